// SPDX-License-Identifier: Apache-2.0
#include "projection/tile_project_tables.h"

#include <algorithm>

#include "base/profile.h"
#include "executors/transfer_tables.h"
#include "optics/pieces.h"
#include "optics/segment_integral.h"

namespace lamina {

TileProjectTables::TileProjectTables(const TransferFunction& transfer_function,
                                     const ProjectPlan& plan)
    : source_(plan.source),
      single_color_(first_color(transfer_function, plan.range.lo, plan.range.hi)) {
    Stage stage("tables");
    switch (plan.source) {
        case SegmentSource::constant: {
            const OpticalProperties constant = transfer_function.at(plan.range.lo);
            constant_optics_ =
                glm::vec4(constant.color, std::min(constant.extinction, max_shader_extinction));
            break;
        }
        case SegmentSource::table:
            table_ = plan.table.uniform_table();
            break;
        case SegmentSource::parts:
            if (!plan.single_color) front_weights_ = FrontWeightTable::get().texels().data();
            break;
        case SegmentSource::cut_table:
            transfer_.emplace(transfer_function, plan.range, plan.table.knot_table(), 0);
            break;
        case SegmentSource::analytic:
            transfer_.emplace(transfer_function, plan.range, nullptr, 0);
            break;
        case SegmentSource::mean:
        case SegmentSource::vertices:
            break;
    }
    build_ms_ = stage.end();
}

void TileProjectTables::set(TetFragments& fragments) const {
    fragments.source = source_;
    fragments.single_color = single_color_;
    fragments.constant_optics = constant_optics_;
    fragments.front_weights = front_weights_;
    fragments.table = table_.get();
    if (table_) fragments.inverse_first_length = static_cast<float>(table_->inverse_first_length());
    fragments.transfer = transfer_ ? &*transfer_ : nullptr;
}

std::int64_t TileProjectTables::byte_count() const {
    return (table_ ? table_->byte_count() : 0) + (transfer_ ? transfer_->byte_count() : 0);
}

}  // namespace lamina
