// Points and segments on which one double does not suffice: their values are those of exact numbers, in vectors as one
// by one.

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "judges/exact.hpp"
#include "judges/fragments.hpp"
#include "support/doubtful.hpp"
#include "support/hex.hpp"
#include "support/outputs.hpp"
#include "support/random.hpp"
#include "texgen/interpolate.hpp"
#include "texgen/texcoord.hpp"

namespace {

using support::everywhere;
using support::Homogeneous;
using support::Outputs;
using support::Random;

constexpr std::array<std::size_t, 4> point_counts{1, 16, 100, 333};

bool is_finite(const glm::vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

// What is promised of value i, s, t or r.
void check(const Outputs& out, std::size_t i, const Homogeneous& exact, double tolerance, const std::string& where) {
    for (std::size_t k = 0; k < 3; ++k) {
        if (exact.q.sign() <= 0) {
            REQUIRE_MESSAGE(support::same_bits(out[k][i], 0.0f), where);
            continue;
        }
        const support::Quotient u = exact.over_q(k);
        if (tolerance == 0.0)
            REQUIRE_MESSAGE(is_nearest(out[k][i], u), where);
        else if (k == 2)
            REQUIRE_MESSAGE(is_within_relatively(out[k][i], u, tolerance), where);
        else
            REQUIRE_MESSAGE(is_within(out[k][i], u, tolerance), where);
    }
    const bool is_lit = exact.q.sign() > 0 && support::contains(everywhere(), out.s()[i], out.t()[i], 0.0f);
    REQUIRE_MESSAGE(out.lit()[i] == (is_lit ? 1.0f : 0.0f), where);
}

bool same_or_both_nan(float a, float b) { return support::same_bits(a, b) || (std::isnan(a) && std::isnan(b)); }

std::vector<support::Cloud> clouds(std::size_t count, Random& random) {
    std::vector<support::Cloud> result = support::doubtful_clouds(count, random);
    for (const support::Cloud& cloud : support::clouds_of_long_sums(count, random)) result.push_back(cloud);
    return result;
}

// Exact points, in vectors and one by one.
void check_points(const glm::dmat4& matrix, const std::vector<glm::vec3>& points) {
    const texgen::WorldTexgen texgen(matrix);
    Outputs out(points.size());
    project(texgen, texgen::world_space(points), everywhere(), out.spans());
    for (std::size_t i = 0; i < points.size(); ++i) {
        const std::string where = support::hex(points[i]);
        check(out, i, support::exactly_at(matrix, points[i]), 0.0, where);
        const glm::vec2 alone = project(texgen, texgen::world_space(points[i])).value();
        REQUIRE_MESSAGE(support::same_bits(alone.x, out.s()[i]), where);
        REQUIRE_MESSAGE(support::same_bits(alone.y, out.t()[i]), where);
    }
}

}  // namespace

TEST_CASE("points in doubt are what exact numbers make of them, at every tolerance and in every number") {
    Random random(51);
    for (const std::size_t count : point_counts) {
        for (const support::Cloud& cloud : clouds(count, random)) {
            const bool is_number = 0.0 * (cloud.matrix[0][0] + cloud.matrix[0][3] + cloud.matrix[3][3]) == 0.0;
            if (!is_number) continue;
            const texgen::WorldTexgen texgen(cloud.matrix);
            for (const double tolerance : {0.0, 0x1p-30, 0x1p-21, 0x1p-12}) {
                Outputs out(count);
                project(texgen, texgen::world_space(cloud.points), everywhere(), out.spans(),
                        texgen::Tolerance{tolerance});
                REQUIRE(out.pads_are_intact());
                for (std::size_t i = 0; i < count; ++i) {
                    const std::string where = cloud.name + " at " + support::hex(cloud.points[i]);
                    if (is_finite(cloud.points[i])) {
                        check(out, i, support::exactly_at(cloud.matrix, cloud.points[i]), tolerance, where);
                    } else {
                        for (std::size_t k = 0; k < 4; ++k) REQUIRE_MESSAGE(support::same_bits(out[k][i], 0.0f), where);
                    }
                }
            }
        }
    }
}

TEST_CASE("points in doubt have the same bits in vectors and one by one") {
    Random random(52);
    constexpr std::size_t count = 320;
    for (const support::Cloud& cloud : clouds(count, random)) {
        for (const int row : {0, 2}) {
            const int numerators = row == 0 ? 2 : 1;
            std::array<std::vector<float>, 3> in_vectors, one_by_one;
            for (auto* arrays : {&in_vectors, &one_by_one}) arrays->fill(std::vector<float>(count));
            texgen::detail::PointJob job = texgen::detail::point_job(
                cloud.matrix, row, numerators, texgen::detail::LitTest(everywhere()), texgen::exact);
            job.count = count;
            job.interleaved_xyz = true;
            job.x = &cloud.points[0].x;
            const auto write_to = [&](std::array<std::vector<float>, 3>& arrays) {
                for (std::size_t k = 0; k < 2; ++k) job.out[k] = arrays[k].data();
                job.lit = row == 0 ? arrays[2].data() : nullptr;
            };
            write_to(in_vectors);
            const auto& kernels = texgen::detail::chosen<texgen::detail::PointKernels>();
            texgen::detail::fill_blocks(kernels.fill_exact, job, 0, texgen::detail::project_one);
            write_to(one_by_one);
            for (std::size_t i = 0; i < count; ++i) texgen::detail::project_one(job, i);
            for (std::size_t k = 0; k < 3; ++k)
                for (std::size_t i = 0; i < count; ++i)
                    REQUIRE_MESSAGE(same_or_both_nan(in_vectors[k][i], one_by_one[k][i]), cloud.name, " at ",
                                    support::hex(cloud.points[i]), ": ", in_vectors[k][i], " ", one_by_one[k][i]);
        }
    }
}

TEST_CASE("one point has the bits that it has in a batch, and is empty behind") {
    Random random(59);
    constexpr std::size_t count = 320;
    for (const support::Cloud& cloud : clouds(count, random)) {
        const texgen::WorldTexgen texgen(cloud.matrix);
        std::vector<glm::vec2> st(count);
        project(texgen, texgen::world_space(cloud.points), st);
        const bool is_number = 0.0 * (cloud.matrix[0][0] + cloud.matrix[0][3] + cloud.matrix[3][3]) == 0.0;
        for (std::size_t i = 0; i < count; ++i) {
            const std::string where = cloud.name + " at " + support::hex(cloud.points[i]);
            const std::optional<glm::vec2> alone = project(texgen, texgen::world_space(cloud.points[i]));
            const glm::vec2 value = alone.value_or(glm::vec2(0.0f));
            REQUIRE_MESSAGE(same_or_both_nan(value.x, st[i].x), where, ": ", value.x, " ", st[i].x);
            REQUIRE_MESSAGE(same_or_both_nan(value.y, st[i].y), where, ": ", value.y, " ", st[i].y);
            const bool is_in_front = is_number && is_finite(cloud.points[i]) &&
                                     support::exactly_at(cloud.matrix, cloud.points[i]).q.sign() > 0;
            if (is_number) REQUIRE_MESSAGE(alone.has_value() == is_in_front, where);
        }
    }
}

TEST_CASE("values of a segment in doubt are what exact numbers make of them, at every tolerance and in every number") {
    Random random(53);
    for (const std::size_t count : point_counts) {
        for (const support::Stretch& stretch : support::doubtful_stretches(count, random)) {
            const glm::vec4 ends = 0.0f * (stretch.segment.a + stretch.segment.b);
            if (!(ends.x + ends.y + ends.z + ends.w == 0.0f)) continue;
            for (const double tolerance : {0.0, 0x1p-30, 0x1p-21, 0x1p-12}) {
                Outputs out(count);
                interpolate(stretch.segment, stretch.alpha, everywhere(), out.spans(), texgen::Tolerance{tolerance});
                REQUIRE(out.pads_are_intact());
                for (std::size_t i = 0; i < count; ++i) {
                    const std::string where = stretch.name + " at " + support::hex(stretch.alpha[i]);
                    if (std::isfinite(stretch.alpha[i])) {
                        check(out, i, support::exactly_at(stretch.segment, stretch.alpha[i]), tolerance, where);
                    } else {
                        for (std::size_t k = 0; k < 4; ++k) REQUIRE_MESSAGE(support::same_bits(out[k][i], 0.0f), where);
                    }
                }
            }
        }
    }
}

TEST_CASE("values of a segment in doubt have the same bits in vectors and one by one") {
    Random random(54);
    constexpr std::size_t count = 320;
    for (const support::Stretch& stretch : support::doubtful_stretches(count, random)) {
        for (const int first : {0, 2}) {
            std::array<std::vector<float>, 2> in_vectors, one_by_one;
            for (auto* arrays : {&in_vectors, &one_by_one}) arrays->fill(std::vector<float>(count));
            texgen::detail::SegmentJob job{};
            texgen::detail::prepare_job(job, stretch.segment, first, first == 0 ? 2 : 1, 0.0);
            job.count = count;
            job.alpha = stretch.alpha.data();
            const auto write_to = [&](std::array<std::vector<float>, 2>& arrays) {
                for (std::size_t k = 0; k < 2; ++k) job.out[k] = arrays[k].data();
            };
            write_to(in_vectors);
            interpolate_job(texgen::detail::chosen<texgen::detail::SegmentKernels>(), job);
            write_to(one_by_one);
            for (std::size_t i = 0; i < count; ++i) texgen::detail::interpolate_one(job, i);
            for (std::size_t k = 0; k < 2; ++k)
                for (std::size_t i = 0; i < count; ++i)
                    REQUIRE_MESSAGE(same_or_both_nan(in_vectors[k][i], one_by_one[k][i]), stretch.name, " at ",
                                    support::hex(stretch.alpha[i]), ": ", in_vectors[k][i], " ", one_by_one[k][i]);
        }
    }
}

TEST_CASE("next to ties that no two doubles tell from ties the nearest float is found all the same") {
    Random random(58);
    constexpr std::size_t count = 160;
    std::vector<glm::vec3> points(count);
    for (const double factor : {0.1, 0.3, 1.7}) {
        for (const double least : {0x1p-120, 0x1p-170, 0x1p-220}) {
            for (glm::vec3& point : points) point = {random.uniform_float(1.0, 2.0), 1.0f, random.integer(-1, 1)};
            check_points(
                support::matrix_of_rows({factor, 0x1p-24 * factor, least, 0.0}, {factor, 0x1p-24 * factor, -least, 0.0},
                                        {factor, 0x1p-24 * factor, 0.0, 0.0}, {0.0, 0.0, 0.0, factor}),
                points);
        }
    }
    // A tie of a subnormal element, the last digit of which counts.
    points.assign(count, {0x1p127f, 0.0f, 0.0f});
    const glm::dvec4 subnormal(0x1p-1024 - 0x1p-1074, 0.0, 0.0, 0x1.000001p-896 + 0x1p-947);
    check_points(support::matrix_of_rows(subnormal, subnormal, subnormal, {0.0, 0.0, 0.0, 0x1p-897}), points);
}

TEST_CASE("where q is 1 what a sum in double leaves decides a tie, and next to a tie nothing") {
    Random random(59);
    std::vector<glm::vec3> points(100);
    for (int steps = -3; steps <= 3; ++steps) {
        const double next_to_tie = 0x1.000001p+0 + steps * 0x1p-52;  // of two floats
        for (const double left : {0x1p-54, 0x1p-60, 0x1p-100, -0x1p-54, -0x1p-60, -0x1p-100}) {
            for (glm::vec3& point : points) {
                const float x = std::ldexp(random.coin() ? 1.0f : -1.0f, random.integer(-20, 20));
                point = {x, x, 0.0f};
            }
            const glm::dvec4 row(next_to_tie, left, 0.0, 0.0);
            check_points(support::matrix_of_rows(row, -row, row, {0.0, 0.0, 0.0, 1.0}), points);
        }
    }
}

TEST_CASE("two doubles leave none of these points in doubt") {
    Random random(55);
    constexpr std::size_t count = 320;
    const auto& kernels = texgen::detail::chosen<texgen::detail::PointKernels>();
    for (const support::Cloud& cloud : clouds(count, random)) {
        std::vector<float> s(count), t(count);
        texgen::detail::PointJob job =
            texgen::detail::point_job(cloud.matrix, 0, 2, texgen::detail::LitTest(everywhere()), texgen::exact);
        job.count = count;
        job.interleaved_xyz = true;
        job.x = &cloud.points[0].x;
        job.out[0] = s.data();
        job.out[1] = t.data();
        std::size_t undecided = 0;
        texgen::detail::fill_blocks(kernels.fill_exact, job, 0,
                                    [&](const texgen::detail::PointJob&, std::size_t) { ++undecided; });
        CHECK_MESSAGE(undecided == 0, cloud.name, ": ", undecided);
    }
}
