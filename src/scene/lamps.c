/* scene/lamps.c: see lamps.h. */
#include "scene/lamps.h"

#include <math.h>

#include "math/elementary.h"
#include "math/transform.h"
#include "schema/schema.h"
#include "velo/light.h"

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

static void meter(void *user, const double p[3]) {
  Meter *m = user;
  double sum = 0;
  for (size_t i = 0; i < m->scene->lights.count; i++)
    sum += lit_by(&m->scene->lights.items[i], m->strength[i], p);
  if (!(sum > 0) || !isfinite(sum))
    return;
  double bin = PER_STOP * (vl_precise_log2(sum) + STOPS);
  m->bins[bin < 0 ? 0 : bin >= BINS ? BINS - 1 : (int)bin]++;
  m->count++;
}

double vl_lamp_illuminance(const vlScene *scene, const vlExtent *boxes) {
  Meter m = {.scene = scene};
  if (scene->lights.count == 0)
    return 0;
  m.strength = vl_alloc_array(scene->context, scene->lights.count, sizeof *m.strength);
  if (!m.strength)
    return 0;
  for (size_t i = 0; i < scene->lights.count; i++) {
    const vlLightDef *l = &scene->lights.items[i];
    m.strength[i] = vl_light_def_luminance(&l->color) * (double)l->scale;
  }
  vl_extent_visit(scene, boxes, NULL, meter, &m);
  vl_free(scene->context, m.strength);
  uint64_t below = 0;
  for (int i = 0; i < BINS; i++) {
    below += m.bins[i];
    if (2 * below >= m.count && m.count)
      return vl_precise_exp2((i + 0.5) / PER_STOP - STOPS);
  }
  return 0;
}
