/* import/pbrt/upgrade/params.c: parameters: finding them, their values, the rows that rename
 * them. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/text.h"
#include "import/pbrt/decimal.h"
#include "import/pbrt/upgrade/upgrade.h"

vlOldParam *vl_old_find(vlOldStatement *s, const char *name) {
  for (size_t i = s->params.count; i > 0; i--) {
    vlOldParam *p = &s->params.items[i - 1];
    if (!p->dropped && vl_text_is(p->name, name))
      return p;
  }
  return NULL;
}

void vl_old_drop(vlOldStatement *s, vlOldParam *p) {
  if (!p || p->dropped)
    return;
  p->dropped = true;
  vl_old_note(s, "without %s", p->name);
}

void vl_old_drop_all(vlOldStatement *s, const char *const *names, size_t count) {
  for (size_t i = 0; i < count; i++)
    vl_old_drop(s, vl_old_find(s, names[i]));
}

bool vl_old_drop_loses(vlOldStatement *s, const char *name, double neutral) {
  vlOldParam *p = vl_old_find(s, name);
  double value;
  vl_old_drop(s, p);
  return p && !(vl_old_is_grey(p, &value) && value == neutral);
}

bool vl_old_is_texture(const vlOldParam *p) {
  return vl_text_is(p->type, "texture") && p->count > 0;
}

bool vl_old_is_color(const vlOldParam *p, double rgb[3]) {
  if (!p || p->strings || vl_text_is(p->new_type, "blackbody") ||
      vl_text_is(p->new_type, "spectrum"))
    return false;
  if (p->count != 1 && p->count != 3)
    return false;
  for (int i = 0; i < 3; i++)
    rgb[i] = p->number[p->count == 3 ? i : 0];
  return true;
}

bool vl_old_is_grey(const vlOldParam *p, double *value) {
  double rgb[3];
  if (!vl_old_is_color(p, rgb) || rgb[0] != rgb[1] || rgb[1] != rgb[2])
    return false;
  *value = rgb[0];
  return true;
}

bool vl_old_is_black(vlOldStatement *s, const char *name) {
  double value;
  const vlOldParam *p = vl_old_find(s, name);
  return p && vl_old_is_grey(p, &value) && value == 0;
}

double vl_old_number(vlOldStatement *s, const char *name, double otherwise) {
  const vlOldParam *p = vl_old_find(s, name);
  return p && p->count && !p->strings ? p->number[0] : otherwise;
}

double *vl_old_all_numbers(const vlOldStatement *s, const vlOldParam *p, size_t *found) {
  const char *at = s->file->text + p->value.start, *end = s->file->text + p->value.end;
  double *numbers = vl_alloc_array(s->u->context, p->count, sizeof *numbers);
  if (!numbers)
    vl_old_fail_memory(s->u);
  *found = 0;
  while (numbers && at < end && *found < p->count) {
    if (*at == '#')
      at += strcspn(at, "\n");
    if (at < end && !vl_number_scan(&at, end, &numbers[*found]))
      at++;
    else
      ++*found;
  }
  return numbers;
}

const char *vl_old_text(double value, char text[32]) {
  for (int digits = 1; digits <= 9; digits++) {
    snprintf(text, 32, "%.*g", digits, value);
    bool plain = !strchr(text, 'e') || !(fabs(value) >= 1e-4 && fabs(value) < 1e7);
    if (plain && (float)strtod(text, NULL) == (float)value)
      break;
  }
  return text;
}

const char *vl_old_rgb_text(const double rgb[3], char text[VL_OLD_VALUE]) {
  char n[3][32];
  for (int i = 0; i < 3; i++)
    vl_old_text(rgb[i], n[i]);
  snprintf(text, VL_OLD_VALUE, "[ %s %s %s ]", n[0], n[1], n[2]);
  return text;
}

void vl_old_value(vlOldParam *p, const char *format, ...) {
  VL_FORMAT(p->new_value, format);
}

void vl_old_set_color(vlOldParam *p, const double rgb[3]) {
  p->new_type = "rgb";
  vl_old_rgb_text(rgb, p->new_value);
  memcpy(p->number, rgb, 3 * sizeof *rgb);
  p->count = 3;
}

bool vl_old_clip(const vlOldStatement *s, const char *name, double rgb[3]) {
  const double max = fmax(rgb[0], fmax(rgb[1], rgb[2]));
  char text[32];
  if (!(max > 1))
    return false;
  vl_old_lose(s, "\"%s\" reflects %s of the light: 1 is taken", name, vl_old_text(max, text));
  for (int i = 0; i < 3; i++)
    rgb[i] = fmin(rgb[i], 1);
  return true;
}

void vl_old_keep_first(const vlOldStatement *s, vlOldParam *p) {
  const vlOldSpan first = p->span[0];
  vl_old_value(p, "%.*s", (int)(first.end - first.start), s->file->text + first.start);
}

/* ---- types ------------------------------------------------------------------------------- */

static const char *const types[][2] = {{"color", "rgb"},
                                       {"point", "point3"},
                                       {"vector", "vector3"},
                                       {"normal3", "normal"},
                                       {"point3f", "point3"}};

/* XYZ to linear sRGB (IEC 61966-2-1). */
static void set_rgb_of_xyz(vlOldParam *p) {
  static const double m[3][3] = {{3.240479, -1.537150, -0.498535},
                                 {-0.969256, 1.875991, 0.041556},
                                 {0.055648, -0.204043, 1.057311}};
  double rgb[3];
  for (int i = 0; i < 3; i++) {
    rgb[i] = m[i][0] * p->number[0] + m[i][1] * p->number[1] + m[i][2] * p->number[2];
    if (rgb[i] < 0)
      rgb[i] = 0;
  }
  memcpy(p->number, rgb, sizeof rgb);
  p->new_type = "rgb";
  vl_old_rgb_text(rgb, p->new_value);
}

