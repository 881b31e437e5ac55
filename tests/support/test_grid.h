// SPDX-License-Identifier: Apache-2.0
// An unstructured grid as mesh files hold it, and the mesh that the library should read from it.
#pragma once

#include <glm/vec3.hpp>

#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "lamina/mesh.h"
#include "mesh_files/mesh_assembly.h"

namespace lamina::testing {

struct TestArray {
    std::string name, type;  // type: a name of VTK XML files, "Float32"
    int components = 1;
    std::vector<double> values;
};

struct TestCell {
    int type = 10;  // cell type of VTK; 10: tetrahedron
    std::vector<int> corners;
};

struct TestGrid {
    std::vector<glm::dvec3> points;
    std::vector<TestCell> cells;
    std::vector<TestArray> point_arrays, cell_arrays;
    std::string points_type = "Float64", index_type = "Int64", types_type = "UInt8";

    TestArray points_array() const {
        TestArray array{"Points", points_type, 3, {}};
        for (const auto& p : points) array.values.insert(array.values.end(), {p.x, p.y, p.z});
        return array;
    }
    TestArray connectivity() const {
        TestArray array{"connectivity", index_type, 1, {}};
        for (const auto& cell : cells) {
            array.values.insert(array.values.end(), cell.corners.begin(), cell.corners.end());
        }
        return array;
    }
    TestArray offsets() const {
        TestArray array{"offsets", index_type, 1, {}};
        double end = 0;
        for (const auto& cell : cells) {
            array.values.push_back(end += static_cast<double>(cell.corners.size()));
        }
        return array;
    }
    TestArray types() const {
        TestArray array{"types", types_type, 1, {}};
        for (const auto& cell : cells) array.values.push_back(cell.type);
        return array;
    }
};

// Returns a grid of tets, a hexahedron, a voxel cell, a wedge and a pyramid, with a triangle and a
// line, and with arrays of several types. All numbers are exact in their types.
inline TestGrid mixed_grid() {
    TestGrid grid;
    for (int i = 0; i < 24; ++i) {
        grid.points.push_back({i % 2 + i * 0.125, (i / 2) % 2 - i * 0.0625, i / 4 + 0.1});
    }
    grid.cells = {{10, {0, 1, 2, 4}},
                  {5, {0, 1, 2}},
                  {12, {4, 5, 7, 6, 8, 9, 11, 10}},
                  {13, {8, 9, 10, 12, 13, 14}},
                  {3, {1, 2}},
                  {14, {12, 13, 15, 14, 16}},
                  {11, {16, 17, 18, 19, 20, 21, 22, 23}},
                  {10, {3, 5, 7, 9}}};
    TestArray scalar{"pressure", "Float32", 1, {}}, vector{"vel & <x>", "Float64", 3, {}};
    TestArray pair{"pair", "Float64", 2, {}}, small{"small", "Int8", 1, {}};
    for (int i = 0; i < 24; ++i) {
        scalar.values.push_back(static_cast<double>(std::sqrt(static_cast<float>(i)) - 2.5f));
        vector.values.insert(vector.values.end(), {2.0 * i, -1.0 * i, 2.0 * i});  // length 3 i
        pair.values.insert(pair.values.end(), {1.0, 2.0});
        small.values.push_back(5 * i - 100);
    }
    grid.point_arrays = {scalar, vector, pair, small};
    grid.cell_arrays = {{"region", "UInt16", 1, {60000, 1, 2, 3, 4, 5, 6, 7}},
                        {"id", "Int64", 1, {-1, -2, -3, -4, -5, -6, -7, 1e15}}};
    return grid;
}

// Returns the scalars that an array gives: itself, or a vector's length and components.
inline std::vector<MeshScalar> scalars_of(const TestArray& array) {
    if (array.components == 1) return {{array.name, array.values}};
    if (array.components != 3) return {};
    std::vector<MeshScalar> scalars{{array.name, {}},
                                    {array.name + ".x", {}},
                                    {array.name + ".y", {}},
                                    {array.name + ".z", {}}};
    for (std::size_t i = 0; i < array.values.size(); i += 3) {
        const double* const v = &array.values[i];
        scalars[0].values.push_back(std::hypot(v[0], v[1], v[2]));
        for (std::size_t axis = 0; axis < 3; ++axis) scalars[axis + 1].values.push_back(v[axis]);
    }
    return scalars;
}

// Returns the mesh that read_mesh() should make of a grid of cells with straight edges.
inline MeshData expected_mesh(const TestGrid& grid) {
    MeshData mesh;
    mesh.points = grid.points;
    std::vector<std::size_t> cell_of_tet;
    for (std::size_t i = 0; i < grid.cells.size(); ++i) {
        const auto& cell = grid.cells[i];
        const std::vector<std::int32_t> c(cell.corners.begin(), cell.corners.end());
        if (cell.type < 10) {
            ++mesh.cells.skipped;
            continue;
        }
        if (cell.type == 10) {
            mesh.tets.push_back({c[0], c[1], c[2], c[3]});
        } else {
            const SplitCell split = split_cell(cell.type, c, grid.points);
            mesh.tets.insert(mesh.tets.end(), split.tets.begin(),
                             split.tets.begin() + static_cast<std::ptrdiff_t>(split.count));
            ++mesh.cells.split;
        }
        cell_of_tet.resize(mesh.tets.size(), i);
    }
    for (const auto& array : grid.point_arrays) {
        for (const MeshScalar& scalar : scalars_of(array)) mesh.point_scalars.push_back(scalar);
    }
    for (const auto& array : grid.cell_arrays) {
        for (const MeshScalar& of_cells : scalars_of(array)) {
            MeshScalar scalar{of_cells.name, {}};
            for (const std::size_t cell : cell_of_tet)
                scalar.values.push_back(of_cells.values[cell]);
            mesh.cell_scalars.push_back(scalar);
        }
    }
    return mesh;
}

}  // namespace lamina::testing
