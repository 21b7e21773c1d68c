// What is known of a tile before it is divided, what it gets, and the bodies of TriangleSetup. Included by
// interpolate.hpp.

namespace TEXGEN_DETAIL_BUILD {

// What a tile gets: the work; under a tolerance the length of its chunks (0: none), and the rule that serves them all
// with a bound on the error of s and of t, if there is one (chunks.inc.hpp).
struct Plan {
    Work work;
    int chunk;
    StepRule steps;
    double error[2];
    Coverage sides, depth;  // inside: s and t, or r, need not be compared
};

struct TileSurvey {
    // Sets no more than the corners, in place: zeros, or a copy, would cost what a small tile does.
    TileSurvey(const TriangleFunctions& triangle, const Tile& tile) noexcept
        : at(corners_of(triangle.planes, triangle.st, triangle.q, tile)) {}

    Corners at;
    Plan plan;
    RectInDoubt in_doubt;  // has planes where those of the triangle cancel
};

// Chunks are short where q varies much, so that their ends are not far from their middle. A chunk costs about as much as
// 32 fragments besides those that it has. None is shorter than a vector, but what may be left at the end of a row.
TEXGEN_APART inline int chunk_length(const Corners& at, const Tile& tile) noexcept {
    constexpr int shortest = 64;
    const int width = tile.width;
    const double q = 0.25 * (at.q[0] + at.q[1] + at.q[2] + at.q[3]);
    int longest = longest_chunk;
    while (longest > shortest && std::fabs(at.q_ramp.dx) * longest > 0.5 * q) longest /= 2;
    if (width <= longest) return width;
    const int chunks = (width - 1) / longest + 1;
    constexpr int lanes = TileJob::longest_vector;
    return ((width - 1) / chunks / lanes + 1) * lanes;
}

// A chunk costs as much as some fragments, and the first one, with what chunks need, as much as some tens.
inline bool pays_for_chunks(int width, int height) noexcept {
    return width >= TileJob::longest_vector && static_cast<std::int64_t>(width) * height > 128;
}

// Whether a tile has a shape that is divided in float, where its tolerance allows. Each column of vectors is made ready in
// double once, which pays from four rows on; chunks take less time in long rows, and where a column leaves the cache.
inline bool has_shape_for_float(int width, int height) noexcept {
    if (static_cast<std::int64_t>(width) * height > (width < 64 ? 16384 : 512)) return false;
    return width == 8 ? height % 2 == 0 : width >= 16 && height >= 4 && width <= 8 * height;
}

// Whether a tile goes by the path of small ones. Rows that are shorter than vectors are gathered in a buffer. The more
// fragments a tile has, the likelier one is in doubt in double, and then all are divided again; and in long rows vectors
// that follow one another share a division at less cost. In float there is no doubt.
inline bool is_small(const Tile& tile, double tolerance) noexcept {
    constexpr int most_in_vector = 8;
    const bool is_column = tile.is_column();  // a row
    const int width = is_column ? tile.height : tile.width, height = is_column ? 1 : tile.height;
    if (tolerance != 0.0 && has_shape_for_float(width, height)) return true;
    const int most = width < most_in_vector ? SmallTile::most_in_short_rows : width <= 64 ? 4096 : 512;
    return tile.count() <= most && (tolerance == 0.0 || !pays_for_chunks(width, height));
}

// The plan of a tile that is divided without a survey.
inline Plan plan_without_survey(const Tile& tile, const Corners& at) noexcept {
    return {Work::divide,        pays_for_chunks(tile.width, tile.height) ? chunk_length(at, tile) : 0,
            StepRule::undecided, {},
            Coverage::partial,   Coverage::inside};
}

// The cheapest rule that serves every chunk of a tile well in front, and the error that it leaves; less work than a
// division is said of it then, and affine where a line would do. The bound is that of the kernel with each of its terms
// at its largest. A step of i is i (F_x Q - F Q_x) over the Q at both of its ends, and that difference is constant
// along a row.
inline void choose_steps(Plan& plan, const Corners& at, double tolerance) noexcept {
    const double half = 0.5 * (plan.chunk - 1);
    const double extent = 1.001 * half * std::fabs(at.q_ramp.dx) * at.reciprocal;
    if (!(extent <= 0.25)) return;
    const auto slope_times_q_squared = [&](std::size_t i) {
        const Double2 first = at.numerator_ramp.dx * at.q[i];
        const Double2 second = at.numerator[i] * at.q_ramp.dx;
        return magnitude(first - second) + (magnitude(first) + magnitude(second)) * gamma(8);
    };
    const Double2 reach =
        larger(slope_times_q_squared(0), slope_times_q_squared(2)) * (1.001 * half * at.reciprocal * at.reciprocal);
    const double square = extent * extent, fourth = square * square;
    const Double2 rest =
        of_flags::chunk_error(at.largest_quotient(), reach, at.numerator_error, at.q_error, at.reciprocal, fourth);
    const auto fits = [&](double share) {
        const Double2 error = reach * share + rest;
        plan.error[0] = error[0];
        plan.error[1] = error[1];
        return error[0] <= tolerance && error[1] <= tolerance;
    };
    const bool is_affine = fits(extent);
    if (fits(fourth))
        plan.steps = StepRule::degree4;
    else if (fits(fourth * fourth))
        plan.steps = StepRule::degree8;
    else
        return;
    if (plan.work != Work::affine) plan.work = is_affine ? Work::affine : Work::quadratic;
}

// How much of a tile is between the limits of the region's depth. The planes serve: only leading digits matter.
TEXGEN_APART inline Coverage depth_coverage(const TriangleFunctions& triangle, const Tile& tile) noexcept {
    const Corners at = corners_of(triangle.planes, triangle.planes.plane_twice(2), triangle.q, tile);
    return r_coverage(at, triangle.lit, triangle.tolerance);
}

// Writes the plan in place: a copy would wait for what was just written field by field, as would a comparison of two
// fields.
inline void choose_plan(const TriangleFunctions& triangle, const Tile& tile, const Corners& at, Plan& plan) noexcept {
    plan.work = Work::nothing;
    plan.chunk = 0;
    plan.steps = StepRule::undecided;
    plan.depth = Coverage::inside;
    if (at.all_behind()) return;
    const Coverage sides = st_coverage(at, triangle.lit, triangle.tolerance);
    plan.sides = sides;
    if (sides == Coverage::outside) return;
    Coverage depth = Coverage::inside;
    if (triangle.lit.has_depth) depth = plan.depth = depth_coverage(triangle, tile);
    if (depth == Coverage::outside) return;

    const bool all_inside = sides == Coverage::inside && depth == Coverage::inside;
    plan.work = all_inside ? Work::divide : Work::divide_and_test;
    if (at.is_well_in_front() && is_constant(triangle.q.value)) plan.work = Work::affine;
    const Work without_chunks = plan.work;
    if (triangle.tolerance == 0.0 || !pays_for_chunks(tile.width, tile.height)) return;
    plan.chunk = chunk_length(at, tile);
    if (at.is_well_in_front()) choose_steps(plan, at, triangle.tolerance * share_for_tiles);
    if (has_shape_for_float(tile.width, tile.height)) plan.work = without_chunks;  // whether or not floats serve
}

// Surveys a tile that is no column. What it returns is made in its place.
TEXGEN_APART inline TileSurvey survey_rows(const TriangleFunctions& triangle, const Tile& tile) noexcept {
    TileSurvey found(triangle, tile);
    for (;;) {
        choose_plan(triangle, tile, found.at, found.plan);
        if (found.in_doubt.planes || found.plan.work == Work::nothing || !found.at.cancel() ||
            !cancel_beyond_zeros(found.at, triangle.planes, 0, 1, tile))
            return found;
        found.in_doubt.planes.make(triangle.planes, tile);
        take_corners(found.at, found.in_doubt.planes->ramps(0, 1, tile));
    }
}

// Surveys a tile; a column as the row of the mirrored triangle that interpolate.inc.hpp makes of it.
inline TileSurvey survey(const TriangleFunctions& triangle, const Tile& tile) noexcept {
    return tile.is_column() ? survey_rows(triangle.mirrored(), tile.mirrored()) : survey_rows(triangle, tile);
}

}  // namespace TEXGEN_DETAIL_BUILD

