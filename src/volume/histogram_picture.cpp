// SPDX-License-Identifier: Apache-2.0
#include "volume/histogram_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "image/coded_image.h"

namespace lamina {
namespace {

constexpr int bars_high = 160;

class Chart {
  public:
    Chart(const ValueStatistics& statistics, int width)
        : of_(statistics), image_(width, room + line + bars_high + 2 * line + room, 3, 8) {
        fill_rectangle(image_, 0, 0, image_.width, image_.height, paper);
        draw_text(image_, room, room,
                  fmt::format("{} values, height: logarithm of the count", of_.count), dot, ink);
    }

    CodedImage draw() {
        if (of_.histogram.empty()) return std::move(image_);
        for (std::size_t i = 0; i < of_.histogram.counts.size(); ++i) draw_bar(i);
        fill_rectangle(image_, room, bottom, bars_wide(), 1, ink);
        const std::vector<double>& edges = of_.histogram.edges;
        draw_text(image_, room, bottom + 4, label(edges.front()), dot, ink);
        const std::string last = label(edges.back());
        draw_text(image_, image_.width - room - text_width(last, dot), bottom + 4, last, dot, ink);
        draw_marks();
        return std::move(image_);
    }

  private:
    static constexpr int dot = 2, line = (text_dots_high + 3) * dot, room = 8;  // pixels
    static constexpr int bottom = room + line + bars_high;
    static constexpr PixelColor paper{255, 255, 255}, ink{40, 40, 40}, bar_color{70, 110, 160},
        mark_color{200, 60, 40};

    std::string label(double value) const {
        const std::vector<double>& edges = of_.histogram.edges;
        return number_text(value, fineness_of(edges.front(), edges.back()));
    }
    int bars_wide() const { return image_.width - 2 * room; }
    int column(double value) const {
        const double lo = of_.histogram.edges.front(), hi = of_.histogram.edges.back();
        const double share = lo < hi ? (value / 2 - lo / 2) / (hi / 2 - lo / 2) : 0.5;
        return room + static_cast<int>(share * (bars_wide() - 1));
    }

    void draw_bar(std::size_t i) {
        const std::vector<std::int64_t>& counts = of_.histogram.counts;
        const double most = std::log1p(*std::max_element(counts.begin(), counts.end()));
        const int high = static_cast<int>(
            std::lround(bars_high * std::log1p(static_cast<double>(counts[i])) / most));
        const auto at = [&](std::size_t place) {
            return room +
                   static_cast<int>(place * static_cast<std::size_t>(bars_wide()) / counts.size());
        };
        fill_rectangle(image_, at(i), bottom - high, std::max(1, at(i + 1) - at(i)), high,
                       bar_color);
    }

    void draw_marks() {
        std::string text = "percentiles";
        for (const std::size_t i :
             {std::size_t{0}, of_.percentiles.size() / 2, of_.percentiles.size() - 1}) {
            fill_rectangle(image_, column(of_.percentiles[i]), bottom - bars_high, 1, bars_high + 4,
                           mark_color);
            text += fmt::format(" {:g}%={}", 0.1 * ValueStatistics::places[i],
                                label(of_.percentiles[i]));
        }
        draw_text(image_, room, bottom + line + 2, text, dot, mark_color);
    }

    const ValueStatistics& of_;
    CodedImage image_;
};

}  // namespace

CodedImage histogram_picture(const ValueStatistics& statistics, int width) {
    return Chart(statistics, width).draw();
}

}  // namespace lamina
