// Scenes from frame to frame: what an update costs as objects and projectors double, and a frame as less of it is lit.
// An element is a frame.

#include <cmath>
#include <cstdint>
#include <memory>
#include <random>
#include <span>
#include <string>
#include <vector>

#include <glm/ext/matrix_transform.hpp>
#include <glm/vec3.hpp>
#include <texgen/linear.hpp>
#include <texgen/projector.hpp>
#include <texgen/scene.hpp>
#include <texgen/texcoord.hpp>

#include "bench.hpp"

namespace bench {

namespace {

using Indices = std::vector<std::uint32_t>;

std::string grouped(std::size_t count) {
    return count < 1000 ? std::to_string(count) : std::to_string(count / 1000) + " 000";
}

// Objects of about a unit on a plain, as dense whatever their number, and projectors above it.
class Plain {
public:
    Plain(std::size_t objects, std::size_t projectors) : side_(std::sqrt(static_cast<double>(objects))) {
        for (std::size_t i = 0; i < objects; ++i) {
            const glm::vec3 half(between(0.2, 0.6), between(0.2, 0.6), between(0.2, 0.6));
            bounds_.push_back({-half, half});
            models_.push_back(model());
        }
        for (std::size_t i = 0; i < projectors; ++i) projectors_.push_back(spot());
        update({}, {});
    }

    texgen::SceneWork update(const Indices& objects, const Indices& projectors) {
        return scene_.update({models_, bounds_, projectors_}, {objects, projectors});
    }

    // So many of them move, each time others: the objects a step, the projectors anywhere.
    void move(std::size_t objects, std::size_t projectors) {
        moved_objects_.clear();
        moved_projectors_.clear();
        for (std::size_t i = 0; i < objects; ++i) {
            next_object_ = (next_object_ + 7919) % models_.size();
            glm::dmat4 moved = models_[next_object_].matrix();
            moved[3] += glm::dvec4(between(-0.5, 0.5), 0, between(-0.5, 0.5), 0);
            models_[next_object_] = texgen::ModelMatrix(moved);
            moved_objects_.push_back(static_cast<std::uint32_t>(next_object_));
        }
        for (std::size_t i = 0; i < projectors; ++i) {
            next_projector_ = (next_projector_ + 1) % projectors_.size();
            projectors_[next_projector_] = spot();
            moved_projectors_.push_back(static_cast<std::uint32_t>(next_projector_));
        }
        update(moved_objects_, moved_projectors_);
    }

    // Without a scene: a T_o and a question for every pair.
    std::size_t ask_every_pair() const {
        std::size_t lit = 0;
        for (std::size_t o = 0; o < models_.size(); ++o) {
            for (const texgen::Projector& projector : projectors_) {
                const texgen::ObjectTexgen texgen = texgen::object_linear(projector, models_[o]);
                lit += coverage(texgen, texgen::whole_texture(), bounds_[o]) != texgen::Coverage::outside;
            }
        }
        return lit;
    }

    // The first of them light everything, in parallel rays; the others nothing.
    void light_by(std::size_t bright) {
        Indices all;
        const double half = 2.0 * side_;
        const texgen::OrthographicLens lens{-half, half, -half, half, 0.1, 100.0};
        for (std::size_t i = 0; i < projectors_.size(); ++i) {
            const texgen::Aim down{{0, 20, 0}, {0.001 * static_cast<double>(i), 0, 0}, {0, 0, 1}};
            const texgen::Aim up{{0, 20, 0}, {0.001 * static_cast<double>(i), 40, 0}, {0, 0, 1}};
            projectors_[i] = i < bright ? texgen::make_projector(lens, down, texgen::opengl).value()
                                        : texgen::make_projector(narrow, up, texgen::opengl).value();
            all.push_back(static_cast<std::uint32_t>(i));
        }
        update({}, all);
    }

    const texgen::Scene& scene() const { return scene_; }
    std::size_t object_count() const { return models_.size(); }
    std::size_t projector_count() const { return projectors_.size(); }

private:
    static constexpr texgen::PerspectiveLens narrow{
        .fovy = texgen::degrees(30), .aspect = 1, .z_near = 0.1, .z_far = 100};

    double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }

    texgen::ModelMatrix model() {
        const glm::dmat4 place =
            glm::translate(glm::dmat4(1.0), glm::dvec3(between(-side_, side_), 0.5, between(-side_, side_)));
        return texgen::ModelMatrix(glm::rotate(place, between(0, 6.28), glm::dvec3(0, 1, 0)));
    }
    texgen::Projector spot() {
        const glm::dvec3 position(between(-side_, side_), between(4, 8), between(-side_, side_));
        const glm::dvec3 target(position.x + between(-3, 3), 0, position.z + between(-3, 3));
        return texgen::make_projector(narrow, {position, target, {0.1, 1, 0.2}}, texgen::opengl).value();
    }

    std::mt19937 random_{11};
    double side_;
    std::vector<texgen::ModelMatrix> models_;
    std::vector<texgen::Box> bounds_;
    std::vector<texgen::Projector> projectors_;
    texgen::Scene scene_;
    Indices moved_objects_, moved_projectors_;
    std::size_t next_object_ = 0, next_projector_ = 0;
};

void add_updates(std::size_t objects, std::size_t projectors) {
    const Scene scene{"Scene, " + grouped(objects) + " objects x " + std::to_string(projectors), 1, 1};
    const auto plain = std::make_shared<Plain>(objects, projectors);
    if (objects * projectors <= 300000)
        add_unchecked(scene, "T_o and coverage() of every pair",
                      [plain](std::size_t) { benchmark::DoNotOptimize(plain->ask_every_pair()); });
    add_unchecked(scene, "texgen, all objects move", [plain](std::size_t) { plain->move(plain->object_count(), 0); });
    add_unchecked(scene, "texgen, 1 % of the objects move",
                  [plain](std::size_t) { plain->move(plain->object_count() / 100, 0); });
    add_unchecked(scene, "texgen, a projector moves", [plain](std::size_t) { plain->move(0, 1); });
    add_unchecked(scene, "texgen, nothing moves", [plain](std::size_t) { plain->move(0, 0); });
}

// The update, with 1 % of the objects moving, and the coordinates of 256 points for each lit pair.
void add_lit_shares() {
    constexpr std::size_t points = 256;
    const Scene scene{"Frame, 2 000 objects x 100, of 256 points each", 1, 1};
    for (const std::size_t percent : {100u, 10u, 1u, 0u}) {
        const auto plain = std::make_shared<Plain>(2000, 100);
        plain->light_by(percent);
        const std::string share = percent == 0 ? "the update alone" : std::to_string(percent) + " % lit";
        add_unchecked(scene, "texgen, " + share, [plain](std::size_t) {
            plain->move(plain->object_count() / 100, 0);
            const std::span<const glm::vec3> object(reinterpret_cast<const glm::vec3*>(input(3 * points)), points);
            for (const texgen::LitPair& pair : plain->scene().pairs())
                texgen::project(plain->scene().texgen(pair), texgen::object_space(object), texgen::whole_texture(),
                                {.s = std::span(output(points, 0), points),
                                 .t = std::span(output(points, 1), points),
                                 .r = {},
                                 .lit = std::span(output(points, 2), points)});
        });
    }
}

}  // namespace

void add_scenes() {
    add_updates(2000, 64);
    add_updates(4000, 64);
    add_updates(2000, 128);
    add_updates(10000, 256);
    add_updates(20000, 256);
    add_updates(10000, 512);
    add_lit_shares();
}

}  // namespace bench
