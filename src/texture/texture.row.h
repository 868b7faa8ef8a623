/* texture/texture.row.h: for the files that hold rows of textures: parameters by type, and
 * those that several kinds share. Names in files and defaults are pbrt-v4's. */
#ifndef TEXTURE_TEXTURE_ROW_H
#define TEXTURE_TEXTURE_ROW_H

#include "schema/schema.h"
#include "velo/texture.h"

/* Declares the row of each kind, which is in the file of the kind: texture/NAME.row.c. */
#define DECLARE(kind, name, row, ...) extern const vlKindRow row;
VL_TEXTURE_KINDS(DECLARE)
#undef DECLARE
/* Defines a row; one of a kind that is not in the list does not compile. */
#define VL_TEXTURE_ROW(row) const __typeof__(row) row

#define BOOL(...) VL_PARAMETER(BOOL, vlTextureDef, __VA_ARGS__)
#define COUNT(...) VL_PARAMETER(COUNT, vlTextureDef, __VA_ARGS__)
#define FLOAT(...) VL_PARAMETER(FLOAT, vlTextureDef, __VA_ARGS__)
#define DOUBLE(...) VL_PARAMETER(DOUBLE, vlTextureDef, __VA_ARGS__)
#define VECTOR(...) \
  VL_PARAMETER(FLOAT3, vlTextureDef, __VA_ARGS__, .flags = VL_PARAMETER_VECTOR)
#define CHOICE(...) VL_PARAMETER(CHOICE, vlTextureDef, __VA_ARGS__)
#define FILE_NAME(...) VL_PARAMETER(FILE, vlTextureDef, __VA_ARGS__)
#define NUMBER(...) VL_PARAMETER(FLOAT_INPUT, vlTextureDef, __VA_ARGS__)
#define BLOCK(...) VL_PARAMETER(BLOCK, vlTextureDef, __VA_ARGS__)
/* An input of the texture's own type; half: a, b, c or d. */
#define INPUT(name, half, text, value)                                                  \
  VL_PARAMETER(EITHER_INPUT, vlTextureDef, name, float_##half, text, VL_DEFAULT(value), \
               VL_SECOND(vlTextureDef, spectrum_##half))

/* Words of parameters; null at the end. */
extern const char *const vl_texture_mappings[];
extern const char *const vl_texture_wraps[];
extern const char *const vl_texture_filters[];

/* Parameters that several kinds share. */
#define TRANSFORM \
  BLOCK(NULL, texture_from_world, "4 x 4 matrix, row-major, from world space to texture space")
#define MAPPING                                                                          \
  CHOICE("mapping", mapping,                                                             \
         "how the texture coordinates (s, t) follow from the surface point",             \
         .choices = vl_texture_mappings),                                                \
      FLOAT("uscale", su, "mapping uv: s = uscale * u + udelta", VL_DEFAULT(1)),         \
      FLOAT("vscale", sv, "mapping uv: t = vscale * v + vdelta", VL_DEFAULT(1)),         \
      FLOAT("udelta", du, "mappings uv and planar: offset of s", VL_DEFAULT(0)),         \
      FLOAT("vdelta", dv, "mappings uv and planar: offset of t", VL_DEFAULT(0)),         \
      VECTOR("v1", planar_v1, "mapping planar: s = v1 . p + udelta, p in texture space", \
             VL_DEFAULT(1, 0, 0)),                                                       \
      VECTOR("v2", planar_v2, "mapping planar: t = v2 . p + vdelta, p in texture space", \
             VL_DEFAULT(0, 1, 0)),                                                       \
      TRANSFORM,                                                                         \
      COUNT(NULL, uv_set, "number of the uv set, for triangles that have several",       \
            VL_RANGE(0, 3)),                                                             \
      BOOL(NULL, st_from_uv_given, "true: st_from_uv replaces su, sv, du and dv"),       \
      BLOCK(NULL, st_from_uv,                                                            \
            "2 x 3 matrix, row-major: (s, t) is this matrix times (u, v, 1)")
#define OCTAVES                                                                          \
  COUNT("octaves", octaves, "number of octaves of noise that are summed", VL_DEFAULT(8), \
        VL_RANGE(0, 64), .flags = VL_PARAMETER_CLAMPED),                                 \
      FLOAT("roughness", omega, "amplitude of each octave, relative to the one before",  \
            VL_DEFAULT(0.5)),                                                            \
      TRANSFORM
/* The parameters that follow filter, scale and invert. */
#define CHANNELS                                                                               \
  BLOCK(NULL, tint, "factors on R, G, B and alpha"),                                           \
      BOOL(NULL, colors, "true: multiply by the colours of the shape's vertices"),             \
      BLOCK(NULL, channel,                                                                     \
            "channel that a float texture reads: 0 to 3, or -1: the mean of the colours, or "  \
            "alpha, by the image"),                                                            \
      FLOAT(NULL, bias, "number added to the value of a float texture", VL_DEFAULT(0)),        \
      DOUBLE(NULL, cutoff,                                                                     \
             "a float texture becomes 1 where its value is at least the cutoff, otherwise 0; " \
             "unset: not changed",                                                             \
             .flags = VL_PARAMETER_UNSET)

#endif
