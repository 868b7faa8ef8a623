/* camera_files/formats.h: the table of dialects, and the detection of a file's dialect. */
#ifndef CAMERA_FILES_FORMATS_H
#define CAMERA_FILES_FORMATS_H

#include "camera_files/files.h"

/* Indexed by vlCameraDialect; the entry of AUTO is null. */
extern const vlCameraFormat *const vl_camera_formats[VL_CAMERA_DIALECT_COUNT];
/* Returns AUTO if the tree is in none of the dialects. */
vlCameraDialect vl_camera_dialect_of_tree(const json_t *tree);
/* Which other program a file that is in none of the dialects seems to be from, and what to give
 * instead: a constant text, or null. */
const char *vl_camera_other_tool(const char *text, size_t size);
/* Goes through the fields of all objects of the tree whose names the dialect's row does not
 * know. Those that by their name change the image (crop, flip, skew, k5, ...) and are not off
 * (null, false, 0, "none") are errors; the record counts the others. */
vlResult vl_camera_check_unread(const vlCameraFile *file, const vlCameraFormat *format,
                                const json_t *tree, vlCameraRecord *record);
/* The same for a text with a separator in its dialect's row: for its lines. */
vlResult vl_camera_check_lines(const vlCameraFile *file, const vlCameraFormat *format,
                               const char *text, size_t size, vlCameraRecord *record);
/* The same as vl_camera_dialect_of_tree for files that are neither JSON nor YAML. The text ends
 * with a zero byte. */
vlCameraDialect vl_camera_dialect_of_text(const char *text, size_t size);

#endif
