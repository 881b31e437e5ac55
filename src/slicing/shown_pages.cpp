// SPDX-License-Identifier: Apache-2.0
#include "slicing/shown_pages.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "base/parallel.h"

namespace lamina {
namespace {

// The pages on one axis that hold cells of a brick.
struct PageSpan {
    std::int64_t first, last;
};
PageSpan pages_of_brick(std::int64_t brick, std::int64_t first_sample, std::int64_t pages) {
    constexpr std::int64_t edge = MinMaxBricks::edge;
    const std::int64_t begin = brick * edge - first_sample;
    // The outermost bricks also stand for everything beyond the samples.
    const std::int64_t from = brick == 0 ? 0 : begin / BrickCache::edge;
    const std::int64_t to = (begin + edge) / BrickCache::edge;
    return {std::min(from, pages - 1), std::min(to, pages - 1)};
}

// The bricks on one axis that touch a share, or a page.
struct BrickSpan {
    std::int64_t first, end;
};
BrickSpan bricks_of(const std::optional<IndexBox>& share, int axis,
                    const OccupiedBricks& occupied) {
    const std::int64_t count = occupied.count[static_cast<std::size_t>(axis)];
    if (!share) return {0, count};
    const auto brick_at = [&](double place) {
        const double brick = std::floor(place / double{MinMaxBricks::edge});
        return static_cast<std::int64_t>(std::clamp(brick, 0.0, static_cast<double>(count)));
    };
    return {std::min(brick_at(share->min[axis]), count - 1),
            std::min(brick_at(share->max[axis]) + 1, count)};
}

// Returns for each page on one axis its bricks among those of `span`; none if first = end.
std::vector<BrickSpan> bricks_of_pages(const BrickSpan& span, std::int64_t first_sample,
                                       std::int64_t pages) {
    std::vector<BrickSpan> bricks(static_cast<std::size_t>(pages), {0, 0});
    for (std::int64_t brick = span.first; brick < span.end; ++brick) {
        const PageSpan touched = pages_of_brick(brick, first_sample, pages);
        for (std::int64_t page = touched.first; page <= touched.last; ++page) {
            BrickSpan& of_page = bricks[static_cast<std::size_t>(page)];
            if (of_page.end == 0) of_page.first = brick;
            of_page.end = brick + 1;
        }
    }
    return bricks;
}

// Returns how far a point lies outside each of a view's five planes: behind the eye, and beside the
// picture's edges by a pixel and more. Below 0: inside.
std::array<double, 5> outside_of(const View& view, const glm::dvec3& point) {
    const glm::dvec3 way = point - view.eye;
    const double depth = glm::dot(way, view.forward);
    const double across = glm::dot(way, view.right), up = glm::dot(way, view.up);
    const double scale = view.projection == Projection::perspective ? depth : 1;
    const double half_width = (0.5 * view.width + 1) * view.pixel * scale;
    const double half_height = (0.5 * view.height + 1) * view.pixel * scale;
    return {-depth, across - half_width, -across - half_width, up - half_height, -up - half_height};
}

}  // namespace

std::vector<std::uint32_t> pages_shown(const TileVolume& volume, const OccupiedBricks& occupied,
                                       const std::optional<IndexBox>& share) {
    const BrickCache& cache = *volume.pages();
    const auto& count = cache.count();
    std::array<std::vector<BrickSpan>, 3> bricks;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        bricks[axis] = bricks_of_pages(bricks_of(share, static_cast<int>(axis), occupied),
                                       volume.first_of_pages()[axis], count[axis]);
    }
    std::vector<std::uint8_t> shown(cache.brick_count());
    parallel_for(std::ssize(bricks[2]), 1, [&](std::int64_t z) {
        const BrickSpan deep = bricks[2][static_cast<std::size_t>(z)];
        for (std::size_t y = 0; y < bricks[1].size(); ++y) {
            for (std::size_t x = 0; x < bricks[0].size(); ++x) {
                const BrickSpan across = bricks[0][x], along = bricks[1][y];
                shown[cache.number(static_cast<std::int64_t>(x), static_cast<std::int64_t>(y), z)] =
                    occupied.any_of({across.first, along.first, deep.first},
                                    {across.end - 1, along.end - 1, deep.end - 1});
            }
        }
    });
    std::vector<std::uint32_t> numbers;
    for (std::uint32_t page = 0; page < shown.size(); ++page)
        if (shown[page] != 0) numbers.push_back(page);
    return numbers;
}

std::vector<std::uint32_t> pages_seen(const std::vector<std::uint32_t>& pages,
                                      const std::array<std::int64_t, 3>& count,
                                      const std::array<std::int64_t, 3>& first, const Grid& grid,
                                      const View& view) {
    std::vector<std::uint32_t> seen;
    for (const std::uint32_t page : pages) {
        const glm::dvec3 place{page % count[0], page / count[0] % count[1],
                               page / (count[0] * count[1])};
        const glm::dvec3 begin =
            glm::dvec3(first[0], first[1], first[2]) + place * double{BrickCache::edge};
        std::array<double, 5> least;
        least.fill(1);
        for (int corner = 0; corner < 8; ++corner) {
            // One sample more on each side covers everything beyond the volume's samples.
            const glm::dvec3 step{corner & 1, corner >> 1 & 1, corner >> 2};
            const glm::dvec3 at = begin - 1.0 + step * double(BrickCache::edge + 2);
            const auto outside = outside_of(view, grid.to_world(at));
            for (std::size_t i = 0; i < least.size(); ++i)
                least[i] = corner == 0 ? outside[i] : std::min(least[i], outside[i]);
        }
        if (std::ranges::all_of(least, [](double by) { return by <= 0; })) seen.push_back(page);
    }
    return seen;
}

}  // namespace lamina
