// Results of everything public that must not depend on how the user configured GLM, nor on what else is in the program,
// in hexadecimal, one a line.

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <span>
#include <vector>

#include <texgen/batch.hpp>
#include <texgen/diagnose.hpp>
#include <texgen/scene.hpp>
#include <texgen/texgen.hpp>

#if __has_include(<Eigen/Core>)
#include <texgen/eigen.hpp>
#include <texgen/reference.hpp>
#endif

namespace {

void print(const char* what, double value) { std::printf("%s %a\n", what, value); }

template <glm::length_t N, class T, glm::qualifier Q>
void print(const char* what, const glm::vec<N, T, Q>& v) {
    for (glm::length_t i = 0; i < N; ++i) print(what, static_cast<double>(v[i]));
}

template <class To, class From>
void print(const char* what, const texgen::Transform<To, From>& transform) {
    for (glm::length_t column = 0; column < 4; ++column) {
        print(what, transform.matrix()[column]);
        print(what, transform.rounded()[column]);
    }
}

// One projector with all that is made from it.
void print_projector(const texgen::Projector& projector) {
    using namespace texgen;
    print("P_p", projector.projection);
    print("V_p", projector.view);
    print("P_p V_p", projector.matrix());
    print("S", scale_bias(projector.conventions));
    const glm::vec4 clip(0.25f, -0.5f, 0.75f, 2.0f);
    print("remapped", to_texture(clip, projector.conventions));
    const ViewMatrix view(look_at(Aim{.position = {1, 2, 30}, .target = {0, 1, 0}, .up = {0.5, 1, 0}})->matrix());
    const PerspectiveLens wide{degrees(40), 16.0 / 9.0, 0.1, 100.0};
    print("contained", contain(wide, 2.5).fovy.in_radians());
    print("covered", cover(wide, 2.5).min());
    print("mirrored", *mirrored(projector.view, {0.25, 1.0, -0.5, 3.0}));
    print("carried", eye_linear(projector.projection, Transform<ProjectorEye, Eye>(view.matrix()), opengl));
    const CameraPose pose = inverse_rigid(view);
    print("V_e^-1", pose);
    print("inverse", *inverse(view));
    print("K", *pinhole({500.0, 510.0, 319.5, 239.5, 640.0, 480.0, 0.1, 10.0, PixelCentre::integer, 0.25}, opengl));
    print("[R|t]", *view_from_opencv(glm::dmat3(view.matrix()), glm::dvec3(0.5, 1.0, 2.0)));
    print("of row vectors", from_row_vectors<Eye, World>(view.rounded_for_row_vectors()));
    print("T_e", eye_linear(projector, pose));
    glm::dmat4 model(1.0);
    model[0] = glm::dvec4(0.0, 2.0, 0.0, 0.0);
    model[1] = glm::dvec4(-2.0, 0.0, 0.0, 0.0);
    model[3] = glm::dvec4(0.1, 0.2, 0.3, 1.0);
    const ObjectTexgen texgen = object_linear(projector, ModelMatrix(model));
    print("T_o", texgen);
    const Projector camera{projector.projection, ProjectorView(view.matrix()), projector.conventions};
    const WindowTexgen of_window = *window_linear(projector, camera, {0, 0, 64, 64});
    print("T_w", of_window);
    print("a depth's error", depth_error_bound(of_window, {20.5f, 30.5f, 0.5f}, DepthBuffer::unorm24));
    for (const glm::vec4& plane : planes(texgen)) print("plane", plane);
    for (const glm::vec4& plane : clip_planes(texgen, whole_texture())) print("clip plane", plane);

    std::array<glm::vec3, 37> points;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto k = static_cast<float>(i);
        points[i] = glm::vec3(0.37f * k - 5.0f, 0.11f * k - 2.0f, 3.0f - 0.53f * k);
    }
    const auto positions = object_space(points);
    std::array<glm::vec4, points.size()> strq;
    generate(texgen, positions, strq);
    std::array<glm::vec2, points.size()> st;
    project(texgen, positions, st);
    std::array<float, points.size()> s, t, r, lit;
    const TextureRegion volume = whole_texture().with_depth(projector.conventions, DepthMapping::unit);
    print("depth", *volume.depth());
    project(texgen, positions.within({glm::vec3(-20.0f), glm::vec3(20.0f)}), volume, {s, t, r, lit});
    for (std::size_t i = 0; i < points.size(); ++i) {
        print("strq", strq[i]);
        print("st", st[i]);
        if (const auto alone = project(texgen, object_space(points[i]))) print("st", *alone);
        print("s", static_cast<double>(s[i]));
        print("t", static_cast<double>(t[i]));
        print("r", static_cast<double>(r[i]));
        print("lit", static_cast<double>(lit[i]));
        if (const auto divided = divide(strq[i])) print("divided", *divided);
    }

