// SPDX-License-Identifier: Apache-2.0
// Finds rays along surfaces:
//   for each open face of a visible tet, and each jump of the transfer function in a tet:
//       see the surface's corners in the picture, without what lies behind the eye
//       if they lie on a line, the surface is seen edge-on: if the center of a pixel lies on this
//       line, its ray runs along the surface
#include "facts/surface_rays.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>
#include <utility>

#include "base/parallel.h"
#include "optics/pieces.h"
#include "scene/camera.h"

namespace lamina {
namespace {

// Bound on the error of a scalar in float32, as a share of the window (equal to scalar_rounding in
// plan/choices.h), and the width, in such roundings, up to which a ramp counts as a jump.
constexpr double scalar_rounding = 0x1p-22, steep_width = 1024;

// Changes of at most this share of full scale (.0026 / 255) are not looked for.
constexpr double least_change = 1e-5;

// Distance in pixels between a ray and a surface at which they count as meeting: far more than
// tie_pixels (scene/camera.h) and the roundings of places in double precision.
constexpr double tie_distance = 1e-6;
// Steps of the places that walks have, as a share of the mesh's diagonal (docs/numerics.md,
// section 7), with a margin of 2.
constexpr double place_step = 0x1p-29;
// Pixels to which corners lie on a line in a first test, before the exact tolerance is known.
constexpr double nearly_edge_on = 0.01;

// The nearest depth, as a share of the diagonal, of what is looked at in perspective views.
constexpr double nearest = 1e-6;

// Scalars between which the transfer function jumps, and the change of a ray along this surface.
struct Jump {
    double lo, hi;
    double change;
};

// Bounds the change of a ray of this length if `share` of the optics' difference is exchanged.
double change_between(const OpticalProperties& a, const OpticalProperties& b, double length,
                      double share) {
    const glm::dvec3 apart = glm::abs(b.color - a.color);
    const double depth = share * std::abs(b.extinction - a.extinction) * length;
    const double seen = std::min(1.0, std::max(a.extinction, b.extinction) * length);
    return -std::expm1(-depth) + share * seen * std::max({apart.r, apart.g, apart.b});
}

// Returns the jumps at scalars of the range, ascending. A value at an end of the range counts: rays
// may run in a face of such values.
std::vector<Jump> jumps_of(const TransferFunction& transfer_function, const ValueRange& range,
                           double rounding, double length) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    std::vector<Jump> jumps;
    const auto add = [&](double lo, double hi, const OpticalProperties& a,
                         const OpticalProperties& b) {
        const double share = hi - lo > rounding ? rounding / (hi - lo) : 1;
        const double change = change_between(a, b, length, share);
        if (change > least_change) jumps.push_back({lo, hi, std::min(change, 1.0)});
    };
    std::optional<LinearPiece> before;
    for_each_linear_piece(transfer_function.knots(), std::nextafter(range.lo, -infinity),
                          std::nextafter(range.hi, infinity), [&](const LinearPiece& piece) {
                              if (before) add(piece.from, piece.from, before->at_to, piece.at_from);
                              if (piece.to - piece.from <= steep_width * rounding)
                                  add(piece.from, piece.to, piece.at_from, piece.at_to);
                              before = piece;
                          });
    return jumps;
}

// Up to six corners of a plane polygon, in any order.
template <typename Point>
class Corners {
  public:
    void add(const Point& point) { points_[count_++] = point; }
    const Point* begin() const { return points_.data(); }
    const Point* end() const { return points_.data() + count_; }
    std::size_t size() const { return count_; }

  private:
    std::array<Point, 6> points_{};
    std::size_t count_ = 0;
};

double distance_from_line(const glm::dvec2& point, const glm::dvec2& on, const glm::dvec2& along) {
    const glm::dvec2 way = point - on;
    return std::abs(way.x * along.y - way.y * along.x) / glm::length(along);
}

// A polygon that is seen edge-on: the ends of the line, and how wide it is, in pixels.
struct EdgeOn {
    glm::dvec2 from, to;
    double width = 0;

    double distance(const glm::dvec2& point) const {
        return distance_from_line(point, from, to - from);
    }
};

// Sees polygons in the picture.
class Picture {
  public:
    Picture(const Scene& scene, double diagonal)
        : window_(View(*scene.camera, scene.width, scene.height)),
          size_(scene.width, scene.height),
          near_(window_.perspective() ? nearest * diagonal : 0),
          place_step_(place_step * diagonal) {}

    const WindowView& window() const { return window_; }

