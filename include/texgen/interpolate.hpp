#pragma once

// Floor 7: (s, t, r) over segments and over the fragments of triangles: interpolate s, t, r, q perspective-correctly,
// then divide by q, per fragment.
//
// The dial has three tiers. All begin with the homogeneous values at the corners of the rectangle, which decide whether
// anything is lit at all (Work::nothing).
//
//   exact       divide in double and round to float with a certificate; a value whose error bound straddles the middle
//               of two floats is decided exactly. Always the nearest float.                    divide_nearest()
//   tolerance   in float, along chunks of a row, about the value in the middle: by a line, a parabola, a polynomial of
//               degree 4 or 8, or a division, the first whose bound fits.                      divide_chunks()
//   between     where a chunk's bound does not fit: functions in double, rounded and divided in float, if that fits, else
//               as exact.                                                                      divide_without_chunks()
//
// Where q changes sign the rectangle is cut until its parts are on one side.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include <glm/vec2.hpp>

#include "conventions.hpp"
#include "detail/assert.hpp"
#include "detail/lanes.hpp"
#include "detail/nearest.hpp"
#include "detail/planes.hpp"
#include "detail/widen.hpp"
#include "primitives.hpp"
#include "skip.hpp"
#include "texcoord.hpp"

namespace texgen {

namespace detail {

// A tile of up to two numerators F and of Q: the linear functions, their values at the corner fragments and bounds on
// their errors. What holds at the corners with a margin for rounding holds at every fragment.
struct Corners {
    Ramp numerator_ramp[2], q_ramp;
    double numerator[2][4];
    double q[4];
    double numerator_error[2];
    double q_error;
    double least_q, largest_q;
    double reciprocal;  // the largest 1 / q, for a tile in front

    bool all_behind() const noexcept { return largest_q < -q_error; }
    bool all_in_front() const noexcept { return least_q > q_error; }
    // Far enough in front that the relative error of q is below 2^-24.
    bool well_in_front() const noexcept { return least_q > 0x1p24 * q_error; }

    // The largest |F| and |F/Q|; the latter for a tile in front. Where Q varies little the quotient of the bounds will do;
    // else the corners have it, u = F/Q being monotone along every line.
    double largest_numerator(std::size_t k) const noexcept {
        const double(&f)[4] = numerator[k];
        return larger(larger(std::fabs(f[0]), std::fabs(f[1])), larger(std::fabs(f[2]), std::fabs(f[3]))) +
               numerator_error[k];
    }
    double largest_quotient(std::size_t k) const noexcept {
        if (largest_q < 1.25 * least_q) return largest_numerator(k) * reciprocal;
        double largest = 0.0;
        for (std::size_t i = 0; i < 4; ++i)
            largest = larger(largest, (std::fabs(numerator[k][i]) + numerator_error[k]) / (q[i] - q_error));
        return largest;
    }

