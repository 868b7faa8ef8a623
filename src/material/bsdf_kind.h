/* material/bsdf_kind.h: the kinds of BSDF that materials consist of. Each name stands for
 * a function that evaluates its parameters (vl_parameters_NAME) and two kernels
 * (vl_bsdf_NAME_eval, vl_bsdf_NAME_sample). A material's compile function chooses its kind. */
#ifndef MATERIAL_BSDF_KIND_H
#define MATERIAL_BSDF_KIND_H

#define VL_BSDF_KINDS(X)                                                                       \
  X(DIFFUSE, diffuse)                                                                          \
  X(CONDUCTOR, conductor)   /* metal of index eta + i k; each lane is rough, or smooth if both \
                               alphas are below 1e-3 */                                        \
  X(DIELECTRIC, dielectric) /* eta_s > 0 is the index inside over the index outside; each lane \
                               is rough or smooth */                                           \
  X(THIN_DIELECTRIC, thin)                                                                     \
  X(COATED_DIFFUSE, coat) /* rough or smooth dielectric coat over a diffuse base, by a table   \
                             of its transmittance */                                           \
  X(PRINCIPLED,                                                                                \
    principled) /* the principled material, which has several layers (docs/principled.md) */   \
  X(DIFFUSE_TRANSMISSION, translucent)                                                         \
  X(LAYERED, layered) /* rough or smooth dielectric coat over metal or a diffuse base, by      \
                         random walks */                                                       \
  X(HAIR, hair)                                                                                \
  X(MEASURED, measured)

enum {
#define VL_KIND(NAME, name) VL_BSDF_##NAME,
  VL_BSDF_KINDS(VL_KIND)
#undef VL_KIND
      VL_BSDF_KIND_COUNT
};

#endif
