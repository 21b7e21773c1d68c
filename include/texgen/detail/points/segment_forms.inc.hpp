// How a segment is divided: its ends, the forms about them and about the asymptote, and their errors. Included by
// segment.hpp.

namespace TEXGEN_DETAIL_BUILD {

// Both ends in two coordinates, or in one that is in both places.
struct SegmentEnds {
    Double2 a, b;
    double q_a, q_b;

    SegmentEnds(const Segment& segment, int first, int second) noexcept
        : a(of(segment.a, first, second)),
          b(of(segment.b, first, second)),
          q_a(widened(segment.a.w)),
          q_b(widened(segment.b.w)) {}
    explicit SegmentEnds(const SegmentJob& job) noexcept
        : a(double2_of(job.a[0], job.a[1])), b(double2_of(job.b[0], job.b[1])), q_a(job.q_a), q_b(job.q_b) {}

    bool are_in_front() const noexcept { return q_a > 0.0 && q_b > 0.0; }

private:
    static Double2 of(const glm::vec4& end, int first, int second) noexcept {
        return double2_of(widened(end[static_cast<glm::length_t>(first)]),
                          widened(end[static_cast<glm::length_t>(second)]));
    }
};

inline double larger_lane(const Double2& of) noexcept { return larger(of[0], of[1]); }

// Written as a whole: a number that is read soon after it was written in halves waits for all writes before it.
inline void put(double (&to)[2], const Double2& values) noexcept { std::memcpy(to, &values, sizeof values); }

// The quotients at the ends of a segment in front, but for some ulps.
struct EndQuotients {
    double of_q_a, of_q_b;
    Double2 at_a, at_b;

    explicit EndQuotients(const SegmentEnds& ends) noexcept
        : of_q_a(1.0 / ends.q_a), of_q_b(1.0 / ends.q_b), at_a(ends.a * of_q_a), at_b(ends.b * of_q_b) {}

    Double2 least() const noexcept { return smaller(magnitude(at_a), magnitude(at_b)); }
    Double2 largest() const noexcept { return larger(magnitude(at_a), magnitude(at_b)); }
    Double2 sum() const noexcept { return magnitude(at_a) + magnitude(at_b); }
};

// With D = Q1 - Q0, u is exactly
//   U + d / (alpha + p),  U = (F1 - F0) / D, p = Q0 / D, d = (F0 Q1 - F1 Q0) / D^2.
struct Asymptote {
    double pole, ratio;
    Double2 base, slope;

    Asymptote(const SegmentEnds& ends, const EndQuotients& u) noexcept : ratio(larger(1.0, ends.q_a * u.of_q_b)) {
        const double difference = ends.q_b - ends.q_a;
        const double inverse = difference != 0.0 ? 1.0 / difference : 0.0;  // then the pole is not in range
        pole = ends.q_a * inverse;
        base = (ends.b - ends.a) * inverse;
        slope = (ends.a * ends.q_b - ends.b * ends.q_a) * inverse * inverse;
    }

    // Whether no number leaves its range.
    bool is_in_range(const EndQuotients& u) const noexcept {
        const double size = magnitude(pole);
        return ratio < 0x1p10 && size < 0x1p30 && size > 0x1p-30 &&
               all_less(u.sum() + magnitude(base), double2_of(0x1p60, 0x1p60));
    }

    // The error of that in unit roundoffs of double. Roundings of D, its reciprocal and their products are 3 of p, 4 of
    // U and 7 of d; p is at most max(1, Q0 / Q1) times the divisor. The errors of p and d, one of the sum, three of a
    // reciprocal that two vectors share, and one of the product are relative to u - U, which is largest at an end; that
    // of the last sum is relative to u.
    Double2 error(const EndQuotients& u) const noexcept {
        const Double2 part = larger(magnitude(u.at_a - base), magnitude(u.at_b - base));
        return (part * (12.0 + 3.0 * ratio) + magnitude(base) * 4.0 + u.largest()) * 1.01;
    }
};

// About the end where q is less, with i the alpha from there, u is exactly
//   u0 + d i / (1 + b i),  b = (Q1 - Q0) / Q0 >= 0,  d = (u1 - u0) Q1 / Q0,
// and the step lies between 0 and u1 - u0.
struct LesserEnd {
    bool is_b;
    double ratio, bend;
    Double2 base, slope;

    LesserEnd(const SegmentEnds& ends, const EndQuotients& u) noexcept
        : is_b(ends.q_b < ends.q_a),
          ratio(is_b ? ends.q_a * u.of_q_b : ends.q_b * u.of_q_a),
          bend(is_b ? (ends.q_a - ends.q_b) * u.of_q_b : (ends.q_b - ends.q_a) * u.of_q_a),
          base(is_b ? u.at_b : u.at_a),
          slope(((is_b ? u.at_a : u.at_b) - base) * ratio) {}

    bool is_in_range(const EndQuotients& u) const noexcept {
        return ratio < 0x1p60 && all_less(u.sum(), double2_of(0x1p60, 0x1p60));
    }

    // The error of that in float. In its unit roundoffs the step errs by 11 at most: by those of 1 - alpha, b, its
    // product and the sum, the product of two sums, what it divides, the products with the other sum and with i, d, the
    // share of the other d and its product. u0 and the last sum are rounded once each. A share of d, and what of d two
    // vectors divide, may be below the normal floats: of each that is lost, times less than 2^60.
    Double2 error(const EndQuotients& u) const noexcept {
        return (u.largest() * 2.0 + magnitude(u.at_a - u.at_b) * 12.0) * 1.001 * unit_roundoff_float + 0x1p-64;
    }
};

}  // namespace TEXGEN_DETAIL_BUILD