    // The error of F/Q in double for a tile well in front: as in certain_quotient(), where it is worst.
    double quotient_error(std::size_t k, double largest) const noexcept {
        return 1.0001 * (numerator_error[k] + q_error * largest) * reciprocal + 4.0 * unit_roundoff_double * largest;
    }
};

// The corners of a tile for one coordinate or two.
inline Corners corners(const TrianglePlanes& planes, const Plane* const (&numerator)[2], std::size_t numerators,
                       const Plane& q, const Tile& tile) noexcept {
    Corners corners{};
    const auto fill = [&](const Plane& plane, Ramp& ramp, double(&value)[4]) {
        ramp = planes.ramp(plane, tile);
        const double across = (tile.width - 1) * ramp.dx;
        const double down = (tile.height - 1) * ramp.dy;
        value[0] = ramp.base;
        value[1] = ramp.base + across;
        value[2] = ramp.base + down;
        value[3] = value[2] + across;
        return planes.error(plane, tile);
    };
    for (std::size_t k = 0; k < numerators; ++k)
        corners.numerator_error[k] = fill(*numerator[k], corners.numerator_ramp[k], corners.numerator[k]);
    corners.q_error = fill(q, corners.q_ramp, corners.q);
    corners.least_q = smaller(smaller(corners.q[0], corners.q[1]), smaller(corners.q[2], corners.q[3]));
    corners.largest_q = larger(larger(corners.q[0], corners.q[1]), larger(corners.q[2], corners.q[3]));
    corners.reciprocal = 1.0 / (corners.least_q - corners.q_error);
    return corners;
}

// Where the fragments in front lie as to one side of the region: G = F - bound Q is positive above it and negative below.
struct SideOfBound {
    bool all_below, all_above;
};

// The float that is written may be on the other side of the bound than the exact value, by an ulp or by the tolerance:
// so the answer must hold with that much slack.
inline SideOfBound side_of(const Corners& at, std::size_t k, double bound, double tolerance) noexcept {
    const double(&f)[4] = at.numerator[k];
    const double g[4] = {f[0] - bound * at.q[0], f[1] - bound * at.q[1], f[2] - bound * at.q[2],
                         f[3] - bound * at.q[3]};
    const double least = smaller(smaller(g[0], g[1]), smaller(g[2], g[3]));
    const double largest = larger(larger(g[0], g[1]), larger(g[2], g[3]));
    const double slack = 0x1p-22 * std::fabs(bound) + 0x1p-148 + tolerance;
    const double q = larger(std::fabs(at.least_q), std::fabs(at.largest_q));
    const double margin = 1.0001 * (at.numerator_error[k] + (std::fabs(bound) + slack) * at.q_error + slack * q +
                                    gamma(4) * std::fabs(bound) * q);
    return {largest * (1.0 - gamma(4)) < -margin, least * (1.0 - gamma(4)) > margin};
}

// Where one coordinate lies in the region, for all fragments at once.
enum class Place { outside, across, inside };

inline Place place_of(const Corners& at, std::size_t k, double min, double max, double tolerance) noexcept {
    const SideOfBound of_min = side_of(at, k, min, tolerance);
    if (of_min.all_below) return Place::outside;
    const SideOfBound of_max = side_of(at, k, max, tolerance);
    if (of_max.all_above) return Place::outside;
    return of_min.all_above && of_max.all_below && at.all_in_front() ? Place::inside : Place::across;
}

// What a tile gets: the work; under a tolerance the length of its chunks, and the factors that serve them all with a bound
// on the error of s and of t, if there are such (kernels.inc.hpp, Chunks).
struct Plan {
    Work work;
    int chunk;
    int factors;
    double error[2];
};

inline namespace TEXGEN_BUILD {
class TileInterpolator;
}

}  // namespace detail

class TriangleSetup;
class FootprintSetup;
inline namespace TEXGEN_BUILD {
template <class = void>
Work interpolate(const TriangleSetup&, FragmentRect, Texcoords) noexcept;
}

// A triangle made ready for interpolation over any number of rectangles of fragments.
class TriangleSetup {
public:
    // Guarantee: everything in double about the first vertex; no allocation, noexcept.
    // Shapes: window positions in pixels, the camera's clip w, and homogeneous (s, t, r, q), in either winding.
    // Bad input: empty where a number is not finite, a clip_w is not positive, or the area is zero (decided exactly).
    static std::optional<TriangleSetup> of(const Triangle& triangle, TextureRegion region,
                                           Tolerance tolerance = exact) noexcept {
        const std::optional<detail::TrianglePlanes> planes = detail::TrianglePlanes::of(triangle);
        if (!planes) return std::nullopt;
        return TriangleSetup(*planes, region, tolerance);
    }

    // Guarantee: the least work that is certified to stay inside the tolerance for every fragment of the rectangle;
    // never nothing where a fragment is lit. noexcept. An empty rectangle needs nothing.
    Work work(FragmentRect rect) const noexcept {
        if (rect.width <= 0 || rect.height <= 0) return Work::nothing;
        const detail::Tile tile{rect.x, rect.y, rect.width, rect.height};
        return plan(tile, corners(tile)).work;
    }

    // Guarantee: |computed - exact| of s (x) and t (y) is at most this for every fragment of the rectangle with q > 0,
    // the rounding to float included; infinite where no finite bound exists, as next to q = 0. noexcept.
    glm::dvec2 error_bound(FragmentRect rect) const noexcept {
        if (rect.width <= 0 || rect.height <= 0) return {0.0, 0.0};
        const detail::Tile tile{rect.x, rect.y, rect.width, rect.height};
        const detail::Corners at = corners(tile);
        if (at.all_behind()) return {0.0, 0.0};
        const detail::Plan plan = this->plan(tile, at);
        const auto bound = [&](std::size_t k) {
            if (plan.factors != detail::TileJob::any_factors) return plan.error[k];
            if (!at.all_in_front()) return std::numeric_limits<double>::infinity();
            return detail::larger(tolerance_, detail::half_ulp(at.largest_quotient(k)));
        };
        return {bound(0), bound(1)};
    }

private:
    friend class FootprintSetup;
    friend class detail::TileInterpolator;
    template <class>
    friend Work TEXGEN_BUILD::interpolate(const TriangleSetup&, FragmentRect, Texcoords) noexcept;

