/* camera/optics_file.c: pbrt's lens files: four numbers per surface (radius of curvature,
 * thickness, index of refraction, aperture diameter; mm), from the scene's side; # starts a
 * comment. */
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/file.h"
#include "base/machine.h"
#include "base/text.h"
#include "camera/optics.h"

typedef struct {
  const char *path, *at, *line_start;
  uint32_t line;
} Reader;

static void skip(Reader *r) {
  for (;; r->at++) {
    if (*r->at == '#')
      r->at += strcspn(r->at, "\n");
    if (*r->at == '\n') {
      r->line++;
      r->line_start = r->at + 1;
    }
    if (!vl_is_blank(*r->at))
      return;
  }
}

/* Parses a plain decimal; the whole word must match. */
static bool number(const char *word, size_t length, double *value) {
  char text[64], *end;
  if (length == 0 || length >= sizeof text || strspn(word, "0123456789+-.eE") < length)
    return false;
  memcpy(text, word, length);
  text[length] = 0;
  *value = strtod(text, &end);
  return *end == 0;
}

static vlResult read(Reader *r, vlLensSurface *surfaces, uint32_t *count, vlError *error) {
  uint32_t n = 0;
  for (skip(r); *r->at; skip(r), n++) {
    size_t length = strcspn(r->at, " \t\r\n\v\f#");
    uint32_t column = (uint32_t)(r->at - r->line_start) + 1;
    double value;
    if (!number(r->at, length, &value))
      return vl_fail_at(error, VL_ERROR_SCENE, r->path, r->line, column,
                        "lens file: \"%s\" is not a number",
                        vl_short_text_of(r->at, length).text);
    if (n == 4 * VL_MAX_SURFACES)
      return vl_fail_at(error, VL_ERROR_SCENE, r->path, r->line, column,
                        "lens file: more than %d surfaces", VL_MAX_SURFACES);
    vlLensSurface *s = &surfaces[n / 4];
    *(n % 4 == 0   ? &s->radius
      : n % 4 == 1 ? &s->thickness
      : n % 4 == 2 ? &s->ior
                   : &s->aperture) = value;
    r->at += length;
  }
  if (n == 0 || n % 4)
    return vl_fail_at(
        error, VL_ERROR_SCENE, r->path, r->line, 0,
        "lens file: %u numbers; each surface has 4: radius, thickness, ior, aperture diameter",
        n);
  *count = n / 4;
  return VL_OK;
}

vlResult vl_optics_load(vlContext *context, const char *path, const vlOpticsDef *def,
                        vlOptics **optics, vlError *error) {
  vl_error_clear(error);
  if (optics)
    *optics = NULL;
  if (!context || !path || !def || !optics)
    return vl_fail_argument(error, "lens: context, path, def or optics is null");
  char *data = NULL;
  size_t size;
  VL_TRY(vl_file_read(context, path, false, &data, &size, error));
  vlLensSurface surfaces[VL_MAX_SURFACES];
  vlOpticsDef filled = *def;
  Reader r = {path, data, data, 1};
  void *locale = vl_machine_set_numerals();
  vlResult result = read(&r, surfaces, &filled.count, error);
  vl_machine_restore_numerals(locale);
  if (result == VL_OK && strlen(data) != size)
    result =
        vl_fail_at(error, VL_ERROR_SCENE, path, r.line, 0, "lens file: it is not a text file");
  vl_free(context, data);
  if (result != VL_OK)
    return result;
  filled.surfaces = surfaces;
  vlError inner = {0};
  result = vl_optics_create(context, &filled, optics, &inner);
  if (result == VL_ERROR_MEMORY)
    return vl_fail_memory(error);
  if (result == VL_OK)
    return VL_OK;
  /* the file gives the lens, the caller the other parameters */
  return vl_fail_at(error, VL_ERROR_SCENE, path, 0, 0, "%s", inner.message);
}
