#pragma once

// Floor 7: (s, t, r) over the fragments of triangles: interpolate s, t, r, q perspective-correctly, then divide by q, per
// fragment. Segments are in segment.hpp.
//
// The dial has three tiers. All begin with the homogeneous values at the corners of the rectangle, which decide whether
// anything is lit at all (Work::nothing).
//
//   exact       divide in double and round to float with a certificate; a value whose error bound straddles the middle
//               of two floats is decided exactly. Always the nearest float.                    divide_nearest()
//   tolerance   in float, along chunks of a row, about the value in the middle: by a polynomial of degree 2, 4 or 8, or
//               by a division, the first whose bound fits.                                     divide_chunks()
//   between     where a chunk's bound does not fit: functions in double, rounded and divided in float, if that fits, else
//               as exact.                                                                      divide_without_chunks()
//
// Where q changes sign the rectangle is cut until its parts are on one side. What is still in doubt (ties, and the last
// parts) is decided to twice the precision of double, in vectors (divide_closely()); and what that leaves, fragment by
// fragment, exactly.

#include "detail/language.hpp"

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include <glm/vec2.hpp>

#include "conventions.hpp"
#include "detail/arithmetic/nearest.hpp"
#include "detail/arithmetic/widen.hpp"
#include "detail/assert.hpp"
#include "detail/culling/lit_test.hpp"
#include "detail/simd/lanes.hpp"
#include "detail/triangle/close_planes.hpp"
#include "detail/triangle/corners.hpp"
#include "detail/triangle/planes.hpp"
#include "primitives.hpp"
#include "segment.hpp"
#include "texcoord.hpp"

