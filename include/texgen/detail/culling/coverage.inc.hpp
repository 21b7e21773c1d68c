// Boxes and spheres against the forms of a slide: in floats, in double, and at last exactly.

namespace TEXGEN_DETAIL {

// Whether a box is inside the inner side k, exactly.
inline bool is_inside_inner_side(const LitForms& forms, std::size_t k, const Box& box, CloseRows& close) noexcept {
    const std::array<double, 4> form = forms.inner_side(k);
    Point vertex{};
    for (std::size_t j = 0; j < 3; ++j) {
        if (form[j] == 0.0) continue;
        vertex[j] = widened((form[j] > 0.0 ? box.min : box.max)[static_cast<glm::length_t>(j)]);
        if (!is_finite(vertex[j])) return false;
    }
    return forms.inner_sign_at(k, form, vertex, close) >= 0;
}

// What the planes say of a box, exactly: of those that are in doubt. For a NaN, and for forms of which nothing is known:
// partial.
inline Coverage exact_coverage(const LitForms& forms, const Box& box,
                               const FormsInDoubt& doubt = {~0u, ~0u, false, false}) noexcept {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    bool is_empty = false;
    for (glm::length_t j = 0; j < 3; ++j) {
        if (!(box.min[j] <= box.max[j]) && !(box.min[j] > box.max[j])) return Coverage::partial;
        is_empty = is_empty || box.min[j] > box.max[j];
    }
    if (is_empty || forms.light_nothing()) return Coverage::outside;
    if (!forms.are_usable()) return Coverage::partial;
    for (glm::length_t j = 0; j < 3; ++j)
        if (box.min[j] == infinity || box.max[j] == -infinity) return Coverage::partial;  // beyond all numbers

    // The vertex where a form is largest, or least; false where it is infinite there.
    const glm::dvec3 min = widened(box.min);
    const glm::dvec3 max = widened(box.max);
    const auto take_vertex = [&](std::size_t k, bool largest, Point& vertex) {
        for (std::size_t j = 0; j < 3; ++j) {
            const double a = forms.a(k, j);
            if (a == 0.0) continue;
            vertex[j] = ((a > 0.0) == largest ? max : min)[static_cast<glm::length_t>(j)];
            if (!is_finite(vertex[j])) return false;
        }
        return true;
    };
    CloseRows close;
    const auto sign_at_vertex = [&](std::size_t k, bool largest) {
        Point vertex{};
        return take_vertex(k, largest, vertex) ? forms.sign_at(k, vertex, close) : largest ? 1 : -1;
    };
    double size = 0.0;
    for (glm::length_t j = 0; j < 3; ++j) size += larger(std::fabs(min[j]), std::fabs(max[j]));
    // Almost always the outer side has room for the inner one.
    const auto is_inside_side = [&](std::size_t k) {
        Point vertex{};
        return (take_vertex(k, false, vertex) && forms.is_inside_at(k, vertex, size)) ||
               is_inside_inner_side(forms, k, box, close);
    };
    bool is_inside = !doubt.is_any_negative;
    for (std::size_t k = forms.count(); k-- > 0;) {
        if ((doubt.largest >> k & 1u) != 0 && sign_at_vertex(k, true) < (k == LitForms::q ? 1 : 0))
            return Coverage::outside;
        if (!is_inside || (doubt.least >> k & 1u) == 0) continue;
        is_inside = k == LitForms::q ? sign_at_vertex(k, false) > 0 : is_inside_side(k);
    }
    return is_inside ? Coverage::inside : Coverage::partial;
}

inline namespace TEXGEN_BUILD {

// Puts a box among others; whether it holds a point that is a number.
inline bool put(const Box& box, BoxBlock& block, std::size_t i) noexcept {
    // Without a branch for each.
    bool has_points = true;
    for (std::size_t j = 0; j < 3; ++j) {
        const float min = box.min[static_cast<glm::length_t>(j)];
        const float max = box.max[static_cast<glm::length_t>(j)];
        has_points &= min <= max;
        has_points &= min <= (std::numeric_limits<float>::max)();
        has_points &= max >= std::numeric_limits<float>::lowest();
        block.min[j][i] = widened(min);
        block.max[j][i] = widened(max);
    }
    return has_points;
}

// Boxes of which floats do not say what they are, gathered until they fill vectors.
class OpenBoxes {
public:
    OpenBoxes(const BoxKernels& kernels, const LitForms& forms) noexcept
        : kernels_(kernels), forms_(forms), has_forms_(forms.can_say()) {}

    // A box that is partial to the planes, or in doubt.
    void add(const Box& box, bool is_in_doubt, Coverage& out) noexcept {
        if (!put(box, block_, count_) || !has_forms_) {
            out = exact_coverage(forms_, box);
            return;
        }
        box_[count_] = &box;
        out_[count_] = &out;
        is_in_doubt_ = is_in_doubt_ || is_in_doubt;
        if (++count_ == box_block) decide();
    }

    // The planes in double, where there is doubt; and those that a further plane separates from the pyramid are
    // outside.
    void decide() noexcept {
        if (count_ == 0) return;
        for (std::size_t i = 0; i < count_; ++i) *out_[i] = Coverage::partial;
        if (is_in_doubt_) decide_doubt();
        bool any_is_partial = false;
        for (std::size_t i = 0; i < count_; ++i) any_is_partial |= *out_[i] == Coverage::partial;
        if (any_is_partial) separate();
        count_ = 0;
        is_in_doubt_ = false;
    }

private:
    void separate() noexcept {
        if (!separating_) separating_.emplace(forms_);
        double least_of_largest[box_block];
        kernels_.separate(separating_->data(), separating_->size(), block_, least_of_largest);
        for (std::size_t i = 0; i < count_; ++i)
            if (*out_[i] == Coverage::partial && least_of_largest[i] < 0.0) *out_[i] = Coverage::outside;
    }

    void decide_doubt() noexcept {
        if (!double_forms_) double_forms_ = forms_.in_double();
        BoxBounds bounds;
        kernels_.bound(*double_forms_, block_, bounds);
        for (std::size_t i = 0; i < count_; ++i) {
            if (bounds.upper[i] < 0.0)
                *out_[i] = Coverage::outside;
            else if (bounds.lower[i] < 0.0)
                *out_[i] = exact_coverage(forms_, *box_[i]);
            else if (bounds.inner_lower[i] >= 0.0)
                *out_[i] = Coverage::inside;
            else if (!(bounds.inner_upper[i] < 0.0))
                *out_[i] = exact_coverage(forms_, *box_[i]);
        }
    }

    const BoxKernels& kernels_;
    const LitForms& forms_;
    std::optional<DoubleForms> double_forms_;
    std::optional<SeparatingForms> separating_;
    BoxBlock block_{};
    const Box* box_[box_block];
    Coverage* out_[box_block];
    std::size_t count_ = 0;
    bool has_forms_;
    bool is_in_doubt_ = false;
};

// Kernels know no Coverage but its numbers.
static_assert(Coverage{0} == Coverage::outside && Coverage{1} == Coverage::partial && Coverage{2} == Coverage::inside);

// Classifies bodies of `Floats` floats each by a kernel, and calls decide(i, is_in_doubt) for those that are left open. Where
// the floats of bodies do not follow one another, as where the user aligns GLM's vectors, copy(body, floats) makes them.
template <std::size_t Floats, class Body, class Classify, class Copy, class Decide>
void classify_many(std::span<const Body> bodies, std::span<Coverage> out, const Classify& classify, const Copy& copy,
                   const Decide& decide) noexcept {
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
            classify(reinterpret_cast<const float*>(&bodies[begin]), count, classes);
        } else {
            float copies[copied][Floats] = {};
            for (std::size_t i = 0; i < count; ++i) copy(bodies[begin + i], copies[i]);
            classify(copies[0], (count + body_quantum - 1) / body_quantum * body_quantum, classes);
        }
        // Without a branch for each.
        std::size_t open_count = 0;
        for (std::size_t i = 0; i < count; ++i) {
            out[begin + i] = static_cast<Coverage>(classes[i] & 3);
            open[open_count] = i;
            open_count += static_cast<std::size_t>(classes[i] / open_body);
        }
        for (std::size_t k = 0; k < open_count; ++k) decide(begin + open[k], classes[open[k]] == body_in_doubt);
        begin += count;
    }
}

