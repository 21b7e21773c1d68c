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
#include <utility>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "../../conventions.hpp"
#include "../../coverage.hpp"
#include "../arithmetic/inverse.hpp"
#include "../arithmetic/nearest.hpp"
#include "../arithmetic/rounding.hpp"
#include "../arithmetic/widen.hpp"

namespace TEXGEN_DETAIL {

// How many times the smallest element that is not 0 the largest is; infinite where an element is beyond 2^+-200, so that
// a product of three matrices neither overflows nor underflows. r is in no form, and may be small.
//
// Each element of such a product, rounded, is a multiple of the product of the factors' last bits. So where the quotients of
// M, and of S P and V together, are no larger than these, no element of T_o that is not 0 is below 2^-600 of the largest,
// and coverage() of it is decided.
inline double range_of(const glm::dmat4& m, bool without_r = false) noexcept {
    double smallest = 0x1p200;
    double largest = 0x1p-200;
    for (glm::length_t column = 0; column < 4; ++column) {
        for (glm::length_t row = 0; row < 4; ++row) {
            const double size = std::fabs(m[column][row]);
            if (!(size <= 0x1p200)) return std::numeric_limits<double>::infinity();
            if (size == 0.0 || (without_r && row == 2)) continue;
            if (size < 0x1p-200) return std::numeric_limits<double>::infinity();
            smallest = smaller(smallest, size);
            largest = larger(largest, size);
        }
    }
    return largest / smallest;
}
inline constexpr double object_range = 0x1p240;
inline constexpr double projector_range = 0x1p190;
static_assert(object_range * projector_range * 0x1p165 < 0x1p600);  // three times 53 bits, two sums of four, and 2

// Where M v is for the points v of an object's box. All numbers are finite.
struct WorldBounds {
    std::array<double, 3> min, max;
    double size;  // >= |M| |v| in each component, which the rounding of any product with M goes by; < 0: no point

    static constexpr double unbounded_size = 0x1p500;
    static constexpr WorldBounds none() noexcept { return {{}, {}, -1.0}; }
    static constexpr WorldBounds unbounded() noexcept { return {{}, {}, unbounded_size}; }

