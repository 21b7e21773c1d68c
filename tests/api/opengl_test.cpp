// A real OpenGL as the judge of stored planes, of the five modes and of fragments. Skipped (exit 77) where there is
// none.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "support/fixed_function.hpp"
#include "support/hex.hpp"
#include "support/opengl.hpp"
#include "support/opengl_fragments.hpp"
#include "support/random.hpp"
#include "texgen/clip.hpp"
#include "texgen/fixed_function.hpp"
#include "texgen/footprint.hpp"
#include "texgen/interpolate.hpp"
#include "texgen/linear.hpp"
#include "texgen/primitives.hpp"
#include "texgen/reference.hpp"

namespace {

namespace gl = support::gl;
using gl::fragment_tolerance;
using gl::largest_terms;
using support::Coordinate;
using support::coordinates;
using support::hex;
using support::modes;
using support::NormalScaling;
using support::Random;
using support::rounded;
using support::scalings;
using support::slide_projector;
using support::TexGenMode;
using support::TexGenUnit;
using texgen::FixedFunctionVertex;

const glm::mat4 identity(1.0f);

const gl::Context& opengl() { return gl::Context::or_skip(); }

gl::Enum name(TexGenMode mode) {
    constexpr std::array names{gl::object_linear, gl::eye_linear, gl::sphere_map, gl::reflection_map, gl::normal_map};
    return names[static_cast<std::size_t>(mode)];
}
gl::Enum name(Coordinate coordinate) { return gl::s + static_cast<gl::Enum>(coordinate); }
gl::Enum switch_of(Coordinate coordinate) { return gl::texture_gen_s + static_cast<gl::Enum>(coordinate); }

glm::vec4 plane_of(const gl::Context& g, Coordinate coordinate, gl::Enum which) {
    glm::vec4 plane(-7.0f);
    g.GetTexGenfv(name(coordinate), which, &plane[0]);
    return plane;
}

// One unit of ours and OpenGL's, told the same.
class Both {
public:
    explicit Both(const gl::Context& context) : gl_(context) { gl_.reset(); }

    const TexGenUnit& ours() const { return ours_; }

    void enable(Coordinate coordinate, bool on = true) {
        ours_.enable(coordinate, on);
        on ? gl_.Enable(switch_of(coordinate)) : gl_.Disable(switch_of(coordinate));
    }
    void set_mode(Coordinate coordinate, TexGenMode mode) {
        REQUIRE(ours_.set_mode(coordinate, mode));
        gl_.TexGeni(name(coordinate), gl::texture_gen_mode, static_cast<int>(name(mode)));
    }
    void set_object_plane(Coordinate coordinate, const glm::vec4& plane) {
        ours_.set_object_plane(coordinate, plane);
        gl_.TexGenfv(name(coordinate), gl::object_plane, &plane[0]);
    }
    void set_eye_plane(Coordinate coordinate, const glm::vec4& plane, const glm::mat4& modelview) {
        REQUIRE(ours_.set_eye_plane(coordinate, plane, modelview));
        gl_.load_matrix(gl::modelview, modelview);
        gl_.TexGenfv(name(coordinate), gl::eye_plane, &plane[0]);
    }
    void set_texture_matrix(const glm::mat4& matrix) {
        ours_.set_texture_matrix(matrix);
        gl_.load_matrix(gl::texture, matrix);
    }
    void set_normal_scaling(NormalScaling scaling) {
        ours_.set_normal_scaling(scaling);
        gl_.Disable(gl::rescale_normal);
        gl_.Disable(gl::normalize);
        if (scaling == NormalScaling::rescale) gl_.Enable(gl::rescale_normal);
        if (scaling == NormalScaling::normalize) gl_.Enable(gl::normalize);
    }

    void load_projection(const glm::mat4& matrix) { gl_.load_matrix(gl::projection, matrix); }

    // A projection that puts this vertex into the middle of the view, whatever its eye coordinates are.
    glm::vec4 judge(const FixedFunctionVertex& vertex, const glm::mat4& modelview) {
        const glm::dvec4 eye = glm::dmat4(modelview) * glm::dvec4(vertex.position);
        double squared = 0.0;
        for (int i = 0; i < 4; ++i) squared += eye[i] * eye[i];
        glm::mat4 projection(0.0f);
        for (int i = 0; i < 4; ++i) projection[i][3] = static_cast<float>(eye[i] / squared);
        gl_.load_matrix(gl::projection, projection);
        gl_.load_matrix(gl::modelview, modelview);
        const gl::Context::Feedback feedback = gl_.vertex_texcoord(vertex.position, vertex.normal, vertex.texcoord);
        REQUIRE(feedback.valid);
        REQUIRE(gl_.GetError() == gl::no_error);
        return feedback.texcoord;
    }

private:
    const gl::Context& gl_;
    TexGenUnit ours_;
};

double norm(const glm::dmat4& m) {
    double largest = 0.0;
    for (int column = 0; column < 4; ++column) {
        double sum = 0.0;
        for (int row = 0; row < 4; ++row) sum += std::fabs(m[column][row]);
        largest = std::max(largest, sum);
    }
    return largest;
}

double condition(const glm::mat4& modelview) {
    const texgen::ModelviewMatrix matrix(modelview);
    return norm(matrix.matrix()) * norm(texgen::inverse(matrix).value().matrix());
}

double largest(const glm::vec4& v) {
    return static_cast<double>(std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z), std::fabs(v.w)}));
}

