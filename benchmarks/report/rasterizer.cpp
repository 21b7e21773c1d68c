#include "rasterizer.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

namespace report {

namespace {

// Window positions are rounded to 1/256 pixel, as graphics hardware does: in double the edge functions are then exact
// up to 2^18 pixels from the window, and neighbours share every edge without a gap.
glm::vec2 snapped(glm::vec2 window) { return glm::round(window * 256.0f) / 256.0f; }

// Twice the signed area of (from, to, point): positive on the inner side of an edge of a counterclockwise triangle.
double edge(glm::dvec2 from, glm::dvec2 to, glm::dvec2 point) {
    return (to.x - from.x) * (point.y - from.y) - (to.y - from.y) * (point.x - from.x);
}

struct Polygon {
    std::array<texgen::ClipVertex, 4> vertices;
    std::size_t count;
};

Polygon clipped(const std::array<glm::vec4, 3>& positions, const std::array<glm::vec4, 3>& values) {
    std::array<texgen::ClipVertex, 3> triangle;
    for (std::size_t i = 0; i < 3; ++i) triangle[i] = {positions[i], values[i]};
    Polygon polygon;
    polygon.count = texgen::clip_to_near(triangle, polygon.vertices, texgen::DepthRange::negative_one_to_one);
    return polygon;
}

Attributes blended(const std::array<Attributes, 3>& corners, glm::vec3 weights) {
    return {weights.x * corners[0].position + weights.y * corners[1].position + weights.z * corners[2].position,
            weights.x * corners[0].normal + weights.y * corners[1].normal + weights.z * corners[2].normal};
}

void append_triangle(std::vector<DrawnTriangle>& triangles, const std::array<glm::vec4, 3>& positions,
                     const std::array<glm::vec4, 3>& strq, const std::array<Attributes, 3>& corners, glm::vec3 colour,
                     std::uint32_t source, texgen::Viewport viewport, glm::vec2 offset) {
    const Polygon polygon = clipped(positions, strq);
    // The clip carries four numbers a vertex: a second pass over the corners' weights says where each new vertex lies.
    const Polygon weights = clipped(positions, {glm::vec4(1, 0, 0, 0), glm::vec4(0, 1, 0, 0), glm::vec4(0, 0, 1, 0)});
    const auto vertex = [&](std::size_t i) {
        texgen::WindowVertex result = texgen::to_window(polygon.vertices[i], viewport);
        result.window = snapped(result.window + offset);
        return result;
    };
    const auto depth = [&](std::size_t i) { return polygon.vertices[i].position.z / polygon.vertices[i].position.w; };
    const auto attributes = [&](std::size_t i) { return blended(corners, glm::vec3(weights.vertices[i].strq)); };
    for (std::size_t i = 2; i < polygon.count; ++i) {
        const texgen::Triangle triangle{vertex(0), vertex(i - 1), vertex(i)};
        if (!std::isnormal(edge(triangle.a.window, triangle.b.window, triangle.c.window))) continue;
        triangles.push_back({triangle,
                             {depth(0), depth(i - 1), depth(i)},
                             {attributes(0), attributes(i - 1), attributes(i)},
                             colour,
                             source});
    }
}

void append_surface(std::vector<DrawnTriangle>& triangles, const Surface& surface, std::uint32_t source,
                    const Camera& camera, texgen::Viewport viewport, glm::vec2 offset) {
    const glm::dmat4& world_from_object = surface.world_from_object.matrix();
    const glm::mat4 clip_from_object(camera.clip_from_world * world_from_object);
    const glm::mat3 normal_matrix(glm::transpose(glm::inverse(glm::dmat3(world_from_object))));
    for (const auto& indices : surface.mesh.triangles) {
        std::array<glm::vec4, 3> positions, strq;
        std::array<Attributes, 3> corners;
        for (std::size_t i = 0; i < 3; ++i) {
            const glm::vec4 position(surface.mesh.positions[indices[i]], 1.0f);
            positions[i] = clip_from_object * position;
            strq[i] = surface.strq[indices[i]];
            corners[i] = {glm::vec3(glm::mat4(world_from_object) * position),
                          normal_matrix * surface.mesh.normals[indices[i]]};
        }
        append_triangle(triangles, positions, strq, corners, surface.colour, source++, viewport, offset);
    }
}

// Which pixel centres of a row a triangle covers, by the top-left rule: a centre on an edge belongs to the triangle
// whose left or top edge it is.
class Coverage {
public:
    Coverage(const texgen::Triangle& triangle, int window_width)
        : corners_{triangle.a.window, triangle.b.window, triangle.c.window} {
        if (edge(corners_[0], corners_[1], corners_[2]) < 0.0) std::swap(corners_[1], corners_[2]);
        const auto [left, right] = std::minmax({corners_[0].x, corners_[1].x, corners_[2].x});
        const double last = window_width;
        columns_ = {static_cast<int>(std::clamp(std::floor(left), 0.0, last)),
                    static_cast<int>(std::clamp(std::ceil(right), 0.0, last))};
    }

    RowSpan row(int y) const {
        auto [begin, end] = columns_;
        while (begin < end && !covers(begin, y)) ++begin;
        while (end > begin && !covers(end - 1, y)) --end;
        return {begin, end};
    }

private:
    bool covers(int x, int y) const {
        const glm::dvec2 centre(x + 0.5, y + 0.5);
        for (std::size_t i = 0; i < 3; ++i) {
            const glm::dvec2& from = corners_[i];
            const glm::dvec2& to = corners_[(i + 1) % 3];
            const double side = edge(from, to, centre);
            // Counterclockwise with y up: a left edge goes down, a top edge goes to the left.
            const bool owns_its_centres = to.y < from.y || (to.y == from.y && to.x < from.x);
            if (side < 0.0 || (side == 0.0 && !owns_its_centres)) return false;
        }
        return true;
    }

