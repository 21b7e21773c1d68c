#pragma once

// Reads one line of JSON at a time: objects, arrays, strings without escapes, numbers, true and false. That is what the
// files of cases hold; anything else is an error.

#include <cctype>
#include <cstdlib>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace support {

struct Json {
    std::string text;  // of a string, a number, true or false
    std::vector<Json> items;
    std::map<std::string, Json> members;

    bool has(const std::string& name) const { return members.count(name) != 0; }
    const Json& operator[](const std::string& name) const {
        const auto found = members.find(name);
        if (found == members.end()) throw std::runtime_error("no member " + name);
        return found->second;
    }
    const Json& operator[](std::size_t i) const { return items.at(i); }

    // Decimal or hexadecimal; "inf" and "nan" as well.
    double number() const {
        char* end = nullptr;
        const double value = std::strtod(text.c_str(), &end);
        if (text.empty() || *end != '\0') throw std::runtime_error("no number: " + text);
        return value;
    }
    bool is_true() const { return text == "true"; }
};

class JsonReader {
public:
    static Json read(std::string_view line) {
        JsonReader reader(line);
        Json result = reader.value();
        reader.skip_spaces();
        if (!reader.rest_.empty()) reader.fail();
        return result;
    }

private:
    explicit JsonReader(std::string_view line) : rest_(line) {}

    [[noreturn]] void fail() const { throw std::runtime_error("bad JSON at: " + std::string(rest_.substr(0, 40))); }

    void skip_spaces() {
        while (!rest_.empty() && std::isspace(static_cast<unsigned char>(rest_.front())) != 0) rest_.remove_prefix(1);
    }
    bool take(char c) {
        skip_spaces();
        if (rest_.empty() || rest_.front() != c) return false;
        rest_.remove_prefix(1);
        return true;
    }
    std::string string() {
        if (!take('"')) fail();
        const std::size_t end = rest_.find_first_of("\"\\");
        if (end == std::string_view::npos || rest_[end] == '\\') fail();
        std::string result(rest_.substr(0, end));
        rest_.remove_prefix(end + 1);
        return result;
    }
    Json value() {
        Json result;
        skip_spaces();
        if (rest_.empty()) fail();
        if (take('{')) {
            if (take('}')) return result;
            do {
                std::string name = string();
                if (!take(':')) fail();
                result.members[name] = value();
            } while (take(','));
            if (!take('}')) fail();
        } else if (take('[')) {
            if (take(']')) return result;
            do result.items.push_back(value());
            while (take(','));
            if (!take(']')) fail();
        } else if (rest_.front() == '"') {
            result.text = string();
        } else {
            const std::size_t end = rest_.find_first_of(",]} ");
            result.text = std::string(rest_.substr(0, end));
            rest_.remove_prefix(result.text.size());
            if (result.text.empty()) fail();
        }
        return result;
    }

    std::string_view rest_;
};

}  // namespace support
