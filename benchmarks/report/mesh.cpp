#include "mesh.hpp"

#include <algorithm>
#include <cstddef>

#include <glm/geometric.hpp>

namespace report {

namespace {

using Row = std::array<glm::dvec3, 4>;
using Patch = std::array<Row, 4>;

// Martin Newell's teapot, z up: six profiles (radius, height), of which a quarter turn makes a patch, and the four
// patches of the handle and the spout, of which the other half is the mirror image.
struct ProfilePoint {
    double radius, height;
};

constexpr std::array<std::array<ProfilePoint, 4>, 6> profiles{{
    {{{1.4, 2.4}, {1.3375, 2.53125}, {1.4375, 2.53125}, {1.5, 2.4}}},  // rim
    {{{1.5, 2.4}, {1.75, 1.875}, {2.0, 1.35}, {2.0, 0.9}}},            // upper body
    {{{2.0, 0.9}, {2.0, 0.45}, {1.5, 0.225}, {1.5, 0.15}}},            // lower body
    {{{0.0, 3.15}, {0.8, 3.15}, {0.0, 2.85}, {0.2, 2.7}}},             // knob
    {{{0.2, 2.7}, {0.4, 2.55}, {1.3, 2.55}, {1.3, 2.4}}},              // lid
    {{{0.0, 0.0}, {1.425, 0.0}, {1.5, 0.075}, {1.5, 0.15}}},           // bottom
}};

constexpr std::array<std::array<std::array<std::array<double, 3>, 4>, 4>, 4> mirrored_patches{{
    {{{{{-1.6, 0, 2.025}, {-1.6, -0.3, 2.025}, {-1.5, -0.3, 2.25}, {-1.5, 0, 2.25}}},  // upper handle
      {{{-2.3, 0, 2.025}, {-2.3, -0.3, 2.025}, {-2.5, -0.3, 2.25}, {-2.5, 0, 2.25}}},
      {{{-2.7, 0, 2.025}, {-2.7, -0.3, 2.025}, {-3, -0.3, 2.25}, {-3, 0, 2.25}}},
      {{{-2.7, 0, 1.8}, {-2.7, -0.3, 1.8}, {-3, -0.3, 1.8}, {-3, 0, 1.8}}}}},
    {{{{{-2.7, 0, 1.8}, {-2.7, -0.3, 1.8}, {-3, -0.3, 1.8}, {-3, 0, 1.8}}},  // lower handle
      {{{-2.7, 0, 1.575}, {-2.7, -0.3, 1.575}, {-3, -0.3, 1.35}, {-3, 0, 1.35}}},
      {{{-2.5, 0, 1.125}, {-2.5, -0.3, 1.125}, {-2.65, -0.3, 0.9375}, {-2.65, 0, 0.9375}}},
      {{{-2, 0, 0.9}, {-2, -0.3, 0.9}, {-1.9, -0.3, 0.6}, {-1.9, 0, 0.6}}}}},
    {{{{{1.7, 0, 1.425}, {1.7, -0.66, 1.425}, {1.7, -0.66, 0.6}, {1.7, 0, 0.6}}},  // lower spout
      {{{2.6, 0, 1.425}, {2.6, -0.66, 1.425}, {3.1, -0.66, 0.825}, {3.1, 0, 0.825}}},
      {{{2.3, 0, 2.1}, {2.3, -0.25, 2.1}, {2.4, -0.25, 2.025}, {2.4, 0, 2.025}}},
      {{{2.7, 0, 2.4}, {2.7, -0.25, 2.4}, {3.3, -0.25, 2.4}, {3.3, 0, 2.4}}}}},
    {{{{{2.7, 0, 2.4}, {2.7, -0.25, 2.4}, {3.3, -0.25, 2.4}, {3.3, 0, 2.4}}},  // upper spout
      {{{2.8, 0, 2.475}, {2.8, -0.25, 2.475}, {3.525, -0.25, 2.49375}, {3.525, 0, 2.49375}}},
      {{{2.9, 0, 2.475}, {2.9, -0.15, 2.475}, {3.45, -0.15, 2.5125}, {3.45, 0, 2.5125}}},
      {{{2.8, 0, 2.4}, {2.8, -0.15, 2.4}, {3.2, -0.15, 2.4}, {3.2, 0, 2.4}}}}},
}};

// A cubic Bezier curve's point and derivative.
struct CurvePoint {
    glm::dvec3 point, derivative;
};

CurvePoint evaluate(const Row& control, double u) {
    const double v = 1.0 - u;
    return {
        v * v * v * control[0] + 3.0 * u * v * v * control[1] + 3.0 * u * u * v * control[2] + u * u * u * control[3],
        3.0 * (v * v * (control[1] - control[0]) + 2.0 * u * v * (control[2] - control[1]) +
               u * u * (control[3] - control[2]))};
}

glm::dvec3 position_on(const Patch& patch, double u, double v) {
    Row across;
    for (std::size_t i = 0; i < 4; ++i) across[i] = evaluate(patch[i], v).point;
    return evaluate(across, u).point;
}

glm::dvec3 normal_on(const Patch& patch, double u, double v) {
    // At the knob's tip and the bottom's centre a patch shrinks to a point: a step aside has the same normal.
    u = std::clamp(u, 1e-3, 1.0 - 1e-3);
    Row across;
    Row across_derivative;
    for (std::size_t i = 0; i < 4; ++i) {
        const CurvePoint row = evaluate(patch[i], v);
        across[i] = row.point;
        across_derivative[i] = row.derivative;
    }
    return glm::normalize(glm::cross(evaluate(across, u).derivative, evaluate(across_derivative, u).point));
}

// The cells of a grid of (divisions + 1)^2 vertices that starts at vertex `first`, as two triangles each.
void append_cells(Mesh& mesh, std::uint32_t first, std::uint32_t divisions) {
    const std::uint32_t row = divisions + 1;
    for (std::uint32_t i = 0; i < divisions; ++i) {
        for (std::uint32_t j = 0; j < divisions; ++j) {
            const std::uint32_t corner = first + i * row + j;
            mesh.triangles.push_back({corner, corner + row, corner + 1});
            mesh.triangles.push_back({corner + 1, corner + row, corner + row + 1});
        }
    }
}

void append_patch(Mesh& mesh, const Patch& patch, int divisions) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const auto y_up = [](const glm::dvec3& v) { return glm::vec3(glm::dvec3(v.x, v.z, -v.y)); };
    for (int i = 0; i <= divisions; ++i) {
        for (int j = 0; j <= divisions; ++j) {
            const double u = static_cast<double>(i) / divisions;
            const double v = static_cast<double>(j) / divisions;
            mesh.positions.push_back(y_up(position_on(patch, u, v)));
            mesh.normals.push_back(y_up(normal_on(patch, u, v)));
        }
    }
    append_cells(mesh, first, static_cast<std::uint32_t>(divisions));
}

}  // namespace

