// SPDX-License-Identifier: Apache-2.0
#include "projection/fan_geometry.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>

#include "facts/drawn_range.h"
#include "optics/opacity.h"

namespace lamina {
namespace {

// Polygons reach this far beyond the picture, so that rounding uncovers no pixel centre in it.
constexpr double guard = 2;  // pixels

// Distance below which two corners count as one.
constexpr double same = 1e-9;  // pixels

// Shares of the corners of a face seen edge-on: negative at every pixel, so no ray meets the face.
constexpr glm::dvec3 nowhere(0, 0, -1);

// Distance from the picture, in pixels, up to which fans are drawn: nearer corners keep the
// sub-pixel digits of float32 and of rasterisers.
constexpr double farthest_beyond = 1024;

// Steps per pixel of the grid to which corners are rounded: 16 times those of most rasterisers.
constexpr double grid_steps = 4096;

// Returns the edge a, b of a triangle on the side of `inside`. It begins at the lesser corner, so
// that both triangles of the edge compute the same numbers. Points on an edge belong to its right
// triangle, on horizontal edges to the upper one (the top-left rule with rows running upwards).
TriangleRecord::Edge edge_of(glm::dvec2 a, glm::dvec2 b, const glm::dvec2& inside) {
    if (b.x < a.x || (b.x == a.x && b.y < a.y)) std::swap(a, b);
    const glm::dvec2 along = b - a;
    const bool left = cross(along, inside - a) > 0;
    const double sign = left ? 1 : -1;
    return {a.x, a.y, -sign * along.y, sign * along.x, along.y > 0 ? !left : left};
}

// Returns the share of the corner opposite the edge a, b. `area`: twice the triangle's signed area.
TriangleRecord::Share share_of(const glm::dvec2& a, const glm::dvec2& b, double area) {
    const glm::dvec2 along = (b - a) / area;
    return {a.x, a.y, -along.y, along.x};
}

}  // namespace

// Computes the shares. The ray z (x, y, 1) of a place meets the face a, b, c if it is a positive
// combination of these. The share of a is det(ray, b, c) / det(a, b, c), over z (Olano and Greer
// 1997, section 3; also with corners behind the eye). For parallel rays areas take the place of
// volumes. The axes right, up, forward are left-handed, so the divisor is positive for front faces.
FacePairs::FacePairs(const WindowView& window, double near_depth, const Tet& tet,
                     const std::array<glm::dvec3, 4>& seen, const Fronts& fronts)
    : window_(window), near_depth_(near_depth), seen_(seen), fronts_(fronts) {
    const bool perspective = window.perspective();
    // Returns the plane through an edge and the eye (or the line of the edge in the picture). All
    // faces that share the edge, in all tets, get the same numbers up to their sign.
    const auto edge = [&](std::size_t i, std::size_t j) {
        const double sign = tet[i] < tet[j] ? 1 : -1;
        if (tet[i] > tet[j]) std::swap(i, j);
        const glm::dvec3 &p = seen[i], &q = seen[j];
        if (perspective) return sign * glm::cross(p, q);
        return sign * glm::dvec3(p.y - q.y, q.x - p.x, p.x * q.y - p.y * q.x);
    };
    for (std::size_t face = 0; face < 4; ++face) {
        const auto& [a, b, c] = face_corners[face];
        const std::array<Linear, 3> opposite{edge(b, c), edge(c, a), edge(a, b)};
        const glm::dvec3 at = perspective ? seen[a] : glm::dvec3(seen[a].x, seen[a].y, 1);
        const double sign = fronts[face] ? 1 : -1, volume = sign * glm::dot(opposite[0], at);
        // A face through the eye is not met, because rays begin inside the tet.
        any_front_ = any_front_ || (fronts[face] && volume > 0);
        for (std::size_t i = 0; i < 3; ++i) {
            shares_[face][i] = volume > 0 ? opposite[i] / volume * sign : nowhere;
        }
        const glm::dvec3 normal = glm::cross(seen[b] - seen[a], seen[c] - seen[a]);
        inside_[face] = normal / glm::dot(normal, seen[face] - seen[a]);
        inside_at_eye_[face] = -glm::dot(inside_[face], seen[a]);
        cut_ = cut_ || seen[face].z < near_depth;
    }
    const glm::dvec2 lo(-guard), hi = 2.0 * window.middle() + guard;
    picture_ = {4, {lo, glm::dvec2(hi.x, lo.y), hi, glm::dvec2(lo.x, hi.y)}};
}

glm::dvec3 FacePairs::ray_at(const glm::dvec2& place) const {
    return {(place - window_.middle()) * window_.view().pixel, 1};
}

// Returns the polygon's region on which the function is not negative (Sutherland and Hodgman 1974).
FacePairs::Polygon FacePairs::cut(const Polygon& polygon, const Linear& function) const {
    Polygon clipped;
    const auto add = [&](const glm::dvec2& corner) {
        const auto near = [&](const glm::dvec2& other) {
            return glm::distance(corner, other) < same;
        };
        if (clipped.count == 0 || !near(clipped.corners[clipped.count - 1])) clipped.add(corner);
    };
    for (std::size_t i = 0; i < polygon.count; ++i) {
        const glm::dvec2 &a = polygon.corners[i], &b = polygon.corners[(i + 1) % polygon.count];
        const double at_a = glm::dot(function, ray_at(a)), at_b = glm::dot(function, ray_at(b));
        if (at_a >= 0) add(a);
        if ((at_a < 0) != (at_b < 0)) add(a + at_a / (at_a - at_b) * (b - a));
    }
    if (clipped.count > 1 &&
        glm::distance(clipped.corners[0], clipped.corners[clipped.count - 1]) < same)
        --clipped.count;
    if (clipped.count < 3) clipped.count = 0;
    return clipped;
}

// Returns the polygon's region whose rays meet the face.
FacePairs::Polygon FacePairs::seen_region(std::size_t face, const Polygon& polygon) const {
    Polygon clipped = polygon;
    for (const Linear& share : shares_[face]) {
        if (clipped.count > 0) clipped = cut(clipped, share);
    }
    return clipped;
}

// Returns the depth of a face's plane: 1/z, or z if rays are parallel.
FacePairs::Linear FacePairs::depth_of(std::size_t face) const {
    Linear depth(0);
    for (std::size_t i = 0; i < 3; ++i) {
        const double scale = window_.perspective() ? 1 : seen_[face_corners[face][i]].z;
        depth += scale * shares_[face][i];
    }
    return depth;
}

// Returns the polygon's region in which rays meet the face behind (or before) the near plane.
FacePairs::Polygon FacePairs::limited(const Polygon& polygon, std::size_t face,
                                      bool behind_near) const {
    if (!cut_ || polygon.count == 0) return polygon;
    const bool perspective = window_.perspective();
    const Linear beyond = perspective ? Linear(0, 0, 1 / near_depth_) - depth_of(face)
                                      : depth_of(face) - Linear(0, 0, near_depth_);
    return cut(polygon, behind_near ? beyond : -beyond);
}

FacePairs::Hit FacePairs::hit(std::size_t face, const glm::dvec2& place) const {
    const glm::dvec3 ray = ray_at(place);
    const bool perspective = window_.perspective();
    Hit hit{1, near_depth_, {}};
    if (face == near_plane) {
        if (perspective) hit.inverse_z = 1 / near_depth_;
        const glm::dvec3 along = perspective ? ray : glm::dvec3(ray.x, ray.y, near_depth_);
        for (std::size_t i = 0; i < 4; ++i)
            hit.shares[i] =
                std::max(glm::dot(inside_[i], along) + inside_at_eye_[i] * hit.inverse_z, 0.0);
        return hit;
    }
    double sum = 0, z = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t corner = face_corners[face][i];
        hit.shares[corner] = std::max(glm::dot(shares_[face][i], ray), 0.0);
        sum += hit.shares[corner];
        z += hit.shares[corner] * seen_[corner].z;
    }
    hit.inverse_z = perspective ? sum : 1;
    hit.z = perspective ? 1 / sum : z;
    return hit;
}

