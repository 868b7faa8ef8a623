/* scene/inspect.c: a summary of a scene: its bounding box, its lights and their power. */
#include <math.h>
#include <string.h>

#include "color/color.h"
#include "math/double3.h"
#include "scene/extent.h"
#include "scene/lamps.h"
#include "scene/solid.h"
#include "schema/schema.h"
#include "velo/check.h"
#include "velo/light.h"
#include "velo/shape_kinds.h"

void vl_scene_bounds(const vlScene *s, double low[3], double high[3]) {
  const size_t n = s->groups.count + 1;
  vlExtent *boxes = vl_alloc_array(s->context, n, sizeof *boxes);
  for (size_t g = 0; boxes && g < n; g++)
    boxes[g] = vl_extent_nothing;
  for (size_t i = 0; boxes && i < s->shapes.count; i++) {
    const vlExtent own = vl_shape_box(&s->shapes.items[i]);
    vl_extent_join(&boxes[s->shapes.items[i].group.index], &own);
  }
  vlExtent whole = boxes ? boxes[0] : vl_extent_nothing;
  for (size_t i = 0; boxes && i < s->instances.count; i++) {
    const vlExtent *box = &boxes[s->instances.items[i].group.index];
    const vlMat4 m = vl_mat4_load(s->instances.items[i].world_from_group);
    if (!vl_extent_is_empty(box))
      vl_extent_visit_box(&m, box, vl_extent_grow, &whole);
  }
  memcpy(low, whole.low, sizeof whole.low);
  memcpy(high, whole.high, sizeof whole.high);
  vl_free(s->context, boxes);
}

/* ---- areas ------------------------------------------------------------------------------- */

static double triangle_area(const double p[3][3]) {
  double e[2][3], n[3];
  vl_sub3(p[1], p[0], e[0]);
  vl_sub3(p[2], p[0], e[1]);
  vl_cross3(e[0], e[1], n);
  return 0.5 * vl_norm3(n);
}

/* Area of a shape. Patches count as two triangles; quadrics as if their transform scaled
 * uniformly. */
static double shape_area(const vlShapeDef *d) {
  vlMat4 m = vl_mat4_load(d->group_from_shape);
  double r = d->radius, turn = d->phi_max, scale = vl_mat4_scale_of(&m), sum = 0;
  if (d->kind == VL_SHAPE_SPHERE || d->kind == VL_SHAPE_CYLINDER)
    return turn * r * ((double)d->z_max - (double)d->z_min) * scale * scale;
  if (d->kind == VL_SHAPE_DISK)
    return 0.5 * turn * (r * r - (double)d->inner_radius * (double)d->inner_radius) * scale *
           scale;
  if (!vl_shape_is_mesh(d->kind))
    return NAN;
  uint32_t per = d->kind == VL_SHAPE_TRIANGLES ? 3 : 4;
  for (uint32_t i = 0; i < d->faces; i++) {
    double p[4][3];
    for (uint32_t k = 0; k < per; k++)
      vl_mat4_vertex(&m, d->positions + 3 * (size_t)d->indices[per * (size_t)i + k], p[k]);
    sum += triangle_area((const double(*)[3])p);
    if (per == 4)
      sum += triangle_area((const double(*)[3])(p + 1));
  }
  return sum;
}

/* ---- lights ------------------------------------------------------------------------------ */

double vl_light_def_luminance(const vlSpectrum *s) {
  float dense[VL_LAMBDA_COUNT];
  const float *y = vl_cie_y();
  double sum = 0, own = vl_spectrum_photometric(s, NULL);
  if (vl_spectrum_dense(s, VL_ROLE_ILLUMINANT, dense, NULL) != VL_OK || !(own > 0))
    return 0;
  for (int i = 0; i < VL_LAMBDA_COUNT; i++)
    sum += (double)y[i] * (double)dense[i];
  return sum / own;
}

static bool given(double x) {
  return x == x && x > 0;
}

static vlLightInfo shape_light(const vlScene *s, const vlShapeDef *d) {
  const vlEmissionDef *e = &s->emissions.items[d->emission.index - 1];
  bool meshed = vl_shape_is_mesh(d->kind);
  vlLightInfo info = {.kind = "area", .source = d->source, .faces = meshed ? d->faces : 1};
  info.image = e->image || e->texture.index;
  info.power = given(e->power) ? e->power * (double)info.faces
               : info.image    ? NAN
                               : M_PI * shape_area(d) * vl_light_def_luminance(&e->radiance) *
                                  (double)e->scale * (e->two_sided ? 2 : 1);
  return info;
}

static vlLightInfo light(const vlScene *s, const vlLightDef *l) {
  vlLightInfo info = {.kind = vl_kind_row(&vl_light_family, (int)l->kind)->name,
                      .source = l->source};
  double low[3], high[3], radius2 = 0;
  info.image = l->path || l->image;
  vl_scene_bounds(s, low, high);
  for (int k = 0; k < 3; k++)
    radius2 += high[k] > low[k] ? 0.25 * (high[k] - low[k]) * (high[k] - low[k]) : 0;
  info.power =
      vl_light_power(l, vl_light_def_luminance(&l->color) * (double)l->scale, sqrt(radius2));
  return info;
}

uint32_t vl_scene_light_count(const vlScene *s) {
  size_t n = s->lights.count - vl_scene_removed_count(&s->light_marks);
  for (size_t i = 0; i < s->shapes.count; i++)
    n += s->shapes.items[i].emission.index != 0;
  return (uint32_t)n;
}

vlResult vl_scene_light_info(const vlScene *s, uint32_t index, vlLightInfo *info) {
  if (!s || !info)
    return VL_ERROR_ARGUMENT;
  size_t left = index;
  for (size_t i = 0; i < s->lights.count; i++)
    if (!vl_scene_light_is_removed(s, i) && left-- == 0) {
      *info = light(s, &s->lights.items[i]);
      return VL_OK;
    }
  for (size_t i = 0; i < s->shapes.count; i++)
    if (s->shapes.items[i].emission.index && left-- == 0) {
      *info = shape_light(s, &s->shapes.items[i]);
      return VL_OK;
    }
  return VL_ERROR_ARGUMENT;
}
