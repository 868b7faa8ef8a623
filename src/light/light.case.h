/* light/light.case.h: what the tests of lights must know of a kind beyond its row: light that
 * arrives at known points of a floor (test/conformance/lights.h), and cases of its
 * parameters. */
#ifndef LIGHT_LIGHT_CASE_H
#define LIGHT_LIGHT_CASE_H

#include <stdbool.h>
#include <stdint.h>

#include "schema/parameter.case.h"
#include "velo/light.h"

/* Radiance times solid angle that arrives at a point of the floor y = 0, without the cosine at
 * the floor: of a point light the intensity over the squared distance. */
typedef struct LightKnown {
  double x, z;
  double rgb[3];
} LightKnown;

typedef struct LightVariant {
  const char *parameters; /* null ends the list */
  const char *before;     /* statements after those of the case; null: none */
  LightKnown known[4];    /* of delta lights; all 0 ends the list */
  double rim[4][2]; /* x and z of points of the floor at the end of what the light reaches; all
                       0: none are known */
  void (*change)(vlLightDef *def); /* sets what the format cannot say; null: nothing */
  bool compensated; /* directions darker than the mean are not sampled: BSDF samples find their
        light */
} LightVariant;

enum { LIGHT_VARIANTS = 8 };
typedef struct LightCase {
  const char *before; /* statements before the light, such as its place; null: none */
  LightVariant variants[LIGHT_VARIANTS];
  /* Of kinds whose illuminance can be given: parameters, and the normal of the surface that
   * gets it. */
  const char *illuminated[LIGHT_VARIANTS];
  double faced[3];
  ParameterCase parameters[PARAMETER_CASES];
} LightCase;

/* Declares the case of each kind, which is in the file of the kind: light/NAME.case.c. */
#define LIGHT_CASE(kind, name) extern const LightCase name##_light;
VL_LIGHT_KINDS(LIGHT_CASE)
#undef LIGHT_CASE

#endif