enum class Kind { rigid, scaled, sheared, projective };
constexpr std::array kinds{Kind::rigid, Kind::scaled, Kind::sheared, Kind::projective};

glm::mat4 random_modelview(Random& random, Kind kind, double distance) {
    glm::dmat4 m = random.rigid(distance);
    switch (kind) {
        case Kind::rigid:
            break;
        case Kind::scaled:
            for (int column = 0; column < 3; ++column) m[column] *= random.power_of_ten(-1.5, 1.5);
            break;
        case Kind::sheared:
            m[1] += random.uniform(-3.0, 3.0) * m[0];
            m[2] += random.uniform(-3.0, 3.0) * m[1];
            break;
        case Kind::projective:
            for (int column = 0; column < 4; ++column) m[column] += glm::dvec4(random.vector4(0.3));
            break;
    }
    return rounded(m);
}

// State

TEST_CASE("a new TexGenUnit is what glGetTexGen returns in a new context") {
    const gl::Context& g = opengl();
    MESSAGE("judged by OpenGL ", std::string(reinterpret_cast<const char*>(g.GetString(gl::version))), ", ",
            std::string(reinterpret_cast<const char*>(g.GetString(gl::renderer))));
    g.MatrixMode(gl::modelview);
    g.LoadIdentity();
    const TexGenUnit unit;
    for (const Coordinate coordinate : coordinates) {
        int mode = 0;
        g.GetTexGeniv(name(coordinate), gl::texture_gen_mode, &mode);
        CHECK(static_cast<gl::Enum>(mode) == name(unit.mode(coordinate)));
        CHECK((g.IsEnabled(switch_of(coordinate)) != 0) == unit.enabled(coordinate));
        CHECK(plane_of(g, coordinate, gl::object_plane) == unit.object_plane(coordinate));
        CHECK(plane_of(g, coordinate, gl::eye_plane) == unit.eye_plane(coordinate));
    }
    CHECK(g.GetError() == gl::no_error);
}

TEST_CASE("a mode is refused exactly where OpenGL says INVALID_ENUM, and neither changes then") {
    const gl::Context& g = opengl();
    int refused = 0;
    for (const Coordinate coordinate : coordinates) {
        for (const TexGenMode mode : modes) {
            for (const TexGenMode before : {TexGenMode::object_linear, TexGenMode::eye_linear}) {
                g.reset();
                TexGenUnit unit;
                REQUIRE(unit.set_mode(coordinate, before));
                g.TexGeni(name(coordinate), gl::texture_gen_mode, static_cast<int>(name(before)));
                REQUIRE(g.GetError() == gl::no_error);
                g.TexGeni(name(coordinate), gl::texture_gen_mode, static_cast<int>(name(mode)));
                const gl::Enum error = g.GetError();
                CHECK(unit.set_mode(coordinate, mode) == (error != gl::invalid_enum));
                refused += error == gl::invalid_enum ? 1 : 0;
                int now = 0;
                g.GetTexGeniv(name(coordinate), gl::texture_gen_mode, &now);
                CHECK(name(unit.mode(coordinate)) == static_cast<gl::Enum>(now));
            }
        }
    }
    CHECK(refused == 2 * (2 + 1 + 1));
}

TEST_CASE("stored eye planes are OpenGL's, for rigid, scaled, sheared and projective MODELVIEWs") {
    const gl::Context& g = opengl();
    Random random(101);
    double worst = 0.0;
    for (const Kind kind : kinds) {
        for (int i = 0; i < 2000; ++i) {
            const glm::mat4 modelview = random_modelview(random, kind, random.power_of_ten(0.0, 4.0));
            const glm::vec4 plane = random.vector4(10.0);
            Both both(g);
            both.set_eye_plane(Coordinate::r, plane, modelview);
            g.load_matrix(gl::modelview, glm::mat4(3.0f));  // a snapshot: neither cares
            const glm::vec4 theirs = plane_of(g, Coordinate::r, gl::eye_plane);
            const glm::vec4 ours = both.ours().eye_plane(Coordinate::r);
            const double tolerance = std::max(4e-6, 2e-7 * condition(modelview));
            INFO("kind ", static_cast<int>(kind), " modelview ", hex(modelview), " plane ", hex(plane));
            INFO("OpenGL ", hex(theirs), " ours ", hex(ours));
            const double error = largest(theirs - ours) / largest(ours);
            worst = std::max(worst, error / tolerance);
            REQUIRE(error <= tolerance);
            CHECK(plane_of(g, Coordinate::r, gl::object_plane) == both.ours().object_plane(Coordinate::r));
        }
    }
    MESSAGE("stored planes: worst error ", worst, " of the tolerance");
    CHECK(g.GetError() == gl::no_error);
}

TEST_CASE("a translation and a power of two are stored by both to the bit") {
    const gl::Context& g = opengl();
    Both both(g);
    glm::mat4 modelview(1.0f);
    modelview[3] = {10.0f, 20.0f, 30.0f, 1.0f};
    both.set_eye_plane(Coordinate::s, {1, 2, 3, 4}, modelview);
    CHECK(plane_of(g, Coordinate::s, gl::eye_plane) == glm::vec4(1, 2, 3, -136));
    CHECK(both.ours().eye_plane(Coordinate::s) == glm::vec4(1, 2, 3, -136));
    modelview = glm::mat4(0.25f);
    modelview[3][3] = 1.0f;
    both.set_eye_plane(Coordinate::t, {1, 2, 3, 4}, modelview);
    CHECK(plane_of(g, Coordinate::t, gl::eye_plane) == glm::vec4(4, 8, 12, 4));
    CHECK(both.ours().eye_plane(Coordinate::t) == glm::vec4(4, 8, 12, 4));
}

