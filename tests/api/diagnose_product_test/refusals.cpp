// Why there is no projector: each way in which a lens or an aim is refused has its name.

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <type_traits>

#include <glm/vec3.hpp>

#include "support/random.hpp"
#include "support/special_values.hpp"
#include "support/windows.hpp"
#include "texgen/diagnose.hpp"
#include "texgen/projector.hpp"

namespace {

using support::infinity_double;
using support::nan_double;
using support::Random;
using texgen::Aim;
using texgen::Conventions;
using texgen::Defect;
using texgen::Diagnosis;
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
        const Conventions conventions = support::any_conventions(random);
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
