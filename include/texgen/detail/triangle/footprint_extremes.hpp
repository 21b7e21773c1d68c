#pragma once

// The extremes of footprints over a convex part of the window, without visiting fragments.
//
// With X(y) = d(s,t)/dx Q^2 and Y(x) = d(s,t)/dy Q^2 in texels (planes.hpp: each is affine in one coordinate of the
// window), rho = max(|X|, |Y|) / Q^2, |det J| = |D| / Q^3, and the ratio of the singular values is L^2 / (|D| Q), L the
// spectral norm of (X, Y). X, Y and Q are affine, so |X|, |Y| and L are convex.

#include <array>
#include <cmath>
#include <cstddef>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "../arithmetic/rounding.hpp"

namespace TEXGEN_DETAIL {

// A convex polygon of the window: a triangle or a rectangle, cut by the sides of a box.
class WindowPolygon {
public:
    void add(const glm::dvec2& corner) noexcept { corners_[count_++] = corner; }

    std::size_t count() const noexcept { return count_; }
    const glm::dvec2& operator[](std::size_t i) const noexcept { return corners_[i]; }
    const glm::dvec2& after(std::size_t i) const noexcept { return corners_[i + 1 < count_ ? i + 1 : 0]; }

    // The part where sign * p[axis] <= bound.
    WindowPolygon cut(glm::length_t axis, double sign, double bound) const noexcept {
        WindowPolygon result;
        for (std::size_t i = 0; i < count_; ++i) {
            const glm::dvec2& from = corners_[i];
            const glm::dvec2& to = after(i);
            const double from_excess = sign * from[axis] - bound;
            const double to_excess = sign * to[axis] - bound;
            if (from_excess <= 0.0) result.add(from);
            if ((from_excess < 0.0 && to_excess > 0.0) || (from_excess > 0.0 && to_excess < 0.0))
                result.add(from + (from_excess / (from_excess - to_excess)) * (to - from));
        }
        return result;
    }

private:
    // A convex polygon has at most one corner more after a cut, and rounding may leave another.
    std::array<glm::dvec2, 4 + 2 * 4> corners_;  // not initialized: that would cost what a cut does
    std::size_t count_ = 0;
};

// J J^T = ((a, b), (b, c)) of a J with these columns, and its larger eigenvalue, (a + c)/2 + root.
struct Spectrum {
    double b, half, root, largest;  // half: (a - c)/2

    Spectrum(const glm::dvec2& x, const glm::dvec2& y) noexcept {
        const double a = x.x * x.x + y.x * y.x;
        const double c = x.y * x.y + y.y * y.y;
        b = x.x * x.y + y.x * y.y;
        half = 0.5 * (a - c);
        root = std::sqrt(half * half + b * b);
        largest = 0.5 * (a + c) + root;
    }
};

// X(y), Y(x) and Q about the first vertex of the triangle, and bounds on their errors over the polygon.
struct FootprintField {
    glm::dvec2 x, y, twist;  // X = x + p.y twist, Y = y - p.x twist
    double q, q_dx, q_dy;
    double error, q_error;

    glm::dvec2 x_at(const glm::dvec2& p) const noexcept { return x + p.y * twist; }
    glm::dvec2 y_at(const glm::dvec2& p) const noexcept { return y - p.x * twist; }
    double q_at(const glm::dvec2& p) const noexcept { return q + (p.x * q_dx + p.y * q_dy); }

