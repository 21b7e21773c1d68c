#include "compare.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <ctime>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <texgen/batch.hpp>
#include <texgen/interpolate.hpp>

#include "../error.hpp"
#include "../peers.hpp"
#include "compare/checks.hpp"

namespace report {

namespace {

using checks::accepted_texels;
using checks::check_promise;
using checks::Collector;
using checks::Exact;
using checks::exact_at;
using checks::is_one_signed;
using checks::RectCheck;

constexpr int largest_triangle_side = 64;

using Rects = std::span<const texgen::FragmentRect>;

void texgen_within(texgen::Tolerance tolerance, const texgen::Triangle& triangle, const texgen::TextureRegion& region,
                   Rects rects, RectCoordinates& out) {
    const auto setup = texgen::TriangleSetup::of(triangle, region, tolerance);
    if (!setup) return out.lit.fill(0.0f);
    for (const texgen::FragmentRect& rect : rects) texgen::interpolate(*setup, rect, out.of(rect));
}

void texgen_exact(const texgen::Triangle& triangle, const texgen::TextureRegion& region, Rects rects,
                  RectCoordinates& out) {
    texgen_within(texgen::exact, triangle, region, rects, out);
}

void texgen_accepted(const texgen::Triangle& triangle, const texgen::TextureRegion& region, Rects rects,
                     RectCoordinates& out) {
    texgen_within(texgen::texels(accepted_texels, texture_size), triangle, region, rects, out);
}

struct FloatRegion {
    float s_min, s_max, t_min, t_max;

    explicit FloatRegion(const texgen::TextureRegion& region)
        : s_min(static_cast<float>(region.min().x)),
          s_max(static_cast<float>(region.max().x)),
          t_min(static_cast<float>(region.min().y)),
          t_max(static_cast<float>(region.max().y)) {}
};

// What it costs to leave no rect out for lying beyond a side of the region: a region without sides, and the mask
// compared here. What is behind is still left out.
void texgen_sides_not_skipped(const texgen::Triangle& triangle, const texgen::TextureRegion& region, Rects rects,
                              RectCoordinates& out) {
    constexpr double far_away = std::numeric_limits<float>::max();
    const FloatRegion bounds(region);
    texgen::TextureRegion everywhere = texgen::atlas_tile({-far_away, -far_away}, {far_away, far_away});
    if (const auto depth = region.depth()) everywhere = everywhere.with_depth(depth->x, depth->y);
    const auto setup = texgen::TriangleSetup::of(triangle, everywhere);
    if (!setup) return out.lit.fill(0.0f);
    for (const texgen::FragmentRect& rect : rects) {
        const texgen::Texcoords of_rect = out.of(rect);
        if (texgen::interpolate(*setup, rect, of_rect) == texgen::Work::nothing) continue;
        for (std::size_t i = 0; i < of_rect.lit.size(); ++i) {
            const float s = of_rect.s[i], t = of_rect.t[i];
            const bool is_inside =
                (s >= bounds.s_min) & (s <= bounds.s_max) & (t >= bounds.t_min) & (t <= bounds.t_max);
            of_rect.lit[i] = is_inside ? of_rect.lit[i] : 0.0f;
        }
    }
}

template <class Peer>
void glm_loop(const texgen::Triangle& triangle, const texgen::TextureRegion& region, Rects rects,
              RectCoordinates& out) {
    const FloatRegion bounds(region);
    const Peer peer(triangle);
    for (const texgen::FragmentRect& rect : rects) {
        peer(rect, [&](std::size_t fragment, float s, float t, float q) {
            out.s[fragment] = s;
            out.t[fragment] = t;
            // Without branches, so that the compiler can make vectors of the loop.
            const bool is_lit =
                (q > 0.0f) & (s >= bounds.s_min) & (s <= bounds.s_max) & (t >= bounds.t_min) & (t <= bounds.t_max);
            out.lit[fragment] = is_lit ? 1.0f : 0.0f;
        });
    }
}

void eigen_planes(const texgen::Triangle& triangle, const texgen::TextureRegion& region, Rects rects,
                  RectCoordinates& out) {
    using Planes = EigenPlanes<Workload::rect_width>;
    const FloatRegion bounds(region);
    const Planes planes(triangle);
    for (const texgen::FragmentRect& rect : rects) {
        planes(rect, out.s.data(), out.t.data(), [&](Eigen::Index offset, const auto& s, const auto& t, const auto& q) {
            Eigen::Map<Planes::Row>(out.lit.data() + offset, rect.width) =
                (q > 0.0f && s >= bounds.s_min && s <= bounds.s_max && t >= bounds.t_min && t <= bounds.t_max)
                    .template cast<float>();
        });
    }
}

struct Method {
    const char* name;
    void (*run)(const texgen::Triangle&, const texgen::TextureRegion&, Rects, RectCoordinates&);

