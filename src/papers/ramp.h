// SPDX-License-Identifier: Apache-2.0
// LaMar 2004, section 4: 256 rays side by side, each homogeneous and one unit long; ray x has the
// opacity x/255.
#pragma once

#include <optional>
#include <vector>

#include "compositing/dither.h"
#include "compositing/fixed_ray.h"
#include "image/metrics.h"

namespace lamina::papers {

inline constexpr int ramp_width = 256;

// One number a ray, in units of 1/255: colour, associated, as it would be shown.
using Curve = std::vector<double>;

struct RampSetting {
    int samples = 64;  // N
    double color = 1;
    Emulation emulation = {};
    std::optional<Dither> dither = {};
    Order order = Order::back_to_front;
};

// What software shows: color * x.
Curve exact_ramp(double color);

Curve composite_ramp(const RampSetting& setting);

// Opacity (colour 1) by exponent-factoring; factors as TreeShape takes them.
Curve composite_ramp_tree(const RampSetting& setting, const std::vector<int>& factors);

// Of e = measured - exact. Both of one size, at least 1.
ErrorNorms error_of(const Curve& measured, const Curve& exact);

// Places where a curve is lower than one place before.
int decreases(const Curve& curve);

// By how much, at most; 0 where it never decreases.
double largest_drop(const Curve& curve);

// How many different values it has.
int levels(const Curve& curve);

// The first column that shows something; ramp_width when none does.
int first_shown(const Curve& curve);

}  // namespace lamina::papers
