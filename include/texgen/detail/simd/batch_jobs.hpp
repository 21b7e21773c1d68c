#pragma once

// What the kernels of a batch of triangles are given and what they return; see detail/kernels/batch_*.inc.hpp.

#include <cstddef>
#include <cstdint>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "../arithmetic/rounding.hpp"
#include "../arithmetic/widen.hpp"
#include "../language.hpp"
#include "jobs.hpp"

namespace TEXGEN_DETAIL {

// So many triangles are made ready, or tiles divided, at once.
inline constexpr std::size_t batch_block = 8;

// A vertex as the kernels read it: x, y, w and from `strq` on s, t, r, q, `size` floats in all. They load eight.
struct BatchVertex {
    struct Layout {
        glm::vec2 window;
        float clip_w;
        glm::vec4 strq;
    };
    static constexpr std::size_t size = sizeof(Layout) / sizeof(float);
    static constexpr std::size_t strq = size - 4;
};

// The linear functions of a triangle (triangle/planes.hpp), each as base, dx, dy about the vertex of the largest w, and
// e: at (x, y) from there it errs by at most e (1 + |x| per_reach[0] + |y| per_reach[1]). In whole vectors: the last
// four are 0.
struct alignas(64) BatchPlanes {
    static constexpr std::size_t s = 0, t = 4, q = 8, origin = 12, per_reach = 14, r = 16, count = 24;
    static constexpr std::size_t of_coordinate[4] = {s, t, r, q};
    static constexpr double margin = 8.0;  // pixels: a small tile may reach beyond the vertices by about its own size

    double value[count];

    // Whether it is behind everywhere without a doubt, as is what is refused.
    bool is_behind() const noexcept {
        return value[q] < 0.0 && value[q + 1] == 0.0 && value[q + 2] == 0.0 && value[q + 3] == 0.0;
    }
};

// The error of a plane, of the magnitudes of its terms: see TrianglePlanes::error().
inline constexpr double batch_plane_error = 1.0001 * gamma(20);

// Tiles of more fragments than largest_batch_tile are left to a TriangleSetup, which costs little beside them and
// resumes where one is in doubt; so are those that scratch does not hold, if they need it or are in doubt.
inline constexpr std::size_t largest_batch_tile = 4096;
inline constexpr std::size_t largest_in_scratch = 512;

// Where the values of fragments go: an output is null, or an array of `count` floats.
struct BatchOutputs {
    float* out[3];
    float* lit;
    std::size_t count;
    float min[2], max[2];  // the region
    bool has_depth;
    float r_min, r_max;

    // Whether they have more floats than that.
    bool are_beyond(std::int64_t floats) const noexcept {
        std::size_t arrays = lit != nullptr ? 1 : 0;
        for (const float* const array : out) arrays += array != nullptr ? 1 : 0;
        return count * arrays > static_cast<std::size_t>(floats);
    }
};

// r is computed where it has an output, and for the depth of a mask.
struct BatchJob : BatchOutputs {
    const BatchPlanes* planes;
    const float* vertices;
    double tolerance;
    double least[3], greatest[3];  // the limits of s, t and r as finite numbers

    bool needs_r() const noexcept { return out[2] != nullptr || (has_depth && lit != nullptr); }
};

// A tile of each triangle: x, y, width, height. Their values follow one another.
struct TilesJob : BatchJob {
    const int (*tiles)[4];
    std::size_t tile_count;
};

// Triangle ids[k] of `triangles` at fragment k of a rectangle; any other id is no triangle.
struct VisibilityBuffer {
    const std::uint32_t* ids;
    std::uint32_t triangles;
    int x, y, width;
};

// planes[triangles] stands for ids that are no triangle.
struct FragmentsJob : BatchJob, VisibilityBuffer {};

// The footprints of a visibility buffer.
struct BatchFootprintsJob : VisibilityBuffer, FootprintArrays {
    const BatchPlanes* planes;
    const float* vertices;
    std::size_t count;
    double texels[2];  // per unit of s and t
    float per_texel[2];
};

// The column or row of a tile that holds an edge along which s, t or r of a triangle is 0; -1 where there is none.
struct ZerosOfTile {
    int column[3] = {-1, -1, -1}, row[3] = {-1, -1, -1};

    TEXGEN_APART ZerosOfTile(const float* triangle, const int (&tile)[4]) noexcept {
        for (std::size_t i = 0; i < 3; ++i) {
            const float* const from = triangle + i * BatchVertex::size;
            const float* const to = triangle + (i + 1) % 3 * BatchVertex::size;
            for (std::size_t axis = 0; axis < 2; ++axis) {
                if (from[axis] != to[axis]) continue;
                const int index = index_at(detail::widened(from[axis]), tile[axis], tile[2 + axis]);
                for (std::size_t k = 0; k < 3; ++k)
                    if (index >= 0 && from[BatchVertex::strq + k] == 0.0f && to[BatchVertex::strq + k] == 0.0f)
                        (axis == 0 ? column : row)[k] = index;
            }
        }
    }
};

struct BatchKernels {
    // Makes a block ready; reads a float behind its last vertex. Returns a bit for each triangle that is not known.
    unsigned (*set_up)(const float* triangles, BatchPlanes* planes) noexcept;
    // From tile `first` on, which begins a block, with values from `done` on. Stops at a block with tiles in doubt.
    Undecided (*divide_tiles)(const TilesJob& job, std::size_t first, std::size_t done) noexcept;
    Undecided (*divide_fragments)(const FragmentsJob& job, std::size_t first) noexcept;
};

struct BatchFootprintKernels {
    Undecided (*fill)(const BatchFootprintsJob& job, std::size_t first) noexcept;
};

}  // namespace TEXGEN_DETAIL
