/* scene/schema/shapes.c: the shapes. Names and defaults are pbrt-v4's; its shapes "plymesh" and "loopsubdiv" are other ways
 * to say triangles. */
#include "base/cookie.h"
#include "scene/schema/schema.h"

#define DEGREES 0.017453292519943295
#define IN_FILES (VL_PARAMETER_RULE | VL_PARAMETER_SHORTHAND)

/* clang-format off */
#define ALPHA \
  {.name = "alpha", VL_PLACE(vlShapeDef, alpha), .type = VL_PARAMETER_FLOAT_INPUT, .value = {1}, \
   .flags = VL_PARAMETER_RULE, .description = "coverage, 0 to 1"}
#define ARRAY(file_name, field, text) \
  {.name = (file_name), VL_PLACE(vlShapeDef, field), .type = VL_PARAMETER_BLOCK, .description = (text)}
#define LENGTH(file_name, field, number, ...) \
  {.name = (file_name), VL_PLACE(vlShapeDef, field), .type = VL_PARAMETER_FLOAT, .unit = "length", \
   .value = {number}, __VA_ARGS__}
#define RADIUS LENGTH("radius", radius, 1, VL_FROM(0), .flags = VL_PARAMETER_ABOVE_LOW, .description = "radius")
#define PHI_MAX \
  {.name = "phimax", VL_PLACE(vlShapeDef, phi_max), .type = VL_PARAMETER_FLOAT, .unit = "degrees", .factor = DEGREES, \
   .value = {360 * DEGREES}, VL_FROM(0), .flags = VL_PARAMETER_ABOVE_LOW, \
   .description = "the part of the turn about z that is there"}
#define WIDTH(file_name, text) \
  {.name = (file_name), VL_PLACE(vlShapeDef, widths), .type = VL_PARAMETER_FLOAT, .flags = IN_FILES, .unit = "length", \
   .value = {1}, .description = (text)}
/* clang-format on */

static const vlParameter triangles_parameters[] = {
    ALPHA,
    ARRAY("P", positions, "vertices"),
    ARRAY("indices", indices, "3 vertices per triangle; unset: there is one triangle"),
    ARRAY("N", normals, "shading normal per vertex"),
    ARRAY("S", tangents, "tangent per vertex"),
    ARRAY("uv", uvs, "texture coordinates per vertex"),
    ARRAY(NULL, tangent_signs, "per vertex: the bitangent is sign * n x tangent"),
    ARRAY(NULL, more_uvs, "further sets of texture coordinates, 1 to 3"),
    ARRAY(NULL, colors, "linear RGB and coverage per vertex"),
    ARRAY(NULL, positions_close, "vertices at times[1]"),
    ARRAY(NULL, normals_close, "normals at times[1]"),
    ARRAY(NULL, times, "of the two sets of vertices, seconds"),
    {VL_PLACE(vlShapeDef, one_sided), .type = VL_PARAMETER_BOOL, .description = "rays pass through the backs"},
    {.name = "displacement",
     VL_PLACE(vlShapeDef, displacement),
     .type = VL_PARAMETER_FLOAT_INPUT,
     .unit = "length",
     .flags = VL_PARAMETER_RULE,
     .description = "float texture that moves the surface along its normals"},
    {.name = "edgelength",
     .alias = "displacement.edgelength",
     VL_PLACE(vlShapeDef, edge_length),
     .type = VL_PARAMETER_FLOAT,
     .unit = "length",
     .flags = VL_PARAMETER_ABOVE_LOW,
     .value = {1},
     VL_FROM(0),
     .description = "displaced triangles are divided until no edge is longer"}};
VL_KIND_ROW(triangles, .identifier = "TRIANGLES", .name = "trianglemesh", .description = "a mesh of triangles",
            .traits = VL_SHAPE_TRAIT_MESH | VL_SHAPE_TRAIT_EMITS)

static const vlParameter bilinear_parameters[] = {
    ALPHA, ARRAY("P", positions, "vertices"),
    ARRAY("indices", indices, "4 vertices per patch: p00 p10 p01 p11; unset: there is one patch"),
    ARRAY("N", normals, "shading normal per vertex"), ARRAY("uv", uvs, "texture coordinates per vertex")};
VL_KIND_ROW(bilinear, .identifier = "BILINEAR", .name = "bilinearmesh", .description = "a mesh of bilinear patches",
            .traits = VL_SHAPE_TRAIT_MESH | VL_SHAPE_TRAIT_EMITS)

