/* api/receipt_settings.c: the settings in a receipt: the members of the defs by their names.
 * Enumerators have the names of their kinds. Numbers that are not set are left out. */
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "api/receipt.h"
#include "camera/parts.h"
#include "sampler/sampler.h"
#include "velo/schema.h"
#include "velo/trace.h"
#include "world/accel/accel.h"

typedef enum Type { BOOL, COUNT, FLOAT, DOUBLE, CHOICE, FAMILY, STRING } Type;

typedef struct Field {
  const char *name;
  Type type;
  size_t offset;
  uint32_t count;           /* number of values; more than one value is written as a list */
  const char *const *names; /* CHOICE: the name of each enumerator, ending with null */
  const char *family;       /* FAMILY: name of the family in velo/schema.h */
} Field;

#define MEMBER(def, member, type, size) \
#member, type, offsetof(def, member), sizeof((def *)0)->member / (size)
#define FIELD_BOOL(def, member) \
  { MEMBER(def, member, BOOL, sizeof(bool)), NULL, NULL }
#define FIELD_COUNT(def, member) \
  { MEMBER(def, member, COUNT, sizeof(uint32_t)), NULL, NULL }
#define FIELD_FLOAT(def, member) \
  { MEMBER(def, member, FLOAT, sizeof(float)), NULL, NULL }
#define FIELD_DOUBLE(def, member) \
  { MEMBER(def, member, DOUBLE, sizeof(double)), NULL, NULL }
#define FIELD_STRING(def, member) \
  { MEMBER(def, member, STRING, sizeof(char *)), NULL, NULL }
#define FIELD_CHOICE(def, member, names) \
  { MEMBER(def, member, CHOICE, sizeof(int)), names, NULL }
#define FIELD_FAMILY(def, member, family) \
  { MEMBER(def, member, FAMILY, sizeof(int)), NULL, family }
#define FIELD_END \
  { NULL, BOOL, 0, 0, NULL, NULL }

static const char *const colors[] = {"spectral", "rgb", NULL};
static const char *const light_samplers[] = {"bvh", "power", "uniform", NULL};
static const char *const bits[] = {"portable", "fast", NULL};
static const char *const spaces[] = {"srgb", "dci-p3", "rec2020", "aces2065-1", NULL};
static const char *const views[] = {"standard", "khronos-neutral", "agx", "raw", NULL};
static const char *const environments[] = {"auto", "none",  "studio", "sky",     "white",
                                           "file", "lamps", "window", "evening", NULL};
static const char *const framings[] = {"auto", "corner", "front", NULL};

static const Field load_fields[] = {FIELD_BOOL(vlLoadDef, permissive),
                                    FIELD_DOUBLE(vlLoadDef, time),
                                    FIELD_DOUBLE(vlLoadDef, time_close),
                                    FIELD_STRING(vlLoadDef, scene),
                                    FIELD_STRING(vlLoadDef, animation),
                                    FIELD_STRING(vlLoadDef, variant),
                                    FIELD_STRING(vlLoadDef, camera),
                                    FIELD_BOOL(vlLoadDef, strict),
                                    FIELD_STRING(vlLoadDef, search_path),
                                    FIELD_DOUBLE(vlLoadDef, unit),
                                    FIELD_END};
static const Field complete_fields[] = {FIELD_CHOICE(vlCompleteDef, environment, environments),
                                        FIELD_DOUBLE(vlCompleteDef, rotation),
                                        FIELD_FLOAT(vlCompleteDef, strength),
                                        FIELD_DOUBLE(vlCompleteDef, up),
                                        FIELD_DOUBLE(vlCompleteDef, front),
                                        FIELD_BOOL(vlCompleteDef, ground),
                                        FIELD_BOOL(vlCompleteDef, reframe),
                                        FIELD_CHOICE(vlCompleteDef, framing, framings),
                                        FIELD_DOUBLE(vlCompleteDef, azimuth),
                                        FIELD_DOUBLE(vlCompleteDef, elevation),
                                        FIELD_BOOL(vlCompleteDef, backdrop),
                                        FIELD_DOUBLE(vlCompleteDef, ground_middle),
                                        FIELD_DOUBLE(vlCompleteDef, ground_radius),
                                        FIELD_BOOL(vlCompleteDef, open_walls),
                                        FIELD_DOUBLE(vlCompleteDef, walls_from),
                                        FIELD_END};
