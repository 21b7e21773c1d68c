// What a slide covers of boxes and spheres: never a false outside, never a false inside, judged by exact sums.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/matrix.hpp>

#include "judges/exact.hpp"
#include "judges/rational_matrix.hpp"
#include "support/hex.hpp"
#include "support/random.hpp"
#include "support/special_values.hpp"
#include "texgen/coverage.hpp"
#include "texgen/linear.hpp"
#include "texgen/projector.hpp"
#include "texgen/texcoord.hpp"

namespace {

using support::Dyadic;
using support::hex;
using support::infinity_float;
using support::nan_float;
using support::Random;
using texgen::atlas_tile;
using texgen::Box;
using texgen::Coverage;
using texgen::coverage;
using texgen::degrees;
using texgen::LitVolume;
using texgen::Sphere;
using texgen::TextureRegion;
using texgen::whole_texture;
using texgen::WorldTexgen;

constexpr double infinite = std::numeric_limits<double>::infinity();

std::string hex(const Box& box) { return "box " + hex(box.min) + " to " + hex(box.max); }
std::string hex(const Sphere& sphere) { return "sphere " + hex(sphere.centre) + ", radius " + hex(sphere.radius); }

// How many bodies a test takes, unless the environment says otherwise.
long count_of(const char* name, long usual) {
    const char* text = std::getenv(name);
    return text != nullptr ? std::atol(text) : usual;
}

// c[0] x + c[1] y + c[2] z + c[3] >= 0, or > 0.
struct Inequality {
    std::array<Dyadic, 4> c;
    bool is_strict;
    std::array<double, 4> near_to_c = {};  // within a few ulp, of those that are asked often
};

// Whether a point fulfils all of them: Fourier and Motzkin's elimination, which is exact, and for the last variable its
// greatest lower bound against its least upper one.
bool have_a_solution(std::vector<Inequality> all) {
    for (std::size_t variable = 0; variable < 2; ++variable) {
        std::vector<Inequality> rest, lower, upper;
        for (const Inequality& one : all) {
            const int sign = one.c[variable].sign();
            (sign == 0 ? rest : sign > 0 ? lower : upper).push_back(one);
        }
        for (const Inequality& low : lower) {
            for (const Inequality& high : upper) {
                Inequality sum{{}, low.is_strict || high.is_strict, {}};
                for (std::size_t k = variable + 1; k < 4; ++k)
                    sum.c[k] = high.c[k] * low.c[variable] - low.c[k] * high.c[variable];
                rest.push_back(sum);
            }
        }
        all = rest;
    }
    const Inequality *low = nullptr, *high = nullptr;  // z >= -low.c[3] / low.c[2], z <= high.c[3] / -high.c[2]
    for (const Inequality& one : all) {
        const int sign = one.c[2].sign();
        if (sign == 0) {
            if (one.c[3].sign() < (one.is_strict ? 1 : 0)) return false;
            continue;
        }
        const Inequality*& bound = sign > 0 ? low : high;
        if (bound == nullptr) {
            bound = &one;
            continue;
        }
        const int order =
            (one.c[3] * support::magnitude(bound->c[2]) - bound->c[3] * support::magnitude(one.c[2])).sign();
        if (order < 0 || (order == 0 && one.is_strict)) bound = &one;
    }
    if (low == nullptr || high == nullptr) return true;
    const int gap = (high->c[3] * low->c[2] - low->c[3] * high->c[2]).sign();
    return gap > 0 || (gap == 0 && !low->is_strict && !high->is_strict);
}

// A region of real numbers about those that are inside the given one, or may be rounded into it; and one in those that
// are rounded into it. Subnormal numbers may count as 0.
struct Rounded {
    double outer, inner;

    static Rounded of_min(double min) {
        if (!std::isfinite(min)) return {min, min};
        float first = support::to_float(min);
        while (static_cast<double>(first) < min) first = std::nextafter(first, infinity_float);
        if (std::fabs(min) < 0x1p-126) return {-0x1p-126, first > 0.0f ? 0x1p-126 : static_cast<double>(first)};
        return {static_cast<double>(std::nextafter(first, -infinity_float)), static_cast<double>(first)};
    }
    static Rounded of_max(double max) {
        const Rounded mirrored = of_min(-max);
        return {-mirrored.outer, -mirrored.inner};
    }
};

// The coordinates that a region limits, rows of the matrix, and the limits of each: s, t, and r where it has a depth.
int limited(const TextureRegion& region) { return region.depth() ? 3 : 2; }
glm::dvec2 limits(const TextureRegion& region, int k) {
    return k == 2 ? *region.depth() : glm::dvec2(region.min()[k], region.max()[k]);
}

// The truth: of what is outside, of the outer region; of what is inside, of the inner one. An infinite side is none.
class Judge {
public:
    Judge(const glm::dmat4& matrix, const TextureRegion& region) {
        const auto row = [&](int k) {
            std::array<Dyadic, 4> c;
            for (int j = 0; j < 4; ++j) c[static_cast<std::size_t>(j)] = Dyadic(matrix[j][k]);
            return c;
        };
        const std::array<Dyadic, 4> q = row(3);
        const auto form = [&](const std::array<Dyadic, 4>& coordinate, double side, double sign) {
            Inequality one{{}, false, {}};
            for (std::size_t j = 0; j < 4; ++j) one.c[j] = Dyadic(sign) * (coordinate[j] - Dyadic(side) * q[j]);
            return one;
        };
        for (int k = 0; k < 2 * limited(region); ++k) {
            const double sign = k % 2 == 0 ? 1.0 : -1.0;
            const glm::dvec2 given = limits(region, k / 2);
            const auto [outer, inner] = k % 2 == 0 ? Rounded::of_min(given.x) : Rounded::of_max(given.y);
            if (!std::isinf(outer)) forms_.push_back(form(row(k / 2), outer, sign));
            if (!std::isinf(inner)) inner_forms_.push_back(form(row(k / 2), inner, sign));
            no_float_is_inside_ = no_float_is_inside_ || inner == sign * infinite;
        }
        forms_.push_back({q, true, {}});
        inner_forms_.push_back({q, true, {}});
        for (std::vector<Inequality>* const forms : {&forms_, &inner_forms_})
            for (Inequality& one : *forms)
                for (std::size_t j = 0; j < 4; ++j) one.near_to_c[j] = one.c[j].estimate();
    }

    const std::vector<Inequality>& forms() const { return forms_; }
    const std::vector<Inequality>& inner_forms() const { return inner_forms_; }
    bool no_float_is_inside() const { return no_float_is_inside_; }

    // The sign of a form where it is largest over the box (or least).
    static int extreme_sign(const Inequality& form, const Box& box, bool largest) {
        std::array<double, 3> vertex{};
        double nearly = form.near_to_c[3], size = std::fabs(nearly);
        for (int j = 0; j < 3; ++j) {
            const auto i = static_cast<std::size_t>(j);
            const int sign = form.c[i].sign();
            if (sign == 0) continue;
            vertex[i] = static_cast<double>((sign > 0) == largest ? box.max[j] : box.min[j]);
            if (std::isinf(vertex[i])) return largest ? 1 : -1;
            nearly += form.near_to_c[i] * vertex[i];
            size += std::fabs(form.near_to_c[i] * vertex[i]);
        }
        // A dozen roundings, each below 2^-50 of what it is of.
        if (std::fabs(nearly) > 0x1p-45 * size + 0x1p-900 && size < 0x1p900) return nearly > 0.0 ? 1 : -1;
        Dyadic value = form.c[3];
        for (std::size_t j = 0; j < 3; ++j)
            if (form.c[j].sign() != 0) value = value + form.c[j] * Dyadic(vertex[j]);
        return value.sign();
    }

