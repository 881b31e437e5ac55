// SPDX-License-Identifier: Apache-2.0
#include "slicing/slab_geometry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <numeric>

#include "mesh/predicates.h"

namespace lamina {
namespace {

// Margin of pixels_of() in pixels, far more than the rounding of boxes and rays to float.
constexpr double box_margin_pixels = 1;

// Share of the farthest corner's depth. A nearer corner counts as behind the eye in pixels_of().
constexpr double nearest_share = 1e-6;

int clamped(double place, int size) {
    return static_cast<int>(std::clamp(place, 0.0, static_cast<double>(size)));
}

// Rasterisers (llvmpipe, most GPUs) snap vertices to a grid of 1/256 pixel, which can make the
// triangles of a convex polygon overlap, so that a pixel gets its slab twice. So SlabCutter puts
// corners on the grid itself, and draws the convex hull of the result. The polygon is larger than
// needed by a margin, of which snapping takes up to 1/512 pixel.
constexpr double grid_per_pixel = 256;
constexpr double margin_pixels = 1.0 / 16;
// Share of a slab's far depth: a slab that begins nearer to the eye's plane is drawn over the whole
// image, because points in the eye's plane project to infinity.
constexpr double near_share = 1e-6;

using Polygon = std::vector<glm::dvec2>;

double cross(const glm::dvec2& a, const glm::dvec2& b) {
    return a.x * b.y - a.y * b.x;
}

// Sets `hull` to the convex hull of points, by Andrew's monotone chain. Sorts `points`.
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

// Clips to sign * coordinate >= sign * limit (Sutherland and Hodgman). `kept`: memory to work in.
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

// Finds the convex polygon that a slab of a box covers in the picture: the hull of the projected
// corners of the box's part in the slab, widened by a margin, clipped to the image, and snapped.
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
    // Collects the corners of the convex body between two depths: the box's corners there, and the
    // points where its edges cross the two planes; in view coordinates.
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

