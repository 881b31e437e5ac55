// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "compositing/tree_shape.h"
#include "facts/volume_facts.h"
#include "lamina/grid.h"
#include "lamina/scene.h"
#include "scene/camera.h"

namespace lamina {

// N slabs of equal thickness perpendicular to the view direction. Slab 0 is the nearest to the eye.
// Depths are eye-space z.
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

// Appends triangles for each slab. They cover every pixel whose ray meets `box` (index space)
// inside the slab, and each pixel centre lies in at most one triangle of a slab. They may cover a
// little more, because the fragment's own ray decides. `starts`, if given, gets the number of
// vertices before each slab, in drawing order, and after the last one.
void append_slab_polygons(const View& view, const Grid& grid, const IndexBox& box,
                          const Slabs& slabs, Order order, std::vector<SlabVertex>& triangles,
                          std::vector<std::size_t>* starts = nullptr);

// Appends one polygon around several slabs together. Its corners carry the number of the first
// slab.
void append_span_polygon(const View& view, const Grid& grid, const IndexBox& box,
                         const Slabs& slabs, const SampleSpan& span,
                         std::vector<SlabVertex>& triangles);

}  // namespace lamina
