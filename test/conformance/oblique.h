/* conformance/oblique.h: the law of oblique ways: what passes a medium of known extinction
 * along rays that no axis is parallel to, which cross cells from all sides in all orders. */
#ifndef TEST_CONFORMANCE_OBLIQUE_H
#define TEST_CONFORMANCE_OBLIQUE_H

#include "conformance.h"
#include "math/double3.h"
#include "transport.h"
#include "unit.h"

/* Where the eye of medium_form is; it looks at the origin. */
#define FACING "LookAt 0 0 3 "

/* A camera without perspective: its place and axes. */
typedef struct Oblique {
  double eye[3], right[3], up[3], forward[3];
} Oblique;

static Oblique oblique_from(const double eye[3]) {
  static const double y[3] = {0, 1, 0};
  Oblique o = {0};
  for (int k = 0; k < 3; k++) {
    o.eye[k] = eye[k];
    o.forward[k] = -eye[k];
  }
  vl_normalize3(o.forward);
  vl_cross3(y, o.forward, o.right);
  vl_normalize3(o.right);
  vl_cross3(o.forward, o.right, o.up);
  return o;
}

/* The extinction at a point of the box. */
typedef double OfPoint(const double p[3], PlainNoise *noise);

/* The transmittance of the way through the box from -1 to 1 at (x, y) of the screen. */
static double passes_way(OfPoint *density, const Oblique *o, double x, double y) {
  enum { STEPS = 256 };
  double from[3];
  double first = 0;
  double last = INFINITY;
  double sum = 0;
  for (int k = 0; k < 3; k++) {
    from[k] = o->eye[k] + x * o->right[k] + y * o->up[k];
    const double a = (-1 - from[k]) / o->forward[k];
    const double b = (1 - from[k]) / o->forward[k];
    first = fmax(first, fmin(a, b));
    last = fmin(last, fmax(a, b));
  }
  if (!(first < last))
    return 1;
  for (int i = 0; i < STEPS; i++) {
    double p[3];
    for (int k = 0; k < 3; k++)
      p[k] = from[k] + (first + (last - first) * (i + 0.5) / STEPS) * o->forward[k];
    sum += density(p, plain_noise) * (last - first) / STEPS;
  }
  return exp(-sum);
}

/* The mean of a pixel's ways. */
static double passes_pixel_from(OfPoint *density, const Oblique *o, uint32_t width,
                                uint32_t column, uint32_t row) {
  enum { STEPS = 3 };
  double sum = 0;
  for (int i = 0; i < STEPS * STEPS; i++)
    sum += passes_way(density, o, (column + (i % STEPS + 0.5) / STEPS) / width - 0.5,
                      0.5 - (row + (i / STEPS + 0.5) / STEPS) / width) /
           (STEPS * STEPS);
  return sum;
}

static void check_oblique(const char *name, const char *parameters, OfPoint *density,
                          const double eye[3]) {
  static char form[TEXT];
  static char text[TEXT];
  char what[100];
  Mean off = {0};
  const Oblique o = oblique_from(eye);
  assert_memory_equal(medium_form, FACING, strlen(FACING));
  snprintf(form, sizeof form, "LookAt %g %g %g %s", eye[0], eye[1], eye[2],
           medium_form + strlen(FACING));
  scene_text(text, form, name, parameters);
  vlImage *image = image_of(text, NULL, MEDIUM_SPP);
  const uint32_t width = vl_image_width(image);
  for (uint32_t i = 0; i < width * width; i++)
    mean_add(&off, (double)vl_image_get(image, i % width, i / width, 1) -
                       passes_pixel_from(density, &o, width, i % width, i / width));
  vl_image_destroy(image);
  snprintf(what, sizeof what, "light that passes from %g %g %g, beyond the known", eye[0],
           eye[1], eye[2]);
  check_mean("media", name, what, &off, 0, (Sight){.slack = 2e-3, .min = 0.02});
}

static void oblique_ways(void **state) {
  (void)state;
  static const double eyes[][3] = {{1, 2, 4}, {-2.5, 1.1, 0.9}, {0.8, -2, -3.5}};
  const vlKindFamily *family = vl_kind_family_find("media");
  for (uint32_t k = 0; k < family->kind_count; k++)
    for (size_t i = 0; i < sizeof eyes / sizeof *eyes; i++) {
      const MediumCase *c = medium_cases[k];
      char all[2000];
      snprintf(all, sizeof all, "%s%s", c->shape, c->absorbs);
      if (c->density)
        check_oblique(family->rows[k]->name, all, c->density, eyes[i]);
      if (c->layers)
        check_oblique(family->rows[k]->name, c->layers, c->density_of_layers, eyes[i]);
      if (c->blocks)
        check_oblique(family->rows[k]->name, c->blocks, c->density_of_blocks, eyes[i]);
    }
  expect_no_failures();
}

#endif