    // The others know no depth.
    bool is_library() const { return std::string_view(name).starts_with("texgen"); }
};

constexpr std::array<Method, 6> methods{{{"texgen, exact", texgen_exact},
                                         {"texgen, 1/512 texel", texgen_accepted},
                                         {"texgen, sides not skipped", texgen_sides_not_skipped},
                                         {"GLM, barycentric", glm_loop<GlmBarycentric>},
                                         {"GLM, plane equations", glm_loop<GlmPlanes>},
                                         {"Eigen, plane equations", eigen_planes}}};

void measure_errors(Comparison& comparison, const Workload& work, const texgen::TextureRegion& region) {
    std::vector<Collector> collectors;
    for (const Method& method : methods) collectors.emplace_back(method.is_library());
    std::array<Exact, Workload::rect_area> exact{};
    RectCoordinates coordinates{};
    for (const Workload::Job& job : work.jobs) {
        const texgen::Triangle& triangle = work.triangles[job.triangle].window;
        const auto setup = texgen::TriangleSetup::of(triangle, region);
        for (std::size_t r = job.first_rect; r < job.first_rect + job.rect_count; ++r) {
            const texgen::FragmentRect& rect = work.rects[r];
            const RectCheck check{rect, work.coverage[r]};
            check.for_each([&](std::size_t i, int x, int y) {
                exact[i] = exact_at(triangle, region, x, y);
                ++comparison.covered_fragments;
            });
            for (std::size_t m = 0; m < methods.size(); ++m) {
                methods[m].run(triangle, region, std::span(&rect, 1), coordinates);
                check.for_each([&](std::size_t i, int x, int y) {
                    collectors[m].add(exact[i], coordinates.s[i], coordinates.t[i], coordinates.lit[i] != 0.0f,
                                      {triangle, x, y});
                });
            }
            if (!setup) continue;
            const texgen::Work done = texgen::interpolate(*setup, rect, coordinates.with_r(rect));
            comparison.fragments_of_work[static_cast<std::size_t>(done)] += coordinates.of(rect).s.size();
            if (done != texgen::Work::nothing && is_one_signed(triangle))
                check_promise(comparison, triangle, check, exact, coordinates);
        }
    }
    for (std::size_t m = 0; m < methods.size(); ++m)
        comparison.measurements.push_back({methods[m].name, 0.0, collectors[m].finish()});
}

using Run = std::function<void()>;

// Time of the processor, which other programs do not slow down by taking turns with this one.
double seconds_for(const Run& run, int passes) {
    const std::clock_t start = std::clock();
    for (int pass = 0; pass < passes; ++pass) run();
    return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC / passes;
}

// So many that one measurement takes a millisecond, the clock's step being a microsecond.
int passes_for(const Run& run) {
    constexpr double enough_seconds = 1e-3;
    int passes = 1;
    while (passes < 1024 && passes * seconds_for(run, passes) < enough_seconds) passes *= 2;
    return passes;
}

// Seconds a run. They take turns, so that a change of the machine's speed meets all of them; the median of the rounds
// counts.
std::vector<double> medians_of(const std::vector<Run>& runs, int most_rounds, double enough_seconds) {
    constexpr int fewest_rounds = 5;
    std::vector<int> passes;
    for (const Run& run : runs) passes.push_back(passes_for(run));
    std::vector<std::vector<double>> seconds(runs.size());
    double total = 0;
    for (int round = 0; round < most_rounds && (round < fewest_rounds || total < enough_seconds); ++round) {
        for (std::size_t turn = 0; turn < runs.size(); ++turn) {
            const std::size_t i = (turn + static_cast<std::size_t>(round)) % runs.size();
            seconds[i].push_back(seconds_for(runs[i], passes[i]));
            total += passes[i] * seconds[i].back();
        }
    }
    std::vector<double> medians;
    for (std::vector<double>& of_run : seconds) {
        const auto middle = of_run.begin() + static_cast<std::ptrdiff_t>(of_run.size() / 2);
        std::nth_element(of_run.begin(), middle, of_run.end());
        medians.push_back(*middle);
    }
    return medians;
}

std::vector<Run> runs_of(const Workload& work, const texgen::TextureRegion& region) {
    static RectCoordinates coordinates;
    std::vector<Run> runs;
    for (const Method& method : methods)
        runs.emplace_back([&work, &region, &method] {
            for (const Workload::Job& job : work.jobs)
                method.run(work.triangles[job.triangle].window, region, work.rects_of(job), coordinates);
        });
    return runs;
}

// The triangles of the work at once, each with one rectangle.
Run batch_of(const Workload& work, int side, texgen::Tolerance tolerance) {
    struct Batch {
        texgen::TriangleBatch setups;
        std::vector<texgen::Triangle> triangles;
        std::vector<texgen::FragmentRect> rects;
        std::vector<float> s, t, lit;
    };
    const auto batch =
        std::make_shared<Batch>(Batch{texgen::TriangleBatch(texgen::whole_texture(), tolerance), {}, {}, {}, {}, {}});
    for (const Workload::Job& job : work.jobs) {
        const texgen::FragmentRect& first = work.rects[job.first_rect];
        batch->triangles.push_back(work.triangles[job.triangle].window);
        batch->rects.push_back({first.x, first.y, side, side});
    }
    for (std::vector<float>* out : {&batch->s, &batch->t, &batch->lit})
        out->resize(batch->rects.size() * static_cast<std::size_t>(side * side));
    return [batch] {
        batch->setups.assign(batch->triangles);
        texgen::interpolate(batch->setups, batch->rects, {.s = batch->s, .t = batch->t, .r = {}, .lit = batch->lit});
    };
}

}  // namespace

std::string in_hexadecimal(const Witness& witness) {
    const auto& [triangle, x, y] = witness;
    std::string text = "fragment (" + std::to_string(x) + ", " + std::to_string(y) + ")";
    const auto append = [&text](const char* name, const texgen::WindowVertex& v) {
        std::array<char, 256> line;
        std::snprintf(line.data(), line.size(), "; %s: window %a %a, w %a, strq %a %a %a %a", name,
                      static_cast<double>(v.window.x), static_cast<double>(v.window.y), static_cast<double>(v.clip_w),
                      static_cast<double>(v.strq.x), static_cast<double>(v.strq.y), static_cast<double>(v.strq.z),
                      static_cast<double>(v.strq.w));
        text += line.data();
    };
    append("a", triangle.a);
    append("b", triangle.b);
    append("c", triangle.c);
    return text;
}

bool Comparison::is_as_promised() const {
    const Errors& exact = measurements[0].errors;
    const Errors& accepted = measurements[1].errors;
    return largest_ulp <= promised_ulp && exact.wrong_decisions == 0 && accepted.wrong_decisions == 0 &&
           accepted.max_texels <= accepted_texels;
}

Comparison compare(const Workload& work, const texgen::TextureRegion& region, int rounds) {
    Comparison comparison;
    comparison.evaluated_fragments = work.evaluated_fragments();
    measure_errors(comparison, work, region);
    const std::vector<double> seconds = medians_of(runs_of(work, region), rounds, 0.8);
    for (std::size_t m = 0; m < methods.size(); ++m)
        comparison.measurements[m].nanoseconds = 1e9 * seconds[m] / static_cast<double>(comparison.evaluated_fragments);
    return comparison;
}

std::vector<Series> times_by_size(int rounds) {
    std::vector<Series> series;
    for (const Method& method : methods) series.push_back({method.name, Series::Mark::line, {}});
    const texgen::Tolerance accepted = texgen::texels(accepted_texels, texture_size);
    series.push_back({"texgen, exact, in a batch", Series::Mark::dashes, {}});
    series.push_back({"texgen, 1/512 texel, in a batch", Series::Mark::dashes, {}});
    const texgen::TextureRegion region = texgen::whole_texture();
    for (int side = 1; side <= largest_triangle_side; side *= 2) {
        constexpr int count = 64;
        Workload work;
        for (int i = 0; i < count; ++i) work.add_right_triangle(37 * i % 512, side);
        std::vector<Run> runs = runs_of(work, region);
        runs.push_back(batch_of(work, side, texgen::exact));
        runs.push_back(batch_of(work, side, accepted));
        const std::vector<double> seconds = medians_of(runs, rounds, 0.1);
        for (std::size_t i = 0; i < runs.size(); ++i)
            series[i].points.emplace_back(side * side, 1e9 * seconds[i] / count);
    }
    std::erase_if(series, [](const Series& s) { return s.name.ends_with("not skipped"); });
    return series;
}

std::optional<double> overtakes_at(const Series& ours, const Series& theirs) {
    for (std::size_t i = ours.points.size(); i-- > 0;) {
        const double lead = std::log(theirs.points[i].y / ours.points[i].y);
        if (lead >= 0) continue;
        if (i + 1 == ours.points.size()) return std::nullopt;
        // Straight lines between the points, as the chart has them.
        const double next = std::log(theirs.points[i + 1].y / ours.points[i + 1].y);
        return ours.points[i].x * std::pow(ours.points[i + 1].x / ours.points[i].x, lead / (lead - next));
    }
    return 0.0;
}

}  // namespace report