static const vlParameter sphere_parameters[] = {
    ALPHA, RADIUS, LENGTH("zmin", z_min, -1, .description = "where it starts along z; unset in a file: -radius"),
    LENGTH("zmax", z_max, 1, .description = "where it ends along z; unset in a file: radius"), PHI_MAX};
VL_KIND_ROW(sphere, .identifier = "SPHERE", .name = "sphere", .description = "a sphere or a part of one",
            .traits = VL_SHAPE_TRAIT_QUADRIC | VL_SHAPE_TRAIT_EMITS)

static const vlParameter disk_parameters[] = {
    ALPHA, RADIUS,
    LENGTH("innerradius", inner_radius, 0, VL_FROM(0), .description = "of a hole; less than the radius"),
    LENGTH("height", height, 0, .description = "where it is along z"), PHI_MAX};
VL_KIND_ROW(disk, .identifier = "DISK", .name = "disk", .description = "a disk across z, or a part of one",
            .traits = VL_SHAPE_TRAIT_QUADRIC | VL_SHAPE_TRAIT_EMITS)

static const vlParameter cylinder_parameters[] = {ALPHA, RADIUS,
                                                  LENGTH("zmin", z_min, -1, .description = "where it starts along z"),
                                                  LENGTH("zmax", z_max, 1, .description = "where it ends along z"),
                                                  PHI_MAX};
VL_KIND_ROW(cylinder, .identifier = "CYLINDER", .name = "cylinder", .description = "a cylinder about z, open",
            .traits = VL_SHAPE_TRAIT_QUADRIC | VL_SHAPE_TRAIT_EMITS)

static const char *const curve_kinds[] = {"flat", "cylinder", "ribbon", NULL};
static const char *const curve_bases[] = {"bezier", "bspline", NULL};

static const vlParameter curves_parameters[] = {
    ALPHA,
    {.name = "type",
     VL_PLACE(vlShapeDef, curve),
     .type = VL_PARAMETER_CHOICE,
     .choices = curve_kinds,
     .description = "flat: faces each ray; cylinder: with the normal of a tube; ribbon: lies across its normals"},
    ARRAY("P", positions, "control points; in the def 4 Bezier points per segment"),
    {.name = "basis",
     VL_PLACE(vlShapeDef, positions),
     .type = VL_PARAMETER_CHOICE,
     .choices = curve_bases,
     .flags = IN_FILES,
     .description = "of the control points"},
    {.name = "degree",
     VL_PLACE(vlShapeDef, positions),
     .type = VL_PARAMETER_COUNT,
     .value = {3},
     VL_RANGE(2, 3),
     .flags = IN_FILES,
     .description = "of the control points"},
    WIDTH("width", "of the whole curve"),
    WIDTH("width0", "at its start; unset: width"),
    WIDTH("width1", "at its end; unset: width"),
    ARRAY(NULL, widths, "at both ends of each segment"),
    ARRAY("N", normals, "of ribbons, at both ends of each segment"),
    {.name = "splitdepth",
     VL_PLACE(vlShapeDef, split_depth),
     .type = VL_PARAMETER_COUNT,
     .flags = VL_PARAMETER_RULE,
     .value = {3},
     .description = "segments are cut into 2^splitdepth pieces for speed, at most 10; images do not depend on it"}};
VL_KIND_ROW(curves, .identifier = "CURVES", .name = "curve", .description = "cubic curves with a width, as hairs are",
            .traits = 0)

#define ROW(NAME, name) [VL_SHAPE_##NAME] = &name##_row,
static const vlKindRow *const rows[] = {VL_SHAPE_KINDS(ROW)};

const vlKindFamily vl_shape_family = {"shapes", "shape", "Shape", sizeof rows / sizeof *rows, rows};

vlShapeDef vl_default_shape_def(vlShapeKind kind) {
  vlShapeDef def = {.cookie = VL_COOKIE_SHAPE, .kind = kind, .alpha = vl_float_input(1.0f), .times = {0.0, 1.0}};
  const vlKindRow *row = vl_kind_row(&vl_shape_family, (int)kind);
  if (row) vl_row_set_defaults(row, &def);
  for (int i = 0; i < 16; i += 5) def.group_from_shape[i] = 1.0;
  return def;
}
