#include "distances.hpp"

#include <algorithm>
#include <cmath>

#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/mat4x4.hpp>
#include <glm/trigonometric.hpp>
#include <texgen/linear.hpp>
#include <texgen/projector.hpp>
#include <texgen/texcoord.hpp>

#include "../error.hpp"

namespace report {

namespace {

// S P V M from the same numbers, all of which are floats, in the given arithmetic.
template <class Number>
struct Matrices {
    using Matrix = glm::mat<4, 4, Number, glm::defaultp>;
    using Vector = glm::vec<3, Number, glm::defaultp>;

    Matrix texture_from_world, world_from_object;

    Matrices(glm::vec3 place, glm::vec3 projector)
        : texture_from_world(Matrix(.5, 0, 0, 0, 0, .5, 0, 0, 0, 0, .5, 0, .5, .5, .5, 1) *
                             glm::perspective(glm::radians(Number(30)), Number(1), Number(0.2), Number(1000)) *
                             glm::lookAt(Vector(projector), Vector(place), Vector(0, 1, 0))),
          world_from_object(glm::rotate(glm::translate(Matrix(1), Vector(place)), Number(0.5), Vector(0, 1, 0))) {}
};

template <class Vector>
double error_of(const Vector& strq, glm::dvec2 exact) {
    return texture_size * finite(std::max(std::fabs(static_cast<double>(strq.x / strq.w) - exact.x),
                                          std::fabs(static_cast<double>(strq.y / strq.w) - exact.y)));
}

}  // namespace

std::vector<Series> errors_by_distance() {
    std::vector<Series> series{{"GLM, matrices in float", Series::Mark::line, {}},
                               {"positions in the world, in float", Series::Mark::line, {}},
                               {"texgen, T_o in a shader, in float", Series::Mark::line, {}},
                               {"texgen, exact", Series::Mark::line, {}}};
    for (double distance = 1; distance < 2e7; distance *= std::sqrt(10.0)) {
        const glm::vec3 place(0.6 * distance, 0, -0.8 * distance), projector = place + glm::vec3(2, 3, 4);
        const Matrices<float> plain(place, projector);
        const Matrices<long double> exact(place, projector);
        const auto ours = texgen::object_linear(
            texgen::make_projector(
                texgen::PerspectiveLens{.fovy = texgen::degrees(30), .aspect = 1, .z_near = 0.2, .z_far = 1000},
                {projector, place, {0, 1, 0}}, texgen::opengl)
                .value(),
            texgen::ModelMatrix(Matrices<double>(place, projector).world_from_object));
        const glm::mat4 all_in_float = plain.texture_from_world * plain.world_from_object;
        const glm::mat4 rounded = ours.rounded();
        std::array<double, 4> worst{1e-9, 1e-9, 1e-9, 1e-9};
        for (int i = 0; i < 512; ++i) {
            const glm::vec3 point = (glm::vec3(i % 8, i / 8 % 8, i / 64) - 3.4f) / 7.0f;
            const auto strq = exact.texture_from_world * (exact.world_from_object * glm::vec<4, long double>(point, 1));
            const glm::dvec2 st(strq.x / strq.w, strq.y / strq.w);
            const glm::vec4 world = plain.world_from_object * glm::vec4(point, 1);
            glm::vec2 projected;
            texgen::project(ours, texgen::object_space({&point, 1}), {&projected, 1});
            const glm::vec4 found[] = {all_in_float * glm::vec4(point, 1), plain.texture_from_world * world,
                                       rounded * glm::vec4(point, 1), glm::vec4(projected, 0, 1)};
            for (std::size_t k = 0; k < worst.size(); ++k) worst[k] = std::max(worst[k], error_of(found[k], st));
        }
        for (std::size_t k = 0; k < worst.size(); ++k) series[k].points.emplace_back(distance, worst[k]);
    }
    return series;
}

}  // namespace report
