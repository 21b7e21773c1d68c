#pragma once

// A tree over the objects' bounds in the world, which leaves out what a projector does not light.

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "../../primitives.hpp"
#include "../arithmetic/rounding.hpp"
#include "../held.hpp"
#include "world_forms.hpp"

namespace TEXGEN_DETAIL {

class BoundsTree {
public:
    const WorldBounds& operator[](std::size_t object) const noexcept { return bounds_[object]; }

    // Takes the bounds of the objects that changed from bounds_of(object); objects from `count` on have none. These are
    // the changed ones until the next call.
    void change(const std::span<const std::uint32_t>& objects, std::size_t count, const auto& bounds_of) noexcept {
        const bool grows = count > bounds_.size();
        if (grows) grow(count);
        for (const std::uint32_t object : objects) bounds_[object] = bounds_of(object);
        // The last sorting knows nothing of objects that moved since. To sort all anew costs less than as many moves
        // do, or than growing does.
        moves_ += objects.size();
        if (grows || (stage_ == Stage::sorted && moves_ > bounds_.size())) sort_all();
        sort(grows ? (std::numeric_limits<std::size_t>::max)() : steps_a_move * objects.size());
        for (const std::uint32_t object : objects) mark(object);
        refit();
        changed_.make(have_most_changed() ? 0 : changed_objects_.size(),
                      [&](std::size_t i) { return bounds_[changed_objects_[i]]; });
    }

    // Calls found(object, inside) for each object that the forms do not leave out, of all or of the changed ones;
    // `inside` says that all of it is lit for certain. Where most have changed, all are asked about in either case.
    // Returns the number of blocks that were tested.
    std::size_t visit(const WorldForms& forms, bool all, const auto& found) const noexcept {
        const bool visits_all = all || have_most_changed();
        const Levels& levels = visits_all ? all_ : changed_;
        const std::vector<std::uint32_t>& objects = visits_all ? object_at_ : changed_objects_;
        if (levels.height == 0) return 0;
        return levels.visit(levels.height - 1, 0, forms, [&](std::size_t place) {
            const Coverage coverage = forms.coverage(bounds_[objects[place]]);
            if (coverage != Coverage::outside) found(objects[place], coverage == Coverage::inside);
        });
    }

    // Takes how many blocks `visits` of all objects tested. Each pays for two steps of sorting, and they say when to
    // sort anew. An object that moved since the last sorting began may cost each visit a path of blocks. Up to that,
    // tests are wasted that are beyond twice those of a sorted tree, or all where most objects moved. A sorting begins
    // when as many are wasted as there are objects: it takes eight steps for each, less time than a test takes.
    void sort_for(std::size_t visits, std::size_t tested) noexcept {
        if (stage_ == Stage::sorted && visits > 0) {
            const std::size_t size = bounds_.size();
            if (tests_when_sorted_ == 0 && moves_ <= size / 8) tests_when_sorted_ = tested / visits + 1;
            const std::size_t fair = moves_ <= size / 2 ? 2 * tests_when_sorted_ * visits : 0;
            if (tested > fair) wasted_ += (std::min)(tested - fair, visits * moves_ * all_.height);
            if (wasted_ > size) sort_all();
        }
        sort(steps_a_test * tested);
    }

private:
    static constexpr std::size_t width = BoundsRow::width;

    static void for_each(std::uint32_t bits, const auto& action) noexcept {
        for (; bits != 0; bits &= bits - 1) action(static_cast<std::size_t>(std::countr_zero(bits)));
    }

    // Neighbours in a level, which share a place in the level above.
    struct Block {
        BoundsRow bounds;
        std::uint32_t changed = 0;  // a bit for each
    };

    // The lowest level has a block for every eight places, each other level one for every eight blocks below it.
    struct Levels {
        std::array<std::vector<Block>, 11> blocks;  // the lowest first; 8^11 is above 2^32
        HeldCount height;

