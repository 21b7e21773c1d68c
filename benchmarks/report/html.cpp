#include "html.hpp"

#include <algorithm>
#include <cstddef>

namespace report {

std::string number(double value) {
    return value >= 1e30 ? "not a number" : formatted(value != 0 && value < 0.01 ? "%.1e" : "%.3g", value);
}

std::string escaped(std::string_view text) {
    std::string result;
    for (const char c : text) {
        if (c == '<')
            result += "&lt;";
        else if (c == '>')
            result += "&gt;";
        else if (c == '&')
            result += "&amp;";
        else if (c == '"')
            result += "&quot;";
        else
            result += c;
    }
    return result;
}

std::string unbroken(std::string_view option) {
    std::string html;
    for (const char c : option) html += c == '-' ? "&#8209;" : escaped(std::string_view(&c, 1));
    return html;
}

std::string duration(double nanoseconds) {
    return nanoseconds < 1e3   ? formatted("%.3g ns", nanoseconds)
           : nanoseconds < 1e6 ? formatted("%.3g \u00b5s", nanoseconds / 1e3)
                               : formatted("%.3g ms", nanoseconds / 1e6);
}

std::string grouped(std::size_t count) {
    std::string digits = std::to_string(count);
    for (auto i = static_cast<std::ptrdiff_t>(digits.size()) - 3; i > 0; i -= 3)
        digits.insert(static_cast<std::size_t>(i), "&#8239;");
    return digits;
}

std::string folded(const std::string& title, const std::string& html) {
    return html.empty() ? "" : "<details><summary>" + title + "</summary>\n" + html + "</details>\n";
}

std::string base64(std::string_view bytes) {
    constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string result;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const auto byte = [&](std::size_t k) {
            return i + k < bytes.size() ? static_cast<unsigned>(static_cast<unsigned char>(bytes[i + k])) : 0u;
        };
        const unsigned group = byte(0) << 16 | byte(1) << 8 | byte(2);
        const std::size_t meaningful = std::min<std::size_t>(3, bytes.size() - i) + 1;
        for (std::size_t k = 0; k < 4; ++k) result += k < meaningful ? digits[group >> (18 - 6 * k) & 63] : '=';
    }
    return result;
}

}  // namespace report
