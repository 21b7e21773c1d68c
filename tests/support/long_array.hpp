#pragma once

// An array of floats that is longer than memory: all of it is one and the same block, again and again, but for its end,
// which has a block of its own. No page next to it may be touched, nor any as far below it as it is long.

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <span>

namespace support {

class LongArray {
public:
    explicit LongArray(std::size_t count)
        : count_(count), blocks_((count * sizeof(float) + block - 1) / block), size_((2 * blocks_ + 2) * block) {
        void* const reserved = mmap(nullptr, size_, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
        if (reserved == MAP_FAILED) return;
        memory_ = static_cast<std::byte*>(reserved);
        const int file = memfd_create("texgen", 0);
        is_usable_ = file >= 0 && ftruncate(file, static_cast<off_t>(2 * block)) == 0;
        for (std::size_t i = 0; is_usable_ && i < blocks_; ++i) {
            const auto offset = static_cast<off_t>(i + 1 < blocks_ ? 0 : block);
            is_usable_ = mmap(begin() + i * block, block, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_FIXED, file,
                              offset) != MAP_FAILED;
        }
        if (file >= 0) close(file);
    }
    ~LongArray() {
        if (memory_ != nullptr) munmap(memory_, size_);
    }
    LongArray(const LongArray&) = delete;
    LongArray& operator=(const LongArray&) = delete;

    // False where the machine does not give what this needs.
    bool is_usable() const { return is_usable_; }
    // Its last float is the last before a page that may not be touched.
    std::span<float> floats() const { return {reinterpret_cast<float*>(begin() + blocks_ * block) - count_, count_}; }
    std::span<float> last(std::size_t count) const { return floats().last(count); }

private:
    static constexpr std::size_t block = std::size_t{1} << 21;

    std::byte* begin() const { return memory_ + (blocks_ + 1) * block; }

    std::size_t count_, blocks_, size_;
    std::byte* memory_ = nullptr;
    bool is_usable_ = false;
};

}  // namespace support
