/** @file
 * velo/scene.h: the editable description of a world: what a scene file says, or what a program adds. Everything added
 * is copied. A scene remembers its first error: from then on every vl_scene_add_* returns id 0, and vl_scene_result
 * gives the error. Not thread-safe. */
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

/** Id of a texture. As with every id: index 0 is none, the first object has index 1; valid in its own scene only. */
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
/** Id of a participating medium. */
typedef struct vlMediumId {
  uint32_t index; /**< from 1; 0: vacuum */
} vlMediumId;

/** A place in a file, for errors that are found later. Copied. */
typedef struct vlSource {
  const char *file;      /**< path; may be null */
  uint32_t line, column; /**< from 1; 0: not known */
} vlSource;

/** Colour spaces of RGB values, all linear: sRGB (Rec. 709), DCI-P3, Rec. 2020, ACES 2065-1. */
typedef enum vlColorSpace { VL_SPACE_SRGB, VL_SPACE_DCI_P3, VL_SPACE_REC2020, VL_SPACE_ACES2065_1 } vlColorSpace;

/** How a spectrum is given. */
typedef enum vlSpectrumKind {
  VL_SPECTRUM_CONSTANT,  /**< `value` at every wavelength */
  VL_SPECTRUM_RGB,       /**< `rgb` in `space`; where it is used decides the spectrum (vlParameterRole) */
  VL_SPECTRUM_BLACKBODY, /**< at `kelvin`, normalised to maximum 1 */
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
  const float *wavelengths, *values; /**< SAMPLED: nm, ascending; the values there */
  const char *name;                  /**< NAMED */
} vlSpectrum;
/** The same value at every wavelength. */
VL_API vlSpectrum vl_spectrum_constant(float value);
/** A linear sRGB colour. */
VL_API vlSpectrum vl_spectrum_rgb(float r, float g, float b);
/** A black body at this temperature, in kelvin, normalised to maximum 1. */
VL_API vlSpectrum vl_spectrum_blackbody(float kelvin);
/** A spectrum of the library by its name; the string must live until a def with it is added. */
VL_API vlSpectrum vl_spectrum_named(const char *name);
/** The names of the library's spectra, index from 0; null past the end. Constant. */
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
/** An input without texture. */
VL_API vlFloatInput vl_float_input(float value);
/** An input without texture. */
VL_API vlSpectrumInput vl_spectrum_input(vlSpectrum value);

/* ---- textures -------------------------------------------------------------------------------------------------- */

/** X(NAME, name) for each kind of texture; its description and parameters: velo/schema.h. */
#define VL_TEXTURE_KINDS(X)                                                                                          \
  X(CONSTANT, constant)                                                                                              \
  X(SCALE, scale)                                                                                                    \
  X(MIX, mix)                                                                                                        \
  X(CHECKERBOARD, checkerboard)                                                                                      \
  X(IMAGE, image)                                                                                                    \
  X(DIRECTION_MIX, direction_mix)                                                                                    \
  X(BILERP, bilerp)                                                                                                  \
  X(FBM, fbm)                   /* float: octaves of noise in texture space (texture_from_world), as the next two */ \
  X(WRINKLED, wrinkled)         /* float: octaves of the noise's absolute value */                                   \
  X(WINDY, windy)               /* float: wind waves; octaves and roughness are fixed */                             \
  X(MARBLE, marble)             /* colour; scale and variation of its veins */                                       \
  X(DOTS, dots)                 /* b inside the dots, a outside */                                                   \
  X(VERTEX_COLOR, vertex_color) /* the shape's vertex colours; tint, channel, bias, cutoff as for an image */
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
/** The value of an image outside the unit square: repeated, black, that of the nearest edge, by the rules of an
 * octahedral map, mirrored. */
typedef enum vlWrap { VL_WRAP_REPEAT, VL_WRAP_BLACK, VL_WRAP_CLAMP, VL_WRAP_OCTAHEDRAL, VL_WRAP_MIRROR } vlWrap;
/** Interpolation of images. */
typedef enum vlTextureFilter {
  VL_FILTER_POINT,     /**< nearest texel of the level that fits the footprint */
  VL_FILTER_BILINEAR,  /**< between four texels of the finer level */
  VL_FILTER_TRILINEAR, /**< bilinear on two levels, and linear between them */
  VL_FILTER_EWA        /**< taken as trilinear: footprints are isotropic */
} vlTextureFilter;
/** The map from a surface point to (s, t) (pbrt book 10.2). */
typedef enum vlMapping { VL_MAPPING_UV, VL_MAPPING_SPHERICAL, VL_MAPPING_CYLINDRICAL, VL_MAPPING_PLANAR } vlMapping;