TEST_CASE("OpenGL stores Everitt's (4) for the rows of S P_p V_p under V_e, and for those of S P_p under V_e V_p^-1") {
    const gl::Context& g = opengl();
    Random random(102);
    const texgen::Projector projector = slide_projector();
    const auto world_planes = texgen::planes(texgen::texture_from_world(projector));
    const auto lens_planes = texgen::planes(texgen::scale_bias(texgen::opengl) * projector.projection);
    for (int i = 0; i < 500; ++i) {
        const glm::mat4 view = rounded(random.rigid(20.0));
        const texgen::CameraPose world_from_eye = texgen::inverse(texgen::ViewMatrix(view)).value();
        const auto everitt4 = texgen::planes(texgen::eye_linear(projector, world_from_eye));
        const texgen::Transform<texgen::Eye, texgen::ProjectorEye> eye_from_projector =
            texgen::ViewMatrix(view) * texgen::inverse_rigid(projector.view);
        for (const Coordinate coordinate : coordinates) {
            const auto row = static_cast<std::size_t>(coordinate);
            INFO("view ", hex(view), " Everitt (4) ", hex(everitt4[row]));
            Both both(g);
            both.set_eye_plane(coordinate, world_planes[row], view);
            const double tolerance = 4e-6 * largest(everitt4[row]);
            CHECK(largest(plane_of(g, coordinate, gl::eye_plane) - everitt4[row]) <= tolerance);
            CHECK(largest(both.ours().eye_plane(coordinate) - everitt4[row]) <= tolerance);
            both.set_eye_plane(coordinate, lens_planes[row], eye_from_projector.rounded());
            CHECK(largest(plane_of(g, coordinate, gl::eye_plane) - everitt4[row]) <= tolerance);
            CHECK(largest(both.ours().eye_plane(coordinate) - everitt4[row]) <= tolerance);
        }
    }
}

// Vertices

TEST_CASE(
    "the linear modes are OpenGL's at vertices, per coordinate, off coordinates and the texture matrix included") {
    const gl::Context& g = opengl();
    Random random(103);
    double worst = 0.0;
    for (int round = 0; round < 60; ++round) {
        Both both(g);
        const Kind kind = kinds[static_cast<std::size_t>(round) % kinds.size()];
        const bool with_texture_matrix = random.coin();
        for (const Coordinate coordinate : coordinates) {
            both.enable(coordinate, random.integer(0, 3) != 0);
            both.set_mode(coordinate, random.coin() ? TexGenMode::object_linear : TexGenMode::eye_linear);
        }
        if (with_texture_matrix)
            both.set_texture_matrix(
                {random.vector4(1.0), random.vector4(1.0), random.vector4(1.0), random.vector4(1.0)});
        for (int i = 0; i < 40; ++i) {
            for (const Coordinate coordinate : coordinates) {
                both.set_object_plane(coordinate, random.vector4(2.0));
                // Judged apart: here both have the very same plane in eye space.
                both.set_eye_plane(coordinate, random.vector4(2.0), identity);
            }
            const glm::mat4 modelview = random_modelview(random, kind, 10.0);
            const FixedFunctionVertex vertex{
                .position = random.vector4(5.0), .normal = random.vector3(1.0), .texcoord = random.vector4(3.0)};
            const glm::vec4 theirs = both.judge(vertex, modelview);
            const glm::vec4 ours = both.ours().generate(vertex, modelview);
            // The sum of the absolute terms of each coordinate, through the texture matrix.
            glm::dvec4 terms(0.0);
            for (const Coordinate coordinate : coordinates) {
                const int c = static_cast<int>(coordinate);
                if (!both.ours().enabled(coordinate)) {
                    terms[c] = std::fabs(static_cast<double>(vertex.texcoord[c]));
                } else if (both.ours().mode(coordinate) == TexGenMode::object_linear) {
                    for (int k = 0; k < 4; ++k)
                        terms[c] += std::fabs(static_cast<double>(both.ours().object_plane(coordinate)[k]) *
                                              static_cast<double>(vertex.position[k]));
                } else {
                    for (int k = 0; k < 4; ++k)
                        for (int j = 0; j < 4; ++j)
                            terms[c] += std::fabs(static_cast<double>(both.ours().eye_plane(coordinate)[k]) *
                                                  static_cast<double>(modelview[j][k]) *
                                                  static_cast<double>(vertex.position[j]));
                }
            }
            glm::dvec4 through(0.0);
            for (int row = 0; row < 4; ++row)
                for (int k = 0; k < 4; ++k)
                    through[row] += std::fabs(static_cast<double>(both.ours().texture_matrix()[k][row])) * terms[k];
            INFO("modelview ", hex(modelview), " position ", hex(vertex.position), " texture matrix ",
                 hex(both.ours().texture_matrix()));
            INFO("OpenGL ", hex(theirs), " ours ", hex(ours));
            for (int c = 0; c < 4; ++c) {
                const double error = std::fabs(static_cast<double>(theirs[c]) - static_cast<double>(ours[c]));
                worst = std::max(worst, error / through[c]);
                REQUIRE(error <= 3e-7 * through[c]);
            }
        }
    }
    MESSAGE("linear modes at vertices: worst error ", worst, " of the absolute terms");
}

