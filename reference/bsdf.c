/* bsdf.c: the kinds of BSDFs by name, and the simplest of them. */
#include "bsdf.h"

#include "more/more.h"

/* A diffuse surface looks equally bright from everywhere on the light's side: f = reflectance / pi. */
static spectrum diffuse_value(const bsdf *b, vector wo, vector wi, double *density) {
  *density = wo.z * wi.z > 0 ? fabs(wi.z) / PI : 0;
  return scaled(*density, b->reflectance); /* f times the cosine */
}

spectrum bsdf_value(const bsdf *b, vector wo, vector wi, sampler *s, double *density) {
  vector o = to_local(b->frame, wo), i = to_local(b->frame, wi);
  *density = b->kind == BSDF_PHASE ? phase(b->g, o, i) : 0;
  switch (b->kind) {
    case BSDF_DIFFUSE: return diffuse_value(b, o, i, density);
    case BSDF_CONDUCTOR: return conductor_value(b, o, i, density);
    case BSDF_DIELECTRIC: return dielectric_value(b, o, i, density);
    case BSDF_PHASE: return gray(*density);
    default: return more_bsdf_value(b, o, i, s, density);
  }
}

static bool sample_direction(const bsdf *b, vector wo, sampler *s, bsdf_sample *result) {
  if (b->kind == BSDF_DIELECTRIC) return sample_dielectric(b, wo, s, result);
  if (b->kind == BSDF_MORE) return sample_more_bsdf(b, wo, s, result);
  if (b->kind == BSDF_CONDUCTOR) sample_conductor(b, wo, s, result);
  if (b->kind == BSDF_DIFFUSE) result->wi = face_forward(sample_cosine_hemisphere(s), make_vector(0, 0, wo.z));
  if (b->kind == BSDF_PHASE) result->wi = sample_phase(b->g, s);
  return true;
}

bool sample_bsdf(const bsdf *b, vector wo, sampler *s, bsdf_sample *result) {
  *result = (bsdf_sample){.weight = gray(1), .density = 1};
  if (!sample_direction(b, to_local(b->frame, wo), s, result)) return false;
  result->wi = normalize(from_local(b->frame, result->wi));
  if (result->specular) return true;
  spectrum value = bsdf_value(b, wo, result->wi, s, &result->density);
  result->weight = scaled(1 / result->density, value);
  return result->density > 0;
}