/** A texture: a number or a spectrum for each point of a surface. */
typedef struct vlTextureDef {
  uint32_t cookie;
  const char *name;   /**< for messages; may be null */
  vlSource source;    /**< where the file describes it */
  vlTextureKind kind; /**< which fields below are read */
  bool spectrum;      /**< a colour texture, which reads the spectrum_* inputs; else a float texture: float_* */
  /** Inputs of a float texture. Constant: the value a; scale: a; mix, checkerboard: a, b; bilerp: a to d are v00, v01,
   * v10, v11. */
  vlFloatInput float_a, float_b, float_c, float_d;
  vlSpectrumInput spectrum_a, spectrum_b, spectrum_c, spectrum_d; /**< the same of a colour texture */
  vlFloatInput amount;                                            /**< scale: the factor; mix: share of b */
  float direction[3];                                             /**< direction mix */
  uint32_t dimension;     /**< checkerboard: 2 (s, t by the mapping) or 3 (unit cubes in texture_from_world) */
  uint32_t octaves;       /**< noise: number of octaves, at most 64; default 8 */
  float omega;            /**< noise: amplitude of each octave relative to the one before ("roughness"); default 0.5 */
  float variation;        /**< marble; default 0.2 */
  const char *path;       /**< image: path, read when the world is built (once per path); or */
  const vlImage *image;   /**< image: given directly, copied; or */
  const void *data;       /**< image: an image file in memory, copied */
  size_t data_size;       /**< length of data, bytes */
  vlWrap wrap;            /**< of s, and of t unless wrap_t_given */
  bool wrap_t_given;      /**< wrap_t is read */
  vlWrap wrap_t;          /**< of t */
  vlTextureFilter filter; /**< interpolation */
  bool encoding_given;    /**< encoding and gamma are read; else the file's own (8-bit: sRGB) */
  vlEncoding encoding;    /**< of the file's integers */
  float gamma;            /**< for VL_ENCODING_GAMMA */
  float scale;            /**< factor on image values; marble: on positions */
  bool invert;            /**< 1 - value, after scale */
  /** Image and vertex colour, after filter, scale and invert: factors on R, G, B and coverage. */
  float tint[4];
  bool colors; /**< also multiply by the shape's vertex colours */
  /** The channel that a float texture reads: 0 to 3 (coverage is 1 where the image has none); -1: grey, the mean of the
   * colours or the coverage, depending on the image. */
  int channel;
  float bias;           /**< added to a float texture's channel */
  double cutoff;        /**< a float texture becomes 1 from this value on and 0 below; unset: stays as it is */
  vlColorSpace space;   /**< of the image's colours */
  vlMapping mapping;    /**< UV: (s, t) = (su u + du, sv v + dv); others map points through texture_from_world */
  float su, sv, du, dv; /**< scale and offset of uv; planar: offsets du, dv */
  float planar_v1[3], planar_v2[3]; /**< planar: s and t are the products with these, in texture space */
  double texture_from_world[16];    /**< world space to texture space */
  uint32_t uv_set;                  /**< 0 to 3, of triangles with several */
  bool st_from_uv_given;            /**< st_from_uv replaces su, sv, du, dv */
  float st_from_uv[6];              /**< (s, t) = this 2 x 3 row-major matrix times (u, v, 1) */
} vlTextureDef;
/** The default def of a kind. spectrum: a colour texture, else a float texture. */
VL_API vlTextureDef vl_default_texture_def(vlTextureKind kind, bool spectrum);
/** Adds a texture. Its inputs must have been added before. Returns index 0 on error (vl_scene_result). */
VL_API vlTextureId vl_scene_add_texture(vlScene *scene, const vlTextureDef *def);

/* ---- materials ------------------------------------------------------------------------------------------------- */

/** X(NAME, name) for each kind of material; its description and parameters: velo/schema.h. */
#define VL_MATERIAL_KINDS(X)                                                                                        \
  X(DIFFUSE, diffuse)                                                                                               \
  X(COATED_DIFFUSE, coated_diffuse)                                                                                 \
  X(CONDUCTOR, conductor)                                                                                           \
  X(DIELECTRIC, dielectric)                                                                                         \
  X(THIN_DIELECTRIC, thin_dielectric)                                                                               \
  X(MIX, mix)                                                                                                       \
  X(PRINCIPLED, principled) /* layered: glTF's metallic-roughness with its extensions */                            \
  X(DIFFUSE_TRANSMISSION, diffuse_transmission)                                                                     \
  X(COATED_CONDUCTOR, coated_conductor)                                                                             \
  X(HAIR, hair)                                                                                                     \
  X(MEASURED, measured)     /* a BRDF from a file */                                                                \
  X(SUBSURFACE, subsurface) /* a solid that scatters light below its surface: VL_TRACER_VOLPATH; glass in others */ \
  X(INTERFACE, interface)
