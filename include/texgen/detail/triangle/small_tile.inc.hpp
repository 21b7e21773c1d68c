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

// Whether all of the tile is lit by s and t, or certainly a part. The sides are those of coverage_by_sides() with twice
// its margins, so that nothing is said of a tile of which that says something else.
enum class SmallAnswer { doubt, lit, partly_lit };
inline SmallAnswer ask(const LitTest& lit, double tolerance, const SmallFunction<Double2>& f,
                       const SmallDivisor& divisor) noexcept {
    if (!divisor.is_far_from_zero()) return SmallAnswer::doubt;
    const SmallFunction<double>& q = divisor.function;
    Double2 min = double2_of(lit.least(0), lit.least(1));
    Double2 max = double2_of(lit.greatest(0), lit.greatest(1));
    if (!lit.is_narrow) {
        // A side far beyond all quotients may as well stand eight times beyond them, where its margin is no larger than
        // they are. What is lit then is inside by coverage_by_sides(), too, whatever q does in the tile.
        const Double2 largest = magnitude(f.base) + magnitude(f.right) + magnitude(f.bottom);
        const Double2 beyond = largest * (8.0 / divisor.least) + 1.0;
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
    const Double2 margin = error * 2.0 + (size * 0x1p-21 + (0x1.1p-124 + 4.1 * tolerance)) * divisor.largest;
    if (all_less(margin, smaller(least_above, least_below))) return SmallAnswer::lit;
    const bool is_partly_dark = any_less(smaller(least_above, least_below), -margin);
    const Double2 largest_above = largest_of<Double2>(above[0], above[1], above[2]);
    const Double2 largest_below = largest_of<Double2>(below[0], below[1], below[2]);
    const bool may_be_dark = any_less(smaller(largest_above, largest_below), margin);
    return is_partly_dark && !may_be_dark ? SmallAnswer::partly_lit : SmallAnswer::doubt;
}

// Whether one bound serves all quotients; the tile is in float where that does. Exact: F errs by less than 2^-41.5 of
// itself and q by 2^-44, and four roundings follow: within SmallTile::ulps; |F| is above 2^-124 q, so the floats are
// normal. In float, with u = 2^-24 and b the steps to the last row, of which y is at most half: F is rounded with its
// column, its step, the product with y and the sum, by u (2 F + 1.5 b), as is q, and the reciprocal and the product
// round by 2 u. Of quotients that are `greatest` at most this is 6 u greatest + 1.5 u (b_F + greatest b_q) / q, and
// what floats below 2^-126 lose, one of them times y and over q, is less than 2^-96.
inline bool serves(const SmallFunction<Double2>& f, const SmallDivisor& divisor, double tolerance,
                   SmallTile& tile) noexcept {
    const SmallFunction<double>& q = divisor.function;
    const Double2 least = least_of<Double2>(f.base, f.right, f.bottom);
    const Double2 largest = largest_of<Double2>(f.base, f.right, f.bottom);
    tile.is_in_float = false;
    if (tolerance != 0.0 && has_shape_for_float(tile.width, read_alone(tile.height))) {
        const Double2 greatest = larger(largest, -least) * (1.001 / divisor.least);
        const double allowed = (tolerance - 0x1p-96) * (divisor.least - q.error);
        const Double2 error = f.error + greatest * q.error;
        const Double2 rounded = larger(f.bottom, -f.bottom) + greatest * (4.02 * divisor.least + std::fabs(q.bottom));
        tile.is_in_float =
            all_less(error * 1.01 + rounded * (1.52 * unit_roundoff_float), double2_of(allowed, allowed)) &&
            divisor.least > larger(0x1p-10 * divisor.largest, 0x1p-21) && tolerance < 0x1p40;
    }
    if (tile.is_in_float) return true;
    if (tolerance != 0.0 && pays_for_chunks(tile.width, tile.height)) return false;
    return all_less(f.error * 0x1.8p41 + 0x1.1p-124 * divisor.largest, larger(least, -largest));
}

// What is left of a tile: nothing; its one unit, in doubt; or all, as no one bound serves, or it has more units.
enum class SmallDoubt { none, of_unit, of_all };

// Divides one or two coordinates, if one bound serves them; `tile` says where they go. A column is divided as a row; if
// that is in doubt it is left to the mirrored triangle.
template <class CompiledWhereCalled = void>
TEXGEN_APART SmallDoubt divide_small(const TriangleFunctions& triangle, const Tile& rect, const RampOf<Double2>& ramp,
                                     const SmallFunction<Double2>& f, const SmallDivisor& q, SmallTile& tile) noexcept {
    const bool is_column = rect.is_column();
    tile.width = is_column ? rect.height : rect.width;
    tile.height = is_column ? 1 : rect.height;
    if (!serves(f, q, triangle.tolerance, tile)) return SmallDoubt::of_all;
    const auto& [q_base, q_dx, q_dy] = triangle.q.value;
    store_ramps({f.base, is_column ? ramp.dy : ramp.dx, is_column ? ramp.dx : ramp.dy}, tile.numerator);
    tile.q = {q.function.base, is_column ? q_dy : q_dx, is_column ? q_dx : q_dy};
    if (chosen<TileKernels>().fill_small(tile)) return SmallDoubt::none;
    return !is_column && tile.width * tile.height <= TileJob::unit_size ? SmallDoubt::of_unit : SmallDoubt::of_all;
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

// The same for a small tile; the one coordinate stands in both places.
template <class CompiledWhereCalled = void>
TEXGEN_APART void fill_small_alone(const TriangleFunctions& triangle, const Tile& rect, const SmallPlace& place,
                                   const SmallDivisor& q, glm::length_t coordinate, const std::span<float>& output,
                                   SmallTile& tile) noexcept {
    const PlaneOf<Double2> plane = triangle.planes.plane_twice(coordinate);
    tile.out[0] = tile.out[1] = output.data();
    tile.lit = nullptr;
    const SmallDoubt doubt = divide_small(triangle, rect, plane.value, SmallFunction<Double2>(plane, place), q, tile);
    if (doubt == SmallDoubt::none) return;
    if (doubt == SmallDoubt::of_all) return interpolate_alone(triangle, rect, coordinate, output);
    RectInDoubt in_doubt;
    TileInterpolator<>(triangle, plane, rect, in_doubt, coordinate, coordinate, {output}).interpolate_from_doubt(rect);
}

// Fills s, t, r and the mask of a small tile, if one certificate serves all of s and t that is asked for.
template <class CompiledWhereCalled = void>
TEXGEN_APART SmallAnswer fill_small(const TriangleFunctions& triangle, const Tile& rect,
                                    const Texcoords& out) noexcept {
    const SmallPlace place(triangle.planes.from_a({rect.x, read_alone(rect.y), rect.width, rect.height}), rect.width,
                           read_alone(rect.height));
    const SmallDivisor q(triangle.q, place);
    const SmallFunction<Double2> f(triangle.st, place);
    const SmallAnswer answer = ask(triangle.lit, triangle.tolerance, f, q);
    if (answer == SmallAnswer::doubt) return answer;
    const bool is_lit = answer == SmallAnswer::lit;
    SmallTile tile;
    const bool needs_mask = !is_lit && !out.lit.empty();
    // For few fragments s and t give the mask sooner than spans do, even if they have no outputs.
    float scratch[2][TileJob::unit_size];
    Texcoords both = out;
    if (needs_mask && rect.count() <= TileJob::unit_size) {
        const auto count = static_cast<std::size_t>(rect.count());
        if (out.s.empty()) both.s = {scratch[0], count};
        if (out.t.empty()) both.t = {scratch[1], count};
    }
    if (!both.s.empty() && !both.t.empty()) {
        tile.out[0] = both.s.data();
        tile.out[1] = both.t.data();
        tile.lit = needs_mask ? out.lit.data() : nullptr;
        if (tile.lit != nullptr) triangle.lit.copy_to(tile.min, tile.max);
        const SmallDoubt doubt = divide_small(triangle, rect, triangle.st.value, f, q, tile);
        if (doubt == SmallDoubt::of_all) return SmallAnswer::doubt;
        if (doubt == SmallDoubt::of_unit) {
            RectInDoubt in_doubt;
            TileInterpolator<>(triangle, triangle.st, rect, in_doubt, 0, 1, both).interpolate_from_doubt(rect);
        }
    } else {
        if (needs_mask) return SmallAnswer::doubt;
        if (!out.s.empty()) fill_small_alone(triangle, rect, place, q, 0, out.s, tile);
        if (!out.t.empty()) fill_small_alone(triangle, rect, place, q, 1, out.t, tile);
    }
    if (!out.r.empty()) fill_small_alone(triangle, rect, place, q, 2, out.r, tile);
    if (is_lit && !out.lit.empty()) chosen<MaskKernels>().light_all(out.lit.data(), out.lit.size());
    return answer;
}

}  // namespace TEXGEN_DETAIL_BUILD
