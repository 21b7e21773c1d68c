#pragma once

// What the library reads of its own classes, and nobody else.

#include <cstddef>

#include "language.hpp"

namespace TEXGEN_DETAIL {

struct Inside {
    template <class Setup>
    static const auto& functions(const Setup& setup) noexcept {
        return setup.functions_;
    }
    template <class Setup>
    static const auto& texels(const Setup& setup) noexcept {
        return setup.texels_;
    }
    template <class Batch>
    static const auto& triangle(const Batch& batch, std::size_t i) noexcept {
        return batch.triangles_[i];
    }
    template <class Batch>
    static const auto* planes(const Batch& batch) noexcept {
        return batch.planes_.data();
    }
    template <class Batch>
    static const auto& lit(const Batch& batch) noexcept {
        return batch.lit_;
    }
};

}  // namespace TEXGEN_DETAIL
