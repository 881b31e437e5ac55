// SPDX-License-Identifier: Apache-2.0
// The linear intervals of the transfer function over scalars normalised to [0, 1]. executors/transfer_tables.h
// describes the layout.
uniform sampler2D intervals;
uniform sampler2D interval_starts;

// Returns the interval that holds `scalar`. At the value of a step it is the upper one (lamina/transfer_function.h).
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

// Returns (left end, 1 / width, table node at the left end, table nodes to the right end).
vec4 interval_place(int interval) { return texelFetch(intervals, ivec2(interval, 0), 0); }

// Returns the position of a scalar in its interval, 0..1.
float share_of_interval(vec4 place, float scalar) { return clamp((scalar - place.x) * place.y, 0.0, 1.0); }
