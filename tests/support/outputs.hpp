#pragma once

// The caller's arrays, each inside a larger one whose other floats must stay as they are.

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "texgen/texcoord.hpp"

namespace support {

// s, t, r and lit for `count` values; bits 0 to 3 of `asked` say which are asked for. Each starts `misalignment` floats
// behind an address of the allocator's, with poison before and after it and in it.
class Outputs {
public:
    static constexpr unsigned all = 15;

    explicit Outputs(std::size_t count, unsigned asked = all, std::size_t misalignment = 0)
        : count_(count), asked_(asked), first_(pad + misalignment) {
        for (std::vector<float>& array : arrays_) array.assign(first_ + count_ + pad, poison());
    }

    texgen::Texcoords spans() { return {.s = span(0), .t = span(1), .r = span(2), .lit = span(3)}; }

    // What stands in array k, asked for or not.
    std::span<const float> operator[](std::size_t k) const { return {arrays_[k].data() + first_, count_}; }
    std::span<const float> s() const { return (*this)[0]; }
    std::span<const float> t() const { return (*this)[1]; }
    std::span<const float> r() const { return (*this)[2]; }
    std::span<const float> lit() const { return (*this)[3]; }
    std::size_t size() const { return count_; }
    bool asked(std::size_t k) const { return ((asked_ >> k) & 1u) != 0u; }

    static bool is_poison(float value) { return std::bit_cast<std::uint32_t>(value) == poison_bits; }
    static bool is_poison(std::span<const float> values) {
        return std::all_of(values.begin(), values.end(), [](float value) { return is_poison(value); });
    }

    // Whether everything outside the spans still is as it was.
    bool pads_are_intact() const {
        for (std::size_t k = 0; k < 4; ++k) {
            const std::span<const float> array(arrays_[k]);
            if (!is_poison(array.first(first_)) || !is_poison(array.last(pad))) return false;
            if (!asked(k) && !is_poison((*this)[k])) return false;
        }
        return true;
    }

private:
    static constexpr std::uint32_t poison_bits = 0x7fe0dead;  // a NaN that no arithmetic makes
    static constexpr std::size_t pad = 40;
    static float poison() { return std::bit_cast<float>(poison_bits); }

    std::span<float> span(std::size_t k) {
        return asked(k) ? std::span<float>(arrays_[k]).subspan(first_, count_) : std::span<float>();
    }

    std::size_t count_;
    unsigned asked_;
    std::size_t first_;
    std::array<std::vector<float>, 4> arrays_;
};

// `count` floats of an array that has 32 more, `behind` floats from where a line of a cache begins.
inline std::span<float> behind_line(std::vector<float>& array, std::size_t behind, std::size_t count) {
    void* begin = array.data();
    std::size_t room = array.size() * sizeof(float);
    return {static_cast<float*>(std::align(64, (behind + count) * sizeof(float), begin, room)) + behind, count};
}

inline bool same_bits(float a, float b) { return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b); }
inline bool same_bits(std::span<const float> a, std::span<const float> b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](float x, float y) { return same_bits(x, y); });
}

}  // namespace support
