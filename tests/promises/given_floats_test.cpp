// A caller that rounds to float in the same breath gets the results of those floats. Compilers have been seen to inline
// both sides and forget the rounding (see detail/arithmetic/widen.hpp), so each function is asked twice: with floats
// that are rounded in place, and with the same floats by way of memory. Both must give the same bits.

#include <doctest/doctest.h>

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "support/random.hpp"
#include "texgen/batch.hpp"
#include "texgen/clip.hpp"
#include "texgen/coverage.hpp"
#include "texgen/diagnose.hpp"
#include "texgen/eigen.hpp"
#include "texgen/fixed_function.hpp"
#include "texgen/footprint.hpp"
#include "texgen/interpolate.hpp"
#include "texgen/linear.hpp"
#include "texgen/reference.hpp"
#include "texgen/scale_bias.hpp"
#include "texgen/scene.hpp"
#include "texgen/surface.hpp"
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
glm::vec3 point(const Numbers& n, std::size_t first) {
    return {Rounding::round(n[first]), Rounding::round(n[first + 1]), Rounding::round(n[first + 2])};
}

template <class Rounding>
glm::mat4 matrix(const Numbers& n) {
    return {vector<Rounding>(n, 0), vector<Rounding>(n, 4), vector<Rounding>(n, 8), vector<Rounding>(n, 12)};
}

template <class Rounding>
glm::dmat4 transform(const Numbers& n) {
    return texgen::ModelMatrix(matrix<Rounding>(n)).matrix();
}

template <class Rounding>
std::array<glm::dmat4, 2> from_row_vectors(const Numbers& n) {
    std::array<float, 16> rows{};
    for (std::size_t i = 0; i < 16; ++i) rows[i] = Rounding::round(n[i]);
    return {texgen::from_row_vectors<texgen::World, texgen::Object>(rows).matrix(),
            texgen::from_row_vectors<texgen::World, texgen::Object>(matrix<Rounding>(n)).matrix()};
}

template <class Rounding>
glm::dmat4 from_eigen(const Numbers& n) {
    Eigen::Matrix4f m;
    for (std::size_t i = 0; i < 16; ++i) m(static_cast<Eigen::Index>(i)) = Rounding::round(n[i]);
    return texgen::from_eigen<texgen::ModelMatrix>(m).matrix();
}

template <class Rounding>
std::array<glm::vec4, 2> stored_plane(const Numbers& n) {
    texgen::TexGenUnit unit;
    REQUIRE(unit.set_eye_plane(texgen::Coordinate::s, vector<Rounding>(n, 16), matrix<Rounding>(n)));
    const glm::dvec4 bound =
        unit.eye_plane_error_bound(texgen::Coordinate::s, vector<Rounding>(n, 16), matrix<Rounding>(n));
    return {unit.eye_plane(texgen::Coordinate::s), glm::vec4(bound)};
}

template <class Rounding>
glm::vec4 by_unit(const Numbers& n, texgen::TexGenMode mode) {
    texgen::TexGenUnit unit;
    for (const auto coordinate : {texgen::Coordinate::s, texgen::Coordinate::t}) {
        unit.enable(coordinate);
        REQUIRE(unit.set_mode(coordinate, mode));
        unit.set_object_plane(coordinate, vector<Rounding>(n, 3));
        REQUIRE(unit.set_eye_plane(coordinate, vector<Rounding>(n, 16), matrix<Rounding>(n)));
    }
    unit.set_texture_matrix(matrix<Rounding>(n));
    return unit.generate({vector<Rounding>(n, 5), point<Rounding>(n, 9), vector<Rounding>(n, 20)}, matrix<Rounding>(n));
}

// Next to a side of the region: so far inside or outside that only the float that was given tells.
template <class Rounding>
std::array<texgen::Coverage, 3> coverages(const Numbers& n) {
    const texgen::WorldTexgen texgen(matrix<ByMemory>(n));
    const glm::vec3 min = point<Rounding>(n, 16);
    const texgen::Box box{min, min + glm::vec3(0.0f, 0.0f, 1.0f)};
    const glm::dvec4 corner = texgen.matrix() * glm::dvec4(n[16], n[17], n[18], 1.0);
    const texgen::TextureRegion region = texgen::atlas_tile({corner.x / corner.w, 0.0}, {1e3, 1e3});
    std::array<texgen::Coverage, 3> result{texgen::coverage(texgen, region, box),
                                           texgen::coverage(texgen, region, texgen::Sphere{min, 0.0f})};
    texgen::coverage(texgen, region, std::span(&box, 1), std::span(&result[2], 1));
    return result;
}

