// The bodies of the lenses of projector.hpp.

namespace TEXGEN_DETAIL {

// What lenses need of two numbers: their sum and difference, both in halves where a sum could leave the range.
// (Elsewhere halves would lose the last bit of subnormal numbers.)
class LensExtent {
public:
    LensExtent(double from, double to) noexcept : unit_(larger(std::fabs(from), std::fabs(to)) < 0x1p1000 ? 1.0 : 0.5) {
        sum_ = unit_ * to + unit_ * from;
        difference_ = unit_ * to - unit_ * from;
    }

    // (to + from) / (to - from), and number / (to - from) for one of the two.
    double sum_over_length() const noexcept { return sum_ / difference_; }
    double end_over_length(double end) const noexcept { return unit_ * end / difference_; }

    // 2 number / (to - from), where neither twice the number nor half the difference leaves the range on the way.
    double twice_over_length(double number) const noexcept {
        if (unit_ < 1.0) return number / difference_;
        return std::fabs(difference_) < 1.0 ? 2.0 * number / difference_ : number / (0.5 * difference_);
    }

private:
    double unit_, sum_, difference_;
};

// Row z of a lens: clip z = scale * z_eye + offset. Clip w is -z_eye, or 1 of parallel rays.
struct DepthRow {
    double scale, offset;
};

DepthRow perspective_depth(const auto& lens, DepthRange range) noexcept {
    const bool infinite = !is_finite(lens.z_far);
    const LensExtent depth(lens.z_near, lens.z_far);
    const double far_ratio = infinite ? 1.0 : depth.end_over_length(lens.z_far);    // far / (far - near)
    const double near_ratio = infinite ? 0.0 : depth.end_over_length(lens.z_near);  // near / (far - near)
    if (range == DepthRange::negative_one_to_one) {
        const double scale = infinite ? 1.0 : depth.sum_over_length();
        const double offset = lens.z_near * (2.0 * far_ratio);
        return lens.reversed_depth ? DepthRow{scale, offset} : DepthRow{-scale, -offset};
    }
    return lens.reversed_depth ? DepthRow{near_ratio, lens.z_near * far_ratio}
                               : DepthRow{-far_ratio, -lens.z_near * far_ratio};
}

inline DepthRow orthographic_depth(const OrthographicLens& lens, DepthRange range) noexcept {
    const LensExtent depth(lens.z_near, lens.z_far);
    if (range == DepthRange::negative_one_to_one) {
        const double scale = depth.twice_over_length(1.0), offset = depth.sum_over_length();
        return lens.reversed_depth ? DepthRow{scale, offset} : DepthRow{-scale, -offset};
    }
    const double scale = depth.twice_over_length(0.5);
    return lens.reversed_depth ? DepthRow{scale, depth.end_over_length(lens.z_far)}
                               : DepthRow{-scale, -depth.end_over_length(lens.z_near)};
}

// Takes the matrix of a lens for a right-handed eye and y up to the conventions; empty where doubles cannot hold it.
inline std::optional<ProjectorProjection> checked_projection(const glm::dmat4& in_right_hand,
                                                             const Conventions& conventions) noexcept {
    glm::dmat4 matrix = in_right_hand;
    if (conventions.handedness == Handedness::left) matrix[2] = -matrix[2];
    if (conventions.ndc_y == NdcY::down)
        for (glm::length_t column = 0; column < 4; ++column) matrix[column][1] = -matrix[column][1];
    const bool usable = is_finite(matrix) && matrix[0][0] != 0.0 && matrix[1][1] != 0.0;
    return usable ? std::optional(ProjectorProjection(matrix)) : std::nullopt;
}

// The perspective matrix: the focal lengths on the diagonal, the skew beside them, the off-axis terms in column z.
inline std::optional<ProjectorProjection> checked_perspective(const glm::dvec2& focal_length, double skew,
                                                              const glm::dvec2& off_axis, const DepthRow& depth,
                                                              const Conventions& conventions) noexcept {
    glm::dmat4 matrix(0.0);
    matrix[0][0] = focal_length.x;
    matrix[1][0] = skew;
    matrix[1][1] = focal_length.y;
    matrix[2] = {off_axis.x, off_axis.y, depth.scale, -1.0};
    matrix[3][2] = depth.offset;
    return checked_projection(matrix, conventions);
}

// 1 - 2 centre / size, where the centre is counted from the middle of the first pixel, or from its edge. Nothing is
// rounded before the sum; where that could leave the range all is divided by 4.
inline double off_axis_term(double centre, double size, PixelCentre convention) noexcept {
    const double unit = larger(std::fabs(centre), size) < 0x1p1000 ? 1.0 : 0.25;
    Expansion<3> sum;
    sum.add(unit * size);
    sum.add(-(2.0 * unit) * centre);
    sum.add(convention == PixelCentre::integer ? -unit : 0.0);
    return sum.estimate() / (unit * size);
}

}  // namespace TEXGEN_DETAIL

