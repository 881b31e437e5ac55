// SPDX-License-Identifier: Apache-2.0
#include "papers/figure_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <utility>

#include "base/json_text.h"
#include "study/report_files.h"

namespace lamina::papers {
namespace {

std::string cell_of(const nlohmann::ordered_json& value) {
    if (value.is_null()) return {};
    if (value.is_number_float()) return fmt::format("{:.6g}", value.get<double>());
    if (!value.is_string()) return json_text(value);
    return value.get<std::string>();
}

// Size of the drawing, and the rectangle of the plot in it, in pixels.
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

// Returns the place of the value on the axis: 0 at axis.low, 1 at axis.high.
double share_of(const PlotAxis& axis, double value) {
    const double inside = std::clamp(value, axis.low, axis.high);
    return axis.powers_of_two ? std::log2(inside / axis.low) / std::log2(axis.high / axis.low)
                              : (inside - axis.low) / (axis.high - axis.low);
}

std::string text_at(double x, double y, const char* anchor, const std::string& text,
                    const std::string& more = {}) {
    return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}>{}</text>\n", x, y,
                       anchor, more, study::escaped_markup(text));
}

double across(const LinePlot& plot, double x) {
    return left + plot_width * share_of(plot.x, x);
}

double down(const LinePlot& plot, double y) {
    return bottom - plot_height * share_of(plot.y, y);
}

std::string grid(const LinePlot& plot) {
    std::string svg;
    for (const double x : ticks(plot.x)) {
        svg += fmt::format("<path d=\"M{0:.1f} {1}V{2}\" stroke=\"#dddddd\"/>\n", across(plot, x),
                           top, bottom);
        svg += text_at(across(plot, x), bottom + 18, "middle", fmt::format("{:g}", x));
    }
    for (const double y : ticks(plot.y)) {
        svg += fmt::format("<path d=\"M{0} {1:.1f}H{2}\" stroke=\"#dddddd\"/>\n", left,
                           down(plot, y), right);
        svg += text_at(left - 8, down(plot, y) + 4, "end", fmt::format("{:g}", y));
    }
    return svg;
}

std::string frame(const LinePlot& plot) {
    const double middle = 0.5 * (top + bottom);
    return fmt::format("<path d=\"M{0} {1}V{2}H{3}\" stroke=\"#000000\" fill=\"none\"/>\n", left,
                       top, bottom, right) +
           text_at(0.5 * (left + right), bottom + 42, "middle", plot.x.label) +
           text_at(20, middle, "middle", plot.y.label,
                   fmt::format(" transform=\"rotate(-90 20 {:.1f})\"", middle)) +
           text_at(left, top - 18, "start", plot.title, " font-weight=\"bold\"");
}

std::string points_of(const LinePlot& plot, const LinePlot::Line& line) {
    std::string points;
    for (std::size_t i = 0; i < line.x.size(); ++i) {
        points += fmt::format("{}{:.2f},{:.2f}", i == 0 ? "" : " ", across(plot, line.x[i]),
                              down(plot, line.y[i]));
    }
    return points;
}

std::string legend_entry(const LinePlot& plot, std::size_t index) {
    const double y = top + 10 + 20 * static_cast<double>(index), x = right + 16;
    return fmt::format("<path d=\"M{:.1f} {:.1f}h32\" {}/>\n", x, y, stroke_of(index)) +
           text_at(x + 40, y + 4, "start", plot.lines[index].name);
}

}  // namespace

Image plain_picture(const Scene& scene, SceneData data, const Capabilities& capabilities,
                    std::shared_ptr<TableCache> tables) {
    Pipeline pipeline(scene, std::move(data),
                      {.capabilities = capabilities, .tables = std::move(tables)});
    Image picture;
    pipeline.draw_frame();
    pipeline.read(picture);
    return picture;
}

std::string csv_of_rows(const nlohmann::ordered_json& rows) {
    std::vector<std::string> names;
    for (const auto& [key, value] : rows.front().items()) names.push_back(key);
    study::CsvTable csv(names);
    for (const nlohmann::ordered_json& row : rows) {
        std::vector<std::string> cells;
        for (const auto& [key, value] : row.items()) cells.push_back(cell_of(value));
        csv.add_row(cells);
    }
    return csv.text();
}

nlohmann::ordered_json time_rows(const std::vector<study::TimedFrame>& frames,
                                 const std::vector<study::FrameTimes>& times) {
    auto rows = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < frames.size(); ++i) {
        rows.push_back({{"technique", frames[i].name},
                        {"ms", times[i].ms},
                        {"ratio", times[i].ms / times[0].ms},
                        {"cpu_ms", times[i].cpu_ms},
                        {"cpu_ratio", times[i].cpu_ms / times[0].cpu_ms},
                        {"slowest_over_fastest", times[i].max / times[i].min}});
    }
    return rows;
}

void LinePlot::add(std::string name, std::vector<double> x_of, std::vector<double> y_of) {
    assert(x_of.size() == y_of.size());
    lines.push_back({std::move(name), std::move(x_of), std::move(y_of)});
}

std::string LinePlot::svg() const {
    std::string svg = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" "
        "height=\"{1}\" font-family=\"sans-serif\" font-size=\"13\">\n"
        "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n",
        drawing_width, drawing_height);
    svg += grid(*this) + frame(*this);
    for (std::size_t i = 0; i < lines.size(); ++i) {
        svg +=
            fmt::format("<polyline points=\"{}\" {}/>\n", points_of(*this, lines[i]), stroke_of(i));
        svg += legend_entry(*this, i);
    }
    return svg + "</svg>\n";
}

}  // namespace lamina::papers
