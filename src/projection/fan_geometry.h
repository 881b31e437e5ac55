// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec4.hpp>

#include "lamina/mesh.h"
#include "plan/plan.h"
#include "projection/tet_projector.h"
#include "scene/scene.h"

namespace lamina {

// A tet in one view, cut into convex polygons of the picture. On each polygon the rays enter the
// tet by one face or at the near plane, and leave it by one other face. Unlike the fans of Kraus
// 2004, these polygons are right if a corner lies behind the eye. None of them reaches far beyond
// the picture, because there float32 resolves window coordinates only to whole pixels.
class FacePairs {
  public:
    using Fronts = std::array<bool, 4>;  // for each corner: is the opposite face a front face?

    // `tet`: the corners' places. `seen`: the corners relative to the eye, along right, up and
    // forward.
    FacePairs(const WindowView& window, double near_depth, const Tet& tet,
              const std::array<glm::dvec3, 4>& seen, const Fronts& fronts);

    // A part of the picture's rectangle, cut by the edges of two faces and by the near plane.
    using Polygon = FewPoints<glm::dvec2, 12>;  // window coordinates

    // Barycentric coordinates in the tet of the point where a ray meets a face or the near plane.
    // In perspective views they are divided by z, which makes them linear in the picture.
    using Shares = std::array<double, 4>;
    struct Hit {
        double inverse_z;  // 1 in orthographic views
        double z;
        Shares shares;
    };
    static constexpr std::size_t near_plane = 4;  // stands for the near plane instead of a face
    // Returns the hit of the ray at a place of the window with a face's plane or the near plane.
    Hit hit(std::size_t face, const glm::dvec2& place) const;

    // Calls visit(polygon, front face or near_plane, back face).
    template <typename Visit>
    void for_each(const Visit& visit) const {
        for (std::size_t back = 0; back < 4; ++back) {
            if (fronts_[back]) continue;
            const Polygon behind = limited(seen_region(back, picture_), back, true);
            if (behind.count == 0) continue;
            for (std::size_t front = 0; front < 4; ++front) {
                if (!fronts_[front]) continue;
                const Polygon both = seen_region(front, behind);
                if (const Polygon clipped = limited(both, front, true); clipped.count > 0)
                    visit(clipped, front, back);
                if (!cut_) continue;
                if (const Polygon clipped = limited(both, front, false); clipped.count > 0)
                    visit(clipped, near_plane, back);
            }
            if (cut_ && !any_front_) visit(behind, near_plane, back);
        }
    }

    // Largest number of triangles of one tet. Its polygons, at most 6, do not overlap, and their
    // union is convex: at most two triangles for each corner inside it, and one for each corner on
    // its border except two. Inside lie at most 4: a corner of the tet or the crossing of two
    // edges, and points where edges meet the near plane. On the border lie at most 4 corners of the
    // picture, 6 of the section with the near plane, and 12 ends of 6 lines that cross the union.
    static constexpr std::size_t most_triangles = 28;

  private:
    // A linear function a.x + b.y + c of a ray's position (at depth 1 unless rays are parallel).
    using Linear = glm::dvec3;

    glm::dvec3 ray_at(const glm::dvec2& place) const;
    Polygon cut(const Polygon& polygon, const Linear& function) const;
    Polygon seen_region(std::size_t face, const Polygon& polygon) const;
    Polygon limited(const Polygon& polygon, std::size_t face, bool behind_near) const;
    Linear depth_of(std::size_t face) const;

    const WindowView& window_;
    double near_depth_;
    bool cut_ = false, any_front_ = false;
    std::array<glm::dvec3, 4> seen_;
    Fronts fronts_;
    std::array<std::array<Linear, 3>, 4> shares_;  // shares of each face's corners
    // The shares in space: their change per x, y, z, and their values at the eye.
    std::array<glm::dvec3, 4> inside_;
    std::array<double, 4> inside_at_eye_;
    Polygon picture_;
};

// A vertex of the triangles of Kraus 2004 (shaders/projection/fan.vert): two points of the tet, one
// on its front and one on its back, that are seen at one position of the window.
struct FanVertex {
    glm::vec2 position;  // window coordinates
    // For perspective interpolation: 1/z at the front, 1/z at the back, and their difference, which
    // would have few digits if it were computed from the two float32 numbers. All three are linear
    // in window coordinates. For linear interpolation: 0, 0, and the thickness.
    glm::vec3 inverse;
    // The normalised scalar in x, or colour and extinction; divided by z for perspective
    // interpolation. With Coloring::vertex `front` holds the vertex's colour and opacity.
    glm::vec4 front, back;
    // The tet's least and largest normalised scalar. Interpolated scalars are clamped to these,
    // because they are rounded, and the scalar of a constant tet may lie exactly at a step.
    glm::vec2 scalars;
    std::uint32_t tet;
};

// Projects each tet as three or four triangles around a thick vertex, at which the ray is longest
// in the tet: the projections of the smaller tets of Kraus 2004, Figure 3. Tets that cross the near
// plane are projected as the polygons of FacePairs. So are tets that reach far beyond the picture,
// unless perspective views are interpolated linearly.
class FanGeometry : public TetGeometry {
  public:
    // A polygon has two more vertices than triangles, and there are at most six polygons.
    static constexpr std::size_t most_vertices = FacePairs::most_triangles + 12,
                                 most_indices = 3 * FacePairs::most_triangles;

