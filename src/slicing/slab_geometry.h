// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <vector>

#include "compositing/tree_shape.h"
#include "facts/volume_facts.h"
#include "lamina/scene.h"
#include "lamina/volume.h"
#include "plan/plan.h"
#include "scene/camera.h"
#include "tiles/tile_image.h"

namespace lamina {

// Returns the box, in the volume's index space, that a brick of the plan draws: from its first to
// its last samples, and beyond them up to the volume's border if the brick reaches the last ones.
IndexBox box_of(const TextureBrick& brick, const Grid& grid);

// A coordinate beyond all others, the largest float: it says that a box has no last face.
inline constexpr glm::dvec3 no_last_face{double{std::numeric_limits<float>::max()}};

// Returns the last face (largest coordinate) of a brick on each axis, in its own index space, if
// the volume ends there, else no_last_face. `end`: its largest coordinates; `first`: the sample at
// its origin. The volume's box is closed: rays in its faces are inside, as in the reference tracer.
// Rays in a face between two bricks belong to the one that begins there.
glm::dvec3 last_face_of(const glm::dvec3& end, const glm::dvec3& first, const Grid& grid);

// A row of a brick along x. Its samples begin .. end - 1 are samples of the volume, from flat index
// `first` on; the others repeat the nearest of these.
struct BrickRow {
    std::size_t first;
    std::int64_t begin, end;

    template <typename Texel>
    void repeat_ends(Texel* row, std::int64_t size) const {
        std::fill(row, row + begin, row[begin]);
        std::fill(row + end, row + size, row[end - 1]);
    }
};
BrickRow row_of(const TextureBrick& brick, const Grid& grid, std::int64_t y, std::int64_t z);

// Sets `numbers` to the bricks' indices, in `order` along every ray. Allocates only if it grows.
void set_visibility_order(const std::vector<TextureBrick>& bricks, const Grid& grid,
                          const View& view, Order order, std::vector<std::size_t>& numbers);

// A rectangle of pixels; end_column and end_row are not part of it.
struct PixelBox {
    int first_column = 0, end_column = 0, first_row = 0, end_row = 0;

    bool meets(const TileGrid::Tile& tile) const {
        return tile.column < end_column && tile.column + TileGrid::edge > first_column &&
               tile.row < end_row && tile.row + TileGrid::edge > first_row;
    }
    PixelBox joined(const PixelBox& other) const;
    PixelBox common(const PixelBox& other) const;
};

// Returns the pixels whose rays meet a box of the grid's index space, and some around them.
PixelBox pixels_of(const IndexBox& box, const Grid& grid, const View& view);

// Equally thick slabs perpendicular to the view direction, nearest first. Depths: eye-space z.
struct Slabs {
    double near = 0;
    double far = 0;
    int count = 1;

    double depth(int boundary) const {
        return boundary == count ? far : near + (far - near) * boundary / count;
    }
};

// A corner of a triangle: pixel coordinates (column to the right, row downwards from the image's
// top, pixel centres at half integers) and the number of its slab.
struct SlabVertex {
    float column, row;
    float slab;
};

// Appends each slab's triangles, in drawing order. They cover every pixel whose ray meets `box`
// (index space) in the slab exactly once, and some more: shaders clip each ray to the box. If
// `starts` is given, it gets the number of vertices before each slab and, last, after all slabs.
void append_slab_polygons(const View& view, const Grid& grid, const IndexBox& box,
                          const Slabs& slabs, Order order, std::vector<SlabVertex>& triangles,
                          std::vector<std::size_t>* starts = nullptr);

}  // namespace lamina
