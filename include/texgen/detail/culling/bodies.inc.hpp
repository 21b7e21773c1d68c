// Many bodies against the forms of a slide: in floats first, and those that floats leave open in groups.

namespace TEXGEN_DETAIL {

// Kernels know only the numbers of Coverage.
static_assert(Coverage{0} == Coverage::outside && Coverage{1} == Coverage::partial && Coverage{2} == Coverage::inside);

// Copies the floats of a body to places that are `distance` floats apart.
inline void copy_floats(const Box& box, float* to, std::size_t distance) noexcept {
    TEXGEN_FOR (std::size_t j = 0; j < 3; ++j) {
        to[j * distance] = box.min[static_cast<glm::length_t>(j)];
        to[(3 + j) * distance] = box.max[static_cast<glm::length_t>(j)];
    }
}
inline void copy_floats(const Sphere& sphere, float* to, std::size_t distance) noexcept {
    TEXGEN_FOR (std::size_t j = 0; j < 3; ++j) to[j * distance] = sphere.centre[static_cast<glm::length_t>(j)];
    to[3 * distance] = sphere.radius;
}

// Classifies bodies of `Floats` floats each by a kernel. Bodies that it leaves open are gathered until they fill
// vectors, and `decide` classifies them. Where bodies have gaps between them, as where the user aligns GLM's vectors,
// their floats are copied.
template <std::size_t Floats, class Body, class Decide>
void classify_many(const LitForms& forms, const FloatForms& float_forms, const std::span<const Body>& bodies,
                   const std::span<Coverage>& out, Classify classify, const Decide& decide) noexcept {
    constexpr std::size_t chunk = 16 * body_quantum;
    constexpr bool is_dense = sizeof(Body) == Floats * sizeof(float);
    constexpr std::size_t copied = is_dense ? body_quantum : chunk;
    TEXGEN_ASSERT(bodies.size() == out.size());
    if (bodies.size() != out.size()) return;
    if (!forms.can_say()) {
        for (std::size_t i = 0; i < bodies.size(); ++i) out[i] = coverage_without_forms(forms, bodies[i]);
        return;
    }
    int classes[chunk];
    std::size_t open[chunk + body_quantum];
    std::size_t open_count = 0;
    OpenRow rows[Floats] = {};
    const auto decide_last = [&](std::size_t count) {
        bool is_any_in_doubt = false;
        open_count -= count;
        for (std::size_t k = 0; k < count; ++k) {
            const std::size_t i = open[open_count + k];
            copy_floats(bodies[i], &rows[0][k], body_quantum);
            is_any_in_doubt |= out[i] == Coverage{body_in_doubt & 3};
        }
        decide(rows, count, is_any_in_doubt, classes);
        for (std::size_t k = 0; k < count; ++k) {
            const std::size_t i = open[open_count + k];
            out[i] = classes[k] == body_in_doubt ? coverage_without_forms(forms, bodies[i])
                                                 : static_cast<Coverage>(classes[k]);
        }
    };
    for (std::size_t begin = 0; begin < bodies.size();) {
        // Whole quanta are read where they are, a rest with some of the bodies before it, and a few from a copy.
        const std::size_t left = bodies.size() - begin;
        const std::size_t count = left >= chunk          ? chunk
                                  : left >= body_quantum ? left / body_quantum * body_quantum
                                                         : left;
        const std::size_t before = is_dense && begin != 0 && count < body_quantum ? body_quantum - count : 0;
        if (is_dense && before + count >= body_quantum) {
            classify(float_forms, reinterpret_cast<const float*>(&bodies[begin - before]), before + count, classes);
        } else {
            float copies[copied][Floats] = {};
            for (std::size_t i = 0; i < count; ++i) copy_floats(bodies[begin + i], copies[i], 1);
            classify(float_forms, copies[0], (count + body_quantum - 1) / body_quantum * body_quantum, classes);
        }
        // Each body is written behind the open ones, and counted if it is open: there is no branch for each.
        for (std::size_t i = 0; i < count; ++i) {
            const int body_class = classes[before + i];
            out[begin + i] = static_cast<Coverage>(body_class & 3);
            open[open_count] = begin + i;
            open_count += static_cast<std::size_t>(body_class >= open_body);
        }
        begin += count;
        while (open_count >= body_quantum) decide_last(body_quantum);
    }
    if (open_count > 0) decide_last(open_count);
}

}  // namespace TEXGEN_DETAIL
