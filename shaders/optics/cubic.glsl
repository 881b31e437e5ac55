// SPDX-License-Identifier: Apache-2.0
// Cubics c.x + t (c.y + t (c.z + t c.w)) over 0 <= t <= 1. Inside a cell, a trilinear field is such
// a cubic along every straight line (docs/numerics.md, section 9).
float cubic_at(vec4 c, float t) { return c.x + t * (c.y + t * (c.z + t * c.w)); }

// The scalar along a part of a ray inside one cell.
struct CellScalar {
    vec4 cubic;
#ifdef STEPS  // the transfer function has steps
    vec2 limits;  // the least and the largest scalar that the cell shows (slicing/cell_cubic.glsl)
#endif
};

float limited(CellScalar scalar, float value) {
#ifdef STEPS
    return clamp(value, scalar.limits.x, scalar.limits.y);
#else
    return value;
#endif
}

float scalar_at(CellScalar scalar, float t) { return limited(scalar, cubic_at(scalar.cubic, t)); }

float cubic_slope(vec4 c, float t) { return c.y + t * (2.0 * c.z + t * (3.0 * c.w)); }

float cubic_mean(vec4 c) { return c.x + (1.0 / 2.0) * c.y + (1.0 / 3.0) * c.z + (1.0 / 4.0) * c.w; }

// Returns a lower and an upper bound of the cubic: the extremes of its Bernstein coefficients.
vec2 cubic_range(vec4 c) {
    float one = c.x + (1.0 / 3.0) * c.y;
    float two = one + (1.0 / 3.0) * (c.y + c.z);
    float end = c.x + c.y + c.z + c.w;
    return vec2(min(min(c.x, one), min(two, end)), max(max(c.x, one), max(two, end)));
}

// Returns such bounds of a cell's scalar, between 0 and 1.
vec2 scalar_range(CellScalar scalar) {
    vec2 range = cubic_range(scalar.cubic);
    return clamp(vec2(limited(scalar, range.x), limited(scalar, range.y)), 0.0, 1.0);
}

// Returns numerator / divisor if the quotient lies between 0 and 1, else 1.
float place_or_end(float numerator, float divisor) {
    bool inside = numerator != 0.0 && (numerator > 0.0) == (divisor > 0.0) && abs(numerator) < abs(divisor);
    return inside ? numerator / divisor : 1.0;
}

// Returns the t in (0, 1) at which the cubic's slope changes sign, in ascending order; 1 for each
// that does not exist. The quotient form has no cancellation (Press et al., Numerical Recipes,
// 5.6).
vec2 cubic_turns(vec4 c) {
    float discriminant = c.z * c.z - 3.0 * c.w * c.y;
    if (discriminant <= 0.0) return vec2(1.0);
    float root = sqrt(discriminant);
    float q = c.z < 0.0 ? root - c.z : -(root + c.z);
    float one = place_or_end(q, 3.0 * c.w), other = place_or_end(c.y, q);
    return vec2(min(one, other), max(one, other));
}

// A bracket from..to around the t at which a monotone cubic has a wanted value, and the best t so
// far.
struct RootBracket {
    float from, to, t;
};

// Moves bracket.t to where a parabola that touches the cubic has the value (Euler's method, of
// third order, also near turns of the cubic), or to the bracket's middle if the parabola's root
// lies outside the bracket.
void approach_root(vec4 c, float value, bool rising, inout RootBracket bracket) {
    float rest = cubic_at(c, bracket.t) - value;
    if ((rest < 0.0) == rising) bracket.from = bracket.t;
    else bracket.to = bracket.t;
    float slope = cubic_slope(c, bracket.t), bend = c.z + 3.0 * c.w * bracket.t;
    float root = sqrt(max(slope * slope - 4.0 * rest * bend, 0.0));
    float divisor = rising ? slope + root : slope - root;
    float nearer = bracket.t - 2.0 * rest / divisor;
    bool inside = divisor != 0.0 && nearer >= bracket.from && nearer <= bracket.to;
    bracket.t = inside ? nearer : 0.5 * (bracket.from + bracket.to);
}

// Returns the t between places.x and places.y at which a cubic has `value`. The cubic is monotone
// between the two places and has the values values.x and values.y there. Even t^3 = 1e-4 takes no
// more than six steps. Seven steps are written out, because software rasterisers limit the
// iterations of all loops together (plan/choices.h).
float cubic_root(vec4 c, float value, vec2 places, vec2 values) {
    bool rising = values.y >= values.x;
    float share = clamp((value - values.x) / (values.y - values.x), 0.0, 1.0);
    RootBracket bracket = RootBracket(places.x, places.y, places.x + (places.y - places.x) * share);
    approach_root(c, value, rising, bracket);
    approach_root(c, value, rising, bracket);
    approach_root(c, value, rising, bracket);
    approach_root(c, value, rising, bracket);
    approach_root(c, value, rising, bracket);
    approach_root(c, value, rising, bracket);
    approach_root(c, value, rising, bracket);
    return bracket.t;
}
