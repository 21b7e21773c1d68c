// The README's shaders, as they are written there, compiled and run by a real OpenGL and compared with what the library
// computes for the same fragments. Skipped (exit 77) where there is none. Each shader is broken as well, in the ways
// that users break them, and the comparison must notice.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "support/opengl.hpp"
#include "support/opengl_fragments.hpp"
#include "support/random.hpp"
#include "texgen/clip.hpp"
#include "texgen/footprint.hpp"
#include "texgen/interpolate.hpp"
#include "texgen/linear.hpp"
#include "texgen/reference.hpp"

namespace {

namespace gl = support::gl;
using support::Random;
using support::rounded;

constexpr float nothing = -1e30f;
constexpr int width = gl::Context::width, height = gl::Context::height;
constexpr std::size_t pixel_count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);

const glm::vec3 surface(0.5f, 0.75f, 1.0f), border(0.125f, 0.25f, 3.0f);
constexpr float bias = 0.002f;

// The README's text

enum Shader : std::size_t { vertex, slide, gradients, shadow, deferred, shader_count };

const std::vector<std::string>& shaders() {
    static const std::vector<std::string> blocks = [] {
        std::vector<std::string> result;
        std::ifstream readme(TEXGEN_TEST_DATA "/../README.md");
        bool is_open = false;
        for (std::string line; std::getline(readme, line);) {
            if (line == "```glsl") {
                result.emplace_back();
                is_open = true;
            } else if (line == "```") {
                is_open = false;
            } else if (is_open) {
                result.back() += line + '\n';
            }
        }
        REQUIRE(result.size() == shader_count);
        return result;
    }();
    return blocks;
}

struct Change {
    std::string from, to;
};

std::string changed(const std::string& source, const Change& change) {
    const std::size_t at = source.find(change.from);
    INFO(change.from);
    REQUIRE(at != std::string::npos);
    std::string result = source;
    return result.replace(at, change.from.size(), change.to);
}

TEST_CASE("the lines of GLSL in the headers are those of the README") {
    std::size_t lines = 0;
    for (const char* header : {"linear.hpp", "texcoord.hpp"}) {
        std::ifstream text(std::string(TEXGEN_TEST_DATA "/../include/texgen/") + header);
        for (std::string line; std::getline(text, line);) {
            if (line.rfind("//     ", 0) != 0 || line.back() != ';') continue;
            INFO(header, ": ", line);
            ++lines;
            CHECK(std::any_of(shaders().begin(), shaders().end(), [&](const std::string& shader) {
                return shader.find("    " + line.substr(7)) != std::string::npos;
            }));
        }
    }
    CHECK(lines == 4);
}

// What is drawn

// A triangle of an object, and what falls on it.
struct Scene {
    glm::mat4 clip_from_object;
    texgen::ObjectTexgen texgen;
    texgen::TextureRegion region;
    std::array<glm::vec3, 3> corners;
    texgen::Triangle triangle;  // the same in the window
};

std::optional<texgen::Projector> projector_at(const glm::dvec3& position, const glm::dvec3& target) {
    return texgen::make_projector(
        texgen::PerspectiveLens{.fovy = texgen::degrees(30.0), .aspect = 1.0, .z_near = 2.0, .z_far = 200.0},
        texgen::Aim{.position = position, .target = target, .up = {0.0, 1.0, 0.0}}, texgen::opengl);
}

