// Points x, y, z to s, t, r, q, planar or interleaved.

#include <memory>
#include <string>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <glm/vec4.hpp>

#include "bench.hpp"
#include "points.hpp"

namespace bench {

namespace {

constexpr Eigen::Index block = 256;

// A scene with its points and its outputs.
class Generate {
public:
    Generate(std::size_t count, Layout layout) : points_(count, layout), scene_(scene_of("generate", points_)) {}

    const Points& points() const { return points_; }
    const Scene& scene() const { return scene_; }
    std::size_t size() const { return points_.size(); }

    float* coordinate(std::size_t k) const { return output(size(), k); }
    // Four outputs long.
    glm::vec4* strq() const { return reinterpret_cast<glm::vec4*>(output(size())); }

    // In texels: the error of the quotients that a shader would make of the values.
    void check(std::size_t i, Errors& errors, bool has_promise) const {
        for (std::size_t k = 0; k < size(); k += scene_.step()) {
            const Points::Exact exact = points_.exact(i, k);
            glm::vec4 computed;
            for (int row = 0; row < 4; ++row) {
                computed[row] = points_.is_planar() ? coordinate(static_cast<std::size_t>(row))[k] : strq()[k][row];
                const auto wanted = static_cast<double>(exact.value[row]);
                errors.add_ulp(computed[row], wanted);
                if (has_promise)
                    errors.check(computed[row], wanted,
                                 texgen::generate_error * static_cast<double>(exact.magnitude[row]));
            }
            for (int row = 0; row < 2; ++row)
                errors.add_texels(static_cast<double>(computed[row]) / computed.w - exact.quotient(row));
        }
    }

private:
    Points points_;
    Scene scene_;
};

void ours(const Generate& work, std::size_t i) {
    const Points& points = work.points();
    const auto span = [&](std::size_t k) { return std::span(work.coordinate(k), work.size()); };
    if (points.is_planar())
        texgen::generate(points.transform(i), points.positions(), {span(0), span(1), span(2), span(3)});
    else
        texgen::generate(points.transform(i), points.positions(), std::span(work.strq(), work.size()));
}

void glm_planar(const Generate& work, std::size_t i) {
    const glm::mat4 matrix = work.points().matrix(i);
    const float *x = work.points().axis(0), *y = work.points().axis(1), *z = work.points().axis(2);
    float *s = work.coordinate(0), *t = work.coordinate(1), *r = work.coordinate(2), *q = work.coordinate(3);
    for (std::size_t k = 0; k < work.size(); ++k) {
        const glm::vec4 strq = matrix * glm::vec4(x[k], y[k], z[k], 1.0f);
        s[k] = strq.x;
        t[k] = strq.y;
        r[k] = strq.z;
        q[k] = strq.w;
    }
}

void glm_interleaved(const Generate& work, std::size_t i) {
    const glm::mat4 matrix = work.points().matrix(i);
    const glm::vec3* vectors = work.points().vectors();
    glm::vec4* strq = work.strq();
    for (std::size_t k = 0; k < work.size(); ++k) strq[k] = matrix * glm::vec4(vectors[k], 1.0f);
}

void eigen_planar(const Generate& work, std::size_t i) {
    using Block = Eigen::Array<float, block, 1>;
    const Eigen::Matrix4f m = eigen_matrix(work.points(), i);
    const auto at = [&](const float* axis, std::size_t k) { return Eigen::Map<const Block>(axis + k); };
    for (std::size_t k = 0; k < work.size(); k += block) {
        const auto x = at(work.points().axis(0), k), y = at(work.points().axis(1), k), z = at(work.points().axis(2), k);
        for (Eigen::Index r = 0; r < 4; ++r)
            Eigen::Map<Block>(work.coordinate(static_cast<std::size_t>(r)) + k) =
                m(r, 0) * x + m(r, 1) * y + m(r, 2) * z + m(r, 3);
    }
}

void eigen_interleaved(const Generate& work, std::size_t i) {
    const auto count = static_cast<Eigen::Index>(work.size());
    const Eigen::Map<const Eigen::Matrix3Xf> points(&work.points().vectors()->x, 3, count);
    const Eigen::Matrix4f matrix = eigen_matrix(work.points(), i);
    Eigen::Map<Eigen::Matrix4Xf> strq(&work.strq()->x, 4, count);
    for (Eigen::Index k = 0; k < count; k += block)
        strq.middleCols<block>(k).noalias() = matrix * points.middleCols<block>(k).colwise().homogeneous();
}

void add_scene(std::size_t count, Layout layout) {
    const auto work = std::make_shared<Generate>(count, layout);
    const auto add = [&](const std::string& name, bool has_promise, auto run) {
        add_row(
            work->scene(), name, 0, [=](std::size_t i) { run(*work, i); },
            [=](std::size_t i, Errors& errors) { work->check(i, errors, has_promise); });
    };
    const bool is_planar = layout == Layout::planar;
    add("texgen", true, ours);
    add("GLM, mat4 * vec4", false, is_planar ? glm_planar : glm_interleaved);
    add(is_planar ? "Eigen, array blocks" : "Eigen, product", false, is_planar ? eigen_planar : eigen_interleaved);
    add_unchecked(work->scene(), "floor: four store streams", [=](std::size_t i) {
        const auto value = static_cast<float>(i);
        store(value, work->coordinate(0), work->coordinate(1), work->size());
        store(value, work->coordinate(2), work->coordinate(3), work->size());
    });
}

}  // namespace

void add_generate() {
    for (const Layout layout : {Layout::planar, Layout::interleaved})
        for (const std::size_t count : {l1_count, l2_count, dram_count}) add_scene(count, layout);
}

}  // namespace bench
