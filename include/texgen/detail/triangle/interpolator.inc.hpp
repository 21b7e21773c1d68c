// Takes a triangle's tiles from one tier to the next. Included by interpolate.hpp.

namespace TEXGEN_DETAIL_BUILD {

// Interpolates up to two coordinates, and the mask, of a triangle into the caller's arrays.
template <class CompiledWhereCalled = void>
class TileInterpolator {
public:
    static constexpr int scratch_width = 512;

    // For the coordinates of these planes: s and t, of which one that only the mask needs has no output; or one alone
    // in both places, which goes to out.s. `in_doubt` is the rectangle's, for all of its outputs.
    TEXGEN_APART TileInterpolator(const TriangleFunctions& triangle, const PlaneOf<Double2>& planes, const Tile& rect,
                                  RectInDoubt& in_doubt, glm::length_t first, glm::length_t second,
                                  const Texcoords& out) noexcept
        : triangle_(triangle),
          rect_(rect),
          count_(first == second ? 1 : 2),
          coordinate_{first, second},
          planes_(&planes),
          in_doubt_(in_doubt),
          output_{out.s, out.t},
          lit_(out.lit) {}

    // Leaves the mask as it is, which is known already.
    void leave_mask() noexcept { lit_ = {}; }

    TEXGEN_APART Corners corners_at(const Tile& tile) noexcept {
        Corners at = corners_of(triangle_.planes, *planes_, triangle_.q, tile);
        if (!at.all_behind() && at.cancel() &&
            cancel_beyond_zeros(at, triangle_.planes, coordinate_[0], coordinate_[1], tile))
            take_corners(at, close_ramps(tile));
        return at;
    }

    TEXGEN_APART void interpolate(const Tile& tile, const Plan* plan) noexcept {
        const Corners at = corners_at(tile);
        interpolate(tile, at, plan != nullptr ? *plan : plan_without_survey(tile, at));
    }

    TEXGEN_APART void interpolate(const Tile& tile, const Corners& at, const Plan& plan) noexcept {
        whole_ = tile;
        whole_at_ = &at;
        doubtful_.drop();
        triangle_.tolerance == 0.0 ? fill_exact(tile, at) : fill(tile, at, plan);
    }

    // Fills a tile of at most one unit, well in front, of which doubles leave a fragment in doubt.
    TEXGEN_RARE void interpolate_from_doubt(const Tile& tile) noexcept {
        const Corners at = corners_of(triangle_.planes, *planes_, triangle_.q, tile);
        TileJob job = make_job(tile, at);
        fill_from_doubt(tile, at, job, job.unit_at(0, 0));
    }

    // Fills a tile in strips of a width that the scratch arrays hold.
    void interpolate_in_strips(const Tile& tile, const Plan& plan) noexcept {
        Tile strip = tile;
        for (strip.width = scratch_width; strip.x < tile.x + tile.width; strip.x += scratch_width) {
            const std::int64_t rest = tile.x + tile.width - strip.x;
            if (rest < strip.width) strip.width = static_cast<int>(rest);
            interpolate(strip, corners_at(strip), plan);
        }
    }

private:
    TEXGEN_RARE void fill(const Tile& tile, int longest) noexcept {
        const Corners at = corners_at(tile);
        if (are_floats_apart(at.largest_quotient())) return fill_exact(tile, at);
        Plan plan = plan_without_survey(tile, at);
        if (plan.chunk > longest) plan.chunk = 0;
        fill(tile, at, plan);
    }

    // Whether rounding a quotient of such a size to float alone errs by more than the tolerance: then no chunk that has
    // it can be certified.
    TEXGEN_RARE bool are_floats_apart(const Double2& quotient) const noexcept {
        const Double2 rounded = quotient * unit_roundoff_float;
        return !(larger(rounded[0], rounded[1]) < triangle_.tolerance);
    }

    void fill(const Tile& tile, const Corners& at, const Plan& plan) noexcept {
        // No chunk is certified of a tile whose least quotient is so large; and few chunks do not repay the attempt if
        // their largest one is.
        if (plan.chunk != 0 && plan.steps == StepRule::undecided &&
            are_floats_apart(tile.count() > Corners::few ? at.least_quotient() : at.largest_quotient()))
            return fill_exact(tile, at);
        if (at.is_well_in_front())
            return plan.chunk != 0 ? fill_polynomial(tile, at, plan) : fill_float_divided(tile, at);
        split(tile, at);
    }

