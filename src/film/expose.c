/* film/expose.c: see expose.h. */
#include "film/expose.h"

#include "color/kernels.h"

static void multiply3(const float a[9], const float b[9], float c[9]) {
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) c[3 * i + j] = a[3 * i] * b[j] + a[3 * i + 1] * b[3 + j] + a[3 * i + 2] * b[6 + j];
}

static void convert(vlColorSpace space, const float *balance, const vlExposure *e, float *r, float *g, float *b) {
  float to[9], from[9], m[9], product[9];
  vl_rgb_from_xyz(space, to);
  vl_xyz_from_rgb(VL_SPACE_SRGB, from);
  if (balance) multiply3(to, balance, m);
  multiply3(balance ? m : to, from, product);
  for (int i = 0; i < 9; i++) m[i] = product[i];
  for (int i = 0; space == VL_SPACE_SRGB && !balance && i < 9; i++) m[i] = i % 4 == 0; /* not the rounded product */
  const float *x = e->radiance[0], *y = e->radiance[1], *z = e->radiance[2];
  for (uint32_t i = 0; i < VL_PAD(e->n); i++) {
    r[i] = m[0] * x[i] + m[1] * y[i] + m[2] * z[i];
    g[i] = m[3] * x[i] + m[4] * y[i] + m[5] * z[i];
    b[i] = m[6] * x[i] + m[7] * y[i] + m[8] * z[i];
  }
}

/* As pbrt's maxcomponentvalue: of the sensor's values, which are X, Y, Z. */
static void limit(vlColorSpace space, float most, uint32_t n, float *r, float *g, float *b) {
  float m[9];
  vl_xyz_from_rgb(space, m);
  for (uint32_t i = 0; i < VL_PAD(n); i++) {
    float x = m[0] * r[i] + m[1] * g[i] + m[2] * b[i], y = m[3] * r[i] + m[4] * g[i] + m[5] * b[i];
    float z = m[6] * r[i] + m[7] * g[i] + m[8] * b[i], top = x > y ? x : y;
    top = top > z ? top : z;
    float f = top > most ? most / top : 1.0f;
    r[i] *= f, g[i] *= f, b[i] *= f;
  }
}

void vl_film_expose(const vlFilm *film, vlIsa isa, const vlExposure *e, float *r, float *g, float *b) {
  vlColorSpace space = vl_film_def(film)->space;
  const float *balance = vl_film_balance(film);
  if (e->lambda[0]) {
    float m[9], to[9];
    vl_rgb_from_xyz(space, balance ? to : m);
    if (balance) multiply3(to, balance, m);
    vl_color_kernels(isa)->rgb_from_radiance(m, e->n, e->radiance, e->lambda, e->inv_pdf, r, g, b);
  } else {
    convert(space, balance, e, r, g, b);
  }
  float f = e->exposure;
  for (uint32_t i = 0; f != 1.0f && i < VL_PAD(e->n); i++) r[i] *= f, g[i] *= f, b[i] *= f;
  if (vl_film_def(film)->max_component < 3e38f) limit(space, vl_film_def(film)->max_component, e->n, r, g, b);
}
