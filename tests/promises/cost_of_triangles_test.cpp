// What triangles cost: no input of a function takes many times the ordinary one's time. Ratios of times that were taken
// in turn, as users compile them.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "judges/fragments.hpp"
#include "support/float_state.hpp"
#include "support/hard_triangles.hpp"
#include "support/has_avx512.hpp"
#include "support/hex.hpp"
#include "support/limits.hpp"
#include "support/near_cut.hpp"
#include "support/random.hpp"
#include "support/stopwatch.hpp"
#include "texgen/batch.hpp"
#include "texgen/footprint.hpp"
#include "texgen/interpolate.hpp"

namespace {

namespace limit = support::limit;

using support::everywhere;
using support::hex;
using support::Random;
using support::Shot;
using texgen::FragmentRect;
using texgen::Tolerance;
using texgen::Triangle;
using texgen::WindowVertex;

// Of masks alone, where ordinary ones are made at once.
const double masks_by_vectors = support::has_whole_avx512() ? 1.25 : 1.0;

constexpr std::array<Tolerance, 2> tolerances{texgen::exact, texgen::texels(1.0 / 512.0, 4096.0)};

// One triangle with its set-up, over its rectangle: s, t and the mask.
class Workload {
public:
    Workload(const Shot& shot, Tolerance tolerance)
        : shot_(shot), tolerance_(tolerance), s_(support::count_of(shot.rect)), t_(s_.size()), lit_(s_.size()) {}

    void operator()() {
        interpolate(support::setup_of(shot_.triangle, everywhere(), tolerance_), shot_.rect, {s_, t_, {}, lit_});
    }

private:
    Shot shot_;
    Tolerance tolerance_;
    std::vector<float> s_, t_, lit_;
};

Shot ordinary(int width, int height) {
    return {{{{3.7f, 5.2f}, 1.1f, {0.1f, 0.2f, 0.3f, 1.0f}},
             {{1030.1f, 2.4f}, 1.4f, {1.2f, 0.1f, 0.3f, 1.3f}},
             {{410.0f, 800.7f}, 1.2f, {0.5f, 1.1f, 0.3f, 1.2f}}},
            {300, 100, width, height}};
}

// The time of a shot over that of the ordinary one of its size; taken anew while it is above the most that it may be.
double cost(const Shot& shot, Tolerance tolerance, double most) {
    return support::worst_over_ordinary_within(most, Workload(ordinary(shot.rect.width, shot.rect.height), tolerance),
                                               Workload(shot, tolerance));
}

// The least of some short times: quick, for many shots.
double least_time(const Shot& shot, Tolerance tolerance) {
    const support::Calls calls = support::calls_of(Workload(shot, tolerance));
    double least = HUGE_VAL;
    for (int i = 0; i < 8; ++i) least = std::min(least, support::nanoseconds_of(calls, 4));
    return least;
}

void require_cost(const char* name, const Shot& shot, double most) {
    for (const Tolerance tolerance : tolerances) {
        const double ratio = cost(shot, tolerance, most);
        REQUIRE_MESSAGE(ratio <= most, name, ", tolerance ", tolerance.value, ": ", ratio, " times in ", hex(shot));
    }
}

WindowVertex vertex(float x, float y, float w, float s, float t, float q) { return {{x, y}, w, {s, t, 0.5f, q}}; }

}  // namespace

TEST_CASE("ties whose terms are 110 powers of two apart take at most three times what those of 60 take") {
    // Two corners on ties, and small; the third makes others of what is left of it.
    const auto ties = [](int exponent) {
        const float k = std::ldexp(1.0f, exponent);
        return Shot{{{{0.5f, 40.5f}, 1.0f, {0x1.80005ap0f * k, 0x1.000032p0f * k, 0x1.00000cp0f * k, 3.0f}},
                     {{24.5f, 16.5f}, 1.0f, {0x1.80002ap0f * k, 0x1.000052p0f * k, 0x1.000014p0f * k, 3.0f}},
                     {{40.5f, 8.5f}, 1.0f, {0x1.800012p+1f, 0x1.000002p+1f, 0x1.00003ap+1f, 3.0f}}},
                    {16, 2, 64, 4}};
    };
    for (const int exponent : {-85, -95, -100, -110}) {
        const double ratio = support::worst_over_ordinary_within(3.0, Workload(ties(-60), texgen::exact),
                                                                 Workload(ties(exponent), texgen::exact));
        REQUIRE_MESSAGE(ratio <= 3.0, exponent, ": ", ratio, " times");
    }
}

