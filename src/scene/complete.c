/* scene/complete.c: completes a file of plain geometry: a camera that frames everything, light,
 * a ground plane. */
#include <math.h>
#include <string.h>

#include "base/cookie.h"
#include "base/unset.h"
#include "math/approx_double.h"
#include "math/double3.h"
#include "math/elementary.h"
#include "scene/closed.h"
#include "scene/environment.h"
#include "scene/facing.h"
#include "scene/inside.h"
#include "scene/lamps.h"
#include "scene/mend.h"
#include "scene/plain.h"
#include "scene/stray.h"
#include "scene/studio.h"
#include "scene/tilt.h"
#include "scene/tray.h"
#include "scene/upright.h"
#include "schema/schema.h"
#include "velo/material.h"
#include "velo/shape_kinds.h"
#include "velo/texture.h"

vlCompleteDef vl_default_complete_def(void) {
  return (vlCompleteDef){.cookie = VL_COOKIE_COMPLETE,
                         .rotation = VL_UNSET,
                         .strength = 1.0f,
                         .up = {0, 1, 0},
                         .front = {0, 0, 1},
                         .azimuth = VL_UNSET,
                         .elevation = VL_UNSET,
                         .ground_middle = {VL_UNSET, VL_UNSET, VL_UNSET},
                         .ground_radius = VL_UNSET,
                         .walls_from = {VL_UNSET, VL_UNSET, VL_UNSET}};
}

vlCompleteDef vl_scene_completed(const vlScene *scene) {
  return scene->completed.cookie ? scene->completed : vl_default_complete_def();
}

bool vl_scene_framed(const vlScene *scene, double low[3], double high[3]) {
  if (!scene->completed.cookie || !(scene->framed[0][0] <= scene->framed[1][0]))
    return false;
  memcpy(low, scene->framed[0], sizeof scene->framed[0]);
  memcpy(high, scene->framed[1], sizeof scene->framed[1]);
  return true;
}

static void set_framed(vlScene *scene, const vlExtent *box) {
  memcpy(scene->framed[0], box->low, sizeof box->low);
  memcpy(scene->framed[1], box->high, sizeof box->high);
}

/* ---- the camera -------------------------------------------------------------------------- */

/* The view frustum. sides: offset of each side plane, which is the maximum over all points of x
 * - z tan(half angle) for the right side, and likewise for the others. near, far: the limits of
 * z. */
typedef struct Frame {
  double center[3], right[3], up[3], ahead[3];
  double tan_x, tan_y;
  double sides[4], near, far;
} Frame;

static void widen(void *user, const double p[3]) {
  Frame *f = user;
  double d[3] = {p[0] - f->center[0], p[1] - f->center[1], p[2] - f->center[2]};
  double x = vl_dot3(d, f->right), y = vl_dot3(d, f->up), z = vl_dot3(d, f->ahead);
  f->sides[0] = fmax(f->sides[0], x - f->tan_x * z);
  f->sides[1] = fmax(f->sides[1], -x - f->tan_x * z);
  f->sides[2] = fmax(f->sides[2], y - f->tan_y * z);
  f->sides[3] = fmax(f->sides[3], -y - f->tan_y * z);
  f->near = fmin(f->near, z);
  f->far = fmax(f->far, z);
}

/* Directions of the scene, and from where the camera looks. */
typedef struct View {
  double right[3], up[3], front[3];
  double azimuth, elevation; /* radians: from the front to the right, above the horizon */
  bool front_unknown;        /* the file does not say which side is its front */
  bool on_plain;             /* the model stands on a plain */
  vlExtent shown;            /* model and ground around it */
  vlPlains plains;           /* the searches for them so far */
} View;

static double extent_along(const vlExtent *box, const double axis[3]) {
  double sum = 0;
  for (int i = 0; i < 3; i++)
    sum += fabs(axis[i]) * vl_extent_size(box, i);
  return sum;
}

/* Whether a surface with this mean normal is as good as closed: it does not say its front. */
static bool is_closed(const double mean_normal[3]) {
  return vl_norm3(mean_normal) < 0.05;
}

