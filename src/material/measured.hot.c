/* material/measured.hot.c: the BSDF of measured materials (material/measured_tables.h). The
 * file's tables sample directions: they warp random numbers by the luminance, then by the
 * visible normals. The code is scalar because nearly all of it is table lookups.
 *
 * For wo below the surface both directions are negated (as in pbrt). */
#include "material/local.hot.h"
#include "material/measured_lookup.h"

vlBsdfEval vl_bsdf_measured_eval;
vlBsdfSample vl_bsdf_measured_sample;

/* wo in the file's frame, and the table slices for it. */
typedef struct Seen {
  vlVec3 o;
  float turn_x, turn_y, turn_z; /* signs that map the lane's directions to the file's */
  float phi, area;              /* reference azimuth; 4 sigma */
  vlMeasuredSlices slices;
} Seen;

static inline float elevation(vlVec3 w) {
  return vl_atan2(__builtin_sqrtf(w.x * w.x + w.y * w.y), w.z);
}
static inline float theta_to_u(float theta) {
  return __builtin_sqrtf(theta * (2.0f * VL_INV_PI));
}
static inline float phi_to_u(float phi) { /* phi may exceed one turn */
  float u = phi * (0.5f * VL_INV_PI) + 0.5f;
  return u - __builtin_floorf(u);
}
static inline float opposite(float x, float side) { /* -1 where x is not on the given side */
  return x * side < 0.0f ? -1.0f : 1.0f;
}

static inline vlVec3 turned(const Seen *s, vlVec3 w) {
  return vl_vec3(w.x * s->turn_x, w.y * s->turn_y, w.z * s->turn_z);
}

/* o.z must not be 0. */
static inline Seen seen_from(const vlMeasured *m, vlVec3 o) {
  Seen s;
  s.turn_x = s.turn_y = s.turn_z = o.z < 0.0f ? -1.0f : 1.0f;
  s.o = turned(&s, o);
  if (m->halves | m->quarters) {
    float y = opposite(s.o.y, m->side_y), x = m->quarters ? opposite(s.o.x, m->side_x) : y;
    s.turn_x *= x;
    s.turn_y *= y;
    s.o = turned(&s, o);
  }
  float theta = elevation(s.o), phi = vl_atan2(s.o.y, s.o.x);
  s.slices = vl_measured_slices(m, phi, theta);
  s.phi = m->isotropic ? phi : 0.0f;
  vlMeasuredCell c =
      vl_measured_cell(&m->sigma, theta_to_u(theta), phi * (0.5f * VL_INV_PI) + 0.5f);
  s.area = 4.0f * vl_max(vl_measured_in(&m->sigma, m->sigma.values, c), VL_MIN_FRACTION);
  return s;
}

/* f cos at the point (x, y) of the unit square of random numbers, which the warp maps to the
 * normal (tx, py). */
static inline void value_at(const vlMeasured *m, const Seen *s, vlMeasuredPoint at, float tx,
                            float py, const float lambda[4], float value[4]) {
  float scale = 1.0f;
  if (m->scaled) {
    vlMeasuredCell c = vl_measured_cell(&m->ndf, tx, py);
    scale = vl_max(vl_measured_in(&m->ndf, m->ndf.values, c), 0.0f) / s->area;
  }
  const vlMeasuredTable *t = &m->spectra;
  vlMeasuredCell cell = vl_measured_cell(t, at.x, at.y);
  size_t size = (size_t)t->width * t->height;
  for (uint32_t c = 0; c < 4; c++) {
    vlMeasuredKnot k = {c < 2 ? c : 2, 0.0f};
    if (m->lambda)
      k = vl_measured_knot(m->lambda, m->lambdas, lambda[c]);
    float sum = 0.0f;
    for (uint32_t i = 0; i < s->slices.count; i++) {
      const float *spectrum =
          t->values + ((size_t)s->slices.slice[i] * m->lambdas + k.i) * size;
      float a = vl_measured_in(t, spectrum, cell);
      if (k.t > 0.0f)
        a = vl_measured_between(a, vl_measured_in(t, spectrum + size, cell), k.t);
      sum += s->slices.weight[i] * a;
    }
    value[c] = m->lambda || c < 3 ? vl_clamp(sum * scale, 0.0f, 1e30f) : 0.0f;
  }
}

