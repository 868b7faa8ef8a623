/* scene/take.c: a def is checked by its row, and what it points at is copied into the scene. */
#include <stdio.h>

#include "scene/scene.h"
#include "schema/schema.h"
#include "velo/edit.h"
#include "velo/texture.h"

typedef struct Take {
  vlScene *scene;
  vlSource source;
  const char *what;
} Take;

static bool bad(const Take *t, const vlParameter *p, const char *why) {
  vl_scene_fail(t->scene, VL_ERROR_SCENE, t->source, "%s: parameter \"%s\" %s", t->what,
                vl_parameter_label(p), why);
  return false;
}

static bool take_texture(const Take *t, const vlParameter *p, vlTextureId id, bool spectrum) {
  if (!id.index)
    return true;
  if (p->flags & VL_PARAMETER_NO_TEXTURE)
    return bad(t, p, "cannot be textured");
  if (!vl_scene_has(t->scene, VL_SCENE_TEXTURES, id.index))
    return bad(t, p, "names a texture that does not exist (add it first)");
  if (t->scene->textures.items[id.index - 1].spectrum == spectrum)
    return true;
  return bad(t, p,
             spectrum ? "needs a spectrum texture, this is a float texture"
                      : "needs a float texture, this is a spectrum texture");
}

static bool take_spectrum(const Take *t, const vlParameter *p, vlSpectrum *s) {
  char what[160];
  snprintf(what, sizeof what, "%s: parameter \"%s\"", t->what, vl_parameter_label(p));
  if (!vl_scene_copy_spectrum(t->scene, s, t->source, what))
    return false;
  return !(p->flags & VL_PARAMETER_ONE_NUMBER) || s->kind == VL_SPECTRUM_CONSTANT ||
         bad(t, p, "must be one number");
}

static bool take_spectrum_input(const Take *t, const vlParameter *p, vlSpectrumInput *input) {
  if (!take_texture(t, p, input->texture, true))
    return false;
  if (!input->texture.index)
    return take_spectrum(t, p, &input->value);
  input->value = vl_spectrum_constant(1.0f);
  return true;
}

static bool take_member(const Take *t, const vlParameter *p, void *at) {
  switch (p->type) {
    case VL_PARAMETER_STRING:
    case VL_PARAMETER_FILE:
      return vl_scene_copy_string(t->scene, at);
    case VL_PARAMETER_SPECTRUM:
      return take_spectrum(t, p, at);
    case VL_PARAMETER_EITHER_INPUT:
    case VL_PARAMETER_FLOAT_INPUT:
      return take_texture(t, p, ((vlFloatInput *)at)->texture, false);
    case VL_PARAMETER_SPECTRUM_INPUT:
      return take_spectrum_input(t, p, at);
    case VL_PARAMETER_TEXTURE:
      return take_texture(t, p, *(vlTextureId *)at, true);
    case VL_PARAMETER_BOOL:
    case VL_PARAMETER_COUNT:
    case VL_PARAMETER_FLOAT:
    case VL_PARAMETER_DOUBLE:
    case VL_PARAMETER_FLOAT3:
    case VL_PARAMETER_DOUBLE3:
    case VL_PARAMETER_CHOICE:
    case VL_PARAMETER_BLOCK:
      return true;
  }
  return true;
}

static bool take_parameter(const Take *t, const vlParameter *p, char *def, bool spectrum) {
  if (p->type == VL_PARAMETER_EITHER_INPUT) { /* only the number or the spectrum is read; the
                                                 other is set to 0 */
    if (!spectrum) {
      *(vlSpectrumInput *)(void *)(def + p->second) = (vlSpectrumInput){0};
    } else {
      *(vlFloatInput *)(void *)(def + p->offset) = (vlFloatInput){0};
      return take_spectrum_input(t, p, (vlSpectrumInput *)(void *)(def + p->second));
    }
  } else if (p->second && !take_member(t, p, def + p->second)) {
    return false;
  }
  return take_member(t, p, def + p->offset);
}

bool vl_row_take(vlScene *scene, const vlKindRow *row, void *def, bool spectrum,
                 vlSource source, const char *what) {
  const Take t = {scene, source, what};
  char name[200];
  char message[VL_GIVEN_MESSAGE];
  for (uint32_t i = 0; i < row->parameter_count; i++) {
    const vlParameter *p = &row->parameters[i];
    if (p->flags & VL_PARAMETER_SHORTHAND)
      continue;
    if (!take_parameter(&t, p, def, spectrum))
      return false;
    snprintf(name, sizeof name, "%s: parameter \"%s\"", what, vl_parameter_label(p));
    if (vl_parameter_check(p, def, name, message))
      continue;
    vl_scene_fail(scene, VL_ERROR_SCENE, source, "%s", message);
    return false;
  }
  return true;
}
