#pragma once

// Points and segments on which one double does not suffice: exact ties, cancelling sums, numbers that are none. What
// they cost beside ordinary ones, and what becomes of them, are tests of their own.

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "judges/oracle.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"
#include "texgen/primitives.hpp"

namespace support {

struct Cloud {
    std::string name;
    glm::dmat4 matrix;
    std::vector<glm::vec3> points;
};

inline glm::dmat4 matrix_of_rows(const glm::dvec4& s, const glm::dvec4& t, const glm::dvec4& r, const glm::dvec4& q) {
    return glm::transpose(glm::dmat4(s, t, r, q));
}

// A perspective projector, and points in front of it.
inline Cloud ordinary_cloud(std::size_t count, Random& random) {
    Cloud cloud{
        "ordinary",
        matrix_of_rows({1.2, 0.1, -0.5, 0.3}, {-0.1, 1.3, -0.5, 0.2}, {0.0, 0.0, -1.01, -0.2}, {0.01, 0.02, -1.0, 0.5}),
        {}};
    for (std::size_t i = 0; i < count; ++i)
        cloud.points.push_back(
            {random.uniform_float(-3.0, 3.0), random.uniform_float(-3.0, 3.0), random.uniform_float(-9.0, -2.0)});
    return cloud;
}

// Whose sums have terms of many sizes: s and t are middles of floats times q everywhere; or multiples of a q of which
// only the least term is left; or middles but for a term far below what cancels beside them.
inline std::vector<Cloud> clouds_of_long_sums(std::size_t count, Random& random) {
    const auto multiples_of = [](const glm::dvec4& q, double s, double t) {
        return matrix_of_rows(s * q, t * q, (s + 1.0) * q, q);
    };
    const glm::dvec4 long_row(0x1.8b3a6p-1, -0x1.2c5f4ep-1, 0x1.d10932p-1, 0x1.46a1cp+0);
    const glm::dvec4 cancelling_row(0x1.999999999999p-4, 0x1p-60, -0x1.999999999999p-4, 0.0);
    std::vector<Cloud> clouds{
        {"long ties", multiples_of(long_row, 16.0 + 0x1p-20, 0x3p-20 - 16.0), {}},
        {"all but the least term cancels", multiples_of(cancelling_row, 3.0, 5.0), {}},
        {"ties but for what sums of sums lose",
         matrix_of_rows({0x1p-60, 0x1p-123, -0x1p-60, 1.0 + 0x1p-24},
                        {0.1 * 0x1p-60, -0x1p-125, -0.1 * 0x1p-60, 1.0 + 0x1p-24},
                        {0.1 * 0x1p-55, 0.1 * 0x1p-123, -0.1 * 0x1p-55, 0x1p-24 - 1.0}, {0.0, 0.0, 0.0, 1.0}),
         {}}};
    const auto of_any_size = [&] { return std::ldexp(random.uniform_float(1.0, 2.0), random.integer(-18, 17)); };
    for (std::size_t i = 0; i < count; ++i) {
        clouds[0].points.push_back({of_any_size(), -of_any_size(), of_any_size()});
        const float x = random.uniform_float(1.0, 2.0);
        clouds[1].points.push_back({x, std::ldexp(x, -50), x});
        clouds[2].points.push_back({x, random.uniform_float(1.0, 2.0), x});
    }
    return clouds;
}

inline std::vector<Cloud> doubtful_clouds(std::size_t count, Random& random) {
    const Cloud ordinary = ordinary_cloud(count, random);
    const glm::dmat4 orthographic =
        matrix_of_rows({0.125, 0.0, 0.0, 0.5}, {0.0, 0.125, 0.0, 0.5}, {0.0, 0.0, -0.125, 0.5}, {0.0, 0.0, 0.0, 1.0});
    const glm::dmat4 divided =
        matrix_of_rows({0.125, 0.0, 0.0, 0.5}, {0.0, 0.125, 0.0, 0.5}, {0.0, 0.0, 0.0, 1.0}, {0.0, 0.0, 1.0, 0.0});
    const double tenth = 0.1;  // no number of few bits
    std::vector<Cloud> clouds;
    const auto add = [&](const char* name, const glm::dmat4& matrix, const auto& point) {
        Cloud cloud{name, matrix, {}};
        for (std::size_t i = 0; i < count; ++i) cloud.points.push_back(point());
        clouds.push_back(cloud);
    };
    const auto within = [&](double size) { return [&random, size] { return random.vector3(size); }; };
    // x/8 + 1/2 is a tie where x has more bits below the last one of the sum than a float, and these end in a one.
    const auto odd = [&](int exponent) {
        return std::ldexp(static_cast<float>(2 * random.integer(1 << 22, (1 << 23) - 1) + 1), exponent);
    };
    const auto tied = [&] { return glm::vec3(odd(-23), -odd(-23), std::ldexp(1.0f, random.integer(-3, 3))); };
    add("ties under an orthographic lens of half extent 4", orthographic, within(4.0));
    add("a tie in each point", orthographic, tied);
    add("ties, and a factor that no float has", tenth * orthographic, tied);
    add("ties of quotients", divided, tied);
    add("ties of quotients, and a factor", tenth * divided, tied);
    add("ties beyond the texture", orthographic, [&] { return glm::vec3(odd(-10), odd(-9), odd(-20)); });
    add("next to ties",
        matrix_of_rows({1.0, 0x1p-24, 0.0, 0.0}, {1.0, 0.0, 0x1p-24, 0.0}, {1.0, 0x1p-24, 0.0, 0.0},
                       {0.0, 0.0, 0.0, 1.0}),
        [&] {
            return glm::vec3(random.uniform_float(1.0, 2.0), 1.0f, std::nextafter(1.0f, random.coin() ? 2.0f : 0.0f));
        });
    // By decimals of few digits, that no float has: many sums are next to ties, and few on one.
    add("a turned decal of half extent 10",
        matrix_of_rows({0.04, 0.03, 0.0, 0.5}, {-0.03, 0.04, 0.0, 0.5}, {0.0, 0.0, 0.05, 0.5}, {0.0, 0.0, 0.0, 1.0}),
        within(10.0));
    // What the leading sums lose cancels, or all but a little of it.
    add("ties of sums that lose what cancels",
        matrix_of_rows({1.0, 0x1p-60, -0x1p-60, 0x1p-24}, {1.0, tenth * 0x1p-50, tenth * -0x1p-50, -0x1p-24},
                       {-1.0, 0x1p-30, -0x1p-30, -0x1p-24}, {0.0, 0.0, 0.0, 1.0}),
        [&] {
            const float y = random.uniform_float(1.0, 2.0);
            return glm::vec3(random.uniform_float(1.0, 2.0), y,
                             random.coin() ? y : std::nextafter(y, random.coin() ? 4.0f : 0.0f));
        });
    add("ties but for tiny products",
        matrix_of_rows({1.0, 0x1p-780, 0.0, 0x1p-24}, {1.0, -0x1p-780, 0.0, 0x1p-24}, {1.0, 0.0, 0.0, 0x1p-24},
                       {0.0, 0.0, 0.0, 1.0}),
        [&] { return glm::vec3(random.uniform_float(1.0, 2.0), 0x1p-100f, 0.0f); });
    add("next to q = 0", ordinary.matrix, [&] {
        const float x = random.uniform_float(-3.0, 3.0), y = random.uniform_float(-3.0, 3.0);
        return glm::vec3(x, y, to_float(0.01 * static_cast<double>(x) + 0.02 * static_cast<double>(y) + 0.5));
    });
    add("on q = 0",
        matrix_of_rows({1.0, 0.0, 0.0, 0.0}, {0.0, 1.0, 0.0, 0.0}, {0.0, 0.0, 1.0, 0.0}, {1.0, 2.0, 3.0, -4.0}), [&] {
            const auto y = static_cast<float>(random.integer(0, 100)), z = static_cast<float>(random.integer(0, 100));
            return glm::vec3(4.0f - 2.0f * y - 3.0f * z, y, z);
        });
    add("on both sides of q = 0", ordinary.matrix, within(9.0));
    add("at the origin", ordinary.matrix, within(0.0));
    add("s and t are 0",
        matrix_of_rows({1.1, 0.3, -0.7, 0.0}, {1.1, 0.3, -0.7, 0.0}, {1.1, 0.3, -0.7, 0.0}, {0.0, 0.0, 0.0, 1.0}),
        within(0.0));
    add("s and t cancel",
        matrix_of_rows({0.1, -0.1, 0.0, 0.0}, {0.1, -0.1, 0x1p-90, 0.0}, {0.0, 0.0, 0.0, 1.0}, {0.0, 0.0, 0.3, 7.0}),
        [&] {
            const float x = random.uniform_float(-3.0, 3.0);
            return glm::vec3(x, x, random.uniform_float(1.0, 2.0));
        });
    add("q cancels",
        matrix_of_rows({0.1, 0.2, 0.0, 0.0}, {0.3, -0.1, 0.0, 0.0}, {0.0, 0.0, 0.0, 1.0}, {0.1e20, -0.1e20, 0.3, -0.7}),
        [&] {
            const float x = random.uniform_float(-3.0, 3.0);
            return glm::vec3(x, x, random.uniform_float(-9.0, 9.0));
        });
    add("subnormal", orthographic, within(0x1p-130));
    add("subnormal results",
        matrix_of_rows({0.3, 0.1, 0.0, 0.0}, {0.1, 0.5, 0.0, 0.0}, {0.0, 0.0, 0.0, 0.0}, {0.0, 0.0, 0.0, 1.0}),
        within(0x1p-140));
    add("huge", ordinary.matrix, within(0x1p126));
    add("a matrix of large numbers", 0x1p300 * ordinary.matrix, within(9.0));
    add("a matrix of small numbers", tenth * 0x1p-300 * divided, tied);

    const auto spoil = [&](const char* name, const std::vector<glm::vec3>& points, const glm::dmat4& matrix,
                           std::size_t every, const glm::vec3& with) {
        Cloud cloud{name, matrix, points};
        for (std::size_t i = 0; i < count; ++i)
            if (i % every == every / 2) cloud.points[i] = with;
        clouds.push_back(cloud);
    };
    const std::vector<glm::vec3> ties = clouds[1].points;
    spoil("every second one NaN", ordinary.points, ordinary.matrix, 2, glm::vec3(nan_float));
    spoil("every 64th one NaN", ordinary.points, ordinary.matrix, 64, {0.0f, nan_float, 0.0f});
    spoil("all infinite", ordinary.points, ordinary.matrix, 1, glm::vec3(0.0f, 0.0f, infinity_float));
    spoil("every second one infinite", ordinary.points, ordinary.matrix, 2, {-infinity_float, infinity_float, 0.0f});
    spoil("every 64th one infinite, the rest ties", ties, orthographic, 64, {infinity_float, 0.0f, 0.0f});
    spoil("every 64th one far away", ordinary.points, ordinary.matrix, 64, {1e30f, 0.0f, 0.0f});
    spoil("every second one far away", ordinary.points, ordinary.matrix, 2, {1e30f, -1e30f, 1.0f});
    spoil("every 64th one on q = 0", ordinary.points,
          matrix_of_rows({1.2, 0.1, -0.5, 0.3}, {-0.1, 1.3, -0.5, 0.2}, {0.0, 0.0, -1.0, -0.2}, {0.0, 0.0, -1.0, 0.0}),
          64, {1.0f, 2.0f, 0.0f});

    for (const float bad : {nan_float, infinity_float}) {
        for (const int row : {0, 3}) {
            Cloud cloud = clouds[1];
            cloud.name = std::string(row == 0 ? "s" : "q") + (bad == infinity_float ? " is infinite" : " is NaN");
            cloud.matrix[row == 0 ? 0 : 3][row] = static_cast<double>(bad);
            clouds.push_back(cloud);
            cloud.name += ", next to q = 0";
            cloud.points = clouds[7].points;
            cloud.matrix = clouds[7].matrix;
            cloud.matrix[0][row] = static_cast<double>(bad);
            clouds.push_back(cloud);
        }
    }
    return clouds;
}

struct Stretch {
    std::string name;
    texgen::Segment segment;
    std::vector<float> alpha;
};

inline Stretch ordinary_stretch(std::size_t count, Random& random) {
    Stretch stretch{"ordinary", {{0.1f, 0.7f, 0.3f, 1.1f}, {1.9f, 0.4f, 0.8f, 2.3f}}, {}};
    for (std::size_t i = 0; i < count; ++i) stretch.alpha.push_back(random.uniform_float(0.0, 1.0));
    return stretch;
}

inline std::vector<Stretch> doubtful_stretches(std::size_t count, Random& random) {
    const Stretch ordinary = ordinary_stretch(count, random);
    std::vector<Stretch> stretches;
    const auto add = [&](const char* name, const glm::vec4& a, const glm::vec4& b, auto alpha) {
        Stretch stretch{name, {a, b}, {}};
        for (std::size_t i = 0; i < count; ++i) stretch.alpha.push_back(alpha());
        stretches.push_back(stretch);
    };
    const auto any = [&] { return random.uniform_float(0.0, 1.0); };
    // 1 + alpha is a tie where alpha is an odd multiple of 2^-24.
    const auto tied = [&] { return static_cast<float>(2 * random.integer(0, (1 << 22) - 1) + 1) * 0x1p-24f; };
    const auto tiny = [&] { return std::ldexp(random.uniform_float(0.5, 1.0), random.integer(-148, -30)); };
    const auto last = [&] { return 1.0f - static_cast<float>(random.integer(1, 64)) * 0x1p-24f; };
    add("ties", {1.0f, 1.0f, 1.0f, 1.0f}, {2.0f, 2.0f, 2.0f, 1.0f}, tied);
    add("ties, and a factor", glm::vec4(0.3f), 0.3f * glm::vec4(2.0f, 2.0f, 2.0f, 1.0f), tied);
    add("ties of quotients", {3.0f, 5.0f, 3.0f, 3.0f}, {6.0f, 10.0f, 6.0f, 3.0f}, tied);
    for (const float q : {49.0f, 107.0f})
        add("ties of quotients that a rounded reciprocal misses", {q, 64.0f * q, -q, q},
            {2.0f * q, 128.0f * q, -2.0f * q, q}, tied);
    add("large ties, beside ends that are not of a size", {64.0f, 0.0123f, 64.0f, 1.0f}, {128.0f, 100.3f, 128.0f, 1.0f},
        tied);
    add("large ties, beside ends that are far apart", {64.0f, 0x1.23456p-9f, 64.0f, 1.0f},
        {128.0f, -0x1.abcdep+25f, 128.0f, 1.0f}, tied);
    add("large ties, beside coordinates that begin at 0", {64.0f, 0.0f, 0.0f, 1.0f}, {128.0f, 0.7f, -1.0f, 1.0f}, tied);
    add("ties where q crosses 0", {-3.0f, 5.0f, 1.0f, 1.0f}, {-5.0f, 3.0f, 7.0f, -1.0f},
        [&] { return 0.5f - static_cast<float>(random.integer(-4, 8)) * 0x1p-14f; });
    add("q of ends that are not of a size", {1.0f, 2.0f, 3.0f, 0x1.234p-7f}, {3.0f, 1.0f, 2.0f, 0x1.5678p+3f}, tied);
    add("all of ends that are not of a size", {0x1.23456p-9f, 0x1.9876p-7f, -0x1.357p-8f, 0x1.abcdep-9f},
        {0x1.fedcbap+3f, 0x1.2468ap+4f, 0x1.fffffep+3f, 0x1.8ap+2f},
        [&] { return static_cast<float>(random.integer(0, 64)) * 0x1p-6f; });
    add("q crosses 0 at the middle", {1.0f, 2.0f, 3.0f, 1.0f}, {-3.0f, 1.0f, 2.0f, -1.0f},
        [&] { return neighbour(0.5f, random.integer(-4, 4)); });
    add("next to the root of q", {1.0f, 2.0f, 3.0f, 0.7f}, {-3.0f, 1.0f, 2.0f, -1.3f},
        [&] { return neighbour(0.35f, random.integer(-9, 9)); });
    add("q crosses 0", {1.0f, 2.0f, 3.0f, 0.7f}, {-3.0f, 1.0f, 2.0f, -1.3f}, any);
    add("all behind", {1.0f, 2.0f, 3.0f, -0.7f}, {-3.0f, 1.0f, 2.0f, -1.3f}, any);
    add("q is 0 all along", {1.0f, 2.0f, 3.0f, 0.0f}, {-3.0f, 1.0f, 2.0f, 0.0f}, any);
    add("q is 0 at an end", {1.0f, 2.0f, 3.0f, 0.0f}, {-3.0f, 1.0f, 2.0f, 1.0f}, tiny);
    add("u crosses 0", {1.0f, -1.0f, 3.0f, 1.0f}, {-1.0f, 1.0f, 2.0f, 1.0f}, [] { return 0.5f; });
    add("tiny alphas", ordinary.segment.a, ordinary.segment.b, tiny);
    add("tiny alphas from 0", {0.0f, 0.0f, 0.0f, 1.0f}, {1.0f, 3.0f, 2.0f, 3.0f}, tiny);
    add("a large beside b", {1e12f, -1e12f, 1e12f, 1e12f}, {1.0f, 2.0f, 3.0f, 1.0f}, last);
    add("a and b huge", {3e38f, -2e38f, 1e38f, 1e38f}, {-3e38f, 3e38f, 2e38f, 3e38f}, any);
    add("a and b subnormal", {3e-40f, -2e-41f, 1e-42f, 1e-40f}, {-3e-40f, 3e-40f, 2e-40f, 3e-40f}, any);
    add("subnormal values", {3e-40f, -2e-41f, 1e-42f, 1.0f}, {-3e-40f, 3e-40f, 2e-40f, 3.0f}, any);
    add("every alpha NaN", ordinary.segment.a, ordinary.segment.b, [&] { return nan_float; });
    add("every second alpha NaN", ordinary.segment.a, ordinary.segment.b,
        [&, i = 0]() mutable { return i++ % 2 == 0 ? nan_float : any(); });
    add("every 64th alpha NaN", ordinary.segment.a, ordinary.segment.b,
        [&, i = 0]() mutable { return i++ % 64 == 9 ? nan_float : any(); });
    add("s is NaN, next to the root of q", {nan_float, 2.0f, 3.0f, 0.7f}, {-3.0f, 1.0f, 2.0f, -1.3f},
        [&] { return neighbour(0.35f, random.integer(-9, 9)); });
    add("s is infinite, and q crosses 0", {infinity_float, 2.0f, 3.0f, 0.5f}, {-3.0f, 1.0f, 2.0f, -0.5f},
        [] { return 0.5f; });
    add("q is NaN", {1.0f, 2.0f, 3.0f, nan_float}, {-3.0f, 1.0f, 2.0f, -1.3f}, any);
    add("q is infinite", {1.0f, 2.0f, 3.0f, infinity_float}, {-3.0f, 1.0f, 2.0f, 1.3f}, any);
    return stretches;
}

}  // namespace support
