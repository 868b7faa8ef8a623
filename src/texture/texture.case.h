/* texture/texture.case.h: what the tests of textures must know of a kind beyond its row: its
 * values at points of a square with texture coordinates 0 to 1 (test/conformance/textures.h),
 * and cases of its parameters. */
#ifndef TEXTURE_TEXTURE_CASE_H
#define TEXTURE_TEXTURE_CASE_H

#include <stdbool.h>
#include <stdint.h>

#include "math/noise.case.h"
#include "schema/parameter.case.h"
#include "velo/texture.h"

/* The value at a point of the square: u, v from 0 to 1, before the mapping. Of a float texture
 * all three are the value. */
typedef struct TextureKnown {
  double u, v;
  double rgb[3];
} TextureKnown;

/* Where a texture is asked: uv, a place in texture space, and there the width of the ray. */
typedef struct TextureAt {
  double u, v, p[3], width;
  PlainNoise *noise;
} TextureAt;
typedef void TextureFormula(const TextureAt *at, double rgb[3]);

typedef struct TextureVariant {
  const char *parameters;  /* null ends the list */
  double low, high;        /* of all values */
  bool even;               /* the same value everywhere */
  bool of_space;           /* varies along each axis of texture space */
  bool filtered;           /* what wide rays see is about the mean over their footprint */
  TextureFormula *formula; /* its value everywhere, but on 2 % of the points (edges); null: not
                              known */
  TextureKnown known[5];   /* u = v = 0 ends the list */
} TextureVariant;

enum { TEXTURE_VARIANTS = 8 };
typedef struct TextureCase {
  TextureVariant variants[TEXTURE_VARIANTS];
  ParameterCase parameters[PARAMETER_CASES];
} TextureCase;

/* Declares the case of each kind, which is in the file of the kind: texture/NAME.case.c. */
#define TEXTURE_CASE(kind, name, ...) extern const TextureCase name##_texture;
VL_TEXTURE_KINDS(TEXTURE_CASE)
#undef TEXTURE_CASE

#endif
