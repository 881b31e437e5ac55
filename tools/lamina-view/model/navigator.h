// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "lamina/camera.h"
#include "lamina/sampling.h"
#include "lamina/volume.h"
#include "model/document.h"

namespace lamina::view {

enum class PointerButton { left, right, middle };

// Keys have GLFW's numbers; those of letters and digits are the ASCII codes of capital letters and
// digits.
namespace key {
constexpr int escape = 256, enter = 257, tab = 258, right = 262, left = 263, down = 264, up = 265,
              home = 268;
}

// An input of the user.
struct InputEvent {
    enum class Kind { pointer, press, release, wheel, key, character, drop };
    Kind kind = Kind::pointer;
    double seconds = 0;   // time of the input
    glm::dvec2 place{0};  // pointer in the window (PictureArea); wheel: steps to the right and up
    PointerButton button = PointerButton::left;
    int key = 0;             // pressed or repeated
    unsigned character = 0;  // Unicode
    bool shift = false, control = false;
    std::vector<std::filesystem::path> files = {};  // dropped
};

// Rectangle of the picture in the window, in units of the pointer, from the window's upper left
// corner.
struct PictureArea {
    glm::dvec2 corner{0};
    glm::dvec2 size{1};
    int columns = 1;  // width of the picture in pixels

    bool contains(const glm::dvec2& place) const {
        const glm::dvec2 inside = place - corner;
        return inside.x >= 0 && inside.y >= 0 && inside.x < size.x && inside.y < size.y;
    }
    // Returns the pixel at a place; pixel centres have whole numbers.
    glm::dvec2 pixel(const glm::dvec2& place) const {
        return (place - corner) * (columns / size.x) - glm::dvec2(.5);
    }
    // Returns the place from the picture's middle, right and up, in heights of the picture.
    glm::dvec2 share(const glm::dvec2& place) const {
        const glm::dvec2 from_middle = place - corner - .5 * size;
        return {from_middle.x / size.y, -from_middle.y / size.y};
    }
    double aspect() const { return size.x / size.y; }
};

// Moves the camera by pointer and keys.
class CameraControl {
  public:
    struct Around {
        PictureArea area;
        Grid::Bounds bounds;                // of the data, in world units
        const PointProbe* probe = nullptr;  // of the picture; null without one
    };

    // Returns true if the event moved the camera or began or ended a drag. Does nothing while the
    // camera is automatic.
    bool handle(const InputEvent& event, const Around& around, Document& document);
    // Returns true while the camera is dragged, and for a moment after each step.
    bool moving(double seconds) const { return dragging_ || seconds < steps_until_; }
    std::optional<double> rest_at() const;  // time (s) at which the last step is over

    void set_projection(Document& document, Projection projection) const;
    void fit(const Around& around, Document& document) const;
    // Looks from the positive (`sign` 1) or negative (-1) end of an axis.
    void see_axis(int axis, double sign, const Around& around, Document& document) const;

  private:
    enum class Motion { orbit, pan, zoom };
    bool press(const InputEvent& event, const Around& around, Document& document);
    bool drag(const InputEvent& event, const Around& around, Document& document);
    bool key(const InputEvent& event, const Around& around, Document& document);
    bool fly(const InputEvent& event, const Around& around, Document& document);
    void step_until(double seconds);

    bool dragging_ = false;
    Motion motion_ = Motion::orbit;
    PointerButton button_ = PointerButton::left;
    glm::dvec2 last_{0}, pressed_{0};
    double pressed_at_ = -1, steps_until_ = 0;
};

// Motions of the camera. Each function takes a camera and returns the next one. Drags and places
// are in units of PictureArea::share(), so that they do not depend on the picture's pixels.

// Axes of the picture in the world: right, up, and away from the eye. They are orthonormal.
struct ViewAxes {
    glm::dvec3 right, up, forward;
};
ViewAxes axes_of(const Camera& camera);

// Returns the world length of the picture's height at the distance of the camera's centre.
double height_at_center(const Camera& camera);

// Turns the camera around its centre, at the same distance. A drag over the picture's height turns
// by 180 degrees; the scene follows the drag. The view direction stays a degree away from `up`.
Camera orbited(const Camera& camera, const glm::dvec2& drag);
// Moves eye and centre so that objects at the centre's distance follow the drag.
Camera panned(const Camera& camera, const glm::dvec2& drag);
// Zooms: objects at the centre's distance get 1 / `factor` times as large. The point at `place`
// keeps its place.
Camera zoomed(const Camera& camera, double factor, const glm::dvec2& place = glm::dvec2(0));
// Moves eye and centre by `step` world units to the right, up and forward. Orthographic views are
// enlarged instead of moved forward, which would change nothing.
Camera flown(const Camera& camera, const glm::dvec3& step);
// Makes the point the camera's centre, in the middle of the picture. A perspective view turns, an
// orthographic view is shifted.
Camera looking_at(const Camera& camera, const glm::dvec3& point);
// Shows the whole box from the same direction, as large as possible. `aspect`: width of the picture
// over its height.
Camera fitted(const Camera& camera, const Grid::Bounds& box, double aspect);
// Looks at the middle of the box from the direction `from`, fitted to the box. Up is z, or y if the
// view is along z.
Camera seen_from(const Camera& camera, const glm::dvec3& from, const Grid::Bounds& box,
                 double aspect);
// Returns the camera with another projection; objects at the centre's distance keep their size.
Camera with_projection(const Camera& camera, Projection projection);

}  // namespace lamina::view
