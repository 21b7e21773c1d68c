// The inner loops of a batch: a block of triangles made ready, and their functions in lanes. Included by batch.inc.hpp.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

TEXGEN_INLINE Doubles load_lanes(const double* from) noexcept { return load<Doubles>(from); }
TEXGEN_INLINE Doubles load_lanes(const float* from) noexcept { return to_doubles(load<Floats>(from)); }
TEXGEN_INLINE Residues load_lanes(const std::uint64_t* from) noexcept { return load<Residues>(from); }

// Loads the first `count` numbers at from(j) to lane j, in whole vectors. The last come first: a division needs q.
template <class Vector, std::size_t Size, class From>
TEXGEN_INLINE void load_columns(Vector (&columns)[Size], std::size_t count, const From& from) noexcept {
    TEXGEN_FOR (std::size_t end = Size; end > 0; end -= at_once) {
        const std::size_t first = end - at_once;
        if (first >= count) continue;
        Vector row[lanes];
        TEXGEN_FOR (std::size_t j = 0; j < at_once; ++j) row[j] = load_lanes(from(j) + first);
        transpose(row);
        TEXGEN_FOR (std::size_t j = 0; j < at_once; ++j) columns[first + j] = row[j];
    }
}

// Stores lane j of all columns at to(j).
template <class Vector, std::size_t Size, class To>
TEXGEN_INLINE void store_columns(const Vector (&columns)[Size], const To& to) noexcept {
    TEXGEN_FOR (std::size_t first = 0; first < Size; first += at_once) {
        Vector row[lanes];
        TEXGEN_FOR (std::size_t j = 0; j < at_once; ++j) row[j] = columns[first + j];
        transpose(row);
        TEXGEN_FOR (std::size_t j = 0; j < at_once; ++j) store(to(j) + first, row[j]);
    }
}

// The offsets of a triangle's vertices from its first float, the one of the largest w first, as TrianglePlanes has
// them. The bits of positive w have their order; others are refused in any order. A branch would be mispredicted.
TEXGEN_INLINE const std::size_t* about_farthest(const float* triangle) noexcept {
    static constexpr std::size_t of_turned[5] = {0, BatchVertex::size, 2 * BatchVertex::size, 0, BatchVertex::size};
    const auto w = [&](std::size_t i) { return bit_cast<int>(triangle[i * BatchVertex::size + 2]); };
    const auto is_b = static_cast<unsigned>(w(1) > w(0)) & static_cast<unsigned>(w(2) <= w(1));
    const auto is_c = static_cast<unsigned>(w(2) > w(0)) & ~is_b;
    return of_turned + (is_b + 2 * is_c);
}

// Loads the triangle of each lane: its vertices, the one of the largest w first.
TEXGEN_INLINE void load_about_farthest(const float* const (&triangle)[lanes], Doubles (&vertex)[3][8]) noexcept {
    const std::size_t* of_turned[lanes];
    TEXGEN_FOR (std::size_t j = 0; j < at_once; ++j) of_turned[j] = about_farthest(triangle[j]);
    TEXGEN_FOR (std::size_t i = 0; i < 3; ++i)
        load_columns(vertex[i], 8, [&](std::size_t j) { return triangle[j] + of_turned[j][i]; });
}

