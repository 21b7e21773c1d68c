// Points and segments over raw bytes: nothing but the outputs is written, a value is what it is alone (so that a NaN
// spoils its own only) in every layout, Eigen's too, and values that are drawn for it are right by the exact judge.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "fuzz/input.hpp"
#include "judges/exact.hpp"
#include "judges/verdict.hpp"
#include "support/outputs.hpp"
#include "texgen/eigen.hpp"
#include "texgen/interpolate.hpp"
#include "texgen/texcoord.hpp"

namespace {

using fuzz::Input;
using fuzz::must;
using fuzz::must_be_right;
using fuzz::same;
using support::Outputs;
using texgen::ObjectTexgen;
using texgen::Tolerance;

// A count on both sides of the blocks of the kernels, and numbers that repeat, turned, until there are enough.
std::vector<float> numbers(Input& input, std::size_t count) {
    std::vector<float> few(1 + input.size(23));
    for (float& number : few) number = input.number();
    const std::size_t step = 1 + input.size(7);
    std::vector<float> many(count);
    for (std::size_t i = 0; i < count; ++i) many[i] = few[i * step % few.size()];
    return many;
}

std::size_t count_of(Input& input) { return input.coin() ? input.size(40) : input.size(600); }

// The points, in one of the layouts.
struct Layout {
    std::vector<glm::vec3> vectors;
    std::array<std::vector<float>, 3> arrays;
    std::vector<unsigned char> bytes;

    texgen::Positions<texgen::Object> positions(Input& input, const std::vector<glm::vec3>& points) {
        switch (points.empty() ? 1 : input.integer(0, 4)) {
            case 0:
                vectors = points;
                return texgen::object_space(vectors);
            case 1:
                for (std::size_t k = 0; k < 3; ++k)
                    for (const glm::vec3& point : points) arrays[k].push_back(point[static_cast<int>(k)]);
                return texgen::object_space(arrays[0], arrays[1], arrays[2]);
            case 2:
                return of_eigen(points, 3 + input.integer(0, 5));
            case 3:
                return of_eigen(points, 1 + input.integer(0, 5), input.coin());
            default: {
                const std::size_t offset = input.size(8), stride = 12 + input.size(16);
                bytes.assign(offset + points.size() * stride + 12, 0xa5);
                for (std::size_t i = 0; i < points.size(); ++i)
                    std::memcpy(bytes.data() + offset + i * stride, &points[i].x, 12);
                return texgen::object_space(reinterpret_cast<const float*>(bytes.data() + offset), points.size(),
                                            stride);
            }
        }
    }

    // Columns of a matrix of Eigen's, so many floats apart.
    texgen::Positions<texgen::Object> of_eigen(const std::vector<glm::vec3>& points, int stride) {
        using Columns = Eigen::Map<Eigen::Matrix3Xf, 0, Eigen::OuterStride<>>;
        const auto count = static_cast<Eigen::Index>(points.size());
        arrays[0].assign(points.size() * static_cast<std::size_t>(stride), -7.0f);
        Columns columns(arrays[0].data(), 3, count, Eigen::OuterStride<>(stride));
        for (Eigen::Index i = 0; i < count; ++i) columns.col(i) = texgen::to_eigen(points[static_cast<std::size_t>(i)]);
        return texgen::object_space(columns);
    }

