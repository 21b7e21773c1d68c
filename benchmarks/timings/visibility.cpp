// Visibility buffers: the fragments of a rectangle, each of the triangle that its id names, to s, t and to footprints.

#include <cstdint>
#include <memory>
#include <random>
#include <span>
#include <string>
#include <vector>

#include <texgen/batch.hpp>
#include <texgen/reference.hpp>

#include "../peers.hpp"
#include "bench.hpp"
#include "derivatives.hpp"

namespace bench {

namespace {

constexpr texgen::FragmentRect rect{0, 0, 128, 64};
constexpr std::size_t count = 128 * 64;

struct Buffer {
    std::vector<texgen::Triangle> triangles;
    std::vector<std::uint32_t> ids;
};

// 256 triangles that cover the rectangle, in runs of so many fragments.
std::shared_ptr<Buffer> make_buffer(std::size_t run) {
    std::mt19937 random(11);
    const auto between = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    auto buffer = std::make_shared<Buffer>();
    for (int i = 0; i < 256; ++i) {
        const auto vertex = [&](double x, double y, double q_over_w, double s, double t) {
            const double w = static_cast<float>(between(1, 4));
            const double q = w * q_over_w;
            return texgen::WindowVertex{glm::vec2(x, y), static_cast<float>(w), glm::vec4(s * q, t * q, 0.5 * q, q)};
        };
        const double x = between(-40, -1), y = between(-40, -1);
        buffer->triangles.push_back({vertex(x, y, 2, between(0, 0.2), between(0, 0.2)),
                                     vertex(x + 300, y, 2.6, between(0.8, 1), between(0, 0.3)),
                                     vertex(x, y + 300, 2.3, between(0, 0.3), between(0.8, 1))});
    }
    while (buffer->ids.size() < count) buffer->ids.insert(buffer->ids.end(), run, random() % 256);
    return buffer;
}

std::span<float> array(std::size_t k) { return {output(count, k), count}; }

void add_footprints_of(const std::string& name, const std::shared_ptr<Buffer>& buffer) {
    const Scene scene{"footprints of a visibility buffer, " + name, 1, count};
    const auto check = [=](std::size_t, Errors& errors) {
        for (std::size_t k = 0; k < count; k += 97)
            judge(Derivatives(buffer->triangles[buffer->ids[k]], static_cast<int>(k % 128), static_cast<int>(k / 128)),
                  count, k, errors);
    };
    auto batch = std::make_shared<texgen::TriangleBatch>(texgen::whole_texture());
    batch->assign(buffer->triangles);
    const auto write = [=](const texgen::Footprints& out) {
        texgen::footprint(*batch, buffer->ids, rect, {4096, 4096}, out);
    };
    add_row(
        scene, "four derivatives: texgen", 0.0,
        [=](std::size_t) { write({.dsdx = array(0), .dtdx = array(1), .dsdy = array(2), .dtdy = array(3)}); }, check);
    add_unchecked(scene, "level of detail: texgen", [=](std::size_t) { write({.level = array(0)}); });
    add_unchecked(scene, "level, anisotropy, major axis: texgen", [=](std::size_t) {
        write({.level = array(0), .anisotropy = array(1), .major_s = array(2), .major_t = array(3)});
    });
    std::vector<report::GlmPlanes> planes(buffer->triangles.begin(), buffer->triangles.end());
    const auto look_up = [=](std::size_t) {
        float* const to[] = {output(count, 0), output(count, 1), output(count, 2), output(count, 3)};
        for (std::size_t k = 0; k < count; ++k) {
            const report::GlmPlanes& plane = planes[buffer->ids[k]];
            const glm::vec3 centre(static_cast<float>(k % 128) + 0.5f, static_cast<float>(k / 128) + 0.5f, 1.0f);
            const float q = glm::dot(plane.q, centre);
            const glm::vec2 st = glm::vec2(glm::dot(plane.s, centre), glm::dot(plane.t, centre)) / q;
            const glm::vec2 dx = (glm::vec2(plane.s.x, plane.t.x) - st * plane.q.x) / q;
            const glm::vec2 dy = (glm::vec2(plane.s.y, plane.t.y) - st * plane.q.y) / q;
            to[0][k] = dx.x;
            to[1][k] = dx.y;
            to[2][k] = dy.x;
            to[3][k] = dy.y;
        }
    };
    add_row(scene, "four derivatives: GLM, plane equations looked up", promises_nothing, look_up, check);
}

void add_buffer(const std::string& name, std::size_t run) {
    const std::shared_ptr<Buffer> buffer = make_buffer(run);
    const Scene scene{"visibility buffer, " + name, 1, count};
    const auto check = [=](std::size_t, Errors& errors) {
        for (std::size_t k = 0; k < count; ++k) {
            const auto x = static_cast<long double>(k % 128) + 0.5L, y = static_cast<long double>(k / 128) + 0.5L;
            const auto exact = texgen::reference::quotient<long double>(
                texgen::reference::strq<long double>(buffer->triangles[buffer->ids[k]], x, y));
            errors.add(output(count, 0)[k], static_cast<double>(exact[0]));
            errors.add(output(count, 1)[k], static_cast<double>(exact[1]));
        }
    };
    for (const NamedTolerance& given : tolerances) {
        auto batch = std::make_shared<texgen::TriangleBatch>(texgen::whole_texture(), given.tolerance);
        batch->assign(buffer->triangles);
        const auto interpolate = [=](std::size_t) {
            texgen::interpolate(*batch, buffer->ids, rect,
                                {.s = {output(count, 0), count}, .t = {output(count, 1), count}, .r = {}, .lit = {}});
        };
        add_row(scene, given.name, given.tolerance.value, interpolate, check);
    }
    std::vector<report::GlmPlanes> planes(buffer->triangles.begin(), buffer->triangles.end());
    const auto look_up = [=](std::size_t) {
        float* const s = output(count, 0);
        float* const t = output(count, 1);
        for (std::size_t k = 0; k < count; ++k) {
            const report::GlmPlanes& plane = planes[buffer->ids[k]];
            const glm::vec3 centre(static_cast<float>(k % 128) + 0.5f, static_cast<float>(k / 128) + 0.5f, 1.0f);
            const float q = glm::dot(plane.q, centre);
            s[k] = glm::dot(plane.s, centre) / q;
            t[k] = glm::dot(plane.t, centre) / q;
        }
    };
    add_row(scene, "GLM, plane equations looked up", promises_nothing, look_up, check);
    add_footprints_of(name, buffer);
}

}  // namespace

void add_visibility() {
    add_buffer("128x64, runs of 8", 8);
    add_buffer("128x64, ids in any order", 1);
}

}  // namespace bench
