/* import/pbrt/spectrum.c: colours and numbers of parameters become inputs of the scene: rgb,
 * named spectra, spectrum files (two columns: wavelength in nm, value), sampled spectra,
 * blackbodies, textures by name. */

#include "base/file.h"
#include "base/text.h"
#include "color/named.h"
#include "import/pbrt/builder.h"
#include "import/pbrt/decimal.h"
#include "import/pbrt/token.h"

/* The block lives until the end of the import, like the strings. */
static float *keep_floats(vlImport *import, size_t count) {
  char **slot = VL_IMPORT_PUSH(import, &import->strings);
  if (!slot)
    return NULL;
  float *block = vl_alloc_array(import->context, count ? count : 1, sizeof *block);
  *slot = (char *)block;
  if (!block)
    vl_import_fail_memory(import);
  return block;
}

static bool take_pairs(vlImport *import, const float *pairs, size_t values, vlSource source,
                       vlSpectrum *spectrum) {
  if (values % 2)
    return vl_import_wrong(import, source,
                           "a spectrum holds pairs of wavelength and value; found %zu numbers",
                           values);
  size_t n = values / 2;
  float *block = keep_floats(import, values);
  if (!block)
    return false;
  for (size_t i = 0; i < n; i++) {
    block[i] = pairs[2 * i];
    block[n + i] = pairs[2 * i + 1];
    if (i && !(block[i] > block[i - 1]))
      return vl_import_wrong(import, source,
                             "wavelengths of a spectrum must increase: %g comes after %g",
                             (double)block[i], (double)block[i - 1]);
  }
  *spectrum = (vlSpectrum){.kind = VL_SPECTRUM_SAMPLED,
                           .scale = 1.0f,
                           .count = (uint32_t)n,
                           .wavelengths = block,
                           .values = block + n};
  return true;
}

static bool parse_file(vlImport *import, const char *path, char *data, size_t size,
                       vlSpectrum *spectrum) {
  VL_ARRAY(float) pairs = {0};
  vlTokenizer tokens;
  vl_tokenizer_start(&tokens, data, size);
  bool fine = true;
  while (fine) {
    vlToken token = vl_token_next(&tokens);
    if (token.kind == VL_TOKEN_END)
      break;
    double value;
    vlSource at = {path, token.line, token.column};
    if (token.kind != VL_TOKEN_WORD || !vl_number_parse(token.text, token.length, &value)) {
      fine = vl_import_wrong(import, at, "spectrum file: expected a number");
      break;
    }
    float *slot = VL_PUSH(import->context, &pairs);
    if (slot)
      *slot = (float)value;
    else
      fine = vl_import_fail_memory(import);
  }
  vlSource whole = {path, 1, 1};
  if (fine && pairs.count == 0)
    fine = vl_import_wrong(import, whole, "spectrum file: holds no numbers");
  fine = fine && take_pairs(import, pairs.items, pairs.count, whole, spectrum);
  VL_ARRAY_FREE(import->context, &pairs);
  return fine;
}

static bool read_file(vlImport *import, const vlParam *param, vlSpectrum *spectrum) {
  char path[4096];
  char *data;
  size_t size;
  vlError error = {0};
  if (!vl_import_path(import, param, path, sizeof path))
    return false;
  vlResult result = vl_file_read(import->context, path, true, &data, &size, &error);
  if (result != VL_OK)
    return vl_import_fail(import, result, param->source, "%s", error.message);
  bool fine = parse_file(import, path, data, size, spectrum);
  vl_free(import->context, data);
  return fine;
}

static bool read_named(vlImport *import, const vlParam *param, vlSpectrum *spectrum) {
  const char *text = param->strings.items[0];
  const char *near;
  const char *known = vl_named_spectrum_find(text, &near);
  if (known) {
    *spectrum = vl_spectrum_named(known);
    return true;
  }
  if (strchr(text, '/') || strchr(text, '.'))
    return read_file(import, param, spectrum);
  char path[4096];
  if (!near &&
      vl_import_find(import, param->source, text, path, sizeof path) != VL_FOUND_TOO_LONG)
    return read_file(import, param, spectrum);
  return vl_import_wrong(import, param->source, "no spectrum is named \"%s\"%s",
                         vl_short_text(text).text, vl_hint(near).text);
}

bool vl_import_spectrum(vlImport *import, vlParam *p, vlSpectrum *spectrum) {
  size_t count = vl_param_count(p);
  if (p->type == VL_PARAM_RGB) {
    if (count != 3)
      return vl_import_wrong(import, p->source, "\"rgb %s\" takes 3 values, found %zu", p->name,
                             count);
    *spectrum = vl_spectrum_rgb(p->floats.items[0], p->floats.items[1], p->floats.items[2]);
    spectrum->space = p->space;
    for (int i = 0; i < 3; i++)
      if (spectrum->rgb[i] < 0.0f)
        return vl_import_wrong(import, p->source, "\"rgb %s\" has a negative value", p->name);
    return true;
  }
  if (p->type == VL_PARAM_BLACKBODY) {
    if (count != 1)
      return vl_import_wrong(import, p->source,
                             "\"blackbody %s\" takes 1 value (kelvin), found %zu", p->name,
                             count);
    *spectrum = vl_spectrum_blackbody(p->floats.items[0]);
    if (p->floats.items[0] > 0.0f)
      return true;
    return vl_import_wrong(import, p->source, "\"blackbody %s\" must be above 0 kelvin",
                           p->name);
  }
  if (p->strings.count == 0)
    return take_pairs(import, p->floats.items, p->floats.count, p->source, spectrum);
  if (count != 1)
    return vl_import_wrong(import, p->source, "\"spectrum %s\" takes one name, found %zu",
                           p->name, count);
  return read_named(import, p, spectrum);
}

bool vl_import_float_input(vlDict *dict, const char *name, vlFloatInput *input) {
  vlParam *p = vl_dict_find_counted(dict, name, VL_BIT_FLOAT | VL_BIT_TEXTURE, 1);
  if (!p)
    return false;
  if (p->type == VL_PARAM_TEXTURE)
    return vl_import_texture_id(dict->import, p->strings.items[0], false, p->source,
                                &input->texture);
  *input = vl_float_input(p->floats.items[0]);
  return true;
}

bool vl_import_spectrum_input(vlDict *dict, const char *name, vlSpectrumInput *input,
                              bool albedo) {
  vlImport *import = dict->import;
  vlParam *p = vl_dict_find(dict, name, VL_BITS_SPECTRUM | VL_BIT_TEXTURE);
  if (!p)
    return false;
  if (p->type == VL_PARAM_TEXTURE) {
    if (vl_param_count(p) != 1)
      return vl_dict_fail_at(dict, p->source, "parameter \"%s\" takes 1 texture, found %zu",
                             name, vl_param_count(p));
    return vl_import_texture_id(import, p->strings.items[0], true, p->source, &input->texture);
  }
  *input = (vlSpectrumInput){0};
  if (!vl_import_spectrum(import, p, &input->value))
    return false;
  for (int i = 0; albedo && p->type == VL_PARAM_RGB && i < 3; i++)
    if (p->floats.items[i] > 1.0f)
      return vl_dict_fail_at(dict, p->source,
                             "\"rgb %s\" is a reflectance and must not be above 1, it is %g",
                             name, (double)p->floats.items[i]);
  return true;
}
