/* own_camera: a camera of one's own: a fisheye that sees half of all directions in the largest circle of the image
 * (docs/own-code.md). The scene's camera keeps its place and its size.
 *
 *   own_camera SCENE IMAGE
 *   build/release/bin/example_own_camera examples/corner.pbrt examples/own_camera.jpg
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <velo/velo.h>

static void rays_of(void *user, const vlOwnFilmPoints *points, const vlOwnRays *rays) {
  const double *widest = user; /* angle from the axis at the edge of the circle */
  double half = 0.5 * fmin(points->width, points->height);
  for (uint32_t i = 0; i < points->count; i++) {
    double x = (points->x[i] - 0.5 * points->width) / half, y = (points->y[i] - 0.5 * points->height) / half;
    double r = hypot(x, y), angle = r * *widest;
    if (r > 1) continue; /* no ray: black and transparent */
    rays->dx[i] = r > 0 ? sin(angle) * x / r : 0;
    rays->dy[i] = r > 0 ? sin(angle) * y / r : 0;
    rays->dz[i] = cos(angle);
  }
}

/* Of a call that fails: one line, and the end of the program. */
static void must(vlResult result, const vlError *error) {
  if (result == VL_OK) return;
  fprintf(stderr, "%s: %s %s\n", vl_result_name(result), error->file, error->message);
  exit(1);
}

int main(int count, char **arguments) {
  static double right_angle = 1.5707963267948966;
  static const vlOwnCamera fisheye = {.name = "my fisheye", .rays = rays_of, .user = &right_angle};
  if (count != 3) {
    fprintf(stderr, "usage: own_camera SCENE IMAGE\n");
    return 2;
  }
  vlError error = {0};
  vlContextDef def = vl_default_context_def();
  vlContext *context;
  vlScene *scene;
  vlWorld *world;
  vlFilm *film;
  vlImage *image;
  vlCamera camera;
  must(vl_context_create(&def, &context), &error);
  must(vl_scene_create(context, &scene), &error);
  must(vl_scene_load(scene, arguments[1], NULL, &error), &error);
  must(vl_scene_complete(scene, NULL, &error), &error); /* adds a camera and light if the file has none */
  vlSceneDefs *defs = vl_scene_defs(scene);             /* the file's settings */
  defs->camera.own = &fisheye;                          /* the rest of the camera stays: place, size, shutter */
  must(vl_world_build(scene, &defs->build, &world, &error), &error);
  must(vl_camera_make(&defs->camera, &camera, NULL, &error), &error);
  must(vl_film_create(context, &defs->film, &film), &error);
  must(vl_render(world, &camera, film, &defs->render, NULL, &error), &error);
  must(vl_film_develop(film, &defs->develop, &image), &error);
  must(vl_image_write(image, arguments[2], NULL, &error), &error);
  vl_image_destroy(image);
  vl_film_destroy(film);
  vl_world_destroy(world);
  vl_scene_destroy(scene);
  vl_context_destroy(context);
  return 0;
}
