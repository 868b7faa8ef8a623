/* texture/node.h: compiled textures: a flat list of nodes, and the points at which they are
 * evaluated. A node refers to its inputs by index, and these indices are always lower than its
 * own. Spectra are compiled for their role:
 * an RGB colour gives different spectra as an albedo and as an illuminant. */
#ifndef TEXTURE_NODE_H
#define TEXTURE_NODE_H

#include "base/file_stamp.h"
#include "color/color.h"
#include "image/mipmap.h"
#include "math/approx.h"
#include "math/vec.h"
#include "velo/lookup.h"
#include "velo/world.h"

/* A constant spectrum, ready for 4 channels. In RGB mode kind is always VL_SPECTRAL_RGB. */
typedef enum vlSpectralKind {
  VL_SPECTRAL_CONSTANT,
  VL_SPECTRAL_SIGMOID,
  VL_SPECTRAL_DENSE,
  VL_SPECTRAL_RGB
} vlSpectralKind;
typedef struct vlSpectral {
  vlSpectralKind kind;
  float scale; /* factor for spectra of all kinds */
  vlSigmoid sigmoid;
  const float *dense; /* VL_LAMBDA_COUNT values, one per wavelength */
  float rgb[3];       /* linear sRGB; of the kinds constant, sigmoid and RGB */
} vlSpectral;

/* Value of the spectrum at one channel. lambda: the channel's wavelength in nm; not read in RGB
 * mode. */
static inline float vl_spectral_at(const vlSpectral *s, int channel, float lambda) {
  switch (s->kind) {
    case VL_SPECTRAL_SIGMOID:
      return s->scale * vl_sigmoid(s->sigmoid, lambda);
    case VL_SPECTRAL_DENSE:
      return s->scale * vl_dense_at(s->dense, lambda);
    case VL_SPECTRAL_RGB:
      return channel < 3 ? s->scale * s->rgb[channel] : 0.0f;
    case VL_SPECTRAL_CONSTANT:
      break;
  }
  return s->scale;
}

/* Limits per texture, which bound the nesting of textures: the number of scratch rows for
 * evaluation over a batch (texture/batch.hot.c), and the number of nodes visited (a shared
 * input counts each time it is evaluated). */
enum { VL_NODE_ROWS = 64, VL_NODE_VISITS = 4096 };

typedef struct vlTextureNode {
  uint32_t kind; /* vlTextureKind. VL_TEXTURE_CONSTANT: a number or, of colours, a spectrum */
  bool is_spectrum;
  uint8_t rows; /* number of scratch rows for evaluation of the node and its inputs */
  uint16_t visits;
  vlSpectrumRole role;
  float value;                /* of a constant number */
  vlSpectral spectrum;        /* of a constant spectrum; of VL_TEXTURE_IMAGE for the role of an
                                 illuminant: dense is the colour space's illuminant */
  int32_t a, b, c, d, amount; /* node indices of the inputs; -1: none */
  const struct vlTextureDef *def; /* the numbers that some kinds alone have; without its
                                     inputs, names and data. Null: the texture has no def */
  int32_t image;                  /* index in world->images; -1: the node has no image */
  uint32_t wrap, wrap_t;          /* vlWrap */
  uint32_t filter;                /* vlTextureFilter */
  float scale;
  bool invert;
  /* plain: tint, bias, cutoff and vertex colours have no effect. channel: the channel that a
   * float texture reads; -1: the image's channels determine it. */
  bool plain, colors;
  int8_t channel;
  uint8_t uv_set;
  float tint[4], bias, cutoff; /* cutoff is NaN if there is none */
  vlColorSpace space;
  vlSrgbMap to_srgb; /* in RGB mode, of nodes that give colours of the space */
  uint32_t mapping;  /* vlMapping */
  bool st_given;     /* the map st gives s and t, instead of su, sv, du, dv */
  float su, sv, du, dv;
  float st[6]; /* map from uv to (s, t) */
  float v1[3], v2[3];
  float texture_from_world[12];
} vlTextureNode;

/* Whether the node reads more than the first uv set. */
static inline bool vl_texture_needs_corner(const vlTextureNode *node) {
  return node->uv_set != 0 || node->colors;
}

/* ---- where a node is evaluated (pbrt book 10.2) ------------------------------------------ */

