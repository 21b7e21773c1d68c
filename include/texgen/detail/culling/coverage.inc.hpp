// Boxes against the forms of a slide: in floats, in double, and at last exactly; and the bodies of coverage.hpp.

namespace TEXGEN_DETAIL {

// The coverage of a box where the forms cannot be asked.
inline Coverage coverage_without_forms(const LitForms& forms, const Box& box) noexcept {
    bool is_empty = false;
    for (glm::length_t j = 0; j < 3; ++j) {
        if (std::isnan(box.min[j]) || std::isnan(box.max[j])) return Coverage::partial;
        is_empty = is_empty || box.min[j] > box.max[j];
    }
    return is_empty || forms.lights_nothing ? Coverage::outside : Coverage::partial;
}

// Whether a box holds a point that is a number. An extent is a NaN where a side is, or both are the same infinity.
inline bool has_points(const Box& box) noexcept {
    bool result = true;
    for (glm::length_t j = 0; j < 3; ++j) result = result && widened(box.max[j]) - widened(box.min[j]) >= 0.0;
    return result;
}

inline namespace TEXGEN_BUILD {

// Classifies many boxes; separating() as below.
void coverage_of_many(const LitForms& forms, const FloatForms& float_forms, const auto& separating,
                      const std::span<const Box>& boxes, const std::span<Coverage>& out) noexcept {
    const BoxBatchKernels& kernels = chosen<BoxBatchKernels>();
    DoubleForms double_forms;  // made when first needed
    classify_many<6>(forms, float_forms, boxes, out, kernels.classify,
                     [&](const OpenRow* open, std::size_t count, bool is_any_in_doubt, int* classes) {
                         if (is_any_in_doubt && double_forms.count == 0) forms.take_in_double(double_forms);
                         kernels.decide(is_any_in_doubt ? &double_forms : nullptr, separating(), open, count, classes);
                     });
}

// Classifies a box. separating() gives further planes, which are asked whether a box that seems partial is outside.
Coverage coverage_of(const BoxKernels& kernels, const LitForms& forms, const Box& box,
                     const auto& separating) noexcept {
    const float *const min = &box.min.x, *const max = &box.max.x;
    const int answer = forms.can_say() ? kernels.classify(forms.lanes, min, max) : body_in_doubt;
    if (answer < open_body) return static_cast<Coverage>(answer);
    if (answer != open_body + static_cast<int>(Coverage::partial)) {
        if (!forms.can_say() || !has_points(box)) return coverage_without_forms(forms, box);
        const int decided = kernels.decide(answer, forms.matrix, forms.outer, forms.inner, min, max);
        if (decided != static_cast<int>(Coverage::partial)) return static_cast<Coverage>(decided);
    }
    return kernels.is_separated(separating(), min, max) ? Coverage::outside : Coverage::partial;
}

}  // namespace TEXGEN_BUILD
}  // namespace TEXGEN_DETAIL

namespace TEXGEN_NAMESPACE_BUILD {

template <class Space>
LitVolume<Space>::LitVolume(const Transform<Texture, Space>& texture_from_space, const TextureRegion& region) noexcept
    : forms_(texture_from_space.matrix(), region, detail::chosen<detail::FormKernels>()),
      float_forms_(forms_.in_float(detail::chosen<detail::FloatFormKernels>())),
      unit_forms_(forms_.unit()),
      separating_(forms_.separating(detail::chosen<detail::SeparatingPlaneKernels>())) {}

template <class Space>
Coverage LitVolume<Space>::coverage(const Box& box) const noexcept {
    return detail::coverage_of(detail::chosen<detail::BoxKernels>(), forms_, box,
                               [this]() -> const detail::SeparatingPlanes& { return separating_; });
}
template <class Space>
Coverage LitVolume<Space>::coverage(const Sphere& sphere) const noexcept {
    return detail::coverage_of(
        forms_, unit_forms_, [](std::size_t) { return 1.0; },
        [this]() -> const detail::UnitForms& { return unit_forms_; }, sphere);
}

template <class Space>
void LitVolume<Space>::coverage(const std::span<const Box>& boxes, const std::span<Coverage>& out) const noexcept {
    detail::coverage_of_many(
        forms_, float_forms_, [this]() -> const detail::SeparatingPlanes& { return separating_; }, boxes, out);
}
template <class Space>
void LitVolume<Space>::coverage(const std::span<const Sphere>& spheres, const std::span<Coverage>& out) const noexcept {
    detail::coverage_of_many(forms_, float_forms_, unit_forms_, spheres, out);
}

// For a single body no forms are made in float.
template <class Space>
Coverage coverage(const Transform<Texture, Space>& texture_from_space, const TextureRegion& region,
                  const Box& box) noexcept {
    const detail::LitForms forms(texture_from_space.matrix(), region, detail::chosen<detail::FormKernels>());
    return detail::coverage_of(detail::chosen<detail::BoxKernels>(), forms, box,
                               [&] { return forms.separating(detail::chosen<detail::SeparatingPlaneKernels>()); });
}
template <class Space>
Coverage coverage(const Transform<Texture, Space>& texture_from_space, const TextureRegion& region,
                  const Sphere& sphere) noexcept {
    const detail::LitForms forms(texture_from_space.matrix(), region, detail::chosen<detail::FormKernels>());
    return detail::coverage_of(
        forms, forms.lanes, [&](std::size_t k) { return forms.slope(k); }, [&] { return forms.unit(); }, sphere);
}
template <class Space>
void coverage(const Transform<Texture, Space>& texture_from_space, const TextureRegion& region,
              const std::span<const Box>& boxes, const std::span<Coverage>& out) noexcept {
    const detail::LitForms forms(texture_from_space.matrix(), region, detail::chosen<detail::FormKernels>());
    detail::OnDemand<detail::SeparatingPlanes> separating;
    detail::coverage_of_many(
        forms, forms.in_float(detail::chosen<detail::FloatFormKernels>()),
        [&]() -> const detail::SeparatingPlanes& {
            if (!separating) separating.make(forms.separating(detail::chosen<detail::SeparatingPlaneKernels>()));
            return *separating;
        },
        boxes, out);
}
template <class Space>
void coverage(const Transform<Texture, Space>& texture_from_space, const TextureRegion& region,
              const std::span<const Sphere>& spheres, const std::span<Coverage>& out) noexcept {
    const detail::LitForms forms(texture_from_space.matrix(), region, detail::chosen<detail::FormKernels>());
    detail::coverage_of_many(forms, forms.in_float(detail::chosen<detail::FloatFormKernels>()), forms.unit(), spheres,
                             out);
}

}  // namespace TEXGEN_NAMESPACE_BUILD
