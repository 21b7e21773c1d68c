// What breaks a precondition of sizes is asserted, and without assertions writes nothing at all.

#include "support/broken_preconditions.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "texgen/batch.hpp"
#include "texgen/clip.hpp"
#include "texgen/coverage.hpp"
#include "texgen/fixed_function.hpp"
#include "texgen/footprint.hpp"
#include "texgen/interpolate.hpp"
#include "texgen/segment.hpp"
#include "texgen/texcoord.hpp"

namespace {

using support::broken_preconditions;
using texgen::Coverage;
using texgen::whole_texture;

// An array of which one element is missing or too many, between others that nobody may touch.
template <class Element>
class WrongSize {
public:
    WrongSize(std::size_t count, bool is_longer, const Element& untouched)
        : elements_(count + 20, untouched), first_(elements_), size_(is_longer ? count + 1 : count - 1) {}

    std::span<Element> span() { return std::span(elements_).subspan(8, size_); }
    bool is_untouched() const {
        return std::memcmp(elements_.data(), first_.data(), elements_.size() * sizeof(Element)) == 0;
    }

private:
    std::vector<Element> elements_, first_;
    std::size_t size_;
};

// Whether write(span) of so many elements asserts, and writes nothing.
template <class Element, class Write>
void check_nothing_is_written(std::size_t count, const Element& untouched, const Write& write) {
    for (const bool is_longer : {false, true}) {
        CAPTURE(count);
        CAPTURE(is_longer);
        WrongSize<Element> out(count, is_longer, untouched);
        write(out.span());
        CHECK(std::exchange(broken_preconditions, 0) != 0);
        CHECK(out.is_untouched());
    }
}

texgen::Triangle some_triangle() {
    return {{{0, 0}, 1, {0, 0, 0.5f, 1}}, {{64, 0}, 2, {2, 0, 1, 2}}, {{0, 64}, 4, {0, 4, 2, 4}}};
}

texgen::Transform<texgen::Texture, texgen::World> some_texgen() {
    return texgen::Transform<texgen::Texture, texgen::World>(glm::dmat4(1));
}

template <class Vector>
concept InObjectSpace = requires(Vector v) {
    texgen::object_space(v);
};
template <class Vector>
concept InWorldSpace = requires(Vector v) {
    texgen::world_space(v);
};
template <class Vector>
concept InEyeSpace = requires(Vector v) {
    texgen::eye_space(v);
};
template <class Vector>
concept InWindowSpace = requires(Vector v) {
    texgen::window_space(v);
};
template <class Vector>
concept AreCoordinates = std::is_constructible_v<texgen::Position<texgen::World>, Vector>;
template <class Vector>
constexpr int ways_to_make_a_point =
    InObjectSpace<Vector> + InWorldSpace<Vector> + InEyeSpace<Vector> + InWindowSpace<Vector> + AreCoordinates<Vector>;
template <class Vector>
concept IsDivided = requires(Vector v) {
    texgen::divide(v);
};

}  // namespace

TEST_CASE("outputs of another length than the points or values are asserted, and stay as they are") {
    constexpr float untouched = -7.0f;
    const texgen::Segment segment{{0, 0, 0, 1}, {1, 1, 1, 2}};
    constexpr std::size_t counts[] = {2, 3, 40, 700};
    for (const std::size_t count : counts) {
        const std::vector<glm::vec3> points(count, glm::vec3(0.25f, 0.5f, 0.75f));
        const std::vector<float> alphas(count, 0.25f);
        const auto positions = texgen::world_space(points);
        check_nothing_is_written(count, untouched, [&](std::span<float> out) {
            texgen::project(some_texgen(), positions, whole_texture(), {out, out, out, out});
        });
        check_nothing_is_written(count, untouched, [&](std::span<float> out) {
            texgen::generate(some_texgen(), positions, {.s = out, .q = out});
        });
        check_nothing_is_written(count, glm::vec2(untouched),
                                 [&](std::span<glm::vec2> out) { texgen::project(some_texgen(), positions, out); });
        check_nothing_is_written(count, glm::vec4(untouched),
                                 [&](std::span<glm::vec4> out) { texgen::generate(some_texgen(), positions, out); });
        check_nothing_is_written(count, untouched, [&](std::span<float> out) {
            texgen::interpolate(segment, alphas, whole_texture(), {out, out, out, out});
        });
    }
}

TEST_CASE("three arrays of coordinates that disagree are asserted, and are no points") {
    const std::vector<float> longer(40, 0.5f);
    for (std::size_t shortest = 0; shortest < 3; ++shortest) {
        const auto part = [&](std::size_t k) { return std::span(longer).first(k == shortest ? 7 : 40); };
        const auto positions = texgen::world_space(part(0), part(1), part(2));
        CHECK(std::exchange(broken_preconditions, 0) == 1);
        CHECK(positions.size() == 0);
    }
}

