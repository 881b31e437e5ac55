// SPDX-License-Identifier: Apache-2.0
#include "projection/gl_tet_leaves.h"

#include "executors/gl_compositing.h"
#include "projection/visible_parts.h"

namespace lamina {

GlTetLeaves::GlTetLeaves(const CompositingPlan& plan, GlTetStream& stream,
                         const TetGeometry& geometry, const DrawOrder<TetPart>& parts,
                         std::int64_t samples, const GlTetStream::Programs& programs)
    : plan_(plan),
      stream_(stream),
      geometry_(geometry),
      parts_(parts),
      samples_(samples),
      programs_(programs) {}

void GlTetLeaves::draw(const SampleSpan& span, const gl::Framebuffer& target, double depth_scale) {
    for (gl::Program* program : programs_)
        program->set("depth_scale", static_cast<float>(depth_scale));
    const CompositingState state(plan_, true, target);
    drawn_ += stream_.draw(geometry_, parts_of_leaf(parts_, span, samples_), target.height(),
                           programs_, [] {});
}

}  // namespace lamina
