// Next to nothing a vertex: what is left is the cost of a triangle.
#version 450
#extension GL_GOOGLE_include_directive : require
#include "draw.glsl"

layout(location = 0) in vec3 position;

void main() { gl_Position = placed(position); }
