// Points as the floats nearest to their quotients: blocks of them in double, and anew what that leaves in doubt.
// Included by kernels.inc.hpp.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

// What the last points needed, so that cheaper ways are not tried in vain on those that follow.
struct Effort {
    bool is_either_side = false;  // some were behind the projector
    int in_vain = 0;              // how many vectors in a row needed two doubles
    bool are_ties = false;        // numerators need two doubles, and not q alone
    bool precisely[3] = {};       // of each numerator and of q: whether all of its sum is kept, or its leading part

    // Whether the next vector is likely to need two doubles, too.
    TEXGEN_INLINE bool has_company() const noexcept { return in_vain >= 4; }

    // Asks for more of numerator k and of q, where lanes are unknown; false if there is no more.
    TEXGEN_INLINE bool sharpen(std::size_t k, std::uint64_t unknown) noexcept {
        if (unknown == 0 || (precisely[k] && precisely[2])) return false;
        return precisely[precisely[k] ? 2 : k] = true;
    }
};

// The forms of q and of the numerators, to be summed in double or in two.
struct PointTerms {
    TwofoldForm q;
    TwofoldForm numerator[2];
    bool are_quotients;  // q is 1: the numerators are the quotients

    TEXGEN_APART explicit PointTerms(const PointJob& job) noexcept
        : q(job.q), are_quotients(q.used == 0 && job.q.w == 1.0) {
        for (int k = 0; k < job.numerators; ++k) {
            numerator[k] = TwofoldForm(job.numerator[k]);
            are_quotients &= numerator[k].is_finite;
        }
    }
};

