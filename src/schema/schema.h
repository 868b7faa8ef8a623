/* schema/schema.h: the rows of all families of kinds, and functions that access a def through
 * its row. A row describes one kind and its parameters. The row of a kind is in the folder of
 * its family (src/material/diffuse.row.c), those of films, cameras and settings are in this
 * folder. */
#ifndef SCHEMA_SCHEMA_H
#define SCHEMA_SCHEMA_H

#include "base/attributes.h"
#include "velo/scene_base.h"
#include "velo/schema.h"
#include "velo/setting.h"
#include "velo/spectrum.h"

/* For the files that hold rows: each kind has an array of parameters and a vlKindRow; the list
 * of kinds then makes the table, so that a kind without a row does not compile. */

/* Initialises a parameter of type VL_PARAMETER_##TYPE, stored in the member `path` of Def.
 * file_name may be NULL. VL_DEFAULT, VL_RANGE or VL_FROM and further initialisers may follow.
 * The compiler warns if the member has another C type. */
#define VL_PARAMETER(TYPE, Def, file_name, path, text_line, ...)                     \
  {                                                                                  \
    .type = VL_PARAMETER_##TYPE, .name = file_name, .member = #path,                 \
    .offset = VL_TYPED_OFFSET(VL_POINTER_##TYPE, Def, path),                         \
    .size = sizeof(((const Def *)NULL)->path), .description = text_line, __VA_ARGS__ \
  }
#define VL_DEFAULT(...) .value = {__VA_ARGS__}
#define VL_RANGE(min, max) .low = (min), .high = (max)
#define VL_FROM(min) .low = (min), .high = (double)__builtin_inff()
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

/* Initialises the parameters of a row with a list of them, or with an array. */
#define VL_PARAMETERS(...)                          \
  .parameters = (const vlParameter[]){__VA_ARGS__}, \
  .parameter_count = sizeof((const vlParameter[]){__VA_ARGS__}) / sizeof(vlParameter)
#define VL_ROW_PARAMETERS(array) \
  .parameters = (array), .parameter_count = sizeof(array) / sizeof *(array)

/* For the list of a family's kinds (FAMILY/kinds.row.h), X(kind, row, ...): declares each row;
 * lists each row at its kind. */
#define VL_DECLARE_ROW(kind, row, ...) extern const vlKindRow row;
#define VL_LIST_ROW(kind, row, ...) [kind] = &row,

/* Initialises a family with its rows, each at its kind (VL_LIST_ROW), and the list of its
 * kinds. */
#define VL_ROW_ARRAY(...) ((const vlKindRow *const[]){__VA_ARGS__})
#define VL_KIND_FAMILY(row_list, KINDS, family_name, thing_name, directive_name)        \
  {                                                                                     \
    .name = family_name, .thing = thing_name, .directive = directive_name,              \
    .kind_count = sizeof VL_ROW_ARRAY(row_list) / sizeof(vlKindRow *),                  \
    .words = (const char *const[]){KINDS(VL_KIND_WORD)}, .rows = VL_ROW_ARRAY(row_list) \
  }
#define VL_KIND_WORD(kind, name, ...) #name,

/* A loop over the parameters of a row; p: what its body calls one. */
#define VL_EACH_PARAMETER(p, row) \
  for (const vlParameter *p = (row)->parameters; vl_is_parameter_of(p, row); p++)
static inline bool vl_is_parameter_of(const vlParameter *p, const vlKindRow *row) {
  return p - row->parameters < (ptrdiff_t)row->parameter_count;
}

/* For the size of a table with one entry per kind: `0 VL_MATERIAL_KINDS(VL_COUNT_KIND)`. */
#define VL_COUNT_KIND(...) +1

/* ---- families ---------------------------------------------------------------------------- */

extern const vlKindFamily vl_material_family, vl_texture_family, vl_pixel_filter_family;
extern const vlKindFamily vl_light_family;    /* vlLightDef */
extern const vlKindFamily vl_emission_family; /* vlEmissionDef; it has one kind */
extern const vlKindFamily vl_shape_family;    /* vlShapeDef */
extern const vlKindFamily vl_medium_family;   /* vlMediumDef */
/* The def of these families is vlSceneDefs: */
extern const vlKindFamily vl_sampler_family, vl_tracer_family, vl_film_family;

/* The kinds of camera in files (vlCameraDef): those of this list, then one per projection. */
#define VL_CAMERA_KINDS(X)                          \
  X(VL_CAMERA_PBRT_PERSPECTIVE, pbrt_perspective)   \
  X(VL_CAMERA_PBRT_ORTHOGRAPHIC, pbrt_orthographic) \
  X(VL_CAMERA_SPHERICAL, spherical)                 \
  X(VL_CAMERA_REALISTIC, realistic)                 \
  X(VL_CAMERA_PINHOLE, pinhole)                     \
  X(VL_CAMERA_THIN_LENS, thin_lens)                 \
  X(VL_CAMERA_FISHEYE, fisheye)                     \
  X(VL_CAMERA_OPENCV, opencv)                       \
  X(VL_CAMERA_OPENCV_FISHEYE, opencv_fisheye)       \
  X(VL_CAMERA_COLMAP, colmap)
typedef enum vlCameraKind {
#define VL_KIND(kind, name) kind,
  VL_CAMERA_KINDS(VL_KIND)
#undef VL_KIND
      VL_CAMERA_OF_PROJECTION /* + vlProjection */
} vlCameraKind;
extern const vlKindFamily vl_camera_family;
/* The settings (velo/setting.h), a row for each group; no files of scenes name them. */
extern const vlKindFamily vl_setting_family;
/* The settings of cameras: the parameters of all kinds, and what files say by rules. */
extern const vlKindRow vl_camera_settings_row;
/* Those of sensors and their exposures. */
extern const vlKindRow vl_sensor_settings_row, vl_exposure_settings_row;

/* Power of a light, by pbrt's definition. luminance: of the light's colour, with its scale.
 * radius: of a sphere around the scene. NaN: the power depends on an image. */
double vl_light_power(const vlLightDef *def, double luminance, double radius);

/* Bounding box of a shape in shape space; `centers` is ignored. For curves it is the box of the
 * control points. If the shape has no vertices, the box is empty (low > high). */
void vl_shape_own_box(const vlShapeDef *def, double low[3], double high[3]);
/* Whether shapes of this kind have vertices and faces (VL_SHAPE_TRAIT_MESH). */
bool vl_shape_is_mesh(uint32_t kind); /* vlShapeKind */

/* The row of a kind. Null: the family has no such kind. */
const vlKindRow *vl_kind_row(const vlKindFamily *family, int kind);
/* The kind that has this name or alias in files. -1: none. */
int vl_kind_find(const vlKindFamily *family, const char *name);
/* Gives the names that kinds have in files, without aliases, for "did you mean" messages.
 * Returns the number of names, at most `max`. */
size_t vl_kind_names(const vlKindFamily *family, const char **names, size_t max);
/* The parameter that has this name or alias in files. Null: none. */
const vlParameter *vl_row_find(const vlKindRow *row, const char *name);

/* ---- members of defs -------------------------------------------------------------------- */

/* How the value of a parameter is stored. Offsets are from the value's begin. */
typedef struct vlMemberType {
  int numbers;   /* 1 or 3; 0: it holds a spectrum, a text, or something else */
  size_t number; /* offset of the first one */
  double (*get)(const void *at, int i);
  void (*put)(void *at, int i, double number);
  bool textured;    /* it begins with the id of a texture, which stands for the rest */
  bool spectral;    /* it holds a spectrum */
  size_t spectrum;  /* offset of the spectrum */
  bool text;        /* it is a pointer to characters */
  const char *rule; /* what it must be; null: check.c writes that */
} vlMemberType;
extern const vlMemberType vl_member_types[]; /* by vlParameterType */

static inline uint32_t vl_member_texture(const vlMemberType *type, const void *at) {
  return type->textured ? ((const vlTextureId *)at)->index : 0;
}

static inline double vl_member_number(const vlMemberType *type, const void *at, int i) {
  return type->get((const char *)at + type->number, i);
}

static inline const vlSpectrum *vl_member_spectrum(const vlMemberType *type, const void *at) {
  return (const vlSpectrum *)(const void *)((const char *)at + type->spectrum);
}

/* ---- defs -------------------------------------------------------------------------------- */

/* Sets the members that the row describes to their defaults. Other members are unchanged. */
void vl_row_set_defaults(const vlKindRow *row, void *def);
/* The same with the row of a kind; an unknown kind has none. */
void vl_kind_set_defaults(const vlKindFamily *family, int kind, void *def);
/* Sets all members that any row of the family describes to their defaults, because a def may
 * change its kind. The defaults of `kind` are set last and take precedence. */
void vl_family_set_defaults(const vlKindFamily *family, int kind, void *def);
/* Copies the members that the row describes. Pointers are copied, not what they point at. */
void vl_row_copy_members(const vlKindRow *row, const void *from, void *to);
/* The name of a parameter in messages: its name in files, else its member's. */
const char *vl_parameter_label(const vlParameter *parameter);
/* Whether the value of a parameter fits its row: it is finite, in range and a known choice, and
 * not missing if it is required. Otherwise *wrong is the number that does not fit. */
bool vl_parameter_fits(const vlParameter *parameter, const void *def, double *wrong);
/* Writes why it does not (velo/setting.h: VL_GIVEN_MESSAGE). name: of the value in the message.
 */
void vl_parameter_complain(const vlParameter *parameter, const char *name, double wrong,
                           char message[VL_GIVEN_MESSAGE]);
/* Both: if the result is false, message holds the reason. */
bool vl_parameter_check(const vlParameter *parameter, const void *def, const char *name,
                        char message[VL_GIVEN_MESSAGE]);
/* Whether a number in the def's unit is finite (or may be infinite, or unset), whole if it must
 * be, and in range; of a choice, whether it is the index of one. */
bool vl_number_fits(const vlParameter *parameter, double number);
/* The range of its numbers, or infinity; numbers that are clamped have none. */
double vl_parameter_low(const vlParameter *parameter);
double vl_parameter_high(const vlParameter *parameter);
uint32_t vl_choice_count(const vlParameter *parameter); /* number of its choices */
/* Checks the choices of a part of a group's def (velo/setting.h), such as the member film of
 * vlSceneDefs: each must be one of those in its row. begin, size: of the part in the group's
 * def, bytes. If the result is false, message holds the reason. */
bool vl_choices_check(vlSettingGroup group, size_t begin, size_t size, const void *part,
                      char message[VL_GIVEN_MESSAGE]);
/* Gives the value of a parameter as a number. This works for counts, floats, doubles, choices,
 * bools, and inputs without texture that hold one number. False: the parameter is of another
 * type. */
bool vl_parameter_number(const vlParameter *parameter, const void *def, double *number);
/* Gives the textures that the members of the row read, at most `max`. Returns their number. */
uint32_t vl_row_textures(const vlKindRow *row, const void *def, vlTextureId *ids, uint32_t max);
/* Whether the value of a parameter is its default. */
bool vl_parameter_is_default(const vlParameter *parameter, const void *def, bool spectrum);

#endif