    bool is_outside_a_plane(const Box& box) const {
        return std::ranges::any_of(
            forms_, [&](const Inequality& form) { return extreme_sign(form, box, true) < (form.is_strict ? 1 : 0); });
    }
    bool is_inside(const Box& box) const {
        return !no_float_is_inside_ && std::ranges::all_of(inner_forms_, [&](const Inequality& form) {
            return extreme_sign(form, box, false) >= (form.is_strict ? 1 : 0);
        });
    }
    // Whether it touches one of the inner planes: those of the region as it is given, where its sides are floats.
    bool touches(const Box& box) const {
        return std::ranges::any_of(inner_forms_, [&](const Inequality& form) {
            return extreme_sign(form, box, true) == 0 || extreme_sign(form, box, false) == 0;
        });
    }
    bool is_outside(const Box& box) const {
        std::vector<Inequality> all = forms_;
        for (int j = 0; j < 3; ++j) {
            Inequality low{{}, false, {}}, high{{}, false, {}};
            low.c[static_cast<std::size_t>(j)] = Dyadic(1.0);
            high.c[static_cast<std::size_t>(j)] = Dyadic(-1.0);
            if (!std::isinf(box.min[j])) {
                low.c[3] = -Dyadic(box.min[j]);
                all.push_back(low);
            }
            if (!std::isinf(box.max[j])) {
                high.c[3] = Dyadic(box.max[j]);
                all.push_back(high);
            }
        }
        return !have_a_solution(all);
    }

private:
    std::vector<Inequality> forms_, inner_forms_;  // q is the last
    bool no_float_is_inside_ = false;
};

bool has_nan(const Box& box) {
    for (int j = 0; j < 3; ++j)
        if (std::isnan(box.min[j]) || std::isnan(box.max[j])) return true;
    return false;
}
bool is_empty(const Box& box) { return box.min.x > box.max.x || box.min.y > box.max.y || box.min.z > box.max.z; }
bool has_no_number(const Box& box) {
    for (int j = 0; j < 3; ++j)
        if (box.min[j] == infinity_float || box.max[j] == -infinity_float) return true;
    return false;
}

// Whether the library promises exact decisions at the planes.
bool has_moderate_exponents(const glm::dmat4& matrix, const TextureRegion& region) {
    double largest = 0.0, least = infinite;
    for (int j = 0; j < 4; ++j) {
        for (const int k : {0, 1, 2, 3}) {
            if (k == 2 && !region.depth()) continue;
            const double size = std::fabs(matrix[j][k]);
            largest = std::max(largest, size);
            if (size > 0.0) least = std::min(least, size);
        }
    }
    for (int k = 0; k < 2 * limited(region); ++k) {
        const double size = std::fabs(limits(region, k / 2)[k % 2]);
        if (size > 0.0 && size < infinite && !(size >= 0x1p-200 && size <= 0x1p200)) return false;
    }
    return largest == 0.0 || least / largest > 0x1p-598;
}

struct Counts {
    long outside = 0, partial = 0, inside = 0, separated = 0, touching = 0, false_partial = 0;
};

// Empty where the answer is what the contract says. `look_for_false_partials` asks of each `partial` whether it is one.
std::string what_is_wrong(Coverage answer, const Judge& judge, bool is_exact, const Box& box, Counts& counts,
                          bool look_for_false_partials = false) {
    if (has_nan(box)) return answer == Coverage::partial ? "" : "a NaN, and not partial";
    if (is_empty(box)) return answer == Coverage::outside ? "" : "empty, and not outside";
    if (has_no_number(box)) return answer == Coverage::inside ? "no point of it is lit, and it is inside" : "";
    const bool outside_a_plane = judge.is_outside_a_plane(box);
    const bool inside = !outside_a_plane && judge.is_inside(box);
    counts.touching += judge.touches(box);
    switch (answer) {
        case Coverage::outside:
            ++counts.outside;
            if (outside_a_plane) return "";
            ++counts.separated;
            return judge.is_outside(box) ? "" : "a false outside";
        case Coverage::inside:
            ++counts.inside;
            return inside ? "" : "a false inside";
        case Coverage::partial:
            ++counts.partial;
            if (is_exact && outside_a_plane) return "outside a plane, and not outside";
            if (is_exact && inside) return "inside all planes, and not inside";
            if (look_for_false_partials && judge.is_outside(box)) ++counts.false_partial;
            return "";
    }
    return "no answer at all";
}

struct Slide {
    glm::dmat4 matrix;
    TextureRegion region;
    std::optional<glm::vec3> touched = {};  // a point on a side, or on an edge, to within an ulp of double or two
};

std::string hex(const Slide& slide) {
    return "matrix " + hex(slide.matrix) + ", region " + hex(slide.region.min()) + " to " + hex(slide.region.max()) +
           (slide.region.depth() ? ", depth " + hex(*slide.region.depth()) : "");
}

// In one of two slides a depth: the whole one, a part, or to one side.
TextureRegion with_some_depth(const TextureRegion& region, texgen::Conventions conventions,
                              texgen::DepthMapping mapping, Random& random) {
    switch (random.integer(0, 7)) {
        case 0:
            return region.with_depth();
        case 1:
            return region.with_depth(conventions, mapping);
        case 2:
            return region.with_depth(random.uniform(-1.0, 0.9), random.uniform(0.9, 1.1));
        case 3:
            return random.coin() ? region.with_depth(0.0, infinite) : region.with_depth(-infinite, 0.999);
        default:
            return region;
    }
}

// A projector as a scene has it, about a place, and the whole texture or a tile of an atlas.
Slide ordinary_slide(Random& random, double distance_from_origin) {
    const glm::dvec3 place = distance_from_origin * random.direction();
    const texgen::Aim aim{.position = place + random.uniform(0.0, 20.0) * random.direction(),
                          .target = place + random.uniform(0.0, 20.0) * random.direction(),
                          .up = random.direction()};
    const TextureRegion region = random.coin() ? whole_texture()
                                               : atlas_tile({random.integer(0, 7) / 8.0, random.integer(0, 3) / 4.0},
                                                            {random.integer(8, 15) / 8.0, random.integer(4, 7) / 4.0});
    const auto slide_of = [&](const auto& lens) -> std::optional<Slide> {
        const texgen::Conventions all[] = {texgen::opengl, texgen::vulkan, texgen::direct3d, texgen::metal};
        const texgen::Conventions of_hand = all[random.integer(0, 3)];
        const texgen::Conventions conventions = random.coin() ? of_hand : left_handed(of_hand);
        auto projector = texgen::make_projector(lens, aim, conventions);
        if (!projector) return {};
        if (random.integer(0, 3) == 0) {  // reversed: z becomes w - z, or -z
            glm::dmat4 reversed = projector->projection.matrix();
            for (int j = 0; j < 4; ++j)
                reversed[j].z =
                    (conventions.depth == texgen::DepthRange::zero_to_one ? reversed[j].w : 0.0) - reversed[j].z;
            projector->projection = texgen::ProjectorProjection(reversed);
        }
        const TextureRegion of_slide = random.coin() ? region : whole_texture();
        const auto mapping = random.coin() ? texgen::DepthMapping::unit : texgen::DepthMapping::ndc;
        return Slide{texgen::texture_from_world(*projector, of_slide, mapping).matrix(),
                     with_some_depth(region, conventions, mapping, random),
                     {}};
    };
    std::optional<Slide> slide;
    switch (random.integer(0, 4)) {
        case 0: {
            const double size = random.uniform(1.0, 15.0);
            slide = slide_of(texgen::OrthographicLens{-size, random.uniform(0.3, 1.0) * size, -size,
                                                      random.uniform(0.3, 1.0) * size, 0.1, 100.0});
            break;
        }
        case 1:
            slide = slide_of(texgen::FrustumLens{random.uniform(-0.5, 0.0), random.uniform(0.1, 0.5),
                                                 random.uniform(-0.5, 0.0), random.uniform(0.1, 0.5), 0.5, 200.0});
            break;
        case 2:
            slide = slide_of(texgen::PinholeLens{
                random.uniform(400.0, 900.0), random.uniform(400.0, 900.0), random.uniform(200.0, 400.0),
                random.uniform(150.0, 300.0), 640.0, 480.0, 0.2, random.coin() ? infinite : 100.0,
                random.coin() ? texgen::PixelCentre::integer : texgen::PixelCentre::half, random.uniform(-2.0, 2.0)});
            break;
        default:
            slide = slide_of(texgen::PerspectiveLens{.fovy = degrees(random.uniform(8.0, 110.0)),
                                                     .aspect = random.uniform(0.5, 2.0),
                                                     .z_near = 0.1,
                                                     .z_far = random.coin() ? infinite : 500.0});
            break;
    }
    return slide ? *slide : ordinary_slide(random, distance_from_origin);
}

Slide hostile_slide(Random& random) {
    Slide slide = ordinary_slide(random, random.integer(0, 2) == 0 ? random.power_of_ten(2.0, 6.0) : 0.0);
    const auto any_region = [&] {
        const auto side = [&] {
            const int kind = random.integer(0, 19);
            return kind == 0 ? random.power_of_ten(-300.0, 300.0) : kind == 1 ? 0.0 : random.uniform(-4.0, 4.0);
        };
        glm::dvec2 min{side(), side()}, max{side(), side()};  // braces: from left to right
        if (random.integer(0, 3) == 0) max.x = min.x;
        if (random.integer(0, 3) == 0) min.x = -infinite;
        if (random.integer(0, 3) == 0) max.y = infinite;
        const TextureRegion region = atlas_tile(min, max);
        if (random.coin()) return region;
        const double near = side(), far = random.integer(0, 3) == 0 ? near : side();
        return region.with_depth(random.integer(0, 3) == 0 ? -infinite : near, far);
    };
    switch (random.integer(0, 9)) {
        case 0:
            slide.matrix = glm::dmat4(support::rounded(slide.matrix));
            break;
        case 1:
            slide.matrix *= random.power_of_ten(-30.0, 30.0);
            break;
        case 2: {  // small integers: exact ties everywhere
            for (int j = 0; j < 4; ++j)
                for (int k = 0; k < 4; ++k) slide.matrix[j][k] = random.integer(-2, 2);
            slide.region = atlas_tile({random.integer(-2, 1), random.integer(-2, 1)},
                                      {random.integer(-1, 2), random.integer(-1, 2)});
            if (random.coin()) slide.region = slide.region.with_depth(random.integer(-2, 1), random.integer(-1, 2));
            break;
        }
        case 3: {
            const int axis = random.integer(0, 2);
            slide.matrix[axis] = -slide.matrix[axis];
            break;
        }
        case 4:
            for (int j = 0; j < 4; ++j)
                for (int k = 0; k < 4; ++k)
                    slide.matrix[j][k] = random.uniform(-1.0, 1.0) * random.power_of_ten(-3.0, 3.0);
            break;
        case 5:
            slide.region = any_region();
            break;
        case 6:
            if (random.integer(0, 9) == 0)
                for (int j = 0; j < 4; ++j) slide.matrix[j][random.integer(0, 3)] *= random.power_of_ten(-250.0, 250.0);
            break;
        case 7: {  // aligned with the axes
            const double focal_length = random.power_of_ten(-1.0, 1.0);
            slide.matrix = glm::dmat4(0.0);
            slide.matrix[random.integer(0, 1)][0] = focal_length;
            slide.matrix[random.integer(0, 1)][1] = random.coin() ? focal_length : -focal_length;
            slide.matrix[2][0] = slide.matrix[2][1] = random.coin() ? 0.5 : 0.0;
            slide.matrix[2][3] = random.coin() ? 1.0 : -1.0;
            slide.matrix[2][2] = random.coin() ? 1.0 : 0.5;
            for (const int k : {0, 1, 2, 3}) slide.matrix[3][k] = random.coin() ? 0.0 : random.integer(-3, 3);
            break;
        }
        case 8:  // q hardly changes
            for (int j = 0; j < 3; ++j) slide.matrix[j][3] *= random.power_of_ten(-12.0, -4.0);
            break;
        default:
            break;
    }
    return slide;
}

// Moves one or two sides of the slide into a point, so that their forms cancel there as far as double can say.
void touch(Slide& slide, const glm::vec3& point, Random& random) {
    const auto linear = [&](int k) {
        long double sum = 0;
        for (int j = 0; j < 3; ++j) sum += static_cast<long double>(slide.matrix[j][k]) * point[j];
        return sum;
    };
    const long double q = linear(3) + slide.matrix[3][3];
    for (int k = 0; k < limited(slide.region); ++k) {
        const bool is_min = random.coin();
        const double given = limits(slide.region, k)[is_min ? 0 : 1];
        const Rounded rounded = is_min ? Rounded::of_min(given) : Rounded::of_max(given);
        const int kind = random.integer(0, 2);
        const double side = kind == 0 ? given : kind == 1 ? rounded.outer : rounded.inner;
        if (std::isinf(side) || random.integer(0, 3) == 0) continue;
        double moved = static_cast<double>(side * q - linear(k));
        for (int steps = random.integer(-2, 2); steps != 0; steps += steps < 0 ? 1 : -1)
            moved = std::nextafter(moved, steps < 0 ? -infinite : infinite);
        slide.matrix[3][k] = moved;
        slide.touched = point;
    }
}

// A point where `forms` of them are 0, as far as double goes: on a side, on an edge, at the apex.
glm::dvec3 point_on(const Slide& slide, int forms, Random& random, const glm::dvec3& about) {
    const auto row = [&](int k) {
        return glm::dvec4(slide.matrix[0][k], slide.matrix[1][k], slide.matrix[2][k], slide.matrix[3][k]);
    };
    const glm::dvec4 q = row(3);
    const auto side = [&](int k) {
        const double value = limits(slide.region, k)[random.integer(0, 1)];
        return std::isinf(value) ? q : row(k) - value * q;
    };
    const int coordinates = limited(slide.region);
    const int first = random.integer(0, coordinates - 1), step_on = random.integer(1, coordinates - 1);
    const bool is_edge_of_depth = coordinates == 3 && forms == 2;
    const glm::dvec4 plane[3] = {forms == 1 && random.integer(0, 3) == 0 ? q : side(first),
                                 side(is_edge_of_depth ? first : 0),
                                 side(is_edge_of_depth ? (first + step_on) % coordinates : 1)};
    glm::dvec3 p = about;
    const auto normal = [](const glm::dvec4& f) { return glm::dvec3(f.x, f.y, f.z); };
    const auto dot = [](const glm::dvec3& a, const glm::dvec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; };
    for (int step = 0; step < (forms == 1 ? 3 : 60); ++step) {
        const glm::dvec4& f = forms == 1      ? plane[0]
                              : forms == 2    ? plane[1 + step % 2]
                              : step % 3 == 2 ? q
                                              : plane[1 + step % 3];
        const glm::dvec3 n = normal(f);
        const double squared = dot(n, n);
        if (squared > 0.0) p -= (dot(n, p) + f.w) / squared * n;
    }
    return p;
}

enum class Family { ordinary, at_side, at_edge, at_apex, integers, tiny, huge, unbounded, empty, nan, bits };
constexpr int family_count = 11;

Box hostile_box(const Slide& slide, Family family, Random& random) {
    const double reach = random.power_of_ten(-1.0, 2.0);
    glm::dvec3 about = random.uniform(0.0, 1.0) * reach * random.direction();
    // Where the projector is, if it is far away.
    if (random.integer(0, 3) != 0) {
        const glm::dvec3 apex = point_on(slide, 3, random, glm::dvec3(0.0));
        if (std::fabs(apex.x) + std::fabs(apex.y) + std::fabs(apex.z) < 1e7) about += apex;
    }
    const auto box_from = [&](const glm::vec3& corner, double size) {
        Box box{corner, corner};
        for (int j = 0; j < 3; ++j) {
            if (random.integer(0, 3) == 0) continue;  // flat
            const float other = support::to_float(static_cast<double>(corner[j]) + random.uniform(-1.0, 1.0) * size);
            box.min[j] = std::min(corner[j], other);
            box.max[j] = std::max(corner[j], other);
        }
        return box;
    };
    const auto near = [&](const glm::dvec3& p) {
        glm::vec3 result;
        for (int j = 0; j < 3; ++j) result[j] = support::neighbour(support::to_float(p[j]), random.integer(-2, 2));
        return result;
    };
    const double size = random.power_of_ten(-2.0, 2.0);
    if (slide.touched && (family == Family::at_side || family == Family::at_edge) && random.integer(0, 3) != 0)
        return box_from(*slide.touched, size);
    switch (family) {
        case Family::ordinary:
            return box_from(glm::vec3(about), size);
        case Family::at_side:
            return box_from(near(point_on(slide, 1, random, about)), size);
        case Family::at_edge:
            return box_from(near(point_on(slide, 2, random, about)), size);
        case Family::at_apex:
            return box_from(near(point_on(slide, 3, random, about)), size);
        case Family::integers: {
            Box box{};
            for (int j = 0; j < 3; ++j) {
                const int first = random.integer(-4, 4), second = random.integer(-4, 4);
                box.min[j] = static_cast<float>(std::min(first, second));
                box.max[j] = static_cast<float>(std::max(first, second));
            }
            return box;
        }
        case Family::tiny:
            return box_from(
                random.coin() ? near(point_on(slide, random.integer(1, 3), random, about)) : glm::vec3(0.0f),
                random.power_of_ten(-44.0, -4.0));
        case Family::huge:
            return box_from(glm::vec3(about), random.power_of_ten(4.0, 38.0));
        case Family::unbounded: {
            Box box = random.coin() ? hostile_box(slide, Family::integers, random)
                                    : box_from(near(point_on(slide, random.integer(1, 3), random, about)), size);
            for (int j = 0; j < 3; ++j) {
                if (random.integer(0, 2) == 0) box.min[j] = -infinity_float;
                if (random.integer(0, 2) == 0) box.max[j] = infinity_float;
            }
            if (random.integer(0, 19) == 0) box.min.x = infinity_float;
            return box;
        }
        case Family::empty: {
            Box box = box_from(glm::vec3(about), size);
            const int axis = random.integer(0, 2);
            std::swap(box.min[axis], box.max[axis]);
            if (box.min[axis] == box.max[axis]) box.max[axis] = support::neighbour(box.max[axis], -1);
            if (random.integer(0, 9) == 0) box = {glm::vec3(infinity_float), glm::vec3(-infinity_float)};
            return box;
        }
        case Family::nan: {
            Box box = box_from(glm::vec3(about), size);
            (random.coin() ? box.min : box.max)[random.integer(0, 2)] = nan_float;
            return box;
        }
        case Family::bits:
            return {{random.any_float(), random.any_float(), random.any_float()},
                    {random.any_float(), random.any_float(), random.any_float()}};
    }
    return {};
}

// Whether the region has a point.
bool is_a_region(const TextureRegion& region) {
    return region.min().x <= region.max().x && region.min().y <= region.max().y &&
           (!region.depth() || region.depth()->x <= region.depth()->y);
}

}  // namespace