TEST_CASE("outputs of another length than the rectangle are asserted, and stay as they are") {
    constexpr float untouched = -7.0f;
    for (const texgen::FragmentRect rect : {texgen::FragmentRect{3, 4, 8, 8}, texgen::FragmentRect{3, 4, 40, 30}}) {
        const auto count = static_cast<std::size_t>(rect.width) * static_cast<std::size_t>(rect.height);
        for (const texgen::Tolerance tolerance : {texgen::exact, texgen::Tolerance{1e-3}}) {
            const auto triangle = texgen::TriangleSetup::of(some_triangle(), whole_texture(), tolerance);
            REQUIRE(triangle.has_value());
            const texgen::FootprintSetup footprint(*triangle, {256, 256});
            texgen::TriangleBatch batch(whole_texture(), tolerance);
            const texgen::Triangle one = some_triangle();
            batch.assign({&one, 1});
            const std::vector<std::uint32_t> ids(count, 0u);
            check_nothing_is_written(count, untouched, [&](std::span<float> out) {
                texgen::interpolate(*triangle, rect, {out, out, out, out});
            });
            check_nothing_is_written(count, untouched, [&](std::span<float> out) {
                texgen::footprint(footprint, rect, {.dsdx = out, .level = out, .major_t = out});
            });
            check_nothing_is_written(count, untouched, [&](std::span<float> out) {
                texgen::interpolate(batch, std::span(&rect, 1), {out, out, out, out});
            });
            std::vector<float> right(count, untouched);
            check_nothing_is_written(1, rect, [&](std::span<texgen::FragmentRect> other_rects) {
                texgen::interpolate(batch, other_rects, {.s = right});
            });
            std::vector<float> of_two(2 * count, untouched);
            texgen::interpolate(batch, std::array{rect, rect}, {.s = of_two});
            CHECK(std::exchange(broken_preconditions, 0) != 0);
            CHECK(std::count(of_two.begin(), of_two.end(), untouched) == static_cast<std::ptrdiff_t>(2 * count));
            check_nothing_is_written(count, untouched, [&](std::span<float> out) {
                texgen::interpolate(batch, ids, rect, {out, out, out, out});
            });
            check_nothing_is_written(count, untouched, [&](std::span<float> out) {
                texgen::footprint(batch, ids, rect, {256, 256}, {.dsdx = out, .level = out});
            });
            check_nothing_is_written(count, std::uint32_t{0}, [&](std::span<std::uint32_t> other_ids) {
                texgen::interpolate(batch, other_ids, rect, {.s = right});
                texgen::footprint(batch, other_ids, rect, {256, 256}, {.level = right});
            });
            CHECK(std::count(right.begin(), right.end(), untouched) == static_cast<std::ptrdiff_t>(count));
        }
    }
}

TEST_CASE("answers of another count than the bodies are asserted, and stay as they are") {
    const texgen::LitVolume volume(some_texgen(), whole_texture());
    constexpr std::size_t counts[] = {2, 5, 100};
    for (const std::size_t count : counts) {
        const std::vector<texgen::Box> boxes(count, texgen::Box{glm::vec3(0), glm::vec3(1)});
        const std::vector<texgen::Sphere> spheres(count, texgen::Sphere{glm::vec3(0), 1.0f});
        const auto check = [&](const auto& bodies) {
            check_nothing_is_written(count, Coverage::outside,
                                     [&](std::span<Coverage> out) { volume.coverage(bodies, out); });
            check_nothing_is_written(count, Coverage::outside, [&](std::span<Coverage> out) {
                texgen::coverage(some_texgen(), whole_texture(), bodies, out);
            });
        };
        check(std::span(boxes));
        check(std::span(spheres));
        const texgen::TexGenUnit unit;
        const std::vector<texgen::FixedFunctionVertex> vertices(count, {.position = glm::vec4(1)});
        check_nothing_is_written(count, glm::vec4(-7),
                                 [&](std::span<glm::vec4> out) { unit.generate(vertices, glm::mat4(1), out); });
    }
}

