// The inner loops of batches, and the table of them. Included by instruction_sets.inc.hpp once per instruction set.

#include "batch_set_up.inc.hpp"

#include "batch_closely.inc.hpp"

#include "batch_corners.inc.hpp"

#include "batch_residues.inc.hpp"

#include "batch_fragments.inc.hpp"

#include "batch_footprints.inc.hpp"
#include "batch_shapes.inc.hpp"
#include "batch_survey.inc.hpp"

#include "batch_doubt.inc.hpp"

#include "batch_tiles.inc.hpp"

namespace TEXGEN_DETAIL::TEXGEN_ISA {

template <class CompiledWhereCalled>
inline constexpr BatchKernels kernel_table<BatchKernels, CompiledWhereCalled>{
    .set_up = set_up_batch<CompiledWhereCalled>,
    .divide_tiles = divide_batch_tiles<CompiledWhereCalled>,
    .divide_fragments = divide_batch_fragments<CompiledWhereCalled>};

template <class CompiledWhereCalled>
inline constexpr BatchFootprintKernels kernel_table<BatchFootprintKernels, CompiledWhereCalled>{
    .fill = fill_batch_footprints<CompiledWhereCalled>};

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
