// The plain-loop twin of vectors.inc.hpp, for compilers without vectors in the language. Included by kernels.inc.hpp.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

inline constexpr int lanes = 8;  // of Doubles, and of the Floats that they round to
inline constexpr int wide_lanes = 8;
inline constexpr std::size_t at_once = lanes, wide_at_once = wide_lanes;  // the same, of arrays

template <class T>
struct Lanes {
    using Element = T;

    T lane[lanes];

    T operator[](int i) const noexcept { return lane[i]; }

    static Lanes of(const auto& operation) noexcept {
        Lanes result;
        for (int i = 0; i < lanes; ++i) result.lane[i] = operation(i);
        return result;
    }

    Lanes& operator+=(T b) noexcept { return *this = *this + b; }
    Lanes& operator&=(const Lanes& b) noexcept { return *this = *this & b; }
    Lanes& operator|=(const Lanes& b) noexcept { return *this = *this | b; }

    // The operand on the right is Lanes or one number for all.
    Lanes operator+(const auto& b) const noexcept {
        return of([&](int i) { return lane[i] + at(b, i); });
    }
    Lanes operator-(const auto& b) const noexcept {
        return of([&](int i) { return lane[i] - at(b, i); });
    }
    Lanes operator*(const auto& b) const noexcept {
        return of([&](int i) { return lane[i] * at(b, i); });
    }
    Lanes operator&(const auto& b) const noexcept {
        return of([&](int i) { return lane[i] & at(b, i); });
    }
    friend Lanes operator*(T a, const Lanes& b) noexcept { return b * a; }
    friend Lanes operator+(T a, const Lanes& b) noexcept { return b + a; }
    friend Lanes operator-(T a, const Lanes& b) noexcept {
        return of([&](int i) { return a - b.lane[i]; });
    }
    // Not one for both: behind a friend with `auto` the front end of nvcc forgets the other members.
    friend Lanes operator/(T a, const Lanes& b) noexcept {
        return of([&](int i) { return a / b.lane[i]; });
    }
    friend Lanes operator/(const Lanes& a, const Lanes& b) noexcept {
        return of([&](int i) { return a.lane[i] / b.lane[i]; });
    }
    friend Lanes operator|(const Lanes& a, const Lanes& b) noexcept {
        return of([&](int i) { return a.lane[i] | b.lane[i]; });
    }
    Lanes operator~() const noexcept {
        return of([&](int i) { return ~lane[i]; });
    }
    friend Lanes operator^(const Lanes& a, const Lanes& b) noexcept {
        return of([&](int i) { return a.lane[i] ^ b.lane[i]; });
    }

    static T at(T number, int) noexcept { return number; }
    static T at(const Lanes& many, int i) noexcept { return many.lane[i]; }
};

using Doubles = Lanes<double>;
using Floats = Lanes<float>;
using Words = Lanes<int>;
using Residues = Lanes<std::uint64_t>;
using WideFloats = Floats;
using WideWords = Words;

// converted() converts the number in each lane; bits_as() keeps its bits.
template <class To, class From>
TEXGEN_INLINE To converted(const From& from) noexcept {
    return To::of([&](int i) { return static_cast<typename To::Element>(from.lane[i]); });
}
template <class To, class From>
TEXGEN_INLINE To bits_as(const From& from) noexcept {
    return To::of([&](int i) { return bit_cast<typename To::Element>(from.lane[i]); });
}

template <class Vector>
TEXGEN_INLINE Vector indices() noexcept {
    return Vector::of([](int i) { return static_cast<typename Vector::Element>(i); });
}

TEXGEN_INLINE Doubles to_doubles(const auto& values) noexcept { return converted<Doubles>(values); }
TEXGEN_INLINE Floats to_floats(const Doubles& values) noexcept { return converted<Floats>(values); }

template <class Function, class... Vector>
TEXGEN_INLINE void for_halves(const Function& f, const Vector&... values) noexcept {
    f(to_doubles(values)...);
}
template <class Function, class... Vector>
TEXGEN_INLINE WideFloats in_double(const Function& f, const Vector&... values) noexcept {
    return to_floats(f(to_doubles(values)...));
}

