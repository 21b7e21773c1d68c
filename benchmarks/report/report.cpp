// The report: renders the scenes with the library, checks every fragment against the reference, and sets run time and
// error beside the loops that others write.

#include <charconv>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#if __has_include(<unistd.h>)
#include <unistd.h>
#endif

#include "compare.hpp"
#include "costs.hpp"
#include "failure.hpp"
#include "files.hpp"
#include "page.hpp"
#include "render.hpp"
#include "room.hpp"
#include "scenes.hpp"
#include "timings.hpp"
#include "worst_times.hpp"

namespace report {

namespace {

namespace fs = std::filesystem;

constexpr int smallest_side = 16;
constexpr int largest_side = 4096;

constexpr const char* usage =
    "usage: texgen_report [--mesh FILE.obj] [--slide FILE.png|.jpg] [--size WxH] [--out DIR] [--costs FILE]\n"
    "                     [--worst FILE] [--timings FILE.json]...\n"
    "\n"
    "Renders texgen's scenes, checks every fragment against the reference, and writes pictures and index.html.\n"
    "\n"
    "  --mesh FILE   a Wavefront OBJ file instead of the teapot; it is scaled to the teapot's size, y up\n"
    "  --slide FILE  a PNG or JPEG picture instead of the built-in slide\n"
    "  --size WxH    the size of the pictures, 16 to 4096 a side (default: 1024x1024)\n"
    "  --out DIR     the folder of the report (default: report)\n"
    "  --costs FILE  what costs.cmake wrote: what it costs to compile the headers and calls\n"
    "  --worst FILE  what texgen_worst wrote: the worst input found for each function\n"
    "  --timings FILE  what texgen_bench_o2, then what texgen_bench_native wrote with --benchmark_out\n"
    "  --help        this text\n"
    "\n"
    "Exit status: 0; 1 where the library broke a promise; 2 for a bad option, input or folder.\n";

struct Options {
    std::optional<fs::path> mesh, slide;
    int width = 1024, height = 1024;
    fs::path out = "report";
    std::optional<std::string> costs, worst;
    std::vector<std::string> timings;
    bool help = false;
};

int parse_side(std::string_view text, std::string_view size) {
    int value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value < smallest_side || value > largest_side)
        throw Failure{"bad size '" + std::string(size) + "': wanted WxH, each from 16 to 4096"};
    return value;
}

Options parse(const std::vector<std::string_view>& arguments) {
    Options options;
    for (std::size_t i = 0; i < arguments.size(); ++i) {
        const std::string_view option = arguments[i];
        if (option == "--help") {
            options.help = true;
            continue;
        }
        if (option != "--mesh" && option != "--slide" && option != "--size" && option != "--out" &&
            option != "--costs" && option != "--worst" && option != "--timings")
            throw Failure{"unknown option '" + std::string(option) + "'; --help lists them"};
        if (++i == arguments.size() || arguments[i].empty()) throw Failure{std::string(option) + " needs a value"};
        const std::string_view value = arguments[i];
        if (option == "--mesh") options.mesh = value;
        if (option == "--slide") options.slide = value;
        if (option == "--out") options.out = value;
        if (option == "--costs") options.costs = value;
        if (option == "--worst") options.worst = value;
        if (option == "--timings") options.timings.emplace_back(value);
        if (option == "--size") {
            const std::size_t x = value.find('x');
            options.width = parse_side(value.substr(0, x), value);
            options.height = parse_side(x == std::string_view::npos ? "" : value.substr(x + 1), value);
        }
    }
    return options;
}

// One line on stderr that is written over, once the program has run for a second, and only where somebody watches.
class Progress {
public:
    ~Progress() {
        if (is_shown_) std::fputs("\r\033[K", stderr);
    }

