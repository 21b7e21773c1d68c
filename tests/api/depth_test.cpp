// A region with a depth: what is lit of points, segments and triangles ends where the projector's planes, or any other
// limits of r, are; and nothing else changes.

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "judges/exact.hpp"
#include "judges/fragments.hpp"
#include "judges/verdict.hpp"
#include "support/hard_triangles.hpp"
#include "support/hex.hpp"
#include "support/outputs.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"
#include "support/windows.hpp"
#include "texgen/interpolate.hpp"
#include "texgen/linear.hpp"
#include "texgen/projector.hpp"
#include "texgen/reference.hpp"
#include "texgen/segment.hpp"
#include "texgen/texcoord.hpp"

namespace {

using support::count_of;
using support::everywhere;
using support::ExactTriangle;
using support::hex;
using support::infinity_double;
using support::nan_double;
using support::Outputs;
using support::Random;
using support::same_bits;
using support::Seen;
using support::setup_of;
using support::Shot;
using texgen::Aim;
using texgen::Conventions;
using texgen::DepthMapping;
using texgen::Projector;
using texgen::Segment;
using texgen::TextureRegion;
using texgen::Tolerance;
using texgen::Work;

std::vector<Conventions> preset_conventions() {
    std::vector<Conventions> result;
    for (const Conventions& api : {texgen::opengl, texgen::vulkan, texgen::direct3d, texgen::metal})
        for (const Conventions& conventions : {api, texgen::left_handed(api)}) result.push_back(conventions);
    return result;
}

struct LensCase {
    const char* name;
    double z_near, z_far;
    std::optional<Projector> (*make)(const Aim&, Conventions);
};

template <int ZFar, bool Reversed>
std::optional<Projector> perspective(const Aim& aim, Conventions conventions) {
    return make_projector(
        texgen::PerspectiveLens{texgen::degrees(40), 1.5, 0.5, ZFar == 0 ? infinity_double : ZFar, Reversed}, aim,
        conventions);
}

const std::array lenses{
    LensCase{"perspective", 0.5, 20.0, perspective<20, false>},
    LensCase{"reversed", 0.5, 20.0, perspective<20, true>},
    LensCase{"infinite", 0.5, infinity_double, perspective<0, false>},
    LensCase{"infinite reversed", 0.5, infinity_double, perspective<0, true>},
    LensCase{"frustum", 0.5, 20.0,
             [](const Aim& aim, Conventions conventions) {
                 return make_projector(texgen::FrustumLens{-0.3, 0.4, -0.2, 0.5, 0.5, 20.0}, aim, conventions);
             }},
    LensCase{"orthographic", 0.5, 20.0,
             [](const Aim& aim, Conventions conventions) {
                 return make_projector(texgen::OrthographicLens{-2.0, 3.0, -2.5, 2.0, 0.5, 20.0}, aim, conventions);
             }},
    LensCase{"pinhole", 0.5, 20.0,
             [](const Aim& aim, Conventions conventions) {
                 return make_projector(texgen::PinholeLens{500.0, 510.0, 320.0, 240.0, 640.0, 480.0, 0.5, 20.0,
                                                           texgen::PixelCentre::half},
                                       aim, conventions);
             }},
};

// Distances from the projector along its axis, and whether its light is there.
std::vector<double> distances(const LensCase& lens) {
    std::vector<double> result{0.25, 0.499, 0.501, 1.0, 5.0, 19.9, 20.1, 40.0, 1e3, 1e6, 1e12};
    if (lens.z_far < infinity_double) result.pop_back();
    return result;
}
bool is_reached(const LensCase& lens, double distance) { return distance > lens.z_near && distance < lens.z_far; }

float lit_at(const texgen::WorldTexgen& texgen, const glm::vec3& point, const TextureRegion& region) {
    float lit = -1.0f;
    project(texgen, texgen::world_space(std::span(&point, 1)), region, {{}, {}, {}, {&lit, 1}});
    return lit;
}

// Only the mask of what `out` has.
texgen::Texcoords mask_of(Outputs& out) { return {.s = {}, .t = {}, .r = {}, .lit = out.spans().lit}; }

}  // namespace

