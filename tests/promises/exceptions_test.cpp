// Programs that trap invalid operations, divisions by zero and overflow, as debug builds of games do, may call every
// function: with what a scene gives it none of these is raised, not even by lanes that hold nothing.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cfenv>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "api/diagnose_product_test/users_code.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"
#include "support/stopwatch.hpp"
#include "support/triangles.hpp"
#include "support/workloads.hpp"
#include "texgen/batch.hpp"
#include "texgen/clip.hpp"
#include "texgen/coverage.hpp"
#include "texgen/diagnose.hpp"
#include "texgen/fixed_function.hpp"
#include "texgen/footprint.hpp"
#include "texgen/interpolate.hpp"
#include "texgen/linear.hpp"
#include "texgen/projector.hpp"
#include "texgen/scene.hpp"
#include "texgen/texcoord.hpp"

namespace {

using support::infinity_double;
using support::Random;

constexpr int trapped = FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW;

// One of every kind of lens, whose axes stand anyhow.
std::vector<texgen::Projector> draw_projectors(Random& random) {
    const auto coordinate = [&] { return random.uniform(-5.0, 5.0); };
    const texgen::Aim aim{
        {coordinate(), coordinate(), coordinate()}, {coordinate() + 20.0, coordinate(), coordinate()}, {0.0, 1.0, 0.0}};
    const double z_near = random.uniform(0.1, 1.0), width = random.uniform(1.0, 20.0);
    const texgen::Angle fovy = texgen::degrees(random.uniform(10.0, 90.0));
    const std::optional<texgen::Projector> drawn[] = {
        make_projector(texgen::PerspectiveLens{fovy, 1.5, z_near, 100.0}, aim, texgen::opengl),
        make_projector(texgen::PerspectiveLens{fovy, 1.0, z_near, infinity_double}, aim, texgen::vulkan),
        make_projector(texgen::PerspectiveLens{fovy, 1.0, z_near, infinity_double, true}, aim, texgen::direct3d),
        make_projector(texgen::OrthographicLens{-width, width, -1.0, 1.0, 0.0, 100.0}, aim, texgen::opengl),
        make_projector(texgen::OrthographicLens{-3.0, 0.5 * width, -1.0, 1.0, -3.0, 50.0}, aim, texgen::metal)};
    std::vector<texgen::Projector> projectors;
    for (const std::optional<texgen::Projector>& projector : drawn) projectors.push_back(projector.value());
    // Straight along an axis: elements of the matrix are 0.
    projectors.push_back(make_projector(texgen::OrthographicLens{-width, width, -4.0, 4.0, 0.0, 100.0},
                                        texgen::Aim{{0.0, 10.0, 0.0}, {0.0, 0.0, 0.0}, {0.0, 0.0, -1.0}},
                                        texgen::opengl)
                             .value());
    return projectors;
}

// What a function finds where it has written nothing yet.
[[gnu::noinline]] void fill_stack_with_nans() {
    volatile float stack[40000];
    for (volatile float& number : stack) number = std::numeric_limits<float>::quiet_NaN();
}

}  // namespace

TEST_CASE("no function raises an exception of floating point but underflow and inexact for an ordinary input") {
    std::size_t asked = 0;
    for (const support::Workload& workload : support::workloads) {
        CAPTURE(std::string(workload.function));
        Random random(8100);
        for (int i = 0; i < 20; ++i) {
            const support::Calls calls = workload.calls(workload.inputs.ordinary(random));
            if (!calls) continue;
            ++asked;
            std::feclearexcept(FE_ALL_EXCEPT);
            calls(1);
            REQUIRE(std::fetestexcept(trapped) == 0);
        }
    }
    CHECK(asked > 2000);
}

