// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "lamina/image.h"
#include "lamina/report.h"
#include "model/transfer_editor.h"
#include "panels/transfer_drawing.h"

namespace lamina::view {

// Data that the plot shows beside the curves.
struct TransferSurroundings {
    const ValueHistogram* histogram = nullptr;
    std::optional<double> value_under_pointer;
    ImageColorSpace space = ImageColorSpace::linear;
};

// The curves over the histogram, with points that can be dragged, and the strip of colours below.
class TransferPlot {
  public:
    // Shows the whole range of histogram and points, and all extinctions.
    void fit(const TransferEditor& editor, const ValueHistogram* histogram);
    // Draws into a rectangle of ImGui's current window. Returns the name of the edit, or an empty
    // text.
    std::string draw(TransferEditor& editor, const TransferSurroundings& surroundings,
                     const ImVec2& size);
    const TransferFrame& frame() const { return frame_; }

  private:
    enum class Drag { none, points, rectangle, window, pan };

    void place(const ImVec2& corner, const ImVec2& size);
    void fit_extinction(const TransferEditor& editor);
    std::optional<TransferHandle> handle_at(const TransferEditor& editor, const ImVec2& at) const;
    std::string take_pointer(TransferEditor& editor);
    std::string press_left(TransferEditor& editor, const ImVec2& at);
    std::string drag(TransferEditor& editor);
    void end_drag(TransferEditor& editor);
    std::string take_keys(TransferEditor& editor);
    std::string menu(TransferEditor& editor);
    void zoom(float steps, float at_x);
    void draw_stops(const TransferEditor& editor, ImageColorSpace space) const;
    void draw_all(const TransferEditor& editor, const TransferSurroundings& surroundings) const;

    TransferFrame frame_;
    ImVec2 strip_min_, strip_max_;  // corners of the strip of colours
    Drag drag_ = Drag::none;
    ImVec2 pressed_at_;
    // Range of values when the drag began: of the plot or, for Drag::window, of the points.
    double value_lo_at_press_ = 0, value_hi_at_press_ = 1;
    bool fitted_ = false;
};

}  // namespace lamina::view
