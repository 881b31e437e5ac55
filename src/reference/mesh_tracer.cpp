// SPDX-License-Identifier: Apache-2.0
#include "reference/mesh_tracer.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>
#include <vector>

#include "base/error.h"
#include "base/interrupt.h"
#include "mesh/point_gradients.h"
#include "mesh/ray_walk.h"
#include "optics/ray_lights.h"
#include "reference/seen_segment.h"
#include "reference/segment_sum.h"
#include "reference/transfer_intervals.h"

namespace lamina {
namespace {

// Ends of segments are accurate to this many epsilons of the largest distance and coordinate on the
// ray (mesh/ray_walk.cpp: 8 for a corner's place, as much for weights and parameter).
constexpr double place_epsilons = 16;
// Interpolated scalars are accurate to this many epsilons of the values at the corners.
constexpr double value_epsilons = 64;

struct MeshTileTotals {
    double error_estimate = 0;
    std::int64_t segments = 0, overlapping = 0;
};

class MeshTileTracer {
  public:
    MeshTileTracer(const TetMesh& mesh, const FaceTree& open_faces, std::span<const double> scalar,
                   const std::vector<char>& no_value, const TransferFunction& transfer_function,
                   const TransferIntervals& intervals, const View& view,
                   const TraceOptions& options)
        : mesh_(mesh),
          open_faces_(open_faces),
          scalar_(scalar),
          no_value_(no_value),
          transfer_function_(transfer_function),
          intervals_(intervals),
          view_(view),
          options_(options) {
        if (options.lighting) gradients_ = point_gradients(mesh, scalar);
        const glm::dvec3 lo = mesh.bounds().min - view.eye, hi = mesh.bounds().max - view.eye;
        reach_ = glm::length(glm::max(glm::abs(lo), glm::abs(hi)));
    }

    MeshTileTotals trace(const PictureTile& tile, PreciseImage& image) const {
        MeshTileTotals totals;
        RayWalk walk(mesh_, open_faces_);
        SegmentSum sum(transfer_function_, intervals_,
                       place_epsilons * std::numeric_limits<double>::epsilon() * reach_,
                       options_.tolerance);
        for (int row = tile.row; row < tile.row + tile.height; ++row) {
            check_interrupt();
            trace_row(tile, row, walk, sum, image, totals);
        }
        return totals;
    }

  private:
    void trace_row(const PictureTile& tile, int row, RayWalk& walk, SegmentSum& sum,
                   PreciseImage& image, MeshTileTotals& totals) const {
        std::vector<TetSegment> listed;
        for (int column = tile.column; column < tile.column + tile.width; ++column) {
            const View::Ray ray = view_.ray(column, row);
            const double world_per_z = glm::length(ray.direction);
            std::optional<RayLights> lights;
            if (options_.lighting) lights.emplace(*options_.lighting, -ray.direction);
            sum.begin(lights ? &*lights : nullptr);
            walk.aim(ray.origin, ray.direction);
            const SeenRange seen = seen_range(options_.clip, ray);
            const auto add = [&](const TetSegment& segment) {
                add_segment(segment, seen, world_per_z, sum);
                return !sum.opaque();
            };
            if (walk.overlapping()) {
                ++totals.overlapping;
                walk.list(listed);
                for (const TetSegment& segment : listed) add(segment);
            } else {
                for (const RayWalk::Entry& entry : walk.entries()) {
                    if (!sum.opaque()) walk.follow(entry, add);
                }
            }
            sum.finish();
            double* const pixel = image.pixel(column, row);
            for (int channel = 0; channel < 3; ++channel) pixel[channel] = color_of(sum)[channel];
            pixel[3] = sum.alpha();
            totals.error_estimate = std::max(totals.error_estimate, sum.error_estimate());
            totals.segments += sum.segments();
        }
    }

    // Adds the part of the segment that is seen.
    void add_segment(const TetSegment& segment, const SeenRange& seen, double world_per_z,
                     SegmentSum& sum) const {
        if (!no_value_.empty() && no_value_[static_cast<std::size_t>(segment.tet)] != 0) return;
        const auto [from, to, front, back] = seen_segment(segment, seen, scalar_);
        if (from == to) return;
        const double length = (to - from) * world_per_z;
        if (gradients_.empty()) return sum.add(front, back, length, slack_of(segment.tet));
        sum.add_lit(front, back, gradient_along(segment, from, to), length, slack_of(segment.tet));
    }

