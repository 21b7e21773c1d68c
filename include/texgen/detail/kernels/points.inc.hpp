// The inner loops of points, and what those of segments share with them. Included by kernels.inc.hpp.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

template <class Vector, class Job>
TEXGEN_INLINE void load_points(const Job& job, std::size_t i, Vector& x, Vector& y, Vector& z) noexcept {
    if (job.interleaved_xyz) {
        load_interleaved(job.x + 3 * i, x, y, z);
    } else {
        x = load<Vector>(job.x + i);
        y = load<Vector>(job.y + i);
        z = load<Vector>(job.z + i);
    }
}

// Stores a vector of results from index i on, and their mask: inside the region and in front. Here and below `numerators`
// is a constant where it is quick to have one.
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

// Lanes that cannot be vouched for: where value - error and value + error do not round to one float, and where it is not
// certain on which side of the projector the point is.
struct Doubt {
    Words rounding{};
    LongWords side{};
    LongWords behind{};  // no doubt, but no ordinary points

    TEXGEN_INLINE bool any_lane() const noexcept { return any(rounding | narrow(side)); }
};

// numerator[k] / q with these errors, of all or of each lane; the error of the quotient is that of certain_quotient(). With
// Signed, q has either sign, and lanes that are certainly behind give 0; else they are in doubt too; and in none where both
// floats are inside the tolerance. Returns the mask of the lanes in front.
template <bool Signed, class Error>
TEXGEN_INLINE LongWords divide_certainly(std::size_t numerators, const Doubles (&numerator)[2],
                                         const Error (&numerator_error)[2], const Doubles& q, const Error& q_error,
                                         double tolerance, Floats (&value)[2], Doubt& doubt) noexcept {
    const LongWords in_front = greater(q - 0x1p20 * q_error, 0.0);
    Doubles reciprocal = 1.0 / q;
    if constexpr (Signed) {
        doubt.behind |= ~in_front;
        doubt.side |= ~(in_front | greater(-1.0 * q - q_error, 0.0));
        reciprocal = where(in_front, reciprocal);
    } else {
        doubt.side |= ~in_front;
    }
    const Doubles relative_error = reciprocal * (q_error * 1.001) + 4.0 * unit_roundoff_double;
    for (std::size_t k = 0; k < numerators; ++k) {
        Doubles quotient = numerator[k] * reciprocal;
        if constexpr (Signed) quotient = where(in_front, quotient);
        Doubles error = magnitude(quotient) * relative_error + reciprocal * (numerator_error[k] * 1.001);
        if constexpr (Signed) error = where(in_front, error);  // of a numerator that is no number
        value[k] = to_floats(quotient - error);
        const Floats other = to_floats(quotient + error);
        Words differ = bits(value[k]) ^ bits(other);
        if constexpr (Signed) {
            if (tolerance > 0.0 && any(differ)) {
                const Words is_within =
                    narrow(at_most((to_doubles(other) - to_doubles(value[k])) * 2.0, Doubles{} + tolerance));
                value[k] = select(is_within, to_floats(quotient), value[k]);
                differ &= ~is_within;
            }
        }
        doubt.rounding |= differ;
    }
    return in_front;
}

// What decided a vector or a block of values, and is tried first with the next, so that company is not tried in vain.
enum class Rung {
    in_front,     // in double, with errors that hold for the block, which is all in front
    either_side,  // the same on both sides of the projector
    each_lane,    // with errors of each lane
    closely       // in two doubles
};
struct Effort {
    Rung rung = Rung::in_front;
    bool are_ties = false;   // closely: the numerators as well as q
    bool precisely = false;  // all of the sums, or their leading part
};

// What doing a block again leaves.
struct Again {
    std::uint64_t doubtful;  // bit i: value begin + i
    Effort effort;
};

