// SPDX-License-Identifier: Apache-2.0
#include "image/npy_header.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>

#include "base/error.h"

namespace lamina {
namespace {

constexpr std::uint64_t max_header_bytes = 65536;
constexpr std::size_t most_axes = 32;  // NumPy's own limit

void read_header_bytes(std::ifstream& stream, const std::string& name, void* bytes,
                       std::size_t count) {
    stream.read(static_cast<char*>(bytes), static_cast<std::streamsize>(count));
    if (!stream) fail("{}: cannot read as NPY: the file ends too early", name);
}

}  // namespace

NpyHeader::NpyHeader(const std::filesystem::path& path) : name_(path.string()) {
    std::ifstream stream(path, std::ios::binary);
    if (!stream) fail("{}: cannot open: {}", name_, std::strerror(errno));
    char start[8] = {};
    read_header_bytes(stream, name_, start, sizeof start);
    if (std::string_view(start, npy_magic.size()) != npy_magic) {
        fail("{}: cannot read as NPY: the file does not begin with \\x93NUMPY", name_);
    }
    const int version = static_cast<unsigned char>(start[6]);
    if (version < 1 || version > 3) {
        fail("{}: NPY version {}; expected 1, 2 or 3", name_, version);
    }
    unsigned char length_bytes[4] = {};
    read_header_bytes(stream, name_, length_bytes, version == 1 ? 2 : 4);
    std::uint32_t length = 0;  // little-endian in the file
    for (int i = 3; i >= 0; --i) length = length << 8 | length_bytes[i];
    if (length > max_header_bytes) {
        fail("{}: NPY header of {} bytes; expected at most {}", name_, length, max_header_bytes);
    }
    text_.resize(length);
    read_header_bytes(stream, name_, text_.data(), length);
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

}  // namespace lamina
