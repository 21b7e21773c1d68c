// What doubles leave in doubt of a batch's fragments, to twice their precision: the edge functions from the differences between
// the fragment and the vertices, as in triangle/close_planes.hpp, a triangle in each lane. Included by batch.inc.hpp. For rounding
// to nearest; only exact products are added to what their sum is compared with, so that contraction changes nothing.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

// A difference: the leading 26 bits of the double next to it, the others, and what that lacks. Of two such products all but that of
// the others are exact.
struct DifferenceLanes {
    Doubles high, low, lost;

    TEXGEN_INLINE void set(const Doubles& a, const Doubles& b) noexcept {
        const Doubles difference = two_sum(a, b * -1.0, lost);
        high = leading_bits<26>(difference);
        low = difference - high;
    }
};

// An edge function in two doubles, and the sizes of the terms that it is the difference of.
struct EdgeLanes {
    Doubles high, low, size;

    // What two differences span: within 2^-98 of the size. Not short are differences that have a low part, or have lost one.
    TEXGEN_INLINE void set(const DifferenceLanes& to_x, const DifferenceLanes& to_y, const DifferenceLanes& from_x,
                           const DifferenceLanes& from_y, bool is_short, bool is_lost) noexcept {
        const Doubles left = to_x.high * from_y.high;
        const Doubles right = to_y.high * from_x.high;
        size = magnitude(left) + magnitude(right);
        high = two_sum(left, right * -1.0, low);
        if (is_short) return;
        Doubles error[4];
        const Doubles left_middle = two_sum(to_x.high * from_y.low, to_x.low * from_y.high, error[0]);
        const Doubles right_middle = two_sum(to_y.high * from_x.low, to_y.low * from_x.high, error[1]);
        const Doubles middle = two_sum(left_middle, right_middle * -1.0, error[2]);
        const Doubles sum = two_sum(high, middle, error[3]);
        Doubles last = to_x.low * from_y.low - to_y.low * from_x.low;
        if (is_lost)
            last = last + (((to_x.high + to_x.low) * from_y.lost + to_x.lost * (from_y.high + from_y.low)) -
                           ((to_y.high + to_y.low) * from_x.lost + to_y.lost * (from_x.high + from_x.low)));
        const Doubles rest = ((low + error[3]) + (error[2] + (error[0] - error[1]))) + last;
        high = two_sum(sum, rest, low);
    }

    // A product with a float is within 2^-104 of itself.
    TEXGEN_INLINE void multiply(const Doubles& factor) noexcept {
        const Doubles leading = leading_bits<27>(high);
        Doubles error;
        high = quick_two_sum(leading * factor, (high - leading) * factor, error);
        low = low * factor + error;
    }
};

// The vertices of the triangle in each lane; of its numbers x, y, w, s, t, r, q.
struct VertexLanes {
    Doubles vertex[3][8];
    Doubles area;        // nearly, doubled
    LongWords has_area;  // its sign is known
    Doubles error_of_q;  // infinite elsewhere, so that all is in doubt

    TEXGEN_INLINE explicit VertexLanes(const float* const (&triangle)[lanes]) noexcept {
        TEXGEN_UNROLL
        for (std::size_t i = 0; i < 3; ++i)
            load_columns(vertex[i], 8, [&](std::size_t j) { return triangle[j] + i * BatchVertex::size; });
        const Doubles left = (number(1, 0) - number(0, 0)) * (number(2, 1) - number(0, 1));
        const Doubles right = (number(1, 1) - number(0, 1)) * (number(2, 0) - number(0, 0));
        area = left - right;
        has_area = greater(magnitude(area), (magnitude(left) + magnitude(right)) * gamma(4));
        if (any(~has_area)) find_area();
        error_of_q = where(~has_area, Doubles{} + std::numeric_limits<double>::infinity());
    }

    TEXGEN_INLINE const Doubles& number(std::size_t i, std::size_t k) const noexcept {
        return vertex[i][k < 3 ? k : BatchVertex::strq + (k - 3)];
    }

private:
    // Of slivers it takes two doubles.
    TEXGEN_INLINE void find_area() noexcept {
        DifferenceLanes to_b[2], to_c[2];
        for (std::size_t k = 0; k < 2; ++k) {
            to_b[k].set(number(1, k), number(0, k));
            to_c[k].set(number(2, k), number(0, k));
        }
        EdgeLanes edge;
        edge.set(to_b[0], to_b[1], to_c[0], to_c[1], false, true);
        area = edge.high;
        has_area = greater(magnitude(area), edge.size * 0x1p-98);
    }
};

