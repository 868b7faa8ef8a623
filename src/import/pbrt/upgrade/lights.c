/* import/pbrt/upgrade/lights.c: LightSource and AreaLightSource. */
#include <stdio.h>

#include "base/context.h"
#include "base/free.h"
#include "base/text.h"
#include "color/color.h"
#include "import/pbrt/upgrade/upgrade.h"

#define POSE \
  { "from to" }
#define COMMON \
  { "scale power" }
#define SAMPLES               \
  {"samples", VL_OLD_DROP}, { \
    "nsamples", VL_OLD_DROP   \
  }

static const vlOldRow point[] = {{"I"}, POSE, COMMON, {0}};
static const vlOldRow spot[] = {{"I coneangle conedeltaangle"}, POSE, COMMON, {0}};
static const vlOldRow goniometric[] = {
    {"I"}, {"mapname", VL_OLD_RENAME, "filename"}, {"filename"}, COMMON, {0}};
static const vlOldRow projection[] = {{"mapname", VL_OLD_RENAME, "filename"},
                                      {"filename fov"},
                                      {"fov", VL_OLD_DEFAULT, "\"float fov\" 45"},
                                      COMMON,
                                      {0}};
static const vlOldRow distant[] = {{"L"}, POSE, COMMON, {"illuminance"}, {0}};
static const vlOldRow infinite[] = {{"L"},
                                    {"mapname", VL_OLD_RENAME, "filename"},
                                    {"filename portal illuminance"},
                                    SAMPLES,
                                    COMMON,
                                    {0}};
static const vlOldRow area[] = {{"L twosided"}, SAMPLES, COMMON, {0}};

/* ---- the factor -------------------------------------------------------------------------- */

/* The pairs of a sampled spectrum; the caller frees both arrays. */
static bool read_pairs(const vlOldStatement *s, const vlOldParam *p, float **wavelengths,
                       float **values) {
  vlContext *context = s->u->context;
  size_t found;
  double *numbers = vl_old_all_numbers(s, p, &found);
  if (!numbers)
    return false;
  *wavelengths = vl_alloc_zero(context, p->count, sizeof **wavelengths);
  *values = vl_alloc_zero(context, p->count, sizeof **values);
  const bool fine = *wavelengths && *values;
  for (size_t i = 0; fine && i < found; i++)
    (i % 2 ? *values : *wavelengths)[i / 2] = (float)numbers[i];
  vl_free(context, numbers);
  return fine || vl_old_fail_memory(s->u);
}

/* pbrt-v4 divides a light's spectrum by its luminance, pbrt-v3 does not. 1 for colours. */
static bool luminance(const vlOldStatement *s, const vlOldParam *p, double *factor) {
  vlSpectrum one = vl_spectrum_constant(1.0f), spectrum = one;
  float *wavelengths = NULL, *values = NULL;
  bool fine = true, sampled = p && vl_text_is(p->type, "spectrum");
  vlError error;
  *factor = 1;
  if (sampled && p->strings)
    vl_old_lose(s,
                "pbrt-v4 divides the spectrum of \"%s\" by its luminance: give the brightness "
                "by \"scale\"",
                p->name);
  if (p && vl_text_is(p->type, "blackbody") && p->count && p->number[0] > 0) {
    spectrum = vl_spectrum_blackbody((float)p->number[0]);
  } else if (sampled && !p->strings && p->count && p->count % 2 == 0) {
    fine = read_pairs(s, p, &wavelengths, &values);
    spectrum.kind = VL_SPECTRUM_SAMPLED;
    spectrum.wavelengths = wavelengths;
    spectrum.values = values;
    spectrum.count = (uint32_t)(p->count / 2);
  } else {
    return true;
  }
  double y = fine ? vl_spectrum_photometric(&spectrum, &error) : 0,
         unit = vl_spectrum_photometric(&one, &error);
  if (y > 0 && unit > 0)
    *factor = y / unit;
  VL_FREE(s->u->context, wavelengths, values);
  return fine;
}

/* Makes one number of all factors: "scale", which was a colour, and `more`. tint receives what
 * is not grey. */
static bool fold_scale(vlOldStatement *s, vlOldParam *color, double more, double tint[3]) {
  vlOldParam *scale = vl_old_find(s, "scale");
  double value = 1, rgb[3] = {1, 1, 1}, own[3];
  char text[32];
  for (int i = 0; i < 3; i++)
    tint[i] = 1;
  if (scale && !vl_old_is_grey(scale, &value)) {
    value = 1;
    if (!vl_old_is_color(scale, rgb)) {
      vl_old_lose(s, "\"scale\": a spectrum has no counterpart: 1 is taken");
    } else if (color && vl_old_is_color(color, own)) {
      for (int i = 0; i < 3; i++)
        own[i] *= rgb[i];
      vl_old_set_color(color, own);
      vl_old_note(s, "%s times scale", color->name);
    } else {
      memcpy(tint, rgb, sizeof rgb);
    }
  }
  if (scale && value * more == value && vl_text_is(scale->new_type, "float"))
    return true;
  value *= more;
  bool needed = (float)value != 1.0f;
  if (scale && needed && scale->count == 3 && more == 1) { /* the number as it is written */
    scale->new_type = "float";
    vl_old_keep_first(s, scale);
    return true;
  }
  if (scale)
    scale->dropped = true;
  if (!needed)
    return true;
  vl_old_note(s, "scale %s", vl_old_text(value, text));
  return vl_old_add(s, "\"float scale\" %s", vl_old_text(value, text));
}