// As TrianglePlanes, with the same operations in the same order, whose errors are bounded there. Returns the lanes
// where the sign of the area is in doubt, or a number is not finite, as in lanes without a triangle; q is -1 there.
TEXGEN_INLINE LongWords set_up_lanes(const float* triangles, BatchPlanes* planes) noexcept {
    const float* of_lane[lanes];
    TEXGEN_FOR (std::size_t j = 0; j < at_once; ++j) of_lane[j] = triangles + 3 * BatchVertex::size * j;
    Doubles vertex[3][8];
    load_about_farthest(of_lane, vertex);
    const auto& [a, b, c] = vertex;
    const Doubles b_x = b[0] - a[0], b_y = b[1] - a[1];
    const Doubles c_x = c[0] - a[0], c_y = c[1] - a[1];
    const Doubles left = b_x * c_y, right = b_y * c_x;
    const Doubles area = left - right;
    const Doubles area_terms = magnitude(left) + magnitude(right);
    const Doubles w_bc = b[2] * c[2], w_ac = a[2] * c[2], w_ab = a[2] * b[2];
    const Doubles largest = area_terms * maximum(maximum(w_bc, w_ac), w_ab);
    const Doubles factor = with_sign_of(reciprocals_of_powers(power_of_two_below(largest)), area);
    const Doubles weight_a = w_bc * factor, weight_b = w_ac * factor, weight_c = w_ab * factor;

    const Doubles size_b_x = magnitude(b_x), size_b_y = magnitude(b_y);
    const Doubles size_c_x = magnitude(c_x), size_c_y = magnitude(c_y);
    const Doubles reach_x = maximum(size_b_x, size_c_x) + BatchPlanes::margin;
    const Doubles reach_y = maximum(size_b_y, size_c_y) + BatchPlanes::margin;
    const Doubles base_terms = (size_b_x * size_c_y + size_b_y * size_c_x) * batch_plane_error;
    const Doubles b_dx_terms = size_c_y * reach_x * batch_plane_error;
    const Doubles c_dx_terms = size_b_y * reach_x * batch_plane_error;
    const Doubles b_dy_terms = size_c_x * reach_y * batch_plane_error;
    const Doubles c_dy_terms = size_b_x * reach_y * batch_plane_error;

    Doubles value[BatchPlanes::count]{};
    Doubles all_slopes{};
    TEXGEN_FOR (std::size_t k = 0; k < 4; ++k) {
        Doubles* const function = &value[BatchPlanes::of_coordinate[k]];
        const Doubles at_a = a[BatchVertex::strq + k] * weight_a;
        const Doubles at_b = b[BatchVertex::strq + k] * weight_b;
        const Doubles at_c = c[BatchVertex::strq + k] * weight_c;
        const Doubles b_minus_a = at_b - at_a, c_minus_a = at_c - at_a;
        function[0] = at_a * area;
        function[1] = b_minus_a * c_y - c_minus_a * b_y;
        function[2] = c_minus_a * b_x - b_minus_a * c_x;
        const Doubles size_a = magnitude(at_a);
        const Doubles b_and_a = magnitude(at_b) + size_a, c_and_a = magnitude(at_c) + size_a;
        function[3] = maximum(size_a * base_terms, maximum(b_and_a * b_dx_terms + c_and_a * c_dx_terms,
                                                           b_and_a * b_dy_terms + c_and_a * c_dy_terms));
        all_slopes = all_slopes + function[1];
    }
    // A weight, s, t, r or q that is not finite makes that sum infinite or a NaN; a window that is not, the area.
    const LongWords is_known = greater(magnitude(area), area_terms * gamma(4)) & greater(a[2], 0.0) &
                               greater(b[2], 0.0) & greater(c[2], 0.0) &
                               at_most(magnitude(all_slopes), Doubles{} + 0x1p1000);
    Doubles* const q = &value[BatchPlanes::q];
    q[0] = select(is_known, q[0], Doubles{} - 1.0);
    for (std::size_t i = 1; i < 4; ++i) q[i] = where(is_known, q[i]);
    value[BatchPlanes::origin] = a[0];
    value[BatchPlanes::origin + 1] = a[1];
    value[BatchPlanes::per_reach] = 1.0 / reach_x;
    value[BatchPlanes::per_reach + 1] = 1.0 / reach_y;
    store_columns(value, [&](std::size_t j) { return planes[j].value; });
    return ~is_known;
}

template <class CompiledWhereCalled = void>
unsigned set_up_batch(const float* triangles, BatchPlanes* planes) noexcept {
    unsigned unknown = 0;
    for (std::size_t i = 0; i < batch_block; i += at_once)
        unknown |=
            static_cast<unsigned>(lane_bits(set_up_lanes(triangles + 3 * BatchVertex::size * i, planes + i)) << i);
    return unknown;
}

// The functions of a triangle in each lane; that of r only if with_r.
struct BatchLanes {
    Doubles value[BatchPlanes::count]{};

