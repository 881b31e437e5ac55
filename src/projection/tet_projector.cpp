// SPDX-License-Identifier: Apache-2.0
// TetProjector::project(), for a whole tet or a cell fragment, in double precision:
//   1. Transform the corners to eye space, and clip the tet at the near plane.
//   2. Place the center (tet_view-inl.h), and drop the tet if its outline covers no pixel centre.
//   3. For each face: its depth as a linear function of the pixel, front faces first.
//   4. The scalar, the planes that cut a cell fragment, and gradients, relative to the center.
//   5. Choose the FragmentKind: careful if float32 does not suffice.
#include "projection/tet_projector.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "optics/segment_integral.h"
#include "projection/tet_setup.h"
#include "projection/tet_view-inl.h"
#include "simd/vectors-inl.h"

LAMINA_SIMD_BEGIN
namespace {

// All pairs of a front face and a back face, one pair in each of four lanes (some repeat a pair):
// front_of[n] and back_of[n] have their indices in SeenTet if n faces are front faces.
alignas(16) constexpr std::int32_t front_of[4][4] = {
    {0, 0, 0, 0}, {0, 0, 0, 0}, {0, 1, 0, 1}, {0, 1, 2, 2}};
alignas(16) constexpr std::int32_t back_of[4][4] = {
    {0, 0, 0, 0}, {1, 2, 3, 3}, {2, 2, 3, 3}, {3, 3, 3, 3}};

// Safety margins of the outline, relative to depths and in pixels. They exceed all rounding errors
// of float32, because no visible pixel may lie outside the outline.
constexpr float rounding = 1e-6f, least_slack = 1e-3f;

// Smallest |c| / |r| in find_outline(). Flatter lines are tilted to it, so that they bound columns.
constexpr float oblique = 1e-4f;

}  // namespace

// Bounds the blocks of pixels whose rays may meet the tet. A ray meets it only if the difference of
// back depth and front depth is positive for each pair of a front and a back face. For the block
// whose first pixel lies X columns and Y rows from the area's first pixel, the largest difference
// in the block is at most  largest + c X - r Y. The block may thus be visible only if
//
//   X >= (-largest + r Y) / c   (c > 0: a least column),  or  X <= (-largest + r Y) / c   (c < 0)
//
// The lanes of a vector hold the four pairs of faces.
TetOutline find_outline(const SilhouetteRecord& record, const PixelArea& area, int image_rows,
                        int block) {
    const float middle = 0.5f * static_cast<float>(block - 1);  // from a block's first pixel centre
    const SeenTet& seen = record.seen();
    const float columns = static_cast<float>(area.last_column - area.first_column),
                rows = static_cast<float>(area.last_row - area.first_row);
    // The middle of the area's first block, from the record's center.
    const float column = static_cast<float>(area.first_column) + 0.5f - seen.center[0] + middle,
                row = static_cast<float>(image_rows - area.first_row) - 0.5f - seen.center[1] -
                      middle;
    const std::uint32_t fronts = record.front_faces() & 3u;
    const Int4 front = load<Int4>(front_of[fronts]), back = load<Int4>(back_of[fronts]);
    const Float4 depth = load<Float4>(seen.depth.high.data()),
                 per_column = load<Float4>(seen.depth_per_column.high.data()),
                 per_row = load<Float4>(seen.depth_per_row.high.data());
    const auto difference = [&](Float4 v)
                                LAMINA_LAMBDA { return permute(v, back) - permute(v, front); };
    const float slack =
        least_slack + rounding * (std::abs(column) + std::abs(row) + columns + rows + 64);
    const Float4 slack_of_face = (abs(per_column) + abs(per_row)) * slack + abs(depth) * rounding;
    const Float4 c = difference(per_column), r = difference(per_row);
    const Float4 abs_c = abs(c), abs_r = abs(r);
    const Float4 at_middle = difference(depth) + c * column + r * row;
    const Float4 to_corner = abs_c * middle + abs_r * (middle + oblique * (columns + 8));
    const Float4 largest =
        at_middle + to_corner + (permute(slack_of_face, back) + permute(slack_of_face, front));
    const Float4 steepness = max(max(abs_c, abs_r * oblique), 1e-30f);
    const auto is_least = c >= 0;
    const Float4 divisor = select(is_least, steepness, -steepness);
    TetOutline outline;
    store_unaligned(-largest / divisor, outline.at_first.data());
    store_unaligned(r / divisor, outline.per_row.data());
    outline.least = static_cast<std::uint8_t>(bits_of(is_least));
    return outline;
}

