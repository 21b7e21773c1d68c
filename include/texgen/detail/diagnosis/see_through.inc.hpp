// What diagnose.hpp says of a texgen matrix that no order and no use of its factors gives: what else it was made of,
// and the lens that is seen through it, P' = S^-1 T X^-1 V^-1.

namespace TEXGEN_DETAIL {

// All of a set-up but its points.
struct SetupMatrices {
    const Projector* projector = nullptr;
    const glm::dmat4* pose = nullptr;    // null: not known, or the points are in the world
    const glm::dmat4* texgen = nullptr;  // null: what the projector and the pose compose
    bool are_planes = false;             // texgen is what hardware holds, in float whatever its numbers
    bool in_world_space = false, in_eye_space = false, in_window = false;
    Picture picture = {};
    DepthMapping depth = DepthMapping::unit;
    std::optional<Conventions> conventions = std::nullopt;
    LensFacts lens = {};

    bool is_placed() const noexcept { return in_world_space || pose != nullptr; }
};

// S^-1 T, or what that does to magnitudes.
inline glm::dmat4 before_scale_bias(const glm::dmat4& given, const glm::dmat4& scale_bias) noexcept {
    glm::dmat4 texgen = given;
    for (glm::length_t column = 0; column < 4; ++column)
        for (glm::length_t row = 0; row < 3; ++row)
            texgen[column][row] = (texgen[column][row] - scale_bias[3][row] * texgen[column][3]) / scale_bias[row][row];
    return texgen;
}
inline glm::dmat4 magnitude_before_scale_bias(const glm::dmat4& given, const glm::dmat4& scale_bias) noexcept {
    glm::dmat4 magnitude = given;
    for (glm::length_t column = 0; column < 4; ++column)
        for (glm::length_t row = 0; row < 3; ++row)
            magnitude[column][row] += 2.0 * std::fabs(scale_bias[3][row] / scale_bias[row][row]) * magnitude[column][3];
    return magnitude;
}

// Whether texgen is the product of these factors, which may have been composed in float.
inline bool is_product_of(const Factors& factors, const glm::dmat4& texgen) noexcept {
    return Multiple(right_composition(factors), texgen).within(composed_in_float) > 0.0;
}

// Whether the projector's pose stands where its view belongs.
inline bool has_pose_for_view(const glm::dmat4& texgen, const Factors& factors) noexcept {
    const CertifiedInverse inverse(factors.view);
    if (!inverse.is_regular()) return false;
    Factors with_pose = factors;
    with_pose.view = as_in_scenes(inverse.matrix());
    return is_product_of(with_pose, texgen);
}

// Whether the lens is that of the other hand, which looks along the other axis. Of parallel light only r says it.
inline bool has_lens_of_other_hand(const glm::dmat4& texgen, const Factors& factors) noexcept {
    Factors with_other = factors;
    with_other.projection[2] = -factors.projection[2];
    return is_product_of(with_other, texgen);
}

// Whether one of the factors is transposed in the product.
inline bool has_transposed_factor(const glm::dmat4& texgen, const Factors& factors) noexcept {
    Factors with_transposed = factors;
    const auto is_product_with = [&](glm::dmat4& factor) {
        const glm::dmat4 given = factor;
        factor = glm::transpose(given);
        const bool is_product = is_product_of(with_transposed, texgen);
        factor = given;
        return is_product;
    };
    return is_product_with(with_transposed.scale_bias) || is_product_with(with_transposed.projection) ||
           is_product_with(with_transposed.view) || (with_transposed.pose && is_product_with(*with_transposed.pose));
}

// Whether the product has this share of the scale-bias's bias: the scale, where they were multiplied in the other order,
// or nothing.
inline bool has_bias_times(const glm::dvec3& share, const glm::dmat4& texgen, const Factors& factors) noexcept {
    Factors with_share = factors;
    for (glm::length_t row = 0; row < 3; ++row) with_share.scale_bias[3][row] *= share[row];
    return is_product_of(with_share, texgen);
}

// Whether rows s, t and q are those of the product.
inline bool has_other_rows_than_r(const glm::dmat4& texgen, const Factors& factors) noexcept {
    glm::dmat4 rows = texgen;
    for (glm::length_t column = 0; column < 4; ++column) rows[column][2] = 0.0;
    return is_product_of(factors, rows);
}

// P', the projection that a texgen matrix has in it, scaled until its w is as large as that of P. Elements that may be
// the rounding of a zero are 0. Empty where V X is singular, or P' is no lens.
inline std::optional<glm::dmat4> lens_within(const glm::dmat4& texgen, const Factors& factors) noexcept {
    const Product pose = pose_product(factors);
    const CertifiedInverse inverse(pose.value);
    if (!inverse.is_regular()) return std::nullopt;
    const glm::dmat4 back = inverse.matrix();
    glm::dmat4 p = before_scale_bias(texgen, factors.scale_bias) * back;
    const glm::dmat4 terms =
        magnitude_before_scale_bias(absolute(p), factors.scale_bias) * pose.magnitude * absolute(back);
    for (glm::length_t column = 0; column < 4; ++column)
        for (glm::length_t row = 0; row < 4; ++row)
            if (std::fabs(p[column][row]) <= composed_in_float.of_magnitude * terms[column][row]) p[column][row] = 0.0;
    const bool was_perspective = is_perspective(factors.projection);
    const double unit = was_perspective ? p[2].w / factors.projection[2].w : p[3].w / factors.projection[3].w;
    if (is_zero_row(texgen, 2))
        for (glm::length_t column = 0; column < 4; ++column) p[column][2] = unit * factors.projection[column][2];
    if (unit == 0.0) return std::nullopt;
    p *= 1.0 / std::fabs(unit);
    return is_finite(p) && is_lens(p) && is_perspective(p) == was_perspective ? std::optional(p) : std::nullopt;
}

// The distance at which a lens has that depth; infinite where it has that depth nowhere in front.
inline double distance_of(double depth, const glm::dmat4& p, Handedness handedness) noexcept {
    const double per_z = depth * p[2].w - p[2].z;
    const double distance = ahead_of(p, handedness) * ratio(p[3].z - depth * p[3].w, per_z);
    return is_finite(distance) && (distance > 0.0 || !is_perspective(p)) ? distance : infinity;
}

// What a lens was meant to be: what is known of it, and for the rest what the projector's lens is.
inline LensFacts meant_by(const glm::dmat4& p, const Conventions& conventions, const LensFacts& known) noexcept {
    LensFacts facts = known;
    if (!facts.fovy && is_perspective(p) && p[2].x == 0.0 && p[2].y == 0.0)
        facts.fovy = radians(2.0 * std::atan2(std::fabs(p[2].w), std::fabs(p[1].y)));
    if (!facts.aspect) facts.aspect = std::fabs(p[1].y / p[0].x);
    if (!facts.z_near) facts.z_near = distance_of(low_end(conventions.depth), p, conventions.handedness);
    if (!facts.z_far) facts.z_far = distance_of(1.0, p, conventions.handedness);
    facts.mirrored = false;
    return facts;
}

// Looks at the lens in a matrix that is no product of its factors. Adds what it finds; returns whether it found any.
inline bool look_through(const glm::dmat4& texgen, const Factors& factors, const SetupMatrices& setup,
                         Diagnosis& diagnosis) noexcept {
    const auto finds = [&](bool is_there, Defect defect) {
        if (is_there) diagnosis.add(defect);
        return is_there;
    };
    const glm::dmat4& scale_bias = factors.scale_bias;
    if (finds(has_pose_for_view(texgen, factors), Defect::view_not_inverted) ||
        finds(has_lens_of_other_hand(texgen, factors), Defect::mixed_handedness) ||
        finds(has_transposed_factor(texgen, factors), Defect::transposed) ||
        finds(has_bias_times({scale_bias[0].x, scale_bias[1].y, scale_bias[2].z}, texgen, factors),
              Defect::wrong_order) ||
        finds(has_bias_times(glm::dvec3(0.0), texgen, factors), Defect::bias_without_w))
        return true;
    const glm::dmat4& given = factors.projection;
    if (!is_lens(given)) return false;
    auto p = lens_within(texgen, factors);
    if (!p) return false;
    const Conventions conventions = setup.projector->conventions;
    // The projector's own lens may mirror: where it does, P' is turned back, and examined against a lens that does not.
    const double turns_y = conventions.ndc_y == NdcY::up ? 1.0 : -1.0;
    for (glm::length_t column = 0; column < 4; ++column) {
        if (given[0].x < 0.0) (*p)[column].x = -(*p)[column].x;
        if (turns_y * given[1].y < 0.0) (*p)[column].y = -(*p)[column].y;
    }
    Diagnosis of_lens;
    examine_lens(*p, false, conventions, meant_by(given, conventions, setup.lens), setup.picture, of_lens);
    for (const Finding& finding : of_lens) diagnosis.add(finding.defect, finding.number);
    const bool is_of_depth_alone = of_lens.size() == 1 && of_lens.contains(Defect::depth_range_mismatch);
    return !of_lens.empty() && !(is_of_depth_alone && !has_other_rows_than_r(texgen, factors));
}

}  // namespace TEXGEN_DETAIL