    // Returns the polygon if it is nearly edge-on, without what lies behind the eye.
    std::optional<EdgeOn> edge_on(const Corners<glm::dvec3>& corners) const {
        if (corners.size() < 3) return {};
        const Corners<glm::dvec2> seen = project(corners);
        EdgeOn line;
        double longest = 0;
        for (const glm::dvec2& a : seen) {
            for (const glm::dvec2& b : seen) {
                const double length = glm::length(b - a);
                if (length > longest) line = {a, b};
                longest = std::max(longest, length);
            }
        }
        if (!(longest > 0) || !std::isfinite(longest)) return {};
        for (const glm::dvec2& point : seen) {
            line.width = std::max(line.width, line.distance(point));
            if (!(line.width <= nearly_edge_on)) return {};
        }
        return line;
    }

    // Returns the pixels that roundings of places may move a ray or the polygon.
    double tie(const Corners<glm::dvec3>& corners) const {
        double pixel = window_.view().pixel;
        if (window_.perspective()) {
            double depth = std::numeric_limits<double>::infinity();
            for (const glm::dvec3& corner : corners) depth = std::min(depth, corner.z);
            pixel *= std::max(depth, near_);
        }
        return tie_distance + place_step_ / pixel;
    }

    // Tells whether the center of a pixel is this near to the line.
    bool meets_pixel(const EdgeOn& line, double distance) const {
        const glm::dvec2 way = glm::abs(line.to - line.from);
        return way.x >= way.y ? meets(line, distance, 0, 1) : meets(line, distance, 1, 0);
    }

  private:
    // Looks at all pixels along the axis on which the line is longer. Their centers on the other
    // axis, from either side of the picture, lie halfway between whole numbers.
    bool meets(const EdgeOn& line, double distance, int along, int across) const {
        const auto [low, high] = std::minmax(line.from[along], line.to[along]);
        const double first = std::max(std::ceil(low - distance - 0.5), 0.0),
                     last = std::min(std::floor(high + distance - 0.5), size_[along] - 1.0);
        const double way = line.to[along] - line.from[along];
        const double slope = (line.to[across] - line.from[across]) / way;
        // A line that rises by at most 45 degrees is this far from a center at most, along the
        // axis.
        const double reach = std::sqrt(2) * distance;
        for (double pixel = first; pixel <= last; ++pixel) {
            const double at = line.from[across] + slope * (pixel + 0.5 - line.from[along]) - 0.5;
            const double center = std::round(at);
            if (std::abs(at - center) <= reach && center >= 0 && center < size_[across])
                return true;
        }
        return false;
    }

    Corners<glm::dvec2> project(const Corners<glm::dvec3>& corners) const {
        Corners<glm::dvec2> seen;
        for (const glm::dvec3& a : corners) {
            if (a.z < near_) continue;
            seen.add(window_.to_window(a));
            for (const glm::dvec3& b : corners) {
                if (b.z < near_)
                    seen.add(window_.to_window(a + (near_ - a.z) / (b.z - a.z) * (b - a)));
            }
        }
        return seen;
    }

    WindowView window_;
    glm::dvec2 size_;
    double near_;
    double place_step_;  // world units
};

// Looks for surfaces along which rays run, and keeps the largest change of one.
class SurfaceSearch {
  public:
    SurfaceSearch(const Scene& scene, const SceneMesh& mesh, const MeshFacts& facts)
        : transfer_function_(*scene.transfer_function),
          mesh_(mesh.mesh),
          values_(mesh.scalar.values),
          some_without_value_(facts.non_finite > 0),
          diagonal_(facts.diagonal),
          rounding_(scalar_rounding * (facts.window.hi - facts.window.lo)),
          jumps_(jumps_of(transfer_function_, facts.range, rounding_, facts.diagonal)),
          picture_(scene, facts.diagonal) {}

    double largest() {
        const auto faces = mesh_.open_faces();
        parallel_for(std::ssize(faces), 1 << 10,
                     [&](std::int64_t index) { look_at(faces[static_cast<std::size_t>(index)]); });
        if (jumps_.empty() && !some_without_value_) return largest_;
        parallel_for(std::ssize(mesh_.tets()), 1 << 10,
                     [&](std::int64_t index) { look_at_tet(static_cast<std::int32_t>(index)); });
        return largest_;
    }

  private:
    using Scalars = std::array<double, 4>;  // at a tet's corners

    void look_at(const TetFace& face) {
        const Scalars scalars = scalars_of(face.tet);
        const auto [least, most] = std::ranges::minmax(scalars);
        if (!std::isfinite(least + most)) return;
        const double shown = transfer_function_.max_extinction(least, most);
        const double change = -std::expm1(-shown * diagonal_);
        if (!(change > least_change)) return;
        Corners<glm::dvec3> corners;
        for (const glm::dvec3& corner : mesh_.corners(face))
            corners.add(picture_.window().see(corner));
        if (const auto line = picture_.edge_on(corners)) add_if_met(*line, corners, {}, change);
    }

