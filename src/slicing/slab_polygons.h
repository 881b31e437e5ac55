// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "compositing/tree_shape.h"
#include "facts/facts.h"
#include "lamina/grid.h"
#include "lamina/scene.h"
#include "scene/camera.h"

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
// top, pixel centres at half integers), and the number of its slab.
struct SlabVertex {
    float column, row;
    float slab;
};

// Appends triangles that cover every pixel whose ray meets the part of `box` (index space) inside
// each slab, with each pixel centre in at most one triangle of a slab. They may cover a little
// more: the fragment's own ray decides. `starts`, where given: the number of vertices before each
// slab, in the order drawn, and after the last.
void append_slab_polygons(const View& view, const Grid& grid, const IndexBox& box,
                          const Slabs& slabs, Order order, std::vector<SlabVertex>& triangles,
                          std::vector<std::size_t>* starts = nullptr);

// The same for several slabs at once: one polygon around them, whose corners carry the first.
void append_span_polygon(const View& view, const Grid& grid, const IndexBox& box,
                         const Slabs& slabs, const SampleSpan& span,
                         std::vector<SlabVertex>& triangles);

}  // namespace lamina
