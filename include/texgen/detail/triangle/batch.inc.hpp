// The bodies of TriangleBatch, and how its triangles come to their kernels and out of doubt. Included by batch.hpp.

namespace TEXGEN_DETAIL {

// Of what is refused, or no triangle: behind everywhere, without a doubt.
inline BatchPlanes planes_behind() noexcept {
    BatchPlanes result{};
    result.value[BatchPlanes::q] = -1.0;
    return result;
}

// Where vectors leave open whether a triangle has an area, or is refused.
inline BatchPlanes batch_planes(const Triangle& triangle) noexcept {
    BatchPlanes result = planes_behind();
    const TrianglePlanes planes(triangle);
    if (!planes.is_usable()) return result;
    const auto reach_of = [&](glm::length_t axis) {
        return larger(std::fabs(planes.to_b()[axis]), std::fabs(planes.to_c()[axis])) + 8.0;
    };
    const double reach_x = reach_of(0);
    const double reach_y = reach_of(1);
    constexpr std::size_t place[4] = {BatchPlanes::s, BatchPlanes::t, BatchPlanes::r, BatchPlanes::q};
    for (std::size_t k = 0; k < 4; ++k) {
        const Plane plane = planes.plane(static_cast<glm::length_t>(k));
        double* const function = &result.value[place[k]];
        function[0] = plane.value.base;
        function[1] = plane.value.dx;
        function[2] = plane.value.dy;
        function[3] = batch_plane_error *
                      larger(plane.magnitude.base, larger(plane.magnitude.dx * reach_x, plane.magnitude.dy * reach_y));
    }
    const glm::dvec2 origin = planes.corner(0);
    result.value[BatchPlanes::origin] = origin.x;
    result.value[BatchPlanes::origin + 1] = origin.y;
    result.value[BatchPlanes::per_reach] = 1.0 / reach_x;
    result.value[BatchPlanes::per_reach + 1] = 1.0 / reach_y;
    return result;
}

// The outputs of `count` values from `first` on.
template <class Outputs>
Outputs subspans(const Outputs& all, std::size_t first, std::size_t count) noexcept {
    Outputs part = all;
    for_each_output(part, [&](std::span<float>& output) {
        if (!output.empty()) output = output.subspan(first, count);
    });
    return part;
}

void clear(auto& out) noexcept {
    for_each_output(out, [](std::span<float>& output) {
        for (float& value : output) value = 0.0f;
    });
}

// The fragments of all together, or the most of which no array can be.
inline std::size_t count_of(std::span<const FragmentRect> rects) noexcept {
    constexpr std::size_t most = (std::numeric_limits<std::size_t>::max)();
    std::size_t left = most;
    for (const FragmentRect& rect : rects) left -= (std::min)(count_of(rect), left);
    return most - left;
}

inline namespace TEXGEN_BUILD {

inline std::optional<TriangleSetup> set_up(const TriangleBatch& batch, std::size_t triangle) noexcept {
    return TriangleSetup::of(Inside::triangle(batch, triangle), batch.region(), batch.tolerance());
}

// A rectangle of one triangle with fragments, by its own set-up.
template <class CompiledWhereCalled = void>
void interpolate_apart(const std::optional<TriangleSetup>& setup, const Tile& tile, Texcoords out) noexcept {
    if (!setup || interpolate_tile(*setup, tile, out) == Work::nothing) clear(out);
}

// What every kernel is given of a batch.
inline void describe(BatchJob& job, const TriangleBatch& batch, const Texcoords& out, std::size_t count) noexcept {
    job.planes = Inside::planes(batch);
    job.vertices = &Inside::triangle(batch, 0).a.window.x;
    job.tolerance = accepted(batch.tolerance());
    job.out[0] = array_of(out.s, count);
    job.out[1] = array_of(out.t, count);
    job.out[2] = array_of(out.r, count);
    job.lit = array_of(out.lit, count);
    job.count = count;
    const LitTest& lit = Inside::lit(batch);
    lit.copy_to(job.min, job.max);
    job.has_depth = lit.has_depth();
    job.r_min = lit.r_min();
    job.r_max = lit.r_max();
}

// What is made of the triangles that a visibility buffer has asked for last: neighbours share few.
template <class Made>
class Recent {
public:
    // Of a triangle, by make() where it is not known.
    const std::optional<Made>& of(std::uint32_t id, const auto& make) noexcept {
        Known& known = known_[id % batch_block];
        if (known.id != id) {
            known.made = make();
            known.id = id;
        }
        return known.made;
    }

private:
    struct Known {
        std::uint32_t id = no_triangle;
        std::optional<Made> made;
    };
    Known known_[batch_block];
};

inline Tile part_of(const FragmentRect& rect, std::size_t first, std::size_t count) noexcept {
    const auto width = static_cast<std::size_t>(rect.width);
    return {rect.x + static_cast<std::int64_t>(first % width), rect.y + static_cast<std::int64_t>(first / width),
            static_cast<int>(count), 1};
}

// So many fragments of one id in a row pay for a set-up of their own.
inline constexpr std::size_t long_run = 64;

// Calls run(first, count) for the long runs of one id in a row. Each has a whole probe, wherever that begins.
void for_each_long_run(std::span<const std::uint32_t> ids, std::size_t width, const auto& run) noexcept {
    constexpr std::size_t probe = long_run / 2;
    const auto are_one = [&](std::size_t first) {
        return ids[first] == ids[first + probe - 1] &&
               std::memcmp(&ids[first], &ids[first + 1], (probe - 1) * sizeof ids[0]) == 0;
    };
    for (std::size_t row = 0; row < ids.size(); row += width) {
        const std::size_t end_of_row = row + width;
        for (std::size_t at = row; at + probe <= end_of_row;) {
            if (!are_one(at)) {
                at += probe;
                continue;
            }
            const std::uint32_t id = ids[at];
            std::size_t begin = at, end = at + probe;
            while (begin > row && ids[begin - 1] == id) --begin;
            while (end + probe <= end_of_row && ids[end] == id && are_one(end)) end += probe;
            while (end < end_of_row && ids[end] == id) ++end;
            if (end - begin >= long_run) run(begin, end - begin);
            at = end;
        }
    }
}

// Calls run(triangle, row part, first fragment) for the runs of one id in a row among `count` fragments from `first`
// on, of those that is_wanted(fragment).
void for_each_run(std::span<const std::uint32_t> ids, const FragmentRect& rect, std::size_t first, std::size_t count,
                  const auto& is_wanted, const auto& run) noexcept {
    const auto width = static_cast<std::size_t>(rect.width);
    for (std::size_t begin = first; begin < first + count;) {
        std::size_t end = begin + 1;
        const std::size_t row = begin / width;
        const std::size_t end_of_row = (std::min)((row + 1) * width, first + count);
        if (is_wanted(begin)) {
            while (end < end_of_row && ids[end] == ids[begin] && is_wanted(end)) ++end;
            run(ids[begin], part_of(rect, begin, end - begin), begin);
        }
        begin = end;
    }
}

// The fragments of a visibility buffer from `begin` to `end`.
template <class CompiledWhereCalled = void>
void interpolate_ids(const TriangleBatch& batch, FragmentsJob& job, const FragmentRect& rect, std::size_t begin,
                     std::size_t end, const Texcoords& out) noexcept {
    const BatchKernels& kernels = chosen<BatchKernels>();
    job.count = end;
    for (Undecided doubt = kernels.divide_fragments(job, begin); doubt.begin < end;) {
        const std::size_t left = (std::min)(exact_block, end - doubt.begin);
        for_each_run(
            {job.ids, end}, rect, doubt.begin, left,
            [&](std::size_t fragment) { return (doubt.values >> (fragment - doubt.begin) & 1u) != 0; },
            [&](std::uint32_t id, const Tile& part, std::size_t first) {
                interpolate_apart(set_up(batch, id), part, subspans(out, first, static_cast<std::size_t>(part.width)));
            });
        doubt = kernels.divide_fragments(job, doubt.begin + left);
    }
}

// The same of one that may have long runs, which go to set-ups. Apart, so that small ones need no room for these.
template <class CompiledWhereCalled = void>
TEXGEN_APART void interpolate_runs(const TriangleBatch& batch, FragmentsJob& job, const FragmentRect& rect,
                                   std::span<const std::uint32_t> ids, const Texcoords& out) noexcept {
    Recent<TriangleSetup> recent;
    std::size_t done = 0;
    for_each_long_run(ids, static_cast<std::size_t>(rect.width), [&](std::size_t first, std::size_t length) {
        if (done < first) interpolate_ids(batch, job, rect, done, first, out);
        done = first + length;
        Texcoords here = subspans(out, first, length);
        const std::uint32_t id = ids[first];
        if (id >= batch.size()) return clear(here);
        interpolate_apart(recent.of(id, [&] { return set_up(batch, id); }), part_of(rect, first, length), here);
    });
    if (done < ids.size()) interpolate_ids(batch, job, rect, done, ids.size(), out);
}

}  // namespace TEXGEN_BUILD
}  // namespace TEXGEN_DETAIL

