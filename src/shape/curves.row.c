/* shape/curves.row.c: the name and the parameters of curves. */
#include "shape/shape.row.h"

static const char *const curve_kinds[] = {"flat", "cylinder", "ribbon", NULL};
static const char *const curve_bases[] = {"bezier", "bspline", NULL};

static const vlParameter parameters[] = {
    ALPHA,
    PARAMETER(
        CHOICE, "type", curve,
        "flat: turned towards each ray; cylinder: likewise, with a tube's normals; ribbon: "
        "perpendicular to N",
        .choices = curve_kinds),
    ARRAY("P", positions, "point3 array",
          "control points; vlShapeDef has 4 Bezier control points per segment"),
    IN_FILES(CHOICE, "basis", positions, "basis of the curve's polynomials",
             .choices = curve_bases),
    IN_FILES(COUNT, "degree", positions, "degree of the curve's polynomials", VL_DEFAULT(3),
             VL_RANGE(2, 3)),
    ARRAY(NULL, widths, NULL, "widths at both ends of each segment"),
    IN_FILES(FLOAT, "width", widths, "width of the curve, constant along it", VL_DEFAULT(1),
             VL_FROM(0), .unit = "length"),
    IN_FILES(FLOAT, "width0", widths, "width at the start of the curve; unset: width",
             VL_DEFAULT(1), VL_FROM(0), .unit = "length"),
    IN_FILES(FLOAT, "width1", widths, "width at the end of the curve; unset: width",
             VL_DEFAULT(1), VL_FROM(0), .unit = "length"),
    ARRAY("N", normals, "normal array", "ribbons: normals at both ends of each segment"),
    PARAMETER(
        COUNT, "splitdepth", split_depth,
        "each segment is split into 2^splitdepth pieces, splitdepth at most 10; affects only "
        "the speed",
        VL_DEFAULT(3), .flags = VL_PARAMETER_RULE),
};

const vlKindRow vl_shape_row_curves = {
    .name = "curve",
    .description = "cubic curves with a width, such as hairs",
    .traits = 0,
    VL_ROW_PARAMETERS(parameters),
};
