// Boxes and spheres against linear forms. Included by lanes.hpp once per instruction set.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

// q is split so that its products with a float are exact. What they leave of the sum is far below it, or nothing.
template <class CompiledWhereCalled = void>
void weigh_forms(const glm::dmat4& matrix, const FormWeights& weights, FormLanes& forms) noexcept {
    TEXGEN_UNROLL
    for (std::size_t i = 0; i < form_lanes; i += static_cast<std::size_t>(lanes)) {
        const Doubles of[3] = {load<Doubles>(weights.of[0] + i), load<Doubles>(weights.of[1] + i),
                               load<Doubles>(weights.of[2] + i)};
        const auto of_q = load<Doubles>(weights.of_q + i);
        Doubles form[4];
        TEXGEN_UNROLL
        for (std::size_t j = 0; j < 4; ++j) {
            const glm::dvec4& column = matrix[static_cast<glm::length_t>(j)];
            const double high = bit_cast<double>(bit_cast<std::uint64_t>(column.w) & ~std::uint64_t{0x7ffffff});
            const double low = column.w - high;
            const Doubles row = of[0] * column.x + (of[1] * column.y + of[2] * column.z);
            Doubles rest;
            const Doubles sum = two_sum(row, of_q * high, rest);
            form[j] = sum + (rest + of_q * low);
        }
        const Doubles largest = maximum(maximum(magnitude(form[0]), magnitude(form[1])), magnitude(form[2]));
        const Doubles size = select(greater(largest, 0.0), largest, maximum(magnitude(form[3]), Doubles{} + 0x1p-900));
        const Doubles scale = 1.0 / power_of_two_below(size);
        for (std::size_t j = 0; j < 3; ++j) store(forms.a[j] + i, form[j] * scale);
        store(forms.d + i, form[3] * scale);
        store(forms.narrowing + i, load<Doubles>(weights.width + i) * scale);
    }
}

// Scaled by powers of two so that one bound serves all: 7 u (max|a_j| size + |d|) with u = 2^-24, see classes(), and 0.1 u for
// the bound's own roundings; 8.1 leaves room for one more. The change over a sphere, whose slope may be sqrt(3) max|a_j|,
// errs by at most 3 u of it, less than 8.1 u of four radii.
// |a_j| and |d| are so small that nothing overflows before the size does. What holds with room for the inner sides holds for
// both, so one bound has that room, too.
// A form is worth as much as it changes within the scene. How large that is, the distances of the sides from the origin
// tell: a form that hardly changes there (q, nearly orthographic, or a far plane) is not scaled up to them. Nor is a limit of
// depth whose rounding moves it far.
template <class CompiledWhereCalled = void>
void round_forms(const FormLanes& forms, std::size_t count, FloatForms& result) noexcept {
    Doubles gradient[form_lanes / static_cast<std::size_t>(lanes)];
    double distance[form_lanes];
    for (std::size_t i = 0; i < form_lanes; i += static_cast<std::size_t>(lanes)) {
        Doubles& sum = gradient[i / static_cast<std::size_t>(lanes)];
        sum = magnitude(load<Doubles>(forms.a[0] + i)) + magnitude(load<Doubles>(forms.a[1] + i)) +
              magnitude(load<Doubles>(forms.a[2] + i));
        store(distance + i, where(greater(sum, 0.0), magnitude(load<Doubles>(forms.d + i)) / sum));
    }
    const double extent = larger(larger(distance[0], distance[1]), larger(distance[2], distance[3]));
    const double per_extent = extent > 0.0 ? 1.0 / extent : 0.0;
    const double of_narrowing = 0x1p22 * (forms.largest_q + forms.last_q * per_extent);
    constexpr double is_depth[form_lanes] = {0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0};
    Doubles largest_a{}, largest_d{}, largest_narrowing{};
    for (std::size_t i = 0; i < form_lanes; i += static_cast<std::size_t>(lanes)) {
        const auto d = load<Doubles>(forms.d + i);
        const auto narrowing = load<Doubles>(forms.narrowing + i);
        const Doubles size = maximum(load<Doubles>(is_depth + i) * narrowing * of_narrowing,
                                     maximum(gradient[i / static_cast<std::size_t>(lanes)], magnitude(d) * per_extent));
        const Doubles scale =
            where(greater(size, 0x1p-900) & ~greater(size, 0x1p900), 0.125 / power_of_two_below(size));
        Doubles squared{};
        for (std::size_t j = 0; j < 3; ++j) {
            const Doubles a = load<Doubles>(forms.a[j] + i) * scale;
            squared = squared + a * a;
            largest_a = maximum(magnitude(a), largest_a);
            store(result.a[j] + i, to_floats(a));
            store(result.magnitude_of_a[j] + i, to_floats(magnitude(a)));
        }
        store(result.slope + i, to_floats(squared));
        store(result.twice_d + i, to_floats(d * scale * 2.0));
        largest_d = maximum(magnitude(d * scale), largest_d);
        largest_narrowing = maximum(narrowing * scale, largest_narrowing);
    }
    for (float& slope : result.slope) slope = std::sqrt(slope);
    const auto largest_of = [](const Doubles& values) {
        double largest = values[0];
        for (int i = 1; i < lanes; ++i) largest = larger_or_nan(largest, values[i]);
        return largest;
    };
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const double bound_d = largest_of(largest_d);
    const double most_narrowed = largest_of(largest_narrowing);
    const double error_a = 8.1 * unit_roundoff_float * largest_of(largest_a) + 1.1 * most_narrowed * forms.largest_q;
    const double error_d = 8.1 * unit_roundoff_float * (bound_d < 0x1p100 ? bound_d : infinity) +  // nothing is certain
                           1.1 * most_narrowed * forms.last_q;
    result.count = count;
    result.error_per_size = static_cast<float>(error_a + 0x1p-100);
    result.error = static_cast<float>(2.0 * error_d + 0x1p-100);
}

