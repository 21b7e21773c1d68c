// Programs of one call each, as a new user writes them: what the call writes are local variables, of which nothing else
// takes the address, and they are printed by value. A compiler that loses sight of them in the call, as GCC 12 may (its
// bug 115033), prints what they held before. Every public function that writes through a span is called.
//
// The calls are macros: the text of each is a part of every program. A function would hide what the compiler may lose,
// which are outputs: what is read comes from functions.

#include <cstddef>
#include <cstdio>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <texgen/batch.hpp>
#include <texgen/texgen.hpp>

#if __has_include(<Eigen/Core>)
#include <texgen/eigen.hpp>
#include <texgen/reference.hpp>
#endif

#include "one_call/inputs.hpp"

namespace {

using namespace texgen;

// What is called, with `count` values an output, of four coordinates as `mask` says

#define GIVEN(bit) (mask >> (bit)&1) != 0 ? count : 0
#define SPANS(s, t, r, lit) \
    {s, GIVEN(0)}, {t, GIVEN(1)}, {r, GIVEN(2)}, { lit, GIVEN(3) }

#define PROJECT(...)                    \
    const auto given = points<count>(); \
    project(WorldTexgen(matrix()), world_space(given), whole_texture(), {SPANS(__VA_ARGS__)}, tolerance)

#define PROJECT_PLANAR(...)                  \
    const auto [x, y, z] = columns<count>(); \
    project(EyeTexgen(matrix()), eye_space(x, y, z), whole_texture(), {SPANS(__VA_ARGS__)}, tolerance)

#define PROJECT_WITHIN(...)                               \
    const auto given = points<count>();                   \
    const Box all{glm::vec3(-200.0f), glm::vec3(200.0f)}; \
    project(WorldTexgen(matrix()), world_space(given).within(all), whole_texture(), {SPANS(__VA_ARGS__)}, tolerance)

#define PROJECT_STRIDED(...)                                                                           \
    const auto given = strided<count>();                                                               \
    project(ObjectTexgen(matrix()), object_space(given[0].position, count, sizeof given[0]), volume(), \
            {SPANS(__VA_ARGS__)}, tolerance)

#define GENERATE(...)                   \
    const auto given = points<count>(); \
    generate(WorldTexgen(matrix()), world_space(given), HomogeneousTexcoords{SPANS(__VA_ARGS__)})

#define INTERPOLATE(...)                           \
    const auto given = setup(tolerance, volume()); \
    if (given) interpolate(*given, {3, 4, count, 1}, {SPANS(__VA_ARGS__)})

#define INTERPOLATE_BATCH(...)               \
    const FragmentRect rect{3, 4, count, 1}; \
    interpolate(batch(tolerance), std::span(&rect, 1), {SPANS(__VA_ARGS__)})

#define INTERPOLATE_IDS(...) interpolate(batch(tolerance), ids<count>, {3, 4, count, 1}, {SPANS(__VA_ARGS__)})

#define DERIVATIVES_OF_IDS(...) \
    footprint(batch(tolerance), ids<count>, {3, 4, count, 1}, {1024.0, 512.0}, {SPANS(__VA_ARGS__), {}, {}, {}, {}})

#define INTERPOLATE_SEGMENT(...)           \
    const auto alpha = fractions<count>(); \
    interpolate({triangle.a.strq, triangle.b.strq}, alpha, volume(), {SPANS(__VA_ARGS__)}, tolerance)

#define DERIVATIVES(...)                                  \
    const auto given = setup(tolerance, whole_texture()); \
    if (given)                                            \
    footprint(FootprintSetup(*given, {1024.0, 512.0}), {3, 4, count, 1}, {SPANS(__VA_ARGS__), {}, {}, {}, {}})

#define FILTERS(...)                                      \
    const auto given = setup(tolerance, whole_texture()); \
    if (given)                                            \
    footprint(FootprintSetup(*given, {1024.0, 512.0}), {3, 4, count, 1}, {{}, {}, {}, {}, SPANS(__VA_ARGS__)})

#define REFERENCE(...) reference::interpolate(triangle, whole_texture(), {3, 4, count, 1}, {SPANS(__VA_ARGS__)})

#define PROJECT_EIGEN(...)                                                                     \
    const auto given = columns<count>();                                                       \
    const Eigen::Map<const Eigen::Matrix<float, count, 1>> x(given.x), y(given.y), z(given.z); \
    project(WorldTexgen(matrix()), world_space(x, y, z), whole_texture(), {SPANS(__VA_ARGS__)}, tolerance)

// The same, with one output of another type.
#define PROJECT_PAIRS(out)              \
    const auto given = points<count>(); \
    project(WorldTexgen(matrix()), world_space(given), std::span<glm::vec2>(out, count), tolerance)

#define GENERATE_VECTORS(out)           \
    const auto given = points<count>(); \
    generate(WorldTexgen(matrix()), world_space(given), {out, count})

#define FIXED_FUNCTION(out)                                                           \
    FixedFunctionVertex vertices[count];                                              \
    for (int i = 0; i < count; ++i) vertices[i].position = glm::vec4(point(i), 1.0f); \
    TexGenUnit unit;                                                                  \
    unit.enable(Coordinate::s);                                                       \
    unit.generate(vertices, glm::mat4(2.0f), {out, count})

#define COVERAGE(body, out)                 \
    const auto given = bodies<count>(body); \
    coverage(WorldTexgen(matrix()), whole_texture(), given, {out, count})
#define COVERAGE_OF_BOXES(out) COVERAGE(box, out)
#define COVERAGE_OF_SPHERES(out) COVERAGE(sphere, out)

#define VOLUME(body, out)                   \
    const auto given = bodies<count>(body); \
    LitVolume<World>(WorldTexgen(matrix()), whole_texture()).coverage(given, {out, count})
#define VOLUME_AND_BOXES(out) VOLUME(box, out)
#define VOLUME_AND_SPHERES(out) VOLUME(sphere, out)

// Where a program keeps its outputs

constexpr float unwritten = 7.0f;

// Whether all builds compute the same bits: not within a tolerance, nor of what filters make of derivatives. Those are
// printed with a digit, of a sum that is 0.0015 away from where the digit changes, so that none depends on the build.
bool same_bits = true;

[[gnu::noinline]] void print(float value) {
    if (same_bits)
        std::printf(" %a", static_cast<double>(value));
    else
        std::printf(" %.1f", static_cast<double>(value) + 0.0725);
}
void print(glm::vec2 v) { print(v.x), print(v.y); }
void print(glm::vec4 v) { print(v.x), print(v.y), print(v.z), print(v.w); }
void print(Coverage coverage) { std::printf(" %d", static_cast<int>(coverage)); }

void run(const char* name, unsigned mask, void (*program)(Tolerance), Tolerance tolerance, bool is_exact = true) {
    same_bits = is_exact && tolerance.value == 0.0;
    std::printf("%s %u %a", name, mask, tolerance.value);
    program(tolerance);
    std::printf("\n");
}

// Compilers lost variables that are one by one: of those each set of outputs is asked for, of others each alone and
// all.
using AllMasks = std::integer_sequence<unsigned, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15>;
using SomeMasks = std::integer_sequence<unsigned, 1, 2, 4, 8, 15>;

#define FOUR_OUTPUTS(CALL, is_exact)                                                                             \
    template <unsigned mask>                                                                                     \
    [[gnu::noinline]] void CALL##_scalars([[maybe_unused]] Tolerance tolerance) {                                \
        constexpr int count = 1;                                                                                 \
        float s = unwritten, t = unwritten, r = unwritten, lit = unwritten;                                      \
        CALL(&s, &t, &r, &lit);                                                                                  \
        print(s), print(t), print(r), print(lit);                                                                \
    }                                                                                                            \
    template <unsigned mask>                                                                                     \
    [[gnu::noinline]] void CALL##_members([[maybe_unused]] Tolerance tolerance) {                                \
        constexpr int count = 1;                                                                                 \
        struct {                                                                                                 \
            float x = 3.0f, s = unwritten, t = unwritten, r = unwritten, lit = unwritten;                        \
        } vertex;                                                                                                \
        CALL(&vertex.s, &vertex.t, &vertex.r, &vertex.lit);                                                      \
        print(vertex.x), print(vertex.s), print(vertex.t), print(vertex.r), print(vertex.lit);                   \
    }                                                                                                            \
    template <unsigned mask>                                                                                     \
    [[gnu::noinline]] void CALL##_arrays([[maybe_unused]] Tolerance tolerance) {                                 \
        constexpr int count = 3;                                                                                 \
        float s[3] = {unwritten, unwritten, unwritten}, t[3] = {unwritten, unwritten, unwritten};                \
        float r[3] = {unwritten, unwritten, unwritten}, lit[3] = {unwritten, unwritten, unwritten};              \
        CALL(s, t, r, lit);                                                                                      \
        print(s[0]), print(s[1]), print(s[2]), print(t[0]), print(t[1]), print(t[2]);                            \
        print(r[0]), print(r[1]), print(r[2]), print(lit[0]), print(lit[1]), print(lit[2]);                      \
    }                                                                                                            \
    template <unsigned mask>                                                                                     \
    [[gnu::noinline]] void CALL##_vectors([[maybe_unused]] Tolerance tolerance) {                                \
        constexpr int count = 17;                                                                                \
        std::vector<float> s(count, unwritten), t(count, unwritten), r(count, unwritten), lit(count, unwritten); \
        CALL(s.data(), t.data(), r.data(), lit.data());                                                          \
        for (const auto* output : {&s, &t, &r, &lit})                                                            \
            for (const float value : *output) print(value);                                                      \
    }                                                                                                            \
    template <unsigned... mask>                                                                                  \
    void CALL##_few(std::integer_sequence<unsigned, mask...>, Tolerance tolerance) {                             \
        (run(#CALL " scalars", mask, CALL##_scalars<mask>, tolerance, is_exact), ...);                           \
        (run(#CALL " members", mask, CALL##_members<mask>, tolerance, is_exact), ...);                           \
    }                                                                                                            \
    template <unsigned... mask>                                                                                  \
    void CALL##_many(std::integer_sequence<unsigned, mask...>, Tolerance tolerance) {                            \
        (run(#CALL " arrays", mask, CALL##_arrays<mask>, tolerance, is_exact), ...);                             \
        (run(#CALL " vectors", mask, CALL##_vectors<mask>, tolerance, is_exact), ...);                           \
    }                                                                                                            \
    void CALL##_masks() {                                                                                        \
        for (const Tolerance tolerance : {exact, Tolerance{0x1p-12}}) {                                          \
            CALL##_few(AllMasks(), tolerance);                                                                   \
            CALL##_many(SomeMasks(), tolerance);                                                                 \
        }                                                                                                        \
    }

#define ONE_OUTPUT(CALL, Value)                                                                    \
    [[gnu::noinline]] void CALL##_scalar([[maybe_unused]] Tolerance tolerance) {                   \
        constexpr int count = 1;                                                                   \
        auto value = static_cast<Value>(unwritten);                                                \
        CALL(&value);                                                                              \
        print(value);                                                                              \
    }                                                                                              \
    [[gnu::noinline]] void CALL##_member([[maybe_unused]] Tolerance tolerance) {                   \
        constexpr int count = 1;                                                                   \
        struct {                                                                                   \
            float x = 3.0f;                                                                        \
            Value value = static_cast<Value>(unwritten);                                           \
        } vertex;                                                                                  \
        CALL(&vertex.value);                                                                       \
        print(vertex.x), print(vertex.value);                                                      \
    }                                                                                              \
    [[gnu::noinline]] void CALL##_array([[maybe_unused]] Tolerance tolerance) {                    \
        constexpr int count = 3;                                                                   \
        constexpr auto none = static_cast<Value>(unwritten);                                       \
        Value value[3] = {none, none, none};                                                       \
        CALL(value);                                                                               \
        print(value[0]), print(value[1]), print(value[2]);                                         \
    }                                                                                              \
    [[gnu::noinline]] void CALL##_vector([[maybe_unused]] Tolerance tolerance) {                   \
        constexpr int count = 17;                                                                  \
        std::vector<Value> values(count, static_cast<Value>(unwritten));                           \
        CALL(values.data());                                                                       \
        for (const Value value : values) print(value);                                             \
    }                                                                                              \
    void CALL##_all() {                                                                            \
        for (const Tolerance tolerance : {exact, Tolerance{0x1p-12}})                              \
            for (const auto program : {CALL##_scalar, CALL##_member, CALL##_array, CALL##_vector}) \
                run(#CALL, 1, program, tolerance);                                                 \
    }

FOUR_OUTPUTS(PROJECT, true)
FOUR_OUTPUTS(PROJECT_PLANAR, true)
FOUR_OUTPUTS(PROJECT_STRIDED, true)
FOUR_OUTPUTS(PROJECT_WITHIN, true)
FOUR_OUTPUTS(GENERATE, true)
FOUR_OUTPUTS(INTERPOLATE, true)
FOUR_OUTPUTS(INTERPOLATE_BATCH, true)
FOUR_OUTPUTS(INTERPOLATE_IDS, true)
FOUR_OUTPUTS(DERIVATIVES_OF_IDS, true)
FOUR_OUTPUTS(INTERPOLATE_SEGMENT, true)
FOUR_OUTPUTS(DERIVATIVES, true)
FOUR_OUTPUTS(FILTERS, false)
#if __has_include(<Eigen/Core>)
FOUR_OUTPUTS(PROJECT_EIGEN, true)
FOUR_OUTPUTS(REFERENCE, true)
#endif
ONE_OUTPUT(PROJECT_PAIRS, glm::vec2)
ONE_OUTPUT(GENERATE_VECTORS, glm::vec4)
ONE_OUTPUT(FIXED_FUNCTION, glm::vec4)
ONE_OUTPUT(COVERAGE_OF_BOXES, Coverage)
ONE_OUTPUT(COVERAGE_OF_SPHERES, Coverage)
ONE_OUTPUT(VOLUME_AND_BOXES, Coverage)
ONE_OUTPUT(VOLUME_AND_SPHERES, Coverage)

// A corner is outside, so that two new vertices are written.
constexpr ClipVertex polygon[] = {{{0.0f, 0.0f, 0.5f, 1.0f}, triangle.a.strq},
                                  {{1.0f, 0.0f, 0.25f, 1.0f}, triangle.b.strq},
                                  {{0.0f, 1.0f, -4.0f, 1.0f}, triangle.c.strq}};

template <class Clip>
void run_clip(const char* name, Clip clip) {
    same_bits = true;
    std::printf("%s", name);
    clip();
    std::printf("\n");
}

[[gnu::noinline]] void clip_near() {
    ClipVertex out[4] = {};
    const std::size_t count = clip_to_near(polygon, out, DepthRange::zero_to_one);
    std::printf(" %zu", count);
    print(out[0].position), print(out[1].strq), print(out[2].position), print(out[3].strq);
}

[[gnu::noinline]] void clip_slide() {
    ClipVertex out[8] = {};
    const std::size_t count = clip_to_slide(polygon, whole_texture(), out);
    std::printf(" %zu", count);
    print(out[0].position), print(out[1].strq), print(out[2].position), print(out[3].strq), print(out[4].strq);
}

// It writes through no span; its result is a local variable all the same.
[[gnu::noinline]] void project_alone() {
    std::optional<glm::vec2> st = glm::vec2(unwritten);
    same_bits = true;
    std::printf("project a point");
    for (int i = 0; i < 4; ++i) {
        st = project(WorldTexgen(matrix()), world_space(point(i)));
        print(st.has_value() ? 1.0f : 0.0f), print(st.value_or(glm::vec2(0.0f)));
    }
    std::printf("\n");
}

}  // namespace

int main() {
    PROJECT_masks();
    PROJECT_PLANAR_masks();
    PROJECT_STRIDED_masks();
    PROJECT_WITHIN_masks();
    GENERATE_masks();
    INTERPOLATE_masks();
    INTERPOLATE_BATCH_masks();
    INTERPOLATE_IDS_masks();
    DERIVATIVES_OF_IDS_masks();
    INTERPOLATE_SEGMENT_masks();
    DERIVATIVES_masks();
    FILTERS_masks();
#if __has_include(<Eigen/Core>)
    PROJECT_EIGEN_masks();
    REFERENCE_masks();
#endif
    PROJECT_PAIRS_all();
    GENERATE_VECTORS_all();
    FIXED_FUNCTION_all();
    COVERAGE_OF_BOXES_all();
    COVERAGE_OF_SPHERES_all();
    VOLUME_AND_BOXES_all();
    VOLUME_AND_SPHERES_all();
    project_alone();
    run_clip("clip_to_near", clip_near);
    run_clip("clip_to_slide", clip_slide);
}
