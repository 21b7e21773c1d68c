#pragma once

// Workloads of the diagnosis of set-ups.

#include <algorithm>
#include <array>
#include <cstddef>

#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

#include "support/random.hpp"
#include "support/stopwatch.hpp"
#include "support/workloads/numbers.hpp"
#include "support/workloads/texgens.hpp"
#include "texgen/diagnose.hpp"
#include "texgen/projector.hpp"
#include "texgen/scale_bias.hpp"

namespace support::detail {

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
inline constexpr Inputs setup_inputs{0, valid_setup, draw_setup, "drawn: a set-up with wrong elements"};
inline constexpr Inputs defect_inputs{0, setup_with_one_defect, draw_setup, setup_inputs.words};
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

}  // namespace support::detail
