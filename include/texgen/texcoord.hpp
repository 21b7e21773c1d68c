#pragma once

// Floor 4: texture coordinates of points. generate() gives the homogeneous (s, t, r, q) that a fragment shader divides (see
// README.md, "In a shader"); project() divides them here, and says which points the slide falls on.

#include "detail/language.hpp"

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <span>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "conventions.hpp"
#include "detail/arithmetic/nearest.hpp"
#include "detail/arithmetic/widen.hpp"
#include "detail/assert.hpp"
#include "detail/culling/lit_test.hpp"
#include "detail/simd/lanes.hpp"
#include "transform.hpp"

namespace TEXGEN_NAMESPACE {

// Divided coordinates, planar. An empty span is not computed. lit is 1 where the slide falls and 0 elsewhere.
struct Texcoords {
    std::span<float> s, t, r, lit;
};

// Homogeneous coordinates, planar. An empty span is not computed.
struct HomogeneousTexcoords {
    std::span<float> s, t, r, q;
};

// A view of points with w = 1 in a known space: three arrays of floats that share a stride. It owns nothing, and reads
// floats at any alignment. Made by object_space(), world_space() and eye_space().
template <class Space>
class Positions {
public:
    // Precondition: each pointer addresses `count` floats, `stride_bytes` apart.
    Positions(const float* x, const float* y, const float* z, std::size_t count, std::size_t stride_bytes) noexcept
        : x_(x), y_(y), z_(z), count_(count), stride_bytes_(stride_bytes) {}

    std::size_t size() const noexcept { return count_; }

    // Whether the layout is one that needs no gathering: one array of vectors, or three arrays of floats, aligned.
    bool is_interleaved() const noexcept {
        return count_ != 0 && stride_bytes_ == 3 * sizeof(float) && y_ == x_ + 1 && z_ == x_ + 2 && is_aligned(x_);
    }
    bool is_planar() const noexcept {
        return stride_bytes_ == sizeof(float) && is_aligned(x_) && is_aligned(y_) && is_aligned(z_);
    }

    const float* x() const noexcept { return x_; }
    const float* y() const noexcept { return y_; }
    const float* z() const noexcept { return z_; }

    glm::vec3 operator[](std::size_t i) const noexcept {
        return {load(x_, i * stride_bytes_), load(y_, i * stride_bytes_), load(z_, i * stride_bytes_)};
    }

private:
    static bool is_aligned(const float* first) noexcept {
        return reinterpret_cast<std::uintptr_t>(first) % alignof(float) == 0;
    }
    static float load(const float* first, std::size_t offset_bytes) noexcept {
        float value;
        std::memcpy(&value, reinterpret_cast<const std::byte*>(first) + offset_bytes, sizeof value);
        return value;
    }