/* Turns a view that shows a tilted plane edge-on by the least angle at which it lies open, and
 * upwards rather than downwards: a plane that faces up is seen from above. */
static bool open_plane(const vlScene *scene, const vlExtent *box, View *v) {
  const double open = 0.6, steepest = 1.2; /* sine of the least angle to the plane; radians */
  double n[3], ahead[3], level = 0;
  if (v->on_plain || !vl_tilt_find(scene, box, n))
    return false;
  for (int i = 0; i < 3; i++)
    ahead[i] = vl_precise_cos(v->elevation) * (vl_precise_cos(v->azimuth) * v->front[i] +
                                               vl_precise_sin(v->azimuth) * v->right[i]) +
               vl_precise_sin(v->elevation) * v->up[i];
  double along = vl_dot3(n, ahead);
  const double rise = vl_dot3(n, v->up), upwards = 0.1;
  if (fabs(along) >= open)
    return false;
  const double sign = (fabs(rise) > upwards ? rise : along) < 0 ? -1 : 1;
  along *= sign;
  for (int i = 0; i < 3; i++) {
    n[i] *= sign;
    ahead[i] -= along * n[i]; /* in the plane */
  }
  level = vl_norm3(ahead);
  if (!(level > 0))
    return false;
  for (int i = 0; i < 3; i++)
    ahead[i] = sqrt(1 - open * open) * ahead[i] / level + open * n[i];
  const double x = vl_dot3(ahead, v->right), z = vl_dot3(ahead, v->front);
  v->azimuth = vl_atan2_double(x, z);
  v->elevation =
      fmin(fmax(vl_atan2_double(vl_dot3(ahead, v->up), sqrt(x * x + z * z)), 0), steepest);
  return true;
}

/* The axis that points up; 3: none does. */
static int upward_axis(const View *v) {
  int axis = 0;
  while (axis < 3 && v->up[axis] != 1)
    axis++;
  return axis;
}

/* Whether the view is one into a room without a ceiling; then it is from higher above. */
static bool look_into(const vlScene *scene, const vlExtent *box, View *v) {
  const int axis = upward_axis(v);
  if (axis == 3 || v->on_plain || !vl_tray_is(scene, box, axis))
    return false;
  v->elevation = 0.9;
  return true;
}

/* Flat models are seen nearly along their normal, from the side of their faces' fronts (flat
 * ground from below only if it cannot be seen from above); charts that are less flat, from the
 * front. */
static const char *find_view(const vlScene *scene, const vlCompleteDef *def,
                             const vlExtent *box, View *v) {
  v->azimuth = 0.45;
  v->elevation = 0.3;
  if (def->framing == VL_FRAMING_FRONT)
    v->azimuth = v->elevation = 0;
  if (def->framing == VL_FRAMING_FRONT)
    return "from the front, as asked";
  double x = extent_along(box, v->right), y = extent_along(box, v->up),
         z = extent_along(box, v->front), n[3];
  if (def->framing == VL_FRAMING_CORNER || !(x + y + z > 0))
    return "from the front, a little from the right and above";
  const double flat = 0.2, chart = 0.4, against = -0.05, half_turn = M_PI;
  vl_facing_mean_normal(scene, y <= flat * fmin(x, z), n);
  if (fmin(x, z) > 0 && y <= flat * fmin(x, z)) {
    const bool below = vl_dot3(n, v->up) < against;
    const double high = 0.9 - 0.45 * y / (flat * fmin(x, z)); /* the flatter, the more so */
    v->elevation = below ? -high : high;
    v->azimuth = 0.25;
    return below ? "flat: from below" : "flat: from above";
  }
  if (z <= chart * fmin(x, y)) {
    const bool raised =
        v->front_unknown && is_closed(n) && vl_facing_raised_is_behind(scene, box, v->front);
    const bool behind = z <= flat * fmin(x, y) && (vl_dot3(n, v->front) < against || raised);
    v->azimuth = (behind ? half_turn : 0) + 0.25;
    v->elevation = 0.15;
    return behind ? "flat: from behind" : "flat: from the front";
  }
  if (x <= flat * fmin(y, z)) {
    const bool raised = is_closed(n) && vl_facing_raised_is_behind(scene, box, v->right);
    const bool left = vl_dot3(n, v->right) < against || raised;
    v->azimuth = left ? -0.5 * half_turn - 0.25 : 0.5 * half_turn - 0.25;
    v->elevation = 0.15;
    return left ? "flat: from the left" : "flat: from the right";
  }
  const bool behind = v->front_unknown && vl_facing_is_behind(scene, box, v->front);
  v->azimuth += behind ? half_turn : 0;
  if (look_into(scene, box, v))
    return "open above: from above";
  if (open_plane(scene, box, v))
    return "flat and tilted: from the side on which it lies open";
  return behind ? "from behind, where the model has more detail"
                : "from the front, a little from the right and above";
}

