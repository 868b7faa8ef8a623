/** @file
 * velo/check.h: the scene doctor: finds likely mistakes in a scene, also in one that can be
 * rendered, and summarises its contents. It works on the description (velo/scene.h) of a scene
 * from any file format and builds no world. */
#ifndef VELO_CHECK_H
#define VELO_CHECK_H

#include "velo/channels.h"
#include "velo/load.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- findings ---------------------------------------------------------------------------- */

/** Kinds of findings. */
typedef enum vlFindingKind {
  VL_FINDING_MISSING_FILE, /**< a file that the scene names does not exist; the message has the
                              nearest name */
  VL_FINDING_BROKEN_FILE,  /**< an image that cannot be read */
  VL_FINDING_UNUSED,   /**< a named texture, material, medium or object, or an area light, that
                          nothing uses */
  VL_FINDING_REPLACED, /**< a material that is replaced by another before any shape uses it */
  VL_FINDING_OPEN_DIELECTRIC, /**< a refracting solid whose surface is not closed: it has edges
                                 with one face only */
  VL_FINDING_INVERTED_DIELECTRIC, /**< a refracting solid whose normals point inwards */
  VL_FINDING_MEDIA,      /**< solids of media that overlap, or are nested and disagree about the
                            medium between them */
  VL_FINDING_DEGENERATE, /**< faces without area, normals without length */
  VL_FINDING_NO_UV,  /**< a texture over uv on a mesh without uv, or vertex colours on a mesh
                        without them */
  VL_FINDING_ALBEDO, /**< a surface that reflects more light than it receives */
  VL_FINDING_CAMERA_INSIDE, /**< the camera is inside a closed solid */
  VL_FINDING_DARK_LIGHT, /**< a light of power 0, or one that arrives at the wrong side of its
                            portal */
  VL_FINDING_ROUGH_COAT, /**< a rough coat that loses light between its microfacets; the message
                            says how much */
  VL_FINDING_WRONG, /**< reported while loading (vl_scene_diagnose): any other error in the file
                     */
  VL_FINDING_OVERWRITTEN, /**< reported while loading: something is given twice, and the second
                             one is used */
  VL_FINDING_REMARK,      /**< reported while loading: a warning of the importer */
  VL_FINDING_KINDS        /**< number of kinds */
} vlFindingKind;
/** "missing-file", "unused", ...: a stable, constant string for programs. */
VL_API const char *vl_finding_kind_name(vlFindingKind kind);

/** Severity of a finding. */
typedef enum vlSeverity {
  VL_SEVERITY_ERROR,   /**< the scene cannot be rendered */
  VL_SEVERITY_WARNING, /**< the image is probably not what was intended */
  VL_SEVERITY_NOTE     /**< harmless */
} vlSeverity;

/** A finding. Its strings live as long as the check and the scene. */
typedef struct vlFinding {
  vlFindingKind kind;  /**< what was found */
  vlSeverity severity; /**< how bad it is */
  vlResult code;       /**< for errors: the result that rendering would return */
  vlSource source;     /**< location in the scene's file; file is null or line 0 if not known */
  const char *message; /**< one line */
} vlFinding;

/** A list of findings: errors first, then warnings, then notes. Constant once made. */
typedef struct vlCheck vlCheck;

/** What to check. */
typedef struct vlCheckDef {
  uint32_t cookie;
  bool names_only; /**< find unused names only; default false */
  bool images;     /**< read the scene's images for their greatest values; default true. Their
                    * existence is always checked */
} vlCheckDef;
/** The default def. */
VL_API vlCheckDef vl_default_check_def(void);
/** Checks a scene, which must outlive the check. def may be null. Errors: MEMORY, ARGUMENT, the
 * error of vl_scene_result. */
VL_API vlResult vl_scene_check(const vlScene *scene, const vlCheckDef *def, vlCheck **check,
                               vlError *error);
/** Null is allowed. */
VL_API void vl_check_destroy(vlCheck *check);
/** Number of findings. */
VL_API uint32_t vl_check_count(const vlCheck *check);
/** Finding `index`, from 0; lives as long as the check and the scene; null past the end. */
VL_API const vlFinding *vl_check_finding(const vlCheck *check, uint32_t index);

/* ---- loading with diagnosis -------------------------------------------------------------- */

/** Receives a problem of a file, on the calling thread. Its code is what loading would have
 * returned; VL_OK: a remark on something valid that may be unintended. `problem` lives until
 * the callback returns. */
typedef void vlProblemFn(void *user, const vlError *problem);
/** As vl_scene_load, but continues after an error where the format permits it (pbrt: after each
 * complete statement): the error is passed to `tell`, and its statement is left out of the
 * scene. Such a scene is for inspection, not for rendering. An error that ends the reading is
 * returned and not passed to `tell`. */
VL_API vlResult vl_scene_diagnose(vlScene *scene, const char *path, const vlLoadDef *def,
                                  vlProblemFn *tell, void *user, vlError *error);

/* ---- contents of a scene ----------------------------------------------------------------- */

/** A light: a vlLightDef, or a shape that emits light, with all its faces. */
typedef struct vlLightInfo {
  const char *kind; /**< point, spot, distant, infinite, area, ... */
  vlSource source;  /**< where the file describes it */
  uint64_t faces;   /**< area lights: number of emissive faces */
  bool image;       /**< its radiance comes from an image */
  /** Luminance times area times solid angle, integrated over all emitted light (of distant and
   * infinite lights: into a sphere around the scene). NaN with an image. */
  double power;
} vlLightInfo;
/** Number of lights. */
VL_API uint32_t vl_scene_light_count(const vlScene *scene);
/** Light `index`, from 0. ARGUMENT: no such light. */
VL_API vlResult vl_scene_light_info(const vlScene *scene, uint32_t index, vlLightInfo *info);
/** The number of ids of a kind in the world that is built from the scene. */
VL_API uint32_t vl_scene_id_count(const vlScene *scene, vlIdKind kind);
/** As vl_world_id_info, without building a world. Strings live as long as the scene. ARGUMENT:
 * no such id. */
VL_API vlResult vl_scene_id_info(const vlScene *scene, vlIdKind kind, uint32_t id,
                                 vlIdInfo *info);
/** What a glTF file lets its reader choose by vlLoadDef. */
typedef enum vlChoiceKind {
  VL_CHOICE_SCENE,
  VL_CHOICE_CAMERA,
  VL_CHOICE_ANIMATION,
  VL_CHOICE_VARIANT
} vlChoiceKind;
/** One of the choices. */
typedef struct vlChoiceInfo {
  const char *name; /**< its name in the file; may be null; lives as long as the scene */
  double seconds;   /**< of an animation: the time of its last key; else 0 */
} vlChoiceInfo;
/** The number of choices of a kind. */
VL_API uint32_t vl_scene_choice_count(const vlScene *scene, vlChoiceKind kind);
/** Choice `index`, from 0: the number that vlLoadDef accepts. ARGUMENT: no such choice. */
VL_API vlResult vl_scene_choice_info(const vlScene *scene, vlChoiceKind kind, uint32_t index,
                                     vlChoiceInfo *info);
/** Bounding box of all shapes in world space, instances included (moving ones at rest). Without
 * shapes: low > high. */
VL_API void vl_scene_bounds(const vlScene *scene, double low[3], double high[3]);

#ifdef __cplusplus
}
#endif
#endif
