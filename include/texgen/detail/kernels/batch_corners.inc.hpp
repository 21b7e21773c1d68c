// The functions of a batch's triangles far from slivers, where the terms of batch_closely.inc.hpp cancel: about a
// corner, where only one of the three terms is not 0, and with coefficients that residues have sharpened. Included by
// batch.inc.hpp.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

// The product of a value in two doubles and a difference: three exact products, and the rest.
struct ProductLanes {
    Doubles high, middle[2], rest;

    TEXGEN_INLINE ProductLanes(const CloseValues& a, const DifferenceLanes& b) noexcept {
        const Doubles leading = leading_bits<26>(a.high);
        const Doubles trailing = a.high - leading;
        high = leading * b.high;
        middle[0] = trailing * b.high;
        middle[1] = leading * b.low;
        rest = trailing * b.low + (a.low * (b.high + b.low) + a.high * b.lost);
    }
};

// With C the corner next to a fragment p, F(p) = F(C) + F_x (p - C).x + F_y (p - C).y, F(C) = area w_j w_k f_C. The
// area, F_x and F_y are known to 96 bits of the terms that they cancel from, or by residues to 144. With u = 2^-53 the
// products here lack 12 u^2 of F(C) and 9 u^2 of the others, and the sums of what exact ones leave 48 u^2 of all three:
// 2^-98 covers them.
struct CornerLanes {
    TEXGEN_APART CornerLanes(const VertexLanes& given, const ResidueLanes& residues, const Doubles& x,
                             const Doubles& y) noexcept
        : given_(given), residues_(residues), along_(given, 0), down_(given, 1) {
        Doubles distance[3];
        TEXGEN_FOR (std::size_t i = 0; i < 3; ++i)
            distance[i] = magnitude(x - given.number(i, 0)) + magnitude(y - given.number(i, 1));
        is_second_ = greater(distance[0], distance[1]);
        is_third_ = greater(minimum(distance[0], distance[1]), distance[2]);
        to_x_.set(x, corner(0));
        to_y_.set(y, corner(1));
        const EdgeLanes edge = given.area_closely();
        area_ = sharpened({edge.high, edge.low, edge.size * 0x1p-98}, residues.area(), residues.area_grain());
        weight_[0] = with_sign_of(of_corner(given.number(1, 2), given.number(2, 2), given.number(0, 2)), given.area);
        weight_[1] = of_corner(given.number(2, 2), given.number(0, 2), given.number(1, 2));
        residues.steps(dx_, dy_);
    }

    // The function of coordinate k at the fragment, and by how much it grows along a row and down a column.
    TEXGEN_APART void take(std::size_t k, const ResidueValues& values, CloseValues& base, CloseValues& dx,
                           CloseValues& dy) const noexcept {
        const Doubles grain = where(residues_.is_known, values.grain);
        dx = sharpened(along_.function(given_, k), values.times(dx_), grain * residues_.per_x);
        dy = sharpened(down_.function(given_, k), values.times(dy_), grain * residues_.per_y);
        const Doubles f = corner(3 + k);
        EdgeLanes at_corner{area_.high, area_.low, {}};
        at_corner.multiply(weight_[0]);
        at_corner.multiply(weight_[1]);
        at_corner.multiply(f);
        const ProductLanes of_x(dx, to_x_), of_y(dy, to_y_);
        Doubles error[6];
        Doubles sum = two_sum(of_x.high, of_y.high, error[0]);
        sum = two_sum(sum, at_corner.high, error[1]);
        Doubles middle = two_sum(of_x.middle[0], of_y.middle[0], error[2]);
        middle = two_sum(middle, of_x.middle[1], error[3]);
        middle = two_sum(middle, of_y.middle[1], error[4]);
        sum = two_sum(sum, middle, error[5]);
        const Doubles rest = ((error[0] + error[1]) + (error[2] + error[3]) + (error[4] + error[5])) +
                             (at_corner.low + (of_x.rest + of_y.rest));
        base.high = two_sum(sum, rest, base.low);
        const Doubles x = magnitude(to_x_.high + to_x_.low), y = magnitude(to_y_.high + to_y_.low);
        base.error = (magnitude(at_corner.high) + magnitude(dx.high) * x + magnitude(dy.high) * y) * 0x1p-98 +
                     (area_.error * magnitude(weight_[0] * weight_[1] * f) + (dx.error * x + dy.error * y)) * 1.01;
    }

private:
    TEXGEN_INLINE Doubles of_corner(const Doubles& a, const Doubles& b, const Doubles& c) const noexcept {
        return select(is_third_, c, select(is_second_, b, a));
    }
    TEXGEN_INLINE Doubles corner(std::size_t k) const noexcept {
        return of_corner(given_.number(0, k), given_.number(1, k), given_.number(2, k));
    }

