// SPDX-License-Identifier: Apache-2.0
#include "slicing/trial_truth.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "base/profile.h"
#include "compositing/codes.h"
#include "facts/volume_facts.h"

namespace lamina {
namespace {

// Number of bricks that are counted, which takes some 10 ms. If more bricks have points, points are
// not rare, and a sample of the bricks is enough.
constexpr std::size_t most_bricks = 1 << 16;

// Returns the min/max bricks in which the scalar passes a point of the transfer function.
std::vector<std::size_t> bricks_with_points(const MinMaxBricks& bricks,
                                            const TransferFunction& transfer_function) {
    const auto knots = transfer_function.knots();
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < bricks.ranges.size(); ++i) {
        const ValueRange range = bricks.range(i);
        const auto point = std::ranges::lower_bound(knots, range.lo, {}, &TransferKnot::value);
        if (range.lo < range.hi && point != knots.end() && point->value <= range.hi)
            found.push_back(i);
    }
    return found;
}

// Counts the rectangles over each pixel: add() changes four corners, sums() adds along both axes.
class RectangleCounts {
  public:
    RectangleCounts(int width, int height)
        : width_(width),
          height_(height),
          counts_(static_cast<std::size_t>(width + 1) * static_cast<std::size_t>(height + 1)) {}

    // Adds pixels first .. last, inclusive on both axes.
    void add(glm::ivec2 first, glm::ivec2 last) {
        first = glm::max(first, glm::ivec2(0));
        last = glm::min(last, glm::ivec2(width_ - 1, height_ - 1));
        if (first.x > last.x || first.y > last.y) return;
        at(first.x, first.y) += 1;
        at(last.x + 1, first.y) -= 1;
        at(first.x, last.y + 1) -= 1;
        at(last.x + 1, last.y + 1) += 1;
    }

    std::vector<float> sums() {
        std::vector<float> sums;
        sums.reserve(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
        for (int row = 0; row < height_; ++row) {
            std::int32_t sum = 0;
            for (int column = 0; column < width_; ++column) {
                if (row > 0) at(column, row) += at(column, row - 1);
                sum += at(column, row);
                sums.push_back(static_cast<float>(sum));
            }
        }
        return sums;
    }

  private:
    std::int32_t& at(int column, int row) {
        return counts_[static_cast<std::size_t>(row) * static_cast<std::size_t>(width_ + 1) +
                       static_cast<std::size_t>(column)];
    }

    int width_, height_;
    std::vector<std::int32_t> counts_;
};

// Returns a min/max brick's box, a voxel larger: `cell` axes draw half as much beyond samples, or
// as much if lookup is nearest.
IndexBox box_of(const MinMaxBricks& bricks, std::size_t number, const Grid& grid) {
    auto rest = static_cast<std::int64_t>(number);
    glm::dvec3 lower;
    for (int axis = 0; axis < 3; ++axis) {
        const std::int64_t count = bricks.count[static_cast<std::size_t>(axis)];
        lower[axis] = static_cast<double>(rest % count * MinMaxBricks::edge);
        rest /= count;
    }
    const double beyond = grid.lookup == VolumeLookup::nearest ? 1 : 0.5;
    return {glm::max(lower - beyond, grid.index_min()),
            glm::min(lower + (MinMaxBricks::edge + beyond), grid.index_max())};
}

// A rectangle in pixels; empty at first.
struct Rectangle {
    glm::dvec2 first{std::numeric_limits<double>::infinity()}, last = -first;
};

// Returns the rectangle around a box, in pixel coordinates of View::ray(); none if part of the box
// is not in front of the eye, because then the rectangle would cover the picture.
std::optional<Rectangle> rectangle_around(const IndexBox& box, const Grid& grid, const View& view) {
    const glm::dvec2 middle = 0.5 * glm::dvec2(view.width, view.height) - 0.5;
    Rectangle found;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 index((corner & 1) ? box.max.x : box.min.x,
                               (corner & 2) ? box.max.y : box.min.y,
                               (corner & 4) ? box.max.z : box.min.z);
        const glm::dvec3 seen = grid.to_world(index) - view.eye;
        const double z = glm::dot(seen, view.forward);
        if (!(z > 0)) return std::nullopt;
        const double scale =
            1 / (view.pixel * (view.projection == Projection::perspective ? z : 1));
        const glm::dvec2 pixel =
            middle + scale * glm::dvec2(glm::dot(seen, view.right), -glm::dot(seen, view.up));
        found.first = glm::min(found.first, pixel);
        found.last = glm::max(found.last, pixel);
    }
    return found;
}

double difference_of(const float* a, const float* b) {
    double largest = 0;
    for (int channel = 0; channel < 4; ++channel)
        largest = std::max(largest, std::abs(double{a[channel]} - double{b[channel]}));
    return largest;
}

// Returns the largest difference of a channel from one of the four neighbours, for each pixel.
std::vector<float> contrasts_of(const Image& picture) {
    std::vector<float> contrasts(static_cast<std::size_t>(picture.width) *
                                 static_cast<std::size_t>(picture.height));
    const auto compare = [&](int column, int row, int right, int down) {
        const auto place = [&](int x, int y) {
            return static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) +
                   static_cast<std::size_t>(x);
        };
        const auto contrast = static_cast<float>(
            difference_of(picture.pixel(column, row), picture.pixel(column + right, row + down)));
        for (float* const pixel :
             {&contrasts[place(column, row)], &contrasts[place(column + right, row + down)]})
            *pixel = std::max(*pixel, contrast);
    };
    for (int row = 0; row < picture.height; ++row) {
        for (int column = 0; column < picture.width; ++column) {
            if (column + 1 < picture.width) compare(column, row, 1, 0);
            if (row + 1 < picture.height) compare(column, row, 0, 1);
        }
    }
    return contrasts;
}

