// The fragments of rows and rects of a triangle to s, t.

#include <memory>
#include <random>
#include <vector>

#include <texgen/batch.hpp>
#include <texgen/interpolate.hpp>
#include <texgen/reference.hpp>

#include "../peers.hpp"
#include "bench.hpp"
#include "estimate.hpp"

namespace bench {

namespace {

using texgen::FragmentRect;
using texgen::Triangle;

std::size_t area(const FragmentRect& rect) {
    return static_cast<std::size_t>(rect.width) * static_cast<std::size_t>(rect.height);
}

struct Value {
    double s, t;
};

// Triangles, and a rect inside each.
struct Rows {
    Scene scene;
    bool times_set_up;
    std::vector<Triangle> triangles;
    std::vector<FragmentRect> rects;
    std::vector<std::vector<Value>> exact{};  // of the elements that are checked; filled when first needed

    void define() {
        if (!exact.empty()) return;
        for (std::size_t i = 0; i < scene.inputs; ++i) {
            auto& values = exact.emplace_back();
            for (std::size_t k = 0; k < scene.elements; k += scene.step()) {
                const auto width = static_cast<std::size_t>(rects[i].width);
                const auto quotient = texgen::reference::quotient<long double>(
                    texgen::reference::strq<long double>(triangles[i], rects[i].x + static_cast<int>(k % width) + 0.5L,
                                                         rects[i].y + static_cast<int>(k / width) + 0.5L));
                values.push_back({static_cast<double>(quotient[0]), static_cast<double>(quotient[1])});
            }
        }
    }
};

// The rect, and the legs of the right triangle around it. q/w grows by q_ratio from the right angle to the end of
// leg_x.
struct Shape {
    const char* name;
    int width, height;
    double leg_x, leg_y;
    double q_ratio;
    std::size_t inputs;
    bool times_set_up = false;
};

std::shared_ptr<Rows> make_rows(const Shape& shape) {
    std::mt19937 random(7);
    const auto between = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    auto rows = std::make_shared<Rows>(
        Rows{.scene = {"rows, " + std::string(shape.name), shape.inputs,
                       static_cast<std::size_t>(shape.width) * static_cast<std::size_t>(shape.height)},
             .times_set_up = shape.times_set_up,
             .triangles = {},
             .rects = {}});
    for (std::size_t i = 0; i < shape.inputs; ++i) {
        const double x = between(0, 100), y = between(0, 100);
        const auto vertex = [&](double at_x, double at_y, double q_over_w, double s, double t) {
            const double w = static_cast<float>(between(1, 4));
            const double q = w * q_over_w;
            return texgen::WindowVertex{glm::vec2(at_x, at_y), static_cast<float>(w),
                                        glm::vec4(s * q, t * q, 0.5 * q, q)};
        };
        // Without growth q/w is a power of 2, to be constant in float too.
        rows->triangles.push_back(
            {vertex(x, y, 2, between(0, 0.2), between(0, 0.2)),
             vertex(x + shape.leg_x, y, 2 * shape.q_ratio, between(0.8, 1), between(0, 0.3)),
             vertex(x, y + shape.leg_y, 2 * std::sqrt(shape.q_ratio), between(0, 0.3), between(0.8, 1))});
        // Anywhere in the lower left quarter where that has room, else in the corner.
        const auto offset = [&](double leg, int side) {
            return static_cast<int>(between(1, leg > 8 * side && side < 16 ? leg / 2 - side : 2));
        };
        rows->rects.push_back({static_cast<int>(x) + offset(shape.leg_x, shape.width),
                               static_cast<int>(y) + offset(shape.leg_y, shape.height), shape.width, shape.height});
    }
    return rows;
}

struct Ours {
    std::optional<texgen::TriangleSetup> setup;
    void operator()(const FragmentRect& rect, float* s, float* t) const {
        if (!setup) fail("rows: a triangle was refused");
        texgen::interpolate(*setup, rect, {.s = {s, area(rect)}, .t = {t, area(rect)}, .r = {}, .lit = {}});
    }
};

template <class Peer>
struct GlmLoop {
    Peer peer;
    explicit GlmLoop(const Triangle& triangle) : peer(triangle) {}
    void operator()(const FragmentRect& rect, float* s, float* t) const {
        peer(rect, [&](std::size_t i, float fragment_s, float fragment_t, float) {
            s[i] = fragment_s;
            t[i] = fragment_t;
        });
    }
};

// The C_u note's option (3) over a triangle: the quotients of its vertices, interpolated as ordinary coordinates are.
struct DividedAtVertices : GlmLoop<report::GlmPlanes> {
    explicit DividedAtVertices(Triangle triangle) : GlmLoop(divided(triangle)) {}
    static const Triangle& divided(Triangle& triangle) {
        for (texgen::WindowVertex* vertex : {&triangle.a, &triangle.b, &triangle.c}) vertex->strq /= vertex->strq.w;
        return triangle;
    }
};

struct EigenRows {
    report::EigenPlanes<4096> peer;
    explicit EigenRows(const Triangle& triangle) : peer(triangle) {}
    void operator()(const FragmentRect& rect, float* s, float* t) const {
        peer(rect, s, t, [](const auto&...) {});
    }
};

// s, t, q at the first fragment of a row, then a step of x further each.
glm::vec3 first_of_row(const report::GlmPlanes& planes, const FragmentRect& rect, int row) {
    const glm::vec3 centre(static_cast<float>(rect.x) + 0.5f, static_cast<float>(rect.y + row) + 0.5f, 1.0f);
    return {glm::dot(planes.s, centre), glm::dot(planes.t, centre), glm::dot(planes.q, centre)};
}
glm::vec3 step_of_x(const report::GlmPlanes& planes) { return {planes.s.x, planes.t.x, planes.q.x}; }

struct ForwardDifferences {
    report::GlmPlanes planes;
    explicit ForwardDifferences(const Triangle& triangle) : planes(triangle) {}
    void operator()(const FragmentRect& rect, float* s, float* t) const {
        const glm::vec3 step = step_of_x(planes);
        for (int row = 0; row < rect.height; ++row) {
            glm::vec3 at = first_of_row(planes, rect, row);
            for (int i = 0; i < rect.width; ++i, at += step) {
                *s++ = at.x / at.z;
                *t++ = at.y / at.z;
            }
        }
    }
};

// A true division every 16 fragments, and the line between.
struct DivisionEvery16 {
    report::GlmPlanes planes;
    explicit DivisionEvery16(const Triangle& triangle) : planes(triangle) {}
    void operator()(const FragmentRect& rect, float* s, float* t) const {
        const glm::vec3 step = step_of_x(planes);
        for (int row = 0; row < rect.height; ++row, s += rect.width, t += rect.width) {
            const glm::vec3 first = first_of_row(planes, rect, row);
            glm::vec2 left(first.x / first.z, first.y / first.z);
            for (int begin = 0; begin < rect.width; begin += 16) {
                const int length = rect.width - begin < 16 ? rect.width - begin : 16;
                const glm::vec3 at = first + static_cast<float>(begin + length) * step;
                const glm::vec2 right(at.x / at.z, at.y / at.z);
                const glm::vec2 slope = (right - left) / static_cast<float>(length);
                for (int i = 0; i < length; ++i) {
                    s[begin + i] = left.x + static_cast<float>(i) * slope.x;
                    t[begin + i] = left.y + static_cast<float>(i) * slope.y;
                }
                left = right;
            }
        }
    }
};

#ifdef TEXGEN_BENCH_ESTIMATE
// Rects whose width is a multiple of the lanes.
template <int newton_steps>
struct Estimate {
    report::GlmPlanes planes;
    explicit Estimate(const Triangle& triangle) : planes(triangle) {}
    void operator()(const FragmentRect& rect, float* s, float* t) const {
        const glm::vec3 step = step_of_x(planes);
        float counted[lane_count];
        for (std::size_t i = 0; i < lane_count; ++i) counted[i] = static_cast<float>(i);
        const auto width = static_cast<std::size_t>(rect.width);
        for (int row = 0; row < rect.height; ++row, s += width, t += width) {
            const glm::vec3 first = first_of_row(planes, rect, row);
            for (std::size_t i = 0; i < width; i += lane_count) {
                const Lanes x = load(counted) + static_cast<float>(i);
                const Lanes inverse_q = reciprocal<newton_steps>(first.z + step.z * x);
                store(s + i, (first.x + step.x * x) * inverse_q);
                store(t + i, (first.y + step.y * x) * inverse_q);
            }
        }
    }
};
#endif

// make(triangle) is the set-up; what it returns is called with a rect and the two outputs.
template <class Make>
void add_method(const std::shared_ptr<Rows>& rows, const std::string& name, double tolerance, Make make) {
    const std::size_t count = rows->scene.elements;
    const auto check = [=](std::size_t i, Errors& errors) {
        rows->define();
        for (std::size_t k = 0; k < rows->exact[i].size(); ++k) {
            errors.add(output(count, 0)[k * rows->scene.step()], rows->exact[i][k].s);
            errors.add(output(count, 1)[k * rows->scene.step()], rows->exact[i][k].t);
        }
    };
    if (rows->times_set_up) {
        const auto run = [=](std::size_t i) {
            make(rows->triangles[i])(rows->rects[i], output(count, 0), output(count, 1));
        };
        return add_row(rows->scene, name, tolerance, run, check);
    }
    std::vector<decltype(make(rows->triangles[0]))> methods;
    methods.reserve(rows->triangles.size());
    for (const Triangle& triangle : rows->triangles) methods.push_back(make(triangle));
    const auto run = [=](std::size_t i) { methods[i](rows->rects[i], output(count, 0), output(count, 1)); };
    add_row(rows->scene, name, tolerance, run, check);
}

// All triangles at once, timed with the first.
void add_batch(const std::shared_ptr<Rows>& rows) {
    for (const NamedTolerance& given : tolerances) {
        const std::size_t count = rows->scene.elements;
        const std::size_t all = count * rows->scene.inputs;
        auto batch = std::make_shared<texgen::TriangleBatch>(texgen::whole_texture(), given.tolerance);
        const auto run = [=](std::size_t i) {
            if (i != 0) return;
            batch->assign(rows->triangles);
            texgen::interpolate(*batch, rows->rects,
                                {.s = {output(all, 0), all}, .t = {output(all, 1), all}, .r = {}, .lit = {}});
        };
        const auto check = [=](std::size_t i, Errors& errors) {
            rows->define();
            run(0);
            for (std::size_t k = 0; k < count; ++k) {
                errors.add(output(all, 0)[i * count + k], rows->exact[i][k].s);
                errors.add(output(all, 1)[i * count + k], rows->exact[i][k].t);
            }
        };
        add_row(rows->scene, std::string(given.name) + ", in a batch", given.tolerance.value, run, check);
    }
}

template <class Method>
void add_peer(const std::shared_ptr<Rows>& rows, const std::string& name) {
    add_method(rows, name, promises_nothing, [](const Triangle& triangle) { return Method(triangle); });
}

void add_scene(const Shape& shape) {
    const std::shared_ptr<Rows> rows = make_rows(shape);
    for (const NamedTolerance& given : tolerances) {
        add_method(rows, given.name, given.tolerance.value, [tolerance = given.tolerance](const Triangle& triangle) {
            return Ours{texgen::TriangleSetup::of(triangle, texgen::whole_texture(), tolerance)};
        });
    }
    if (shape.times_set_up) add_batch(rows);
    add_peer<GlmLoop<report::GlmPlanes>>(rows, "GLM, plane equations");
    add_peer<GlmLoop<report::GlmBarycentric>>(rows, "GLM, barycentric");
    add_peer<GlmLoop<report::GlmPlanesIn<double>>>(rows, "GLM, plane equations in double");
    add_peer<EigenRows>(rows, "Eigen, plane equations in arrays");
    add_peer<DividedAtVertices>(rows, "rejected: divided at the vertices: option (3)");
    add_peer<ForwardDifferences>(rows, "rejected: forward differences");
    add_peer<DivisionEvery16>(rows, "rejected: division every 16");
#ifdef TEXGEN_BENCH_ESTIMATE
    if (static_cast<std::size_t>(shape.width) % lane_count == 0) {
        add_peer<Estimate<0>>(rows, "rejected: rcp");
        add_peer<Estimate<1>>(rows, "rejected: rcp, a Newton step");
    }
#endif
    const std::size_t count = rows->scene.elements;
    add_unchecked(rows->scene, "floor: two store streams",
                  [count](std::size_t i) { store(static_cast<float>(i), output(count, 0), output(count, 1), count); });
}

// The set-up alone; an element is a triangle.
void add_set_up(const Shape& shape) {
    const std::shared_ptr<Rows> rows = make_rows(shape);
    const Scene scene{rows->scene.name, rows->scene.inputs, 1};
    for (const NamedTolerance& given : tolerances) {
        add_unchecked(scene, given.name, [=, tolerance = given.tolerance](std::size_t i) {
            auto setup = texgen::TriangleSetup::of(rows->triangles[i], texgen::whole_texture(), tolerance);
            benchmark::DoNotOptimize(&setup);
        });
    }
    add_unchecked(scene, "GLM, plane equations", [=](std::size_t i) {
        report::GlmPlanes planes(rows->triangles[i]);
        benchmark::DoNotOptimize(&planes);
    });
}

}  // namespace

void add_rows() {
    Shape row{.name = "", .width = 1024, .height = 1, .leg_x = 1080, .leg_y = 1000, .q_ratio = 1.3, .inputs = 16};
    const auto add_ratios = [&row](const char* gentle, const char* steep, const char* parallel) {
        for (const auto& [name, ratio] : {std::pair{gentle, 1.3}, std::pair{steep, 30.0}, std::pair{parallel, 1.0}}) {
            row.name = name;
            row.q_ratio = ratio;
            add_scene(row);
        }
    };
    add_ratios("1024x1, q/w by 1.3", "1024x1, q/w by 30", "1024x1, parallel");
    row.height = 4;
    row.inputs = 8;
    add_ratios("1024x4, q/w by 1.3", "1024x4, q/w by 30", "1024x4, parallel");

    Shape small{.name = "triangles of 64x1 with set-up",
                .width = 64,
                .height = 1,
                .leg_x = 90,
                .leg_y = 30,
                .q_ratio = 1.3,
                .inputs = 32,
                .times_set_up = true};
    add_scene(small);
    small = {"triangles of 8x8 with set-up", 8, 8, 24, 24, 1.3, 32, true};
    add_scene(small);
    add_scene({"8x8 of a large triangle", 8, 8, 1000, 1000, 1.3, 32});
    small.name = "set-up alone";
    add_set_up(small);
    add_scene({"DRAM, 4096x4096, q/w by 1.3", 4096, 4096, 8300, 8300, 1.3, 1});
}

}  // namespace bench
