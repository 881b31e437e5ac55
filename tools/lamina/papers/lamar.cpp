// SPDX-License-Identifier: Apache-2.0
#include "papers/lamar.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numeric>
#include <set>

#include "base/parallel.h"
#include "compositing/codes.h"
#include "papers/figure_files.h"
#include "study/report_files.h"
#include "volume/generate.h"

namespace lamina::papers {
namespace {

constexpr int depth = 1024;  // slabs
constexpr double light_density = 0.023;
constexpr double opacity_per_density = 0.765;

// Converts a code to units of 1/255; codes of 16 bits, too.
double in_255ths(std::uint32_t code, int bits) {
    return 255.0 * code / largest_code(bits);
}

template <typename Ray>
Curve each_column(const Ray& ray) {
    Curve curve(ramp_width);
    parallel_for(ramp_width, 8, [&](std::int64_t column) {
        curve[static_cast<std::size_t>(column)] = ray(static_cast<std::uint32_t>(column));
    });
    return curve;
}

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
    LinePlot plot{title,
                  {"wanted opacity of the ray, in 1/255", 0, 255},
                  {"shown, in 1/255", 0, std::max(high, 1.0)}};
    Curve x(ramp_width);
    std::iota(x.begin(), x.end(), 0.0);
    for (const NamedCurve& named : curves) plot.add(named.name, x, named.curve);
    return plot.svg();
}

// Returns a grey strip, 32 pixels high, whose codes are the values.
CodedImage strip_of(const Curve& curve) {
    constexpr int high = 32;
    CodedImage image(ramp_width, high, 3, 8);
    for (std::size_t i = 0; i < image.codes.size(); ++i)
        image.codes[i] = static_cast<std::uint16_t>(std::lround(curve[i / 3 % ramp_width]));
    return image;
}

}  // namespace

const std::vector<LamarItem>& lamar_items() {
    static const std::vector<LamarItem> items{
        {"table1", {"table1.csv"}, reproduce_table1, nullptr},
        {"table2", {"table2.csv"}, reproduce_table2, nullptr},
        {"table3", {"table3.csv"}, reproduce_table3, nullptr},
        {"table4", {"table4.csv"}, nullptr, draw_table4},
        {"figure1", {"figure1.csv"}, nullptr, draw_figure1},
        {"figure2", ramp_figure_files("figure2"), reproduce_figure2, nullptr},
        {"figure3", ramp_figure_files("figure3"), reproduce_figure3, nullptr},
        {"figure4", ramp_figure_files("figure4"), reproduce_figure4, nullptr},
        {"figure5", ramp_figure_files("figure5"), reproduce_figure5, nullptr},
        {"figure6", {}, nullptr, draw_figure6},
        {"figure9", ramp_figure_files("figure9"), reproduce_figure9, nullptr},
        {"figure10", {"figure10.csv"}, nullptr, draw_figure10},
        {"order", {"order.csv", "order.svg"}, reproduce_order, nullptr},
        {"order_mixing", {"order_mixing.csv"}, nullptr, draw_order_mixing},
        {"dithering",
         {"dithering_periods.csv", "dithering_periods.svg", "dithering_increments.csv",
          "dithering_increments.svg", "dithering_spans.csv"},
         reproduce_dithering,
         nullptr},
        {"times", {"times.csv", "times_palettes.csv"}, nullptr, draw_times},
    };
    return items;
}

Scene with_paper_hardware(Scene scene) {
    scene.target = Target::emulated;
    scene.emulate = Emulation{};  // 8 bits, truncate, separate
    return scene;
}

Volume mixing_volume() {
    return generate({"mixing", std::array<std::int64_t, 3>{128, 128, 256}, SampleType::uint8});
}

