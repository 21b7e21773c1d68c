// The forms of a slide, a lane each: made, rounded to float, and asked about one box. Included by kernels.inc.hpp.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

// The weights of forms, a lane each.
struct WeightLanes {
    Doubles of[3], of_q;

    TEXGEN_INLINE WeightLanes(const FormWeights& weights, std::size_t i) noexcept
        : of{load<Doubles>(weights.of[0] + i), load<Doubles>(weights.of[1] + i), load<Doubles>(weights.of[2] + i)},
          of_q(load<Doubles>(weights.of_q + i)) {}
};

// A coefficient of each form, from a column of the matrix: exactly, as a sum of parts far below one another, for which
// q is split so that its products with a float are exact; and rounded.
struct CoefficientLanes {
    Doubles part[3], rounded;

    CoefficientLanes() = default;
    TEXGEN_INLINE CoefficientLanes(const WeightLanes& weights, const glm::dvec4& column) noexcept {
        const double half = detail::leading_bits<26>(column.w);
        const Doubles row = weights.of[0] * column.x + (weights.of[1] * column.y + weights.of[2] * column.z);
        Doubles rest;
        part[0] = two_sum(row, weights.of_q * half, rest);
        part[1] = two_sum(rest, weights.of_q * (column.w - half), part[2]);
        rounded = part[0] + part[1];
    }
};

template <class CompiledWhereCalled = void>
void weigh_forms(const glm::dmat4& matrix, const FormWeights& weights, FormLanes& forms) noexcept {
    for (std::size_t i = 0; i < form_lanes; i += at_once) {
        const WeightLanes of(weights, i);
        Doubles form[4];
        TEXGEN_FOR (int j = 0; j < 4; ++j)
            form[j] = CoefficientLanes(of, matrix[static_cast<glm::length_t>(j)]).rounded;
        const Doubles largest = maximum(maximum(magnitude(form[0]), magnitude(form[1])), magnitude(form[2]));
        const Doubles size = select(greater(largest, 0.0), largest, maximum(magnitude(form[3]), Doubles{} + 0x1p-900));
        const Doubles scale = 1.0 / power_of_two_below(size);
        for (std::size_t j = 0; j < 3; ++j) store(forms.a[j] + i, form[j] * scale);
        store(forms.d + i, form[3] * scale);
        store(forms.narrowing + i, load<Doubles>(forms.narrowing + i) * scale);
        store(forms.error_a + i, largest * scale * gamma(8) * 1.001 + 0x1p-1000);
        store(forms.error_d + i, magnitude(form[3] * scale) * gamma(8) * 1.001 + 0x1p-1000);
    }
}

