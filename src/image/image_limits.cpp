// SPDX-License-Identifier: Apache-2.0
#include "image/image_limits.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <limits>
#include <system_error>

#include "base/enum_words.h"
#include "base/error.h"
#include "lamina/image.h"

namespace lamina {

void check_image_size(const std::string& name, std::int64_t width, std::int64_t height) {
    if (width < 1 || height < 1 || width > max_image_side || height > max_image_side ||
        width > max_image_pixels / height) {
        fail("{}: an image of {} x {} pixels; expected 1 to {} a side and at most {} in all", name,
             width, height, max_image_side, max_image_pixels);
    }
}

std::uint64_t length_of_file(const std::filesystem::path& path) {
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status))
        fail("{}: cannot open: {}", path.string(), error ? error.message() : std::strerror(ENOENT));
    if (!std::filesystem::is_regular_file(status))
        fail("{}: cannot open: it is not a regular file", path.string());
    const std::uintmax_t length = std::filesystem::file_size(path, error);
    if (error) fail("{}: cannot open: {}", path.string(), error.message());
    return length;
}

void check_file_can_hold(const std::string& name, std::uint64_t image_bytes,
                         std::uint64_t file_bytes, std::uint64_t ratio) {
    if (image_bytes / ratio > file_bytes) {
        fail("{}: the header promises {} bytes of pixels, more than a file of {} bytes can hold",
             name, image_bytes, file_bytes);
    }
}

template <typename Real>
void require_finite(const std::string& name, const RgbaImage<Real>& image) {
    constexpr Real largest = std::numeric_limits<float>::max();
    for (std::size_t i = 0; i < image.rgba.size(); ++i) {
        if (std::abs(image.rgba[i]) <= largest) continue;  // false for NaN
        const std::size_t pixel = i / 4;
        const auto width = static_cast<std::size_t>(image.width);
        fail("{}: pixel ({}, {}), channel {}, is {}; expected a finite float32 number", name,
             pixel % width, pixel / width, "RGBA"[i % 4], image.rgba[i]);
    }
}

template void require_finite(const std::string&, const Image&);
template void require_finite(const std::string&, const PreciseImage&);

Image to_float(const PreciseImage& image) {
    Image rounded(image.width, image.height);
    rounded.space = image.space;
    rounded.annotations = image.annotations;
    std::transform(image.rgba.begin(), image.rgba.end(), rounded.rgba.begin(),
                   [](double value) { return static_cast<float>(value); });
    return rounded;
}

PreciseImage to_double(const Image& image) {
    PreciseImage precise(image.width, image.height);
    precise.space = image.space;
    precise.annotations = image.annotations;
    precise.rgba.assign(image.rgba.begin(), image.rgba.end());
    return precise;
}

const char* name_of(ImageColorSpace space) {
    return word_of(space, {"linear", "display"});
}

}  // namespace lamina