        void resize(std::size_t places) noexcept {
            std::size_t level = 0;
            for (std::size_t count = places; count > (level > 0 ? 1 : 0); ++level) {
                count = (count + width - 1) / width;
                blocks[level].resize(count);
            }
            height = level;
        }

        void make(std::size_t places, const auto& bounds_of) noexcept {
            for (std::vector<Block>& level : blocks) level.clear();
            resize(places);
            for (std::size_t place = 0; place < places; ++place) put(place, bounds_of(place));
            for (std::size_t level = 1; level < height; ++level)
                for (std::size_t place = 0; place < blocks[level - 1].size(); ++place) fit(level, place);
        }

        void put(std::size_t place, const WorldBounds& bounds) noexcept {
            blocks[0][place / width].bounds.put(place % width, bounds);
        }
        void fit(std::size_t level, std::size_t place) noexcept {
            blocks[level][place / width].bounds.put(place % width, blocks[level - 1][place].bounds);
        }

        std::size_t visit(std::size_t level, std::size_t index, const WorldForms& forms,
                          const auto& found) const noexcept {
            std::size_t tested = 1;
            for_each(forms.may_light(blocks[level][index].bounds), [&](std::size_t i) {
                const std::size_t place = index * width + i;
                if (level > 0)
                    tested += visit(level - 1, place, forms, found);
                else
                    found(place);
            });
            return tested;
        }
    };

    bool have_most_changed() const noexcept { return changed_objects_.size() > bounds_.size() / 2; }

    void mark(std::uint32_t object) noexcept {
        std::size_t place = place_[object];
        all_.put(place, bounds_[object]);
        for (std::size_t level = 0; level < all_.height; ++level, place /= width)
            all_.blocks[level][place / width].changed |= 1u << place % width;
    }

    // Fits the blocks over the places that are marked; the objects there become the changed ones.
    void refit() noexcept {
        changed_objects_.clear();
        if (all_.height > 0) refit(all_.height - 1, 0);
    }
    void refit(std::size_t level, std::size_t index) noexcept {
        for_each(std::exchange(all_.blocks[level][index].changed, 0), [&](std::size_t i) {
            const std::size_t place = index * width + i;
            if (level == 0) return changed_objects_.push_back(object_at_[place]);
            refit(level - 1, place);
            all_.fit(level, place);
        });
    }

    // New objects stand behind the others until they are sorted in. There is room for half as many more, so that
    // objects that come one by one do not move all memory each time. A sorting that this interrupts starts again.
    void grow(std::size_t count) noexcept {
        const std::size_t before = bounds_.size();
        const std::size_t size = count + count / 2;
        bounds_.resize(size, WorldBounds::none());
        keys_.resize(size);
        sorted_keys_.resize(size);
        object_at_.resize(size);
        place_.resize(size);
        for (std::size_t i = before; i < size; ++i) object_at_[i] = place_[i] = static_cast<std::uint32_t>(i);
        for (std::size_t i = 0; i < size; ++i) keys_[i] = i;
        changed_objects_.reserve(size);
        changed_.resize(size / 2);
        all_.resize(size);
        for (std::size_t object = 0; object < before; object += width) mark(object_at_[object]);
        refit();
    }

    // Neighbours in the world become neighbours in the tree, by the Morton codes of their middles. A sorting runs in
    // slices of a few steps for each object that moves, so that about as many moves as there are objects pay for one.
    // It measures the extent of the world, encodes, and sorts by one byte of the codes after another (radix sort).
    // Where one object is far away most others have the same code: such crowds, runs of objects with one code, are
    // sorted by their own extents, twice if need be. At last each place gets its object. Meanwhile the tree stays
    // right, whatever stands where.
    enum class Stage { measure, encode, sort_by_byte, find_crowd, place, sorted };
    static constexpr std::size_t steps_a_move = 12;
    static constexpr std::size_t steps_a_test = 2;
    static constexpr std::size_t code_bytes = 4;
    static constexpr std::size_t crowd_size = 64;
    static constexpr int crowd_passes = 2;

