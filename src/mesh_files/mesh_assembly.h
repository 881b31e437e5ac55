// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <cstdint>
#include <string>
#include <vector>

#include "lamina/mesh_data.h"

namespace lamina {

// Cells in the form of VTK's unstructured grids: cell i has the type types[i] and the points
// connectivity[ends[i - 1]] ... connectivity[ends[i] - 1].
struct MeshCells {
    std::vector<std::int64_t> connectivity;
    std::vector<std::int64_t> ends;
    std::vector<std::int64_t> types;
};

// One unstructured grid of a file, or one piece of it.
struct MeshPiece {
    std::string label;  // "FILE" or "FILE: Piece 2", for messages
    std::vector<glm::dvec3> points;
    MeshCells cells;
    std::vector<MeshScalar> point_scalars;
    std::vector<MeshScalar> cell_scalars;  // one value a cell
};

std::vector<glm::dvec3> points_from_values(const std::vector<double>& values);

// Whether an array gives a scalar: with one component the array itself, with three components the
// length of the vector. Other arrays give none.
inline bool makes_scalar(std::int64_t components) {
    return components == 1 || components == 3;
}
MeshScalar scalar_from_values(std::string name, std::int64_t components,
                              std::vector<double> values);

// Joins pieces into one mesh: their points one after the other, their cells cut into tets. Throws
// Error for invalid cells.
class MeshAssembly {
  public:
    explicit MeshAssembly(std::string file) : file_(std::move(file)) {}

    void add(MeshPiece piece);
    MeshData finish();  // throws Error where there is no point or no tet

  private:
    std::vector<std::int64_t> add_cells(const MeshPiece& piece, std::int32_t first_point);

    std::string file_;
    MeshData mesh_;
    bool first_ = true;
};

}  // namespace lamina