// Does a block again, from each_lane on at least. What a vector needs beyond that, up to 15 that follow it get at once. Terms
// are the sums at a vector of values: q and the numerators, nearly and in two doubles, and which lanes are behind whatever
// their q, being no numbers.
template <class Terms>
TEXGEN_INLINE Again fill_block_again(const DividedOutput& output, const Terms& terms, std::size_t begin,
                                     std::size_t end, Effort effort) noexcept {
    const auto numerators = static_cast<std::size_t>(output.numerators);
    std::uint64_t doubtful = 0;
    for (std::size_t i = begin; i < end; i += static_cast<std::size_t>(lanes)) {
        const auto at = terms.load(i);
        const LongWords are_dark = terms.are_dark(at);
        Floats value[2];
        if (effort.rung <= Rung::each_lane || i / static_cast<std::size_t>(lanes) % 16 == 0) {
            Doubles numerator[2], numerator_error[2];
            for (std::size_t k = 0; k < numerators; ++k) {
                numerator[k] = terms.numerator[k].nearly_at(at);
                numerator_error[k] = terms.numerator[k].error_at(at);
            }
            Doubt doubt;
            const LongWords in_front =
                divide_certainly<true>(numerators, numerator, numerator_error, terms.q.nearly_at(at),
                                       terms.q.error_at(at), terms.tolerance(), value, doubt);
            const bool is_decided = !any(doubt.rounding | narrow(doubt.side & ~are_dark));
            effort = {is_decided ? Rung::each_lane : Rung::closely, false, effort.precisely && !is_decided};
            if (is_decided) {
                store_points(output, i, numerators, value, narrow(in_front));
                continue;
            }
        }
        LongWords in_front, is_known;
        for (;;) {
            const TwofoldDivisor q(terms.q.at(at, effort.precisely));
            in_front = q.in_front;
            is_known = q.is_known | are_dark;
            for (std::size_t k = 0; k < numerators; ++k) {
                const auto& numerator = terms.numerator[k];
                if (!effort.are_ties)
                    effort.are_ties = !divide_nearly(numerator.nearly_at(at), numerator.error_at(at), q, value[k]);
                if (!effort.are_ties) continue;
                if (numerator.is_finite)
                    value[k] = nearest_quotients(numerator.at(at, effort.precisely), q, terms.tolerance(),
                                                 effort.precisely, is_known);
                else
                    value[k] = to_floats(where(in_front, numerator.nearly_at(at) * q.reciprocal));
            }
            if (effort.precisely || !any(narrow(~is_known))) break;
            effort.precisely = true;
        }
        store_points(output, i, numerators, value, narrow(in_front));
        const Words doubt = narrow(~is_known);
        if (!any(doubt)) continue;
        for (int lane = 0; lane < lanes; ++lane)
            if (doubt[lane] != 0) doubtful |= std::uint64_t{1} << (i - begin + static_cast<std::size_t>(lane));
    }
    return {doubtful, effort};
}

// The largest |x|, |y|, |z| of a block: of all three together for triples. A NaN is the largest.
struct PointExtent {
    double x, y, z;

    TEXGEN_INLINE PointExtent(const WideWords& x_bits, const WideWords& y_bits, const WideWords& z_bits) noexcept
        : x(static_cast<double>(bit_cast<float>(largest_lane(x_bits)))),
          y(static_cast<double>(bit_cast<float>(largest_lane(y_bits)))),
          z(static_cast<double>(bit_cast<float>(largest_lane(z_bits)))) {}

    TEXGEN_INLINE double magnitude_of(const PointForm& form) const noexcept {
        return std::fabs(form.x) * x + std::fabs(form.y) * y + std::fabs(form.z) * z + std::fabs(form.w);
    }
};

TEXGEN_INLINE PointExtent extent_of(const PointJob& job, std::size_t begin, std::size_t end) noexcept {
    WideWords x{};
    WideWords y{};
    WideWords z{};
    for (std::size_t i = begin; i < end; i += static_cast<std::size_t>(wide_lanes)) {
        const float* const from = job.x + 3 * i;
        x = maximum(magnitude_bits(load<WideFloats>(job.interleaved_xyz ? from : job.x + i)), x);
        y = maximum(magnitude_bits(load<WideFloats>(job.interleaved_xyz ? from + wide_lanes : job.y + i)), y);
        z = maximum(magnitude_bits(load<WideFloats>(job.interleaved_xyz ? from + 2 * wide_lanes : job.z + i)), z);
    }
    if (job.interleaved_xyz) x = y = z = maximum(maximum(x, y), z);
    return {x, y, z};
}

template <class Job>
TEXGEN_INLINE PointLanes load_points(const Job& job, std::size_t i) noexcept {
    Floats x, y, z;
    load_points(job, i, x, y, z);
    return {{to_doubles(x), to_doubles(y), to_doubles(z)}};
}

TEXGEN_INLINE Doubles at(const PointForm& form, const PointLanes& point) noexcept {
    return point.v[0] * form.x + (point.v[1] * form.y + (point.v[2] * form.z + form.w));
}