/* A point at which a texture is evaluated: uv, position and normal in world space, and the
 * footprint. The footprint has a width in world units and, for image lookups, the two axes of
 * an ellipse in (s, t). color: interpolated vertex colour, read only by nodes that use it. */
typedef struct vlTexturePoint {
  float u, v;
  vlVec3 p, n;
  float width;
  float axes[4]; /* (s, t) of the first axis, then of the second axis; full lengths */
  float color[4];
} vlTexturePoint;

static inline vlVec3 vl_texture_space(const vlTextureNode *node, vlVec3 p) {
  return vl_affine_point(node->texture_from_world, p);
}

/* Texture coordinates of the point. */
static inline vlVec2 vl_texture_st(const vlTextureNode *node, vlTexturePoint at) {
  if (node->st_given)
    return (vlVec2){node->st[0] * at.u + node->st[1] * at.v + node->st[2],
                    node->st[3] * at.u + node->st[4] * at.v + node->st[5]};
  if (node->mapping == VL_MAPPING_UV)
    return (vlVec2){node->su * at.u + node->du, node->sv * at.v + node->dv};
  vlVec3 q = vl_texture_space(node, at.p);
  if (node->mapping == VL_MAPPING_PLANAR)
    return (vlVec2){node->du + q.x * node->v1[0] + q.y * node->v1[1] + q.z * node->v1[2],
                    node->dv + q.x * node->v2[0] + q.y * node->v2[1] + q.z * node->v2[2]};
  float phi = vl_atan2(q.y, q.x);
  if (node->mapping == VL_MAPPING_CYLINDRICAL)
    return (vlVec2){(VL_PI + phi) * (0.5f * VL_INV_PI), q.z};
  phi = phi < 0 ? phi + 2 * VL_PI : phi;
  vlVec3 d = vl_normalize(q);
  return (vlVec2){vl_acos(vl_clamp(d.z, -1, 1)) * VL_INV_PI, phi * (0.5f * VL_INV_PI)};
}

/* ---- the images of a world --------------------------------------------------------------- */

/* What tells whether an image is that of an earlier build: from which bytes it was made, and
 * how. */
typedef struct vlImageKey {
  vlFileStamp stamp;  /* of a file; `there` is false for bytes in memory */
  uint64_t size;      /* number of bytes in memory */
  uint64_t owner;     /* of bytes in memory: their number in the scene; 0: not known */
  uint8_t digest[16]; /* of bytes in memory */
  bool pyramid, encoding_given;
  vlEncoding encoding;
  float gamma;
} vlImageKey;

struct vlPart;
typedef struct vlWorldImage {
  vlMipmap *mipmap;
  struct vlPart *part; /* owns the mipmap */
  vlImageKey key;
  const char *path; /* path and the options that change the pixels, so that each file is read
                       once; or null */
  const void *data; /* the image file in memory, if path is null */
  vlEncoding encoding;
  bool encoding_given;
  float gamma;
} vlWorldImage;

/* ---- compiling, and evaluation at one point ---------------------------------------------- */

struct vlWorld;
/* What functions that add a node return when memory is exhausted. */
enum { VL_TEXTURE_NO_MEMORY = -2 };
/* Compiles a spectrum for its role; errors as for vl_spectrum_dense. */
vlResult vl_spectral_compile(struct vlWorld *world, const vlSpectrum *spectrum,
                             vlSpectrumRole role, vlSpectral *result, vlError *error);
/* Whether all colours of a spectrum node are linear sRGB, and at least one of them is not a
 * constant grey. */
bool vl_node_has_rgb_colors(const struct vlWorld *world, int32_t node);
/* A point of a triangle, for interpolating vertex attributes. */
typedef struct vlTextureCorner {
  const struct vlWorldShape *shape;
  uint32_t prim;
  float weights[3];
} vlTextureCorner;
/* A point at which a float texture is evaluated: its first uv set, position and geometric
 * normal (of any length, on either side). Position and normal are in the space of the shape's
 * group (world space for shapes outside of groups). corner is null if the shape has no
 * triangles. */
typedef struct vlTextureQuery {
  float u, v;
  vlVec3 p, n;
  const vlTextureCorner *corner;
} vlTextureQuery;
/* Evaluates a float texture at one point, for alpha, mix amounts and displacement. It does not
 * filter images; apart from that it gives the same bits as vl_texture_float over a batch. */
float vl_texture_float_at(const struct vlWorld *world, int32_t node,
                          const vlTextureQuery *query);

#endif
