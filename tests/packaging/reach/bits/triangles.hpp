#pragma once

// The digest of triangles, alone and in batches.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#ifdef WITH_BATCHES
#include <texgen/batch.hpp>
#endif
#include <texgen/interpolate.hpp>

#include "inputs.hpp"
#include "results.hpp"

namespace bits {

inline bool same_in_batches = true;

// Two triangles and their rectangles in one batch, and the first rectangle's fragments by ids.
struct InBatch {
    texgen::Triangle triangle[2];
    texgen::FragmentRect rect[2];
    Outputs alone[2] = {Outputs(0), Outputs(0)};
};

inline bool same_in_a_batch([[maybe_unused]] const InBatch& given) {
    bool is_same = true;
#ifdef WITH_BATCHES
    // Somewhere else each time.
    static std::vector<std::vector<char>> others;
    if (others.size() < 16) others.emplace_back(24);
    texgen::TriangleBatch batch(boundless);
    batch.assign(given.triangle);
    is_same = is_same && reinterpret_cast<std::uintptr_t>(texgen::detail::Inside::planes(batch)) %
                                 alignof(decltype(*texgen::detail::Inside::planes(batch))) ==
                             0;
    Outputs all(given.alone[0].count + given.alone[1].count);
    if (all.count <= most) {
        interpolate(batch, given.rect, all.spans());
        for (std::size_t i = 0; i < all.count; ++i) {
            const std::size_t from = i < given.alone[0].count ? 0 : given.alone[0].count;
            const Outputs& alone = given.alone[from == 0 ? 0 : 1];
            is_same = is_same && all.s[i] == alone.s[i - from] && all.t[i] == alone.t[i - from] &&
                      all.r[i] == alone.r[i - from] && all.lit[i] == alone.lit[i - from];
        }
    }
    const texgen::FragmentRect& rect = given.rect[0];
    Outputs second(given.alone[0].count), by_id(second.count);
    if (const auto setup = texgen::TriangleSetup::of(given.triangle[1], boundless))
        interpolate(*setup, rect, second.spans());
    std::array<std::uint32_t, most> ids;
    for (std::size_t i = 0; i < second.count; ++i) ids[i] = i % 7 < 3 ? 1 : 0;
    interpolate(batch, std::span<const std::uint32_t>(ids.data(), by_id.count), rect, by_id.spans());
    for (std::size_t i = 0; i < by_id.count; ++i) {
        const Outputs& alone = ids[i] == 0 ? given.alone[0] : second;
        is_same = is_same && by_id.s[i] == alone.s[i] && by_id.t[i] == alone.t[i] && by_id.r[i] == alone.r[i] &&
                  by_id.lit[i] == alone.lit[i];
    }
#endif
    return is_same;
}

// A rectangle behind an empty one, of so many fragments that it is left to a set-up, stands in its place.
inline bool is_placed_behind_an_empty_one([[maybe_unused]] const texgen::Triangle& triangle) {
    bool is_same = true;
#ifdef WITH_BATCHES
    std::vector<texgen::FragmentRect> rects(40, {0, 0, 2, 2});
    rects[3] = {0, 0, 0, 4};
    rects.back() = {0, 0, 64, 65};
    const std::size_t large = 64 * 65, before = 4 * (rects.size() - 2);
    std::vector<float> all(before + large, -777.0f), alone(large);
    texgen::TriangleBatch batch(boundless);
    batch.assign(std::vector<texgen::Triangle>(rects.size(), triangle));
    interpolate(batch, rects, {all, {}, {}, {}});
    if (const auto setup = texgen::TriangleSetup::of(triangle, boundless))
        interpolate(*setup, rects.back(), {alone, {}, {}, {}});
    for (std::size_t i = 0; i < large; ++i) is_same = is_same && all[before + i] == alone[i];
#endif
    return is_same;
}

inline std::uint64_t triangles(Classes& classes) {
    Random random(4);
    Digest digest;
    InBatch last{};
    for (int round = 0; round < 150; ++round) {
        const Kind kind = kind_of(round);
        const auto vertex = [&](int x, int y) {
            texgen::WindowVertex corner;
            const float w = 1.0f + 3.0f * random.positive();
            corner.window = glm::vec2(static_cast<float>(x) * 0x1p-4f, static_cast<float>(y) * 0x1p-4f);
            corner.clip_w = kind == Kind::any ? w : 1.0f;
            corner.strq = strq(random, kind);
            return corner;
        };
        // Where the other two kinds need them, sides whose area is a power of two.
        const auto anywhere = [&](int otherwise) {
            const int window = random.integer(-(1 << 12), 1 << 12);
            return kind == Kind::any ? window : otherwise;
        };
        const int ax = anywhere(0), ay = anywhere(0), bx = anywhere(1 << 11), by = anywhere(0);
        const int cx = anywhere(0), cy = anywhere(1 << 11);
        const texgen::WindowVertex a = vertex(ax, ay), b = vertex(bx, by), c = vertex(cx, cy);
        const texgen::Triangle triangle{a, b, c};
        const int width = random.integer(1, 120), height = random.integer(1, 8);
        const int x = random.integer(-100, 50), y = random.integer(-100, 50);
        const texgen::FragmentRect rect{x, y, width, height};
        const auto interpolated = [&](texgen::TextureRegion region) {
            Outputs out(static_cast<std::size_t>(width * height));
            if (const auto setup = texgen::TriangleSetup::of(triangle, region)) interpolate(*setup, rect, out.spans());
            return out;
        };
        const Outputs everywhere = interpolated(boundless);
        add(digest, classes, everywhere, interpolated(texgen::whole_texture()));
        InBatch given{{triangle, last.triangle[0]}, {rect, last.rect[0]}, {everywhere, last.alone[0]}};
        same_in_batches = same_in_batches && same_in_a_batch(given) && is_placed_behind_an_empty_one(triangle);
        last = given;
    }
    return digest.value();
}

}  // namespace bits
