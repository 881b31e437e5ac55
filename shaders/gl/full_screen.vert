// SPDX-License-Identifier: Apache-2.0
#version 450 core

// Draws one triangle that covers the viewport, made from gl_VertexID alone: (-1,-1), (3,-1), (-1,3).
void main() {
    vec2 position_ndc = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
    gl_Position = vec4(position_ndc, 0.0, 1.0);
}
