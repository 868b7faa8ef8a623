/* view/engine_reload.c: the render goes on with a world that was loaded anew: after a change of
 * the scene's files (engine_watch.c), or because a page chose another of the lecture's scenes,
 * which are loaded here. */
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "cli/macros.h"
#include "cli/report.h"
#include "cli/vector.h"
#include "view/camera_edit.h"
#include "view/camera_pose.h"
#include "view/engine_status.h"

/* The numbers of a def that say how large things are in the image. */
static const size_t focal[] = {
    offsetof(vlCameraDef, fov),          offsetof(vlCameraDef, view_distance),
    offsetof(vlCameraDef, zoom),         offsetof(vlCameraDef, pixel_size),
    offsetof(vlCameraDef, focal_mm),     offsetof(vlCameraDef, sensor_width_mm),
    offsetof(vlCameraDef, fx),           offsetof(vlCameraDef, fy),
    offsetof(vlCameraDef, skew),         offsetof(vlCameraDef, cx),
    offsetof(vlCameraDef, cy),           offsetof(vlCameraDef, screen_min_x),
    offsetof(vlCameraDef, screen_max_x), offsetof(vlCameraDef, screen_min_y),
    offsetof(vlCameraDef, screen_max_y)};
enum { FOCAL = LENGTH(focal) };

static double number_at(const vlCameraDef *def, size_t offset) {
  double value;
  memcpy(&value, (const char *)def + offset, sizeof value);
  return value;
}

static bool same_focal(const vlCameraDef *a, const vlCameraDef *b) {
  bool same = a->projection == b->projection && a->fov_axis == b->fov_axis;
  for (int i = 0; i < FOCAL; i++) {
    const double x = number_at(a, focal[i]), y = number_at(b, focal[i]);
    same &= x == y || (isnan(x) && isnan(y));
  }
  return same;
}

static void copy_focal(const vlCameraDef *from, vlCameraDef *to) {
  to->fov_axis = from->fov_axis;
  for (int i = 0; i < FOCAL; i++)
    memcpy((char *)to + focal[i], (const char *)from + focal[i], sizeof(double));
}

static bool same_size(const ViewCamera *a, const ViewCamera *b) {
  return a->made.width == b->made.width && a->made.height == b->made.height;
}

/* Whether two cameras have the same field of view, in the sense of --resolution. */
static bool same_field(const vlCamera *a, const vlCamera *b) {
  vlCamera c;
  return vl_camera_resize(a, b->width, b->height, &c) == VL_OK && is_near(c.fx, b->fx) &&
         is_near(c.fy, b->fy) && is_near(c.cx, b->cx) && is_near(c.cy, b->cy) &&
         is_near(c.skew, b->skew);
}

/* Whether all that does not depend on the size is the same. */
static bool same_rest(const vlCamera *a, const vlCamera *b) {
  return a->projection == b->projection && a->lens_radius == b->lens_radius &&
         is_near(a->focus_distance, b->focus_distance) && a->near_plane == b->near_plane &&
         a->far_plane == b->far_plane && a->exposure_time == b->exposure_time &&
         a->shutter_open == b->shutter_open && a->shutter_close == b->shutter_close &&
         memcmp(a->shape, b->shape, sizeof a->shape) == 0 &&
         memcmp(a->world_from_camera, b->world_from_camera, sizeof a->world_from_camera) == 0 &&
         memcmp(&a->distortion, &b->distortion, sizeof a->distortion) == 0;
}

static bool has_parts_of_scene(const ViewCamera *camera) {
  return camera->def.lens.optics || camera->def.lens.aperture;
}

/* before, now: the scene's camera, before and now. False: the scene's camera changed in more
 * than the size of the image. Else *camera is the page's camera for the size of the image: its
 * field of view is that of the scene's camera if the page left it so; otherwise it is kept
 * across the smaller side, as with --resolution. */
static bool keep_camera(const ViewCamera *before, const ViewCamera *now, ViewCamera *camera) {
  const bool sized = same_size(before, now);
  if (!same_rest(&before->made, &now->made))
    return false;
  if (!same_field(&before->made, &now->made) && (sized || !same_focal(&before->def, &now->def)))
    return false;
  if (sized)
    return true;
  ViewCamera next = *camera;
  vlError error;
  vlCamera made;
  if (same_focal(&camera->def, &before->def)) {
    copy_focal(&now->def, &next.def);
    next.def.width = now->def.width;
    next.def.height = now->def.height;
    if (vl_camera_make(&next.def, &next.made, NULL, &error) != VL_OK)
      return false;
  } else if (vl_camera_resize(&camera->made, now->made.width, now->made.height, &made) !=
                 VL_OK ||
             camera_take(&camera->def, &made, camera->units.lookat, &next, &error) != VL_OK) {
    return false;
  }
  next.units = camera->units;
  *camera = next;
  return same_size(camera, now);
}

/* For another time of the same animation. added: the scene's camera is not the file's. *camera
 * becomes the scene's if that is the file's and the page has not moved it; otherwise it gets
 * the shutter of the new one. */