TEST_CASE("light reaches from the near plane to the far one: every lens, convention and mapping") {
    Random random(9000);
    int reached = 0, beyond = 0, lit = 0, dark = 0;
    for (const LensCase& lens : lenses) {
        for (const Conventions& conventions : preset_conventions()) {
            for (const DepthMapping mapping : {DepthMapping::unit, DepthMapping::ndc}) {
                CAPTURE(std::string(lens.name));
                const glm::dvec3 position = random.uniform(0.0, 3.0) * random.direction(), to = random.direction();
                const Projector projector =
                    lens.make({.position = position, .target = position + to, .up = random.direction()}, conventions)
                        .value();
                const TextureRegion region = texgen::whole_texture().with_depth(conventions, mapping);
                const auto texgen = texture_from_world(projector, region, mapping);
                std::vector<glm::vec3> points;
                for (const double distance : distances(lens)) {
                    CAPTURE(distance);
                    const glm::vec3 point(position + distance * to);
                    points.push_back(point);
                    REQUIRE(lit_at(texgen, point, region) == (is_reached(lens, distance) ? 1.0f : 0.0f));
                    if (distance < 1e12) REQUIRE(lit_at(texgen, point, texgen::whole_texture()) == 1.0f);
                    ++(is_reached(lens, distance) ? reached : beyond);
                }
                // All of them along a segment and over a triangle, against the exact rationals.
                std::vector<glm::vec4> strq(points.size());
                generate(texgen, texgen::world_space(points), strq);
                const Segment segment{strq[0], strq[7]};
                std::vector<float> alpha(200);
                for (std::size_t i = 0; i < alpha.size(); ++i) alpha[i] = static_cast<float>(i) / 199.0f;
                for (const Tolerance tolerance : {texgen::exact, Tolerance{1e-3}}) {
                    Outputs out(alpha.size());
                    interpolate(segment, alpha, region, out.spans(), tolerance);
                    for (std::size_t i = 0; i < alpha.size(); ++i) {
                        const std::string wrong =
                            what_is_wrong(support::exactly_at(segment, alpha[i]), region, tolerance, out, i);
                        REQUIRE_MESSAGE(wrong.empty(), wrong);
                    }
                    const auto vertex = [&](float x, float y, const glm::vec4& at) {
                        return texgen::WindowVertex{{x, y}, 1.0f, at};
                    };
                    const Shot shot{
                        {vertex(0.0f, 0.0f, strq[0]), vertex(40.0f, 0.0f, strq[7]), vertex(0.0f, 10.0f, strq[1])},
                        {0, 0, 40, 10}};
                    Outputs of_triangle(count_of(shot.rect));
                    const Work work =
                        interpolate(setup_of(shot.triangle, region, tolerance), shot.rect, of_triangle.spans());
                    Seen seen;
                    const std::string wrong =
                        first_wrong(shot, ExactTriangle(shot.triangle), region, tolerance, work, of_triangle, seen);
                    REQUIRE_MESSAGE(wrong.empty(), wrong);
                    lit += seen.lit;
                    dark += seen.dark;
                }
            }
        }
    }
    CHECK(reached > 500);
    CHECK(beyond > 500);
    CHECK(lit > 20000);
    CHECK(dark > 5000);
}

