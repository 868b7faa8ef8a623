/* material/compile.h: compiles a material of the scene: one function per kind, which
 * chooses the BSDF and compiles the inputs that it reads. */
#ifndef MATERIAL_COMPILE_H
#define MATERIAL_COMPILE_H

#include "base/error.h"
#include "material/kinds.row.h"
#include "scene/scene.h"
#include "velo/material.h"
#include "world/world.h"

typedef struct vlMaterialBuild {
  vlWorld *world;
  const vlScene *scene;
  const vlMaterialDef *def;
  vlWorldMaterial *m; /* the result; on entry nodes are -1, eta_s is 1.5, kind, traits and remap
                         are set, and all other members are zero */
  vlError *error;
} vlMaterialBuild;

typedef vlResult vlCompileMaterial(const vlMaterialBuild *b);
#define VL_DECLARE_COMPILE(kind, name, row, compile) vlCompileMaterial compile;
VL_MATERIAL_KINDS(VL_DECLARE_COMPILE)
#undef VL_DECLARE_COMPILE

/* Compiles an input into a texture node. */
static inline vlResult vl_material_float(const vlMaterialBuild *b, vlFloatInput input,
                                         int32_t *node) {
  return vl_world_float_node(b->world, b->scene, input, node, b->error);
}
/* Compiles a spectrum input, which is a member of the def. The row of the kind gives the role
 * of the spectrum. */
vlResult vl_material_spectrum(const vlMaterialBuild *b, const vlSpectrumInput *input,
                              int32_t *node);
typedef struct vlMaterialFloat {
  vlFloatInput input;
  int32_t *node;
} vlMaterialFloat;
vlResult vl_material_floats(const vlMaterialBuild *b, const vlMaterialFloat *floats,
                            size_t count);

/* Compile inputs that several kinds share. Roughness: u_roughness and v_roughness. Metal:
 * reflectance, or eta and k. Dielectric: index of refraction, one number or, if it is
 * dispersive, a spectrum. */
vlResult vl_material_roughness(const vlMaterialBuild *b);

#endif
