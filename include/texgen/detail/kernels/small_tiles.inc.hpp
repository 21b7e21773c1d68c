// Small tiles, see SmallTile: one certificate from their corners, and the quotients. Included by kernels.inc.hpp.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

// A linear function over the tile: at its first fragment, its steps to the last column and row, and a bound on its error, see
// TrianglePlanes::ramp() and error(). Rows that are reached by sums add 6 u to its 20 u of the magnitude, for which gamma has room.
template <class Number>
struct SmallFunction {
    Number base, right, bottom, error;

    TEXGEN_INLINE SmallFunction(const PlaneOf<Number>& plane, const SmallTile& tile) noexcept
        : base(plane.value.base + (plane.value.dx * tile.x + plane.value.dy * tile.y)),
          right(plane.value.dx * (SmallTile::width - 1.0)),
          bottom(plane.value.dy * tile.bottom),
          error((plane.magnitude.base + plane.magnitude.dx * tile.reach_x + plane.magnitude.dy * tile.reach_y) *
                gamma(20)) {}
};

// At the corner where a function is least.
template <class Number>
TEXGEN_INLINE Number least_of(const Number& base, const Number& right, const Number& bottom) noexcept {
    const Number of_row = smaller(base, base + right);
    return smaller(of_row, of_row + bottom);
}

// Whether all is lit, and far enough from q = 0 and from 0 that one bound serves all quotients. The sides are those of coverage_of()
// with twice its margins, so that this is never said of a tile of which that does not say it.
// Exact: F errs by less than 2^-41.5 of itself and q by 2^-44, and four roundings follow: within small_ulps; F is above 2^-124 q,
// so the floats are normal.
// In float, with u = 2^-24 and b the steps to the last row, of which y is at most half: F is rounded with its column, its step,
// the product with y, and the sum, by u (2 F + 1.5 b), as is q, and the reciprocal and the product round by 2 u. Of a quotient that
// is at most `max` this is 6 u max + 1.5 u (b_F + max b_q) / q, and what floats below 2^-126 lose is less than 2^-100.
inline constexpr int small_ulps = 0xfff;
TEXGEN_INLINE bool is_certain(const SmallTile& tile, const SmallFunction<Double2>& f,
                              const SmallFunction<double>& q) noexcept {
    const double least_q = least_of(q.base, q.right, q.bottom);
    const double largest_q = -least_of(-q.base, -q.right, -q.bottom);
    const Double2 min = tile.min, max = tile.max;
    const Double2 above = least_of<Double2>(f.base - min * q.base, f.right - min * q.right, f.bottom - min * q.bottom);
    const Double2 below = least_of<Double2>(max * q.base - f.base, max * q.right - f.right, max * q.bottom - f.bottom);
    const Double2 error = f.error + max * q.error;
    const Double2 margin = error * 2.0 + (max * 0x1p-21 + (0x1.1p-124 + 4.1 * tile.tolerance)) * largest_q;
    if (!(all_less(margin, above, margin, below) && least_q > larger(0x1p44 * q.error, 0x1p-100) && largest_q < 0x1p60))
        return false;
    if (tile.tolerance == 0.0) return all_less((f.error + min * q.error) * 0x1.8p41, above);
    const double allowed = (tile.tolerance - 0x1p-100) * (least_q - q.error);
    const Double2 rounded = larger(f.bottom, -f.bottom) + max * (4.02 * least_q + std::fabs(q.bottom));
    return all_less(error * 1.01 + rounded * (1.52 * unit_roundoff_float), double2_of(allowed, allowed)) &&
           least_q > larger(0x1p-10 * largest_q, 0x1p-21) && tile.tolerance < 0x1p40;
}

