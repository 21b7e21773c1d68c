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

// Options of a compiler, which lines are not broken in.
std::string unbroken(std::string_view option);

// 0.71 ns, 3.2 us, 6 ms.
std::string duration(double nanoseconds);

// 1234567 with a thin space every three digits.
std::string grouped(std::size_t count);

// What opens by a click.
std::string folded(const std::string& title, const std::string& html);

std::string base64(std::string_view bytes);

}  // namespace report
