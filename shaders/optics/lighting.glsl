// SPDX-License-Identifier: Apache-2.0
// Twin of RayLights (optics/ray_lights.h): what light does to a place with a gradient. All vectors have the same axes.
// LIGHTS: their number, up to 8. GRAY_LIGHT: all components of each colour are equal. HIGHLIGHTS: specular > 0.
#ifdef GRAY_LIGHT
#define LIGHT_COLOR float
#define COLOR_OF_LIGHT(i) light_colors[i].r
#else
#define LIGHT_COLOR vec3
#define COLOR_OF_LIGHT(i) light_colors[i].rgb
#endif

uniform vec3 light_terms;                // ambient - 1, diffuse, specular
uniform float half_power;                // of the square of a cosine
uniform vec4 light_directions[LIGHTS];   // unit vectors to the lights; w = 1: a headlight, whatever the vector
uniform vec4 light_colors[LIGHTS];

// To a colour c light adds c * change + highlight.
struct LightEffect {
    LIGHT_COLOR change, highlight;
};

void add_effect_of(int i, vec3 normal, vec3 to_eye, float along_eye, inout LightEffect effect) {
    vec3 to_light = light_directions[i].w > 0.0 ? to_eye : light_directions[i].xyz;
    float along_light = dot(normal, to_light);
    effect.change += light_terms.y * abs(along_light) * COLOR_OF_LIGHT(i);
#ifdef HIGHLIGHTS
    float both = along_light + along_eye;
    float sum = 2.0 + 2.0 * dot(to_light, to_eye);  // |l + v|^2; where it is 0 there is no highlight
    float halfway_square = min(both * both / max(sum, 1e-12), 1.0);
    float shine = sum > 1e-6 && halfway_square > 0.0 ? pow(halfway_square, half_power) : 0.0;
    effect.highlight += light_terms.z * shine * COLOR_OF_LIGHT(i);
#endif
}

// Returns what light does where the gradient is so, of a length whose square float32 holds. `smallest_square`: of the
// smallest gradient, in the same unit. `to_eye`: a unit vector. Lights are no loop, because software rasterisers have a
// limit for the rounds of all loops together (plan/march_limit.h).
LightEffect light_effect(vec3 gradient, float smallest_square, vec3 to_eye) {
    float square = dot(gradient, gradient);
    float weight = square / (square + smallest_square);
    vec3 normal = gradient / sqrt(max(square, 1e-37));
    float along_eye = dot(normal, to_eye);
    LightEffect effect = LightEffect(LIGHT_COLOR(light_terms.x), LIGHT_COLOR(0.0));
    add_effect_of(0, normal, to_eye, along_eye, effect);
#if LIGHTS > 1
    add_effect_of(1, normal, to_eye, along_eye, effect);
#endif
#if LIGHTS > 2
    add_effect_of(2, normal, to_eye, along_eye, effect);
#endif
#if LIGHTS > 3
    add_effect_of(3, normal, to_eye, along_eye, effect);
#endif
#if LIGHTS > 4
    add_effect_of(4, normal, to_eye, along_eye, effect);
#endif
#if LIGHTS > 5
    add_effect_of(5, normal, to_eye, along_eye, effect);
#endif
#if LIGHTS > 6
    add_effect_of(6, normal, to_eye, along_eye, effect);
#endif
#if LIGHTS > 7
    add_effect_of(7, normal, to_eye, along_eye, effect);
#endif
    return LightEffect(weight * effect.change, weight * effect.highlight);
}
