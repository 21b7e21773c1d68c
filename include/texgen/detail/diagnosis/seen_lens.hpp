#pragma once

// The lens that is seen in a texgen matrix or a projection, whatever its view, and what round numbers say of it: those
// that people write stand out of all others.

#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "../../conventions.hpp"
#include "../arithmetic/inverse.hpp"
#include "../arithmetic/rounding.hpp"
#include "../language.hpp"
#include "matrix_signs.hpp"
#include "products.hpp"

namespace TEXGEN_DETAIL {

// A number that people choose, and how far it is from being known: relative to itself.
struct Estimate {
    double value, error;
};

// How unlikely it is, in bits, that the number is as near to a round one, of few digits, by chance; 0 where it is near
// to none. In a decade 3 numbers are 1, 2 or 5, 9 have one digit and 90 have two.
inline double roundness(const Estimate& number, int most_digits = 2) noexcept {
    const auto bits = [&](double in_a_decade) { return -std::log2(in_a_decade * 8.0 / 2.3 * number.error); };
    if (!(number.value > 0x1p-100 && number.value < 0x1p100)) return 0.0;
    const double decade = std::pow(10.0, std::floor(std::log10(number.value * (1.0 + number.error))));
    double digits = 1.0;
    for (int count = 1; count <= most_digits; ++count, digits *= 10.0) {
        const double scaled = number.value / decade * digits;
        const double round = std::round(scaled);
        if (std::fabs(scaled - round) > 4.0 * number.error * scaled) continue;
        const bool is_first = count == 1 && (round == 1.0 || round == 2.0 || round == 5.0 || round == 10.0);
        return larger(0.0, bits(is_first ? 3.0 : 9.0 * digits));
    }
    return 0.0;
}

// The lens that is seen in a texgen matrix, of a space that is the world but for a scale.
class SeenLens {
public:
    SeenLens(const Product& texgen, double rounding) noexcept
        : q_(axis(texgen.value, 3)), rows_(depth_rows(texgen.value)), rounding_(rounding) {
        per_distance_ = glm::length(q_);
        if (!(per_distance_ > 0.0)) return;  // parallel light
        for (glm::length_t row = 0; row < 2; ++row) {
            const glm::dvec3 axis_of_row = axis(texgen.value, row);
            centre_[row] = glm::dot(axis_of_row, q_) / (per_distance_ * per_distance_);
            across_[row] = axis_of_row - centre_[row] * q_;
            focal_length_[row] = glm::length(across_[row]) / per_distance_;
        }
        offset_ = texgen.value[3].z - rows_.limit * texgen.value[3].w;
        offset_error_ = rounding * (texgen.magnitude[3].z + std::fabs(rows_.limit) * texgen.magnitude[3].w);
    }

    // Whether it is a perspective that neither skews nor was skewed.
    bool is_lens() const noexcept {
        const double lengths = glm::length(across_[0]) * glm::length(across_[1]);
        if (!(per_distance_ > 0.0) || !(lengths > 0.0) || !rows_.are_parallel) return false;
        const double cosine = glm::dot(across_[0], across_[1]) / lengths;
        return is_finite(cosine) &&
               std::fabs(cosine) <= 4.0 * rounding_ * (2.0 + 1.0 / focal_length_.x + 1.0 / focal_length_.y);
    }

    // Whether one of its directions is along an axis of the space: a scale along it would look like a part of the lens.
    bool may_be_stretched() const noexcept {
        const auto is_along_axis = [&](const glm::dvec3& v) {
            const double accepted = 8.0 * rounding_ * (1.0 + 1.0 / focal_length_.x + 1.0 / focal_length_.y);
            const glm::dvec3 share = glm::abs(v) / glm::length(v);
            return larger(smaller(share.x, share.y), smaller(larger(share.x, share.y), share.z)) <= accepted;
        };
        return is_along_axis(across_[0]) || is_along_axis(across_[1]) || is_along_axis(q_);
    }

    // Whether the lens's axis goes to that s and t.
    bool is_centred_on(const glm::dvec2& st) const noexcept {
        const glm::dvec2 accepted = 4.0 * rounding_ * (glm::abs(st) + focal_length_ + 1.0);
        return std::fabs(centre_.x - st.x) <= accepted.x && std::fabs(centre_.y - st.y) <= accepted.y;
    }

    // The q at distance 1, and the limit of r at infinity.
    double per_distance() const noexcept { return per_distance_; }
    double limit() const noexcept { return rows_.limit; }
    double rounding() const noexcept { return rounding_; }

    // The focal lengths in units of s and t, and the relative error of one.
    const glm::dvec2& focal_length() const noexcept { return focal_length_; }
    double error_of_focal_length(glm::length_t of = 1) const noexcept {
        return 2.0 * rounding_ * (1.0 + 1.0 / focal_length_[of]);
    }

    // The distance at which r has that value, and r at that distance.
    Estimate distance_of(double r) const noexcept {
        const double difference = r - rows_.limit;
        const double error =
            ratio(offset_error_, std::fabs(offset_)) + rounding_ * (1.0 + ratio(1.0, std::fabs(difference)));
        return {ratio(offset_, difference * per_distance_), error};
    }
    Estimate r_at(double distance) const noexcept {
        if (!is_finite(distance)) return {rows_.limit, rounding_};
        const double q = per_distance_ * distance;
        return {rows_.limit + offset_ / q, rounding_ + offset_error_ / q};
    }