    // Between two parameters of the ray: linear.
    GradientAlong gradient_along(const TetSegment& segment, double from, double to) const {
        const glm::dvec3 in = gradient_at(segment.in), out = gradient_at(segment.out);
        const double length = segment.out.at - segment.in.at;
        const glm::dvec3 slope = length > 0 ? (out - in) / length : glm::dvec3(0);
        const glm::dvec3 front = in + (from - segment.in.at) * slope;
        GradientAlong along;
        for (int c = 0; c < 3; ++c)
            along[static_cast<std::size_t>(c)] = {{front[c], (to - from) * slope[c]}};
        return along;
    }

    glm::dvec3 gradient_at(const FaceCrossing& crossing) const {
        const auto at = [&](std::size_t i) {
            return gradients_[static_cast<std::size_t>(crossing.corners[i])];
        };
        const glm::dvec3 first = at(0);
        return first +
               (crossing.weights[1] * (at(1) - first) + crossing.weights[2] * (at(2) - first));
    }

    // Light is added to what is there: rounding may leave -1e-17 of a colour that it takes away.
    glm::dvec3 color_of(const SegmentSum& sum) const {
        return gradients_.empty() ? sum.color() : glm::max(sum.color(), glm::dvec3(0));
    }

    // Returns how far interpolation may be off inside a tet. Constant values are exact.
    double slack_of(std::int32_t tet) const {
        double lo = INFINITY, hi = -INFINITY;
        for (const std::int32_t corner : mesh_.tets()[static_cast<std::size_t>(tet)]) {
            const double value = scalar_[static_cast<std::size_t>(corner)];
            lo = std::min(lo, value);
            hi = std::max(hi, value);
        }
        if (lo == hi) return 0;
        return value_epsilons * std::numeric_limits<double>::epsilon() *
               std::max(std::abs(lo), std::abs(hi));
    }

    const TetMesh& mesh_;
    const FaceTree& open_faces_;
    std::span<const double> scalar_;
    const std::vector<char>& no_value_;
    const TransferFunction& transfer_function_;
    const TransferIntervals& intervals_;
    const View& view_;
    const TraceOptions& options_;
    std::vector<glm::dvec3> gradients_;  // at the points; empty: nothing is lit
    double reach_;
};

// Marks tets with a value that is not finite. The list is empty where there are none.
std::vector<char> tets_without_value(const TetMesh& mesh, std::span<const double> scalar) {
    if (std::all_of(scalar.begin(), scalar.end(), [](double s) { return std::isfinite(s); }))
        return {};
    std::vector<char> marked;
    marked.reserve(mesh.tets().size());
    for (const Tet& tet : mesh.tets()) {
        marked.push_back(std::any_of(tet.begin(), tet.end(), [&](std::int32_t corner) {
            return !std::isfinite(scalar[static_cast<std::size_t>(corner)]);
        }));
    }
    return marked;
}

}  // namespace

MeshTraceResult trace_mesh(const TetMesh& mesh, const FaceTree& open_faces,
                           std::span<const double> scalar,
                           const TransferFunction& transfer_function, const View& view,
                           const TraceOptions& options, const TileDone& tile_done) {
    check(options);
    MeshTraceResult result{PreciseImage(view.width, view.height)};
    const TransferIntervals intervals(transfer_function);
    const std::vector<char> no_value = tets_without_value(mesh, scalar);
    const MeshTileTracer tracer(mesh, open_faces, scalar, no_value, transfer_function, intervals,
                                view, options);
    const std::vector<PictureTile> tiles = tiles_to_trace(view.width, view.height);
    std::vector<MeshTileTotals> totals(tiles.size());
    const auto trace = [&](const PictureTile& tile, std::size_t number) {
        totals[number] = tracer.trace(tile, result.image);
    };
    trace_tiles(tiles, trace, result.image, tile_done);
    for (const MeshTileTotals& tile : totals) {
        result.error_estimate = std::max(result.error_estimate, tile.error_estimate);
        result.segments += tile.segments;
        result.overlapping_rays += tile.overlapping;
    }
    return result;
}

}  // namespace lamina
