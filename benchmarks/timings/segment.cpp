// A segment at an array of alpha to s, t.

#include <memory>
#include <random>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <glm/common.hpp>
#include <glm/vec4.hpp>
#include <texgen/interpolate.hpp>
#include <texgen/reference.hpp>

#include "bench.hpp"
#include "estimate.hpp"

namespace bench {

namespace {

constexpr Eigen::Index block = 256;
constexpr std::size_t segment_count = 8;

class Segments {
public:
    explicit Segments(std::size_t count)
        : scene_{std::string("segment, ") + (count == l1_count ? "1024" : "32768 (L2)"), segment_count, count} {
        std::mt19937 random(5);
        const auto between = [&](double low, double high) {
            return std::uniform_real_distribution<double>(low, high)(random);
        };
        const auto end = [&](double q, double s, double t) { return glm::vec4(s * q, t * q, 0.5 * q, q); };
        for (std::size_t i = 0; i < segment_count; ++i)
            segments_.push_back({end(between(1, 2), between(0, 0.3), between(0, 0.3)),
                                 end(between(1, 8), between(0.7, 1), between(0.7, 1))});
    }

    const Scene& scene() const { return scene_; }
    std::size_t size() const { return scene_.elements; }
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
        const glm::vec4 strq = mixed(alpha[k]);
        s[k] = strq.x / strq.w;
        t[k] = strq.y / strq.w;
    }
}

void glm_mix(const Segments& work, std::size_t i) {
    const texgen::Segment segment = work.segment(i);
    glm_loop(work, [&](float alpha) { return glm::mix(segment.a, segment.b, alpha); });
}

void short_mix(const Segments& work, std::size_t i) {
    const texgen::Segment segment = work.segment(i);
    const glm::vec4 difference = segment.b - segment.a;
    glm_loop(work, [&](float alpha) { return segment.a + alpha * difference; });
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
    for (const Stop& stop : dial)
        add(stop.name, stop.tolerance.value,
            [tolerance = stop.tolerance](const Segments& segments, std::size_t i) { ours(segments, i, tolerance); });
    add("GLM, mix", promises_nothing, glm_mix);
    add("Eigen, array blocks", promises_nothing, eigen_arrays);
    add("rejected: A + a(B-A)", promises_nothing, short_mix);
#ifdef TEXGEN_BENCH_ESTIMATE
    add("rejected: rcp", promises_nothing, estimated<0>);
    add("rejected: rcp, a Newton step", promises_nothing, estimated<1>);
#endif
    add_unchecked(work->scene(), "floor: two store streams",
                  [=](std::size_t i) { store(static_cast<float>(i), work->s(), work->t(), work->size()); });
}

}  // namespace

void add_segment() {
    add_scene(l1_count);
    add_scene(l2_count);
}

}  // namespace bench
