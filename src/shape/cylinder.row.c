/* shape/cylinder.row.c: the name, the parameters and the box of cylinders. */
#include "shape/shape.row.h"

const vlKindRow vl_shape_row_cylinder = {
    .name = "cylinder",
    .description = "an open cylinder about the z axis, or a part of one",
    .traits = VL_SHAPE_TRAIT_QUADRIC | VL_SHAPE_TRAIT_EMITS,
    VL_PARAMETERS(ALPHA, RADIUS, LENGTH("zmin", z_min, "z of the lower end", -1),
                  LENGTH("zmax", z_max, "z of the upper end", 1), PHI_MAX),
};

vlShapeBox vl_shape_box_cylinder;

void vl_shape_box_cylinder(const vlShapeDef *def, double low[3], double high[3]) {
  vl_shape_box_round(def, def->z_min, def->z_max, low, high);
}
