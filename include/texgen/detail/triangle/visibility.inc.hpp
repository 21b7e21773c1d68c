// A visibility buffer of a batch's triangles: long runs of one id go to set-ups, what is between them to kernels, and
// what these leave in doubt to set-ups again. Included by batch.hpp.

namespace TEXGEN_DETAIL_BUILD {

inline void describe(VisibilityBuffer& buffer, const TriangleBatch& batch, const std::span<const std::uint32_t>& ids,
                     const FragmentRect& rect) noexcept {
    buffer = {ids.data(), static_cast<std::uint32_t>(batch.size()), rect.x, rect.y, rect.width};
}

// What was made of the triangles that were asked for last: a row shares most of them with the one before.
template <class Made>
class Recent {
public:
    // What was made of a triangle; if it is not kept, make() makes it.
    const std::optional<Made>& of(std::uint32_t id, const auto& make) noexcept {
        Known& known = known_[id % size];
        if (known.id != id) {
            known.made = make();
            known.id = id;
        }
        return known.made;
    }

private:
    static constexpr std::size_t size = 16;
    struct Known {
        std::uint32_t id = no_triangle;
        std::optional<Made> made;

        Known() noexcept {}  // without it GCC clears all 16 as a whole, what is not made as well
    };
    Known known_[size];
};

// Those `count` fragments of a rectangle from `first` on: a part of a row, or whole rows.
inline Tile part_of(const FragmentRect& rect, std::size_t first, std::size_t count) noexcept {
    const auto width = static_cast<std::size_t>(rect.width);
    return {rect.x + static_cast<std::int64_t>(first % width), rect.y + static_cast<std::int64_t>(first / width),
            static_cast<int>((std::min)(count, width)), static_cast<int>((count - 1) / width) + 1};
}

// A run of at least so many fragments of one id in a row has a set-up of its own.
inline constexpr std::size_t long_run = 64;

// Calls of_one(first, count) for the long runs of one id within a row, and once for rows that are of one id together,
// and of_any(begin, end) for what is between them. A long run holds a whole probe, wherever it begins, and as much
// beside it, half of that on one side: those few fragments are looked at first.
void for_each_stretch(const std::span<const std::uint32_t>& ids, std::size_t width, const auto& of_one,
                      const auto& of_any) noexcept {
    constexpr std::size_t probe = long_run / 2;
    std::size_t done = 0;
    const auto are_as_before = [&](std::size_t first, std::size_t count) {
        return std::memcmp(&ids[first - 1], &ids[first], count * sizeof ids[0]) == 0;
    };
    for (std::size_t row = 0; row < ids.size(); row += width) {
        const std::size_t end_of_row = row + width;
        for (std::size_t at = row; at + probe <= end_of_row;) {
            const auto is_here = [&](std::size_t place) { return place < end_of_row && ids[place] == ids[at]; };
            std::size_t begin = at;
            const bool is_probe = is_here(at + probe - 1) &&
                                  (is_here(at + probe + probe / 2 - 1) || (at > row && is_here(at - probe / 2))) &&
                                  are_as_before(at + 1, probe - 1);
            while (is_probe && begin > row && is_here(begin - 1)) --begin;
            if (!is_probe || !is_here(begin + long_run - 1)) {
                at += probe;
                continue;
            }
            std::size_t end = at + probe, step = probe;
            for (; end + step <= end_of_row && are_as_before(end, step); step *= 2) end += step;
            for (; step >= probe; step /= 2)
                if (end + step <= end_of_row && are_as_before(end, step)) end += step;
            while (is_here(end)) ++end;
            if (end - begin == width)
                for (; end + width <= ids.size() && are_as_before(end, width); row += width) end += width;
            at = end;
            if (end - begin < long_run) continue;
            if (done < begin) of_any(done, begin);
            done = end;
            of_one(begin, end - begin);
        }
    }
    if (done < ids.size()) of_any(done, ids.size());
}

// Calls run(triangle, row part, first fragment) for the runs of one id in a row among `count` fragments from `first`
// on, where is_wanted(fragment).
void for_each_run(const std::span<const std::uint32_t>& ids, const FragmentRect& rect, std::size_t first,
                  std::size_t count, const auto& is_wanted, const auto& run) noexcept {
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

// Has a kernel fill the fragments of a visibility buffer from `begin` to `end`, and calls run() as above for the runs
// that it leaves in doubt.
void fill_buffer(auto kernel, auto& job, const FragmentRect& rect, std::size_t begin, std::size_t end,
                 const auto& run) noexcept {
    job.count = end;
    for (Undecided doubt = kernel(job, begin); doubt.begin < end;) {
        const std::size_t left = (std::min)(exact_block, end - doubt.begin);
        const auto is_doubtful = [&](std::size_t i) { return (doubt.values >> (i - doubt.begin) & 1u) != 0; };
        for_each_run({job.ids, end}, rect, doubt.begin, left, is_doubtful, run);
        doubt = kernel(job, doubt.begin + left);
    }
}
template <class CompiledWhereCalled = void>
void interpolate_ids(const TriangleBatch& batch, FragmentsJob& job, const FragmentRect& rect, std::size_t begin,
                     std::size_t end, const Texcoords& out) noexcept {
    const auto run = [&](std::uint32_t id, const Tile& part, std::size_t first) {
        interpolate_apart(set_up(batch, id), part, subspans(out, first, static_cast<std::size_t>(part.width)));
    };
    fill_buffer(chosen<BatchKernels>().divide_fragments, job, rect, begin, end, run);
}

// Interpolates a buffer that may have long runs, which go to set-ups. Apart, so that buffers without them need no room
// for these.
template <class CompiledWhereCalled = void>
TEXGEN_APART void interpolate_runs(const TriangleBatch& batch, FragmentsJob& job, const FragmentRect& rect,
                                   const std::span<const std::uint32_t>& ids, const Texcoords& out) noexcept {
    Recent<TriangleSetup> recent;
    for_each_stretch(
        ids, static_cast<std::size_t>(rect.width),
        [&](std::size_t first, std::size_t length) {
            Texcoords here = subspans(out, first, length);
            const std::uint32_t id = ids[first];
            if (id >= batch.size()) return clear(here);
            interpolate_apart(recent.of(id, [&] { return set_up(batch, id); }), part_of(rect, first, length), here);
        },
        [&](std::size_t begin, std::size_t end) { interpolate_ids(batch, job, rect, begin, end, out); });
}

// Gives the kernel of footprints what it needs of a visibility buffer.
inline void describe(BatchFootprintsJob& job, const TriangleBatch& batch, const std::span<const std::uint32_t>& ids,
                     const FragmentRect& rect, const TexelsPerUnit& texels, const Footprints& out) noexcept {
    describe(job, batch, ids, rect);
    job.planes = Inside::planes(batch);
    job.vertices = &Inside::triangle(batch, 0).a.window.x;
    job.count = ids.size();
    job.texels[0] = texels.s;
    job.texels[1] = texels.t;
    for (std::size_t k = 0; k < 2; ++k) job.per_texel[k] = static_cast<float>(1.0 / job.texels[k]);
    take_arrays(job, out, 0);
}

// The footprints of a visibility buffer: of long runs by set-ups, of others in lanes, and by set-ups what these leave.
template <class CompiledWhereCalled = void>
void footprint_ids(const TriangleBatch& batch, const std::span<const std::uint32_t>& ids, const FragmentRect& rect,
                   const TexelsPerUnit& texels, const Footprints& out) noexcept {
    Recent<FootprintSetup> recent;
    // Fills a run by a set-up: if `always`, also where nothing of it is lit; else that is cleared.
    const auto fill_run = [&](std::uint32_t id, const Tile& part, std::size_t first, bool always) {
        Footprints here = subspans(out, first, static_cast<std::size_t>(part.count()));
        if (id >= batch.size()) return clear(here);
        const auto& setup = recent.of(id, [&]() -> std::optional<FootprintSetup> {
            const auto triangle = set_up(batch, id);
            if (!triangle) return std::nullopt;
            return FootprintSetup(*triangle, texels);
        });
        if (!setup || (!footprint_tile(*setup, part, here, always) && !always)) clear(here);
    };
    const auto fill_in_doubt = [&](std::uint32_t id, const Tile& part, std::size_t first) {
        fill_run(id, part, first, true);
    };
    // Whether the kernel may have their reciprocals, times 2^100, in float.
    const bool are_ordinary = texels.s > 0x1p-24 && texels.s < 0x1p24 && texels.t > 0x1p-24 && texels.t < 0x1p24;
    for_each_stretch(
        ids, static_cast<std::size_t>(rect.width),
        [&](std::size_t first, std::size_t length) {
            fill_run(ids[first], part_of(rect, first, length), first, false);
        },
        [&](std::size_t begin, std::size_t end) {
            BatchFootprintsJob job{};
            describe(job, batch, ids, rect, texels, out);
            if (job.are_filtered() && !are_ordinary)
                return for_each_run(
                    ids, rect, begin, end - begin, [](std::size_t) { return true; }, fill_in_doubt);
            fill_buffer(chosen<BatchFootprintKernels>().fill, job, rect, begin, end, fill_in_doubt);
        });
}

}  // namespace TEXGEN_DETAIL_BUILD

namespace TEXGEN_NAMESPACE_BUILD {

template <class CompiledWhereCalled>
void interpolate(const TriangleBatch& batch, const std::span<const std::uint32_t>& ids, const FragmentRect& rect,
                 const Texcoords& asked) noexcept {
    Texcoords out = asked;
    const std::size_t count = detail::count_of(rect);
    if (count == 0) return;
    TEXGEN_ASSERT(ids.size() == count);
    if (ids.size() != count || !detail::drop_unasked(out, count)) return;
    if (batch.size() == 0) return detail::clear(out);
    detail::FragmentsJob job{};
    detail::describe(job, batch, out, count);
    detail::describe(job, batch, ids, rect);
    if (static_cast<std::size_t>(rect.width) < detail::long_run)
        detail::interpolate_ids(batch, job, rect, 0, count, out);
    else
        detail::interpolate_runs(batch, job, rect, ids, out);
}

template <class CompiledWhereCalled>
void footprint(const TriangleBatch& batch, const std::span<const std::uint32_t>& ids, const FragmentRect& rect,
               const TexelsPerUnit& texels, const Footprints& asked) noexcept {
    Footprints out = asked;
    const std::size_t count = detail::count_of(rect);
    if (count == 0) return;
    TEXGEN_ASSERT(ids.size() == count);
    if (ids.size() != count || !detail::drop_unasked(out, count)) return;
    if (batch.size() == 0) return detail::clear(out);
    detail::footprint_ids(batch, ids, rect, texels, out);
}

}  // namespace TEXGEN_NAMESPACE_BUILD