TEST_CASE("a triangle that the near plane cuts costs at most 16 times the ordinary one, and 4 times in 99 of 100") {
    // Three or four in a thousand are dearer than 4 times: so many that chance does not make ten of them.
    constexpr int count = 1000;
    for (const auto& [width, height] : {std::array{8, 8}, std::array{64, 4}}) {
        for (const Tolerance tolerance : tolerances) {
            Random random(71);
            int far_corners = 0;
            int dear = 0;
            const double of_ordinary = least_time(ordinary(width, height), tolerance);
            for (int i = 0; i < count; ++i) {
                const auto [triangle, rect] = support::near_cut(random, width, height);
                std::array<double, 3> seconds{};
                for (int order = 0; order < 3; ++order) {
                    const Shot shot{support::rotated(triangle, order), rect};
                    far_corners += std::fabs(shot.triangle.a.window.x) > 1e4f;
                    auto& of_order = seconds[static_cast<std::size_t>(order)];
                    of_order = least_time(shot, tolerance);
                    if (of_order > limit::near_plane * of_ordinary)
                        of_order = cost(shot, tolerance, limit::near_plane) * of_ordinary;
                    INFO(width, " x ", height, ", tolerance ", tolerance.value, " in ", hex(shot));
                    REQUIRE(of_order <= limit::near_plane * of_ordinary);
                }
                const auto [least, largest] = std::minmax_element(seconds.begin(), seconds.end());
                const auto shot_of = [&, t = triangle, r = rect](const double* order) {
                    return Shot{support::rotated(t, static_cast<int>(order - seconds.data())), r};
                };
                constexpr double most = limit::near_plane_99_of_100;
                dear += *largest > most * of_ordinary && cost(shot_of(largest), tolerance, most) > most;
                if (*largest <= limit::rotation * *least) continue;
                const double ratio = support::worst_over_ordinary_within(
                    limit::rotation, Workload(shot_of(least), tolerance), Workload(shot_of(largest), tolerance));
                REQUIRE_MESSAGE(ratio <= limit::rotation, hex(shot_of(largest)));
            }
            CHECK_MESSAGE(dear <= count / 100, width, " x ", height, ", tolerance ", tolerance.value);
            CHECK(far_corners > count / 5);
        }
    }
}

TEST_CASE("footprints by ids of triangles that are refused cost what others do") {
    Random random(75);
    constexpr int width = 128, height = 16;
    std::vector<Triangle> triangles, refused;
    for (int i = 0; i < 500; ++i) {
        triangles.push_back(support::make_triangle(support::Family::friendly, random));
        refused.push_back(triangles.back());
        refused.back().b = refused.back().a;
    }
    std::vector<std::uint32_t> ids;
    for (int i = 0; i < width * height; ++i) ids.push_back(static_cast<std::uint32_t>(random.integer(0, 499)));
    std::vector<float> dx(ids.size()), dy(ids.size()), level(ids.size());
    texgen::TriangleBatch of_triangles(everywhere()), of_refused(everywhere());
    of_triangles.assign(triangles);
    of_refused.assign(refused);
    const auto run = [&](const texgen::TriangleBatch& batch) {
        return [&] {
            texgen::Footprints out;
            out.dsdx = dx;
            out.dsdy = dy;
            out.level = level;
            footprint(batch, ids, {300, 300, width, height}, {1024.0, 1024.0}, out);
        };
    };
    const double ratio = support::worst_over_ordinary_within(2.0, run(of_triangles), run(of_refused));
    CHECK_MESSAGE(ratio <= 2.0, ratio, " times");
}

