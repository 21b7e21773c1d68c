#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

#include <glm/vec3.hpp>

namespace report {

// Triangles in object space, y up. Their winding means nothing: shading is two-sided.
struct Mesh {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;  // of unit length, one a position
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

// Newell's teapot, standing on y = 0 at the origin: 6.5 wide, 3.15 high. Each patch has divisions^2 cells.
Mesh teapot(int divisions);

// The parallelogram corner, corner + u, corner + v in cells^2 pairs of triangles.
Mesh parallelogram(glm::vec3 corner, glm::vec3 u, glm::vec3 v, int cells);

// An axis-parallel box.
Mesh box(glm::vec3 min, glm::vec3 max);

void append(Mesh& mesh, const Mesh& other);

// A Wavefront OBJ file, moved and scaled to stand where the teapot stands. Normals are the file's where every corner
// has one. Throws Failure for a file that is not a mesh.
Mesh load_obj(const std::filesystem::path& file);

}  // namespace report