TEST_CASE("sphere, reflection and normal map are OpenGL's at vertices, under its three treatments of normals") {
    const gl::Context& g = opengl();
    Random random(104);
    double worst_normal = 0.0, worst_reflection = 0.0, worst_sphere = 0.0;
    for (const Kind kind : kinds) {
        for (const NormalScaling scaling : scalings) {
            for (int round = 0; round < 8; ++round) {
                Both both(g);
                both.set_normal_scaling(scaling);
                // s and t differ in mode, so that each is seen in each place.
                constexpr std::array normal_modes{TexGenMode::sphere_map, TexGenMode::reflection_map,
                                                  TexGenMode::normal_map};
                both.set_mode(Coordinate::s, normal_modes[static_cast<std::size_t>(round) % 3]);
                both.set_mode(Coordinate::t, normal_modes[static_cast<std::size_t>(round / 3) % 3]);
                both.set_mode(Coordinate::r, normal_modes[1 + static_cast<std::size_t>(round) % 2]);
                for (const Coordinate coordinate : {Coordinate::s, Coordinate::t, Coordinate::r})
                    both.enable(coordinate);
                for (int i = 0; i < 60; ++i) {
                    const glm::mat4 modelview = random_modelview(random, kind, 10.0);
                    const FixedFunctionVertex vertex{.position = random.vector4(5.0),
                                                     .normal = glm::vec3(random.direction()),
                                                     .texcoord = random.vector4(3.0)};
                    const glm::vec4 theirs = both.judge(vertex, modelview);
                    const glm::vec4 ours = both.ours().generate(vertex, modelview);

                    TexGenUnit helper;
                    helper.set_normal_scaling(scaling);
                    for (const Coordinate coordinate : {Coordinate::s, Coordinate::t, Coordinate::r}) {
                        helper.enable(coordinate);
                        REQUIRE(helper.set_mode(coordinate, TexGenMode::normal_map));
                    }
                    const glm::dvec3 n(glm::vec3(helper.generate(vertex, modelview)));
                    for (const Coordinate coordinate : {Coordinate::s, Coordinate::t, Coordinate::r})
                        REQUIRE(helper.set_mode(coordinate, TexGenMode::reflection_map));
                    const glm::dvec3 r(glm::vec3(helper.generate(vertex, modelview)));
                    const double n_squared = n.x * n.x + n.y * n.y + n.z * n.z;
                    const double m = 2.0 * std::sqrt(r.x * r.x + r.y * r.y + (r.z + 1.0) * (r.z + 1.0));

                    INFO("kind ", static_cast<int>(kind), " scaling ", static_cast<int>(scaling), " modelview ",
                         hex(modelview), " position ", hex(vertex.position), " normal ", hex(vertex.normal));
                    INFO("OpenGL ", hex(theirs), " ours ", hex(ours));
                    // Theirs inverts in float: everything is as far off as the inverse.
                    const double float_inverse = std::max(1e-6, 5e-8 * condition(modelview));
                    for (const Coordinate coordinate : {Coordinate::s, Coordinate::t, Coordinate::r}) {
                        const int c = static_cast<int>(coordinate);
                        const double error = std::fabs(static_cast<double>(theirs[c]) - static_cast<double>(ours[c]));
                        switch (both.ours().mode(coordinate)) {
                            case TexGenMode::normal_map:
                                worst_normal = std::max(worst_normal, error / (float_inverse * std::sqrt(n_squared)));
                                REQUIRE(error <= float_inverse * std::sqrt(n_squared));
                                break;
                            case TexGenMode::reflection_map:
                                worst_reflection =
                                    std::max(worst_reflection, error / (float_inverse * (1.0 + 4.0 * n_squared)));
                                REQUIRE(error <= float_inverse * (1.0 + 4.0 * n_squared));
                                break;
                            default:
                                worst_sphere =
                                    std::max(worst_sphere, error * m / (float_inverse * (1.0 + 4.0 * n_squared)));
                                REQUIRE(error <= float_inverse * (1.0 + 4.0 * n_squared) / m);
                        }
                    }
                    CHECK(theirs.w == ours.w);
                }
            }
        }
    }
    MESSAGE("of the tolerance: normal ", worst_normal, ", reflection ", worst_reflection, ", sphere ", worst_sphere);
}

TEST_CASE("SGI's recipe, the projector in the texture matrix, is OpenGL's") {
    const gl::Context& g = opengl();
    Random random(105);
    const texgen::Projector projector = slide_projector();
    glm::dmat4 half(1.0);
    half[0][0] = half[1][1] = half[3][0] = half[3][1] = 0.5;
    const glm::mat4 texture_matrix = rounded(half * projector.projection.matrix() * projector.view.matrix());
    for (int i = 0; i < 500; ++i) {
        const glm::mat4 view = rounded(random.rigid(20.0));
        const glm::mat4 model = rounded(random.rigid(5.0));
        Both both(g);
        both.set_texture_matrix(texture_matrix);
        for (const Coordinate coordinate : coordinates) {
            glm::vec4 plane(0.0f);
            plane[static_cast<int>(coordinate)] = 1.0f;
            both.set_eye_plane(coordinate, plane, view);
            both.enable(coordinate);
        }
        const FixedFunctionVertex vertex{.position = {random.vector3(5.0), 1.0f}};
        const glm::mat4 modelview = rounded(glm::dmat4(view) * glm::dmat4(model));
        const glm::vec4 theirs = both.judge(vertex, modelview);
        const glm::vec4 ours = both.ours().generate(vertex, modelview);
        const auto texgen = texgen::object_linear(projector, texgen::ModelMatrix(model), texgen::whole_texture(),
                                                  texgen::DepthMapping::ndc);
        const glm::dvec4 definition = texgen.matrix() * glm::dvec4(vertex.position);
        INFO("view ", hex(view), " model ", hex(model), " position ", hex(vertex.position));
        INFO("OpenGL ", hex(theirs), " ours ", hex(ours));
        // Planes, view and modelview are floats some tens of units away from the origin.
        for (int c = 0; c < 4; ++c) {
            CHECK(std::fabs(static_cast<double>(theirs[c]) - static_cast<double>(ours[c])) <= 2e-4);
            CHECK(std::fabs(static_cast<double>(theirs[c]) - definition[c]) <= 2e-4);
        }
    }
}