TEXGEN_INLINE Doubles truncated(const Doubles& values) noexcept { return to_doubles(converted<Words>(values)); }

using LongWords = Words;
TEXGEN_INLINE LongWords greater(const Doubles& a, const auto& b) noexcept {
    return LongWords::of([&](int i) { return a.lane[i] > Doubles::at(b, i) ? -1 : 0; });
}
template <class Vector>
TEXGEN_INLINE Words at_most(const Vector& a, const Vector& b) noexcept {
    return LongWords::of([&](int i) { return a.lane[i] <= b.lane[i] ? -1 : 0; });
}
TEXGEN_INLINE LongWords are_nonzero(const Doubles& a) noexcept {
    return LongWords::of([&](int i) { return a.lane[i] != 0.0 ? -1 : 0; });
}
TEXGEN_INLINE Doubles where(const LongWords& mask, const Doubles& values) noexcept {
    return Doubles::of([&](int i) { return mask.lane[i] != 0 ? values.lane[i] : 0.0; });
}
TEXGEN_INLINE Doubles select(const LongWords& mask, const Doubles& a, const Doubles& b) noexcept {
    return Doubles::of([&](int i) { return mask.lane[i] != 0 ? a.lane[i] : b.lane[i]; });
}
TEXGEN_INLINE LongWords are_near_middles(const Doubles& a, std::int64_t ulps) noexcept {
    const auto offset = static_cast<std::uint64_t>(ulps - 0x10000000);
    const auto mask = static_cast<std::uint64_t>(0x1ffffffe - 2 * ulps);
    return LongWords::of([&](int i) { return ((bit_cast<std::uint64_t>(a.lane[i]) + offset) & mask) == 0 ? -1 : 0; });
}
TEXGEN_INLINE Doubles middle_near(const Doubles& a) noexcept {
    return Doubles::of([&](int i) {
        return bit_cast<double>((bit_cast<std::uint64_t>(a.lane[i]) & ~std::uint64_t{0x1fffffff}) | 0x10000000);
    });
}

TEXGEN_INLINE Residues to_residues(const Doubles& integers) noexcept {
    return converted<Residues>(converted<Lanes<std::int64_t>>(integers));
}
TEXGEN_INLINE Doubles signed_numbers(const Residues& a) noexcept {
    return to_doubles(converted<Lanes<std::int64_t>>(a));
}
TEXGEN_INLINE LongWords are_zero(const Residues& a) noexcept {
    return LongWords::of([&](int i) { return a.lane[i] == 0 ? -1 : 0; });
}
TEXGEN_INLINE LongWords are_positive(const Residues& a) noexcept {
    return LongWords::of([&](int i) { return a.lane[i] - 1 < 0x7fffffffffffffff ? -1 : 0; });
}

TEXGEN_INLINE Words narrow(const LongWords& mask) noexcept { return mask; }
TEXGEN_INLINE Words equal(const Words& a, const auto& b) noexcept {
    return Words::of([&](int i) { return a.lane[i] == Words::at(b, i) ? -1 : 0; });
}
TEXGEN_INLINE Doubles with_sign_of(const Doubles& size, const Doubles& sign) noexcept {
    return Doubles::of([&](int i) { return std::copysign(size.lane[i], sign.lane[i]); });
}

TEXGEN_INLINE WideFloats to_numbers(const WideWords& words) noexcept { return converted<WideFloats>(words); }
TEXGEN_INLINE WideWords halved(const WideWords& words) noexcept {
    return WideWords::of([&](int i) { return words.lane[i] >> 1; });
}
TEXGEN_INLINE Doubles folded(const WideFloats& values) noexcept { return to_doubles(values); }
TEXGEN_INLINE WideWords are_negative(const WideFloats& a) noexcept {
    return WideWords::of([&](int i) { return a.lane[i] < 0.0f ? -1 : 0; });
}
template <class Vector>
TEXGEN_INLINE Vector minimum(const Vector& a, const Vector& b) noexcept {
    return Vector::of([&](int i) { return a.lane[i] < b.lane[i] ? a.lane[i] : b.lane[i]; });
}
template <class Vector>
TEXGEN_INLINE Vector maximum(const Vector& a, const Vector& b) noexcept {
    return Vector::of([&](int i) { return a.lane[i] > b.lane[i] ? a.lane[i] : b.lane[i]; });
}
TEXGEN_INLINE WideFloats larger_magnitude(const WideFloats& a, const WideFloats& b) noexcept {
    return maximum(bits_as<WideFloats>(bits_as<WideWords>(a) & 0x7fffffff), b);
}
template <class Vector>
TEXGEN_INLINE WideWords less(const Vector& a, const Vector& b) noexcept {
    return WideWords::of([&](int i) { return a.lane[i] < b.lane[i] ? -1 : 0; });
}
TEXGEN_INLINE Doubles magnitude(const Doubles& a) noexcept {
    return Doubles::of([&](int i) { return a.lane[i] < 0.0 ? -a.lane[i] : a.lane[i]; });
}

