// Boxes and spheres against linear forms. Included by lanes.hpp once per instruction set.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

// Many bodies, a lane each. Where the largest value of a form is negative, the body is outside; where the least of all are
// positive, inside; where all are positive in the middle, no further plane makes it outside. An infinity makes the error
// one or a NaN, and nothing is certain.
// In float a sum or difference of two corners is rounded, as are a coefficient, a product, at most three sums of them and the
// sum of the two: 7 u.
template <class Change>
TEXGEN_INLINE WideWords classes(const FloatForms& forms, const WideFloats (&twice_middle)[3], const Change& change,
                                const WideFloats& size, const WideWords& is_proper) noexcept {
    WideFloats largest = WideFloats{} + 0x1p126f;
    WideFloats least = largest;
    WideFloats middle = largest;
    const auto take = [&](std::size_t k) {
        const WideFloats value =
            twice_middle[0] * forms.a[0][k] +
            (twice_middle[1] * forms.a[1][k] + (twice_middle[2] * forms.a[2][k] + forms.twice_d[k]));
        const WideFloats change_k = change(k);
        largest = minimum(value + change_k, largest);
        least = minimum(value - change_k, least);
        middle = minimum(value, middle);
    };
    TEXGEN_UNROLL
    for (std::size_t k = 0; k < forms_without_depth; ++k) take(k);
    for (std::size_t k = forms_without_depth; k < forms.count; ++k) take(k);
    const WideFloats zero{};
    const WideFloats error = size * forms.error_per_size + forms.error;
    const WideWords outside = less(largest + error, zero) & is_proper;
    const WideWords inside = less(error - least, zero) & is_proper;
    const WideWords partial = less(error - largest, zero) & less(least + error, zero) & is_proper;
    const WideWords reached = partial & less(error - middle, zero);
    return body_in_doubt - (outside & 7) - (inside & 5) - (partial & 2) - (reached & 4);
}

template <class CompiledWhereCalled = void>
void classify_boxes(const FloatForms& original, const float* boxes, std::size_t count, int* out) noexcept {
    const FloatForms forms = original;
    for (std::size_t i = 0; i < count; i += static_cast<std::size_t>(wide_lanes)) {
        WideFloats min[3], max[3], sum[3], extent[3];
        load_boxes(boxes + 6 * i, min, max);
        WideFloats size{};
        for (int j = 0; j < 3; ++j) {
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
    const FloatForms forms = original;
    for (std::size_t i = 0; i < count; i += static_cast<std::size_t>(wide_lanes)) {
        WideFloats twice[3], radius;
        load_spheres(spheres + 4 * i, twice, radius);
        WideFloats size = radius + radius;
        for (int j = 0; j < 3; ++j) {
            twice[j] = twice[j] + twice[j];
            size = size + magnitude(twice[j]);
        }
        const WideFloats diameter = radius + radius;
        const auto change = [&](std::size_t k) { return diameter * forms.slope[k]; };
        store(out + i, classes(forms, twice, change, size + diameter, at_most(WideFloats{}, radius)));
    }
}

// One body, a lane a form.
using FormFloats = std::conditional_t<(wide_lanes > static_cast<int>(form_lanes)), Floats, WideFloats>;

template <class Change>
TEXGEN_INLINE int class_of(const FloatForms& forms, const float (&twice_middle)[3], const Change& change, float size,
                           bool is_proper) noexcept {
    const float error = size * forms.error_per_size + forms.error;
    const FormFloats zero{};
    auto outside = less(zero, zero);
    auto inside = ~outside, not_outside = inside, partial = outside, reached = inside;
    TEXGEN_UNROLL
    for (std::size_t k = 0; k < form_lanes; k += sizeof(FormFloats) / sizeof(float)) {
        const FormFloats value =
            load<FormFloats>(forms.a[0] + k) * twice_middle[0] +
            (load<FormFloats>(forms.a[1] + k) * twice_middle[1] +
             (load<FormFloats>(forms.a[2] + k) * twice_middle[2] + load<FormFloats>(forms.twice_d + k)));
        const FormFloats change_k = change(k);
        const FormFloats largest = value + change_k;
        const FormFloats least = value - change_k;
        outside = outside | less(largest + error, zero);
        not_outside = not_outside & less(error - largest, zero);
        inside = inside & less(error - least, zero);
        partial = partial | less(least + error, zero);
        reached = reached & less(error - value, zero);
    }
    if (!is_proper) return body_in_doubt;
    if (any(outside)) return 0;
    if (!any(~inside)) return 2;
    if (any(~not_outside) || !any(partial)) return body_in_doubt;
    return any(~reached) ? open_body + 1 : 1;
}

template <class CompiledWhereCalled = void>
int classify_box(const FloatForms& forms, const float* min, const float* max) noexcept {
    const float sum[3] = {min[0] + max[0], min[1] + max[1], min[2] + max[2]};
    const float extent[3] = {max[0] - min[0], max[1] - min[1], max[2] - min[2]};
    const auto change = [&](std::size_t k) {
        return load<FormFloats>(forms.magnitude_of_a[0] + k) * extent[0] +
               (load<FormFloats>(forms.magnitude_of_a[1] + k) * extent[1] +
                load<FormFloats>(forms.magnitude_of_a[2] + k) * extent[2]);
    };
    const float size =
        (std::fabs(sum[0]) + extent[0]) + (std::fabs(sum[1]) + extent[1]) + (std::fabs(sum[2]) + extent[2]);
    return class_of(forms, sum, change, size, min[0] <= max[0] && min[1] <= max[1] && min[2] <= max[2]);
}

template <class CompiledWhereCalled = void>
int classify_sphere(const FloatForms& forms, const float* centre, float radius) noexcept {
    const float twice[3] = {2.0f * centre[0], 2.0f * centre[1], 2.0f * centre[2]};
    const auto change = [&](std::size_t k) { return load<FormFloats>(forms.slope + k) * (2.0f * radius); };
    const float size = std::fabs(twice[0]) + std::fabs(twice[1]) + std::fabs(twice[2]) + 4.0f * radius;
    return class_of(forms, twice, change, size, radius >= 0.0f);
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
    for (std::size_t k = forms.count; k-- > 0;) {
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