    // Rows of a matrix of columns, and three vectors with gaps.
    texgen::Positions<texgen::Object> of_eigen(const std::vector<glm::vec3>& points, int stride, bool in_rows) {
        using Vector = Eigen::Map<Eigen::VectorXf, 0, Eigen::InnerStride<>>;
        using Rows = Eigen::Map<Eigen::MatrixX3f, 0, Eigen::Stride<Eigen::Dynamic, Eigen::Dynamic>>;
        const auto count = static_cast<Eigen::Index>(points.size());
        const std::size_t size = points.size() * static_cast<std::size_t>(stride);
        arrays[0].assign(3 * size, -7.0f);
        const auto coordinate = [&](std::size_t k) {
            return Vector(arrays[0].data() + k * size, count, Eigen::InnerStride<>(stride));
        };
        Vector x = coordinate(0), y = coordinate(1), z = coordinate(2);
        for (Eigen::Index i = 0; i < count; ++i) {
            const glm::vec3& point = points[static_cast<std::size_t>(i)];
            x[i] = point.x, y[i] = point.y, z[i] = point.z;
        }
        if (!in_rows) return texgen::object_space(x, y, z);
        const Eigen::Stride<Eigen::Dynamic, Eigen::Dynamic> strides(static_cast<Eigen::Index>(size), stride);
        return texgen::object_space(Rows(arrays[0].data(), count, 3, strides));
    }
};

void require_same(const Outputs& out, std::size_t i, const Outputs& alone, const char* promise) {
    for (std::size_t k = 0; k < 4; ++k)
        if (out.asked(k)) must(same(out[k][i], alone[k][0]), promise);
}

// Of a matrix with which a product could leave 2^-900 .. 2^1000, or that is not finite, no bits are promised.
bool has_promised_bits(const glm::dmat4& matrix) {
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            if (const double size = std::fabs(matrix[column][row]); size != 0.0 && !(size > 0x1p-700 && size < 0x1p700))
                return false;
    return true;
}

bool is_judged(const glm::dmat4& matrix, const glm::vec3& point) {
    return has_promised_bits(matrix) && fuzz::all_finite(point);
}

// What is in front is within its bound of the exact value, where that is finite.
void require_within(const Outputs& out, std::size_t i, const support::Homogeneous& at, const glm::dvec2& bound) {
    for (std::size_t k = 0; k < 2 && at.q.sign() > 0; ++k) {
        if (!out.asked(k) || !std::isfinite(bound[static_cast<int>(k)])) continue;
        must(std::isfinite(out[k][i]), "where a bound is finite there is a number");
        const support::Quotient u = at.over_q(k);
        const support::Dyadic error = magnitude(support::Dyadic(static_cast<double>(out[k][i])) * u.d - u.n);
        must(error <= support::Dyadic(bound[static_cast<int>(k)]) * u.d, "no error is larger than its bound");
    }
}

void project_points(Input& input) {
    const glm::dmat4 matrix = input.coin() ? glm::dmat4(input.matrix()) : input.wide_matrix();
    const ObjectTexgen texgen(matrix);
    const texgen::TextureRegion region = input.region_with_depth();
    const Tolerance tolerance = input.tolerance();
    const std::size_t count = count_of(input);
    const unsigned asked = input.raw<std::uint8_t>() & 15u;
    Outputs out(count, asked, input.size(7));
    const std::size_t judged[2] = {input.size(600), input.size(600)};
    const std::size_t spoilt = input.size(600);
    const std::vector<float> xyz = numbers(input, 3 * count);
    std::vector<glm::vec3> points(count);
    for (std::size_t i = 0; i < count; ++i) points[i] = {xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]};
    Layout layout;
    project(texgen, layout.positions(input, points), region, out.spans(), tolerance);
    must(out.pads_are_intact(), "project writes its outputs only");
    if (count == 0) return;

    const glm::dvec2 bound = project_error_bound(texgen, texgen::object_space(points), tolerance);
    must(bound.x >= 0.0 && bound.y >= 0.0, "an error bound is no NaN, and not negative");
    for (const std::size_t i : {judged[0] % count, judged[1] % count}) {
        if (is_judged(matrix, points[i])) require_within(out, i, support::exactly_at(matrix, points[i]), bound);
        Outputs alone(1, asked);
        project(texgen, texgen::object_space(std::span(&points[i], 1)), region, alone.spans(), texgen::exact);
        if (!(tolerance.value > 0.0) && has_promised_bits(matrix))
            require_same(out, i, alone, "a point's bits are those that it has alone");
        if (out.asked(3)) must(out.lit()[i] == 0.0f || out.lit()[i] == 1.0f, "lit is 0 or 1");
        if (is_judged(matrix, points[i]))
            must_be_right(what_is_wrong(support::exactly_at(matrix, points[i]), region, tolerance, out, i));
    }

    // The same without a mask, as pairs.
    std::vector<glm::vec2> pairs(count + 2, glm::vec2(-7.0f));
    project(texgen, texgen::object_space(points), std::span(pairs).subspan(1, count), tolerance);
    must(pairs.front() == glm::vec2(-7.0f) && pairs.back() == glm::vec2(-7.0f), "project writes its pairs only");
    if (!(tolerance.value > 0.0) && (asked & 3u) == 3u && has_promised_bits(matrix))
        for (std::size_t i = 0; i < count; ++i)
            must(same(pairs[1 + i].x, out.s()[i]) && same(pairs[1 + i].y, out.t()[i]), "pairs are s and t");

