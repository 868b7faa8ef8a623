/* export/pbrt/row.c: writes the members of a def as parameters of pbrt's language, by the row
 * of its kind. */

#include <stdio.h>
#include <stdlib.h>

#include "base/text.h"
#include "export/pbrt/pbrt.h"

/* The value in the unit of the file. */
static double in_files(const vlParameter *p, double value) {
  return p->factor != 0 ? value / p->factor : value;
}

/* Writes as few digits as are needed to read the same number again: 360 degrees, not those of
 * the float next to 2 pi. */
static void put_float(vlExport *x, const vlParameter *p, float v) {
  const double value = in_files(p, (double)v);
  const double factor = p->factor != 0 ? p->factor : 1;
  char text[32];
  int digits = 6;
  do
    snprintf(text, sizeof text, "%.*g", digits++, value);
  while (digits <= 17 && (float)(strtod(text, NULL) * factor) != v);
  PUT(" \"float %s\" [%s]", p->name, text);
}

static const char *vector_type(const vlParameter *p) {
  return p->flags & VL_PARAMETER_VECTOR ? "vector3" : "point3";
}

void vl_pbrt_parameter(vlExport *x, const vlParameter *p, const void *def) {
  const void *at = (const char *)def + p->offset;
  const float *v = at;
  switch (p->type) {
    case VL_PARAMETER_BOOL:
      PUT(" \"bool %s\" %s", p->name, *(const bool *)at ? "true" : "false");
      break;
    case VL_PARAMETER_COUNT:
      PUT(" \"integer %s\" [%u]", p->name, *(const uint32_t *)at);
      break;
    case VL_PARAMETER_FLOAT:
      put_float(x, p, *v);
      break;
    case VL_PARAMETER_DOUBLE:
      PUT(" \"float %s\" [%.17g]", p->name, in_files(p, *(const double *)at));
      break;
    case VL_PARAMETER_FLOAT3:
      PUT(" \"%s %s\" [%.9g %.9g %.9g]", vector_type(p), p->name, (double)v[0], (double)v[1],
          (double)v[2]);
      break;
    case VL_PARAMETER_DOUBLE3: {
      const double *d = at;
      PUT(" \"%s %s\" [%.17g %.17g %.17g]", vector_type(p), p->name, d[0], d[1], d[2]);
      break;
    }
    case VL_PARAMETER_CHOICE:
      PUT(" \"string %s\" \"%s\"", p->name, p->choices[*(const int *)at]);
      break;
    case VL_PARAMETER_STRING:
      if (*(const char *const *)at)
        PUT(" \"string %s\" \"%s\"", p->name, *(const char *const *)at);
      break;
    case VL_PARAMETER_SPECTRUM:
      vl_pbrt_spectrum(x, p->name, at);
      break;
    case VL_PARAMETER_FILE:
    case VL_PARAMETER_FLOAT_INPUT:
    case VL_PARAMETER_SPECTRUM_INPUT:
    case VL_PARAMETER_EITHER_INPUT:
    case VL_PARAMETER_TEXTURE:
    case VL_PARAMETER_BLOCK:
      break;
  }
}

void vl_pbrt_row(vlExport *x, const vlKindRow *row, const void *def, bool all,
                 const char *skip) {
  VL_EACH_PARAMETER(p, row) {
    if (!p->name || (p->flags & VL_PARAMETER_SHORTHAND) || (skip && vl_text_is(p->name, skip)))
      continue;
    /* defaults are left out, but for `all` and RGB colours; an unset value has no text */
    const bool always =
        !(p->flags & VL_PARAMETER_UNSET) && (all || p->flags & VL_PARAMETER_RGB);
    if (!always && vl_parameter_is_default(p, def, false))
      continue;
    if (vl_pbrt_knows(x, row, p))
      vl_pbrt_parameter(x, p, def);
  }
}
