// Meshes and slides of the user's: refused, or taken.

#include <doctest/doctest.h>

#include <string>

#include "workplace.hpp"

namespace {

using report_test::contents;
using report_test::Outcome;
using report_test::png_header;
using report_test::png_signature;
using report_test::triangle;
using report_test::Workplace;
using report_test::write;

}  // namespace

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
