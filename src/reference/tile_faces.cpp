// SPDX-License-Identifier: Apache-2.0
#include "reference/tile_faces.h"

#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "mesh/norm1.h"

namespace lamina {
namespace {

// More are not listed: searching the tree is then better.
constexpr std::size_t most_listed = 1 << 16;

// Points whose tangent from the middle of the view is larger than this may be anywhere.
constexpr double widest = 1e3;

// A coordinate of a point, or of a line's place and direction, is off by at most some 8 epsilon of
// the distances (1-norm). The rest is to spare.
constexpr double place_error = 64 * std::numeric_limits<double>::epsilon(), spare_pixels = 1e-6;

std::array<glm::dvec3, 8> corners_of(const FaceTree::Box& box) {
    std::array<glm::dvec3, 8> corners;
    for (std::size_t i = 0; i < 8; ++i) {
        corners[i] = {i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y,
                      i & 4 ? box.max.z : box.min.z};
    }
    return corners;
}

}  // namespace

TileFaces::Pixels TileFaces::all() const {
    return {{0, 0}, {tile_.width - 1, tile_.height - 1}};
}

// Lines go on behind the eye. Points there are seen mirrored, so what lies on both sides of it may
// be anywhere.
template <std::size_t count>
TileFaces::Pixels TileFaces::pixels_around(const std::array<glm::dvec3, count>& points) const {
    const bool perspective = view_.projection == Projection::perspective;
    const glm::dvec2 origin(0.5 * view_.width - 0.5 - tile_.column,
                            0.5 * view_.height - 0.5 - tile_.row);
    glm::dvec2 least(INFINITY), most(-INFINITY);
    int behind = 0;
    for (const glm::dvec3& point : points) {
        const glm::dvec3 from = point - view_.eye;
        const double distance = norm1(from), depth = glm::dot(from, view_.forward);
        glm::dvec2 place(glm::dot(from, view_.right), -glm::dot(from, view_.up));
        double slack = place_error * (distance + norm1(view_.eye));
        if (perspective) {
            if (!(std::abs(depth) * widest > distance)) return all();
            behind += depth < 0;
            const double share = distance / std::abs(depth);
            place /= depth;
            slack = place_error * share * (1 + share);
        }
        place = place / view_.pixel + origin;
        slack = slack / view_.pixel + spare_pixels;
        least = glm::min(least, place - slack);
        most = glm::max(most, place + slack);
    }
    if (behind != 0 && behind != static_cast<int>(count)) return all();
    const glm::dvec2 end(tile_.width, tile_.height);
    return {glm::ivec2(glm::ceil(glm::clamp(least, glm::dvec2(0), end))),
            glm::ivec2(glm::floor(glm::clamp(most, glm::dvec2(-1), end - 1.0)))};
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
    const auto meets = [&](const FaceTree::Box& box) {
        return count <= most_listed && !pixels_around(corners_of(box)).empty();
    };
    const auto add = [&](std::int32_t face) {
        const Pixels pixels =
            pixels_around(mesh_.corners(mesh_.open_faces()[static_cast<std::size_t>(face)]));
        if (pixels.empty()) return;
        faces_.push_back({face, pixels});
        const glm::ivec2 size = pixels.last - pixels.first + 1;
        count += static_cast<std::size_t>(size.x * size.y);
    };
    tree_.visit(meets, add);
    if (count > most_listed) return false;
    // Until a pixel's list is filled, its end is its beginning.
    ends_.assign(static_cast<std::size_t>(tile.width * tile.height) + 1, 0);
    for_each_pixel([&](std::int32_t, std::size_t pixel) { ++ends_[pixel + 1]; });
    for (std::size_t i = 1; i < ends_.size(); ++i) ends_[i] += ends_[i - 1];
    listed_.resize(count);
    for_each_pixel([&](std::int32_t face, std::size_t pixel) { listed_[ends_[pixel]++] = face; });
    return true;
}

std::span<const std::int32_t> TileFaces::of(const glm::ivec2& pixel) const {
    const auto number =
        static_cast<std::size_t>((pixel.y - tile_.row) * tile_.width + (pixel.x - tile_.column));
    const std::size_t first = number == 0 ? 0 : ends_[number - 1];
    return std::span(listed_).subspan(first, ends_[number] - first);
}

}  // namespace lamina