    // The functions in two doubles, made for the whole rectangle when a tile first needs them.
    TEXGEN_APART CloseRamps close_ramps(const Tile& tile) noexcept {
        if (!in_doubt_.planes) in_doubt_.planes.make(triangle_.planes, rect_);
        return in_doubt_.planes->ramps(coordinate_[0], coordinate_[1], tile);
    }

    // What a tile in doubt begins with: the functions in two doubles if these are made already, else the planes as they
    // are.
    TEXGEN_APART DoubtfulFunctions functions_of(const Tile& tile, const Corners& at) noexcept {
        DoubtfulFunctions result;
        result.tolerance = triangle_.tolerance;
        result.are_close = static_cast<bool>(in_doubt_.planes);
        result.are_close ? take_close(tile, result, false) : take_planes(at, result);
        result.are_sums_first = result.are_close;
        return result;
    }

    // The functions in two doubles; where their terms cancel, or leave doubt, from exact growths, which cost as much as
    // one exact fragment.
    TEXGEN_APART void take_close(const Tile& tile, CloseFunctions& functions, bool leave_doubt) noexcept {
        CloseRamps ramps = close_ramps(tile);
        const auto [first, second] = coordinate_;
        if ((leave_doubt || ramps.cancel()) && !in_doubt_.planes->are_exact(first, second)) {
            take_exact_growths(triangle_.planes, first, second, *in_doubt_.planes);
            ramps = close_ramps(tile);
        }
        ramps.copy_to(functions);
    }

    TEXGEN_RARE void add_residues(const Tile& tile, DoubtfulFunctions& functions) noexcept {
        if (!in_doubt_.residues) in_doubt_.residues.make(triangle_.planes, rect_);
        for (std::size_t k = 0; k < 3; ++k)
            in_doubt_.residues->add_to(functions.function[k], k == CloseFunctions::q ? 3 : coordinate_[k], tile);
        functions.have_residues = true;
    }

    static constexpr int few_ties = 16;
    // Adds to what is known of the functions; false where there is no more. Residues come first where many are in
    // doubt, as with ties. They are enough, without two doubles, in tiles of few fragments, where sums in double decide
    // ties already, and where sums in two doubles would not.
    TEXGEN_RARE bool sharpen(const Tile& tile, DoubtfulFunctions& functions, int fragments) noexcept {
        const bool have_both = functions.are_close && functions.have_residues;
        if (have_both && (in_doubt_.planes->are_exact(coordinate_[0], coordinate_[1]) || are_few(fragments, tile)))
            return false;
        bool are_enough = false;
        if (!functions.have_residues && (functions.are_close || are_many(fragments, tile))) {
            add_residues(tile, functions);
            are_enough = functions.adds_residues_first && !functions.are_close && let_residues_decide(functions) &&
                         (tile.count() < few_ties || are_decided_by_sums(functions, 1.0) ||
                          !are_decided_by_sums(functions, 0x1p-46));
        }
        if (!are_enough && (have_both || !functions.are_close)) {
            take_close(tile, functions, have_both);
            functions.are_close = true;
        }
        functions.are_sums_first = functions.are_close || are_decided_by_sums(functions, 1.0);
        return true;
    }

    // The first of these fragments of a unit.
    TEXGEN_RARE static Tile first_of(const Tile& tile, const TileJob::Unit& unit, std::uint64_t fragments) noexcept {
        const int i = std::countr_zero(fragments), width = unit.x_end - unit.x_begin;
        return {tile.x + unit.x_begin + i % width, tile.y + unit.y_begin + i / width, 1, 1};
    }

    // Decides the fragments of a unit that are asked for: with what is known of the functions, with more while any
    // stays in doubt, and the last ones one by one: a few at once where that was in vain before, or where they are on a
    // side. Returns whether all of 64 were in doubt at first.
    TEXGEN_APART bool fill_closely(const Tile& tile, const TileJob& job, DoubtfulFunctions& functions,
                                   const TileJob::Unit& unit, std::uint64_t asked = ~std::uint64_t{0}) noexcept {
        // A row's last vector may be in doubt beyond it.
        const int size = (unit.x_end - unit.x_begin) * (unit.y_end - unit.y_begin);
        asked &= ~std::uint64_t{0} >> (TileJob::unit_size - size);
        const bool is_vain = functions.are_vain && are_few(std::popcount(asked), tile);
        std::uint64_t doubtful = is_vain ? asked : kernels_.fill_closely(job, functions, unit, asked);
        const bool are_all = doubtful == ~std::uint64_t{0};
        const auto are_on_side = [&] {
            return are_few(std::popcount(doubtful), tile) &&
                   ExactFragment::is_on_side(triangle_.planes, first_of(tile, unit, doubtful));
        };
        while (doubtful != 0 && !are_on_side() && sharpen(tile, functions, std::popcount(doubtful)))
            doubtful = kernels_.fill_closely(job, functions, unit, doubtful);
        functions.are_vain |= doubtful != 0;
        for (; doubtful != 0; doubtful &= doubtful - 1) fill_one(first_of(tile, unit, doubtful));
        return are_all;
    }

