/* render/flow.c: optical flow. It projects the surface point of each pixel with another camera,
 * computes the point's displacement on the film, and decides by a ray of the other camera
 * whether the point is visible from there.
 *
 *   P -> project -> (u, v) - the pixel's point;   other camera -> ray towards P -> is the first
 *                                                 hit P?
 *
 * Pixels of the sky have flow, too. Their target is a direction; it is visible if the other
 * camera's ray hits nothing. */
#include <math.h>

#include "camera/moments.h"
#include "math/double3.h"
#include "render/channel_pass.h"
#include "world/moving.h"

/* A hit hides the point if it is nearer by more than this tolerance, relative to the size of
 * the numbers. Rays are rounded to float (2^-23), and their hit distance moves by 1 / cosine of
 * that. */
static const double TOLERANCE = 0x1p-19, MIN_COSINE = 0.01;

typedef struct Target {
  bool sky;
  double point[3];     /* on the surface */
  double direction[3]; /* of the sky */
  double normal[3];
  double pixel[2]; /* in the other image */
  double seconds;  /* when the other camera sees it */
} Target;

/* The target of lane i, when the lane's pixel sees it. */
static Target target_of(const vlGroundTruthBatch *b, uint32_t i) {
  Target t = {.sky = b->object[i] == 0};
  for (int k = 0; k < 3; k++) {
    t.direction[k] = b->d[k][i];
    t.normal[k] = b->n_geometric[k][i];
    if (!t.sky)
      t.point[k] = b->o[k][i] + b->distance[i] * b->d[k][i];
  }
  return t;
}

/* A target and the lane that it comes from. */
typedef struct Chase {
  const vlChannelPass *p;
  const vlChannelWorker *w;
  const Target *target;
  uint32_t lane;
  int which;
} Chase;

/* The position of the target's surface point at a time. */
static void follow(const Chase *c, double seconds, double point[3]) {
  const vlGroundTruthBatch *b = c->w->batch;
  uint32_t i = c->lane;
  double from = vl_channel_time(c->p, (int32_t)c->w->x[i], (int32_t)c->w->y[i]);
  for (int k = 0; k < 3; k++)
    point[k] = c->target->point[k];
  if (!c->target->sky && c->p->world->moves)
    vl_world_follow(c->p->world, b->object[i] - 1, b->primitive[i] - 1,
                    b->instance[i] ? b->instance[i] - 1 : VL_NONE, from, seconds, point, point);
}

/* The point to project. The sky is at a large finite distance, so large that the eyes of a
 * stereo camera coincide. */
static void far_away(const Target *t, const double world_from_camera[12], double point[3]) {
  const double *m = world_from_camera, eye[3] = {m[3], m[7], m[11]};
  for (int k = 0; k < 3 && t->sky; k++)
    point[k] = eye[k] + 1e6 * (1 + vl_norm3(eye)) * t->direction[k];
}

/* A vlSeenFn: the target in the other camera with a rolling shutter, both at a time. */
static bool seen_at(void *user, double seconds, double film[2]) {
  const Chase *c = user;
  const vlCameraCompiled *camera = &c->p->other_compiled[c->which];
  double point[3], forth[12], m[12];
  follow(c, seconds, point);
  vl_camera_pose_at(camera, seconds, forth, m);
  far_away(c->target, forth, point);
  return vl_camera_film_at(camera, seconds, point, film);
}

/* Finds the target's film point in the other camera, the time at which that camera sees it,
 * and its position then. An orthographic camera has one direction in all its pixels. */
static bool find_pixel(const vlChannelPass *p, const vlChannelWorker *w, uint32_t lane,
                       int which, Target *t) {
  const vlCamera *camera = &p->other[which];
  const Target before = *t;
  Chase chase = {p, w, &before, lane, which};
  if (t->sky && camera->projection == VL_PROJECTION_ORTHOGRAPHIC)
    return false;
  if (camera->readout > 0) {
    bool seen =
        vl_camera_find_time(&p->other_compiled[which], seen_at, &chase, &t->seconds, t->pixel);
    follow(&chase, t->seconds, t->point);
    return seen;
  }
  t->seconds = p->other_time[which];
  follow(&chase, t->seconds, t->point);
  double point[3] = {t->point[0], t->point[1], t->point[2]}, z;
  far_away(t, camera->world_from_camera, point);
  return vl_camera_project(camera, point, t->pixel, &z);
}

/* The other camera's ray towards the target, and its length; false: it has none. */
static bool aim(const vlCamera *camera, const Target *t, vlGroundTruthBatch *to, double *end) {
  double o[3], d[3];
  if (!vl_camera_unproject(camera, t->pixel[0], t->pixel[1], o, d))
    return false;
  for (int k = 0; k < 3; k++)
    d[k] = t->sky ? t->direction[k] : t->point[k] - o[k];
  double length = vl_norm3(d);
  if (!(length > 0))
    return false;
  for (int k = 0; k < 3; k++) {
    to->o[k][to->n] = o[k];
    to->d[k][to->n] = d[k] / length;
  }
  *end = t->sky ? (double)INFINITY : length;
  return true;
}