/** The kinds of materials: VL_MATERIAL_DIFFUSE and so on, from VL_MATERIAL_KINDS. */
typedef enum vlMaterialKind {
#define VL_KIND(NAME, name) VL_MATERIAL_##NAME,
  VL_MATERIAL_KINDS(VL_KIND)
#undef VL_KIND
} vlMaterialKind;

/** Traits of kinds of materials (vlKindRow.traits). */
enum {
  VL_MATERIAL_OPAQUE = 1,   /**< transmits no light */
  VL_MATERIAL_METAL = 2,    /**< its colour is that of a conductor's reflection; it has no albedo */
  VL_MATERIAL_ROUGH = 4,    /**< has a microfacet distribution with an alpha */
  VL_MATERIAL_REFRACTS = 8, /**< a closed shape of it refracts light */
  VL_MATERIAL_ABSENT = 16   /**< no surface: only separates media */
};

/** The principled material: glTF 2.0's metallic-roughness with its KHR_materials extensions; docs/principled.md has the
 * formulas. Its base colour is vlMaterialDef.reflectance, its index of refraction (one number; 0: infinite, full
 * reflection) vlMaterialDef.eta. The defaults are the extensions': everything beyond metal, roughness and specular is
 * off. */
typedef struct vlPrincipledDef {
  vlFloatInput metallic;                      /**< 0 to 1; default 1 */
  vlFloatInput roughness;                     /**< 0 to 1, alpha = roughness^2; default 1 */
  vlFloatInput anisotropy;                    /**< strength, 0 to 1: alpha along the tangent tends to 1 by its square */
  vlFloatInput anisotropy_rotation;           /**< radians from the tangent towards the bitangent */
  vlFloatInput specular;                      /**< factor on the dielectric's reflection; default 1 */
  vlSpectrumInput specular_color;             /**< factor on its reflection at normal incidence; default 1 */
  vlFloatInput transmission;                  /**< share of the base that transmits light instead of scattering it */
  bool thin_walled;                           /**< a sheet: no refraction; default true (glTF: no thickness) */
  float dispersion;                           /**< 20 / Abbe number; ignored for sheets */
  vlFloatInput diffuse_transmission;          /**< share of the diffuse light that leaves on the other side */
  vlSpectrumInput diffuse_transmission_color; /**< factor on that light */
  vlFloatInput clearcoat, clearcoat_roughness; /**< share that has a clear coat, 0 to 1; its alpha's square root */
  vlSpectrumInput sheen_color;                 /**< albedo of the sheen; 0: none */
  vlFloatInput sheen_roughness;                /**< square root of its alpha */
  vlFloatInput iridescence;                    /**< share that a thin film covers, 0 to 1 */
  float iridescence_ior;                       /**< index of refraction of the film; default 1.3 */
  vlFloatInput iridescence_thickness;          /**< thickness of the film, nm */
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
/** Hair (pbrt book 9.9), for curves: their v runs across the hair. */
typedef struct vlHairDef {
  vlHairColor color;                   /**< default: melanin, of eumelanin 1.3 */
  vlSpectrumInput sigma_a;             /**< VL_HAIR_SIGMA_A */
  vlFloatInput eumelanin, pheomelanin; /**< VL_HAIR_MELANIN: concentrations */
  vlFloatInput eta;                    /**< index of refraction; default 1.55 */
  vlFloatInput beta_m, beta_n;         /**< longitudinal and azimuthal roughness, 0 to 1; default 0.3 */
  vlFloatInput alpha;                  /**< tilt of the scales, degrees; default 2 */
} vlHairDef;

/** A scattering solid below a smooth or rough dielectric surface (pbrt book, 3rd edition, 11.4). Either the
 * coefficients (per unit of length, times vlMaterialDef.scale), or the reflectance of a thick piece
 * (vlMaterialDef.reflectance) and the mean free path (times vlMaterialDef.scale). eta (one number, 0.5 to 2.5) and g
 * are vlMaterialDef's. */
typedef struct vlSubsurfaceDef {
  bool from_reflectance;            /**< the second way */
  vlSpectrumInput sigma_a, sigma_s; /**< absorption and scattering; default: whole milk, per millimetre */
  vlSpectrumInput mfp;              /**< mean free path, scene units; default 1 */
} vlSubsurfaceDef;

/** A material: how a surface scatters light. One flat struct; the defaults of a kind are pbrt-v4's. */
typedef struct vlMaterialDef {
  uint32_t cookie;
  const char *name;                      /**< for messages and ids; may be null */
  vlSource source;                       /**< where the file describes it */
  vlMaterialKind kind;                   /**< which fields below are read */
  vlSpectrumInput reflectance;           /**< diffuse, coated diffuse, diffuse transmission; metals: use_reflectance */
  bool use_reflectance;                  /**< metals: eta and k follow from reflectance */
  vlFloatInput u_roughness, v_roughness; /**< of the surface; coated kinds: see coat_u_roughness */
  bool remap_roughness;                  /**< alpha = sqrt(roughness), pbrt book 9.6; else alpha = roughness */
  vlSpectrumInput eta,
      k; /**< index of refraction. Metals: both; dielectrics, coat of coated diffuse: eta, untextured */
  vlFloatInput thickness,
      g;                  /**< coat: thickness (coated diffuse: untextured), mean cosine. Subsurface: g, untextured */
  vlSpectrumInput albedo; /**< of the coat's medium; 0: it only absorbs */
  uint32_t max_depth, samples;   /**< coat: bounces inside; random walks per evaluation */
  vlFloatInput amount;           /**< mix: share of the second material */
  vlMaterialId materials[2];     /**< mix: the two materials */
  vlFloatInput displacement;     /**< bump map: height in scene units; texture index 0: none */
  const char *normal_map;        /**< path of a linear tangent-space normal map; null: none */
  vlPrincipledDef principled;    /**< principled */
  vlSpectrumInput transmittance; /**< diffuse transmission */
  float scale; /**< diffuse transmission: factor on reflectance and transmittance; subsurface: vlSubsurfaceDef */
  vlFloatInput coat_u_roughness, coat_v_roughness; /**< coated conductor: of the coat; u_roughness is the metal's */
  vlSpectrumInput coat_eta;                        /**< coated conductor: index of refraction of the coat; untextured */
  vlHairDef hair;                                  /**< hair */
  const char *measured; /**< measured: path of a spectral file of the RGL material database (Dupuy and Jakob 2018) */
  vlSubsurfaceDef subsurface; /**< subsurface */
  /** Coated diffuse with a medium that only absorbs and is not textured: a rough coat loses no light (pbrt's loses what
   * scatters between its microfacets more than once, 40 % at alpha 0.4 over white), and max_depth is not read. */
  bool conserve_energy;
} vlMaterialDef;
/** The default def of a kind. */
VL_API vlMaterialDef vl_default_material_def(vlMaterialKind kind);
/** Adds a material. Its textures and materials must have been added before. Returns index 0 on error. */
VL_API vlMaterialId vl_scene_add_material(vlScene *scene, const vlMaterialDef *def);

/* ---- participating media --------------------------------------------------------------------------------------- */

/** X(NAME, name) for each kind of medium; its parameters: velo/schema.h. Homogeneous: constant coefficients. Grid:
 * sigma_a and sigma_s times a density on a grid over a box. RGB grid: sigma_a and sigma_s on a grid. Cloud: times a
 * procedural density (pbrt-v4's cloud). NanoVDB: times a density from a NanoVDB file. */
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

/** A participating medium (pbrt book 11). Coefficients are per world unit of length, whatever the medium's transform.
 * The phase function is Henyey and Greenstein's. Kinds with a box are empty outside it. */
typedef struct vlMediumDef {
  uint32_t cookie;
  const char *name;            /**< for messages; may be null */
  vlSource source;             /**< where the file describes it */
  vlMediumKind kind;           /**< which fields below are read */
  vlSpectrum sigma_a, sigma_s; /**< absorption and scattering coefficients; default 1; not of RGB grids */
  float scale;                 /**< factor on both */
  float g;                     /**< mean cosine of scattering, -1 to 1 */
  /** sigma_a acts on each channel of linear sRGB: exp(-sigma_a x) of it remains after the distance x, as in glTF, in
   * both colour modes, independent of how the distance is divided (docs/media.md). For homogeneous media without
   * emission whose sigma_a is an RGB value or a constant. Default false: sigma_a is a spectrum, as in pbrt. */
  bool rgb_absorption;
  /** Emitted radiance: sigma_a times this per unit of length, divided by its own luminance as that of lights, times
   * emission_scale. Homogeneous and grid. */
  vlSpectrum emission;
  float emission_scale;         /**< factor on emission */
  double world_from_medium[16]; /**< medium space to world space */
  /** Grids: nx * ny * nz values, x fastest, at the centres of equal cells of the box from low to high; linear between
   * them, towards 0 at the box's faces. */
  uint32_t nx, ny, nz;
  float low[3], high[3];                  /**< corners of the box in medium space; of clouds, too */
  const float *density, *emission_scales; /**< grid: factors on both coefficients; on emission (may be null) */
  const float *temperature;               /**< grid: kelvin; black-body emission in place of `emission`; may be null */
  float temperature_offset, temperature_scale; /**< kelvin = (value - offset) * scale; no emission below 100 */
  const float *rgb_a, *rgb_s, *rgb_emission;   /**< RGB grid: 3 numbers a cell, in `space`; null coefficients: 1 */
  vlColorSpace space;                          /**< of the RGB grid */
  float cloud_density, wispiness, frequency;   /**< cloud: density, strength and frequency of the noise */
  const char *path;                            /**< path of the NanoVDB file */
  const char *grid, *temperature_grid;         /**< names of its grids; null: density, temperature (may be absent) */
} vlMediumDef;
/** The default def of a kind. */
VL_API vlMediumDef vl_default_medium_def(vlMediumKind kind);
/** Adds a medium. Returns index 0 on error: negative coefficients or values, a grid without cells, an empty box,
 * numbers that are not finite. */
VL_API vlMediumId vl_scene_add_medium(vlScene *scene, const vlMediumDef *def);

/* ---- lights ---------------------------------------------------------------------------------------------------- */

/** Emission of surfaces. Radiance = scale * L, normalised so that its luminance Y is 1 for L of Y = 1 (pbrt's
 * SpectrumToPhotometric convention, book 12.1: named, blackbody and sampled spectra are divided by their own Y). */
typedef struct vlEmissionDef {
  uint32_t cookie;
  vlSource source;     /**< where the file describes it */
  vlSpectrum radiance; /**< L */
  float scale;         /**< factor on radiance */
  double power;        /**< total power, watts (pbrt's "power"), which sets the scale; VL_UNSET: none */
  bool two_sided;      /**< both sides emit light; else the side of the normal */
  const char *image;   /**< path of an emission image over uv; null: none; or */
  vlTextureId texture; /**< a colour texture of an image (VL_TEXTURE_IMAGE), times scale; radiance is ignored */
} vlEmissionDef;
/** The default def. */
VL_API vlEmissionDef vl_default_emission_def(void);
/** Adds an emission, for any number of shapes. Returns index 0 on error. */
VL_API vlEmissionId vl_scene_add_emission(vlScene *scene, const vlEmissionDef *def);

/** X(NAME, name) for each kind of light; its description and parameters: velo/schema.h. A goniometric light's image is
 * an equal-area octahedral square (pbrt book 3.8.3) whose axis is the light's y axis. A projection light's image is its
 * intensity, projected along z, y up. */
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
  vlSource source;              /**< where the file describes it */
  vlLightKind kind;             /**< which fields below are read */
  vlSpectrum color;             /**< intensity (point, spot, ...) or radiance (distant, infinite) */
  float scale;                  /**< factor on color or image */
  double power;                 /**< lights at a point: total power, watts, which sets the scale; VL_UNSET: none */
  double illuminance;           /**< distant, infinite: lux, which sets the scale; VL_UNSET: none */
  double world_from_light[16];  /**< light space to world space */
  float from[3], to[3];         /**< light space: point: its position is `from`; spot, distant: emit from -> to */
  float cone_angle, cone_delta; /**< spot: angle of the cone's edge from its axis, width of the falloff; radians */
  bool cone_squared;            /**< falloff t^2 in the cosine, as in glTF; else pbrt's smooth step 3t^2 - 2t^3 */
  const char *path;             /**< image; infinite: square, equal-area octahedral (pbrt book 3.8.3); null: uniform */
  const vlImage *image;         /**< the image given directly, copied */
  vlColorSpace space;           /**< of an image that names none; images hold radiance, times scale; color is ignored */
  vlMediumId medium;            /**< the medium around the light */
  float fov;                    /**< projection: radians across the image's smaller side; default pi/2 */
  /** Infinite with an image: it illuminates only through a rectangle in the world, `portal`, in directions to the side
   * that (last - first) x (second - first) points to. Points that see no such direction get no light from it. */
  bool has_portal;
  float portal[4][3]; /**< the corners in order around the rectangle, world space */
} vlLightDef;
/** The default def of a kind. */
VL_API vlLightDef vl_default_light_def(vlLightKind kind);
/** Adds a light. Returns index 0 on error. */
VL_API vlLightId vl_scene_add_light(vlScene *scene, const vlLightDef *def);

