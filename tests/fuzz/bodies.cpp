// Boxes, spheres and scenes over raw bytes: a batch answers as the single question does, a NaN leaves its own body
// open, no corner of a body contradicts what is said of it, by the exact judge, and a scene has the pairs that asking
// for each gives.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "fuzz/input.hpp"
#include "judges/exact.hpp"
#include "texgen/coverage.hpp"
#include "texgen/linear.hpp"
#include "texgen/projector.hpp"
#include "texgen/scene.hpp"

namespace {

using fuzz::Input;
using fuzz::must;
using support::Dyadic;
using texgen::Box;
using texgen::Coverage;
using texgen::Sphere;

bool is_nan(const glm::vec3& v) { return std::isnan(v.x) || std::isnan(v.y) || std::isnan(v.z); }

// Whether a point is lit: q > 0, and s, t, and r where there is a depth, between the sides, which may be infinite.
bool is_lit(const support::Homogeneous& at, const texgen::TextureRegion& region) {
    if (at.q.sign() <= 0) return false;
    for (std::size_t k = 0; k < (region.depth() ? 3 : 2); ++k) {
        const glm::dvec2 limits = support::limits_of(region, k);
        if (std::isnan(limits.x) || std::isnan(limits.y)) return false;
        if (compare(at.over_q(k), limits.x) < 0 || compare(at.over_q(k), limits.y) > 0) return false;
    }
    return true;
}

// As real numbers, and as the floats that they are rounded to.
void agrees(Coverage coverage, const glm::dmat4& matrix, const texgen::TextureRegion& region, const glm::vec3& point) {
    if (coverage == Coverage::partial || !fuzz::all_finite(point)) return;
    const support::Homogeneous at = support::exactly_at(matrix, point);
    for (const bool lit : {is_lit(at, region), support::contains(region, at)})
        must(lit == (coverage == Coverage::inside),
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

// Where exponents are so far apart that coverage() cannot say, a scene may know that a pair is dark, or lit in full.
bool can_say(const glm::dmat4& texgen, const texgen::TextureRegion& region) {
    const auto is_moderate = [](double x) { return x == 0.0 || (std::fabs(x) > 0x1p-150 && std::fabs(x) < 0x1p150); };
    for (int k = 0; k < 2; ++k)
        if (!is_moderate(region.min()[k]) || !is_moderate(region.max()[k])) return false;
    if (region.depth() && (!is_moderate(region.depth()->x) || !is_moderate(region.depth()->y))) return false;
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            if (!is_moderate(texgen[column][row])) return false;
    return true;
}

// The pairs of a scene after an update, against every object and every projector by themselves.
void require_pairs(const texgen::Scene& scene, const texgen::SceneView& view) {
    std::size_t count = 0;
    for (std::uint32_t o = 0; o < view.models.size(); ++o) {
        for (std::uint32_t p = 0; p < view.projectors.size(); ++p) {
            const auto texgen = object_linear(view.projectors[p], view.models[o], view.regions[p]);
            const Coverage expected = coverage(texgen, view.regions[p], view.bounds[o]);
            if (expected == Coverage::outside) continue;
            const bool is_there =
                count < scene.pairs().size() && scene.pairs()[count].object == o && scene.pairs()[count].projector == p;
            if (!is_there && expected == Coverage::partial && !can_say(texgen.matrix(), view.regions[p])) continue;
            must(is_there, "no pair is missing, and pairs are in order");
            const texgen::LitPair& pair = scene.pairs()[count++];
            must(pair.coverage == expected || !can_say(texgen.matrix(), view.regions[p]),
                 "a pair says what its box does");
            must(std::memcmp(&scene.texgen(pair).matrix(), &texgen.matrix(), sizeof(glm::dmat4)) == 0 ||
                     !fuzz::all_finite(texgen.matrix()),
                 "a pair has its T_o");
        }
    }
    must(count == scene.pairs().size(), "no pair is left over");
}

void update_scenes(Input& input) {
    const auto model_of = [&] {
        glm::dmat4 m = input.coin() ? glm::dmat4(input.matrix()) : glm::dmat4(1.0);
        if (input.coin()) m[0][3] = m[1][3] = m[2][3] = 0.0, m[3][3] = 1.0;
        m[3][0] += static_cast<double>(input.number());
        return texgen::ModelMatrix(m);
    };
    const auto box_of = [&] {
        const glm::vec3 a = input.vector3(), b = input.vector3();
        return input.integer(0, 7) == 0 ? Box{a, b} : Box{glm::min(a, b), glm::max(a, b)};
    };
    const auto projector_of = [&] {
        const texgen::PerspectiveLens lens{texgen::degrees(1.0 + input.integer(0, 170)), 1.0, 0.1, 100.0};
        const texgen::Aim aim{glm::dvec3(input.vector3()), glm::dvec3(input.vector3()), {0.0, 1.0, 0.0}};
        if (const auto made = make_projector(lens, aim, input.conventions())) return *made;
        return texgen::Projector{texgen::ProjectorProjection(input.wide_matrix()),
                                 texgen::ProjectorView(glm::dmat4(1.0)), texgen::opengl};
    };
    texgen::Scene scene;
    std::vector<texgen::ModelMatrix> models;
    std::vector<Box> bounds;
    std::vector<texgen::Projector> projectors;
    std::vector<texgen::TextureRegion> regions;
    for (int frame = input.integer(1, 5); frame > 0; --frame) {
        std::vector<std::uint32_t> changed_objects, changed_projectors;
        for (std::size_t i = input.size(6); i > 0; --i) {
            if (input.coin() || models.empty()) {
                models.push_back(model_of());
                bounds.push_back(box_of());
            } else {
                const std::size_t o = input.size(15) % models.size();
                models[o] = model_of();
                bounds[o] = box_of();
                changed_objects.push_back(static_cast<std::uint32_t>(o));
            }
        }
        for (std::size_t i = input.size(2); i > 0; --i) {
            if (input.coin() || projectors.empty()) {
                projectors.push_back(projector_of());
                regions.push_back(input.region_with_depth());
            } else {
                const std::size_t p = input.size(3) % projectors.size();
                projectors[p] = projector_of();
                changed_projectors.push_back(static_cast<std::uint32_t>(p));
            }
        }
        // What is taken away has no name among the changes.
        while (input.integer(0, 7) == 0 && !models.empty()) {
            models.pop_back();
            bounds.pop_back();
        }
        std::erase_if(changed_objects, [&](std::uint32_t o) { return o >= models.size(); });
        const texgen::SceneView view{models, bounds, projectors, regions};
        (void)scene.update(view, {changed_objects, changed_projectors});
        require_pairs(scene, view);
        (void)scene.update_eye(texgen::CameraPose(input.coin() ? input.wide_matrix() : glm::dmat4(1.0)));
        must(scene.eye_texgens().size() == projectors.size(), "there is a T_e for each projector");
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Input input(data, size);
    if (input.integer(0, 2) == 0) {
        update_scenes(input);
        return 0;
    }
    const texgen::ObjectTexgen texgen(input.coin() ? glm::dmat4(input.matrix()) : input.wide_matrix());
    const texgen::TextureRegion region = input.region_with_depth();
    if (input.coin())
        cover_boxes(input, texgen, region);
    else
        cover_spheres(input, texgen, region);
    return 0;
}
