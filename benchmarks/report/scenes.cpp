#include "scenes.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include <texgen/footprint.hpp>
#include <texgen/linear.hpp>
#include <texgen/projector.hpp>
#include <texgen/surface.hpp>

#include "html.hpp"

namespace report {

namespace {

constexpr glm::vec3 plaster(0.86f, 0.85f, 0.82f);
constexpr glm::vec3 porcelain(0.95f, 0.94f, 0.92f);

// The projector of the GLSL walk-through.
const texgen::Aim walk_through_aim{.position = {2, 5, 5}, .target = {-2, -4, 0}, .up = {0, 1, 0}};
constexpr Depth walk_through_depth{8, 16};

// What a projector sees of the surfaces that its slide falls on.
std::shared_ptr<const DepthMap> seen_from(const texgen::Projector& projector, const texgen::Aim& aim,
                                          const Picture& slide, std::span<const Surface> surfaces) {
    constexpr int longer = 512;
    const int side = std::max(slide.width, slide.height);
    const auto texels = [&](int pixels) { return std::max(1, longer * pixels / side); };
    return std::make_shared<const DepthMap>(make_depth_map(surfaces, {projector.matrix().matrix(), aim.position},
                                                           texels(slide.width), texels(slide.height)));
}

View from_projector(std::string file, const std::string& sentence, std::shared_ptr<const DepthMap> map) {
    return {.file = std::move(file),
            .caption = sentence + ": " + key_of(*map),
            .surfaces = {},
            .slide = {},
            .sampling = Sampling::depth_from_projector,
            .shadow = Shadow{std::move(map), {}}};
}

// The mesh under the walk-through's slide, on a floor that its axis meets at the target. The floor reaches behind the
// camera.
std::vector<Surface> mesh_on_floor(const texgen::Projector& projector, const Mesh& mesh) {
    return {projected(projector, parallelogram({-32, -4, 30}, {60, 0, 0}, {0, 0, -60}, 6), in_place, plaster),
            projected(projector, mesh, placed({-2.2, -4, -0.2}, 25, 0.62), porcelain)};
}

const Eye beside_walk_through{{1.2, 2.6, 9.2}, {-1.85, -3.75, 0.3}, 39};
const Eye near_mesh{{0.4, 0.6, 6.2}, {-2.1, -3.0, 0.0}, 34};

// The walk-through's scene, by any lens.
Scene mesh_under_slide(const Setting& setting, const LensChoice& lens, View view, const char* title) {
    view.slide = setting.slide;
    view.surfaces =
        mesh_on_floor(projector_of(lens, *setting.slide, walk_through_aim, walk_through_depth), setting.mesh);
    return {.name = view.file.substr(0, view.file.find('.')),
            .title = title,
            .camera = camera(beside_walk_through, setting.aspect),
            .shading = Shading::slide_as_light,
            .light = light_of(lens, walk_through_aim),
            .region = texgen::whole_texture(),
            .views = {std::move(view)}};
}

Scene shadows(const Setting& setting) {
    const texgen::Projector projector =
        projector_of(setting.lens, *setting.slide, walk_through_aim, walk_through_depth);
    const std::vector<Surface> surfaces = mesh_on_floor(projector, setting.mesh);
    const auto map = seen_from(projector, walk_through_aim, *setting.slide, surfaces);
    const std::span<const glm::vec4> floor = surfaces.front().strq;
    const auto corner = [&](std::size_t i) {
        return texgen::WindowVertex{{}, 1, floor[surfaces.front().mesh.triangles.front()[i]]};
    };
    const double of_floor = climb({corner(0), corner(1), corner(2)}, *map);
    const auto view = [&](const char* file, const char* caption, std::optional<double> constant_bias) {
        return View{.file = file,
                    .caption = caption,
                    .surfaces = surfaces,
                    .slide = setting.slide,
                    .shadow = Shadow{map, constant_bias}};
    };
    return {
        .name = "shadow",
        .title = "Shadows by r",
        .camera = camera(near_mesh, setting.aspect),
        .shading = Shading::slide_as_paint,
        .light = light_of(setting.lens, walk_through_aim),
        .region = texgen::whole_texture(),
        .views = {view("shadow.png",
                       "Lit where r is the least that the projector sees, give or take what each triangle's own plane "
                       "climbs within a texel of the map: no triangle shadows itself, and sides that face away are "
                       "dark.",
                       std::nullopt),
                  view("shadow_constant.png", "With one bias for all, as large as the floor needs,", of_floor),
                  from_projector("shadow_projector.png", "All that the projector sees, and so all that is lit", map)}};
}

// The near plane stands in the mesh, the far one on the floor.
Scene volume(const Setting& setting) {
    const texgen::Projector projector = projector_of(setting.lens, *setting.slide, walk_through_aim, {9.6, 12.2});
    std::vector<Surface> surfaces = mesh_on_floor(projector, setting.mesh);
    const auto map = seen_from(projector, walk_through_aim, *setting.slide, surfaces);
    for (Surface& edge : edges_of(projector)) surfaces.push_back(std::move(edge));
    return {
        .name = "volume",
        .title = "The volume that a projector lights",
        .camera = camera({{5.5, 0.5, 7.5}, {-1.7, -3.0, 0.5}, 34}, setting.aspect),
        .shading = Shading::slide_as_light,
        .light = light_of(setting.lens, walk_through_aim),
        .region = texgen::whole_texture().with_depth(texgen::opengl, texgen::DepthMapping::unit),
        .views = {
            {.file = "volume.png",
             .caption = "The region has the depth of the projector: what is before the near plane or beyond the "
                        "far one is dark.",
             .surfaces = std::move(surfaces),
             .slide = setting.slide},
            from_projector("volume_projector.png", "The projector sees what its near plane leaves of the mesh", map)}};
}

// Small triangles in the far corner of a large window, where plane equations in float lose the most.
Scene lost(const Setting& setting) {
    const std::vector<Surface> surfaces =
        mesh_on_floor(projector_of(setting.lens, *setting.slide, walk_through_aim), setting.dense);
    const auto view = [&](const char* file, const std::string& caption, Coordinates coordinates, Sampling sampling) {
        return View{.file = file,
                    .caption = caption,
                    .surfaces = surfaces,
                    .slide = setting.slide,
                    .coordinates = coordinates,
                    .sampling = sampling};
    };
    return {
        .name = "lost",
        .title = "What is lost, and what is kept: small triangles at the far corner of a window of 4096",
        .camera = camera(near_mesh, setting.aspect),
        .shading = Shading::slide_as_light,
        .light = light_of(setting.lens, walk_through_aim),
        .region = texgen::whole_texture(),
        .corner = {3072, 3072},
        .views = {view("lost_kept.png",
                       "By texgen, a part of the picture pixel for pixel; the mesh has " +
                           std::to_string(setting.dense.triangles.size()) + " triangles.",
                       Coordinates::library, Sampling::nearest),
                  view("lost.png",
                       "By plane equations in float: where a triangle has few fragments the slide falls apart into "
                       "noise.",
                       Coordinates::float_planes, Sampling::nearest),
                  view("lost_kept_error.png",
                       "The error of texgen: dark blue wherever the slide falls, about 1e-4 texel of 4096.",
                       Coordinates::library, Sampling::error_as_colour),
                  view("lost_error.png",
                       "The error of plane equations in float: blue up to 1e-4 texel of 4096, white at 1/30, red from "
                       "10 texels on.",
                       Coordinates::float_planes, Sampling::error_as_colour)}};
}

// A trapezoid of the window, w = 1, with the q that makes it a rectangle seen in perspective.
Surface trapezoid(double aspect) {
    const double narrow = 0.35, wide = 0.9, high = 0.8, half_width = std::min(1.0, 1.0 / aspect);
    const std::array<glm::dvec2, 4> corners{{{-wide, -high}, {wide, -high}, {narrow, high}, {-narrow, high}}};
    const std::array<glm::vec4, 4> strq = texgen::quadrilateral(corners).value();
    Surface surface{
        .mesh = {}, .world_from_object = in_place, .strq = {strq.begin(), strq.end()}, .colour = glm::vec3(1)};
    for (const glm::dvec2& corner : corners) {
        surface.mesh.positions.emplace_back(half_width * corner.x, half_width * aspect * corner.y, 0.0);
        surface.mesh.normals.emplace_back(0, 0, 1);
    }
    surface.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return surface;
}

Scene qcoord(const std::shared_ptr<const Picture>& slide, double aspect) {
    const Surface projective = trapezoid(aspect);
    Surface real = projective;
    for (glm::vec4& strq : real.strq) strq /= strq.w;
    return {.name = "trapezoid",
            .title = "A trapezoid: divide at each fragment, not at the corners",
            .camera = {glm::dmat4(1.0), glm::dvec3(0, 0, 1)},
            .shading = Shading::slide_alone,
            .light = glm::vec4(0, 0, 1, 0),
            .region = texgen::whole_texture(),
            .views = {
                {.file = "trapezoid.png",
                 .caption = "By the q of quadrilateral(), divided at each fragment, the slide looks like a board that "
                            "leans back, and every "
                            "straight line of it is straight.",
                 .surfaces = {projective},
                 .slide = slide},
                {.file = "trapezoid_real.png",
                 .caption = "Divided at the corners already, which is wrong: each triangle has an affine image of its "
                            "own, and lines have a crease along the diagonal.",
                 .surfaces = {real},
                 .slide = slide}}};
}

// A projector that stands beside its wall. What it throws there becomes a rectangle where the slide is warped the other
// way.
Scene keystone(const std::shared_ptr<const Picture>& slide, double aspect) {
    const texgen::Aim aim{.position = {-1.9, 2.0, 2.5}, .target = {0.5, 2.0, 0}, .up = {0, 1, 0}};
    const texgen::Projector projector = projector_of({.extent = 37}, *slide, aim, {1, 20});
    const texgen::WorldTexgen as_it_is = texgen::texture_from_world(projector);
    const double half_height = 0.9 * relative_height(*slide), half_width = half_height * slide->width / slide->height;
    std::array<glm::dvec2, 4> corners{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
    for (glm::dvec2& corner : corners) {
        const glm::dvec4 on_wall(aim.target + glm::dvec3(half_width * corner.x, half_height * corner.y, 0), 1);
        const glm::dvec4 strq = as_it_is.matrix() * on_wall;
        corner = glm::dvec2(strq) / strq.w;
    }
    const glm::dmat4 corrected = texgen::keystone(corners).value().matrix() * as_it_is.matrix();
    const auto surfaces = [&](const glm::dmat4& texture_from_world) {
        const texgen::ObjectTexgen texgen(texture_from_world);
        return std::vector<Surface>{
            projected(texgen, parallelogram({-7, -0.5f, 0}, {14, 0, 0}, {0, 6.5f, 0}, 4), in_place, plaster),
            projected(texgen, parallelogram({-7, -0.5f, 20}, {14, 0, 0}, {0, 0, -20}, 4), in_place, plaster),
            body_of(aim, -0.5)};
    };
    return {
        .name = "keystone",
        .title = "From the side, corrected",
        .camera = camera({{0, 1.9, 9.6}, {0, 1.9, 0}, 36}, aspect),
        .shading = Shading::slide_as_light,
        .light = glm::vec4(aim.position, 1),
        .region = texgen::whole_texture(),
        .views = {{.file = "keystone.png",
                   .caption = "A projector that stands at the left of its wall throws an upright rectangle: "
                              "keystone of that rectangle's corners is part of its matrix.",
                   .surfaces = surfaces(corrected),
                   .slide = slide},
                  {.file = "keystone_missing.png",
                   .caption = "Without it the slide is larger where the wall is farther away.",
                   .surfaces = surfaces(as_it_is.matrix()),
                   .slide = slide},
                  {.file = "keystone_projector.png",
                   .caption = "The first picture from where the projector is: what it has to throw, in its own window.",
                   .surfaces = surfaces(corrected),
                   .slide = slide,
                   .camera = Camera{projector.matrix().matrix(), aim.position}}}};
}

// A projector between two walls that stand open towards the camera: one before it, one behind it.
Scene reverse(const std::shared_ptr<const Picture>& slide, double aspect) {
    const texgen::Aim aim{.position = {0, 1.8, 0}, .target = {-5, 2.2, 0}, .up = {0, 1, 0}};
    const texgen::Projector projector = projector_of({.extent = 40}, *slide, aim, {2.5, 7});
    const auto wall = [&](float side) {
        return projected(projector, parallelogram({5.0f * side, -0.5f, 3.5f}, {-2.6f * side, 0, -7}, {0, 5.0f, 0}, 2),
                         in_place, plaster);
    };
    std::vector<Surface> surfaces{
        projected(projector, parallelogram({-7, -0.5f, 20}, {14, 0, 0}, {0, 0, -40}, 4), in_place, plaster), wall(-1),
        wall(1)};
    surfaces.push_back(body_of(aim, -0.5));
    return {.name = "reverse",
            .title = "Behind the projector",
            .camera = camera({{0, 4.0, 13.5}, {0, 1.6, 0}, 46}, aspect),
            .shading = Shading::slide_as_light,
            .light = glm::vec4(aim.position, 1),
            .region = texgen::whole_texture(),
            .views = {
                {.file = "reverse.png",
                 .caption = "A projector between two walls, aimed at the left one: the wall at its back has q < 0 and "
                            "stays dark.",
                 .surfaces = surfaces,
                 .slide = slide},
                {.file = "reverse_uncured.png",
                 .caption = "Without the test of q the wall behind the projector gets the slide too, upside down.",
                 .surfaces = surfaces,
                 .slide = slide,
                 .coordinates = Coordinates::ignoring_sign_of_q},
                from_projector("reverse_projector.png",
                               "The projector sees the wall before it, and nothing of the one at its back",
                               seen_from(projector, aim, *slide, surfaces))}};
}

// The texture modulates the surface everywhere, so what confines the slide is the texture's own white border.
Scene white_border(const Setting& setting) {
    const std::vector<Surface> surfaces =
        mesh_on_floor(projector_of(setting.lens, *setting.slide, walk_through_aim), setting.mesh);
    return {.name = "border",
            .title = "A white border",
            .camera = camera(beside_walk_through, setting.aspect),
            .shading = Shading::modulate,
            .light = light_of(setting.lens, walk_through_aim),
            // The border's texels reach as far as the clamp does, so the coordinates are needed far outside the slide.
            .region = texgen::atlas_tile({-1000, -1000}, {1000, 1000}),
            .views = {{.file = "border.png",
                       .caption = "The texture multiplies the colour of the surface and is clamped to its edge, whose "
                                  "texels are white: outside the slide nothing changes.",
                       .surfaces = surfaces,
                       .slide = std::make_shared<const Picture>(with_white_border(*setting.slide, 2))},
                      {.file = "border_missing.png",
                       .caption = "Without the border the clamp draws the slide's edge out over the floor.",
                       .surfaces = surfaces,
                       .slide = setting.slide}}};
}

// The projector stands at the far end of a floor and looks at the camera: where the camera sees the floor from near,
// the slide is spread over many pixels a texel, and where it sees it from far, many texels fall on a pixel.
Scene facing(double aspect) {
    const auto slide = std::make_shared<const Picture>(fine_slide());
    const texgen::Aim aim{.position = {0.8, 2.2, -9}, .target = {-0.1, 0, -2.4}, .up = {0, -1, 0}};
    const texgen::Projector projector = projector_of({.extent = 34}, *slide, aim, {3, 14});
    const std::vector<Surface> surfaces{
        projected(projector, parallelogram({-12, 0, 2.5f}, {24, 0, 0}, {0, 0, -10.5f}, 1), in_place, plaster)};
    const Camera eye = camera({{0.3, 2.4, 5.0}, {-0.1, 0, -2.6}, 22}, aspect);
    double score = 0.0;
    for (const DrawnTriangle& triangle : rasterize(surfaces, eye, 512, 512).triangles)
        score = std::max(score, texgen::headlights(triangle.window));
    const auto view = [&](const char* file, const std::string& caption, Sampling sampling) {
        return View{.file = file, .caption = caption, .surfaces = surfaces, .slide = slide, .sampling = sampling};
    };
    return {
        .name = "facing",
        .title = "A projector that faces the camera: what filters need to know",
        .camera = eye,
        .shading = Shading::slide_alone,
        .light = glm::vec4(aim.position, 1),
        .region = texgen::whole_texture(),
        .views = {
            view("facing_nearest.png",
                 "The nearest texel, a part of the picture pixel for pixel: the print falls apart.", Sampling::nearest),
            view("facing_trilinear.png",
                 "Trilinear, of the footprint's level: no noise, and the far print is blurred away.",
                 Sampling::trilinear),
            view("facing_anisotropic.png",
                 "Anisotropic, up to 16 probes along the footprint's major axis: more of the print is kept.",
                 Sampling::anisotropic),
            view(
                "facing_level.png",
                "The level of detail: blue where a texel covers many pixels, white at one, yellow where many fall on a "
                "pixel, and a line at each whole level; the projector adds " +
                    formatted("%.1f", score) + " levels to the camera's.",
                Sampling::level_as_colour),
            view("facing_anisotropy.png",
                 "The anisotropy: the longer a pixel's footprint is than wide, the lighter, with a line at each power "
                 "of "
                 "two.",
                 Sampling::anisotropy_as_colour),
            from_projector("facing_projector.png", "The projector, upside down, sees the floor towards the camera",
                           seen_from(projector, aim, *slide, surfaces))}};
}

}  // namespace

std::vector<Scene> make_scenes(const Setting& setting) {
    const View first{.file = "teapot.png",
                     .caption =
                         "A slide falls on a mesh and on the floor, upright and unmirrored on both; nothing casts a "
                         "shadow, so the floor behind the mesh has its part of it too.",
                     .surfaces = {},
                     .slide = {}};
    const View parallel{.file = "orthographic.png",
                        .caption =
                            "Parallel rays: q is 1 at every vertex, and the slide's checks are of one size on the "
                            "floor; what makes the far ones smaller is the camera.",
                        .surfaces = {},
                        .slide = {}};
    const LensChoice rays{.is_orthographic = true, .extent = 5.2};
    Scene under_rays = mesh_under_slide(setting, rays, parallel, "Parallel rays");
    under_rays.views.push_back(
        from_projector("orthographic_projector.png", "The projector sees what is far as large as what is near",
                       seen_from(projector_of(rays, *setting.slide, walk_through_aim, walk_through_depth),
                                 walk_through_aim, *setting.slide, under_rays.views.front().surfaces)));
    return {mesh_under_slide(setting, setting.lens, first, "A mesh and a floor under a slide"),
            shadows(setting),
            volume(setting),
            lost(setting),
            qcoord(setting.slide, setting.aspect),
            keystone(setting.slide, setting.aspect),
            reverse(setting.slide, setting.aspect),
            std::move(under_rays),
            facing(setting.aspect),
            white_border(setting)};
}

}  // namespace report
