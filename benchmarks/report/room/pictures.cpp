#include "pictures.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <texgen/interpolate.hpp>
#include <texgen/scene.hpp>

namespace report::lit_room {

Picture shaded(const Rules& rule, const Room& room, const Seen& seen, const texgen::Scene& scene, const Camera& camera,
               const Picture& slide, int width, int height) {
    Picture picture(width, height, glm::vec3(0.02f));
    const auto at_pixel = [&](int x, int y) -> glm::vec3& { return picture.at(x, height - 1 - y); };
    const auto attributes = [&](std::uint32_t o, std::size_t triangle, int x, int y) {
        Attributes at = AttributePlane(seen.work[o].triangles[triangle]).attributes(x, y);
        at.normal = glm::normalize(at.normal);
        if (glm::dot(at.normal, glm::vec3(camera.position) - at.position) < 0.0f) at.normal = -at.normal;
        return at;
    };
    for (std::uint32_t o = 0; o < room.objects.size(); ++o) {
        for (const Workload::Job& job : seen.work[o].jobs) {
            for (std::size_t r = job.first_rect; r < job.first_rect + job.rect_count; ++r) {
                seen.for_each_seen({o, static_cast<std::uint32_t>(job.triangle)}, r, [&](std::size_t, int x, int y) {
                    const Attributes at = attributes(o, job.triangle, x, y);
                    const glm::vec3 to_camera = glm::normalize(glm::vec3(camera.position) - at.position);
                    at_pixel(x, y) = room.objects[o].colour * (0.1f + 0.2f * glm::dot(at.normal, to_camera));
                });
            }
        }
    }
    light_all(rule, room, seen, scene,
              [&](std::uint32_t o, std::uint32_t p, std::size_t triangle, std::size_t r, texgen::Work,
                  const RectCoordinates& coordinates) {
                  seen.for_each_seen({o, static_cast<std::uint32_t>(triangle)}, r, [&](std::size_t i, int x, int y) {
                      if (coordinates.lit[i] == 0.0f) return;
                      const Attributes at = attributes(o, triangle, x, y);
                      const glm::vec3 to_light = glm::normalize(glm::vec3(room.positions[p]) - at.position);
                      const float diffuse = std::max(0.0f, glm::dot(at.normal, to_light));
                      at_pixel(x, y) += 1.3f * diffuse * room.objects[o].colour * room.tints[p] *
                                        slide.sample(coordinates.s[i], coordinates.t[i]);
                  });
              });
    // Where many slides fall on one another they approach white and keep their differences.
    for (glm::vec3& colour : picture.pixels) colour = 1.0f - glm::exp(-1.8f * colour);
    return picture;
}

Picture coloured_by_work(const Room& room, const Seen& seen, const texgen::Scene& scene, int width, int height) {
    std::vector<texgen::Work> most(seen.nearest.size(), texgen::Work::nothing);
    Rules rule = rules.back();
    rule.tolerance = texgen::texels(1.0 / 512, 4096);
    light_all(rule, room, seen, scene,
              [&](std::uint32_t o, std::uint32_t, std::size_t triangle, std::size_t r, texgen::Work work,
                  const RectCoordinates&) {
                  seen.for_each_seen({o, static_cast<std::uint32_t>(triangle)}, r, [&](std::size_t, int x, int y) {
                      texgen::Work& at = most[seen.pixel(x, y)];
                      at = std::max(at, work);
                  });
              });
    Picture picture(width, height, glm::vec3(0));
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            picture.at(x, height - 1 - y) = work_colours[static_cast<std::size_t>(most[seen.pixel(x, y)])].colour;
    return picture;
}

void count_lit(RoomReport& report, const Room& room, const Seen& seen, const texgen::Scene& scene) {
    std::size_t covered = 0, lit = 0, in_view = 0;
    std::vector<bool> is_bright(room.objects.size() * room.projectors.size(), false);
    for (const Workload& work : seen.work)
        for (std::size_t r = 0; r < work.rects.size(); ++r)
            Seen::for_each_covered(work, r, [&](std::size_t, int, int) { ++covered; });
    light_all(rules.back(), room, seen, scene,
              [&](std::uint32_t o, std::uint32_t p, std::size_t, std::size_t r, texgen::Work,
                  const RectCoordinates& coordinates) {
                  Seen::for_each_covered(seen.work[o], r, [&](std::size_t i, int, int) {
                      if (coordinates.lit[i] == 0.0f) return;
                      ++lit;
                      is_bright[o * room.projectors.size() + p] = true;
                  });
              });
    for (const texgen::LitPair& pair : scene.pairs()) in_view += !seen.work[pair.object].jobs.empty();
    const auto bright = static_cast<std::size_t>(std::count(is_bright.begin(), is_bright.end(), true));
    report.lit_share =
        static_cast<double>(lit) / static_cast<double>(std::max<std::size_t>(1, covered * projector_count));
    report.dark_pair_share =
        static_cast<double>(in_view - bright) / static_cast<double>(std::max<std::size_t>(1, in_view));
}

}  // namespace report::lit_room
