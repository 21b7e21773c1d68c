#pragma once

// Every public function as a workload: a call with an ordinary input, and with inputs that are meant to take long. An
// input is a list of numbers, floats first and doubles after them, so that a search can change their bits and print
// them.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "support/limits.hpp"
#include "support/near_cut.hpp"
#include "support/random.hpp"
#include "support/stopwatch.hpp"
#include "support/triangles.hpp"
#include "texgen/batch.hpp"
#include "texgen/clip.hpp"
#include "texgen/coverage.hpp"
#include "texgen/diagnose.hpp"
#include "texgen/eigen.hpp"
#include "texgen/fixed_function.hpp"
#include "texgen/footprint.hpp"
#include "texgen/interpolate.hpp"
#include "texgen/linear.hpp"
#include "texgen/projector.hpp"
#include "texgen/scale_bias.hpp"
#include "texgen/scene.hpp"
#include "texgen/surface.hpp"
#include "texgen/texcoord.hpp"

namespace support {

using Numbers = std::vector<double>;

// Inputs that are meant to take long, where a search begins.
struct Hostile {
    Numbers (*draw)(Random&);
    const char* words;
};

struct Workload {
    const char* function;
    std::size_t floats;            // as many of an input's numbers
    Numbers (*ordinary)(Random&);  // what a user's program gives it
    Hostile hostile;
    Calls (*calls)(const Numbers&);  // empty where the numbers break a precondition, or there is nothing to do
    double (*limit)(const Numbers&);

    // Interpolates 64 x 4 fragments of a triangle.
    bool takes_near_cuts() const {
        const std::string_view name = function;
        return name.starts_with("interpolate a triangle") && name.ends_with("64 x 4");
    }
};

namespace detail {

// Takes numbers one after another.
class Reader {
public:
    explicit Reader(const Numbers& numbers) : next_(numbers.data()) {}

    double real() { return *next_++; }
    float single() { return to_float(real()); }
    glm::vec2 vec2() { return {single(), single()}; }
    glm::vec3 vec3() {
        const float x = single(), y = single(), z = single();
        return {x, y, z};
    }
    glm::vec4 vec4() {
        const float x = single(), y = single(), z = single(), w = single();
        return {x, y, z, w};
    }
    glm::dvec3 dvec3() {
        const double x = real(), y = real(), z = real();
        return {x, y, z};
    }
    glm::dvec4 dvec4() {
        const double x = real(), y = real(), z = real(), w = real();
        return {x, y, z, w};
    }
    glm::dmat4 dmat4() {
        const glm::dvec4 a = dvec4(), b = dvec4(), c = dvec4(), d = dvec4();
        return {a, b, c, d};
    }
    glm::mat4 mat4() { return rounded(dmat4()); }

private:
    const double* next_;
};

inline void put(Numbers& n, float x) { n.push_back(static_cast<double>(x)); }
inline void put(Numbers& n, double x) { n.push_back(x); }
template <glm::length_t N, class T, glm::qualifier Q>
void put(Numbers& n, const glm::vec<N, T, Q>& v) {
    for (glm::length_t i = 0; i < N; ++i) put(n, v[i]);
}
template <class T, glm::qualifier Q>
void put(Numbers& n, const glm::mat<4, 4, T, Q>& m) {
    for (glm::length_t i = 0; i < 4; ++i) put(n, m[i]);
}
inline void put(Numbers& n, const texgen::Triangle& t) {
    for (const texgen::WindowVertex* v : {&t.a, &t.b, &t.c}) {
        put(n, v->window);
        put(n, v->clip_w);
        put(n, v->strq);
    }
}
template <class... Parts>
Numbers numbers(const Parts&... parts) {
    Numbers n;
    (put(n, parts), ...);
    return n;
}

inline double always(const Numbers&) { return limit::any; }
inline double of_touching(const Numbers&) { return limit::touching; }

// Numbers without a meaning

inline double any_float(Random& random) {
    const double sign = random.coin() ? 1.0 : -1.0;
    switch (random.integer(0, 9)) {
        case 0:
            return sign * static_cast<double>(to_float(random.power_of_ten(-44.0, 38.0)));
        case 1:
        case 2:
            return sign * static_cast<double>(to_float(random.power_of_ten(-6.0, 6.0)));
        case 3:
        case 4:
        case 5:
            return 0.125 * static_cast<double>(random.integer(-16, 16));
        default:
            return static_cast<double>(random.uniform_float(-2.0, 2.0));
    }
}
template <std::size_t Count>
Numbers any_numbers(Random& random) {
    Numbers n(Count);
    for (double& x : n) x = any_float(random);
    return n;
}

template <std::size_t Count>
inline constexpr Hostile hostile_numbers{any_numbers<Count>, "drawn: any numbers"};

// Projectors

inline texgen::Aim ordinary_aim(Random& random) {
    const glm::dvec3 position = 4.0 * random.direction();
    return {position, 0.3 * random.direction(), glm::dvec3(0.1, 1.0, 0.2)};
}
inline texgen::Projector ordinary_projector(Random& random) {
    const texgen::PerspectiveLens lens{texgen::degrees(random.uniform(30.0, 60.0)), 1.3, 0.5, 100.0};
    return texgen::make_projector(lens, ordinary_aim(random), texgen::opengl).value();
}
inline glm::dmat4 ordinary_texgen(Random& random) {
    return texgen::texture_from_world(ordinary_projector(random)).matrix();
}
// Along the axes, with small numbers: s = x / 8 + 1/2.
inline glm::dmat4 aligned_texgen(Random& random) {
    const double half = std::ldexp(1.0, random.integer(-1, 3));
    const texgen::OrthographicLens lens{-half, half, -half, half, 0.0, 16.0};
    const texgen::Aim aim{{0.0, 0.0, 8.0}, {0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}};
    const texgen::PerspectiveLens open{texgen::degrees(90.0), 1.0, 0.5, 64.0};
    return texgen::texture_from_world(random.coin() ? texgen::make_projector(lens, aim, texgen::opengl).value()
                                                    : texgen::make_projector(open, aim, texgen::opengl).value())
        .matrix();
}
inline glm::dmat4 drawn_texgen(Random& random) {
    switch (random.integer(0, 3)) {
        case 0:
            return ordinary_texgen(random);
        case 1: {
            glm::dmat4 m(0.0);
            for (int i = 0; i < 4; ++i)
                for (int k = 0; k < 4; ++k) m[i][k] = any_float(random);
            return m;
        }
        default:
            return aligned_texgen(random);
    }
}

// Numbers of a scene

// What the limits are about: positions and coordinates of a world, of a camera and of slides as they are. Beyond, where
// floats of all sizes meet in one sum, ties may differ from their middle by less than two doubles hold, and are decided
// one by one.
template <class Number>
bool is_between(Number value, double least, double largest) {
    const double size = std::fabs(static_cast<double>(value));
    return size == 0.0 || (size >= least && size <= largest);
}
template <glm::length_t N, class T, glm::qualifier Q>
bool is_between(const glm::vec<N, T, Q>& v, double least, double largest) {
    bool all = true;
    for (glm::length_t i = 0; i < N; ++i) all = all && is_between(v[i], least, largest);
    return all;
}
// A position, or a coordinate.
template <class Value>
bool is_of_a_scene(const Value& value) {
    return is_between(value, 0x1p-20, 0x1p20);
}
// A matrix, whose zeros may be what rounding makes of them.
inline bool is_of_a_scene(const glm::dmat4& matrix) {
    bool all = true;
    for (glm::length_t i = 0; i < 4; ++i) all = all && is_between(matrix[i], 0x1p-60, 0x1p30);
    return all;
}

// Points

inline constexpr std::size_t pattern = 8;

// Points that repeat until there are `Count`.
template <std::size_t Count>
std::vector<glm::vec3> points_of(Reader& reader) {
    std::vector<glm::vec3> points;
    for (std::size_t i = 0; i < Count; ++i) points.push_back(i < pattern ? reader.vec3() : points[i - pattern]);
    for (std::size_t i = Count; i < pattern; ++i) reader.vec3();
    return points;
}
inline Numbers ordinary_points(Random& random) {
    Numbers n;
    for (std::size_t i = 0; i < pattern; ++i) put(n, random.vector3(1.0));
    put(n, ordinary_texgen(random));
    return n;
}
inline Numbers draw_points(Random& random) {
    Numbers n;
    const glm::dmat4 texgen = drawn_texgen(random);
    for (std::size_t i = 0; i < pattern; ++i) {
        glm::vec3 point = random.coin() ? random.vector3(2.0) : glm::vec3(0.0f);
        if (random.coin()) point = random.vector3(4.0);
        if (random.integer(0, 31) == 0) point.y = std::numeric_limits<float>::quiet_NaN();
        if (random.integer(0, 3) == 0)
            for (int k = 0; k < 3; ++k) point[k] = to_float(any_float(random));
        // On q = 0, but for the rounding.
        if (random.integer(0, 3) == 0 && texgen[2].w != 0.0)
            point.z = to_float(-(texgen[3].w + texgen[0].w * point.x + texgen[1].w * point.y) / texgen[2].w);
        put(n, point);
    }
    put(n, texgen);
    return n;
}
inline constexpr Hostile hostile_points{
    draw_points, "drawn: points of any size, next to q = 0 or NaN, under an aligned projector or any matrix"};

struct PointBatch {
    std::vector<glm::vec3> points;
    texgen::WorldTexgen texgen;
    std::vector<float> out[4];
    std::vector<glm::vec4> strq;
    std::vector<float> xyz[3];
};
template <std::size_t Count>
std::shared_ptr<PointBatch> batch_of(const Numbers& n) {
    Reader reader(n);
    std::vector<glm::vec3> points = points_of<Count>(reader);
    auto batch =
        std::make_shared<PointBatch>(PointBatch{std::move(points), texgen::WorldTexgen(reader.dmat4()), {}, {}, {}});
    for (std::vector<float>& out : batch->out) out.resize(Count);
    batch->strq.resize(Count);
    return batch;
}

inline constexpr texgen::Tolerance tolerance = texgen::texels(1.0 / 512.0, 4096.0);

inline bool is_of_a_scene(const PointBatch& batch) {
    return is_of_a_scene(batch.texgen.matrix()) &&
           std::all_of(batch.points.begin(), batch.points.end(), [](const glm::vec3& p) { return is_of_a_scene(p); });
}
inline texgen::TextureRegion wide_open() { return texgen::atlas_tile({-1e30, -1e30}, {1e30, 1e30}); }
// Whose depth begins at the r of ordinary coordinates, so that r alone can tell.
inline texgen::TextureRegion wide_open_from_half() { return wide_open().with_depth(0.5, 1.0); }

// What is asked of points and segments.
enum class Outputs { all, lit, r, pairs };
struct Asked {
    bool is_exact = true, has_depth = false, is_within = false, is_planar = false;
    Outputs outputs = Outputs::all;