namespace TEXGEN_NAMESPACE {

inline std::optional<ProjectorProjection> perspective(const PerspectiveLens& lens,
                                                      const Conventions& conventions) noexcept {
    const double half_angle = 0.5 * lens.fovy.in_radians();
    if (!detail::is_half_angle(half_angle)) return std::nullopt;
    if (!detail::is_aspect(lens.aspect)) return std::nullopt;
    if (!(lens.z_near > 0.0 && lens.z_near < lens.z_far)) return std::nullopt;
    // cos / sin and not 1 / tan: two functions within an ulp and one division, at any angle whose half is exact.
    const double focal_length =
        half_angle < 0x1p-30 ? 2.0 / lens.fovy.in_radians() : std::cos(half_angle) / std::sin(half_angle);
    return detail::checked_perspective({focal_length / lens.aspect, focal_length}, 0.0, glm::dvec2(0.0),
                                       detail::perspective_depth(lens, conventions.depth), conventions);
}

inline std::optional<ProjectorProjection> frustum(const FrustumLens& lens, const Conventions& conventions) noexcept {
    if (!(lens.z_near > 0.0 && lens.z_near < lens.z_far && detail::is_finite(lens.z_far))) return std::nullopt;
    const detail::LensExtent width(lens.left, lens.right);
    const detail::LensExtent height(lens.bottom, lens.top);
    return detail::checked_perspective({width.twice_over_length(lens.z_near), height.twice_over_length(lens.z_near)},
                                       0.0, {width.sum_over_length(), height.sum_over_length()},
                                       detail::perspective_depth(lens, conventions.depth), conventions);
}

inline std::optional<ProjectorProjection> orthographic(const OrthographicLens& lens,
                                                       const Conventions& conventions) noexcept {
    if (!(lens.z_near < lens.z_far && detail::is_finite(lens.z_near) && detail::is_finite(lens.z_far)))
        return std::nullopt;
    const detail::LensExtent width(lens.left, lens.right);
    const detail::LensExtent height(lens.bottom, lens.top);
    const detail::DepthRow depth = detail::orthographic_depth(lens, conventions.depth);
    glm::dmat4 matrix(0.0);
    matrix[0][0] = width.twice_over_length(1.0);
    matrix[1][1] = height.twice_over_length(1.0);
    matrix[2][2] = depth.scale;
    matrix[3][0] = -width.sum_over_length();
    matrix[3][1] = -height.sum_over_length();
    matrix[3][2] = depth.offset;
    matrix[3][3] = 1.0;
    return detail::checked_projection(matrix, conventions);
}

// With the camera's x = x_eye, y = -y_eye and z = -z_eye: u = (fx x + skew y) / z + cx, and NDC x = 2 u / width - 1.
inline std::optional<ProjectorProjection> pinhole(const PinholeLens& lens, const Conventions& conventions) noexcept {
    if (!(lens.fx > 0.0 && lens.fy > 0.0 && lens.width > 0.0 && lens.height > 0.0)) return std::nullopt;
    if (!(detail::is_finite(lens.width) && detail::is_finite(lens.height))) return std::nullopt;
    if (!(lens.z_near > 0.0 && lens.z_near < lens.z_far)) return std::nullopt;
    const detail::LensExtent width(0.0, lens.width);
    const detail::LensExtent height(0.0, lens.height);
    return detail::checked_perspective({width.twice_over_length(lens.fx), height.twice_over_length(lens.fy)},
                                       -width.twice_over_length(lens.skew),
                                       {detail::off_axis_term(lens.cx, lens.width, lens.centre),
                                        -detail::off_axis_term(lens.cy, lens.height, lens.centre)},
                                       detail::perspective_depth(lens, conventions.depth), conventions);
}

}  // namespace TEXGEN_NAMESPACE
