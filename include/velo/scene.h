/** @file
 * velo/scene.h: the editable description of a world. A scene file or a program adds textures, materials, media, lights
 * and shapes to it; everything is copied. A scene keeps its first error: from then on every vl_scene_add_* returns an
 * id of index 0, and vl_scene_result returns the error. A scene is not thread-safe. */
#ifndef VELO_SCENE_H
#define VELO_SCENE_H

#include "velo/base.h"
#include "velo/camera.h"
#include "velo/image.h"

#ifdef __cplusplus
extern "C" {
#endif

/** The description of a world and of how its image is taken. Made from a context, which must outlive it. */
typedef struct vlScene vlScene;

/** Id of a texture. The rules for all ids: index 0 means none, the first object has index 1, and an id is valid in its
 * own scene only. */
typedef struct vlTextureId {
  uint32_t index; /**< from 1; 0: none */
} vlTextureId;
/** Id of a material. */
typedef struct vlMaterialId {
  uint32_t index; /**< from 1; 0: none */
} vlMaterialId;
/** Id of an emission. */
typedef struct vlEmissionId {
  uint32_t index; /**< from 1; 0: none */
} vlEmissionId;
/** Id of a light. */
typedef struct vlLightId {
  uint32_t index; /**< from 1; 0: none */
} vlLightId;
/** Id of a shape. */
typedef struct vlShapeId {
  uint32_t index; /**< from 1; 0: none */
} vlShapeId;
/** Id of a group of shapes. */
typedef struct vlGroupId {
  uint32_t index; /**< from 1; 0: the world itself */
} vlGroupId;
/** Id of an instance. */
typedef struct vlInstanceId {
  uint32_t index; /**< from 1; 0: none */
} vlInstanceId;
/** Id of a participating medium. */
typedef struct vlMediumId {
  uint32_t index; /**< from 1; 0: vacuum */
} vlMediumId;

/** A place in a file, which later errors refer to. `file` is copied. */
typedef struct vlSource {
  const char *file;      /**< path; may be null */
  uint32_t line, column; /**< from 1; 0: not known */
} vlSource;

/** What a file calls a shape, a material or an instance, for ids and messages. Every member may be null. */
typedef struct vlLabel {
  const char *name;  /**< short; the importers give no two shapes, materials or instances of a file the same */
  const char *path;  /**< all names that apply, from the root down, with / between: nodes, mesh, material */
  const char *place; /**< indices in a file without lines: nodes[3].meshes[1].primitives[0] */
} vlLabel;

/** Colour spaces of RGB values, all linear: sRGB (Rec. 709), DCI-P3, Rec. 2020, ACES 2065-1. */
typedef enum vlColorSpace { VL_SPACE_SRGB, VL_SPACE_DCI_P3, VL_SPACE_REC2020, VL_SPACE_ACES2065_1 } vlColorSpace;

/** How a spectrum is given. */
typedef enum vlSpectrumKind {
  VL_SPECTRUM_CONSTANT, /**< `value` at every wavelength */
  VL_SPECTRUM_RGB, /**< `rgb` in `space`; the role of the parameter (vlParameterRole) decides how it becomes a spectrum
                    */
  VL_SPECTRUM_BLACKBODY, /**< a black body at `kelvin`, normalised to maximum 1 */
  VL_SPECTRUM_SAMPLED,   /**< `count` pairs of wavelength and value: linear between them, 0 outside */
  VL_SPECTRUM_NAMED      /**< `name`: "metal-Au-eta", "glass-BK7", "stdillum-D65", ... (vl_spectrum_name) */
} vlSpectrumKind;
/** A spectrum by value. Only `scale` and the fields of the kind are read. */
typedef struct vlSpectrum {
  vlSpectrumKind kind;               /**< which fields below are read */
  float scale;                       /**< factor on all values */
  float value;                       /**< CONSTANT */
  float rgb[3];                      /**< RGB: linear */
  vlColorSpace space;                /**< RGB: the colour space */
  float kelvin;                      /**< BLACKBODY: temperature */
  uint32_t count;                    /**< SAMPLED: number of pairs */
  const float *wavelengths, *values; /**< SAMPLED: wavelengths in nm, ascending, and the values at them */
  const char *name;                  /**< NAMED */
} vlSpectrum;
/** The same value at every wavelength. */
VL_API vlSpectrum vl_spectrum_constant(float value);
/** A linear sRGB colour. */
VL_API vlSpectrum vl_spectrum_rgb(float r, float g, float b);
/** A black body at this temperature, in kelvin, normalised to maximum 1. */
VL_API vlSpectrum vl_spectrum_blackbody(float kelvin);
/** One of the library's named spectra; the string must stay valid until a def with this spectrum is added. */
VL_API vlSpectrum vl_spectrum_named(const char *name);
/** Name `index`, from 0, of the library's spectra; null past the end. Constant strings. */
VL_API const char *vl_spectrum_name(uint32_t index);

/** A number that may be textured. */
typedef struct vlFloatInput {
  vlTextureId texture; /**< a float texture; index 0: none */
  float value;         /**< used without a texture */
} vlFloatInput;
/** A spectrum that may be textured. */
typedef struct vlSpectrumInput {
  vlTextureId texture; /**< a colour texture; index 0: none */
  vlSpectrum value;    /**< used without a texture */
} vlSpectrumInput;
/** A number without a texture. */
VL_API vlFloatInput vl_float_input(float value);
/** A spectrum without a texture. */
VL_API vlSpectrumInput vl_spectrum_input(vlSpectrum value);

/* ---- textures -------------------------------------------------------------------------------------------------- */

/** X(NAME, name) for each kind of texture. velo/schema.h describes the kinds and their parameters. */
#define VL_TEXTURE_KINDS(X)                                                                         \
  X(CONSTANT, constant)                                                                             \
  X(SCALE, scale)                                                                                   \
  X(MIX, mix)                                                                                       \
  X(CHECKERBOARD, checkerboard)                                                                     \
  X(IMAGE, image)                                                                                   \
  X(DIRECTION_MIX, direction_mix)                                                                   \
  X(BILERP, bilerp)                                                                                 \
  X(FBM, fbm)                   /* float: octaves of noise in texture space (texture_from_world) */ \
  X(WRINKLED, wrinkled)         /* float: octaves of the noise's absolute value */                  \
  X(WINDY, windy)               /* float: wind waves; octaves and roughness are fixed */            \
  X(MARBLE, marble)             /* colour: veins with a scale and a variation */                    \
  X(DOTS, dots)                 /* b in the dots, a between them */                                 \
  X(VERTEX_COLOR, vertex_color) /* the shape's vertex colours; has an image's tint, channel, bias, cutoff */
/** The kinds of textures: VL_TEXTURE_CONSTANT and so on, from VL_TEXTURE_KINDS. */
typedef enum vlTextureKind {
#define VL_KIND(NAME, name) VL_TEXTURE_##NAME,
  VL_TEXTURE_KINDS(VL_KIND)
#undef VL_KIND
} vlTextureKind;

/** Traits of kinds of textures (vlKindRow.traits). */
enum {
  VL_TEXTURE_FLOAT_ONLY = 1, /**< there is no colour texture of the kind */
  VL_TEXTURE_COLOR_ONLY = 2  /**< there is no float texture of the kind */
};
/** The value of an image outside the unit square. REPEAT: the image is repeated. BLACK: 0. CLAMP: the value of the
 * nearest edge. OCTAHEDRAL: the wrapping of an octahedral map. MIRROR: the image is repeated and mirrored. */
typedef enum vlWrap { VL_WRAP_REPEAT, VL_WRAP_BLACK, VL_WRAP_CLAMP, VL_WRAP_OCTAHEDRAL, VL_WRAP_MIRROR } vlWrap;
/** Interpolation of images. */
typedef enum vlTextureFilter {
  VL_FILTER_POINT,     /**< nearest texel of the level that fits the footprint */
  VL_FILTER_BILINEAR,  /**< between four texels of the finer level */
  VL_FILTER_TRILINEAR, /**< bilinear on two levels, and linear between them */
  VL_FILTER_EWA        /**< treated as trilinear; the taps follow the longer axis of the footprint */
} vlTextureFilter;
/** The map from a surface point to (s, t) (pbrt book 10.2). */
typedef enum vlMapping { VL_MAPPING_UV, VL_MAPPING_SPHERICAL, VL_MAPPING_CYLINDRICAL, VL_MAPPING_PLANAR } vlMapping;

/** A texture: a number or a spectrum for each point of a surface. */
typedef struct vlTextureDef {
  uint32_t cookie;
  const char *name;   /**< for messages; may be null */
  vlSource source;    /**< where the file describes it */
  vlTextureKind kind; /**< which fields below are read */
  bool spectrum; /**< true: a colour texture, which reads the inputs spectrum_*; false: a float texture, which reads
                    float_* */
  /** Inputs of a float texture. Constant: a is the value. Scale reads a. Mix, checkerboard and dots read a and b.
   * Bilerp reads a to d as v00, v01, v10, v11. */
  vlFloatInput float_a, float_b, float_c, float_d;
  vlSpectrumInput spectrum_a, spectrum_b, spectrum_c, spectrum_d; /**< the same inputs of a colour texture */
  vlFloatInput amount;                                            /**< scale: the factor; mix: share of b */
  float direction[3];                                             /**< direction mix: its direction */
  uint32_t dimension; /**< checkerboard: 2 (s and t of the mapping) or 3 (unit cubes in texture space) */
  uint32_t octaves;   /**< noise: number of octaves, at most 64; default 8 */
  float omega; /**< noise: amplitude of each octave relative to the previous one (pbrt's "roughness"); default 0.5 */
  float variation;        /**< marble: strength of the variation; default 0.2 */
  const char *path;       /**< image: path of a file, read when the world is built (once per path); or */
  const vlImage *image;   /**< image: an image in memory, copied; or */
  const void *data;       /**< image: an image file in memory, copied */
  size_t data_size;       /**< length of data, bytes */
  vlWrap wrap;            /**< wrapping of s, and of t unless wrap_t_given */
  bool wrap_t_given;      /**< wrap_t is read */
  vlWrap wrap_t;          /**< wrapping of t */
  vlTextureFilter filter; /**< interpolation */
  bool encoding_given;    /**< encoding and gamma are read; else the file's own encoding is used (8-bit files: sRGB) */
  vlEncoding encoding;    /**< encoding of the file's integers */
  float gamma;            /**< for VL_ENCODING_GAMMA */
  float scale;            /**< factor on image values; marble: on positions */
  bool invert;            /**< the value becomes 1 - value, after scale */
  /** Image and vertex colour: factors on R, G, B and coverage, applied after filter, scale and invert. */
  float tint[4];
  bool colors; /**< also multiply by the shape's vertex colours */
  /** The channel that a float texture reads. 0 to 3: R, G, B or coverage, which is 1 if the image has none. -1: the
   * mean of the colours or the coverage, depending on the image. */
  int channel;
  float bias; /**< added to a float texture's channel */
  double
      cutoff; /**< a float texture's value becomes 1 if it is at least the cutoff, else 0; unset: it is not changed */
  vlColorSpace space;   /**< colour space of the image's colours */
  vlMapping mapping;    /**< UV: (s, t) = (su u + du, sv v + dv); the other mappings use the point in texture space */
  float su, sv, du, dv; /**< scale and offset of uv; planar: offsets du, dv */
  float planar_v1[3],
      planar_v2[3]; /**< planar: s and t are the dot products of the point in texture space with these vectors */
  double texture_from_world[16]; /**< world space to texture space */
  uint32_t uv_set;               /**< number of the uv set, 0 to 3, for triangles with several sets */
  bool st_from_uv_given;         /**< st_from_uv replaces su, sv, du, dv */
  float st_from_uv[6];           /**< (s, t) = this 2 x 3 row-major matrix times (u, v, 1) */
} vlTextureDef;
/** The default def of a kind. spectrum: true for a colour texture, false for a float texture. */
VL_API vlTextureDef vl_default_texture_def(vlTextureKind kind, bool spectrum);
/** Adds a texture. Its inputs must have been added before. Returns index 0 on error (vl_scene_result). */
VL_API vlTextureId vl_scene_add_texture(vlScene *scene, const vlTextureDef *def);

/* ---- materials ------------------------------------------------------------------------------------------------- */

/** X(NAME, name) for each kind of material. velo/schema.h describes the kinds and their parameters. */
#define VL_MATERIAL_KINDS(X)                                                                             \
  X(DIFFUSE, diffuse)                                                                                    \
  X(COATED_DIFFUSE, coated_diffuse)                                                                      \
  X(CONDUCTOR, conductor)                                                                                \
  X(DIELECTRIC, dielectric)                                                                              \
  X(THIN_DIELECTRIC, thin_dielectric)                                                                    \
  X(MIX, mix)                                                                                            \
  X(PRINCIPLED, principled) /* layered: glTF's metallic-roughness with its extensions */                 \
  X(DIFFUSE_TRANSMISSION, diffuse_transmission)                                                          \
  X(COATED_CONDUCTOR, coated_conductor)                                                                  \
  X(HAIR, hair)                                                                                          \
  X(MEASURED, measured)     /* a BRDF from a file */                                                     \
  X(SUBSURFACE, subsurface) /* a solid that scatters light inside: VL_TRACER_VOLPATH only; else glass */ \
  X(INTERFACE, interface)
/** The kinds of materials: VL_MATERIAL_DIFFUSE and so on, from VL_MATERIAL_KINDS. */
typedef enum vlMaterialKind {
#define VL_KIND(NAME, name) VL_MATERIAL_##NAME,
  VL_MATERIAL_KINDS(VL_KIND)
#undef VL_KIND
} vlMaterialKind;

/** Traits of kinds of materials (vlKindRow.traits). */
enum {
  VL_MATERIAL_OPAQUE = 1, /**< transmits no light */
  VL_MATERIAL_METAL = 2,  /**< a conductor: its colour is the colour of its specular reflection, and it has no albedo */
  VL_MATERIAL_ROUGH = 4,  /**< has a microfacet distribution with an alpha */
  VL_MATERIAL_REFRACTS = 8, /**< a closed shape of this material refracts light */
  VL_MATERIAL_ABSENT = 16   /**< not a visible surface; it only separates media */
};

/** The principled material: glTF 2.0's metallic-roughness with its KHR_materials extensions; docs/principled.md has the
 * formulas. Its base colour is vlMaterialDef.reflectance. Its index of refraction is vlMaterialDef.eta, one number; 0
 * means infinite, that is full reflection. The defaults are those of glTF's extensions: all layers other than metallic,
 * roughness and specular are off. */
typedef struct vlPrincipledDef {
  vlFloatInput metallic;            /**< 0 to 1; default 1 */
  vlFloatInput roughness;           /**< 0 to 1, alpha = roughness^2; default 1 */
  vlFloatInput anisotropy;          /**< strength, 0 to 1: alpha along the tangent is mix(alpha, 1, strength^2) */
  vlFloatInput anisotropy_rotation; /**< radians from the tangent towards the bitangent */
  vlFloatInput specular;            /**< factor on the dielectric's reflection; default 1 */
  vlSpectrumInput specular_color;   /**< factor on the dielectric's reflection at normal incidence; default 1 */
  vlFloatInput transmission;        /**< share of the base that transmits light instead of scattering it */
  bool thin_walled; /**< a thin sheet, which does not refract; default true (as in glTF without thickness) */
  float dispersion; /**< 20 / Abbe number; ignored if thin_walled */
  vlFloatInput diffuse_transmission;          /**< share of the diffuse light that is transmitted to the other side */
  vlSpectrumInput diffuse_transmission_color; /**< factor on the diffusely transmitted light */
  vlFloatInput clearcoat,
      clearcoat_roughness;      /**< coverage of the clear coat, 0 to 1; its roughness, the square root of its alpha */
  vlSpectrumInput sheen_color;  /**< albedo of the sheen; 0: none */
  vlFloatInput sheen_roughness; /**< roughness of the sheen, the square root of its alpha */
  vlFloatInput iridescence;     /**< coverage of the thin film, 0 to 1 */
  float iridescence_ior;        /**< index of refraction of the film; default 1.3 */
  vlFloatInput iridescence_thickness; /**< thickness of the film, nm */
  /** Tangent-space normal maps of the base and of the clear coat: linear colour textures (VL_TEXTURE_IMAGE, not
   * clamped); index 0: none. */
  vlTextureId normal, clearcoat_normal;
  float normal_scale, clearcoat_normal_scale; /**< factors on x and y of the normal maps */
} vlPrincipledDef;

/** How the absorption of hair is given. */
typedef enum vlHairColor {
  VL_HAIR_SIGMA_A,     /**< absorption coefficient, per radius of the hair */
  VL_HAIR_REFLECTANCE, /**< vlMaterialDef.reflectance: the colour of many hairs together */
  VL_HAIR_MELANIN      /**< concentrations of two pigments */
} vlHairColor;
/** Hair (pbrt book 9.9). For curves, whose parameter v runs across the hair. */
typedef struct vlHairDef {
  vlHairColor color;                   /**< how the colour is given; default VL_HAIR_MELANIN, with eumelanin 1.3 */
  vlSpectrumInput sigma_a;             /**< VL_HAIR_SIGMA_A: absorption coefficient */
  vlFloatInput eumelanin, pheomelanin; /**< VL_HAIR_MELANIN: concentrations */
  vlFloatInput eta;                    /**< index of refraction; default 1.55 */
  vlFloatInput beta_m, beta_n;         /**< longitudinal and azimuthal roughness, 0 to 1; default 0.3 */
  vlFloatInput alpha;                  /**< tilt of the scales, degrees; default 2 */
} vlHairDef;

/** A solid that scatters light below a smooth or rough dielectric surface (pbrt book, 3rd edition, 11.4). It is given
 * in one of two ways: by sigma_a and sigma_s (per unit of length, times vlMaterialDef.scale); or by the reflectance of
 * a thick piece (vlMaterialDef.reflectance) and the mean free path (times vlMaterialDef.scale). vlMaterialDef.eta (one
 * number, 0.5 to 2.5) and vlMaterialDef.g are read, too. */
typedef struct vlSubsurfaceDef {
  bool from_reflectance; /**< true: given by reflectance and mfp; false: by sigma_a and sigma_s */
  vlSpectrumInput sigma_a,
      sigma_s;         /**< absorption and scattering coefficients; default: those of whole milk, per millimetre */
  vlSpectrumInput mfp; /**< mean free path, scene units; default 1 */
} vlSubsurfaceDef;

/** A material: how a surface scatters light. One struct holds the parameters of all kinds; the defaults of a kind are
 * pbrt-v4's. */
typedef struct vlMaterialDef {
  uint32_t cookie;
  const char *name;    /**< for messages and ids; may be null */
  const char *place;   /**< index in a file without lines: materials[2]; may be null */
  vlSource source;     /**< where the file describes it */
  vlMaterialKind kind; /**< which fields below are read */
  vlSpectrumInput
      reflectance;      /**< reflectance: diffuse, coated diffuse, diffuse transmission; metals with use_reflectance */
  bool use_reflectance; /**< metals: eta and k are computed from reflectance */
  vlFloatInput u_roughness,
      v_roughness;      /**< roughness of the surface; coated conductor: of the metal; coated diffuse: of the coat */
  bool remap_roughness; /**< true: alpha = sqrt(roughness) (pbrt book 9.6); false: alpha = roughness */
  vlSpectrumInput eta,
      k; /**< index of refraction. Metals: eta and k; dielectrics and the coat of coated diffuse: eta, untextured */
  vlFloatInput thickness, g;   /**< coat: its thickness (coated diffuse: untextured) and its medium's mean cosine.
                                  Subsurface: g, untextured */
  vlSpectrumInput albedo;      /**< albedo of the coat's medium; 0: the medium only absorbs */
  uint32_t max_depth, samples; /**< coat: largest number of bounces inside it; number of random walks per evaluation */
  vlFloatInput amount;         /**< mix: share of the second material */
  vlMaterialId materials[2];   /**< mix: the two materials */
  vlFloatInput displacement;   /**< bump map: height in scene units; texture index 0: none */
  const char *normal_map;      /**< path of a linear tangent-space normal map; null: none */
  vlPrincipledDef principled;  /**< parameters of the principled material */
  vlSpectrumInput transmittance; /**< diffuse transmission: its transmittance */
  float scale; /**< diffuse transmission: factor on reflectance and transmittance; subsurface: see vlSubsurfaceDef */
  vlFloatInput coat_u_roughness, coat_v_roughness; /**< coated conductor: roughness of the coat */
  vlSpectrumInput coat_eta;                        /**< coated conductor: index of refraction of the coat; untextured */
  vlHairDef hair;                                  /**< parameters of hair */
  const char *measured; /**< measured: path of a spectral file of the RGL material database (Dupuy and Jakob 2018) */
  vlSubsurfaceDef subsurface; /**< parameters of the subsurface material */
  /** Coated diffuse, if its medium only absorbs and is not textured: true makes a rough coat conserve energy, and
   * max_depth is not read. Otherwise, as in pbrt, a rough coat loses the light that scatters more than once between its
   * microfacets: 40 % at alpha 0.4 over a white base. */
  bool conserve_energy;
} vlMaterialDef;
/** The default def of a kind. */
VL_API vlMaterialDef vl_default_material_def(vlMaterialKind kind);
/** Adds a material. Its textures and materials must have been added before. Returns index 0 on error. */
VL_API vlMaterialId vl_scene_add_material(vlScene *scene, const vlMaterialDef *def);

/* ---- participating media --------------------------------------------------------------------------------------- */

/** X(NAME, name) for each kind of medium. velo/schema.h describes the parameters. Homogeneous: constant coefficients.
 * Grid: sigma_a and sigma_s times a density on a grid over a box. RGB grid: sigma_a and sigma_s themselves on a grid.
 * Cloud: sigma_a and sigma_s times a procedural density (pbrt-v4's cloud). NanoVDB: sigma_a and sigma_s times a density
 * from a NanoVDB file. */
#define VL_MEDIUM_KINDS(X)    \
  X(HOMOGENEOUS, homogeneous) \
  X(GRID, grid)               \
  X(RGB_GRID, rgb_grid)       \
  X(CLOUD, cloud)             \
  X(NANOVDB, nanovdb)
/** The kinds of media: VL_MEDIUM_HOMOGENEOUS and so on, from VL_MEDIUM_KINDS. */
typedef enum vlMediumKind {
#define VL_KIND(NAME, name) VL_MEDIUM_##NAME,
  VL_MEDIUM_KINDS(VL_KIND)
#undef VL_KIND
} vlMediumKind;

/** A participating medium (pbrt book 11). Coefficients are per unit of length in world space, whatever the medium's
 * transform. The phase function is Henyey and Greenstein's. A medium with a box is empty outside the box. */
typedef struct vlMediumDef {
  uint32_t cookie;
  const char *name;            /**< for messages; may be null */
  vlSource source;             /**< where the file describes it */
  vlMediumKind kind;           /**< which fields below are read */
  vlSpectrum sigma_a, sigma_s; /**< absorption and scattering coefficients; default 1; not read for RGB grids */
  float scale;                 /**< factor on both coefficients */
  float g;                     /**< mean cosine of scattering, -1 to 1 */
  /** True: sigma_a acts on each channel of linear sRGB, as in glTF: the share exp(-sigma_a x) remains after the
   * distance x. This holds in both colour modes and does not depend on how the distance is divided (docs/media.md).
   * Only for homogeneous media without emission, with a sigma_a that is an RGB value or a constant. False (default):
   * sigma_a is a spectrum, as in pbrt. */
  bool rgb_absorption;
  /** Homogeneous and grid: the medium emits the radiance sigma_a * emission * emission_scale per unit of length. As for
   * lights, the emission spectrum is first divided by its own luminance. */
  vlSpectrum emission;
  float emission_scale;         /**< factor on emission */
  double world_from_medium[16]; /**< medium space to world space */
  /** Grids: nx * ny * nz values, x fastest, at the centres of equal cells that divide the box from low to high. Between
   * the centres the values are interpolated linearly, towards 0 at the box's faces. */
  uint32_t nx, ny, nz;
  float low[3], high[3];                  /**< grids and clouds: corners of the box in medium space */
  const float *density, *emission_scales; /**< grid: factors on both coefficients; factors on emission (may be null) */
  const float *temperature; /**< grid: temperatures for black-body emission, which replaces `emission`; may be null */
  float temperature_offset, temperature_scale; /**< kelvin = (value - offset) * scale; no emission below 100 K */
  const float *rgb_a, *rgb_s,
      *rgb_emission;  /**< RGB grid: 3 numbers per cell, in `space`; rgb_a and rgb_s: null means 1 */
  vlColorSpace space; /**< colour space of the RGB grid */
  float cloud_density, wispiness, frequency; /**< cloud: density, strength and frequency of the noise */
  const char *path;                          /**< path of the NanoVDB file */
  const char *grid,
      *temperature_grid; /**< names of the file's grids; null: "density" and "temperature", which may be absent */
} vlMediumDef;
/** The default def of a kind. */
VL_API vlMediumDef vl_default_medium_def(vlMediumKind kind);
/** Adds a medium. Returns index 0 on error: negative coefficients or values, a grid without cells, an empty box,
 * numbers that are not finite. */
VL_API vlMediumId vl_scene_add_medium(vlScene *scene, const vlMediumDef *def);

/* ---- lights ---------------------------------------------------------------------------------------------------- */

/** Emission of surfaces. The emitted radiance is scale * L in units in which a spectrum L with Y = 1 has luminance 1.
 * As in pbrt (SpectrumToPhotometric, book 12.1), named, blackbody and sampled spectra are first divided by their own Y.
 */
typedef struct vlEmissionDef {
  uint32_t cookie;
  vlSource source;     /**< where the file describes it */
  vlSpectrum radiance; /**< L */
  float scale;         /**< factor on radiance */
  double power;        /**< total power, watts (pbrt's "power"); it determines the scale; VL_UNSET: not used */
  bool two_sided;      /**< true: both sides emit light; false: only the side of the normal */
  const char *image;   /**< path of an emission image over uv; null: none; or */
  vlTextureId
      texture; /**< a colour texture of kind VL_TEXTURE_IMAGE: emits its value times scale; radiance is ignored */
} vlEmissionDef;
/** The default def. */
VL_API vlEmissionDef vl_default_emission_def(void);
/** Adds an emission, which any number of shapes may use. Returns index 0 on error. */
VL_API vlEmissionId vl_scene_add_emission(vlScene *scene, const vlEmissionDef *def);

/** X(NAME, name) for each kind of light. velo/schema.h describes the kinds and their parameters. A goniometric light's
 * image is an equal-area octahedral square (pbrt book 3.8.3) with the light's y axis as its axis. A projection light's
 * image is its intensity, projected along the light's z axis with y up. */
#define VL_LIGHT_KINDS(X)     \
  X(POINT, point)             \
  X(SPOT, spot)               \
  X(DISTANT, distant)         \
  X(INFINITE, infinite)       \
  X(GONIOMETRIC, goniometric) \
  X(PROJECTION, projection)
/** The kinds of lights: VL_LIGHT_POINT and so on, from VL_LIGHT_KINDS. */
typedef enum vlLightKind {
#define VL_KIND(NAME, name) VL_LIGHT_##NAME,
  VL_LIGHT_KINDS(VL_KIND)
#undef VL_KIND
} vlLightKind;
/** A light that is not a surface. */
typedef struct vlLightDef {
  uint32_t cookie;
  vlSource source;  /**< where the file describes it */
  vlLightKind kind; /**< which fields below are read */
  vlSpectrum color; /**< intensity (point, spot, ...) or radiance (distant, infinite) */
  float scale;      /**< factor on color or image */
  double power; /**< lights that emit from a point: total power, watts; it determines the scale; VL_UNSET: not used */
  double illuminance;          /**< distant, infinite: illuminance, lux; it determines the scale; VL_UNSET: not used */
  double world_from_light[16]; /**< light space to world space */
  float from[3], to[3]; /**< light space. Point: its position is `from`; spot, distant: emits in the direction from
                           `from` to `to` */
  float cone_angle,
      cone_delta; /**< spot: angle between the cone's axis and its edge, and width of the falloff inside it; radians */
  bool cone_squared; /**< true: the falloff is t^2, t linear in the cosine, as in glTF; false: pbrt's smooth step 3t^2 -
                        2t^3 */
  const char *path;  /**< path of the image; infinite: a square equal-area octahedral map (pbrt book 3.8.3); null:
                        uniform light */
  const vlImage *image; /**< the image in memory, in place of path; copied */
  vlColorSpace space;   /**< colour space of an image that names none; an image replaces color, and its values are
                           multiplied by scale */
  vlMediumId medium;    /**< the medium around the light */
  float fov;            /**< projection: radians across the image's smaller side; default pi/2 */
  /** Infinite with an image: the light enters only through the rectangle `portal` in the world, in directions to the
   * side that (last - first) x (second - first) points to. A point from which the portal is not seen in such a
   * direction gets no light. */
  bool has_portal;
  float portal[4][3]; /**< the four corners, in order around the rectangle, world space */
} vlLightDef;
/** The default def of a kind. */
VL_API vlLightDef vl_default_light_def(vlLightKind kind);
/** Adds a light. Returns index 0 on error. */
VL_API vlLightId vl_scene_add_light(vlScene *scene, const vlLightDef *def);

/* ---- shapes ---------------------------------------------------------------------------------------------------- */

/** X(NAME, name) for each kind of shape. velo/schema.h describes the kinds and their parameters. Curves are cubic
 * Bezier segments with a width, for hair, fur and grass. */
#define VL_SHAPE_KINDS(X) \
  X(TRIANGLES, triangles) \
  X(BILINEAR, bilinear)   \
  X(SPHERE, sphere)       \
  X(DISK, disk)           \
  X(CYLINDER, cylinder)   \
  X(CURVES, curves)
/** The kinds of shapes: VL_SHAPE_TRIANGLES and so on, from VL_SHAPE_KINDS. */
typedef enum vlShapeKind {
#define VL_KIND(NAME, name) VL_SHAPE_##NAME,
  VL_SHAPE_KINDS(VL_KIND)
#undef VL_KIND
} vlShapeKind;
/** The cross-section of curves. */
typedef enum vlCurveKind {
  VL_CURVE_FLAT,     /**< a strip that faces every ray */
  VL_CURVE_CYLINDER, /**< a strip that faces every ray, shaded with the normals of a tube */
  VL_CURVE_RIBBON    /**< a strip oriented by its normals */
} vlCurveKind;

/** A shape: one or many primitives with a material. */
typedef struct vlShapeDef {
  uint32_t cookie;
  vlSource source;  /**< where the file describes it */
  vlLabel label;    /**< what the file calls it; copied */
  vlShapeKind kind; /**< which fields below are read */
  vlGroupId group;  /**< index 0: the shape is in the world; else it is part of this group, which instances place */
  double group_from_shape[16]; /**< shape space to group (or world) space */
  /** The side of normals follows pbrt-v4's rule. The normal is dpdu x dpdv in shape space (of a triangle: given by the
   * order of its corners), transformed to group space by the inverse transpose. There it is flipped if exactly one of
   * these holds: reverse_orientation is set, group_from_shape mirrors. So a mirrored mesh keeps its outside, but the
   * normals of a sphere, disk, cylinder or curve turn over under a mirroring group_from_shape. Instances never flip
   * normals. Vertex normals take precedence if they are given; only reverse_orientation flips them. */
  bool reverse_orientation;
  vlMaterialId material; /**< index 0: a default diffuse material of reflectance 0.5 */
  vlFloatInput alpha;    /**< coverage, 0 to 1; 1: opaque */
  vlEmissionId emission; /**< index 0: emits no light */
  /** The media on both sides of the surface; its normal points to the outside. If both ids are equal (also both 0), the
   * shape does not separate media: the surrounding medium is on both sides. */
  vlMediumId inside, outside;
  /** Numbers of vertices and of faces of a mesh. Curves: faces is the number of segments, vertices is 4 times that
   * number. */
  uint32_t vertices, faces;
  const float *positions;     /**< 3 per vertex, shape space */
  const float *normals;       /**< 3 per vertex, shape space; may be null */
  const float *tangents;      /**< 3 per vertex, shape space; pbrt's S; may be null */
  const float *uvs;           /**< 2 per vertex; may be null */
  const uint32_t *indices;    /**< triangles: 3 per face; bilinear: 4 per face (pbrt's order p00 p10 p01 p11) */
  const float *tangent_signs; /**< triangles: 1 per vertex; the bitangent is sign * n x tangent; null: all 1 */
  const float *more_uvs[3];   /**< triangles: uv sets 1 to 3, 2 per vertex; may be null */
  const float *colors;        /**< triangles: vertex colours, 4 per vertex: linear R G B and coverage; may be null */
  bool one_sided;             /**< triangles: rays that meet a back face pass through it */
  /** The shape is a part of the background: it is rendered, but alpha is 0 where camera rays meet it first. */
  bool backdrop;
  /** Moving triangles: positions and normals at times[1]; `positions` and `normals` are those at times[0]. Between
   * these times they are interpolated linearly; before and after them the mesh is at rest. May be null. A moving mesh
   * cannot emit light. */
  const float *positions_close, *normals_close;
  double times[2]; /**< seconds; default 0, 1 */
  /** Triangles at rest: a float texture displaces the vertices along their normals, in units of shape space (texture
   * index 0: none). Before that the triangles are subdivided until no edge is longer than edge_length. More than 2^24
   * triangles are an error of vl_world_build. */
  vlFloatInput displacement;
  float edge_length; /**< largest length of an edge, group space; default 1 */
  /** Sphere, disk, cylinder: pbrt's parameters (book 6.2-6.4). The shape's axis is z in shape space; phi_max is in
   * radians. */
  float radius, inner_radius, z_min, z_max, height, phi_max;
  /** `faces` whole spheres as one shape. It takes 28 bytes per sphere, where a separate shape takes about 750. The
   * parameters above are not read, and the spheres cannot emit light. Both null: one sphere at the origin. */
  const double *centers; /**< 3 per sphere, shape space */
  const float *radii;    /**< 1 per sphere, above 0 */
  /** Curves: `positions` has the 4 Bezier control points of each segment. The parameter u runs along a segment, v from
   * one side to the other. Ribbons: `normals` has the normals at both ends of each segment (6 numbers per segment).
   * Curves cannot emit light. */
  vlCurveKind curve;
  const float *widths; /**< curves: widths at both ends of each segment, 2 per segment, shape space */
  /** Curves: each segment is cut into 2^split_depth pieces for faster intersection, into fewer if there are millions of
   * segments; default 3. The image does not depend on it. */
  uint32_t split_depth;
} vlShapeDef;
/** The default def of a kind. */
VL_API vlShapeDef vl_default_shape_def(vlShapeKind kind);
/** Adds a shape. Returns index 0 on error, for example when an index is out of range, a position or normal is not
 * finite (the message names the vertex), or a radius is not above 0. */
VL_API vlShapeId vl_scene_add_shape(vlScene *scene, const vlShapeDef *def);

/** Adds an empty group; shapes join it by vlShapeDef.group. name may be null. Returns index 0 on error. */
VL_API vlGroupId vl_scene_add_group(vlScene *scene, const char *name);
/** Places a group in the world. Groups cannot be nested. Returns index 0 on error (vl_scene_result). */
VL_API vlInstanceId vl_scene_add_instance(vlScene *scene, vlGroupId group, const double world_from_group[16],
                                          vlSource source);
/** Places a moving group in the world: `keys` poses (16 numbers each) at ascending times, in seconds. Between two times
 * translation, rotation and scale are interpolated separately (formulas: src/math/motion.h); before the first and after
 * the last time the group is at rest. Errors (returned by vl_scene_result): a pose is singular, only one of two
 * consecutive poses mirrors, or the times do not ascend. */
VL_API vlInstanceId vl_scene_add_moving_instance(vlScene *scene, vlGroupId group, uint32_t keys, const double *times,
                                                 const double *world_from_group, vlSource source);

/* ---- how the image is taken ------------------------------------------------------------------------------------ */

/** X(NAME, name) for each tracer. Their names in pbrt files are in velo/schema.h. The tracers with light paths
 * (docs/tracers.md) are replaced by VL_TRACER_VOLPATH in scenes with VL_MATERIAL_SUBSURFACE, and for a rolling shutter
 * with motion. */
#define VL_TRACER_KINDS(X)                                                                                      \
  X(PATH, path) /* ignores media */                                                                             \
  X(RAYCAST, raycast)                                                                                           \
  X(AMBIENT_OCCLUSION, ambient_occlusion)                                                                       \
  X(VOLPATH, volpath)             /* paths through media and solids; without those, bitwise equal to PATH */    \
  X(BIDIRECTIONAL, bidirectional) /* camera paths, and light paths that connect to the camera; unbiased */      \
  X(MERGING, merging)             /* also merges them at surfaces, in a radius that shrinks each pass */        \
  X(SPPM, sppm)                   /* as MERGING, but smooth surfaces do not count as bounces of camera paths */ \
  X(LIGHT_PATH, light_path)       /* light paths only: smooth surfaces look black */                            \
  X(RANDOM_WALK, random_walk)     /* does not sample lights; directions are uniform: for comparison */
/** Light transport algorithms (docs/tracers.md). */
typedef enum vlTracer {
#define VL_KIND(NAME, name) VL_TRACER_##NAME,
  VL_TRACER_KINDS(VL_KIND)
#undef VL_KIND
} vlTracer;
/** X(NAME, name) for each sampler. velo/schema.h has descriptions and the names in pbrt files. */
#define VL_SAMPLER_KINDS(X)         \
  X(INDEPENDENT, independent)       \
  X(REGULAR, regular)               \
  X(STRATIFIED, stratified)         \
  X(NROOKS, nrooks)                 \
  X(MULTI_JITTERED, multi_jittered) \
  X(HAMMERSLEY, hammersley)         \
  X(HALTON, halton)                 \
  X(SOBOL, sobol)                   \
  X(ZSOBOL, zsobol)
/** Sample generators (src/trace/sampler/sampler.h): those of the lecture and the low-discrepancy samplers of pbrt
 * book 8.6-8.7.
 */
typedef enum vlSamplerKind {
#define VL_KIND(NAME, name) VL_SAMPLER_##NAME,
  VL_SAMPLER_KINDS(VL_KIND)
#undef VL_KIND
} vlSamplerKind;
/** X(NAME, name) for each kind of pixel filter. velo/schema.h describes the kinds and their parameters. */
#define VL_PIXEL_FILTER_KINDS(X) \
  X(BOX, box)                    \
  X(TRIANGLE, triangle)          \
  X(GAUSSIAN, gaussian)          \
  X(MITCHELL, mitchell)          \
  X(LANCZOS, lanczos)            \
  X(BLACKMAN_HARRIS, blackman_harris)
/** The kinds of pixel filters: VL_PIXEL_FILTER_BOX and so on, from VL_PIXEL_FILTER_KINDS. */
typedef enum vlPixelFilterKind {
#define VL_KIND(NAME, name) VL_PIXEL_FILTER_##NAME,
  VL_PIXEL_FILTER_KINDS(VL_KIND)
#undef VL_KIND
} vlPixelFilterKind;
/** A pixel reconstruction filter (pbrt book 8.8). */
typedef struct vlPixelFilter {
  vlPixelFilterKind kind;   /**< which fields below are read */
  float radius_x, radius_y; /**< half of the filter's extent along x and y, pixels */
  float sigma;              /**< Gaussian: standard deviation, pixels */
  float b, c;               /**< Mitchell: its parameters */
  float tau;                /**< Lanczos: number of cycles of the sinc */
} vlPixelFilter;
/** The default filter of a kind, with pbrt-v4's default sizes. */
VL_API vlPixelFilter vl_default_pixel_filter(vlPixelFilterKind kind);
/** The coordinate system of the ground truth channels that the scene's file requests (pbrt's gbuffer film). NONE: it
 * requests no channels. */
typedef enum vlGbuffer { VL_GBUFFER_NONE, VL_GBUFFER_CAMERA, VL_GBUFFER_WORLD } vlGbuffer;
/** How a path represents radiance: at 4 sampled wavelengths, or as R, G, B. */
typedef enum vlColorMode { VL_COLOR_SPECTRAL, VL_COLOR_RGB } vlColorMode;
/** How a light is selected: by a light BVH (pbrt book 12.6), by power, uniformly. */
typedef enum vlLightSampler { VL_LIGHT_SAMPLER_BVH, VL_LIGHT_SAMPLER_POWER, VL_LIGHT_SAMPLER_UNIFORM } vlLightSampler;

/** The defs of camera, film, build, render and develop as the scene's file gives them (velo/render.h). */
typedef struct vlSceneDefs vlSceneDefs;
/** The scene's defs, never null. The scene owns them and what their pointers point at. May be changed until the scene
 * is destroyed. */
VL_API vlSceneDefs *vl_scene_defs(vlScene *scene);
/** Copies camera, image size and crop from another scene of the same context. The objects of the camera's lens are
 * copied, too, so that `from` may be destroyed afterwards. ARGUMENT, MEMORY. */
VL_API vlResult vl_scene_take_camera(vlScene *scene, vlScene *from, vlError *error);
/** Focuses the scene's camera, which must have a lens of many elements, at a distance from its film, in scene units.
 * ARGUMENT, MEMORY. */
VL_API vlResult vl_scene_refocus(vlScene *scene, double distance, vlError *error);

/** Creates an empty scene. ARGUMENT, MEMORY. */
VL_API vlResult vl_scene_create(vlContext *context, vlScene **scene);
/** Null is allowed. */
VL_API void vl_scene_destroy(vlScene *scene);
/** The scene's first error; VL_OK if there is none. error may be null. */
VL_API vlResult vl_scene_result(const vlScene *scene, vlError *error);

/** How to read a scene file. */
typedef struct vlLoadDef {
  uint32_t cookie;
  bool permissive;         /**< true: features that are not supported cause warnings, and normals and uvs that are not
                              finite, normals that are zero and, in pbrt files, missing images are repaired, with a warning
                              that counts them; false: they are errors (zero normals are not) */
  bool strict;             /**< glTF, OBJ: true: a missing image is an error; false: a warning, and the material does
                              without it */
  const char *search_path; /**< pbrt, glTF, OBJ: further folders, separated by ':', in which files are looked for; null:
                              none */
  double time;             /**< glTF: time of the animations, seconds; unset: the scene without animation */
  double time_close;     /**< glTF: time when the shutter closes, seconds, later than `time`; for motion blur; unset: no
                            motion */
  const char *scene;     /**< glTF: name of the scene, or its number from 0; null: the file's default */
  const char *animation; /**< glTF: name of the animation, or its number from 0; null: the first */
  const char *variant;   /**< glTF: name of a material variant; null: the file's default */
  const char *camera;    /**< glTF: name of the camera, or its number from 0; null: the first */
  const vlCancel *cancel; /**< stops the load; the scene must then be destroyed; default null */
  vlStepFn *progress;     /**< default null */
  void *progress_user;    /**< passed to progress */
} vlLoadDef;
/** The default def. */
VL_API vlLoadDef vl_default_load_def(void);
/** Adds the contents of a file to the scene. The suffix selects the format: .pbrt, .gltf, .glb, .obj, .ply, .stl, .off
 * or one of these but glTF's with .gz. Relative paths in the file are relative to its folder. def may be null. Errors:
 * SCENE, MISSING, IO, MEMORY, UNSUPPORTED (valid, but not supported; the message says what). */
VL_API vlResult vl_scene_load(vlScene *scene, const char *path, const vlLoadDef *def, vlError *error);

/** As vl_scene_load, for a pbrt scene in memory. name: the file's name in messages, required; relative paths are
 * relative to its folder, which need not contain a file of this name. data is copied. */
VL_API vlResult vl_scene_load_memory(vlScene *scene, const char *name, const void *data, size_t size,
                                     const vlLoadDef *def, vlError *error);

/** The environment (light from all directions) that vl_scene_complete adds. */
typedef enum vlEnvironmentKind {
  VL_ENVIRONMENT_AUTO,   /**< STUDIO if vlSceneDefs.light_missing, else none. If the scene has other lights, its
                            strength is such that a surface gets 0.3 times as much light from it as from them */
  VL_ENVIRONMENT_NONE,   /**< none is added */
  VL_ENVIRONMENT_STUDIO, /**< neutral: soft lights above and in front in a grey room */
  VL_ENVIRONMENT_SKY,    /**< a clear sky and the sun */
  VL_ENVIRONMENT_WHITE,  /**< radiance 1 from all directions */
  VL_ENVIRONMENT_FILE    /**< the image at `path` */
} vlEnvironmentKind;
/** From where the added camera looks. */
typedef enum vlFraming {
  VL_FRAMING_AUTO,   /**< CORNER; flat models nearly along their normal; the middle of a shell that contains nothing */
  VL_FRAMING_CORNER, /**< from the front, slightly from the right and from above */
  VL_FRAMING_FRONT   /**< straight from the front */
} vlFraming;
/** What to add to a scene that lacks a camera, a light or a ground. */
typedef struct vlCompleteDef {
  uint32_t cookie;
  uint32_t width, height;        /**< image size in pixels, for framing and for files without a size; 0: the film's */
  vlEnvironmentKind environment; /**< default AUTO */
  const char *path; /**< FILE: path of an image, either twice as wide as high (longitude and latitude; its centre is in
                       the direction -front) or square (equal-area octahedral) */
  double rotation;  /**< rotation of the environment about `up`, radians, counter-clockwise as seen from above */
  float strength;   /**< factor on the environment's radiance */
  double up[3], front[3]; /**< directions in world space; default +y and +z, as in glTF */
  bool ground;            /**< adds a wide grey disk under everything */
  bool reframe;           /**< replaces the file's camera by one that frames the scene */
  vlFraming framing;      /**< where the added camera stands */
  /** With the added camera and the studio: a ground of the studio's colour under the model, which catches its shadows
   * and becomes transparent away from it. It is a backdrop (vlShapeDef.backdrop). Default false. */
  bool backdrop;
  /** With the added camera: of a closed model (a room whose walls hide it, a dome around it) the faces between the
   * camera and the middle are left out; a note gives their number. The camera of a dome frames what the dome contains.
   * Default false. */
  bool open_walls;
} vlCompleteDef;
/** The default def. */
VL_API vlCompleteDef vl_default_complete_def(void);
/** Adds what is missing (vlSceneDefs.camera_missing, light_missing) or requested. The new camera looks at the whole
 * scene (vlFraming). What is chosen is logged (VL_LOG_DEBUG). def may be null. Errors: as vl_scene_result; MISSING, IO
 * (path). */
VL_API vlResult vl_scene_complete(vlScene *scene, const vlCompleteDef *def, vlError *error);

/** The size of a scene. */
typedef struct vlSceneInfo {
  /** Numbers of objects. Objects of a group count once, however many instances it has; emissive_shapes also count as
   * shapes. */
  uint64_t shapes, triangles, vertices, textures, materials, lights, emissive_shapes, groups, instances, media;
} vlSceneInfo;
/** Counts the contents of a scene. */
VL_API void vl_scene_info(const vlScene *scene, vlSceneInfo *info);
/** The number of objects of a kind in the scene. family: name of a family of velo/schema.h: "materials", "textures",
 * "media", "lights" or "shapes"; the result for other names is 0. */
VL_API uint64_t vl_scene_kind_count(const vlScene *scene, const char *family, uint32_t kind);

#ifdef __cplusplus
}
#endif
#endif
