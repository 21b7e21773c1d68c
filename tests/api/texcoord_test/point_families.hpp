#pragma once

// Families of matrices and points that are hard for rounding, each with its share of hard points.

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "judges/exact.hpp"
#include "support/hex.hpp"
#include "support/random.hpp"
#include "texgen/linear.hpp"
#include "texgen/projector.hpp"
#include "texgen/texcoord.hpp"

namespace texcoord_cases {

using support::Dyadic;
using support::hex;
using support::Homogeneous;
using support::Random;
using texgen::Object;
using texgen::ObjectTexgen;
using texgen::Positions;
using texgen::Tolerance;

using Points = std::vector<glm::vec3>;

struct Batch {
    glm::dmat4 matrix;
    Points points;

    ObjectTexgen texgen() const { return ObjectTexgen(matrix); }
    Positions<Object> positions() const { return texgen::object_space(points); }
};

inline glm::dvec4 row(const glm::dmat4& m, int k) { return {m[0][k], m[1][k], m[2][k], m[3][k]}; }
inline void set_row(glm::dmat4& m, int k, const glm::dvec4& values) {
    for (int column = 0; column < 4; ++column) m[column][k] = values[column];
}

inline double dot(const glm::dvec4& r, const glm::vec3& v) {
    return r.x * static_cast<double>(v.x) + r.y * static_cast<double>(v.y) + r.z * static_cast<double>(v.z) + r.w;
}

// A slide projector somewhere near the origin, and points about it.
inline Batch slide(Random& random, std::size_t count) {
    const glm::dvec3 position = 5.0 * random.direction(), target = random.direction();
    const auto projector = texgen::make_projector(
        texgen::PerspectiveLens{
            .fovy = texgen::degrees(random.uniform(10.0, 100.0)), .aspect = 1.0, .z_near = 0.1, .z_far = 100.0},
        {.position = position, .target = target, .up = random.direction()}, texgen::opengl);
    Batch batch{texture_from_world(projector.value()).matrix(), Points(count)};
    for (glm::vec3& point : batch.points)
        point = random.coin() ? random.vector3(8.0) : glm::vec3(target) + random.vector3(1.0);
    return batch;
}

struct PointFamily {
    const char* name;
    Batch (*make)(Random&, std::size_t count);
    bool (*is_hard)(const Homogeneous&, const Batch&);
    double least_share;  // of the points that are hard
};

inline const std::array families{
    PointFamily{"a slide projector", slide, [](const Homogeneous&, const Batch&) { return true; }, 1.0},
    PointFamily{"rounded to float",
                [](Random& random, std::size_t count) {
                    Batch batch = slide(random, count);
                    batch.matrix = glm::dmat4(glm::mat4(batch.matrix));
                    return batch;
                },
                [](const Homogeneous& at, const Batch&) { return at.q.sign() > 0; }, 0.3},
    PointFamily{"far from the origin, where rows cancel",
                [](Random& random, std::size_t count) {
                    Batch batch = slide(random, count);
                    const double distance = random.power_of_ten(3.0, 8.0);
                    const glm::dvec3 far = distance * random.direction();
                    for (int k = 0; k < 4; ++k) {
                        glm::dvec4 r = row(batch.matrix, k);
                        r.w -= r.x * far.x + r.y * far.y + r.z * far.z;
                        set_row(batch.matrix, k, r);
                    }
                    for (glm::vec3& point : batch.points) point = glm::vec3(glm::dvec3(point) + far);
                    return batch;
                },
                [](const Homogeneous& at, const Batch& batch) {
                    return std::fabs(at.q.estimate()) < 0.1 * std::fabs(batch.matrix[3][3]);
                },
                0.6},
    PointFamily{"next to q = 0",
                [](Random& random, std::size_t count) {
                    Batch batch = slide(random, count);
                    // The last point is on the plane up to a unit of the double's last place; the others are its
                    // neighbours.
                    glm::dvec4 q = row(batch.matrix, 3);
                    q.w = 0.0;
                    const glm::vec3 on_plane = batch.points.empty() ? glm::vec3(1.0f) : batch.points.back();
                    q.w = -dot(q, on_plane);
                    for (int i = random.integer(-2, 2); i != 0; i += i < 0 ? 1 : -1)
                        q.w = std::nextafter(q.w, i < 0 ? -HUGE_VAL : HUGE_VAL);
                    set_row(batch.matrix, 3, q);
                    for (glm::vec3& point : batch.points) {
                        point = on_plane;
                        for (int k = 0; k < 3; ++k)
                            if (random.integer(0, 2) == 0)
                                point[k] = support::neighbour(point[k], random.integer(-1, 1));
                    }
                    return batch;
                },
                [](const Homogeneous& at, const Batch& batch) {
                    return std::fabs(at.q.estimate()) < 0x1p-18 * std::fabs(batch.matrix[3][3]);
                },
                0.9},
    PointFamily{"on q = 0 exactly, and beside it",
                [](Random& random, std::size_t count) {
                    Batch batch = slide(random, count);
                    const double scale = std::ldexp(1.0, random.integer(-40, 40));
                    const glm::ivec3 n{random.integer(-9, 9), random.integer(1, 9), random.integer(-9, 9)};
                    const int m = random.integer(-9, 9);
                    set_row(batch.matrix, 3, scale * glm::dvec4(n.x, n.y, n.z, -m * n.y));
                    for (glm::vec3& point : batch.points) {
                        const int i = random.integer(-999, 999), j = random.integer(-999, 999);
                        // n.x (i n.y) + n.y (m - i n.x - j n.z) + n.z (j n.y) = m n.y
                        point = glm::vec3(i * n.y, m - i * n.x - j * n.z, j * n.y);
                        if (random.integer(0, 3) == 0) point.y = support::neighbour(point.y, random.coin() ? 1 : -1);
                    }
                    return batch;
                },
                [](const Homogeneous& at, const Batch&) { return at.q.sign() == 0; }, 0.6},
    PointFamily{"scaled by 1e-30 to 1e30",
                [](Random& random, std::size_t count) {
                    Batch batch = slide(random, count);
                    const double scale = random.power_of_ten(-30.0, 30.0);
                    for (int k = 0; k < 4; ++k) set_row(batch.matrix, k, scale * row(batch.matrix, k));
                    const float unit = static_cast<float>(random.coin() ? 1.0 : random.power_of_ten(-30.0, 30.0));
                    for (glm::vec3& point : batch.points) point *= unit;
                    return batch;
                },
                [](const Homogeneous&, const Batch& batch) {
                    const double size = std::fabs(batch.matrix[3][3]);
                    return size > 1e8 || size < 1e-8;
                },
                0.5},
    PointFamily{"each row in its own unit",
                [](Random& random, std::size_t count) {
                    Batch batch = slide(random, count);
                    for (int k = 0; k < 4; ++k)
                        set_row(batch.matrix, k, random.power_of_ten(-25.0, 25.0) * row(batch.matrix, k));
                    return batch;
                },
                [](const Homogeneous& at, const Batch&) {
                    return at.q.sign() > 0 &&
                           !(std::fabs(at.over_q(0).estimate()) < 1e6 && std::fabs(at.over_q(0).estimate()) > 1e-6);
                },
                0.3},
    PointFamily{"q constant: an orthographic projector",
                [](Random& random, std::size_t count) {
                    Batch batch = slide(random, count);
                    set_row(batch.matrix, 3, {0.0, 0.0, 0.0, random.coin() ? 1.0 : random.uniform(-1.0, 3.0)});
                    return batch;
                },
                [](const Homogeneous& at, const Batch&) { return at.q.sign() > 0; }, 0.5},
    PointFamily{"between two floats",
                [](Random& random, std::size_t count) {
                    Batch batch{glm::dmat4(0.0), Points(count)};
                    const double power = std::ldexp(1.0, random.integer(-10, 10));
                    for (int k = 0; k < 3; ++k) set_row(batch.matrix, k, {power, power * 0x1p-24, 0.0, 0.0});
                    set_row(batch.matrix, 3, {0.0, 0.0, 0.0, std::ldexp(1.0, random.integer(-10, 10))});
                    for (glm::vec3& point : batch.points) {
                        point.x = random.uniform_float(1.0, 2.0);
                        point.y = static_cast<float>(random.integer(-1, 3));  // 1: a tie; the others are next to one
                    }
                    return batch;
                },
                [](const Homogeneous& at, const Batch&) { return is_tie(at.over_q(0)); }, 0.3},
    PointFamily{"subnormal results",
                [](Random& random, std::size_t count) {
                    Batch batch = slide(random, count);
                    const double small = random.power_of_ten(-45.0, -38.0);
                    for (int k = 0; k < 3; ++k) set_row(batch.matrix, k, small * row(batch.matrix, k));
                    return batch;
                },
                [](const Homogeneous& at, const Batch&) {
                    return at.q.sign() > 0 && std::fabs(at.over_q(0).estimate()) < 0x1p-126;
                },
                0.3},
    PointFamily{"results about the largest float",
                [](Random& random, std::size_t count) {
                    Batch batch = slide(random, count);
                    for (int k = 0; k < 3; ++k) set_row(batch.matrix, k, 3e38 * row(batch.matrix, k));
                    return batch;
                },
                [](const Homogeneous& at, const Batch&) {
                    return at.q.sign() > 0 && std::fabs(at.over_q(0).estimate()) > 0x1p127;
                },
                0.1},
    PointFamily{"random floats in the matrix and in the points",
                [](Random& random, std::size_t count) {
                    Batch batch{glm::dmat4(0.0), Points(count)};
                    const bool all_bits = random.coin();
                    const auto any = [&] { return all_bits ? random.any_finite() : random.uniform_float(-2.0, 2.0); };
                    for (int column = 0; column < 4; ++column)
                        for (int k = 0; k < 4; ++k) batch.matrix[column][k] = static_cast<double>(any());
                    for (glm::vec3& point : batch.points)
                        for (int k = 0; k < 3; ++k) point[k] = any();
                    return batch;
                },
                [](const Homogeneous& at, const Batch&) { return at.q.sign() > 0; }, 0.3},
};

inline std::string describe(const Batch& batch, std::size_t i) {
    return hex(batch.points[i]) + " by " + hex(batch.matrix);
}

inline std::size_t any_count(Random& random) {
    return static_cast<std::size_t>(random.integer(0, 4) == 0 ? random.integer(120, 270) : random.integer(1, 67));
}

}  // namespace texcoord_cases
