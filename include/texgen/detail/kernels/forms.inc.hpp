// The forms of a slide, a lane each: made, rounded to float, and asked about one box. Included by kernels.inc.hpp.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

// q is split so that its products with a float are exact. What they leave of the sum is far below it, or nothing.
template <class CompiledWhereCalled = void>
void weigh_forms(const glm::dmat4& matrix, const FormWeights& weights, FormLanes& forms) noexcept {
    for (std::size_t i = 0; i < form_lanes; i += static_cast<std::size_t>(lanes)) {
        const Doubles of[3] = {load<Doubles>(weights.of[0] + i), load<Doubles>(weights.of[1] + i),
                               load<Doubles>(weights.of[2] + i)};
        const auto of_q = load<Doubles>(weights.of_q + i);
        Doubles form[4];
        TEXGEN_UNROLL
        for (std::size_t j = 0; j < 4; ++j) {
            const glm::dvec4& column = matrix[static_cast<glm::length_t>(j)];
            const double high = leading_26_bits(column.w);
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
        store(forms.error_a + i, largest * scale * gamma(8) * 1.001 + 0x1p-1000);
        store(forms.error_d + i, magnitude(form[3] * scale) * gamma(8) * 1.001 + 0x1p-1000);
    }
}

template <class CompiledWhereCalled = void>
void make_unit_forms(const FormLanes& forms, const double* slopes, UnitForms& result) noexcept {
    for (std::size_t i = 0; i < form_lanes; i += static_cast<std::size_t>(lanes)) {
        const Doubles scale = 1.0 / maximum(load<Doubles>(slopes + i), Doubles{} + 0x1p-800);
        const auto take = [&](const double* from, double* to) { store(to + i, load<Doubles>(from + i) * scale); };
        for (std::size_t j = 0; j < 3; ++j) take(forms.a[j], result.a[j]);
        take(forms.d, result.d);
        take(forms.narrowing, result.narrowing);
        take(forms.error_a, result.error_a);
        take(forms.error_d, result.error_d);
    }
    result.largest_q = forms.largest_q;
    result.last_q = forms.last_q;
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
    doubt = {.is_finite = is_proper};
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
    LongWords outside{}, negative{}, dark{};
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
    doubt.largest = doubt.least = 0;
    TEXGEN_UNROLL
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t first = i * static_cast<std::size_t>(lanes);
        const Doubles least = value[i] - change[i];
        const LongWords largest_is_open = ~greater(value[i] + change[i], error[i]);
        const LongWords is_negative = greater(0.0 - error[i], least);
        const LongWords is_inside = greater(least - error[i], load<Doubles>(forms.narrowing + first) * narrowed);
        const LongWords least_is_open = ~(is_inside | is_negative);
        negative = negative | is_negative;
        dark = dark | ~greater(value[i], error[i]);
        doubt.largest |= static_cast<std::uint32_t>(lane_bits(largest_is_open)) << first;
        doubt.least |= static_cast<std::uint32_t>(lane_bits(least_is_open)) << first;
    }
    doubt.is_any_negative = any(negative);
    if (doubt.largest == 0) {
        if (doubt.is_any_negative) return any(dark) ? open_body + 1 : 1;
        if (doubt.least == 0) return 2;
    }
    return body_in_doubt;
}

// Forms where they are largest over a finite box, or least: as sums of exact products with halves of the coefficients, and of
// what those leave, each of its terms rounded. Where they leave nothing, as numbers with few digits do, the value is exact;
// elsewhere its sign is known where it is larger than the roundings.
struct CloseForms {
    Doubles value;
    LongWords is_known;

    TEXGEN_INLINE CloseForms(const glm::dmat4& matrix, const Doubles (&of)[3], const Doubles& of_q,
                             const double (&at_positive)[4], const double (&at_negative)[4]) noexcept {
        Doubles high{}, low{}, size_of_low{};
        for (std::size_t j = 0; j < 4; ++j) {
            const glm::dvec4& column = matrix[static_cast<glm::length_t>(j)];
            const double half = leading_26_bits(column.w);
            const Doubles row = of[0] * column.x + (of[1] * column.y + of[2] * column.z);
            Doubles rest;
            const Doubles sum = two_sum(row, of_q * half, rest);
            rest = rest + of_q * (column.w - half);
            const Doubles x = select(greater(sum + rest, 0.0), Doubles{} + at_positive[j], Doubles{} + at_negative[j]);
            const Doubles first = leading_bits<27>(sum);
            Doubles left[3];
            high = two_sum(high, first * x, left[0]);
            high = two_sum(high, (sum - first) * x, left[1]);
            left[2] = rest * x;
            TEXGEN_UNROLL
            for (const Doubles& part : left) {
                low = low + part;
                size_of_low = size_of_low + magnitude(part);
            }
        }
        value = high + low;
        is_known = at_most(size_of_low, Doubles{}) | greater(magnitude(value), size_of_low * gamma(24) + 0x1p-1000);
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
        const auto bits_of = [i](const LongWords& mask) { return static_cast<std::uint32_t>(lane_bits(mask)) << i; };
        // Where they are largest, and then where they are least.
        for (int end = 0; end < 2; ++end) {
            std::uint32_t& in_doubt = end == 0 ? doubt.largest : doubt.least;
            if ((in_doubt & bits_of(~LongWords{})) == 0 || (end == 1 && doubt.is_any_negative)) continue;
            const CloseForms close(matrix, of, load<Doubles>((end == 0 ? weights.of_q : weights.inner_of_q) + i),
                                   end == 0 ? max : min, end == 0 ? min : max);
            const std::uint32_t settled = in_doubt & bits_of(close.is_known);
            constexpr std::uint32_t bit_of_q = 1u << form_of_q;
            const bool any_is_negative = (settled & (bits_of(greater(Doubles{}, close.value)) |
                                                     (bits_of(~greater(close.value, 0.0)) & bit_of_q))) != 0;
            in_doubt &= ~settled;
            if (end == 0 && any_is_negative) return true;
            doubt.is_any_negative |= any_is_negative;
        }
    }
    return false;
}

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
