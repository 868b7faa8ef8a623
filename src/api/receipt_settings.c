/* api/receipt_settings.c: the settings in a receipt: the members of the defs by the rows of
 * velo/setting.h. Enumerators have the names of their kinds. Numbers that are not set are left
 * out. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "api/receipt.h"
#include "base/text.h"
#include "base/unset.h"
#include "sampler/sampler.h"
#include "schema/schema.h"
#include "velo/setting.h"
#include "velo/trace.h"
#include "world/accel/accel.h"

/* How members begin that do not change the image, or that are put in another way: the number
 * of samples records what time_limit does; put_adaptive puts those of noise. */
static const char *const left_out[] = {"render.first_sample",
                                       "render.time_limit",
                                       "render.noise",
                                       "render.pass_rows",
                                       "render.priority",
                                       "build.accelerator",
                                       "width",
                                       "height",
                                       "path",
                                       "find_up"};
/* The object "adaptive" of "render". */
static const char *const adaptive[] = {"noise", "noise_view", "noise_exposure", "noise_scale"};

bool vl_receipt_put(json_t *parent, const char *key, json_t *value) {
  if (!parent || !value) {
    json_decref(value);
    return false;
  }
  return (key ? json_object_set_new(parent, key, value)
              : json_array_append_new(parent, value)) == 0;
}

/* The name of a kind in scene files, or of its constant if it has none there; of a choice that
 * is no kind, its name in the row with dashes. size: of name. */
static json_t *choice(const vlParameter *p, uint32_t value) {
  char name[64];
  snprintf(name, sizeof name, "%ss", vl_setting_keyword(p));
  const vlKindFamily *family = vl_kind_family_find(name);
  if (value >= vl_choice_count(p))
    return json_string("unknown");
  if (family)
    return json_string(family->rows[value]->name ? family->rows[value]->name
                                                 : family->words[value]);
  snprintf(name, sizeof name, "%s", p->choices[value]);
  for (char *dash = name; (dash = strchr(dash, '_'));)
    *dash = '-';
  return json_string(name);
}

static json_t *number(double value) {
  return isinf(value) ? json_string(value > 0 ? "infinity" : "-infinity") : json_real(value);
}

/* Makes the JSON of value i of a member. *unset: the value is a number that is not set. */
static json_t *value_of(const vlParameter *p, const char *at, uint32_t i, bool *unset) {
  const vlParameterType type = p->type;
  if (type == VL_PARAMETER_BOOL)
    return json_boolean(*(const bool *)(const void *)at);
  if (type == VL_PARAMETER_STRING) {
    const char *text;
    memcpy(&text, at, sizeof text);
    *unset = !text;
    return text ? json_string(text) : NULL;
  }
  if (type == VL_PARAMETER_COUNT || type == VL_PARAMETER_CHOICE) {
    uint32_t u;
    memcpy(&u, at, sizeof u);
    return type == VL_PARAMETER_CHOICE ? choice(p, u) : json_integer(u);
  }
  double d;
  float f = 0;
  if (type == VL_PARAMETER_FLOAT) {
    memcpy(&f, at, sizeof f);
    d = (double)f;
    *unset = isnan(f);
  } else {
    memcpy(&d, at + i * sizeof d, sizeof d);
    *unset = vl_is_unset(d);
  }
  return *unset ? NULL : number(d);
}

static bool put_member(json_t *object, const char *key, const vlParameter *p, const void *def) {
  const char *at = (const char *)def + p->offset;
  bool unset = false;
  if (p->type != VL_PARAMETER_DOUBLE3) {
    json_t *value = value_of(p, at, 0, &unset);
    return unset || vl_receipt_put(object, key, value);
  }
  json_t *list = json_array();
  for (uint32_t i = 0; i < 3; i++) {
    json_t *value = value_of(p, at, i, &unset);
    if (!vl_receipt_put(list, NULL, unset ? json_null() : value)) {
      json_decref(list);
      return false;
    }
  }
  return vl_receipt_put(object, key, list);
}

