#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec4.hpp>
#include <texgen/conventions.hpp>

#include "depth_map.hpp"
#include "mesh.hpp"
#include "picture.hpp"
#include "rasterizer.hpp"
#include "stage.hpp"

namespace report {

enum class Shading {
    slide_as_light,  // Lambert's law for the projector's light, on top of a dim light at the camera
    slide_as_paint,  // as bright at any angle, on top of the same
    modulate,        // the camera's light times the texture, clamped to its edge
    slide_alone      // the texture as it is
};

enum class Coordinates {
    library,             // texgen::interpolate
    float_planes,        // plane equations in float, as a user of GLM writes them
    ignoring_sign_of_q,  // s/q and t/q wherever they fall: the reverse projection is not cured
};

// How the slide is looked up; or what footprints, or the reference, say of it, as colours. All but bilinear are drawn
// with one sample a pixel.
enum class Sampling {
    bilinear,
    nearest,
    trilinear,
    anisotropic,
    level_as_colour,
    anisotropy_as_colour,
    error_as_colour,
    depth_from_projector  // not by the camera: the map of the view's shadow
};

// One picture.
struct View {
    std::string file, caption;
    std::vector<Surface> surfaces;
    std::shared_ptr<const Picture> slide;
    Coordinates coordinates = Coordinates::library;
    Sampling sampling = Sampling::bilinear;
    std::optional<Shadow> shadow{};
    std::optional<Camera> camera{};  // in the place of the scene's
};

// The first view is the one that is timed and checked; further ones show it next to what it would be otherwise.
struct Scene {
    std::string name, title;
    Camera camera;
    Shading shading;
    glm::vec4 light;  // the projector's position (w = 1), or the direction to it (w = 0)
    texgen::TextureRegion region;
    glm::ivec2 corner{0, 0};  // where the picture begins in its window
    std::vector<View> views;
};

// `mesh` stands where the teapot stands, `dense` where small triangles are shown. The camera has the given aspect.
struct Setting {
    Mesh mesh, dense;
    std::shared_ptr<const Picture> slide;
    LensChoice lens;
    double aspect;
};
std::vector<Scene> make_scenes(const Setting& setting);

}  // namespace report
