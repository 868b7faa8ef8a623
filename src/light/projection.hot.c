/* light/projection.hot.c: projection lights: a point that projects an image along its
 * axis (pbrt book 12.2.2). */
#include "light/kinds.hot.h"

vlSampleLight vl_light_sample_projection;
vlEmitLight vl_light_emit_projection;
vlLightDensity vl_light_emit_pdf_projection;

/* Least cosine to the axis of a projected direction: pbrt's near plane. */
#define PROJECTION_NEAR 1e-3f

/* Returns 1 if the image covers direction d, and sets *st to the position in the image's unit
 * square; else returns 0. */
static float image_point(const vlWorldLight *light, vlVec3 d, vlVec2 *st) {
  vlVec3 local = vl_normalize(vl_light_local(light, d));
  *st = (vlVec2){0, 0};
  float x = local.x / local.z / light->own[0], y = local.y / local.z / light->own[1];
  if (!(local.z > PROJECTION_NEAR) || !(vl_abs(x) <= 1.0f) || !(vl_abs(y) <= 1.0f))
    return 0.0f;
  *st = (vlVec2){0.5f * (x + 1.0f), 0.5f * (y + 1.0f)};
  return 1.0f;
}

/* 1 - cosine of the half angle of a cone around the image. */
static float image_span(const vlWorldLight *light) {
  return vl_min(1.001f * (1.0f - light->cos_end), 2.0f);
}

void vl_light_sample_projection(const vlLightQuery *q, vlLightSample *out) {
  vlVec2 st;
  float factor = vl_light_towards_point(q, out);
  factor *= image_point(q->light, vl_neg(out->w), &st);
  vl_light_emission(q->world, q->emitted, q->lambda, st, factor, out->radiance);
}

void vl_light_emit_projection(const vlEmissionQuery *q, vlEmission *out) {
  float span = image_span(q->light), factor = 2.0f * VL_PI * span;
  vlVec2 st;
  vl_light_emit_from_point(q, span, out);
  factor *= image_point(q->light, out->d, &st);
  vl_light_emission(q->world, q->emitted, q->lambda, st, factor, out->flux);
}

float vl_light_emit_pdf_projection(const vlWorld *world, const vlWorldLight *light, float p,
                                   vlVec3 w, float distance, const vlPoint *at) {
  (void)world;
  (void)at;
  return vl_light_emit_pdf_from_point(light, image_span(light), p, w, distance);
}
