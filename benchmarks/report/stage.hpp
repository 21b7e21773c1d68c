#pragma once

// What scenes are built of: projectors by the lens of their slide, cameras, and surfaces with or without the slide.

#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <texgen/projector.hpp>
#include <texgen/transform.hpp>

#include "mesh.hpp"
#include "picture.hpp"
#include "rasterizer.hpp"

namespace report {

// Of the projector: the angle in degrees, or with parallel rays the width, of the slide's longer side.
struct LensChoice {
    bool is_orthographic = false;
    double extent = 30;
};

struct Depth {
    double z_near = 0.2, z_far = 1000;
};

// How high the slide is when its longer side is 1.
double relative_height(const Picture& slide);

texgen::Projector projector_of(const LensChoice& lens, const Picture& slide, const texgen::Aim& aim,
                               const Depth& depth = {});

// From where its light comes: from a point, or from afar.
glm::vec4 light_of(const LensChoice& lens, const texgen::Aim& aim);

struct Eye {
    glm::dvec3 position, target;
    double fovy;  // of the shorter side of the picture, in degrees
};
Camera camera(const Eye& eye, double aspect);

inline const texgen::ModelMatrix in_place{glm::dmat4(1.0)};
texgen::ModelMatrix placed(glm::dvec3 position, double turn_degrees, double scale);

// With the texture coordinates that the slide has there.
Surface projected(const texgen::ObjectTexgen& texgen, Mesh mesh, const texgen::ModelMatrix& model, glm::vec3 colour);
Surface projected(const texgen::Projector& projector, Mesh mesh, const texgen::ModelMatrix& model, glm::vec3 colour);

// What gets no slide.
Surface unlit(Mesh mesh, const texgen::ModelMatrix& model, glm::vec3 colour);

// The projector's own body, around the centre of projection, where q is nearly 0.
Surface body_of(const texgen::Aim& aim, double floor);

// The edges of what a projector lights between its near plane and its far one.
std::vector<Surface> edges_of(const texgen::Projector& projector);

}  // namespace report
