/* material/bsdf_names.h: names of the kinds of BSDF, for records of paths. */
#ifndef MATERIAL_BSDF_NAMES_H
#define MATERIAL_BSDF_NAMES_H

/* By the kind: "diffuse", "coat". Defined in compile.c. */
extern const char *const vl_bsdf_names[];

#endif
