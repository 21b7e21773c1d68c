// Small tiles that need no more than one certificate from their corners: no plan, no chunks, no job of many fields.
// Included by interpolate.hpp.

namespace TEXGEN_DETAIL {
inline namespace TEXGEN_BUILD {

// Rows that are shorter than vectors are gathered in a buffer, which has a unit. Of many fragments one may well be in
// doubt, which has all of them divided again; and in long rows vectors that follow one another share a division at less
// cost.
inline bool is_small(const Tile& tile, double tolerance) noexcept {
    constexpr int longest_vector = 8;
    const int most = tile.width < longest_vector ? TileJob::unit_size : tile.width <= 64 ? 4096 : 512;
    return tile.count() <= most && (tolerance == 0.0 || !pays_for_chunks(tile));
}

// Where a tile begins from the vertex that the planes are about, how far it reaches from there at least, and its last
// column and row.
struct SmallPlace {
    double x, y, reach_x, reach_y, right, bottom;

    SmallPlace(const glm::dvec2& from_a, const Tile& rect) noexcept
        : x(from_a.x),
          y(from_a.y),
          reach_x(std::fabs(x) + rect.width),
          reach_y(std::fabs(y) + rect.height),
          right(rect.width - 1.0),
          bottom(rect.height - 1.0) {}
};

// A linear function over the tile: at its first fragment, its steps to the last column and row, and a bound on its
// error, see TrianglePlanes::ramp() and error(). A row's product and sums add less than 6 u to its 20 u of the
// magnitude, for which gamma has room.
template <class Number>
struct SmallFunction {
    Number base, right, bottom, error;

    SmallFunction(const PlaneOf<Number>& plane, const SmallPlace& place) noexcept
        : base(plane.value.base + (plane.value.dx * place.x + plane.value.dy * place.y)),
          right(plane.value.dx * place.right),
          bottom(plane.value.dy * place.bottom),
          error((plane.magnitude.base + plane.magnitude.dx * place.reach_x + plane.magnitude.dy * place.reach_y) *
                gamma(20)) {}
};

// At the corner where a function is least, and where it is largest.
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

// Whether all of it is lit, or certainly a part, and far enough from q = 0 and from 0 that one bound serves all
// quotients. The sides are those of coverage_by_sides() with twice its margins, so that nothing is said of a tile of
// which that says something else. Exact: F errs by less than 2^-41.5 of itself and q by 2^-44, and four roundings
// follow: within SmallTile::ulps; F is above 2^-124 q, so the floats are normal. In float, with u = 2^-24 and b the
// steps to the last row, of which y is at most half: F is rounded with its column, its step, the product with y, and
// the sum, by u (2 F + 1.5 b), as is q, and the reciprocal and the product round by 2 u. Of a quotient that is at most
// `greatest` this is 6 u greatest + 1.5 u (b_F + greatest b_q) / q, and what floats below 2^-126 lose is less than
// 2^-100.
enum class SmallAnswer { doubt, lit, partly_lit };
inline SmallAnswer ask(const LitTest& lit, double tolerance, const SmallFunction<Double2>& f,
                       const SmallFunction<double>& q, SmallTile& tile) noexcept {
    const double least_q = least_of(q.base, q.right, q.bottom);
    const double largest_q = largest_of(q.base, q.right, q.bottom);
    if (!(least_q > larger(0x1p44 * q.error, 0x1p-100) && largest_q < 0x1p60)) return SmallAnswer::doubt;
    const Double2 min = double2_of(lit.least(0), lit.least(1));
    const Double2 max = double2_of(lit.greatest(0), lit.greatest(1));
    const Double2 above[3] = {f.base - min * q.base, f.right - min * q.right, f.bottom - min * q.bottom};
    const Double2 below[3] = {max * q.base - f.base, max * q.right - f.right, max * q.bottom - f.bottom};
    const Double2 least_above = least_of<Double2>(above[0], above[1], above[2]);
    const Double2 least_below = least_of<Double2>(below[0], below[1], below[2]);
    const Double2 error = f.error + max * q.error;
    const Double2 margin = error * 2.0 + (max * 0x1p-21 + (0x1.1p-124 + 4.1 * tolerance)) * largest_q;
    const bool is_lit = all_less(margin, smaller(least_above, least_below));
    tile.is_in_float = false;
    if (is_lit && tolerance != 0.0 && tile.width == 8 && read_alone(tile.height) % 2 == 0) {
        const double allowed = (tolerance - 0x1p-100) * (least_q - q.error);
        const Double2 rounded = larger(f.bottom, -f.bottom) + max * (4.02 * least_q + std::fabs(q.bottom));
        tile.is_in_float =
            all_less(error * 1.01 + rounded * (1.52 * unit_roundoff_float), double2_of(allowed, allowed)) &&
            least_q > larger(0x1p-10 * largest_q, 0x1p-21) && tolerance < 0x1p40;
        if (tile.is_in_float) return SmallAnswer::lit;
    }
    if (!all_less(f.error * 0x1.8p41 + 0x1.1p-124 * largest_q, least_of<Double2>(f.base, f.right, f.bottom)))
        return SmallAnswer::doubt;
    if (is_lit) return SmallAnswer::lit;
    const bool is_partly_dark = any_less(smaller(least_above, least_below), -margin);
    const Double2 largest_above = largest_of<Double2>(above[0], above[1], above[2]);
    const Double2 largest_below = largest_of<Double2>(below[0], below[1], below[2]);
    const bool may_be_dark = any_less(smaller(largest_above, largest_below), margin);
    return is_partly_dark && !may_be_dark ? SmallAnswer::partly_lit : SmallAnswer::doubt;
}

// s, t and their mask of a small tile, if one certificate serves all of it. A tile of one unit with a value in doubt is
// divided again here, without a plan.
template <class CompiledWhereCalled = void>
TEXGEN_APART SmallAnswer fill_small(const TriangleFunctions& triangle, const Tile& rect,
                                    const Texcoords& out) noexcept {
    const Double2 least = double2_of(triangle.lit.least(0), triangle.lit.least(1));
    if (!(least[0] >= 0.0 && least[1] >= 0.0) || out.s.empty() || out.t.empty()) return SmallAnswer::doubt;
    const SmallPlace place(triangle.planes.from_a(rect), rect);
    const SmallFunction<Double2> f(triangle.st, place);
    const SmallFunction<double> q(triangle.q, place);
    SmallTile tile;
    tile.width = rect.width;
    tile.height = rect.height;
    const SmallAnswer answer = ask(triangle.lit, triangle.tolerance, f, q, tile);
    if (answer == SmallAnswer::doubt) return answer;
    const RampOf<Double2>& st = triangle.st.value;
    store_ramps({f.base, st.dx, st.dy}, tile.numerator);
    tile.q = {q.base, triangle.q.value.dx, triangle.q.value.dy};
    tile.out[0] = out.s.data();
    tile.out[1] = out.t.data();
    tile.lit = out.lit.empty() ? nullptr : out.lit.data();
    if (tile.lit != nullptr) triangle.lit.copy_to(tile.min, tile.max);
    const TileKernels& kernels = chosen<TileKernels>();
    if (!kernels.fill_small(tile)) {
        if (rect.count() > TileJob::unit_size) return SmallAnswer::doubt;
        OnDemand<CloseRamps> close;
        TileInterpolator<> interpolator(kernels, triangle, rect, close);
        interpolator.add(out.s, out.t, out.lit);
        interpolator.interpolate_from_doubt(rect);
    }
    return answer;
}

inline Work work_of(const TriangleFunctions& triangle, bool is_lit) noexcept {
    return is_constant(triangle.q.value) ? Work::affine : is_lit ? Work::divide : Work::divide_and_test;
}

}  // namespace TEXGEN_BUILD
}  // namespace TEXGEN_DETAIL
