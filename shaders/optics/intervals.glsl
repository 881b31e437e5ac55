// SPDX-License-Identifier: Apache-2.0
// The intervals on which the transfer function is linear, over scalars normalised to [0, 1].
// ShaderIntervals in executors/transfer_tables.h describes both textures: `interval_starts` holds,
// for each of 1024 equal parts of [0, 1], the interval in which the part begins. TABLE_BLOCKS: both are in a storage
// block, in which the four texels of an interval lie side by side.
#ifdef TABLE_BLOCKS
layout(std430, binding = 4) readonly buffer Intervals {
    float interval_starts[1024];
    vec4 interval_texels[];
};

vec4 interval_texel(int interval, int row) { return interval_texels[4 * interval + row]; }
int interval_at_start(int part) { return int(interval_starts[part]); }
#else
uniform sampler2D intervals;
uniform sampler2D interval_starts;

// Returns a texel of an interval. Many intervals, of labels, continue in the next rows.
vec4 interval_texel(int interval, int row) {
#if INTERVALS > 4096
    return texelFetch(intervals, ivec2(interval & 4095, 4 * (interval >> 12) + row), 0);
#else
    return texelFetch(intervals, ivec2(interval, row), 0);
#endif
}

int interval_at_start(int part) { return int(texelFetch(interval_starts, ivec2(part, 0), 0).r); }
#endif

// Returns the number of the interval that holds `scalar`: at a step of the transfer function, the
// interval above the step (lamina/transfer_function.h).
int find_interval(float scalar) {
#if INTERVALS == 1
    return 0;
#else
    int i = interval_at_start(min(int(scalar * 1024.0), 1023));
    while (i + 1 < INTERVALS && scalar >= interval_texel(i + 1, 0).x) ++i;
    return i;
#endif
}

// Returns row 0: (left end, 1 / width, pre-integration table node at the left end, number of table
// nodes from there to the right end).
vec4 interval_place(int interval) { return interval_texel(interval, 0); }

// Returns the position of a scalar in its interval: 0 at the left end, 1 at the right, clamped.
// `place` comes from interval_place().
float share_of_interval(vec4 place, float scalar) { return clamp((scalar - place.x) * place.y, 0.0, 1.0); }