template <class Rounding>
std::vector<texgen::Coverage> by_scene(const Numbers& n) {
    const glm::vec3 min = point<Rounding>(n, 16);
    const texgen::Box box{min, min};
    const texgen::ModelMatrix model(matrix<Rounding>(n));
    const texgen::Projector projector{texgen::ProjectorProjection(glm::dmat4(1.0)),
                                      texgen::ProjectorView(glm::dmat4(1.0)), texgen::opengl};
    const glm::dmat4& m = model.matrix();
    const glm::dvec4 corner = m * glm::dvec4(n[16], n[17], n[18], 1.0);
    const texgen::TextureRegion region = texgen::atlas_tile({0.5 + 0.5 * corner.x / corner.w, 0.0}, {1e3, 1e3});
    texgen::Scene scene;
    scene.update({std::span(&model, 1), std::span(&box, 1), std::span(&projector, 1), std::span(&region, 1)}, {});
    std::vector<texgen::Coverage> result;
    for (const texgen::LitPair& pair : scene.pairs()) result.push_back(pair.coverage);
    return result;
}

template <class Rounding>
std::vector<texgen::Defect> diagnosed(const Numbers& n) {
    const std::array<glm::vec4, 4> planes{vector<Rounding>(n, 0), vector<Rounding>(n, 4), vector<Rounding>(n, 8),
                                          vector<Rounding>(n, 12)};
    const glm::vec3 lit = point<Rounding>(n, 16);
    texgen::ProjectionSetup<texgen::Object> setup;
    setup.points = texgen::object_space(std::span(&lit, 1));
    std::vector<texgen::Defect> result;
    for (const texgen::Finding& finding : texgen::diagnose(planes, setup)) result.push_back(finding.defect);
    return result;
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
std::array<float, 48> by_batch(const Numbers& n) {
    std::array<float, 48> out{};
    const std::span<float> all(out);
    texgen::TriangleBatch batch(texgen::whole_texture());
    const std::array triangles{triangle<Rounding>(n)};
    batch.assign(triangles);
    const std::array rects{texgen::FragmentRect{3, 5, 16, 1}};
    texgen::interpolate(batch, rects, {.s = all.first(16), .t = all.subspan(16, 16), .r = all.last(16), .lit = {}});
    return out;
}

template <class Rounding>
std::array<double, 8> bounds_of_setup(const Numbers& n) {
    const texgen::Segment segment{vector<Rounding>(n, 0), vector<Rounding>(n, 4)};
    const texgen::FragmentRect rect{3, 5, 16, 1};
    const auto setup = texgen::TriangleSetup::of(triangle<Rounding>(n), texgen::whole_texture(), {1e-6});
    const glm::dvec2 of_triangle = setup.value().error_bound(rect);
    const glm::dvec2 of_segment = texgen::error_bound(segment, {1e-6});
    return {of_triangle.x,
            of_triangle.y,
            of_segment.x,
            of_segment.y,
            static_cast<double>(setup.value().work(rect)),
            static_cast<double>(texgen::work(segment, texgen::whole_texture())),
            texgen::headlights(triangle<Rounding>(n)),
            static_cast<double>(texgen::work(segment, texgen::whole_texture().with_depth(0.5, 1.5)))};
}

template <class Rounding>
std::array<double, 16> footprinted(const Numbers& n) {
    const auto setup = texgen::TriangleSetup::of(triangle<Rounding>(n), texgen::whole_texture());
    const texgen::FootprintSetup footprints(setup.value(), {256.0, 512.0});
    const texgen::Footprint one = footprints.at(7, 9).value();
    const texgen::FootprintExtremes all = footprints.extremes().value();
    const glm::dvec2 bound = footprints.error_bound({3, 5, 16, 1});
    return {one.dx.x,       one.dx.y,         one.dy.x,    one.dy.y,        one.level,
            one.anisotropy, one.major.x,      one.major.y, all.least_level, all.largest_level,
            all.least_area, all.largest_area, bound.x,     bound.y};
}

template <class Rounding>
std::array<texgen::ClipVertex, 8> clipped_to_slide(const Numbers& n) {
    std::array<texgen::ClipVertex, 8> out{};
    const std::array<texgen::ClipVertex, 3> polygon{
        texgen::ClipVertex{vector<Rounding>(n, 0), vector<Rounding>(n, 4)},
        texgen::ClipVertex{vector<Rounding>(n, 8), vector<Rounding>(n, 12)},
        texgen::ClipVertex{vector<Rounding>(n, 16), vector<Rounding>(n, 20)}};
    texgen::clip_to_slide(polygon, texgen::whole_texture(), out);
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

// The box is the point: a number next to it does not hold it.
template <class Rounding>
std::array<glm::vec2, 1> projected_within(const Numbers& n) {
    std::array<glm::vec2, 1> out{};
    const glm::vec3 given = point<ByMemory>(n, 16);
    const texgen::Box box{point<Rounding>(n, 16), point<Rounding>(n, 16)};
    texgen::project(texgen::ObjectTexgen(matrix<Rounding>(n)), texgen::object_space(std::span(&given, 1)).within(box),
                    out);
    return out;
}

template <class Rounding>
std::array<std::optional<glm::vec2>, 2> projected_alone(const Numbers& n) {
    const texgen::ObjectTexgen texture_from_object(matrix<Rounding>(n));
    const glm::vec3 other(Rounding::round(n[19]), Rounding::round(n[20]), Rounding::round(n[21]));
    return {texgen::project(texture_from_object, texgen::object_space(point<Rounding>(n, 16))),
            texgen::project(texture_from_object, texgen::object_space(other))};
}

template <class Rounding>
std::array<float, 12> generated(const Numbers& n) {
    const texgen::ObjectTexgen texture_from_object(matrix<Rounding>(n));
    const glm::vec3 given = point<Rounding>(n, 16);
    const auto at = texgen::object_space(std::span(&given, 1));
    glm::vec4 strq(0.0f);
    texgen::generate(texture_from_object, at, std::span(&strq, 1));
    const glm::vec4 bound(texgen::generate_error_bound(texture_from_object, at));
    const glm::vec2 divided_bound(texgen::project_error_bound(texture_from_object, at, {1e-6}));
    float s = 0.0f, t = 0.0f;
    texgen::project(texture_from_object, at, texgen::whole_texture(), {.s = {&s, 1}, .t = {&t, 1}, .r = {}, .lit = {}},
                    {1e-6});
    return {strq.x, strq.y, strq.z, strq.w, bound.x, bound.y, bound.z, bound.w, divided_bound.x, divided_bound.y, s, t};
}

template <class Rounding>
glm::dvec2 bound_of_depth(const Numbers& n) {
    return texgen::depth_error_bound(texgen::WindowTexgen(matrix<ByMemory>(n)), point<Rounding>(n, 16),
                                     texgen::DepthBuffer::float32);
}

template <class Rounding>
std::optional<glm::vec2> divided(const Numbers& n) {
    return texgen::divide(vector<Rounding>(n, 0));
}

// Of a triangle that only the floats that were given put beside the edge.
template <class Rounding>
std::array<double, 6> of_surface(const Numbers& n) {
    const glm::vec4 a = vector<Rounding>(n, 0), b = vector<Rounding>(n, 4), c = vector<Rounding>(n, 8);
    Numbers next_to_edge_on = n;
    for (std::size_t k = 0; k < 4; ++k) next_to_edge_on[8 + k] = n[12] * n[k] + n[13] * n[4 + k];
    const glm::dvec3 plane = texgen::receiver_plane(a, b, c).value();
    return {plane.x,
            plane.y,
            plane.z,
            texgen::slide_area(a, b, c).value(),
            texgen::slide_area(a, b, vector<Rounding>(next_to_edge_on, 8)).value(),
            static_cast<double>(texgen::facing(a, b, vector<Rounding>(next_to_edge_on, 8), texgen::TextureOrigin{}))};
}

bool same(const texgen::ClipVertex& a, const texgen::ClipVertex& b) {
    return a.position == b.position && a.strq == b.strq;
}

}  // namespace

TEST_CASE("floats that are rounded in place give the results of those floats") {
#if defined(__AVX2__) && defined(__FMA__)
    if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) return;
#endif
    Random random(101);
    for (int i = 0; i < 2000; ++i) {
        const Numbers numbers = random_numbers(random);
        REQUIRE(transform<InPlace>(numbers) == transform<ByMemory>(numbers));
        REQUIRE(from_row_vectors<InPlace>(numbers) == from_row_vectors<ByMemory>(numbers));
        REQUIRE(remapped<InPlace>(numbers) == remapped<ByMemory>(numbers));
        REQUIRE(window<InPlace>(numbers) == window<ByMemory>(numbers));
        const auto one = clipped<InPlace>(numbers), other = clipped<ByMemory>(numbers);
        for (std::size_t k = 0; k < 4; ++k) REQUIRE(same(one[k], other[k]));
        REQUIRE(mixed<InPlace>(numbers) == mixed<ByMemory>(numbers));
        REQUIRE(by_reference<InPlace>(numbers) == by_reference<ByMemory>(numbers));
        REQUIRE(by_setup<InPlace>(numbers) == by_setup<ByMemory>(numbers));
        REQUIRE(by_batch<InPlace>(numbers) == by_batch<ByMemory>(numbers));
        REQUIRE(by_setup<InPlace>(numbers) == by_batch<InPlace>(numbers));
        REQUIRE(along_segment<InPlace>(numbers) == along_segment<ByMemory>(numbers));
        REQUIRE(projected<InPlace>(numbers) == projected<ByMemory>(numbers));
        REQUIRE(projected_within<InPlace>(numbers) == projected_within<ByMemory>(numbers));
        REQUIRE(projected_alone<InPlace>(numbers) == projected_alone<ByMemory>(numbers));
        REQUIRE(divided<InPlace>(numbers) == divided<ByMemory>(numbers));
        REQUIRE(from_eigen<InPlace>(numbers) == from_eigen<ByMemory>(numbers));
        REQUIRE(stored_plane<InPlace>(numbers) == stored_plane<ByMemory>(numbers));
        for (const auto mode :
             {texgen::TexGenMode::object_linear, texgen::TexGenMode::eye_linear, texgen::TexGenMode::sphere_map})
            REQUIRE(by_unit<InPlace>(numbers, mode) == by_unit<ByMemory>(numbers, mode));
        REQUIRE(coverages<InPlace>(numbers) == coverages<ByMemory>(numbers));
        REQUIRE(by_scene<InPlace>(numbers) == by_scene<ByMemory>(numbers));
        REQUIRE(diagnosed<InPlace>(numbers) == diagnosed<ByMemory>(numbers));
        REQUIRE(bounds_of_setup<InPlace>(numbers) == bounds_of_setup<ByMemory>(numbers));
        REQUIRE(footprinted<InPlace>(numbers) == footprinted<ByMemory>(numbers));
        const auto slide = clipped_to_slide<InPlace>(numbers), other_slide = clipped_to_slide<ByMemory>(numbers);
        for (std::size_t k = 0; k < 8; ++k) REQUIRE(same(slide[k], other_slide[k]));
        REQUIRE(generated<InPlace>(numbers) == generated<ByMemory>(numbers));
        REQUIRE(of_surface<InPlace>(numbers) == of_surface<ByMemory>(numbers));
        REQUIRE(bound_of_depth<InPlace>(numbers) == bound_of_depth<ByMemory>(numbers));
    }
}

TEST_CASE("the sides of a region in floats are the first floats inside it") {
    Random random(102);
    for (int i = 0; i < 20000; ++i) {
        const double left = random.uniform(0.0, 0.5), right = random.uniform(0.5, 1.0);
        const texgen::detail::LitTest lit(texgen::atlas_tile({left, left}, {right, right}).with_depth(left, right));
        REQUIRE(static_cast<double>(lit.r_min) == lit.least(0));
        REQUIRE(static_cast<double>(lit.r_max) == lit.greatest(0));
        for (std::size_t k = 0; k < 2; ++k) {
            REQUIRE(lit.least(k) >= left);
            REQUIRE(texgen::detail::float_before(support::to_float(lit.least(k))) < left);
            REQUIRE(lit.greatest(k) <= right);
            REQUIRE(-texgen::detail::float_before(support::to_float(-lit.greatest(k))) > right);
        }
    }
}
