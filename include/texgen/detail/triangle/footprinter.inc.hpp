// Footprints over a triangle's tiles, and the body of footprint(). Included by footprint.hpp.

namespace TEXGEN_DETAIL_BUILD {

// The outputs of fragments from `first` on.
inline void take_arrays(FootprintArrays& to, const Footprints& out, std::size_t first) noexcept {
    const auto array = [first](const std::span<float>& span) { return span.empty() ? nullptr : span.data() + first; };
    to = {{array(out.dsdx), array(out.dtdx)},
          {array(out.dsdy), array(out.dtdy)},
          array(out.level),
          array(out.anisotropy),
          {array(out.major_s), array(out.major_t)}};
}

// Fills the caller's arrays with footprints: in vectors where a tile is well in front, else by halves, or one by one.
template <class CompiledWhereCalled = void>
class TileFootprinter {
public:
    TileFootprinter(const FootprintFunctions& functions, const TexelsPerUnit& texels, const Tile& rect,
                    const Footprints& out) noexcept
        : functions_(functions), texels_(texels), rect_(rect), out_(out) {}

    void fill_all(const Tile& tile, const Corners& at) noexcept {
        if (at.all_behind()) return store_rows(tile, nothing());  // behind, or 0 everywhere
        const bool may_be_vectors = at.has_one_error();
        if (may_be_vectors && tile.width <= largest_index && fill_in_vectors(tile, at)) return;
        const int least = may_be_vectors ? 8 : 2;
        if (tile.width <= least && tile.height <= least) return fill_one_by_one(tile);
        // Across the side by which q changes more, so that one of the halves is without a zero of q.
        const double change_across_width = tile.width * std::fabs(at.q_ramp.dx);
        const double change = tile.height * std::fabs(at.q_ramp.dy);
        const bool across_width =
            tile.height <= 1 ||
            (tile.width > 1 && (may_be_vectors ? tile.width >= tile.height : change_across_width >= change));
        for (const Tile& half : tile.halves(across_width)) fill_all(half, corners_at(half));
    }

private:
    static constexpr int largest_index = 1 << 24;  // floats beyond are not every integer

    // The corners of a tile, of q alone.
    Corners corners_at(const Tile& tile) noexcept {
        Corners at;
        take_corners(at, close_q().ramps(tile));
        return at;
    }

    const CloseQ& close_q() noexcept {
        if (!close_q_) close_q_.make(functions_.triangle.planes, rect_);
        return *close_q_;
    }

    static Footprint nothing() noexcept { return {{0.0, 0.0}, {0.0, 0.0}, 0.0, {0.0, 0.0}, 0.0, {0.0, 0.0}}; }

