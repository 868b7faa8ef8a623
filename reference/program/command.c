/* program/command.c: the command line, and what begins and ends the program. */
#include "command.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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

static bool read_all(int count, char **arguments, options *o) {
  *o = (options){.samples = 64, .max_depth = -1};
  for (int i = 1; i < count; i++) {
    if (arguments[i][0] != '-' && !o->scene)
      o->scene = arguments[i];
    else if (i + 1 == count || !read_option(arguments[i], arguments[i + 1], o))
      return false;
    else
      i++;
  }
  return o->scene && o->output;
}

bool read_options(int count, char **arguments, options *o) {
  if (read_all(count, arguments, o)) return true;
  fprintf(stderr,
          "usage: velo-reference SCENE -o IMAGE.exr [--spp N] [--seed N] [--resolution WxH] [--max-depth N] "
          "[--tracer path|volpath] [--color spectral|rgb] [--filter box]\n");
  return false;
}

void apply_options(options *o, vlSceneDefs *defs, vlCamera *camera) {
  if (o->rgb) defs->build.color = VL_COLOR_RGB;
  if (o->box) defs->film.filter = vl_default_pixel_filter(VL_PIXEL_FILTER_BOX);
  if (o->tracer) defs->render.tracer = strcmp(o->tracer, "path") == 0 ? VL_TRACER_PATH : VL_TRACER_VOLPATH;
  if (o->max_depth < 0) o->max_depth = defs->render.max_depth;
  if (o->width == 0) return;
  vl_camera_resize(camera, (uint32_t)o->width, (uint32_t)o->height, camera);
  defs->film.width = (uint32_t)o->width;
  defs->film.height = (uint32_t)o->height;
  memset(defs->film.crop, 0, sizeof defs->film.crop);
}

int main(int count, char **arguments) {
  options o;
  static vlContext *context;
  static vlScene *scene;
  vlContextDef def = vl_default_context_def();
  vlError error = {.code = VL_ERROR_MEMORY, .message = "not rendered"};
  if (!read_options(count, arguments, &o)) return 2;
  if (vl_context_create(&def, &context) == VL_OK && vl_scene_create(context, &scene) == VL_OK &&
      render_file(context, &o, scene, &error))
    return 0;
  if (error.file[0]) fprintf(stderr, "%s:%u:%u: ", error.file, error.line, error.column);
  fprintf(stderr, "%s\n", error.message);
  return error.code == VL_ERROR_MISSING ? 4 : error.code == VL_ERROR_IO ? 5 : 3;
}
