// Boxes and spheres against linear forms. Included by kernels.inc.hpp once per instruction set.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

// The classes of many bodies, a lane each. Where the largest value of a form is negative, the body is outside; where
// the least of all are positive, inside; where all are positive in the middle, no further plane makes it outside. An
// infinite coordinate makes the error infinite or a NaN: nothing is certain then.
// In float a sum or difference of two corners is rounded, as are a coefficient, a product, at most three sums of them
// and the sum of the two: 7 u.
TEXGEN_INLINE WideWords classes(const FloatForms& forms, const WideFloats (&twice_middle)[3], const auto& change,
                                const WideFloats& size, const WideWords& is_proper) noexcept {
    WideFloats largest = WideFloats{} + 0x1p126f, least = largest, middle = largest;
    const auto take = [&](std::size_t k) {
        const WideFloats value =
            twice_middle[0] * forms.a[0][k] +
            (twice_middle[1] * forms.a[1][k] + (twice_middle[2] * forms.a[2][k] + forms.twice_d[k]));
        const WideFloats change_k = change(k);
        largest = minimum(value + change_k, largest);
        least = minimum(value - change_k, least);
        middle = minimum(value, middle);
    };
    TEXGEN_FOR (std::size_t k = 0; k < forms_without_depth; ++k) take(k);
    for (std::size_t k = forms_without_depth; k < forms.count; ++k) take(k);
    const WideFloats zero{};
    const WideFloats error = size * forms.error_per_size + forms.error;
    const WideWords outside = less(largest + error, zero) & is_proper, inside = less(error - least, zero) & is_proper;
    const WideWords partial = less(error - largest, zero) & less(least + error, zero) & is_proper;
    const WideWords reached = partial & less(error - middle, zero);
    return body_in_doubt - (outside & 7) - (inside & 5) - (partial & 2) - (reached & 4);
}

// How the loops read forms: GCC spreads the numbers of a copy over lanes before the loop, which takes longer than a
// batch of 16 bodies. With four lanes they are copied, as no instruction spreads what it reads.
using ReadForms = std::conditional_t<wide_lanes == 4, const FloatForms, const FloatForms&>;

template <class CompiledWhereCalled = void>
void classify_boxes(const FloatForms& original, const float* boxes, std::size_t count, int* out) noexcept {
    ReadForms forms = original;
    for (std::size_t i = 0; i < count; i += wide_at_once) {
        WideFloats min[3], max[3], sum[3], extent[3];
        load_boxes(boxes + 6 * i, min, max);
        WideFloats size{};
        TEXGEN_FOR (int j = 0; j < 3; ++j) {
            sum[j] = min[j] + max[j];
            extent[j] = max[j] - min[j];
            size = size + magnitude(sum[j]) + extent[j];
        }
        const auto change = [&](std::size_t k) {
            return extent[0] * forms.magnitude_of_a[0][k] +
                   (extent[1] * forms.magnitude_of_a[1][k] + extent[2] * forms.magnitude_of_a[2][k]);
        };
        const WideWords proper = at_most(min[0], max[0]) & at_most(min[1], max[1]) & at_most(min[2], max[2]);
        store(out + i, classes(forms, sum, change, size, proper));
    }
}

template <class CompiledWhereCalled = void>
void classify_spheres(const FloatForms& original, const float* spheres, std::size_t count, int* out) noexcept {
    ReadForms forms = original;
    for (std::size_t i = 0; i < count; i += wide_at_once) {
        WideFloats sphere[4], twice[3];  // the radius last
        load_fours(spheres + 4 * i, sphere);
        const WideFloats diameter = sphere[3] + sphere[3];
        WideFloats size = diameter;
        TEXGEN_FOR (int j = 0; j < 3; ++j) {
            twice[j] = sphere[j] + sphere[j];
            size = size + magnitude(twice[j]);
        }
        const auto change = [&](std::size_t k) { return diameter * forms.slope[k]; };
        store(out + i, classes(forms, twice, change, size + diameter, at_most(WideFloats{}, sphere[3])));
    }
}

// A box in each lane, by the rows that a FormAtVertex names.
using BoxRows = Doubles[8];

// Values of a form with the right signs, where asked: an infinite one has it in any case, and no size of a row is
// infinite. In double a coefficient, a product and three sums are rounded, less than half of what gamma(8) has room
// for. Where that leaves the sign open, exact terms are summed, whose magnitudes are 2^49 times that error together:
// gamma(8) is 2^-49.
TEXGEN_INLINE Doubles signed_form(const FormAtVertex& form, const BoxRows& row, const BoxRows& size,
                                  const LongWords& asked) noexcept {
    Doubles value = Doubles{} + form.coefficient[3];
    Doubles error = Doubles{} + form.error[3];
    TEXGEN_FOR (std::size_t j = 0; j < 3; ++j) {
        value = value + row[form.row[j]] * form.coefficient[j];
        error = error + size[form.row[j]] * form.error[j];
    }
    const LongWords is_open = asked & at_most(magnitude(value), error);
    if (!any(is_open)) return value;
    Doubles term[FormAtVertex::max_terms];
    for (std::size_t k = 0; k < form.term_count; ++k) term[k] = row[form.term[k].row] * form.term[k].factor;
    const Doubles sigma = power_of_two_below(maximum(error, Doubles{} + 0x1p-900)) * 0x1p52;
    return select(is_open, signed_sum(term, form.term_count, sigma, is_open), value);
}