// Scales forms by powers of two so that one bound serves all: 7 u (max|a_j| size + |d|) with u = 2^-24, see classes(),
// and 0.1 u for the bound's own roundings; 8.1 leaves room for one more. The change over a sphere, whose slope may be
// sqrt(3) max|a_j|, errs by at most 3 u of it, less than 8.1 u of four radii.
// |a_j| and |d| are so small that nothing overflows before the size does. The bound has room for the inner sides, too.
// How much a form changes within the scene matters, and the distances of the sides from the origin tell how large that
// is: a form that hardly changes there (q, nearly orthographic, or a far plane) is not scaled up to the others. Nor is
// a limit of depth that its rounding moves far.
template <class CompiledWhereCalled = void>
void round_forms(const FormLanes& forms, std::size_t count, FloatForms& result) noexcept {
    Doubles gradient[form_lanes / at_once];
    double distance[form_lanes];
    for (std::size_t i = 0; i < form_lanes; i += at_once) {
        Doubles& sum = gradient[i / at_once];
        sum = magnitude(load<Doubles>(forms.a[0] + i)) + magnitude(load<Doubles>(forms.a[1] + i)) +
              magnitude(load<Doubles>(forms.a[2] + i));
        // A constant form, whose d is about 1, is at no distance.
        store(distance + i,
              where(greater(sum, 0.0), magnitude(load<Doubles>(forms.d + i)) / maximum(sum, Doubles{} + 0x1p-900)));
    }
    const double extent = larger(larger(distance[0], distance[1]), larger(distance[2], distance[3]));
    const double per_extent = extent > 0.0 ? 1.0 / extent : 0.0;
    const double of_narrowing = 0x1p22 * (forms.largest_q + forms.last_q * per_extent);
    constexpr double is_depth[form_lanes] = {0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0};
    Doubles largest_a{}, largest_d{}, largest_narrowing{};
    for (std::size_t i = 0; i < form_lanes; i += at_once) {
        const auto d = load<Doubles>(forms.d + i);
        const auto narrowing = load<Doubles>(forms.narrowing + i);
        const Doubles size = maximum(load<Doubles>(is_depth + i) * narrowing * of_narrowing,
                                     maximum(gradient[i / at_once], magnitude(d) * per_extent));
        const Doubles scale = where(greater(size, 0x1p-900) & ~greater(size, 0x1p900),
                                    0.125 / maximum(power_of_two_below(size), Doubles{} + 0x1p-900));
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
    const double bound_d = largest_of(largest_d), most_narrowed = largest_of(largest_narrowing);
    const double error_a = 8.1 * unit_roundoff_float * largest_of(largest_a) + 1.1 * most_narrowed * forms.largest_q;
    const double error_d = 8.1 * unit_roundoff_float * (bound_d < 0x1p100 ? bound_d : infinity) +  // nothing is certain
                           1.1 * most_narrowed * forms.last_q;
    result.count = count;
    result.error_per_size = static_cast<float>(error_a + 0x1p-100);
    result.error = static_cast<float>(2.0 * error_d + 0x1p-100);
}

// One box in double, a lane a form: twice the value in its middle, and how much it changes to either end. A sum or
// difference of two corners is rounded, as are a coefficient, a product, three sums of them and the sum of the two: 8
// u. Nothing is certain of an infinite coordinate.
template <class CompiledWhereCalled = void>
int classify_box(const FormLanes& forms, const float* box_min, const float* box_max) noexcept {
    double sum[3], extent[3], size[3];
    bool is_certain = true;
    for (std::size_t j = 0; j < 3; ++j) {
        const double min = widened(box_min[j]), max = widened(box_max[j]);
        sum[j] = min + max;
        extent[j] = max - min;
        size[j] = std::fabs(sum[j]) + extent[j];
        is_certain &= extent[j] >= 0.0;
        is_certain &= size[j] < infinity;
    }
    if (!is_certain) return body_in_doubt;
    const double narrowed = 2.2 * forms.last_q + 1.1 * forms.largest_q * (size[0] + size[1] + size[2]);

    constexpr std::size_t count = form_lanes / at_once;
    Doubles value[count], change[count], error[count];
    LongWords outside{}, negative{}, open{}, not_inside{}, dark{};
    TEXGEN_FOR (std::size_t i = 0; i < count; ++i) {
        const std::size_t first = i * at_once;
        const Doubles a[3] = {load<Doubles>(forms.a[0] + first), load<Doubles>(forms.a[1] + first),
                              load<Doubles>(forms.a[2] + first)};
        const Doubles twice_d = load<Doubles>(forms.d + first) * 2.0;
        value[i] = (a[0] * sum[0] + a[1] * sum[1]) + (a[2] * sum[2] + twice_d);
        change[i] = magnitude(a[0]) * extent[0] + (magnitude(a[1]) * extent[1] + magnitude(a[2]) * extent[2]);
        error[i] =
            (magnitude(a[0]) * size[0] + magnitude(a[1]) * size[1]) + (magnitude(a[2]) * size[2] + magnitude(twice_d));
        error[i] = minimum(error[i], Doubles{} + 0x1p900) * gamma(8);
        outside = outside | greater(0.0 - error[i], value[i] + change[i]);
    }
    if (any(outside)) return 0;
    TEXGEN_FOR (std::size_t i = 0; i < count; ++i) {
        const Doubles least = value[i] - change[i];
        const auto narrowing = load<Doubles>(forms.narrowing + i * at_once);
        open = open | ~greater(value[i] + change[i], error[i]);
        negative = negative | greater(0.0 - error[i], least);
        not_inside = not_inside | ~greater(least - error[i], narrowing * narrowed);
        dark = dark | ~greater(value[i], error[i]);
    }
    if (any(open)) return any(negative) ? body_not_inside : body_in_doubt;
    if (any(negative)) return any(dark) ? open_body + 1 : 1;
    return any(not_inside) ? body_not_outside : 2;
}

// Numbers with the exact signs of forms where they are largest over a box that has points, or least. A double decides
// where it is larger than its roundings, or infinite; then two doubles, where they leave nothing, as of numbers with
// few digits, or are larger than the roundings of what they leave. Then what they leave is summed without loss as far
// as two doubles go: that is all of it on a side that is touched, but for the tiny weight of q beside a side at 0. At
// last exact sums decide, of 21 numbers at most. A coordinate whose coefficient is 0 is not used.
TEXGEN_INLINE Doubles signed_forms(const glm::dmat4& matrix, const WeightLanes& weights, const double (&at_positive)[3],
                                   const double (&at_negative)[3]) noexcept {
    const CoefficientLanes constant(weights, matrix[3]);
    CoefficientLanes coefficient[3];
    Doubles at[3], value = constant.rounded, size = magnitude(value);
    TEXGEN_FOR (int j = 0; j < 3; ++j) {
        coefficient[j] = CoefficientLanes(weights, matrix[static_cast<glm::length_t>(j)]);
        const Doubles& rounded = coefficient[j].rounded;
        at[j] = where(are_nonzero(rounded),
                      select(greater(rounded, 0.0), Doubles{} + at_positive[j], Doubles{} + at_negative[j]));
        const Doubles term = rounded * at[j];
        value = value + term;
        size = size + magnitude(term);
    }
    // A coefficient is rounded twice, its product once, and their sums.
    LongWords is_open = at_most(magnitude(value), minimum(size * gamma(8) + 0x1p-1000, Doubles{} + 0x1p1000));
    if (!any(is_open)) return value;
    Doubles left[3][3];
    Doubles high = constant.part[0], low = constant.part[1];
    Doubles size_of_low = magnitude(low), last = magnitude(constant.part[2]);
    TEXGEN_FOR (int j = 0; j < 3; ++j) {
        const Doubles(&part)[3] = coefficient[j].part;
        const Doubles first = leading_bits<27>(part[0]);
        high = two_sum(high, first * at[j], left[j][0]);
        high = two_sum(high, (part[0] - first) * at[j], left[j][1]);
        left[j][2] = part[1] * at[j];
        TEXGEN_FOR (const Doubles& number : left[j]) {
            low = low + number;
            size_of_low = size_of_low + magnitude(number);
        }
        last = last + magnitude(part[2]);
    }
    const auto take = [&](const Doubles& sum, const Doubles& lost) {
        value = select(is_open, sum, value);
        is_open &= greater(lost, 0.0) & ~greater(magnitude(sum), lost * gamma(24) + 0x1p-1000);
    };
    take(high + low, size_of_low);
    if (!any(is_open)) return value;
    // Beyond high + low there are 16 numbers, each rounded once, their sum fifteen times, and the whole twice.
    Doubles rest = constant.part[2], lost = magnitude(rest);
    low = constant.part[1];
    TEXGEN_FOR (int j = 0; j < 3; ++j) {
        const auto& [part, rounded] = coefficient[j];
        const Doubles first = leading_bits<27>(part[1]);
        Doubles of_low[5] = {{}, {}, {}, (part[1] - first) * at[j], part[2] * at[j]};
        low = two_sum(low, left[j][0], of_low[0]);
        low = two_sum(low, left[j][1], of_low[1]);
        low = two_sum(low, first * at[j], of_low[2]);
        TEXGEN_FOR (const Doubles& number : of_low) {
            rest = rest + number;
            lost = lost + magnitude(number);
        }
    }
    take((high + low) + rest, lost);
    if (!any(is_open)) return value;
    const int parts = any(are_nonzero(last)) ? 3 : 2;
    Doubles term[21];
    Doubles* next = term;
    for (int k = 0; k < parts; ++k) {
        *next++ = constant.part[k];
        TEXGEN_FOR (int j = 0; j < 3; ++j) {
            const Doubles first = leading_bits<27>(coefficient[j].part[k]);
            *next++ = first * at[j];
            *next++ = (coefficient[j].part[k] - first) * at[j];
        }
    }
    // Parts that cancel are larger than the coefficient, so sizes are summed anew.
    const std::size_t terms = static_cast<std::size_t>(7 * parts);
    size = Doubles{};
    for (std::size_t k = 0; k < terms; ++k) size = size + magnitude(term[k]);
    return select(is_open, signed_sum(term, terms, power_of_two_below(size) * 8.0, is_open), value);
}

template <class CompiledWhereCalled = void>
int decide_box(int answer, const glm::dmat4& matrix, const FormWeights& outer, const FormWeights& inner,
               const float* box_min, const float* box_max) noexcept {
    constexpr double least[form_lanes] = {0.0, 0.0, 0.0, 0.0, 0x1p-1000};  // q is not 0
    double min[3], max[3];
    for (std::size_t j = 0; j < 3; ++j) {
        min[j] = widened(box_min[j]);
        max[j] = widened(box_max[j]);
    }
    for (const bool is_largest : {true, false}) {
        if (answer == (is_largest ? body_not_outside : body_not_inside)) continue;
        for (std::size_t i = 0; i < form_lanes; i += at_once) {
            const Doubles value = signed_forms(matrix, WeightLanes(is_largest ? outer : inner, i),
                                               is_largest ? max : min, is_largest ? min : max);
            if (any(greater(load<Doubles>(least + i), value))) return is_largest ? 0 : 1;
        }
    }
    return answer == body_not_inside ? 1 : 2;
}

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
