/* camera_files/colmap.h: functions shared by the readers and writers of COLMAP's text and
 * binary models. */
#ifndef CAMERA_FILES_COLMAP_H
#define CAMERA_FILES_COLMAP_H

#include "camera_files/files.h"

/* Reads a file of a model as text that ends with a zero byte. A .bin file is converted to the
 * text form. The caller releases the text with vl_free. */
vlResult vl_colmap_load(const vlCameraFile *file, const char *path, char **text, size_t *size);

/* A camera and its image, to be written. */
typedef struct vlColmapRecord {
  const char *model, *name;
  uint32_t width, height, count;
  double parameters[16], quaternion[4], translation[3]; /* w x y z */
} vlColmapRecord;
void vl_colmap_put_bin(vlCameraText *cameras, vlCameraText *images,
                       const vlColmapRecord *record);

#endif
