// SPDX-License-Identifier: Apache-2.0
#include "optics/intervals.glsl"
#include "optics/opacity.glsl"

// Integrates segments with a table whose nodes lie at the transfer function's points and between them: twin of
// KnotTable::lookup (preintegration/preintegration_table.h). The texel (front node, back node) has the mean extinction
// in its last component. With colour, it has emission in rgb, and each length is a layer.
#ifdef TABLE_COLORED
uniform sampler3D knot_table;
uniform float layers_per_length;
#else
uniform sampler2D knot_table;
#endif
// TABLE_LIT: a second table with front parts (optics/segment_integral.h), of emission in rgb and of extinction in a,
// for the same nodes and lengths.
#ifdef TABLE_LIT
uniform sampler3D front_parts;
#endif

// Returns the coordinate of a scalar in the table; nodes have whole numbers. `place`: interval_place() of the scalar's
// interval.
float table_node(vec4 place, float scalar) { return place.z + share_of_interval(place, scalar) * place.w; }

#ifdef TABLE_COLORED
#define TABLE_SAMPLER sampler3D
vec4 table_texel(TABLE_SAMPLER table, ivec2 node, int layer) { return texelFetch(table, ivec3(node, layer), 0); }
#else
#define TABLE_SAMPLER sampler2D
vec4 table_texel(TABLE_SAMPLER table, ivec2 node, int layer) { return texelFetch(table, node, 0).rrrr; }
#endif

// Interpolates bilinearly, in float32, between the four nodes around `nodes`.
vec4 table_layer(TABLE_SAMPLER table, vec2 nodes, int layer) {
    ivec2 corner = min(ivec2(nodes), ivec2(TABLE_NODES - 2));
    vec2 share = nodes - vec2(corner);
    vec4 front = table_texel(table, corner, layer);
    vec4 back = table_texel(table, corner + ivec2(0, 1), layer);
    front += share.x * (table_texel(table, corner + ivec2(1, 0), layer) - front);
    back += share.x * (table_texel(table, corner + ivec2(1, 1), layer) - back);
    return front + share.y * (back - front);
}

// Returns the mean extinction at table nodes. It does not depend on length.
float table_extinction(vec2 nodes) {
#if defined(TABLE_FILTERED) && defined(TABLE_COLORED)
    return texture(knot_table, vec3((nodes + 0.5) / float(TABLE_NODES), 0.0)).a;
#elif defined(TABLE_FILTERED)
    return texture(knot_table, (nodes + 0.5) / float(TABLE_NODES)).r;
#else
    return table_layer(knot_table, nodes, 0).a;
#endif
}

#ifdef TABLE_COLORED
// Interpolates in a table between nodes and between lengths.
vec4 table_numbers(sampler3D table, vec2 nodes, float world_length) {
    float layer = min(world_length * layers_per_length, float(TABLE_LAYERS - 1));
#ifdef TABLE_FILTERED
    return texture(table, vec3((nodes + 0.5) / float(TABLE_NODES), (layer + 0.5) / float(TABLE_LAYERS)));
#elif TABLE_LAYERS == 1
    return table_layer(table, nodes, 0);
#else
    int below = min(int(layer), TABLE_LAYERS - 2);
    vec4 entry = table_layer(table, nodes, below);
    return entry + (layer - float(below)) * (table_layer(table, nodes, below + 1) - entry);
#endif
}
#endif

// Returns emission (rgb, with a coloured table) and mean extinction (a) at table nodes.
vec4 table_entry(vec2 nodes, float world_length) {
#ifdef TABLE_COLORED
    return table_numbers(knot_table, nodes, world_length);
#else
    return vec4(table_extinction(nodes));
#endif
}

// The sum over a segment from the front on: associated colour, and optical depth in a. For lit ones also the front
// parts of colour and opacity, and the share of the segment's length that is not added yet.
struct RunSum {
    vec4 whole;
#ifdef TABLE_LIT
    vec4 front;
    float behind;
#endif
};

// Adds a piece of the segment, between two table nodes, behind `sum`. `share`: its share of the segment's length.
void add_run(inout RunSum sum, vec2 nodes, float world_length, float share) {
    vec4 entry = table_entry(nodes, world_length);
    float depth = entry.a * world_length;
#ifdef TABLE_LIT
    sum.behind = max(sum.behind - share, 0.0);
#endif
#ifdef TABLE_COLORED
    if (depth > 0.0) {
        float weight = exp(-sum.whole.a) * opacity_from_depth(depth) / entry.a;
        sum.whole.rgb += weight * entry.rgb;
#ifdef TABLE_LIT
        sum.front += weight * (sum.behind * entry + share * table_numbers(front_parts, nodes, world_length));
#endif
    }
#endif
    sum.whole.a += depth;
}

// Returns whether a segment on which the scalar stays between two values is transparent.
bool is_transparent(float least, float largest) {
    vec2 nodes = vec2(table_node(interval_place(find_interval(least)), least),
                      table_node(interval_place(find_interval(largest)), largest));
    return table_extinction(nodes) == 0.0;
}

// Returns the associated colour and the optical depth of a segment on which the scalar is linear from `front` to
// `back`. The table is smooth inside the transfer function's intervals and has kinks at their ends, so the segment is
// cut into up to three pieces at the first and the last interval end that it crosses. They are added in a loop, which a
// transparent segment never enters, because software rasterisers skip loops but not branches.
RunSum integrate_run(float front, float back, float world_length, bool transparent) {
    int front_interval = find_interval(front);
    int back_interval = find_interval(back);
    vec4 front_place = interval_place(front_interval);
    vec4 back_place = interval_place(back_interval);
    vec2 nodes = vec2(table_node(front_place, front), table_node(back_place, back));
    float run_length = world_length;
    int runs = transparent ? 0 : 1;

    vec2 inner_nodes, back_nodes;
    float inner_length, back_length;
    if (front_interval != back_interval && !transparent) {
        runs = 3;
        bool rising = front < back;
        vec4 first = interval_place(rising ? front_interval + 1 : front_interval);
        vec4 last = interval_place(rising ? back_interval : back_interval + 1);
        float back_end = rising ? back_place.z : back_place.z + back_place.w;
        float length_per_scalar = world_length / (back - front);
        back_nodes = vec2(back_end, nodes.y);
        back_length = (back - last.x) * length_per_scalar;
        inner_nodes = vec2(first.z, back_end);
        inner_length = (last.x - first.x) * length_per_scalar;
        nodes.y = rising ? front_place.z + front_place.w : front_place.z;
        run_length = (first.x - front) * length_per_scalar;
    }
    RunSum sum;
    sum.whole = vec4(0.0);
#ifdef TABLE_LIT
    sum.front = vec4(0.0);
    sum.behind = 1.0;
#endif
    for (int run = 0; run < runs; ++run) {
        add_run(sum, nodes, run_length, run_length / world_length);
        nodes = run == 0 ? inner_nodes : back_nodes;
        run_length = run == 0 ? inner_length : back_length;
    }
    return sum;
}
