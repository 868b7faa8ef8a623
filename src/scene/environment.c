/* scene/environment.c: see environment.h. Directions: x right, y ahead (away from the viewer),
 * z up. The image is the equal-area octahedral square of infinite lights
 * (math/octahedral.h). */
#include "scene/environment.h"

#include <math.h>
#include <string.h>

#include "image/image.h"
#include "math/approx_double.h"
#include "math/double3.h"
#include "math/elementary.h"
#include "math/octahedral.h"
#include "math/vec.h"
#include "scene/studio.h"
#include "velo/light.h"

enum { BUILT_IN_SIDE = 512, MAX_SIDE = 2048 };

bool vl_scene_axes(const vlCompleteDef *def, double right[3], double up[3], double front[3]) {
  memcpy(up, def->up, sizeof def->up);
  const double height = vl_normalize3(up);
  vl_along3(def->front, -vl_dot3(def->front, up), up, front);
  const double length = vl_normalize3(front);
  vl_cross3(up, front, right);
  return height > 0 && length > 1e-6 && isfinite(height + length);
}

/* ---- built-in environments --------------------------------------------------------------- */

/* Fills an image of direction. */
typedef struct StudioFill {
  const vlStudio *studio;
  vlImage *image;
} StudioFill;

static void fill_row(void *user, uint32_t y, VL_UNUSED uint32_t worker) {
  const StudioFill *fill = user;
  const float side = (float)fill->image->width;
  float *row = vl_image_row(fill->image, y);
  for (uint32_t x = 0; x < fill->image->width; x++) {
    float *rgb = row + 3 * (size_t)x;
    rgb[0] = rgb[1] = rgb[2] = 0;
    fill->studio->radiance(
        vl_octahedral_decode(((float)x + 0.5f) / side, ((float)y + 0.5f) / side), rgb);
  }
}

static void fill_studio(vlScene *scene, const vlStudio *studio, vlImage *image) {
  StudioFill fill = {studio, image};
  vl_parallel_for(scene->context, image->height, fill_row, &fill);
}

/* Fills the image with skylight. The sun is a separate light. */
static void fill_sky(vlImage *image) {
  static const float zenith[3] = {0.16f, 0.32f, 0.75f}, horizon[3] = {0.72f, 0.85f, 1.0f},
                     ground[3] = {0.22f, 0.20f, 0.18f};
  for (uint32_t y = 0; y < image->height; y++) {
    float *row = vl_image_row(image, y);
    for (uint32_t x = 0; x < image->width; x++) {
      vlVec3 d = vl_octahedral_decode(((float)x + 0.5f) / (float)image->width,
                                      ((float)y + 0.5f) / (float)image->height);
      float height = 1 - (1 - (d.z > 0 ? d.z : 0)) * (1 - (d.z > 0 ? d.z : 0)),
            above = vl_smooth_step(d.z, -0.02f, 0.02f);
      for (int c = 0; c < 3; c++) {
        float sky = horizon[c] + (zenith[c] - horizon[c]) * height;
        row[3 * x + (uint32_t)c] = ground[c] + (sky - ground[c]) * above;
      }
    }
  }
}

/* ---- files ------------------------------------------------------------------------------- */

/* Converts an image over longitude and latitude. A pixel of the result is the mean of 2 x 2
 * lookups, each interpolated between four pixels. */
static void from_latitudes(const vlImage *from, const float *pixels, uint32_t channels,
                           vlImage *to) {
  double w = from->width, h = from->height;
  for (uint32_t y = 0; y < to->height; y++) {
    float *row = vl_image_row(to, y);
    for (uint32_t x = 0; x < to->width; x++) {
      double sum[3] = {0, 0, 0};
      for (int k = 0; k < 4; k++) {
        vlVec3 d =
            vl_octahedral_decode(((float)x + (k & 1 ? 0.75f : 0.25f)) / (float)to->width,
                                 ((float)y + (k & 2 ? 0.75f : 0.25f)) / (float)to->height);
        double u = (vl_atan2_double(d.x, d.y) / 6.283185307179586 + 0.5) * w - 0.5;
        double v = vl_acos_double(d.z > 1 ? 1 : d.z < -1 ? -1 : (double)d.z) / M_PI * h - 0.5;
        vl_map_add_at(pixels, from->width, from->height, channels, u, v, sum);
      }
      for (int n = 0; n < 3; n++)
        row[3 * x + (uint32_t)n] = sum[n] > 0 ? (float)(0.25 * sum[n]) : 0.0f;
    }
  }
}

