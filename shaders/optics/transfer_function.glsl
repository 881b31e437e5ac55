// SPDX-License-Identifier: Apache-2.0
#include "optics/intervals.glsl"

// Colour and extinction (a, per world unit) at a scalar.
vec4 classify(float scalar) {
    int interval = find_interval(scalar);
    float share = share_of_interval(interval_place(interval), scalar);
    vec4 left = texelFetch(intervals, ivec2(interval, 1), 0);
    vec4 right = texelFetch(intervals, ivec2(interval, 2), 0);
    return left + share * (right - left);
}
