#pragma once

// The objects' bounds in the world, and what a projector lights of them at most. What the tree leaves out is dark for
// certain; what it keeps is tested again in the object's own space.

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "../conventions.hpp"
#include "../skip.hpp"
#include "inverse.hpp"
#include "nearest.hpp"
#include "rounding.hpp"
#include "widen.hpp"

namespace TEXGEN_DETAIL {

// Where M v is for the points v of an object's box. All numbers are finite.
struct WorldBounds {
    std::array<double, 3> min, max;
    double size;  // >= |M| |v| in each component, which the rounding of any product with M goes by; < 0: no point

    static constexpr double unbounded_size = 0x1p500;
    static constexpr WorldBounds none() noexcept { return {{}, {}, -1.0}; }
    static constexpr WorldBounds unbounded() noexcept { return {{}, {}, unbounded_size}; }

    friend bool operator==(const WorldBounds&, const WorldBounds&) = default;
};

// Unbounded where a number is not finite or M is not affine. Four terms a component, each rounded at most five times.
inline WorldBounds world_bounds(const glm::dmat4& m, const Box& box) noexcept {
    WorldBounds result = WorldBounds::none();
    const glm::dvec3 low = glm::dvec3(widened(glm::vec4(box.min, 0.0f)));
    const glm::dvec3 high = glm::dvec3(widened(glm::vec4(box.max, 0.0f)));
    result.size = 0.0;
    for (glm::length_t i = 0; i < 3; ++i) {
        double least = m[3][i];
        double largest = m[3][i];
        double size = std::fabs(m[3][i]);
        for (glm::length_t j = 0; j < 3; ++j) {
            const double of_low = m[j][i] * low[j];
            const double of_high = m[j][i] * high[j];
            least += smaller(of_low, of_high);
            largest += larger(of_low, of_high);
            size += std::fabs(of_low) + std::fabs(of_high);
        }
        const auto axis = static_cast<std::size_t>(i);
        result.min[axis] = least - gamma(8) * size;
        result.max[axis] = largest + gamma(8) * size;
        if (!(size < 0x1p400)) return WorldBounds::unbounded();
        result.size = larger(result.size, size);
    }
    const bool is_affine = m[0][3] == 0.0 && m[1][3] == 0.0 && m[2][3] == 0.0 && m[3][3] == 1.0;
    if (!is_affine) return WorldBounds::unbounded();
    return low.x > high.x || low.y > high.y || low.z > high.z ? WorldBounds::none() : result;
}

// The five forms of a slide in the world (the sides as u - min q and max q - u, and q), with room for what any T_o that is
// composed in double may differ by. With T = S P V, computed in double, each element of T, of T_o = (S P)(V M) and of a
// form errs by at most gamma(16) of the same product of magnitudes, and so does the form's value at M v: in all by less than
// slack = gamma(64) (|S P| |V|)_form (size, size, size, 1). What rounding makes of a side (see RoundedSide) moves the form
// by at most its width times |T_q| |v|, which is part of the slack. Where a form is below -slack over the bounds, so is that
// of T_o over the box, and where all are above slack, so are those.
class WorldForms {
public:
    // texture_from_eye is S P. The forms of a matrix that is not finite say nothing, as that of an infinite side.
    WorldForms(const glm::dmat4& texture_from_eye, const glm::dmat4& view, const TextureRegion& region) noexcept {
        const glm::dmat4 matrix = texture_from_eye * view;
        if (!is_finite(matrix)) return;
        glm::dmat4 magnitude(0.0);
        for (glm::length_t column = 0; column < 4; ++column)
            for (glm::length_t row = 0; row < 4; ++row)
                for (glm::length_t k = 0; k < 4; ++k)
                    magnitude[column][row] += std::fabs(texture_from_eye[k][row]) * std::fabs(view[column][k]);
        for (std::size_t k = 0; k < 2; ++k) {
            const auto row = static_cast<glm::length_t>(k);
            const double min = (region.min)()[row];
            const double max = (region.max)()[row];
            set(2 * k, matrix, magnitude, row, 1.0, -min, width_of(RoundedSide::of_min(min)));
            set(2 * k + 1, matrix, magnitude, row, -1.0, max, width_of(RoundedSide::of_max(max)));
        }
        set(4, matrix, magnitude, 3, 0.0, 1.0, 0.0);
    }