// One box in double, a lane a form: twice the value in its middle, and how much it changes to either end. A sum or difference
// of two corners is rounded, as are a coefficient, a product, three sums of them and the sum of the two: 8 u. Of a form that
// uses a coordinate which is infinite nothing is certain here.
template <class CompiledWhereCalled = void>
int classify_box(const FormLanes& forms, const float* box_min, const float* box_max, FormsInDoubt& doubt) noexcept {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    double sum[3], extent[3], size[3];
    bool is_proper = true;
    for (std::size_t j = 0; j < 3; ++j) {
        const double min = widened(box_min[j]);
        const double max = widened(box_max[j]);
        sum[j] = min + max;
        extent[j] = max - min;
        size[j] = std::fabs(sum[j]) + extent[j];
        is_proper &= extent[j] >= 0.0;
        is_proper &= size[j] < infinity;
    }
    doubt = {~0u, ~0u, false, is_proper};
    double narrowed = 2.2 * forms.last_q;
    bool is_unbounded[3] = {};
    if (!is_proper) {
        for (std::size_t j = 0; j < 3; ++j) {
            if (!(extent[j] >= 0.0)) return body_in_doubt;
            is_unbounded[j] = !(size[j] < infinity);
            if (!is_unbounded[j]) continue;
            sum[j] = extent[j] = size[j] = 0.0;
            if (forms.a[j][form_of_q] != 0.0) narrowed = infinity;
        }
    }
    narrowed += 1.1 * forms.largest_q * (size[0] + size[1] + size[2]);

    constexpr std::size_t count = form_lanes / static_cast<std::size_t>(lanes);
    Doubles value[count], change[count], error[count];
    LongWords outside{}, open_largest{}, negative{}, open_least{}, dark{};
    TEXGEN_UNROLL
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t first = i * static_cast<std::size_t>(lanes);
        const Doubles a[3] = {load<Doubles>(forms.a[0] + first), load<Doubles>(forms.a[1] + first),
                              load<Doubles>(forms.a[2] + first)};
        const Doubles twice_d = load<Doubles>(forms.d + first) * 2.0;
        value[i] = (a[0] * sum[0] + a[1] * sum[1]) + (a[2] * sum[2] + twice_d);
        change[i] = magnitude(a[0]) * extent[0] + (magnitude(a[1]) * extent[1] + magnitude(a[2]) * extent[2]);
        error[i] =
            (magnitude(a[0]) * size[0] + magnitude(a[1]) * size[1]) + (magnitude(a[2]) * size[2] + magnitude(twice_d));
        error[i] = minimum(error[i], Doubles{} + 0x1p900) * gamma(8);
        for (std::size_t j = 0; j < 3; ++j)
            if (is_unbounded[j]) error[i] = select(greater(magnitude(a[j]), 0.0), Doubles{} + infinity, error[i]);
        outside = outside | greater(0.0 - error[i], value[i] + change[i]);
    }
    if (any(outside)) return 0;
    int largest_in_doubt[form_lanes], least_in_doubt[form_lanes];
    TEXGEN_UNROLL
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t first = i * static_cast<std::size_t>(lanes);
        const Doubles least = value[i] - change[i];
        const LongWords largest_is_open = ~greater(value[i] + change[i], error[i]);
        const LongWords is_negative = greater(0.0 - error[i], least);
        const LongWords is_inside = greater(least - error[i], load<Doubles>(forms.narrowing + first) * narrowed);
        const LongWords least_is_open = ~(is_inside | is_negative);
        open_largest = open_largest | largest_is_open;
        negative = negative | is_negative;
        open_least = open_least | least_is_open;
        dark = dark | ~greater(value[i], error[i]);
        store(largest_in_doubt + first, narrow(largest_is_open));
        store(least_in_doubt + first, narrow(least_is_open));
    }
    doubt.is_any_negative = any(negative);
    if (!any(open_largest)) {
        if (doubt.is_any_negative) return any(dark) ? open_body + 1 : 1;
        if (!any(open_least)) return 2;
    }
    doubt.largest = doubt.least = 0;
    for (std::size_t k = 0; k < max_forms; ++k) {
        doubt.largest |= (static_cast<std::uint32_t>(largest_in_doubt[k]) & 1u) << k;
        doubt.least |= (static_cast<std::uint32_t>(least_in_doubt[k]) & 1u) << k;
    }
    return body_in_doubt;
}

