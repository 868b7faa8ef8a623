/* import/pbrt/upgrade/materials_more.c: materials whose parameters are computed: uber with
 * opacity, translucent, mix, disney. */
#include <stdio.h>

#include "base/text.h"
#include "import/pbrt/upgrade/upgrade.h"

/* Writes a share as a parameter "amount": a number, or a float texture. False after an
 * error. */
static bool amount_text(vlOldStatement *s, const vlOldParam *p, const char *what, char *text,
                        size_t size) {
  double rgb[3];
  char number[32];
  if (p && vl_old_is_texture(p)) {
    const char *copy = vl_old_float_copy(s, p->text[0]);
    if (s->u->result != VL_OK)
      return false;
    if (copy)
      return snprintf(text, size, "\"texture amount\" \"%s\"", copy) > 0;
    vl_old_lose(s, "%s: texture \"%s\" cannot become one of numbers: 0.5 is taken", what,
                p->text[0]);
  }
  double value = 0.5;
  if (p && vl_old_is_color(p, rgb))
    value = (rgb[0] + rgb[1] + rgb[2]) / 3;
  if (p && vl_old_is_color(p, rgb) && !vl_old_is_grey(p, &value))
    vl_old_lose(s, "%s: a colour has no counterpart: its mean is taken", what);
  snprintf(text, size, "\"float amount\" %s", vl_old_text(value, number));
  return true;
}

/* ---- uber -------------------------------------------------------------------------------- */

/* The statement becomes a named material, and the material itself a mix of it with nothing. */
static bool mix_with_nothing(vlOldStatement *s, const vlOldParam *opacity) {
  char amount[600], solid[300];
  vlUpgrade *u = s->u;
  if (!amount_text(s, opacity, "opacity", amount, sizeof amount))
    return false;
  if (!u->see_through &&
      !vl_old_insert(s, VL_OLD_BEFORE,
                     "MakeNamedMaterial \"see-through\" \"string type\" \"interface\""))
    return false;
  u->see_through = true;
  if (vl_text_is(s->directive, "Material")) {
    snprintf(solid, sizeof solid, "solid-%u", ++u->made);
    vlOldSpan head = {s->keyword.start, s->names[0].end};
    if (!vl_old_edit(s, head, "MakeNamedMaterial \"%s\" \"string type\" \"coateddiffuse\"",
                     solid))
      return false;
    return vl_old_insert(s, VL_OLD_AFTER,
                         "Material \"mix\" \"string materials\" [ \"see-through\" \"%s\" ] %s",
                         solid, amount);
  }
  snprintf(solid, sizeof solid, "%.200s-solid", s->name[0]);
  s->renamed = 0; /* the name is written here */
  if (!vl_old_edit(s, s->names[0], "\"%s\"", solid))
    return false;
  return vl_old_insert(s, VL_OLD_AFTER,
                       "MakeNamedMaterial \"%s\" \"string type\" \"mix\" "
                       "\"string materials\" [ \"see-through\" \"%s\" ] %s",
                       s->name[0], solid, amount);
}

static void drop_black(vlOldStatement *s, const char *name) {
  if (vl_old_is_black(s, name))
    vl_old_drop(s, vl_old_find(s, name));
}

bool vl_old_uber(vlOldStatement *s) {
  vlOldParam *opacity = vl_old_find(s, "opacity");
  double value;
  drop_black(s, "Kr");
  drop_black(s, "Kt");
  const bool coat = !vl_old_is_black(s, "Ks");
  if (coat && !vl_old_find(s, "roughness") && !vl_old_find(s, "uroughness") &&
      !vl_old_find(s, "vroughness") && !vl_old_add(s, "\"float roughness\" 0.1"))
    return false;
  if (!coat) {
    static const char *const names[] = {
        "Ks", "roughness", "uroughness", "vroughness", "remaproughness", "index", "eta"};
    vl_old_drop_all(s, names, VL_LENGTH(names));
  }
  if (!opacity)
    return true;
  bool opaque = vl_old_is_grey(opacity, &value) && value == 1;
  vl_old_drop(s, opacity);
  return opaque || mix_with_nothing(s, opacity);
}

/* ---- translucent ------------------------------------------------------------------------- */

