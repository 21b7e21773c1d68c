// All headers that need no Eigen, in one file: for compilers and dialects that the tests of their results do not reach.

#ifdef _WIN32
// It makes macros of short words; of min and max too, where the standard library stands it. MinGW's does not, and so
// comes first here.
#include <windows.h>

#include <bits/stdc++.h>
#define min(a, b) (((a) < (b)) ? (a) : (b))
#define max(a, b) (((a) > (b)) ? (a) : (b))
#else
// What it makes macros of, and what <sys/types.h> does on macOS and the BSDs, X11 and macOS's <AssertMacros.h>; and
// <X11/Xos.h>, behind what declares functions of that name.
#define near
#define far
#define small char
#define major(device) device
#define minor(device) device
#define TileShape 1
#define require(assertion, label) ((void)0)
#include <cstring>
#include <string>
#include <variant>
#define index(s, c) strchr((s), (c))
#endif

#include <texgen/batch.hpp>
#include <texgen/clip.hpp>
#include <texgen/conventions.hpp>
#include <texgen/coverage.hpp>
#include <texgen/diagnose.hpp>
#include <texgen/fixed_function.hpp>
#include <texgen/footprint.hpp>
#include <texgen/interpolate.hpp>
#include <texgen/linear.hpp>
#include <texgen/primitives.hpp>
#include <texgen/projector.hpp>
#include <texgen/scale_bias.hpp>
#include <texgen/scene.hpp>
#include <texgen/texcoord.hpp>
#include <texgen/texgen.hpp>
#include <texgen/transform.hpp>

// What is a template is compiled for a call.
void call(const texgen::ObjectTexgen& texgen, texgen::Positions<texgen::Object> points, const texgen::Texcoords& out,
          const texgen::Footprints& footprints, std::span<const texgen::Box> boxes,
          std::span<texgen::Coverage> coverages, std::span<texgen::ClipVertex> polygon) {
    using namespace texgen;
    project(texgen, points, whole_texture(), out);
    generate(texgen, points, HomogeneousTexcoords{out.s, out.t, out.r, out.lit});
    coverage(texgen, whole_texture(), boxes, coverages);
    clip_to_slide(polygon.first(3), whole_texture(), polygon);
    if (const auto setup = TriangleSetup::of({}, whole_texture(), exact)) {
        interpolate(*setup, {0, 0, 1, 1}, out);
        footprint(FootprintSetup(*setup, {1.0, 1.0}), {0, 0, 1, 1}, footprints);
    }
    TriangleBatch batch(whole_texture());
    batch.assign({});
    interpolate(batch, std::span<const FragmentRect>(), out);
    interpolate(batch, std::span<const std::uint32_t>(), {0, 0, 0, 0}, out);
    footprint(batch, {}, {0, 0, 0, 0}, {1.0, 1.0}, footprints);
    interpolate(Segment{}, out.s, whole_texture(), out);
    diagnose(texgen);
    diagnose(planes(texgen));
    Scene().update({}, {});
}

int main() { return 0; }
