// SPDX-License-Identifier: Apache-2.0
// The ramp of LaMar 2004, section 4: 256 rays side by side, each homogeneous and one unit long. Ray
// x has the opacity x/255.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "compositing/codes.h"
#include "compositing/fixed_ray.h"
#include "image/difference.h"

namespace lamina::papers {

inline constexpr int ramp_width = 256;

// One number for each ray in units of 1/255: the associated colour that would be shown.
using Curve = std::vector<double>;

struct RampSetting {
    int samples = 64;  // N
    double color = 1;
    Emulation emulation = {};
    std::optional<Dither> dither = {};
    Order order = Order::back_to_front;
};

// The exact ramp: color * x.
Curve exact_ramp(double color);

Curve composite_ramp(const RampSetting& setting);

// The opacity (colour 1) by exponent-factoring. `factors`: as in TreeShape.
Curve composite_ramp_tree(const RampSetting& setting, const std::vector<int>& factors);

// Norms of e = measured - exact. Both have the same size, at least 1.
ErrorNorms error_of(const Curve& measured, const Curve& exact);

// Returns the number of places at which a curve is lower than one place before.
int decreases(const Curve& curve);

// Returns the largest such decrease; 0 if the curve never decreases.
double largest_drop(const Curve& curve);

// The number of different values of a curve.
int levels(const Curve& curve);

// Returns the first column that is not 0, or ramp_width if there is none.
int first_shown(const Curve& curve);

// The effect of dithering along depth on a structure that fills only some of a ray's slabs (LaMar
// 2004, section 5.2).

struct SpanSetting {
    double code = 0.1;  // opacity of its samples in codes of 8 bits, 0 < code < 1
    int slabs = 9;      // number of slabs that it fills, >= 1
    Dither dither;
};

// Statistics over all positions of the structure relative to the pattern.
struct SpanLoss {
    double lost = 0;  // share of positions at which nothing of it shows
    // Mean number of slabs from its boundary to the first slab that shows, over the positions that
    // have one.
    double mean_shift = 0;
    int largest_shift = 0;
    double sum_error = 0;  // RMS difference between the sum of its codes and slabs * code, in codes
};

SpanLoss span_loss(const SpanSetting& setting);

struct NamedCurve {
    std::string name;
    Curve curve;
};

// The files that write_ramp_figure() writes: NAME.csv and NAME.svg.
std::vector<std::string> ramp_figure_files(const std::string& name);

// Writes a figure of ramps into `folder`; `curves[0]` is the exact one. NAME.csv has one column for
// each curve, and NAME.svg is their plot. Returns {files, curves: {name: [...]}, errors: {name:
// {linf, l1, l2}}, panels}, in units of 1/255. The panels are one grey strip for each curve, as in
// the paper.
nlohmann::ordered_json write_ramp_figure(const std::filesystem::path& folder,
                                         const std::string& name, const std::string& title,
                                         const std::vector<NamedCurve>& curves);

}  // namespace lamina::papers
