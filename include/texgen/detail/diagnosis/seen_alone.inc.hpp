// What diagnose.hpp says of a texgen matrix whose projector is not given. Rows s, t and q of a perspective have the
// lens in them, whatever its view: lengths and angles do not change under rotations.

namespace TEXGEN_DETAIL {

// Whether near or far, where they are known, land on an end of the other range, or infinity lands where they put it in
// that range: the latter holds in any units.
inline bool lands_on_other_range(const SeenLens& lens, const DepthEnds& ends, const LensFacts& facts,
                                 bool is_placed) noexcept {
    for (const auto& distance : {facts.z_near, facts.z_far}) {
        if (!is_placed || !distance || !(*distance > 0.0)) continue;
        const Estimate r = lens.r_at(*distance);
        for (const double other : ends.other_lows)
            if (r.error < 0x1p-5 && std::fabs(r.value - other) <= 0x1p-12 + 4.0 * r.error) return true;
    }
    if (!facts.z_near || !facts.z_far || !(*facts.z_far > *facts.z_near)) return false;
    // Planes that were taken from a projector in float are known to 2^-22 at best.
    const double accepted = 4.0 * larger(lens.rounding(), 0x1p-22);
    const double beyond = *facts.z_near / (*facts.z_far - *facts.z_near);
    if (!(beyond > 16.0 * accepted)) return false;
    for (const double other : ends.other_lows)
        for (const double in_range : {1.0 + beyond, -beyond})
            if (std::fabs(lens.limit() - (other + (1.0 - other) * in_range)) <= accepted) return true;
    return false;
}

// The texgen matrix of the world, as far as the pose is known: without it.
inline Product in_the_world(const glm::dmat4& texgen, const glm::dmat4* pose) noexcept {
    const Product given = lens_factor(texgen);
    if (pose == nullptr) return given;
    const CertifiedInverse inverse(*pose);
    return inverse.is_regular() ? given * lens_factor(inverse.matrix()) : given;
}

// S as it should be. A lens misses it whose axis goes to (0, 0), and doubles it where that goes to the bias of S S; in
// the other order its scale is applied to its bias as well.
struct SeenScaleBias {
    glm::dvec2 scale, bias, scaled_bias, bias_of_two;
    double up_along_t;  // 1 where t grows upwards, -1 downwards, 0 where that is not known

