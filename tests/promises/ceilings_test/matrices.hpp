#pragma once

// The worst of matrices, lenses and views.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "judges/oracle.hpp"
#include "judges/rational_matrix.hpp"
#include "judges/real.hpp"
#include "support/aspects.hpp"
#include "support/mirrors.hpp"
#include "support/random.hpp"
#include "support/windows.hpp"
#include "texgen/linear.hpp"
#include "texgen/projector.hpp"

namespace ceilings {

using support::exactly;
using support::operator*;
using support::Random;
using support::Rational;
using support::RationalMatrix;

struct WorstMatrices {
    double inverse = 0.0, planes = 0.0;
};

enum class MatrixFamily { one_size, near_to_singular, scaled };
inline constexpr std::array<const char*, 3> matrix_families{"elements of one size", "near to singular",
                                                            "rows and columns from 1e-30 to 1e30"};

// The inverse in double ulps of the largest term of X A X, and stored planes in float ulps of their largest component.
inline WorstMatrices of_matrices(MatrixFamily family, std::uint64_t seed) {
    Random random(seed);
    WorstMatrices worst;
    for (int i = 0; i < 60; ++i) {
        glm::dmat4 m = random.matrix();
        const double distance = random.power_of_ten(-6.0, -2.0);
        if (family == MatrixFamily::near_to_singular)
            for (int k = 0; k < 4; ++k) m[k][2] = m[k][0] + distance * m[k][2];
        if (family == MatrixFamily::scaled) {
            const double unit = random.power_of_ten(-10.0, 10.0);
            for (int column = 0; column < 4; ++column) {
                m[column] *= unit * random.power_of_ten(-10.0, 10.0);
                for (int k = 0; k < 4; ++k) m[k][column] *= random.power_of_ten(-2.0, 2.0);
            }
        }
        const RationalMatrix a = exactly(m), exact = support::inverse(a).value();
        const RationalMatrix x = exactly(inverse(texgen::ModelMatrix(m)).value().matrix());
        const glm::mat4 stored =
            eye_planes_as_stored(texgen::WorldTexgen(glm::dmat4(1.0)), texgen::ViewMatrix(m)).value().rounded();
        for (std::size_t r = 0; r < 4; ++r) {
            Rational largest_element = 0;
            for (const Rational& element : exact[r])
                largest_element = std::max(largest_element, support::magnitude(element));
            for (std::size_t c = 0; c < 4; ++c) {
                Rational largest = 0;
                for (std::size_t j = 0; j < 4; ++j)
                    for (std::size_t k = 0; k < 4; ++k)
                        largest = std::max(largest, support::magnitude(exact[r][j] * a[j][k] * exact[k][c]));
                const auto in_units = [](const Rational& error, int ulp) {
                    return error == 0 ? 0.0 : support::nearest<double>(error * support::power_of_two(-ulp));
                };
                worst.inverse = std::max(worst.inverse, in_units(support::magnitude(x[r][c] - exact[r][c]),
                                                                 support::ulp_exponent<double>(largest)));
                const float element = stored[static_cast<int>(c)][static_cast<int>(r)];
                worst.planes = std::max(worst.planes, in_units(support::magnitude(exactly(element) - exact[r][c]),
                                                               support::ulp_exponent<float>(largest_element)));
            }
        }
    }
    return worst;
}

// Lenses from 0.1 to 179.9 degrees: the focal lengths and the depth of the matrix, in its double ulps.
inline double of_lenses(std::uint64_t seed) {
    Random random(seed);
    double worst = 0.0;
    for (int i = 0; i < 300; ++i) {
        const double fovy = (i % 3 == 0   ? random.power_of_ten(-1.0, 0.0)
                             : i % 3 == 1 ? random.uniform(1.0, 179.0)
                                          : 180.0 - random.power_of_ten(-1.0, 0.0)) *
                            0.01745329251994329577;
        const double aspect = random.uniform(0.3, 3.0), z_near = random.power_of_ten(-3.0, 0.0);
        const double z_far = i % 4 == 0 ? HUGE_VAL : z_near * random.power_of_ten(0.5, 9.0);
        const glm::dmat4 p =
            perspective({texgen::radians(fovy), aspect, z_near, z_far}, texgen::opengl).value().matrix();
        const support::RealMatrix exact = support::perspective(fovy, aspect, z_near, z_far);
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 4; ++row)
                worst = std::max(
                    worst, support::error_in_ulps(
                               p[column][row], exact[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)]));
    }
    return worst;
}