    // outside and inside for certain. A form over bounds is its value in the middle, give or take that of half the extents;
    // the rounding of those is part of the slack.
    Coverage coverage(const WorldBounds& bounds) const noexcept {
        if (bounds.size < 0.0) return Coverage::outside;
        double middle[3];
        double half[3];
        for (std::size_t j = 0; j < 3; ++j) {
            middle[j] = 0.5 * (bounds.max[j] + bounds.min[j]);
            half[j] = 0.5 * (bounds.max[j] - bounds.min[j]);
        }
        bool is_inside = true;
        for (const Form& form : forms_) {
            const auto& a = form.a;
            const double value = a[0] * middle[0] + a[1] * middle[1] + a[2] * middle[2] + form.d;
            const double change = std::fabs(a[0]) * half[0] + std::fabs(a[1]) * half[1] + std::fabs(a[2]) * half[2];
            const double slack = form.slack_per_size * bounds.size + form.slack;
            if (value + change < -slack) return Coverage::outside;
            is_inside = is_inside && value - change > slack;
        }
        return is_inside ? Coverage::inside : Coverage::partial;
    }

private:
    // The given side is between the outer and the inner one.
    static double width_of(const RoundedSide& side) noexcept { return std::fabs(side.inner - side.outer); }

    // of_row * row + of_q * q, times a power of two: the sum of the magnitudes becomes about 1. The side may be off by
    // `width`.
    void set(std::size_t k, const glm::dmat4& matrix, const glm::dmat4& magnitude, glm::length_t row, double of_row,
             double of_q, double width) noexcept {
        Form form;
        double sizes[4];
        double coefficients[4];
        double sum = 0.0;
        for (glm::length_t j = 0; j < 4; ++j) {
            coefficients[j] = of_row * matrix[j][row] + of_q * matrix[j][3];
            sizes[j] = std::fabs(of_row) * magnitude[j][row] + std::fabs(of_q) * magnitude[j][3];
            sum += sizes[j];
        }
        if (!(sum > 0x1p-400 && sum < 0x1p400)) return;
        const double scale = reciprocal_power_of_two(sum);
        for (std::size_t j = 0; j < 3; ++j) form.a[j] = scale * coefficients[j];
        form.d = scale * coefficients[3];
        const double of_width = 1.1 * width * scale;
        form.slack_per_size = gamma(64) * scale * (sizes[0] + sizes[1] + sizes[2]) + 0x1p-100 +
                              of_width * (magnitude[0][3] + magnitude[1][3] + magnitude[2][3]);
        form.slack = gamma(64) * scale * sizes[3] + 0x1p-100 + of_width * magnitude[3][3];
        forms_[k] = form;
    }

    struct Form {
        std::array<double, 3> a{};
        double d = 0.0;
        double slack_per_size = 1.0, slack = 1.0;
    };
    std::array<Form, 5> forms_;
};

class BoundsTree {
public:
    std::size_t size() const noexcept { return bounds_.size(); }
    const WorldBounds& operator[](std::size_t object) const noexcept { return bounds_[object]; }

    // Takes the bounds of the objects that changed, from bounds_of(object); all objects are below `count` or have none.
    // They are the changed ones until forget_changes().
    template <class BoundsOf>
    void change(std::span<const std::uint32_t> objects, std::size_t count, const BoundsOf& bounds_of) noexcept {
        const bool grows = count > bounds_.size();
        // Room for half as much again, so that objects which come one by one do not sort each time.
        if (grows) bounds_.resize(count + count / 2, WorldBounds::none());
        for (const std::uint32_t object : objects) bounds_[object] = bounds_of(object);
        // What moved is no longer where it was sorted in. Sorting costs less than as many moves.
        moves_ += objects.size();
        if (grows || moves_ > bounds_.size()) sort();
        for (const std::uint32_t object : objects) mark(object);
        if (height_ > 0) refit(height_ - 1, 0);
    }

    void forget_changes() noexcept {
        if (height_ > 0) forget(height_ - 1, 0);
    }

    // Calls found(object, inside) for what the forms do not leave out, of all objects or of the changed ones: `inside`
    // where all of it is lit for certain. Returns the number of bounds that were tested.
    template <class Found>
    std::size_t visit(const WorldForms& forms, bool all, const Found& found) const noexcept {
        return height_ > 0 ? visit(height_ - 1, 0, forms, all, found) : 0;
    }

private:
    static constexpr std::size_t width = 8;

    // Neighbours in a level, which share a place in the level above.
    struct Block {
        std::array<WorldBounds, width> bounds;
        std::uint32_t changed = 0;  // a bit for each

        Block() noexcept { bounds.fill(WorldBounds::none()); }

        WorldBounds all() const noexcept {
            WorldBounds sum = WorldBounds::none();
            for (const WorldBounds& one : bounds) {
                if (one.size < 0.0) continue;
                for (std::size_t j = 0; j < 3; ++j) {
                    sum.min[j] = sum.size < 0.0 ? one.min[j] : smaller(sum.min[j], one.min[j]);
                    sum.max[j] = sum.size < 0.0 ? one.max[j] : larger(sum.max[j], one.max[j]);
                }
                sum.size = larger(sum.size, one.size);
            }
            return sum;
        }

