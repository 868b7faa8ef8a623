// The programs that show a frame: exposure, view transforms (as src/image/view.c), false colours.
export const vertex = `#version 300 es
uniform vec4 place;            // corners of the image in clip space: left, top, right, bottom
out vec2 point;                // place in the image, 0 to 1, y down
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
  if (view == 1) return srgbCurve(khronosNeutral(max(c, 0.0)));
  if (view == 2) return clamp(agx(max(c, 0.0)), 0.0, 1.0);
  return view == 3 ? clamp(c, 0.0, 1.0) : srgbCurve(c);
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
  uint h = uint(id) * 2654435761u;
  h ^= h >> 15; h *= 2246822519u; h ^= h >> 13;
  float hue = float(h & 1023u) / 1024.0, light = 0.55 + 0.35 * float(h >> 10 & 255u) / 255.0;
  vec3 c = clamp(abs(fract(hue + vec3(0.0, 2.0, 1.0) / 3.0) * 6.0 - 3.0) - 1.0, 0.0, 1.0);
  return id == 0.0 ? vec3(0.08) : light * mix(vec3(1), c, 0.65);
}
vec3 falseColour(vec3 v) {
  bool nothing = any(isinf(v)) || any(isnan(v));
  if (kind == 1) return nothing ? vec3(0.13) : viridis(clamp((v.x - low.x) / (high.x - low.x), 0.0, 1.0));
  if (kind == 2) return v == vec3(0) ? vec3(0.13) : 0.5 + 0.5 * v;
  if (kind == 3) return v == vec3(0) ? vec3(0.13) : clamp((v - low) / max(high - low, 1e-9), 0.0, 1.0);
  if (kind == 4) return vec3(fract(v.xy), 0.25);
  if (kind == 5) return srgbCurve(v);
  return idColour(v.x);
}`;

export const fragment = `#version 300 es
precision highp float;
precision highp int;
uniform highp sampler2D pixels;
uniform vec2 size;             // of the image
uniform vec4 window;           // x0, y0 of the frame in the image, its scale, 0
uniform float exposure;
uniform int view, kind;        // kind: 0 colours, 1 scalar, 2 direction, 3 position, 4 uv, 5 albedo, 6 ids
uniform vec3 low, high;
uniform float taps;            // texels that a pixel of the screen covers, each way
uniform float dim;
in vec2 point;
out vec4 result;
${views}
${colours}
vec3 texel(ivec2 at) {
  ivec2 last = textureSize(pixels, 0) - 1;
  return texelFetch(pixels, clamp(at, ivec2(0), last), 0).rgb;
}
vec3 shown(vec3 v) { return kind == 0 ? display(v) : falseColour(v); }
void main() {
  vec2 at = (point * size - window.xy) / window.z;
  vec2 end = vec2(textureSize(pixels, 0));
  if (at.x < 0.0 || at.y < 0.0 || at.x >= end.x || at.y >= end.y) discard;
  vec3 sum = vec3(0);
  if (window.z > 1.0 && kind == 0) {            // a coarse image: smooth
    vec2 p = at - 0.5, f = fract(p);
    ivec2 i = ivec2(floor(p));
    sum = shown(mix(mix(texel(i), texel(i + ivec2(1, 0)), f.x),
                    mix(texel(i + ivec2(0, 1)), texel(i + ivec2(1, 1)), f.x), f.y));
  } else if (taps <= 1.0) {                     // pixels are shown as pixels
    sum = shown(texel(ivec2(at)));
  } else {                                      // a reduced image: the mean of what a pixel covers
    int n = int(min(4.0, ceil(taps)));
    for (int j = 0; j < n; j++)
      for (int i = 0; i < n; i++)
        sum += shown(texel(ivec2(at + ((vec2(i, j) + 0.5) / float(n) - 0.5) * taps)));
    sum /= float(n * n);
  }
  result = vec4(sum * dim, 1);
}`;