TEST_CASE("room for fewer vertices than a cut may leave is asserted, and stays as it is") {
    const texgen::ClipVertex untouched{glm::vec4(-7), glm::vec4(-7)};
    // Cut by the near plane, and by a side of the slide.
    const texgen::ClipVertex polygon[] = {
        {{0, 0, -2, 1}, {-1, 0, 0, 1}}, {{4, 0, 2, 3}, {2, 0, 0, 1}}, {{0, 4, 2, 3}, {0, 2, 0, 1}}};
    for (std::size_t room = 0; room <= 8; ++room) {
        CAPTURE(room);
        const auto check = [&](std::size_t needed, const auto& clip) {
            std::vector<texgen::ClipVertex> out(8, untouched);
            const std::size_t count = clip(std::span(out).first(room));
            CHECK((std::exchange(broken_preconditions, 0) == 0) == (room >= needed));
            CHECK((count != 0) == (room >= needed));
            const std::size_t written = room >= needed ? room : 0;
            CHECK(std::all_of(out.begin() + static_cast<std::ptrdiff_t>(written), out.end(),
                              [](const texgen::ClipVertex& vertex) { return vertex.position == glm::vec4(-7); }));
        };
        check(4, [&](std::span<texgen::ClipVertex> out) {
            return texgen::clip_to_near(polygon, out, texgen::DepthRange::negative_one_to_one);
        });
        check(8,
              [&](std::span<texgen::ClipVertex> out) { return texgen::clip_to_slide(polygon, whole_texture(), out); });
    }
}

TEST_CASE("rectangles of a batch with more fragments than there are numbers are of no array's size") {
    // 16 times 2^60, and 64.
    std::vector<texgen::FragmentRect> rects(17, {0, 0, 1 << 30, 1 << 30});
    rects.back() = {0, 0, 8, 8};
    texgen::TriangleBatch batch(whole_texture());
    batch.assign(std::vector<texgen::Triangle>(17, some_triangle()));
    constexpr float untouched = 7.0f;
    std::vector<float> out(64, untouched);
    texgen::interpolate(batch, rects, {.s = out});
    CHECK(std::exchange(broken_preconditions, 0) != 0);
    for (const float value : out) CHECK(value == untouched);
    texgen::interpolate(batch, rects, {});
    CHECK(broken_preconditions == 0);
}

TEST_CASE(
    "a rectangle of no fragments is empty, whatever the sign of its sizes: nothing is asked, asserted or written") {
    const auto triangle = texgen::TriangleSetup::of(some_triangle(), whole_texture());
    REQUIRE(triangle.has_value());
    const texgen::FootprintSetup footprint(*triangle, {256, 256});
    texgen::TriangleBatch batch(whole_texture());
    const texgen::Triangle three[] = {some_triangle(), some_triangle(), some_triangle()};
    batch.assign(three);
    const texgen::FragmentRect whole{3, 4, 8, 8};
    float alone[64];
    texgen::interpolate(*triangle, whole, {.s = alone});
    constexpr int least = -2147483647 - 1;
    for (const auto& size : {std::pair(0, 4), std::pair(4, 0), std::pair(-1, 8), std::pair(8, -1), std::pair(-8, -8),
                             std::pair(least, least), std::pair(least, 1)}) {
        const int width = size.first, height = size.second;
        CAPTURE(width);
        CAPTURE(height);
        const texgen::FragmentRect empty{3, 4, width, height};
        float s[3] = {-7, -7, -7};
        CHECK(texgen::interpolate(*triangle, empty, {.s = s}) == texgen::Work::nothing);
        CHECK_FALSE(texgen::footprint(footprint, empty, {.level = s}));
        CHECK_FALSE(footprint.extremes(empty).has_value());
        CHECK(triangle->work(empty) == texgen::Work::nothing);
        CHECK(triangle->error_bound(empty) == triangle->error_bound({0, 0, 0, 0}));
        const std::vector<std::uint32_t> ids(3, 0u);
        texgen::interpolate(batch, ids, empty, {.s = s});
        texgen::footprint(batch, ids, empty, {256, 256}, {.level = s});
        CHECK(std::count(s, s + 3, -7.0f) == 3);
        // Beside others it has no values.
        float both[128];
        texgen::interpolate(batch, std::vector{whole, empty, whole}, {.s = both});
        CHECK(std::memcmp(both, alone, sizeof alone) == 0);
        CHECK(std::memcmp(both + 64, alone, sizeof alone) == 0);
    }
    CHECK(broken_preconditions == 0);
}

TEST_CASE("a point or a homogeneous coordinate that a float vector would cut short does not compile") {
    static_assert(ways_to_make_a_point<glm::vec3> == 5 && ways_to_make_a_point<glm::vec<3, float, glm::lowp>> == 5);
    static_assert(ways_to_make_a_point<glm::dvec3> == 0 && ways_to_make_a_point<glm::ivec3> == 0);
    static_assert(ways_to_make_a_point<glm::vec4> == 0 && ways_to_make_a_point<glm::dvec4> == 0);
    static_assert(IsDivided<glm::vec4> && !IsDivided<glm::dvec4>);
    CHECK(texgen::world_space({1, 2, 3}).point == glm::vec3(1, 2, 3));
}
