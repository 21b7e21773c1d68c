#pragma once

// The engine's arrays of the room: its objects and its projectors.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <texgen/linear.hpp>
#include <texgen/projector.hpp>
#include <texgen/scene.hpp>

#include "../mesh.hpp"

namespace report::lit_room {

inline constexpr int floor_cells = 20, wall_rows = 4;
inline constexpr float cell = 1.5f, half_side = 0.5f * cell * floor_cells;
inline constexpr std::size_t object_count = 2000, projector_count = 64;
inline constexpr std::size_t moved_count = object_count / 100;

inline constexpr texgen::TextureRegion slide_region = texgen::whole_texture();
inline constexpr texgen::TextureRegion volume_region = slide_region.with_depth();
inline constexpr double reach =
    9.0;  // the far plane of the projectors, beyond which they light nothing where their depth counts

inline bool is_across(std::size_t projector) { return projector % 8 == 3; }

// Numbers in [0, 1) that are the same everywhere, if several are drawn in braces: compilers differ in the order of arguments.
class Numbers {
public:
    double operator()() {
        state_ = state_ * 6364136223846793005u + 1442695040888963407u;
        return static_cast<double>(state_ >> 11) * 0x1p-53;
    }
    double operator()(double low, double high) { return low + (high - low) * (*this)(); }

private:
    std::uint64_t state_ = 1;
};

struct Object {
    Mesh mesh;
    glm::vec3 colour;
};

// The engine's arrays.
struct Room {
    std::vector<Object> objects;
    std::vector<texgen::ModelMatrix> models;
    std::vector<texgen::Box> bounds;
    std::vector<texgen::Projector> projectors;
    std::vector<glm::vec3> tints;       // of the projectors
    std::vector<glm::dvec3> positions;  // of the projectors
    std::vector<std::uint32_t> crates;  // the objects that may move
    std::vector<texgen::TextureRegion> regions_in_reach;

    texgen::SceneView view() const { return {models, bounds, projectors}; }
    texgen::SceneView view_in_reach() const { return {models, bounds, projectors, regions_in_reach}; }

    void add(Mesh mesh, const glm::dmat4& model, glm::vec3 colour) {
        texgen::Box box{glm::vec3(HUGE_VALF), glm::vec3(-HUGE_VALF)};
        for (const glm::vec3& position : mesh.positions)
            box = {glm::min(box.min, position), glm::max(box.max, position)};
        objects.push_back({std::move(mesh), colour});
        models.push_back(texgen::ModelMatrix(model));
        bounds.push_back(box);
    }
};

// Down to the floor, or across the room.
texgen::Projector spot(glm::dvec3 position, double turn, bool across);

Room make_objects();

}  // namespace report::lit_room
