// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "scene/camera.h"

namespace lamina {

// The view with axes of length `unit`. It takes points of the world and gives eye-space coordinates
// in the renderer's units (facts/world_unit.h).
inline View seeing_in_units(View view, double unit) {
    for (glm::dvec3* const axis : {&view.right, &view.up, &view.forward}) *axis *= unit;
    if (view.projection == Projection::orthographic) view.pixel *= unit;
    return view;
}

// Converts points to eye space and to window coordinates: pixels to the right and upwards from the
// picture's lower left corner.
class WindowView {
  public:
    explicit WindowView(const View& view)
        : view_(view),
          middle_(0.5 * view.width, 0.5 * view.height),
          perspective_(view.projection == Projection::perspective) {}

    const View& view() const { return view_; }
    const glm::dvec2& middle() const { return middle_; }
    bool perspective() const { return perspective_; }

    // Eye-space coordinates: along right, up and forward from the eye.
    glm::dvec3 see(const glm::dvec3& point) const {
        const glm::dvec3 p = point - view_.eye;
        return {glm::dot(p, view_.right), glm::dot(p, view_.up), glm::dot(p, view_.forward)};
    }
    glm::dvec2 to_window(const glm::dvec3& seen) const {
        const double scale = perspective_ ? view_.pixel * seen.z : view_.pixel;
        return middle_ + glm::dvec2(seen.x / scale, seen.y / scale);
    }

  private:
    View view_;
    glm::dvec2 middle_;
    bool perspective_;
};

inline double cross(const glm::dvec2& a, const glm::dvec2& b) {
    return a.x * b.y - a.y * b.x;
}

}  // namespace lamina
