/* schema/materials.c: rows of the materials. Names in files and defaults are those of pbrt-v4;
 * the principled material's are those of glTF. */
#include "schema/schema.h"
#include "velo/material.h"

#define BOOL(...) VL_PARAMETER(BOOL, vlMaterialDef, __VA_ARGS__)
#define COUNT(...) VL_PARAMETER(COUNT, vlMaterialDef, __VA_ARGS__)
#define FLOAT(...) VL_PARAMETER(FLOAT, vlMaterialDef, __VA_ARGS__)
#define CHOICE(...) VL_PARAMETER(CHOICE, vlMaterialDef, __VA_ARGS__)
#define FILE_NAME(...) VL_PARAMETER(FILE, vlMaterialDef, __VA_ARGS__)
#define INPUT(...) VL_PARAMETER(FLOAT_INPUT, vlMaterialDef, __VA_ARGS__)
#define SPECTRUM(...) VL_PARAMETER(SPECTRUM_INPUT, vlMaterialDef, __VA_ARGS__)
#define TEXTURE(...) VL_PARAMETER(TEXTURE, vlMaterialDef, __VA_ARGS__)
#define BLOCK(...) VL_PARAMETER(BLOCK, vlMaterialDef, __VA_ARGS__)

#define CLAMPED(least, most) VL_RANGE(least, most), .flags = VL_PARAMETER_CLAMPED
#define ALBEDO CLAMPED(0, 1), .role = VL_PARAMETER_ALBEDO
#define UNBOUNDED VL_FROM(0), .role = VL_PARAMETER_UNBOUNDED
#define SHARE CLAMPED(0, 1)

/* Parameters that several kinds share. */
#define BUMPS_(own)                                                                     \
  INPUT("displacement", displacement, "bump map: height in the scene's unit of length", \
        .flags = (own)),                                                                \
      FILE_NAME("normalmap", normal_map,                                                \
                "normal map: an image of tangent-space normals, linear", .flags = (own))
#define BUMPS BUMPS_(0)
#define REFLECTANCE(value, text) \
  SPECTRUM("reflectance", reflectance, text, VL_DEFAULT(value), ALBEDO)
#define REMAP                                                                            \
  BOOL("remaproughness", remap_roughness,                                                \
       "true: alpha is the square root of the roughness; false: alpha is the roughness", \
       VL_DEFAULT(1))
#define ROUGHNESS                                                                   \
  INPUT("roughness", u_roughness, "sets uroughness and vroughness",                 \
        VL_SECOND(vlMaterialDef, v_roughness), VL_FROM(0),                          \
        .flags = VL_PARAMETER_SHORTHAND | VL_PARAMETER_CLAMPED),                    \
      INPUT("uroughness", u_roughness, "roughness along the tangent", ROUGH_RANGE), \
      INPUT("vroughness", v_roughness, "roughness across the tangent", ROUGH_RANGE), REMAP
#define ROUGH_RANGE VL_FROM(0), .flags = VL_PARAMETER_CLAMPED
#define ETA_DIELECTRIC        \
  VL_DEFAULT(1.5), UNBOUNDED, \
      .flags = VL_PARAMETER_NUMBER | VL_PARAMETER_NO_TEXTURE | VL_PARAMETER_ABOVE_LOW
#define LAYERS                                                                                \
  INPUT("thickness", thickness, "thickness of the medium under the coat, in mean free paths", \
        VL_DEFAULT(0.01)),                                                                    \
      INPUT("g", g, "asymmetry g (mean cosine of scattering) of the medium under the coat",   \
            CLAMPED(-0.999, 0.999)),                                                          \
      SPECTRUM("albedo", albedo, "albedo of the medium under the coat; 0: it only absorbs",   \
               VL_DEFAULT(0), ALBEDO),                                                        \
      COUNT("maxdepth", max_depth, "largest number of bounces between the layers",            \
            VL_DEFAULT(10), VL_RANGE(1, 4294967295.0)),                                       \
      COUNT("nsamples", samples,                                                              \
            "random walks per evaluation, where the material uses random walks",              \
            VL_DEFAULT(1), VL_RANGE(1, 4294967295.0)),                                        \
      BOOL("conserveenergy", conserve_energy,                                                 \
           "compensates the energy that a rough coat over a diffuse base loses",              \
           .flags = VL_PARAMETER_OWN)
