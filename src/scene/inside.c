/* scene/inside.c: see inside.h. */
#include "scene/inside.h"

#include <math.h>
#include <string.h>

#include "math/double3.h"
#include "math/elementary.h"
#include "scene/closed.h"
#include "velo/camera.h"
#include "velo/light.h"

enum {
  POINTS = 7, /* near the middle: itself and towards the faces of the box */
  LAMPS = 12,
  AROUND = 24, /* rays from a point in all directions */
  MAX_RAYS = POINTS * AROUND > LAMPS *AROUND ? POINTS *AROUND : LAMPS *AROUND
};

typedef struct Rays {
  double from[MAX_RAYS][3], toward[MAX_RAYS][3], reach[MAX_RAYS];
  uint32_t count;
} Rays;

static void add_ray(Rays *r, const double from[3], const double toward[3]) {
  memcpy(r->from[r->count], from, sizeof *r->from);
  memcpy(r->toward[r->count++], toward, sizeof *r->toward);
}

/* Direction k of n, evenly spread over the part of the sphere with a height of `lowest` or more
 * above the horizon; `up` is a unit vector. */
static void direction(uint32_t k, uint32_t n, double lowest, const double up[3], double d[3]) {
  const double height = lowest + (1 - lowest) * (k + 0.5) / n, flat = sqrt(1 - height * height),
               turn = 2.399963229728653 * k + 0.3;
  double right[3], ahead[3] = {0, 0, 0};
  int min = fabs(up[0]) < fabs(up[1]) ? 0 : 1;
  min = fabs(up[2]) < fabs(up[min]) ? 2 : min;
  ahead[min] = 1; /* not parallel to `up` */
  vl_cross3(ahead, up, right);
  vl_normalize3(right);
  vl_cross3(up, right, ahead);
  for (int i = 0; i < 3; i++)
    d[i] = height * up[i] +
           flat * (vl_precise_cos(turn) * right[i] + vl_precise_sin(turn) * ahead[i]);
}

static void add_rays_around(Rays *r, const double from[3], const double up[3]) {
  for (uint32_t k = 0; k < AROUND; k++) {
    double d[3];
    direction(k, AROUND, -1, up, d);
    add_ray(r, from, d);
  }
}

static bool cast(vlScene *scene, Rays *r) {
  return vl_closed_reach(scene, (const double(*)[3])r->from, (const double(*)[3])r->toward,
                         r->count, r->reach);
}

/* Whether the camera's eye is in the box. */
static bool find_eye(const vlScene *scene, const vlExtent *box, double eye[3]) {
  vlCamera camera;
  vlCameraDef def = scene->defs.camera;
  def.width = scene->defs.film.width;
  def.height = scene->defs.film.height;
  if (scene->defs.camera_missing || vl_camera_make(&def, &camera, NULL, NULL) != VL_OK)
    return false;
  for (int i = 0; i < 3; i++)
    eye[i] = camera.world_from_camera[4 * i + 3];
  return vl_extent_surrounds(box, eye);
}

/* The point near the middle with the most room around it. */
static bool find_free_point(vlScene *scene, const vlExtent *box, const double up[3], Rays *r,
                            double max, double best[3]) {
  double middle[3], room = -1;
  r->count = 0;
  vl_extent_middle(box, middle);
  for (int point = 0; point < POINTS; point++) {
    double p[3] = {middle[0], middle[1], middle[2]};
    const int axis = (point - 1) / 2;
    if (point)
      p[axis] += (point & 1 ? 0.23 : -0.23) * vl_extent_size(box, axis);
    add_rays_around(r, p, up);
  }
  if (!cast(scene, r))
    return false;
  for (int point = 0; point < POINTS; point++) {
    double sum = 0;
    for (int k = 0; k < AROUND; k++)
      sum += fmin(r->reach[point * AROUND + k], max);
    if (sum > room)
      memcpy(best, r->from[point * AROUND], 3 * sizeof *best);
    room = fmax(room, sum);
  }
  return true;
}

/* Places the lamps around a point, each halfway to what its direction meets. */
static bool place_lamps(vlScene *scene, const double center[3], const double up[3], double max,
                        Rays *r, double lamps[LAMPS][3]) {
  r->count = 0;
  for (uint32_t k = 0; k < LAMPS; k++) {
    double d[3];
    direction(k, LAMPS, 0.05, up, d);
    add_ray(r, center, d);
  }
  if (!cast(scene, r))
    return false;
  for (uint32_t k = 0; k < LAMPS; k++)
    for (int i = 0; i < 3; i++)
      lamps[k][i] = center[i] + 0.5 * fmin(r->reach[k], max) * r->toward[k][i];
  return true;
}

bool vl_scene_add_lamps(vlScene *scene, const vlExtent *boxes, const double up[3],
                        float strength) {
  vlExtent box = vl_extent_nothing;
  vl_extent_visit(scene, boxes, NULL, vl_extent_grow, &box);
  const double max = vl_extent_diagonal(&box);
  double center[3], lamps[LAMPS][3];
  if (!(max > 0) || !isfinite(max))
    return true; /* there is nothing to light */
  Rays *r = vl_alloc(scene->context, sizeof *r);
  if (!r)
    return vl_scene_fail_memory(scene);
  bool ok = find_eye(scene, &box, center) || find_free_point(scene, &box, up, r, max, center);
  ok = ok && place_lamps(scene, center, up, max, r, lamps);
  r->count = 0;
  for (int k = 0; k < LAMPS && ok; k++)
    add_rays_around(r, lamps[k], up);
  ok = ok && cast(scene, r);
  for (int k = 0; k < LAMPS && ok; k++) {
    double nearest = max;
    for (int i = 0; i < AROUND; i++)
      nearest = fmin(nearest, r->reach[k * AROUND + i]);
    vlLightDef light = vl_default_light_def(VL_LIGHT_POINT);
    light.color = vl_spectrum_rgb(1, 1, 1);
    light.scale = strength * (float)(nearest * nearest);
    for (int i = 0; i < 3; i++)
      light.from[i] = (float)lamps[k][i];
    ok = light.scale <= 0 || vl_scene_add_light(scene, &light).index != 0;
  }
  vl_free(scene->context, r);
  return ok;
}