FanGeometry::FanGeometry(const SceneMesh& mesh, const TransferFunction& transfer_function,
                         const ProjectPlan& plan, const View& view)
    : mesh_(mesh),
      transfer_function_(transfer_function),
      plan_(plan),
      window_(view),
      signer_(mesh.mesh, eye_of(view)),
      divided_(window_.perspective() && plan.interpolation == Interpolation::perspective) {}

TetGeometry::Size FanGeometry::largest_size() {
    return {sizeof(FanVertex), most_vertices, most_indices, false};
}

FanGeometry::Corner FanGeometry::corner_of(std::int32_t point) const {
    const auto index = static_cast<std::size_t>(point);
    Corner corner;
    corner.seen = window_.see(mesh_.mesh.points()[index]);
    corner.window = window_.to_window(corner.seen);
    const double value = mesh_.scalar.values[index];
    if (plan_.source == SegmentSource::mean || plan_.source == SegmentSource::vertices) {
        const OpticalProperties optics = transfer_function_.at(value);
        corner.values = glm::dvec4(optics.color, optics.extinction);
    } else {
        corner.values =
            glm::dvec4((value - plan_.range.lo) / (plan_.range.hi - plan_.range.lo), 0, 0, 0);
    }
    return corner;
}

// Scales normalised scalars so that float32 can compute with them (facts/drawn_range.h).
void FanGeometry::bring_near(Corners& corners) {
    const auto [least, largest] =
        std::ranges::minmax(corners, {}, [](const Corner& corner) { return corner.values.x; });
    const double scale = far_scale(least.values.x, largest.values.x);
    for (Corner& corner : corners) corner.values.x *= scale;
}

