// The inner loops of a batch: fragments of any of its triangles. Included by batch.inc.hpp.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

// The functions of one triangle, as BatchLanes has those of several.
struct OneTriangle {
    const double* value;
    TEXGEN_INLINE Doubles operator[](std::size_t k) const noexcept { return value[k] - Doubles{}; }
};

TEXGEN_INLINE bool all(const LongWords& mask) noexcept { return lane_bits(mask) == (std::uint64_t{1} << lanes) - 1; }

// A vector of fragments at (x, y): quotients where they are in front, and the lanes whose side or value is in doubt.
template <std::size_t Numerators>
struct FragmentLanes {
    Floats quotient[Numerators];
    LongWords front;
    Words doubtful;

    TEXGEN_INLINE void divide(const auto& functions, const Doubles& x, const Doubles& y, double tolerance) noexcept {
        const Doubles p_x = x - functions[BatchPlanes::origin], p_y = y - functions[BatchPlanes::origin + 1];
        const Doubles stretch = magnitude(p_x) * functions[BatchPlanes::per_reach] +
                                (magnitude(p_y) * functions[BatchPlanes::per_reach + 1] + 1.001);
        const Doubles q =
            functions[BatchPlanes::q] + (functions[BatchPlanes::q + 1] * p_x + functions[BatchPlanes::q + 2] * p_y);
        const Doubles q_error = functions[BatchPlanes::q + 3] * stretch;
        front = greater(q, q_error * well_in_front);
        const Doubles reciprocal = where(front, 1.0 / q);
        const Doubles stretched = stretch * (reciprocal * 1.0001);
        Doubles u[Numerators], largest{}, largest_error{};
        TEXGEN_FOR (std::size_t k = 0; k < Numerators; ++k) {
            const std::size_t place = BatchPlanes::of_coordinate[k];
            u[k] = (functions[place] + (functions[place + 1] * p_x + functions[place + 2] * p_y)) * reciprocal +
                   0.0;  // no -0
            largest = k == 0 ? magnitude(u[k]) : maximum(largest, magnitude(u[k]));
            largest_error = k == 0 ? functions[place + 3] : maximum(largest_error, functions[place + 3]);
            quotient[k] = to_floats(u[k]);
        }
        doubtful = Words{};
        LongWords is_certain{};
        if (tolerance > 0.0) {
            // Either float next to a quotient errs by half of the distance between the two, and by what doubles are
            // rounded by, within 1.0002.
            const Doubles written = (largest * functions[BatchPlanes::q + 3] + largest_error) * stretched +
                                    (largest * (0.5001 * unit_roundoff_float) + 0x1p-150);
            is_certain = front & at_most(written, Doubles{} + 0.5 * tolerance);
            if (all(is_certain)) [[likely]]
                return;
        }
        if (!all(front)) doubtful = narrow(~(front | greater(q * -1.0, q_error)));
        const Doubles relative_error = functions[BatchPlanes::q + 3] * stretched + 8.0 * unit_roundoff_double;
        TEXGEN_FOR (std::size_t k = 0; k < Numerators; ++k) {
            const Doubles error =
                functions[BatchPlanes::of_coordinate[k] + 3] * stretched + magnitude(u[k]) * relative_error;
            const RoundedEnds ends(u[k], error);
            quotient[k] = ends.below;
            doubtful |= ends.differ();
        }
        doubtful &= ~narrow(is_certain);
    }
};

TEXGEN_INLINE const float* vertices_of(const auto& job, std::size_t triangle) noexcept {
    return job.vertices + 3 * BatchVertex::size * triangle;
}

// The ids of a vector of fragments from n on. Lanes behind the last fragment have the id of the first one.
struct FragmentIds {
    std::uint32_t last[lanes];
    const std::uint32_t* value;
    bool is_whole;

    TEXGEN_INLINE FragmentIds(const auto& job, std::size_t n) noexcept
        : value(job.ids + n), is_whole(n + at_once <= job.count) {
        if (is_whole) return;
        for (std::size_t i = 0; i < at_once; ++i) last[i] = n + i < job.count ? value[i] : value[0];
        value = last;
    }
    TEXGEN_INLINE bool are_one() const noexcept {
        return !any(load<Words>(value) ^ (Words{} + static_cast<int>(value[0])));
    }
};

// The centres of a vector of fragments of a rectangle, which follow one another row by row.
class FragmentCentres {
public:
    Doubles x, y;