// A floor from near the camera to far away. The slide falls on it from above; or the projector stands on its far side,
// so that the floor reaches behind it, to where the slide would be seen again without a gate.
Scene random_scene(Random& random, bool reaches_behind) {
    const auto projector = reaches_behind ? projector_at({0.0, 0.0, -15.0}, {random.uniform(-1.0, 1.0), 1.0, 0.0})
                                          : projector_at({2.0, 5.0, 5.0}, {-2.0, -4.0, 0.0});
    const auto camera = texgen::make_projector(
        texgen::PerspectiveLens{.fovy = texgen::degrees(50.0), .aspect = 1.0, .z_near = 0.5, .z_far = 500.0},
        texgen::Aim{.position = {random.uniform(-3.0, 3.0), random.uniform(1.0, 8.0), 12.0},
                    .target = {random.uniform(-1.0, 1.0), -2.0, 0.0},
                    .up = {random.uniform(-1.0, 1.0), 1.0, 0.0}},
        texgen::opengl);
    REQUIRE(projector.has_value());
    REQUIRE(camera.has_value());
    const texgen::ModelMatrix model(random.rigid(5.0));
    const texgen::TextureRegion region =
        random.coin() ? texgen::whole_texture() : texgen::atlas_tile({0.25, 0.125}, {0.75, 0.875});
    Scene scene{rounded(camera->matrix().matrix() * model.matrix()),
                texgen::object_linear(*projector, model, region),
                region,
                {},
                {}};

    const std::array floor{glm::dvec4(random.uniform(-9, -5), -4, 6, 1), glm::dvec4(random.uniform(5, 9), -4, 6, 1),
                           glm::dvec4(random.uniform(-30, 30), -4, random.uniform(-100, -60), 1)};
    for (std::size_t i = 0; i < 3; ++i) scene.corners[i] = glm::vec3(texgen::inverse_rigid(model).matrix() * floor[i]);
    std::array<glm::vec4, 3> strq;
    texgen::generate(scene.texgen, texgen::object_space(scene.corners), strq);
    std::array<texgen::WindowVertex, 3> window;
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec4 clip = glm::dmat4(scene.clip_from_object) * glm::dvec4(scene.corners[i], 1.0);
        window[i] = texgen::to_window({glm::vec4(clip), strq[i]}, {0, 0, width, height});
    }
    scene.triangle = {window[0], window[1], window[2]};
    return scene;
}

std::vector<glm::vec4> draw(const gl::Context& g, const Scene& scene, unsigned program) {
    g.UseProgram(program);
    const auto at = [&](const char* name) { return g.GetUniformLocation(program, name); };
    const glm::mat4 texture_from_object = scene.texgen.rounded();
    const glm::vec4 region(scene.region.min(), scene.region.max());
    g.UniformMatrix4fv(at("clip_from_object"), 1, 0, &scene.clip_from_object[0][0]);
    g.UniformMatrix4fv(at("texture_from_object"), 1, 0, &texture_from_object[0][0]);
    g.Uniform4fv(at("region"), 1, &region[0]);
    g.Uniform3fv(at("border"), 1, &border[0]);
    g.Uniform3fv(at("surface"), 1, &surface[0]);
    g.Uniform1f(at("bias"), bias);
    g.clear(glm::vec4(nothing));
    g.Begin(gl::triangles);
    for (const glm::vec3& corner : scene.corners) g.Vertex3fv(&corner[0]);
    g.End();
    REQUIRE(g.GetError() == gl::no_error);
    return g.pixels();
}

// Textures

constexpr int size = 64, detailed = 1024;
constexpr std::size_t texel_count = static_cast<std::size_t>(size) * static_cast<std::size_t>(size);

unsigned bind_new_texture(const gl::Context& g, gl::Enum filter) {
    unsigned texture = 0;
    g.GenTextures(1, &texture);
    g.BindTexture(gl::texture_2d, texture);
    g.TexParameteri(gl::texture_2d, gl::texture_min_filter, static_cast<int>(filter));
    g.TexParameteri(gl::texture_2d, gl::texture_mag_filter,
                    static_cast<int>(filter == gl::nearest ? gl::nearest : gl::linear));
    return texture;
}

// No two texels are equal, and none is the border.
glm::vec3 slide_texel(int column, int row) {
    return {static_cast<float>(column + 1) / size, static_cast<float>(row + 1) / size, 1.0f};
}

void bind_slide(const gl::Context& g) {
    bind_new_texture(g, gl::nearest);
    std::vector<glm::vec4> texels;
    for (int row = 0; row < size; ++row)
        for (int column = 0; column < size; ++column) texels.emplace_back(slide_texel(column, row), 1.0f);
    g.TexImage2D(gl::texture_2d, 0, static_cast<int>(gl::rgba32f), size, size, 0, gl::rgba, gl::float_type,
                 texels.data());
    REQUIRE(g.GetError() == gl::no_error);
}

