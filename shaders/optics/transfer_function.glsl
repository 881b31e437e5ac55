// SPDX-License-Identifier: Apache-2.0
#include "optics/intervals.glsl"

// Returns colour (rgb) and extinction (a, per world unit) in an interval, at the position `share`:
// 0 at its left end, 1 at its right. Rows 1 and 2 of `intervals` hold both at the left and the
// right end.
vec4 optics_at(int interval, float share) {
    vec4 left = interval_texel(interval, 1);
    vec4 right = interval_texel(interval, 2);
    return left + share * (right - left);
}

// Returns the extinction at the same position in double precision. Row 3 of `intervals` holds, in r
// and g, what float32 lost of the extinctions at the left and the right end.
double precise_extinction_at(int interval, float share) {
    vec2 low = interval_texel(interval, 3).rg;
    double left = double(interval_texel(interval, 1).a) + double(low.x);
    double right = double(interval_texel(interval, 2).a) + double(low.y);
    return left + double(share) * (right - left);
}