template <class CompiledWhereCalled = void>
void cover(const LitForms& forms, const FloatForms& float_forms, std::span<const Box> boxes,
           const std::span<Coverage>& out) noexcept {
    const BoxKernels& kernels = chosen<BoxKernels>();
    OpenBoxes open_boxes(kernels, forms);
    classify_many<6>(
        boxes, out,
        [&](const float* floats, std::size_t count, int* classes) {
            kernels.classify_boxes(float_forms, floats, count, classes);
        },
        [](const Box& box, float* floats) {
            for (glm::length_t j = 0; j < 3; ++j) {
                floats[j] = box.min[j];
                floats[3 + j] = box.max[j];
            }
        },
        [&](std::size_t i, bool is_in_doubt) { open_boxes.add(boxes[i], is_in_doubt, out[i]); });
    open_boxes.decide();
}

// Whether a further plane separates one box, which is partial to the forms, from what they leave.
inline bool is_separated(const BoxKernels& kernels, const LitForms& forms, const BoxBlock& block) noexcept {
    constexpr double unbounded = 0x1p200;  // nor larger than what products hold
    Point middle{};
    for (std::size_t j = 0; j < 3; ++j)
        middle[j] = 0.5 * larger(block.min[j][0], -unbounded) + 0.5 * smaller(block.max[j][0], unbounded);
    // Almost always the middle is lit, or the vertex where the form is largest that is negative there.
    const std::uint32_t dark = forms.dark_at(middle);
    if (dark == 0) return false;
    for (std::uint32_t bits = dark; bits != 0; bits &= bits - 1) {
        const auto k = static_cast<std::size_t>(std::countr_zero(bits));
        Point vertex = middle;
        for (std::size_t j = 0; j < 3; ++j)
            if (forms.a(k, j) != 0.0) vertex[j] = (forms.a(k, j) > 0.0 ? block.max : block.min)[j][0];
        if ((forms.dark_at(vertex) & ~(std::uint32_t{1} << k)) == 0) return false;
    }
    const SeparatingForms separating(forms, dark);
    double least_of_largest[box_block];
    kernels.separate(separating.data(), separating.size(), block, least_of_largest);
    return least_of_largest[0] < 0.0;
}

