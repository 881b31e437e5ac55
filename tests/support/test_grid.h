// SPDX-License-Identifier: Apache-2.0
// An unstructured grid as files hold it, and the mesh that it should become.
#pragma once

#include <glm/vec3.hpp>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "lamina/mesh_data.h"
#include "mesh_files/cell_split.h"

namespace lamina::testing {

struct TestArray {
    std::string name, type;  // type: of VTK XML
    int components = 1;
    std::vector<double> values;
};

struct TestCell {
    int type = 10;
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

// Two tets, a hexahedron, a wedge and a pyramid side by side, with a triangle and a line, and
// arrays of several types. All numbers are exact in their types.
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

inline std::vector<double> scalar_of(const TestArray& array) {
    if (array.components == 1) return array.values;
    std::vector<double> lengths;
    for (std::size_t i = 0; i < array.values.size(); i += 3) {
        lengths.push_back(std::hypot(array.values[i], array.values[i + 1], array.values[i + 2]));
    }
    return lengths;
}

// What read_mesh should make of a grid.
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
        if (cell.type == 10 || cell.type == 24) {
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
        if (array.components != 1 && array.components != 3) continue;
        mesh.point_scalars.push_back({array.name, scalar_of(array)});
    }
    for (const auto& array : grid.cell_arrays) {
        if (array.components != 1 && array.components != 3) continue;
        const std::vector<double> values = scalar_of(array);
        MeshScalar scalar{array.name, {}};
        for (const std::size_t cell : cell_of_tet) scalar.values.push_back(values[cell]);
        mesh.cell_scalars.push_back(scalar);
    }
    return mesh;
}

}  // namespace lamina::testing
