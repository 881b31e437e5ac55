// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "model/document.h"
#include "work/shown.h"

namespace lamina::view {

class PrecisionInSight;

// Places of panels: the column on the right, or the strip below the picture.
enum class PanelPlace { side, bottom };

// Objects that panels read and change.
struct PanelContext {
    Document& document;
    const Shown& shown;
    std::optional<double> value_under_pointer;  // of the data, at the visible point
    PrecisionInSight* precision = nullptr;      // null: no errors and times are known
};

// A part of the window beside the picture.
class Panel {
  public:
    virtual ~Panel() = default;
    virtual const char* title() const = 0;
    virtual PanelPlace place() const { return PanelPlace::side; }
    virtual void draw(PanelContext& context) = 0;  // ImGui calls, inside a begun window
};

// Returns all panels, from top to bottom.
std::vector<std::unique_ptr<Panel>> make_panels();

}  // namespace lamina::view
