#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <texgen/conventions.hpp>

#include "mesh.hpp"
#include "picture.hpp"
#include "rasterizer.hpp"

namespace report {

enum class Shading {
    slide_as_light,  // Lambert's law for the projector's light, on top of a dim light at the camera
    modulate,        // the camera's light times the texture, clamped to its edge
    slide_alone      // the texture as it is
};

enum class Coordinates {
    library,             // texgen::interpolate
    ignoring_sign_of_q,  // s/q and t/q wherever they fall: the reverse projection is not cured
};

// How the slide is looked up; or what footprints say of it, as colours. All but bilinear are drawn with one sample a pixel.
enum class Sampling { bilinear, nearest, trilinear, anisotropic, level_as_colour, anisotropy_as_colour };

// One picture.
struct View {
    std::string file, caption;
    std::vector<Surface> surfaces;
    std::shared_ptr<const Picture> slide;
    Coordinates coordinates = Coordinates::library;
    Sampling sampling = Sampling::bilinear;
};

// The first view is the one that is timed and checked; further ones show it next to what it would be otherwise.
struct Scene {
    std::string name, title;
    Camera camera;
    Shading shading;
    glm::vec4 light;  // the projector's position (w = 1), or the direction to it (w = 0)
    texgen::TextureRegion region;
    std::vector<View> views;
};

// `mesh` stands where the teapot stands. The camera has the given aspect.
std::vector<Scene> make_scenes(const Mesh& mesh, const Picture& slide, double aspect);

}  // namespace report
