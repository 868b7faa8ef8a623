/* shape/triangles.row.c: the name and the parameters of meshes of triangles. */
#include "shape/shape.row.h"

static const vlParameter parameters[] = {
    ALPHA,
    ARRAY("P", positions, "point3 array", "vertex positions"),
    ARRAY("indices", indices, "integer array",
          "3 vertex indices per triangle; unset: one triangle"),
    ARRAY("N", normals, "normal array", "shading normal of each vertex"),
    ARRAY("S", tangents, "vector3 array", "tangent of each vertex"),
    ARRAY("uv", uvs, "point2 array", "texture coordinates of each vertex"),
    ARRAY(NULL, tangent_signs, NULL,
          "sign of each vertex; the bitangent is sign * (n x tangent)"),
    ARRAY(NULL, more_uvs, NULL, "sets 1 to 3 of texture coordinates; uv is set 0"),
    ARRAY(NULL, colors, NULL, "colour of each vertex: linear RGB and alpha"),
    ARRAY(NULL, positions_close, NULL, "vertex positions at times[1]"),
    ARRAY(NULL, normals_close, NULL, "shading normals at times[1]"),
    ARRAY(NULL, times, NULL, "times of the two sets of vertex positions, seconds"),
    PARAMETER(BOOL, NULL, one_sided, "true: rays pass through back faces", VL_DEFAULT(0)),
    PARAMETER(FLOAT_INPUT, "displacement", displacement,
              "only of plymesh in files: a float texture that displaces the surface along its "
              "normals",
              .unit = "length", .flags = VL_PARAMETER_RULE),
    PARAMETER(FLOAT, "edgelength", edge_length,
              "only of plymesh in files: displaced triangles are subdivided until no edge is "
              "longer than this",
              .alias = "displacement.edgelength", .unit = "length", VL_DEFAULT(1), VL_FROM(0),
              .flags = VL_PARAMETER_ABOVE_LOW),
};

const vlKindRow vl_shape_row_triangles = {
    .name = "trianglemesh",
    .description = "a mesh of triangles",
    .traits = VL_SHAPE_TRAIT_MESH | VL_SHAPE_TRAIT_EMITS,
    VL_ROW_PARAMETERS(parameters),
};
