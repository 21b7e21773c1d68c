// The report program from outside: what it says, what it leaves behind, and what it returns.

#include <doctest/doctest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

std::string contents(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
}

const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

void write(const fs::path& file, const std::string& bytes) { std::ofstream(file, std::ios::binary) << bytes; }

struct Outcome {
    int status;
    std::string output, error;
};

// An empty folder, the working directory of the program while it lives.
class Workplace {
public:
    Workplace() : before_(fs::current_path()), folder_(before_ / "report_test_files") {
        fs::remove_all(folder_);
        fs::create_directory(folder_);
        fs::current_path(folder_);
    }
    ~Workplace() {
        fs::current_path(before_);
        fs::remove_all(folder_);
    }
    Workplace(const Workplace&) = delete;
    Workplace& operator=(const Workplace&) = delete;

    Outcome run(const std::string& arguments, const std::string& environment = "") const {
        const fs::path output = before_ / "report_test_output", error = before_ / "report_test_error";
        const int status = std::system((environment + " '" TEXGEN_REPORT_PROGRAM "' " + arguments + " >'" +
                                        output.string() + "' 2>'" + error.string() + "'")
                                           .c_str());
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, contents(output), contents(error)};
    }

    // Of one triangle and few pixels, where the pictures are not what is asked for.
    Outcome run_on_little(const std::string& arguments, const std::string& environment = "") const {
        const fs::path mesh = before_ / "report_test_mesh.obj";
        write(mesh, triangle + "f 1 2 3\n");
        return run("--rounds 1 --size 16x16 --mesh '" + mesh.string() + "' " + arguments, environment);
    }

    std::vector<std::string> files() const {
        std::vector<std::string> names;
        for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder_))
            names.push_back(entry.path().lexically_relative(folder_).string());
        std::ranges::sort(names);
        return names;
    }

    void check_refusal(const std::string& arguments, const std::string& reason) const {
        CAPTURE(arguments);
        const std::vector<std::string> before = files();
        const Outcome outcome = run(arguments);
        CAPTURE(outcome.error);
        CHECK(outcome.status == 2);
        CHECK(outcome.output == "");
        CHECK(std::ranges::count(outcome.error, '\n') == 1);
        CHECK(outcome.error.ends_with('\n'));
        CHECK(outcome.error.find(reason) != std::string::npos);
        CHECK(files() == before);
    }

private:
    fs::path before_, folder_;
};

const std::string png_signature = "\x89PNG\r\n\x1a\n";

// A PNG that ends after its header.
std::string png_header(const std::string& width, const std::string& height) {
    using namespace std::string_literals;
    return png_signature + "\0\0\0\rIHDR"s + width + height + "\x08\x02\0\0\0\0\0\0\0"s;
}

// A row as Google Benchmark writes it.
std::string timing_of(const std::string& scene, const std::string& variant, const std::string& nanoseconds) {
    return "{\n\"run_name\": \"" + scene + " > " + variant +
           "\",\n\"aggregate_name\": \"median\",\n\"cpu_time\": " + nanoseconds +
           ",\n\"elements\": 1,\n\"row\": 0,\n\"texels\": 1e-3,\n\"ulp\": 2\n},\n";
}

bool has_gnuplot() { return std::system("command -v gnuplot >/dev/null") == 0; }

}  // namespace

TEST_CASE("a bad option is refused in one line") {
    const Workplace place;
    place.check_refusal("--colour red", "--colour");
    place.check_refusal("teapot.obj", "teapot.obj");
    for (const char* option : {"--mesh", "--slide", "--lens", "--size", "--rounds", "--out", "--costs", "--worst",
                               "--timings", "--others"}) {
        place.check_refusal(option, option);
        place.check_refusal(option + std::string(" ''"), option);
    }
    for (const char* size : {"64", "x", "64x", "x64", "15x64", "64x4097", "-64x64", "64x64x64", "64,64", "1e3x64",
                             "99999999999999999999x64"})
        place.check_refusal(std::string("--size ") + size, size);
    for (const char* rounds : {"0", "22", "-1", "1.5", "many", "99999999999"})
        place.check_refusal(std::string("--rounds ") + rounds, rounds);
    for (const char* lens : {"30", "perspective", "perspective:", "perspective:0", "perspective:151",
                             "perspective:wide", "orthographic:-1", "orthographic:1000", "fisheye:30"})
        place.check_refusal(std::string("--lens ") + lens, lens);
}

