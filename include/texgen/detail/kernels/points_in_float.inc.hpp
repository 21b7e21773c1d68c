// The inner loops of points that are divided in float, inside a tolerance. Included by kernels.inc.hpp.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

// The forms of q and of the numerators in float, in the order in which they are computed.
template <std::size_t Numerators>
struct FormsInFloat {
    float coefficient[1 + Numerators][4];

    TEXGEN_INLINE explicit FormsInFloat(const PointForm (&form)[1 + Numerators]) noexcept {
        for (std::size_t k = 0; k < 1 + Numerators; ++k) {
            coefficient[k][0] = static_cast<float>(form[k].x);
            coefficient[k][1] = static_cast<float>(form[k].y);
            coefficient[k][2] = static_cast<float>(form[k].z);
            coefficient[k][3] = static_cast<float>(form[k].w);
        }
    }
    TEXGEN_INLINE WideFloats at(std::size_t k, const WideFloats& x, const WideFloats& y,
                                const WideFloats& z) const noexcept {
        const float(&c)[4] = coefficient[k];
        return x * c[0] + (y * c[1] + (z * c[2] + c[3]));
    }
    TEXGEN_INLINE void divide(const WideFloats& x, const WideFloats& y, const WideFloats& z, const WideFloats& q,
                              WideFloats (&value)[2]) const noexcept {
        const WideFloats reciprocal = 1.0f / q;
        for (std::size_t k = 0; k < Numerators; ++k) value[k] = at(1 + k, x, y, z) * reciprocal;
    }
};

// Bounds on the errors of quotients in float, by FloatDivision::error(), in each lane. They are computed in float:
// factors cover the roundings of that, 16 units each at most.
struct FloatErrors {
    WideFloats of_form[3];   // of q and of the numerators
    WideWords are_in_range;  // the forms
    float roundings, accepted;

    // For points with these largest |x|, |y|, |z|.
    template <std::size_t Count>
    TEXGEN_INLINE FloatErrors(const FloatDivision& division, const PointForm (&form)[Count], const PointExtent& extent,
                              double tolerance) noexcept
        : are_in_range(~WideWords{}),
          roundings(static_cast<float>(division.roundings * 1.0001)),
          accepted(static_cast<float>(tolerance > 0x1p-100 ? 0.9999 * tolerance : 0.0)) {
        const auto form_error = static_cast<float>(division.form_error * 1.0001);
        const WideFloats underflow = (extent.x + extent.y + extent.z + 1.0f) * 0x1.01p-124f;
        for (std::size_t k = 0; k < Count; ++k) {
            const WideFloats terms = extent.terms_of(form[k]);
            are_in_range &= less(terms, WideFloats{} + static_cast<float>(largest_terms_in_float));
            of_form[k] = terms * form_error + underflow;
        }
    }
    // The lanes where quotients of form k are within the tolerance, if they and 1 / q are at most these. A NaN is not.
    TEXGEN_INLINE WideWords are_within(std::size_t k, const WideFloats& size,
                                       const WideFloats& reciprocal) const noexcept {
        const WideFloats error = (of_form[k] + size * of_form[0]) * (reciprocal * 1.0015f) + size * roundings;
        return less(error, WideFloats{} + accepted);
    }
};

// Where the vector behind the one at point i begins. Two planar arrays are written from planar points in whole lines of
// a cache, where vectors are as long; a block's last vector ends with it, and overlaps. The bits are the same.
template <std::size_t Numerators>
TEXGEN_INLINE std::size_t next_vector(const PointJob& job, std::size_t i, std::size_t end) noexcept {
    const std::size_t next = i + wide_at_once;
    if (wide_lanes < 16 || Numerators < 2 || job.interleaved_xyz || job.interleaved_st || next >= end) return next;
    const auto last = static_cast<std::ptrdiff_t>(end - wide_at_once);
    return static_cast<std::size_t>(next_in_line<WideFloats>(job.out[0], static_cast<std::ptrdiff_t>(i), last));
}

