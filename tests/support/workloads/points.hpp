#pragma once

// Workloads of points and of segments.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "support/random.hpp"
#include "support/special_values.hpp"
#include "support/stopwatch.hpp"
#include "support/workloads/numbers.hpp"
#include "support/workloads/outputs.hpp"
#include "support/workloads/texgens.hpp"
#include "texgen/segment.hpp"
#include "texgen/texcoord.hpp"

namespace support::detail {

inline constexpr std::size_t pattern = 8;

// Points that repeat until there are `Count`.
template <std::size_t Count>
std::vector<glm::vec3> points_of(Reader& reader) {
    std::vector<glm::vec3> points;
    for (std::size_t i = 0; i < Count; ++i) points.push_back(i < pattern ? reader.vec3() : points[i - pattern]);
    for (std::size_t i = Count; i < pattern; ++i) reader.vec3();
    return points;
}
inline Numbers ordinary_points(Random& random) {
    Numbers n;
    for (std::size_t i = 0; i < pattern; ++i) put(n, random.vector3(1.0));
    put(n, ordinary_texgen(random));
    return n;
}
inline Numbers draw_points(Random& random) {
    Numbers n;
    const glm::dmat4 texgen = drawn_texgen(random);
    for (std::size_t i = 0; i < pattern; ++i) {
        glm::vec3 point = random.coin() ? random.vector3(2.0) : glm::vec3(0.0f);
        if (random.coin()) point = random.vector3(4.0);
        if (random.integer(0, 31) == 0) point.y = nan_float;
        if (random.integer(0, 3) == 0)
            for (int k = 0; k < 3; ++k) point[k] = to_float(any_float(random));
        // On q = 0, but for the rounding.
        if (random.integer(0, 3) == 0 && texgen[2].w != 0.0)
            point.z = to_float(-(texgen[3].w + texgen[0].w * point.x + texgen[1].w * point.y) / texgen[2].w);
        put(n, point);
    }
    put(n, texgen);
    return n;
}
inline constexpr Inputs point_inputs{
    24, ordinary_points, draw_points,
    "drawn: points of any size, next to q = 0 or NaN, under an aligned projector or any matrix"};

struct PointBatch {
    std::vector<glm::vec3> points;
    texgen::WorldTexgen texgen;
    std::vector<float> out[4];
    std::vector<glm::vec4> strq;
    std::vector<float> xyz[3];
};
template <std::size_t Count>
std::shared_ptr<PointBatch> batch_of(const Numbers& n) {
    Reader reader(n);
    std::vector<glm::vec3> points = points_of<Count>(reader);
    auto batch =
        std::make_shared<PointBatch>(PointBatch{std::move(points), texgen::WorldTexgen(reader.dmat4()), {}, {}, {}});
    for (std::vector<float>& out : batch->out) out.resize(Count);
    batch->strq.resize(Count);
    return batch;
}

inline bool is_of_a_scene(const PointBatch& batch) {
    return is_of_a_scene(batch.texgen.matrix()) &&
           std::all_of(batch.points.begin(), batch.points.end(), [](const glm::vec3& p) { return is_of_a_scene(p); });
}

template <std::size_t Count, Asked Asks = Asked{}>
Calls project_calls(const Numbers& n) {
    const auto batch = batch_of<Count>(n);
    if (!is_of_a_scene(*batch)) return {};
    const std::vector<glm::vec3>& points = batch->points;
    texgen::Box box{points[0], points[0]};
    for (std::size_t i = 0; i < Count; ++i) {
        for (int k = 0; k < 3; ++k) {
            if (Asks.is_within && std::isnan(points[i][k])) return {};
            box.min[k] = std::min(box.min[k], points[i][k]);
            box.max[k] = std::max(box.max[k], points[i][k]);
            batch->xyz[k].push_back(points[i][k]);
        }
    }
    auto positions =
        Asks.is_planar ? texgen::world_space(batch->xyz[0], batch->xyz[1], batch->xyz[2]) : texgen::world_space(points);
    if (Asks.is_within) positions = positions.within(box);
    return calls_of([batch, positions, st = std::vector<glm::vec2>(Count)]() mutable {
        if constexpr (Asks.outputs == Outputs::pairs)
            texgen::project(batch->texgen, positions, st, Asks.tolerance());
        else
            texgen::project(batch->texgen, positions, Asks.region(), Asks.texcoords(batch->out), Asks.tolerance());
    });
}
inline Calls project_point_calls(const Numbers& n) {
    const auto batch = batch_of<1>(n);
    if (!is_of_a_scene(*batch)) return {};
    return calls_of([batch] { keep(texgen::project(batch->texgen, texgen::world_space(batch->points[0]))); });
}
template <std::size_t Count>
Calls generate_calls(const Numbers& n) {
    return calls_of([batch = batch_of<Count>(n)] {
        texgen::generate(batch->texgen, texgen::world_space(batch->points), batch->strq);
    });
}
template <std::size_t Count>
Calls generate_planar_calls(const Numbers& n) {
    return calls_of([batch = batch_of<Count>(n)] {
        auto& out = batch->out;
        texgen::generate(batch->texgen, texgen::world_space(batch->points),
                         texgen::HomogeneousTexcoords{.s = out[0], .t = out[1], .r = out[2], .q = out[3]});
    });
}
inline Calls project_bound_calls(const Numbers& n) {
    return calls_of([batch = batch_of<1024>(n)] {
        keep(texgen::project_error_bound(batch->texgen, texgen::world_space(batch->points), tolerance));
    });
}
inline Calls generate_bound_calls(const Numbers& n) {
    return calls_of([batch = batch_of<1024>(n)] {
        keep(texgen::generate_error_bound(batch->texgen, texgen::world_space(batch->points)));
    });
}
inline Calls divide_calls(const Numbers& n) {
    return calls_of([strq = Reader(n).vec4()] { keep(texgen::divide(strq)); });
}

// Segments

inline Numbers ordinary_segment(Random& random) {
    Numbers n = ordinary_strq(random);
    for (const double x : ordinary_strq(random)) n.push_back(x);
    for (std::size_t i = 0; i < pattern; ++i) put(n, random.uniform_float(0.0, 1.0));
    return n;
}
inline Numbers draw_segment(Random& random) {
    Numbers n = random.coin() ? any_numbers<8>(random) : ordinary_segment(random);
    n.resize(8);
    if (random.coin()) n[3] = n[7] = 1.0;
    if (random.integer(0, 2) == 0) {
        n = {0.5, 0.25, 0.0, 1.0, 0.75, 0.75, 0.0, 1.0};
        for (std::size_t i = 0; i < pattern; ++i) n.push_back(std::ldexp(2 * random.integer(0, 0x7fffff) + 1, -24));
        return n;
    }
    for (std::size_t i = 0; i < pattern; ++i)
        n.push_back(random.coin() ? static_cast<double>(random.uniform_float(0.0, 1.0))
                                  : static_cast<double>(to_float(n[3] / (n[3] - n[7]))));
    return n;
}
inline constexpr Inputs segment_inputs{16, ordinary_segment, draw_segment,
                                       "drawn: halves between floats, alphas next to the root of q, or any numbers"};

template <std::size_t Count, Asked Asks = Asked{}>
Calls segment_calls(const Numbers& n) {
    struct Job {
        texgen::Segment segment;
        std::vector<float> alpha;
        std::vector<float> out[4];
    };
    Reader reader(n);
    const auto job = std::make_shared<Job>();
    job->segment.a = reader.vec4();
    job->segment.b = reader.vec4();
    for (std::size_t i = 0; i < Count; ++i)
        job->alpha.push_back(i < pattern ? reader.single() : job->alpha[i - pattern]);
    for (const float alpha : job->alpha)
        if (!(alpha >= 0.0f && alpha <= 1.0f && is_of_a_scene(alpha))) return {};
    if (!is_of_a_scene(job->segment.a) || !is_of_a_scene(job->segment.b)) return {};
    for (std::vector<float>& out : job->out) out.resize(Count);
    return calls_of([job] {
        texgen::interpolate(job->segment, job->alpha, Asks.region(), Asks.texcoords(job->out), Asks.tolerance());
    });
}
inline texgen::Segment segment_of(const Numbers& n) {
    Reader reader(n);
    const glm::vec4 a = reader.vec4(), b = reader.vec4();
    return {a, b};
}
inline Calls segment_work_calls(const Numbers& n) {
    return calls_of([segment = segment_of(n)] { keep(texgen::work(segment, texgen::whole_texture(), tolerance)); });
}
inline Calls segment_bound_calls(const Numbers& n) {
    return calls_of([segment = segment_of(n)] { keep(texgen::error_bound(segment, tolerance)); });
}

}  // namespace support::detail
