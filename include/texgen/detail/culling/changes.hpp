#pragma once

// Which indices of an array that grows and shrinks changed since it was last looked at.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "../assert.hpp"
#include "../held.hpp"
#include "../language.hpp"

namespace TEXGEN_DETAIL {

class Changes {
public:
    void begin(const std::span<const std::uint32_t>& named, std::size_t count) noexcept {
        if (count > is_changed_.size()) is_changed_.resize(count, 0);
        changed_.reserve(is_changed_.capacity());
        const std::size_t before = count_;
        // New indices come first, and in order, as callers append them.
        for (std::size_t i = (std::min)(count, before); i < (std::max)(count, before); ++i)
            add(static_cast<std::uint32_t>(i));
        for (const std::uint32_t i : named) {
            TEXGEN_ASSERT(i < count || i < before);
            if (i < count) add(i);  // one that is gone was added above
        }
        count_ = count;
    }

    void end() noexcept {
        for (const std::uint32_t i : changed_) is_changed_[i] = 0;
        changed_.clear();
    }

    std::span<const std::uint32_t> changed() const noexcept { return changed_; }
    bool is_changed(std::size_t i) const noexcept { return is_changed_[i] != 0; }

private:
    void add(std::uint32_t i) noexcept {
        if (is_changed_[i] != 0) return;
        is_changed_[i] = 1;
        changed_.push_back(i);
    }

    std::vector<std::uint32_t> changed_;
    std::vector<std::uint8_t> is_changed_;
    HeldCount count_;
};

}  // namespace TEXGEN_DETAIL