static bool new_image(vlScene *scene, uint32_t side, vlImage **image) {
  vlImageDef def = vl_default_image_def(side, side, 3);
  def.type = VL_PIXEL_F32;
  return vl_image_create(scene->context, &def, image) == VL_OK || vl_scene_fail_memory(scene);
}

static bool read_environment(vlScene *scene, const char *path, vlImage **image) {
  vlError error;
  vl_error_clear(&error);
  vlImage *from = NULL;
  vlResult r = vl_image_read(scene->context, path ? path : "", &from, &error);
  if (r != VL_OK)
    return vl_scene_fail(scene, r, (vlSource){0}, "%s", error.message);
  if (from->width == from->height) {
    *image = from;
    return true;
  }
  uint32_t channel[4], channels = vl_image_color(from, channel);
  float *pixels = NULL;
  bool ok = from->width == 2 * from->height && channels > 0;
  if (!ok)
    vl_scene_fail(scene, VL_ERROR_SCENE, (vlSource){0},
                  "%.300s: %u x %u: an image of the surroundings must be twice as wide as "
                  "high, or square",
                  path, from->width, from->height);
  channels = channels > 2 ? 3 : 1;
  ok = ok && (vl_image_to_float(from, channel, channels, &pixels) == VL_OK ||
              vl_scene_fail_memory(scene));
  /* pixels at the horizon keep about their solid angle */
  uint32_t side = from->height + from->height / 4;
  ok = ok && new_image(scene, side > MAX_SIDE ? MAX_SIDE : side < 16 ? 16 : side, image);
  if (ok)
    from_latitudes(from, pixels, channels, *image);
  vl_free(scene->context, pixels);
  vl_image_destroy(from);
  return ok;
}

/* ---- the light --------------------------------------------------------------------------- */

static bool add_sun(vlScene *scene, const vlCompleteDef *def, const vlLightDef *sky) {
  vlLightDef sun = vl_default_light_def(VL_LIGHT_DISTANT);
  memcpy(sun.world_from_light, sky->world_from_light, sizeof sun.world_from_light);
  const float from[3] = {-0.45f, -0.55f, 0.75f};
  memcpy(sun.from, from, sizeof from);
  sun.to[0] = sun.to[1] = sun.to[2] = 0;
  sun.color = vl_spectrum_rgb(1.0f, 0.93f, 0.82f);
  sun.scale = 3.0f * def->strength;
  return vl_scene_add_light(scene, &sun).index != 0;
}

bool vl_scene_add_environment(vlScene *scene, const vlCompleteDef *def,
                              vlEnvironmentKind kind) {
  vlLightDef light = vl_default_light_def(VL_LIGHT_INFINITE);
  double right[3], up[3], front[3], c = vl_precise_cos(def->rotation),
                                    s = vl_precise_sin(def->rotation);
  if (!vl_scene_axes(def, right, up, front) || !isfinite(def->strength) || !isfinite(c))
    return vl_scene_fail(scene, VL_ERROR_ARGUMENT, (vlSource){0},
                         "environment: its axes, rotation or strength make no sense");
  for (int i = 0; i < 3; i++) { /* axes: x right, y ahead, rotated about z */
    light.world_from_light[4 * i] = c * right[i] - s * front[i];
    light.world_from_light[4 * i + 1] = -s * right[i] - c * front[i];
    light.world_from_light[4 * i + 2] = up[i];
  }
  light.scale = def->strength;
  vlImage *image = NULL;
  bool ok = true;
  if (kind == VL_ENVIRONMENT_FILE)
    ok = read_environment(scene, def->path, &image);
  const vlStudio *studio = vl_studio(kind);
  if (studio && (ok = new_image(scene, BUILT_IN_SIDE, &image)))
    fill_studio(scene, studio, image);
  if (kind == VL_ENVIRONMENT_SKY && (ok = new_image(scene, BUILT_IN_SIDE, &image)))
    fill_sky(image);
  light.image = image;
  ok = ok && vl_scene_add_light(scene, &light).index != 0;
  vl_image_destroy(image);
  return ok && (kind != VL_ENVIRONMENT_SKY || add_sun(scene, def, &light));
}
