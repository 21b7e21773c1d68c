#pragma once

// The climbs: towards the largest share of a bound, and towards the inputs that a function takes longest for.

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "promises/adversary/inputs.hpp"
#include "promises/adversary/shares.hpp"
#include "support/hard_triangles.hpp"
#include "support/race.hpp"
#include "support/random.hpp"
#include "support/workloads.hpp"
#include "support/workloads/numbers.hpp"
#include "support/workloads/triangles.hpp"

namespace adversary {

struct Find {
    Share share = says_nothing;
    Numbers numbers;
    long tried = 0;
};

// Climbs from many beginnings, and back to the best of them now and then; gives up a climb that stands still.
inline Find search(const Promise& promise, double seconds, std::uint64_t seed) {
    using Clock = std::chrono::steady_clock;
    const auto end = Clock::now() + std::chrono::duration<double>(seconds);
    Random random(seed);
    Find best;
    do {
        Numbers here = best.share >= 0.0 && random.integer(0, 3) == 0 ? best.numbers : promise.begin(random);
        Share share = promise.share(here);
        for (int idle = 0; idle < 400 && !(share > 1.0) && Clock::now() < end; ++idle) {
            const Numbers next = moved(promise.floats, here, random);
            if (!all_finite(next)) continue;
            const Share of_next = promise.share(next);
            ++best.tried;
            if (!(of_next >= share)) continue;
            if (of_next > share) idle = 0;
            here = next;
            share = of_next;
        }
        if (share > best.share) {
            best.share = share;
            best.numbers = here;
        }
    } while (!(best.share > 1.0) && Clock::now() < end);
    return best;
}

// Where a climb begins: the hard families of triangles serve as well.
inline Numbers begin(const support::Workload& workload, Random& random) {
    if (workload.inputs.draw != support::detail::draw_triangle || random.coin()) return workload.inputs.draw(random);
    const auto last = static_cast<int>(support::hard_families.size()) - 1;
    const support::Shot shot = support::hard_families[static_cast<std::size_t>(random.integer(0, last))].make(random);
    return support::detail::numbers(shot.triangle, static_cast<float>(shot.rect.x), static_cast<float>(shot.rect.y));
}

// Looks at the recorded inputs, and for some seconds climbs from the slowest of some beginnings, or from the slowest
// input so far.
inline std::vector<support::SlowInput> search(const support::Workload& workload,
                                              const std::vector<support::RecordedInput>& recorded, double seconds,
                                              std::uint64_t seed) {
    using Clock = std::chrono::steady_clock;
    Random random(seed);
    const support::Race race(workload);
    support::Slowest slowest(workload, race);
    const auto look = [&](const Numbers& numbers, const std::string& words = "found by a search") {
        const double ratio = race.glance(numbers);
        slowest.offer(numbers, ratio, words);
        return ratio;
    };
    for (const support::RecordedInput& input : recorded)
        if (input.function == workload.function) look(input.numbers, input.words);
    const auto end = Clock::now() + std::chrono::duration<double>(seconds);
    while (Clock::now() < end) {
        Numbers here = begin(workload, random);
        double ratio = look(here);
        for (int i = 0; i < 8 && Clock::now() < end; ++i) {
            const auto known = static_cast<int>(slowest.inputs().size());
            const Numbers other =
                known == 0 || random.integer(0, 15) != 0
                    ? begin(workload, random)
                    : slowest.inputs()[static_cast<std::size_t>(random.integer(0, known - 1))].numbers;
            const double of_other = look(other);
            if (of_other <= ratio) continue;
            here = other;
            ratio = of_other;
        }
        for (int idle = 0; idle < 100 && Clock::now() < end; ++idle) {
            const Numbers next = moved(workload.inputs.floats, here, random);
            const double of_next = look(next);
            if (of_next < 0.98 * ratio) continue;
            if (of_next > 1.02 * ratio) idle = 0;
            here = next;
            ratio = std::max(ratio, of_next);
        }
    }
    return slowest.inputs();
}

}  // namespace adversary