    // Exact sums of a single fragment cost less than two doubles and residues do, which pay where a tile shares them.
    bool is_one() const noexcept { return rect_.count() == 1; }

    // Clears a tile behind. Of any other, what is next to q = 0 is decided closely, and what comes before and after
    // that is filled as a tile of its own.
    TEXGEN_RARE void split(const Tile& tile, const Corners& at) noexcept {
        if (at.all_behind()) return clear(tile);
        if (tile.count() <= TileJob::unit_size) return fill_closely(tile);
        const Stretch stretch = at.next_to_zero(tile);
        for (std::size_t i = 0; i < 3; ++i) {
            const Tile part = stretch.part(tile, i);
            if (part.count() == 0) continue;
            if (i == 1)
                fill_closely(part);
            else
                fill(part, part.count() > Corners::few ? longest_chunk : 0);
        }
    }

    // Fills a tile in double, from the first unit on, or from a given one.
    TEXGEN_APART void fill_exact(const Tile& tile, const Corners& at, const TileJob::Unit* from = nullptr) noexcept {
        if (!at.may_share_divisions()) return split(tile, at);
        TileJob job = make_job(tile, at);
        const Double2 largest = at.largest_quotient();
        const Double2 error = at.quotient_error(largest);
        // The float next to a quotient in double errs by 2^-24 of it more, half an ulp, or by what is flushed to zero.
        const Double2 written = error * 1.001 + (largest * (1.0001 * unit_roundoff_float) + 0x1p-125);
        TEXGEN_FOR (std::size_t k = 0; k < 2; ++k)
            job.quotient_error[k] = written[k] <= triangle_.tolerance ? 0.0 : error[k];
        // Less than a unit does not repay the search for its least quotient.
        job.ulps = tile.count() < TileJob::unit_size ? 0 : at.ulps_of_quotients();
        TileJob::Unit unit = from == nullptr ? job.unit_at(0, 0) : *from;
        std::uint64_t doubtful = 0;
        unit = fill_units(kernels_, job, unit, 16 * TileJob::unit_size, doubtful);
        if (job.is_done(unit)) return;
        fill_from_doubt(tile, at, job, unit, doubtful);
    }

    TEXGEN_RARE void fill_from_doubt(const Tile& tile, const Corners& at, TileJob& job, const TileJob::Unit& from,
                                     std::uint64_t doubtful = ~std::uint64_t{0}) noexcept {
        TileJob::Unit unit = from;
        // Where a plane is all zeros fill_around() has left its numerator out.
        for (std::size_t k = 0; k < count_; ++k)
            if (planes_->magnitude.dx[k] + planes_->magnitude.dy[k] != 0.0)
                if (const Stretch zeros = zeros_of(triangle_.planes, coordinate_[k], tile); zeros.end != 0)
                    return fill_around(tile, zeros, k);
        if (is_one()) return fill_one(tile);
        DoubtfulFunctions functions = functions_of(tile, at);
        functions.adds_residues_first = true;
        // For few fragments it takes less to decide them by residues than to see whether their quotients are exact.
        if (is_constant(functions.function[CloseFunctions::q].high) && sharpen(tile, functions, TileJob::unit_size) &&
            tile.width + tile.height > 4 && take_exact_quotients(functions, job))
            unit = fill_units(kernels_, job, unit, TileJob::unit_size, doubtful);
        // Doubt comes in runs. So several units are decided closely before doubles are tried again: four after one that
        // was in doubt altogether, and four times as many whenever doubles fail for most of a unit again.
        for (int many = 1; !job.is_done(unit);) {
            const bool may_get_closer = !functions.are_close && are_many(std::popcount(doubtful), tile);
            for (int i = 0; i < many && !job.is_done(unit);
                 ++i, unit = job.unit_after(unit), doubtful = ~std::uint64_t{0})
                if (fill_closely(tile, job, functions, unit, doubtful)) many = many < 4 ? 4 : many;
            if (job.is_done(unit)) return;
            // Two doubles, rounded, err by less than the planes. They replace the planes where these leave much in
            // doubt: at once if they are made already, else after a second failure.
            bool is_closer = may_get_closer && functions.are_close;
            if (!is_closer) {
                unit = fill_units(kernels_, job, unit, TileJob::unit_size, doubtful);
                const bool fails_again = are_many(std::popcount(doubtful), tile);
                is_closer = fails_again && !job.is_done(unit) && !functions.are_close && !functions.have_residues;
                const int size = (unit.x_end - unit.x_begin) * (unit.y_end - unit.y_begin);
                many = 4 * std::popcount(doubtful) > 3 * size ? 4 * many : 1;
            }
            if (is_closer) {
                Corners closer;
                take_corners(closer, close_ramps(tile));
                return fill_exact(tile, closer, &unit);
            }
        }
    }

