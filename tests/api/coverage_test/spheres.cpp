// Spheres, judged by their exact distances from what is lit.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "api/coverage_test/judge.hpp"
#include "api/coverage_test/slides.hpp"
#include "judges/oracle.hpp"
#include "judges/rational_matrix.hpp"
#include "support/hex.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"
#include "texgen/coverage.hpp"

namespace coverage_cases {

using support::Rational;
using texgen::coverage;
using texgen::LitVolume;

namespace {

// How far a point is from what is lit (q >= 0 and the sides), exactly: the nearest point is the projection onto the
// planes of some of the forms, so it is the nearest of those projections that fulfil all of them.
class DistanceJudge {
public:
    using Form = std::array<Rational, 4>;

    explicit DistanceJudge(const Judge& judge)
        : forms_(rational(judge.forms())),
          inner_forms_(rational(judge.inner_forms())),
          no_float_is_inside_(judge.no_float_is_inside()) {
        for (const Inequality& form : judge.forms()) near_forms_.emplace_back(form);
        for (const Inequality& form : judge.inner_forms()) near_inner_forms_.emplace_back(form);
    }

    // What doubles are certain of; the exact answers take a thousand times as long.
    bool is_surely_outside_a_plane(const Sphere& sphere) const {
        return std::ranges::any_of(near_forms_, [&](const NearForm& f) { return f.is_negative_over(sphere); });
    }
    bool is_surely_inside(const Sphere& sphere) const {
        return !no_float_is_inside_ &&
               std::ranges::all_of(near_inner_forms_, [&](const NearForm& f) { return f.is_positive_over(sphere); });
    }
    // By the plane through an edge that faces the centre; any weights that are not negative prove it.
    bool is_surely_outside_an_edge(const Sphere& sphere) const {
        for (const NearForm& f : near_forms_)
            for (const NearForm& g : near_forms_)
                if (&f < &g && NearForm::facing(f, g, sphere).is_negative_over(sphere)) return true;
        return false;
    }

    // Whether some point within the radius is lit, or would be with q = 0.
    bool reaches(const Sphere& sphere) const {
        const std::array<Rational, 3> centre{support::exactly(sphere.centre.x), support::exactly(sphere.centre.y),
                                             support::exactly(sphere.centre.z)};
        const Rational radius = support::exactly(sphere.radius);
        const std::size_t n = forms_.size();
        for (std::size_t set = 0; set < std::size_t{1} << n; ++set) {
            std::vector<std::size_t> active;
            for (std::size_t k = 0; k < n; ++k)
                if ((set >> k & 1u) != 0u) active.push_back(k);
            if (active.size() > 3) continue;
            const auto point = projection(centre, active);
            if (!point) continue;
            Rational squared = 0;
            for (std::size_t j = 0; j < 3; ++j) squared += ((*point)[j] - centre[j]) * ((*point)[j] - centre[j]);
            if (squared > radius * radius) continue;
            if (std::ranges::all_of(forms_, [&](const auto& f) { return value(f, *point) >= 0; })) return true;
        }
        return false;
    }

    // -1, 0, 1: f(centre) + sign |a| radius.
    static int extreme_sign(const Form& f, const Sphere& sphere, int sign) {
        const Rational at = value(f, {support::exactly(sphere.centre.x), support::exactly(sphere.centre.y),
                                      support::exactly(sphere.centre.z)});
        const Rational radius = support::exactly(sphere.radius);
        const Rational change = (f[0] * f[0] + f[1] * f[1] + f[2] * f[2]) * radius * radius;  // squared
        const Rational squared = at * at;
        if (sign > 0) return at >= 0 ? (at > 0 || change > 0) : squared > change ? -1 : squared < change;
        return at <= 0            ? -static_cast<int>(at < 0 || change > 0)
               : squared > change ? 1
                                  : -static_cast<int>(squared < change);
    }
    bool is_outside_a_plane(const Sphere& sphere) const {
        for (std::size_t k = 0; k < forms_.size(); ++k)
            if (extreme_sign(forms_[k], sphere, 1) < (k + 1 == forms_.size() ? 1 : 0)) return true;
        return false;
    }
    bool is_inside(const Sphere& sphere) const {
        for (std::size_t k = 0; k < inner_forms_.size(); ++k)
            if (extreme_sign(inner_forms_[k], sphere, -1) < (k + 1 == inner_forms_.size() ? 1 : 0)) return false;
        return !no_float_is_inside_;
    }

private:
    // In double: a form, or a sum of two with weights >= 0, of which `size` holds the magnitudes.
    struct NearForm {
        glm::dvec3 a{0.0}, size_of_a{0.0};
        double d = 0.0, size_of_d = 0.0;

