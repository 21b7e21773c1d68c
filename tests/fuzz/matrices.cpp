// Everything that makes or takes a matrix, over raw bytes: what is empty and what is finite, which bad number stays
// where, and relations that hold whatever the numbers are.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "fuzz/input.hpp"
#include "texgen/eigen.hpp"
#include "texgen/fixed_function.hpp"
#include "texgen/linear.hpp"
#include "texgen/projector.hpp"
#include "texgen/scale_bias.hpp"
#include "texgen/transform.hpp"

namespace {

using fuzz::all_finite;
using fuzz::Input;
using fuzz::must;
using fuzz::same;
using texgen::Coordinate;
using texgen::TexGenMode;
using texgen::TexGenUnit;

bool all_in_range(const glm::dmat4& m, double least, double largest) {
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            if (const double size = std::fabs(m[column][row]); size != 0.0 && !(size >= least && size <= largest))
                return false;
    return true;
}

void inverses(Input& input) {
    glm::dmat4 m = input.coin() ? glm::dmat4(input.matrix()) : input.wide_matrix();
    const auto result = inverse(texgen::ModelMatrix(m));
    must(!result || all_finite(result->matrix()), "an inverse is finite");
    must(!result || all_finite(m), "what is not finite has no inverse");

    // A power of two changes nothing but the exponents.
    const int exponent = input.integer(-64, 64);
    if (all_in_range(m, 0x1p-300, 0x1p300)) {
        glm::dmat4 scaled = m;
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 4; ++row) scaled[column][row] = std::ldexp(m[column][row], exponent);
        const auto inverse_of_scaled = inverse(texgen::ModelMatrix(scaled));
        if (result && inverse_of_scaled && all_in_range(result->matrix(), 0x1p-800, 0x1p800)) {
            for (int column = 0; column < 4; ++column)
                for (int row = 0; row < 4; ++row)
                    must(
                        std::ldexp(inverse_of_scaled->matrix()[column][row], exponent) == result->matrix()[column][row],
                        "the inverse of a scaled matrix is scaled");
        }
    }
    if (result) {
        const glm::dmat4 bound = inverse_error_bound(texgen::ModelMatrix(m), *result);
        for (int k = 0; k < 16; ++k) must(bound[k / 4][k % 4] >= 0.0, "an error bound is no NaN, and not negative");
    }
    const auto planes = eye_planes_as_stored(texgen::ObjectTexgen(input.wide_matrix()), texgen::ModelviewMatrix(m));
    must(!planes || all_finite(planes->matrix()), "stored planes are finite");
    must(!planes || all_finite(m), "nothing is stored under what is not finite");

    // Two equal rows, or columns, up to a power of two.
    const int from = input.integer(0, 3), to = (from + input.integer(1, 3)) % 4;
    const double factor = std::ldexp(1.0, input.integer(-20, 20));
    const bool rows = input.coin();
    for (int i = 0; i < 4; ++i)
        if (rows)
            m[i][to] = factor * m[i][from];
        else
            m[to][i] = factor * m[from][i];
    if (all_in_range(m, 0x1p-900, 0x1p900)) {
        must(!inverse(texgen::ModelMatrix(m)), "what is singular has no inverse");
        must(!eye_planes_as_stored(texgen::ObjectTexgen(glm::dmat4(1.0)), texgen::ModelviewMatrix(m)),
             "nothing is stored under what is singular");
        TexGenUnit unit;
        const glm::mat4 rounded(m);
        if (glm::dmat4(rounded) == m) {
            must(!unit.set_eye_plane(Coordinate::s, glm::vec4(5.0f), rounded), "a singular MODELVIEW is refused");
            must(unit.eye_plane(Coordinate::s) == glm::vec4(1, 0, 0, 0), "a refused plane changes nothing");
        }
    }
}

void require_projection(const std::optional<texgen::ProjectorProjection>& projection, bool bad) {
    must(!projection || all_finite(projection->matrix()), "a lens is finite");
    must(!projection || !bad, "a lens out of range is empty");
}