TEST_CASE("no box of a hostile family is outside or inside that is not, and the planes are decided exactly") {
    Random random(41);
    const long total = count_of("TEXGEN_COVERAGE_BOXES", 300000);
    std::array<Counts, family_count> counts{};
    long done = 0, have_depth = 0;
    while (done < total) {
        Slide slide = hostile_slide(random);
        if (random.coin()) touch(slide, random.vector3(random.power_of_ten(-1.0, 5.0)), random);
        const WorldTexgen transform(slide.matrix);
        const Judge judge(slide.matrix, slide.region);
        const bool is_exact = has_moderate_exponents(slide.matrix, slide.region);
        std::vector<Box> boxes;
        std::vector<Family> families;
        for (int i = random.integer(0, 150); i > 0; --i) {
            families.push_back(static_cast<Family>(random.integer(0, family_count - 1)));
            boxes.push_back(hostile_box(slide, families.back(), random));
        }
        std::vector<Coverage> answers(boxes.size(), Coverage::inside);
        const LitVolume<texgen::World> volume(transform, slide.region);
        volume.coverage(boxes, answers);
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            Counts& of_family = counts[static_cast<std::size_t>(families[i])];
            std::string wrong = what_is_wrong(answers[i], judge, is_exact, boxes[i], of_family);
            if (!is_a_region(slide.region) && !has_nan(boxes[i]))
                wrong = answers[i] == Coverage::outside ? "" : "the region is empty, and it is not outside";
            if (volume.coverage(boxes[i]) != answers[i]) wrong = "one box alone is something else";
            REQUIRE_MESSAGE(wrong.empty(), wrong << ": " << hex(slide) << ", " << hex(boxes[i]) << ": "
                                                 << static_cast<int>(answers[i]));
        }
        done += static_cast<long>(boxes.size());
        have_depth += slide.region.depth() ? static_cast<long>(boxes.size()) : 0;
    }
    CHECK(have_depth > total / 3);
    MESSAGE("of " << done << " boxes " << have_depth << " are of a region with a depth");
    const auto of = [&](Family family) -> const Counts& { return counts[static_cast<std::size_t>(family)]; };
    for (int family = 0; family < family_count; ++family) {
        const Counts& c = counts[static_cast<std::size_t>(family)];
        MESSAGE("family " << family << ": outside " << c.outside << ", by a separating plane alone " << c.separated
                          << ", partial " << c.partial << ", inside " << c.inside << ", touching " << c.touching);
        if (family >= static_cast<int>(Family::empty)) continue;
        CHECK(c.outside > total / 1000);
        CHECK(c.partial > total / 1000);
    }
    CHECK(of(Family::integers).touching > total / 300);
    CHECK(of(Family::unbounded).separated > 0);
    for (const Family family : {Family::at_side, Family::at_edge, Family::at_apex, Family::integers})
        CHECK(of(family).separated > total / 10000);
    for (const Family family :
         {Family::ordinary, Family::at_side, Family::at_edge, Family::integers, Family::unbounded})
        CHECK(of(family).inside > total / 5000);
}

