// SPDX-License-Identifier: Apache-2.0
#pragma once

// Limits that are checked before memory is allocated for an image.
#include <cstdint>
#include <filesystem>
#include <string>

#include "lamina/image.h"

namespace lamina {

constexpr std::int64_t max_image_side = 32768;
constexpr std::int64_t max_image_pixels = std::int64_t{1} << 26;  // 1 GiB of float RGBA

// Throws Error unless both sides are in 1..max_image_side and the area is at most max_image_pixels.
// `name`: the file or one of its components; the message begins with it.
void check_image_size(const std::string& name, std::int64_t width, std::int64_t height);

// Returns the length of a file in bytes. Throws Error if it is missing or no regular file.
std::uint64_t length_of_file(const std::filesystem::path& path);

// Throws Error if `file_bytes` cannot hold `image_bytes` even compressed by `ratio` : 1.
void check_file_can_hold(const std::string& name, std::uint64_t image_bytes,
                         std::uint64_t file_bytes, std::uint64_t ratio);

// Throws Error, naming `name`, pixel and channel, unless all components are finite float32.
template <typename Real>
void require_finite(const std::string& name, const RgbaImage<Real>& image);

extern template void require_finite(const std::string&, const Image&);
extern template void require_finite(const std::string&, const PreciseImage&);

}  // namespace lamina
