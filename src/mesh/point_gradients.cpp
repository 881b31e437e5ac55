// SPDX-License-Identifier: Apache-2.0
#include "mesh/point_gradients.h"

#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>

namespace lamina {
namespace {

struct Weighted {
    glm::dvec3 sum{0};  // gradient times six volumes
    double weight = 0;
};

// Of one tet, with lengths in units of `unit`. The gradient times the volume is a sum of products:
// nothing is divided by the volume of a sliver.
Weighted weighted_gradient(const TetMesh& mesh, std::span<const double> scalar, const Tet& tet,
                           double unit) {
    const auto point = [&](std::size_t i) {
        return mesh.points()[static_cast<std::size_t>(tet[i])];
    };
    const auto value = [&](std::size_t i) { return scalar[static_cast<std::size_t>(tet[i])]; };
    const glm::dvec3 a = (point(1) - point(0)) / unit, b = (point(2) - point(0)) / unit,
                     c = (point(3) - point(0)) / unit;
    const glm::dvec3 bc = glm::cross(b, c);
    const double weight = glm::dot(a, bc);
    const glm::dvec3 sum = (value(1) - value(0)) * bc + (value(2) - value(0)) * glm::cross(c, a) +
                           (value(3) - value(0)) * glm::cross(a, b);
    // Tets are positively oriented; the rounded volume of those next to flat may not be.
    if (!(weight > 0) || !std::isfinite(sum.x + sum.y + sum.z)) return {};
    return {sum, weight};
}

}  // namespace

std::vector<glm::dvec3> point_gradients(const TetMesh& mesh, std::span<const double> scalar) {
    const double unit = glm::distance(mesh.bounds().min, mesh.bounds().max);
    std::vector<Weighted> points(mesh.points().size());
    for (const Tet& tet : mesh.tets()) {
        const Weighted one = weighted_gradient(mesh, scalar, tet, unit);
        if (!(one.weight > 0)) continue;
        for (const std::int32_t corner : tet) {
            Weighted& point = points[static_cast<std::size_t>(corner)];
            point.sum += one.sum;
            point.weight += one.weight;
        }
    }
    std::vector<glm::dvec3> gradients;
    gradients.reserve(points.size());
    for (const Weighted& point : points) {
        gradients.push_back(point.weight > 0 ? point.sum / point.weight / unit : glm::dvec3(0));
    }
    return gradients;
}

}  // namespace lamina
