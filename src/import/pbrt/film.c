/* import/pbrt/film.c: Film, Option and media. */
#include <math.h>
#include <stdio.h>

#include "base/text.h"
#include "import/pbrt/builder.h"
#include "import/pbrt/decimal.h"
#include "velo/render.h"

static double clamped(double value, double high) {
  if (value < 0)
    return 0;
  return value > high ? high : value;
}

/* Reads the crop window. pbrt's "pixelbounds" are x0 x1 y0 y1 in pixels. "cropwindow" gives the
 * same as fractions of the image size, which are rounded up; it takes precedence. */
static bool read_crop(vlDict *dict, vlSceneDefs *s) {
  vlImport *import = dict->import;
  double w = s->film.width, h = s->film.height;
  double box[4] = {0, w, 0, h}; /* x0 x1 y0 y1, pixels */
  double crop[4];
  vlParam *pixels = vl_dict_find_counted(dict, "pixelbounds", VL_BIT_INTEGER, 4);
  vlSource source = dict->source;
  if (!vl_import_fine(import))
    return false;
  if (pixels) {
    source = pixels->source;
    for (int i = 0; i < 4; i++) {
      const double bound = pixels->integers.items[i];
      box[i] = clamped(bound, i < 2 ? w : h);
    }
  }
  if (vl_dict_floats(dict, "cropwindow", 4, crop)) {
    for (int i = 0; i < 4; i += 2) {
      const bool ascending = crop[i] < crop[i + 1];
      const double low = clamped(ascending ? crop[i] : crop[i + 1], 1);
      const double high = clamped(ascending ? crop[i + 1] : crop[i], 1);
      const float size = (float)(i ? h : w);
      /* single precision, as in pbrt, so that the result is the same pixels */
      box[i] = ceilf(size * (float)low);
      box[i + 1] = ceilf(size * (float)high);
    }
  }
  if (!(box[0] < box[1] && box[2] < box[3]))
    return vl_dict_fail_at(dict, source, "the crop window holds no pixel");
  s->film.crop[0] = (uint32_t)box[0];
  s->film.crop[2] = (uint32_t)box[1];
  s->film.crop[1] = (uint32_t)box[2];
  s->film.crop[3] = (uint32_t)box[3];
  return vl_import_fine(import);
}

/* Reads the name of the sensor. The default white of a measured sensor is daylight of 6500 K.
 * When permissive, the standard observer with the same white replaces an unknown sensor. */
static bool read_sensor_name(vlDict *dict, double *white) {
  enum { MAX_SENSORS = 64 };
  const char *names[MAX_SENSORS], *plain = vl_sensor_name(0), *name = plain;
  uint32_t count = 0;
  vlImport *import = dict->import;
  while (count < MAX_SENSORS && vl_sensor_name(count)) {
    names[count] = vl_sensor_name(count);
    count++;
  }
  vlParam *p = vl_dict_find(dict, "sensor", VL_BIT_STRING);
  if (!vl_dict_string(dict, "sensor", &name) || vl_text_is(name, plain))
    return true;
  *white = 6500.0;
  const size_t found = vl_name_index(name, names, count);
  if (found == count)
    return vl_import_unknown(import, p->source, "sensor", name, names, count);
  vl_scene_defs(import->scene)->film.sensor = names[found];
  return true;
}

/* Reads the sensor, its white balance and its largest component value. */
static bool read_sensor(vlDict *dict) {
  vlImport *import = dict->import;
  double white = 0.0, usual = 0.0, top = INFINITY;
  if (!read_sensor_name(dict, &usual))
    return false;
  if (vl_dict_double(dict, "whitebalance", &white) && white != 0.0 &&
      !(white >= 1000.0 && white <= 1e5))
    return vl_dict_fail_at(
        dict, vl_dict_find(dict, "whitebalance", VL_BIT_FLOAT)->source,
        "\"whitebalance\" is %g; it must be 0 (none) or 1000 to 100000 kelvin", white);
  vl_scene_defs(import->scene)->film.white_balance = white != 0.0 ? white : usual;
  if (vl_dict_double(dict, "maxcomponentvalue", &top) && !(top >= 0.0))
    return vl_dict_fail(dict, "\"maxcomponentvalue\" must not be negative");
  vl_scene_defs(import->scene)->film.max_component = top < 1e30 ? (float)top : INFINITY;
  return vl_import_fine(import);
}

/* Reads the parameters that the rows do not describe: the file name, the factors of the
 * exposure, the crop window, the sensor. */
static bool read_rest(vlDict *dict, vlSceneDefs *s) {
  vlImport *import = dict->import;
  double iso = 100.0, time = 1.0, ratio = 1.0;
  bool half = true;
  const char *output = "";
  vlParam *file = vl_dict_find(dict, "filename", VL_BIT_STRING);
  vl_dict_string(dict, "filename", &output);
  import->film_diagonal = 35.0;
  vl_dict_double(dict, "diagonal", &import->film_diagonal); /* used by realistic cameras only */
  /* ignored: the program decides how the file is written */
  vl_dict_bool(dict, "savefp16", &half);
  vl_dict_double(dict, "iso", &iso);
  vl_dict_double(dict, "exposuretime", &time);
  vl_dict_double(dict, "imagingratio", &ratio);
  if (!vl_import_fine(import))
    return false;
  if (strlen(output) >= sizeof s->output)
    return vl_dict_fail_at(dict, file->source, "the file name is too long");
  snprintf(s->output, sizeof s->output, "%s", output);
  s->develop.exposure = (float)(iso / 100.0 * time * ratio);
  if (!(s->develop.exposure >= 0.0f) || !isfinite(s->develop.exposure))
    return vl_dict_fail(dict, "the exposure is negative or not finite");
  return read_crop(dict, s) && read_sensor(dict);
}

