#include "chart.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <regex>
#include <set>
#include <utility>

#include "html.hpp"

namespace report {

namespace {

// On both sides of a script; no name has it, for a name is one line.
const std::string mark = "\n<!-- gnuplot -->\n";

// As gnuplot takes text literally.
std::string literal(const std::string& text) {
    std::string quoted(1, '\'');
    quoted += std::regex_replace(text, std::regex("'"), "''");
    return quoted += '\'';
}

std::string figure_of(double height, const std::string& script, const std::string& caption) {
    return "<figure class=\"chart\">" + mark + "reset\nset encoding utf8\n" +
           formatted("set terminal svg dynamic size 440,%g font 'sans-serif,13' linewidth 2\n", height) + script +
           mark + "<figcaption>" + escaped(caption) + "</figcaption></figure>\n";
}

// It ends a little beyond the points. Its numbers are decades and, where those are few, 2 and 5 of each: one at least.
std::string axis_of(const std::vector<Series>& series, int dimension, const std::string& title) {
    std::vector<double> values;
    for (const Series& s : series)
        for (const glm::dvec2& point : s.points) values.push_back(point[dimension]);
    const auto [least, most] = std::ranges::minmax(values);
    const double margin = std::max({1.2, std::pow(most / least, 0.05), std::sqrt(2.6 * least / most)});
    const std::string axis = dimension == 0 ? "x" : "y", digits = most < 300 * least ? "1 2 5" : "1";
    return "set " + axis + "label " + literal(title) + "\nset " + axis +
           formatted("range [%g:%g]\n", least / margin, most * margin) + "set " + axis + "tics ()\n" +
           "set for [d=-12:12] for [m in '" + digits + "'] " + axis + "tics add (label(m, d) m * 10.0**d)\n";
}

std::vector<std::string> split(const std::string& text, const std::string& separator) {
    const std::regex regex(separator);
    return {std::sregex_token_iterator(text.begin(), text.end(), regex, -1), {}};
}

// One a script; none where gnuplot is missing or fails. It runs inside the folder, so that no path needs quoting.
std::vector<std::string> drawn(const std::string& scripts, const Staging& folder) {
    folder.write("charts", scripts);
    const std::filesystem::path before = std::filesystem::current_path();
    std::filesystem::current_path(folder.folder());
    const int status = std::system("gnuplot --default-settings charts >charts.svg 2>charts.log");
    std::filesystem::current_path(before);
    if (status != 0) return {};
    // What is empty or as it would be anyway, and what shows or names the same for each.
    const std::regex needless(
        R"(<title>Gnuplot</title>|<desc>.*</desc>|<g [^>]*>\s*</g>\s*| (id|stroke-linecap|stroke-linejoin)="[^"]*")");
    const std::string svg = std::regex_replace(read_file(folder.folder() / "charts.svg"), needless, "");
    std::vector<std::string> pictures = split(svg, "</svg>");
    pictures.pop_back();  // what follows the last
    for (std::string& picture : pictures) {
        picture = picture.erase(0, picture.find("<svg")) + "</svg>";
        // The first defines the shapes of points for all.
        const std::size_t from = picture.find("<defs>"), to = picture.find("</defs>");
        if (&picture != &pictures.front() && to != picture.npos) picture.erase(from, to + 7 - from);
    }
    return pictures;
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

std::string chart_of(const std::vector<Series>& series, const std::string& x, const std::string& y,
                     const std::string& caption) {
    constexpr const char* styles[] = {"points pointtype 7", "points pointtype 6",
                                      "linespoints pointtype 7 pointsize 0.6",
                                      "linespoints pointtype 6 pointsize 0.6 dashtype 2"};
    constexpr const char* look =
        "set logscale xy\nset nomxtics\nset nomytics\nset tics scale 0 textcolor rgb '#444a55'\nset pointsize 1.2\n"
        "set xlabel offset 0,0.6\nset border 3 linewidth 0.5 linecolor rgb '#9a9aa5'\n"
        "set grid linetype 1 linewidth 0.5 linecolor rgb '#dde0e8'\n"
        "set key below height 1 left Left reverse noenhanced samplen 1 maxcols 1\n"
        "label(m, d) = m eq '1' && abs(d) > 2 ? sprintf('10^{%d}', d) : sprintf('%g', m * 10.0**d)\n";
    std::string plot = "plot ", data;
    std::set<std::string> names;
    for (const Series& s : series) {
        plot += std::string("'-' with ") + styles[static_cast<int>(s.mark)] + " linecolor rgb '" + colour_of(s.name) +
                "' title " + literal(names.insert(s.name).second ? s.name : "") + ",";
        for (const glm::dvec2& point : s.points) data += formatted("%.4g %.4g\n", point.x, point.y);
        data += "e\n";
    }
    plot.back() = '\n';
    return figure_of(300 + 19 * static_cast<double>(names.size()),
                     look + axis_of(series, 0, x) + axis_of(series, 1, y) + plot + data, caption);
}

std::string bars_of(const std::vector<Bar>& bars, const std::string& caption) {
    double most = 0, y = 0;
    std::string script = "set margins 0,0,0,0\nunset border\nunset tics\nunset key\n";
    for (const Bar& bar : bars) {
        most = std::max(most, bar.nanoseconds);
        y -= 1;
        script += "set label " + literal(bar.name) + formatted(" at 0,%g noenhanced\n", y + 0.75) + "set label " +
                  literal(duration(bar.nanoseconds)) + formatted(" at %g,%g offset 0.5\n", bar.nanoseconds, y + 0.3) +
                  formatted("set object rectangle from 0,%g to %g,%g fillcolor rgb '%s' fillstyle solid noborder\n",
                            y + 0.1, bar.nanoseconds, y + 0.5, colour_of(bar.name));
    }
    return figure_of(-38 * y, script + formatted("plot [0:%g] [%g:0] NaN\n", most / 0.8, y), caption);
}

std::string with_charts_drawn(const std::string& page, const Staging& folder) {
    const std::vector<std::string> pieces = split(page, mark);  // text and scripts by turns
    std::string scripts, html = pieces.front();
    for (std::size_t i = 1; i < pieces.size(); i += 2) scripts += pieces[i] + "\n";
    std::vector<std::string> pictures = drawn(scripts, folder);
    if (2 * pictures.size() + 1 != pieces.size())
        pictures.assign(pieces.size() / 2, std::string("<p>") + no_chart + "</p>");
    for (std::size_t i = 1; i < pieces.size(); i += 2) html += pictures[i / 2] + "\n" + pieces[i + 1];
    return html;
}

}  // namespace report
