/* shape/disk.row.c: the name, the parameters and the box of disks. */
#include "shape/shape.row.h"

const vlKindRow vl_shape_row_disk = {
    .name = "disk",
    .description = "a disk perpendicular to the z axis, or a part of one",
    .traits = VL_SHAPE_TRAIT_QUADRIC | VL_SHAPE_TRAIT_EMITS,
    VL_PARAMETERS(ALPHA, RADIUS,
                  PARAMETER(FLOAT, "innerradius", inner_radius,
                            "radius of the hole in the middle; less than radius",
                            .unit = "length", VL_FROM(0)),
                  LENGTH("height", height, "z of the disk", 0), PHI_MAX),
};

vlShapeBox vl_shape_box_disk;

void vl_shape_box_disk(const vlShapeDef *def, double low[3], double high[3]) {
  vl_shape_box_round(def, def->height, def->height, low, high);
}
