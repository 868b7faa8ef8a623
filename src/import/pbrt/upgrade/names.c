/* import/pbrt/upgrade/names.c: names that are given twice. In pbrt-v3 a texture or a named
 * material lasts until the end of its attribute block, and a later one of the same name
 * replaces it; in pbrt-v4 each name is given once. Later ones get a number, and what refers to
 * them follows. */
#include <stdio.h>

#include "base/context.h"
#include "base/text.h"
#include "import/pbrt/upgrade/upgrade.h"

typedef enum Family { FLOAT_TEXTURE, COLOR_TEXTURE, MATERIAL, MEDIUM, OBJECT } Family;

/* Textures and materials are attributes; media and objects are the scene's. */
static bool is_scoped(Family family) {
  return family <= MATERIAL;
}

static bool is_word(const vlOldStatement *s, const char *word) {
  return vl_text_is(s->directive, word);
}

/* The family of which the statement makes a member. */
static bool makes(const vlOldStatement *s, Family *family) {
  if (is_word(s, "Texture") && s->name_count == 3)
    *family = vl_text_is(s->name[1], "float") ? FLOAT_TEXTURE : COLOR_TEXTURE;
  else if (is_word(s, "MakeNamedMaterial"))
    *family = MATERIAL;
  else if (is_word(s, "MakeNamedMedium"))
    *family = MEDIUM;
  else if (is_word(s, "ObjectBegin"))
    *family = OBJECT;
  else
    return false;
  return s->name_count > 0;
}

/* The last one of that name; one whose block has ended counts only where `ended` is true. name:
 * null finds nothing (a parameter without values). */
static const vlOldName *find(const vlUpgrade *u, Family family, const char *name, bool ended) {
  for (size_t i = name ? u->names.count : 0; i > 0; i--) {
    const vlOldName *n = &u->names.items[i - 1];
    if (n->family == (int)family && (ended || !n->ended) && vl_text_is(n->old, name))
      return n;
  }
  return NULL;
}

static bool is_taken(const vlUpgrade *u, Family family, const char *name) {
  for (size_t i = 0; i < u->names.count; i++)
    if (u->names.items[i].family == (int)family && vl_text_is(u->names.items[i].name, name))
      return true;
  return false;
}

static bool make(vlUpgrade *u, vlOldStatement *s, Family family) {
  char name[300];
  snprintf(name, sizeof name, "%s", s->name[0]);
  for (uint32_t k = 2; is_taken(u, family, name); k++)
    snprintf(name, sizeof name, "%.280s-%u", s->name[0], k);
  vlOldName *n = VL_PUSH(u->context, &u->names);
  if (!n)
    return vl_old_fail_memory(u);
  *n = (vlOldName){.family = (int)family,
                   .depth = u->attributes,
                   .old = vl_strdup(u->context, s->name[0]),
                   .name = vl_strdup(u->context, name)};
  if (!n->old || !n->name)
    return vl_old_fail_memory(u);
  if (vl_text_is(name, s->name[0]))
    return true;
  vl_old_note(s, "a second \"%s\" -> \"%s\"", s->name[0], name);
  s->name[0] = n->name;
  s->renamed |= 1u;
  u->renamed++;
  return true;
}

/* The new name of what the statement refers to; null: as it is. */
static const char *new_name(vlUpgrade *u, Family family, const char *name) {
  u->referred++;
  const vlOldName *n = find(u, family, name, false);
  if (!n)
    n = find(u, family, name, true);
  return n && !vl_text_is(n->name, name) ? n->name : NULL;
}

static void refer(vlUpgrade *u, vlOldStatement *s, size_t i, Family family) {
  const char *name = i < s->name_count ? new_name(u, family, s->name[i]) : NULL;
  if (!name)
    return;
  vl_old_note(s, "\"%s\" -> \"%s\"", s->name[i], name);
  s->name[i] = name;
  s->renamed |= 1u << i;
}

static void refer_by(vlUpgrade *u, vlOldStatement *s, vlOldParam *p, Family family) {
  const char *name = p->strings && p->count == 1 ? new_name(u, family, p->text[0]) : NULL;
  if (!name)
    return;
  vl_old_note(s, "%s is \"%s\"", p->name, name);
  p->text[0] = name;
  vl_old_value(p, "\"%.150s\"", name);
}

/* Whether the parameter takes a float texture. It matters only where there is a colour texture
 * of the name, too. */
static bool takes_numbers(const vlOldStatement *s, const char *name) {
  static const char numbers[] =
      "alpha shadowalpha amount bumpmap displacement roughness uroughness vroughness sigma eta "
      "index beta_m beta_n eumelanin pheomelanin metallic clearcoat sheen clearcoatgloss "
      "sheentint speculartint flatness anisotropic spectrans difftrans scale";
  return (is_word(s, "Texture") && vl_text_is(s->name[1], "float")) ||
         vl_has_word(numbers, name);
}

static Family texture_family(const vlUpgrade *u, const vlOldStatement *s, const vlOldParam *p) {
  const bool number = find(u, FLOAT_TEXTURE, p->text[0], false),
             color = find(u, COLOR_TEXTURE, p->text[0], false);
  if (number != color)
    return number ? FLOAT_TEXTURE : COLOR_TEXTURE;
  return takes_numbers(s, p->name) ? FLOAT_TEXTURE : COLOR_TEXTURE;
}

static void enter_or_leave(vlUpgrade *u, const vlOldStatement *s) {
  if (is_word(s, "AttributeBegin") || is_word(s, "ObjectBegin"))
    u->attributes++;
  if (!is_word(s, "AttributeEnd") && !is_word(s, "ObjectEnd"))
    return;
  if (u->attributes)
    u->attributes--;
  for (size_t i = u->names.count; i > 0; i--) {
    vlOldName *n = &u->names.items[i - 1];
    if (is_scoped((Family)n->family) && n->depth > u->attributes)
      n->ended = true;
  }
}

bool vl_old_names(vlOldStatement *s) {
  vlUpgrade *u = s->u;
  Family family;
  if (is_word(s, "NamedMaterial"))
    refer(u, s, 0, MATERIAL);
  if (is_word(s, "ObjectInstance"))
    refer(u, s, 0, OBJECT);
  for (size_t i = 0; is_word(s, "MediumInterface") && i < 2; i++)
    refer(u, s, i, MEDIUM);
  VL_EACH_ITEM(vlOldParam, p, &s->params) {
    if (strncmp(p->name, "namedmaterial", 13) == 0)
      refer_by(u, s, p, MATERIAL);
    if (vl_old_is_texture(p))
      refer_by(u, s, p, texture_family(u, s, p));
  }
  if (makes(s, &family) && !make(u, s, family))
    return false;
  enter_or_leave(u, s);
  return true;
}
