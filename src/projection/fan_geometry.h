// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include <array>
#include <cstdint>
#include <span>

#include "plan/project_plan.h"
#include "projection/face_pairs.h"
#include "projection/tet_geometry.h"
#include "scene/camera.h"
#include "scene/scene_mesh.h"
#include "visibility/order_graph.h"

namespace lamina {

// A vertex of the triangles of Kraus 2004 (shaders/projection/fan.vert). It holds two points of the
// tet that are seen at one position of the window: one on its front and one on its back.
struct FanVertex {
    glm::vec2 position;  // window coordinates
    // Perspective interpolation: 1/z at the front, 1/z at the back, and their difference. The
    // difference of the two float32 numbers would have few digits. All three are linear in window
    // coordinates. Linear interpolation: 0, 0, and the thickness.
    glm::vec3 inverse;
    // The normalised scalar in x, or colour and extinction; for perspective interpolation divided
    // by z. With Coloring::vertex `front` holds the vertex's colour and opacity.
    glm::vec4 front, back;
    // The tet's least and largest normalised scalar. Interpolated scalars are clamped to these,
    // because they are rounded, and the scalar of a constant tet may lie exactly at a step.
    glm::vec2 scalars;
    std::uint32_t tet;
};

// Projects each tet as three or four triangles around a thick vertex, the projections of the
// smaller tets of Kraus 2004, Figure 3. Tets that cross the near plane are projected as the
// polygons of FacePairs; so are, if pictures are exact, tets that reach far beyond the picture.
class FanGeometry : public TetGeometry {
  public:
    // A polygon has two more vertices than triangles, and there are at most six polygons.
    static constexpr std::size_t most_vertices = FacePairs::most_triangles + 12,
                                 most_indices = 3 * FacePairs::most_triangles;

    // All arguments must outlive it.
    FanGeometry(const SceneMesh& mesh, const TransferFunction& transfer_function,
                const ProjectPlan& plan, const View& view);
    static Size largest_size();
    // Always projects the whole tet.
    Written write(const TetPart& part, const Place& place) const override;

    // A corner of a tet.
    struct Corner {
        glm::dvec3 seen;    // relative to the eye: along right, up and forward
        glm::dvec2 window;  // window coordinates
        glm::dvec4 values;  // as in FanVertex, not divided
    };
    using Corners = std::array<Corner, 4>;
    // Values that all vertices of a tet share.
    struct Owner {
        std::int32_t tet;
        glm::vec2 scalars;
    };
    using Fronts = FacePairs::Fronts;

  private:
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

}  // namespace lamina
