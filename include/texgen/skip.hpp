#pragma once

// Floor 6: what a primitive, a batch or a box needs. Work that is not needed is not done.

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include <glm/vec3.hpp>

#include "conventions.hpp"
#include "detail/assert.hpp"
#include "detail/body_blocks.hpp"
#include "detail/lit_forms.hpp"
#include "detail/widen.hpp"
#include "transform.hpp"

namespace texgen {

// What the fragments of a rectangle need, in the order of its cost.
//   nothing          no fragment is lit: all are behind the projector, or outside one side of the region
//   affine           q/w is constant there (an orthographic projector, a parallel view), or varies so little that straight
//                    lines stay inside the tolerance: no division
//   quadratic        q/w varies, and a certified quadratic stays inside the tolerance: no division a fragment
//   divide           one division a fragment; every fragment is in front of the projector and inside the region
//   divide_and_test  one division a fragment; the sign of q or the sides of the region are tested
// Where the region's border crosses an affine or quadratic rectangle, the mask is compared from the coordinates.
enum class Work { nothing, affine, quadratic, divide, divide_and_test };

// What the slide is to a body. A point is lit where q > 0 and (s, t) is in the closed region.
//   outside  no point of the closed body is lit
//   partial  neither of the others, or not provably one of them
//   inside   all points are lit
enum class Coverage { outside, partial, inside };

// The points between two corners, both included. Extents may be infinite.
struct Box {
    glm::vec3 min, max;
};

// The points within `radius` of the centre, those at that distance included.
struct Sphere {
    glm::vec3 centre;
    float radius;
};

namespace detail {

// What the five planes say of a box, exactly: the contract where the floats are in doubt.
inline Coverage exact_coverage(const LitForms& forms, const Box& box) noexcept {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    bool is_empty = false;
    for (int j = 0; j < 3; ++j) {
        if (!(box.min[j] <= box.max[j]) && !(box.min[j] > box.max[j])) return Coverage::partial;  // a NaN
        is_empty = is_empty || box.min[j] > box.max[j];
    }
    if (is_empty || forms.light_nothing()) return Coverage::outside;
    if (!forms.are_usable()) return Coverage::partial;
    for (int j = 0; j < 3; ++j)
        if (box.min[j] == infinity || box.max[j] == -infinity) return Coverage::partial;  // no point at all

    // The sign of a form at the vertex where it is largest, or least.
    const auto sign_at_vertex = [&](std::size_t k, bool largest) {
        Point vertex{};
        for (std::size_t j = 0; j < 3; ++j) {
            if (!forms[k].uses[j]) continue;
            vertex[j] =
                widened((forms[k].a[j] > 0.0) == largest ? box.max[static_cast<int>(j)] : box.min[static_cast<int>(j)]);
            if (!is_finite(vertex[j])) return largest ? 1 : -1;
        }
        return forms.sign_at(k, vertex);
    };
    if (sign_at_vertex(LitForms::q, true) <= 0) return Coverage::outside;
    bool is_inside = sign_at_vertex(LitForms::q, false) > 0;
    for (std::size_t k = 0; k < LitForms::side_count; ++k) {
        if (sign_at_vertex(k, true) < 0) return Coverage::outside;
        is_inside = is_inside && sign_at_vertex(k, false) >= 0;
    }
    return is_inside ? Coverage::inside : Coverage::partial;
}

// Boxes that the floats did not reject, gathered from many blocks, as few of a scene remain.
class RemainingBoxes {
public:
    void add(const LitForms& forms, const Box& box, Coverage& out) noexcept {
        block_.set(count_, box);
        box_[count_] = &box;
        out_[count_] = &out;
        if (++count_ == double_box_block) decide(forms);
    }

    void decide(const LitForms& forms) noexcept {
        if (count_ == 0) return;
        DoubleLanes least_of_largest;
        DoubleLanes least;
        DoubleLanes separation;
        find_extremes(forms, block_, least_of_largest, least);
        bool is_any_partial = false;
        for (std::size_t i = 0; i < count_; ++i) {
            *out_[i] = decided(forms, i, least_of_largest[i], least[i]);
            is_any_partial = is_any_partial || *out_[i] == Coverage::partial;
        }
        if (is_any_partial && forms.are_usable()) {
            find_separation(forms, block_, separation);
            for (std::size_t i = 0; i < count_; ++i)
                if (*out_[i] == Coverage::partial && is_proper(i) && separation[i] < 0.0) *out_[i] = Coverage::outside;
        }
        count_ = 0;
    }

private:
    // Neither empty nor with a NaN.
    bool is_proper(std::size_t i) const noexcept {
        bool result = true;
        for (std::size_t j = 0; j < 3; ++j) result = result && block_.min[j][i] <= block_.max[j][i];
        return result;
    }

    Coverage decided(const LitForms& forms, std::size_t i, double least_of_largest, double least) const noexcept {
        double size = 0.0;
        for (std::size_t j = 0; j < 3; ++j) size += larger(-block_.min[j][i], block_.max[j][i]);
        const double error = forms.error(size);
        if (is_proper(i) && error < 0x1p1000) {
            if (least_of_largest < -error) return Coverage::outside;
            if (least > error) return Coverage::inside;
            if (least_of_largest > error && least < -error) return Coverage::partial;
        }
        return exact_coverage(forms, *box_[i]);
    }

