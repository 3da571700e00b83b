// Writes down which vertex ran, and where WARPS is defined, in which lane of which group.
#version 450
#extension GL_GOOGLE_include_directive : require
#ifdef WARPS
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_ballot : require
#endif
#include "draw.glsl"

layout(set = 0, binding = 0) buffer Counters { uint invocations; uint warps; };
// Three words an invocation: vertex, warp, lane.
layout(set = 0, binding = 1) writeonly buffer Log { uint entries[]; };

void main() {
    uint warp = 0;
    uint lane = 0;
#ifdef WARPS
    if (subgroupElect()) warp = atomicAdd(warps, 1);
    warp = subgroupBroadcastFirst(warp);
    lane = gl_SubgroupInvocationID;
#endif
    uint entry = 3 * atomicAdd(invocations, 1);
    if (entry + 2 < entries.length()) {
        entries[entry] = gl_VertexIndex;
        entries[entry + 1] = warp;
        entries[entry + 2] = lane;
    }
    gl_Position = placed(vec3(0.0));
}
