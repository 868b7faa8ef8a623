/* image/check_flow.c: whether flow leads to the same point in the other image. */
#include <math.h>

#include "cli/report.h"
#include "cli/vector.h"
#include "image/check.h"
#include "velo/channels.h"

/* Computes the world point that the pixel shows. For a pixel without a hit, it is a distant
 * point on the ray. */
static bool find_point(const Check *c, bool hit, double p[3]) {
  double origin[3], direction[3];
  if (!vl_camera_unproject(&c->camera, c->point[0], c->point[1], origin, direction))
    return false;
  if (!hit) {
    const double *m = c->other_camera.world_from_camera, eye[3] = {m[3], m[7], m[11]};
    vector_along(eye, 1e6 * (1 + vector_length(eye)), direction, p);
    return c->other_camera.projection != VL_PROJECTION_ORTHOGRAPHIC;
  }
  if (c->distance >= 0) {
    vector_along(origin, (double)c->pixel[c->distance], direction, p);
    return true;
  }
  if (c->p < 0)
    return false;
  check_load3(c, c->p, p);
  return true;
}

/* Finds the nearest and farthest distance around a position in the other image. Returns false
 * outside the file's window. */
static bool around(const Check *c, const double at[2], double *nearest, double *farthest) {
  uint32_t width = vl_image_width(c->other), height = vl_image_height(c->other),
           step = vl_image_channels(c->other);
  const float *pixels = vl_image_const_pixels(c->other);
  double x = floor(at[0]) - c->other_x0, y = floor(at[1]) - c->other_y0;
  if (!(x >= 0 && y >= 0 && x < width && y < height))
    return false;
  *nearest = INFINITY;
  *farthest = 0;
  for (int j = -1; j <= 1; j++)
    for (int i = -1; i <= 1; i++) {
      double px = x + i, py = y + j;
      if (!(px >= 0 && py >= 0 && px < width && py < height))
        continue;
      double t = pixels[((size_t)py * width + (size_t)px) * step + (size_t)c->other_distance];
      *nearest = fmin(*nearest, t);
      *farthest = fmax(*farthest, t);
    }
  return true;
}

/* In the other image, a visible point has nothing in front of it, and a hidden point has
 * something. The pixel's eight neighbours count, too, because of edges. Grazing surfaces remain
 * uncertain: a share of the pixels may disagree. */
static void compare_distances(Check *c, int hidden, const double at[2], bool hit,
                              const double p[3]) {
  double nearest, farthest, origin[3], direction[3], away[3];
  if (c->other_distance < 0 || hidden > VL_HIDDEN_BEHIND || !around(c, at, &nearest, &farthest))
    return;
  if (!vl_camera_unproject(&c->other_camera, at[0], at[1], origin, direction))
    return;
  vector_subtract(p, origin, away);
  double distance = hit ? vector_length(away) : (double)INFINITY;
  c->flow_seen++;
  c->flow_wrong +=
      hidden == VL_HIDDEN_BEHIND ? nearest >= distance : farthest < distance * 0.99;
}

/* How far the pixel moves if p has an error as large as the largest length from which it was
 * computed, by the derivative of the projection. Near the other camera's plane of depth 0 it
 * grows as size / depth^2. P and the distance are 32-bit floats, so p has an error relative to
 * that length. A flow error divided by the result is the relative error of p that would explain
 * it. */
static double pixels_of_rounding(const Check *c, const double p[3], const double at[2]) {
  const double *m = c->other_camera.world_from_camera, eye[3] = {m[3], m[7], m[11]};
  double away[3] = {p[0] - eye[0], p[1] - eye[1], p[2] - eye[2]}, near = vector_length(away),
         largest = 0;
  double size = fmax(fmax(vector_length(p), vector_length(eye)), near), step = 1e-7 * near;
  for (int k = 0; k < 3 && step > 0; k++) {
    double moved[3] = {p[0], p[1], p[2]}, there[2], z;
    moved[k] += step;
    if (vl_camera_project(&c->other_camera, moved, there, &z))
      largest = fmax(largest, hypot(there[0] - at[0], there[1] - at[1]));
  }
  return step > 0 ? largest * size / step : 0;
}

