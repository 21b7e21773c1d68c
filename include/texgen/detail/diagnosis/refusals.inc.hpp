// What diagnose.hpp says of a lens and an aim that make no projector.

namespace TEXGEN_DETAIL {

inline void require_finite(std::initializer_list<double> numbers, Diagnosis& diagnosis) noexcept {
    for (const double number : numbers)
        if (!is_finite(number)) diagnosis.add(Defect::not_finite);
}

// Adds the defect where the rule is broken by finite numbers; require_finite() speaks of others.
inline void refuse_unless(bool keeps_rule, std::initializer_list<double> numbers, Defect defect,
                          Diagnosis& diagnosis) noexcept {
    bool all_finite = true;
    for (const double number : numbers) all_finite = all_finite && is_finite(number);
    if (all_finite && !keeps_rule) diagnosis.add(defect);
}

// Examines the planes of a lens whose far plane may be infinitely far.
inline void examine_planes(double z_near, double z_far, Diagnosis& diagnosis) noexcept {
    require_finite({z_near, z_far == infinity ? 0.0 : z_far}, diagnosis);
    refuse_unless(z_near > 0.0, {z_near}, Defect::near_not_in_front, diagnosis);
    refuse_unless(z_near < z_far, {z_near, z_far}, Defect::far_not_beyond_near, diagnosis);
}

void examine_rectangle(const auto& lens, Diagnosis& diagnosis) noexcept {
    require_finite({lens.left, lens.right, lens.bottom, lens.top, lens.z_near, lens.z_far}, diagnosis);
    refuse_unless(lens.left != lens.right, {lens.left, lens.right}, Defect::lens_without_extent, diagnosis);
    refuse_unless(lens.bottom != lens.top, {lens.bottom, lens.top}, Defect::lens_without_extent, diagnosis);
    refuse_unless(lens.z_near < lens.z_far, {lens.z_near, lens.z_far}, Defect::far_not_beyond_near, diagnosis);
}

inline void examine(const PerspectiveLens& lens, Diagnosis& diagnosis) noexcept {
    const double angle = lens.fovy.in_radians();
    require_finite({angle, lens.aspect}, diagnosis);
    const bool exceeds_a_turn = std::fabs(angle) > 2.0 * std::numbers::pi;
    // Not half the angle, as in perspective(): where that half is 0 the angle is in range, and its lens beyond double.
    refuse_unless(angle > 0.0 && 0.5 * angle < 0.5 * std::numbers::pi, {angle},
                  exceeds_a_turn ? Defect::angle_unit_mistaken : Defect::angle_out_of_range, diagnosis);
    refuse_unless(lens.aspect > 0.0, {lens.aspect}, Defect::aspect_not_positive, diagnosis);
    examine_planes(lens.z_near, lens.z_far, diagnosis);
}
inline void examine(const FrustumLens& lens, Diagnosis& diagnosis) noexcept {
    examine_rectangle(lens, diagnosis);
    refuse_unless(lens.z_near > 0.0, {lens.z_near}, Defect::near_not_in_front, diagnosis);
}
inline void examine(const OrthographicLens& lens, Diagnosis& diagnosis) noexcept { examine_rectangle(lens, diagnosis); }
inline void examine(const PinholeLens& lens, Diagnosis& diagnosis) noexcept {
    require_finite({lens.fx, lens.fy, lens.cx, lens.cy, lens.width, lens.height, lens.skew}, diagnosis);
    refuse_unless(lens.fx > 0.0, {lens.fx}, Defect::focal_length_not_positive, diagnosis);
    refuse_unless(lens.fy > 0.0, {lens.fy}, Defect::focal_length_not_positive, diagnosis);
    refuse_unless(lens.width > 0.0, {lens.width}, Defect::picture_without_size, diagnosis);
    refuse_unless(lens.height > 0.0, {lens.height}, Defect::picture_without_size, diagnosis);
    examine_planes(lens.z_near, lens.z_far, diagnosis);
}

inline void examine(const Aim& aim, Diagnosis& diagnosis) noexcept {
    const auto is_number = [&](const glm::dvec3& v) {
        require_finite({v.x, v.y, v.z}, diagnosis);
        return is_finite(v);
    };
    const bool has_position = is_number(aim.position), has_target = is_number(aim.target), has_up = is_number(aim.up);
    // As look_at() decides.
    const Difference view = scaled_difference(aim.target, aim.position);
    const glm::dvec3 up = scaled_near_one(aim.up);
    const bool has_both = has_position && has_target;
    const bool looks_somewhere = length(view.high) > 0.0, points_somewhere = length(up) > 0.0;
    if (has_both && !looks_somewhere) diagnosis.add(Defect::target_at_position);
    if (has_up && !points_somewhere) diagnosis.add(Defect::up_is_zero);
    if (looks_somewhere && points_somewhere && !is_sideways(cross(view, up), view.high, up))
        diagnosis.add(Defect::up_parallel_to_view);
}

Diagnosis diagnose(const auto& lens, const Aim& aim, const Conventions& conventions) noexcept {
    Diagnosis diagnosis;
    if (make_projector(lens, aim, conventions)) return diagnosis;
    examine(lens, diagnosis);
    examine(aim, diagnosis);
    if (diagnosis.empty()) diagnosis.add(Defect::beyond_double);
    return diagnosis;
}

}  // namespace TEXGEN_DETAIL

namespace TEXGEN_NAMESPACE {

inline Diagnosis diagnose(const PerspectiveLens& lens, const Aim& aim, const Conventions& conventions) noexcept {
    return detail::diagnose(lens, aim, conventions);
}
inline Diagnosis diagnose(const FrustumLens& lens, const Aim& aim, const Conventions& conventions) noexcept {
    return detail::diagnose(lens, aim, conventions);
}
inline Diagnosis diagnose(const OrthographicLens& lens, const Aim& aim, const Conventions& conventions) noexcept {
    return detail::diagnose(lens, aim, conventions);
}
inline Diagnosis diagnose(const PinholeLens& lens, const Aim& aim, const Conventions& conventions) noexcept {
    return detail::diagnose(lens, aim, conventions);
}

}  // namespace TEXGEN_NAMESPACE
