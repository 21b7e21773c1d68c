// Matrices, lenses and aims, with subnormal numbers taken as 0.

#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <optional>

#include "judges/oracle.hpp"
#include "judges/rational_matrix.hpp"
#include "promises/float_state_test/inputs.hpp"
#include "support/float_state.hpp"
#include "support/hex.hpp"
#include "support/random.hpp"
#include "texgen/projector.hpp"

namespace float_state {

using support::exactly;
using support::Rational;

TEST_CASE("what is singular stays singular, and what is regular is inverted within its bound") {
    in_every_state([](const FloatState& state, Random& random) {
        double worst = 0.0;
        for (int i = 0; i < 300; ++i) {
            glm::dmat4 m(0.0);
            for (int column = 0; column < 4; ++column)
                for (int row = 0; row < 4; ++row) m[column][row] = random.integer(-(1 << 20), 1 << 20) * 0x1p-20;
            const bool is_singular = i % 3 == 0;
            if (is_singular) m[1] = 3.0 * m[0] - 2.0 * m[2];
            std::optional<texgen::Transform<texgen::Object, texgen::World>> computed;
            glm::dmat4 bound(0.0);
            under(state, [&] {
                computed = inverse(texgen::ModelMatrix(m));
                if (computed) bound = inverse_error_bound(texgen::ModelMatrix(m), *computed);
            });
            REQUIRE_MESSAGE(computed.has_value() == !is_singular, hex(m));
            if (!computed) continue;
            const support::RationalMatrix exact = *support::inverse(exactly(m));
            Rational largest = 0;
            for (const auto& row : exact)
                for (const Rational& element : row) largest = std::max(largest, support::magnitude(element));
            for (std::size_t row = 0; row < 4; ++row) {
                for (std::size_t column = 0; column < 4; ++column) {
                    const double x = computed->matrix()[static_cast<int>(column)][static_cast<int>(row)];
                    const Rational error = support::magnitude(exactly(x) - exact[row][column]);
                    worst = std::max(worst, support::nearest<double>(error / largest));
                    REQUIRE_MESSAGE(error <= exactly(bound[static_cast<int>(column)][static_cast<int>(row)]), hex(m));
                }
            }
        }
        CHECK(worst <= 0x1p-50);
    });
}

TEST_CASE("lenses and aims are refused as in the default state, and have its bits") {
    in_every_state([](const FloatState& state, Random& random) {
        int refused = 0;
        for (int i = 0; i < 500; ++i) {
            const double fovy = random.integer(0, 9) == 0 ? random.uniform(-90.0, 0.0) : random.uniform(0.1, 179.9);
            const texgen::PerspectiveLens lens{.fovy = texgen::degrees(fovy),
                                               .aspect = random.integer(0, 19) == 0 ? 0.0 : random.uniform(0.5, 2.0),
                                               .z_near = random.uniform(0.1, 1.0),
                                               .z_far = random.uniform(1.0, 1e9)};
            texgen::Aim aim{10.0 * random.direction(), random.direction(), random.direction()};
            if (random.integer(0, 9) == 0) aim.target = aim.position;
            const auto projection = texgen::perspective(lens, texgen::opengl);
            const auto view = texgen::look_at(aim);
            std::optional<texgen::ProjectorProjection> projection_here;
            std::optional<texgen::ProjectorView> view_here;
            under(state, [&] {
                projection_here = texgen::perspective(lens, texgen::opengl);
                view_here = texgen::look_at(aim);
            });
            REQUIRE(projection_here.has_value() == projection.has_value());
            REQUIRE(view_here.has_value() == view.has_value());
            refused += !projection + !view;
            if (projection) CHECK(projection_here->matrix() == projection->matrix());
            if (view) CHECK(view_here->matrix() == view->matrix());
        }
        CHECK(refused > 50);
    });
}

}  // namespace float_state
