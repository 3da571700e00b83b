// Counts its invocations and, where WARPS is defined, the groups that they run in.
#version 450
#extension GL_GOOGLE_include_directive : require
#ifdef WARPS
#extension GL_KHR_shader_subgroup_basic : require
#endif
#include "draw.glsl"

layout(set = 0, binding = 0) buffer Counters { uint invocations; uint warps; };

void main() {
    atomicAdd(invocations, 1);
#ifdef WARPS
    if (subgroupElect()) atomicAdd(warps, 1);
#endif
    gl_Position = placed(vec3(0.0));
}
