// The worst points and segments cost at most eight times what ordinary ones do: as many of them, laid out alike, with
// the same outputs.

#include <doctest/doctest.h>

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "support/doubtful.hpp"
#include "support/limits.hpp"
#include "support/outputs.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"
#include "support/stopwatch.hpp"
#include "texgen/interpolate.hpp"
#include "texgen/texcoord.hpp"

namespace {

using support::Random;
using texgen::Tolerance;

#ifdef TEXGEN_SCALAR
const double limit_of_any = 16.0;  // plain loops have no vectors to save by
#else
const double limit_of_any = support::limit::any * support::limit::times_by_vectors();
#endif

struct Planes {
    std::vector<float> x, y, z;

    explicit Planes(const std::vector<glm::vec3>& points) {
        for (const glm::vec3& point : points) {
            x.push_back(point.x);
            y.push_back(point.y);
            z.push_back(point.z);
        }
    }
};

// A call of project() on a cloud.
class Projection {
public:
    enum class Way { interleaved_lit, planar, strided, lit_only, one_coordinate, pairs, one_by_one };
    static constexpr std::array ways{Way::interleaved_lit, Way::planar, Way::strided,   Way::lit_only,
                                     Way::one_coordinate,  Way::pairs,  Way::one_by_one};

    Projection(const support::Cloud& cloud, Way way, Tolerance tolerance)
        : texgen_(cloud.matrix),
          points_(cloud.points),
          planes_(cloud.points),
          way_(way),
          tolerance_(tolerance),
          outputs_(3, std::vector<float>(cloud.points.size())),
          pairs_(cloud.points.size()) {
        for (const glm::vec3& point : cloud.points) padded_.emplace_back(point, 1.0f);
    }

    void operator()() {
        const auto out = [&](std::size_t k) { return std::span<float>(outputs_[k]); };
        const auto run = [&](const texgen::Positions<texgen::World>& positions, const texgen::Texcoords& to) {
            project(texgen_, positions, texgen::whole_texture(), to, tolerance_);
        };
        const auto interleaved = texgen::world_space(points_);
        switch (way_) {
            case Way::interleaved_lit:
                return run(interleaved, {out(0), out(1), {}, out(2)});
            case Way::planar:
                return run(texgen::world_space(planes_.x, planes_.y, planes_.z), {out(0), out(1), {}, {}});
            case Way::strided:
                return run(texgen::world_space(&padded_[0].x, padded_.size(), sizeof padded_[0]),
                           {out(0), out(1), {}, {}});
            case Way::lit_only:
                return run(interleaved, {{}, {}, {}, out(2)});
            case Way::one_coordinate:
                return run(texgen::world_space(planes_.x, planes_.y, planes_.z), {out(0), {}, {}, {}});
            case Way::pairs:
                return project(texgen_, interleaved, pairs_, tolerance_);
            case Way::one_by_one:
                for (std::size_t i = 0; i < points_.size(); ++i)
                    pairs_[i] = project(texgen_, texgen::world_space(points_[i])).value_or(glm::vec2(0.0f));
        }
    }

private:
    texgen::WorldTexgen texgen_;
    std::vector<glm::vec3> points_;
    Planes planes_;
    Way way_;
    Tolerance tolerance_;
    std::vector<std::vector<float>> outputs_;
    std::vector<glm::vec2> pairs_;
    std::vector<glm::vec4> padded_;
};

}  // namespace

TEST_CASE("the worst points cost eight times ordinary ones at most, ten within a tolerance") {
    Random random(56);
    std::size_t turn = 0;
    for (const std::size_t count : {1u, 16u, 64u, 1024u}) {
        const support::Cloud ordinary = support::ordinary_cloud(count, random);
        for (const support::Cloud& cloud : support::doubtful_clouds(count, random)) {
            for (const Projection::Way way : Projection::ways) {
                // Of few points a seventh, in turn.
                if (count < 1024 && turn++ % 7 != 0) continue;
                for (const double tolerance : {0.0, 0x1p-21}) {
                    // Within a tolerance the ordinary ones are floats alone: of one coordinate 8.7 was seen where q
                    // cancels, of both 8.1 where s is infinite.
                    const double most = (tolerance > 0.0 ? 10.0 * support::limit::times_by_vectors() : limit_of_any) *
                                        support::limit::noise;
                    const double cost =
                        support::worst_over_ordinary_within(most, Projection(ordinary, way, Tolerance{tolerance}),
                                                            Projection(cloud, way, Tolerance{tolerance}));
                    CHECK_MESSAGE(cost <= most, cloud.name, ": ", cost, " times, ", count, " points, layout ",
                                  static_cast<int>(way), ", tolerance ", tolerance);
                }
            }
        }
    }
}