Mesh teapot(int divisions) {
    constexpr double arc = 0.56;  // Newell's control point for a quarter of a circle
    Mesh mesh;
    for (const auto& profile : profiles) {
        for (int quarter = 0; quarter < 4; ++quarter) {
            Patch patch;
            for (std::size_t i = 0; i < 4; ++i) {
                const auto [r, z] = profile[i];
                patch[i] = {glm::dvec3(r, 0, z), glm::dvec3(r, -arc * r, z), glm::dvec3(arc * r, -r, z),
                            glm::dvec3(0, -r, z)};
                for (glm::dvec3& point : patch[i])
                    for (int turn = 0; turn < quarter; ++turn) point = {point.y, -point.x, point.z};
            }
            append_patch(mesh, patch, divisions);
        }
    }
    for (const auto& half : mirrored_patches) {
        for (const double side : {1.0, -1.0}) {
            Patch patch;
            for (std::size_t i = 0; i < 4; ++i)
                for (std::size_t j = 0; j < 4; ++j)
                    patch[i][j] = glm::dvec3(half[i][j][0], side * half[i][j][1], half[i][j][2]);
            append_patch(mesh, patch, divisions);
        }
    }
    return mesh;
}

Mesh parallelogram(glm::vec3 corner, glm::vec3 u, glm::vec3 v, int cells) {
    Mesh mesh;
    for (int i = 0; i <= cells; ++i)
        for (int j = 0; j <= cells; ++j)
            mesh.positions.push_back(corner + static_cast<float>(i) / static_cast<float>(cells) * u +
                                     static_cast<float>(j) / static_cast<float>(cells) * v);
    mesh.normals.assign(mesh.positions.size(), glm::normalize(glm::cross(u, v)));
    append_cells(mesh, 0, static_cast<std::uint32_t>(cells));
    return mesh;
}

Mesh box(glm::vec3 min, glm::vec3 max) {
    Mesh mesh;
    const glm::vec3 size = max - min;
    for (int axis = 0; axis < 3; ++axis) {
        glm::vec3 u(0.0f), v(0.0f), w(0.0f);
        u[(axis + 1) % 3] = size[(axis + 1) % 3];
        v[(axis + 2) % 3] = size[(axis + 2) % 3];
        w[axis] = size[axis];
        append(mesh, parallelogram(min, u, v, 1));
        append(mesh, parallelogram(min + w, u, v, 1));
    }
    return mesh;
}

void append(Mesh& mesh, const Mesh& other) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
    mesh.normals.insert(mesh.normals.end(), other.normals.begin(), other.normals.end());
    for (const auto& [a, b, c] : other.triangles) mesh.triangles.push_back({first + a, first + b, first + c});
}

}  // namespace report
