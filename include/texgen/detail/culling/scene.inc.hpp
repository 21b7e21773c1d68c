// What a scene does from frame to frame.

namespace TEXGEN_DETAIL {

// Sets element i, or appends it. Elements come in order; they have no default for resize().
template <class Element>
void put(std::vector<Element>& elements, std::size_t i, const Element& element) noexcept {
    if (i < elements.size())
        elements[i] = element;
    else
        elements.push_back(element);
}
template <class Element>
void truncate(std::vector<Element>& elements, std::size_t count) noexcept {
    if (count < elements.size()) elements.erase(elements.begin() + static_cast<std::ptrdiff_t>(count), elements.end());
}

inline bool have_same_bits(const glm::dmat4& a, const glm::dmat4& b) noexcept {
    return std::memcmp(&a, &b, sizeof a) == 0;
}

// Whether both may be products of the same matrices. NaNs count as equal, as a compiler may take either of two.
inline bool are_same(const glm::dmat4& a, const glm::dmat4& b) noexcept {
    for (glm::length_t i = 0; i < 16; ++i) {
        const double of_a = a[i / 4][i % 4], of_b = b[i / 4][i % 4];
        if (!(of_a == of_b || (of_a != of_a && of_b != of_b))) return false;
    }
    return true;
}

}  // namespace TEXGEN_DETAIL

namespace TEXGEN_NAMESPACE_COMPILER {

inline Scene::Scene(DepthMapping depth) noexcept : depth_(depth) {}

// Not inlined, so that one copy rounds alike wherever it is called.
TEXGEN_APART inline Scene::Prepared::Prepared(const Projector& projector, const TextureRegion& slide,
                                              DepthMapping depth) noexcept
    : texture_from_eye(detail::texture_from_projector_eye(projector, slide, depth)),
      view(projector.view),
      region(slide),
      forms(texture_from_eye.matrix(), view.matrix(), region) {}

inline SceneWork Scene::update(const SceneView& view, const SceneChanges& changes) noexcept {
    SceneWork work;
    const std::size_t objects = (std::min)(view.models.size(), view.bounds.size());
    const std::size_t projectors =
        view.regions.empty() ? view.projectors.size() : (std::min)(view.projectors.size(), view.regions.size());
    TEXGEN_ASSERT(view.models.size() == view.bounds.size());
    TEXGEN_ASSERT(view.regions.empty() || view.regions.size() == view.projectors.size());
    const auto region_of = [&](std::size_t i) { return view.regions.empty() ? whole_texture() : view.regions[i]; };

    objects_.begin(changes.objects, objects);
    projectors_.begin(changes.projectors, projectors);
    TEXGEN_ASSERT(is_as_it_was(view, projectors, region_of));
    if (objects_.changed().empty() && projectors_.changed().empty()) return work;

    tree_.change(objects_.changed(), objects, [&](std::uint32_t i) {
        return i < objects ? detail::world_bounds(view.models[i].matrix(), view.bounds[i])
                           : detail::WorldBounds::none();
    });
    for (const std::uint32_t i : projectors_.changed()) {
        if (i >= projectors) continue;
        detail::put(prepared_, i, Prepared(view.projectors[i], region_of(i), depth_));
    }
    eye_texgens_.reserve(prepared_.capacity());
    detail::truncate(prepared_, projectors);

    drop_changed_pairs();
    const std::size_t kept = pairs_.size();
    std::size_t visits = 0, tested_in_visits = 0;
    for (std::uint32_t p = 0; p < projectors; ++p) {
        const bool is_changed = projectors_.is_changed(p);
        const std::size_t tested = tree_.visit(prepared_[p].forms, is_changed, [&](std::uint32_t o, bool is_inside) {
            if (!is_changed && !objects_.is_changed(o)) return;
            ++work.pairs_tested;
            add_pair(o, p, view.models[o], view.bounds[o], is_inside, work);
        });
        work.bounds_tested += tested;
        if (!is_changed) continue;
        ++visits;
        tested_in_visits += tested;
    }
    merge_pairs(kept);
    tree_.sort_for(visits, tested_in_visits);
    objects_.end();
    projectors_.end();
    return work;
}

inline std::span<const LitPair> Scene::pairs_of(std::uint32_t object) const noexcept {
    const LitPair* const end = pairs_.data() + pairs_.size();
    const LitPair* const first =
        std::partition_point(pairs_.data(), end, [=](const LitPair& pair) { return pair.object < object; });
    return {first, std::partition_point(first, end, [=](const LitPair& pair) { return pair.object == object; })};
}

inline std::size_t Scene::update_eye(const CameraPose& world_from_eye) noexcept {
    const bool camera_moved = !camera_ || !detail::have_same_bits(camera_->matrix(), world_from_eye.matrix());
    camera_ = world_from_eye;
    std::size_t computed = 0;
    for (std::size_t i = 0; i < prepared_.size(); ++i) {
        Prepared& projector = prepared_[i];
        if (!camera_moved && projector.has_eye_texgen) continue;
        detail::put(eye_texgens_, i, projector.texture_from_eye * (projector.view * world_from_eye));
        projector.has_eye_texgen = true;
        ++computed;
    }
    detail::truncate(eye_texgens_, prepared_.size());
    return computed;
}

bool Scene::is_as_it_was(const SceneView& view, std::size_t projectors, const auto& region_of) const noexcept {
    for (std::size_t i = 0; i < (std::min)(view.models.size(), view.bounds.size()); ++i) {
        if (objects_.is_changed(i)) continue;
        if (!(tree_[i] == detail::world_bounds(view.models[i].matrix(), view.bounds[i]))) return false;
    }
    for (std::size_t i = 0; i < projectors; ++i) {
        if (projectors_.is_changed(i)) continue;
        const Prepared now(view.projectors[i], region_of(i), depth_);
        const Prepared& then = prepared_[i];
        if (!detail::are_same(now.texture_from_eye.matrix(), then.texture_from_eye.matrix()) ||
            !detail::are_same(now.view.matrix(), then.view.matrix()))
            return false;
    }
    return true;
}

inline void Scene::drop_changed_pairs() noexcept {
    std::size_t kept = 0;
    for (const LitPair& pair : pairs_) {
        if (objects_.is_changed(pair.object) || projectors_.is_changed(pair.projector))
            free_.push_back(pair.texgen);
        else
            pairs_[kept++] = pair;
    }
    detail::truncate(pairs_, kept);
}

// Makes room for all that a pair may need, and allocates only when there are more pairs than ever.
inline void Scene::reserve_a_pair() noexcept {
    if (pairs_.size() < pairs_.capacity()) return;
    const std::size_t count = std::max<std::size_t>(16, 2 * pairs_.size());
    pairs_.reserve(count);
    new_.reserve(count);
    texgens_.reserve(count);
    free_.reserve(count);
}

inline void Scene::add_pair(std::uint32_t object, std::uint32_t projector, const ModelMatrix& model, const Box& box,
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
    detail::put(texgens_, place, texgen);
    pairs_.push_back({object, projector, lit, place});
}

// Sorts the new pairs, from `kept` on, and merges them with the old from the end on.
inline void Scene::merge_pairs(std::size_t kept) noexcept {
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

}  // namespace TEXGEN_NAMESPACE_COMPILER