TEST_CASE("an element far below the others bounds the slide where its region has no side") {
    // Of boxes without an end: there the sign of a product of two such elements decides.
    Random random(642);
    Counts counts;
    for (int n = 0; n < 6000; ++n) {
        const double tiny = std::ldexp(random.uniform(1.0, 2.0), -random.integer(400, 597));
        Slide slide{glm::dmat4(0.0), whole_texture()};
        for (int j = 0; j < 4; ++j) {
            for (const int k : {0, 1, 3}) {
                const double sign = random.coin() ? 1.0 : -1.0;
                const int kind = random.integer(0, 3);
                slide.matrix[j][k] = kind == 0 ? 0.0 : kind == 1 ? sign * tiny : sign * random.integer(1, 4) / 4.0;
            }
        }
        slide.matrix[3][3] = 1.0;  // the largest, so that nothing is below 2^-600 of it
        glm::dvec2 min(0.0), max(1.0);
        for (int k = 0; k < 2; ++k) {
            if (random.coin()) min[k] = -infinite;
            if (random.integer(0, 2) != 0) max[k] = infinite;
        }
        slide.region = atlas_tile(min, max);
        const Judge judge(slide.matrix, slide.region);
        const LitVolume<texgen::World> volume(WorldTexgen(slide.matrix), slide.region);
        std::vector<Box> boxes(10);
        for (Box& box : boxes) {
            for (int j = 0; j < 3; ++j) {
                box.min[j] = support::to_float(random.uniform(-4.0, 4.0));
                box.max[j] = box.min[j] + 0.25f;
            }
            for (int ends = random.integer(1, 2); ends > 0; --ends)
                random.coin() ? box.min[random.integer(0, 2)] = -infinity_float
                              : box.max[random.integer(0, 2)] = infinity_float;
        }
        std::vector<Coverage> answers(boxes.size());
        volume.coverage(boxes, answers);
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            std::string wrong = what_is_wrong(answers[i], judge, true, boxes[i], counts);
            if (volume.coverage(boxes[i]) != answers[i]) wrong = "one box alone is something else";
            REQUIRE_MESSAGE(wrong.empty(), wrong << ": " << hex(slide) << ", " << hex(boxes[i]) << ": "
                                                 << static_cast<int>(answers[i]));
        }
    }
    MESSAGE("outside " << counts.outside << ", by a separating plane alone " << counts.separated << ", partial "
                       << counts.partial << ", inside " << counts.inside);
    CHECK(counts.separated > 100);
    CHECK(counts.partial > 1000);
}

TEST_CASE("a box that touches an edge of the pyramid at one point is not outside") {
    // The apex in the origin, s = t = 0 exactly along the edge through P: rows P x A of integers have no rounding, but
    // the plane through that edge parallel to an axis has. Each box has P on an edge parallel to the axis, and nothing
    // beyond the plane.
    Random random(320);
    const auto integers = [&](int most) {
        return glm::dvec3(random.integer(-most, most), random.integer(-most, most), random.integer(-most, most));
    };
    const auto cross = [](const glm::dvec3& a, const glm::dvec3& b) {
        return glm::dvec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
    };
    int touching = 0;
    for (int i = 0; i < 3000; ++i) {
        const glm::dvec3 p = integers(1 << 20), of_s = cross(p, integers(1 << 30)), of_t = cross(p, integers(1 << 30));
        glm::dvec3 of_q = integers(1 << 30);
        if (of_q.x * p.x + of_q.y * p.y + of_q.z * p.z < 0.0) of_q = -of_q;
        glm::dmat4 matrix(0.0);
        for (int j = 0; j < 3; ++j) matrix[j] = {of_s[j], of_t[j], 0.0, of_q[j]};
        REQUIRE(support::exactly_at(matrix, glm::vec3(p)).s.sign() == 0);
        REQUIRE(support::exactly_at(matrix, glm::vec3(p)).t.sign() == 0);
        for (int axis = 0; axis < 3; ++axis) {
            if (!(of_s[axis] * of_t[axis] < 0.0)) continue;
            Box box{glm::vec3(p), glm::vec3(p)};
            for (int j = 0; j < 3; ++j) {
                const float length = random.uniform_float(1.0, 1e6);
                const double form = std::fabs(of_t[axis]) * of_s[j] + std::fabs(of_s[axis]) * of_t[j];
                if (j == axis || form > 0.0) box.min[j] -= length;
                if (j == axis || form < 0.0) box.max[j] += length;
            }
            ++touching;
            REQUIRE_MESSAGE(coverage(WorldTexgen(matrix), whole_texture(), box) != Coverage::outside,
                            hex(matrix) << " " << hex(box));
        }
    }
    CHECK(touching > 2000);
}

namespace {

// What is left where some sides are none, or lie so far away that they might be.
TextureRegion without_some_sides(const TextureRegion& region, Random& random) {
    glm::dvec2 min = region.min(), max = region.max();
    for (glm::length_t k = 0; k < 2; ++k) {
        const double far = random.coin() ? HUGE_VAL : random.power_of_ten(10.0, 60.0);
        if (random.coin()) min[k] = -far;
        if (random.coin()) max[k] = far;
    }
    const TextureRegion result = texgen::atlas_tile(min, max);
    return region.depth() ? result.with_depth(region.depth()->x, region.depth()->y) : result;
}

}  // namespace

TEST_CASE("of the boxes of random scenes less than 3 % are partial that could be outside, whatever sides there are") {
    Random random(42);
    Counts counts;
    long tested = 0;
    for (int scene = 0; scene < 320; ++scene) {
        const double distance = scene % 4 == 0 ? 1e5 : 0.0;
        Slide slide = ordinary_slide(random, distance);
        if (scene % 2 == 1) slide.region = without_some_sides(slide.region, random);
        const Judge judge(slide.matrix, slide.region);
        const LitVolume<texgen::World> volume(WorldTexgen(slide.matrix), slide.region);
        const glm::dvec3 apex = point_on(slide, 3, random, glm::dvec3(0.0));
        const glm::dvec3 centre = distance > 0.0 ? apex : glm::dvec3(0.0);
        std::vector<Box> boxes;
        for (int i = 0; i < 300; ++i) {
            const double size = random.power_of_ten(-1.0, 1.5);
            const glm::dvec3 middle = centre + random.uniform(0.0, 40.0) * random.direction();
            const glm::dvec3 half(size * random.uniform(0.1, 1.0), size * random.uniform(0.1, 1.0),
                                  size * random.uniform(0.1, 1.0));
            boxes.push_back({glm::vec3(middle - half), glm::vec3(middle + half)});
        }
        std::vector<Coverage> answers(boxes.size());
        volume.coverage(boxes, answers);
        tested += static_cast<long>(boxes.size());
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            const std::string wrong = what_is_wrong(answers[i], judge, true, boxes[i], counts, true);
            REQUIRE_MESSAGE(wrong.empty(), wrong << ": " << hex(slide) << ", " << hex(boxes[i]));
        }
    }
    MESSAGE("of " << tested << ": outside " << counts.outside << " (by a separating plane alone " << counts.separated
                  << "), partial " << counts.partial << " (falsely " << counts.false_partial << "), inside "
                  << counts.inside);
    CHECK(counts.partial > tested / 20);
    CHECK(counts.inside > tested / 50);
    CHECK(counts.separated > tested / 200);
    CHECK(counts.false_partial * 100 < tested * 3);
    // The theorem of separating axes leaves none but what rounding does.
    CHECK(counts.false_partial * 1000 < tested);
}

namespace {

using support::Rational;

// How far a point is from what is lit (q >= 0 and the sides), exactly: the nearest point is the projection onto the
// planes of some of the forms, so it is the nearest of those projections that fulfil all of them.
class DistanceJudge {
public:
    using Form = std::array<Rational, 4>;

    explicit DistanceJudge(const Judge& judge)
        : forms_(rational(judge.forms())),
          inner_forms_(rational(judge.inner_forms())),
          no_float_is_inside_(judge.no_float_is_inside()) {
        for (const Inequality& form : judge.forms()) near_forms_.emplace_back(form);
        for (const Inequality& form : judge.inner_forms()) near_inner_forms_.emplace_back(form);
    }

    // What doubles are certain of; the exact answers take a thousand times as long.
    bool is_surely_outside_a_plane(const Sphere& sphere) const {
        return std::ranges::any_of(near_forms_, [&](const NearForm& f) { return f.is_negative_over(sphere); });
    }
    bool is_surely_inside(const Sphere& sphere) const {
        return !no_float_is_inside_ &&
               std::ranges::all_of(near_inner_forms_, [&](const NearForm& f) { return f.is_positive_over(sphere); });
    }
    // By the plane through an edge that faces the centre; any weights that are not negative prove it.
    bool is_surely_outside_an_edge(const Sphere& sphere) const {
        for (const NearForm& f : near_forms_)
            for (const NearForm& g : near_forms_)
                if (&f < &g && NearForm::facing(f, g, sphere).is_negative_over(sphere)) return true;
        return false;
    }