    const float* x_;
    const float* y_;
    const float* z_;
    std::size_t count_;
    std::size_t stride_bytes_;
};

namespace detail {
inline namespace TEXGEN_COMPILER {

template <class Space>
Positions<Space> interleaved(std::span<const glm::vec3> points) noexcept {
    if (points.empty()) return {nullptr, nullptr, nullptr, 0, sizeof(glm::vec3)};
    const glm::vec3* first = points.data();
    return {&first->x, &first->y, &first->z, points.size(), sizeof(glm::vec3)};
}

template <class Space>
Positions<Space> planar(std::span<const float> x, std::span<const float> y, std::span<const float> z) noexcept {
    TEXGEN_ASSERT(x.size() == y.size() && x.size() == z.size());
    return {x.data(), y.data(), z.data(), x.size(), sizeof(float)};
}

template <class Space>
Positions<Space> strided(const float* first, std::size_t count, std::size_t stride_bytes) noexcept {
    return {first, first + (count != 0 ? 1 : 0), first + (count != 0 ? 2 : 0), count, stride_bytes};
}

}  // namespace TEXGEN_COMPILER
}  // namespace detail

// Points of a space from an array of vectors, from three arrays (of one size, asserted), or from x, y, z that follow one
// another every stride_bytes.
inline Positions<Object> object_space(std::span<const glm::vec3> points) noexcept {
    return detail::interleaved<Object>(points);
}
inline Positions<Object> object_space(std::span<const float> x, std::span<const float> y,
                                      std::span<const float> z) noexcept {
    return detail::planar<Object>(x, y, z);
}
inline Positions<Object> object_space(const float* first, std::size_t count, std::size_t stride_bytes) noexcept {
    return detail::strided<Object>(first, count, stride_bytes);
}

// The same of points in the world.
inline Positions<World> world_space(std::span<const glm::vec3> points) noexcept {
    return detail::interleaved<World>(points);
}
inline Positions<World> world_space(std::span<const float> x, std::span<const float> y,
                                    std::span<const float> z) noexcept {
    return detail::planar<World>(x, y, z);
}
inline Positions<World> world_space(const float* first, std::size_t count, std::size_t stride_bytes) noexcept {
    return detail::strided<World>(first, count, stride_bytes);
}

// The same of points in the eye's space.
inline Positions<Eye> eye_space(std::span<const glm::vec3> points) noexcept { return detail::interleaved<Eye>(points); }
inline Positions<Eye> eye_space(std::span<const float> x, std::span<const float> y, std::span<const float> z) noexcept {
    return detail::planar<Eye>(x, y, z);
}
inline Positions<Eye> eye_space(const float* first, std::size_t count, std::size_t stride_bytes) noexcept {
    return detail::strided<Eye>(first, count, stride_bytes);
}

namespace detail {
inline namespace TEXGEN_COMPILER {

// A row of a texgen matrix as a linear form of points with w = 1.
inline PointForm form(const glm::dmat4& matrix, int row) noexcept {
    const auto i = static_cast<glm::length_t>(row);
    return {matrix[0][i], matrix[1][i], matrix[2][i], matrix[3][i]};
}

// The sum of the terms' magnitudes.
inline double terms_at(const PointForm& form, const glm::dvec3& v) noexcept {
    return std::fabs(form.x * v.x) + std::fabs(form.y * v.y) + std::fabs(form.z * v.z) + std::fabs(form.w);
}

// Three products and three sums: each term is rounded four times at most.
inline Bounded value_at(const PointForm& form, const glm::dvec3& v) noexcept {
    return {form.x * v.x + form.y * v.y + form.z * v.z + form.w, gamma(5) * terms_at(form, v)};
}

inline Expansion<8> exactly_at(const PointForm& form, const glm::dvec3& v) noexcept {
    Expansion<8> sum;
    sum.add_product(form.x, v.x);
    sum.add_product(form.y, v.y);
    sum.add_product(form.z, v.z);
    sum.add(form.w);
    return sum;
}

// The value at a point, and a bound on its error that is small beside it: from the exact sum where the terms cancel.
// A NaN or an infinity stays one in the error.
inline Bounded closely_at(const PointForm& form, const glm::dvec3& v) noexcept {
    const Bounded close = value_at(form, v);
    if (std::fabs(close.value) > 0x1p20 * close.error || !(close.error < 0x1p1000)) return close;
    const double value = exactly_at(form, v).estimate();
    return {value, 0x1p-48 * std::fabs(value)};
}

inline bool is_computed(const std::span<float>& output, std::size_t count) noexcept {
    TEXGEN_ASSERT(output.empty() || output.size() == count);
    return !output.empty() && output.size() == count;
}

// The array of an output that is computed, or null. The span comes by reference, here and everywhere: where a function takes
// it by value, out of an aggregate that the caller has by reference, and returns its pointer, GCC 12 at -O2 and -Os
// forgets that what it points to is written, and the user's variables keep what they held (bug 115033 of GCC).
inline float* array_of(const std::span<float>& output, std::size_t count) noexcept {
    return is_computed(output, count) ? output.data() : nullptr;
}

// Calls batch(x, y, z, triples, first, count, whole) for parts of the positions that the kernels can read: arrays of
// x, y, z, or triples from x on. Where the count is no multiple of point_quantum, or the layout is none of theirs, the
// part is a copy, padded with its last point to a whole number of quanta.
template <class Space, class Batch>
void for_each_batch(const Positions<Space>& positions, const Batch& batch) noexcept {
    const std::size_t count = positions.size();
    std::size_t first = 0;
    if (positions.is_planar() || positions.is_interleaved()) {
        first = count / point_quantum * point_quantum;
        if (first != 0)
            batch(positions.x(), positions.y(), positions.z(), positions.is_interleaved(), std::size_t{0}, first,
                  first);
    }
    constexpr std::size_t copy_size = 256;
    float x[copy_size];
    float y[copy_size];
    float z[copy_size];
    while (first < count) {
        const std::size_t part = count - first < copy_size ? count - first : copy_size;
        const std::size_t whole = (part + point_quantum - 1) / point_quantum * point_quantum;
        for (std::size_t i = 0; i < whole; ++i) {
            const glm::vec3 point = positions[first + (i < part ? i : part - 1)];
            x[i] = point.x;
            y[i] = point.y;
            z[i] = point.z;
        }
        batch(x, y, z, false, first, part, whole);
        first += part;
    }
}

// One point of a job, every decision exact.
inline void project_one(const PointJob& job, std::size_t i) noexcept {
    const glm::dvec3 v = job.triples ? widened(glm::vec3(job.x[3 * i], job.x[3 * i + 1], job.x[3 * i + 2]))
                                     : widened(glm::vec3(job.x[i], job.y[i], job.z[i]));
    const auto exact_q = [&] { return exactly_at(job.q, v); };
    const Bounded q = value_at(job.q, v);
    const bool in_front = certain_sign(q, exact_q) > 0;
    float value[2] = {0.0f, 0.0f};
    for (int k = 0; k < job.numerators; ++k) {
        const PointForm& numerator = job.numerator[k];
        if (in_front)
            value[k] = certain_quotient(
                value_at(numerator, v), q, [&] { return exactly_at(numerator, v); }, exact_q);
        if (job.pairs)
            job.out[0][2 * i + static_cast<std::size_t>(k)] = value[k];
        else
            job.out[k][i] = value[k];
    }
    if (job.lit != nullptr) job.lit[i] = in_front && is_inside(value[0], value[1], job.min, job.max) ? 1.0f : 0.0f;
}

inline namespace TEXGEN_BUILD {

// The values of a job from `first` on by its kernel, and by one(job, i) what that cannot decide.
template <class Kernel, class Job, class One>
void divide_blocks(Kernel kernel, const Job& job, std::size_t first, const One& one) noexcept {
    for (Undecided left = kernel(job, first); left.begin < job.count; left = kernel(job, first)) {
        for (std::uint64_t values = left.values; values != 0; values &= values - 1)
            one(job, left.begin + static_cast<std::size_t>(std::countr_zero(values)));
        first = (left.begin / nearest_block + 1) * nearest_block;
    }
}

// Points begin to end of a job: in vectors; what those cannot decide point by point.
inline void project_nearest(const PointKernels& kernels, PointJob job, std::size_t begin, std::size_t end) noexcept {
    job.count = end;
    divide_blocks(kernels.divide_nearest, job, begin, project_one);
}

// Points begin to end by a kernel that stops at a block whose error is not certified to be inside the tolerance. Such a
// block has company: `otherwise` gets more points after each failure, until the kernel is tried again.
template <class Kernel, class Otherwise>
void project_within(Kernel kernel, PointJob job, std::size_t begin, std::size_t end,
                    const Otherwise& otherwise) noexcept {
    job.count = end;
    std::size_t pause = float_block;
    for (std::size_t i = kernel(job, begin); i < end; i = kernel(job, i)) {
        pause = pause < (end - begin) / 8 ? 8 * pause : end - begin;
        const std::size_t resume = pause < end - i ? i + pause : end;
        otherwise(job, i, resume);
        i = resume;
    }
}

// The dial: forms and division in float, else forms in double divided in float, else as exact.
inline void project_within_tolerance(const PointKernels& kernels, const PointJob& points) noexcept {
    const auto nearest = [&kernels](const PointJob& job, std::size_t begin, std::size_t end) {
        project_nearest(kernels, job, begin, end);
    };
    if (points.tolerance == 0.0) return nearest(points, 0, points.count);
    const auto rounded = [&](const PointJob& job, std::size_t begin, std::size_t end) {
        project_within(kernels.divide_rounded, job, begin, end, nearest);
    };
    project_within(kernels.divide_float, points, 0, points.count, rounded);
}

}  // namespace TEXGEN_BUILD

// Where one or two coordinates of all points go. A coordinate that only the mask needs has no array; `pairs` takes two
// coordinates in turn.
struct PointOutputs {
    float* coordinate[2] = {};
    float* lit = nullptr;
    float* pairs = nullptr;

    bool are_complete(int numerators) const noexcept {
        return pairs != nullptr || (coordinate[0] != nullptr && (numerators == 1 || coordinate[1] != nullptr));
    }
};

// Calls group(first, numerators, outputs) for the coordinates that are computed together: s and t where both are asked for
// or the mask is, either one alone, and r.
template <class Group>
void for_each_group(const Texcoords& out, std::size_t count, const Group& group) noexcept {
    float* const s = array_of(out.s, count);
    float* const t = array_of(out.t, count);
    float* const r = array_of(out.r, count);
    float* const lit = array_of(out.lit, count);
    if (lit != nullptr || (s != nullptr && t != nullptr))
        group(0, 2, PointOutputs{{s, t}, lit, nullptr});
    else if (s != nullptr)
        group(0, 1, PointOutputs{{s, nullptr}, nullptr, nullptr});
    else if (t != nullptr)
        group(1, 1, PointOutputs{{t, nullptr}, nullptr, nullptr});
    if (r != nullptr) group(2, 1, PointOutputs{{r, nullptr}, nullptr, nullptr});
}

// Runs a job for `count` points or values, padded to `whole`, whose results belong at `first`. What has no place of its
// own goes through buffers.
template <class Job, class Run>
void run_batch(Job job, const PointOutputs& out, std::size_t first, std::size_t count, std::size_t whole,
               const Run& run) noexcept {
    if (count == whole && out.are_complete(job.numerators)) {
        job.count = count;
        job.pairs = out.pairs != nullptr;
        for (int k = 0; k < job.numerators; ++k)
            job.out[k] = job.pairs ? out.pairs + 2 * first : out.coordinate[k] + first;
        job.lit = out.lit != nullptr ? out.lit + first : nullptr;
        return run(job);
    }
    constexpr std::size_t buffer_size = 256;
    float buffer[3][buffer_size];
    job.out[0] = buffer[0];
    job.out[1] = buffer[1];
    job.lit = out.lit != nullptr ? buffer[2] : nullptr;
    for (std::size_t begin = 0; begin < count; begin += buffer_size) {
        job.count = whole - begin < buffer_size ? whole - begin : buffer_size;
        run(job);
        const std::size_t end = count - begin < job.count ? count - begin : job.count;
        for (std::size_t i = 0; i < end; ++i) {
            const std::size_t to = first + begin + i;
            for (std::size_t k = 0; k < 2; ++k) {
                if (out.pairs != nullptr) out.pairs[2 * to + k] = buffer[k][i];
                if (out.coordinate[k] != nullptr) out.coordinate[k][to] = buffer[k][i];
            }
            if (out.lit != nullptr) out.lit[to] = buffer[2][i];
        }
        job.advance(job.count);
    }
}

inline namespace TEXGEN_BUILD {

template <class Space>
void project_all(const Positions<Space>& positions, const PointJob& job, const PointOutputs& out) noexcept {
    const PointKernels& kernels = chosen<PointKernels>();
    for_each_batch(positions, [&](const float* x, const float* y, const float* z, bool triples, std::size_t first,
                                  std::size_t count, std::size_t whole) {
        PointJob part = job;
        part.x = x;
        part.y = y;
        part.z = z;
        part.triples = triples;
        run_batch(part, out, first, count, whole,
                  [&](const PointJob& points) { project_within_tolerance(kernels, points); });
    });
}

}  // namespace TEXGEN_BUILD

// A job without points: the forms of these rows over the row of q.
inline PointJob point_job(const glm::dmat4& matrix, int row, int numerators, const TextureRegion& region,
                          Tolerance tolerance) noexcept {
    PointJob job{};
    job.numerators = numerators;
    for (int k = 0; k < numerators; ++k) job.numerator[k] = form(matrix, row + k);
    job.q = form(matrix, 3);
    job.tolerance = accepted(tolerance);
    LitTest(region).copy_to(job.min, job.max);
    return job;
}

inline namespace TEXGEN_BUILD {

template <class Space>
void generate_all(const glm::dmat4& matrix, const Positions<Space>& positions, float* const (&out)[4],
                  float* quads) noexcept {
    GenerateJob job{};
    for (int k = 0; k < 4; ++k) job.form[k] = form(matrix, k);
    for_each_batch(positions, [&](const float* x, const float* y, const float* z, bool triples, std::size_t first,
                                  std::size_t count, std::size_t whole) {
        GenerateJob part = job;
        part.x = x;
        part.y = y;
        part.z = z;
        part.triples = triples;
        part.count = whole;
        if (count == whole) {
            part.quads = quads != nullptr ? quads + 4 * first : nullptr;
            for (std::size_t k = 0; k < 4; ++k) part.out[k] = out[k] != nullptr ? out[k] + first : nullptr;
            return chosen<PointKernels>().generate(part);
        }
        // A padded part is at most as long as for_each_batch() copies.
        float buffer[4][256];
        for (std::size_t k = 0; k < 4; ++k) part.out[k] = buffer[k];
        chosen<PointKernels>().generate(part);
        for (std::size_t i = 0; i < count; ++i) {
            for (std::size_t k = 0; k < 4; ++k) {
                if (quads != nullptr) quads[4 * (first + i) + k] = buffer[k][i];
                if (out[k] != nullptr) out[k][first + i] = buffer[k][i];
            }
        }
    });
}

}  // namespace TEXGEN_BUILD

}  // namespace TEXGEN_COMPILER
}  // namespace detail

// Guarantee: |computed - exact| of each coordinate (s, t, r, q) that generate() gives is at most this for every position,
// the rounding to float included: 1/2 ulp + 2^-50 sum |T_ij v_j|, where that is largest. No allocation, noexcept; it looks
// at every position.
// Bad input: a NaN or an infinity of a matrix's row or of a position makes a NaN or an infinity of the bounds it reaches.
template <class Space>
glm::dvec4 generate_error_bound(const Transform<Texture, Space>& texture_from_space,
                                Positions<Space> positions) noexcept {
    glm::dvec4 largest(0.0);
    for (glm::length_t k = 0; k < 4; ++k) {
        const detail::PointForm form = detail::form(texture_from_space.matrix(), k);
        for (std::size_t i = 0; i < positions.size(); ++i) {
            const detail::Bounded value = detail::value_at(form, detail::widened(positions[i]));
            const double bound = value.error + detail::half_ulp(std::fabs(value.value) + 2.0 * value.error);
            largest[k] = detail::larger_or_nan(largest[k], bound);
        }
    }
    return largest;
}

// Guarantee: |computed - exact| of s (x) and t (y) that project() gives is at most this for every position with q > 0, the
// rounding to float included; infinite where no finite bound exists. No allocation, noexcept; it looks at every position.
// Bad input: a NaN or an infinity of the matrix or of a position makes the bounds infinite.
template <class Space>
glm::dvec2 project_error_bound(const Transform<Texture, Space>& texture_from_space, Positions<Space> positions,
                               Tolerance tolerance = exact) noexcept {
    const glm::dmat4& matrix = texture_from_space.matrix();
    const detail::PointForm q_form = detail::form(matrix, 3);
    glm::dvec2 largest(0.0);
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const glm::dvec3 v = detail::widened(positions[i]);
        const detail::Bounded q = detail::closely_at(q_form, v);
        if (!(q.error < 0x1p1000)) return glm::dvec2(std::numeric_limits<double>::infinity());
        if (q.value <= 0.0) continue;
        for (glm::length_t k = 0; k < 2; ++k) {
            const detail::PointForm form = detail::form(matrix, k);
            const detail::Bounded s = detail::closely_at(form, v);
            const double quotient = (std::fabs(s.value) + s.error) / (q.value - q.error) * (1.0 + detail::gamma(4));
            const double of_nearest = detail::half_ulp(quotient);
            // Of the three ways to divide, the one in float errs most.
            const double of_float = detail::forms_in_float.error(detail::terms_at(form, v), detail::terms_at(q_form, v),
                                                                 std::fabs(v.x) + std::fabs(v.y) + std::fabs(v.z) + 1.0,
                                                                 q.value - q.error, quotient);
            const double bound = detail::larger(detail::smaller(of_float, detail::accepted(tolerance)), of_nearest);
            largest[k] = detail::larger_or_nan(largest[k], bound);
        }
    }
    return largest;
}

