// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "mesh/face_tree.h"
#include "reference/seen_pixels.h"
#include "reference/trace_tiles.h"
#include "scene/camera.h"

namespace lamina {

// The open faces that the lines of a tile's pixels may meet: they are found once for the tile, so
// that each line need not search the tree.
class TileFaces {
  public:
    TileFaces(const TetMesh& mesh, const FaceTree& open_faces, const View& view)
        : mesh_(mesh), tree_(open_faces), view_(view) {}

    // Lists the faces of a tile. Returns false where there are too many to be listed.
    bool list(const PictureTile& tile);

    // Indices into the mesh's open faces, of a pixel of the picture in the tile that was listed.
    std::span<const std::int32_t> of(const glm::ivec2& pixel) const;

  private:
    struct ListedFace {
        std::int32_t face;
        SeenPixels pixels;
    };
    template <typename Visit>
    void for_each_pixel(const Visit& visit) const;

    const TetMesh& mesh_;
    const FaceTree& tree_;
    const View& view_;
    PictureTile tile_{};
    std::vector<ListedFace> faces_;
    std::vector<std::int32_t> listed_;  // pixel by pixel
    std::vector<std::size_t> ends_;     // of the pixels' lists
};

}  // namespace lamina