    // Whether some point within the radius is lit, or would be with q = 0.
    bool reaches(const Sphere& sphere) const {
        const std::array<Rational, 3> centre{support::exactly(sphere.centre.x), support::exactly(sphere.centre.y),
                                             support::exactly(sphere.centre.z)};
        const Rational radius = support::exactly(sphere.radius);
        const std::size_t n = forms_.size();
        for (std::size_t set = 0; set < std::size_t{1} << n; ++set) {
            std::vector<std::size_t> active;
            for (std::size_t k = 0; k < n; ++k)
                if ((set >> k & 1u) != 0u) active.push_back(k);
            if (active.size() > 3) continue;
            const auto point = projection(centre, active);
            if (!point) continue;
            Rational squared = 0;
            for (std::size_t j = 0; j < 3; ++j) squared += ((*point)[j] - centre[j]) * ((*point)[j] - centre[j]);
            if (squared > radius * radius) continue;
            if (std::ranges::all_of(forms_, [&](const auto& f) { return value(f, *point) >= 0; })) return true;
        }
        return false;
    }

    // -1, 0, 1: f(centre) + sign |a| radius.
    static int extreme_sign(const Form& f, const Sphere& sphere, int sign) {
        const Rational at = value(f, {support::exactly(sphere.centre.x), support::exactly(sphere.centre.y),
                                      support::exactly(sphere.centre.z)});
        const Rational radius = support::exactly(sphere.radius);
        const Rational change = (f[0] * f[0] + f[1] * f[1] + f[2] * f[2]) * radius * radius;  // squared
        const Rational squared = at * at;
        if (sign > 0) return at >= 0 ? (at > 0 || change > 0) : squared > change ? -1 : squared < change;
        return at <= 0            ? -static_cast<int>(at < 0 || change > 0)
               : squared > change ? 1
                                  : -static_cast<int>(squared < change);
    }
    bool is_outside_a_plane(const Sphere& sphere) const {
        for (std::size_t k = 0; k < forms_.size(); ++k)
            if (extreme_sign(forms_[k], sphere, 1) < (k + 1 == forms_.size() ? 1 : 0)) return true;
        return false;
    }
    bool is_inside(const Sphere& sphere) const {
        for (std::size_t k = 0; k < inner_forms_.size(); ++k)
            if (extreme_sign(inner_forms_[k], sphere, -1) < (k + 1 == inner_forms_.size() ? 1 : 0)) return false;
        return !no_float_is_inside_;
    }

private:
    // In double: a form, or a sum of two with weights >= 0, of which `size` holds the magnitudes.
    struct NearForm {
        glm::dvec3 a{0.0}, size_of_a{0.0};
        double d = 0.0, size_of_d = 0.0;

        explicit NearForm(const Inequality& form)
            : a(form.c[0].estimate(), form.c[1].estimate(), form.c[2].estimate()),
              size_of_a(glm::abs(a)),
              d(form.c[3].estimate()),
              size_of_d(std::fabs(d)) {}
        NearForm(double w, const NearForm& f, double v, const NearForm& g)
            : a(w * f.a + v * g.a),
              size_of_a(w * f.size_of_a + v * g.size_of_a),
              d(w * f.d + v * g.d),
              size_of_d(w * f.size_of_d + v * g.size_of_d) {}
        static NearForm facing(const NearForm& f, const NearForm& g, const Sphere& sphere) {
            const double across = glm::dot(f.a, g.a);
            const double w = across * g.at(sphere) - glm::dot(g.a, g.a) * f.at(sphere);
            const double v = across * f.at(sphere) - glm::dot(f.a, f.a) * g.at(sphere);
            return w > 0.0 && v > 0.0 ? NearForm(w / (w + v), f, v / (w + v), g) : NearForm(0.0, f, 0.0, g);
        }

        double at(const Sphere& sphere) const { return glm::dot(a, glm::dvec3(sphere.centre)) + d; }
        double change(const Sphere& sphere) const { return glm::length(a) * static_cast<double>(sphere.radius); }
        // A few dozen roundings, each below 2^-52 of what it is of.
        double error(const Sphere& sphere) const {
            const glm::dvec3 reach = glm::abs(glm::dvec3(sphere.centre)) + static_cast<double>(sphere.radius);
            return 0x1p-45 * (glm::dot(size_of_a, reach) + size_of_d) + 0x1p-900;
        }
        bool is_negative_over(const Sphere& sphere) const { return at(sphere) + change(sphere) < -error(sphere); }
        bool is_positive_over(const Sphere& sphere) const { return at(sphere) - change(sphere) > error(sphere); }
    };

    static std::vector<Form> rational(const std::vector<Inequality>& forms) {
        std::vector<Form> result;
        for (const Inequality& form : forms) {
            Form f;
            for (std::size_t j = 0; j < 4; ++j) f[j] = form.c[j].rational();
            result.push_back(f);
        }
        return result;
    }
    static Rational value(const std::array<Rational, 4>& f, const std::array<Rational, 3>& p) {
        return f[0] * p[0] + f[1] * p[1] + f[2] * p[2] + f[3];
    }

    // Onto the points where all active forms are 0: c - N^T (N N^T)^-1 f(c). Empty where the normals are dependent.
    std::optional<std::array<Rational, 3>> projection(const std::array<Rational, 3>& centre,
                                                      const std::vector<std::size_t>& active) const {
        support::RationalMatrix gram{};
        for (std::size_t i = 0; i < 4; ++i) {
            gram[i][i] = 1;
            for (std::size_t k = 0; k < active.size() && i < active.size(); ++k) {
                gram[i][k] = 0;
                for (std::size_t j = 0; j < 3; ++j) gram[i][k] += forms_[active[i]][j] * forms_[active[k]][j];
            }
        }
        const auto inverse = support::inverse(gram);
        if (!inverse) return {};
        std::array<Rational, 3> point = centre;
        for (std::size_t i = 0; i < active.size(); ++i) {
            Rational weight = 0;
            for (std::size_t k = 0; k < active.size(); ++k)
                weight -= (*inverse)[i][k] * value(forms_[active[k]], centre);
            for (std::size_t j = 0; j < 3; ++j) point[j] += weight * forms_[active[i]][j];
        }
        return point;
    }

    std::vector<Form> forms_, inner_forms_;  // q is the last
    std::vector<NearForm> near_forms_, near_inner_forms_;
    bool no_float_is_inside_;
};

}  // namespace

TEST_CASE("where sides are none a box is partial only if no plane leaves it out") {
    Random random(4714);
    Counts counts;
    const auto integer = [&](int most) { return static_cast<double>(random.integer(-most, most)); };
    for (int i = 0; i < 40000; ++i) {
        Slide slide{glm::dmat4(0.0), whole_texture()};
        for (glm::length_t j = 0; j < 4; ++j) slide.matrix[j] = {integer(3), integer(3), 0.0, integer(3)};
        const auto row = [&](glm::length_t k) {
            return glm::dvec3(slide.matrix[0][k], slide.matrix[1][k], slide.matrix[2][k]);
        };
        if (glm::determinant(glm::dmat3(row(0), row(1), row(3))) == 0.0) continue;  // there need be no pyramid
        slide.region = without_some_sides(slide.region, random);
        const glm::vec3 middle(integer(3), integer(3), integer(3));
        const Box box{middle - glm::vec3(1.0f), middle + glm::vec3(1.0f)};
        const Coverage answer = coverage(WorldTexgen(slide.matrix), slide.region, box);
        const Judge judge(slide.matrix, slide.region);
        const std::string wrong = what_is_wrong(answer, judge, true, box, counts);
        REQUIRE_MESSAGE(wrong.empty(), wrong << ": " << hex(slide) << ", " << hex(box));
        // Most that touch a plane, of these integers, touch it exactly.
        const Box around{box.min - glm::vec3(0x1p-10f), box.max + glm::vec3(0x1p-10f)};
        if (answer == Coverage::partial) REQUIRE_MESSAGE(!judge.is_outside(around), hex(slide) << ", " << hex(box));
    }
    MESSAGE("outside " << counts.outside << " (by a separating plane alone " << counts.separated << "), partial "
                       << counts.partial << ", inside " << counts.inside);
    CHECK(counts.separated > 500);
}

TEST_CASE("a sphere that just reaches an edge far from the origin is not outside") {
    // s = a (x - x of the edge) and t likewise, over q = 1: the rounding of a x is far above the ulp of a small
    // distance.
    Random random(47);
    int touching = 0;
    for (int i = 0; i < 20000; ++i) {
        const double a[2] = {random.uniform(0.1, 1.0), random.uniform(0.1, 1.0)};
        const glm::vec3 centre(random.uniform_float(1e6, 2e6), random.uniform_float(1e6, 2e6), 0.0f);
        glm::dmat4 matrix(0.0);
        Rational squared = 0;
        double distance = 0.0;
        for (int k = 0; k < 2; ++k) {
            matrix[k][k] = a[k];
            matrix[3][k] = -a[k] * (static_cast<double>(centre[k]) + random.uniform(0.05, 0.2));
            const Rational way = support::exactly(-matrix[3][k]) / support::exactly(a[k]) - support::exactly(centre[k]);
            squared += way * way;
            distance = std::hypot(distance, support::nearest<double>(way));
        }
        matrix[3][3] = 1.0;
        const float radius = support::to_float(distance);
        const Rational exact_radius = support::exactly(radius);
        if (exact_radius * exact_radius < squared) continue;
        ++touching;
        const Sphere sphere{centre, radius};
        REQUIRE_MESSAGE(coverage(WorldTexgen(matrix), texgen::whole_texture(), sphere) != Coverage::outside,
                        hex(sphere));
    }
    CHECK(touching > 5000);
}