static const char *choose_view(const vlScene *scene, const vlCompleteDef *def,
                               const vlExtent *box, View *v) {
  const char *from = find_view(scene, def, box, v);
  if (vl_is_unset(def->azimuth) && vl_is_unset(def->elevation))
    return from;
  if (!vl_is_unset(def->azimuth))
    v->azimuth = def->azimuth;
  if (!vl_is_unset(def->elevation))
    v->elevation = def->elevation;
  return "as given";
}

static void set_camera(vlScene *scene, const double up[3], double fov, const double eye[3],
                       const double lookat[3]) {
  vlSceneDefs *s = &scene->defs;
  vlCameraDef camera = vl_default_camera_def(s->film.width, s->film.height);
  camera.shutter_open = s->camera.shutter_open;
  camera.shutter_close = s->camera.shutter_close;
  camera.fov = fov;
  camera.fov_axis = VL_FOV_SMALLER;
  memcpy(camera.lookat, lookat, 3 * sizeof *camera.lookat);
  memcpy(camera.eye, eye, 3 * sizeof *camera.eye);
  memcpy(camera.up, up, 3 * sizeof *camera.up);
  s->camera = camera;
  s->camera_source = (vlSource){0};
  s->camera_missing = false;
}

/* without: shapes that need not be in the image; may be null. */
static void frame_camera(vlScene *scene, const View *v, const vlExtent *box,
                         const vlExtent *boxes, const bool *without) {
  const double fov = 0.6, margin = v->on_plain ? 0.7 : 0.9; /* some ground is seen around */
  const double closest = 0.2; /* distance of the nearest point, in parts of the depth of all */
  const vlSceneDefs *s = &scene->defs;
  double half = vl_precise_tan(0.5 * fov), aspect = (double)s->film.width / s->film.height,
         lookat[3], eye[3];
  double ca = vl_precise_cos(v->azimuth), sa = vl_precise_sin(v->azimuth),
         ce = vl_precise_cos(v->elevation), se = vl_precise_sin(v->elevation);
  Frame f = {.tan_x = margin * half * (aspect > 1 ? aspect : 1),
             .tan_y = margin * half * (aspect > 1 ? 1 : 1 / aspect)};
  for (int i = 0; i < 3; i++) {
    f.center[i] = box->low[i] <= box->high[i] ? 0.5 * (box->low[i] + box->high[i]) : 0;
    f.ahead[i] = -(ce * (ca * v->front[i] + sa * v->right[i]) + se * v->up[i]);
    f.right[i] = ca * v->right[i] - sa * v->front[i];
  }
  vl_cross3(f.right, f.ahead, f.up);
  for (int i = 0; i < 4; i++)
    f.sides[i] = -INFINITY;
  f.near = INFINITY;
  f.far = -INFINITY;
  vl_extent_visit(scene, boxes, without, widen, &f);
  double x = 0, y = 0, d = 1;
  if (isfinite(f.sides[0])) {
    x = 0.5 * (f.sides[0] - f.sides[1]);
    y = 0.5 * (f.sides[2] - f.sides[3]);
    d = fmax((f.sides[0] + f.sides[1]) / (2 * f.tan_x),
             (f.sides[2] + f.sides[3]) / (2 * f.tan_y));
    /* what is thin and long, and seen from its end, is not touched by the camera */
    d = fmax(d, closest * (f.far - f.near) - f.near);
  }
  if (!(d > 0) || !isfinite(d))
    d = 1;
  for (int i = 0; i < 3; i++) {
    lookat[i] = f.center[i] + x * f.right[i] + y * f.up[i];
    eye[i] = lookat[i] - d * f.ahead[i];
  }
  set_camera(scene, v->up, fov, eye, lookat);
}

