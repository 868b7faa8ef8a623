/* render/support.c: a table of features by tracers: what each tracer lacks. A new row is enough
 * for vl_render, the race and vl_tracer_lacks; docs/tracers.md lists the rows. */
#include "render/support.h"

#include "base/text.h"
#include "render/camera_view.h"
#include "velo/shape_kinds.h"
#include "velo/tracer.h"

#define BIT VL_TRACER_BIT
enum {
  FROM_LIGHTS = BIT(VL_TRACER_BIDIRECTIONAL) | BIT(VL_TRACER_MERGING) | BIT(VL_TRACER_SPPM) |
                BIT(VL_TRACER_LIGHT_PATH)
};

typedef struct Scene {
  const vlWorld *world;
  const vlCamera *camera;
  const vlFilmDef *film;
  vlResult result; /* MEMORY: a feature could not be looked for */
} Scene;

/* A feature, and the tracers that do not render it. */
typedef struct Feature {
  const char *name; /* in the note of the log: "this tracer does not support NAME" */
  bool (*present)(Scene *scene);
  uint32_t lacking;
} Feature;

static bool has_spectral_film(Scene *s) {
  return s->film->buckets > 0;
}

/* All paths of a pass, or of a group of light paths, have one time; with a readout time each
 * row has its own. */
static bool has_rolling_shutter(Scene *s) {
  return (s->world->moves || s->camera->moves) && s->camera->readout > 0;
}

static bool has_subsurface(Scene *s) {
  return s->world->has_subsurface;
}

/* A light path goes the other way and would meet the side that camera paths do not. */
static bool has_one_sided(Scene *s) {
  return s->world->has_one_sided;
}

/* Light paths would show the camera what camera rays do not meet. */
static bool has_hidden(Scene *s) {
  return s->world->has_hidden;
}

/* A curve turns to face the ray that hits it (shape/curves.c). The surface that a light
 * path hits is not the surface that a camera path hits: their points, normals and areas differ,
 * and so do the shadow rays from them. */
static bool has_curves(Scene *s) {
  for (size_t i = 0; i < s->world->shapes.count; i++)
    if (s->world->shapes.items[i].kind == VL_SHAPE_CURVES)
      return true;
  return false;
}

static bool is_hair(const vlWorld *world, uint32_t material) {
  const vlWorldMaterial *m = &world->materials.items[material];
  if (!m->mixed)
    return m->no_cosine; /* hair is the only such material */
  return is_hair(world, m->mix[0]) || is_hair(world, m->mix[1]);
}

/* The BSDF of hair (material/hair.hot.c) is not symmetric: absorption, refraction and the
 * tilt of the scales follow from the direction of the camera. Light paths would need its
 * adjoint. */
static bool has_hair(Scene *s) {
  for (size_t i = 0; i < s->world->shapes.count; i++)
    if (is_hair(s->world, s->world->shapes.items[i].material))
      return true;
  return false;
}

/* The roughness of a vertex depends on the path before it, so paths from both sides would not
 * see the same BSDF. */
static bool has_regularisation(Scene *s) {
  return s->world->def.regularize;
}

/* Light paths find such a camera only by paths from the camera (camera_view.h). */
static bool has_other_camera(Scene *s) {
  vlCameraView view;
  vl_camera_view(s->camera, s->film, &view);
  return !view.sees && !s->camera->own;
}
static bool has_other_own_camera(Scene *s) {
  vlCameraView view;
  vl_camera_view(s->camera, s->film, &view);
  return !view.sees && s->camera->own;
}

/* Light paths start at lights. Other tracers find a medium's own light by paths from the
 * camera. */
static bool has_emissive_media(Scene *s) {
  for (size_t i = 0; i < s->world->media.count; i++)
    if (s->world->media.items[i].emits)
      return true;
  return false;
}

static bool has_differing_media(Scene *s) {
  bool differ = false;
  s->result = vl_media_differ(s->world, s->camera, &differ);
  return differ;
}

/* What takes time is last. */
static const Feature features[] = {
    {"films with spectra", has_spectral_film, FROM_LIGHTS},
    {"motion with a rolling shutter", has_rolling_shutter, FROM_LIGHTS},
    {"material \"subsurface\"", has_subsurface, FROM_LIGHTS},
    {"surfaces that rays pass through from one side", has_one_sided, FROM_LIGHTS},
    {"shapes that are hidden from the camera", has_hidden, FROM_LIGHTS},
    {"shape \"curve\"", has_curves, FROM_LIGHTS},
    {"material \"hair\"", has_hair, FROM_LIGHTS},
    {"regularization", has_regularisation, FROM_LIGHTS},
    {"cameras other than perspective ones with a round lens", has_other_camera,
     BIT(VL_TRACER_LIGHT_PATH)},
    {"own cameras that do not project points, have a lens or move", has_other_own_camera,
     BIT(VL_TRACER_LIGHT_PATH)},
    {"light from media", has_emissive_media, BIT(VL_TRACER_LIGHT_PATH)},
    {"media that do not fit together", has_differing_media, FROM_LIGHTS},
};

vlResult vl_tracers_lack(const vlWorld *world, const vlCamera *camera, const vlFilmDef *film,
                         uint32_t tracers, const char **lack) {
  Scene scene = {world, camera, film, VL_OK};
  *lack = NULL;
  for (size_t i = 0; !*lack && i < VL_LENGTH(features); i++)
    if (features[i].lacking & tracers && features[i].present(&scene))
      *lack = features[i].name;
  return scene.result;
}

const char *vl_tracer_lacks(const vlWorld *world, const vlCamera *camera, const vlFilmDef *film,
                            vlTracer tracer) {
  const char *lack;
  vl_tracers_lack(world, camera, film, VL_TRACER_BIT(tracer), &lack);
  return lack;
}
