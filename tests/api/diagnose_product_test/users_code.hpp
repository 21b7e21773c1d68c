#pragma once

// The code of users who mean something and make a mistake, or none, and what the diagnosis is told of it.

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <optional>
#include <string>
#include <type_traits>

#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "support/hex.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"
#include "support/windows.hpp"
#include "texgen/diagnose.hpp"
#include "texgen/projector.hpp"

namespace product_cases {

using support::any_conventions;
using support::hex;
using support::infinity_double;
using support::Random;
using texgen::Conventions;
using texgen::Defect;
using texgen::DepthMapping;
using texgen::DepthRange;
using texgen::Diagnosis;
using texgen::NdcY;
using texgen::Object;
using texgen::Projector;
using texgen::TextureOrigin;

enum class LensKind { perspective, infinite, frustum, orthographic };

// What a user means to set up.
struct Meant {
    Conventions conventions = texgen::opengl;
    LensKind kind = LensKind::perspective;
    double fovy = 30.0, aspect = 1.0, z_near = 0.1, z_far = 100.0;  // in degrees
    double left = -1.0, right = 1.0, bottom = -1.0, top = 1.0;
    texgen::Aim aim{{0.0, 0.0, 0.0}, {0.0, 0.0, -1.0}, {0.0, 1.0, 0.0}};
    glm::dmat4 pose{1.0};  // the model, or the camera's pose
    texgen::TextureRegion region = texgen::whole_texture();
    DepthMapping depth = DepthMapping::unit;

    bool is_left() const { return conventions.handedness == texgen::Handedness::left; }
    bool is_zero_to_one() const { return conventions.depth == DepthRange::zero_to_one; }
};

// The user's own code, with GLM, in float or in double.
template <class T>
struct Code {
    using Matrix = glm::mat<4, 4, T>;
    using Vector = glm::vec<3, T>;

    static Matrix lens(const Meant& m, T fovy, bool zero_to_one) {
        const T a = static_cast<T>(m.aspect), n = static_cast<T>(m.z_near), f = static_cast<T>(m.z_far);
        const T l = static_cast<T>(m.left), r = static_cast<T>(m.right), b = static_cast<T>(m.bottom),
                t = static_cast<T>(m.top);
        Matrix p(T(1));
        if (m.kind == LensKind::perspective && m.is_left())
            p = zero_to_one ? glm::perspectiveLH_ZO(fovy, a, n, f) : glm::perspectiveLH_NO(fovy, a, n, f);
        if (m.kind == LensKind::perspective && !m.is_left())
            p = zero_to_one ? glm::perspectiveRH_ZO(fovy, a, n, f) : glm::perspectiveRH_NO(fovy, a, n, f);
        if (m.kind == LensKind::infinite) {
            // GLM 1.0.1 declares those of a hand and does not define them; this one is right-handed.
            p = glm::infinitePerspective(fovy, a, n);
            if (m.is_left()) p[2] = -p[2];
            p[2][2] = p[2][3];
            p[3][2] = zero_to_one ? -n : T(-2) * n;
        }
        if (m.kind == LensKind::frustum)
            p = zero_to_one ? glm::frustumRH_ZO(l, r, b, t, n, f) : glm::frustumRH_NO(l, r, b, t, n, f);
        // GLM's left-handed frusta have the off-axis terms of right-handed ones.
        if (m.kind == LensKind::frustum && m.is_left()) p[2] = -p[2];
        if (m.kind == LensKind::orthographic && m.is_left())
            p = zero_to_one ? glm::orthoLH_ZO(l, r, b, t, n, f) : glm::orthoLH_NO(l, r, b, t, n, f);
        if (m.kind == LensKind::orthographic && !m.is_left())
            p = zero_to_one ? glm::orthoRH_ZO(l, r, b, t, n, f) : glm::orthoRH_NO(l, r, b, t, n, f);
        if (m.conventions.ndc_y == NdcY::down)
            for (int i = 0; i < 4; ++i) p[i][1] = -p[i][1];
        return p;
    }
    static Matrix lens(const Meant& m) { return lens(m, glm::radians(static_cast<T>(m.fovy)), m.is_zero_to_one()); }

    static Matrix view(const Meant& m) {
        const Vector eye(m.aim.position), target(m.aim.target), up(m.aim.up);
        return m.is_left() ? glm::lookAtLH(eye, target, up) : glm::lookAtRH(eye, target, up);
    }

