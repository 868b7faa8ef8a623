/* export/pbrt/parameters.c: writes the members of a def that differ from their defaults as
 * parameters, by the row of its kind. */

#include "base/text.h"
#include "export/pbrt/pbrt.h"
#include "velo/texture.h"

bool vl_pbrt_knows(vlExport *x, const vlKindRow *row, const vlParameter *p) {
  if (p->flags & VL_PARAMETER_OWN)
    vl_export_lose(x, "%s of %s: left out", p->name, row->name);
  return !(p->flags & VL_PARAMETER_OWN);
}

static bool is_file_parameter(const vlParameter *p) {
  return p->name && !(p->flags & (VL_PARAMETER_RULE | VL_PARAMETER_SHORTHAND));
}

/* Files are copied beside the scene. One of them is an image, whose values are no colours. */
static bool prepare_file(vlExport *x, const vlParameter *p, const char *path, char name[300]) {
  vlTextureDef t = vl_default_texture_def(VL_TEXTURE_IMAGE, true);
  t.path = path;
  t.encoding = VL_ENCODING_LINEAR;
  t.encoding_given = true;
  return vl_pbrt_image(x, &t, vl_text_is(p->name, "normalmap") ? VL_PBRT_COLORS : VL_PBRT_ANY,
                       name);
}

static bool prepare(vlExport *x, const vlParameter *p, const void *def, bool spectrum,
                    int depth, vlPbrtParameter *result) {
  const char *at = (const char *)def + p->offset;
  if (p->type == VL_PARAMETER_EITHER_INPUT && spectrum)
    return vl_pbrt_inner_color(x, (const void *)((const char *)def + p->second), depth,
                               &result->input);
  if (p->type == VL_PARAMETER_EITHER_INPUT || p->type == VL_PARAMETER_FLOAT_INPUT)
    return vl_pbrt_inner_number(x, (const void *)at, depth, &result->input);
  if (p->type == VL_PARAMETER_SPECTRUM_INPUT)
    return vl_pbrt_inner_color(x, (const void *)at, depth, &result->input);
  if (p->type == VL_PARAMETER_FILE)
    return prepare_file(x, p, *(const char *const *)(const void *)at, result->file);
  return true;
}

bool vl_pbrt_prepare(vlExport *x, const vlKindRow *row, const void *def, bool spectrum,
                     vlPbrtWish *wish, int depth, vlPbrtParameter *list) {
  for (uint32_t i = 0; i < row->parameter_count; i++) {
    const vlParameter *p = &row->parameters[i];
    vlPbrtWished w = wish ? wish(def, p) : VL_PBRT_UNLESS_DEFAULT;
    list[i] = (vlPbrtParameter){0};
    if (!is_file_parameter(p) || w == VL_PBRT_NEVER)
      continue;
    list[i].wanted = w == VL_PBRT_ALWAYS || !vl_parameter_is_default(p, def, spectrum);
    list[i].wanted = list[i].wanted && vl_pbrt_knows(x, row, p);
    if (list[i].wanted && !prepare(x, p, def, spectrum, depth, &list[i]))
      return false;
  }
  return true;
}

static void put_spectrum(vlExport *x, const vlParameter *p, const vlPbrtInput *input) {
  const vlSpectrum *s = &input->spectrum;
  if (!input->texture[0] && s->kind == VL_SPECTRUM_CONSTANT &&
      (p->flags & (VL_PARAMETER_NUMBER | VL_PARAMETER_ONE_NUMBER)))
    PUT(" \"float %s\" [%.9g]", p->name, (double)s->value * (double)s->scale);
  else
    vl_pbrt_put_color(x, p->name, input);
}

static void put(vlExport *x, const vlParameter *p, const void *def, bool spectrum,
                const vlPbrtParameter *prepared) {
  const vlPbrtInput *input = &prepared->input;
  const bool either = p->type == VL_PARAMETER_EITHER_INPUT;
  if (p->type == VL_PARAMETER_FILE)
    PUT(" \"string %s\" \"%s\"", p->name, prepared->file);
  else if (p->type == VL_PARAMETER_SPECTRUM_INPUT)
    put_spectrum(x, p, input);
  else if (either && spectrum)
    vl_pbrt_put_color(x, p->name, input);
  else if (either || p->type == VL_PARAMETER_FLOAT_INPUT)
    vl_pbrt_put_number(x, p->name, input);
  else
    vl_pbrt_parameter(x, p, def);
}

void vl_pbrt_put(vlExport *x, const vlKindRow *row, const void *def, bool spectrum,
                 const vlPbrtParameter *list) {
  for (uint32_t i = 0; i < row->parameter_count; i++)
    if (list[i].wanted)
      put(x, &row->parameters[i], def, spectrum, &list[i]);
}
