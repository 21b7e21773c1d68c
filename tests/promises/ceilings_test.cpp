// The worst that was seen of every function, in every family and build: ceilings.txt. A run may lower a ceiling, and
// none may raise one.
//
// With TEXGEN_LOWER_CEILINGS=<file> the table is written there, lowered to what this run saw, with rows of its own
// build.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include "promises/ceilings_test/matrices.hpp"
#include "promises/ceilings_test/points.hpp"
#include "promises/ceilings_test/surfaces.hpp"
#include "promises/ceilings_test/triangles.hpp"
#include "support/hard_triangles.hpp"
#include "support/has_avx512.hpp"
#include "support/surfaces.hpp"

namespace ceilings {

namespace {

// What decides the bits of the tiers below exact: the compiler, which contracts or does not, and the instruction set.
std::string build() {
#if defined(TEXGEN_SCALAR)
    const std::string set = "loops";
#elif defined(__x86_64__)
#if defined(TEXGEN_NO_DISPATCH)
    const std::string set = "flags";
#else
    const std::string set = support::has_avx512() ? "avx512" : __builtin_cpu_supports("avx2") ? "avx2" : "sse2";
#endif
#else
    const std::string set = "other";
#endif
#if defined(__FMA__)
    const std::string flags = "-fma";
#else
    const std::string flags;
#endif
#if defined(__clang__)
    return "clang++-" + set + flags;
#else
    return "g++-" + set + flags;
#endif
}

// function | family | build -> ceiling. A row for the build `any` serves those that have none of their own.
class Ceilings {
public:
    explicit Ceilings(const std::string& path) {
        std::ifstream file(path);
        for (std::string line; std::getline(file, line);) {
            if (line.empty() || line.front() == '#') {
                heading_ += line + "\n";
                continue;
            }
            std::istringstream fields(line);
            std::array<std::string, 4> field;
            for (std::string& f : field) {
                std::getline(fields, f, '|');
                f.erase(0, f.find_first_not_of(' '));
                f.erase(f.find_last_not_of(' ') + 1);
            }
            rows_[{field[0], field[1], field[2]}] = std::strtod(field[3].c_str(), nullptr);
        }
    }

    bool is_empty() const { return rows_.empty(); }

    double of(const std::string& function, const std::string& family, const std::string& own_build) const {
        for (const std::string& name : {own_build, std::string("any")})
            if (const auto row = rows_.find({function, family, name}); row != rows_.end()) return row->second;
        return -1.0;
    }

    void lower(const std::string& function, const std::string& family, const std::string& name, double seen) {
        // Rounded up in the third digit, so that a ceiling says no more than it knows.
        const double unit = seen > 0.0 ? std::pow(10.0, std::floor(std::log10(seen)) - 2.0) : 1.0;
        const double ceiling = std::ceil(seen / unit) * unit;
        const auto [row, is_new] = rows_.insert({{function, family, name}, ceiling});
        if (!is_new) row->second = std::min(row->second, ceiling);
    }