TEST_CASE("a mesh that cannot be used is refused in one line") {
    const Workplace place;
    place.check_refusal("--mesh missing.obj", "missing.obj");
    place.check_refusal("--mesh .", "not a regular file");
    place.check_refusal("--mesh \"$(printf 'two\\nlines.obj')\"", "two?lines.obj");
    const auto check = [&](const std::string& text, const std::string& reason) {
        write("mesh.obj", text);
        place.check_refusal("--rounds 1 --size 16x16 --mesh mesh.obj", reason);
    };
    check("", "no faces");
    check(triangle, "no faces");
    check(triangle + "f 1 2\n", "no faces");
    check(triangle + "f 1 2 4\n", "out of range");
    check(triangle + "f 0 1 2\n", "out of range");
    check(triangle + "f -1 -2 -4\n", "out of range");
    check(triangle + "f 1 2 99999999999\n", "out of range");
    check(triangle + "f one two three\n", "out of range");
    check(triangle + "vn 0 0 1\nf 1//1 2//1 3//2\n", "out of range");
    check(triangle + "f 1 1 1\nf 1 2 2\n", "no area");
    check("v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "line 1");
    check("v 0 0 0\nv inf 0 0\nv 0 1 0\nf 1 2 3\n", "line 2");
    check("v 0 0 0\nv 1 0 0\nv 0 1\nf 1 2 3\n", "line 3");
    check("v 0 \\\n0 0\nv 1 0 0\nv inf 0 0\nf 1 2 3\n", "line 4");
    check("v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n", "one point");
    check(std::string("\x7f"
                      "ELF\0\0\xff\xfe\0v\0f",
                      12),
          "no faces");
}

TEST_CASE("a slide that cannot be used is refused in one line") {
    using namespace std::string_literals;
    const Workplace place;
    REQUIRE(place.run_on_little("--out good").status == 0);
    const std::string good = contents("good/teapot.png");
    place.check_refusal("--slide missing.png", "missing.png");
    const auto check = [&](const std::string& bytes) {
        write("slide.png", bytes);
        place.check_refusal("--rounds 1 --size 16x16 --slide slide.png", "slide.png");
    };
    check("");
    check("not a picture");
    check(png_signature);
    check(good.substr(0, good.size() / 2));
    check(good.substr(0, good.size() - 1));
    check(png_header("\0\0\0\0"s, "\0\0\0\1"s));
    check(png_header("\x7f\xff\xff\xff", "\x7f\xff\xff\xff"));
    check(png_header("\0\0\x75\x30"s, "\0\0\x75\x30"s));
    check("\xff\xd8\xff"s);
    check("\xff\xd8\xff\xc4\x10\x02\x00"s + std::string(16, '\xff') + std::string(4080, '\0'));
}

TEST_CASE("timings that are none are refused in one line") {
    const Workplace place;
    place.check_refusal("--timings missing.json", "missing.json");
    for (const char* text : {"", "{}", "not JSON", "{\n\"run_name\": \"a > b\",\n\"aggregate_name\": \"median\"\n}\n",
                             "\"\": \": \"", "\n}\n{\n\"cpu_time\": nan,\n}"}) {
        write("timings.json", text);
        place.check_refusal("--timings timings.json", "timings.json");
        place.check_refusal("--others timings.json", "timings.json");
    }
}

TEST_CASE("timings become the page's tables and charts, which say where others are faster") {
    const Workplace place;
    write("timings.json", timing_of("K9, 1024", "texgen, <exact>", "1.25") + timing_of("K9, 1024", "GLM, loop", "2.5") +
                              timing_of("project planar, 1024", "texgen, 1/512 texel of 4096", "3") +
                              timing_of("project planar, 1024", "GLM, mat4 * vec4", "2"));
    CHECK(place.run_on_little("--timings timings.json").status == 0);
    const std::string page = contents("report/index.html");
    CHECK(page.find("<td>texgen, &lt;exact&gt;</td><td>1.250</td><td>2.00</td>") != std::string::npos);
    CHECK(page.find("<h3>Points</h3>") != std::string::npos);
    CHECK(page.find("<h3>Bodies</h3>") == std::string::npos);
    CHECK(page.find("1.50 times the time of GLM, mat4 * vec4") < page.find("<h2>"));
    CHECK(page.find("<b>not the fastest</b>") != std::string::npos);
    CHECK(page.find(has_gnuplot() ? "<title>GLM, mat4 * vec4</title>" : "No chart") != std::string::npos);

    write("timings.json", timing_of("project planar, 1024", "texgen, exact", "0.75") +
                              timing_of("project planar, 1024", "GLM, mat4 * vec4", "16.25"));
    CHECK(!fs::exists("report/times.md"));
    CHECK(place.run_on_little("--timings timings.json --timings timings.json").status == 0);
    const std::string table = contents("report/times.md");
    CHECK(table.find("| points, planar | 0.75 / 0.75, 1.0e-3 | | 16.2 / 16.2, 1.0e-3 | |\n") != std::string::npos);
    CHECK(table.find("| a segment | | | | |\n") != std::string::npos);
}

TEST_CASE("a speed that was promised of a build is judged by that build, the first two of all rows or another") {
    const Workplace place;
    const char* scene = "rows, 1024x4, q/w by 30";
    const auto rows_of = [&](const std::string& compiler, const std::string& flags, const char* nanoseconds) {
        return "\"compiler\": \"" + compiler + "\",\n\"flags\": \"" + flags + "\",\n" +
               timing_of(scene, "texgen, 1/512 texel of 4096", nanoseconds) +
               timing_of(scene, "GLM, plane equations", "1") + timing_of(scene, "GLM, barycentric", "4");
    };
    write("o2.json", rows_of("GNU 12", "-O2", "0.1"));
    write("native.json", rows_of("GNU 12", "-O3 -march=native", "0.5"));
    write("avx2.json", rows_of("GNU 12", "-O3 -mavx2 -mfma", "0.25"));
    write("clang.json", rows_of("Clang 14", "-O3 -march=native", "0.8"));
    const std::string two = "--timings o2.json --timings native.json";
    const auto judges = [](const std::string& page, const std::string& flags, const char* asked, const char* measured,
                           const char* answer) {
        return page.find("<td>" + flags + "</td><td>" + asked + "x</td><td>" + measured + "x</td><td></td><td>" +
                         answer + "</td>") != std::string::npos;
    };
    REQUIRE(place.run_on_little(two + " --others clang.json --others avx2.json").status == 0);
    std::string page = contents("report/index.html");
    CHECK(judges(page, "-O2", "42", "40", "no"));
    CHECK(judges(page, "-O3 -march=native", "3", "2", "no"));
    CHECK(judges(page, "-O3 -mavx2 -mfma", "2", "4", "yes"));
    CHECK(judges(page, "clang++ -O3 -march=native", "2.4", "1.25", "no"));

    REQUIRE(place.run_on_little(two).status == 0);
    page = contents("report/index.html");
    CHECK(judges(page, "-O3 -march=native", "3", "2", "no"));
    CHECK(page.find("clang++") == std::string::npos);
    CHECK(page.find("-mavx2") == std::string::npos);
}

TEST_CASE("without gnuplot, and with one that fails, the page says so in the place of its charts and is complete") {
    const Workplace place;
    write("gnuplot", "#!/bin/sh\necho '<svg'\nexit 1\n");
    fs::permissions("gnuplot", fs::perms::owner_all);
    for (const std::string path : {"/nowhere", "."}) {
        const Outcome outcome = place.run_on_little("", "PATH=" + path);
        CHECK(outcome.status == 0);
        const std::string page = contents("report/index.html");
        CHECK(page.find("No chart: gnuplot is missing or failed.") != std::string::npos);
        CHECK(page.find("<svg") == std::string::npos);
        CHECK(page.ends_with("</html>\n"));
        CHECK(outcome.output.find("No chart: gnuplot is missing or failed.") != std::string::npos);
    }
}

TEST_CASE("names of timings are text to gnuplot, and nothing that it executes") {
    const Workplace place;
    write("timings.json", timing_of("project planar, 1024", "texgen, `touch one`' . system('touch two') #", "3") +
                              timing_of("project planar, 1024", "GLM, {/=99 @mat4} \\", "2"));
    CHECK(place.run_on_little("--timings timings.json").status == 0);
    CHECK((contents("report/index.html").find("No chart") == std::string::npos) == has_gnuplot());
    for (const std::string& file : place.files()) CHECK((file.starts_with("report") || file == "timings.json"));
}

TEST_CASE("costs that are none are refused in one line") {
    const Workplace place;
    place.check_refusal("--costs missing.txt", "missing.txt");
    for (const char* text : {"not costs", "GLM||1|2", "GLM||1|2|3|4", "|GLM|1|2|3", "GLM|||2|3", "GLM||0|2|3",
                             "GLM||-1|2|3", "GLM||1|two|3", "GLM||nan|2|3", "GLM||1|2|3\n\n"}) {
        write("costs.txt", text);
        place.check_refusal("--costs costs.txt", "costs.txt");
    }
}

TEST_CASE("costs become a table of the terminal and of the page, none become nothing") {
    const Workplace place;
    write("costs.txt",
          "GLM's "
          "headers||200|800|0\nclip.hpp||300|900|\nclip_<near>()|clip.hpp|550|10900|7000\nodd()|nowhere.hpp|50|1|1\n");
    const Outcome outcome = place.run_on_little("--costs costs.txt");
    CHECK(outcome.status == 0);
    CHECK(outcome.output.find("1.50x GLM") != std::string::npos);
    CHECK(contents("report/index.html")
              .find("<td>clip_&lt;near&gt;()</td><td>0.55</td><td>+0.25 s</td><td>10.0</td><td>7.0</td>") !=
          std::string::npos);
    write("costs.txt", "");
    CHECK(place.run_on_little("--costs costs.txt").status == 0);
    CHECK(contents("report/index.html").find("costs to compile") == std::string::npos);
}

TEST_CASE("worst times that are none are refused in one line") {
    const Workplace place;
    place.check_refusal("--worst missing.txt", "missing.txt");
    for (const char* text : {"", "not times", "f|x|1|2", "f|x|1|2|3|4", "|x|1|2|3", "f|x||2|3", "f|x|0|2|3",
                             "f|x|1|-2|3", "f|x|1|two|3", "f|x|nan|2|3", "f|x|1|2|3\n\n"}) {
        write("worst.txt", text);
        place.check_refusal("--worst worst.txt", "worst.txt");
    }
}

TEST_CASE("worst times become a table of the terminal and of the page that says which limits are met") {
    const Workplace place;
    write("worst.txt", "divide|<any>|2|9|8\nproject|ties everywhere|2|17|8\n");
    const Outcome outcome = place.run_on_little("--worst worst.txt");
    CHECK(outcome.status == 0);
    CHECK(outcome.output.find("8.5      8  NOT MET  ties everywhere") != std::string::npos);
    const std::string page = contents("report/index.html");
    CHECK(page.find("1 of 2 are within their limits") != std::string::npos);
    CHECK(page.find("<td>divide</td><td>2.0</td><td>9.0</td><td>4.5</td><td>8</td><td>yes</td><td>&lt;any&gt;</td>") !=
          std::string::npos);
    CHECK(page.find("<td>project</td><td>2.0</td><td>17.0</td><td>8.5</td><td>8</td><td>no</td>") != std::string::npos);
}

TEST_CASE("a folder that cannot be written is refused in one line, and an old report survives") {
    const Workplace place;
    write("file", "mine");
    place.check_refusal("--rounds 1 --size 16x16 --out file", "not a folder");
    place.check_refusal("--rounds 1 --size 16x16 --out file/below", "not a folder");
    place.check_refusal("--rounds 1 --size 16x16 --out /dev/null/below", "not a folder");
    place.check_refusal("--rounds 1 --size 16x16 --out /proc/below", "/proc/below");
    place.check_refusal("--rounds 1 --size 16x16 --out deep/" + std::string(300, 'd'), "ddd");
    place.check_refusal("--rounds 1 --size 16x16 --out /", "root of the file system");
    place.check_refusal("--rounds 1 --size 16x16 --out /tmp/..", "root of the file system");
    fs::create_symlink("/", "slash");
    place.check_refusal("--rounds 1 --size 16x16 --out slash/", "root of the file system");
    fs::create_symlink("nowhere", "dangling");
    fs::create_symlink("circle", "circle");
    place.check_refusal("--rounds 1 --size 16x16 --out dangling", "dangling");
    place.check_refusal("--rounds 1 --size 16x16 --out circle/below", "circle");
    fs::create_directories("old/teapot.png");
    write("old/index.html", "yesterday");
    place.check_refusal("--rounds 1 --size 16x16 --out old", "teapot.png");
    place.check_refusal("--rounds 1 --size 16x16 --out old --mesh missing.obj", "missing.obj");
    CHECK(contents("old/index.html") == "yesterday");
    CHECK(contents("file") == "mine");
}

TEST_CASE("what cannot be printed is said, and nothing is written") {
    const Workplace place;
    if (!fs::exists("/dev/full")) return;
    for (const std::string arguments : {"--help", "--rounds 1 --size 16x16"}) {
        CAPTURE(arguments);
        const int status =
            std::system(("'" TEXGEN_REPORT_PROGRAM "' " + arguments + " >/dev/full 2>../report_test_error").c_str());
        CHECK(WEXITSTATUS(status) == 2);
        CHECK(contents("../report_test_error") == "texgen_report: cannot write to standard output\n");
        CHECK(place.files().empty());
    }
}

TEST_CASE("a run writes the page and the pictures, and nothing else") {
    const Workplace place;
    const Outcome outcome = place.run("--size 64x48 --out deep/down");
    CHECK(outcome.status == 0);
    CHECK(outcome.error == "");
    CHECK(outcome.output.find("texgen, exact") != std::string::npos);
    CHECK(outcome.output.find("64x48") != std::string::npos);
    CHECK(outcome.output.find("the same") != std::string::npos);
    CHECK(outcome.output.find("differs") == std::string::npos);

    std::vector<std::string> pictures;
    for (const std::string& file : place.files()) {
        const fs::path path(file);
        if (path.extension() != ".png") continue;
        pictures.push_back(path.filename().string());
        CHECK(contents(path).starts_with(png_signature));
    }
    CHECK(pictures == std::vector<std::string>{"border.png",
                                               "border_missing.png",
                                               "facing_anisotropic.png",
                                               "facing_anisotropy.png",
                                               "facing_level.png",
                                               "facing_nearest.png",
                                               "facing_projector.png",
                                               "facing_trilinear.png",
                                               "keystone.png",
                                               "keystone_missing.png",
                                               "keystone_projector.png",
                                               "lost.png",
                                               "lost_error.png",
                                               "lost_kept.png",
                                               "lost_kept_error.png",
                                               "orthographic.png",
                                               "orthographic_projector.png",
                                               "reverse.png",
                                               "reverse_projector.png",
                                               "reverse_uncured.png",
                                               "room.png",
                                               "room_reach.png",
                                               "room_work.png",
                                               "shadow.png",
                                               "shadow_constant.png",
                                               "shadow_projector.png",
                                               "teapot.png",
                                               "trapezoid.png",
                                               "trapezoid_real.png",
                                               "volume.png",
                                               "volume_projector.png"});
    const std::string page = contents("deep/down/index.html");
    CHECK(page.ends_with("</html>\n"));
    CHECK(page.size() < 1'000'000);
    CHECK(page.find("data:image/") < page.find("<h2>"));
    CHECK(page.find("src=\"http") == std::string::npos);
    for (const std::string& file : place.files()) CHECK(file.find("/.") == std::string::npos);
}

TEST_CASE("a run replaces an old report and leaves other files alone") {
    const Workplace place;
    fs::create_directory("mine");
    write("mine/index.html", "yesterday");
    write("mine/letter.txt", "dear reader");
    CHECK(place.run_on_little("--out mine").status == 0);
    CHECK(contents("mine/index.html").starts_with("<!DOCTYPE html>"));
    CHECK(contents("mine/letter.txt") == "dear reader");
}

TEST_CASE("a run takes a mesh and a slide of the user's") {
    const Workplace place;
    REQUIRE(place.run("--rounds 1 --size 16x16 --out first").status == 0);
    write("mesh.obj", "# relative indices, a quadrilateral that goes on in further lines, and a face with normals\n" +
                          triangle +
                          "v 1 1 0.5\r\nvn 0 0 1\nf -4 -3 \\\r\n-1 \\\n-2\nf 1//1 2//1 3//1\n# C:\\\nf 1 2 3\n");
    const Outcome outcome = place.run("--rounds 1 --size 32x32 --mesh mesh.obj --slide first/reverse.png");
    CHECK(outcome.status == 0);
    CHECK(outcome.error == "");
    CHECK(contents("report/index.html").find("mesh.obj") != std::string::npos);
    CHECK(contents("report/index.html").find("reverse.png") != std::string::npos);
}

TEST_CASE("a mesh of Windows and a slide of one pixel are taken, and the other kinds of files are refused by name") {
    const Workplace place;
    write("mesh.obj", "\xef\xbb\xbfv 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3\r\n");
    using namespace std::string_literals;
    write("pixel.png", png_header("\0\0\0\1"s, "\0\0\0\1"s) + "\0\0\0\x0cIDAT"s +
                           "\x78\x9c\x63\x68\x68\x68\0\0\3\x04\1\x81"s + "\x4b\xd3\xd2\x10"s + "\0\0\0\0IEND"s +
                           "\xae\x42\x60\x82"s);
    const Outcome outcome = place.run("--rounds 1 --size 16x16 --mesh mesh.obj --slide pixel.png");
    CHECK(outcome.status == 0);
    CHECK(outcome.error == "");
    place.check_refusal("--mesh /dev/zero", "not a regular file");
    place.check_refusal("--slide /dev/zero", "not a regular file");
    place.check_refusal("--slide .", "not a regular file");
}

TEST_CASE("whoever watches a terminal sees the progress, and a clear line after it") {
    const Workplace place;
    if (std::system("script -qec true /dev/null >/dev/null 2>&1") != 0) return;  // no pseudo-terminal can be had
    // Nothing is said in the first second, in which a quick machine renders small pictures.
    std::string watched;
    for (int size = 16; size <= 1024 && watched.find(": rendering ") == std::string::npos; size *= 4) {
        const std::string sizes = std::to_string(size) + "x" + std::to_string(size);
        const std::string command =
            "script -qec \"'" TEXGEN_REPORT_PROGRAM "' --rounds 1 --size " + sizes + "\" /dev/null >watched";
        REQUIRE(std::system(command.c_str()) == 0);
        watched = contents("watched");
    }
    CHECK(watched.find(": rendering ") != std::string::npos);
    CHECK(watched.find(": measuring errors far from the origin") != std::string::npos);
    const std::size_t last = watched.rfind("\r\033[K");
    REQUIRE(last != std::string::npos);
    CHECK(watched.find("written to", last) != std::string::npos);
}

TEST_CASE("a lens of the user's changes the picture") {
    const Workplace place;
    REQUIRE(place.run_on_little("--out wide").status == 0);
    REQUIRE(place.run_on_little("--out narrow --lens perspective:8").status == 0);
    REQUIRE(place.run_on_little("--out parallel --lens orthographic:5.2").status == 0);
    CHECK(contents("wide/teapot.png") != contents("narrow/teapot.png"));
    CHECK(contents("parallel/teapot.png") == contents("wide/orthographic.png"));
}

TEST_CASE("in a browser the page fits a desk and a telephone, folded or not") {
    const Workplace place;
    const std::string find = "$(command -v chromium || command -v chromium-browser || command -v google-chrome)";
    if (std::system(("test -n \"" + find + "\"").c_str()) != 0) {
        MESSAGE("no browser looks at the page");
        return;
    }
    std::string timings = "\"flags\": \"-O3 -march=native\",\n";
    for (const char* scene : {"project planar, 1024", "rows, 1024x4, q/w by 1.3"})
        timings +=
            timing_of(scene, "texgen, 1/512 texel of 4096", "0.25") + timing_of(scene, "GLM, mat4 * vec4", "0.125");
    write("timings.json", timings);
    REQUIRE(place.run("--rounds 1 --size 256x256 --timings timings.json --timings timings.json").status == 0);
    for (const std::string width : {"400", "1280"}) {
        write("frame.html",
              "<body><script>function look(frame) {\n"
              "const page = frame.contentDocument, faults = [], width = page.documentElement.clientWidth;\n"
              "const top = page.images[0].getBoundingClientRect().top;\n"
              "if (top > 400) faults.push('the first picture is at ' + top);\n"
              "page.querySelectorAll('details').forEach(details => details.open = true);\n"
              "if (page.documentElement.scrollWidth > width) faults.push('the page scrolls');\n"
              "for (const image of page.images) if (!image.naturalWidth) faults.push('an empty picture');\n"
              "for (const element of page.querySelectorAll('body *')) {\n"
              "  const box = element.getBoundingClientRect(), around = element.parentElement.closest('.wide, svg');\n"
              "  const limit = around ? around.getBoundingClientRect() : {left: 0, right: width, bottom: 1e9};\n"
              "  const scrolls = around && around.className == 'wide';\n"
              "  if (box.width && !scrolls && (box.left < limit.left - 1 || box.right > limit.right + 1 ||\n"
              "      box.bottom > limit.bottom + 1)) faults.push(element.tagName + element.textContent.slice(0, 40));\n"
              "}\n"
              "document.body.dataset.faults = faults.join('; ') || 'none';\n"
              "}</script><iframe height=900 width=" +
                  width + " onload='look(this)' src=report/index.html></iframe></body>");
        CHECK(
            std::system(
                (find + " --headless --no-sandbox --disable-gpu --allow-file-access-from-files --user-data-dir=browser "
                        "--dump-dom \"file://$PWD/frame.html\" >seen.html 2>browser.log")
                    .c_str()) == 0);
        const std::string seen = contents("seen.html");
        CAPTURE(seen);
        CHECK(seen.find("data-faults=\"none\"") != std::string::npos);
    }
}

TEST_CASE("the example of --help works as written") {
    const Workplace place;
    const std::string help = place.run("--help").output;
    const std::string example = help.substr(help.find("Example:\n") + 9);
    CHECK(std::system(("(" + example + ") >output 2>error").c_str()) == 0);
    CHECK(contents("error") == "");
    CHECK(contents("pyramid/index.html").ends_with("</html>\n"));
}

TEST_CASE("--help says how, and writes nothing") {
    const Workplace place;
    const Outcome outcome = place.run("--help");
    CHECK(outcome.status == 0);
    CHECK(outcome.error == "");
    for (const char* option :
         {"--mesh", "--slide", "--lens", "--size", "--rounds", "--out", "--costs", "--worst", "--timings", "--others"})
        CHECK(outcome.output.find(option) != std::string::npos);
    CHECK(place.files().empty());
}
