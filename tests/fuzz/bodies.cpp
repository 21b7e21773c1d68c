// Boxes and spheres over raw bytes: a batch answers as the single question does, a NaN leaves its own body open, and no
// corner of a body contradicts what is said of it, by the exact judge.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "fuzz/input.hpp"
#include "support/exact.hpp"
#include "texgen/skip.hpp"

namespace {

using fuzz::Input;
using fuzz::must;
using support::Dyadic;
using texgen::Box;
using texgen::Coverage;
using texgen::Sphere;

bool is_nan(const glm::vec3& v) { return std::isnan(v.x) || std::isnan(v.y) || std::isnan(v.z); }

// Whether a point is lit: q > 0, and s and t between the sides, which may be infinite.
bool is_lit(const glm::dmat4& matrix, const texgen::TextureRegion& region, const glm::vec3& point) {
    const support::Homogeneous at = support::exactly_at(matrix, point);
    if (at.q.sign() <= 0) return false;
    for (std::size_t k = 0; k < 2; ++k) {
        const int i = static_cast<int>(k);
        const double min = region.min()[i], max = region.max()[i];
        if (std::isnan(min) || std::isnan(max)) return false;
        if (compare(at.over_q(k), min) < 0 || compare(at.over_q(k), max) > 0) return false;
    }
    return true;
}

void agrees(Coverage coverage, const glm::dmat4& matrix, const texgen::TextureRegion& region, const glm::vec3& point) {
    if (coverage == Coverage::partial || !fuzz::all_finite(point)) return;
    must(is_lit(matrix, region, point) == (coverage == Coverage::inside),
         coverage == Coverage::inside ? "inside, all points are lit" : "outside, no point is lit");
}

void cover_boxes(Input& input, const texgen::ObjectTexgen& texgen, const texgen::TextureRegion& region) {
    const glm::dmat4& matrix = texgen.matrix();
    std::vector<Box> few(1 + input.size(5));
    for (Box& box : few) {
        const glm::vec3 a = input.vector3(), b = input.vector3();
        box = input.integer(0, 3) == 0 ? Box{a, b} : Box{glm::min(a, b), glm::max(a, b)};
    }
    std::vector<Box> boxes(input.size(80));
    for (std::size_t i = 0; i < boxes.size(); ++i) boxes[i] = few[i % few.size()];
    std::vector<Coverage> out(boxes.size() + 2, static_cast<Coverage>(77));
    coverage(texgen, region, std::span<const Box>(boxes), std::span(out).subspan(1, boxes.size()));
    must(out.front() == static_cast<Coverage>(77) && out.back() == static_cast<Coverage>(77),
         "coverage writes its outputs only");
    for (std::size_t i = 0; i < few.size(); ++i) {
        const Box& box = few[i];
        const Coverage alone = coverage(texgen, region, box);
        for (std::size_t j = i; j < boxes.size(); j += few.size())
            must(out[1 + j] == alone, "a batch answers as the single question does");
        const bool is_any_nan = is_nan(box.min) || is_nan(box.max);
        const bool is_empty = box.min.x > box.max.x || box.min.y > box.max.y || box.min.z > box.max.z;
        if (is_any_nan || (!is_empty && !fuzz::all_finite(matrix)))
            must(alone == Coverage::partial, "what is no number leaves it open");
        else if (is_empty)
            must(alone == Coverage::outside, "an empty box is outside");
        if (is_any_nan || is_empty || !fuzz::all_finite(matrix) || !fuzz::all_finite(box.min) ||
            !fuzz::all_finite(box.max))
            continue;
        for (int corner = 0; corner < 8; ++corner)
            agrees(alone, matrix, region,
                   {((corner & 1) != 0 ? box.max : box.min).x, ((corner & 2) != 0 ? box.max : box.min).y,
                    ((corner & 4) != 0 ? box.max : box.min).z});
        agrees(alone, matrix, region, glm::clamp(input.vector3(), box.min, box.max));
        agrees(alone, matrix, region, glm::clamp(0.5f * box.min + 0.5f * box.max, box.min, box.max));
    }
}

void cover_spheres(Input& input, const texgen::ObjectTexgen& texgen, const texgen::TextureRegion& region) {
    const glm::dmat4& matrix = texgen.matrix();
    std::vector<Sphere> spheres(1 + input.size(7));
    for (Sphere& sphere : spheres) sphere = {input.vector3(), input.number()};
    std::vector<Coverage> out(spheres.size() + 2, static_cast<Coverage>(77));
    coverage(texgen, region, std::span<const Sphere>(spheres), std::span(out).subspan(1, spheres.size()));
    must(out.front() == static_cast<Coverage>(77) && out.back() == static_cast<Coverage>(77),
         "coverage writes its outputs only");
    for (std::size_t i = 0; i < spheres.size(); ++i) {
        const Sphere& sphere = spheres[i];
        const Coverage alone = coverage(texgen, region, sphere);
        must(out[1 + i] == alone, "a batch answers as the single question does");
        if (is_nan(sphere.centre) || std::isnan(sphere.radius) ||
            (!(sphere.radius < 0.0f) && !fuzz::all_finite(matrix))) {
            must(alone == Coverage::partial, "what is no number leaves it open");
            continue;
        }
        if (!fuzz::all_finite(sphere.centre) || !std::isfinite(sphere.radius)) continue;
        if (sphere.radius < 0.0f) {
            must(alone == Coverage::outside, "a sphere of negative radius is outside");
            continue;
        }
        agrees(alone, matrix, region, sphere.centre);
        // Points of the sphere along the axes, moved inward where the sum is rounded.
        for (int axis = 0; axis < 3; ++axis) {
            for (const float sign : {-1.0f, 1.0f}) {
                glm::vec3 point = sphere.centre;
                point[axis] += sign * sphere.radius;
                if (!std::isfinite(point[axis])) continue;
                if (magnitude(Dyadic(point[axis]) - Dyadic(sphere.centre[axis])) <= Dyadic(sphere.radius))
                    agrees(alone, matrix, region, point);
            }
        }
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Input input(data, size);
    const texgen::ObjectTexgen texgen(input.coin() ? glm::dmat4(input.matrix()) : input.wide_matrix());
    const texgen::TextureRegion region = input.region();
    if (input.coin())
        cover_boxes(input, texgen, region);
    else
        cover_spheres(input, texgen, region);
    return 0;
}
