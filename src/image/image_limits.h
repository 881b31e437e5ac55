// SPDX-License-Identifier: Apache-2.0
#pragma once

// Limits that are checked before memory is taken for an image.
#include <cstdint>
#include <filesystem>
#include <string>

#include "lamina/image.h"

namespace lamina {

constexpr std::int64_t max_image_side = 32768;
constexpr std::int64_t max_image_pixels = std::int64_t{1} << 26;  // 1 GiB of float RGBA

// Throws Error unless both sides are in 1..max_image_side and the area is at most max_image_pixels.
// `name`: the file or its component, with which the message begins.
void check_image_size(const std::string& name, std::int64_t width, std::int64_t height);

// Returns the length of a file in bytes. Throws Error if it is missing or no regular file.
std::uint64_t length_of_file(const std::filesystem::path& path);

// Throws Error if `file_bytes`, compressed by `ratio` : 1, cannot hold `image_bytes`.
void check_file_can_hold(const std::string& name, std::uint64_t image_bytes,
                         std::uint64_t file_bytes, std::uint64_t ratio);

// Throws Error, which begins with `name` and names pixel and channel, if a component is no finite
// float32. Such pictures are neither written nor compared.
template <typename Real>
void require_finite(const std::string& name, const RgbaImage<Real>& image);

extern template void require_finite(const std::string&, const Image&);
extern template void require_finite(const std::string&, const PreciseImage&);

}  // namespace lamina
