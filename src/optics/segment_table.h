// SPDX-License-Identifier: Apache-2.0
// Pre-integration tables over (scalar at the front, scalar at the back, length) with equally spaced
// scalars, in all variants that Kraus, Qiao, Ebert 2004, section 3, and docs/numerics.md, section
// 5, compare.
#pragma once

#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

#include "lamina/table_settings.h"
#include "lamina/transfer_function.h"
#include "optics/segment_integral.h"

namespace lamina {

struct SegmentTableRequest {
    double lo = 0, hi = 1;   // scalars, lo <= hi, finite
    double max_length = 1;   // longest segment in world units, finite, >= 0
    int scalar_nodes = 256;  // 2..4096, along both axes
    int length_layers = 16;  // 1..64
    LengthMapping mapping = LengthMapping::octave;
    TableStore store = TableStore::mean_extinction;
    TableFormat format = TableFormat::fixed16;
    TableConstruction construction = TableConstruction::exact;
    // False only where transfer_function.single_color(lo, hi); then texels have one channel.
    bool colored = true;

    friend bool operator==(const SegmentTableRequest&, const SegmentTableRequest&) = default;
};

struct SegmentTable {
    SegmentTableRequest request;
    int channels = 4;  // of a texel: 4 (rgb, then tbar or alpha) or 1 (tbar or alpha)
    // Number of layers that are stored: 1 for a mean extinction without colour, which does not
    // depend on length.
    int layers = 1;
    // Value = stored * scale; fixed formats store [0, 1], float16 stores values below 32768.
    float scale = 1;
    glm::dvec3 single_color{0};  // the colour where colored is false
    // What the texture holds, rounded to the format and not multiplied by `scale`. The index is
    // ((layer * nodes + back) * nodes + front) * channels + channel.
    std::vector<float> texels;
    double build_ms = 0;

    std::int64_t byte_count() const;    // size of the texture
    double length_of(int layer) const;  // world units
    // 1 / length_of(1), a uniform of the shader; 0 where there is none.
    double inverse_first_length() const;
    // The layer coordinate of a length: whole numbers are layers, 0..layers - 1. Lengths are
    // clamped to max_length.
    double layer_of(double length) const;
    // Computes what shaders do (optics/segment_table.glsl), but in double precision: trilinear
    // interpolation between texels. With TableStore::opacity, optical_depth is -log1p(-alpha),
    // which is +inf for alpha = 1.
    SegmentIntegral lookup(double front, double back, double length) const;
};

// Builds a table on all cores, with progress. Throws Error where the texels would exceed 1 GiB as
// floats. Extinctions beyond 1e30 over a length of max(1, max_length) are clamped to that: it is
// opaque, and its products stay finite in float32.
SegmentTable build_segment_table(const TransferFunction& transfer_function,
                                 const SegmentTableRequest& request);

}  // namespace lamina