        explicit NearForm(const Inequality& form)
            : a(form.c[0].estimate(), form.c[1].estimate(), form.c[2].estimate()),
              size_of_a(glm::abs(a)),
              d(form.c[3].estimate()),
              size_of_d(std::fabs(d)) {}
        NearForm(double w, const NearForm& f, double v, const NearForm& g)
            : a(w * f.a + v * g.a),
              size_of_a(w * f.size_of_a + v * g.size_of_a),
              d(w * f.d + v * g.d),
              size_of_d(w * f.size_of_d + v * g.size_of_d) {}
        static NearForm facing(const NearForm& f, const NearForm& g, const Sphere& sphere) {
            const double across = glm::dot(f.a, g.a);
            const double w = across * g.at(sphere) - glm::dot(g.a, g.a) * f.at(sphere);
            const double v = across * f.at(sphere) - glm::dot(f.a, f.a) * g.at(sphere);
            return w > 0.0 && v > 0.0 ? NearForm(w / (w + v), f, v / (w + v), g) : NearForm(0.0, f, 0.0, g);
        }

        double at(const Sphere& sphere) const { return glm::dot(a, glm::dvec3(sphere.centre)) + d; }
        double change(const Sphere& sphere) const { return glm::length(a) * static_cast<double>(sphere.radius); }
        // A few dozen roundings, each below 2^-52 of what it is of.
        double error(const Sphere& sphere) const {
            const glm::dvec3 reach = glm::abs(glm::dvec3(sphere.centre)) + static_cast<double>(sphere.radius);
            return 0x1p-45 * (glm::dot(size_of_a, reach) + size_of_d) + 0x1p-900;
        }
        bool is_negative_over(const Sphere& sphere) const { return at(sphere) + change(sphere) < -error(sphere); }
        bool is_positive_over(const Sphere& sphere) const { return at(sphere) - change(sphere) > error(sphere); }
    };

    static std::vector<Form> rational(const std::vector<Inequality>& forms) {
        std::vector<Form> result;
        for (const Inequality& form : forms) {
            Form f;
            for (std::size_t j = 0; j < 4; ++j) f[j] = form.c[j].rational();
            result.push_back(f);
        }
        return result;
    }
    static Rational value(const std::array<Rational, 4>& f, const std::array<Rational, 3>& p) {
        return f[0] * p[0] + f[1] * p[1] + f[2] * p[2] + f[3];
    }

    // Onto the points where all active forms are 0: c - N^T (N N^T)^-1 f(c). Empty where the normals are dependent.
    std::optional<std::array<Rational, 3>> projection(const std::array<Rational, 3>& centre,
                                                      const std::vector<std::size_t>& active) const {
        support::RationalMatrix gram{};
        for (std::size_t i = 0; i < 4; ++i) {
            gram[i][i] = 1;
            for (std::size_t k = 0; k < active.size() && i < active.size(); ++k) {
                gram[i][k] = 0;
                for (std::size_t j = 0; j < 3; ++j) gram[i][k] += forms_[active[i]][j] * forms_[active[k]][j];
            }
        }
        const auto inverse = support::inverse(gram);
        if (!inverse) return {};
        std::array<Rational, 3> point = centre;
        for (std::size_t i = 0; i < active.size(); ++i) {
            Rational weight = 0;
            for (std::size_t k = 0; k < active.size(); ++k)
                weight -= (*inverse)[i][k] * value(forms_[active[k]], centre);
            for (std::size_t j = 0; j < 3; ++j) point[j] += weight * forms_[active[i]][j];
        }
        return point;
    }