inline namespace TEXGEN_BUILD {

// Guarantee: T v, each coordinate within 1/2 ulp + 2^-50 sum |T_ij v_j| of its exact value; no allocation, noexcept.
// Shapes: as many outputs as positions (asserted); outputs must not overlap the positions. Units of T's region.
// Bad input: NaN and infinity spoil their own point only. q <= 0 is kept: it is the caller's to test.
// Source: Everitt, Projective Texture Mapping, (3) and (4).
template <class Space>
void generate(const Transform<Texture, Space>& texture_from_space, Positions<Space> positions,
              std::span<glm::vec4> strq) noexcept {
    TEXGEN_ASSERT(strq.size() == positions.size());
    if (strq.empty() || strq.size() != positions.size()) return;
    detail::generate_all(texture_from_space.matrix(), positions, {}, &strq[0].x);
}

// The same into one array a coordinate; an empty one is not computed.
template <class Space>
void generate(const Transform<Texture, Space>& texture_from_space, Positions<Space> positions,
              HomogeneousTexcoords out) noexcept {
    const auto array = [&](const std::span<float>& output) { return detail::array_of(output, positions.size()); };
    detail::generate_all(texture_from_space.matrix(), positions,
                         {array(out.s), array(out.t), array(out.r), array(out.q)}, nullptr);
}

// Guarantee: in front of the projector (q > 0, decided exactly) s/q, t/q and r/q within max(tolerance, 1/2 ulp) of the
// exact value of the given numbers (r: the tolerance relative to max(1, |r|)). With `exact` each is the nearest float,
// whatever the layout, the count, the place or the build, as long as no product of a matrix element and a coordinate
// leaves 2^-900 .. 2^1000. lit = 1 inside the closed region, decided from the s and t that are (or would be) written.
// Behind, s = t = r = lit = 0. No allocation, noexcept.
// Shapes: as many outputs as positions, or none (asserted); outputs must not overlap the positions.
// Bad input: NaN and infinity spoil their own point only; a point whose q is NaN is behind.
// Source: Everitt, Projective Texture Mapping, section 2; the reverse projection is behind q = 0.
template <class Space>
void project(const Transform<Texture, Space>& texture_from_space, Positions<Space> positions, TextureRegion region,
             Texcoords out, Tolerance tolerance = exact) noexcept {
    const glm::dmat4& matrix = texture_from_space.matrix();
    detail::for_each_group(out, positions.size(), [&](int row, int numerators, const detail::PointOutputs& outputs) {
        detail::project_all(positions, detail::point_job(matrix, row, numerators, region, tolerance), outputs);
    });
}

// The same into pairs, without a mask: behind the projector both are 0.
template <class Space>
void project(const Transform<Texture, Space>& texture_from_space, Positions<Space> positions, std::span<glm::vec2> st,
             Tolerance tolerance = exact) noexcept {
    TEXGEN_ASSERT(st.size() == positions.size());
    if (st.empty() || st.size() != positions.size()) return;
    detail::project_all(positions, detail::point_job(texture_from_space.matrix(), 0, 2, whole_texture(), tolerance),
                        {{}, nullptr, &st[0].x});
}

}  // namespace TEXGEN_BUILD

// Guarantee: (s/q, t/q), each the nearest float; empty for q <= 0, behind the projector, and for a NaN q. noexcept.
// A fragment shader does the same, and takes the light where it is lit (README.md has the whole of it):
//
//     vec3 light = textureProj(slide, strq).rgb;
//     bool lit = strq.q > 0.0 && st == clamp(st, region.xy, region.zw);
//
inline std::optional<glm::vec2> divide(glm::vec4 strq) noexcept {
    if (!(strq.w > 0.0f)) return std::nullopt;
    return glm::vec2(strq.x / strq.w, strq.y / strq.w);
}

}  // namespace TEXGEN_NAMESPACE
