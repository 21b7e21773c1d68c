#include <cmath>
#include <cstdio>
#include <texgen/texgen.hpp>

#ifdef __cpp_exceptions
#error "exceptions are on"
#endif
#ifdef __cpp_rtti
#error "RTTI is on"
#endif
#if __has_include(<Eigen/Core>)
#error "Eigen is on the include path"
#endif

// The projector's target is in the middle of the slide.
int main() {
    const texgen::Aim aim{.position = {2, 5, 5}, .target = {-2, -4, 0}, .up = {0, 1, 0}};
    const auto projector = texgen::make_projector(
        texgen::PerspectiveLens{.fovy = texgen::degrees(30), .aspect = 1, .z_near = 0.2, .z_far = 1000}, aim,
        texgen::opengl);
    if (!projector) return 1;
    const glm::vec3 target(aim.target);
    glm::vec2 st;
    texgen::project(texgen::texture_from_world(*projector), texgen::world_space({&target, 1}), {&st, 1});
    std::printf("%.9g %.9g\n", static_cast<double>(st.x), static_cast<double>(st.y));
    return std::fabs(st.x - 0.5f) < 1e-6f && std::fabs(st.y - 0.5f) < 1e-6f ? 0 : 1;
}
