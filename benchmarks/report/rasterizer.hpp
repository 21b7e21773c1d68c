#pragma once

// A small z-buffered rasteriser for the report. It finds which fragments a triangle covers; their texture coordinates
// are the library's.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <texgen/clip.hpp>
#include <texgen/primitives.hpp>
#include <texgen/texcoord.hpp>
#include <texgen/transform.hpp>

#include "mesh.hpp"

namespace report {

struct Camera {
    glm::dmat4 clip_from_world;  // OpenGL's clip space
    glm::dvec3 position;
};

// A mesh in its place, with the homogeneous texture coordinates of its vertices.
struct Surface {
    Mesh mesh;
    texgen::ModelMatrix world_from_object;
    std::vector<glm::vec4> strq;
    glm::vec3 colour;
};

// What is shaded: a vertex' or a fragment's.
struct Attributes {
    glm::vec3 position, normal;  // in the world
};

struct DrawnTriangle {
    texgen::Triangle window;
    glm::vec3 depth;  // z/w at the three corners
    std::array<Attributes, 3> corners;
    glm::vec3 colour;
    std::uint32_t source;  // which triangle of the surfaces it is, or is a part of
};

// The covered fragments [begin, end) of one row of a rect, counted from the rect's left side.
struct RowSpan {
    int begin, end;
};

// The work of a frame in the order of drawing, so that every interpolator can be given the same.
struct Workload {
    struct Job {
        std::size_t triangle;
        std::size_t first_rect, rect_count;
    };
    static constexpr int rect_width = 64;
    static constexpr int rect_height = 8;
    static constexpr std::size_t rect_area = std::size_t{rect_width} * rect_height;

    std::vector<DrawnTriangle> triangles;
    std::vector<Job> jobs;
    std::vector<texgen::FragmentRect> rects;                 // none is larger than rect_width x rect_height
    std::vector<std::array<RowSpan, rect_height>> coverage;  // one a rect

    std::span<const texgen::FragmentRect> rects_of(const Job& job) const {
        return std::span(rects).subspan(job.first_rect, job.rect_count);
    }
    std::size_t evaluated_fragments() const;

    // Half of a square at (x, x), on the slide, with the rects of the whole.
    void add_right_triangle(int x, int side);
};

// The texture coordinates of one rect, row by row.
struct RectCoordinates {
    std::array<float, Workload::rect_area> s, t, r, lit;

    texgen::Texcoords of(texgen::FragmentRect rect) {
        const std::size_t count = static_cast<std::size_t>(rect.width) * static_cast<std::size_t>(rect.height);
        return {.s = std::span(s).first(count),
                .t = std::span(t).first(count),
                .r = {},
                .lit = std::span(lit).first(count)};
    }
    texgen::Texcoords with_r(texgen::FragmentRect rect) {
        texgen::Texcoords out = of(rect);
        out.r = std::span(r).first(out.s.size());
        return out;
    }
};

// The triangles of the surfaces in the window, clipped to the camera's near plane, and the rects that cover them. The
// picture is shifted by `offset` pixels.
Workload rasterize(std::span<const Surface> surfaces, const Camera& camera, int width, int height,
                   glm::vec2 offset = glm::vec2(0));

// The same work in a larger window, of which the picture begins at the given pixel.
Workload moved(Workload work, glm::ivec2 to);

// Perspective-correct depth and attributes at the centre of a fragment.
class AttributePlane {
public:
    explicit AttributePlane(const DrawnTriangle& triangle);
    float depth(int x, int y) const;
    Attributes attributes(int x, int y) const;

private:
    glm::dvec3 barycentric(int x, int y) const;

    const DrawnTriangle& triangle_;
    double area_;
};

}  // namespace report