void projectors(Input& input) {
    const texgen::Conventions conventions = input.conventions();
    const texgen::TextureRegion region = input.region();
    const auto depth = input.coin() ? texgen::DepthMapping::ndc : texgen::DepthMapping::unit;
    const texgen::Aim aim{input.wide_vector3(), input.wide_vector3(), input.wide_vector3()};
    const auto view = look_at(aim);
    if (view) {
        must(!(texgen::detail::distance_from_rigid(view->matrix()) > 1e-14), "a view is rigid");
        const auto back = inverse_rigid(*view);
        must(texgen::detail::distance_from_rigid(back.matrix()) <= 1e-14, "and so is its inverse");
    }
    const glm::dmat3 rotation(input.wide_matrix());
    const auto of_opencv = texgen::view_from_opencv(rotation, aim.position);
    must(!of_opencv || all_finite(of_opencv->matrix()), "a view is finite");
    const texgen::ProjectorView any_view(input.wide_matrix());
    const glm::dvec4 plane(input.wide_vector3(), input.wide_number());
    const auto mirrored = texgen::mirrored(any_view, plane);
    must(!mirrored || (all_finite(mirrored->matrix()) && all_finite(any_view.matrix())), "a mirrored view is finite");
    double field[6];
    for (double& f : field) f = input.wide_number();
    bool any_bad = false;
    for (const double f : field) any_bad = any_bad || !std::isfinite(f);
    const auto& [a, b, c, d, e, f] = field;
    const texgen::PerspectiveLens any_lens{texgen::radians(a), b, c, d};
    const auto contained = perspective(contain(any_lens, e), conventions);
    must(!contained || (a > 0.0 && b > 0.0 && c > 0.0 && c < d && e > 0.0), "a lens that is none contains no picture");
    const texgen::TextureRegion crop = cover(any_lens, e, region);
    if (region.min().x <= region.max().x && region.max().x < 1e300 && region.min().x > -1e300)
        must(!(crop.min().x < region.min().x || crop.max().x > region.max().x), "a crop is a part");
    std::optional<texgen::Projector> projector;
    switch (input.integer(0, 3)) {
        case 0: {
            const texgen::PerspectiveLens lens{input.coin() ? texgen::degrees(a) : texgen::radians(a), b, c, d,
                                               input.coin()};
            require_projection(perspective(lens, conventions), !(a > 0.0 && b > 0.0 && c > 0.0 && c < d));
            projector = make_projector(lens, aim, conventions);
            must(projector.has_value() == (view.has_value() && perspective(lens, conventions).has_value()),
                 "a projector is there where its lens and its aim are");
            break;
        }
        case 1: {
            const texgen::FrustumLens lens{a, b, c, d, e, f};
            require_projection(frustum(lens, conventions), any_bad || a == b || c == d || !(e > 0.0 && e < f));
            projector = make_projector(lens, aim, conventions);
            break;
        }
        case 2: {
            const texgen::PinholeLens lens{a,
                                           b,
                                           e,
                                           f,
                                           c,
                                           d,
                                           input.wide_number(),
                                           input.wide_number(),
                                           input.coin() ? texgen::PixelCentre::half : texgen::PixelCentre::integer,
                                           input.wide_number()};
            require_projection(pinhole(lens, conventions), any_bad || !(a > 0.0 && b > 0.0 && c > 0.0 && d > 0.0) ||
                                                               !(lens.z_near > 0.0 && lens.z_near < lens.z_far) ||
                                                               !std::isfinite(lens.skew));
            projector = make_projector(lens, aim, conventions);
            break;
        }
        default: {
            const texgen::OrthographicLens lens{a, b, c, d, e, f};
            require_projection(orthographic(lens, conventions), any_bad || a == b || c == d || !(e < f));
            projector = make_projector(lens, aim, conventions);
            break;
        }
    }
    if (projector) {
        const auto world = texture_from_world(*projector, region, depth);
        const auto object = object_linear(*projector, texgen::ModelMatrix(glm::dmat4(1.0)), region, depth);
        const auto eye = eye_linear(*projector, texgen::CameraPose(glm::dmat4(1.0)), region, depth);
        (void)projector->matrix();
        const auto carried =
            eye_linear(projector->projection, texgen::Transform<texgen::ProjectorEye, texgen::Eye>(glm::dmat4(1.0)),
                       conventions, region, depth);
        const auto of_lens = scale_bias(conventions, region, depth) * projector->projection;
        if (all_finite(of_lens.matrix())) must(carried.matrix() == of_lens.matrix(), "a light at the eye is S P_p");
        for (int column = 0; column < 4; ++column) {
            for (int row = 0; row < 4; ++row) {
                const double w = world.matrix()[column][row];
                must((std::isnan(w) && std::isnan(object.matrix()[column][row])) ||
                         (w == object.matrix()[column][row] && w == eye.matrix()[column][row]) || std::isnan(w),
                     "with identities the three texgen matrices are one");
            }
        }
        const texgen::Viewport viewport{input.integer(-9, 9), input.integer(-9, 9), input.integer(-99, 99),
                                        input.integer(-99, 99)};
        const texgen::Projector camera{texgen::ProjectorProjection(input.wide_matrix()), projector->view, conventions};
        const auto window = window_linear(*projector, input.coin() ? camera : *projector, viewport, region, depth);
        must(!window || all_finite(window->matrix()), "a window's texgen matrix is finite");
        must(!window || (viewport.width != 0 && viewport.height != 0), "a window without an area has none");
        if (window) {
            const auto buffer = static_cast<texgen::DepthBuffer>(input.integer(0, 2));
            const glm::dvec2 bound = depth_error_bound(*window, input.vector3(), buffer);
            must(bound.x >= 0.0 && bound.y >= 0.0, "a depth's error bound is no NaN, and not negative");
        }
        const auto rows = planes(world);
        for (int row = 0; row < 4; ++row)
            for (int column = 0; column < 4; ++column)
                must(same(rows[static_cast<std::size_t>(row)][column], world.rounded()[column][row]),
                     "planes are the rows");
    }
}

