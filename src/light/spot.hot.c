/* light/spot.hot.c: spot lights: a point that emits into a cone with a smooth edge (pbrt
 * book 12.2.1). The cone is round in the light's frame, which may be skewed. */
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

static vlVec3 frame_axis(const vlWorldLight *light) {
  return vl_load3(light->own);
}

/* Cosine between the axis and light that leaves along d (world space), in the light's frame. */
static float axis_cosine(const vlWorldLight *light, vlVec3 d) {
  return light->skewed_cone ? vl_dot(vl_normalize(vl_light_local(light, d)), frame_axis(light))
                            : vl_dot(d, vl_light_axis(light));
}

void vl_light_sample_spot(const vlLightQuery *q, vlLightSample *out) {
  float factor = vl_light_towards_point(q, out);
  factor *= edge(q->light, axis_cosine(q->light, vl_neg(out->w)));
  vl_light_emission(q->world, q->emitted, q->lambda, (vlVec2){0, 0}, factor, out->radiance);
}

/* Samples a ray of a skewed cone, uniformly in the light's frame. Returns the cosine there. */
static float emit_skewed(const vlEmissionQuery *q, float span, vlEmission *out) {
  const vlWorldLight *light = q->light;
  vl_light_emit_from_point(q, span, out);
  vlVec3 local = vl_warp_cone(q->s, q->t, span);
  vlVec3 in_frame = vl_from_local(vl_frame_from_z(frame_axis(light)), local);
  out->d = vl_light_from_local(light, in_frame);
  out->density *= vl_light_stretch(light, vl_light_local(light, out->d));
  return local.z;
}

void vl_light_emit_spot(const vlEmissionQuery *q, vlEmission *out) {
  float span = 1.0f - q->light->cos_end;
  float cosine = q->light->skewed_cone ? emit_skewed(q, span, out)
                                       : vl_light_emit_from_point(q, span, out);
  if (span == 2.0f)
    cosine = axis_cosine(q->light, out->d);
  float factor = q->light->skewed_cone ? 1.0f / out->density : 2.0f * VL_PI * span;
  factor *= edge(q->light, cosine);
  vl_light_emission(q->world, q->emitted, q->lambda, (vlVec2){0, 0}, factor, out->flux);
}

float vl_light_emit_pdf_spot(VL_UNUSED const vlWorld *world, const vlWorldLight *light, float p,
                             vlVec3 w, float distance, VL_UNUSED const vlPoint *at) {
  if (!light->skewed_cone)
    return vl_light_emit_pdf_from_point(light, 1.0f - light->cos_end, p, w, distance);
  float span = 1.0f - light->cos_end;
  vlVec3 d = vl_neg(w);
  if (span < 2.0f && axis_cosine(light, d) < 1.0f - span)
    return 0.0f;
  float density = VL_INV_2PI / span * vl_light_stretch(light, vl_light_local(light, d));
  return p * density / (distance * distance);
}
