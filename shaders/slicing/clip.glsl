// SPDX-License-Identifier: Apache-2.0
// The scene's clip planes, in the texture's index space: points with dot(plane.xyz, point) +
// plane.w >= 0 are kept.
uniform REAL4 clip_planes[CLIP_PLANES];

// Returns that part of the range `depths` in which the ray is on the kept side of all planes; y <=
// x if there is none.
REAL2 clip_to_planes(Ray ray, REAL2 depths) {
    for (int i = 0; i < CLIP_PLANES; ++i) {
        REAL distance = dot(clip_planes[i].xyz, ray.origin) + clip_planes[i].w;
        REAL slope = dot(clip_planes[i].xyz, ray.direction);
        if (abs(slope) < REAL(1e-20)) slope = REAL(1e-20);  // a ray that runs along a plane never crosses it
        REAL crossing = -distance / slope;
        if (slope > REAL(0.0)) depths.x = max(depths.x, crossing);
        else depths.y = min(depths.y, crossing);
    }
    return depths;
}
