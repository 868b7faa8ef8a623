/* scene/lamps.c: see lamps.h. */
#include "scene/lamps.h"

#include <math.h>

#include "base/free.h"
#include "base/unset.h"
#include "math/double3.h"
#include "math/elementary.h"
#include "math/transform.h"
#include "schema/schema.h"
#include "velo/light.h"
#include "velo/shape_kinds.h"

/* A histogram of illuminances: bins of a quarter of a stop. */
enum { STOPS = 64, PER_STOP = 4, BINS = 2 * STOPS * PER_STOP };

typedef struct Meter {
  const vlScene *scene;
  double *strength; /* of each light: lux, or candela */
  uint64_t bins[BINS], count;
} Meter;

static double lit_by(const vlLightDef *l, double strength, const double p[3]) {
  if (l->kind == VL_LIGHT_INFINITE)
    return 0;
  if (l->kind == VL_LIGHT_DISTANT)
    return strength;
  double d[3], axis[3], d2 = 0, a2 = 0, along = 0, at[3];
  const double from[3] = {l->from[0], l->from[1], l->from[2]};
  vlMat4 m = vl_mat4_load(l->world_from_light);
  vl_mat4_point(&m, from, at);
  for (int i = 0; i < 3; i++)
    axis[i] = (double)l->to[i] - from[i];
  vl_mat4_vector(&m, axis, axis);
  for (int i = 0; i < 3; i++) {
    d[i] = p[i] - at[i];
    d2 += d[i] * d[i];
    a2 += axis[i] * axis[i];
    along += d[i] * axis[i];
  }
  if (!(d2 > 0))
    return 0;
  bool outside =
      l->kind == VL_LIGHT_SPOT && along < vl_precise_cos((double)l->cone_angle) * sqrt(d2 * a2);
  return outside ? 0 : strength / d2;
}

static void count(Meter *m, double sum) {
  if (!(sum > 0) || !isfinite(sum))
    return;
  double bin = PER_STOP * (vl_precise_log2(sum) + STOPS);
  m->bins[bin < 0 ? 0 : bin >= BINS ? BINS - 1 : (int)bin]++;
  m->count++;
}

static void meter(void *user, const double p[3]) {
  Meter *m = user;
  double sum = 0;
  for (size_t i = 0; i < m->scene->lights.count; i++)
    sum += lit_by(&m->scene->lights.items[i], m->strength[i], p);
  count(m, sum);
}

/* The median of what was counted; 0: nothing was. */
static double median(const Meter *m) {
  uint64_t below = 0;
  for (int i = 0; i < BINS; i++) {
    below += m->bins[i];
    if (2 * below >= m->count && m->count)
      return vl_precise_exp2((i + 0.5) / PER_STOP - STOPS);
  }
  return 0;
}

double vl_lamp_illuminance(const vlScene *scene, const vlExtent *boxes) {
  Meter m = {.scene = scene};
  if (scene->lights.count == 0)
    return 0;
  m.strength = vl_alloc_zero(scene->context, scene->lights.count, sizeof *m.strength);
  if (!m.strength)
    return 0;
  for (size_t i = 0; i < scene->lights.count; i++) {
    const vlLightDef *l = &scene->lights.items[i];
    if (!vl_scene_light_is_removed(scene, i))
      m.strength[i] = vl_light_def_luminance(&l->color) * (double)l->scale;
  }
  vl_extent_visit(scene, boxes, NULL, meter, &m);
  vl_free(scene->context, m.strength);
  return median(&m);
}

/* ---- surfaces ---------------------------------------------------------------------------- */

/* A surface that emits light, as a point light. */
typedef struct Emitter {
  double middle[3], candela, area;
} Emitter;

typedef struct EmitterMeter {
  Meter meter;
  Emitter *emitters;
  size_t count;
} EmitterMeter;

static double area_of(const vlShapeDef *d, const vlMat4 *m) {
  double sum = 0;
  for (size_t face = 0; face < d->faces; face++) {
    double p[3][3], n[3];
    vl_mesh_face(d, m, face, p, n);
    sum += 0.5 * vl_norm3(n);
  }
  return sum;
}

/* False: the shape is no lamp. */
static bool take_emitter(const vlScene *scene, const vlShapeDef *d, Emitter *emitter) {
  if (!d->emission.index || d->group.index || d->kind != VL_SHAPE_TRIANGLES || !d->positions ||
      !d->indices)
    return false;
  const vlEmissionDef *e = &scene->emissions.items[d->emission.index - 1];
  const double radiance = vl_light_def_luminance(&e->radiance) * (double)e->scale;
  if (e->image || e->texture.index || !vl_is_unset(e->power) || !(radiance > 1))
    return false;
  const vlMat4 m = vl_mat4_load(d->group_from_shape);
  vlExtent box = vl_extent_nothing;
  vl_extent_visit_shape(d, NULL, vl_extent_grow, &box);
  vl_extent_middle(&box, emitter->middle);
  emitter->area = area_of(d, &m);
  emitter->candela = radiance * emitter->area;
  return true;
}

static void meter_emitters(void *user, const double p[3]) {
  EmitterMeter *m = user;
  double sum = 0;
  for (size_t i = 0; i < m->count; i++) {
    const Emitter *g = &m->emitters[i];
    double d2 = g->area / M_PI; /* no more than beside a plane of it */
    for (int k = 0; k < 3; k++)
      d2 += (p[k] - g->middle[k]) * (p[k] - g->middle[k]);
    sum += d2 > 0 ? g->candela / d2 : 0;
  }
  count(&m->meter, sum);
}

double vl_surface_illuminance(const vlScene *scene, const vlExtent *boxes) {
  const size_t shapes = scene->shapes.count;
  EmitterMeter m = {.meter = {.scene = scene}};
  if (scene->emissions.count == 0 || shapes == 0)
    return 0;
  bool *lamps = vl_alloc_array(scene->context, shapes, sizeof *lamps);
  m.emitters = vl_alloc_array(scene->context, shapes, sizeof *m.emitters);
  for (size_t i = 0; i < shapes && lamps && m.emitters; i++) {
    lamps[i] = take_emitter(scene, &scene->shapes.items[i], &m.emitters[m.count]);
    m.count += lamps[i];
  }
  if (m.count)
    vl_extent_visit(scene, boxes, lamps, meter_emitters, &m);
  VL_FREE(scene->context, lamps, m.emitters);
  return median(&m.meter);
}
