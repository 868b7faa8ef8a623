/* trace/medium/phase.h: the phase function of Henyey and Greenstein (1941; pbrt book 11.3.1).
 * It is normalised over the sphere and sampled exactly, so its value is also its density. */
#ifndef TRACE_MEDIUM_PHASE_H
#define TRACE_MEDIUM_PHASE_H

#include "math/warp.h"

/* Value per steradian. cosine: of the angle between the directions of flight before and after
 * scattering. */
static inline float vl_phase(float g, float cosine) {
  /* at least (1 - |g|)^2 */
  float denominator = vl_max(1.0f + g * g - 2.0f * g * cosine, 1e-12f);
  return VL_INV_4PI * (1.0f - g * g) / (denominator * __builtin_sqrtf(denominator));
}

/* Samples the direction of flight after scattering. d: unit direction of flight before. */
static inline vlVec3 vl_phase_sample(float g, vlVec3 d, float u, float v) {
  float square = (1.0f - g * g) / (1.0f - g + 2.0f * g * u);
  /* first order in g */
  float near = 1.0f - 2.0f * u, cosine = -near + 1.5f * g * (1.0f - near * near);
  /* For smaller |g|, the exact formula subtracts numbers near 1 and has an error of 6e-8 / 2g,
   * which is larger than the error g^2 of the series. */
  if (vl_abs(g) > 1e-3f)
    cosine = (1.0f + g * g - square * square) / (2.0f * g);
  cosine = vl_clamp(cosine, -1.0f, 1.0f);
  float sine = __builtin_sqrtf((1.0f - cosine) * (1.0f + cosine));
  vlSinCos a = vl_sincos_turn(v);
  return vl_normalize(
      vl_from_local(vl_frame_from_z(d), vl_vec3(sine * a.cos, sine * a.sin, cosine)));
}

#endif
