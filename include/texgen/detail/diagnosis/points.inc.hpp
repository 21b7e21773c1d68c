// What diagnose.hpp says of points, seen with a texgen matrix.

namespace TEXGEN_DETAIL {

inline constexpr double accepted_error_in_texels = 0.5;

struct Picture {
    TextureRegion region = whole_texture();
    glm::dvec2 texels_per_unit{};

    bool is_measured() const noexcept { return texels_per_unit.x > 0.0 && texels_per_unit.y > 0.0; }
    glm::dvec2 extent() const noexcept { return (region.max)() - (region.min)(); }

    // Texels per unit; where the texture's size is not known, of a picture of 4096 texels.
    glm::dvec2 texels() const noexcept { return is_measured() ? texels_per_unit : 4096.0 / extent(); }
};

// What the examination of the matrices leaves for the points: the matrix to see them with, which is the given texgen
// matrix or the one that the set-up composes.
struct Examined {
    std::optional<glm::dmat4> texgen, right;  // right: what the set-up composes, where texgen is that but for rounding
    // What floats lose of the texgen matrix, element by element: half the bound on the rounding, where one is rounded.
    glm::dmat4 lost{0.0};
};

// The error of s and t in texels that every lit point has at least: that of the rows' constants where q is largest, on
// the far plane. 0 where that plane is infinitely far, or row r does not show it.
inline double least_error_in_texels(const Examined& examined, const Picture& picture, DepthMapping depth) noexcept {
    const glm::dmat4& texgen = *examined.texgen;
    const DepthRows rows = depth_rows(texgen);
    const double constant = texgen[3].z - rows.limit * texgen[3].w;  // r = limit q + constant
    const double far_end = rows.limit > 0.5 ? 1.0 : depth == DepthMapping::unit ? 0.0 : -1.0;
    const double largest_q = rows.is_parallel_light ? texgen[3].w : ratio(constant, far_end - rows.limit);
    if (!rows.are_parallel || !(largest_q > 0.0)) return 0.0;
    const glm::dvec2 texels = picture.texels();
    const double error = larger(examined.lost[3].x * texels.x, examined.lost[3].y * texels.y) / largest_q;
    return is_finite(error) ? error : 0.0;
}

// What the points say. Each question is whether all of them are on one side of a plane, with the bound on the rounding:
// then their convex hull is too, and no face between them is lit.
class PointReport {
public:
    PointReport(const Examined& examined, const Picture& picture, DepthMapping depth) noexcept
        : has_texgen_(examined.texgen),
          has_right_(examined.right),
          texgen_(rows(examined.texgen)),
          right_(rows(examined.right)),
          lost_(rows(examined.lost)),
          picture_(picture),
          planes_(picture.region) {
        for (std::size_t k = 0; k < outside_.size(); ++k) outside_[k] = k < planes_.size();
        if (has_texgen_) error_in_texels_ = least_error_in_texels(examined, picture, depth);
    }

    void add(const glm::dvec3& v) noexcept {
        if (!is_finite(v)) {
            all_finite_ = false;
            return;
        }
        const Bounded strq[] = {value_at(texgen_[0], v), value_at(texgen_[1], v), value_at(texgen_[2], v),
                                value_at(texgen_[3], v)};
        const Bounded& q = strq[3];
        ++count_;
        behind_ = behind_ && q.value <= -q.error;
        for (std::size_t k = 1; k < planes_.size(); ++k) {
            const Bounded& u = strq[planes_[k].coordinate];
            const double bound = planes_[k].bound;
            const double error =
                u.error + std::fabs(bound) * q.error + gamma(3) * (std::fabs(u.value) + std::fabs(bound * q.value));
            outside_[k] = outside_[k] && planes_[k].at(u.value, q.value) < -error;
        }
        if (q.value == 0.0) {
            all_in_front_ = false;
            return;
        }
        const glm::dvec3 str = glm::dvec3(strq[0].value, strq[1].value, strq[2].value) / q.value;
        const glm::dvec2 st(str.x, str.y);
        // Points that floats have thrown behind the projector are compared, too.
        if (has_right_) compare(v, st);
        if (!(q.value > q.error)) {
            all_in_front_ = false;
            return;
        }
        if (in_front_++ == 0) {
            first_ = v;
            least_ = most_ = st;
        }
        distinct_ = distinct_ || v != first_;
        for (glm::length_t k = 0; k < 2; ++k) {
            least_[k] = smaller(least_[k], st[k]);
            most_[k] = larger(most_[k], st[k]);
        }
        // Where it is known what is right, compare() has measured it.
        if (!has_right_ && is_lit(str)) {
            const double lost_of_q = terms_at(lost_[3], v);
            for (glm::length_t k = 0; k < 2; ++k)
                raise((terms_at(lost_[k == 0 ? 0 : 1], v) + std::fabs(st[k]) * lost_of_q) / q.value,
                      picture_.texels()[k]);
        }
    }

