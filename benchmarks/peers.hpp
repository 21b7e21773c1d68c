#pragma once

// The loops that a user of GLM or Eigen writes, for the same input as texgen::interpolate. The constructor is the
// set-up of a triangle. Each skips nothing, and trusts its numbers.

#include <cstddef>

#include <Eigen/Core>
#include <Eigen/LU>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <texgen/primitives.hpp>

namespace report {

// Barycentric coordinates of each fragment, weighted by 1/w.
class GlmBarycentric {
public:
    explicit GlmBarycentric(const texgen::Triangle& triangle)
        : triangle_(triangle),
          area_(edge(triangle.a.window, triangle.b.window, triangle.c.window)),
          inverse_w_(1.0f / glm::vec3(triangle.a.clip_w, triangle.b.clip_w, triangle.c.clip_w)) {}

    // write(fragment, s/q, t/q, q) for each fragment of the rect.
    template <class Write>
    void operator()(const texgen::FragmentRect& rect, const Write& write) const {
        const auto& [a, b, c] = triangle_;
        std::size_t fragment = 0;
        for (int y = rect.y; y < rect.y + rect.height; ++y) {
            for (int x = rect.x; x < rect.x + rect.width; ++x, ++fragment) {
                const glm::vec2 centre(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
                glm::vec3 weights(edge(b.window, c.window, centre), edge(c.window, a.window, centre),
                                  edge(a.window, b.window, centre));
                weights *= inverse_w_ / area_;
                weights /= weights.x + weights.y + weights.z;
                const glm::vec4 strq = weights.x * a.strq + weights.y * b.strq + weights.z * c.strq;
                write(fragment, strq.x / strq.w, strq.y / strq.w, strq.w);
            }
        }
    }

private:
    static float edge(glm::vec2 from, glm::vec2 to, glm::vec2 point) {
        return (to.x - from.x) * (point.y - from.y) - (to.y - from.y) * (point.x - from.x);
    }

    texgen::Triangle triangle_;
    float area_;
    glm::vec3 inverse_w_;
};

// Plane equations of s/w, t/w and q/w over the window, in float or in double; 1/w cancels in the quotients.
template <class Scalar>
struct GlmPlanesIn {
    using Vector = glm::vec<3, Scalar>;
    Vector s, t, q;

    explicit GlmPlanesIn(const texgen::Triangle& triangle) {
        const auto& [a, b, c] = triangle;
        const auto plane_from_corners = glm::inverse(
            glm::transpose(glm::mat<3, 3, Scalar>(Vector(a.window, 1), Vector(b.window, 1), Vector(c.window, 1))));
        const Vector inverse_w = Scalar(1) / Vector(a.clip_w, b.clip_w, c.clip_w);
        s = plane_from_corners * (Vector(a.strq.x, b.strq.x, c.strq.x) * inverse_w);
        t = plane_from_corners * (Vector(a.strq.y, b.strq.y, c.strq.y) * inverse_w);
        q = plane_from_corners * (Vector(a.strq.w, b.strq.w, c.strq.w) * inverse_w);
    }

    // As above.
    template <class Write>
    void operator()(const texgen::FragmentRect& rect, const Write& write) const {
        std::size_t fragment = 0;
        for (int y = rect.y; y < rect.y + rect.height; ++y) {
            for (int x = rect.x; x < rect.x + rect.width; ++x, ++fragment) {
                const Vector centre(static_cast<Scalar>(x) + Scalar(0.5), static_cast<Scalar>(y) + Scalar(0.5), 1);
                const Scalar fragment_q = glm::dot(q, centre);
                write(fragment, static_cast<float>(glm::dot(s, centre) / fragment_q),
                      static_cast<float>(glm::dot(t, centre) / fragment_q), static_cast<float>(fragment_q));
            }
        }
    }
};
using GlmPlanes = GlmPlanesIn<float>;

// The same plane equations, a row of at most max_width fragments at a time in Eigen's arrays.
template <int max_width>
class EigenPlanes {
public:
    using Row = Eigen::Array<float, Eigen::Dynamic, 1, Eigen::ColMajor, max_width, 1>;

    explicit EigenPlanes(const texgen::Triangle& triangle) {
        const auto& [a, b, c] = triangle;
        Eigen::Matrix3f corners;
        corners << a.window.x, a.window.y, 1, b.window.x, b.window.y, 1, c.window.x, c.window.y, 1;
        Eigen::Matrix3f values;  // one corner a row: s, t, q
        values << a.strq.x, a.strq.y, a.strq.w, b.strq.x, b.strq.y, b.strq.w, c.strq.x, c.strq.y, c.strq.w;
        const Eigen::Vector3f w(a.clip_w, b.clip_w, c.clip_w);
        planes_ = corners.inverse() * w.cwiseInverse().asDiagonal() * values;
    }

    // finish(offset of the row, s, t, q) once s and t of the row are written.
    template <class Finish>
    void operator()(const texgen::FragmentRect& rect, float* s_out, float* t_out, const Finish& finish) const {
        const float first = static_cast<float>(rect.x) + 0.5f;
        const Row x = Row::LinSpaced(rect.width, first, first + static_cast<float>(rect.width - 1));
        for (int row = 0; row < rect.height; ++row) {
            const float y = static_cast<float>(rect.y + row) + 0.5f;
            const Eigen::RowVector3f start = y * planes_.row(1) + planes_.row(2);
            const Eigen::Index offset = static_cast<Eigen::Index>(row) * rect.width;
            Eigen::Map<Row> s(s_out + offset, rect.width);
            Eigen::Map<Row> t(t_out + offset, rect.width);
            const Row q = x * planes_(0, 2) + start(2);
            s = (x * planes_(0, 0) + start(0)) / q;
            t = (x * planes_(0, 1) + start(1)) / q;
            finish(offset, s, t, q);
        }
    }

private:
    Eigen::Matrix3f planes_;
};

}  // namespace report
