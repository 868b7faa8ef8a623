/* view/camera_keep.c: see camera_keep.h. */
#include "view/camera_keep.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "view/camera_edit.h"

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
enum { FOCAL = sizeof focal / sizeof *focal };

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

static bool near(double a, double b) {
  return a == b || fabs(a - b) <= 1e-9 * fmax(fabs(a), fabs(b));
}

static bool same_size(const ViewCamera *a, const ViewCamera *b) {
  return a->made.width == b->made.width && a->made.height == b->made.height;
}

/* Whether two cameras have the same field of view, in the sense of --resolution. */
static bool same_field(const vlCamera *a, const vlCamera *b) {
  vlCamera c;
  return vl_camera_resize(a, b->width, b->height, &c) == VL_OK && near(c.fx, b->fx) &&
         near(c.fy, b->fy) && near(c.cx, b->cx) && near(c.cy, b->cy) && near(c.skew, b->skew);
}

/* Whether all that does not depend on the size is the same. */
static bool same_rest(const vlCamera *a, const vlCamera *b) {
  return a->projection == b->projection && a->lens_radius == b->lens_radius &&
         near(a->focus_distance, b->focus_distance) && a->near_plane == b->near_plane &&
         a->far_plane == b->far_plane && a->exposure_time == b->exposure_time &&
         a->shutter_open == b->shutter_open && a->shutter_close == b->shutter_close &&
         memcmp(a->shape, b->shape, sizeof a->shape) == 0 &&
         memcmp(a->world_from_camera, b->world_from_camera, sizeof a->world_from_camera) == 0 &&
         memcmp(&a->distortion, &b->distortion, sizeof a->distortion) == 0;
}

static bool has_parts_of_scene(const ViewCamera *camera) {
  return camera->def.lens.optics || camera->def.lens.aperture;
}

bool camera_keep(const ViewCamera *before, const ViewCamera *now, const ViewCamera *shown,
                 ViewCamera *kept) {
  const bool sized = same_size(before, now);
  if (has_parts_of_scene(shown) || !same_rest(&before->made, &now->made))
    return false;
  if (!same_field(&before->made, &now->made) && (sized || !same_focal(&before->def, &now->def)))
    return false;
  ViewCamera next = *shown;
  if (sized) {
    *kept = next;
    return true;
  }
  vlError error;
  vlCamera made;
  if (same_focal(&shown->def, &before->def)) {
    copy_focal(&now->def, &next.def);
    next.def.width = now->def.width;
    next.def.height = now->def.height;
    if (vl_camera_make(&next.def, &next.made, NULL, &error) != VL_OK)
      return false;
  } else if (vl_camera_resize(&shown->made, now->made.width, now->made.height, &made) !=
                 VL_OK ||
             camera_take(&shown->def, &made, shown->units.lookat, &next, &error) != VL_OK) {
    return false;
  }
  next.units = shown->units;
  *kept = next;
  return same_size(kept, now);
}

bool camera_follow(const ViewCamera *before, const ViewCamera *now, const ViewCamera *shown,
                   bool added, ViewCamera *kept) {
  vlError error;
  if (has_parts_of_scene(shown))
    return false;
  if (!added && same_size(before, shown) && same_rest(&before->made, &shown->made) &&
      same_field(&before->made, &shown->made)) {
    *kept = *now;
    return true;
  }
  ViewCamera next;
  if (camera_set_shutter(shown, now->def.shutter_open, now->def.shutter_close, &next, &error) !=
      VL_OK)
    return false;
  *kept = next;
  return true;
}