    bool is_missed_by(const SeenLens& lens) const noexcept {
        return lens.is_centred_on(glm::dvec2(0.0)) && !lens.is_centred_on(bias);
    }
    bool is_in_other_order_by(const SeenLens& lens) const noexcept {
        return lens.is_centred_on(scaled_bias) && !lens.is_centred_on(bias);
    }
    bool is_doubled_by(const SeenLens& lens) const noexcept {
        return lens.is_centred_on(bias_of_two) && !lens.is_centred_on(bias);
    }
};
inline std::optional<Conventions> known_conventions(const SetupMatrices& setup) noexcept {
    return setup.projector != nullptr ? std::optional(setup.projector->conventions) : setup.conventions;
}
inline SeenScaleBias seen_scale_bias(const SetupMatrices& setup) noexcept {
    const std::optional<Conventions> conventions = known_conventions(setup);
    const glm::dmat4 s = texgen::scale_bias(conventions.value_or(opengl), setup.picture.region, setup.depth).matrix();
    const glm::dvec4 bias_of_two = s * s[3];
    const double up_along_t = !conventions ? 0.0 : conventions->origin == TextureOrigin::bottom_left ? 1.0 : -1.0;
    return {{std::fabs(s[0].x), std::fabs(s[1].y)},
            {s[3].x, s[3].y},
            {s[0].x * s[3].x, s[1].y * s[3].y},
            {bias_of_two.x, bias_of_two.y},
            up_along_t};
}

// For a lens whose axis goes to the picture's corner: whether `near`, by row r, is a round number if the lens is a
// quarter of another, by a bias without w, or only if it is a whole lens without a bias. Empty where r has no bias, or
// none is known.
struct RoundNear {
    bool of_quarter, of_whole;
};
inline std::optional<RoundNear> round_near(const SeenLens& lens, const SetupMatrices& setup) noexcept {
    constexpr double enough_bits = 8.0;
    const std::optional<Conventions> conventions = known_conventions(setup);
    if (!conventions || conventions->depth == DepthRange::zero_to_one || setup.depth == DepthMapping::ndc)
        return std::nullopt;
    const double of_quarter = roundness(lens.distance_of(0.0));
    return RoundNear{of_quarter > enough_bits, !(of_quarter > 0.0) && roundness(lens.distance_of(-1.0)) > enough_bits};
}

// Adds what the lens that is seen shows. Where facts of it are known they decide. Where none are, only numbers that are
// round with a mistake, and not without it, show one: round numbers are what people write.
inline void examine_seen_lens(const SeenLens& lens, const SetupMatrices& setup, const LensFacts& facts,
                              Diagnosis& diagnosis) noexcept {
    const SeenScaleBias s = seen_scale_bias(setup);
    const double error = lens.error_of_focal_length();
    const glm::dvec2 as_clip = lens.focal_length(), in_ndc = as_clip / s.scale;
    const auto is_meant = [&](double focal_length) {
        if (!facts.fovy) return is_of_round_angle({focal_length, error});
        const double half = 0.5 * facts.fovy->in_radians();
        return std::fabs(focal_length * std::sin(half) - std::cos(half)) <=
               larger(4.0 * error, 0x1p-16) * std::cos(half);
    };
    const bool is_missed = s.is_missed_by(lens);
    const std::optional<RoundNear> near_of = is_missed ? round_near(lens, setup) : std::nullopt;
    // A focal length of 1 is also that of a quarter of a lens, with sides as long as its near plane is far.
    const auto shows_meant = [&](double focal_length) {
        return is_meant(focal_length) &&
               (facts.fovy || (near_of && near_of->of_whole) || std::fabs(focal_length - 1.0) > error);
    };
    // The size and the aspect that are seen are the lens's own only where no object can be stretched.
    const bool knows_unit = setup.is_placed() || setup.in_eye_space;
    const bool shows_size = knows_unit || !lens.may_be_stretched();
    const std::optional<DepthEnds> ends = depth_ends(setup.depth, known_conventions(setup));
    // Where w is biased, too, it is halved, and only its size differs.
    const bool halves_w = std::fabs(lens.per_distance() - 0.5) <= 4.0 * lens.rounding();
    if (is_missed && (facts.fovy || halves_w || !(near_of && near_of->of_quarter))) {
        if (shows_meant(as_clip.y) && !halves_w) {
            diagnosis.add(Defect::scale_bias_missing);
            return;
        }
        if (shows_meant(as_clip.y) || shows_meant(as_clip.y / 0.5) || shows_meant(in_ndc.y)) {
            diagnosis.add(Defect::bias_without_w);
            return;
        }
    } else if (facts.fovy && s.is_doubled_by(lens)) {
        // Row r then looks like that of another range, too: nothing more is said.
        if (is_meant(in_ndc.y / s.scale.y)) diagnosis.add(Defect::scale_bias_doubled);
        return;
    } else if (facts.fovy) {
        // A tangent below 0 turns the picture as a view by half a turn does: both signs are asked.
        if (shows_size && !is_meant(in_ndc.y) &&
            (mistakes_unit(in_ndc.y, *facts.fovy) || mistakes_unit(-in_ndc.y, *facts.fovy)))
            diagnosis.add(Defect::angle_unit_mistaken);
    } else if (shows_size && lens.is_centred_on(s.bias) && !is_meant(in_ndc.y) &&
               is_of_degrees_as_radians(lens, in_ndc.y, s.up_along_t)) {
        diagnosis.add(Defect::angle_unit_mistaken);
    }
    // People write an aspect in few digits. A projector's lens has all of them, with which what is stretched seldom agrees
    // by chance.
    const double of_aspect =
        setup.lens.aspect ? 0x1p-12 : larger(0x1p-20, 4.0 * (error + lens.error_of_focal_length(0)));
    if (shows_size && facts.aspect && std::fabs(*facts.aspect - 1.0) > 0x1p-10 &&
        std::fabs(in_ndc.y / in_ndc.x * *facts.aspect - 1.0) <= of_aspect)
        diagnosis.add(Defect::aspect_inverted);
    const bool knows_planes = facts.z_near || facts.z_far;
    if (ends && (knows_planes ? lands_on_other_range(lens, *ends, facts, knows_unit)
                              : is_round_in_other_range(lens, *ends, knows_unit)))
        diagnosis.add(Defect::depth_range_mismatch);
}

// For a matrix whose rows r and q are none of a lens: whether they are when 1/2 is taken from every element, as it is
// added to a glm::mat4. Parallel light is none of it: q would be that of a lens along a diagonal, of a size that no
// view has.
inline bool has_bias_in_every_column(const glm::dmat4& texgen, const glm::dmat4* pose) noexcept {
    const SeenLens lens(in_the_world(texgen - 0.5, pose), rounding_of(texgen));
    return lens.is_lens() && lens.is_centred_on(glm::dvec2(0.0));
}

// Examines a matrix by its own marks. Returns whether it is transposed.
inline bool examine_alone(const glm::dmat4& texgen, const SetupMatrices& setup, Diagnosis& diagnosis) noexcept {
    constexpr double margin = 0x1p-10;
    const DepthRows rows = depth_rows(texgen);
    const SeenLens lens(in_the_world(texgen, setup.pose), rounding_of(texgen));
    const bool shows_lens = lens.is_lens();
    const bool has_bias = !shows_lens && !rows.is_parallel_light && has_bias_in_every_column(texgen, setup.pose);
    // Factors in float show in their product in double what that shows when it is rounded.
    const glm::dmat4 rounded = widened(glm::mat4(texgen));
    const bool may_be_of_floats = rounded != texgen && is_finite(rounded);
    if (may_be_of_floats && !shows_lens && !has_bias) return examine_alone(rounded, setup, diagnosis);
    if (!rows.are_parallel) {
        const bool is_transposed = shows_transposed(texgen);
        diagnosis.add(is_transposed ? Defect::transposed : has_bias ? Defect::bias_without_w : Defect::wrong_order);
        return is_transposed;
    }
    const std::optional<Conventions> conventions = known_conventions(setup);
    const std::size_t found_before = diagnosis.size();
    // As in mistakes_depth(): no range has infinity there.
    if (rows.limit > margin && rows.limit < 1.0 - margin) {
        const SeenScaleBias s = seen_scale_bias(setup);
        diagnosis.add(!shows_lens                    ? Defect::depth_range_mismatch
                      : s.is_missed_by(lens)         ? Defect::bias_without_w
                      : s.is_doubled_by(lens)        ? Defect::scale_bias_doubled
                      : s.is_in_other_order_by(lens) ? Defect::wrong_order
                                                     : Defect::depth_range_mismatch);
    } else if (shows_lens) {
        const glm::dmat4* p = setup.projector != nullptr ? &setup.projector->projection.matrix() : nullptr;
        examine_seen_lens(lens, setup,
                          p != nullptr && is_lens(*p) ? meant_by(*p, *conventions, setup.lens) : setup.lens, diagnosis);
    } else if (has_bias) {
        diagnosis.add(Defect::bias_without_w);
    }
    const bool has_scale_bias =
        !diagnosis.contains(Defect::scale_bias_missing) && !diagnosis.contains(Defect::bias_without_w);
    if (conventions && setup.is_placed() && has_scale_bias && !setup.lens.mirrored &&
        !diagnosis.contains(Defect::mixed_handedness) &&
        is_mirrored(texgen, setup.pose != nullptr ? *setup.pose : glm::dmat4(1.0), *conventions))
        diagnosis.add(Defect::mirrored);
    const bool is_faultless = diagnosis.size() == found_before;
    return may_be_of_floats && is_faultless && examine_alone(rounded, setup, diagnosis);
}

}  // namespace TEXGEN_DETAIL
