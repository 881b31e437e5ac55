// SPDX-License-Identifier: Apache-2.0
#include "optics/intervals.glsl"
#include "optics/opacity.glsl"

// Twin of PreintegrationTable::lookup_split (optics/preintegration_table.h). Texel (front node, back node): mean extinction in
// the last component; with colour, emission in rgb and one layer a length.
#ifdef TABLE_COLORED
uniform sampler3D preintegration;
uniform float layers_per_length;
#else
uniform sampler2D preintegration;
#endif

// Coordinate of a scalar in the table: whole numbers are nodes.
float table_node(vec4 place, float scalar) { return place.z + share_of_interval(place, scalar) * place.w; }

#ifdef TABLE_COLORED
vec4 table_texel(ivec2 node, int layer) { return texelFetch(preintegration, ivec3(node, layer), 0); }
#else
vec4 table_texel(ivec2 node, int layer) { return texelFetch(preintegration, node, 0).rrrr; }
#endif

// Bilinear in float32 between the four nodes around `nodes`.
vec4 table_layer(vec2 nodes, int layer) {
    ivec2 corner = min(ivec2(nodes), ivec2(TABLE_NODES - 2));
    vec2 share = nodes - vec2(corner);
    vec4 front = table_texel(corner, layer);
    vec4 back = table_texel(corner + ivec2(0, 1), layer);
    front += share.x * (table_texel(corner + ivec2(1, 0), layer) - front);
    back += share.x * (table_texel(corner + ivec2(1, 1), layer) - back);
    return front + share.y * (back - front);
}

// Mean extinction at table nodes; it does not depend on length.
float mean_extinction(vec2 nodes) {
#if defined(TABLE_FILTERED) && defined(TABLE_COLORED)
    return texture(preintegration, vec3((nodes + 0.5) / float(TABLE_NODES), 0.0)).a;
#elif defined(TABLE_FILTERED)
    return texture(preintegration, (nodes + 0.5) / float(TABLE_NODES)).r;
#else
    return table_layer(nodes, 0).a;
#endif
}

// Emission (rgb, with a coloured table) and mean extinction (a) at table nodes.
vec4 table_entry(vec2 nodes, float world_length) {
#ifndef TABLE_COLORED
    return vec4(mean_extinction(nodes));
#else
    float layer = min(world_length * layers_per_length, float(TABLE_LAYERS - 1));
#ifdef TABLE_FILTERED
    return texture(preintegration,
                   vec3((nodes + 0.5) / float(TABLE_NODES), (layer + 0.5) / float(TABLE_LAYERS)));
#elif TABLE_LAYERS == 1
    return table_layer(nodes, 0);
#else
    int below = min(int(layer), TABLE_LAYERS - 2);
    vec4 entry = table_layer(nodes, below);
    return entry + (layer - float(below)) * (table_layer(nodes, below + 1) - entry);
#endif
#endif
}

// Adds what lies behind `sum` (associated colour, optical depth in a): a run between two table nodes.
void add_run(inout vec4 sum, vec2 nodes, float world_length) {
    vec4 entry = table_entry(nodes, world_length);
    float depth = entry.a * world_length;
#ifdef TABLE_COLORED
    if (depth > 0.0) sum.rgb += exp(-sum.a) * opacity_from_depth(depth) / entry.a * entry.rgb;
#endif
    sum.a += depth;
}

// Associated colour and optical depth (a) of a segment on which the scalar runs straight from `front` to `back`. The
// table is smooth inside the transfer function's intervals and not across their ends: the run is cut at the first and
// at the last of these.
vec4 integrate_run(float front, float back, float world_length) {
    vec4 sum = vec4(0.0);
    int front_interval = find_interval(front);
    int back_interval = find_interval(back);
    vec4 front_place = interval_place(front_interval);
    vec4 back_place = interval_place(back_interval);
    float front_node = table_node(front_place, front);
    float back_node = table_node(back_place, back);
    if (front_interval == back_interval) {
        add_run(sum, vec2(front_node, back_node), world_length);
        return sum;
    }
    bool rising = front < back;
    vec4 first = rising ? interval_place(front_interval + 1) : front_place;
    vec4 last = rising ? back_place : interval_place(back_interval + 1);
    float front_end = rising ? front_place.z + front_place.w : front_place.z;
    float back_end = rising ? back_place.z : back_place.z + back_place.w;
    float length_per_scalar = world_length / (back - front);
    add_run(sum, vec2(front_node, front_end), (first.x - front) * length_per_scalar);
    if (first.x != last.x) add_run(sum, vec2(first.z, back_end), (last.x - first.x) * length_per_scalar);
    add_run(sum, vec2(back_end, back_node), (back - last.x) * length_per_scalar);
    return sum;
}

// Whether a segment on which the scalar stays between two values shows nothing.
bool is_transparent(float least, float largest) {
    vec2 nodes = vec2(table_node(interval_place(find_interval(least)), least),
                      table_node(interval_place(find_interval(largest)), largest));
    return mean_extinction(nodes) == 0.0;
}