// The comparison

// A fragment, and by how much OpenGL's coordinates may differ from it.
struct Fragment {
    int x, y;
    glm::dvec3 str;
    bool lit, behind;
    glm::dvec3 allowed;
};

// The texel that a coordinate falls into: -1 before the texture, `size` beyond it, and nothing where either of two may
// be right.
std::optional<int> texel(double u, double allowed) {
    const double low = std::floor((u - allowed) * size), high = std::floor((u + allowed) * size);
    if (low != high) return std::nullopt;
    return static_cast<int>(std::clamp(low, -1.0, static_cast<double>(size)));
}

struct Comparison {
    std::size_t compared = 0, lit = 0, behind = 0, mirrored = 0, wrong = 0;
};

// The color that a fragment must have, within `tolerance` of it; empty where either of two may be right.
struct Expected {
    glm::vec3 color;
    double tolerance;
};
using Expect = std::function<std::optional<Expected>(const Scene&, const Fragment&)>;

void compare(const std::vector<glm::vec4>& pixels, const Scene& scene, const Expect& expect, Comparison& result) {
    const auto setup = texgen::TriangleSetup::of(scene.triangle, scene.region);
    REQUIRE(setup.has_value());
    std::vector<float> s(pixel_count), t(pixel_count), r(pixel_count), lit(pixel_count);
    REQUIRE(texgen::interpolate(*setup, {0, 0, width, height}, {s, t, r, lit}) != texgen::Work::nothing);
    for (std::size_t i = 0; i < pixel_count; ++i) {
        if (pixels[i].x == nothing) continue;
        const int x = static_cast<int>(i) % width, y = static_cast<int>(i) / width;
        const Eigen::Vector4d strq = texgen::reference::strq(scene.triangle, x + 0.5, y + 0.5);
        const glm::dvec4 terms = gl::largest_terms(scene.triangle, x + 0.5, y + 0.5);
        // The matrix is rounded there, and the vertices are computed in float.
        constexpr double tolerance = 4.0 * gl::fragment_tolerance;
        if (2.0 * tolerance * terms.w > std::fabs(strq[3])) continue;
        Fragment fragment{x, y, {s[i], t[i], r[i]}, lit[i] != 0.0f, strq[3] < 0.0, glm::dvec3(0.0)};
        bool near_side = false;
        for (int c = 0; c < 3; ++c) {
            const double u = std::fabs(fragment.str[c]);
            fragment.allowed[c] = tolerance * (terms[c] + u * terms.w) / std::fabs(strq[3]) + 6e-8 * u;
            if (c < 2 && !fragment.behind)
                for (const double side : {scene.region.min()[c], scene.region.max()[c]})
                    near_side = near_side || std::fabs(fragment.str[c] - side) <= fragment.allowed[c];
        }
        const auto expected = near_side ? std::nullopt : expect(scene, fragment);
        if (!expected) continue;
        const glm::dvec2 mirrored(strq[0] / strq[3], strq[1] / strq[3]);
        ++result.compared;
        result.lit += fragment.lit;
        result.behind += fragment.behind;
        result.mirrored += fragment.behind && mirrored.x > scene.region.min().x && mirrored.x < scene.region.max().x &&
                           mirrored.y > scene.region.min().y && mirrored.y < scene.region.max().y;
        bool equal = true;
        for (int c = 0; c < 3; ++c)
            equal = equal && std::fabs(static_cast<double>(pixels[i][c]) - static_cast<double>(expected->color[c])) <=
                                 expected->tolerance;
        result.wrong += equal ? 0 : 1;
    }
}

Comparison comparison(const gl::Context& g, const std::string& vertex_source, const std::string& fragment_source,
                      const Expect& expect, std::uint64_t seed) {
    const unsigned program = g.program(vertex_source.c_str(), fragment_source.c_str());
    INFO(gl::Context::reason());
    REQUIRE(program != 0);
    Random random(seed);
    Comparison result;
    for (int i = 0; i < 8; ++i) {
        const Scene scene = random_scene(random, i % 2 == 0);
        compare(draw(g, scene, program), scene, expect, result);
    }
    return result;
}