TEST_CASE("no sphere is outside or inside that is not, and few of a scene are partial that could be outside") {
    Random random(43);
    Counts counts;
    int tested = 0, judged_partial = 0, clearly_inside = 0, clearly_outside = 0;
    const long total = count_of("TEXGEN_COVERAGE_SPHERES", 4000);
    long have_depth = 0;
    for (long scene = 0; 40 * scene < total; ++scene) {
        const Slide slide = scene % 3 == 2 ? hostile_slide(random) : ordinary_slide(random, scene % 6 == 0 ? 1e5 : 0.0);
        const DistanceJudge judge(Judge(slide.matrix, slide.region));
        const bool is_counted = scene % 3 != 2 && scene < 100;
        have_depth += slide.region.depth() ? 40 : 0;
        const glm::dvec3 apex = point_on(slide, 3, random, glm::dvec3(0.0));
        std::vector<Sphere> spheres;
        for (int i = 0; i < 40; ++i) {
            const double size = random.power_of_ten(-1.0, 1.3);
            const glm::dvec3 about =
                (scene % 6 == 0 ? apex : glm::dvec3(0.0)) + random.uniform(0.0, 40.0) * random.direction();
            Sphere sphere{glm::vec3(about), support::to_float(size)};
            if (i % 4 == 0) {  // touching a side, an edge or the apex as well as floats can
                const glm::dvec3 point = point_on(slide, random.integer(1, 3), random, about);
                const glm::dvec3 way = point - glm::dvec3(sphere.centre);
                const float distance = support::to_float(std::sqrt(way.x * way.x + way.y * way.y + way.z * way.z));
                sphere.radius = support::neighbour(distance, random.integer(-2, 2));
            }
            if (i % 4 == 2) {  // touching the nearest side
                double nearest = infinite;
                for (int i_side = 0; i_side < 2 * limited(slide.region); ++i_side) {
                    const int k = i_side / 2;
                    const double side = limits(slide.region, k)[random.integer(0, 1)];
                    glm::dvec4 f;
                    for (int j = 0; j < 4; ++j)
                        f[j] = std::isinf(side) ? slide.matrix[j][3] : slide.matrix[j][k] - side * slide.matrix[j][3];
                    const glm::dvec3 c(sphere.centre);
                    nearest = std::min(nearest, std::fabs(f.x * c.x + f.y * c.y + f.z * c.z + f.w) /
                                                    std::sqrt(f.x * f.x + f.y * f.y + f.z * f.z));
                }
                if (nearest < 1e6)
                    sphere.radius = support::neighbour(support::to_float(nearest), random.integer(-2, 2));
            }
            if (i % 20 == 1 || !(sphere.radius >= 0.0f && sphere.radius < infinity_float)) sphere.radius = 0.0f;
            spheres.push_back(sphere);
        }
        std::vector<Coverage> answers(spheres.size());
        const LitVolume<texgen::World> volume(WorldTexgen(slide.matrix), slide.region);
        volume.coverage(spheres, answers);
        for (std::size_t i = 0; i < spheres.size(); ++i) {
            const Sphere& sphere = spheres[i];
            std::string wrong;
            if (answers[i] == Coverage::outside) {
                ++counts.outside;
                if (is_a_region(slide.region) && !judge.is_surely_outside_a_plane(sphere) &&
                    !judge.is_outside_a_plane(sphere)) {
                    ++counts.separated;
                    if (!judge.is_surely_outside_an_edge(sphere) && judge.reaches(sphere)) wrong = "a false outside";
                }
            } else if (answers[i] == Coverage::inside) {
                ++counts.inside;
                if (!judge.is_surely_inside(sphere) && !judge.is_inside(sphere)) wrong = "a false inside";
            } else {
                ++counts.partial;
                if (is_counted && i % 2 != 0) {
                    ++judged_partial;
                    counts.false_partial += !judge.reaches(sphere);
                    Sphere a_little_larger = sphere;
                    a_little_larger.radius *= 1.0001f;
                    clearly_inside += judge.is_inside(a_little_larger);
                    clearly_outside += judge.is_outside_a_plane(a_little_larger);
                }
            }
            tested += is_counted && i % 2 != 0;
            if (volume.coverage(sphere) != answers[i]) wrong = "one sphere alone is something else";
            REQUIRE_MESSAGE(wrong.empty(), wrong << ": " << hex(slide) << ", " << hex(sphere));
        }
    }
    MESSAGE("of " << total << " spheres " << have_depth << " are of a region with a depth: outside " << counts.outside
                  << " (by a separating plane alone " << counts.separated << "), partial " << counts.partial
                  << ", inside " << counts.inside << "; of " << tested << " in ordinary scenes " << counts.false_partial
                  << " are falsely partial");
    CHECK(counts.separated > 10);
    CHECK(counts.inside > 50);
    CHECK(judged_partial > 50);
    CHECK(clearly_inside == 0);
    CHECK(clearly_outside == 0);
    CHECK(counts.false_partial * 100 < tested * 3);
}

TEST_CASE("what rounds onto a side of the region is not outside, and what rounds off it is not inside") {
    // s = x + offset, t = 0.5, q = 1.
    const auto of = [](double offset, const TextureRegion& region, float x) {
        glm::dmat4 matrix(0.0);
        matrix[0][0] = 1.0;
        matrix[3] = {offset, 0.5, 0.0, 1.0};
        const WorldTexgen transform(matrix);
        const glm::vec3 point(x, 0.0f, 0.0f);
        float lit = -1.0f;
        project(transform, texgen::world_space(std::span(&point, 1)), region,
                {.s = {}, .t = {}, .r = {}, .lit = {&lit, 1}});
        const Coverage answer = coverage(transform, region, Box{point, point});
        const Coverage of_sphere = coverage(transform, region, Sphere{point, 0.0f});
        CHECK((of_sphere == answer || of_sphere == Coverage::partial));
        if (answer != Coverage::partial) CHECK(lit == (answer == Coverage::inside ? 1.0f : 0.0f));
        return answer;
    };
    const TextureRegion whole = whole_texture();
    CHECK(of(0x0.40p-23, whole, 1.0f) == Coverage::partial);  // a quarter of an ulp outside is lit
    CHECK(of(0x0.80p-23, whole, 1.0f) == Coverage::partial);  // a tie that goes to the even 1
    CHECK(of(0x0.c0p-23, whole, 1.0f) == Coverage::partial);  // not beyond the next float
    CHECK(of(0x1.01p-23, whole, 1.0f) == Coverage::outside);
    CHECK(of(0.0, whole, 1.0f) == Coverage::inside);
    CHECK(of(0.0, whole, 0.0f) == Coverage::inside);
    CHECK(of(-0x0.81p-23, atlas_tile({1.0, 0.0}, {2.0, 1.0}), 1.0f) == Coverage::outside);
    CHECK(of(-0x0.40p-23, atlas_tile({1.0, 0.0}, {2.0, 1.0}), 1.0f) == Coverage::partial);
    CHECK(of(-0x1p-126, whole, 0.0f) == Coverage::partial);
    CHECK(of(-0x1.00001p-126, whole, 0.0f) == Coverage::outside);

    // The first float inside is half an ulp above 0.7, whose nearest is below.
    const TextureRegion tile = atlas_tile({0.7, 0.0}, {1.0, 1.0});
    const float below = 0.7f, above = std::nextafter(0.7f, 1.0f);
    REQUIRE(static_cast<double>(below) < 0.7);
    CHECK(of(0.0, tile, above) == Coverage::inside);
    CHECK(of(0.7 - static_cast<double>(below), tile, below) == Coverage::partial);  // inside, and rounds to below
    CHECK(of(0x0.78p-24, tile, below) == Coverage::partial);
    CHECK(of(-0x1p-30, tile, below) == Coverage::outside);

    // The same of points whose s is anywhere about a side.
    Random random(44);
    int outside = 0, inside = 0, lit_and_outside_in_reals = 0;
    for (int i = 0; i < 30000; ++i) {
        const double side = random.coin() ? random.uniform(-2.0, 2.0) : random.uniform_float(-2.0, 2.0);
        const TextureRegion region =
            random.coin() ? atlas_tile({side, 0.0}, {4.0, 1.0}) : atlas_tile({-4.0, 0.0}, {side, 1.0});
        const float x = support::neighbour(support::to_float(side), random.integer(-1, 1));
        const double offset = random.uniform(-1.5, 1.5) * 0x1p-23 * std::fabs(side);
        const Coverage answer = of(offset, region, x);
        outside += answer == Coverage::outside;
        inside += answer == Coverage::inside;
        const double s = static_cast<double>(x) + offset;
        lit_and_outside_in_reals += answer == Coverage::partial && !(s >= region.min().x && s <= region.max().x);
    }
    CHECK(outside > 3000);
    CHECK(inside > 3000);
    CHECK(lit_and_outside_in_reals > 1000);
}

