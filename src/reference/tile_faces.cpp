// SPDX-License-Identifier: Apache-2.0
#include "reference/tile_faces.h"

#include "mesh/box_corners.h"

namespace lamina {
namespace {

// More are not listed: searching the tree is then better.
constexpr std::size_t most_listed = 1 << 16;

}  // namespace

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
        const SeenPixels pixels =
            sight.around(mesh_.corners(mesh_.open_faces()[static_cast<std::size_t>(face)]));
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