    // With r halved or not.
    static Matrix bias(const Meant& m, bool halves_depth) {
        const glm::dvec2 size = m.region.max() - m.region.min();
        const T s = static_cast<T>(m.region.min().x), t = static_cast<T>(m.region.min().y), w = static_cast<T>(size.x),
                h = static_cast<T>(size.y);
        const bool follows = (m.conventions.ndc_y == NdcY::up) == (m.conventions.origin == TextureOrigin::bottom_left);
        Matrix b(T(1));
        b[0][0] = w / 2;
        b[1][1] = follows ? h / 2 : -h / 2;
        b[3][0] = s + w / 2;
        b[3][1] = t + h / 2;
        if (halves_depth) b[2][2] = b[3][2] = T(1) / 2;
        return b;
    }
    static Matrix bias(const Meant& m) { return bias(m, m.depth == DepthMapping::unit && !m.is_zero_to_one()); }

    static Matrix pose(const Meant& m) { return Matrix(m.pose); }
};

enum class Mistake {
    none,
    radians,
    lens_of_other_range,
    bias_of_other_range,
    bias_without_w,
    no_bias,
    pose_for_view,
    lens_of_other_hand,
    inverted_aspect
};

// Of factors in one number, and composed in that or in another.
template <class T, class Composed = T>
glm::dmat4 made(const Meant& m, Mistake mistake, Random& random) {
    using My = Code<T>;
    using Matrix = glm::mat<4, 4, Composed>;
    const Matrix s(My::bias(m)), p(My::lens(m)), v(My::view(m)), x(My::pose(m));
    const bool from_left = random.coin();
    const auto product = [&](const Matrix& a, const Matrix& b, const Matrix& c, const Matrix& d) {
        return glm::dmat4(from_left ? a * b * c * d : a * (b * (c * d)));
    };
    switch (mistake) {
        case Mistake::radians:
            return product(s, Matrix(My::lens(m, static_cast<T>(m.fovy), m.is_zero_to_one())), v, x);
        case Mistake::lens_of_other_range:
            return product(s, Matrix(My::lens(m, glm::radians(static_cast<T>(m.fovy)), !m.is_zero_to_one())), v, x);
        case Mistake::bias_of_other_range:
            return product(Matrix(My::bias(m, s[2][2] == Composed(1))), p, v, x);
        case Mistake::no_bias:
            return glm::dmat4(p * v * x);
        case Mistake::pose_for_view:
            return product(s, p, Matrix(glm::inverse(My::view(m))), x);
        case Mistake::lens_of_other_hand: {
            Matrix other = p;
            other[2] = -other[2];
            return product(s, other, v, x);
        }
        case Mistake::inverted_aspect: {
            Meant other = m;
            other.aspect = 1.0 / m.aspect;
            return product(s, Matrix(My::lens(other)), v, x);
        }
        case Mistake::bias_without_w: {
            Matrix clip = from_left ? p * v * x : p * (v * x);
            const int way = random.integer(0, 3);
            if (way == 3) return glm::dmat4(clip * Composed(0.5) + Composed(0.5));
            for (int i = 0; i < 4; ++i) {
                const int rows = way == 0 ? 2 : way == 1 ? 3 : 4;
                for (int row = 0; row < rows; ++row)
                    clip[i][row] = clip[i][row] * Composed(0.5) + (i == 3 ? Composed(0.5) : Composed(0));
            }
            return glm::dmat4(clip);
        }
        default:
            return product(s, p, v, x);
    }
}

inline Meant any_meant(Mistake mistake, Random& random) {
    Meant m;
    m.conventions = any_conventions(random);
    const bool is_symmetric = mistake == Mistake::radians || mistake == Mistake::inverted_aspect;
    m.kind = is_symmetric ? static_cast<LensKind>(random.integer(0, 1)) : static_cast<LensKind>(random.integer(0, 3));
    // Where w is 1 it is not missed, and rays that are parallel have no side to look to.
    if ((mistake == Mistake::bias_without_w || mistake == Mistake::lens_of_other_hand) &&
        m.kind == LensKind::orthographic)
        m.kind = LensKind::frustum;
    m.fovy = random.integer(0, 2) == 0 ? 5.0 * random.integer(1, 34) : random.uniform(0.5, 170.0);
    m.aspect = random.integer(0, 2) == 0 ? 4.0 / 3.0 : random.uniform(0.3, 3.0);
    m.z_near = random.integer(0, 2) == 0 ? 0.1 : random.power_of_ten(-2.0, 1.0);
    m.z_far = m.z_near * random.power_of_ten(0.7, 4.0);
    const double height = random.uniform(0.3, 2.0) * m.z_near, width = height * m.aspect;
    m.left = random.uniform(-1.5, 0.5) * width;
    m.right = m.left + width;
    m.bottom = random.uniform(-1.5, 0.5) * height;
    m.top = m.bottom + height;
    if (m.kind == LensKind::orthographic) {
        const double size = random.power_of_ten(0.0, 3.0);
        m.left *= size, m.right *= size, m.bottom *= size, m.top *= size;
    }
    const double distance = random.power_of_ten(0.0, 5.0);
    m.aim.position = distance * random.direction();
    m.aim.target = m.aim.position + (1.0 + distance * random.uniform(0.1, 1.0)) * random.direction();
    // Beside the view, or a lookAt() in float turns the picture by more than rounding.
    const glm::dvec3 forward = glm::normalize(m.aim.target - m.aim.position);
    do m.aim.up = random.coin() ? glm::dvec3(0.0, 1.0, 0.0) : random.direction();
    while (std::fabs(glm::dot(m.aim.up, forward)) > 0.99);
    if (random.integer(0, 3) != 0) {
        m.pose = random.rotation();
        const double scale = random.power_of_ten(-1.0, 1.0);
        for (int i = 0; i < 3; ++i) m.pose[i] *= scale * (random.coin() ? 1.0 : random.uniform(0.5, 2.0));
        m.pose[3] = glm::dvec4(m.aim.position + distance * random.uniform(0.0, 1.0) * random.direction(), 1.0);
    }
    m.depth = random.integer(0, 3) == 0 ? DepthMapping::ndc : DepthMapping::unit;
    const int region = random.integer(0, 5);
    if (mistake != Mistake::bias_without_w && region == 0) m.region = texgen::rectangle_texture(640, 480);
    if (mistake != Mistake::bias_without_w && region == 1) m.region = texgen::atlas_tile({0.25, 0.5}, {0.5, 0.75});
    return m;
}

inline std::optional<Projector> right_projector(const Meant& m) {
    if (m.kind == LensKind::frustum)
        return make_projector(texgen::FrustumLens{m.left, m.right, m.bottom, m.top, m.z_near, m.z_far}, m.aim,
                              m.conventions);
    if (m.kind == LensKind::orthographic)
        return make_projector(texgen::OrthographicLens{m.left, m.right, m.bottom, m.top, m.z_near, m.z_far}, m.aim,
                              m.conventions);
    return make_projector(texgen::PerspectiveLens{texgen::degrees(m.fovy), m.aspect, m.z_near,
                                                  m.kind == LensKind::infinite ? infinity_double : m.z_far},
                          m.aim, m.conventions);
}

inline Projector own_projector(const Meant& m) {
    return {texgen::ProjectorProjection(Code<float>::lens(m)), texgen::ProjectorView(Code<float>::view(m)),
            m.conventions};
}

inline std::string text(const Meant& m, const glm::dmat4& texgen, const Diagnosis& diagnosis) {
    std::string result = "found:";
    for (const texgen::Finding& finding : diagnosis) result += " [" + std::string(finding.what()) + "]";
    return result + " of lens " + std::to_string(static_cast<int>(m.kind)) + " fovy " + hex(m.fovy) + " aspect " +
           hex(m.aspect) + " near " + hex(m.z_near) + " far " + hex(m.z_far) + " position " + hex(m.aim.position) +
           " of " + support::text(m.conventions) + " mapping " + std::to_string(static_cast<int>(m.depth)) + " pose " +
           hex(m.pose) + " texgen " + hex(texgen);
}

// Numbers that people write, near the origin.
inline Meant human(Mistake mistake, Random& random) {
    constexpr std::array aspects{1.0, 4.0 / 3.0, 16.0 / 9.0, 1.5};
    constexpr std::array nears{0.1, 0.2, 0.5, 1.0};
    constexpr std::array fars{20.0, 50.0, 100.0, 200.0, 500.0, 1000.0};
    Meant m = any_meant(mistake, random);
    m.kind = LensKind::perspective;
    m.fovy = 5.0 * random.integer(4, 24);
    m.aspect = aspects[static_cast<std::size_t>(random.integer(0, 3))];
    m.z_near = nears[static_cast<std::size_t>(random.integer(0, 3))];
    m.z_far = fars[static_cast<std::size_t>(random.integer(0, 5))];
    m.aim.position = random.uniform(2.0, 20.0) * random.direction();
    m.aim.target = random.uniform(0.0, 1.0) * random.direction();
    m.aim.up = {0.0, 1.0, 0.0};
    const glm::dvec3 forward = glm::normalize(m.aim.target - m.aim.position);
    if (std::fabs(forward.y) > 0.99) return human(mistake, random);
    m.pose = glm::dmat4(1.0);
    m.pose[3] = glm::dvec4(random.uniform(0.0, 2.0) * random.direction(), 1.0);
    return m;
}

// What the diagnosis is told beside the matrix.
enum class Told { projector, lens, nothing };

inline constexpr std::array mistakes{
    Mistake::radians, Mistake::lens_of_other_range, Mistake::bias_of_other_range, Mistake::bias_without_w,
    Mistake::no_bias, Mistake::pose_for_view,       Mistake::inverted_aspect,     Mistake::lens_of_other_hand};

constexpr Defect defect_of(Mistake mistake) {
    switch (mistake) {
        case Mistake::radians:
            return Defect::angle_unit_mistaken;
        case Mistake::lens_of_other_range:
        case Mistake::bias_of_other_range:
            return Defect::depth_range_mismatch;
        case Mistake::bias_without_w:
            return Defect::bias_without_w;
        case Mistake::no_bias:
            return Defect::scale_bias_missing;
        case Mistake::lens_of_other_hand:
            return Defect::mixed_handedness;
        case Mistake::inverted_aspect:
            return Defect::aspect_inverted;
        default:
            return Defect::view_not_inverted;
    }
}

inline double distance_of(const Meant& m) {
    const glm::dvec3& p = m.aim.position;
    return std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
}

inline bool is_of_range(Mistake mistake) {
    return mistake == Mistake::lens_of_other_range || mistake == Mistake::bias_of_other_range;
}

// Whether floats have kept what the mistake changes: of depths whose far plane is infinitely far that is a distance,
// near beside far away; of a lens as wide as half the world its angle.
inline bool leaves_a_trace(const Meant& m, Mistake mistake, Told told) {
    if (is_of_range(mistake) && m.kind == LensKind::infinite)
        return m.z_near > (told == Told::projector ? 1e-5 : 1e-3) * distance_of(m);
    if (mistake == Mistake::inverted_aspect) return std::fabs(m.aspect - 1.0) > 0.01;
    return mistake != Mistake::radians || std::fabs(std::tan(0.5 * m.fovy)) < 20.0;
}

// In the object's space, or in the world's or the eye's, where the pose says so.
enum class In { object, world, eye };

template <class Space>
Diagnosis diagnosis_in(const Meant& m, const std::optional<Projector>& projector, Told told, bool has_conventions,
                       const glm::dmat4& texgen) {
    texgen::ProjectionSetup<Space> setup{.region = m.region, .depth = m.depth};
    if (told == Told::projector) setup.projector = projector;
    if (told != Told::nothing && !std::is_same_v<Space, texgen::World>) setup.world_from_space.emplace(m.pose);
    if (has_conventions) setup.conventions = m.conventions;
    if (told == Told::lens) {
        if (m.kind <= LensKind::infinite) setup.lens = {texgen::degrees(m.fovy), m.aspect};
        setup.lens.z_near = m.z_near;
        setup.lens.z_far = m.kind == LensKind::infinite ? infinity_double : m.z_far;
    }
    return diagnose(texgen::Transform<texgen::Texture, Space>(texgen), setup);
}

inline Diagnosis diagnosis_of(const Meant& m, In in, const std::optional<Projector>& projector, Told told,
                              bool has_conventions, const glm::dmat4& texgen) {
    if (in == In::object) return diagnosis_in<Object>(m, projector, told, has_conventions, texgen);
    if (in == In::world) return diagnosis_in<texgen::World>(m, projector, told, has_conventions, texgen);
    return diagnosis_in<texgen::Eye>(m, projector, told, has_conventions, texgen);
}

inline In put_in_space(Meant& m, Random& random) {
    const In in = static_cast<In>(random.integer(0, 2));
    if (in == In::world) m.pose = glm::dmat4(1.0);
    if (in == In::eye) {
        const glm::dvec4 place = m.pose[3];
        m.pose = random.rotation();
        m.pose[3] = place;
    }
    return in;
}

inline glm::dmat4 made_somehow(const Meant& m, Mistake mistake, Random& random) {
    switch (random.integer(0, 3)) {
        case 0:
            return made<double>(m, mistake, random);
        case 1:
            return glm::dmat4(support::rounded(made<double>(m, mistake, random)));
        case 2:
            return made<float, double>(m, mistake, random);
        default:
            return made<float>(m, mistake, random);
    }
}

// Set-ups that are as they should be; as many as TEXGEN_VALID_SETUPS says.
inline int valid_setups() {
    const char* number = std::getenv("TEXGEN_VALID_SETUPS");
    return number != nullptr ? std::atoi(number) : 200000;
}

inline void require_valid(const Meant& m, const glm::dmat4& texgen, const Diagnosis& diagnosis) {
    for (const texgen::Finding& finding : diagnosis)
        if (finding.defect != Defect::precision_lost) FAIL(text(m, texgen, diagnosis));
}

}  // namespace product_cases
