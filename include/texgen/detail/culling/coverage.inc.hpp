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

// What the five planes say of a box, exactly. For a NaN, and for forms of which nothing is known: partial.
inline Coverage exact_coverage(const LitForms& forms, const Box& box) noexcept {
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
            if (!forms[k].uses[j]) continue;
            vertex[j] = ((forms[k].a[j] > 0.0) == largest ? max : min)[static_cast<glm::length_t>(j)];
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
    if (sign_at_vertex(LitForms::q, true) <= 0) return Coverage::outside;
    bool is_inside = sign_at_vertex(LitForms::q, false) > 0;
    for (std::size_t k = 0; k < side_count; ++k) {
        if (sign_at_vertex(k, true) < 0) return Coverage::outside;
        is_inside = is_inside && is_inside_side(k);
    }
    return is_inside ? Coverage::inside : Coverage::partial;
}

inline namespace TEXGEN_BUILD {

// Boxes of which floats do not say that they are outside or inside, gathered until they fill vectors.
class OpenBoxes {
public:
    OpenBoxes(const BoxKernels& kernels, const LitForms& forms) noexcept
        : kernels_(kernels), forms_(forms), has_forms_(forms.are_usable() && !forms.light_nothing()) {}

    // A box that is partial to the five planes, or in doubt.
    void add(const Box& box, bool is_in_doubt, Coverage& out) noexcept {
        // Without a branch for each.
        bool has_points = has_forms_;
        for (std::size_t j = 0; j < 3; ++j) {
            const float min = box.min[static_cast<glm::length_t>(j)];
            const float max = box.max[static_cast<glm::length_t>(j)];
            has_points &= min <= max;
            has_points &= min <= (std::numeric_limits<float>::max)();
            has_points &= max >= std::numeric_limits<float>::lowest();
            block_.min[j][count_] = widened(min);
            block_.max[j][count_] = widened(max);
        }
        if (!has_points) {
            out = exact_coverage(forms_, box);
            return;
        }
        box_[count_] = &box;
        out_[count_] = &out;
        is_in_doubt_ = is_in_doubt_ || is_in_doubt;
        if (++count_ == box_block) decide();
    }

    // The five planes in double, where there is doubt; and those that a further plane separates from the pyramid are
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
        double least_of_largest[box_block];
        kernels_.separate(forms_.separating(), forms_.separating_count(), block_, least_of_largest);
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
    BoxBlock block_{};
    const Box* box_[box_block];
    Coverage* out_[box_block];
    std::size_t count_ = 0;
    bool has_forms_;
    bool is_in_doubt_ = false;
};

template <class CompiledWhereCalled = void>
void cover(const LitForms& forms, const FloatForms& float_forms, std::span<const Box> boxes,
           std::span<Coverage> out) noexcept {
    constexpr std::size_t chunk = 16 * box_quantum;
    // Six floats follow one another, but where the user aligns GLM's vectors.
    constexpr bool is_dense = sizeof(Box) == 6 * sizeof(float);
    constexpr std::size_t copied = is_dense ? box_quantum : chunk;
    const BoxKernels& kernels = chosen<BoxKernels>();
    OpenBoxes open_boxes(kernels, forms);
    int classes[chunk];
    std::size_t open[chunk];
    for (std::size_t begin = 0; begin < boxes.size();) {
        // Whole quanta where they are, the rest from a copy.
        const std::size_t left = boxes.size() - begin;
        const std::size_t count = left >= chunk ? chunk : left >= box_quantum ? left / box_quantum * box_quantum : left;
        if (is_dense && count >= box_quantum) {
            kernels.classify(float_forms, &boxes[begin].min.x, count, classes);
        } else {
            float copy[copied][6] = {};
            for (std::size_t i = 0; i < count; ++i) {
                const Box& box = boxes[begin + i];
                for (glm::length_t j = 0; j < 3; ++j) {
                    copy[i][j] = box.min[j];
                    copy[i][3 + j] = box.max[j];
                }
            }
            const std::size_t whole = (count + box_quantum - 1) / box_quantum * box_quantum;
            kernels.classify(float_forms, copy[0], whole, classes);
        }
        // Without a branch: partial and doubtful are the odd ones. Kernels know no Coverage but its numbers.
        static_assert(Coverage{0} == Coverage::outside && Coverage{1} == Coverage::partial &&
                      Coverage{2} == Coverage::inside);
        std::size_t open_count = 0;
        for (std::size_t i = 0; i < count; ++i) {
            out[begin + i] = static_cast<Coverage>(classes[i]);
            open[open_count] = begin + i;
            open_count += static_cast<std::size_t>(classes[i] & 1);
        }
        for (std::size_t k = 0; k < open_count; ++k) {
            Coverage& result = out[open[k]];
            open_boxes.add(boxes[open[k]], result != Coverage::partial, result);
        }
        begin += count;
    }
    open_boxes.decide();
}

// One box: the planes are decided exactly at once, which says what the floats would.
template <class CompiledWhereCalled = void>
Coverage coverage_of(const LitForms& forms, const Box& box) noexcept {
    Coverage result = exact_coverage(forms, box);
    if (result != Coverage::partial) return result;
    OpenBoxes open_boxes(chosen<BoxKernels>(), forms);
    open_boxes.add(box, false, result);
    open_boxes.decide();
    return result;
}

}  // namespace TEXGEN_BUILD