#define METAL(eta_name, k_name)                                                             \
  SPECTRUM(eta_name, eta, "index of refraction of the metal", .text = "metal-Cu-eta",       \
           UNBOUNDED),                                                                      \
      SPECTRUM(k_name, k, "extinction coefficient of the metal", .text = "metal-Cu-k",      \
               UNBOUNDED),                                                                  \
      SPECTRUM("reflectance", reflectance,                                                  \
               "reflectance at normal incidence; replaces the index of refraction and the " \
               "extinction coefficient",                                                    \
               VL_DEFAULT(0.5), ALBEDO),                                                    \
      BOOL(NULL, use_reflectance, "use reflectance instead of eta and k")

/* ---- one layer
 * ---------------------------------------------------------------------------------------------------
 */

static const vlParameter diffuse_parameters[] = {
    REFLECTANCE(0.5, "fraction of light that is reflected"), BUMPS};
VL_KIND_ROW(diffuse, .name = "diffuse", .description = "Lambertian reflection",
            .traits = VL_MATERIAL_OPAQUE)

static const vlParameter conductor_parameters[] = {METAL("eta", "k"), ROUGHNESS, BUMPS};
VL_KIND_ROW(conductor, .name = "conductor", .description = "a smooth or rough metal",
            .traits = VL_MATERIAL_OPAQUE | VL_MATERIAL_METAL | VL_MATERIAL_ROUGH)

static const vlParameter dielectric_parameters[] = {
    SPECTRUM("eta", eta, "index of refraction of the inside, relative to the outside",
             ETA_DIELECTRIC),
    ROUGHNESS, BUMPS};
VL_KIND_ROW(dielectric, .name = "dielectric",
            .description = "a smooth or rough dielectric, such as glass or water",
            .traits = VL_MATERIAL_ROUGH | VL_MATERIAL_REFRACTS)

static const vlParameter thin_dielectric_parameters[] = {
    SPECTRUM("eta", eta, "index of refraction", ETA_DIELECTRIC), BUMPS};
VL_KIND_ROW(thin_dielectric, .name = "thindielectric",
            .description = "a thin sheet of glass, without refraction")

static const vlParameter diffuse_transmission_parameters[] = {
    REFLECTANCE(0.25, "fraction of light that is reflected"),
    SPECTRUM("transmittance", transmittance, "fraction of light that is transmitted",
             VL_DEFAULT(0.25), ALBEDO),
    FLOAT("scale", scale, "factor on reflectance and transmittance", VL_DEFAULT(1), VL_FROM(0)),
    BUMPS};
VL_KIND_ROW(diffuse_transmission, .name = "diffusetransmission",
            .description = "Lambertian reflection and transmission, as of leaves and paper")

static const char *const hair_colors[] = {"sigma_a", "reflectance", "melanin", NULL};
static const vlParameter hair_parameters[] = {
    CHOICE(
        NULL, hair.color,
        "the parameters that give the absorption: sigma_a, reflectance, or eu- and pheomelanin",
        VL_DEFAULT(VL_HAIR_MELANIN), .choices = hair_colors),
    SPECTRUM("sigma_a", hair.sigma_a, "absorption coefficient, per radius of the hair",
             VL_DEFAULT(0), UNBOUNDED),
    SPECTRUM("reflectance", reflectance, "colour that the hair has as a whole", VL_DEFAULT(0.5),
             ALBEDO, .alias = "color"),
    INPUT("eumelanin", hair.eumelanin, "concentration of eumelanin, the brown pigment",
          VL_DEFAULT(1.3), ROUGH_RANGE),
    INPUT("pheomelanin", hair.pheomelanin, "concentration of pheomelanin, the red pigment",
          ROUGH_RANGE),
    INPUT("eta", hair.eta, "index of refraction of the hair", VL_DEFAULT(1.55),
          CLAMPED(1.0001, 10)),
    INPUT("beta_m", hair.beta_m, "roughness along the hair", VL_DEFAULT(0.3), SHARE),
    INPUT("beta_n", hair.beta_n, "roughness around the hair", VL_DEFAULT(0.3), SHARE),
    INPUT("alpha", hair.alpha, "angle by which the scales on the hair are tilted",
          VL_DEFAULT(2), .unit = "degrees"),
    BUMPS_(VL_PARAMETER_OWN),
};
VL_KIND_ROW(hair, .name = "hair", .description = "hair and fur (pbrt book 9.9); for curves")

static const vlParameter measured_parameters[] = {
    FILE_NAME("filename", measured,
              "required: a .bsdf file with spectra from the RGL material database",
              .flags = VL_PARAMETER_REQUIRED),
    BUMPS};
VL_KIND_ROW(measured, .name = "measured",
            .description = "a measured BRDF (Dupuy and Jakob 2018)")

/* ---- several layers
 * ----------------------------------------------------------------------------------------------
 */

