/* shape/bilinear.row.c: the name and the parameters of meshes of bilinear patches. */
#include "shape/shape.row.h"

const vlKindRow vl_shape_row_bilinear = {
    .name = "bilinearmesh",
    .description = "a mesh of bilinear patches",
    .traits = VL_SHAPE_TRAIT_MESH | VL_SHAPE_TRAIT_EMITS,
    VL_PARAMETERS(
        ALPHA, ARRAY("P", positions, "point3 array", "vertex positions"),
        ARRAY("indices", indices, "integer array",
              "4 vertex indices per patch, in the order p00 p10 p01 p11; unset: one patch"),
        ARRAY("N", normals, "normal array", "shading normal of each vertex"),
        ARRAY("uv", uvs, "point2 array", "texture coordinates of each vertex")),
};
