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

#ifdef TABLE_COLORED
vec4 table_row(ivec3 texel, float share) {
    vec4 left = texelFetch(preintegration, texel, 0);
    return left + share * (texelFetch(preintegration, texel + ivec3(1, 0, 0), 0) - left);
}

vec4 table_layer(ivec2 node, int layer, vec2 share) {
    vec4 front = table_row(ivec3(node, layer), share.x);
    return front + share.y * (table_row(ivec3(node + ivec2(0, 1), layer), share.x) - front);
}
#endif

// Emission (rgb) and mean extinction (a) of the segment.
vec4 table_entry(float front, float back, float world_length) {
    vec2 node = vec2(table_node(front), table_node(back));
#ifdef TABLE_FILTERED
    vec2 texture_node = (node + 0.5) / float(TABLE_NODES);
#ifdef TABLE_COLORED
    float layer = (min(world_length * layers_per_length, float(TABLE_LAYERS - 1)) + 0.5) / float(TABLE_LAYERS);
    return texture(preintegration, vec3(texture_node, layer));
#else
    return vec4(texture(preintegration, texture_node).r);
#endif
#else
    ivec2 corner = min(ivec2(node), ivec2(TABLE_NODES - 2));
    vec2 share = node - vec2(corner);
#ifdef TABLE_COLORED
#if TABLE_LAYERS == 1
    return table_layer(corner, 0, share);
#else
    float layer = min(world_length * layers_per_length, float(TABLE_LAYERS - 1));
    int below = min(int(layer), TABLE_LAYERS - 2);
    vec4 entry = table_layer(corner, below, share);
    return entry + (layer - float(below)) * (table_layer(corner, below + 1, share) - entry);
#endif
#else
    vec4 texels = vec4(texelFetch(preintegration, corner, 0).r,
                       texelFetch(preintegration, corner + ivec2(1, 0), 0).r,
                       texelFetch(preintegration, corner + ivec2(0, 1), 0).r,
                       texelFetch(preintegration, corner + ivec2(1, 1), 0).r);
    vec2 columns = texels.xz + share.x * (texels.yw - texels.xz);
    return vec4(columns.x + share.y * (columns.y - columns.x));
#endif
#endif
}
