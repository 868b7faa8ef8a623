/* scene/complete.c: completes a file of plain geometry: a camera that frames everything, light, a ground plane. */
#include <math.h>
#include <string.h>

#include "base/cookie.h"
#include "math/elementary.h"
#include "math/transform.h"
#include "scene/environment.h"
#include "scene/schema/schema.h"

vlCompleteDef vl_default_complete_def(void) {
  return (vlCompleteDef){.cookie = VL_COOKIE_COMPLETE, .strength = 1.0f, .up = {0, 1, 0}, .front = {0, 0, 1}};
}

/* ---- where everything is ----------------------------------------------------------------------------------------- */

/* Calls `visit` with points of the scene: several thousand vertices of each mesh, and the corners of the boxes of other
 * shapes. */
typedef void Visit(void *user, const double p[3]);

static void visit_box(const vlMat4 *m, const double low[3], const double high[3], Visit *visit, void *user) {
  for (int k = 0; k < 8; k++) {
    double corner[3] = {k & 1 ? low[0] : high[0], k & 2 ? low[1] : high[1], k & 4 ? low[2] : high[2]}, p[3];
    vl_mat4_point(m, corner, p);
    visit(user, p);
  }
}

static void visit_shape(const vlShapeDef *d, const vlMat4 *world_from_group, size_t most, Visit *visit, void *user) {
  vlMat4 m = vl_mat4_multiply(*world_from_group, vl_mat4_load(d->group_from_shape));
  for (size_t i = 0; d->centers && i < d->faces; i += d->faces / most + 1) {
    const double *c = d->centers + 3 * i;
    double r = d->radii[i], low[3] = {c[0] - r, c[1] - r, c[2] - r}, high[3] = {c[0] + r, c[1] + r, c[2] + r};
    visit_box(&m, low, high, visit, user);
  }
  if (d->centers) return;
  if (!d->positions) {
    double low[3], high[3];
    vl_shape_own_box(d, low, high);
    if (low[0] > high[0]) return;
    visit_box(&m, low, high, visit, user);
    return;
  }
  size_t step = d->vertices / most + 1;
  for (size_t i = 0; i < d->vertices; i += step) {
    double v[3] = {d->positions[3 * i], d->positions[3 * i + 1], d->positions[3 * i + 2]}, p[3];
    vl_mat4_point(&m, v, p);
    visit(user, p);
  }
}

typedef struct Box {
  double low[3], high[3];
} Box;

static void grow(void *user, const double p[3]) {
  Box *b = user;
  for (int i = 0; i < 3; i++) b->low[i] = fmin(b->low[i], p[i]), b->high[i] = fmax(b->high[i], p[i]);
}

static const Box nothing = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};

/* boxes: bounding boxes of the groups, in group space. A file that moves gives points of all its times instead. */
static void visit_scene(const vlScene *scene, const Box *boxes, Visit *visit, void *user) {
  vlMat4 identity = vl_mat4_identity();
  for (size_t i = 0; i + 2 < scene->frame_points.count; i += 3) visit(user, scene->frame_points.items + i);
  if (scene->frame_points.count) return;
  for (size_t i = 0; i < scene->shapes.count; i++)
    if (!scene->shapes.items[i].group.index) visit_shape(&scene->shapes.items[i], &identity, 20000, visit, user);
  for (size_t i = 0; i < scene->instances.count; i++) {
    const vlSceneInstance *instance = &scene->instances.items[i];
    const Box *b = &boxes[instance->group.index - 1];
    vlMat4 m = vl_mat4_load(instance->world_from_group);
    if (b->low[0] <= b->high[0]) visit_box(&m, b->low, b->high, visit, user);
  }
}

