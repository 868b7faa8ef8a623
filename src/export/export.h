/* export/export.h: scenes out again. export.c (the face, losses, files) -> gltf*.c or pbrt*.c. What a format cannot
 * hold is counted as a loss in words, one line for each kind. */
#ifndef EXPORT_EXPORT_H
#define EXPORT_EXPORT_H

#include <jansson.h>

#include "base/file.h"
#include "math/transform.h"
#include "scene/scene.h"
#include "velo/export.h"

enum { VL_EXPORT_LOSSES = 64 };

typedef struct vlLoss {
  char text[200];
  uint64_t count;
} vlLoss;

typedef struct vlBytes {
  VL_ARRAY(char) data;
  bool full; /* memory was out */
} vlBytes;

/* An image that was written: by what the scene's texture holds. */
typedef struct vlExportImage {
  const void *data; /* of an image file in memory, or the vlImage; or */
  const char *path;
  uint32_t variant; /* hash of what was done to it; 0: as it is */
  json_int_t index; /* glTF: image */
  char name[300];   /* pbrt: file */
} vlExportImage;

/* glTF: a material as shapes use it. */
typedef struct vlExportLook {
  vlMaterialId material;
  vlFloatInput alpha;
  vlEmissionId emission;
  vlMediumId inside;
  bool one_sided, colors, normal;
  json_int_t index;
} vlExportLook;

typedef struct vlExport {
  vlContext *context;
  const vlScene *scene;
  const char *path;
  const vlSaveDef *def;
  vlError *error;
  vlResult result;
  bool dry; /* nothing is written: only what would be lost is looked for */
  vlLoss losses[VL_EXPORT_LOSSES];
  uint32_t loss_count;
  char stem[200]; /* of the file's name, for those beside it */
  VL_ARRAY(vlExportImage) images;
  /* glTF */
  bool binary;
  json_t *root;
  vlBytes buffer;
  VL_ARRAY(vlExportLook) looks;
  /* pbrt */
  vlBytes text;
} vlExport;

/* ---- export.c ---------------------------------------------------------------------------------------------------- */

void vl_export_lose(vlExport *x, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* Remembers the first error; false. */
bool vl_export_fail(vlExport *x, vlResult result, const char *format, ...) __attribute__((format(printf, 3, 4)));
void vl_bytes_put(vlContext *context, vlBytes *bytes, const void *data, size_t size);
void vl_bytes_print(vlContext *context, vlBytes *bytes, const char *format, ...) __attribute__((format(printf, 3, 4)));
/* A whole file beside the scene's (name null: the scene's own). */
bool vl_export_file(vlExport *x, const char *name, const void *data, size_t size);
/* Path of a file beside the scene's. */
bool vl_export_path(vlExport *x, const char *name, char *path, size_t size);
/* The image of a texture, decoded. */
vlImage *vl_export_decode(vlExport *x, const vlTextureDef *t);
/* Its bytes as they are where it is PNG or JPEG (*suffix), else packed as PNG; a block of the context. */
bool vl_export_image(vlExport *x, const vlTextureDef *t, char **data, size_t *size, const char **suffix);
/* An image as the bytes of a file of that suffix. */
bool vl_export_pack(vlExport *x, const vlImage *image, const char *suffix, char **data, size_t *size);

/* ---- values.c ---------------------------------------------------------------------------------------------------- */

/* Linear sRGB. Lights are divided by their luminance as the tracer does; a textured input gives its texture's mean
 * where that is easily told. */
void vl_export_light_rgb(const vlSpectrum *s, float rgb[3]);
void vl_export_rgb(vlExport *x, const vlSpectrumInput *input, float rgb[3]);
float vl_export_number(vlExport *x, const vlFloatInput *input);
/* The texture of an input when it is an image; else null. */
const vlTextureDef *vl_export_texture(const vlExport *x, vlTextureId id);
/* (s, t) = 2x3 matrix times (u, v, 1). */
void vl_export_st_from_uv(const vlTextureDef *t, double m[6]);
/* Reflectance at normal incidence of a metal. */
void vl_export_metal_rgb(vlExport *x, const vlMaterialDef *m, float rgb[3]);
/* Index of refraction at 589 nm. */
float vl_export_eta(const vlSpectrum *eta);
/* GGX's alpha of a pbrt material's roughness. */
float vl_export_alpha(vlExport *x, const vlMaterialDef *m, const vlFloatInput *roughness);

/* ---- meshes.c ---------------------------------------------------------------------------------------------------- */

/* A shape as triangles; `own` are blocks to be freed by vl_export_free_mesh. False: none, said or counted as a loss. */
typedef struct vlExportMesh {
  uint32_t vertices, faces;
  const float *positions, *normals, *tangents, *uvs[4], *colors, *signs;
  const uint32_t *indices;
  void *own[4];
} vlExportMesh;
bool vl_export_mesh(vlExport *x, const vlShapeDef *d, vlExportMesh *mesh);
void vl_export_free_mesh(vlExport *x, vlExportMesh *mesh);

/* ---- glTF, pbrt -------------------------------------------------------------------------------------------------- */

bool vl_export_gltf(vlExport *x);
/* Index of the bufferView of bytes put into the buffer; target 0: none. */
json_int_t vl_gltf_put_view(vlExport *x, const void *data, size_t size, int target);
/* Appends to the array `key` of the root; the index. Steals value. */
json_int_t vl_gltf_put(vlExport *x, const char *key, json_t *value);
void vl_gltf_use(vlExport *x, const char *extension);
json_t *vl_gltf_array_of(const float *values, size_t count);
/* Index of the material; -1: none. */
json_int_t vl_gltf_put_material(vlExport *x, const vlShapeDef *d, bool *colors, bool *tangents);
bool vl_gltf_is_hidden(const vlExport *x, const vlShapeDef *d);
/* textureInfo of an image; null: none. */
json_t *vl_gltf_texture_info(vlExport *x, const vlTextureDef *t, bool linear);
bool vl_gltf_put_camera(vlExport *x, json_t *nodes, bool mirror);
bool vl_gltf_put_lights(vlExport *x, json_t *nodes);

bool vl_export_pbrt(vlExport *x);

#endif
