/* material/material.case.h: what the tests of materials must know of a kind beyond its row:
 * typical and extreme parameters, and what is known of the light that the material scatters
 * with them (test/conformance/materials.h). */
#ifndef MATERIAL_MATERIAL_CASE_H
#define MATERIAL_MATERIAL_CASE_H

#include <stdbool.h>

#include "velo/material.h"

/* Two directions away from the surface, in its frame: to the eye, and to where light comes
 * from. */
typedef struct MaterialAt {
  double out[3], in[3];
  double across; /* of hair: offset from its axis, -1 to 1 */
} MaterialAt;
/* The BSDF times the cosine of `in`, of R, G and B. */
typedef void MaterialFormula(const MaterialAt *at, double value[3]);

typedef struct MaterialVariant {
  const char *parameters; /* null ends the list */
  double albedo[3]; /* known mean weight, of R, G and B, if the eye is 0.2 radians from the
                       normal; 0: not known */
  double reflected; /* known share of the weight that stays on the side of the eye, there;
                       0: not known */
  double along;     /* known mean of the samples' directions along x, by their weight, there;
                       0: not known */
  double refracts;  /* the index below the surface over that above, with whose square radiance
                       changes: no law of energy; 0: all light has the same index */
  bool both_sides;  /* light from below is scattered, too: reciprocity over the whole sphere */
  bool one_way;     /* not reciprocal */
  /* the BSDF is estimated by random walks: its means are compared, not its values */
  bool walks;
  MaterialFormula *formula; /* null: not known */
} MaterialVariant;

enum { MATERIAL_VARIANTS = 6 };
typedef struct MaterialCase {
  MaterialVariant variants[MATERIAL_VARIANTS];
} MaterialCase;

/* Declares the case of each kind, which is in the file of the kind: material/NAME.case.c. */
#define MATERIAL_CASE(kind, name, ...) extern const MaterialCase name##_material;
VL_MATERIAL_KINDS(MATERIAL_CASE)
#undef MATERIAL_CASE

#endif