    TriangleSetup(const detail::TrianglePlanes& planes, const TextureRegion& region, Tolerance tolerance) noexcept
        : planes_(planes),
          s_(planes.plane(0)),
          t_(planes.plane(1)),
          q_(planes.plane(3)),
          lit_(region),
          tolerance_(detail::accepted(tolerance)) {}

    detail::Corners corners(const detail::Tile& tile) const noexcept {
        return detail::corners(planes_, {&s_, &t_}, 2, q_, tile);
    }
    detail::Plan plan(const detail::Tile& tile, const detail::Corners& at) const noexcept;

    detail::TrianglePlanes planes_;
    detail::Plane s_, t_, q_;
    detail::LitTest lit_;
    double tolerance_;
};

static_assert(sizeof(TriangleSetup) <= 512);

namespace detail {

// Short where q varies much, so that the ends of a chunk are not far from its middle. A chunk costs about as much as 32
// fragments besides those that it has.
inline int chunk_length(const Corners& at, int width) noexcept {
    const double q = 0.25 * (at.q[0] + at.q[1] + at.q[2] + at.q[3]);
    int longest = 256;
    while (longest > 64 && std::fabs(at.q_ramp.dx) * longest > 0.25 * q) longest /= 2;
    if (width <= longest) return width;
    const int chunks = (width - 1) / longest + 1;
    constexpr int lanes = 16;
    return ((width - 1) / chunks / lanes + 1) * lanes;
}

// The fewest factors that serve every chunk of a tile well in front, and the error that they leave: the bound of the
// kernel with each of its terms at its largest. A step of i is i (F_x Q - F Q_x) / Q^2 by the product of the Q at both ends: the
// difference is constant along a row.
inline void choose_factors(Plan& plan, const Corners& at, double tolerance) noexcept {
    const double half = 0.5 * (plan.chunk - 1);
    const double q_x = std::fabs(at.q_ramp.dx);
    const double extent = 1.001 * half * q_x * at.reciprocal;
    if (!(extent <= 0.25)) return;
    double reach[2], rest[2];
    for (std::size_t k = 0; k < 2; ++k) {
        const double f_x = at.numerator_ramp[k].dx;
        const auto slope_times_q_squared = [&](std::size_t i) {
            const double first = f_x * at.q[i];
            const double second = at.numerator[k][i] * at.q_ramp.dx;
            return std::fabs(first - second) + gamma(8) * (std::fabs(first) + std::fabs(second));
        };
        const double largest = at.largest_quotient(k);
        reach[k] =
            1.001 * half * larger(slope_times_q_squared(0), slope_times_q_squared(2)) * at.reciprocal * at.reciprocal;
        rest[k] = 0x2.003p-24 * largest + 0x8.009p-24 * reach[k] + 0x1p-115 +
                  1.001 * (at.numerator_error[k] + (largest + reach[k]) * at.q_error) * at.reciprocal;
    }
    double share = extent;
    for (int factors = 0; factors <= 3; ++factors, share *= share) {
        const double error[2] = {share * reach[0] + rest[0], share * reach[1] + rest[1]};
        if (!(error[0] <= tolerance && error[1] <= tolerance)) continue;
        plan.factors = factors;
        plan.error[0] = error[0];
        plan.error[1] = error[1];
        return;
    }
}

}  // namespace detail

inline detail::Plan TriangleSetup::plan(const detail::Tile& tile, const detail::Corners& at) const noexcept {
    using detail::Place;
    detail::Plan plan{Work::nothing, 0, detail::TileJob::any_factors, {}};
    if (at.all_behind()) return plan;
    const Place s_place = detail::place_of(at, 0, lit_.min(0), lit_.max(0), tolerance_);
    if (s_place == Place::outside) return plan;
    const Place t_place = detail::place_of(at, 1, lit_.min(1), lit_.max(1), tolerance_);
    if (t_place == Place::outside) return plan;

    plan.work = s_place == Place::inside && t_place == Place::inside ? Work::divide : Work::divide_and_test;
    if (tolerance_ > 0.0) plan.chunk = detail::chunk_length(at, tile.width);
    if (!at.well_in_front()) return plan;
    if (q_.is_constant()) plan.work = Work::affine;
    if (tolerance_ == 0.0) return plan;
    detail::choose_factors(plan, at, tolerance_ * (1.0 - 0x1p-18));
    if (plan.factors == 0)
        plan.work = Work::affine;
    else if (plan.factors != detail::TileJob::any_factors && plan.work != Work::affine)
        plan.work = Work::quadratic;
    return plan;
}

namespace detail {

inline namespace TEXGEN_BUILD {

// Interpolates up to two coordinates, and the mask, of a triangle into the caller's arrays.
class TileInterpolator {
public:
    static constexpr int scratch_width = 512;

    TileInterpolator(const TileKernels& kernels, const TriangleSetup& setup, FragmentRect rect) noexcept
        : kernels_(kernels), setup_(setup), rect_(rect) {}

    // A coordinate (0 to 3: s, t, r, q) and its plane; one that only the mask needs has no output.
    void add(glm::length_t coordinate, const Plane& plane, std::span<float> output) noexcept {
        coordinate_[count_] = coordinate;
        plane_[count_] = &plane;
        output_[count_++] = output;
    }
    void add_lit(std::span<float> lit) noexcept { lit_ = lit; }

    Corners corners(const Tile& tile) const noexcept {
        return detail::corners(setup_.planes_, plane_, count_, setup_.q_, tile);
    }

    void shade(const Tile& tile) noexcept {
        const Corners at = corners(tile);
        shade(tile, at, {Work::divide, chunk_length(at, tile.width), TileJob::any_factors, {}});
    }

    void shade(const Tile& tile, const Corners& at, const Plan& plan) noexcept {
        if (setup_.tolerance_ == 0.0) return divide_nearest(tile, at);
        if (at.well_in_front()) return divide_chunks(tile, at, plan);
        divide_parts(tile, at, [&](const Tile& half) { shade(half); });
    }

private:
    // A tile behind is cleared; one that is in doubt is halved, until it is so small that its fragments are decided one by
    // one.
    template <class ShadeHalf>
    void divide_parts(const Tile& tile, const Corners& at, const ShadeHalf& shade_half) noexcept {
        if (at.all_behind()) return clear(tile);
        if (tile.width <= 8 && tile.height <= 8) return shade_one_by_one(tile);
        for (const Tile& half : tile.halves()) shade_half(half);
    }

    void divide_nearest(const Tile& tile, const Corners& at) noexcept {
        // Beyond a ratio of 2^12 the error bound of the largest quotient would make the smallest ones doubtful.
        if (!at.well_in_front() || !(at.least_q > 0x1p-12 * at.largest_q))
            return divide_parts(tile, at, [&](const Tile& half) { divide_nearest(half, corners(half)); });
        TileJob job = this->job(tile, at);
        for (std::size_t k = 0; k < count_; ++k) job.quotient_error[k] = at.quotient_error(k, at.largest_quotient(k));
        TileJob::Unit unit = kernels_.divide_nearest(job, job.unit_at(0, 0));
        while (!job.is_done(unit)) {
            shade_one_by_one(part(tile, unit));
            unit = kernels_.divide_nearest(job, job.unit_after(unit));
        }
    }

    void divide_chunks(const Tile& tile, const Corners& at, const Plan& plan) noexcept {
        TileJob job = this->job(tile, at);
        job.chunk = plan.chunk;
        job.factors = plan.factors;
        job.tolerance = setup_.tolerance_ * (1.0 - 0x1p-20);
        job.q_error = at.q_error;
        job.least_q = 0x1p24 * at.q_error;
        for (std::size_t k = 0; k < count_; ++k) job.numerator_error[k] = at.numerator_error[k];
        TileJob::Unit next{0, 0, 0, 0};
        while (true) {
            const TileJob::Unit refused = kernels_.divide_chunks(job, next);
            if (job.is_done(refused)) return;
            const Tile rest = part(tile, refused);
            divide_without_chunks(rest, corners(rest));
            next = refused.x_end < tile.width ? TileJob::Unit{refused.x_end, 0, refused.y_begin, 0}
                                              : TileJob::Unit{0, 0, refused.y_end, 0};
        }
    }

    void divide_without_chunks(const Tile& tile, const Corners& at) noexcept {
        bool fits = at.well_in_front() && at.least_q > 0x1p-20 * at.largest_q;
        for (std::size_t k = 0; k < count_ && fits; ++k) fits = rounded_error(at, k) <= setup_.tolerance_;
        if (!fits) return divide_nearest(tile, at);
        TileJob job = this->job(tile, at);
        job.scale(reciprocal_power_of_two(at.largest_q));
        kernels_.divide_rounded(job);
    }

    // The error of F/Q with F and Q rounded to float, then the reciprocal and the product: 4 u |F/Q|, u = 2^-24. With
    // 2^-21 <= Q <= 2 a float of F that is subnormal, or flushed to zero, adds less than 2^-104.
    double rounded_error(const Corners& at, std::size_t k) const noexcept {
        const double largest = at.largest_quotient(k);
        return 4.01 * unit_roundoff_float * largest + 0x1p-104 + at.quotient_error(k, largest);
    }

    void shade_one_by_one(const Tile& tile) noexcept {
        for (std::int64_t y = tile.y; y < tile.y + tile.height; ++y)
            for (std::int64_t x = tile.x; x < tile.x + tile.width; ++x) shade_one(x, y);
    }

    // One fragment, every decision exact.
    void shade_one(std::int64_t x, std::int64_t y) noexcept {
        const TrianglePlanes& planes = setup_.planes_;
        const Bounded q = planes.at(setup_.q_, x, y);
        const auto exact_q = [&] { return planes.exactly_at(3, x, y); };
        const bool in_front = certain_sign(q, exact_q) > 0;
        float value[2] = {0.0f, 0.0f};
        for (std::size_t k = 0; k < count_; ++k) {
            const auto exact_numerator = [&] { return planes.exactly_at(coordinate_[k], x, y); };
            if (in_front) value[k] = certain_quotient(planes.at(*plane_[k], x, y), q, exact_numerator, exact_q);
            if (!output_[k].empty()) output_[k][offset(x, y)] = value[k];
        }
        if (!lit_.empty()) lit_[offset(x, y)] = in_front ? setup_.lit_(value[0], value[1]) : 0.0f;
    }

    void clear(const Tile& tile) noexcept {
        for (const std::span<float> output : {output_[0], output_[1], lit_}) {
            if (output.empty()) continue;
            for (std::int64_t y = tile.y; y < tile.y + tile.height; ++y) {
                float* const row = output.data() + offset(tile.x, y);
                for (int i = 0; i < tile.width; ++i) row[i] = 0.0f;
            }
        }
    }

    // What every kernel needs.
    TileJob job(const Tile& tile, const Corners& at) noexcept {
        TileJob job{};
        job.numerators = static_cast<int>(count_);
        job.width = tile.width;
        job.height = tile.height;
        job.q = at.q_ramp;
        job.q_is_constant = setup_.q_.is_constant();
        for (std::size_t k = 0; k < count_; ++k) {
            job.numerator[k] = at.numerator_ramp[k];
            job.out[k] = output_[k].empty() ? scratch_[k] : output_[k].data() + offset(tile.x, tile.y);
            job.pitch[k] = output_[k].empty() ? 0 : rect_.width;
        }
        if (lit_.empty()) return job;
        job.lit = lit_.data() + offset(tile.x, tile.y);
        job.lit_pitch = rect_.width;
        setup_.lit_.copy_to(job.min, job.max);
        return job;
    }

    static Tile part(const Tile& tile, const TileJob::Unit& unit) noexcept {
        return {tile.x + unit.x_begin, tile.y + unit.y_begin, unit.x_end - unit.x_begin, unit.y_end - unit.y_begin};
    }

    std::size_t offset(std::int64_t x, std::int64_t y) const noexcept { return offset_in(rect_, x, y); }

    const TileKernels& kernels_;
    const TriangleSetup& setup_;
    FragmentRect rect_;
    std::size_t count_ = 0;
    glm::length_t coordinate_[2] = {};
    const Plane* plane_[2] = {};
    std::span<float> output_[2];
    std::span<float> lit_;
    float scratch_[2][scratch_width];  // coordinates that only the mask needs, a row at a time
};

}  // namespace TEXGEN_BUILD

}  // namespace detail

inline namespace TEXGEN_BUILD {

// Guarantee: in front of the projector s/q, t/q and r/q, within max(tolerance, 1/2 ulp) of the exact value of the given
// floats (r: the tolerance relative to max(1, |r|)). With `exact` each is the nearest float, so that its bits depend on
// neither the rectangle, the length, the alignment nor the build. lit = 1 inside the closed region, decided from the s
// and t that are (or would be) written. Behind, s = t = r = lit = 0, the sign of q decided exactly. Returns
// setup.work(rect); for Work::nothing lit is 0 and s, t, r are not written. No allocation, noexcept.
// Shapes: each output has width * height floats, row-major, or none (asserted). Fragments outside the triangle get the
// values of its plane; where the interpolated 1/w is not positive nothing is promised.
// Bad input: an empty rectangle does nothing.
// Source: OpenGL compatibility specification, polygon rasterization; Everitt, Projective Texture Mapping, section 2.
template <class>
Work interpolate(const TriangleSetup& setup, FragmentRect rect, Texcoords out) noexcept {
    TEXGEN_ASSERT(rect.width >= 0 && rect.height >= 0);
    if (rect.width <= 0 || rect.height <= 0) return Work::nothing;
    const std::size_t count = static_cast<std::size_t>(rect.width) * static_cast<std::size_t>(rect.height);
    bool any_output = false;
    for (std::span<float>* output : {&out.s, &out.t, &out.r, &out.lit}) {
        if (!detail::is_computed(*output, count)) *output = {};
        any_output = any_output || !output->empty();
    }

    const detail::Tile tile{rect.x, rect.y, rect.width, rect.height};
    const detail::Corners at = setup.corners(tile);
    const detail::Plan plan = setup.plan(tile, at);
    if (plan.work == Work::nothing) {
        for (float& lit : out.lit) lit = 0.0f;
        return plan.work;
    }

    if (!any_output) return plan.work;
    const detail::TileKernels& kernels = detail::chosen<detail::TileKernels>();

    const bool both = !out.lit.empty() || (!out.s.empty() && !out.t.empty());
    if (both || !out.s.empty() || !out.t.empty()) {
        detail::TileInterpolator interpolator(kernels, setup, rect);
        if (both || !out.s.empty()) interpolator.add(0, setup.s_, out.s);
        if (both || !out.t.empty()) interpolator.add(1, setup.t_, out.t);
        interpolator.add_lit(out.lit);
        const bool needs_scratch = both && (out.s.empty() || out.t.empty());
        if (both && !(needs_scratch && tile.width > detail::TileInterpolator::scratch_width)) {
            interpolator.shade(tile, at, plan);
        } else {
            detail::Tile strip = tile;
            for (strip.width = detail::TileInterpolator::scratch_width; strip.x < tile.x + tile.width;
                 strip.x += detail::TileInterpolator::scratch_width) {
                const std::int64_t rest = tile.x + tile.width - strip.x;
                if (rest < strip.width) strip.width = static_cast<int>(rest);
                interpolator.shade(strip, interpolator.corners(strip), plan);
            }
        }
    }
    if (!out.r.empty()) {
        const detail::Plane r = setup.planes_.plane(2);
        detail::TileInterpolator interpolator(kernels, setup, rect);
        interpolator.add(2, r, out.r);
        interpolator.shade(tile);
    }
    return plan.work;
}

}  // namespace TEXGEN_BUILD

// The same of a segment, for all alpha in [0, 1].
// Guarantee: never nothing where a value is lit, never less than divide_and_test where one is dark or behind; affine where
// q is the same at both ends. noexcept.
// Bad input: an end that is not finite needs divide_and_test.
inline Work work(const Segment& segment, TextureRegion region, Tolerance tolerance = exact) noexcept {
    const glm::dvec4 a = detail::widened(segment.a);
    const glm::dvec4 b = detail::widened(segment.b);
    // A product with 0 is 0 for numbers only.
    if (!(0.0 * (a.x + a.y + a.w) == 0.0 && 0.0 * (b.x + b.y + b.w) == 0.0)) return Work::divide_and_test;
    if (a.w <= 0.0 && b.w <= 0.0) return Work::nothing;

    // A tile of one row whose corners are the ends: given, so without an error.
    detail::Corners at{};
    for (std::size_t i = 0; i < 4; ++i) {
        const glm::dvec4& end = i % 2 == 0 ? a : b;
        at.numerator[0][i] = end.x;
        at.numerator[1][i] = end.y;
        at.q[i] = end.w;
    }
    at.least_q = detail::smaller(a.w, b.w);
    at.largest_q = detail::larger(a.w, b.w);
    const detail::LitTest lit(region);
    const double accepted = detail::accepted(tolerance);
    const detail::Place s_place = detail::place_of(at, 0, lit.min(0), lit.max(0), accepted);
    const detail::Place t_place = detail::place_of(at, 1, lit.min(1), lit.max(1), accepted);
    if (s_place == detail::Place::outside || t_place == detail::Place::outside) return Work::nothing;
    if (a.w == b.w) return Work::affine;
    return s_place == detail::Place::inside && t_place == detail::Place::inside ? Work::divide : Work::divide_and_test;
}

namespace detail {

// A float stands for the segment's value at alpha exactly: A - alpha A + alpha B.
inline Expansion<5> exactly_mixed(double a, double b, double alpha) noexcept {
    Expansion<5> sum;
    sum.add(a);
    sum.add_product(-alpha, a);
    sum.add_product(alpha, b);
    return sum;
}

// 1 - alpha, the products and the sum are rounded once each.
inline Bounded mixed(double a, double b, double alpha) noexcept {
    const double from_a = (1.0 - alpha) * a;
    const double from_b = alpha * b;
    return {from_a + from_b, gamma(4) * (std::fabs(from_a) + std::fabs(from_b))};
}

// One value of a job, every decision exact.
inline void interpolate_one(const SegmentJob& job, std::size_t i) noexcept {
    const double alpha = job.alpha[i];
    const auto exact_q = [&] { return exactly_mixed(job.q_a, job.q_b, alpha); };
    const Bounded q = mixed(job.q_a, job.q_b, alpha);
    const bool in_front = certain_sign(q, exact_q) > 0;
    float value[2] = {0.0f, 0.0f};
    for (int k = 0; k < job.numerators; ++k) {
        if (in_front)
            value[k] = certain_quotient(
                mixed(job.a[k], job.b[k], alpha), q, [&] { return exactly_mixed(job.a[k], job.b[k], alpha); }, exact_q);
        job.out[k][i] = value[k];
    }
    if (job.lit != nullptr) job.lit[i] = in_front && is_inside(value[0], value[1], job.min, job.max) ? 1.0f : 0.0f;
}

// What is known of a segment whose ends are in front: q is least, and |F/Q| largest, at an end.
struct SegmentBounds {
    double q_least, q_largest;
    double numerator[2], quotient[2];

