#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <sstream>
#include <string>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#define TINYOBJLOADER_IMPLEMENTATION
#include <tiny_obj_loader.h>

#include "failure.hpp"
#include "files.hpp"
#include "mesh.hpp"

namespace report {

namespace {

constexpr int no_normal = -1;

struct Corner {
    int position, normal;  // from 0
};

struct ObjFile {
    std::vector<glm::dvec3> positions, normals;
    std::vector<std::array<Corner, 3>> triangles;
};

Failure unusable(const std::filesystem::path& file, const std::string& reason) {
    return {"cannot use " + file.string() + ": " + reason};
}

// A line that ends in a backslash goes on in the next one, but for comments, which may end in a path. Empty lines
// behind it keep the count of lines.
std::string with_lines_joined(const std::string& text) {
    std::istringstream lines(text);
    std::string result, line;
    std::size_t joined = 0;
    while (std::getline(lines, line)) {
        if (line.ends_with('\r')) line.pop_back();
        const bool goes_on = line.ends_with('\\') && !line.starts_with('#');
        if (goes_on) line.back() = ' ';
        result += line;
        ++joined;
        if (goes_on) continue;
        result.append(joined, '\n');
        joined = 0;
    }
    return result;
}

// The parser reads whatever is not a number as 0, so the numbers are checked here.
void check_vertices(const std::string& text, const std::filesystem::path& file) {
    std::istringstream lines(text);
    std::string line;
    for (int number = 1; std::getline(lines, line); ++number) {
        const std::size_t start = line.find_first_not_of(" \t");
        if (start == std::string::npos || line.find_first_of(" \t", start) != start + 1 || line[start] != 'v') continue;
        const char* cursor = line.c_str() + start + 1;
        for (int component = 0; component < 3; ++component) {
            char* end = nullptr;
            const double value = std::strtod(cursor, &end);
            if (end == cursor || !(std::fabs(value) <= 1e30))
                throw unusable(file, "line " + std::to_string(number) + " is not a vertex of three numbers up to 1e30");
            cursor = end;
        }
    }
}

// An OBJ index counts from 1, or from the newest backwards where it is negative. What points nowhere becomes an index
// that is out of every range.
int from_zero(int index, std::size_t count) {
    constexpr int nowhere = std::numeric_limits<int>::max();
    const int resolved = index > 0 ? index - 1 : static_cast<int>(count) + index;
    return index == 0 || resolved < 0 ? nowhere : resolved;
}

tinyobj::callback_t callbacks() {
    tinyobj::callback_t result;
    result.vertex_cb = [](void* user, float x, float y, float z, float) {
        static_cast<ObjFile*>(user)->positions.emplace_back(x, y, z);
    };
    result.normal_cb = [](void* user, float x, float y, float z) {
        static_cast<ObjFile*>(user)->normals.emplace_back(x, y, z);
    };
    // A polygon becomes a fan: it is taken to be convex.
    result.index_cb = [](void* user, tinyobj::index_t* indices, int count) {
        ObjFile& obj = *static_cast<ObjFile*>(user);
        const auto corner = [&](int i) {
            const tinyobj::index_t& index = indices[i];
            return Corner{from_zero(index.vertex_index, obj.positions.size()),
                          index.normal_index == 0 ? no_normal : from_zero(index.normal_index, obj.normals.size())};
        };
        for (int i = 2; i < count; ++i) obj.triangles.push_back({corner(0), corner(i - 1), corner(i)});
    };
    return result;
}

ObjFile parse(const std::filesystem::path& file) {
    std::string text = read_file(file);
    if (text.starts_with("\xef\xbb\xbf")) text.erase(0, 3);  // a byte order mark
    text = with_lines_joined(text);
    check_vertices(text, file);
    ObjFile obj;
    std::istringstream stream(text);
    std::string warning, error;
    if (!tinyobj::LoadObjWithCallback(stream, callbacks(), &obj, nullptr, &warning, &error))
        throw unusable(file, "not a Wavefront OBJ file");
    if (obj.triangles.empty()) throw unusable(file, "it has no faces");
    const auto is_in_range = [](int index, std::size_t count) { return static_cast<std::size_t>(index) < count; };
    for (const auto& triangle : obj.triangles)
        for (const Corner& corner : triangle)
            if (!is_in_range(corner.position, obj.positions.size()) ||
                (corner.normal != no_normal && !is_in_range(corner.normal, obj.normals.size())))
                throw unusable(file, "a face has an index out of range");
    return obj;
}

// As wide, deep or high as the teapot at most, standing on y = 0 with its middle above the origin.
void fit(std::vector<glm::dvec3>& positions, const std::filesystem::path& file) {
    glm::dvec3 min(std::numeric_limits<double>::infinity());
    glm::dvec3 max = -min;
    for (const glm::dvec3& position : positions) {
        min = glm::min(min, position);
        max = glm::max(max, position);
    }
    const glm::dvec3 size = max - min;
    const double scale = std::min(6.5 / std::max(size.x, size.z), 3.15 / size.y);
    if (!std::isfinite(scale)) throw unusable(file, "all its vertices are one point");
    const glm::dvec3 foot(0.5 * (min.x + max.x), min.y, 0.5 * (min.z + max.z));
    for (glm::dvec3& position : positions) position = (position - foot) * scale;
}

glm::dvec3 area(const ObjFile& obj, const std::array<Corner, 3>& triangle) {
    const auto at = [&](std::size_t i) { return obj.positions[static_cast<std::size_t>(triangle[i].position)]; };
    return glm::cross(at(1) - at(0), at(2) - at(0));
}

// The sum of the normals of the faces at a position, each as long as its face is large.
std::vector<glm::dvec3> smooth_normals(const ObjFile& obj) {
    std::vector<glm::dvec3> sums(obj.positions.size(), glm::dvec3(0.0));
    for (const auto& triangle : obj.triangles)
        for (const Corner& corner : triangle) sums[static_cast<std::size_t>(corner.position)] += area(obj, triangle);
    return sums;
}

}  // namespace

Mesh load_obj(const std::filesystem::path& file) {
    ObjFile obj = parse(file);
    fit(obj.positions, file);
    if (std::ranges::all_of(obj.triangles, [&](const auto& triangle) { return area(obj, triangle) == glm::dvec3(0); }))
        throw unusable(file, "its faces have no area");
    const bool has_normals = std::ranges::all_of(obj.triangles, [](const auto& triangle) {
        return std::ranges::all_of(triangle, [](const Corner& corner) { return corner.normal != no_normal; });
    });
    if (!has_normals) obj.normals = smooth_normals(obj);

    Mesh mesh;
    for (const auto& triangle : obj.triangles) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (const Corner& corner : triangle) {
            const auto normal_index = static_cast<std::size_t>(has_normals ? corner.normal : corner.position);
            const glm::dvec3 normal = obj.normals[normal_index];
            const double length = glm::length(normal);
            mesh.positions.emplace_back(obj.positions[static_cast<std::size_t>(corner.position)]);
            mesh.normals.push_back(length > 0.0 ? glm::vec3(normal / length) : glm::vec3(0, 1, 0));
        }
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    return mesh;
}

}  // namespace report
