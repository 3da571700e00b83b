// Sixteen loads from places that depend on the vertex alone.
#version 450
#extension GL_GOOGLE_include_directive : require
#include "draw.glsl"

layout(location = 0) in vec3 position;
// A power of two of words.
layout(set = 0, binding = 2) readonly buffer Table { uint words[]; };

void main() {
    uint last = uint(words.length()) - 1;
    uint place = uint(gl_VertexIndex) * 0x9e3779b9u;
    uint sum = 0;
    for (int i = 0; i < 16; i++) {
        // Steps of a linear congruential generator; its high bits are the random ones.
        place = place * 1664525u + 1013904223u;
        sum += words[(place ^ (place >> 15)) & last];
    }
    gl_Position = placed(position + 1e-30 * float(sum & 1u));
}