    // Looks at the jumps in a tet, and at its faces to tets that show nothing for lack of a value.
    void look_at_tet(std::int32_t tet) {
        const Scalars scalars = scalars_of(tet);
        const auto [least, most] = std::ranges::minmax(scalars);
        if (!std::isfinite(least + most)) return;
        if (some_without_value_) {
            for (int face = 0; face < 4; ++face) {
                const std::int32_t behind =
                    mesh_
                        .neighbors()[static_cast<std::size_t>(tet)][static_cast<std::size_t>(face)];
                if (behind == TetMesh::no_neighbor) continue;
                const auto [a, b] = std::ranges::minmax(scalars_of(behind));
                if (!std::isfinite(a + b)) look_at({tet, face});
            }
        }
        if (least == most) return;  // a scalar and a jump beside it round alike
        auto jump = std::ranges::lower_bound(jumps_, least - rounding_, {}, &Jump::hi);
        for (; jump != jumps_.end() && jump->lo <= most + rounding_; ++jump)
            look_at(tet, scalars, std::clamp(0.5 * jump->lo + 0.5 * jump->hi, least, most), *jump);
    }

    void look_at(std::int32_t tet, const Scalars& scalars, double level, const Jump& jump) {
        std::array<glm::dvec3, 4> seen;
        for (std::size_t i = 0; i < 4; ++i) {
            const std::int32_t corner = mesh_.tets()[static_cast<std::size_t>(tet)][i];
            seen[i] = picture_.window().see(mesh_.points()[static_cast<std::size_t>(corner)]);
        }
        const auto on_level = [&](std::size_t i) {
            return std::abs(scalars[i] - level) <= rounding_;
        };
        Corners<glm::dvec3> corners;
        const auto [least, most] = std::ranges::minmax(scalars);
        for (std::size_t i = 0; i < 4; ++i) {
            if (on_level(i)) corners.add(seen[i]);
            for (std::size_t j = 0; j < i; ++j) {
                if (on_level(i) || on_level(j) || (scalars[i] < level) == (scalars[j] < level))
                    continue;
                const double share = (level - scalars[i]) / (scalars[j] - scalars[i]);
                corners.add(seen[i] + share * (seen[j] - seen[i]));
            }
        }
        if (std::max(most - level, level - least) <= rounding_) return add(jump.change);
        const auto line = picture_.edge_on(corners);
        if (!line) return;
        // Pixels for a unit of the scalar. It does not change along the line.
        double pixels = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            const bool in_front = !picture_.window().perspective() || seen[i].z > 0;
            if (in_front && !on_level(i))
                pixels = std::max(pixels, line->distance(picture_.window().to_window(seen[i])) /
                                              std::abs(scalars[i] - level));
        }
        add_if_met(*line, corners, {pixels * rounding_, pixels * 0.5 * (jump.hi - jump.lo)},
                   jump.change);
    }

    // Pixels by which roundings of scalars move a surface, and half the width of a steep ramp.
    struct Reach {
        double rounding = 0, ramp = 0;
    };

    void add_if_met(const EdgeOn& line, const Corners<glm::dvec3>& corners, const Reach& reach,
                    double change) {
        const double tie = picture_.tie(corners) + reach.rounding;
        if (line.width > tie || !picture_.meets_pixel(line, tie + reach.ramp)) return;
        add(change);
    }

    void add(double change) {
        double before = largest_;
        while (before < change && !largest_.compare_exchange_weak(before, change)) {
        }
    }

    Scalars scalars_of(std::int32_t tet) const {
        Scalars found{};
        for (std::size_t i = 0; i < 4; ++i) {
            found[i] =
                values_[static_cast<std::size_t>(mesh_.tets()[static_cast<std::size_t>(tet)][i])];
        }
        return found;
    }

    const TransferFunction& transfer_function_;
    const TetMesh& mesh_;
    const std::vector<double>& values_;
    bool some_without_value_;
    double diagonal_;
    double rounding_;  // of a scalar
    std::vector<Jump> jumps_;
    Picture picture_;
    std::atomic<double> largest_ = 0;
};

}  // namespace

double surface_ray_error(const Scene& scene, const SceneMesh& mesh, const MeshFacts& facts) {
    return SurfaceSearch(scene, mesh, facts).largest();
}

}  // namespace lamina