    void begin(Stage stage, std::size_t next) noexcept {
        stage_ = stage;
        next_ = next;
    }

    void sort_all() noexcept {
        moves_ = wasted_ = tests_when_sorted_ = 0;
        first_ = 0;
        last_ = bounds_.size();
        pass_ = 0;
        begin(Stage::measure, first_);
    }

    void sort(std::size_t steps) noexcept {
        while (steps > 0 && stage_ != Stage::sorted) {
            const std::size_t last = stage_ < Stage::find_crowd ? last_ : bounds_.size();
            const std::size_t end = next_ + (std::min)(last - next_, steps);
            steps -= end - next_;
            if (stage_ == Stage::find_crowd && find_crowd(end)) {
                steps += end - last_;  // those that were not looked at
                continue;
            }
            if (stage_ == Stage::measure) measure(end);
            if (stage_ == Stage::encode) encode(end);
            if (stage_ == Stage::sort_by_byte) sort_by_byte(end);
            if (stage_ == Stage::place) put_in_place(end);
            next_ = end;
            if (next_ == last) begin_next_stage();
        }
    }

    void begin_next_stage() noexcept {
        if (stage_ == Stage::measure) {
            // A crowd without an extent needs no sorting.
            bool is_extended = false;
            for (std::size_t j = 0; j < 3; ++j) is_extended = is_extended || low_[j] < high_[j];
            if (pass_ == 0 || is_extended) return begin(Stage::encode, first_);
        } else if (stage_ == Stage::encode) {
            byte_ = 0;
            for (auto& places : first_place_) {
                auto sum = static_cast<std::uint32_t>(first_);
                for (std::uint32_t& first : places) sum += std::exchange(first, sum);
            }
            return begin(Stage::sort_by_byte, first_);
        } else if (stage_ == Stage::sort_by_byte && ++byte_ < code_bytes) {
            return begin(stage_, first_);
        } else if (stage_ == Stage::place) {
            return begin(Stage::sorted, 0);
        }
        const bool is_last = last_ == bounds_.size();
        if (is_last && pass_ == crowd_passes) return begin(Stage::place, 0);
        first_ = is_last ? 0 : last_;
        pass_ += is_last;
        begin(Stage::find_crowd, first_);
    }

    // Whether a crowd ends before `end`; if so its keys become those that are sorted.
    bool find_crowd(std::size_t end) noexcept {
        for (std::size_t i = next_; i < end; ++i) {
            const bool is_last = i + 1 == bounds_.size();
            if (!is_last && code_of(keys_[i]) == code_of(keys_[i + 1])) continue;
            const std::size_t first = std::exchange(first_, i + 1);
            if (i + 1 - first <= crowd_size || code_of(keys_[i]) == code_of_nowhere) continue;
            first_ = first;
            last_ = i + 1;
            begin(Stage::measure, first_);
            return true;
        }
        if (end == bounds_.size()) last_ = end;
        return false;
    }

    bool is_somewhere(std::size_t object) const noexcept {
        return bounds_[object].size >= 0.0 && bounds_[object].size < WorldBounds::unbounded_size;
    }
    double middle(std::size_t object, std::size_t axis) const noexcept {
        return 0.5 * bounds_[object].min[axis] + 0.5 * bounds_[object].max[axis];
    }

    void measure(std::size_t end) noexcept {
        if (next_ == first_) {
            low_.fill((std::numeric_limits<double>::max)());
            high_.fill(std::numeric_limits<double>::lowest());
        }
        for (std::size_t i = next_; i < end; ++i) {
            const std::size_t object = object_of(keys_[i]);
            for (std::size_t j = 0; j < 3 && is_somewhere(object); ++j) {
                low_[j] = smaller(low_[j], middle(object, j));
                high_[j] = larger(high_[j], middle(object, j));
            }
        }
    }

