/* light/projection.hot.c: projection lights: a point that projects an image along its
 * axis (pbrt book 12.2.2). */
#include "light/kinds.hot.h"

vlSampleLight vl_light_sample_projection;
vlEmitLight vl_light_emit_projection;
vlLightDensity vl_light_emit_pdf_projection;

/* Least cosine to the axis of a projected direction: pbrt's near plane. */
#define PROJECTION_NEAR 1e-3f

/* Returns 1 if the image covers a direction, and sets *st to the position in the image's unit
 * square; else returns 0. local: the direction in the light's frame, not normalized. */
static float image_point(const vlWorldLight *light, vlVec3 local, vlVec2 *st) {
  local = vl_normalize(local);
  *st = (vlVec2){0, 0};
  float x = local.x / local.z / light->own[0], y = local.y / local.z / light->own[1];
  if (!(local.z > PROJECTION_NEAR) || !(vl_abs(x) <= 1.0f) || !(vl_abs(y) <= 1.0f))
    return 0.0f;
  *st = (vlVec2){0.5f * (x + 1.0f), 0.5f * (y + 1.0f)};
  return 1.0f;
}

/* Density per solid angle of light paths, which are spread evenly over the image in the plane
 * z = 1. local: as above. */
static float image_density(const vlWorldLight *light, vlVec3 local) {
  float cosine = local.z / vl_length(local);
  float area = 4.0f * light->own[0] * light->own[1];
  return vl_light_stretch(light, local) / (area * cosine * cosine * cosine);
}

void vl_light_sample_projection(const vlLightQuery *q, vlLightSample *out) {
  vlVec2 st;
  float factor = vl_light_towards_point(q, out);
  factor *= image_point(q->light, vl_light_local(q->light, vl_neg(out->w)), &st);
  vl_light_emission(q->world, q->emitted, q->lambda, st, factor, out->radiance);
}

void vl_light_emit_projection(const vlEmissionQuery *q, vlEmission *out) {
  const vlWorldLight *light = q->light;
  vlVec2 st;
  float x = (2.0f * q->s - 1.0f) * light->own[0], y = (2.0f * q->t - 1.0f) * light->own[1];
  vlVec3 d = vl_light_from_local(light, vl_vec3(x, y, 1.0f)), local = vl_light_local(light, d);
  vl_light_emit_along(q, d, image_density(light, local), out);
  float factor = image_point(light, local, &st) / out->density;
  vl_light_emission(q->world, q->emitted, q->lambda, st, factor, out->flux);
}

float vl_light_emit_pdf_projection(VL_UNUSED const vlWorld *world, const vlWorldLight *light,
                                   float p, vlVec3 w, float distance,
                                   VL_UNUSED const vlPoint *at) {
  vlVec2 st;
  vlVec3 local = vl_light_local(light, vl_neg(w));
  if (image_point(light, local, &st) == 0.0f)
    return 0.0f;
  return p * image_density(light, local) / (distance * distance);
}
