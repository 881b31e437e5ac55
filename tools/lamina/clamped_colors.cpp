// SPDX-License-Identifier: Apache-2.0
#include "clamped_colors.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/vector_relational.hpp>

namespace lamina {

void count_clamped_colors(const RenderRequest& request, RenderStats& stats) {
    const Scene& scene = request.scene;
    const auto clamped = [](const TransferKnot& knot) {
        return glm::any(glm::greaterThan(knot.optics.color, glm::dvec3(1)));
    };
    const std::int64_t count = is_fixed_point(scene.target)
                                   ? std::ranges::count_if(scene.transfer_function.knots(), clamped)
                                   : 0;
    stats.counts["clamped_colors"] = count;
    if (count > 0) {
        request.message(fmt::format(
            "{} transfer-function points have a colour above 1, which the target {} clamps", count,
            name_of(scene.target)));
    }
}

}  // namespace lamina