// A block of points, with errors that hold for all of it. Returns what is in doubt (it is written all the same).
template <bool Signed, std::size_t Numerators>
TEXGEN_INLINE Doubt fill_points_block(const PointJob& job, std::size_t begin, std::size_t end) noexcept {
    const PointExtent extent = extent_of(job, begin, end);
    double numerator_error[2];
    for (std::size_t k = 0; k < Numerators; ++k) numerator_error[k] = gamma(5) * extent.magnitude_of(job.numerator[k]);
    const double q_error = gamma(5) * extent.magnitude_of(job.q);
    Doubt doubt;
    for (std::size_t i = begin; i < end; i += static_cast<std::size_t>(lanes)) {
        const PointLanes point = load_points(job, i);
        Doubles numerator[2];
        for (std::size_t k = 0; k < Numerators; ++k) numerator[k] = at(job.numerator[k], point);
        Floats value[2];
        const LongWords in_front = divide_certainly<Signed>(Numerators, numerator, numerator_error, at(job.q, point),
                                                            q_error, job.tolerance, value, doubt);
        store_points(job, i, Numerators, value, narrow(in_front));
    }
    return doubt;
}

// The sums of points, for fill_block_again().
struct PointTerms {
    const PointJob& job;
    TwofoldForm q;
    TwofoldForm numerator[2];

    TEXGEN_INLINE double tolerance() const noexcept { return job.tolerance; }
    TEXGEN_INLINE explicit PointTerms(const PointJob& points) noexcept : job(points), q(points.q) {
        for (int k = 0; k < job.numerators; ++k) numerator[k] = TwofoldForm(points.numerator[k]);
    }
    TEXGEN_INLINE PointLanes load(std::size_t i) const noexcept { return load_points(job, i); }
    TEXGEN_INLINE LongWords are_dark(const PointLanes& at) const noexcept {
        const Doubles zero =
            (at.v[0] + at.v[1] + at.v[2]) * (q.is_finite ? 0.0 : std::numeric_limits<double>::quiet_NaN());
        return ~at_most(zero, zero);
    }
};

template <class CompiledWhereCalled = void>
TEXGEN_APART Again fill_points_again(const PointJob& original, std::size_t begin, std::size_t end,
                                     const Effort& effort) noexcept {
    if (effort.rung <= Rung::either_side) {
        const PointJob job = original;
        const Doubt doubt = job.numerators == 2 ? fill_points_block<true, 2>(job, begin, end)
                                                : fill_points_block<true, 1>(job, begin, end);
        if (!doubt.any_lane()) return {0, {any(doubt.behind) ? Rung::either_side : Rung::in_front}};
    }
    return fill_block_again(original, PointTerms(original), begin, end, effort);
}

// Most blocks are all in front and in no doubt; those that follow one that is not are taken for what it was, seven of them.
// The job is copied, here and below, so that the compiler knows that no store changes it: nothing that the loop reads may be
// reached from elsewhere.
template <std::size_t Numerators>
TEXGEN_INLINE Undecided fill_points_exact_of(const PointJob& original, std::size_t first) noexcept {
    const PointJob job = original;
    Effort effort;
    for (std::size_t begin = first; begin < job.count;) {
        const std::size_t block = begin / exact_block;
        const std::size_t next = (block + 1) * exact_block;
        const std::size_t end = next < job.count ? next : job.count;
        if (block % 8 == 0 && effort.rung == Rung::each_lane) effort = {};
        bool is_certain = false;
        if (effort.rung == Rung::in_front)
            is_certain = !fill_points_block<false, Numerators>(job, begin, end).any_lane();
        if (!is_certain) {
            const Again again = fill_points_again(original, begin, end, effort);
            if (again.doubtful != 0) return {begin, again.doubtful};
            effort = again.effort;
        }
        begin = end;
    }
    return {job.count, 0};
}

template <class CompiledWhereCalled = void>
Undecided fill_points_exact(const PointJob& job, std::size_t first) noexcept {
    return job.numerators == 2 ? fill_points_exact_of<2>(job, first) : fill_points_exact_of<1>(job, first);
}

// The forms of q and of the numerators in float, in the order in which they are computed.
template <std::size_t Numerators>
struct FormsInFloat {
    float coefficient[1 + Numerators][4];

    TEXGEN_INLINE explicit FormsInFloat(const PointJob& job) noexcept {
        fill(coefficient[0], job.q);
        for (std::size_t k = 0; k < Numerators; ++k) fill(coefficient[1 + k], job.numerator[k]);
    }
    TEXGEN_INLINE WideFloats at(std::size_t k, const WideFloats& x, const WideFloats& y,
                                const WideFloats& z) const noexcept {
        const float(&c)[4] = coefficient[k];
        return x * c[0] + (y * c[1] + (z * c[2] + c[3]));
    }

private:
    TEXGEN_INLINE static void fill(float (&to)[4], const PointForm& form) noexcept {
        to[0] = static_cast<float>(form.x);
        to[1] = static_cast<float>(form.y);
        to[2] = static_cast<float>(form.z);
        to[3] = static_cast<float>(form.w);
    }
};

