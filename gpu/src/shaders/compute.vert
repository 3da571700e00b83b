// 3,200 floating-point operations: 400 times a multiplication and an addition of four floats.
#version 450
#extension GL_GOOGLE_include_directive : require
#include "draw.glsl"

layout(location = 0) in vec3 position;

void main() {
    vec4 value = vec4(position, 1.0);
    // Not known before the draw, so that the loop is not computed beforehand.
    vec4 factor = draw.place.wwww + 0.5;
    for (int i = 0; i < 400; i++) value = fma(value, factor, position.xyzx);
    // Too little to move a vertex, but the compiler does not know.
    gl_Position = placed(position + 1e-30 * clamp(value.xyz + value.w, -1.0, 1.0));
}
