// SPDX-License-Identifier: Apache-2.0
#include "study/ladder_cost.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace lamina::study {
namespace {

// Seconds of one processor that a tet takes: TetGen and the search for the largest errors take most
// of it (.00022 on an EPYC with AVX2, 2026-11).
constexpr double usual_seconds_a_tet = 2.5e-4;

// Tets over 1 / tolerance. A field with second derivatives needs points in proportion to the power
// 1.5, noise nearly to the power 3.
constexpr double least_power = 1.5, usual_power = 2.5, largest_power = 3.5;

// All meshes of a ladder that halves its tolerances have so many times the tets of the last one:
// 1 + 2^-1.5 + 2^-3 + ...
constexpr double sum_of_ladder = 1.55;

}  // namespace

void LadderCost::add(double tolerance, std::int64_t tets, double seconds) {
    const Made made{tolerance, static_cast<double>(std::max<std::int64_t>(tets, 1))};
    power_ = usual_power;
    if (last_ && made.tolerance < last_->tolerance)
        power_ = std::clamp(
            std::log(made.tets / last_->tets) / std::log(last_->tolerance / made.tolerance),
            least_power, largest_power);
    seconds_a_tet_ = seconds / made.tets;
    last_ = made;
}

double LadderCost::at_most(std::size_t meshes) const {
    const double largest = most_tets_ * usual_seconds_a_tet;
    const auto count = static_cast<double>(meshes);
    return (ends_there_ ? std::min(count, sum_of_ladder) : count) * largest;
}

double LadderCost::of(std::span<const double> tolerances) const {
    assert(last_);
    double seconds = 0;
    if (ends_there_ && last_->tets >= most_tets_) return 0;
    for (const double tolerance : tolerances) {
        const double tets =
            std::min(most_tets_, last_->tets * std::pow(last_->tolerance / tolerance, power_));
        seconds += tets * seconds_a_tet_;
        if (ends_there_ && tets >= most_tets_) break;
    }
    return seconds;
}

}  // namespace lamina::study
