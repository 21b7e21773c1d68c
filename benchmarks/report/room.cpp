#include "room.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <limits>
#include <utility>

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <texgen/interpolate.hpp>
#include <texgen/linear.hpp>
#include <texgen/projector.hpp>
#include <texgen/scene.hpp>

#include "html.hpp"
#include "mesh.hpp"
#include "rasterizer.hpp"

namespace report {

namespace {

constexpr int floor_cells = 20, wall_rows = 4;
constexpr float cell = 1.5f, half_side = 0.5f * cell * floor_cells;
constexpr std::size_t object_count = 2000, projector_count = 64;
constexpr std::size_t moved_count = object_count / 100;
constexpr int frame_count = 6;
constexpr texgen::TextureRegion slide_region = texgen::whole_texture();
constexpr texgen::TextureRegion volume_region = slide_region.with_depth();
constexpr double reach =
    9.0;  // the far plane of the projectors, beyond which they light nothing where their depth counts

bool is_across(std::size_t projector) { return projector % 8 == 3; }

// Numbers in [0, 1) that are the same everywhere.
class Numbers {
public:
    double operator()() {
        state_ = state_ * 6364136223846793005u + 1442695040888963407u;
        return static_cast<double>(state_ >> 11) * 0x1p-53;
    }
    double operator()(double low, double high) { return low + (high - low) * (*this)(); }

private:
    std::uint64_t state_ = 1;
};

struct Object {
    Mesh mesh;
    glm::vec3 colour;
};

// The engine's arrays.
struct Room {
    std::vector<Object> objects;
    std::vector<texgen::ModelMatrix> models;
    std::vector<texgen::Box> bounds;
    std::vector<texgen::Projector> projectors;
    std::vector<glm::vec3> tints;       // of the projectors
    std::vector<glm::dvec3> positions;  // of the projectors
    std::vector<std::uint32_t> crates;  // the objects that may move
    std::vector<texgen::TextureRegion> regions_in_reach;

    texgen::SceneView view() const { return {models, bounds, projectors}; }
    texgen::SceneView view_in_reach() const { return {models, bounds, projectors, regions_in_reach}; }

    void add(Mesh mesh, const glm::dmat4& model, glm::vec3 colour) {
        texgen::Box box{glm::vec3(HUGE_VALF), glm::vec3(-HUGE_VALF)};
        for (const glm::vec3& position : mesh.positions)
            box = {glm::min(box.min, position), glm::max(box.max, position)};
        objects.push_back({std::move(mesh), colour});
        models.push_back(texgen::ModelMatrix(model));
        bounds.push_back(box);
    }
};

// Down to the floor, or across the room.
texgen::Projector spot(glm::dvec3 position, double turn, bool across) {
    const glm::dvec3 down(1.6 * std::cos(turn), -position.y, 1.6 * std::sin(turn));
    const glm::dvec3 target = position + (across ? glm::dvec3(std::cos(turn), -0.2, std::sin(turn)) : down);
    const texgen::PerspectiveLens lens{.fovy = texgen::degrees(32), .aspect = 1, .z_near = 0.1, .z_far = reach};
    return texgen::make_projector(lens, {position, target, {0, 1, 0}}, texgen::opengl).value();
}

Room make_objects() {
    Room room;
    Numbers number;
    const glm::dmat4 in_place(1.0);
    const glm::vec3 plaster(0.8f, 0.78f, 0.74f);
    for (int x = 0; x < floor_cells; ++x)
        for (int z = 0; z < floor_cells; ++z)
            room.add(parallelogram(
                         {cell * static_cast<float>(x) - half_side, 0, cell * static_cast<float>(z + 1) - half_side},
                         {cell, 0, 0}, {0, 0, -cell}, 1),
                     in_place, plaster);
    for (int side = 0; side < 4; ++side) {
        const glm::dmat4 turned = glm::rotate(in_place, glm::radians(90.0 * side), glm::dvec3(0, 1, 0));
        for (int x = 0; x < floor_cells; ++x)
            for (int y = 0; y < wall_rows; ++y)
                room.add(
                    parallelogram({cell * static_cast<float>(x) - half_side, cell * static_cast<float>(y), -half_side},
                                  {cell, 0, 0}, {0, cell, 0}, 1),
                    turned, plaster);
    }
    while (room.objects.size() < object_count) {
        const glm::vec3 half(number(0.08, 0.25), number(0.06, 0.3), number(0.08, 0.25));
        glm::dmat4 model = glm::translate(in_place, glm::dvec3(number(-14, 14), half.y, number(-14, 14)));
        model = glm::rotate(model, number(0, 6.28), glm::dvec3(0, 1, 0));
        room.crates.push_back(static_cast<std::uint32_t>(room.objects.size()));
        room.add(box(-half, half), model, glm::vec3(number(0.5, 0.95), number(0.5, 0.95), number(0.5, 0.95)));
    }
    for (std::size_t i = 0; i < projector_count; ++i) {
        const glm::dvec3 position(-13.0 + 26.0 / 7.0 * static_cast<double>(i % 8), 5.5,
                                  -13.0 + 26.0 / 7.0 * static_cast<double>(i / 8));
        room.positions.push_back(position);
        room.projectors.push_back(spot(position, number(0, 6.28), is_across(i)));
        room.tints.push_back(glm::vec3(number(0.5, 1), number(0.5, 1), number(0.5, 1)));
        room.regions_in_reach.push_back(volume_region);
    }
    return room;
}

// What a frame shows: the workload of each object, and the triangle that is seen at each pixel.
struct Seen {
    struct Triangle {
        std::uint32_t object, triangle;
        friend bool operator==(const Triangle&, const Triangle&) = default;
    };
    static constexpr std::uint32_t nothing = 0xffffffff;

