// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstddef>

#include "lamina/tet.h"
#include "scene/camera.h"

namespace lamina {

// A tet in one view, cut into convex polygons of the picture. On each polygon the rays enter the
// tet by one face or at the near plane, and leave it by one other face. Unlike the fans of Kraus
// 2004, these polygons are right if a corner lies behind the eye. None of them reaches far beyond
// the picture, where float32 resolves window coordinates only to whole pixels.
class FacePairs {
  public:
    using Fronts = std::array<bool, 4>;  // for each corner: the face opposite is a front face

    // `seen`: the corners relative to the eye, along right, up and forward.
    FacePairs(const WindowView& window, double near_depth, const Tet& tet,
              const std::array<glm::dvec3, 4>& seen, const Fronts& fronts);

    // A polygon is the picture's rectangle, cut by at most three edges of either face and by the
    // near plane.
    static constexpr std::size_t most_corners = 12;
    struct Polygon {
        std::size_t count = 0;
        std::array<glm::dvec2, most_corners> corners;  // window coordinates
    };

    // Shares are the barycentric coordinates, with respect to the tet's corners, of the point where
    // a ray meets a face or the near plane. In perspective views they are divided by z, so that
    // they are linear in the picture.
    using Shares = std::array<double, 4>;
    struct Hit {
        double inverse_z;  // 1 in orthographic views
        double z;
        Shares shares;
    };
    static constexpr std::size_t near_plane = 4;  // stands for the near plane instead of a face
    Hit hit(std::size_t face, const glm::dvec2& place) const;

    // Calls visit(polygon, front face or near_plane, back face).
    template <typename Visit>
    void for_each(const Visit& visit) const {
        for (std::size_t back = 0; back < 4; ++back) {
            if (fronts_[back]) continue;
            const Polygon behind = limited(part_of(back, picture_), back, true);
            if (behind.count == 0) continue;
            for (std::size_t front = 0; front < 4; ++front) {
                if (!fronts_[front]) continue;
                const Polygon both = part_of(front, behind);
                if (const Polygon part = limited(both, front, true); part.count > 0)
                    visit(part, front, back);
                if (!cut_) continue;
                if (const Polygon part = limited(both, front, false); part.count > 0)
                    visit(part, near_plane, back);
            }
            if (cut_ && !any_front_) visit(behind, near_plane, back);
        }
    }

    // Largest number of triangles of the polygons of one tet. The polygons do not overlap, and
    // their union is convex. Triangulated, they have at most two triangles for each corner inside
    // the union, and one for each corner on its border except two. At most 4 corners lie inside: a
    // corner of the tet or the crossing of two edges, and points where edges meet the near plane.
    // On the border lie at most 4 corners of the picture, 6 of the section with the near plane, and
    // 12 ends of at most 6 lines that cross the union. There are at most 6 polygons.
    static constexpr std::size_t most_triangles = 28;

  private:
    // A linear function a.x + b.y + c of a ray's position at depth 1, or of its position if rays
    // are parallel.
    using Linear = glm::dvec3;

    glm::dvec3 ray_at(const glm::dvec2& place) const;
    Polygon cut(const Polygon& polygon, const Linear& function) const;
    Polygon part_of(std::size_t face, const Polygon& polygon) const;
    Polygon limited(const Polygon& polygon, std::size_t face, bool behind_near) const;
    Linear depth_of(std::size_t face) const;

    const WindowView& window_;
    double near_depth_;
    bool cut_ = false, any_front_ = false;
    std::array<glm::dvec3, 4> seen_;
    Fronts fronts_;
    std::array<std::array<Linear, 3>, 4> shares_;  // of the corners of each face
    // The shares in space: their change per x, y, z, and their values at the eye.
    std::array<glm::dvec3, 4> inside_;
    std::array<double, 4> inside_at_eye_;
    Polygon picture_;
};

}  // namespace lamina
