#include "picture.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

#include <glm/common.hpp>

#define STBI_ONLY_JPEG
#define STBI_ONLY_PNG
#define STBI_MAX_DIMENSIONS 16384
#define STB_IMAGE_IMPLEMENTATION
#include <stb_image.h>
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb_image_write.h>

#include "failure.hpp"
#include "files.hpp"

namespace report {

namespace {

constexpr int largest_side = 1024;

// Bytes as a stream for the decoder, which takes the end of a file for zeros and decodes on.
struct ByteStream {
    const std::string& bytes;
    std::size_t position = 0;
    bool was_read_beyond_end = false;

    int read(char* data, int size) {
        const std::size_t count = std::min(static_cast<std::size_t>(size), bytes.size() - position);
        was_read_beyond_end |= count == 0;
        std::memcpy(data, bytes.data() + position, count);
        position += count;
        return static_cast<int>(count);
    }

    void skip(int count) {
        const auto end = static_cast<std::ptrdiff_t>(bytes.size());
        const std::ptrdiff_t target = static_cast<std::ptrdiff_t>(position) + count;
        was_read_beyond_end |= target > end;
        position = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(target, 0, end));
    }
};

constexpr stbi_io_callbacks byte_stream_callbacks{
    [](void* user, char* data, int size) { return static_cast<ByteStream*>(user)->read(data, size); },
    [](void* user, int count) { static_cast<ByteStream*>(user)->skip(count); },
    [](void* user) {
        const auto* stream = static_cast<const ByteStream*>(user);
        return static_cast<int>(stream->position == stream->bytes.size());
    }};

// Whether no Huffman table of a JPEG has more than 256 codes: stb_image 2.27 writes them all into an array of 257.
bool huffman_tables_fit(const std::string& jpeg) {
    const auto byte = [&jpeg](std::size_t i) {
        return i < jpeg.size() ? static_cast<unsigned>(static_cast<unsigned char>(jpeg[i])) : 0u;
    };
    std::size_t position = 2;
    for (;;) {
        position = jpeg.find('\xff', position);
        if (position == std::string::npos) return true;
        const unsigned marker = byte(++position);
        const bool is_in_scan_data = marker == 0x00 || (marker >= 0xd0 && marker <= 0xd7);
        if (marker == 0xff || is_in_scan_data) continue;
        if (marker == 0xd9) return true;
        ++position;
        const std::size_t end = position + (byte(position) << 8 | byte(position + 1));
        if (marker == 0xc4) {
            for (std::size_t table = position + 2; table < end;) {
                unsigned codes = 0;
                for (std::size_t length = 1; length <= 16; ++length) codes += byte(table + length);
                if (codes > 256) return false;
                table += 17 + codes;
            }
        }
        position = end;
    }
}

// The mean of each factor x factor block of colour(x, y); a pixel counts by how much of it is in the block, and blocks
// at the right and the bottom may be cut.
template <class Colour>
Picture reduced(int width, int height, float factor, const Colour& colour) {
    const auto blocks = [factor](int side) {
        return static_cast<int>(std::ceil(static_cast<float>(side) / factor - 1e-3f));
    };
    const auto share = [factor](int pixel, int block) {
        const auto from = static_cast<float>(pixel), to = from + 1.0f, start = static_cast<float>(block) * factor;
        return std::max(0.0f, std::min(to, start + factor) - std::max(from, start));
    };
    const auto last = [factor](int block, int side) {
        return std::min(static_cast<int>(std::ceil(static_cast<float>(block + 1) * factor)), side);
    };
    Picture picture(blocks(width), blocks(height), glm::vec3(0));
    for (int y = 0; y < picture.height; ++y) {
        for (int x = 0; x < picture.width; ++x) {
            float sum = 0.0f;
            for (int row = static_cast<int>(static_cast<float>(y) * factor); row < last(y, height); ++row) {
                for (int column = static_cast<int>(static_cast<float>(x) * factor); column < last(x, width); ++column) {
                    const float weight = share(row, y) * share(column, x);
                    picture.at(x, y) += weight * colour(column, row);
                    sum += weight;
                }
            }
            picture.at(x, y) /= sum;
        }
    }
    return picture;
}

// How many pixels a side become one where at most so many are wanted.
float factor_of(const Picture& picture, int most) {
    return std::max(1.0f, static_cast<float>(std::max(picture.width, picture.height)) / static_cast<float>(most));
}

unsigned char to_byte(float value) {
    return static_cast<unsigned char>(std::lround(255.0f * std::clamp(value, 0.0f, 1.0f)));
}

std::vector<unsigned char> bytes_of(const Picture& picture) {
    std::vector<unsigned char> bytes;
    bytes.reserve(3 * picture.pixels.size());
    for (const glm::vec3& colour : picture.pixels)
        for (int channel = 0; channel < 3; ++channel) bytes.push_back(to_byte(colour[channel]));
    return bytes;
}

void append(void* text, void* data, int size) {
    static_cast<std::string*>(text)->append(static_cast<const char*>(data), static_cast<std::size_t>(size));
}

}  // namespace