// A box is outside if a form is negative where it is largest, or q is 0; else inside if no inner form is negative where
// it is least. q comes before the sides, as it is negative for half of what is at the apex. Once all boxes are known,
// the other forms are not asked.
TEXGEN_INLINE void bound_box(const DoubleForms& forms, const BoxRows& row, const LongWords& have_points,
                             LongWords& outside, LongWords& inside) noexcept {
    BoxRows size;
    TEXGEN_FOR (std::size_t j = 0; j < 8; ++j) size[j] = minimum(magnitude(row[j]), Doubles{} + 0x1p128);
    inside = have_points;
    for (const bool largest : {true, false}) {
        for (std::size_t k = forms.count; k-- > 0 && any(inside);) {
            const FormAtVertex& form = largest ? forms.form[k].largest : forms.form[k].least;
            const double least = k == form_of_q ? 0x1p-1000 : 0.0;
            inside = inside & ~greater(Doubles{} + least, signed_form(form, row, size, inside));
        }
        if (largest) outside = have_points & ~inside;
    }
}

// A body that is in none of these three is partial.
TEXGEN_INLINE void store_classes(int* out, const LongWords& outside, const LongWords& inside,
                                 const LongWords& in_doubt) noexcept {
    store(out, 1 - (narrow(outside) & 1) + (narrow(inside) & 1) + (narrow(in_doubt) & (body_in_doubt - 1)));
}

template <class CompiledWhereCalled = void>
void decide_boxes(const DoubleForms* forms, const SeparatingPlanes& planes, const OpenRow* boxes, std::size_t count,
                  int* classes) noexcept {
    for (std::size_t i = 0; i < count; i += at_once) {
        BoxRows row;
        TEXGEN_FOR (std::size_t j = 0; j < 6; ++j) row[j] = to_doubles(load<Floats>(boxes[j] + i));
        row[FormAtVertex::row_of_1] = Doubles{} + 1.0;
        row[FormAtVertex::row_of_0] = Doubles{};
        LongWords have_points = ~LongWords{};
        TEXGEN_FOR (std::size_t j = 0; j < 3; ++j) have_points = have_points & at_most(Doubles{}, row[3 + j] - row[j]);
        LongWords outside{}, inside{};
        if (forms != nullptr) bound_box(*forms, row, have_points, outside, inside);
        const LongWords open = have_points & ~(outside | inside);
        if (any(open)) outside = outside | (open & are_separated(planes, row));
        store_classes(classes + i, outside, inside, ~have_points);
    }
}

// The extremes of a form over a sphere are its value at the centre +- the radius, as |a| = 1. Beside an edge, where
// forms f and g meet, a sphere may be outside, but of neither form: where w_f = c g - f and w_g = c f - g, c = a_f.a_g,
// are positive at the centre, the edge is what is nearest, at the squared distance -(w_f f + w_g g) / (1 - c^2).
// With E = error_f + error_g and M = E + |f| + |g|: a value errs by at most 3/8 of its error, of which 16 u of it are
// no more, and a squared length |a|^2 by 28 u. So weights err by 2.2 E at most, and the sum by 2.8 M E: above 16 M E
// one weight at most is negative, w_f say. Then g is so as well, and the sphere nearer, to g's side, by w_f^2 of the
// numerator, 5 E^2.
template <class CompiledWhereCalled = void>
void decide_spheres(const UnitForms& forms, std::size_t form_count, const OpenRow* spheres, std::size_t count,
                    int* classes) noexcept {
    for (std::size_t i = 0; i < count; i += at_once) {
        Doubles sphere[4];
        TEXGEN_FOR (std::size_t j = 0; j < 4; ++j)
            sphere[j] = count == 1 ? Doubles{} + widened(*spheres[j]) : to_doubles(load<Floats>(spheres[j] + i));
        const Doubles& radius = sphere[3];
        const Doubles size = magnitude(sphere[0]) + magnitude(sphere[1]) + magnitude(sphere[2]);
        const LongWords is_sphere = greater(Doubles{} + infinity, size + radius) & at_most(Doubles{}, radius);
        const Doubles of_q = ((size + radius * 2.0) * forms.largest_q + forms.last_q) * 1.1;
        const Doubles squared_radius = radius * radius;
        Doubles value[max_forms], margin[max_forms], reach[max_forms];
        LongWords outside = ~is_sphere, dark{}, inside = is_sphere;
        for (std::size_t k = 0; k < form_count; ++k) {
            value[k] =
                sphere[0] * forms.a[0][k] + (sphere[1] * forms.a[1][k] + (sphere[2] * forms.a[2][k] + forms.d[k]));
            const Doubles error = size * forms.error_a[k] + forms.error_d[k];
            margin[k] = error * 16.0;
            reach[k] = magnitude(value[k]) + margin[k];
            const Doubles rounding = error + radius * gamma(4);
            outside = outside | greater(0.0 - rounding, value[k] + radius);
            inside = inside & greater(value[k] - radius - of_q * forms.narrowing[k], rounding);
            dark = dark | greater(0.0 - value[k], 0.0);
        }
        const std::size_t edges = any(dark & ~outside) ? edge_count(form_count) : 0;
        for (std::size_t edge = 0; edge < edges; ++edge) {
            const std::size_t f = first_of_edge[edge], g = second_of_edge[edge];
            const auto& a = forms.a;
            const double across = a[0][f] * a[0][g] + a[1][f] * a[1][g] + a[2][f] * a[2][g];
            const Doubles against_f = value[f] - value[g] * across, against_g = value[g] - value[f] * across;
            const LongWords faces = greater(Doubles{}, maximum(against_f, against_g));
            if (count > 1 && !any(faces)) continue;  // for one sphere that takes longer than the rest
            const Doubles errors = (margin[f] + margin[g]) * (reach[f] + reach[g]);
            outside = outside | (faces & greater(against_f * value[f] + against_g * value[g],
                                                 squared_radius * (1.0 + gamma(16) - across * across) + errors));
        }
        store_classes(classes + i, outside & is_sphere, inside, ~is_sphere);
    }
}

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