    // All arguments must outlive it.
    FanGeometry(const SceneMesh& mesh, const TransferFunction& transfer_function,
                const ProjectPlan& plan, const View& view);
    static Size largest_size();
    // Projects the whole tet, whatever `cell_fragment.piece` is.
    Written write(const CellFragment& cell_fragment, const Place& place) const override;

    // A corner of a tet.
    struct Corner {
        glm::dvec3 seen;    // relative to the eye: along right, up and forward
        glm::dvec2 window;  // window coordinates
        glm::dvec4 values;  // as FanVertex::front, but not divided by z
    };
    using Corners = std::array<Corner, 4>;
    // Values that all vertices of a tet share.
    struct Owner {
        std::int32_t tet;
        glm::vec2 scalars;
    };
    using Fronts = FacePairs::Fronts;

  private:
    // Triangles around the thick vertex, which is the first.
    struct Fan {
        int rim = 0;  // number of vertices around the first one: 3 or 4
        std::array<FanVertex, 5> vertices;
    };
    // A point on the front or the back of the tet.
    struct Point {
        double inverse_z;  // 1 in orthographic views
        double z;
        glm::dvec4 values;  // divided by z
    };

    Corner corner_of(std::int32_t point) const;
    static void bring_near(Corners& corners);
    Fronts fronts_of(std::int32_t tet) const;
    Point point_of(const Corner& corner) const;
    Point mix(std::span<const Point> points, std::span<const double> weights) const;
    bool make_fan(const Corners& corners, const Fronts& fronts, Fan& fan) const;
    bool make_around_corner(const Corners& corners, std::size_t lone_face, bool front,
                            Fan& fan) const;
    bool make_around_crossing(const Corners& corners, const std::array<std::size_t, 2>& front_faces,
                              const std::array<std::size_t, 2>& back_faces, Fan& fan) const;
    FanVertex thick_vertex(const glm::dvec2& window, const Point& front, const Point& back,
                           double inverse_difference) const;
    FanVertex thin_vertex(const Corner& corner) const;
    Written write_pairs(const Owner& owner, const Corners& corners, const Place& place) const;
    static void append(FanVertex vertex, const Owner& owner, const Place& place, Written& written);
    static void append(const Fan& fan, const Owner& owner, const Place& place, Written& written);

    const SceneMesh& mesh_;
    const TransferFunction& transfer_function_;
    const ProjectPlan& plan_;
    WindowView window_;
    FaceSigner signer_;
    bool divided_;  // values are divided by z for interpolation
};

// A triangle of Kraus 2004 (FanVertex) as a rasteriser treats it: its corners are rounded to a grid
// (rounded_to_grid()), and values are interpolated linearly between them.
struct TriangleRecord {
    // A function of the pixel: twice the area of the triangle of an edge and a pixel centre, >= 0
    // on the inner side. Two triangles that share an edge compute it with opposite signs.
    struct Edge {
        double column, row;          // a corner of the edge, window coordinates
        double per_column, per_row;  // change of the area from that corner
        bool has_zeros;              // pixel centres on the edge belong to this triangle
    };
    struct Corner {
        glm::vec3 inverse;  // as in FanVertex
        glm::vec4 front, back;
    };
    std::array<Edge, 3> edges;  // opposite the corners; these are rounded to the grid
    // The weight of a corner in the interpolation, a linear function of the pixel. As in
    // rasterisers, it refers to the corners before rounding.
    struct Share {
        double column, row;  // place at which it is 0
        double per_column, per_row;
    };
    std::array<Share, 3> shares;
    std::array<Corner, 3> corners;
    glm::vec2 scalars;     // as in FanVertex
    std::uint32_t number;  // number of the tet, for dithering
};

// Fills the record. Returns false if the triangle covers nothing.
bool make_triangle(const std::array<const FanVertex*, 3>& vertices, TriangleRecord& record);

// Returns the point of the rasteriser's grid to which a corner is rounded.
glm::dvec2 rounded_to_grid(const glm::vec2& window);

}  // namespace lamina
