// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <vector>

#include "lamina/image.h"
#include "lamina/transfer_function.h"
#include "lamina/volume.h"
#include "reference/tracer.h"
#include "scene/camera.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// Counts for each pixel the min/max bricks that its ray may cross and in which the scalar passes a
// point of the transfer function: features narrower than a slab lie in these. A brick counts in the
// whole rectangle around it. If bricks are very many, only one in a few is counted.
std::vector<float> cover_of_points(const MinMaxBricks& bricks, const Grid& grid,
                                   const TransferFunction& transfer_function, const View& view);

// The reference tracer's colours of some pixels, with which trial pictures are compared.
class TrialTruth {
  public:
    TrialTruth(const Volume& volume, const TransferFunction& transfer_function, const View& view,
               TraceOptions options);

    void trace_all();
    // Traces at most `count` pixels of a picture that is too large for trace_all(). One quarter is
    // spread over equal squares; one has the largest differences between `picture` and `finer`; one
    // has the smallest counts of `cover` (cover_of_points(), or empty) above zero, as both pictures
    // may miss what is rare. The rest has the largest contrasts between neighbours in `finer`:
    // there a ray grazes what its neighbour hits, and slabs miss most.
    void trace_some(std::size_t count, const Image& picture, const Image& finer,
                    const std::vector<float>& cover);

    bool empty() const { return pixels_.empty(); }
    std::int64_t rays() const { return static_cast<std::int64_t>(pixels_.size()); }
    // Returns the max error on traced pixels plus the tracer's error estimate, in units of 1/255.
    double error_of(const Image& picture) const;

  private:
    // Appends the `count` pixels with the largest values that are above 0 and not in pixels_ yet.
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