    // Objects that moved beyond the measured extent get the codes of its ends; those that are nowhere come last.
    void encode(std::size_t end) noexcept {
        if (next_ == first_) first_place_ = {};
        for (std::size_t i = next_; i < end; ++i) {
            const std::size_t object = object_of(keys_[i]);
            std::uint64_t code = code_of_nowhere;
            if (is_somewhere(object)) {
                code = 0;
                for (std::size_t j = 0; j < 3; ++j) {
                    const double extent = high_[j] - low_[j];
                    const double along = extent > 0.0 ? (middle(object, j) - low_[j]) / extent : 0.0;
                    code |= every_third_bit(static_cast<std::uint32_t>(1023.0 * smaller(larger(along, 0.0), 1.0))) << j;
                }
            }
            keys_[i] = code << 32 | object;
            for (std::size_t byte = 0; byte < code_bytes; ++byte) ++first_place_[byte][byte_of(keys_[i], byte)];
        }
    }

    static constexpr std::uint64_t code_of_nowhere = 0x7fffffff;
    static std::uint64_t code_of(std::uint64_t key) noexcept { return key >> 32; }
    static std::uint32_t object_of(std::uint64_t key) noexcept { return static_cast<std::uint32_t>(key); }
    static std::size_t byte_of(std::uint64_t key, std::size_t byte) noexcept { return key >> (32 + 8 * byte) & 0xff; }

    // The keys go there and back, so that after an even number of bytes they are sorted in keys_.
    void sort_by_byte(std::size_t end) noexcept {
        static_assert(code_bytes % 2 == 0);
        const auto& from = byte_ % 2 == 0 ? keys_ : sorted_keys_;
        auto& to = byte_ % 2 == 0 ? sorted_keys_ : keys_;
        for (std::size_t i = next_; i < end; ++i) to[first_place_[byte_][byte_of(from[i], byte_)]++] = from[i];
    }

    void put_in_place(std::size_t end) noexcept {
        for (std::size_t place = next_; place < end; ++place) {
            const std::uint32_t object = object_of(keys_[place]);
            const std::uint32_t other = object_at_[place];
            if (object == other) continue;
            std::swap(object_at_[place], object_at_[place_[object]]);
            std::swap(place_[object], place_[other]);
            mark(object);
            mark(other);
        }
        refit();
    }

    static std::uint64_t every_third_bit(std::uint32_t ten_bits) noexcept {
        std::uint64_t result = 0;
        for (std::uint32_t i = 0; i < 10; ++i) result |= static_cast<std::uint64_t>(ten_bits >> i & 1u) << 3 * i;
        return result;
    }

    std::vector<WorldBounds> bounds_;                // of each object
    std::vector<std::uint32_t> place_;               // of each object
    std::vector<std::uint32_t> object_at_;           // of each place
    std::vector<std::uint64_t> keys_, sorted_keys_;  // a Morton code, and in its low half an object
    Levels all_;                                     // over the places
    std::vector<std::uint32_t> changed_objects_;     // in the order of their places
    Levels changed_;                                 // over these, where they are not most of all
    std::size_t moves_ = 0;                          // since the last sorting began
    std::size_t wasted_ = 0;                         // tests that these moves cost, since it ended
    std::size_t tests_when_sorted_ = 0;              // of a visit then; 0 where that is not known

    Stage stage_ = Stage::sorted;
    std::size_t next_ = 0;              // of the stage: a key, or a place
    std::size_t first_ = 0, last_ = 0;  // the keys that are sorted
    int pass_ = 0;
    std::size_t byte_ = 0;
    std::array<double, 3> low_{}, high_{};
    std::array<std::array<std::uint32_t, 256>, code_bytes> first_place_{};  // of each byte's values
};

}  // namespace TEXGEN_DETAIL
