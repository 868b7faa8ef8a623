/* light/infinite.hot.c: infinite lights (pbrt book 12.5): uniform, by an image, or by an image
 * that is seen through a portal. environment.hot.c samples an image for many lanes at once. */
#include "light/kinds.hot.h"
#include "light/portal.h"
#include "math/octahedral.h"
#include "math/warp.h"

vlSampleLight vl_light_sample_infinite;
vlEmitLight vl_light_emit_infinite;
vlLightDensity vl_light_emit_pdf_infinite;

void vl_infinite_at(const vlWorld *world, const vlWorldLight *light, vlVec3 o, vlVec3 d,
                    const float lambda[4], float out[4]) {
  vlVec2 st = {0, 0};
  if (light->environment != VL_NONE) {
    const vlEnvironment *env = &world->environments.items[light->environment];
    st = vl_environment_square(env, d);
    if (env->portal && !vl_portal_shows(env->portal, o, d)) {
      for (int c = 0; c < 4; c++)
        out[c] = 0.0f;
      return;
    }
  }
  vl_emitted_at(world, &world->emitted.items[light->emitted], lambda, st.x, st.y, true, out);
}

float vl_infinite_pdf(const vlWorld *world, const vlWorldLight *light, vlVec3 o, vlVec3 d) {
  if (light->environment == VL_NONE)
    return world->def.imitate_pbrt ? 0.0f : 0.25f * VL_INV_PI;
  const vlEnvironment *env = &world->environments.items[light->environment];
  vlPortalWindow window;
  if (env->portal)
    return vl_portal_shows(env->portal, o, d) && vl_portal_window(env->portal, o, &window)
               ? vl_portal_pdf(env->portal, &window, d)
               : 0.0f;
  vlVec2 st = vl_environment_square(env, d);
  return env->cells[vl_environment_at(env, st.x, st.y)].pdf * (0.25f * VL_INV_PI);
}

void vl_light_sample_infinite(const vlLightQuery *q, vlLightSample *out) {
  const vlWorld *world = q->world;
  const vlWorldLight *light = q->light;
  out->distant = true;
  if (light->environment == VL_NONE) {
    if (world->def.imitate_pbrt)
      return; /* pbrt-v4 samples a uniform sky by the BSDF only */
    out->w = vl_warp_sphere(q->u, q->v);
    out->pdf = 0.25f * VL_INV_PI;
    vl_emitted_at(world, q->emitted, q->lambda, 0, 0, true, out->radiance);
  } else if (world->environments.items[light->environment].portal) {
    /* without a portal, environment.hot.c samples the map */
    const vlPortal *portal = world->environments.items[light->environment].portal;
    vlPortalWindow window;
    if (!vl_portal_window(portal, q->p, &window))
      return;
    out->w = vl_portal_sample(portal, &window, q->u, q->v);
    out->pdf = vl_infinite_pdf(world, light, q->p, out->w);
    vl_infinite_at(world, light, q->p, out->w, q->lambda, out->radiance);
  }
  out->target = out->w;
}

/* ---- rays that leave the light ----------------------------------------------------------- */

/* Density per solid angle of the directions of light paths from an infinite light. The
 * environment map's own density excludes dim directions, so half of the light paths use that
 * density, and the other half are uniform over the sphere. */
static float sky_density(const vlWorld *world, const vlWorldLight *light, vlVec3 w) {
  if (light->environment == VL_NONE)
    return VL_INV_4PI;
  return 0.5f * (vl_infinite_pdf(world, light, vl_vec3(0, 0, 0), w) + VL_INV_4PI);
}

static const vlPortal *portal_of(const vlWorld *world, const vlWorldLight *light) {
  return light->environment == VL_NONE ? NULL
                                       : world->environments.items[light->environment].portal;
}

bool vl_is_outside_portal(const vlWorld *world, const vlWorldLight *light, vlVec3 p) {
  const vlPortal *portal = portal_of(world, light);
  return portal && !(vl_portal_corner_from(portal, p).z > 0.0f);
}