    TEXGEN_INLINE FragmentCentres(const auto& job, std::size_t first) noexcept
        : width_(job.width),
          per_width_(1.0 / job.width),
          left_(job.x + 0.5),
          top_(job.y + 0.5),
          first_(static_cast<double>(first)) {
        place();
    }
    // Goes to the next vector, which is beside this one if its row has room for it.
    TEXGEN_INLINE void advance() noexcept {
        first_ += lanes;
        column_ += lanes;
        if (column_ + lanes <= width_)
            x = x + static_cast<double>(lanes);
        else
            place();
    }

private:
    TEXGEN_INLINE void place() noexcept {
        using Walk = FragmentWalk<Doubles, double>;
        const Walk walk(width_, per_width_, first_);
        x = walk.x + left_;
        y = walk.y + top_;
        column_ = first_ - Walk::row_of(first_ + 0.5, per_width_) * width_;
    }

    double width_, per_width_, left_, top_;
    double first_, column_;  // of the first fragment: its number, and its column
};

// What earlier vectors in doubt say about later ones: whether these are likely to share triangles, how to decide them
// first, and the functions of triangles, over rows of this width from the first row on.
struct Learned {
    enum Way { nearly, closely, about_corners };
    static constexpr double rows = 64.0;
    bool vectors_share = true, are_functions_about_corners = false;
    Way first = nearly;
    unsigned triangles = 0;  // a bit for each
    std::uint32_t id[batch_block];
    double left = 0.0, top = 0.0, width = 0.0;
    BatchFunctions functions;
};

// Collects vectors of fragments that have lanes in doubt, and up to a block of their triangles, and decides them at
// once by functions that the fragments of a triangle share. Where only a few vectors were collected, and for lanes that
// stay in doubt, each is decided by itself.
class DoubtfulFragments {
public:
    struct Vector {
        Doubles x, y;
        Words doubtful;
        const FragmentOutputs* out;
        std::size_t n, place;  // where the first fragment goes: in `out`, and in the block
    };

    // For a block of the fragments of a rectangle, which `learned` outlives.
    TEXGEN_INLINE DoubtfulFragments(const FragmentsJob& job, Learned& learned, double left, double top, double width,
                                    double height) noexcept
        : job_(job), learned_(learned), left_(left), top_(top), width_(width), height_(height) {}

    TEXGEN_INLINE void add(const Vector& vector, const FragmentIds& ids) noexcept {
        const bool is_shared = learned_.vectors_share || ids.are_one();
        if (is_shared && has_taken(vector, ids)) return;
        if (is_shared && count_ != 0) {
            learned_.vectors_share = count_ > 1;
            decide();
            if (has_taken(vector, ids)) return;
        }
        if (count_ == 0) triangles_ = 0;
        const float* of_lane[lanes];
        for (std::size_t i = 0; i < at_once; ++i)
            of_lane[i] = vertices_of(job_, ids.value[i] < job_.triangles ? ids.value[i] : 0);
        undecided_ |= put_closely(of_lane, vector) << vector.place;
    }

    // The fragments that stay in doubt, as bits of the block.
    TEXGEN_INLINE std::uint64_t undecided() noexcept {
        if (count_ != 0) decide();
        return undecided_;
    }

private:
    struct Known {
        Vector vector;
        std::size_t triangle[lanes];  // of each lane; of a lane that is certain, that of the first one in doubt
        bool is_one;                  // all lanes have the first one's

        TEXGEN_INLINE std::size_t place(std::size_t i) const noexcept { return triangle[is_one ? 0 : i]; }
    };

    TEXGEN_INLINE bool has(std::size_t place) const noexcept { return (triangles_ >> place & 1u) != 0; }

    // Collects a vector; false where there is no room for its triangles.
    TEXGEN_INLINE bool has_taken(const Vector& vector, const FragmentIds& ids) noexcept {
        Known& known = vectors_[count_];
        known.vector = vector;
        known.is_one = ids.are_one();
        const std::uint64_t asked = lane_bits(vector.doubtful);
        const auto first = static_cast<std::size_t>(std::countr_zero(asked));
        for (std::size_t i = 0; i < (known.is_one ? 1 : at_once); ++i) {
            const std::uint32_t id = ids.value[(asked >> i & 1u) != 0 ? i : first];
            const std::size_t place = id % batch_block;
            if (has(place) && id_[place] != id) return false;
            known.triangle[i] = place;
            triangles_ |= 1u << place;
            id_[place] = id;
        }
        ++count_;
        return true;
    }

