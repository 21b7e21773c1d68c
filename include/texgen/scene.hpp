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
#include "detail/culling/changes.hpp"
#include "linear.hpp"
#include "primitives.hpp"
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

// What changed since the last update: objects whose model matrix or bounds changed, projectors whose matrices,
// conventions or region did. They may be in any order; what is named twice changed once. Indices beyond the last
// update's counts are new, those beyond the present ones are gone: neither needs a name. Where another object takes
// over an index, that index changed.
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
    std::size_t bounds_tested = 0;     // of a projector against up to eight bounds, of objects or groups
    std::size_t pairs_tested = 0;      // boxes against a T_o
    std::size_t texgens_computed = 0;  // T_o
};

inline namespace TEXGEN_COMPILER {

// Keeps what of a scene is lit by which projector, from frame to frame.
// Guarantee: after update() no pair is missing of which a point of the object's closed box is lit by T_o =
// object_linear() of the engine's matrices, and pairs() are those that coverage() of T_o and the box does not call
// outside, with its answer, whatever the numbers are. T_o is that of texgen(): where a compiler contracts products and
// sums (g++ with FMA does) it may round one of a call elsewhere otherwise. Pairs are in the order of the objects, and
// for each in that of the projectors, whatever happened before: two scenes that see the same arrays have the same pairs
// and the same matrices.
// Nothing of the engine's is kept but copies. Memory is allocated only in an update, and only when the number of
// objects, of projectors or of lit pairs exceeds all former ones; but a copy may allocate until its arrays have grown
// again, and in update_eye(). noexcept.
// Cost: an update in which nothing changed does nothing. Otherwise only pairs of which a part changed are tested,
// eight bounds in the world at once, in trees over those of all objects and of the ones that changed: a changed
// projector costs what its light is near to; any other costs one test, some 15 ns, for up to eight changed objects, and
// a few for more of them (6 for 100 of 5000 among small lights), or one for seven objects where its light is near to
// all. What is found costs a T_o and a coverage(); and the lit pairs are gone through once, at some nanoseconds each.
// The trees are sorted anew as objects change, a few objects for each, and as projectors test more bounds than they
// need to, at a part of that time: no update sorts all, but one that changes as many, or allocates memory for more.
// Memory: 210 bytes an object, 900 to 1500 a projector, 170 to 270 a lit pair, up to twice that where they came one by
// one.
// Bad input: where T_o, as it is computed, or a box is not finite, the pair is partial and kept, as coverage() has it:
// where a product of finite matrices overflows, too. An empty box is never lit. Where exponents are so far apart that
// coverage() might not say (elements beyond 2^+-200, or 2^190 apart), an object meets every projector, a projector
// every object.
// Spans that disagree in size, and an index that names nothing, are asserted; beyond the shortest nothing is
// looked at. Where something changed without being named, its pairs stay as they were, and new ones may be of what it
// was, of what it is, or half of each. With assertions on this is asserted, as far as the bounds in the world show it:
// an update then looks at every object, and takes 50 ns for each.
// Source: Everitt, Projective Texture Mapping: T_o "must be updated every time the model matrix changes".
class Scene {
public:
    explicit Scene(DepthMapping depth = DepthMapping::unit) noexcept;

    // Takes in what changed, and finds the lit pairs anew where it matters.
    SceneWork update(const SceneView& view, const SceneChanges& changes) noexcept;

    std::span<const LitPair> pairs() const noexcept { return pairs_; }

    // Finds the pairs of one object, by bisection.
    std::span<const LitPair> pairs_of(std::uint32_t object) const noexcept;

    // T_o of the pairs, each at its own place: places that no pair names have no meaning. A pair keeps its place until
    // it changes.
    std::span<const ObjectTexgen> texgens() const noexcept { return texgens_; }
    const ObjectTexgen& texgen(const LitPair& pair) const noexcept { return texgens_[pair.texgen]; }

    // Makes T_e = eye_linear() of each projector of the last update, for this camera: for those that changed since, or
    // for all when the camera moved. Returns for how many. One matrix of eye_texgens() then serves all objects of a
    // projector.
    std::size_t update_eye(const CameraPose& world_from_eye) noexcept;
    std::span<const EyeTexgen> eye_texgens() const noexcept { return eye_texgens_; }

private:
    struct Prepared {
        Prepared(const Projector& projector, const TextureRegion& slide, DepthMapping depth) noexcept;

        Transform<Texture, ProjectorEye> texture_from_eye;
        ProjectorView view;
        TextureRegion region;
        detail::WorldForms forms;
        bool has_eye_texgen = false;
    };

    bool is_as_it_was(const SceneView& view, std::size_t projectors, const auto& region_of) const noexcept;
    void drop_changed_pairs() noexcept;
    void reserve_a_pair() noexcept;
    void add_pair(std::uint32_t object, std::uint32_t projector, const ModelMatrix& model, const Box& box,
                  bool is_inside, SceneWork& work) noexcept;
    void merge_pairs(std::size_t kept) noexcept;

    DepthMapping depth_;
    detail::Changes objects_, projectors_;
    detail::BoundsTree tree_;
    std::vector<Prepared> prepared_;
    std::vector<LitPair> pairs_, new_;
    std::vector<ObjectTexgen> texgens_;
    std::vector<std::uint32_t> free_;  // places of texgens_ that no pair has
    std::vector<EyeTexgen> eye_texgens_;
    std::optional<CameraPose> camera_;
};

}  // namespace TEXGEN_COMPILER
}  // namespace TEXGEN_NAMESPACE

#include "detail/culling/scene.inc.hpp"
