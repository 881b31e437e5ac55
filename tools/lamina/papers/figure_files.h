// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "render/pipeline.h"
#include "study/study_frames.h"

// Pictures, tables and plots of a paper's items.
namespace lamina::papers {

// Draws one picture of a scene of method slice or project, without warnings. `capabilities` and
// `tables`: as in PipelineOptions.
Image plain_picture(const Scene& scene, SceneData data, const Capabilities& capabilities,
                    std::shared_ptr<TableCache> tables);

// Returns a CSV table of objects with the same keys and plain values, one row each; null is an
// empty cell.
std::string csv_of_rows(const nlohmann::ordered_json& rows);

// Returns rows of names, times and ratios to the first frame: [{technique, ms, ratio, cpu_ms,
// ...}].
nlohmann::ordered_json time_rows(const std::vector<study::TimedFrame>& frames,
                                 const std::vector<study::FrameTimes>& times);

struct PlotAxis {
    std::string label;
    double low = 0;
    double high = 1;             // > low
    bool powers_of_two = false;  // logarithmic with ticks at powers of two; needs low > 0
};

// A plot of lines as SVG, for print. It has seven colours that colour-blind people can tell apart
// (Okabe and Ito 2008, without yellow). Each has its own dash pattern, so that it also works in
// grey. The legend is at the right. The first line is black and solid; it is for exact values.
struct LinePlot {
    struct Line {
        std::string name;
        std::vector<double> x, y;
    };

    std::string title;
    PlotAxis x, y;
    std::vector<Line> lines = {};

    // Adds a line through the points (x[i], y[i]); both vectors have the same length. Points are
    // clamped to the axes.
    void add(std::string name, std::vector<double> x_of, std::vector<double> y_of);
    std::string svg() const;
};

}  // namespace lamina::papers