    // rho^2 Q^4.
    double square_at(const glm::dvec2& p) const noexcept {
        const glm::dvec2 at_x = x_at(p);
        const glm::dvec2 at_y = y_at(p);
        return larger(glm::dot(at_x, at_x), glm::dot(at_y, at_y));
    }
    // L^2.
    double spectral_square_at(const glm::dvec2& p) const noexcept { return Spectrum(x_at(p), y_at(p)).largest; }
};

struct RangeOfQ {
    double least, largest;
};

inline RangeOfQ range_of_q(const FootprintField& field, const WindowPolygon& polygon) noexcept {
    RangeOfQ range{infinity, -infinity};
    for (std::size_t i = 0; i < polygon.count(); ++i) {
        const double q = field.q_at(polygon[i]);
        range = {smaller(q, range.least), larger(q, range.largest)};
    }
    return range;
}

// The largest |a + k b|^2 / (c + k d)^4 for k in [0, 1], where the denominator is not 0: at an end, or where the
// derivative vanishes, d b.b k^2 + (3 d a.b - c b.b) k + 2 d a.a - c a.b = 0.
inline double largest_along(const glm::dvec2& a, const glm::dvec2& b, double c, double d) noexcept {
    double largest = 0.0;
    const auto consider = [&](double k) {
        if (!(k >= 0.0 && k <= 1.0)) return;
        const glm::dvec2 numerator = a + k * b;
        const double square = (c + k * d) * (c + k * d);
        largest = larger(glm::dot(numerator, numerator) / (square * square), largest);
    };
    consider(0.0);
    consider(1.0);
    const double second = d * glm::dot(b, b);
    const double first = 3.0 * d * glm::dot(a, b) - c * glm::dot(b, b);
    const double constant = 2.0 * d * glm::dot(a, a) - c * glm::dot(a, b);
    const double discriminant = first * first - 4.0 * second * constant;
    if (discriminant >= 0.0) {
        const double root = -0.5 * (first + std::copysign(std::sqrt(discriminant), first));
        if (second != 0.0) consider(root / second);
        if (root != 0.0) consider(constant / root);
    }
    return largest;
}

// The largest rho^2, for a polygon in front. Along lines of constant Q it is convex, so it is largest on the polygon's
// border; along a side X, Y and Q are affine.
inline double largest_square_of_rho(const FootprintField& field, const WindowPolygon& polygon) noexcept {
    double largest = 0.0;
    for (std::size_t i = 0; i < polygon.count(); ++i) {
        const glm::dvec2& from = polygon[i];
        const glm::dvec2& to = polygon.after(i);
        const double q = field.q_at(from);
        const double q_change = field.q_at(to) - q;
        const glm::dvec2 x = field.x_at(from);
        const glm::dvec2 y = field.y_at(from);
        largest = larger(largest_along(x, field.x_at(to) - x, q, q_change), largest);
        largest = larger(largest_along(y, field.y_at(to) - y, q, q_change), largest);
    }
    return largest;
}

// Where |a + k b|^2 <= v, or a little more: the interval centre +- sqrt((v - least) / b.b), widened for the roundings.
class Sublevel {
public:
    Sublevel(const glm::dvec2& a, const glm::dvec2& b) noexcept : size_(glm::dot(b, b)) {
        if (!(size_ > 0.0)) {
            least_ = glm::dot(a, a) * (1.0 - 0x1p-40);
            return;
        }
        const double left = a.x * b.y;
        const double right = a.y * b.x;
        const double cross = std::fabs(left - right) - 0x1p-50 * (std::fabs(left) + std::fabs(right));
        least_ = cross > 0.0 ? cross * cross / size_ * (1.0 - 0x1p-40) : 0.0;
        centre_ = -glm::dot(a, b) / size_;
        slack_ = 0x1p-48 * (std::fabs(a.x * b.x) + std::fabs(a.y * b.y)) / size_;
    }

    double least() const noexcept { return least_; }

    // The part of the polygon inside, its coordinate `axis` being k.
    WindowPolygon cut(const WindowPolygon& polygon, glm::length_t axis, double v) const noexcept {
        if (!(size_ > 0.0)) return polygon;
        const double half = std::sqrt(larger(v - least_, 0.0) / size_) * (1.0 + 0x1p-40) + slack_;
        return polygon.cut(axis, 1.0, half + centre_).cut(axis, -1.0, half - centre_);
    }

private:
    double size_, least_ = 0.0, centre_ = 0.0, slack_ = 0.0;
};

// The largest Q of the polygon where N = max(|X|, |Y|) is at most n, as a function of n: concave, as N is convex and Q
// affine. The least of rho = N / Q^2 is that of n / Q(n)^2, and a few values of Q(n) enclose it: between two of them
// the function is below the lines through the pairs of values on either side.
class LargestQ {
public:
    // n is right to within rounding, as is q; -infinity where N is nowhere so small.
    struct Sample {
        double n, q;
    };

    LargestQ(const FootprintField& field, const WindowPolygon& polygon) noexcept
        : field_(field), polygon_(polygon), of_x_(field.x, field.twist), of_y_(field.y, -field.twist) {
        double highest = 0.0;
        for (std::size_t i = 0; i < polygon.count(); ++i) highest = larger(field.square_at(polygon[i]), highest);
        attain(polygon);
        const double lowest = larger(of_x_.least(), of_y_.least());
        insert(0, std::sqrt(lowest));
        insert(1, std::sqrt(larger(highest * (1.0 + 0x1p-40), lowest)));
        least_[0] = enclosed(0);
    }

    std::size_t count() const noexcept { return count_; }
    bool is_full() const noexcept { return count_ == samples_.size(); }

    // The least rho^2 that was met.
    double attained() const noexcept { return attained_; }

    // A lower bound on rho^2 where N is between samples i and i + 1, and the n where that is.
    struct Least {
        double bound, n;
    };
    const Least& least_between(std::size_t i) const noexcept { return least_[i]; }

