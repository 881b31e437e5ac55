// SPDX-License-Identifier: Apache-2.0
#include "lamina/sampling.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include "mesh/face_tree.h"
#include "mesh/predicates.h"
#include "mesh/ray_walk.h"
#include "reference/cell_walk.h"
#include "reference/cells.h"
#include "reference/chord.h"
#include "reference/mesh_walk.h"
#include "scene/scene.h"
#include "volume/volume_store.h"

namespace lamina {
namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();
constexpr FieldPoint no_value{no_number, glm::dvec3(no_number)};

// Largest distance from a face, as a share of the coordinates, to which rounding can move a point
// on it: three products, two sums and the differences before them lose half an ulp each.
constexpr double rounding = 8 * std::numeric_limits<double>::epsilon();

// A cell, and a point in it in the cell's own coordinates (0..1).
struct CellPlace {
    CellIndex cell;
    glm::dvec3 place;
};

std::optional<CellPlace> place_in(const Grid& grid, const glm::dvec3& position) {
    const glm::dvec3 lowest = grid.index_min(), highest = grid.index_max();
    const glm::dvec3 index = grid.to_index(position);
    CellPlace found{};
    for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        const double slack =
            rounding * (norm1(position) + norm1(grid.origin)) / glm::length(grid.step[a]);
        if (!(index[axis] >= lowest[axis] - slack && index[axis] <= highest[axis] + slack))
            return {};
        const double cell = std::clamp(std::floor(index[axis]), std::floor(lowest[axis]),
                                       std::ceil(highest[axis]) - 1);
        found.cell[a] = static_cast<std::int64_t>(cell);
        found.place[axis] = std::clamp(index[axis] - cell, 0.0, 1.0);
    }
    return found;
}

bool all_finite(std::span<const double> values) {
    return std::ranges::all_of(values, [](double v) { return std::isfinite(v); });
}

template <typename Samples>
FieldPoint point_at(const Grid& grid, const Samples& samples, const CellPlace& at) {
    const CellCorners corners = CellSamples<Samples>(grid, samples).corners(at.cell);
    if (!all_finite(corners.v)) return no_value;
    const glm::dvec3 still(0);
    const GradientAlong gradient =
        GradientSamples<Samples>(grid, samples).along(at.cell, at.place, still);
    return {corners.along(at.place, still)(0),
            glm::dvec3(gradient[0](0), gradient[1](0), gradient[2](0))};
}

}  // namespace

// The mesh of a FieldSampler.
struct SampledMesh {
    SceneMesh mesh;
    FaceTree open_faces;
    // Gradients at the mesh's points: x, y, z components.
    std::array<std::vector<double>, 3> gradients;

    explicit SampledMesh(SceneMesh taken)
        : mesh(std::move(taken)), open_faces(mesh.mesh, mesh.mesh.open_faces()) {
        for (const glm::dvec3& gradient : gradients_of(mesh))
            for (int c = 0; c < 3; ++c)
                gradients[static_cast<std::size_t>(c)].push_back(gradient[c]);
    }

    std::optional<FieldPoint> at(const glm::dvec3& position) const;
    // `direction` has length 1.
    std::vector<RaySegment> along(const glm::dvec3& origin, const glm::dvec3& direction) const;

  private:
    std::vector<TetSegment> segments(const glm::dvec3& origin, const glm::dvec3& direction) const;
    std::array<double, 4> corner_values(std::int32_t tet) const;
    FieldPoint in_tet(const TetSegment& segment) const;
};

std::vector<TetSegment> SampledMesh::segments(const glm::dvec3& origin,
                                              const glm::dvec3& direction) const {
    RayWalk walk(mesh.mesh, open_faces);
    walk.aim(origin, direction);
    std::vector<TetSegment> found;
    walk.list(found);
    return found;
}

std::array<double, 4> SampledMesh::corner_values(std::int32_t tet) const {
    std::array<double, 4> values;
    std::ranges::transform(
        mesh.mesh.tets()[static_cast<std::size_t>(tet)], values.begin(),
        [&](std::int32_t corner) { return mesh.scalar.values[static_cast<std::size_t>(corner)]; });
    return values;
}

// Returns the field at parameter 0 of the line, which lies in the segment.
FieldPoint SampledMesh::in_tet(const TetSegment& segment) const {
    if (!all_finite(corner_values(segment.tet))) return no_value;
    constexpr double all = std::numeric_limits<double>::infinity();
    const auto value_of = [&](std::span<const double> values) {
        const SeenSegment seen = seen_segment(segment, {-all, all}, values);
        if (!(seen.from < seen.to)) return seen.front;
        const double share = std::clamp(-seen.from / (seen.to - seen.from), 0.0, 1.0);
        return seen.front + share * (seen.back - seen.front);
    };
    return {value_of(mesh.scalar.values),
            glm::dvec3(value_of(gradients[0]), value_of(gradients[1]), value_of(gradients[2]))};
}