    // Decides the vectors that are collected, and puts their values in place.
    TEXGEN_APART void decide() noexcept {
        const bool are_few = count_ <= 2;
        if (!are_few && !are_functions_known()) take_functions();
        bool is_one_left = false;
        for (std::size_t k = 0; k < count_; ++k) {
            const Known& known = vectors_[k];
            std::uint64_t left = are_few ? lane_bits(known.vector.doubtful) : put_together(known);
            if (left != 0 && is_one_left && !are_few && !learned_.are_functions_about_corners) {
                learned_.are_functions_about_corners = true;
                take_functions();
                left = put_together(known);
            }
            if (left != 0) {
                is_one_left = true;
                const float* of_lane[lanes];
                for (std::size_t i = 0; i < at_once; ++i) of_lane[i] = vertices_of(job_, id_[known.place(i)]);
                left = put_closely(of_lane, known.vector);
            }
            undecided_ |= left << known.vector.place;
        }
        triangles_ = 0;
        count_ = 0;
    }

    // Decides a vector by the shared functions. Returns the lanes that stay in doubt, as put() and put_closely() do.
    TEXGEN_APART std::uint64_t put_together(const Known& known) const noexcept {
        const Doubles x = known.vector.x - learned_.left, y = known.vector.y - learned_.top;
        const BatchFunction* const functions = learned_.functions.of;
        if (known.is_one) return put(known.vector, BatchFunctionsAt<BatchFunction>{functions[known.place(0)], x, y});
        const BatchFunction* of_lane[lanes];
        for (std::size_t i = 0; i < at_once; ++i) of_lane[i] = &functions[known.place(i)];
        const LaneFunctions of(of_lane, job_.needs_r());
        return put(known.vector, BatchFunctionsAt<LaneFunctions>{of, x, y});
    }

    bool are_functions_known() const noexcept {
        bool are_same = learned_.left == left_ && learned_.width >= width_ && learned_.top <= top_ &&
                        top_ + height_ <= learned_.top + learned_.rows;
        for (std::size_t i = 0; i < batch_block; ++i)
            are_same &= !has(i) || ((learned_.triangles >> i & 1u) != 0 && learned_.id[i] == id_[i]);
        return are_same;
    }

    // Makes the functions of all these triangles, and of earlier ones whose places they do not take.
    TEXGEN_APART void take_functions() noexcept {
        for (std::size_t i = 0; i < batch_block; ++i)
            if (has(i)) learned_.id[i] = id_[i];
        learned_.triangles |= triangles_;
        learned_.left = left_;
        learned_.top = top_;
        learned_.width = width_;
        const auto first = static_cast<std::size_t>(std::countr_zero(triangles_));
        const Doubles none{};
        for (std::size_t i = 0; i < batch_block; i += at_once) {
            const float* of_lane[lanes];
            for (std::size_t j = 0; j < at_once; ++j)
                of_lane[j] = vertices_of(job_, learned_.id[(learned_.triangles >> (i + j) & 1u) != 0 ? i + j : first]);
            learned_.functions.take(of_lane, job_.needs_r(), none + left_, none + top_, none + width_,
                                    none + learned_.rows, i, learned_.are_functions_about_corners);
        }
    }

    TEXGEN_APART std::uint64_t put(const Vector& vector, const auto& at) const noexcept {
        CloseFragments<3> fragments;
        const CloseDivisor q(at.values(3));
        fragments.quotient[2] = Floats{};
        fragments.divide(at, q, job_.needs_r() ? 3 : 2, job_.tolerance, true);
        vector.out->put_where(vector.doubtful, vector.n, fragments.quotient, q.front);
        return lane_bits(vector.doubtful & narrow(fragments.doubtful));
    }

    // Decides a vector by itself: by residues and doubles, then by two doubles, then about a corner. It begins with
    // what decided the vector before.
    TEXGEN_APART std::uint64_t put_closely(const float* const (&of_lane)[lanes], const Vector& vector) noexcept {
        const VertexLanes vertices(of_lane);
        CloseFragmentsAt at(job_.needs_r());
        std::uint64_t left = 0;
        const Learned::Way first = learned_.first;
        if (first == Learned::about_corners) {
            at.take_about_corners(vertices, vector.x, vector.y, true);
            left = put(vector, at);
            if (left == 0) return 0;
        }
        const bool starts_closely = first != Learned::nearly;
        for (const bool closely : {starts_closely, !starts_closely}) {
            if (closely) {
                at.take(vertices, CloseLanes(vertices, vector.x, vector.y), true);
            } else {
                at.add_residues(vertices, vector.x, vector.y);
                if (!starts_closely) at.take(vertices, NearLanes(vertices, vector.x, vector.y), false);
            }
            if (!closely || !starts_closely) at.sharpen();
            left = put(vector, at);
            if (left == 0) return 0;
            if (first == Learned::nearly) learned_.first = Learned::closely;
        }
        at.take_about_corners(vertices, vector.x, vector.y, false);
        learned_.first = Learned::about_corners;
        return put(vector, at);
    }