    constexpr texgen::Tolerance tolerance() const { return is_exact ? texgen::exact : detail::tolerance; }
    texgen::TextureRegion region() const { return has_depth ? wide_open_from_half() : texgen::whole_texture(); }
    texgen::Texcoords texcoords(std::vector<float> (&out)[4]) const {
        const auto span = [&](std::size_t i, Outputs alone) {
            return outputs == Outputs::all || outputs == alone ? std::span<float>(out[i]) : std::span<float>();
        };
        return {span(0, Outputs::all), span(1, Outputs::all), span(2, Outputs::r), span(3, Outputs::lit)};
    }
};

template <std::size_t Count, Asked Asks = Asked{}>
Calls project_calls(const Numbers& n) {
    const auto batch = batch_of<Count>(n);
    if (!is_of_a_scene(*batch)) return {};
    const std::vector<glm::vec3>& points = batch->points;
    texgen::Box box{points[0], points[0]};
    for (std::size_t i = 0; i < Count; ++i) {
        for (int k = 0; k < 3; ++k) {
            if (Asks.is_within && std::isnan(points[i][k])) return {};
            box.min[k] = std::min(box.min[k], points[i][k]);
            box.max[k] = std::max(box.max[k], points[i][k]);
            batch->xyz[k].push_back(points[i][k]);
        }
    }
    auto positions =
        Asks.is_planar ? texgen::world_space(batch->xyz[0], batch->xyz[1], batch->xyz[2]) : texgen::world_space(points);
    if (Asks.is_within) positions = positions.within(box);
    return calls_of([batch, positions, st = std::vector<glm::vec2>(Count)]() mutable {
        if constexpr (Asks.outputs == Outputs::pairs)
            texgen::project(batch->texgen, positions, st, Asks.tolerance());
        else
            texgen::project(batch->texgen, positions, Asks.region(), Asks.texcoords(batch->out), Asks.tolerance());
    });
}
inline Calls project_point_calls(const Numbers& n) {
    const auto batch = batch_of<1>(n);
    if (!is_of_a_scene(*batch)) return {};
    return calls_of([batch] { keep(texgen::project(batch->texgen, texgen::world_space(batch->points[0]))); });
}
template <std::size_t Count>
Calls generate_calls(const Numbers& n) {
    return calls_of([batch = batch_of<Count>(n)] {
        texgen::generate(batch->texgen, texgen::world_space(batch->points), batch->strq);
    });
}
template <std::size_t Count>
Calls generate_planar_calls(const Numbers& n) {
    return calls_of([batch = batch_of<Count>(n)] {
        auto& out = batch->out;
        texgen::generate(batch->texgen, texgen::world_space(batch->points),
                         texgen::HomogeneousTexcoords{.s = out[0], .t = out[1], .r = out[2], .q = out[3]});
    });
}
inline Calls project_bound_calls(const Numbers& n) {
    return calls_of([batch = batch_of<1024>(n)] {
        keep(texgen::project_error_bound(batch->texgen, texgen::world_space(batch->points), tolerance));
    });
}
inline Calls generate_bound_calls(const Numbers& n) {
    return calls_of([batch = batch_of<1024>(n)] {
        keep(texgen::generate_error_bound(batch->texgen, texgen::world_space(batch->points)));
    });
}
inline Calls divide_calls(const Numbers& n) {
    return calls_of([strq = Reader(n).vec4()] { keep(texgen::divide(strq)); });
}
inline Numbers ordinary_strq(Random& random) {
    const float q = random.uniform_float(1.0, 4.0);
    return numbers(q * random.uniform_float(0.2, 0.8), q * random.uniform_float(0.2, 0.8), 0.5f * q, q);
}

// Segments

inline Numbers ordinary_segment(Random& random) {
    Numbers n = ordinary_strq(random);
    for (const double x : ordinary_strq(random)) n.push_back(x);
    for (std::size_t i = 0; i < pattern; ++i) put(n, random.uniform_float(0.0, 1.0));
    return n;
}
inline Numbers draw_segment(Random& random) {
    Numbers n = random.coin() ? any_numbers<8>(random) : ordinary_segment(random);
    n.resize(8);
    if (random.coin()) n[3] = n[7] = 1.0;
    if (random.integer(0, 2) == 0) {
        n = {0.5, 0.25, 0.0, 1.0, 0.75, 0.75, 0.0, 1.0};
        for (std::size_t i = 0; i < pattern; ++i) n.push_back(std::ldexp(2 * random.integer(0, 0x7fffff) + 1, -24));
        return n;
    }
    for (std::size_t i = 0; i < pattern; ++i)
        n.push_back(random.coin() ? static_cast<double>(random.uniform_float(0.0, 1.0))
                                  : static_cast<double>(to_float(n[3] / (n[3] - n[7]))));
    return n;
}
inline constexpr Hostile hostile_segment{draw_segment,
                                         "drawn: halves between floats, alphas next to the root of q, or any numbers"};

template <std::size_t Count, Asked Asks = Asked{}>
Calls segment_calls(const Numbers& n) {
    struct Job {
        texgen::Segment segment;
        std::vector<float> alpha;
        std::vector<float> out[4];
    };
    Reader reader(n);
    const auto job = std::make_shared<Job>();
    job->segment.a = reader.vec4();
    job->segment.b = reader.vec4();
    for (std::size_t i = 0; i < Count; ++i)
        job->alpha.push_back(i < pattern ? reader.single() : job->alpha[i - pattern]);
    for (const float alpha : job->alpha)
        if (!(alpha >= 0.0f && alpha <= 1.0f && is_of_a_scene(alpha))) return {};
    if (!is_of_a_scene(job->segment.a) || !is_of_a_scene(job->segment.b)) return {};
    for (std::vector<float>& out : job->out) out.resize(Count);
    return calls_of([job] {
        texgen::interpolate(job->segment, job->alpha, Asks.region(), Asks.texcoords(job->out), Asks.tolerance());
    });
}
inline texgen::Segment segment_of(const Numbers& n) {
    Reader reader(n);
    const glm::vec4 a = reader.vec4(), b = reader.vec4();
    return {a, b};
}
inline Calls segment_work_calls(const Numbers& n) {
    return calls_of([segment = segment_of(n)] { keep(texgen::work(segment, texgen::whole_texture(), tolerance)); });
}
inline Calls segment_bound_calls(const Numbers& n) {
    return calls_of([segment = segment_of(n)] { keep(texgen::error_bound(segment, tolerance)); });
}

// Triangles

// Seven numbers a corner, and the first fragment of the rectangle.
inline Numbers ordinary_triangle(Random& random) {
    texgen::Triangle triangle{};
    const glm::vec2 window[] = {{-10.0f, -20.0f}, {1400.0f, 40.0f}, {60.0f, 1200.0f}};
    std::size_t i = 0;
    for (texgen::WindowVertex* vertex : {&triangle.a, &triangle.b, &triangle.c}) {
        const Numbers strq = ordinary_strq(random);
        *vertex = {window[i++] + glm::vec2(random.uniform_float(-20.0, 20.0), random.uniform_float(-20.0, 20.0)),
                   random.uniform_float(1.0, 4.0), Reader(strq).vec4()};
    }
    return numbers(triangle, static_cast<float>(random.integer(150, 300)),
                   static_cast<float>(random.integer(150, 300)));
}

// u half-way between two floats at every fragment: s = 1/2 + 2^-24 x at w = q = 1, corners on the pixels' corners.
inline Numbers triangle_of_ties(Random& random) {
    texgen::Triangle triangle{};
    const int dx = random.integer(0, 3), dy = random.integer(0, 3);
    const float w = random.coin() ? 1.0f : std::ldexp(1.0f, random.integer(-3, 3));
    for (texgen::WindowVertex* vertex : {&triangle.a, &triangle.b, &triangle.c}) {
        const int x = random.integer(0, 1023), y = random.integer(0, 1023);
        const double s = 0.5 + std::ldexp((2 * dx + 1) * x + 2 * dy * y, -24);
        const double t = 0.5 + std::ldexp(2 * dy * x + (2 * dx + 1) * y, -24);
        *vertex = {{static_cast<float>(x), static_cast<float>(y)}, w, {to_float(s), to_float(t), 0.25f, 1.0f}};
    }
    return numbers(triangle, static_cast<float>(random.integer(0, 900)), static_cast<float>(random.integer(0, 900)));
}

inline Numbers draw_triangle(Random& random) {
    switch (random.integer(0, 7)) {
        case 0:
        case 1: {
            const NearCut cut = near_cut(random);
            return numbers(cut.triangle, static_cast<float>(cut.rect.x), static_cast<float>(cut.rect.y));
        }
        case 2:
            return triangle_of_ties(random);
        case 3: {
            Numbers n = ordinary_triangle(random);
            n[21 + static_cast<std::size_t>(random.integer(0, 1))] =
                static_cast<double>(to_float(random.power_of_ten(4.0, 9.3)));
            return n;
        }
        case 4: {  // all units of any size
            Numbers n = ordinary_triangle(random);
            for (std::size_t k = 0; k < 7; ++k) {
                const double unit = random.coin() ? 1.0 : random.power_of_ten(-38.0, 30.0);
                for (std::size_t i = 0; i < 3; ++i) n[7 * i + k] = static_cast<double>(to_float(n[7 * i + k] * unit));
            }
            return n;
        }
        case 5: {  // all corners far out
            Numbers n = ordinary_triangle(random);
            const double unit = random.power_of_ten(2.0, 6.0);
            for (std::size_t k = 0; k < 2; ++k)
                for (std::size_t i = 0; i < 3; ++i)
                    n[7 * i + k] = static_cast<double>(to_float((n[7 * i + k] - 400.0) * unit));
            return n;
        }
        default: {
            const Family family =
                families[static_cast<std::size_t>(random.integer(0, static_cast<int>(families.size()) - 1))];
            const texgen::Triangle triangle = make_triangle(family, random);
            const texgen::FragmentRect pixel = pixel_near(triangle, random);
            return numbers(triangle, static_cast<float>(pixel.x), static_cast<float>(pixel.y));
        }
    }
}
inline constexpr Hostile hostile_triangle{
    draw_triangle,
    "drawn: cut by the near plane, half-way between floats, far away, in mixed units, or of a hard family"};

inline texgen::Triangle triangle_of(const Numbers& n) {
    Reader reader(n);
    const auto vertex = [&] {
        const glm::vec2 window = reader.vec2();
        const float w = reader.single();
        return texgen::WindowVertex{window, w, reader.vec4()};
    };
    const texgen::WindowVertex a = vertex(), b = vertex(), c = vertex();
    return {a, b, c};
}
template <int Width, int Height>
texgen::FragmentRect rect_of(const Numbers& n) {
    const auto pixel = [](double x) { return static_cast<int>(std::clamp(x, -2147480000.0, 2147480000.0)); };
    return {pixel(n[21]), pixel(n[22]), Width, Height};
}

// A triangle of a window, with pixels as they may be outside of it.
inline bool is_of_a_scene(const texgen::Triangle& triangle) {
    bool all = true;
    for (const texgen::WindowVertex* v : {&triangle.a, &triangle.b, &triangle.c})
        all = all && is_of_a_scene(v->clip_w) && is_between(v->window, 0x1p-10, 0x1p30) && is_of_a_scene(v->strq);
    return all;
}

struct TileCall {
    texgen::TriangleSetup setup;
    texgen::FragmentRect rect;
    std::vector<float> out[8];
};
template <int Width, int Height, bool IsExact>
std::shared_ptr<TileCall> tile_call(const Numbers& n, texgen::TextureRegion region) {
    const texgen::Triangle triangle = triangle_of(n);
    const auto setup = texgen::TriangleSetup::of(triangle, region, IsExact ? texgen::exact : tolerance);
    if (!setup || !is_of_a_scene(triangle)) return nullptr;
    auto call = std::make_shared<TileCall>(TileCall{*setup, rect_of<Width, Height>(n), {}});
    for (std::vector<float>& out : call->out) out.resize(Width * Height);
    return call;
}
template <int Width, int Height, bool IsExact>
Calls triangle_calls(const Numbers& n) {
    const auto call = tile_call<Width, Height, IsExact>(n, texgen::whole_texture());
    if (!call) return {};
    return calls_of([call] {
        keep(texgen::interpolate(call->setup, call->rect,
                                 {.s = call->out[0], .t = call->out[1], .r = call->out[2], .lit = call->out[3]}));
    });
}
// One output alone: r, or the mask.
template <int Width, int Height, bool IsMask, bool HasDepth = false>
Calls one_output_calls(const Numbers& n) {
    const auto call = tile_call<Width, Height, true>(n, HasDepth ? wide_open_from_half() : wide_open());
    if (!call) return {};
    return calls_of([call] {
        const std::span<float> out(call->out[0]);
        keep(texgen::interpolate(
            call->setup, call->rect,
            {.s = {}, .t = {}, .r = IsMask ? std::span<float>() : out, .lit = IsMask ? out : std::span<float>()}));
    });
}
// With a region that leaves no tile dark; or with the texture's, in which small tiles have a certificate of their own.
template <int Width, int Height, bool IsExact, texgen::TextureRegion (*Region)() = wide_open>
Calls open_triangle_calls(const Numbers& n) {
    const auto call = tile_call<Width, Height, IsExact>(n, Region());
    if (!call) return {};
    return calls_of([call] {
        keep(texgen::interpolate(call->setup, call->rect, {.s = call->out[0], .t = call->out[1], .r = {}, .lit = {}}));
    });
}
// What is asked of a batch: s and t, r as well, or the mask alone, of a depth too.
enum class OutputsOf { s_t, s_t_r, mask, mask_of_depth };
template <OutputsOf Of>
texgen::TextureRegion region_for() {
    return Of == OutputsOf::mask_of_depth ? wide_open_from_half() : wide_open();
}
template <OutputsOf Of>
texgen::Texcoords outputs_for(std::vector<float> (&out)[8]) {
    if constexpr (Of == OutputsOf::s_t) return {.s = out[0], .t = out[1], .r = {}, .lit = {}};
    if constexpr (Of == OutputsOf::s_t_r) return {.s = out[0], .t = out[1], .r = out[2], .lit = {}};
    return {.s = {}, .t = {}, .r = {}, .lit = out[0]};
}
// A batch of `Count` of them, made ready and divided; or with others among them, of which one is dark and one is
// refused.
template <int Width, int Height, std::size_t Count, bool IsExact, OutputsOf Of = OutputsOf::s_t, bool HasOthers = false>
Calls batch_calls(const Numbers& n) {
    const auto call = tile_call<Width, Height, IsExact>(n, region_for<Of>());
    if (!call) return {};
    struct Batch {
        texgen::TriangleBatch batch{region_for<Of>(), IsExact ? texgen::exact : tolerance};
        std::vector<texgen::Triangle> triangles;
        std::vector<texgen::FragmentRect> rects;
        std::vector<float> out[8];
    };
    auto all = std::make_shared<Batch>();
    all->triangles.assign(Count, triangle_of(n));
    if constexpr (HasOthers) {
        Random random(1);
        all->triangles[1] = all->triangles[3] = all->triangles[4] = triangle_of(ordinary_triangle(random));
        for (texgen::WindowVertex* v : {&all->triangles[1].a, &all->triangles[1].b, &all->triangles[1].c})
            v->strq.w *= -1.0f;
        all->triangles[3].a.clip_w = 0.0f;
    }
    all->rects.assign(Count, call->rect);
    for (std::vector<float>& out : all->out) out.resize(Count * Width * Height);
    return calls_of([all] {
        all->batch.assign(all->triangles);
        interpolate(all->batch, all->rects, outputs_for<Of>(all->out));
        keep(all->out[0].data());
    });
}
// Eight of them made ready, those that face away dark.
inline Calls batch_facing_calls(const Numbers& n) {
    const texgen::Triangle triangle = triangle_of(n);
    if (!is_of_a_scene(triangle)) return {};
    auto batch = std::make_shared<texgen::TriangleBatch>(wide_open());
    return calls_of([batch, triangles = std::vector<texgen::Triangle>(8, triangle)] {
        batch->assign_facing(triangles, texgen::TextureOrigin::bottom_left);
        keep(texgen::detail::Inside::planes(*batch));
    });
}
// The fragments of one of `Count` triangles that are the same, in runs of `Run`.
template <std::size_t Run, std::size_t Count = 8, class Ask>
Calls ids_calls(const Numbers& n, bool is_exact, texgen::TextureRegion region, Ask ask) {
    const auto call = tile_call<64, 4, true>(n, region);
    if (!call) return {};
    auto batch = std::make_shared<texgen::TriangleBatch>(region, is_exact ? texgen::exact : tolerance);
    batch->assign(std::vector<texgen::Triangle>(Count, triangle_of(n)));
    std::vector<std::uint32_t> ids(256);
    for (std::size_t i = 0; i < ids.size(); ++i) ids[i] = static_cast<std::uint32_t>(i / Run % Count);
    return calls_of([call, batch, ids, ask] {
        ask(*batch, ids, *call);
        keep(call->out[0].data());
    });
}
template <std::size_t Run, bool IsExact, OutputsOf Of = OutputsOf::s_t, std::size_t Count = 8>
Calls visibility_calls(const Numbers& n) {
    return ids_calls<Run, Count>(n, IsExact, region_for<Of>(), [](const auto& batch, const auto& ids, TileCall& call) {
        interpolate(batch, ids, call.rect, outputs_for<Of>(call.out));
    });
}
template <std::size_t Run, std::size_t Count = 8>
Calls footprint_ids_calls(const Numbers& n) {
    return ids_calls<Run, Count>(n, true, wide_open(), [](const auto& batch, const auto& ids, TileCall& call) {
        auto& out = call.out;
        footprint(batch, ids, call.rect, {1024.0, 768.0},
                  {out[0], out[1], out[2], out[3], out[4], out[5], out[6], out[7]});
    });
}
inline Calls setup_calls(const Numbers& n) {
    return calls_of(
        [triangle = triangle_of(n)] { keep(texgen::TriangleSetup::of(triangle, texgen::whole_texture(), tolerance)); });
}
inline Calls triangle_work_calls(const Numbers& n) {
    const auto call = tile_call<64, 4, false>(n, texgen::whole_texture());
    if (!call) return {};
    return calls_of([call] { keep(call->setup.work(call->rect)); });
}
inline Calls volume_work_calls(const Numbers& n) {
    const auto call = tile_call<64, 4, false>(n, wide_open_from_half());
    if (!call) return {};
    return calls_of([call] { keep(call->setup.work(call->rect)); });
}
inline Calls triangle_bound_calls(const Numbers& n) {
    const auto call = tile_call<64, 4, false>(n, texgen::whole_texture());
    if (!call) return {};
    return calls_of([call] { keep(call->setup.error_bound(call->rect)); });
}

// What the numbers of a triangle are, for the limit: q = 0 crosses the tile, or the near plane has left a corner.
template <int Width, int Height>
double triangle_limit(const Numbers& n) {
    const texgen::Triangle t = triangle_of(n);
    const texgen::FragmentRect rect = rect_of<Width, Height>(n);
    const auto minor = [](const texgen::WindowVertex& a, const texgen::WindowVertex& b, double x, double y) {
        return (static_cast<double>(a.window.x) - x) * (static_cast<double>(b.window.y) - y) -
               (static_cast<double>(a.window.y) - y) * (static_cast<double>(b.window.x) - x);
    };
    const auto over_w = [](const texgen::WindowVertex& v) {
        return static_cast<double>(v.strq.w) / static_cast<double>(v.clip_w);
    };
    bool is_positive = false, is_negative = false;
    for (const double x : {rect.x - 0.5, rect.x + Width + 0.5}) {
        for (const double y : {rect.y - 0.5, rect.y + Height + 0.5}) {
            const double q = (minor(t.b, t.c, x, y) * over_w(t.a) + minor(t.c, t.a, x, y) * over_w(t.b) +
                              minor(t.a, t.b, x, y) * over_w(t.c)) *
                             twice_area(t);
            is_positive = is_positive || q >= 0.0;
            is_negative = is_negative || q <= 0.0;
        }
    }
    if (is_positive && is_negative) return limit::q_is_zero;
    const auto [least, largest] = std::minmax({t.a.clip_w, t.b.clip_w, t.c.clip_w});
    return largest > 100.0f * least ? limit::near_plane : limit::any;
}

// Footprints

template <int Width, int Height, bool IsExact, class Ask>
Calls footprint_calls_of(const Numbers& n, Ask ask) {
    const auto call = tile_call<Width, Height, IsExact>(n, wide_open());
    if (!call) return {};
    const texgen::FootprintSetup setup(call->setup, {1024.0, 768.0});
    return calls_of([call, setup, ask] { ask(setup, *call); });
}
template <int Width, int Height, bool IsExact>
Calls footprint_calls(const Numbers& n) {
    return footprint_calls_of<Width, Height, IsExact>(n, [](const texgen::FootprintSetup& setup, TileCall& call) {
        auto& out = call.out;
        keep(texgen::footprint(setup, call.rect, {out[0], out[1], out[2], out[3], out[4], out[5], out[6], out[7]}));
    });
}
inline Calls footprint_setup_calls(const Numbers& n) {
    return footprint_calls_of<1, 1, true>(n, [](const texgen::FootprintSetup&, TileCall& call) {
        keep(texgen::FootprintSetup(call.setup, {1024.0, 768.0}));
    });
}
inline Calls footprint_at_calls(const Numbers& n) {
    return footprint_calls_of<1, 1, true>(
        n, [](const texgen::FootprintSetup& setup, TileCall& call) { keep(setup.at(call.rect.x, call.rect.y)); });
}
inline Calls footprint_bound_calls(const Numbers& n) {
    return footprint_calls_of<64, 4, true>(
        n, [](const texgen::FootprintSetup& setup, TileCall& call) { keep(setup.error_bound(call.rect)); });
}
inline Calls extremes_calls(const Numbers& n) {
    return footprint_calls_of<64, 4, true>(
        n, [](const texgen::FootprintSetup& setup, TileCall& call) { keep(setup.extremes(call.rect)); });
}
inline Calls all_extremes_calls(const Numbers& n) {
    return footprint_calls_of<64, 4, true>(
        n, [](const texgen::FootprintSetup& setup, TileCall&) { keep(setup.extremes()); });
}
inline Calls headlights_calls(const Numbers& n) {
    return calls_of([triangle = triangle_of(n)] { keep(texgen::headlights(triangle)); });
}
inline Calls footprint_of_calls(const Numbers& n) {
    return calls_of([dx = glm::dvec2(n[0], n[1]), dy = glm::dvec2(n[2], n[3]),
                     texels = texgen::TexelsPerUnit{n[4], n[5]}] { keep(texgen::footprint_of(dx, dy, texels)); });
}

// Surfaces

inline Numbers ordinary_corners(Random& random) {
    Numbers n;
    for (int i = 0; i < 3; ++i)
        for (const double x : ordinary_strq(random)) n.push_back(x);
    return n;
}
// Edge on or next to it: sums and multiples of one another, up to units and to a bit.
inline Numbers draw_corners(Random& random) {
    if (random.integer(0, 3) == 0) return any_numbers<12>(random);
    Numbers n = ordinary_corners(random);
    for (std::size_t k = 0; k < 4; ++k) {
        for (std::size_t i : {k, 4 + k}) n[i] = std::ldexp(random.integer(1, 1 << 21), -20);
        n[8 + k] = n[k] + n[4 + k];
        const double unit = random.coin() ? 1.0 : std::ldexp(1.0, random.integer(-20, 20));
        for (std::size_t i : {k, 4 + k, 8 + k}) n[i] *= unit;
    }
    const double unit = std::ldexp(1.0, random.integer(-8, 8));
    for (std::size_t k = 0; k < 4; ++k) n[k] = random.coin() ? unit * n[k] : unit * n[4 + k];
    if (random.coin()) n[static_cast<std::size_t>(random.integer(0, 11))] *= 1.0 + 0x1p-22;
    return n;
}
inline constexpr Hostile hostile_corners{draw_corners, "drawn: triangles edge on or next to it, in mixed units"};
template <class Ask>
Calls corner_calls(const Numbers& n, Ask ask) {
    Reader reader(n);
    const glm::vec4 a = reader.vec4(), b = reader.vec4(), c = reader.vec4();
    return calls_of([a, b, c, ask] { ask(a, b, c); });
}
// Where numbers of all sizes meet in products of three, no two doubles hold what is left.
inline double facing_limit(const Numbers& n) {
    double least = HUGE_VAL, largest = 0.0;
    for (const double x : n) {
        if (x != 0.0) least = std::min(least, std::fabs(x));
        largest = std::max(largest, std::fabs(x));
    }
    return largest > 0x1p8 * least ? limit::all_sizes : limit::any;
}
inline Calls facing_calls(const Numbers& n) {
    return corner_calls(n, [](const glm::vec4& a, const glm::vec4& b, const glm::vec4& c) {
        keep(texgen::facing(a, b, c, texgen::TextureOrigin::bottom_left));
    });
}
inline Calls slide_area_calls(const Numbers& n) {
    return corner_calls(
        n, [](const glm::vec4& a, const glm::vec4& b, const glm::vec4& c) { keep(texgen::slide_area(a, b, c)); });
}
inline Calls receiver_plane_calls(const Numbers& n) {
    return corner_calls(
        n, [](const glm::vec4& a, const glm::vec4& b, const glm::vec4& c) { keep(texgen::receiver_plane(a, b, c)); });
}
inline Numbers ordinary_quadrilateral(Random& random) {
    Numbers n = {0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0};
    for (double& x : n) x += random.uniform(-0.2, 0.2);
    return n;
}
// Next to a line, or with a corner on the diagonal of its neighbours, but for an ulp.
inline Numbers draw_quadrilateral(Random& random) {
    Numbers n = ordinary_quadrilateral(random);
    const std::size_t last = random.coin() ? 2 : 0;
    for (std::size_t i : {std::size_t{2}, std::size_t{6}}) {
        const double along = random.uniform(0.1, 0.9);
        for (std::size_t k = 0; k < 2; ++k) n[i + k] = n[k] + along * (n[4 + k] - n[k]);
        n[i + random.bits() % 2] *= 1.0 + random.integer(-2, 2) * 0x1p-52;
        if (last == 0) break;
    }
    if (random.integer(0, 3) == 0)
        for (double& x : n) x += 1e3;
    return n;
}
inline constexpr Hostile hostile_quadrilateral{draw_quadrilateral,
                                               "drawn: quadrilaterals next to a triangle or a line"};
template <bool IsMatrix>
Calls quadrilateral_calls(const Numbers& n) {
    const std::array<glm::dvec2, 4> corners{glm::dvec2(n[0], n[1]), glm::dvec2(n[2], n[3]), glm::dvec2(n[4], n[5]),
                                            glm::dvec2(n[6], n[7])};
    return calls_of([corners] {
        if constexpr (IsMatrix)
            keep(texgen::keystone(corners));
        else
            keep(texgen::quadrilateral(corners, texgen::rectangle_texture(640.0, 480.0)));
    });
}

// Bodies

inline constexpr std::size_t bodies = 256;
inline constexpr std::size_t body_pattern = 4;

inline Numbers ordinary_boxes(Random& random) {
    Numbers n;
    for (std::size_t i = 0; i < body_pattern; ++i) {
        const glm::vec3 centre = random.vector3(3.0), half(random.uniform_float(0.1, 0.4));
        put(n, centre - half);
        put(n, centre + half);
    }
    put(n, ordinary_texgen(random));
    return n;
}
inline Numbers draw_boxes(Random& random) {
    Numbers n;
    const glm::dmat4 texgen = drawn_texgen(random);
    for (std::size_t i = 0; i < body_pattern; ++i) {
        glm::vec3 a{}, b{};
        for (int k = 0; k < 3; ++k) {
            a[k] = random.coin() ? static_cast<float>(random.integer(-16, 15)) : random.uniform_float(-8.0, 8.0);
            b[k] = a[k] + (random.coin() ? static_cast<float>(random.integer(0, 4)) : random.uniform_float(0.0, 2.0));
        }
        if (random.integer(0, 3) == 0) {
            a.x = to_float(any_float(random));
            b.x = a.x + std::fabs(to_float(any_float(random)));
        }
        put(n, a);
        put(n, b);
    }
    put(n, texgen);
    return n;
}
inline constexpr Hostile hostile_boxes{
    draw_boxes, "drawn: boxes with whole coordinates or of any size, under an aligned projector or any matrix"};
inline Numbers ordinary_spheres(Random& random) {
    Numbers n;
    for (std::size_t i = 0; i < body_pattern; ++i) {
        put(n, random.vector3(3.0));
        put(n, random.uniform_float(0.1, 0.4));
    }
    put(n, ordinary_texgen(random));
    return n;
}
inline Numbers draw_spheres(Random& random) {
    Numbers n;
    for (std::size_t i = 0; i < body_pattern; ++i)
        for (const double x : any_numbers<4>(random)) n.push_back(x);
    put(n, drawn_texgen(random));
    return n;
}
inline constexpr Hostile hostile_spheres{draw_spheres,
                                         "drawn: spheres of any numbers, under an aligned projector or any matrix"};

// Bodies of a world, and a matrix as cameras of such sizes make it, where a sine that is 0 may be 2^-54. (As
// is_of_a_scene().)
inline bool are_of_a_scene(const Numbers& n) {
    const auto body_end = n.end() - 16;
    return std::all_of(n.begin(), body_end, [](double x) { return is_between(x, 0x1p-20, 0x1p20); }) &&
           std::all_of(body_end, n.end(), [](double x) { return is_between(x, 0x1p-60, 0x1p20); });
}
inline texgen::TextureRegion whole_volume() { return texgen::whole_texture().with_depth(); }
template <class Body, std::size_t Count, texgen::TextureRegion (&Region)() = texgen::whole_texture>
Calls coverage_calls(const Numbers& n) {
    if (!are_of_a_scene(n)) return {};
    Reader reader(n);
    std::vector<Body> all;
    for (std::size_t i = 0; i < body_pattern; ++i) {
        if constexpr (std::is_same_v<Body, texgen::Box>) {
            const glm::vec3 min = reader.vec3(), max = reader.vec3();
            all.push_back({min, max});
        } else {
            const glm::vec3 centre = reader.vec3();
            all.push_back({centre, reader.single()});
        }
    }
    for (std::size_t i = body_pattern; i < Count; ++i) all.push_back(all[i - body_pattern]);
    const texgen::LitVolume<texgen::World> volume(texgen::WorldTexgen(reader.dmat4()), Region());
    std::vector<texgen::Coverage> out(Count);
    return calls_of([=]() mutable {
        if constexpr (Count == 1)
            keep(volume.coverage(all[0]));
        else
            volume.coverage(std::span<const Body>(all), out);
    });
}
// Asked once: the volume is made for it.
template <class Body, texgen::TextureRegion (&Region)() = texgen::whole_texture>
Calls one_question_calls(const Numbers& n) {
    if (!are_of_a_scene(n)) return {};
    Reader reader(n);
    const glm::vec3 a = reader.vec3(), b = reader.vec3();
    Numbers matrix(n.end() - 16, n.end());
    return calls_of([a, b, texgen = texgen::WorldTexgen(Reader(matrix).dmat4())] {
        if constexpr (std::is_same_v<Body, texgen::Box>)
            keep(texgen::coverage(texgen, Region(), texgen::Box{a, b}));
        else
            keep(texgen::coverage(texgen, Region(), texgen::Sphere{a, b.x}));
    });
}
// A frame in which all of 64 objects change, about 4 projectors that have a depth and are one.
inline Calls scene_calls(const Numbers& n) {
    if (!are_of_a_scene(n)) return {};
    struct Engine {
        std::vector<texgen::ModelMatrix> models;
        std::vector<texgen::Box> bounds;
        std::vector<texgen::Projector> projectors;
        std::vector<texgen::TextureRegion> regions;
        std::vector<std::uint32_t> all;
        texgen::Scene scene;
    };
    const auto engine = std::make_shared<Engine>();
    Reader reader(n);
    for (std::uint32_t i = 0; i < 64; ++i) {
        if (i < body_pattern) {
            const glm::vec3 min = reader.vec3(), max = reader.vec3();
            engine->bounds.push_back({min, max});
        } else {
            engine->bounds.push_back(engine->bounds[i - body_pattern]);
        }
        engine->models.emplace_back(glm::dmat4(1.0));
        engine->all.push_back(i);
    }
    glm::dmat4 projection = reader.dmat4();
    for (int k = 0; k < 4; ++k)
        projection[k] = glm::dvec4(2.0 * glm::dvec3(projection[k]) - projection[k].w, projection[k].w);
    engine->projectors.assign(
        4, {texgen::ProjectorProjection(projection), texgen::ProjectorView(glm::dmat4(1.0)), texgen::opengl});
    engine->regions.assign(4, whole_volume());
    return calls_of([engine] {
        keep(engine->scene.update({engine->models, engine->bounds, engine->projectors, engine->regions},
                                  {engine->all, {}}));
    });
}
inline Numbers ordinary_volume(Random& random) {
    return numbers(ordinary_texgen(random), glm::dvec4(0.0, 0.0, 1.0, 1.0));
}
inline Numbers draw_volume(Random& random) {
    Numbers n = numbers(drawn_texgen(random));
    for (const double x : any_numbers<4>(random)) n.push_back(x);
    return n;
}
inline constexpr Hostile hostile_volume{draw_volume, "drawn: an aligned projector or any matrix"};
inline texgen::TextureRegion read_region(Reader& reader, bool has_depth) {
    const glm::dvec4 sides = reader.dvec4();
    const texgen::TextureRegion region = texgen::atlas_tile({sides.x, sides.y}, {sides.z, sides.w});
    return has_depth ? region.with_depth(sides.x, sides.w) : region;
}
template <bool HasDepth>
Calls volume_calls(const Numbers& n) {
    Reader reader(n);
    const texgen::WorldTexgen texgen(reader.dmat4());
    const texgen::TextureRegion region = read_region(reader, HasDepth);
    return calls_of([texgen, region] { keep(texgen::LitVolume<texgen::World>(texgen, region)); });
}
template <bool HasDepth>
Calls planes_calls(const Numbers& n) {
    Reader reader(n);
    const texgen::WorldTexgen texgen(reader.dmat4());
    const texgen::TextureRegion region = read_region(reader, HasDepth);
    return calls_of([texgen, region] { keep(texgen::clip_planes(texgen, region)); });
}

// Clipping

inline Numbers ordinary_polygon(Random& random) {
    Numbers n;
    for (int i = 0; i < 3; ++i) {
        const float w = random.uniform_float(1.0, 4.0);
        put(n, glm::vec4(random.vector3(1.0) * w, w));
        if (i == 0) n[2] = -1.5 * n[3];  // one corner behind
        for (const double x : ordinary_strq(random)) n.push_back(x);
        n[n.size() - 4] *= i == 0 ? 2.0 : 1.0;
    }
    for (double& x : n) x = static_cast<double>(to_float(x));
    return n;
}
// Of a camera and of slides as they are, as is_of_a_scene() has them.
template <bool ToNear, texgen::TextureRegion (&Region)() = texgen::whole_texture>
Calls clip_calls(const Numbers& n) {
    Reader reader(n);
    std::array<texgen::ClipVertex, 3> polygon{};
    for (texgen::ClipVertex& vertex : polygon) {
        vertex.position = reader.vec4();
        vertex.strq = reader.vec4();
        if (!is_of_a_scene(vertex.position) || !is_of_a_scene(vertex.strq)) return {};
    }
    return calls_of([polygon, out = std::array<texgen::ClipVertex, 12>{}]() mutable {
        if constexpr (ToNear)
            keep(texgen::clip_to_near(polygon, out, texgen::DepthRange::negative_one_to_one));
        else
            keep(texgen::clip_to_slide(polygon, Region(), out));
    });
}
inline Calls to_window_calls(const Numbers& n) {
    Reader reader(n);
    const glm::vec4 position = reader.vec4(), strq = reader.vec4();
    if (!(position.w >= std::numeric_limits<float>::min())) return {};  // in every state of subnormal numbers
    return calls_of([position, strq] { keep(texgen::to_window({position, strq}, {0, 0, 1024, 768})); });
}

// Matrices

inline Numbers ordinary_matrix(Random& random) {
    glm::dmat4 m = random.rigid(10.0);
    m[0] *= 1.5;
    return numbers(m, random.rigid(10.0));
}
inline Numbers draw_matrix(Random& random) {
    Numbers n(32);
    const int kind = random.integer(0, 3);
    const double distance = random.power_of_ten(-16.0, 0.0);
    for (double& x : n) {
        x = kind == 0 ? any_float(random) : random.uniform(-1.0, 1.0);
        if (kind == 1) x = random.integer(0, 2) == 0 ? std::ldexp(x, random.integer(-120, 20)) : 0.0;
    }
    if (kind >= 2)
        for (std::size_t k = 0; k < 4; ++k) n[4 * k + 2] = n[4 * k] + distance * n[4 * k + 2];
    return n;
}
inline constexpr Hostile hostile_matrix{draw_matrix, "drawn: almost singular, graded, or any numbers"};
template <class Ask>
Calls matrix_calls(const Numbers& n, Ask ask) {
    Reader reader(n);
    const glm::dmat4 a = reader.dmat4(), b = reader.dmat4();
    return calls_of([a, b, ask] { ask(a, b); });
}
inline Calls inverse_calls(const Numbers& n) {
    return matrix_calls(n, [](const glm::dmat4& m, const glm::dmat4&) { keep(inverse(texgen::ModelMatrix(m))); });
}
inline Calls inverse_bound_calls(const Numbers& n) {
    return matrix_calls(n, [](const glm::dmat4& m, const glm::dmat4& x) {
        keep(inverse_error_bound(texgen::ModelMatrix(m), texgen::Transform<texgen::Object, texgen::World>(x)));
    });
}
inline Calls rigid_calls(const Numbers& n) {
    if (!(texgen::detail::distance_from_rigid(Reader(n).dmat4()) <= 1e-3)) return {};
    return matrix_calls(n, [](const glm::dmat4& m, const glm::dmat4&) { keep(inverse_rigid(texgen::ViewMatrix(m))); });
}
inline Numbers ordinary_rigid(Random& random) { return numbers(random.rigid(10.0), glm::dmat4(1.0)); }
inline Numbers draw_rigid(Random& random) {
    return numbers(random.rigid(random.power_of_ten(-300.0, 300.0)), glm::dmat4(1.0));
}
inline constexpr Hostile hostile_rigid{draw_rigid, "drawn: a pose at any distance"};
inline Calls eye_planes_calls(const Numbers& n) {
    return matrix_calls(n, [](const glm::dmat4& m, const glm::dmat4& planes) {
        keep(eye_planes_as_stored(texgen::WorldTexgen(planes), texgen::ViewMatrix(m)));
    });
}
inline Calls eye_planes_bound_calls(const Numbers& n) {
    return matrix_calls(n, [](const glm::dmat4& m, const glm::dmat4& planes) {
        keep(eye_planes_error_bound(texgen::WorldTexgen(planes), texgen::ViewMatrix(m), texgen::EyeTexgen(planes)));
    });
}
inline Calls rounded_planes_calls(const Numbers& n) {
    return matrix_calls(n, [](const glm::dmat4& m, const glm::dmat4&) { keep(planes(texgen::WorldTexgen(m))); });
}
template <bool OfObject>
Calls composed_calls(const Numbers& n) {
    Random random(5);
    return matrix_calls(n, [projector = ordinary_projector(random)](const glm::dmat4& m, const glm::dmat4& view) {
        const texgen::Projector with_view{projector.projection, texgen::ProjectorView(view), projector.conventions};
        if constexpr (OfObject)
            keep(object_linear(with_view, texgen::ModelMatrix(m)));
        else
            keep(eye_linear(with_view, texgen::CameraPose(m)));
    });
}
inline Calls texture_from_world_calls(const Numbers& n) {
    return matrix_calls(n, [](const glm::dmat4& projection, const glm::dmat4& view) {
        keep(texgen::texture_from_world(
            {texgen::ProjectorProjection(projection), texgen::ProjectorView(view), texgen::opengl}));
    });
}
// A camera's projection and view; the projector is an ordinary one.
inline Numbers ordinary_camera(Random& random) {
    const texgen::Projector camera = ordinary_projector(random);
    return numbers(camera.projection.matrix(), camera.view.matrix());
}
inline Numbers draw_camera(Random& random) {
    return random.coin() ? draw_matrix(random)
                         : numbers(ordinary_projector(random).projection.matrix(),
                                   random.rigid(random.power_of_ten(-10.0, 10.0)));
}
inline constexpr Hostile hostile_camera{draw_camera, "drawn: a camera at any distance, or almost singular matrices"};
inline Calls window_linear_calls(const Numbers& n) {
    Random random(5);
    return matrix_calls(n,
                        [projector = ordinary_projector(random)](const glm::dmat4& projection, const glm::dmat4& view) {
                            const texgen::Projector camera{texgen::ProjectorProjection(projection),
                                                           texgen::ProjectorView(view), texgen::opengl};
                            keep(window_linear(projector, camera, {0, 0, 1024, 768}));
                        });
}
inline Calls depth_bound_calls(const Numbers& n) {
    return matrix_calls(n, [](const glm::dmat4& m, const glm::dmat4& numbers) {
        keep(depth_error_bound(texgen::WindowTexgen(m), glm::vec3(numbers[0]), texgen::DepthBuffer::unorm24));
    });
}
inline Calls to_texture_calls(const Numbers& n) {
    return calls_of([strq = Reader(n).vec4()] { keep(texgen::to_texture(strq, texgen::opengl)); });
}
inline Calls scale_bias_calls(const Numbers& n) {
    return calls_of([region = texgen::atlas_tile({n[0], n[1]}, {n[2], n[3]})] {
        keep(region);
        keep(texgen::scale_bias(texgen::opengl, region));
    });
}

inline Calls product_calls(const Numbers& n) {
    return matrix_calls(n, [](const glm::dmat4& view, const glm::dmat4& model) {
        keep(texgen::ViewMatrix(view) * texgen::ModelMatrix(model));
    });
}
inline Calls rounded_calls(const Numbers& n) {
    return matrix_calls(n, [](const glm::dmat4& m, const glm::dmat4&) { keep(texgen::ViewMatrix(m).rounded()); });
}
inline Calls row_vectors_calls(const Numbers& n) {
    return matrix_calls(n, [](const glm::dmat4& m, const glm::dmat4&) {
        keep(texgen::from_row_vectors<texgen::Eye, texgen::World>(m).rounded_for_row_vectors());
    });
}
inline Calls carried_calls(const Numbers& n) {
    return matrix_calls(n, [](const glm::dmat4& projection, const glm::dmat4& view) {
        keep(texgen::eye_linear(texgen::ProjectorProjection(projection),
                                texgen::Transform<texgen::ProjectorEye, texgen::Eye>(view), texgen::opengl));
    });
}
inline Calls to_eigen_calls(const Numbers& n) {
    return matrix_calls(n, [](const glm::dmat4& m, const glm::dmat4&) {
        keep(texgen::to_eigen_affine<Eigen::Affine3d>(texgen::ViewMatrix(m)));
        keep(texgen::to_eigen<Eigen::Matrix4f>(texgen::ViewMatrix(m)));
    });
}
inline Calls from_eigen_calls(const Numbers& n) {
    return calls_of([m = Eigen::Matrix4d(Eigen::Map<const Eigen::Matrix4d>(n.data()))] {
        keep(texgen::from_eigen<texgen::ViewMatrix>(m));
    });
}
// A camera that moves to and fro over 16 projectors.
inline Calls update_eye_calls(const Numbers& n) {
    const auto scene = std::make_shared<texgen::Scene>();
    Random random(4);
    const std::vector<texgen::Projector> projectors(16, ordinary_projector(random));
    scene->update({{}, {}, projectors}, {});
    Reader reader(n);
    const texgen::CameraPose there(reader.dmat4()), back(reader.dmat4());
    return calls_of([scene, there, back, is_back = false]() mutable {
        keep(scene->update_eye(is_back ? back : there));
        is_back = !is_back;
    });
}

// Projectors' own functions

inline Numbers ordinary_look(Random& random) {
    const texgen::Aim aim = ordinary_aim(random);
    return numbers(aim.position, aim.target, aim.up, glm::dvec3(0.7, 1.3, 0.5), glm::dvec4(-1.0, 1.1, -0.9, 1.0), 20.0);
}
inline Numbers draw_look(Random& random) {
    Numbers n = ordinary_look(random);
    const int kind = random.integer(0, 3);
    if (kind == 0)
        for (double& x : n) x = any_float(random);
    if (kind == 1)  // up almost along the view
        for (std::size_t k = 0; k < 3; ++k) n[6 + k] = (n[3 + k] - n[k]) * (1.0 + random.power_of_ten(-17.0, -1.0));
    if (kind == 2) {
        const double unit = random.power_of_ten(-300.0, 300.0);
        for (double& x : n) x *= random.coin() ? unit : 1.0;
    }
    return n;
}
inline constexpr Hostile hostile_look{draw_look, "drawn: up next to the view, or numbers of any size"};
inline texgen::Aim aim_of(Reader& reader) {
    const glm::dvec3 position = reader.dvec3(), target = reader.dvec3();
    return {position, target, reader.dvec3()};
}
inline Calls look_at_calls(const Numbers& n) {
    Reader reader(n);
    return calls_of([aim = aim_of(reader)] { keep(texgen::look_at(aim)); });
}
// The numbers behind an aim: an angle, an aspect, a near plane; four sides; a far plane.
template <int Kind>
Calls lens_calls(const Numbers& n) {
    Reader reader(n);
    const texgen::Aim aim = aim_of(reader);
    const glm::dvec3 a = reader.dvec3();
    const glm::dvec4 sides = reader.dvec4();
    const double z_far = reader.real();
    const texgen::PerspectiveLens perspective{texgen::radians(a.x), a.y, a.z, z_far};
    const texgen::FrustumLens frustum{sides.x, sides.y, sides.z, sides.w, a.z, z_far};
    const texgen::OrthographicLens orthographic{sides.x, sides.y, sides.z, sides.w, a.z, z_far};
    const texgen::PinholeLens pinhole{
        a.x, a.y, sides.x, sides.y, std::fabs(sides.z), sides.w, a.z, z_far, texgen::PixelCentre::half};
    return calls_of([=] {
        if constexpr (Kind == 0) keep(texgen::perspective(perspective, texgen::opengl));
        if constexpr (Kind == 1) keep(texgen::frustum(frustum, texgen::opengl));
        if constexpr (Kind == 2) keep(texgen::orthographic(orthographic, texgen::opengl));
        if constexpr (Kind == 3) keep(texgen::make_projector(perspective, aim, texgen::opengl));
        if constexpr (Kind == 4) keep(texgen::make_projector(frustum, aim, texgen::opengl));
        if constexpr (Kind == 5) keep(texgen::make_projector(orthographic, aim, texgen::opengl));
        if constexpr (Kind == 6) keep(texgen::pinhole(pinhole, texgen::opengl));
        if constexpr (Kind == 7) keep(texgen::make_projector(pinhole, aim, texgen::opengl));
        if constexpr (Kind == 8) {
            const glm::dmat4 view{glm::dvec4(aim.position, 0.0), glm::dvec4(aim.target, 0.0), glm::dvec4(aim.up, 0.0),
                                  glm::dvec4(a, 1.0)};
            keep(texgen::mirrored(texgen::ProjectorView(view), sides));
        }
        if constexpr (Kind == 9) keep(texgen::view_from_opencv({aim.position, aim.target, aim.up}, a));
        if constexpr (Kind == 10) keep(texgen::contain(perspective, a.x + a.y));
        if constexpr (Kind == 11) keep(texgen::cover(frustum, sides.y));
        if constexpr (Kind == 12) keep(texgen::diagnose(perspective, aim, texgen::opengl));
        if constexpr (Kind == 13) keep(texgen::diagnose(frustum, aim, texgen::opengl));
        if constexpr (Kind == 14) keep(texgen::diagnose(orthographic, aim, texgen::opengl));
        if constexpr (Kind == 15) keep(texgen::diagnose(pinhole, aim, texgen::opengl));
    });
}

// OpenGL's fixed function

inline Numbers ordinary_vertex(Random& random) {
    Numbers n = numbers(rounded(random.rigid(5.0)), random.vector4(1.0));
    n.back() = 1.0;
    put(n, random.vector3(1.0));
    put(n, random.vector4(1.0));
    return n;
}
inline Numbers draw_vertex(Random& random) {
    Numbers n = random.coin() ? any_numbers<27>(random) : ordinary_vertex(random);
    if (random.coin())
        for (std::size_t i = 16; i < 27; ++i) n[i] = any_float(random);
    return n;
}
inline constexpr Hostile hostile_vertex{draw_vertex, "drawn: any numbers"};
template <texgen::TexGenMode Mode>
Calls unit_calls(const Numbers& n) {
    using texgen::Coordinate;
    Reader reader(n);
    const glm::mat4 modelview = reader.mat4();
    texgen::FixedFunctionVertex vertex{};
    vertex.position = reader.vec4();
    vertex.normal = reader.vec3();
    const glm::vec4 plane = reader.vec4();
    texgen::TexGenUnit unit;
    unit.set_normal_scaling(texgen::TexGenUnit::NormalScaling::normalize);
    for (const Coordinate coordinate : {Coordinate::s, Coordinate::t, Coordinate::r, Coordinate::q}) {
        unit.enable(coordinate, unit.set_mode(coordinate, Mode));
        unit.set_object_plane(coordinate, plane);
        static_cast<void>(unit.set_eye_plane(coordinate, plane, modelview));
    }
    return calls_of([unit, vertex, modelview] { keep(unit.generate(vertex, modelview)); });
}
template <bool OfBound>
Calls eye_plane_calls(const Numbers& n) {
    using texgen::Coordinate;
    Reader reader(n);
    const glm::mat4 modelview = reader.mat4();
    const glm::vec4 plane = reader.vec4();
    return calls_of([modelview, plane, unit = texgen::TexGenUnit()]() mutable {
        if constexpr (OfBound)
            keep(unit.eye_plane_error_bound(Coordinate::s, plane, modelview));
        else
            keep(unit.set_eye_plane(Coordinate::s, plane, modelview));
    });
}

// Of a batch, with the normals left as they are.
inline Calls unit_batch_calls(const Numbers& n) {
    using texgen::Coordinate;
    Reader reader(n);
    const glm::mat4 modelview = reader.mat4();
    std::vector<texgen::FixedFunctionVertex> vertices(64);
    vertices[0].position = reader.vec4();
    vertices[0].normal = reader.vec3();
    for (texgen::FixedFunctionVertex& vertex : vertices) vertex = vertices[0];
    texgen::TexGenUnit unit;
    for (const Coordinate coordinate : {Coordinate::s, Coordinate::t, Coordinate::r})
        unit.enable(coordinate, unit.set_mode(coordinate, texgen::TexGenMode::normal_map));
    return calls_of([unit, vertices, modelview, out = std::vector<glm::vec4>(64)]() mutable {
        unit.generate(vertices, modelview, out);
        keep(out[0]);
    });
}

// Diagnosis

// A projection, a view, a model, and what claims to be their texgen matrix.
inline Numbers setup_of(const texgen::Projector& projector, const texgen::ModelMatrix& model,
                        const glm::dmat4& texgen) {
    return numbers(projector.projection.matrix(), projector.view.matrix(), model.matrix(), texgen);
}

// What users upload: composed in double as a product is given here, or in float from its factors.
template <class... Factors>
glm::dmat4 composed(bool in_float, const Factors&... factors) {
    return in_float ? glm::dmat4((glm::mat4(factors) * ...)) : (factors * ...);
}

// A set-up with one defect: the scale-bias or the model left out, or there twice, V before P, or the transpose.
inline Numbers setup_with_one_defect(Random& random) {
    const texgen::Projector projector = ordinary_projector(random);
    const texgen::ModelMatrix model(random.rigid(1.0));
    const glm::dmat4 s = texgen::scale_bias(projector.conventions).matrix(), p = projector.projection.matrix(),
                     v = projector.view.matrix(), x = model.matrix();
    const bool in_float = random.coin();
    const std::array wrong{composed(in_float, p, v, x),    composed(in_float, s, s, p, v, x),
                           composed(in_float, s, p, v),    composed(in_float, s, p, v, x, x),
                           composed(in_float, s, v, p, x), glm::transpose(composed(in_float, s, p, v, x))};
    return setup_of(projector, model, wrong[static_cast<std::size_t>(random.integer(0, 5))]);
}

inline Numbers valid_setup(Random& random) {
    const texgen::Projector projector = ordinary_projector(random);
    const texgen::ModelMatrix model(random.rigid(1.0));
    return setup_of(projector, model,
                    composed(random.coin(), texgen::scale_bias(projector.conventions).matrix(),
                             projector.projection.matrix(), projector.view.matrix(), model.matrix()));
}

inline Numbers draw_setup(Random& random) {
    Numbers n = random.coin() ? valid_setup(random) : setup_with_one_defect(random);
    const int changes = random.integer(0, 6);
    for (int i = 0; i < changes; ++i) n[static_cast<std::size_t>(random.integer(0, 63))] = any_float(random);
    if (random.integer(0, 3) == 0) std::rotate(n.begin(), n.begin() + 16 * random.integer(1, 3), n.end());
    return n;
}
inline constexpr Hostile hostile_setup{draw_setup, "drawn: a set-up with wrong elements"};
enum class Diagnosed { projector, setup, valid_setup, texgen, planes };
template <Diagnosed What>
Calls diagnose_calls(const Numbers& n) {
    Reader reader(n);
    const glm::dmat4 projection = reader.dmat4(), view = reader.dmat4(), model = reader.dmat4(),
                     texgen = reader.dmat4();
    const texgen::Projector projector{texgen::ProjectorProjection(projection), texgen::ProjectorView(view),
                                      texgen::opengl};
    texgen::ProjectionSetup<texgen::Object> setup;
    setup.projector = projector;
    setup.world_from_space = texgen::ModelMatrix(model);
    setup.texgen = texgen::ObjectTexgen(texgen);
    if (What == Diagnosed::valid_setup && !texgen::diagnose(setup).empty()) return {};
    return calls_of([=] {
        if constexpr (What == Diagnosed::projector) keep(texgen::diagnose(projector));
        if constexpr (What == Diagnosed::setup || What == Diagnosed::valid_setup) keep(texgen::diagnose(setup));
        if constexpr (What == Diagnosed::texgen) keep(texgen::diagnose(*setup.texgen));
        if constexpr (What == Diagnosed::planes) keep(texgen::diagnose(planes(*setup.texgen)));
    });
}

}  // namespace detail

// All of them

inline const std::array workloads{
    Workload{"project, exact, 1024 points", 24, detail::ordinary_points, detail::hostile_points,
             detail::project_calls<1024>, detail::always},
    Workload{"project, tolerance, 1024 points", 24, detail::ordinary_points, detail::hostile_points,
             detail::project_calls<1024, detail::Asked{.is_exact = false}>, detail::always},
    Workload{"project, exact, 1 point", 24, detail::ordinary_points, detail::hostile_points,
             detail::project_calls<1>, detail::always},
    Workload{"project, exact, lit alone with a depth, 1024 points", 24, detail::ordinary_points, detail::hostile_points,
             detail::project_calls<1024, detail::Asked{.has_depth = true, .outputs = detail::Outputs::lit}>, detail::always},
    Workload{"project to pairs, 1024 points", 24, detail::ordinary_points, detail::hostile_points,
             detail::project_calls<1024, detail::Asked{.outputs = detail::Outputs::pairs}>, detail::always},
    Workload{"project, tolerance, 1 point", 24, detail::ordinary_points, detail::hostile_points, detail::project_calls<1, detail::Asked{.is_exact = false}>, detail::always},
    Workload{"project, exact, with a depth, 1024 points", 24, detail::ordinary_points, detail::hostile_points, detail::project_calls<1024, detail::Asked{.has_depth = true}>, detail::always},
    Workload{"project, tolerance, with a depth, 1024 points", 24, detail::ordinary_points, detail::hostile_points, detail::project_calls<1024, detail::Asked{.is_exact = false, .has_depth = true}>, detail::always},
    Workload{"project, exact, lit alone, 1024 points", 24, detail::ordinary_points, detail::hostile_points, detail::project_calls<1024, detail::Asked{.outputs = detail::Outputs::lit}>, detail::always},
    Workload{"project, tolerance, lit alone, 1024 points", 24, detail::ordinary_points, detail::hostile_points, detail::project_calls<1024, detail::Asked{.is_exact = false, .outputs = detail::Outputs::lit}>, detail::always},
    Workload{"project, exact, planar, 1024 points", 24, detail::ordinary_points, detail::hostile_points, detail::project_calls<1024, detail::Asked{.is_planar = true}>, detail::always},
    Workload{"project, tolerance, planar, 1024 points", 24, detail::ordinary_points, detail::hostile_points, detail::project_calls<1024, detail::Asked{.is_exact = false, .is_planar = true}>, detail::always},
    Workload{"project within a box, exact, planar, 1024 points", 24, detail::ordinary_points, detail::hostile_points, detail::project_calls<1024, detail::Asked{.is_within = true, .is_planar = true}>, detail::always},
    Workload{"project within a box, tolerance, planar, 1024 points", 24, detail::ordinary_points, detail::hostile_points, detail::project_calls<1024, detail::Asked{.is_exact = false, .is_within = true, .is_planar = true}>, detail::always},
    Workload{"project to pairs, tolerance, 1024 points", 24, detail::ordinary_points, detail::hostile_points, detail::project_calls<1024, detail::Asked{.is_exact = false, .outputs = detail::Outputs::pairs}>, detail::always},
    Workload{"project to pairs within a box, exact, 1024 points", 24, detail::ordinary_points, detail::hostile_points, detail::project_calls<1024, detail::Asked{.is_within = true, .outputs = detail::Outputs::pairs}>, detail::always},
    Workload{"project to pairs within a box, tolerance, 1024 points", 24, detail::ordinary_points, detail::hostile_points, detail::project_calls<1024, detail::Asked{.is_exact = false, .is_within = true, .outputs = detail::Outputs::pairs}>, detail::always},
    Workload{"generate, 1024 points", 24, detail::ordinary_points, detail::hostile_points, detail::generate_calls<1024>,
             detail::always},
    Workload{"generate, 1 point", 24, detail::ordinary_points, detail::hostile_points, detail::generate_calls<1>,
             detail::always},
    Workload{"generate to four arrays, 1024 points", 24, detail::ordinary_points, detail::hostile_points,
             detail::generate_planar_calls<1024>, detail::always},
    Workload{"project within a box, exact, 1024 points", 24, detail::ordinary_points, detail::hostile_points,
             detail::project_calls<1024, detail::Asked{.is_within = true}>, detail::always},
    Workload{"project within a box, tolerance, 1024 points", 24, detail::ordinary_points, detail::hostile_points,
             detail::project_calls<1024, detail::Asked{.is_exact = false, .is_within = true}>, detail::always},
    Workload{"project a point", 24, detail::ordinary_points, detail::hostile_points, detail::project_point_calls,
             detail::always},
    Workload{"project_error_bound, 1024 points", 24, detail::ordinary_points, detail::hostile_points,
             detail::project_bound_calls, detail::always},
    Workload{"generate_error_bound, 1024 points", 24, detail::ordinary_points, detail::hostile_points,
             detail::generate_bound_calls, detail::always},
    Workload{"divide", 4, detail::ordinary_strq, detail::hostile_numbers<4>, detail::divide_calls, detail::always},
    Workload{"interpolate a segment, exact, 1024", 16, detail::ordinary_segment, detail::hostile_segment,
             detail::segment_calls<1024>, detail::always},
    Workload{"interpolate a segment, tolerance, 1024", 16, detail::ordinary_segment, detail::hostile_segment,
             detail::segment_calls<1024, detail::Asked{.is_exact = false}>, detail::always},
    Workload{"interpolate a segment, exact, with a depth, 1024", 16, detail::ordinary_segment, detail::hostile_segment,
             detail::segment_calls<1024, detail::Asked{.has_depth = true}>, detail::always},
    Workload{"interpolate a segment, exact, 1", 16, detail::ordinary_segment, detail::hostile_segment,
             detail::segment_calls<1>, detail::always},
    Workload{"interpolate a segment, exact, lit alone, 1024", 16, detail::ordinary_segment, detail::hostile_segment, detail::segment_calls<1024, detail::Asked{.outputs = detail::Outputs::lit}>, detail::always},
    Workload{"interpolate a segment, tolerance, lit alone, 1024", 16, detail::ordinary_segment, detail::hostile_segment, detail::segment_calls<1024, detail::Asked{.is_exact = false, .outputs = detail::Outputs::lit}>, detail::always},
    Workload{"interpolate a segment, exact, r alone, 1024", 16, detail::ordinary_segment, detail::hostile_segment, detail::segment_calls<1024, detail::Asked{.outputs = detail::Outputs::r}>, detail::always},
    Workload{"interpolate a segment, tolerance, with a depth, 1024", 16, detail::ordinary_segment, detail::hostile_segment, detail::segment_calls<1024, detail::Asked{.is_exact = false, .has_depth = true}>, detail::always},
    Workload{"interpolate a segment, tolerance, 1", 16, detail::ordinary_segment, detail::hostile_segment, detail::segment_calls<1, detail::Asked{.is_exact = false}>, detail::always},
    Workload{"work of a segment", 16, detail::ordinary_segment, detail::hostile_segment, detail::segment_work_calls,
             detail::always},
    Workload{"error_bound of a segment", 16, detail::ordinary_segment, detail::hostile_segment,
             detail::segment_bound_calls, detail::always},
    Workload{"TriangleSetup::of", 23, detail::ordinary_triangle, detail::hostile_triangle, detail::setup_calls,
             detail::always},
    Workload{"TriangleSetup::work, 64 x 4", 23, detail::ordinary_triangle, detail::hostile_triangle,
             detail::triangle_work_calls, detail::always},
    Workload{"TriangleSetup::error_bound, 64 x 4", 23, detail::ordinary_triangle, detail::hostile_triangle,
             detail::triangle_bound_calls, detail::always},
    Workload{"interpolate a triangle, exact, 64 x 4", 23, detail::ordinary_triangle, detail::hostile_triangle,
             detail::open_triangle_calls<64, 4, true>, detail::triangle_limit<64, 4>},
    Workload{"interpolate a triangle, tolerance, 64 x 4", 23, detail::ordinary_triangle, detail::hostile_triangle,
             detail::open_triangle_calls<64, 4, false>, detail::triangle_limit<64, 4>},
    Workload{"interpolate a triangle, exact, all outputs, 64 x 4", 23, detail::ordinary_triangle,
             detail::hostile_triangle, detail::triangle_calls<64, 4, true>, detail::triangle_limit<64, 4>},
    Workload{"interpolate a triangle, exact, 8 x 8", 23, detail::ordinary_triangle, detail::hostile_triangle,
             detail::open_triangle_calls<8, 8, true>, detail::triangle_limit<8, 8>},
    Workload{"interpolate a triangle, tolerance, 8 x 8", 23, detail::ordinary_triangle, detail::hostile_triangle,
             detail::open_triangle_calls<8, 8, false>, detail::triangle_limit<8, 8>},
    Workload{"interpolate a triangle, exact, 1 x 1", 23, detail::ordinary_triangle, detail::hostile_triangle,
             detail::open_triangle_calls<1, 1, true>, detail::triangle_limit<1, 1>},
    Workload{"interpolate a triangle, exact, of the texture, 1 x 64", 23, detail::ordinary_triangle, detail::hostile_triangle,
             detail::open_triangle_calls<1, 64, true, texgen::whole_texture>, detail::triangle_limit<1, 64>},
    Workload{"interpolate a triangle, tolerance, of the texture, 1 x 64", 23, detail::ordinary_triangle, detail::hostile_triangle,
             detail::open_triangle_calls<1, 64, false, texgen::whole_texture>, detail::triangle_limit<1, 64>},
    Workload{"interpolate a triangle, exact, all outputs, 8 x 8", 23, detail::ordinary_triangle, detail::hostile_triangle,
             detail::triangle_calls<8, 8, true>, detail::triangle_limit<8, 8>},
    Workload{"interpolate a triangle, tolerance, all outputs, 8 x 8", 23, detail::ordinary_triangle, detail::hostile_triangle,
             detail::triangle_calls<8, 8, false>, detail::triangle_limit<8, 8>},
    Workload{"interpolate a triangle, exact, r alone, 64 x 4", 23, detail::ordinary_triangle, detail::hostile_triangle,
             detail::one_output_calls<64, 4, false>, detail::triangle_limit<64, 4>},
    Workload{"interpolate a triangle, exact, lit alone, 64 x 4", 23, detail::ordinary_triangle,
             detail::hostile_triangle, detail::one_output_calls<64, 4, true>, detail::triangle_limit<64, 4>},
    Workload{"interpolate a triangle, exact, lit alone with a depth, 64 x 4", 23, detail::ordinary_triangle,
             detail::hostile_triangle, detail::one_output_calls<64, 4, true, true>, detail::triangle_limit<64, 4>},
    Workload{"TriangleSetup::work with a depth, 64 x 4", 23, detail::ordinary_triangle, detail::hostile_triangle,
             detail::volume_work_calls, detail::always},
    Workload{"interpolate a batch, exact, 8 x 8", 23, detail::ordinary_triangle, detail::hostile_triangle, detail::batch_calls<8, 8, 8, true>, detail::triangle_limit<8, 8>},
    Workload{"interpolate a batch, tolerance, 8 x 8", 23, detail::ordinary_triangle, detail::hostile_triangle, detail::batch_calls<8, 8, 8, false>, detail::triangle_limit<8, 8>},
    Workload{"interpolate a batch, exact, r as well, 8 x 8", 23, detail::ordinary_triangle, detail::hostile_triangle, detail::batch_calls<8, 8, 8, true, detail::OutputsOf::s_t_r>, detail::triangle_limit<8, 8>},
    Workload{"interpolate a batch, exact, lit alone, 8 x 8", 23, detail::ordinary_triangle, detail::hostile_triangle, detail::batch_calls<8, 8, 8, true, detail::OutputsOf::mask>, detail::triangle_limit<8, 8>},
    Workload{"interpolate a batch, tolerance, lit alone with a depth, 8 x 8", 23, detail::ordinary_triangle, detail::hostile_triangle, detail::batch_calls<8, 8, 8, false, detail::OutputsOf::mask_of_depth>, detail::triangle_limit<8, 8>},
    Workload{"interpolate a batch, exact, 64 x 1", 23, detail::ordinary_triangle, detail::hostile_triangle, detail::batch_calls<64, 1, 8, true>, detail::triangle_limit<64, 1>},
    Workload{"interpolate a batch, tolerance, 64 x 1", 23, detail::ordinary_triangle, detail::hostile_triangle, detail::batch_calls<64, 1, 8, false>, detail::triangle_limit<64, 1>},
    Workload{"interpolate a batch of 1, exact, 8 x 8", 23, detail::ordinary_triangle, detail::hostile_triangle, detail::batch_calls<8, 8, 1, true>, detail::triangle_limit<8, 8>},
    Workload{"interpolate a batch of 9, tolerance, 4 x 4", 23, detail::ordinary_triangle, detail::hostile_triangle, detail::batch_calls<4, 4, 9, false>, detail::triangle_limit<4, 4>},
    Workload{"interpolate a batch, some dark or refused, exact, 8 x 8", 23, detail::ordinary_triangle, detail::hostile_triangle, detail::batch_calls<8, 8, 8, true, detail::OutputsOf::s_t, true>, detail::triangle_limit<8, 8>},
    Workload{"TriangleBatch::assign_facing", 23, detail::ordinary_triangle, detail::hostile_triangle,
             detail::batch_facing_calls, detail::always},
    Workload{"interpolate ids, exact, in runs", 23, detail::ordinary_triangle, detail::hostile_triangle, detail::visibility_calls<8, true>, detail::triangle_limit<64, 4>},
    Workload{"interpolate ids, exact, mixed", 23, detail::ordinary_triangle, detail::hostile_triangle, detail::visibility_calls<1, true>, detail::triangle_limit<64, 4>},
    Workload{"interpolate ids, exact, each of another triangle", 23, detail::ordinary_triangle, detail::hostile_triangle, detail::visibility_calls<1, true, detail::OutputsOf::s_t, 256>, detail::triangle_limit<64, 4>},
    Workload{"interpolate ids, tolerance, in runs", 23, detail::ordinary_triangle, detail::hostile_triangle, detail::visibility_calls<8, false>, detail::triangle_limit<64, 4>},
    Workload{"interpolate ids, tolerance, mixed", 23, detail::ordinary_triangle, detail::hostile_triangle, detail::visibility_calls<1, false>, detail::triangle_limit<64, 4>},
    Workload{"interpolate ids, exact, r as well, in runs", 23, detail::ordinary_triangle, detail::hostile_triangle, detail::visibility_calls<8, true, detail::OutputsOf::s_t_r>, detail::triangle_limit<64, 4>},
    Workload{"interpolate ids, exact, lit alone, mixed", 23, detail::ordinary_triangle, detail::hostile_triangle, detail::visibility_calls<1, true, detail::OutputsOf::mask>, detail::triangle_limit<64, 4>},
    Workload{"interpolate ids, tolerance, lit alone with a depth, in runs", 23, detail::ordinary_triangle, detail::hostile_triangle, detail::visibility_calls<8, false, detail::OutputsOf::mask_of_depth>, detail::triangle_limit<64, 4>},
    Workload{"footprint of ids, in runs", 23, detail::ordinary_triangle, detail::hostile_triangle, detail::footprint_ids_calls<8>, detail::triangle_limit<64, 4>},
    Workload{"footprint of ids, mixed", 23, detail::ordinary_triangle, detail::hostile_triangle, detail::footprint_ids_calls<1, 9>, detail::triangle_limit<64, 4>},
    Workload{"FootprintSetup", 23, detail::ordinary_triangle, detail::hostile_triangle, detail::footprint_setup_calls,
             detail::always},
    Workload{"FootprintSetup::at", 23, detail::ordinary_triangle, detail::hostile_triangle, detail::footprint_at_calls,
             detail::triangle_limit<1, 1>},
    Workload{"FootprintSetup::error_bound, 64 x 4", 23, detail::ordinary_triangle, detail::hostile_triangle,
             detail::footprint_bound_calls, detail::always},
    Workload{"FootprintSetup::extremes, 64 x 4", 23, detail::ordinary_triangle, detail::hostile_triangle,
             detail::extremes_calls, detail::always},
    Workload{"FootprintSetup::extremes of the triangle", 23, detail::ordinary_triangle, detail::hostile_triangle,
             detail::all_extremes_calls, detail::always},
    Workload{"footprint, exact, 64 x 4", 23, detail::ordinary_triangle, detail::hostile_triangle,
             detail::footprint_calls<64, 4, true>, detail::triangle_limit<64, 4>},
    Workload{"footprint, tolerance, 8 x 8", 23, detail::ordinary_triangle, detail::hostile_triangle,
             detail::footprint_calls<8, 8, false>, detail::triangle_limit<8, 8>},
    Workload{"footprint_of", 0,
             [](Random& random) {
                 return detail::numbers(1e-3 * random.direction(), 1e-3 * random.uniform(0.5, 2.0), 1024.0, 768.0);
             },
             detail::hostile_numbers<6>, detail::footprint_of_calls, detail::always},
    Workload{"headlights", 23, detail::ordinary_triangle, detail::hostile_triangle, detail::headlights_calls,
             detail::always},
    Workload{"facing", 12, detail::ordinary_corners, detail::hostile_corners, detail::facing_calls,
             detail::facing_limit},
    Workload{"slide_area", 12, detail::ordinary_corners, detail::hostile_corners, detail::slide_area_calls,
             detail::always},
    Workload{"receiver_plane", 12, detail::ordinary_corners, detail::hostile_corners, detail::receiver_plane_calls,
             detail::always},
    Workload{"quadrilateral", 0, detail::ordinary_quadrilateral, detail::hostile_quadrilateral,
             detail::quadrilateral_calls<false>, detail::always},
    Workload{"keystone", 0, detail::ordinary_quadrilateral, detail::hostile_quadrilateral,
             detail::quadrilateral_calls<true>, detail::always},
    Workload{"LitVolume", 0, detail::ordinary_volume, detail::hostile_volume, detail::volume_calls<false>,
             detail::always},
    Workload{"LitVolume with a depth", 0, detail::ordinary_volume, detail::hostile_volume, detail::volume_calls<true>,
             detail::always},
    Workload{"coverage of a box, with a depth", 24, detail::ordinary_boxes, detail::hostile_boxes,
             detail::coverage_calls<texgen::Box, 1, detail::whole_volume>, detail::of_touching},
    Workload{"coverage of 256 boxes, with a depth", 24, detail::ordinary_boxes, detail::hostile_boxes,
             detail::coverage_calls<texgen::Box, detail::bodies, detail::whole_volume>, detail::of_touching},
    Workload{"coverage of a sphere, with a depth", 16, detail::ordinary_spheres, detail::hostile_spheres,
             detail::coverage_calls<texgen::Sphere, 1, detail::whole_volume>, detail::of_touching},
    Workload{"coverage of 256 spheres, with a depth", 16, detail::ordinary_spheres, detail::hostile_spheres,
             detail::coverage_calls<texgen::Sphere, detail::bodies, detail::whole_volume>, detail::of_touching},
    Workload{"coverage of a box, asked once, with a depth", 24, detail::ordinary_boxes, detail::hostile_boxes,
             detail::one_question_calls<texgen::Box, detail::whole_volume>, detail::of_touching},
    Workload{"clip_to_slide with a depth", 24, detail::ordinary_polygon, detail::hostile_numbers<24>,
             detail::clip_calls<false, detail::whole_volume>, detail::always},
    Workload{"coverage of a box", 24, detail::ordinary_boxes, detail::hostile_boxes,
             detail::coverage_calls<texgen::Box, 1>, detail::of_touching},
    Workload{"coverage of 256 boxes", 24, detail::ordinary_boxes, detail::hostile_boxes,
             detail::coverage_calls<texgen::Box, detail::bodies>, detail::of_touching},
    Workload{"coverage of a sphere", 16, detail::ordinary_spheres, detail::hostile_spheres,
             detail::coverage_calls<texgen::Sphere, 1>, detail::of_touching},
    Workload{"coverage of 256 spheres", 16, detail::ordinary_spheres, detail::hostile_spheres,
             detail::coverage_calls<texgen::Sphere, detail::bodies>, detail::of_touching},
    Workload{"coverage of a box, asked once", 24, detail::ordinary_boxes, detail::hostile_boxes,
             detail::one_question_calls<texgen::Box>, detail::of_touching},
    Workload{"coverage of a sphere, asked once, with a depth", 16, detail::ordinary_spheres, detail::hostile_spheres, detail::one_question_calls<texgen::Sphere, detail::whole_volume>, detail::of_touching},
    Workload{"Scene::update with a depth, 64 objects, 4 projectors", 24, detail::ordinary_boxes, detail::hostile_boxes, detail::scene_calls, detail::always},
    Workload{"coverage of a sphere, asked once", 16, detail::ordinary_spheres, detail::hostile_spheres,
             detail::one_question_calls<texgen::Sphere>, detail::of_touching},
    Workload{"clip_planes", 0, detail::ordinary_volume, detail::hostile_volume, detail::planes_calls<false>,
             detail::always},
    Workload{"clip_planes with a depth", 0, detail::ordinary_volume, detail::hostile_volume, detail::planes_calls<true>,
             detail::always},
    Workload{"clip_to_near", 24, detail::ordinary_polygon, detail::hostile_numbers<24>, detail::clip_calls<true>,
             detail::always},
    Workload{"clip_to_slide", 24, detail::ordinary_polygon, detail::hostile_numbers<24>, detail::clip_calls<false>,
             detail::always},
    Workload{"to_window", 8, detail::ordinary_polygon, detail::hostile_numbers<24>, detail::to_window_calls,
             detail::always},
    Workload{"inverse", 0, detail::ordinary_matrix, detail::hostile_matrix, detail::inverse_calls, detail::always},
    Workload{"inverse_error_bound", 0, detail::ordinary_matrix, detail::hostile_matrix, detail::inverse_bound_calls,
             detail::always},
    Workload{"inverse_rigid", 0, detail::ordinary_rigid, detail::hostile_rigid, detail::rigid_calls, detail::always},
    Workload{"eye_planes_as_stored", 0, detail::ordinary_matrix, detail::hostile_matrix, detail::eye_planes_calls,
             detail::always},
    Workload{"eye_planes_error_bound", 0, detail::ordinary_matrix, detail::hostile_matrix,
             detail::eye_planes_bound_calls, detail::always},
    Workload{"planes", 0, detail::ordinary_matrix, detail::hostile_matrix, detail::rounded_planes_calls,
             detail::always},
    Workload{"texture_from_world", 0, detail::ordinary_matrix, detail::hostile_matrix, detail::texture_from_world_calls,
             detail::always},
    Workload{"object_linear", 0, detail::ordinary_matrix, detail::hostile_matrix, detail::composed_calls<true>,
             detail::always},
    Workload{"eye_linear", 0, detail::ordinary_matrix, detail::hostile_matrix, detail::composed_calls<false>,
             detail::always},
    Workload{"eye_linear of what the camera carries", 0, detail::ordinary_matrix, detail::hostile_matrix,
             detail::carried_calls, detail::always},
    Workload{"from_row_vectors, rounded_for_row_vectors", 0, detail::ordinary_matrix, detail::hostile_matrix,
             detail::row_vectors_calls, detail::always},
    Workload{"window_linear", 0, detail::ordinary_camera, detail::hostile_camera, detail::window_linear_calls,
             detail::always},
    Workload{"depth_error_bound", 0, detail::ordinary_matrix, detail::hostile_matrix, detail::depth_bound_calls,
             detail::always},
    Workload{"scale_bias", 0, detail::ordinary_strq, detail::hostile_numbers<4>, detail::scale_bias_calls,
             detail::always},
    Workload{"to_texture", 4, detail::ordinary_strq, detail::hostile_numbers<4>, detail::to_texture_calls,
             detail::always},
    Workload{"product of transforms", 0, detail::ordinary_matrix, detail::hostile_matrix, detail::product_calls,
             detail::always},
    Workload{"Transform::rounded", 0, detail::ordinary_matrix, detail::hostile_matrix, detail::rounded_calls,
             detail::always},
    Workload{"to_eigen, to_eigen_affine", 0, detail::ordinary_rigid, detail::hostile_matrix, detail::to_eigen_calls,
             detail::always},
    Workload{"from_eigen", 0, detail::ordinary_matrix, detail::hostile_matrix, detail::from_eigen_calls,
             detail::always},
    Workload{"Scene::update_eye, 16 projectors", 0, detail::ordinary_matrix, detail::hostile_matrix,
             detail::update_eye_calls, detail::always},
    Workload{"look_at", 0, detail::ordinary_look, detail::hostile_look, detail::look_at_calls, detail::always},
    Workload{"perspective", 0, detail::ordinary_look, detail::hostile_look, detail::lens_calls<0>, detail::always},
    Workload{"frustum", 0, detail::ordinary_look, detail::hostile_look, detail::lens_calls<1>, detail::always},
    Workload{"orthographic", 0, detail::ordinary_look, detail::hostile_look, detail::lens_calls<2>, detail::always},
    Workload{"make_projector, perspective", 0, detail::ordinary_look, detail::hostile_look, detail::lens_calls<3>,
             detail::always},
    Workload{"make_projector, frustum", 0, detail::ordinary_look, detail::hostile_look, detail::lens_calls<4>,
             detail::always},
    Workload{"make_projector, orthographic", 0, detail::ordinary_look, detail::hostile_look, detail::lens_calls<5>,
             detail::always},
    Workload{"pinhole", 0, detail::ordinary_look, detail::hostile_look, detail::lens_calls<6>, detail::always},
    Workload{"make_projector, pinhole", 0, detail::ordinary_look, detail::hostile_look, detail::lens_calls<7>,
             detail::always},
    Workload{"mirrored", 0, detail::ordinary_look, detail::hostile_look, detail::lens_calls<8>, detail::always},
    Workload{"view_from_opencv", 0, detail::ordinary_look, detail::hostile_look, detail::lens_calls<9>, detail::always},
    Workload{"contain", 0, detail::ordinary_look, detail::hostile_look, detail::lens_calls<10>, detail::always},
    Workload{"cover", 0, detail::ordinary_look, detail::hostile_look, detail::lens_calls<11>, detail::always},
    Workload{"TexGenUnit::generate, object linear", 27, detail::ordinary_vertex, detail::hostile_vertex,
             detail::unit_calls<texgen::TexGenMode::object_linear>, detail::always},
    Workload{"TexGenUnit::generate, eye linear", 27, detail::ordinary_vertex, detail::hostile_vertex,
             detail::unit_calls<texgen::TexGenMode::eye_linear>, detail::always},
    Workload{"TexGenUnit::generate, sphere map", 27, detail::ordinary_vertex, detail::hostile_vertex,
             detail::unit_calls<texgen::TexGenMode::sphere_map>, detail::always},
    Workload{"TexGenUnit::generate, reflection map", 27, detail::ordinary_vertex, detail::hostile_vertex,
             detail::unit_calls<texgen::TexGenMode::reflection_map>, detail::always},
    Workload{"TexGenUnit::generate, normal map, 64 vertices", 27, detail::ordinary_vertex, detail::hostile_vertex,
             detail::unit_batch_calls, detail::always},
    Workload{"TexGenUnit::set_eye_plane", 27, detail::ordinary_vertex, detail::hostile_vertex,
             detail::eye_plane_calls<false>, detail::always},
    Workload{"TexGenUnit::eye_plane_error_bound", 27, detail::ordinary_vertex, detail::hostile_vertex,
             detail::eye_plane_calls<true>, detail::always},
    Workload{"diagnose a lens, perspective", 0, detail::ordinary_look, detail::hostile_look, detail::lens_calls<12>,
             detail::always},
    Workload{"diagnose a lens, frustum", 0, detail::ordinary_look, detail::hostile_look, detail::lens_calls<13>,
             detail::always},
    Workload{"diagnose a lens, orthographic", 0, detail::ordinary_look, detail::hostile_look, detail::lens_calls<14>,
             detail::always},
    Workload{"diagnose a lens, pinhole", 0, detail::ordinary_look, detail::hostile_look, detail::lens_calls<15>,
             detail::always},
    Workload{"diagnose a projector", 0, detail::valid_setup, detail::hostile_setup,
             detail::diagnose_calls<detail::Diagnosed::projector>, detail::always},
    Workload{"diagnose a set-up", 0, detail::setup_with_one_defect, detail::hostile_setup,
             detail::diagnose_calls<detail::Diagnosed::setup>, detail::always},
    Workload{"diagnose a valid set-up", 0, detail::valid_setup, detail::hostile_setup,
             detail::diagnose_calls<detail::Diagnosed::valid_setup>, detail::always},
    Workload{"diagnose a texgen matrix", 0, detail::valid_setup, detail::hostile_setup,
             detail::diagnose_calls<detail::Diagnosed::texgen>, detail::always},
    Workload{"diagnose planes", 0, detail::valid_setup, detail::hostile_setup,
             detail::diagnose_calls<detail::Diagnosed::planes>, detail::always},
};

}  // namespace support
