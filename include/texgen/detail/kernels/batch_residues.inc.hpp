// The functions of a batch's triangles over tiles and runs that doubles leave in doubt, to twice their precision and as
// integers modulo 2^64, as in triangle/doubt.hpp, a triangle in each lane. Included by batch.inc.hpp.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

// The functions s, t, r, q of a triangle about a fragment: each as base and its growth along a row and down a column,
// in two doubles and as residues, with an error and a grain. In whole vectors, so that the last residues are 0; r only
// where it is needed.
struct alignas(64) BatchFunction {
    double part[4][8];  // high, low, error, grain
    std::uint64_t residues[16];
};

// The functions of the triangle in each lane.
struct LaneFunctions {
    Doubles part[4][8];
    Residues residues[16];

    TEXGEN_INLINE LaneFunctions(const BatchFunction* const (&of)[lanes], bool needs_r) noexcept {
        for (std::size_t n = 0; n < 4; ++n)
            if (n != 2 || needs_r) load_columns(part[n], 8, [&](std::size_t j) { return of[j]->part[n]; });
        load_columns(residues, 12, [&](std::size_t j) { return of[j]->residues; });
    }
};

// The functions of a block of triangles.
struct BatchFunctions {
    BatchFunction of[batch_block];

    // Makes the functions from `first` on, of a triangle in each lane about a fragment, for this many columns and rows:
    // see CloseRamp::copy_to(). Where residues know nothing the grain is 0. They are made about corners where their
    // terms cancel, or if about_corners asks for it.
    TEXGEN_APART void take(const float* const (&triangle)[lanes], bool needs_r, const Doubles& x, const Doubles& y,
                           const Doubles& width, const Doubles& height, std::size_t first,
                           bool about_corners) noexcept {
        const VertexLanes vertices(triangle);
        const CloseLanes close(vertices, x, y);
        ResidueLanes of_corners(vertices, x, y);
        Residues dx[3], dy[3];
        of_corners.steps(dx, dy);
        Residues residues[16]{};
        Doubles grain[4];
        for (std::size_t n = 0; n < 4; ++n) {
            if (n == 2 && !needs_r) continue;
            const ResidueValues value = of_corners.values(n);
            residues[3 * n] = value.times(of_corners.side);
            residues[3 * n + 1] = value.times(dx) * of_corners.one_x;
            residues[3 * n + 2] = value.times(dy) * of_corners.one_y;
            grain[n] = where(of_corners.is_known, value.grain);
        }
        store_columns(residues, [&](std::size_t j) { return of[first + j].residues; });
        if (!about_corners) {
            const CloseSteps along(vertices, 0), down(vertices, 1);
            LongWords cancel{};
            for (std::size_t n = 0; n < 4; ++n)
                if (n != 2 || needs_r)
                    cancel |=
                        put(n, {close.function(vertices, n), along.function(vertices, n), down.function(vertices, n)},
                            grain[n], width, height, vertices, first);
            if (!any(cancel)) return;
        }
        take_about_corners(vertices, needs_r, close, of_corners, x, y, grain, width, height, first);
    }

private:
    // Stores function n. Returns the lanes where it cancels: more than one float in 2^12 would stay in doubt.
    TEXGEN_INLINE LongWords put(std::size_t n, const CloseValues (&term)[3], const Doubles& grain, const Doubles& width,
                                const Doubles& height, const VertexLanes& vertices, std::size_t first) noexcept {
        const Doubles size =
            magnitude(term[0].high) + (magnitude(term[1].high) * width + magnitude(term[2].high) * height);
        const Doubles lost = term[0].error + (term[1].error * width + term[2].error * height);
        const Doubles unit = power_of_two_below(size) * 0x1p-50;
        const Doubles rounder = unit * 0x1.8p52;
        Doubles part[8];
        TEXGEN_FOR (std::size_t j = 0; j < 3; ++j) {
            part[j] = (term[j].high + rounder) - rounder;
            part[3 + j] = (term[j].high - part[j]) + term[j].low;
        }
        part[6] = (lost + (width + height + 1.0) * unit * 0x1p-50) * 1.01 + (n < 3 ? Doubles{} : vertices.error_of_q);
        part[7] = grain;
        store_columns(part, [&](std::size_t j) { return of[first + j].part[n]; });
        return greater(lost, size * cancelled_share);
    }

    TEXGEN_APART void take_about_corners(const VertexLanes& vertices, bool needs_r, const CloseLanes& close,
                                         ResidueLanes& residues, const Doubles& x, const Doubles& y,
                                         const Doubles (&grain)[4], const Doubles& width, const Doubles& height,
                                         std::size_t first) noexcept {
        const CornerLanes corners(vertices, residues, x, y);
        for (std::size_t n = 0; n < 4; ++n) {
            if (n == 2 && !needs_r) continue;
            CloseValues term[3];
            corners.take(n, residues.values(n), term[0], term[1], term[2]);
            term[0] = better(term[0], close.function(vertices, n));
            put(n, term, grain[n], width, height, vertices, first);
        }
    }
};

// The functions at (x, y) from the fragment that they are about. Sums of the high parts are exact: see CloseFunction.
template <class Functions>
struct BatchFunctionsAt {
    static constexpr bool are_sums_first = true;
    const Functions& of;
    Doubles x, y;

    TEXGEN_INLINE CloseValues values(std::size_t n) const noexcept {
        const auto& part = of.part[n];
        return {x * part[1] + (y * part[2] + part[0]), x * part[4] + (y * part[5] + part[3]), Doubles{} + part[6]};
    }
    TEXGEN_INLINE Residues residues(std::size_t n) const noexcept {
        return to_residues(x) * of.residues[3 * n + 1] + (to_residues(y) * of.residues[3 * n + 2] + of.residues[3 * n]);
    }
    TEXGEN_INLINE auto grain(std::size_t n) const noexcept { return of.part[n][7]; }
};

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