    DoubleBlock block_{};
    std::array<const Box*, double_box_block> box_{};
    std::array<Coverage*, double_box_block> out_{};
    std::size_t count_ = 0;
};

inline void cover(const LitForms& forms, const FloatForms& float_forms, std::span<const Box> boxes,
                  std::span<Coverage> out) noexcept {
    RemainingBoxes remaining;
    FloatForms::Block block{};
    std::array<int, box_block> rejected;
    std::array<std::size_t, box_block> kept;
    for (std::size_t begin = 0; begin < boxes.size(); begin += box_block) {
        const std::size_t count = boxes.size() - begin < box_block ? boxes.size() - begin : box_block;
        for (std::size_t i = 0; i < count; ++i) block.set(i, boxes[begin + i]);
        float_forms.reject(block, rejected);
        std::size_t kept_count = 0;
        for (std::size_t i = 0; i < count; ++i) {
            out[begin + i] = Coverage::outside;
            kept[kept_count] = begin + i;
            kept_count += rejected[i] == 0 ? 1u : 0u;
        }
        for (std::size_t i = 0; i < kept_count; ++i) remaining.add(forms, boxes[kept[i]], out[kept[i]]);
    }
    remaining.decide(forms);
}

// f(centre) +- |a| radius are the extremes of a form over a sphere.
inline Coverage sphere_coverage(const LitForms& forms, const Sphere& sphere) noexcept {
    const Point centre{widened(sphere.centre.x), widened(sphere.centre.y), widened(sphere.centre.z)};
    const double radius = widened(sphere.radius);
    const double size = std::fabs(centre[0]) + std::fabs(centre[1]) + std::fabs(centre[2]) + std::fabs(radius);
    if (!is_finite(size)) return Coverage::partial;
    if (radius < 0.0 || forms.light_nothing()) return Coverage::outside;
    if (!forms.are_usable()) return Coverage::partial;
    bool is_inside = true;
    for (std::size_t k = 0; k < LitForms::count; ++k) {
        const BoundedForm& form = forms[k];
        const double value = form.a[0] * centre[0] + form.a[1] * centre[1] + form.a[2] * centre[2] + form.d;
        const double change = std::sqrt(form.a[0] * form.a[0] + form.a[1] * form.a[1] + form.a[2] * form.a[2]) * radius;
        const double error = 4.0 * form.error_a * size + form.error_d;
        if (value + change + error < 0.0) return Coverage::outside;
        is_inside = is_inside && value - change - error > 0.0;
    }
    return is_inside ? Coverage::inside : Coverage::partial;
}

inline void cover(const LitForms& forms, std::span<const Sphere> spheres, std::span<Coverage> out) noexcept {
    for (std::size_t i = 0; i < spheres.size(); ++i) out[i] = sphere_coverage(forms, spheres[i]);
}

}  // namespace detail

// The points that a slide lights, prepared once for many questions: what the functions below prepare at every call.
// Guarantee: `outside` and `inside` are never false: they hold for the exact values of the matrix, the region and the body
// as they are given. A box is `partial` only where it is so, or touches a plane through an edge or through the apex of the
// projector's pyramid within 2^-48 of the sizes involved; the pyramid's own planes are decided exactly. A batch answers as
// the single question does. No allocation, noexcept.
// Shape: bodies of Space, in order; both spans have one size (asserted).
// Bad input: a NaN anywhere in a body, or a matrix that is not finite: partial. A box with min > max in some axis, a
// sphere with a negative radius, an empty region (see TextureRegion) or a q that is 0 everywhere: outside. Exponents so
// far apart that exact sums leave the range of double (elements below 2^-400 of the matrix's largest, sides of the region
// beyond 2^+-200): partial. An infinite side of the region is none.
// Source: the separating axis theorem; Gottschalk, Lin, Manocha, OBBTree, SIGGRAPH 1996.
template <class Space>
class LitVolume {
public:
    LitVolume(const Transform<Texture, Space>& texture_from_space, const TextureRegion& region) noexcept
        : forms_(texture_from_space.matrix(), region), float_forms_(forms_) {}

    Coverage coverage(const Box& box) const noexcept { return coverage_of(box); }
    Coverage coverage(const Sphere& sphere) const noexcept { return coverage_of(sphere); }

    void coverage(std::span<const Box> boxes, std::span<Coverage> out) const noexcept {
        TEXGEN_ASSERT(boxes.size() == out.size());
        detail::cover(forms_, float_forms_, boxes, out);
    }
    void coverage(std::span<const Sphere> spheres, std::span<Coverage> out) const noexcept {
        TEXGEN_ASSERT(spheres.size() == out.size());
        detail::cover(forms_, spheres, out);
    }

private:
    template <class Body>
    Coverage coverage_of(const Body& body) const noexcept {
        Coverage result;
        coverage(std::span(&body, 1), std::span(&result, 1));
        return result;
    }

    detail::LitForms forms_;
    detail::FloatForms float_forms_;
};

// What the slide is to a box or a sphere, and to many of them: a LitVolume of the transform and the region, asked once.
template <class Space>
Coverage coverage(const Transform<Texture, Space>& texture_from_space, const TextureRegion& region,
                  const Box& box) noexcept {
    return LitVolume<Space>(texture_from_space, region).coverage(box);
}
template <class Space>
Coverage coverage(const Transform<Texture, Space>& texture_from_space, const TextureRegion& region,
                  const Sphere& sphere) noexcept {
    return LitVolume<Space>(texture_from_space, region).coverage(sphere);
}
template <class Space>
void coverage(const Transform<Texture, Space>& texture_from_space, const TextureRegion& region,
              std::span<const Box> boxes, std::span<Coverage> out) noexcept {
    LitVolume<Space>(texture_from_space, region).coverage(boxes, out);
}
template <class Space>
void coverage(const Transform<Texture, Space>& texture_from_space, const TextureRegion& region,
              std::span<const Sphere> spheres, std::span<Coverage> out) noexcept {
    LitVolume<Space>(texture_from_space, region).coverage(spheres, out);
}

}  // namespace texgen