/* pbrt-v3's blackbody has a factor as its second number. */
static double blackbody_scale(const vlOldStatement *s, vlOldParam *p) {
  if (!p || !vl_text_is(p->type, "blackbody") || p->count != 2)
    return 1;
  vl_old_keep_first(s, p);
  return p->number[1];
}

/* ---- images ------------------------------------------------------------------------------ */

/* Names the equal-area map that the image becomes. */
static bool name_map(vlOldStatement *s, const vlOldParam *map, const double factor[3]) {
  char name[4096];
  return vl_old_environment(s, map->text[0], factor, name, sizeof name) &&
         vl_old_put_name(s, map, name, "an equal-area map");
}

static bool is_grey(const double rgb[3]) {
  return rgb[0] == rgb[1] && rgb[1] == rgb[2];
}

/* Its colour stays beside the image, which has numbers. */
static bool goniometric_light(vlOldStatement *s, const vlOldParam *map) {
  vlOldParam *color = vl_old_find(s, "I");
  const double one[3] = {1, 1, 1};
  double more = blackbody_scale(s, color), factor, tint[3];
  if (!luminance(s, color, &factor) || !fold_scale(s, color, more * factor, tint))
    return false;
  if (!is_grey(tint))
    vl_old_lose(s, "goniometric: a colour \"scale\" has no counterpart: left out");
  return name_map(s, map, one);
}

/* color: null: none. */
static bool image_light(vlOldStatement *s, const vlOldParam *map, vlOldParam *color) {
  bool around = !vl_text_is(s->name[0], "projection");
  double more = 1, tint[3], rgb[3] = {1, 1, 1};
  if (vl_text_is(s->name[0], "goniometric"))
    return goniometric_light(s, map);
  if (color && !vl_old_is_color(color, rgb)) {
    vl_old_lose(s, "\"%s\" is a spectrum beside an image: left out", color->name);
  } else if (color && vl_old_is_grey(color, &more)) {
    for (int i = 0; i < 3; i++)
      rgb[i] = 1;
    if (more != 1)
      vl_old_note(s, "%s in scale", color->name);
  } else if (color && around) {
    vl_old_note(s, "%s in the image", color->name);
  } else if (color) {
    vl_old_lose(s, "projection: a colour \"I\" has no counterpart: left out");
  }
  if (color)
    color->dropped = true;
  if (!fold_scale(s, NULL, more, tint))
    return false;
  for (int i = 0; i < 3; i++)
    tint[i] *= rgb[i];
  if (!around && !is_grey(tint))
    vl_old_lose(s, "projection: a colour \"scale\" has no counterpart: left out");
  return around ? name_map(s, map, tint) : vl_old_write_file_name(s, map);
}

static bool plain_light(vlOldStatement *s) {
  vlOldParam *map = vl_old_find(s, "mapname"), *color = vl_old_find(s, "L");
  double more, factor, tint[3];
  if (!color)
    color = vl_old_find(s, "I");
  if (map && map->strings && map->text[0][0])
    return image_light(s, map, color);
  if (map)
    map->dropped = true;
  more = blackbody_scale(s, color);
  if (!luminance(s, color, &factor) || !fold_scale(s, color, more * factor, tint))
    return false;
  if (is_grey(tint))
    return true;
  if (!color) {
    char text[VL_OLD_VALUE];
    bool intensity = vl_has_word("point spot", s->name[0]);
    return vl_old_add(s, "\"rgb %s\" %s", intensity ? "I" : "L", vl_old_rgb_text(tint, text));
  }
  vl_old_lose(s, "a colour \"scale\" of a spectrum has no counterpart: left out");
  return true;
}

static const vlOldKind kinds[] = {{"point", NULL, point},
                                  {"spot", NULL, spot},
                                  {"goniometric", NULL, goniometric},
                                  {"projection", NULL, projection},
                                  {"distant", NULL, distant},
                                  {"infinite exinfinite", "infinite", infinite},
                                  {0}};

static bool names_image(vlOldStatement *s) {
  const vlOldParam *map = vl_old_find(s, "mapname");
  if (!map)
    map = vl_old_find(s, "filename");
  return map && map->strings && map->text[0][0];
}

/* A goniometric light without an image is a point light. */
bool vl_old_light(vlOldStatement *s) {
  const vlOldKind *kind = vl_old_kind(kinds, s->name[0]);
  if (!kind) {
    vl_old_lose(s, "light \"%s\" has no counterpart: left out", s->name[0]);
    return vl_old_remove(s);
  }
  if (kind->rows == goniometric && !names_image(s))
    return vl_old_rename(s, 0, "point") && vl_old_light(s);
  if (kind->rows == projection && !names_image(s)) {
    vl_old_lose(s, "a projection without an image has no counterpart: left out");
    return vl_old_remove(s);
  }
  return plain_light(s) && vl_old_become(s, kind);
}

bool vl_old_area_light(vlOldStatement *s) {
  bool diffuse = vl_text_is(s->name[0], "diffuse") || vl_text_is(s->name[0], "area");
  if (!s->name[0][0])
    return true;
  if (!diffuse) {
    vl_old_lose(s, "area light \"%s\" has no counterpart: left out", s->name[0]);
    return vl_old_remove(s);
  }
  return plain_light(s) && vl_old_rows(s, area) && vl_old_rename(s, 0, "diffuse");
}
