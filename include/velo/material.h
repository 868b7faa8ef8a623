/** @file
 * velo/material.h: materials: their kinds, and the def with their parameters. */
#ifndef VELO_MATERIAL_H
#define VELO_MATERIAL_H

#include "velo/spectrum.h"

#ifdef __cplusplus
extern "C" {
#endif

/** X(kind, name, row, compile) for each kind of material. velo/schema.h describes the kinds and
 * their parameters. compile: the function of the library that chooses the BSDF. */
#define VL_MATERIAL_KINDS(X)                                                                 \
  X(VL_MATERIAL_DIFFUSE, diffuse, vl_material_row_diffuse, vl_compile_diffuse_material)      \
  X(VL_MATERIAL_COATED_DIFFUSE, coated_diffuse, vl_material_row_coated_diffuse,              \
    vl_compile_coated_diffuse_material)                                                      \
  X(VL_MATERIAL_CONDUCTOR, conductor, vl_material_row_conductor,                             \
    vl_compile_conductor_material)                                                           \
  X(VL_MATERIAL_DIELECTRIC, dielectric, vl_material_row_dielectric,                          \
    vl_compile_dielectric_material)                                                          \
  X(VL_MATERIAL_THIN_DIELECTRIC, thin_dielectric, vl_material_row_thin_dielectric,           \
    vl_compile_thin_dielectric_material)                                                     \
  X(VL_MATERIAL_MIX, mix, vl_material_row_mix, vl_compile_mix_material)                      \
  X(VL_MATERIAL_PRINCIPLED, principled, vl_material_row_principled,                          \
    vl_compile_principled_material) /* layers: glTF's material with its extensions */        \
  X(VL_MATERIAL_DIFFUSE_TRANSMISSION, diffuse_transmission,                                  \
    vl_material_row_diffuse_transmission, vl_compile_diffuse_transmission_material)          \
  X(VL_MATERIAL_COATED_CONDUCTOR, coated_conductor, vl_material_row_coated_conductor,        \
    vl_compile_coated_conductor_material)                                                    \
  X(VL_MATERIAL_HAIR, hair, vl_material_row_hair, vl_compile_hair_material)                  \
  X(VL_MATERIAL_MEASURED, measured, vl_material_row_measured,                                \
    vl_compile_measured_material) /* a BRDF from a file */                                   \
  X(VL_MATERIAL_SUBSURFACE, subsurface, vl_material_row_subsurface,                          \
    vl_compile_subsurface_material) /* a solid that scatters light inside: VL_TRACER_VOLPATH \
                                       only; else glass */                                   \
  X(VL_MATERIAL_INTERFACE, interface, vl_material_row_interface, vl_compile_interface_material)
/** The kinds of materials: VL_MATERIAL_DIFFUSE and so on, from VL_MATERIAL_KINDS. */
typedef enum vlMaterialKind {
#define VL_KIND(kind, ...) kind,
  VL_MATERIAL_KINDS(VL_KIND)
#undef VL_KIND
} vlMaterialKind;

/** The principled material: glTF 2.0's metallic-roughness with its KHR_materials extensions;
 * docs/principled.md has the formulas. Its base colour is vlMaterialDef.reflectance. Its index
 * of refraction is vlMaterialDef.eta, one number; 0 means infinite, that is full reflection.
 * The defaults are those of glTF's extensions: all layers other than metallic, roughness and
 * specular are off. */
typedef struct vlPrincipledDef {
  vlFloatInput metallic;  /**< 0 to 1; default 1 */
  vlFloatInput roughness; /**< 0 to 1, alpha = roughness^2; default 1 */
  /** strength, 0 to 1: alpha along the tangent is mix(alpha, 1, strength^2) */
  vlFloatInput anisotropy;
  vlFloatInput anisotropy_rotation; /**< radians from the tangent towards the bitangent */
  vlFloatInput specular;            /**< factor on the dielectric's reflection; default 1 */
  vlSpectrumInput specular_color;   /**< factor on the dielectric's reflection at normal
                                       incidence; default 1 */
  /** share of the base that transmits light instead of scattering it */
  vlFloatInput transmission;
  bool thin_walled; /**< a thin sheet, which does not refract; default true (as in glTF without
                       thickness) */
  float dispersion; /**< 20 / Abbe number; ignored if thin_walled */
  vlFloatInput diffuse_transmission; /**< share of the diffuse light that is transmitted to the
                                        other side */
  vlSpectrumInput diffuse_transmission_color;  /**< factor on the diffusely transmitted light */
  vlFloatInput clearcoat, clearcoat_roughness; /**< coverage of the clear coat, 0 to 1; its
                                                  roughness, the square root of its alpha */
  vlSpectrumInput sheen_color;                 /**< albedo of the sheen; 0: none */
  vlFloatInput sheen_roughness; /**< roughness of the sheen, the square root of its alpha */
  vlFloatInput iridescence;     /**< coverage of the thin film, 0 to 1 */
  float iridescence_ior;        /**< index of refraction of the film; default 1.3 */
  vlFloatInput iridescence_thickness; /**< thickness of the film, nm */
  /** Tangent-space normal maps of the base and of the clear coat: linear colour textures
   * (VL_TEXTURE_IMAGE, not clamped); index 0: none. */
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
  /** how the colour is given; default VL_HAIR_MELANIN, with eumelanin 1.3 */
  vlHairColor color;
  vlSpectrumInput sigma_a;             /**< VL_HAIR_SIGMA_A: absorption coefficient */
  vlFloatInput eumelanin, pheomelanin; /**< VL_HAIR_MELANIN: concentrations */
  vlFloatInput eta;                    /**< index of refraction; default 1.55 */
  vlFloatInput beta_m, beta_n; /**< longitudinal and azimuthal roughness, 0 to 1; default 0.3 */
  vlFloatInput alpha;          /**< tilt of the scales, degrees; default 2 */
} vlHairDef;

/** A solid that scatters light below a smooth or rough dielectric surface (pbrt book, 3rd
 * edition, 11.4). It is given in one of two ways: by sigma_a and sigma_s (per unit of length,
 * times vlMaterialDef.scale); or by the reflectance of a thick piece
 * (vlMaterialDef.reflectance) and the mean free path (times vlMaterialDef.scale).
 * vlMaterialDef.eta (one number, 0.5 to 2.5) and vlMaterialDef.g are read, too. */
typedef struct vlSubsurfaceDef {
  bool from_reflectance; /**< true: given by reflectance and mfp; false: by sigma_a and sigma_s
                          */
  vlSpectrumInput sigma_a, sigma_s; /**< absorption and scattering coefficients; default: those
                                       of whole milk, per millimetre */
  vlSpectrumInput mfp;              /**< mean free path, scene units; default 1 */
} vlSubsurfaceDef;

/** A material: how a surface scatters light. One struct holds the parameters of all kinds; the
 * defaults of a kind are pbrt-v4's. */
struct vlMaterialDef {
  uint32_t cookie;
  const char *name;            /**< for messages and ids; may be null */
  const char *place;           /**< index in a file without lines: materials[2]; may be null */
  vlSource source;             /**< where the file describes it */
  vlMaterialKind kind;         /**< which fields below are read */
  vlSpectrumInput reflectance; /**< reflectance: diffuse, coated diffuse, diffuse transmission;
                                  metals with use_reflectance */
  bool use_reflectance;        /**< metals: eta and k are computed from reflectance */
  vlFloatInput u_roughness, v_roughness; /**< roughness of the surface; coated conductor: of the
                                            metal; coated diffuse: of the coat */
  bool remap_roughness;   /**< true: alpha = sqrt(roughness) (pbrt book 9.6); false: alpha =
                           * roughness
                           */
  vlSpectrumInput eta, k; /**< index of refraction. Metals: eta and k; dielectrics and the coat
                             of coated diffuse: eta, untextured */
  vlFloatInput thickness, g;   /**< coat: its thickness (coated diffuse: untextured) and its
                                  medium's mean cosine. Subsurface: g, untextured */
  vlSpectrumInput albedo;      /**< albedo of the coat's medium; 0: the medium only absorbs */
  uint32_t max_depth, samples; /**< coat: largest number of bounces inside it; number of random
                                  walks per evaluation */
  vlFloatInput amount;         /**< mix: share of the second material */
  vlMaterialId materials[2];   /**< mix: the two materials */
  vlFloatInput displacement;   /**< bump map: height in scene units; texture index 0: none */
  const char *normal_map;      /**< path of a linear tangent-space normal map; null: none */
  vlPrincipledDef principled;  /**< parameters of the principled material */
  vlSpectrumInput transmittance; /**< diffuse transmission: its transmittance */
  float scale; /**< diffuse transmission: factor on reflectance and transmittance; subsurface:
                  see vlSubsurfaceDef */
  /** coated conductor: roughness of the coat */
  vlFloatInput coat_u_roughness, coat_v_roughness;
  /** coated conductor: index of refraction of the coat; untextured */
  vlSpectrumInput coat_eta;
  vlHairDef hair;       /**< parameters of hair */
  const char *measured; /**< measured: path of a spectral file of the RGL material database
                           (Dupuy and Jakob 2018) */
  vlSubsurfaceDef subsurface; /**< parameters of the subsurface material */
  /** Coated diffuse, if its medium only absorbs and is not textured: true makes a rough coat
   * conserve energy, and max_depth is not read. Otherwise, as in pbrt, a rough coat loses the
   * light that scatters more than once between its microfacets: 40 % at alpha 0.4 over a white
   * base. */
  bool conserve_energy;
};
/** The default def of a kind. */
VL_API vlMaterialDef vl_default_material_def(vlMaterialKind kind);
/** Adds a material. Its textures and materials must have been added before. Returns index 0 on
 * error. */
VL_API vlMaterialId vl_scene_add_material(vlScene *scene, const vlMaterialDef *def);

#ifdef __cplusplus
}
#endif
#endif
