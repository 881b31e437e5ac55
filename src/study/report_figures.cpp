// SPDX-License-Identifier: Apache-2.0
#include "study/report_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <utility>

#include "image/png.h"
#include "image/srgb.h"

namespace lamina::study {
namespace {

std::string base64(const std::string& bytes) {
    constexpr const char* digits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t group = 0;
        for (std::size_t j = 0; j < 3; ++j)
            group =
                group << 8 | (i + j < bytes.size() ? static_cast<std::uint8_t>(bytes[i + j]) : 0u);
        for (std::size_t j = 0; j < 4; ++j)
            text += i + j <= bytes.size() ? digits[group >> (18 - 6 * j) & 63] : '=';
    }
    return text;
}

// Calls visit(column, row) for the pixels of a square that are inside.
template <typename Visit>
void for_each_in_square(int column, int row, int step, int width, int height, const Visit& visit) {
    for (int y = row * step; y < std::min((row + 1) * step, height); ++y) {
        for (int x = column * step; x < std::min((column + 1) * step, width); ++x) visit(x, y);
    }
}

int squares(int pixels, int step) {
    return (pixels + step - 1) / step;
}

}  // namespace

CodedImage shown(const Image& image, ImageColorSpace space) {
    CodedImage coded(image.width, image.height, 3, 8);
    for (std::size_t i = 0; i < coded.codes.size(); ++i)
        coded.codes[i] = display_code(static_cast<double>(image.rgba[i / 3 * 4 + i % 3]), space);
    return coded;
}

int reduction(int width, int height, int largest) {
    return squares(std::max(width, height), largest);
}

Image reduced(const Image& image, int step) {
    Image small(squares(image.width, step), squares(image.height, step));
    for (int row = 0; row < small.height; ++row) {
        for (int column = 0; column < small.width; ++column) {
            double sum[4] = {}, count = 0;
            for_each_in_square(column, row, step, image.width, image.height, [&](int x, int y) {
                for (int i = 0; i < 4; ++i) sum[i] += static_cast<double>(image.pixel(x, y)[i]);
                ++count;
            });
            for (int i = 0; i < 4; ++i)
                small.pixel(column, row)[i] = static_cast<float>(sum[i] / count);
        }
    }
    return small;
}

Difference reduced(const Difference& difference, int step) {
    const std::size_t channels = difference.channels.size();
    Difference small{
        squares(difference.width, step), squares(difference.height, step), difference.channels, {}};
    for (int row = 0; row < small.height; ++row) {
        for (int column = 0; column < small.width; ++column) {
            const double* worst = nullptr;
            double largest = -1;
            for_each_in_square(
                column, row, step, difference.width, difference.height, [&](int x, int y) {
                    const auto pixel =
                        static_cast<std::size_t>(y) * static_cast<std::size_t>(difference.width) +
                        static_cast<std::size_t>(x);
                    const double* const e = &difference.e[channels * pixel];
                    for (std::size_t i = 0; i < channels; ++i) {
                        if (std::abs(e[i]) <= largest) continue;
                        largest = std::abs(e[i]);
                        worst = e;
                    }
                });
            small.e.insert(small.e.end(), worst, worst + channels);
        }
    }
    return small;
}

std::string data_uri(const CodedImage& image) {
    return data_uri("image/png", encode_png(image));
}

std::string data_uri(const std::string& type, const std::string& bytes) {
    return "data:" + type + ";base64," + base64(bytes);
}