// Decides points anew: as sums where q is 1; in double with the error of each lane, unless four vectors in a row needed
// more (then one in eight blocks tries again); and in two doubles, where a vector begins with what the one before
// needed. Returns what stays in doubt, bit i for point begin + i.
template <class CompiledWhereCalled = void>
TEXGEN_LARGE std::uint64_t fill_block_again(const PointJob& job, const PointTerms& terms, std::size_t begin,
                                            std::size_t end, Effort& effort) noexcept {
    const std::size_t numerators = job.numerators == 2 ? 2 : 1;  // never 0: GCC 12 fails on a loop that may be none
    const Doubles within = limit_within(job.tolerance);
    std::uint64_t doubtful = 0;
    for (std::size_t i = begin; i < end; i += at_once) {
        const PointLanes at = load_points(job, i);
        const PointLanes sizes{{magnitude(at.v[0]), magnitude(at.v[1]), magnitude(at.v[2])}};
        // Points that are no numbers are behind, whatever their q is.
        const Doubles zero = (at.v[0] + at.v[1] + at.v[2]) * (terms.q.is_finite ? 0.0 : nan);
        const LongWords are_dark = ~at_most(zero, zero);
        Floats value[2];
        Words in_front{};
        std::uint64_t unknown = 0;
        bool is_decided = false;
        const bool is_tried = !effort.has_company() || i % (8 * exact_block) == 0;
        if (is_tried && terms.are_quotients) {
            LongWords is_known = ~LongWords{};
            in_front = narrow(~are_dark);
            for (std::size_t k = 0; k < numerators; ++k)
                value[k] = select(in_front, terms.numerator[k].nearest_at(at, sizes, is_known), Floats{});
            is_decided = !any(~(is_known | are_dark));
        } else if (is_tried) {
            PointDivision division;
            Doubles numerator_error[2];
            division.q = value_at(terms.q.form, at);
            division.reciprocal = 1.0 / division.q;
            for (std::size_t k = 0; k < numerators; ++k) {
                division.numerator[k] = value_at(terms.numerator[k].form, at);
                numerator_error[k] = terms.numerator[k].error_at(sizes);
            }
            Doubt doubt;
            // Without the tolerance: most of what it would allow is decided before this, and the rest below.
            in_front = narrow(divide_certainly<true>(numerators, division, numerator_error, terms.q.error_at(sizes),
                                                     0.0, value, doubt));
            is_decided = !any(doubt.rounding | narrow(doubt.side & ~are_dark));
        }
        if (is_tried) effort.in_vain = is_decided ? 0 : effort.in_vain + 1;
        while (!is_decided) {
            const PointLanes grains{{last_bits(sizes.v[0]), last_bits(sizes.v[1]), last_bits(sizes.v[2])}};
            TwofoldDivisor q(terms.q.at(at, sizes, effort.precisely[2], grains));
            q.in_front &= ~are_dark;
            in_front = narrow(q.in_front);
            unknown = lane_bits(~(q.is_known | are_dark));
            // At first q alone is in two doubles: these lose little unless ties, or q = 0, ask for the last bits.
            if (!effort.are_ties) {
                is_decided = unknown == 0;
                for (std::size_t k = 0; k < numerators; ++k)
                    is_decided &= divide_nearly(value_at(terms.numerator[k].form, at),
                                                terms.numerator[k].error_at(sizes), q, value[k]);
                if (is_decided) break;
                effort.are_ties = unknown == 0 || effort.precisely[2];
                effort.precisely[2] = !effort.are_ties;
                continue;
            }
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

// Decides vectors of a block anew, those with a bit in `doubtful`. Returns the first exact_block of which points stay
// in doubt, and these; or `end` and none.
TEXGEN_APART inline Undecided fill_vectors_again(const PointJob& job, std::size_t begin, std::size_t end,
                                                 std::uint64_t doubtful, Effort& effort) noexcept {
    const PointTerms terms(job);
    Undecided left{begin, 0};
    for (; doubtful != 0; doubtful &= doubtful - 1) {
        const std::size_t i = begin + static_cast<std::size_t>(std::countr_zero(doubtful)) * wide_at_once;
        if (i / exact_block != left.begin / exact_block) {
            if (left.values != 0) return left;
            left.begin = i / exact_block * exact_block;
        }
        left.values |= fill_block_again(job, terms, i, i + wide_at_once, effort) << (i - left.begin);
    }
    return left.values != 0 ? left : Undecided{end, 0};
}

// Whether so few vectors of a block are in doubt that only these are done anew.
TEXGEN_INLINE bool are_few(std::uint64_t vectors) noexcept {
    return vectors != 0 && 4 * wide_at_once * static_cast<std::size_t>(std::popcount(vectors)) <= exact_block;
}

// Divides a block that may be on both sides of the projector, and anew those of its vectors that are in doubt. Where
// these are more than a quarter, it is decided anew as a whole, like those that follow up to a multiple of eight
// blocks, or further while they need two doubles. Returns where the next block begins, or a block whose values stay in
// doubt.
template <class CompiledWhereCalled = void>
TEXGEN_APART Undecided fill_points_again(const PointJob& original, std::size_t begin, Effort& effort) noexcept {
    std::size_t end = end_of_block(original.count, begin, exact_block);
    PointJob job = original;
    if (job.numerators == 1) {  // it stands in both places: this is compiled for two alone
        job.numerator[1] = job.numerator[0];
        job.out[1] = job.out[0];
    }
    LongWords behind{};
    const std::uint64_t vectors = fill_points_block<true, 2>(job, begin, end, behind);
    if (vectors == 0) effort = {};
    effort.is_either_side = any(behind);
    if (vectors == 0) return {end, 0};
    if (are_few(vectors)) return fill_vectors_again(original, begin, end, vectors, effort);
    const PointTerms terms(original);
    for (;;) {
        const std::uint64_t doubtful = fill_block_again(original, terms, begin, end, effort);
        if (doubtful != 0) return {begin, doubtful};
        begin = end;
        const bool is_first_of_eight = begin / exact_block % 8 == 0;
        if (begin == original.count || (is_first_of_eight && !effort.has_company())) break;
        end = end_of_block(original.count, begin, exact_block);
    }
    effort = {};
    return {begin, 0};
}

// Most blocks are in front and in no doubt: they are divided four at once. Of a block with a few vectors in doubt only
// these are done anew; one with more is done anew as a whole, as may be those that follow, up to seven. The job is
// copied, here and below, so that the compiler knows that no store changes it: nothing that the loop reads may be
// reached from elsewhere.
template <std::size_t Numerators>
TEXGEN_INLINE Undecided fill_points_exact_of(const PointJob& original, std::size_t first) noexcept {
    const PointJob job = original;
    Effort effort;
    constexpr std::uint64_t all = ~std::uint64_t{};
    constexpr std::size_t vectors = exact_block / wide_at_once;
    static_assert(float_block / wide_at_once <= 64);
    std::uint64_t doubtful = all;  // a bit for each vector of a float_block
    for (std::size_t begin = first; begin < job.count;) {
        if (begin % float_block == 0) {
            const std::size_t end = end_of_block(job.count, begin, float_block);
            LongWords unused{};
            if (effort.is_either_side) {
                doubtful = all;
            } else if (job.ulps != 0) {
                doubtful = fill_bounded_block<Numerators>(job, begin, end) ? 0 : all;
            } else {
                doubtful = fill_points_block<false, Numerators>(job, begin, end, unused);
            }
        }
        const std::uint64_t of_block = doubtful >> begin % float_block / wide_at_once & all >> (64 - vectors);
        Undecided left{end_of_block(job.count, begin, exact_block), 0};
        if (are_few(of_block))
            left = fill_vectors_again(original, begin, left.begin, of_block, effort);
        else if (of_block != 0)
            left = fill_points_again(original, begin, effort);
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