// The lenses of calibrated cameras, whose axis is near to the middle of the picture or anywhere, in double ulps.
inline double of_pinholes(bool about_the_middle, std::uint64_t seed) {
    Random random(seed);
    double worst = 0.0;
    for (int i = 0; i < 1000; ++i) {
        const double width = random.integer(320, 8192), height = random.integer(240, 8192);
        const auto centre = [&](double size) {
            return about_the_middle ? 0.5 * size * (1.0 + random.power_of_ten(-16.0, -2.0))
                                    : random.uniform(-1.0, 2.0) * size;
        };
        const texgen::PinholeLens lens{.fx = random.power_of_ten(2.0, 4.0),
                                       .fy = random.power_of_ten(2.0, 4.0),
                                       .cx = centre(width),
                                       .cy = centre(height),
                                       .width = width,
                                       .height = height,
                                       .z_near = 0.1,
                                       .z_far = 100.0,
                                       .centre = texgen::PixelCentre::integer,
                                       .skew = random.uniform(-9.0, 9.0)};
        const glm::dmat4 p = pinhole(lens, texgen::opengl).value().matrix();
        const Rational w = support::exactly(width), h = support::exactly(height);
        worst = std::max({worst, support::ulp_error(p[0][0], Rational(2 * support::exactly(lens.fx) / w)),
                          support::ulp_error(p[1][1], Rational(2 * support::exactly(lens.fy) / h)),
                          support::ulp_error(p[1][0], Rational(-2 * support::exactly(lens.skew) / w)),
                          support::ulp_error(p[2][0], Rational(1 - (2 * support::exactly(lens.cx) + 1) / w)),
                          support::ulp_error(p[2][1], Rational((2 * support::exactly(lens.cy) + 1) / h - 1))});
    }
    return worst;
}

// Views in a mirror, in double ulps.
inline double of_mirrors(double distance, std::uint64_t seed) {
    Random random(seed);
    double worst = 0.0;
    for (int i = 0; i < 200; ++i) {
        const glm::dvec3 position = distance * random.direction(), normal = random.direction();
        const texgen::Aim aim{position, position + random.direction(), random.direction()};
        const auto view = look_at(aim).value();
        // The mirror is in front of the camera, where the translation cancels.
        const glm::dvec4 plane(
            normal, random.uniform(0.1, 3.0) - (normal.x * position.x + normal.y * position.y + normal.z * position.z));
        worst = std::max(worst, support::mirror_error(view, plane, mirrored(view, plane).value().matrix()));
    }
    return worst;
}

struct WorstAspects {
    double angle = 0.0, sides = 0.0, crop = 0.0;  // double ulps; 2^-53 of the largest side
};

inline WorstAspects of_aspects(std::uint64_t seed) {
    Random random(seed);
    WorstAspects worst;
    for (int i = 0; i < 300; ++i) {
        const texgen::PerspectiveLens lens = support::random_perspective(random);
        const double wider = lens.aspect * random.uniform(1.0, 10.0);
        worst.angle = std::max(worst.angle, support::narrowed_angle_error(lens, contain(lens, wider)));
        const auto rectangle = support::random_rectangle<texgen::FrustumLens>(random);
        const double aspect = random.power_of_ten(-1.0, 1.0);
        const support::Narrowing narrowing(rectangle, aspect);
        worst.sides = std::max(worst.sides, narrowing.measured_contain_error(rectangle, contain(rectangle, aspect)));
        const texgen::TextureRegion picture = texgen::atlas_tile({0.25, 0.5}, {0.75, 0.625});
        worst.crop = std::max(worst.crop, narrowing.measured_cover_error(picture, cover(rectangle, aspect, picture)));
    }
    return worst;
}