// Fills a block of points as if all were in front. The largest |v_j| bound the terms of the forms, and with the largest
// quotient and the least q, found on the way, the error of every point. Returns whether all are in front and inside the
// tolerance (they are written all the same). A NaN becomes the largest quotient, and fails.
template <std::size_t Numerators>
TEXGEN_INLINE bool fill_in_front(const PointJob& job, const PointForm (&of)[1 + Numerators],
                                 const FormsInFloat<Numerators>& forms, std::size_t begin, std::size_t end) noexcept {
    PointExtent extent;
    WideWords largest[Numerators] = {};
    // The bits of positive floats have their order; those of a negative one, and of -0, are below them all. A q that
    // overflows is not the least: are_in_range tells of it.
    WideWords least_q = signed_bits(WideFloats{} + static_cast<float>(largest_q_in_front));
    WideFloats x, y, z, value[2];
    for (std::size_t i = begin; i < end; i = next_vector<Numerators>(job, i, end)) {
        load_points(job, i, x, y, z);
        extent.add(x, y, z);
        const WideFloats q = forms.at(0, x, y, z);
        least_q = minimum(signed_bits(q), least_q);
        forms.divide(x, y, z, q, value);
        for (std::size_t k = 0; k < Numerators; ++k) largest[k] = maximum(magnitude_bits(value[k]), largest[k]);
        store_points(job, i, Numerators, value, ~WideWords{});
    }
    const FloatErrors errors(all_float, of, extent, job.tolerance);
    // What q is at least, from the least one that was computed.
    const WideFloats q = from_bits(least_q) * (1.0f - (errors.roundings + 0x1p-20f)) - errors.of_form[0];
    WideWords are_within = errors.are_in_range & less(WideFloats{} + static_cast<float>(least_q_in_front), q);
    for (std::size_t k = 0; k < Numerators; ++k)
        are_within &= errors.are_within(1 + k, from_bits(largest[k]), 1.0f / q);
    return !any(~are_within);
}

inline constexpr std::uint64_t many_doubtful = ~std::uint64_t{};

// Fills a block on either side of the projector from differences to one of its points, so that distance from the origin
// costs no digits, with errors of each lane. Returns bit i for vector i if a lane of it is neither certainly inside the
// tolerance nor certainly behind (it is written all the same); many_doubtful for more than an eighth of them.
template <class CompiledWhereCalled = void>
TEXGEN_APART std::uint64_t fill_about_point(const PointJob& job, std::size_t begin, std::size_t end) noexcept {
    WideFloats x, y, z;
    load_points(job, (begin + end - 1) / 2 / wide_at_once * wide_at_once, x, y, z);
    const auto number = [](float a) { return std::isnan(a) ? 0.0f : a; };
    const float point[3] = {number(x[1]), number(y[1]), number(z[1])};
    PointExtent extent;
    WideFloats difference[float_block / wide_at_once][3], *next = difference[0];
    for (std::size_t i = begin; i < end; i += wide_at_once, next += 3) {
        load_points(job, i, x, y, z);
        next[0] = x - point[0];
        next[1] = y - point[1];
        next[2] = z - point[2];
        extent.add(next[0], next[1], next[2]);
    }
    PointForm about[3] = {job.q, job.numerator[0], job.numerator[job.numerators - 1]};
    // What sums in double lose, and differences that count as 0 because they are subnormal, is less than form_error
    // times this: 2^-28 of the terms at the point.
    double at[3], reach[3];
    for (std::size_t j = 0; j < 3; ++j) {
        at[j] = static_cast<double>(point[j]);
        reach[j] = std::fabs(at[j]) + 0x1p-76;
    }
    double lost[3];
    for (std::size_t k = 0; k < 3; ++k) {
        PointForm& form = about[k];
        lost[k] = (std::fabs(form.x) * reach[0] + std::fabs(form.y) * reach[1] + std::fabs(form.z) * reach[2] +
                   std::fabs(form.w)) *
                  0x1p-28;
        form.w += form.x * at[0] + form.y * at[1] + form.z * at[2];
    }
    const FormsInFloat<2> forms(about);
    for (std::size_t k = 0; k < 3; ++k) about[k].w = std::fabs(about[k].w) + lost[k];
    const FloatErrors errors(about_point, about, extent, job.tolerance);
    // So far in front 1 / q errs by less than 2^-9 of itself.
    const WideFloats least_q = errors.of_form[0] * 0x1p10f + 0x1p-58f;
    std::uint64_t doubtful = 0;
    std::size_t count = 0;
    next = difference[0];
    for (std::size_t i = begin; i < end; i += wide_at_once, next += 3) {
        const auto value_of = [&](std::size_t k) { return forms.at(k, next[0], next[1], next[2]); };
        const WideFloats q = value_of(0), reciprocal = 1.0f / q;
        const WideWords are_in_front = errors.are_in_range & less(least_q, q);
        // This takes a q that is no number, too, of a point that is none.
        const WideWords are_behind = errors.are_in_range & ~less(errors.of_form[0] * -1.001f, q);
        WideWords are_certain = are_in_front;
        WideFloats value[2];
        TEXGEN_FOR (std::size_t k = 0; k < 2; ++k) {
            value[k] = from_bits(are_in_front & signed_bits(value_of(1 + k) * reciprocal));
            are_certain &= errors.are_within(1 + k, magnitude(value[k]), reciprocal * 1.002f);
        }
        store_points(job, i, static_cast<std::size_t>(job.numerators), value, are_in_front);
        if (!any(~(are_certain | are_behind))) continue;
        doubtful |= std::uint64_t{1} << (i - begin) / wide_at_once;
        if (++count * 8 * wide_at_once > end - begin) return many_doubtful;
    }
    return doubtful;
}

