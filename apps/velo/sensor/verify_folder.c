/* sensor/verify_folder.c: the frames as files, in the folder that EMVA's own program reads: a
 * descriptor EMVA1288_Data.txt, and the images it names
 * (github.com/EMVA1288/emva1288, doc/datasets_image.rst). */
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "cli/macros.h"
#include "cli/report.h"
#include "sensor/verify.h"

int verify_folder_open(Verify *v) {
  char path[4096];
  if (!v->folder)
    return -1;
  int length = text_set(path, "%s/EMVA1288_Data.txt", v->folder);
  if (length >= (int)sizeof path)
    return report_usage("--frames: the name is too long");
  mkdir(v->folder, 0777);
  v->descriptor = fopen(path, "wx");
  if (!v->descriptor)
    return report_failure(
        STATUS_IO, "%s: cannot be written: --frames needs a new or an empty folder", path);
  fprintf(v->descriptor, "v 3.1\nn %u %u %u\n", vl_sensor_def(v->sensor)->bits, v->size,
          v->size);
  return -1;
}

/* A series of frames. kind: 'b' bright, 'd' dark. time: exposure time, seconds; in the file in
 * ns. electrons: mean number per pixel; in the file photons. */
int verify_folder_series(Verify *v, char kind, double time, double electrons) {
  if (!v->descriptor)
    return -1;
  if (kind == 'b')
    fprintf(v->descriptor, "b %.3f %.6f\n", time * 1e9, electrons / v->efficiency);
  else
    fprintf(v->descriptor, "d %.3f\n", time * 1e9);
  return -1;
}

int verify_folder_frame(Verify *v, int which) {
  char path[4096];
  char name[32];
  vlError error = {0};
  vlImage *image = NULL;
  if (!v->descriptor)
    return -1;
  text_set(name, "frame_%04u.png", v->frame - 1);
  if (text_set(path, "%s/%s", v->folder, name) >= (int)sizeof path)
    return report_usage("--frames: the name is too long");
  vlImageDef def = vl_default_image_def(v->size, v->size, 1);
  def.type = VL_PIXEL_U16;
  vlResult result = vl_image_create(v->context, &def, &image);
  if (result == VL_OK) {
    memcpy(vl_image_pixels(image), v->frames[which],
           sizeof(uint16_t) * (size_t)v->size * v->size);
    result = vl_image_write(image, path, NULL, &error);
  }
  vl_image_destroy(image);
  if (result == VL_OK)
    fprintf(v->descriptor, "i %s\n", name);
  return report_error(&error, result, path);
}

int verify_folder_close(Verify *v) {
  FILE *file = v->descriptor;
  v->descriptor = NULL;
  if (!file)
    return -1;
  bool failed = ferror(file) != 0;
  failed |= fclose(file) != 0;
  return failed ? report_failure(STATUS_IO, "%s: the descriptor cannot be written", v->folder)
                : -1;
}
