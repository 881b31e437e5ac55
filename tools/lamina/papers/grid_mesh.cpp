// SPDX-License-Identifier: Apache-2.0
#include "papers/grid_mesh.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <utility>

#include "mesh/mesh_shape.h"
#include "meshing/volume_mesh.h"

namespace lamina::papers {
namespace {

// Returns the Kuhn mesh of a grid with `cells` cells. Point `index` lies at place(index) and has
// the scalar field(index).
template <typename Place, typename Field>
SceneMesh split_grid(const std::array<std::int32_t, 3>& cells, const Place& place,
                     const Field& field) {
    Grid grid;
    grid.centering = {Centering::node, Centering::node, Centering::node};
    for (std::size_t axis = 0; axis < 3; ++axis) grid.size[axis] = cells[axis] + 1;
    const auto samples =
        std::make_shared<std::vector<std::uint8_t>>(static_cast<std::size_t>(grid.sample_count()));
    const Volume volume(grid, SampleType::uint8,
                        std::shared_ptr<const void>(samples, samples->data()));
    MeshData data =
        make_kuhn_mesh(TrilinearField(volume), std::numeric_limits<std::int32_t>::max());
    MeshScalar scalar = std::move(data.point_scalars.front());
    data.point_scalars.clear();
    for (std::size_t i = 0; i < data.points.size(); ++i) {
        scalar.values[i] = field(data.points[i]);
        data.points[i] = place(data.points[i]);
    }
    return {TetMesh(std::move(data), "generated mesh"), std::move(scalar), false, {}};
}

double blobs(const glm::dvec3& p) {
    const auto blob = [&](const glm::dvec3& center, double radius) {
        const glm::dvec3 d = (p - center) / radius;
        return std::exp(-glm::dot(d, d));
    };
    return 0.9 * blob({.4, .45, .5}, .28) + 0.6 * blob({.68, .62, .35}, .15) +
           0.5 * blob({.35, .75, .7}, .12);
}

// Returns the heights of layers 0..count above the body. Thicknesses are first, first * growth,
// ..., last.
std::vector<double> layer_heights(std::int32_t count, double first, double last) {
    const double growth = std::pow(last / first, 1.0 / (count - 1));
    std::vector<double> heights{0};
    double thickness = first;
    for (std::int32_t layer = 0; layer < count; ++layer) {
        heights.push_back(heights.back() + thickness);
        thickness *= growth;
    }
    return heights;
}

// Returns the body's height, for a bump of height 1.
double bump_at(double x, double y) {
    return std::exp(-10 * ((x - .5) * (x - .5) + (y - .5) * (y - .5)));
}

double layer_depth(double x, double y) {
    return 0.001 * (2 + std::sin(11 * x + 4 * y) * std::cos(9 * y - 3 * x));
}

}  // namespace

SceneMesh make_box_mesh(const std::array<std::int32_t, 3>& cells) {
    const glm::dvec3 size(cells[0], cells[1], cells[2]);
    return split_grid(
        cells, [&](const glm::dvec3& index) { return index / size; },
        [&](const glm::dvec3& index) { return blobs(index / size); });
}

SceneMesh make_graded_mesh(std::int32_t cells, std::int32_t layers, double ratio, double bump) {
    // The longest edge is a diagonal of an outermost cell, which hardly depends on the thickness of
    // the first layer.
    const double width = 1.0 / cells;
    const auto made = [&](double first) {
        const std::vector<double> heights = layer_heights(layers, first, width);
        const auto height = [&](const glm::dvec3& index) {
            return heights[static_cast<std::size_t>(std::lround(index.z))];
        };
        return split_grid(
            {cells, cells, layers},
            [&](const glm::dvec3& index) {
                const double x = width * index.x, y = width * index.y;
                return glm::dvec3(x, y, bump * bump_at(x, y) + height(index));
            },
            [&](const glm::dvec3& index) {
                const double h = height(index) / layer_depth(width * index.x, width * index.y);
                return 1 / (1 + h * h);
            });
    };
    const double longest = edge_lengths(made(width / ratio).mesh).longest;
    return made(longest / ratio);
}

}  // namespace lamina::papers