/* Density of light paths through a portal, whose directions are sampled in proportion to
 * radiance. The density is per area perpendicular to w and per solid angle. */
static float portal_density(const vlPortal *portal, vlVec3 w) {
  vlPortalWindow whole = vl_portal_whole(portal);
  float across = portal->width * portal->height * vl_portal_local(portal, w).z;
  return across > 0.0f ? vl_portal_pdf(portal, &whole, w) / across : 0.0f;
}

float vl_light_emit_pdf_infinite(const vlWorld *world, const vlWorldLight *light, float p,
                                 vlVec3 w, VL_UNUSED float distance,
                                 VL_UNUSED const vlPoint *at) {
  if (portal_of(world, light))
    return p * portal_density(portal_of(world, light), w);
  return p * sky_density(world, light, w) / vl_light_disk(world);
}

/* Samples a direction of an infinite light with the density vl_infinite_pdf. */
static vlVec3 sky_direction(const vlWorld *world, const vlWorldLight *light,
                            const float lambda[4], float u, float v, float *pdf,
                            float radiance[4]) {
  const vlEmitted *e = &world->emitted.items[light->emitted];
  if (light->environment == VL_NONE) {
    *pdf = VL_INV_4PI;
    vl_emitted_at(world, e, lambda, 0, 0, true, radiance);
    return vl_warp_sphere(u, v);
  }
  if (u < 0.5f) {
    vlVec3 w = vl_warp_sphere(2.0f * u, v);
    vl_infinite_at(world, light, vl_vec3(0, 0, 0), w, lambda, radiance);
    *pdf = sky_density(world, light, w);
    return w;
  }
  u = vl_min(2.0f * u - 1.0f, VL_ONE_MINUS_EPSILON);
  const vlEnvironment *env = &world->environments.items[light->environment];
  float dx, dy;
  uint32_t y = vl_environment_row(env, v, &dy), x = vl_environment_cell(env, y, u, &dx);
  float s = ((float)x + dx) / (float)env->size, t = ((float)y + dy) / (float)env->size;
  *pdf = 0.5f * (env->cells[(size_t)y * env->size + x].pdf + 1.0f) * VL_INV_4PI;
  vl_emitted_at(world, e, lambda, s, t, true, radiance);
  return vl_environment_direction(env, s, t);
}

/* Samples a ray through the portal, from outside the world. */
static void through_portal(const vlWorld *world, const vlWorldLight *light,
                           const vlPortal *portal, const float lambda[4], float u, float v,
                           float s, float t, vlEmission *out) {
  vlPortalWindow whole = vl_portal_whole(portal);
  vlVec3 w = vl_portal_sample(portal, &whole, s, t);
  float density = portal_density(portal, w);
  if (!(density > 0.0f))
    return;
  vlVec3 at = vl_load3(portal->corner);
  at = vl_add(at, vl_portal_world(portal, vl_vec3(u * portal->width, v * portal->height, 0)));
  vlVec3 away = vl_sub(at, vl_load3(world->center));
  out->o = vl_add(at, vl_mul(w, vl_length(away) + world->radius));
  out->d = vl_neg(w);
  out->at = w;
  vl_infinite_at(world, light, vl_sub(at, w), w, lambda, out->flux);
  for (int c = 0; c < 4; c++)
    out->flux[c] /= density;
  out->density = density;
  out->valid = true;
}

void vl_light_emit_infinite(const vlEmissionQuery *q, vlEmission *out) {
  const vlWorld *world = q->world;
  const vlPortal *portal = portal_of(world, q->light);
  if (portal) {
    through_portal(world, q->light, portal, q->lambda, q->u, q->v, q->s, q->t, out);
    return;
  }
  float pdf;
  vl_light_emit_from_afar(
      world, sky_direction(world, q->light, q->lambda, q->s, q->t, &pdf, out->flux), q->u, q->v,
      out);
  out->valid = pdf > 0.0f;
  if (!out->valid)
    return;
  for (int c = 0; c < 4; c++)
    out->flux[c] *= vl_light_disk(world) / pdf;
  out->density = pdf / vl_light_disk(world);
}
