/** @file
 * velo/lookup.h: how a texture is looked up: texture coordinates, wrapping and interpolation of
 * images. */
#ifndef VELO_LOOKUP_H
#define VELO_LOOKUP_H

#ifdef __cplusplus
extern "C" {
#endif

/** The value of an image outside the unit square. REPEAT: the image is repeated. BLACK: 0.
 * CLAMP: the value of the nearest edge. OCTAHEDRAL: the wrapping of an octahedral map. MIRROR:
 * the image is repeated and mirrored. */
typedef enum vlWrap {
  VL_WRAP_REPEAT,
  VL_WRAP_BLACK,
  VL_WRAP_CLAMP,
  VL_WRAP_OCTAHEDRAL,
  VL_WRAP_MIRROR
} vlWrap;
/** Interpolation of images. */
typedef enum vlTextureFilter {
  VL_FILTER_POINT,     /**< nearest texel of the level that fits the footprint */
  VL_FILTER_BILINEAR,  /**< between four texels of the finer level */
  VL_FILTER_TRILINEAR, /**< bilinear on two levels, and linear between them */
  VL_FILTER_EWA /**< treated as trilinear; the taps follow the longer axis of the footprint */
} vlTextureFilter;
/** The map from a surface point to (s, t) (pbrt book 10.2). */
typedef enum vlMapping {
  VL_MAPPING_UV,
  VL_MAPPING_SPHERICAL,
  VL_MAPPING_CYLINDRICAL,
  VL_MAPPING_PLANAR
} vlMapping;

#ifdef __cplusplus
}
#endif
#endif