TEST_CASE(
    "nor does one under lenses of all kinds, with depths of all kinds, for bodies, points and what is made of them") {
    Random random(8200);
    const texgen::ModelMatrix model{glm::dmat4(1.0)};
    const auto require_none = [](const std::string& of) {
        CAPTURE(of);
        REQUIRE(std::fetestexcept(trapped) == 0);
    };
    std::size_t lit = 0;
    for (int round = 0; round < 40; ++round) {
        const std::vector<texgen::Projector> projectors = draw_projectors(random);
        std::vector<glm::vec3> points;
        for (int i = 0; i < 40; ++i)
            points.emplace_back(random.uniform_float(5.0, 15.0), random.uniform_float(-5.0, 5.0),
                                random.uniform_float(-5.0, 5.0));
        std::vector<texgen::Box> boxes;
        std::vector<texgen::Sphere> spheres;
        for (const glm::vec3& point : points) {
            boxes.push_back({point - 0.5f, point + 0.5f});
            spheres.push_back({point, 0.5f});
        }
        boxes.push_back({glm::vec3(1.0f), glm::vec3(-1.0f)});
        spheres.push_back({glm::vec3(0.0f), 0.0f});
        for (std::size_t kind = 0; kind < projectors.size(); ++kind) {
            CAPTURE(kind);
            for (const texgen::TextureRegion& region : {texgen::whole_texture(), texgen::whole_texture().with_depth(),
                                                        texgen::whole_texture().with_depth(0.0, infinity_double),
                                                        texgen::whole_texture().with_depth(-infinity_double, 1.0)}) {
                std::feclearexcept(FE_ALL_EXCEPT);
                const texgen::WorldTexgen matrix = texture_from_world(projectors[kind], region);
                require_none("texture_from_world");
                clip_planes(matrix, region);
                require_none("clip_planes");
                const texgen::LitVolume volume(matrix, region);
                require_none("LitVolume");
                for (const texgen::Box& box : boxes) {
                    coverage(matrix, region, box);
                    volume.coverage(box);
                    require_none("a box");
                }
                for (const texgen::Sphere& sphere : spheres) {
                    coverage(matrix, region, sphere);
                    volume.coverage(sphere);
                    require_none("a sphere");
                }
                for (const std::size_t count : {std::size_t{2}, std::size_t{9}, boxes.size()}) {
                    std::vector<texgen::Coverage> out(count);
                    coverage(matrix, region, std::span<const texgen::Box>(boxes).last(count), out);
                    require_none("boxes");
                    lit += static_cast<std::size_t>(std::ranges::count(out, texgen::Coverage::inside));
                    out.resize(std::min(count, spheres.size()));
                    coverage(matrix, region, std::span<const texgen::Sphere>(spheres).last(out.size()), out);
                    require_none("spheres");
                }
                std::vector<float> s(points.size()), t(points.size()), r(points.size()), mask(points.size());
                for (const texgen::Tolerance tolerance : {texgen::exact, texgen::texels(0.5, 1024.0)}) {
                    const texgen::Positions<texgen::World> positions = texgen::world_space(points);
                    project(matrix, positions, region, {s, t, r, mask}, tolerance);
                    require_none("points");
                    project(matrix, positions.within({{5.0f, -5.0f, -5.0f}, {15.0f, 5.0f, 5.0f}}), region,
                            {s, t, r, mask}, tolerance);
                    require_none("points within a box");
                }
            }
        }
        const std::vector<texgen::ModelMatrix> models(boxes.size(), model);
        const double no_limit = infinity_double;
        for (const texgen::TextureRegion& region :
             {texgen::whole_texture(), texgen::whole_texture().with_depth(),
              texgen::whole_texture().with_depth(0.0, no_limit), texgen::whole_texture().with_depth(-no_limit, 1.0)}) {
            const std::vector<texgen::TextureRegion> regions(projectors.size(), region);
            texgen::Scene scene;
            std::feclearexcept(FE_ALL_EXCEPT);
            scene.update({models, boxes, projectors, regions}, {});
            require_none("Scene::update");
        }
    }
    CHECK(lit > 1000);
}

