/** @file
 * velo/load.h: scene files read into a scene, and what is added to a scene that lacks a camera,
 * a light or a ground. */
#ifndef VELO_LOAD_H
#define VELO_LOAD_H

#include "velo/scene_base.h"

#ifdef __cplusplus
extern "C" {
#endif

/** How to read a scene file. */
typedef struct vlLoadDef {
  uint32_t cookie;
  bool permissive; /**< true: features that are not supported cause warnings, and normals and
                      uvs that are not finite, normals that are zero and, in pbrt files, missing
                      images are repaired, with a warning that counts them; false: they are
                      errors (zero normals are not) */
  bool strict;     /**< glTF, OBJ: true: a missing image is an error; false: a warning, and the
                      material does without it */
  const char *search_path; /**< pbrt, glTF, OBJ: further folders, separated by ':', in which
                              files are looked for; null: none */
  double time; /**< glTF: time of the animations, seconds; unset: the scene without animation */
  double time_close; /**< glTF: time when the shutter closes, seconds, later than `time`; for
                        motion blur; unset: no motion */
  /** glTF: name of the scene, or its number from 0; null: the file's default */
  const char *scene;
  /** glTF: name of the animation, or its number from 0; null: the first */
  const char *animation;
  const char *variant; /**< glTF: name of a material variant; null: the file's default */
  const char *camera;  /**< glTF: name of the camera, or its number from 0; null: the first */
  double unit; /**< length of the file's unit, metres, 1e-9 to 1e9: candela and lumens of its
                  lights give the light that they give in metres; unset: 1 */
  const vlCancel *cancel; /**< stops the load; the scene must then be destroyed or rolled
                              back (velo/edit.h); default null */
  vlStepFn *progress;     /**< default null */
  void *progress_user;    /**< passed to progress */
} vlLoadDef;
/** The default def. */
VL_API vlLoadDef vl_default_load_def(void);
/** Adds the contents of a file to the scene. The suffix selects the format: .pbrt, .gltf, .glb,
 * .obj, .ply, .stl or .off; all but glTF's two also with .gz behind it. Relative paths in the
 * file are relative to its folder. def may be null. Errors: SCENE, MISSING, IO, MEMORY,
 * UNSUPPORTED (valid, but not supported; the message says what). */
VL_API vlResult vl_scene_load(vlScene *scene, const char *path, const vlLoadDef *def,
                              vlError *error);

/** As vl_scene_load, for a pbrt scene in memory. name: the file's name in messages, required;
 * relative paths are relative to its folder, which need not contain a file of this name. data
 * is copied. */
VL_API vlResult vl_scene_load_memory(vlScene *scene, const char *name, const void *data,
                                     size_t size, const vlLoadDef *def, vlError *error);

/** The environment (light from all directions) that vl_scene_complete adds. */
typedef enum vlEnvironmentKind {
  VL_ENVIRONMENT_AUTO,   /**< STUDIO if vlSceneDefs.light_missing, else none. If the scene has
                            other lights, its strength is such that a surface gets 0.3 times as
                            much light from it as from them. None if the file has a camera and
                            surfaces that emit light, brighter than white, light the others */
  VL_ENVIRONMENT_NONE,   /**< none is added */
  VL_ENVIRONMENT_STUDIO, /**< a studio: soft boxes above and in front in a cool grey room */
  VL_ENVIRONMENT_SKY,    /**< a clear sky and the sun */
  VL_ENVIRONMENT_WHITE,  /**< radiance 1 from all directions */
  VL_ENVIRONMENT_FILE,   /**< the image at `path` */
  VL_ENVIRONMENT_LAMPS,  /**< for models that enclose their camera: the studio, and lamps in the
                            free space around the camera or, if it is not inside the model,
                            around the model's middle */
  VL_ENVIRONMENT_WINDOW, /**< a studio: daylight through a tall window on the left, in a warm
                            room */
  VL_ENVIRONMENT_EVENING /**< a studio: a low warm sun on the left, and a blue sky */
} vlEnvironmentKind;
/** Whether the environment is a studio: its main light is on the left of the camera, and it has
 * a floor (vlCompleteDef.backdrop). Any thread. */
VL_API bool vl_environment_is_studio(vlEnvironmentKind kind);
/** From where the added camera looks. */
typedef enum vlFraming {
  VL_FRAMING_AUTO,   /**< CORNER; flat models nearly along their normal; the middle of a shell
                        that contains nothing */
  VL_FRAMING_CORNER, /**< from the front, slightly from the right and from above */
  VL_FRAMING_FRONT   /**< straight from the front */
} vlFraming;
/** What to add to a scene that lacks a camera, a light or a ground. */
typedef struct vlCompleteDef {
  uint32_t cookie;
  uint32_t width, height; /**< image size in pixels, for framing and for files without a size;
                             0: the film's */
  vlEnvironmentKind environment; /**< default AUTO */
  /** FILE: path of an image, either twice as wide as high (longitude and latitude; its centre
   * is in the direction -front) or square (equal-area octahedral) */
  const char *path;
  double rotation; /**< rotation of the environment about `up`, radians, counter-clockwise as
                      seen from above; unset: a studio's main light is on the left of the
                      added or the file's camera, all others are not rotated */
  float strength;  /**< factor on the environment's radiance */
  double up[3], front[3]; /**< directions in world space; default +y and +z, as in glTF */
  bool find_up; /**< `up` is y or z, and a guess: the other one is taken if the model stands on
                   its base only so; default false */
  bool ground;  /**< adds a wide grey disk under everything */
  bool reframe; /**< replaces the file's camera by one that frames the scene */
  vlFraming framing; /**< where the added camera stands */
  /** Where the added camera stands, as seen from the model's middle: radians from `front` to
   * the right, and above the horizon. Unset: as `framing` says. */
  double azimuth, elevation;
  /** With a studio: a ground of the studio's colour under the model, which catches its shadows
   * and becomes transparent away from it. It is a backdrop (vlShapeDef.backdrop). None where
   * the camera is inside the model or does not look from above. Default false. */
  bool backdrop;
  /** Middle, in world space, and radius of the ground. Unset: under the model, by its size.
   * With either the backdrop does not depend on the camera and the studio. */
  double ground_middle[3], ground_radius;
  /** With the added camera: of a closed model (a room whose walls hide it, a dome around it)
   * the faces between the camera and the middle are left out; a note gives their number. The
   * camera of a dome frames what the dome contains. Default false. */
  bool open_walls;
  /** The point, in world space, that stands for the camera when walls are left out. Unset: the
   * added camera's eye, or a point far away behind it. */
  double walls_from[3];
  /** One-sided faces (vlShapeDef.one_sided) are seen from both sides. With open_walls it is
   * chosen for an object that is wound the wrong way: its faces look inwards, and it is no
   * room. Default false. */
  bool both_sides;
} vlCompleteDef;
/** The default def. */
VL_API vlCompleteDef vl_default_complete_def(void);
/** Adds what is missing (vlSceneDefs.camera_missing, light_missing) or requested. The new
 * camera looks at the whole scene (vlFraming). What is chosen is logged (VL_LOG_DEBUG). def may
 * be null. Errors: as vl_scene_result; MISSING, IO (path). */
VL_API vlResult vl_scene_complete(vlScene *scene, const vlCompleteDef *def, vlError *error);
/** What vl_scene_complete added last, as a def that leaves nothing to choose: vl_scene_complete
 * by it gives the same file's scene the same lights, ground and walls and, if it has no camera,
 * the same camera, bit for bit. What was not added is not asked for. The path is the pointer
 * that was given. Before any vl_scene_complete it is the default def. */
VL_API vlCompleteDef vl_scene_completed(const vlScene *scene);
/** The box in world space of what the camera frames that vl_scene_complete has added last: the
 * model without stray parts, without a wide ground and without a dome. False, and the box is
 * left as it is: it has added no camera. Any thread that has the scene for itself. */
VL_API bool vl_scene_framed(const vlScene *scene, double low[3], double high[3]);

#ifdef __cplusplus
}
#endif
#endif
