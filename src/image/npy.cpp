// SPDX-License-Identifier: Apache-2.0
#include "image/npy.h"

#include <algorithm>
#include <bit>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>

#include "base/error.h"
#include "image/image_limits.h"

namespace lamina {

namespace {

constexpr std::uint64_t max_header_bytes = 65536;
constexpr std::size_t most_axes = 32;  // NumPy's own limit

void read_bytes(std::istream& stream, const std::string& name, void* bytes, std::size_t count) {
    stream.read(static_cast<char*>(bytes), static_cast<std::streamsize>(count));
    if (!stream) fail("{}: cannot read as NPY: the file ends too early", name);
}

static_assert(std::endian::native == std::endian::little,
              "the numbers are copied as they lie in memory");

constexpr std::size_t alignment = 64;  // bytes; the data begin at a multiple of it (NEP 1)

struct Layout {
    bool is_double;
    std::int64_t height, width, channels;
};

Layout layout_of(const NpyHeader& header) {
    const std::string descr = header.descr();
    if (descr != "<f8" && descr != "<f4") header.wrong("descr", "'<f4' or '<f8'");
    if (header.is_fortran_order()) header.wrong("fortran_order", "False");
    const std::vector<std::int64_t> shape = header.shape();
    if (shape.size() != 3 || (shape[2] != 3 && shape[2] != 4))
        header.wrong("shape", "(height, width, 4) or (height, width, 3)");
    return {descr == "<f8", shape[0], shape[1], shape[2]};
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

NpyHeader::NpyHeader(const std::filesystem::path& path) : name_(path.string()) {
    std::ifstream stream(path, std::ios::binary);
    if (!stream) fail("{}: cannot open: {}", name_, std::strerror(errno));
    read(stream);
}

NpyHeader::NpyHeader(std::string name, std::istream& stream) : name_(std::move(name)) {
    read(stream);
}

void NpyHeader::read(std::istream& stream) {
    char start[8] = {};
    read_bytes(stream, name_, start, sizeof start);
    if (std::string_view(start, npy_magic.size()) != npy_magic)
        fail("{}: cannot read as NPY: the file does not begin with \\x93NUMPY", name_);
    const int version = static_cast<unsigned char>(start[6]);
    if (version < 1 || version > 3) fail("{}: NPY version {}; expected 1, 2 or 3", name_, version);
    unsigned char length_bytes[4] = {};
    read_bytes(stream, name_, length_bytes, version == 1 ? 2 : 4);
    std::uint32_t length = 0;  // little-endian in the file
    for (int i = 3; i >= 0; --i) length = length << 8 | length_bytes[i];
    if (length > max_header_bytes)
        fail("{}: NPY header of {} bytes; expected at most {}", name_, length, max_header_bytes);
    text_.resize(length);
    read_bytes(stream, name_, text_.data(), length);
    data_offset_ = static_cast<std::int64_t>(sizeof start) + (version == 1 ? 2 : 4) + length;
}

std::string_view NpyHeader::value(std::string_view key) const {
    const std::string_view text = text_;
    std::size_t at = text.find(fmt::format("'{}'", key));
    if (at != std::string_view::npos) at = text.find(':', at);
    if (at == std::string_view::npos) fail("{}: NPY header without '{}'", name_, key);
    at = text.find_first_not_of(' ', at + 1);
    return at == std::string_view::npos ? std::string_view() : text.substr(at);
}

std::string NpyHeader::descr() const {
    const std::string_view text = value("descr");
    const std::size_t end = text.starts_with('\'') ? text.find('\'', 1) : std::string_view::npos;
    return end == std::string_view::npos ? std::string() : std::string(text.substr(1, end - 1));
}

bool NpyHeader::is_fortran_order() const {
    const std::string_view text = value("fortran_order");
    if (text.starts_with("True")) return true;
    if (!text.starts_with("False")) wrong("fortran_order", "True or False");
    return false;
}

std::vector<std::int64_t> NpyHeader::shape() const {
    const std::string_view text = value("shape");
    std::vector<std::int64_t> numbers;
    const char* at = text.data();
    const char* const end = at + text.size();
    if (at == end || *at++ != '(') return {};
    while (at < end && *at != ')') {
        std::int64_t number = 0;
        const auto [next, error] = std::from_chars(at, end, number);
        if (error != std::errc() || numbers.size() == most_axes) return {};
        numbers.push_back(number);
        at = next;
        while (at < end && (*at == ',' || *at == ' ')) ++at;
    }
    return at < end ? numbers : std::vector<std::int64_t>{};
}

void NpyHeader::wrong(const char* key, std::string_view expected) const {
    const std::string_view found = value(key);
    const char closing = found.starts_with('(') ? ')' : ',';
    const std::size_t end = found.find(closing);
    const auto shown = found.substr(0, std::min<std::size_t>(end, 40));
    fail("{}: NPY header, '{}': found {}{}; expected {}", name_, key, one_line(std::string(shown)),
         closing == ')' && end < 40 ? ")" : "", expected);
}

template <typename Real>
void write_npy(OutputFile& file, const RgbaImage<Real>& image) {
    const std::string name = file.path().string();
    check_image_size(name, image.width, image.height);
    require_finite(name, image);
    std::string header =
        fmt::format("{{'descr': '<f{}', 'fortran_order': False, 'shape': ({}, {}, 4), }}",
                    sizeof(Real), image.height, image.width);
    const std::size_t preamble = npy_magic.size() + 4;  // version and header length
    while ((preamble + header.size() + 1) % alignment != 0) header += ' ';
    header += '\n';
    const auto length = static_cast<std::uint16_t>(header.size());
    file.write(std::string(npy_magic) + '\x01' + '\x00');
    file.write(&length, sizeof length);
    file.write(header);
    file.write(image.rgba.data(), image.rgba.size() * sizeof(Real));
}

template void write_npy(OutputFile&, const Image&);
template void write_npy(OutputFile&, const PreciseImage&);

PreciseImage read_npy(const std::filesystem::path& path) {
    const std::string name = path.string();
    const std::uint64_t file_bytes = length_of_file(path);
    std::ifstream stream(path, std::ios::binary);
    if (!stream) fail("{}: cannot open: {}", name, std::strerror(errno));
    const NpyHeader header(path);
    const Layout layout = layout_of(header);
    check_image_size(name, layout.width, layout.height);
    const std::uint64_t data_bytes =
        static_cast<std::uint64_t>(layout.width * layout.height * layout.channels) *
        (layout.is_double ? sizeof(double) : sizeof(float));
    const auto header_bytes = static_cast<std::uint64_t>(header.data_offset());
    stream.seekg(header.data_offset());
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