    std::array<glm::dvec2, 3> corners_;
    RowSpan columns_;  // no centre outside them is covered
};

int clamped_floor(float value, int size) {
    return static_cast<int>(std::clamp(std::floor(value), 0.0f, static_cast<float>(size)));
}

// The rects of one band of rows: as narrow as what is covered there, cut where the grid of rects is.
void append_band(Workload& work, const Coverage& coverage, int y, int height) {
    std::array<RowSpan, Workload::rect_height> rows{};
    int begin = 0, end = 0;
    for (int row = 0; row < height; ++row) {
        const RowSpan span = coverage.row(y + row);
        rows[static_cast<std::size_t>(row)] = span;
        if (span.begin == span.end) continue;
        begin = begin == end ? span.begin : std::min(begin, span.begin);
        end = std::max(end, span.end);
    }
    while (begin < end) {
        const int next = std::min(end, (begin / Workload::rect_width + 1) * Workload::rect_width);
        std::array<RowSpan, Workload::rect_height> spans{};
        bool any = false;
        for (int row = 0; row < height; ++row) {
            const auto [row_begin, row_end] = rows[static_cast<std::size_t>(row)];
            const RowSpan span{std::clamp(row_begin, begin, next) - begin, std::clamp(row_end, begin, next) - begin};
            spans[static_cast<std::size_t>(row)] = span;
            any |= span.begin < span.end;
        }
        if (any) {
            work.rects.push_back({begin, y, next - begin, height});
            work.coverage.push_back(spans);
        }
        begin = next;
    }
}

}  // namespace

std::size_t Workload::evaluated_fragments() const {
    std::size_t sum = 0;
    for (const texgen::FragmentRect& rect : rects)
        sum += static_cast<std::size_t>(rect.width) * static_cast<std::size_t>(rect.height);
    return sum;
}

void Workload::add_right_triangle(int x, int side) {
    const auto vertex = [&](int right, int up, float w, glm::vec2 st) {
        const glm::vec2 at(x + right * side, x + up * side);
        return texgen::WindowVertex{at + 0.25f, w, glm::vec4(w * st, 0.5f * w, w)};
    };
    const texgen::Triangle window{vertex(0, 0, 2.0f, {0.2f, 0.1f}), vertex(1, 0, 2.6f, {0.8f, 0.3f}),
                                  vertex(0, 1, 2.3f, {0.3f, 0.9f})};
    const std::size_t first = rects.size();
    for (int y = 0; y < side; y += rect_height) {
        for (int column = 0; column < side; column += rect_width) {
            rects.push_back({x + column, x + y, std::min(rect_width, side - column), std::min(rect_height, side - y)});
            coverage.push_back({});
        }
    }
    jobs.push_back({triangles.size(), first, rects.size() - first});
    triangles.push_back({.window = window, .depth = {}, .corners = {}, .colour = {}, .source = {}});
}

Workload rasterize(std::span<const Surface> surfaces, const Camera& camera, int width, int height, glm::vec2 offset) {
    Workload work;
    std::uint32_t source = 0;
    for (const Surface& surface : surfaces) {
        append_surface(work.triangles, surface, source, camera, {0, 0, width, height}, offset);
        source += static_cast<std::uint32_t>(surface.mesh.triangles.size());
    }
    for (std::size_t i = 0; i < work.triangles.size(); ++i) {
        const texgen::Triangle& triangle = work.triangles[i].window;
        const auto [low, high] = std::minmax({triangle.a.window.y, triangle.b.window.y, triangle.c.window.y});
        const Coverage coverage(triangle, width);
        const std::size_t first = work.rects.size();
        const int top = std::min(clamped_floor(high, height) + 1, height);
        for (int y = clamped_floor(low, height); y < top; y += Workload::rect_height)
            append_band(work, coverage, y, std::min(Workload::rect_height, top - y));
        if (work.rects.size() > first) work.jobs.push_back({i, first, work.rects.size() - first});
    }
    return work;
}

Workload moved(Workload work, glm::ivec2 to) {
    for (DrawnTriangle& triangle : work.triangles)
        for (texgen::WindowVertex* vertex : {&triangle.window.a, &triangle.window.b, &triangle.window.c})
            vertex->window += glm::vec2(to);
    for (texgen::FragmentRect& rect : work.rects) {
        rect.x += to.x;
        rect.y += to.y;
    }
    return work;
}

AttributePlane::AttributePlane(const DrawnTriangle& triangle)
    : triangle_(triangle), area_(edge(triangle.window.a.window, triangle.window.b.window, triangle.window.c.window)) {}

glm::dvec3 AttributePlane::barycentric(int x, int y) const {
    const glm::dvec2 centre(x + 0.5, y + 0.5);
    const auto& [a, b, c] = triangle_.window;
    return glm::dvec3(edge(b.window, c.window, centre), edge(c.window, a.window, centre),
                      edge(a.window, b.window, centre)) /
           area_;
}

float AttributePlane::depth(int x, int y) const {
    return static_cast<float>(glm::dot(barycentric(x, y), glm::dvec3(triangle_.depth)));
}

Attributes AttributePlane::attributes(int x, int y) const {
    const auto& [a, b, c] = triangle_.window;
    const glm::dvec3 weights = barycentric(x, y) / glm::dvec3(a.clip_w, b.clip_w, c.clip_w);
    return blended(triangle_.corners, glm::vec3(weights / (weights.x + weights.y + weights.z)));
}

}  // namespace report
