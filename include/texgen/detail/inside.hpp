#pragma once

// Access to private members of the public classes, for the library alone.

#include <cstddef>

#include "language.hpp"

namespace TEXGEN_DETAIL {

struct Inside {
    static const auto& functions(const auto& setup) noexcept { return setup.functions_; }
    static const auto& texels(const auto& setup) noexcept { return setup.texels_; }
    static const auto& triangle(const auto& batch, std::size_t i) noexcept { return batch.triangles_[i]; }
    static const auto* planes(const auto& batch) noexcept { return batch.planes_.data(); }
    static const auto& lit(const auto& batch) noexcept { return batch.lit_; }
};

}  // namespace TEXGEN_DETAIL
