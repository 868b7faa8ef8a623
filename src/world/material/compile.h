/* world/material/compile.h: compiles a material of the scene: one function per kind, which chooses the BSDF and
 * compiles the inputs that it reads. */
#ifndef WORLD_MATERIAL_COMPILE_H
#define WORLD_MATERIAL_COMPILE_H

#include "base/error.h"
#include "scene/scene.h"
#include "world/world.h"

typedef struct vlMaterialBuild {
  vlWorld *world;
  const vlScene *scene;
  const vlMaterialDef *def;
  vlWorldMaterial *m; /* nodes are -1; all else is zero except kind, traits, remap and eta_s (1.5) */
  vlError *error;
} vlMaterialBuild;

typedef vlResult vlCompileMaterial(const vlMaterialBuild *b);
#define VL_DECLARE_COMPILE(NAME, name) vlCompileMaterial vl_compile_##name##_material;
VL_MATERIAL_KINDS(VL_DECLARE_COMPILE)

/* Compiles an input into a texture node. */
static inline vlResult vl_material_float(const vlMaterialBuild *b, vlFloatInput input, int32_t *node) {
  return vl_world_float_node(b->world, b->scene, input, node, b->error);
}
/* The same for a member of the def; its row says which role the spectrum has. */
vlResult vl_material_spectrum(const vlMaterialBuild *b, const vlSpectrumInput *input, int32_t *node);
typedef struct vlMaterialFloat {
  vlFloatInput input;
  int32_t *node;
} vlMaterialFloat;
vlResult vl_material_floats(const vlMaterialBuild *b, const vlMaterialFloat *floats, size_t count);

/* Inputs that several kinds share: u_roughness and v_roughness; a metal's reflectance, or its eta and k; a
 * dielectric's index of refraction, as one number or (if disperses) a spectrum. */
vlResult vl_material_roughness(const vlMaterialBuild *b);
vlResult vl_material_metal(const vlMaterialBuild *b);
vlResult vl_material_index(const vlMaterialBuild *b, const vlSpectrumInput *eta, bool disperses);
/* The layers of a coat that random walks evaluate. metal: of a coated conductor. */
vlResult vl_material_layers(const vlMaterialBuild *b, bool metal);
vlResult vl_material_fail(const vlMaterialBuild *b, const char *what);

#endif