TEST_CASE("nor does one for the holes of a visibility buffer, fragments behind, or a segment of one q") {
    // q is 0 between the second column and the third.
    const auto vertex = [](float x, float y) {
        return texgen::WindowVertex{{x, y}, 1.0f, {0.25f * x + 0.125f * y, 0.5f + 0.25f * y, 0.5f, x - 1.75f}};
    };
    const std::array<texgen::Triangle, 1> triangle{{{vertex(0.0f, 0.0f), vertex(16.0f, 0.0f), vertex(0.0f, 16.0f)}}};
    texgen::TriangleBatch batch(texgen::whole_texture());
    batch.assign(triangle);
    for (const int width : {1, 3, 5, 8, 13}) {
        std::vector<std::uint32_t> ids(static_cast<std::size_t>(width) * 3, 0u);
        ids[ids.size() / 2] = texgen::no_triangle;
        std::array<std::vector<float>, 8> out;
        for (std::vector<float>& array : out) array.resize(ids.size());
        std::feclearexcept(FE_ALL_EXCEPT);
        interpolate(batch, ids, {0, 0, width, 3}, {out[0], out[1], out[2], out[3]});
        CHECK(std::fetestexcept(trapped) == 0);
        footprint(batch, ids, {0, 0, width, 3}, {4096.0, 4096.0},
                  {out[0], out[1], out[2], out[3], out[4], out[5], out[6], out[7]});
        CHECK(std::fetestexcept(trapped) == 0);
    }
    for (const texgen::Segment& segment : {texgen::Segment{{0.1f, 0.2f, 0.3f, 1.0f}, {0.5f, 0.6f, 0.7f, 1.0f}},
                                           texgen::Segment{{0.1f, 0.2f, 0.3f, 1.0f}, {0.1f, 0.2f, 0.3f, 1.0f}}}) {
        const std::vector<float> alpha{0.0f, 0.25f, 0.3f, 0.75f, 1.0f};
        std::array<std::vector<float>, 4> out;
        for (std::vector<float>& array : out) array.resize(alpha.size());
        for (const texgen::Tolerance tolerance : {texgen::exact, texgen::texels(1.0 / 16.0, 1024.0)}) {
            std::feclearexcept(FE_ALL_EXCEPT);
            interpolate(segment, alpha, texgen::whole_texture(), {out[0], out[1], out[2], out[3]}, tolerance);
            CHECK(std::fetestexcept(trapped) == 0);
        }
    }
}

TEST_CASE(
    "nor does one where the outputs and the stack held NaNs before, of triangles of any size, alone or in a batch") {
    Random random(8300);
    const texgen::TextureRegion region = texgen::atlas_tile({0.1, 0.01}, {0.5, 0.7});
    for (int round = 0; round < 400; ++round) {
        const texgen::Triangle triangle = support::make_triangle(support::Family::friendly, random);
        const std::vector<texgen::Triangle> triangles(4, triangle);
        const texgen::Tolerance tolerance = random.coin() ? texgen::exact : texgen::texels(1.0 / 512.0, 4096.0);
        const texgen::TextureRegion sides = random.coin() ? region : region.with_depth(0.2, 0.8);
        texgen::TriangleBatch batch(sides, tolerance);
        batch.assign(triangles);
        const glm::vec2 middle = (triangle.a.window + triangle.b.window + triangle.c.window) / 3.0f;
        const texgen::FragmentRect rect{static_cast<int>(middle.x), static_cast<int>(middle.y), random.integer(1, 40),
                                        random.integer(1, random.coin() ? 1 : 40)};
        const std::vector<texgen::FragmentRect> rects(triangles.size(), rect);
        const auto one = static_cast<std::size_t>(rect.width) * static_cast<std::size_t>(rect.height);
        std::array<std::vector<float>, 8> array;
        const auto out = [&](std::size_t which, std::size_t count) {
            array[which].assign(count, std::numeric_limits<float>::quiet_NaN());
            return std::span<float>(array[which]);
        };
        const bool has_r = random.coin();
        const auto texcoords = [&](std::size_t count) {
            return texgen::Texcoords{out(0, count), out(1, count), has_r ? out(2, count) : std::span<float>(),
                                     out(3, count)};
        };
        const auto require_none = [&](const auto& call) {
            fill_stack_with_nans();
            std::feclearexcept(FE_ALL_EXCEPT);
            call();
            REQUIRE_MESSAGE(std::fetestexcept(trapped) == 0, support::hex(triangle), " in ", rect.width, " x ",
                            rect.height, " at ", rect.x, ", ", rect.y);
        };
        const texgen::TriangleSetup setup = texgen::TriangleSetup::of(triangle, sides, tolerance).value();
        const std::vector<std::uint32_t> ids(one, 2u);
        const texgen::Texcoords of_all = texcoords(triangles.size() * one);
        require_none([&] { interpolate(batch, rects, of_all); });
        const texgen::Texcoords of_one = texcoords(one);
        require_none([&] { interpolate(setup, rect, of_one); });
        require_none([&] { interpolate(batch, ids, rect, of_one); });
        const texgen::Footprints footprints{out(0, one), out(1, one), out(2, one), out(3, one),
                                            out(4, one), out(5, one), out(6, one), out(7, one)};
        require_none([&] { footprint(texgen::FootprintSetup(setup, {1024.0, 1024.0}), rect, footprints); });
        require_none([&] { footprint(batch, ids, rect, {1024.0, 1024.0}, footprints); });
    }
}