    const VertexLanes& given_;
    const ResidueLanes& residues_;
    CloseSteps along_, down_;
    LongWords is_second_, is_third_;  // the corner that is next to the fragment
    DifferenceLanes to_x_, to_y_;     // from there
    CloseValues area_;
    Doubles weight_[2];
    Residues dx_[3], dy_[3];
};

// What is known of s, t, q, and r where it is needed, at a fragment in each lane. A grain of 0: there is no residue.
struct CloseFragmentsAt {
    const bool needs_r;
    bool are_sums_first;
    CloseValues value[4];
    Residues residue[4]{};
    Doubles of_grain[4]{};

    TEXGEN_INLINE explicit CloseFragmentsAt(bool with_r) noexcept : needs_r(with_r) {}

    // Member by member: GCC would copy a value in halves, for which a load of the whole would wait.
    TEXGEN_INLINE CloseValues values(std::size_t n) const noexcept {
        return {value[n].high, value[n].low, value[n].error};
    }
    TEXGEN_INLINE const Residues& residues(std::size_t n) const noexcept { return residue[n]; }
    TEXGEN_INLINE const Doubles& grain(std::size_t n) const noexcept { return of_grain[n]; }

    TEXGEN_INLINE void take(const VertexLanes& vertices, const auto& terms, bool are_close) noexcept {
        are_sums_first = are_close;
        for (std::size_t n = 0; n < 4; ++n)
            if (n != 2 || needs_r) value[n] = terms.function(vertices, n);
        value[3].error = value[3].error + vertices.error_of_q;
    }
    TEXGEN_INLINE void add_residues(const VertexLanes& vertices, const Doubles& x, const Doubles& y) noexcept {
        ResidueLanes lanes_of(vertices, x, y);
        for (std::size_t n = 0; n < 4; ++n) {
            if (n == 2 && !needs_r) continue;
            const ResidueValues of = lanes_of.values(n);
            residue[n] = of.times(lanes_of.side);
            of_grain[n] = where(lanes_of.is_known, of.grain);
        }
    }
    // Makes all functions about a corner, where terms cancel by more than two doubles and residues know. They replace
    // what is there if this is the first try, else only in lanes that err by less so.
    TEXGEN_APART void take_about_corners(const VertexLanes& vertices, const Doubles& x, const Doubles& y,
                                         bool is_first) noexcept {
        are_sums_first = true;
        ResidueLanes residues(vertices, x, y);
        const CornerLanes corners(vertices, residues, x, y);
        for (std::size_t n = 0; n < 4; ++n) {
            if (n == 2 && !needs_r) continue;
            const ResidueValues of = residues.values(n);
            CloseValues at, dx, dy;
            corners.take(n, of, at, dx, dy);
            if (n == 3) at.error = at.error + vertices.error_of_q;
            residue[n] = of.times(residues.side);
            of_grain[n] = where(residues.is_known, of.grain);
            value[n] = sharpened(is_first ? at : better(value[n], at), residue[n], of_grain[n]);
        }
    }
    TEXGEN_INLINE void sharpen() noexcept {
        for (std::size_t n = 0; n < 4; ++n)
            if (n != 2 || needs_r) value[n] = sharpened(value[n], residue[n], of_grain[n]);
    }
};

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