TEST_CASE(
    "beyond the largest float nothing is inside, and what rounds to infinity is not outside of what begins there") {
    const auto of = [](double s, const TextureRegion& region) {
        glm::dmat4 matrix(0.0);
        matrix[3] = {s, 0.5, 0.0, 1.0};
        return coverage(WorldTexgen(matrix), region, Box{glm::vec3(0.0f), glm::vec3(1.0f)});
    };
    const TextureRegion far_away = atlas_tile({0x1p129, 0.0}, {0x1p131, 1.0});
    CHECK(of(0x1p130, far_away) == Coverage::partial);
    CHECK(of(0x1.ffffffp127, far_away) == Coverage::partial);
    CHECK(of(0x1.fffffdp127, far_away) == Coverage::outside);
    const TextureRegion to_there = atlas_tile({0.0, 0.0}, {0x1p130, 1.0});
    CHECK(of(0x1.fffffep127, to_there) == Coverage::inside);
    CHECK(of(0x1p129, to_there) == Coverage::partial);
    CHECK(of(0x1p131, to_there) == Coverage::partial);  // no float is beyond the side
}

TEST_CASE("a batch has room for what rounds off the slide where s hardly changes") {
    // s = 1 + 2^-20 x / z is rounded to 1 next to x = 0, and t = 1/2: only x >= 0 is inside [1, 2].
    glm::dmat4 matrix(0.0);
    matrix[0][0] = 0x1p-20;
    matrix[2] = {1.0, 0.5, 0.0, 1.0};
    const WorldTexgen transform(matrix);
    const TextureRegion region = atlas_tile({1.0, 0.0}, {2.0, 1.0});
    std::vector<Box> boxes;
    for (const float x : {-0.2f, -0.01f, 0.0f, 0.01f}) boxes.push_back({{x, 0.0f, 1.0f}, {x, 1.0f, 1.5f}});
    std::vector<Coverage> answers(boxes.size());
    coverage(transform, region, boxes, answers);
    CHECK(answers == std::vector{Coverage::outside, Coverage::partial, Coverage::inside, Coverage::inside});
}

TEST_CASE("a batch of spheres answers as the single question where sides of the slide are nearly one plane") {
    // A side at infinity is q, as s <= 1 nearly is: what weighs them is noise, and another one in vectors.
    const glm::dmat4 matrix{
        {0x1.551cd266a9d58p9, -0x1.3b81ebf445084p84, 0x1.af5955321f24cp46, -0x1.43d7e9a6db7b6p2},
        {0x1.4f991f25cfcc8p-19, 0x1.8af80740606cap-84, -0x1.00fe11fbbb954p94, 0x1.d5946c49badp70},
        {0x1.59aa370764aacp-13, -0x1.23db22a41ac28p-43, -0x1.a10589b706878p-66, 0x1.bbde6447d5fa8p42},
        {0x1.a3fdc30796fp-89, -0x1.413a26abfa0eap-8, 0x1.ae96da0e57f2p10, -0x1.4504a77b7fb68p49}};
    constexpr double endless = std::numeric_limits<double>::infinity();
    const TextureRegion region = atlas_tile({-endless, 0.0}, {1.0, endless}).with_depth(-0.144, endless);
    const LitVolume<texgen::World> volume(WorldTexgen(matrix), region);
    std::vector<Sphere> spheres{{{-0x1.9ea102p-37f, -0x1.a5823ep-35f, -0x1.0fa61p-35f}, 0x1.cp0f}};
    Random random(1177);
    for (int i = 1; i < 4000; ++i)
        spheres.push_back({{random.uniform_float(-0x1p-34, 0x1p-34), random.uniform_float(-0x1p-34, 0x1p-34),
                            random.uniform_float(-0x1p-34, 0x1p-34)},
                           random.uniform_float(0.0, 4.0)});
    std::vector<Coverage> answers(spheres.size());
    volume.coverage(spheres, answers);
    int outside = 0;
    for (std::size_t i = 0; i < spheres.size(); ++i) {
        INFO(hex(spheres[i]));
        REQUIRE(answers[i] == volume.coverage(spheres[i]));
        outside += answers[i] == Coverage::outside;
    }
    CHECK(outside > 0);
}

TEST_CASE("what cancels to less than two doubles hold is not taken for 0") {
    // At (1, 1, 1) is s - q = 1 + 2^-53 - 2^-130 - 1 - 2^-53, so that s/q is rounded to 1 and is less.
    const auto of = [](double of_z) {
        glm::dmat4 matrix(0.0);
        matrix[0][0] = 1.0;
        matrix[1][0] = 0x1p-53;
        matrix[2][0] = of_z;
        matrix[3] = {-1.0, 0x1p-54, 0.0, 0x1p-53};
        const Box boxes[] = {{glm::vec3(1.0f), glm::vec3(1.0f)}};
        Coverage answers[] = {Coverage::outside};
        coverage(WorldTexgen(matrix), atlas_tile({1.0, 0.0}, {2.0, 1.0}), boxes, answers);
        CHECK(coverage(WorldTexgen(matrix), atlas_tile({1.0, 0.0}, {2.0, 1.0}), boxes[0]) == answers[0]);
        return answers[0];
    };
    CHECK(of(-0x1p-130) == Coverage::partial);
    CHECK(of(0.0) == Coverage::inside);
    CHECK(of(0x1p-130) == Coverage::inside);
}

TEST_CASE("what cancels only after a double has lost digits of it is 0") {
    Random random(1109);
    for (int i = 0; i < 20; ++i) {
        const double slope = 1.0 + 0x1p-52;
        const float tiny = 0x1p-100f * random.uniform_float(1.0, 2.0);
        glm::dmat4 matrix(0.0);
        matrix[0][0] = slope;
        matrix[1][0] = -slope;
        matrix[2][0] = 1.0;
        matrix[3] = {-1.0, 0.5, 0.0, 1.0};
        const std::vector<Box> boxes(2, Box{glm::vec3(tiny, tiny, 1.0f), glm::vec3(tiny, tiny, 1.0f)});
        std::vector<Coverage> together(2);
        coverage(WorldTexgen(matrix), whole_texture(), boxes, together);
        CHECK(together[0] == Coverage::inside);
        CHECK(coverage(WorldTexgen(matrix), whole_texture(), boxes[0]) == Coverage::inside);
    }
}

TEST_CASE("a side is decided exactly where its terms have too many digits for two doubles") {
    // At the point (1 + 2^-23, 2^-40, 0) s is (1 + 2^-23) q but for the tiny term of y.
    const double side = 0x1.000002p0, q = 0x1.0000000000001p0;
    for (const double tiny : {0x1p-100, -0x1p-100}) {
        glm::dmat4 matrix(0.0);
        matrix[0] = {q, 0.0, 0.0, 0.0};
        matrix[1] = {tiny, 0.0, 0.0, 0.0};
        matrix[3] = {0.0, 1.0, 0.0, q};
        const glm::vec3 point(0x1.000002p0f, 0x1p-40f, 0.0f);
        const texgen::LitVolume<texgen::World> volume(texgen::WorldTexgen(matrix),
                                                      texgen::atlas_tile({side, 0.0}, {2.0, 2.0}));
        CHECK(volume.coverage(texgen::Box{point, point}) ==
              (tiny > 0.0 ? texgen::Coverage::inside : texgen::Coverage::partial));
    }
}

