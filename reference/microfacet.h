/* microfacet.h: rough surfaces as many small mirrors: the distribution of Trowbridge and Reitz, called GGX (pbrt book
 * 9.6). All directions are local; m is the normal of a small mirror, on the side of +z. */
#pragma once
#include "bsdf.h"

/* So smooth that it is computed as a mirror (pbrt's EffectivelySmooth). */
static inline bool is_smooth(const bsdf *b) {
  return b->alpha_x < 1e-3 && b->alpha_y < 1e-3;
}

/* D(m): the area of mirrors with normal m, per area of the surface and per solid angle (pbrt book 9.6.1). */
static inline double mirror_distribution(const bsdf *b, vector m) {
  double ax = fmax(b->alpha_x, 1e-4), ay = fmax(b->alpha_y, 1e-4);
  double e = square(m.x / ax) + square(m.y / ay) + square(m.z);
  return 1 / (PI * ax * ay * square(e));
}

/* Smith's Lambda: from the direction w, the hidden area of the mirrors over the visible one (pbrt book 9.6.2). */
static inline double hidden_over_visible(const bsdf *b, vector w) {
  double ax = fmax(b->alpha_x, 1e-4), ay = fmax(b->alpha_y, 1e-4);
  double slope2 = (square(ax * w.x) + square(ay * w.y)) / square(w.z);
  return (sqrt(1 + slope2) - 1) / 2;
}

/* G1: the share of the mirrors that is seen from w. G: the share that is seen from wo and from wi (pbrt book 9.6.3). */
static inline double visible(const bsdf *b, vector w) {
  return 1 / (1 + hidden_over_visible(b, w));
}
static inline double visible_from_both(const bsdf *b, vector wo, vector wi) {
  return 1 / (1 + hidden_over_visible(b, wo) + hidden_over_visible(b, wi));
}

/* The density of the normals that w sees, D(m) G1(w) |w . m| / |w . z|: a mirror counts as large as it looks from w. */
static inline double visible_density(const bsdf *b, vector w, vector m) {
  return visible(b, w) / fabs(w.z) * mirror_distribution(b, m) * fabs(dot(w, m));
}

/* Draws a normal with that density (Heitz 2018, pbrt book 9.6.4). With x and y times alpha, the mirrors are a
 * hemisphere, seen from wh. A ball looks like a disk, with y from -h to h at each x; of the hemisphere one sees a disk
 * with a flatter lower half, y from -wh.z h to h. */
static inline vector sample_visible_normal(const bsdf *b, vector w, sampler *s) {
  double ax = fmax(b->alpha_x, 1e-4), ay = fmax(b->alpha_y, 1e-4);
  vector wh = normalize(make_vector(ax * w.x, ay * w.y, w.z));
  if (wh.z < 0) wh = negate(wh);
  frame f = make_frame(wh, fabs(wh.z) < 0.99999 ? cross(make_vector(0, 0, 1), wh) : make_vector(1, 0, 0));
  square_point p = sample_unit_disk(s);
  double h = sqrt(1 - square(p.x));
  double seen = (1 + wh.z) / 2;
  double y = (1 - seen) * h + seen * p.y;
  double z = sqrt(fmax(0, 1 - square(p.x) - square(y)));
  vector n = from_local(f, make_vector(p.x, y, z));
  return normalize(make_vector(ax * n.x, ay * n.y, fmax(1e-6, n.z)));
}

/* The mirror's law: w and the result have the same angle to m, on both sides of it. */
static inline vector reflect(vector w, vector m) {
  return subtract(scale(2 * dot(w, m), m), w);
}