namespace TEXGEN_NAMESPACE {
inline namespace TEXGEN_COMPILER {

inline void TriangleBatch::take(std::span<const Triangle> triangles) noexcept {
    using detail::batch_block;
    static_assert(sizeof(Triangle) == 3 * sizeof(detail::BatchVertex::Layout));
    TEXGEN_ASSERT(triangles.size() < no_triangle);
    size_ = triangles.size();
    const std::size_t whole = (size_ + batch_block - 1) / batch_block * batch_block;
    if (whole >= planes_.size()) {  // kernels read beyond the last
        triangles_.resize(whole + 1);
        planes_.resize(whole + 1);
    }
    std::copy(triangles.begin(), triangles.end(), triangles_.begin());
}

template <class CompiledWhereCalled>
void TriangleBatch::set_up() noexcept {
    using detail::batch_block;
    const detail::BatchKernels& kernels = detail::chosen<detail::BatchKernels>();
    for (std::size_t first = 0; first < size_; first += batch_block) {
        unsigned unknown = kernels.set_up(&triangles_[first].a.window.x, &planes_[first]);
        for (std::size_t i = first; unknown != 0 && i < size_; unknown >>= 1, ++i)
            if ((unknown & 1u) != 0) planes_[i] = detail::batch_planes(triangles_[i]);
    }
    planes_[size_] = detail::planes_behind();
}

template <class CompiledWhereCalled>
void TriangleBatch::assign(std::span<const Triangle> triangles) noexcept {
    take(triangles);
    set_up<CompiledWhereCalled>();
}

template <class CompiledWhereCalled>
void TriangleBatch::assign_facing(std::span<const Triangle> triangles, TextureOrigin origin) noexcept {
    take(triangles);
    for (std::size_t i = 0; i < size_; ++i) {
        auto& [a, b, c] = triangles_[i];
        if (facing(a.strq, b.strq, c.strq, origin) == Facing::away) a.clip_w = 0.0f;  // which is refused
    }
    set_up<CompiledWhereCalled>();
}

}  // namespace TEXGEN_COMPILER

inline namespace TEXGEN_BUILD {

template <class CompiledWhereCalled>
void interpolate(const TriangleBatch& batch, std::span<const FragmentRect> rects, Texcoords out) noexcept {
    static_assert(sizeof(FragmentRect) == sizeof(int[4]));
    TEXGEN_ASSERT(rects.size() == batch.size());
    if (rects.size() != batch.size() || rects.empty()) return;
    const std::size_t count = detail::count_of(rects);
    if (!detail::take_computed(out, count)) return;
    detail::TilesJob job{};
    detail::describe(job, batch, out, count);
    job.tiles = reinterpret_cast<const int(*)[4]>(rects.data());
    job.tile_count = rects.size();
    const detail::BatchKernels& kernels = detail::chosen<detail::BatchKernels>();
    std::size_t known = 0;
    std::size_t done = 0;
    for (detail::Undecided doubt = kernels.divide_tiles(job, 0, 0); doubt.begin < rects.size();) {
        for (; known < doubt.begin; ++known) done += detail::count_of(rects[known]);
        for (; known < (std::min)(doubt.begin + detail::batch_block, rects.size()); ++known, doubt.values >>= 1) {
            const std::size_t values = detail::count_of(rects[known]);
            if ((doubt.values & 1u) != 0 && values != 0)
                detail::interpolate_apart(detail::set_up(batch, known), detail::tile_of(rects[known]),
                                          detail::subspans(out, done, values));
            done += values;
        }
        doubt = kernels.divide_tiles(job, known, done);
    }
}

template <class CompiledWhereCalled>
void interpolate(const TriangleBatch& batch, std::span<const std::uint32_t> ids, FragmentRect rect,
                 Texcoords out) noexcept {
    const std::size_t count = detail::count_of(rect);
    if (count == 0) return;
    TEXGEN_ASSERT(ids.size() == count);
    if (ids.size() != count || !detail::take_computed(out, count)) return;
    if (batch.size() == 0) return detail::clear(out);
    detail::FragmentsJob job{};
    detail::describe(job, batch, out, count);
    job.ids = ids.data();
    job.triangles = static_cast<std::uint32_t>(batch.size());
    job.x = rect.x;
    job.y = rect.y;
    job.width = rect.width;
    if (static_cast<std::size_t>(rect.width) < detail::long_run)
        detail::interpolate_ids(batch, job, rect, 0, count, out);
    else
        detail::interpolate_runs(batch, job, rect, ids, out);
}

template <class CompiledWhereCalled>
void footprint(const TriangleBatch& batch, std::span<const std::uint32_t> ids, FragmentRect rect, TexelsPerUnit texels,
               Footprints out) noexcept {
    const std::size_t count = detail::count_of(rect);
    if (count == 0) return;
    TEXGEN_ASSERT(ids.size() == count);
    if (ids.size() != count || !detail::take_computed(out, count)) return;
    detail::Recent<FootprintSetup> recent;
    detail::for_each_run(
        ids, rect, 0, count, [](std::size_t) { return true; },
        [&](std::uint32_t id, const detail::Tile& part, std::size_t first) {
            Footprints here = detail::subspans(out, first, static_cast<std::size_t>(part.width));
            if (id >= batch.size()) return detail::clear(here);
            const auto& setup = recent.of(id, [&]() -> std::optional<FootprintSetup> {
                const auto triangle = detail::set_up(batch, id);
                if (!triangle) return std::nullopt;
                return FootprintSetup(*triangle, texels);
            });
            if (!setup || !detail::footprint_tile(*setup, part, here)) detail::clear(here);
        });
}

}  // namespace TEXGEN_BUILD
}  // namespace TEXGEN_NAMESPACE
