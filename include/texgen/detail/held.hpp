#pragma once

// What classes that keep memory need for it: a count that moves with it, and an allocator for aligned types.

#include <cstddef>
#include <new>
#include <utility>

#include "language.hpp"

namespace TEXGEN_DETAIL {

// The count of what the vectors beside it hold. It is 0 once its object has been moved from, as they are empty then.
class HeldCount {
public:
    HeldCount() noexcept = default;
    HeldCount(std::size_t count) noexcept : count_(count) {}
    HeldCount(const HeldCount&) noexcept = default;
    HeldCount& operator=(const HeldCount&) noexcept = default;
    HeldCount(HeldCount&& other) noexcept : count_(std::exchange(other.count_, 0)) {}
    HeldCount& operator=(HeldCount&& other) noexcept {
        count_ = std::exchange(other.count_, 0);
        return *this;
    }
    ~HeldCount() = default;

    operator std::size_t() const noexcept { return count_; }

private:
    std::size_t count_ = 0;
};

// An allocator for types that are aligned beyond the ordinary. It is not std::allocator, for which clang++ 14 with the
// library of g++ 12 forgets the alignment in C++23.
template <class Value>
struct AlignedAllocator {
    using value_type = Value;

    AlignedAllocator() noexcept = default;
    template <class Other>
    AlignedAllocator(const AlignedAllocator<Other>&) noexcept {}

    Value* allocate(std::size_t count) {
        return static_cast<Value*>(::operator new(count * sizeof(Value), std::align_val_t(alignof(Value))));
    }
    void deallocate(Value* values, std::size_t) noexcept {
        ::operator delete(values, std::align_val_t(alignof(Value)));
    }

    friend bool operator==(const AlignedAllocator&, const AlignedAllocator&) noexcept { return true; }
};

}  // namespace TEXGEN_DETAIL