    void conclude(Diagnosis& diagnosis) const noexcept {
        if (!all_finite_) diagnosis.add(Defect::not_finite);
        if (error_in_texels_ > accepted_error_in_texels) diagnosis.add(Defect::precision_lost, error_in_texels_);
        if (count_ == 0 || !has_texgen_) return;
        if (behind_) diagnosis.add(Defect::everything_behind);
        if (!behind_ && outside_[5]) diagnosis.add(Defect::everything_below_depth);
        if (!behind_ && outside_[6]) diagnosis.add(Defect::everything_above_depth);
        for (std::size_t k = 1; k < SlidePlanes::without_depth; ++k)
            if (outside_[k]) diagnosis.add(Defect::region_never_hit);
        const glm::dvec2 texels = picture_.texels();
        const double size = larger((most_.x - least_.x) * texels.x, (most_.y - least_.y) * texels.y);
        if (all_in_front_ && distinct_ && texels.x > 0.0 && texels.y > 0.0 && size < 1.0)
            diagnosis.add(Defect::smaller_than_texel, size);
    }

private:
    // Rows s, t, r and q; zero where there is no matrix.
    static std::array<PointForm, 4> rows(const std::optional<glm::dmat4>& m) noexcept {
        if (!m) return {};
        return {{form(*m, 0), form(*m, 1), form(*m, 2), form(*m, 3)}};
    }

    bool is_lit(const glm::dvec3& str) const noexcept {
        for (std::size_t k = 1; k < planes_.size(); ++k) {
            const auto& [coordinate, sign, bound] = planes_[k];
            if (!(sign * str[coordinate] >= sign * bound)) return false;
        }
        return true;
    }

    void raise(double error, double texels) noexcept { error_in_texels_ = larger(error * texels, error_in_texels_); }

    // Measures how far s and t are from those of the matrix that the set-up composes in double.
    void compare(const glm::dvec3& v, const glm::dvec2& st) noexcept {
        const double q = value_at(right_[3], v).value;
        if (!(q > 0.0)) return;
        const glm::dvec3 right =
            glm::dvec3(value_at(right_[0], v).value, value_at(right_[1], v).value, value_at(right_[2], v).value) / q;
        if (!is_lit(right)) return;
        for (glm::length_t k = 0; k < 2; ++k) raise(std::fabs(st[k] - right[k]), picture_.texels()[k]);
    }

    bool has_texgen_, has_right_;
    std::array<PointForm, 4> texgen_, right_, lost_;  // rows s, t, r and q
    Picture picture_;
    SlidePlanes planes_;
    std::size_t count_ = 0, in_front_ = 0;
    bool all_finite_ = true, behind_ = true, all_in_front_ = true, distinct_ = false;
    std::array<bool, SlidePlanes::max_size> outside_;  // of the planes behind q's
    glm::dvec3 first_{0.0};
    glm::dvec2 least_{0.0}, most_{0.0};
    double error_in_texels_ = 0.0;
};

}  // namespace TEXGEN_DETAIL