static const Field film_fields[] = {FIELD_COUNT(vlFilmDef, width),
                                    FIELD_COUNT(vlFilmDef, height),
                                    FIELD_COUNT(vlFilmDef, crop),
                                    FIELD_FAMILY(vlFilmDef, filter.kind, "filters"),
                                    FIELD_FLOAT(vlFilmDef, filter.radius_x),
                                    FIELD_FLOAT(vlFilmDef, filter.radius_y),
                                    FIELD_FLOAT(vlFilmDef, filter.sigma),
                                    FIELD_FLOAT(vlFilmDef, filter.b),
                                    FIELD_FLOAT(vlFilmDef, filter.c),
                                    FIELD_FLOAT(vlFilmDef, filter.tau),
                                    FIELD_CHOICE(vlFilmDef, space, spaces),
                                    FIELD_DOUBLE(vlFilmDef, white_balance),
                                    FIELD_STRING(vlFilmDef, sensor),
                                    FIELD_FLOAT(vlFilmDef, max_component),
                                    FIELD_BOOL(vlFilmDef, errors),
                                    FIELD_COUNT(vlFilmDef, buckets),
                                    FIELD_DOUBLE(vlFilmDef, lambda_min),
                                    FIELD_DOUBLE(vlFilmDef, lambda_max),
                                    FIELD_END};
static const Field build_fields[] = {FIELD_CHOICE(vlBuildDef, color, colors),
                                     FIELD_CHOICE(vlBuildDef, light_sampler, light_samplers),
                                     FIELD_BOOL(vlBuildDef, imitate_pbrt),
                                     FIELD_BOOL(vlBuildDef, regularize),
                                     FIELD_CHOICE(vlBuildDef, bits, bits),
                                     FIELD_END};
/* time_limit is not among the fields, since the number of samples records its effect. */
static const Field render_fields[] = {FIELD_FAMILY(vlRenderDef, tracer, "tracers"),
                                      FIELD_FAMILY(vlRenderDef, sampler, "samplers"),
                                      FIELD_COUNT(vlRenderDef, spp),
                                      FIELD_COUNT(vlRenderDef, seed),
                                      FIELD_COUNT(vlRenderDef, sequence),
                                      FIELD_COUNT(vlRenderDef, max_depth),
                                      FIELD_COUNT(vlRenderDef, max_diffuse_depth),
                                      FIELD_COUNT(vlRenderDef, max_glossy_depth),
                                      FIELD_COUNT(vlRenderDef, max_transmission_depth),
                                      FIELD_COUNT(vlRenderDef, max_volume_depth),
                                      FIELD_FLOAT(vlRenderDef, ao_distance),
                                      FIELD_BOOL(vlRenderDef, ao_cosine),
                                      FIELD_BOOL(vlRenderDef, centred),
                                      FIELD_BOOL(vlRenderDef, same_wavelengths),
                                      FIELD_BOOL(vlRenderDef, sharp_textures),
                                      FIELD_BOOL(vlRenderDef, share_samples),
                                      FIELD_BOOL(vlRenderDef, transparent),
                                      FIELD_DOUBLE(vlRenderDef, merge_radius),
                                      FIELD_COUNT(vlRenderDef, light_paths),
                                      FIELD_END};
/* The object "adaptive" of "render". */
static const Field noise_fields[] = {
    FIELD_DOUBLE(vlRenderDef, noise), FIELD_CHOICE(vlRenderDef, noise_view, views),
    FIELD_FLOAT(vlRenderDef, noise_exposure), FIELD_FLOAT(vlRenderDef, noise_scale), FIELD_END};
static const Field develop_fields[] = {FIELD_FLOAT(vlDevelopDef, exposure), FIELD_END};

bool vl_receipt_put(json_t *parent, const char *key, json_t *value) {
  if (!parent || !value) {
    json_decref(value);
    return false;
  }
  return (key ? json_object_set_new(parent, key, value)
              : json_array_append_new(parent, value)) == 0;
}

/* Returns the name of a kind in scene files. If it has none there, returns the name of its
 * constant. */
static const char *kind_name(const char *family, uint32_t kind) {
  const vlKindFamily *f = vl_kind_family_find(family);
  if (!f || kind >= f->kind_count)
    return "unknown";
  return f->rows[kind]->name ? f->rows[kind]->name : f->words[kind];
}