/* Converts a density over the square of normals to one over directions wi: d(x) d(y) = dm / (2
 * pi^2 x sin), dm = dw / (4 o.m). Bounds of both factors: pbrt's; the quotient is clamped as
 * well. */
static inline float over_directions(float density, float x, float sine, float oh) {
  float area = vl_max(2.0f * VL_PI * VL_PI * x * sine, 1e-6f) * 4.0f * vl_max(oh, 1e-9f);
  return vl_clamp(density / area, 0.0f, 1e30f);
}

static inline void lambdas_of(const vlBsdfParams *params, uint32_t i, float lambda[4]) {
  for (int c = 0; c < 4; c++)
    lambda[c] = params->lambda[c] ? params->lambda[c][i] : 0.0f;
}

void vl_bsdf_measured_eval(uint32_t n, const vlBsdfParams *params, vlBsdfDirections wo,
                           vlBsdfDirections wi, float *const value[4], float *pdf) {
  for (uint32_t i = 0; i < n; i++) {
    for (int c = 0; c < 4; c++)
      value[c][i] = 0.0f;
    pdf[i] = 0.0f;
    if (!(wo.z[i] * wi.z[i] > 0.0f))
      continue;
    const vlMeasured *m = params->measured[i];
    Seen s = seen_from(m, vl_lane3(wo.x, wo.y, wo.z, i));
    vlVec3 h = vl_normalize(vl_add(s.o, turned(&s, vl_lane3(wi.x, wi.y, wi.z, i))));
    float x = theta_to_u(elevation(h)), y = phi_to_u(vl_atan2(h.y, h.x) - s.phi);
    vlMeasuredPoint at = vl_measured_invert(&m->vndf, s.slices, x, y);
    float lambda[4], f[4];
    lambdas_of(params, i, lambda);
    value_at(m, &s, at, x, y, lambda, f);
    for (int c = 0; c < 4; c++)
      value[c][i] = f[c];
    float density = at.pdf * vl_measured_at(&m->luminance, s.slices, at.x, at.y);
    pdf[i] =
        over_directions(density, x, __builtin_sqrtf(h.x * h.x + h.y * h.y), vl_dot(s.o, h));
  }
}

void vl_bsdf_measured_sample(uint32_t n, const vlBsdfParams *params, vlBsdfDirections wo,
                             vlBsdfRandom random, vlBsdfSampled out) {
  for (uint32_t i = 0; i < n; i++) {
    for (int c = 0; c < 4; c++)
      out.weight[c][i] = 0.0f;
    out.wi.x[i] = out.wi.y[i] = out.pdf[i] = 0.0f;
    out.wi.z[i] = 1.0f;
    out.flags[i] = (uint32_t)VL_SAMPLED_NONE;
    out.eta_scale[i] = 1.0f;
    if (wo.z[i] == 0.0f)
      continue;
    const vlMeasured *m = params->measured[i];
    Seen s = seen_from(m, vl_lane3(wo.x, wo.y, wo.z, i));
    vlMeasuredPoint at = vl_measured_sample(&m->luminance, s.slices, random.u[i], random.v[i]);
    vlMeasuredPoint normal = vl_measured_sample(&m->vndf, s.slices, at.x, at.y);
    vlSinCos theta = vl_sincos(normal.x * normal.x * (0.5f * VL_PI));
    vlSinCos phi = vl_sincos((2.0f * normal.y - 1.0f) * VL_PI + s.phi);
    vlVec3 h = vl_vec3(theta.sin * phi.cos, theta.sin * phi.sin, theta.cos);
    float oh = vl_dot(s.o, h);
    vlVec3 w = vl_normalize(vl_reflect(s.o, h, oh));
    float p = over_directions(at.pdf * normal.pdf, normal.x, theta.sin, oh);
    if (!(w.z > 0.0f && oh > 0.0f && p > 0.0f))
      continue;
    float lambda[4], f[4];
    lambdas_of(params, i, lambda);
    value_at(m, &s, at, normal.x, normal.y, lambda, f);
    for (int c = 0; c < 4; c++)
      out.weight[c][i] = vl_min(f[c] / p, 1e30f);
    w = turned(&s, w);
    vl_set_lane3(out.wi.x, out.wi.y, out.wi.z, i, w);
    out.pdf[i] = p;
    out.flags[i] = 0;
  }
}
