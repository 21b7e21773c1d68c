#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <texgen/conventions.hpp>
#include <texgen/primitives.hpp>

#include "chart.hpp"
#include "rasterizer.hpp"

namespace report {

// The input of one fragment, in full.
struct Witness {
    texgen::Triangle triangle;
    int x, y;
};

std::string in_hexadecimal(const Witness& witness);

// Errors of s and t against the reference in long double, over the covered fragments that the slide falls on.
struct Errors {
    double max_texels = 0, nearly_max_texels = 0;  // of a texture of 4096; nearly max: the 99.9th percentile
    double max_ulp = 0, nearly_max_ulp = 0;        // of float, where the coordinate is a texel or more from 0
    std::size_t wrong_decisions = 0;               // lit where it is dark, or dark where it is lit
    Witness worst{};
};

struct Measurement {
    std::string method;
    double nanoseconds;  // a fragment of the rects, the set-up of the triangles included
    Errors errors;
};

struct Comparison {
    std::size_t covered_fragments = 0, evaluated_fragments = 0;
    std::vector<Measurement> measurements;           // the library first: exact, then within 1/512 texel
    std::array<std::size_t, 5> fragments_of_work{};  // by texgen::Work, of the library, exact
    double largest_ulp = 0;  // of the library's s, t and r, on every fragment for which it makes its promise
    Witness largest_ulp_at{};

    bool is_as_promised() const;
};

// Runs the library and its peers over the work: first once for the errors, then in turns against the clock.
Comparison compare(const Workload& work, const texgen::TextureRegion& region, int rounds);

// Nanoseconds a triangle, its set-up included, against the fragments of its rectangle, 1 to 4096: a line a method.
std::vector<Series> times_by_size(int rounds);

// From how many fragments on ours takes no longer than theirs: 0 where it never takes longer, empty where that is
// beyond the last.
std::optional<double> overtakes_at(const Series& ours, const Series& theirs);

}  // namespace report
