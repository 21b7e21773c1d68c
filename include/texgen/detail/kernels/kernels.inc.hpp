// The inner loops, a file a concern, and the tables of them. Included by instruction_sets.inc.hpp once per instruction set, inside
// that set's target region, so that one source serves all of them. A kernel gets plain numbers; the only decisions that it makes
// are how a chunk of a row is divided and what is in doubt.

#ifdef TEXGEN_HAS_VECTORS
#include "../simd/vectors.inc.hpp"
#else
#include "../simd/loops.inc.hpp"
#endif

#include "stores.inc.hpp"
#include "tiles.inc.hpp"

#include "../simd/twofold.inc.hpp"
#include "chunks.inc.hpp"

#include "points.inc.hpp"
#include "points_in_float.inc.hpp"
#include "segments.inc.hpp"

#include "boxes.inc.hpp"
#include "footprint.inc.hpp"
#include "forms.inc.hpp"
#include "mask.inc.hpp"
#include "separating.inc.hpp"

namespace TEXGEN_DETAIL::TEXGEN_ISA {

// The kernels of a kind, compiled where it is asked for.
template <class Table, class CompiledWhereCalled = void>
struct KernelTable;

template <class CompiledWhereCalled>
struct KernelTable<TileKernels, CompiledWhereCalled> {
    static const TileKernels& get() noexcept {
        static constexpr TileKernels table{.fill_exact = fill_tile_exact<>,
                                           .fill_float_divided = fill_tile_float_divided<>,
                                           .fill_polynomial = fill_tile_polynomial<>,
                                           .fill_closely = fill_tile_closely<>};
        return table;
    }
};

template <class CompiledWhereCalled>
struct KernelTable<PointKernels, CompiledWhereCalled> {
    static const PointKernels& get() noexcept {
        static constexpr PointKernels table{.fill_exact = fill_points_exact<>,
                                            .fill_all_float = fill_points_within<FormsInFloat>,
                                            .fill_float_divided = fill_points_within<FormsInDouble>,
                                            .generate = generate_points<>};
        return table;
    }
};

template <class CompiledWhereCalled>
struct KernelTable<SegmentKernels, CompiledWhereCalled> {
    static const SegmentKernels& get() noexcept {
        static constexpr SegmentKernels table{.fill_exact = fill_segment_exact<>,
                                              .fill_in_double = fill_segment_in_double<>,
                                              .fill_all_float = fill_segment_all_float<>};
        return table;
    }
};

template <class CompiledWhereCalled>
struct KernelTable<MaskKernels, CompiledWhereCalled> {
    static const MaskKernels& get() noexcept {
        static constexpr MaskKernels table{.light_all = light_all<>, .darken = darken<>};
        return table;
    }
};

template <class CompiledWhereCalled>
struct KernelTable<FootprintKernels, CompiledWhereCalled> {
    static const FootprintKernels& get() noexcept {
        static constexpr FootprintKernels table{.differentiate = differentiate<>, .filter = filter<>};
        return table;
    }
};

template <class CompiledWhereCalled>
struct KernelTable<FormKernels, CompiledWhereCalled> {
    static const FormKernels& get() noexcept {
        static constexpr FormKernels table{.weigh = weigh_forms<>};
        return table;
    }
};

template <class CompiledWhereCalled>
struct KernelTable<SeparatingFormKernels, CompiledWhereCalled> {
    static const SeparatingFormKernels& get() noexcept {
        static constexpr SeparatingFormKernels table{.make = make_planes<>};
        return table;
    }
};

template <class CompiledWhereCalled>
struct KernelTable<FloatFormKernels, CompiledWhereCalled> {
    static const FloatFormKernels& get() noexcept {
        static constexpr FloatFormKernels table{.round = round_forms<>};
        return table;
    }
};

template <class CompiledWhereCalled>
struct KernelTable<BoxKernels, CompiledWhereCalled> {
    static const BoxKernels& get() noexcept {
        static constexpr BoxKernels table{
            .classify = classify_box<>, .sharpen = sharpen<>, .is_separated = is_separated<>};
        return table;
    }
};

template <class CompiledWhereCalled>
struct KernelTable<BoxBatchKernels, CompiledWhereCalled> {
    static const BoxBatchKernels& get() noexcept {
        static constexpr BoxBatchKernels table{
            .classify = classify_boxes<>, .bound = bound_boxes<>, .separate = separate<>};
        return table;
    }
};

template <class CompiledWhereCalled>
struct KernelTable<SphereBatchKernels, CompiledWhereCalled> {
    static const SphereBatchKernels& get() noexcept {
        static constexpr SphereBatchKernels table{.classify = classify_spheres<>, .bound = bound_spheres<>};
        return table;
    }
};

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
