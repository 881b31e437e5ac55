// SPDX-License-Identifier: Apache-2.0
// The rays of a mesh's picture:
//   for each ray of a tile, several of them side by side:
//       entries = the open faces by which the ray enters the mesh, front to back (tiles.h)
//       for each entry, while anything behind can be visible:
//           for each tet from the entry on, until the ray leaves the mesh (mesh_walk.h):
//               cut its segment to the visible part (mesh_walk.h)
//               composite it, if it may be visible (composite.h)
// On rays on which the mesh overlaps itself, tets are composited by entry (mesh/tet_overlaps.h).
#include "reference/tracer.h"

#include "mesh/tet_mesh.h"
#include "mesh/tet_overlaps.h"
#include "optics/ray_lights.h"
#include "reference/composite.h"
#include "reference/mesh_walk.h"
#include "reference/transfer_intervals.h"

namespace lamina {
namespace {

// Error of the ends of segments, in epsilons of the largest distance and coordinate on the ray: 8
// for a corner's place (mesh/ray_walk.h), and 8 for the weights and the parameter.
constexpr double place_epsilons = 16;

class MeshTile {
  public:
    struct Picture {
        const TetMesh& mesh;
        const FaceTree& open_faces;
        std::span<const double> scalar;
        std::span<const char> no_value;         // marks tets with a scalar that is not finite
        std::span<const glm::dvec3> gradients;  // at the points; empty if nothing is lit
        const TransferFunction& transfer_function;
        const TransferIntervals& intervals;
        const View& view;
        const TraceOptions& options;
        double reach;  // no point of the mesh is farther from the eye
    };

    MeshTile(const Picture& picture, const PictureTile& tile, PreciseImage& image,
             const RowDone& row_done)
        : picture_(picture),
          image_(image),
          faces_(picture.mesh, picture.open_faces, picture.view),
          listed_(faces_.list(tile)),
          pixels_({tile.column, tile.row},
                  {tile.column + tile.width - 1, tile.row + tile.height - 1}, row_done),
          walk_(picture.mesh, picture.open_faces, picture.scalar),
          rays_(PacketWalk::width, {{0, 0}, 0, std::nullopt, empty_sum(picture)}) {}

    TraceTotals trace() {
        constexpr LaneSet all = lane_bit(PacketWalk::width) - 1;
        while (true) {
            for_each_lane(all & ~walk_.walking(), [&](std::size_t lane) { begin(lane); });
            if (walk_.walking() == 0) return totals_;
            const LaneSet walked = walk_.walking();
            walk_.step();
            find_seen(walk_.lanes(), picture_.intervals.columns(), seen_);
            for_each_lane(walked & seen_.shown, [&](std::size_t lane) {
                const SeenSegment seen{seen_.from[lane], seen_.to[lane], seen_.front[lane],
                                       seen_.back[lane]};
                add(lane, walk_.tet(lane), seen, seen_.length[lane], seen_.slack[lane],
                    [&] { return walk_.segment(lane); });
                if (rays_[lane].sum.opaque()) walk_.stop(lane);
            });
            for_each_lane(walked & ~walk_.walking(), [&](std::size_t lane) { go_on(lane); });
        }
    }

  private:
    struct MeshRay {
        glm::ivec2 pixel{0};
        std::size_t entered = 0;  // number of entries of the ray that have been entered
        std::optional<RayLights> lights;
        SegmentSum sum;
    };

    static SegmentSum empty_sum(const Picture& picture) {
        return {picture.transfer_function, picture.intervals,
                place_epsilons * std::numeric_limits<double>::epsilon() * picture.reach,
                picture.options.tolerance};
    }

    // Begins rays until one walks, or no pixel is left.
    void begin(std::size_t lane) {
        MeshRay& ray = rays_[lane];
        const TraceOptions& options = picture_.options;
        while (pixels_.any() && (walk_.walking() & lane_bit(lane)) == 0) {
            ray.pixel = pixels_.take();
            ray.entered = 0;
            const View::Ray line = picture_.view.ray(ray.pixel.x, ray.pixel.y);
            const SeenRange range = seen_range(options.clip, line);
            seen_.first[lane] = range.from;
            seen_.last[lane] = range.to;
            seen_.world_per_z[lane] = glm::length(line.direction);
            if (options.lighting) ray.lights.emplace(*options.lighting, -line.direction);
            ray.sum.begin(ray.lights ? &*ray.lights : nullptr);
            if (listed_) {
                walk_.ray(lane).aim(line.origin, line.direction, faces_.of(ray.pixel));
            } else {
                walk_.ray(lane).aim(line.origin, line.direction);
            }
            if (walk_.ray(lane).overlapping()) add_overlapping(lane);
            go_on(lane);
        }
    }

    // Enters the mesh at the ray's next entry, or ends the ray.
    void go_on(std::size_t lane) {
        MeshRay& ray = rays_[lane];
        const RayWalk& line = walk_.ray(lane);
        if (!line.overlapping() && !ray.sum.opaque() && ray.entered < line.entries().size())
            return walk_.enter(lane, line.entries()[ray.entered++]);
        ray.sum.finish();
        // Rounding may leave -1e-17 of a colour that light takes away.
        const glm::dvec3 color =
            ray.lights ? glm::max(ray.sum.color(), glm::dvec3(0)) : ray.sum.color();
        double* const pixel = image_.pixel(ray.pixel.x, ray.pixel.y);
        for (int channel = 0; channel < 3; ++channel) pixel[channel] = color[channel];
        pixel[3] = ray.sum.alpha();
        totals_.add({ray.sum.error_estimate(), ray.sum.segments()});
    }

