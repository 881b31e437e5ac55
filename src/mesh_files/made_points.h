// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "lamina/mesh.h"
#include "mesh/point_table.h"

namespace lamina {

// Adds points that cells need and files lack. Each is a weighted sum of a mesh's points, and so are
// its values.
class MadePoints {
  public:
    MadePoints(MeshData& mesh, PointPlaces& places) : mesh_(mesh), places_(places) {}

    // Adds a point and returns its index. Throws Error beyond 2^31 - 1 points. `sources`: points of
    // the mesh that are not made.
    std::int32_t add(std::span<const std::int32_t> sources, std::span<const double> weights);

    // Returns the middle of a quadrilateral of eight points, four corners and then the middles of
    // its edges, by the shape functions of serendipity elements (vtkQuadraticQuad): -1/4 and 1/2.
    // Two cells that share the face get one point; if they have copies of its points, each gets
    // one, at exactly the same place.
    std::int32_t middle_of(const std::array<std::int32_t, 8>& face);

    // Appends the values at the points that were made since the last call to each scalar at points.
    void append_values();

    static constexpr std::size_t most_points = 0x7fffffff;

  private:
    MeshData& mesh_;
    PointPlaces& places_;
    std::map<std::array<std::int32_t, 8>, std::int32_t> middles_;
    // Those since append_values(): point i has the sources ends_[i - 1] ... ends_[i] - 1.
    std::vector<std::int32_t> sources_;
    std::vector<double> weights_;
    std::vector<std::size_t> ends_;
};

}  // namespace lamina
