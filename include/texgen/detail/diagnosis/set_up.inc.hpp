// The bodies of diagnose.hpp: all of a set-up together, and what is public.

namespace TEXGEN_DETAIL {

constexpr bool defects_stand_in_order() noexcept {
    for (std::size_t i = 0; i < defect_count; ++i)
        if (defects_in_words[i].defect != static_cast<Defect>(i)) return false;
    return true;
}
static_assert(defects_stand_in_order());

inline void examine(const Composition& composition, bool in_eye_space, Diagnosis& diagnosis) noexcept {
    if (composition.transposed) diagnosis.add(Defect::transposed);
    if (composition.order == Order::view_before_projection) diagnosis.add(Defect::view_projection_swapped);
    if (composition.order == Order::wrong) diagnosis.add(Defect::wrong_order);
    const auto add_pose = [&](PoseUse use, Defect of_camera, Defect of_model) {
        if (composition.pose == use) diagnosis.add(in_eye_space ? of_camera : of_model);
    };
    add_pose(PoseUse::inverted, Defect::camera_not_inverted, Defect::model_inverted);
    add_pose(PoseUse::left_out, Defect::camera_left_out, Defect::model_left_out);
    add_pose(PoseUse::doubled, Defect::camera_inverse_doubled, Defect::model_doubled);
    if (composition.scale_bias == ScaleBiasUse::left_out) diagnosis.add(Defect::scale_bias_missing);
    if (composition.scale_bias == ScaleBiasUse::doubled) diagnosis.add(Defect::scale_bias_doubled);
    if (composition.scale_bias == ScaleBiasUse::without_w) diagnosis.add(Defect::bias_without_w);
    if (composition.other_depth) diagnosis.add(Defect::depth_range_mismatch);
    // With the other sign as well both axes are where they were, and depth is turned round.
    if (composition.s_mirrored && composition.t_mirrored && composition.multiple < 0.0) {
        diagnosis.add(Defect::mixed_handedness);
        return;
    }
    if (composition.t_mirrored) diagnosis.add(Defect::upside_down);
    if (composition.s_mirrored) diagnosis.add(Defect::mirrored);
    if (composition.multiple < 0.0) diagnosis.add(Defect::everything_behind);
}

inline bool are_numbers(const SetupMatrices& setup) noexcept {
    const TextureRegion& region = setup.picture.region;
    const LensFacts& lens = setup.lens;
    // An infinite side of the region is no limit, but a projector's scale-bias does not reach it.
    const auto is_side = [&](const glm::dvec2& side) {
        return setup.projector != nullptr ? is_finite(side) : !std::isnan(side.x) && !std::isnan(side.y);
    };
    const auto is_given_finite = [](const std::optional<double>& value) { return !value || is_finite(*value); };
    const std::optional<glm::dvec2> depth = region.depth();
    return is_side((region.min)()) && is_side((region.max)()) &&
           !(depth && (std::isnan(depth->x) || std::isnan(depth->y))) && is_finite(setup.picture.texels_per_unit) &&
           is_given_finite(lens.aspect) && is_given_finite(lens.z_near) &&
           !(lens.z_far && !(*lens.z_far > -infinity)) && !(lens.fovy && !is_finite(lens.fovy->in_radians()));
}

// Half the bound on the rounding of an element to float, relative to it.
inline constexpr double expected_rounding = 0.5 * unit_roundoff_float;

// The smaller of the two magnitudes of each element.
inline glm::dmat4 smaller_elements(const glm::dmat4& a, const glm::dmat4& b) noexcept {
    glm::dmat4 result(0.0);
    for (glm::length_t k = 0; k < 4; ++k) result[k] = (glm::min)(glm::abs(a[k]), glm::abs(b[k]));
    return result;
}

// What floats lose of the matrix where the product is known: nothing of elements that equal the product's. The rounding
// of others moves the multiple that fits best; a number of few bits next to it is taken for what was meant.
inline glm::dmat4 lost_of(const glm::dmat4& texgen, const Product& right) noexcept {
    const double fitted = Multiple(right, texgen).within(composed_in_float);
    const double large = 0x1p37 * fitted;
    const double of_few_bits = (fitted + large) - large;
    const double multiple = std::fabs(fitted - of_few_bits) < 0x1p-20 * fitted ? of_few_bits : fitted;
    return smaller_elements(texgen - multiple * right.value, expected_rounding * texgen);
}

// Says what else is wrong with a matrix that is no product of its factors. Another mistake hides the product, but
// neither that it is transposed nor what it shows without its pose, which may be what is mistaken. Returns whether it
// is transposed.
inline bool examine_no_product(const glm::dmat4& texgen, const Factors& factors, const SetupMatrices& setup,
                               Diagnosis& diagnosis) noexcept {
    const glm::dmat4 given = as_in_scenes(texgen);
    const bool is_transposed = !setup.in_window && shows_transposed(given);
    if (is_transposed) diagnosis.add(Defect::transposed);
    const glm::dmat4 upright = is_transposed ? glm::transpose(given) : given;
    if (look_through(upright, as_in_scenes(factors), setup, diagnosis)) return is_transposed;
    if (setup.pose != nullptr && !setup.in_window && !is_zero_row(upright, 3)) {
        SetupMatrices without_pose = setup;
        without_pose.pose = nullptr;
        Diagnosis alone;
        examine_alone(upright, without_pose, alone);
        // No order of these factors gives it.
        for (const Finding& finding : alone)
            if (finding.defect != Defect::wrong_order) diagnosis.add(finding.defect);
    }
    diagnosis.add(Defect::not_of_this_set_up);
    return is_transposed;
}

inline Examined examine(const SetupMatrices& setup, Diagnosis& diagnosis) noexcept {
    if (!are_numbers(setup)) diagnosis.add(Defect::not_finite);
    if (is_empty(setup.picture.region)) diagnosis.add(Defect::region_never_hit);
    const glm::dvec2 texels = setup.picture.extent() * setup.picture.texels_per_unit;
    if (setup.picture.is_measured() && !is_empty(setup.picture.region) && smaller(texels.x, texels.y) < 1.0)
        diagnosis.add(Defect::smaller_than_texel, smaller(texels.x, texels.y));

    Examined examined;
    std::optional<Factors> factors;
    if (setup.projector != nullptr) {
        examine(*setup.projector, setup.lens, setup.picture, diagnosis);
        if (setup.is_placed()) {
            const Projector& projector = *setup.projector;
            factors = Factors{texgen::scale_bias(projector.conventions, setup.picture.region, setup.depth).matrix(),
                              projector.projection.matrix(), projector.view.matrix(), std::nullopt};
        }
    }
    if (setup.pose != nullptr) {
        if (!examine_usable(*setup.pose, diagnosis)) factors.reset();
        if (!setup.in_window && is_affine_transposed(*setup.pose)) {
            diagnosis.add(Defect::transposed);
            if (setup.texgen == nullptr) factors.reset();  // of their product nothing is known
        }
        glm::dmat4 turned_and_scaled = *setup.pose;
        turned_and_scaled[3] = glm::dvec4(0.0);
        if (turned_and_scaled == glm::dmat4(0.0)) diagnosis.add(Defect::rank_below_three);
        // The identity is left out: it fits in every order, and would add noise.
        if (factors && *setup.pose != glm::dmat4(1.0)) factors->pose = *setup.pose;
    }
    std::optional<Product> right;
    if (factors) {
        right = right_composition(*factors);
        if (!is_finite(right->value) || right->value == glm::dmat4(0.0)) right.reset();
    }

    if (setup.texgen == nullptr) {
        if (!right) return examined;
        examined.texgen = right->value;
        if (!are_independent(right->value, {0, 1, 3})) diagnosis.add(Defect::rank_below_three);
        const glm::dmat4& view = setup.projector->view.matrix();
        if (is_in_float(view)) {
            const Product lens = scale_bias_factor(*factors, {}) * lens_factor(factors->projection);
            const glm::dmat4 by_view = lens.magnitude * rounded_magnitudes(view);
            const glm::dmat4 by_all = factors->pose ? by_view * lens_factor(*factors->pose).magnitude : by_view;
            examined.lost = expected_rounding * smaller_elements(by_all, right->value);
        }
        return examined;
    }
    const glm::dmat4& texgen = *setup.texgen;
    if (!examine_usable(texgen, diagnosis)) return examined;
    if (is_opengl_default(texgen)) {
        diagnosis.add(Defect::never_written);
        return examined;
    }
    examined.texgen = texgen;
    const bool in_float = setup.are_planes || is_in_float(texgen);
    if (in_float) examined.lost = expected_rounding * rounded_magnitudes(texgen);
    const bool has_q = !is_zero_row(texgen, 3);
    const bool is_dependent = has_q && !are_independent(texgen, {0, 1, 3});
    bool was_transposed = false;
    const auto composition = right ? composition_of(texgen, *factors, *right, in_float) : std::nullopt;
    if (composition) {
        examine(*composition, setup.in_eye_space, diagnosis);
        const bool is_right = mistakes(*composition) == 0 && composition->multiple > 0.0;
        if (is_right) {
            examined.right = right->value;
            if (in_float) examined.lost = lost_of(texgen, *right);
        }
        if (is_right && is_dependent) diagnosis.add(Defect::rank_below_three);
        was_transposed = composition->transposed;
    } else if (is_dependent) {
        diagnosis.add(Defect::rank_below_three);
    } else if (right) {
        was_transposed = examine_no_product(texgen, *factors, setup, diagnosis);
    } else if (has_q && !setup.in_window) {  // a camera's inverse leaves no mark of a lens
        was_transposed = examine_alone(texgen, setup, diagnosis);
    }
    if (!has_q || (was_transposed && is_zero_row(glm::transpose(texgen), 3))) diagnosis.add(Defect::q_row_zero);
    if (!has_q) examined.texgen.reset();
    return examined;
}

template <class Space>
SetupMatrices matrices_of(const ProjectionSetup<Space>& setup, bool are_planes) noexcept {
    return {setup.projector ? &*setup.projector : nullptr,
            setup.world_from_space ? &setup.world_from_space->matrix() : nullptr,
            setup.texgen ? &setup.texgen->matrix() : nullptr,
            are_planes,
            std::is_same_v<Space, World>,
            std::is_same_v<Space, Eye>,
            std::is_same_v<Space, Window>,
            {setup.region, setup.texels_per_unit},
            setup.depth,
            setup.conventions,
            setup.lens};
}

template <class Space>
Diagnosis diagnose(const ProjectionSetup<Space>& setup, bool are_planes) noexcept {
    Diagnosis diagnosis;
    const SetupMatrices matrices = matrices_of(setup, are_planes);
    const Examined examined = examine(matrices, diagnosis);
    PointReport report(examined, matrices.picture, matrices.depth);
    const std::size_t count = setup.points ? setup.points->size() : 0;
    for (std::size_t i = 0; i < count; ++i) report.add(widened((*setup.points)[i]));
    report.conclude(diagnosis);
    return diagnosis;
}

}  // namespace TEXGEN_DETAIL

