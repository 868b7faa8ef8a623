/** @file
 * velo/camera_file.h: reads and writes the camera files of other tools. docs/camera-files.md
 * gives each dialect's contents, axes and pixel origin. Reading converts them to velo's
 * conventions: x right, y down, z forward, the first pixel's centre at (0.5, 0.5). If a dialect
 * cannot hold a field, writing fails with an error that names the field. */
#ifndef VELO_CAMERA_FILE_H
#define VELO_CAMERA_FILE_H

#include "velo/camera.h"

#ifdef __cplusplus
extern "C" {
#endif

/** File formats for cameras. */
typedef enum vlCameraDialect {
  VL_CAMERA_DIALECT_AUTO, /**< reading: by content and name; writing: by the suffix, where that
                             is unambiguous */
  VL_CAMERA_DIALECT_VELO, /**< JSON; holds everything, exactly */
  VL_CAMERA_DIALECT_OPENCV,  /**< YAML, JSON or XML, also FileStorage's */
  VL_CAMERA_DIALECT_ROS,     /**< camera_info YAML, or .ini */
  VL_CAMERA_DIALECT_COLMAP,  /**< a folder with the files cameras and images (.txt or .bin), or
                                one of these files */
  VL_CAMERA_DIALECT_NERF,    /**< transforms.json */
  VL_CAMERA_DIALECT_KALIBR,  /**< camchain YAML */
  VL_CAMERA_DIALECT_BLENDER, /**< JSON of Blender's own property names */
  VL_CAMERA_DIALECT_PBRT,   /**< write only: Transform and Camera statements; scenes are read by
                               vl_scene_load */
  VL_CAMERA_DIALECT_GLTF,   /**< a node with a camera; .glb is read too */
  VL_CAMERA_DIALECT_OPENGL, /**< projection and view matrix and their conventions, as JSON or
                             * YAML
                             */
  VL_CAMERA_DIALECT_VULKAN, /**< as OPENGL, with Vulkan's conventions */
  VL_CAMERA_DIALECT_D3D,    /**< as OPENGL, with Direct3D's conventions */
  VL_CAMERA_DIALECT_MITSUBA, /**< a sensor in Mitsuba 3's XML */
  VL_CAMERA_DIALECT_USD,     /**< a Camera in USD's text form, .usda */
  VL_CAMERA_DIALECT_EXR,     /**< the header of an image rendered by the program velo; only that
                                program reads it */
  VL_CAMERA_DIALECT_EUROC,   /**< sensor.yaml of the EuRoC datasets */
  VL_CAMERA_DIALECT_CAMODOCAL,  /**< camodocal's and VINS's YAML */
  VL_CAMERA_DIALECT_BASALT,     /**< Basalt's calibration JSON */
  VL_CAMERA_DIALECT_ORBSLAM,    /**< ORB-SLAM's settings, YAML */
  VL_CAMERA_DIALECT_OKVIS,      /**< OKVIS's configuration, YAML */
  VL_CAMERA_DIALECT_SVO,        /**< SVO's YAML, of one camera or of a rig */
  VL_CAMERA_DIALECT_KITTI,      /**< KITTI's calib.txt and calib_cam_to_cam.txt */
  VL_CAMERA_DIALECT_BOP,        /**< scene_camera.json and camera.json of the BOP challenge */
  VL_CAMERA_DIALECT_GAUSSIANS,  /**< cameras.json of 3D Gaussian splatting */
  VL_CAMERA_DIALECT_METASHAPE,  /**< Metashape's XML, of cameras or of a calibration */
  VL_CAMERA_DIALECT_MESHROOM,   /**< AliceVision's .sfm, JSON */
  VL_CAMERA_DIALECT_OPENSFM,    /**< reconstruction.json, camera_models.json */
  VL_CAMERA_DIALECT_OPEN3D,     /**< Open3D's pinhole camera and trajectory JSON */
  VL_CAMERA_DIALECT_VISP,       /**< ViSP's XML */
  VL_CAMERA_DIALECT_MIDDLEBURY, /**< calib.txt of the Middlebury stereo datasets */
  VL_CAMERA_DIALECT_MVSNET,     /**< MVSNet's cam.txt */
  VL_CAMERA_DIALECT_BUNDLER,    /**< Bundler's bundle.out */
  VL_CAMERA_DIALECT_OPENMVG,    /**< OpenMVG's sfm_data.json */
  VL_CAMERA_DIALECT_REALITYCAPTURE, /**< RealityCapture's XMP and CSV */
  VL_CAMERA_DIALECT_NERFSTUDIO,     /**< nerfstudio's camera_path.json */
  VL_CAMERA_DIALECT_VISUALSFM,      /**< VisualSFM's .nvm */
  VL_CAMERA_DIALECT_ZED,            /**< the .conf of ZED stereo cameras */
  VL_CAMERA_DIALECT_COLLADA,        /**< COLLADA's .dae */
  VL_CAMERA_DIALECT_DSO,            /**< camera.txt of DSO, LSD-SLAM, TUM monoVO */
  VL_CAMERA_DIALECT_LLFF,           /**< LLFF's poses_bounds.npy */
  VL_CAMERA_DIALECT_RECORD3D,       /**< Record3D's metadata */
  VL_CAMERA_DIALECT_POLYCAM,        /**< Polycam's JSON of a keyframe */
  VL_CAMERA_DIALECT_SCANNER3D,      /**< 3D Scanner App's frame JSON */
  VL_CAMERA_DIALECT_DEPTHAI,        /**< calibration JSON of OAK cameras */
  VL_CAMERA_DIALECT_KINECT,         /**< calibration JSON of Azure Kinect */
  VL_CAMERA_DIALECT_REALSENSE,      /**< RealSense's intrinsics as JSON */
  VL_CAMERA_DIALECT_CALIBIO,        /**< calib.io's JSON */
  VL_CAMERA_DIALECT_NUSCENES,       /**< nuScenes' calibrated_sensor.json */
  VL_CAMERA_DIALECT_PANOPTIC,       /**< calibration JSON of CMU Panoptic */
  VL_CAMERA_DIALECT_NERFIES,        /**< camera JSON of Nerfies and HyperNeRF */
  VL_CAMERA_DIALECT_THREEJS,        /**< three.js' JSON of a camera */
  VL_CAMERA_DIALECT_MATRIX,         /**< a matrix of numbers alone in a text file */
  VL_CAMERA_DIALECT_ARIA,           /**< calibration JSON of Project Aria's glasses */
  VL_CAMERA_DIALECT_COUNT           /**< number of dialects */
} vlCameraDialect;

/** "velo", "opencv", ...; a constant string; null outside the range. */
VL_API const char *vl_camera_dialect_name(vlCameraDialect dialect);

/** How to read or write a camera file. */
typedef struct vlCameraFileDef {
  uint32_t cookie;
  vlCameraDialect dialect; /**< default VL_CAMERA_DIALECT_AUTO */
  const char *frame; /**< the camera or pose to read from a file with several: its name, or its
                        number from 0; null: the first */
  const char *const *drop; /**< names of fields that writing may drop if the dialect cannot hold
                              them, as the errors name them (docs/camera-files.md has the list),
                              or "all"; another name is an error */
  uint32_t drop_count;     /**< length of drop */
  uint32_t width, height;  /**< image size, pixels, for files that have none; 0: the size of the
                              images that the file names, if they exist; else 720 rows for files
                              with an aspect ratio (glTF, USD), an error for others */
} vlCameraFileDef;

/** The default def. */
VL_API vlCameraFileDef vl_default_camera_file_def(void);

/** How many names of fields vlCameraRecord.unread_names has at most. */
enum { VL_UNREAD_NAMES = 3 };

/** A camera as read from a file, or to be written to one. */
typedef struct vlCameraRecord {
  vlCameraDef camera;      /**< the camera, in velo's conventions */
  vlCameraDialect dialect; /**< the dialect of the file read */
  uint32_t frames;         /**< number of cameras or poses in the file */
  bool size_assumed;       /**< the file holds no image size, and the def gave none */
  char name[256];          /**< name of the camera or its image; may be empty */
  uint32_t unread; /**< number of fields that velo does not understand; they have no effect.
                      docs/camera-files.md names the dialects in which they are counted */
  uint32_t unread_line; /**< the line of the first one; 0: unknown */
  /** the first VL_UNREAD_NAMES, as messages show them: "a", "b", "c" */
  char unread_names[128];
} vlCameraRecord;

/** Reads one camera. def may be null: the default. The result is a description; vl_camera_make
 * checks its numbers. Errors: MISSING, IO, MEMORY; SCENE: the contents are wrong, and the
 * message names the field; UNSUPPORTED: the camera is valid, but velo does not have its
 * model. */
VL_API vlResult vl_camera_read(vlContext *context, const char *path, const vlCameraFileDef *def,
                               vlCameraRecord *record, vlError *error);
/** Writes one camera; the file is written whole or not at all. def may be null: the default.
 * Errors: ARGUMENT, IO, MEMORY; UNSUPPORTED: the dialect cannot hold a field that the camera
 * has; the message names it. */
VL_API vlResult vl_camera_write(vlContext *context, const char *path,
                                const vlCameraFileDef *def, const vlCameraRecord *record,
                                vlError *error);
/** Whether vl_camera_write would write several files into a folder, which `path` or its folder
 * is, and not a file of that name. dialect: VL_CAMERA_DIALECT_AUTO: that of the name. */
VL_API bool vl_camera_writes_folder(const char *path, vlCameraDialect dialect);

#ifdef __cplusplus
}
#endif
#endif
