// SPDX-License-Identifier: Apache-2.0
#include "image/npy.h"

#include <algorithm>
#include <bit>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "image/finite.h"
#include "image/image_limits.h"

namespace lamina {
namespace {

static_assert(std::endian::native == std::endian::little,
              "the numbers are copied as they lie in memory");

constexpr std::string_view magic = "\x93NUMPY";
constexpr std::size_t alignment = 64;  // of the data, NEP 1
constexpr std::uint64_t max_header_bytes = 65536;

struct Layout {
    bool is_double = true;
    std::int64_t height = 0, width = 0, channels = 0;
};

// Reads the literal of a Python dictionary that is the header of the file.
class HeaderText {
  public:
    HeaderText(const std::string& name, std::string_view text) : name_(name), text_(text) {}

    // Returns what follows `key`, without leading blanks.
    std::string_view value(std::string_view key) const {
        std::size_t at = text_.find(fmt::format("'{}'", key));
        if (at != std::string_view::npos) at = text_.find(':', at);
        if (at == std::string_view::npos) fail("{}: NPY header without '{}'", name_, key);
        at = text_.find_first_not_of(' ', at + 1);
        return at == std::string_view::npos ? std::string_view() : text_.substr(at);
    }

    Layout layout() const {
        Layout found;
        const std::string_view descr = value("descr");
        if (!descr.starts_with("'<f8'") && !descr.starts_with("'<f4'")) {
            wrong("descr", descr, "'<f4' or '<f8'");
        }
        found.is_double = descr.starts_with("'<f8'");
        const std::string_view order = value("fortran_order");
        if (!order.starts_with("False")) wrong("fortran_order", order, "False");
        const std::string_view shape = value("shape");
        const std::vector<std::int64_t> numbers = tuple(shape);
        if (numbers.size() != 3 || (numbers[2] != 3 && numbers[2] != 4)) {
            wrong("shape", shape, "(height, width, 4) or (height, width, 3)");
        }
        found.height = numbers[0];
        found.width = numbers[1];
        found.channels = numbers[2];
        return found;
    }

  private:
    [[noreturn]] void wrong(const char* key, std::string_view found, const char* expected) const {
        const char closing = found.starts_with('(') ? ')' : ',';
        const std::size_t end = found.find(closing);
        const auto shown = found.substr(0, std::min<std::size_t>(end, 40));
        fail("{}: NPY header, '{}': found {}{}; expected {}", name_, key,
             one_line(std::string(shown)), closing == ')' && end < 40 ? ")" : "", expected);
    }

    // Reads a tuple such as "(2, 3, 4)". Returns an empty list where the text is none.
    static std::vector<std::int64_t> tuple(std::string_view text) {
        std::vector<std::int64_t> numbers;
        const char* at = text.data();
        const char* const end = at + text.size();
        if (at == end || *at++ != '(') return {};
        while (at < end && *at != ')') {
            std::int64_t number = 0;
            const auto [next, error] = std::from_chars(at, end, number);
            if (error != std::errc() || numbers.size() == 3) return {};
            numbers.push_back(number);
            at = next;
            while (at < end && (*at == ',' || *at == ' ')) ++at;
        }
        return at < end ? numbers : std::vector<std::int64_t>{};
    }

    const std::string& name_;
    std::string_view text_;
};

template <typename Real>
void write_numbers(OutputFile& file, const RgbaImage<Real>& image) {
    const std::string name = file.path().string();
    check_image_size(name, image.width, image.height);
    require_finite(name, image);
    std::string header =
        fmt::format("{{'descr': '<f{}', 'fortran_order': False, 'shape': ({}, {}, 4), }}",
                    sizeof(Real), image.height, image.width);
    const std::size_t preamble = magic.size() + 4;  // version and header length
    while ((preamble + header.size() + 1) % alignment != 0) header += ' ';
    header += '\n';
    const auto length = static_cast<std::uint16_t>(header.size());
    file.write(std::string(magic) + '\x01' + '\x00');
    file.write(&length, sizeof length);
    file.write(header);
    file.write(image.rgba.data(), image.rgba.size() * sizeof(Real));
}

void read_bytes(std::ifstream& stream, const std::string& name, void* bytes, std::size_t count) {
    stream.read(static_cast<char*>(bytes), static_cast<std::streamsize>(count));
    if (!stream) fail("{}: cannot read as NPY: the file ends too early", name);
}

// Leaves the stream at the first number.
std::string read_header(std::ifstream& stream, const std::string& name) {
    char start[8] = {};
    read_bytes(stream, name, start, sizeof start);
    if (std::string_view(start, magic.size()) != magic) {
        fail("{}: cannot read as NPY: the file does not begin with \\x93NUMPY", name);
    }
    const int version = static_cast<unsigned char>(start[6]);
    if (version < 1 || version > 3) {
        fail("{}: NPY version {}; expected 1, 2 or 3", name, version);
    }
    std::uint32_t length = 0;
    read_bytes(stream, name, &length, version == 1 ? 2 : 4);
    if (length > max_header_bytes) {
        fail("{}: NPY header of {} bytes; expected at most {}", name, length, max_header_bytes);
    }
    std::string header(length, ' ');
    read_bytes(stream, name, header.data(), length);
    return header;
}

template <typename Real>
void read_pixels(std::ifstream& stream, const std::string& name, std::int64_t channels,
                 PreciseImage& image) {
    const auto width = static_cast<std::size_t>(image.width);
    const auto stored = static_cast<std::size_t>(channels);
    std::vector<Real> row(width * stored);
    for (int y = 0; y < image.height; ++y) {
        read_bytes(stream, name, row.data(), row.size() * sizeof(Real));
        double* pixel = image.pixel(0, y);
        for (std::size_t x = 0; x < width; ++x, pixel += 4) {
            pixel[3] = 1;
            for (std::size_t c = 0; c < stored; ++c)
                pixel[c] = static_cast<double>(row[x * stored + c]);
        }
    }
}

}  // namespace

void write_npy(OutputFile& file, const Image& image) {
    write_numbers(file, image);
}

void write_npy(OutputFile& file, const PreciseImage& image) {
    write_numbers(file, image);
}

PreciseImage read_npy(const std::filesystem::path& path) {
    const std::string name = path.string();
    const std::uint64_t file_bytes = length_of_file(path);
    std::ifstream stream(path, std::ios::binary);
    if (!stream) fail("{}: cannot open: {}", name, std::strerror(errno));
    const std::string header = read_header(stream, name);
    const Layout layout = HeaderText(name, header).layout();
    check_image_size(name, layout.width, layout.height);
    const std::uint64_t data_bytes =
        static_cast<std::uint64_t>(layout.width * layout.height * layout.channels) *
        (layout.is_double ? sizeof(double) : sizeof(float));
    const auto header_bytes = static_cast<std::uint64_t>(stream.tellg());
    if (file_bytes != header_bytes + data_bytes) {
        fail("{}: {} bytes of numbers; expected {} for shape ({}, {}, {})", name,
             file_bytes - header_bytes, data_bytes, layout.height, layout.width, layout.channels);
    }
    PreciseImage image(static_cast<int>(layout.width), static_cast<int>(layout.height));
    if (layout.is_double)
        read_pixels<double>(stream, name, layout.channels, image);
    else
        read_pixels<float>(stream, name, layout.channels, image);
    return image;
}

}  // namespace lamina
