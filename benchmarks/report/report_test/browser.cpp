// The page as a browser lays it out.

#include <doctest/doctest.h>

#include <cstdlib>
#include <string>

#include "workplace.hpp"

namespace {

using report_test::contents;
using report_test::timing_of;
using report_test::Workplace;
using report_test::write;

}  // namespace

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
