// SPDX-License-Identifier: Apache-2.0
#include "slicing/point_cover.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <limits>
#include <optional>

namespace lamina {
namespace {

// Number of bricks that are counted, in some 10 ms. If more have points, these are not rare.
constexpr std::size_t most_bricks = 1 << 16;

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

// Counts of rectangles, as differences from pixel to pixel until they are summed.
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

struct Box {
    glm::dvec3 lo, hi;  // index space
};

// The outermost bricks have half a sample more: the outer half voxels of "cell" axes.
Box box_of(const MinMaxBricks& bricks, std::size_t number, const Grid& grid) {
    auto rest = static_cast<std::int64_t>(number);
    glm::dvec3 lower;
    for (int axis = 0; axis < 3; ++axis) {
        const std::int64_t count = bricks.count[static_cast<std::size_t>(axis)];
        lower[axis] = static_cast<double>(rest % count * MinMaxBricks::edge);
        rest /= count;
    }
    return {glm::max(lower - 0.5, grid.index_min()),
            glm::min(lower + (MinMaxBricks::edge + 0.5), grid.index_max())};
}

struct Rectangle {
    glm::dvec2 first{std::numeric_limits<double>::infinity()}, last = -first;
};

// Returns the rectangle around a box in pixels, as View::ray takes them; none if part of the box is
// beside the eye: it would cover the picture.
std::optional<Rectangle> rectangle_around(const Box& box, const Grid& grid, const View& view) {
    const glm::dvec2 middle = 0.5 * glm::dvec2(view.width, view.height) - 0.5;
    Rectangle found;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 index((corner & 1) ? box.hi.x : box.lo.x,
                               (corner & 2) ? box.hi.y : box.lo.y,
                               (corner & 4) ? box.hi.z : box.lo.z);
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

}  // namespace lamina
