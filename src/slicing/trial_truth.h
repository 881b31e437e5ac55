// SPDX-License-Identifier: Apache-2.0
// The reference tracer's colours of pixels that trial pictures are held against.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <vector>

#include "lamina/image.h"
#include "lamina/transfer_function.h"
#include "lamina/volume.h"
#include "reference/volume_tracer.h"
#include "scene/camera.h"

namespace lamina {

class TrialTruth {
  public:
    // `tolerance`: of the tracer, of full scale.
    TrialTruth(const Volume& volume, const TransferFunction& transfer_function, const View& view,
               double tolerance);

    void trace_all();
    // Traces at most `count` pixels of a picture that is too large for trace_all(): a quarter all
    // over the picture, one at a place of its own in each of equal cells; a quarter where `picture`
    // and `finer` differ most; a quarter where `cover` (slicing/point_cover.h; may be empty) says
    // that there are fewest, but some, points of the transfer function: what is rare both pictures
    // may miss; and the rest where a pixel of `finer` differs most from a neighbour: a ray that
    // grazes what its neighbours hit is at such an edge, and there segments miss most.
    void trace_some(std::size_t count, const Image& picture, const Image& finer,
                    const std::vector<float>& cover);

    bool empty() const { return pixels_.empty(); }
    std::int64_t rays() const { return static_cast<std::int64_t>(pixels_.size()); }
    // Largest error of a channel on the traced pixels, the tracer's own estimate included, in
    // 1/255.
    double error_of(const Image& picture) const;

  private:
    // Appends pixels that are not there yet: those of the largest values above 0.
    void append_unknown(std::size_t count, std::vector<float> values);
    void trace();

    const Volume& volume_;
    const TransferFunction& transfer_function_;
    View view_;
    TraceOptions options_;
    std::vector<glm::ivec2> pixels_;
    TracedPixels traced_;
};

}  // namespace lamina