void remaps(Input& input) {
    const texgen::Conventions conventions = input.conventions();
    const texgen::TextureRegion region = input.region();
    const auto depth = input.coin() ? texgen::DepthMapping::ndc : texgen::DepthMapping::unit;
    const glm::vec4 clip = input.vector4();
    const glm::dmat4 s = scale_bias(conventions, region, depth).matrix();
    const glm::vec4 texture = to_texture(clip, conventions, region, depth);
    must(same(texture.w, clip.w), "the remap keeps q");
    if (all_finite(clip) && all_finite(s)) {
        const glm::dvec4 v(clip);
        for (int k = 0; k < 2; ++k) {
            const double side = std::fmax(std::fabs(region.min()[k]), std::fabs(region.max()[k]));
            const double expected = s[0][k] * v.x + s[1][k] * v.y + s[2][k] * v.z + s[3][k] * v.w;
            const double size = side * std::fmax(std::fabs(v[k]), std::fabs(v.w));
            if (!(size < 0x1p127)) continue;
            must(std::fabs(static_cast<double>(texture[k]) - expected) <=
                     0x1.01p-24 * std::fabs(expected) + 0x1p-48 * size + 0x1p-149,
                 "the remap is S times the clip coordinate");
        }
    }
    // A bad x spoils s only.
    glm::vec4 bad = clip;
    const int component = input.integer(0, 2);
    bad[component] = std::numeric_limits<float>::quiet_NaN();
    const glm::vec4 after = to_texture(bad, conventions, region, depth);
    for (int k = 0; k < 4; ++k)
        if (k != component) must(same(after[k], texture[k]), "a bad value spoils its own component");
}

