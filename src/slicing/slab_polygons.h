// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "scene/camera.h"
#include "scene/facts.h"
#include "scene/scene.h"
#include "volume/grid.h"

namespace lamina {

// N slabs of equal thickness perpendicular to the view direction, slab 0 nearest the eye. Depths
// are eye-space z.
struct Slabs {
    double near = 0;
    double far = 0;
    int count = 1;

    double depth(int boundary) const {
        return boundary == count ? far : near + (far - near) * boundary / count;
    }
};

// A corner of a triangle: pixel coordinates (column to the right, row downwards from the image's
// top, pixel centres at half integers), and the depths of its slab relative to Slabs::near.
struct SlabVertex {
    float column, row;
    float front, back;
};

// Appends triangles that cover every pixel whose ray meets the part of `box` (index space) inside
// each slab, with each pixel centre in at most one triangle of a slab. They may cover a little
// more: the fragment's own ray decides.
void append_slab_polygons(const View& view, const Grid& grid, const IndexBox& box,
                          const Slabs& slabs, Order order, std::vector<SlabVertex>& triangles);

}  // namespace lamina
