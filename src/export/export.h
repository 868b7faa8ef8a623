/* export/export.h: exporters write scenes to files of other formats. export.c (interface,
 * losses, files) calls gltf*.c or pbrt*.c. Whatever a format cannot represent is counted as a
 * loss, with one line of text per kind of loss. */
#ifndef EXPORT_EXPORT_H
#define EXPORT_EXPORT_H

#include <jansson.h>

#include "base/file_set.h"
#include "camera_files/files.h"
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
  bool full; /* an allocation failed */
} vlBytes;

/* An image that was written, identified by the source of the scene's texture. */
typedef struct vlExportImage {
  const void *data; /* the image file in memory or the vlImage; null: path */
  const char *path;
  uint32_t variant; /* hash of the changes to the image; 0: unchanged */
  json_int_t index; /* glTF: index of the image */
  char name[300];   /* pbrt: name of the file */
} vlExportImage;

/* glTF: a material together with the properties of the shapes that use it. */
typedef struct vlExportLook {
  vlMaterialId material;
  vlFloatInput alpha;
  vlEmissionId emission;
  vlMediumId inside;
  bool one_sided;
  json_int_t index;
} vlExportLook;

typedef struct vlExport {
  vlContext *context;
  const vlScene *scene;
  const char *path;
  const vlSaveDef *def;
  vlError *error;
  vlResult result;
  bool dry; /* nothing is written; only losses are collected */
  vlLoss losses[VL_EXPORT_LOSSES];
  uint32_t loss_count;
  vlFileSet files;
  char stem[200]; /* the scene's file name without suffix; names of further files start with it
                   */
  VL_ARRAY(vlExportImage) images;
  /* glTF */
  bool binary;
  json_t *root;
  vlBytes buffer;
  VL_ARRAY(vlExportLook) looks;
  /* pbrt */
  vlBytes text;
  double shutter;  /* seconds that it is open, to which pbrt's exposure is proportional */
  double times[2]; /* of all motions, seconds; both 0: nothing moves */
} vlExport;

/* ---- export.c ---------------------------------------------------------------------------- */

/* Counts a loss of this text. */
void vl_export_lose(vlExport *x, const char *format, ...) VL_PRINTF(2, 3);
/* Stores the error if it is the first one. Always returns false. */
bool vl_export_fail(vlExport *x, vlResult result, const char *format, ...) VL_PRINTF(3, 4);
/* Whether the shape is only a boundary between media: its material is "interface": light passes
 * it as if it were not there. In glTF and pbrt such a shape gives no light. */
bool vl_export_parts_media(const vlExport *x, const vlShapeDef *d);
/* Reports that memory is lacking. Always returns false. */
bool vl_export_no_memory(vlExport *x);
/* vl_alloc_array that reports it if there is no memory. */
void *vl_export_alloc(vlExport *x, size_t count, size_t size);
/* vl_file_read, with its error as that of the export. */
bool vl_export_read(vlExport *x, const char *path, char **data, size_t *size);
/* Append bytes, and text. */
void vl_bytes_put(vlContext *context, vlBytes *bytes, const void *data, size_t size);
void vl_bytes_print(vlContext *context, vlBytes *bytes, const char *format, ...)
    VL_PRINTF(3, 4);
/* Writes the scene file, which comes last: until then the earlier one and its files are as they
 * were. */
bool vl_export_main(vlExport *x, const void *data, size_t size);
/* Writes a file beside the scene file. No file is overwritten: where another has the name,
 * `name` becomes a free one ("room-2.bin"). A file that has these bytes already is taken as it
 * is. */
bool vl_export_data(vlExport *x, char name[300], const void *data, size_t size);
/* The camera as a file of the dialect. What the dialect cannot hold is left out and counted as
 * a loss: `lost`, or the dialect's message. The text stays empty where the dialect cannot hold
 * the camera at all. Returns false after an error. The caller frees text->text. */
bool vl_export_camera(vlExport *x, vlCameraDialect dialect, const vlCameraRecord *record,
                      const char *lost, vlCameraText *text);
/* Encodes an image in the format that the suffix names. */
bool vl_export_pack(vlExport *x, const vlImage *image, const char *suffix, char **data,
                    size_t *size);

/* ---- values.c ---------------------------------------------------------------------------- */