    // The same with a word on where the points lie: the bits of `exact` stay, and other values keep the tolerance. What
    // is no number lies in no box.
    std::vector<glm::vec3> finite;
    for (const glm::vec3& point : points)
        if (fuzz::all_finite(point)) finite.push_back(point);
    if (!finite.empty()) {
        texgen::Box box{finite[0], finite[0]};
        for (const glm::vec3& point : finite) {
            for (int k = 0; k < 3; ++k) {
                box.min[k] = std::min(box.min[k], point[k]);
                box.max[k] = std::max(box.max[k], point[k]);
            }
        }
        Layout finite_layout;
        const auto positions = finite_layout.positions(input, finite);
        Outputs with(finite.size(), asked), without(finite.size(), asked);
        project(texgen, positions.within(box), region, with.spans(), tolerance);
        project(texgen, positions, region, without.spans(), tolerance);
        must(with.pads_are_intact(), "project within a box writes its outputs only");
        std::vector<glm::vec2> pairs_within(finite.size());
        project(texgen, positions.within(box), pairs_within, tolerance);
        const glm::dvec2 bound_within = project_error_bound(texgen, positions.within(box), tolerance);
        const std::size_t i = judged[0] % finite.size();
        if (!(tolerance.value > 0.0) && has_promised_bits(matrix))
            for (std::size_t k = 0; k < 4; ++k)
                if (with.asked(k)) must(same(with[k][i], without[k][i]), "a box changes no bit of the nearest float");
        if (is_judged(matrix, finite[i])) {
            const support::Homogeneous at = support::exactly_at(matrix, finite[i]);
            must_be_right(what_is_wrong(at, region, tolerance, with, i));
            require_within(with, i, at, bound_within);
            for (std::size_t k = 0; k < 2; ++k)
                must(at.q.sign() > 0 ? support::keeps(pairs_within[i][static_cast<int>(k)], at.over_q(k), k, tolerance)
                                     : pairs_within[i][static_cast<int>(k)] == 0.0f,
                     "pairs within a box are in the tolerance");
        }
    }

    // One point has the same bits.
    for (const std::size_t i : {judged[0] % count, judged[1] % count}) {
        if (!has_promised_bits(matrix)) continue;
        glm::vec2 in_array(-7.0f);
        project(texgen, texgen::object_space(std::span(&points[i], 1)), std::span(&in_array, 1));
        const auto alone = project(texgen, texgen::object_space(points[i]));
        must(same(alone.value_or(glm::vec2(0.0f)).x, in_array.x) && same(alone.value_or(glm::vec2(0.0f)).y, in_array.y),
             "one point has the bits that it has in an array");
        if (is_judged(matrix, points[i]))
            must(alone.has_value() == (support::exactly_at(matrix, points[i]).q.sign() > 0),
                 "one point is empty behind, and there only");
    }

    // A point that is no number spoils nothing but itself.
    const std::size_t bad = spoilt % count;
    points[bad][static_cast<int>(bad % 3)] = bad % 2 == 0 ? std::numeric_limits<float>::quiet_NaN() : HUGE_VALF;
    Outputs after(count, asked);
    project(texgen, texgen::object_space(points), region, after.spans(), texgen::exact);
    for (const std::size_t i : {judged[0] % count, judged[1] % count}) {
        if (i == bad || !has_promised_bits(matrix)) continue;
        Outputs alone(1, asked);
        project(texgen, texgen::object_space(std::span(&points[i], 1)), region, alone.spans(), texgen::exact);
        require_same(after, i, alone, "a bad point spoils itself only");
    }
    if (after.asked(3)) must(after.lit()[bad] == 0.0f || bad % 2 != 0, "a NaN is not lit");
}

void generate_points(Input& input) {
    const glm::dmat4 matrix = input.coin() ? glm::dmat4(input.matrix()) : input.wide_matrix();
    const ObjectTexgen texgen(matrix);
    const std::size_t count = count_of(input);
    const unsigned asked = input.raw<std::uint8_t>() & 15u;
    const std::size_t judged = input.size(600);
    const std::vector<float> xyz = numbers(input, 3 * count);
    std::vector<glm::vec3> points(count);
    for (std::size_t i = 0; i < count; ++i) points[i] = {xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]};
    Layout layout, other_layout;
    Outputs out(count, asked, input.size(7));
    const texgen::Texcoords spans = out.spans();
    generate(texgen, layout.positions(input, points), {.s = spans.s, .t = spans.t, .r = spans.r, .q = spans.lit});
    must(out.pads_are_intact(), "generate writes its outputs only");
    std::vector<glm::vec4> quads(count + 2, glm::vec4(-7.0f));
    generate(texgen, other_layout.positions(input, points), std::span(quads).subspan(1, count));
    must(quads.front() == glm::vec4(-7.0f) && quads.back() == glm::vec4(-7.0f), "generate writes its quads only");
    if (count == 0) return;

    const std::size_t i = judged % count;
    glm::vec4 alone(0.0f);
    generate(texgen, texgen::object_space(std::span(&points[i], 1)), std::span(&alone, 1));
    must(same(alone, quads[1 + i]), "generated coordinates are those that the point has alone");
    for (std::size_t k = 0; k < 4; ++k)
        if (out.asked(k)) must(same(out[k][i], alone[static_cast<int>(k)]), "arrays hold what quads do");
    const auto st = texgen::divide(alone);
    must(st.has_value() == (alone.w > 0.0f), "divide is empty behind, and for a NaN");
    if (!is_judged(matrix, points[i])) return;

    // |value - exact| <= 1/2 ulp + 2^-50 sum |T_ij v_j|.
    const glm::dvec4 bound = generate_error_bound(texgen, texgen::object_space(std::span(&points[i], 1)));
    const support::Homogeneous exact = support::exactly_at(matrix, points[i]);
    const support::Dyadic values[4] = {exact.s, exact.t, exact.r, exact.q};
    for (int k = 0; k < 4; ++k) {
        if (std::isfinite(bound[k]))
            must(std::isfinite(alone[k]) &&
                     magnitude(support::Dyadic(static_cast<double>(alone[k])) - values[k]) <= support::Dyadic(bound[k]),
                 "no error is larger than its bound");
        support::Dyadic slack = magnitude(support::Dyadic(matrix[3][k]));
        for (int j = 0; j < 3; ++j)
            slack = slack + magnitude(support::Dyadic(matrix[j][k]) * support::Dyadic(points[i][j]));
        slack = slack * support::Dyadic(texgen::generate_error);
        const float value = alone[k];
        must(!std::isnan(value), "numbers make no NaN");
        // An infinity stands for everything beyond the largest float and half a unit.
        const bool is_high_enough =
            value == HUGE_VALF || values[k] - slack <= support::Dyadic(support::detail::middle(value, true));
        const bool is_low_enough =
            value == -HUGE_VALF || support::Dyadic(support::detail::middle(value, false)) <= values[k] + slack;
        must(is_high_enough && is_low_enough, "generate keeps its bound");
    }
}

