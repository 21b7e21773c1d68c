#pragma once

// Floor 7: footprints. What a fragment covers of the texture: the derivatives of s/q and t/q by the window's x and y, and
// what filters make of them. Projection varies them wildly within one triangle, and where q is near 0 a difference of two
// fragments tells nothing; so they are computed in closed form, from the set-up that interpolates.
//
// With S, T, Q the linear functions of the set-up (detail/planes.hpp),
//   J = d(s/q, t/q) / d(x, y) = ((S_x Q - S Q_x, S_y Q - S Q_y), (T_x Q - T Q_x, T_y Q - T Q_y)) / Q^2,
//   det J = D / Q^3, D the determinant of the coefficients of S, T, Q.
// The first column of J Q^2 is affine in y and does not depend on x, the second is affine in x and does not depend on y.

#include "detail/language.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include <glm/vec2.hpp>

#include "conventions.hpp"
#include "detail/arithmetic/nearest.hpp"
#include "detail/assert.hpp"
#include "detail/simd/lanes.hpp"
#include "detail/triangle/footprint_extremes.hpp"
#include "detail/triangle/planes.hpp"
#include "interpolate.hpp"
#include "primitives.hpp"
#include "texcoord.hpp"

namespace TEXGEN_NAMESPACE {

// How many texels one unit of s and of t spans: the size of the texture for normalised coordinates, those of an atlas_tile
// too; 1 for a rectangle texture. Of level 0. Bad values (not positive, not finite) make what is measured in texels NaN.
struct TexelsPerUnit {
    double s, t;
};

// The same for a region that covers width x height texels.
constexpr TexelsPerUnit texels_per_unit(const TextureRegion& region, double width, double height) noexcept {
    return {width / ((region.max)().x - (region.min)().x), height / ((region.max)().y - (region.min)().y)};
}

// The footprint of one fragment.
//   dx, dy            d(s, t)/dx and d(s, t)/dy a pixel, in units of s and t: dPdx and dPdy of textureGrad
//   level             lambda_base = log2(rho) of OpenGL, rho = max(|dx|, |dy|) in texels; -infinity where both are 0
//   singular_values   of J in texels, the larger first: the half axes of the ellipse that a pixel's circle becomes
//   anisotropy        their ratio, at least 1; infinite where J has rank 1, 1 where it is 0
//   major             the longer half axis, in units of s and t; (1, 0) times its length where they are equal
// `level` is neither biased nor clamped, as textureQueryLod's second result.
// Source: OpenGL 4.6 compatibility specification, 8.14.1, Scale Factor and Level of Detail; for the ellipse, Heckbert,
// Fundamentals of Texture Mapping and Image Warping (1989).
struct Footprint {
    glm::dvec2 dx, dy;
    double level;
    glm::dvec2 singular_values;
    double anisotropy;
    glm::dvec2 major;
};

// Planar; an empty span is not computed. The derivatives are named as GLSL would: dsdx is d(s/q)/dx.
struct Footprints {
    std::span<float> dsdx, dtdx, dsdy, dtdy, level, anisotropy, major_s, major_t;
};

// Over the fragments in front of the projector.
//   least_level, largest_level   the range of `level`: 2^largest_level texels a pixel is the strongest minification, and
//                                2^-least_level pixels a texel the strongest magnification
//   least_area, largest_area     the range of |det J| in texels: the texels that a pixel covers
//   largest_anisotropy           as in a Footprint
struct FootprintExtremes {
    double least_level, largest_level;
    double least_area, largest_area;
    double largest_anisotropy;
};

namespace detail {
inline namespace TEXGEN_COMPILER {

inline bool is_usable(const TexelsPerUnit& texels) noexcept {
    return texels.s > 0x1p-200 && texels.s < 0x1p200 && texels.t > 0x1p-200 && texels.t < 0x1p200;
}

// All of a footprint from J and det J, which has digits that J has lost where J is almost singular: determinant(unit) is
// unit^2 det J, for a power of two that brings J near 1. So no square leaves the range of double.
template <class Determinant>
Footprint footprint_of(const glm::dvec2& dx, const glm::dvec2& dy, const Determinant& determinant,
                       const TexelsPerUnit& texels) noexcept {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const double largest_slope =
        larger_or_nan(larger_or_nan(std::fabs(dx.x), std::fabs(dx.y)), larger_or_nan(std::fabs(dy.x), std::fabs(dy.y)));
    if (!is_usable(texels) || !(largest_slope < infinity)) return {dx, dy, nan, {nan, nan}, nan, {nan, nan}};
    if (!(largest_slope > 0.0)) return {dx, dy, -infinity, {0.0, 0.0}, 1.0, {0.0, 0.0}};
    const double unit = reciprocal_power_of_two(smaller(larger(largest_slope, 0x1p-1000), 0x1p1000));
    const double s_dx = unit * dx.x * texels.s;
    const double t_dx = unit * dx.y * texels.t;
    const double s_dy = unit * dy.x * texels.s;
    const double t_dy = unit * dy.y * texels.t;
    const double size = larger(larger(std::fabs(s_dx), std::fabs(t_dx)), larger(std::fabs(s_dy), std::fabs(t_dy)));
    const double scale = reciprocal_power_of_two(size);
    const double p = s_dx * scale;
    const double q = t_dx * scale;
    const double u = s_dy * scale;
    const double v = t_dy * scale;
    const double a = p * p + u * u;
    const double b = p * q + u * v;
    const double c = q * q + v * v;
    const double half = 0.5 * (a - c);
    const double root = std::sqrt(half * half + b * b);
    const double largest = 0.5 * (a + c) + root;  // the larger eigenvalue of J J^T, and det^2 over it the smaller
    const double det = std::fabs(determinant(unit) * (texels.s * scale) * (texels.t * scale));
    const double length = std::sqrt(largest);
    glm::dvec2 major(1.0, 0.0);
    if (root > 0.0) {
        major = half < 0.0 ? glm::dvec2(b, root - half) : glm::dvec2(half + root, b);
        major *= 1.0 / std::sqrt(major.x * major.x + major.y * major.y);
    }
    return {dx,
            dy,
            0.5 * std::log2(larger(p * p + q * q, u * u + v * v)) - std::log2(scale) - std::log2(unit),
            glm::dvec2(length, smaller(det / length, length)) / scale / unit,
            det > 0.0 ? larger(largest / det, 1.0) : infinity,
            glm::dvec2(major.x / texels.s, major.y / texels.t) * (length / scale) / unit};
}

}  // namespace TEXGEN_COMPILER
}  // namespace detail

inline namespace TEXGEN_COMPILER {

// What filters make of derivatives that come from elsewhere.
// Guarantee: singular values and anisotropy within 2^-48 of themselves (of the larger singular value for the smaller; so
// with the anisotropy, relative to its square), level within 2^-48 max(1, |level|): of any finite derivatives, while what
// comes out is a normal number; what is beyond the largest is infinite. No allocation, noexcept.
// Shapes: units of s and t a pixel.
// Bad input: what is not finite makes all but dx and dy NaN.
inline Footprint footprint_of(const glm::dvec2& dx, const glm::dvec2& dy, const TexelsPerUnit& texels) noexcept {
    const auto determinant = [&](double unit) {
        return detail::difference_of_products(unit * dx.x, unit * dy.y, unit * dy.x, unit * dx.y);
    };
    return detail::footprint_of(dx, dy, determinant, texels);
}

}  // namespace TEXGEN_COMPILER

namespace detail {
inline namespace TEXGEN_COMPILER {
inline namespace TEXGEN_BUILD {
class TileFootprinter;
}
}  // namespace TEXGEN_COMPILER
}  // namespace detail

inline namespace TEXGEN_COMPILER {
class FootprintSetup;
}
inline namespace TEXGEN_BUILD {
template <class = void>
bool footprint(const FootprintSetup&, FragmentRect, Footprints) noexcept;
}

inline namespace TEXGEN_COMPILER {

// A triangle made ready for footprints, beside the set-up for its coordinates.
class FootprintSetup {
public:
    // Guarantee: in double, about the vertex with the largest clip_w; no allocation, noexcept.
    FootprintSetup(const TriangleSetup& triangle, TexelsPerUnit texels) noexcept
        : triangle_(triangle),
          texels_(texels),
          slope_{triangle.planes_.slope(0), triangle.planes_.slope(1)},
          determinant_(triangle.planes_.jacobian_determinant()) {}

    // The footprint of the fragment (x, y), empty behind the projector; the sign of q is decided exactly.
    // Guarantee: dx and dy within error_bound() without its rounding to float. No allocation, noexcept.
    std::optional<Footprint> at(int x, int y) const noexcept { return footprint_at(x, y); }

    // Guarantee: |computed - exact| of what footprint() writes to dsdx and dsdy (x), dtdx and dtdy (y), at every fragment of
    // the rectangle with q > 0; infinite where no finite bound exists, as next to q = 0. noexcept.
    //
    // A numerator N = N^ + e over (Q^ + f)^2: the error is at most (e + 2 |f| |N|/Q) / Q^2 but for squares of f/Q, below
    // 2^-23 where the tile is well in front. Rounding adds 4 u |N|/Q^2, and half an ulp.
    glm::dvec2 error_bound(FragmentRect rect) const noexcept {
        if (rect.width <= 0 || rect.height <= 0) return {0.0, 0.0};
        const detail::Tile tile{rect.x, rect.y, rect.width, rect.height};
        const detail::Corners at = triangle_.corners(tile);
        if (at.all_behind()) return {0.0, 0.0};
        const auto bound = [&](std::size_t k) {
            if (!at.well_in_front()) return std::numeric_limits<double>::infinity();
            const double per_q_squared = at.reciprocal * at.reciprocal;
            const double numerator = largest_numerator(k, tile);
            const double error = numerator_error(k, tile) + 2.0 * at.q_error * at.reciprocal * numerator +
                                 8.0 * detail::unit_roundoff_double * numerator;
            return detail::larger(triangle_.tolerance_,
                                  1.001 * error * per_q_squared + detail::half_ulp(numerator * per_q_squared));
        };
        return {bound(0), bound(1)};
    }

    // Guarantee: no fragment of the rectangle that is in front of the projector has a level, an area or an anisotropy
    // outside of these (they hold for exact footprints and for those of `exact`; a tolerance may add its share). Each is
    // reached within 1 % at some point of the rectangle (that is levels within 0.015) where q is well away from 0;
    // largest_level, largest_area and largest_anisotropy are infinite where q is not. Empty where all is behind the
    // projector or the rectangle is empty. A level of the Jacobian 0 is -infinity, and NaN where the texels are bad. It
    // takes as long as some tens of fragments, and never visits them. No allocation, noexcept.
    std::optional<FootprintExtremes> extremes(FragmentRect rect) const noexcept {
        if (rect.width <= 0 || rect.height <= 0) return std::nullopt;
        const glm::dvec2 first = triangle_.planes_.from_a({rect.x, rect.y, 1, 1});
        const glm::dvec2 last = first + glm::dvec2(rect.width - 1, rect.height - 1);
        detail::WindowPolygon polygon;
        polygon.add(first);
        polygon.add({last.x, first.y});
        polygon.add(last);
        polygon.add({first.x, last.y});
        return extremes(polygon);
    }

    // The same for all fragments inside the triangle.
    std::optional<FootprintExtremes> extremes() const noexcept {
        detail::WindowPolygon polygon;
        polygon.add({0.0, 0.0});
        polygon.add(triangle_.planes_.to_b());
        polygon.add(triangle_.planes_.to_c());
        return extremes(polygon);
    }

private:
    friend class detail::TileFootprinter;
    template <class>
    friend bool TEXGEN_BUILD::footprint(const FootprintSetup&, FragmentRect, Footprints) noexcept;

    detail::Corners corners(const detail::Tile& tile) const noexcept { return triangle_.corners(tile); }
    double tolerance() const noexcept { return triangle_.tolerance_; }

    // Whether interpolate() does nothing there.
    bool is_dark(const detail::Corners& at) const noexcept {
        if (at.all_behind()) return true;
        const detail::Places places = detail::places_of(at, triangle_.lit_, triangle_.tolerance_);
        return places.s == detail::Place::outside || places.t == detail::Place::outside;
    }

    std::optional<Footprint> footprint_at(std::int64_t x, std::int64_t y) const noexcept {
        const detail::TrianglePlanes& planes = triangle_.planes_;
        detail::Bounded bounded = planes.at(triangle_.q_, x, y);
        if (!(std::fabs(bounded.value) > 0x1p24 * bounded.error)) bounded = detail::close_to(planes, 3, x, y);
        const auto exact_q = [&] { return planes.exactly_at(3, x, y); };
        if (detail::certain_sign(bounded, exact_q) <= 0) return std::nullopt;
        const double q = bounded.value > 0x1p24 * bounded.error ? bounded.value : planes.closely_at(3, x, y);
        const glm::dvec2 p = planes.from_a({x, y, 1, 1});
        const double reciprocal = 1.0 / q;
        const auto divided = [&](double numerator) { return numerator * reciprocal * reciprocal; };
        const auto& s = slope_[0].value;
        const auto& t = slope_[1].value;
        return detail::footprint_of(
            {divided(s.dx + p.y * s.twist), divided(t.dx + p.y * t.twist)},
            {divided(s.dy - p.x * s.twist), divided(t.dy - p.x * t.twist)},
            [&](double unit) { return determinant_ * reciprocal * (reciprocal * unit) * (reciprocal * unit); },
            texels_);
    }

    // The largest numerators, and bounds on their errors, over a tile.
    double largest_numerator(std::size_t k, const detail::Tile& tile) const noexcept {
        const detail::Slope::Terms at = at_first(k, tile);
        const double dx = detail::larger(std::fabs(at.dx), std::fabs(at.dx + (tile.height - 1) * at.twist));
        const double dy = detail::larger(std::fabs(at.dy), std::fabs(at.dy - (tile.width - 1) * at.twist));
        return detail::larger(dx, dy);
    }
    double numerator_error(std::size_t k, const detail::Tile& tile) const noexcept {
        const glm::dvec2 p = triangle_.planes_.from_a(tile);
        const detail::Slope::Terms& magnitude = slope_[k].magnitude;
        return detail::gamma(20) * detail::larger(magnitude.dx + (std::fabs(p.y) + tile.height) * magnitude.twist,
                                                  magnitude.dy + (std::fabs(p.x) + tile.width) * magnitude.twist);
    }
    detail::Slope::Terms at_first(std::size_t k, const detail::Tile& tile) const noexcept {
        const glm::dvec2 p = triangle_.planes_.from_a(tile);
        const detail::Slope::Terms& at_a = slope_[k].value;
        return {at_a.dx + p.y * at_a.twist, at_a.dy - p.x * at_a.twist, at_a.twist};
    }

    std::optional<FootprintExtremes> extremes(const detail::WindowPolygon& polygon) const noexcept;

    TriangleSetup triangle_;
    TexelsPerUnit texels_;
    detail::Slope slope_[2];
    double determinant_;  // det J Q^3
};

}  // namespace TEXGEN_COMPILER

namespace detail {
inline namespace TEXGEN_COMPILER {

inline namespace TEXGEN_BUILD {

// Footprints into the caller's arrays: in vectors where the tile is well in front, else in its halves, and at last one
// by one.
class TileFootprinter {
public:
    TileFootprinter(const FootprintKernels& kernels, const FootprintSetup& setup, FragmentRect rect,
                    const Footprints& out) noexcept
        : kernels_(kernels), setup_(setup), rect_(rect), out_(out) {}

    void fill_all(const Tile& tile, const Corners& at) noexcept {
        if (at.all_behind()) return store_rows(tile, nothing());
        const bool may_be_vectors = at.well_in_front() && at.least_q > 0x1p-12 * at.largest_q;
        if (may_be_vectors && tile.width <= largest_index && fill_in_vectors(tile, at)) return;
        if (tile.width <= 8 && tile.height <= 8) return fill_one_by_one(tile);
        for (const Tile& half : tile.halves()) fill_all(half, setup_.corners(half));
    }

private:
    static constexpr int largest_index = 1 << 24;  // floats beyond are not every integer

    static Footprint nothing() noexcept { return {{0.0, 0.0}, {0.0, 0.0}, 0.0, {0.0, 0.0}, 0.0, {0.0, 0.0}}; }

    bool needs_filter() const noexcept {
        return !out_.level.empty() || !out_.anisotropy.empty() || !out_.major_s.empty() || !out_.major_t.empty();
    }

    // False where floats do not reach. They hold the numerators in texels relative to their largest, Q relative to its
    // own, and the factors that bring both back.
    bool fill_in_vectors(const Tile& tile, const Corners& at) noexcept {
        const TexelsPerUnit& texels = setup_.texels_;
        const double numerator[2] = {setup_.largest_numerator(0, tile), setup_.largest_numerator(1, tile)};
        const double largest = larger(numerator[0] * texels.s, numerator[1] * texels.t);
        const bool filters = needs_filter();
        if (!(larger(numerator[0], numerator[1]) < 0x1p500) || !(at.largest_q < 0x1p200) || !(at.least_q > 0x1p-200))
            return false;
        if (filters && (!is_usable(texels) || !(largest > 0x1p-500))) return false;

        const double q_scale = reciprocal_power_of_two(at.largest_q);
        const double q_scale_squared = q_scale * q_scale;
        const double texel_scale = reciprocal_power_of_two(largest);
        const auto scaled = [](const Slope::Terms& terms, double factor) {
            return FootprintJob::Slope{terms.dx * factor, terms.dy * factor, terms.twist * factor};
        };
        FootprintJob job{};
        job.width = tile.width;
        job.height = tile.height;
        job.q = {at.q_ramp.base * q_scale, at.q_ramp.dx * q_scale, at.q_ramp.dy * q_scale};
        job.derivatives_in_float = float_fits(tile, at, numerator);
        job.pitch = rect_.width;
        const std::size_t offset = this->offset(tile.x, tile.y);
        const auto array = [offset](const std::span<float>& span) {
            return span.empty() ? nullptr : span.data() + offset;
        };
        for (std::size_t k = 0; k < 2; ++k) {
            const Slope::Terms first = setup_.at_first(k, tile);
            job.slope[k] = scaled(first, q_scale_squared);
            if (filters) job.texels[k] = scaled(first, (k == 0 ? texels.s : texels.t) * texel_scale);
        }
        job.dx[0] = array(out_.dsdx);
        job.dx[1] = array(out_.dtdx);
        job.dy[0] = array(out_.dsdy);
        job.dy[1] = array(out_.dtdy);
        if (job.dx[0] != nullptr || job.dx[1] != nullptr || job.dy[0] != nullptr || job.dy[1] != nullptr)
            kernels_.differentiate(job);
        if (!filters) return true;

        const double back = q_scale_squared / texel_scale;  // from a length of the job to texels, but for 1 / Q^2
        const double determinant = std::fabs(setup_.determinant_ * texels.s * texels.t);
        job.filters_in_float = job.derivatives_in_float || float_serves_filters(tile, at, job.texels);
        job.level_offset = static_cast<float>(2 * exponent_of(q_scale) - exponent_of(texel_scale));
        job.anisotropy_factor = factor_of(q_scale / (texel_scale * texel_scale * determinant));
        job.major_factor[0] = factor_of(back / texels.s);
        job.major_factor[1] = factor_of(back / texels.t);
        job.level = array(out_.level);
        job.anisotropy = array(out_.anisotropy);
        job.major[0] = array(out_.major_s);
        job.major[1] = array(out_.major_t);
        for (int row = 0; (row = kernels_.filter(job, row)) < tile.height; ++row)
            fill_one_by_one({tile.x, tile.y + row, tile.width, 1});
        return true;
    }

    static float factor_of(double factor) noexcept { return static_cast<float>(factor); }

    static int exponent_of(double power_of_two) noexcept {
        return static_cast<int>(bit_cast<std::uint64_t>(power_of_two) >> 52) - 1023;
    }

    // Whether columns of J Q^2 and Q in float are within 2^-19 of themselves, which leaves level, anisotropy and major within
    // 2^-16. With u = 2^-24 base, slope, product and sum of a component N are rounded: u (2 |N| + 2 |twist| width), where |N|
    // is at most about 1; and one of the columns is nowhere shorter than at the first fragment less what the twist takes.
    static bool float_serves_filters(const Tile& tile, const Corners& at,
                                     const FootprintJob::Slope (&texels)[2]) noexcept {
        constexpr double u = 1.001 * unit_roundoff_float;
        const auto length = [](double s, double t) { return std::sqrt(s * s + t * t); };
        const double twist = length(texels[0].twist, texels[1].twist);
        const double least = larger(length(texels[0].dx, texels[1].dx) - tile.height * twist,
                                    length(texels[0].dy, texels[1].dy) - tile.width * twist);
        const double error = 1.5 * u * (4.0 + 2.0 * tile.width * twist);
        const double q_error = u * (2.0 * at.largest_q + 2.0 * tile.width * std::fabs(at.q_ramp.dx));
        return error <= 0x1p-19 * least && q_error <= 0x1p-19 * at.least_q;
    }

    // The error of N/Q^2 in float, with u = 2^-24: base, slope, product and sum of both are rounded, then the reciprocal,
    // its square and the product.
    bool float_fits(const Tile& tile, const Corners& at, const double (&numerator)[2]) const noexcept {
        constexpr double u = 1.001 * unit_roundoff_float;
        const double tolerance = setup_.tolerance();
        const double q_error = u * (2.0 * at.largest_q + 2.0 * tile.width * std::fabs(at.q_ramp.dx));
        if (!(tolerance > 0.0) || !(q_error < 0x1p-10 * at.least_q)) return false;
        const double per_q_squared = at.reciprocal * at.reciprocal;
        bool fits = true;
        for (std::size_t k = 0; k < 2; ++k) {
            const double twist = std::fabs(setup_.slope_[k].value.twist);
            const double error = u * (6.0 * numerator[k] + 2.0 * tile.width * twist) + setup_.numerator_error(k, tile) +
                                 2.0 * (q_error + at.q_error) * at.reciprocal * numerator[k];
            const double in_range = numerator[k] / (at.largest_q * at.largest_q);
            fits = fits && in_range < 0x1p60 && 1.01 * error * per_q_squared + 0x1p-80 <= tolerance;
        }
        return fits;
    }

    void fill_one_by_one(const Tile& tile) noexcept {
        for (std::int64_t y = tile.y; y < tile.y + tile.height; ++y) {
            for (std::int64_t x = tile.x; x < tile.x + tile.width; ++x) {
                const std::optional<Footprint> footprint = setup_.footprint_at(x, y);
                store_rows({x, y, 1, 1}, footprint ? *footprint : nothing());
            }
        }
    }

    void store_rows(const Tile& tile, const Footprint& value) noexcept {
        const auto put = [&](const std::span<float>& output, double number) {
            if (output.empty()) return;
            const auto rounded = static_cast<float>(number);
            for (std::int64_t y = tile.y; y < tile.y + tile.height; ++y) {
                float* const row = output.data() + offset(tile.x, y);
                for (int i = 0; i < tile.width; ++i) row[i] = rounded;
            }
        };
        put(out_.dsdx, value.dx.x);
        put(out_.dtdx, value.dx.y);
        put(out_.dsdy, value.dy.x);
        put(out_.dtdy, value.dy.y);
        put(out_.level, value.level);
        put(out_.anisotropy, value.anisotropy);
        put(out_.major_s, value.major.x);
        put(out_.major_t, value.major.y);
    }

    std::size_t offset(std::int64_t x, std::int64_t y) const noexcept { return offset_in(rect_, x, y); }

    const FootprintKernels& kernels_;
    const FootprintSetup& setup_;
    FragmentRect rect_;
    Footprints out_;
};

}  // namespace TEXGEN_BUILD

}  // namespace TEXGEN_COMPILER
}  // namespace detail

inline namespace TEXGEN_BUILD {

// The footprints of a rectangle. Returns whether the slide may light any of its fragments; where it lights none, nothing is
// written, as interpolate() does not for Work::nothing.
// Guarantee: in front of the projector the derivatives are within setup.error_bound(rect): with `exact` next to half an ulp,
// with a tolerance within max(tolerance, that), in units of s and t a pixel. level is within 2^-16 max(1, |level| / 32) of
// that of derivatives within the bound, anisotropy and major within 2^-16 of theirs (major relative to its length; where
// the anisotropy is near 1 its direction means nothing). Behind, all are 0, the sign of q decided exactly. No allocation,
// noexcept.
// Shapes: each output has width * height floats, row-major, or none (asserted). Fragments outside the triangle get the
// values of its plane; where the interpolated 1/w is not positive nothing is promised.
// Bad input: an empty rectangle does nothing. With bad texels level, anisotropy and major are NaN, the derivatives right. A
// Jacobian that is 0 has level -infinity, anisotropy 1 and major 0.
template <class>
bool footprint(const FootprintSetup& setup, FragmentRect rect, Footprints out) noexcept {
    TEXGEN_ASSERT(rect.width >= 0 && rect.height >= 0);
    if (rect.width <= 0 || rect.height <= 0) return false;
    const std::size_t count = detail::count_of(rect);
    for (std::span<float>* output :
         {&out.dsdx, &out.dtdx, &out.dsdy, &out.dtdy, &out.level, &out.anisotropy, &out.major_s, &out.major_t})
        if (!detail::is_computed(*output, count)) *output = {};
    const detail::Tile tile{rect.x, rect.y, rect.width, rect.height};
    const detail::Corners at = setup.corners(tile);
    if (setup.is_dark(at)) return false;
    detail::TileFootprinter(detail::chosen<detail::FootprintKernels>(), setup, rect, out).fill_all(tile, at);
    return true;
}

}  // namespace TEXGEN_BUILD

inline std::optional<FootprintExtremes> FootprintSetup::extremes(const detail::WindowPolygon& polygon) const noexcept {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    const auto& s = slope_[0];
    const auto& t = slope_[1];
    glm::dvec2 reach(0.0, 0.0);
    for (std::size_t i = 0; i < polygon.count(); ++i)
        for (glm::length_t axis = 0; axis < 2; ++axis)
            reach[axis] = detail::larger(std::fabs(polygon[i][axis]), reach[axis]);
    const auto size_of = [&](const detail::Slope::Terms& magnitude) {
        return detail::larger(magnitude.dx + reach.y * magnitude.twist, magnitude.dy + reach.x * magnitude.twist);
    };
    const detail::Ramp& q = triangle_.q_.value;
    const detail::Ramp& q_magnitude = triangle_.q_.magnitude;
    const double size = size_of(s.magnitude) * texels_.s + size_of(t.magnitude) * texels_.t;
    const double q_size = q_magnitude.base + reach.x * q_magnitude.dx + reach.y * q_magnitude.dy;
    // Both are brought near 1, so that no fourth power leaves the range of double; J in texels is then `back` times
    // what the field says.
    const double scale = detail::reciprocal_power_of_two(detail::larger(size, 0x1p-700));
    const double q_scale = detail::reciprocal_power_of_two(q_size);
    const double back = q_scale / scale * q_scale;
    const double back_levels = 2.0 * std::log2(q_scale) - std::log2(scale);  // where `back` itself is no normal number
    const auto scaled = [&](double of_s, double of_t) {
        return glm::dvec2(of_s * (texels_.s * scale), of_t * (texels_.t * scale));
    };
    const detail::FootprintField field{scaled(s.value.dx, t.value.dx),
                                       scaled(s.value.dy, t.value.dy),
                                       scaled(s.value.twist, t.value.twist),
                                       q.base * q_scale,
                                       q.dx * q_scale,
                                       q.dy * q_scale,
                                       detail::gamma(24) * size * scale,
                                       detail::gamma(24) * q_size * q_scale};
    const detail::Range range = detail::range_of_q(field, polygon);
    if (range.largest <= -field.q_error) return std::nullopt;
    if (!detail::is_usable(texels_)) return FootprintExtremes{nan, nan, nan, nan, nan};

    // What the bounds leave for the roundings of the footprints themselves, of level and of area and anisotropy.
    constexpr double slack = 0x1p-15;
    const auto level = [&](double square, double outward) {
        if (square == 0.0) return -infinity;
        const double middle = 0.5 * std::log2(square) + back_levels;
        return middle + outward * slack * detail::larger(1.0, std::fabs(middle) / 32.0);
    };
    const double determinant = std::fabs(determinant_ * (texels_.s * scale) * (texels_.t * scale)) / q_scale;
    const auto area = [&](double at_q) { return determinant / (at_q * at_q * at_q) * back * back; };
    FootprintExtremes result{level(detail::least_square_of_rho(field, polygon), -1.0), infinity,
                             area(range.largest + field.q_error) * (1.0 - slack), infinity, infinity};
    const double least_q = range.least - field.q_error;
    if (!(least_q > 0x1p20 * field.q_error)) return result;
    const double rho = std::sqrt(detail::largest_square_of_rho(field, polygon)) * (1.0 + 4.0 * field.q_error / least_q);
    const double largest_rho = rho + field.error / (least_q * least_q);
    result.largest_level = level(largest_rho * largest_rho, 1.0);
    result.largest_area = area(least_q) * (1.0 + slack);
    // |L^ + e|^2 / Q <= (L^2 / Q) (1 + e / L)^2, L at its least where the ratio is 1: L^2 = |D| Q.
    const double relative = field.error / std::sqrt(determinant * least_q);
    const double anisotropy = detail::largest_anisotropy(field, polygon) / determinant;
    if (relative < 0x1p-20)
        result.largest_anisotropy = detail::larger(anisotropy * (1.0 + slack + 4.0 * relative), 1.0);
    return result;
}

// How much a triangle is the "deer in headlights": lit by a projector that faces the camera, so that what is near to the
// camera is far from the projector and gets few texels on many pixels, and what is far gets many on few.
//
// The area of the footprint goes with 1 / Q^3 = (w/q)^3, so between the vertices nearest to the camera and farthest from it
// the level of detail rises by 3/2 log2(w_far / w_near) for the camera, and by 3/2 log2(q_near / q_far) for the projector.
// The latter is the score, in levels: 0 for a parallel projector, negative where the projector stands with the camera and
// evens out what the camera does, positive where both add up; infinite where the projector's plane is reached.
// No allocation, noexcept.
// Bad input: NaN where a clip_w is not positive, a clip_w or q not finite, or q is not positive at the vertex nearest to
// the camera.
// Source: Everitt, Projective Texture Mapping; the dueling frusta of Stamminger and Drettakis, Perspective Shadow Maps,
// SIGGRAPH 2002.
inline double headlights(const Triangle& triangle) noexcept {
    const WindowVertex* nearest = &triangle.a;
    const WindowVertex* farthest = &triangle.a;
    for (const WindowVertex* vertex : {&triangle.a, &triangle.b, &triangle.c}) {
        const bool is_usable = vertex->clip_w > 0.0f && detail::is_finite(detail::widened(vertex->clip_w)) &&
                               detail::is_finite(detail::widened(vertex->strq.w));
        if (!is_usable) return std::numeric_limits<double>::quiet_NaN();
        if (vertex->clip_w < nearest->clip_w) nearest = vertex;
        if (vertex->clip_w > farthest->clip_w) farthest = vertex;
    }
    const double near_q = detail::widened(nearest->strq.w);
    const double far_q = detail::widened(farthest->strq.w);
    if (!(near_q > 0.0)) return std::numeric_limits<double>::quiet_NaN();
    return far_q > 0.0 ? 1.5 * std::log2(near_q / far_q) : std::numeric_limits<double>::infinity();
}

}  // namespace TEXGEN_NAMESPACE
