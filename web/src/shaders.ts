// What runs on the graphics card.

export const SURFACE_VERTEX = `#version 300 es
in vec3 position, normal, tint;
in vec2 uv;
uniform mat4 modelViewMatrix, projectionMatrix;
uniform mat3 normalMatrix;
out vec3 facing, colour, corner;
out vec2 texture_at;
flat out int triangle;
void main() {
    facing = normalMatrix * normal;
    colour = tint;
    texture_at = uv;
    triangle = gl_VertexID / 3;
    int k = gl_VertexID % 3;
    corner = vec3(k == 0, k == 1, k == 2);
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}`;

// Lines and checks are as wide as the pixels ask for, and fade where there would be several in one.
export const SURFACE_FRAGMENT = `#version 300 es
precision highp float;
precision highp int;
in vec3 facing, colour, corner;
in vec2 texture_at;
flat in int triangle;
uniform int pattern, hovered, picked, halves;
uniform float period, edges, flat_light;
uniform vec3 accent;
out vec4 pixel;

float line(float distance_to_line, float width) {
    return 1.0 - smoothstep(width - 0.5, width + 0.5, distance_to_line);
}

float checks(vec2 at) {
    vec2 w = fwidth(at);
    vec2 side = clamp((abs(fract(at * 0.5 + 0.25) - 0.5) - 0.25) * 2.0 / max(w, vec2(1e-6)), -1.0, 1.0);
    float fade = clamp(1.5 - max(w.x, w.y), 0.0, 1.0);
    return 0.5 - 0.5 * side.x * side.y * fade;
}

float grid(vec2 at) {
    vec2 w = fwidth(at);
    vec2 d = (0.5 - abs(fract(at) - 0.5)) / max(w, vec2(1e-6));
    float fade = clamp(2.0 - 4.0 * max(w.x, w.y), 0.15, 1.0);
    return line(min(d.x, d.y), 0.8) * fade;
}

void main() {
    vec3 base = colour;
    if (pattern == 1) base = mix(base, base * vec3(0.42, 0.52, 0.6), checks(texture_at / period));
    if (pattern == 2) base = mix(base, base * 0.28, grid(texture_at / period));
    int face = triangle / halves;
    if (edges > 0.0) {
        vec3 d = corner / max(fwidth(corner), vec3(1e-6));
        // The diagonal of a quad is no edge.
        if (halves == 2) { if (triangle % 2 == 0) d.y = 1e6; else d.z = 1e6; }
        base = mix(base, vec3(0.08, 0.09, 0.12), edges * line(min(d.x, min(d.y, d.z)), 0.6));
    }
    if (face == hovered) base = mix(base, accent, 0.35);
    if (face == picked) base = mix(base, accent, 0.75);
    vec3 n = normalize(facing);
    float light = mix(0.46 + 0.52 * abs(n.z) + 0.08 * n.y, 1.0, flat_light);
    // The back of a surface is darker.
    if (!gl_FrontFacing && flat_light == 0.0) light *= 0.62;
    pixel = vec4(base * light, 1.0);
}`;

// A line of a width in pixels: four corners for each of its two ends.
export const LINE_VERTEX = `#version 300 es
in vec2 position;
in vec3 start, end;
uniform mat4 modelViewMatrix, projectionMatrix;
uniform vec2 size;
uniform float width, lift;
void main() {
    vec4 a = projectionMatrix * modelViewMatrix * vec4(start, 1.0);
    vec4 b = projectionMatrix * modelViewMatrix * vec4(end, 1.0);
    vec2 along = (b.xy / b.w - a.xy / a.w) * size;
    along = length(along) > 1e-6 ? normalize(along) : vec2(1.0, 0.0);
    vec4 at = position.x < 0.0 ? a : b;
    vec2 offset = (along * position.x + vec2(-along.y, along.x) * position.y) * width / size;
    at.xy += offset * at.w;
    at.z -= lift * at.w;
    gl_Position = at;
}`;

export const LINE_FRAGMENT = `#version 300 es
precision highp float;
uniform vec3 tint;
out vec4 pixel;
void main() { pixel = vec4(tint, 1.0); }`;

export const POINT_VERTEX = `#version 300 es
in vec2 position;
in vec3 at, tint;
uniform mat4 modelViewMatrix, projectionMatrix;
uniform vec2 size;
uniform float width, lift;
out vec2 within;
out vec3 colour;
void main() {
    within = position;
    colour = tint;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(at, 1.0);
    gl_Position.xy += position * width / size * gl_Position.w;
    gl_Position.z -= lift * gl_Position.w;
}`;

export const POINT_FRAGMENT = `#version 300 es
precision highp float;
in vec2 within;
in vec3 colour;
out vec4 pixel;
void main() {
    float r = length(within);
    if (r > 1.0) discard;
    pixel = vec4(r > 0.74 ? vec3(1.0) : colour, 1.0);
}`;
