// The diagnosis of products that users make by hand: the mistakes of the papers' readers are named first, whatever the API,
// the lens, the place and the precision, and what is right is not found fault with.

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>

#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>

#include "support/hex.hpp"
#include "support/random.hpp"
#include "texgen/diagnose.hpp"
#include "texgen/linear.hpp"
#include "texgen/projector.hpp"

namespace {

using support::hex;
using support::Random;
using texgen::Conventions;
using texgen::Defect;
using texgen::DepthMapping;
using texgen::DepthRange;
using texgen::Diagnosis;
using texgen::Handedness;
using texgen::NdcY;
using texgen::Object;
using texgen::Projector;
using texgen::TextureOrigin;
using texgen::TextureRegion;

constexpr double infinity = std::numeric_limits<double>::infinity();

enum class LensKind { perspective, infinite, frustum, orthographic };

// What a user means to set up.
struct Meant {
    Conventions conventions = texgen::opengl;
    LensKind kind = LensKind::perspective;
    double fovy = 30.0, aspect = 1.0, z_near = 0.1, z_far = 100.0;  // in degrees
    double left = -1.0, right = 1.0, bottom = -1.0, top = 1.0;
    texgen::Aim aim{{0.0, 0.0, 0.0}, {0.0, 0.0, -1.0}, {0.0, 1.0, 0.0}};
    glm::dmat4 pose{1.0};  // the model, or the camera's pose
    TextureRegion region = texgen::whole_texture();
    DepthMapping depth = DepthMapping::unit;

    bool is_left() const { return conventions.handedness == Handedness::left; }
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
            p = m.is_left() ? glm::infinitePerspectiveLH(fovy, a, n) : glm::infinitePerspectiveRH(fovy, a, n);
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

// What a user makes of it; and the rest of what the diagnosis is told.
struct Made {
    glm::dmat4 texgen{1.0};
    bool is_told = true;  // false: the mistake left no trace, as in a lens that has none
};

enum class Mistake {
    none,
    radians,
    lens_of_other_range,
    bias_of_other_range,
    bias_without_w,
    no_bias,
    pose_for_view,
    row_count
};

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
        default:
            return Defect::view_not_inverted;
    }
}

template <class T>
glm::dmat4 made(const Meant& m, Mistake mistake, Random& random) {
    using My = Code<T>;
    using Matrix = typename My::Matrix;
    const Matrix s = My::bias(m), p = My::lens(m), v = My::view(m), x = My::pose(m);
    const bool from_left = random.coin();
    const auto product = [&](const Matrix& a, const Matrix& b, const Matrix& c, const Matrix& d) {
        return glm::dmat4(from_left ? a * b * c * d : a * (b * (c * d)));
    };
    switch (mistake) {
        case Mistake::radians:
            return product(s, My::lens(m, static_cast<T>(m.fovy), m.is_zero_to_one()), v, x);
        case Mistake::lens_of_other_range:
            return product(s, My::lens(m, glm::radians(static_cast<T>(m.fovy)), !m.is_zero_to_one()), v, x);
        case Mistake::bias_of_other_range:
            return product(My::bias(m, s[2][2] == T(1)), p, v, x);
        case Mistake::no_bias:
            return glm::dmat4(p * v * x);
        case Mistake::pose_for_view:
            return product(s, p, glm::inverse(v), x);
        case Mistake::bias_without_w: {
            Matrix clip = from_left ? p * v * x : p * (v * x);
            const int way = random.integer(0, 3);
            if (way == 3) return glm::dmat4(clip * T(0.5) + T(0.5));
            for (int i = 0; i < 4; ++i) {
                const int rows = way == 0 ? 2 : way == 1 ? 3 : 4;
                for (int row = 0; row < rows; ++row) clip[i][row] = clip[i][row] * T(0.5) + (i == 3 ? T(0.5) : T(0));
            }
            return glm::dmat4(clip);
        }
        default:
            return product(s, p, v, x);
    }
}

Conventions any_conventions(Random& random) {
    return {random.coin() ? DepthRange::negative_one_to_one : DepthRange::zero_to_one,
            random.coin() ? NdcY::up : NdcY::down, random.coin() ? TextureOrigin::bottom_left : TextureOrigin::top_left,
            random.coin() ? Handedness::right : Handedness::left};
}

