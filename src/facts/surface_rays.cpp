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
#include <span>
#include <utility>

#include "base/parallel.h"
#include "mesh/few_points.h"
#include "optics/optics_change.h"
#include "optics/pieces.h"
#include "scene/camera.h"

namespace lamina {
namespace {

// Changes of at most this share of full scale (.0026 / 255) are not looked for.
constexpr double least_change = 1e-5;

// Distance in pixels between a ray and a surface at which they count as meeting: far more than
// tie_pixels (scene/camera.h) and the roundings of places in double precision.
constexpr double tie_distance = 1e-6;
// Steps of the places that walks have, as a share of the mesh's diagonal (docs/numerics.md,
// section 7), with a margin of 2.
constexpr double place_step = 0x1p-29;
// The nearest depth, as a share of the diagonal, of what is looked at in perspective views.
constexpr double nearest = 1e-6;

// Scalars between which the transfer function jumps, and the change of a ray along this surface.
struct Jump {
    double lo, hi;
    double change;
};

// Returns the jumps at scalars of the range, ascending. A value at an end of the range counts: rays
// may run in a face of such values.
std::vector<Jump> jumps_of(const TransferFunction& transfer_function, const ValueRange& range,
                           double rounding, double length) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    std::vector<Jump> jumps;
    const auto add = [&](double lo, double hi, const OpticalProperties& a,
                         const OpticalProperties& b) {
        const double share = hi - lo > rounding ? rounding / (hi - lo) : 1;
        const double change = OpticsChange::between(a, b, length, share).of_ray(length);
        if (change > least_change) jumps.push_back({lo, hi, change});
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

using Scalars = std::array<double, 4>;  // at a tet's corners

Scalars scalars_of(const SceneMesh& mesh, std::int32_t tet) {
    Scalars found{};
    const Tet& corners = mesh.mesh.tets()[static_cast<std::size_t>(tet)];
    for (std::size_t i = 0; i < 4; ++i)
        found[i] = mesh.scalar.values[static_cast<std::size_t>(corners[i])];
    return found;
}

bool are_finite(const Scalars& scalars) {
    const auto [least, most] = std::ranges::minmax(scalars);
    return std::isfinite(least + most);
}

// The surfaces in tets at which what a ray shows jumps, apart from the boundary of the mesh.
class InnerSurfaces {
  public:
    InnerSurfaces(const Scene& scene, const SceneMesh& mesh, const MeshFacts& facts)
        : mesh_(mesh),
          some_without_value_(facts.non_finite > 0),
          rounding_(scalar_rounding * (facts.window.hi - facts.window.lo)),
          jumps_(jumps_of(*scene.transfer_function, facts.range, rounding_, facts.diagonal)) {}

    double rounding() const { return rounding_; }  // of a scalar
    bool none() const { return jumps_.empty() && !some_without_value_; }

    // Returns the jumps that the surface of a tet with these finite scalars may be at.
    std::span<const Jump> jumps_in(const Scalars& scalars) const {
        const auto [least, most] = std::ranges::minmax(scalars);
        if (least == most) return {};  // a scalar and a jump beside it round alike
        const auto first = std::ranges::lower_bound(jumps_, least - rounding_, {}, &Jump::hi);
        auto end = first;
        while (end != jumps_.end() && end->lo <= most + rounding_) ++end;
        return {first, end};
    }
    // Tells whether a tet's neighbour shows nothing for lack of a value.
    bool ends_at(std::int32_t tet, std::size_t face) const {
        if (!some_without_value_) return false;
        const std::int32_t behind = mesh_.mesh.neighbors()[static_cast<std::size_t>(tet)][face];
        return behind != TetMesh::no_neighbor && !are_finite(scalars_of(mesh_, behind));
    }
    bool any_in(std::int32_t tet) const {
        const Scalars scalars = scalars_of(mesh_, tet);
        if (!are_finite(scalars)) return false;
        if (!jumps_in(scalars).empty()) return true;
        for (std::size_t face = 0; face < 4; ++face)
            if (ends_at(tet, face)) return true;
        return false;
    }

  private:
    const SceneMesh& mesh_;
    bool some_without_value_;
    double rounding_;
    std::vector<Jump> jumps_;
};

template <typename Point>
using Corners = FewPoints<Point, 6>;

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

    // Returns the polygon as a line, without what lies behind the eye, unless it is wider than
    // this.
    std::optional<EdgeOn> edge_on(const Corners<glm::dvec3>& corners, double widest) const {
        if (corners.count < 3) return {};
        const Corners<glm::dvec2> seen = project(corners);
        EdgeOn line;
        double longest = 0;
        for (const glm::dvec2& a : seen.points()) {
            for (const glm::dvec2& b : seen.points()) {
                const double length = glm::length(b - a);
                if (length > longest) line = {a, b};
                longest = std::max(longest, length);
            }
        }
        if (!(longest > 0) || !std::isfinite(longest)) return {};
        for (const glm::dvec2& point : seen.points()) {
            line.width = std::max(line.width, line.distance(point));
            if (!(line.width <= widest)) return {};
        }
        return line;
    }

    // Returns the pixels that roundings of places may move a ray or the polygon.
    double tie(const Corners<glm::dvec3>& corners) const {
        double pixel = window_.view().pixel;
        if (window_.perspective()) {
            double depth = std::numeric_limits<double>::infinity();
            for (const glm::dvec3& corner : corners.points()) depth = std::min(depth, corner.z);
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
        for (const glm::dvec3& a : corners.points()) {
            if (a.z < near_) continue;
            seen.add(window_.to_window(a));
            for (const glm::dvec3& b : corners.points()) {
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
          scene_mesh_(mesh),
          mesh_(mesh.mesh),
          diagonal_(facts.diagonal),
          surfaces_(scene, mesh, facts),
          rounding_(surfaces_.rounding()),
          picture_(scene, facts.diagonal) {}

    // `tets`: tets_with_surfaces().
    double largest(std::span<const std::int32_t> tets) {
        const auto faces = mesh_.open_faces();
        parallel_for(std::ssize(faces), 1 << 10,
                     [&](std::int64_t index) { look_at(faces[static_cast<std::size_t>(index)]); });
        parallel_for(std::ssize(tets), 1 << 10, [&](std::int64_t index) {
            look_at_tet(tets[static_cast<std::size_t>(index)]);
        });
        return largest_;
    }

  private:
    void look_at(const TetFace& face) {
        const Scalars scalars = scalars_of(scene_mesh_, face.tet);
        if (!are_finite(scalars)) return;
        const auto [least, most] = std::ranges::minmax(scalars);
        const double shown = transfer_function_.max_extinction(least, most);
        const double change = -std::expm1(-shown * diagonal_);
        if (!(change > least_change) || change <= largest_) return;
        Corners<glm::dvec3> corners;
        for (const glm::dvec3& corner : mesh_.corners(face))
            corners.add(picture_.window().see(corner));
        const double tie = picture_.tie(corners);
        const auto line = picture_.edge_on(corners, tie);
        if (line && picture_.meets_pixel(*line, tie)) add(change);
    }

    // Looks at the jumps in a tet, and at its faces to tets that show nothing for lack of a value.
    void look_at_tet(std::int32_t tet) {
        const Scalars scalars = scalars_of(scene_mesh_, tet);
        for (std::int32_t face = 0; face < 4; ++face)
            if (surfaces_.ends_at(tet, static_cast<std::size_t>(face))) look_at({tet, face});
        const auto [least, most] = std::ranges::minmax(scalars);
        for (const Jump& jump : surfaces_.jumps_in(scalars))
            look_at(tet, scalars, std::clamp(0.5 * jump.lo + 0.5 * jump.hi, least, most), jump);
    }

    void look_at(std::int32_t tet, const Scalars& scalars, double level, const Jump& jump) {
        if (jump.change <= largest_) return;
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
        const auto line = picture_.edge_on(corners, std::numeric_limits<double>::infinity());
        if (!line) return;
        // Pixels for a unit of the scalar. It does not change along the line if this is edge-on.
        double pixels = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            const bool in_front = !picture_.window().perspective() || seen[i].z > 0;
            if (in_front && !on_level(i))
                pixels = std::max(pixels, line->distance(picture_.window().to_window(seen[i])) /
                                              std::abs(scalars[i] - level));
        }
        // Roundings of the scalar move the surface, and a steep ramp reaches to both sides of it.
        const double tie = picture_.tie(corners) + pixels * rounding_;
        const double ramp = pixels * 0.5 * (jump.hi - jump.lo);
        if (line->width <= tie && picture_.meets_pixel(*line, tie + ramp)) add(jump.change);
    }

    void add(double change) {
        double before = largest_;
        while (before < change && !largest_.compare_exchange_weak(before, change)) {
        }
    }

    const TransferFunction& transfer_function_;
    const SceneMesh& scene_mesh_;
    const TetMesh& mesh_;
    double diagonal_;
    InnerSurfaces surfaces_;
    double rounding_;  // of a scalar
    Picture picture_;
    std::atomic<double> largest_ = 0;
};

}  // namespace

std::vector<std::int32_t> tets_with_surfaces(const Scene& scene, const SceneMesh& mesh,
                                             const MeshFacts& facts) {
    const InnerSurfaces surfaces(scene, mesh, facts);
    if (surfaces.none()) return {};
    constexpr std::int64_t tets_per_task = 8192;
    const auto count = std::ssize(mesh.mesh.tets());
    std::vector<std::vector<std::int32_t>> found(
        static_cast<std::size_t>((count + tets_per_task - 1) / tets_per_task));
    parallel_for(std::ssize(found), 1, [&](std::int64_t task) {
        const std::int64_t end = std::min(count, (task + 1) * tets_per_task);
        for (std::int64_t tet = task * tets_per_task; tet < end; ++tet) {
            const auto number = static_cast<std::int32_t>(tet);
            if (surfaces.any_in(number)) found[static_cast<std::size_t>(task)].push_back(number);
        }
    });
    std::vector<std::int32_t> tets;
    for (const auto& mine : found) tets.insert(tets.end(), mine.begin(), mine.end());
    return tets;
}

double surface_ray_error(const Scene& scene, const SceneMesh& mesh, const MeshFacts& facts) {
    std::span<const std::int32_t> tets;
    if (facts.surface_tets) tets = *facts.surface_tets;
    return SurfaceSearch(scene, mesh, facts).largest(tets);
}

}  // namespace lamina
