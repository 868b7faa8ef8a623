/* light/point.hot.c: point lights with the same intensity in all directions (pbrt book
 * 12.2). */
#include "light/kinds.hot.h"

vlSampleLight vl_light_sample_point;
vlEmitLight vl_light_emit_point;
vlLightDensity vl_light_emit_pdf_point;

void vl_light_sample_point(const vlLightQuery *q, vlLightSample *out) {
  float factor = vl_light_towards_point(q, out);
  vl_light_emission(q->world, q->emitted, q->lambda, (vlVec2){0, 0}, factor, out->radiance);
}

void vl_light_emit_point(const vlEmissionQuery *q, vlEmission *out) {
  const float span = 2.0f;
  vl_light_emit_from_point(q, span, out);
  vl_light_emission(q->world, q->emitted, q->lambda, (vlVec2){0, 0}, 2.0f * VL_PI * span,
                    out->flux);
}

float vl_light_emit_pdf_point(VL_UNUSED const vlWorld *world, const vlWorldLight *light,
                              float p, vlVec3 w, float distance, VL_UNUSED const vlPoint *at) {
  return vl_light_emit_pdf_from_point(light, 2.0f, p, w, distance);
}