    void add_overlapping(std::size_t lane) {
        ++totals_.overlapping_rays;
        const SeenRange range{seen_.first[lane], seen_.last[lane]};
        walk_.ray(lane).list(overlapping_);
        sort_by_entry(
            std::span(overlapping_),
            entry_rule(picture_.mesh, eye_of(picture_.view), walk_.ray(lane).line().direction),
            [](const TetSegment& segment) { return segment.in.at; }, &TetSegment::tet);
        for (const TetSegment& segment : overlapping_) {
            const Tet& tet = picture_.mesh.tets()[segment.tet];
            const auto [least, most] = range_in(picture_.scalar, tet);
            const SeenSegment seen = seen_segment(segment, range, picture_.scalar);
            const double slack = scalar_slack(least, most);
            const auto [lo, hi] = std::minmax(seen.front, seen.back);
            if (seen.from < seen.to && picture_.intervals.visible(lo - slack, hi + slack))
                add(lane, segment.tet, seen, (seen.to - seen.from) * seen_.world_per_z[lane], slack,
                    [&] { return segment; });
        }
    }

    // Adds `seen`, the visible part, `length` world units long, of the segment that segment()
    // returns in the tet `tet`. `slack`: scalar_slack().
    template <typename Segment>
    void add(std::size_t lane, std::int32_t tet, const SeenSegment& seen, double length,
             double slack, const Segment& segment) {
        const auto& no_value = picture_.no_value;
        if (!no_value.empty() && no_value[tet] != 0) return;
        MeshRay& ray = rays_[lane];
        if (!ray.lights) return ray.sum.add(seen.front, seen.back, length, slack);
        const GradientAlong gradient = gradient_along(segment(), seen.from, seen.to);
        ray.sum.add_lit(seen.front, seen.back, gradient, length, slack);
    }

    // Returns the gradient, which is linear, between two parameters of the ray.
    GradientAlong gradient_along(const TetSegment& segment, double from, double to) const {
        const glm::dvec3 in = gradient_at(segment.in), out = gradient_at(segment.out);
        const double length = segment.out.at - segment.in.at;
        const glm::dvec3 slope = length > 0 ? (out - in) / length : glm::dvec3(0);
        const glm::dvec3 front = in + (from - segment.in.at) * slope;
        GradientAlong along;
        for (int c = 0; c < 3; ++c) along[c] = {{front[c], (to - from) * slope[c]}};
        return along;
    }

    glm::dvec3 gradient_at(const FaceCrossing& crossing) const {
        const auto at = [&](std::size_t i) { return picture_.gradients[crossing.corners[i]]; };
        const glm::dvec3 first = at(0);
        return first +
               (crossing.weights[1] * (at(1) - first) + crossing.weights[2] * (at(2) - first));
    }

    const Picture& picture_;
    PreciseImage& image_;
    TileFaces faces_;
    bool listed_ = false;  // faces_ lists the tile's faces; otherwise rays search the tree
    PixelsInTurn pixels_;
    PacketWalk walk_;
    SeenLanes seen_{};
    std::vector<MeshRay> rays_;            // one a lane
    std::vector<TetSegment> overlapping_;  // memory of add_overlapping()
    TraceTotals totals_;
};

// Returns a distance from the eye that no point of the mesh exceeds.
double reach_of(const TetMesh& mesh, const View& view) {
    const glm::dvec3 lo = mesh.bounds().min - view.eye, hi = mesh.bounds().max - view.eye;
    return glm::length(glm::max(glm::abs(lo), glm::abs(hi)));
}

// Returns a mark for each tet with a value that is not finite; empty if there are none.
std::vector<char> tets_without_value(const TetMesh& mesh, std::span<const double> scalar) {
    if (std::all_of(scalar.begin(), scalar.end(), [](double s) { return std::isfinite(s); }))
        return {};
    std::vector<char> marked;
    marked.reserve(mesh.tets().size());
    for (const Tet& tet : mesh.tets()) {
        marked.push_back(std::any_of(tet.begin(), tet.end(), [&](std::int32_t corner) {
            return !std::isfinite(scalar[corner]);
        }));
    }
    return marked;
}

}  // namespace

TraceResult trace_mesh(const TetMesh& mesh, const FaceTree& open_faces,
                       std::span<const double> scalar, const TransferFunction& transfer_function,
                       const View& view, const TraceOptions& options, const TileDone& tile_done) {
    check(options);
    const TransferIntervals intervals(transfer_function);
    const std::vector<char> no_value = tets_without_value(mesh, scalar);
    std::vector<glm::dvec3> gradients;
    if (options.lighting) gradients = point_gradients(mesh, scalar);
    const MeshTile::Picture picture{mesh,      open_faces,          scalar,    no_value,
                                    gradients, transfer_function,   intervals, view,
                                    options,   reach_of(mesh, view)};
    const auto trace = [&](const PictureTile& tile, PreciseImage& image, const RowDone& row_done) {
        return MeshTile(picture, tile, image, row_done).trace();
    };
    return trace_tiles(view, trace, tile_done);
}

}  // namespace lamina