TEST_CASE(
    "a tolerance finer than the floats of a tile costs at most 1.6 times what exact does, of few chunks three times") {
    Random random(73);
    const Tolerance fine = tolerances[1];
    for (const auto& [width, height, limit] :
         {std::tuple{64, 4, 3.0}, std::tuple{65, 16, 1.6}, std::tuple{200, 16, 1.6}}) {
        for (int i = 0; i < 60; ++i) {
            Shot shot{support::make_triangle(support::Family::friendly, random), {300, 300, width, height}};
            // A repeated slide, far from where it begins.
            for (WindowVertex* corner : support::vertices(shot.triangle)) {
                corner->strq.x += corner->strq.w * random.uniform_float(1e2, 1e5);
                corner->strq.y += corner->strq.w * random.uniform_float(-1e4, 1e4);
            }
            const double ratio =
                support::worst_over_ordinary_within(limit, Workload(shot, texgen::exact), Workload(shot, fine));
            REQUIRE_MESSAGE(ratio <= limit, ratio, " times in ", hex(shot));
        }
    }
}

TEST_CASE("a triangle whose cut corner comes first costs what it costs with the other corners first") {
    const Triangle cut{{{-544164.188f, 27988.3828f}, 0.1f, {-68.9127731f, -22.6434841f, -10.0570049f, -24.988451f}},
                       {{810.03656f, 428.25708f}, 97.3841324f, {82.398613f, 24.5005531f, 16.0539932f, 30.6767712f}},
                       {{525.804382f, 361.901428f}, 68.5282516f, {38.480442f, 12.9906549f, 11.8506365f, 8.97344875f}}};
    Shot shots[3];
    for (int order = 0; order < 3; ++order) {
        shots[order] = {support::rotated(cut, order), {169, 428, 256, 16}};
        require_cost("cut", shots[order], limit::any);
    }
    for (const Tolerance tolerance : tolerances) {
        for (int i = 0; i < 9; ++i) {
            const double ratio = support::worst_over_ordinary_within(limit::rotation, Workload(shots[i / 3], tolerance),
                                                                     Workload(shots[i % 3], tolerance));
            REQUIRE_MESSAGE(ratio <= limit::rotation, "tolerance ", tolerance.value, ": ", ratio, " times in order ",
                            i % 3);
        }
    }
}

TEST_CASE("fragments that all lie between two floats cost at most 8 times the ordinary ones") {
    // s = 1/2 + (2 i + 1) 2^-25 at fragment i of every row, with parallel views; then with the row's own 1 / (q/w), and
    // with a corner a hair beside its place.
    constexpr float unit = 0x1p-25f;
    for (const auto& [width, height] : {std::array{8, 8}, std::array{64, 4}, std::array{64, 64}}) {
        const FragmentRect rect{0, 0, width, height};
        const Triangle ties{vertex(0, 0, 1, 0.5f, 0.5f, 1), vertex(1024, 0, 1, 0.5f + 2048 * unit, 0.5f, 1),
                            vertex(0, 1024, 1, 0.5f, 0.5f + 4096 * unit, 1)};
        require_cost("ties", {ties, rect}, limit::any);
        Triangle rows = ties;
        rows.c.strq *= 2.0f;
        require_cost("ties of the first rows, q by rows", {rows, rect}, limit::any);
        Triangle beside = ties;
        beside.b.window.y = 1e-5f;
        require_cost("next to ties", {beside, rect}, limit::any);
    }
}

