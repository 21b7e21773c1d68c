#pragma once

// Floor 8: many projectors and many objects. From frame to frame a Scene says which object needs anything of which
// projector, and has the texgen matrices for those alone, made anew only when a matrix in them changed.

#include "detail/language.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>

#include "conventions.hpp"
#include "coverage.hpp"
#include "detail/assert.hpp"
#include "detail/culling/bounds_tree.hpp"
#include "linear.hpp"
#include "projector.hpp"
#include "transform.hpp"

namespace TEXGEN_NAMESPACE {

// The engine's arrays, as they are now. An object or a projector is known by its index.
struct SceneView {
    std::span<const ModelMatrix> models;  // M of each object
    std::span<const Box> bounds;          // of each object, in its own space
    std::span<const Projector> projectors;
    std::span<const TextureRegion> regions = {};  // of each projector; none: the whole texture for all
};

// What is not as it was at the last update: objects whose model matrix or bounds changed, projectors whose matrices,
// conventions or region did. In any order; what is named twice changed once. Indices beyond the last update's counts
// are new, those beyond the present ones are gone: neither needs a name. Where another object takes over an index, that
// index changed.
struct SceneChanges {
    std::span<const std::uint32_t> objects = {};
    std::span<const std::uint32_t> projectors = {};
};

// An object on which light of a projector falls, or may fall. `texgen` is the place of its T_o in Scene::texgens().
struct LitPair {
    std::uint32_t object, projector;
    Coverage coverage;  // inside or partial
    std::uint32_t texgen;
};

// What an update did.
struct SceneWork {
    std::size_t bounds_tested = 0;     // world bounds, of objects and of groups of them, against a projector
    std::size_t pairs_tested = 0;      // boxes against a T_o
    std::size_t texgens_computed = 0;  // T_o
};

inline namespace TEXGEN_COMPILER {

// Guarantee: after update() no pair is missing of which a point of the object's closed box is lit by T_o = object_linear()
// of the engine's matrices, and pairs() are those that coverage() of T_o and the box does not call outside, with its
// answer, whatever the numbers are. They are in the order of the objects, and for each in that of the projectors, whatever
// happened before: two scenes that see the same arrays have the same pairs and the same matrices. Nothing of the engine's is
// kept but copies. Memory is allocated only in an update, and only when the number of objects, of projectors or of lit
// pairs exceeds all former ones; noexcept.
// Cost: an update in which nothing changed does nothing. Otherwise only pairs of which a part changed are tested, through
// a tree over the objects' bounds in the world: a changed projector costs what its light is near to, a changed object at
// most one test a projector and level (5 for 10 000 objects), fewer where the light is far from all that changed; what is
// found costs a T_o and a coverage(); and the lit pairs are gone through once, at about a nanosecond each. The tree is put
// into a new order once as many objects changed as there are, a few objects for each that changes: no update does all of
// it, but one that changes or adds as many. Where there are more objects than ever, their memory moves. Memory: 250 bytes
// an object, 850 a projector, 170 a lit pair, up to twice that where they came one by one.
// Bad input: where T_o, as it is computed, or a box is not finite, the pair is partial and kept, as coverage() has it: where
// a product of finite matrices overflows, too. An empty box is never lit. Where exponents are so far apart that coverage()
// might not say (elements beyond 2^+-200, or 2^190 apart), an object meets every projector, a projector every
// object.
// Spans that disagree in size, and an index that names nothing, are asserted; beyond the shortest nothing is
// looked at. What changed without being named stays as it was; with assertions on, that is asserted too, as far as the
// bounds in the world show it.
// Source: Everitt, Projective Texture Mapping: T_o "must be updated every time the model matrix changes".
class Scene {
public:
    explicit Scene(DepthMapping depth = DepthMapping::unit) noexcept : depth_(depth) {}

    SceneWork update(const SceneView& view, const SceneChanges& changes) noexcept {
        SceneWork work;
        const std::size_t objects = (std::min)(view.models.size(), view.bounds.size());
        const std::size_t projectors = view.projectors.size();
        TEXGEN_ASSERT(view.models.size() == view.bounds.size());
        TEXGEN_ASSERT(view.regions.empty() || view.regions.size() == projectors);
        const auto region_of = [&](std::size_t i) {
            return i < view.regions.size() ? view.regions[i] : whole_texture();
        };

        objects_.begin(changes.objects, objects);
        projectors_.begin(changes.projectors, projectors);
        TEXGEN_ASSERT(is_as_it_was(view, region_of));
        if (objects_.changed().empty() && projectors_.changed().empty()) return work;

        tree_.change(objects_.changed(), objects, [&](std::uint32_t i) {
            return i < objects ? detail::world_bounds(view.models[i].matrix(), view.bounds[i])
                               : detail::WorldBounds::none();
        });
        for (const std::uint32_t i : projectors_.changed()) {
            if (i >= projectors) continue;
            put(prepared_, i, Prepared(view.projectors[i], region_of(i), depth_));
        }
        eye_texgens_.reserve(prepared_.capacity());
        cut(prepared_, projectors);

        drop_changed_pairs();
        const std::size_t kept = pairs_.size();
        for (std::uint32_t p = 0; p < projectors; ++p) {
            const bool is_changed = projectors_.is_changed(p);
            if (!is_changed && objects_.changed().empty()) continue;
            work.bounds_tested += tree_.visit(prepared_[p].forms, is_changed, [&](std::uint32_t o, bool is_inside) {
                ++work.pairs_tested;
                add_pair(o, p, view.models[o], view.bounds[o], is_inside, work);
            });
        }
        merge_pairs(kept);
        tree_.forget_changes();
        objects_.end();
        projectors_.end();
        return work;
    }

    std::span<const LitPair> pairs() const noexcept { return pairs_; }

    // The pairs of one object: found by bisection.
    std::span<const LitPair> pairs_of(std::uint32_t object) const noexcept {
        const LitPair* const end = pairs_.data() + pairs_.size();
        const LitPair* const first =
            std::partition_point(pairs_.data(), end, [=](const LitPair& pair) { return pair.object < object; });
        return {first, std::partition_point(first, end, [=](const LitPair& pair) { return pair.object == object; })};
    }

    // T_o of the pairs, each at its own place: those that no pair names are of no meaning. A pair keeps its place until it
    // changes.
    std::span<const ObjectTexgen> texgens() const noexcept { return texgens_; }
    const ObjectTexgen& texgen(const LitPair& pair) const noexcept { return texgens_[pair.texgen]; }

    // Makes T_e = eye_linear() of each projector of the last update, for this camera: of those that changed since, or of all
    // when the camera moved. Returns how many. One matrix of eye_texgens() then serves all objects of a projector.
    std::size_t update_eye(const CameraPose& world_from_eye) noexcept {
        const bool camera_moved = !camera_ || !have_same_bits(camera_->matrix(), world_from_eye.matrix());
        camera_ = world_from_eye;
        std::size_t computed = 0;
        for (std::size_t i = 0; i < prepared_.size(); ++i) {
            Prepared& projector = prepared_[i];
            if (!camera_moved && projector.has_eye_texgen) continue;
            put(eye_texgens_, i, projector.texture_from_eye * (projector.view * world_from_eye));
            projector.has_eye_texgen = true;
            ++computed;
        }
        cut(eye_texgens_, prepared_.size());
        return computed;
    }
    std::span<const EyeTexgen> eye_texgens() const noexcept { return eye_texgens_; }

private:
    // Which indices changed since the last update.
    class Changes {
    public:
        void begin(std::span<const std::uint32_t> named, std::size_t count) noexcept {
            if (count > is_changed_.size()) is_changed_.resize(count, 0);
            changed_.reserve(is_changed_.capacity());
            // New ones first, and in order: they are appended.
            for (std::size_t i = (std::min)(count, count_); i < (std::max)(count, count_); ++i)
                add(static_cast<std::uint32_t>(i));
            for (const std::uint32_t i : named) {
                TEXGEN_ASSERT(i < count || i < count_);
                if (i < count || i < count_) add(i);
            }
            count_ = count;
        }

        void end() noexcept {
            for (const std::uint32_t i : changed_) is_changed_[i] = 0;
            changed_.clear();
        }

        std::span<const std::uint32_t> changed() const noexcept { return changed_; }
        bool is_changed(std::size_t i) const noexcept { return is_changed_[i] != 0; }

    private:
        void add(std::uint32_t i) noexcept {
            if (is_changed_[i] != 0) return;
            is_changed_[i] = 1;
            changed_.push_back(i);
        }

        std::vector<std::uint32_t> changed_;
        std::vector<std::uint8_t> is_changed_;
        std::size_t count_ = 0;
    };

    struct Prepared {
        Prepared(const Projector& projector, const TextureRegion& slide, DepthMapping depth) noexcept
            : texture_from_eye(detail::texture_from_projector_eye(projector, slide, depth)),
              view(projector.view),
              region(slide),
              forms(texture_from_eye.matrix(), view.matrix(), region) {}

        Transform<Texture, ProjectorEye> texture_from_eye;
        ProjectorView view;
        TextureRegion region;
        detail::WorldForms forms;
        bool has_eye_texgen = false;
    };

    // Elements come in order, and have no default.
    template <class Element>
    static void put(std::vector<Element>& elements, std::size_t i, const Element& element) noexcept {
        if (i < elements.size())
            elements[i] = element;
        else
            elements.push_back(element);
    }
    template <class Element>
    static void cut(std::vector<Element>& elements, std::size_t count) noexcept {
        if (count < elements.size())
            elements.erase(elements.begin() + static_cast<std::ptrdiff_t>(count), elements.end());
    }

    static bool have_same_bits(const glm::dmat4& a, const glm::dmat4& b) noexcept {
        return std::memcmp(&a, &b, sizeof a) == 0;
    }

    template <class RegionOf>
    bool is_as_it_was(const SceneView& view, const RegionOf& region_of) const noexcept {
        for (std::size_t i = 0; i < (std::min)(view.models.size(), view.bounds.size()); ++i) {
            if (objects_.is_changed(i)) continue;
            if (!(tree_[i] == detail::world_bounds(view.models[i].matrix(), view.bounds[i]))) return false;
        }
        for (std::size_t i = 0; i < view.projectors.size(); ++i) {
            if (projectors_.is_changed(i)) continue;
            const Prepared now(view.projectors[i], region_of(i), depth_);
            const Prepared& then = prepared_[i];
            if (!have_same_bits(now.texture_from_eye.matrix(), then.texture_from_eye.matrix()) ||
                !have_same_bits(now.view.matrix(), then.view.matrix()))
                return false;
        }
        return true;
    }

    void drop_changed_pairs() noexcept {
        std::size_t kept = 0;
        for (const LitPair& pair : pairs_) {
            if (objects_.is_changed(pair.object) || projectors_.is_changed(pair.projector))
                free_.push_back(pair.texgen);
            else
                pairs_[kept++] = pair;
        }
        cut(pairs_, kept);
    }

    // Room for all that a pair may need until there are more of them.
    void reserve_a_pair() noexcept {
        if (pairs_.size() < pairs_.capacity()) return;
        const std::size_t count = std::max<std::size_t>(16, 2 * pairs_.size());
        pairs_.reserve(count);
        new_.reserve(count);
        texgens_.reserve(count);
        free_.reserve(count);
    }

    void add_pair(std::uint32_t object, std::uint32_t projector, const ModelMatrix& model, const Box& box,
                  bool is_inside, SceneWork& work) noexcept {
        const Prepared& prepared = prepared_[projector];
        const ObjectTexgen texgen = prepared.texture_from_eye * (prepared.view * model);
        ++work.texgens_computed;
        const Coverage lit = is_inside ? Coverage::inside : coverage(texgen, prepared.region, box);
        if (lit == Coverage::outside) return;
        reserve_a_pair();
        auto place = static_cast<std::uint32_t>(texgens_.size());
        if (!free_.empty()) {
            place = free_.back();
            free_.pop_back();
        }
        put(texgens_, place, texgen);
        pairs_.push_back({object, projector, lit, place});
    }

    // Sorts the new pairs, from `kept` on, and merges them with the old from the end on.
    void merge_pairs(std::size_t kept) noexcept {
        const auto precedes = [](const LitPair& a, const LitPair& b) {
            return a.object != b.object ? a.object < b.object : a.projector < b.projector;
        };
        const auto first_new = pairs_.begin() + static_cast<std::ptrdiff_t>(kept);
        std::sort(first_new, pairs_.end(), precedes);
        new_.assign(first_new, pairs_.end());
        std::size_t from_old = kept;
        std::size_t from_new = new_.size();
        for (std::size_t to = pairs_.size(); from_new > 0; --to) {
            const bool old_is_last = from_old > 0 && precedes(new_[from_new - 1], pairs_[from_old - 1]);
            pairs_[to - 1] = old_is_last ? pairs_[--from_old] : new_[--from_new];
        }
    }

    DepthMapping depth_;
    Changes objects_, projectors_;
    detail::BoundsTree tree_;
    std::vector<Prepared> prepared_;
    std::vector<LitPair> pairs_, new_;
    std::vector<ObjectTexgen> texgens_;
    std::vector<std::uint32_t> free_;  // places of texgens_
    std::vector<EyeTexgen> eye_texgens_;
    std::optional<CameraPose> camera_;
};

}  // namespace TEXGEN_COMPILER

}  // namespace TEXGEN_NAMESPACE
