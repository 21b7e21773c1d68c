// Small tiles that one certificate serves, see SmallTile. Included by kernels.inc.hpp.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

// The row of each lane, over the number of rows, where a vector holds four rows of two columns, or two rows of four.
inline constexpr double joined_rows[2][8] = {{0.0, 0.0, 0.25, 0.25, 0.5, 0.5, 0.75, 0.75},
                                             {0.0, 0.0, 0.0, 0.0, 0.5, 0.5, 0.5, 0.5}};

// Divides in double, two rows at once, of an odd number the last two again; returns whether integers find no value in
// doubt. A short single row is both rows. A long one is cut into rows as wide as a vector, of which the last may begin
// in the one before. A vector of eight holds several rows of two or four columns, and y counts such vectors. What a
// vector writes beyond its row is overwritten by those that follow.
TEXGEN_INLINE bool divide_small_tile(const SmallTile& tile) noexcept {
    const auto& [f_base, f_dx, f_dy] = tile.numerator;
    const Ramp& of_q = tile.q;
    int width = tile.width, stride = width;
    const int count = width * tile.height;
    double q_dy = of_q.dy, dy[2] = {f_dy[0], f_dy[1]};
    if (tile.height == 1) {
        const bool is_short = width < 2 * lanes;
        stride = is_short ? 0 : lanes;
        q_dy = stride * of_q.dx;
        for (std::size_t k = 0; k < 2; ++k) dy[k] = stride * f_dx[k];
        if (!is_short) width = lanes;
    }
    Doubles column = indices<Doubles>(), first_y{};
    if (lanes > 4 && width % 2 == 0 && width <= 4 && count >= 2 * lanes) {
        const double rows = width == 2 ? 4.0 : 2.0;
        first_y = load<Doubles>(joined_rows[width == 4]);
        column = column - first_y * 8.0;
        q_dy *= rows;
        for (double& of_row : dy) of_row *= rows;
        width = stride = lanes;
    }
    // Rows that are shorter than a vector have no room for the last one.
    float buffer[2][SmallTile::most_in_short_rows + lanes];
    const bool has_room = width >= lanes;
    float* const out[2] = {has_room ? tile.out[0] : buffer[0], has_room ? tile.out[1] : buffer[1]};
    Distances distance = far_from_middles();
    Doubles x = column;
    for (int begin = 0;;) {
        const Doubles first_q = x * of_q.dx + of_q.base;
        const Doubles first[2] = {x * f_dx[0] + f_base[0], x * f_dx[1] + f_base[1]};
        const int last = begin + count - width - stride;
        Doubles y = first_y;
        for (int n = begin;;) {
            const Doubles q = y * q_dy + first_q, second_q = q + q_dy;
            const SharedDivision division(q, second_q);
            Doubles quotient[2][2];
            TEXGEN_FOR (std::size_t k = 0; k < 2; ++k) {
                const Doubles value = y * dy[k] + first[k];
                quotient[0][k] = value * division.reciprocal[0];
                quotient[1][k] = (value + dy[k]) * division.reciprocal[1];
            }
            TEXGEN_FOR (int i = 0; i < 2; ++i) {
                TEXGEN_FOR (std::size_t k = 0; k < 2; ++k) store(out[k] + (n + i * stride), to_floats(quotient[i][k]));
                distance = nearer(distance, quotient[i][0], quotient[i][1], SmallTile::ulps);
            }
            if (n == last) break;
            n += 2 * width;
            y = y + 2.0;
            if (n > last) {
                n = last;
                y = first_y + static_cast<double>(n - begin) / width;
            }
        }
        if (begin + lanes >= width) break;
        begin = begin + 2 * lanes <= width ? begin + lanes : width - lanes;
        x = column + static_cast<double>(begin);
    }
    if (!has_room)
        for (std::size_t k = 0; k < 2; ++k)
            std::memcpy(tile.out[k], buffer[k], static_cast<std::size_t>(count) * sizeof(float));
    return !any_zero(distance);
}

// Divides in float a tile of eight columns, of which a vector holds whole rows, or a part of one; or of sixteen and
// more, where the last vector of a row may begin in the one before. Rows are counted from the middle. It is quicker
// with a width that is a constant.
TEXGEN_INLINE void divide_small_in_float(const SmallTile& tile, int width, int columns) noexcept {
    const auto& [f_base, f_dx, f_dy] = tile.numerator;
    const Ramp of_q{tile.q.base, tile.q.dx, read_alone(tile.q.dy)};
    const int count = width * tile.height, rows = wide_lanes / columns, last = width - columns;
    float* const out[2] = {tile.out[0], tile.out[1]};
    const WideWords index = indices<WideWords>();
    const WideFloats row = rows == 1 ? WideFloats{} : to_numbers(halved(halved(halved(index))));
    const double middle = 0.5 * (tile.height - 1.0);
    for (int begin = 0;;) {
        const WideFloats x = to_numbers(index) - row * static_cast<float>(width) + static_cast<float>(begin);
        const auto first_of = [&](const Ramp& ramp) {
            const double base = ramp.base + middle * ramp.dy;
            return in_double([&](const Doubles& column) { return column * ramp.dx + base; }, x);
        };
        const WideFloats first_q = first_of(of_q);
        const WideFloats first[2] = {first_of({f_base[0], f_dx[0], f_dy[0]}), first_of({f_base[1], f_dx[1], f_dy[1]})};
        const float q_dy = static_cast<float>(of_q.dy);
        const float dy[2] = {static_cast<float>(f_dy[0]), static_cast<float>(f_dy[1])};
        WideFloats y = row - static_cast<float>(middle);
        for (int n = begin; n < count; n += rows * width) {
            const WideFloats reciprocal = 1.0f / (y * q_dy + first_q);
            TEXGEN_FOR (std::size_t k = 0; k < 2; ++k) store(out[k] + n, (y * dy[k] + first[k]) * reciprocal);
            y = y + static_cast<float>(rows);
        }
        if (begin == last) break;
        begin = begin + columns < last ? begin + columns : last;
    }
}

// Whether no value is in doubt.
template <class CompiledWhereCalled = void>
bool fill_small_tile(const SmallTile& tile) noexcept {
    if (!tile.is_in_float) {
        if (!divide_small_tile(tile) && !tile.is_certain) return false;
    } else if (tile.width == 8) {
        divide_small_in_float(tile, 8, wide_lanes < 8 ? wide_lanes : 8);
    } else {
        divide_small_in_float(tile, tile.width, wide_lanes);
    }
    if (tile.lit != nullptr)
        light_apart(tile.min, tile.max, tile.out[0], tile.out[1], tile.lit, tile.width * tile.height);
    return true;
}

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