// The shader is right as it stands, and each change is seen.
void judge(Shader shader, const std::vector<Change>& vertex_changes, const std::vector<Change>& changes,
           const Expect& expect, std::uint64_t seed) {
    const gl::Context& g = gl::Context::or_skip();
    const std::string &vertex_source = shaders()[vertex], &source = shaders()[shader];
    const Comparison right = comparison(g, vertex_source, source, expect, seed);
    MESSAGE(right.compared, " fragments, ", right.lit, " lit, ", right.behind, " behind, where ", right.mirrored,
            " would be lit");
    CHECK(right.wrong == 0);
    CHECK(right.compared > 100000);
    CHECK(right.lit > 10000);
    CHECK(right.compared - right.lit - right.behind > 10000);
    CHECK(right.mirrored > 300);
    for (const Change& change : vertex_changes) {
        INFO("with ", change.to);
        CHECK(comparison(g, changed(vertex_source, change), source, expect, seed).wrong > 500);
    }
    for (const Change& change : changes) {
        INFO("with ", change.to);
        CHECK(comparison(g, vertex_source, changed(source, change), expect, seed).wrong > 500);
    }
}

const std::vector<Change> broken_vertices{
    {"vec4(position, 1.0);\n}", "vec4(position, 1.0);\n    strq /= strq.q;\n}"},  // divided too early
    {"texture_from_object * vec4(position, 1.0)", "vec4(position, 1.0) * texture_from_object"},
};

std::optional<Expected> slide_color(const Scene&, const Fragment& fragment) {
    if (!fragment.lit) return Expected{surface * border, 1e-6};
    const auto column = texel(fragment.str.x, fragment.allowed.x), row = texel(fragment.str.y, fragment.allowed.y);
    if (!column || !row) return std::nullopt;
    return Expected{surface * slide_texel(*column, *row), 1e-6};
}

TEST_CASE("the README's slide on a surface shows what the library computes, gated, bordered and modulated") {
    bind_slide(gl::Context::or_skip());
    judge(slide, broken_vertices,
          {{"strq.q > 0.0 &&", ""},
           {"textureProj(slide, strq)", "texture(slide, strq.st)"},
           {"textureProj(slide, strq)", "textureProj(slide, strq.tspq)"},
           {"textureProj(slide, strq)", "textureProj(slide, strq.stp)"},
           {"strq.st / strq.q", "strq.st"},
           {"&& st == clamp(st, region.xy, region.zw)", ""},
           {": border", ": vec3(0.0)"},
           {"surface * ", ""}},
          slide_color, 201);
}

TEST_CASE("the README's slide with gradients shows the same") {
    bind_slide(gl::Context::or_skip());
    judge(gradients, broken_vertices,
          {{"strq.q > 0.0 &&", ""},
           {"textureGrad(slide, st,", "textureGrad(slide, st.ts,"},
           {"&& st == clamp(st, region.xy, region.zw)", ""},
           {"light = border", "light = vec3(0.0)"},
           {"surface * ", ""}},
          slide_color, 202);
}

std::optional<texgen::Footprint> footprint_at(const Scene& scene, const Fragment& fragment) {
    return texgen::FootprintSetup(texgen::TriangleSetup::of(scene.triangle, scene.region).value(), {detailed, detailed})
        .at(fragment.x, fragment.y);
}

