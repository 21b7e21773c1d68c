#pragma once

// The kernels of batches: apart from all others, so that only files with batches pay for them.

#include <bit>

#include "batch_jobs.hpp"
#include "lanes.hpp"

#define TEXGEN_KERNELS "../kernels/batch.inc.hpp"
#include "instruction_sets.inc.hpp"
#undef TEXGEN_KERNELS

#ifdef TEXGEN_SEPARATE_KERNELS
namespace TEXGEN_DETAIL_BUILD {
TEXGEN_EXTERN template const BatchKernels& chosen<BatchKernels>() noexcept;
TEXGEN_EXTERN template const BatchFootprintKernels& chosen<BatchFootprintKernels>() noexcept;
}  // namespace TEXGEN_DETAIL_BUILD
#endif