    std::vector<Workload> work;  // of each object
    std::vector<Triangle> nearest;
    int width;

    std::size_t pixel(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    }

    // visit(index in the rect, x, y) for the fragments of a rect that its triangle covers, or where it is seen.
    template <class Visit>
    static void for_each_covered(const Workload& work, std::size_t r, const Visit& visit) {
        const texgen::FragmentRect& rect = work.rects[r];
        for (int row = 0; row < rect.height; ++row) {
            const auto [begin, end] = work.coverage[r][static_cast<std::size_t>(row)];
            for (int column = begin; column < end; ++column)
                visit(static_cast<std::size_t>(row * rect.width + column), rect.x + column, rect.y + row);
        }
    }
    template <class Visit>
    void for_each_seen(Triangle triangle, std::size_t r, const Visit& visit) const {
        for_each_covered(work[triangle.object], r, [&](std::size_t i, int x, int y) {
            if (nearest[pixel(x, y)] == triangle) visit(i, x, y);
        });
    }
};

Seen look(const Room& room, const Camera& camera, int width, int height) {
    const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    Seen seen{{}, std::vector<Seen::Triangle>(pixels, {Seen::nothing, 0}), width};
    std::vector<float> depth(pixels, std::numeric_limits<float>::infinity());
    for (std::uint32_t o = 0; o < room.objects.size(); ++o) {
        // In the place of texture coordinates the vertices carry their position, of which each projector makes its own.
        const Object& object = room.objects[o];
        Surface surface{object.mesh, room.models[o], {}, object.colour};
        for (const glm::vec3& position : object.mesh.positions) surface.strq.emplace_back(position, 1.0f);
        seen.work.push_back(rasterize(std::span(&surface, 1), camera, width, height));
        const Workload& work = seen.work.back();
        for (const Workload::Job& job : work.jobs) {
            const AttributePlane plane(work.triangles[job.triangle]);
            for (std::size_t r = job.first_rect; r < job.first_rect + job.rect_count; ++r) {
                Seen::for_each_covered(work, r, [&](std::size_t, int x, int y) {
                    const float at = plane.depth(x, y);
                    if (!(at < depth[seen.pixel(x, y)])) return;
                    depth[seen.pixel(x, y)] = at;
                    seen.nearest[seen.pixel(x, y)] = {o, static_cast<std::uint32_t>(job.triangle)};
                });
            }
        }
    }
    return seen;
}

struct Rules {
    const char* name;
    bool scene, triangles, rects;
    texgen::Tolerance tolerance = texgen::exact;
    texgen::TextureRegion region = slide_region;
};
constexpr std::array rules{Rules{"none", false, false, false},
                           Rules{"rectangles", false, false, true},
                           Rules{"triangles, rectangles", false, true, true},
                           Rules{"pairs", true, false, false},
                           Rules{"pairs, triangles", true, true, false},
                           Rules{"pairs, triangles, rectangles", true, true, true},
                           Rules{"pairs, rectangles", true, false, true}};

// Another picture: what is beyond the reach of a projector is dark.
constexpr Rules in_reach{"pairs, rectangles, depth", true, false, true, texgen::exact, volume_region};

struct Counts {
    std::size_t pairs = 0, triangles = 0, rects = 0, fragments = 0;
};

texgen::FragmentRect around(std::span<const texgen::FragmentRect> rects) {
    texgen::FragmentRect all = rects.front();
    for (const texgen::FragmentRect& rect : rects) {
        const int right = std::max(all.x + all.width, rect.x + rect.width);
        const int top = std::max(all.y + all.height, rect.y + rect.height);
        all.x = std::min(all.x, rect.x);
        all.y = std::min(all.y, rect.y);
        all.width = right - all.x;
        all.height = top - all.y;
    }
    return all;
}

// The coordinates that one projector gives an object. Without the rule of the rectangles each fragment is evaluated and
// compared. use(triangle, rect, work, coordinates) gets what may be lit.
template <class Use>
void light(const Rules& rule, const Workload& work, const texgen::ObjectTexgen& texgen, Counts& counts,
           const Use& use) {
    static RectCoordinates coordinates;
    const texgen::TextureRegion everywhere = texgen::atlas_tile({-HUGE_VAL, -HUGE_VAL}, {HUGE_VAL, HUGE_VAL});
    ++counts.pairs;
    for (const Workload::Job& job : work.jobs) {
        texgen::Triangle triangle = work.triangles[job.triangle].window;
        for (texgen::WindowVertex* vertex : {&triangle.a, &triangle.b, &triangle.c})
            vertex->strq = glm::vec4(texgen.matrix() * glm::dvec4(vertex->strq));
        const auto setup = texgen::TriangleSetup::of(triangle, rule.rects ? rule.region : everywhere, rule.tolerance);
        ++counts.triangles;
        if (!setup) continue;
        if (rule.triangles) {
            const auto tested = rule.rects ? setup : texgen::TriangleSetup::of(triangle, rule.region);
            if (tested->work(around(work.rects_of(job))) == texgen::Work::nothing) continue;
        }
        for (std::size_t r = job.first_rect; r < job.first_rect + job.rect_count; ++r) {
            const texgen::Texcoords out = coordinates.of(work.rects[r]);
            const texgen::Work done = texgen::interpolate(*setup, work.rects[r], out);
            ++counts.rects;
            if (done == texgen::Work::nothing) continue;
            counts.fragments += out.lit.size();
            if (!rule.rects) {
                // Without branches, so that the compiler can make vectors of the loop.
                for (std::size_t i = 0; i < out.lit.size(); ++i) {
                    const float in_s = out.s[i] >= 0.0f && out.s[i] <= 1.0f ? out.lit[i] : 0.0f;
                    out.lit[i] = out.t[i] >= 0.0f && out.t[i] <= 1.0f ? in_s : 0.0f;
                }
            }
            use(job.triangle, r, done, coordinates);
        }
    }
}

// All pairs of an object in view, or those of the scene; use() as above, with the pair before.
template <class Use>
Counts light_all(const Rules& rule, const Room& room, const Seen& seen, const texgen::Scene& scene, const Use& use) {
    Counts counts;
    const auto light_pair = [&](std::uint32_t o, std::uint32_t p, const texgen::ObjectTexgen& texgen) {
        light(rule, seen.work[o], texgen, counts,
              [&](std::size_t triangle, std::size_t rect, texgen::Work work, const RectCoordinates& coordinates) {
                  use(o, p, triangle, rect, work, coordinates);
              });
    };
    if (rule.scene) {
        for (const texgen::LitPair& pair : scene.pairs())
            if (!seen.work[pair.object].jobs.empty()) light_pair(pair.object, pair.projector, scene.texgen(pair));
        return counts;
    }
    for (std::uint32_t o = 0; o < room.objects.size(); ++o) {
        if (seen.work[o].jobs.empty()) continue;
        for (std::uint32_t p = 0; p < room.projectors.size(); ++p)
            light_pair(o, p, texgen::object_linear(room.projectors[p], room.models[o]));
    }
    return counts;
}

double seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

// The picture, lit by all projectors.
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

// Each seen fragment in the colour of the dearest work that a projector asks of its rectangle.
struct WorkColour {
    glm::vec3 colour;
    const char* meaning;
};
constexpr std::array<WorkColour, 5> work_colours{{{glm::vec3(0.10f, 0.11f, 0.14f), "dark none"},
                                                  {glm::vec3(0.2f, 0.55f, 0.95f), "blue affine"},
                                                  {glm::vec3(0.25f, 0.75f, 0.45f), "green quadratic"},
                                                  {glm::vec3(0.95f, 0.8f, 0.25f), "yellow a division"},
                                                  {glm::vec3(0.9f, 0.3f, 0.2f), "red a division and a test"}}};

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

// How much is lit, and which kept pairs light nothing.
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

Camera camera_at(int frame, double aspect) {
    const double angle = 0.6 + 0.04 * frame;
    const glm::dvec3 position(14.0 * std::sin(angle), 5.5, 14.0 * std::cos(angle));
    const glm::dmat4 projection = glm::perspective(glm::radians(58.0), aspect, 0.1, 100.0);
    return {projection * glm::lookAt(position, glm::dvec3(0, 0, 0), glm::dvec3(0, 1, 0)), position};
}

}  // namespace

bool RoomReport::is_same_picture() const {
    return std::ranges::all_of(rows, [](const RoomRow& row) { return row.same_picture; });
}

std::string RoomReport::key_of_work() const {
    std::string key;
    for (const WorkColour& work : work_colours)
        if (std::ranges::find(work_picture.pixels, work.colour) != work_picture.pixels.end())
            key += (key.empty() ? "" : ", ") + std::string(work.meaning);
    return key;
}

RoomReport make_room(const Picture& slide, int width, int height) {
    Room room = make_objects();
    RoomReport report{.objects = room.objects.size(),
                      .projectors = room.projectors.size(),
                      .moved_objects = moved_count,
                      .moved_projectors = 1,
                      .lit_share = 0,
                      .dark_pair_share = 0,
                      .update_microseconds = 0,
                      .first_update_microseconds = 0,
                      .rows = {},
                      .in_reach = {},
                      .picture = {},
                      .work_picture = {},
                      .reach_picture = {}};
    texgen::Scene scene, scene_in_reach;
    double start = seconds();
    scene.update(room.view(), {});
    report.first_update_microseconds = 1e6 * (seconds() - start);
    scene_in_reach.update(room.view_in_reach(), {});

    Numbers number;
    std::array<std::vector<double>, rules.size()> times;
    std::array<Counts, rules.size()> counts;
    std::vector<double> updates, times_in_reach;
    Counts counts_in_reach;
    for (int frame = 0; frame < frame_count; ++frame) {
        std::vector<std::uint32_t> moved;
        for (std::size_t i = 0; i < moved_count; ++i) {
            const std::uint32_t o =
                room.crates[static_cast<std::size_t>(number(0, static_cast<double>(room.crates.size())))];
            moved.push_back(o);
            room.models[o] = texgen::ModelMatrix(glm::rotate(room.models[o].matrix(), 0.1, glm::dvec3(0, 1, 0)));
        }
        const auto turned = static_cast<std::uint32_t>(frame);
        room.projectors[turned] = spot(room.positions[turned], number(0, 6.28), is_across(turned));
        const auto update_of = [&](texgen::Scene& changed, const texgen::SceneView& view) {
            start = seconds();
            changed.update(view, {moved, std::span(&turned, 1)});
            return seconds() - start;
        };
        const double update = update_of(scene, room.view());
        updates.push_back(1e6 * update);
        const double update_in_reach = update_of(scene_in_reach, room.view_in_reach());

        const Camera camera = camera_at(frame, static_cast<double>(width) / height);
        const Seen seen = look(room, camera, width, height);
        float sum = 0;
        const auto time = [&](const Rules& rule, const texgen::Scene& of, Counts& count) {
            start = seconds();
            count = light_all(rule, room, seen, of,
                              [&](std::uint32_t, std::uint32_t, std::size_t, std::size_t, texgen::Work,
                                  const RectCoordinates& coordinates) { sum += coordinates.s[0]; });
            return 1e3 * (seconds() - start);
        };
        for (std::size_t turn = 0; turn < rules.size(); ++turn) {
            const std::size_t k = (turn + static_cast<std::size_t>(frame)) % rules.size();
            times[k].push_back(time(rules[k], scene, counts[k]) + (rules[k].scene ? 1e3 * update : 0.0));
        }
        times_in_reach.push_back(time(in_reach, scene_in_reach, counts_in_reach) + 1e3 * update_in_reach);
        static volatile float sink = 0;
        sink = sink + sum;
        if (frame + 1 < frame_count) continue;

        report.picture = shaded(rules.front(), room, seen, scene, camera, slide, width, height);
        const auto row = [&](const Rules& rule, std::vector<double>& milliseconds, const Counts& count, bool is_same) {
            return RoomRow{.rules = rule.name,
                           .milliseconds = median(milliseconds),
                           .pairs = count.pairs,
                           .triangles = count.triangles,
                           .rects = count.rects,
                           .fragments = count.fragments,
                           .same_picture = is_same};
        };
        for (std::size_t k = 0; k < rules.size(); ++k) {
            const Picture again = shaded(rules[k], room, seen, scene, camera, slide, width, height);
            report.rows.push_back(row(rules[k], times[k], counts[k], again.pixels == report.picture.pixels));
        }
        report.reach_picture = shaded(in_reach, room, seen, scene_in_reach, camera, slide, width, height);
        report.in_reach = row(in_reach, times_in_reach, counts_in_reach, false);
        report.work_picture = coloured_by_work(room, seen, scene, width, height);
        count_lit(report, room, seen, scene);
    }
    report.update_microseconds = median(updates);
    return report;
}

namespace {

std::string summary_of(const RoomReport& room) {
    return formatted(
               "%zu objects, %zu projectors; from frame to frame the camera moves, %zu objects turn and %zu projector "
               "swings. %.2f%% of what the covered fragments could get from the projectors is lit. ",
               room.objects, room.projectors, room.moved_objects, room.moved_projectors, 100 * room.lit_share) +
           formatted(
               "The scene's update takes %.0f microseconds a frame (%.0f the first time) and is part of the times with "
               "pairs; of the pairs that it keeps in view, %.1f%% have no lit fragment. The last row of the table is "
               "%.1f times as fast as the first.",
               room.update_microseconds, room.first_update_microseconds, 100 * room.dark_pair_share, room.speedup()) +
           formatted(
               " Where the light ends at the far planes, %.0f from the projectors, %zu pairs in view are left of %zu, "
               "and "
               "a frame takes %.3g ms instead of %.3g.",
               reach, room.in_reach.pairs, room.rows.back().pairs, room.in_reach.milliseconds,
               room.rows.back().milliseconds);
}

}  // namespace

std::string text_of(const RoomReport& room) {
    std::string text = "room: " + summary_of(room) + "\n";
    text += formatted("%-30s %10s %10s %10s %10s %12s %8s\n", "rules", "ms", "pairs", "triangles", "rects", "fragments",
                      "picture");
    for (const RoomRow& row : room.rows)
        text += formatted("%-30s %10.2f %10zu %10zu %10zu %12zu %8s\n", row.rules.c_str(), row.milliseconds, row.pairs,
                          row.triangles, row.rects, row.fragments, row.same_picture ? "the same" : "differs");
    return text;
}

std::string html_of(const RoomReport& room) {
    std::string html =
        "<p>The room above, by which rules leave work out:</p>\n<table>\n<tr><th>rules</th><th>a frame</th>"
        "<th>times as fast</th><th>fragments</th></tr>\n";
    for (const RoomRow& row : room.rows)
        html += "<tr><td>" + escaped(row.rules) + "</td><td>" + duration(1e6 * row.milliseconds) +
                formatted("</td><td>%.1f</td><td>", room.rows.front().milliseconds / row.milliseconds) +
                grouped(row.fragments) + "</td></tr>\n";
    return html + "</table>\n" +
           folded("What the rules are, and what is counted",
                  "<p>" + escaped(summary_of(room)) + " The picture is " +
                      (room.is_same_picture() ? "the same" : "NOT the same") +
                      " by all rules.</p>\n<p>Pairs: Scene keeps only those that coverage() of the object's box does "
                      "not call "
                      "outside. Triangles: one question to the set-up for all its rectangles; it pays only where pairs "
                      "are "
                      "not skipped. Rectangles: Work::nothing; without this rule each fragment is evaluated and "
                      "compared.</p>\n");
}

}  // namespace report