    void show(const std::string& what) {
        if (!is_watched() || std::chrono::steady_clock::now() - start_ < std::chrono::seconds(1)) return;
        std::fprintf(stderr, "\r\033[K%s", what.c_str());
        std::fflush(stderr);
        is_shown_ = true;
    }

private:
    static bool is_watched() {
#if __has_include(<unistd.h>)
        return isatty(STDERR_FILENO) != 0;
#else
        return false;
#endif
    }

    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    bool is_shown_ = false;
};

std::string processor() {
    std::ifstream info("/proc/cpuinfo");
    for (std::string line; std::getline(info, line);)
        if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
    return "unknown";
}

Report make_report(const Options& options, const Mesh& mesh, const Picture& slide) {
    Progress progress;
    Report report{.circumstances = {{"compiler", TEXGEN_REPORT_COMPILER},
                                    {"flags", TEXGEN_REPORT_FLAGS},
                                    {"processor", processor()},
                                    {"mesh", options.mesh ? options.mesh->filename().string() : "Newell's teapot"},
                                    {"slide", options.slide ? options.slide->filename().string() : "built in"},
                                    {"size", std::to_string(options.width) + "x" + std::to_string(options.height)}},
                  .scenes = {}};
    const double aspect = static_cast<double>(options.width) / options.height;
    for (const Scene& scene : make_scenes(mesh, slide, aspect)) {
        SceneReport result{.name = scene.name, .title = scene.title, .comparison = {}, .pictures = {}};
        for (const View& view : scene.views) {
            progress.show("rendering " + view.file);
            result.pictures.push_back(
                {view.file, view.caption, encode_png(render(scene, view, options.width, options.height))});
        }
        progress.show("measuring " + scene.name);
        result.comparison =
            compare(rasterize(scene.views.front().surfaces, scene.camera, options.width, options.height), scene.region);
        report.scenes.push_back(std::move(result));
    }
    return report;
}

// The plot as SVG, from a script that draws into name.svg; empty where there is no gnuplot. Run inside the folder, so
// that no path needs quoting.
std::string draw_plot(const Staging& staging, const std::string& name, const std::string& script) {
    const fs::path svg = staging.folder() / (name + ".svg");
    staging.write(name + ".gp", script);
    const fs::path before = fs::current_path();
    fs::current_path(staging.folder());
    const int status = std::system(("gnuplot " + name + ".gp >gnuplot.log 2>&1").c_str());
    fs::current_path(before);
    std::error_code ignored;
    fs::remove(staging.folder() / "gnuplot.log", ignored);
    if (status == 0 && fs::exists(svg)) return read_file(svg);
    fs::remove(svg, ignored);
    return {};
}

int run(const Options& options) {
    // Everything that can be wrong with the input is found before anything is written.
    const Mesh mesh = options.mesh ? load_obj(*options.mesh) : teapot(12);
    const Picture slide = options.slide ? load_picture(*options.slide) : built_in_slide();
    std::vector<Timings> timings;
    for (const std::string& file : options.timings) timings.push_back(read_timings(file));
    const std::vector<Cost> costs = options.costs ? read_costs(*options.costs) : std::vector<Cost>();
    const std::vector<WorstTime> worst = options.worst ? read_worst_times(*options.worst) : std::vector<WorstTime>();
    static_cast<void>(Staging(options.out));

    const Report report = make_report(options, mesh, slide);
    const RoomReport room = make_room(slide, options.width, options.height);

    const Staging staging(options.out);
    const std::string name = "time_against_error";
    const std::string plot = draw_plot(staging, name, plot_of(report, name + ".svg"));
    std::vector<TimingsPlot> plots;
    if (!plot.empty()) plots = plots_of(timings);
    for (TimingsPlot& drawn : plots) drawn.svg = draw_plot(staging, drawn.name, drawn.script);
    for (const SceneReport& scene : report.scenes)
        for (const PictureOfScene& picture : scene.pictures) staging.write(picture.file, picture.png);
    const std::string room_png = encode_png(room.picture), work_png = encode_png(room.work_picture);
    staging.write("room.png", room_png);
    staging.write("room_work.png", work_png);
    staging.write("index.html", html_of(report, plot,
                                        html_of(timings, plots) + html_of(worst) + html_of(costs) +
                                            html_of(room, room_png, work_png)));
    staging.publish();

    std::fputs(
        (text_of(report) + "\n" + text_of(room) + "\n" + text_of(timings) + text_of(worst) + text_of(costs)).c_str(),
        stdout);
    if (plot.empty()) std::puts("\nno plot: gnuplot is missing or failed");
    std::printf("\nwritten to %s\n", (options.out / "index.html").string().c_str());
    for (const SceneReport& scene : report.scenes) {
        if (scene.comparison.is_as_promised()) continue;
        std::fprintf(stderr, "texgen_report: the library broke its promise in %s\n", scene.name.c_str());
        return 1;
    }
    if (!room.is_same_picture()) {
        std::fputs("texgen_report: what was skipped in the room changed its picture\n", stderr);
        return 1;
    }
    return 0;
}

// One line, whatever a file is called.
int fail(std::string message) {
    for (char& c : message)
        if (static_cast<unsigned char>(c) < ' ') c = '?';
    std::fprintf(stderr, "texgen_report: %s\n", message.c_str());
    return 2;
}

}  // namespace

}  // namespace report

int main(int count, char** arguments) {
    try {
        const report::Options options = report::parse({arguments + 1, arguments + count});
        if (!options.help) return report::run(options);
        std::fputs(report::usage, stdout);
        return 0;
    } catch (const report::Failure& failure) {
        return report::fail(failure.message);
    } catch (const std::exception& exception) {
        return report::fail(exception.what());
    }
}