    explicit SegmentBounds(const SegmentJob& job) noexcept
        : q_least(smaller(job.q_a, job.q_b)), q_largest(larger(job.q_a, job.q_b)), numerator{}, quotient{} {
        for (int k = 0; k < job.numerators; ++k) {
            numerator[k] = larger(std::fabs(job.a[k]), std::fabs(job.b[k]));
            quotient[k] = 1.001 * larger(std::fabs(job.a[k]) / job.q_a, std::fabs(job.b[k]) / job.q_b);
        }
    }

    // As in certain_quotient(), with errors of `relative` in the numerator and in q, and `final` in the division.
    double error(int k, double relative, double final) const noexcept {
        return 1.001 * relative * (numerator[k] + quotient[k] * q_largest) / q_least + final * quotient[k];
    }
    bool is_well_in_front() const noexcept { return q_least > 0x1p-20 * q_largest && q_largest < 0x1p1000; }
};

// The error of float arithmetic for every alpha in [0, 1]: with u = 2^-24 the five roundings of A - alpha A + alpha B are
// at most 5 u max(|A|, |B|), and the reciprocal and the product add 2 u. Infinite where a float could leave its range.
inline double segment_float_error(const SegmentBounds& bounds, int k) noexcept {
    const bool in_range = bounds.q_least > 0x1p-10 * bounds.q_largest && bounds.q_least > 0x1p-100 &&
                          bounds.q_largest < 0x1p100 && bounds.numerator[k] < 0x1p100;
    if (!in_range) return std::numeric_limits<double>::infinity();
    return bounds.error(k, 5.01 * unit_roundoff_float, 2.01 * unit_roundoff_float) + 0x1p-146 / bounds.q_least +
           0x1p-149;
}

// What the segments' kernels need, but for the alphas and the outputs: coordinates `first` and the next.
inline SegmentJob segment_job(const Segment& segment, int first, int numerators) noexcept {
    SegmentJob job{};
    job.numerators = numerators;
    for (int k = 0; k < numerators; ++k) {
        const auto coordinate = static_cast<glm::length_t>(first + k);
        job.a[k] = widened(segment.a[coordinate]);
        job.b[k] = widened(segment.b[coordinate]);
    }
    job.q_a = widened(segment.a.w);
    job.q_b = widened(segment.b.w);
    return job;
}

inline namespace TEXGEN_BUILD {

// In float where that stays inside the tolerance for the whole segment, else the nearest float: in vectors, and the
// blocks that those cannot vouch for value by value.
inline void interpolate_job(const SegmentKernels& kernels, SegmentJob job, double tolerance) noexcept {
    if (job.q_a > 0.0 && job.q_b > 0.0) {
        const SegmentBounds bounds(job);
        bool float_fits = tolerance > 0.0;
        for (int k = 0; k < job.numerators; ++k) float_fits = float_fits && segment_float_error(bounds, k) <= tolerance;
        if (float_fits) return kernels.divide_float(job);
        job.in_front = bounds.is_well_in_front();
        for (int k = 0; k < job.numerators; ++k)
            job.quotient_error[k] = bounds.error(k, gamma(4), 4.0 * unit_roundoff_double);
    }
    for (std::size_t i = kernels.divide_nearest(job, 0); i < job.count; i = kernels.divide_nearest(job, i)) {
        const std::size_t block_end = (i / nearest_block + 1) * nearest_block;
        for (; i < job.count && i < block_end; ++i) interpolate_one(job, i);
    }
}

}  // namespace TEXGEN_BUILD

}  // namespace detail

// Guarantee: |computed - exact| of s (x) and t (y) is at most this for every alpha in [0, 1] with q > 0, the rounding to
// float included; infinite where q reaches 0 and no finite bound exists. noexcept.
// Bad input: infinite where an s, t or q of an end is not finite.
inline glm::dvec2 error_bound(const Segment& segment, Tolerance tolerance = exact) noexcept {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const detail::SegmentJob job = detail::segment_job(segment, 0, 2);
    // A product with 0 is 0 for numbers only.
    const double sum = job.a[0] + job.a[1] + job.b[0] + job.b[1] + job.q_a + job.q_b;
    if (!(0.0 * sum == 0.0)) return {infinity, infinity};
    if (job.q_a <= 0.0 && job.q_b <= 0.0) return {0.0, 0.0};
    if (job.q_a <= 0.0 || job.q_b <= 0.0) return {infinity, infinity};
    const detail::SegmentBounds bounds(job);
    const auto bound = [&](int k) {
        const double of_nearest = detail::half_ulp(bounds.quotient[k]);
        const double of_float = detail::segment_float_error(bounds, k);
        // Where both are next to one another, a file with other flags may have decided otherwise.
        const bool may_be_float = of_float * (1.0 - 0x1p-40) <= detail::accepted(tolerance);
        return may_be_float ? detail::larger(of_float, of_nearest) : of_nearest;
    };
    return {bound(0), bound(1)};
}

inline namespace TEXGEN_BUILD {

// Guarantee: C_u = ((1-a) A_u + a B_u) / ((1-a) A_q + a B_q) for u = s, t, r within max(tolerance, 1/2 ulp) of the exact
// value of the given floats (r: the tolerance relative to max(1, |r|)); with `exact` the nearest float, the ends
// included. The sign of q is exact, and behind the projector all are 0. lit as for triangles. No allocation, noexcept.
// Shapes: each output as long as alpha, or empty (asserted); alpha in [0, 1] (asserted).
// Bad input: NaN and infinity spoil their own value only; an alpha that is NaN is never lit.
// Source: the C_u note, (2).
template <class = void>
void interpolate(const Segment& segment, std::span<const float> alpha, TextureRegion region, Texcoords out,
                 Tolerance tolerance = exact) noexcept {
    for ([[maybe_unused]] const float a : alpha) TEXGEN_ASSERT(!(a < 0.0f) && !(a > 1.0f));
    const double accepted = detail::accepted(tolerance);
    const detail::SegmentKernels& kernels = detail::chosen<detail::SegmentKernels>();
    detail::for_each_group(out, alpha.size(), [&](int first, int numerators, const detail::PointOutputs& outputs) {
        detail::SegmentJob job = detail::segment_job(segment, first, numerators);
        detail::LitTest(region).copy_to(job.min, job.max);
        const auto run = [&](const detail::SegmentJob& part) { detail::interpolate_job(kernels, part, accepted); };

        const std::size_t whole = alpha.size() / detail::point_quantum * detail::point_quantum;
        job.alpha = alpha.data();
        if (whole != 0) detail::run_batch(job, outputs, 0, whole, whole, run);
        const std::size_t rest = alpha.size() - whole;
        if (rest == 0) return;
        float padded[detail::point_quantum];
        for (std::size_t i = 0; i < detail::point_quantum; ++i) padded[i] = alpha[whole + (i < rest ? i : rest - 1)];
        job.alpha = padded;
        detail::run_batch(job, outputs, whole, rest, detail::point_quantum, run);
    });
}

}  // namespace TEXGEN_BUILD

}  // namespace texgen
