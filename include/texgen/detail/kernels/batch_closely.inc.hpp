// What doubles leave in doubt of a batch's fragments, to twice their precision: the edge functions from the differences between
// the fragment and the vertices, as in triangle/close_planes.hpp, a triangle in each lane. Included by batch.inc.hpp. For rounding
// to nearest; only exact products are added to what their sum is compared with, so that contraction changes nothing.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

// x, y, w and from BatchVertex::strq on s, t, r, q of a vertex of the triangle in each lane.
struct VertexLanes {
    Floats value[8];

    TEXGEN_INLINE void load_from(const float* const (&triangle)[lanes], std::size_t i, bool is_one) noexcept {
        if (is_one) {
            TEXGEN_UNROLL
            for (std::size_t k = 0; k < 8; ++k) value[k] = triangle[0][i * BatchVertex::size + k] - Floats{};
            return;
        }
        TEXGEN_UNROLL
        for (std::size_t first = 0; first < 8; first += static_cast<std::size_t>(lanes)) {
            Floats column[lanes];
            TEXGEN_UNROLL
            for (std::size_t j = 0; j < static_cast<std::size_t>(lanes); ++j)
                column[j] = load<Floats>(triangle[j] + i * BatchVertex::size + first);
            transpose(column);
            TEXGEN_UNROLL
            for (std::size_t j = 0; j < static_cast<std::size_t>(lanes); ++j) value[first + j] = column[j];
        }
    }
};

// The leading 26 bits of a factor, and the rest: of two such products all but that of the rests are exact.
struct FactorInParts {
    Doubles high, low;

    TEXGEN_INLINE void set(const Doubles& factor) noexcept {
        high = leading_bits<26>(factor);
        low = factor - high;
    }
};

// A product of an edge function, in two doubles, with a float: within 2^-104 of itself.
struct EdgeLanes {
    Doubles high, low;

    TEXGEN_INLINE void multiply(const Doubles& factor) noexcept {
        const Doubles leading = leading_bits<27>(high);
        Doubles error;
        high = quick_two_sum(leading * factor, (high - leading) * factor, error);
        low = low * factor + error;
    }
};

// What all functions of the triangles share: F = sum G_i f_i, with G_i = E_i w_j w_k.
struct CloseLanes {
    Floats given[3][4];                       // s, t, r, q
    Doubles leading[3], trailing[3], low[3];  // of G_i; leading and trailing are 27 and 26 bits
    Doubles size[3];                          // of both products of E_i, times w_j w_k
    Doubles inexact;                          // 0 where all G_i are a double, exactly
    LongWords is_known;                       // that, within 2^-98 of its size