// Fragments

// Texture coordinates of every fragment of a triangle whose vertices are at these window positions and have these
// clip-space w; -1e30 where there is no fragment.
constexpr float nothing = -1e30f;

glm::vec4 clip_position(const texgen::WindowVertex& vertex) {
    const float half_width = gl::Context::width / 2, half_height = gl::Context::height / 2;
    return {(vertex.window.x / half_width - 1.0f) * vertex.clip_w,
            (vertex.window.y / half_height - 1.0f) * vertex.clip_w, 0.0f, vertex.clip_w};
}

// The triangle by itself, as whoever calls has set OpenGL up.
std::vector<glm::vec4> draw(const gl::Context& g, const texgen::Triangle& triangle) {
    g.clear(glm::vec4(nothing));
    g.Begin(gl::triangles);
    for (const texgen::WindowVertex* vertex : {&triangle.a, &triangle.b, &triangle.c}) {
        g.TexCoord4fv(&vertex->strq[0]);
        const glm::vec4 position = clip_position(*vertex);
        g.Vertex4fv(&position[0]);
    }
    g.End();
    REQUIRE(g.GetError() == gl::no_error);
    return g.pixels();
}

std::vector<glm::vec4> draw_with_texcoords(const gl::Context& g, const texgen::Triangle& triangle) {
    g.reset();
    g.show_texcoord();
    return draw(g, triangle);
}

// A triangle of at least a tenth of the target, window positions on sixteenths of a pixel.
texgen::Triangle random_triangle(Random& random, double w_decades) {
    for (;;) {
        const auto vertex = [&random, w_decades] {
            const auto sixteenths = [&random](int size) {
                return static_cast<float>(random.integer(16, 16 * (size - 1))) / 16.0f;
            };
            return texgen::WindowVertex{{sixteenths(gl::Context::width), sixteenths(gl::Context::height)},
                                        static_cast<float>(random.power_of_ten(-0.5 * w_decades, 0.5 * w_decades)),
                                        glm::vec4(0.0f)};
        };
        const texgen::Triangle triangle{vertex(), vertex(), vertex()};
        if (std::fabs(support::twice_area(triangle)) > 0.2 * gl::Context::width * gl::Context::height) return triangle;
    }
}

struct Comparison {
    std::size_t fragments = 0, behind = 0;
    double worst = 0.0, worst_homogeneous = 0.0;
};

void compare(const std::vector<glm::vec4>& pixels, const texgen::Triangle& triangle, double tolerance,
             Comparison& result) {
    INFO("triangle ", hex(triangle));
    for (int row = 0; row < gl::Context::height; ++row) {
        for (int column = 0; column < gl::Context::width; ++column) {
            const glm::vec4 theirs = pixels[static_cast<std::size_t>(row * gl::Context::width + column)];
            if (theirs.x == nothing) continue;
            ++result.fragments;
            const double x = column + 0.5, y = row + 0.5;
            const Eigen::Vector4d strq = texgen::reference::strq(triangle, x, y);
            const Eigen::Vector3d u = texgen::reference::quotient<double>(strq);
            const glm::dvec4 terms = largest_terms(triangle, x, y);
            INFO("fragment ", x, " ", y, " OpenGL ", hex(theirs), " exact ",
                 hex(glm::dvec4(strq[0], strq[1], strq[2], strq[3])));
            if (strq[3] <= 0.0) ++result.behind;
            // s, t, r, q themselves share the error of the w of the fragment, which cancels in the quotients.
            for (int c = 0; c < 4; ++c) {
                const double error = std::fabs(static_cast<double>(theirs[c]) - strq[c]);
                result.worst_homogeneous = std::max(result.worst_homogeneous, error / terms[c]);
                if (!(error <= 4.0 * tolerance * terms[c])) FAIL("homogeneous coordinate ", c, " is off by ", error);
            }
            // At q = 0, as far as floats can tell, a quotient may be anything.
            if (2.0 * tolerance * terms[3] > std::fabs(strq[3])) continue;
            for (int c = 0; c < 3; ++c) {
                const double allowed = (terms[c] + std::fabs(u[c]) * terms[3]) / std::fabs(strq[3]);
                const double error = std::fabs(static_cast<double>(theirs[c]) / static_cast<double>(theirs.w) - u[c]);
                result.worst = std::max(result.worst, error / allowed);
                if (!(error <= tolerance * allowed)) FAIL("quotient ", c, " is off by ", error);
            }
        }
    }
}

