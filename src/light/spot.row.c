/* light/spot.row.c: the name, the parameters and the power of spot lights. */
#include <math.h>

#include "light/light.row.h"
#include "math/elementary.h"
#include "math/stretch.h"
#include "math/vec.h"

const vlKindRow vl_light_row_spot = {
    .name = "spot",
    .description = "a point that emits into a cone",
    .traits = VL_LIGHT_TRAIT_AT_POINT | VL_LIGHT_TRAIT_DELTA | VL_LIGHT_TRAIT_AIMS,
    VL_PARAMETERS(
        INTENSITY, SCALE, POWER, RADIANT_POWER, RADIANT_INTENSITY,
        FROM("position of the light"),
        TO("a point on the cone's axis, towards which the light points"),
        PARAMETER(FLOAT, "coneangle", cone_angle,
                  "angle between the axis and the edge of the cone, in the light's own frame",
                  ANGLE(30 * DEGREES), VL_RANGE(0, 180 * DEGREES + 1e-6),
                  .flags = VL_PARAMETER_ABOVE_LOW),
        PARAMETER(FLOAT, "conedeltaangle", cone_delta,
                  "angle inside the cone's edge over which the intensity falls to 0",
                  ANGLE(5 * DEGREES), VL_FROM(0)),
        PARAMETER(
            BOOL, NULL, cone_squared,
            "true: the falloff is t^2, t linear in the cosine, as in glTF; false: 3t^2 - 2t^3, "
            "as in pbrt",
            VL_DEFAULT(0))),
};

vlLightPower vl_light_power_spot;

/* Directions over which the power of a skewed cone is summed: by cosine with the axis, and
 * around it. */
enum { COSINES = 128, AROUND = 256 };

/* The mean, around the axis (basis.z), of the world's solid angle per solid angle of the
 * frame. */
static double mean_stretch(const vlStretch *stretch, vlFrame basis, double cosine) {
  const double sine = sqrt(1 - cosine * cosine);
  double sum = 0;
  for (int i = 0; i < AROUND; i++) {
    const double phi = 2 * PI * (i + 0.5) / AROUND;
    const float x = (float)(sine * vl_precise_cos(phi)),
                y = (float)(sine * vl_precise_sin(phi));
    const vlVec3 d = vl_from_local(basis, vl_vec3(x, y, (float)cosine));
    const double direction[3] = {(double)d.x, (double)d.y, (double)d.z};
    sum += vl_stretch_at(stretch, direction);
  }
  return sum / AROUND;
}

/* The integral of the falloff over the directions of the world; inner, outer: cosines between
 * which it falls. */
static double skewed_solid_angle(const vlLightDef *def, const vlStretch *stretch, double inner,
                                 double outer) {
  const vlVec3 axis =
      vl_vec3(def->to[0] - def->from[0], def->to[1] - def->from[1], def->to[2] - def->from[2]);
  const vlFrame basis = vl_frame_from_z(vl_normalize(axis));
  double sum = 0;
  for (int i = 0; i < COSINES; i++) {
    const double cosine = outer + (1 - outer) * (i + 0.5) / COSINES;
    const double t = inner > outer ? fmin((cosine - outer) / (inner - outer), 1) : 1;
    const double falloff = def->cone_squared ? t * t : t * t * (3 - 2 * t);
    sum += falloff * mean_stretch(stretch, basis, cosine);
  }
  return 2 * PI * (1 - outer) * sum / COSINES;
}

double vl_light_power_spot(const vlLightDef *def, double luminance, VL_UNUSED double radius) {
  double inner = vl_precise_cos((double)def->cone_angle - (double)def->cone_delta),
         outer = vl_precise_cos((double)def->cone_angle);
  const vlStretch stretch = vl_stretch(def->world_from_light);
  if (stretch.is_skewed)
    return luminance * skewed_solid_angle(def, &stretch, inner, outer);
  const double mean_edge = def->cone_squared ? 1 / 3.0 : 0.5; /* of the falloff over the edge */
  return 2 * PI * luminance * ((1 - inner) + mean_edge * (inner - outer));
}