/* ---- closed models ----------------------------------------------------------------------- */

/* *box becomes what a dome contains. camera: one is added: before what a dome contains, or in
 * the middle of a shell that contains nothing. */
static void frame_closed(vlScene *scene, const View *v, bool camera, const vlClosed *closed,
                         vlExtent *box, const vlExtent *boxes) {
  double ahead[3];
  if (closed->kind == VL_CLOSED_DOME) {
    *box = vl_extent_nothing;
    vl_extent_visit(scene, boxes, closed->shell, vl_extent_grow, box);
    if (camera)
      frame_camera(scene, v, box, boxes, closed->shell);
  }
  if (closed->kind == VL_CLOSED_EMPTY && camera) {
    vl_sub3(closed->middle, v->front, ahead);
    set_camera(scene, v->up, 1.2, closed->middle, ahead);
  }
}

static bool is_inside(const vlClosed *closed) {
  return closed->kind == VL_CLOSED_DOME || closed->kind == VL_CLOSED_EMPTY;
}

/* Finds whether the model is closed. from: the eye of the added camera; in its place comes, of
 * a dome and an empty shell, a point far away behind the camera: light comes in from there. */
static bool choose_walls(vlScene *scene, const View *v, const vlExtent *whole,
                         const vlExtent *boxes, double from[3], vlClosed *closed) {
  double size = 0, far_away[3];
  if (!vl_closed_find(scene, whole, boxes, from, true, closed))
    return false;
  if (!is_inside(closed))
    return true;
  vlExtent box = *whole;
  frame_closed(scene, v, true, closed, &box, boxes);
  for (int i = 0; i < 3; i++)
    size += vl_extent_size(whole, i);
  for (int i = 0; i < 3; i++) {
    double away = closed->kind == VL_CLOSED_EMPTY
                      ? v->front[i]
                      : scene->defs.camera.eye[i] - closed->middle[i];
    far_away[i] =
        closed->middle[i] + 1e4 * size * away / (closed->kind == VL_CLOSED_EMPTY ? 1 : size);
  }
  /* what is found must be found from that point alone */
  vlClosed again;
  if (!vl_closed_find(scene, whole, boxes, far_away, true, &again))
    return false;
  bool same = again.kind == closed->kind;
  if (same)
    memcpy(from, far_away, sizeof far_away);
  vl_free(scene->context, same ? closed->shell : again.shell);
  *closed = same ? again : *closed;
  return true;
}

/* Lets camera and light into a closed model. */
static bool open_model(vlScene *scene, const vlClosed *closed, const double from[3]) {
  uint64_t count = 0;
  bool inside = is_inside(closed);
  if (inside && closed->emits) {
    vl_log(scene->context, VL_LOG_INFO, NULL,
           "the model is closed and emits light: the camera is inside");
    return true;
  }
  if (!vl_closed_open(scene, closed, from, &count))
    return false;
  vl_log(scene->context, VL_LOG_INFO, NULL,
         "the model is closed: %s%llu of its faces, on the camera's side, are hidden",
         inside ? "the camera is inside, and " : "", (unsigned long long)count);
  return true;
}

/* Lets one-sided faces be seen from both sides, also those in groups. */
static void show_both_sides(vlScene *scene) {
  for (size_t i = 0; i < scene->shapes.count; i++)
    scene->shapes.items[i].one_sided = false;
}

