// A caller that rounds to float in the same breath gets the results of those floats. Compilers have been seen to inline
// both sides and forget the rounding (see detail/widen.hpp), so each function is asked twice: with floats that are rounded
// in place, and with the same floats by way of memory. Both must give the same bits.

#include <doctest/doctest.h>

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "support/random.hpp"
#include "texgen/clip.hpp"
#include "texgen/interpolate.hpp"
#include "texgen/linear.hpp"
#include "texgen/reference.hpp"
#include "texgen/scale_bias.hpp"
#include "texgen/texcoord.hpp"

namespace {

using support::Random;

struct InPlace {
    static float round(double value) { return static_cast<float>(value); }
};
struct ByMemory {
    static float round(double value) { return support::to_float(value); }
};

using Numbers = std::array<double, 24>;

Numbers random_numbers(Random& random) {
    Numbers numbers{};
    for (double& number : numbers) number = random.uniform(0.5, 1.5);
    return numbers;
}

template <class Rounding>
glm::vec4 vector(const Numbers& n, std::size_t first) {
    return {Rounding::round(n[first]), Rounding::round(n[first + 1]), Rounding::round(n[first + 2]),
            Rounding::round(n[first + 3])};
}

template <class Rounding>
texgen::Triangle triangle(const Numbers& n) {
    return {
        .a = {{0.0f, 0.0f}, 1.0f, vector<Rounding>(n, 0)},
        .b = {{Rounding::round(90.0 * n[12]), 0.0f}, Rounding::round(n[13]), vector<Rounding>(n, 4)},
        .c = {{Rounding::round(n[14]), Rounding::round(90.0 * n[15])}, Rounding::round(n[16]), vector<Rounding>(n, 8)}};
}

template <class Rounding>
glm::dmat4 transform(const Numbers& n) {
    return texgen::ModelMatrix(glm::mat4(vector<Rounding>(n, 0), vector<Rounding>(n, 4), vector<Rounding>(n, 8),
                                         vector<Rounding>(n, 12)))
        .matrix();
}

template <class Rounding>
glm::vec4 remapped(const Numbers& n) {
    return texgen::to_texture(vector<Rounding>(n, 0), texgen::opengl, texgen::rectangle_texture(640, 480));
}

template <class Rounding>
glm::vec2 window(const Numbers& n) {
    return texgen::to_window({vector<Rounding>(n, 0), vector<Rounding>(n, 4)}, {0, 0, 1021, 767}).window;
}

template <class Rounding>
std::array<texgen::ClipVertex, 4> clipped(const Numbers& n) {
    std::array<texgen::ClipVertex, 4> out{};
    std::array<texgen::ClipVertex, 3> polygon{texgen::ClipVertex{vector<Rounding>(n, 0), vector<Rounding>(n, 4)},
                                              texgen::ClipVertex{vector<Rounding>(n, 8), vector<Rounding>(n, 12)},
                                              texgen::ClipVertex{vector<Rounding>(n, 16), vector<Rounding>(n, 20)}};
    polygon[1].position.z = Rounding::round(-3.0 * n[3]);
    texgen::clip_to_near(polygon, out, texgen::DepthRange::zero_to_one);
    return out;
}

template <class Rounding>
Eigen::Matrix<double, 4, 1> mixed(const Numbers& n) {
    return texgen::reference::strq(texgen::Segment{vector<Rounding>(n, 0), vector<Rounding>(n, 4)}, n[8] - 0.5);
}

template <class Rounding>
std::array<float, 48> by_reference(const Numbers& n) {
    std::array<float, 48> out{};
    const std::span<float> all(out);
    texgen::reference::interpolate(triangle<Rounding>(n), texgen::whole_texture(), {3, 5, 16, 1},
                                   {.s = all.first(16), .t = all.subspan(16, 16), .r = all.last(16), .lit = {}});
    return out;
}

template <class Rounding>
std::array<float, 48> by_setup(const Numbers& n) {
    std::array<float, 48> out{};
    const std::span<float> all(out);
    const auto setup = texgen::TriangleSetup::of(triangle<Rounding>(n), texgen::whole_texture());
    texgen::interpolate(setup.value(), {3, 5, 16, 1},
                        {.s = all.first(16), .t = all.subspan(16, 16), .r = all.last(16), .lit = {}});
    return out;
}

template <class Rounding>
std::array<float, 8> along_segment(const Numbers& n) {
    std::array<float, 8> out{}, alpha{};
    for (std::size_t i = 0; i < 8; ++i) alpha[i] = Rounding::round(n[8 + i] - 0.5);
    texgen::interpolate(texgen::Segment{vector<Rounding>(n, 0), vector<Rounding>(n, 4)}, alpha, texgen::whole_texture(),
                        {.s = out, .t = {}, .r = {}, .lit = {}});
    return out;
}

template <class Rounding>
std::array<glm::vec2, 2> projected(const Numbers& n) {
    std::array<glm::vec2, 2> out{};
    const texgen::ObjectTexgen texture_from_object(
        glm::mat4(vector<Rounding>(n, 0), vector<Rounding>(n, 4), vector<Rounding>(n, 8), vector<Rounding>(n, 12)));
    const std::array<glm::vec3, 2> points{
        glm::vec3(Rounding::round(n[16]), Rounding::round(n[17]), Rounding::round(n[18])),
        glm::vec3(Rounding::round(n[19]), Rounding::round(n[20]), Rounding::round(n[21]))};
    texgen::project(texture_from_object, texgen::object_space(points), out);
    return out;
}

template <class Rounding>
std::optional<glm::vec2> divided(const Numbers& n) {
    return texgen::divide(vector<Rounding>(n, 0));
}

bool same(const texgen::ClipVertex& a, const texgen::ClipVertex& b) {
    return a.position == b.position && a.strq == b.strq;
}

}  // namespace

TEST_CASE("floats that are rounded in place give the results of those floats") {
    Random random(101);
    for (int i = 0; i < 2000; ++i) {
        const Numbers numbers = random_numbers(random);
        REQUIRE(transform<InPlace>(numbers) == transform<ByMemory>(numbers));
        REQUIRE(remapped<InPlace>(numbers) == remapped<ByMemory>(numbers));
        REQUIRE(window<InPlace>(numbers) == window<ByMemory>(numbers));
        const auto one = clipped<InPlace>(numbers), other = clipped<ByMemory>(numbers);
        for (std::size_t k = 0; k < 4; ++k) REQUIRE(same(one[k], other[k]));
        REQUIRE(mixed<InPlace>(numbers) == mixed<ByMemory>(numbers));
        REQUIRE(by_reference<InPlace>(numbers) == by_reference<ByMemory>(numbers));
        REQUIRE(by_setup<InPlace>(numbers) == by_setup<ByMemory>(numbers));
        REQUIRE(along_segment<InPlace>(numbers) == along_segment<ByMemory>(numbers));
        REQUIRE(projected<InPlace>(numbers) == projected<ByMemory>(numbers));
        REQUIRE(divided<InPlace>(numbers) == divided<ByMemory>(numbers));
    }
}
