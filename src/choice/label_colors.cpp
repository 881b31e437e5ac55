// SPDX-License-Identifier: Apache-2.0
#include "choice/label_colors.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/vec3.hpp>
#include <vector>

namespace lamina {
namespace {

// Linear light; neighbours differ in hue.
constexpr std::array<glm::dvec3, 8> label_colors{{{.75, .20, .05},
                                                  {.06, .30, .65},
                                                  {.80, .55, .08},
                                                  {.10, .45, .15},
                                                  {.45, .12, .50},
                                                  {.08, .50, .50},
                                                  {.75, .30, .40},
                                                  {.70, .65, .55}}};

// Rare labels are denser, by up to ten times.
double extinction_of(double share) {
    return std::pow(std::max(share, .01), -.5);
}

}  // namespace

AutomaticTransfer label_transfer(const ValueDistribution& values) {
    std::size_t common = 0;
    double most = 0;
    for (std::size_t i = 0; i < values.distinct(); ++i) {
        const double share = values.share(values.value(i), values.value(i));
        if (share > most) {
            most = share;
            common = i;
        }
    }
    std::vector<TransferKnot> points;
    double largest = 0;
    for (std::size_t i = 0; i < values.distinct(); ++i) {
        const double share = values.share(values.value(i), values.value(i)) / (1 - most);
        OpticalProperties optics{label_colors[(i + (i > common ? 7 : 0)) % label_colors.size()],
                                 extinction_of(share)};
        if (i == common) optics = {};
        largest = std::max(largest, optics.extinction);
        points.push_back({values.value(i), optics});
    }
    for (TransferKnot& point : points) point.optics.extinction /= largest;
    return {TransferFunction::nearest(points),
            fmt::format("{} whole numbers are taken for labels: {:g}, {:.3g} % of the field, is "
                        "transparent, each of the others has a colour",
                        values.distinct(), values.value(common), 100 * most)};
}

}  // namespace lamina
