// SPDX-License-Identifier: Apache-2.0
// The reference for every picture of a volume: the viewing rays through the exact trilinear field,
// in double precision.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "lamina/image.h"
#include "lamina/transfer_function.h"
#include "lamina/volume.h"
#include "reference/tiles.h"
#include "scene/camera.h"

namespace lamina {

struct TraceResult {
    PreciseImage image;  // associated RGBA in linear light, before any background
    // The largest error over all pixels and channels, as a share of full scale, without rounding
    // (some 1e-14).
    double error_estimate = 0;
    // Number of pieces of rays with extinction that were integrated, each inside one cell and one
    // interval of the transfer function.
    std::int64_t segments = 0;
};

// Traces a volume. Cells with a NaN or infinite corner are transparent. It uses all cores; the
// result does not depend on their number. Throws Error for options out of range.
TraceResult trace_volume(const Volume& volume, const TransferFunction& transfer_function,
                         const View& view, const TraceOptions& options,
                         const TileDone& tile_done = {});

// Some pixels of the view, given as (column, row), traced as in a whole picture.
struct TracedPixels {
    std::vector<glm::dvec4> rgba;  // as in TraceResult::image, in the order of the pixels
    double error_estimate = 0;     // as in TraceResult
};
TracedPixels trace_pixels(const Volume& volume, const TransferFunction& transfer_function,
                          const View& view, std::span<const glm::ivec2> pixels,
                          const TraceOptions& options);

}  // namespace lamina
