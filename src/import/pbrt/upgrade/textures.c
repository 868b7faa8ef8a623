/* import/pbrt/upgrade/textures.c: Texture. */
#include <stdio.h>

#include "base/context.h"
#include "base/text.h"
#include "import/pbrt/upgrade/upgrade.h"

static vlOldTexture *find_texture(vlUpgrade *u, const char *name) {
  for (size_t i = u->textures.count; i > 0; i--)
    if (vl_text_is(u->textures.items[i - 1].name, name))
      return &u->textures.items[i - 1];
  return NULL;
}

/* Whether the colour texture of this name is a mix that noise_rule has written. */
static bool is_noise(vlUpgrade *u, const char *name) {
  const vlOldTexture *t = find_texture(u, name);
  return t && t->grey;
}

#define MAPPING \
  { "mapping uscale vscale udelta vdelta v1 v2" }

static const vlOldRow constant[] = {{"value"}, {0}};
static const vlOldRow scale[] = {{"tex scale"}, {0}};
static const vlOldRow mix[] = {{"tex1 tex2 amount"}, {0}};
static const vlOldRow bilerp[] = {{"v00 v01 v10 v11"}, MAPPING, {0}};
static const vlOldRow imagemap[] = {
    {"filename wrap maxanisotropy scale invert encoding filter"}, MAPPING, {0}};
static const vlOldRow uv[] = {MAPPING, {0}};
static const vlOldRow checkerboard[] = {
    {"dimension tex1 tex2"}, {"aamode", VL_OLD_DROP}, MAPPING, {0}};
static const vlOldRow dots[] = {{"inside outside"}, MAPPING, {0}};
static const vlOldRow noise[] = {{"octaves roughness"}, {0}};
static const vlOldRow marble[] = {{"octaves roughness scale variation"}, {0}};
static const vlOldRow ptex[] = {{"filename encoding scale"}, {0}};

static bool is_spectrum(const vlOldStatement *s) {
  return !vl_text_is(s->name[1], "float");
}

/* ---- scale ------------------------------------------------------------------------------- */

/* Whether the input is a constant of one number, *value; an input that is not given is 1. */
static bool one_number(const vlOldParam *p, double *value) {
  *value = 1;
  return !p || vl_old_is_grey(p, value);
}

/* Makes the parameter the float `scale`; of a grey colour the first of its three numbers. */
static void set_scale(const vlOldStatement *s, vlOldParam *p) {
  p->new_name = "scale";
  p->new_type = "float";
  if (p->count != 3)
    return;
  vl_old_keep_first(s, p);
}

/* pbrt-v3 multiplies two textures of one type, pbrt-v4 a texture by numbers. */
static bool scale_rule(vlOldStatement *s) {
  vlOldParam *a = vl_old_find(s, "tex1"), *b = vl_old_find(s, "tex2");
  double value, rgb[3];
  char text[32];
  if (!a && !b)
    return true; /* pbrt-v4's already, or 1 */
  if (!is_spectrum(s)) {
    if (a)
      a->new_name = "tex";
    if (b)
      b->new_name = "scale";
    return true;
  }
  if (!one_number(b, &value) && one_number(a, &value)) {
    vlOldParam *t = a;
    a = b;
    b = t;
  }
  if (b && one_number(b, &value)) {
    set_scale(s, b);
  } else if (b && vl_old_is_texture(b)) {
    if (a && vl_old_is_texture(a) && is_noise(s->u, a->text[0])) {
      vlOldParam *t = a;
      a = b;
      b = t;
    }
    const char *copy = vl_old_float_copy(s, b->text[0]);
    if (s->u->result != VL_OK)
      return false;
    if (copy) {
      if (!is_noise(s->u, b->text[0]))
        vl_old_lose(s,
                    "a product of two colour textures has no counterpart: \"%s\" becomes one "
                    "of numbers",
                    b->text[0]);
      b->new_name = "scale";
      vl_old_value(b, "\"%.150s\"", copy);
    } else {
      vl_old_lose(s, "a product of two colour textures has no counterpart: \"%s\" is left out",
                  b->text[0]);
      b->dropped = true;
    }
  } else if (b && vl_old_is_color(b, rgb)) {
    vl_old_lose(s, "a texture times a colour has no counterpart: the colour's mean is taken");
    set_scale(s, b);
    vl_old_value(b, "%s", vl_old_text((rgb[0] + rgb[1] + rgb[2]) / 3, text));
  } else if (b) {
    vl_old_lose(s, "a texture times a spectrum has no counterpart: the texture alone is taken");
    b->dropped = true;
  }
  if (a)
    a->new_name = "tex";
  return true;
}