// The extremes of a form over a sphere are its value at the centre +- |a| radius. Beside an edge of the pyramid a sphere
// may be outside none of the five planes: there the plane through the edge that faces the centre separates them. With
// the products of normals G it is w_f f + w_g g, w = -G^-1 (f, g) at the centre, up to a positive factor, where both
// weights are positive; rounded weights serve as well.
inline Coverage coverage_of(const LitForms& forms, const Sphere& sphere) noexcept {
    const Point centre{widened(sphere.centre.x), widened(sphere.centre.y), widened(sphere.centre.z)};
    const double radius = widened(sphere.radius);
    const double size = std::fabs(centre[0]) + std::fabs(centre[1]) + std::fabs(centre[2]);
    if (!(size >= 0.0) || std::isnan(radius)) return Coverage::partial;  // a NaN
    if (radius < 0.0 || forms.light_nothing()) return Coverage::outside;
    if (!forms.are_usable() || !is_finite(size + radius)) return Coverage::partial;
    const auto dot = [](const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
    double value[LitForms::count];
    double error[LitForms::count];
    bool is_inside = true;
    for (std::size_t k = 0; k < LitForms::count; ++k) {
        const LinearForm& form = forms[k];
        value[k] = dot(form.a, centre) + form.d;
        error[k] = form.error_a * size + form.error_d;
        const double change = forms.slope(k) * radius;
        if (value[k] + change + (error[k] + gamma(4) * change) < 0.0) return Coverage::outside;
        const double narrowing = 1.1 * forms.narrowing(k, size + 2.0 * radius);
        is_inside = is_inside && value[k] - change - (error[k] + gamma(4) * change) > narrowing;
    }
    if (is_inside) return Coverage::inside;
    for (std::size_t f = 0; f < 2; ++f) {
        for (std::size_t g = 2; g < side_count; ++g) {
            const double across = dot(forms[f].a, forms[g].a);
            double of_f = across * value[g] - forms.slope(g) * forms.slope(g) * value[f];
            double of_g = across * value[f] - forms.slope(f) * forms.slope(f) * value[g];
            if (!(of_f > 0.0 && of_g > 0.0)) continue;
            const double both = of_f + of_g;  // or their squares could be too small for a double
            of_f /= both;
            of_g /= both;
            const double longest = of_f * forms.slope(f) + of_g * forms.slope(g);
            const double squared = of_f * of_f * (forms.slope(f) * forms.slope(f)) + 2.0 * of_f * of_g * across +
                                   of_g * of_g * (forms.slope(g) * forms.slope(g)) + gamma(32) * longest * longest;
            const double change = std::sqrt(squared) * radius;
            const double rounding = gamma(8) * (of_f * std::fabs(value[f]) + of_g * std::fabs(value[g]) + change);
            if (of_f * value[f] + of_g * value[g] + change + (of_f * error[f] + of_g * error[g]) + rounding < 0.0)
                return Coverage::outside;
        }
    }
    return Coverage::partial;
}

}  // namespace TEXGEN_DETAIL

namespace TEXGEN_NAMESPACE {
inline namespace TEXGEN_BUILD {

template <class Space>
LitVolume<Space>::LitVolume(const Transform<Texture, Space>& texture_from_space, const TextureRegion& region) noexcept
    : forms_(texture_from_space.matrix(), region), float_forms_(forms_.in_float()) {}

template <class Space>
Coverage LitVolume<Space>::coverage(const Box& box) const noexcept {
    return detail::coverage_of(forms_, box);
}
template <class Space>
Coverage LitVolume<Space>::coverage(const Sphere& sphere) const noexcept {
    return detail::coverage_of(forms_, sphere);
}

template <class Space>
void LitVolume<Space>::coverage(std::span<const Box> boxes, std::span<Coverage> out) const noexcept {
    TEXGEN_ASSERT(boxes.size() == out.size());
    detail::cover(forms_, float_forms_, boxes, out);
}
template <class Space>
void LitVolume<Space>::coverage(std::span<const Sphere> spheres, std::span<Coverage> out) const noexcept {
    TEXGEN_ASSERT(spheres.size() == out.size());
    for (std::size_t i = 0; i < spheres.size(); ++i) out[i] = coverage(spheres[i]);
}

// One body needs no forms in float, nor do spheres.
template <class Space>
Coverage coverage(const Transform<Texture, Space>& texture_from_space, const TextureRegion& region,
                  const Box& box) noexcept {
    return detail::coverage_of(detail::LitForms(texture_from_space.matrix(), region), box);
}
template <class Space>
Coverage coverage(const Transform<Texture, Space>& texture_from_space, const TextureRegion& region,
                  const Sphere& sphere) noexcept {
    return detail::coverage_of(detail::LitForms(texture_from_space.matrix(), region), sphere);
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