/* ---- shapes ---------------------------------------------------------------------------------------------------- */

/** X(NAME, name) for each kind of shape; its description and parameters: velo/schema.h. Curves are cubic Bezier
 * segments with a width, for hair, fur and grass. */
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
  vlSource source;             /**< where the file describes it */
  vlShapeKind kind;            /**< which fields below are read */
  vlGroupId group;             /**< index 0: the world; else part of a group that instances place */
  double group_from_shape[16]; /**< shape space to group (or world) space */
  /** pbrt-v4's rule for the side of normals: dpdu x dpdv (of a triangle: by the order of its corners) in shape space is
   * transformed by the inverse transpose to group space, and flipped there if reverse_orientation differs from
   * "group_from_shape mirrors". So a mirrored mesh keeps its outside, but a sphere, disk, cylinder or curve under a
   * mirroring group_from_shape turns its normals over. Instances never flip: the side goes with the shape. Vertex
   * normals take precedence where given; only reverse_orientation flips them. */
  bool reverse_orientation;
  vlMaterialId material; /**< index 0: a default diffuse material of reflectance 0.5 */
  vlFloatInput alpha;    /**< coverage, 0 to 1; 1: opaque */
  vlEmissionId emission; /**< index 0: emits no light */
  /** Media on both sides; the normal points to the outside. Equal ids (also both 0): the shape does not separate media
   * and lies in the surrounding one. */
  vlMediumId inside, outside;
  /** Number of vertices and of faces of a mesh; curves: faces is the number of segments, vertices 4 times that. */
  uint32_t vertices, faces;
  const float *positions;     /**< 3 a vertex, shape space */
  const float *normals;       /**< 3 a vertex, shape space; may be null */
  const float *tangents;      /**< 3 a vertex, shape space, pbrt's S; may be null */
  const float *uvs;           /**< 2 a vertex; may be null */
  const uint32_t *indices;    /**< triangles: 3 a face; bilinear: 4 a face (pbrt's order p00 p10 p01 p11) */
  const float *tangent_signs; /**< triangles: 1 a vertex: the bitangent is sign * n x tangent; null: 1 */
  const float *more_uvs[3];   /**< triangles: 2 a vertex: uv sets 1 to 3; may be null */
  const float *colors;        /**< triangles: 4 a vertex: linear R G B and coverage; may be null */
  bool one_sided;             /**< triangles: rays pass through their backs */
  /** Moving triangles: the vertices (and normals) at times[1]; those above are at times[0]; linear between, at rest
   * before and after. May be null. Such a mesh cannot emit light. */
  const float *positions_close, *normals_close;
  double times[2]; /**< seconds; default 0, 1 */
  /** Triangles at rest: a float texture displaces them along their normals, in scene units (texture index 0: none),
   * once they are subdivided until no edge is longer than edge_length. At most 2^24 triangles, else vl_world_build
   * fails. */
  vlFloatInput displacement;
  float edge_length; /**< group space; default 1 */
  /** Sphere, disk, cylinder: pbrt's parameters, around the z axis, shape space (book 6.2-6.4); phi_max in radians. */
  float radius, inner_radius, z_min, z_max, height, phi_max;
  /** Many whole spheres as one shape, 28 bytes each (a sphere of its own takes some 750): `faces` of them; the numbers
   * above are not read. Both null: one sphere at the origin. They cannot emit light. */
  const double *centers; /**< 3 a sphere, shape space */
  const float *radii;    /**< 1 a sphere, above 0 */
  /** Curves: positions has the 4 Bezier points of each segment. They cannot emit light. u runs along a segment, v from
   * one side to the other. Ribbons: normals has those at both ends of each segment (6 numbers a face). */
  vlCurveKind curve;
  const float *widths; /**< curves: 2 a face, at its ends, shape space */
  /** Curves: segments are cut into 2^split_depth pieces for speed, fewer where there are millions; default 3. The image
   * does not depend on it. */
  uint32_t split_depth;
} vlShapeDef;
/** The default def of a kind. */
VL_API vlShapeDef vl_default_shape_def(vlShapeKind kind);
/** Adds a shape. Returns index 0 on error: an index out of range, a position or normal that is not finite (the message
 * names the vertex), radius <= 0, ... */
