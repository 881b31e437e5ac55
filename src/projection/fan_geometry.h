// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include <array>
#include <cstdint>
#include <span>

#include "visibility/face_signs.h"
#include "projection/face_pairs.h"
#include "projection/tet_geometry.h"
#include "projection/window_view.h"
#include "plan/project_plan.h"
#include "scene/scene_mesh.h"

namespace lamina {

// A vertex of the paper's triangles (shaders/projection/fan.vert): the points at the front and at
// the back of the tet that are seen at one place.
struct FanVertex {
    glm::vec2 position;  // window coordinates
    // Perspective interpolation: 1/z at the front and at the back, and the difference, of which
    // theirs in float32 would say little (all linear in window coordinates). Linear: 0, 0, and the
    // thickness.
    glm::vec3 inverse;
    // The scalar (normalised) in x, or colour and extinction; over z for perspective interpolation.
    // Coloring `vertex`: in `front` the vertex's colour and opacity.
    glm::vec4 front, back;
    // The tet's least and largest scalar (normalised): what is interpolated is rounded, and a tet
    // of one scalar may lie just at a step.
    glm::vec2 scalars;
    std::uint32_t tet;
};

// Three or four triangles around a thick vertex for each tet: the projections of the smaller tets
// of Kraus 2004, Figure 3. Of tets that cross the near plane or, where pictures are exact, reach
// far beyond the picture, the polygons of FacePairs.
class FanGeometry : public TetGeometry {
  public:
    // A polygon has two vertices more than triangles; of six polygons.
    static constexpr std::size_t most_vertices = FacePairs::most_triangles + 12,
                                 most_indices = 3 * FacePairs::most_triangles;

    // All must outlive it.
    FanGeometry(const SceneMesh& mesh, const TransferFunction& transfer_function,
                const ProjectPlan& plan, const View& view);
    static Size largest_size();
    // Whole tets, whatever the part.
    Written write(const TetPart& part, const Place& place) const override;

    // A corner of a tet, or of a part of one.
    struct Corner {
        glm::dvec3 seen;    // from the eye: along right, up and forward
        glm::dvec2 window;  // window coordinates
        glm::dvec4 values;  // as in FanVertex, not divided
    };
    using Corners = std::array<Corner, 4>;
    // All vertices of a tet have these alike.
    struct Owner {
        std::int32_t tet;
        glm::vec2 scalars;
    };
    using Fronts = FacePairs::Fronts;

  private:
    struct Fan {
        int rim = 0;  // 3 or 4 vertices around the first one
        std::array<FanVertex, 5> vertices;
    };
    // What is seen at one place, front or back.
    struct Point {
        double inverse_z;  // 1 in orthographic views
        double z;
        glm::dvec4 values;  // divided by z
    };

    Corner corner_of(std::int32_t point) const;
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
    bool divided_;  // values are interpolated over z
};

}  // namespace lamina
