// SPDX-License-Identifier: Apache-2.0
#include "reference/mesh_tile.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "mesh/scalar_range.h"

namespace lamina {
namespace {

// Ends of segments are accurate to this many epsilons of the largest distance and coordinate on the
// ray (mesh/ray_walk.h: 8 for a corner's place, as much for weights and parameter).
constexpr double place_epsilons = 16;

SegmentSum empty_sum(const MeshTile::Picture& picture) {
    return {picture.transfer_function, picture.intervals,
            place_epsilons * std::numeric_limits<double>::epsilon() * picture.reach,
            picture.options.tolerance};
}

}  // namespace

MeshTile::MeshTile(const Picture& picture, const PictureTile& tile, PreciseImage& image,
                   const RowDone& row_done)
    : picture_(picture),
      image_(image),
      faces_(picture.mesh, picture.open_faces, picture.view),
      listed_(faces_.list(tile)),
      pixels_({tile.column, tile.row}, {tile.column + tile.width - 1, tile.row + tile.height - 1},
              row_done),
      walk_(picture.mesh, picture.open_faces, picture.scalar),
      rays_(PacketWalk::width, {{0, 0}, 0, std::nullopt, empty_sum(picture)}) {}

MeshTile::Totals MeshTile::trace() {
    constexpr LaneSet all = lane_bit(PacketWalk::width) - 1;
    while (true) {
        for_each_lane(all & ~walk_.walking(), [&](std::size_t lane) { begin(lane); });
        if (walk_.walking() == 0) return totals_;
        const LaneSet walked = walk_.walking();
        walk_.step();
        find_seen(walk_.lanes(), picture_.intervals.columns(), seen_);
        for_each_lane(walked & seen_.shown, [&](std::size_t lane) {
            add_shown(lane);
            if (rays_[lane].sum.opaque()) walk_.stop(lane);
        });
        for_each_lane(walked & ~walk_.walking(), [&](std::size_t lane) { go_on(lane); });
    }
}

// Begins rays until one walks, or no pixel is left.
void MeshTile::begin(std::size_t lane) {
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

// Enters the mesh once more, or ends the ray.
void MeshTile::go_on(std::size_t lane) {
    MeshRay& ray = rays_[lane];
    const RayWalk& line = walk_.ray(lane);
    if (!line.overlapping() && !ray.sum.opaque() && ray.entered < line.entries().size())
        return walk_.enter(lane, line.entries()[ray.entered++]);
    ray.sum.finish();
    // Light is added to what is there: rounding may leave -1e-17 of a colour that it takes away.
    const glm::dvec3 color =
        ray.lights ? glm::max(ray.sum.color(), glm::dvec3(0)) : ray.sum.color();
    double* const pixel = image_.pixel(ray.pixel.x, ray.pixel.y);
    for (int channel = 0; channel < 3; ++channel) pixel[channel] = color[channel];
    pixel[3] = ray.sum.alpha();
    totals_.error_estimate = std::max(totals_.error_estimate, ray.sum.error_estimate());
    totals_.segments += ray.sum.segments();
}

void MeshTile::add_overlapping(std::size_t lane) {
    ++totals_.overlapping;
    const SeenRange range{seen_.first[lane], seen_.last[lane]};
    walk_.ray(lane).list(overlapping_);
    for (const TetSegment& segment : overlapping_) {
        const Tet& tet = picture_.mesh.tets()[static_cast<std::size_t>(segment.tet)];
        const auto [least, most] = range_in(picture_.scalar, tet);
        const SeenSegment part = seen_segment(segment, range, picture_.scalar);
        const double slack = scalar_slack(least, most);
        const auto [lo, hi] = std::minmax(part.front, part.back);
        if (part.from < part.to && picture_.intervals.visible(lo - slack, hi + slack))
            add(lane, segment.tet, part, (part.to - part.from) * seen_.world_per_z[lane], slack,
                [&] { return segment; });
    }
}

void MeshTile::add_shown(std::size_t lane) {
    const SeenSegment part{seen_.from[lane], seen_.to[lane], seen_.front[lane], seen_.back[lane]};
    add(lane, walk_.tet(lane), part, seen_.length[lane], seen_.slack[lane],
        [&] { return walk_.segment(lane); });
}

// Adds a part of segment(), which is in that tet.
template <typename Segment>
void MeshTile::add(std::size_t lane, std::int32_t tet, const SeenSegment& part, double length,
                   double slack, const Segment& segment) {
    const auto& no_value = picture_.no_value;
    if (!no_value.empty() && no_value[static_cast<std::size_t>(tet)] != 0) return;
    MeshRay& ray = rays_[lane];
    if (!ray.lights) return ray.sum.add(part.front, part.back, length, slack);
    const GradientAlong gradient = gradient_along(segment(), part.from, part.to);
    ray.sum.add_lit(part.front, part.back, gradient, length, slack);
}

// Between two parameters of the ray: linear.
GradientAlong MeshTile::gradient_along(const TetSegment& segment, double from, double to) const {
    const glm::dvec3 in = gradient_at(segment.in), out = gradient_at(segment.out);
    const double length = segment.out.at - segment.in.at;
    const glm::dvec3 slope = length > 0 ? (out - in) / length : glm::dvec3(0);
    const glm::dvec3 front = in + (from - segment.in.at) * slope;
    GradientAlong along;
    for (int c = 0; c < 3; ++c)
        along[static_cast<std::size_t>(c)] = {{front[c], (to - from) * slope[c]}};
    return along;
}

glm::dvec3 MeshTile::gradient_at(const FaceCrossing& crossing) const {
    const auto at = [&](std::size_t i) {
        return picture_.gradients[static_cast<std::size_t>(crossing.corners[i])];
    };
    const glm::dvec3 first = at(0);
    return first + (crossing.weights[1] * (at(1) - first) + crossing.weights[2] * (at(2) - first));
}

}  // namespace lamina
