/* camera_files/formats.h: the table of dialects, and the detection of a file's dialect. */
#ifndef CAMERA_FILES_FORMATS_H
#define CAMERA_FILES_FORMATS_H

#include "camera_files/files.h"

/* Indexed by vlCameraDialect; the entry of AUTO is null. */
extern const vlCameraFormat *const vl_camera_formats[VL_CAMERA_DIALECT_COUNT];
/* Returns AUTO if the tree is in none of the dialects. */
vlCameraDialect vl_camera_dialect_of_tree(const json_t *tree);
/* The same for files that are neither JSON nor YAML. The text ends with a zero byte. */
vlCameraDialect vl_camera_dialect_of_text(const char *text, size_t size);

#endif
