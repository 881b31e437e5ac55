// SPDX-License-Identifier: Apache-2.0
#include "statistics_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/text.h"
#include "image/coded_image.h"
#include "volume/value_statistics.h"

namespace lamina {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t most_rows = 16;
constexpr int bar_letters = 40, narrowest_picture = 480;
constexpr std::size_t narrowest_end = 8;

std::string row_end(const std::vector<double>& edges, std::size_t number) {
    return number_text(edges[number], fineness_of(edges.front(), edges.back()), 5);
}

}  // namespace

void add_statistics(const ValueStatistics& statistics, Json& info) {
    info["percentiles"] = nullptr;
    info["histogram"] = nullptr;
    if (statistics.percentiles.empty()) return;
    Json percentiles = Json::object();
    for (std::size_t i = 0; i < statistics.percentiles.size(); ++i) {
        const std::string name = fmt::format("{:g}", 0.1 * ValueStatistics::places[i]);
        percentiles[name] = statistics.percentiles[i];
    }
    info["percentiles"] = percentiles;
    info["histogram"] = {{"edges", statistics.histogram.edges},
                         {"counts", statistics.histogram.counts}};
}

std::string percentiles_text(const Json& percentiles) {
    const double fineness =
        fineness_of(percentiles.front().get<double>(), percentiles.back().get<double>());
    std::string text;
    for (const auto& [name, value] : percentiles.items()) {
        text += fmt::format("{}{} %: {}", text.empty() ? "" : ", ", name,
                            number_text(value.get<double>(), fineness, 6));
    }
    return text;
}

std::string histogram_text(const Json& histogram) {
    const auto edges = histogram["edges"].get<std::vector<double>>();
    const auto counts = histogram["counts"].get<std::vector<std::int64_t>>();
    // All rows have as many intervals, but for the last.
    const std::size_t together = (counts.size() + most_rows - 1) / most_rows;
    std::vector<std::int64_t> sums;
    std::vector<std::string> ends{row_end(edges, 0)};
    for (std::size_t i = 0; i < counts.size(); ++i) {
        if (i % together == 0) sums.push_back(0);
        sums.back() += counts[i];
        if ((i + 1) % together == 0 || i + 1 == counts.size())
            ends.push_back(row_end(edges, i + 1));
    }
    const auto most = static_cast<double>(*std::max_element(sums.begin(), sums.end()));
    const auto all = static_cast<double>(std::accumulate(sums.begin(), sums.end(), std::int64_t{}));
    std::size_t width = narrowest_end;
    for (const std::string& end : ends) width = std::max(width, end.size());
    std::string text = "(# is the logarithm of the count)\n";
    for (std::size_t row = 0; row < sums.size(); ++row) {
        const auto sum = static_cast<double>(sums[row]);
        const auto letters =
            static_cast<std::size_t>(std::lround(bar_letters * std::log1p(sum) / std::log1p(most)));
        text += fmt::format("  {:>{}} .. {:<{}} {:>7.3f} % {}\n", ends[row], width, ends[row + 1],
                            width, 100 * sum / all, std::string(letters, '#'));
    }
    return text;
}

CodedImage above_one_another(const CodedImage& above, const std::function<CodedImage(int)>& below) {
    const int width = std::max(above.width, narrowest_picture);
    const CodedImage second = below(width);
    CodedImage image(width, above.height + second.height, 3, 8);
    fill_rectangle(image, 0, 0, image.width, image.height, {255, 255, 255});
    copy_into(image, above, 0, 0);
    copy_into(image, second, 0, above.height);
    return image;
}

}  // namespace lamina