    friend bool operator==(const WorldBounds&, const WorldBounds&) = default;
};

// Unbounded where a number is not finite, M is not affine or its exponents are far apart. Four terms a component, each rounded at most five times.
inline WorldBounds world_bounds(const glm::dmat4& m, const Box& box) noexcept {
    WorldBounds result = WorldBounds::none();
    const glm::dvec3 low = widened(box.min);
    const glm::dvec3 high = widened(box.max);
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
    if (!is_affine || !(range_of(m) <= object_range)) return WorldBounds::unbounded();
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
    // texture_from_eye is S P. Where coverage() may not be able to say, the forms say nothing; nor does that of an infinite
    // side.
    WorldForms(const glm::dmat4& texture_from_eye, const glm::dmat4& view, const TextureRegion& region) noexcept {
        const glm::dmat4 matrix = texture_from_eye * view;
        if (!(range_of(texture_from_eye, true) * range_of(view) <= projector_range)) return;
        constexpr double infinity = std::numeric_limits<double>::infinity();
        for (glm::length_t k = 0; k < 2; ++k) {
            if (!LitForms::is_usable_side((region.min)()[k], -infinity)) return;
            if (!LitForms::is_usable_side((region.max)()[k], infinity)) return;
        }
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
        if (grows) grow(count);
        for (const std::uint32_t object : objects) bounds_[object] = bounds_of(object);
        // What moved is no longer where it was sorted in. Sorting costs less than as many moves.
        moves_ += objects.size();
        if (grows || (stage_ == Stage::sorted && moves_ > bounds_.size())) {
            moves_ = 0;
            begin(Stage::measure);
        }
        sort(steps_a_move * objects.size());
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
                found(object_at_[place], coverage == Coverage::inside);
        });
        return tested;
    }

    // New objects stand behind the others, until they are sorted in. Room for half as much again, so that objects which
    // come one by one do not move all memory each time.
    void grow(std::size_t count) noexcept {
        const std::size_t before = bounds_.size();
        const std::size_t size = count + count / 2;
        bounds_.resize(size, WorldBounds::none());
        keys_.resize(size);
        sorted_keys_.resize(size);
        object_at_.resize(size);
        place_.resize(size);
        for (std::size_t i = before; i < size; ++i) object_at_[i] = place_[i] = static_cast<std::uint32_t>(i);
        std::size_t blocks = size;
        for (height_ = 0; height_ == 0 || blocks > 1; ++height_) {
            blocks = (blocks + width - 1) / width;
            levels_[height_].resize(blocks);
        }
        for (std::size_t object = 0; object < before; object += width) mark(object_at_[object]);
        refit(height_ - 1, 0);
        forget_changes();
    }

    // Neighbours in the world become neighbours in the tree, by the Morton code of their middle. That is done in slices, of
    // some steps for each object that moves, and so at most once for as many moves as there are objects: the extent of the
    // world, the codes, a radix sort by their bytes, and at last place after place gets its object. Meanwhile the tree is as
    // right as ever, whatever stands where.
    enum class Stage { measure, encode, sort_by_byte, place, sorted };
    static constexpr std::size_t steps_a_move = 12;
    static constexpr std::size_t code_bytes = 4;

    void begin(Stage stage) noexcept {
        stage_ = stage;
        next_ = 0;
    }

    void sort(std::size_t steps) noexcept {
        while (steps > 0 && stage_ != Stage::sorted) {
            const std::size_t end = (std::min)(bounds_.size(), next_ + steps);
            steps -= end - next_;
            switch (stage_) {
                case Stage::measure:
                    measure(end);
                    break;
                case Stage::encode:
                    encode(end);
                    break;
                case Stage::sort_by_byte:
                    sort_by_byte(end);
                    break;
                default:
                    put_in_place(end);
                    break;
            }
            next_ = end;
            if (next_ == bounds_.size()) begin_next_stage();
        }
    }

    void begin_next_stage() noexcept {
        if (stage_ == Stage::encode) {
            byte_ = 0;
            for (auto& places : first_place_) {
                std::uint32_t sum = 0;
                for (std::uint32_t& first : places) sum += std::exchange(first, sum);
            }
        }
        if (stage_ == Stage::sort_by_byte) {
            std::swap(keys_, sorted_keys_);
            if (++byte_ < code_bytes) return begin(stage_);
        }
        begin(static_cast<Stage>(static_cast<int>(stage_) + 1));
    }

    bool is_somewhere(std::size_t object) const noexcept {
        return bounds_[object].size >= 0.0 && bounds_[object].size < WorldBounds::unbounded_size;
    }
    double middle(std::size_t object, std::size_t axis) const noexcept {
        return 0.5 * bounds_[object].min[axis] + 0.5 * bounds_[object].max[axis];
    }

    void measure(std::size_t end) noexcept {
        if (next_ == 0) {
            low_.fill((std::numeric_limits<double>::max)());
            high_.fill(std::numeric_limits<double>::lowest());
        }
        for (std::size_t object = next_; object < end; ++object) {
            for (std::size_t j = 0; j < 3 && is_somewhere(object); ++j) {
                low_[j] = smaller(low_[j], middle(object, j));
                high_[j] = larger(high_[j], middle(object, j));
            }
        }
    }

    // What moved beyond the extent since stands at its end; what is nowhere comes last.
    void encode(std::size_t end) noexcept {
        if (next_ == 0) first_place_ = {};
        for (std::size_t object = next_; object < end; ++object) {
            std::uint64_t code = 0x7fffffff;
            if (is_somewhere(object)) {
                code = 0;
                for (std::size_t j = 0; j < 3; ++j) {
                    const double extent = high_[j] - low_[j];
                    const double along = extent > 0.0 ? (middle(object, j) - low_[j]) / extent : 0.0;
                    code |= every_third_bit(static_cast<std::uint32_t>(1023.0 * smaller(larger(along, 0.0), 1.0))) << j;
                }
            }
            keys_[object] = code << 32 | object;
            for (std::size_t byte = 0; byte < code_bytes; ++byte) ++first_place_[byte][byte_of(keys_[object], byte)];
        }
    }

    static std::size_t byte_of(std::uint64_t key, std::size_t byte) noexcept { return key >> (32 + 8 * byte) & 0xff; }

    void sort_by_byte(std::size_t end) noexcept {
        for (std::size_t i = next_; i < end; ++i)
            sorted_keys_[first_place_[byte_][byte_of(keys_[i], byte_)]++] = keys_[i];
    }

    void put_in_place(std::size_t end) noexcept {
        for (std::size_t place = next_; place < end; ++place) {
            const auto object = static_cast<std::uint32_t>(keys_[place]);
            const std::uint32_t other = object_at_[place];
            if (object == other) continue;
            std::swap(object_at_[place], object_at_[place_[object]]);
            std::swap(place_[object], place_[other]);
            mark(object);
            mark(other);
        }
        refit(height_ - 1, 0);
        forget_changes();
    }

    static std::uint64_t every_third_bit(std::uint32_t ten_bits) noexcept {
        std::uint64_t result = 0;
        for (std::uint32_t i = 0; i < 10; ++i) result |= static_cast<std::uint64_t>(ten_bits >> i & 1u) << 3 * i;
        return result;
    }

    std::vector<WorldBounds> bounds_;                // of each object
    std::vector<std::uint32_t> place_;               // of each object
    std::vector<std::uint32_t> object_at_;           // of each place
    std::vector<std::uint64_t> keys_, sorted_keys_;  // a Morton code, and below it the object
    std::array<std::vector<Block>, 11> levels_;      // the objects' first; 8^11 is above 2^32
    std::size_t height_ = 0;
    std::size_t moves_ = 0;  // since the last sorting began

    Stage stage_ = Stage::sorted;
    std::size_t next_ = 0;  // of the stage: an object, or a place
    std::size_t byte_ = 0;
    std::array<double, 3> low_{}, high_{};
    std::array<std::array<std::uint32_t, 256>, code_bytes> first_place_{};  // of each byte's values
};

}  // namespace TEXGEN_DETAIL
