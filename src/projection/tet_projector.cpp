// SPDX-License-Identifier: Apache-2.0
#include "projection/tet_projector.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "facts/drawn_range.h"
#include "optics/segment_integral.h"
#include "projection/stored_gradients.h"
#include "projection/tet_view-inl.h"

namespace lamina {
namespace {

using LAMINA_LEAST(finite);
using OneTet = LAMINA_LEAST(TetView)<double>;

// Angle by which a face seen edge-on is taken as inclined, so that its depth per pixel is a number.
// It is far below the perturbation of rays that run along faces (GlProjectRenderer).
constexpr double least_inclination = 1e-16;

double largest(const glm::dvec3& v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

// Width, as a share of its distance, below which a tet is a needle. Seen from the eye, its corners
// are rounded by about a 1000th of its width, and planes through them may lie anywhere along it. A
// ray meets it only by a chance of about this share.
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
    return static_cast<float>(finite(value));
}

std::array<float, 4> finite_floats(const std::array<double, 4>& values) {
    return {finite_float(values[0]), finite_float(values[1]), finite_float(values[2]),
            finite_float(values[3])};
}

void set_center(const OneTet& tet, SeenTet& record) {
    record.center = {static_cast<float>(tet.center_x), static_cast<float>(tet.center_y)};
    record.center_depth = static_cast<float>(tet.center_depth);
    record.center_z = static_cast<float>(tet.center_z);
}

void set_scalars(const OneTet::Linear& linear, SeenTet& record) {
    record.scalar = finite_float(linear[0]);
    record.scalar_per_z = finite_float(linear[1]);
    record.scalar_per_column = finite_float(linear[2]);
    record.scalar_per_row = finite_float(linear[3]);
}

// Returns the linear function (value - origin) * scale.
OneTet::Linear linear(const OneTet& tet, const PartField& field, double origin, double scale) {
    return tet.linear((field.at(tet.center()) - origin) * scale, field.gradient() * scale);
}

OpticalProperties optics_at(const LinearPiece& piece, double scalar) {
    return interpolate({piece.from, piece.at_from}, {piece.to, piece.at_to}, scalar);
}

// Only the face's own corners are used, in the order of their numbers, so that the two tets of a
// face compute the same numbers, and no ray leaves one before or after it enters the other. `front`
// is the exact sign of a face that is not edge-on, and equal for both tets of one that is.
OneTet::DepthPlane depth_plane(const OneTet& view, const Tet& tet, std::size_t face, bool front,
                               const std::array<glm::dvec3, 4>& corners) {
    const auto sorted = sorted_face(tet, face);
    const glm::dvec3& a = corners[sorted[0]];
    const glm::dvec3& b = corners[sorted[1]];
    const glm::dvec3& c = corners[sorted[2]];
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    const double distance = glm::dot(normal, a);
    // right, up, forward are left-handed, so determinants have the other sign than in the world.
    const double sign = front == turned_by_sorting(tet, face) ? -1 : 1;
    const double reach = view.perspective() ? std::max({largest(a), largest(b), largest(c)}) : 1;
    const double least = least_inclination * largest(normal) * reach;
    const double rounded = view.divisor(normal, distance);
    return view.plane(normal, distance, sign * std::max(sign * rounded, std::max(least, 1e-300)));
}

// Returns whether float32 is good enough for the depths. `cut`: the near plane cuts the tet.
bool set_depths(const OneTet& view, const Tet& tet, FaceSigns signs, bool cut,
                const std::array<glm::dvec3, 4>& corners, SilhouetteRecord& record) {
    SeenTet& seen = record.seen();
    std::size_t first_back = 0, place_of_back = 3;
    double rounding = 0;
    for (std::size_t face = 0; face < 4; ++face) {
        const bool front = is_front(tet, face, signs);
        const OneTet::DepthPlane plane = depth_plane(view, tet, face, front, corners);
        const std::size_t place = front ? first_back++ : place_of_back--;
        set_pair(seen.depth, place, plane.depth);
        set_pair(seen.depth_per_column, place, plane.per_column);
        set_pair(seen.depth_per_row, place, plane.per_row);
        rounding = std::max(rounding, view.size_of(plane));
    }
    record.tet.fronts = static_cast<std::uint32_t>(first_back);
    const bool steep =
        rounding * std::numeric_limits<float>::epsilon() > float_tolerance * view.depth_range;
    return !(steep || first_back == 0 || cut);
}

// Returns whether float32 is good enough for the scalars.
bool set_whole(const OneTet& view, const PartField& field, const ValueRange& range,
               TetRecord& record) {
    const double width = range.hi - range.lo;
    const auto normalised = [&](double value) { return (value - range.lo) / width; };
    const double least = normalised(field.least()), largest = normalised(field.largest());
    const double shrink = far_scale(least, largest), scale = (1 / width) * shrink;
    const OneTet::Linear exact = linear(view, field, range.lo, scale);
    set_scalars(exact, record.seen);
    record.least = static_cast<float>(least * shrink);
    record.largest = static_cast<float>(largest * shrink);
    const SeenTet& seen = record.seen;
    const std::array rounded{seen.scalar, seen.scalar_per_z, seen.scalar_per_column,
                             seen.scalar_per_row};
    for (std::size_t i = 0; i < exact.size(); ++i)
        record.scalar_rest[i] = finite_float(exact[i] - static_cast<double>(rounded[i]));
    return !runs_beyond({field.least(), field.largest()}, range, far_for_floats);
}

// Returns a cut of a fragment, or a plane in front of everything if the tet has no scalars beyond
// `level`.
OneTet::Level cut_at(const OneTet& view, const PartField& field, double level, bool is_cut) {
    if (!is_cut) return {{-beyond_all, 0, 0}, true};
    return view.level(field.gradient(), level - field.at(glm::dvec3(0)));
}

void set_part(const OneTet& view, const PartField& field, const LinearPiece& piece,
              FragmentRecord& record) {
    const double width = field.largest() - field.least();
    set_scalars(linear(view, field, field.least(), width > 0 ? 1 / width : 0), record.seen);
    const auto [lower, lower_front] = cut_at(view, field, field.least(), field.cut_low());
    const auto [upper, above] = cut_at(view, field, field.largest(), field.cut_high());
    record.lower_cut = {static_cast<float>(lower.depth), static_cast<float>(lower.per_column),
                        static_cast<float>(lower.per_row)};
    record.upper_cut = static_cast<float>(upper.depth);
    record.upper_cut_per_column = static_cast<float>(upper.per_column);
    record.upper_cut_per_row = static_cast<float>(upper.per_row);
    // The fragment lies below the upper cut.
    const bool upper_front = !field.cut_high() || !above;
    if (lower_front) record.fronts |= FragmentRecord::lower_cut_is_front;
    if (upper_front) record.fronts |= FragmentRecord::upper_cut_is_front;
    const auto optics = [&](double scalar) {
        const OpticalProperties found = optics_at(piece, scalar);
        return finite_floats({found.color.r, found.color.g, found.color.b, found.extinction});
    };
    record.low = optics(field.least());
    record.high = optics(field.largest());
}

// Returns whether no segment through the fragment is deeper than thin_depth.
bool is_thin(const std::array<glm::dvec3, 4>& corners, const FragmentRecord& record) {
    const double most = std::max(record.low[3], record.high[3]);
    return LAMINA_LEAST(longest_edge)<double>(corners) * most <= thin_depth;
}

void set_gradients(const OneTet& view, const Tet& tet, std::span<const glm::vec3> gradients,
                   const std::array<glm::dvec3, 4>& corners, GradientRecord& lit) {
    double largest_of_tet = 0;
    for (const std::int32_t corner : tet) {
        const glm::vec3& gradient = gradients[static_cast<std::size_t>(corner)];
        largest_of_tet = std::max(largest_of_tet, largest(glm::dvec3(gradient)));
    }
    const double scale = StoredGradients::scale_of_tet(largest_of_tet);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        PartField::Values values;
        for (std::size_t i = 0; i < 4; ++i) {
            const glm::vec3& gradient = gradients[static_cast<std::size_t>(tet[i])];
            values[i] = static_cast<double>(gradient[static_cast<int>(axis)]);
        }
        const auto [at_center, per_z, per_column, per_row] =
            finite_floats(linear(view, PartField(corners, values, nullptr), 0, scale));
        lit.components[axis] = {at_center, per_z, per_column, per_row};
    }
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
    OneTet seen(view());
    const auto bounds = seen.place_center(std::span(visible.seen).first(visible.count));
    set_center(seen, record.seen());
    const bool cut = bounds.nearest <= near_depth_;
    outline = outline_of(visible, field, cut);
    if (outline.count == 0 ||
        pixel_bounds(outline.points(), margin_, view().width, view().height).empty())
        return std::nullopt;
    const FaceSigns signs = signer_.signs(static_cast<std::size_t>(part.tet));
    bool plain = set_depths(seen, tet, signs, cut, corners, record);
    if (piece != nullptr) {
        set_part(seen, field, *piece, record.fragment);
    } else {
        plain = set_whole(seen, field, range_, record.tet) && plain;
    }
    record.tet.number = part_number(part, tets_.size());
    if (lit != nullptr) set_gradients(seen, tet, gradients_, corners, *lit);
    if (!plain) return FragmentKind::careful;
    const bool thin = piece != nullptr && is_thin(corners, record.fragment);
    return thin ? FragmentKind::thin : FragmentKind::plain;
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
