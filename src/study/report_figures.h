// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "image/coded_image.h"
#include "image/difference.h"
#include "lamina/image.h"
#include "lamina/image_color_space.h"

namespace lamina::study {

// Pictures for a page.

// Returns the picture as write_png shows it on black: 8-bit sRGB codes, three channels.
CodedImage shown(const Image& image, ImageColorSpace space = ImageColorSpace::linear);

// Returns the divisor of the sides after which neither has more than `largest` pixels.
int reduction(int width, int height, int largest = 256);

// Returns the means of squares of `step` x `step` pixels.
Image reduced(const Image& image, int step);
// Returns the pixel with the largest |e| of each square, so that no error is averaged away.
Difference reduced(const Difference& difference, int step);

// Returns an RGB picture of 8 bits as "data:image/png;base64,...".
std::string data_uri(const CodedImage& image);
// Returns bytes of a media type as "data:...;base64,...".
std::string data_uri(const std::string& type, const std::string& bytes);

struct PlotAxis {
    std::string label;
    double low = 0;
    double high = 1;             // > low
    bool powers_of_two = false;  // logarithmic with ticks at powers of two; needs low > 0
};

// A plot of lines as SVG, for print. It has seven colours that colour-blind people can tell apart
// (Okabe and Ito 2008, without yellow). Each has its own dash pattern, so that it also works in
// grey. The legend is at the right. The first line is black and solid; it is for exact values.
class LinePlot {
  public:
    LinePlot(std::string title, PlotAxis x, PlotAxis y);

    // Adds a line through the points (x[i], y[i]); both vectors have the same length. Points are
    // clamped to the axes.
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

// Escapes the characters <, > and & of a text that stands between tags of HTML or SVG.
std::string escaped_markup(const std::string& text);

}  // namespace lamina::study
