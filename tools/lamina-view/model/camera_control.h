// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "lamina/grid.h"
#include "lamina/point_probe.h"
#include "model/document.h"
#include "model/input_event.h"
#include "model/picture_area.h"

namespace lamina::view {

// Moves the camera by pointer and keys.
class CameraControl {
  public:
    // Surroundings of the camera in the window. `probe`: null while there is no picture.
    struct Around {
        PictureArea area;
        Grid::Bounds bounds;  // of the data
        const PointProbe* probe = nullptr;
    };

    // Returns true if the event was for the camera. Does nothing while the camera is still to be
    // chosen from the data.
    bool handle(const InputEvent& event, const Around& around, Document& document);
    // Returns true while the camera is dragged, and for a moment after steps.
    bool moving(double seconds) const { return dragging_ || seconds < steps_until_; }
    std::optional<double> rest_at() const;  // when steps are over

    void set_projection(Document& document, Projection projection) const;
    void fit(const Around& around, Document& document) const;
    // Looks from the positive (`sign` 1) or negative end of an axis.
    void see_axis(int axis, double sign, const Around& around, Document& document) const;

  private:
    enum class Way { orbit, pan, zoom };
    bool press(const InputEvent& event, const Around& around, Document& document);
    bool drag(const InputEvent& event, const Around& around, Document& document);
    bool key(const InputEvent& event, const Around& around, Document& document);
    bool fly(const InputEvent& event, const Around& around, Document& document);
    void step_until(double seconds);

    bool dragging_ = false;
    Way way_ = Way::orbit;
    PointerButton button_ = PointerButton::left;
    glm::dvec2 last_{0}, pressed_{0};
    double pressed_at_ = -1, steps_until_ = 0;
};

}  // namespace lamina::view
