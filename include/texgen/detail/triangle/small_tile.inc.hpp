// Small tiles that need no more than one certificate from their corners: no plan, no chunks, no job of many fields.
// Included by interpolate.hpp.

namespace TEXGEN_DETAIL_BUILD {

// Where a tile begins, from the vertex that planes are about, how far it reaches at most, its last column and row.
struct SmallPlace {
    double x, y, reach_x, reach_y, right, bottom;

    SmallPlace(const glm::dvec2& from_a, double width, double height) noexcept
        : x(from_a.x),
          y(from_a.y),
          reach_x(std::fabs(x) + width),
          reach_y(std::fabs(y) + height),
          right(width - 1.0),
          bottom(height - 1.0) {}
};

// A linear function over the tile: at its first fragment, its steps to the last column and row, and a bound on its
// error, see TrianglePlanes::ramp() and error(). A row's product and sums add less than 6 u to its 20 u of the
// magnitude, for which gamma has room.
template <class Number>
struct SmallFunction {
    Number base, right, bottom, error;

    SmallFunction(const PlaneOf<Number>& plane, const SmallPlace& place) noexcept
        : base(plane.value.base + plane.value.dx * place.x + plane.value.dy * place.y),
          right(plane.value.dx * place.right),
          bottom(plane.value.dy * place.bottom),
          error((plane.magnitude.base + plane.magnitude.dx * place.reach_x + plane.magnitude.dy * place.reach_y) *
                gamma(20)) {}
};

// The least and the largest value of a linear function at the corners.
template <class Number>
Number least_of(const Number& base, const Number& right, const Number& bottom) noexcept {
    const Number of_row = smaller(base, base + right);
    return smaller(of_row, of_row + bottom);
}
template <class Number>
Number largest_of(const Number& base, const Number& right, const Number& bottom) noexcept {
    const Number of_row = larger(base, base + right);
    return larger(of_row, of_row + bottom);
}

// q over the tile, and at the corners where it is least and largest. These do not follow function.error: clang++ would
// load the two at once, and a load of what two stores wrote waits for both.
struct SmallDivisor {
    double least, largest;
    SmallFunction<double> function;

    SmallDivisor(const Plane& q, const SmallPlace& place) noexcept : function(q, place) {
        least = least_of(function.base, function.right, function.bottom);
        largest = largest_of(function.base, function.right, function.bottom);
    }

