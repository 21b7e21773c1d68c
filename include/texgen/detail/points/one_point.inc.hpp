// One point: in double with a bound on its error; what that leaves in doubt in two doubles, and by exact sums what
// those leave in doubt. Included by texcoord.hpp.

namespace TEXGEN_DETAIL {

// Two forms side by side, as a matrix has them in its columns.
struct FormPair {
    Double2 x, y, z, w;

    // Inlined, because clang++ 19 to 23 else read two numbers of a form at once, and wait for both of their stores.
    TEXGEN_INLINE FormPair(const PointForm& a, const PointForm& b) noexcept
        : x(double2_of(a.x, b.x)), y(double2_of(a.y, b.y)), z(double2_of(a.z, b.z)), w(double2_of(a.w, b.w)) {}

    PointForm form(std::size_t k) const noexcept { return {x[k], y[k], z[k], w[k]}; }
};

// Two sums in two doubles each, and bounds on what these left out.
struct CloseSums {
    Double2 high, low, lost;

    // From sums in one double and the remainders of their roundings.
    template <std::size_t Count>
    CloseSums(const Double2& sum, const Double2 (&remainder)[Count]) noexcept {
        DoubleDouble2 rest = two_sum(remainder[0], remainder[1]);
        Double2 third = rest.low;
        lost = magnitude(third);
        for (std::size_t i = 2; i < Count; ++i) {
            rest = two_sum(rest.high, remainder[i]);
            third = third + rest.low;
            lost = lost + magnitude(rest.low);
        }
        DoubleDouble2 all = two_sum(sum, rest.high);
        if (any_less(magnitude(all.high) * 0x1p-60, lost)) {
            // Beside a sum that cancels the lost part is large, and is added.
            rest = two_sum(all.low, third);
            all = two_sum(all.high, rest.high);
            lost = lost * 0x1p-49 + magnitude(rest.low);
        }
        high = all.high;
        low = all.low;
    }

    // Whether sum k is known to this share of itself; a 0 is where it is exact.
    bool is_within(double share, std::size_t k) const noexcept { return lost[k] <= share * std::fabs(high[k]); }
};

// Two forms at a point of floats. Their coefficients are split in two parts, whose products are exact without fma().
inline CloseSums closely_at(const FormPair& forms, const glm::dvec3& v) noexcept {
    const Double2 x = leading_bits<27>(forms.x), y = leading_bits<27>(forms.y), z = leading_bits<27>(forms.z);
    const DoubleDouble2 to_x = two_sum<Double2>(x * v.x, forms.w);
    const DoubleDouble2 to_y = two_sum<Double2>(to_x.high, y * v.y);
    const DoubleDouble2 to_z = two_sum<Double2>(to_y.high, z * v.z);
    const Double2 remainder[] = {
        (forms.x - x) * v.x, (forms.y - y) * v.y, (forms.z - z) * v.z, to_x.low, to_y.low, to_z.low};
    return {to_z.high, remainder};
}

// A number as an odd integer of up to `count` bits times a power of two. Further bits are cut off.
struct Digits {
    std::int64_t integer;
    int exponent;

    explicit Digits(double number, int count = 53) noexcept {
        const auto bits = bit_cast<std::uint64_t>(number);
        const std::uint64_t size = ((bits & 0xfffffffffffff) | std::uint64_t{1} << 52) >> (53 - count);
        const int zeros = std::countr_zero(size);
        const auto odd = static_cast<std::int64_t>(size >> zeros);
        const std::int64_t sign = static_cast<std::int64_t>(bits) >> 63;
        integer = number == 0.0 ? 0 : (odd ^ sign) - sign;
        exponent = static_cast<int>(bits >> 52 & 0x7ff) - (1022 + count) + zeros;
    }
};

// A sum modulo a power of two: an integer without a sign, of which the last `size` bits are kept, times 2^unit.
template <class Integer>
class Residue {
public:
    static constexpr int size = 8 * sizeof(Integer);

    explicit Residue(int unit) noexcept : unit_(unit) {}

    void add(const Digits& term) noexcept {
        if (term.integer != 0) add(static_cast<Integer>(term.integer), term.exponent);
    }

