// A search that tries to break what the library promises: it climbs over the bits of the inputs towards the largest
// share of each stated bound, and towards the decisions that hang by the least. Exact integers and rationals judge.
// Prints, for every promise, the worst input that it met; fails where a promise is broken.
//
//   adversary [--seconds N] [--seed N] [--only WORD] [--towards error]
//
// Towards time it climbs to the inputs that a function takes longest for, as a multiple of what ordinary ones take, and
// fails where that is above its limit (support/limits.hpp). What it prints is a line of worst_inputs.txt, behind what
// it measured; it begins with those, and with 0 seconds they are all. Functions whose names stand behind --but, which a
// | separates, are searched, and never fail.
//
//   adversary --towards time [--seconds N] [--seed N] [--only WORD] [--but NAME|NAME...]

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "promises/adversary/bodies.hpp"
#include "promises/adversary/climbs.hpp"
#include "promises/adversary/inputs.hpp"
#include "promises/adversary/matrices.hpp"
#include "promises/adversary/points.hpp"
#include "promises/adversary/shares.hpp"
#include "promises/adversary/surfaces.hpp"
#include "promises/adversary/time.hpp"
#include "promises/adversary/triangles.hpp"
#include "support/random.hpp"
#include "support/workloads/surfaces.hpp"

namespace {

using namespace adversary;

const std::array promises{
    Promise{"generate: 2^-50 of the terms", 4,
            [](Random& random) {
                Numbers n = any_floats(random, 4);
                for (int k = 0; k < 4; ++k) n.push_back(random.coin() ? any_float(random) : random.uniform(-1.0, 1.0));
                return n;
            },
            generate_share},
    Promise{"generate: generate_error_bound", 4, [](Random& random) { return any_floats(random, 8); },
            generate_bound_share},
    Promise{"project, exact: the nearest float, a decision", 25, begin_batch, project_exact_share},
    Promise{"project: the tolerance", 25, [](Random& random) { return with_tolerance(begin_batch(random), random); },
            project_within_share},
    Promise{"project: project_error_bound", 25,
            [](Random& random) { return with_tolerance(begin_batch(random), random); }, project_bound_share},
    Promise{"segment, exact: the nearest float, a decision", 9, begin_segment, segment_exact_share},
    Promise{"segment: the tolerance", 9, [](Random& random) { return with_tolerance(begin_segment(random), random); },
            segment_within_share},
    Promise{"segment: error_bound", 9, [](Random& random) { return with_tolerance(begin_segment(random), random); },
            segment_bound_share},
    Promise{"triangle, exact: the nearest float, a decision", 21, begin_triangle, triangle_exact_share},
    Promise{"triangle: the tolerance", 21,
            [](Random& random) { return with_tolerance(begin_triangle(random), random); },
            triangle_within_share<false>},
    Promise{"triangle: error_bound", 21, [](Random& random) { return with_tolerance(begin_triangle(random), random); },
            triangle_within_share<true>},
    Promise{"triangle: work, a decision", 21, begin_triangle, work_share},
    Promise{"footprint: error_bound", 21, begin_triangle, footprint_share<OfFootprints::bound>},
    Promise{"footprint: extremes", 21, begin_triangle, footprint_share<OfFootprints::extremes>},
    Promise{"footprint of ids: error_bound", 21, begin_triangle, footprint_share<OfFootprints::batch>},
    Promise{"box: coverage, a decision", 25, begin_batch, coverage_share},
    Promise{"inverse: 2 ulp of the largest term", 0, begin_matrix, inverse_share},
    Promise{"inverse: inverse_error_bound", 0, begin_matrix, inverse_bound_share},
    Promise{"pinhole: 4 ulp", 0, begin_pinhole, pinhole_share},
    Promise{"mirrored: 1 ulp, or 2^-96 of the terms", 0,
            [](Random& random) {
                Numbers n(20);
                for (double& x : n) x = random.uniform(-1.0, 1.0);
                return n;
            },
            mirrored_share},
    Promise{"eye planes: 0.54 ulp of the largest", 20, begin_planes, eye_planes_share},
    Promise{"clip to the slide: slide_clip_error", 24, [](Random& random) { return any_floats(random, 24); },
            clip_to_slide_share},
    Promise{"clip to near: 1/2 ulp + clip_error", 24, [](Random& random) { return any_floats(random, 24); },
            clip_to_near_share},
    Promise{"window_linear: 2^-47 of the terms", 3, begin_window, window_share},
    Promise{"depth_error_bound", 4, begin_depth, depth_bound_share},
    Promise{"facing: the exact sign, a decision", 12, begin_surface, facing_share},
    Promise{"slide_area: 2^-50 of itself", 12, begin_surface, slide_area_share},
    Promise{"receiver_plane: 2^-49 of itself", 12, begin_surface, receiver_plane_share},
    Promise{"quadrilateral: the homography's q, a decision", 0, support::detail::draw_quadrilateral,
            quadrilateral_share},
    Promise{"keystone: 2^-48 of its terms, a decision", 0, support::detail::draw_quadrilateral, keystone_share},
};

bool search_towards_error(double seconds, std::uint64_t seed, std::string_view only) {
    bool all_kept = true;
    for (const Promise& promise : promises) {
        if (std::string_view(promise.name).find(only) == std::string_view::npos) continue;
        const Find worst = search(promise, seconds / static_cast<double>(promises.size()), seed);
        const bool kept = worst.share >= 0.0 && worst.share <= 1.0;
        all_kept = all_kept && kept;
        std::printf("%-48s %s %.6f of it after %ld inputs:", promise.name, kept ? "kept," : "BROKEN,", worst.share,
                    worst.tried);
        for (const double number : worst.numbers) std::printf(" %a", number);
        std::printf("\n");
        std::fflush(stdout);
    }
    return all_kept;
}

}  // namespace

int main(int count, char** arguments) {
    double seconds = 5.0;
    std::uint64_t seed = 1;
    std::string_view only, excepted, towards = "error";
    for (int i = 1; i + 1 < count; i += 2) {
        const std::string_view option = arguments[i];
        if (option == "--seconds") seconds = std::atof(arguments[i + 1]);
        if (option == "--seed") seed = std::strtoull(arguments[i + 1], nullptr, 10);
        if (option == "--only") only = arguments[i + 1];
        if (option == "--but") excepted = arguments[i + 1];
        if (option == "--towards") towards = arguments[i + 1];
    }
    const bool all_kept = towards == "time" ? search_towards_time(seconds, seed, only, excepted)
                                            : search_towards_error(seconds, seed, only);
    if (std::ferror(stdout) != 0) {
        std::fputs("adversary: cannot write to standard output\n", stderr);
        return EXIT_FAILURE;
    }
    return all_kept ? EXIT_SUCCESS : EXIT_FAILURE;
}
