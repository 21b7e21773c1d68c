// What a frame makes anew: T_o for each object, or T_e for the camera, and what reaches a vertex of either in float.

#include <memory>
#include <random>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <texgen/linear.hpp>

#include "bench.hpp"

namespace bench {

namespace {

constexpr std::size_t object_count = 64;

using LongMatrix = glm::mat<4, 4, long double>;
using LongVector = glm::vec<4, long double>;

// Objects that turn about a place that is far from the origin, under a projector and before a camera that stand there.
class Objects {
public:
    Objects() {
        std::mt19937 random(3);
        const auto between = [&](double low, double high) {
            return std::uniform_real_distribution<double>(low, high)(random);
        };
        const glm::dvec3 place(700, 20, -700);
        for (std::size_t i = 0; i < object_count; ++i) {
            const glm::dvec3 offset(between(-1, 1), between(-1, 1), between(-1, 1));
            const glm::dvec3 axis(between(-1, 1), between(-1, 1), 1);
            models_.emplace_back(glm::rotate(glm::translate(glm::dmat4(1), place + offset), between(0, 6), axis));
            poses_.emplace_back(glm::inverse(glm::lookAt(place + offset + glm::dvec3(0, 2, 8), place, {0, 1, 0})));
        }
        const texgen::PerspectiveLens lens{.fovy = texgen::degrees(40), .aspect = 1, .z_near = 1, .z_far = 100};
        const auto projector = texgen::make_projector(
            lens, texgen::Aim{.position = place + glm::dvec3(3, 6, 5), .target = place, .up = {0, 1, 0}},
            texgen::opengl);
        if (!projector) fail("matrices: the projector was refused");
        projector_.push_back(*projector);
        texture_from_world_ = glm::mat4(texgen::texture_from_world(*projector).matrix());
    }

    const texgen::Projector& projector() const { return projector_.front(); }
    const texgen::ModelMatrix& model(std::size_t i) const { return models_[i]; }
    const texgen::CameraPose& pose(std::size_t i) const { return poses_[i]; }
    // What an engine keeps in float.
    const glm::mat4& texture_from_world() const { return texture_from_world_; }

    glm::mat4* result(std::size_t i) const { return reinterpret_cast<glm::mat4*>(output(16 * object_count)) + i; }

    // The error of the quotients of a vertex near the object's origin, or of a point eight before the camera.
    void check(std::size_t i, const glm::dmat4& world_from_space, const LongVector& vertex, Errors& errors) const {
        const LongVector exact = LongMatrix(projector().projection.matrix()) * LongMatrix(projector().view.matrix()) *
                                 (LongMatrix(world_from_space) * vertex);
        const LongVector computed = LongMatrix(*result(i)) * vertex;
        for (int row = 0; row < 2; ++row) {
            const long double wanted = (exact[row] / exact[3] + 1) / 2;
            errors.add_texels(static_cast<double>(computed[row] / computed[3] - wanted));
            errors.add_ulp(static_cast<float>(computed[row] / computed[3]), static_cast<double>(wanted));
        }
    }

private:
    std::vector<texgen::Projector> projector_;
    std::vector<texgen::ModelMatrix> models_;
    std::vector<texgen::CameraPose> poses_;
    glm::mat4 texture_from_world_{1};
};

}  // namespace

void add_matrices() {
    const auto objects = std::make_shared<Objects>();
    const auto add = [&](const Scene& scene, const std::string& name, auto run, auto check) {
        add_row(scene, name, promises_nothing, run, check);
    };
    const auto check_object = [=](std::size_t i, Errors& errors) {
        objects->check(i, objects->model(i).matrix(), {0.5L, -0.25L, 0.125L, 1}, errors);
    };
    const auto check_camera = [=](std::size_t i, Errors& errors) {
        objects->check(i, objects->pose(i).matrix(), {0.5L, -0.25L, -8, 1}, errors);
    };
    const Scene per_object{"matrices, T_o of an object", object_count, 1};
    add(
        per_object, "texgen, object_linear()",
        [=](std::size_t i) {
            *objects->result(i) = texgen::object_linear(objects->projector(), objects->model(i)).rounded();
        },
        check_object);
    add(
        per_object, "GLM, mat4 * mat4",
        [=](std::size_t i) {
            *objects->result(i) = objects->texture_from_world() * glm::mat4(objects->model(i).matrix());
        },
        check_object);
    const Scene per_camera{"matrices, T_e of a camera", object_count, 1};
    add(
        per_camera, "texgen, eye_linear()",
        [=](std::size_t i) {
            *objects->result(i) = texgen::eye_linear(objects->projector(), objects->pose(i)).rounded();
        },
        check_camera);
    add(
        per_camera, "GLM, mat4 * mat4",
        [=](std::size_t i) {
            *objects->result(i) = objects->texture_from_world() * glm::mat4(objects->pose(i).matrix());
        },
        check_camera);
}

}  // namespace bench