// Returns one pixel, chosen at random, of each square of `edge` x `edge` pixels.
std::vector<glm::ivec2> pixels_all_over(int width, int height, int edge) {
    std::vector<glm::ivec2> pixels;
    for (int row = 0; row < height; row += edge) {
        for (int column = 0; column < width; column += edge) {
            const std::uint32_t bits = random_bits(static_cast<std::uint32_t>(column),
                                                   static_cast<std::uint32_t>(row), 0, 0);
            const auto across = static_cast<std::uint32_t>(std::min(edge, width - column));
            const auto down = static_cast<std::uint32_t>(std::min(edge, height - row));
            pixels.emplace_back(column + static_cast<int>((bits & 0xffff) % across),
                                row + static_cast<int>((bits >> 16) % down));
        }
    }
    return pixels;
}

std::vector<float> differences_of(const Image& a, const Image& b) {
    std::vector<float> differences;
    differences.reserve(a.rgba.size() / 4);
    for (std::size_t i = 0; i < a.rgba.size(); i += 4)
        differences.push_back(static_cast<float>(difference_of(&a.rgba[i], &b.rgba[i])));
    return differences;
}

// Returns for each pixel 1 / the number of bricks that cover it, times a random factor of 1/2 to 1
// that parts equal numbers; 0 if no brick covers it.
std::vector<float> rarity_of(const std::vector<float>& cover, int width) {
    std::vector<float> rarity;
    rarity.reserve(cover.size());
    for (std::size_t i = 0; i < cover.size(); ++i) {
        const auto pixel = static_cast<std::uint32_t>(i);
        const auto columns = static_cast<std::uint32_t>(width);
        const std::uint32_t bits = random_bits(pixel % columns, pixel / columns, 1, 0);
        const float share = static_cast<float>(bits) * 0x1p-32f;
        rarity.push_back(cover[i] > 0 ? 1 / (cover[i] * (1 + share)) : 0);
    }
    return rarity;
}

// Appends the `count` pixels with the largest values, or fewer if not as many are above 0.
void append_largest(std::size_t count, int picture_width, const std::vector<float>& values,
                    std::vector<glm::ivec2>& pixels) {
    std::vector<std::size_t> order(values.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto larger = [&](std::size_t a, std::size_t b) {
        return values[a] != values[b] ? values[a] > values[b] : a < b;
    };
    count = std::min(count, static_cast<std::size_t>(
                                std::ranges::count_if(values, [](float v) { return v > 0; })));
    std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count), order.end(),
                     larger);
    const auto width = static_cast<std::size_t>(picture_width);
    for (std::size_t i = 0; i < count; ++i)
        pixels.emplace_back(static_cast<int>(order[i] % width), static_cast<int>(order[i] / width));
}

}  // namespace

std::vector<float> cover_of_points(const MinMaxBricks& bricks, const Grid& grid,
                                   const TransferFunction& transfer_function, const View& view) {
    const std::vector<std::size_t> found = bricks_with_points(bricks, transfer_function);
    const std::size_t stride = found.size() / most_bricks + 1;
    const glm::dvec2 end(view.width, view.height);
    RectangleCounts counts(view.width, view.height);
    for (std::size_t i = 0; i < found.size(); i += stride) {
        const auto around = rectangle_around(box_of(bricks, found[i], grid), grid, view);
        if (!around) continue;
        counts.add(glm::ivec2(glm::clamp(glm::floor(around->first), glm::dvec2(-1), end)),
                   glm::ivec2(glm::clamp(glm::ceil(around->last), glm::dvec2(-1), end)));
    }
    return counts.sums();
}

TrialTruth::TrialTruth(const Volume& volume, const TransferFunction& transfer_function,
                       const View& view, TraceOptions options)
    : volume_(volume),
      transfer_function_(transfer_function),
      view_(view),
      options_(std::move(options)) {}

void TrialTruth::trace_all() {
    pixels_ = pixels_all_over(view_.width, view_.height, 1);
    trace();
}

void TrialTruth::trace_some(std::size_t count, const Image& picture, const Image& finer,
                            const std::vector<float>& cover) {
    const double pixels = static_cast<double>(view_.width) * view_.height;
    const double edge = std::ceil(std::sqrt(pixels / (static_cast<double>(count) / 4)));
    pixels_ = pixels_all_over(view_.width, view_.height, static_cast<int>(edge));
    append_unknown(count / 4, differences_of(picture, finer));
    append_unknown(count / 4, rarity_of(cover, view_.width));
    append_unknown(count - std::min(count, pixels_.size()), contrasts_of(finer));
    trace();
}

void TrialTruth::append_unknown(std::size_t count, std::vector<float> values) {
    if (values.empty()) return;
    for (const glm::ivec2& pixel : pixels_) {
        values[static_cast<std::size_t>(pixel.y) * static_cast<std::size_t>(view_.width) +
               static_cast<std::size_t>(pixel.x)] = 0;
    }
    append_largest(count, view_.width, values, pixels_);
}

void TrialTruth::trace() {
    const Stage tracing("trace trial rays");
    traced_ = trace_pixels(volume_, transfer_function_, view_, pixels_, options_);
}

double TrialTruth::error_of(const Image& picture) const {
    double largest = 0;
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
        const float* const drawn = picture.pixel(pixels_[i].x, pixels_[i].y);
        for (int channel = 0; channel < 4; ++channel)
            largest = std::max(largest, std::abs(drawn[channel] - traced_.rgba[i][channel]));
    }
    return 255 * (largest + traced_.error_estimate);
}

}  // namespace lamina
