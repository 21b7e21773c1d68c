#pragma once

// The frame of the benchmarks: rows that are checked before they are timed, the memory they share, and what is written
// at most or at least (the floors).

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <optional>
#include <string>

#include <benchmark/benchmark.h>
#include <texgen/conventions.hpp>

#include "../error.hpp"

namespace bench {

// The workloads.
void add_matrices();
void add_generate();
void add_project();
void add_segment();
void add_rows();
void add_visibility();
void add_depth();
void add_coverage();
void add_scenes();
void add_footprints();

constexpr std::size_t l1_count = 1024, l2_count = 32768, dram_count = std::size_t{1} << 24;

// Between arrays that follow one another, so that they do not begin at the same place of a page.
constexpr std::size_t padding = 112;

// The k-th of several arrays of `count` floats in one piece of memory that all rows share, as they run in turn. Each
// array begins on a cache line. The inputs are random, uniform in [0, 1).
const float* input(std::size_t count, std::size_t k = 0);
float* output(std::size_t count, std::size_t k = 0);

// The floors, with the widest vectors of the machine whatever the flags.
void store(float value, float* s, float* t, std::size_t count);
void copy(const float* x, const float* y, const float* z, float* s, float* t, std::size_t count);

// Rows are named "workload, scene > variant".
constexpr const char* separator = " > ";

// How many inputs the rows of a scene take in turn, and how many elements each has.
struct Scene {
    std::string name;
    std::size_t inputs, elements;

    // The elements that are checked: all, or of many every `step`-th.
    std::size_t step() const { return elements <= std::size_t{1} << 16 ? 1 : 1009; }
};

constexpr double promises_nothing = std::numeric_limits<double>::infinity();

// The largest errors of a row, and whether they are within its promise: max(tolerance, 1/2 ulp).
class Errors {
public:
    explicit Errors(double tolerance) : tolerance_(tolerance) {}

    // `slack` is what the promise allows beyond.
    void add(float computed, double exact, double slack = 0) {
        add_texels(computed - exact);
        if (std::fabs(exact) >= 1.0 / report::texture_size) add_ulp(computed, exact);
        check(computed, exact, slack);
    }
    void add_texels(double error) {
        texels_ = std::max(texels_, report::texture_size * report::finite(std::fabs(error)));
    }
    void add_ulp(float computed, double exact) {
        ulp_ = std::max(ulp_, report::finite(report::in_ulp(computed - exact, exact)));
    }
    void check(float computed, double exact, double slack = 0) {
        const double error = report::finite(std::fabs(computed - exact));
        is_kept_ = is_kept_ && (error <= tolerance_ + slack ||
                                report::finite(report::in_ulp(error - slack, exact)) <= report::promised_ulp);
    }

    double texels() const { return texels_; }
    double ulp() const { return ulp_; }
    bool is_kept() const { return is_kept_; }

private:
    double tolerance_;
    double texels_ = 0, ulp_ = 0;
    bool is_kept_ = true;
};

[[noreturn]] inline void fail(const std::string& message) {
    std::fprintf(stderr, "%s\n", message.c_str());
    std::exit(1);
}

// Rows run in random order; their number gives back the order in which they were added.
inline int next_number() {
    static int number = 0;
    return number++;
}

inline void register_row(const std::string& name, auto body) {
    benchmark::RegisterBenchmark(name.c_str(), [body, row = next_number()](benchmark::State& state) mutable {
        body(state);
        state.counters["row"] = row;
    });
}

template <class Run>
void time(benchmark::State& state, const Scene& scene, Run& run) {
    for ([[maybe_unused]] auto _ : state) {
        for (std::size_t i = 0; i < scene.inputs; ++i) {
            run(i);
            benchmark::ClobberMemory();
        }
    }
    state.counters["elements"] = static_cast<double>(scene.inputs * scene.elements);
}

// A row that computes: run(i) puts the results of input i into output(), and check(i, errors) judges them.
template <class Run, class Check>
void add_row(const Scene& scene, const std::string& variant, double tolerance, Run run, Check check) {
    const std::string name = scene.name + separator + variant;
    register_row(name, [=, errors = std::optional<Errors>()](benchmark::State& state) mutable {
        if (!errors) {
            errors.emplace(tolerance);
            for (std::size_t i = 0; i < scene.inputs; ++i) {
                run(i);
                check(i, *errors);
            }
            if (!errors->is_kept())
                fail(name + ": an error of " + std::to_string(errors->texels()) + " texels of 4096, " +
                     std::to_string(errors->ulp()) + " ulp breaks the promise");
        }
        time(state, scene, run);
        state.counters["texels"] = errors->texels();
        state.counters["ulp"] = errors->ulp();
    });
}

// A row without results to judge: a floor, or a set-up.
template <class Run>
void add_unchecked(const Scene& scene, const std::string& variant, Run run) {
    register_row(scene.name + separator + variant, [=](benchmark::State& state) { time(state, scene, run); });
}

// The tolerances that have rows.
struct NamedTolerance {
    const char* name;
    texgen::Tolerance tolerance;
};
inline constexpr NamedTolerance tolerances[] = {{"texgen, exact", texgen::exact},
                                                {"texgen, 1/512 texel of 4096", texgen::texels(1.0 / 512, 4096)},
                                                {"texgen, 1/16 texel of 1024", texgen::texels(1.0 / 16, 1024)},
                                                {"texgen, 1 texel of 256", texgen::texels(1, 256)}};

}  // namespace bench
