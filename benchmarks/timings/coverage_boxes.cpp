// Coverage: boxes and spheres against one projector after another, in batches.

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <texgen/coverage.hpp>
#include <texgen/linear.hpp>
#include <texgen/projector.hpp>

#include "bench.hpp"

namespace bench {

namespace {

using texgen::Box;
using texgen::Coverage;
using texgen::Sphere;

constexpr std::size_t projector_count = 8;

// Bodies of 0.1 to 10 units, scattered within `spread` of a place that the projectors stand near.
class Bodies {
public:
    Bodies(const std::string& name, std::size_t count, double spread, double distance)
        : scene_{"Coverage, " + name, projector_count, count}, out_(count) {
        std::mt19937 random(7);
        const auto between = [&](double low, double high) {
            return std::uniform_real_distribution<double>(low, high)(random);
        };
        const auto about = [&](double extent) {
            const double x = between(-extent, extent), y = between(-extent, extent);
            return glm::dvec3(distance) + glm::dvec3(x, y, between(-extent, extent));
        };
        while (volumes_.size() < projector_count) {
            const texgen::PerspectiveLens lens{
                .fovy = texgen::degrees(between(20, 90)), .aspect = between(0.7, 1.6), .z_near = 0.2, .z_far = 1000};
            const texgen::Aim aim{.position = about(10), .target = about(10), .up = {0.1, 1, 0.2}};
            const auto projector = texgen::make_projector(lens, aim, texgen::opengl);
            if (!projector) continue;
            transforms_.push_back(texgen::texture_from_world(*projector));
            volumes_.emplace_back(transforms_.back(), texgen::whole_texture());
            const auto rows = texgen::planes(transforms_.back());
            planes_.push_back({rows[0], rows[3] - rows[0], rows[1], rows[3] - rows[1], rows[3]});
        }
        for (std::size_t i = 0; i < count; ++i) {
            const double size = std::pow(10.0, between(-1, 1));
            const glm::dvec3 centre = about(spread);
            const glm::dvec3 half = size * glm::dvec3(between(0.1, 0.5), between(0.1, 0.5), between(0.1, 0.5));
            boxes_.push_back({glm::vec3(centre - half), glm::vec3(centre + half)});
            spheres_.push_back({glm::vec3(centre), static_cast<float>(0.5 * size)});
        }
    }

    const Scene& scene() const { return scene_; }
    const auto& boxes() const { return boxes_; }
    const auto& spheres() const { return spheres_; }
    auto& out() { return out_; }
    const auto& transform(std::size_t i) const { return transforms_[i]; }
    const auto& volume(std::size_t i) const { return volumes_[i]; }
    // Lit where all are >= 0, as a user has them.
    const std::array<glm::vec4, 5>& planes(std::size_t i) const { return planes_[i]; }