TEST_CASE("a tile that q = 0 crosses costs at most 24 times the ordinary one") {
    Random random(72);
    int crossed = 0;
    for (const auto& [width, height] : {std::array{8, 8}, std::array{64, 4}, std::array{256, 16}}) {
        for (int i = 0; i < 40; ++i) {
            // Through the middle of the tile, at any slope; the first times along a row of fragments.
            const double angle = i < 3 ? 0.0 : random.uniform(0.0, 6.3);
            const glm::dvec2 across(std::sin(angle), std::cos(angle));
            const glm::dvec2 middle(400.0 + 0.5 * width, 300.5 + height / 2);
            Triangle triangle = support::make_triangle(support::Family::friendly, random);
            for (WindowVertex* corner : support::vertices(triangle)) {
                const glm::dvec2 from = glm::dvec2(corner->window) - middle;
                corner->strq.w = static_cast<float>((from.x * across.x + from.y * across.y) *
                                                    static_cast<double>(corner->clip_w) / 500.0);
            }
            const Shot shot{triangle, {400, 300, width, height}};
            crossed += support::detail::changes_sign(shot, support::ExactTriangle(triangle), 3);
            for (const Tolerance tolerance : tolerances) {
                const double ratio = least_time(shot, tolerance) / least_time(ordinary(width, height), tolerance);
                if (ratio > limit::q_is_zero) require_cost("crossed", shot, limit::q_is_zero);
            }
        }
    }
    CHECK(crossed > 80);
}

namespace {

// t is 0 along the upper edge, s along the left one: as of a quadrilateral of a user interface, or of a chart of a
// lightmap, whose corners are centres of fragments.
Triangle with_edges_at(float x, float y) {
    return {vertex(x, y, 1.0f, 0.0f, 0.0f, 1.25f), vertex(x + 600.0f, y, 2.0f, 1.5f, 0.0f, 2.0f),
            vertex(x, y + 512.0f, 1.5f, 0.0f, 1.0f, 1.5f)};
}

}  // namespace

TEST_CASE("fragments on an edge along which a coordinate is 0 cost at most 8 times the ordinary ones, 20 in a column") {
    for (const Tolerance tolerance : tolerances) {
        for (const auto& [width, height] :
             {std::pair{1, 1}, {8, 1}, {1, 8}, {8, 8}, {64, 1}, {1, 64}, {64, 4}, {512, 1}}) {
            std::vector<float> s(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)), t(s.size());
            const auto call = [&](const Triangle& triangle, FragmentRect rect, bool is_mask) {
                return [&, rect, is_mask, setup = support::setup_of(triangle, texgen::whole_texture(), tolerance)] {
                    if (is_mask)
                        interpolate(setup, rect, {{}, {}, {}, s});
                    else
                        interpolate(setup, rect, {s, t});
                };
            };
            for (const bool is_mask : {false, true}) {
                if (is_mask && height > 8) continue;  // each row has a span
                const double most = is_mask ? 16.0 * masks_by_vectors : width == 1 && height > 1 ? 20.0 : 8.0;
                const auto ratio = [&](float x, float y, FragmentRect rect) {
                    return support::worst_over_ordinary_within(most, call(with_edges_at(90.3f, 190.3f), rect, is_mask),
                                                               call(with_edges_at(x, y), rect, is_mask));
                };
                INFO(width, " x ", height, ", tolerance ", tolerance.value, std::string(is_mask ? ", mask" : ""));
                CHECK(ratio(90.3f, 200.5f, {140, 200, width, height}) <= most);
                CHECK(ratio(100.5f, 190.3f, {100, 240, width, height}) <= most);
            }
        }
    }
}

TEST_CASE("tiles of a batch on such edges cost at most 8 times the ordinary ones, and their masks alone 32 times") {
    for (const auto& [width, height] : {std::pair{8, 8}, {64, 1}, {1, 64}, {64, 4}, {16, 16}}) {
        const std::vector<FragmentRect> rects(8, {100, 200, width, height});
        std::vector<float> s(8 * support::count_of(rects[0])), t(s.size());
        for (const bool is_mask : {false, true}) {
            const auto call = [&](float x, float y) {
                texgen::TriangleBatch batch(texgen::whole_texture());
                batch.assign(std::vector<Triangle>(8, with_edges_at(x, y)));
                return [&, is_mask, batch] {
                    interpolate(batch, rects, is_mask ? texgen::Texcoords{{}, {}, {}, s} : texgen::Texcoords{s, t});
                };
            };
            const double most = is_mask ? 32.0 * masks_by_vectors : 8.0;
            for (const auto& [x, y] : {std::pair{90.3f, 200.5f}, {100.5f, 190.3f}, {100.5f, 200.5f}}) {
                const double ratio = support::worst_over_ordinary_within(most, call(90.3f, 190.3f), call(x, y));
                CHECK_MESSAGE(ratio <= most, width, " x ", height, std::string(is_mask ? ", mask: " : ": "), ratio,
                              " times");
            }
        }
    }
}

