// A real OpenGL as the judge of stored planes, of the five modes and of fragments. Skipped (exit 77) where there is
// none.

#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <string>

#include "api/opengl_test/both.hpp"
#include "support/fixed_function.hpp"
#include "support/hex.hpp"
#include "support/opengl.hpp"
#include "support/random.hpp"
#include "texgen/fixed_function.hpp"
#include "texgen/linear.hpp"
#include "texgen/projector.hpp"
#include "texgen/scale_bias.hpp"

namespace judged {

using support::hex;

namespace {

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
        for (const TexGenMode mode : support::modes) {
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
    const texgen::Projector projector = support::slide_projector();
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

}  // namespace

}  // namespace judged
