// The programs of the screen. The first develops a frame: exposure and view transform (as src/image/view.c), or false
// colours, once for each pixel of the frame. The second lays the result on the page.
export const vertex = `#version 300 es
uniform vec4 place;            // corners in clip space: left, top, right, bottom
out vec2 point;                // place in the texture, 0 to 1
void main() {
  point = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  gl_Position = vec4(mix(place.x, place.z, point.x), mix(place.y, place.w, point.y), 0, 1);
}`;

const views = `
vec3 srgbCurve(vec3 x) {
  x = clamp(x, 0.0, 1.0);
  return mix(1.055 * pow(max(x, 1e-9), vec3(1.0 / 2.4)) - 0.055, 12.92 * x, vec3(lessThanEqual(x, vec3(0.0031308))));
}
vec3 khronosNeutral(vec3 c) {
  float f90 = 0.04, start = 0.8 - 0.04, x = min(c.r, min(c.g, c.b));
  c -= x <= 2.0 * f90 ? x - x * x / (4.0 * f90) : f90;
  float peak = max(c.r, max(c.g, c.b));
  if (peak <= start) return c;
  float d = 1.0 - start, to = 1.0 - d * d / (peak + d - start);
  float g = 1.0 / (0.15 * (peak - to) + 1.0);
  return c * (to / peak) * g + to * (1.0 - g);
}
vec3 agx(vec3 c) {
  vec3 v = vec3(dot(c, vec3(0.842479062253094, 0.0784335999999992, 0.0792237451477643)),
                dot(c, vec3(0.0423282422610123, 0.878468636469772, 0.0791661274605434)),
                dot(c, vec3(0.0423756549057051, 0.0784336, 0.879142973793104)));
  vec3 x = clamp((log2(max(v, 1e-30)) + 12.47393) / (4.026069 + 12.47393), 0.0, 1.0), x2 = x * x, x4 = x2 * x2;
  vec3 r = 15.5 * x4 * x2 - 40.14 * x4 * x + 31.96 * x4 - 6.868 * x2 * x + 0.4298 * x2 + 0.1191 * x - 0.00232;
  return vec3(dot(r, vec3(1.19687900512017, -0.0980208811401368, -0.0990297440797205)),
              dot(r, vec3(-0.0528968517574562, 1.15190312990417, -0.0989611768448433)),
              dot(r, vec3(-0.0529716355144438, -0.0980434501171241, 1.15107367264116)));
}
vec3 display(vec3 c) {
  c = clamp(c * exposure, -1e30, 1e30);
  if (any(isnan(c))) c = vec3(0);
#if VIEW == 1
  return srgbCurve(khronosNeutral(max(c, 0.0)));
#elif VIEW == 2
  return clamp(agx(max(c, 0.0)), 0.0, 1.0);
#elif VIEW == 3
  return clamp(c, 0.0, 1.0);
#else
  return srgbCurve(c);
#endif
}`;

// Viridis (Smith, van der Walt), a polynomial of degree 6 by Matt Zucker.
const colours = `
vec3 viridis(float t) {
  return vec3(0.2777273, 0.0054073, 0.3340998) + t * (vec3(0.1050930, 1.4046135, 1.3845902) +
    t * (vec3(-0.3308618, 0.2148476, 0.0950952) + t * (vec3(-4.6342305, -5.7991010, -19.3324410) +
    t * (vec3(6.2282699, 14.1799334, 56.6905526) + t * (vec3(4.7763850, -13.7451454, -65.3530326) +
    t * vec3(-5.4354559, 4.6458526, 26.3124352))))));
}
vec3 idColour(float id) {
  float hue = fract(id * 0.61803398875), light = 0.95 - 0.3 * fract(id * 0.38196601125);
  vec3 c = clamp(abs(fract(hue + vec3(0.0, 2.0, 1.0) / 3.0) * 6.0 - 3.0) - 1.0, 0.0, 1.0);
  return id == 0.0 ? vec3(0.08) : light * mix(vec3(1), c, 0.6);
}
vec3 falseColour(vec3 v) {
#if KIND == 1 || KIND == 8
  float s = KIND == 1 ? v.x : max(v.x, max(v.y, v.z));
  return any(isinf(v)) || any(isnan(v)) ? vec3(0.13) : viridis(clamp((s - low.x) / (high.x - low.x), 0.0, 1.0));
#elif KIND == 9
  return any(isinf(v)) || any(isnan(v)) ? vec3(0.13) : v.x <= 0.0 ? vec3(0) : viridis(clamp((log2(max(v.x, 1e-30)) - low.x) / (high.x - low.x), 0.0, 1.0));
#elif KIND == 2
  return v == vec3(0) ? vec3(0.13) : 0.5 + 0.5 * v;
#elif KIND == 3
  return v == vec3(0) ? vec3(0.13) : clamp((v - low) / max(high - low, 1e-9), 0.0, 1.0);
#elif KIND == 4
  return vec3(fract(v.xy), 0.25);
#elif KIND == 5
  return srgbCurve(v);
#elif KIND == 7
  float r = min(length(v.xy) / high.x, 1.0), hue = r > 0.0 ? fract(atan(v.y, v.x) / 6.28318531 + 1.0) : 0.0;
  vec3 c = mix(vec3(1), clamp(abs(fract(hue + vec3(0.0, 2.0, 1.0) / 3.0) * 6.0 - 3.0) - 1.0, 0.0, 1.0), r);
  return v.z == 0.0 ? c : v.z == 3.0 ? vec3(0.13) : 0.45 * c;
#else
  return idColour(v.x);
#endif
}`;

// Develops a frame. kind: 0 colours, 1 scalar, 2 direction, 3 position, 4 uv, 5 albedo, 6 ids, 7 flow, 8 standard error, 9 scalar
// on a logarithmic scale (low and high are powers of two; black: 0). Each combination is a
// program of its own, so that none computes what it does not show.
export const develop = (view, kind) => `#version 300 es
precision highp float;
precision highp int;
#define VIEW ${view}
#define KIND ${kind}
uniform highp sampler2D pixels;
uniform float exposure;
uniform vec3 low, high;
out vec4 result;
${views}
${colours}
void main() {
  vec3 v = texelFetch(pixels, ivec2(gl_FragCoord.xy), 0).rgb;
#if KIND == 0
  result = vec4(display(v), 1);
#else
  result = vec4(falseColour(v), 1);
#endif
}`;

// Lays developed pixels on the page.
export const lay = `#version 300 es
precision mediump float;
uniform sampler2D pixels;
uniform float dim;
in highp vec2 point;
out vec4 result;
void main() { result = vec4(texture(pixels, point).rgb * dim, 1); }`;
