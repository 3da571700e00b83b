// What every vertex shader here is given. Included by all of them.

// Changed between draws, as a scene does it for each of its objects: place.xyz is added to the
// position, place.w scales it.
layout(push_constant) uniform Draw { vec4 place; } draw;

vec4 placed(vec3 position) { return vec4(draw.place.xyz + draw.place.w * position, 1.0); }
