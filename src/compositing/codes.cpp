// SPDX-License-Identifier: Apache-2.0
#include "compositing/codes.h"

#include <numbers>
#include <numeric>
#include <utility>

namespace lamina {
namespace {

constexpr double e = std::numbers::e;
// The minimax code at sigma = 1, before the division by 1 - ln(share) / e.
constexpr double low_end = 1 - 1 / e;

double encode_minimax(double depth, double share) {
    const double sigma = depth / share, log_part = -std::log(share) / e;
    const double full = 1 + log_part;  // Y in docs/numerics.md, section 4
    if (sigma <= 1) return -std::expm1(-sigma) / full;
    if (depth <= 1) return (low_end + std::log(sigma) / e) / full;
    return (low_end + log_part - std::expm1(1 - depth) / e) / full;
}

double decode_minimax(double value, double share) {
    const double log_part = -std::log(share) / e;
    const double u = value * (1 + log_part);  // the code before the division by Y
    if (u <= low_end) return -share * std::log1p(-u);
    if (u <= low_end + log_part) return share * std::exp(e * u - e + 1);
    return 1 - std::log1p(-std::min(e * (u - low_end - log_part), 1.0));
}

}  // namespace

std::vector<std::uint32_t> dither_ranks(int period, std::uint64_t seed) {
    std::vector<std::uint32_t> ranks(static_cast<std::size_t>(period));
    std::iota(ranks.begin(), ranks.end(), 0u);
    SplitMix64 random(seed);
    for (std::size_t i = ranks.size() - 1; i > 0; --i) {
        std::swap(ranks[i], ranks[random.next() % (i + 1)]);
    }
    return ranks;
}

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
    switch (code) {
        case NodeCode::phi:
            return std::min(-share * std::log1p(-value), opaque_node_depth);
        case NodeCode::alpha:
            return std::min(-std::log1p(-value), opaque_node_depth);
        case NodeCode::minimax:
            return std::min(decode_minimax(value, share), opaque_node_depth);
    }
    unreachable_enum();
}

}  // namespace lamina
