// A vertex of a mesh, seen by an eye; it says which range of faces is drawn. Where COUNT is defined it counts as
// count.vert does; where COMPUTE is, it takes 3,200 floating-point operations.
#version 460
#ifdef WARPS
#extension GL_KHR_shader_subgroup_basic : require
#endif

layout(location = 0) in vec3 position;
layout(location = 0) flat out uint range;
layout(push_constant) uniform Frame { mat4 view; } frame;
#ifdef COUNT
layout(set = 0, binding = 0) buffer Counters { uint invocations; uint warps; };
#endif

void main() {
#ifdef COUNT
    atomicAdd(invocations, 1);
#ifdef WARPS
    if (subgroupElect()) atomicAdd(warps, 1);
#endif
#endif
    range = gl_DrawID;
    vec3 placed = position;
#ifdef COMPUTE
    vec4 value = vec4(position, 1.0);
    // Not known before the draw, so that the loop is not computed beforehand.
    vec4 factor = 1e-3 * frame.view[0] + 0.5;
    for (int i = 0; i < 400; i++) value = fma(value, factor, position.xyzx);
    // Too little to move a vertex, but the compiler does not know.
    placed += 1e-30 * clamp(value.xyz + value.w, -1.0, 1.0);
#endif
    gl_Position = frame.view * vec4(placed, 1.0);
}
