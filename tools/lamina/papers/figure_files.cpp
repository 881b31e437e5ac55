// SPDX-License-Identifier: Apache-2.0
#include "papers/figure_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "papers/panels.h"
#include "study/error_json.h"
#include "study/line_plot.h"
#include "study/text_file.h"

namespace lamina::papers {
namespace {

using Json = nlohmann::ordered_json;

std::string csv_of(const std::vector<NamedCurve>& curves) {
    std::vector<std::string> names{"x"};
    for (const NamedCurve& named : curves) names.push_back(named.name);
    study::CsvTable table(names);
    for (std::size_t x = 0; x < ramp_width; ++x) {
        std::vector<std::string> cells{std::to_string(x)};
        for (const NamedCurve& named : curves) cells.push_back(fmt::format("{}", named.curve[x]));
        table.add_row(cells);
    }
    return table.text();
}

std::string svg_of(const std::string& title, const std::vector<NamedCurve>& curves) {
    double high = 0;
    for (const NamedCurve& named : curves) {
        high = std::max(high, *std::max_element(named.curve.begin(), named.curve.end()));
    }
    study::LinePlot plot(title, {"wanted opacity of the ray, in 1/255", 0, 255},
                         {"shown, in 1/255", 0, std::max(high, 1.0)});
    Curve x(ramp_width);
    std::iota(x.begin(), x.end(), 0.0);
    for (const NamedCurve& named : curves) plot.add(named.name, x, named.curve);
    return plot.svg();
}

// A grey strip, 32 pixels high. The values are the codes themselves.
CodedImage strip_of(const Curve& curve) {
    constexpr int high = 32;
    CodedImage image(ramp_width, high, 3, 8);
    for (std::size_t i = 0; i < image.codes.size(); ++i)
        image.codes[i] = static_cast<std::uint16_t>(std::lround(curve[i / 3 % ramp_width]));
    return image;
}

}  // namespace

std::vector<std::string> ramp_figure_files(const std::string& name) {
    return {name + ".csv", name + ".svg"};
}

Json write_ramp_figure(const std::filesystem::path& folder, const std::string& name,
                       const std::string& title, const std::vector<NamedCurve>& curves) {
    study::write_text(folder / (name + ".csv"), csv_of(curves));
    study::write_text(folder / (name + ".svg"), svg_of(title, curves));
    Panels panels;
    for (const NamedCurve& named : curves) panels.add("", named.name, strip_of(named.curve));
    Json values;
    values["panels"] = panels.json();
    values["files"] = ramp_figure_files(name);
    for (const NamedCurve& named : curves) values["curves"][named.name] = named.curve;
    for (std::size_t i = 1; i < curves.size(); ++i) {
        values["errors"][curves[i].name] =
            study::to_json(error_of(curves[i].curve, curves[0].curve));
    }
    return values;
}

}  // namespace lamina::papers
