// The diagnosis of products that users make by hand: the mistakes of the papers' readers are named first, whatever the
// API, the lens, the place and the precision, and what is right is not found fault with.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>

#include "support/hex.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"
#include "support/windows.hpp"
#include "texgen/diagnose.hpp"
#include "texgen/linear.hpp"
#include "texgen/projector.hpp"
#include "texgen/surface.hpp"

namespace {

using support::any_conventions;
using support::hex;
using support::infinity_double;
using support::nan_double;
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
        case Mistake::lens_of_other_hand: {
            Matrix other = p;
            other[2] = -other[2];
            return product(s, other, v, x);
        }
        case Mistake::inverted_aspect: {
            Meant other = m;
            other.aspect = 1.0 / m.aspect;
            return product(s, My::lens(other), v, x);
        }
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

Meant any_meant(Mistake mistake, Random& random) {
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

std::optional<Projector> right_projector(const Meant& m) {
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

// Numbers that people write, near the origin.
Meant human(Mistake mistake, Random& random) {
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

Diagnosis diagnosis_of(const Meant& m, In in, const std::optional<Projector>& projector, Told told,
                       bool has_conventions, const glm::dmat4& texgen) {
    if (in == In::object) return diagnosis_in<Object>(m, projector, told, has_conventions, texgen);
    if (in == In::world) return diagnosis_in<texgen::World>(m, projector, told, has_conventions, texgen);
    return diagnosis_in<texgen::Eye>(m, projector, told, has_conventions, texgen);
}

double distance_of(const Meant& m) {
    const glm::dvec3& p = m.aim.position;
    return std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
}

bool is_of_range(Mistake mistake) {
    return mistake == Mistake::lens_of_other_range || mistake == Mistake::bias_of_other_range;
}

// Whether floats have kept what the mistake changes: of depths whose far plane is infinitely far that is a distance,
// near beside far away; of a lens as wide as half the world its angle.
bool leaves_a_trace(const Meant& m, Mistake mistake, Told told) {
    if (is_of_range(mistake) && m.kind == LensKind::infinite)
        return m.z_near > (told == Told::projector ? 1e-5 : 1e-3) * distance_of(m);
    if (mistake == Mistake::inverted_aspect) return std::fabs(m.aspect - 1.0) > 0.01;
    return mistake != Mistake::radians || std::fabs(std::tan(0.5 * m.fovy)) < 20.0;
}

// Without its projector a matrix shows no lens of parallel light, and of frusta no angle.
bool is_shown(const Meant& m, Mistake mistake) {
    return is_of_range(mistake) ? m.kind != LensKind::orthographic : m.kind <= LensKind::infinite;
}

In put_in_space(Meant& m, Random& random) {
    const In in = static_cast<In>(random.integer(0, 2));
    if (in == In::world) m.pose = glm::dmat4(1.0);
    if (in == In::eye) {
        const glm::dvec4 place = m.pose[3];
        m.pose = random.rotation();
        m.pose[3] = place;
    }
    return in;
}

glm::dmat4 made_somehow(const Meant& m, Mistake mistake, Random& random) {
    switch (random.integer(0, 2)) {
        case 0:
            return made<double>(m, mistake, random);
        case 1:
            return glm::dmat4(support::rounded(made<double>(m, mistake, random)));
        default:
            return made<float>(m, mistake, random);
    }
}

constexpr std::array mistakes{
    Mistake::radians, Mistake::lens_of_other_range, Mistake::bias_of_other_range, Mistake::bias_without_w,
    Mistake::no_bias, Mistake::pose_for_view,       Mistake::inverted_aspect,     Mistake::lens_of_other_hand};

// Of the rest nothing is seen without the projector: a pose is the view of another, and a lens that looks back a turned
// one.
bool needs_projector(Mistake mistake) {
    return mistake == Mistake::pose_for_view || mistake == Mistake::lens_of_other_hand;
}

}  // namespace

TEST_CASE("what users' own code gets wrong is named first, with the projector that was meant beside it") {
    for (const Mistake mistake : mistakes) {
        Random random(620);
        for (int i = 0; i < 1000;) {
            Meant m = any_meant(mistake, random);
            const In in = put_in_space(m, random);
            const std::optional<Projector> projector = right_projector(m);
            if (!projector || !leaves_a_trace(m, mistake, Told::projector)) continue;
            const glm::dmat4 texgen = made_somehow(m, mistake, random);
            const Diagnosis diagnosis = diagnosis_of(m, in, random.coin() ? *projector : own_projector(m),
                                                     Told::projector, random.coin(), texgen);
            REQUIRE_MESSAGE(!diagnosis.empty(), text(m, texgen, diagnosis));
            REQUIRE_MESSAGE(diagnosis[0].defect == defect_of(mistake), text(m, texgen, diagnosis));
            ++i;
        }
    }
}

TEST_CASE("what users' own code gets wrong is named first, with what is known of the lens beside it") {
    for (const Mistake mistake : mistakes) {
        if (needs_projector(mistake)) continue;
        Random random(621);
        for (int i = 0; i < 1000;) {
            Meant m = any_meant(mistake, random);
            const In in = put_in_space(m, random);
            if (!is_shown(m, mistake) || !leaves_a_trace(m, mistake, Told::lens)) continue;
            const glm::dmat4 texgen = made_somehow(m, mistake, random);
            const bool has_conventions = m.depth == DepthMapping::ndc || random.coin();
            const Diagnosis diagnosis = diagnosis_of(m, in, std::nullopt, Told::lens, has_conventions, texgen);
            REQUIRE_MESSAGE(!diagnosis.empty(), text(m, texgen, diagnosis));
            REQUIRE_MESSAGE(diagnosis[0].defect == defect_of(mistake), text(m, texgen, diagnosis));
            ++i;
        }
    }
}

TEST_CASE("what users' own code gets wrong is named first, with the projector but without the pose") {
    for (const Mistake mistake : mistakes) {
        if (needs_projector(mistake)) continue;
        Random random(629);
        for (int i = 0; i < 300;) {
            Meant m = any_meant(mistake, random);
            m.pose = random.rotation();  // a scale that is not the same in all directions hides the lens
            m.pose[3] = glm::dvec4(m.aim.position, 1.0);
            // Without its unit a matrix has no distance: only the far plane's, over near, is in it.
            const bool is_in_units =
                !is_of_range(mistake) || (m.kind != LensKind::infinite && m.z_far < 1e3 * m.z_near);
            const std::optional<Projector> projector = right_projector(m);
            if (!projector || !is_shown(m, mistake) || !is_in_units || !leaves_a_trace(m, mistake, Told::lens))
                continue;
            const glm::dmat4 texgen = made_somehow(m, mistake, random);
            const Diagnosis diagnosis = diagnose(
                texgen::ObjectTexgen(texgen),
                {.projector = random.coin() ? *projector : own_projector(m), .region = m.region, .depth = m.depth});
            REQUIRE_MESSAGE(!diagnosis.empty(), text(m, texgen, diagnosis));
            REQUIRE_MESSAGE(diagnosis[0].defect == defect_of(mistake), text(m, texgen, diagnosis));
            ++i;
        }
    }
}

TEST_CASE("of a matrix alone the numbers that people write name what is wrong with them") {
    for (const Mistake mistake : mistakes) {
        if (needs_projector(mistake) || mistake == Mistake::inverted_aspect) continue;
        Random random(622);
        int found = 0;
        for (int i = 0; i < 1000; ++i) {
            Meant m = human(mistake, random);
            m.depth = DepthMapping::unit;
            if (!leaves_a_trace(m, mistake, Told::nothing)) m.fovy = 30.0;
            if (mistake == Mistake::no_bias || mistake == Mistake::bias_without_w) m.fovy = random.integer(20, 120);
            // Where r lacks no bias that is round, that is the quarter of a lens as well.
            if (m.fovy == 90.0 && (m.is_zero_to_one() || mistake == Mistake::bias_without_w)) m.fovy = 91.0;
            // Where far is much farther, near is round in float with a bias of r and without one.
            if (!is_of_range(mistake)) m.z_far = std::min(m.z_far, 200.0 * m.z_near);
            const In in = random.coin() ? In::object : In::world;
            if (in == In::world) m.pose = glm::dmat4(1.0);
            // Floats keep few digits of the near plane, and an angle only where the picture stands on its head as well.
            const bool keeps_float = mistake == Mistake::radians ? std::tan(0.5 * m.fovy) < 0.0 : !is_of_range(mistake);
            const glm::dmat4 texgen = keeps_float ? made_somehow(m, mistake, random) : made<double>(m, mistake, random);
            const Diagnosis diagnosis = diagnosis_of(m, in, std::nullopt, Told::nothing, true, texgen);
            found += !diagnosis.empty() && diagnosis[0].defect == defect_of(mistake);
        }
        CHECK_MESSAGE(found >= (is_of_range(mistake) ? 950 : 1000), found, " of ", static_cast<int>(mistake));
    }
}

namespace {

// Set-ups that are as they should be; as many as TEXGEN_VALID_SETUPS says.
int valid_setups() {
    const char* number = std::getenv("TEXGEN_VALID_SETUPS");
    return number != nullptr ? std::atoi(number) : 200000;
}

void require_valid(const Meant& m, const glm::dmat4& texgen, const Diagnosis& diagnosis) {
    for (const texgen::Finding& finding : diagnosis)
        if (finding.defect != Defect::precision_lost) FAIL(text(m, texgen, diagnosis));
}

}  // namespace

TEST_CASE("a lens of the other range is a lens from another distance, and named by the one that was meant") {
    Meant m, other;
    m.aim = {{1.0, 5.0, 2.0}, {0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}};
    other.z_near = 10.0 / 199.9;
    const glm::dmat4 bias = Code<double>::bias(m), view = Code<double>::view(m);
    const double fovy = glm::radians(m.fovy);
    const glm::dmat4 mistaken = bias * Code<double>::lens(m, fovy, true) * view;
    const glm::dmat4 right = bias * Code<double>::lens(other, fovy, false) * view;
    for (int i = 0; i < 4; ++i)
        for (int row = 0; row < 4; ++row) CHECK(std::fabs(mistaken[i][row] - right[i][row]) < 1e-14);
    for (const glm::dmat4& texgen : {mistaken, glm::dmat4(support::rounded(mistaken))}) {
        const Diagnosis diagnosis = diagnosis_of(m, In::world, std::nullopt, Told::lens, false, texgen);
        REQUIRE(diagnosis.size() == 1);
        CHECK(diagnosis[0].defect == Defect::depth_range_mismatch);
        CHECK(diagnosis_of(other, In::world, std::nullopt, Told::lens, false, texgen).empty());
    }
}

TEST_CASE("the quarters of a lens of 90 degrees are not found fault with, whose sides are as long as near is far") {
    Random random(641);
    for (int i = 0; i < 4096; ++i) {
        const auto bit = [&](int k) { return (i >> k) % 2 != 0; };
        Meant m;
        m.kind = LensKind::frustum;
        m.aim = {{2.0 + random.integer(0, 9), 5.0, 5.0}, {-2.0, -4.0, 0.0}, {0.0, 1.0, 0.0}};
        m.conventions = any_conventions(random);
        m.depth = bit(0) ? DepthMapping::unit : DepthMapping::ndc;
        m.z_near = bit(1) ? 0.125 : 0.02 * random.integer(1, 30);
        m.z_far = (bit(2) ? 1e4 : 40.0) * m.z_near;
        const double height = m.z_near * (bit(3) ? 1.0 : 2.0), width = height * (bit(4) ? 1.0 : 1.5);
        m.left = bit(5) ? 0.0 : -width, m.bottom = bit(6) ? 0.0 : -height;
        m.right = m.left + width, m.top = m.bottom + height;
        const texgen::WorldTexgen texgen = texture_from_world(*right_projector(m), m.region, m.depth);
        const texgen::Projector p = *right_projector(m);
        const glm::mat4 in_float =
            scale_bias(m.conventions, m.region, m.depth).rounded() * p.projection.rounded() * p.view.rounded();
        const glm::dmat4 given = bit(7)   ? texgen.matrix()
                                 : bit(9) ? glm::dmat4(texgen.rounded())
                                          : glm::dmat4(in_float);
        for (const Told told : {Told::nothing, Told::projector}) {
            const bool has_conventions = bit(8);
            require_valid(m, given, diagnosis_of(m, In::world, right_projector(m), told, has_conventions, given));
        }
    }
}

TEST_CASE("the sides of an object that is stretched by an unknown pose are not taken for those of the lens") {
    Random random(642);
    for (int i = 0; i < 2000; ++i) {
        Meant m = human(Mistake::none, random);
        m.aspect = random.coin() ? 1.5 : 2.0;
        m.depth = DepthMapping::unit;
        const int axis = random.integer(0, 2);  // level, along an axis of the world
        m.aim.target = m.aim.position;
        m.aim.target[axis == 1 ? 0 : axis] += random.coin() ? 5.0 : -5.0;
        m.pose[1] *= random.coin() ? 1.0 / (m.aspect * m.aspect) : m.aspect * m.aspect;
        const std::optional<Projector> projector = right_projector(m);
        const glm::dmat4 texgen = object_linear(*projector, texgen::ModelMatrix(m.pose), m.region, m.depth).matrix();
        require_valid(
            m, texgen,
            diagnose(texgen::ObjectTexgen(texgen), {.projector = projector, .region = m.region, .depth = m.depth}));
    }
}

TEST_CASE("through a pose far away a lens shows no more than the rounding of the matrix leaves of it there") {
    Random random(645);
    for (int i = 0; i < 20000; ++i) {
        const auto place = [&](double reach) {
            const double x = random.uniform(-reach, reach), y = random.uniform(-reach, reach);
            return glm::dvec3(x, y, random.uniform(-reach, reach));
        };
        Meant m;
        m.conventions = texgen::direct3d;
        m.depth = DepthMapping::unit;
        m.aim = {place(20.0), {3.0, 5.5, 1.25}, {0.0, 1.0, 0.0}};
        m.pose = glm::dmat4(glm::dvec4(0.0, 1.0, 0.0, 0.0), glm::dvec4(-1.0, 0.0, 0.0, 0.0),
                            glm::dvec4(0.0, 0.0, 1.0, 0.0), glm::dvec4(place(1e7), 1.0));
        m.z_near = i % 2 == 0 ? 10.0 : 0.05;
        m.z_far = i % 2 == 0 ? 30.0 : 5000.0;
        const texgen::ObjectTexgen texgen = object_linear(*right_projector(m), texgen::ModelMatrix(m.pose));
        // The numbers that people write are looked for in double, the planes that are known in float as well.
        const bool in_float = i % 2 != 0;
        const texgen::ObjectTexgen given = in_float ? texgen::ObjectTexgen(texgen.rounded()) : texgen;
        texgen::ProjectionSetup<Object> setup{.world_from_space = texgen::ModelMatrix(m.pose),
                                              .conventions = m.conventions};
        if (in_float) setup.lens.z_near = m.z_near;
        require_valid(m, given.matrix(), diagnose(given, setup));
    }
}

TEST_CASE("factors that commute are not taken for a wrong order, where floats fit it no worse") {
    Random random(643);
    for (int i = 0; i < 20000; ++i) {
        Meant m = human(Mistake::none, random);
        m.depth = DepthMapping::unit;
        m.aim.position = {0.0, 0.0, 0.0};
        if (random.coin()) m.aim.target = {0.0, 0.0, m.is_left() ? 5.0 : -5.0};
        m.pose = glm::dmat4(1.0);
        for (int k = 0; k < 3; ++k) m.pose[k] *= 74.6;
        const std::optional<Projector> projector = right_projector(m);
        const glm::dmat4 texgen = made<float>(m, Mistake::none, random);
        require_valid(m, texgen, diagnosis_of(m, In::object, projector, Told::projector, false, texgen));
    }
}

TEST_CASE("planes that are no round numbers only in the units of an object are not found fault with") {
    Meant m;
    m.aim = {{1.0, 5.0, 2.0}, {0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}};
    for (const DepthRange range : {DepthRange::negative_one_to_one, DepthRange::zero_to_one}) {
        m.conventions.depth = range;
        for (int scale = 1; scale < 10; ++scale) {
            for (int i = 0; i < 3; ++i) m.pose[i][i] = scale;
            for (int ratio = 2; ratio < 100; ++ratio) {
                for (int first = 1; first < 10; ++first) {
                    m.z_near = 0.1 * first;
                    m.z_far = ratio * m.z_near;
                    const glm::dmat4 clip = Code<double>::lens(m) * Code<double>::view(m);
                    const glm::dmat4 texgen = Code<double>::bias(m) * clip * m.pose;
                    require_valid(m, texgen, diagnosis_of(m, In::object, std::nullopt, Told::nothing, true, texgen));
                }
            }
        }
    }
}

TEST_CASE("degrees as radians are named where the picture is level over y and over z, and up is along one of them") {
    Meant m;
    m.aspect = 4.0 / 3.0;
    for (const glm::dvec3& up : {glm::dvec3(0.0, 1.0, 0.0), glm::dvec3(0.0, 0.0, 1.0)}) {
        for (const glm::dvec3& position :
             {glm::dvec3(0.0, 5.0, 5.0), glm::dvec3(0.0, -5.0, 5.0), glm::dvec3(0.0, 5.0, -5.0),
              glm::dvec3(0.0, -5.0, -5.0), glm::dvec3(0.0, 2.0, 9.0), glm::dvec3(5.0, 0.0, 0.0)}) {
            m.aim = {position, {0.0, 0.0, 0.0}, up};
            for (const double number : {30.0, 45.0, 60.0, 75.0, 90.0}) {
                const auto diagnosis_of_angle = [&](double fovy, bool has_conventions) {
                    const glm::dmat4 clip = Code<double>::lens(m, fovy, false) * Code<double>::view(m);
                    return diagnosis_of(m, In::world, std::nullopt, Told::nothing, has_conventions,
                                        Code<double>::bias(m) * clip);
                };
                for (const bool has_conventions : {false, true}) {
                    CAPTURE(number);
                    CHECK(diagnosis_of_angle(glm::radians(number), has_conventions).empty());
                    const Diagnosis diagnosis = diagnosis_of_angle(number, has_conventions);
                    REQUIRE(!diagnosis.empty());
                    CHECK(diagnosis[0].defect == Defect::angle_unit_mistaken);
                }
            }
        }
    }
}

TEST_CASE("what users' own code gets right is not found fault with, whatever else is told") {
    Random random(623);
    const int count = valid_setups();
    for (int i = 0; i < count; ++i) {
        // All numbers as people write them, or some, or none.
        Meant m = random.coin() ? human(Mistake::none, random) : any_meant(Mistake::none, random);
        if (random.coin()) m.fovy = random.uniform(0.5, 170.0);
        if (random.coin()) m.z_near = random.power_of_ten(-2.0, 0.0);
        m.z_far = std::max(m.z_far, 3.0 * m.z_near);
        const bool is_quarter = random.integer(0, 7) == 0;
        if (is_quarter) {
            // Of a lens, of numbers that are as round as its corner; without its depth range it is that of a whole one.
            m = human(Mistake::none, random);
            m.conventions.depth = DepthRange::negative_one_to_one;
            m.depth = DepthMapping::unit;
            m.kind = LensKind::frustum;
            m.z_far = m.z_near * random.integer(2, 50);  // in float the planes do not say it where far is farther
            m.left = m.bottom = 0.0;
            m.right = m.z_near * std::ldexp(1.0, random.integer(-2, 1));
            m.top = m.z_near * std::ldexp(1.0, random.integer(-2, 1));
        }
        const In in = put_in_space(m, random);
        const std::optional<Projector> projector = right_projector(m);
        if (!projector) continue;
        const glm::dmat4 texgen = made_somehow(m, Mistake::none, random);
        const Told told = static_cast<Told>(random.integer(0, 2));
        require_valid(m, texgen,
                      diagnosis_of(m, in, random.coin() ? *projector : own_projector(m), told,
                                   is_quarter || random.coin(), texgen));
    }
}

TEST_CASE(
    "an angle that degrees make as radians is one where the picture stands upright, or floats leave it in doubt") {
    Random random(630);
    for (int i = 0; i < 1000; ++i) {
        Meant m = human(Mistake::none, random);
        const double number = random.coin() ? 30.0 : 60.0;
        m.fovy = glm::degrees(2.0 * std::atan(std::fabs(std::tan(0.5 * number))));
        const In in = random.coin() ? In::object : In::world;
        if (in == In::world) m.pose = glm::dmat4(1.0);
        const glm::dmat4 upright = made<double>(m, Mistake::none, random);
        require_valid(m, upright, diagnosis_of(m, in, std::nullopt, Told::nothing, true, upright));
        // Which way t grows is not told: it may hang down as a picture whose origin is at its top.
        const glm::dmat4 in_float = made<float>(m, Mistake::none, random);
        require_valid(m, in_float, diagnosis_of(m, in, std::nullopt, Told::nothing, false, in_float));
        m.aim.up = random.direction();
        const glm::dmat4 askew = made<float>(m, Mistake::none, random);
        require_valid(m, askew, diagnosis_of(m, in, std::nullopt, Told::nothing, true, askew));
    }
}

TEST_CASE("cameras, narrowed lenses, cropped pictures, mirrors and flashlights are not found fault with") {
    Random random(624);
    const int count = valid_setups() / 4;
    for (int i = 0; i < count; ++i) {
        Meant m = any_meant(Mistake::none, random);
        const int kind = random.integer(0, 4);
        std::optional<Projector> projector;
        texgen::LensFacts facts;
        if (kind == 0) {
            const double width = random.integer(320, 4000), height = random.integer(240, 3000);
            const double focal = width * random.uniform(0.3, 4.0);
            projector = make_projector(
                texgen::PinholeLens{focal, focal * random.uniform(0.9, 1.1), width * random.uniform(0.4, 0.6),
                                    height * random.uniform(0.4, 0.6), width, height, m.z_near,
                                    random.coin() ? infinity_double : m.z_far,
                                    random.coin() ? texgen::PixelCentre::half : texgen::PixelCentre::integer,
                                    random.coin() ? 0.0 : focal * random.uniform(-0.01, 0.01)},
                m.aim, m.conventions);
        } else {
            texgen::PerspectiveLens lens{texgen::degrees(m.fovy), m.aspect, m.z_near, m.z_far, random.coin()};
            if (kind == 1) lens = contain(lens, random.uniform(0.3, 3.0));
            if (kind == 2) m.region = cover(lens, random.uniform(0.3, 3.0), m.region);
            projector = make_projector(lens, m.aim, m.conventions);
            if (random.coin()) facts = {lens.fovy, lens.aspect, lens.z_near, lens.z_far};
        }
        if (!projector) continue;
        if (kind == 3) {
            const glm::dvec3 n = random.direction();
            projector->view = *mirrored(projector->view, {n.x, n.y, n.z, random.uniform(-5.0, 5.0)});
            facts.mirrored = true;
        }
        if (random.coin()) m.region = m.region.with_depth(m.conventions, m.depth);
        // A flashlight is told without its projector, and so is in its camera's space.
        const bool is_flashlight = kind == 4;
        const glm::dmat4 product =
            is_flashlight ? eye_linear(projector->projection,
                                       texgen::Transform<texgen::ProjectorEye, texgen::Eye>(projector->view.matrix()),
                                       m.conventions, m.region, m.depth)
                                .matrix()
                          : object_linear(*projector, texgen::ModelMatrix(m.pose), m.region, m.depth).matrix();
        const glm::dmat4 texgen = random.coin() ? product : glm::dmat4(support::rounded(product));
        if (is_flashlight) {
            require_valid(
                m, texgen,
                diagnose(texgen::EyeTexgen(texgen),
                         {.region = m.region, .depth = m.depth, .conventions = m.conventions, .lens = facts}));
            continue;
        }
        texgen::ProjectionSetup<Object> setup{.region = m.region, .depth = m.depth, .lens = facts};
        if (random.coin()) setup.projector = projector;
        if (random.coin()) setup.world_from_space = texgen::ModelMatrix(m.pose);
        if (random.coin()) setup.conventions = m.conventions;
        require_valid(m, texgen, diagnose(texgen::ObjectTexgen(texgen), setup));
    }
}

TEST_CASE("the fragments of a camera's window are not found fault with, nor what fills a quadrilateral of it") {
    Random random(644);
    for (int i = 0; i < 2000; ++i) {
        const Meant m = any_meant(Mistake::none, random), of_camera = any_meant(Mistake::none, random);
        const std::optional<Projector> projector = right_projector(m), camera = right_projector(of_camera);
        if (!projector || !camera) continue;
        const auto texgen = window_linear(*projector, *camera, {0, 0, 640, 480}, m.region, m.depth);
        if (!texgen) continue;
        const bool has_projector = random.coin(), is_rounded = random.coin();
        const texgen::WindowTexgen given = is_rounded ? texgen::WindowTexgen(texgen->rounded()) : *texgen;
        texgen::ProjectionSetup<texgen::Window> setup{.region = m.region, .depth = m.depth};
        if (has_projector) setup.projector = projector;
        const Diagnosis diagnosis = diagnose(given, setup);
        if (!is_rounded) require_valid(m, given.matrix(), diagnosis);
        for (const texgen::Finding& finding : diagnosis)
            REQUIRE_MESSAGE((finding.defect == Defect::precision_lost || finding.defect == Defect::rank_below_three),
                            text(m, given.matrix(), diagnosis));
    }
    const auto keystone = texgen::keystone({glm::dvec2(0, 0), {640, 20}, {600, 440}, {30, 480}});
    REQUIRE(keystone);
    CHECK(diagnose(*keystone).empty());
}

TEST_CASE("models of any size, and lenses whose planes are next to one another, are not found fault with") {
    Random random(3711);
    const auto named = [](const auto& setup) {
        const Diagnosis diagnosis = diagnose(setup);
        return std::any_of(diagnosis.begin(), diagnosis.end(),
                           [](const auto& finding) { return finding.defect != Defect::precision_lost; });
    };
    const Projector projector =
        make_projector(texgen::PerspectiveLens{texgen::degrees(40.0), 1.3, 0.1, 100.0},
                       texgen::Aim{{1.0, 2.0, 3.0}, {0.0, 0.3, 0.1}, {0.0, 1.0, 0.0}}, texgen::opengl)
            .value();
    for (int exponent = -1000; exponent <= 1000; ++exponent) {
        const double size = std::ldexp(random.uniform(0.5, 1.0), exponent);
        glm::dmat4 matrix = glm::rotate(glm::translate(glm::dmat4(1.0), 0.5 * random.direction()),
                                        random.uniform(0.0, 6.0), random.direction()) *
                            glm::scale(glm::dmat4(1.0), glm::dvec3(size));
        const texgen::ModelMatrix model(matrix);
        texgen::ProjectionSetup<Object> setup{
            .projector = projector, .world_from_space = model, .texgen = object_linear(projector, model)};
        INFO(exponent, ": ", hex(matrix));
        REQUIRE(!named(setup));
        if (exponent < -148 || exponent > 126) continue;
        setup.texgen = texgen::ObjectTexgen(setup.texgen->rounded());
        REQUIRE(!named(setup));
    }
    // In float, and in double. Depth is a difference of large numbers there: two that once fell on the other low end.
    const auto check = [&](const texgen::PerspectiveLens& lens, const texgen::Aim& aim, Conventions conventions,
                           bool is_float) {
        std::optional<Projector> of_lens = make_projector(lens, aim, conventions);
        if (!of_lens) return;
        if (is_float) {
            of_lens->projection = texgen::ProjectorProjection(of_lens->projection.rounded());
            of_lens->view = texgen::ProjectorView(of_lens->view.rounded());
        }
        texgen::ProjectionSetup<texgen::World> setup{.projector = of_lens,
                                                     .lens = {.z_near = lens.z_near, .z_far = lens.z_far}};
        INFO(hex(lens.z_near), " to ", hex(lens.z_far), is_float ? " in float" : "");
        REQUIRE(!named(setup));
        setup.texgen = texture_from_world(*of_lens);
        REQUIRE(!named(setup));
    };
    for (const auto& [fovy, z_near, z_far] :
         {std::array{35.0, 0x1.999999999999ap+2, 0x1.99999e6b26844p+2}, {43.0, 0x1.cp+1, 0x1.c00005a70aa6ep+1}})
        for (const Conventions& api : {texgen::opengl, texgen::direct3d})
            for (const Conventions& conventions : {api, left_handed(api)})
                for (const bool is_reversed : {false, true})
                    check({texgen::degrees(fovy), 1.3, z_near, z_far, is_reversed},
                          {{1.0, 2.0, 3.0}, {0.0, 0.3, 0.1}, {0.0, 1.0, 0.0}}, conventions, true);
    for (int i = 0; i < 20000; ++i) {
        const double z_near = random.uniform(0.1, 10.0);
        const bool is_float = random.coin();
        const double gap = random.power_of_ten(is_float ? -7.0 : -15.0, -1.0);
        check({texgen::degrees(random.uniform(20.0, 100.0)), 1.3, z_near, z_near * (1.0 + gap), random.coin()},
              {random.direction(), 9.0 * random.direction(), random.direction()}, any_conventions(random), is_float);
    }
}

TEST_CASE("angles in whole radians, and tiny ones, are not taken for degrees") {
    Random random(3712);
    int lenses = 0;
    for (int i = 0; i < 2000; ++i) {
        const bool is_whole = i % 2 == 0;
        const texgen::Angle fovy =
            texgen::radians(is_whole ? random.integer(1, 12) / 4.0 : random.power_of_ten(-9.0, -2.0));
        const texgen::Aim aim{9.0 * random.direction(), 9.0 * random.direction(), random.direction()};
        const std::optional<Projector> projector =
            make_projector(texgen::PerspectiveLens{fovy, 1.5, 0.1, 100.0}, aim, any_conventions(random));
        if (!projector) continue;
        ++lenses;
        const auto takes_for_degrees = [&](const texgen::ProjectionSetup<texgen::World>& setup) {
            const Diagnosis diagnosis = diagnose(setup);
            return std::any_of(diagnosis.begin(), diagnosis.end(),
                               [](const auto& finding) { return finding.defect == Defect::angle_unit_mistaken; });
        };
        INFO(hex(fovy.in_radians()));
        const texgen::WorldTexgen texgen = texture_from_world(*projector);
        REQUIRE(!takes_for_degrees({.projector = projector}));
        REQUIRE(!takes_for_degrees({.projector = projector, .texgen = texgen}));
        REQUIRE(!takes_for_degrees({.texgen = texgen}));
        REQUIRE(!takes_for_degrees({.texgen = texgen, .lens = {.fovy = fovy}}));
        REQUIRE(!takes_for_degrees({.projector = projector, .lens = {.fovy = fovy}}));
    }
    CHECK(lenses > 1500);
}

TEST_CASE("a model that is scaled to nothing shows without any matrix") {
    Random random(625);
    for (int i = 0; i < 200; ++i) {
        Meant m = any_meant(Mistake::none, random);
        const std::optional<Projector> projector = right_projector(m);
        if (!projector) continue;
        texgen::ProjectionSetup<Object> setup{.region = m.region, .depth = m.depth};
        if (random.coin()) setup.projector = projector;
        setup.world_from_space = texgen::ModelMatrix(m.pose);
        CHECK(diagnose(setup).empty());
        for (int axis = 0; axis < 3; ++axis) m.pose[axis] = glm::dvec4(0.0);
        setup.world_from_space = texgen::ModelMatrix(m.pose);
        const Diagnosis diagnosis = diagnose(setup);
        REQUIRE(diagnosis.size() == 1);
        CHECK(diagnosis[0].defect == Defect::rank_below_three);
    }
}

TEST_CASE("of a projector alone the numbers that people write name the wrong unit and the wrong range") {
    Random random(626);
    int angles = 0, ranges = 0;
    for (int i = 0; i < 1000; ++i) {
        const Meant m = human(Mistake::none, random);
        const auto diagnosis_of_lens = [&](double fovy, bool zero_to_one, const texgen::LensFacts& facts = {}) {
            const Projector projector{texgen::ProjectorProjection(Code<double>::lens(m, fovy, zero_to_one)),
                                      texgen::ProjectorView(Code<double>::view(m)), m.conventions};
            return diagnose(texgen::ProjectionSetup<texgen::World>{.projector = projector, .lens = facts});
        };
        const double fovy = glm::radians(m.fovy);
        REQUIRE(diagnosis_of_lens(fovy, m.is_zero_to_one()).empty());
        const Diagnosis of_degrees = diagnosis_of_lens(m.fovy, m.is_zero_to_one());
        REQUIRE(!of_degrees.empty());
        angles += of_degrees[0].defect == Defect::angle_unit_mistaken;
        const Diagnosis of_range = diagnosis_of_lens(fovy, !m.is_zero_to_one());
        ranges += !of_range.empty() && of_range[0].defect == Defect::depth_range_mismatch;
        // Where a plane is known, numbers do not speak: the lens is one for this range that has another near plane.
        if (!m.is_zero_to_one()) REQUIRE(diagnosis_of_lens(fovy, true, {.z_far = m.z_far}).empty());
        REQUIRE(diagnosis_of_lens(fovy, !m.is_zero_to_one(), {.z_near = 1.5 * m.z_near}).empty());
    }
    CHECK(angles == 1000);
    CHECK(ranges >= 950);
}

TEST_CASE("a matrix that lacks a column, or whose lens is another that mirrors alike, is not of this set-up") {
    Random random(655);
    for (int i = 0; i < 300; ++i) {
        Meant m = any_meant(Mistake::none, random);
        const auto require_stale = [&](const glm::dmat4& texgen, bool mirrored) {
            const Diagnosis diagnosis = diagnose(texgen::WorldTexgen(texgen), {.projector = right_projector(m),
                                                                               .region = m.region,
                                                                               .depth = m.depth,
                                                                               .lens = {.mirrored = mirrored}});
            REQUIRE_MESSAGE(diagnosis.size() == 1, text(m, texgen, diagnosis));
            CHECK(diagnosis[0].defect == Defect::not_of_this_set_up);
        };
        m.kind = LensKind::perspective;
        for (int column = 0; column < 4; ++column) {
            glm::dmat4 texgen = texture_from_world(*right_projector(m), m.region, m.depth).matrix();
            texgen[column] = glm::dvec4(0.0);
            require_stale(texgen, false);
        }
        m.kind = LensKind::frustum;
        if (i % 3 != 1) std::swap(m.left, m.right);
        if (i % 3 != 0) std::swap(m.bottom, m.top);
        Meant other = m;
        other.left *= 1.5, other.right *= 1.7, other.bottom *= 1.3, other.top *= 1.1;
        require_stale(texture_from_world(*right_projector(other), m.region, m.depth).matrix(), true);
    }
}

TEST_CASE("a bias without w is named in a tile of an atlas too, where both s and t lack it and w is what it is") {
    Random random(656);
    for (int i = 0; i < 300; ++i) {
        Meant m = any_meant(Mistake::bias_without_w, random);
        m.region = texgen::atlas_tile({0.25, 0.5}, {0.5, 0.75});
        const In in = put_in_space(m, random);
        const auto is_named = [&](const glm::dmat4& texgen) {
            return diagnosis_of(m, in, right_projector(m), Told::projector, false, texgen)
                .contains(Defect::bias_without_w);
        };
        const glm::dmat4 s = Code<double>::bias(m), right = made<double>(m, Mistake::none, random);
        glm::dmat4 mistaken = made<double>(m, Mistake::no_bias, random);
        for (int row = 0; row < 2; ++row) {
            // By the tile's scale, with s or t turned, or by 1/2.
            const double scale = i % 3 == 2 ? 0.5 : i % 3 == row ? -s[row][row] : s[row][row];
            for (int column = 0; column < 4; ++column) mistaken[column][row] *= scale;
            mistaken[3][row] += i % 3 == 2 ? 0.5 : s[3][row];
        }
        REQUIRE_MESSAGE(is_named(mistaken), text(m, mistaken, {}));
        for (const int row : {0, 1, 3}) {
            glm::dmat4 other = mistaken;
            for (int column = 0; column < 4; ++column)
                other[column][row] = row == 3 ? 1.25 * other[column][3] : right[column][row];
            REQUIRE_MESSAGE(!is_named(other), text(m, other, {}));
        }
    }
}

// Why there is no projector

namespace {

using texgen::Aim;
using texgen::FrustumLens;
using texgen::OrthographicLens;
using texgen::PerspectiveLens;
using texgen::PinholeLens;
using texgen::PixelCentre;

const Aim good_aim{{1.0, 5.0, 2.0}, {0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}};
const PerspectiveLens good_perspective{texgen::degrees(30.0), 1.5, 0.1, 100.0};
const FrustumLens good_frustum{-0.1, 0.2, -0.1, 0.1, 0.1, 100.0};
const OrthographicLens good_orthographic{-1.0, 2.0, -1.0, 1.0, -5.0, 5.0};
const PinholeLens good_pinhole{800.0, 790.0, 320.0, 240.0, 640.0, 480.0, 0.1, 100.0, PixelCentre::half, 0.5};

// What is wrong with a lens or an aim, alone, in the order in which it was put there.
template <class Lens>
void require_only(const Lens& lens, const Aim& aim, Defect defect) {
    for (const Conventions& conventions : {texgen::opengl, texgen::vulkan, left_handed(texgen::direct3d)}) {
        const Diagnosis diagnosis = diagnose(lens, aim, conventions);
        REQUIRE_FALSE(make_projector(lens, aim, conventions));
        REQUIRE(diagnosis.size() == 1);
        CHECK(diagnosis[0].defect == defect);
    }
}

template <class Lens, class Member>
Lens with(Lens lens, Member Lens::*member, std::type_identity_t<Member> value) {
    lens.*member = value;
    return lens;
}

// A number that a lens may not have, more often than one that it may.
double any_number(Random& random) {
    constexpr std::array special{0.0,       -1.0, 1.0, 2.0, 1e-320, 1e308, -1e308, infinity_double, -infinity_double,
                                 nan_double};
    return random.coin() ? special[static_cast<std::size_t>(random.integer(0, 9))] : random.uniform(-2.0, 4.0);
}

glm::dvec3 any_vector(Random& random) {
    if (random.coin()) return {1.0, 2.0, 2.0};
    return {any_number(random), any_number(random), any_number(random)};
}

template <class Lens>
void require_said_where_refused(const Lens& lens, const Aim& aim, Conventions conventions, std::array<int, 2>& counts) {
    const bool is_made = make_projector(lens, aim, conventions).has_value();
    REQUIRE(diagnose(lens, aim, conventions).empty() == is_made);
    ++counts[is_made];
}

}  // namespace

TEST_CASE("each way in which a lens is refused has its name") {
    const PerspectiveLens& p = good_perspective;
    for (const double degrees : {0.0, -30.0, 180.0, 359.0})
        require_only(with(p, &PerspectiveLens::fovy, texgen::degrees(degrees)), good_aim, Defect::angle_out_of_range);
    for (const double radians : {0x1p-1074, 0x1p-1073})
        require_only(with(p, &PerspectiveLens::fovy, texgen::radians(radians)), good_aim, Defect::beyond_double);
    for (const double number : {10.0, 30.0, 90.0, -45.0})
        require_only(with(p, &PerspectiveLens::fovy, texgen::radians(number)), good_aim, Defect::angle_unit_mistaken);
    for (const double aspect : {0.0, -1.5})
        require_only(with(p, &PerspectiveLens::aspect, aspect), good_aim, Defect::aspect_not_positive);
    for (const double z_near : {0.0, -0.1})
        require_only(with(p, &PerspectiveLens::z_near, z_near), good_aim, Defect::near_not_in_front);
    for (const double z_far : {0.1, 0.05, -infinity_double})
        require_only(with(p, &PerspectiveLens::z_far, z_far), good_aim,
                     z_far < 0.0 ? Defect::not_finite : Defect::far_not_beyond_near);
    for (const double number : {nan_double, infinity_double}) {
        require_only(with(p, &PerspectiveLens::fovy, texgen::radians(number)), good_aim, Defect::not_finite);
        require_only(with(p, &PerspectiveLens::aspect, number), good_aim, Defect::not_finite);
        require_only(with(p, &PerspectiveLens::z_near, number), good_aim, Defect::not_finite);
    }
    require_only(with(p, &PerspectiveLens::aspect, 1e-320), good_aim, Defect::beyond_double);

    const FrustumLens& f = good_frustum;
    require_only(with(f, &FrustumLens::left, f.right), good_aim, Defect::lens_without_extent);
    require_only(with(f, &FrustumLens::bottom, f.top), good_aim, Defect::lens_without_extent);
    require_only(with(f, &FrustumLens::z_near, 0.0), good_aim, Defect::near_not_in_front);
    require_only(with(f, &FrustumLens::z_far, 0.05), good_aim, Defect::far_not_beyond_near);
    require_only(with(f, &FrustumLens::z_far, infinity_double), good_aim, Defect::not_finite);
    require_only(with(f, &FrustumLens::top, nan_double), good_aim, Defect::not_finite);

    const OrthographicLens& o = good_orthographic;
    require_only(with(o, &OrthographicLens::right, o.left), good_aim, Defect::lens_without_extent);
    require_only(with(o, &OrthographicLens::top, o.bottom), good_aim, Defect::lens_without_extent);
    require_only(with(o, &OrthographicLens::z_far, -5.0), good_aim, Defect::far_not_beyond_near);
    require_only(with(o, &OrthographicLens::left, -infinity_double), good_aim, Defect::not_finite);
    require_only(with(o, &OrthographicLens::left, o.right + 0x1p-52), good_aim, Defect::lens_without_extent);

    const PinholeLens& k = good_pinhole;
    for (double PinholeLens::*focal_length : {&PinholeLens::fx, &PinholeLens::fy})
        require_only(with(k, focal_length, 0.0), good_aim, Defect::focal_length_not_positive);
    for (double PinholeLens::*size : {&PinholeLens::width, &PinholeLens::height})
        require_only(with(k, size, -1.0), good_aim, Defect::picture_without_size);
    require_only(with(k, &PinholeLens::skew, nan_double), good_aim, Defect::not_finite);
    require_only(with(k, &PinholeLens::cx, infinity_double), good_aim, Defect::not_finite);
    require_only(with(k, &PinholeLens::z_near, 0.0), good_aim, Defect::near_not_in_front);
    require_only(with(k, &PinholeLens::z_far, 0.1), good_aim, Defect::far_not_beyond_near);
    CHECK(diagnose(with(k, &PinholeLens::z_far, infinity_double), good_aim, texgen::opengl).empty());
}

TEST_CASE("each way in which an aim is refused has its name, up parallel to the view first of all") {
    Random random(627);
    for (int i = 0; i < 200; ++i) {
        Aim aim;
        aim.position = std::round(random.power_of_ten(0.0, 3.0)) * glm::dvec3(1.0, -2.0, 0.5);
        // By powers of two, so that no rounding turns up away from the view.
        const glm::dvec3 direction{random.integer(-8, 8), random.integer(-8, 8), random.integer(1, 8)};
        aim.target = aim.position + direction;
        aim.up = std::ldexp(random.coin() ? 1.0 : -1.0, random.integer(-30, 30)) * direction;
        require_only(good_perspective, aim, Defect::up_parallel_to_view);
        require_only(good_pinhole, aim, Defect::up_parallel_to_view);
        aim.up = glm::dvec3(0.0);
        require_only(good_frustum, aim, Defect::up_is_zero);
        aim = {aim.position, aim.position, {0.0, 1.0, 0.0}};
        require_only(good_orthographic, aim, Defect::target_at_position);
        for (glm::dvec3 Aim::*vector : {&Aim::position, &Aim::target, &Aim::up}) {
            for (const double bad : {nan_double, infinity_double, -infinity_double}) {
                Aim spoilt = good_aim;
                (spoilt.*vector)[random.integer(0, 2)] = bad;
                require_only(good_perspective, spoilt, Defect::not_finite);
            }
        }
    }
    // All that is wrong, in order.
    const Diagnosis all = diagnose(PerspectiveLens{texgen::degrees(0.0), 0.0, 0.0, nan_double},
                                   Aim{{1.0, 1.0, 1.0}, {1.0, 1.0, 1.0}, {0.0, 0.0, 0.0}}, texgen::metal);
    constexpr std::array expected{Defect::not_finite,        Defect::angle_out_of_range, Defect::aspect_not_positive,
                                  Defect::near_not_in_front, Defect::target_at_position, Defect::up_is_zero};
    REQUIRE(all.size() == expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) CHECK(all[i].defect == expected[i]);
}

TEST_CASE("a lens and an aim are said to be refused where no projector is made of them, and nowhere else") {
    Random random(628);
    std::array<int, 2> counts{};
    for (int i = 0; i < 100000; ++i) {
        const Aim aim{any_vector(random), any_vector(random), any_vector(random)};
        const Conventions conventions = any_conventions(random);
        const auto number = [&](double usual) { return random.integer(0, 3) == 0 ? any_number(random) : usual; };
        const PerspectiveLens p{random.coin() ? texgen::degrees(number(60.0)) : texgen::radians(number(1.0)),
                                number(1.5), number(0.1), number(10.0), random.coin()};
        require_said_where_refused(p, aim, conventions, counts);
        const FrustumLens f{number(-1.0), number(1.0), number(-1.0), number(1.0), number(0.1), number(10.0)};
        require_said_where_refused(f, aim, conventions, counts);
        const OrthographicLens o{f.left, f.right, f.bottom, f.top, f.z_near, f.z_far};
        require_said_where_refused(o, aim, conventions, counts);
        const PinholeLens k{number(9.0),          number(9.0), number(3.0), number(3.0),
                            number(8.0),          number(8.0), number(0.1), number(infinity_double),
                            PixelCentre::integer, number(0.0)};
        require_said_where_refused(k, aim, conventions, counts);
    }
    CHECK(counts[0] > 10000);
    CHECK(counts[1] > 10000);
}

static_assert(noexcept(diagnose(good_perspective, good_aim, texgen::opengl)));
static_assert(noexcept(diagnose(good_frustum, good_aim, texgen::opengl)));
static_assert(noexcept(diagnose(good_orthographic, good_aim, texgen::opengl)));
static_assert(noexcept(diagnose(good_pinhole, good_aim, texgen::opengl)));
