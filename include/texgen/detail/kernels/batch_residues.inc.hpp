// The functions of a batch's triangles over tiles and runs that doubles leave in doubt, to twice their precision and as integers
// modulo 2^64, as in triangle/close_planes.hpp, a tile in each lane; then the quotients. Included by batch.inc.hpp.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

// Of as many tiles as a block has, about their first fragments: base, and by how much it grows along a row and down; q last.
struct BatchFunctions {
    double high[4][3][batch_block], low[4][3][batch_block], error[4][batch_block], grain[4][batch_block];
    std::uint64_t residue[4][3][batch_block];

    // The tiles from `first` on, of a triangle in each lane: see CloseRamp::split(). What residues do not know has a grain of 0.
    // Returns the lanes that nothing is known of.
    template <std::size_t Numerators>
    TEXGEN_APART LongWords take(const float* const (&triangle)[lanes], const Doubles& x, const Doubles& y,
                                const Doubles& width, const Doubles& height, std::size_t first) noexcept {
        const VertexLanes vertices(triangle);
        const CloseLanes close(vertices, x, y);
        const CloseSteps along(vertices, 1), down(vertices, 0);
        ResidueLanes corners(vertices, x, y);
        Residues dx[3], dy[3];
        corners.steps(dx, dy);
        for (std::size_t n = 0; n <= Numerators; ++n) {
            const std::size_t k = n < Numerators ? n : 3;
            const Twofold term[3] = {close.function(vertices, k), along.function(vertices, k),
                                     down.function(vertices, k)};
            const Doubles size =
                magnitude(term[0].high) + (magnitude(term[1].high) * width + magnitude(term[2].high) * height);
            const Doubles lost = term[0].lost + (term[1].lost * width + term[2].lost * height);
            const Doubles unit = power_of_two_below(size) * 0x1p-50;
            const Doubles rounder = unit * 0x1.8p52;
            TEXGEN_UNROLL
            for (std::size_t j = 0; j < 3; ++j) {
                const Doubles leading = (term[j].high + rounder) - rounder;
                store(&high[n][j][first], leading);
                store(&low[n][j][first], (term[j].high - leading) + term[j].low);
            }
            store(&error[n][first], (lost + (width + height + 1.0) * unit * 0x1p-50) * 1.01);
            const ResidueValues value = corners.values(k);
            store(&residue[n][0][first], value.times(corners.side));
            store(&residue[n][1][first], value.times(dx));
            store(&residue[n][2][first], value.times(dy));
            // Of what is 0 at all corners any grain.
            store(&grain[n][first], where(corners.is_known | at_most(size, Doubles{}), value.grain));
        }
        return ~vertices.has_area;
    }
};

// Of tile i at (x, y) from its first fragment; sums of the high parts are exact.
struct BatchFunctionsAt {
    const BatchFunctions& of;
    std::size_t i;
    Doubles x, y;

    TEXGEN_INLINE CloseValues values(std::size_t n) const noexcept {
        return {x * of.high[n][1][i] + (y * of.high[n][2][i] + of.high[n][0][i]),
                x * of.low[n][1][i] + (y * of.low[n][2][i] + of.low[n][0][i]), Doubles{} + of.error[n][i]};
    }
    TEXGEN_INLINE Residues residues(std::size_t n) const noexcept {
        return to_residues(x) * of.residue[n][1][i] + (to_residues(y) * of.residue[n][2][i] + of.residue[n][0][i]);
    }
    TEXGEN_INLINE double grain(std::size_t n) const noexcept { return of.grain[n][i]; }
};

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