// One box.
inline Coverage coverage_of(const BoxKernels& kernels, const LitForms& forms, const Box& box) noexcept {
    FormsInDoubt doubt{~0u, ~0u, false, false};
    const int answer =
        forms.can_say() ? kernels.classify_box(forms.lanes(), &box.min.x, &box.max.x, doubt) : body_in_doubt;
    if (answer < open_body) return static_cast<Coverage>(answer);
    if (answer == body_in_doubt && doubt.is_finite &&
        kernels.sharpen(forms.matrix(), forms.weights(), &box.min.x, &box.max.x, doubt))
        return Coverage::outside;
    const Coverage result = answer == body_in_doubt ? exact_coverage(forms, box, doubt) : Coverage::partial;
    if (result != Coverage::partial) return result;
    BoxBlock block;
    for (std::size_t i = 0; i < box_block; ++i)
        if (!put(box, block, i)) return result;
    return forms.can_say() && is_separated(kernels, forms, block) ? Coverage::outside : result;
}

}  // namespace TEXGEN_BUILD

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
    double slope[max_forms];
    // Most are far outside, which takes no root.
    for (std::size_t k = 0; k < forms.count(); ++k) {
        const LinearForm form = forms[k];
        value[k] = dot(form.a, centre) + form.d;
        error[k] = form.error_a * size + form.error_d;
        const double most = 1.001 * (std::fabs(form.a[0]) + std::fabs(form.a[1]) + std::fabs(form.a[2])) * radius;
        if (value[k] + most + error[k] < 0.0) return Coverage::outside;
    }
    bool is_inside = true;
    for (std::size_t k = 0; k < forms.count(); ++k) {
        slope[k] = forms.slope(k);
        const double change = slope[k] * radius;
        if (value[k] + change + (error[k] + gamma(4) * change) < 0.0) return Coverage::outside;
        const double narrowing = 1.1 * forms.narrowing(k, size + 2.0 * radius);
        is_inside = is_inside && value[k] - change - (error[k] + gamma(4) * change) > narrowing;
    }
    if (is_inside) return Coverage::inside;
    const auto is_beside_edge = [&](std::size_t f, std::size_t g) {
        if (value[f] >= 0.0 && value[g] >= 0.0) return false;
        const double across = dot(forms[f].a, forms[g].a);
        double of_f = across * value[g] - slope[g] * slope[g] * value[f];
        double of_g = across * value[f] - slope[f] * slope[f] * value[g];
        if (!(of_f > 0.0 && of_g > 0.0)) return false;
        const double both = of_f + of_g;  // or their squares could be too small for a double
        of_f /= both;
        of_g /= both;
        const double longest = of_f * slope[f] + of_g * slope[g];
        const double squared = of_f * of_f * (slope[f] * slope[f]) + 2.0 * of_f * of_g * across +
                               of_g * of_g * (slope[g] * slope[g]) + gamma(32) * longest * longest;
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
class OpenSpheres {
public:
    OpenSpheres(const BoxKernels& kernels, const LitForms& forms) noexcept : kernels_(kernels), forms_(forms) {}

    void add(const Sphere& sphere, Coverage& out) noexcept {
        const bool is_sphere = is_finite(sphere.centre.x) && is_finite(sphere.centre.y) && is_finite(sphere.centre.z) &&
                               sphere.radius >= 0.0f && is_finite(sphere.radius);
        if (!is_sphere || !forms_.can_say()) {
            out = exact_coverage(forms_, sphere);
            return;
        }
        for (std::size_t j = 0; j < 3; ++j)
            block_.centre[j][count_] = widened(sphere.centre[static_cast<glm::length_t>(j)]);
        block_.radius[count_] = widened(sphere.radius);
        sphere_[count_] = &sphere;
        out_[count_] = &out;
        if (++count_ == box_block) decide();
    }

    void decide() noexcept {
        if (count_ == 0) return;
        if (!sphere_forms_) sphere_forms_ = forms_.for_spheres();
        int classes[box_block];
        kernels_.bound_spheres(*sphere_forms_, block_, classes);
        for (std::size_t i = 0; i < count_; ++i)
            *out_[i] =
                classes[i] == body_in_doubt ? exact_coverage(forms_, *sphere_[i]) : static_cast<Coverage>(classes[i]);
        count_ = 0;
    }

private:
    const BoxKernels& kernels_;
    const LitForms& forms_;
    std::optional<SphereForms> sphere_forms_;
    SphereBlock block_{};
    const Sphere* sphere_[box_block];
    Coverage* out_[box_block];
    std::size_t count_ = 0;
};

template <class CompiledWhereCalled = void>
void cover(const LitForms& forms, const FloatForms& float_forms, std::span<const Sphere> spheres,
           const std::span<Coverage>& out) noexcept {
    const BoxKernels& kernels = chosen<BoxKernels>();
    OpenSpheres open_spheres(kernels, forms);
    classify_many<4>(
        spheres, out,
        [&](const float* floats, std::size_t count, int* classes) {
            kernels.classify_spheres(float_forms, floats, count, classes);
        },
        [](const Sphere& sphere, float* floats) {
            for (glm::length_t j = 0; j < 3; ++j) floats[j] = sphere.centre[j];
            floats[3] = sphere.radius;
        },
        [&](std::size_t i, bool) { open_spheres.add(spheres[i], out[i]); });
    open_spheres.decide();
}

}  // namespace TEXGEN_BUILD

}  // namespace TEXGEN_DETAIL

