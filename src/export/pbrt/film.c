/* export/pbrt/film.c: writes the film of a scene by the row of its kind, and functions for
 * parameters that do not stand in the scene as they do in files. */
#include <math.h>

#include "base/text.h"
#include "export/pbrt/pbrt.h"

static vlFilmKind kind_of(const vlSceneDefs *defs) {
  return defs->gbuffer ? VL_FILM_GBUFFER : defs->film.buckets ? VL_FILM_SPECTRAL : VL_FILM_RGB;
}

const char *vl_pbrt_film_kind(const vlSceneDefs *defs) {
  return vl_kind_row(&vl_film_family, (int)kind_of(defs))->name;
}

/* ---- parameters -------------------------------------------------------------------------- */

static void put_number(vlExport *x, const vlParameter *p, double value) {
  const double k = p->factor != 0 ? 1 / p->factor : 1;
  if (p->type == VL_PARAMETER_COUNT)
    PUT(" \"integer %s\" [%.0f]", p->name, k * value);
  else
    PUT(" \"float %s\" [%.9g]", p->name, k * value);
}

static double number_of(const vlExport *x, const vlParameter *p) {
  double number = 0;
  vl_parameter_number(p, &x->scene->defs, &number);
  return number;
}

static void put_line(vlExport *x, const vlParameter *p, double value) {
  PUT(" ");
  put_number(x, p, value);
  PUT("\n");
}

/* A text that pbrt's language can hold. */
static void put_text(vlExport *x, const vlParameter *p, const char *text) {
  if (text && text[0] && !strpbrk(text, "\"\\\n"))
    PUT("  \"string %s\" \"%s\"\n", p->name, text);
}

typedef void Rule(vlExport *x, const vlParameter *p);

static void put_system(vlExport *x, const vlParameter *p) {
  if (x->scene->defs.gbuffer == VL_GBUFFER_WORLD)
    PUT("  \"string %s\" \"%s\"\n", p->name, p->choices[1]);
}

/* The number of buckets and their limits in one line, which is always written. */
static void put_buckets(vlExport *x, const vlParameter *p) {
  static const char *const limits[] = {"lambdamin", "lambdamax"};
  const vlKindRow *row = vl_kind_row(&vl_film_family, VL_FILM_SPECTRAL);
  PUT(" ");
  put_number(x, p, number_of(x, p));
  for (int i = 0; i < 2; i++) {
    const vlParameter *limit = vl_row_find(row, limits[i]);
    put_number(x, limit, number_of(x, limit));
  }
  PUT("\n");
}

/* All factors of the exposure in one. */
static void put_iso(vlExport *x, const vlParameter *p) {
  const vlSceneDefs *defs = &x->scene->defs;
  double exposure = (double)defs->develop.exposure * defs->camera.exposure_time / x->shutter;
  if (fabs(exposure - 1) > 1e-7)
    put_line(x, p, p->value[0] * exposure);
}

static void put_sensor(vlExport *x, const vlParameter *p) {
  put_text(x, p, x->scene->defs.film.sensor);
}

static void put_white_balance(vlExport *x, const vlParameter *p) {
  if (number_of(x, p) > 0)
    put_line(x, p, number_of(x, p));
}

/* pbrt clamps the sensor's output, velo's film its input. */
static void put_max_component(vlExport *x, const vlParameter *p) {
  const float exposure = x->scene->defs.develop.exposure;
  if (number_of(x, p) < 1e30)
    put_line(x, p, number_of(x, p) * (exposure > 0 ? (double)exposure : 1));
}

static void put_bounds(vlExport *x, const vlParameter *p) {
  const vlFilmDef *film = &x->scene->defs.film;
  const uint32_t *crop = film->crop;
  if (crop[0] || crop[1] || crop[2] != film->width || crop[3] != film->height)
    PUT("  \"integer %s\" [%u %u %u %u]\n", p->name, crop[0], crop[2], crop[1], crop[3]);
}

static void put_file_name(vlExport *x, const vlParameter *p) {
  put_text(x, p, x->scene->defs.output);
}

/* In the order of the file. Null: what another parameter or the camera's text says. Parameters
 * that are not here are written by their rows alone. */
static const struct {
  const char *name;
  Rule *put;
} rules[] = {
    {"coordinatesystem", put_system},
    {"nbuckets", put_buckets},
    {"iso", put_iso},
    {"sensor", put_sensor},
    {"whitebalance", put_white_balance},
    {"maxcomponentvalue", put_max_component},
    {"pixelbounds", put_bounds},
    {"filename", put_file_name},
    {"lambdamin", NULL},    /* nbuckets */
    {"lambdamax", NULL},    /* nbuckets */
    {"xresolution", NULL},  /* the camera's text */
    {"yresolution", NULL},  /* the camera's text */
    {"diagonal", NULL},     /* realistic cameras are not written */
    {"cropwindow", NULL},   /* pixelbounds */
    {"exposuretime", NULL}, /* iso */
    {"imagingratio", NULL}, /* iso */
    {"savefp16", NULL},     /* is ignored */
};
enum { RULES = VL_LENGTH(rules) };

static bool has_rule(const vlParameter *p) {
  for (size_t i = 0; i < RULES; i++)
    if (vl_text_is(rules[i].name, p->name))
      return true;
  return false;
}

void vl_pbrt_film(vlExport *x) {
  const vlSceneDefs *defs = &x->scene->defs;
  const vlKindRow *row = vl_kind_row(&vl_film_family, (int)kind_of(defs));
  for (size_t i = 0; i < RULES; i++) {
    const vlParameter *p = vl_row_find(row, rules[i].name);
    if (p && rules[i].put)
      rules[i].put(x, p);
  }
  VL_EACH_PARAMETER(p, row) {
    if (!p->name || has_rule(p) || vl_parameter_is_default(p, defs, false))
      continue;
    PUT(" ");
    vl_pbrt_parameter(x, p, defs);
    PUT("\n");
  }
}
