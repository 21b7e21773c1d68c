// A job unit by unit, and chunk by chunk, by the kernels of any instruction set, and how much of it is in doubt.
// Included by interpolate.hpp.

namespace TEXGEN_DETAIL_BUILD {

// Whether more than a fourth of a unit is in doubt, which is no chance: those are ties, or the planes are not exact
// enough.
inline bool are_many(int fragments, const Tile& tile) noexcept {
    return fragments > (tile.count() < TileJob::unit_size ? tile.count() : TileJob::unit_size) / 4;
}

// Whether so few are in doubt that exact growths, which cost as much as two exact fragments, would not pay even if each
// unit of the tile had as many.
inline bool are_few(int fragments, const Tile& tile) noexcept {
    return fragments * tile.count() <= 4 * TileJob::unit_size && fragments <= 2;
}

// Fills units from the given one on up to the first with fragments in doubt, which it returns; `doubtful` says which
// fragments. While none is, more and more units are filled at once, of `most` fragments at most; if one of these is in
// doubt, they are filled again, one by one. A job that knows its ulps goes in pairs, but for units in doubt.
inline TileJob::Unit fill_units(const TileKernels& kernels, const TileJob& job, const TileJob::Unit& from, int most,
                                std::uint64_t& doubtful) noexcept {
    TileJob::Unit unit = from;
    for (int size = TileJob::unit_size; !job.is_done(unit);) {
        if (job.ulps != 0 && unit.x_end - unit.x_begin >= TileJob::longest_pair) {
            unit = kernels.divide_in_pairs(job, unit);
            if (job.is_done(unit)) return unit;
        }
        doubtful = kernels.divide(job, unit);
        if (doubtful == 0) {
            if (job.ulps == 0 && size < most) size *= 2;
            unit = job.unit_after(unit, size);
        } else {
            if (size == TileJob::unit_size) return unit;
            most = size = TileJob::unit_size;
            unit = job.unit_at(unit.x_begin, unit.y_begin);
        }
    }
    return unit;
}

// Fills the tile from `first` on. Chunks that no rule serves, a part of one row or whole rows, are handed to `refuse`,
// unless they are filled already.
void fill_chunk_groups(const TileKernels& kernels, const TileJob& job, const TileJob::Unit& first,
                       const auto& refuse) noexcept {
    const int width = job.width, height = job.height;
    const int longest = job.chunk;
    const int whole_chunks = width / longest;
    const int per_row = whole_chunks + (whole_chunks * longest < width ? 1 : 0);
    int chunk = first.x_begin / longest, y = first.y_begin;
    ChunkGroup group;
    RowOutputs row(job, y);
    while (y < height) {
        const std::int64_t left = static_cast<std::int64_t>(height - y) * per_row - chunk;
        const int count = left < group.size ? static_cast<int>(left) : group.size;
        kernels.weigh_chunks(job, group, per_row, y, chunk, count);
        for (int i = 0, end; i < count; i = end) {
            // Successive chunks of one rule are filled at once; over the ends of rows, too, where the rows of the
            // outputs follow one another and consist of whole chunks.
            const StepRule rule = group.rule_of(job, i);
            const bool is_refused = rule == StepRule::none;
            const bool is_seamless = job.is_contiguous && whole_chunks * longest == width && !is_refused;
            const int in_row = whole_chunks > chunk ? whole_chunks - chunk : 1;
            const int most = is_seamless || count - i < in_row || (is_refused && per_row == 1) ? count : i + in_row;
            end = job.steps != StepRule::undecided ? most : i + 1;
            while (end < most && group.rule_of(job, end) == rule) ++end;
            const int begin = chunk * longest;
            if (is_refused) {
                const int rows = per_row == 1 ? end - i : 1;
                const int x_end = begin + (end - i) / rows * job.length_of_chunk(begin);
                if (begin < job.filled.x_begin || x_end > job.filled.x_end) refuse({begin, x_end, y, y + rows});
            } else {
                kernels.fill_chunks(job, row, group, i, end, begin);
            }
            for (chunk += end - i; chunk >= per_row; chunk -= per_row, ++y) row.advance();
        }
    }
}

}  // namespace TEXGEN_DETAIL_BUILD
