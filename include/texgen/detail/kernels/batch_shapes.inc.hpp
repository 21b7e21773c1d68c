// How the kernels of a batch walk a tile. Included by batch.inc.hpp.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

// Whether a positive number divides a power of two: it is one, and no larger.
TEXGEN_INLINE bool divides(int a, int power_of_two) noexcept { return (a & (a - 1)) == 0 && a <= power_of_two; }

// The rectangle of a tile as its kernels walk it: a single row as a column. Most tiles have that of the one before.
struct ShapeOfTile {
    int width = 0;
    bool is_turned = false;
    std::size_t count = 0;
    double per_width = 1.0, last_row = 0.0;
    bool is_whole = false;          // its rows consist of whole vectors, or its vectors of whole rows
    bool has_wide_columns = false;  // its wide vectors consist of whole rows
    // The columns and rows of the first vector, and how many rows further down the next one is; the same in float, from
    // the middle of the tile.
    Doubles x{}, y{};
    double rows = 1.0;
    // Of as many fragments more, for a vector that begins later. GCC 12 fails at -O0 where they have no values.
    float wide_x[2 * wide_lanes] = {}, wide_y[2 * wide_lanes] = {};
    float wide_rows = 1.0f;

    TEXGEN_INLINE bool is_of(int tile_width, int tile_height) const noexcept {
        return given_[0] == tile_width && given_[1] == tile_height;
    }
    TEXGEN_APART void take(int tile_width, int tile_height) noexcept {
        given_[0] = tile_width;
        given_[1] = tile_height;
        is_turned = tile_height == 1;
        width = is_turned ? 1 : tile_width;
        count = static_cast<std::size_t>(tile_width) * static_cast<std::size_t>(tile_height);
        per_width = 1.0 / width;
        last_row = (is_turned ? tile_width : tile_height) - 1;
        const bool is_narrow = divides(width, lanes);
        is_whole = is_narrow ? count % at_once == 0 : width >= lanes;
        has_wide_columns = divides(width, wide_lanes);
        x = indices<Doubles>();
        y = Doubles{};
        rows = 1.0;
        if (is_narrow) {
            const FragmentWalk<Doubles, double> walk(width, per_width, 0.0);
            x = walk.x;
            y = walk.y;
            rows = walk.rows_per_vector;
        }
        if (!has_wide_columns) return;
        const FragmentWalk<WideFloats, float> wide(static_cast<float>(width), static_cast<float>(per_width), 0.0);
        wide_rows = wide.rows_per_vector;
        const WideFloats first_x = wide.x - 0.5f * static_cast<float>(width - 1);
        const WideFloats first_y = wide.y - static_cast<float>(0.5 * last_row);
        store(wide_x, first_x);
        store(wide_x + wide_lanes, first_x);
        store(wide_y, first_y);
        store(wide_y + wide_lanes, first_y + wide_rows);
    }

private:
    int given_[2] = {0, 0};
};

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
