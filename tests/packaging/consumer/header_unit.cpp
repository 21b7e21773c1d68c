import <texgen/linear.hpp>;

// The projector's target is in the middle of the slide.
int main() {
    const texgen::Aim aim{.position = {2, 5, 5}, .target = {-2, -4, 0}, .up = {0, 1, 0}};
    const auto projector = texgen::make_projector(
        texgen::PerspectiveLens{.fovy = texgen::degrees(30), .aspect = 1, .z_near = 0.2, .z_far = 1000}, aim,
        texgen::opengl);
    if (!projector) return 1;
    const glm::dvec4 strq = texgen::texture_from_world(*projector).matrix() * glm::dvec4(-2, -4, 0, 1);
    const double s = strq.x / strq.w;
    return s > 0.499999 && s < 0.500001 ? 0 : 1;
}
