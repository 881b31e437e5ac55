// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <random>
#include <unordered_map>
#include <vector>

#include "lamina/mesh.h"

namespace lamina::test {

// Makes the Delaunay mesh of random points in a tetrahedron and of its four corners, by insertion
// of points (Bowyer 1981, Watson 1981). The points lie on a grid of integers below 2^20, so that
// all determinants are exact in 128 bits. The mesh is convex: it fills the tetrahedron.
class DelaunayMesh {
  public:
    static MeshData make(int points, std::uint32_t seed, double scale = 1.0 / (1 << 20)) {
        DelaunayMesh mesh;
        mesh.start();
        for (const Point& point : mesh.random_points(points, seed)) mesh.insert(point);
        return mesh.data(scale);
    }

  private:
    __extension__ typedef __int128 Integer;
    using Point = std::array<std::int64_t, 3>;
    struct Cell {
        Tet corners;
        std::array<std::int32_t, 4> across;  // cell behind each face; -1: none
        bool alive = true;
    };
    static constexpr std::int64_t size = 1 << 20;

    static Integer determinant(const Point& u, const Point& v, const Point& w) {
        return Integer(u[0]) * (v[1] * w[2] - v[2] * w[1]) +
               Integer(u[1]) * (v[2] * w[0] - v[0] * w[2]) +
               Integer(u[2]) * (v[0] * w[1] - v[1] * w[0]);
    }
    Point difference(std::int32_t a, const Point& b) const {
        const Point& p = points_[static_cast<std::size_t>(a)];
        return {p[0] - b[0], p[1] - b[1], p[2] - b[2]};
    }
    // Returns six times the signed volume of the tet of a face and a point. It is negative if the
    // point lies on the face's outer side.
    Integer inside(const Cell& cell, std::size_t face, const Point& point) const {
        const auto [a, b, c] = corners_of_face(cell.corners, face);
        return determinant(difference(a, point), difference(b, point), difference(c, point));
    }
    bool in_sphere(const Cell& cell, const Point& point) const {
        std::array<Point, 4> d;
        std::array<Integer, 4> square;
        for (std::size_t i = 0; i < 4; ++i) {
            d[i] = difference(cell.corners[i], point);
            square[i] = Integer(d[i][0]) * d[i][0] + Integer(d[i][1]) * d[i][1] +
                        Integer(d[i][2]) * d[i][2];
        }
        return square[0] * determinant(d[1], d[2], d[3]) -
                   square[1] * determinant(d[0], d[2], d[3]) +
                   square[2] * determinant(d[0], d[1], d[3]) -
                   square[3] * determinant(d[0], d[1], d[2]) >
               0;
    }

    void start() {
        points_ = {{0, 0, 0}, {size, 0, 0}, {0, size, 0}, {0, 0, size}};
        cells_ = {{{0, 1, 2, 3}, {-1, -1, -1, -1}, true}};
    }

    // Returns random points strictly inside the tetrahedron, ordered along a coarse serpentine, so
    // that the walk from one to the next is short.
    static std::vector<Point> random_points(int count, std::uint32_t seed) {
        std::mt19937 random(seed);
        std::vector<Point> points;
        while (points.size() < static_cast<std::size_t>(count)) {
            Point p;
            for (std::int64_t& x : p) x = 1 + random() % (size - 1);
            if (p[0] + p[1] + p[2] < size) points.push_back(p);
        }
        const auto key = [](const Point& p) {
            const std::int64_t cell = size / 32, x = p[0] / cell, y = p[1] / cell, z = p[2] / cell;
            const std::int64_t row = x % 2 == 0 ? y : 31 - y, column = row % 2 == 0 ? z : 31 - z;
            return (x * 32 + row) * 32 + column;
        };
        std::sort(points.begin(), points.end(), [&](const Point& a, const Point& b) {
            return key(a) != key(b) ? key(a) < key(b) : a < b;
        });
        points.erase(std::unique(points.begin(), points.end()), points.end());
        return points;
    }