TEST_CASE("within a sixteenth of a texel points behind the projector cost little more than those in front") {
    Random random(59);
    constexpr std::size_t count = 4096;
    const support::Cloud in_front = support::ordinary_cloud(count, random);
    support::Cloud behind = in_front, either_side = in_front, far = in_front, some_next_to_zero = in_front;
    behind.name = "behind";
    either_side.name = "on either side";
    far.name = "far from the origin";
    some_next_to_zero.name = "every 97th next to q = 0";
    const glm::dvec3 place(3e4, -2e4, 1e4);
    far.matrix[3] -= glm::dmat4(far.matrix) * glm::dvec4(place, 0.0);
    for (std::size_t i = 0; i < count; ++i) {
        glm::vec3& point = behind.points[i];
        point.z = -point.z + 1.0f;
        if (i % 64 < 32) either_side.points[i] = point;
        if (i % 97 == 0) some_next_to_zero.points[i].z = 0.5f + 0.01f * point.x + 0.02f * point.y - 1e-4f;
        far.points[i] += glm::vec3(place);
    }
    for (const support::Cloud* cloud : {&behind, &either_side, &far, &some_next_to_zero}) {
        for (const Projection::Way way : {Projection::Way::interleaved_lit, Projection::Way::planar,
                                          Projection::Way::lit_only, Projection::Way::pairs}) {
            const double most = cloud == &some_next_to_zero ? 6.0 : 4.0;
            const Tolerance tolerance = texgen::texels(1.0 / 16.0, 1024.0);
            const double cost = support::worst_over_ordinary_within(most, Projection(in_front, way, tolerance),
                                                                    Projection(*cloud, way, tolerance));
            CHECK_MESSAGE(cost <= most, cloud->name, ": ", cost, " times, layout ", static_cast<int>(way));
        }
    }
}

TEST_CASE("within a tolerance points cost little more where their arrays do not begin with a line of a cache") {
    Random random(60);
    constexpr std::size_t count = 32768;
    constexpr double most = 1.5;
    const support::Cloud cloud = support::ordinary_cloud(count, random);
    const Planes planes(cloud.points);
    const texgen::WorldTexgen texgen(cloud.matrix);
    std::vector<float> s(count + 32), t(s.size());
    const auto alone = texgen::world_space(planes.x, planes.y, planes.z);
    for (const auto& positions : {alone, alone.within({glm::vec3(-9.0f), glm::vec3(9.0f)})}) {
        const auto run = [&](std::size_t behind) {
            return [&, of_s = support::behind_line(s, behind, count), of_t = support::behind_line(t, behind, count)] {
                project(texgen, positions, texgen::whole_texture(), {of_s, of_t}, texgen::texels(1.0 / 16.0, 1024.0));
            };
        };
        const double ratio = support::worst_over_ordinary_within(most, run(0), run(4));
        CHECK_MESSAGE(ratio <= most, ratio, " times");
    }
}

TEST_CASE("points among which some are no numbers cost little more than those that are numbers") {
    Random random(61);
    constexpr std::size_t count = 4096;
    const support::Cloud ordinary = support::ordinary_cloud(count, random);
    for (const std::size_t step : {8u, 32u, 256u}) {
        support::Cloud some = ordinary;
        for (std::size_t i = 1; i < count; i += step) some.points[i][random.integer(0, 2)] = support::nan_float;
        for (const Projection::Way way :
             {Projection::Way::interleaved_lit, Projection::Way::planar, Projection::Way::pairs}) {
            for (const Tolerance tolerance : {texgen::exact, texgen::texels(1.0 / 16.0, 1024.0)}) {
                const double most = 4.0;
                const double cost = support::worst_over_ordinary_within(most, Projection(ordinary, way, tolerance),
                                                                        Projection(some, way, tolerance));
                CHECK_MESSAGE(cost <= most, "one of ", step, ": ", cost, " times, layout ", static_cast<int>(way),
                              ", tolerance ", tolerance.value);
            }
        }
    }
}

TEST_CASE("the points of an orthographic decal, and a few at the projector's own place, cost little more than others") {
    Random random(62);
    constexpr std::size_t count = 4096;
    const support::Cloud ordinary = support::ordinary_cloud(count, random);
    // x/16 + 1/2 is a tie for a large part of the floats up to 8; decimals make fewer, but in most blocks one.
    const glm::dmat4 aligned = support::matrix_of_rows({0x1p-4, 0.0, 0.0, 0.5}, {0.0, 0x1p-4, 0.0, 0.5},
                                                       {0.0, 0.0, 0x1p-4, 0.5}, {0.0, 0.0, 0.0, 1.0});
    const glm::dmat4 turned = support::matrix_of_rows({0.04, 0.03, 0.0, 0.5}, {-0.03, 0.04, 0.0, 0.5},
                                                      {0.0, 0.0, 0.05, 0.5}, {0.0, 0.0, 0.0, 1.0});
    std::vector<support::Cloud> clouds{{"aligned", aligned, {}}, {"turned", turned, {}}, ordinary};
    for (std::size_t i = 0; i < count; ++i) {
        clouds[0].points.push_back(random.vector3(8.0));
        clouds[1].points.push_back(random.vector3(10.0));
        if (i % 64 == 0) clouds[2].points[i] = glm::vec3(0.0f, 0.0f, 0.5f);
    }
    clouds[2].name = "one of 64 at q = 0";
    for (const support::Cloud& cloud : clouds) {
        for (const Projection::Way way :
             {Projection::Way::interleaved_lit, Projection::Way::planar, Projection::Way::pairs}) {
            for (const Tolerance tolerance : {texgen::exact, texgen::texels(1.0 / 512.0, 4096.0)}) {
                const bool may_be_rounded = tolerance.value > 0.0 && &cloud != &clouds[2];
                const double most = may_be_rounded ? 2.5 : 6.0;
                const double cost = support::worst_over_ordinary_within(most, Projection(ordinary, way, tolerance),
                                                                        Projection(cloud, way, tolerance));
                CHECK_MESSAGE(cost <= most, cloud.name, ": ", cost, " times, layout ", static_cast<int>(way),
                              ", tolerance ", tolerance.value);
            }
        }
    }
}

