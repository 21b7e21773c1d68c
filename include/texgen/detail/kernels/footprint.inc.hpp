// The inner loops of footprints. Included by kernels.inc.hpp.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

TEXGEN_INLINE const WideFloats& to_floats(const WideFloats& values) noexcept { return values; }

// (dx + y twist, dy - x twist) / Q^2 of s and of t. A last vector of a row, here and below, overlaps the one before.
template <class Vector, class Scalar>
TEXGEN_INLINE void differentiate_rows(const FootprintJob& job) noexcept {
    using Result = std::remove_cvref_t<decltype(to_floats(Vector()))>;
    constexpr int vector_size = static_cast<int>(sizeof(Result) / sizeof(float));
    const int count = job.width < vector_size ? job.width : vector_size;
    const int last = job.width - count;
    // In double, or of short vectors, it is no matter whether these span two lines.
    const bool begins_with_lines = std::is_same_v<Scalar, float> && vector_size > 4 &&
                                   4 * std::int64_t{job.width} * job.height > floats_in_first_cache;
    const Vector lane = indices<Vector>();
    const auto q_dx = static_cast<Scalar>(job.q.dx);
    const auto s_dy = static_cast<Scalar>(job.slope[0].dy);
    const auto t_dy = static_cast<Scalar>(job.slope[1].dy);
    const auto s_twist = static_cast<Scalar>(-job.slope[0].twist);
    const auto t_twist = static_cast<Scalar>(-job.slope[1].twist);
    const auto put = [count](float* to, int x, const Vector& values) {
        if (to != nullptr) store_some<Result>(to + x, count, to_floats(values));
    };
    for (int y = 0; y < job.height; ++y) {
        const auto q = static_cast<Scalar>(job.q.base + y * job.q.dy);
        const auto s_dx = static_cast<Scalar>(job.slope[0].dx + y * job.slope[0].twist);
        const auto t_dx = static_cast<Scalar>(job.slope[1].dx + y * job.slope[1].twist);
        float* const dsdx = job.row(job.dx[0], y);
        float* const dtdx = job.row(job.dx[1], y);
        float* const dsdy = job.row(job.dy[0], y);
        float* const dtdy = job.row(job.dy[1], y);
        const float* const first = dsdx != nullptr ? dsdx : dtdy;
        for (int x = 0;;) {
            const Vector index = lane + static_cast<Scalar>(x);
            const Vector reciprocal = Scalar(1) / (index * q_dx + q);
            const Vector squared = reciprocal * reciprocal;
            put(dsdx, x, squared * s_dx);
            put(dtdx, x, squared * t_dx);
            put(dsdy, x, squared * (index * s_twist + s_dy));
            put(dtdy, x, squared * (index * t_twist + t_dy));
            if (x == last) break;
            x = begins_with_lines && first != nullptr ? static_cast<int>(next_in_line<Result>(first, x, last))
                : x + count < last                    ? x + count
                                                      : last;
        }
    }
}

template <class CompiledWhereCalled = void>
void differentiate(const FootprintJob& original) noexcept {
    const FootprintJob job = original;
    if (job.derivatives_in_float)
        differentiate_rows<WideFloats, float>(job);
    else
        differentiate_rows<Doubles, double>(job);
}

// base + dx i of each index i: in float, or in double and rounded.
template <bool InFloat>
TEXGEN_INLINE WideFloats linear(const WideFloats& index, double base, double dx) noexcept {
    if constexpr (InFloat) return index * static_cast<float>(dx) + static_cast<float>(base);
    return in_double([&](const Doubles& i) { return i * dx + base; }, index);
}

TEXGEN_INLINE WideFloats larger_of(const WideFloats& a, const WideFloats& b) noexcept {
    return from_bits(maximum(signed_bits(a), signed_bits(b)));  // for numbers that are not negative
}

// 1/2 log2(a / b) for normal a, b > 0, within 2^-23. With a = 2^i m, b = 2^j n and s = (m - n) / (m + n) it is
// (i - j)/2 + artanh(s) / ln 2, and |s| < 1/3: the polynomial meets the latter at the zeros of a Chebyshev polynomial,
// within 2^-24.4.
TEXGEN_INLINE WideFloats half_log2_of_quotient(const WideFloats& a, const WideFloats& b) noexcept {
    const auto mantissa = [](const WideFloats& value) {
        return from_bits((signed_bits(value) & (WideWords{} + 0x7fffff)) | (WideWords{} + 0x3f800000));
    };
    const auto exponent = [](const WideFloats& value) { return signed_bits(value) & (WideWords{} + 0x7f800000); };
    const WideFloats m = mantissa(a), n = mantissa(b);
    const WideFloats s = (m - n) * (1.0f / (m + n));
    const WideFloats x = s * s;
    const WideFloats series = ((x * 0.252369056f + 0.284511161f) * x + 0.481025008f) * x + 1.44269398f;
    return series * s + to_numbers(exponent(a) - exponent(b)) * 0x1p-24f;
}

