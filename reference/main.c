/* main.c: velo-reference, a small path tracer for reading, and for checking velo. It takes the scene's description,
 * image files and colour tables from the library, and computes everything else itself, one ray at a time.
 *
 *   velo-reference SCENE -o IMAGE.exr [--spp N] [--seed N] [--resolution WxH] [--max-depth N] [--tracer NAME]
 *      [--color rgb]
 *
 * The image has the channels R G B A and error.R error.G error.B, the standard errors of the pixels' means. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "camera.h"
#include "film.h"
#include "tracer.h"

typedef struct options {
  const char *scene, *output;
  uint32_t samples, seed, width, height;
  long max_depth;     /* -1: the scene's */
  const char *tracer; /* null: the scene's */
  bool rgb;
} options;

static int usage(const char *message, const char *what) {
  fprintf(stderr, "velo-reference: %s%s\n", message, what);
  fprintf(stderr,
          "usage: velo-reference SCENE -o IMAGE.exr [--spp N] [--seed N] [--resolution WxH] [--max-depth N] "
          "[--tracer NAME] [--color rgb]\n");
  return 2;
}

/* A whole number from `low` to `high`. */
static bool read_number(const char *text, long low, long high, long *number) {
  char *end;
  *number = strtol(text, &end, 10);
  return *text && !*end && *number >= low && *number <= high;
}

static bool read_size(const char *text, options *o) {
  char width[16], rest[16];
  long w, h;
  if (sscanf(text, "%15[0-9]x%15[0-9]", width, rest) != 2) return false;
  if (!read_number(width, 1, 65536, &w) || !read_number(rest, 1, 65536, &h)) return false;
  o->width = (uint32_t)w;
  o->height = (uint32_t)h;
  return true;
}

/* 0, or the exit code of a wrong command line. */
static int read_options(int count, char **arguments, options *o) {
  *o = (options){.samples = 64, .max_depth = -1};
  for (int i = 1; i < count; i++) {
    const char *name = arguments[i];
    if (name[0] != '-') {
      if (o->scene) return usage("two scenes: ", name);
      o->scene = name;
      continue;
    }
    if (i + 1 == count) return usage("a value is missing after ", name);
    const char *value = arguments[++i];
    long number = 0;
    bool ok = true;
    if (strcmp(name, "-o") == 0)
      o->output = value;
    else if (strcmp(name, "--resolution") == 0)
      ok = read_size(value, o);
    else if (strcmp(name, "--tracer") == 0)
      ok = strcmp(o->tracer = value, "path") == 0 || strcmp(value, "volpath") == 0;
    else if (strcmp(name, "--color") == 0)
      ok = o->rgb = strcmp(value, "rgb") == 0;
    else if (strcmp(name, "--spp") == 0) {
      ok = read_number(value, 1, 1L << 30, &number);
      o->samples = (uint32_t)number;
    } else if (strcmp(name, "--seed") == 0) {
      ok = read_number(value, 0, UINT32_MAX, &number);
      o->seed = (uint32_t)number;
    } else if (strcmp(name, "--max-depth") == 0)
      ok = read_number(value, 0, 1 << 20, &o->max_depth);
    else
      return usage("unknown option ", name);
    if (!ok) return usage("not a value of this option: ", value);
  }
  if (!o->scene) return usage("no scene", "");
  if (!o->output) return usage("no image to write: -o", "");
  return 0;
}

/* The lecture's render_perspective: for each pixel and each of its samples a ray, and what the ray brings back. Rows go
 * down; the lecture's go up. */
static uint64_t render_scene(const world *w, const vlCamera *camera, const medium *around_camera, view_plane *plane,
                             uint32_t max_depth, uint32_t seed) {
  uint64_t not_finite = 0;
  for (uint32_t row = 0; row < plane->height; row++) {
    for (uint32_t column = 0; column < plane->width; column++) {
      for (uint32_t i = 0; i < plane->samples; i++) {
        sampler s = make_sampler(seed, (uint64_t)row * plane->width + column, i);
        wavelengths lambda = sample_wavelengths(w->rgb, &s);
        double weight;
        square_point offset = sample_filter(plane, &s, &weight);
        double rgb[3] = {0, 0, 0};
        bool met = false;
        ray r;
        if (camera_ray(camera, column + 0.5 + offset.x, row + 0.5 + offset.y, &s, &r)) {
          spectrum radiance = trace_ray(w, r, around_camera, max_depth, &s, &lambda, &met);
          if (!is_finite(radiance)) {
            not_finite++;
            continue;
          }
          radiance_to_rgb(scaled(weight * camera->exposure_time, radiance), &lambda, plane->space, rgb);
        }
        add_sample(plane, column, row, rgb, met);
      }
    }
  }
  return not_finite;
}

static bool render_file(vlContext *context, const options *o, vlScene *scene, vlError *error) {
  if (vl_scene_load(scene, o->scene, NULL, error) != VL_OK) return false;
  if (vl_scene_complete(scene, NULL, error) != VL_OK) return false;
  vlSceneDefs *defs = vl_scene_defs(scene);
  if (o->rgb) defs->build.color = VL_COLOR_RGB;
  if (o->tracer) defs->render.tracer = strcmp(o->tracer, "path") == 0 ? VL_TRACER_PATH : VL_TRACER_VOLPATH;
  vlCamera camera;
  if (vl_camera_make(&defs->camera, &camera, NULL, error) != VL_OK) return false;
  if (o->width) {
    vl_camera_resize(&camera, o->width, o->height, &camera);
    defs->film.width = o->width;
    defs->film.height = o->height;
    memset(defs->film.crop, 0, sizeof defs->film.crop);
  }
  uint32_t max_depth = o->max_depth >= 0 ? (uint32_t)o->max_depth : defs->render.max_depth;
  world w = {0};
  view_plane plane = {0};
  vlImage *image = NULL;
  bool ok = check_camera(&camera, defs->camera_source, error) && make_world(context, scene, &w, error) &&
            make_view_plane(defs, o->samples, &plane, error);
  if (ok) {
    uint64_t lost = render_scene(&w, &camera, medium_of(&w, defs->camera_medium), &plane, max_depth, o->seed);
    if (lost > 0) fprintf(stderr, "velo-reference: %llu samples were not finite\n", (unsigned long long)lost);
    ok = make_image(&plane, context, &image) && vl_image_write(image, o->output, NULL, error) == VL_OK;
  }
  vl_image_destroy(image);
  free(plane.pixels);
  free_world(&w);
  return ok;
}

static int exit_code(vlResult code) {
  switch (code) {
    case VL_OK: return 0;
    case VL_ERROR_MISSING: return 4;
    case VL_ERROR_IO: return 5;
    default: return 3;
  }
}

int main(int count, char **arguments) {
  options o;
  int wrong = read_options(count, arguments, &o);
  if (wrong) return wrong;
  vlContext *context = NULL;
  vlScene *scene = NULL;
  vlContextDef def = vl_default_context_def();
  vlError error = {0};
  bool ok = vl_context_create(&def, &context) == VL_OK && vl_scene_create(context, &scene) == VL_OK;
  if (ok) ok = render_file(context, &o, scene, &error);
  if (!ok) {
    if (error.file[0]) fprintf(stderr, "%s:%u:%u: ", error.file, error.line, error.column);
    fprintf(stderr, "%s\n", error.message[0] ? error.message : "not rendered");
    if (error.code == VL_OK) error.code = VL_ERROR_MEMORY;
  }
  vl_scene_destroy(scene);
  vl_context_destroy(context);
  return exit_code(error.code);
}
