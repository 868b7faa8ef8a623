/** @file
 * velo/camera_file.h: cameras in the files of other tools, read and written. docs/camera-files.md says for every
 * dialect what it holds, its axes and its pixel origin; everything is brought to velo's: x right, y down, z forward,
 * the first pixel's centre at (0.5, 0.5). What a dialect cannot hold is refused by name, never dropped silently. */
#ifndef VELO_CAMERA_FILE_H
#define VELO_CAMERA_FILE_H

#include "velo/camera.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum vlCameraDialect {
  VL_CAMERA_DIALECT_AUTO,    /**< reading: by content and name; writing: by the file's suffix where that is clear */
  VL_CAMERA_DIALECT_VELO,    /**< JSON; holds everything, exactly */
  VL_CAMERA_DIALECT_OPENCV,  /**< YAML or JSON, also FileStorage's */
  VL_CAMERA_DIALECT_ROS,     /**< camera_info YAML */
  VL_CAMERA_DIALECT_COLMAP,  /**< folder with cameras.txt and images.txt, or one of them */
  VL_CAMERA_DIALECT_NERF,    /**< transforms.json */
  VL_CAMERA_DIALECT_KALIBR,  /**< camchain YAML */
  VL_CAMERA_DIALECT_BLENDER, /**< JSON of Blender's own property names */
  VL_CAMERA_DIALECT_PBRT,    /**< written only: Transform and Camera statements; scenes are read by vl_scene_load */
  VL_CAMERA_DIALECT_GLTF,    /**< a node with a camera; .glb is read too */
  VL_CAMERA_DIALECT_OPENGL,  /**< projection and view matrix, as JSON or YAML; conventions stated */
  VL_CAMERA_DIALECT_VULKAN,
  VL_CAMERA_DIALECT_D3D,
  VL_CAMERA_DIALECT_MITSUBA, /**< a sensor in Mitsuba 3's XML */
  VL_CAMERA_DIALECT_USD,     /**< a Camera in USD's text form, .usda */
  VL_CAMERA_DIALECT_EXR,     /**< the header of an image that the program velo rendered; read by that program alone */
  VL_CAMERA_DIALECT_COUNT
} vlCameraDialect;

/** "velo", "opencv", ...; null outside the range. */
VL_API const char *vl_camera_dialect_name(vlCameraDialect dialect);

typedef struct vlCameraFileDef {
  uint32_t cookie;
  vlCameraDialect dialect;
  const char *frame; /**< of files with several cameras or poses: its name or its number from 0; null: the first */
  const char *const *drop; /**< fields that writing may leave out */
  uint32_t drop_count;
  uint32_t width,
      height; /**< the image's, for dialects that hold none (glTF); 0: 720 rows of the file's aspect ratio */
} vlCameraFileDef;

VL_API vlCameraFileDef vl_default_camera_file_def(void);

typedef struct vlCameraRecord {
  vlCameraDef camera;
  vlCameraDialect dialect; /**< that it was read as */
  uint32_t frames;         /**< that the file holds */
  bool size_assumed;       /**< the file holds no image size, and the def gave none */
  char name[256];          /**< of the camera or its image; may be empty */
} vlCameraRecord;

/** Null def: the default. Errors: MISSING, IO, MEMORY; SCENE: what the file says is wrong, with the field's name;
 * UNSUPPORTED: understood, but no camera of velo's. The camera is not made yet: vl_camera_make judges its numbers. */
VL_API vlResult vl_camera_read(vlContext *context, const char *path, const vlCameraFileDef *def, vlCameraRecord *record,
                               vlError *error);
/** The file is written whole or not at all. UNSUPPORTED: the dialect cannot hold a field that the camera has; the
 * message names it. */
VL_API vlResult vl_camera_write(vlContext *context, const char *path, const vlCameraFileDef *def,
                                const vlCameraRecord *record, vlError *error);

#ifdef __cplusplus
}
#endif
#endif
