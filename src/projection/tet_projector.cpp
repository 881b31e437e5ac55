// SPDX-License-Identifier: Apache-2.0
#include "projection/tet_projector.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "facts/far_scalars.h"
#include "optics/front_weights.h"
#include "projection/stored_gradients.h"

namespace lamina {
namespace {

// A face seen edge-on is taken as inclined by this angle, so that its depth per pixel is a number.
// The angle is far below the perturbation of rays that run along faces (GlProjectRenderer).
constexpr double least_inclination = 1e-16;

double largest(const glm::dvec3& v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

// A tet thinner than this share of its distance is a needle. Seen from the eye, its corners are
// rounded by some 1000th of its width, and planes through them may lie anywhere along it. A ray
// meets it only by a chance of about this share.
constexpr double least_width = 0x1p-42;

bool is_too_thin(const std::array<glm::dvec3, 4>& corners) {
    double reach = 0, longest = 0, widest = 0;  // widest: twice a face's area
    for (const glm::dvec3& corner : corners) reach = std::max(reach, largest(corner));
    for (std::size_t i = 0; i < 4; ++i) {
        const glm::dvec3& from = corners[i];
        const glm::dvec3 a = corners[(i + 1) % 4] - from, b = corners[(i + 2) % 4] - from;
        longest = std::max({longest, largest(a), largest(b)});
        widest = std::max(widest, largest(glm::cross(a, b)));
    }
    return widest <= least_width * reach * longest;
}

// Returns the corners of a face in the order of their numbers, which is the same for both tets that
// share it.
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

void set_pair(SeenTet::Pairs& pairs, std::size_t place, double value) {
    pairs.high[place] = static_cast<float>(value);
    pairs.low[place] = static_cast<float>(value - static_cast<double>(pairs.high[place]));
}

float finite_float(double value) {
    return static_cast<float>(std::clamp(value, -beyond_all, beyond_all));
}

void set_scalars(const std::array<double, 4>& linear, SeenTet& record) {
    record.scalar = finite_float(linear[0]);
    record.scalar_per_z = finite_float(linear[1]);
    record.scalar_per_column = finite_float(linear[2]);
    record.scalar_per_row = finite_float(linear[3]);
}

// Returns a bound on the optical depth of all runs through a part.
double largest_depth(const std::array<glm::dvec3, 4>& corners, const FragmentRecord& record) {
    double longest = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = i + 1; j < 4; ++j)
            longest = std::max(longest, glm::distance(corners[i], corners[j]));
    }
    return longest * std::max(record.low[3], record.high[3]);
}

OpticalProperties optics_at(const LinearPiece& piece, double scalar) {
    return interpolate({piece.from, piece.at_from}, {piece.to, piece.at_to}, scalar);
}

}  // namespace

TetProjector::TetProjector(const TetMesh& mesh, std::span<const double> scalar,
                           const ValueRange& range, const TetPieces& pieces, const View& view,
                           double near_depth, double margin, std::span<const glm::vec3> gradients)
    : points_(mesh.points()),
      tets_(mesh.tets()),
      scalar_(scalar),
      gradients_(gradients),
      range_(range),
      pieces_(pieces),
      window_(view),
      signer_(mesh, eye_of(view)),
      near_depth_(near_depth),
      margin_(margin) {}

// The ray z (x, y, 1) of the window place (x, y) meets the plane through A, B, C with normal n at
// 1/z = n.(x, y, 1) / n.A, and the parallel ray (x, y, z) at z = (n.A - n.(x, y, 0)) / n_z. Only
// the face's own corners are used, in the order of their numbers, so that the two tets of a face
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
    // This is the exact sign where the face is not edge-on, and the same for both tets where it is.
    const bool front = is_front(tet, face, signs);
    // right, up, forward are left-handed, so determinants have the other sign than in the world.
    const double sign = front == turned_by_sorting(tet, face) ? -1 : 1;
    const double rounded = window_.perspective() ? distance : normal.z;
    const double reach = window_.perspective() ? std::max({largest(a), largest(b), largest(c)}) : 1;
    const double least = least_inclination * largest(normal) * reach;
    const double divisor = sign * std::max(sign * rounded, std::max(least, 1e-300));
    const double per_pixel = -window_.view().pixel / divisor;
    return {(window_.perspective() ? -normal.z : distance) / divisor, normal.x * per_pixel,
            normal.y * per_pixel, front};
}