    // Whether the picture stands on its head: its side is level if y is up, or if z is, and t grows downwards along
    // that axis. Not where its side is level for both, and t grows upwards along the one that may be up.
    bool hangs_down(double up_along_t) const noexcept {
        const glm::dvec3 side = across_[0] / glm::length(across_[0]),
                         up = up_along_t / glm::length(across_[1]) * across_[1];
        const double accepted = 8.0 * rounding_ * (1.0 + 1.0 / focal_length_.x);
        double lowest = 0.0, highest = 0.0;
        for (glm::length_t axis = 1; axis < 3; ++axis) {
            if (std::fabs(side[axis]) > accepted) continue;
            lowest = smaller(lowest, up[axis]);
            highest = larger(highest, up[axis]);
        }
        return lowest < -accepted && highest <= accepted;
    }

private:
    static glm::dvec3 axis(const glm::dmat4& m, glm::length_t row) noexcept {
        return {m[0][row], m[1][row], m[2][row]};
    }

    glm::dvec3 q_;
    DepthRows rows_;
    double rounding_, per_distance_;
    glm::dvec3 across_[2] = {};  // rows s and t without their part along q
    glm::dvec2 centre_{0.0}, focal_length_{0.0};
    double offset_ = 0.0, offset_error_ = 0.0;  // r = limit q + offset
};

// Whether the angle of that focal length is a whole number of degrees.
inline bool is_of_round_angle(const Estimate& focal_length) noexcept {
    const double half =
        0.5 * degrees(std::round(radians(2.0 * std::atan2(1.0, focal_length.value)).in_degrees())).in_radians();
    return std::fabs(focal_length.value * std::sin(half) - std::cos(half)) <= focal_length.error * std::cos(half);
}

// The number of whole degrees that make that focal length, but for its sign, if they are taken for radians; 0 where
// none do. Numbers below half a turn are not tried: people write such radians, too.
inline double degrees_as_radians(const Estimate& focal_length) noexcept {
    constexpr double turn = 2.0 * std::numbers::pi;
    const double step = focal_length.error < 0x1p-30 ? 1.0 : 5.0;
    const double angle = 2.0 * std::atan2(1.0, focal_length.value);
    const double accepted = focal_length.error * std::sin(angle) + 0x1p-44;
    for (double turns = 0.0; turns < 180.0; turns += turn) {
        for (const double number : {turns + turn - angle, turns + turn + angle}) {
            // The nearest whole number, as the sum keeps no fraction.
            const double round = step * ((number / step + 0x1.8p52) - 0x1.8p52);
            if (std::fabs(number - round) <= accepted && round > 0.0 && round < 180.0) return round;
        }
    }
    return 0.0;
}

// The r of the near plane, or where depth is reversed of the far one: `low` as the mapping and the conventions have it,
// and as a lens or a scale-bias for the other depth range leaves it.
struct DepthEnds {
    double low;
    std::array<double, 2> other_lows;
};
inline std::optional<DepthEnds> depth_ends(DepthMapping depth, const std::optional<Conventions>& conventions) noexcept {
    if (depth == DepthMapping::unit || (conventions && conventions->depth == DepthRange::zero_to_one))
        return DepthEnds{0.0, {0.5, -1.0}};
    return conventions ? std::optional(DepthEnds{-1.0, {0.0, 0.0}}) : std::nullopt;
}

// Whether near and far are round numbers if the range is the other one, and near is none as it is: floats are not exact
// enough to say that. In an unknown scale a third, a seventh or a ninth of a round number is as round.
inline bool is_round_in_other_range(const SeenLens& lens, const DepthEnds& ends, bool knows_unit) noexcept {
    constexpr double enough_bits = 24.0;
    const Estimate z_near = lens.distance_of(ends.low);
    if (!(z_near.error < 0x1p-30) || !(roundness(lens.distance_of(1.0)) > 0.0)) return false;
    for (const double unit : {1.0, 3.0, 7.0, 9.0})
        if ((unit == 1.0 || !knows_unit) && roundness({unit * z_near.value, z_near.error}, 5) > 0.0) return false;
    for (const double other : ends.other_lows)
        if (roundness(lens.distance_of(other)) >= enough_bits) return true;
    return false;
}

// Whether the angle is that of whole degrees which were taken for radians. Where floats leave doubt the picture must
// stand on its head as well, as a tangent below 0 makes it.
inline bool is_of_degrees_as_radians(const SeenLens& lens, double focal_length, double up_along_t) noexcept {
    const double error = lens.error_of_focal_length();
    const bool hangs_down = lens.hangs_down(up_along_t);
    if (!(error < 0x1p-30) && !hangs_down) return false;
    const double number = degrees_as_radians({focal_length, error});
    if (!(number > 0.0)) return false;
    return std::tan(0.5 * number) < 0.0 ? !lens.hangs_down(-up_along_t) : error < 0x1p-30 && !hangs_down;
}

}  // namespace TEXGEN_DETAIL