TEST_CASE("a row on which q is 0 everywhere, and a rectangle far outside of the window, cost at most 24 and 8 times") {
    const Triangle zero_row{vertex(0, -7.5f, 1, 0.3f, 0.2f, -1), vertex(0, 24.5f, 1, 0.5f, 0.8f, 1),
                            vertex(1000, 8.5f, 1, 0.2f, 0.9f, 0)};
    require_cost("q = 0 along a row", {zero_row, {30, 8, 64, 4}}, limit::q_is_zero);
    for (const int x : {1000000000, -1000000000})
        require_cost("far away", {ordinary(64, 4).triangle, {x, 100, 64, 4}}, limit::any);
}

// As users have it: the other times are of a state in which subnormal numbers cost nothing.
TEST_CASE("where no coordinate is subnormal, subnormal numbers do not double the time") {
    const auto require_same_cost = [](const char* name, const support::Calls& calls) {
        double ratio = HUGE_VAL;
        for (int attempt = 0; attempt < 5 && ratio > 2.0; ++attempt) {
            std::array<double, 2> least{HUGE_VAL, HUGE_VAL};
            for (int turn = 0; turn < 30; ++turn)
                for (std::size_t i = 0; i < least.size(); ++i)
                    support::under(support::float_states[i],
                                   [&] { least[i] = std::min(least[i], support::detail::nanoseconds_of(calls, 8)); });
            ratio = least[0] / least[1];
        }
        CHECK_MESSAGE(ratio <= 2.0, name, ": ", ratio, " times");
    };
    const auto cut = [](float s, float t) {
        return Triangle{vertex(-544164.188f, 27988.3828f, 0.1f, -69.1f * s, -22.6f * t, -25.1f),
                        vertex(810.03656f, 428.25708f, 97.3841324f, 82.3f * s, 24.5f * t, 30.7f),
                        vertex(525.804382f, 361.901428f, 68.5282516f, 38.5f * s, 12.9f * t, 8.97f)};
    };
    for (const Tolerance tolerance : tolerances) {
        for (const auto& [s, t] : {std::array{0.0f, 0.0f}, std::array{0.0f, 1.0f}, std::array{1.0f, 0.0f}}) {
            const Shot shot{cut(s, t), {169, 428, 64, 4}};
            require_same_cost("zeros", support::calls_of(Workload(shot, tolerance)));
        }
        // Weights that differ by a rounding.
        const float next = 1.0f + 0x1p-23f;
        const Triangle flat{vertex(0.0f, 0.0f, 1.0f, 0.1f, 0.2f, 1.0f), vertex(1000.0f, 0.0f, next, 0.9f, 0.3f, 1.0f),
                            vertex(0.0f, 1000.0f, 1.0f, 0.2f, 0.8f, 1.0f)};
        texgen::TriangleBatch batch(everywhere(), tolerance);
        batch.assign(std::vector<Triangle>(8, flat));
        const std::vector<FragmentRect> rects(8, {300, 300, 8, 8});
        std::vector<float> s(512), t(512);
        require_same_cost("weights", support::calls_of([&] { interpolate(batch, rects, {s, t, {}, {}}); }));
    }
}

