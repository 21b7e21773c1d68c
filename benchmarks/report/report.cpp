// The report: renders the scenes with the library, checks every fragment against the reference, and sets run time and
// error beside the loops that others write.

#include <charconv>
#include <chrono>
#include <cstdio>
#include <exception>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#if __has_include(<unistd.h>)
#include <unistd.h>
#endif

#include "../printed.hpp"
#include "compare.hpp"
#include "costs.hpp"
#include "distances.hpp"
#include "failure.hpp"
#include "files.hpp"
#include "html.hpp"
#include "page.hpp"
#include "readme_table.hpp"
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
constexpr int most_rounds = 21;

constexpr const char* usage =
    "usage: %s [OPTION VALUE]...\n"
    "\n"
    "Renders texgen's scenes, checks every fragment against the reference, and writes pictures and index.html.\n"
    "\n"
    "  --mesh FILE     a Wavefront OBJ file instead of the teapot; it is scaled to the teapot's size, y up\n"
    "  --slide FILE    a PNG or JPEG picture instead of the built-in slide\n"
    "  --lens LENS     of the projector above the mesh: perspective:DEGREES, from 1 to 150, or orthographic:WIDTH, "
    "from\n"
    "                  0.1 to 100, of the slide's longer side; the mesh is 4 wide (default: perspective:30)\n"
    "  --size WxH      the size of the pictures, 16 to 4096 a side (default: 1024x1024)\n"
    "  --rounds N      how often the loops take turns, 1 to 21; the median counts (default: 21)\n"
    "  --out DIR       the folder of the report (default: report)\n"
    "  --timings FILE  what texgen_bench_o2, then what texgen_bench_native wrote with --benchmark_out; may be "
    "repeated;\n"
    "                  of two the rows of the README's table become times.md\n"
    "  --others FILE   what texgen_bench_avx2 or texgen_bench_clang wrote, for the table of speeds promised; may be "
    "repeated\n"
    "  --worst FILE    what texgen_worst wrote: the worst input found for each function\n"
    "  --costs FILE    what costs.cmake wrote: what it costs to compile the headers and calls\n"
    "  --help          this text\n"
    "\n"
    "Exit status: 0; 1 where the library broke a promise; 2 for a bad option, input or folder: then nothing is "
    "written.\n"
    "\n"
    "Example:\n"
    "  printf 'v -1 0 1\\nv 1 0 1\\nv 0 0 -1\\nv 0 2 0\\nf 1 2 4\\nf 2 3 4\\nf 3 1 4\\n' >pyramid.obj\n"
    "  %s --mesh pyramid.obj --lens perspective:20 --size 256x256 --out pyramid\n";

struct Options {
    std::optional<fs::path> mesh, slide;
    LensChoice lens;
    int width = 1024, height = 1024;
    int rounds = most_rounds;
    fs::path out = "report";
    std::optional<std::string> costs, worst;
    std::vector<std::string> timings, others;
    bool help = false;
};

std::optional<int> parse_integer(std::string_view text, int least, int most) {
    int value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool is_whole = error == std::errc() && end == text.data() + text.size();
    return is_whole && value >= least && value <= most ? std::optional(value) : std::nullopt;
}

int parse_rounds(std::string_view text) {
    const std::optional<int> rounds = parse_integer(text, 1, most_rounds);
    if (!rounds) throw Failure{"bad number of rounds '" + std::string(text) + "': wanted 1 to 21"};
    return *rounds;
}

int parse_side(std::string_view text, std::string_view size) {
    const std::optional<int> side = parse_integer(text, smallest_side, largest_side);
    if (!side) throw Failure{"bad size '" + std::string(size) + "': wanted WxH, each from 16 to 4096"};
    return *side;
}

LensChoice parse_lens(std::string_view text) {
    const std::size_t colon = text.find(':');
    const std::string_view kind = text.substr(0, colon);
    const bool is_orthographic = kind == "orthographic";
    const std::optional<double> extent =
        number_of(colon == std::string_view::npos ? "" : std::string(text.substr(colon + 1)));
    const auto [least, most] = is_orthographic ? std::pair(0.1, 100.0) : std::pair(1.0, 150.0);
    if ((!is_orthographic && kind != "perspective") || !extent || *extent < least || *extent > most)
        throw Failure{"bad lens '" + std::string(text) +
                      "': wanted perspective:DEGREES, from 1 to 150, or orthographic:WIDTH, from 0.1 to 100"};
    return {is_orthographic, *extent};
}

