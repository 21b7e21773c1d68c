// Timings, costs and worst times: refused, or tables and charts of the page.

#include <doctest/doctest.h>

#include <filesystem>
#include <string>

#include "workplace.hpp"

namespace {

namespace fs = std::filesystem;
using report_test::contents;
using report_test::has_gnuplot;
using report_test::Outcome;
using report_test::timing_of;
using report_test::Workplace;
using report_test::write;

}  // namespace

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
