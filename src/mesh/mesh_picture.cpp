// SPDX-License-Identifier: Apache-2.0
#include "mesh/mesh_picture.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

namespace lamina {
namespace {

constexpr int room = 8;  // pixels around and between the panels
// No edges are drawn in panels whose faces or tets cover fewer pixels than this on average.
constexpr double pixels_for_edges = 40;
constexpr std::array<std::uint16_t, 3> paper{255, 255, 255};
constexpr glm::dvec3 no_value(200, 30, 30);

// Maps values to purple over green to yellow, by five colours of matplotlib's viridis.
glm::dvec3 color_of(double value, const ValueRange& range) {
    static const std::array<glm::dvec3, 5> colors{glm::dvec3(68, 1, 84), glm::dvec3(59, 82, 139),
                                                  glm::dvec3(33, 145, 140), glm::dvec3(94, 201, 98),
                                                  glm::dvec3(253, 231, 37)};
    if (!std::isfinite(value)) return no_value;
    const double share = range.lo < range.hi ? (value - range.lo) / (range.hi - range.lo) : 0.5;
    const double place = 4 * std::clamp(share, 0.0, 1.0);
    const auto below = static_cast<std::size_t>(std::min(3.0, std::floor(place)));
    return glm::mix(colors[below], colors[below + 1], place - static_cast<double>(below));
}

// One of the four panels: for each pixel, the face or tet (piece) that it shows, and its colour.
class Panel {
  public:
    // The vector right x up points towards the eye. The mesh's box fits into the panel.
    Panel(const TetMesh& mesh, const glm::dvec3& right, const glm::dvec3& up, int side)
        : right_(right),
          up_(up),
          side_(side),
          center_(0.5 * mesh.bounds().min + 0.5 * mesh.bounds().max),
          piece_(static_cast<std::size_t>(side) * side, -1),
          height_(piece_.size(), -INFINITY),
          color_(piece_.size()) {
        const glm::dvec3 half = 0.5 * mesh.bounds().max - 0.5 * mesh.bounds().min;
        const double reach =
            std::max(glm::dot(half, glm::abs(right)), glm::dot(half, glm::abs(up)));
        scale_ = reach > 0 ? 0.5 * side / reach : 1;
    }

    // Returns a point's place in pixels; rows go downwards.
    glm::dvec2 place(const glm::dvec3& point) const {
        const glm::dvec3 p = point - center_;
        return {0.5 * side_ + scale_ * glm::dot(p, right_),
                0.5 * side_ - scale_ * glm::dot(p, up_)};
    }
    glm::dvec3 world(int column, int row) const {
        return center_ + ((column + 0.5 - 0.5 * side_) / scale_) * right_ +
               ((0.5 * side_ - row - 0.5) / scale_) * up_;
    }

    // Calls visit(column, row) for the pixels with centres in the box around the places.
    template <std::size_t count, typename Visit>
    void for_pixels(const std::array<glm::dvec2, count>& places, const Visit& visit) const {
        glm::dvec2 lo = places[0], hi = places[0];
        for (const glm::dvec2& p : places) {
            lo = glm::min(lo, p);
            hi = glm::max(hi, p);
        }
        const auto first = [](double at) {
            return static_cast<int>(std::ceil(std::max(0.0, at - 0.5)));
        };
        const auto end = [&](double at) {
            return static_cast<int>(std::floor(std::clamp(at - 0.5, -1.0, side_ - 1.0))) + 1;
        };
        for (int row = first(lo.y); row < end(hi.y); ++row)
            for (int column = first(lo.x); column < end(hi.x); ++column) visit(column, row);
    }

    void set(int column, int row, std::int32_t piece, double height, const glm::dvec3& color) {
        const std::size_t pixel = index(column, row);
        if (height < height_[pixel]) return;
        height_[pixel] = height;
        piece_[pixel] = piece;
        color_[pixel] = color;
    }

    void copy_to(CodedImage& image, int left, int top) const {
        const bool edges = pixels_a_piece() >= pixels_for_edges;
        for (int row = 0; row < side_; ++row)
            for (int column = 0; column < side_; ++column) {
                const std::size_t pixel = index(column, row);
                if (piece_[pixel] < 0) continue;
                glm::dvec3 color = color_[pixel];
                if (edges && at_edge(column, row)) color = 0.35 * color;
                const auto first = static_cast<std::size_t>(
                    3 * (static_cast<std::int64_t>(top + row) * image.width + left + column));
                for (int c = 0; c < 3; ++c)
                    image.codes[first + static_cast<std::size_t>(c)] =
                        static_cast<std::uint16_t>(std::floor(color[c] + 0.5));
            }
    }

  private:
    std::size_t index(int column, int row) const {
        return static_cast<std::size_t>(row) * side_ + column;
    }
    bool at_edge(int column, int row) const {
        const std::int32_t piece = piece_[index(column, row)];
        return (column + 1 < side_ && piece_[index(column + 1, row)] != piece) ||
               (row + 1 < side_ && piece_[index(column, row + 1)] != piece);
    }
    double pixels_a_piece() const {
        std::vector<std::int32_t> seen;
        for (const std::int32_t piece : piece_) {
            if (piece >= 0) seen.push_back(piece);
        }
        const auto pixels = static_cast<double>(seen.size());
        std::sort(seen.begin(), seen.end());
        const auto end = std::unique(seen.begin(), seen.end());
        return pixels / std::max(1.0, static_cast<double>(end - seen.begin()));
    }