Options parse(const std::vector<std::string_view>& arguments) {
    Options options;
    for (std::size_t i = 0; i < arguments.size(); ++i) {
        const std::string_view option = arguments[i];
        if (option == "--help") {
            options.help = true;
            continue;
        }
        if (option != "--mesh" && option != "--slide" && option != "--lens" && option != "--size" &&
            option != "--rounds" && option != "--out" && option != "--costs" && option != "--worst" &&
            option != "--timings" && option != "--others")
            throw Failure{"unknown option '" + std::string(option) + "'; --help lists them"};
        if (++i == arguments.size() || arguments[i].empty()) throw Failure{std::string(option) + " needs a value"};
        const std::string_view value = arguments[i];
        if (option == "--mesh") options.mesh = value;
        if (option == "--slide") options.slide = value;
        if (option == "--lens") options.lens = parse_lens(value);
        if (option == "--rounds") options.rounds = parse_rounds(value);
        if (option == "--out") options.out = value;
        if (option == "--costs") options.costs = value;
        if (option == "--worst") options.worst = value;
        if (option == "--timings") options.timings.emplace_back(value);
        if (option == "--others") options.others.emplace_back(value);
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

    explicit Progress(std::size_t steps) : steps_(steps) {}

    void show(const std::string& what) {
        ++step_;
        if (!is_watched() || std::chrono::steady_clock::now() - start_ < std::chrono::seconds(1)) return;
        std::fprintf(stderr, "\r\033[K%zu of %zu: %s", step_, steps_, what.c_str());
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
    std::size_t steps_, step_ = 0;
    bool is_shown_ = false;
};

std::string processor() {
    std::ifstream info("/proc/cpuinfo");
    for (std::string line; std::getline(info, line);)
        if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
    return "unknown";
}

// How much of a picture the page needs, which has 400 pixels for one, and more for the first.
enum class InPage { first, reduced, thinned, part };

// Filters are shown pixel for pixel, in a part that is neither near nor far.
InPage in_page(Sampling sampling) {
    switch (sampling) {
        case Sampling::nearest:
        case Sampling::trilinear:
        case Sampling::anisotropic:
            return InPage::part;
        case Sampling::level_as_colour:
        case Sampling::anisotropy_as_colour:
            return InPage::thinned;
        case Sampling::error_as_colour:
        case Sampling::depth_from_projector:
        case Sampling::bilinear:
            break;
    }
    return InPage::reduced;
}

Picture embedded(const Picture& picture, InPage in_page) {
    switch (in_page) {
        case InPage::first:
            return reduced(picture, 512);
        case InPage::thinned:
            return thinned(picture, 400);
        case InPage::part:
            return cropped(picture, picture.width * 3 / 8, picture.height * 17 / 64, 344, 256);
        case InPage::reduced:
            break;
    }
    return reduced(picture, 400);
}

PictureOfScene shown(const std::string& file, const std::string& caption, const Picture& picture, InPage in_page) {
    const Picture small = embedded(picture, in_page);
    const std::string png = encode_png(small), jpeg = encode_jpeg(small);
    return {file, caption, encode_png(picture), png.size() < jpeg.size() ? png : jpeg};
}

// What a bias that is the same for all triangles costs.
std::string in_words(const ShadowCount& count) {
    if (count.lost == 0) return " nothing is dark that is lit in the picture before.";
    return formatted(
        " steeper triangles shadow themselves and one another: %.1f%% of what is lit in the picture before is dark.",
        100.0 * static_cast<double>(count.lost) / static_cast<double>(count.lit));
}

Report make_report(const Options& options, const Setting& setting) {
    const std::vector<Scene> scenes = make_scenes(setting);
    std::size_t steps = scenes.size() + 3;
    for (const Scene& scene : scenes) steps += scene.views.size();
    Progress progress(steps);
    Report report{.circumstances = {{"compiler", TEXGEN_REPORT_COMPILER},
                                    {"flags", TEXGEN_REPORT_FLAGS},
                                    {"processor", processor()},
                                    {"mesh", options.mesh ? options.mesh->filename().string() : "Newell's teapot"},
                                    {"slide", options.slide ? options.slide->filename().string() : "built in"},
                                    {"size", std::to_string(options.width) + "x" + std::to_string(options.height)}},
                  .scenes = {},
                  .room = {},
                  .room_pictures = {},
                  .times_by_size = {},
                  .errors_by_distance = {},
                  .timings = {},
                  .other_timings = {},
                  .worst = {},
                  .costs = {}};
    for (const Scene& scene : scenes) {
        SceneReport result{.name = scene.name, .title = scene.title, .comparison = {}, .pictures = {}};
        const Workload work = rasterize(scene.views.front().surfaces, scene.camera, options.width, options.height);
        for (const View& view : scene.views) {
            progress.show("rendering " + view.file);
            const bool is_first = &view == &scenes.front().views.front();
            std::string caption = view.caption;
            if (view.shadow && view.sampling == Sampling::bilinear) {
                const ShadowCount count = count_shadows(*view.shadow, work, scene.region);
                if (view.shadow->constant_bias)
                    caption += in_words(count);
                else
                    result.shadowed_by_themselves += count.by_themselves;
            }
            result.pictures.push_back(shown(view.file, caption, render(scene, view, options.width, options.height),
                                            is_first ? InPage::first : in_page(view.sampling)));
        }
        progress.show("measuring " + scene.name);
        result.comparison = compare(moved(work, scene.corner), scene.region, options.rounds);
        report.scenes.push_back(std::move(result));
    }
    progress.show("lighting the room");
    report.room = make_room(*setting.slide, options.width, options.height);
    report.room_pictures = {
        shown("room.png", "A projector lights what its slide falls on; nothing casts shadows.", report.room.picture,
              InPage::reduced),
        shown("room_work.png",
              "The dearest work that a projector asks of each rectangle, for 1/512 texel of 4096: " +
                  report.room.key_of_work() + ".",
              report.room.work_picture, InPage::thinned),
        shown("room_reach.png", "The same light, ended at the far planes of the projectors by with_depth().",
              report.room.reach_picture, InPage::reduced)};
    progress.show("measuring triangles of all sizes");
    report.times_by_size = times_by_size(options.rounds);
    progress.show("measuring errors far from the origin");
    report.errors_by_distance = errors_by_distance();
    return report;
}

void check_printed() {
    if (!is_printed()) throw Failure{"cannot write to standard output"};
}

int run(const Options& options) {
    // Everything that can be wrong with the input is found before anything is written.
    const Mesh mesh = options.mesh ? load_obj(*options.mesh) : teapot(12);
    const Setting setting{
        .mesh = mesh,
        .dense = options.mesh ? mesh : teapot(64),
        .slide = std::make_shared<const Picture>(options.slide ? load_picture(*options.slide) : built_in_slide()),
        .lens = options.lens,
        .aspect = static_cast<double>(options.width) / options.height};
    std::vector<Timings> timings, others;
    for (const std::string& file : options.timings) timings.push_back(read_timings(file));
    for (const std::string& file : options.others) others.push_back(read_timings(file));
    std::vector<Cost> costs;
    if (options.costs) costs = read_costs(*options.costs);
    std::vector<WorstTime> worst;
    if (options.worst) worst = read_worst_times(*options.worst);
    static_cast<void>(Staging(options.out));

    Report report = make_report(options, setting);
    report.timings = std::move(timings);
    report.other_timings = std::move(others);
    report.worst = std::move(worst);
    report.costs = std::move(costs);

    const Staging staging(options.out);
    for (const SceneReport& scene : report.scenes)
        for (const PictureOfScene& picture : scene.pictures) staging.write(picture.file, picture.png);
    for (const PictureOfScene& picture : report.room_pictures) staging.write(picture.file, picture.png);
    const std::string page = with_charts_drawn(html_of(report), Staging(options.out));
    staging.write("index.html", page);
    if (const std::string table = readme_table_of(report); !table.empty()) staging.write("times.md", table);
    staging.check_names();

    std::fputs(text_of(report).c_str(), stdout);
    if (page.find(no_chart) != page.npos) std::printf("\n%s\n", no_chart);
    check_printed();
    staging.publish();
    std::printf("\nwritten to %s\n", (options.out / "index.html").string().c_str());
    check_printed();
    for (const SceneReport& scene : report.scenes) {
        if (scene.comparison.is_as_promised() && scene.shadowed_by_themselves == 0) continue;
        std::fprintf(stderr, "texgen_report: the library broke its promise in %s\n", scene.name.c_str());
        return 1;
    }
    if (!report.room.is_same_picture()) {
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
        std::printf(report::usage, arguments[0], arguments[0]);
        report::check_printed();
        return 0;
    } catch (const report::Failure& failure) {
        return report::fail(failure.message);
    } catch (const std::exception& exception) {
        return report::fail(exception.what());
    }
}
