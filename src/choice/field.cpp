// SPDX-License-Identifier: Apache-2.0
#include "choice/field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/geometric.hpp>
#include <limits>

#include "choice/shown_cells.h"
#include "choice/value_distribution.h"
#include "facts/mesh_facts.h"
#include "facts/volume_facts.h"
#include "mesh/predicates.h"
#include "optics/pieces.h"

namespace lamina {

namespace {

std::vector<WeightedValue> weighted(const ValueCounts& counted, SampleType type) {
    const double lowest =
        type == SampleType::int16 ? double{std::numeric_limits<std::int16_t>::min()} : 0;
    std::vector<WeightedValue> values;
    for (std::size_t code = 0; code < counted.codes.size(); ++code) {
        if (counted.codes[code] > 0)
            values.push_back(
                {static_cast<double>(code) + lowest, static_cast<double>(counted.codes[code])});
    }
    for (const float value : counted.some) values.push_back({value, 1});
    return values;
}

}  // namespace

double VolumeField::spacing() const {
    const Grid& grid = volume_.grid();
    double smallest = std::numeric_limits<double>::infinity();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (grid.size[axis] > 1) smallest = std::min(smallest, glm::length(grid.step[axis]));
    }
    return smallest;
}

ValueDistribution VolumeField::distribution() const {
    return ValueDistribution(
        weighted(values_ != nullptr ? *values_ : count_values(volume_), volume_.type()));
}

std::vector<glm::dvec3> VolumeField::shown_points(const TransferFunction& transfer_function,
                                                  double least) const {
    return hull_of_shown_cells(volume_, bricks_, [&](const ValueRange& range) {
        return transfer_function.max_extinction(range.lo, range.hi) > least;
    });
}

std::array<glm::dvec3, 8> VolumeField::corners() const {
    const Grid& grid = volume_.grid();
    std::array<glm::dvec3, 8> corners = box_corners(grid.index_min(), grid.index_max());
    for (glm::dvec3& corner : corners) corner = grid.to_world(corner);
    return corners;
}

std::vector<double> VolumeField::optical_depths(const Scene& scene) const {
    Facts facts;
    facts.grid = volume_.grid();
    measure_view(scene, facts);
    const bool large = volume_.grid().sample_count() > large_volume;
    const RaySampling sampling = large ? RaySampling{256, 256} : RaySampling{};
    std::vector<double> depths;
    for (const ScalarRays::Ray& ray : sample_rays(scene, volume_, facts, &bricks_, sampling).rays)
        depths.push_back(ray.optical_depths.back());
    return depths;
}

namespace {

constexpr std::size_t most_tets = std::size_t{1} << 19;

// Quadrature points of a tet, each of which stands for a quarter of it; exact for quadratic
// functions (Hammer and Stroud 1956).
constexpr double near_corner = 0.58541019662496845, near_others = 0.13819660112501051;

// Returns six times the volume of a tet, in units of the mesh's diagonal cubed.
double volume_of(const TetMesh& mesh, const Tet& tet, double diagonal) {
    const auto at = [&](std::size_t corner) {
        return mesh.points()[static_cast<std::size_t>(tet[corner])] / diagonal;
    };
    const glm::dvec3 origin = at(0);
    return std::abs(glm::dot(at(1) - origin, glm::cross(at(2) - origin, at(3) - origin)));
}

// Weight of a marker in a large mesh of which only some tets are sampled, in units of the mesh's
// diagonal cubed: more than 0, and less than any share that counts.
constexpr double smallest_weight = 1e-30;

// Returns the point values that are far from all others.
std::vector<double> markers_of(const SceneMesh& mesh) {
    std::vector<WeightedValue> at_points;
    at_points.reserve(mesh.scalar.values.size());
    for (const double value : mesh.scalar.values) {
        if (std::isfinite(value)) at_points.push_back({value, 1});
    }
    return find_markers(ValueDistribution(std::move(at_points)));
}

double depth_of(const TransferFunction& transfer_function, const MeshFacts::Run& run) {
    double sum = 0;
    for_each_linear_piece(
        transfer_function.knots(), run.front, run.back, [&](const LinearPiece& piece) {
            const double mean = (piece.at_from.extinction + piece.at_to.extinction) / 2;
            sum += run.front == run.back
                       ? mean
                       : mean * ((piece.to - piece.from) / (run.back - run.front));
        });
    return sum * run.length;
}

}  // namespace

double MeshField::spacing() const {
    const auto points = mesh_.mesh.points();
    double sum = 0;
    for (const Tet& tet : mesh_.mesh.tets()) {
        for (std::size_t i = 0; i < 4; ++i) {
            for (std::size_t j = 0; j < i; ++j) {
                sum += glm::distance(points[static_cast<std::size_t>(tet[i])],
                                     points[static_cast<std::size_t>(tet[j])]);
            }
        }
    }
    return sum / (6 * static_cast<double>(mesh_.mesh.tets().size()));
}

ValueDistribution MeshField::distribution() const {
    const auto tets = mesh_.mesh.tets();
    const TetMesh::Bounds& bounds = mesh_.mesh.bounds();
    const double diagonal = glm::distance(bounds.min, bounds.max);
    const std::size_t step = tets.size() / most_tets + 1;
    const std::vector<double> markers = markers_of(mesh_);
    std::vector<WeightedValue> values;
    for (std::size_t i = 0; i < tets.size(); i += step) {
        const Tet& tet = tets[i];
        const ValueRange range = range_in(mesh_.scalar.values, tet);
        if (range.empty()) continue;
        const double weight = volume_of(mesh_.mesh, tet, diagonal);
        std::array<double, 4> at_corners;
        double sum = 0;
        bool marked = false;
        for (std::size_t k = 0; k < 4; ++k) {
            at_corners[k] = mesh_.scalar.values[static_cast<std::size_t>(tet[k])];
            sum += at_corners[k];
            marked = marked || std::ranges::count(markers, at_corners[k]) > 0;
        }
        for (const double value : at_corners) {
            const double inside = near_others * (sum - value) + near_corner * value;
            values.push_back({marked ? value : std::clamp(inside, range.lo, range.hi), weight});
        }
    }
    // A tet that is not sampled may have the only corner with a marker.
    if (step > 1) {
        for (const double marker : markers) values.push_back({marker, smallest_weight});
    }
    return ValueDistribution(std::move(values));
}

std::vector<glm::dvec3> MeshField::shown_points(const TransferFunction& transfer_function,
                                                double least) const {
    const auto points = mesh_.mesh.points();
    std::vector<char> shown(points.size());
    for (const Tet& tet : mesh_.mesh.tets()) {
        const ValueRange range = range_in(mesh_.scalar.values, tet);
        if (range.empty() || !(transfer_function.max_extinction(range.lo, range.hi) > least))
            continue;
        for (const std::int32_t corner : tet) shown[static_cast<std::size_t>(corner)] = 1;
    }
    std::vector<glm::dvec3> found;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (shown[i] != 0) found.push_back(points[i]);
    }
    return found;
}

std::array<glm::dvec3, 8> MeshField::corners() const {
    return box_corners(mesh_.mesh.bounds().min, mesh_.mesh.bounds().max);
}

std::vector<double> MeshField::optical_depths(const Scene& scene) const {
    std::vector<double> depths;
    for (const auto& ray : find_view_rays(scene, mesh_)) {
        double depth = 0;
        for (const MeshFacts::Run& run : ray) depth += depth_of(*scene.transfer_function, run);
        depths.push_back(depth);
    }
    return depths;
}

}  // namespace lamina
