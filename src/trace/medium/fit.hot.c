/* trace/medium/fit.hot.c: whether the media of a world fit together: every segment of a path
 * has the same medium from both of its ends. Camera paths take the medium from the surfaces
 * that they cross, so in a world whose media do not fit, light paths would find other media
 * than camera paths do. Each border of media (a shape that names two) tells the medium on the
 * side from which a path arrives, and so does each light; vlTraceDef.fit records where the
 * path's medium is another. */
#include "trace/medium/volume.h"

static void note(const vlTracing *t, uint32_t lane, uint32_t expected, uint32_t medium) {
  vlMediaFit *fit = t->def->fit;
  if (expected == medium || fit->wrong[lane])
    return;
  fit->wrong[lane] = 1;
  for (int c = 0; c < 4; c++)
    fit->before[c][lane] = t->batch->radiance[c][lane];
}

void vl_fit_border(const vlTracing *t, uint32_t lane, uint32_t shape, vlVec3 g, vlVec3 d,
                   uint32_t medium) {
  note(t, lane, vl_medium_beyond(&t->world->shapes.items[shape], g, vl_neg(d), medium), medium);
}

void vl_fit_endless(const vlTracing *t, uint32_t medium) {
  vlMediaFit *fit = t->def->fit;
  fit->endless += fit->has_sky && medium != fit->sky_medium;
}

void vl_fit_surfaces(const vlTracing *t, uint32_t n, const vlVertices *at,
                     const vlVolumeRows *rows) {
  const vlSurface *f = &at->surface;
  const vlPaths *p = &at->paths;
  for (uint32_t i = 0; i < n; i++)
    vl_fit_border(t, p->lane[i], at->hits.shape[i], vl_row3(&f->g, i), vl_row3(&p->d, i),
                  rows->medium[i]);
}

/* The medium from which shadow ray k meets the shape of its area light. `here`: if the shape is
 * no border. */
static uint32_t before_light(const vlTracing *t, const vlShadowRays *q, uint32_t k,
                             uint32_t light_shape, uint32_t here) {
  vlVec3 o = vl_row3(&q->o, k), d = vl_row3(&q->d, k);
  float from = 0.999f * q->t_max[k], to = 1.001f * q->t_max[k], hit, time = q->time[k];
  uint32_t shape, prim, instance;
  vlRays ray = vl_one_ray(&o, &d, &from, &to, t->world->moves ? &time : NULL);
  vl_accel_closest(t->world, 1, &ray, false, &shape, &prim, &instance, &hit);
  if (shape != light_shape)
    return here;
  vlPoint at = vl_point_at_time(t->world, time, o, d, shape, prim, instance, hit);
  return vl_medium_beyond(&t->world->shapes.items[shape], at.g, vl_neg(d), here);
}

void vl_fit_shadows(const vlTracing *t, uint32_t count, const vlLightSamples *samples,
                    const vlShadowRays *q, const vlShadowFlights *f) {
  for (uint32_t k = 0; k < count; k++) {
    float passes = vl_largest4(f->beta[0][k], f->beta[1][k], f->beta[2][k], f->beta[3][k]);
    if (q->occluded[k] || !(passes > 0.0f))
      continue; /* without transmittance, it ended on the way */
    uint32_t number = samples->light[f->from[k]], medium = f->medium[k];
    const vlWorldShape *shape = NULL;
    const vlWorldLight *light = &t->world->lights.items[number];
    if (light->shape != VL_NONE)
      shape = &t->world->shapes.items[light->shape];
    bool border = shape && shape->inside != shape->outside;
    note(t, q->lane[k],
         border ? before_light(t, q, k, light->shape, medium)
                : t->def->fit->light_medium[number],
         medium);
  }
}