/* The pixel of the other image to which the flow leads; null: it is outside. */
static const float *led_to(const Check *c, const float flow[2]) {
  double x = floor(c->point[0] + (double)flow[0]) - c->other_x0,
         y = floor(c->point[1] + (double)flow[1]) - c->other_y0;
  uint32_t width = vl_image_width(c->other), height = vl_image_height(c->other);
  if (!(x >= 0 && y >= 0 && x < width && y < height))
    return NULL;
  return vl_image_const_pixels(c->other) +
         ((size_t)y * width + (size_t)x) * vl_image_channels(c->other);
}

/* Counts a pixel whose flow leads elsewhere than in a world at rest. */
static void count_elsewhere(Check *c, const float flow[2]) {
  const float *there = led_to(c, flow);
  c->flow_elsewhere++;
  if (!there || c->object < 0 || c->other_object < 0)
    return;
  bool same = c->pixel[c->object] > 0 && c->pixel[c->object] == there[c->other_object];
  if (c->instance >= 0 && c->other_instance >= 0)
    same = same && c->pixel[c->instance] == there[c->other_instance];
  c->flow_same += same;
}

void check_flow(Check *c) {
  int hidden = (int)c->pixel[c->hidden[c->which]];
  const float *flow = c->pixel + c->flow[c->which];
  bool hit = check_is_hit(c);
  if (hidden < VL_HIDDEN_NOT || hidden > VL_HIDDEN_NOWHERE ||
      (float)hidden != c->pixel[c->hidden[c->which]]) {
    check_note(c, RULE_HIDDEN, INFINITY);
    return;
  }
  double p[3], at[2], z;
  if (!find_point(c, hit, p))
    return;
  if (!vl_camera_project(&c->other_camera, p, at, &z)) {
    check_that(c, RULE_HIDDEN, hidden == VL_HIDDEN_NOWHERE && flow[0] == 0 && flow[1] == 0);
    return;
  }
  double larger =
      fmax(fmax(c->other_camera.width, c->other_camera.height), fmax(fabs(at[0]), fabs(at[1])));
  double error =
      hypot(at[0] - c->point[0] - (double)flow[0], at[1] - c->point[1] - (double)flow[1]);
  if (hidden != VL_HIDDEN_NOWHERE)
    check_note(c, RULE_FLOW, error / fmax(larger, pixels_of_rounding(c, p, at)));
  if (hidden != VL_HIDDEN_NOWHERE && error > 0.01)
    count_elsewhere(c, flow);
  const double margin = 1e-3;
  bool inside = at[0] > margin && at[1] > margin && at[0] < c->other_camera.width - margin &&
                at[1] < c->other_camera.height - margin;
  bool outside = at[0] < -margin || at[1] < -margin || at[0] > c->other_camera.width + margin ||
                 at[1] > c->other_camera.height + margin;
  bool cut = c->other_camera.near_plane > 0 || c->other_camera.far_plane < (double)INFINITY;
  bool wrong = (inside && !cut && hidden >= VL_HIDDEN_OUTSIDE) ||
               (outside && hidden < VL_HIDDEN_OUTSIDE);
  check_note(c, RULE_HIDDEN, wrong ? (double)INFINITY : 0);
  compare_distances(c, hidden, at, hit, p);
}

void check_finish_flow(Check *c) {
  if (c->flow_seen)
    check_note(c, RULE_SEEN, (double)c->flow_wrong / (double)c->flow_seen);
}

void check_explain_flow(const Check *c, double threshold) {
  if (c->rules[RULE_FLOW].worst <= threshold || !c->flow_elsewhere)
    return;
  report_note(
      "%s: the flow of %llu pixels leads elsewhere than in a world at rest, of %llu of "
      "them to the same object there: of objects that move, flow cannot be checked",
      c->path, (unsigned long long)c->flow_elsewhere, (unsigned long long)c->flow_same);
}