TEST_CASE("a batch takes no longer than its triangles one by one, however large their tiles are") {
    constexpr double most = 1.4;
    const std::vector<Triangle> triangles(8, ordinary(1, 1).triangle);
    for (const Tolerance tolerance : tolerances) {
        texgen::TriangleBatch batch(texgen::whole_texture(), tolerance);
        for (const int size : {3, 8, 9, 12, 17, 24, 32, 40}) {
            const std::vector<FragmentRect> rects(triangles.size(), {300, 100, size, size});
            const std::size_t count = support::count_of(rects[0]), all = count * rects.size();
            // Which of the two is the faster depends on where the arrays begin: all the places count together.
            constexpr std::size_t page = 4096 / sizeof(float);
            std::vector<float> memory(3 * (all + 2 * page));
            const auto array = [&](std::size_t which, std::size_t place) {
                return std::span(memory).subspan(which * (all + 2 * page) + (1 + which) * place * (page / 16 + 4), all);
            };
            for (const bool is_lit_asked : {false, true}) {
                const auto outputs = [&](std::size_t place, std::size_t begin, std::size_t values) {
                    const auto part = [&](std::size_t which) { return array(which, place).subspan(begin, values); };
                    return texgen::Texcoords{part(0), part(1), {}, is_lit_asked ? part(2) : std::span<float>()};
                };
                const auto one_by_one = [&] {
                    for (std::size_t place = 0; place < 4; ++place)
                        for (std::size_t i = 0; i < rects.size(); ++i)
                            interpolate(support::setup_of(triangles[i], texgen::whole_texture(), tolerance), rects[i],
                                        outputs(place, i * count, count));
                };
                const auto together = [&] {
                    for (std::size_t place = 0; place < 4; ++place) {
                        batch.assign(triangles);
                        interpolate(batch, rects, outputs(place, 0, all));
                    }
                };
                const double ratio = support::worst_over_ordinary_within(most, one_by_one, together);
                CHECK_MESSAGE(ratio <= most, size, " x ", size, ", tolerance ", tolerance.value, ": ", ratio, " times");
            }
        }
    }
}

TEST_CASE(
    "one coordinate takes little more than s and t, and all three with the mask not much more than twice as long") {
    constexpr double most_alone = 2.25, most_of_all = 3.0;
    std::vector<float> s(256), t(256), r(256), lit(256);
    for (const Tolerance tolerance : tolerances) {
        const texgen::TriangleSetup setup =
            support::setup_of(ordinary(1, 1).triangle, texgen::whole_texture(), tolerance);
        for (const auto& [width, height] : {std::pair{1, 1}, {4, 4}, {8, 8}, {16, 16}, {64, 4}}) {
            const FragmentRect rect{300, 100, width, height};
            const std::size_t count = support::count_of(rect);
            const auto part = [&](std::vector<float>& all) { return std::span(all).first(count); };
            const auto over_both = [&](double limit, const texgen::Texcoords& out) {
                return support::worst_over_ordinary_within(
                    limit,
                    [&] {
                        interpolate(setup, rect, {part(s), part(t)});
                    },
                    [&] { interpolate(setup, rect, out); });
            };
            const double of_s = over_both(most_alone, {part(s)}), of_r = over_both(most_alone, {{}, {}, part(r)});
            const double of_all = over_both(most_of_all, {part(s), part(t), part(r), part(lit)});
            INFO(width, " x ", height, ", tolerance ", tolerance.value);
            CHECK(of_s <= most_alone);
            CHECK(of_r <= most_alone);
            CHECK(of_all <= most_of_all);
        }
    }
}

TEST_CASE("a column takes little more than a row of as many fragments, and a narrow tile than a wide one") {
    std::vector<float> s(4000), t(4000), lit(4000);
    struct Pair {
        int width, height, other_width, other_height;
        double most;
    };
    for (const Tolerance tolerance : tolerances) {
        const texgen::TriangleSetup setup =
            support::setup_of(ordinary(1, 1).triangle, texgen::whole_texture(), tolerance);
        for (const Pair& pair : {Pair{1, 8, 8, 1, 1.5},
                                 {1, 64, 64, 1, 1.5},
                                 {1, 200, 200, 1, 1.75},
                                 {1, 4000, 4000, 1, 1.5},
                                 {2, 64, 16, 8, 4.0},
                                 {7, 16, 8, 16, 2.5}}) {
            const auto call = [&](int width, int height) {
                return [&, rect = FragmentRect{300, 100, width, height}] {
                    const auto part = [&](std::vector<float>& all) {
                        return std::span(all).first(support::count_of(rect));
                    };
                    interpolate(setup, rect, {part(s), part(t), {}, part(lit)});
                };
            };
            const double ratio = support::worst_over_ordinary_within(
                pair.most, call(pair.other_width, pair.other_height), call(pair.width, pair.height));
            INFO(pair.width, " x ", pair.height, ", tolerance ", tolerance.value);
            CHECK(ratio <= pair.most);
        }
    }
}

