#pragma once

// Small pieces of text and HTML.

#include <array>
#include <cstdio>
#include <string>
#include <string_view>

namespace report {

template <class... Values>
std::string formatted(const char* format, Values... values) {
    std::array<char, 512> buffer;
    std::snprintf(buffer.data(), buffer.size(), format, values...);
    return buffer.data();
}

// An error with three digits.
std::string number(double value);

std::string escaped(std::string_view text);

// A figure with the SVG inside; nothing for an empty one.
std::string figure(std::string_view svg, const std::string& name, const std::string& caption);

std::string base64(std::string_view bytes);

}  // namespace report
