// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "executors/transfer_tables.h"
#include "lamina/transfer_function.h"
#include "plan/project_plan.h"
#include "projection/tile_fragments.h"

namespace lamina {

// The transfer function in the form that the fragments of tets read (projection/tet_color-inl.h).
class TileProjectTables {
  public:
    TileProjectTables(const TransferFunction& transfer_function, const ProjectPlan& plan);

    // Sets pointers to the tables. `fragments` must not outlive them.
    void set(TetFragments& fragments) const;
    double build_ms() const { return build_ms_; }
    std::int64_t byte_count() const;

  private:
    SegmentSource source_;
    glm::vec3 single_color_;
    glm::vec4 constant_optics_{0};
    const float* front_weights_ = nullptr;
    std::shared_ptr<const UniformTable> table_;
    std::optional<TileTransfer> transfer_;  // for SegmentSource::cut_table and ::analytic
    double build_ms_ = 0;
};

}  // namespace lamina
