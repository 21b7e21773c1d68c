#pragma once

// A value that is made where it is first needed, if ever. std::optional would serve, but each of its types takes every
// user four times as long to compile: it is kept for results.

#include <new>

#include "language.hpp"

namespace TEXGEN_DETAIL {

// For types that need no destructor. The value is not initialized before it is made.
template <class Value>
class OnDemand {
public:
    OnDemand() noexcept {}

    explicit operator bool() const noexcept { return is_made_; }
    Value& operator*() noexcept { return value_; }
    Value* operator->() noexcept { return &value_; }

    template <class... Arguments>
    void make(const Arguments&... arguments) noexcept {
        ::new (static_cast<void*>(&value_)) Value(arguments...);
        is_made_ = true;
    }
    void drop() noexcept { is_made_ = false; }

private:
    union {
        Value value_;
    };
    bool is_made_ = false;
};

}  // namespace TEXGEN_DETAIL
