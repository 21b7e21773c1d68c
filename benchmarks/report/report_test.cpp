// The report program from outside: what it says, what it leaves behind, and what it returns.

#include <doctest/doctest.h>
#include <sys/wait.h>

#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "report_test/workplace.hpp"

namespace {

namespace fs = std::filesystem;
using report_test::contents;
using report_test::Outcome;
using report_test::png_signature;
using report_test::Workplace;
using report_test::write;

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