namespace TEXGEN_NAMESPACE_COMPILER {

inline std::optional<TriangleSetup> TriangleSetup::of(const Triangle& triangle, const TextureRegion& region,
                                                      const Tolerance& tolerance) noexcept {
    std::optional<TriangleSetup> setup(std::in_place, Key(), triangle, region, tolerance);
    if (!setup->functions_.planes.is_usable()) setup.reset();
    return setup;
}

inline Work TriangleSetup::work(const FragmentRect& rect) const noexcept {
    if (rect.width <= 0 || rect.height <= 0) return Work::nothing;
    return detail::survey(functions_, detail::tile_of(rect)).plan.work;
}

inline glm::dvec2 TriangleSetup::error_bound(const FragmentRect& rect) const noexcept {
    if (rect.width <= 0 || rect.height <= 0) return {0.0, 0.0};
    const detail::Tile tile = detail::tile_of(rect);
    const detail::TileSurvey found = detail::survey(functions_, tile);
    const detail::Corners& at = found.at;
    const detail::Plan& plan = found.plan;
    if (at.all_behind()) return {0.0, 0.0};
    // A tile that is divided in float errs by the tolerance at most, whatever a polynomial would.
    const bool has_rule =
        plan.steps != detail::StepRule::undecided && !detail::has_shape_for_float(tile.width, tile.height);
    const auto bound = [&](std::size_t k) {
        if (has_rule) return plan.error[k];
        if (!at.all_in_front()) return detail::infinity;
        return detail::larger(functions_.tolerance, detail::half_ulp(at.largest_quotient()[k]));
    };
    return {bound(0), bound(1)};
}

}  // namespace TEXGEN_NAMESPACE_COMPILER
