// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "panels/panel.h"
#include "panels/transfer_plot.h"

namespace lamina::view {

struct ValueSpan {
    double lo = 0, hi = 1;
};

// The editor of the transfer function: the plot and, on its right, the numbers of the selected
// points, colour maps, and controls of the whole function.
class TransferPanel : public Panel {
  public:
    const char* title() const override { return "Transfer function"; }
    PanelPlace place() const override { return PanelPlace::bottom; }
    void draw(PanelContext& context) override;

  private:
    void draw_controls(PanelContext& context);
    void draw_presets(PanelContext& context);
    void draw_selected(Document& document);
    void draw_density_point(Document& document, std::size_t index);
    void draw_color(Document& document, double value, const glm::dvec3& color);
    void draw_whole(Document& document);
    void draw_density_slider(Document& document);
    void draw_between(Document& document);
    void draw_maps(PanelContext& context);
    ValueSpan span_of(const PanelContext& context) const;
    void apply_map(PanelContext& context, const std::string& name_or_path);

    TransferPlot plot_;
    std::uint64_t fitted_to_ = 0;  // Revisions::data when plot_ was fitted
    bool counted_ = false;         // there was a histogram when plot_ was fitted
    double density_ = 1;           // factor on the density slider while it is dragged
    bool over_points_ = false;     // true: maps are stretched over the points; false: over the data
    std::string map_file_, map_message_;
};

}  // namespace lamina::view
