// SPDX-License-Identifier: Apache-2.0
// Cubics c.x + t (c.y + t (c.z + t c.w)) over 0 <= t <= 1. A trilinear field is one along every straight line inside a
// cell (docs/numerics.md, section 9).
float cubic_at(vec4 c, float t) { return c.x + t * (c.y + t * (c.z + t * c.w)); }

float cubic_slope(vec4 c, float t) { return c.y + t * (2.0 * c.z + t * (3.0 * c.w)); }

float cubic_mean(vec4 c) { return c.x + (1.0 / 2.0) * c.y + (1.0 / 3.0) * c.z + (1.0 / 4.0) * c.w; }

// Returns bounds on the cubic, low and high: those of its Bernstein coefficients.
vec2 cubic_range(vec4 c) {
    float one = c.x + (1.0 / 3.0) * c.y;
    float two = one + (1.0 / 3.0) * (c.y + c.z);
    float end = c.x + c.y + c.z + c.w;
    return vec2(min(min(c.x, one), min(two, end)), max(max(c.x, one), max(two, end)));
}

// Returns numerator / divisor if that lies between 0 and 1, else 1.
float place_or_end(float numerator, float divisor) {
    bool inside = numerator != 0.0 && (numerator > 0.0) == (divisor > 0.0) && abs(numerator) < abs(divisor);
    return inside ? numerator / divisor : 1.0;
}

// Returns the places, in order, between which the cubic is monotone; 1 for missing ones. The
// quotient form has no cancellation (Press et al., Numerical Recipes, 5.6).
vec2 cubic_turns(vec4 c) {
    float discriminant = c.z * c.z - 3.0 * c.w * c.y;
    if (discriminant <= 0.0) return vec2(1.0);
    float root = sqrt(discriminant);
    float q = c.z < 0.0 ? root - c.z : -(root + c.z);
    float one = place_or_end(q, 3.0 * c.w), other = place_or_end(c.y, q);
    return vec2(min(one, other), max(one, other));
}

// A bracket around the place at which a monotone cubic has a value, and the best place known.
struct RootBracket {
    float from, to, t;
};

// Moves to the place at which a parabola that touches the cubic has the value (Euler's method, of
// third order, also near places where the cubic turns), or to the middle of the bracket if that
// place lies outside.
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

// Returns the place at which a cubic, which is monotone from one place to another, has a value
// between its values there. Even t^3 = 1e-4 takes no more than six steps. They are not a loop,
// because software rasterisers have a limit for the rounds of all loops together
// (plan/choices.h).
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
