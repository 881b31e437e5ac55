// SPDX-License-Identifier: Apache-2.0
#version 450 core

#include "study/probe.glsl"
layout(location = 0) out vec4 result;

void main() { result = vec4(probe(ivec2(gl_FragCoord.xy))); }
