#version 450 core
// SPDX-License-Identifier: Apache-2.0
// Composites one fragment of projected tetrahedra over the target: the colour and opacity of the pixel's ray inside a
// cell fragment. A cell fragment is a tet, or the region of one on which the transfer function is linear. FAN: it is
// drawn as the triangles of Kraus 2004 (fan.vert), otherwise as its silhouette (silhouette.vert). OPACITY_ONLY: draws
// opacity alone, for the leaves of a compositing tree.
#include "projection/sources.glsl"
#ifdef FAN
#include "projection/fan.glsl"
#else
#define SEEN flat in
#define WINDOW_PLACE gl_FragCoord.xy
#include "projection/silhouette.glsl"
#endif
#include "projection/tet_color.glsl"
#include "projection/output.glsl"

#ifdef OPACITY_ONLY
void main() { write_fragment(vec4(tet_color().a)); }
#else
void main() { write_fragment(tet_color()); }
#endif
