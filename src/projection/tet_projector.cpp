// SPDX-License-Identifier: Apache-2.0
#include "projection/tet_projector.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace lamina {
namespace {

// A face seen edge-on is taken as inclined by this angle, so that its depth per pixel is a number;
// it is far below what moves rays aside that run along faces (GlProjectRenderer).
constexpr double least_inclination = 1e-16;

double largest(const glm::dvec3& v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

// The corners of a face in the order of their numbers, the same for both tets that share it.
std::array<std::size_t, 3> sorted_face(const Tet& tet, std::size_t face) {
    std::array<std::size_t, 3> corners = face_corners[face];
    const auto sort = [&](std::size_t& low, std::size_t& high) {
        if (tet[low] > tet[high]) std::swap(low, high);
    };
    sort(corners[0], corners[1]);
    sort(corners[1], corners[2]);
    sort(corners[0], corners[1]);
    return corners;
}

// Depths on faces in float32 are good enough where their rounding is at most this share of the
// tet's depth: a face that is seen so nearly edge-on that it exceeds this is met by the rays of
// hardly a pixel, unless whole walls of a mesh are.
constexpr double float_tolerance = 2e-3;

void set_pair(TetRecord::Pairs& pairs, std::size_t place, double value) {
    pairs.high[place] = static_cast<float>(value);
    pairs.low[place] = static_cast<float>(value - static_cast<double>(pairs.high[place]));
}

// The part of a tet in front of the near plane has at most 6 corners.
struct VisibleCorners {
    std::size_t count = 0;
    std::array<glm::dvec3, 6> seen;
};
VisibleCorners clip_near(const std::array<glm::dvec3, 4>& corners, double near) {
    VisibleCorners visible;
    const auto add = [&](const glm::dvec3& point) {
        if (visible.count < visible.seen.size()) visible.seen[visible.count++] = point;
    };
    for (std::size_t i = 0; i < 4; ++i) {
        const glm::dvec3& a = corners[i];
        if (a.z >= near) add(a);
        for (std::size_t j = i + 1; j < 4; ++j) {
            const glm::dvec3& b = corners[j];
            if ((a.z < near) == (b.z < near)) continue;
            const double share = (near - a.z) / (b.z - a.z);
            add({a.x + share * (b.x - a.x), a.y + share * (b.y - a.y), near});
        }
    }
    return visible;
}

}  // namespace

TetProjector::TetProjector(const TetMesh& mesh, std::span<const double> scalar,
                           const ValueRange& range, const View& view, double near_depth,
                           double margin)
    : points_(mesh.points()),
      tets_(mesh.tets()),
      scalar_(scalar),
      range_(range),
      window_(view),
      signer_(mesh, eye_of(view)),
      near_depth_(near_depth),
      margin_(margin) {}

// The plane through A, B, C with normal n is met by the ray z (x, y, 1) of the window place (x, y)
// at 1/z = n.(x, y, 1) / n.A, and by the parallel ray (x, y, z) at z = (n.A - n.(x, y, 0)) / n_z.
// Nothing but the face's own corners goes in, in the order of their numbers: the two tets of a face
// compute the same numbers, and no ray leaves one before or after it enters the other.
TetProjector::DepthPlane TetProjector::depth_plane(const Tet& tet, std::size_t face,
                                                   FaceSigns signs,
                                                   const std::array<Seen, 4>& corners) const {
    const auto sorted = sorted_face(tet, face);
    const Seen& a = corners[sorted[0]];
    const Seen& b = corners[sorted[1]];
    const Seen& c = corners[sorted[2]];
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    const double distance = glm::dot(normal, a);
    // Of the exact sign, where the face is not edge-on; the same for both tets where it is.
    const bool front = is_front(tet, face, signs);
    // right, up, forward are left-handed: determinants have the other sign than in the world.
    const double sign = front == turned_by_sorting(tet, face) ? -1 : 1;
    const double rounded = window_.perspective() ? distance : normal.z;
    const double reach = window_.perspective() ? std::max({largest(a), largest(b), largest(c)}) : 1;
    const double least = least_inclination * largest(normal) * reach;
    const double divisor = sign * std::max(sign * rounded, std::max(least, 1e-300));
    const double per_pixel = -window_.view().pixel / divisor;
    return {(window_.perspective() ? -normal.z : distance) / divisor, normal.x * per_pixel,
            normal.y * per_pixel, front};
}

TetProjector::Result TetProjector::set_depths(const Tet& tet, FaceSigns signs,
                                              const std::array<Seen, 4>& corners,
                                              const Extent& extent, TetRecord& record) const {
    const double column = record.center[0] - window_.middle().x,
                 row = record.center[1] - window_.middle().y;
    std::size_t first_back = 0, place_of_back = 3;
    double rounding = 0;
    for (std::size_t face = 0; face < 4; ++face) {
        const DepthPlane plane = depth_plane(tet, face, signs, corners);
        const std::size_t place = plane.front ? first_back++ : place_of_back--;
        const double at_center = plane.at_middle + column * plane.per_column + row * plane.per_row -
                                 static_cast<double>(record.center_depth);
        set_pair(record.depth, place, at_center);
        set_pair(record.depth_per_column, place, plane.per_column);
        set_pair(record.depth_per_row, place, plane.per_row);
        rounding =
            std::max(rounding, std::abs(at_center) + extent.columns * std::abs(plane.per_column) +
                                   extent.rows * std::abs(plane.per_row));
    }
    record.fronts = static_cast<std::uint32_t>(first_back);
    const bool steep =
        rounding * std::numeric_limits<float>::epsilon() > float_tolerance * extent.depth_range;
    return steep || first_back == 0 || extent.cut ? Result::careful : Result::plain;
}

void TetProjector::set_scalars(const Tet& tet, const std::array<Seen, 4>& corners,
                               TetRecord& record) const {
    std::array<double, 4> values;
    for (std::size_t i = 0; i < 4; ++i) {
        values[i] =
            (scalar_[static_cast<std::size_t>(tet[i])] - range_.lo) / (range_.hi - range_.lo);
    }
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    record.least_scalar = static_cast<float>(*least);
    record.largest_scalar = static_cast<float>(*most);
    const glm::dvec3 e1 = corners[1] - corners[0], e2 = corners[2] - corners[0],
                     e3 = corners[3] - corners[0];
    const glm::dvec3 n1 = glm::cross(e2, e3);
    glm::dvec3 gradient =
        ((values[1] - values[0]) * n1 + (values[2] - values[0]) * glm::cross(e3, e1) +
         (values[3] - values[0]) * glm::cross(e1, e2)) /
        glm::dot(e1, n1);
    // A tet without volume shows nothing, whatever its scalar.
    if (!(largest(gradient) < 1e30)) gradient = glm::dvec3(0);
    const double x = (record.center[0] - window_.middle().x) * window_.view().pixel,
                 y = (record.center[1] - window_.middle().y) * window_.view().pixel,
                 z = static_cast<double>(record.center_z);
    const glm::dvec3 direction = window_.perspective() ? glm::dvec3(x, y, 1) : glm::dvec3(0, 0, 1);
    const glm::dvec3 center = window_.perspective() ? z * direction : glm::dvec3(x, y, z);
    record.scalar = static_cast<float>(values[0] + glm::dot(gradient, center - corners[0]));
    record.scalar_per_z = static_cast<float>(glm::dot(gradient, direction));
    record.scalar_per_column = static_cast<float>(gradient.x * window_.view().pixel);
    record.scalar_per_row = static_cast<float>(gradient.y * window_.view().pixel);
}

TetProjector::Result TetProjector::project(std::int32_t index, TetRecord& record,
                                           ScreenPolygon& polygon) const {
    const Tet& tet = tets_[static_cast<std::size_t>(index)];
    std::array<Seen, 4> corners;
    for (std::size_t i = 0; i < 4; ++i)
        corners[i] = window_.see(points_[static_cast<std::size_t>(tet[i])]);
    const VisibleCorners visible = clip_near(corners, near_depth_);
    if (visible.count == 0) return Result::hidden;
    std::array<glm::dvec2, 6> places;
    double z = 0, nearest = INFINITY, farthest = 0;
    for (std::size_t i = 0; i < visible.count; ++i) {
        places[i] = window_.to_window(visible.seen[i]);
        z += visible.seen[i].z / static_cast<double>(visible.count);
        nearest = std::min(nearest, visible.seen[i].z);
        farthest = std::max(farthest, visible.seen[i].z);
    }
    polygon = surround({places.data(), visible.count}, margin_, window_.view().width,
                       window_.view().height);
    if (polygon.count == 0) return Result::hidden;
    glm::dvec2 lo(polygon.corners[0]), hi = lo;
    for (int i = 1; i < polygon.count; ++i) {
        const glm::dvec2 corner(polygon.corners[static_cast<std::size_t>(i)]);
        lo = glm::min(lo, corner);
        hi = glm::max(hi, corner);
    }
    const glm::dvec2 center = glm::floor(0.5 * (lo + hi)) + 0.5;
    const auto depth_of = [&](double at) { return window_.perspective() ? -1 / at : at; };
    record.center = {static_cast<float>(center.x), static_cast<float>(center.y)};
    record.center_depth = static_cast<float>(depth_of(z));
    record.center_z = window_.perspective() ? -1 / record.center_depth : record.center_depth;
    record.tet = static_cast<std::uint32_t>(index);
    // A change of 1/z means most at the far end.
    const double range = (farthest - nearest) / (window_.perspective() ? farthest * farthest : 1);
    const Extent extent{hi.x - lo.x, hi.y - lo.y, range, nearest <= near_depth_};
    set_scalars(tet, corners, record);
    return set_depths(tet, signer_.signs(static_cast<std::size_t>(index)), corners, extent, record);
}

}  // namespace lamina