    void add_product(const Digits& a, const Digits& b) noexcept {
        if (a.integer == 0 || b.integer == 0) return;
        add(static_cast<Integer>(a.integer) * static_cast<Integer>(b.integer), a.exponent + b.exponent);
    }

    void add_scaled(const Residue& other, const Digits& factor) noexcept {
        add(other.integer_ * static_cast<Integer>(factor.integer), other.unit_ + factor.exponent);
        is_whole_ = is_whole_ && other.is_whole_;
    }

    // Whether all terms are multiples of the unit. If so sign() is that of a sum of less than 2^(size - 1) units.
    bool is_whole() const noexcept { return is_whole_; }
    int sign() const noexcept { return integer_ == 0 ? 0 : integer_ >> (size - 1) != 0 ? -1 : 1; }

private:
    void add(const Integer& integer, int exponent) noexcept {
        const int by = exponent - unit_;
        if (by >= size) return;
        is_whole_ = is_whole_ && by >= 0;
        integer_ += integer << (by & (size - 1));
    }

    Integer integer_ = 0;
    int unit_;
    bool is_whole_ = true;
};

// The floats nearest to two numerators over q at a point of floats, every decision exact, in two doubles where they
// suffice. False where q is not positive, or is a NaN.
inline bool divide_closely(const FormPair& numerators, const PointForm& q_form, const glm::dvec3& v,
                           float (&value)[2]) noexcept {
    constexpr double enough = 0x1p-51;
    const CloseSums q = closely_at({q_form, q_form}, v);
    const bool is_q_close = q.is_within(enough, 0);
    const auto exact_q = [&] { return exactly_at(q_form, v); };
    if (!(is_q_close ? q.high[0] > 0.0 : certain_sign(value_at(q_form, v), exact_q) > 0)) return false;
    const CloseSums s = closely_at(numerators, v);
    bool is_decided[2], is_tied[2];
    float other[2];
    double middle[2];
    const Double2 quotient = s.high / q.high[0] + 0.0;  // no -0
    const Double2 error = magnitude(quotient) * 0x1p-48;
    const Double2 low = quotient - error, high = quotient + error;
    for (std::size_t k = 0; k < 2; ++k) {
        value[k] = static_cast<float>(low[k]);
        other[k] = static_cast<float>(high[k]);
        is_decided[k] = is_q_close && s.is_within(enough, k);
        is_tied[k] = is_decided[k] && value[k] != other[k];
        middle[k] = is_tied[k] ? middle_of(value[k], other[k]) : 0.0;
    }
    if (is_tied[0] || is_tied[1]) {
        // Decides as nearest_to() does. Next to a tie s.high - middle q.high is exact, part by part.
        const Double2 factor = double2_of(middle[0], middle[1]);
        const Double2 q_high = leading_bits<27>(q.high), q_low = leading_bits<27>(q.low);
        const Double2 remainder[3] = {s.low, -(factor * q_low), -(factor * (q.low - q_low))};
        CloseSums rest((s.high - factor * q_high) - factor * (q.high - q_high), remainder);
        rest.lost = rest.lost + (s.lost + magnitude(factor) * q.lost);
        for (std::size_t k = 0; k < 2; ++k) {
            if (!is_tied[k]) continue;
            is_decided[k] = rest.is_within(0.5, k);
            if (rest.high[k] >= 0.0) value[k] = rest.high[k] > 0.0 ? other[k] : static_cast<float>(middle[k]);
        }
    }
    for (std::size_t k = 0; k < 2; ++k) {
        if (is_decided[k]) continue;
        const PointForm form = numerators.form(k);
        value[k] = certain_quotient(
            value_at(form, v), value_at(q_form, v), [&] { return exactly_at(form, v); }, exact_q);
    }
    return true;
}

// s/q and t/q of a point, where q is well above 0. Their errors are those of certain_quotient().
struct PointQuotients {
    Double2 value, error;