    bool is_far_from_zero() const noexcept {
        return least > larger(0x1p44 * function.error, 0x1p-100) && largest < 0x1p60;
    }
};

// Whether all of the tile is lit by s and t, or certainly a part. The sides are those of coverage_by_sides() with margins
// on both sides of its own, so that nothing is said of a tile of which that says something else.
enum class SmallAnswer { doubt, lit, partly_lit };
inline SmallAnswer ask(const LitTest& lit, double tolerance, const SmallFunction<Double2>& f,
                       const SmallDivisor& divisor) noexcept {
    if (!divisor.is_far_from_zero()) return SmallAnswer::doubt;
    const SmallFunction<double>& q = divisor.function;
    const double written = 2.0 * tolerance * divisor.largest;  // what the tolerance adds to the margins
    Double2 min = double2_of(lit.least(0), lit.least(1));
    Double2 max = double2_of(lit.greatest(0), lit.greatest(1));
    if (!lit.is_narrow) {
        // A side far beyond all quotients and the tolerance may as well stand at several times both, where its margin is no
        // larger than they are. What is lit then is inside by coverage_by_sides(), too, whatever q does in the tile.
        const Double2 largest = magnitude(f.base) + magnitude(f.right) + magnitude(f.bottom);
        const Double2 beyond = (largest * 8.0 + 4.0 * written) * (1.0 / divisor.least) + 1.0;
        min = larger(-beyond, min);
        max = smaller(beyond, max);
        if (!all_less(min, max)) return SmallAnswer::doubt;  // a NaN, or nothing
    }
    const Double2 above[3] = {f.base - min * q.base, f.right - min * q.right, f.bottom - min * q.bottom};
    const Double2 below[3] = {max * q.base - f.base, max * q.right - f.right, max * q.bottom - f.bottom};
    const Double2 least_above = least_of<Double2>(above[0], above[1], above[2]);
    const Double2 least_below = least_of<Double2>(below[0], below[1], below[2]);
    const Double2 size = larger(max, -min);
    const Double2 error = f.error + size * q.error;
    const Double2 most = error * 2.0 + (size * 0x1p-21 + (0x1.1p-124 + 2.01 * tolerance)) * divisor.largest;
    if (all_less(most, smaller(least_above, least_below))) return SmallAnswer::lit;
    const Double2 least = -error + written;
    const bool is_partly_dark = any_less(smaller(least_above, least_below), least);
    const Double2 largest_above = largest_of<Double2>(above[0], above[1], above[2]);
    const Double2 largest_below = largest_of<Double2>(below[0], below[1], below[2]);
    const bool may_be_dark = any_less(smaller(largest_above, largest_below), -least);
    return is_partly_dark && !may_be_dark ? SmallAnswer::partly_lit : SmallAnswer::doubt;
}

// Whether one bound serves all quotients. The tile is in float where that does; in double all are certain where it is
// within the tolerance, else those that are not next to half-way between two floats.
//
// Exact: F errs by less than 2^-41.5 of itself and q by 2^-44, and four roundings follow: within SmallTile::ulps; |F| is
// above 2^-124 q, so the floats are normal. In float, with u = 2^-24 and b the steps to the last row, of which y is at most
// half: F is rounded with its column, its step, the product with y and the sum, by u (2 F + 1.5 b), as is q, and the
// reciprocal and the product round by 2 u. Of quotients that are `greatest` at most this is 6 u greatest + 1.5 u (b_F +
// greatest b_q) / q, and what floats below 2^-126 lose, one of them times y and over q, is less than 2^-96. In double only
// the quotient is rounded to float.
inline bool serves(const SmallFunction<Double2>& f, const SmallDivisor& divisor, double tolerance,
                   SmallTile& tile) noexcept {
    const SmallFunction<double>& q = divisor.function;
    const Double2 least = least_of<Double2>(f.base, f.right, f.bottom);
    const Double2 largest = largest_of<Double2>(f.base, f.right, f.bottom);
    tile.is_in_float = tile.is_certain = false;
    if (tolerance != 0.0) {
        const Double2 greatest = larger(largest, -least) * (1.001 / divisor.least);
        const double allowed = (tolerance - 0x1p-96) * (divisor.least - q.error);
        const bool may_be_float = has_shape_for_float(tile.width, read_alone(tile.height)) &&
                                  divisor.least > larger(0x1p-10 * divisor.largest, 0x1p-21) && tolerance < 0x1p40;
        Double2 rounded = greatest * (may_be_float ? 4.02 * divisor.least + std::fabs(q.bottom) : divisor.least);
        if (may_be_float) rounded = rounded + larger(f.bottom, -f.bottom);
        const Double2 error = (f.error + greatest * q.error) * 1.01 + rounded * (1.52 * unit_roundoff_float);
        tile.is_certain = all_less(error, double2_of(allowed, allowed));
        tile.is_in_float = tile.is_certain && may_be_float;
        if (!tile.is_in_float && pays_for_chunks(tile.width, tile.height)) return false;
    }
    return tile.is_certain || all_less(f.error * 0x1.8p41 + 0x1.1p-124 * divisor.largest, larger(least, -largest));
}

// Interpolates one coordinate of a rectangle that is no column; without a plan (null) nothing is known of it.
template <class CompiledWhereCalled = void>
TEXGEN_APART void interpolate_alone(const TriangleFunctions& triangle, const Tile& rect, RectInDoubt& in_doubt,
                                    glm::length_t coordinate, const std::span<float>& output,
                                    const Plan* plan) noexcept {
    if (output.empty()) return;
    TileInterpolator<>(triangle, triangle.planes.plane_twice(coordinate), rect, in_doubt, coordinate, coordinate,
                       {output})
        .interpolate(rect, plan);
}

// Interpolates one coordinate of any rectangle.
template <class CompiledWhereCalled = void>
TEXGEN_APART void interpolate_alone(const TriangleFunctions& triangle, const Tile& rect, glm::length_t coordinate,
                                    const std::span<float>& output) noexcept {
    if (rect.is_column()) return interpolate_alone(triangle.mirrored(), rect.mirrored(), coordinate, output);
    RectInDoubt in_doubt;
    interpolate_alone(triangle, rect, in_doubt, coordinate, output, nullptr);
}

// The most fragments of which coordinates are computed for the mask alone, where spans would do.
inline constexpr std::int64_t most_in_scratch = 1024;

// Fills s, t, r and the mask of a small tile.
template <class CompiledWhereCalled = void>
class SmallInterpolator {
public:
    SmallInterpolator(const TriangleFunctions& triangle, const Tile& rect) noexcept
        : triangle_(triangle),
          rect_(rect),
          place_(triangle.planes.from_a({rect.x, read_alone(rect.y), rect.width, rect.height}), rect.width,
                 read_alone(rect.height)),
          q_(triangle.q, place_),
          st_(triangle.st, place_) {}