// Fills blocks of float_block points, or of four times as many after one that was certainly in front; where one is not,
// about a point. Where more than an eighth of a block's vectors are in doubt, so are likely those that follow: from
// each such block on more points are done exactly. The loops read a copy of the job, made field by field: a load of
// several fields would wait for their stores, as it would of the forms, which are found by number, in the copy.
template <std::size_t Numerators>
TEXGEN_INLINE Undecided fill_points_within_of(const PointJob& original, std::size_t first) noexcept {
    PointForm of[1 + Numerators] = {original.q};
    for (std::size_t k = 0; k < Numerators; ++k) of[1 + k] = original.numerator[k];
    const FormsInFloat<Numerators> forms(of);
    const PointJob job = original;
    if (job.is_certified) {
        WideFloats x, y, z, value[2];
        for (std::size_t i = first; i < job.count; i = next_vector<Numerators>(job, i, job.count)) {
            load_points(job, i, x, y, z);
            forms.divide(x, y, z, forms.at(0, x, y, z), value);
            store_points(job, i, Numerators, value, ~WideWords{});
        }
        return {job.count, 0};
    }
    Effort effort;
    std::size_t size = float_block, pause = float_block;
    int failures = 0;
    for (std::size_t begin = first, end; begin < job.count; begin = end) {
        end = end_of_block(job.count, begin, size);
        size = 4 * float_block;
        if (failures % 8 == 0 && fill_in_front<Numerators>(job, of, forms, begin, end)) continue;
        ++failures;
        size = float_block;
        end = end_of_block(job.count, begin, size);
        const std::uint64_t doubtful = fill_about_point(original, begin, end);
        if (doubtful == 0) continue;
        Undecided left;
        if (doubtful == many_doubtful) {
            pause *= 4;
            PointJob part = original;
            part.count = end = pause < job.count - begin ? begin + pause : job.count;
            left = fill_points_exact(part, begin);
        } else {
            left = fill_vectors_again(original, begin, end, doubtful, effort);
        }
        if (left.values != 0) return left;
    }
    return {job.count, 0};
}

template <class CompiledWhereCalled = void>
Undecided fill_points_within(const PointJob& job, std::size_t first) noexcept {
    return job.numerators == 2 ? fill_points_within_of<2>(job, first) : fill_points_within_of<1>(job, first);
}

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
