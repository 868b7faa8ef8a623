/* main.c: velo-reference, a small path tracer for reading, and for checking velo. It takes the scene's description,
 * image files and colour tables from the library, and computes everything else itself, one ray at a time.
 *
 *   velo-reference SCENE -o IMAGE.exr [--spp N] [--seed N] [--resolution WxH] [--max-depth N] [--tracer NAME]
 *      [--color spectral|rgb] [--filter box]
 *
 * The image has the channels R G B A and error.R error.G error.B, the standard errors of the pixels' means. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "camera.h"
#include "film.h"
#include "more/check.h"
#include "tracer.h"

typedef struct options {
  const char *scene, *output;
  long samples, seed, width, height;
  long max_depth;     /* -1: the scene's */
  const char *tracer; /* null: the scene's */
  bool rgb, box;
} options;

/* The lecture's render_scene: for each pixel and each of its samples a primary ray, and what the ray brings back. Rows
 * go down; the lecture's go up. Returns the number of samples that were lost because they were not finite. */
static unsigned long render_scene(const world *w, const vlCamera *camera, const vlMediumDef *around_camera,
                                  view_plane *plane, const options *o) {
  unsigned long lost = 0;
  for (uint32_t row = 0; row < plane->height; row++) {
    for (uint32_t column = 0; column < plane->width; column++) {
      for (uint32_t i = 0; i < plane->samples; i++) {
        sampler s = make_sampler((uint64_t)o->seed, (uint64_t)row * plane->width + column, i);
        wavelengths lambda = sample_wavelengths(w->rgb, &s);
        square_point sp = sample_filter(plane, &s);
        spectrum radiance = gray(0);
        bool met = false;
        ray r;
        if (camera_ray(camera, column + 0.5 + sp.x, row + 0.5 + sp.y, &s, &r))
          radiance = trace_ray(w, r, around_camera, (uint32_t)o->max_depth, &s, &lambda, &met);
        if (isfinite(radiance.c[0] + radiance.c[1] + radiance.c[2] + radiance.c[3]))
          add_sample(plane, column, row, scaled(camera->exposure_time, radiance), &lambda, met);
        else
          lost++;
      }
    }
  }
  return lost;
}

/* ---- the command line -------------------------------------------------------------------------------------------- */

/* A whole number from `low` to `high`. */
static bool read_number(const char *text, long low, long high, long *number) {
  char *end;
  *number = strtol(text, &end, 10);
  return *text && !*end && *number >= low && *number <= high;
}

static bool read_size(const char *text, options *o) {
  char width[16], height[16];
  return sscanf(text, "%15[0-9]x%15[0-9]", width, height) == 2 && read_number(width, 1, 65536, &o->width) &&
         read_number(height, 1, 65536, &o->height);
}

/* False for an unknown option or a wrong value. */
static bool read_option(const char *name, const char *value, options *o) {
  if (strcmp(name, "-o") == 0) return (o->output = value) != NULL;
  if (strcmp(name, "--spp") == 0) return read_number(value, 1, 1L << 30, &o->samples);
  if (strcmp(name, "--seed") == 0) return read_number(value, 0, UINT32_MAX, &o->seed);
  if (strcmp(name, "--resolution") == 0) return read_size(value, o);
  if (strcmp(name, "--max-depth") == 0) return read_number(value, 0, 1 << 20, &o->max_depth);
  if (strcmp(name, "--color") == 0) return (o->rgb = strcmp(value, "rgb") == 0) || strcmp(value, "spectral") == 0;
  if (strcmp(name, "--filter") == 0) return (o->box = strcmp(value, "box") == 0);
  if (strcmp(name, "--tracer") != 0) return false;
  o->tracer = value;
  return strcmp(value, "path") == 0 || strcmp(value, "volpath") == 0;
}

static bool read_options(int count, char **arguments, options *o) {
  *o = (options){.samples = 64, .max_depth = -1};
  for (int i = 1; i < count; i++) {
    bool option = arguments[i][0] == '-';
    if (!option && o->scene) return false;
    if (!option)
      o->scene = arguments[i];
    else if (i + 1 == count || !read_option(arguments[i], arguments[i + 1], o))
      return false;
    else
      i++;
  }
  return o->scene && o->output;
}

/* ---- from the file to the image ---------------------------------------------------------------------------------- */

static bool render_file(vlContext *context, options *o, vlScene *scene, vlError *error) {
  if (vl_scene_load(scene, o->scene, NULL, error) != VL_OK) return false;
  if (vl_scene_complete(scene, NULL, error) != VL_OK) return false;
  vlSceneDefs *defs = vl_scene_defs(scene);
  if (o->rgb) defs->build.color = VL_COLOR_RGB;
  if (o->box) defs->film.filter = vl_default_pixel_filter(VL_PIXEL_FILTER_BOX);
  if (o->tracer) defs->render.tracer = strcmp(o->tracer, "path") == 0 ? VL_TRACER_PATH : VL_TRACER_VOLPATH;
  if (o->max_depth < 0) o->max_depth = defs->render.max_depth;
  vlCamera camera;
  if (vl_camera_make(&defs->camera, &camera, NULL, error) != VL_OK) return false;
  if (o->width) {
    vl_camera_resize(&camera, (uint32_t)o->width, (uint32_t)o->height, &camera);
    defs->film.width = (uint32_t)o->width;
    defs->film.height = (uint32_t)o->height;
    memset(defs->film.crop, 0, sizeof defs->film.crop);
  }
  if (!check_scene(scene, &camera, error)) return false;
  static world w; /* memory is not given back: the program ends */
  if (!make_world(context, scene, &w, error)) return false;
  view_plane plane = make_view_plane(defs, (uint32_t)o->samples);
  unsigned long lost = render_scene(&w, &camera, medium_of(&w, defs->camera_medium), &plane, o);
  if (lost > 0) fprintf(stderr, "velo-reference: %lu samples were not finite\n", lost);
  vlImage *image = NULL;
  return make_image(&plane, context, &image) && vl_image_write(image, o->output, NULL, error) == VL_OK;
}

int main(int count, char **arguments) {
  options o;
  if (!read_options(count, arguments, &o)) {
    fprintf(stderr,
            "usage: velo-reference SCENE -o IMAGE.exr [--spp N] [--seed N] [--resolution WxH] [--max-depth N] "
            "[--tracer path|volpath] [--color spectral|rgb] [--filter box]\n");
    return 2;
  }
  static vlContext *context;
  static vlScene *scene;
  vlContextDef def = vl_default_context_def();
  vlError error = {.code = VL_ERROR_MEMORY, .message = "not rendered"};
  bool ok = vl_context_create(&def, &context) == VL_OK && vl_scene_create(context, &scene) == VL_OK &&
            render_file(context, &o, scene, &error);
  if (!ok && error.file[0]) fprintf(stderr, "%s:%u:%u: ", error.file, error.line, error.column);
  if (!ok) fprintf(stderr, "%s\n", error.message);
  if (ok) return 0;
  return error.code == VL_ERROR_MISSING ? 4 : error.code == VL_ERROR_IO ? 5 : 3;
}