template <class Vector>
TEXGEN_INLINE Vector load(const void* from) noexcept {
    Vector values;
    std::memcpy(values.lane, from, sizeof values.lane);
    return values;
}
TEXGEN_INLINE void store(void* to, const auto& values) noexcept { std::memcpy(to, values.lane, sizeof values.lane); }

TEXGEN_INLINE Words inside(const Floats& values, float min, float max) noexcept {
    return Words::of([&](int i) { return values.lane[i] >= min && values.lane[i] <= max ? -1 : 0; });
}

TEXGEN_INLINE Floats one_where(const Words& mask) noexcept {
    return Floats::of([&](int i) { return mask.lane[i] != 0 ? 1.0f : 0.0f; });
}

TEXGEN_INLINE Floats reversed(const Floats& a) noexcept {
    return Floats::of([&](int i) { return a.lane[lanes - 1 - i]; });
}

TEXGEN_INLINE void load_interleaved(const float* from, Floats& x, Floats& y, Floats& z) noexcept {
    x = Floats::of([&](int i) { return from[3 * i]; });
    y = Floats::of([&](int i) { return from[3 * i + 1]; });
    z = Floats::of([&](int i) { return from[3 * i + 2]; });
}
TEXGEN_INLINE void load_boxes(const float* from, WideFloats (&min)[3], WideFloats (&max)[3]) noexcept {
    for (int j = 0; j < 3; ++j) {
        min[j] = WideFloats::of([&](int i) { return from[6 * i + j]; });
        max[j] = WideFloats::of([&](int i) { return from[6 * i + 3 + j]; });
    }
}
template <class Vector, class Number>
TEXGEN_INLINE void load_fours(const Number* from, Vector (&values)[4]) noexcept {
    for (int j = 0; j < 4; ++j) values[j] = Vector::of([&](int i) { return from[4 * i + j]; });
}
TEXGEN_INLINE void store_interleaved(float* to, const auto&... of) noexcept {
    for (int i = 0; i < lanes; ++i) ((*to++ = of.lane[i]), ...);
}

template <class Vector>
TEXGEN_INLINE void transpose(Vector (&rows)[lanes]) noexcept {
    for (int i = 0; i < lanes; ++i)
        for (int k = 0; k < i; ++k) std::swap(rows[i].lane[k], rows[k].lane[i]);
}

TEXGEN_INLINE std::uint64_t lane_bits(const LongWords& mask) noexcept {
    std::uint64_t result = 0;
    for (int i = 0; i < lanes; ++i) result |= std::uint64_t{mask.lane[i] != 0} << i;
    return result;
}

TEXGEN_INLINE bool any(const Words& mask) noexcept {
    int all = 0;
    for (int i = 0; i < lanes; ++i) all |= mask.lane[i];
    return all != 0;
}
using Distances = Words;
TEXGEN_INLINE Distances far_from_middles() noexcept { return Distances{} + 1; }
TEXGEN_INLINE Distances nearer(const Distances& others, const Doubles& a, const Doubles& b, int ulps) noexcept {
    return others & ~(are_near_middles(a, ulps) | are_near_middles(b, ulps));
}
TEXGEN_INLINE bool any_zero(const Distances& distances) noexcept { return any(equal(distances, 0)); }
TEXGEN_INLINE bool any_nonzero_near(const Distances& distances, const Doubles& a) noexcept {
    return any(equal(distances, 0) & are_nonzero(a));
}

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