void eigen(Input& input) {
    const glm::dmat4 m = input.wide_matrix();
    Eigen::Matrix4d given;
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row) given(row, column) = m[column][row];
    const auto model = texgen::from_eigen<texgen::ModelMatrix>(given);
    const Eigen::Matrix4d back = to_eigen(model);
    const auto rounded = texgen::to_eigen<Eigen::Matrix4f>(model);
    const bool is_affine = m[0][3] == 0.0 && m[1][3] == 0.0 && m[2][3] == 0.0 && m[3][3] == 1.0;
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) {
            must(same(model.matrix()[column][row], m[column][row]) && same(back(row, column), m[column][row]),
                 "Eigen's elements are kept");
            must(same(rounded(row, column), model.rounded()[column][row]), "and rounded once");
        }
    }
    must(to_eigen_affine(model).has_value() == is_affine, "what is affine is an Affine3d, and nothing else");
}

void fixed_function(Input& input) {
    TexGenUnit unit;
    for (int i = input.integer(0, 12); i > 0; --i) {
        const auto coordinate = static_cast<Coordinate>(input.integer(-1, 5));
        const bool is_one = static_cast<int>(coordinate) >= 0 && static_cast<int>(coordinate) <= 3;
        switch (input.integer(0, 5)) {
            case 0:
                unit.enable(coordinate, input.coin());
                must(is_one || !unit.enabled(coordinate), "no coordinate is not enabled");
                break;
            case 1: {
                const auto mode = static_cast<TexGenMode>(input.integer(-1, 6));
                const TexGenMode before = unit.mode(coordinate);
                const bool taken = unit.set_mode(coordinate, mode);
                must(unit.mode(coordinate) == (taken ? mode : before), "a mode is taken, or nothing changes");
                break;
            }
            case 2: {
                const glm::vec4 plane = input.vector4();
                unit.set_object_plane(coordinate, plane);
                if (is_one) must(same(unit.object_plane(coordinate), plane), "an object plane is stored as it is");
                break;
            }
            case 3: {
                const glm::vec4 before = unit.eye_plane(coordinate), plane = input.vector4();
                const bool taken = unit.set_eye_plane(coordinate, plane, input.matrix());
                must(all_finite(unit.eye_plane(coordinate)), "no plane is stored that is not finite");
                must(taken || same(before, unit.eye_plane(coordinate)), "a refused plane changes nothing");
                break;
            }
            case 4:
                unit.set_texture_matrix(input.coin() ? glm::mat4(1.0f) : input.matrix());
                break;
            default:
                unit.set_normal_scaling(static_cast<TexGenUnit::NormalScaling>(input.integer(-1, 4)));
                break;
        }
    }
    const glm::mat4 modelview = input.matrix();
    std::vector<texgen::FixedFunctionVertex> vertices(1 + input.size(4));
    for (auto& v : vertices) v = {input.vector4(), input.vector3(), input.vector4()};
    std::vector<glm::vec4> out(vertices.size() + 2, glm::vec4(-7.0f));
    unit.generate(vertices, modelview, std::span(out).subspan(1, vertices.size()));
    must(out.front() == glm::vec4(-7.0f) && out.back() == glm::vec4(-7.0f), "generate writes its outputs only");
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const glm::vec4 alone = unit.generate(vertices[i], modelview);
        must(same(alone, out[1 + i]), "a batch has the bits of its vertices");
        if (unit.texture_matrix() != glm::mat4(1.0f)) continue;
        for (int k = 0; k < 4; ++k) {
            const auto coordinate = static_cast<Coordinate>(k);
            if (!unit.enabled(coordinate))
                must(same(alone[k], vertices[i].texcoord[k]), "a coordinate that is off is the vertex's own");
            else if (unit.mode(coordinate) == TexGenMode::sphere_map)
                must(std::isnan(alone[k]) || (alone[k] >= 0.0f && alone[k] <= 1.0f), "the sphere map stays in [0, 1]");
        }
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Input input(data, size);
    switch (input.integer(0, 4)) {
        case 0:
            inverses(input);
            break;
        case 1:
            projectors(input);
            break;
        case 2:
            remaps(input);
            break;
        case 3:
            eigen(input);
            break;
        default:
            fixed_function(input);
            break;
    }
    return 0;
}