    // Boxes, in whole vectors and a rest.
    std::array<Box, 200> boxes;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        const glm::vec3& point = points[i % points.size()];
        boxes[i] = {point, point + glm::vec3(0.02f * static_cast<float>(i))};
    }
    std::array<Coverage, boxes.size()> covered;
    coverage(texgen, whole_texture(), boxes, covered);
    for (const Coverage answer : covered) print("coverage", static_cast<double>(answer));

    // A polygon that reaches behind the camera.
    const ClipVertex polygon[] = {{glm::vec4(-0.5f, -0.5f, 0.5f, 1.0f), strq[0]},
                                  {glm::vec4(0.5f, -0.25f, 0.25f, 2.0f), strq[9]},
                                  {glm::vec4(0.25f, 0.5f, -3.0f, -1.0f), strq[20]}};
    std::array<ClipVertex, 4> visible;
    const std::size_t count = clip_to_near(polygon, visible, projector.conventions.depth);
    for (std::size_t i = 0; i < count; ++i) {
        print("clipped", visible[i].position);
        print("clipped strq", visible[i].strq);
        print("window", to_window(visible[i], {0, 0, 64, 64}).window);
    }
    if (count < 3) return;
    const Triangle triangle{to_window(visible[0], {0, 0, 64, 64}), to_window(visible[1], {0, 0, 64, 64}),
                            to_window(visible[2], {0, 0, 64, 64})};
    const auto setup = TriangleSetup::of(triangle, whole_texture());
    std::array<float, 60> fragment_s{}, fragment_t{};
    if (setup) interpolate(*setup, {10, 20, 20, 3}, {fragment_s, fragment_t, {}, {}});
    for (const float value : fragment_s) print("fragment s", static_cast<double>(value));
    for (const float value : fragment_t) print("fragment t", static_cast<double>(value));
    if (!setup) return;
    TriangleBatch batch(whole_texture());
    batch.assign({&triangle, 1});
    const FragmentRect rect{10, 20, 20, 3};
    interpolate(batch, std::span(&rect, 1), {fragment_s, fragment_t, {}, {}});
    for (const float value : fragment_s) print("fragment s of a batch", static_cast<double>(value));
    std::array<std::uint32_t, 60> ids{};
    for (std::size_t i = 0; i < ids.size(); i += 3) ids[i] = no_triangle;
    interpolate(batch, ids, rect, {fragment_s, fragment_t, {}, {}});
    for (const float value : fragment_t) print("fragment t by ids", static_cast<double>(value));
    footprint(batch, ids, rect, {256.0, 256.0}, {fragment_s, fragment_t, {}, {}, {}, {}, {}, {}});
    for (const float value : fragment_s) print("ds/dx by ids", static_cast<double>(value));
    const FootprintSetup footprints(*setup, {256.0, 256.0});
    print("footprints within", footprints.error_bound({10, 20, 20, 3}));
    if (const auto extremes = footprints.extremes()) print("largest level", extremes->largest_level);
    batch.assign_facing({&triangle, 1}, TextureOrigin::top_left);
    interpolate(batch, ids, rect, {fragment_s, fragment_t, {}, {}});
    for (const float value : fragment_s) print("fragment s of what faces", static_cast<double>(value));
}