/* Leaves out the walls of a closed model. *box: what the camera and the ground are for. */
static bool open_walls(vlScene *scene, const View *v, bool camera, vlExtent *box,
                       const vlExtent *boxes, vlClosed *closed) {
  vlCompleteDef *done = &scene->completed;
  const vlExtent whole = *box;
  double from[3];
  bool given = !vl_is_unset(done->walls_from[0]);
  memcpy(from, given ? done->walls_from : scene->defs.camera.eye, sizeof from);
  bool ok = given ? vl_closed_find(scene, &whole, boxes, from, false, closed)
                  : choose_walls(scene, v, &whole, boxes, from, closed);
  const bool turned = ok && closed->kind == VL_CLOSED_TURNED;
  done->both_sides = done->both_sides || turned;
  if (turned)
    vl_log(scene->context, VL_LOG_INFO, NULL,
           "the model's faces look inwards: they are seen from both sides");
  done->open_walls = ok && closed->kind != VL_CLOSED_NOT && !turned;
  if (done->open_walls) {
    memcpy(done->walls_from, from, sizeof from);
    frame_closed(scene, v, camera, closed, box, boxes);
    ok = open_model(scene, closed, from);
  }
  vl_free(scene->context, closed->shell);
  return ok;
}

static void tell_camera(const vlScene *scene, const char *view, const vlExtent *box) {
  vl_log(scene->context, VL_LOG_DEBUG, NULL, "camera: %s; the model is %.4g x %.4g x %.4g",
         view, vl_extent_size(box, 0), vl_extent_size(box, 1), vl_extent_size(box, 2));
}

/* ---- the ground -------------------------------------------------------------------------- */

/* Opacity over v of a disk, which is 1 in the middle: opaque around the model, transparent at
 * the rim. */
static bool fade_texture(vlScene *scene, vlTextureId *id) {
  enum { ROWS = 128 };
  vlImageDef def = vl_default_image_def(1, ROWS, 1);
  def.type = VL_PIXEL_F32;
  vlImage *image = NULL;
  if (vl_image_create(scene->context, &def, &image) != VL_OK)
    return vl_scene_fail_memory(scene);
  float *pixels = vl_image_pixels(image);
  for (int y = 0; y < ROWS; y++) {
    float v = 1 - ((float)y + 0.5f) / ROWS, t = v / 0.7f; /* rows from the top, where v is 1 */
    t = t < 1 ? t : 1;
    pixels[y] = t * t * (3 - 2 * t);
  }
  vlTextureDef texture = vl_default_texture_def(VL_TEXTURE_IMAGE, false);
  texture.image = image;
  texture.wrap = VL_WRAP_CLAMP;
  *id = vl_scene_add_texture(scene, &texture);
  vl_image_destroy(image);
  return id->index != 0;
}

/* Middle and radius of a disk under everything, where they are not given. */
static void place_ground(vlCompleteDef *def, const View *v, const vlExtent *box, bool fades) {
  double center[3], size = 0;
  for (int i = 0; i < 3; i++) {
    bool some = box->low[i] <= box->high[i];
    center[i] = some ? 0.5 * (box->low[i] + box->high[i]) : 0;
    size += some ? vl_extent_size(box, i) * vl_extent_size(box, i) : 1;
  }
  size = sqrt(size);
  if (!(size > 0))
    size = 1;
  double lowest = INFINITY;
  for (int k = 0; k < 8; k++) {
    double corner[3];
    vl_extent_corner(box, k, corner);
    vl_sub3(corner, center, corner);
    lowest = fmin(lowest, vl_dot3(corner, v->up));
  }
  if (!isfinite(lowest))
    lowest = 0;
  for (int i = 0; i < 3; i++)
    if (vl_is_unset(def->ground_middle[i]))
      def->ground_middle[i] = center[i] + (lowest - 1e-4 * size) * v->up[i];
  if (vl_is_unset(def->ground_radius))
    def->ground_radius = (fades ? 2.5 : 40) * size;
  def->ground_radius = (double)(float)def->ground_radius;
}

