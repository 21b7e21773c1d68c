#pragma once

// What the benchmarks of points share: points in a projector's cone, and their exact coordinates.

#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <texgen/texcoord.hpp>

#include "bench.hpp"

namespace bench {

enum class Layout { planar, interleaved };
constexpr std::size_t matrix_count = 8;

// Points of the unit cube, one matrix after another that puts all of them on the slide, in front of the projector.
class Points {
public:
    Points(std::size_t count, Layout layout) : count_(count), layout_(layout) {
        for (std::size_t i = 0; i < matrix_count; ++i) {
            const auto turn = static_cast<float>(i);
            const glm::mat4 view = glm::lookAt(glm::vec3(0.3f * turn - 1.0f, 2.0f + 0.1f * turn, 4.5f - 0.2f * turn),
                                               glm::vec3(0.5f), glm::vec3(0.0f, 1.0f, 0.0f));
            const glm::mat4 bias(0.5f, 0, 0, 0, 0, 0.5f, 0, 0, 0, 0, 0.5f, 0, 0.5f, 0.5f, 0.5f, 1.0f);
            matrices_.push_back(bias * glm::perspective(0.6f, 1.0f, 0.5f, 100.0f) * view);
        }
    }

    std::size_t size() const { return count_; }
    bool is_planar() const { return layout_ == Layout::planar; }
    // By reference: the given floats are those in memory.
    const glm::mat4& matrix(std::size_t i) const { return matrices_[i]; }
    texgen::Transform<texgen::Texture, texgen::World> transform(std::size_t i) const {
        return texgen::Transform<texgen::Texture, texgen::World>(matrices_[i]);
    }

    const float* axis(std::size_t k) const { return input(count_, k); }
    const glm::vec3* vectors() const {
        input(count_, 2);
        return reinterpret_cast<const glm::vec3*>(input(count_));
    }
    texgen::Positions<texgen::World> positions() const {
        if (is_planar()) return texgen::world_space({axis(0), count_}, {axis(1), count_}, {axis(2), count_});
        return texgen::world_space(std::span(vectors(), count_));
    }

    struct Exact {
        long double value[4];
        long double magnitude[4];  // the sum of the terms without their signs
        double quotient(int row) const { return static_cast<double>(value[row] / value[3]); }
    };
    Exact exact(std::size_t i, std::size_t point) const {
        const glm::vec3 p = positions()[point];
        Exact exact{};
        for (int row = 0; row < 4; ++row) {
            const long double coordinate[4] = {p.x, p.y, p.z, 1};
            for (int column = 0; column < 4; ++column) {
                const long double term = coordinate[column] * matrices_[i][column][row];
                exact.value[row] += term;
                exact.magnitude[row] += std::fabs(term);
            }
        }
        return exact;
    }

private:
    std::size_t count_;
    Layout layout_;
    std::vector<glm::mat4> matrices_;
};

inline Eigen::Map<const Eigen::Matrix4f> eigen_matrix(const Points& points, std::size_t i) {
    return Eigen::Map<const Eigen::Matrix4f>(&points.matrix(i)[0][0]);
}

// The scenes of a workload: by size and layout. name is the workload's.
inline Scene scene_of(const std::string& name, const Points& points) {
    const char* size = points.size() == l1_count ? "1024" : points.size() == l2_count ? "32768 (L2)" : "16 M (DRAM)";
    return {name + (points.is_planar() ? " planar, " : " interleaved, ") + size,
            points.size() == dram_count ? 1 : matrix_count, points.size()};
}

}  // namespace bench