// A scene of boxes and what is wrong with a projector.
void print_scene(const texgen::Projector& projector) {
    using namespace texgen;
    std::vector<ModelMatrix> models;
    std::vector<Box> bounds;
    for (int i = 0; i < 40; ++i) {
        glm::dmat4 model(1.0);
        model[3] = glm::dvec4(0.5 * i - 10.0, 0.25 * i - 8.0, 3.0 - 0.3 * i, 1.0);
        models.emplace_back(model);
        bounds.push_back({glm::vec3(-0.5f), glm::vec3(0.5f)});
    }
    Scene scene;
    scene.update({models, bounds, {&projector, 1}}, {});
    for (const LitPair& pair : scene.pairs()) {
        print("lit", pair.object);
        print("pairs", static_cast<double>(scene.pairs_of(pair.object).size()));
        print("T_o", scene.texgen(pair));
    }
    const ObjectTexgen texgen = object_linear(projector, models[20]);
    const Aim upright{{0.0, 4.0, 0.0}, {0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}};
    for (const Finding& finding : diagnose(PerspectiveLens{degrees(30), 1.0, 0.1, 10.0}, upright, opengl))
        print("finding", static_cast<double>(finding.defect));
    for (const Finding& finding : diagnose(projector)) print("finding", static_cast<double>(finding.defect));
    for (const Finding& finding : diagnose(planes(texgen))) print("finding", static_cast<double>(finding.defect));
    const WorldTexgen transposed(glm::transpose(texture_from_world(projector).matrix()));
    for (const Finding& finding : diagnose(transposed, {.projector = projector}))
        print("finding", static_cast<double>(finding.defect));
    std::array<glm::vec3, 5> points{};
    for (const Finding& finding :
         diagnose(ProjectionSetup<Object>{.projector = projector, .texgen = texgen, .points = object_space(points)}))
        print("finding", static_cast<double>(finding.defect));
#if __has_include(<Eigen/Core>)
    const Eigen::Matrix4d matrix = to_eigen(texgen);
    print("from Eigen", from_eigen<ObjectTexgen>(matrix));
    print("from Eigen", to_eigen(glm::dvec4(texgen.matrix()[2]))(2));
    float s[4];
    reference::interpolate({{{0, 0}, 1, {0, 0, 0, 1}}, {{4, 0}, 2, {1, 0, 0, 2}}, {{0, 4}, 1, {0, 1, 0, 1}}},
                           whole_texture(), {0, 0, 2, 2}, {s, {}, {}, {}});
    for (const float value : s) print("reference", static_cast<double>(value));
#endif
}

void print_surface() {
    using namespace texgen;
    const glm::vec4 a(0.25f, 0.5f, 0.75f, 1.0f), b(1.5f, 0.25f, 0.5f, 2.0f), c(0.1f, 1.3f, 0.7f, 1.7f);
    print("facing", static_cast<double>(facing(a, b, c, TextureOrigin::bottom_left)));
    print("area on the slide", *slide_area(a, b, c));
    print("receiver plane", *receiver_plane(a, b, c));
    const std::array<glm::dvec2, 4> corners{glm::dvec2(0.1, 0.2), glm::dvec2(3.1, -0.3), glm::dvec2(2.5, 2.25),
                                            glm::dvec2(0.3, 1.1)};
    const auto strq = *quadrilateral(corners, rectangle_texture(640, 480));
    for (const glm::vec4& corner : strq) print("corner", corner);
    print("keystone", *keystone(corners));
}

void print_fixed_function() {
    using namespace texgen;
    TexGenUnit unit;
    glm::mat4 modelview(1.0f);
    modelview[0] = glm::vec4(0.6f, 0.8f, 0.0f, 0.0f);
    modelview[1] = glm::vec4(-0.8f, 0.6f, 0.0f, 0.0f);
    modelview[3] = glm::vec4(1.0f, 2.0f, -5.0f, 1.0f);
    for (const TexGenMode mode : {TexGenMode::object_linear, TexGenMode::eye_linear, TexGenMode::sphere_map}) {
        for (const Coordinate coordinate : {Coordinate::s, Coordinate::t}) {
            unit.enable(coordinate);
            if (!unit.set_mode(coordinate, mode)) std::puts("not this mode");
            if (!unit.set_eye_plane(coordinate, glm::vec4(0.5f, 1.0f, -2.0f, 0.25f), modelview)) std::puts("singular");
        }
        const FixedFunctionVertex vertex{glm::vec4(1.0f, 2.0f, 3.0f, 1.0f), glm::vec3(0.0f, 0.6f, 0.8f),
                                         glm::vec4(0.0f, 0.0f, 0.5f, 1.0f)};
        print("unit", unit.generate(vertex, modelview));
        print("eye plane", unit.eye_plane(Coordinate::s));
    }
}

}  // namespace

int main() {
    using namespace texgen;
#if defined(__x86_64__) && defined(__AVX2__)
    if (!__builtin_cpu_supports("avx2")) return 77;
#endif
    const Aim aim{.position = {2, 5, 5}, .target = {-2, -4, 0}, .up = {0, 1, 0}};
    const PerspectiveLens lens{.fovy = degrees(30), .aspect = 1, .z_near = 0.2, .z_far = 1000};
    const FrustumLens off_centre{.left = -1, .right = 2, .bottom = -0.5, .top = 1.5, .z_near = 1, .z_far = 50};
    for (const Conventions& conventions : {opengl, direct3d, vulkan}) {
        print_projector(*make_projector(lens, aim, conventions));
        print_projector(*make_projector(off_centre, aim, conventions));
        print_scene(*make_projector(lens, aim, conventions));
    }
    print_surface();
    print_fixed_function();
    return 0;
}
