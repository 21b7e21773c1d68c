#include "chart.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "html.hpp"

namespace report {

namespace {

constexpr double left = 58, right = 8, top = 8, bottom = 44, width = 560, height = 330;

// A logarithmic axis from the decade, or the half or fifth of one, below the least value to the one above the largest.
class Axis {
public:
    Axis(const std::vector<Series>& series, int dimension, double from, double to) : from_(from), to_(to) {
        double least = HUGE_VAL, most = 0;
        for (const Series& s : series) {
            for (const glm::dvec2& point : s.points) {
                least = std::min(least, point[dimension]);
                most = std::max(most, point[dimension]);
            }
        }
        const bool is_short = most < 300 * least;
        for (double decade = std::pow(10, std::floor(std::log10(least))); decade < 12 * most; decade *= 10)
            for (const double step : {1.0, 2.0, 5.0})
                if (step == 1.0 || is_short) ticks_.push_back(step * decade);
        while (ticks_.size() > 2 && ticks_[1] <= least) ticks_.erase(ticks_.begin());
        while (ticks_.size() > 2 && 1.01 * ticks_[ticks_.size() - 2] >= most) ticks_.pop_back();
    }

    const std::vector<double>& ticks() const { return ticks_; }
    double operator()(double value) const {
        return from_ + (to_ - from_) * std::log(value / ticks_.front()) / std::log(ticks_.back() / ticks_.front());
    }

private:
    double from_, to_;
    std::vector<double> ticks_;
};

std::string tick_label(double value) {
    if (value > 0.009 && value < 900) return formatted("%.3g", value);
    return "10<tspan dy=\"-5\" font-size=\"10\">" + formatted("%.0f", std::log10(value)) + "</tspan>";
}

std::string swatch(const Series& series) {
    const char* colour = colour_of(series.name);
    const char* shape = series.mark == Series::Mark::line
                            ? "<path d=\"M0 7h22\" stroke=\"%s\" stroke-width=\"3\" fill=\"none\"/>"
                        : series.mark == Series::Mark::ring
                            ? "<circle cx=\"11\" cy=\"7\" r=\"5\" stroke=\"%s\" stroke-width=\"2\" fill=\"none\"/>"
                            : "<circle cx=\"11\" cy=\"7\" r=\"6\" fill=\"%s\"/>";
    return "<svg class=\"swatch\" viewBox=\"0 0 22 14\">" + formatted(shape, colour) + "</svg>";
}

std::string drawn(const Series& series, const Axis& x, const Axis& y) {
    const char* colour = colour_of(series.name);
    std::string svg;
    if (series.mark == Series::Mark::line) {
        svg += "<polyline fill=\"none\" stroke-width=\"2\" stroke=\"" + std::string(colour) + "\" points=\"";
        for (const glm::dvec2& point : series.points) svg += formatted("%.1f,%.1f ", x(point.x), y(point.y));
        svg += "\"/>";
    }
    const bool is_ring = series.mark == Series::Mark::ring;
    const double radius = series.mark == Series::Mark::line ? 3.5 : 6;
    for (const glm::dvec2& point : series.points)
        svg +=
            formatted("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"%g\" fill=\"%s\" stroke=\"%s\" stroke-width=\"%g\"><title>",
                      x(point.x), y(point.y), radius, is_ring ? "none" : colour, is_ring ? colour : "#fff",
                      is_ring ? 2.5 : 1.0) +
            escaped(series.name) + formatted(": %.4g, %.3g</title></circle>\n", point.x, point.y);
    return svg;
}

}  // namespace

const char* colour_of(std::string_view series) {
    constexpr std::pair<std::string_view, const char*> colours[] = {{"texgen, exact", "#0059b3"},
                                                                    {"texgen, 1/512 texel", "#35a3e8"},
                                                                    {"texgen, 1/16 texel", "#12a58c"},
                                                                    {"texgen, 1 texel of 256", "#7ac943"},
                                                                    {"texgen, T_o", "#35a3e8"},
                                                                    {"texgen", "#0059b3"},
                                                                    {"positions in the world", "#e6a100"},
                                                                    {"GLM, barycentric", "#e6a100"},
                                                                    {"GLM", "#d1491b"},
                                                                    {"Eigen", "#b05cc0"},
                                                                    {"floor", "#222222"}};
    for (const auto& [name, colour] : colours)
        if (series.find(name) != series.npos) return colour;
    return "#9a9aa5";
}

std::string chart_of(const std::vector<Series>& series, const std::string& x_label, const std::string& y_label,
                     const std::string& caption) {
    const Axis x(series, 0, left, width - right), y(series, 1, height - bottom, top);
    std::string svg = formatted("<svg viewBox=\"0 0 %g %g\" role=\"img\">", width, height);
    svg += "<g stroke=\"#dde0e8\">";
    for (const double tick : x.ticks()) svg += formatted("<path d=\"M%.1f %gV%g\"/>", x(tick), top, height - bottom);
    for (const double tick : y.ticks()) svg += formatted("<path d=\"M%g %.1fH%g\"/>", left, y(tick), width - right);
    svg += "</g>\n<g text-anchor=\"middle\">";
    for (const double tick : x.ticks())
        svg += formatted("<text x=\"%.1f\" y=\"%g\">", std::min(x(tick), width - 20), height - bottom + 18) +
               tick_label(tick) + "</text>";
    svg += formatted("<text x=\"%g\" y=\"%g\">", (left + width - right) / 2, height - 6) + escaped(x_label) + "</text>";
    svg += formatted("<text transform=\"translate(14 %g) rotate(-90)\">", (top + height - bottom) / 2) +
           escaped(y_label) + "</text></g>\n<g text-anchor=\"end\">";
    for (const double tick : y.ticks())
        svg += formatted("<text x=\"%g\" y=\"%.1f\">", left - 6, std::max(y(tick) + 4, top + 8)) + tick_label(tick) +
               "</text>";
    svg += "</g>\n";
    std::string legend, named;
    for (const Series& s : series) {
        svg += drawn(s, x, y);
        if (named.find("|" + s.name + "|") != named.npos) continue;
        named += "|" + s.name + "|";
        legend += "<span>" + swatch(s) + escaped(s.name) + "</span> ";
    }
    return "<figure class=\"chart\">" + svg + "</svg>\n<p class=\"legend\">" + legend + "</p>\n<figcaption>" +
           escaped(caption) + "</figcaption></figure>\n";
}

std::string bars_of(const std::vector<Bar>& bars, const std::string& caption) {
    double most = 0;
    for (const Bar& bar : bars) most = std::max(most, bar.nanoseconds);
    std::string html = "<figure class=\"chart\">\n";
    for (const Bar& bar : bars)
        html += "<div class=\"bar\"><span>" + escaped(bar.name) + "</span><span>" +
                formatted("<i style=\"width:%.1f%%;background:%s\"></i>", 75 * bar.nanoseconds / most,
                          colour_of(bar.name)) +
                duration(bar.nanoseconds) + "</span></div>\n";
    return html + "<figcaption>" + escaped(caption) + "</figcaption></figure>\n";
}

}  // namespace report