// The derivatives themselves, in the place of what would be sampled with them.
TEST_CASE("the gradients of the README's shader are the derivatives of footprint.hpp") {
    const gl::Context& g = gl::Context::or_skip();
    for (const bool by_x : {true, false}) {
        const std::string macro =
            std::string("#define textureGrad(slide, st, dx, dy) vec3(") + (by_x ? "dx" : "dy") + ", 0.0)\nuniform";
        const std::string source = changed(shaders()[gradients], {"uniform", macro});
        const Expect expect = [by_x](const Scene& scene, const Fragment& fragment) -> std::optional<Expected> {
            if (!fragment.lit) return Expected{surface * border, 1e-6};
            const texgen::Footprint footprint = footprint_at(scene, fragment).value();
            return Expected{surface * glm::vec3(by_x ? footprint.dx : footprint.dy, 0.0f),
                            std::max(fragment.allowed.x, fragment.allowed.y)};
        };
        const Comparison right = comparison(g, shaders()[vertex], source, expect, 203);
        MESSAGE(right.compared, " fragments, ", right.lit, " lit");
        CHECK(right.wrong == 0);
        CHECK(right.lit > 10000);
        for (const Change& change :
             {Change{"strq * gl_FragCoord.w", "strq"}, Change{"st * dx.q", "0.0"}, Change{"st * dy.q", "0.0"},
              Change{"st * dx.q) / affine.q", "st * dx.q)"}, Change{"st * dy.q) / affine.q", "st * dy.q)"}}) {
            const bool concerns_this = change.from.find(by_x ? "dy" : "dx") == std::string::npos;
            INFO("with ", change.to);
            const std::size_t wrong = comparison(g, shaders()[vertex], changed(source, change), expect, 203).wrong;
            CHECK(concerns_this == (wrong > 500));
        }
    }
}

TEST_CASE("the README's shader samples the level of detail of footprint.hpp") {
    const gl::Context& g = gl::Context::or_skip();
    // Each level has its number as its color.
    bind_new_texture(g, gl::linear_mipmap_linear);
    for (int level = 0; level <= 10; ++level) {
        const int side = detailed >> level;
        const std::vector<float> texels(static_cast<std::size_t>(4 * side * side), static_cast<float>(level));
        g.TexImage2D(gl::texture_2d, level, static_cast<int>(gl::rgba32f), side, side, 0, gl::rgba, gl::float_type,
                     texels.data());
    }
    std::size_t between = 0;
    const Expect expect = [&between](const Scene& scene, const Fragment& fragment) -> std::optional<Expected> {
        if (!fragment.lit) return Expected{surface * border, 1e-6};
        const double level = std::clamp(footprint_at(scene, fragment).value().level, 0.0, 10.0);
        between += level > 0.5 && level < 9.5;
        return Expected{surface * static_cast<float>(level), 0.1};  // what Mesa's logarithm may be off
    };
    const Comparison right = comparison(g, shaders()[vertex], shaders()[gradients], expect, 204);
    CHECK(right.wrong == 0);
    CHECK(right.lit > 10000);
    CHECK(between > 1000);
}

TEST_CASE("the README's shadow compares r as the library computes it") {
    const gl::Context& g = gl::Context::or_skip();
    Random random(205);
    std::vector<float> depth(texel_count);
    for (float& value : depth) value = random.uniform_float(0.75, 1.0);
    bind_new_texture(g, gl::nearest);
    g.TexImage2D(gl::texture_2d, 0, static_cast<int>(gl::depth_component24), size, size, 0, gl::depth_component,
                 gl::float_type, depth.data());
    g.TexParameteri(gl::texture_2d, gl::texture_compare_mode, static_cast<int>(gl::compare_ref_to_texture));
    g.TexParameteri(gl::texture_2d, gl::texture_compare_func, static_cast<int>(gl::less_or_equal));
    for (const gl::Enum wrap : {gl::texture_wrap_s, gl::texture_wrap_t})
        g.TexParameteri(gl::texture_2d, wrap, static_cast<int>(gl::clamp_to_border));
    const glm::vec4 lit_border(1.0f);
    g.TexParameterfv(gl::texture_2d, gl::texture_border_color, &lit_border[0]);
    REQUIRE(g.GetError() == gl::no_error);

    std::size_t in_shadow = 0;
    const Expect expect = [&](const Scene&, const Fragment& fragment) -> std::optional<Expected> {
        if (fragment.behind) return Expected{glm::vec3(0.0f), 0.0};
        const auto column = texel(fragment.str.x, fragment.allowed.x), row = texel(fragment.str.y, fragment.allowed.y);
        if (!column || !row) return std::nullopt;
        const bool is_on_map = *column >= 0 && *column < size && *row >= 0 && *row < size;
        const double nearest =
            is_on_map ? static_cast<double>(depth[static_cast<std::size_t>(*row * size + *column)]) : 1.0;
        // What is compared with a depth of 24 bits is clamped as it is: beyond z_far there is light.
        const double behind_it = std::min(fragment.str.z - static_cast<double>(bias), 1.0) - nearest;
        if (std::fabs(behind_it) <= fragment.allowed.z) return std::nullopt;
        in_shadow += behind_it > 0.0;
        return Expected{behind_it > 0.0 ? glm::vec3(0.0f) : surface, 0.0};
    };
    judge(shadow, broken_vertices,
          {{"strq.q > 0.0 ? light : 0.0", "light"},
           {"bias * strq.q", "bias"},
           {"bias * strq.q", "0.0"},
           {"textureProj(depth_map, strq - ", "textureProj(depth_map, strq.tspq - "},
           {"surface * ", "vec3(1.0) * "}},
          expect, 205);
    CHECK(in_shadow > 5000);
}

}  // namespace

