// SPDX-License-Identifier: Apache-2.0
#include "optics/opacity.glsl"
#include "optics/mean_extinction.glsl"

// A segment by one look-up in a table whose nodes lie on the transfer function's points
// (PreintegrationTable::lookup_once); with EXACT_OPACITY its opacity in closed form, and only its colour, if there is more
// than one, from the table (emission_ratio).
#ifdef TABLE_NODES
#include "optics/preintegration.glsl"
#endif
#ifndef TABLE_COLORED
uniform vec3 single_color;
#endif

// Associated colour and opacity of a segment on which the scalar, normalised to [0, 1], runs straight.
vec4 integrate_segment(float front, float back, float world_length) {
    ExtinctionRun run = find_run_of(front, back);
#ifdef PIECE_NODES
    vec2 nodes = min(front < back ? run.nodes : run.nodes.yx, float(TABLE_NODES - 1));
    vec4 entry = table_entry(nodes, world_length);
#endif
#ifdef EXACT_OPACITY
    float opacity = opacity_from_depth(run.mean * world_length);
#else
    float opacity = opacity_from_depth(entry.a * world_length);
#endif
#ifdef TABLE_COLORED
    return vec4(entry.rgb * (opacity / max(entry.a, 1e-37)), opacity);  // where nothing absorbs, nothing is emitted
#else
    return vec4(single_color * opacity, opacity);
#endif
}