TEST_CASE("the footprints of a column take little more than those of a row") {
    constexpr double most = 2.5;
    std::vector<float> values[4];
    for (std::vector<float>& all : values) all.resize(4000);
    for (const Tolerance tolerance : tolerances) {
        const texgen::FootprintSetup setup(
            support::setup_of(ordinary(1, 1).triangle, texgen::whole_texture(), tolerance), {1024.0, 1024.0});
        for (const int size : {64, 4000}) {
            const auto part = [&](std::size_t i) { return std::span(values[i]).first(static_cast<std::size_t>(size)); };
            texgen::Footprints level;
            level.level = part(0);
            for (const texgen::Footprints& out : {texgen::Footprints{part(0), part(1), part(2), part(3)}, level}) {
                const auto call = [&](FragmentRect rect) { return [&, rect] { footprint(setup, rect, out); }; };
                const double ratio =
                    support::worst_over_ordinary_within(most, call({300, 100, size, 1}), call({300, 100, 1, size}));
                INFO(size, " fragments, tolerance ", tolerance.value);
                CHECK(ratio <= most);
            }
        }
    }
}

TEST_CASE(
    "a small tile takes little more where a coordinate has one side or none, or sides far away, than in a texture") {
    constexpr double most = 1.5;
    std::vector<float> s(64), t(64), lit(64);
    for (const Tolerance tolerance : tolerances) {
        const Triangle triangle = ordinary(1, 1).triangle;
        const texgen::TriangleSetup both = support::setup_of(triangle, texgen::whole_texture(), tolerance);
        for (const auto& [first, last] : {std::pair{glm::dvec2(0.0), HUGE_VAL},
                                          {glm::dvec2(-HUGE_VAL), HUGE_VAL},
                                          {glm::dvec2(-HUGE_VAL, 0.0), HUGE_VAL},
                                          {glm::dvec2(0.0), 1e30}}) {
            const texgen::TriangleSetup open =
                support::setup_of(triangle, texgen::atlas_tile(first, glm::dvec2(last)), tolerance);
            for (const int width : {1, 8}) {
                const FragmentRect rect{300, 100, width, width};
                const auto part = [&](std::vector<float>& all) {
                    return std::span(all).first(support::count_of(rect));
                };
                const texgen::Texcoords out{part(s), part(t), {}, part(lit)};
                REQUIRE(both.work(rect) == texgen::Work::divide);
                REQUIRE(open.work(rect) == texgen::Work::divide);
                const double ratio = support::worst_over_ordinary_within(
                    most, [&] { interpolate(both, rect, out); }, [&] { interpolate(open, rect, out); });
                INFO(width, " x ", width, ", tolerance ", tolerance.value, ", from ", first.x, ", ", first.y, " to ",
                     last);
                CHECK(ratio <= most);
            }
        }
    }
}

TEST_CASE("long runs of a visibility buffer take little more than rows of their triangles") {
    constexpr double most = 2.5;
    const Triangle triangle = ordinary(1, 1).triangle;
    const FragmentRect rect{100, 100, 512, 2};
    const std::vector<std::uint32_t> ids(support::count_of(rect), 0);
    std::vector<float> s(ids.size()), t(ids.size()), lit(ids.size());
    for (const Tolerance tolerance : tolerances) {
        texgen::TriangleBatch batch(texgen::whole_texture(), tolerance);
        batch.assign(std::span(&triangle, 1));
        const texgen::TriangleSetup setup = support::setup_of(triangle, texgen::whole_texture(), tolerance);
        const double ratio = support::worst_over_ordinary_within(
            most,
            [&] {
                interpolate(setup, rect, {s, t, {}, lit});
            },
            [&] {
                interpolate(batch, ids, rect, {s, t, {}, lit});
            });
        CHECK_MESSAGE(ratio <= most, "tolerance ", tolerance.value, ": ", ratio, " times");
    }
}