bool TetProjector::set_depths(const Tet& tet, FaceSigns signs, const std::array<Seen, 4>& corners,
                              const Extent& extent, SilhouetteRecord& record) const {
    SeenTet& seen = record.seen();
    std::size_t first_back = 0, place_of_back = 3;
    double rounding = 0;
    for (std::size_t face = 0; face < 4; ++face) {
        const DepthPlane plane = depth_plane(tet, face, signs, corners);
        const std::size_t place = plane.front ? first_back++ : place_of_back--;
        const double at_center = depth_at_center(plane, seen);
        set_pair(seen.depth, place, at_center);
        set_pair(seen.depth_per_column, place, plane.per_column);
        set_pair(seen.depth_per_row, place, plane.per_row);
        rounding =
            std::max(rounding, std::abs(at_center) + extent.columns * std::abs(plane.per_column) +
                                   extent.rows * std::abs(plane.per_row));
    }
    record.tet.fronts = static_cast<std::uint32_t>(first_back);
    const bool steep =
        rounding * std::numeric_limits<float>::epsilon() > float_tolerance * extent.depth_range;
    return !(steep || first_back == 0 || extent.cut);
}

double TetProjector::depth_at_center(const DepthPlane& plane, const SeenTet& record) const {
    const double column = record.center[0] - window_.middle().x,
                 row = record.center[1] - window_.middle().y;
    return plane.at_middle + column * plane.per_column + row * plane.per_row -
           static_cast<double>(record.center_depth);
}

// Returns the depth at the record's center, per column and per row. A level that passes through the
// eye is seen edge-on: all three are huge, and only the side of the edge on which a pixel lies
// counts.
std::array<float, 3> TetProjector::plane_at_center(const DepthPlane& plane,
                                                   const SeenTet& record) const {
    const glm::dvec3 exact(depth_at_center(plane, record), plane.per_column, plane.per_row);
    const glm::dvec3 kept = exact * std::min(1.0, beyond_all / std::max(largest(exact), 1.0));
    return {static_cast<float>(kept.x), static_cast<float>(kept.y), static_cast<float>(kept.z)};
}

// With the scalar e at the eye and its gradient g, the ray z (x, y, 1) meets a level at
// 1/z = g.(x, y, 1) / (level - e). Where the level lies above e, it is a front to larger scalars.
TetProjector::DepthPlane TetProjector::level_plane(const PartField& field, double level) const {
    const glm::dvec3& gradient = field.gradient();
    const double above_eye = level - field.at(glm::dvec3(0));
    const double divisor = window_.perspective() ? above_eye : gradient.z;
    const bool front = divisor >= 0;
    const double kept = front ? std::max(divisor, 1e-200) : std::min(divisor, -1e-200);
    const double per_pixel = -window_.view().pixel / kept;
    return {(window_.perspective() ? -gradient.z : above_eye) / kept, gradient.x * per_pixel,
            gradient.y * per_pixel, front};
}

// Returns the depth of a z, and the z of a depth.
double TetProjector::inverted(double value) const {
    return window_.perspective() ? -1 / value : value;
}

// Returns the linear function (value - origin) * scale.
TetProjector::Linear TetProjector::linear(const PartField& field, double origin, double scale,
                                          const SeenTet& record) const {
    const double x = (record.center[0] - window_.middle().x) * window_.view().pixel,
                 y = (record.center[1] - window_.middle().y) * window_.view().pixel,
                 // Shaders measure depths from here. center_z is rounded, by much of a small tet
                 // far away.
        z = inverted(static_cast<double>(record.center_depth));
    const glm::dvec3 direction = window_.perspective() ? glm::dvec3(x, y, 1) : glm::dvec3(0, 0, 1);
    const glm::dvec3 center = window_.perspective() ? z * direction : glm::dvec3(x, y, z);
    const glm::dvec3 gradient = field.gradient() * scale;
    return {(field.at(center) - origin) * scale, glm::dot(gradient, direction),
            gradient.x * window_.view().pixel, gradient.y * window_.view().pixel};
}