    // Fills what is before a row or column where numerator k is 0, then those zeros, with that numerator left out, and
    // then what is behind them.
    TEXGEN_RARE void fill_around(const Tile& tile, const Stretch& zeros, std::size_t k) noexcept {
        const auto rest = [&](const Double2& of) {
            return double2_of(k == 0 || count_ == 1 ? 0.0 : of[0], k == 1 || count_ == 1 ? 0.0 : of[1]);
        };
        const auto rest_of = [&](const RampOf<Double2>& of) {
            return RampOf<Double2>{rest(of.base), rest(of.dx), rest(of.dy)};
        };
        const PlaneOf<Double2>* const planes = planes_;
        const PlaneOf<Double2> without{rest_of(planes->value), rest_of(planes->magnitude)};
        for (std::size_t i = 0; i < 3; ++i) {
            const Tile part = zeros.part(tile, i);
            if (part.count() == 0) continue;
            planes_ = i == 1 ? &without : planes;
            fill_exact(part, corners_at(part));
        }
        planes_ = planes;
    }

    // Decides a part of the tile, unit by unit. All such parts share one job and what is known of the functions.
    TEXGEN_RARE void fill_closely(const Tile& tile) noexcept {
        if (is_one()) return fill_one(tile);
        if (tile.count() > TileJob::unit_size) {
            for (const Tile& half : tile.halves(tile.height == 1)) fill_closely(half);
            return;
        }
        const int x = static_cast<int>(tile.x - whole_.x);
        const int y = static_cast<int>(tile.y - whole_.y);
        if (!doubtful_) doubtful_.make(make_job(whole_, *whole_at_), functions_of(whole_, *whole_at_));
        fill_closely(whole_, doubtful_->job, doubtful_->functions, {x, x + tile.width, y, y + tile.height});
    }

    // What is left of rows for a last chunk is divided where it is shorter than a vector.
    TEXGEN_APART void fill_narrow_rest(const Tile& tile, const Corners& at, const Plan& plan, int rest) noexcept {
        const int whole = tile.width - rest;
        if (whole == 0) return fill_exact(tile, at);
        fill_polynomial(part_of(tile, {0, whole, 0, tile.height}), at, plan);
        const Tile narrow = part_of(tile, {whole, tile.width, 0, tile.height});
        fill_exact(narrow, corners_at(narrow));
    }

    TEXGEN_APART void fill_polynomial(const Tile& tile, const Corners& at, const Plan& plan) noexcept {
        const int rest = tile.width % plan.chunk;
        if (rest != 0 && rest < TileJob::longest_vector) return fill_narrow_rest(tile, at, plan, rest);
        TileJob job = make_job(tile, at);
        job.chunk = plan.chunk;
        job.steps = plan.steps;
        job.tolerance = triangle_.tolerance * share_for_chunks;
        job.q_error = at.q_error;
        job.least_q = well_in_front * at.q_error;
        for (std::size_t k = 0; k < 2; ++k) job.numerator_error[k] = at.numerator_error[k];
        fill_chunk_groups(kernels_, job, {0, 0, 0, 0},
                          [&](const TileJob::Unit& refused) { fill_refused(tile, job, refused); });
    }