/* ---- mappings ---------------------------------------------------------------------------- */

static bool maps(const vlOldRow *rows) {
  for (; rows && rows->name; rows++)
    if (vl_has_word(rows->name, "mapping"))
      return true;
  return false;
}

/* pbrt-v3 ignores the numbers of other mappings; in pbrt-v4 they are errors. */
static void drop_unused(vlOldStatement *s) {
  static const struct {
    const char *mapping, *names;
  } unused[] = {{"uv", "v1 v2"},
                {"spherical", "uscale vscale udelta vdelta v1 v2"},
                {"cylindrical", "uscale vscale udelta vdelta v1 v2"},
                {"planar", "uscale vscale"},
                {"solid", "mapping uscale vscale udelta vdelta v1 v2"}};
  const vlOldParam *given = vl_old_find(s, "mapping");
  const char *mapping = given && given->text[0] ? given->text[0] : "uv";
  if (vl_text_is(s->name[2], "checkerboard") && vl_old_number(s, "dimension", 2) == 3)
    mapping = "solid";
  for (size_t k = 0; k < VL_LENGTH(unused); k++)
    for (size_t i = 0; vl_text_is(mapping, unused[k].mapping) && i < s->params.count; i++)
      if (vl_has_word(unused[k].names, s->params.items[i].name))
        vl_old_drop(s, &s->params.items[i]);
}

/* ---- others ------------------------------------------------------------------------------ */

/* The value of a bool, which old files have as a word or in quotation marks. */
static bool is_true(const vlOldStatement *s, const vlOldParam *p) {
  return p->text[0] ? vl_text_is(p->text[0], "true") : s->file->text[p->span[0].start] == 't';
}

/* A flag of the filter becomes the filter's name; gamma, a number or a flag for sRGB, an
 * encoding. */
static bool image_rule(vlOldStatement *s) {
  vlOldParam *trilinear = vl_old_find(s, "trilinear"), *gamma = vl_old_find(s, "gamma"),
             *name = vl_old_find(s, "filename");
  if (trilinear) {
    bool on = is_true(s, trilinear);
    vl_old_drop(s, trilinear);
    if (on && !vl_old_add(s, "\"string filter\" \"trilinear\""))
      return false;
  }
  if (gamma && vl_text_is(gamma->type, "bool")) {
    bool on = is_true(s, gamma);
    vl_old_drop(s, gamma);
    if (!vl_old_add(s, "\"string encoding\" \"%s\"", on ? "sRGB" : "linear"))
      return false;
  } else if (gamma) {
    char text[32];
    vl_old_drop(s, gamma);
    if (!(gamma->number[0] == 1 ? vl_old_add(s, "\"string encoding\" \"linear\"")
                                : vl_old_add(s, "\"string encoding\" \"gamma %s\"",
                                             vl_old_text(gamma->number[0], text))))
      return false;
  }
  return vl_old_write_file_name(s, name);
}

/* pbrt-v3 accepts some colour textures as textures of numbers, but makes none of them. */
static bool lose_numbers(vlOldStatement *s) {
  vl_old_lose(s, "%s of numbers has no counterpart: the constant 1 replaces it", s->name[2]);
  for (size_t i = 0; i < s->params.count; i++)
    vl_old_drop(s, &s->params.items[i]);
  return vl_old_edit(s, s->names[2], "\"constant\"");
}

/* Red is u, green v: the corners of a bilinear interpolation. */
static bool uv_rule(vlOldStatement *s) {
  return vl_old_add(s,
                    "\"rgb v00\" [ 0 0 0 ] \"rgb v01\" [ 0 1 0 ] \"rgb v10\" [ 1 0 0 ] "
                    "\"rgb v11\" [ 1 1 0 ]");
}