bool TetProjector::set_whole(const PartField& field, TetRecord& record) const {
    const double width = range_.hi - range_.lo;
    const auto normalised = [&](double value) { return (value - range_.lo) / width; };
    const double least = normalised(field.least()), largest = normalised(field.largest());
    const double shrink = far_scale(least, largest), scale = (1 / width) * shrink;
    const Linear exact = linear(field, range_.lo, scale, record.seen);
    set_scalars(exact, record.seen);
    record.least = static_cast<float>(least * shrink);
    record.largest = static_cast<float>(largest * shrink);
    const SeenTet& seen = record.seen;
    const std::array rounded{seen.scalar, seen.scalar_per_z, seen.scalar_per_column,
                             seen.scalar_per_row};
    for (std::size_t i = 0; i < exact.size(); ++i)
        record.scalar_rest[i] = finite_float(exact[i] - static_cast<double>(rounded[i]));
    return !runs_beyond({field.least(), field.largest()}, range_, far_for_floats);
}

void TetProjector::set_gradients(const Tet& tet, const std::array<Seen, 4>& corners,
                                 const SeenTet& record, GradientRecord& lit) const {
    double largest_of_tet = 0;
    for (const std::int32_t corner : tet) {
        const glm::vec3& gradient = gradients_[static_cast<std::size_t>(corner)];
        largest_of_tet = std::max(largest_of_tet, largest(glm::dvec3(gradient)));
    }
    const double scale = StoredGradients::scale_of_tet(largest_of_tet);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        PartField::Values values;
        for (std::size_t i = 0; i < 4; ++i) {
            const glm::vec3& gradient = gradients_[static_cast<std::size_t>(tet[i])];
            values[i] = static_cast<double>(gradient[static_cast<int>(axis)]);
        }
        const auto [at_center, per_z, per_column, per_row] =
            linear(PartField(corners, values, nullptr), 0, scale, record);
        lit.components[axis] = {finite_float(at_center), finite_float(per_z),
                                finite_float(per_column), finite_float(per_row)};
    }
}

void TetProjector::set_part(const PartField& field, const LinearPiece& piece,
                            FragmentRecord& record) const {
    const double width = field.largest() - field.least();
    set_scalars(linear(field, field.least(), width > 0 ? 1 / width : 0, record.seen), record.seen);
    const DepthPlane before_all{-beyond_all, 0, 0, true};
    const DepthPlane lower = field.cut_low() ? level_plane(field, field.least()) : before_all;
    DepthPlane upper = before_all;
    if (field.cut_high()) {  // the part lies below this cut
        upper = level_plane(field, field.largest());
        upper.front = !upper.front;
    }
    record.lower_cut = plane_at_center(lower, record.seen);
    const std::array<float, 3> upper_cut = plane_at_center(upper, record.seen);
    record.upper_cut = upper_cut[0];
    record.upper_cut_per_column = upper_cut[1];
    record.upper_cut_per_row = upper_cut[2];
    if (lower.front) record.fronts |= FragmentRecord::lower_cut_is_front;
    if (upper.front) record.fronts |= FragmentRecord::upper_cut_is_front;
    const auto optics = [&](double scalar) -> std::array<float, 4> {
        const OpticalProperties found = optics_at(piece, scalar);
        return {finite_float(found.color.r), finite_float(found.color.g),
                finite_float(found.color.b), finite_float(found.extinction)};
    };
    record.low = optics(field.least());
    record.high = optics(field.largest());
}

TetProjector::VisibleCorners TetProjector::clip_near(const std::array<Seen, 4>& corners) const {
    VisibleCorners visible;
    const auto add = [&](const glm::dvec3& point) {
        if (visible.count < visible.seen.size()) visible.seen[visible.count++] = point;
    };
    for (std::size_t i = 0; i < 4; ++i) {
        const glm::dvec3& a = corners[i];
        if (a.z >= near_depth_) add(a);
        for (std::size_t j = i + 1; j < 4; ++j) {
            const glm::dvec3& b = corners[j];
            if ((a.z < near_depth_) == (b.z < near_depth_)) continue;
            const double share = (near_depth_ - a.z) / (b.z - a.z);
            add({a.x + share * (b.x - a.x), a.y + share * (b.y - a.y), near_depth_});
        }
    }
    return visible;
}