TEST_CASE("one point in an array costs less than a vector of them") {
    constexpr double most = 0.9;
    Random random(60);
    support::Cloud sixteen = support::ordinary_cloud(16, random), one = sixteen;
    one.points.resize(1);
    for (const Projection::Way way : {Projection::Way::interleaved_lit, Projection::Way::pairs}) {
        for (const Tolerance tolerance : {texgen::exact, texgen::texels(1.0 / 16.0, 1024.0)}) {
            const double cost = support::worst_over_ordinary_within(most, Projection(sixteen, way, tolerance),
                                                                    Projection(one, way, tolerance));
            CHECK_MESSAGE(cost <= most, cost, " of sixteen, layout ", static_cast<int>(way));
        }
    }
}

TEST_CASE("points that fill no last vector cost little more than those that do") {
    constexpr double most = 1.5;
    Random random(58);
    const support::Cloud cloud = support::ordinary_cloud(256, random);
    const texgen::WorldTexgen texgen(cloud.matrix);
    std::vector<glm::vec4> padded, strq(256);
    std::vector<glm::vec2> st(256);
    for (const glm::vec3& point : cloud.points) padded.emplace_back(point, 1.0f);
    const auto generates = [&](std::size_t count) {
        return [&, count] {
            generate(texgen, texgen::world_space(&padded[0].x, count, sizeof padded[0]), std::span(strq).first(count));
        };
    };
    const auto projects = [&](std::size_t count) {
        return [&, count] {
            project(texgen, texgen::world_space(&padded[0].x, count, sizeof padded[0]), std::span(st).first(count));
        };
    };
    const double of_generate = support::worst_over_ordinary_within(most, generates(256), generates(255));
    const double of_project = support::worst_over_ordinary_within(most, projects(256), projects(255));
    CHECK(of_generate <= most);
    CHECK(of_project <= most);
}

TEST_CASE("the worst segments cost eight times ordinary ones at most, at every size, whatever is asked for") {
    Random random(57);
    for (const std::size_t count : {1u, 16u, 64u, 1024u}) {
        const support::Stretch ordinary = support::ordinary_stretch(count, random);
        for (const support::Stretch& stretch : support::doubtful_stretches(count, random)) {
            std::vector<float> s(count), t(count), lit(count);
            for (const bool is_lit_asked : {false, true}) {
                for (const double tolerance : {0.0, 0x1p-21}) {
                    const auto run = [&](const support::Stretch& of) {
                        return [&, of] {
                            interpolate(of.segment, of.alpha, texgen::whole_texture(),
                                        {s, t, {}, is_lit_asked ? std::span<float>(lit) : std::span<float>()},
                                        Tolerance{tolerance});
                        };
                    };
                    const double cost = support::worst_over_ordinary_within(limit_of_any, run(ordinary), run(stretch));
                    CHECK_MESSAGE(cost <= limit_of_any, stretch.name, ": ", cost, " times, ", count,
                                  " values, tolerance ", tolerance, std::string(is_lit_asked ? ", lit" : ""));
                }
            }
        }
    }
}

TEST_CASE("to assert that points are in their box takes no longer than to project them") {
    constexpr double most = 2.0;
    const std::vector<glm::vec3> points(1024, glm::vec3(0.25f));
    std::vector<float> s(points.size()), t(points.size());
    const texgen::WorldTexgen texgen(glm::dmat4(1.0));
    const auto project_with = [&](const texgen::Positions<texgen::World>& positions) {
        project(texgen, positions, texgen::whole_texture(), {s, t}, texgen::texels(1.0 / 16.0, 1024.0));
    };
    const texgen::Positions<texgen::World> positions = texgen::world_space(points);
    const double of_box = support::worst_over_ordinary_within(
        most, [&] { project_with(positions); },
        [&] {
            project_with(positions.within({glm::vec3(0.0f), glm::vec3(1.0f)}));
        });
    CHECK(of_box <= most);
}
