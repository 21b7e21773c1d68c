// Points x, y, z to s/q, t/q, planar or interleaved to pairs.

#include <memory>
#include <string>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "bench.hpp"
#include "estimate.hpp"
#include "points.hpp"

namespace bench {

namespace {

constexpr Eigen::Index block = 256;

// A scene with its points and its outputs.
class Project {
public:
    Project(std::size_t count, Layout layout) : points_(count, layout), scene_(scene_of("project", points_)) {}

    const Points& points() const { return points_; }
    const Scene& scene() const { return scene_; }
    std::size_t size() const { return points_.size(); }

    float* s() const { return output(size(), 0); }
    float* t() const { return output(size(), 1); }
    // Two outputs long.
    glm::vec2* pairs() const { return reinterpret_cast<glm::vec2*>(output(size(), 0)); }

    void check(std::size_t i, Errors& errors) const {
        for (std::size_t k = 0; k < size(); k += scene_.step()) {
            const Points::Exact exact = points_.exact(i, k);
            const glm::vec2 computed = points_.is_planar() ? glm::vec2(s()[k], t()[k]) : pairs()[k];
            errors.add(computed.x, exact.quotient(0));
            errors.add(computed.y, exact.quotient(1));
        }
    }

private:
    Points points_;
    Scene scene_;
};

void project(const Project& work, std::size_t i, const texgen::Positions<texgen::World>& positions,
             texgen::Tolerance tolerance) {
    const Points& points = work.points();
    if (points.is_planar())
        texgen::project(points.transform(i), positions, texgen::whole_texture(),
                        {.s = {work.s(), work.size()}, .t = {work.t(), work.size()}, .r = {}, .lit = {}}, tolerance);
    else
        texgen::project(points.transform(i), positions, std::span(work.pairs(), work.size()), tolerance);
}

void ours(const Project& work, std::size_t i, texgen::Tolerance tolerance) {
    project(work, i, work.points().positions(), tolerance);
}

// With the box that the points are drawn from.
void ours_within(const Project& work, std::size_t i, texgen::Tolerance tolerance) {
    project(work, i, work.points().positions().within({glm::vec3(0.0f), glm::vec3(1.0f)}), tolerance);
}

// One at a time, of which the compiler makes no batch.
void ours_one_by_one(const Project& work, std::size_t i) {
    const auto transform = work.points().transform(i);
    const glm::vec3* vectors = work.points().vectors();
    for (std::size_t k = 0; k < work.size(); ++k) {
        work.pairs()[k] = texgen::project(transform, texgen::world_space(vectors[k])).value_or(glm::vec2(0.0f));
        benchmark::ClobberMemory();
    }
}

void glm_one_by_one(const Project& work, std::size_t i) {
    const glm::mat4 matrix = work.points().matrix(i);
    const glm::vec3* vectors = work.points().vectors();
    for (std::size_t k = 0; k < work.size(); ++k) {
        const glm::vec4 strq = matrix * glm::vec4(vectors[k], 1.0f);
        work.pairs()[k] = glm::vec2(strq) / strq.w;
        benchmark::ClobberMemory();
    }
}

template <class Scalar>
void glm_planar(const Project& work, std::size_t i) {
    const glm::mat<4, 4, Scalar> matrix(work.points().matrix(i));
    const float *x = work.points().axis(0), *y = work.points().axis(1), *z = work.points().axis(2);
    float *s = work.s(), *t = work.t();
    for (std::size_t k = 0; k < work.size(); ++k) {
        const glm::vec<4, Scalar> strq = matrix * glm::vec<4, Scalar>(x[k], y[k], z[k], 1);
        s[k] = static_cast<float>(strq.x / strq.w);
        t[k] = static_cast<float>(strq.y / strq.w);
    }
}

template <class Scalar>
void glm_interleaved(const Project& work, std::size_t i) {
    const glm::mat<4, 4, Scalar> matrix(work.points().matrix(i));
    const glm::vec3* vectors = work.points().vectors();
    glm::vec2* pairs = work.pairs();
    for (std::size_t k = 0; k < work.size(); ++k) {
        const glm::vec<4, Scalar> strq = matrix * glm::vec<4, Scalar>(vectors[k], 1);
        pairs[k] = glm::vec2(glm::vec<2, Scalar>(strq) / strq.w);
    }
}

void eigen_planar(const Project& work, std::size_t i) {
    using Block = Eigen::Array<float, block, 1>;
    const Eigen::Matrix4f m = eigen_matrix(work.points(), i);
    const auto at = [&](const float* axis, std::size_t k) { return Eigen::Map<const Block>(axis + k); };
    for (std::size_t k = 0; k < work.size(); k += block) {
        const auto x = at(work.points().axis(0), k), y = at(work.points().axis(1), k), z = at(work.points().axis(2), k);
        const Block q = m(3, 0) * x + m(3, 1) * y + m(3, 2) * z + m(3, 3);
        Eigen::Map<Block>(work.s() + k) = (m(0, 0) * x + m(0, 1) * y + m(0, 2) * z + m(0, 3)) / q;
        Eigen::Map<Block>(work.t() + k) = (m(1, 0) * x + m(1, 1) * y + m(1, 2) * z + m(1, 3)) / q;
    }
}

void eigen_interleaved(const Project& work, std::size_t i) {
    const auto count = static_cast<Eigen::Index>(work.size());
    const Eigen::Map<const Eigen::Matrix3Xf> points(&work.points().vectors()->x, 3, count);
    Eigen::Matrix<float, 3, 4> rows;
    rows << eigen_matrix(work.points(), i).topRows<2>(), eigen_matrix(work.points(), i).bottomRows<1>();
    Eigen::Map<Eigen::Matrix2Xf> pairs(&work.pairs()->x, 2, count);
    for (Eigen::Index k = 0; k < count; k += block)
        pairs.middleCols<block>(k) =
            (rows * points.middleCols<block>(k).colwise().homogeneous()).colwise().hnormalized();
}

#ifdef TEXGEN_BENCH_ESTIMATE
template <int newton_steps>
void estimate_planar(const Project& work, std::size_t i) {
    const glm::mat4 m = work.points().matrix(i);
    const float *x = work.points().axis(0), *y = work.points().axis(1), *z = work.points().axis(2);
    float *s = work.s(), *t = work.t();
    for (std::size_t k = 0; k < work.size(); k += lane_count) {
        const auto row = [&, at_x = load(x + k), at_y = load(y + k), at_z = load(z + k)](int r) {
            return m[0][r] * at_x + m[1][r] * at_y + m[2][r] * at_z + m[3][r];
        };
        const Lanes inverse_q = reciprocal<newton_steps>(row(3));
        store(s + k, row(0) * inverse_q);
        store(t + k, row(1) * inverse_q);
    }
}
#endif

void add_scene(std::size_t count, Layout layout) {
    const auto work = std::make_shared<Project>(count, layout);
    const auto add = [&](const std::string& name, double tolerance, auto run) {
        add_row(
            work->scene(), name, tolerance, [=](std::size_t i) { run(*work, i); },
            [=](std::size_t i, Errors& errors) { work->check(i, errors); });
    };
    for (const NamedTolerance& given : tolerances)
        add(given.name, given.tolerance.value,
            [tolerance = given.tolerance](const Project& project, std::size_t i) { ours(project, i, tolerance); });
    const bool is_planar = layout == Layout::planar;
    for (const NamedTolerance& given : {tolerances[0], tolerances[2]})
        add(std::string(given.name) + ", within a box", given.tolerance.value,
            [tolerance = given.tolerance](const Project& project, std::size_t i) {
                ours_within(project, i, tolerance);
            });
    if (!is_planar && count == l1_count) {
        add("texgen, exact, one by one", 0.0, ours_one_by_one);
        add("GLM, mat4 * vec4, one by one", promises_nothing, glm_one_by_one);
    }
    add("GLM, mat4 * vec4", promises_nothing, is_planar ? glm_planar<float> : glm_interleaved<float>);
    add("GLM, dmat4 * dvec4", promises_nothing, is_planar ? glm_planar<double> : glm_interleaved<double>);
    add(is_planar ? "Eigen, array blocks" : "Eigen, hnormalized", promises_nothing,
        is_planar ? eigen_planar : eigen_interleaved);
#ifdef TEXGEN_BENCH_ESTIMATE
    if (is_planar) {
        add("rejected: rcp", promises_nothing, estimate_planar<0>);
        add("rejected: rcp, a Newton step", promises_nothing, estimate_planar<1>);
    }
#endif
    add_unchecked(work->scene(), "floor: two store streams",
                  [=](std::size_t i) { store(static_cast<float>(i), work->s(), work->t(), work->size()); });
    add_unchecked(work->scene(), "floor: copying as many bytes", [=](std::size_t) {
        const Points& points = work->points();
        copy(points.axis(0), points.axis(1), points.axis(2), work->s(), work->t(), work->size());
    });
}

}  // namespace

void add_project() {
    for (const Layout layout : {Layout::planar, Layout::interleaved})
        for (const std::size_t count : {l1_count, l2_count, dram_count}) add_scene(count, layout);
}

}  // namespace bench
