// Twelve values of four floats for the fragment shader.
#version 450
#extension GL_GOOGLE_include_directive : require
#include "draw.glsl"

layout(location = 0) in vec3 position;
layout(location = 0) out vec4 varyings[12];

void main() {
    gl_Position = placed(position);
    for (int i = 0; i < 12; i++) varyings[i] = gl_Position * float(i + 1);
}