namespace {

// The size of the drawing in pixels, and the rectangle of the plot within it.
constexpr double drawing_width = 760, drawing_height = 440;
constexpr double left = 70, top = 44, plot_width = 460, plot_height = 330;
constexpr double right = left + plot_width, bottom = top + plot_height;

struct Pen {
    const char* color;
    const char* dashes;
};
constexpr std::array<Pen, 7> pens{{{"#000000", "none"},
                                   {"#d55e00", "none"},
                                   {"#0072b2", "7 3"},
                                   {"#009e73", "2 3"},
                                   {"#cc79a7", "10 3 2 3"},
                                   {"#e69f00", "4 2"},
                                   {"#56b4e9", "12 3"}}};

std::string stroke_of(std::size_t line) {
    const Pen& pen = pens[line % pens.size()];
    return fmt::format(R"(stroke="{}" stroke-dasharray="{}" stroke-width="1.6" fill="none")",
                       pen.color, pen.dashes);
}

// Returns a step of 1, 2 or 5 times a power of ten, for about five ticks.
double tick_step(double range) {
    const double power = std::pow(10, std::floor(std::log10(range / 4)));
    for (const double factor : {1.0, 2.0, 5.0}) {
        if (range / (factor * power) <= 6) return factor * power;
    }
    return 10 * power;
}

std::vector<double> ticks(const PlotAxis& axis) {
    std::vector<double> at;
    if (axis.powers_of_two) {
        const int first = static_cast<int>(std::ceil(std::log2(axis.low)));
        const int last = static_cast<int>(std::floor(std::log2(axis.high)));
        for (int e = first; e <= last; ++e) at.push_back(std::exp2(e));
        return at;
    }
    const double step = tick_step(axis.high - axis.low);
    const auto first = static_cast<int>(std::ceil(axis.low / step - 1e-9));
    for (int i = first; i * step <= axis.high + 1e-9 * step; ++i) at.push_back(i * step);
    return at;
}

// Returns 0 at axis.low and 1 at axis.high.
double share_of(const PlotAxis& axis, double value) {
    const double inside = std::clamp(value, axis.low, axis.high);
    return axis.powers_of_two ? std::log2(inside / axis.low) / std::log2(axis.high / axis.low)
                              : (inside - axis.low) / (axis.high - axis.low);
}

std::string text_at(double x, double y, const char* anchor, const std::string& text,
                    const std::string& more = {}) {
    return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}>{}</text>\n", x, y,
                       anchor, more, escaped_markup(text));
}

}  // namespace

LinePlot::LinePlot(std::string title, PlotAxis x, PlotAxis y)
    : title_(std::move(title)), x_(std::move(x)), y_(std::move(y)) {}

void LinePlot::add(std::string name, std::vector<double> x, std::vector<double> y) {
    assert(x.size() == y.size());
    lines_.push_back({std::move(name), std::move(x), std::move(y)});
}

double LinePlot::across(double x) const {
    return left + plot_width * share_of(x_, x);
}
double LinePlot::down(double y) const {
    return bottom - plot_height * share_of(y_, y);
}

std::string LinePlot::grid() const {
    std::string svg;
    for (const double x : ticks(x_)) {
        svg += fmt::format("<path d=\"M{0:.1f} {1}V{2}\" stroke=\"#dddddd\"/>\n", across(x), top,
                           bottom);
        svg += text_at(across(x), bottom + 18, "middle", fmt::format("{:g}", x));
    }
    for (const double y : ticks(y_)) {
        svg += fmt::format("<path d=\"M{0} {1:.1f}H{2}\" stroke=\"#dddddd\"/>\n", left, down(y),
                           right);
        svg += text_at(left - 8, down(y) + 4, "end", fmt::format("{:g}", y));
    }
    return svg;
}

std::string LinePlot::frame() const {
    const double middle = 0.5 * (top + bottom);
    return fmt::format("<path d=\"M{0} {1}V{2}H{3}\" stroke=\"#000000\" fill=\"none\"/>\n", left,
                       top, bottom, right) +
           text_at(0.5 * (left + right), bottom + 42, "middle", x_.label) +
           text_at(20, middle, "middle", y_.label,
                   fmt::format(" transform=\"rotate(-90 20 {:.1f})\"", middle)) +
           text_at(left, top - 18, "start", title_, " font-weight=\"bold\"");
}

std::string LinePlot::points_of(const Line& line) const {
    std::string points;
    for (std::size_t i = 0; i < line.x.size(); ++i) {
        points +=
            fmt::format("{}{:.2f},{:.2f}", i == 0 ? "" : " ", across(line.x[i]), down(line.y[i]));
    }
    return points;
}

std::string LinePlot::legend_entry(std::size_t index) const {
    const double y = top + 10 + 20 * static_cast<double>(index), x = right + 16;
    return fmt::format("<path d=\"M{:.1f} {:.1f}h32\" {}/>\n", x, y, stroke_of(index)) +
           text_at(x + 40, y + 4, "start", lines_[index].name);
}

std::string LinePlot::svg() const {
    std::string svg = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" "
        "height=\"{1}\" font-family=\"sans-serif\" font-size=\"13\">\n"
        "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n",
        drawing_width, drawing_height);
    svg += grid() + frame();
    for (std::size_t i = 0; i < lines_.size(); ++i) {
        svg += fmt::format("<polyline points=\"{}\" {}/>\n", points_of(lines_[i]), stroke_of(i));
        svg += legend_entry(i);
    }
    return svg + "</svg>\n";
}

std::string escaped_markup(const std::string& text) {
    std::string markup;
    for (const char c : text) {
        if (c == '&')
            markup += "&amp;";
        else if (c == '<')
            markup += "&lt;";
        else if (c == '>')
            markup += "&gt;";
        else
            markup += c;
    }
    return markup;
}

}  // namespace lamina::study