static const vlParameter coated_diffuse_parameters[] = {
    REFLECTANCE(0.5, "reflectance of the base"), ROUGHNESS,
    SPECTRUM("eta", eta, "index of refraction of the coat", ETA_DIELECTRIC), LAYERS, BUMPS};
VL_KIND_ROW(coated_diffuse, .name = "coateddiffuse",
            .description = "a dielectric coat over a diffuse base",
            .traits = VL_MATERIAL_OPAQUE | VL_MATERIAL_ROUGH)

static const vlParameter coated_conductor_parameters[] = {
    METAL("conductor.eta", "conductor.k"),
    INPUT("conductor.roughness", u_roughness,
          "sets conductor.uroughness and conductor.vroughness",
          VL_SECOND(vlMaterialDef, v_roughness), VL_FROM(0),
          .flags = VL_PARAMETER_SHORTHAND | VL_PARAMETER_CLAMPED),
    INPUT("conductor.uroughness", u_roughness, "roughness of the metal, along the tangent",
          ROUGH_RANGE),
    INPUT("conductor.vroughness", v_roughness, "roughness of the metal, across the tangent",
          ROUGH_RANGE),
    INPUT("interface.roughness", coat_u_roughness,
          "sets interface.uroughness and interface.vroughness",
          VL_SECOND(vlMaterialDef, coat_v_roughness), VL_FROM(0),
          .flags = VL_PARAMETER_SHORTHAND | VL_PARAMETER_CLAMPED),
    INPUT("interface.uroughness", coat_u_roughness, "roughness of the coat, along the tangent",
          ROUGH_RANGE),
    INPUT("interface.vroughness", coat_v_roughness, "roughness of the coat, across the tangent",
          ROUGH_RANGE),
    REMAP,
    SPECTRUM("interface.eta", coat_eta, "index of refraction of the coat", ETA_DIELECTRIC),
    LAYERS,
    BUMPS,
};
VL_KIND_ROW(coated_conductor, .name = "coatedconductor",
            .description = "a dielectric coat over a metal",
            .traits = VL_MATERIAL_OPAQUE | VL_MATERIAL_METAL | VL_MATERIAL_ROUGH)

static const vlParameter principled_parameters[] = {
    SPECTRUM("basecolor", reflectance, "colour of the diffuse base, or of the metal",
             VL_DEFAULT(1), ALBEDO),
    INPUT("metallic", principled.metallic, "fraction of the base that is metal", VL_DEFAULT(1),
          SHARE),
    INPUT("roughness", principled.roughness, "roughness of the base; alpha is its square",
          VL_DEFAULT(1), SHARE),
    INPUT(
        "anisotropy", principled.anisotropy,
        "strength of the anisotropy: its square interpolates alpha along the tangent towards 1",
        SHARE),
    INPUT("anisotropyrotation", principled.anisotropy_rotation,
          "angle of the anisotropy's direction from the tangent towards the bitangent",
          .unit = "degrees", .factor = 0.017453292519943295, .flags = VL_PARAMETER_FILE_NUMBER),
    SPECTRUM("eta", eta, "index of refraction; 0: infinite, full reflection", VL_DEFAULT(1.5),
             VL_FROM(0), .role = VL_PARAMETER_UNBOUNDED,
             .flags = VL_PARAMETER_ONE_NUMBER | VL_PARAMETER_NO_TEXTURE),
    INPUT("specular", principled.specular, "factor on the dielectric's reflection",
          VL_DEFAULT(1), SHARE),
    SPECTRUM("specularcolor", principled.specular_color,
             "factor on the dielectric's reflection at normal incidence", VL_DEFAULT(1),
             UNBOUNDED),
    INPUT("transmission", principled.transmission,
          "fraction of the dielectric base that transmits light", SHARE),
    BOOL("thinwalled", principled.thin_walled,
         "true: the surface is a thin sheet, without refraction", VL_DEFAULT(1)),
    FLOAT("dispersion", principled.dispersion,
          "dispersion: 20 divided by the Abbe number; no effect with thinwalled", VL_FROM(0)),
    INPUT("diffusetransmission", principled.diffuse_transmission,
          "fraction of the diffuse light that is transmitted", SHARE),
    SPECTRUM("diffusetransmissioncolor", principled.diffuse_transmission_color,
             "colour of the diffusely transmitted light", VL_DEFAULT(1), ALBEDO),
    INPUT("clearcoat", principled.clearcoat, "fraction of the surface that a clear coat covers",
          SHARE),
    INPUT("clearcoatroughness", principled.clearcoat_roughness, "roughness of the clear coat",
          SHARE),
    SPECTRUM("sheencolor", principled.sheen_color, "colour of the sheen; black: no sheen",
             VL_DEFAULT(0), ALBEDO),
    INPUT("sheenroughness", principled.sheen_roughness, "roughness of the sheen", SHARE),
    INPUT("iridescence", principled.iridescence,
          "fraction of the surface that a thin film covers", SHARE),
    FLOAT("iridescenceeta", principled.iridescence_ior, "index of refraction of the thin film",
          VL_DEFAULT(1.3), VL_FROM(1)),
    INPUT("iridescencethickness", principled.iridescence_thickness,
          "thickness of the thin film", VL_DEFAULT(400), .unit = "nm", VL_FROM(0),
          .flags = VL_PARAMETER_CLAMPED),
    TEXTURE(NULL, principled.normal, "a tangent-space normal map"),
    FLOAT(NULL, principled.normal_scale, "factor on x and y of the normal map", VL_DEFAULT(1)),
    TEXTURE(NULL, principled.clearcoat_normal, "a normal map of the clear coat"),
    FLOAT(NULL, principled.clearcoat_normal_scale,
          "factor on x and y of the clear coat's normal map", VL_DEFAULT(1)),
    BUMPS,
};
VL_KIND_ROW(principled, .name = "principled",
            .description = "glTF's layered material (principled.md)",
            .traits = VL_MATERIAL_ROUGH)