/* A disk. fades: with the radiance of a studio's floor, into which it fades. */
static bool add_ground(vlScene *scene, const View *v, bool fades) {
  const vlCompleteDef *def = &scene->completed;
  vlMaterialDef material = vl_default_material_def(VL_MATERIAL_DIFFUSE);
  material.name = "ground";
  vlShapeDef disk = vl_default_shape_def(VL_SHAPE_DISK);
  disk.radius = (float)def->ground_radius;
  disk.backdrop = fades;
  if (fades && !fade_texture(scene, &disk.alpha.texture))
    return false;
  const vlStudio *studio = vl_studio(def->environment);
  const float *albedo = (studio ? studio : vl_studio(VL_ENVIRONMENT_STUDIO))->floor;
  if (fades)
    material.reflectance = vl_spectrum_input(vl_spectrum_rgb(albedo[0], albedo[1], albedo[2]));
  disk.material = vl_scene_add_material(scene, &material);
  for (int i = 0; i < 3; i++) {
    disk.group_from_shape[4 * i] = v->right[i];
    disk.group_from_shape[4 * i + 1] = -v->front[i];
    disk.group_from_shape[4 * i + 2] = v->up[i];
    disk.group_from_shape[4 * i + 3] = def->ground_middle[i];
  }
  return vl_scene_add_shape(scene, &disk).index != 0;
}

/* ---- the steps --------------------------------------------------------------------------- */

/* Lux that light a scene well enough without the studio, which gives about 2. */
static const double LIT_BY_SURFACES = 0.2;

/* The studio is the fill light of the scene's own lamps: 0.3 times their light. A file with a
 * camera is a scene, not a model alone, and gets none where its surfaces light it. */
static void fit_studio(const vlScene *scene, const vlExtent *boxes, vlCompleteDef *done) {
  double lux = vl_lamp_illuminance(scene, boxes), own = vl_surface_illuminance(scene, boxes);
  if (own > 0)
    vl_log(scene->context, VL_LOG_DEBUG, NULL,
           "light: surfaces of the file that emit light give %.3g lux", own);
  if (own >= LIT_BY_SURFACES && scene->camera_read) {
    done->environment = VL_ENVIRONMENT_NONE;
    return;
  }
  if (lux > 0)
    done->strength *= (float)(0.3 * lux / M_PI);
  if (lux > 0)
    vl_log(scene->context, VL_LOG_DEBUG, NULL,
           "light: the file's lamps give %.3g lux; the studio adds 0.3 times that", lux);
  else
    vl_log(scene->context, VL_LOG_DEBUG, NULL, "light: the studio");
}

static bool ground_is_given(const vlCompleteDef *def) {
  return !vl_is_unset(def->ground_middle[0]) || !vl_is_unset(def->ground_radius);
}

static bool walls_are_given(const vlCompleteDef *def) {
  return def->open_walls && !vl_is_unset(def->walls_from[0]);
}

/* The view of the file's camera, in the terms of an added one's. Returns whether it looks
 * from above at a model that it is not in, so that a ground does not come between them. */
static bool find_own_view(const vlScene *scene, const vlExtent *box, View *v) {
  const vlCameraDef *c = &scene->defs.camera;
  const double *m = c->world_from_camera;
  double eye[3], back[3], inside = 1, above = 0;
  for (int i = 0; i < 3; i++) {
    eye[i] = c->has_matrix ? m[4 * i + 3] : c->eye[i];
    back[i] = c->has_matrix ? -m[4 * i + 2] : c->eye[i] - c->lookat[i];
    inside *= eye[i] > box->low[i] && eye[i] < box->high[i];
    above += v->up[i] * (eye[i] - (v->up[i] > 0 ? box->low[i] : box->high[i]));
  }
  const double length = vl_norm3(back);
  if (!(length > 0) || !isfinite(length + above))
    return false;
  v->azimuth = vl_atan2_double(vl_dot3(back, v->right), vl_dot3(back, v->front));
  v->elevation = vl_dot3(back, v->up) / length; /* its sine: only the sign is used */
  return !(inside > 0) && above > 0 && v->elevation >= 0;
}

/* Finds the plain on which a model stands. *box becomes that of the model, and so do the
 * limits, down to the ground. */
