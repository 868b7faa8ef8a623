/* material/material.row.h: for the files that hold rows of materials: parameters by type, and
 * those that several kinds share. Names in files and defaults are those of pbrt-v4; the
 * principled material's are those of glTF. */
#ifndef MATERIAL_MATERIAL_ROW_H
#define MATERIAL_MATERIAL_ROW_H

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

#define CLAMPED(min, max) VL_RANGE(min, max), .flags = VL_PARAMETER_CLAMPED
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
#define REMAP                                                                            \
  BOOL("remaproughness", remap_roughness,                                                \
       "true: alpha is the square root of the roughness; false: alpha is the roughness", \
       VL_DEFAULT(1))
/* layer: prefix of the names; of: whose roughness it is, with a comma. */
#define ROUGHNESS_OF(layer, u, v, of)                                                 \
  INPUT(layer "roughness", u, "sets " layer "uroughness and " layer "vroughness",     \
        VL_SECOND(vlMaterialDef, v), VL_FROM(0),                                      \
        .flags = VL_PARAMETER_SHORTHAND | VL_PARAMETER_CLAMPED),                      \
      INPUT(layer "uroughness", u, "roughness " of "along the tangent", ROUGH_RANGE), \
      INPUT(layer "vroughness", v, "roughness " of "across the tangent", ROUGH_RANGE)
#define ROUGHNESS ROUGHNESS_OF("", u_roughness, v_roughness, ""), REMAP
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

#endif
