// The inner loops of points: how they are loaded and stored, and blocks of them in double. Included by kernels.inc.hpp.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

template <class Vector>
TEXGEN_INLINE void load_points(const PointInput& job, std::size_t i, Vector& x, Vector& y, Vector& z) noexcept {
    if (job.interleaved_xyz) {
        load_interleaved(job.x + 3 * i, x, y, z);
    } else {
        x = load<Vector>(job.x + i);
        y = load<Vector>(job.y + i);
        z = load<Vector>(job.z + i);
    }
}

// Stores a vector of results from index i on, and their mask: inside the region and in front. Here and below
// `numerators` is a constant where it is quick to have one.
template <class Vector, class Mask>
TEXGEN_INLINE void store_points(const DividedOutput& output, std::size_t i, std::size_t numerators,
                                const Vector (&value)[2], const Mask& in_front) noexcept {
    if (numerators == 2) {
        if (output.lit != nullptr) store(output.lit + i, lit_of(output, value, in_front));
        if (output.interleaved_st) return store_interleaved(output.out[0] + 2 * i, value[0], value[1]);
        store(output.out[1] + i, value[1]);
    }
    store(output.out[0] + i, value[0]);
}

// Below this floats are no further apart than the tolerance; 0 for an exact one.
TEXGEN_INLINE Doubles limit_within(double tolerance) noexcept {
    return power_of_two_below(Doubles{} + tolerance) * 0x1p24;
}

// The lanes whose quotient may be rounded to either float within its error: both lose at most half a tolerance.
TEXGEN_INLINE LongWords is_within(double tolerance, const Doubles& size, const Doubles& error) noexcept {
    return greater(limit_within(tolerance), size * 2.0) & at_most(error * 4.0, Doubles{} + tolerance);
}

// Lanes in doubt: which float is nearest, see RoundedEnds, or on which side of the projector the point is.
struct Doubt {
    Words rounding{};
    LongWords side{};
    LongWords behind{};  // not certainly in front, which is no doubt by itself

    TEXGEN_INLINE bool any_lane() const noexcept { return any(rounding | narrow(side)); }
};

// The numerators and q at a vector of points, and 1 / q.
struct PointDivision {
    Doubles numerator[2], q, reciprocal;
};

// Divides numerator[k] / q, with these errors of all lanes or of each. With Signed, q has either sign, lanes that are
// certainly behind give 0, and where either float is within the tolerance there is no doubt; else all are in front.
// Returns the mask of the lanes in front.
// With u = 2^-53, r = 1/q, and S and Q the sums of terms, numerator and q err by 4.01 u S and 4.01 u Q, and their
// errors are given as 9.9 u S and 9.9 u Q at least. So in front the quotient errs by r (4.01 u S + |quotient| 4.01 u
// Q); its roundings, as it is less than r S, by u r S each: one of the product, three of r where two q share a
// division, and one of what becomes a float.
template <bool Signed>
TEXGEN_INLINE LongWords divide_certainly(std::size_t numerators, const PointDivision& of,
                                         const Doubles (&numerator_error)[2], const Doubles& q_error, double tolerance,
                                         Floats (&value)[2], Doubt& doubt) noexcept {
    LongWords in_front = ~LongWords{};
    Doubles reciprocal = of.reciprocal;
    if constexpr (Signed) {
        in_front = greater(of.q, q_error * 0x1p20);
        doubt.behind |= ~in_front;
        doubt.side |= ~in_front & greater(of.q + q_error, 0.0);  // a q that is no number leaves no doubt
        reciprocal = where(in_front, reciprocal);
    }
    for (std::size_t k = 0; k < numerators; ++k) {
        Doubles quotient = of.numerator[k] * reciprocal;
        if constexpr (Signed) quotient = where(in_front, quotient);
        const Doubles size = magnitude(quotient);
        Doubles error = numerator_error[k] + size * q_error;   // times q
        if constexpr (Signed) error = where(in_front, error);  // of a numerator that is no number
        error = error * reciprocal;
        const RoundedEnds ends(quotient, error);
        value[k] = ends.below;
        Words differ = ends.differ();
        if (Signed && tolerance > 0.0 && any(differ)) differ &= ~narrow(is_within(tolerance, size, error));
        doubt.rounding |= differ;
    }
    return in_front;
}

