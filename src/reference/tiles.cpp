// SPDX-License-Identifier: Apache-2.0
#include "reference/tiles.h"

#include <atomic>
#include <mutex>

#include "base/client.h"
#include "base/error.h"
#include "base/parallel.h"
#include "mesh/face_tree.h"
#include "mesh/predicates.h"
#include "mesh/tet_mesh.h"

namespace lamina {
namespace {

// Tangent of the angle from the view's middle above which a point counts as seen by all pixels.
constexpr double widest = 1e3;

// Bounds on errors of projected points. Points, and origins and directions of lines, err by 8
// epsilons of the 1-norms of point, eye, origin. The rest of 64, and 1e-6 pixels, are a reserve.
constexpr double place_error = 64 * std::numeric_limits<double>::epsilon(), spare_pixels = 1e-6;
constexpr double least_error = 64 * std::numeric_limits<double>::denorm_min();

// Returns how far the view's axes are from orthonormal (1e-8 if `up` is nearly along the view).
double skew_of(const View& view) {
    const auto off = [](const glm::dvec3& a, const glm::dvec3& b, double expected) {
        return std::abs(glm::dot(a, b) - expected);
    };
    return std::max({off(view.right, view.forward, 0), off(view.up, view.forward, 0),
                     off(view.right, view.up, 0), off(view.right, view.right, 1),
                     off(view.up, view.up, 1), off(view.forward, view.forward, 1)});
}

// Number of entries in all lists above which searching the tree is quicker than listing faces.
constexpr std::size_t most_listed = 1 << 16;

}  // namespace

void check(const TraceOptions& options) {
    if (!(options.tolerance >= TraceOptions::smallest_tolerance && options.tolerance <= 1)) {
        fail("render.trace.tolerance: {} is out of range, expected {} to 1", options.tolerance,
             TraceOptions::smallest_tolerance);
    }
    if (options.lighting && options.lighting->smallest_gradient.is_automatic()) {
        fail(
            "lighting.smallest_gradient: is \"auto\", expected a number: it has not been chosen "
            "from the data");
    }
}

std::vector<PictureTile> tiles_to_trace(int width, int height) {
    constexpr int edge = 32;
    std::vector<PictureTile> tiles;
    for (int row = 0; row < height; row += edge)
        for (int column = 0; column < width; column += edge)
            tiles.push_back(
                {column, row, std::min(edge, width - column), std::min(edge, height - row)});
    // Returns the square of twice the distance between the middles of a tile and of the picture.
    const auto distance = [&](const PictureTile& tile) {
        const std::int64_t across = 2 * tile.column + tile.width - width;
        const std::int64_t down = 2 * tile.row + tile.height - height;
        return across * across + down * down;
    };
    std::ranges::stable_sort(tiles, {}, distance);
    return tiles;
}

void TraceTotals::add(const TraceTotals& other) {
    error_estimate = std::max(error_estimate, other.error_estimate);
    segments += other.segments;
    overlapping_rays += other.overlapping_rays;
}

TraceResult trace_tiles(
    const View& view,
    const std::function<TraceTotals(const PictureTile&, PreciseImage&, const RowDone&)>& trace,
    const TileDone& done) {
    TraceResult result{{}, PreciseImage(view.width, view.height)};
    const std::vector<PictureTile> tiles = tiles_to_trace(view.width, view.height);
    std::int64_t rows = 0;
    for (const PictureTile& tile : tiles) rows += tile.height;
    Progress progress("tracing", rows);
    std::atomic<std::size_t> next{0};  // parallel_for() gives its numbers in no order
    std::mutex telling;
    parallel_for(std::ssize(tiles), 1, [&](std::int64_t) {
        const PictureTile& tile = tiles[next++];
        // Progress counts rows, because a tile may take minutes. Empty rows are counted at the end.
        std::int64_t left = tile.height;
        const TraceTotals totals = trace(tile, result.image, [&] {
            if (left == 0) return;
            --left;
            progress.advance();
        });
        {
            const std::lock_guard lock(telling);
            result.add(totals);
            if (done) done(tile, result.image);
        }
        progress.advance(left);
    });
    return result;
}

TileSight::TileSight(const View& view, const PictureTile& tile)
    : view_(view),
      size_(tile.width, tile.height),
      middle_(0.5 * view.width - 0.5 - tile.column, 0.5 * view.height - 0.5 - tile.row),
      error_(place_error + 8 * skew_of(view)),
      eye_norm_(norm1(view.eye)) {}

// Projection mirrors points behind the eye. If points lie on both sides, all pixels may see them.
SeenPixels TileSight::around(std::span<const glm::dvec3> points) const {
    const SeenPixels all{{0, 0}, size_ - 1};
    const bool perspective = view_.projection == Projection::perspective;
    glm::dvec2 least(INFINITY), most(-INFINITY);
    std::size_t behind = 0;
    for (const glm::dvec3& point : points) {
        const glm::dvec3 from = point - view_.eye;
        const double distance = norm1(from), depth = glm::dot(from, view_.forward);
        glm::dvec2 place(glm::dot(from, view_.right), -glm::dot(from, view_.up));
        double slack = error_ * (distance + eye_norm_) + least_error;
        if (perspective) {
            if (!(std::abs(depth) * widest > distance)) return all;
            behind += depth < 0;
            place /= depth;
            slack *= (1 + distance / std::abs(depth)) / std::abs(depth);
        }
        place = place / view_.pixel + middle_;
        slack = slack / view_.pixel + spare_pixels;
        if (!std::isfinite(place.x + place.y + slack)) return all;
        least = glm::min(least, place - slack);
        most = glm::max(most, place + slack);
    }
    if (behind != 0 && behind != points.size()) return all;
    return {glm::ivec2(glm::ceil(glm::clamp(least, glm::dvec2(0), glm::dvec2(size_)))),
            glm::ivec2(glm::floor(glm::clamp(most, glm::dvec2(-1), glm::dvec2(size_ - 1))))};
}

template <typename Visit>
void TileFaces::for_each_pixel(const Visit& visit) const {
    for (const auto& [face, pixels] : faces_) {
        for (int row = pixels.first.y; row <= pixels.last.y; ++row) {
            for (int column = pixels.first.x; column <= pixels.last.x; ++column)
                visit(face, static_cast<std::size_t>(row * tile_.width + column));
        }
    }
}

bool TileFaces::list(const PictureTile& tile) {
    tile_ = tile;
    faces_.clear();
    std::size_t count = 0;
    const TileSight sight(view_, tile);
    const auto meets = [&](const FaceTree::Box& box) {
        return count <= most_listed && !sight.around(box_corners(box.min, box.max)).empty();
    };
    const auto add = [&](std::int32_t face) {
        const SeenPixels pixels = sight.around(mesh_.corners(mesh_.open_faces()[face]));
        if (pixels.empty()) return;
        faces_.push_back({face, pixels});
        const glm::ivec2 size = pixels.last - pixels.first + 1;
        count += static_cast<std::size_t>(size.x * size.y);
    };
    tree_.visit(meets, add);
    if (count > most_listed) return false;
    const auto pixels = static_cast<std::size_t>(tile.width * tile.height);
    std::vector<std::size_t> lengths(pixels, 0), filled(pixels, 0);
    for_each_pixel([&](std::int32_t, std::size_t pixel) { ++lengths[pixel]; });
    begins_.assign(1, 0);
    for (const std::size_t length : lengths) begins_.push_back(begins_.back() + length);
    listed_.resize(count);
    for_each_pixel([&](std::int32_t face, std::size_t pixel) {
        listed_[begins_[pixel] + filled[pixel]++] = face;
    });
    return true;
}

std::span<const std::int32_t> TileFaces::of(const glm::ivec2& pixel) const {
    const auto number =
        static_cast<std::size_t>((pixel.y - tile_.row) * tile_.width + (pixel.x - tile_.column));
    return std::span(listed_).subspan(begins_[number], begins_[number + 1] - begins_[number]);
}

}  // namespace lamina
