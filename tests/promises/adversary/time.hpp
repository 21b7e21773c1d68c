#pragma once

// What is above its limit of time, again and again.

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <list>
#include <string_view>
#include <vector>

#include "promises/adversary/climbs.hpp"
#include "support/limits.hpp"
#include "support/race.hpp"
#include "support/workloads.hpp"

namespace adversary {

// What is above its limit once has to be so again and again, and by more than noise.
inline bool is_above_limit(const support::Workload& workload, const support::SlowInput& input) {
    const double limit = support::limit::noise * input.limit;
    if (!(input.slowness.ratio() > limit)) return false;
    std::list<support::Race> races;  // all are kept, so that the arrays of each begin elsewhere
    for (int attempt = 0; attempt < 5; ++attempt)
        if (!(races.emplace_back(workload).measure(input.numbers, 40).ratio() > limit)) return false;
    return true;
}

inline bool near_cuts_keep_limits(const support::Workload& workload) {
    for (int attempt = 0;; ++attempt) {
        const support::NearCutTimes times = support::race_near_cuts(workload, 40);
        const bool kept = times.slowest.ratio() <= support::limit::near_plane &&
                          times.of_99_in_100.ratio() <= support::limit::near_plane_99_of_100 &&
                          times.rotation.ratio() <= support::limit::rotation &&
                          times.crossed.ratio() <= support::limit::q_is_zero;
        if (!kept && attempt < 2) continue;
        std::printf(
            "%s cut by the near plane: %.1f at most (%g), %.1f for 99 of 100 (%g), %.1f between rotations (%g), %.1f "
            "where q = 0 "
            "crosses (%g)\n",
            workload.function, times.slowest.ratio(), support::limit::near_plane, times.of_99_in_100.ratio(),
            support::limit::near_plane_99_of_100, times.rotation.ratio(), support::limit::rotation,
            times.crossed.ratio(), support::limit::q_is_zero);
        return kept;
    }
}

inline bool is_one_of(std::string_view name, std::string_view names) {
    while (!names.empty()) {
        const std::string_view first = names.substr(0, names.find('|'));
        if (name == first) return true;
        names.remove_prefix(std::min(names.size(), first.size() + 1));
    }
    return false;
}

inline bool search_towards_time(double seconds, std::uint64_t seed, std::string_view only, std::string_view excepted) {
    const auto is_asked_for = [&](const support::Workload& workload) {
        return std::string_view(workload.function).find(only) != std::string_view::npos;
    };
    std::ifstream file(TEXGEN_TEST_DATA "/promises/worst_inputs.txt");
    const std::vector<support::RecordedInput> recorded = support::read_inputs(file);
    const auto count = std::count_if(support::workloads.begin(), support::workloads.end(), is_asked_for);
    bool all_kept = true;
    for (const support::Workload& workload : support::workloads) {
        if (!is_asked_for(workload)) continue;
        const bool is_excepted = is_one_of(workload.function, excepted);
        if (workload.takes_near_cuts() && !near_cuts_keep_limits(workload) && !is_excepted) all_kept = false;
        for (const support::SlowInput& input : search(workload, recorded, seconds / static_cast<double>(count), seed)) {
            const bool is_above = is_above_limit(workload, input);
            all_kept = all_kept && (is_excepted || !is_above);
            const char* verdict = is_above ? is_excepted ? "EXCEPTED," : "BROKEN," : "kept,";
            std::printf("%s %.1f times the ordinary %.1f ns, limit %g: %s | %s |", verdict, input.slowness.ratio(),
                        input.slowness.ordinary, input.limit, workload.function, input.words.c_str());
            for (const double number : input.numbers) std::printf(" %a", number);
            std::printf("\n");
            std::fflush(stdout);
        }
    }
    return all_kept;
}

}  // namespace adversary