    void write(const std::string& path) const {
        std::ofstream file(path);
        file << heading_;
        for (const auto& [name, ceiling] : rows_)
            file << name[0] << " | " << name[1] << " | " << name[2] << " | " << ceiling << "\n";
    }

private:
    std::string heading_;
    std::map<std::array<std::string, 3>, double> rows_;
};

}  // namespace

TEST_CASE("no ceiling is raised") {
    Ceilings ceilings(TEXGEN_TEST_DATA "/promises/ceilings.txt");
    const char* const lowered = std::getenv("TEXGEN_LOWER_CEILINGS");
    REQUIRE((lowered != nullptr || !ceilings.is_empty()));
    const auto hold = [&](const std::string& function, const std::string& family, bool same_in_every_build,
                          double seen) {
        const std::string row = same_in_every_build ? "any" : build();
        const double ceiling = ceilings.of(function, family, build());
        if (lowered != nullptr) return ceilings.lower(function, family, row, seen);
        CHECK_MESSAGE(ceiling >= 0.0, "no ceiling for ", function, " | ", family);
        CHECK_MESSAGE(seen <= ceiling, function, " | ", family, " | ", row, " | ", seen);
        if (seen < 0.9 * ceiling) MESSAGE("may be lowered: ", function, " | ", family, " | ", row, " | ", seen);
    };

    std::uint64_t seed = 9000;
    for (const support::HardFamily& family : support::hard_families) {
        const Worst worst = of_triangles(family, ++seed);
        hold("triangle, exact, ulp", family.name, true, worst.exact);
        hold("triangle, share of the tolerance", family.name, false, worst.share);
        hold("triangle, share of error_bound", family.name, false, worst.bound);
    }
    seed = 9018;
    for (const SegmentFamily& family : segment_families) {
        const Worst worst = of_segments(family, ++seed);
        hold("segment, exact, ulp", family.name, true, worst.exact);
        hold("segment, share of the tolerance", family.name, false, worst.share);
    }
    seed = 9021;
    for (const PointFamily& family : point_families) {
        const WorstPoints worst = of_points(family, ++seed);
        hold("project, exact, ulp", family.name, true, worst.exact);
        hold("project, share of the tolerance", family.name, false, worst.share);
        hold("generate, ulp", family.name, false, worst.generate);
    }
    seed = 9024;
    for (std::size_t i = 0; i < matrix_families.size(); ++i) {
        const WorstMatrices worst = of_matrices(static_cast<MatrixFamily>(i), ++seed);
        hold("inverse, ulp of the largest term", matrix_families[i], false, worst.inverse);
        hold("stored eye planes, ulp of the largest", matrix_families[i], false, worst.planes);
    }
    for (const support::HardFamily& family : support::hard_families)
        hold("footprint, share of error_bound", family.name, false, of_footprints(family, ++seed));
    hold("perspective, ulp", "0.1 to 179.9 degrees", false, of_lenses(++seed));
    hold("look_at, ulp of 1", "any up", false, of_views(false, ++seed));
    hold("look_at, ulp of 1", "up within 1e-7 to 1e-1 of the view", false, of_views(true, ++seed));
    for (const char* const distance : {"1", "1e3", "1e5", "1e7"})
        hold("object_linear in float, texels of 4096", std::string(distance) + " from the origin", false,
             of_poses(std::strtod(distance, nullptr), ++seed));
    hold("clip_to_slide, share of slide_clip_error", "ordinary", true, of_clips(false, false, ++seed));
    hold("clip_to_slide, share of slide_clip_error", "about the projector", true, of_clips(true, false, ++seed));
    for (std::size_t i = 0; i < corner_families.size(); ++i) {
        const WorstSurfaces worst = of_surfaces(support::corner_families[i], ++seed);
        hold("slide_area, 2^-52 of itself", corner_families[i], false, worst.area);
        hold("receiver_plane, 2^-52 of itself", corner_families[i], false, worst.plane);
    }
    seed = 9060;
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        const WorstQuadrilaterals worst = of_quadrilaterals(support::shapes[i], ++seed);
        hold("quadrilateral, ulp of q", shapes[i], false, worst.q);
        hold("keystone, 2^-52 of its terms", shapes[i], false, worst.matrix);
    }
    seed = 9066;
    hold("pinhole, ulp", "the axis anywhere", false, of_pinholes(false, ++seed));
    hold("pinhole, ulp", "the axis near the middle", false, of_pinholes(true, ++seed));
    for (const char* const distance : {"1", "1e3", "1e5", "1e7"})
        hold("window_linear, 2^-53 of its terms", std::string(distance) + " from the origin", false,
             of_windows(std::strtod(distance, nullptr), ++seed));
    seed = 9072;
    hold("clip_to_slide with a depth, share of slide_clip_error", "ordinary", true, of_clips(false, true, ++seed));
    hold("clip_to_slide with a depth, share of slide_clip_error", "about the projector", true,
         of_clips(true, true, ++seed));
    for (const double z_far : {20.0, HUGE_VAL}) {
        for (const bool is_reversed : {false, true}) {
            const std::string family =
                std::string(z_far < HUGE_VAL ? "to z_far" : "infinite") + (is_reversed ? ", reversed" : "");
            const WorstDepths worst = of_depths(z_far, is_reversed, ++seed);
            hold("project r, exact, ulp", family, true, worst.r);
            hold("clip_planes of a depth, ulp", family, true, worst.planes);
        }
    }
    seed = 9090;
    for (const char* const distance : {"1", "1e7"})
        hold("mirrored, ulp", std::string(distance) + " from the origin", false,
             of_mirrors(std::strtod(distance, nullptr), ++seed));
    const WorstAspects aspects = of_aspects(++seed);
    hold("contain, ulp of the angle", "any", false, aspects.angle);
    hold("contain, 2^-53 of the largest side", "any", false, aspects.sides);
    hold("cover, 2^-53 of the largest side", "any", false, aspects.crop);
    if (lowered != nullptr) ceilings.write(lowered);
}

}  // namespace ceilings