// Walks a line through the position from tet to tet, and interpolates in the tet whose segment of
// the line holds the position or, within rounding, is nearest to it.
std::optional<FieldPoint> SampledMesh::at(const glm::dvec3& position) const {
    const auto& [lowest, highest] = mesh.mesh.bounds();
    const double slack = rounding * (norm1(position) + norm1(lowest) + norm1(highest));
    for (int axis = 0; axis < 3; ++axis) {
        if (!(position[axis] >= lowest[axis] - slack && position[axis] <= highest[axis] + slack))
            return {};
    }
    // A line from `position` towards the middle of the mesh crosses the boundary without running
    // along one of its faces, if the mesh is convex.
    const glm::dvec3 inward = lowest + 0.5 * (highest - lowest) - position;
    const double distance = glm::length(inward);
    const std::vector<TetSegment> found =
        segments(position, distance > slack ? inward / distance : glm::dvec3(1, 0, 0));
    const TetSegment* nearest = nullptr;
    double least = slack;
    for (const TetSegment& segment : found) {
        const double away = std::max({segment.in.at, -segment.out.at, 0.0});
        if (!(away <= least) || (nearest && away == least)) continue;
        nearest = &segment;
        least = away;
    }
    if (!nearest) return {};
    return in_tet(*nearest);
}

namespace {

// Returns the segment begin..end with the smallest and largest of `values`, those of the corners;
// both are NaN if a corner's value is not finite.
RaySegment bounded(double begin, double end, std::span<const double> values) {
    if (!all_finite(values)) return {begin, end, no_number, no_number};
    const auto [least, most] = std::ranges::minmax(values);
    return {begin, end, least, most};
}

// `direction` has length 1.
std::vector<RaySegment> segments_in(const Volume& volume, const glm::dvec3& origin,
                                    const glm::dvec3& direction) {
    const Grid& grid = volume.grid();
    const Chord chord = clip_to_box(grid, View::Ray{origin, direction});
    const double entry = std::max(glm::dot(grid.to_world(chord.entry) - origin, direction), 0.0);
    std::vector<RaySegment> result;
    if (!(chord.length_z > 0)) return result;
    visit_samples(volume, [&](const auto& samples) {
        const CellSamples<std::remove_cvref_t<decltype(samples)>> cells(grid, samples);
        CellWalk(grid, chord).run([&](const CellIndex& cell, double from, double to) {
            result.push_back(bounded(entry + from, entry + to, cells.corners(cell).v));
            return true;
        });
    });
    return result;
}

SceneMesh mesh_of(MeshData data, const std::string& scalar) {
    Scene scene;
    scene.scalar = scalar;
    return scene_mesh(scene, std::move(data));
}

}  // namespace

std::vector<RaySegment> SampledMesh::along(const glm::dvec3& origin,
                                           const glm::dvec3& direction) const {
    std::vector<RaySegment> result;
    for (const TetSegment& segment : segments(origin, direction)) {
        const double begin = std::max(segment.in.at, 0.0);
        if (!(begin < segment.out.at)) continue;
        result.push_back(bounded(begin, segment.out.at, corner_values(segment.tet)));
    }
    return result;
}

struct FieldSampler::Parts {
    std::variant<Volume, SampledMesh> field;
};

FieldSampler::FieldSampler(Volume volume)
    : parts_(std::make_shared<Parts>(Parts{std::move(volume)})) {}

FieldSampler::FieldSampler(MeshData mesh, const std::string& scalar)
    : parts_(std::make_shared<Parts>(Parts{SampledMesh(mesh_of(std::move(mesh), scalar))})) {}

std::optional<FieldPoint> FieldSampler::at(const glm::dvec3& position) const {
    if (const auto* const mesh = std::get_if<SampledMesh>(&parts_->field))
        return mesh->at(position);
    const Volume& volume = std::get<Volume>(parts_->field);
    const auto place = place_in(volume.grid(), position);
    if (!place) return {};
    return visit_samples(
        volume, [&](const auto& samples) { return point_at(volume.grid(), samples, *place); });
}

std::vector<RaySegment> FieldSampler::along(const glm::dvec3& origin,
                                            const glm::dvec3& direction) const {
    const double length = glm::length(direction);
    if (!(length > 0 && std::isfinite(length) && std::isfinite(norm1(origin)))) return {};
    if (const auto* const mesh = std::get_if<SampledMesh>(&parts_->field))
        return mesh->along(origin, direction / length);
    return segments_in(std::get<Volume>(parts_->field), origin, direction / length);
}

}  // namespace lamina
