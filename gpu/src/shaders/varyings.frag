#version 450

layout(location = 0) in vec4 varyings[12];
layout(location = 0) out vec4 colour;

void main() {
    colour = vec4(0.0);
    for (int i = 0; i < 12; i++) colour += varyings[i];
}
