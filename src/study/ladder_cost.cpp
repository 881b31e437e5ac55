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

double LadderCost::most_seconds(std::span<const Step> steps) {
    double full = 0, tets = 0;  // of a ladder that ends with a full mesh, and of other meshes
    double ladder = 0;
    for (const Step& step : steps) {
        const auto most = static_cast<double>(step.most_tets);
        if (!step.last_if_full) {
            tets += most;
            continue;
        }
        full = std::max(full, most);
        ladder += most;
    }
    return usual_seconds_a_tet * (tets + std::min(ladder, sum_of_ladder * full));
}

double LadderCost::expected_seconds(std::span<const Step> steps) const {
    assert(last_);
    double seconds = 0;
    bool full = false;
    for (const Step& step : steps) {
        if (step.last_if_full && full) continue;
        const auto most = static_cast<double>(step.most_tets);
        const double tets =
            std::min(most, last_->tets * std::pow(last_->tolerance / step.tolerance, power_));
        seconds += tets * seconds_a_tet_;
        full = full || (step.last_if_full && tets >= most);
    }
    return seconds;
}

}  // namespace lamina::study