static const vlParameter subsurface_parameters[] = {
    {.name = "name",
     .member = "subsurface",
     .type = VL_PARAMETER_STRING,
     .offset = offsetof(vlMaterialDef, subsurface),
     .flags = VL_PARAMETER_RULE | VL_PARAMETER_SHORTHAND,
     .description =
         "a measured substance (media.md); replaces sigma_a, sigma_s, reflectance and mfp"},
    SPECTRUM("sigma_a", subsurface.sigma_a, "absorption coefficient, per unit of length",
             VL_DEFAULT(0.0011, 0.0024, 0.014), VL_FROM(0), .role = VL_PARAMETER_UNBOUNDED,
             .flags = VL_PARAMETER_RGB),
    SPECTRUM("sigma_s", subsurface.sigma_s, "scattering coefficient, per unit of length",
             VL_DEFAULT(2.55, 3.21, 3.77), VL_FROM(0), .role = VL_PARAMETER_UNBOUNDED,
             .flags = VL_PARAMETER_RGB),
    SPECTRUM("reflectance", reflectance,
             "reflectance of a thick slab; with mfp it replaces sigma_a and sigma_s",
             VL_DEFAULT(0.5), ALBEDO),
    SPECTRUM("mfp", subsurface.mfp,
             "mean free path, used with reflectance, in the scene's unit of length",
             VL_DEFAULT(1), UNBOUNDED),
    BOOL(NULL, subsurface.from_reflectance,
         "use reflectance and mfp instead of sigma_a and sigma_s"),
    FLOAT("scale", scale, "factor on sigma_a and sigma_s, or on mfp", VL_DEFAULT(1),
          VL_FROM(0)),
    SPECTRUM("eta", eta, "index of refraction", VL_DEFAULT(1.33), VL_RANGE(0.5, 2.5),
             .role = VL_PARAMETER_UNBOUNDED,
             .flags = VL_PARAMETER_ONE_NUMBER | VL_PARAMETER_NO_TEXTURE),
    INPUT("g", g, "asymmetry g: mean cosine of scattering", VL_RANGE(-1, 1),
          .flags = VL_PARAMETER_NO_TEXTURE | VL_PARAMETER_ABOVE_LOW | VL_PARAMETER_BELOW_HIGH),
    ROUGHNESS,
    BUMPS,
};
VL_KIND_ROW(subsurface, .name = "subsurface",
            .description = "a solid in which light scatters below the surface",
            .traits = VL_MATERIAL_OPAQUE | VL_MATERIAL_ROUGH | VL_MATERIAL_REFRACTS)

/* ---- no surface of their own
 * ------------------------------------------------------------------------------------- */

static const vlParameter mix_parameters[] = {
    BLOCK("materials", materials, "names of the two materials",
          .flags = VL_PARAMETER_RULE | VL_PARAMETER_REQUIRED),
    INPUT("amount", amount, "fraction of the second material", VL_DEFAULT(0.5), SHARE),
};
VL_KIND_ROW(mix, .name = "mix",
            .description = "two materials, one of which is chosen at each hit")

VL_KIND_ROW_EMPTY(interface, .name = "interface", .alias = "none", .traits = VL_MATERIAL_ABSENT,
                  .description = "no visible surface, only a boundary between two media")

#define ROW(NAME, name) [VL_MATERIAL_##NAME] = &name##_row,
VL_KIND_FAMILY(vl_material_family, VL_MATERIAL_KINDS, ROW, "materials", "material", "Material")
