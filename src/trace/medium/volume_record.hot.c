/* trace/medium/volume_record.hot.c: records paths through media for vl_trace_paths
 * (tracer/record.h). It computes again what the tracer added. */
#include "trace/medium/volume.h"
#include "tracer/record.h"

static void record_met(vlTracing *t, const vlPaths *p, const vlVolumeRows *rows,
                       VL_UNUSED const vlFlightEnds *ends, uint32_t i, const vlHitLight *met,
                       bool sky) {
  float inv = vl_volume_inverse_density(t, rows, i, met->pdf);
  float weight = inv / vl_volume_inverse_density(t, rows, i, 0.0f);
  vl_record_hit_light(t, p, i, met, sky, weight, inv);
}

static void record_arrival(vlTracing *t, uint32_t i, uint32_t depth, const vlPaths *p,
                           const vlVolumeRows *rows, const vlHits *hits,
                           const vlFlightEnds *x) {
  vlPathVertex *v = vl_record_arrival(t, p, i, depth);
  if (!v)
    return;
  float inv = vl_volume_inverse_density(t, rows, i, 0.0f);
  for (int c = 0; c < 4; c++)
    v->throughput[c] *= inv;
  if (x->event[i] == VL_ON_SURFACE)
    vl_record_surface(t, p, hits, i, v);
  if (x->event[i] != VL_IN_MEDIUM && x->event[i] != VL_AT_END)
    return;
  v->event = VL_PATH_MEDIUM;
  v->fate = VL_PATH_ABSORBED;
  v->medium = rows->medium[i] == VL_NONE ? 0 : rows->medium[i] + 1;
  v->distance = x->t[i];
  vl_store3(v->position, vl_add(vl_row3(&p->o, i), vl_mul(vl_row3(&p->d, i), x->t[i])));
}

void vl_volume_record_travel(vlTracing *t, uint32_t n, uint32_t depth, const vlPaths *p,
                             const vlVolumeRows *rows, const vlHits *hits,
                             const vlFlightEnds *ends) {
  for (uint32_t i = 0; i < n; i++) {
    record_arrival(t, i, depth, p, rows, hits, ends);
    vlPathContribution from_medium = {
        .event = VL_PATH_LIGHT_MEDIUM, .type = "medium", .weight = 1.0f};
    float sum = 0.0f;
    for (int c = 0; c < 4; c++)
      sum += from_medium.radiance[c] = ends->given[c][i];
    if (sum != 0.0f)
      vl_record_light(t, p->lane[i], &from_medium);
  }
  vl_stage_lights_hit(t, n, p, hits, rows, ends, record_met);
  if (depth >= t->def->max_depth)
    vl_record_depth(t, n, p);
}

void vl_volume_record_shadows(vlTracing *t, uint32_t count, const vlLightSamples *l,
                              const vlShadowRays *q, const vlShadowFlights *f) {
  for (uint32_t k = 0; k < count; k++) {
    uint32_t i = f->from[k];
    vlPathContribution c = {.event = VL_PATH_LIGHT_SAMPLED,
                            .occluded = q->occluded[k],
                            .light_pdf = f->light_pdf[k],
                            .bsdf_pdf = f->pdf[k]};
    vl_record_sampled(t->world, l, i, &c);
    float inv = 1.0f / vl_volume_shadow_density(t, f, k, f->pdf[k]);
    c.weight = vl_volume_shadow_density(t, f, k, 0.0f) * inv;
    for (int m = 0; m < 4; m++)
      c.radiance[m] = q->occluded[k] ? 0.0f : q->radiance[m][k] * f->beta[m][k] * inv;
    vl_record_light(t, q->lane[k], &c);
  }
}
