#include "optics/intervals.glsl"
#include "optics/opacity.glsl"

// Twin of PreintegrationTable::lookup (optics/preintegration_table.h). Texel (front node, back node): mean extinction in
// the last component; with colour, emission in rgb and one layer a length.
#ifdef TABLE_COLORED
uniform sampler3D preintegration;
uniform float layers_per_length;
#else
uniform sampler2D preintegration;
#endif

float table_node(float scalar) {
    vec3 place = place_in_interval(find_interval(scalar), scalar);
    return place.y + place.x * place.z;
}

vec2 table_nodes(float front, float back) { return vec2(table_node(front), table_node(back)); }

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
