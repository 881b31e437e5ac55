// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <variant>

#include "base/error.h"
#include "base/output_file.h"
#include "image/difference.h"
#include "image/npy.h"
#include "image/picture.h"
#include "image/png.h"
#include "lamina/image.h"

namespace lamina {
namespace {

PictureComparison compared(const Difference& difference) {
    ImageError error = measure(difference);
    return {std::move(error.channels), std::move(error.of_channel), error.all, error.worst.column,
            error.worst.row,           error.worst.channel};
}

void check_range(double range) {
    if (!(range > 0 && std::isfinite(range)))
        fail("range: found {}, expected a finite number above 0, in 1/255", range);
}

// Returns a picture with straight alpha as associated linear light.
PreciseImage associated(const CodedImage& coded) {
    PreciseImage image(coded.width, coded.height);
    const double most = coded.bit_depth == 16 ? 65535 : 255;
    for (std::size_t i = 0; i < image.rgba.size(); ++i) {
        const double alpha = coded.codes[i | 3] / most;
        image.rgba[i] = (i & 3) == 3 ? alpha : alpha * linear_from_srgb(coded.codes[i] / most);
    }
    return image;
}

}  // namespace

PictureComparison compare(const PreciseImage& a, const PreciseImage& b) {
    check_spaces(a.space, b.space);
    return compared(difference(a, b));
}

PictureComparison compare_files(const std::filesystem::path& a, const std::filesystem::path& b) {
    return compared(difference(load_image(a), load_image(b)));
}

std::string difference_png(const PreciseImage& a, const PreciseImage& b, double range) {
    check_range(range);
    return encode_png(difference_picture(difference(a, b), range));
}

std::vector<std::uint8_t> difference_codes(std::span<const float> differences, double range) {
    check_range(range);
    std::vector<std::uint8_t> codes;
    codes.reserve(3 * differences.size());
    for (const float e : differences) {
        if (std::isnan(e)) fail("difference {}: found nan, expected a number", codes.size() / 3);
        for (const std::uint16_t code : false_color_of(std::clamp(e / range, -1.0, 1.0)))
            codes.push_back(static_cast<std::uint8_t>(code));
    }
    return codes;
}

LoadedPicture load_picture(const std::filesystem::path& file) {
    LoadedImage loaded = load_image(file);
    LoadedPicture picture{{}, loaded.space};
    if (const auto* const pixels = std::get_if<Image>(&loaded.pixels))
        picture.image = to_double(*pixels);
    else if (auto* const precise = std::get_if<PreciseImage>(&loaded.pixels))
        picture.image = std::move(*precise);
    else if (const auto& coded = std::get<CodedImage>(loaded.pixels); coded.channels == 4)
        picture.image = associated(coded);
    else
        fail("{}: holds codes over a background, expected .exr, .npy or a .png with alpha",
             file.string());
    picture.image.space = picture.space.value_or(ImageColorSpace::linear);
    return picture;
}

void save_picture(const Image& picture, const std::filesystem::path& file, const PngLook& look,
                  const std::map<std::string, std::string>& attributes) {
    const std::string suffix = file.extension().string();
    if (suffix != ".png" && suffix != ".exr" && suffix != ".npy")
        fail("{}: {}", file.string(), refusal_of_suffix(suffix));
    AtomicFile output(file);
    write_picture(output, picture, look, attributes, picture.space);
    output.commit();
}

void save_picture(const PreciseImage& picture, const std::filesystem::path& file,
                  const PngLook& look, const std::map<std::string, std::string>& attributes) {
    if (file.extension() != ".npy") return save_picture(to_float(picture), file, look, attributes);
    AtomicFile output(file);
    write_npy(output, picture);
    output.commit();
}

std::string picture_png(const Image& picture, const PngLook& look) {
    return encode_png(picture, look, picture.space);
}

std::vector<std::uint8_t> screen_codes(const Image& picture, const glm::dvec3& background) {
    const CodedImage shown = coded_picture("picture", picture, background, picture.space).codes;
    return {shown.codes.begin(), shown.codes.end()};
}

}  // namespace lamina
