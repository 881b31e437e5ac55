// SPDX-License-Identifier: Apache-2.0
// The intervals on which the transfer function is linear, over scalars normalised to [0, 1].
// ShaderIntervals in executors/transfer_tables.h describes both textures: `interval_starts` holds,
// for each of 1024 equal parts of [0, 1], the interval in which the part begins.
uniform sampler2D intervals;
uniform sampler2D interval_starts;

// Returns the number of the interval that holds `scalar`: at a step of the transfer function, the
// interval above the step (lamina/transfer_function.h).
int find_interval(float scalar) {
#if INTERVALS == 1
    return 0;
#else
    int cell = min(int(scalar * 1024.0), 1023);
    int i = int(texelFetch(interval_starts, ivec2(cell, 0), 0).r);
    while (i + 1 < INTERVALS && scalar >= texelFetch(intervals, ivec2(i + 1, 0), 0).x) ++i;
    return i;
#endif
}

// Returns row 0: (left end, 1 / width, pre-integration table node at the left end, number of table
// nodes from there to the right end).
vec4 interval_place(int interval) { return texelFetch(intervals, ivec2(interval, 0), 0); }

// Returns the position of a scalar in its interval: 0 at the left end, 1 at the right, clamped.
// `place` comes from interval_place().
float share_of_interval(vec4 place, float scalar) { return clamp((scalar - place.x) * place.y, 0.0, 1.0); }