// Deferred

// A floor that a camera has drawn into a depth buffer, and a projector that it reaches behind.
struct DeferredScene {
    texgen::WindowTexgen texgen;
    texgen::TextureRegion region;
    std::vector<glm::vec4> texels;  // the depth, and two numbers that no other texel has
};

DeferredScene deferred_scene(Random& random) {
    const texgen::Conventions reversed{texgen::DepthRange::zero_to_one, texgen::NdcY::up,
                                       texgen::TextureOrigin::bottom_left, texgen::Handedness::right};
    const auto camera =
        texgen::make_projector(
            texgen::PerspectiveLens{
                .fovy = texgen::degrees(50.0), .aspect = 1.0, .z_near = 0.5, .z_far = HUGE_VAL, .reversed_depth = true},
            texgen::Aim{.position = {random.uniform(-3.0, 3.0), random.uniform(1.0, 8.0), 12.0},
                        .target = {random.uniform(-1.0, 1.0), -2.0, 0.0},
                        .up = {random.uniform(-1.0, 1.0), 1.0, 0.0}},
            reversed)
            .value();
    const auto projector = projector_at({0.0, 0.0, -15.0}, {random.uniform(-1.0, 1.0), -3.0, 0.0}).value();
    const texgen::Viewport viewport{0, 0, width, height};
    const texgen::TextureRegion region =
        random.coin() ? texgen::whole_texture() : texgen::atlas_tile({0.25, 0.125}, {0.75, 0.875});
    DeferredScene scene{texgen::window_linear(projector, camera, viewport, region).value(), region, {}};
    const glm::dmat4 world_from_clip = inverse(camera.matrix()).value().matrix();
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            // The floor is y = -4; beside it is nothing.
            const glm::dvec4 near =
                world_from_clip * glm::dvec4((x + 0.5) / 128.0 - 1.0, (y + 0.5) / 128.0 - 1.0, 1.0, 1.0);
            const glm::dvec4 slope = world_from_clip[2];
            const double down = (near.y + 4.0 * near.w) / (slope.y + 4.0 * slope.w);
            const double depth = 1.0 - down;
            scene.texels.emplace_back(depth > 0.0 && depth < 1.0 ? support::to_float(depth) : 0.0f,
                                      static_cast<float>(x + 1) / 512.0f, static_cast<float>(y + 1) / 512.0f, 1.0f);
        }
    }
    return scene;
}

