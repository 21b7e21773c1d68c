// The benchmarks' main, their memory, and the floors.

#include "bench.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "../printed.hpp"

#if defined(__GNUC__) && defined(__x86_64__)
#include <immintrin.h>
#endif

namespace bench {

namespace {

constexpr std::size_t line = 64;

// Memory that the system provides when it is first touched.
float* allocate(std::size_t floats) {
    static std::vector<std::unique_ptr<void, decltype(&std::free)>> blocks;
    void* block = std::calloc(floats + line, sizeof(float));
    if (block == nullptr) fail("texgen_bench: out of memory");
    blocks.emplace_back(block, &std::free);
    const auto address = reinterpret_cast<std::uintptr_t>(block);
    return reinterpret_cast<float*>((address + line - 1) / line * line);
}

std::size_t begin_of(std::size_t count, std::size_t k) { return k * (count + padding); }

}  // namespace

const float* input(std::size_t count, std::size_t k) {
    static float* const memory = allocate(3 * (dram_count + padding));
    static std::size_t filled = 0;
    static std::uint64_t state = 1;
    for (const std::size_t end = begin_of(count, k) + count; filled < end; ++filled) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        memory[filled] = static_cast<float>(state >> 40) * 0x1p-24f;
    }
    return memory + begin_of(count, k);
}

float* output(std::size_t count, std::size_t k) {
    static float* const memory = allocate(4 * (dram_count + padding));
    return memory + begin_of(count, k);
}

namespace {

void store_plain(float value, float* s, float* t, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
        s[i] = value;
        t[i] = value;
    }
}

void copy_plain(const float* x, const float* y, const float* z, float* s, float* t, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
        s[i] = x[i];
        t[i] = y[i] + z[i];
    }
}

#if defined(__GNUC__) && defined(__x86_64__)

bool has_avx512() {
    static const bool has = __builtin_cpu_supports("avx512f");
    return has;
}

[[gnu::target("avx512f")]] void store_avx512(float value, float* s, float* t, std::size_t count) {
    const __m512 values = _mm512_set1_ps(value);
    for (std::size_t i = 0; i < count; i += 16) {
        _mm512_storeu_ps(s + i, values);
        _mm512_storeu_ps(t + i, values);
    }
}

[[gnu::target("avx512f")]] void copy_avx512(const float* x, const float* y, const float* z, float* s, float* t,
                                            std::size_t count) {
    for (std::size_t i = 0; i < count; i += 16) {
        _mm512_storeu_ps(s + i, _mm512_loadu_ps(x + i));
        _mm512_storeu_ps(t + i, _mm512_add_ps(_mm512_loadu_ps(y + i), _mm512_loadu_ps(z + i)));
    }
}

#else

bool has_avx512() { return false; }
constexpr auto store_avx512 = store_plain;
constexpr auto copy_avx512 = copy_plain;

#endif

// One line a row, in the order in which they were added; the file that --benchmark_out names has everything.
class Reporter : public benchmark::BenchmarkReporter {
public:
    bool ReportContext(const Context&) override { return true; }

    void ReportRuns(const std::vector<Run>& runs) override {
        for (const Run& run : runs)
            if (run.aggregate_name == "median") medians_.push_back(run);
    }

    void Finalize() override {
        std::ranges::sort(medians_, {}, [](const Run& run) { return counter(run, "row"); });
        for (const Run& run : medians_)
            std::printf("%-75s %8.3f ns %10.3g texels %10.3g ulp\n", run.run_name.function_name.c_str(),
                        run.GetAdjustedCPUTime() / counter(run, "elements"), counter(run, "texels"),
                        counter(run, "ulp"));
    }

private:
    static double counter(const Run& run, const char* name) {
        const auto found = run.counters.find(name);
        return found == run.counters.end() ? 0.0 : static_cast<double>(found->second);
    }

    std::vector<Run> medians_;
};

}  // namespace

void store(float value, float* s, float* t, std::size_t count) {
    (has_avx512() && count % 16 == 0 ? store_avx512 : store_plain)(value, s, t, count);
}

void copy(const float* x, const float* y, const float* z, float* s, float* t, std::size_t count) {
    (has_avx512() && count % 16 == 0 ? copy_avx512 : copy_plain)(x, y, z, s, t, count);
}

}  // namespace bench

int main(int count, char** arguments) {
    // What the user gives comes later, and counts.
    std::array defaults{std::string("--benchmark_repetitions=7"), std::string("--benchmark_min_time=0.01"),
                        std::string("--benchmark_enable_random_interleaving=true"),
                        std::string("--benchmark_report_aggregates_only=true")};
    std::vector<char*> all{arguments[0]};
    for (std::string& option : defaults) all.push_back(option.data());
    all.insert(all.end(), arguments + 1, arguments + count);
    int all_count = static_cast<int>(all.size());
    all.push_back(nullptr);

    benchmark::AddCustomContext("compiler", TEXGEN_REPORT_COMPILER);
    benchmark::AddCustomContext("flags", TEXGEN_REPORT_FLAGS);
    benchmark::Initialize(&all_count, all.data());
    if (benchmark::ReportUnrecognizedArguments(all_count, all.data())) return 2;
#ifdef TEXGEN_BENCH_ROWS_ALONE
    bench::add_rows();
#else
    bench::add_matrices();
    bench::add_generate();
    bench::add_project();
    bench::add_segment();
    bench::add_rows();
    bench::add_visibility();
    bench::add_depth();
    bench::add_coverage();
    bench::add_scenes();
    bench::add_footprints();
#endif
    bench::Reporter reporter;
    const bool has_run = benchmark::RunSpecifiedBenchmarks(&reporter) != 0;
    if (has_run && is_printed()) return 0;
    std::fprintf(stderr, "texgen_bench: %s\n", has_run ? "cannot write to standard output" : "no row has such a name");
    return 2;
}