    TEXGEN_INLINE PointQuotients(const FormPair& forms, const glm::dvec3& v, const Bounded& q) noexcept {
        const double reciprocal = 1.0 / q.value;
        const double relative_error = reciprocal * (q.error * 1.001) + 4.0 * unit_roundoff_double;
        const Double2 x = forms.x * v.x, y = forms.y * v.y, z = forms.z * v.z;
        const Double2 terms = magnitude(x) + magnitude(y) + magnitude(z) + magnitude(forms.w);
        value = (x + y + z + forms.w) * reciprocal;
        error = magnitude(value) * relative_error + terms * (reciprocal * (gamma(5) * 1.001));
    }
};
inline bool is_well_above_0(const Bounded& q) noexcept { return q.value > 0x1p20 * q.error; }

// The same beside a tie, by a remainder modulo a power of two. From quotients within error of their values, |s - middle
// q| is at most 2.0001 q error. Where that error is at most 2^-44 of the quotient, middle has 25 bits times 2^f and q
// is below 2^(e + 1), that is less than 2^(e - 16 + f). A template, as files of one program may differ in the widest
// integer. (Beside a q below 2^-600 elements of the matrix may be subnormal, which Digits cannot read.)
template <class Integer>
TEXGEN_APART bool divide_beside_ties(const FormPair& numerators, const PointForm& q_form, const glm::dvec3& v,
                                     float (&value)[2]) noexcept {
    const Bounded q = value_at(q_form, v);
    if (!is_well_above_0(q) || !(q.value > 0x1p-600)) return false;
    const PointQuotients quotient(numerators, v, q);
    if (any_less(magnitude(quotient.value) * 0x1p-44, quotient.error)) return false;
    const Digits at[] = {Digits(v.x, 24), Digits(v.y, 24), Digits(v.z, 24)};
    const auto residue_of = [&at](const PointForm& form, int unit) {
        Residue<Integer> sum(unit);
        sum.add_product(Digits(form.x), at[0]);
        sum.add_product(Digits(form.y), at[1]);
        sum.add_product(Digits(form.z), at[2]);
        sum.add(Digits(form.w));
        return sum;
    };
    const int unit = static_cast<int>(bit_cast<std::uint64_t>(q.value) >> 52) - 1023 - 15 - Residue<Integer>::size;
    const Residue<Integer> of_q = residue_of(q_form, unit);
    bool is_whole = true;
    for (std::size_t k = 0; k < 2 && is_whole; ++k) {
        value[k] = nearest_to(quotient.value[k] + 0.0, quotient.error[k], [&](double middle) {
            const Digits factor(-middle, 25);
            Residue<Integer> remainder = residue_of(numerators.form(k), unit + factor.exponent);
            remainder.add_scaled(of_q, factor);
            is_whole = remainder.is_whole();
            return remainder.sign();
        });
    }
    return is_whole;
}

// Two numerators over q at a point; empty behind the projector.
inline std::optional<glm::vec2> divide_point(const FormPair& numerators, const PointForm& q_form,
                                             const glm::dvec3& v) noexcept {
    const Bounded q = value_at(q_form, v);
    if (is_well_above_0(q)) {
        const PointQuotients quotient(numerators, v, q);
        if (rounds_alone(quotient.value[0], quotient.error[0]) && rounds_alone(quotient.value[1], quotient.error[1]))
            return glm::vec2(static_cast<float>(quotient.value[0]), static_cast<float>(quotient.value[1]));
    }
    if (q.value < -q.error) return std::nullopt;
    float value[2];
    if (!divide_beside_ties<WideInteger>(numerators, q_form, v, value) && !divide_closely(numerators, q_form, v, value))
        return std::nullopt;
    return glm::vec2(value[0], value[1]);
}

// One point of a job.
inline void project_one(const PointJob& job, std::size_t i) noexcept {
    const glm::dvec3 v = job.interleaved_xyz ? widened(glm::vec3(job.x[3 * i], job.x[3 * i + 1], job.x[3 * i + 2]))
                                             : widened(glm::vec3(job.x[i], job.y[i], job.z[i]));
    const std::optional<glm::vec2> value = divide_point({job.numerator[0], job.numerator[1]}, job.q, v);
    for (std::size_t k = 0; k < static_cast<std::size_t>(job.numerators); ++k)
        (job.interleaved_st ? job.out[0][2 * i + k] : job.out[k][i]) =
            value ? (*value)[static_cast<glm::length_t>(k)] : 0.0f;
    if (job.lit != nullptr) job.lit[i] = value && is_inside(value->x, value->y, job.min, job.max) ? 1.0f : 0.0f;
}

}  // namespace TEXGEN_DETAIL
