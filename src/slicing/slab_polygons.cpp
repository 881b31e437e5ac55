// SPDX-License-Identifier: Apache-2.0
#include "slicing/slab_polygons.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "mesh/predicates.h"

namespace lamina {
namespace {

// Grid to which vertices are rounded. Rasterisers snap vertices to a grid (llvmpipe and most GPUs:
// 1/256 pixel), which can turn a convex polygon into one whose triangles overlap, so that a pixel
// gets its slab twice. So the corners are put on that grid here, and the convex hull of the result
// is drawn. The polygon is a margin larger than needed; snapping takes 1/512 of a pixel of it.
constexpr double grid_per_pixel = 256;
constexpr double margin_pixels = 1.0 / 16;
// Share of a slab's far depth: a slab that begins nearer to the eye's plane is drawn over the whole
// image, because points in the eye's plane project to infinity.
constexpr double near_share = 1e-6;

using Polygon = std::vector<glm::dvec2>;

double cross(const glm::dvec2& a, const glm::dvec2& b) {
    return a.x * b.y - a.y * b.x;
}

// Andrew's monotone chain; `points` are sorted in place.
void convex_hull(Polygon& points, Polygon& hull) {
    std::sort(points.begin(), points.end(), [](const glm::dvec2& a, const glm::dvec2& b) {
        return a.x < b.x || (a.x == b.x && a.y < b.y);
    });
    hull.clear();
    const auto add_chain = [&](auto begin, auto end) {
        const std::size_t start = hull.size();
        for (auto point = begin; point != end; ++point) {
            while (hull.size() >= start + 2 &&
                   cross(hull.back() - hull[hull.size() - 2], *point - hull.back()) <= 0) {
                hull.pop_back();
            }
            hull.push_back(*point);
        }
        hull.pop_back();
    };
    add_chain(points.begin(), points.end());
    add_chain(points.rbegin(), points.rend());
}

// Sutherland-Hodgman against one side: keeps the part with sign * coordinate >= sign * limit.
void clip_side(Polygon& polygon, Polygon& kept, int axis, double sign, double limit) {
    kept.clear();
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const glm::dvec2 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
        const double at_a = sign * (a[axis] - limit), at_b = sign * (b[axis] - limit);
        if (at_a >= 0) kept.push_back(a);
        if ((at_a > 0 && at_b < 0) || (at_a < 0 && at_b > 0)) {
            kept.push_back(a + (b - a) * (at_a / (at_a - at_b)));
        }
    }
    std::swap(polygon, kept);
}

class SlabCutter {
  public:
    SlabCutter(const View& view, const Grid& grid, const IndexBox& box) : view_(view) {
        const std::array<glm::dvec3, 8> indices = box_corners(box.min, box.max);
        for (std::size_t corner = 0; corner < indices.size(); ++corner) {
            const glm::dvec3 offset = grid.to_world(indices[corner]) - view.eye;
            corners_[corner] = {glm::dot(offset, view.right), glm::dot(offset, view.up),
                                glm::dot(offset, view.forward)};
        }
    }

    // Returns the convex polygon, in pixels and inside the image, that covers the box between two
    // depths; empty if there is none.
    const Polygon& cut(double front, double back) {
        polygon_.clear();
        collect_points(front, back);
        if (points_.empty()) return polygon_;
        const double width = view_.width, height = view_.height;
        if (view_.projection == Projection::perspective && front <= near_share * back) {
            polygon_ = {{0, 0}, {width, 0}, {width, height}, {0, height}};
            return polygon_;
        }
        project_points();
        convex_hull(points_, polygon_);
        points_.clear();
        for (const glm::dvec2& point : polygon_) {
            for (const double x : {-margin_pixels, margin_pixels}) {
                for (const double y : {-margin_pixels, margin_pixels})
                    points_.push_back(point + glm::dvec2(x, y));
            }
        }
        convex_hull(points_, polygon_);
        clip_side(polygon_, points_, 0, 1, 0);
        clip_side(polygon_, points_, 0, -1, width);
        clip_side(polygon_, points_, 1, 1, 0);
        clip_side(polygon_, points_, 1, -1, height);
        snap_to_grid();
        return polygon_;
    }

  private:
    // Collects corners between the depths and crossings of the edges with both planes, in view
    // coordinates.
    void collect_points(double front, double back) {
        space_.clear();
        for (const glm::dvec3& corner : corners_) {
            if (corner.z >= front && corner.z <= back) space_.push_back(corner);
        }
        for (std::size_t corner = 0; corner < 8; ++corner) {
            for (const std::size_t bit : {std::size_t{1}, std::size_t{2}, std::size_t{4}}) {
                if ((corner & bit) != 0) continue;
                const glm::dvec3 &a = corners_[corner], &b = corners_[corner | bit];
                for (const double depth : {front, back}) {
                    if ((a.z < depth) == (b.z < depth)) continue;
                    glm::dvec3 point = a + (b - a) * ((depth - a.z) / (b.z - a.z));
                    point.z = depth;
                    space_.push_back(point);
                }
            }
        }
        points_.resize(space_.size());
    }

    // Cross products of grid numbers are exact in double: the hull is strictly convex.
    void snap_to_grid() {
        points_.clear();
        for (const glm::dvec2& point : polygon_)
            points_.push_back(glm::round(point * grid_per_pixel));
        polygon_.clear();
        if (points_.size() >= 3) convex_hull(points_, polygon_);
        if (polygon_.size() < 3) polygon_.clear();
        for (glm::dvec2& point : polygon_) point /= grid_per_pixel;
    }

    void project_points() {
        for (std::size_t i = 0; i < space_.size(); ++i) {
            const double scale =
                1 /
                (view_.pixel * (view_.projection == Projection::perspective ? space_[i].z : 1.0));
            points_[i] = {0.5 * view_.width + scale * space_[i].x,
                          0.5 * view_.height - scale * space_[i].y};
        }
    }

    const View& view_;
    std::array<glm::dvec3, 8> corners_;  // right, up, forward from the eye
    std::vector<glm::dvec3> space_;
    Polygon points_, polygon_;
};

void append_fan(const Polygon& polygon, int slab, std::vector<SlabVertex>& triangles) {
    const auto vertex = [&](std::size_t corner) {
        return SlabVertex{static_cast<float>(polygon[corner].x),
                          static_cast<float>(polygon[corner].y), static_cast<float>(slab)};
    };
    for (std::size_t corner = 2; corner < polygon.size(); ++corner) {
        triangles.insert(triangles.end(), {vertex(0), vertex(corner - 1), vertex(corner)});
    }
}

}  // namespace

void append_slab_polygons(const View& view, const Grid& grid, const IndexBox& box,
                          const Slabs& slabs, Order order, std::vector<SlabVertex>& triangles,
                          std::vector<std::size_t>* starts) {
    SlabCutter cutter(view, grid, box);
    for (int i = 0; i < slabs.count; ++i) {
        const int slab = order == Order::front_to_back ? i : slabs.count - 1 - i;
        if (starts != nullptr) starts->push_back(triangles.size());
        append_fan(cutter.cut(slabs.depth(slab), slabs.depth(slab + 1)), slab, triangles);
    }
    if (starts != nullptr) starts->push_back(triangles.size());
}

void append_span_polygon(const View& view, const Grid& grid, const IndexBox& box,
                         const Slabs& slabs, const SampleSpan& span,
                         std::vector<SlabVertex>& triangles) {
    SlabCutter cutter(view, grid, box);
    append_fan(cutter.cut(slabs.depth(span.first), slabs.depth(span.end())), span.first, triangles);
}

}  // namespace lamina
