// The way from clip coordinates into the window.

#include <doctest/doctest.h>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "api/clip_test/near_planes.hpp"
#include "judges/oracle.hpp"
#include "support/hex.hpp"
#include "support/random.hpp"
#include "texgen/clip.hpp"

namespace clip_cases {

using support::hex;

TEST_CASE("the window: corners of NDC are the viewport's corners, clip_w and the coordinates pass through") {
    const texgen::Viewport viewport{10, 20, 640, 480};
    const glm::vec4 strq(0.1f, 0.2f, 0.3f, 0.4f);
    const auto low = texgen::to_window({{-2, -2, 0, 2}, strq}, viewport);
    const auto high = texgen::to_window({{3, 3, 1, 3}, strq}, viewport);
    CHECK(low.window == glm::vec2(10.0f, 20.0f));
    CHECK(high.window == glm::vec2(650.0f, 500.0f));
    CHECK(low.clip_w == 2.0f);
    CHECK(low.strq == strq);
    CHECK(texgen::to_window({{0, 0, 0, 1}, strq}, viewport).window == glm::vec2(330.0f, 260.0f));
    // A negative height turns the picture over.
    CHECK(texgen::to_window({{1, 1, 0, 1}, strq}, {0, 480, 640, -480}).window == glm::vec2(640.0f, 0.0f));
}

TEST_CASE("the window is within its stated error of the exact division") {
    support::Random random(39);
    int cancelling = 0;
    for (int i = 0; i < 5000; ++i) {
        const double w = random.power_of_ten(-6.0, 6.0);
        const texgen::Viewport viewport{random.integer(-5000, 5000), random.integer(-5000, 5000),
                                        random.integer(1, 16384), random.integer(-16384, -1)};
        // Every other one next to the window's 0, where the ulp is small beside what is added.
        const auto clip_of = [&](double any, int first, int size) {
            return support::to_float(w * (i % 2 == 0 ? any : -(2.0 * first / size + 1.0)));
        };
        const texgen::ClipVertex v{
            {clip_of(random.uniform(-100.0, 100.0), viewport.x, viewport.width),
             clip_of(random.uniform(-1.0, 1.0), viewport.y, viewport.height), 0.0f, support::to_float(w)},
            {0, 0, 0, 1}};
        const auto computed = texgen::to_window(v, viewport);
        const auto check = [&v, &cancelling](float window, float clip, int first, int size) {
            const Rational half(size, 2);
            const Rational offset = half * exactly(clip) / exactly(v.position.w);
            const Rational exact = first + half + offset;
            cancelling += support::magnitude(exact) < support::magnitude(offset) * support::power_of_two(-22);
            const Rational slack =
                exactly(texgen::to_window_error) * (support::magnitude(first + half) + support::magnitude(offset));
            return is_rounded(window, exact, slack);
        };
        REQUIRE_MESSAGE(check(computed.window.x, v.position.x, viewport.x, viewport.width), hex(v.position));
        REQUIRE_MESSAGE(check(computed.window.y, v.position.y, viewport.y, viewport.height), hex(v.position));
    }
    CHECK(cancelling > 3000);
}

}  // namespace clip_cases