VL_API vlShapeId vl_scene_add_shape(vlScene *scene, const vlShapeDef *def);

/** Adds an empty group; shapes join it by vlShapeDef.group. name may be null. Returns index 0 on error. */
VL_API vlGroupId vl_scene_add_group(vlScene *scene, const char *name);
/** Places a group in the world (groups do not nest). Errors: vl_scene_result. */
VL_API void vl_scene_add_instance(vlScene *scene, vlGroupId group, const double world_from_group[16], vlSource source);
/** Places a group in motion: `keys` poses (16 numbers each) at ascending times, in seconds. Between them translation,
 * rotation and scale are interpolated separately (formulas: src/math/motion.h); it is at rest before the first and
 * after the last. Errors (vl_scene_result): a singular pose, a pose that mirrors next to one that does not, times that
 * do not ascend. */
VL_API void vl_scene_add_moving_instance(vlScene *scene, vlGroupId group, uint32_t keys, const double *times,
                                         const double *world_from_group, vlSource source);

/* ---- how the image is taken ------------------------------------------------------------------------------------ */

/** X(NAME, name) for each tracer; what pbrt files call it: velo/schema.h. Those that follow light both ways
 * (docs/tracers.md): with solids that light goes through (VL_MATERIAL_SUBSURFACE), or where something moves while the
 * camera's rows are read out, VL_TRACER_VOLPATH stands in. */
