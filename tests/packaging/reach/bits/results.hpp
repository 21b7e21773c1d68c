#pragma once

// Results and the digest of their bits.

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include <texgen/texcoord.hpp>

namespace bits {

// FNV-1a of the floats' bits, the low byte first.
class Digest {
public:
    void add(float value) {
        std::uint32_t bits;
        std::memcpy(&bits, &value, sizeof bits);
        for (int shift = 0; shift < 32; shift += 8) value_ = (value_ ^ (bits >> shift & 0xff)) * 0x100000001b3u;
    }
    std::uint64_t value() const { return value_; }

private:
    std::uint64_t value_ = 0xcbf29ce484222325u;
};

inline constexpr std::size_t most = 1024;

// Outputs, all 0 before: where nothing is in front of the projector none but the mask is written.
struct Outputs {
    std::size_t count;
    std::array<float, most> s{}, t{}, r{}, lit{};

    explicit Outputs(std::size_t size) : count(size) {}
    texgen::Texcoords spans() { return {{s.data(), count}, {t.data(), count}, {r.data(), count}, {lit.data(), count}}; }
    bool operator==(const Outputs&) const = default;
};

// How often each class of results came up: the digest of nothing proves nothing.
struct Classes {
    int behind = 0, dark = 0, lit = 0;
};

inline void add(Digest& digest, Classes& classes, const Outputs& everywhere, const Outputs& on_slide) {
    for (std::size_t i = 0; i < everywhere.count; ++i) {
        digest.add(everywhere.s[i]);
        digest.add(everywhere.t[i]);
        digest.add(everywhere.r[i]);
        digest.add(everywhere.lit[i]);
        const bool lit = on_slide.lit[i] == 1.0f;
        digest.add(on_slide.lit[i]);
        // Where nothing is lit, a whole rectangle may be left alone.
        digest.add(lit ? on_slide.s[i] : 0.0f);
        digest.add(lit ? on_slide.t[i] : 0.0f);
        ++(everywhere.lit[i] == 0.0f ? classes.behind : lit ? classes.lit : classes.dark);
    }
}

inline const texgen::TextureRegion boundless = texgen::atlas_tile({-0x1p120, -0x1p120}, {0x1p120, 0x1p120});

}  // namespace bits
