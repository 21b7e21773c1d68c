#pragma once

// Workloads of matrices: inverses, texgen matrices and what they are made of.

#include <cmath>
#include <cstddef>
#include <memory>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "support/random.hpp"
#include "support/stopwatch.hpp"
#include "support/workloads/numbers.hpp"
#include "support/workloads/texgens.hpp"
#include "texgen/eigen.hpp"
#include "texgen/linear.hpp"
#include "texgen/projector.hpp"
#include "texgen/scale_bias.hpp"
#include "texgen/scene.hpp"

namespace support::detail {

inline Numbers ordinary_matrix(Random& random) {
    glm::dmat4 m = random.rigid(10.0);
    m[0] *= 1.5;
    return numbers(m, random.rigid(10.0));
}
inline Numbers draw_matrix(Random& random) {
    Numbers n(32);
    const int kind = random.integer(0, 3);
    const double distance = random.power_of_ten(-16.0, 0.0);
    for (double& x : n) {
        x = kind == 0 ? any_float(random) : random.uniform(-1.0, 1.0);
        if (kind == 1) x = random.integer(0, 2) == 0 ? std::ldexp(x, random.integer(-120, 20)) : 0.0;
    }
    if (kind >= 2)
        for (std::size_t k = 0; k < 4; ++k) n[4 * k + 2] = n[4 * k] + distance * n[4 * k + 2];
    return n;
}
inline constexpr Inputs matrix_inputs{0, ordinary_matrix, draw_matrix,
                                      "drawn: almost singular, graded, or any numbers"};
template <class Ask>
Calls matrix_calls(const Numbers& n, Ask ask) {
    Reader reader(n);
    const glm::dmat4 a = reader.dmat4(), b = reader.dmat4();
    return calls_of([a, b, ask] { ask(a, b); });
}
inline Calls inverse_calls(const Numbers& n) {
    return matrix_calls(n, [](const glm::dmat4& m, const glm::dmat4&) { keep(inverse(texgen::ModelMatrix(m))); });
}
inline Calls inverse_bound_calls(const Numbers& n) {
    return matrix_calls(n, [](const glm::dmat4& m, const glm::dmat4& x) {
        keep(inverse_error_bound(texgen::ModelMatrix(m), texgen::Transform<texgen::Object, texgen::World>(x)));
    });
}
inline Calls rigid_calls(const Numbers& n) {
    if (!(texgen::detail::distance_from_rigid(Reader(n).dmat4()) <= 1e-3)) return {};
    return matrix_calls(n, [](const glm::dmat4& m, const glm::dmat4&) { keep(inverse_rigid(texgen::ViewMatrix(m))); });
}
inline Numbers ordinary_rigid(Random& random) { return numbers(random.rigid(10.0), glm::dmat4(1.0)); }
inline Numbers draw_rigid(Random& random) {
    return numbers(random.rigid(random.power_of_ten(-300.0, 300.0)), glm::dmat4(1.0));
}
inline constexpr Inputs rigid_inputs{0, ordinary_rigid, draw_rigid, "drawn: a pose at any distance"};
inline constexpr Inputs affine_inputs{0, ordinary_rigid, draw_matrix, matrix_inputs.words};
inline Calls eye_planes_calls(const Numbers& n) {
    return matrix_calls(n, [](const glm::dmat4& m, const glm::dmat4& planes) {
        keep(eye_planes_as_stored(texgen::WorldTexgen(planes), texgen::ViewMatrix(m)));
    });
}
inline Calls eye_planes_bound_calls(const Numbers& n) {
    return matrix_calls(n, [](const glm::dmat4& m, const glm::dmat4& planes) {
        keep(eye_planes_error_bound(texgen::WorldTexgen(planes), texgen::ViewMatrix(m), texgen::EyeTexgen(planes)));
    });
}
inline Calls rounded_planes_calls(const Numbers& n) {
    return matrix_calls(n, [](const glm::dmat4& m, const glm::dmat4&) { keep(planes(texgen::WorldTexgen(m))); });
}
template <bool OfObject>
Calls composed_calls(const Numbers& n) {
    Random random(5);
    return matrix_calls(n, [projector = ordinary_projector(random)](const glm::dmat4& m, const glm::dmat4& view) {
        const texgen::Projector with_view{projector.projection, texgen::ProjectorView(view), projector.conventions};
        if constexpr (OfObject)
            keep(object_linear(with_view, texgen::ModelMatrix(m)));
        else
            keep(eye_linear(with_view, texgen::CameraPose(m)));
    });
}
inline Calls texture_from_world_calls(const Numbers& n) {
    return matrix_calls(n, [](const glm::dmat4& projection, const glm::dmat4& view) {
        keep(texgen::texture_from_world(
            {texgen::ProjectorProjection(projection), texgen::ProjectorView(view), texgen::opengl}));
    });
}
// A camera's projection and view; the projector is an ordinary one.
inline Numbers ordinary_camera(Random& random) {
    const texgen::Projector camera = ordinary_projector(random);
    return numbers(camera.projection.matrix(), camera.view.matrix());
}
inline Numbers draw_camera(Random& random) {
    return random.coin() ? draw_matrix(random)
                         : numbers(ordinary_projector(random).projection.matrix(),
                                   random.rigid(random.power_of_ten(-10.0, 10.0)));
}
inline constexpr Inputs camera_inputs{0, ordinary_camera, draw_camera,
                                      "drawn: a camera at any distance, or almost singular matrices"};
inline Calls window_linear_calls(const Numbers& n) {
    Random random(5);
    return matrix_calls(n,
                        [projector = ordinary_projector(random)](const glm::dmat4& projection, const glm::dmat4& view) {
                            const texgen::Projector camera{texgen::ProjectorProjection(projection),
                                                           texgen::ProjectorView(view), texgen::opengl};
                            keep(window_linear(projector, camera, {0, 0, 1024, 768}));
                        });
}
inline Calls depth_bound_calls(const Numbers& n) {
    return matrix_calls(n, [](const glm::dmat4& m, const glm::dmat4& numbers) {
        keep(depth_error_bound(texgen::WindowTexgen(m), glm::vec3(numbers[0]), texgen::DepthBuffer::unorm24));
    });
}
inline constexpr Inputs side_inputs{0, ordinary_strq, any_numbers<4>, strq_inputs.words};
inline Calls to_texture_calls(const Numbers& n) {
    return calls_of([strq = Reader(n).vec4()] { keep(texgen::to_texture(strq, texgen::opengl)); });
}
inline Calls scale_bias_calls(const Numbers& n) {
    return calls_of([region = texgen::atlas_tile({n[0], n[1]}, {n[2], n[3]})] {
        keep(region);
        keep(texgen::scale_bias(texgen::opengl, region));
    });
}

inline Calls product_calls(const Numbers& n) {
    return matrix_calls(n, [](const glm::dmat4& view, const glm::dmat4& model) {
        keep(texgen::ViewMatrix(view) * texgen::ModelMatrix(model));
    });
}
inline Calls rounded_calls(const Numbers& n) {
    return matrix_calls(n, [](const glm::dmat4& m, const glm::dmat4&) { keep(texgen::ViewMatrix(m).rounded()); });
}
inline Calls row_vectors_calls(const Numbers& n) {
    return matrix_calls(n, [](const glm::dmat4& m, const glm::dmat4&) {
        keep(texgen::from_row_vectors<texgen::Eye, texgen::World>(m).rounded_for_row_vectors());
    });
}
inline Calls carried_calls(const Numbers& n) {
    return matrix_calls(n, [](const glm::dmat4& projection, const glm::dmat4& view) {
        keep(texgen::eye_linear(texgen::ProjectorProjection(projection),
                                texgen::Transform<texgen::ProjectorEye, texgen::Eye>(view), texgen::opengl));
    });
}
inline Calls to_eigen_calls(const Numbers& n) {
    return matrix_calls(n, [](const glm::dmat4& m, const glm::dmat4&) {
        keep(texgen::to_eigen_affine<Eigen::Affine3d>(texgen::ViewMatrix(m)));
        keep(texgen::to_eigen<Eigen::Matrix4f>(texgen::ViewMatrix(m)));
    });
}
inline Calls from_eigen_calls(const Numbers& n) {
    return calls_of([m = Eigen::Matrix4d(Eigen::Map<const Eigen::Matrix4d>(n.data()))] {
        keep(texgen::from_eigen<texgen::ViewMatrix>(m));
    });
}
// A camera that moves to and fro over 16 projectors.
inline Calls update_eye_calls(const Numbers& n) {
    const auto scene = std::make_shared<texgen::Scene>();
    Random random(4);
    const std::vector<texgen::Projector> projectors(16, ordinary_projector(random));
    scene->update({{}, {}, projectors}, {});
    Reader reader(n);
    const texgen::CameraPose there(reader.dmat4()), back(reader.dmat4());
    return calls_of([scene, there, back, is_back = false]() mutable {
        keep(scene->update_eye(is_back ? back : there));
        is_back = !is_back;
    });
}

}  // namespace support::detail
