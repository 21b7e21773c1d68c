#pragma once

// The fragments of a rectangle against the contract, and what came up among them.

#include <cmath>
#include <cstddef>
#include <limits>
#include <string>

#include "judges/exact.hpp"
#include "judges/verdict.hpp"
#include "support/outputs.hpp"
#include "support/shot.hpp"
#include "texgen/interpolate.hpp"

namespace support {

// So large that whatever is in front is lit.
constexpr texgen::TextureRegion everywhere() {
    constexpr double huge = std::numeric_limits<double>::infinity();
    return texgen::atlas_tile({-huge, -huge}, {huge, huge});
}

inline std::size_t count_of(const texgen::FragmentRect& rect) {
    return static_cast<std::size_t>(rect.width) * static_cast<std::size_t>(rect.height);
}

// How often each case came up, so that a test can say that it did.
struct Seen {
    int in_front = 0, behind = 0, on_plane = 0, subnormal = 0, infinite = 0, lit = 0, dark = 0, nothing = 0;

    Seen& operator+=(const Seen& other) {
        in_front += other.in_front;
        behind += other.behind;
        on_plane += other.on_plane;
        subnormal += other.subnormal;
        infinite += other.infinite;
        lit += other.lit;
        dark += other.dark;
        nothing += other.nothing;
        return *this;
    }
};

// Empty where fragment i of the rectangle is what it must be; otherwise what is wrong with it.
inline std::string what_is_wrong(const Shot& shot, const ExactTriangle& exact, const texgen::TextureRegion& region,
                                 texgen::Tolerance tolerance, texgen::Work work, const Outputs& out, std::size_t i,
                                 Seen& seen) {
    const auto [x, y] = shot.fragment(i);
    if (!exact.has_positive_w(x, y)) return {};
    const Homogeneous at = exact.at(x, y);
    ++(at.q.sign() > 0 ? seen.in_front : at.q.sign() < 0 ? seen.behind : seen.on_plane);
    std::string wrong;
    if (work == texgen::Work::nothing) {
        ++seen.nothing;
        for (std::size_t k = 0; k < 3; ++k)
            if (!Outputs::is_poison(out[k][i])) wrong = "nothing was to be done, and was written";
        if (out.asked(3) && !same_bits(out.lit()[i], 0.0f)) wrong = "nothing was to be done, and lit is not 0";
    } else {
        wrong = what_is_wrong(at, region, tolerance, out, i);
        seen.subnormal += std::fpclassify(out.s()[i]) == FP_SUBNORMAL;
        seen.infinite += std::isinf(out.s()[i]);
    }
    if (out.asked(3)) ++(out.lit()[i] == 1.0f ? seen.lit : seen.dark);
    if (wrong.empty()) return {};
    return "fragment " + std::to_string(x) + " " + std::to_string(y) + ": " + wrong;
}

// The same for all fragments of the rectangle, or for each `step`th from `first` on.
inline std::string first_wrong(const Shot& shot, const ExactTriangle& exact, const texgen::TextureRegion& region,
                               texgen::Tolerance tolerance, texgen::Work work, const Outputs& out, Seen& seen,
                               std::size_t first = 0, std::size_t step = 1) {
    for (std::size_t i = first; i < out.size(); i += step) {
        const std::string wrong = what_is_wrong(shot, exact, region, tolerance, work, out, i, seen);
        if (!wrong.empty()) return wrong;
    }
    return {};
}

// Precondition: the triangle can be set up; a std::bad_optional_access fails the test.
inline texgen::TriangleSetup setup_of(const texgen::Triangle& triangle,
                                      const texgen::TextureRegion& region = everywhere(),
                                      texgen::Tolerance tolerance = texgen::exact) {
    return texgen::TriangleSetup::of(triangle, region, tolerance).value();
}

// With a side next to the coordinates of a fragment of the rectangle, at one of its corners more often than not.
inline texgen::TextureRegion region_at(const Shot& shot, const ExactTriangle& exact, Random& random) {
    const auto somewhere = [&](int length) {
        return random.integer(0, 2) == 0 ? random.integer(0, length - 1) : random.coin() ? 0 : length - 1;
    };
    const Homogeneous at = exact.at(shot.x(somewhere(shot.rect.width)), shot.y(somewhere(shot.rect.height)));
    return at.q.sign() > 0 ? region_about(at, random) : texgen::whole_texture();
}

}  // namespace support
