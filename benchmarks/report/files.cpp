#include "files.hpp"

#include <charconv>
#include <fstream>
#include <random>
#include <sstream>
#include <system_error>
#include <vector>

#include "failure.hpp"

namespace report {

namespace fs = std::filesystem;

namespace {

constexpr std::uintmax_t largest_input = std::uintmax_t{1} << 30;

// The destination itself where it exists, otherwise the folder that it will be made in.
fs::path deepest_existing_folder(const fs::path& destination) {
    fs::path folder = destination;
    std::error_code error;
    while (!fs::exists(folder, error) && folder.has_relative_path()) {
        if (fs::is_symlink(folder, error))
            throw Failure{"cannot write to " + destination.string() + ": " + folder.string() + " leads nowhere"};
        folder = folder.parent_path();
    }
    if (!fs::is_directory(folder, error))
        throw Failure{"cannot write to " + destination.string() + ": " + folder.string() + " is not a folder"};
    return folder;
}

}  // namespace

std::string read_file(const fs::path& file) {
    std::error_code error;
    const fs::file_status status = fs::status(file, error);
    if (!fs::exists(status)) throw Failure{"cannot open " + file.string() + ": no such file"};
    if (!fs::is_regular_file(status)) throw Failure{"cannot read " + file.string() + ": not a regular file"};
    const std::uintmax_t size = fs::file_size(file, error);
    if (error || size > largest_input) throw Failure{"cannot read " + file.string() + ": larger than 1 GiB"};
    std::ifstream stream(file, std::ios::binary);
    if (!stream) throw Failure{"cannot open " + file.string() + ": permission denied"};
    std::string bytes(static_cast<std::size_t>(size), '\0');
    stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    if (!stream) throw Failure{"cannot read " + file.string()};
    return bytes;
}

std::vector<std::vector<std::string>> read_fields(const fs::path& file) {
    std::vector<std::vector<std::string>> lines;
    std::istringstream text(read_file(file));
    for (std::string line; std::getline(text, line);) {
        std::vector<std::string>& fields = lines.emplace_back(1);
        for (const char c : line) {
            if (c == '|')
                fields.emplace_back();
            else if (c != '\r')
                fields.back() += c;
        }
    }
    return lines;
}

std::optional<double> number_of(const std::string& field) {
    double value = 0;
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (error != std::errc() || end != field.data() + field.size() || !(value >= 0) || value > 1e12)
        return std::nullopt;
    return value;
}

Staging::Staging(const fs::path& destination) {
    std::error_code error;
    destination_ = fs::absolute(destination, error).lexically_normal();
    if (!destination_.has_filename()) destination_ = destination_.parent_path();
    if (fs::equivalent(destination_, destination_.root_path(), error))
        throw Failure{"cannot write to " + destination.string() + ": it is the root of the file system"};
    const fs::path parent = deepest_existing_folder(destination_);
    std::random_device random;
    for (int attempt = 0; attempt < 100; ++attempt) {
        std::ostringstream name;
        name << ".texgen-report-" << std::hex << random();
        if (fs::create_directory(parent / name.str(), error)) {
            folder_ = parent / name.str();
            // Whether folders can have the names that are missing is known when they are made.
            std::error_code refusal;
            fs::create_directories(folder_ / "trial" / destination_.lexically_relative(parent), refusal);
            fs::remove_all(refusal ? folder_ : folder_ / "trial", error);
            if (refusal) throw Failure{"cannot write to " + destination.string() + ": " + refusal.message()};
            return;
        }
    }
    throw Failure{"cannot write to " + destination.string() + ": " + error.message()};
}

Staging::~Staging() {
    std::error_code error;
    if (!folder_.empty()) fs::remove_all(folder_, error);
}

void Staging::write(const std::string& name, std::string_view bytes) const {
    std::ofstream stream(folder_ / name, std::ios::binary);
    stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    stream.close();
    if (!stream) throw Failure{"cannot write " + (destination_ / name).string()};
}

void Staging::check_names() const {
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_)) {
        const fs::path file = destination_ / entry.path().filename();
        if (fs::is_directory(file, error)) throw Failure{"cannot write " + file.string() + ": a folder has that name"};
    }
}

void Staging::publish() const {
    std::error_code error;
    if (!fs::exists(destination_, error)) {
        fs::create_directories(destination_.parent_path(), error);
        fs::rename(folder_, destination_, error);
        if (error) throw Failure{"cannot write to " + destination_.string() + ": " + error.message()};
        return;
    }
    std::vector<fs::path> names;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_)) names.push_back(entry.path().filename());
    for (const fs::path& name : names) {
        fs::rename(folder_ / name, destination_ / name, error);
        if (error) throw Failure{"cannot write " + (destination_ / name).string() + ": " + error.message()};
    }
}

}  // namespace report