// The largest |x|, |y|, |z| in each lane. A NaN is left out: it makes q a NaN, whatever the form.
struct PointExtent {
    WideFloats x{}, y{}, z{};

    TEXGEN_INLINE void add(const WideFloats& of_x, const WideFloats& of_y, const WideFloats& of_z) noexcept {
        x = larger_magnitude(of_x, x);
        y = larger_magnitude(of_y, y);
        z = larger_magnitude(of_z, z);
    }
    // At least the sum of a form's terms, but for a rounding each.
    TEXGEN_INLINE WideFloats terms_of(const PointForm& form) const noexcept {
        const auto factor = [](double coefficient) { return std::fabs(static_cast<float>(coefficient)); };
        return x * factor(form.x) + (y * factor(form.y) + (z * factor(form.z) + factor(form.w)));
    }
};

TEXGEN_INLINE PointLanes load_points(const PointInput& job, std::size_t i) noexcept {
    Floats x, y, z;
    load_points(job, i, x, y, z);
    return {{to_doubles(x), to_doubles(y), to_doubles(z)}};
}

// Blocks end at multiples of their size.
TEXGEN_INLINE std::size_t end_of_block(std::size_t count, std::size_t begin, std::size_t size) noexcept {
    const std::size_t next = (begin / size + 1) * size;
    return next < count ? next : count;
}

// A division of eight doubles takes longer than all else, so two vectors of points share one.
inline constexpr bool divides_pairs = lanes == 8 && wide_lanes == 16;
inline constexpr std::size_t vectors_at_once = wide_lanes / lanes;

// Computes what is divided at these points, and begins the divisions. Returns 1 / (q q').
template <std::size_t Numerators, bool Shares>
TEXGEN_INLINE Doubles begin_division(const PointJob& job, const WideFloats& x, const WideFloats& y, const WideFloats& z,
                                     PointDivision* division) noexcept {
    PointDivision* next = division;
    for_halves(
        [&](const Doubles& of_x, const Doubles& of_y, const Doubles& of_z) {
            const PointLanes point{{of_x, of_y, of_z}};
            next->q = value_at(job.q, point);
            if constexpr (!Shares) next->reciprocal = 1.0 / next->q;
            for (std::size_t k = 0; k < Numerators; ++k) next->numerator[k] = value_at(job.numerator[k], point);
            ++next;
        },
        x, y, z);
    if constexpr (!Shares) return division[0].reciprocal * division[vectors_at_once - 1].reciprocal;
    const SharedDivision shared(division[0].q, division[1].q);
    for (std::size_t i = 0; i < 2; ++i) division[i].reciprocal = shared.reciprocal[i];
    return shared.of_both;
}

// Whether reciprocals of q, or of products of two, are all between 2^-500 and 2^500, so that two q may share a
// division. The sum is no less than the largest, and keeps a NaN, which `least` forgets.
struct ReciprocalRange {
    Doubles least = Doubles{} + 1.0, sum{};

    TEXGEN_INLINE void add(const Doubles& reciprocal) noexcept {
        least = minimum(reciprocal, least);
        sum = sum + reciprocal;
    }
    TEXGEN_INLINE LongWords holds() const noexcept {
        return greater(least, 0x1p-500) & greater(Doubles{} + 0x1p500, sum);
    }
};

// Fills a block of points of a job that knows its ulps. Returns whether all is certain (it is written all the same). A
// point that is not in the job's box can spoil only the one that shares its division, and the range tells.
template <std::size_t Numerators>
TEXGEN_INLINE bool fill_bounded_block(const PointJob& job, std::size_t begin, std::size_t end) noexcept {
    Distances distance = far_from_middles();
    ReciprocalRange range;
    for (std::size_t i = begin; i < end; i += wide_at_once) {
        WideFloats x, y, z;
        load_points(job, i, x, y, z);
        PointDivision division[vectors_at_once];
        range.add(begin_division<Numerators, divides_pairs>(job, x, y, z, division));
        TEXGEN_FOR (std::size_t j = 0; j < vectors_at_once; ++j) {
            Doubles quotient[2];
            Floats value[2];
            for (std::size_t k = 0; k < Numerators; ++k) {
                quotient[k] = division[j].numerator[k] * division[j].reciprocal;
                value[k] = to_floats(quotient[k]);
            }
            distance = nearer(distance, quotient[0], quotient[Numerators - 1], job.ulps);
            store_points(job, i + j * at_once, Numerators, value, ~Words{});
        }
    }
    return !any(~range.holds()) && !any_zero(distance);
}

