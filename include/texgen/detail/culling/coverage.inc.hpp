// Boxes against the forms of a slide: in floats, in double, and at last exactly; and what is asked of a volume.

namespace TEXGEN_DETAIL {

// What is said of a box of which no form is asked.
inline Coverage coverage_without_forms(const LitForms& forms, const Box& box) noexcept {
    bool is_empty = false;
    for (glm::length_t j = 0; j < 3; ++j) {
        if (std::isnan(box.min[j]) || std::isnan(box.max[j])) return Coverage::partial;
        is_empty = is_empty || box.min[j] > box.max[j];
    }
    return is_empty || forms.light_nothing() ? Coverage::outside : Coverage::partial;
}

// Whether a box holds a point that is a number: of a NaN and beyond all numbers, inf - inf, an extent is a NaN.
inline bool has_points(const Box& box) noexcept {
    bool result = true;
    for (glm::length_t j = 0; j < 3; ++j) result = result && widened(box.max[j]) - widened(box.min[j]) >= 0.0;
    return result;
}

// What the planes say of a box that has points, exactly: of those that are in doubt.
inline Coverage exact_coverage(const LitForms& forms, const Box& box, const FormsInDoubt& doubt) noexcept {
    // The vertex where a form is largest, or least; false where it is infinite there.
    const glm::dvec3 min = widened(box.min);
    const glm::dvec3 max = widened(box.max);
    const auto take_vertex = [&](const Point& a, bool largest, Point& vertex) {
        for (std::size_t j = 0; j < 3; ++j) {
            if (a[j] == 0.0) continue;
            vertex[j] = ((a[j] > 0.0) == largest ? max : min)[static_cast<glm::length_t>(j)];
            if (!is_finite(vertex[j])) return false;
        }
        return true;
    };
    CloseRows close;
    const auto sign_at_vertex = [&](std::size_t k, bool largest) {
        Point vertex{};
        return take_vertex(forms.a(k), largest, vertex) ? forms.sign_at(k, vertex, close) : largest ? 1 : -1;
    };
    double size = 0.0;
    for (glm::length_t j = 0; j < 3; ++j) size += larger(std::fabs(min[j]), std::fabs(max[j]));
    // Almost always the outer side has room for the inner one.
    const auto is_inside_side = [&](std::size_t k) {
        Point vertex{}, inner_vertex{};
        if (take_vertex(forms.a(k), false, vertex) && forms.is_inside_at(k, vertex, size)) return true;
        const std::array<double, 4> inner = forms.inner_side(k);
        return take_vertex({inner[0], inner[1], inner[2]}, false, inner_vertex) &&
               forms.inner_sign_at(k, inner, inner_vertex, close) >= 0;
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

template <class CompiledWhereCalled = void>
void cover(const LitForms& forms, const FloatForms& float_forms, const SeparatingForms& separating,
           std::span<const Box> boxes, const std::span<Coverage>& out) noexcept {
    const BoxBatchKernels& kernels = chosen<BoxBatchKernels>();
    DoubleForms double_forms;  // made when first needed
    classify_many<6>(forms, float_forms, boxes, out, kernels.classify,
                     [&](const OpenRow* open, std::size_t count, bool is_any_in_doubt, int* classes) {
                         if (is_any_in_doubt && double_forms.count == 0) forms.take_in_double(double_forms);
                         kernels.decide(is_any_in_doubt ? &double_forms : nullptr, separating, open, count, classes);
                     });
}

// One box; separating() is asked where a further plane may make it outside.
template <class Separating>
Coverage coverage_of(const BoxKernels& kernels, const LitForms& forms, const Box& box,
                     const Separating& separating) noexcept {
    FormsInDoubt doubt;
    const int answer = forms.can_say() ? kernels.classify(forms.lanes(), &box.min.x, &box.max.x, doubt) : body_in_doubt;
    if (answer < open_body) return static_cast<Coverage>(answer);
    if (answer == body_in_doubt) {
        if (!forms.can_say() || (!doubt.is_finite && !has_points(box))) return coverage_without_forms(forms, box);
        if (doubt.is_finite && kernels.sharpen(forms.matrix(), forms.weights(), &box.min.x, &box.max.x, doubt))
            return Coverage::outside;
        const Coverage result = exact_coverage(forms, box, doubt);
        if (result != Coverage::partial) return result;
    }
    return kernels.is_separated(separating(), &box.min.x, &box.max.x) ? Coverage::outside : Coverage::partial;
}

}  // namespace TEXGEN_BUILD
}  // namespace TEXGEN_DETAIL

namespace TEXGEN_NAMESPACE {
inline namespace TEXGEN_BUILD {

template <class Space>
LitVolume<Space>::LitVolume(const Transform<Texture, Space>& texture_from_space, const TextureRegion& region) noexcept
    : forms_(texture_from_space.matrix(), region, detail::chosen<detail::FormKernels>()),
      float_forms_(forms_.in_float(detail::chosen<detail::FloatFormKernels>())),
      unit_forms_(forms_.unit(detail::chosen<detail::UnitFormKernels>())),
      separating_(forms_.separating(detail::chosen<detail::SeparatingFormKernels>())) {}

template <class Space>
Coverage LitVolume<Space>::coverage(const Box& box) const noexcept {
    return detail::coverage_of(detail::chosen<detail::BoxKernels>(), forms_, box,
                               [this]() -> const detail::SeparatingForms& { return separating_; });
}
template <class Space>
Coverage LitVolume<Space>::coverage(const Sphere& sphere) const noexcept {
    return detail::coverage_of(
        forms_, unit_forms_, [](std::size_t) { return 1.0; },
        [this]() -> const detail::UnitForms& { return unit_forms_; }, sphere);
}

template <class Space>
void LitVolume<Space>::coverage(std::span<const Box> boxes, std::span<Coverage> out) const noexcept {
    TEXGEN_ASSERT(boxes.size() == out.size());
    detail::cover(forms_, float_forms_, separating_, boxes, out);
}
template <class Space>
void LitVolume<Space>::coverage(std::span<const Sphere> spheres, std::span<Coverage> out) const noexcept {
    TEXGEN_ASSERT(spheres.size() == out.size());
    detail::cover(forms_, float_forms_, unit_forms_, spheres, out);
}

// One body needs no forms in float.
template <class Space>
Coverage coverage(const Transform<Texture, Space>& texture_from_space, const TextureRegion& region,
                  const Box& box) noexcept {
    const detail::LitForms forms(texture_from_space.matrix(), region, detail::chosen<detail::FormKernels>());
    return detail::coverage_of(detail::chosen<detail::BoxKernels>(), forms, box,
                               [&] { return forms.separating(detail::chosen<detail::SeparatingFormKernels>()); });
}
template <class Space>
Coverage coverage(const Transform<Texture, Space>& texture_from_space, const TextureRegion& region,
                  const Sphere& sphere) noexcept {
    const detail::LitForms forms(texture_from_space.matrix(), region, detail::chosen<detail::FormKernels>());
    return detail::coverage_of(
        forms, forms.lanes(), [&](std::size_t k) { return forms.slope(k); },
        [&] { return forms.unit(detail::chosen<detail::UnitFormKernels>()); }, sphere);
}
template <class Space>
void coverage(const Transform<Texture, Space>& texture_from_space, const TextureRegion& region,
              std::span<const Box> boxes, std::span<Coverage> out) noexcept {
    LitVolume<Space>(texture_from_space, region).coverage(boxes, out);
}
template <class Space>
void coverage(const Transform<Texture, Space>& texture_from_space, const TextureRegion& region,
              std::span<const Sphere> spheres, std::span<Coverage> out) noexcept {
    TEXGEN_ASSERT(spheres.size() == out.size());
    const detail::LitForms forms(texture_from_space.matrix(), region, detail::chosen<detail::FormKernels>());
    detail::cover(forms, forms.in_float(detail::chosen<detail::FloatFormKernels>()),
                  forms.unit(detail::chosen<detail::UnitFormKernels>()), spheres, out);
}

}  // namespace TEXGEN_BUILD
}  // namespace TEXGEN_NAMESPACE
