/* conformance/moving.h: the law of moving meshes: at any time between their two times, points
 * and normals of the corners are those between the first and the last ones. */
#ifndef TEST_CONFORMANCE_MOVING_H
#define TEST_CONFORMANCE_MOVING_H

#include "conformance.h"
#include "unit.h"

/* What a square does that rises and whose normals turn, and rays from above. */
typedef struct Moving {
  vlTraceRays *rays;
  vlTraceHits *hits;
  uint32_t elsewhere, turned, late;
} Moving;

static const float still_normals[12] = {.3f, .1f, 1, -.2f, .4f, 1, .1f, -.3f, 1, 0, .2f, 1};
static const float turned_normals[12] = {-.4f, .2f, 1, .3f, -.1f, 1, .2f, .5f, 1, -.3f, 0, 1};

/* The normal at (x, y) in the square from -1 to 1, of which the two triangles meet where x is
 * y. */
static void normal_of_rising(double x, double y, double time, double n[3]) {
  const double u = (x + 1) / 2;
  const double v = (y + 1) / 2;
  const double under[4] = {1 - u, u - v, v, 0};
  const double over[4] = {1 - v, 0, u, v - u};
  const double *w = u > v ? under : over;
  double length2 = 0;
  for (int k = 0; k < 3; k++) {
    n[k] = 0;
    for (int c = 0; c < 4; c++)
      n[k] += w[c] * ((1 - time) * (double)still_normals[3 * c + k] +
                      time * (double)turned_normals[3 * c + k]);
    length2 += n[k] * n[k];
  }
  for (int k = 0; k < 3; k++)
    n[k] /= sqrt(length2);
}

static void ask_moving(Probe *probe, vlTrace *trace, const vlOwnPaths *paths) {
  Moving *m = probe->user;
  set_rays_down(m->rays);
  vl_world_trace(trace, m->rays, m->hits);
  assert_non_null(paths->time);
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    const double time = (double)paths->time[i];
    double n[3];
    double apart = 0;
    normal_of_rising((double)m->rays->origin[0][i], (double)m->rays->origin[1][i], time, n);
    for (int k = 0; k < 3; k++)
      apart = fmax(apart, fabs((double)m->hits->shading[k][i] - n[k]));
    m->late += time > 0.75;
    m->elsewhere += !(fabs((double)m->hits->t[i] - (1 - 0.5 * time)) < 1e-4);
    m->turned += !(apart < 1e-3);
  }
}

static void moving_meshes(void **state) {
  (void)state;
  static const float above[12] = {-1, -1, .5f, 1, -1, .5f, 1, 1, .5f, -1, 1, .5f};
  static const char *const text = HEAD "WorldBegin LightSource \"infinite\"";
  vlShapeDef square = square_def();
  square.positions_close = above;
  square.normals = still_normals;
  square.normals_close = turned_normals;
  Moving m = {.rays = new_rays(), .hits = calloc(1, sizeof *m.hits)};
  Probe probe = {.ask = ask_moving, .user = &m};
  vlScene *scene = need_scene(text);
  assert_int_not_equal(vl_scene_add_shape(scene, &square).index, 0);
  probe_scene(scene, text, &probe, 1);
  if (m.late < VL_OWN_BATCH / 8 || m.elsewhere || m.turned)
    broken("shapes", "trianglemesh", "moving: %u of %u points are elsewhere, %u normals others",
           m.elsewhere, VL_OWN_BATCH, m.turned);
  free(m.rays);
  free(m.hits);
  expect_no_failures();
}

#endif
