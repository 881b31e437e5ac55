// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace lamina::study {

struct PlotAxis {
    std::string label;
    double low = 0;
    double high = 1;             // > low
    bool powers_of_two = false;  // logarithmic, ticks at powers of two; then low > 0
};

// A plot of lines as SVG, for print: seven colours that stay apart for the colour-blind (Okabe and
// Ito 2008, without yellow), with a dash pattern of their own each so that grey paper will do, and
// a legend to the right. The first line is black and whole, for what is right.
class LinePlot {
  public:
    LinePlot(std::string title, PlotAxis x, PlotAxis y);

    // Points (x[i], y[i]), as many of each; clamped to the axes.
    void add(std::string name, std::vector<double> x, std::vector<double> y);

    std::string svg() const;

  private:
    struct Line {
        std::string name;
        std::vector<double> x, y;
    };

    double across(double x) const;
    double down(double y) const;
    std::string frame() const;
    std::string grid() const;
    std::string points_of(const Line& line) const;
    std::string legend_entry(std::size_t index) const;

    std::string title_;
    PlotAxis x_, y_;
    std::vector<Line> lines_;
};

}  // namespace lamina::study
