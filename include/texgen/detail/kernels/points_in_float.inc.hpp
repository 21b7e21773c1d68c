// The inner loops of points that are divided in float, inside a tolerance. Included by kernels.inc.hpp.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

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
    PointFormLanes form[1 + Numerators];

    TEXGEN_INLINE explicit FormsInDouble(const PointJob& job) noexcept : form{job.q} {
        for (std::size_t k = 0; k < Numerators; ++k) form[1 + k] = job.numerator[k];
    }
    TEXGEN_INLINE WideFloats at(std::size_t k, const WideFloats& x, const WideFloats& y,
                                const WideFloats& z) const noexcept {
        const auto value = [&](const Doubles& vx, const Doubles& vy, const Doubles& vz) {
            return value_at(form[k], PointLanes{{vx, vy, vz}});
        };
        return in_double(value, x, y, z);
    }
};

// Whether the errors of quotients in float are inside a tolerance in all lanes, by FloatDivision::error(): in float
// itself, whose roundings, 16 units each at most, the factors cover. A NaN is not inside.
TEXGEN_INLINE bool are_within(const FloatDivision& division, const PointForm& numerator, const PointForm& q_form,
                              const PointExtent& extent, const WideWords& least_q, const WideWords& largest,
                              double tolerance) noexcept {
    const auto form_error = static_cast<float>(division.form_error * 1.0001);
    const auto roundings = static_cast<float>(division.roundings * 1.0001);
    const WideFloats s_terms = extent.terms_of(numerator);
    const WideFloats q_terms = extent.terms_of(q_form);
    const WideFloats quotient = from_bits(largest);
    const WideFloats underflow = (extent.x + extent.y + extent.z + 1.0f) * 0x1.01p-124f;
    const WideFloats q_error = q_terms * form_error + underflow;
    const WideFloats q = from_bits(least_q) * (1.0f - (roundings + 0x1p-20f)) - q_error;
    const WideFloats error =
        (s_terms * form_error + underflow + quotient * q_error) / q * 1.0015f + quotient * roundings;
    const auto accepted = static_cast<float>(tolerance > 0x1p-100 ? 0.9999 * tolerance : 0.0);
    constexpr float largest_terms = 0x1p126f;
    const WideWords is_within = less(WideFloats{} + 0x1p-59f, q) & less(s_terms, WideFloats{} + largest_terms) &
                                less(q_terms, WideFloats{} + largest_terms) & less(error, WideFloats{} + accepted);
    return !any(~is_within);
}

// Divided in float, in blocks of float_block points and then more. The largest |v_j| bound the terms of the forms, and
// with the largest quotient and the least q, found on the way, the error of every point: see FloatDivision. Returns
// where the first block begins that is not inside the tolerance (it is written all the same), or the count. A NaN makes
// the largest quotient one, and fails. The job is copied for the loops, field by field: what was written by fields is
// waited for when it is read whole, as it would be were its forms, which are found by their number, in the copy.
template <template <std::size_t> class Forms, std::size_t Numerators>
TEXGEN_INLINE std::size_t fill_points_within_of(const PointJob& original, std::size_t first) noexcept {
    constexpr bool in_float = std::is_same_v<Forms<1>, FormsInFloat<1>>;
    constexpr FloatDivision division = in_float ? all_float : float_divided;
    const Forms<Numerators> forms(original);
    const PointJob job = original;
    const auto divide = [&](const WideFloats& x, const WideFloats& y, const WideFloats& z, const WideFloats& q,
                            WideFloats(&value)[2]) {
        const WideFloats reciprocal = 1.0f / q;
        for (std::size_t k = 0; k < Numerators; ++k) value[k] = forms.at(1 + k, x, y, z) * reciprocal;
    };
    WideFloats x, y, z, value[2];
    if (in_float && job.is_certified) {
        for (std::size_t i = first; i < job.count; i += wide_at_once) {
            load_points(job, i, x, y, z);
            divide(x, y, z, forms.at(0, x, y, z), value);
            store_points(job, i, Numerators, value, ~WideWords{});
        }
        return job.count;
    }
    std::size_t size_of_block = in_float ? float_block : exact_block;
    for (std::size_t begin = first, end; begin < job.count; begin = end) {
        end = size_of_block < job.count - begin ? begin + size_of_block : job.count;
        size_of_block = 4 * float_block;
        PointExtent extent;
        WideWords largest[Numerators] = {};
        // The bits of positive floats have their order; those of a negative one, and of -0, are below them all. A q
        // that overflowed in float would go unnoticed, not being the least; its terms tell.
        WideWords least_q = signed_bits(WideFloats{} + 0x1p100f);
        for (std::size_t i = begin; i < end; i += wide_at_once) {
            load_points(job, i, x, y, z);
            extent.add(x, y, z);
            const WideFloats q = forms.at(0, x, y, z);
            least_q = minimum(signed_bits(q), least_q);
            divide(x, y, z, q, value);
            for (std::size_t k = 0; k < Numerators; ++k) largest[k] = maximum(magnitude_bits(value[k]), largest[k]);
            store_points(job, i, Numerators, value, ~WideWords{});
        }
        for (std::size_t k = 0; k < Numerators; ++k)
            if (!are_within(division, original.numerator[k], original.q, extent, least_q, largest[k],
                            original.tolerance))
                return begin;
    }
    return job.count;
}

template <template <std::size_t> class Forms, class CompiledWhereCalled = void>
std::size_t fill_points_within(const PointJob& job, std::size_t first) noexcept {
    return job.numerators == 2 ? fill_points_within_of<Forms, 2>(job, first)
                               : fill_points_within_of<Forms, 1>(job, first);
}

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
