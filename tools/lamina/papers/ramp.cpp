// SPDX-License-Identifier: Apache-2.0
#include "papers/ramp.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <set>

#include "base/parallel.h"
#include "compositing/unit_opacity.h"

namespace lamina::papers {
namespace {

// Codes of 16 bits are reported in units of 1/255, too.
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

}  // namespace

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
        norms.l1 += e;
        squares += e * e;
    }
    const auto count = static_cast<double>(exact.size());
    norms.l1 /= count;
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

}  // namespace lamina::papers
