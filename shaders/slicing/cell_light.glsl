// SPDX-License-Identifier: Apache-2.0
// Adds light to parts of rays in one cell (docs/numerics.md, section 10). The engine `cpu` does
// this in slicing/cpu_light-inl.h. The bend of light along a part is its second difference over the
// three nodes of Gauss' rule; it estimates the rule's error.
#include "optics/cell_optics.glsl"
#include "optics/lighting.glsl"
#include "slicing/cell_gradient.glsl"

uniform float most_bend;  // a part is cut if light bends more along it

// Length, as a share of the part, below which a piece is not cut further
// (plan/classification_choice.cpp counts the iterations that this allows).
const float shortest_lit_piece = 1.0 / 256.0;
// A piece whose light bends more than most_bend is still not cut if its bend times its visible
// opacity is at most this share of most_bend. The engine `cpu` uses twice the share
// (faint_share_of_cells in executors/lights.h): here the number of iterations is bounded anyway,
// and pieces grow more slowly.
const float faint_share = 1.0 / 4.0;

float length_square(vec3 v) { return dot(v, v); }

// Returns a bound, expressed as a bend, on highlights and changes of light that lie between the
// nodes of Gauss' rule. The piece begins at t = `at` and is `extent` long.
float hidden_bend(CellGradient gradient, float at, float extent) {
    float reach = 0.5 * extent, middle = at + reach;
    vec3 c2 = vec3(gradient.x.z, gradient.y.z, gradient.z.z), c3 = vec3(gradient.x.w, gradient.y.w, gradient.z.w);
    vec3 slope = vec3(cubic_slope(gradient.x, middle), cubic_slope(gradient.y, middle), cubic_slope(gradient.z, middle));
    vec3 most = reach * (abs(slope) + reach * (abs(c2 + 3.0 * c3 * middle) + reach * abs(c3)));
    float square = length_square(gradient_along(gradient, middle)), way = length_square(most);
    return hidden_effect(square, way, gradient.smallest_square);
}

// Returns what light i contributes at the piece's front and back to hidden_kinks(): the scalar
// product of gradient and light there, times its colour, if a kink lies between that end and the
// middle; else 0.
vec2 beyond_kink(int i, vec3 front, vec3 middle, vec3 back, vec3 to_eye) {
    vec3 to_light = direction_to_light(i, to_eye);
    vec3 color = light_colors[i].rgb;
    vec2 ends = vec2(dot(front, to_light), dot(back, to_light));
    float largest = max(color.r, max(color.g, color.b));
    return largest * abs(ends) * vec2(lessThan(ends * dot(middle, to_light), vec2(0.0)));
}

// Returns a bound on the error of the rule with three nodes at kinks, expressed as a bend. Light
// has a kink where the gradient is perpendicular to a light. A kink in the middle of a piece costs
// .045 of the bend. A kink at k <= .5 of the piece's length from an end costs at most .113 of the
// cosine at that end: k of it if k < .113, because no node lies there, and less if k is larger.
float hidden_kinks(CellGradient gradient, vec3 to_eye, float at, float extent) {
    vec3 front = gradient_along(gradient, at), back = gradient_along(gradient, at + extent);
    vec3 middle = gradient_along(gradient, at + 0.5 * extent);
    vec2 beyond = vec2(0.0);
#define ADD_BEYOND(i) beyond += beyond_kink(i, front, middle, back, to_eye);
    FOR_EACH_LIGHT(ADD_BEYOND)
#undef ADD_BEYOND
    vec2 squares = vec2(length_square(front), length_square(back));
    vec2 seen = beyond * squares / (squares + gradient.smallest_square) / sqrt(max(squares, 1e-37));
    return 0.113 / 0.045 * light_terms.y * max(seen.x, seen.y);
}

// Sums over the nodes of a piece. `change` multiplies the colour at the interval's left end, and
// `shared_change` the interval's change of colour. `highlight` is added.
struct LightSum {
    LIGHT_COLOR change, shared_change, highlight, bend;
};

void add_node(LightEffect effect, float amount, float share, float bend, inout LightSum sum) {
    sum.change += amount * effect.change;
    sum.shared_change += amount * share * effect.change;
    sum.highlight += amount * effect.highlight;
    sum.bend += bend * (effect.change + effect.highlight);
}

float largest_component(vec3 v) { return max(v.x, max(v.y, v.z)); }
float largest_component(float v) { return v; }

// Adds light to a part's associated colour by Gauss' rule with three nodes, whose weights add up to
// the part's opacity. `part` begins at t = `at` and is `extent` long, where t is the parameter of
// `gradient`. Returns the bend of light, or the bound on what the nodes may miss if that is larger.
float add_light(CellGradient gradient, vec3 to_eye, Interval interval, LinearPart part, float at, float extent,
                float depth, float opacity, inout vec3 color) {
    const vec3 nodes = vec3(0.112701665, 0.5, 0.887298335);
    const vec3 weights = vec3(5.0, 8.0, 5.0) / 18.0;
    vec4 share = part.share;
    vec3 there = share.x + nodes * (share.y + nodes * (share.z + nodes * share.w));
    float d0 = part.extinction + part.change * share.x;
    vec3 d = part.change * (share.yzw * vec3(1.0 / 2.0, 1.0 / 3.0, 1.0 / 4.0));
    vec3 before = nodes * (d0 + nodes * (d.x + nodes * (d.y + nodes * d.z)));
    vec3 extinction = max(part.extinction + part.change * there, 0.0);
    vec3 amount = weights * extinction * (1.0 - shallow_opacity(vec4(before, 0.0)).xyz);
    if (depth > largest_part_depth) amount = vec3(1.0, 0.0, 0.0);
    LightSum sum = LightSum(LIGHT_COLOR(0.0), LIGHT_COLOR(0.0), LIGHT_COLOR(0.0), LIGHT_COLOR(0.0));
    vec3 places = at + extent * nodes;
    float smallest = gradient.smallest_square;
    add_node(light_effect(gradient_along(gradient, places.x), smallest, to_eye), amount.x, there.x, 1.0, sum);
    add_node(light_effect(gradient_along(gradient, places.y), smallest, to_eye), amount.y, there.y, -2.0, sum);
    add_node(light_effect(gradient_along(gradient, places.z), smallest, to_eye), amount.z, there.z, 1.0, sum);
    float scale = opacity / (amount.x + amount.y + amount.z + 1e-37);
    color += scale * (interval.left.rgb * sum.change + interval.change.rgb * sum.shared_change + sum.highlight);
    color = max(color, 0.0);
    return max(largest_component(abs(sum.bend)),
               max(hidden_bend(gradient, at, extent), hidden_kinks(gradient, to_eye, at, extent)));
}

// Tells whether a part's light bends too much for one rule. `seen`: the visible share of the part's
// opacity.
bool bends(float bend, float seen) {
    float largest_effect = hidden_limits.x + hidden_limits.z;
    return bend > most_bend && bend * seen * max(largest_effect, 1.0) > faint_share * most_bend;
}

// Returns the length of the first piece of a part, 1 / 8 to 1 of the part. It falls with the root
// of the bend, because the error at a kink falls with the square of the length.
float longest_piece(float bend) { return clamp(sqrt(most_bend / max(bend, 1e-30)), 1.0 / 8.0, 1.0); }
