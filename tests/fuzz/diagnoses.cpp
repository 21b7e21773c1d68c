// The diagnosis over raw bytes: findings stand in order, each once, with their sentences; what is not finite is said,
// and a point that is no number hides nothing of the others; a set-up that the library made has no fault but what is
// true of it; a lens and an aim are said to be refused where no projector is made of them.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "fuzz/input.hpp"
#include "texgen/diagnose.hpp"
#include "texgen/linear.hpp"
#include "texgen/projector.hpp"

namespace {

using fuzz::Input;
using fuzz::must;
using texgen::Defect;
using texgen::Diagnosis;
using texgen::Eye;
using texgen::Object;
using texgen::ProjectionSetup;
using texgen::Projector;
using texgen::Transform;
using texgen::World;

// Sometimes with no bits beyond float's, as users have them.
glm::dmat4 matrix_of(Input& input) {
    switch (input.integer(0, 2)) {
        case 0:
            return input.wide_matrix();
        case 1:
            return glm::dmat4(input.matrix());
        default: {
            glm::dmat4 m(1.0);
            for (int i = 0; i < 3; ++i) m[3][i] = static_cast<double>(input.number());
            m[input.integer(0, 3)][input.integer(0, 3)] = input.wide_number();
            return m;
        }
    }
}

void require_form(const Diagnosis& diagnosis) {
    const Defect* before = nullptr;
    for (const texgen::Finding& finding : diagnosis) {
        must(!before || *before < finding.defect, "findings stand in order, each once");
        before = &finding.defect;
        must(!finding.what().empty() && !finding.remedy().empty(), "every finding has its sentences");
        const bool has_number =
            finding.defect == Defect::precision_lost || finding.defect == Defect::smaller_than_texel;
        must(has_number ? finding.number >= 0.0 : finding.number == 0.0, "a number is one, where there is any");
    }
}

// Whether both have the same findings, not_finite aside.
bool are_alike(const Diagnosis& a, const Diagnosis& b) {
    for (std::size_t i = 0; i < texgen::defect_count; ++i)
        if (const auto defect = static_cast<Defect>(i); defect != Defect::not_finite)
            if (a.contains(defect) != b.contains(defect)) return false;
    return true;
}

// Precondition: there are some.
template <class Space>
texgen::Positions<Space> positions_of(const std::vector<glm::vec3>& points) {
    return {&points[0].x, &points[0].y, &points[0].z, points.size(), sizeof(glm::vec3)};
}

template <class Space>
void diagnose_anything(Input& input) {
    ProjectionSetup<Space> setup;
    bool is_bad = false;
    if (input.coin()) {
        const glm::dmat4 projection = matrix_of(input), view = matrix_of(input);
        setup.projector =
            Projector{texgen::ProjectorProjection(projection), texgen::ProjectorView(view), input.conventions()};
        is_bad = !fuzz::all_finite(projection) || !fuzz::all_finite(view);
    }
    if (input.coin()) {
        const glm::dmat4 pose = matrix_of(input);
        setup.world_from_space.emplace(pose);
        is_bad = is_bad || !fuzz::all_finite(pose);
    }
    if (input.coin()) setup.region = input.region_with_depth();
    if (input.coin()) setup.depth = texgen::DepthMapping::ndc;
    if (input.coin()) setup.conventions = input.conventions();
    if (input.coin()) setup.texels_per_unit = {input.wide_number(), input.wide_number()};
    if (input.coin()) setup.lens.fovy = texgen::degrees(input.wide_number());
    if (input.coin()) setup.lens.aspect = input.wide_number();
    if (input.coin()) setup.lens.z_near = input.wide_number();
    if (input.coin()) setup.lens.z_far = input.wide_number();
    setup.lens.mirrored = input.coin();
    const glm::dmat4 texgen = matrix_of(input);
    if (input.coin()) {
        setup.texgen.emplace(texgen);
        is_bad = is_bad || !fuzz::all_finite(texgen);
    }
    std::vector<glm::vec3> points(input.size(9));
    for (glm::vec3& point : points) {
        point = input.vector3();
        if (!fuzz::all_finite(point)) point = glm::vec3(1.0f);
    }
    if (!points.empty()) setup.points = positions_of<Space>(points);
    const Diagnosis diagnosis = diagnose(setup);
    require_form(diagnosis);
    must(!is_bad || diagnosis.contains(Defect::not_finite), "what is not finite is said");

    std::vector<glm::vec3> with_bad = points;
    const std::size_t place = points.empty() ? 0 : input.size(9) % points.size();
    const float no_number = input.coin() ? std::numeric_limits<float>::quiet_NaN() : -HUGE_VALF;
    with_bad.insert(with_bad.begin() + static_cast<std::ptrdiff_t>(place), {1.0f, no_number, 2.0f});
    setup.points = positions_of<Space>(with_bad);
    const Diagnosis beside = diagnose(setup);
    require_form(beside);
    must(beside.contains(Defect::not_finite), "what is not finite is said");
    must(are_alike(diagnosis, beside), "a point that is no number hides nothing of the others");

    if (setup.projector) require_form(diagnose(*setup.projector));
    const auto planes = texgen::planes(Transform<texgen::Texture, Space>(texgen));
    require_form(texgen::diagnose<Space>(planes, setup));
    require_form(texgen::diagnose<Space>(planes));
}

// In [low, high], on a grid that raw bytes choose.
double ordinary(Input& input, double low, double high) {
    return low + (high - low) * static_cast<double>(input.raw<std::uint16_t>()) / 65535.0;
}
glm::dvec3 ordinary_vector(Input& input, double size) {
    glm::dvec3 v(0.0);
    for (int i = 0; i < 3; ++i) v[i] = ordinary(input, -size, size);
    return v;
}

template <class Space>
void diagnose_what_is_right(Input& input) {
    const texgen::Conventions conventions = input.conventions();
    const double distance = std::ldexp(1.0, input.integer(0, 13));
    const glm::dvec3 position = ordinary_vector(input, distance);
    const texgen::Aim aim{position, position + ordinary_vector(input, 2.0), ordinary_vector(input, 1.0)};
    ProjectionSetup<Space> setup;
    const double z_near = ordinary(input, 0.01, 2.0), z_far = z_near * ordinary(input, 5.0, 10000.0);
    if (input.coin()) {
        const texgen::PerspectiveLens lens{texgen::degrees(ordinary(input, 5.0, 110.0)), ordinary(input, 0.4, 2.5),
                                           z_near, input.coin() ? z_far : HUGE_VAL, input.coin()};
        setup.projector = make_projector(lens, aim, conventions);
        if (input.coin()) setup.lens = {lens.fovy, lens.aspect, lens.z_near, lens.z_far};
    } else {
        const double left = ordinary(input, -1.5, 0.5) * z_near, bottom = ordinary(input, -1.5, 0.5) * z_near;
        const double right = left + ordinary(input, 0.3, 2.0) * z_near,
                     top = bottom + ordinary(input, 0.3, 2.0) * z_near;
        setup.projector =
            input.coin()
                ? make_projector(texgen::FrustumLens{left, right, bottom, top, z_near, z_far}, aim, conventions)
                : make_projector(texgen::OrthographicLens{left, right, bottom, top, z_near, z_far}, aim, conventions);
    }
    if (!setup.projector) return;
    if (input.coin()) setup.region = texgen::rectangle_texture(input.integer(16, 4096), input.integer(16, 4096));
    if (input.coin()) setup.depth = texgen::DepthMapping::ndc;
    if (input.coin()) setup.conventions = conventions;
    glm::dmat4 pose(1.0);
    if (!std::is_same_v<Space, World>) {
        // A rotation about an axis, and a place.
        const auto turned =
            texgen::look_at({position + ordinary_vector(input, 100.0), position, ordinary_vector(input, 1.0)});
        if (!turned) return;
        pose = inverse_rigid(*turned).matrix();
        const double scale = std::is_same_v<Space, Object> ? std::ldexp(1.0, input.integer(-20, 20)) : 1.0;
        for (int i = 0; i < 3; ++i) pose[i] *= scale;
        setup.world_from_space.emplace(pose);
    }
    const Transform<World, Space> world_from_space(pose);
    if (input.coin()) setup.region = setup.region.with_depth(setup.projector->conventions, setup.depth);
    const auto texgen = texgen::detail::texture_from_projector_eye(*setup.projector, setup.region, setup.depth) *
                        (setup.projector->view * world_from_space);
    if (input.coin()) setup.texgen = input.coin() ? texgen : Transform<texgen::Texture, Space>(texgen.rounded());
    std::vector<glm::vec3> points(input.size(6));
    for (glm::vec3& point : points) point = glm::vec3(position + ordinary_vector(input, 2.0 * distance));
    if (!points.empty()) setup.points = positions_of<Space>(points);
    const Diagnosis diagnosis = diagnose(setup);
    require_form(diagnosis);
    for (const texgen::Finding& finding : diagnosis)
        must(finding.defect == Defect::everything_behind || finding.defect == Defect::region_never_hit ||
                 finding.defect == Defect::everything_below_depth || finding.defect == Defect::everything_above_depth ||
                 finding.defect == Defect::smaller_than_texel || finding.defect == Defect::precision_lost,
             "what the library made has no fault but what is true of it");
    must(diagnose(*setup.projector).empty(), "a projector that the library made has no fault");
}

template <class Lens>
void diagnose_lens(const Lens& lens, const texgen::Aim& aim, texgen::Conventions conventions) {
    const Diagnosis diagnosis = diagnose(lens, aim, conventions);
    require_form(diagnosis);
    must(diagnosis.empty() == make_projector(lens, aim, conventions).has_value(),
         "what is refused is said, and no more");
}

void diagnose_lenses(Input& input) {
    const texgen::Aim aim{input.wide_vector3(), input.wide_vector3(), input.wide_vector3()};
    const texgen::Conventions conventions = input.conventions();
    double n[9];
    for (double& number : n) number = input.coin() ? input.wide_number() : 0.25 * input.integer(-4, 12);
    diagnose_lens(texgen::PerspectiveLens{input.coin() ? texgen::degrees(n[0]) : texgen::radians(n[0]), n[1], n[2],
                                          n[3], input.coin()},
                  aim, conventions);
    diagnose_lens(texgen::FrustumLens{n[0], n[1], n[2], n[3], n[4], n[5]}, aim, conventions);
    diagnose_lens(texgen::OrthographicLens{n[0], n[1], n[2], n[3], n[4], n[5]}, aim, conventions);
    diagnose_lens(texgen::PinholeLens{n[0], n[1], n[2], n[3], n[4], n[5], n[6], n[7],
                                      input.coin() ? texgen::PixelCentre::half : texgen::PixelCentre::integer, n[8]},
                  aim, conventions);
}

template <class Space>
void diagnose_in(Input& input) {
    if (input.coin())
        diagnose_anything<Space>(input);
    else
        diagnose_what_is_right<Space>(input);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Input input(data, size);
    switch (input.integer(0, 3)) {
        case 0:
            diagnose_in<Object>(input);
            break;
        case 1:
            diagnose_in<World>(input);
            break;
        case 2:
            diagnose_in<Eye>(input);
            break;
        default:
            diagnose_lenses(input);
            break;
    }
    return 0;
}
