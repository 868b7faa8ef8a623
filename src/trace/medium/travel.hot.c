/* trace/medium/travel.hot.c: what camera rays, bounces and shadow rays have in common on their
 * way through media and interfaces (trace/medium/volume.h). */
#include "trace/medium/volume.h"

void vl_travel_start(vlTravel *k) {
  __builtin_memset(k, 0, sizeof *k);
  for (uint32_t i = 0; i < VL_FLIGHTS; i++)
    k->f.medium[i] = VL_NONE;
}

void vl_travel_closest(const vlTracing *t, vlTravel *k) {
  const vlRays *r = &k->f.rays;
  VL_ROW float o[3][VL_FLIGHTS], d[3][VL_FLIGHTS], t_min[VL_FLIGHTS], t_max[VL_FLIGHTS],
      time[VL_FLIGHTS];
  VL_ROW uint32_t shape[VL_FLIGHTS], prim[VL_FLIGHTS], instance[VL_FLIGHTS];
  VL_ROW float hit[VL_FLIGHTS];
  if (k->count == 0)
    return;
  for (uint32_t j = 0; j < k->count; j++) {
    uint32_t i = k->open[j];
    o[0][j] = r->ox[i];
    o[1][j] = r->oy[i];
    o[2][j] = r->oz[i];
    d[0][j] = r->dx[i];
    d[1][j] = r->dy[i];
    d[2][j] = r->dz[i];
    t_min[j] = k->f.from[i];
    if (r->t_max)
      t_max[j] = r->t_max[i];
    if (r->time)
      time[j] = r->time[i];
  }
  vlRays rays = {o[0],
                 o[1],
                 o[2],
                 d[0],
                 d[1],
                 d[2],
                 t_min,
                 r->t_max ? t_max : NULL,
                 r->time ? time : NULL};
  vl_accel_closest(t->world, k->count, &rays, false, shape, prim, instance, hit);
  for (uint32_t j = 0; j < k->count; j++) {
    uint32_t i = k->open[j];
    k->x.shape[i] = shape[j];
    k->x.prim[i] = prim[j];
    k->x.instance[i] = instance[j];
    k->x.hit[i] = hit[j];
  }
}

uint32_t vl_travel_pass(const vlTracing *t, vlTravel *k, uint32_t i, uint32_t medium) {
  const vlRays *r = &k->f.rays;
  const vlCrossings *x = &k->x;
  vlVec3 d = vl_lane3(r->dx, r->dy, r->dz, i), g = vl_lane3(x->gx, x->gy, x->gz, i);
  if (t->def->fit)
    vl_fit_border(t, k->f.paths->lane[k->f.path[i]], x->shape[i], g, d, medium);
  k->f.from[i] = vl_past_crossing(x->t[i], g, x->offset[i], d, k->f.from[i]);
  return vl_medium_beyond(&t->world->shapes.items[x->shape[i]], g, d, medium);
}