static bool group_boxes(vlScene *scene, Box **boxes) {
  *boxes = vl_alloc_array(scene->context, scene->groups.count + 1, sizeof **boxes);
  if (!*boxes) {
    vl_scene_fail(scene, VL_ERROR_MEMORY, (vlSource){0}, "out of memory");
    return false;
  }
  vlMat4 identity = vl_mat4_identity();
  for (size_t i = 0; i < scene->groups.count; i++) (*boxes)[i] = nothing;
  for (size_t i = 0; i < scene->shapes.count; i++) {
    const vlShapeDef *d = &scene->shapes.items[i];
    if (d->group.index) visit_shape(d, &identity, SIZE_MAX, grow, &(*boxes)[d->group.index - 1]);
  }
  return true;
}

/* ---- the camera -------------------------------------------------------------------------------------------------- */

/* The view frustum. sides: offset of each side plane, which is the maximum over all points of x - z tan(half angle) for
 * the right side, and likewise for the others. */
typedef struct Frame {
  double center[3], right[3], up[3], ahead[3];
  double tan_x, tan_y;
  double sides[4];
} Frame;

static double dot(const double a[3], const double b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void widen(void *user, const double p[3]) {
  Frame *f = user;
  double d[3] = {p[0] - f->center[0], p[1] - f->center[1], p[2] - f->center[2]};
  double x = dot(d, f->right), y = dot(d, f->up), z = dot(d, f->ahead);
  f->sides[0] = fmax(f->sides[0], x - f->tan_x * z), f->sides[1] = fmax(f->sides[1], -x - f->tan_x * z);
  f->sides[2] = fmax(f->sides[2], y - f->tan_y * z), f->sides[3] = fmax(f->sides[3], -y - f->tan_y * z);
}

static bool frame_camera(vlScene *scene, const vlCompleteDef *def, const Box *box, const Box *boxes) {
  const double azimuth = 0.45, elevation = 0.3, fov = 0.6, margin = 0.9;
  double right[3], up[3], front[3];
  vlSceneDefs *s = &scene->defs;
  if (!vl_scene_axes(def, right, up, front)) {
    vl_scene_fail(scene, VL_ERROR_ARGUMENT, (vlSource){0}, "camera: the axes up and front make no sense");
    return false;
  }
  double half = vl_precise_tan(0.5 * fov), aspect = (double)s->film.width / s->film.height;
  Frame f = {.tan_x = margin * half * (aspect > 1 ? aspect : 1),
             .tan_y = margin * half * (aspect > 1 ? 1 : 1 / aspect)};
  for (int i = 0; i < 3; i++) {
    f.center[i] = box->low[i] <= box->high[i] ? 0.5 * (box->low[i] + box->high[i]) : 0;
    f.ahead[i] =
        -(vl_precise_cos(elevation) * (vl_precise_cos(azimuth) * front[i] + vl_precise_sin(azimuth) * right[i]) +
          vl_precise_sin(elevation) * up[i]);
    f.right[i] = vl_precise_cos(azimuth) * right[i] - vl_precise_sin(azimuth) * front[i];
  }
  for (int i = 0; i < 3; i++)
    f.up[i] = f.right[(i + 1) % 3] * f.ahead[(i + 2) % 3] - f.right[(i + 2) % 3] * f.ahead[(i + 1) % 3];
  for (int i = 0; i < 4; i++) f.sides[i] = -INFINITY;
  visit_scene(scene, boxes, widen, &f);
  double x = 0, y = 0, d = 1;
  if (isfinite(f.sides[0])) {
    x = 0.5 * (f.sides[0] - f.sides[1]), y = 0.5 * (f.sides[2] - f.sides[3]);
    d = fmax((f.sides[0] + f.sides[1]) / (2 * f.tan_x), (f.sides[2] + f.sides[3]) / (2 * f.tan_y));
  }
  if (!(d > 0) || !isfinite(d)) d = 1;
  vlCameraDef camera = vl_default_camera_def(s->film.width, s->film.height);
  camera.shutter_open = s->camera.shutter_open, camera.shutter_close = s->camera.shutter_close;
  camera.fov = fov;
  camera.fov_axis = VL_FOV_SMALLER;
  for (int i = 0; i < 3; i++) {
    camera.lookat[i] = f.center[i] + x * f.right[i] + y * f.up[i];
    camera.eye[i] = camera.lookat[i] - d * f.ahead[i];
    camera.up[i] = up[i];
  }
  s->camera = camera;
  s->camera_source = (vlSource){0};
  s->camera_missing = false;
  return true;
}

/* ---- the ground -------------------------------------------------------------------------------------------------- */

static bool add_ground(vlScene *scene, const vlCompleteDef *def, const Box *box) {
  double right[3], up[3], front[3], center[3], size = 0;
  if (!vl_scene_axes(def, right, up, front)) return false;
  for (int i = 0; i < 3; i++) {
    bool some = box->low[i] <= box->high[i];
    center[i] = some ? 0.5 * (box->low[i] + box->high[i]) : 0;
    size += some ? (box->high[i] - box->low[i]) * (box->high[i] - box->low[i]) : 1;
  }
  size = sqrt(size);
  if (!(size > 0)) size = 1;
  double lowest = INFINITY;
  for (int k = 0; k < 8; k++) {
    double corner[3] = {k & 1 ? box->low[0] : box->high[0], k & 2 ? box->low[1] : box->high[1],
                        k & 4 ? box->low[2] : box->high[2]};
    for (int i = 0; i < 3; i++) corner[i] -= center[i];
    lowest = fmin(lowest, dot(corner, up));
  }
  if (!isfinite(lowest)) lowest = 0;
  vlMaterialDef material = vl_default_material_def(VL_MATERIAL_DIFFUSE);
  material.name = "ground";
  vlShapeDef disk = vl_default_shape_def(VL_SHAPE_DISK);
  disk.radius = (float)(40 * size);
  disk.material = vl_scene_add_material(scene, &material);
  for (int i = 0; i < 3; i++) {
    disk.group_from_shape[4 * i] = right[i];
    disk.group_from_shape[4 * i + 1] = -front[i];
    disk.group_from_shape[4 * i + 2] = up[i];
    disk.group_from_shape[4 * i + 3] = center[i] + (lowest - 1e-4 * size) * up[i];
  }
  return vl_scene_add_shape(scene, &disk).index != 0;
}

vlResult vl_scene_complete(vlScene *scene, const vlCompleteDef *given, vlError *error) {
  vl_error_clear(error);
  vlCompleteDef def = given ? *given : vl_default_complete_def();
  if (!scene) return vl_fail(error, VL_ERROR_ARGUMENT, "scene complete: scene is null");
  if (def.cookie != VL_COOKIE_COMPLETE) return vl_fail(error, VL_ERROR_ARGUMENT, "scene complete: " VL_BAD_COOKIE);
  if (scene->error.code != VL_OK) return vl_scene_result(scene, error);
  vlSceneDefs *s = &scene->defs;
  bool camera = s->camera_missing || def.reframe;
  if (camera && def.width && def.height) {
    const uint32_t whole[4] = {0, 0, def.width, def.height};
    s->film.width = def.width, s->film.height = def.height;
    memcpy(s->film.crop, whole, sizeof whole);
  }
  Box *boxes = NULL, box = nothing;
  bool ok = true;
  if (camera || def.ground) {
    ok = group_boxes(scene, &boxes);
    if (ok) visit_scene(scene, boxes, grow, &box);
  }
  if (ok && camera) ok = frame_camera(scene, &def, &box, boxes);
  if (ok && def.ground) ok = add_ground(scene, &def, &box);
  vl_free(scene->context, boxes);
  vlEnvironmentKind kind = def.environment;
  /* The studio is dimmed in a scene that has lights. It is added because surfaces without direct light would be
   * black. */
  if (kind == VL_ENVIRONMENT_AUTO && scene->lights.count > 0) def.strength *= 0.3f;
  if (kind == VL_ENVIRONMENT_AUTO) kind = s->light_missing ? VL_ENVIRONMENT_STUDIO : VL_ENVIRONMENT_NONE;
  if (ok && kind != VL_ENVIRONMENT_NONE && vl_scene_add_environment(scene, &def, kind)) s->light_missing = false;
  return vl_scene_result(scene, error);
}