Comparison deferred_comparison(const gl::Context& g, const std::string& source) {
    const unsigned program = g.program(shaders()[vertex].c_str(), source.c_str());
    INFO(gl::Context::reason());
    REQUIRE(program != 0);
    g.UseProgram(program);
    const auto at = [&](const char* name) { return g.GetUniformLocation(program, name); };
    Random random(206);
    Comparison result;
    for (int i = 0; i < 8; ++i) {
        const DeferredScene scene = deferred_scene(random);
        bind_new_texture(g, gl::nearest);  // as both the depth and the slide
        g.TexImage2D(gl::texture_2d, 0, static_cast<int>(gl::rgba32f), width, height, 0, gl::rgba, gl::float_type,
                     scene.texels.data());
        const glm::mat4 identity(1.0f), texture_from_window = scene.texgen.rounded();
        const glm::vec4 region(scene.region.min(), scene.region.max());
        g.UniformMatrix4fv(at("clip_from_object"), 1, 0, &identity[0][0]);
        g.UniformMatrix4fv(at("texture_from_window"), 1, 0, &texture_from_window[0][0]);
        g.Uniform4fv(at("region"), 1, &region[0]);
        g.Uniform3fv(at("border"), 1, &border[0]);
        g.clear(glm::vec4(nothing));
        g.Begin(gl::triangles);
        for (const glm::vec3& corner : {glm::vec3(-1, -1, 0), glm::vec3(3, -1, 0), glm::vec3(-1, 3, 0)})
            g.Vertex3fv(&corner[0]);
        g.End();
        REQUIRE(g.GetError() == gl::no_error);
        const std::vector<glm::vec4> pixels = g.pixels();

        std::vector<glm::vec3> fragments;
        for (std::size_t k = 0; k < pixel_count; ++k)
            fragments.emplace_back(static_cast<float>(k % width) + 0.5f, static_cast<float>(k / width) + 0.5f,
                                   scene.texels[k].x);
        std::vector<float> s(pixel_count), t(pixel_count), lit(pixel_count);
        texgen::project(scene.texgen, texgen::window_space(fragments), scene.region, {s, t, {}, lit});
        const glm::dmat4& m = scene.texgen.matrix();
        for (std::size_t k = 0; k < pixel_count; ++k) {
            const glm::dvec4 v(fragments[k], 1.0), strq = m * v;
            const auto terms = [&](int row) {
                double sum = 0.0;
                for (int j = 0; j < 4; ++j) sum += std::fabs(m[j][row] * v[j]);
                return sum;
            };
            constexpr double tolerance = 8.0 * 0x1p-24;
            if (2.0 * tolerance * terms(3) > std::fabs(strq.w)) continue;
            const bool is_lit = lit[k] != 0.0f;
            glm::dvec2 allowed;
            bool near_side = false;
            for (int c = 0; c < 2; ++c) {
                const double u = strq[c] / strq.w;
                allowed[c] = tolerance * (terms(c) + std::fabs(u) * terms(3)) / std::fabs(strq.w);
                for (const double side : {scene.region.min()[c], scene.region.max()[c]})
                    near_side = near_side || std::fabs(u - side) <= allowed[c];
            }
            glm::vec3 expected = border;
            if (is_lit) {
                const auto texel_of = [&](double u, double error) -> std::optional<int> {
                    const double low = std::floor((u - error) * width), high = std::floor((u + error) * width);
                    return low == high ? std::optional(std::clamp(static_cast<int>(low), 0, width - 1)) : std::nullopt;
                };
                const auto column = texel_of(s[k], allowed.x), row = texel_of(t[k], allowed.y);
                if (!column || !row) continue;
                expected = glm::vec3(scene.texels[static_cast<std::size_t>(*row * width + *column)]);
            }
            if (near_side) continue;
            ++result.compared;
            result.lit += is_lit;
            result.behind += strq.w < 0.0;
            result.wrong += glm::vec3(pixels[k]) != expected;
        }
    }
    return result;
}

TEST_CASE("the README's deferred light shows what the library computes for the fragments of the depth buffer") {
    const gl::Context& g = gl::Context::or_skip();
    const Comparison right = deferred_comparison(g, shaders()[deferred]);
    MESSAGE(right.compared, " fragments, ", right.lit, " lit, ", right.behind, " behind");
    CHECK(right.wrong == 0);
    CHECK(right.compared > 300000);
    CHECK(right.lit > 10000);
    CHECK(right.behind > 10000);
    for (const Change& change :
         {Change{"vec4(gl_FragCoord.xy", "vec4(gl_FragCoord.yx"},
          Change{"ivec2(gl_FragCoord.xy)", "ivec2(gl_FragCoord.yx)"}, Change{".r, 1.0)", ".r, 0.0)"},
          Change{"strq.q > 0.0 &&", ""}, Change{"strq.st / strq.q", "strq.st"},
          Change{"&& st == clamp(st, region.xy, region.zw)", ""}, Change{": border", ": vec3(0.0)"}}) {
        INFO("with ", change.to);
        CHECK(deferred_comparison(g, changed(shaders()[deferred], change)).wrong > 500);
    }
}
