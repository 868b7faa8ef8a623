/* world/material/compile.h: from a material of the scene to one of the world: a function per kind, each of which
 * chooses the BSDF and compiles the inputs that it reads. */
#ifndef WORLD_MATERIAL_COMPILE_H
#define WORLD_MATERIAL_COMPILE_H

#include "base/error.h"
#include "scene/scene.h"
#include "world/world.h"

typedef struct vlMaterialBuild {
  vlWorld *world;
  const vlScene *scene;
  const vlMaterialDef *def;
  vlWorldMaterial *m; /* nodes are -1, all else zero but kind, traits, remap, and eta_s, which is 1.5 */
  vlError *error;
} vlMaterialBuild;

typedef vlResult vlCompileMaterial(const vlMaterialBuild *b);
#define VL_DECLARE_COMPILE(NAME, name) vlCompileMaterial vl_compile_##name##_material;
VL_MATERIAL_KINDS(VL_DECLARE_COMPILE)

/* Inputs as nodes. */
static inline vlResult vl_material_float(const vlMaterialBuild *b, vlFloatInput input, int32_t *node) {
  return vl_world_float_node(b->world, b->scene, input, node, b->error);
}
static inline vlResult vl_material_spectrum(const vlMaterialBuild *b, vlSpectrumInput input, vlSpectrumRole role,
                                            int32_t *node) {
  return vl_world_spectrum_node(b->world, b->scene, input, role, node, b->error);
}
typedef struct vlMaterialFloat {
  vlFloatInput input;
  int32_t *node;
} vlMaterialFloat;
vlResult vl_material_floats(const vlMaterialBuild *b, const vlMaterialFloat *floats, size_t count);

/* What several kinds have: u_roughness and v_roughness; the metal's reflectance, or eta and k; the index of refraction
 * of a dielectric, as one number or (disperses: it may) a spectrum. */
vlResult vl_material_roughness(const vlMaterialBuild *b);
vlResult vl_material_metal(const vlMaterialBuild *b);
vlResult vl_material_index(const vlMaterialBuild *b, const vlSpectrumInput *eta, bool disperses);
/* The layers of a coat that are looked at by random walks; metal: of a coated conductor. */
vlResult vl_material_layers(const vlMaterialBuild *b, bool metal);
vlResult vl_material_fail(const vlMaterialBuild *b, const char *what);

#endif