namespace TEXGEN_NAMESPACE {
inline namespace TEXGEN_BUILD {

template <class Space>
LitVolume<Space>::LitVolume(const Transform<Texture, Space>& texture_from_space, const TextureRegion& region) noexcept
    : forms_(texture_from_space.matrix(), region, detail::chosen<detail::BoxKernels>()),
      float_forms_(forms_.in_float(detail::chosen<detail::BoxKernels>())) {}

template <class Space>
Coverage LitVolume<Space>::coverage(const Box& box) const noexcept {
    return detail::coverage_of(detail::chosen<detail::BoxKernels>(), forms_, box);
}
template <class Space>
Coverage LitVolume<Space>::coverage(const Sphere& sphere) const noexcept {
    return detail::exact_coverage(forms_, sphere);
}

template <class Space>
void LitVolume<Space>::coverage(std::span<const Box> boxes, std::span<Coverage> out) const noexcept {
    TEXGEN_ASSERT(boxes.size() == out.size());
    detail::cover(forms_, float_forms_, boxes, out);
}
template <class Space>
void LitVolume<Space>::coverage(std::span<const Sphere> spheres, std::span<Coverage> out) const noexcept {
    TEXGEN_ASSERT(spheres.size() == out.size());
    detail::cover(forms_, float_forms_, spheres, out);
}

// One body needs no forms in float.
template <class Space>
Coverage coverage(const Transform<Texture, Space>& texture_from_space, const TextureRegion& region,
                  const Box& box) noexcept {
    const detail::BoxKernels& kernels = detail::chosen<detail::BoxKernels>();
    return detail::coverage_of(kernels, detail::LitForms(texture_from_space.matrix(), region, kernels), box);
}
template <class Space>
Coverage coverage(const Transform<Texture, Space>& texture_from_space, const TextureRegion& region,
                  const Sphere& sphere) noexcept {
    const detail::BoxKernels& kernels = detail::chosen<detail::BoxKernels>();
    return detail::exact_coverage(detail::LitForms(texture_from_space.matrix(), region, kernels), sphere);
}
template <class Space>
void coverage(const Transform<Texture, Space>& texture_from_space, const TextureRegion& region,
              std::span<const Box> boxes, std::span<Coverage> out) noexcept {
    LitVolume<Space>(texture_from_space, region).coverage(boxes, out);
}
template <class Space>
void coverage(const Transform<Texture, Space>& texture_from_space, const TextureRegion& region,
              std::span<const Sphere> spheres, std::span<Coverage> out) noexcept {
    LitVolume<Space>(texture_from_space, region).coverage(spheres, out);
}

}  // namespace TEXGEN_BUILD
}  // namespace TEXGEN_NAMESPACE
