// What a user keeps in a struct, and hands to functions of his own by reference: each passes members of it on. GCC 12
// takes a member that is passed by value out of a reference for unread (its bug 115033): linked with -flto it leaves out
// what the caller has written there, so that no function of the library takes an aggregate by value, which the
// floors' check holds. Of the headers that take members of a light such functions are called; the light is a local
// variable, written anew for each call.

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <span>

#include <texgen/batch.hpp>
#include <texgen/diagnose.hpp>
#include <texgen/texgen.hpp>

namespace {

using namespace texgen;

struct Light {
    Projector projector;
    Projector camera;
    Conventions conventions;
    TextureRegion region;
    Tolerance tolerance;
    PerspectiveLens lens;
    Aim aim;
    Viewport viewport;
    FragmentRect rect;
    TexelsPerUnit texels;
    Triangle triangle;
    Segment segment;
    Box box;
    Sphere sphere;
    glm::vec3 point;
    glm::vec4 a, b, c;
    glm::dvec2 min, max;
    std::span<const glm::vec3> points;
    std::span<const float> alpha;
    std::span<const std::uint32_t> ids;
    std::span<const ClipVertex> polygon;
    Positions<World> positions;
    Texcoords texcoords;
    Footprints footprints;
};

const glm::vec3 some_points[] = {{0.1f, 0.2f, 0.3f}, {-0.3f, 0.1f, -0.5f}, {1.1f, 0.4f, 0.2f}};
const float some_alpha[] = {0.25f, 0.5f, 0.875f};
const std::uint32_t some_ids[] = {0, 0, 0};
const ClipVertex some_polygon[] = {{{0.0f, 0.0f, 0.5f, 1.0f}, {0.1f, 0.2f, 0.3f, 1.0f}},
                                   {{1.0f, 0.0f, 0.25f, 1.0f}, {2.9f, 0.5f, 0.75f, 2.0f}},
                                   {{0.0f, 1.0f, -4.0f, 1.0f}, {0.5f, 1.5f, 0.25f, 1.5f}}};
constexpr float unwritten = 7.0f;
float written[8][3];

// Inlined, so that all members are written where a call is made.
[[gnu::always_inline]] inline Light light(const Projector& projector) {
    const auto out = [](std::size_t i) { return std::span<float>(written[i]); };
    return {.projector = projector,
            .camera = projector,
            .conventions = vulkan,
            .region = atlas_tile({0.125, 0.25}, {0.875, 0.75}).with_depth(0.125, 0.984375),
            .tolerance = Tolerance{0x1p-12},
            .lens = {.fovy = degrees(40.0), .aspect = 1.5, .z_near = 0.25, .z_far = 100.0},
            .aim = {.position = {1, 2, 4}, .target = {0, 0.5, 0}, .up = {0, 1, 0}},
            .viewport = {10, 20, 640, 480},
            .rect = {3, 4, 3, 1},
            .texels = {1024.0, 512.0},
            .triangle = {{{0.0f, 0.0f}, 1.0f, {0.1f, 0.2f, 0.3f, 1.0f}},
                         {{40.0f, 0.0f}, 3.0f, {2.9f, 0.5f, 0.75f, 2.0f}},
                         {{0.0f, 30.0f}, 2.0f, {0.5f, 1.5f, 0.25f, 1.5f}}},
            .segment = {{0.1f, 0.2f, 0.3f, 1.0f}, {2.9f, 0.5f, 0.75f, 2.0f}},
            .box = {glm::vec3(-0.25f), glm::vec3(0.25f)},
            .sphere = {glm::vec3(0.125f), 0.25f},
            .point = {0.3f, 0.1f, 0.2f},
            .a = {0.1f, 0.2f, 0.3f, 1.0f},
            .b = {2.9f, 0.5f, 0.75f, 2.0f},
            .c = {0.5f, 1.5f, 0.25f, 1.5f},
            .min = {0.125, 0.0},
            .max = {0.5, 1.0},
            .points = some_points,
            .alpha = some_alpha,
            .ids = some_ids,
            .polygon = some_polygon,
            .positions = world_space(some_points),
            .texcoords = {out(0), out(1), out(2), out(3)},
            .footprints = {out(0), out(1), out(2), out(3), out(4), out(5), out(6), out(7)}};
}

void print(double value) { std::printf(" %a", value); }
void print(bool value) { std::printf(" %d", value ? 1 : 0); }
void print(const glm::vec4& v) {
    for (glm::length_t i = 0; i < 4; ++i) print(static_cast<double>(v[i]));
}
void print(const glm::dvec4& v) {
    for (glm::length_t i = 0; i < 4; ++i) print(v[i]);
}
void print(const glm::dvec2& v) { print(v.x), print(v.y); }
void print(const glm::vec2& v) { print(glm::dvec2(v)); }
void print(const glm::dvec3& v) { print(glm::dvec2(v)), print(v.z); }
void print(const glm::dmat4& m) {
    for (glm::length_t i = 0; i < 4; ++i) print(m[i]);
}
template <class To, class From>
void print(const Transform<To, From>& transform) {
    print(transform.matrix());
}
void print(const Projector& projector) { print(projector.projection), print(projector.view); }
void print(const TextureRegion& region) {
    print((region.min)()), print((region.max)()), print(region.depth().value_or(glm::dvec2(-1.0)));
}
void print(Work work) { std::printf(" work %d", static_cast<int>(work)); }
void print(Coverage coverage) { std::printf(" coverage %d", static_cast<int>(coverage)); }
void print(Facing facing) { std::printf(" facing %d", static_cast<int>(facing)); }
void print(std::size_t count) { std::printf(" %zu", count); }
void print(const Diagnosis& diagnosis) {
    for (const Finding& finding : diagnosis) std::printf(" defect %d", static_cast<int>(finding.defect));
}
template <class Value>
void print(const std::optional<Value>& value) {
    print(value.has_value());
    if (value) print(*value);
}
// What was written by the last call: a digit, as bits within a tolerance may be those of the build.
void print_written() {
    for (auto& output : written)
        for (float& value : output) {
            if (value != unwritten) std::printf(" %.1f", static_cast<double>(value) + 0.0125);
            value = unwritten;
        }
}

ModelMatrix model() { return ModelMatrix(glm::dmat4(2.0)); }
WorldTexgen texgen_of(const Light& light) { return texture_from_world(light.projector); }

#define ASK(NAME, ...) \
    [[gnu::noinline]] auto NAME(const Light& l) { return __VA_ARGS__; }
#define WRITE(NAME, ...)                          \
    [[gnu::noinline]] bool NAME(const Light& l) { \
        __VA_ARGS__;                              \
        return true;                              \
    }

ASK(ask_projector, make_projector(l.lens, l.aim, l.conventions))
ASK(ask_perspective, perspective(l.lens, l.conventions))
ASK(ask_refusal, diagnose(PerspectiveLens{.fovy = degrees(400.0), .aspect = -1.0, .z_near = 1.0, .z_far = 2.0}, l.aim,
                          l.conventions))
ASK(ask_left_handed, left_handed(l.conventions).handedness == Handedness::left)
ASK(ask_cover, cover(l.lens, 2.0, l.region))
ASK(ask_tile, atlas_tile(l.min, l.max))
ASK(ask_depth, l.region.with_depth(l.conventions, DepthMapping::ndc))
ASK(ask_scale_bias, scale_bias(l.conventions, l.region))
ASK(ask_to_texture, to_texture(l.b, l.conventions, l.region))
ASK(ask_world, texture_from_world(l.projector, l.region))
ASK(ask_object, object_linear(l.projector, model(), l.region))
ASK(ask_eye, eye_linear(l.projector, CameraPose(glm::dmat4(1.0)), l.region))
ASK(ask_window, window_linear(l.projector, l.camera, l.viewport, l.region))
ASK(ask_divided, divide(l.b))
ASK(ask_point, project(texgen_of(l), world_space(l.point)))
ASK(ask_project_bound, project_error_bound(texgen_of(l), l.positions, l.tolerance))
ASK(ask_work, work(l.segment, l.region, l.tolerance))
ASK(ask_segment_bound, error_bound(l.segment, l.tolerance))
ASK(ask_setup, TriangleSetup::of(l.triangle, l.region, l.tolerance)->work(l.rect))
ASK(ask_bound, TriangleSetup::of(l.triangle, l.region, l.tolerance)->error_bound(l.rect))
ASK(ask_footprint_bound, FootprintSetup(*TriangleSetup::of(l.triangle, l.region), l.texels).error_bound(l.rect))
ASK(ask_level, FootprintSetup(*TriangleSetup::of(l.triangle, l.region), l.texels).extremes(l.rect)->largest_level)
ASK(ask_facing, facing(l.a, l.b, l.c, TextureOrigin::top_left))
ASK(ask_area, slide_area(l.a, l.b, l.c))
ASK(ask_plane, receiver_plane(l.a, l.b, l.c))
ASK(ask_box, coverage(texgen_of(l), l.region, l.box))
ASK(ask_sphere, coverage(texgen_of(l), l.region, l.sphere))
ASK(ask_volume, LitVolume(texgen_of(l), l.region).coverage(l.box))
ASK(ask_planes, [&] {
    const ClipPlanes planes = clip_planes(texgen_of(l), l.region);
    return glm::dvec4(*planes.begin());
}())
WRITE(write_generated, generate(texgen_of(l), l.positions, HomogeneousTexcoords{l.texcoords.s, l.texcoords.t, {}, {}}))
WRITE(write_points, project(texgen_of(l), l.positions, l.region, l.texcoords, l.tolerance))
WRITE(write_span, project(texgen_of(l), world_space(l.points), l.region, l.texcoords, l.tolerance))
WRITE(write_segment, interpolate(l.segment, l.alpha, l.region, l.texcoords, l.tolerance))
WRITE(write_triangle, interpolate(*TriangleSetup::of(l.triangle, l.region), l.rect, l.texcoords))
WRITE(write_footprint,
      footprint(FootprintSetup(*TriangleSetup::of(l.triangle, l.region), l.texels), l.rect, l.footprints))
WRITE(write_batch, TriangleBatch batch(l.region, l.tolerance); batch.assign({&l.triangle, 1});
      interpolate(batch, std::span(&l.rect, 1), l.texcoords))
WRITE(write_ids, TriangleBatch batch(l.region, l.tolerance); batch.assign({&l.triangle, 1});
      interpolate(batch, l.ids, l.rect, l.texcoords))
WRITE(write_footprint_of_ids, TriangleBatch batch(l.region, l.tolerance); batch.assign({&l.triangle, 1});
      footprint(batch, l.ids, l.rect, l.texels, l.footprints))
WRITE(clip_slide, ClipVertex out[16]; const std::size_t count = clip_to_slide(l.polygon, l.region, out); print(count);
      for (std::size_t i = 0; i < count; ++i) print(out[i].strq))
WRITE(clip_near, ClipVertex out[8]; const std::size_t count = clip_to_near(l.polygon, out, l.conventions.depth);
      print(count); for (std::size_t i = 0; i < count; ++i) print(out[i].strq))

#define RUN(NAME)                             \
    {                                         \
        std::printf(#NAME);                   \
        const Light here = light(*projector); \
        print(NAME(here));                    \
        print_written();                      \
        std::printf("\n");                    \
    }

}  // namespace

int main() {
    for (auto& output : written)
        for (float& value : output) value = unwritten;
    const auto projector =
        make_projector(PerspectiveLens{.fovy = degrees(30.0), .aspect = 1.25, .z_near = 0.25, .z_far = 50.0},
                       Aim{.position = {2, 5, 5}, .target = {0, 0, 0}, .up = {0, 1, 0}}, opengl);
    if (!projector) return 1;
    RUN(ask_projector)
    RUN(ask_perspective)
    RUN(ask_refusal)
    RUN(ask_left_handed)
    RUN(ask_cover)
    RUN(ask_tile)
    RUN(ask_depth)
    RUN(ask_scale_bias)
    RUN(ask_to_texture)
    RUN(ask_world)
    RUN(ask_object)
    RUN(ask_eye)
    RUN(ask_window)
    RUN(ask_divided)
    RUN(ask_point)
    RUN(ask_project_bound)
    RUN(ask_work)
    RUN(ask_segment_bound)
    RUN(ask_setup)
    RUN(ask_bound)
    RUN(ask_footprint_bound)
    RUN(ask_level)
    RUN(ask_facing)
    RUN(ask_area)
    RUN(ask_plane)
    RUN(ask_box)
    RUN(ask_sphere)
    RUN(ask_volume)
    RUN(ask_planes)
    RUN(write_generated)
    RUN(write_points)
    RUN(write_span)
    RUN(write_segment)
    RUN(write_triangle)
    RUN(write_footprint)
    RUN(write_batch)
    RUN(write_ids)
    RUN(write_footprint_of_ids)
    RUN(clip_slide)
    RUN(clip_near)
}
