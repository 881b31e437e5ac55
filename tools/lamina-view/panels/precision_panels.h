// SPDX-License-Identifier: Apache-2.0
// Panels for errors and times of the settings that were tried.
#pragma once

#include <string>

#include "model/attempts.h"
#include "panels/panel.h"

namespace lamina::view {

// Writes cells of a table's row: expected error, Linf, L2, share of the pixels that these are
// measured on, and ms of a frame. Unknown numbers are empty cells.
void error_and_time_cells(const Attempt& attempt);
// Declares the columns of these cells.
void error_and_time_columns();

// Shows the settings that were tried. A click on a row goes back to them.
class AttemptsPanel : public Panel {
  public:
    const char* title() const override { return "Tried"; }
    PanelPlace place() const override { return PanelPlace::bottom; }
    void draw(PanelContext& context) override;

  private:
    void draw_table(PanelContext& context);
    void draw_saving(const PanelContext& context);

    std::string file_;     // name for saving; empty: beside the scene
    std::string message_;  // result of saving
    bool failed_ = false;
};

// Edits the bifurcation factors of the compositing tree as text. Lists the errors and times of
// factors that were tried with the other settings and the view as they are now.
class FactorsPanel : public Panel {
  public:
    const char* title() const override { return "Bifurcation factors"; }
    void draw(PanelContext& context) override;

  private:
    void take(Document& document);
    void draw_tried(PanelContext& context);

    std::string text_, shown_;  // as edited, and as in the scene
    std::string message_;       // why the last factors were refused
};

// Chooses the picture to compare with, and how both pictures are shown.
class ComparisonPanel : public Panel {
  public:
    const char* title() const override { return "Compare"; }
    void draw(PanelContext& context) override;
};

}  // namespace lamina::view