        template <class Action>
        static void for_each(std::uint32_t bits, const Action& action) noexcept {
            for (; bits != 0; bits &= bits - 1) action(static_cast<std::size_t>(std::countr_zero(bits)));
        }
    };

    void mark(std::uint32_t object) noexcept {
        std::size_t place = place_[object];
        levels_[0][place / width].bounds[place % width] = bounds_[object];
        for (std::size_t level = 0; level < height_; ++level, place /= width) {
            std::uint32_t& changed = levels_[level][place / width].changed;
            const std::uint32_t bit = 1u << place % width;
            if ((changed & bit) != 0) break;
            changed |= bit;
        }
    }

    void refit(std::size_t level, std::size_t index) noexcept {
        if (level == 0) return;
        Block& block = levels_[level][index];
        Block::for_each(block.changed, [&](std::size_t i) {
            refit(level - 1, index * width + i);
            block.bounds[i] = levels_[level - 1][index * width + i].all();
        });
    }

    void forget(std::size_t level, std::size_t index) noexcept {
        Block& block = levels_[level][index];
        if (level > 0) Block::for_each(block.changed, [&](std::size_t i) { forget(level - 1, index * width + i); });
        block.changed = 0;
    }

    template <class Found>
    std::size_t visit(std::size_t level, std::size_t index, const WorldForms& forms, bool all,
                      const Found& found) const noexcept {
        const Block& block = levels_[level][index];
        std::size_t tested = 0;
        Block::for_each(all ? (1u << width) - 1 : block.changed, [&](std::size_t i) {
            ++tested;
            const std::size_t place = index * width + i;
            const Coverage coverage = forms.coverage(block.bounds[i]);
            if (coverage == Coverage::outside) return;
            if (level > 0)
                tested += visit(level - 1, place, forms, all, found);
            else
                found(static_cast<std::uint32_t>(order_[place]), coverage == Coverage::inside);
        });
        return tested;
    }

    // Neighbours in the world become neighbours in the tree: by the Morton code of their middle.
    void sort() noexcept {
        moves_ = 0;
        const auto middle = [this](std::size_t object, glm::length_t axis) {
            const auto j = static_cast<std::size_t>(axis);
            return 0.5 * bounds_[object].min[j] + 0.5 * bounds_[object].max[j];
        };
        glm::dvec3 low((std::numeric_limits<double>::max)());
        glm::dvec3 high(std::numeric_limits<double>::lowest());
        const auto is_somewhere = [this](std::size_t object) {
            return bounds_[object].size >= 0.0 && bounds_[object].size < WorldBounds::unbounded_size;
        };
        for (std::size_t object = 0; object < bounds_.size(); ++object) {
            for (glm::length_t j = 0; j < 3 && is_somewhere(object); ++j) {
                low[j] = smaller(low[j], middle(object, j));
                high[j] = larger(high[j], middle(object, j));
            }
        }
        order_.resize(bounds_.size());
        for (std::size_t object = 0; object < bounds_.size(); ++object) {
            std::uint64_t code = 0x7fffffff;  // what is nowhere comes last
            if (is_somewhere(object)) {
                code = 0;
                for (glm::length_t j = 0; j < 3; ++j) {
                    const double extent = high[j] - low[j];
                    const double along = extent > 0.0 ? (middle(object, j) - low[j]) / extent : 0.0;
                    code |= every_third_bit(static_cast<std::uint32_t>(1023.0 * along)) << j;
                }
            }
            order_[object] = code << 32 | object;
        }
        std::sort(order_.begin(), order_.end());

        place_.resize(bounds_.size());
        std::size_t blocks = bounds_.size();
        for (height_ = 0; height_ == 0 || blocks > 1; ++height_) {
            blocks = (blocks + width - 1) / width;
            levels_[height_].assign(blocks, Block{});
        }
        for (std::size_t place = 0; place < order_.size(); ++place) {
            const auto object = static_cast<std::uint32_t>(order_[place]);
            place_[object] = static_cast<std::uint32_t>(place);
            mark(object);
        }
        refit(height_ - 1, 0);
        forget_changes();
    }

    static std::uint64_t every_third_bit(std::uint32_t ten_bits) noexcept {
        std::uint64_t result = 0;
        for (std::uint32_t i = 0; i < 10; ++i) result |= static_cast<std::uint64_t>(ten_bits >> i & 1u) << 3 * i;
        return result;
    }

    std::vector<WorldBounds> bounds_;            // of each object
    std::vector<std::uint64_t> order_;           // of each place: a Morton code, and below it the object
    std::vector<std::uint32_t> place_;           // of each object
    std::array<std::vector<Block>, 11> levels_;  // the objects' first; 8^11 is above 2^32
    std::size_t height_ = 0;
    std::size_t moves_ = 0;
};

}  // namespace TEXGEN_DETAIL
