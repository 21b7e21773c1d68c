#pragma once

// The shaders as the README has them, and changed.

#include <doctest/doctest.h>

#include <cstddef>
#include <fstream>
#include <string>
#include <vector>

namespace shaded {

enum Shader : std::size_t { vertex, slide, gradients, shadow, deferred, shader_count };

inline const std::vector<std::string>& shaders() {
    static const std::vector<std::string> blocks = [] {
        std::vector<std::string> result;
        std::ifstream readme(TEXGEN_TEST_DATA "/../README.md");
        bool is_open = false;
        for (std::string line; std::getline(readme, line);) {
            if (line == "```glsl") {
                result.emplace_back();
                is_open = true;
            } else if (line == "```") {
                is_open = false;
            } else if (is_open) {
                result.back() += line + '\n';
            }
        }
        REQUIRE(result.size() == shader_count);
        return result;
    }();
    return blocks;
}

struct Change {
    std::string from, to;
};

inline std::string changed(const std::string& source, const Change& change) {
    const std::size_t at = source.find(change.from);
    INFO(change.from);
    REQUIRE(at != std::string::npos);
    std::string result = source;
    return result.replace(at, change.from.size(), change.to);
}

}  // namespace shaded
