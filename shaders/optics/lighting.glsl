// SPDX-License-Identifier: Apache-2.0
// Twin of RayLights (optics/ray_lights.h): the effect of lights on the colour at a place with a
// given gradient. All vectors are in the same coordinates. The includer defines LIGHTS: the number
// of lights, up to 8; GRAY_LIGHT: if in each light's colour r, g and b are equal; HIGHLIGHTS: if
// specular > 0.
#ifdef GRAY_LIGHT
#define LIGHT_COLOR float
#define COLOR_OF_LIGHT(i) light_colors[i].r
#else
#define LIGHT_COLOR vec3
#define COLOR_OF_LIGHT(i) light_colors[i].rgb
#endif

uniform vec3 light_terms;                // ambient - 1, diffuse, specular
uniform float half_power;                // half the specular power: exponent of the cosine's square
uniform vec4 light_directions[LIGHTS];   // unit vectors to the lights; w = 1: a headlight
uniform vec4 light_colors[LIGHTS];

// The effect of light: a colour c becomes c + c * change + highlight.
struct LightEffect {
    LIGHT_COLOR change, highlight;
};

// Expands to DO(0) DO(1) ... for all lights. This is no loop, because software rasterisers limit
// the iterations of all loops together (plan/choices.h).
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
    float sum = 2.0 + 2.0 * dot(to_light, to_eye);  // |to_light + to_eye|^2; 0 if they are opposite: no highlight
    float halfway_square = min(both * both / max(sum, 1e-12), 1.0);
    float shine = sum > 1e-6 && halfway_square > 0.0 ? pow(halfway_square, half_power) : 0.0;
    effect.highlight += light_terms.z * shine * COLOR_OF_LIGHT(i);
#endif
}

// Returns the effect of light at a place with this gradient, whose squared length must fit into
// float32. `smallest_square`: the square of Lighting::smallest_gradient, in the same unit.
// `to_eye`: a unit vector.
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

// LightCuts (executors/lights.h): x is the largest effect of highlights. If the gradient in a piece
// differs from that in the piece's middle by more than sqrt(y) times its length, the quadrature
// nodes may miss a highlight. z and w are the same two numbers for diffuse and ambient light.
uniform vec4 hidden_limits;

// Returns a bound on the effect of light that the quadrature nodes of a piece may miss. `square`:
// the gradient's squared length in the piece's middle. `reach`: the square of its largest
// difference from the gradient there. Nothing is missed if the difference is below the limits of
// hidden_limits. Above them a highlight may lie between nodes; diffuse and ambient light have no
// peaks, and are missed fully only if the gradient differs by three times the limit.
float hidden_effect(float square, float reach, float smallest_square) {
    float steepest = 2.0 * (square + reach);  // |a + b|^2 <= 2 |a|^2 + 2 |b|^2
    float weight = steepest / (steepest + smallest_square);
    float near = hidden_limits.w * square;
    float share = clamp((reach - near) / max(8.0 * near, 1e-37), 0.0, 1.0);
    return weight * (hidden_limits.z * share + (reach > hidden_limits.y * square ? hidden_limits.x : 0.0));
}