    // Where the planes leave no doubt in long double, the answer is theirs, or `outside` for a box none of whose
    // corners is lit.
    void check_boxes(std::size_t i) const {
        const glm::dmat4& m = transforms_[i].matrix();
        for (std::size_t k = 0; k < boxes_.size(); ++k) {
            long double largest[5], least[5];
            std::fill_n(largest, 5, -HUGE_VALL);
            std::fill_n(least, 5, HUGE_VALL);
            bool is_a_corner_lit = false;
            for (int corner = 0; corner < 8; ++corner) {
                long double strq[4] = {};
                for (int row = 0; row < 4; ++row) {
                    for (int j = 0; j < 3; ++j)
                        strq[row] += static_cast<long double>(m[j][row]) *
                                     ((corner >> j & 1) != 0 ? boxes_[k].max : boxes_[k].min)[j];
                    strq[row] += m[3][row];
                }
                const long double values[5] = {strq[0], strq[3] - strq[0], strq[1], strq[3] - strq[1], strq[3]};
                for (int f = 0; f < 5; ++f) {
                    largest[f] = std::max(largest[f], values[f]);
                    least[f] = std::min(least[f], values[f]);
                }
                is_a_corner_lit = is_a_corner_lit || *std::min_element(values, values + 5) > 0;
            }
            constexpr long double doubt = 1e-9L;
            const bool is_outside = *std::min_element(largest, largest + 5) < -doubt;
            const bool is_inside = *std::min_element(least, least + 5) > doubt;
            const bool reaches_in = *std::min_element(largest, largest + 5) > doubt;
            const bool reaches_out = *std::min_element(least, least + 5) < -doubt;
            const Coverage answer = out_[k];
            if ((is_outside && answer != Coverage::outside) || (is_inside && answer != Coverage::inside) ||
                (reaches_in && reaches_out && answer == Coverage::inside) ||
                (is_a_corner_lit && answer == Coverage::outside))
                fail(scene_.name + ": a box has the wrong answer");
        }
    }

private:
    Scene scene_;
    std::vector<texgen::WorldTexgen> transforms_;
    std::vector<texgen::LitVolume<texgen::World>> volumes_;
    std::vector<std::array<glm::vec4, 5>> planes_;
    std::vector<Box> boxes_;
    std::vector<Sphere> spheres_;
    std::vector<Coverage> out_;
};

// The vertex that is farthest along the plane decides outside, the opposite one inside.
void glm_boxes(Bodies& work, std::size_t i) {
    const std::array<glm::vec4, 5>& planes = work.planes(i);
    for (std::size_t k = 0; k < work.boxes().size(); ++k) {
        const Box& box = work.boxes()[k];
        Coverage answer = Coverage::inside;
        for (const glm::vec4& plane : planes) {
            const glm::vec4 far(plane.x > 0 ? box.max.x : box.min.x, plane.y > 0 ? box.max.y : box.min.y,
                                plane.z > 0 ? box.max.z : box.min.z, 1.0f);
            if (glm::dot(plane, far) < 0) {
                answer = Coverage::outside;
                break;
            }
            const glm::vec4 near(plane.x > 0 ? box.min.x : box.max.x, plane.y > 0 ? box.min.y : box.max.y,
                                 plane.z > 0 ? box.min.z : box.max.z, 1.0f);
            if (glm::dot(plane, near) < 0) answer = Coverage::partial;
        }
        work.out()[k] = answer;
    }
}

void glm_spheres(Bodies& work, std::size_t i) {
    std::array<glm::vec4, 5> planes = work.planes(i);
    for (glm::vec4& plane : planes) plane /= glm::length(glm::vec3(plane));
    for (std::size_t k = 0; k < work.spheres().size(); ++k) {
        const Sphere& sphere = work.spheres()[k];
        Coverage answer = Coverage::inside;
        for (const glm::vec4& plane : planes) {
            const float distance = glm::dot(plane, glm::vec4(sphere.centre, 1.0f));
            if (distance < -sphere.radius) {
                answer = Coverage::outside;
                break;
            }
            if (distance < sphere.radius) answer = Coverage::partial;
        }
        work.out()[k] = answer;
    }
}

void add_boxes(const std::string& name, std::size_t count, double spread, double distance) {
    const auto work = std::make_shared<Bodies>(name, count, spread, distance);
    const auto add = [&](const std::string& variant, auto run) {
        register_row(work->scene().name + separator + variant,
                     [=, is_checked = false](benchmark::State& state) mutable {
                         for (std::size_t i = 0; !is_checked && i < projector_count; ++i) {
                             run(i);
                             work->check_boxes(i);
                         }
                         is_checked = true;
                         time(state, work->scene(), run);
                     });
    };
    add("texgen, a batch", [=](std::size_t i) { work->volume(i).coverage(work->boxes(), work->out()); });
    add("texgen, a batch with set-up", [=](std::size_t i) {
        texgen::coverage(work->transform(i), texgen::whole_texture(), std::span<const Box>(work->boxes()),
                         std::span(work->out()));
    });
    add("texgen, one box at a time", [=](std::size_t i) {
        for (std::size_t k = 0; k < work->boxes().size(); ++k)
            work->out()[k] = work->volume(i).coverage(work->boxes()[k]);
    });
    add("texgen, one question", [=](std::size_t i) {
        for (std::size_t k = 0; k < work->boxes().size(); ++k)
            work->out()[k] = texgen::coverage(work->transform(i), texgen::whole_texture(), work->boxes()[k]);
    });
    // Floats decide without a bound here, so nothing is promised.
    add_unchecked(work->scene(), "GLM, five planes", [=](std::size_t i) { glm_boxes(*work, i); });
}

void add_spheres(std::size_t count) {
    const auto work = std::make_shared<Bodies>("4096 spheres, scattered", count, 30.0, 0.0);
    add_unchecked(work->scene(), "texgen, a batch",
                  [=](std::size_t i) { work->volume(i).coverage(work->spheres(), work->out()); });
    add_unchecked(work->scene(), "GLM, five planes", [=](std::size_t i) { glm_spheres(*work, i); });
}

}  // namespace

void add_coverage() {
    add_boxes("4096 boxes, scattered", 4096, 30.0, 0.0);
    add_boxes("4096 boxes, dense", 4096, 10.0, 0.0);
    add_boxes("4096 boxes, 1e5 from the origin", 4096, 30.0, 1e5);
    add_boxes("16 boxes", 16, 30.0, 0.0);
    add_spheres(4096);
}

}  // namespace bench
