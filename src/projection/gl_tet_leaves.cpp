// SPDX-License-Identifier: Apache-2.0
#include "projection/gl_tet_leaves.h"

#include "executors/gl_compositing.h"

namespace lamina {

GlTetLeaves::GlTetLeaves(const CompositingPlan& plan, GlTetStream& stream,
                         const TetGeometry& geometry, std::span<const TetPart> parts,
                         const GlTetStream::Programs& programs)
    : plan_(plan), stream_(stream), geometry_(geometry), parts_(parts), programs_(programs) {}

void GlTetLeaves::draw(const SampleSpan& span, const gl::Framebuffer& target, double depth_scale) {
    for (gl::Program* program : programs_)
        program->set("depth_scale", static_cast<float>(depth_scale));
    const CompositingState state(plan_, true, target);
    const auto all = static_cast<int>(parts_.size());
    const auto leaf = parts_.subspan(static_cast<std::size_t>(all - span.end()),
                                     static_cast<std::size_t>(span.count));
    drawn_ += stream_.draw(geometry_, leaf, programs_, [] {});
}

}  // namespace lamina