Scene mixing_scene(int pixels, bool white) {
    Scene scene;
    std::vector<TransferKnot> knots;
    for (int value = 0; value <= 255; ++value) {
        const double density = light_density + (1 - light_density) * value / 255.0;
        const glm::dvec3 color = white ? glm::dvec3(1) : glm::dvec3(density, 1 - density, 0);
        knots.push_back({double(value), {color, -std::log1p(-opacity_per_density * density)}});
    }
    scene.transfer_function = TransferFunction::linear(std::move(knots));
    scene.camera->projection = Projection::orthographic;
    scene.camera->eye = {0.5, 0.5, 2};
    scene.camera->center = glm::dvec3(0.5);
    scene.camera->height = 1;
    scene.width = scene.height = pixels;
    scene.slice.classification = Classification::post;
    scene.slice.samples = depth;
    return scene;
}

Curve exact_ramp(double color) {
    return each_column([&](std::uint32_t column) { return color * column; });
}

Curve composite_ramp(const RampSetting& setting) {
    return each_column([&](std::uint32_t column) {
        const RaySample sample{setting.color, opacity_over(column / 255.0, 1.0 / setting.samples)};
        const std::vector<RaySample> ray(static_cast<std::size_t>(setting.samples), sample);
        const FixedPixel pixel =
            composite_straight(ray, setting.emulation, setting.dither, setting.order, column);
        return in_255ths(pixel.color, setting.emulation.bits);
    });
}

Curve composite_ramp_tree(const RampSetting& setting, const std::vector<int>& factors) {
    const TreeShape tree(factors, setting.samples);
    return each_column([&](std::uint32_t column) {
        const std::vector<double> ray(static_cast<std::size_t>(setting.samples), column / 255.0);
        return in_255ths(
            composite_tree(ray, tree, setting.emulation, setting.dither, setting.order, column),
            setting.emulation.bits);
    });
}

ErrorNorms error_of(const Curve& measured, const Curve& exact) {
    assert(measured.size() == exact.size() && !exact.empty());
    ErrorNorms norms;
    double squares = 0;
    for (std::size_t i = 0; i < exact.size(); ++i) {
        const double e = measured[i] - exact[i];
        norms.linf = std::max(norms.linf, std::abs(e));
        norms.mean += e;
        squares += e * e;
    }
    const auto count = static_cast<double>(exact.size());
    norms.mean /= count;
    norms.l2 = std::sqrt(squares / count);
    return norms;
}

int decreases(const Curve& curve) {
    int found = 0;
    for (std::size_t i = 1; i < curve.size(); ++i) found += curve[i] < curve[i - 1] ? 1 : 0;
    return found;
}

double largest_drop(const Curve& curve) {
    double drop = 0;
    for (std::size_t i = 1; i < curve.size(); ++i) drop = std::max(drop, curve[i - 1] - curve[i]);
    return drop;
}

int levels(const Curve& curve) {
    return static_cast<int>(std::set<double>(curve.begin(), curve.end()).size());
}

int first_shown(const Curve& curve) {
    const auto shown = std::find_if(curve.begin(), curve.end(), [](double v) { return v > 0; });
    return static_cast<int>(shown - curve.begin());
}

SpanLoss span_loss(const SpanSetting& setting) {
    const int period = setting.dither.period;
    const std::vector<std::uint32_t> ranks = dither_ranks(period, setting.dither.seed);
    SpanLoss loss;
    int shown = 0;
    for (int place = 0; place < period; ++place) {
        std::uint32_t sum = 0;
        int first = -1;
        for (int i = 0; i < setting.slabs; ++i) {
            const std::uint32_t rank = ranks[static_cast<std::size_t>((place + i) % period)];
            const std::uint32_t code =
                dither_code(setting.code, rank, period, setting.dither.increment, largest_code(8));
            if (code > 0 && first < 0) first = i;
            sum += code;
        }
        const double error = sum - setting.slabs * setting.code;
        loss.sum_error += error * error / period;
        if (first < 0) continue;
        ++shown;
        loss.mean_shift += first;
        loss.largest_shift = std::max(loss.largest_shift, first);
    }
    loss.sum_error = std::sqrt(loss.sum_error);
    loss.lost = static_cast<double>(period - shown) / period;
    if (shown > 0) loss.mean_shift /= shown;
    return loss;
}

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
