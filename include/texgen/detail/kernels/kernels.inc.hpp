// The inner loops, a file a concern, and the tables of them. Included by instruction_sets.inc.hpp once per instruction
// set, inside that set's target region, so that one source serves all of them. A kernel gets plain numbers; the only
// decisions that it makes are how a chunk of a row is divided and what is in doubt.

#ifdef TEXGEN_HAS_VECTORS
#include "../simd/vectors.inc.hpp"

#include "../simd/middles.inc.hpp"
#else
#include "../simd/loops.inc.hpp"
#endif

// What decides doubt is the most code, the more so for short vectors: for these it is compiled for size.
#if defined(TEXGEN_HAS_VECTORS) && TEXGEN_LANE_BYTES == 16
#define TEXGEN_LARGE TEXGEN_RARE
#else
#define TEXGEN_LARGE TEXGEN_APART
#endif

#include "../simd/quotients.inc.hpp"

#include "stores.inc.hpp"

#include "../simd/twofold.inc.hpp"

#include "doubt.inc.hpp"

#include "chunks.inc.hpp"
#include "small_tiles.inc.hpp"
#include "tiles.inc.hpp"

#include "points.inc.hpp"
#include "points_exactly.inc.hpp"
#include "points_in_float.inc.hpp"

#include "generate.inc.hpp"
#include "segments.inc.hpp"

#include "separating.inc.hpp"

#include "boxes.inc.hpp"
#include "footprint.inc.hpp"
#include "forms.inc.hpp"
#include "mask.inc.hpp"

namespace TEXGEN_DETAIL::TEXGEN_ISA {

// The table of a kind of kernels, compiled where it is asked for: kernels without the parameter would be compiled here.
template <class Table, class CompiledWhereCalled = void>
inline constexpr Table kernel_table;

template <class CompiledWhereCalled>
inline constexpr TileKernels kernel_table<TileKernels, CompiledWhereCalled>{
    .fill_small = fill_small_tile<CompiledWhereCalled>,
    .divide = divide_tile<CompiledWhereCalled>,
    .divide_in_pairs = divide_in_pairs<CompiledWhereCalled>,
    .weigh_chunks = weigh_chunks<CompiledWhereCalled>,
    .fill_chunks = fill_chunks<CompiledWhereCalled>,
    .fill_closely = fill_tile_closely<CompiledWhereCalled>};

template <class CompiledWhereCalled>
inline constexpr PointKernels kernel_table<PointKernels, CompiledWhereCalled>{
    .fill_exact = fill_points_exact<CompiledWhereCalled>,
    .fill_within = fill_points_within<CompiledWhereCalled>,
    .generate = generate_points<CompiledWhereCalled>};

template <class CompiledWhereCalled>
inline constexpr SegmentKernels kernel_table<SegmentKernels, CompiledWhereCalled>{
    .fill_exact = fill_segment_exact<CompiledWhereCalled>,
    .fill_in_double = fill_segment_in_double<CompiledWhereCalled>,
    .fill_all_float = fill_segment_all_float<CompiledWhereCalled>};

template <class CompiledWhereCalled>
inline constexpr MaskKernels kernel_table<MaskKernels, CompiledWhereCalled>{.light_all = light_all<CompiledWhereCalled>,
                                                                            .darken = darken<CompiledWhereCalled>};

template <class CompiledWhereCalled>
inline constexpr FootprintKernels kernel_table<FootprintKernels, CompiledWhereCalled>{
    .differentiate = differentiate<CompiledWhereCalled>, .filter = filter<CompiledWhereCalled>};

template <class CompiledWhereCalled>
inline constexpr FormKernels kernel_table<FormKernels, CompiledWhereCalled>{.weigh = weigh_forms<CompiledWhereCalled>};

template <class CompiledWhereCalled>
inline constexpr SeparatingPlaneKernels kernel_table<SeparatingPlaneKernels, CompiledWhereCalled>{
    .make = make_separating_planes<CompiledWhereCalled>};

template <class CompiledWhereCalled>
inline constexpr FloatFormKernels kernel_table<FloatFormKernels, CompiledWhereCalled>{
    .round = round_forms<CompiledWhereCalled>};

template <class CompiledWhereCalled>
inline constexpr BoxKernels kernel_table<BoxKernels, CompiledWhereCalled>{
    .classify = classify_box<CompiledWhereCalled>,
    .decide = decide_box<CompiledWhereCalled>,
    .is_separated = is_separated<CompiledWhereCalled>};

template <class CompiledWhereCalled>
inline constexpr BoxBatchKernels kernel_table<BoxBatchKernels, CompiledWhereCalled>{
    .classify = classify_boxes<CompiledWhereCalled>, .decide = decide_boxes<CompiledWhereCalled>};

template <class CompiledWhereCalled>
inline constexpr SphereKernels kernel_table<SphereKernels, CompiledWhereCalled>{
    .classify = classify_spheres<CompiledWhereCalled>, .decide = decide_spheres<CompiledWhereCalled>};

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA

#undef TEXGEN_LARGE