// Forms where they are largest over a finite box, or least: as sums of exact products with halves of the coefficients, and of
// what those leave. That is below 2^-26 of the terms, and its own roundings below 2^-76; where it is 0, as it is for numbers
// with few digits, the value is exact. Elsewhere its sign is known where it is larger than that.
struct CloseForms {
    Doubles value;
    LongWords is_known;

    TEXGEN_INLINE CloseForms(const glm::dmat4& matrix, const Doubles (&of)[3], const Doubles& of_q,
                             const double (&at_positive)[4], const double (&at_negative)[4]) noexcept {
        Doubles high{}, low{}, lost{}, size{};
        TEXGEN_UNROLL
        for (std::size_t j = 0; j < 4; ++j) {
            const glm::dvec4& column = matrix[static_cast<glm::length_t>(j)];
            const double half = bit_cast<double>(bit_cast<std::uint64_t>(column.w) & ~std::uint64_t{0x7ffffff});
            const Doubles row = of[0] * column.x + (of[1] * column.y + of[2] * column.z);
            Doubles rest;
            const Doubles sum = two_sum(row, of_q * half, rest);
            rest = rest + of_q * (column.w - half);
            const Doubles x = select(greater(sum + rest, 0.0), Doubles{} + at_positive[j], Doubles{} + at_negative[j]);
            const Doubles first = leading_bits<27>(sum);
            for (const Doubles& part : {first, sum - first}) {
                Doubles left;
                high = two_sum(high, part * x, left);
                low = low + left;
                lost = lost + magnitude(left);
            }
            low = low + rest * x;
            lost = lost + magnitude(rest * x);
            size = size + (magnitude(row) + magnitude(of_q * column.w)) * magnitude(x);
        }
        value = high + low;
        is_known = at_most(lost, Doubles{}) | greater(magnitude(value), size * 0x1p-76);
    }
};

template <class CompiledWhereCalled = void>
bool sharpen(const glm::dmat4& matrix, const FormWeights& weights, const float* box_min, const float* box_max,
             FormsInDoubt& doubt) noexcept {
    double min[4] = {0.0, 0.0, 0.0, 1.0}, max[4] = {0.0, 0.0, 0.0, 1.0};
    for (std::size_t j = 0; j < 3; ++j) {
        min[j] = widened(box_min[j]);
        max[j] = widened(box_max[j]);
    }
    for (std::size_t i = 0; i < form_lanes; i += static_cast<std::size_t>(lanes)) {
        const Doubles of[3] = {load<Doubles>(weights.of[0] + i), load<Doubles>(weights.of[1] + i),
                               load<Doubles>(weights.of[2] + i)};
        int is_known[lanes];
        double value[lanes];
        const auto settle = [&](const CloseForms& close, std::uint32_t& in_doubt) {
            store(is_known, narrow(close.is_known));
            store(value, close.value);
            bool any_is_negative = false;
            for (std::size_t lane = 0; lane < static_cast<std::size_t>(lanes); ++lane) {
                const std::uint32_t bit = std::uint32_t{1} << (i + lane);
                if ((in_doubt & bit) == 0 || is_known[lane] == 0) continue;
                in_doubt &= ~bit;
                any_is_negative |= value[lane] < 0.0 || (i + lane == form_of_q && value[lane] == 0.0);
            }
            return any_is_negative;
        };
        const std::uint32_t here = ((std::uint32_t{1} << lanes) - 1) << i;
        if ((doubt.largest & here) != 0 &&
            settle({matrix, of, load<Doubles>(weights.of_q + i), max, min}, doubt.largest))
            return true;
        if (!doubt.is_any_negative && (doubt.least & here) != 0)
            doubt.is_any_negative = settle({matrix, of, load<Doubles>(weights.inner_of_q + i), min, max}, doubt.least);
    }
    return false;
}

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

