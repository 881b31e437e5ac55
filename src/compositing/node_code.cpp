// SPDX-License-Identifier: Apache-2.0
#include "compositing/node_code.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/enum_words.h"

namespace lamina {
namespace {

constexpr double e = std::numbers::e;
constexpr double low_end = 1 - 1 / e;  // value at sigma = 1, times Y

double encode_minimax(double depth, double share) {
    const double sigma = depth / share, log_part = -std::log(share) / e;
    const double full = 1 + log_part;
    if (sigma <= 1) return -std::expm1(-sigma) / full;
    if (depth <= 1) return (low_end + std::log(sigma) / e) / full;
    return (low_end + log_part - std::expm1(1 - depth) / e) / full;
}

double decode_minimax(double value, double share) {
    const double log_part = -std::log(share) / e;
    const double u = value * (1 + log_part);
    if (u <= low_end) return -share * std::log1p(-u);
    if (u <= low_end + log_part) return share * std::exp(e * u - e + 1);
    return 1 - std::log1p(-std::min(e * (u - low_end - log_part), 1.0));
}

}  // namespace

double encode_depth(NodeCode code, double depth, double share) {
    switch (code) {
        case NodeCode::phi:
            return -std::expm1(-depth / share);
        case NodeCode::alpha:
            return -std::expm1(-depth);
        case NodeCode::minimax:
            return std::min(encode_minimax(depth, share), 1.0);
    }
    unreachable_enum();
}

double decode_depth(NodeCode code, double value, double share) {
    if (value >= 1) return opaque_node_depth;
    double depth = 0;
    switch (code) {
        case NodeCode::phi:
            depth = -share * std::log1p(-value);
            break;
        case NodeCode::alpha:
            depth = -std::log1p(-value);
            break;
        case NodeCode::minimax:
            depth = decode_minimax(value, share);
            break;
    }
    return std::min(depth, opaque_node_depth);
}

}  // namespace lamina