LAMINA_SIMD_END

namespace lamina {
namespace {

// Binary exponent of the smallest gradient after StoredGradients::scale: 2^-40 to 2^-39. Its square
// is about 2^-80; float32 then still holds the squares of gradients that are 2^20 times as short.
constexpr int smallest_exponent = -40;

// Limit of a gradient's components after StoredGradients::scale; longer gradients are shortened.
constexpr double longest_stored = 0x1p120;

using LAMINA_LEAST(finite);
using OneTet = LAMINA_LEAST(TetView)<double>;

// Smallest angle, in radians, between a face and the rays. Faces seen edge-on are tilted to it, so
// that depth per pixel is finite. ray_perturbation() moves rays by a far larger angle.
constexpr double least_inclination = 1e-16;

// Returns the largest size of a component.
double largest(const glm::dvec3& v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

bool is_needle(const std::array<glm::dvec3, 4>& corners) {
    // double_area: twice the area of the largest face.
    double distance = 0, longest_edge = 0, double_area = 0;
    for (const glm::dvec3& corner : corners) distance = std::max(distance, largest(corner));
    for (std::size_t i = 0; i < 4; ++i) {
        const glm::dvec3& from = corners[i];
        const glm::dvec3 a = corners[(i + 1) % 4] - from, b = corners[(i + 2) % 4] - from;
        longest_edge = std::max({longest_edge, largest(a), largest(b)});
        double_area = std::max(double_area, largest(glm::cross(a, b)));
    }
    return double_area <= least_width * distance * longest_edge;
}

// Returns the corners of a face by ascending place (`tet`: the corners' places): one order for both
// tets that share it.
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

// Stores a double as the sum of two floats.
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

void set_scalars(const OneTet::Linear& linear, SeenTet& record) {
    record.scalar = finite_float(linear[0]);
    record.scalar_per_z = finite_float(linear[1]);
    record.scalar_per_column = finite_float(linear[2]);
    record.scalar_per_row = finite_float(linear[3]);
}

// Returns (scalar - origin) * scale as a linear function of window coordinates and z.
OneTet::Linear linear(const OneTet& tet, const TetField& field, double origin, double scale) {
    return tet.linear((field.at(tet.center()) - origin) * scale, field.gradient() * scale);
}

// Returns the plane of a face. It is computed from the face's sorted corners alone, so that both
// tets that share the face get identical numbers: no ray leaves one tet before or after it enters
// the other. `front`: is_front(), which is exact. If the plane is edge-on or, by rounding, seen
// from the wrong side, it is tilted.
OneTet::DepthPlane depth_plane(const OneTet& view, const Tet& tet, std::size_t face, bool front,
                               const std::array<glm::dvec3, 4>& corners) {
    const auto sorted = sorted_face(tet, face);
    const glm::dvec3& a = corners[sorted[0]];
    const glm::dvec3& b = corners[sorted[1]];
    const glm::dvec3& c = corners[sorted[2]];
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    const double distance = glm::dot(normal, a);
    // Eye space (right, up, forward) is left-handed: determinants change their sign.
    const double sign = front == turned_by_sorting(tet, face) ? -1 : 1;
    const double distance_of_corners =
        view.perspective() ? std::max({largest(a), largest(b), largest(c)}) : 1;
    const double least = least_inclination * largest(normal) * distance_of_corners;
    const double divisor = view.divisor(normal, distance);
    return view.plane(normal, distance, sign * std::max(sign * divisor, std::max(least, 1e-300)));
}

// Sets the faces' planes; returns true if float32 suffices for them. `cut`: the near plane cuts it.
bool set_depths(const OneTet& view, const Tet& tet, FaceSigns signs, bool cut,
                const std::array<glm::dvec3, 4>& corners, SilhouetteRecord& record) {
    SeenTet& seen = record.seen();
    std::size_t next_front = 0, next_back = 3;  // front faces come first
    double largest_term = 0;                    // of the terms whose rounding affects depths
    for (std::size_t face = 0; face < 4; ++face) {
        const bool front = is_front(tet, face, signs);
        const OneTet::DepthPlane plane = depth_plane(view, tet, face, front, corners);
        const std::size_t place = front ? next_front++ : next_back--;
        set_pair(seen.depth, place, plane.depth);
        set_pair(seen.depth_per_column, place, plane.per_column);
        set_pair(seen.depth_per_row, place, plane.per_row);
        largest_term = std::max(largest_term, view.size_of(plane));
    }
    record.tet.fronts = static_cast<std::uint32_t>(next_front);
    const bool inexact =
        largest_term * std::numeric_limits<float>::epsilon() > float_tolerance * view.depth_range;
    const bool eye_inside = next_front == 0;
    return !(inexact || eye_inside || cut);
}

// Sets a whole tet's scalars, normalised to `range`. Returns true if float32 suffices for them.
bool set_whole(const OneTet& view, const TetField& field, const ValueRange& range,
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

// Returns the plane on which the scalar is `level`, where a cell fragment ends. If it does not end
// there (`is_cut` is false), returns a front plane in front of everything, which cuts nothing.
OneTet::Level cut_at(const OneTet& view, const TetField& field, double level, bool is_cut) {
    if (!is_cut) return {{-beyond_all, 0, 0}, true};
    return view.level(field.gradient(), level - field.at(glm::dvec3(0)));
}

// Sets a cell fragment's scalars, normalised to its own range, its two cuts, and the optics there.
void set_fragment(const OneTet& view, const TetField& field, const LinearPiece& piece,
                  FragmentRecord& record) {
    const double width = field.largest() - field.least();
    set_scalars(linear(view, field, field.least(), width > 0 ? 1 / width : 0), record.seen);
    const auto [lower, lower_front] = cut_at(view, field, field.least(), field.cut_low());
    // cut_at() tells whether a plane is the front of the region with larger scalars. The fragment
    // lies below its upper plane, so that answer is negated.
    const auto [upper, front_of_above] = cut_at(view, field, field.largest(), field.cut_high());
    record.lower_cut = {static_cast<float>(lower.depth), static_cast<float>(lower.per_column),
                        static_cast<float>(lower.per_row)};
    record.upper_cut = static_cast<float>(upper.depth);
    record.upper_cut_per_column = static_cast<float>(upper.per_column);
    record.upper_cut_per_row = static_cast<float>(upper.per_row);
    const bool upper_front = !field.cut_high() || !front_of_above;
    if (lower_front) record.fronts |= FragmentRecord::lower_cut_is_front;
    if (upper_front) record.fronts |= FragmentRecord::upper_cut_is_front;
    const auto optics = [&](double scalar) {
        const OpticalProperties found =
            interpolate({piece.from, piece.at_from}, {piece.to, piece.at_to}, scalar);
        return finite_floats({found.color.r, found.color.g, found.color.b, found.extinction});
    };
    record.low = optics(field.least());
    record.high = optics(field.largest());
}

// Sets the gradient in a tet, component by component, shortened by StoredGradients::scale_of_tet().
void set_gradients(const OneTet& view, const Tet& tet, std::span<const glm::vec3> gradients,
                   const std::array<glm::dvec3, 4>& corners, GradientRecord& lit) {
    double largest_of_tet = 0;
    for (const std::int32_t corner : tet) {
        const glm::vec3& gradient = gradients[static_cast<std::size_t>(corner)];
        largest_of_tet = std::max(largest_of_tet, largest(glm::dvec3(gradient)));
    }
    const double scale = StoredGradients::scale_of_tet(largest_of_tet);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        TetField::Values values;
        for (std::size_t i = 0; i < 4; ++i) {
            const glm::vec3& gradient = gradients[static_cast<std::size_t>(tet[i])];
            values[i] = static_cast<double>(gradient[static_cast<int>(axis)]);
        }
        const auto [at_center, per_z, per_column, per_row] =
            finite_floats(linear(view, TetField(corners, values, nullptr), 0, scale));
        lit.components[axis] = {at_center, per_z, per_column, per_row};
    }
}

}  // namespace

TetField::TetField(const Corners& corners, const Values& values, const LinearPiece* piece)
    : corners_(corners), values_(values) {
    const auto [least, largest] = std::ranges::minmax(values);
    least_ = least;
    largest_ = largest;
    if (piece != nullptr) {
        cut_low_ = piece->from > least;
        cut_high_ = piece->to < largest;
        least_ = std::clamp(least, piece->from, piece->to);
        largest_ = std::clamp(largest, piece->from, piece->to);
    }
    const glm::dvec3 e1 = corners[1] - corners[0], e2 = corners[2] - corners[0],
                     e3 = corners[3] - corners[0];
    const LAMINA_LEAST(TetSlopes)<double> slopes(corners);
    gradient_ =
        slopes.numerator(values[1] - values[0], values[2] - values[0], values[3] - values[0]) /
        slopes.determinant;
    // A tet without volume is invisible, whatever its gradient; 0 avoids infinity and NaN.
    const double extent = std::max({lamina::largest(e1), lamina::largest(e2), lamina::largest(e3)});
    if (!(lamina::largest(gradient_) * extent < 1e30 * (largest - least)))
        gradient_ = glm::dvec3(0);
}

FewPoints<glm::dvec3, 8> TetField::outline() const {
    FewPoints<glm::dvec3, 8> outline;
    for (std::size_t i = 0; i < 4; ++i) {
        if (values_[i] >= least_ && values_[i] <= largest_) outline.add(corners_[i]);
        for (std::size_t j = i + 1; j < 4; ++j) {
            const auto crosses = [&](double level) {
                return (values_[i] < level && values_[j] > level) ||
                       (values_[i] > level && values_[j] < level);
            };
            // The points of the edge from corner i to corner j at which the region ends.
            for (const double level : {least_, largest_}) {
                if (!crosses(level)) continue;
                const double share = (level - values_[i]) / (values_[j] - values_[i]);
                outline.add(corners_[i] + share * (corners_[j] - corners_[i]));
            }
        }
    }
    return outline;
}

StoredGradients::StoredGradients(std::span<const glm::dvec3> gradients, double smallest) {
    if (smallest > 0)
        scale = std::ldexp(1.0, std::clamp(smallest_exponent - std::ilogb(smallest), -1000, 1000));
    at_points.reserve(gradients.size());
    for (const glm::dvec3& g : gradients) {
        const double length = largest(g) * scale;
        at_points.emplace_back(length > longest_stored ? g * scale * (longest_stored / length)
                                                       : g * scale);
    }
}

float StoredGradients::smallest_square(const Lighting& lighting) const {
    const double smallest = std::clamp(*lighting.smallest_gradient * scale, 1e-15, 1e15);
    return static_cast<float>(smallest * smallest);
}

TetProjector::VisibleCorners TetProjector::clip_near(const TetField::Corners& corners) const {
    VisibleCorners visible;
    for (std::size_t i = 0; i < 4; ++i) {
        const glm::dvec3& a = corners[i];
        if (a.z >= tets_.near_depth) visible.add(a);
        for (std::size_t j = i + 1; j < 4; ++j) {
            const glm::dvec3& b = corners[j];
            if ((a.z < tets_.near_depth) == (b.z < tets_.near_depth)) continue;
            const double share = (tets_.near_depth - a.z) / (b.z - a.z);
            visible.add({a.x + share * (b.x - a.x), a.y + share * (b.y - a.y), tets_.near_depth});
        }
    }
    return visible;
}

std::optional<FragmentKind> TetProjector::project(const CellFragment& cell_fragment,
                                                  SilhouetteRecord& record, ScreenOutline& outline,
                                                  GradientRecord* lit) const {
    const Tet& tet = tets_.mesh.tets()[static_cast<std::size_t>(cell_fragment.tet)];
    TetField::Corners corners;
    TetField::Values values;
    for (std::size_t i = 0; i < 4; ++i) {
        corners[i] = tets_.window.see(tets_.mesh.points()[static_cast<std::size_t>(tet[i])]);
        values[i] = tets_.scalar[static_cast<std::size_t>(tet[i])];
    }
    const VisibleCorners visible = clip_near(corners);
    if (visible.count == 0 || is_needle(corners)) return std::nullopt;
    const LinearPiece* const piece = tets_.piece_of(cell_fragment);
    const TetField field(corners, values, piece);
    const View& view = tets_.view();
    OneTet seen(view);
    const auto bounds = seen.place_center(visible.points());
    record.seen().center = {static_cast<float>(seen.center_x), static_cast<float>(seen.center_y)};
    record.seen().center_depth = static_cast<float>(seen.center_depth);
    record.seen().center_z = static_cast<float>(seen.center_z);
    const bool cut = bounds.nearest <= tets_.near_depth;
    outline = outline_of(visible, field, cut);
    if (outline.count == 0 ||
        pixel_bounds(outline.points(), tets_.margin, view.width, view.height).empty())
        return std::nullopt;
    const FaceSigns signs = signer_.signs(static_cast<std::size_t>(cell_fragment.tet));
    bool float_suffices = set_depths(seen, tets_.mesh.place(tet), signs, cut, corners, record);
    if (piece != nullptr) {
        set_fragment(seen, field, *piece, record.fragment);
    } else {
        float_suffices = set_whole(seen, field, tets_.range, record.tet) && float_suffices;
    }
    record.tet.number = cell_fragment_number(cell_fragment, tets_.mesh.tets().size());
    if (lit != nullptr) set_gradients(seen, tet, tets_.gradients, corners, *lit);
    if (!float_suffices) return FragmentKind::careful;
    if (piece == nullptr) return FragmentKind::plain;
    const double extinction = std::max(record.fragment.low[3], record.fragment.high[3]);
    const double largest_depth = LAMINA_LEAST(longest_edge)<double>(corners) * extinction;
    return largest_depth <= thin_depth ? FragmentKind::thin : FragmentKind::plain;
}

ScreenOutline TetProjector::outline_of(const VisibleCorners& visible, const TetField& field,
                                       bool cut_by_near) const {
    ScreenOutline outline;
    const auto add = [&](const auto& corners) {
        for (const glm::dvec3& corner : corners.points())
            outline.add(tets_.window.to_window(corner));
    };
    if (cut_by_near || !(field.cut_low() || field.cut_high())) {
        add(visible);
    } else {
        add(field.outline());
    }
    return outline;
}

TetGeometry::Size SilhouetteGeometry::largest_size(bool lit) {
    constexpr std::size_t corners = ScreenPolygon::most_corners;
    return {sizeof(SilhouetteVertex), corners, 3 * (corners - 2), true, lit};
}

TetGeometry::Written SilhouetteGeometry::write(const CellFragment& cell_fragment,
                                               const Place& place) const {
    ScreenOutline outline;
    SilhouetteRecord record;  // copied when complete: `place` may be memory that is slow to read
    GradientRecord gradient;
    GradientRecord* const lit = place.gradient != nullptr ? &gradient : nullptr;
    const std::optional<FragmentKind> kind =
        projector_.project(cell_fragment, record, outline, lit);
    if (!kind) return {};
    const ScreenPolygon polygon =
        surround(outline.points(), projector_.tets().margin, projector_.tets().view().width,
                 projector_.tets().view().height);
    if (polygon.count == 0) return {};
    std::memcpy(place.record, &record, sizeof(record));
    if (lit != nullptr) std::memcpy(place.gradient, &gradient, sizeof(gradient));
    Written written;
    written.kind = *kind;
    for (int i = 0; i < polygon.count; ++i) {
        const SilhouetteVertex vertex{polygon.corners[static_cast<std::size_t>(i)],
                                      place.record_number};
        std::memcpy(place.vertices + written.vertices++ * sizeof(vertex), &vertex, sizeof(vertex));
    }
    for (std::uint32_t i = 2; i < written.vertices; ++i) {  // a fan of triangles
        place.indices[written.indices++] = place.first_vertex;
        place.indices[written.indices++] = place.first_vertex + i - 1;
        place.indices[written.indices++] = place.first_vertex + i;
    }
    return written;
}

TetOutline outline_of(const SilhouetteRecord& record, const PixelArea& area, int image_rows,
                      int block) {
    return LAMINA_LEAST(find_outline)(record, area, image_rows, block);
}

}  // namespace lamina
