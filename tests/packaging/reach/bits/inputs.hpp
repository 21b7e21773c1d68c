#pragma once

// Inputs that are the same floats everywhere: integers times powers of two, of three kinds.

#include <cstdint>

#include <texgen/transform.hpp>

namespace bits {

// splitmix64 (Steele, Lea, Flood 2014).
class Random {
public:
    explicit Random(std::uint64_t seed) : state_(seed) {}

    std::uint64_t bits() {
        std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31);
    }
    // In [low, high].
    int integer(int low, int high) {
        return low + static_cast<int>(bits() % static_cast<std::uint64_t>(std::int64_t{high} - low + 1));
    }
    // In [-1, 1], a multiple of 2^-20.
    float unit() { return static_cast<float>(integer(-(1 << 20), 1 << 20)) * 0x1p-20f; }
    // In (0, 1].
    float positive() { return static_cast<float>(integer(1, 1 << 20)) * 0x1p-20f; }
    // A small integer.
    float small() { return static_cast<float>(integer(-4, 4)); }

private:
    std::uint64_t state_;
};

enum class Kind { any, middles, zeros };
inline Kind kind_of(int round) { return static_cast<Kind>(round % 3); }

// A matrix of the kind, with a q that is constant for `middles`.
inline glm::dmat4 matrix(Random& random, Kind kind) {
    glm::dmat4 m;
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            m[column][row] = kind == Kind::any                 ? random.integer(-(1 << 30), 1 << 30) * 0x1p-28
                             : kind == Kind::zeros || row != 3 ? random.integer(-16, 16) * 0x1p-2
                                                               : (column == 3 ? 1.0 : 0.0);
    return m;
}

inline glm::vec4 strq(Random& random, Kind kind) {
    const auto coordinate = [&] { return kind == Kind::zeros ? random.small() : random.unit(); };
    const float s = coordinate(), t = coordinate(), r = coordinate(), q = coordinate();
    return glm::vec4(s, t, r, kind == Kind::middles ? 1.0f : q);
}

}  // namespace bits
