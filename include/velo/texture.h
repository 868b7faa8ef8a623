/** @file
 * velo/texture.h: textures: their kinds, and the def with their parameters. */
#ifndef VELO_TEXTURE_H
#define VELO_TEXTURE_H

#include "velo/image.h"
#include "velo/lookup.h"
#include "velo/spectrum.h"

#ifdef __cplusplus
extern "C" {
#endif

/** X(kind, name, row, gives, function) for each kind of texture. velo/schema.h describes the
 * kinds and their parameters. function: how a compiled texture is evaluated at a point. It
 * gives FLOAT: a number; COLOR: linear RGB; SHARE: the weight of the second of two inputs,
 * which are numbers or spectra. OTHER: the evaluators have code for the kind. */
#define VL_TEXTURE_KINDS(X)                                                                \
  X(VL_TEXTURE_CONSTANT, constant, vl_texture_row_constant, OTHER, NULL)                   \
  X(VL_TEXTURE_SCALE, scale, vl_texture_row_scale, OTHER, vl_node_scale)                   \
  X(VL_TEXTURE_MIX, mix, vl_texture_row_mix, OTHER, vl_node_mix)                           \
  X(VL_TEXTURE_CHECKERBOARD, checkerboard, vl_texture_row_checkerboard, SHARE,             \
    vl_node_checkerboard)                                                                  \
  X(VL_TEXTURE_IMAGE, image, vl_texture_row_image, OTHER, vl_node_image_rgb)               \
  X(VL_TEXTURE_DIRECTION_MIX, direction_mix, vl_texture_row_direction_mix, SHARE,          \
    vl_node_direction_mix)                                                                 \
  X(VL_TEXTURE_BILERP, bilerp, vl_texture_row_bilerp, OTHER, vl_node_bilerp)               \
  X(VL_TEXTURE_FBM, fbm, vl_texture_row_fbm, FLOAT,                                        \
    vl_node_fbm) /* float: octaves of noise in texture space (texture_from_world) */       \
  X(VL_TEXTURE_WRINKLED, wrinkled, vl_texture_row_wrinkled, FLOAT,                         \
    vl_node_wrinkled) /* float: octaves of the noise's absolute value */                   \
  X(VL_TEXTURE_WINDY, windy, vl_texture_row_windy, FLOAT,                                  \
    vl_node_windy) /* float: wind waves; octaves and roughness are fixed */                \
  X(VL_TEXTURE_MARBLE, marble, vl_texture_row_marble, COLOR,                               \
    vl_node_marble) /* colour: veins with a scale and a variation */                       \
  X(VL_TEXTURE_DOTS, dots, vl_texture_row_dots, SHARE,                                     \
    vl_node_dots) /* b in the dots, a between them */                                      \
  X(VL_TEXTURE_VERTEX_COLOR, vertex_color, vl_texture_row_vertex_color, OTHER,             \
    vl_node_vertex_color_rgb) /* the shape's vertex colours; has an image's tint, channel, \
                                 bias, cutoff */
/** The kinds of textures: VL_TEXTURE_CONSTANT and so on, from VL_TEXTURE_KINDS. */
typedef enum vlTextureKind {
#define VL_KIND(kind, ...) kind,
  VL_TEXTURE_KINDS(VL_KIND)
#undef VL_KIND
} vlTextureKind;

/** Traits of kinds of textures (vlKindRow.traits). */
enum {
  VL_TEXTURE_FLOAT_ONLY = 1, /**< there is no colour texture of the kind */
  VL_TEXTURE_COLOR_ONLY = 2  /**< there is no float texture of the kind */
};
/** A texture: a number or a spectrum for each point of a surface. */
struct vlTextureDef {
  uint32_t cookie;
  const char *name;   /**< for messages; may be null */
  vlSource source;    /**< where the file describes it */
  vlTextureKind kind; /**< which fields below are read */
  bool spectrum; /**< true: a colour texture, which reads the inputs spectrum_*; false: a float
                    texture, which reads float_* */
  /** Inputs of a float texture. Constant: a is the value. Scale reads a. Mix, checkerboard and
   * dots read a and b. Bilerp reads a to d as v00, v01, v10, v11. */
  vlFloatInput float_a, float_b, float_c, float_d;
  /** the same inputs of a colour texture */
  vlSpectrumInput spectrum_a, spectrum_b, spectrum_c, spectrum_d;
  vlFloatInput amount; /**< scale: the factor; mix: share of b */
  float direction[3];  /**< direction mix: its direction */
  uint32_t dimension;  /**< checkerboard: 2 (s and t of the mapping) or 3 (unit cubes in texture
                          space) */
  uint32_t octaves;    /**< noise: number of octaves, at most 64; default 8 */
  float omega;         /**< noise: amplitude of each octave relative to the previous one (pbrt's
                          "roughness"); default 0.5 */
  float variation;     /**< marble: strength of the variation; default 0.2 */
  /** image: path of a file, read when the world is built (once per path); or */
  const char *path;
  const vlImage *image;   /**< image: an image in memory, copied; or */
  const void *data;       /**< image: an image file in memory, copied */
  size_t data_size;       /**< length of data, bytes */
  vlWrap wrap;            /**< wrapping of s, and of t unless wrap_t_given */
  bool wrap_t_given;      /**< wrap_t is read */
  vlWrap wrap_t;          /**< wrapping of t */
  vlTextureFilter filter; /**< interpolation */
  bool encoding_given;    /**< encoding and gamma are read; else the file's own encoding is used
                             (8-bit files: sRGB) */
  vlEncoding encoding;    /**< encoding of the file's integers */
  float gamma;            /**< for VL_ENCODING_GAMMA */
  float scale;            /**< factor on image values; marble: on positions */
  bool invert;            /**< the value becomes 1 - value, after scale */
  /** Image and vertex colour: factors on R, G, B and coverage, applied after filter, scale and
   * invert. */
  float tint[4];
  bool colors; /**< also multiply by the shape's vertex colours */
  /** The channel that a float texture reads. 0 to 3: R, G, B or coverage, which is 1 if the
   * image has none. -1: the mean of the colours or the coverage, depending on the image. */
  int channel;
  float bias;    /**< added to a float texture's channel */
  double cutoff; /**< a float texture's value becomes 1 if it is at least the cutoff, else 0;
                    unset: it is not changed */
  vlColorSpace space; /**< colour space of the image's colours */
  vlMapping mapping;  /**< UV: (s, t) = (su u + du, sv v + dv); the other mappings use the point
                         in texture space */
  float su, sv, du, dv;             /**< scale and offset of uv; planar: offsets du, dv */
  float planar_v1[3], planar_v2[3]; /**< planar: s and t are the dot products of the point in
                                       texture space with these vectors */
  double texture_from_world[16];    /**< world space to texture space */
  uint32_t uv_set;       /**< number of the uv set, 0 to 3, for triangles with several sets */
  bool st_from_uv_given; /**< st_from_uv replaces su, sv, du, dv */
  float st_from_uv[6];   /**< (s, t) = this 2 x 3 row-major matrix times (u, v, 1) */
};
/** The default def of a kind. spectrum: true for a colour texture, false for a float texture.
 */
VL_API vlTextureDef vl_default_texture_def(vlTextureKind kind, bool spectrum);
/** Adds a texture. Its inputs must have been added before. Returns index 0 on error
 * (vl_scene_result). */
VL_API vlTextureId vl_scene_add_texture(vlScene *scene, const vlTextureDef *def);

#ifdef __cplusplus
}
#endif
#endif
