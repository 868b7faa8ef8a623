/* render/scene_opening.h: what is known of a scene once it is open. */
#ifndef APP_RENDER_SCENE_OPENING_H
#define APP_RENDER_SCENE_OPENING_H

#include "velo/load.h"
#include "velo/render.h"

/* How a scene was loaded and completed. complete: what was added, with nothing left to
 * choose. */
typedef struct SceneOpening {
  vlLoadDef load;
  vlCompleteDef complete;
  bool lamps;             /* a file of a model (glTF, OBJ, PLY) that its own lights or
                                    surfaces light */
  bool self_lit;          /* surfaces of a model's file light it, and nothing is added */
  bool silent;            /* input: the camera that is added is not reported */
  bool images_only;       /* input: images alone are written (near.h) */
  const vlCancel *cancel; /* input: stops the load; null: nothing does */
  const char *text; /* input: a pbrt scene in memory, in place of the file; null: the file */
  bool model; /* a file of a model: its exposure is metered, its default output is a .png */
  vlEnvironmentKind environment; /* what is added: VL_ENVIRONMENT_NONE or a kind other than
                                    VL_ENVIRONMENT_AUTO */
  double moved[3];               /* what was subtracted from all positions (near.h) */
  bool camera_added;             /* the file has no camera: one was made for the scene */
  vlCameraDef camera;            /* before it was turned */
  vlWorld *metered;              /* the world with which the model was found lit or dark, for
                                    vlBuildDef.previous; null: it was not looked at */
  double low[3], high[3]; /* of what an added camera frames, else the bounds of the file's
 scene, without an added ground; low > high: it is empty */
} SceneOpening;

#endif