#define VL_TRACER_KINDS(X)                                                                                            \
  X(PATH, path) /* ignores media */                                                                                   \
  X(RAYCAST, raycast)                                                                                                 \
  X(AMBIENT_OCCLUSION, ambient_occlusion)                                                                             \
  X(VOLPATH, volpath)             /* through media and solids; where there are none the same as PATH, to the bit */   \
  X(BIDIRECTIONAL, bidirectional) /* paths from the camera, and paths from the lights that it sees; unbiased */       \
  X(MERGING, merging)             /* and both meet at surfaces, within a radius that shrinks with each pass */        \
  X(SPPM, sppm)                   /* the same; smooth surfaces on the camera's path are no bounces, as pbrt counts */ \
  X(LIGHT_PATH, light_path)       /* from the lights alone: no light through or in what is smooth */                  \
  X(RANDOM_WALK, random_walk)     /* samples no light and scatters all over the sphere: for comparison */
/** Light transport algorithms (docs/tracers.md). */
typedef enum vlTracer {
#define VL_KIND(NAME, name) VL_TRACER_##NAME,
  VL_TRACER_KINDS(VL_KIND)
#undef VL_KIND
} vlTracer;
/** X(NAME, name) for each sampler; what it is and what pbrt files call it: velo/schema.h. */
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
/** Sample generators (src/trace/sampler/sampler.h): the lecture's, and the low-discrepancy ones of pbrt book 8.6-8.7.
 */
