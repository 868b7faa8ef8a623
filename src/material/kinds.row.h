/* material/kinds.row.h: what each kind of BSDF has, by its full names: a function that
 * evaluates its parameters for a run of lanes, and two kernels (NAME.hot.c). The compile
 * function of a material (VL_MATERIAL_KINDS) chooses the BSDF. */
#ifndef MATERIAL_KINDS_ROW_H
#define MATERIAL_KINDS_ROW_H

/* X(kind, name, parameters, eval, sample)
 *
 *   CONDUCTOR        metal of index eta + i k; a lane is rough, or smooth if both alphas are
 *                    below 1e-3
 *   DIELECTRIC       eta_s > 0: index inside over index outside; a lane is rough or smooth
 *   COATED_DIFFUSE   rough or smooth dielectric coat over a diffuse base, by a table of its
 *                    transmittance
 *   PRINCIPLED       the principled material, which has several layers (docs/principled.md)
 *   LAYERED          rough or smooth dielectric coat over metal or a diffuse base, by random
 *                    walks */
#define VL_BSDF_KINDS(X)                                                                 \
  X(VL_BSDF_DIFFUSE, "diffuse", vl_parameters_diffuse, vl_bsdf_diffuse_eval,             \
    vl_bsdf_diffuse_sample)                                                              \
  X(VL_BSDF_CONDUCTOR, "conductor", vl_parameters_conductor, vl_bsdf_conductor_eval,     \
    vl_bsdf_conductor_sample)                                                            \
  X(VL_BSDF_DIELECTRIC, "dielectric", vl_parameters_dielectric, vl_bsdf_dielectric_eval, \
    vl_bsdf_dielectric_sample)                                                           \
  X(VL_BSDF_THIN_DIELECTRIC, "thin", vl_parameters_thin, vl_bsdf_thin_eval,              \
    vl_bsdf_thin_sample)                                                                 \
  X(VL_BSDF_COATED_DIFFUSE, "coat", vl_parameters_coat, vl_bsdf_coat_eval,               \
    vl_bsdf_coat_sample)                                                                 \
  X(VL_BSDF_PRINCIPLED, "principled", vl_parameters_principled, vl_bsdf_principled_eval, \
    vl_bsdf_principled_sample)                                                           \
  X(VL_BSDF_DIFFUSE_TRANSMISSION, "translucent", vl_parameters_translucent,              \
    vl_bsdf_translucent_eval, vl_bsdf_translucent_sample)                                \
  X(VL_BSDF_LAYERED, "layered", vl_parameters_layered, vl_bsdf_layered_eval,             \
    vl_bsdf_layered_sample)                                                              \
  X(VL_BSDF_HAIR, "hair", vl_parameters_hair, vl_bsdf_hair_eval, vl_bsdf_hair_sample)    \
  X(VL_BSDF_MEASURED, "measured", vl_parameters_measured, vl_bsdf_measured_eval,         \
    vl_bsdf_measured_sample)

enum {
#define VL_KIND(kind, name, parameters, eval, sample) kind,
  VL_BSDF_KINDS(VL_KIND)
#undef VL_KIND
      VL_BSDF_KIND_COUNT
};

#endif