    // Fills a refused unit in shorter chunks or by divisions, and with it those below, which would be refused as well.
    TEXGEN_RARE void fill_refused(const Tile& tile, TileJob& job, const TileJob::Unit& refused) noexcept {
        Tile rest = part_of(tile, refused);
        const bool touches = refused.x_begin == job.filled.x_end || refused.x_end == job.filled.x_begin;
        if (rest.width < tile.width && (job.filled.x_end == 0 || touches)) {
            rest.height = tile.height - refused.y_begin;
            if (job.filled.x_end == 0 || refused.x_begin < job.filled.x_begin) job.filled.x_begin = refused.x_begin;
            if (refused.x_end > job.filled.x_end) job.filled.x_end = refused.x_end;
        }
        fill(rest, job.chunk - 1);
    }

    TEXGEN_APART void fill_float_divided(const Tile& tile, const Corners& at) noexcept {
        const Double2 error = at.float_divided_error();
        const bool fits = at.is_well_in_front() && at.least_q > 0x1p-20 * at.largest_q &&
                          error[0] <= triangle_.tolerance && error[1] <= triangle_.tolerance;
        if (!fits) return fill_exact(tile, at);
        TileJob job = make_job(tile, at, reciprocal_power_of_two(at.largest_q));
        job.is_in_float = true;
        kernels_.divide(job, {0, tile.width, 0, tile.height});
    }

    // Fills one fragment; every decision is exact.
    TEXGEN_RARE void fill_one(const Tile& at) noexcept {
        const ExactFragment exact(triangle_.planes, at.x, at.y, ExactFragment::Factor::any);
        const ExactFragment::Sum q = exact.function(3);
        const bool in_front = q.sign() > 0;
        float value[2] = {0.0f, 0.0f};
        for (std::size_t k = 0; k < count_; ++k) {
            if (in_front) value[k] = nearest_quotient(exact.function(coordinate_[k]), q);
            if (!output_[k].empty()) output_[k][offset(at.x, at.y)] = value[k];
        }
        const bool is_lit = in_front && is_inside(value[0], value[1], triangle_.lit.min, triangle_.lit.max);
        if (!lit_.empty()) lit_[offset(at.x, at.y)] = is_lit ? 1.0f : 0.0f;
    }

    void clear(const Tile& tile) noexcept {
        for (const std::span<float>& output : {output_[0], output_[1], lit_}) fill_rows(output, rect_, tile, 0.0f);
    }

    // A job with what every kernel needs. `factor` is common to numerators and q.
    TEXGEN_APART TileJob make_job(const Tile& tile, const Corners& at, double factor = 1.0) noexcept {
        TileJob job;  // not {}: all zeros would cost what a row does
        job.width = tile.width;
        job.height = tile.height;
        job.q = {at.q_ramp.base * factor, at.q_ramp.dx * factor, at.q_ramp.dy * factor};
        job.q_is_constant = is_constant(at.q_ramp);
        job.pitch = rect_.width;
        job.is_contiguous = tile.width == rect_.width;
        const auto& [base, dx, dy] = at.numerator_ramp;
        store_ramps({base * factor, dx * factor, dy * factor}, job.numerator);
        const std::size_t first = offset(tile.x, tile.y);
        // One coordinate alone stands in both places.
        TEXGEN_FOR (std::size_t k = 0; k < 2; ++k) {
            const std::span<float>& output = output_[k < count_ ? k : 0];
            job.is_scratch[k] = output.empty();
            job.out[k] = output.empty() ? scratch_[k] : output.data() + first;
            job.is_contiguous = job.is_contiguous && !job.is_scratch[k];
        }
        job.lit = lit_.empty() ? nullptr : lit_.data() + first;
        triangle_.lit.copy_to(job.min, job.max);
        return job;
    }

    static Tile part_of(const Tile& tile, const TileJob::Unit& unit) noexcept {
        return {tile.x + unit.x_begin, tile.y + unit.y_begin, unit.x_end - unit.x_begin, unit.y_end - unit.y_begin};
    }

    std::size_t offset(std::int64_t x, std::int64_t y) const noexcept { return offset_in(rect_, x, y); }

    const TileKernels& kernels_ = chosen<TileKernels>();
    const TriangleFunctions& triangle_;
    Tile rect_;  // whose fragments the outputs have
    std::size_t count_;
    glm::length_t coordinate_[2];
    const PlaneOf<Double2>* planes_;
    RectInDoubt& in_doubt_;
    Tile whole_;  // what is being interpolated, and its corners
    const Corners* whole_at_;
    OnDemand<DoubtfulJob> doubtful_;
    std::span<float> output_[2];
    std::span<float> lit_;
    float scratch_[2][scratch_width];  // coordinates that only the mask needs, a row at a time
};

}  // namespace TEXGEN_DETAIL_BUILD
