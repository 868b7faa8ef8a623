/** @file
 * velo/lookup.h: how a texture is looked up: texture coordinates, wrapping and interpolation of
 * images. */
#ifndef VELO_LOOKUP_H
#define VELO_LOOKUP_H

#ifdef __cplusplus
extern "C" {
#endif

/** The value of an image outside the unit square. REPEAT: the image is repeated. BLACK: 0.
 * CLAMP: that of the nearest edge. OCTAHEDRAL: the square's edges fold onto themselves (pbrt
 * book 3.8.3). MIRROR: the image is repeated and mirrored. */
typedef enum vlWrap {
  VL_WRAP_REPEAT,
  VL_WRAP_BLACK,
  VL_WRAP_CLAMP,
  VL_WRAP_OCTAHEDRAL,
  VL_WRAP_MIRROR
} vlWrap;
/** Interpolation of images. All but POINT take taps along the footprint's longer axis. */
typedef enum vlTextureFilter {
  VL_FILTER_POINT,     /**< nearest texel of the level that fits the footprint */
  VL_FILTER_BILINEAR,  /**< between four texels of the finer level */
  VL_FILTER_TRILINEAR, /**< bilinear on two levels, and linear between them */
  VL_FILTER_EWA        /**< as trilinear */
} vlTextureFilter;
/** The map from a surface point to (s, t) (pbrt book 10.2). */
typedef enum vlMapping {
  VL_MAPPING_UV,          /**< from the surface's u, v */
  VL_MAPPING_SPHERICAL,   /**< s: half turns from texture space's z axis; t: turns around it */
  VL_MAPPING_CYLINDRICAL, /**< s: turns around texture space's z axis; t: z */
  VL_MAPPING_PLANAR       /**< s, t: dot products with two vectors, plus offsets */
} vlMapping;

#ifdef __cplusplus
}
#endif
#endif