static bool read_gbuffer(vlDict *dict, vlSceneDefs *s) {
  int number = 0;
  vl_dict_row_choice(dict, "coordinatesystem", &number);
  s->gbuffer = number ? VL_GBUFFER_WORLD : VL_GBUFFER_CAMERA;
  return true;
}

static bool check_wavelengths(vlDict *dict, vlSceneDefs *s) {
  if (!s->film.buckets || s->film.lambda_min < s->film.lambda_max)
    return true;
  return vl_dict_fail(dict, "\"lambdamin\" is %g, it must be below \"lambdamax\", %g",
                      s->film.lambda_min, s->film.lambda_max);
}

/* Functions, by kind, for what the rows do not describe; null: none. */
static bool (*const rules[0 VL_FILM_KINDS(VL_COUNT_KIND)])(vlDict *dict, vlSceneDefs *s) = {
    [VL_FILM_GBUFFER] = read_gbuffer,
};

bool vl_import_film(vlImport *import) {
  vlSceneDefs *s = vl_scene_defs(import->scene);
  const vlChoice *choice = &import->film;
  vlDict dict = vl_import_choice_dict(import, "Film", &vl_film_family, choice, "rgb");
  const bool known = dict.row;
  if (!known && !vl_import_unknown_kind(import, choice->source, &vl_film_family, choice->kind))
    return false;
  if (!known)
    vl_dict_set_kind(&dict, &vl_film_family, VL_FILM_RGB);
  vl_row_set_defaults(dict.row, s);
  s->film.space = choice->given ? choice->space : VL_SPACE_SRGB;
  if (!vl_import_parameters(&dict, s, false) || !read_rest(&dict, s))
    return false;
  if ((rules[dict.kind] && !rules[dict.kind](&dict, s)) || !check_wavelengths(&dict, s))
    return false;
  if (!known)
    vl_dict_skip(&dict);
  return vl_dict_done(&dict);
}

/* ---- options ----------------------------------------------------------------------------- */

/* pbrt compares option names without case, blanks, dashes and underscores. */
static void normalise(const char *name, char *result, size_t size) {
  size_t n = 0;
  for (; *name && n + 1 < size; name++)
    if (*name != '-' && *name != '_')
      result[n++] = *name >= 'A' && *name <= 'Z' ? (char)(*name - 'A' + 'a') : *name;
  result[n] = 0;
}

typedef struct Switch {
  const char *name;
  bool *value; /* null: the option changes the image and velo does not support it */
} Switch;

static bool read_switch(vlImport *import, const vlStatement *s, const Switch *row) {
  const char *value = s->names[1];
  const bool on = vl_text_is(value, "true");
  if (!on && !vl_text_is(value, "false"))
    return vl_import_wrong(import, s->source,
                           "Option \"%s\": expected true or false, found \"%s\"", row->name,
                           vl_short_text(value).text);
  if (row->value)
    *row->value = on;
  return row->value || !on ||
         vl_import_unsupported(import, s->source,
                               "Option \"%s\": velo cannot; its materials stay what they are",
                               row->name);
}

static bool read_seed(vlImport *import, const vlStatement *s) {
  const char *value = s->names[1];
  double seed;
  if (!vl_number_parse(value, strlen(value), &seed) || seed != floor(seed) ||
      fabs(seed) > 4294967295.0)
    return vl_import_wrong(import, s->source, "Option \"seed\": \"%s\" is not an integer",
                           vl_short_text(value).text);
  vl_scene_defs(import->scene)->render.seed = (uint32_t)(int64_t)seed;
  return true;
}

static bool read_edge_scale(vlImport *import, const vlStatement *s, const char *name) {
  const char *value = s->names[1];
  if (vl_number_parse(value, strlen(value), &import->edge_scale) && import->edge_scale > 0.0)
    return true;
  return vl_import_wrong(import, s->source, "Option \"%s\": \"%s\" is not a number above 0",
                         name, vl_short_text(value).text);
}

bool vl_import_option(vlImport *import, const vlStatement *s) {
  vlRenderDef *render = &vl_scene_defs(import->scene)->render;
  const Switch switches[] = {{"disablepixeljitter", &render->centred},
                             {"disabletexturefiltering", &render->sharp_textures},
                             {"disablewavelengthjitter", &render->same_wavelengths},
                             {"forcediffuse", NULL}};
  char name[64];
  normalise(s->names[0], name, sizeof name);
  if (vl_text_is(name, "seed"))
    return read_seed(import, s);
  if (vl_text_is(name, "displacementedgescale"))
    return read_edge_scale(import, s, name);
  for (size_t i = 0; i < VL_LENGTH(switches); i++)
    if (vl_text_is(name, switches[i].name))
      return read_switch(import, s, &switches[i]);
  static const char *const known[] = {"seed",
                                      "displacementedgescale",
                                      "disablepixeljitter",
                                      "disabletexturefiltering",
                                      "disablewavelengthjitter",
                                      "forcediffuse",
                                      "msereferenceimage",
                                      "msereferenceout",
                                      "pixelstats",
                                      "wavefront",
                                      "rendercoordsys"};
  if (VL_IS_AMONG(name, known))
    return true; /* it does not change the image */
  return vl_import_unknown(import, s->source, "option", s->names[0], known, VL_LENGTH(known));
}
