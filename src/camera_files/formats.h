/* camera_files/formats.h: the table of dialects, and which one a file is in. */
#ifndef CAMERA_FILES_FORMATS_H
#define CAMERA_FILES_FORMATS_H

#include "camera_files/files.h"

/* By vlCameraDialect; AUTO has none. */
extern const vlCameraFormat *const vl_camera_formats[VL_CAMERA_DIALECT_COUNT];
/* AUTO: none of them. */
vlCameraDialect vl_camera_dialect_of_tree(const json_t *tree);
/* For files that are neither JSON nor YAML; text ends with a zero byte. */
vlCameraDialect vl_camera_dialect_of_text(const char *text, size_t size);

#endif