TEST_CASE("limits that are infinite change nothing; an empty depth or a NaN takes all light, and leaves s, t and r") {
    Random random(9100);
    const TextureRegion sides = texgen::atlas_tile({0.1, 0.2}, {0.9, 0.7});
    for (const Tolerance tolerance : {texgen::exact, Tolerance{1e-4}}) {
        int lit_before = 0;
        for (int i = 0; i < 300; ++i) {
            const Shot shot = support::detail::ordinary(support::Family::friendly, random);
            const Segment segment{shot.triangle.a.strq, shot.triangle.b.strq};
            std::vector<float> alpha(static_cast<std::size_t>(random.integer(1, 100)));
            for (float& a : alpha) a = random.uniform_float(0.0, 1.0);
            const auto scene = support::random_window_scene(random, 0.0);
            const auto texgen = texture_from_world(scene.projector);
            std::vector<glm::vec3> points(static_cast<std::size_t>(random.integer(1, 100)));
            for (glm::vec3& point : points) point = random.vector3(8.0);

            const auto answers = [&](const TextureRegion& region) {
                std::vector<Outputs> result{Outputs(count_of(shot.rect)), Outputs(alpha.size()),
                                            Outputs(points.size())};
                interpolate(setup_of(shot.triangle, region, tolerance), shot.rect, result[0].spans());
                interpolate(segment, alpha, region, result[1].spans(), tolerance);
                project(texgen, texgen::world_space(points), region, result[2].spans(), tolerance);
                return result;
            };
            const std::vector<Outputs> before = answers(sides),
                                       same = answers(sides.with_depth(-infinity_double, infinity_double));
            for (std::size_t j = 0; j < before.size(); ++j) {
                for (std::size_t k = 0; k < 4; ++k) REQUIRE(same_bits(before[j][k], same[j][k]));
                for (const float lit : before[j].lit()) lit_before += lit == 1.0f;
            }
            for (const TextureRegion& empty :
                 {sides.with_depth(1.0, 0.0), sides.with_depth(nan_double, 1.0), sides.with_depth(0.0, nan_double),
                  sides.with_depth(nan_double, infinity_double), sides.with_depth(-infinity_double, nan_double),
                  sides.with_depth(infinity_double, -infinity_double), sides.with_depth(0.1, 0.1)}) {
                const std::vector<Outputs> dark = answers(empty);
                for (std::size_t j = 0; j < before.size(); ++j) {
                    for (std::size_t k = 0; k < 3; ++k)
                        REQUIRE((same_bits(before[j][k], dark[j][k]) || (j == 0 && Outputs::is_poison(dark[j][k]))));
                    for (const float lit : dark[j].lit()) REQUIRE(same_bits(lit, 0.0f));
                }
            }
        }
        CHECK(lit_before > 3000);
    }
}

TEST_CASE("a mask is the same whether r is asked for or not, in rectangles of all sizes") {
    std::uint64_t seed = 9200;
    int both = 0;
    for (const support::HardFamily& family : support::hard_families) {
        CAPTURE(std::string(family.name));
        Random random(++seed);
        for (int i = 0; i < 40; ++i) {
            Shot shot = family.make(random);
            const std::array sizes{std::array{random.integer(1, 80), random.integer(1, 80)},
                                   std::array{random.integer(900, 2200), random.integer(1, 3)},
                                   std::array{random.integer(1, 3), random.integer(900, 2200)},
                                   std::array{random.integer(1, 9), random.integer(1, 9)}};
            if (std::abs(static_cast<std::int64_t>(shot.rect.x)) < 2000000000 &&
                std::abs(static_cast<std::int64_t>(shot.rect.y)) < 2000000000) {
                const auto& [width, height] = sizes[random.bits() % sizes.size()];
                shot.rect.width = width;
                shot.rect.height = height;
            }
            const ExactTriangle exact(shot.triangle);
            const TextureRegion region = region_at(shot, exact, random);
            const auto setup = setup_of(shot.triangle, region);
            Outputs all(count_of(shot.rect)), alone(count_of(shot.rect), 8u);
            interpolate(setup, shot.rect, all.spans());
            interpolate(setup, shot.rect, mask_of(alone));
            REQUIRE_MESSAGE(same_bits(all.lit(), alone.lit()), hex(shot));
            REQUIRE(alone.pads_are_intact());
            int lit = 0;
            for (const float one : all.lit()) lit += one == 1.0f;
            both += lit != 0 && lit != static_cast<int>(all.size());

            // Within the tolerance either may be right.
            const Tolerance tolerance{random.power_of_ten(-7.0, -1.0)};
            const auto loose = setup_of(shot.triangle, region, tolerance);
            Outputs within(count_of(shot.rect), 8u);
            const Work work = interpolate(loose, shot.rect, mask_of(within));
            Seen seen;
            const std::size_t step = 1 + within.size() / 50;
            const std::string wrong =
                first_wrong(shot, exact, region, tolerance, work, within, seen, random.bits() % step, step);
            REQUIRE_MESSAGE(wrong.empty(), wrong, " with ", hex(tolerance.value), " in ", hex(shot));
        }
    }
    CHECK(both > 100);
}

