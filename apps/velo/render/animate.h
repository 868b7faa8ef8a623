/* render/animate.h: --animate and --turntable: frames of an animated model, or of a camera that
 * goes around it. Each frame is a render of its own, with the receipt of the command that makes
 * it alone. */
#ifndef APP_RENDER_ANIMATE_H
#define APP_RENDER_ANIMATE_H

#include "render/job.h"
#include "render/scene_options.h"
#include "render/steady.h"
#include "render/video.h"
#include "velo/choose.h"

/* What the frames have in common. They are built in one context, each with the world of the
 * frame before it, so that what has not changed is neither read nor built again
 * (vlBuildDef.previous). With --turntable only the camera changes: scene and world are those of
 * the first frame. */
typedef struct AnimateShared {
  float exposure; /* of all frames, in stops; NaN until the first one has been metered */
  bool preparing; /* the first frame of all is not rendered: it only sets the exposure and the
                     tracer */
  const Arguments *whole; /* the command line, from which those of the frames are made */
  bool job_checked, tracer_checked; /* options without effect have been reported (needs.h) */
  bool raced;                       /* the first frame had its race, or needed none */
  RaceKind race;                    /* RACE_NONE: none was needed, and choice is not set */
  vlTracerChoice choice;
  bool still;    /* --turntable */
  Steady steady; /* with --denoise: the frames that the next ones use */
  vlContext *context;
  vlScene *scene; /* with --turntable; null before the first frame */
  vlWorld *world; /* of the last frame; null before the first one */
  SceneOpening opening;
  vlSceneDefs defs; /* of the scene as it was opened */
} AnimateShared;

/* Renders one image. videos: what becomes of it; null: it stays an image. */
typedef int AnimateRender(const Arguments *arguments, AnimateShared *shared, Videos *videos);

bool animate_wanted(const Arguments *arguments);
/* Renders the frames one after the other. Returns the exit code; the first failure ends it. */
int animate_run(const Arguments *arguments, Videos *videos, AnimateRender *render);

#endif
