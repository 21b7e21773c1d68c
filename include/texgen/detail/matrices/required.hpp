#pragma once

#include "../language.hpp"

namespace TEXGEN_DETAIL {

// A member that has no default: leaving it out does not compile.
template <class T>
class Required {
public:
    constexpr Required(T value) noexcept : value_(value) {}
    constexpr operator T() const noexcept { return value_; }

private:
    T value_;
};

}  // namespace TEXGEN_DETAIL
