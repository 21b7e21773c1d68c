#pragma once

// What the kernels for tiles, points, segments and footprints are given and what they return (for boxes see
// box_kernels.hpp): plain numbers and arrays, so that a table of kernels serves files of all compilers and flags.

#include <cstddef>
#include <cstdint>

#include "../language.hpp"
#include "tiers.hpp"

namespace TEXGEN_DETAIL {

// Linear functions over a rectangle of fragments: base at its first fragment.
template <class Number>
struct RampOf {
    Number base, dx, dy;
};
using Ramp = RampOf<double>;

// Two linear functions, each coefficient of both side by side: compilers load such a pair as 16 bytes, and a load waits
// for two stores of 8.
struct TwoRamps {
    alignas(16) double base[2];
    double dx[2], dy[2];
};

template <class Number>
bool is_constant(const RampOf<Number>& ramp) noexcept {
    return ramp.dx == 0 && ramp.dy == 0;
}

// F(p) = base + (p - a) . (dx, dy), about the first vertex, which has the largest w: nothing cancels there that does
// not cancel in the triangle itself. `magnitude` is the same with the absolute values of all terms: it bounds the
// rounding errors.
template <class Number>
struct PlaneOf {
    RampOf<Number> value;
    RampOf<Number> magnitude;
};
using Plane = PlaneOf<double>;

inline constexpr int longest_chunk = 256;
// Of more floats than that the first cache does not hold all lines, so that it matters how vectors lie in them: see
// next_in_line().
inline constexpr std::int64_t floats_in_first_cache = 8192;

// The index of the column or row whose fragments have this coordinate, among `size` from `first` on; -1 if none has.
inline int index_at(double coordinate, std::int64_t first, int size) noexcept {
    const double index = (coordinate - 0.5) - static_cast<double>(first);  // integers
    return index >= 0.0 && index < size && static_cast<int>(index) == index ? static_cast<int>(index) : -1;
}

// numerator[k] / q over a rectangle, into out[k]; lit (or null) says what is in the closed region. One numerator alone
// is in both places. Rows of the outputs are pitch apart; an output that only the mask needs (is_scratch) has one row,
// which all rows overwrite.
struct TileJob {
    int width, height;
    int chunk = 0;                         // the most fragments of a row in a chunk
    StepRule steps = StepRule::undecided;  // the rule of all chunks
    TwoRamps numerator;
    Ramp q;
    bool q_is_constant;
    bool is_in_float = false;        // numerators and q are rounded to float, then divided
    double quotient_error[2] = {};   // for fill_exact; 0 where the float nearest to a quotient in double will do
    std::int32_t ulps = 0;           // see Corners::ulps_of_quotients
    double numerator_error[2] = {};  // this and what follows: for fill_polynomial
    double q_error = 0.0;
    double least_q = 0.0;  // below it no certificate holds
    double tolerance = 0.0;
    float* out[2];
    bool is_scratch[2];
    float* lit;
    std::ptrdiff_t pitch;
    bool is_contiguous;    // rows follow one another in all outputs
    float min[2], max[2];  // the region

    // The job is done, checked and resumed in units of about 64 fragments: a part of a row, or several short rows.
    // After the last unit comes an empty one.
    struct Unit {
        int x_begin, x_end, y_begin, y_end;
    };

    Unit filled = {0, 0, 0, 0};  // the columns in which chunks without a rule are filled already, down to the last row

    static constexpr int unit_size = 64;
    static constexpr int longest_vector = 16;  // the most floats in one
    static constexpr int longest_pair = 16;    // at most so many fragments share a division, in vectors of any size

    int length_of_chunk(int begin) const noexcept { return chunk < width - begin ? chunk : width - begin; }

