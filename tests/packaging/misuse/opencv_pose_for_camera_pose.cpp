// the view of OpenCV for the camera's pose in the world
#include <texgen/projector.hpp>

using namespace texgen;

auto pose_of(const glm::dmat3& rotation, const glm::dvec3& translation) {
    const std::optional<ProjectorView> view = view_from_opencv(rotation, translation);
#ifndef MISUSE
    const std::optional<Transform<World, ProjectorEye>> pose = inverse_rigid(*view);
#else
    const std::optional<Transform<World, ProjectorEye>> pose = view;
#endif
    return pose;
}