    std::int32_t cell_at(const Point& point) const {
        std::int32_t at = last_;
        // Crosses any face that has the point on its outer side. In a Delaunay mesh this ends.
        for (std::size_t turn = 0;; ++turn) {
            const Cell& cell = cells_[static_cast<std::size_t>(at)];
            std::size_t tried = 0;
            while (tried < 4 && inside(cell, (turn + tried) % 4, point) >= 0) ++tried;
            if (tried == 4) return at;
            at = cell.across[(turn + tried) % 4];
        }
    }

    // Removes the cells whose circumspheres contain the point, and joins the point with each face
    // of the cavity that they leave.
    void insert(const Point& point) {
        const std::vector<std::int32_t> cavity = cells_around(point);
        const auto index = static_cast<std::int32_t>(points_.size());
        points_.push_back(point);
        std::unordered_map<std::uint64_t, std::pair<std::int32_t, std::size_t>> waiting;
        for (const std::int32_t old : cavity) {
            for (std::size_t face = 0; face < 4; ++face) {
                const Cell cell = cells_[static_cast<std::size_t>(old)];
                const std::int32_t outer = cell.across[face];
                if (outer >= 0 && !cells_[static_cast<std::size_t>(outer)].alive) continue;
                const auto [a, b, c] = corners_of_face(cell.corners, face);
                const std::int32_t made = new_cell({index, a, b, c});
                cells_[static_cast<std::size_t>(made)].across[0] = outer;
                if (outer >= 0) {
                    auto& across = cells_[static_cast<std::size_t>(outer)].across;
                    *std::find(across.begin(), across.end(), old) = made;
                }
                join_sides(made, waiting);
            }
        }
        for (const std::int32_t old : cavity) free_.push_back(old);
    }

    // Returns all cells whose circumspheres contain the point, and marks them as dead; their memory
    // is reused later.
    std::vector<std::int32_t> cells_around(const Point& point) {
        std::vector<std::int32_t> cavity{cell_at(point)};
        cells_[static_cast<std::size_t>(cavity[0])].alive = false;
        for (std::size_t i = 0; i < cavity.size(); ++i) {
            for (const std::int32_t next : cells_[static_cast<std::size_t>(cavity[i])].across) {
                if (next < 0) continue;
                Cell& cell = cells_[static_cast<std::size_t>(next)];
                if (!cell.alive || !in_sphere(cell, point)) continue;
                cell.alive = false;
                cavity.push_back(next);
            }
        }
        return cavity;
    }

    std::int32_t new_cell(const Tet& corners) {
        if (free_.empty()) {
            cells_.push_back({});
            free_.push_back(static_cast<std::int32_t>(cells_.size()) - 1);
        }
        last_ = free_.back();
        free_.pop_back();
        cells_[static_cast<std::size_t>(last_)] = {corners, {-1, -1, -1, -1}, true};
        return last_;
    }

    // Joins a new cell, whose corner 0 is the new point, with its neighbours among the new cells:
    // two share a face if they share its edge (a, b). `waiting`: sides not joined yet, by edge.
    template <typename Waiting>
    void join_sides(std::int32_t made, Waiting& waiting) {
        const Tet corners = cells_[static_cast<std::size_t>(made)].corners;
        for (std::size_t face = 1; face < 4; ++face) {
            const std::int32_t a = corners[face == 1 ? 2 : 1], b = corners[face == 3 ? 2 : 3];
            const std::uint64_t key = (static_cast<std::uint64_t>(std::min(a, b)) << 32) |
                                      static_cast<std::uint64_t>(std::max(a, b));
            const auto [other, first] = waiting.try_emplace(key, made, face);
            if (first) continue;
            const auto [cell, cell_face] = other->second;
            cells_[static_cast<std::size_t>(made)].across[face] = cell;
            cells_[static_cast<std::size_t>(cell)].across[cell_face] = made;
        }
    }

    MeshData data(double scale) const {
        MeshData mesh;
        for (const Point& p : points_) {
            mesh.points.push_back(scale * glm::dvec3(static_cast<double>(p[0]),
                                                     static_cast<double>(p[1]),
                                                     static_cast<double>(p[2])));
        }
        for (const Cell& cell : cells_) {
            if (cell.alive) mesh.tets.push_back(cell.corners);
        }
        return mesh;
    }

    std::vector<Point> points_;
    std::vector<Cell> cells_;
    std::vector<std::int32_t> free_;
    std::int32_t last_ = 0;
};

}  // namespace lamina::test