    std::vector<Form> forms_, inner_forms_;  // q is the last
    std::vector<NearForm> near_forms_, near_inner_forms_;
    bool no_float_is_inside_;
};

}  // namespace

TEST_CASE("a sphere that just reaches an edge far from the origin is not outside") {
    // s = a (x - x of the edge) and t likewise, over q = 1: the rounding of a x is far above the ulp of a small
    // distance.
    Random random(47);
    int touching = 0;
    for (int i = 0; i < 20000; ++i) {
        const double a[2] = {random.uniform(0.1, 1.0), random.uniform(0.1, 1.0)};
        const glm::vec3 centre(random.uniform_float(1e6, 2e6), random.uniform_float(1e6, 2e6), 0.0f);
        glm::dmat4 matrix(0.0);
        Rational squared = 0;
        double distance = 0.0;
        for (int k = 0; k < 2; ++k) {
            matrix[k][k] = a[k];
            matrix[3][k] = -a[k] * (static_cast<double>(centre[k]) + random.uniform(0.05, 0.2));
            const Rational way = support::exactly(-matrix[3][k]) / support::exactly(a[k]) - support::exactly(centre[k]);
            squared += way * way;
            distance = std::hypot(distance, support::nearest<double>(way));
        }
        matrix[3][3] = 1.0;
        const float radius = support::to_float(distance);
        const Rational exact_radius = support::exactly(radius);
        if (exact_radius * exact_radius < squared) continue;
        ++touching;
        const Sphere sphere{centre, radius};
        REQUIRE_MESSAGE(coverage(WorldTexgen(matrix), texgen::whole_texture(), sphere) != Coverage::outside,
                        hex(sphere));
    }
    CHECK(touching > 5000);
}

TEST_CASE("no sphere is outside or inside that is not, and few of a scene are partial that could be outside") {
    Random random(43);
    Counts counts;
    int tested = 0, judged_partial = 0, clearly_inside = 0, clearly_outside = 0;
    const long total = count_of("TEXGEN_COVERAGE_SPHERES", 4000);
    long have_depth = 0;
    for (long scene = 0; 40 * scene < total; ++scene) {
        const Slide slide = scene % 3 == 2 ? hostile_slide(random) : ordinary_slide(random, scene % 6 == 0 ? 1e5 : 0.0);
        const DistanceJudge judge(Judge(slide.matrix, slide.region));
        const bool is_counted = scene % 3 != 2 && scene < 100;
        have_depth += slide.region.depth() ? 40 : 0;
        const glm::dvec3 apex = point_on(slide, 3, random, glm::dvec3(0.0));
        std::vector<Sphere> spheres;
        for (int i = 0; i < 40; ++i) {
            const double size = random.power_of_ten(-1.0, 1.3);
            const glm::dvec3 about =
                (scene % 6 == 0 ? apex : glm::dvec3(0.0)) + random.uniform(0.0, 40.0) * random.direction();
            Sphere sphere{glm::vec3(about), support::to_float(size)};
            if (i % 4 == 0) {  // touching a side, an edge or the apex as well as floats can
                const glm::dvec3 point = point_on(slide, random.integer(1, 3), random, about);
                const glm::dvec3 way = point - glm::dvec3(sphere.centre);
                const float distance = support::to_float(std::sqrt(way.x * way.x + way.y * way.y + way.z * way.z));
                sphere.radius = support::neighbour(distance, random.integer(-2, 2));
            }
            if (i % 4 == 2) {  // touching the nearest side
                double nearest = infinite;
                for (int i_side = 0; i_side < 2 * limited(slide.region); ++i_side) {
                    const int k = i_side / 2;
                    const double side = limits(slide.region, k)[random.integer(0, 1)];
                    glm::dvec4 f;
                    for (int j = 0; j < 4; ++j)
                        f[j] = std::isinf(side) ? slide.matrix[j][3] : slide.matrix[j][k] - side * slide.matrix[j][3];
                    const glm::dvec3 c(sphere.centre);
                    nearest = std::min(nearest, std::fabs(f.x * c.x + f.y * c.y + f.z * c.z + f.w) /
                                                    std::sqrt(f.x * f.x + f.y * f.y + f.z * f.z));
                }
                if (nearest < 1e6)
                    sphere.radius = support::neighbour(support::to_float(nearest), random.integer(-2, 2));
            }
            if (i % 20 == 1 || !(sphere.radius >= 0.0f && sphere.radius < infinity_float)) sphere.radius = 0.0f;
            spheres.push_back(sphere);
        }
        std::vector<Coverage> answers(spheres.size());
        const LitVolume<texgen::World> volume(WorldTexgen(slide.matrix), slide.region);
        volume.coverage(spheres, answers);
        for (std::size_t i = 0; i < spheres.size(); ++i) {
            const Sphere& sphere = spheres[i];
            std::string wrong;
            if (answers[i] == Coverage::outside) {
                ++counts.outside;
                if (is_a_region(slide.region) && !judge.is_surely_outside_a_plane(sphere) &&
                    !judge.is_outside_a_plane(sphere)) {
                    ++counts.separated;
                    if (!judge.is_surely_outside_an_edge(sphere) && judge.reaches(sphere)) wrong = "a false outside";
                }
            } else if (answers[i] == Coverage::inside) {
                ++counts.inside;
                if (!judge.is_surely_inside(sphere) && !judge.is_inside(sphere)) wrong = "a false inside";
            } else {
                ++counts.partial;
                if (is_counted && i % 2 != 0) {
                    ++judged_partial;
                    counts.false_partial += !judge.reaches(sphere);
                    Sphere a_little_larger = sphere;
                    a_little_larger.radius *= 1.0001f;
                    clearly_inside += judge.is_inside(a_little_larger);
                    clearly_outside += judge.is_outside_a_plane(a_little_larger);
                }
            }
            tested += is_counted && i % 2 != 0;
            if (volume.coverage(sphere) != answers[i]) wrong = "one sphere alone is something else";
            REQUIRE_MESSAGE(wrong.empty(), wrong << ": " << hex(slide) << ", " << hex(sphere));
        }
    }
    MESSAGE("of " << total << " spheres " << have_depth << " are of a region with a depth: outside " << counts.outside
                  << " (by a separating plane alone " << counts.separated << "), partial " << counts.partial
                  << ", inside " << counts.inside << "; of " << tested << " in ordinary scenes " << counts.false_partial
                  << " are falsely partial");
    CHECK(counts.separated > 10);
    CHECK(counts.inside > 50);
    CHECK(judged_partial > 50);
    CHECK(clearly_inside == 0);
    CHECK(clearly_outside == 0);
    CHECK(counts.false_partial * 100 < tested * 3);
}

TEST_CASE("a batch of spheres answers as the single question where sides of the slide are nearly one plane") {
    // A side at infinity is q, as s <= 1 nearly is: what weighs them is noise, and another one in vectors.
    const glm::dmat4 matrix{
        {0x1.551cd266a9d58p9, -0x1.3b81ebf445084p84, 0x1.af5955321f24cp46, -0x1.43d7e9a6db7b6p2},
        {0x1.4f991f25cfcc8p-19, 0x1.8af80740606cap-84, -0x1.00fe11fbbb954p94, 0x1.d5946c49badp70},
        {0x1.59aa370764aacp-13, -0x1.23db22a41ac28p-43, -0x1.a10589b706878p-66, 0x1.bbde6447d5fa8p42},
        {0x1.a3fdc30796fp-89, -0x1.413a26abfa0eap-8, 0x1.ae96da0e57f2p10, -0x1.4504a77b7fb68p49}};
    const TextureRegion region = atlas_tile({-infinite, 0.0}, {1.0, infinite}).with_depth(-0.144, infinite);
    const LitVolume<texgen::World> volume(WorldTexgen(matrix), region);
    std::vector<Sphere> spheres{{{-0x1.9ea102p-37f, -0x1.a5823ep-35f, -0x1.0fa61p-35f}, 0x1.cp0f}};
    Random random(1177);
    for (int i = 1; i < 4000; ++i)
        spheres.push_back({{random.uniform_float(-0x1p-34, 0x1p-34), random.uniform_float(-0x1p-34, 0x1p-34),
                            random.uniform_float(-0x1p-34, 0x1p-34)},
                           random.uniform_float(0.0, 4.0)});
    std::vector<Coverage> answers(spheres.size());
    volume.coverage(spheres, answers);
    int outside = 0;
    for (std::size_t i = 0; i < spheres.size(); ++i) {
        INFO(hex(spheres[i]));
        REQUIRE(answers[i] == volume.coverage(spheres[i]));
        outside += answers[i] == Coverage::outside;
    }
    CHECK(outside > 0);
}

}  // namespace coverage_cases
