#include "stage.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>

#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <texgen/linear.hpp>
#include <texgen/texcoord.hpp>

namespace report {

namespace {

constexpr glm::vec3 steel(0.55f, 0.60f, 0.75f);
constexpr glm::vec3 glow(3.0f, 1.9f, 0.4f);

}  // namespace

double relative_height(const Picture& slide) {
    return static_cast<double>(slide.height) / std::max(slide.width, slide.height);
}

texgen::Projector projector_of(const LensChoice& lens, const Picture& slide, const texgen::Aim& aim,
                               const Depth& depth) {
    const double aspect = static_cast<double>(slide.width) / slide.height;
    if (lens.is_orthographic) {
        const double top = 0.5 * lens.extent * relative_height(slide);
        return texgen::make_projector(texgen::OrthographicLens{.left = -top * aspect,
                                                               .right = top * aspect,
                                                               .bottom = -top,
                                                               .top = top,
                                                               .z_near = depth.z_near,
                                                               .z_far = depth.z_far},
                                      aim, texgen::opengl)
            .value();
    }
    const double half_height = relative_height(slide) * std::tan(0.5 * glm::radians(lens.extent));
    return texgen::make_projector(texgen::PerspectiveLens{.fovy = texgen::radians(2.0 * std::atan(half_height)),
                                                          .aspect = aspect,
                                                          .z_near = depth.z_near,
                                                          .z_far = depth.z_far},
                                  aim, texgen::opengl)
        .value();
}

glm::vec4 light_of(const LensChoice& lens, const texgen::Aim& aim) {
    return lens.is_orthographic ? glm::vec4(aim.position - aim.target, 0) : glm::vec4(aim.position, 1);
}

Camera camera(const Eye& eye, double aspect) {
    double half_height = std::tan(0.5 * glm::radians(eye.fovy));
    if (aspect < 1.0) half_height /= aspect;
    const double z_near = 0.1;
    const double top = z_near * half_height;
    const glm::dmat4 projection = glm::frustum(-top * aspect, top * aspect, -top, top, z_near, 200.0);
    return {projection * glm::lookAt(eye.position, eye.target, glm::dvec3(0, 1, 0)), eye.position};
}

texgen::ModelMatrix placed(glm::dvec3 position, double turn_degrees, double scale) {
    glm::dmat4 matrix = glm::translate(glm::dmat4(1.0), position);
    matrix = glm::rotate(matrix, glm::radians(turn_degrees), glm::dvec3(0, 1, 0));
    return texgen::ModelMatrix(glm::scale(matrix, glm::dvec3(scale)));
}

Surface projected(const texgen::ObjectTexgen& texgen, Mesh mesh, const texgen::ModelMatrix& model, glm::vec3 colour) {
    std::vector<glm::vec4> strq(mesh.positions.size());
    texgen::generate(texgen, texgen::object_space(mesh.positions), std::span(strq));
    return {std::move(mesh), model, std::move(strq), colour};
}

Surface projected(const texgen::Projector& projector, Mesh mesh, const texgen::ModelMatrix& model, glm::vec3 colour) {
    return projected(texgen::object_linear(projector, model), std::move(mesh), model, colour);
}

Surface unlit(Mesh mesh, const texgen::ModelMatrix& model, glm::vec3 colour) {
    std::vector<glm::vec4> strq(mesh.positions.size(), glm::vec4(-1, -1, 0, 1));
    return {std::move(mesh), model, std::move(strq), colour};
}

Surface body_of(const texgen::Aim& aim, double floor) {
    const auto foot = static_cast<float>(floor - aim.position.y);
    Mesh body = box({-0.3f, -0.3f, -0.25f}, {0.5f, 0.3f, 0.25f});
    append(body, box({-0.5f, -0.15f, -0.15f}, {-0.3f, 0.15f, 0.15f}));
    append(body, box({0.04f, foot, -0.06f}, {0.16f, -0.3f, 0.06f}));
    const glm::dvec3 ahead = aim.target - aim.position;
    const texgen::ModelMatrix model = placed(aim.position, glm::degrees(std::atan2(ahead.z, -ahead.x)), 1);
    return unlit(std::move(body), model, steel);
}

std::vector<Surface> edges_of(const texgen::Projector& projector) {
    const glm::dmat4 world_from_clip = texgen::inverse(projector.matrix()).value().matrix();
    const auto corner = [&](std::size_t i) {
        const glm::dvec4 at = world_from_clip * glm::dvec4(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1, 1);
        return glm::dvec3(at) / at.w;
    };
    std::vector<Surface> edges;
    for (std::size_t from = 0; from < 8; ++from) {
        for (const std::size_t bit : {1u, 2u, 4u}) {
            if ((from & bit) != 0) continue;
            const glm::dvec3 along = corner(from | bit) - corner(from), ahead = glm::normalize(along);
            const glm::dvec3 aside = glm::normalize(glm::cross(ahead, glm::dvec3(0.31, 0.42, 0.85)));
            const glm::dmat4 model(glm::dvec4(aside, 0), glm::dvec4(glm::cross(ahead, aside), 0), glm::dvec4(ahead, 0),
                                   glm::dvec4(corner(from), 1));
            const float half = 0.02f, length = static_cast<float>(glm::length(along));
            edges.push_back(unlit(box({-half, -half, 0}, {half, half, length}), texgen::ModelMatrix(model), glow));
        }
    }
    return edges;
}

}  // namespace report