FanGeometry::Fronts FanGeometry::fronts_of(std::int32_t index) const {
    const auto tet = static_cast<std::size_t>(index);
    const FaceSigns signs = signer_.signs(tet);
    Fronts fronts;
    for (std::size_t face = 0; face < 4; ++face)
        fronts[face] = is_front(mesh_.mesh.place(mesh_.mesh.tets()[tet]), face, signs);
    return fronts;
}

FanGeometry::Point FanGeometry::point_of(const Corner& corner) const {
    const double inverse = window_.perspective() ? 1 / corner.seen.z : 1;
    return {inverse, corner.seen.z, corner.values * inverse};
}

FanGeometry::Point FanGeometry::mix(std::span<const Point> points,
                                    std::span<const double> weights) const {
    Point sum{0, 0, glm::dvec4(0)};
    for (std::size_t i = 0; i < points.size(); ++i) {
        sum.inverse_z += weights[i] * points[i].inverse_z;
        sum.z += weights[i] * points[i].z;
        sum.values += weights[i] * points[i].values;
    }
    if (window_.perspective()) sum.z = 1 / sum.inverse_z;
    return sum;
}

// Makes a vertex from the points at which its ray enters and leaves the tet. `inverse_difference`:
// their difference of 1/z in perspective views, of z in orthographic ones.
FanVertex FanGeometry::thick_vertex(const glm::dvec2& window, const Point& front, const Point& back,
                                    double inverse_difference) const {
    const double difference = std::max(inverse_difference, 0.0);
    FanVertex vertex{};
    vertex.position = window;
    if (divided_) {
        vertex.inverse = glm::dvec3(front.inverse_z, back.inverse_z, difference);
        vertex.front = front.values;
        vertex.back = back.values;
        return vertex;
    }
    double thickness = difference;
    if (window_.perspective()) {
        thickness *= front.z * back.z;
        const glm::dvec2 place = (window - window_.middle()) * window_.view().pixel;
        if (plan_.thickness == Thickness::exact) thickness *= std::sqrt(1 + glm::dot(place, place));
    }
    vertex.inverse = glm::dvec3(0, 0, thickness);
    const glm::dvec4 at_front = front.values / front.inverse_z;
    const glm::dvec4 at_back = back.values / back.inverse_z;
    vertex.front = at_front;
    vertex.back = at_back;
    if (plan_.source == SegmentSource::vertices) {
        const glm::dvec4 mean = 0.5 * (at_front + at_back);
        vertex.front = glm::dvec4(glm::dvec3(mean), opacity_from_depth(mean.a * thickness));
    }
    return vertex;
}