namespace TEXGEN_NAMESPACE {

namespace detail {
inline namespace TEXGEN_COMPILER {

// What a tile gets: the work; under a tolerance the length of its chunks, and the factors that serve them all with a bound
// on the error of s and of t, if there are such (chunks.inc.hpp).
struct Plan {
    Work work;
    int chunk;
    int factors;
    double error[2];
};

inline namespace TEXGEN_BUILD {

// What is known of a tile before it is divided.
struct TileSurvey {
    Corners at;
    Plan plan;
    std::optional<CloseRamps> close;  // where the planes cancel
};

class TileInterpolator;

}  // namespace TEXGEN_BUILD

}  // namespace TEXGEN_COMPILER
}  // namespace detail

inline namespace TEXGEN_COMPILER {
class TriangleSetup;
class FootprintSetup;
}  // namespace TEXGEN_COMPILER
inline namespace TEXGEN_BUILD {
template <class = void>
Work interpolate(const TriangleSetup&, FragmentRect, Texcoords) noexcept;
}

inline namespace TEXGEN_COMPILER {

// A triangle made ready for interpolation over any number of rectangles of fragments.
class TriangleSetup {
    struct Key {
        explicit Key() = default;
    };

public:
    // Guarantee: everything in double, about the vertex with the largest clip_w; no allocation, noexcept.
    // Shapes: window positions in pixels, the camera's clip w, and homogeneous (s, t, r, q), in either winding.
    // Bad input: empty where a number is not finite, a clip_w is not positive, or the area is zero (decided exactly).
    static std::optional<TriangleSetup> of(const Triangle& triangle, TextureRegion region,
                                           Tolerance tolerance = exact) noexcept {
        std::optional<TriangleSetup> setup(std::in_place, Key(), triangle, region, tolerance);
        if (!setup->planes_.is_usable()) setup.reset();
        return setup;
    }

    // What of() makes in place.
    TriangleSetup(Key, const Triangle& triangle, const TextureRegion& region, Tolerance tolerance) noexcept
        : planes_(triangle),
          st_(planes_.planes(0, 1)),
          q_(planes_.plane(3)),
          lit_(region),
          tolerance_(detail::accepted(tolerance)) {}

    // Guarantee: the least work that is certified to stay inside the tolerance for every fragment of the rectangle;
    // never nothing where a fragment is lit. noexcept. An empty rectangle needs nothing.
    Work work(FragmentRect rect) const noexcept {
        if (rect.width <= 0 || rect.height <= 0) return Work::nothing;
        return survey({rect.x, rect.y, rect.width, rect.height}).plan.work;
    }

    // Guarantee: |computed - exact| of s (x) and t (y) is at most this for every fragment of the rectangle with q > 0,
    // the rounding to float included; infinite where no finite bound exists, as next to q = 0. noexcept.
    glm::dvec2 error_bound(FragmentRect rect) const noexcept {
        if (rect.width <= 0 || rect.height <= 0) return {0.0, 0.0};
        const detail::TileSurvey found = survey({rect.x, rect.y, rect.width, rect.height});
        const detail::Corners& at = found.at;
        const detail::Plan& plan = found.plan;
        if (at.all_behind()) return {0.0, 0.0};
        const auto bound = [&](std::size_t k) {
            if (plan.factors != detail::TileJob::any_factors) return plan.error[k];
            if (!at.all_in_front()) return std::numeric_limits<double>::infinity();
            return detail::larger(tolerance_, detail::half_ulp(at.largest_quotient()[k]));
        };
        return {bound(0), bound(1)};
    }

private:
    friend class FootprintSetup;
    friend class detail::TileInterpolator;
    template <class>
    friend Work TEXGEN_BUILD::interpolate(const TriangleSetup&, FragmentRect, Texcoords) noexcept;

    detail::TileSurvey survey(const detail::Tile& tile) const noexcept;
    detail::Corners corners(const detail::Tile& tile) const noexcept { return survey(tile).at; }
    detail::Plan plan(const detail::Tile& tile, const detail::Corners& at) const noexcept;

    detail::TrianglePlanes planes_;
    detail::PlaneOf<detail::Pair> st_;
    detail::Plane q_;
    detail::LitTest lit_;
    double tolerance_;
};

}  // namespace TEXGEN_COMPILER

static_assert(sizeof(TriangleSetup) <= 512);

namespace detail {
inline namespace TEXGEN_COMPILER {

inline namespace TEXGEN_BUILD {

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

// A chunk costs as much as some fragments, and the first of them as much as some tens.
inline bool pays_for_chunks(const Tile& tile) noexcept {
    return tile.width >= 16 && static_cast<std::int64_t>(tile.width) * tile.height > 64;
}

// The fewest factors that serve every chunk of a tile well in front, and the error that they leave; less work than a
// division is said of it then, and affine where none were needed. The bound is that of the kernel with each of its terms at
// its largest. A step of i is i (F_x Q - F Q_x) over the Q at both of its ends, and that difference is constant along a row.
inline void choose_factors(Plan& plan, const Corners& at, double tolerance) noexcept {
    const double half = 0.5 * (plan.chunk - 1);
    const double extent = 1.001 * half * std::fabs(at.q_ramp.dx) * at.reciprocal;
    if (!(extent <= 0.25)) return;
    const auto slope_times_q_squared = [&](std::size_t i) {
        const Pair first = at.numerator_ramp.dx * at.q[i];
        const Pair second = at.numerator[i] * at.q_ramp.dx;
        return magnitude(first - second) + (magnitude(first) + magnitude(second)) * gamma(8);
    };
    const Pair largest = at.largest_quotient();
    const Pair reach =
        larger(slope_times_q_squared(0), slope_times_q_squared(2)) * (1.001 * half * at.reciprocal * at.reciprocal);
    const Pair rest = largest * chunk_middle_error + reach * chunk_step_error + chunk_underflow +
                      (at.numerator_error + (largest + reach) * at.q_error) * (1.001 * at.reciprocal);
    const auto fits = [&](double share) {
        const Pair error = reach * share + rest;
        plan.error[0] = error[0];
        plan.error[1] = error[1];
        return error[0] <= tolerance && error[1] <= tolerance;
    };
    const bool is_affine = fits(extent);
    double share = extent;
    for (int factors = 1; factors <= 3; ++factors) {
        share *= share;
        if (!fits(share)) continue;
        plan.factors = factors;
        if (plan.work != Work::affine) plan.work = is_affine ? Work::affine : Work::quadratic;
        return;
    }
}

}  // namespace TEXGEN_BUILD

}  // namespace TEXGEN_COMPILER
}  // namespace detail

inline detail::Plan TriangleSetup::plan(const detail::Tile& tile, const detail::Corners& at) const noexcept {
    using detail::Place;
    detail::Plan plan{Work::nothing, 0, detail::TileJob::any_factors, {}};
    if (at.all_behind()) return plan;
    const detail::Places places = detail::places_of(at, lit_, tolerance_);
    if (places.s == Place::outside || places.t == Place::outside) return plan;

    plan.work = places.s == Place::inside && places.t == Place::inside ? Work::divide : Work::divide_and_test;
    if (at.well_in_front() && is_constant(at.q_ramp)) plan.work = Work::affine;
    if (tolerance_ == 0.0 || !detail::pays_for_chunks(tile)) return plan;
    plan.chunk = detail::chunk_length(at, tile.width);
    if (!at.well_in_front()) return plan;
    detail::choose_factors(plan, at, tolerance_ * (1.0 - 0x1p-18));
    return plan;
}

inline detail::TileSurvey TriangleSetup::survey(const detail::Tile& tile) const noexcept {
    detail::TileSurvey found;  // not {}: zeros would cost what a small tile does
    found.at = detail::corners_of(planes_, st_, q_, tile);
    for (;;) {
        found.plan = plan(tile, found.at);
        if (found.close || found.plan.work == Work::nothing || !found.at.cancel()) return found;
        found.close = detail::ClosePlanes(planes_, tile).ramps(0, 1);
        found.at = detail::corners_of(*found.close);
    }
}

namespace detail {
inline namespace TEXGEN_COMPILER {

inline namespace TEXGEN_BUILD {

// Interpolates up to two coordinates, and the mask, of a triangle into the caller's arrays.
class TileInterpolator {
public:
    static constexpr int scratch_width = 512;

    // `close` is what is known of the functions that add() says, or nothing yet.
    TileInterpolator(const TileKernels& kernels, const TriangleSetup& setup, FragmentRect rect,
                     std::optional<CloseRamps>& close) noexcept
        : kernels_(kernels), setup_(setup), rect_(rect), close_(close) {}

    // s and t, of which one that only the mask needs has no output.
    void add(const std::span<float>& s, const std::span<float>& t, const std::span<float>& lit) noexcept {
        planes_ = setup_.st_;
        count_ = 2;
        coordinate_[1] = 1;
        output_[0] = s;
        output_[1] = t;
        lit_ = lit;
    }
    // One coordinate, 0 to 2 for s, t, r.
    void add(glm::length_t coordinate, const std::span<float>& output) noexcept {
        planes_ = setup_.planes_.planes(coordinate, coordinate);
        count_ = 1;
        coordinate_[0] = coordinate;
        output_[0] = output;
    }

    Corners corners(const Tile& tile) noexcept {
        const Corners at = corners_of(setup_.planes_, planes_, setup_.q_, tile);
        return at.all_behind() || !at.cancel() ? at : corners_of(close_ramps(tile));
    }

    // A coordinate whose plan nobody knows.
    void interpolate(const Tile& tile) noexcept {
        const Corners at = corners(tile);
        interpolate(tile, at, plan(tile, at));
    }

    void interpolate(const Tile& tile, const Corners& at, const Plan& plan) noexcept {
        whole_ = tile;
        closely_.reset();
        shade(tile, at, plan);
    }

    // In parts that the scratch arrays hold.
    void interpolate_in_strips(const Tile& tile, const Plan& plan) noexcept {
        Tile strip = tile;
        for (strip.width = scratch_width; strip.x < tile.x + tile.width; strip.x += scratch_width) {
            const std::int64_t rest = tile.x + tile.width - strip.x;
            if (rest < strip.width) strip.width = static_cast<int>(rest);
            interpolate(strip, corners(strip), plan);
        }
    }

private:
    static Plan plan(const Tile& tile, const Corners& at) noexcept {
        return {Work::divide, pays_for_chunks(tile) ? chunk_length(at, tile.width) : 0, TileJob::any_factors, {}};
    }

    void shade(const Tile& tile) noexcept {
        const Corners at = corners(tile);
        shade(tile, at, plan(tile, at));
    }

    void shade(const Tile& tile, const Corners& at, const Plan& plan) noexcept {
        if (setup_.tolerance_ == 0.0) return divide_nearest(tile, at);
        if (at.well_in_front())
            return plan.chunk != 0 ? divide_chunks(tile, at, plan) : divide_without_chunks(tile, at);
        divide_parts(tile, at, [&](const Tile& half) { shade(half); });
    }

    // They are made when a tile first needs them, for all of the rectangle.
    CloseRamps close_ramps(const Tile& tile) noexcept {
        const Tile all{rect_.x, rect_.y, rect_.width, rect_.height};
        if (!close_) close_ = ClosePlanes(setup_.planes_, all).ramps(coordinate_[0], coordinate_[count_ - 1]);
        return close_->moved_to(tile);
    }

    // A tile behind is cleared; one that is in doubt is halved, until it is so small that it is divided closely.
    template <class ShadeHalf>
    void divide_parts(const Tile& tile, const Corners& at, const ShadeHalf& shade_half) noexcept {
        if (at.all_behind()) return clear(tile);
        if (tile.width <= 8 && tile.height <= 8) return divide_closely(tile, at);
        for (const Tile& half : tile.halves()) shade_half(half);
    }

    void divide_nearest(const Tile& tile, const Corners& at) noexcept {
        // Beyond a ratio of 2^12 the error bound of the largest quotient would make the smallest ones doubtful.
        if (!at.well_in_front() || !(at.least_q > 0x1p-12 * at.largest_q))
            return divide_parts(tile, at, [&](const Tile& half) { divide_nearest(half, corners(half)); });
        TileJob job = this->job(tile, at);
        const Pair error = at.quotient_error(at.largest_quotient());
        for (std::size_t k = 0; k < 2; ++k) job.quotient_error[k] = error[k];
        TileJob::Unit unit = kernels_.divide_nearest(job, job.unit_at(0, 0));
        if (job.is_done(unit)) return;
        const CloseFunctions functions = close_ramps(tile).split();
        if (take_exact_quotients(functions, job)) {
            kernels_.divide_nearest(job, unit);
            return;
        }
        // Doubt has company: twice as many units after each failure that follows another.
        for (int many = 1; !job.is_done(unit);) {
            for (int i = 0; i < many && !job.is_done(unit); ++i, unit = job.unit_after(unit))
                shade_some(tile, unit, kernels_.divide_closely(job, functions, unit));
            const TileJob::Unit next = kernels_.divide_nearest(job, unit);
            many = next.x_begin == unit.x_begin && next.y_begin == unit.y_begin ? 2 * many : 1;
            unit = next;
        }
    }

    // Where q is constant the quotients are linear; if doubles hold them exactly, every tie is decided by rounding to float.
    static bool take_exact_quotients(const CloseFunctions& functions, TileJob& job) noexcept {
        const auto is_zero = [](const Ramp& ramp) { return ramp.base == 0.0 && ramp.dx == 0.0 && ramp.dy == 0.0; };
        const auto is_exact = [&](const CloseFunction& f) { return is_zero(f.low) && 4.0 * f.error < f.grain; };
        const double q = functions.q.high.base;
        if (!is_exact(functions.q) || functions.q.high.dx != 0.0 || functions.q.high.dy != 0.0) return false;
        Ramp quotient[2];
        for (std::size_t k = 0; k < 2; ++k) {
            const Ramp& f = functions.numerator[k].high;
            quotient[k] = {f.base / q, f.dx / q, f.dy / q};
            const auto is_quotient = [q](double u, double numerator) {
                const DoubleDouble product = two_product(u, q);
                return product.high == numerator && product.low == 0.0;
            };
            const auto& [base, dx, dy] = quotient[k];
            const double size = std::fabs(base) + job.width * std::fabs(dx) + job.height * std::fabs(dy);
            const double bit = smaller(smaller(last_bit(base), last_bit(dx)), last_bit(dy));
            if (!is_exact(functions.numerator[k]) || !(size < 0x1p52 * bit) || !is_quotient(base, f.base) ||
                !is_quotient(dx, f.dx) || !is_quotient(dy, f.dy))
                return false;
        }
        for (std::size_t k = 0; k < 2; ++k) {
            job.numerator[k] = quotient[k];
            job.quotient_error[k] = 0.0;
        }
        job.q = {1.0, 0.0, 0.0};
        job.q_is_constant = true;
        return true;
    }

    // A small tile, by one job for all that there are: with the planes as they are, and closely only if that leaves doubt. What
    // a last vector writes beyond the tile is to its right, where the halves come later.
    void divide_closely(const Tile& tile, const Corners& at) noexcept {
        const int x = static_cast<int>(tile.x - whole_.x);
        const int y = static_cast<int>(tile.y - whole_.y);
        const TileJob::Unit unit{x, x + tile.width, y, y + tile.height};
        if (!closely_) {
            closely_.emplace(job(whole_, at), (close_ ? close_ramps(whole_) : plain_ramps()).split());
            closely_->first.is_contiguous = false;
        }
        const auto& [job, functions] = *closely_;
        std::uint64_t doubtful = kernels_.divide_closely(job, functions, unit);
        if (doubtful != 0 && !close_) {
            closely_->second = close_ramps(whole_).split();
            doubtful = kernels_.divide_closely(job, functions, unit);
        }
        shade_some(whole_, unit, doubtful);
    }

    // The planes as they are.
    CloseRamps plain_ramps() const noexcept {
        const Corners at = corners_of(setup_.planes_, planes_, setup_.q_, whole_);
        const auto plain = [](double base, double dx, double dy, double error) {
            return CloseRamp{{{base, 0.0}, {dx, 0.0}, {dy, 0.0}}, error, 0.0};
        };
        const auto numerator = [&](std::size_t k) {
            const auto& [base, dx, dy] = at.numerator_ramp;
            return plain(base[k], dx[k], dy[k], at.numerator_error[k]);
        };
        return {whole_, {numerator(0), numerator(1), plain(at.q_ramp.base, at.q_ramp.dx, at.q_ramp.dy, at.q_error)}};
    }

    // Fragments of a unit, one by one: a bit for each.
    void shade_some(const Tile& tile, const TileJob::Unit& unit, std::uint64_t fragments) noexcept {
        const int width = unit.x_end - unit.x_begin;
        for (; fragments != 0; fragments &= fragments - 1) {
            const int i = std::countr_zero(fragments);
            shade_one(tile.x + unit.x_begin + i % width, tile.y + unit.y_begin + i / width);
        }
    }

    void divide_chunks(const Tile& tile, const Corners& at, const Plan& plan) noexcept {
        TileJob job = this->job(tile, at);
        job.chunk = plan.chunk;
        job.factors = plan.factors;
        job.tolerance = setup_.tolerance_ * (1.0 - 0x1p-20);
        job.q_error = at.q_error;
        job.least_q = 0x1p24 * at.q_error;
        for (std::size_t k = 0; k < 2; ++k) job.numerator_error[k] = at.numerator_error[k];
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
        const Pair error = rounded_error(at);
        const bool fits = at.well_in_front() && at.least_q > 0x1p-20 * at.largest_q && error[0] <= setup_.tolerance_ &&
                          error[1] <= setup_.tolerance_;
        if (!fits) return divide_nearest(tile, at);
        kernels_.divide_rounded(job(tile, at, reciprocal_power_of_two(at.largest_q)));
    }

    // The error of F/Q with F and Q rounded to float, then the reciprocal and the product: 4 u |F/Q|, u = 2^-24. With
    // 2^-21 <= Q <= 2 a float of F that is subnormal, or flushed to zero, adds less than 2^-104.
    Pair rounded_error(const Corners& at) const noexcept {
        const Pair largest = at.largest_quotient();
        return largest * (4.01 * unit_roundoff_float) + 0x1p-104 + at.quotient_error(largest);
    }

    // One fragment, every decision exact.
    void shade_one(std::int64_t x, std::int64_t y) noexcept {
        const TrianglePlanes& planes = setup_.planes_;
        const TrianglePlanes::Exact q = planes.exactly_at(3, x, y);
        const bool in_front = q.sign() > 0;
        float value[2] = {0.0f, 0.0f};
        for (std::size_t k = 0; k < count_; ++k) {
            if (in_front) value[k] = nearest_quotient(planes.exactly_at(coordinate_[k], x, y), q);
            if (!output_[k].empty()) output_[k][offset(x, y)] = value[k];
        }
        if (!lit_.empty()) lit_[offset(x, y)] = in_front ? setup_.lit_(value[0], value[1]) : 0.0f;
    }

    void clear(const Tile& tile) noexcept {
        for (const std::span<float>& output : {output_[0], output_[1], lit_}) {
            if (output.empty()) continue;
            for (std::int64_t y = tile.y; y < tile.y + tile.height; ++y) {
                float* const row = output.data() + offset(tile.x, y);
                for (int i = 0; i < tile.width; ++i) row[i] = 0.0f;
            }
        }
    }

    // What every kernel needs. A factor that the numerators and q share is free.
    TileJob job(const Tile& tile, const Corners& at, double factor = 1.0) noexcept {
        TileJob job{};
        job.numerators = static_cast<int>(count_);
        job.width = tile.width;
        job.height = tile.height;
        job.q = {at.q_ramp.base * factor, at.q_ramp.dx * factor, at.q_ramp.dy * factor};
        job.q_is_constant = is_constant(at.q_ramp);
        job.pitch = rect_.width;
        job.is_contiguous = tile.width == rect_.width;
        const Pair base = at.numerator_ramp.base * factor;
        const Pair dx = at.numerator_ramp.dx * factor;
        const Pair dy = at.numerator_ramp.dy * factor;
        // One coordinate alone takes the place of both.
        for (std::size_t k = 0; k < 2; ++k) {
            const std::span<float>& output = output_[k < count_ ? k : 0];
            job.numerator[k] = {base[k], dx[k], dy[k]};
            job.is_scratch[k] = output.empty();
            job.out[k] = output.empty() ? scratch_[k] : output.data() + offset(tile.x, tile.y);
            job.is_contiguous = job.is_contiguous && !job.is_scratch[k];
        }
        if (lit_.empty()) return job;
        job.lit = lit_.data() + offset(tile.x, tile.y);
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
    PlaneOf<Pair> planes_;
    std::optional<CloseRamps>& close_;
    Tile whole_;  // what is being interpolated
    std::optional<std::pair<TileJob, CloseFunctions>> closely_;
    std::span<float> output_[2];
    std::span<float> lit_;
    float scratch_[2][scratch_width];  // coordinates that only the mask needs, a row at a time
};

}  // namespace TEXGEN_BUILD

}  // namespace TEXGEN_COMPILER
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
    const std::size_t count = detail::count_of(rect);
    bool any_output = false;
    for (std::span<float>* output : {&out.s, &out.t, &out.r, &out.lit}) {
        if (!detail::is_computed(*output, count)) *output = {};
        any_output = any_output || !output->empty();
    }

    const detail::Tile tile{rect.x, rect.y, rect.width, rect.height};
    detail::TileSurvey found = setup.survey(tile);
    const detail::Plan& plan = found.plan;
    if (plan.work == Work::nothing) {
        for (float& lit : out.lit) lit = 0.0f;
        return plan.work;
    }

    if (!any_output) return plan.work;
    const detail::TileKernels& kernels = detail::chosen<detail::TileKernels>();

    const auto interpolate_one = [&](glm::length_t coordinate, const std::span<float>& output) {
        if (output.empty()) return;
        std::optional<detail::CloseRamps> close;
        detail::TileInterpolator interpolator(kernels, setup, rect, close);
        interpolator.add(coordinate, output);
        if (coordinate == 2) return interpolator.interpolate(tile);
        interpolator.interpolate(tile, interpolator.corners(tile), plan);
    };
    const bool both = !out.s.empty() && !out.t.empty();
    if (both || !out.lit.empty()) {
        detail::TileInterpolator interpolator(kernels, setup, rect, found.close);
        interpolator.add(out.s, out.t, out.lit);
        if (both)
            interpolator.interpolate(tile, found.at, plan);
        else
            interpolator.interpolate_in_strips(tile, plan);
    } else {
        interpolate_one(0, out.s);
        interpolate_one(1, out.t);
    }
    interpolate_one(2, out.r);
    return plan.work;
}

}  // namespace TEXGEN_BUILD

}  // namespace TEXGEN_NAMESPACE
