// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "executors/tree_leaves.h"
#include "gl/program.h"
#include "plan/compositing_plan.h"
#include "projection/gl_tet_stream.h"

namespace lamina {

// The tets of one frame, or their cell fragments, as the samples of a compositing tree.
class GlTetLeaves : public TreeLeaves {
  public:
    // `samples`: of the tree (parts_of_leaf). The programs must draw opacity alone (OPACITY_ONLY).
    // All arguments must outlive it.
    GlTetLeaves(const CompositingPlan& plan, GlTetStream& stream, const TetGeometry& geometry,
                const DrawOrder<TetPart>& parts, std::int64_t samples,
                const GlTetStream::Programs& programs);

    void draw(const SampleSpan& span, const gl::Framebuffer& target, double depth_scale) override;
    std::int64_t drawn() const { return drawn_; }

  private:
    const CompositingPlan& plan_;
    GlTetStream& stream_;
    const TetGeometry& geometry_;
    DrawOrder<TetPart> parts_;
    std::int64_t samples_;
    const GlTetStream::Programs& programs_;
    std::int64_t drawn_ = 0;
};

}  // namespace lamina
