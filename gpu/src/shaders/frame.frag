// Which range is seen, and which face of it.
#version 450

layout(location = 0) flat in uint range;
layout(location = 0) out uvec2 seen;

void main() { seen = uvec2(range, gl_PrimitiveID); }