Meant any_meant(Mistake mistake, Random& random) {
    Meant m;
    m.conventions = any_conventions(random);
    m.kind = mistake == Mistake::radians ? static_cast<LensKind>(random.integer(0, 1))
                                         : static_cast<LensKind>(random.integer(0, 3));
    // Where w is 1 it is not missed.
    if (mistake == Mistake::bias_without_w && m.kind == LensKind::orthographic) m.kind = LensKind::frustum;
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
    m.aim.up = random.coin() ? glm::dvec3(0.0, 1.0, 0.0) : random.direction();
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

std::optional<Projector> right_projector(const Meant& m) {
    if (m.kind == LensKind::frustum)
        return make_projector(texgen::FrustumLens{m.left, m.right, m.bottom, m.top, m.z_near, m.z_far}, m.aim,
                              m.conventions);
    if (m.kind == LensKind::orthographic)
        return make_projector(texgen::OrthographicLens{m.left, m.right, m.bottom, m.top, m.z_near, m.z_far}, m.aim,
                              m.conventions);
    return make_projector(texgen::PerspectiveLens{texgen::degrees(m.fovy), m.aspect, m.z_near,
                                                  m.kind == LensKind::infinite ? infinity : m.z_far},
                          m.aim, m.conventions);
}

Projector own_projector(const Meant& m) {
    return {texgen::ProjectorProjection(Code<float>::lens(m)), texgen::ProjectorView(Code<float>::view(m)),
            m.conventions};
}

std::string text(const Meant& m, const glm::dmat4& texgen, const Diagnosis& diagnosis) {
    std::string result = "found:";
    for (const texgen::Finding& finding : diagnosis) result += " [" + std::string(finding.what()) + "]";
    const Conventions& c = m.conventions;
    return result + " of lens " + std::to_string(static_cast<int>(m.kind)) + " fovy " + hex(m.fovy) + " aspect " +
           hex(m.aspect) + " near " + hex(m.z_near) + " far " + hex(m.z_far) + " position " + hex(m.aim.position) +
           " conventions " + std::to_string(static_cast<int>(c.depth.operator DepthRange())) +
           std::to_string(static_cast<int>(c.ndc_y.operator NdcY())) +
           std::to_string(static_cast<int>(c.origin.operator TextureOrigin())) +
           std::to_string(static_cast<int>(c.handedness.operator Handedness())) + " mapping " +
           std::to_string(static_cast<int>(m.depth)) + " pose " + hex(m.pose) + " texgen " + hex(texgen);
}

}  // namespace

TEST_CASE("explore") {
    for (const Mistake mistake : {Mistake::radians, Mistake::lens_of_other_range, Mistake::bias_of_other_range,
                                  Mistake::bias_without_w, Mistake::no_bias, Mistake::pose_for_view}) {
        Random random(620);
        int named = 0, in_float_named = 0, floats = 0, shown = 0;
        constexpr int n = 4000;
        for (int i = 0; i < n; ++i) {
            const Meant m = any_meant(mistake, random);
            const bool in_float = random.coin();
            const glm::dmat4 texgen = in_float ? made<float>(m, mistake, random) : made<double>(m, mistake, random);
            const auto projector = right_projector(m);
            if (!projector) continue;
            texgen::ProjectionSetup<Object> setup{.projector = random.coin() ? *projector : own_projector(m),
                                                  .world_from_space = texgen::ModelMatrix(m.pose),
                                                  .region = m.region,
                                                  .depth = m.depth};
            const Diagnosis d = diagnose(texgen::ObjectTexgen(texgen), setup);
            const bool ok = !d.empty() && d[0].defect == defect_of(mistake);
            floats += in_float;
            named += ok;
            in_float_named += in_float && ok;
            if (!ok && shown++ < 3) MESSAGE(in_float, " ", text(m, texgen, d));
        }
        MESSAGE(static_cast<int>(mistake), ": ", named, " of ", n, ", in float ", in_float_named, " of ", floats);
    }
    Random random(621);
    int wrong = 0;
    for (int i = 0; i < 100000; ++i) {
        const Meant m = any_meant(Mistake::none, random);
        const bool in_float = random.coin();
        const glm::dmat4 texgen =
            in_float ? made<float>(m, Mistake::none, random) : made<double>(m, Mistake::none, random);
        const auto projector = right_projector(m);
        if (!projector) continue;
        texgen::ProjectionSetup<Object> setup{.projector = random.coin() ? *projector : own_projector(m),
                                              .world_from_space = texgen::ModelMatrix(m.pose),
                                              .region = m.region,
                                              .depth = m.depth};
        const Diagnosis d = diagnose(texgen::ObjectTexgen(texgen), setup);
        if (!d.empty() && d[0].defect != Defect::precision_lost && wrong++ < 4)
            MESSAGE(in_float, " ", text(m, texgen, d));
    }
    MESSAGE(wrong, " wrong");
}