// Sums F = sum G_i f_i over the corners, with G_i = E_i w_j w_k: what the functions of the triangles share.
struct CloseTerms {
    Doubles leading[3], trailing[3], low[3];  // of G_i; leading and trailing are 27 and 26 bits
    Doubles size[3];                          // of what E_i is the difference of, times w_j w_k
    Doubles inexact;                          // 0 where all G_i are a double, exactly
    bool is_leading;                          // leading is all there is

    // Of E_i, and what is not 0 where they are not exact differences.
    TEXGEN_INLINE void take(const VertexLanes& given, EdgeLanes (&edge)[3], const Doubles& edge_inexact) noexcept {
        inexact = edge_inexact;
        Doubles rest{};
        TEXGEN_UNROLL
        for (std::size_t i = 0; i < 3; ++i) {
            const Doubles w_j = given.number((i + 1) % 3, 2);
            const Doubles w_k = given.number((i + 2) % 3, 2);
            inexact = inexact + magnitude(edge[i].low);
            edge[i].multiply(with_sign_of(w_j, given.area));
            inexact = inexact + magnitude(edge[i].low);
            edge[i].multiply(w_k);
            low[i] = edge[i].low;
            inexact = inexact + magnitude(low[i]);
            size[i] = edge[i].size * (w_j * w_k);
            leading[i] = leading_bits<27>(edge[i].high);
            trailing[i] = edge[i].high - leading[i];
            rest = rest + (magnitude(trailing[i]) + magnitude(low[i]));
        }
        is_leading = !any(are_nonzero(rest));
    }

    // Of coordinate k, 0 to 3 for s, t, r, q.
    TEXGEN_INLINE CloseValues function(const VertexLanes& given, std::size_t k) const noexcept {
        Doubles f[3];
        TEXGEN_UNROLL
        for (std::size_t i = 0; i < 3; ++i) f[i] = given.number(i, 3 + k);
        Doubles error[5];
        Doubles sum = two_sum(leading[0] * f[0], leading[1] * f[1], error[0]);
        sum = two_sum(sum, leading[2] * f[2], error[1]);
        Doubles rest = error[0] + error[1];
        Doubles is_inexact = magnitude(error[0]) + (magnitude(error[1]) + inexact);
        if (!is_leading) {
            Doubles second = two_sum(trailing[0] * f[0], trailing[1] * f[1], error[2]);
            second = two_sum(second, trailing[2] * f[2], error[3]);
            sum = two_sum(sum, second, error[4]);
            is_inexact = is_inexact + ((magnitude(error[2]) + magnitude(error[3])) + magnitude(error[4]));
            rest = (rest + error[4]) + ((error[2] + error[3]) + (low[0] * f[0] + (low[1] * f[1] + low[2] * f[2])));
        }
        CloseValues result;
        result.high = two_sum(sum, rest, result.low);
        result.error = Doubles{};
        const LongWords is_rounded = greater(is_inexact, 0.0);
        if (any(is_rounded)) {
            const Doubles terms = magnitude(f[0]) * size[0] + (magnitude(f[1]) * size[1] + magnitude(f[2]) * size[2]);
            result.error = where(is_rounded, terms * 0x1p-96);
        }
        return result;
    }
};

// At a fragment: all are within 2^-98 of their size. Of one far away what corner k is off corner j takes the place of what it is off
// the fragment: E_i is the same, of terms that are less.
struct CloseLanes : CloseTerms {
    TEXGEN_INLINE CloseLanes(const VertexLanes& given, const Doubles& x, const Doubles& y) noexcept {
        // Of side i from here to its corner j, and from there or here to k.
        DifferenceLanes to_x[3], to_y[3], from_x[3], from_y[3];
        Doubles lost{}, below{};
        TEXGEN_UNROLL
        for (std::size_t i = 0; i < 3; ++i) {
            to_x[i].set(given.number(i, 0), x);
            to_y[i].set(given.number(i, 1), y);
            lost = lost + (magnitude(to_x[i].lost) + magnitude(to_y[i].lost));
            below = below + (magnitude(to_x[i].low) + magnitude(to_y[i].low));
            from_x[(i + 1) % 3] = to_x[i];
            from_y[(i + 1) % 3] = to_y[i];
        }
        const bool is_lost = any(greater(lost, 0.0));
        if (is_lost) {
            Doubles spread{};
            for (std::size_t i = 1; i < 3; ++i)
                spread = spread + (magnitude(given.number(i, 0) - given.number(0, 0)) +
                                   magnitude(given.number(i, 1) - given.number(0, 1)));
            const LongWords is_far = greater(magnitude(to_x[0].high) + magnitude(to_y[0].high), spread * 0x1p10);
            for (std::size_t i = 0; i < 3; ++i) {
                const std::size_t j = (i + 1) % 3;
                const std::size_t k = (i + 2) % 3;
                from_x[i].set(given.number(k, 0), select(is_far, given.number(j, 0), x));
                from_y[i].set(given.number(k, 1), select(is_far, given.number(j, 1), y));
                lost = lost + (magnitude(from_x[i].lost) + magnitude(from_y[i].lost));
            }
        }
        const bool is_short = !is_lost && !any(greater(below, 0.0));
        EdgeLanes edge[3];
        TEXGEN_UNROLL
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t j = (i + 1) % 3;
            edge[i].set(to_x[j], to_y[j], from_x[i], from_y[i], is_short, is_lost);
        }
        take(given, edge, below + lost);
    }
};

