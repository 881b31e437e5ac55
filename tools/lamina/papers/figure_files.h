// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "render/pipeline.h"
#include "study/study_frames.h"

// Functions for the pictures, tables and plots of the papers' items.
namespace lamina::papers {

// Draws one picture of a scene of method slice or project, without warnings. `capabilities` and
// `tables`: as in PipelineOptions.
Image plain_picture(const Scene& scene, SceneData data, const Capabilities& capabilities,
                    std::shared_ptr<TableCache> tables);

// Returns a CSV table of objects that have the same keys and plain values: one row each; null
// becomes an empty cell.
std::string csv_of_rows(const nlohmann::ordered_json& rows);

// Returns one row for each frame: [{technique, ms, ratio, cpu_ms, ...}]; `ratio` is relative to the
// first frame.
nlohmann::ordered_json time_rows(const std::vector<study::TimedFrame>& frames,
                                 const std::vector<study::FrameTimes>& times);

struct PlotAxis {
    std::string label;
    double low = 0;
    double high = 1;             // > low
    bool powers_of_two = false;  // logarithmic with ticks at powers of two; needs low > 0
};

// A plot of lines as SVG, for print. It has seven colours that colour-blind people can tell apart
// (Okabe and Ito 2008, without yellow), each with its own dash pattern, so that it works in grey,
// too. The legend is at the right. The first line, black and solid, is for exact values.
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
