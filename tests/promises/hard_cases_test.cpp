// Every case of hard_cases.jsonl: inputs on which an obvious formula fails, with the exact result, put to the public
// function that answers it. A kind that is not known here fails.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "judges/oracle.hpp"
#include "judges/rational_traits.hpp"
#include "promises/hard_cases_test/matrices.hpp"
#include "promises/hard_cases_test/numbers.hpp"
#include "support/json.hpp"
#include "support/random.hpp"
#include "texgen/coverage.hpp"
#include "texgen/interpolate.hpp"
#include "texgen/reference.hpp"
#include "texgen/texcoord.hpp"

namespace hard_cases {

namespace reference = texgen::reference;
using texgen::Segment;
using texgen::Triangle;

namespace {

const texgen::TextureRegion vast = texgen::atlas_tile({-1e300, -1e300}, {1e300, 1e300});
const texgen::TextureRegion boundless = texgen::atlas_tile({-HUGE_VAL, -HUGE_VAL}, {HUGE_VAL, HUGE_VAL});

struct Divided {
    float s, lit;
};

Divided at(const Segment& segment, float alpha) {
    Divided result{-7.0f, -7.0f};
    texgen::interpolate(segment, {&alpha, 1}, vast, {.s = {&result.s, 1}, .t = {}, .r = {}, .lit = {&result.lit, 1}});
    return result;
}

// (1 - a) A + a B as s over q = 1; what is said of s holds for t and r.
void lerp(const Json& json) {
    const Json& in = json["in"];
    const float a = as_float(in["A"]), b = as_float(in["B"]), alpha = as_float(in["a"]);
    const Segment segment{{a, 0, 0, 1}, {b, 0, 0, 1}};
    CHECK(reference::strq(segment, exactly(alpha))[0] == as_rational(json["exact_hex_rational"]));
    CHECK(at(segment, alpha).s == as_float(json["f32"]));
}

void cu(const Json& json) {
    const Json& in = json["in"];
    const Segment segment{{as_float(in["Au"]), 0, 0, as_float(in["Aq"])},
                          {as_float(in["Bu"]), 0, 0, as_float(in["Bq"])}};
    const float alpha = as_float(in["a"]);
    const auto exact = reference::strq(segment, exactly(alpha));
    const Divided computed = at(segment, alpha);
    if (json.has("q_exact_zero")) {
        CHECK(exact[3] == 0);
        CHECK(computed.s == 0.0f);
        CHECK(computed.lit == 0.0f);
        return;
    }
    CHECK(reference::quotient(exact)[0] == as_rational(json["exact_hex_rational"]));
    const bool in_front = json["q_sign"].number() > 0.0;
    CHECK((exact[3] > 0) == in_front);
    CHECK(computed.s == (in_front ? as_float(json["f32"]) : 0.0f));
    if (in_front && std::isfinite(computed.s)) {
        CHECK(work(segment, vast) != texgen::Work::nothing);
        const Rational error = support::magnitude(exactly(computed.s) - reference::quotient(exact)[0]);
        const double bound = error_bound(segment).x;
        if (std::isfinite(bound)) CHECK(error <= exactly(bound));
    }
    CHECK(computed.lit == (in_front && std::isfinite(computed.s) ? 1.0f : 0.0f));
}

void div(const Json& json) {
    const float s = as_float(json["in"]["s"]), q = as_float(json["in"]["q"]), expected = as_float(json["f32"]);
    const auto divided = texgen::divide({s, -s, 0, q});
    REQUIRE(divided);
    CHECK(divided->x == expected);
    CHECK(divided->y == -expected);
    // The same through a matrix: s = x, q = y.
    glm::dmat4 pick(0.0);
    pick[0][0] = 1.0;
    pick[1][3] = 1.0;
    const glm::vec3 point(s, q, 0.0f);
    Divided projected{-7.0f, -7.0f};
    texgen::project(texgen::ObjectTexgen(pick), texgen::object_space(std::span(&point, 1)), texgen::whole_texture(),
                    {.s = {&projected.s, 1}, .t = {}, .r = {}, .lit = {}});
    CHECK(projected.s == expected);
}

// q = T_q v: its value from generate(), its sign from project().
void dot4(const Json& json) {
    const glm::vec4 row = as_vector(json["in"]["T_q"]), v = as_vector(json["in"]["v"]);
    REQUIRE(v.w == 1.0f);
    glm::dmat4 matrix(0.0);
    matrix[3][0] = 1.0;  // s = 1
    Rational slack = 0;
    for (int k = 0; k < 4; ++k) {
        matrix[k][3] = row[k];
        slack += support::magnitude(exactly(row[k]) * exactly(v[k])) * support::power_of_two(-50);
    }
    const texgen::ObjectTexgen texture_from_object(matrix);
    const glm::vec3 point(v);
    const auto points = texgen::object_space(std::span(&point, 1));
    const Rational exact = as_rational(json["exact_hex_rational"]);
    glm::vec4 strq(-7.0f);
    texgen::generate(texture_from_object, points, std::span(&strq, 1));
    const Rational half_ulp = support::power_of_two(support::ulp_exponent<float>(exact) - 1);
    CHECK(support::magnitude(exactly(strq.w) - exact) <= half_ulp + slack);
    Divided projected{-7.0f, -7.0f};
    texgen::project(texture_from_object, points, vast,
                    {.s = {&projected.s, 1}, .t = {}, .r = {}, .lit = {&projected.lit, 1}});
    CHECK(support::magnitude(exactly(strq.w) - exact) <= exactly(generate_error_bound(texture_from_object, points).w));
    const bool in_front = json["sign"].number() > 0.0;
    CHECK((coverage(texture_from_object, boundless, texgen::Box{point, point}) == texgen::Coverage::outside) !=
          in_front);
    if (in_front && std::isfinite(projected.s))
        CHECK(support::magnitude(exactly(projected.s) - 1 / exact) <=
              exactly(project_error_bound(texture_from_object, points).x));
    CHECK(projected.s == (in_front ? support::nearest<float>(1 / exact) : 0.0f));
    CHECK(projected.lit == (in_front && std::isfinite(projected.s) ? 1.0f : 0.0f));
}

// The orientation of (a, b, p) decides whether there is a triangle at all.
void orient(const Json& json) {
    const Json& c = json["in"]["axay_bxby_pxpy"];
    const auto vertex = [&c](std::size_t i) {
        return texgen::WindowVertex{{as_float(c[2 * i]), as_float(c[2 * i + 1])}, 1.0f, {0, 0, 0, 1}};
    };
    const Triangle triangle{vertex(0), vertex(1), vertex(2)};
    const int sign = static_cast<int>(json["sign"].number());
    const reference::detail::Vertex<Rational> a(triangle.a), b(triangle.b), p(triangle.c);
    CHECK(reference::detail::edge(a, b, p.x, p.y) == as_rational(json["exact_hex_rational"]));
    if (sign != 0) CHECK(reference::detail::WindowTriangle<Rational>(triangle).side == sign);
    CHECK(texgen::TriangleSetup::of(triangle, texgen::whole_texture()).has_value() == (sign != 0));
}

void tri(const Json& json) {
    const Json& in = json["in"];
    const double px = in["px"].number(), py = in["py"].number();
    // Moved so that the point is the centre of its pixel; the move is exact.
    const glm::dvec2 centre(std::floor(px) + 0.5, std::floor(py) + 0.5);
    const auto vertex = [&](std::size_t i) {
        const double x = in["x"][i].number() + (centre.x - px), y = in["y"][i].number() + (centre.y - py);
        const glm::vec2 window(static_cast<float>(x), static_cast<float>(y));
        REQUIRE(glm::dvec2(window) == glm::dvec2(x, y));
        return texgen::WindowVertex{window, as_float(in["w"][i]), {as_float(in["s"][i]), 0, 0, as_float(in["q"][i])}};
    };
    const Triangle triangle{vertex(0), vertex(1), vertex(2)};
    const auto exact = reference::strq(triangle, exactly(centre.x), exactly(centre.y));
    CHECK(reference::quotient(exact)[0] == as_rational(json["exact_hex_rational"]));
    const texgen::FragmentRect pixel{static_cast<int>(std::floor(px)), static_cast<int>(std::floor(py)), 1, 1};
    float by_reference = -7.0f, fast = -7.0f;
    reference::interpolate(triangle, vast, pixel, {.s = {&by_reference, 1}, .t = {}, .r = {}, .lit = {}});
    const auto setup = texgen::TriangleSetup::of(triangle, vast);
    REQUIRE(setup);
    texgen::interpolate(*setup, pixel, {.s = {&fast, 1}, .t = {}, .r = {}, .lit = {}});
    CHECK(by_reference == as_float(json["f32"]));
    CHECK(fast == as_float(json["f32"]));
    CHECK(setup->work(pixel) != texgen::Work::nothing);
    CHECK(support::magnitude(exactly(fast) - as_rational(json["exact_hex_rational"])) <=
          exactly(setup->error_bound(pixel).x));
}

// How far a line through the divided ends is from the divided segment, at its worst of n steps: option (3) against (2).
void affine_dev(const Json& json) {
    const Json& in = json["in"];
    const auto end = [&in](const std::string& index) {
        return reference::Vector4<Rational>(exactly(as_float(in["N" + index])), 0, 0,
                                            exactly(as_float(in["Q" + index])));
    };
    const int steps = static_cast<int>(in["n"].number());
    Rational worst = 0;
    for (int i = 0; i <= steps; ++i) {
        const Rational alpha(i, steps);
        const Rational right = reference::interpolate_then_divide(end("0"), end("1"), alpha)[0];
        const Rational line = reference::wrong_divide_then_interpolate(end("0"), end("1"), alpha)[0];
        worst = std::max(worst, support::magnitude(right - line));
    }
    CHECK(worst == as_rational(json["exact_hex_rational"]));

    // A segment under half that tolerance is divided.
    const Segment segment{{as_float(in["N0"]), 0, 0, as_float(in["Q0"])},
                          {as_float(in["N1"]), 0, 0, as_float(in["Q1"])}};
    const texgen::Tolerance tolerance{0.5 * support::nearest<double>(worst)};
    std::vector<float> alpha, s(static_cast<std::size_t>(steps + 1));
    for (int i = 0; i <= steps; ++i) alpha.push_back(support::to_float(static_cast<double>(i) / steps));
    texgen::interpolate(segment, alpha, vast, {.s = s, .t = {}, .r = {}, .lit = {}}, tolerance);
    for (std::size_t i = 0; i < alpha.size(); ++i) {
        const Rational right = reference::quotient(reference::strq(segment, exactly(alpha[i])))[0];
        const Rational error = support::magnitude(exactly(s[i]) - right);
        CHECK(error <= std::max(exactly(tolerance.value),
                                Rational(support::power_of_two(support::ulp_exponent<float>(right) - 1))));
        CHECK(error <= exactly(error_bound(segment, tolerance).x));
    }
}

}  // namespace

TEST_CASE("every hard case is answered by the function that it is about") {
    const std::map<std::string, void (*)(const Json&)> checks{{"lerp", lerp},
                                                              {"cu", cu},
                                                              {"div", div},
                                                              {"dot4", dot4},
                                                              {"orient", orient},
                                                              {"tri", tri},
                                                              {"eyeplane", eyeplane},
                                                              {"compose_To", compose_to},
                                                              {"lookat", lookat},
                                                              {"te_from_poses", te_from_poses},
                                                              {"perspective", perspective},
                                                              {"affine_dev", affine_dev}};
    std::ifstream file(TEXGEN_TEST_DATA "/promises/hard_cases.jsonl");
    REQUIRE(file.is_open());
    std::map<std::string, int> counts;
    std::string line;
    while (std::getline(file, line)) {
        if (line.empty()) continue;
        const Json json = support::JsonReader::read(line);
        const std::string kind = json["kind"].text;
        CAPTURE(line);
        const auto check = checks.find(kind);
        REQUIRE(check != checks.end());
        ++counts[kind];
        check->second(json);
    }
    const std::map<std::string, int> expected{{"lerp", 17},       {"cu", 16},        {"div", 13},
                                              {"dot4", 6},        {"orient", 5},     {"tri", 5},
                                              {"eyeplane", 18},   {"lookat", 6},     {"te_from_poses", 4},
                                              {"perspective", 8}, {"compose_To", 8}, {"affine_dev", 8}};
    CHECK(counts == expected);
}

}  // namespace hard_cases
