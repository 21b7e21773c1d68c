// The inner loops of points. Included by kernels.inc.hpp.

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

// Lanes that cannot be vouched for: of whose float it is not certain, see RoundedEnds, or on which side of the
// projector the point is.
struct Doubt {
    Words rounding{};
    LongWords side{};
    LongWords behind{};  // no doubt, but no ordinary points

    TEXGEN_INLINE bool any_lane() const noexcept { return any(rounding | narrow(side)); }
};

// What is divided at a vector of points.
struct PointDivision {
    Doubles numerator[2], q, reciprocal;
};

// numerator[k] / q with these errors, of all or of each lane. With Signed, q has either sign, and lanes that are
// certainly behind give 0; else all are in front; and in no doubt where both floats are inside the tolerance. Returns
// the mask of the lanes in front.
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
        doubt.side |= ~in_front & greater(of.q + q_error, 0.0);  // no doubt of a q that is no number
        reciprocal = where(in_front, reciprocal);
    }
    for (std::size_t k = 0; k < numerators; ++k) {
        Doubles quotient = of.numerator[k] * reciprocal;
        if constexpr (Signed) quotient = where(in_front, quotient);
        Doubles error = numerator_error[k] + magnitude(quotient) * q_error;  // times q
        if constexpr (Signed) error = where(in_front, error);                // of a numerator that is no number
        const RoundedEnds ends(quotient, reciprocal * error);
        value[k] = ends.below;
        Words differ = ends.differ();
        if constexpr (Signed) {
            if (tolerance > 0.0 && any(differ)) {
                const Words is_within =
                    narrow(at_most((to_doubles_as_rounded(ends.above) - to_doubles_as_rounded(ends.below)) * 2.0,
                                   Doubles{} + tolerance));
                value[k] = select(is_within, to_floats(quotient), value[k]);
                differ &= ~is_within;
            }
        }
        doubt.rounding |= differ;
    }
    return in_front;
}

// What decided a vector or a block of points, and is tried first with the next, so that company is not tried in vain.
enum class Rung {
    in_front,     // in double, with errors that hold for the block, which is all in front
    either_side,  // the same on both sides of the projector
    each_lane,    // with errors of each lane
    closely       // in two doubles
};
struct Effort {
    Rung rung = Rung::in_front;
    bool are_ties = false;   // closely: the numerators as well as q
    bool precisely[3] = {};  // all of the numerators' sums and of q's, or their leading part

    // Where lanes of numerator k, or of q, are unknown they ask for more. False if that is all there is.
    TEXGEN_INLINE bool sharpen(std::size_t k, std::uint64_t unknown) noexcept {
        if (unknown == 0 || (precisely[k] && precisely[2])) return false;
        return precisely[precisely[k] ? 2 : k] = true;
    }
};

// The largest |x|, |y|, |z| in each lane, of those that are numbers: where one is none, so is q, whatever its form.
struct PointExtent {
    WideFloats x{}, y{}, z{};

    TEXGEN_INLINE void add(const WideFloats& of_x, const WideFloats& of_y, const WideFloats& of_z) noexcept {
        x = larger_magnitude(of_x, x);
        y = larger_magnitude(of_y, y);
        z = larger_magnitude(of_z, z);
    }
    // At least the sum of a form's terms, but for a rounding each.
    TEXGEN_INLINE WideFloats terms_of(const PointForm& form) const noexcept {
        const auto factor = [](double coefficient) { return static_cast<float>(std::fabs(coefficient)); };
        return x * factor(form.x) + (y * factor(form.y) + (z * factor(form.z) + factor(form.w)));
    }
};

TEXGEN_INLINE PointLanes load_points(const PointInput& job, std::size_t i) noexcept {
    Floats x, y, z;
    load_points(job, i, x, y, z);
    return {{to_doubles(x), to_doubles(y), to_doubles(z)}};
}

// Of eight doubles a division takes longer than all else, so two vectors of points share one.
inline constexpr bool divides_pairs = lanes == 8 && wide_lanes == 16;
inline constexpr std::size_t vectors_at_once = wide_lanes / lanes;

// What is divided at these points, the divisions begun. Returns 1 / (q q').
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

// Whether reciprocals, or those of products of two q, are between 2^-500 and 2^500, so that what shares a division is a
// product of numbers in range. The sum tells of what the least of them forgets, a NaN, and is no less than the largest.
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

