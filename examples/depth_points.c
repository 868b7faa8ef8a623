/* depth_points: depth becomes points in space: the depth of each pixel's centre (ground truth), and the ray through it,
 * give the point that it sees. The image shows the points from the side; they are also written to IMAGE.ply.
 *
 *   depth_points SCENE IMAGE
 *   build/release/bin/example_depth_points examples/corner.pbrt examples/depth_points.jpg
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <velo/velo.h>

/* Of a call that fails: one line, and the end of the program. */
static void must(vlResult result, const vlError *error) {
  if (result == VL_OK) return;
  fprintf(stderr, "%s: %s %s\n", vl_result_name(result), error->file, error->message);
  exit(1);
}

int main(int count, char **arguments) {
  if (count != 3) {
    fprintf(stderr, "usage: depth_points SCENE IMAGE\n");
    return 2;
  }
  vlError error = {0};
  vlContextDef def = vl_default_context_def();
  vlContext *context;
  vlScene *scene;
  vlWorld *world;
  vlFilm *film;
  vlImage *color, *depth, *view;
  vlCamera camera;
  must(vl_context_create(&def, &context), &error);
  must(vl_scene_create(context, &scene), &error);
  must(vl_scene_load(scene, arguments[1], NULL, &error), &error);
  must(vl_scene_complete(scene, NULL, &error), &error); /* adds a camera and light if the file has none */
  vlSceneDefs *defs = vl_scene_defs(scene);             /* the file's settings */
  must(vl_world_build(scene, &defs->build, &world, &error), &error);
  must(vl_camera_make(&defs->camera, &camera, NULL, &error), &error);
  must(vl_film_create(context, &defs->film, &film), &error);
  must(vl_render(world, &camera, film, &defs->render, NULL, &error), &error);
  must(vl_film_develop(film, &defs->develop, &color), &error);
  uint32_t width = camera.width, height = camera.height;
  vlChannelsDef channels = vl_default_channels_def(width, height);
  channels.channels = VL_CHANNEL_DISTANCE;
  must(vl_render_channels(world, &camera, &channels, &depth, NULL, &error), &error);
  vlImageDef view_def = vl_default_image_def(width, height, 3);
  must(vl_image_create(context, &view_def, &view), &error);
  float *pixels = memset(vl_image_pixels(view), 0, sizeof(float) * 3 * width * height);
  vlCameraDef side_def = defs->camera;
  vlCamera side;
  side_def.eye[0] += 3;
  side_def.eye[1] += 1.5;
  must(vl_camera_make(&side_def, &side, NULL, &error), &error);
  char path[4096];
  snprintf(path, sizeof path, "%s.ply", arguments[2]);
  FILE *file = fopen(path, "w");
  if (!file) return 1;
  fprintf(
      file,
      "ply\nformat ascii 1.0\nelement vertex %u\nproperty float x\nproperty float y\nproperty float z\nend_header\n",
      width * height);
  for (uint32_t y = 0; y < height; y++)
    for (uint32_t x = 0; x < width; x++) {
      double o[3], d[3], p[3], place[2], t = vl_image_get(depth, x, y, 0);
      if (!vl_camera_unproject(&camera, x + 0.5, y + 0.5, o, d) || t > 1e6) t = 0; /* a pixel that sees nothing */
      for (int i = 0; i < 3; i++) p[i] = o[i] + t * d[i];
      fprintf(file, "%.6g %.6g %.6g\n", p[0], p[1], p[2]);
      if (t == 0 || !vl_camera_project(&side, p, place, NULL) || place[0] < 0 || place[1] < 0) continue;
      uint32_t at = (uint32_t)place[1] * width + (uint32_t)place[0];
      for (uint32_t c = 0; c < 3 && place[0] < width && place[1] < height; c++)
        pixels[3 * at + c] = vl_image_get(color, x, y, c);
    }
  fclose(file);
  must(vl_image_write(view, arguments[2], NULL, &error), &error);
  vl_image_destroy(color);
  vl_image_destroy(depth);
  vl_image_destroy(view);
  vl_film_destroy(film);
  vl_world_destroy(world);
  vl_scene_destroy(scene);
  vl_context_destroy(context);
  return 0;
}
