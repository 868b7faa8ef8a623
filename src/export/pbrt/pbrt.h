/* export/pbrt/pbrt.h: declarations shared by the files that write pbrt's language. */
#ifndef EXPORT_PBRT_PBRT_H
#define EXPORT_PBRT_PBRT_H

#include "export/export.h"
#include "schema/schema.h"

#define PUT(...) vl_bytes_print(x->context, &x->text, __VA_ARGS__)

/* Writes numbers in brackets. */
void vl_pbrt_floats(vlExport *x, const float *v, size_t count);
/* Writes ConcatTransform unless the matrix is the identity. */
void vl_pbrt_matrix(vlExport *x, const double m[16]);
/* Starts a spectrum parameter of that name. */
void vl_pbrt_spectrum(vlExport *x, const char *name, const vlSpectrum *s);
/* Writes the members of a def that differ from the row's defaults. With `all`, every member
 * that is set is written. Arrays, files, inputs and the member `skip` (may be null) are left
 * out. */
void vl_pbrt_row(vlExport *x, const vlKindRow *row, const void *def, bool all,
                 const char *skip);
/* Whether pbrt's kind has the parameter. A loss is counted when it does not. */
bool vl_pbrt_knows(vlExport *x, const vlKindRow *row, const vlParameter *p);
/* Writes one parameter with the value that it has in the def. Arrays, files and inputs are left
 * out. */
void vl_pbrt_parameter(vlExport *x, const vlParameter *p, const void *def);
/* The name of the film's kind. */
const char *vl_pbrt_film_kind(const vlSceneDefs *defs);
/* Writes the film's parameters except its size, which the camera's text holds. */
void vl_pbrt_film(vlExport *x);
/* Writes "medium<index + 1>", before WorldBegin. */
bool vl_pbrt_medium(vlExport *x, size_t index);
/* Writes "material<id>" and everything it refers to. */
bool vl_pbrt_material(vlExport *x, uint32_t id);
bool vl_pbrt_shape(vlExport *x, size_t index);
/* What pbrt requires of a file. */
typedef enum vlPbrtFile {
  VL_PBRT_ANY,    /* not an image: copied as it is */
  VL_PBRT_VALUES, /* an image of one channel or with channels R, G and B */
  VL_PBRT_COLORS  /* an image with channels R, G and B: lights, normal maps */
} vlPbrtFile;
/* Copies a texture's image beside the scene; name receives the file name. An image that pbrt
 * would refuse is written as an EXR with channels R, G and B. */
bool vl_pbrt_image(vlExport *x, const vlTextureDef *t, vlPbrtFile kind, char name[300]);
/* Counts a loss where the image's colours are of a space that its file does not name: pbrt
 * takes them for sRGB. image: of an image in memory. */
void vl_pbrt_lose_space(vlExport *x, vlColorSpace space, const vlImage *image);
/* The same as vl_pbrt_image for the image of an area light, with all factors of its texture. */
bool vl_pbrt_emitted_image(vlExport *x, const vlTextureDef *t, char name[300]);
/* An input as a parameter: a number or a texture. `prepare`, called between directives, writes
 * the texture and keeps its name. `put` writes the parameter. */
typedef struct vlPbrtInput {
  char texture[64]; /* empty: a value */
  float number;
  vlSpectrum spectrum;
} vlPbrtInput;
bool vl_pbrt_prepare_number(vlExport *x, const vlFloatInput *input, bool squared,
                            vlPbrtInput *result);
bool vl_pbrt_prepare_color(vlExport *x, const vlSpectrumInput *input, vlPbrtInput *result);
/* The colour for a base under a smooth coat of index eta, chosen so that the coated surface
 * reflects as much light as the uncoated one. */
bool vl_pbrt_prepare_under_coat(vlExport *x, const vlSpectrumInput *input, double eta,
                                vlPbrtInput *result);
/* The colour mixed with white: c (1 - white) + white. */
bool vl_pbrt_prepare_raised(vlExport *x, const vlSpectrumInput *input, float white,
                            vlPbrtInput *result);
/* The reflectance of pbrt's conductor that reflects about as much light as a principled metal
 * of this colour. alpha: the mean over its microfacets. */
bool vl_pbrt_prepare_metal(vlExport *x, const vlSpectrumInput *input, float alpha,
                           vlPbrtInput *result);
void vl_pbrt_put_number(vlExport *x, const char *name, const vlPbrtInput *input);
void vl_pbrt_put_color(vlExport *x, const char *name, const vlPbrtInput *input);
/* Prepares the input without changes to its values. depth: nesting of textures. */
bool vl_pbrt_inner_number(vlExport *x, const vlFloatInput *input, int depth,
                          vlPbrtInput *result);
bool vl_pbrt_inner_color(vlExport *x, const vlSpectrumInput *input, int depth,
                         vlPbrtInput *result);

/* Writes all parameters of a row in the same two steps, prepare and put (parameters.c). Only
 * parameters that differ from their defaults are written, unless `wish` (may be null) decides
 * otherwise. list has one entry per parameter of the row. spectrum selects the spectrum or the
 * float input of EITHER_INPUT. */
enum { VL_PBRT_PARAMETERS = 64 };
typedef struct vlPbrtParameter {
  bool wanted;
  vlPbrtInput input;
  char file[300];
} vlPbrtParameter;
typedef enum vlPbrtWished {
  VL_PBRT_UNLESS_DEFAULT,
  VL_PBRT_ALWAYS,
  VL_PBRT_NEVER
} vlPbrtWished;
typedef vlPbrtWished vlPbrtWish(const void *def, const vlParameter *parameter);
bool vl_pbrt_prepare(vlExport *x, const vlKindRow *row, const void *def, bool spectrum,
                     vlPbrtWish *wish, int depth, vlPbrtParameter *list);
void vl_pbrt_put(vlExport *x, const vlKindRow *row, const void *def, bool spectrum,
                 const vlPbrtParameter *list);

#endif
