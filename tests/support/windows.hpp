#pragma once

// Cameras with a window, projectors beside them, and their exact T_w.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include <glm/common.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "judges/oracle.hpp"
#include "judges/rational_matrix.hpp"
#include "support/random.hpp"
#include "texgen/linear.hpp"
#include "texgen/projector.hpp"

namespace support {

struct WindowScene {
    texgen::Projector projector, camera;
    texgen::Viewport viewport;
    texgen::TextureRegion region;
    texgen::DepthMapping depth;
    texgen::Aim projector_aim, camera_aim;
};

inline texgen::Conventions any_conventions(Random& random) {
    return {random.coin() ? texgen::DepthRange::zero_to_one : texgen::DepthRange::negative_one_to_one,
            random.coin() ? texgen::NdcY::down : texgen::NdcY::up,
            random.coin() ? texgen::TextureOrigin::top_left : texgen::TextureOrigin::bottom_left,
            random.coin() ? texgen::Handedness::right : texgen::Handedness::left};
}

inline std::optional<texgen::Projector> any_projector(Random& random, const texgen::Aim& aim) {
    const texgen::Conventions conventions = any_conventions(random);
    const double z_near = random.power_of_ten(-2.0, 0.0), z_far = z_near * random.power_of_ten(1.0, 6.0);
    switch (random.integer(0, 3)) {
        case 0:
            return make_projector(texgen::OrthographicLens{-2.0, 3.0, -2.5, 2.0, -1.0, 30.0}, aim, conventions);
        case 1:
            return make_projector(texgen::FrustumLens{-z_near, 0.5 * z_near, -0.7 * z_near, z_near, z_near, z_far}, aim,
                                  conventions);
        default:
            return make_projector(
                texgen::PerspectiveLens{texgen::degrees(random.uniform(20.0, 100.0)), random.uniform(0.5, 2.0), z_near,
                                        random.coin() ? HUGE_VAL : z_far, random.coin()},
                aim, conventions);
    }
}

// A camera and a projector that look at one place, `distance` from the origin.
inline WindowScene random_window_scene(Random& random, double distance) {
    const glm::dvec3 place = distance * random.direction();
    const auto aim = [&] {
        const glm::dvec3 position = place + random.uniform(2.0, 8.0) * random.direction();
        return texgen::Aim{position, place + 0.5 * random.direction(), random.direction()};
    };
    const texgen::Aim of_projector = aim(), of_camera = aim();
    const auto projector = any_projector(random, of_projector), camera = any_projector(random, of_camera);
    const int width = random.integer(1, 4096), height = random.integer(1, 4096);
    const texgen::Viewport viewport{random.integer(-50, 500), random.integer(-50, 500), random.coin() ? width : -width,
                                    random.coin() ? height : -height};
    return {projector.value(),
            camera.value(),
            viewport,
            random.coin() ? texgen::whole_texture() : texgen::atlas_tile({0.125, 0.3}, {2.5, 0.7}),
            random.coin() ? texgen::DepthMapping::unit : texgen::DepthMapping::ndc,
            of_projector,
            of_camera};
}

// W, from its definition.
inline glm::dmat4 window_from_ndc(const texgen::Viewport& viewport, texgen::Conventions conventions) {
    const bool halves = conventions.depth == texgen::DepthRange::negative_one_to_one;
    glm::dmat4 w(1.0);
    w[0][0] = 0.5 * viewport.width;
    w[1][1] = 0.5 * viewport.height;
    w[2][2] = halves ? 0.5 : 1.0;
    w[3] = glm::dvec4(viewport.x + 0.5 * viewport.width, viewport.y + 0.5 * viewport.height, halves ? 0.5 : 0.0, 1.0);
    return w;
}

using RationalVector = std::array<Rational, 4>;

inline RationalVector at(const RationalMatrix& m, const glm::dvec3& v) {
    RationalVector result;
    for (std::size_t row = 0; row < 4; ++row)
        result[row] = m[row][0] * exactly(v.x) + m[row][1] * exactly(v.y) + m[row][2] * exactly(v.z) + m[row][3];
    return result;
}

// S P_p V_p (W P_c V_c)^-1 of the numbers that were given, and the product of its factors' magnitudes.
class ExactWindow {
public:
    explicit ExactWindow(const WindowScene& scene) {
        const std::array factors{exactly(scale_bias(scene.projector.conventions, scene.region, scene.depth).matrix()),
                                 exactly(scene.projector.projection.matrix()),
                                 exactly(scene.projector.view.matrix()),
                                 inverse(exactly(scene.camera.view.matrix())).value(),
                                 inverse(exactly(scene.camera.projection.matrix())).value(),
                                 inverse(exactly(window_from_ndc(scene.viewport, scene.camera.conventions))).value()};
        product_ = factors[0];
        terms_ = magnitudes(factors[0]);
        for (std::size_t i = 1; i < factors.size(); ++i) {
            product_ = product_ * factors[i];
            terms_ = terms_ * magnitudes(factors[i]);
        }
    }

    // The largest error of s/q, t/q and r/q, over (m_s + |s/q| m_q) / |q|; 0 where q is.
    double share_of_terms(const texgen::WindowTexgen& computed, const glm::dvec3& fragment) const {
        const RationalVector exact = at(product_, fragment), got = at(exactly(computed.matrix()), fragment);
        const RationalVector terms = at(terms_, glm::abs(fragment));
        if (exact[3] == 0 || got[3] == 0) return 0.0;
        double worst = 0.0;
        for (std::size_t c = 0; c < 3; ++c) {
            const Rational u = exact[c] / exact[3];
            const Rational bound = (terms[c] + magnitude(u) * terms[3]) / magnitude(exact[3]);
            worst = std::max(worst, nearest<double>(Rational(magnitude(got[c] / got[3] - u) / bound)));
        }
        return worst;
    }

private:
    RationalMatrix product_, terms_;
};

inline glm::dvec3 random_fragment(Random& random, const texgen::Viewport& viewport) {
    const double depth = std::array{random.uniform(0.0, 1.0), 1.0 - random.power_of_ten(-7.0, -1.0),
                                    random.power_of_ten(-7.0, -1.0)}[random.bits() % 3];
    const glm::dvec3 fragment(viewport.x + viewport.width * random.uniform(0.0, 1.0),
                              viewport.y + viewport.height * random.uniform(0.0, 1.0), depth);
    return {to_float(fragment.x), to_float(fragment.y), to_float(fragment.z)};
}

}  // namespace support
