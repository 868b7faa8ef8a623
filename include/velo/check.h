/* velo/check.h: the scene doctor: what in a description is likely to be a mistake although it can be rendered, and what
 * a scene holds, for people. Reads the description (velo/scene.h) alone, whatever file it came from; builds nothing. */
#ifndef VELO_CHECK_H
#define VELO_CHECK_H

#include "velo/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- findings ---------------------------------------------------------------------------------------------------- */

typedef enum vlFindingKind {
  VL_FINDING_MISSING_FILE,        /* a file that the scene names is not there: the message names the nearest */
  VL_FINDING_BROKEN_FILE,         /* an image that cannot be read */
  VL_FINDING_UNUSED,              /* a named texture, material, medium or object that nothing uses; an area light */
  VL_FINDING_REPLACED,            /* a material that another one replaces before any shape takes it */
  VL_FINDING_OPEN_DIELECTRIC,     /* a body that light passes, whose surface has edges of one face only */
  VL_FINDING_INVERTED_DIELECTRIC, /* one whose normals point inwards */
  VL_FINDING_MEDIA,               /* bodies of media that overlap, or lie in each other and say something else */
  VL_FINDING_DEGENERATE,          /* faces without area, normals without length */
  VL_FINDING_NO_UV,               /* a texture over uv on a mesh that has none, or vertex colours that are not there */
  VL_FINDING_ALBEDO,              /* gives back more light than it gets */
  VL_FINDING_CAMERA_INSIDE,       /* the camera stands in a closed body */
  VL_FINDING_DARK_LIGHT,          /* a light of power 0 */
  VL_FINDING_ROUGH_COAT,          /* a rough coat that loses light between its microfacets: how much */
  VL_FINDING_WRONG,               /* told while loading (vlLoadDef's problem): what else is wrong in the file */
  VL_FINDING_OVERWRITTEN,         /* likewise: said twice, the second counts */
  VL_FINDING_REMARK,              /* likewise: the importer's own warnings */
  VL_FINDING_KINDS
} vlFindingKind;
/* "missing-file", "unused", ...: stable, for programs. */
VL_API const char *vl_finding_kind_name(vlFindingKind kind);

typedef enum vlSeverity {
  VL_SEVERITY_ERROR,   /* the scene cannot be rendered so */
  VL_SEVERITY_WARNING, /* the image is probably not what was meant */
  VL_SEVERITY_NOTE     /* harmless, and good to know */
} vlSeverity;

typedef struct vlFinding {
  vlFindingKind kind;
  vlSeverity severity;
  vlResult code;   /* errors: what rendering would return */
  vlSource source; /* file null, line 0 where not known */
  const char *message;
} vlFinding;

typedef struct vlCheck vlCheck; /* a list of findings: errors first, then warnings, then notes */

typedef struct vlCheckDef {
  uint32_t cookie;
  bool names_only; /* unused names alone; default false */
  bool images;     /* read the scene's images for their greatest values; default true. They are looked for anyway */
} vlCheckDef;
VL_API vlCheckDef vl_default_check_def(void);
/* def may be null. The scene must outlive the check. MEMORY; ARGUMENT; the scene's own error. */
VL_API vlResult vl_scene_check(const vlScene *scene, const vlCheckDef *def, vlCheck **check, vlError *error);
VL_API void vl_check_destroy(vlCheck *check);
VL_API uint32_t vl_check_count(const vlCheck *check);
/* Lives as long as the check and the scene; null past the end. */
VL_API const vlFinding *vl_check_finding(const vlCheck *check, uint32_t index);

/* ---- loading for a doctor ------------------------------------------------------------------------------------------
 */

/* code: what loading would have returned, and where; VL_OK: a remark on what is right and perhaps not meant. */
typedef void vlProblemFn(void *user, const vlError *problem);
/* As vl_scene_load, but where the file can be read on after a mistake (pbrt: after each wrong statement that is whole),
 * the mistake is told, what it says is left out, and the scene gets the rest. Such a scene is to be looked at, not to
 * be rendered. What ends the reading is returned, and not told. */
VL_API vlResult vl_scene_diagnose(vlScene *scene, const char *path, const vlLoadDef *def, vlProblemFn *tell, void *user,
                                  vlError *error);

/* ---- what a scene holds --------------------------------------------------------------------------------------------
 */

/* A light, or all faces of a shape that emits light. */
typedef struct vlLightInfo {
  const char *kind; /* point, spot, distant, infinite, area */
  vlSource source;
  uint64_t faces; /* area lights: how many emission */
  bool image;     /* its radiance comes from one */
  /* Luminance times area times solid angle, over all it sends out (of distant and infinite lights: into a sphere round
   * the scene). NaN where an image decides. */
  double power;
} vlLightInfo;
VL_API uint32_t vl_scene_light_count(const vlScene *scene);
/* ARGUMENT: no such light. */
VL_API vlResult vl_scene_light_info(const vlScene *scene, uint32_t index, vlLightInfo *info);
/* Box round all shapes, with instances where they stand (of those that move: at rest). Without any: low > high. */
VL_API void vl_scene_bounds(const vlScene *scene, double low[3], double high[3]);

#ifdef __cplusplus
}
#endif
#endif
