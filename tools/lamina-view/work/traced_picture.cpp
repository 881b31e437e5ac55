// SPDX-License-Identifier: Apache-2.0
#include "work/traced_picture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "lamina/picture_file.h"

namespace lamina::view {

TracedPicture::TracedPicture(std::shared_ptr<const Image> full,
                             std::shared_ptr<const ScreenPicture> screen, const Scene& scene)
    : full_(std::move(full)), background_(scene.background), space_(scene.color_space) {
    if (full_)
        missed_ = {
            full_->width, full_->height,
            std::vector<float>(full_->rgba.size() / 4, std::numeric_limits<float>::quiet_NaN())};
    if (screen && screen->width == scene.width && screen->height == scene.height) {
        screen_ = *screen;
        return;
    }
    screen_.width = scene.width;
    screen_.height = scene.height;
    screen_.rgb.resize(3 * static_cast<std::size_t>(scene.width) *
                       static_cast<std::size_t>(scene.height));
}

void TracedPicture::add(const PictureTile& tile, const PreciseImage& truth) {
    Image traced(tile.width, tile.height);
    for (int row = 0; row < tile.height; ++row) {
        const double* const from = truth.pixel(tile.column, tile.row + row);
        std::transform(from, from + 4 * tile.width, traced.pixel(0, row),
                       [](double number) { return static_cast<float>(number); });
        if (full_) measure(tile, traced, row);
    }
    const std::vector<std::uint8_t> codes = screen_codes(traced, background_, space_);
    const auto line = static_cast<std::ptrdiff_t>(3 * tile.width);
    for (std::ptrdiff_t row = 0; row < tile.height; ++row) {
        const std::ptrdiff_t to =
            3 * (static_cast<std::ptrdiff_t>(tile.row + row) * screen_.width + tile.column);
        std::copy_n(codes.begin() + row * line, line, screen_.rgb.begin() + to);
    }
    pixels_ += static_cast<std::int64_t>(tile.width) * tile.height;
}

void TracedPicture::measure(const PictureTile& tile, const Image& traced, int row) {
    const float* const full = full_->pixel(tile.column, tile.row + row);
    const float* const truth = traced.pixel(0, row);
    float* const missed =
        &missed_
             .e[static_cast<std::size_t>(tile.row + row) * static_cast<std::size_t>(missed_.width) +
                static_cast<std::size_t>(tile.column)];
    for (int i = 0; i < traced.width; ++i)
        missed[i] = largest_difference(full + 4 * i, truth + 4 * i);
    for (int i = 0; i < 4 * traced.width; ++i) {
        const double e = 255 * (static_cast<double>(full[i]) - static_cast<double>(truth[i]));
        largest_ = std::max(largest_, std::abs(e));
        sum_ += e;
        squares_ += e * e;
    }
}

double TracedPicture::share() const {
    return static_cast<double>(pixels_) / (static_cast<double>(screen_.width) * screen_.height);
}

ErrorNorms TracedPicture::error() const {
    if (pixels_ == 0) return {};
    const double numbers = 4 * static_cast<double>(pixels_);
    return {largest_, sum_ / numbers, std::sqrt(squares_ / numbers)};
}

}  // namespace lamina::view