    // Takes a sample at n behind sample i; false where n is no number between both.
    bool add(std::size_t i, double n) noexcept {
        if (!(n > samples_[i].n && n < samples_[i + 1].n)) return false;
        insert(i + 1, n);
        // The lines of what is between two samples go through the next ones.
        for (std::size_t k = count_ - 2; k > i; --k) least_[k] = least_[k - 1];
        for (std::size_t k = i > 0 ? i - 1 : 0; k <= i + 2 && k + 1 < count_; ++k) least_[k] = enclosed(k);
        return true;
    }

private:
    Least enclosed(std::size_t i) const noexcept {
        const Sample& low = samples_[i];
        const Sample& high = samples_[i + 1];
        if (!(high.q + field_.q_error > 0.0)) return {infinity, low.n};  // no point in front
        const double fall = slope_after(i + 1);
        const double q = high.q - fall * (high.n - low.n);
        const double rise = slope_before(i);
        if (!(low.q > -infinity && rise < infinity)) {
            const Least at_low{bound_at(low.n, q), middle_of(low.n, high.n)};
            return smaller_of(at_low, {bound_at(high.n, high.q), at_low.n});
        }
        // The lines meet where low.q + rise (n - low.n) = q + fall (n - low.n).
        const double steps = rise > fall ? (q - low.q) / (rise - fall) : 0.0;
        const double n = low.n + smaller(larger(steps, 0.0), high.n - low.n);
        const double at_n = smaller(low.q + rise * (n - low.n), q + fall * (n - low.n));
        const bool is_inside = n > low.n && n < high.n;
        const double next = is_inside ? n : middle_of(low.n, high.n);
        return smaller_of({bound_at(n, larger(at_n, low.q)), next},
                          smaller_of({bound_at(low.n, low.q), next}, {bound_at(high.n, high.q), next}));
    }

    static Least smaller_of(const Least& a, const Least& b) noexcept { return a.bound < b.bound ? a : b; }
    static double middle_of(double low, double high) noexcept {
        return low > 0x1p-4 * high ? std::sqrt(low) * std::sqrt(high) : 0x1p-3 * high;
    }

    double bound_at(double n, double q) const noexcept {
        const double least_n = larger(n - field_.error, 0.0);
        const double largest_q = q + field_.q_error;
        const double square = largest_q * largest_q;
        return largest_q > 0.0 ? least_n * least_n / (square * square) : infinity;
    }

    // Upper bounds on the function's slope behind sample i, and lower ones before it, from its other neighbour: where
    // that is, and what it has, is rounded.
    double slope_before(std::size_t i) const noexcept {
        if (i == 0 || !(samples_[i - 1].q > -infinity)) return infinity;
        const double run = samples_[i].n - samples_[i - 1].n - rounding_at(i);
        return run > 0.0 ? (samples_[i].q - samples_[i - 1].q + 2.0 * field_.q_error) / run : infinity;
    }
    double slope_after(std::size_t i) const noexcept {
        if (i + 1 >= count_) return 0.0;
        const double run = samples_[i + 1].n - samples_[i].n + rounding_at(i + 1);
        return larger((samples_[i + 1].q - samples_[i].q - 2.0 * field_.q_error) / run, 0.0);
    }
    double rounding_at(std::size_t i) const noexcept { return 0x1p-36 * samples_[i].n + 2.0 * field_.error; }

    void attain(const WindowPolygon& part) noexcept {
        for (std::size_t i = 0; i < part.count(); ++i) {
            const double q = field_.q_at(part[i]);
            if (q > field_.q_error) attained_ = smaller(field_.square_at(part[i]) / (q * q * q * q), attained_);
        }
    }

    void insert(std::size_t i, double n) noexcept {
        const WindowPolygon part = of_y_.cut(of_x_.cut(polygon_, 1, n * n), 0, n * n);
        attain(part);
        for (std::size_t k = count_++; k > i; --k) samples_[k] = samples_[k - 1];
        samples_[i] = {n, part.count() > 0 ? range_of_q(field_, part).largest : -infinity};
    }

    const FootprintField& field_;
    const WindowPolygon& polygon_;
    Sublevel of_x_, of_y_;
    std::array<Sample, 24> samples_{};
    std::array<Least, 24> least_;  // between a sample and the next one
    std::size_t count_ = 0;
    double attained_ = infinity;
};

// A lower bound on rho^2 over the polygon, and within 1 % of it (0.5 % of rho) where the search is not cut short.
inline double least_square_of_rho(const FootprintField& field, const WindowPolygon& polygon) noexcept {
    LargestQ largest_q(field, polygon);
    for (;;) {
        std::size_t lowest = 0;
        LargestQ::Least least = largest_q.least_between(0);
        for (std::size_t i = 1; i + 1 < largest_q.count(); ++i) {
            const LargestQ::Least here = largest_q.least_between(i);
            if (!(here.bound < least.bound)) continue;
            least = here;
            lowest = i;
        }
        if (least.bound >= 0.99 * largest_q.attained() || largest_q.is_full() || !largest_q.add(lowest, least.n))
            return smaller(least.bound, largest_q.attained());
    }
}

// The largest ratio of the singular values times |D|, for a polygon in front: L^2 / Q is convex, as the square of a
// convex function over an affine one, so a corner has it.
inline double largest_anisotropy(const FootprintField& field, const WindowPolygon& polygon) noexcept {
    double largest = 0.0;
    for (std::size_t i = 0; i < polygon.count(); ++i)
        largest = larger(field.spectral_square_at(polygon[i]) / field.q_at(polygon[i]), largest);
    return largest;
}

}  // namespace TEXGEN_DETAIL