TEST_CASE("fragments in front of the projector are OpenGL's, for w ratios up to 1e4") {
    const gl::Context& g = opengl();
    Random random(106);
    Comparison result;
    for (int i = 0; i < 24; ++i) {
        texgen::Triangle triangle = random_triangle(random, i % 3 == 0 ? 0.0 : i % 3 == 1 ? 1.0 : 4.0);
        for (texgen::WindowVertex* vertex : {&triangle.a, &triangle.b, &triangle.c})
            vertex->strq = {random.vector3(2.0), random.uniform_float(0.5, 3.0)};
        compare(draw_with_texcoords(g, triangle), triangle, fragment_tolerance, result);
    }
    MESSAGE(result.fragments, " fragments, worst error ", result.worst, " of the largest terms, homogeneous ",
            result.worst_homogeneous);
    CHECK(result.fragments > 100000);
    CHECK(result.behind == 0);
}

TEST_CASE("OpenGL interpolates straight through q = 0, and the reverse projection behind it is the definition's") {
    const gl::Context& g = opengl();
    Random random(107);
    Comparison result;
    for (int i = 0; i < 24; ++i) {
        texgen::Triangle triangle = random_triangle(random, i % 2 == 0 ? 0.0 : 2.0);
        for (texgen::WindowVertex* vertex : {&triangle.a, &triangle.b, &triangle.c}) vertex->strq = random.vector4(2.0);
        triangle.a.strq.w = std::fabs(triangle.a.strq.w) + 0.1f;
        triangle.b.strq.w = -std::fabs(triangle.b.strq.w) - 0.1f;
        compare(draw_with_texcoords(g, triangle), triangle, fragment_tolerance, result);
    }
    MESSAGE(result.fragments, " fragments, ", result.behind, " behind, worst error ", result.worst,
            " of the largest terms, homogeneous ", result.worst_homogeneous);
    CHECK(result.behind > result.fragments / 10);
    CHECK(result.behind < result.fragments * 9 / 10);
}

TEST_CASE("texgen's interpolate gives OpenGL's fragments in front of the projector, and nothing behind it") {
    const gl::Context& g = opengl();
    Random random(108);
    const std::size_t count =
        static_cast<std::size_t>(gl::Context::width) * static_cast<std::size_t>(gl::Context::height);
    const texgen::FragmentRect rect{0, 0, gl::Context::width, gl::Context::height};
    std::vector<float> s(count), t(count), r(count), lit(count);
    std::size_t lit_by_both = 0, dark_behind = 0, dark_outside = 0;
    for (int i = 0; i < 24; ++i) {
        texgen::Triangle triangle = random_triangle(random, i % 2 == 0 ? 0.0 : 3.0);
        for (texgen::WindowVertex* vertex : {&triangle.a, &triangle.b, &triangle.c})
            vertex->strq = {random.uniform_float(-1.0, 2.0), random.uniform_float(-1.0, 2.0),
                            random.uniform_float(-1.0, 2.0), random.uniform_float(i % 4 < 2 ? 0.5 : -2.0, 2.0)};
        const std::vector<glm::vec4> pixels = draw_with_texcoords(g, triangle);
        const auto setup = texgen::TriangleSetup::of(triangle, texgen::whole_texture());
        REQUIRE(setup.has_value());
        if (texgen::interpolate(*setup, rect, {s, t, r, lit}) == texgen::Work::nothing)
            for (std::vector<float>* values : {&s, &t, &r}) std::fill(values->begin(), values->end(), 0.0f);
        INFO("triangle ", hex(triangle));
        for (std::size_t fragment = 0; fragment < count; ++fragment) {
            const glm::vec4 theirs = pixels[fragment];
            if (theirs.x == nothing) continue;
            const double x = static_cast<double>(fragment % gl::Context::width) + 0.5;
            const double y = static_cast<double>(fragment / gl::Context::width) + 0.5;
            const glm::dvec4 terms = largest_terms(triangle, x, y);
            const double q = static_cast<double>(theirs.w);
            if (fragment_tolerance * 2.0 * terms.w > std::fabs(q)) continue;
            INFO("fragment ", x, " ", y, " OpenGL ", hex(theirs), " ours ",
                 hex(glm::vec4(s[fragment], t[fragment], r[fragment], lit[fragment])));
            if (q < 0.0) {
                ++dark_behind;
                if (lit[fragment] != 0.0f) FAIL_CHECK("lit behind the projector");
                continue;
            }
            bool inside = true, near_border = false;
            const glm::vec3 ours(s[fragment], t[fragment], r[fragment]);
            glm::dvec3 error(0.0), allowed(0.0);
            for (int c = 0; c < 3; ++c) {
                const double u = static_cast<double>(theirs[c]) / q;
                allowed[c] = fragment_tolerance * (terms[c] + std::fabs(u) * terms.w) / q + 6e-8 * std::fabs(u);
                error[c] = std::fabs(static_cast<double>(ours[c]) - u);
                if (c < 2) {
                    inside = inside && u >= 0.0 && u <= 1.0;
                    near_border = near_border || std::min(std::fabs(u), std::fabs(u - 1.0)) <= allowed[c];
                }
            }
            if (near_border) continue;
            if ((lit[fragment] != 0.0f) != inside)
                FAIL_CHECK("lit where OpenGL is outside, or dark where it is inside");
            lit_by_both += inside ? 1 : 0;
            dark_outside += inside ? 0 : 1;
            // What is dark may have been skipped.
            if (inside && !(error.x <= allowed.x && error.y <= allowed.y && error.z <= allowed.z))
                FAIL_CHECK("not OpenGL's coordinate");
        }
    }
    MESSAGE(lit_by_both, " fragments lit by both, ", dark_outside, " outside, ", dark_behind, " behind");
    CHECK(lit_by_both > 20000);
    CHECK(dark_outside > 20000);
    CHECK(dark_behind > 20000);
}