typedef enum vlSamplerKind {
#define VL_KIND(NAME, name) VL_SAMPLER_##NAME,
  VL_SAMPLER_KINDS(VL_KIND)
#undef VL_KIND
} vlSamplerKind;
/** X(NAME, name) for each kind of pixel filter; its description and parameters: velo/schema.h. */
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
  float radius_x, radius_y; /**< half of its extent, pixels */
  float sigma;              /**< Gaussian: standard deviation, pixels */
  float b, c;               /**< Mitchell: its parameters */
  float tau;                /**< Lanczos: number of cycles of the sinc */
} vlPixelFilter;
/** The default filter of a kind, with pbrt-v4's default sizes. */
VL_API vlPixelFilter vl_default_pixel_filter(vlPixelFilterKind kind);
/** The coordinate system of ground truth channels that the scene's file requests (pbrt's gbuffer film); NONE: no
 * channels. */
typedef enum vlGbuffer { VL_GBUFFER_NONE, VL_GBUFFER_CAMERA, VL_GBUFFER_WORLD } vlGbuffer;
/** What the channels of radiance are: 4 sampled wavelengths, or R, G, B. */
typedef enum vlColorMode { VL_COLOR_SPECTRAL, VL_COLOR_RGB } vlColorMode;
/** How a light is selected: by a light BVH (pbrt book 12.6), by power, uniformly. */
typedef enum vlLightSampler { VL_LIGHT_SAMPLER_BVH, VL_LIGHT_SAMPLER_POWER, VL_LIGHT_SAMPLER_UNIFORM } vlLightSampler;

/** How the image is taken: camera, film, build, render and develop, as the scene's file says (velo/render.h). */
typedef struct vlSceneDefs vlSceneDefs;
/** The scene's defs, never null. The scene owns them and what their pointers point at. May be changed until the scene
 * is destroyed. */
VL_API vlSceneDefs *vl_scene_defs(vlScene *scene);
/** Copies camera, image size and crop from another scene of the same context, with what its lens needs, so that `from`
 * may be destroyed. ARGUMENT, MEMORY. */
