// What diagnose.hpp says of a projector: of its lens and its view.

namespace TEXGEN_DETAIL {

// Whether a matrix holds numbers to go on with; if not, says why.
inline bool examine_usable(const glm::dmat4& m, Diagnosis& diagnosis) noexcept {
    const bool has_numbers = is_finite(m), is_written = m != glm::dmat4(0.0);
    if (!has_numbers) diagnosis.add(Defect::not_finite);
    if (!is_written) diagnosis.add(Defect::never_written);
    return has_numbers && is_written;
}

// Where nothing is known of a lens, round numbers may show its mistakes.
inline void examine_numbers(const glm::dmat4& p, bool is_upright, const Conventions& conventions,
                            const LensFacts& facts, Diagnosis& diagnosis) noexcept {
    const SeenLens seen(lens_factor(p), rounding_of(p));
    if (!seen.is_lens()) return;
    const double focal_length = seen.focal_length().y;
    if (!facts.fovy && is_upright && seen.is_centred_on(glm::dvec2(0.0)) &&
        !is_of_round_angle({focal_length, seen.error_of_focal_length()}) &&
        is_of_degrees_as_radians(seen, focal_length, conventions.ndc_y == NdcY::up ? 1.0 : -1.0))
        diagnosis.add(Defect::angle_unit_mistaken);
    if (!facts.z_near && !facts.z_far &&
        is_round_in_other_range(seen, *depth_ends(DepthMapping::ndc, conventions), true))
        diagnosis.add(Defect::depth_range_mismatch);
}

inline void examine_lens(const glm::dmat4& p, bool view_reflects, const Conventions& conventions,
                         const LensFacts& facts, const Picture& picture, Diagnosis& diagnosis) noexcept {
    const bool is_away = looks_away(p, conventions.handedness);
    const double x = p[0].x, y = conventions.ndc_y == NdcY::up ? p[1].y : -p[1].y;
    // Where both axes of the picture are turned round as well, the whole matrix has the other sign.
    const double unit = !is_perspective(p) ? p[3].w : std::fabs(p[2].w) * (is_away && x < 0.0 && y < 0.0 ? -1.0 : 1.0);
    const double width = x / unit, height = y / unit;
    if (unit < 0.0)
        diagnosis.add(Defect::everything_behind);
    else if (is_away)
        diagnosis.add(Defect::mixed_handedness);
    if (mistakes_depth(p, conventions.depth, conventions.handedness, facts.z_near, facts.z_far))
        diagnosis.add(Defect::depth_range_mismatch);
    if (is_perspective(p) && facts.fovy && mistakes_unit(height, *facts.fovy))
        diagnosis.add(Defect::angle_unit_mistaken);

    if (!facts.mirrored) {
        // A tangent below 0 turns both axes round: no lens has one, but an angle in the wrong unit may.
        if (view_reflects) {
            if (width * height > 0.0) diagnosis.add(Defect::mirrored);
        } else if (width < 0.0 && height < 0.0) {
            diagnosis.add(Defect::angle_unit_mistaken);
        } else if (width < 0.0) {
            diagnosis.add(Defect::mirrored);
        } else if (height < 0.0) {
            diagnosis.add(Defect::upside_down);
        }
    }

    examine_numbers(p, width > 0.0 && height > 0.0, conventions, facts, diagnosis);

    const glm::dvec2 size = picture.extent() * picture.texels_per_unit;
    const double meant = facts.aspect ? *facts.aspect : picture.is_measured() ? size.x / size.y : 1.0;
    const double aspect = std::fabs(ratio(height, width));
    // Texels need not be square: without the aspect that was meant only the very inverse, in floats, is a mark.
    const double rounding = facts.aspect ? 0x1p-12 : 0x1p-22;
    if (std::fabs(meant - 1.0) > 0x1p-10 && std::fabs(aspect * meant - 1.0) <= rounding)
        diagnosis.add(Defect::aspect_inverted);
}

inline void examine(const Projector& projector, const LensFacts& facts, const Picture& picture,
                    Diagnosis& diagnosis) noexcept {
    glm::dmat4 p = projector.projection.matrix();
    glm::dmat4 v = projector.view.matrix();
    const bool has_projection = examine_usable(p, diagnosis);
    const bool has_view = examine_usable(v, diagnosis);

    // The view is a lens and the projection is rigid: a view is affine, and a rotation is no lens.
    if (has_projection && has_view && is_lens(v) && distance_from_rigid(p) < 1e-3 &&
        (is_perspective(v) || !is_lens(p))) {
        diagnosis.add(Defect::view_projection_swapped);
        std::swap(p, v);
    }
    if (has_view) {
        if (is_affine_transposed(v)) {
            diagnosis.add(Defect::transposed);
            v = glm::transpose(v);
        }
        if (!are_independent(v, axes)) diagnosis.add(Defect::rank_below_three);
    }
    if (has_projection) {
        if (is_lens_transposed(p)) {
            diagnosis.add(Defect::transposed);
            p = glm::transpose(p);
        }
        const bool regular = are_independent(p, {0, 1, 3});
        if (!regular) diagnosis.add(Defect::rank_below_three);
        const bool view_reflects = has_view && is_affine(v) && minor_of(v, axes, axes).value < 0.0;
        const Conventions conventions = projector.conventions;
        if (is_perspective(p) && !looks_away(p, conventions.handedness) && has_no_depth_in_front(p, conventions.depth))
            diagnosis.add(Defect::near_not_in_front);
        if (regular && is_lens(p)) examine_lens(p, view_reflects, conventions, facts, picture, diagnosis);
    }
}

}  // namespace TEXGEN_DETAIL