static const char *choice(const char *const *names, uint32_t value) {
  for (uint32_t i = 0; names[i]; i++)
    if (i == value)
      return names[i];
  return "unknown";
}

static json_t *number(double value) {
  return isinf(value) ? json_string(value > 0 ? "infinity" : "-infinity") : json_real(value);
}

/* Makes the JSON of value i of a field. *unset: the value is a number that is not set. */
static json_t *value_of(const Field *field, const char *at, uint32_t i, bool *unset) {
  double d = 0;
  uint32_t u = 0;
  float f = 0;
  const char *text = NULL;
  switch (field->type) {
    case BOOL:
      return json_boolean(*(const bool *)(const void *)(at + i * sizeof(bool)));
    case FLOAT:
      memcpy(&f, at + i * sizeof f, sizeof f);
      *unset = isnan(f);
      return *unset ? NULL : number((double)f);
    case DOUBLE:
      memcpy(&d, at + i * sizeof d, sizeof d);
      *unset = vl_is_unset(d);
      return *unset ? NULL : number(d);
    case STRING:
      memcpy(&text, at + i * sizeof text, sizeof text);
      *unset = !text;
      return *unset ? NULL : json_string(text);
    case COUNT:
    case CHOICE:
    case FAMILY:
      memcpy(&u, at + i * sizeof u, sizeof u);
      break;
  }
  if (field->type == CHOICE)
    return json_string(choice(field->names, u));
  return field->type == FAMILY ? json_string(kind_name(field->family, u)) : json_integer(u);
}

static bool put_field(json_t *object, const Field *field, const void *def) {
  const char *at = (const char *)def + field->offset;
  bool unset = false;
  if (field->count == 1) {
    json_t *value = value_of(field, at, 0, &unset);
    return unset || vl_receipt_put(object, field->name, value);
  }
  json_t *list = json_array();
  for (uint32_t i = 0; i < field->count; i++) {
    json_t *value = value_of(field, at, i, &unset);
    if (!vl_receipt_put(list, NULL, unset ? json_null() : value)) {
      json_decref(list);
      return false;
    }
  }
  return vl_receipt_put(object, field->name, list);
}

/* Adds an object with the members of a def. Adds nothing if def is null. */
static bool put_def(json_t *tree, const char *name, const Field *fields, const void *def) {
  if (!def)
    return true;
  json_t *object = json_object();
  for (const Field *field = fields; field->name; field++)
    if (!put_field(object, field, def)) {
      json_decref(object);
      return false;
    }
  return vl_receipt_put(tree, name, object);
}

/* Adds the build settings. With fast bits the image also depends on the accelerator, that is on
 * Embree's instruction set, which is added, too. */
static bool put_build(json_t *tree, const vlBuildDef *build) {
  if (!put_def(tree, "build", build_fields, build))
    return false;
  if (build->bits == VL_BITS_PORTABLE)
    return true;
  const char *set = vl_accel_fast_set(build);
  return vl_receipt_put(json_object_get(tree, "build"), set ? "embree" : "accelerator",
                        json_string(set ? set : "bvh"));
}

/* Adds the render settings. A default length of the sequence is replaced by its number. */
static bool put_render(json_t *tree, vlRenderDef render) {
  if (!render.sequence)
    render.sequence = vl_sampler_sequence(render.sampler, render.spp);
  const char *sampler = render.own_sampler ? render.own_sampler->name : NULL;
  const char *tracer = render.own_tracer ? render.own_tracer->name : NULL;
  return put_def(tree, "render", render_fields, &render) &&
         (!sampler || vl_receipt_put(json_object_get(tree, "render"), "own_sampler",
                                     json_string(sampler))) &&
         (!tracer ||
          vl_receipt_put(json_object_get(tree, "render"), "own_tracer", json_string(tracer))) &&
         (!(render.noise > 0) ||
          put_def(json_object_get(tree, "render"), "adaptive", noise_fields, &render));
}

bool vl_receipt_put_settings(json_t *tree, const vlReceiptDef *def) {
  const vlSceneDefs *defs = def->defs;
  return put_def(tree, "load", load_fields, def->load) &&
         put_def(tree, "completed", complete_fields, def->complete) &&
         put_def(tree, "film", film_fields, &defs->film) && put_build(tree, &defs->build) &&
         put_render(tree, defs->render) &&
         put_def(tree, "develop", develop_fields, &defs->develop) &&
         vl_receipt_put(tree, "samples", json_integer(def->samples));
}
