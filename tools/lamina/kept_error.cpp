// SPDX-License-Identifier: Apache-2.0
#include "kept_error.h"

#include <fmt/format.h>

namespace lamina {

void say_what_is_not_kept(const RenderRequest& request, const SlicePlan& plan) {
    const double wanted = request.scene.max_error;
    const double error = plan.found_error() + plan.error_bound.value_or(0);
    const auto& trial = plan.slab_trial;
    if (error > wanted) {
        const std::string why =
            plan.integrates_cells()
                ? fmt::format("exact segments in {} are off by up to {:.2g} / 255{}",
                              name_of(plan.target), error,
                              plan.segment_error > exact_segment_error
                                  ? ", in proportion to the brightest colour"
                                  : "")
            : plan.table.error > wanted
                ? fmt::format(
                      "the pre-integration table is off by up to {:.2g} / 255 "
                      "(render.slice.classification \"post\" does without)",
                      plan.table.error)
            : trial ? fmt::format(
                          "of the numbers of slabs that were tried, {} are taken, with an error "
                          "of {:.2g} / 255 (render.slice.samples sets another)",
                          plan.slabs, error)
                    : fmt::format("{} slabs composited in {} are off by up to {:.2g} / 255",
                                  plan.slabs, name_of(plan.target), error);
        request.message(fmt::format("render.max_error: {:.4g} is not kept: {}", wanted, why));
    } else if (trial && trial->doubtful) {
        request.message(
            fmt::format("render.max_error: {:.4g} is not sure to be kept: {} slabs are off by "
                        "{:.2g} / 255 on {} traced rays of {}, and others may be off by more",
                        wanted, plan.slabs, error, trial->traced, trial->rays));
    }
}

}  // namespace lamina
