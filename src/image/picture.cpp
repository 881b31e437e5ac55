// SPDX-License-Identifier: Apache-2.0
#include "image/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <type_traits>

#include "base/error.h"
#include "image/exr.h"
#include "image/image_limits.h"
#include "image/npy.h"
#include "image/png.h"

namespace lamina {

namespace {

template <typename Real>
LoadedImage finite(std::string name, RgbaImage<Real> image) {
    require_finite(name, image);
    return {std::move(name), std::move(image), {}};
}

LoadedImage load_exr(const std::filesystem::path& path) {
    LoadedImage image = finite(path.string(), read_exr(path));
    image.space = color_space_of_exr(path);
    return image;
}

template <typename A, typename B>
Difference pixel_difference(const A& a, const B& b) {
    constexpr bool coded_a = std::is_same_v<A, CodedImage>;
    constexpr bool coded_b = std::is_same_v<B, CodedImage>;
    if constexpr (coded_a == coded_b)
        return difference(a, b);
    else
        fail(
            "a PNG holds sRGB codes over a background, EXR and NPY hold linear light before any "
            "background; compare PNG with PNG, EXR and NPY with each other");
}

}  // namespace

std::string lower_suffix(const std::filesystem::path& path) {
    std::string suffix = path.extension().string();
    std::ranges::transform(suffix, suffix.begin(), [](unsigned char letter) {
        return static_cast<char>(std::tolower(letter));
    });
    return suffix;
}

std::string refusal_of_suffix(const std::string& suffix) {
    const std::string lower = lower_suffix("picture" + suffix);
    const bool jpeg = lower == ".jpg" || lower == ".jpeg";
    return fmt::format("found the suffix \"{}\"{}, expected .png, .exr or .npy", suffix,
                       jpeg ? ": JPEG would add errors that lamina cannot state" : "");
}

LoadedImage load_image(const std::filesystem::path& path) {
    const std::string suffix = lower_suffix(path);
    if (suffix == ".exr") return load_exr(path);
    if (suffix == ".npy") return finite(path.string(), read_npy(path));
    if (suffix == ".png") return {path.string(), read_png(path), {}};
    fail("{}: suffix '{}'; expected .exr, .npy or .png", path.string(), suffix);
}

Difference difference(const LoadedImage& a, const LoadedImage& b) {
    if (a.space && b.space && *a.space != *b.space) {
        fail(
            "{}, {}: one holds linear light, the other display values (image.color_space); "
            "expected the same of both",
            a.name, b.name);
    }
    try {
        return std::visit([](const auto& x, const auto& y) { return pixel_difference(x, y); },
                          a.pixels, b.pixels);
    } catch (const Error& error) {
        fail("{}, {}: {}", a.name, b.name, error.what());
    }
}

std::size_t write_picture(OutputFile& file, const Image& image, const PngLook& look,
                          const std::map<std::string, std::string>& attributes,
                          ImageColorSpace space) {
    const std::filesystem::path suffix = file.path().extension();
    if (suffix == ".png") return write_png(file, image, look, space);
    if (suffix == ".npy")
        write_npy(file, image);
    else
        write_exr(file, image, attributes, space);
    return 0;
}

}  // namespace lamina
