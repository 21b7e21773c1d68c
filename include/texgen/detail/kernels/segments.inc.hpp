// The inner loops of segments. Included by kernels.inc.hpp.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

// The sums of a segment's values, for fill_block_again().
struct SegmentTerms {
    struct At {
        Doubles alpha;
    };
    struct Mixture {
        double a, b;
        bool is_finite;

        TEXGEN_INLINE Twofold at(const At& at, bool precisely) const noexcept {
            return twofold_mixed(a, b, at.alpha, precisely);
        }
        TEXGEN_INLINE Doubles nearly_at(const At& at) const noexcept { return (1.0 - at.alpha) * a + at.alpha * b; }
        TEXGEN_INLINE Doubles error_at(const At& at) const noexcept {
            return (magnitude((1.0 - at.alpha) * a) + magnitude(at.alpha * b)) * gamma(4);
        }
    };

    const SegmentJob& job;
    Mixture q;
    Mixture numerator[2];

    TEXGEN_INLINE double tolerance() const noexcept { return job.tolerance; }
    TEXGEN_INLINE explicit SegmentTerms(const SegmentJob& segment) noexcept
        : job(segment), q(mixture(segment.q_a, segment.q_b)) {
        for (std::size_t k = 0; k < 2; ++k) numerator[k] = mixture(segment.a[k], segment.b[k]);
    }
    TEXGEN_INLINE At load(std::size_t i) const noexcept {
        return {to_doubles(detail::TEXGEN_ISA::load<Floats>(job.alpha + i))};
    }
    TEXGEN_INLINE LongWords are_dark(const At& at) const noexcept {
        const Doubles zero = at.alpha * (q.is_finite ? 0.0 : std::numeric_limits<double>::quiet_NaN());
        return ~at_most(zero, zero);
    }

private:
    TEXGEN_INLINE static Mixture mixture(double a, double b) noexcept { return {a, b, 0.0 * (a + b) == 0.0}; }
};

template <class CompiledWhereCalled = void>
TEXGEN_APART Again fill_segment_again(const SegmentJob& job, std::size_t begin, std::size_t end,
                                      const Effort& effort) noexcept {
    return fill_block_again(job, SegmentTerms(job), begin, end, effort);
}

// (1 - a) A + a B in double, in blocks as for points. 1 - a, the products and the sum are rounded once each. Where the
// whole segment is in front one bound serves all values; only an alpha that is NaN is in doubt about its side.
template <bool InFront, std::size_t Numerators>
TEXGEN_INLINE Undecided fill_segment_exact_of(const SegmentJob& original, std::size_t first) noexcept {
    const SegmentJob job = original;
    double numerator_error[2];
    for (std::size_t k = 0; k < Numerators; ++k)
        numerator_error[k] = gamma(4) * larger(std::fabs(job.a[k]), std::fabs(job.b[k]));
    const double q_error = gamma(4) * larger(std::fabs(job.q_a), std::fabs(job.q_b));
    Effort effort;
    for (std::size_t begin = first; begin < job.count;) {
        const std::size_t block = begin / exact_block;
        const std::size_t next = (block + 1) * exact_block;
        const std::size_t end = next < job.count ? next : job.count;
        if (block % 8 == 0 && effort.rung == Rung::each_lane) effort = {};
        bool is_certain = false;
        if (effort.rung == Rung::in_front) {
            Doubt doubt;
            for (std::size_t i = begin; i < end; i += static_cast<std::size_t>(lanes)) {
                const Doubles alpha = to_doubles(load<Floats>(job.alpha + i));
                const Doubles rest = 1.0 - alpha;
                const Doubles q = rest * job.q_a + alpha * job.q_b;
                Doubles numerator[2];
                for (std::size_t k = 0; k < Numerators; ++k) numerator[k] = rest * job.a[k] + alpha * job.b[k];
                Floats value[2];
                if constexpr (InFront) {
                    doubt.side |= ~greater(q, 0.0);
                    const Doubles reciprocal = 1.0 / q;
                    for (std::size_t k = 0; k < Numerators; ++k) {
                        const Doubles quotient = numerator[k] * reciprocal;
                        value[k] = to_floats(quotient - job.quotient_error[k]);
                        doubt.rounding |= bits(value[k]) ^ bits(to_floats(quotient + job.quotient_error[k]));
                    }
                    store_points(job, i, Numerators, value, ~Words{});
                } else {
                    const LongWords in_front =
                        divide_certainly<true>(Numerators, numerator, numerator_error, q, q_error, 0.0, value, doubt);
                    store_points(job, i, Numerators, value, narrow(in_front));
                }
            }
            is_certain = !doubt.any_lane();
        }
        if (!is_certain) {
            const Again again = fill_segment_again(original, begin, end, effort);
            if (again.doubtful != 0) return {begin, again.doubtful};
            effort = again.effort;
        }
        begin = end;
    }
    return {job.count, 0};
}

template <class CompiledWhereCalled = void>
Undecided fill_segment_exact(const SegmentJob& job, std::size_t first) noexcept {
    if (job.numerators == 2)
        return job.in_front ? fill_segment_exact_of<true, 2>(job, first) : fill_segment_exact_of<false, 2>(job, first);
    return job.in_front ? fill_segment_exact_of<true, 1>(job, first) : fill_segment_exact_of<false, 1>(job, first);
}

// In float about one end, two vectors by one division, so that an alpha that is no number spoils its neighbour: its block
// is left to fill_exact.
template <std::size_t Numerators>
TEXGEN_INLINE std::size_t fill_segment_all_float_of(const SegmentJob& job, std::size_t first) noexcept {
    // alpha, or 1 - alpha.
    const WideFloats start = WideFloats{} + (job.about_b ? 1.0f : 0.0f);
    const float direction = job.about_b ? -1.0f : 1.0f;
    const auto store_value = [&job](std::size_t i, const WideFloats& step) {
        WideFloats value[2];
        for (std::size_t k = 0; k < Numerators; ++k) value[k] = step * job.slope[k] + job.base[k];
        store_points(job, i, Numerators, value, ~WideWords{});
    };
    for (std::size_t begin = first; begin < job.count; begin += float_block) {
        const std::size_t end = begin + float_block < job.count ? begin + float_block : job.count;
        WideFloats sum{};
        for (std::size_t i = begin; i < end; i += 2 * static_cast<std::size_t>(wide_lanes)) {
            const std::size_t next = i + static_cast<std::size_t>(wide_lanes);
            const WideFloats from = load<WideFloats>(job.alpha + i) * direction + start;
            const WideFloats next_from = load<WideFloats>(job.alpha + (next < end ? next : i)) * direction + start;
            sum = sum + (from + next_from);
            const WideFloats q = from * job.bend + 1.0f;
            const WideFloats next_q = next_from * job.bend + 1.0f;
            const WideFloats of_both = 1.0f / (q * next_q);
            store_value(i, from * (of_both * next_q));
            if (next < end) store_value(next, next_from * (of_both * q));
        }
        if (largest_lane(magnitude_bits(sum - sum)) != 0) return begin;
    }
    return job.count;
}

template <class CompiledWhereCalled = void>
std::size_t fill_segment_all_float(const SegmentJob& original, std::size_t first) noexcept {
    const SegmentJob job = original;
    return job.numerators == 2 ? fill_segment_all_float_of<2>(job, first) : fill_segment_all_float_of<1>(job, first);
}

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
