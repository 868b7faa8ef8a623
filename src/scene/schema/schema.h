/* scene/schema/schema.h: the rows of all families, and what reads a def through its row. The rows of a family are in a
 * file of its name beside this one. */
#ifndef SCENE_SCHEMA_SCHEMA_H
#define SCENE_SCHEMA_SCHEMA_H

#include "velo/scene.h"
#include "velo/schema.h"

/* ---- for the files that hold rows --------------------------------------------------------------------------------
 * Each writes, per kind, an array `NAME_parameters` and VL_KIND_ROW(NAME, ...); the list of kinds then makes the table,
 * so that a kind without a row does not compile. */

/* A parameter of VL_PARAMETER_##TYPE at member `path` of Def; file_name may be NULL. VL_DEFAULT, VL_RANGE or VL_FROM
 * and further initialisers may follow. A member of another C type is a warning at compile time. */
#define VL_PARAMETER(TYPE, Def, file_name, path, text_line, ...)                                        \
  {                                                                                                     \
    .type = VL_PARAMETER_##TYPE, .name = file_name, .member = #path,                                    \
    .offset = VL_TYPED_OFFSET(VL_POINTER_##TYPE, Def, path), .size = sizeof(((const Def *)NULL)->path), \
    .description = text_line, __VA_ARGS__                                                               \
  }
#define VL_DEFAULT(...) .value = {__VA_ARGS__}
#define VL_RANGE(least, most) .low = (least), .high = (most)
#define VL_FROM(least) .low = (least), .high = (double)__builtin_inff()
/* Another member that gets the same value. */
#define VL_SECOND(Def, path) .second = offsetof(Def, path)

#define VL_TYPED_OFFSET(Pointer, Def, path) \
  (offsetof(Def, path) + 0 * sizeof((Pointer)NULL == &((const Def *)NULL)->path))
#define VL_POINTER_BOOL const bool *
#define VL_POINTER_COUNT const uint32_t *
#define VL_POINTER_FLOAT const float *
#define VL_POINTER_DOUBLE const double *
#define VL_POINTER_FLOAT3 const float(*)[3]
#define VL_POINTER_DOUBLE3 const double(*)[3]
#define VL_POINTER_CHOICE const void *
#define VL_POINTER_STRING const char *const *
#define VL_POINTER_FILE const char *const *
#define VL_POINTER_SPECTRUM const vlSpectrum *
#define VL_POINTER_FLOAT_INPUT const vlFloatInput *
#define VL_POINTER_SPECTRUM_INPUT const vlSpectrumInput *
#define VL_POINTER_EITHER_INPUT const vlFloatInput *
#define VL_POINTER_TEXTURE const vlTextureId *
#define VL_POINTER_BLOCK const void *

/* The row of kind `kind` with `kind`_parameters; further initialisers (.name, .traits) may follow. */
#define VL_KIND_ROW(kind, ...)                                                                                  \
  static const vlKindRow kind##_row = {.parameters = kind##_parameters,                                         \
                                       .parameter_count = sizeof kind##_parameters / sizeof *kind##_parameters, \
                                       __VA_ARGS__};
/* For kinds without parameters. */
#define VL_KIND_ROW_EMPTY(kind, ...) static const vlKindRow kind##_row = {__VA_ARGS__};

