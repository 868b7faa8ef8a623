/* trace/medium/volume_shadow.hot.c: shadow rays through participating media and interfaces: the radiance of light
 * samples, with MIS weights against BSDF and phase-function sampling (pbrt book 14.2.3). */
#include "trace/medium/volume.h"

uint32_t vl_volume_push_shadow(vlTracing *t, const vlPaths *p, const vlVolumeRows *rows, uint32_t i, vlVec3 o,
                               const float value[4], float pdf, uint32_t medium, uint32_t count) {
  vlShadowRays *q = &t->s->shadow;
  const vlLightSamples *l = &t->s->light;
  vlVolumeScratch *v = &t->s->volume;
  vlVec3 w = vl_lane3(l->wx, l->wy, l->wz, i);
  float length = VL_INFINITY;
  if (!l->distant[i]) { /* unit length: distances to interfaces are needed */
    vlVec3 to = vl_sub(vl_lane3(l->tx, l->ty, l->tz, i), o);
    length = vl_length(to);
    w = vl_normalize(to);
  }
  q->ox[count] = o.x, q->oy[count] = o.y, q->oz[count] = o.z;
  q->dx[count] = w.x, q->dy[count] = w.y, q->dz[count] = w.z;
  q->t_max[count] = length * (1.0f - 0x1p-21f);
  for (int c = 0; c < 4; c++) {
    q->radiance[c][count] = p->beta[c][i] * value[c] * l->radiance[c][i] * l->pdf[i];
    v->density[c][count] = rows->u[c][i];
  }
  v->light_pdf[count] = l->pdf[i];
  v->pdf[count] = l->delta[i] ? 0.0f : pdf;
  v->shadow_medium[count] = medium;
  v->from[count] = i;
  q->time[count] = vl_path_time(p, i);
  q->lane[count] = p->lane[i];
  vl_shadow_from_medium(t, count, p->lane[i]);
  return count + 1;
}

/* Multiplies f->beta by the transmittance of shadow ray k through media and interfaces, and updates its densities. */
static void pass_media(vlTracing *t, uint32_t k, vlFlight *f) {
  const vlWorld *world = t->world;
  const vlShadowRays *q = &t->s->shadow;
  vlVec3 o = vl_lane3(q->ox, q->oy, q->oz, k), d = vl_lane3(q->dx, q->dy, q->dz, k);
  uint32_t medium = t->s->volume.shadow_medium[k];
  float t_min = 0.0f;
  for (int step = 0; step < 1024; step++) {
    uint32_t shape = VL_NONE, prim = 0, instance = VL_NONE;
    float t_hit = 0.0f;
    vlRays ray = {q->ox + k, q->oy + k,    q->oz + k,
                  q->dx + k, q->dy + k,    q->dz + k,
                  &t_min,    q->t_max + k, t->s->a.time ? q->time + k : NULL};
    if (world->has_interfaces) {
      vl_accel_closest(world, 1, &ray, false, &shape, &prim, &instance, &t_hit);
      t->batch->shadow_rays++;
    }
    if (shape != VL_NONE && !vl_is_interface(world, shape)) break; /* cannot happen: the ray is not occluded */
    vlPoint at = {.t = q->t_max[k]};
    if (shape != VL_NONE) at = vl_point_at_time(world, q->time[k], o, d, shape, prim, instance, t_hit);
    if (medium != VL_NONE) vl_attenuate(&world->media.items[medium], o, d, t_min, at.t, f);
    if (shape == VL_NONE || !(vl_max(vl_max(f->beta[0], f->beta[1]), vl_max(f->beta[2], f->beta[3])) > 0.0f)) return;
    medium = vl_medium_beyond(&world->shapes.items[shape], at.g, d, medium);
    t_min = vl_past_surface(&at, d, t_min);
  }
  for (int c = 0; c < 4; c++) f->beta[c] = 0.0f;
}

vlFlight vl_volume_shadow_flight(vlTracing *t, const vlPaths *p, const vlVolumeRows *rows, uint32_t k, uint32_t depth) {
  bool vacuum = t->s->volume.shadow_medium[k] == VL_NONE && !t->world->has_interfaces;
  vlFlight f = vacuum ? (vlFlight){.channels = vl_volume_rgb(t) ? 3 : 4, .odds = 1.0f}
                      : vl_volume_flight(t, p, rows, t->s->volume.from[k], depth, VL_KEY_SHADOW);
  for (int c = 0; c < 4; c++) f.beta[c] = f.u[c] = f.l[c] = 1.0f;
  for (int c = 0; t->world->by_channel && c < 3; c++) f.passed[c] = t->s->volume.shadow_passed[c][k];
  if (!vacuum) pass_media(t, k, &f);
  f.odds = vl_some_odds(f.odds);
  return f;
}

void vl_volume_shadows(vlTracing *t, const vlPaths *p, const vlVolumeRows *rows, uint32_t count, uint32_t depth) {
  vlShadowRays *q = &t->s->shadow;
  const vlVolumeScratch *v = &t->s->volume;
  vlRays rays = {q->ox, q->oy, q->oz, q->dx, q->dy, q->dz, NULL, q->t_max, p->time ? q->time : NULL};
  vl_accel_occluded(t->world, count, &rays, q->occluded);
  t->batch->shadow_rays += count;
  if (t->batch->recorder) vl_volume_record_shadows(t, p, rows, count, depth);
  for (uint32_t k = 0; k < count; k++) {
    if (q->occluded[k]) continue;
    vlFlight f = vl_volume_shadow_flight(t, p, rows, k, depth);
    float inv = 1.0f / vl_volume_shadow_density(v, &f, k, v->pdf[k]);
    for (int c = 0; c < 4; c++) t->batch->radiance[c][q->lane[k]] += q->radiance[c][k] * f.beta[c] * inv;
  }
}
