/* medium/cloud.hot.c: the density of a cloud. vlWorldMedium.own holds its parameters: a factor
 * of the noise, wispiness, frequency. */
#include "math/noise.h"
#include "medium/lookup.h"

vlMediumDensity vl_medium_density_cloud;

/* pbrt-v4's procedural cloud (the last medium of book 11.4.2): fractal noise, distorted by
 * wisps, thinner with height. */
float vl_medium_density_cloud(const vlWorldMedium *m, vlVec3 p, VL_UNUSED vlVec3 unit) {
  const float density = m->own[0], wispiness = m->own[1];
  vlVec3 q = vl_mul(p, m->own[2]);
  float omega = 0.05f * wispiness, frequency = 10.0f;
  for (int i = 0; wispiness > 0.0f && i < 2; i++) {
    vlVec3 at = vl_mul(q, frequency);
    const float delta = 0.01f;
    float n = vl_noise(at.x, at.y, at.z);
    vlVec3 slope = vl_vec3((vl_noise(at.x + delta, at.y, at.z) - n) / delta,
                           (vl_noise(at.x, at.y + delta, at.z) - n) / delta,
                           (vl_noise(at.x, at.y, at.z + delta) - n) / delta);
    q = vl_add(q, vl_mul(slope, omega));
    omega *= 0.5f;
    frequency *= 1.99f;
  }
  float sum = 0;
  omega = 0.5f;
  frequency = 1.0f;
  for (int i = 0; i < 5; i++) {
    sum += omega * vl_noise(frequency * q.x, frequency * q.y, frequency * q.z);
    omega *= 0.5f;
    frequency *= 1.99f;
  }
  float d = vl_clamp((1.0f - p.y) * 4.5f * density * sum, 0.0f, 1.0f);
  return vl_clamp(d + 2.0f * vl_max(0.0f, 0.5f - p.y), 0.0f, 1.0f);
}
