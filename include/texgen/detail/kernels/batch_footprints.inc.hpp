// The inner loops of a batch: footprints of fragments of any of its triangles. Included by batch.inc.hpp.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

// What the footprints of the triangle in each lane share: the functions of triangle/planes.hpp about its first vertex,
// without a common factor. As they are made of floats, none leaves the range of double.
struct FootprintLanes {
    VertexLanes given;
    Doubles q, q_dx, q_dy;
    Doubles q_size, q_size_dx, q_size_dy;  // the sizes of their terms
    Doubles dx[2], dy[2], twist[2];        // BoundedSlope's, but for the area and all w
    Doubles w;                             // of all vertices
    LongWords is_refused;                  // a w is not positive, or an s, t or r not finite

    // Takes one triangle for all lanes, or one for each.
    TEXGEN_INLINE void take(const auto& triangle) noexcept {
        given.take(triangle);
        const auto number = [&](std::size_t i, std::size_t k) { return given.number(i, k); };
        const Doubles b_x = number(1, 0) - number(0, 0), b_y = number(1, 1) - number(0, 1);
        const Doubles c_x = number(2, 0) - number(0, 0), c_y = number(2, 1) - number(0, 1);
        const Doubles size_b_x = magnitude(b_x), size_b_y = magnitude(b_y);
        const Doubles size_c_x = magnitude(c_x), size_c_y = magnitude(c_y);
        const auto weighted = [&](std::size_t i, std::size_t j, std::size_t k) {
            return number(i, 6) * with_sign_of(number(j, 2) * number(k, 2), given.area);
        };
        const Doubles at_a = weighted(0, 1, 2), at_b = weighted(1, 2, 0), at_c = weighted(2, 0, 1);
        const Doubles b_minus_a = at_b - at_a, c_minus_a = at_c - at_a;
        q = at_a * given.area;
        q_dx = b_minus_a * c_y - c_minus_a * b_y;
        q_dy = c_minus_a * b_x - b_minus_a * c_x;
        const Doubles size_a = magnitude(at_a);
        const Doubles b_and_a = magnitude(at_b) + size_a, c_and_a = magnitude(at_c) + size_a;
        q_size = size_a * (size_b_x * size_c_y + size_b_y * size_c_x);
        q_size_dx = b_and_a * size_c_y + c_and_a * size_b_y;
        q_size_dy = c_and_a * size_b_x + b_and_a * size_c_x;
        TEXGEN_FOR (std::size_t k = 0; k < 2; ++k) {
            const auto mu = [&](std::size_t i, std::size_t j, std::size_t other) {
                return (number(i, 3 + k) * number(j, 6) - number(j, 3 + k) * number(i, 6)) * number(other, 2);
            };
            const Doubles ab = mu(0, 1, 2), bc = mu(1, 2, 0), ca = mu(2, 0, 1);
            dx[k] = (ab * c_y + ca * b_y) * -1.0;
            dy[k] = ab * c_x + ca * b_x;
            twist[k] = ab + bc + ca;
        }
        w = number(0, 2) * number(1, 2) * number(2, 2);
        Doubles sizes{};
        TEXGEN_FOR (std::size_t i = 0; i < 3; ++i)
            sizes = sizes + (magnitude(number(i, 3)) + magnitude(number(i, 4)) + magnitude(number(i, 5)));
        is_refused = ~(greater(number(0, 2), 0.0) & greater(number(1, 2), 0.0) & greater(number(2, 2), 0.0) &
                       greater(Doubles{} + infinity, sizes));
    }
};

// The derivatives of s/q and t/q at a fragment of the triangle in each lane.
struct JacobianLanes {
    Doubles dx[2], dy[2];
    LongWords front, doubtful;
    Doubles q, factor;

    TEXGEN_INLINE void take(const FootprintLanes& of, const Doubles& x, const Doubles& y) noexcept {
        const Doubles p_x = x - of.given.number(0, 0), p_y = y - of.given.number(0, 1);
        q = of.q + (of.q_dx * p_x + of.q_dy * p_y);
        const Doubles error =
            (of.q_size + (of.q_size_dx * magnitude(p_x) + of.q_size_dy * magnitude(p_y))) * gamma(20) +
            of.given.error_of_q;
        front = greater(q * cancelled_share, error) & ~of.is_refused;
        doubtful = ~(front | greater(q * -1.0, error) | of.is_refused);
        if (any(doubtful)) find_q_closely(of.given, x, y);
        const Doubles reciprocal = where(front, 1.0 / select(front, q, Doubles{} + 1.0));
        factor = (of.given.area * reciprocal) * (of.w * reciprocal);
        const Doubles size = magnitude(factor);  // the one product that may leave the range
        doubtful |= front & ~(greater(size, 0x1p-1000) & greater(Doubles{} + 0x1p1000, size));
        TEXGEN_FOR (std::size_t k = 0; k < 2; ++k) {
            dx[k] = (of.dx[k] + p_y * of.twist[k]) * factor;
            dy[k] = (of.dy[k] - p_x * of.twist[k]) * factor;
        }
    }

private:
    // Finds q in two doubles; it is 0 where it is less than half of the grain of its terms.
    TEXGEN_APART void find_q_closely(const VertexLanes& given, const Doubles& x, const Doubles& y) noexcept {
        const CloseValues close = CloseLanes(given, x, y).function(given, 3);
        const Doubles error = close.error + given.error_of_q;
        const LongWords in_front = greater(close.high * cancelled_share, error);
        LongWords is_known = in_front | greater(close.high * -0.5, error);
        if (any(doubtful & ~is_known)) {
            const Doubles grain = ResidueLanes(given, x, y).values(3).grain;
            is_known |= greater(grain * 0.5, magnitude(close.high) + error);
        }
        is_known &= doubtful;
        front |= is_known & in_front;
        doubtful &= ~is_known;
        q = select(is_known, close.high, q);
    }
};