TEST_CASE("a floor under a slide, drawn with OpenGL's own transforms and eye-linear texgen, is texgen's") {
    const gl::Context& g = opengl();
    Random random(109);
    // The second one stands on the far side of the floor and looks at the camera: what is behind it is seen as well.
    const texgen::Projector facing =
        texgen::make_projector(
            texgen::PerspectiveLens{.fovy = texgen::degrees(30.0), .aspect = 1.0, .z_near = 0.2, .z_far = 1000.0},
            texgen::Aim{.position = {0.0, 0.0, -15.0}, .target = {0.0, -4.0, 0.0}, .up = {0.0, 1.0, 0.0}},
            texgen::opengl)
            .value();
    const texgen::Viewport viewport{0, 0, gl::Context::width, gl::Context::height};
    Comparison result;
    for (int i = 0; i < 24; ++i) {
        const auto world_planes = texgen::planes(texgen::texture_from_world(i % 2 == 0 ? slide_projector() : facing));
        // The camera's lens and aim are made as a projector's are.
        const auto camera = texgen::make_projector(
            texgen::PerspectiveLens{.fovy = texgen::degrees(50.0), .aspect = 1.0, .z_near = 0.5, .z_far = 500.0},
            texgen::Aim{.position = {random.uniform(-3.0, 3.0), random.uniform(1.0, 8.0), 12.0},
                        .target = {random.uniform(-1.0, 1.0), -2.0, 0.0},
                        .up = {0.0, 1.0, 0.0}},
            texgen::opengl);
        REQUIRE(camera.has_value());
        const glm::mat4 view = camera->view.rounded();
        const glm::mat4 lens = camera->projection.rounded();

        Both both(g);
        both.load_projection(lens);
        for (const Coordinate coordinate : coordinates) {
            both.enable(coordinate);
            both.set_eye_plane(coordinate, world_planes[static_cast<std::size_t>(coordinate)], view);
        }
        // A triangle on the floor, from near the camera to far away, some of it behind the projector.
        const float left = random.uniform_float(-6, -2), right = random.uniform_float(2, 6);
        const float far_x = random.uniform_float(-60, 120), far_z = random.uniform_float(-100, -60);
        const std::array corners{glm::vec4(left, -4, 6, 1), glm::vec4(right, -4, 6, 1), glm::vec4(far_x, -4, far_z, 1)};
        g.show_texcoord();
        g.clear(glm::vec4(nothing));
        g.Begin(gl::triangles);
        for (const glm::vec4& corner : corners) g.Vertex4fv(&corner[0]);
        g.End();
        REQUIRE(g.GetError() == gl::no_error);

        std::array<texgen::WindowVertex, 3> window;
        for (std::size_t k = 0; k < 3; ++k) {
            const glm::dvec4 clip = glm::dmat4(lens) * (glm::dmat4(view) * glm::dvec4(corners[k]));
            window[k] =
                texgen::to_window({glm::vec4(clip), both.ours().generate({.position = corners[k]}, view)}, viewport);
        }
        INFO("view ", hex(view));
        compare(g.pixels(), {window[0], window[1], window[2]}, fragment_tolerance, result);
    }
    MESSAGE(result.fragments, " fragments, ", result.behind, " behind, worst error ", result.worst,
            " of the largest terms, homogeneous ", result.worst_homogeneous);
    CHECK(result.fragments > 100000);
    CHECK(result.behind > 0);
}

// Footprints

constexpr int slide_width = 512, slide_height = 128;

// Binds a texture of that size, with all its levels and trilinear filtering.
void bind_slide(const gl::Context& g) {
    unsigned slide = 0;
    g.GenTextures(1, &slide);
    g.BindTexture(gl::texture_2d, slide);
    const std::vector<float> texels(static_cast<std::size_t>(slide_width * slide_height * 4), 1.0f);
    for (int level = 0, width = slide_width, height = slide_height; level <= 9; ++level) {
        g.TexImage2D(gl::texture_2d, level, static_cast<int>(gl::rgba), width, height, 0, gl::rgba, gl::float_type,
                     texels.data());
        width = std::max(1, width / 2);
        height = std::max(1, height / 2);
    }
    g.TexParameteri(gl::texture_2d, gl::texture_min_filter, static_cast<int>(gl::linear_mipmap_linear));
    g.TexParameteri(gl::texture_2d, gl::texture_mag_filter, static_cast<int>(gl::linear));
    REQUIRE(g.GetError() == gl::no_error);
}

std::vector<glm::vec4> draw_with_program(const gl::Context& g, const texgen::Triangle& triangle, unsigned program) {
    g.reset();
    g.UseProgram(program);
    return draw(g, triangle);
}

texgen::Triangle random_slide_triangle(Random& random, int round) {
    texgen::Triangle triangle = random_triangle(random, round % 3 == 0 ? 0.0 : 1.0);
    for (texgen::WindowVertex* vertex : {&triangle.a, &triangle.b, &triangle.c}) {
        const float q = random.uniform_float(0.5, 3.0);
        vertex->strq = {q * random.uniform_float(-1.0, 2.0), q * random.uniform_float(-1.0, 2.0), 0.0f, q};
    }
    return triangle;
}