    Unit unit_at(int x, int y, int size = unit_size) const noexcept {
        const int rows = x != 0 || width >= size ? 1 : size / width;
        return {x, size < width - x ? x + size : width, y, rows < height - y ? y + rows : height};
    }
    Unit unit_after(const Unit& unit, int size = unit_size) const noexcept {
        return unit.x_end < width ? unit_at(unit.x_end, unit.y_begin, size) : unit_at(0, unit.y_end, size);
    }
    bool is_done(const Unit& unit) const noexcept { return unit.y_begin >= height; }

    // Whether its outputs have more floats than that.
    bool is_beyond(std::int64_t floats) const noexcept {
        return static_cast<std::int64_t>(width) * height * (lit == nullptr ? 2 : 3) > floats;
    }
};

// A tile of few fragments that one certificate serves, see small_tile.inc.hpp.
struct SmallTile {
    TwoRamps numerator;
    Ramp q;
    int width, height;
    bool is_in_float;  // rounded to float and divided, which leaves no doubt; its shape is one for that
    bool is_certain;   // within the tolerance in double, and in no doubt
    float* out[2];
    float* lit;            // or null
    float min[2], max[2];  // the region

    // A quotient in double that is within so many ulps of half-way between two floats is in doubt.
    static constexpr int ulps = 0xfff;
    // The most fragments of rows that are shorter than vectors.
    static constexpr int most_in_short_rows = 2048;
};

// Where a row of a TileJob goes. A copy, so that the compiler knows that no store changes it.
struct RowOutputs {
    float* out[2];
    std::ptrdiff_t pitch[2];
    float* lit;
    std::ptrdiff_t lit_pitch;
    std::int64_t writable;  // floats from its first fragment on: with the rows below, where these follow
    std::int64_t writable_pitch;

    TEXGEN_APART RowOutputs(const TileJob& job, int y) noexcept
        : lit(job.lit == nullptr ? nullptr : job.lit + y * job.pitch),
          lit_pitch(job.lit == nullptr ? 0 : job.pitch),
          writable(job.is_contiguous ? (job.height - std::int64_t{y}) * job.width : job.width),
          writable_pitch(job.is_contiguous ? job.width : 0) {
        for (std::size_t k = 0; k < 2; ++k) {
            pitch[k] = job.is_scratch[k] ? 0 : job.pitch;
            out[k] = job.out[k] + y * pitch[k];
        }
    }

    void advance() noexcept {
        for (std::size_t k = 0; k < 2; ++k) out[k] += pitch[k];
        lit += lit_pitch;
        writable -= writable_pitch;
    }
};

// Chunks that follow one another, over the ends of rows too: their coefficients, and each one's rule if the job has
// none.
struct ChunkGroup {
    static constexpr int size = 16;

    float bend[size];
    float middle[2][size], slope[2][size];
    float rule[size];
    // Of the fragments of a chunk, or of its first half, from its middle; and a vector more.
    alignas(64) float index[longest_chunk + TileJob::longest_vector];
    int indexed = 0;  // the length of that chunk

    StepRule rule_of(const TileJob& job, int i) const noexcept {
        return job.steps == StepRule::undecided ? static_cast<StepRule>(static_cast<int>(rule[i])) : job.steps;
    }
};

// A linear function of a tile to twice the precision of double: high + low is within `error` of the exact one. The
// coefficients of high are multiples of a unit in which no value of the tile needs more than 52 bits, so that its
// arithmetic is exact; those of low are what is left below the unit. The exact value is an integer times `grain` (0
// where that is not known), and the residue is that integer modulo 2^64: it is all of what is certainly less than 2^62
// grains.
struct CloseFunction {
    Ramp high, low{};
    double error, grain = 0.0;
    RampOf<std::uint64_t> residue{};
};
struct CloseFunctions {
    static constexpr std::size_t q = 2;

