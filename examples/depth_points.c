/* depth_points: depth becomes points in space: the depth of each pixel's centre (ground truth), and the ray through it,
 * give the point that it sees. The image shows the points from the side; they are also written to IMAGE.ply.
 *
 *   depth_points SCENE IMAGE
 *   build/release/bin/example_depth_points examples/corner.pbrt examples/depth_points.jpg
 */
#include <string.h>

#include "example.h"

int main(int count, char **arguments) {
  Example e = example_open(count, arguments, NULL);
  example_render(&e);
  vlImage *color = example_develop(&e), *depth, *view;
  uint32_t width = e.camera.width, height = e.camera.height;
  vlChannelsDef channels = vl_default_channels_def(width, height);
  channels.channels = VL_CHANNEL_DISTANCE;
  example_must(&e, vl_render_channels(e.world, &e.camera, &channels, &depth, NULL, &e.error), "depth");
  vlImageDef def = vl_default_image_def(width, height, 3);
  example_must(&e, vl_image_create(e.context, &def, &view), "image");
  float *pixels = memset(vl_image_pixels(view), 0, sizeof(float) * 3 * width * height);
  vlCameraDef side_def = e.defs->camera;
  vlCamera side;
  side_def.eye[0] += 3, side_def.eye[1] += 1.5;
  example_must(&e, vl_camera_make(&side_def, &side, NULL, &e.error), "camera");
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
      double o[3], d[3], p[3], film[2], t = vl_image_get(depth, x, y, 0);
      if (!vl_camera_unproject(&e.camera, x + 0.5, y + 0.5, o, d) || t > 1e6) t = 0; /* a pixel that sees nothing */
      for (int i = 0; i < 3; i++) p[i] = o[i] + t * d[i];
      fprintf(file, "%.6g %.6g %.6g\n", p[0], p[1], p[2]);
      if (t == 0 || !vl_camera_project(&side, p, film, NULL) || film[0] < 0 || film[1] < 0) continue;
      uint32_t at = (uint32_t)film[1] * width + (uint32_t)film[0];
      for (uint32_t c = 0; c < 3 && film[0] < width && film[1] < height; c++)
        pixels[3 * at + c] = vl_image_get(color, x, y, c);
    }
  fclose(file);
  example_must(&e, vl_image_write(view, arguments[2], NULL, &e.error), arguments[2]);
  vl_image_destroy(color);
  vl_image_destroy(depth);
  vl_image_destroy(view);
  return example_close(&e);
}