FanVertex FanGeometry::thin_vertex(const Corner& corner) const {
    const Point point = point_of(corner);
    return thick_vertex(corner.window, point, point, 0);
}

bool FanGeometry::make_fan(const Corners& corners, const Fronts& fronts, Fan& fan) const {
    std::array<std::size_t, 4> front_faces{}, back_faces{};
    std::size_t front_count = 0, back_count = 0;
    for (std::size_t face = 0; face < 4; ++face) {
        if (fronts[face]) {
            front_faces[front_count++] = face;
        } else {
            back_faces[back_count++] = face;
        }
    }
    if (front_count == 1) return make_around_corner(corners, front_faces[0], true, fan);
    if (front_count == 3) return make_around_corner(corners, back_faces[0], false, fan);
    if (front_count != 2) return false;
    return make_around_crossing(corners, {front_faces[0], front_faces[1]},
                                {back_faces[0], back_faces[1]}, fan);
}

// Makes classes 1a and 1b (Kraus 2004, Figure 1): a corner is seen inside the face opposite.
bool FanGeometry::make_around_corner(const Corners& corners, std::size_t lone_face, bool front,
                                     Fan& fan) const {
    const Corner& apex = corners[lone_face];
    const auto& rim = face_corners[lone_face];
    std::array<double, 3> weights;
    std::array<Point, 3> points;
    double area = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec2& b = corners[rim[(i + 1) % 3]].window;
        const glm::dvec2& c = corners[rim[(i + 2) % 3]].window;
        weights[i] = cross(b - apex.window, c - apex.window);
        points[i] = point_of(corners[rim[i]]);
        area += weights[i];
    }
    if (area == 0 || !std::isfinite(area)) return false;
    // Difference of depth between the apex and the face (perspective: in 1/z). Differences of 1/z
    // come from differences of z (docs/numerics.md, section 6).
    double deeper = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        weights[i] = std::clamp(weights[i] / area, 0.0, 1.0);
        const double dz = apex.seen.z - corners[rim[i]].seen.z;
        deeper +=
            weights[i] * (window_.perspective() ? dz / (apex.seen.z * corners[rim[i]].seen.z) : dz);
    }
    const Point hit = mix(points, weights), tip = point_of(apex);
    fan.vertices[0] = front ? thick_vertex(apex.window, hit, tip, deeper)
                            : thick_vertex(apex.window, tip, hit, -deeper);
    fan.rim = 3;
    for (std::size_t i = 0; i < 3; ++i) fan.vertices[i + 1] = thin_vertex(corners[rim[i]]);
    return true;
}