// Ours at the four fragments of the 2x2 block that OpenGL takes its differences in: a difference of neighbours is the
// derivative somewhere between them, and along a row or a column of fragments that is monotone.
template <class Value>
std::array<double, 2> range_in_block(int x, int y, const Value& value) {
    std::array<double, 2> range{HUGE_VAL, -HUGE_VAL};
    for (const int column : {x & ~1, x | 1}) {
        for (const int row : {y & ~1, y | 1}) {
            const double here = value(column, row);
            range = {std::min(range[0], here), std::max(range[1], here)};
        }
    }
    return range;
}

TEST_CASE("OpenGL's dFdx and dFdy lie between the derivatives of the fragments that it takes its differences of") {
    const gl::Context& g = opengl();
    const unsigned program = g.program(nullptr,
                                       "#version 120\nvoid main() { vec2 c = gl_TexCoord[0].st / gl_TexCoord[0].q; "
                                       "gl_FragColor = vec4(dFdx(c), dFdy(c)); }\n");
    REQUIRE(program != 0);
    Random random(110);
    std::size_t compared = 0, steep = 0;
    double worst = 0.0;
    for (int round = 0; round < 16; ++round) {
        const texgen::Triangle triangle = random_slide_triangle(random, round);
        const std::vector<glm::vec4> pixels = draw_with_program(g, triangle, program);
        const texgen::FootprintSetup setup(texgen::TriangleSetup::of(triangle, texgen::whole_texture()).value(),
                                           {1.0, 1.0});
        for (std::size_t fragment = 0; fragment < pixels.size(); fragment += 7) {
            if (pixels[fragment].x == nothing) continue;
            const int x = static_cast<int>(fragment) % gl::Context::width;
            const int y = static_cast<int>(fragment) / gl::Context::width;
            const auto here = setup.at(x, y);
            for (int c = 0; c < 4; ++c) {
                const auto range = range_in_block(x, y, [&](int column, int row) {
                    const auto at = setup.at(column, row);
                    return at ? (c < 2 ? at->dx : at->dy)[c % 2] : HUGE_VAL;
                });
                constexpr double allowed = 1e-6;  // of coordinates that are floats, of size 2 at most
                const double theirs = static_cast<double>(pixels[fragment][c]);
                const double outside = std::max(range[0] - theirs, theirs - range[1]);
                worst = std::max(worst, outside / allowed);
                if (!(outside <= allowed))
                    FAIL("fragment ", x, " ", y, " derivative ", c, ": ", theirs, " is not in ", range[0], " ",
                         range[1], hex(triangle));
            }
            ++compared;
            steep += here && std::fabs(here->dx.x) > 0.01;
        }
    }
    MESSAGE(compared, " fragments, at most ", worst, " of what floats allow outside");
    CHECK(compared > 20000);
    CHECK(steep > 1000);
}

TEST_CASE("OpenGL's textureQueryLod is the level of detail, within what its differences allow") {
    const gl::Context& g = opengl();
    const unsigned program =
        g.program(nullptr,
                  "#version 400 compatibility\nuniform sampler2D slide;\n"
                  "void main() { gl_FragColor = vec4(textureQueryLod(slide, gl_TexCoord[0].st / gl_TexCoord[0].q), "
                  "0.0, 1.0); }\n");
    if (program == 0) {
        MESSAGE("this OpenGL has no textureQueryLod");
        return;
    }
    bind_slide(g);
    Random random(111);
    std::size_t compared = 0, minified = 0, magnified = 0;
    double lowest = 0.0, highest = 0.0;
    for (int round = 0; round < 16; ++round) {
        texgen::Triangle triangle = random_slide_triangle(random, round);
        if (round % 4 == 0)  // magnified
            for (texgen::WindowVertex* vertex : {&triangle.a, &triangle.b, &triangle.c})
                vertex->strq *= glm::vec4(0.05f, 0.05f, 1.0f, 1.0f);
        const std::vector<glm::vec4> pixels = draw_with_program(g, triangle, program);
        const texgen::FootprintSetup setup(texgen::TriangleSetup::of(triangle, texgen::whole_texture()).value(),
                                           {slide_width, slide_height});
        for (std::size_t fragment = 0; fragment < pixels.size(); fragment += 7) {
            if (pixels[fragment].x == nothing) continue;
            const int x = static_cast<int>(fragment) % gl::Context::width;
            const int y = static_cast<int>(fragment) / gl::Context::width;
            const auto range = range_in_block(x, y, [&](int column, int row) {
                const auto at = setup.at(column, row);
                return at ? at->level : HUGE_VAL;
            });
            const double theirs = static_cast<double>(pixels[fragment].y);
            lowest = std::min(lowest, theirs - range[0]);
            highest = std::max(highest, theirs - range[1]);
            ++compared;
            minified += range[0] > 0.5;
            magnified += range[1] < -0.5;
        }
    }
    MESSAGE(compared, " fragments; theirs from ", lowest, " below ours to ", highest, " above");
    CHECK(compared > 20000);
    CHECK(minified > 5000);
    CHECK(magnified > 2000);
    // The specification lets rho be approximated by as little as the larger of m_u and m_v, half a level below; Mesa
    // does not.
    CHECK(lowest > -0.1);
    CHECK(highest < 0.02);
}

}  // namespace