static void find_plain(const vlScene *scene, vlExtent *boxes, vlExtent *box, View *v) {
  const int axis = upward_axis(v);
  const vlPlain *plain = axis < 3 ? vl_plain_search(scene, boxes, axis, &v->plains) : NULL;
  if (!plain)
    return;
  v->on_plain = true;
  v->shown = plain->shown;
  *box = plain->model;
  box->low[axis] = plain->shown.low[axis];
  boxes[scene->groups.count] = *box;
  vl_log(scene->context, VL_LOG_DEBUG, NULL, "camera: the model stands on a wide flat ground");
}

/* Camera, opening and ground. The scene's `completed` has what is asked for and gets what is
 * chosen. */
static bool complete_geometry(vlScene *scene, const View *axes, bool camera, vlExtent *boxes) {
  vlCompleteDef *done = &scene->completed;
  const bool studio = vl_environment_is_studio(done->environment);
  const bool own = !camera && scene->camera_read;
  vlExtent box = vl_extent_nothing;
  View view = *axes;
  vlClosed closed = {.kind = VL_CLOSED_NOT};
  bool ok = true;
  vl_extent_visit(scene, boxes, NULL, vl_extent_grow, &box);
  find_plain(scene, boxes, &box, &view);
  if (camera) {
    const char *from = choose_view(scene, done, &box, &view);
    tell_camera(scene, from, &box);
    frame_camera(scene, &view, &box, boxes, NULL);
    set_framed(scene, &box);
    done->azimuth = view.azimuth;
    done->elevation = view.elevation;
  }
  if (view.on_plain) {
    boxes[scene->groups.count] = view.shown;
    vl_extent_visit(scene, boxes, NULL, vl_extent_grow, &box); /* the ground is under both */
  }
  bool stands = camera || (own && find_own_view(scene, &box, &view));
  if (studio && vl_is_unset(done->rotation) && (camera || own))
    done->rotation = view.azimuth - 0.45; /* the main light stays to its left */
  if ((camera && done->open_walls) || walls_are_given(done))
    ok = open_walls(scene, &view, camera, &box, boxes, &closed);
  else
    done->open_walls = false;
  if (camera && closed.kind == VL_CLOSED_DOME)
    set_framed(scene, &box);
  bool wanted =
      ground_is_given(done) || (stands && studio && !is_inside(&closed) && view.elevation >= 0);
  bool fades = done->backdrop && wanted && !done->ground;
  done->backdrop = fades;
  if (done->ground || fades)
    place_ground(done, &view, &box, fades);
  if (ok && (done->ground || fades))
    ok = add_ground(scene, &view, fades);
  if (ok && fades)
    vl_log(scene->context, VL_LOG_DEBUG, NULL, "ground: under the model, fading");
  return ok;
}

/* Of a def in which every choice is made, what was not added is not asked for; azimuth and
 * elevation say what the framing said. */
static void leave_out(vlCompleteDef *done, bool camera) {
  done->framing = VL_FRAMING_AUTO;
  if (!camera)
    done->azimuth = done->elevation = VL_UNSET;
  if (!done->open_walls)
    done->walls_from[0] = done->walls_from[1] = done->walls_from[2] = VL_UNSET;
  if (!done->ground && !done->backdrop)
    done->ground_middle[0] = done->ground_middle[1] = done->ground_middle[2] =
        done->ground_radius = VL_UNSET;
  if (done->environment == VL_ENVIRONMENT_NONE)
    done->rotation = VL_UNSET;
}

static void choose_size(vlSceneDefs *s, const vlCompleteDef *def) {
  const uint32_t whole[4] = {0, 0, def->width, def->height};
  s->film.width = def->width;
  s->film.height = def->height;
  memcpy(s->film.crop, whole, sizeof whole);
}

/* The boxes of the groups, and the limits without stray parts. Does nothing where *boxes has
 * them. False: the scene holds the error. */
static bool find_boxes(vlScene *scene, bool camera, vlExtent **boxes) {
  uint64_t count = 0;
  if (*boxes)
    return true;
  if (!vl_extent_groups(scene, boxes))
    return false;
  vl_stray_limit(scene, *boxes, &count);
  if (camera && count)
    vl_log(scene->context, VL_LOG_INFO, NULL,
           "camera: %llu small parts, far away from the rest, are not in its view",
           (unsigned long long)count);
  return true;
}

