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

// One interval of the transfer function. Colour and extinction are linear in the share: the
// position in the interval, 0 at its left end and 1 at its right.
struct Interval {
    float left_end, right_end;  // right_end of the last interval exceeds all scalars
    float inverse_width;
    float shown_beyond;         // extinction is 0 from left_end up to this scalar
    vec4 left, change;          // colour (rgb) and extinction (a) at the left end, and from there to the right
};

Interval interval_at(int number) {
    vec4 place = interval_place(number);
    vec4 left = texelFetch(intervals, ivec2(number, 1), 0);
    vec4 right = texelFetch(intervals, ivec2(number, 2), 0);
    vec2 ends = texelFetch(intervals, ivec2(number, 3), 0).ba;
    return Interval(place.x, ends.y, place.y, ends.x, left, right - left);
}