static bool follow_camera(const ViewCamera *before, const ViewCamera *now, bool added,
                          ViewCamera *camera) {
  vlError error;
  if (!added && same_size(before, camera) && same_rest(&before->made, &camera->made) &&
      same_field(&before->made, &camera->made)) {
    *camera = *now;
    return true;
  }
  return camera_set_shutter(camera, now->def.shutter_open, now->def.shutter_close, camera,
                            &error) == VL_OK;
}

/* False: the camera cannot go on, or it has parts of the old scene. */
static bool carry_camera(bool timed, bool added, const ViewCamera *before,
                         const ViewCamera *now, ViewCamera *camera) {
  if (has_parts_of_scene(camera))
    return false;
  return timed ? follow_camera(before, now, added, camera) : keep_camera(before, now, camera);
}

/* A ReportFn. */
static void post_report(void *engine, const char *kind, const vlError *what) {
  if (!kind || strcmp(kind, "warning") == 0)
    status_problem(engine, kind ? kind : "error", what, what->message);
}

Model *engine_load(Engine *e, const char *path, const ModelTime *time, const vlWorld *previous,
                   FileList *files) {
  Model *model = calloc(1, sizeof *model);
  report_listen(post_report, e);
  const bool loaded = model && model_load(e->def.context, path, e->def.arguments, time,
                                          previous, e->end, model, files) < 0;
  report_listen(NULL, NULL);
  if (loaded)
    return model;
  free(model);
  return NULL;
}

void engine_offer(Engine *e, Model *model, const char *path, uint32_t change) {
  engine_lock(e);
  Model *unused = e->reload.model;
  e->reload.model = model;
  if (path)
    e->reload.path = path;
  e->reload.change = change;
  engine_interrupt(e);
  if (!path)
    engine_drop_traces(e, 0, "the scene changed");
  pthread_cond_broadcast(&e->wake);
  engine_unlock(e);
  model_destroy(unused);
}

/* ---- the lecture's scenes ---------------------------------------------------------------- */

bool engine_load_choice(Engine *e) {
  engine_lock(e);
  const char *path = e->quit ? NULL : e->choice.scene;
  uint32_t change = e->choice.change;
  e->choice.scene = NULL;
  engine_unlock(e);
  if (!path)
    return false;
  FileList files = {.count = 0};
  Model *model = engine_load(e, path, NULL, NULL, &files);
  file_list_free(&files);
  if (model)
    engine_offer(e, model, path, change);
  return true;
}

/* ---- the render thread ------------------------------------------------------------------- */

/* Has the page's camera, its crop and the cameras of its history go on in the scene that was
 * loaded anew, or `timed`, for another time of the same animation; else all begin with the
 * scene's. before: the scene's camera before; page, history: what the page had. The caller
 * holds the lock. */
static void carry_cameras(Engine *e, bool timed, const ViewCamera *before, const Wanted *page,
                          const History *history) {
  const bool added = e->model.opening.camera_added;
  const ViewCamera now = e->scene_camera;
  Wanted *w = &e->wanted;
  History *h = &e->history;
  w->camera = page->camera;
  bool kept = carry_camera(timed, added, before, &now, &w->camera);
  if (!kept) {
    w->camera = now;
    return;
  }
  if (same_size(before, &now))
    memcpy(w->crop, page->crop, sizeof w->crop);
  *h = *history;
  for (uint32_t i = 0; i < h->count && kept; i++)
    kept = carry_camera(timed, added, before, &now, &h->cameras[i]);
  if (kept)
    return;
  h->cameras[0] = w->camera; /* one has parts of the old scene */
  h->count = 1;
  h->at = 0;
}

bool engine_swap_model(Engine *e) {
  static History history; /* the render thread alone uses it */
  engine_lock(e);
  Model *next = e->reload.model;
  engine_unlock(e);
  if (!next)
    return false;
  pthread_rwlock_wrlock(&e->model_lock);
  engine_lock(e);
  next = e->reload.model; /* another load may have replaced it */
  e->reload.model = NULL;
  Model old = e->model;
  const ViewCamera before = e->scene_camera;
  const Wanted page = e->wanted;
  const uint32_t old_spp = old.job.defs->render.spp;
  e->model = *next;
  const bool other = e->reload.path != NULL;
  const bool timed = e->model.timed;
  if (other) {
    e->def.path = e->reload.path;
    e->reload.path = NULL;
    e->wanted.channel = 0;
    e->wanted.paused = false;
  }
  if (other || timed)
    e->wanted.change = e->reload.change;
  history = e->history;
  if (engine_take_model(e) < 0 && (timed || !other))
    carry_cameras(e, timed, &before, &page, &history);
  if ((page.spp != old_spp || timed) && !other)
    e->wanted.spp = page.spp;
  engine_post_state(e, 0);
  engine_unlock(e);
  pthread_rwlock_unlock(&e->model_lock);
  vl_film_destroy(e->film);
  e->film = NULL;
  engine_drop_successor(e);
  engine_warp_forget(e);
  if (!timed)
    e->samples.pixel_seconds = e->coarse.pixel_seconds = e->coarse.channel_seconds = 0;
  model_free(&old);
  free(next);
  return true;
}