// Makes class 2 (Kraus 2004, Figure 1), in which two edges cross in the picture. The two front
// faces share one of these edges, and the two back faces the other.
bool FanGeometry::make_around_crossing(const Corners& corners,
                                       const std::array<std::size_t, 2>& front_faces,
                                       const std::array<std::size_t, 2>& back_faces,
                                       Fan& fan) const {
    const Corner& i = corners[front_faces[0]];
    const Corner& j = corners[front_faces[1]];
    const Corner& k = corners[back_faces[0]];
    const Corner& l = corners[back_faces[1]];
    const glm::dvec2 along_front = l.window - k.window, along_back = j.window - i.window;
    const double area = cross(along_front, along_back);
    if (area == 0 || !std::isfinite(area)) return false;
    const glm::dvec2 apart = i.window - k.window;
    const double at_front = std::clamp(cross(apart, along_back) / area, 0.0, 1.0);
    const double at_back = std::clamp(cross(apart, along_front) / area, 0.0, 1.0);
    const std::array front_points{point_of(k), point_of(l)}, back_points{point_of(i), point_of(j)};
    const std::array front_weights{1 - at_front, at_front}, back_weights{1 - at_back, at_back};
    const Point front = mix(front_points, front_weights), back = mix(back_points, back_weights);
    const auto deeper = [&](const Corner& near, const Corner& far) {
        const double dz = far.seen.z - near.seen.z;
        return window_.perspective() ? dz / (far.seen.z * near.seen.z) : dz;
    };
    const double difference = deeper(k, i) + at_back * deeper(i, j) - at_front * deeper(k, l);
    fan.vertices[0] = thick_vertex(k.window + at_front * along_front, front, back, difference);
    fan.rim = 4;
    fan.vertices[1] = thin_vertex(j);
    fan.vertices[2] = thin_vertex(l);
    fan.vertices[3] = thin_vertex(i);
    fan.vertices[4] = thin_vertex(k);
    return true;
}

void FanGeometry::append(FanVertex vertex, const Owner& owner, const Place& place,
                         Written& written) {
    vertex.tet = static_cast<std::uint32_t>(owner.tet);
    vertex.scalars = owner.scalars;
    std::memcpy(place.vertices + written.vertices++ * sizeof(vertex), &vertex, sizeof(vertex));
}

void FanGeometry::append(const Fan& fan, const Owner& owner, const Place& place, Written& written) {
    const auto first = place.first_vertex + static_cast<std::uint32_t>(written.vertices);
    for (int i = 0; i <= fan.rim; ++i)
        append(fan.vertices[static_cast<std::size_t>(i)], owner, place, written);
    for (int i = 0; i < fan.rim; ++i) {
        place.indices[written.indices++] = first;
        place.indices[written.indices++] = first + 1 + static_cast<std::uint32_t>(i);
        place.indices[written.indices++] =
            first + 1 + static_cast<std::uint32_t>((i + 1) % fan.rim);
    }
}

TetGeometry::Written FanGeometry::write(const CellFragment& cell_fragment,
                                        const Place& place) const {
    const std::int32_t index = cell_fragment.tet;
    const Tet& tet = mesh_.mesh.tets()[static_cast<std::size_t>(index)];
    Corners corners;
    for (std::size_t i = 0; i < 4; ++i) corners[i] = corner_of(tet[i]);
    if (plan_.windowed) bring_near(corners);
    const auto [least, largest] =
        std::ranges::minmax(corners, {}, [](const Corner& corner) { return corner.values.x; });
    const Owner owner{index, {least.values.x, largest.values.x}};
    std::size_t behind = 0;
    glm::dvec2 lo(INFINITY), hi(-INFINITY);
    for (const Corner& corner : corners) {
        behind += corner.seen.z < plan_.near_depth;
        lo = glm::min(lo, corner.window);
        hi = glm::max(hi, corner.window);
    }
    if (behind == 4) return {};
    if (behind > 0) return write_pairs(owner, corners, place);
    const glm::dvec2 size = 2.0 * window_.middle();
    if (hi.x < 0 || hi.y < 0 || lo.x > size.x || lo.y > size.y) return {};
    // A tet that reaches far beyond the picture is cut to it, unless that changes the picture:
    // linear interpolation in perspective views needs the corners of whole tets, as in the paper.
    const glm::dvec2 beyond = glm::max(-lo, hi - size);
    const bool exact = divided_ || !window_.perspective();
    if (exact && std::max(beyond.x, beyond.y) > farthest_beyond)
        return write_pairs(owner, corners, place);
    Written written;
    Fan fan;
    if (make_fan(corners, fronts_of(index), fan)) append(fan, owner, place, written);
    return written;
}