/* Where the direction upwards is to be found. False: the scene holds the error. */
static bool choose_up(vlScene *scene, vlCompleteDef *done, bool camera, vlExtent **boxes,
                      vlPlains *plains) {
  if (!done->find_up)
    return true;
  if (!find_boxes(scene, camera, boxes))
    return false;
  if (vl_upright_find(scene, *boxes, plains, done->up, done->front))
    vl_log(scene->context, VL_LOG_DEBUG, NULL, "up: %s: the model stands on its base only so",
           done->up[2] != 0 ? "z" : "y");
  done->find_up = false;
  return true;
}

static vlResult check_complete(vlScene *scene, const vlCompleteDef *def, vlError *error) {
  if (!scene)
    return vl_fail_argument(error, "scene complete: scene is null");
  if (def->cookie != VL_COOKIE_COMPLETE)
    return vl_fail_argument(error, "scene complete: " VL_BAD_COOKIE);
  char wrong[VL_GIVEN_MESSAGE];
  if (!vl_choices_check(VL_SETTING_COMPLETE, 0, sizeof *def, def, wrong))
    return vl_fail_argument(error, "scene complete: %s", wrong);
  return vl_scene_result(scene, error);
}

vlResult vl_scene_complete(vlScene *scene, const vlCompleteDef *given, vlError *error) {
  vl_error_clear(error);
  const vlCompleteDef def = given ? *given : vl_default_complete_def();
  VL_TRY(check_complete(scene, &def, error));
  vlSceneDefs *s = &scene->defs;
  vlCompleteDef *done = &scene->completed;
  *done = def;
  set_framed(scene, &vl_extent_nothing);
  bool camera = s->camera_missing || def.reframe;
  if ((s->camera_missing || s->light_missing) && !vl_mend_model(scene))
    return vl_scene_result(scene, error);
  if (camera && def.width && def.height)
    choose_size(s, &def);
  if (def.environment == VL_ENVIRONMENT_AUTO)
    done->environment = s->light_missing ? VL_ENVIRONMENT_STUDIO : VL_ENVIRONMENT_NONE;
  bool fits =
      done->environment != def.environment && done->environment == VL_ENVIRONMENT_STUDIO;
  View axes = {.front_unknown = def.find_up};
  vlExtent *boxes = NULL;
  bool ok = choose_up(scene, done, camera, &boxes, &axes.plains);
  if (ok && !vl_scene_axes(done, axes.right, axes.up, axes.front)) {
    vl_scene_fail(scene, VL_ERROR_ARGUMENT, (vlSource){0},
                  "camera: the axes up and front make no sense");
    ok = false;
  }
  if (!ok) {
    vl_free(scene->context, boxes);
    return vl_scene_result(scene, error);
  }
  if (fits && (ok = find_boxes(scene, camera, &boxes)))
    fit_studio(scene, boxes, done);
  const vlEnvironmentKind kind = done->environment;
  bool own_studio = scene->camera_read && vl_environment_is_studio(kind) &&
                    (def.backdrop || vl_is_unset(def.rotation));
  bool geometry = camera || def.ground || own_studio ||
                  (def.backdrop && ground_is_given(&def)) || walls_are_given(&def);
  const bool lamps = kind == VL_ENVIRONMENT_LAMPS;
  if (ok && (geometry || lamps))
    ok = find_boxes(scene, camera, &boxes);
  if (ok && geometry)
    ok = complete_geometry(scene, &axes, camera, boxes);
  else
    done->open_walls = done->backdrop = false;
  if (ok && lamps)
    ok = vl_scene_add_lamps(scene, boxes, axes.up, done->strength);
  vl_free(scene->context, boxes);
  if (done->both_sides)
    show_both_sides(scene);
  if (vl_is_unset(done->rotation))
    done->rotation = 0;
  if (ok && kind != VL_ENVIRONMENT_NONE && vl_scene_add_environment(scene, done, kind))
    s->light_missing = false;
  leave_out(done, camera);
  return vl_scene_result(scene, error);
}
