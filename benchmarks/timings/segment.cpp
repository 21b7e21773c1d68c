// A segment at an array of alpha to s, t, by the three options of the C_u note.

#include <memory>
#include <random>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <glm/common.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <texgen/interpolate.hpp>
#include <texgen/reference.hpp>

#include "bench.hpp"
#include "estimate.hpp"

namespace bench {

namespace {

constexpr Eigen::Index block = 256;
constexpr std::size_t segment_count = 8;

// A segment in space, and the projector's matrix. The elements and coordinates are so short that their products and
// sums are floats: the ends' (s, t, r, q) are exact, and every option has the same segment.
struct Projected {
    glm::mat4 texture_from_space;
    glm::vec3 a, b;

    texgen::Segment segment() const {
        return {texture_from_space * glm::vec4(a, 1), texture_from_space * glm::vec4(b, 1)};
    }
};

// (s, t, q) of the ends, s and t divided.
Projected projected(const glm::dvec3& position, const glm::dvec3& a, const glm::dvec3& b) {
    const glm::dmat4 bias(0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 0.5, 0, 0.5, 0.5, 0.5, 1);
    glm::dmat4 matrix =
        bias * glm::perspective(1.0, 1.0, 0.5, 100.0) * glm::lookAt(position, glm::dvec3(0), glm::dvec3(0, 1, 0));
    for (int column = 0; column < 4; ++column) matrix[column] = glm::round(matrix[column] * 64.0) / 64.0;
    const glm::dmat4 rows = glm::transpose(matrix);
    const auto point = [&](const glm::dvec3& stq) {
        const glm::dvec3 homogeneous(stq.x * stq.z, stq.y * stq.z, stq.z);
        const glm::dvec3 from_zero = homogeneous - glm::dvec3(rows[0].w, rows[1].w, rows[3].w);
        const glm::dmat3 stq_rows{glm::dvec3(rows[0]), glm::dvec3(rows[1]), glm::dvec3(rows[3])};
        return glm::vec3(glm::round(from_zero * glm::inverse(stq_rows) * 256.0) / 256.0);
    };
    return {glm::mat4(matrix), point(a), point(b)};
}

class Segments {
public:
    explicit Segments(std::size_t count)
        : scene_{std::string("segment, ") + (count == l1_count ? "1024" : "32768 (L2)"), segment_count, count} {
        std::mt19937 random(5);
        const auto between = [&](double low, double high) {
            return std::uniform_real_distribution<double>(low, high)(random);
        };
        for (std::size_t i = 0; i < segment_count; ++i) {
            const glm::dvec3 position(between(-2, 2), between(1, 3), between(3, 5));
            const glm::dvec3 a(between(0, 0.3), between(0, 0.3), between(1, 2));
            projected_.push_back(projected(position, a, glm::dvec3(between(0.7, 1), between(0.7, 1), between(1, 8))));
            segments_.push_back(projected_.back().segment());
        }
    }

    const Scene& scene() const { return scene_; }
    std::size_t size() const { return scene_.elements; }
    const Projected& in_space(std::size_t i) const { return projected_[i]; }
    const texgen::Segment& segment(std::size_t i) const { return segments_[i]; }
    const float* alpha() const { return input(size()); }
    float* s() const { return output(size(), 0); }
    float* t() const { return output(size(), 1); }