TetGeometry::Written FanGeometry::write_pairs(const Owner& owner, const Corners& corners,
                                              const Place& place) const {
    const FacePairs pairs(window_, plan_.near_depth,
                          mesh_.mesh.place(mesh_.mesh.tets()[static_cast<std::size_t>(owner.tet)]),
                          {corners[0].seen, corners[1].seen, corners[2].seen, corners[3].seen},
                          fronts_of(owner.tet));
    const auto point_of = [&](const FacePairs::Hit& hit) {
        Point point{hit.inverse_z, hit.z, glm::dvec4(0)};
        for (std::size_t i = 0; i < 4; ++i) point.values += hit.shares[i] * corners[i].values;
        return point;
    };
    Written written;
    pairs.for_each([&](const FacePairs::Polygon& polygon, std::size_t front, std::size_t back) {
        assert(written.indices + 3 * (polygon.count - 2) <= most_indices);
        const auto first = place.first_vertex + static_cast<std::uint32_t>(written.vertices);
        for (std::size_t i = 0; i < polygon.count; ++i) {
            const Point at_front = point_of(pairs.hit(front, polygon.corners[i]));
            const Point at_back = point_of(pairs.hit(back, polygon.corners[i]));
            const double difference = window_.perspective() ? at_front.inverse_z - at_back.inverse_z
                                                            : at_back.z - at_front.z;
            append(thick_vertex(polygon.corners[i], at_front, at_back, difference), owner, place,
                   written);
        }
        for (std::uint32_t i = 2; i < polygon.count; ++i) {
            for (const std::uint32_t corner : {0u, i - 1, i})
                place.indices[written.indices++] = first + corner;
        }
    });
    return written;
}

// Exact up to 2^44 pixels from the picture's corner, so functions of edges are exact up to 2^17.
glm::dvec2 rounded_to_grid(const glm::vec2& window) {
    const auto rounded = [](float v) {
        return std::floor(static_cast<double>(v) * grid_steps + 0.5) / grid_steps;
    };
    return {rounded(window.x), rounded(window.y)};
}

bool make_triangle(const std::array<const FanVertex*, 3>& vertices, TriangleRecord& record) {
    std::array<glm::dvec2, 3> places, exact;
    for (std::size_t i = 0; i < 3; ++i) {
        places[i] = rounded_to_grid(vertices[i]->position);
        exact[i] = glm::dvec2(vertices[i]->position);
    }
    const auto area_of = [](const std::array<glm::dvec2, 3>& p) {
        return cross(p[1] - p[0], p[2] - p[0]);
    };
    const double rounded_area = area_of(places);
    if (!(std::abs(rounded_area) > 0) || !std::isfinite(rounded_area)) return false;
    // Rounding widens slivers and may turn them over. Interpolation between their exact corners
    // would then be extrapolation by far, so it is between the rounded corners.
    const bool is_sliver = area_of(exact) * rounded_area <= 0.01 * rounded_area * rounded_area;
    const std::array<glm::dvec2, 3>& between = is_sliver ? places : exact;
    const double area = area_of(between);
    for (std::size_t i = 0; i < 3; ++i) {
        record.edges[i] = edge_of(places[(i + 1) % 3], places[(i + 2) % 3], places[i]);
        record.shares[i] = share_of(between[(i + 1) % 3], between[(i + 2) % 3], area);
        record.corners[i] = {vertices[i]->inverse, vertices[i]->front, vertices[i]->back};
    }
    record.scalars = vertices[0]->scalars;
    record.number = vertices[0]->tet;
    return true;
}

}  // namespace lamina
