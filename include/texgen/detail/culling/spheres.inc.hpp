// Many bodies against the forms of a slide, in floats first, and spheres.

namespace TEXGEN_DETAIL {

// Kernels know no Coverage but its numbers.
static_assert(Coverage{0} == Coverage::outside && Coverage{1} == Coverage::partial && Coverage{2} == Coverage::inside);

// The floats of a body, this far apart.
inline void copy_floats(const Box& box, float* to, std::size_t distance) noexcept {
    TEXGEN_UNROLL
    for (std::size_t j = 0; j < 3; ++j) {
        to[j * distance] = box.min[static_cast<glm::length_t>(j)];
        to[(3 + j) * distance] = box.max[static_cast<glm::length_t>(j)];
    }
}
inline void copy_floats(const Sphere& sphere, float* to, std::size_t distance) noexcept {
    TEXGEN_UNROLL
    for (std::size_t j = 0; j < 3; ++j) to[j * distance] = sphere.centre[static_cast<glm::length_t>(j)];
    to[3 * distance] = sphere.radius;
}

// Classifies bodies of `Floats` floats each by a kernel, and has `decide` say what that leaves open, which is gathered until it
// fills vectors. Floats of bodies that do not follow one another, as where the user aligns GLM's vectors, are copied.
template <std::size_t Floats, class Body, class Decide>
void classify_many(const LitForms& forms, const FloatForms& float_forms, std::span<const Body> bodies,
                   std::span<Coverage> out, Classify classify, const Decide& decide) noexcept {
    constexpr std::size_t chunk = 16 * body_quantum;
    constexpr bool is_dense = sizeof(Body) == Floats * sizeof(float);
    constexpr std::size_t copied = is_dense ? body_quantum : chunk;
    if (!forms.can_say()) {
        for (std::size_t i = 0; i < bodies.size(); ++i) out[i] = exact_coverage(forms, bodies[i]);
        return;
    }
    int classes[chunk];
    std::size_t open[chunk + body_quantum];
    std::size_t open_count = 0;
    OpenRow rows[Floats] = {};
    const auto decide_last = [&](std::size_t count) {
        bool is_any_in_doubt = false;
        open_count -= count;
        for (std::size_t k = 0; k < count; ++k) {
            const std::size_t i = open[open_count + k];
            copy_floats(bodies[i], &rows[0][k], body_quantum);
            is_any_in_doubt |= out[i] == Coverage{body_in_doubt & 3};
        }
        decide(rows, count, is_any_in_doubt, classes);
        for (std::size_t k = 0; k < count; ++k) {
            const std::size_t i = open[open_count + k];
            out[i] = classes[k] == body_in_doubt ? exact_coverage(forms, bodies[i]) : static_cast<Coverage>(classes[k]);
        }
    };
    for (std::size_t begin = 0; begin < bodies.size();) {
        // Whole quanta where they are, the rest from a copy.
        const std::size_t left = bodies.size() - begin;
        const std::size_t count = left >= chunk          ? chunk
                                  : left >= body_quantum ? left / body_quantum * body_quantum
                                                         : left;
        if (is_dense && count >= body_quantum) {
            classify(float_forms, reinterpret_cast<const float*>(&bodies[begin]), count, classes);
        } else {
            float copies[copied][Floats] = {};
            for (std::size_t i = 0; i < count; ++i) copy_floats(bodies[begin + i], copies[i], 1);
            classify(float_forms, copies[0], (count + body_quantum - 1) / body_quantum * body_quantum, classes);
        }
        // Without a branch for each.
        for (std::size_t i = 0; i < count; ++i) {
            out[begin + i] = static_cast<Coverage>(classes[i] & 3);
            open[open_count] = begin + i;
            open_count += static_cast<std::size_t>(classes[i] >= open_body);
        }
        begin += count;
        while (open_count >= body_quantum) decide_last(body_quantum);
    }
    if (open_count > 0) decide_last(open_count);
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

template <class CompiledWhereCalled = void>
void cover(const LitForms& forms, const FloatForms& float_forms, std::span<const Sphere> spheres,
           const std::span<Coverage>& out) noexcept {
    const SphereBatchKernels& kernels = chosen<SphereBatchKernels>();
    classify_many<4>(forms, float_forms, spheres, out, kernels.classify,
                     [&](const OpenRow* open, std::size_t count, bool, int* classes) {
                         kernels.decide(forms.lanes(), forms.count(), open, count, classes);
                     });
}

}  // namespace TEXGEN_BUILD
}  // namespace TEXGEN_DETAIL
