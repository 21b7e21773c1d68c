// The bodies of TriangleBatch: triangles go to kernels, and their doubt to set-ups. Included by batch.hpp.

namespace TEXGEN_DETAIL {

// The functions of a triangle that is refused, or of none: behind everywhere, without doubt.
inline BatchPlanes planes_behind() noexcept {
    BatchPlanes result{};
    result.value[BatchPlanes::q] = -1.0;
    return result;
}

// Those of a triangle of which the kernel leaves open whether it has an area, or is refused: if it is not, all of it is
// in doubt.
inline BatchPlanes planes_in_doubt(const Triangle& triangle) noexcept {
    BatchPlanes result = planes_behind();
    if (TrianglePlanes(triangle).is_usable()) result.value[BatchPlanes::q + 3] = 0x1p400;
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
    for_each_output(out, [](const std::span<float>& output) {
        for (float& value : output) value = 0.0f;
    });
}

// The count of the fragments of all together, or the largest std::size_t, which no array has.
inline std::size_t count_of(const std::span<const FragmentRect>& rects) noexcept {
    constexpr std::size_t most = (std::numeric_limits<std::size_t>::max)();
    std::size_t left = most;
    for (const FragmentRect& rect : rects) left -= (std::min)(count_of(rect), left);
    return most - left;
}

inline namespace TEXGEN_BUILD {

inline std::optional<TriangleSetup> set_up(const TriangleBatch& batch, std::size_t triangle) noexcept {
    return TriangleSetup::of(Inside::triangle(batch, triangle), batch.region(), batch.tolerance());
}

// Interpolates a rectangle, which has fragments, by the triangle's own set-up.
template <class CompiledWhereCalled = void>
void interpolate_apart(const std::optional<TriangleSetup>& setup, const Tile& tile, const Texcoords& out) noexcept {
    if (!setup || interpolate_tile(*setup, tile, out) == Work::nothing) clear(out);
}

// Gives a job what every kernel needs of a batch.
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
    job.has_depth = lit.has_depth;
    job.r_min = lit.r_min;
    job.r_max = lit.r_max;
    const double min[3] = {lit.least(0), lit.least(1), widened(lit.r_min)};
    const double max[3] = {lit.greatest(0), lit.greatest(1), widened(lit.r_max)};
    for (std::size_t k = 0; k < 3; ++k) {
        job.least[k] = finite_min(double2_of(min[k], min[k]))[0];
        job.greatest[k] = finite_max(double2_of(max[k], max[k]))[0];
    }
}

}  // namespace TEXGEN_BUILD
}  // namespace TEXGEN_DETAIL

namespace TEXGEN_NAMESPACE_COMPILER {

inline void TriangleBatch::take(const std::span<const Triangle>& triangles) noexcept {
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
            if ((unknown & 1u) != 0) planes_[i] = detail::planes_in_doubt(triangles_[i]);
    }
    planes_[size_] = detail::planes_behind();
}

template <class CompiledWhereCalled>
void TriangleBatch::assign(const std::span<const Triangle>& triangles) noexcept {
    take(triangles);
    set_up<CompiledWhereCalled>();
}

template <class CompiledWhereCalled>
void TriangleBatch::assign_facing(const std::span<const Triangle>& triangles, TextureOrigin origin) noexcept {
    take(triangles);
    for (std::size_t i = 0; i < size_; ++i) {
        auto& [a, b, c] = triangles_[i];
        if (facing(a.strq, b.strq, c.strq, origin) == Facing::away) a.clip_w = 0.0f;  // which is refused
    }
    set_up<CompiledWhereCalled>();
}

}  // namespace TEXGEN_NAMESPACE_COMPILER

namespace TEXGEN_NAMESPACE_BUILD {

template <class CompiledWhereCalled>
void interpolate(const TriangleBatch& batch, const std::span<const FragmentRect>& rects,
                 const Texcoords& asked) noexcept {
    Texcoords out = asked;
    static_assert(sizeof(FragmentRect) == sizeof(int[4]));
    TEXGEN_ASSERT(rects.size() == batch.size());
    if (rects.size() != batch.size() || rects.empty()) return;
    const std::size_t count = detail::count_of(rects);
    if (!detail::drop_unasked(out, count)) return;
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

}  // namespace TEXGEN_NAMESPACE_BUILD