    // Doubt, if one certificate does not serve all of s and t that is asked for.
    TEXGEN_INLINE SmallAnswer fill(const Texcoords& out) noexcept {
        const SmallAnswer answer = ask(triangle_.lit, triangle_.tolerance, st_, q_);
        if (answer == SmallAnswer::doubt) return answer;
        const bool is_lit = answer == SmallAnswer::lit;
        const bool needs_mask = !is_lit && !out.lit.empty();
        tile_.lit = needs_mask ? out.lit.data() : nullptr;
        triangle_.lit.copy_to(tile_.min, tile_.max);
        if (!out.s.empty() && !out.t.empty()) {
            if (!fill_both(out)) return SmallAnswer::doubt;
        } else if (needs_mask) {
            // s and t give the mask of few fragments sooner than spans do; that of more in float, or where one of them has
            // an output.
            const bool takes_many = triangle_.tolerance != 0.0 || out.s.size() + out.t.size() != 0;
            if (rect_.count() > (takes_many ? most_in_scratch : TileJob::unit_size) || !fill_both_in_scratch(out))
                return SmallAnswer::doubt;
        } else {
            if (!out.s.empty()) fill_alone(0, out.s);
            if (!out.t.empty()) fill_alone(1, out.t);
        }
        if (!out.r.empty()) fill_alone(2, out.r);
        if (is_lit && !out.lit.empty()) chosen<MaskKernels>().light_all(out.lit.data(), out.lit.size());
        return answer;
    }

private:
    // What is left: nothing; the tile's one unit, in doubt; or all, as no bound serves it, or it has more units.
    enum class Left { nothing, unit, all };

    // Divides two coordinates, or one that stands in both places; tile_.out says where they go. A column is divided as a
    // row; if that is in doubt it is left to the mirrored triangle.
    TEXGEN_APART Left divide(const PlaneOf<Double2>& planes, const SmallFunction<Double2>& f) noexcept {
        const bool is_column = rect_.is_column();
        tile_.width = is_column ? rect_.height : rect_.width;
        tile_.height = is_column ? 1 : rect_.height;
        if (!serves(f, q_, triangle_.tolerance, tile_)) return Left::all;
        const RampOf<Double2>& ramp = planes.value;
        store_ramps({f.base, is_column ? ramp.dy : ramp.dx, is_column ? ramp.dx : ramp.dy}, tile_.numerator);
        const auto& [base, dx, dy] = triangle_.q.value;
        tile_.q = {q_.function.base, is_column ? dy : dx, is_column ? dx : dy};
        if (chosen<TileKernels>().fill_small(tile_)) return Left::nothing;
        return !is_column && rect_.count() <= TileJob::unit_size ? Left::unit : Left::all;
    }

    // Decides what is left; false if that is all.
    TEXGEN_RARE bool decide(Left left, const PlaneOf<Double2>& planes, glm::length_t first, glm::length_t second,
                            const Texcoords& out) noexcept {
        if (left == Left::all) return false;
        RectInDoubt in_doubt;
        TileInterpolator<>(triangle_, planes, rect_, in_doubt, first, second, out).interpolate_from_doubt(rect_);
        return true;
    }

    bool fill_both(const Texcoords& out) noexcept {
        tile_.out[0] = out.s.data();
        tile_.out[1] = out.t.data();
        const Left left = divide(triangle_.st, st_);
        return left == Left::nothing || decide(left, triangle_.st, 0, 1, out);
    }

    // The same where the mask needs what has no output.
    TEXGEN_APART bool fill_both_in_scratch(const Texcoords& out) noexcept {
        float scratch[2][most_in_scratch];
        const auto count = static_cast<std::size_t>(rect_.count());
        Texcoords both = out;
        if (out.s.empty()) both.s = {scratch[0], count};
        if (out.t.empty()) both.t = {scratch[1], count};
        return fill_both(both);
    }

    TEXGEN_APART void fill_alone(glm::length_t coordinate, const std::span<float>& output) noexcept {
        const PlaneOf<Double2> plane = triangle_.planes.plane_twice(coordinate);
        tile_.out[0] = tile_.out[1] = output.data();
        tile_.lit = nullptr;
        const Left left = divide(plane, SmallFunction<Double2>(plane, place_));
        if (left != Left::nothing && !decide(left, plane, coordinate, coordinate, {output}))
            interpolate_alone(triangle_, rect_, coordinate, output);
    }

    const TriangleFunctions& triangle_;
    const Tile& rect_;
    SmallPlace place_;
    SmallDivisor q_;
    SmallFunction<Double2> st_;
    SmallTile tile_;
};

// Fills a small tile, if one certificate serves it.
template <class CompiledWhereCalled = void>
TEXGEN_APART SmallAnswer fill_small(const TriangleFunctions& triangle, const Tile& rect,
                                    const Texcoords& out) noexcept {
    return SmallInterpolator<>(triangle, rect).fill(out);
}

}  // namespace TEXGEN_DETAIL_BUILD
