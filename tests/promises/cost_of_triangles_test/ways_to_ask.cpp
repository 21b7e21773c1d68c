// Batches, ids, columns and outputs: one way to ask takes little more than another.

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "judges/fragments.hpp"
#include "promises/cost_of_triangles_test/ordinary.hpp"
#include "support/outputs.hpp"
#include "support/random.hpp"
#include "support/shot.hpp"
#include "support/stopwatch.hpp"
#include "support/triangles.hpp"
#include "texgen/batch.hpp"
#include "texgen/footprint.hpp"
#include "texgen/interpolate.hpp"

namespace triangle_costs {

TEST_CASE("footprints by ids of triangles that are refused cost what others do") {
    support::Random random(75);
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

// The time of call(arrays) where these begin 4 floats behind a line of a cache, over that where they begin with one.
template <std::size_t Arrays>
double behind_line_over_at_line(double most, std::size_t count, const auto& call) {
    std::array<std::vector<float>, Arrays> memory;
    for (std::vector<float>& array : memory) array.resize(count + 32);
    const auto run = [&](std::size_t behind) {
        std::array<std::span<float>, Arrays> arrays;
        for (std::size_t i = 0; i < Arrays; ++i) arrays[i] = support::behind_line(memory[i], behind, count);
        return [&call, arrays] { call(arrays); };
    };
    return support::worst_over_ordinary_within(most, run(0), run(4));
}

TEST_CASE("within a tolerance rows take little longer where their arrays do not begin with a line of a cache") {
    const texgen::TriangleSetup within =
        support::setup_of(ordinary(1, 1).triangle, texgen::whole_texture(), tolerances[1]);
    // In the first cache; in the second; in none, where memory takes its time, whatever the place.
    for (const glm::ivec2 size : {glm::ivec2(1024, 4), glm::ivec2(1024, 64), glm::ivec2(4096, 2048)}) {
        const FragmentRect rect{300, 100, size.x, size.y};
        const double ratio = behind_line_over_at_line<2>(1.75, support::count_of(rect), [&](const auto& arrays) {
            interpolate(within, rect, {arrays[0], arrays[1]});
        });
        CHECK_MESSAGE(ratio <= 1.75, size.x, " x ", size.y, ": ", ratio, " times");
    }
}

// s and t of a batch's tiles, or all there is of them, in arrays of so many floats.
template <std::size_t Arrays>
void check_tiles_behind_line(const glm::ivec2& size, double most, std::size_t floats) {
    texgen::TriangleBatch within(texgen::whole_texture(), tolerances[1]);
    const auto fragments = static_cast<std::size_t>(size.x * size.y), tiles = floats / fragments;
    within.assign(std::vector<Triangle>(tiles, ordinary(1, 1).triangle));
    const std::vector<FragmentRect> rects(tiles, {300, 100, size.x, size.y});
    const double ratio = behind_line_over_at_line<Arrays>(most, tiles * fragments, [&](const auto& arrays) {
        texgen::Texcoords out{arrays[0], arrays[1]};
        if constexpr (Arrays == 4) out = {arrays[0], arrays[1], arrays[2], arrays[3]};
        interpolate(within, rects, out);
    });
    CHECK_MESSAGE(ratio <= most, size.x, " x ", size.y, ": ", ratio, " times");
}

TEST_CASE(
    "within a tolerance tiles of a batch take little longer where their arrays do not begin with a line of a cache") {
    for (const glm::ivec2 size : {glm::ivec2(8, 8), glm::ivec2(64, 1), glm::ivec2(16, 16)})
        check_tiles_behind_line<2>(size, 1.5, 65536);
    for (const glm::ivec2 size : {glm::ivec2(32, 8), glm::ivec2(24, 24)}) check_tiles_behind_line<4>(size, 1.35, 32768);
}

TEST_CASE("within a tolerance derivatives take little longer where their arrays do not begin with a line of a cache") {
    const texgen::FootprintSetup within(
        support::setup_of(ordinary(1, 1).triangle, texgen::whole_texture(), tolerances[1]), {4096.0, 4096.0});
    for (const glm::ivec2 size : {glm::ivec2(64, 4), glm::ivec2(256, 64), glm::ivec2(1024, 256)}) {
        const FragmentRect rect{300, 100, size.x, size.y};
        const double ratio = behind_line_over_at_line<4>(1.5, support::count_of(rect), [&](const auto& arrays) {
            footprint(within, rect, {arrays[0], arrays[1], arrays[2], arrays[3]});
        });
        CHECK_MESSAGE(ratio <= 1.5, size.x, " x ", size.y, ": ", ratio, " times");
    }
}

TEST_CASE(
    "a tolerance takes little longer than exact at most, of whatever shape a tile of four rows and more is, and no "
    "longer in tall tiles and where caches do not hold one") {
    std::vector<float> s(std::size_t{1} << 23), t(s.size()), r(s.size()), lit(s.size());
    const Triangle triangle = ordinary(1, 1).triangle;
    const texgen::TriangleSetup exact = support::setup_of(triangle);
    const texgen::TriangleSetup within = support::setup_of(triangle, texgen::whole_texture(), tolerances[1]);
    struct Shape {
        glm::ivec2 size;
        double most = 1.5;
    };
    for (const Shape& shape : {Shape{{8, 8}},
                               {{8, 7}},
                               {{12, 12}},
                               {{16, 8}},
                               {{17, 8}},
                               {{16, 16}},
                               {{24, 24}},
                               {{64, 4}},
                               {{64, 8}},
                               {{64, 64}},
                               {{16, 64}, 1.0},
                               {{32, 32}, 1.0},
                               {{4096, 2048}, 1.0}}) {
        const glm::ivec2 size = shape.size;
        const double most = shape.most;
        const FragmentRect rect{300, 100, size.x, size.y};
        const auto part = [&](std::vector<float>& all) { return std::span(all).first(support::count_of(rect)); };
        const double of_s_and_t = support::worst_over_ordinary_within(
            most,
            [&] {
                interpolate(exact, rect, {part(s), part(t)});
            },
            [&] {
                interpolate(within, rect, {part(s), part(t)});
            });
        const double of_all = support::worst_over_ordinary_within(
            most,
            [&] {
                interpolate(exact, rect, {part(s), part(t), part(r), part(lit)});
            },
            [&] {
                interpolate(within, rect, {part(s), part(t), part(r), part(lit)});
            });
        INFO(size.x, " x ", size.y);
        CHECK(of_s_and_t <= most);
        CHECK(of_all <= most);
    }
}

TEST_CASE(
    "one coordinate takes little more than s and t, and all three with the mask not much more than twice as long") {
    constexpr double most_alone = 2.25, most_of_all = 3.0;
    std::vector<float> s(256), t(256), r(256), lit(256);
    for (const Tolerance tolerance : tolerances) {
        const texgen::TriangleSetup setup =
            support::setup_of(ordinary(1, 1).triangle, texgen::whole_texture(), tolerance);
        for (const glm::ivec2 size : {glm::ivec2{1, 1}, {4, 4}, {8, 8}, {16, 16}, {64, 4}}) {
            const FragmentRect rect{300, 100, size.x, size.y};
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
            INFO(size.x, " x ", size.y, ", tolerance ", tolerance.value);
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
                                 {2, 200, 40, 10, 4.0},
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

TEST_CASE("footprints where s and t are constant, as of a palette's colour, take no longer than others") {
    Shot constant = ordinary(64, 64);
    for (WindowVertex* corner : support::vertices(constant.triangle)) {
        corner->strq.x = 0.25f * corner->strq.w;
        corner->strq.y = 0.75f * corner->strq.w;
    }
    std::vector<float> level(64 * 64);
    for (const Tolerance tolerance : tolerances) {
        for (const int size : {8, 16, 64}) {
            const auto call = [&](const Shot& shot) {
                const texgen::FootprintSetup setup(support::setup_of(shot.triangle, texgen::whole_texture(), tolerance),
                                                   {1024.0, 1024.0});
                texgen::Footprints out;
                out.level = std::span(level).first(static_cast<std::size_t>(size * size));
                return [=] { footprint(setup, {300, 100, size, size}, out); };
            };
            const double ratio = support::worst_over_ordinary_within(1.5, call(ordinary(size, size)), call(constant));
            CHECK_MESSAGE(ratio <= 1.5, size, " x ", size, ", tolerance ", tolerance.value, ": ", ratio, " times");
        }
    }
    CHECK(level[0] == -HUGE_VALF);
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

TEST_CASE("a visibility buffer takes little more where its runs are longer, and less where rows share long ones") {
    const FragmentRect rect{100, 100, 1024, 16};
    std::vector<std::uint32_t> ids_in_runs[2];
    std::vector<float> s(support::count_of(rect)), t(s.size());
    for (const Tolerance tolerance : tolerances) {
        texgen::TriangleBatch batch(texgen::whole_texture(), tolerance);
        batch.assign(std::vector<Triangle>(4096, ordinary(1, 1).triangle));
        struct Runs {
            int shorter, longer;
            double most;
        };
        for (const Runs& runs : {Runs{8, 32, 1.2}, {8, 63, 1.6}, {48, 64, 1.0}}) {
            for (const int longer : {0, 1}) {
                const int length = longer != 0 ? runs.longer : runs.shorter;
                ids_in_runs[longer].clear();
                for (std::size_t i = 0; i < s.size(); ++i)
                    ids_in_runs[longer].push_back(
                        static_cast<std::uint32_t>(static_cast<int>(i % 1024) / length * 7 % 4096));
            }
            const auto run = [&](int longer) {
                return [&, ids = ids_in_runs[longer]] { interpolate(batch, ids, rect, {s, t}); };
            };
            const double ratio = support::worst_over_ordinary_within(runs.most, run(0), run(1));
            CHECK_MESSAGE(ratio <= runs.most, runs.longer, " in a run, tolerance ", tolerance.value, ": ", ratio,
                          " times");
        }
    }
}

}  // namespace triangle_costs