    void check(std::size_t i, Errors& errors) const {
        for (std::size_t k = 0; k < size(); k += scene_.step()) {
            const auto exact = texgen::reference::quotient<long double>(
                texgen::reference::strq<long double>(segments_[i], static_cast<long double>(alpha()[k])));
            errors.add(s()[k], static_cast<double>(exact[0]));
            errors.add(t()[k], static_cast<double>(exact[1]));
        }
    }

private:
    Scene scene_;
    std::vector<Projected> projected_;
    std::vector<texgen::Segment> segments_;
};

void ours(const Segments& work, std::size_t i, texgen::Tolerance tolerance) {
    texgen::interpolate(work.segment(i), std::span(work.alpha(), work.size()), texgen::whole_texture(),
                        {.s = {work.s(), work.size()}, .t = {work.t(), work.size()}, .r = {}, .lit = {}}, tolerance);
}

// mixed(alpha) is (s, t, r, q).
template <class Mixed>
void glm_loop(const Segments& work, const Mixed& mixed) {
    const float* alpha = work.alpha();
    float *s = work.s(), *t = work.t();
    for (std::size_t k = 0; k < work.size(); ++k) {
        const auto strq = mixed(alpha[k]);
        s[k] = static_cast<float>(strq.x / strq.w);
        t[k] = static_cast<float>(strq.y / strq.w);
    }
}

void glm_mix(const Segments& work, std::size_t i) {
    const texgen::Segment segment = work.segment(i);
    glm_loop(work, [&](float alpha) { return glm::mix(segment.a, segment.b, alpha); });
}

void double_mix(const Segments& work, std::size_t i) {
    const glm::dvec4 a(work.segment(i).a), b(work.segment(i).b);
    glm_loop(work, [&](float alpha) { return glm::mix(a, b, static_cast<double>(alpha)); });
}

void short_mix(const Segments& work, std::size_t i) {
    const texgen::Segment segment = work.segment(i);
    const glm::vec4 difference = segment.b - segment.a;
    glm_loop(work, [&](float alpha) { return segment.a + alpha * difference; });
}

void direct_projection(const Segments& work, std::size_t i) {
    const Projected projected = work.in_space(i);
    glm_loop(work, [&](float alpha) {
        return projected.texture_from_space * glm::vec4(glm::mix(projected.a, projected.b, alpha), 1.0f);
    });
}

void divided_ends(const Segments& work, std::size_t i) {
    const texgen::Segment segment = work.segment(i);
    const glm::vec4 a = segment.a / segment.a.w, b = segment.b / segment.b.w;
    const float* alpha = work.alpha();
    float *s = work.s(), *t = work.t();
    for (std::size_t k = 0; k < work.size(); ++k) {
        const glm::vec4 mixed = glm::mix(a, b, alpha[k]);
        s[k] = mixed.x;
        t[k] = mixed.y;
    }
}

void eigen_arrays(const Segments& work, std::size_t i) {
    using Block = Eigen::Array<float, block, 1>;
    const auto [a, b] = work.segment(i);
    for (std::size_t k = 0; k < work.size(); k += block) {
        const Eigen::Map<const Block> alpha(work.alpha() + k);
        const Block beta = 1.0f - alpha;
        const Block q = beta * a.w + alpha * b.w;
        Eigen::Map<Block>(work.s() + k) = (beta * a.x + alpha * b.x) / q;
        Eigen::Map<Block>(work.t() + k) = (beta * a.y + alpha * b.y) / q;
    }
}

#ifdef TEXGEN_BENCH_ESTIMATE
template <int newton_steps>
void estimated(const Segments& work, std::size_t i) {
    const auto [a, b] = work.segment(i);
    const float* alphas = work.alpha();
    float *s = work.s(), *t = work.t();
    for (std::size_t k = 0; k < work.size(); k += lane_count) {
        const Lanes alpha = load(alphas + k);
        const Lanes beta = 1.0f - alpha;
        const Lanes inverse_q = reciprocal<newton_steps>(beta * a.w + alpha * b.w);
        store(s + k, (beta * a.x + alpha * b.x) * inverse_q);
        store(t + k, (beta * a.y + alpha * b.y) * inverse_q);
    }
}
#endif

void add_scene(std::size_t count) {
    const auto work = std::make_shared<Segments>(count);
    const auto add = [&](const std::string& name, double tolerance, auto run) {
        add_row(
            work->scene(), name, tolerance, [=](std::size_t i) { run(*work, i); },
            [=](std::size_t i, Errors& errors) { work->check(i, errors); });
    };
    for (const NamedTolerance& given : tolerances)
        add(given.name, given.tolerance.value,
            [tolerance = given.tolerance](const Segments& segments, std::size_t i) { ours(segments, i, tolerance); });
    add("GLM, mix", promises_nothing, glm_mix);
    add("GLM, mix in double", promises_nothing, double_mix);
    add("GLM, mat4 * mix of points: option (1)", promises_nothing, direct_projection);
    add("Eigen, array blocks", promises_nothing, eigen_arrays);
    add("rejected: divided at the ends: option (3)", promises_nothing, divided_ends);
    add("rejected: A + a(B-A)", promises_nothing, short_mix);
#ifdef TEXGEN_BENCH_ESTIMATE
    add("rejected: rcp", promises_nothing, estimated<0>);
    add("rejected: rcp, a Newton step", promises_nothing, estimated<1>);
#endif
    add_unchecked(work->scene(), "floor: two store streams",
                  [=](std::size_t i) { store(static_cast<float>(i), work->s(), work->t(), work->size()); });
    add_unchecked(work->scene(), "floor: copying as many bytes", [=](std::size_t) {
        copy(work->alpha(), work->alpha(), work->alpha(), work->s(), work->t(), work->size());
    });
}

}  // namespace

void add_segment() {
    add_scene(l1_count);
    add_scene(l2_count);
}

}  // namespace bench