// As exact_coverage() of a sphere, where every rounding here and there together could not change what it says: its bounds are
// twice what is rounded, so half of one more or less decides. A root is a square here.
template <class CompiledWhereCalled = void>
void bound_spheres(const SphereForms& forms, const SphereBlock& spheres, int* classes) noexcept {
    for (std::size_t i = 0; i < box_block; i += static_cast<std::size_t>(lanes)) {
        const Doubles centre[3] = {load<Doubles>(spheres.centre[0] + i), load<Doubles>(spheres.centre[1] + i),
                                   load<Doubles>(spheres.centre[2] + i)};
        const auto radius = load<Doubles>(spheres.radius + i);
        const Doubles size = magnitude(centre[0]) + magnitude(centre[1]) + magnitude(centre[2]);
        const Doubles of_q = ((size + radius * 2.0) * forms.largest_q + forms.last_q) * 1.1;
        Doubles value[max_forms], error[max_forms];
        LongWords outside{}, perhaps_outside{}, dark{}, not_inside{}, perhaps_inside = ~outside;
        for (std::size_t k = 0; k < forms.count; ++k) {
            const LinearForm& form = forms.form[k];
            value[k] = centre[0] * form.a[0] + (centre[1] * form.a[1] + (centre[2] * form.a[2] + form.d));
            error[k] = size * form.error_a + form.error_d;
            const Doubles change = radius * forms.slope[k];
            const Doubles rounding = error[k] + change * gamma(4);
            const Doubles least = value[k] - change - of_q * forms.narrowing[k];
            outside = outside | greater(rounding * -1.5, value[k] + change);
            perhaps_outside = perhaps_outside | greater(rounding * -0.5, value[k] + change);
            not_inside = not_inside | ~greater(least, rounding * 1.5);
            perhaps_inside = perhaps_inside & greater(least, rounding * 0.5);
            dark = dark | greater(0.0 - value[k], 0.0);
        }
        const auto try_edge = [&](std::size_t f, std::size_t g) {
            const LongWords asked = (greater(0.0 - value[f], 0.0) | greater(0.0 - value[g], 0.0)) & ~outside;
            if (!any(asked)) return;
            const auto& a = forms.form[f].a;
            const auto& b = forms.form[g].a;
            const double across = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
            const double squared_f = forms.slope[f] * forms.slope[f];
            const double squared_g = forms.slope[g] * forms.slope[g];
            Doubles of_f = value[g] * across - value[f] * squared_g;
            Doubles of_g = value[f] * across - value[g] * squared_f;
            const LongWords faces = greater(of_f, 0.0) & greater(of_g, 0.0) & asked;
            if (!any(faces)) return;
            const Doubles both = 1.0 / (of_f + of_g);
            of_f = of_f * both;
            of_g = of_g * both;
            const Doubles longest = of_f * forms.slope[f] + of_g * forms.slope[g];
            const Doubles squared = (of_f * of_f * squared_f + of_f * of_g * (2.0 * across) + of_g * of_g * squared_g +
                                     longest * longest * gamma(32)) *
                                    (radius * radius);
            const Doubles sum = of_f * value[f] + of_g * value[g];
            const Doubles rounding = (of_f * error[f] + of_g * error[g]) +
                                     (of_f * magnitude(value[f]) + of_g * magnitude(value[g])) * gamma(8);
            const Doubles reach = sum + rounding * 1.5;
            const Doubles perhaps = sum + rounding * 0.5;
            outside =
                outside | (faces & greater(0.0 - reach, 0.0) & greater(reach * reach, squared * (1.0 + gamma(40))));
            perhaps_outside =
                perhaps_outside | (faces & greater(0.0 - perhaps, 0.0) & greater(perhaps * perhaps, squared));
        };
        if (any(dark & ~outside)) {
            for (std::size_t f = 0; f < 2; ++f)
                for (std::size_t g = 2; g < form_of_q; ++g) try_edge(f, g);
            for (std::size_t f = 0; f < form_of_q; ++f)
                for (std::size_t g = form_of_q + 1; g < forms.count; ++g) try_edge(f, g);
        }
        const LongWords inside = ~not_inside;
        const LongWords in_doubt = (perhaps_outside & ~outside) | (perhaps_inside & not_inside & ~outside);
        const Words is_outside = narrow(outside), is_inside = narrow(inside & ~outside), doubts = narrow(in_doubt);
        int each[3][lanes];
        store(each[0], is_outside);
        store(each[1], is_inside);
        store(each[2], doubts);
        for (std::size_t lane = 0; lane < static_cast<std::size_t>(lanes); ++lane)
            classes[i + lane] = each[2][lane] != 0   ? body_in_doubt
                                : each[0][lane] != 0 ? 0
                                : each[1][lane] != 0 ? 2
                                                     : 1;
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