TEST_CASE("many points have the mask of each alone, in every layout and whether r is asked for or not") {
    Random random(9300);
    int lit = 0, dark = 0;
    for (const std::size_t count : {1u, 15u, 16u, 255u, 256u, 1008u, 1023u, 1024u, 1025u, 1040u, 2049u, 5000u}) {
        const auto scene = support::random_window_scene(random, 3.0);
        const auto texgen = texture_from_world(scene.projector);
        const TextureRegion region = texgen::whole_texture().with_depth(random.uniform(0.0, 0.9), 1.0);
        std::vector<glm::vec3> points(count);
        std::array<std::vector<float>, 3> planar;
        for (std::size_t i = 0; i < count; ++i) {
            // Some stretches are dark, and some are lit.
            const double size = i / 700 % 2 == 0 ? 1.0 : 30.0;
            points[i] = glm::vec3(scene.projector_aim.target) + random.vector3(size);
            for (int k = 0; k < 3; ++k) planar[static_cast<std::size_t>(k)].push_back(points[i][k]);
        }
        std::vector<float> alone(count);
        for (std::size_t i = 0; i < count; ++i) {
            alone[i] = lit_at(texgen, points[i], region);
            ++(alone[i] == 1.0f ? lit : dark);
        }
        for (const unsigned asked : {15u, 12u, 8u, 11u}) {
            for (const auto& positions :
                 {texgen::world_space(points), texgen::world_space(planar[0], planar[1], planar[2]),
                  texgen::world_space(&points[0].x, count, sizeof(glm::vec3))}) {
                Outputs out(count, asked, random.bits() % 16);
                project(texgen, positions, region, out.spans());
                REQUIRE(same_bits(out.lit(), alone));
                REQUIRE(out.pads_are_intact());
                Outputs within(count, asked);
                project(texgen, positions, region, within.spans(), {1e-3});
                for (std::size_t i = 0; i < count; i += 1 + count / 100) {
                    const std::string wrong = what_is_wrong(support::exactly_at(texgen.matrix(), points[i]), region,
                                                            Tolerance{1e-3}, within, i);
                    REQUIRE_MESSAGE(wrong.empty(), wrong);
                }
            }
        }
    }
    CHECK(lit > 500);
    CHECK(dark > 500);
}

TEST_CASE("an r that is no number is in no depth, and without one does not matter") {
    glm::dmat4 matrix(0.0);
    matrix[3] = {0.5, 0.5, nan_double, 1.0};
    const std::vector<glm::vec3> points(20, glm::vec3(0.25f));
    const std::vector<float> alpha(20, 0.25f);
    const glm::vec4 end(0.5f, 0.5f, support::infinity_float, 1.0f);
    const TextureRegion volume = texgen::whole_texture().with_depth(-infinity_double, infinity_double);
    for (const bool has_depth : {false, true}) {
        const TextureRegion region = has_depth ? volume : texgen::whole_texture();
        for (const unsigned asked : {15u, 8u}) {
            Outputs of_points(points.size(), asked), of_segment(alpha.size(), asked);
            project(texgen::ObjectTexgen(matrix), texgen::object_space(points), region, of_points.spans());
            interpolate(Segment{end, -end + glm::vec4(1.0f, 1.0f, 0.0f, 2.0f)}, alpha, region, of_segment.spans());
            for (const float lit : of_points.lit()) CHECK(lit == (has_depth ? 0.0f : 1.0f));
            for (const float lit : of_segment.lit()) CHECK(lit == (has_depth ? 0.0f : 1.0f));
        }
    }
    CHECK(work(Segment{end, end}, volume) == Work::affine);
    CHECK(work(Segment{end, 2.0f * end}, volume) == Work::divide_and_test);
    CHECK(work(Segment{end, 2.0f * end}, texgen::whole_texture()) == Work::divide);
}

TEST_CASE("the reference in double has the same depth") {
    Random random(9400);
    int lit = 0, dark = 0, compared = 0;
    for (int i = 0; i < 300; ++i) {
        const Shot shot = support::detail::ordinary(support::Family::friendly, random);
        const TextureRegion region = everywhere().with_depth(random.uniform(-1.0, 1.0), random.uniform(0.5, 2.0));
        Outputs fast(count_of(shot.rect)), reference(count_of(shot.rect));
        if (interpolate(setup_of(shot.triangle, region), shot.rect, fast.spans()) == Work::nothing) continue;
        texgen::reference::interpolate(shot.triangle, region, shot.rect, reference.spans());
        for (std::size_t k = 0; k < fast.size(); ++k) {
            if (!same_bits(fast.r()[k], reference.r()[k])) continue;
            ++compared;
            REQUIRE_MESSAGE(fast.lit()[k] == reference.lit()[k], hex(shot));
            ++(fast.lit()[k] == 1.0f ? lit : dark);
        }
    }
    CHECK(compared > 5000);
    CHECK(lit > 1000);
    CHECK(dark > 1000);
}
