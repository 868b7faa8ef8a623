/* light/light_media.hot.c: the medium around each light. Surfaces between two media
 * define the medium on each side. Rays in many directions from the light find such surfaces,
 * and the most frequent medium is used. If no ray finds one, the straight line from the camera
 * to the light decides. Camera paths find media by the surfaces that they cross, so both sides
 * must agree. */
#include "math/warp.h"
#include "shape/surface_point.h"
#include "trace/two_way/stages.h"

enum { ASKED = 32, ANSWERS = 8 };

static uint32_t closest(const vlWorld *world, vlVec3 o, vlVec3 d, float t_min, float t_max,
                        vlPoint *at) {
  uint32_t shape, prim, instance;
  float t = 0.0f;
  vlRays ray = vl_one_ray(&o, &d, &t_min, &t_max, NULL);
  vl_accel_closest(world, 1, &ray, false, &shape, &prim, &instance, &t);
  if (shape != VL_NONE)
    *at = vl_point_at_time(world, 0.0f, o, d, shape, prim, instance, t);
  return shape;
}

static bool borders(const vlWorldShape *s) {
  return s->inside != s->outside;
}

/* Finds the most frequent medium around p. Returns false if no ray finds one. far: p is outside
 * the world, and rays go towards the world's centre. */
static bool surrounding_medium(const vlWorld *world, vlVec3 p, bool far, uint32_t *medium) {
  uint32_t answer[ANSWERS], votes[ANSWERS], answers = 0, best = 0;
  for (int k = 0; k < ASKED; k++) {
    vlVec3 w = vl_warp_sphere(((float)k + 0.5f) / ASKED,
                              0.618034f * (float)k - (float)(int)(0.618034f * (float)k));
    if (far) {
      vlVec3 to = vl_add(vl_load3(world->center), vl_mul(w, 0.5f * world->radius));
      w = vl_normalize(vl_sub(to, p));
    }
    vlPoint at;
    uint32_t shape = closest(world, p, w, 0.0f, VL_INFINITY, &at);
    if (shape == VL_NONE || !borders(&world->shapes.items[shape]))
      continue;
    uint32_t here = vl_medium_beyond(&world->shapes.items[shape], at.g, vl_neg(w), VL_NONE),
             i = 0;
    while (i < answers && answer[i] != here)
      i++;
    if (i == ANSWERS)
      continue;
    if (i == answers) {
      answer[answers] = here;
      votes[answers++] = 0;
    }
    votes[i]++;
  }
  for (uint32_t i = 1; i < answers; i++)
    if (votes[i] > votes[best])
      best = i;
  if (answers)
    *medium = answer[best];
  return answers > 0;
}

static uint32_t on_the_way(const vlWorld *world, vlVec3 eye, vlVec3 p) {
  vlVec3 d = vl_sub(p, eye);
  float end = vl_length(d), t_min = 0.0f;
  uint32_t medium = world->camera_medium;
  if (!(end > 0.0f))
    return medium;
  d = vl_mul(d, 1.0f / end);
  for (int step = 0; step < 1024; step++) {
    vlPoint at;
    uint32_t shape = closest(world, eye, d, t_min, end, &at);
    if (shape == VL_NONE || !(at.t < end))
      break;
    medium = vl_medium_beyond(&world->shapes.items[shape], at.g, d, medium);
    t_min = vl_past_surface(&at, d, t_min);
  }
  return medium;
}

/* A point next to an area light. Its distance from the surface is at least 1000 times the
 * rounding error of its coordinates. */
static vlVec3 beside(const vlWorld *world, const vlWorldLight *light) {
  const vlWorldShape *s = &world->shapes.items[light->shape];
  vlSurfacePoint point;
  double pdf;
  vlVec3 p = vl_vec3(0, 0, 0), n = vl_load3(light->direction);
  if (s->triangles) {
    for (int k = 0; k < 9; k++)
      (&p.x)[k % 3] += light->corners[k] * (1.0f / 3.0f);
  } else {
    vl_shape_sample(s, light->prim, 0.4f, 0.4f, &point, &pdf);
    p = vl_vec3((float)point.p[0], (float)point.p[1], (float)point.p[2]);
    n = vl_vec3((float)point.n[0], (float)point.n[1], (float)point.n[2]);
  }
  return vl_add(
      p, vl_mul(n, 1e-4f * (1e-3f * world->radius + vl_abs(p.x) + vl_abs(p.y) + vl_abs(p.z))));
}

void vl_light_media(const vlWorld *world, const float eye[3], uint32_t *medium) {
  for (size_t i = 0; i < world->lights.count; i++) {
    const vlWorldLight *light = &world->lights.items[i];
    vlVec3 p = vl_load3(light->position);
    medium[i] = VL_NONE;
    if (light->shape != VL_NONE) {
      if (borders(&world->shapes.items[light->shape]))
        continue; /* its own interface defines the medium */
      if (i > 0 && world->lights.items[i - 1].shape == light->shape) {
        medium[i] = medium[i - 1];
        continue;
      }
      p = beside(world, light);
    } else if (light->far) {
      vlVec3 w = vl_vec3(0, 0, 1);
      if (light->delta)
        w = vl_load3(light->direction);
      p = vl_add(vl_load3(world->center), vl_mul(w, 2.0f * world->radius));
    }
    if (!surrounding_medium(world, p, light->far, &medium[i]))
      medium[i] = on_the_way(world, vl_load3(eye), p);
  }
}
