/* shape/shape.row.h: for the files that hold rows of shapes: parameters by type, those that
 * several kinds share, and boxes. Names in files and defaults are those of pbrt-v4. Its shapes
 * "plymesh" and "loopsubdiv" become triangles. */
#ifndef SHAPE_SHAPE_ROW_H
#define SHAPE_SHAPE_ROW_H

#include "schema/schema.h"
#include "velo/shape.h"

#define DEGREES (3.14159265358979323846 / 180)

#define PARAMETER(TYPE, ...) VL_PARAMETER(TYPE, vlShapeDef, __VA_ARGS__)
#define ARRAY(name, member, type_in_files, line) \
  PARAMETER(BLOCK, name, member, line, .text = type_in_files)
#define LENGTH(name, member, text, ...) \
  PARAMETER(FLOAT, name, member, text, .unit = "length", VL_DEFAULT(__VA_ARGS__))
/* A parameter in files from which an array of the def is computed. */
#define IN_FILES(TYPE, file_name, def_member, text, ...)                                  \
  {                                                                                       \
    .type = VL_PARAMETER_##TYPE, .name = file_name, .member = #def_member,                \
    .offset = offsetof(vlShapeDef, def_member),                                           \
    .flags = VL_PARAMETER_RULE | VL_PARAMETER_SHORTHAND, .description = text, __VA_ARGS__ \
  }
#define ALPHA                                                                              \
  PARAMETER(FLOAT_INPUT, "alpha", alpha, "alpha: opacity of the surface, 0 (a hole) to 1", \
            VL_DEFAULT(1), .flags = VL_PARAMETER_RULE)
#define RADIUS                                                                               \
  PARAMETER(FLOAT, "radius", radius, "radius of the shape", .unit = "length", VL_DEFAULT(1), \
            VL_FROM(0), .flags = VL_PARAMETER_ABOVE_LOW)
#define PHI_MAX                                                                          \
  PARAMETER(FLOAT, "phimax", phi_max, "angle about the z axis that the shape spans",     \
            .unit = "degrees", .factor = DEGREES, VL_DEFAULT(360 * DEGREES), VL_FROM(0), \
            .flags = VL_PARAMETER_ABOVE_LOW)

/* The box [low, high] of a shape in shape space. */
typedef void vlShapeBox(const vlShapeDef *def, double low[3], double high[3]);
/* That of the positions of its vertices. */
vlShapeBox vl_shape_box_points;
/* That of a shape of the def's radius between two heights. */
void vl_shape_box_round(const vlShapeDef *def, double z0, double z1, double low[3],
                        double high[3]);

#endif
