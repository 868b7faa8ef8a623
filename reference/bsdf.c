/* bsdf.c: the kinds of BSDFs by name, and the simplest of them. */
#include "bsdf.h"

#include "more/more.h"

/* A diffuse surface looks equally bright from everywhere: f = reflectance / pi, on the side that the light comes from.
 */
static spectrum diffuse_value(const bsdf *b, vector wo, vector wi, double *density) {
  *density = wo.z * wi.z > 0 ? fabs(wi.z) / PI : 0;
  return scaled(*density, b->reflectance);
}

static spectrum local_value(const bsdf *b, vector wo, vector wi, sampler *s, double *density) {
  *density = 0;
  switch (b->kind) {
    case BSDF_DIFFUSE: return diffuse_value(b, wo, wi, density);
    case BSDF_CONDUCTOR: return conductor_value(b, wo, wi, density);
    case BSDF_DIELECTRIC: return dielectric_value(b, wo, wi, density);
    case BSDF_PHASE: return gray(*density = phase(b->g, wo, wi));
    default: return more_bsdf_value(b, wo, wi, s, density);
  }
}

static bool sample_direction(const bsdf *b, vector wo, sampler *s, bsdf_sample *result) {
  switch (b->kind) {
    case BSDF_DIFFUSE: result->wi = face_forward(sample_cosine_hemisphere(s), make_vector(0, 0, wo.z)); return true;
    case BSDF_CONDUCTOR: sample_conductor(b, wo, s, result); return true;
    case BSDF_DIELECTRIC: return sample_dielectric(b, wo, s, result);
    case BSDF_PHASE: result->wi = sample_phase(b->g, s); return true;
    default: return sample_more_bsdf(b, wo, s, result);
  }
}

spectrum bsdf_value(const bsdf *b, vector wo, vector wi, sampler *s, double *density) {
  return local_value(b, to_local(b->frame, wo), to_local(b->frame, wi), s, density);
}

bool sample_bsdf(const bsdf *b, vector wo, sampler *s, bsdf_sample *result) {
  vector o = to_local(b->frame, wo);
  *result = (bsdf_sample){.weight = gray(1), .density = 1};
  if (o.z == 0 || !sample_direction(b, o, s, result)) return false;
  if (!result->specular) {
    spectrum value = local_value(b, o, result->wi, s, &result->density);
    if (!(result->density > 0)) return false;
    result->weight = scaled(1 / result->density, value);
  }
  result->wi = normalize(from_local(b->frame, result->wi));
  return true;
}
