// SPDX-License-Identifier: Apache-2.0
#include "statistics_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "image/pixel_text.h"
#include "volume/histogram_picture.h"

namespace lamina {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t most_rows = 16;
constexpr int bar_letters = 40, narrowest_picture = 480;

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
    std::string text;
    for (const auto& [name, value] : percentiles.items())
        text += fmt::format("{}{} %: {:.6g}", text.empty() ? "" : ", ", name, value.get<double>());
    return text;
}

std::string histogram_text(const Json& histogram) {
    const auto edges = histogram["edges"].get<std::vector<double>>();
    const auto counts = histogram["counts"].get<std::vector<std::int64_t>>();
    const std::size_t rows = std::min(most_rows, counts.size());
    std::vector<std::int64_t> sums(rows);
    std::vector<double> ends(rows);
    std::int64_t all = 0;
    // Row r has the intervals from r * n / rows on.
    for (std::size_t i = 0, row = 0; i < counts.size(); ++i) {
        if ((row + 1) * counts.size() / rows <= i) ++row;
        sums[row] += counts[i];
        ends[row] = edges[i + 1];
        all += counts[i];
    }
    const auto most = static_cast<double>(*std::max_element(sums.begin(), sums.end()));
    std::string text = "(# is the logarithm of the count)\n";
    double begin = edges.front();
    for (std::size_t row = 0; row < rows; ++row) {
        const auto sum = static_cast<double>(sums[row]);
        const auto letters =
            static_cast<std::size_t>(std::lround(bar_letters * std::log1p(sum) / std::log1p(most)));
        text += fmt::format("  {:>11.5g} .. {:<11.5g} {:>7.3f} % {}\n", begin, ends[row],
                            100 * sum / static_cast<double>(all), std::string(letters, '#'));
        begin = ends[row];
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