    TEXGEN_INLINE BatchLanes(const auto& of_lane, bool with_r) noexcept {
        load_columns(value, with_r ? BatchPlanes::count : BatchPlanes::r, of_lane);
    }

    TEXGEN_INLINE const Doubles& operator[](std::size_t k) const noexcept { return value[k]; }
};

// The columns and rows of a vector of fragments, which follow one another row by row. A half more than a fragment's
// number keeps its quotient by the width away from the integers.
template <class Vector, class Scalar>
struct FragmentWalk {
    Vector number, x, y;  // number: with the half
    Scalar width, per_width;
    Scalar rows_per_vector;  // where it has whole ones

    TEXGEN_INLINE FragmentWalk(Scalar row, Scalar per_row, double first) noexcept
        : number(indices<Vector>() + static_cast<Scalar>(first + 0.5)),
          width(row),
          per_width(per_row),
          rows_per_vector(static_cast<Scalar>(size) * per_row) {
        place();
    }

    TEXGEN_INLINE void advance() noexcept {
        number = number + static_cast<Scalar>(size);
        place();
    }

    // Adding `rounder` and subtracting it leaves the nearest integer.
    template <class Number>
    TEXGEN_INLINE static Number row_of(const Number& number, Scalar per_width) noexcept {
        constexpr auto rounder = static_cast<Scalar>(sizeof(Scalar) == sizeof(double) ? 0x1.8p52 : 0x1.8p23);
        return ((number * per_width - Scalar(0.5)) + rounder) - rounder;
    }

private:
    static constexpr int size = static_cast<int>(sizeof(Vector) / sizeof(Scalar));

    TEXGEN_INLINE void place() noexcept {
        y = row_of(number, per_width);
        x = (number - Scalar(0.5)) - y * width;
    }
};

// Where the values of fragments go: in whole vectors, each of which overwrites what the one before wrote too much.
struct FragmentOutputs : BatchOutputs {
    template <std::size_t Numerators>
    TEXGEN_INLINE void put(std::size_t n, const Floats (&value)[Numerators], const LongWords& in_front) const noexcept {
        TEXGEN_FOR (std::size_t k = 0; k < Numerators; ++k)
            if (out[k] != nullptr) store(out[k] + n, value[k]);
        if (lit != nullptr) store(lit + n, one_where(narrow(in_front) & are_inside(value)));
    }
    // Puts the lanes of the mask, and leaves the others as they are.
    template <std::size_t Numerators>
    TEXGEN_INLINE void put_where(const Words& mask, std::size_t n, const Floats (&value)[Numerators],
                                 const LongWords& in_front) const noexcept {
        const auto put_one = [&](float* to, const Floats& one) { store(to, select(mask, one, load<Floats>(to))); };
        for (std::size_t k = 0; k < Numerators; ++k)
            if (out[k] != nullptr) put_one(out[k] + n, value[k]);
        if (lit != nullptr) put_one(lit + n, one_where(narrow(in_front) & are_inside(value)));
    }
    template <std::size_t Numerators, class Vector>
    TEXGEN_INLINE auto are_inside(const Vector (&value)[Numerators]) const noexcept {
        auto result = in_region(*this, value);
        if constexpr (Numerators == 3)
            if (has_depth) result &= inside(value[2], r_min, r_max);
        return result;
    }
};

// Takes the place of the outputs where a vector would be written beyond their end.
template <std::size_t Size>
struct ScratchOutputs {
    float values[4][Size];

    TEXGEN_INLINE FragmentOutputs in_place_of(const FragmentOutputs& original) noexcept {
        FragmentOutputs result = original;
        for (std::size_t k = 0; k < 3; ++k) result.out[k] = original.out[k] == nullptr ? nullptr : values[k];
        result.lit = original.lit == nullptr ? nullptr : values[3];
        return result;
    }
    void copy_to(const FragmentOutputs& original, std::size_t n, std::size_t count) const noexcept {
        for (std::size_t k = 0; k < 4; ++k) {
            float* const to = k < 3 ? original.out[k] : original.lit;
            if (to != nullptr) std::memcpy(to + n, values[k], count * sizeof(float));
        }
    }
};

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