    TEXGEN_INLINE CloseLanes(const float* const (&triangle)[lanes], const Doubles& x, const Doubles& y,
                             bool is_one) noexcept {
        Doubles w[3];
        FactorInParts to_x[3], to_y[3];
        Doubles lost{}, below{};
        TEXGEN_UNROLL
        for (std::size_t i = 0; i < 3; ++i) {
            VertexLanes vertex;
            vertex.load_from(triangle, i, is_one);
            w[i] = to_doubles(vertex.value[2]);
            TEXGEN_UNROLL
            for (std::size_t k = 0; k < 4; ++k) given[i][k] = vertex.value[BatchVertex::strq + k];
            Doubles error[2];
            const Doubles d_x = two_sum(to_doubles(vertex.value[0]), x * -1.0, error[0]);
            const Doubles d_y = two_sum(to_doubles(vertex.value[1]), y * -1.0, error[1]);
            to_x[i].set(d_x);
            to_y[i].set(d_y);
            lost = lost + (magnitude(error[0]) + magnitude(error[1]));
            below = below + (magnitude(to_x[i].low) + magnitude(to_y[i].low));
        }
        const bool is_short = !any(greater(below, 0.0));
        EdgeLanes edge[3];
        inexact = below;
        TEXGEN_UNROLL
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t j = (i + 1) % 3;
            const std::size_t k = (i + 2) % 3;
            const Doubles left = to_x[j].high * to_y[k].high;
            const Doubles right = to_y[j].high * to_x[k].high;
            size[i] = magnitude(left) + magnitude(right);
            edge[i].high = two_sum(left, right * -1.0, edge[i].low);
            if (is_short) continue;
            Doubles error[4];
            const Doubles left_middle = two_sum(to_x[j].high * to_y[k].low, to_x[j].low * to_y[k].high, error[0]);
            const Doubles right_middle = two_sum(to_y[j].high * to_x[k].low, to_y[j].low * to_x[k].high, error[1]);
            const Doubles middle = two_sum(left_middle, right_middle * -1.0, error[2]);
            const Doubles sum = two_sum(edge[i].high, middle, error[3]);
            const Doubles last = to_x[j].low * to_y[k].low - to_y[j].low * to_x[k].low;
            const Doubles rest = ((edge[i].low + error[3]) + (error[2] + (error[0] - error[1]))) + last;
            edge[i].high = two_sum(sum, rest, edge[i].low);
        }
        const Doubles area = edge[0].high + edge[1].high + edge[2].high;
        is_known = at_most(lost, Doubles{}) & greater(magnitude(area), (size[0] + size[1] + size[2]) * 0x1p-49);
        TEXGEN_UNROLL
        for (std::size_t i = 0; i < 3; ++i) {
            const Doubles w_j = w[(i + 1) % 3];
            const Doubles w_k = w[(i + 2) % 3];
            inexact = inexact + magnitude(edge[i].low);
            edge[i].multiply(with_sign_of(w_j, area));
            inexact = inexact + magnitude(edge[i].low);
            edge[i].multiply(w_k);
            low[i] = edge[i].low;
            inexact = inexact + magnitude(low[i]);
            size[i] = size[i] * (w_j * w_k);
            leading[i] = leading_bits<27>(edge[i].high);
            trailing[i] = edge[i].high - leading[i];
        }
    }

    // The function of coordinate k, 0 to 3 for s, t, r, q.
    TEXGEN_INLINE Twofold function(std::size_t k) const noexcept {
        Doubles f[3];
        TEXGEN_UNROLL
        for (std::size_t i = 0; i < 3; ++i) f[i] = to_doubles(given[i][k]);
        Doubles error[5];
        Doubles sum = two_sum(leading[0] * f[0], leading[1] * f[1], error[0]);
        sum = two_sum(sum, leading[2] * f[2], error[1]);
        Doubles rest = two_sum(trailing[0] * f[0], trailing[1] * f[1], error[2]);
        rest = two_sum(rest, trailing[2] * f[2], error[3]);
        sum = two_sum(sum, rest, error[4]);
        const Doubles terms = magnitude(f[0]) * size[0] + (magnitude(f[1]) * size[1] + magnitude(f[2]) * size[2]);
        const Doubles is_inexact = (magnitude(error[0]) + magnitude(error[1])) +
                                   ((magnitude(error[2]) + magnitude(error[3])) + (magnitude(error[4]) + inexact));
        rest = ((error[0] + error[1]) + error[4]) +
               ((error[2] + error[3]) + (low[0] * f[0] + (low[1] * f[1] + low[2] * f[2])));
        Twofold result;
        result.high = two_sum(sum, rest, result.low);
        result.lost = where(greater(is_inexact, 0.0), terms * 0x1p-96);
        return result;
    }
};

// The last bit of each that is set; of 0 it is that of no other number.
TEXGEN_INLINE Doubles last_bits(const Doubles& a) noexcept {
    const Doubles size = magnitude(a);
    const Doubles last = select(are_nonzero(size - power_of_two_below(a)), size - magnitude(without_last_bit(a)), size);
    return where(are_nonzero(a), last) + where(~are_nonzero(a), Doubles{} + 0x1p500);
}