static bool is_left_out(const char *member) {
  for (size_t i = 0; i < VL_LENGTH(left_out); i++)
    if (strncmp(member, left_out[i], strlen(left_out[i])) == 0)
      return true;
  return false;
}

/* Adds the members of a group's def, without those left out. begin: they begin with it, the
 * key is the rest. */
static bool put_members(json_t *object, vlSettingGroup group, const char *begin,
                        const void *def) {
  const vlKindRow *row = vl_settings(group);
  const size_t length = strlen(begin);
  bool good = object != NULL;
  for (uint32_t i = 0; i < row->parameter_count && good; i++) {
    const vlParameter *p = &row->parameters[i];
    if (strncmp(p->member, begin, length) == 0 && !is_left_out(p->member))
      good = put_member(object, p->member + length, p, def);
  }
  return good;
}

/* Adds an object with the members of a def. Adds nothing if def is null. */
static bool put_def(json_t *tree, const char *name, vlSettingGroup group, const char *begin,
                    const void *def) {
  if (!def)
    return true;
  json_t *object = json_object();
  return vl_receipt_put(tree, name, object) && put_members(object, group, begin, def);
}

static bool put_film(json_t *tree, const vlSceneDefs *defs) {
  const vlFilmDef *film = &defs->film;
  const uint32_t *crop = film->crop;
  json_t *object = json_pack("{s:I,s:I,s:[IIII]}", "width", (json_int_t)film->width, "height",
                             (json_int_t)film->height, "crop", (json_int_t)crop[0],
                             (json_int_t)crop[1], (json_int_t)crop[2], (json_int_t)crop[3]);
  return vl_receipt_put(tree, "film", object) &&
         put_members(object, VL_SETTING_RENDER, "film.", defs);
}

/* Adds the build settings. With fast bits the image also depends on the accelerator, that is on
 * Embree's instruction set, which is added, too. */
static bool put_build(json_t *tree, const vlSceneDefs *defs) {
  if (!put_def(tree, "build", VL_SETTING_RENDER, "build.", defs))
    return false;
  if (defs->build.bits == VL_BITS_PORTABLE)
    return true;
  const char *set = vl_accel_fast_set(&defs->build);
  return vl_receipt_put(json_object_get(tree, "build"), set ? "embree" : "accelerator",
                        json_string(set ? set : "bvh"));
}

static bool put_adaptive(json_t *render, const vlSceneDefs *defs) {
  json_t *object = json_object();
  bool good = vl_receipt_put(render, "adaptive", object);
  for (size_t i = 0; i < VL_LENGTH(adaptive) && good; i++)
    good = put_member(object, adaptive[i], vl_setting(VL_SETTING_RENDER, adaptive[i]), defs);
  return good;
}

/* Adds the render settings. A default length of the sequence is replaced by its number. */
static bool put_render(json_t *tree, vlSceneDefs defs) {
  vlRenderDef *render = &defs.render;
  if (!render->sequence)
    render->sequence = vl_sampler_sequence(render->sampler, render->spp);
  const char *sampler = render->own_sampler ? render->own_sampler->name : NULL;
  const char *tracer = render->own_tracer ? render->own_tracer->name : NULL;
  if (!put_def(tree, "render", VL_SETTING_RENDER, "render.", &defs))
    return false;
  json_t *object = json_object_get(tree, "render");
  return (!sampler || vl_receipt_put(object, "own_sampler", json_string(sampler))) &&
         (!tracer || vl_receipt_put(object, "own_tracer", json_string(tracer))) &&
         (!(render->noise > 0) || put_adaptive(object, &defs));
}

bool vl_receipt_put_settings(json_t *tree, const vlReceiptDef *def) {
  const vlSceneDefs *defs = def->defs;
  return put_def(tree, "load", VL_SETTING_LOAD, "", def->load) &&
         put_def(tree, "completed", VL_SETTING_COMPLETE, "", def->complete) &&
         put_film(tree, defs) && put_build(tree, defs) && put_render(tree, *defs) &&
         put_def(tree, "develop", VL_SETTING_RENDER, "develop.", defs) &&
         vl_receipt_put(tree, "samples", json_integer(def->samples));
}
