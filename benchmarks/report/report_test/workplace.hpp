#pragma once

// A folder for the program to work in, what it says there, and files for it to read.

#include <doctest/doctest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace report_test {

namespace fs = std::filesystem;

inline std::string contents(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
}

inline const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

inline void write(const fs::path& file, const std::string& bytes) { std::ofstream(file, std::ios::binary) << bytes; }

struct Outcome {
    int status;
    std::string output, error;
};

// An empty folder, the working directory of the program while it lives.
class Workplace {
public:
    Workplace() : before_(fs::current_path()), folder_(before_ / "report_test_files") {
        fs::remove_all(folder_);
        fs::create_directory(folder_);
        fs::current_path(folder_);
    }
    ~Workplace() {
        fs::current_path(before_);
        fs::remove_all(folder_);
    }
    Workplace(const Workplace&) = delete;
    Workplace& operator=(const Workplace&) = delete;

    Outcome run(const std::string& arguments, const std::string& environment = "") const {
        const fs::path output = before_ / "report_test_output", error = before_ / "report_test_error";
        const int status = std::system((environment + " '" TEXGEN_REPORT_PROGRAM "' " + arguments + " >'" +
                                        output.string() + "' 2>'" + error.string() + "'")
                                           .c_str());
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, contents(output), contents(error)};
    }

    // Of one triangle and few pixels, where the pictures are not what is asked for.
    Outcome run_on_little(const std::string& arguments, const std::string& environment = "") const {
        const fs::path mesh = before_ / "report_test_mesh.obj";
        write(mesh, triangle + "f 1 2 3\n");
        return run("--rounds 1 --size 16x16 --mesh '" + mesh.string() + "' " + arguments, environment);
    }

    std::vector<std::string> files() const {
        std::vector<std::string> names;
        for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder_))
            names.push_back(entry.path().lexically_relative(folder_).string());
        std::ranges::sort(names);
        return names;
    }

    void check_refusal(const std::string& arguments, const std::string& reason) const {
        CAPTURE(arguments);
        const std::vector<std::string> before = files();
        const Outcome outcome = run(arguments);
        CAPTURE(outcome.error);
        CHECK(outcome.status == 2);
        CHECK(outcome.output == "");
        CHECK(std::ranges::count(outcome.error, '\n') == 1);
        CHECK(outcome.error.ends_with('\n'));
        CHECK(outcome.error.find(reason) != std::string::npos);
        CHECK(files() == before);
    }

private:
    fs::path before_, folder_;
};

inline const std::string png_signature = "\x89PNG\r\n\x1a\n";

// A PNG that ends after its header.
inline std::string png_header(const std::string& width, const std::string& height) {
    using namespace std::string_literals;
    return png_signature + "\0\0\0\rIHDR"s + width + height + "\x08\x02\0\0\0\0\0\0\0"s;
}

// A row as Google Benchmark writes it.
inline std::string timing_of(const std::string& scene, const std::string& variant, const std::string& nanoseconds) {
    return "{\n\"run_name\": \"" + scene + " > " + variant +
           "\",\n\"aggregate_name\": \"median\",\n\"cpu_time\": " + nanoseconds +
           ",\n\"elements\": 1,\n\"row\": 0,\n\"texels\": 1e-3,\n\"ulp\": 2\n},\n";
}

inline bool has_gnuplot() { return std::system("command -v gnuplot >/dev/null") == 0; }

}  // namespace report_test
