// A batch's fragments that doubles leave in doubt, to twice their precision: the edge functions from the differences
// between the fragment and the vertices, as in triangle/close_planes.hpp, a triangle in each lane. Included by
// batch.inc.hpp. For rounding to nearest; products are exact wherever the loss of their sum is computed, so that
// contraction changes nothing.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

// A difference: the leading 26 bits of the double next to it, the bits behind them, and what that double lacks. A
// product of parts of two such differences is exact, but for that of the two low ones.
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

    // The cross product of two differences, within 2^-98 of the size. is_short: low parts are 0; is_lost: some lack a
    // part.
    TEXGEN_INLINE void set(const DifferenceLanes& to_x, const DifferenceLanes& to_y, const DifferenceLanes& from_x,
                           const DifferenceLanes& from_y, bool is_short, bool is_lost) noexcept {
        const Doubles left = to_x.high * from_y.high, right = to_y.high * from_x.high;
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

// The vertices of the triangle in each lane: x, y, w, s, t, r, q of each.
struct VertexLanes {
    Doubles vertex[3][8];
    Doubles area;        // doubled, within 2^-40 of itself
    LongWords has_area;  // its sign is known
    Doubles error_of_q;  // infinite where the sign is not known, which leaves everything in doubt

    VertexLanes() = default;
    TEXGEN_INLINE explicit VertexLanes(const float* const (&triangle)[lanes]) noexcept { take(triangle); }

    TEXGEN_APART void take(const float* const (&triangle)[lanes]) noexcept {
        load_about_farthest(triangle, vertex);
        find_area();
    }
    // The same triangle in all lanes.
    TEXGEN_APART void take(const float* triangle) noexcept {
        const std::size_t* const of_turned = about_farthest(triangle);
        TEXGEN_FOR (std::size_t i = 0; i < 3; ++i) {
            const float* const from = triangle + of_turned[i];
            TEXGEN_FOR (std::size_t k = 0; k < BatchVertex::size; ++k)
                vertex[i][k] = Doubles{} + detail::widened(from[k]);
        }
        find_area();
    }

    TEXGEN_INLINE const Doubles& number(std::size_t i, std::size_t k) const noexcept {
        return vertex[i][k < 3 ? k : BatchVertex::strq + (k - 3)];
    }

    TEXGEN_INLINE EdgeLanes area_closely() const noexcept {
        DifferenceLanes to_b[2], to_c[2];
        for (std::size_t k = 0; k < 2; ++k) {
            to_b[k].set(number(1, k), number(0, k));
            to_c[k].set(number(2, k), number(0, k));
        }
        EdgeLanes edge;
        edge.set(to_b[0], to_b[1], to_c[0], to_c[1], false, true);
        return edge;
    }

private:
    // The area of a sliver takes two doubles.
    TEXGEN_INLINE void find_area() noexcept {
        const Doubles left = (number(1, 0) - number(0, 0)) * (number(2, 1) - number(0, 1));
        const Doubles right = (number(1, 1) - number(0, 1)) * (number(2, 0) - number(0, 0));
        area = left - right;
        has_area = greater(magnitude(area), (magnitude(left) + magnitude(right)) * 0x1p-10);
        if (any(~has_area)) {
            const EdgeLanes edge = area_closely();
            area = edge.high;
            has_area = greater(magnitude(area), edge.size * 0x1p-98);
        }
        error_of_q = where(~has_area, Doubles{} + infinity);
    }
};

// What a triangle's functions F = sum G_i f_i over the corners share: G_i = E_i w_j w_k.
struct CloseTerms {
    Doubles leading[3], trailing[3], low[3];  // of G_i; leading and trailing are 27 and 26 bits
    Doubles size[3];                          // of what E_i is the difference of, times w_j w_k
    Doubles inexact;                          // 0 where all G_i are a double, exactly
    bool is_leading;                          // leading is all there is

    // Takes edge functions E_i; edge_inexact is not 0 in lanes where they were made from rounded differences.
    TEXGEN_INLINE void take(const VertexLanes& given, EdgeLanes (&edge)[3], const Doubles& edge_inexact) noexcept {
        inexact = edge_inexact;
        Doubles rest{};
        TEXGEN_FOR (std::size_t i = 0; i < 3; ++i) {
            const Doubles w_j = given.number((i + 1) % 3, 2), w_k = given.number((i + 2) % 3, 2);
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

    // The function of coordinate k, 0 to 3 for s, t, r, q.
    TEXGEN_INLINE CloseValues function(const VertexLanes& given, std::size_t k) const noexcept {
        Doubles f[3];
        TEXGEN_FOR (std::size_t i = 0; i < 3; ++i) f[i] = given.number(i, 3 + k);
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

// The terms at a fragment, all within 2^-98 of their size. Where it is farther from a corner than the corners are from
// one another, E_i is made from the difference between corners j and k in the place of that between k and the fragment:
// its value is the same, and its terms are smaller.
struct CloseLanes : CloseTerms {
    TEXGEN_APART CloseLanes(const VertexLanes& given, const Doubles& x, const Doubles& y) noexcept {
        // For E_i: from the fragment to corner j, and from the fragment, or from j, to corner k.
        DifferenceLanes to_x[3], to_y[3], from_x[3], from_y[3];
        Doubles lost{}, below{};
        TEXGEN_FOR (std::size_t i = 0; i < 3; ++i) {
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
            const LongWords is_far = greater(magnitude(to_x[0].high) + magnitude(to_y[0].high), spread);
            for (std::size_t i = 0; i < 3; ++i) {
                const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
                from_x[i].set(given.number(k, 0), select(is_far, given.number(j, 0), x));
                from_y[i].set(given.number(k, 1), select(is_far, given.number(j, 1), y));
                lost = lost + (magnitude(from_x[i].lost) + magnitude(from_y[i].lost));
            }
        }
        const bool is_short = !is_lost && !any(greater(below, 0.0));
        EdgeLanes edge[3];
        TEXGEN_FOR (std::size_t i = 0; i < 3; ++i) {
            const std::size_t j = (i + 1) % 3;
            edge[i].set(to_x[j], to_y[j], from_x[i], from_y[i], is_short, is_lost);
        }
        take(given, edge, below + lost);
    }
};

// By how much the functions grow along a row (axis 0) or a column (1), as ExactFragment::growth().
struct CloseSteps : CloseTerms {
    TEXGEN_APART CloseSteps(const VertexLanes& given, std::size_t axis) noexcept {
        EdgeLanes edge[3];
        TEXGEN_FOR (std::size_t i = 0; i < 3; ++i) {
            const std::size_t j = (i + (axis == 0 ? 1 : 2)) % 3, k = (i + (axis == 0 ? 2 : 1)) % 3;
            edge[i].high = two_sum(given.number(j, 1 - axis), given.number(k, 1 - axis) * -1.0, edge[i].low);
            edge[i].size = magnitude(edge[i].high);
        }
        take(given, edge, Doubles{});
    }
};

// Three numbers, and a power of two of which they are multiples.
struct IntegerLanes {
    Doubles number[3];
    Doubles unit, per_unit, largest;

    TEXGEN_INLINE IntegerLanes(const Doubles& a, const Doubles& b, const Doubles& c, const auto&... units) noexcept
        : number{a, b, c} {
        const Doubles size[3] = {magnitude(a), magnitude(b), magnitude(c)};
        unit = minimum(last_bits(size[0]), minimum(last_bits(size[1]), last_bits(size[2])));
        ((unit = minimum(unit, Doubles{} + units)), ...);
        per_unit = reciprocals_of_powers(unit);
        largest = maximum(size[0], maximum(size[1], size[2])) * per_unit;
    }
};

// The values of a function at the corners as integers; times the edge functions and the grain these are its terms.
struct ResidueValues {
    Residues value[3];
    Doubles grain;

    TEXGEN_INLINE Residues times(const Residues (&side)[3]) const noexcept {
        return value[0] * side[0] + (value[1] * side[1] + value[2] * side[2]);
    }
};

// The functions of a triangle in each lane at a fragment as integers modulo 2^64, as PlaneResidues in
// triangle/close_planes.hpp has them.
struct ResidueLanes {
    const VertexLanes& given;
    Residues side[3];    // with the weights
    LongWords is_known;  // where no number is too large, and the area's sign is known
    Residues one_x, one_y;
    Doubles per_x, per_y;  // 1 in the units of x and of y, not reduced

    TEXGEN_APART ResidueLanes(const VertexLanes& vertices, const Doubles& at_x, const Doubles& at_y) noexcept
        : given(vertices) {
        const auto number = [&](std::size_t i, std::size_t k) { return given.number(i, k); };
        const IntegerLanes x(number(0, 0), number(1, 0), number(2, 0), 0.5);
        const IntegerLanes y(number(0, 1), number(1, 1), number(2, 1), 0.5);
        const Doubles w[3] = {number(0, 2), number(1, 2), number(2, 2)};
        const IntegerLanes weight(with_sign_of(w[1] * w[2], given.area), with_sign_of(w[2] * w[0], given.area),
                                  with_sign_of(w[0] * w[1], given.area));
        const Doubles largest =
            maximum(maximum(x.largest, maximum(y.largest, weight.largest)), maximum(x.per_unit, y.per_unit));
        take_known(given.has_area, largest);
        per_x = x.per_unit;
        per_y = y.per_unit;
        const Doubles one = Doubles{} + 1.0;
        one_x = known(one, per_x);
        one_y = known(one, per_y);
        unit_ = x.unit * y.unit * weight.unit;
        // In halves, which are integers: those of a fragment far away, times the units, may need more than 63 bits.
        const Residues first_x = to_residues(at_x * 2.0) * known(one * 0.5, x.per_unit);
        const Residues first_y = to_residues(at_y * 2.0) * known(one * 0.5, y.per_unit);
        TEXGEN_FOR (std::size_t i = 0; i < 3; ++i) {
            scale_[i] = known(weight.number[i], weight.per_unit);
            to_x_[i] = known(x.number[i], x.per_unit) - first_x;
            to_y_[i] = known(y.number[i], y.per_unit) - first_y;
        }
        TEXGEN_FOR (std::size_t i = 0; i < 3; ++i) {
            const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
            side[i] = scale_[i] * (to_x_[j] * to_y_[k] - to_y_[j] * to_x_[k]);
        }
    }

    // By how much the edge functions grow along a row and down a column, without the common factors one_x and one_y.
    TEXGEN_INLINE void steps(Residues (&dx)[3], Residues (&dy)[3]) const noexcept {
        TEXGEN_FOR (std::size_t i = 0; i < 3; ++i) {
            const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
            dx[i] = scale_[i] * (to_y_[j] - to_y_[k]);
            dy[i] = scale_[i] * (to_x_[k] - to_x_[j]);
        }
    }
    // The doubled area, and its grain where all is known.
    TEXGEN_INLINE Residues area() const noexcept {
        return (to_x_[1] - to_x_[0]) * (to_y_[2] - to_y_[0]) - (to_y_[1] - to_y_[0]) * (to_x_[2] - to_x_[0]);
    }
    TEXGEN_INLINE Doubles area_grain() const noexcept { return where(is_known, reciprocals_of_powers(per_x * per_y)); }

    // The corners' values of coordinate k, 0 to 3 for s, t, r, q.
    TEXGEN_INLINE ResidueValues values(std::size_t k) noexcept {
        const IntegerLanes f(given.number(0, 3 + k), given.number(1, 3 + k), given.number(2, 3 + k));
        take_known(is_known, f.largest);
        return {{known(f.number[0], f.per_unit), known(f.number[1], f.per_unit), known(f.number[2], f.per_unit)},
                unit_ * f.unit};
    }

private:
    TEXGEN_INLINE void take_known(const LongWords& before, const Doubles& largest) noexcept {
        is_known = before & greater(Doubles{} + 0x1p140, largest);
        are_large_ = any(greater(largest, 0x1p62));
    }
    // Modulo 2^64. Numbers have at most 48 bits, so large ones are multiples of what the sums in to_residues_of_any()
    // are rounded to.
    TEXGEN_INLINE Residues known(const Doubles& number, const Doubles& per_unit) const noexcept {
        const Doubles integer = number * where(is_known, per_unit);
        return are_large_ ? to_residues_of_any(integer) : to_residues(integer);
    }

    Residues scale_[3], to_x_[3], to_y_[3];
    Doubles unit_;
    bool are_large_;  // some numbers are
};

// The functions of a triangle in each lane at a fragment, in double, with the difference between corners j and k in
// every E_i, as CloseLanes has it far away. With u = 2^-53 the differences are within u, an edge function within 4 u of
// the sizes of its terms, times its weight 6 u, the sum of three 9 u of theirs, and the sizes themselves 7 u.
struct NearLanes {
    Doubles term[3], size[3];

    TEXGEN_INLINE NearLanes(const VertexLanes& given, const Doubles& x, const Doubles& y) noexcept {
        TEXGEN_FOR (std::size_t i = 0; i < 3; ++i) {
            const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
            const Doubles left = (given.number(j, 0) - x) * (given.number(k, 1) - given.number(j, 1));
            const Doubles right = (given.number(j, 1) - y) * (given.number(k, 0) - given.number(j, 0));
            const Doubles weight = given.number(j, 2) * given.number(k, 2);
            term[i] = (left - right) * with_sign_of(weight, given.area);
            size[i] = (magnitude(left) + magnitude(right)) * weight;
        }
    }
    // The value of coordinate k, and 1.01 times what it may err by, as CloseDivisor takes it.
    TEXGEN_INLINE CloseValues function(const VertexLanes& given, std::size_t k) const noexcept {
        const Doubles* const f[3] = {&given.number(0, 3 + k), &given.number(1, 3 + k), &given.number(2, 3 + k)};
        return {term[0] * *f[0] + (term[1] * *f[1] + term[2] * *f[2]), Doubles{},
                (size[0] * magnitude(*f[0]) + (size[1] * magnitude(*f[1]) + size[2] * magnitude(*f[2]))) *
                    (1.02 * gamma(9))};
    }
};

// A value sharpened by its residue. Where the grain is coarse enough, only one integer with that residue is, times the
// grain, within `reach` of the leading part. Their difference is the rest; 2^-50 of it may be lost.
TEXGEN_INLINE CloseValues sharpened(const CloseValues& f, const Residues& residue, const Doubles& grain) noexcept {
    const Doubles reach = magnitude(f.high) * 0x1p-48 + f.error;
    const LongWords is_one = greater(grain * 0x1p60, reach);
    const Doubles integer = (where(is_one, f.high * reciprocals_of_powers(grain)) + 0x1.8p52) - 0x1.8p52;
    const Doubles rest = signed_numbers(residue - to_residues_of_any(integer)) * grain;
    Doubles low;
    const Doubles high = quick_two_sum(integer * grain, rest, low);
    return {select(is_one, high, f.high), select(is_one, low, f.low), select(is_one, reach * 0x1p-48, f.error)};
}

// In each lane the one that errs by less.
TEXGEN_INLINE CloseValues better(const CloseValues& a, const CloseValues& b) noexcept {
    const LongWords is_b = greater(a.error, b.error);
    return {select(is_b, b.high, a.high), select(is_b, b.low, a.low), minimum(a.error, b.error)};
}

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
