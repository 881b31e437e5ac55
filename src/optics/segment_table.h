// SPDX-License-Identifier: Apache-2.0
// Pre-integration tables over (scalar at the front, scalar at the back, length) with equally spaced
// scalars, in every variant that Kraus, Qiao, Ebert 2004, section 3, and docs/numerics.md,
// section 5, compare.
#pragma once

#include <glm/vec3.hpp>

#include <cstdint>
#include <memory>
#include <vector>

#include "lamina/table_settings.h"
#include "lamina/transfer_function.h"
#include "optics/segment_integral.h"

namespace lamina {

struct SegmentTableRequest {
    double lo = 0, hi = 1;   // scalars, lo <= hi, finite
    double max_length = 1;   // of a segment, world units, finite, >= 0
    int scalar_nodes = 256;  // 2..4096, along both axes
    int length_layers = 16;  // 1..64
    LengthMapping mapping = LengthMapping::octave;
    TableStore store = TableStore::mean_extinction;
    TableFormat format = TableFormat::fixed16;
    TableConstruction construction = TableConstruction::exact;
    // false: only where transfer_function.single_color(lo, hi); then one channel
    bool colored = true;

    friend bool operator==(const SegmentTableRequest&, const SegmentTableRequest&) = default;
};

struct SegmentTable {
    SegmentTableRequest request;
    int channels = 4;  // of a texel: 4 (rgb, then tbar or alpha) or 1 (tbar or alpha)
    int layers = 1;    // of the texels: 1 for a mean extinction without colour, which has no length
    float scale = 1;   // value = stored * scale: fixed formats store [0, 1], float16 below 32768
    glm::dvec3 single_color{0};  // where not colored
    // What the texture holds, rounded to the format, before `scale`: index
    // ((layer * nodes + back) * nodes + front) * channels + channel.
    std::vector<float> texels;
    double build_ms = 0;

    std::int64_t byte_count() const;    // of the texture
    double length_of(int layer) const;  // world units
    // 1 / length_of(1), a uniform of the shader; 0 where there is none.
    double inverse_first_length() const;
    // The coordinate of a length: whole numbers are layers, 0..layers - 1; clamped to max_length.
    double layer_of(double length) const;
    // What shaders do (optics/segment_table.glsl), but in double precision: trilinear between
    // texels. With `opacity`, optical_depth is -log1p(-alpha), +inf for alpha = 1.
    SegmentIntegral lookup(double front, double back, double length) const;
};

// On all cores, with progress. Throws Error where the texels would exceed 1 GiB as floats.
// Extinctions beyond 1e30 over a length of max(1, max_length) are cut to that: opaque, and finite
// in float32 however they are multiplied.
SegmentTable build_segment_table(const TransferFunction& transfer_function,
                                 const SegmentTableRequest& request);
// The same, remembered by content, so that the next request of the same transfer function and
// numbers is free: the last 8 tables, as far as they take no more than 1 GiB. Safe from any thread.
std::shared_ptr<const SegmentTable> segment_table(const TransferFunction& transfer_function,
                                                  const SegmentTableRequest& request);

}  // namespace lamina
