// Programs that trap invalid operations, divisions by zero and overflow, as debug builds of games do, may call every
// function: with what a scene gives it none of these is raised, not even by lanes that hold nothing.

#include <doctest/doctest.h>

#include <cfenv>
#include <cstddef>
#include <string>

#include "support/random.hpp"
#include "support/stopwatch.hpp"
#include "support/workloads.hpp"

TEST_CASE("no function raises an exception of floating point but underflow and inexact for an ordinary input") {
    constexpr int trapped = FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW;
    std::size_t asked = 0;
    for (const support::Workload& workload : support::workloads) {
        CAPTURE(std::string(workload.function));
        support::Random random(8100);
        for (int i = 0; i < 20; ++i) {
            const support::Calls calls = workload.calls(workload.ordinary(random));
            if (!calls) continue;
            ++asked;
            std::feclearexcept(FE_ALL_EXCEPT);
            calls(1);
            REQUIRE(std::fetestexcept(trapped) == 0);
        }
    }
    CHECK(asked > 2000);
}