TEST_CASE("nor does a diagnosis of any projector, or of what users' own code makes with it, whatever else is told") {
    using namespace product_cases;
    Random random(8101);
    int asked = 0;
    for (int i = 0; i < 40000; ++i) {
        const Mistake mistake = static_cast<Mistake>(random.integer(0, 8));
        Meant m = random.coin() ? human(mistake, random) : any_meant(mistake, random);
        if (random.integer(0, 3) == 0) m.aim.position = {0.0, 0.0, 0.0};
        if (random.integer(0, 3) == 0) m.aim.target = m.aim.position + glm::dvec3(0.0, 0.0, random.coin() ? 5.0 : -5.0);
        const double end = m.kind == LensKind::infinite ? infinity_double : m.z_far;
        const bool is_of_camera = random.integer(0, 7) == 0, is_reversed = random.integer(0, 7) == 0;
        const std::optional<Projector> projector =
            is_of_camera ? make_projector(texgen::PinholeLens{640.0, 630.0, 320.5, 240.0, 640.0, 480.0, m.z_near, end,
                                                              texgen::PixelCentre::half},
                                          m.aim, m.conventions)
            : is_reversed
                ? make_projector(texgen::PerspectiveLens{texgen::degrees(m.fovy), m.aspect, m.z_near, end, true}, m.aim,
                                 m.conventions)
                : right_projector(m);
        if (!projector) continue;
        ++asked;
        const In in = put_in_space(m, random);
        const glm::dmat4 texgen = random.coin() && in == In::world
                                      ? texture_from_world(*projector, m.region, m.depth).matrix()
                                      : made_somehow(m, mistake, random);
        const Projector told_of = random.coin() ? *projector : own_projector(m);
        const auto raises_none = [&](const auto& diagnose_it) {
            std::feclearexcept(FE_ALL_EXCEPT);
            const Diagnosis diagnosis = diagnose_it();
            const int raised = std::fetestexcept(trapped);
            REQUIRE_MESSAGE(raised == 0, "raised ", raised, is_of_camera, is_reversed, " ", text(m, texgen, diagnosis));
        };
        raises_none([&] { return diagnose(told_of); });
        for (const Told told : {Told::nothing, Told::lens, Told::projector}) {
            const bool has_conventions = random.coin();
            raises_none([&] { return diagnosis_of(m, in, told_of, told, has_conventions, texgen); });
            raises_none([&] { return diagnosis_of(m, in, told_of, told, has_conventions, glm::transpose(texgen)); });
        }
        raises_none(
            [&] { return diagnose(planes(texgen::WorldTexgen(texgen)), texgen::ProjectionSetup<texgen::World>{}); });
        raises_none([&] {
            const std::array points{glm::vec3(0.0f), glm::vec3(0.5f, -1.0f, -7.0f), glm::vec3(-1.0f, 2.0f, -90.0f)};
            const texgen::LensFacts facts{texgen::degrees(m.fovy), m.aspect, m.z_near, end};
            return diagnose(texgen::ProjectionSetup<texgen::World>{.projector = told_of,
                                                                   .points = texgen::world_space(points),
                                                                   .depth = m.depth,
                                                                   .texels_per_unit = {512.0, 512.0},
                                                                   .lens = facts});
        });
    }
    CHECK(asked > 30000);
}
