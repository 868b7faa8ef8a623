/* scene/prove.c: `velo scene convert --prove`: renders the scene and what was written of it,
 * and compares the mean radiance of each material. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "cli/macros.h"
#include "cli/report.h"
#include "cli/text.h"
#include "image/image.h"
#include "render/scene_options.h"
#include "scene/scene.h"
#include "velo/channels.h"

enum {
  SIDE = 256,    /* pixels of the longer side */
  SPP = 64,      /* samples */
  MAX_SHOWN = 64 /* materials printed */
};

/* An image of a scene, with the material of each pixel. */
typedef struct Shot {
  vlScene *scene;
  vlWorld *world;
  vlImage *image, *ids;
} Shot;

/* Sums of a material over its pixels: before and after. */
typedef struct Sums {
  double before[3], after[3];
  uint64_t pixels;
} Sums;

static void close_shot(Shot *shot) {
  vl_image_destroy(shot->image);
  vl_image_destroy(shot->ids);
  vl_world_destroy(shot->world);
  vl_scene_destroy(shot->scene);
}

/* Renders the scene with its own camera and settings at a reduced size. ids: also the material
 * of each pixel. alone: no light is added. */
static vlResult take(vlContext *context, Shot *shot, bool ids, bool alone, vlError *error) {
  vlSceneDefs *defs = vl_scene_defs(shot->scene);
  vlCamera whole, camera;
  vlCompleteDef complete = vl_default_complete_def();
  if (alone)
    complete.environment = VL_ENVIRONMENT_NONE;
  TRY_RESULT(vl_scene_complete(shot->scene, &complete, error));
  const double max = fmax(defs->film.width, defs->film.height);
  const double k = max > SIDE ? SIDE / max : 1;
  vlFilmDef film_def = vl_default_film_def((uint32_t)fmax(1, k * defs->film.width + 0.5),
                                           (uint32_t)fmax(1, k * defs->film.height + 0.5));
  vlRenderDef render = defs->render;
  vlDevelopDef develop = vl_default_develop_def();
  render.spp = SPP;
  vlResult r = vl_world_build(shot->scene, &defs->build, &shot->world, error);
  if (r == VL_OK)
    r = vl_camera_make(&defs->camera, &whole, NULL, error);
  if (r == VL_OK)
    r = vl_camera_resize(&whole, film_def.width, film_def.height, &camera);
  if (r == VL_OK)
    r = image_render(context, shot->world, &camera, &film_def, &render, &develop, &shot->image,
                     error);
  vlChannelsDef channels = vl_default_channels_def(film_def.width, film_def.height);
  channels.channels = VL_CHANNEL_ID_MATERIAL;
  if (r == VL_OK && ids)
    r = vl_render_channels(shot->world, &camera, &channels, NULL, &shot->ids, error);
  return r;
}

/* Adds the pixels of the two images to the sums of their materials, by the ids of the first. */
static void add_up(const Shot *before, const Shot *after, Sums *sums, uint32_t count) {
  const uint32_t *ids = vl_image_const_pixels(before->ids);
  const float *a = vl_image_const_pixels(before->image);
  const float *b = vl_image_const_pixels(after->image);
  const size_t pixels = image_pixel_count(before->image);
  const size_t step = vl_image_channels(before->image);
  const size_t id_step = vl_image_channels(before->ids);
  for (size_t i = 0; i < pixels; i++) {
    const uint32_t id = ids[i * id_step];
    if (id > count)
      continue;
    for (size_t c = 0; c < 3; c++) {
      sums[id].before[c] += (double)a[i * step + c];
      sums[id].after[c] += (double)b[i * step + c];
    }
    sums[id].pixels++;
  }
}

static void print_ratios(const Shot *before, const Sums *sums, uint32_t count) {
  uint32_t printed = 0;
  printf("radiance after / before, per material\n%8s  %7s %7s %7s  material\n", "pixels", "red",
         "green", "blue");
  for (uint32_t id = 0; id <= count; id++) {
    const Sums *s = &sums[id];
    vlIdInfo info = {0};
    if (!s->pixels || printed++ >= MAX_SHOWN)
      continue;
    printf("%8llu ", (unsigned long long)s->pixels);
    for (int c = 0; c < 3; c++)
      if (s->before[c] > 0)
        printf(" %7.3f", s->after[c] / s->before[c]);
      else
        printf(" %7s", s->after[c] > 0 ? "inf" : "-");
    const char *name = "(background)";
    if (id) {
      vl_world_id_info(before->world, VL_ID_MATERIAL, id, &info);
      name = info.name ? info.name : info.type;
    }
    printf("  ");
    text_print_plain(name ? name : "");
    if (id && !info.name)
      printf(".%u", id);
    putchar('\n');
  }
}

int convert_prove(vlContext *context, const vlLoadDef *load, const char *from, const char *to) {
  Shot before = {0}, after = {0};
  vlError error = {0};
  Sums *sums = NULL;
  vlLoadDef plain = vl_default_load_def();
  plain.permissive = load->permissive;
  vlResult r = scene_read(context, from, load, &before.scene, &error);
  if (r == VL_OK)
    r = scene_read(context, to, &plain, &after.scene, &error);
  const bool alone = r == VL_OK && !vl_scene_defs(before.scene)->light_missing;
  if (r == VL_OK)
    r = take(context, &before, true, alone, &error);
  if (r == VL_OK)
    r = take(context, &after, false, alone, &error);
  bool same = r == VL_OK && vl_image_width(before.image) == vl_image_width(after.image) &&
              vl_image_height(before.image) == vl_image_height(after.image);
  if (r == VL_OK && same) {
    const uint32_t count = vl_world_id_count(before.world, VL_ID_MATERIAL);
    sums = calloc((size_t)count + 1, sizeof *sums);
    if (sums) {
      add_up(&before, &after, sums, count);
      print_ratios(&before, sums, count);
    } else {
      r = VL_ERROR_MEMORY;
    }
  }
  free(sums);
  close_shot(&before);
  close_shot(&after);
  if (r != VL_OK)
    return report_error(&error, r, to);
  return same ? STATUS_OK
              : report_failure(STATUS_OTHER, "%s: its images have another shape than %s", to,
                               from);
}
