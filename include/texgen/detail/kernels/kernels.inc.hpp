// The inner loops, a file a concern, and the tables of them. Included by lanes.hpp once per instruction set, inside that set's
// target region, so that one source serves all of them. A kernel gets plain numbers; the only decisions that it makes are how a
// chunk of a row is divided and what is in doubt.

#include "stores.inc.hpp"
#include "tiles.inc.hpp"

#include "../simd/twofold.inc.hpp"
#include "chunks.inc.hpp"

#include "points.inc.hpp"
#include "segments.inc.hpp"

#include "batch_set_up.inc.hpp"

#include "batch_fragments.inc.hpp"
#include "batch_tiles.inc.hpp"
#include "boxes.inc.hpp"
#include "footprint.inc.hpp"

namespace TEXGEN_DETAIL::TEXGEN_ISA {

template <class Table>
const Table& kernels() noexcept {
    if constexpr (std::is_same_v<Table, TileKernels>) {
        static constexpr TileKernels table{.fill_exact = fill_tile_exact<>,
                                           .fill_float_divided = fill_tile_float_divided<>,
                                           .fill_polynomial = fill_tile_polynomial<>,
                                           .fill_closely = fill_tile_closely<>};
        return table;
    } else if constexpr (std::is_same_v<Table, PointKernels>) {
        static constexpr PointKernels table{.fill_exact = fill_points_exact<>,
                                            .fill_all_float = fill_points_within<FormsInFloat>,
                                            .fill_float_divided = fill_points_within<FormsInDouble>,
                                            .generate = generate_points<>};
        return table;
    } else if constexpr (std::is_same_v<Table, SegmentKernels>) {
        static constexpr SegmentKernels table{.fill_exact = fill_segment_exact<>,
                                              .fill_all_float = fill_segment_all_float<>};
        return table;
    } else if constexpr (std::is_same_v<Table, FootprintKernels>) {
        static constexpr FootprintKernels table{.differentiate = differentiate<>, .filter = filter<>};
        return table;
    } else if constexpr (std::is_same_v<Table, BatchKernels>) {
        static constexpr BatchKernels table{.set_up = set_up_batch<>,
                                            .divide_tiles = divide_batch_tiles<>,
                                            .divide_fragments = divide_batch_fragments<>};
        return table;
    } else {
        static constexpr BoxKernels table{.classify = classify<>, .bound = bound<>, .separate = separate<>};
        return table;
    }
}

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
