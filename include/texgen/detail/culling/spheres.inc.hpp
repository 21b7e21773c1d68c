// Spheres against the forms of a slide.

namespace TEXGEN_DETAIL {

// The coverage of a sphere where the forms cannot be asked.
inline Coverage coverage_without_forms(const LitForms& forms, const Sphere& sphere) noexcept {
    const glm::vec3& centre = sphere.centre;
    if (std::isnan(centre.x) || std::isnan(centre.y) || std::isnan(centre.z) || std::isnan(sphere.radius))
        return Coverage::partial;
    return sphere.radius < 0.0f || forms.lights_nothing ? Coverage::outside : Coverage::partial;
}

inline namespace TEXGEN_BUILD {

// Classifies a sphere. What is clear of all bounds by twice the error the kernel says as well, as their roundings
// differ by less than one. Where the centre is in front of all forms no edge is asked. slope_of(k) is |a| of form k.
Coverage coverage_of(const LitForms& forms, const FormLanes& lanes, const auto& slope_of, const auto& make_unit,
                     const Sphere& sphere) noexcept {
    const glm::dvec3 centre = widened(sphere.centre);
    const double radius = widened(sphere.radius);
    const double size = std::fabs(centre.x) + std::fabs(centre.y) + std::fabs(centre.z);
    if (!forms.can_say() || !(radius >= 0.0) || !is_finite(size + radius)) return coverage_without_forms(forms, sphere);
    const double of_q = (size + 2.0 * radius) * lanes.largest_q + lanes.last_q;
    bool is_inside = true, is_partial = false, is_lit = true;
    for (std::size_t k = 0; k < forms.count; ++k) {
        const double value =
            lanes.a[0][k] * centre.x + lanes.a[1][k] * centre.y + lanes.a[2][k] * centre.z + lanes.d[k];
        const double change = slope_of(k) * radius;
        const double bound = 2.0 * (lanes.error_a[k] * size + lanes.error_d[k] + gamma(4) * change);
        if (value + change < -bound) return Coverage::outside;
        const double narrowing = lanes.narrowing[k] * of_q;
        is_inside &= value - change > 1.2 * narrowing + bound;
        is_partial |= value - change < narrowing;
        is_lit &= value > bound;
    }
    if (is_inside) return Coverage::inside;
    if (is_partial && is_lit) return Coverage::partial;
    OpenRow rows[4];
    copy_floats(sphere, rows[0], body_quantum);
    int classes[body_quantum];
    chosen<SphereKernels>().decide(make_unit(), forms.count, rows, 1, classes);
    return static_cast<Coverage>(classes[0]);
}

template <class CompiledWhereCalled = void>
void coverage_of_many(const LitForms& forms, const FloatForms& float_forms, const UnitForms& unit,
                      const std::span<const Sphere>& spheres, const std::span<Coverage>& out) noexcept {
    const SphereKernels& kernels = chosen<SphereKernels>();
    classify_many<4>(forms, float_forms, spheres, out, kernels.classify,
                     [&](const OpenRow* open, std::size_t count, bool, int* classes) {
                         kernels.decide(unit, forms.count, open, count, classes);
                     });
}

}  // namespace TEXGEN_BUILD
}  // namespace TEXGEN_DETAIL
