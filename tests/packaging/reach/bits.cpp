// What the exact tier gives must not depend on the compiler, its flags, the machine or the kernel: a digest of the bits
// of many results, against the one that is written here; and so of what is decided exactly, and of inverses as they are
// rounded. The inputs are integers times powers of two, so that they are the same floats everywhere, and of three kinds
// in turn: any; with a constant q and few bits, so that values stand in the
// middle of two floats; small, so that q is 0 now and then.

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <span>

#include <texgen/clip.hpp>
#include <texgen/coverage.hpp>
#include <texgen/fixed_function.hpp>
#include <texgen/linear.hpp>

#include "bits/inputs.hpp"
#include "bits/points.hpp"
#include "bits/results.hpp"
#include "bits/triangles.hpp"

namespace {

using namespace bits;

// Polygons cut at the camera's near plane, then at the slide, and put into the window.
std::uint64_t polygons(Classes& classes) {
    Random random(5);
    Digest digest;
    for (int round = 0; round < 900; ++round) {
        const Kind kind = kind_of(round);
        std::array<texgen::ClipVertex, 12> polygon, storage;
        const auto corners = static_cast<std::size_t>(random.integer(3, 4));
        for (std::size_t i = 0; i < corners; ++i) {
            const float x = random.unit(), y = random.unit(), z = random.unit();
            const float w = kind == Kind::zeros ? random.small() : 0.5f + random.unit();
            const glm::vec4 coordinates = strq(random, kind);
            polygon[i] = {glm::vec4(x, y, kind == Kind::zeros ? random.small() : z, w),
                          glm::vec4(coordinates.x + 0.5f, coordinates.y + 0.5f, coordinates.z, coordinates.w + 0.5f)};
        }
        const auto range = round % 2 == 0 ? texgen::DepthRange::zero_to_one : texgen::DepthRange::negative_one_to_one;
        const auto add_all = [&](std::size_t count) {
            digest.add(static_cast<float>(count));
            for (std::size_t i = 0; i < count; ++i)
                for (int k = 0; k < 4; ++k) digest.add(storage[i].position[k]), digest.add(storage[i].strq[k]);
        };
        const std::span<const texgen::ClipVertex> given(polygon.data(), corners);
        add_all(clip_to_slide(given, texgen::whole_texture(), storage));
        const std::size_t in_view = clip_to_near(given, storage, range, round % 5 == 0);
        add_all(in_view);
        for (std::size_t i = 0; i < in_view; ++i) {
            const texgen::WindowVertex vertex = to_window(storage[i], {3, 5, 1001, -701});
            digest.add(vertex.window.x);
            digest.add(vertex.window.y);
        }
        const std::size_t on_slide = clip_to_slide({storage.data(), in_view}, texgen::whole_texture(), storage);
        add_all(on_slide);
        ++(on_slide == 0 ? classes.behind : on_slide > corners ? classes.dark : classes.lit);
    }
    return digest.value();
}

// Boxes, most of them about the border of what is lit.
std::uint64_t bodies(Classes& classes) {
    Random random(6);
    Digest digest;
    for (int round = 0; round < 60; ++round) {
        const Kind kind = kind_of(round);
        const texgen::LitVolume<texgen::World> volume(texgen::WorldTexgen(matrix(random, kind)),
                                                      texgen::atlas_tile({-2.0, -2.0}, {2.0, 2.0}));
        std::array<texgen::Box, 75> boxes;
        for (texgen::Box& box : boxes) {
            for (int k = 0; k < 3; ++k) {
                const float middle = kind == Kind::any ? random.unit() : 0.25f * random.small();
                const float size = kind == Kind::any ? 0.5f * random.positive() : 0.25f * random.small();
                box.min[k] = middle - size;
                box.max[k] = middle + size;
            }
        }
        std::array<texgen::Coverage, 75> found;
        volume.coverage(boxes, found);
        for (const texgen::Coverage coverage : found) {
            digest.add(static_cast<float>(static_cast<int>(coverage)));
            ++(coverage == texgen::Coverage::outside   ? classes.behind
               : coverage == texgen::Coverage::partial ? classes.dark
                                                       : classes.lit);
        }
    }
    return digest.value();
}

// Inverses and stored eye planes as they are rounded, which two units of double hardly ever change; and which matrices
// are singular.
std::uint64_t inverses(Classes& classes) {
    Random random(7);
    Digest digest;
    for (int round = 0; round < 300; ++round) {
        const texgen::WorldTexgen planes(matrix(random, Kind::any));
        const glm::dmat4 regular = matrix(random, Kind::any);
        glm::dmat4 singular = regular;
        singular[3] = 2.0 * regular[0] - regular[1];
        for (const glm::dmat4& given : {regular, singular}) {
            const auto inverse = texgen::inverse(texgen::ModelMatrix(given));
            const auto stored = eye_planes_as_stored(planes, texgen::ViewMatrix(given));
            ++(inverse && stored ? classes.lit : classes.behind);
            digest.add(inverse && stored ? 1.0f : 0.0f);
            for (int k = 0; k < 16 && inverse && stored; ++k) {
                digest.add(inverse->rounded()[k / 4][k % 4]);
                digest.add(stored->rounded()[k / 4][k % 4]);
            }
        }
    }
    return digest.value();
}

// Whether eye planes of integers come back as they were: what is 0 among them is so to 2^-60 of the largest only where
// residuals have twice the digits.
bool are_integers_kept() {
    Random random(8);
    int singular = 0;
    for (int round = 0; round < 2000; ++round) {
        glm::dmat4 modelview;
        glm::dvec4 stored;
        for (int i = 0; i < 4; ++i) {
            stored[i] = static_cast<double>(random.small());
            for (int k = 0; k < 4; ++k) modelview[i][k] = static_cast<double>(random.small());
        }
        texgen::TexGenUnit unit;
        if (!unit.set_eye_plane(texgen::Coordinate::s, glm::vec4(stored * modelview), glm::mat4(modelview))) {
            ++singular;
            continue;
        }
        for (int i = 0; i < 4; ++i) {
            const auto value = static_cast<double>(unit.eye_plane(texgen::Coordinate::s)[i]);
            if (stored[i] != 0.0 ? value != stored[i] : value > 0x1p-58 || value < -0x1p-58) return false;
        }
    }
    return singular < 100;
}

bool holds = true;

void compare(const char* what, std::uint64_t (&digest_of)(Classes&), std::uint64_t expected) {
    Classes classes;
    const std::uint64_t digest = digest_of(classes);
    const bool same = digest == expected && classes.behind > 50 && classes.lit > 50;
    std::printf("%-20s %08lx%08lx, behind %d, dark %d, lit %d%s\n", what, static_cast<unsigned long>(digest >> 32),
                static_cast<unsigned long>(digest & 0xffffffff), classes.behind, classes.dark, classes.lit,
                same ? "" : ": not the bits of other builds");
    holds = holds && same;
}

}  // namespace

int main() {
#if defined(__x86_64__) && defined(__FMA__)
    if (!__builtin_cpu_supports("fma")) return 77;
#endif
    compare("points", points, 0xc74a43b09c6628d4);
    compare("homogeneous points", homogeneous_points, 0x6ee2268fe67029b3);
    compare("segments", segments, 0x8e812146eabb3761);
    compare("triangles", triangles, 0xe2857cdbe2c5b2e3);
    compare("polygons", polygons, 0xce0ff08cf94bc6dd);
    compare("bodies", bodies, 0x2e85bbd30985cf48);
    compare("inverses", inverses, 0xdc50a6ad49ba5418);
    const bool are_kept = are_integers_kept();
    if (!are_kept) std::puts("eye planes: integers do not come back");
    if (!same_in_all_layouts) std::puts("points: the layouts disagree");
    if (!same_in_batches) std::puts("triangles: in a batch they have other bits than alone, or no aligned memory");
    return holds && are_kept && same_in_all_layouts && same_in_batches ? 0 : 1;
}
