// Boxes against linear forms. Included by lanes.hpp once per instruction set. A form is largest over a box at the vertex
// that the signs of its coefficients pick, and least at the opposite one: one choice for all the boxes of a call.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

// Where the largest value of a form is negative, the box is outside; where the least of all are positive, inside. An
// infinity makes the error one, and nothing is certain. Where min <= max, the larger magnitude is that of -min or max.
template <class CompiledWhereCalled = void>
void classify(const FloatForms& original, const float* boxes, std::size_t count, int* classes) noexcept {
    const FloatForms forms = original;
    for (std::size_t i = 0; i < count; i += static_cast<std::size_t>(wide_lanes)) {
        WideFloats min[3];
        WideFloats max[3];
        load_boxes(boxes + 6 * i, min, max);
        WideFloats least_of_largest = WideFloats{} + 0x1p126f;
        WideFloats least = least_of_largest;
        for (const FloatForms::Form& form : forms.form) {
            const auto at = [&form](const WideFloats& x, const WideFloats& y, const WideFloats& z) {
                return x * form.a[0] + (y * form.a[1] + (z * form.a[2] + form.d));
            };
            const bool x_grows = form.a[0] > 0.0f;
            const bool y_grows = form.a[1] > 0.0f;
            const bool z_grows = form.a[2] > 0.0f;
            const WideFloats largest = at((x_grows ? max : min)[0], (y_grows ? max : min)[1], (z_grows ? max : min)[2]);
            const WideFloats smallest =
                at((x_grows ? min : max)[0], (y_grows ? min : max)[1], (z_grows ? min : max)[2]);
            least_of_largest = minimum(largest, least_of_largest);
            least = minimum(smallest, least);
        }
        const WideFloats zero{};
        WideFloats size = zero;
        for (int j = 0; j < 3; ++j) size = size + maximum(zero - min[j], max[j]);
        const WideFloats error = size * forms.error_per_size + forms.error;
        const WideWords proper = at_most(min[0], max[0]) & at_most(min[1], max[1]) & at_most(min[2], max[2]);
        const WideWords outside = less(least_of_largest + error, zero) & proper;
        const WideWords inside = less(error - least, zero) & proper;
        const WideWords partial = less(error - least_of_largest, zero) & less(least + error, zero) & proper;
        // The masks are 0 and -1.
        store(classes + i, (outside + outside + outside) + (partial + partial) + (inside + box_doubtful));
    }
}

// Bounds on a form, whose signs are right, where it is largest or least. In double a coefficient, a product and three sums
// are rounded; no error is infinite, as an infinite value has the right sign.
TEXGEN_INLINE void bound_form(const ExactForm& form, bool largest, const BoxBlock& boxes, std::size_t i,
                              double least_lit, Doubles& lower, Doubles& upper) noexcept {
    Doubles value = Doubles{} + form.rounded[3];
    Doubles size = magnitude(value);
    const auto add = [&](std::size_t j) {
        if (form.rounded[j] == 0.0) return;
        const auto vertex = load<Doubles>(((form.rounded[j] > 0.0) == largest ? boxes.max : boxes.min)[j] + i);
        const Doubles term = vertex * form.rounded[j];
        value = value + term;
        size = size + magnitude(term);
    };
    add(0);
    add(1);
    add(2);
    const Doubles error = minimum(size, Doubles{} + 0x1p900) * gamma(8);
    lower = value - error - least_lit;
    upper = value + error - least_lit;
}

