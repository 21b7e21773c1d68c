#pragma once

// The caller's arrays of footprints, as outputs.hpp has those of coordinates.

#include <cstddef>
#include <span>

#include "judges/fragments.hpp"
#include "support/outputs.hpp"
#include "texgen/footprint.hpp"

namespace support {

// The eight outputs of a rectangle, those of `asked` (a bit each) given to the library, all poisoned and padded.
class FootprintOutputs {
public:
    static constexpr unsigned all = 255;

    explicit FootprintOutputs(const texgen::FragmentRect& rect, unsigned asked = all, std::size_t misalignment = 0)
        : first_{Outputs(count_of(rect), asked & 15u, misalignment)},
          rest_{Outputs(count_of(rect), asked >> 4, misalignment)} {}

    texgen::Footprints spans() {
        const texgen::Texcoords a = first_.spans(), b = rest_.spans();
        return {.dsdx = a.s,
                .dtdx = a.t,
                .dsdy = a.r,
                .dtdy = a.lit,
                .level = b.s,
                .anisotropy = b.t,
                .major_s = b.r,
                .major_t = b.lit};
    }
    std::span<const float> operator[](std::size_t k) const { return k < 4 ? first_[k] : rest_[k - 4]; }
    double at(std::size_t k, std::size_t i) const { return static_cast<double>((*this)[k][i]); }
    bool asked(std::size_t k) const { return k < 4 ? first_.asked(k) : rest_.asked(k - 4); }
    bool is_untouched() const {
        for (std::size_t k = 0; k < 8; ++k)
            if (!Outputs::is_poison((*this)[k])) return false;
        return true;
    }
    bool pads_are_intact() const { return first_.pads_are_intact() && rest_.pads_are_intact(); }

private:
    Outputs first_, rest_;
};

}  // namespace support
