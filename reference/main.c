/* main.c: velo-reference, a small path tracer for reading, and for checking velo. It takes the scene's description,
 * image files and colour tables from the library, and computes everything else itself, one ray at a time.
 * program/command.h has the command line. */
#include <stdio.h>

#include "more/more.h"
#include "program/command.h"
#include "program/program.h"

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
        ray r = {.time = sample_time(camera, column, row, &s)};
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

static bool render_file(vlContext *context, options *o, vlScene *scene, vlError *error) {
  vlCamera camera;
  vlSceneDefs *defs = vl_scene_defs(scene);
  if (vl_scene_load(scene, o->scene, NULL, error) != VL_OK || vl_scene_complete(scene, NULL, error) != VL_OK ||
      vl_camera_make(&defs->camera, &camera, NULL, error) != VL_OK)
    return false;
  apply_options(o, defs, &camera);
  static world w; /* static: their memory is given back when the program ends */
  static view_plane plane;
  static vlImage *image;
  if (!check_scene(context, scene, &camera, error) || !make_world(context, scene, &w, error)) return false;
  plane = make_view_plane(defs, (uint32_t)o->samples);
  unsigned long lost = render_scene(&w, &camera, medium_of(&w, defs->camera_medium), &plane, o);
  if (lost > 0) fprintf(stderr, "velo-reference: %lu samples were not finite\n", lost);
  return make_image(&plane, context, &image) && vl_image_write(image, o->output, NULL, error) == VL_OK;
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