VL_API vlResult vl_scene_take_camera(vlScene *scene, vlScene *from, vlError *error);
/** Focuses the scene's camera, one with a lens of many elements, at a distance from its film, scene units. ARGUMENT,
 * MEMORY. */
VL_API vlResult vl_scene_refocus(vlScene *scene, double distance, vlError *error);

/** Creates an empty scene. ARGUMENT, MEMORY. */
VL_API vlResult vl_scene_create(vlContext *context, vlScene **scene);
/** Null is allowed. */
VL_API void vl_scene_destroy(vlScene *scene);
/** The scene's first error; VL_OK if there is none. error may be null. */
VL_API vlResult vl_scene_result(const vlScene *scene, vlError *error);

/** How to read a scene file. Formats other than glTF ignore all but `permissive`. */
typedef struct vlLoadDef {
  uint32_t cookie;
  bool permissive;       /**< features that are not supported are warnings, not errors */
  double time;           /**< glTF: of animations, seconds; unset: as modelled */
  double time_close;     /**< glTF: when the shutter closes, later than time, for motion blur; unset: no motion */
  const char *scene;     /**< glTF: name or number from 0; null: the file's default */
  const char *animation; /**< glTF: name or number from 0; null: the first */
  const char *variant;   /**< glTF: name of a material variant; null: the file's default */
  const char *camera;    /**< glTF: name or number from 0; null: the first */
} vlLoadDef;
/** The default def. */
VL_API vlLoadDef vl_default_load_def(void);
/** Adds the contents of a file to the scene. The suffix selects the format (.pbrt, .gltf, .glb, .obj, .ply; .gz after
 * pbrt, obj, ply); relative paths are relative to the file. def may be null. Errors: SCENE, MISSING, IO, MEMORY,
 * UNSUPPORTED (valid, but not supported; the message says what). */
VL_API vlResult vl_scene_load(vlScene *scene, const char *path, const vlLoadDef *def, vlError *error);

/** The environment (light from all directions) that vl_scene_complete adds. */
typedef enum vlEnvironmentKind {
  VL_ENVIRONMENT_AUTO,   /**< the studio where vlSceneDefs.light_missing; dim where the scene has other lights */
  VL_ENVIRONMENT_NONE,   /**< none is added */
  VL_ENVIRONMENT_STUDIO, /**< neutral: soft lights above and in front in a grey room */
  VL_ENVIRONMENT_SKY,    /**< a clear sky and the sun */
  VL_ENVIRONMENT_WHITE,  /**< radiance 1 from all directions */
  VL_ENVIRONMENT_FILE    /**< the image at `path` */
} vlEnvironmentKind;
/** What to add to a scene that lacks a camera, light or a ground. */
typedef struct vlCompleteDef {
  uint32_t cookie;
  uint32_t width, height;        /**< of the image, pixels, for framing and where the file gives none; 0: the film's */
  vlEnvironmentKind environment; /**< default AUTO */
  const char *path;       /**< FILE: an image twice as wide as high (longitude, latitude; its centre is in the direction
                           * -front)       or square (equal-area octahedral) */
  double rotation;        /**< of the environment, radians about up, counter-clockwise as seen from above */
  float strength;         /**< factor on the environment's radiance */
  double up[3], front[3]; /**< directions of the world; default +y, +z (glTF's) */
  bool ground;            /**< adds a wide grey disk under everything */
  bool reframe;           /**< replaces the file's camera, too */
} vlCompleteDef;
/** The default def. */
VL_API vlCompleteDef vl_default_complete_def(void);
/** Adds what is missing (vlSceneDefs.camera_missing, light_missing) or requested. The new camera frames everything from
 * the front, a little from the right and above. def may be null. Errors: as vl_scene_result; MISSING, IO (path). */
VL_API vlResult vl_scene_complete(vlScene *scene, const vlCompleteDef *def, vlError *error);

/** The size of a scene. */
typedef struct vlSceneInfo {
  /** Counts. Those of a group count once, however many instances it has; emissive_shapes are among shapes. */
  uint64_t shapes, triangles, vertices, textures, materials, lights, emissive_shapes, groups, instances, media;
} vlSceneInfo;
/** Counts the contents of a scene. */
VL_API void vl_scene_info(const vlScene *scene, vlSceneInfo *info);
/** How many things of that kind the scene holds. family: the name of a family of velo/schema.h: "materials",
 * "textures", "media", "lights", "shapes"; 0 for other names. */
VL_API uint64_t vl_scene_kind_count(const vlScene *scene, const char *family, uint32_t kind);

#ifdef __cplusplus
}
#endif
#endif