// The determinant of the corners' (s, t, q), as FloatDeterminant has it in two doubles: det J is that times q and the
// square of the factor before the derivatives. It is 0 where it and its error are less than half a grain of its terms.
struct DeterminantLanes {
    Doubles value;
    LongWords is_known;

    TEXGEN_APART explicit DeterminantLanes(const VertexLanes& given) noexcept {
        const auto number = [&](std::size_t i, std::size_t k) { return given.number(i, k); };
        Doubles size{}, high{}, rest{};
        TEXGEN_FOR (std::size_t k = 0; k < 3; ++k) {
            const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
            const Doubles left = number(i, 3) * number(j, 4), right = number(j, 3) * number(i, 4);
            EdgeLanes minor;
            minor.high = two_sum(left, right * -1.0, minor.low);
            minor.multiply(number(k, 6));
            size = size + (magnitude(left) + magnitude(right)) * magnitude(number(k, 6));
            Doubles error;
            high = two_sum(high, minor.high, error);
            rest = rest + (error + minor.low);
        }
        value = magnitude(high + rest);
        const Doubles error = size * 0x1p-96;
        const auto grain = [&](std::size_t k) { return IntegerLanes(number(0, k), number(1, k), number(2, k)).unit; };
        const LongWords is_zero = greater(grain(3) * grain(4) * grain(6) * 0.5, value + error);
        value = where(~is_zero, value);
        is_known = is_zero | greater(value, error);
    }
};

// J of a block's fragments in texels, column by column and relative to a power of two, so that floats hold it; with its
// determinant, which is made in double. That power is a product of two floats, of which the second is 1 but where J is
// very large or small, and the first is 0 where a fragment is not in front.
struct JacobianBlock {
    float dx[2][exact_block], dy[2][exact_block];
    float determinant[exact_block], unit[2][exact_block];

    // Vectors read beyond the last fragment.
    void clear() noexcept {
        *this = {};
        for (float& value : determinant) value = 1.0f;
    }

    // Returns the lanes that floats do not hold.
    TEXGEN_INLINE LongWords put(std::size_t n, const FootprintLanes& functions, const JacobianLanes& of,
                                const BatchFootprintsJob& job) noexcept {
        const Doubles s_dx = of.dx[0] * job.texels[0], t_dx = of.dx[1] * job.texels[1];
        const Doubles s_dy = of.dy[0] * job.texels[0], t_dy = of.dy[1] * job.texels[1];
        const Doubles size =
            maximum(maximum(magnitude(s_dx), magnitude(t_dx)), maximum(magnitude(s_dy), magnitude(t_dy)));
        const LongWords is_zero = ~are_nonzero(size);
        const Doubles power = select(is_zero, Doubles{} + 1.0, power_of_two_below(size));
        const Doubles per_unit = where(of.front, reciprocals_of_powers(power));
        const Doubles large = select(greater(size, 0x1p100), Doubles{} + 0x1p100, Doubles{} + 1.0);
        const Doubles second = select(greater(Doubles{} + 0x1p-100, size) & ~is_zero, Doubles{} + 0x1p-100, large);
        store(unit[0] + n, to_floats(where(of.front, power * reciprocals_of_powers(second))));
        store(unit[1] + n, to_floats(second));
        store(dx[0] + n, to_floats(s_dx * per_unit));
        store(dx[1] + n, to_floats(t_dx * per_unit));
        store(dy[0] + n, to_floats(s_dy * per_unit));
        store(dy[1] + n, to_floats(t_dy * per_unit));
        const LongWords is_held = is_zero | (greater(size, 0x1p-200) & greater(Doubles{} + 0x1p200, size));
        if (!job.has_shape()) return ~is_held;
        const Doubles left = (s_dx * per_unit) * (t_dy * per_unit), right = (s_dy * per_unit) * (t_dx * per_unit);
        Doubles det = magnitude(left - right);
        LongWords is_known =
            greater(det, maximum((magnitude(left) + magnitude(right)) * 0x1p-30, Doubles{} + 0x1p-100));
        if (any(of.front & ~is_known)) {
            const DeterminantLanes closely(functions.given);
            const Doubles of_s = of.factor * job.texels[0] * per_unit, of_t = of.factor * job.texels[1] * per_unit;
            det = magnitude((closely.value * of_s) * (of.q * of_t));
            is_known = closely.is_known & (greater(det, 0x1p-120) | ~are_nonzero(closely.value));
        }
        store(determinant + n, to_floats(select(of.front, det, Doubles{} + 1.0)));
        return ~(is_held & is_known);
    }

