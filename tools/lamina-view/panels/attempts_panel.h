// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "model/attempts.h"
#include "panels/panel.h"

namespace lamina::view {

// Cells of a table's row, from the next column on: expected error, Linf, L2, the share of the
// pixels that these are measured on, and ms of a frame. Empty if nothing is known.
void error_and_time_cells(const Attempt& attempt);
// Their columns.
void error_and_time_columns();

// Shows the settings that have been tried. A click on a row goes back to it.
class AttemptsPanel : public Panel {
  public:
    const char* title() const override { return "Tried"; }
    PanelPlace place() const override { return PanelPlace::bottom; }
    void draw(PanelContext& context) override;

  private:
    void draw_table(PanelContext& context);
    void draw_saving(const PanelContext& context);

    std::string file_;     // empty: beside the scene
    std::string message_;  // of saving
    bool failed_ = false;
};

}  // namespace lamina::view
