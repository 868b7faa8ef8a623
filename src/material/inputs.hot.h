/* material/inputs.hot.h: evaluation of material parameters over a run of lanes; private to the
 * hot files of material and to subsurface.hot.c. Results go to lanes [r->first, r->last)
 * of the rows. */
#ifndef MATERIAL_INPUTS_HOT_H
#define MATERIAL_INPUTS_HOT_H

#include "texture/run.hot.h"

/* Evaluates the BSDF parameters of material m from its textures, over a run of lanes. Each BSDF
 * kind has one function. */
typedef void vlParametersFn(vlTextureRun *r, const vlWorldMaterial *m);
/* Those of kinds whose inputs others have, too. */
vlParametersFn vl_parameters_diffuse, vl_parameters_conductor, vl_parameters_dielectric;

/* Change the shading normals by a bump map, of which the node is the height, and by a normal
 * map. The first uses VL_BUMP_ROWS rows. */
void vl_stage_bump(vlTextureRun *r, int32_t node);
void vl_stage_normal_map(vlTextureRun *r, int32_t image);

/* Parts of the functions above. vl_stage_layers runs after eta, k and roughness are evaluated;
 * the parts for translucent, subsurface and hair run after the reflectance. The coat's normal
 * of the principled material stays in world space until vl_stage_coat_frames. */
vlParametersFn vl_stage_layers, vl_stage_translucent, vl_stage_subsurface_inputs, vl_stage_hair,
    vl_stage_principled;
void vl_stage_coat_frames(const vlSurface *surface, vlShade *shade, uint32_t first,
                          uint32_t last);

/* Evaluates a roughness texture to the microfacets' alpha. If the material has pbrt's
 * remaproughness, alpha is the square root of the roughness. */
void vl_stage_roughness(vlTextureRun *r, const vlWorldMaterial *m, int32_t node, float *alpha);

#endif