/* Whether the ray's hit hides the point: true unless the hit is the point itself. */
static bool hides(const vlChannelPass *p, const vlGroundTruthBatch *b, uint32_t lane,
                  const Target *t, const vlGroundTruthBatch *other, uint32_t i, double end) {
  if (other->object[i] == 0)
    return false;
  if (t->sky)
    return true;
  bool same = other->object[i] == b->object[lane] && other->instance[i] == b->instance[lane] &&
              other->primitive[i] == b->primitive[lane];
  if (same && p->world->shapes.items[b->object[lane] - 1].triangles)
    return false;
  double o[3], cosine = 0;
  for (int k = 0; k < 3; k++) {
    o[k] = other->o[k][i];
    cosine += t->normal[k] * other->d[k][i];
  }
  double size = end + vl_norm3(o) + vl_norm3(t->point);
  return other->distance[i] < end - TOLERANCE * size / fmax(fabs(cosine), MIN_COSINE);
}

static vlHidden judge(const vlChannelPass *p, const vlGroundTruthBatch *b, uint32_t lane,
                      const Target *t, const vlGroundTruthBatch *other, uint32_t i, double end,
                      const vlCamera *camera) {
  bool inside = t->pixel[0] >= 0 && t->pixel[1] >= 0 && t->pixel[0] < camera->width &&
                t->pixel[1] < camera->height;
  bool cut = !t->sky && !(end >= (double)other->t_min[i] && end <= (double)other->t_max[i]);
  if (!inside || cut)
    return VL_HIDDEN_OUTSIDE;
  return hides(p, b, lane, t, other, i, end) ? VL_HIDDEN_BEHIND : VL_HIDDEN_NOT;
}

/* Makes the other camera's rays for those of the lanes [first, last) that project into it. The
 * first half of the work, so that rays are traced together. */
static void list_targets(const vlChannelPass *p, vlChannelWorker *w, int which, Target *targets,
                         double *ends, uint32_t first, uint32_t last) {
  vlGroundTruthBatch *other = w->other;
  other->n = 0;
  for (uint32_t i = first; i < last; i++) {
    Target t = target_of(w->batch, i);
    if (!find_pixel(p, w, i, which, &t))
      continue;
    float *flow = vl_channel_floats(p, vl_channel_at(p, w->x[i], w->y[i]),
                                    VL_INDEX_FORWARD + (uint32_t)which);
    flow[0] = (float)(t.pixel[0] - ((double)w->x[i] + (double)w->lane_x[i]));
    flow[1] = (float)(t.pixel[1] - ((double)w->y[i] + (double)w->lane_y[i]));
    *vl_channel_ids(p, vl_channel_at(p, w->x[i], w->y[i]), VL_INDEX_FORWARD + (uint32_t)which) =
        VL_HIDDEN_OUTSIDE;
    bool far_outside = !(fabs(t.pixel[0]) < 0x1p20 && fabs(t.pixel[1]) < 0x1p20);
    if (far_outside || !aim(&p->other[which], &t, other, &ends[other->n]))
      continue;
    w->lanes[other->n] = i;
    targets[other->n++] = t;
  }
}

enum { CHUNK = 128 };

static void flow_chunk(const vlChannelPass *p, vlChannelWorker *w, int which, uint32_t first,
                       uint32_t last) {
  Target targets[CHUNK];
  double ends[CHUNK];
  uint32_t x[CHUNK], y[CHUNK];
  float film_x[CHUNK], film_y[CHUNK];
  vlGroundTruthBatch *other = w->other;
  list_targets(p, w, which, targets, ends, first, last);
  if (other->n == 0)
    return;
  for (uint32_t i = 0; i < other->n; i++) {
    double left = floor(targets[i].pixel[0]), top = floor(targets[i].pixel[1]);
    x[i] = (uint32_t)(int32_t)left;
    y[i] = (uint32_t)(int32_t)top;
    film_x[i] = (float)(targets[i].pixel[0] - left);
    film_y[i] = (float)(targets[i].pixel[1] - top);
  }
  vlChannelEnds cut = {&p->other_compiled[which], x, y, film_x, film_y};
  vl_channel_ends(p, w, other->n, &cut, other->t_min, other->t_max);
  for (uint32_t i = 0; i < other->n; i++)
    other->time[i] = vl_world_time(p->world, targets[i].seconds);
  vlGroundTruthDef def = p->ground_truth; /* bump maps and albedo are not needed */
  def.shading = def.albedo = false;
  p->ground_truth_kernels->trace(p->world, &def, w->scratch, other);
  for (uint32_t i = 0; i < other->n; i++) {
    uint32_t lane = w->lanes[i];
    *vl_channel_ids(p, vl_channel_at(p, w->x[lane], w->y[lane]),
                    VL_INDEX_FORWARD + (uint32_t)which) =
        judge(p, w->batch, lane, &targets[i], other, i, ends[i], &p->other[which]);
  }
}

void vl_channel_flow(const vlChannelPass *p, vlChannelWorker *w, int which) {
  for (uint32_t first = 0; first < w->batch->n; first += CHUNK)
    flow_chunk(p, w, which, first, first + CHUNK < w->batch->n ? first + CHUNK : w->batch->n);
}