// A block of points of a job that knows its ulps. Returns whether all is certain (it is written all the same). A point
// that is not in the job's box may spoil the one that shares its division, and only so any other: the range tells.
template <std::size_t Numerators>
TEXGEN_INLINE bool fill_bounded_block(const PointJob& job, std::size_t begin, std::size_t end) noexcept {
    Distances distance = far_from_middles();
    ReciprocalRange range;
    for (std::size_t i = begin; i < end; i += wide_at_once) {
        WideFloats x, y, z;
        load_points(job, i, x, y, z);
        PointDivision division[vectors_at_once];
        range.add(begin_division<Numerators, divides_pairs>(job, x, y, z, division));
        TEXGEN_UNROLL
        for (std::size_t j = 0; j < vectors_at_once; ++j) {
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

// A block of points, with errors that hold for all of it. Returns what is in doubt (it is written all the same).
// All divisions are begun before the first result is asked for: instructions that wait for one keep others from being
// begun.
template <bool Signed, std::size_t Numerators>
TEXGEN_INLINE Doubt fill_points_block(const PointJob& job, std::size_t begin, std::size_t end) noexcept {
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
    // A NaN, of an infinite coordinate of another point, bounds nothing.
    const Doubles q_error = minimum(error_of(job.q), Doubles{} + infinity);
    Doubt doubt;
    ReciprocalRange range;
    next = division;
    for (std::size_t i = begin; i < end; i += at_once) {
        if constexpr (!Signed) range.add(next->reciprocal);
        Floats value[2];
        const LongWords in_front =
            divide_certainly<Signed>(Numerators, *next++, numerator_error, q_error, job.tolerance, value, doubt);
        store_points(job, i, Numerators, value, narrow(in_front));
    }
    if constexpr (!Signed) doubt.side = ~(range.holds() & greater(Doubles{} + 0x1p-13, range.sum * q_error));
    return doubt;
}

// The sums at points: q and the numerators, nearly and in two doubles.
struct PointTerms {
    TwofoldForm q;
    TwofoldForm numerator[2];

    TEXGEN_INLINE explicit PointTerms(const PointJob& job) noexcept : q(job.q) {
        for (int k = 0; k < job.numerators; ++k) numerator[k] = TwofoldForm(job.numerator[k]);
    }
    // Which are behind whatever their q, being no numbers.
    TEXGEN_INLINE LongWords are_dark(const PointLanes& at) const noexcept {
        const Doubles zero = (at.v[0] + at.v[1] + at.v[2]) * (q.is_finite ? 0.0 : nan);
        return ~at_most(zero, zero);
    }
};

// Does a block again, from each_lane on at least. What a vector needs beyond that, those that follow get at once, up to
// eight blocks. Returns what stays in doubt, bit i for point begin + i.
template <class CompiledWhereCalled = void>
TEXGEN_APART std::uint64_t fill_block_again(const PointJob& job, const PointTerms& terms, std::size_t begin,
                                            std::size_t end, Effort& effort) noexcept {
    const std::size_t numerators = job.numerators == 2 ? 2 : 1;  // never 0: GCC 12 fails on a loop that may be none
    // Floats below are no further apart than the tolerance.
    const Doubles within = power_of_two_below(Doubles{} + job.tolerance) * 0x1p24;
    std::uint64_t doubtful = 0;
    for (std::size_t i = begin; i < end; i += at_once) {
        const PointLanes at = load_points(job, i);
        const PointSizes sizes(at);
        const LongWords are_dark = terms.are_dark(at);
        Floats value[2];
        Words in_front{};
        std::uint64_t unknown = 0;
        bool is_decided = false;
        if (effort.rung <= Rung::each_lane || i % (8 * exact_block) == 0) {
            PointDivision division;
            Doubles numerator_error[2];
            division.q = value_at(terms.q.form, at);
            division.reciprocal = 1.0 / division.q;
            for (std::size_t k = 0; k < numerators; ++k) {
                division.numerator[k] = value_at(terms.numerator[k].form, at);
                numerator_error[k] = terms.numerator[k].error_at(sizes);
            }
            Doubt doubt;
            in_front = narrow(divide_certainly<true>(numerators, division, numerator_error, terms.q.error_at(sizes),
                                                     job.tolerance, value, doubt));
            is_decided = !any(doubt.rounding | narrow(doubt.side & ~are_dark));
            if (is_decided) effort = {};
            effort.rung = is_decided ? Rung::each_lane : Rung::closely;
        }
        // q alone in two doubles: what it loses is small beside it unless ties, or q = 0, ask for the last bits of
        // coordinates.
        while (!is_decided && !effort.are_ties) {
            TwofoldDivisor q(terms.q.at(at, sizes, effort.precisely[2]));
            q.in_front &= ~are_dark;
            in_front = narrow(q.in_front);
            is_decided = lane_bits(~(q.is_known | are_dark)) == 0;
            const bool is_known = is_decided;
            for (std::size_t k = 0; k < numerators; ++k)
                is_decided &= divide_nearly(value_at(terms.numerator[k].form, at), terms.numerator[k].error_at(sizes),
                                            q, value[k]);
            if (is_decided) break;
            effort.are_ties = is_known || effort.precisely[2];
            effort.precisely[2] = !effort.are_ties;
        }
        while (!is_decided) {
            const PointGrains grains(sizes);
            TwofoldDivisor q(terms.q.at(at, sizes, effort.precisely[2], grains));
            q.in_front &= ~are_dark;
            in_front = narrow(q.in_front);
            unknown = lane_bits(~(q.is_known | are_dark));
            is_decided = !effort.sharpen(2, unknown);
            for (std::size_t k = 0; k < numerators; ++k) {
                const auto& numerator = terms.numerator[k];
                if (!numerator.is_finite) {
                    value[k] = to_floats(where(q.in_front, value_at(numerator.form, at) * q.reciprocal));
                    continue;
                }
                LongWords is_known;
                value[k] = nearest_quotients(numerator.at(at, sizes, effort.precisely[k], grains), q, within,
                                             effort.precisely[k], is_known);
                const std::uint64_t unknown_of_it = lane_bits(~is_known);
                unknown |= unknown_of_it;
                is_decided &= !effort.sharpen(k, unknown_of_it);
            }
        }
        store_points(job, i, numerators, value, in_front);
        doubtful |= unknown << (i - begin);
    }
    return doubtful;
}

// Blocks end at multiples of their size.
TEXGEN_INLINE std::size_t end_of_block(std::size_t count, std::size_t begin, std::size_t size) noexcept {
    const std::size_t next = (begin / size + 1) * size;
    return next < count ? next : count;
}

// Does blocks from `begin` on again, as long as they need what the first one did, and the first of eight sees whether
// it does. Returns where the next begins, or that with values which stay in doubt.
template <class CompiledWhereCalled = void>
TEXGEN_APART Undecided fill_points_again(const PointJob& original, std::size_t begin, Effort& effort) noexcept {
    std::size_t end = end_of_block(original.count, begin, exact_block);
    if (effort.rung <= Rung::either_side) {
        const PointJob job = original;
        const Doubt doubt = job.numerators == 2 ? fill_points_block<true, 2>(job, begin, end)
                                                : fill_points_block<true, 1>(job, begin, end);
        if (!doubt.any_lane()) {
            effort = {any(doubt.behind) ? Rung::either_side : Rung::in_front};
            return {end, 0};
        }
    }
    const PointTerms terms(original);
    for (;;) {
        const std::uint64_t doubtful = fill_block_again(original, terms, begin, end, effort);
        if (doubtful != 0) return {begin, doubtful};
        begin = end;
        const bool is_first_of_eight = begin / exact_block % 8 == 0;
        if (begin == original.count || (is_first_of_eight && effort.rung == Rung::each_lane)) return {begin, 0};
        end = end_of_block(original.count, begin, exact_block);
    }
}

// Most points are all in front and in no doubt, four blocks at once; blocks of which one is not are done again one by
// one, and those that follow are taken for what it was, seven of them.
// The job is copied, here and below, so that the compiler knows that no store changes it: nothing that the loop reads
// may be reached from elsewhere.
template <std::size_t Numerators>
TEXGEN_INLINE Undecided fill_points_exact_of(const PointJob& original, std::size_t first) noexcept {
    const PointJob job = original;
    Effort effort;
    for (std::size_t begin = first; begin < job.count;) {
        if (begin / exact_block % 8 == 0 && effort.rung == Rung::each_lane) effort = {};
        if (effort.rung == Rung::in_front && begin % float_block == 0) {
            const std::size_t end = end_of_block(job.count, begin, float_block);
            const bool is_certain = job.ulps != 0 ? fill_bounded_block<Numerators>(job, begin, end)
                                                  : !fill_points_block<false, Numerators>(job, begin, end).any_lane();
            if (is_certain) {
                begin = end;
                continue;
            }
        }
        const Undecided left = fill_points_again(original, begin, effort);
        if (left.values != 0) return left;
        begin = left.begin;
    }
    return {job.count, 0};
}

template <class CompiledWhereCalled = void>
Undecided fill_points_exact(const PointJob& job, std::size_t first) noexcept {
    return job.numerators == 2 ? fill_points_exact_of<2>(job, first) : fill_points_exact_of<1>(job, first);
}

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
