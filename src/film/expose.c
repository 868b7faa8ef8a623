/* film/expose.c: see expose.h. */
#include "film/expose.h"

#include "color/kernels.h"
#include "math/transform.h"

static void multiply3(const float a[9], const float b[9], float c[9]) {
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      c[3 * i + j] = a[3 * i] * b[j] + a[3 * i + 1] * b[3 + j] + a[3 * i + 2] * b[6 + j];
}

static void convert(vlColorSpace space, const float *balance, const vlExposure *e, float *r,
                    float *g, float *b) {
  float to[9], from[9], m[9], balanced[9];
  vl_rgb_from_xyz(space, to);
  vl_xyz_from_rgb(VL_SPACE_SRGB, from);
  if (balance)
    multiply3(to, balance, balanced);
  multiply3(balance ? balanced : to, from, m);
  for (int i = 0; space == VL_SPACE_SRGB && !balance && i < 9; i++)
    m[i] = i % 4 == 0; /* the exact identity, not the rounded product of two inverse matrices */
  const float *x = e->radiance[0], *y = e->radiance[1], *z = e->radiance[2];
  for (uint32_t i = 0; i < VL_PAD(e->n); i++) {
    r[i] = m[0] * x[i] + m[1] * y[i] + m[2] * z[i];
    g[i] = m[3] * x[i] + m[4] * y[i] + m[5] * z[i];
    b[i] = m[6] * x[i] + m[7] * y[i] + m[8] * z[i];
  }
}

/* The matrix from the film's red, green, blue back to the sensor's values, for the clamp of the
 * largest component. Without a white balance these are the sensor's X, Y, Z. */
static void values_from_rgb(const vlFilm *film, const float *xyz_from_sensor, float m[9]) {
  float to[9], product[9];
  double whole[9], back[9];
  if (!xyz_from_sensor) {
    vl_xyz_from_rgb(vl_film_def(film)->space, m);
    return;
  }
  vl_rgb_from_xyz(vl_film_def(film)->space, to);
  multiply3(to, xyz_from_sensor, product);
  for (int i = 0; i < 9; i++)
    whole[i] = (double)product[i];
  vl_mat3_inverse(whole, back);
  for (int i = 0; i < 9; i++)
    m[i] = (float)back[i];
}

/* Scales colours whose largest component exceeds `max` (pbrt's maxcomponentvalue). Components
 * are the sensor's values, which m computes from r, g, b. */
static void limit(const float m[9], float max, uint32_t n, float *r, float *g, float *b) {
  for (uint32_t i = 0; i < VL_PAD(n); i++) {
    float x = m[0] * r[i] + m[1] * g[i] + m[2] * b[i],
          y = m[3] * r[i] + m[4] * g[i] + m[5] * b[i];
    float z = m[6] * r[i] + m[7] * g[i] + m[8] * b[i], top = x > y ? x : y;
    top = top > z ? top : z;
    float f = top > max ? max / top : 1.0f;
    r[i] *= f;
    g[i] *= f;
    b[i] *= f;
  }
}

void vl_film_expose(const vlFilm *film, vlIsa isa, const vlExposure *e, float *r, float *g,
                    float *b) {
  vlColorSpace space = vl_film_def(film)->space;
  const vlFilmSensor *sensor = e->lambda[0] ? vl_film_sensor(film) : NULL;
  const float *balance = sensor ? sensor->xyz : vl_film_balance(film);
  float m[9], to[9];
  if (e->lambda[0]) {
    vl_rgb_from_xyz(space, balance ? to : m);
    if (balance)
      multiply3(to, balance, m);
    vl_color_kernels(isa)->rgb_from_radiance(sensor ? sensor->curves : vl_cie_xyz0, m, e->n,
                                             e->radiance, e->lambda, e->inv_pdf, r, g, b);
  } else {
    convert(space, balance, e, r, g, b);
  }
  float f = e->exposure;
  for (uint32_t i = 0; f != 1.0f && i < VL_PAD(e->n); i++) {
    r[i] *= f;
    g[i] *= f;
    b[i] *= f;
  }
  if (!(vl_film_def(film)->max_component < 3e38f))
    return;
  values_from_rgb(film, balance, m);
  limit(m, vl_film_def(film)->max_component, e->n, r, g, b);
}
