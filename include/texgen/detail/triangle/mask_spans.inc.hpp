// A mask without its coordinates: q = 0 and each side of the region bound a half plane, so that what is lit of a row of
// fragments is one span. Its ends are found by a division for all rows, and no fragment is divided. Included by
// interpolate.hpp.

namespace TEXGEN_DETAIL_BUILD {

// Fragments of a row, from `begin` to before `end`.
struct Span {
    int begin, end;
};

// q >= 0 and the sides of the region over a tile, with the margins of coverage_by_sides(): a linear function is above 0
// where it is computed to be above its margin, and not where it is below minus that. Under a tolerance neither s nor t
// has an output that the mask would have to go by: either answer will do within half of the tolerance from a side.
class HalfPlanes {
public:
    TEXGEN_APART HalfPlanes(const TriangleFunctions& triangle, const Corners& at, const Tile& tile) noexcept
        : tile_(tile) {
        const double q = largest_q_of(at);
        const double slack = 0.5 * triangle.tolerance * (at.least_q - at.q_error);
        add(at.q_ramp, at.q_error + 0x1p-46 * q, 0.0);
        const auto& [base, dx, dy] = at.numerator_ramp;
        for (std::size_t side = 0; side < 4; ++side) {
            const std::size_t k = side % 2;
            const auto coordinate = static_cast<glm::length_t>(k);
            const double sign = side < 2 ? 1.0 : -1.0;
            const double bound = side < 2 ? triangle.lit.least(k) : triangle.lit.greatest(k);
            if (bound == -sign * infinity || is_on_side(triangle.planes, coordinate, bound)) continue;
            const auto at_side = [&](const Double2& f, double of_q) { return sign * (f[k] - bound * of_q); };
            Ramp inside{at_side(base, at.q_ramp.base), at_side(dx, at.q_ramp.dx), at_side(dy, at.q_ramp.dy)};
            // Fragments on the side are inside, and none lies within half a fragment of them.
            if (bound == 0.0 && zeros_of(triangle.planes, coordinate, tile).end != 0)
                inside.base += 0.5 * (std::fabs(inside.dx) + std::fabs(inside.dy));
            // Values in the tile are five times the largest one at most, and rounded three times.
            const double margin = margin_of_sides(at, 0.0, q)[k] + std::fabs(bound) * margin_of_bounds(at, q) +
                                  0x1p-46 * at.largest_numerator[k];
            add(inside, margin, slack);
        }
    }

    // False where a function or a bound is next to infinity, and nothing is known.
    bool are_finite() const noexcept { return are_finite_; }

    // The fragments of a row that are lit for certain, and those that may be.
    struct Lit {
        Span certain, possible;
    };
    TEXGEN_APART Lit find(int y) const noexcept {
        const Double2 none{}, all = double2_of(tile_.width, tile_.width);
        Double2 begin = none, end = all;
        for (std::size_t i = 0; i < begins_; ++i) begin = larger(at_begin_[i].in_row(y), begin);
        for (std::size_t i = 0; i < ends_; ++i) end = smaller(at_end_[i].in_row(y), end);
        const auto [certain_begin, possible_begin] = counts_before(smaller(begin, all));
        const auto [certain_end, possible_end] = counts_before(larger(end, none));
        const Span possible{possible_begin < possible_end ? possible_begin : possible_end, possible_end};
        return {certain_begin < certain_end ? Span{certain_begin, certain_end} : Span{possible_end, possible_end},
                possible};
    }

private:
    // Where a function reaches its margin (element 0) and minus its margin (1): in the first row, and the step from row
    // to row.
    struct Zero {
        Double2 first, step;

        Double2 in_row(int y) const noexcept { return first + step * y; }
    };

    // Whether u = bound everywhere. Bounds and coordinates are floats, so their product is exact.
    static bool is_on_side(const TrianglePlanes& planes, glm::length_t coordinate, double bound) noexcept {
        for (std::size_t i = 0; i < 3; ++i)
            if (planes.value(i, coordinate) != bound * planes.value(i, 3)) return false;
        return true;
    }

    // A function that grows along a row by less than a share of its margin is taken for one that grows by that share,
    // which moves its zero only within the margin. One that is above its margin in the whole tile bounds nothing. Within
    // a margin of no more than `slack` either answer will do.
    TEXGEN_APART void add(const Ramp& value, double margin, double slack) noexcept {
        const double least = value.base + smaller(value.dx * tile_.width, 0.0) + smaller(value.dy * tile_.height, 0.0);
        if (least > margin && least < infinity) return;
        const double least_growth = 0x1p-8 * margin / tile_.width;
        double dx = value.dx;
        if (std::fabs(dx) < least_growth) {
            dx = least_growth;
            margin *= 1.01;
        }
        const double per_dx = 1.0 / dx;
        const double base = -value.base * per_dx, step = -value.dy * per_dx, reach = std::fabs(margin * per_dx);
        const double rounding = 0x1p-20 + 0x1p-50 * (std::fabs(base) + std::fabs(step) * tile_.height + reach);
        const Double2 zero = double2_of(base, base);
        const double all = reach + rounding <= slack * std::fabs(per_dx) ? 0.0 : reach + rounding;
        const Double2 outwards = double2_of(all, -all);
        if (dx > 0.0)
            at_begin_[begins_++] = {zero + outwards, double2_of(step, step)};
        else
            at_end_[ends_++] = {zero - outwards, double2_of(step, step)};
        are_finite_ &= rounding < infinity;
    }

    // How many whole numbers from 0 on are below each of two numbers, of which 2^-21 may be taken: the last bits of a
    // sum with 2^52 are those of the nearest integer.
    static std::array<int, 2> counts_before(const Double2& x) noexcept {
        const Double2 sum = (x + (0.5 - 0x1p-21)) + 0x1p52;
        std::uint64_t bits[2];
        std::memcpy(bits, &sum, sizeof bits);
        return {static_cast<int>(bits[0] & 0xffffffffu), static_cast<int>(bits[1] & 0xffffffffu)};
    }

    Tile tile_;
    Zero at_begin_[5], at_end_[5];
    std::size_t begins_ = 0, ends_ = 0;
    bool are_finite_ = true;
};

// Makes the mask of a tile by the spans of its rows. Returns the part where floats decide, or all if that is much.
TEXGEN_APART inline Tile light_spans(const TriangleFunctions& triangle, const Tile& tile, const Corners& at,
                                     const std::span<float>& lit) noexcept {
    const HalfPlanes planes(triangle, at, tile);
    if (!planes.are_finite()) return tile;
    std::memset(lit.data(), 0, lit.size_bytes());
    const MaskKernels& kernels = chosen<MaskKernels>();
    int left = tile.width, right = 0, top = tile.height, bottom = 0;
    for (int y = 0; y < tile.height; ++y) {
        const auto [certain, possible] = planes.find(y);
        kernels.light_all(lit.data() + static_cast<std::ptrdiff_t>(y) * tile.width + certain.begin,
                          static_cast<std::size_t>(certain.end - certain.begin));
        if (possible.begin == certain.begin && possible.end == certain.end) continue;
        const int first = possible.begin < certain.begin ? possible.begin : certain.end;
        const int end = certain.end < possible.end ? possible.end : certain.begin;
        if (first < left) left = first;
        if (end > right) right = end;
        if (bottom == 0) top = y;
        bottom = y + 1;
    }
    if (bottom == 0) return {};
    const Tile part{tile.x + left, tile.y + top, right - left, bottom - top};
    return 4 * part.count() > tile.count() ? tile : part;
}

}  // namespace TEXGEN_DETAIL_BUILD
