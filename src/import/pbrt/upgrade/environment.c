/* import/pbrt/upgrade/environment.c: images of lights. pbrt-v3 has maps over longitude and
 * latitude, pbrt-v4 equal-area maps of the same directions (pbrt book 3.8.3). */
#include <math.h>
#include <stdio.h>

#include "base/context.h"
#include "base/error.h"
#include "base/text.h"
#include "image/image.h"
#include "import/pbrt/upgrade/upgrade.h"
#include "math/approx_double.h"
#include "math/octahedral.h"

enum { MAX_SIDE = 8192, MIN_SIDE = 16, LOOKS = 3 };

typedef struct Work {
  const float *pixels; /* 3 per pixel */
  uint32_t width, height;
  const double *factor;
  vlImage *to;
} Work;

/* Longitude 0 is the x axis and grows towards y; latitude 0, the first row, is the z axis. */
static void fill_row(void *user, uint32_t y, VL_UNUSED uint32_t worker) {
  const Work *w = user;
  float *row = vl_image_row(w->to, y);
  double side = w->to->width;
  for (uint32_t x = 0; x < w->to->width; x++) {
    double sum[3] = {0, 0, 0};
    for (int k = 0; k < LOOKS * LOOKS; k++) {
      vlVec3 d = vl_octahedral_decode((float)((x + (k % LOOKS + 0.5) / LOOKS) / side),
                                      (float)((y + (k / LOOKS + 0.5) / LOOKS) / side));
      double phi = vl_atan2_double(d.y, d.x), theta = vl_acos_double(d.z > 1    ? 1
                                                                     : d.z < -1 ? -1
                                                                                : (double)d.z);
      if (phi < 0)
        phi += 2 * M_PI;
      vl_map_add_at(w->pixels, w->width, w->height, 3, phi / (2 * M_PI) * w->width - 0.5,
                    theta / M_PI * w->height - 0.5, sum);
    }
    for (uint32_t n = 0; n < 3; n++)
      row[3 * x + n] = (float)(sum[n] * w->factor[n] / (LOOKS * LOOKS));
  }
}

/* Three channels; those of an image of one are equal. */
static bool read_pixels(vlUpgrade *u, const vlOldMap *map, const vlImage *from,
                        float **pixels) {
  uint32_t channel[4], count = vl_image_color(from, channel);
  if (!count) {
    u->result = vl_fail(&u->error, VL_ERROR_SCENE, "%s: the image has no colour", map->from);
    return false;
  }
  if (count < 3)
    channel[1] = channel[2] = channel[0];
  return vl_image_to_float(from, channel, 3, pixels) == VL_OK || vl_old_fail_memory(u);
}

static bool convert(vlUpgrade *u, vlOldMap *map, const vlImage *from) {
  double side = sqrt((double)from->width * from->height);
  uint32_t even = 2 * (uint32_t)(side / 2 + 0.5);
  vlImageDef def = vl_default_image_def(even < MIN_SIDE   ? MIN_SIDE
                                        : even > MAX_SIDE ? MAX_SIDE
                                                          : even,
                                        0, 3);
  def.height = def.width;
  def.type = VL_PIXEL_F32;
  vlImage *image = NULL;
  float *pixels = NULL;
  if (!read_pixels(u, map, from, &pixels))
    return false;
  bool fine = vl_image_create(u->context, &def, &image) == VL_OK || vl_old_fail_memory(u);
  if (fine) {
    Work work = {pixels, from->width, from->height, map->factor, image};
    vl_parallel_for(u->context, def.height, fill_row, &work);
    u->result = vl_image_write_memory(image, ".exr", NULL, &map->data, &map->size, &u->error);
    fine = u->result == VL_OK;
  }
  vl_image_destroy(image);
  vl_free(u->context, pixels);
  return fine;
}

/* Makes the new image, and names it: "sky-equiarea.exr", or with a number where another file
 * has the name. */
static bool make_map(vlUpgrade *u, vlOldMap *map, const char *old, char *name, size_t size) {
  vlImage *from = NULL;
  u->result = vl_image_read_named(u->context, NULL, map->from, &from, &u->error);
  bool fine = u->result == VL_OK && convert(u, map, from);
  vl_image_destroy(from);
  if (!fine)
    return false;
  const char *base = vl_file_name(old), *dot = strrchr(base, '.');
  int stem = dot ? (int)(dot - base) : (int)strlen(base);
  snprintf(name, size, "%.*s-equiarea.exr", stem, base);
  u->result = vl_file_set_name(&u->files, name, size, map->data, map->size, &u->error);
  map->name = vl_strdup(u->context, name);
  return u->result == VL_OK && (map->name || vl_old_fail_memory(u));
}

bool vl_old_environment(const vlOldStatement *s, const char *name, const double factor[3],
                        char *result, size_t size) {
  vlUpgrade *u = s->u;
  char path[4096];
  const vlFound found =
      vl_old_find_file(s, name, "image", "it must become an equal-area map", path);
  if (found == VL_FOUND_TOO_LONG)
    return vl_old_fail(s->file, VL_ERROR_SCENE, s->line, 0, "file name too long");
  if (found == VL_FOUND_NOT)
    return snprintf(result, size, "%s", name) > 0;
  VL_EACH_ITEM(const vlOldMap, map, &u->maps) {
    if (vl_text_is(map->from, path) && memcmp(map->factor, factor, sizeof map->factor) == 0)
      return snprintf(result, size, "%s", map->name) > 0;
  }
  vlOldMap *map = VL_PUSH(u->context, &u->maps);
  if (!map)
    return vl_old_fail_memory(u);
  *map = (vlOldMap){.from = vl_strdup(u->context, path),
                    .factor = {factor[0], factor[1], factor[2]}};
  return map->from ? make_map(u, map, name, result, size) : vl_old_fail_memory(u);
}
