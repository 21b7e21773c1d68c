#include "render.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include <glm/geometric.hpp>
#include <texgen/footprint.hpp>
#include <texgen/interpolate.hpp>
#include <texgen/reference.hpp>

#include "../error.hpp"
#include "../peers.hpp"
#include "filters.hpp"
#include "rasterizer.hpp"

namespace report {

namespace {

// What a program that forgets q <= 0 would do.
void divide_regardless(const texgen::Triangle& triangle, const texgen::TextureRegion& region, texgen::FragmentRect rect,
                       const texgen::Texcoords& out) {
    for (int row = 0; row < rect.height; ++row) {
        for (int column = 0; column < rect.width; ++column) {
            const auto strq = texgen::reference::strq<double>(triangle, rect.x + column + 0.5, rect.y + row + 0.5);
            const auto quotient = texgen::reference::quotient<double>(strq);
            const auto fragment = static_cast<std::size_t>(row * rect.width + column);
            out.s[fragment] = static_cast<float>(quotient[0]);
            out.t[fragment] = static_cast<float>(quotient[1]);
            const bool lit = quotient[0] >= region.min().x && quotient[0] <= region.max().x &&
                             quotient[1] >= region.min().y && quotient[1] <= region.max().y;
            out.lit[fragment] = lit ? 1.0f : 0.0f;
        }
    }
}

// What a user of GLM writes: plane equations in float.
void divide_float_planes(const texgen::Triangle& triangle, const texgen::TextureRegion& region,
                         texgen::FragmentRect rect, const texgen::Texcoords& out) {
    const GlmPlanes planes(triangle);
    planes(rect, [&](std::size_t fragment, float s, float t, float q) {
        out.s[fragment] = s;
        out.t[fragment] = t;
        const bool is_lit = q > 0.0f && s >= static_cast<float>(region.min().x) &&
                            s <= static_cast<float>(region.max().x) && t >= static_cast<float>(region.min().y) &&
                            t <= static_cast<float>(region.max().y);
        out.lit[fragment] = is_lit ? 1.0f : 0.0f;
    });
}

// The error of s or t, whichever is larger, in texels.
double error_at(const texgen::Triangle& triangle, int x, int y, float s, float t) {
    const auto exact = texgen::reference::quotient<double>(texgen::reference::strq<double>(triangle, x + 0.5, y + 0.5));
    return texture_size * finite(std::max(std::fabs(s - exact[0]), std::fabs(t - exact[1])));
}

// The footprints of one rect, row by row.
struct RectFootprints {
    std::array<float, Workload::rect_area> level, anisotropy, major_s, major_t;

    texgen::Footprints of(texgen::FragmentRect rect) {
        const std::size_t count = static_cast<std::size_t>(rect.width) * static_cast<std::size_t>(rect.height);
        return {.dsdx = {},
                .dtdx = {},
                .dsdy = {},
                .dtdy = {},
                .level = std::span(level).first(count),
                .anisotropy = std::span(anisotropy).first(count),
                .major_s = std::span(major_s).first(count),
                .major_t = std::span(major_t).first(count)};
    }
};

void darken(const ShadowTest& test, const texgen::Texcoords& out) {
    for (std::size_t i = 0; i < out.lit.size(); ++i)
        if (out.lit[i] != 0.0f && !test.is_lit(out.s[i], out.t[i], out.r[i])) out.lit[i] = 0.0f;
}

class Frame {
public:
    Frame(const Scene& scene, const View& view, const MipMap* filters, int width, int height)
        : scene_(scene),
          view_(view),
          filters_(filters),
          colour_(width, height, backdrop),
          depth_(colour_.pixels.size(), std::numeric_limits<float>::infinity()) {}

    void draw(const Workload& work) {
        for (const Workload::Job& job : work.jobs) {
            const DrawnTriangle& triangle = work.triangles[job.triangle];
            const AttributePlane plane(triangle);
            const auto setup = texgen::TriangleSetup::of(triangle.window, scene_.region);
            std::optional<texgen::FootprintSetup> footprints;
            if (setup && filters_ != nullptr)
                footprints.emplace(*setup,
                                   texgen::texels_per_unit(scene_.region, view_.slide->width, view_.slide->height));
            for (std::size_t i = job.first_rect; i < job.first_rect + job.rect_count; ++i) {
                const texgen::FragmentRect rect = work.rects[i];
                const texgen::Texcoords out = view_.shadow ? coordinates_.with_r(rect) : coordinates_.of(rect);
                if (view_.coordinates == Coordinates::ignoring_sign_of_q)
                    divide_regardless(triangle.window, scene_.region, rect, out);
                else if (view_.coordinates == Coordinates::float_planes)
                    divide_float_planes(triangle.window, scene_.region, rect, out);
                else if (setup)
                    texgen::interpolate(*setup, rect, out);
                else
                    std::ranges::fill(out.lit, 0.0f);
                if (view_.shadow) darken(ShadowTest(*view_.shadow, triangle), out);
                if (footprints) texgen::footprint(*footprints, rect, footprints_.of(rect));
                draw_rect(rect, work.coverage[i], plane, triangle);
            }
        }
    }