// Fills a block of points, with errors that hold for all of it; all are in front if not Signed. Returns a bit for each
// wide vector that has a value in doubt (it is written all the same).
// All divisions are begun before the first result is asked for: what waits for one keeps others from being begun.
template <bool Signed, std::size_t Numerators>
TEXGEN_INLINE std::uint64_t fill_points_block(const PointJob& job, std::size_t begin, std::size_t end,
                                              LongWords& behind) noexcept {
    PointExtent extent;
    PointDivision division[(Signed ? exact_block : float_block) / at_once];
    PointDivision* next = division;
    for (std::size_t i = begin; i < end; i += wide_at_once) {
        WideFloats x, y, z;
        load_points(job, i, x, y, z);
        extent.add(x, y, z);
        begin_division<Numerators, !Signed && divides_pairs>(job, x, y, z, next);
        next += vectors_at_once;
    }
    const Doubles x_size = folded(extent.x), y_size = folded(extent.y), z_size = folded(extent.z);
    const auto error_of = [&](const PointForm& form) {
        return (x_size * std::fabs(form.x) +
                (y_size * std::fabs(form.y) + (z_size * std::fabs(form.z) + std::fabs(form.w)))) *
               gamma(5);
    };
    Doubles numerator_error[2];
    for (std::size_t k = 0; k < Numerators; ++k) numerator_error[k] = error_of(job.numerator[k]);
    // An infinite coordinate of another point may make it a NaN: then infinity stands for it.
    const Doubles q_error = minimum(error_of(job.q), Doubles{} + infinity);
    std::uint64_t doubtful = 0;
    next = division;
    for (std::size_t first = begin; first < end; first += exact_block) {
        Doubt doubt;
        ReciprocalRange range;
        const PointDivision* const first_division = next;
        for (std::size_t i = first; i < first + exact_block && i < end; i += at_once) {
            if constexpr (!Signed) range.add(next->reciprocal);
            Floats value[2];
            const LongWords in_front =
                divide_certainly<Signed>(Numerators, *next++, numerator_error, q_error, 0.0, value, doubt);
            store_points(job, i, Numerators, value, narrow(in_front));
        }
        behind |= doubt.behind;
        if constexpr (!Signed) doubt.side = ~(range.holds() & greater(Doubles{} + 0x1p-13, range.sum * q_error));
        if (!doubt.any_lane()) continue;
        if constexpr (!Signed) {
            bool is_all = any(doubt.side);  // what is behind may be among it
            if (!is_all && job.tolerance > 0.0) {
                Doubles quotient{};
                for (const PointDivision* of = first_division; of != next; ++of)
                    for (std::size_t k = 0; k < Numerators; ++k)
                        quotient = maximum(magnitude(of->numerator[k] * of->reciprocal), quotient);
                const Doubles error = maximum(numerator_error[0], numerator_error[Numerators - 1]) + quotient * q_error;
                is_all = any(~is_within(job.tolerance, quotient, range.sum * error));
                if (!is_all) continue;
            }
            if (is_all) {
                doubtful |= ~(~std::uint64_t{} << (exact_block / wide_at_once)) << (first - begin) / wide_at_once;
                continue;
            }
        }
        for (const PointDivision* of = first_division; of != next; ++of) {
            Doubt of_vector;
            Floats unused[2];
            divide_certainly<true>(Numerators, *of, numerator_error, q_error, Signed ? job.tolerance : 0.0, unused,
                                   of_vector);
            const auto v = static_cast<std::size_t>(of - division) * at_once / wide_at_once;
            doubtful |= std::uint64_t{of_vector.any_lane()} << v;
        }
    }
    return doubtful;
}

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