bool vl_old_translucent(vlOldStatement *s) {
  double kd[3] = {0.25, 0.25, 0.25}, share[2][3] = {{0.5, 0.5, 0.5}, {0.5, 0.5, 0.5}};
  static const char *const from[2] = {"reflect", "transmit"}, *const to[2] = {"reflectance",
                                                                              "transmittance"};
  vlOldParam *p = vl_old_find(s, "Kd");
  const char *texture = p && vl_old_is_texture(p) ? p->text[0] : NULL;
  if (p && !texture && !vl_old_is_color(p, kd))
    vl_old_lose(s, "translucent: a sampled \"Kd\" has no counterpart: 0.25 is taken");
  for (int k = 0; k < 2; k++) {
    vlOldParam *q = vl_old_find(s, from[k]);
    if (q && !vl_old_is_color(q, share[k]))
      vl_old_lose(s, "translucent: a \"%s\" that is no colour has no counterpart: 0.5 is taken",
                  from[k]);
  }
  bool same = memcmp(share[0], share[1], sizeof share[0]) == 0 && share[0][0] == share[0][1] &&
              share[0][1] == share[0][2];
  if (texture && same) {
    char scale[32];
    return vl_old_add(
        s, "\"texture reflectance\" \"%s\" \"texture transmittance\" \"%s\" \"float scale\" %s",
        texture, texture, vl_old_text(share[0][0], scale));
  }
  if (texture) {
    vl_old_lose(s,
                "translucent: a texture times \"reflect\" has no counterpart: the texture "
                "alone is taken where that is not black");
    for (int k = 0; k < 2; k++) {
      double sum = share[k][0] + share[k][1] + share[k][2];
      if (!(sum > 0 ? vl_old_add(s, "\"texture %s\" \"%s\"", to[k], texture)
                    : vl_old_add(s, "\"rgb %s\" [ 0 0 0 ]", to[k])))
        return false;
    }
    return true;
  }
  for (int k = 0; k < 2; k++) {
    char text[VL_OLD_VALUE];
    double product[3];
    for (int i = 0; i < 3; i++)
      product[i] = kd[i] * share[k][i];
    vl_old_clip(s, from[k], product);
    if (!vl_old_add(s, "\"rgb %s\" %s", to[k], vl_old_rgb_text(product, text)))
      return false;
  }
  return true;
}

/* ---- mix --------------------------------------------------------------------------------- */

/* pbrt-v3's amount weighs the first material, pbrt-v4's the second: the names change places. */
bool vl_old_mix(vlOldStatement *s) {
  vlOldParam *first = vl_old_find(s, "namedmaterial1"),
             *second = vl_old_find(s, "namedmaterial2"), *amount = vl_old_find(s, "amount");
  char text[600];
  if (!first && !second && vl_old_find(s, "materials"))
    return true; /* pbrt-v4's already */
  if (!first || !second || !first->strings || !second->strings)
    return vl_old_wrong(s, "mix: \"namedmaterial1\" or \"namedmaterial2\" is missing");
  double value;
  if (amount && !vl_old_is_grey(amount, &value)) {
    if (!amount_text(s, amount, "mix", text, sizeof text))
      return false;
    vl_old_drop(s, amount);
    if (!vl_old_add(s, "%s", text))
      return false;
  } else if (amount) {
    amount->new_type = "float";
    if (amount->count == 3)
      vl_old_keep_first(s, amount);
  }
  vl_old_note(s, "namedmaterial1, namedmaterial2 -> materials");
  second->dropped = true;
  first->new_name = "materials";
  vl_old_value(first, "[ \"%.80s\" \"%.80s\" ]", second->text[0], first->text[0]);
  return true;
}

/* ---- disney ------------------------------------------------------------------------------ */

static bool rename_if(vlOldStatement *s, const char *from, const char *to) {
  vlOldParam *p = vl_old_find(s, from);
  if (!p)
    return false;
  p->new_name = to;
  return true;
}

bool vl_old_disney(vlOldStatement *s) {
  static const char *const lost[] = {"speculartint",    "sheen",    "sheentint",
                                     "scatterdistance", "flatness", "difftrans",
                                     "clearcoatgloss"};
  if (!rename_if(s, "color", "basecolor") &&
      !vl_old_add(s, "\"rgb basecolor\" [ 0.5 0.5 0.5 ]"))
    return false;
  if (!vl_old_find(s, "metallic") && !vl_old_add(s, "\"float metallic\" 0"))
    return false;
  if (!vl_old_find(s, "roughness") && !vl_old_add(s, "\"float roughness\" 0.5"))
    return false;
  rename_if(s, "spectrans", "transmission");
  rename_if(s, "thin", "thinwalled");
  rename_if(s, "anisotropic", "anisotropy");
  for (size_t i = 0; i < VL_LENGTH(lost); i++)
    if (vl_old_drop_loses(s, lost[i], 0))
      vl_old_lose(s, "disney: \"%s\" has no counterpart", lost[i]);
  return true;
}