TEST_CASE(
    "a mask alone costs at most 12 times one that is lit at once where a side crosses the tile or is its plane, 8 of a "
    "large one, and up to 4 more with a tolerance") {
    const auto shot_with = [](int width, int height, const auto& change) {
        Shot shot = ordinary(width, height);
        for (WindowVertex* corner : support::vertices(shot.triangle)) change(*corner);
        return shot;
    };
    for (const auto& [width, height] :
         {std::array{8, 8}, std::array{64, 4}, std::array{256, 16}, std::array{1024, 4}}) {
        const glm::vec2 middle(300.0f + 0.5f * static_cast<float>(width), 100.0f + 0.5f * static_cast<float>(height));
        const auto along = [&](const WindowVertex& corner, glm::vec2 slope) {
            return glm::dot(corner.window - middle, slope) / 1000.0f * corner.clip_w;
        };
        const Shot shots[] = {
            shot_with(width, height,
                      [&](WindowVertex& c) {
                          c.strq.x = along(c, {1.0f, 0.3f});
                      }),
            shot_with(width, height,
                      [&](WindowVertex& c) {
                          c.strq.y = along(c, {-0.2f, 0.8f});
                      }),
            shot_with(width, height,
                      [&](WindowVertex& c) {
                          c.strq.y = c.strq.w + along(c, {0.7f, -0.7f});
                      }),
            shot_with(width, height, [&](WindowVertex& c) { c.strq.x = 0.0f; }),
            shot_with(width, height, [&](WindowVertex& c) { c.strq.x = c.strq.y = c.strq.w; }),
        };
        std::vector<float> lit(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
        for (const Tolerance tolerance : {texgen::exact, texgen::texels(1.0 / 16.0, 1024.0)}) {
            // Spans of few fragments, of which some columns are asked for where a side follows a diagonal; and planes of
            // a side, beside which floats within a tolerance may be.
            const double of_exact = width == 8 ? 12.0 : width == 64 ? 10.0 : 8.0;
            const double most = (tolerance.value > 0.0 ? (width == 8 ? 16.0 : 12.0) : of_exact) * masks_by_vectors;
            const auto call = [&](const Shot& shot) {
                return [&lit, setup = support::setup_of(shot.triangle, texgen::whole_texture(), tolerance),
                        rect = shot.rect] {
                    interpolate(setup, rect, {{}, {}, {}, lit});
                };
            };
            for (const Shot& shot : shots) {
                const double ratio =
                    support::worst_over_ordinary_within(most, call(ordinary(width, height)), call(shot));
                REQUIRE_MESSAGE(ratio <= most, width, " x ", height, ", tolerance ", tolerance.value, ": ", ratio,
                                " times in ", hex(shot));
            }
        }
    }
}

TEST_CASE("masks of a batch that are lit at once take less than s and t do, the less the larger the tiles are") {
    constexpr std::size_t count = 64;
    constexpr double most_of[3][2] = {{0.75, 0.9}, {0.6, 0.6}, {0.4, 0.5}};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 2; ++j) {
            const int size = 8 << i;
            const double most = most_of[i][j];
            const Tolerance tolerance = tolerances[j];
            const Shot shot = ordinary(size, size);
            texgen::TriangleBatch batch(texgen::atlas_tile({-HUGE_VAL, 0.0}, {HUGE_VAL, 1.0}), tolerance);
            batch.assign(std::vector<Triangle>(count, shot.triangle));
            const std::vector<FragmentRect> rects(count, shot.rect);
            std::vector<float> s(count * support::count_of(shot.rect)), t(s.size()), lit(s.size());
            const double ratio = support::worst_over_ordinary_within(
                most,
                [&] {
                    interpolate(batch, rects, {s, t, {}, {}});
                },
                [&] {
                    interpolate(batch, rects, {{}, {}, {}, lit});
                });
            REQUIRE_MESSAGE(ratio <= most, size, ", tolerance ", tolerance.value, ": ", ratio);
            REQUIRE(std::count(lit.begin(), lit.end(), 1.0f) == static_cast<std::ptrdiff_t>(lit.size()));
        }
    }
}
