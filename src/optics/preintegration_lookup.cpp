// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "optics/opacity.h"
#include "optics/preintegration_table.h"

namespace lamina {

namespace {

using Anchor = PreintegrationTable::Anchor;

struct Cell {
    std::size_t first, second;
    double weight;  // of the second
};

Cell cell_of(double position, std::size_t count) {
    const auto first = std::min(static_cast<std::size_t>(position), count - 1);
    return {first, std::min(first + 1, count - 1), position - static_cast<double>(first)};
}

// `front` and `back` are node coordinates.
LitIntegral sample(const PreintegrationTable& table, double front, double back, double length) {
    const std::size_t count = table.nodes.size();
    const Cell f = cell_of(front, count), b = cell_of(back, count);
    const std::array<std::size_t, 4> entries = {
        b.first * count + f.first, b.first * count + f.second, b.second * count + f.first,
        b.second * count + f.second};
    const std::array<double, 4> weights = {(1 - b.weight) * (1 - f.weight),
                                           (1 - b.weight) * f.weight, b.weight * (1 - f.weight),
                                           b.weight * f.weight};
    double extinction = 0;
    for (int i = 0; i < 4; ++i) extinction += weights[i] * table.mean_extinction[entries[i]];
    LitIntegral result;
    SegmentIntegral& whole = result.whole;
    whole.optical_depth = extinction * length;
    whole.alpha = opacity_from_depth(whole.optical_depth);
    if (!table.colored) {
        whole.color = whole.alpha * table.single_color;
        return result;
    }
    if (extinction == 0) return result;
    const double longest = table.lengths.back();
    const double share = longest > 0 ? std::clamp(length / longest, 0.0, 1.0) : 0;
    const Cell l =
        cell_of(share * static_cast<double>(table.lengths.size() - 1), table.lengths.size());
    const double scale = whole.alpha / extinction;
    for (const auto& [layer, of_layer] : {std::pair(l.first, 1 - l.weight), {l.second, l.weight}}) {
        for (int i = 0; i < 4; ++i) {
            const std::size_t number = layer * count * count + entries[i];
            const double weight = scale * of_layer * weights[i];
            const float* const texel = &table.emission[number * 3];
            whole.color += weight * glm::dvec3(texel[0], texel[1], texel[2]);
            if (!table.lit()) continue;
            const float* const front_part = &table.front_parts[number * 4];
            result.front.color += weight * glm::dvec3(front_part[0], front_part[1], front_part[2]);
            result.front.alpha += weight * front_part[3];
        }
    }
    return result;
}

double coordinate_between(const Anchor& a, const Anchor& b, double value) {
    return a.node + (value - a.value) / (b.value - a.value) * (b.node - a.node);
}

// As coordinate(), but returns the left node at a step.
double left_coordinate(const PreintegrationTable& table, double value) {
    const auto& anchors = table.anchors;
    const auto at = std::ranges::lower_bound(anchors, value, {}, &Anchor::value);
    if (at == anchors.end()) return anchors.back().node;
    if (at == anchors.begin()) return at->node;
    return coordinate_between(*(at - 1), *at, value);
}

struct Part {
    double from, to;  // node coordinates, ascending
    double width;     // in scalars
};

// Splits the interval from `lo` to `hi` >= lo at the first and at the last anchor strictly between
// them.
std::array<Part, 3> split(const PreintegrationTable& table, double lo, double hi) {
    const auto& anchors = table.anchors;
    const double first = table.coordinate(lo);
    const double last = lo < hi ? left_coordinate(table, hi) : first;
    const auto above = std::ranges::upper_bound(anchors, lo, {}, &Anchor::value);
    const auto not_below = std::ranges::lower_bound(anchors, hi, {}, &Anchor::value);
    if (above >= not_below) return {Part{first, last, hi - lo}, Part{}, Part{}};
    const auto below = not_below - 1;
    const double inner = below->value - above->value;
    // Where the inner part ends at a step, it takes the node on its own side.
    return {Part{first, double(above->node), above->value - lo},
            Part{table.coordinate(above->value), left_coordinate(table, below->value), inner},
            Part{double(below->node), last, hi - below->value}};
}

}  // namespace

double PreintegrationTable::coordinate(double value) const {
    if (value >= anchors.back().value) return anchors.back().node;
    const auto above = std::ranges::upper_bound(anchors, value, {}, &Anchor::value);
    if (above == anchors.begin()) return 0;
    return coordinate_between(*(above - 1), *above, value);
}

LitIntegral PreintegrationTable::lookup_lit(double front, double back, double length) const {
    std::array<Part, 3> parts = split(*this, std::min(front, back), std::max(front, back));
    if (front > back) {
        std::ranges::reverse(parts);
        for (Part& part : parts) std::swap(part.from, part.to);
    }
    if (front == back) return sample(*this, parts[0].from, parts[0].to, length);
    LitIntegral result;
    SegmentIntegral& whole = result.whole;
    double left = 1;  // behind the part, as a share of the segment
    for (const Part& part : parts) {
        if (part.width == 0) continue;
        const double share = part.width / std::abs(back - front);
        left = std::max(left - share, 0.0);
        const LitIntegral next = sample(*this, part.from, part.to, length * share);
        const double transmittance = std::exp(-whole.optical_depth);
        result.front.color += transmittance * (left * next.whole.color + share * next.front.color);
        result.front.alpha += transmittance * (left * next.whole.alpha + share * next.front.alpha);
        whole.color += transmittance * next.whole.color;
        whole.optical_depth += next.whole.optical_depth;
    }
    whole.alpha = opacity_from_depth(whole.optical_depth);
    return result;
}

}  // namespace lamina