/* The family, from its list of kinds; ROW(NAME, name): `[VL_..._##NAME] = &name##_row,`. */
#define VL_KIND_FAMILY(variable, KINDS, ROW, family_name, thing_name, directive_name)            \
  static const vlKindRow *const variable##_rows[] = {KINDS(ROW)};                                \
  static const char *const variable##_constants[] = {KINDS(VL_KIND_CONSTANT)};                   \
  const vlKindFamily variable = {.name = family_name,                                            \
                                 .thing = thing_name,                                            \
                                 .directive = directive_name,                                    \
                                 .kind_count = sizeof variable##_rows / sizeof *variable##_rows, \
                                 .constants = variable##_constants,                              \
                                 .rows = variable##_rows};
#define VL_KIND_CONSTANT(NAME, name) #NAME,

/* The size of a table with an entry per kind: `0 VL_MATERIAL_KINDS(VL_COUNT_KIND)`. */
#define VL_COUNT_KIND(NAME, name) +1

/* ---- families ---------------------------------------------------------------------------------------------------- */

extern const vlKindFamily vl_material_family, vl_texture_family, vl_pixel_filter_family;
extern const vlKindFamily vl_light_family;    /* vlLightDef */
extern const vlKindFamily vl_emission_family; /* vlEmissionDef: one kind */
extern const vlKindFamily vl_shape_family;    /* vlShapeDef */
extern const vlKindFamily vl_medium_family;   /* vlMediumDef */
/* vlSceneDefs: */
extern const vlKindFamily vl_sampler_family, vl_tracer_family, vl_film_family;

/* What files call cameras (vlCameraDef): those of this list, then one per projection. */
#define VL_CAMERA_KINDS(X)                \
  X(PBRT_PERSPECTIVE, pbrt_perspective)   \
  X(PBRT_ORTHOGRAPHIC, pbrt_orthographic) \
  X(SPHERICAL, spherical)                 \
  X(REALISTIC, realistic)                 \
  X(PINHOLE, pinhole)                     \
  X(THIN_LENS, thin_lens)                 \
  X(FISHEYE, fisheye)                     \
  X(OPENCV, opencv)                       \
  X(OPENCV_FISHEYE, opencv_fisheye)       \
  X(COLMAP, colmap)
typedef enum vlCameraKind {
#define VL_KIND(NAME, name) VL_CAMERA_##NAME,
  VL_CAMERA_KINDS(VL_KIND)
#undef VL_KIND
      VL_CAMERA_OF_PROJECTION /* + vlProjection */
} vlCameraKind;
extern const vlKindFamily vl_camera_family;

/* Power of a light of that def, as pbrt counts it: luminance is that of its colour, scale and
 * included; radius: of a sphere round the scene. NaN: an image decides. */
double vl_light_power(const vlLightDef *def, double luminance, double radius);

/* The box of a shape in its own space, without regard to `centers`; of curves, that of their control points. Empty
 * (low > high): it has no vertices. */
void vl_shape_own_box(const vlShapeDef *def, double low[3], double high[3]);
/* Has the kind vertices and faces (VL_SHAPE_TRAIT_MESH)? */
bool vl_shape_is_mesh(vlShapeKind kind);

/* The row of a kind; null when the family has no such kind. */
const vlKindRow *vl_kind_row(const vlKindFamily *family, int kind);
/* The kind with this name or alias in files; -1: none. */
int vl_kind_find(const vlKindFamily *family, const char *name);
/* Names (not aliases) in files of all kinds that have one, for "did you mean"; returns how many, at most `most`. */
size_t vl_kind_names(const vlKindFamily *family, const char **names, size_t most);
/* The parameter of that name or alias; null: none. */
const vlParameter *vl_row_find(const vlKindRow *row, const char *name);

/* ---- defs -------------------------------------------------------------------------------------------------------- */

/* Gives the members that the row names their defaults; leaves the others alone. */
void vl_row_set_defaults(const vlKindRow *row, void *def);
/* Gives all members that any row of the family names their defaults, those of `kind` last: a def may change its kind.
 */
void vl_family_set_defaults(const vlKindFamily *family, int kind, void *def);
/* Copies the members that the row names; what they point at is shared. */
void vl_row_copy_members(const vlKindRow *row, const void *from, void *to);
/* Checks the members that the row names (ranges, finite numbers, textures that exist and have the right type, choices)
 * and replaces what they point at with copies owned by the scene. spectrum: of EITHER_INPUT, the half that is read.
 * false after vl_scene_fail with a message that names `what`, the parameter, its value and range. BLOCKs are left to
 * the caller. */
bool vl_row_take(struct vlScene *scene, const vlKindRow *row, void *def, bool spectrum, vlSource source,
                 const char *what);
/* Checks the member's own value: finite, in range, a known choice, there where it is required. message: filled when
 * false. */
bool vl_parameter_check(const vlParameter *parameter, const void *def, const char *what, char message[200]);
/* As a number: counts, floats, doubles, choices, bools, inputs without texture that hold one number. false: it is none.
 */
bool vl_parameter_number(const vlParameter *parameter, const void *def, double *number);
/* Is the value the default? */
bool vl_parameter_is_default(const vlParameter *parameter, const void *def, bool spectrum);

#endif
