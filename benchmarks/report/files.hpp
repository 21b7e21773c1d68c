#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace report {

// The whole of a regular file. Throws Failure for anything else, and beyond 1 GiB.
std::string read_file(const std::filesystem::path& file);

// Its lines, each as the fields between |.
std::vector<std::vector<std::string>> read_fields(const std::filesystem::path& file);

// A field that is a number from 0 to 1e12; empty for any other.
std::optional<double> number_of(const std::string& field);

// A hidden folder next to the report's final place, on the same file system. What is written there appears at the
// final place by publish() or not at all: the destructor removes what was not published.
class Staging {
public:
    explicit Staging(const std::filesystem::path& destination);
    ~Staging();
    Staging(const Staging&) = delete;
    Staging& operator=(const Staging&) = delete;

    const std::filesystem::path& folder() const { return folder_; }
    void write(const std::string& name, std::string_view bytes) const;

    // Throws Failure where publish() would find a folder of the name of a file.
    void check_names() const;

    // The whole folder is renamed where there was none. Otherwise the files replace their namesakes one by one, and
    // other files stay: the folder may be the user's home.
    void publish() const;

private:
    std::filesystem::path destination_;
    std::filesystem::path folder_;
};

}  // namespace report