    // False where the range of floats is too small. They hold the numerators in texels relative to the largest, Q
    // relative to its largest, and the factors that undo both.
    bool fill_in_vectors(const Tile& tile, const Corners& at) noexcept {
        const double numerator[2] = {functions_.largest(0, tile), functions_.largest(1, tile)};
        if (larger(numerator[0], numerator[1]) == 0.0) {
            store_rows(tile, texgen::footprint_of({}, {}, texels_));
            return true;
        }
        const double largest = larger(numerator[0] * texels_.s, numerator[1] * texels_.t);
        FootprintJob job;
        take_arrays(job, out_, offset_in(rect_, tile.x, tile.y));
        const bool filters = job.are_filtered();
        if (!(larger(numerator[0], numerator[1]) < 0x1p500) || !(at.largest_q < 0x1p200) || !(at.least_q > 0x1p-200))
            return false;
        if (filters && (!is_usable(texels_) || !(largest > 0x1p-500))) return false;

        const double q_scale = reciprocal_power_of_two(at.largest_q);
        const double q_scale_squared = q_scale * q_scale;
        const double texel_scale = reciprocal_power_of_two(largest);
        const auto scaled = [](const FootprintJob::Slope& terms, double factor) {
            return FootprintJob::Slope{terms.dx * factor, terms.dy * factor, terms.twist * factor};
        };
        job.width = tile.width;
        job.height = tile.height;
        job.q = {at.q_ramp.base * q_scale, at.q_ramp.dx * q_scale, at.q_ramp.dy * q_scale};
        job.derivatives_in_float = float_fits(tile, at, numerator);
        job.pitch = rect_.width;
        for (std::size_t k = 0; k < 2; ++k) {
            const FootprintJob::Slope first = functions_.at_first(k, tile);
            job.slope[k] = scaled(first, q_scale_squared);
            if (filters) job.texels[k] = scaled(first, (k == 0 ? texels_.s : texels_.t) * texel_scale);
        }
        if (job.has_derivatives()) kernels_.differentiate(job);
        if (!filters) return true;

        const double back = q_scale_squared / texel_scale;  // from a length of the job to texels, but for 1 / Q^2
        const double determinant = std::fabs(functions_.determinant * texels_.s * texels_.t);
        const double anisotropy_factor = q_scale / (texel_scale * texel_scale * determinant);
        // Normal floats; an infinite factor is right for a J without a determinant alone.
        constexpr double largest_factor = 0x1p126;
        if (!(back < largest_factor * smaller(texels_.s, texels_.t) &&
              back > 0x1p-126 * larger(texels_.s, texels_.t)) ||
            (anisotropy_factor > largest_factor && anisotropy_factor < infinity))
            return false;
        job.filters_in_float = job.derivatives_in_float || float_serves_filters(tile, at, job.texels);
        job.level_offset = static_cast<float>(2 * exponent_of(q_scale) - exponent_of(texel_scale));
        job.anisotropy_factor = static_cast<float>(anisotropy_factor);
        job.major_factor[0] = static_cast<float>(back / texels_.s);
        job.major_factor[1] = static_cast<float>(back / texels_.t);
        for (int row = 0; (row = kernels_.filter(job, row)) < tile.height; ++row)
            fill_one_by_one({tile.x, tile.y + row, tile.width, 1});
        return true;
    }

    // Whether columns of J Q^2 and Q in float are within 2^-19 of themselves, which leaves level, anisotropy and major
    // within 2^-16. With u = 2^-24 base, slope, product and sum of a component N are rounded: u (2 |N| + 2 |twist|
    // width), where |N| is at most about 1; and one of the columns is nowhere shorter than at the first fragment less
    // what the twist takes.
    static bool float_serves_filters(const Tile& tile, const Corners& at,
                                     const FootprintJob::Slope (&texels)[2]) noexcept {
        constexpr double u = 1.001 * unit_roundoff_float;
        const auto length = [](double s, double t) { return std::sqrt(s * s + t * t); };
        const double twist = length(texels[0].twist, texels[1].twist);
        const double least = larger(length(texels[0].dx, texels[1].dx) - tile.height * twist,
                                    length(texels[0].dy, texels[1].dy) - tile.width * twist);
        const double error = 1.5 * u * (4.0 + 2.0 * tile.width * twist);
        const double q_error = u * (2.0 * at.largest_q + 2.0 * tile.width * std::fabs(at.q_ramp.dx));
        return error <= 0x1p-19 * least && q_error <= 0x1p-19 * at.least_q;
    }

    // The error of N/Q^2 in float, with u = 2^-24: base, slope, product and sum of both are rounded, then the
    // reciprocal, its square and the product.
    bool float_fits(const Tile& tile, const Corners& at, const double (&numerator)[2]) const noexcept {
        constexpr double u = 1.001 * unit_roundoff_float;
        const double tolerance = functions_.triangle.tolerance;
        const double q_error = u * (2.0 * at.largest_q + 2.0 * tile.width * std::fabs(at.q_ramp.dx));
        if (!(tolerance > 0.0) || !(q_error < 0x1p-10 * at.least_q)) return false;
        const double per_q_squared = at.reciprocal * at.reciprocal;
        bool fits = true;
        for (std::size_t k = 0; k < 2; ++k) {
            const double twist = std::fabs(functions_.slope[k].value.twist);
            const double error = u * (6.0 * numerator[k] + 2.0 * tile.width * twist) + functions_.error(k, tile) +
                                 2.0 * (q_error + at.q_error) * at.reciprocal * numerator[k];
            const double in_range = numerator[k] / (at.largest_q * at.largest_q);
            fits = fits && in_range < 0x1p60 && 1.01 * error * per_q_squared + 0x1p-80 <= tolerance;
        }
        return fits;
    }