    const Picture& colour() const { return colour_; }

private:
    void draw_rect(texgen::FragmentRect rect, const std::array<RowSpan, Workload::rect_height>& coverage,
                   const AttributePlane& plane, const DrawnTriangle& triangle) {
        for (int row = 0; row < rect.height; ++row) {
            const auto [begin, end] = coverage[static_cast<std::size_t>(row)];
            for (int column = begin; column < end; ++column) {
                const int x = rect.x + column;
                const int y = rect.y + row;
                const int picture_x = x - scene_.corner.x;
                // The window's y grows upwards, a picture's rows go down.
                const int picture_y = colour_.height - 1 - (y - scene_.corner.y);
                float& nearest = depth_[static_cast<std::size_t>(picture_y) * static_cast<std::size_t>(colour_.width) +
                                        static_cast<std::size_t>(picture_x)];
                const float depth = plane.depth(x, y);
                if (!(depth < nearest)) continue;
                nearest = depth;
                const auto fragment = static_cast<std::size_t>(row * rect.width + column);
                if (view_.sampling == Sampling::error_as_colour && coordinates_.lit[fragment] != 0.0f)
                    colour_.at(picture_x, picture_y) = colour_of_error(
                        error_at(triangle.window, x, y, coordinates_.s[fragment], coordinates_.t[fragment]));
                else
                    colour_.at(picture_x, picture_y) = shade(plane.attributes(x, y), triangle.colour, fragment);
            }
        }
    }

    glm::vec3 shade(const Attributes& at, glm::vec3 colour, std::size_t fragment) const {
        const bool lit = coordinates_.lit[fragment] != 0.0f;
        const glm::vec3 slide = lit ? sampled(fragment) : glm::vec3(0);
        if (lit && is_false_colour()) return slide;
        if (scene_.shading == Shading::slide_alone) return lit ? slide : backdrop;

        const glm::vec3 to_camera = glm::normalize(glm::vec3(scene_.camera.position) - at.position);
        const float towards_camera = glm::dot(glm::normalize(at.normal), to_camera);
        const float headlight = std::abs(towards_camera);
        if (scene_.shading == Shading::modulate)
            return colour * (0.25f + 0.75f * headlight) * (lit ? slide : glm::vec3(1));

        const glm::vec3 normal = towards_camera < 0.0f ? -glm::normalize(at.normal) : glm::normalize(at.normal);
        const glm::vec3 to_projector = glm::normalize(glm::vec3(scene_.light) - scene_.light.w * at.position);
        const float diffuse =
            scene_.shading == Shading::slide_as_paint ? 0.8f : std::max(0.0f, glm::dot(normal, to_projector));
        return colour * (0.08f + 0.26f * headlight + 1.05f * diffuse * slide);
    }

    bool is_false_colour() const {
        return view_.sampling == Sampling::level_as_colour || view_.sampling == Sampling::anisotropy_as_colour;
    }

    glm::vec3 sampled(std::size_t fragment) const {
        const glm::vec2 st(coordinates_.s[fragment], coordinates_.t[fragment]);
        const FilterFootprint footprint{footprints_.level[fragment],
                                        footprints_.anisotropy[fragment],
                                        {footprints_.major_s[fragment], footprints_.major_t[fragment]}};
        switch (view_.sampling) {
            case Sampling::nearest:
                return filters_->nearest(st);
            case Sampling::trilinear:
                return filters_->trilinear(st, footprint.level);
            case Sampling::anisotropic:
                return filters_->anisotropic(st, footprint);
            case Sampling::level_as_colour:
                return colour_of_level(footprint.level);
            case Sampling::anisotropy_as_colour:
                return colour_of_anisotropy(footprint.anisotropy);
            case Sampling::error_as_colour:
            case Sampling::bilinear:
            case Sampling::depth_from_projector:
                break;
        }
        return view_.slide->sample(st.x, st.y);
    }

    const Scene& scene_;
    const View& view_;
    const MipMap* filters_;  // null where they are not asked for
    Picture colour_;
    std::vector<float> depth_;
    RectCoordinates coordinates_{};
    RectFootprints footprints_{};
};

}  // namespace

Picture render(const Scene& scene, const View& view, int width, int height) {
    if (view.sampling == Sampling::depth_from_projector) return picture_of(*view.shadow->map);
    const Camera& camera = view.camera ? *view.camera : scene.camera;
    if (view.sampling != Sampling::bilinear) {
        const MipMap filters(*view.slide);
        Frame frame(scene, view, &filters, width, height);
        frame.draw(moved(rasterize(view.surfaces, camera, width, height), scene.corner));
        return frame.colour();
    }
    Picture sum(width, height, glm::vec3(0));
    for (const glm::vec2 offset :
         {glm::vec2(-0.25f, -0.25f), glm::vec2(0.25f, -0.25f), glm::vec2(-0.25f, 0.25f), glm::vec2(0.25f, 0.25f)}) {
        Frame frame(scene, view, nullptr, width, height);
        frame.draw(moved(rasterize(view.surfaces, camera, width, height, offset), scene.corner));
        for (std::size_t i = 0; i < sum.pixels.size(); ++i) sum.pixels[i] += 0.25f * frame.colour().pixels[i];
    }
    return sum;
}

}  // namespace report
