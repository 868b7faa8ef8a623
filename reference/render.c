/* render.c: how an image is made. The library (vl_...) gives the description of the scene, the images in files and the
 * tables of colours; everything else is computed here. */
#include <stdio.h>

#include "more/more.h"
#include "program/command.h"
#include "program/program.h"

/* The lecture's render_scene: for each pixel and each of its samples a primary ray, and the light that it brings back.
 * Rows go down; the lecture's go up. Returns how many samples were left out, since a NaN or infinity is in them. */
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

bool render_file(vlContext *context, options *o, vlScene *scene, vlError *error) {
  vlCamera camera;
  vlSceneDefs *defs = vl_scene_defs(scene);
  if (vl_scene_load(scene, o->scene, NULL, error) != VL_OK || vl_scene_complete(scene, NULL, error) != VL_OK ||
      vl_camera_make(&defs->camera, &camera, NULL, error) != VL_OK)
    return false;
  apply_options(o, defs, &camera);
  static world w; /* static, like all memory of this program: until its end */
  static view_plane plane;
  static vlImage *image;
  if (!check_scene(context, scene, &camera, error) || !make_world(context, scene, &w, error)) return false;
  plane = make_view_plane(defs, (uint32_t)o->samples);
  unsigned long lost = render_scene(&w, &camera, medium_of(&w, defs->camera_medium), &plane, o);
  if (lost > 0) fprintf(stderr, "velo-reference: %lu samples were not finite\n", lost);
  return make_image(&plane, context, &image) && vl_image_write(image, o->output, NULL, error) == VL_OK;
}
