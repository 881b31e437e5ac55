// SPDX-License-Identifier: Apache-2.0
// Twin of RayLights (optics/ray_lights.h): the effect of light at a place with a gradient. All
// vectors have the same axes. LIGHTS: their number, up to 8. GRAY_LIGHT: all components of each
// colour are equal. HIGHLIGHTS: specular > 0.
#ifdef GRAY_LIGHT
#define LIGHT_COLOR float
#define COLOR_OF_LIGHT(i) light_colors[i].r
#else
#define LIGHT_COLOR vec3
#define COLOR_OF_LIGHT(i) light_colors[i].rgb
#endif

uniform vec3 light_terms;                // ambient - 1, diffuse, specular
uniform float half_power;                // of the square of a cosine
uniform vec4 light_directions[LIGHTS];   // unit vectors to the lights; w = 1: a headlight
uniform vec4 light_colors[LIGHTS];

// The effect of light: it adds c * change + highlight to a colour c.
struct LightEffect {
    LIGHT_COLOR change, highlight;
};

// Writes DO(number) for each light. Lights are no loop, because software rasterisers have a limit for the rounds of all
// loops together (plan/choices.h).
#if LIGHTS == 1
#define FOR_EACH_LIGHT(DO) DO(0)
#elif LIGHTS == 2
#define FOR_EACH_LIGHT(DO) DO(0) DO(1)
#elif LIGHTS == 3
#define FOR_EACH_LIGHT(DO) DO(0) DO(1) DO(2)
#elif LIGHTS == 4
#define FOR_EACH_LIGHT(DO) DO(0) DO(1) DO(2) DO(3)
#elif LIGHTS == 5
#define FOR_EACH_LIGHT(DO) DO(0) DO(1) DO(2) DO(3) DO(4)
#elif LIGHTS == 6
#define FOR_EACH_LIGHT(DO) DO(0) DO(1) DO(2) DO(3) DO(4) DO(5)
#elif LIGHTS == 7
#define FOR_EACH_LIGHT(DO) DO(0) DO(1) DO(2) DO(3) DO(4) DO(5) DO(6)
#else
#define FOR_EACH_LIGHT(DO) DO(0) DO(1) DO(2) DO(3) DO(4) DO(5) DO(6) DO(7)
#endif

vec3 direction_to_light(int i, vec3 to_eye) { return light_directions[i].w > 0.0 ? to_eye : light_directions[i].xyz; }

void add_effect_of(int i, vec3 normal, vec3 to_eye, float along_eye, inout LightEffect effect) {
    vec3 to_light = direction_to_light(i, to_eye);
    float along_light = dot(normal, to_light);
    effect.change += light_terms.y * abs(along_light) * COLOR_OF_LIGHT(i);
#ifdef HIGHLIGHTS
    float both = along_light + along_eye;
    float sum = 2.0 + 2.0 * dot(to_light, to_eye);  // |l + v|^2; if it is 0: no highlight
    float halfway_square = min(both * both / max(sum, 1e-12), 1.0);
    float shine = sum > 1e-6 && halfway_square > 0.0 ? pow(halfway_square, half_power) : 0.0;
    effect.highlight += light_terms.z * shine * COLOR_OF_LIGHT(i);
#endif
}

// Returns the effect of light on a place with this gradient, whose length has a square that float32
// holds. `smallest_square`: square of the smallest gradient, in the same unit. `to_eye`: a unit
// vector.
LightEffect light_effect(vec3 gradient, float smallest_square, vec3 to_eye) {
    float square = dot(gradient, gradient);
    float weight = square / (square + smallest_square);
    vec3 normal = gradient / sqrt(max(square, 1e-37));
    float along_eye = dot(normal, to_eye);
    LightEffect effect = LightEffect(LIGHT_COLOR(light_terms.x), LIGHT_COLOR(0.0));
#define ADD_EFFECT(i) add_effect_of(i, normal, to_eye, along_eye, effect);
    FOR_EACH_LIGHT(ADD_EFFECT)
#undef ADD_EFFECT
    return LightEffect(weight * effect.change, weight * effect.highlight);
}

// The cuts of light (executors/lights.h): x is the largest effect of highlights, and y the
// square of the distance that the gradient may go, as a share of its length in the middle of a
// piece, before highlights may hide; z and w are those of everything else.
uniform vec4 hidden_limits;

// Returns the effect that light may have between the nodes of a piece. The gradient has this square
// in the middle and differs from that by up to the root of `reach`. If it stays near, nothing is
// hidden. Otherwise a highlight may lie between the nodes; everything else changes without peaks,
// and its full effect is possible only if the gradient differs three times as much.
float hidden_effect(float square, float reach, float smallest_square) {
    float steepest = 2.0 * (square + reach);  // |a + b|^2 <= 2 |a|^2 + 2 |b|^2
    float weight = steepest / (steepest + smallest_square);
    float near = hidden_limits.w * square;
    float share = clamp((reach - near) / max(8.0 * near, 1e-37), 0.0, 1.0);
    return weight * (hidden_limits.z * share + (reach > hidden_limits.y * square ? hidden_limits.x : 0.0));
}