    CloseFunction function[3];  // two numerators, and q
    double tolerance;           // within which the float nearest to a quotient in double will do
    bool are_close = false;     // in two doubles; else high alone, the planes
    bool have_residues = false;
    bool are_sums_first = false;  // the sums of high and low say more than residues do
};

// A linear form of points (x, y, z, 1).
struct PointForm {
    double x, y, z, w;
};

// The number of points, and of values along a segment, that a kernel does is a multiple of point_quantum; of points
// that are not divided it is any from there on.
inline constexpr std::size_t point_quantum = 16;
inline constexpr std::size_t exact_block = 64;
inline constexpr std::size_t float_block = 256;

// One or two divided coordinates in arrays, and their mask.
struct DividedOutput {
    std::size_t count;
    int numerators;
    bool interleaved_st;  // both coordinates follow one another from out[0] on; else there is an array for each
    float* out[2];
    float* lit;            // or null
    float min[2], max[2];  // the region
};

struct PointInput {
    bool interleaved_xyz;  // x, y, z follow one another from `x` on; else there are three arrays
    const float* x;
    const float* y;
    const float* z;

    void advance(std::size_t points) noexcept {
        x += interleaved_xyz ? 3 * points : points;
        y += points;
        z += points;
    }
};

// numerator[k] / q at points.
struct PointJob : DividedOutput, PointInput {
    PointForm numerator[2];
    PointForm q;
    double tolerance;
    // What follows from bounds on all points.
    bool is_certified;  // a division in float is inside the tolerance for all points
    std::int32_t ulps;  // that quotients in double are within, 1 less than a power of two; 0 where that is not known
};

// (1 - alpha) a + alpha b of floats as base + alpha (step + rest): both products with a float are exact.
struct Mixture {
    enum Kind : std::int32_t {
        is_short,      // there is no rest, so the sum in double is rounded once
        is_long,       // the rest is what 29 bits leave of b - a
        is_far,        // b - a is no double: step and rest are the ends, one of them negated
        is_not_finite  // base and step are the ends
    };

    double base, step, rest;
    Kind kind;
};

// numerator[k] / q along a segment: values at alpha = 0 and at alpha = 1.
struct SegmentJob : DividedOutput {
    const float* alpha;
    double a[2], b[2];  // one numerator alone is in both places
    double q_a, q_b;
    double tolerance;
    bool is_in_float, is_quick;  // fill_all_float fits the tolerance; else fill_in_double is worth a try
    // For these two kernels, where all is in front. In double about the asymptote (is_asymptotic), base being what
    // quotients tend to as alpha goes to infinity: base + slope / (alpha + pole); else (base + slope alpha) / (pole +
    // bend alpha). In float, about the end where q is less: base + slope i / (1 + bend i), with i the alpha counted
    // from there; the slope of the steeper coordinate is `step`, that of the other `share` of it.
    bool is_asymptotic;
    bool about_b;
    double base[2], slope[2], pole, bend;
    int steeper;
    double step, share;
    std::int32_t ulps;  // that quotients in double are within, 1 less than a power of two
    bool are_accepted;  // by the tolerance, whichever of two floats they are rounded to
    float small_alpha;  // only for alphas in (0, small_alpha] floats may be subnormal, and the ulps too few
    // For fill_exact.
    Mixture numerator[2];
    Mixture q;
    bool are_short;       // all mixtures
    float inexact_alpha;  // only for alphas in (0, inexact_alpha] sums in two doubles may not be exact

    void advance(std::size_t values) noexcept { alpha += values; }
};

// Forms at points, not divided, rounded to float. An output is null or an array; or all go to `strq`, four by four.
struct GenerateJob : PointInput {
    std::size_t count;
    PointForm form[4];
    float* out[4];
    float* strq;
};

// The outputs of footprints, null or arrays: derivatives by x and by y of s and of t, and what filters make of them.
struct FootprintArrays {
    float* dx[2];
    float* dy[2];
    float* level;
    float* anisotropy;
    float* major[2];