TEXGEN_INLINE Doubles least_of_three(const Doubles& a, const Doubles& b, const Doubles& c) noexcept {
    return minimum(a, minimum(b, c));
}
// Powers of two of which function k, 0 to 3 for s, t, r, q, of the triangle in each lane is a multiple at every fragment: as PlaneGrains
// has them.
template <class CompiledWhereCalled = void>
TEXGEN_APART Doubles grains_of(const float* const (&triangle)[lanes], bool is_one, std::size_t k) noexcept {
    VertexLanes vertex[3];
    TEXGEN_UNROLL
    for (std::size_t i = 0; i < 3; ++i) vertex[i].load_from(triangle, i, is_one);
    const auto last_bit = [&](std::size_t i, std::size_t place) {
        return last_bits(to_doubles(vertex[i].value[place]));
    };
    const auto of_all = [&](std::size_t place) {
        return least_of_three(last_bit(0, place), last_bit(1, place), last_bit(2, place));
    };
    const Doubles of_window = minimum(of_all(0), Doubles{} + 0.5) * minimum(of_all(1), Doubles{} + 0.5);
    const Doubles w[3] = {last_bit(0, 2), last_bit(1, 2), last_bit(2, 2)};
    return of_window * (least_of_three(w[0] * w[1], w[1] * w[2], w[2] * w[0]) * of_all(BatchVertex::strq + k));
}

// The lanes in doubt (what is not 0) of a vector of fragments at (x, y), again. Returns those that stay so.
template <std::size_t Numerators>
TEXGEN_APART Words divide_lanes_closely(const float* const (&triangle)[lanes], const Doubles& x, const Doubles& y,
                                        bool is_one, const Words& doubtful, Floats (&quotient)[Numerators],
                                        Words& in_front) noexcept {
    const Words in_doubt = ~equal(doubtful, 0);
    const CloseLanes close(triangle, x, y, is_one);
    const Twofold q = close.function(3);
    const LongWords front = greater(q.high, q.lost * 256.0);
    const Doubles reciprocal = where(front, 1.0 / q.high);
    const Doubles relative_error = reciprocal * q.lost + 0x1p-50;
    const Doubles leading = leading_bits<27>(q.high);
    const Doubles upper = leading * 0.5;
    const Doubles lower = (q.high - leading) * 0.5;
    Words doubt = narrow(~(close.is_known & (front | at_most(q.high, q.lost * -1.0))));
    TEXGEN_UNROLL
    for (std::size_t k = 0; k < Numerators; ++k) {
        const Twofold f = close.function(k);
        const Doubles u = f.high * reciprocal + 0.0;  // no -0
        const Doubles error = magnitude(u) * relative_error + reciprocal * f.lost;
        const Floats below = to_floats(u - error);
        const Floats above = to_floats(u + error);
        Floats value = below;
        const Words differ = bits(below) ^ bits(above);
        if (any(differ)) {
            // Of F - m Q, m being the middle of the two, leading parts cancel; the next are kept in two doubles.
            const Doubles middle = to_doubles(below) + to_doubles(above);  // twice it
            Doubles rest;
            const Doubles sum = two_sum(f.high - middle * upper, middle * lower * -1.0, rest);
            const Doubles remainder = sum + (rest + (f.low - middle * (q.low * 0.5)));
            const Doubles bound = magnitude(middle) * (q.lost * 0.5) + f.lost;
            const Doubles unit = power_of_two_below(middle);
            const LongWords is_open = greater(magnitude(remainder), bound);
            const LongWords is_tie = at_most(magnitude(remainder) + bound, Doubles{});
            const Words may_differ = in_doubt & ~equal(differ, 0);
            Words decided = decide_between(below, above, middle, unit, remainder, is_open, is_tie, value);
            if (any(may_differ & ~decided)) {
                // A multiple of its terms' grains that is certainly smaller than those is 0.
                const Doubles finer =
                    minimum(unit * 0x1p-25 * grains_of(triangle, is_one, 3), grains_of(triangle, is_one, k));
                decided = decide_between(below, above, middle, unit, remainder, is_open,
                                         is_tie | greater(finer, magnitude(remainder) + bound), value);
            }
            doubt |= may_differ & ~decided;
        }
        quotient[k] = select(in_doubt, value, quotient[k]);
    }
    in_front = (in_front & ~in_doubt) | (narrow(front) & in_doubt);
    return doubt & in_doubt;
}

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