glm::vec3 Picture::sample(float s, float t) const {
    const float x = std::clamp(s * static_cast<float>(width) - 0.5f, 0.0f, static_cast<float>(width - 1));
    const float y = std::clamp((1.0f - t) * static_cast<float>(height) - 0.5f, 0.0f, static_cast<float>(height - 1));
    const int left = static_cast<int>(x);
    const int above = static_cast<int>(y);
    const int right = std::min(left + 1, width - 1);
    const int below = std::min(above + 1, height - 1);
    const float to_right = x - static_cast<float>(left);
    return glm::mix(glm::mix(at(left, above), at(right, above), to_right),
                    glm::mix(at(left, below), at(right, below), to_right), y - static_cast<float>(above));
}

Picture load_picture(const std::filesystem::path& file) {
    const std::string bytes = read_file(file);
    if (bytes.starts_with("\xff\xd8") && !huffman_tables_fit(bytes))
        throw Failure{"cannot use " + file.string() + ": a damaged JPEG picture"};
    ByteStream stream{bytes};
    int width = 0, height = 0, channels = 0;
    unsigned char* decoded = stbi_load_from_callbacks(&byte_stream_callbacks, &stream, &width, &height, &channels, 3);
    const std::unique_ptr<unsigned char, void (*)(void*)> owner(decoded, stbi_image_free);
    if (decoded == nullptr) {
        const std::string reason = stbi_failure_reason();
        if (reason == "too large")
            throw Failure{"cannot use " + file.string() + ": larger than " + std::to_string(STBI_MAX_DIMENSIONS) +
                          " pixels a side"};
        throw Failure{"cannot use " + file.string() + ": not a PNG or JPEG picture, or damaged" +
                      (reason.empty() ? "" : " (" + reason + ")")};
    }
    if (stream.was_read_beyond_end) throw Failure{"cannot use " + file.string() + ": the picture is cut off"};
    const auto colour = [&](int x, int y) {
        const unsigned char* rgb = decoded + 3 * (static_cast<std::ptrdiff_t>(y) * width + x);
        return glm::vec3(rgb[0], rgb[1], rgb[2]) / 255.0f;
    };
    const int factor = (std::max(width, height) + largest_side - 1) / largest_side;
    return reduced(width, height, static_cast<float>(factor), colour);
}

std::string encode_png(const Picture& picture) {
    std::string png;
    if (!stbi_write_png_to_func(append, &png, picture.width, picture.height, 3, bytes_of(picture).data(),
                                3 * picture.width))
        throw Failure{"cannot encode a picture: out of memory"};
    return png;
}

std::string encode_jpeg(const Picture& picture) {
    constexpr int quality = 65;
    std::string jpeg;
    if (!stbi_write_jpg_to_func(append, &jpeg, picture.width, picture.height, 3, bytes_of(picture).data(), quality))
        throw Failure{"cannot encode a picture: out of memory"};
    return jpeg;
}

Picture reduced(const Picture& picture, int most) {
    return reduced(picture.width, picture.height, factor_of(picture, most),
                   [&](int x, int y) { return picture.at(x, y); });
}

Picture thinned(const Picture& picture, int most) {
    const float factor = factor_of(picture, most);
    const auto size = [factor](int side) { return std::max(1, static_cast<int>(static_cast<float>(side) / factor)); };
    const auto middle = [factor](int i) { return static_cast<int>((static_cast<float>(i) + 0.5f) * factor); };
    Picture part(size(picture.width), size(picture.height), glm::vec3(0));
    for (int y = 0; y < part.height; ++y)
        for (int x = 0; x < part.width; ++x) part.at(x, y) = picture.at(middle(x), middle(y));
    return part;
}

Picture cropped(const Picture& picture, int x, int y, int width, int height) {
    Picture part(std::min(width, picture.width - x), std::min(height, picture.height - y), glm::vec3(0));
    for (int row = 0; row < part.height; ++row)
        for (int column = 0; column < part.width; ++column) part.at(column, row) = picture.at(x + column, y + row);
    return part;
}

Picture with_white_border(const Picture& picture, int border) {
    Picture framed = picture;
    for (int y = 0; y < framed.height; ++y)
        for (int x = 0; x < framed.width; ++x)
            if (std::min({x, y, framed.width - 1 - x, framed.height - 1 - y}) < border) framed.at(x, y) = glm::vec3(1);
    return framed;
}

}  // namespace report