    void fill_one_by_one(const Tile& tile) noexcept {
        for (std::int64_t y = tile.y; y < tile.y + tile.height; ++y) {
            for (std::int64_t x = tile.x; x < tile.x + tile.width; ++x) {
                const double q = q_at(functions_.triangle, x, y, [this]() -> const CloseQ& { return close_q(); });
                const std::optional<Footprint> footprint = footprint_at(functions_, texels_, x, y, q);
                store_rows({x, y, 1, 1}, footprint ? *footprint : nothing());
            }
        }
    }

    void store_rows(const Tile& tile, const Footprint& value) noexcept {
        const struct {
            const std::span<float>& output;
            double number;
        } stores[] = {{out_.dsdx, value.dx.x},       {out_.dtdx, value.dx.y},      {out_.dsdy, value.dy.x},
                      {out_.dtdy, value.dy.y},       {out_.level, value.level},    {out_.anisotropy, value.anisotropy},
                      {out_.major_s, value.major.x}, {out_.major_t, value.major.y}};
        for (const auto& [output, number] : stores) fill_rows(output, rect_, tile, static_cast<float>(number));
    }

    const FootprintKernels& kernels_ = chosen<FootprintKernels>();
    const FootprintFunctions& functions_;
    TexelsPerUnit texels_;
    Tile rect_;
    const Footprints& out_;
    OnDemand<CloseQ> close_q_;
};

// Fills the footprints of a rectangle. False where none of it is lit: nothing is written then, unless `always`.
template <class CompiledWhereCalled = void>
bool footprint_tile(const FootprintFunctions& functions, const TexelsPerUnit& texels, const Tile& tile,
                    const Footprints& out, bool always) noexcept {
    const TileSurvey found = survey(functions.triangle, tile);
    const bool may_be_lit = found.plan.work != Work::nothing;
    if (may_be_lit || always) TileFootprinter<>(functions, texels, tile, out).fill_all(tile, found.at);
    return may_be_lit;
}

// A column is taken as a row of the mirrored triangle, whose derivatives by x are those by y.
template <class CompiledWhereCalled = void>
inline bool footprint_tile(const FootprintSetup& setup, const Tile& tile, Footprints& out,
                           bool always = false) noexcept {
    const FootprintFunctions& functions = Inside::functions(setup);
    const TexelsPerUnit& texels = Inside::texels(setup);
    if (!tile.is_column()) return footprint_tile(functions, texels, tile, out, always);
    std::swap(out.dsdx, out.dsdy);
    std::swap(out.dtdx, out.dtdy);
    return footprint_tile(functions.mirrored(), texels, tile.mirrored(), out, always);
}

}  // namespace TEXGEN_DETAIL_BUILD

namespace TEXGEN_NAMESPACE_BUILD {

template <class CompiledWhereCalled>
bool footprint(const FootprintSetup& setup, const FragmentRect& rect, const Footprints& asked) noexcept {
    Footprints out = asked;
    const std::size_t count = detail::count_of(rect);
    if (count == 0) return false;
    const detail::Tile tile = detail::tile_of(rect);
    if (!detail::drop_unasked(out, count))
        return detail::survey(detail::Inside::functions(setup).triangle, tile).plan.work != Work::nothing;
    return detail::footprint_tile(setup, tile, out);
}

}  // namespace TEXGEN_NAMESPACE_BUILD
