// Many bodies against the forms of a slide, in floats first, and spheres.

namespace TEXGEN_DETAIL {

// Kernels know no Coverage but its numbers.
static_assert(Coverage{0} == Coverage::outside && Coverage{1} == Coverage::partial && Coverage{2} == Coverage::inside);

inline void copy_floats(const Box& box, float* floats) noexcept {
    for (glm::length_t j = 0; j < 3; ++j) {
        floats[j] = box.min[j];
        floats[3 + j] = box.max[j];
    }
}
inline void copy_floats(const Sphere& sphere, float* floats) noexcept {
    for (glm::length_t j = 0; j < 3; ++j) floats[j] = sphere.centre[j];
    floats[3] = sphere.radius;
}

// Classifies bodies of `Floats` floats each by a kernel, and has decided what is left open. Floats of bodies that do not follow
// one another, as where the user aligns GLM's vectors, are copied.
template <std::size_t Floats, class Body, class OpenBodies>
void classify_many(std::span<const Body> bodies, std::span<Coverage> out, Classify classify, const FloatForms& forms,
                   OpenBodies& open_bodies) noexcept {
    constexpr std::size_t chunk = 16 * body_quantum;
    constexpr bool is_dense = sizeof(Body) == Floats * sizeof(float);
    constexpr std::size_t copied = is_dense ? body_quantum : chunk;
    int classes[chunk];
    std::size_t open[chunk];
    for (std::size_t begin = 0; begin < bodies.size();) {
        // Whole quanta where they are, the rest from a copy.
        const std::size_t left = bodies.size() - begin;
        const std::size_t count = left >= chunk          ? chunk
                                  : left >= body_quantum ? left / body_quantum * body_quantum
                                                         : left;
        if (is_dense && count >= body_quantum) {
            classify(forms, reinterpret_cast<const float*>(&bodies[begin]), count, classes);
        } else {
            float copies[copied][Floats] = {};
            for (std::size_t i = 0; i < count; ++i) copy_floats(bodies[begin + i], copies[i]);
            classify(forms, copies[0], (count + body_quantum - 1) / body_quantum * body_quantum, classes);
        }
        // Without a branch for each.
        std::size_t open_count = 0;
        for (std::size_t i = 0; i < count; ++i) {
            out[begin + i] = static_cast<Coverage>(classes[i] & 3);
            open[open_count] = i;
            open_count += static_cast<std::size_t>(classes[i] >= open_body);
        }
        for (std::size_t k = 0; k < open_count; ++k)
            open_bodies.add(bodies[begin + open[k]], classes[open[k]] == body_in_doubt, out[begin + open[k]]);
        begin += count;
    }
    open_bodies.decide();
}

// The extremes of a form over a sphere are its value at the centre +- |a| radius. Beside an edge of the pyramid a sphere
// may be outside none of the five planes: there the plane through the edge that faces the centre separates them. With
// the products of normals G it is w_f f + w_g g, w = -G^-1 (f, g) at the centre, up to a positive factor, where both
// weights are positive; rounded weights serve as well.
inline Coverage exact_coverage(const LitForms& forms, const Sphere& sphere) noexcept {
    const Point centre{widened(sphere.centre.x), widened(sphere.centre.y), widened(sphere.centre.z)};
    const double radius = widened(sphere.radius);
    const double size = std::fabs(centre[0]) + std::fabs(centre[1]) + std::fabs(centre[2]);
    if (!(size >= 0.0) || std::isnan(radius)) return Coverage::partial;  // a NaN
    if (radius < 0.0 || forms.light_nothing()) return Coverage::outside;
    if (!forms.are_usable() || !is_finite(size + radius)) return Coverage::partial;
    const auto dot = [](const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
    double value[max_forms];
    double error[max_forms];
    bool is_inside = true;
    for (std::size_t k = 0; k < forms.count(); ++k) {
        const LinearForm form = forms[k];
        value[k] = dot(form.a, centre) + form.d;
        error[k] = form.error_a * size + form.error_d;
        const double change = forms.slope(k) * radius;
        if (value[k] + change + (error[k] + gamma(4) * change) < 0.0) return Coverage::outside;
        const double narrowing = 1.1 * forms.narrowing(k, size + 2.0 * radius);
        is_inside = is_inside && value[k] - change - (error[k] + gamma(4) * change) > narrowing;
    }
    if (is_inside) return Coverage::inside;
    const auto is_beside_edge = [&](std::size_t f, std::size_t g) {
        if (value[f] >= 0.0 && value[g] >= 0.0) return false;
        const double across = dot(forms[f].a, forms[g].a);
        double of_f = across * value[g] - forms.slope(g) * forms.slope(g) * value[f];
        double of_g = across * value[f] - forms.slope(f) * forms.slope(f) * value[g];
        if (!(of_f > 0.0 && of_g > 0.0)) return false;
        const double both = of_f + of_g;  // or their squares could be too small for a double
        of_f /= both;
        of_g /= both;
        const double longest = of_f * forms.slope(f) + of_g * forms.slope(g);
        const double squared = of_f * of_f * (forms.slope(f) * forms.slope(f)) + 2.0 * of_f * of_g * across +
                               of_g * of_g * (forms.slope(g) * forms.slope(g)) + gamma(32) * longest * longest;
        const double change = std::sqrt(squared) * radius;
        const double rounding = gamma(8) * (of_f * std::fabs(value[f]) + of_g * std::fabs(value[g]) + change);
        return of_f * value[f] + of_g * value[g] + change + (of_f * error[f] + of_g * error[g]) + rounding < 0.0;
    };
    for (std::size_t f = 0; f < 2; ++f)
        for (std::size_t g = 2; g < LitForms::q; ++g)
            if (is_beside_edge(f, g)) return Coverage::outside;
    for (std::size_t f = 0; f < LitForms::q; ++f)
        for (std::size_t g = LitForms::q + 1; g < forms.count(); ++g)
            if (is_beside_edge(f, g)) return Coverage::outside;
    return Coverage::partial;
}

inline namespace TEXGEN_BUILD {

// Spheres of which floats do not say what they are, gathered until they fill vectors.
template <class CompiledWhereCalled = void>
class OpenSpheres {
public:
    OpenSpheres(const SphereBatchKernels& kernels, const LitForms& forms) noexcept : kernels_(kernels), forms_(forms) {}

    void add(const Sphere& sphere, bool, Coverage& out) noexcept {
        const glm::dvec3 centre = widened(sphere.centre);
        const bool is_sphere = is_finite(sphere.centre) && sphere.radius >= 0.0f && is_finite(sphere.radius);
        if (!is_sphere || !forms_.can_say()) {
            out = exact_coverage(forms_, sphere);
            return;
        }
        for (std::size_t j = 0; j < 3; ++j) block_.centre[j][count_] = centre[static_cast<glm::length_t>(j)];
        block_.radius[count_] = widened(sphere.radius);
        sphere_[count_] = &sphere;
        out_[count_] = &out;
        if (++count_ == box_block) decide();
    }

    void decide() noexcept {
        if (count_ == 0) return;
        int classes[box_block];
        kernels_.bound(forms_.lanes(), forms_.count(), block_, classes);
        for (std::size_t i = 0; i < count_; ++i)
            *out_[i] =
                classes[i] == body_in_doubt ? exact_coverage(forms_, *sphere_[i]) : static_cast<Coverage>(classes[i]);
        count_ = 0;
    }

private:
    const SphereBatchKernels& kernels_;
    const LitForms& forms_;
    SphereBlock block_{};
    const Sphere* sphere_[box_block];
    Coverage* out_[box_block];
    std::size_t count_ = 0;
};

template <class CompiledWhereCalled = void>
void cover(const LitForms& forms, const FloatForms& float_forms, std::span<const Sphere> spheres,
           const std::span<Coverage>& out) noexcept {
    const SphereBatchKernels& kernels = chosen<SphereBatchKernels>();
    OpenSpheres<> open(kernels, forms);
    classify_many<4>(spheres, out, kernels.classify, float_forms, open);
}

}  // namespace TEXGEN_BUILD
}  // namespace TEXGEN_DETAIL
