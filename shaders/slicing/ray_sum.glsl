// SPDX-License-Identifier: Apache-2.0
// The parts that a ray has passed, composited front to back: associated colour, optical depth and
// transmittance. SINGLE_COLOR: only the depth counts.
struct RaySum {
    vec3 color;
    float depth;
    float transmittance;
};

const RaySum empty_sum = RaySum(vec3(0.0), 0.0, 1.0);

// Puts what a ray passes next behind a sum.
void put_behind(RaySum next, inout RaySum sum) {
    sum.color += sum.transmittance * next.color;
    sum.depth += next.depth;
    sum.transmittance *= next.transmittance;
}