// By how much the functions grow along a row (axis 1) or down (axis 0): E_i does by what corners j and k are apart.
struct CloseSteps : CloseTerms {
    TEXGEN_INLINE CloseSteps(const VertexLanes& given, std::size_t axis) noexcept {
        EdgeLanes edge[3];
        TEXGEN_UNROLL
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t j = (i + (axis == 1 ? 1 : 2)) % 3;
            const std::size_t k = (i + (axis == 1 ? 2 : 1)) % 3;
            edge[i].high = two_sum(given.number(j, axis), given.number(k, axis) * -1.0, edge[i].low);
            edge[i].size = magnitude(edge[i].high);
        }
        take(given, edge, Doubles{});
    }
};

// Three numbers as integers, in a power of two of which they are multiples.
struct IntegerLanes {
    Doubles unit, per_unit, largest;
    Doubles value[3];

    TEXGEN_INLINE IntegerLanes(const Doubles& a, const Doubles& b, const Doubles& c, double largest_unit) noexcept {
        const Doubles size[3] = {magnitude(a), magnitude(b), magnitude(c)};
        unit = minimum(minimum(last_bits(size[0]), minimum(last_bits(size[1]), last_bits(size[2]))),
                       Doubles{} + largest_unit);
        per_unit = reciprocals_of_powers(unit);
        value[0] = a * per_unit;
        value[1] = b * per_unit;
        value[2] = c * per_unit;
        largest = maximum(size[0], maximum(size[1], size[2])) * per_unit;
    }
};

// Of the values of a function at the corners: integers times a grain are the function's terms.
struct ResidueValues {
    Residues value[3];
    Doubles grain;

    TEXGEN_INLINE Residues times(const Residues (&side)[3]) const noexcept {
        return value[0] * side[0] + (value[1] * side[1] + value[2] * side[2]);
    }
};

// The functions of a triangle in each lane at a fragment as integers modulo 2^64, as PlaneResidues in triangle/close_planes.hpp has
// them.
struct ResidueLanes {
    const VertexLanes& given;
    Residues side[3];    // with the weights
    LongWords is_known;  // no number is too large, and the area is not next to 0

    TEXGEN_INLINE ResidueLanes(const VertexLanes& vertices, const Doubles& at_x, const Doubles& at_y) noexcept
        : given(vertices) {
        const auto number = [&](std::size_t i, std::size_t k) { return given.number(i, k); };
        const IntegerLanes x(number(0, 0), number(1, 0), number(2, 0), 0.5);
        const IntegerLanes y(number(0, 1), number(1, 1), number(2, 1), 0.5);
        const Doubles w[3] = {number(0, 2), number(1, 2), number(2, 2)};
        const IntegerLanes weight(with_sign_of(w[1] * w[2], given.area), with_sign_of(w[2] * w[0], given.area),
                                  with_sign_of(w[0] * w[1], given.area), 0x1p500);
        const Doubles largest =
            maximum(maximum(x.largest, maximum(y.largest, weight.largest)), maximum(x.per_unit, y.per_unit));
        take_known(given.has_area, largest);
        one_x_ = known(x.per_unit);
        one_y_ = known(y.per_unit);
        unit_ = x.unit * y.unit * weight.unit;
        // Integers, of which a fragment far away has a product that is none of 63 bits.
        const Residues first_x = to_residues(at_x * 2.0) * known(x.per_unit * 0.5);
        const Residues first_y = to_residues(at_y * 2.0) * known(y.per_unit * 0.5);
        TEXGEN_UNROLL
        for (std::size_t i = 0; i < 3; ++i) {
            scale_[i] = known(weight.value[i]);
            to_x_[i] = known(x.value[i]) - first_x;
            to_y_[i] = known(y.value[i]) - first_y;
        }
        TEXGEN_UNROLL
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t j = (i + 1) % 3;
            const std::size_t k = (i + 2) % 3;
            side[i] = scale_[i] * (to_x_[j] * to_y_[k] - to_y_[j] * to_x_[k]);
        }
    }

    // By how much the sides' functions grow along a row and down.
    TEXGEN_INLINE void steps(Residues (&dx)[3], Residues (&dy)[3]) const noexcept {
        TEXGEN_UNROLL
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t j = (i + 1) % 3;
            const std::size_t k = (i + 2) % 3;
            dx[i] = scale_[i] * ((to_y_[j] - to_y_[k]) * one_x_);
            dy[i] = scale_[i] * ((to_x_[k] - to_x_[j]) * one_y_);
        }
    }

    // Of coordinate k, 0 to 3 for s, t, r, q.
    TEXGEN_INLINE ResidueValues values(std::size_t k) noexcept {
        const IntegerLanes f(given.number(0, 3 + k), given.number(1, 3 + k), given.number(2, 3 + k), 0x1p500);
        take_known(is_known, f.largest);
        return {{known(f.value[0]), known(f.value[1]), known(f.value[2])}, unit_ * f.unit};
    }

