/* schema/shapes.c: rows of the shapes. Names and defaults are those of pbrt-v4. Its shapes
 * "plymesh" and "loopsubdiv" become triangles. */
#include <math.h>

#include "base/cookie.h"
#include "schema/schema.h"
#include "velo/shape.h"

#define DEGREES (3.14159265358979323846 / 180)

#define PARAMETER(TYPE, ...) VL_PARAMETER(TYPE, vlShapeDef, __VA_ARGS__)
#define ARRAY(name, member, type_in_files, line) \
  PARAMETER(BLOCK, name, member, line, .text = type_in_files)
#define LENGTH(name, member, text, ...) \
  PARAMETER(FLOAT, name, member, text, .unit = "length", VL_DEFAULT(__VA_ARGS__))
/* A parameter in files from which an array of the def is computed. */
#define IN_FILES(TYPE, file_name, place, text, ...)                                       \
  {                                                                                       \
    .type = VL_PARAMETER_##TYPE, .name = file_name, .member = #place,                     \
    .offset = offsetof(vlShapeDef, place),                                                \
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

static const vlParameter triangles_parameters[] = {
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
VL_KIND_ROW(triangles, .name = "trianglemesh", .description = "a mesh of triangles",
            .traits = VL_SHAPE_TRAIT_MESH | VL_SHAPE_TRAIT_EMITS)

static const vlParameter bilinear_parameters[] = {
    ALPHA,
    ARRAY("P", positions, "point3 array", "vertex positions"),
    ARRAY("indices", indices, "integer array",
          "4 vertex indices per patch, in the order p00 p10 p01 p11; unset: one patch"),
    ARRAY("N", normals, "normal array", "shading normal of each vertex"),
    ARRAY("uv", uvs, "point2 array", "texture coordinates of each vertex"),
};
VL_KIND_ROW(bilinear, .name = "bilinearmesh", .description = "a mesh of bilinear patches",
            .traits = VL_SHAPE_TRAIT_MESH | VL_SHAPE_TRAIT_EMITS)

static const vlParameter sphere_parameters[] = {
    ALPHA,
    RADIUS,
    LENGTH("zmin", z_min, "z of the lower end; unset in a file: -radius", -1),
    LENGTH("zmax", z_max, "z of the upper end; unset in a file: radius", 1),
    PHI_MAX,
    ARRAY(NULL, centers, NULL, "centres of several whole spheres in one shape"),
    ARRAY(NULL, radii, NULL, "radii of the spheres whose centres are given"),
};
VL_KIND_ROW(sphere, .name = "sphere", .description = "a sphere or a part of one",
            .traits = VL_SHAPE_TRAIT_QUADRIC | VL_SHAPE_TRAIT_EMITS)

static const vlParameter disk_parameters[] = {
    ALPHA,
    RADIUS,
    PARAMETER(FLOAT, "innerradius", inner_radius,
              "radius of the hole in the middle; less than radius", .unit = "length",
              VL_FROM(0)),
    LENGTH("height", height, "z of the disk", 0),
    PHI_MAX,
};
VL_KIND_ROW(disk, .name = "disk",
            .description = "a disk perpendicular to the z axis, or a part of one",
            .traits = VL_SHAPE_TRAIT_QUADRIC | VL_SHAPE_TRAIT_EMITS)

static const vlParameter cylinder_parameters[] = {
    ALPHA,
    RADIUS,
    LENGTH("zmin", z_min, "z of the lower end", -1),
    LENGTH("zmax", z_max, "z of the upper end", 1),
    PHI_MAX,
};
VL_KIND_ROW(cylinder, .name = "cylinder",
            .description = "an open cylinder about the z axis, or a part of one",
            .traits = VL_SHAPE_TRAIT_QUADRIC | VL_SHAPE_TRAIT_EMITS)

static const char *const curve_kinds[] = {"flat", "cylinder", "ribbon", NULL};
static const char *const curve_bases[] = {"bezier", "bspline", NULL};

static const vlParameter curves_parameters[] = {
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
VL_KIND_ROW(curves, .name = "curve", .description = "cubic curves with a width, such as hairs",
            .traits = 0)

#define ROW(NAME, name) [VL_SHAPE_##NAME] = &name##_row,
VL_KIND_FAMILY(vl_shape_family, VL_SHAPE_KINDS, ROW, "shapes", "shape", "Shape")

/* ---- boxes ------------------------------------------------------------------------------- */

static void round_box(const vlShapeDef *d, double z0, double z1, double low[3],
                      double high[3]) {
  double r = d->radius;
  low[0] = low[1] = -r;
  low[2] = z0;
  high[0] = high[1] = r;
  high[2] = z1;
}

static void sphere_box(const vlShapeDef *d, double low[3], double high[3]) {
  double r = d->radius, z0 = d->z_min, z1 = d->z_max;
  round_box(d, z0 > -r ? z0 : -r, z1 < r ? z1 : r, low, high);
}

static void disk_box(const vlShapeDef *d, double low[3], double high[3]) {
  round_box(d, d->height, d->height, low, high);
}

static void cylinder_box(const vlShapeDef *d, double low[3], double high[3]) {
  round_box(d, d->z_min, d->z_max, low, high);
}

static void points_box(const vlShapeDef *d, double low[3], double high[3]) {
  for (int k = 0; k < 3; k++) {
    low[k] = (double)INFINITY;
    high[k] = -(double)INFINITY;
  }
  for (size_t i = 0; i < d->vertices; i++)
    for (int k = 0; k < 3; k++) {
      double x = d->positions[3 * i + (size_t)k];
      low[k] = x < low[k] ? x : low[k];
      high[k] = x > high[k] ? x : high[k];
    }
}

#define triangles_box points_box
#define bilinear_box points_box
#define curves_box points_box
#define BOX_OF(NAME, name) [VL_SHAPE_##NAME] = name##_box,
static void (*const box_of[])(const vlShapeDef *, double low[3],
                              double high[3]) = {VL_SHAPE_KINDS(BOX_OF)};

void vl_shape_own_box(const vlShapeDef *def, double low[3], double high[3]) {
  box_of[def->kind](def, low, high);
}

bool vl_shape_is_mesh(uint32_t kind) {
  return (vl_kind_row(&vl_shape_family, (int)kind)->traits & VL_SHAPE_TRAIT_MESH) != 0;
}

vlShapeDef vl_default_shape_def(vlShapeKind kind) {
  vlShapeDef def = {.cookie = VL_COOKIE_SHAPE, .kind = kind, .times = {0.0, 1.0}};
  vl_family_set_defaults(&vl_shape_family, (int)kind, &def);
  for (int i = 0; i < 16; i += 5)
    def.group_from_shape[i] = 1.0;
  return def;
}
