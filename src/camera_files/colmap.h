/* camera_files/colmap.h: what the text and the binary form of COLMAP's models share. */
#ifndef CAMERA_FILES_COLMAP_H
#define CAMERA_FILES_COLMAP_H

#include "camera_files/files.h"

/* Reads a file of a model as text; a .bin is turned into it. A zero byte follows; released with vl_free. */
vlResult vl_colmap_load(const vlCameraFile *file, const char *path, char **text, size_t *size);

/* A camera and its image, to be written. */
typedef struct vlColmapRecord {
  const char *model, *name;
  uint32_t width, height, count;
  double parameters[16], quaternion[4], translation[3]; /* w x y z */
} vlColmapRecord;
void vl_colmap_put_bin(vlCameraText *cameras, vlCameraText *images, const vlColmapRecord *record);

#endif
