/* world/texture/texture.h: compiled textures: a flat list of nodes, inputs by index (always lower than the node's own).
 * Spectra are compiled for the place they stand in: an RGB albedo is another spectrum than an RGB illuminant. */
#ifndef WORLD_TEXTURE_TEXTURE_H
#define WORLD_TEXTURE_TEXTURE_H

#include "color/color.h"
#include "image/mipmap.h"

/* A constant spectrum, ready for 4 channels. In RGB mode kind is always VL_SPECTRAL_RGB. */
typedef enum vlSpectralKind {
  VL_SPECTRAL_CONSTANT,
  VL_SPECTRAL_SIGMOID,
  VL_SPECTRAL_DENSE,
  VL_SPECTRAL_RGB
} vlSpectralKind;
typedef struct vlSpectral {
  vlSpectralKind kind;
  float scale; /* factor on all kinds */
  vlSigmoid sigmoid;
  const float *dense; /* VL_LAMBDA_COUNT */
  float rgb[3];
} vlSpectral;

/* At one channel, whose wavelength is lambda (nm; not read in RGB mode). */
static inline float vl_spectral_at(const vlSpectral *s, int channel, float lambda) {
  switch (s->kind) {
    case VL_SPECTRAL_SIGMOID: return s->scale * vl_sigmoid(s->sigmoid, lambda);
    case VL_SPECTRAL_DENSE: return s->scale * vl_dense_at(s->dense, lambda);
    case VL_SPECTRAL_RGB: return channel < 3 ? s->scale * s->rgb[channel] : 0.0f;
    case VL_SPECTRAL_CONSTANT: break;
  }
  return s->scale;
}

/* Scratch rows that a texture may need while it is evaluated over a batch (trace/texture/texture.hot.c), and how many
 * nodes may be visited for it (inputs that are shared are evaluated each time): these bound nesting. */
enum { VL_NODE_ROWS = 64, VL_NODE_VISITS = 4096 };

typedef enum vlNodeKind {
  VL_NODE_FLOAT,
  VL_NODE_SPECTRUM,
  VL_NODE_SCALE,
  VL_NODE_MIX,
  VL_NODE_CHECKERBOARD,
  VL_NODE_IMAGE,
  VL_NODE_DIRECTION_MIX,
  VL_NODE_BILERP,
  VL_NODE_VERTEX_COLOR,
  VL_NODE_FBM,
  VL_NODE_WRINKLED,
  VL_NODE_WINDY,
  VL_NODE_MARBLE,
  VL_NODE_DOTS
} vlNodeKind;

typedef struct vlTextureNode {
  vlNodeKind kind;
  bool is_spectrum;
  uint8_t rows; /* scratch rows that its evaluation needs, inputs included */
  uint16_t visits;
  vlSpectrumRole role;
  float value;                /* VL_NODE_FLOAT */
  vlSpectral spectrum;        /* VL_NODE_SPECTRUM; VL_NODE_IMAGE: dense = illuminant of the space for that role */
  int32_t a, b, c, d, amount; /* inputs, -1 none */
  float direction[3];
  uint32_t dimension, octaves;
  float omega, variation; /* noise */
  int32_t image;
  vlWrap wrap, wrap_t;
  vlTextureFilter filter;
  float scale;
  bool invert;
  /* tint, bias, cutoff or vertex colours do something; channel of a float texture, -1: by the image */
  bool plain, colors;
  int8_t channel;
  uint8_t uv_set;
  float tint[4], bias, cutoff; /* cutoff NaN: none */
  vlColorSpace space;
  vlMapping mapping;
  bool st_given; /* s, t by st instead of su, sv, du, dv */
  float su, sv, du, dv;
  float st[6], st_scale; /* st_scale: the longest that a unit of uv becomes */
  float v1[3], v2[3];
  float texture_from_world[12];
} vlTextureNode;

typedef struct vlWorldImage {
  vlMipmap *mipmap;
  const char *path; /* with the choices that change the pixels, for reading each file once; or */
  const void *data; /* the file in memory */
  vlEncoding encoding;
  bool encoding_given;
  float gamma;
} vlWorldImage;

struct vlWorld;
/* What push gives when memory is out. */
enum { VL_TEXTURE_NO_MEMORY = -2 };
/* Compiles a spectrum for its role; errors as vl_spectrum_dense. */
vlResult vl_spectral_compile(struct vlWorld *world, const vlSpectrum *spectrum, vlSpectrumRole role, vlSpectral *result,
                             vlError *error);
/* A point of a triangle, for what its corners carry. */
typedef struct vlTextureCorner {
  const struct vlWorldShape *shape;
  uint32_t prim;
  float weights[3];
} vlTextureCorner;
/* Where a float texture is wanted at one point: the first uv set, position, geometric normal (of any length, either
 * side), all in the space of the shape's group; for shapes outside of groups that is the world. corner: null where the
 * shape has no triangles. */
typedef struct vlTextureQuery {
  float u, v;
  vlVec3 p, n;
  const vlTextureCorner *corner;
} vlTextureQuery;
/* A float texture at one point: alpha, the amount of mixed materials, displacement. Unfiltered; else the same bits as
 * vl_texture_float over a batch. */
float vl_texture_float_at(const struct vlWorld *world, int32_t node, const vlTextureQuery *query);

#endif
