/* export/pbrt/pbrt.h: what the writers of pbrt's language share. */
#ifndef EXPORT_PBRT_PBRT_H
#define EXPORT_PBRT_PBRT_H

#include "export/export.h"
#include "scene/schema/schema.h"

#define PUT(...) vl_bytes_print(x->context, &x->text, __VA_ARGS__)

/* Writes ConcatTransform unless it is the identity. */
void vl_pbrt_matrix(vlExport *x, const double m[16]);
/* A parameter of that name. */
void vl_pbrt_spectrum(vlExport *x, const char *name, const vlSpectrum *s);
/* The members of a def that differ from the row's defaults (all: every one that is set); not arrays, files and inputs,
 * and not the one named skip (may be null). */
void vl_pbrt_row(vlExport *x, const vlKindRow *row, const void *def, bool all, const char *skip);
/* "medium<index + 1>", before WorldBegin. */
bool vl_pbrt_medium(vlExport *x, size_t index);
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
/* The same for inputs as they are; depth: of textures in textures. */
bool vl_pbrt_inner_number(vlExport *x, const vlFloatInput *input, int depth, vlPbrtInput *result);
bool vl_pbrt_inner_color(vlExport *x, const vlSpectrumInput *input, int depth, vlPbrtInput *result);

/* All parameters that a row names, in two steps as above (parameters.c): those that differ from their defaults, unless
 * `wish` (may be null) says otherwise. list: an entry per parameter of the row. spectrum: of EITHER_INPUT, the half. */
enum { VL_PBRT_PARAMETERS = 64 };
typedef struct vlPbrtParameter {
  bool wanted;
  vlPbrtInput input;
  char file[300];
} vlPbrtParameter;
typedef enum vlPbrtWished { VL_PBRT_UNLESS_DEFAULT, VL_PBRT_ALWAYS, VL_PBRT_NEVER } vlPbrtWished;
typedef vlPbrtWished vlPbrtWish(const void *def, const vlParameter *parameter);
bool vl_pbrt_prepare(vlExport *x, const vlKindRow *row, const void *def, bool spectrum, vlPbrtWish *wish, int depth,
                     vlPbrtParameter *list);
void vl_pbrt_put(vlExport *x, const vlKindRow *row, const void *def, bool spectrum, const vlPbrtParameter *list);

#endif
