// SPDX-License-Identifier: Apache-2.0
// The ramp of LaMar 2004, section 4: 256 rays side by side, each homogeneous and one unit long. Ray
// x has the opacity x/255.
#pragma once

#include <optional>
#include <vector>

#include "compositing/dither.h"
#include "compositing/fixed_ray.h"
#include "image/metrics.h"

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

// The number of places where a curve is lower than one place before.
int decreases(const Curve& curve);

// The largest such decrease; 0 where the curve never decreases.
double largest_drop(const Curve& curve);

// The number of different values of a curve.
int levels(const Curve& curve);

// The first column that is not 0, or ramp_width where there is none.
int first_shown(const Curve& curve);

}  // namespace lamina::papers
