/* light/spot.hot.c: spot lights: a point that emits into a cone with a smooth edge (pbrt
 * book 12.2.1). */
#include "light/kinds.hot.h"

vlSampleLight vl_light_sample_spot;
vlEmitLight vl_light_emit_spot;
vlLightDensity vl_light_emit_pdf_spot;

/* The spot's falloff: 1 inside the inner cone, 0 outside the outer cone, smooth between them.
 * c: cosine with the axis. */
static float edge(const vlWorldLight *light, float c) {
  float a = light->cos_end, b = light->cos_start;
  if (a == b)
    return c < a ? 0.0f : 1.0f;
  float t = vl_clamp((c - a) / (b - a), 0.0f, 1.0f);
  return light->cone_squared ? t * t : t * t * (3.0f - 2.0f * t);
}

void vl_light_sample_spot(const vlLightQuery *q, vlLightSample *out) {
  float factor = vl_light_towards_point(q, out);
  factor *= edge(q->light, -vl_dot(out->w, vl_light_axis(q->light)));
  vl_emitted_at(q->world, q->emitted, q->lambda, 0, 0, false, out->radiance);
  for (int c = 0; c < 4; c++)
    out->radiance[c] *= factor;
}

void vl_light_emit_spot(const vlEmissionQuery *q, vlEmission *out) {
  float span = 1.0f - q->light->cos_end, factor = 2.0f * VL_PI * span;
  float cosine = vl_light_emit_from_point(q, span, out);
  if (span == 2.0f)
    cosine = vl_dot(out->d, vl_light_axis(q->light));
  factor *= edge(q->light, cosine);
  vl_emitted_at(q->world, q->emitted, q->lambda, 0, 0, false, out->flux);
  for (int c = 0; c < 4; c++)
    out->flux[c] *= factor;
}

float vl_light_emit_pdf_spot(const vlWorld *world, const vlWorldLight *light, float p, vlVec3 w,
                             float distance, const vlPoint *at) {
  (void)world;
  (void)at;
  return vl_light_emit_pdf_from_point(light, 1.0f - light->cos_end, p, w, distance);
}
