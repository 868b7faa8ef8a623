/* material/kinds.row.h: what each kind of material and each kind of BSDF has, by its full
 * names. A material consists of a row (the file NAME.row.c) and a compile function, which
 * chooses the BSDF; a BSDF of a function that evaluates its parameters for a run of lanes, and
 * of two kernels (NAME.hot.c). */
#ifndef MATERIAL_KINDS_ROW_H
#define MATERIAL_KINDS_ROW_H

/* X(kind, row, compile) */
#define VL_MATERIAL_FUNCTIONS(X)                                                        \
  X(VL_MATERIAL_DIFFUSE, vl_material_row_diffuse, vl_compile_diffuse_material)          \
  X(VL_MATERIAL_COATED_DIFFUSE, vl_material_row_coated_diffuse,                         \
    vl_compile_coated_diffuse_material)                                                 \
  X(VL_MATERIAL_CONDUCTOR, vl_material_row_conductor, vl_compile_conductor_material)    \
  X(VL_MATERIAL_DIELECTRIC, vl_material_row_dielectric, vl_compile_dielectric_material) \
  X(VL_MATERIAL_THIN_DIELECTRIC, vl_material_row_thin_dielectric,                       \
    vl_compile_thin_dielectric_material)                                                \
  X(VL_MATERIAL_MIX, vl_material_row_mix, vl_compile_mix_material)                      \
  X(VL_MATERIAL_PRINCIPLED, vl_material_row_principled, vl_compile_principled_material) \
  X(VL_MATERIAL_DIFFUSE_TRANSMISSION, vl_material_row_diffuse_transmission,             \
    vl_compile_diffuse_transmission_material)                                           \
  X(VL_MATERIAL_COATED_CONDUCTOR, vl_material_row_coated_conductor,                     \
    vl_compile_coated_conductor_material)                                               \
  X(VL_MATERIAL_HAIR, vl_material_row_hair, vl_compile_hair_material)                   \
  X(VL_MATERIAL_MEASURED, vl_material_row_measured, vl_compile_measured_material)       \
  X(VL_MATERIAL_INTERFACE, vl_material_row_interface, vl_compile_interface_material)    \
  X(VL_MATERIAL_SUBSURFACE, vl_material_row_subsurface, vl_compile_subsurface_material)

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