std::optional<FragmentKind> TetProjector::project(const TetPart& part, SilhouetteRecord& record,
                                                  ScreenOutline& outline,
                                                  GradientRecord* lit) const {
    const Tet& tet = tets_[static_cast<std::size_t>(part.tet)];
    std::array<Seen, 4> corners;
    PartField::Values values;
    for (std::size_t i = 0; i < 4; ++i) {
        corners[i] = window_.see(points_[static_cast<std::size_t>(tet[i])]);
        values[i] = scalar_[static_cast<std::size_t>(tet[i])];
    }
    const VisibleCorners visible = clip_near(corners);
    if (visible.count == 0 || is_too_thin(corners)) return std::nullopt;
    const LinearPiece* const piece = part.piece == TetPart::whole
                                         ? nullptr
                                         : &pieces_.pieces()[static_cast<std::size_t>(part.piece)];
    const PartField field(corners, values, piece);
    const Extent extent = place_center(visible, record.seen());
    outline = outline_of(visible, field, extent.cut);
    if (outline.count == 0 ||
        pixel_bounds(outline.points(), margin_, view().width, view().height).empty())
        return std::nullopt;
    bool plain =
        set_depths(tet, signer_.signs(static_cast<std::size_t>(part.tet)), corners, extent, record);
    if (piece != nullptr) {
        set_part(field, *piece, record.fragment);
    } else {
        plain = set_whole(field, record.tet) && plain;
    }
    record.tet.number = part_number(part, tets_.size());
    if (lit != nullptr) set_gradients(tet, corners, record.seen(), *lit);
    if (!plain) return FragmentKind::careful;
    const bool thin = piece != nullptr && largest_depth(corners, record.fragment) <= thin_depth;
    return thin ? FragmentKind::thin : FragmentKind::plain;
}

// The center is the same for all parts of a tet, so that they find their common cuts at the same
// depth.
TetProjector::Extent TetProjector::place_center(const VisibleCorners& visible,
                                                SeenTet& record) const {
    glm::dvec2 lo(INFINITY), hi(-INFINITY);
    double z = 0, nearest = INFINITY, farthest = 0;
    for (std::size_t i = 0; i < visible.count; ++i) {
        const glm::dvec2 place = window_.to_window(visible.seen[i]);
        lo = glm::min(lo, place);
        hi = glm::max(hi, place);
        z += visible.seen[i].z / static_cast<double>(visible.count);
        nearest = std::min(nearest, visible.seen[i].z);
        farthest = std::max(farthest, visible.seen[i].z);
    }
    const glm::dvec2 picture = 2.0 * window_.middle();
    lo = glm::clamp(lo, glm::dvec2(0), picture);
    hi = glm::clamp(hi, glm::dvec2(0), picture);
    const glm::dvec2 center = glm::floor(0.5 * (lo + hi)) + 0.5;
    record.center = {static_cast<float>(center.x), static_cast<float>(center.y)};
    record.center_depth = static_cast<float>(inverted(z));
    record.center_z = static_cast<float>(inverted(static_cast<double>(record.center_depth)));
    // A change of 1/z changes z most at the far end.
    const double range = (farthest - nearest) / (window_.perspective() ? farthest * farthest : 1);
    return {hi.x - lo.x, hi.y - lo.y, range, nearest <= near_depth_};
}

ScreenOutline TetProjector::outline_of(const VisibleCorners& visible, const PartField& field,
                                       bool cut_by_near) const {
    ScreenOutline outline;
    const auto add = [&](const Seen& point) {
        outline.corners[outline.count++] = window_.to_window(point);
    };
    if (cut_by_near || !(field.cut_low() || field.cut_high())) {
        std::for_each_n(visible.seen.begin(), visible.count, add);
    } else {
        const PartField::Outline corners = field.outline();
        std::for_each_n(corners.corners.begin(), corners.count, add);
    }
    return outline;
}

}  // namespace lamina
