// SPDX-License-Identifier: Apache-2.0
#include "parallel/plan_digest.h"

#include <fmt/format.h>

#include "base/content_hash.h"

namespace lamina {
namespace {

void add(const IndexBox& box, std::string& text) {
    for (const glm::dvec3& corner : {box.min, box.max})
        text += fmt::format(" {:a} {:a} {:a}", corner.x, corner.y, corner.z);
}

}  // namespace

std::string digest_of(const SlicePlan& plan, const std::vector<IndexBox>& shares) {
    const TableRequest& table = plan.table.request;
    std::string text = fmt::format(
        "{} {} {} {} {} {} {} {:a} {} {} {:a} {:a} {:a} {:a} {} {}", plan.slabs,
        static_cast<int>(plan.classification), static_cast<int>(plan.sampling), plan.single_color,
        plan.nan_transparent, plan.linear, plan.nothing_visible, plan.unit, table.scalar_nodes,
        table.length_layers, table.max_length, plan.opaque_depth, plan.curve_error, plan.most_bend,
        plan.bricks.size(), plan.clip.size());
    add(plan.drawn, text);
    for (const IndexBox& share : shares) add(share, text);
    ContentHash hash;
    hash.add(text);
    return hash.hex();
}

}  // namespace lamina