    // Rounds the polygon to the grid and takes its convex hull. Cross products of grid numbers are
    // exact in double, so the hull is strictly convex.
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

IndexBox box_of(const TextureBrick& brick, const Grid& grid) {
    IndexBox box{grid.index_min(), grid.index_max()};
    for (int axis = 0; axis < 3; ++axis) {
        const std::int64_t first = brick.first[axis], last = first + brick.size[axis] - 1;
        if (brick.bordered) {
            box.min[axis] = std::max(box.min[axis], static_cast<double>(first));
            box.max[axis] = std::min(box.max[axis], static_cast<double>(last));
            continue;
        }
        if (first > 0) box.min[axis] = static_cast<double>(first);
        if (last < grid.size[axis] - 1) box.max[axis] = static_cast<double>(last);
    }
    return box;
}

glm::dvec3 last_face_of(const glm::dvec3& end, const glm::dvec3& first, const Grid& grid) {
    const glm::dvec3 border(
        glm::vec3(grid.index_max() - first));  // in float, because boxes are rounded to float, too
    glm::dvec3 face = no_last_face;
    for (int axis = 0; axis < 3; ++axis) {
        if (end[axis] >= border[axis]) face[axis] = border[axis];
    }
    return face;
}

BrickRow row_of(const TextureBrick& brick, const Grid& grid, std::int64_t y, std::int64_t z) {
    const auto own = [&](std::size_t axis, std::int64_t place) {
        return std::clamp<std::int64_t>(brick.first[axis] + place, 0, grid.size[axis] - 1);
    };
    const std::int64_t begin = std::max<std::int64_t>(-brick.first[0], 0);
    const std::int64_t end = std::min(brick.size[0], grid.size[0] - brick.first[0]);
    const std::int64_t first = (own(2, z) * grid.size[1] + own(1, y)) * grid.size[0] + own(0, 0);
    return {static_cast<std::size_t>(first), begin, end};
}

void set_visibility_order(const std::vector<TextureBrick>& bricks, const Grid& grid,
                          const View& view, Order order, std::vector<std::size_t>& numbers) {
    const auto& first = bricks.front().first;  // of all bricks
    const glm::dvec3 eye = grid.to_index(view.eye) - glm::dvec3(first[0], first[1], first[2]);
    const glm::dvec3 forward = grid.direction_to_index(view.forward);
    // A ray that enters another brick moves away from the eye's by one brick on one axis, and never
    // towards it. So bricks along a ray are ordered by the sum over the axes of the distance in
    // bricks from the eye's; for parallel rays it counts in the direction of view.
    const auto distance_of = [&](std::size_t i) {
        double distance = 0;
        for (int axis = 0; axis < 3; ++axis) {
            // The first brick is of full size, and all begin at multiples of its cells.
            const double cells =
                std::max<double>(1, static_cast<double>(bricks.front().size[axis] - 1));
            const double number = static_cast<double>(bricks[i].first[axis] - first[axis]) / cells;
            if (view.projection == Projection::perspective) {
                distance += std::abs(number - std::floor(eye[axis] / cells));
            } else {
                distance += forward[axis] >= 0 ? number : -number;
            }
        }
        return order == Order::front_to_back ? distance : -distance;
    };
    numbers.resize(bricks.size());
    std::iota(numbers.begin(), numbers.end(), std::size_t{0});
    // std::stable_sort would allocate memory, so ties are broken by number.
    std::sort(numbers.begin(), numbers.end(), [&](std::size_t a, std::size_t b) {
        const double one = distance_of(a), other = distance_of(b);
        return one < other || (one == other && a < b);
    });
}

PixelBox PixelBox::joined(const PixelBox& other) const {
    return {std::min(first_column, other.first_column), std::max(end_column, other.end_column),
            std::min(first_row, other.first_row), std::max(end_row, other.end_row)};
}

PixelBox PixelBox::common(const PixelBox& other) const {
    return {std::max(first_column, other.first_column), std::min(end_column, other.end_column),
            std::max(first_row, other.first_row), std::min(end_row, other.end_row)};
}

// The picture of a box in front of the eye lies inside the rectangle around its corners' pixels.
PixelBox pixels_of(const IndexBox& box, const Grid& grid, const View& view) {
    constexpr double far = std::numeric_limits<double>::infinity();
    glm::dvec3 from_eye[8];
    double nearest = far, farthest = -far;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 index{(corner & 1) != 0 ? box.max.x : box.min.x,
                               (corner & 2) != 0 ? box.max.y : box.min.y,
                               (corner & 4) != 0 ? box.max.z : box.min.z};
        from_eye[corner] = grid.to_world(index) - view.eye;
        const double depth = glm::dot(from_eye[corner], view.forward);
        nearest = std::min(nearest, depth);
        farthest = std::max(farthest, depth);
    }
    const bool perspective = view.projection == Projection::perspective;
    if (perspective && !(nearest > nearest_share * farthest))
        return {0, view.width, 0, view.height};
    double left = far, right = -far, top = far, bottom = -far;
    for (const glm::dvec3& corner_from_eye : from_eye) {
        const double pixel =
            view.pixel * (perspective ? glm::dot(corner_from_eye, view.forward) : 1);
        const double column = 0.5 * view.width + glm::dot(corner_from_eye, view.right) / pixel;
        const double row = 0.5 * view.height - glm::dot(corner_from_eye, view.up) / pixel;
        left = std::min(left, column);
        right = std::max(right, column);
        top = std::min(top, row);
        bottom = std::max(bottom, row);
    }
    return {clamped(std::floor(left - box_margin_pixels), view.width),
            clamped(std::ceil(right + box_margin_pixels), view.width),
            clamped(std::floor(top - box_margin_pixels), view.height),
            clamped(std::ceil(bottom + box_margin_pixels), view.height)};
}

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

}  // namespace lamina
