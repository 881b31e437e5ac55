// SPDX-License-Identifier: Apache-2.0
#include "projection/fan_geometry.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>

#include "facts/drawn_range.h"
#include "optics/opacity.h"

namespace lamina {
namespace {

// Distance from the picture, in pixels, up to which corners of fans keep the sub-pixel digits of
// float32 and of rasterisers.
constexpr double farthest_beyond = 1024;

}  // namespace

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
        fronts[face] = is_front(mesh_.mesh.tets()[tet], face, signs);
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

// `inverse_difference` is that of inverse depths in perspective views, and of depths in
// orthographic ones.
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

// Makes classes 1a and 1b (Kraus 2004, Figure 1), in which a corner is seen inside the face
// opposite.
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

// Makes class 2, in which two edges cross. The two front faces share the edge of the other two
// corners, and so do the back faces.
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

TetGeometry::Written FanGeometry::write(const TetPart& part, const Place& place) const {
    const std::int32_t index = part.tet;
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
    // Linear interpolation is the paper's only between the corners of whole tets.
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
    const FacePairs pairs(
        window_, plan_.near_depth, mesh_.mesh.tets()[static_cast<std::size_t>(owner.tet)],
        {corners[0].seen, corners[1].seen, corners[2].seen, corners[3].seen}, fronts_of(owner.tet));
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

}  // namespace lamina