/* A light's spectrum in linear sRGB, divided by its luminance, as in the tracer. */
void vl_export_light_rgb(const vlSpectrum *s, float rgb[3]);
/* The input in linear sRGB, and an input's number. A textured input gives the mean of its
 * texture if that is easily computed. */
void vl_export_rgb(vlExport *x, const vlSpectrumInput *input, float rgb[3]);
float vl_export_number(vlExport *x, const vlFloatInput *input);
/* Whether the input is white everywhere; whether it is not 0 everywhere. */
bool vl_export_is_white(vlExport *x, const vlSpectrumInput *input);
bool vl_export_is_on(const vlFloatInput *input);
/* A metal's reflectance at normal incidence. */
void vl_export_metal_rgb(vlExport *x, const vlMaterialDef *m, float rgb[3]);
/* Index of refraction at 589 nm. */
float vl_export_eta(const vlSpectrum *eta);
/* The mean of the squares of an input: of an image over all its pixels. Principled materials
 * have alpha = roughness^2. */
float vl_export_mean_square(vlExport *x, const vlFloatInput *input);
/* GGX alpha from the roughness of a pbrt material. */
float vl_export_alpha(vlExport *x, const vlMaterialDef *m, const vlFloatInput *roughness);

/* ---- meshes.c ---------------------------------------------------------------------------- */

/* A shape as triangles. vl_export_free_mesh frees the blocks in `own`. The function returns
 * false when there is no mesh; it has then reported an error or counted a loss. */
typedef struct vlExportMesh {
  uint32_t vertices, faces;
  const float *positions, *normals, *tangents, *uvs[4], *colors, *signs;
  const uint32_t *indices;
  void *own[12];
} vlExportMesh;
bool vl_export_mesh(vlExport *x, const vlShapeDef *d, vlExportMesh *mesh);
void vl_export_free_mesh(vlExport *x, vlExportMesh *mesh);
/* Makes the uv sets 0 to `last` complete, for formats that require them. A mesh without uvs
 * gets those that velo's surfaces have by themselves, so that its faces no longer share
 * vertices; other missing sets equal set 0. */
bool vl_export_make_uvs(vlExport *x, const vlShapeDef *d, uint32_t last, vlExportMesh *mesh);
/* Counts as losses what the file lets one choose and what moves: formats hold the scene as it
 * was loaded. */
void vl_export_lose_choices(vlExport *x);

/* ---- glTF, pbrt -------------------------------------------------------------------------- */

bool vl_export_gltf(vlExport *x);
/* Appends bytes to the buffer and returns the index of their bufferView. target 0: the
 * bufferView has no target. */
json_int_t vl_gltf_put_view(vlExport *x, const void *data, size_t size, int target);
/* Appends to the array `key` of the root and returns the index. Takes ownership of value. */
json_int_t vl_gltf_put(vlExport *x, const char *key, json_t *value);
/* Appends a node, and its index to a list of nodes. Takes ownership of node. */
void vl_gltf_put_node(vlExport *x, json_t *list, json_t *node);
/* The object `key` of another one, which gets an empty one if it has none. */
json_t *vl_gltf_child(json_t *parent, const char *key);
/* Names an object, unless the name is null or empty. */
void vl_gltf_name(json_t *object, const char *name);
void vl_gltf_use(vlExport *x, const char *extension);
/* Adds an extension of the whole file. Takes ownership of value. */
void vl_gltf_put_extension(vlExport *x, const char *name, json_t *value);
/* A JSON array of numbers. */
json_t *vl_gltf_array_of(const float *values, size_t count);
/* Index of the shape's material in the glTF file; -1: none. */
json_int_t vl_gltf_put_material(vlExport *x, const vlShapeDef *d, bool *colors, bool *tangents);
/* A textureInfo object for an image; null: none. */
json_t *vl_gltf_texture_info(vlExport *x, const vlTextureDef *t, bool linear);
/* Writes an image file, of which these are the bytes. Returns its index in "images"; -1 after
 * an error. */
json_int_t vl_gltf_put_file(vlExport *x, const char *bytes, size_t size, const char *suffix);
bool vl_gltf_put_camera(vlExport *x, json_t *nodes, bool mirror);
bool vl_gltf_put_lights(vlExport *x, json_t *nodes);
/* Gives the scene the sum of the infinite lights. mirror: the nodes have a parent that mirrors
 * z. */
bool vl_gltf_put_environment(vlExport *x, json_t *scene, bool mirror);

bool vl_export_pbrt(vlExport *x);

#endif
