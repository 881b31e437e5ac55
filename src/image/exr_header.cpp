// SPDX-License-Identifier: Apache-2.0
// "OpenEXR File Layout": magic number, version, then headers. A header is a list of attributes,
// each a name, a type (both end with a zero), a size and as many bytes, and ends where a name is
// empty.
#include "image/exr_header.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "base/error.h"

namespace lamina {
namespace {

constexpr std::uint32_t magic_number = 20000630;
constexpr std::uint32_t several_parts = 1u << 12;  // flag in the version: more than one header
constexpr std::size_t longest_name = 255;

// Types of attributes whose values have one size, in bytes.
constexpr std::pair<std::string_view, std::uint32_t> sizes_of_types[] = {
    {"box2i", 16},      {"box2f", 16},   {"chromaticities", 32},
    {"compression", 1}, {"double", 8},   {"envmap", 1},
    {"float", 4},       {"int", 4},      {"keycode", 28},
    {"m33f", 36},       {"m33d", 72},    {"m44f", 64},
    {"m44d", 128},      {"v2i", 8},      {"v2f", 8},
    {"v2d", 16},        {"v3i", 12},     {"v3f", 12},
    {"v3d", 24},        {"rational", 8}, {"lineOrder", 1},
    {"timecode", 8},    {"tiledesc", 9}, {"deepImageState", 1}};

// Reads a little-endian number. There must be four bytes at `at`.
std::uint32_t number_at(std::string_view bytes, std::size_t at) {
    std::uint32_t number = 0;
    for (std::size_t i = 4; i-- > 0;)
        number = number << 8 | static_cast<unsigned char>(bytes[at + i]);
    return number;
}

// Returns whether the list of channels (a name, a zero and 16 bytes each) ends with an empty name
// exactly where the value ends.
bool channels_fill(std::string_view value) {
    constexpr std::size_t channel_bytes = 16;
    std::size_t at = 0;
    while (at < value.size() && value[at] != '\0') {
        const std::size_t name_end = value.find('\0', at);
        if (name_end == value.npos) return false;
        at = name_end + 1 + channel_bytes;
    }
    return at + 1 == value.size();
}

// Returns whether the last of the strings (a length, then as many bytes) ends exactly where the
// value ends.
bool strings_fill(std::string_view value) {
    std::uint64_t at = 0;
    while (at + 4 <= value.size()) at += 4 + std::uint64_t{number_at(value, at)};
    return at == value.size();
}

// A preview has a width, a height, and four bytes a pixel.
bool preview_fills(std::string_view value) {
    if (value.size() < 8) return false;
    const std::uint64_t width = number_at(value, 0), height = number_at(value, 4);
    const std::uint64_t pixels = value.size() / 4 - 2;
    return value.size() % 4 == 0 && width <= pixels && height <= pixels && width * height == pixels;
}

bool fills(std::string_view type, std::string_view value) {
    if (type == "chlist") return channels_fill(value);
    if (type == "stringvector") return strings_fill(value);
    if (type == "floatvector") return value.size() % 4 == 0;
    if (type == "preview") return preview_fills(value);
    const auto* const sized =
        std::ranges::find(sizes_of_types, type, &std::pair<std::string_view, std::uint32_t>::first);
    return sized == std::end(sizes_of_types) || value.size() == sized->second;
}

class HeaderWalk {
  public:
    HeaderWalk(const std::filesystem::path& path, std::uint64_t file_bytes)
        : name_(path.string()), stream_(path, std::ios::binary), file_bytes_(file_bytes) {}

    void check() {
        if (number() != magic_number) return;
        const bool several = (number() & several_parts) != 0;
        while (check_attributes() && several) check_tables();
        check_tables();
    }

  private:
    // Checks the attributes of one header. Returns false where there are none, or the file ends.
    bool check_attributes() {
        window_.reset();
        tile_.reset();
        chunks_ = 0;
        bool any = false;
        for (std::string name = word(); !name.empty(); name = word()) {
            const std::string type = word();
            const std::uint32_t size = number();
            if (!stream_) return false;
            const std::uint64_t left = file_bytes_ - static_cast<std::uint64_t>(stream_.tellg());
            const std::string what = fmt::format("{}: attribute \"{}\" of type \"{}\"", name_,
                                                 one_line(name), one_line(type));
            if (size > left) fail("{}: promises {} bytes, the file has {} left", what, size, left);
            std::string value(size, '\0');
            stream_.read(value.data(), static_cast<std::streamsize>(size));
            if (!fills(type, value)) fail("{}: {} bytes are not what its type takes", what, size);
            remember(name, type, value);
            any = true;
        }
        return any;
    }

    void remember(std::string_view name, std::string_view type, std::string_view value) {
        if (name == "dataWindow" && type == "box2i") {
            const auto edge = [&](std::size_t axis) {
                const auto low = static_cast<std::int32_t>(number_at(value, 4 * axis));
                const auto high = static_cast<std::int32_t>(number_at(value, 4 * axis + 8));
                return std::max<std::int64_t>(std::int64_t{high} - low + 1, 0);
            };
            window_ = {edge(0), edge(1)};
        } else if (name == "tiles" && type == "tiledesc") {
            tile_ = {number_at(value, 0), number_at(value, 4)};
        } else if (name == "chunkCount" && type == "int") {
            chunks_ = number_at(value, 0);
        }
    }

    // The headers are followed by a table with 8 bytes for each tile or other chunk. (Numbers of
    // tiles along an edge are below 2^33, so their product does not overflow a double.)
    void check_tables() const {
        double chunks = chunks_;
        if (window_ && tile_ && (*tile_)[0] > 0 && (*tile_)[1] > 0) {
            const auto along = [&](std::size_t axis) {
                return std::ceil(static_cast<double>((*window_)[axis]) /
                                 static_cast<double>((*tile_)[axis]));
            };
            chunks = std::max(chunks, along(0) * along(1));
        }
        if (8 * chunks > static_cast<double>(file_bytes_)) {
            fail("{}: promises {:.0f} tiles or other chunks, more than a file of {} bytes can hold",
                 name_, chunks, file_bytes_);
        }
    }

    std::string word() {
        std::string text;
        while (text.size() <= longest_name) {
            const int c = stream_.get();
            if (c <= 0) break;  // a zero, or the end
            text += static_cast<char>(c);
        }
        return text;
    }

    std::uint32_t number() {
        std::array<char, 4> bytes{};
        stream_.read(bytes.data(), bytes.size());
        return number_at({bytes.data(), bytes.size()}, 0);
    }

    std::string name_;
    std::ifstream stream_;
    std::uint64_t file_bytes_;
    // These are of the header that was read last.
    std::optional<std::array<std::int64_t, 2>> window_, tile_;
    std::uint32_t chunks_ = 0;
};

}  // namespace

void check_exr_header(const std::filesystem::path& path, std::uint64_t file_bytes) {
    HeaderWalk(path, file_bytes).check();
}

}  // namespace lamina
