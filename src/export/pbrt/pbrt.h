/* export/pbrt/pbrt.h: what the writers of pbrt's language share. */
#ifndef EXPORT_PBRT_PBRT_H
#define EXPORT_PBRT_PBRT_H

#include "export/export.h"

#define PUT(...) vl_bytes_print(x->context, &x->text, __VA_ARGS__)

/* Writes ConcatTransform unless it is the identity. */
void vl_pbrt_matrix(vlExport *x, const double m[16]);
/* A parameter of that name. */
void vl_pbrt_spectrum(vlExport *x, const char *name, const vlSpectrum *s);
/* "material<id>", and what it refers to. */
bool vl_pbrt_material(vlExport *x, uint32_t id);
bool vl_pbrt_shape(vlExport *x, size_t index);
/* The name of the file beside the scene's that holds a texture's image as it is; light: of any brightness. */
bool vl_pbrt_image(vlExport *x, const vlTextureDef *t, bool light, char name[300]);
/* A parameter: a number, or the texture that is written before it. To be called between directives: `prepare` writes
 * the texture and keeps its name, `put` writes the parameter. */
typedef struct vlPbrtInput {
  char texture[64]; /* empty: the value */
  float number;
  vlSpectrum spectrum;
} vlPbrtInput;
bool vl_pbrt_prepare_number(vlExport *x, const vlFloatInput *input, bool squared, vlPbrtInput *result);
bool vl_pbrt_prepare_color(vlExport *x, const vlSpectrumInput *input, vlPbrtInput *result);
/* The colour to put under a smooth coat of that index, so that with it as much light comes back as from the bare one.
 */
bool vl_pbrt_prepare_under_coat(vlExport *x, const vlSpectrumInput *input, double eta, vlPbrtInput *result);
void vl_pbrt_put_number(vlExport *x, const char *name, const vlPbrtInput *input);
void vl_pbrt_put_color(vlExport *x, const char *name, const vlPbrtInput *input);

#endif
