/* shape/sphere.row.c: the name, the parameters and the box of spheres. */
#include "shape/shape.row.h"

const vlKindRow vl_shape_row_sphere = {
    .name = "sphere",
    .description = "a sphere or a part of one",
    .traits = VL_SHAPE_TRAIT_QUADRIC | VL_SHAPE_TRAIT_EMITS,
    VL_PARAMETERS(ALPHA, RADIUS,
                  LENGTH("zmin", z_min, "z of the lower end; unset in a file: -radius", -1),
                  LENGTH("zmax", z_max, "z of the upper end; unset in a file: radius", 1),
                  PHI_MAX,
                  ARRAY(NULL, centers, NULL, "centres of several whole spheres in one shape"),
                  ARRAY(NULL, radii, NULL, "radii of the spheres whose centres are given")),
};

vlShapeBox vl_shape_box_sphere;

void vl_shape_box_sphere(const vlShapeDef *def, double low[3], double high[3]) {
  const double r = def->radius, z0 = def->z_min, z1 = def->z_max;
  vl_shape_box_round(def, z0 > -r ? z0 : -r, z1 < r ? z1 : r, low, high);
}