// Two rows share a division of doubles, and integers are asked whether a value is in doubt.
TEXGEN_INLINE bool divide_small(const SmallTile& tile, const Ramp (&f)[2], const Ramp& of_q) noexcept {
    constexpr int width = SmallTile::width;
    const int count = width * tile.height;
    float* const out[2] = {tile.out[0], tile.out[1]};
    WideWords least = WideWords{} + 1;
    for (int begin = 0; begin < width; begin += lanes) {
        const Doubles x = indices<Doubles>() + static_cast<double>(begin);
        const auto first_of = [&](const Ramp& ramp) { return x * ramp.dx + ramp.base; };
        Doubles next_q = first_of(of_q), next[2] = {first_of(f[0]), first_of(f[1])};
        for (int n = begin; n < count; n += 2 * width) {
            const Doubles q[2] = {next_q, next_q + of_q.dy};
            const Doubles of_both = 1.0 / (q[0] * q[1]);
            next_q = q[1] + of_q.dy;
            Doubles quotient[2][2];
            TEXGEN_UNROLL
            for (std::size_t k = 0; k < 2; ++k) {
                const Doubles second = next[k] + f[k].dy;
                quotient[0][k] = next[k] * q[1] * of_both;
                quotient[1][k] = second * q[0] * of_both;
                next[k] = second + f[k].dy;
            }
            TEXGEN_UNROLL
            for (std::size_t i = 0; i < 2; ++i) {
                const int row = static_cast<int>(i) * width;
                TEXGEN_UNROLL
                for (std::size_t k = 0; k < 2; ++k) store(out[k] + (n + row), to_floats(quotient[i][k]));
                least = minimum(least, distances_from_middles(quotient[i][0], quotient[i][1], small_ulps));
            }
        }
    }
    return !any_zero(least);
}

// A vector has whole rows, or a part of one. Rows are counted from the middle.
TEXGEN_INLINE void divide_small_in_float(const SmallTile& tile, const Ramp (&f)[2], const Ramp& of_q) noexcept {
    constexpr int width = SmallTile::width, columns = wide_lanes < width ? wide_lanes : width;
    const int count = width * tile.height;
    float* const out[2] = {tile.out[0], tile.out[1]};
    const WideWords index = indices<WideWords>();
    const WideFloats row = to_numbers(halved(halved(halved(index))));
    const double middle = 0.5 * tile.bottom;
    for (int begin = 0; begin < width; begin += columns) {
        const WideFloats x = to_numbers(index) - row * static_cast<float>(width) + static_cast<float>(begin);
        const auto first_of = [&](const Ramp& ramp) {
            const double base = ramp.base + middle * ramp.dy;
            return in_double([&](const Doubles& column) { return column * ramp.dx + base; }, x);
        };
        const WideFloats first_q = first_of(of_q), first[2] = {first_of(f[0]), first_of(f[1])};
        const float q_dy = static_cast<float>(of_q.dy);
        const float dy[2] = {static_cast<float>(f[0].dy), static_cast<float>(f[1].dy)};
        WideFloats y = row - static_cast<float>(middle);
        for (int n = begin; n < count; n += wide_lanes / columns * width) {
            const WideFloats reciprocal = 1.0f / (y * q_dy + first_q);
            TEXGEN_UNROLL
            for (std::size_t k = 0; k < 2; ++k) store(out[k] + n, (y * dy[k] + first[k]) * reciprocal);
            y = y + static_cast<float>(wide_lanes / columns);
        }
    }
}

template <class CompiledWhereCalled = void>
bool fill_small_tile(const SmallTile& tile) noexcept {
    const SmallFunction<Double2> f(*tile.st, tile);
    const SmallFunction<double> q(*tile.q, tile);
    if (!is_certain(tile, f, q)) return false;
    const RampOf<Double2>& st = tile.st->value;
    const Ramp numerator[2] = {{f.base[0], st.dx[0], st.dy[0]}, {f.base[1], st.dx[1], st.dy[1]}};
    const Ramp of_q{q.base, tile.q->value.dx, tile.q->value.dy};
    if (tile.tolerance == 0.0) return divide_small(tile, numerator, of_q);
    divide_small_in_float(tile, numerator, of_q);
    return true;
}

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