static bool unquote_bools(vlOldStatement *s, vlOldParam *p) {
  for (size_t i = 0; i < p->count && i < VL_OLD_FIRST; i++) {
    if (!p->text[i])
      continue;
    bool on = vl_text_is(p->text[i], "true");
    if (!on && !vl_text_is(p->text[i], "false"))
      continue;
    if (!vl_old_edit(s, p->span[i], on ? "true" : "false"))
      return false;
    if (!i)
      vl_old_note(s, "bool %s without quotes", p->name);
  }
  return true;
}

/* pbrt-v3's blackbodies are pairs of temperature and factor; pbrt-v4's are temperatures. Lights
 * have a scale for the factor (lights.c). */
static void keep_temperature(vlOldStatement *s, vlOldParam *p) {
  const bool light = s->word->rule == vl_old_light || s->word->rule == vl_old_area_light;
  if (light || !vl_text_is(p->type, "blackbody") || p->count < 2)
    return;
  if (p->count > 2)
    vl_old_lose(s, "\"%s\" is a sum of blackbodies: the first is kept", p->name);
  if (p->number[1] != 1)
    vl_old_lose(s, "\"%s\": the factor of a blackbody has no counterpart: left out", p->name);
  vl_old_keep_first(s, p);
}

bool vl_old_types(vlOldStatement *s) {
  VL_EACH_ITEM(vlOldParam, p, &s->params) {
    for (size_t k = 0; k < VL_LENGTH(types); k++)
      if (vl_text_is(p->type, types[k][0]))
        p->new_type = types[k][1];
    if (vl_text_is(p->type, "xyz") && p->count == 3)
      set_rgb_of_xyz(p);
    keep_temperature(s, p);
    if (vl_text_is(p->type, "bool") && p->strings && !unquote_bools(s, p))
      return false;
    /* a spectrum of numbers is pairs of wavelength and value; a file's name is that of a file
     * or of a metal */
    if (!vl_text_is(p->type, "spectrum") || !p->strings || p->count < 1)
      continue;
    char name[4096];
    if (!strchr(p->text[0], '.') && !strchr(p->text[0], '/'))
      continue;
    if (!vl_old_file_name(s, p->text[0], name, sizeof name))
      return false;
    if (p->count > 1)
      vl_old_lose(s, "\"%s\" names several files: the first is kept", p->name);
    if (vl_text_is(name, p->text[0]) && p->count == 1)
      continue;
    vl_old_note(s, "%s is \"%s\"", p->name, name);
    if (!vl_old_edit(s, p->value, "\"%s\"", name))
      return false;
  }
  return true;
}

/* ---- rows -------------------------------------------------------------------------------- */

static bool is_open(const vlOldParam *p) {
  return !p->dropped && p->new_name == p->name;
}

static bool apply(vlOldStatement *s, const vlOldRow *row, bool *known) {
  bool found = false;
  for (size_t i = 0; i < s->params.count; i++) {
    vlOldParam *p = &s->params.items[i];
    bool same = vl_has_word(row->name, p->name);
    if (same && row->action != VL_OLD_DEFAULT)
      known[i] = true;
    found = found || same || vl_text_is(p->new_name, row->name);
    if (!same || !is_open(p))
      continue;
    switch (row->action) {
      case VL_OLD_KEEP:
      case VL_OLD_DEFAULT:
        break;
      case VL_OLD_RENAME:
        p->new_name = row->to;
        break;
      case VL_OLD_DROP:
        vl_old_drop(s, p);
        break;
      case VL_OLD_LOSE:
        p->dropped = true;
        vl_old_lose(s, "%s \"%s\": \"%s\" has no counterpart%s%s", s->directive,
                    s->name_count ? s->name[s->name_count - 1] : "", p->name,
                    row->to ? ": " : "", row->to ? row->to : "");
        break;
    }
  }
  if (row->action != VL_OLD_DEFAULT || found)
    return true;
  /* kinds that both pbrts have */
  bool shared = s->word->rule == vl_old_filter || s->word->rule == vl_old_light;
  if (shared && !s->u->is_old)
    return true;
  vl_old_note(s, "with %s", row->to);
  return vl_old_add(s, "%s", row->to);
}

bool vl_old_rows(vlOldStatement *s, const vlOldRow *rows) {
  enum { MAX_PARAMETERS = 64 };
  bool known[MAX_PARAMETERS] = {false};
  if (s->params.count > MAX_PARAMETERS)
    return vl_old_wrong(s, "too many parameters");
  for (const vlOldRow *row = rows; row && row->name; row++)
    if (!apply(s, row, known))
      return false;
  for (size_t i = 0; i < s->params.count; i++) {
    vlOldParam *p = &s->params.items[i];
    if (known[i] || !is_open(p) || vl_text_is(p->name, "type"))
      continue;
    p->dropped = true;
    vl_old_lose(s, "%s \"%s\": \"%s\" is not a parameter of pbrt-v4: left out", s->directive,
                s->name_count ? s->name[s->name_count - 1] : "", p->name);
  }
  return true;
}

const vlOldKind *vl_old_kind(const vlOldKind *kinds, const char *name) {
  for (const vlOldKind *k = kinds; k->from; k++)
    if (vl_text_is(k->from, name) || vl_has_word(k->from, name))
      return k;
  return NULL;
}

bool vl_old_become(vlOldStatement *s, const vlOldKind *kind) {
  if (kind->lost)
    vl_old_lose(s, "%s", kind->lost);
  return (!kind->rule || kind->rule(s)) && vl_old_rows(s, kind->rows) &&
         vl_old_rename(s, 0, kind->to);
}