    // Computes what filters need of `count` fragments.
    TEXGEN_INLINE void filter(std::size_t begin, std::size_t count, const BatchFootprintsJob& job) const noexcept {
        for (std::size_t n = 0; n < count; n += wide_at_once) {
            const int some = count - n < wide_at_once ? static_cast<int>(count - n) : wide_lanes;
            const auto s_dx = load<WideFloats>(dx[0] + n), t_dx = load<WideFloats>(dx[1] + n);
            const auto s_dy = load<WideFloats>(dy[0] + n), t_dy = load<WideFloats>(dy[1] + n);
            const auto first = load<WideFloats>(unit[0] + n), second = load<WideFloats>(unit[1] + n);
            const auto put = [&](float* to, const WideFloats& value) {
                const WideWords in_front = less(WideFloats{}, first);
                if (to != nullptr) store_some(to + begin + n, some, select(in_front, value, WideFloats{}));
            };
            const WideFloats square = larger_of(s_dx * s_dx + t_dx * t_dx, s_dy * s_dy + t_dy * t_dy);
            const WideWords is_zero = less(square, WideFloats{} + 0.5f);
            if (job.level != nullptr) {
                const auto exponent = [](const WideFloats& power) {
                    return to_numbers(signed_bits(power) - (WideWords{} + bit_cast<int>(1.0f))) * 0x1p-23f;
                };
                const WideFloats levels =
                    half_log2_of_quotient(square, WideFloats{} + 1.0f) + (exponent(first) + exponent(second));
                put(job.level, select(is_zero, WideFloats{} - static_cast<float>(infinity), levels));
            }
            if (!job.has_shape()) continue;
            const SpectrumLanes spectrum(s_dx * s_dx + s_dy * s_dy, s_dx * t_dx + s_dy * t_dy,
                                         t_dx * t_dx + t_dy * t_dy);
            const WideFloats ratio = spectrum.largest * (1.0f / load<WideFloats>(determinant + n));
            put(job.anisotropy, select(is_zero, WideFloats{} + 1.0f, larger_of(ratio, WideFloats{} + 1.0f)));
            WideFloats axis[2];
            spectrum.find_major(first, axis);
            for (std::size_t k = 0; k < 2; ++k) put(job.major[k], axis[k] * job.per_texel[k] * second);
        }
    }
};

template <class CompiledWhereCalled = void>
Undecided fill_batch_footprints(const BatchFootprintsJob& original, std::size_t first) noexcept {
    // It is refused, as w is 0; it has an area, so that nobody looks for one closely.
    static constexpr float dark[3 * BatchVertex::size + 1] = {0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 1};
    const BatchFootprintsJob job = original;
    const bool filters = job.are_filtered();
    const auto vertices = [&](std::uint32_t id) {
        return id < job.triangles && !job.planes[id].is_behind() ? vertices_of(job, id) : dark;
    };
    FragmentCentres centres(job, first);
    FootprintLanes known;
    Words known_ids{};
    bool has_known = false;
    JacobianBlock block;
    if (filters) block.clear();
    for (std::size_t n = first; n < job.count;) {
        const std::size_t begin = n;
        const std::size_t end = job.count - begin < exact_block ? job.count : begin + exact_block;
        std::uint64_t undecided = 0;
        for (; n < end; n += at_once, centres.advance()) {
            const FragmentIds ids(job, n);
            const auto asked_ids = load<Words>(ids.value);
            if (!has_known || any(asked_ids ^ known_ids)) {
                has_known = true;
                known_ids = asked_ids;
                if (ids.are_one()) {
                    known.take(vertices(ids.value[0]));
                } else {
                    const float* of_lane[lanes];
                    TEXGEN_FOR (std::size_t i = 0; i < at_once; ++i) of_lane[i] = vertices(ids.value[i]);
                    known.take(of_lane);
                }
            }
            JacobianLanes jacobian;
            jacobian.take(known, centres.x, centres.y);
            const int count = n + at_once <= end ? lanes : static_cast<int>(end - n);
            const auto put = [&](float* to, const Doubles& value) {
                if (to != nullptr) store_some(to + n, count, to_floats(where(jacobian.front, value)));
            };
            for (std::size_t k = 0; k < 2; ++k) {
                put(job.dx[k], jacobian.dx[k]);
                put(job.dy[k], jacobian.dy[k]);
            }
            LongWords left = jacobian.doubtful;
            if (filters) left |= jacobian.front & block.put(n - begin, known, jacobian, job);
            const std::uint64_t asked = (std::uint64_t{1} << count) - 1;
            undecided |= (lane_bits(left) & asked) << (n - begin);
        }
        if (filters) block.filter(begin, end - begin, job);
        if (undecided != 0) return {begin, undecided};
    }
    return {job.count, 0};
}

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