    bool has_derivatives() const noexcept {
        return dx[0] != nullptr || dx[1] != nullptr || dy[0] != nullptr || dy[1] != nullptr;
    }
    bool has_shape() const noexcept { return anisotropy != nullptr || major[0] != nullptr || major[1] != nullptr; }
    bool are_filtered() const noexcept { return level != nullptr || has_shape(); }
};

// Footprints over a rectangle. Slopes are d/dx Q^2 and d/dy Q^2; rows of the arrays are pitch apart.
struct FootprintJob : FootprintArrays {
    struct Slope {
        double dx, dy;
        double twist;  // a step of y adds it to dx, a step of x takes it from dy
    };

    // Filters need a sum of two squares of `texels` of at least this in float, when the job's largest is about 1.
    static constexpr float smallest_square = 0x1p-24f;

    int width, height;
    Ramp q;
    Slope slope[2];
    Slope texels[2];  // the same in texels, times a factor that level_offset and the factors below make good
    bool derivatives_in_float, filters_in_float;
    float level_offset, anisotropy_factor, major_factor[2];
    std::ptrdiff_t pitch;

    float* row(float* output, int y) const noexcept { return output == nullptr ? nullptr : output + y * pitch; }
};

struct TileKernels {
    // Whether no value is in doubt.
    bool (*fill_small)(const SmallTile&) noexcept;
    // divide() returns which fragments of the part are in doubt: of a unit, a bit for each, row by row; of more units,
    // only whether it is 0. divide_in_pairs(), for a job that knows its ulps, returns the first unit in doubt.
    std::uint64_t (*divide)(const TileJob&, const TileJob::Unit& part) noexcept;
    TileJob::Unit (*divide_in_pairs)(const TileJob&, const TileJob::Unit& first) noexcept;
    // weigh_chunks() makes a group of `count` chunks, beginning with one of row y; fill_chunks() fills those from
    // `first` to `end`, which have one rule and begin at x of the row.
    void (*weigh_chunks)(const TileJob&, ChunkGroup&, int chunks_of_row, int y, int chunk, int count) noexcept;
    void (*fill_chunks)(const TileJob&, const RowOutputs&, ChunkGroup&, int first, int end, int x) noexcept;
    // Decides fragments of a unit, bits as above, on either side of the projector. Returns those that stay in doubt.
    std::uint64_t (*fill_closely)(const TileJob&, const CloseFunctions&, const TileJob::Unit& unit,
                                  std::uint64_t asked) noexcept;
};

// Where a kernel stops: at the first block with values that it cannot decide (bit i: value begin + i), or at the count.
// Blocks end at multiples of exact_block.
struct Undecided {
    std::size_t begin;
    std::uint64_t values;
};

struct PointKernels {
    Undecided (*fill_exact)(const PointJob&, std::size_t first) noexcept;
    // The same, within the tolerance.
    Undecided (*fill_within)(const PointJob&, std::size_t first) noexcept;
    void (*generate)(const GenerateJob&) noexcept;
};

struct SegmentKernels {
    Undecided (*fill_exact)(const SegmentJob&, std::size_t first) noexcept;
    // Returns where the first block of float_block begins that has a value near the middle of two floats, or an alpha
    // that is no number or too small; or the count.
    std::size_t (*fill_in_double)(const SegmentJob&, std::size_t first) noexcept;
    // Returns where the first block of float_block with an alpha that is no number begins, or the count.
    std::size_t (*fill_all_float)(const SegmentJob&, std::size_t first) noexcept;
};

// light_all() makes the mask of what is certainly inside; darken() makes it 0 where r is not in [min, max].
struct MaskKernels {
    void (*light_all)(float* lit, std::size_t count) noexcept;
    void (*darken)(float* lit, const float* r, std::size_t count, float min, float max) noexcept;
};

struct FootprintKernels {
    void (*differentiate)(const FootprintJob&) noexcept;
    // Returns the first row from `first` on with a fragment that floats do not serve, or the height.
    int (*filter)(const FootprintJob&, int first) noexcept;
};

}  // namespace TEXGEN_DETAIL