namespace TEXGEN_NAMESPACE {

inline std::string_view Finding::what() const noexcept {
    return defects_in_words[static_cast<std::size_t>(defect)].what;
}
inline std::string_view Finding::remedy() const noexcept {
    return defects_in_words[static_cast<std::size_t>(defect)].remedy;
}

inline bool Diagnosis::contains(Defect defect) const noexcept {
    for (const Finding& finding : *this)
        if (finding.defect == defect) return true;
    return false;
}

inline void Diagnosis::add(Defect defect, double number) noexcept {
    if (contains(defect)) return;
    std::size_t i = size_++;
    for (; i > 0 && defect < findings_[i - 1].defect; --i) findings_[i] = findings_[i - 1];
    findings_[i] = {defect, number};
}

template <class Space>
Diagnosis diagnose(const ProjectionSetup<Space>& setup) noexcept {
    return detail::diagnose(setup, false);
}

inline Diagnosis diagnose(const Projector& projector) noexcept {
    Diagnosis diagnosis;
    const detail::Examined examined = detail::examine({.projector = &projector, .in_world_space = true}, diagnosis);
    detail::PointReport(examined, {}, DepthMapping::unit).conclude(diagnosis);
    return diagnosis;
}

template <class Space>
Diagnosis diagnose(const Transform<Texture, Space>& texgen,
                   const ProjectionSetup<std::type_identity_t<Space>>& setup) noexcept {
    ProjectionSetup<Space> whole = setup;
    whole.texgen = texgen;
    return detail::diagnose(whole, false);
}

template <class Space>
Diagnosis diagnose(const std::array<glm::vec4, 4>& planes, const ProjectionSetup<Space>& setup) noexcept {
    const glm::dmat4 rows(detail::widened(planes[0]), detail::widened(planes[1]), detail::widened(planes[2]),
                          detail::widened(planes[3]));
    ProjectionSetup<Space> whole = setup;
    whole.texgen.emplace(glm::transpose(rows));
    return detail::diagnose(whole, true);
}

}  // namespace TEXGEN_NAMESPACE