void interpolate_segment(Input& input) {
    const texgen::Segment segment{input.vector4(), input.vector4()};
    const texgen::TextureRegion region = input.region_with_depth();
    const Tolerance tolerance = input.tolerance();
    const std::size_t count = count_of(input);
    const unsigned asked = input.raw<std::uint8_t>() & 15u;
    Outputs out(count, asked, input.size(7));
    const std::size_t judged[2] = {input.size(600), input.size(600)};
    std::vector<float> alpha = numbers(input, count);
    for (float& a : alpha)
        if (!std::isnan(a)) a = std::clamp(a, 0.0f, 1.0f);
    interpolate(segment, alpha, region, out.spans(), tolerance);
    must(out.pads_are_intact(), "interpolate writes its outputs only");
    const glm::dvec2 bound = error_bound(segment, tolerance);
    must(bound.x >= 0.0 && bound.y >= 0.0, "an error bound is no NaN, and not negative");
    const texgen::Work work = texgen::work(segment, region, tolerance);
    const bool has_finite_ends = fuzz::all_finite(segment.a) && fuzz::all_finite(segment.b);
    const auto has_finite_stq = [](const glm::vec4& end) { return fuzz::all_finite(glm::vec3(end.x, end.y, end.w)); };
    must((has_finite_stq(segment.a) && has_finite_stq(segment.b)) || work == texgen::Work::divide_and_test,
         "an end whose s, t or q is not finite needs all work");
    if (has_finite_ends && segment.a.w == segment.b.w)
        must(work == texgen::Work::nothing || work == texgen::Work::affine, "a constant q needs no division");
    if (count == 0) return;
    for (const std::size_t i : {judged[0] % count, judged[1] % count}) {
        if (out.asked(3) && has_finite_ends && !std::isnan(alpha[i])) {
            must(out.lit()[i] == 0.0f || work != texgen::Work::nothing, "no work is needed only where nothing is lit");
            must(out.lit()[i] == 1.0f || segment.a.w == segment.b.w || work == texgen::Work::nothing ||
                     work == texgen::Work::divide_and_test,
                 "what is dark is tested");
        }
        Outputs alone(1, asked);
        interpolate(segment, std::span(&alpha[i], 1), region, alone.spans(), texgen::exact);
        if (!(tolerance.value > 0.0) && has_finite_ends)
            require_same(out, i, alone, "a value's bits are those that it has alone");
        if (out.asked(3)) must(out.lit()[i] == 0.0f || out.lit()[i] == 1.0f, "lit is 0 or 1");
        if (std::isnan(alpha[i]) && out.asked(3)) must(out.lit()[i] == 0.0f, "an alpha that is NaN is not lit");
        if (std::isnan(alpha[i]) || !has_finite_ends) continue;
        const auto exact_values = support::exactly_at(segment, alpha[i]);
        require_within(out, i, exact_values, bound);
        must_be_right(what_is_wrong(exact_values, region, tolerance, out, i));
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Input input(data, size);
    switch (input.integer(0, 2)) {
        case 0:
            project_points(input);
            break;
        case 1:
            generate_points(input);
            break;
        default:
            interpolate_segment(input);
            break;
    }
    return 0;
}