// The same in double, rounded once.
template <std::size_t Numerators>
struct FormsInDouble {
    const PointJob& job;

    TEXGEN_INLINE explicit FormsInDouble(const PointJob& points) noexcept : job(points) {}
    TEXGEN_INLINE WideFloats at(std::size_t k, const WideFloats& x, const WideFloats& y,
                                const WideFloats& z) const noexcept {
        const PointForm& form = k == 0 ? job.q : job.numerator[k - 1];
        const auto value = [&form](const Doubles& vx, const Doubles& vy, const Doubles& vz) {
            return detail::TEXGEN_ISA::at(form, {{vx, vy, vz}});
        };
        return in_double(value, x, y, z);
    }
};

// Divided in float, in blocks of float_block points. The largest |v_j| bound the terms of the forms, and with the largest
// quotient and the least q, found on the way, the error of every point: see FloatDivision. Returns where the first block
// begins that is not inside the tolerance (it is written all the same), or the count. A NaN makes the largest quotient
// one, and fails.
template <template <std::size_t> class Forms, std::size_t Numerators>
TEXGEN_INLINE std::size_t fill_points_within_of(const PointJob& job, std::size_t first) noexcept {
    constexpr bool in_float = std::is_same_v<Forms<1>, FormsInFloat<1>>;
    constexpr FloatDivision division = in_float ? all_float : float_divided;
    const Forms<Numerators> forms(job);
    for (std::size_t begin = first; begin < job.count; begin += float_block) {
        const std::size_t end = begin + float_block < job.count ? begin + float_block : job.count;
        WideWords x_largest{};
        WideWords y_largest{};
        WideWords z_largest{};
        WideWords largest[Numerators] = {};
        WideWords q_least = signed_bits(WideFloats{} + 0x1p100f);
        for (std::size_t i = begin; i < end; i += static_cast<std::size_t>(wide_lanes)) {
            WideFloats x, y, z;
            load_points(job, i, x, y, z);
            x_largest = maximum(magnitude_bits(x), x_largest);
            y_largest = maximum(magnitude_bits(y), y_largest);
            z_largest = maximum(magnitude_bits(z), z_largest);
            const WideFloats q = forms.at(0, x, y, z);
            q_least = minimum(signed_bits(q), q_least);
            const WideFloats reciprocal = 1.0f / q;
            WideFloats value[2];
            for (std::size_t k = 0; k < Numerators; ++k) {
                value[k] = forms.at(1 + k, x, y, z) * reciprocal;
                largest[k] = maximum(magnitude_bits(value[k]), largest[k]);
            }
            store_points(job, i, Numerators, value, ~WideWords{});
        }
        const PointExtent extent(x_largest, y_largest, z_largest);
        const double size = extent.x + extent.y + extent.z + 1.0;
        // The bits of positive floats have their order; those of a negative one, and of -0, are below them all. A q that
        // overflowed in float would go unnoticed, not being the least; its terms tell.
        const int least_bits = ~largest_lane(~q_least);
        const auto least = static_cast<double>(bit_cast<float>(least_bits));
        bool certified = true;
        for (std::size_t k = 0; k < Numerators; ++k) {
            const auto bound = static_cast<double>(bit_cast<float>(largest_lane(largest[k])));
            const double error =
                division.error(extent.magnitude_of(job.numerator[k]), extent.magnitude_of(job.q), size, least, bound);
            certified = certified && error <= job.tolerance;
        }
        if (!certified) return begin;
    }
    return job.count;
}

template <template <std::size_t> class Forms>
std::size_t fill_points_within(const PointJob& original, std::size_t first) noexcept {
    const PointJob job = original;
    return job.numerators == 2 ? fill_points_within_of<Forms, 2>(job, first)
                               : fill_points_within_of<Forms, 1>(job, first);
}

// The forms at points, in double, rounded once.
template <class CompiledWhereCalled = void>
void generate_points(const GenerateJob& original) noexcept {
    const GenerateJob job = original;
    for (std::size_t i = 0; i < job.count; i += static_cast<std::size_t>(lanes)) {
        const PointLanes point = load_points(job, i);
        if (job.strq != nullptr) {
            store_interleaved(job.strq + 4 * i, to_floats(at(job.form[0], point)), to_floats(at(job.form[1], point)),
                              to_floats(at(job.form[2], point)), to_floats(at(job.form[3], point)));
        } else {
            for (std::size_t k = 0; k < 4; ++k)
                if (job.out[k] != nullptr) store(job.out[k] + i, to_floats(at(job.form[k], point)));
        }
    }
}

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