/* Notes that the colour texture `name` is a mix by the float texture `copy`. */
static bool keep_noise(vlUpgrade *u, const char *name, const char *copy) {
  vlOldTexture *t = VL_PUSH(u->context, &u->textures);
  if (!t)
    return vl_old_fail_memory(u);
  *t = (vlOldTexture){
      .name = vl_strdup(u->context, name), .copy = vl_strdup(u->context, copy), .grey = true};
  return (t->name && t->copy) || vl_old_fail_memory(u);
}

/* pbrt-v4's noise is of numbers: a mix of black and white by it is the colour texture. */
static bool noise_rule(vlOldStatement *s) {
  if (!is_spectrum(s))
    return true;
  char name[300];
  snprintf(name, sizeof name, "%.200s-float", s->name[0]);
  vl_old_note(s, "a mix by the float texture \"%s\"", name);
  if (!keep_noise(s->u, s->name[0], name))
    return false;
  s->name[1] = "float";
  s->renamed = 0; /* its name is written here */
  return vl_old_edit(s, s->names[0], "\"%s\"", name) &&
         vl_old_edit(s, s->names[1], "\"float\"") &&
         vl_old_insert(s, VL_OLD_AFTER,
                       "Texture \"%s\" \"spectrum\" \"mix\" \"rgb tex1\" [ 0 0 0 ] "
                       "\"rgb tex2\" [ 1 1 1 ] \"texture amount\" \"%s\"",
                       s->name[0], name);
}

/* The share of a mix is a number in both; as a texture it is a float texture in both. */
static const vlOldKind kinds[] = {
    {"constant", NULL, constant},
    {"scale", NULL, scale, scale_rule},
    {"mix", NULL, mix},
    {"bilerp", NULL, bilerp},
    {"imagemap", NULL, imagemap, image_rule},
    {"uv", "bilerp", uv, uv_rule},
    {"checkerboard", NULL, checkerboard},
    {"dots", NULL, dots},
    {"fbm wrinkled", NULL, noise, noise_rule},
    {"windy", NULL, NULL, noise_rule},
    {"marble", NULL, marble},
    {"ptex", NULL, ptex, image_rule, "velo does not read Ptex files: bake it into an image"},
    {0}};

/* ---- float copies ------------------------------------------------------------------------ */

const char *vl_old_float_copy(vlOldStatement *s, const char *texture) {
  vlUpgrade *u = s->u;
  vlOldTexture *t = find_texture(u, texture);
  if (!t)
    return NULL;
  if (t->copy)
    return t->copy;
  char name[300];
  snprintf(name, sizeof name, "%.200s-float", texture);
  t->copy = vl_strdup(u->context, name);
  if (!t->copy) {
    vl_old_fail_memory(u);
    return NULL;
  }
  return vl_old_insert(s, VL_OLD_BEFORE, "Texture \"%s\" \"float\" %s", name, t->text) ? t->copy
                                                                                       : NULL;
}

/* Keeps what follows name and type of an image texture in the new text. */
static bool keep(const vlOldStatement *s) {
  vlUpgrade *u = s->u;
  if (!vl_text_is(s->name[2], "imagemap") || !is_spectrum(s))
    return true;
  char *text = vl_old_render(s->file, (vlOldSpan){s->names[2].start, s->whole.end});
  vlOldTexture *t = text ? VL_PUSH(u->context, &u->textures) : NULL;
  if (!t) {
    vl_free(u->context, text);
    return vl_old_fail_memory(u);
  }
  *t = (vlOldTexture){.name = vl_strdup(u->context, s->name[0]), .text = text};
  return t->name || vl_old_fail_memory(u);
}

bool vl_old_texture(vlOldStatement *s) {
  const vlOldKind *kind = vl_old_kind(kinds, s->name[2]);
  if (!is_spectrum(s) && vl_has_word("uv marble", s->name[2]))
    return lose_numbers(s);
  if (kind && kind->lost)
    vl_old_lose(s, "%s", kind->lost);
  if (kind && maps(kind->rows))
    drop_unused(s);
  if (kind && kind->rule && !kind->rule(s))
    return false;
  if (vl_text_is(s->name[1], "color") && !vl_old_rename(s, 1, "spectrum"))
    return false;
  return !kind || (vl_old_rows(s, kind->rows) && vl_old_rename(s, 2, kind->to) &&
                   vl_old_finish(s) && keep(s));
}