// Views whose `up` is that near to where they look, or any: the rotation in double ulps of 1.
inline double of_views(bool nearly_parallel, std::uint64_t seed) {
    Random random(seed);
    double worst = 0.0;
    for (int i = 0; i < 100; ++i) {
        const glm::dvec3 position = random.power_of_ten(0.0, 6.0) * random.direction(), to = random.direction();
        const glm::dvec3 up =
            nearly_parallel ? to + random.power_of_ten(-7.0, -1.0) * random.direction() : random.direction();
        const texgen::Aim aim{position, position + to, up};
        const glm::dmat4 v = look_at(aim).value().matrix();
        const support::RealMatrix exact = support::look_at(aim.position, aim.target, aim.up);
        for (std::size_t row = 0; row < 3; ++row)
            for (std::size_t column = 0; column < 3; ++column)
                worst = std::max(
                    worst, static_cast<double>(abs(support::Real(v[static_cast<int>(column)][static_cast<int>(row)]) -
                                                   exact[row][column])) *
                               0x1p52);
    }
    return worst;
}

// What a float T_o loses of s and t, in texels of 4096, where projector and object stand far from the origin and near
// to one another.
inline double of_poses(double distance, std::uint64_t seed) {
    Random random(seed);
    double worst = 0.0;
    for (int i = 0; i < 60; ++i) {
        const glm::dvec3 position = distance * random.direction(), to = random.direction();
        const texgen::Aim aim{position, position + to, random.direction()};
        const texgen::PerspectiveLens lens{texgen::degrees(40.0), 1.0, 0.1, 100.0};
        const texgen::Projector projector = make_projector(lens, aim, texgen::opengl).value();
        glm::dmat4 pose = random.rotation();
        pose[3] = glm::dvec4(position + random.uniform(3.0, 10.0) * to, 1.0);
        const glm::dmat4 t(object_linear(projector, texgen::ModelMatrix(pose)).rounded());
        const support::RealMatrix exact = support::scale_bias() *
                                          support::perspective(lens.fovy.in_radians(), 1.0, lens.z_near, lens.z_far) *
                                          support::look_at(aim.position, aim.target, aim.up) * support::real(pose);
        for (int k = 0; k < 8; ++k) {
            const glm::dvec3 v = random.uniform(0.0, 1.0) * random.direction();
            const auto coordinates = [&](const support::RealMatrix& m) {
                std::array<support::Real, 4> strq;
                for (std::size_t row = 0; row < 4; ++row)
                    strq[row] = m[row][0] * v.x + m[row][1] * v.y + m[row][2] * v.z + m[row][3];
                return strq;
            };
            const auto of_floats = coordinates(support::real(t)), right = coordinates(exact);
            for (std::size_t c = 0; c < 2; ++c)
                worst = std::max(worst,
                                 4096.0 * static_cast<double>(abs(of_floats[c] / of_floats[3] - right[c] / right[3])));
        }
    }
    return worst;
}

// T_w of cameras and projectors that far away, in 2^-53 of the terms of s and q.
inline double of_windows(double distance, std::uint64_t seed) {
    Random random(seed);
    double worst = 0.0;
    for (int i = 0; i < 60; ++i) {
        const support::WindowScene scene = support::random_window_scene(random, distance);
        const auto texgen = window_linear(scene.projector, scene.camera, scene.viewport, scene.region, scene.depth);
        const support::ExactWindow exact(scene);
        for (int k = 0; k < 8; ++k)
            worst = std::max(
                worst, 0x1p53 * exact.share_of_terms(texgen.value(), support::random_fragment(random, scene.viewport)));
    }
    return worst;
}

}  // namespace ceilings