    const FragmentsJob& job_;
    Learned& learned_;
    double left_, top_, width_, height_;
    std::uint64_t undecided_ = 0;
    std::size_t count_ = 0;
    unsigned triangles_ = 0;  // a bit for each
    std::uint32_t id_[batch_block];
    Known vectors_[exact_block / lanes];
};

// Decides a block of fragments anew, of whose vectors these lanes are in doubt. Returns those that stay so, as bits.
TEXGEN_APART inline std::uint64_t decide_fragments(const FragmentsJob& job, const FragmentOutputs& out,
                                                   const FragmentOutputs& in_scratch, std::size_t begin,
                                                   std::size_t end, const Words* doubtful, Learned& learned) noexcept {
    FragmentCentres centres(job, begin);
    // The block is a part of one row, or of whole rows.
    const auto width = static_cast<std::size_t>(job.width);
    const std::size_t row = begin / width;
    const std::size_t rows = (end - 1) / width - row + 1;
    const bool is_part = rows == 1 && width > 1024;
    const std::size_t column = is_part ? begin % width : 0;
    DoubtfulFragments fragments(job, learned, job.x + 0.5 + static_cast<double>(column),
                                job.y + 0.5 + static_cast<double>(row),
                                static_cast<double>(is_part ? end - begin : width), static_cast<double>(rows));
    for (std::size_t n = begin; n < end; n += at_once, centres.advance(), ++doubtful) {
        if (!any(*doubtful)) continue;
        const FragmentIds ids(job, n);
        fragments.add({centres.x, centres.y, ~equal(*doubtful, 0), ids.is_whole ? &out : &in_scratch,
                       ids.is_whole ? n : std::size_t{0}, n - begin},
                      ids);
    }
    return fragments.undecided();
}

// What is learned is large: the caller has it, so that this function's frame stays small.
template <std::size_t Numerators>
TEXGEN_APART Undecided divide_all_fragments(const FragmentsJob& job, std::size_t first, Learned& learned) noexcept {
    const FragmentOutputs out{job};
    ScratchOutputs<at_once> scratch;
    const FragmentOutputs in_scratch = scratch.in_place_of(out);
    FragmentCentres centres(job, first);
    const auto planes_of = [&](std::uint32_t id) { return &job.planes[id < job.triangles ? id : job.triangles]; };
    for (std::size_t n = first; n < job.count;) {
        const std::size_t begin = n;
        const std::size_t end = job.count - begin < exact_block ? job.count : begin + exact_block;
        Words doubtful[exact_block / at_once], any_doubtful{};
        Words* next = doubtful;
        for (; n < end; n += at_once, centres.advance()) {
            const FragmentIds ids(job, n);
            FragmentLanes<Numerators> fragments;
            if (ids.are_one() && ids.value[0] >= job.triangles) {
                fragments = FragmentLanes<Numerators>{};
            } else if (ids.are_one()) {
                fragments.divide(OneTriangle{planes_of(ids.value[0])->value}, centres.x, centres.y, job.tolerance);
            } else {
                const BatchPlanes* of_lane[lanes];
                TEXGEN_FOR (std::size_t i = 0; i < at_once; ++i) of_lane[i] = planes_of(ids.value[i]);
                const BatchLanes functions([&](std::size_t j) { return of_lane[j]->value; }, Numerators == 3);
                fragments.divide(functions, centres.x, centres.y, job.tolerance);
            }
            const FragmentOutputs& to = ids.is_whole ? out : in_scratch;
            to.put(ids.is_whole ? n : 0, fragments.quotient, fragments.front);
            *next++ = fragments.doubtful;
            any_doubtful |= fragments.doubtful;
        }
        std::uint64_t undecided = 0;
        if (any(any_doubtful)) undecided = decide_fragments(job, out, in_scratch, begin, end, doubtful, learned);
        if (n > job.count) scratch.copy_to(out, n - at_once, job.count + at_once - n);
        if (undecided != 0) return {begin, undecided};
    }
    return {job.count, 0};
}

template <class CompiledWhereCalled = void>
Undecided divide_batch_fragments(const FragmentsJob& original, std::size_t first) noexcept {
    const FragmentsJob job = original;
    Learned learned;
    return job.needs_r() ? divide_all_fragments<3>(job, first, learned) : divide_all_fragments<2>(job, first, learned);
}

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
