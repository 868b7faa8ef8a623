/* render/support.c: what tracers do not render: a table of features by tracers. vl_render uses VL_TRACER_VOLPATH in
 * place of a tracer that lacks a feature of the scene, and the race of the tracers (choose.c) leaves such scenes out. A
 * new row is enough for both; docs/tracers.md lists the rows. */
#include "velo/render.h"
#include "world/world.h"

/* A set of tracers. */
#define BIT(tracer) (1u << (tracer))
enum {
  CONNECTING = BIT(VL_TRACER_BIDIRECTIONAL) | BIT(VL_TRACER_MERGING) | BIT(VL_TRACER_SPPM),
  FROM_LIGHTS = CONNECTING | BIT(VL_TRACER_LIGHT_PATH)
};

typedef struct Scene {
  const vlWorld *world;
  const vlCamera *camera;
  const vlFilmDef *film;
} Scene;

/* A feature, and the tracers that do not render it. */
typedef struct Feature {
  const char *name; /* in the note of the log: "this tracer does not support NAME" */
  bool (*present)(const Scene *scene);
  uint32_t lacking;
} Feature;

static bool has_spectral_film(const Scene *s) {
  return s->film->buckets > 0;
}

/* All paths of a pass, or of a group of light paths, have one time; with a readout time each row has its own. */
static bool has_rolling_shutter(const Scene *s) {
  return (s->world->moves || s->camera->moves) && s->camera->readout > 0;
}

static bool has_subsurface(const Scene *s) {
  return s->world->has_subsurface;
}

/* A light path goes the other way and would meet the side that camera paths do not. */
static bool has_one_sided(const Scene *s) {
  return s->world->has_one_sided;
}

/* A curve turns to face the ray that hits it (world/shape/curve.c). The surface that a light path hits is not the
 * surface that a camera path hits: their points, normals and areas differ, and so do the shadow rays from them. */
static bool has_curves(const Scene *s) {
  for (size_t i = 0; i < s->world->shapes.count; i++)
    if (s->world->shapes.items[i].kind == VL_SHAPE_CURVES) return true;
  return false;
}

static bool is_hair(const vlWorld *world, uint32_t material) {
  const vlWorldMaterial *m = &world->materials.items[material];
  if (m->kind != VL_MATERIAL_MIX) return m->kind == VL_MATERIAL_HAIR;
  return is_hair(world, m->mix[0]) || is_hair(world, m->mix[1]);
}

/* The BSDF of hair (trace/bsdf/hair.hot.c) is not symmetric: absorption, refraction and the tilt of the scales follow
 * from the direction of the camera. Light paths would need its adjoint. */
static bool has_hair(const Scene *s) {
  for (size_t i = 0; i < s->world->shapes.count; i++)
    if (is_hair(s->world, s->world->shapes.items[i].material)) return true;
  return false;
}

/* The roughness of a vertex depends on the path before it, so paths from both sides would not see the same BSDF. */
static bool has_regularisation(const Scene *s) {
  return s->world->def.regularize;
}

static const Feature features[] = {
    {"films with spectra", has_spectral_film, FROM_LIGHTS},
    {"motion with a rolling shutter", has_rolling_shutter, FROM_LIGHTS},
    {"material \"subsurface\"", has_subsurface, FROM_LIGHTS},
    {"surfaces that rays pass through from one side", has_one_sided, FROM_LIGHTS},
    {"shape \"curve\"", has_curves, FROM_LIGHTS},
    {"material \"hair\"", has_hair, FROM_LIGHTS},
    {"regularization", has_regularisation, FROM_LIGHTS},
};

const char *vl_tracer_lacks(const vlWorld *world, const vlCamera *camera, const vlFilmDef *film, vlTracer tracer) {
  const Scene scene = {world, camera, film};
  for (size_t i = 0; i < sizeof features / sizeof *features; i++)
    if (features[i].lacking & BIT(tracer) && features[i].present(&scene)) return features[i].name;
  return NULL;
}