// 1 / sqrt(x) of normal numbers, within 2^-22 of itself; finite for 0: Newton's iteration from a guess within 3.5 %.
TEXGEN_INLINE WideFloats inverse_square_root(const WideFloats& x) noexcept {
    WideFloats y = from_bits((WideWords{} + 0x5f3759df) - halved(signed_bits(x)));
    for (int i = 0; i < 3; ++i) y = y * (1.5f - (x * 0.5f * y) * y);
    return y;
}

// The larger eigenvalue of J J^T = ((a, b), (b, c)), and its eigenvector: (|half| + root, b), or (b, |half| + root)
// where half < 0; (1, 0) for a circle.
struct SpectrumLanes {
    WideFloats b, half, root, largest;

    TEXGEN_INLINE SpectrumLanes(const WideFloats& a, const WideFloats& given_b, const WideFloats& c) noexcept
        : b(given_b), half((a - c) * 0.5f) {
        const WideFloats root_square = half * half + b * b;
        root = root_square * inverse_square_root(root_square);
        largest = (a + c) * 0.5f + root;
    }

    // The longer half axis, times a factor.
    TEXGEN_INLINE void find_major(const WideFloats& factor, WideFloats (&axis)[2]) const noexcept {
        const WideFloats along = magnitude(half) + root + largest * 0x1p-24f;
        const WideFloats length = largest * inverse_square_root(largest * (along * along + b * b)) * factor;
        const WideWords swapped = are_negative(half);
        axis[0] = select(swapped, b, along) * length;
        axis[1] = select(swapped, along, b) * length;
    }
};

// Fills rows from `first` on, up to the first with a fragment whose derivatives are too small for floats (it is written
// all the same); returns that row, or the height.
template <bool InFloat, bool Shape>
TEXGEN_INLINE int filter_rows(const FootprintJob& job, int first) noexcept {
    constexpr int smallest = bit_cast<int>(FootprintJob::smallest_square);
    const int count = job.width < wide_lanes ? job.width : wide_lanes, last = job.width - count;
    const WideFloats lane = indices<WideFloats>();
    for (int y = first; y < job.height; ++y) {
        const double q_base = job.q.base + y * job.q.dy;
        const double s_dx = job.texels[0].dx + y * job.texels[0].twist;
        const double t_dx = job.texels[1].dx + y * job.texels[1].twist;
        const double dx_dx = s_dx * s_dx + t_dx * t_dx;
        float* const level = job.row(job.level, y);
        float* const anisotropy = job.row(job.anisotropy, y);
        float* const major_s = job.row(job.major[0], y);
        float* const major_t = job.row(job.major[1], y);
        WideWords too_small{};
        for (int x = 0;; x = x + count < last ? x + count : last) {
            const WideFloats index = lane + static_cast<float>(x);
            const WideFloats q = linear<InFloat>(index, q_base, job.q.dx);
            const WideFloats s_dy = linear<InFloat>(index, job.texels[0].dy, -job.texels[0].twist);
            const WideFloats t_dy = linear<InFloat>(index, job.texels[1].dy, -job.texels[1].twist);
            const WideFloats square = larger_of(s_dy * s_dy + t_dy * t_dy, WideFloats{} + static_cast<float>(dx_dx));
            too_small |= less(signed_bits(square), WideWords{} + smallest);
            if (!Shape || level != nullptr) {
                const WideFloats q_q = q * q;
                store_some(level + x, count, half_log2_of_quotient(square, q_q * q_q) + job.level_offset);
            }
            if constexpr (Shape) {
                const SpectrumLanes spectrum(s_dy * s_dy + static_cast<float>(s_dx * s_dx),
                                             s_dy * t_dy + static_cast<float>(s_dx * t_dx),
                                             t_dy * t_dy + static_cast<float>(t_dx * t_dx));
                const WideFloats per_q = 1.0f / q;
                if (anisotropy != nullptr)
                    store_some(anisotropy + x, count,
                               larger_of(spectrum.largest * per_q * job.anisotropy_factor, WideFloats{} + 1.0f));
                if (major_s != nullptr || major_t != nullptr) {
                    WideFloats axis[2];
                    spectrum.find_major(per_q * per_q, axis);
                    if (major_s != nullptr) store_some(major_s + x, count, axis[0] * job.major_factor[0]);
                    if (major_t != nullptr) store_some(major_t + x, count, axis[1] * job.major_factor[1]);
                }
            }
            if (x == last) break;
        }
        if (any(too_small)) return y;
    }
    return job.height;
}

template <class CompiledWhereCalled = void>
int filter(const FootprintJob& original, int first) noexcept {
    const FootprintJob job = original;
    const bool shape = job.has_shape();
    if (job.filters_in_float) return shape ? filter_rows<true, true>(job, first) : filter_rows<true, false>(job, first);
    return shape ? filter_rows<false, true>(job, first) : filter_rows<false, false>(job, first);
}

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