private:
    TEXGEN_INLINE void take_known(const LongWords& before, const Doubles& largest) noexcept {
        is_known = before & greater(Doubles{} + 0x1p140, largest);
        are_large_ = any(greater(largest, 0x1p62));
    }
    // Modulo 2^64, of at most 48 bits: so large numbers are multiples of what their sums here are rounded to.
    TEXGEN_INLINE Residues known(const Doubles& integer) const noexcept {
        Doubles rest = where(is_known, integer);
        if (are_large_) {
            rest = rest - ((rest * 0x1p-64 + 0x1.8p52) - 0x1.8p52) * 0x1p64;
            rest = rest - where(~greater(Doubles{} + 0x1p63, rest), Doubles{} + 0x1p64);
        }
        return to_residues(rest);
    }

    Residues scale_[3], to_x_[3], to_y_[3], one_x_, one_y_;
    Doubles unit_;
    bool are_large_;  // some numbers are
};

// What is known of fragments of a triangle each, q last: without residues grains are 0.
template <std::size_t Numerators>
struct CloseFragmentsAt {
    CloseValues value[Numerators + 1];
    Residues residue[Numerators + 1]{};
    Doubles of_grain[Numerators + 1]{};

    TEXGEN_INLINE const CloseValues& values(std::size_t n) const noexcept { return value[n]; }
    TEXGEN_INLINE const Residues& residues(std::size_t n) const noexcept { return residue[n]; }
    TEXGEN_INLINE const Doubles& grain(std::size_t n) const noexcept { return of_grain[n]; }

    TEXGEN_APART void add_residues(const VertexLanes& vertices, const Doubles& x, const Doubles& y) noexcept {
        ResidueLanes lanes_of(vertices, x, y);
        for (std::size_t n = 0; n <= Numerators; ++n) {
            const ResidueValues of = lanes_of.values(n < Numerators ? n : 3);
            residue[n] = of.times(lanes_of.side);
            of_grain[n] = where(lanes_of.is_known, of.grain);
        }
    }
};

// The lanes in doubt of a vector of fragments at (x, y), again: others are anything. Returns those that stay so.
template <std::size_t Numerators>
TEXGEN_APART Words divide_lanes_closely(const float* const (&triangle)[lanes], const Doubles& x, const Doubles& y,
                                        const Words& in_doubt, Floats (&quotient)[Numerators],
                                        LongWords& front) noexcept {
    const VertexLanes vertices(triangle);
    const CloseLanes close(vertices, x, y);
    CloseFragmentsAt<Numerators> at;
    for (std::size_t n = 0; n <= Numerators; ++n) at.value[n] = close.function(vertices, n < Numerators ? n : 3);
    at.value[Numerators].error = at.value[Numerators].error + vertices.error_of_q;
    CloseDivisor q;
    q.take(at.value[Numerators]);
    front = q.front;
    CloseFragments<Numerators> fragments;
    Words left = in_doubt;
    for (const bool is_last : {false, true}) {
        if (is_last) at.add_residues(vertices, x, y);
        fragments.divide(at, q, Numerators, 0.0, true);
        left = in_doubt & narrow(fragments.doubtful);
        if (!any(left)) break;
    }
    for (std::size_t k = 0; k < Numerators; ++k) quotient[k] = fragments.quotient[k];
    return left;
}

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
