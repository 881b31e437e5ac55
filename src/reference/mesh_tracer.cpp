// SPDX-License-Identifier: Apache-2.0
#include "reference/mesh_tracer.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <limits>
#include <optional>
#include <vector>

#include "base/error.h"
#include "base/interrupt.h"
#include "mesh/point_gradients.h"
#include "mesh/ray_walk.h"
#include "optics/ray_lights.h"
#include "reference/packet_walk.h"
#include "reference/seen_segment.h"
#include "reference/segment_sum.h"
#include "reference/tile_faces.h"
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
        PacketWalk walk(mesh_, open_faces_, scalar_);
        std::vector<MeshRay> rays;
        rays.reserve(PacketWalk::width);  // sums point to the lights beside them
        for (std::size_t lane = 0; lane < PacketWalk::width; ++lane) rays.emplace_back(new_sum());
        TileFaces faces(mesh_, open_faces_, view_);
        const TileFaces* const listed = faces.list(tile) ? &faces : nullptr;
        PixelsLeft pixels(tile);
        while (true) {
            for (std::size_t lane = 0; lane < PacketWalk::width; ++lane) {
                while (!walk.walks(lane) && !pixels.none()) {
                    begin(pixels.next(), listed, rays[lane], walk.ray(lane));
                    go_on(lane, rays[lane], walk, image, totals);
                }
            }
            if (!walk.any_walks()) return totals;
            walk.step();
            walk.for_each([&](std::size_t lane) {
                MeshRay& ray = rays[lane];
                add_segment(walk, lane, ray);
                if (!walk.left(lane) && !ray.sum.opaque()) return;
                walk.stop(lane);
                go_on(lane, ray, walk, image, totals);
            });
        }
    }

  private:
    // The pixels of a tile, row by row.
    class PixelsLeft {
      public:
        explicit PixelsLeft(const PictureTile& tile) : tile_(tile) {}
        bool none() const { return row_ == tile_.height; }
        glm::ivec2 next() {
            const glm::ivec2 pixel(tile_.column + column_, tile_.row + row_);
            if (++column_ < tile_.width) return pixel;
            check_interrupt();
            column_ = 0;
            ++row_;
            return pixel;
        }

      private:
        const PictureTile& tile_;
        int column_ = 0, row_ = 0;
    };

    struct MeshRay {
        explicit MeshRay(const SegmentSum& empty) : sum(empty) {}

        glm::ivec2 pixel{0};
        SeenRange seen{};
        double world_per_z = 1;
        std::size_t entered = 0;  // number of entries that are done
        std::optional<RayLights> lights;
        SegmentSum sum;
    };

    SegmentSum new_sum() const {
        return {transfer_function_, intervals_,
                place_epsilons * std::numeric_limits<double>::epsilon() * reach_,
                options_.tolerance};
    }

    void begin(const glm::ivec2& pixel, const TileFaces* faces, MeshRay& ray, RayWalk& walk) const {
        const View::Ray seen = view_.ray(pixel.x, pixel.y);
        ray.pixel = pixel;
        ray.world_per_z = glm::length(seen.direction);
        ray.seen = seen_range(options_.clip, seen);
        ray.entered = 0;
        if (options_.lighting) ray.lights.emplace(*options_.lighting, -seen.direction);
        ray.sum.begin(ray.lights ? &*ray.lights : nullptr);
        if (faces != nullptr) return walk.aim(seen.origin, seen.direction, faces->of(pixel));
        walk.aim(seen.origin, seen.direction);
    }

    // Enters the mesh once more, or ends the ray.
    void go_on(std::size_t lane, MeshRay& ray, PacketWalk& packet, PreciseImage& image,
               MeshTileTotals& totals) const {
        const RayWalk& walk = packet.ray(lane);
        if (walk.overlapping()) {
            ++totals.overlapping;
            add_overlapping(walk, ray);
        } else if (ray.entered < walk.entries().size() && !ray.sum.opaque()) {
            return packet.enter(lane, walk.entries()[ray.entered++]);
        }
        ray.sum.finish();
        double* const pixel = image.pixel(ray.pixel.x, ray.pixel.y);
        for (int channel = 0; channel < 3; ++channel) pixel[channel] = color_of(ray.sum)[channel];
        pixel[3] = ray.sum.alpha();
        totals.error_estimate = std::max(totals.error_estimate, ray.sum.error_estimate());
        totals.segments += ray.sum.segments();
    }

    void add_overlapping(const RayWalk& walk, MeshRay& ray) const {
        std::vector<TetSegment> segments;
        walk.list(segments);
        for (const TetSegment& segment : segments) {
            const auto [least, most] = value_range(segment.tet);
            add_seen(segment.tet, seen_segment(segment, ray.seen, scalar_), least, most, ray,
                     [&] { return segment; });
        }
    }

    void add_segment(const PacketWalk& walk, std::size_t lane, MeshRay& ray) const {
        const SeenSegment whole{walk.from(lane), walk.to(lane), walk.front(lane), walk.back(lane)};
        add_seen(walk.tet(lane), seen_segment(whole, ray.seen), walk.least(lane), walk.most(lane),
                 ray, [&] { return walk.segment(lane); });
    }

    // Adds the part of a segment that is seen. `least`, `most`: values at the tet's corners.
    // `segment`() returns the whole one.
    template <typename Segment>
    void add_seen(std::int32_t tet, const SeenSegment& part, double least, double most,
                  MeshRay& ray, const Segment& segment) const {
        if (!no_value_.empty() && no_value_[static_cast<std::size_t>(tet)] != 0) return;
        if (part.from == part.to) return;
        const double length = (part.to - part.from) * ray.world_per_z;
        const double slack = slack_of(least, most);
        if (gradients_.empty()) return ray.sum.add(part.front, part.back, length, slack);
        ray.sum.add_lit(part.front, part.back, gradient_along(segment(), part.from, part.to),
                        length, slack);
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

    struct Range {
        double least, most;
    };
    Range value_range(std::int32_t tet) const {
        Range range{INFINITY, -INFINITY};
        for (const std::int32_t corner : mesh_.tets()[static_cast<std::size_t>(tet)]) {
            const double value = scalar_[static_cast<std::size_t>(corner)];
            range = {std::min(range.least, value), std::max(range.most, value)};
        }
        return range;
    }

    // Returns how far interpolation may be off inside a tet. Constant values are exact.
    static double slack_of(double least, double most) {
        if (least == most) return 0;
        return value_epsilons * std::numeric_limits<double>::epsilon() *
               std::max(std::abs(least), std::abs(most));
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
