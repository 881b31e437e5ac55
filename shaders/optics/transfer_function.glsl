// SPDX-License-Identifier: Apache-2.0
#include "optics/intervals.glsl"

// Returns colour and extinction (a, per world unit) at a place of an interval, 0..1.
vec4 optics_at(int interval, float share) {
    vec4 left = texelFetch(intervals, ivec2(interval, 1), 0);
    vec4 right = texelFetch(intervals, ivec2(interval, 2), 0);
    return left + share * (right - left);
}

// Returns the extinction alone, in double precision.
double precise_extinction_at(int interval, float share) {
    vec2 low = texelFetch(intervals, ivec2(interval, 3), 0).rg;
    double left = double(texelFetch(intervals, ivec2(interval, 1), 0).a) + double(low.x);
    double right = double(texelFetch(intervals, ivec2(interval, 2), 0).a) + double(low.y);
    return left + double(share) * (right - left);
}