// The same as a sum of exact terms in two doubles, which tells how much at most they leave out: nothing for numbers with few
// digits, however much they cancel. What is infinite becomes a NaN here, and stays as it is.
// Source: Ogita, Rump, Oishi, Accurate Sum and Dot Product, SIAM J. Sci. Comput. 26 (2005), Sum2.
TEXGEN_INLINE void bound_exactly(const ExactForm& form, bool largest, const BoxBlock& boxes, std::size_t i,
                                 double least_lit, Doubles& lower, Doubles& upper) noexcept {
    Doubles vertex[4] = {{}, {}, {}, Doubles{} + 1.0};
    for (std::size_t j = 0; j < 3; ++j) {
        if (form.rounded[j] != 0.0)
            vertex[j] = load<Doubles>(((form.rounded[j] > 0.0) == largest ? boxes.max : boxes.min)[j] + i);
    }
    const auto term = [&](std::size_t k) { return vertex[form.terms[k].coordinate] * form.terms[k].factor; };
    Doubles low, rest;
    Doubles high = two_sum(term(0), term(1), low);
    Doubles lost{};
    for (std::size_t k = 2; k < form.term_count; ++k) {
        high = two_sum(high, term(k), rest);
        low = two_sum(low, rest, rest);
        lost = lost + magnitude(rest);
    }
    high = high + low;
    lost = lost + lost;
    lower = maximum(high - lost - least_lit, lower);
    upper = minimum(high + lost - least_lit, upper);
}

// The least of the largest values of the sides, or of the least ones of the inner sides; q first, which is negative for
// half of what is at the apex. Where one is negative for every box, the others are not asked.
template <bool Largest>
TEXGEN_INLINE void bound_least(const DoubleForms& forms, const BoxBlock& boxes, std::size_t i, double* least_lower,
                               double* least_upper) noexcept {
    Doubles all_lower = Doubles{} + 1.0;
    Doubles all_upper = all_lower;
    for (std::size_t k = lit_form_count; k-- > 0;) {
        if (!any(narrow(~greater(0.0 - all_upper, 0.0)))) break;
        const DoubleForms::Form& sides = forms.form[k];
        const ExactForm& form = Largest ? sides.outer : sides.inner;
        Doubles lower;
        Doubles upper;
        bound_form(form, Largest, boxes, i, sides.least_lit, lower, upper);
        const LongWords is_in_doubt = greater(0.0 - lower, 0.0) & ~greater(0.0 - upper, 0.0);
        if (any(narrow(is_in_doubt))) bound_exactly(form, Largest, boxes, i, sides.least_lit, lower, upper);
        all_lower = minimum(lower, all_lower);
        all_upper = minimum(upper, all_upper);
    }
    store(least_lower + i, all_lower);
    store(least_upper + i, all_upper);
}

template <class CompiledWhereCalled = void>
void bound(const DoubleForms& forms, const BoxBlock& boxes, BoxBounds& bounds) noexcept {
    for (std::size_t i = 0; i < box_block; i += static_cast<std::size_t>(lanes)) {
        bound_least<true>(forms, boxes, i, bounds.lower, bounds.upper);
        const auto upper = load<Doubles>(bounds.upper + i);
        store(bounds.inner_lower + i, upper);
        store(bounds.inner_upper + i, upper);
        if (any(narrow(~greater(0.0 - upper, 0.0))))
            bound_least<false>(forms, boxes, i, bounds.inner_lower, bounds.inner_upper);
    }
}

// What a form does not use is skipped, whatever the box has there. A NaN (of an infinity) proves nothing.
template <class CompiledWhereCalled = void>
void separate(const LinearForm* forms, std::size_t count, const BoxBlock& boxes, double* least_of_largest) noexcept {
    for (std::size_t i = 0; i < box_block; i += static_cast<std::size_t>(lanes)) {
        Doubles least = Doubles{} + 1.0;
        Doubles size[3];
        for (std::size_t j = 0; j < 3; ++j)
            size[j] = maximum(0.0 - load<Doubles>(boxes.min[j] + i), load<Doubles>(boxes.max[j] + i));
        for (std::size_t k = 0; k < count; ++k) {
            const LinearForm& form = forms[k];
            Doubles largest = Doubles{} + (form.d + form.error_d);
            for (std::size_t j = 0; j < 3; ++j) {
                if (!form.uses[j]) continue;
                const auto vertex = load<Doubles>((form.a[j] > 0.0 ? boxes.max : boxes.min)[j] + i);
                largest = largest + vertex * form.a[j] + size[j] * form.error_a;
            }
            least = minimum(largest, least);
        }
        store(least_of_largest + i, least);
    }
}

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
