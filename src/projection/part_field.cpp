// SPDX-License-Identifier: Apache-2.0
#include "projection/part_field.h"

#include <algorithm>
#include <cmath>

#include "projection/tet_view-inl.h"

namespace lamina {

PartField::PartField(const Corners& corners, const Values& values, const LinearPiece* piece)
    : corners_(corners), values_(values) {
    const auto [least, largest] = std::ranges::minmax(values);
    least_ = least;
    largest_ = largest;
    if (piece != nullptr) {
        cut_low_ = piece->from > least;
        cut_high_ = piece->to < largest;
        least_ = std::clamp(least, piece->from, piece->to);
        largest_ = std::clamp(largest, piece->from, piece->to);
    }
    const glm::dvec3 e1 = corners[1] - corners[0], e2 = corners[2] - corners[0],
                     e3 = corners[3] - corners[0];
    const LAMINA_LEAST(TetSlopes)<double> slopes(corners);
    gradient_ =
        slopes.numerator(values[1] - values[0], values[2] - values[0], values[3] - values[0]) /
        slopes.determinant;
    // A tet without volume is invisible, whatever its scalar.
    const auto largest_of = [](const glm::dvec3& v) {
        return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    };
    const double extent = std::max({largest_of(e1), largest_of(e2), largest_of(e3)});
    if (!(largest_of(gradient_) * extent < 1e30 * (largest - least))) gradient_ = glm::dvec3(0);
}

PartField::Outline PartField::outline() const {
    Outline outline;
    const auto add = [&](const glm::dvec3& point) {
        if (outline.count < outline.corners.size()) outline.corners[outline.count++] = point;
    };
    for (std::size_t i = 0; i < 4; ++i) {
        if (values_[i] >= least_ && values_[i] <= largest_) add(corners_[i]);
        for (std::size_t j = i + 1; j < 4; ++j) {
            const auto crosses = [&](double level) {
                return (values_[i] < level && values_[j] > level) ||
                       (values_[i] > level && values_[j] < level);
            };
            for (const double level : {least_, largest_}) {
                if (!crosses(level)) continue;
                const double share = (level - values_[i]) / (values_[j] - values_[i]);
                add(corners_[i] + share * (corners_[j] - corners_[i]));
            }
        }
    }
    return outline;
}

}  // namespace lamina