TEST_CASE("a point on sides of the slide is lit where q is positive at all, and is not outside") {
    Random random(1107);
    int lit_ones = 0;
    for (int i = 0; i < 1000; ++i) {
        // s and t are 0, and q is what its last bits leave.
        const glm::dvec2 of_q(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
        const glm::vec3 point(0.0f, random.uniform_float(-1.0, 1.0), random.uniform_float(-1.0, 1.0));
        glm::dmat4 matrix(0.0);
        matrix[1] = {static_cast<double>(point.z), 0.0, 0.0, of_q.x};
        matrix[2] = {-static_cast<double>(point.y), 0.0, 0.0, of_q.y};
        matrix[3].w = -(of_q.x * static_cast<double>(point.y) + of_q.y * static_cast<double>(point.z));
        const WorldTexgen transform(matrix);
        const bool is_lit = texgen::project(transform, texgen::world_space(point)).has_value();
        lit_ones += is_lit;
        CHECK((coverage(transform, whole_texture(), Box{point, point}) == Coverage::outside) == !is_lit);
    }
    CHECK(lit_ones > 200);
}

TEST_CASE("a point whose side is what the last bits of cancelling coefficients leave is told alone as in company") {
    Random random(1108);
    const texgen::TextureRegion region = texgen::atlas_tile({0.0, -1.0}, {1.0, 2.0});
    int inside = 0;
    for (int i = 0; i < 4000; ++i) {
        glm::dmat4 matrix;
        for (glm::length_t column = 0; column < 4; ++column)
            for (glm::length_t row = 0; row < 4; ++row) matrix[column][row] = random.integer(-2, 2) * (1.0 + 0x1p-50);
        const WorldTexgen transform(matrix);
        glm::vec3 point;
        for (glm::length_t j = 0; j < 3; ++j)
            point[j] = random.coin() ? static_cast<float>(random.integer(-3, 3)) : random.coin() ? 0x1p-60f : 0x1p-120f;
        const std::vector<Box> boxes(2, Box{point, point});
        std::vector<Coverage> together(2);
        coverage(transform, region, boxes, together);
        INFO(i);
        CHECK(coverage(transform, region, boxes[0]) == together[0]);
        inside += together[0] == Coverage::inside;
    }
    CHECK(inside > 200);
}

TEST_CASE("a box beside a side by 2^-53 is beside it, and on it touches it, whatever has cancelled to leave that") {
    Random random(950);
    int outside = 0, inside = 0;
    for (int i = 0; i < 4000; ++i) {
        // At (x0, y0) both s = k (y0 x - x0 y) + c and q = g (y0 x - x0 y) + 1 have their last terms alone: the others
        // cancel, of which a side has sums of 150 bits.
        const float x = random.uniform_float(128.0, 256.0), y = random.uniform_float(128.0, 256.0);
        const auto of_29_bits = [&](int exponent) {
            return std::ldexp(random.integer(1 << 28, (1 << 29) - 1), exponent - 29);
        };
        const double k = of_29_bits(random.integer(0, 100)), g = of_29_bits(-12);
        const float side = random.uniform_float(0.5, 1.0), before = std::nextafter(side, 0.0f);
        const int sign = random.integer(-1, 1);
        const auto texgen_of = [&](float at) {
            glm::dmat4 matrix(0.0);
            matrix[0] = {static_cast<double>(y) * k, 0.0, 0.0, static_cast<double>(y) * g};
            matrix[1] = {-static_cast<double>(x) * k, 0.0, 0.0, -static_cast<double>(x) * g};
            matrix[3] = {static_cast<double>(at) + sign * 0x1p-53, 0.5, 0.0, 1.0};
            return WorldTexgen(matrix);
        };
        const TextureRegion region = atlas_tile({static_cast<double>(side), 0.0}, {0x1p120, 1.0});
        const Box below{{x - 1.0f, y, 0.0f}, {x, y + 1.0f, 1.0f}}, above{{x, y - 1.0f, 0.0f}, {x + 1.0f, y, 1.0f}};
        // No float is between the side and the one before, which is outside.
        const Coverage of_below = coverage(texgen_of(before), region, below);
        const Coverage of_above = coverage(texgen_of(side), region, above);
        const std::string context = hex(k) + " " + hex(g) + " " + hex(x) + " " + hex(y) + " " + hex(side);
        CHECK_MESSAGE(of_below == (sign < 0 ? Coverage::outside : Coverage::partial), context);
        CHECK_MESSAGE(of_above == (sign < 0 ? Coverage::partial : Coverage::inside), context);
        outside += of_below == Coverage::outside;
        inside += of_above == Coverage::inside;
    }
    CHECK(outside > 1000);
    CHECK(inside > 2000);
}

TEST_CASE("what is no body, no slide or no number gets a safe answer") {
    const auto projector = texgen::make_projector(
        texgen::PerspectiveLens{.fovy = degrees(30), .aspect = 1, .z_near = 0.2, .z_far = 1000},
        texgen::Aim{.position = {0, 0, 0}, .target = {0, 0, -1}, .up = {0, 1, 0}}, texgen::opengl);
    REQUIRE(projector);
    const WorldTexgen transform = texgen::texture_from_world(*projector);
    const Box inside{{-0.1f, -0.1f, -11.0f}, {0.1f, 0.1f, -10.0f}};
    const Sphere ball{{0.0f, 0.0f, -10.0f}, 0.5f};
    const Box behind{{-0.1f, -0.1f, 10.0f}, {0.1f, 0.1f, 11.0f}};
    const Box everything{glm::vec3(-infinity_float), glm::vec3(infinity_float)};
    CHECK(coverage(transform, whole_texture(), inside) == Coverage::inside);
    CHECK(coverage(transform, whole_texture(), ball) == Coverage::inside);
    CHECK(coverage(transform, whole_texture(), behind) == Coverage::outside);
    CHECK(coverage(transform, whole_texture(), everything) == Coverage::partial);

    // The apex itself has q = 0, and the half-space behind it, too.
    CHECK(coverage(transform, whole_texture(), Box{glm::vec3(0.0f), glm::vec3(0.0f)}) == Coverage::outside);
    CHECK(coverage(transform, whole_texture(),
                   Box{{-infinity_float, -infinity_float, 0.0f}, glm::vec3(infinity_float)}) == Coverage::outside);
    CHECK(coverage(transform, whole_texture(),
                   Box{{-infinity_float, -infinity_float, -1e-30f}, glm::vec3(infinity_float)}) == Coverage::partial);
    // A beam to infinity along the projector's axis.
    CHECK(coverage(transform, whole_texture(), Box{{-0.1f, -0.1f, -infinity_float}, {0.1f, 0.1f, -10.0f}}) ==
          Coverage::inside);

    SUBCASE("spheres") {
        const auto of = [&](const Sphere& sphere) {
            Coverage of_batch{};
            coverage(transform, whole_texture(), std::span(&sphere, 1), std::span(&of_batch, 1));
            CHECK(of_batch == coverage(transform, whole_texture(), sphere));
            return of_batch;
        };
        CHECK(of({{0, 0, -10}, -1.0f}) == Coverage::outside);
        CHECK(of({{0, 0, -10}, -infinity_float}) == Coverage::outside);
        CHECK(of({{0, 0, -10}, nan_float}) == Coverage::partial);
        CHECK(of({{nan_float, 0, -10}, -1.0f}) == Coverage::partial);
        CHECK(of({{0, 0, 10}, infinity_float}) == Coverage::partial);
        CHECK(of({{0, 0, infinity_float}, 1.0f}) == Coverage::partial);
        CHECK(of({{0, 0, 10}, 0.0f}) == Coverage::outside);
        CHECK(of({{0, 0, -10}, 0.0f}) == Coverage::inside);
    }
    SUBCASE("regions without a point are outside, and none is made of a NaN in the box") {
        const double nan = std::numeric_limits<double>::quiet_NaN();
        for (const TextureRegion& region :
             {atlas_tile({0.6, 0.0}, {0.4, 1.0}), atlas_tile({0.0, nan}, {1.0, 1.0}),
              atlas_tile({0.0, 0.0}, {1.0, nan}), atlas_tile({infinite, 0.0}, {-infinite, 1.0})}) {
            CHECK(coverage(transform, region, inside) == Coverage::outside);
            CHECK(coverage(transform, region, ball) == Coverage::outside);
            CHECK(coverage(transform, region, Box{inside.min, glm::vec3(nan_float)}) == Coverage::partial);
        }
        CHECK(coverage(transform, atlas_tile({-infinite, -infinite}, {infinite, infinite}), inside) ==
              Coverage::inside);
        CHECK(coverage(transform, atlas_tile({-infinite, -infinite}, {infinite, infinite}), behind) ==
              Coverage::outside);
    }
    SUBCASE("a matrix with a NaN or an infinity anywhere makes everything partial, but what is empty") {
        for (int element = 0; element < 16; ++element) {
            for (const double bad : {std::numeric_limits<double>::quiet_NaN(), infinite, -infinite}) {
                glm::dmat4 matrix = transform.matrix();
                matrix[element / 4][element % 4] = bad;
                CHECK(coverage(WorldTexgen(matrix), whole_texture(), inside) == Coverage::partial);
                CHECK(coverage(WorldTexgen(matrix), whole_texture(), behind) == Coverage::partial);
                CHECK(coverage(WorldTexgen(matrix), whole_texture(), ball) == Coverage::partial);
                CHECK(coverage(WorldTexgen(matrix), whole_texture(), Box{inside.max, inside.min}) == Coverage::outside);
            }
        }
    }
    SUBCASE("numbers beyond the stated exponents make all that is not empty partial, wherever it is") {
        for (const double beyond : {0x1p201, 0x1p-201}) {
            for (int side = 0; side < 4; ++side) {
                glm::dvec2 min(-0x1p202), max(0x1p199);
                (side < 2 ? min : max)[side % 2] = side < 2 ? -beyond : beyond;
                if (side < 2) (side == 0 ? min.y : min.x) = -1.0;
                if (side >= 2) min = glm::dvec2(-1.0);
                CHECK(coverage(transform, atlas_tile(min, max), behind) == Coverage::partial);
                CHECK(coverage(transform, atlas_tile(min, max), ball) == Coverage::partial);
            }
        }
        for (const double beyond : {0x1p1001, 0x1p-1003}) {
            const WorldTexgen scaled(transform.matrix() * beyond);
            CHECK(coverage(scaled, whole_texture(), behind) == Coverage::partial);
            CHECK(coverage(scaled, whole_texture(), ball) == Coverage::partial);
            CHECK(coverage(scaled, whole_texture(), Box{inside.max, inside.min}) == Coverage::outside);
        }
    }
    SUBCASE("a sphere with a NaN in any number is partial, whatever else is wrong") {
        const TextureRegion empty = atlas_tile({1.0, 1.0}, {0.0, 0.0});
        for (int number = 0; number < 4; ++number) {
            Sphere sphere{{0, 0, 0}, number == 3 ? 1.0f : -1.0f};
            (number == 3 ? sphere.radius : sphere.centre[number]) = nan_float;
            for (const TextureRegion& region : {whole_texture(), empty}) {
                CHECK(coverage(transform, region, sphere) == Coverage::partial);
                Coverage of_batch = Coverage::outside;
                coverage(transform, region, std::span(&sphere, 1), std::span(&of_batch, 1));
                CHECK(of_batch == Coverage::partial);
            }
        }
    }
    SUBCASE("where q is 0 everywhere nothing is lit") {
        glm::dmat4 matrix = transform.matrix();
        for (int j = 0; j < 4; ++j) matrix[j][3] = 0.0;
        CHECK(coverage(WorldTexgen(matrix), whole_texture(), everything) == Coverage::outside);
        CHECK(coverage(WorldTexgen(matrix), whole_texture(), ball) == Coverage::outside);
        CHECK(coverage(WorldTexgen(glm::dmat4(0.0)), whole_texture(), everything) == Coverage::outside);
    }
    SUBCASE("an empty batch is answered") {
        coverage(transform, whole_texture(), std::span<const Box>(), std::span<Coverage>());
        coverage(transform, whole_texture(), std::span<const Sphere>(), std::span<Coverage>());
    }
}
