/* shape/surface_point.c: calls the function of a shape's kind (kinds.h); bounds and area
 * of primitives. */
#include "shape/surface_point.h"

#include <math.h>
#include <string.h>

#include "math/double3.h"
#include "shape/kinds.row.h"
#include "shape/shape_kind.h"
#include "velo/schema.h"
#include "velo/shape_kinds.h"

void vl_ray_to_group(const vlWorldInstance *instance, double o[3], double d[3]) {
  const double p[3] = {o[0], o[1], o[2]}, v[3] = {d[0], d[1], d[2]};
  vl_float_map_point(instance->to_group, p, o);
  vl_float_map_vector(instance->to_group, v, d);
}

void vl_instance_error(const float m[12], const float w[12], float error[4]) {
  const float gamma4 = 4 * 0x1p-24f;
  float spread = 0; /* the largest sum of a row of |m| |w| */
  for (int i = 0; i < 3; i++) {
    float row = 0;
    for (int k = 0; k < 3; k++)
      for (int j = 0; j < 3; j++)
        row += fabsf(m[4 * i + k] * w[4 * k + j]);
    spread = fmaxf(spread, row);
  }
  for (int i = 0; i < 12; i++)
    error[i % 4] = fmaxf(error[i % 4], gamma4 * spread * fabsf(m[i]));
}

#define DECLARE(kind, row, box, functions) extern const vlShapeFunctions functions;
VL_SHAPE_FUNCTIONS(DECLARE)

#define FUNCTIONS(kind, row, box, functions) [kind] = &functions,
static const vlShapeFunctions *const functions_of[] = {VL_SHAPE_FUNCTIONS(FUNCTIONS)};

vlResult vl_shape_compile(vlWorld *world, const vlShapeDef *def, const vlMat4 *to_group,
                          const vlMat4 *from_group, vlWorldShape *shape, vlError *error) {
  return functions_of[def->kind]->compile(world, def, to_group, from_group, shape, error);
}

bool vl_shape_intersect(const vlWorldShape *shape, uint32_t prim, const double o[3],
                        const double d[3], double t_min, double t_max, vlShapeHit *hit) {
  hit->a = hit->b = 0;
  return functions_of[shape->kind]->intersect(shape, prim, o, d, t_min, t_max, hit);
}

void vl_shape_point(const vlWorldShape *shape, uint32_t prim, const vlShapeHit *hit,
                    vlSurfacePoint *point) {
  point->off = 0;
  memset(point->error, 0, sizeof point->error);
  functions_of[shape->kind]->point(shape, prim, hit, point);
}

void vl_shape_sample(const vlWorldShape *shape, uint32_t prim, float u, float v,
                     vlSurfacePoint *point, double *pdf) {
  *pdf = 0;
  point->off = 0;
  memset(point->error, 0, sizeof point->error);
  functions_of[shape->kind]->sample(shape, prim, u, v, point, pdf);
}

double vl_shape_pdf(const vlWorldShape *shape, uint32_t prim, const vlSurfacePoint *point) {
  return functions_of[shape->kind]->pdf(shape, prim, point->p);
}

/* ---- bounds and area, also of triangles -------------------------------------------------- */

float vl_world_prim_area(const vlWorldShape *shape, uint32_t prim) {
  if (shape->triangles) {
    const uint32_t *f = shape->indices + 3 * (size_t)prim;
    double a[3], b[3], n[3];
    for (int i = 0; i < 3; i++) {
      double o = shape->positions[3 * (size_t)f[0] + i];
      a[i] = shape->positions[3 * (size_t)f[1] + i] - o;
      b[i] = shape->positions[3 * (size_t)f[2] + i] - o;
    }
    vl_cross3(a, b, n);
    return (float)(0.5 * sqrt(vl_dot3(n, n)));
  }
  /* The area is the mean of 1/pdf over a grid of parameters, which is exact for parallelograms.
   * A single point suffices if the density is constant. */
  double sum = 0, scale;
  bool even = shape->kind == VL_SHAPE_DISK || ((shape->traits & VL_SHAPE_TRAIT_QUADRIC) &&
                                               vl_is_similarity(shape->from_shape, &scale));
  const int steps = even ? 1 : 16;
  for (int i = 0; i < steps; i++)
    for (int j = 0; j < steps; j++) {
      vlSurfacePoint point;
      double pdf;
      vl_shape_sample(shape, prim, ((float)i + 0.5f) / steps, ((float)j + 0.5f) / steps, &point,
                      &pdf);
      sum += pdf > 0 ? 1 / pdf : 0;
    }
  return (float)(sum / (steps * steps));
}

void vl_world_prim_bounds(const vlWorldShape *shape, uint32_t prim, float low[3],
                          float high[3]) {
  double lo[3] = {INFINITY, INFINITY, INFINITY}, hi[3] = {-INFINITY, -INFINITY, -INFINITY};
  functions_of[shape->kind]->bounds(shape, prim, lo, hi);
  for (int i = 0; i < 3; i++) { /* the box grows by one float step because of rounding */
    low[i] = nextafterf((float)lo[i], -INFINITY);
    high[i] = nextafterf((float)hi[i], INFINITY);
  }
}
