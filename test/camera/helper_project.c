/* test/camera/helper_project.c: projects points for test_opencv.py. Input and output are binary
 * doubles. Input per camera: fisheye (0, 1), width, height, fx, fy, cx, cy, coefficient count,
 * 14 coefficients, 16 of world_from_camera, point count, points. Output: share of pixels
 * outside, radius; then u, v, z, valid of each point. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "velo/camera.h"
#include "velo/distortion.h"
#include "velo/projection.h"

enum { HEADER = 8 + 14 + 16 + 1 };

int main(void) {
  double h[HEADER];
  while (fread(h, sizeof h, 1, stdin) == 1) {
    bool fisheye = h[0] != 0.0;
    vlCameraDef def = vl_default_camera_def((uint32_t)h[1], (uint32_t)h[2]);
    def.fx = h[3];
    def.fy = h[4];
    def.cx = h[5];
    def.cy = h[6];
    if (fisheye)
      def.projection = VL_PROJECTION_EQUIDISTANT;
    def.distortion = fisheye ? VL_DISTORTION_RADIAL : VL_DISTORTION_OPENCV;
    def.distortion_count = (uint32_t)h[7];
    memcpy(def.distortion_coefficients, h + 8, 14 * sizeof *h);
    def.has_matrix = true;
    memcpy(def.world_from_camera, h + 22, 16 * sizeof *h);
    vlCamera camera;
    vlError error;
    if (vl_camera_make(&def, &camera, NULL, &error) != VL_OK) {
      fprintf(stderr, "%s\n", error.message);
      return 1;
    }
    size_t n = (size_t)h[38];
    double *points = malloc(n * 3 * sizeof *points), *out = malloc((n * 4 + 2) * sizeof *out);
    double *pixels = malloc(n * 2 * sizeof *pixels), *z = malloc(n * sizeof *z);
    unsigned char *valid = malloc(n);
    if (!points || !out || !pixels || !z || !valid ||
        fread(points, 3 * sizeof *points, n, stdin) != n)
      return 1;
    vl_camera_project_batch(&camera, n, points, pixels, z, valid);
    out[0] = camera.outside;
    out[1] = camera.distortion.radius;
    for (size_t i = 0; i < n; i++) {
      double *o = out + 2 + 4 * i;
      o[0] = pixels[2 * i];
      o[1] = pixels[2 * i + 1];
      o[2] = z[i];
      o[3] = valid[i];
    }
    if (fwrite(out, sizeof *out, 4 * n + 2, stdout) != 4 * n + 2)
      return 1;
    free(points);
    free(out);
    free(pixels);
    free(z);
    free(valid);
  }
  return 0;
}