    glm::dvec3 right_, up_;
    int side_;
    glm::dvec3 center_;
    double scale_;
    std::vector<std::int32_t> piece_;
    std::vector<double> height_;  // coordinate towards the eye
    std::vector<glm::dvec3> color_;
};

class MeshPainter {
  public:
    MeshPainter(const TetMesh& mesh, std::span<const double> scalar, const ValueRange& range)
        : mesh_(mesh), scalar_(scalar), range_(range) {}

    void draw_boundary(const glm::dvec3& towards_eye, Panel& panel) const {
        std::int32_t piece = 0;
        for (const TetFace& face : mesh_.open_faces()) draw_face(face, piece++, towards_eye, panel);
    }

    void draw_cut(int axis, Panel& panel) const {
        const double plane = 0.5 * mesh_.bounds().min[axis] + 0.5 * mesh_.bounds().max[axis];
        for (std::size_t tet = 0; tet < mesh_.tets().size(); ++tet) {
            double lo = INFINITY, hi = -INFINITY;
            for (const std::int32_t corner : mesh_.tets()[tet]) {
                lo = std::min(lo, point(corner)[axis]);
                hi = std::max(hi, point(corner)[axis]);
            }
            if (lo <= plane && plane <= hi) cut_tet(tet, axis, plane, panel);
        }
    }

  private:
    const glm::dvec3& point(std::int32_t corner) const { return mesh_.points()[corner]; }
    double value(std::int32_t corner) const { return scalar_.empty() ? 0 : scalar_[corner]; }

    void draw_face(const TetFace& face, std::int32_t piece, const glm::dvec3& towards_eye,
                   Panel& panel) const {
        const auto corners = corners_of_face(mesh_.tets()[face.tet], face.face);
        const glm::dvec3 &a = point(corners[0]), &b = point(corners[1]), &c = point(corners[2]);
        const glm::dvec3 normal = glm::cross(b - a, c - a);
        const double facing = glm::dot(normal, towards_eye);
        if (!(facing > 0)) return;
        const double light = 0.55 + 0.45 * facing / glm::length(normal);
        const std::array<glm::dvec2, 3> p{panel.place(a), panel.place(b), panel.place(c)};
        const auto area = [](const glm::dvec2& u, const glm::dvec2& v, const glm::dvec2& w) {
            return (v.x - u.x) * (w.y - u.y) - (v.y - u.y) * (w.x - u.x);
        };
        const double whole = area(p[0], p[1], p[2]);
        panel.for_pixels(p, [&](int column, int row) {
            const glm::dvec2 at(column + 0.5, row + 0.5);
            const double u = area(p[1], p[2], at) / whole, v = area(p[2], p[0], at) / whole;
            const double w = 1 - u - v;
            if (!(u >= 0 && v >= 0 && w >= 0)) return;
            const double s = u * value(corners[0]) + v * value(corners[1]) + w * value(corners[2]);
            panel.set(column, row, piece, glm::dot(u * a + v * b + w * c, towards_eye),
                      light * color_of(s, range_));
        });
    }

    void cut_tet(std::size_t index, int axis, double plane, Panel& panel) const {
        const Tet& tet = mesh_.tets()[index];
        const glm::dvec3& a = point(tet[0]);
        const glm::dvec3 b = point(tet[1]) - a, c = point(tet[2]) - a, d = point(tet[3]) - a;
        const double volume = glm::dot(b, glm::cross(c, d));
        if (!(volume > 0)) return;
        const glm::dvec3 to_b = glm::cross(c, d) / volume, to_c = glm::cross(d, b) / volume,
                         to_d = glm::cross(b, c) / volume;
        const std::array<glm::dvec2, 4> places{panel.place(a), panel.place(a + b),
                                               panel.place(a + c), panel.place(a + d)};
        panel.for_pixels(places, [&](int column, int row) {
            glm::dvec3 at = panel.world(column, row);
            at[axis] = plane;
            const double u = glm::dot(at - a, to_b), v = glm::dot(at - a, to_c),
                         w = glm::dot(at - a, to_d), rest = 1 - u - v - w;
            if (!(u >= 0 && v >= 0 && w >= 0 && rest >= 0)) return;
            const double s =
                rest * value(tet[0]) + u * value(tet[1]) + v * value(tet[2]) + w * value(tet[3]);
            panel.set(column, row, static_cast<std::int32_t>(index), 0, color_of(s, range_));
        });
    }

    const TetMesh& mesh_;
    std::span<const double> scalar_;
    const ValueRange& range_;
};

}  // namespace

CodedImage mesh_picture(const TetMesh& mesh, std::span<const double> scalar,
                        const ValueRange& range, int side) {
    CodedImage image(2 * side + 3 * room, 2 * side + 3 * room, 3, 8);
    for (std::size_t i = 0; i < image.codes.size(); ++i) image.codes[i] = paper[i % 3];
    const MeshPainter painter(mesh, scalar, range);
    const int second = side + 2 * room;
    const glm::dvec3 towards_eye = glm::normalize(glm::dvec3(1, -1, 1));
    const glm::dvec3 right = glm::normalize(glm::dvec3(1, 1, 0));
    Panel boundary(mesh, right, glm::cross(towards_eye, right), side);
    painter.draw_boundary(towards_eye, boundary);
    boundary.copy_to(image, room, room);
    const glm::dvec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    for (int axis = 0; axis < 3; ++axis) {
        Panel panel(mesh, axis == 0 ? y : x, axis == 2 ? y : z, side);
        painter.draw_cut(axis, panel);
        panel.copy_to(image, axis == 1 ? room : second, axis == 0 ? room : second);
    }
    return image;
}

}  // namespace lamina
