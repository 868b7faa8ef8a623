/* import/pbrt/builder.h: types and functions shared by the files that turn pbrt statements into
 * a scene. Statements are executed in file order. Camera, film and similar directives take
 * effect at WorldBegin. Textures, materials and the materials of shapes are resolved at the
 * end, since pbrt allows a material to be named before it is defined. */
#ifndef IMPORT_PBRT_BUILDER_H
#define IMPORT_PBRT_BUILDER_H

#include "import/find.h"
#include "import/names.h"
#include "import/pbrt/parse.h"
#include "import/repair.h"
#include "math/transform.h"
#include "scene/scene.h"
#include "schema/schema.h"
#include "velo/shape.h"

typedef enum vlAttributeTarget {
  VL_ATTR_SHAPE,
  VL_ATTR_LIGHT,
  VL_ATTR_MATERIAL,
  VL_ATTR_MEDIUM,
  VL_ATTR_TEXTURE,
  VL_ATTR_TARGETS
} vlAttributeTarget;

typedef struct vlGraphicsState {
  vlMat4 ctm[2]; /* current transforms at the start and at the end time */
  /* bit mask of the transforms that directives change: bit 0 start, bit 1 end */
  uint32_t active;
  bool reverse_orientation;
  vlColorSpace space;
  uint32_t material; /* 1 + index in import->materials; 0: material_name, or the default */
  const char *material_name; /* named material, resolved at the end; may be null */
  vlSource material_source;
  vlEmissionId emission;
  const char *inside, *outside;       /* names of the media inside and outside of shapes */
  size_t attributes[VL_ATTR_TARGETS]; /* number of parameters in import->attributes[target] that
                                         apply */
} vlGraphicsState;

typedef struct vlStackEntry {
  char kind; /* the block: 'a' attribute, 't' transform, 'o' object, 'i' import */
  vlSource source;
  vlGraphicsState state;
} vlStackEntry;

typedef struct vlTransforms {
  vlMat4 at[2];
} vlTransforms;

/* A texture or material that is resolved at the end. */
typedef enum vlPendingState { VL_PENDING, VL_IN_PROGRESS, VL_DONE } vlPendingState;
typedef struct vlPending {
  const char *name; /* null for unnamed materials */
  const char *kind; /* null: given by the parameter "type" (MakeNamedMaterial) */
  bool spectrum;    /* textures only */
  vlSource source;
  vlColorSpace space;
  vlMat4 ctm; /* textures only */
  vlParamList params;
  vlPendingState state;
  uint32_t id; /* id in the scene when done; 0: skipped */
  bool is_interface;
} vlPending;

/* Links of a shape that are resolved at the end. */
typedef struct vlShapeLink {
  uint32_t shape; /* index in scene->shapes */
  uint32_t material;
  const char *material_name;
  vlSource material_source;
  const char *alpha; /* name of a float texture */
  vlSource alpha_source;
  const char *displacement; /* name of a float texture */
  vlSource displacement_source;
} vlShapeLink;

/* A mesh file that is read at the end (meshes.c). `shape` is the placeholder for its shape. */
typedef struct vlMeshFile {
  const char *path;
  vlSource source;
  vlShapeDef def;
  vlShapeLink link;
  uint32_t shape;
} vlMeshFile;

typedef struct vlObject {
  const char *name;
  vlGroupId group;
  bool defined;
  vlSource source; /* of the first directive that uses the file */
} vlObject;

/* Media that are looked up at the end. target: 's' shape (index in scene->shapes), 'l' light,
 * 'c' camera. */
typedef struct vlMediumLink {
  char target;
  uint32_t index;
  const char *inside, *outside; /* empty: vacuum */
  vlSource source;
} vlMediumLink;

/* Shapes of equal graphics state that become one shape (run.c). */
typedef enum vlRunKind { VL_RUN_CURVES, VL_RUN_MESHES, VL_RUN_SPHERES, VL_RUN_KINDS } vlRunKind;
enum { VL_RUNS = 16, VL_RUN_FROM = 4096 };
typedef VL_ARRAY(float) vlRunFloats;
typedef struct vlShapeRun {
  bool open;
  uint32_t faces; /* gathered so far */
  vlShapeDef def; /* normals, uvs: not null when the run of meshes has them */
  vlShapeLink link;
  const char *inside, *outside; /* media */
  vlRunFloats positions, normals, uvs, widths, radii;
  VL_ARRAY(double) centers; /* 3 a sphere */
  VL_ARRAY(uint32_t) indices;
} vlShapeRun;
typedef struct vlRuns {
  vlShapeRun items[VL_RUNS]; /* of curves the first only */
  uint32_t next;             /* the run that is ended when a new one needs its slot */
} vlRuns;

/* Shapes under an animated transform. */
typedef struct vlMovingGroup {
  vlGroupId group, object; /* object: the object that contains the group; 0: none */
  vlMat4 ctm[2];
  vlSource source;
} vlMovingGroup;

/* A directive before WorldBegin, kept until WorldBegin. */
typedef struct vlChoice {
  bool given;
  const char *kind;
  vlSource source;
  vlColorSpace space;
  vlParamList params;
} vlChoice;

struct vlImport {
  vlContext *context;
  vlScene *scene;
  bool permissive;
  bool image_missing; /* set while a directive is read: its image was reported as missing */
  const char *first;  /* path of the first file */
  const char *search_path; /* further folders, separated by ':'; may be null */
  vlRepairs repairs;
  uint32_t elsewhere; /* number of files that were found in the current folder only */
  bool in_world;
  vlGraphicsState state;
  VL_ARRAY(vlStackEntry) stack;
  vlParamList attributes[VL_ATTR_TARGETS]; /* parameters of Attribute directives that apply, a
                                              stack per target; restoring the graphics state
                                              removes the newer entries */
  vlNameTable coordinate_systems;          /* to indices in matrices */
  VL_ARRAY(vlTransforms) matrices;
  VL_ARRAY(vlPending) textures;
  VL_ARRAY(vlPending) materials;
  vlNameTable float_textures, spectrum_textures, named_materials, objects;
  VL_ARRAY(vlObject) object_list;
  VL_ARRAY(vlShapeLink) links;
  VL_ARRAY(vlMeshFile) mesh_files;
  VL_ARRAY(char *) strings; /* strings kept until the end of the import */
  bool in_object;           /* between ObjectBegin and ObjectEnd */
  vlGroupId object;
  double film_diagonal; /* mm */
  union {
    struct {
      vlChoice film, sampler, integrator, filter, accelerator, camera;
    };
    vlChoice choices[6]; /* the same, in the order of their directives from VL_DIR_FILM on */
  };
  vlMat4 camera_from_world[2]; /* current transforms at the start and at the end time */
  vlNameTable media;           /* to ids in the scene */
  VL_ARRAY(vlMediumLink) medium_links;
  double times[2]; /* TransformTimes: times of the two current transforms in seconds */
  VL_ARRAY(vlMovingGroup) moving;
  vlRuns runs[VL_RUN_KINDS];
  double edge_scale; /* Option "displacementedgescale" */
  uint32_t depth;    /* nesting of textures or materials that refer to each other */
  uint32_t problems; /* number of errors reported so far */
};
enum { VL_IMPORT_DEPTH = 200, VL_IMPORT_PROBLEMS = 1000 };

/* ---- errors, warnings, copies (report.c) ------------------------------------------------- */
bool vl_import_fail(vlImport *import, vlResult code, vlSource source, const char *format, ...)
    VL_PRINTF(4, 5);
/* The same of what the scene's text says: the code is VL_ERROR_SCENE. */
bool vl_import_wrong(vlImport *import, vlSource source, const char *format, ...)
    VL_PRINTF(3, 4);
/* The same at a directive or at one of its parameters; the message begins with dict->what. */
bool vl_dict_fail(const vlDict *dict, const char *format, ...) VL_PRINTF(2, 3);
bool vl_dict_fail_at(const vlDict *dict, vlSource source, const char *format, ...)
    VL_PRINTF(3, 4);
bool vl_import_fine(const vlImport *import); /* no error was reported */
bool vl_import_fail_memory(vlImport *import);
void vl_import_warn(vlImport *import, vlLogLevel level, vlSource source, const char *format,
                    ...) VL_PRINTF(4, 5);
void vl_dict_warn(const vlDict *dict, const char *format, ...) VL_PRINTF(2, 3);
/* While diagnosing (vl_scene_diagnose): reports the scene's error and clears it. False when not
 * diagnosing or when the error is fatal. */
bool vl_import_recover(vlImport *import);
/* While diagnosing: reports a note on valid input that is probably unintended. */
void vl_import_remark(vlImport *import, vlSource source, const char *format, ...)
    VL_PRINTF(3, 4);
/* Reports valid pbrt that velo does not support: as an error, or, when permissive, as a
 * warning; it then returns true. */
bool vl_import_unsupported(vlImport *import, vlSource source, const char *format, ...)
    VL_PRINTF(3, 4);
/* Reports a kind that is not among `known` in the same way. */
bool vl_import_unknown(vlImport *import, vlSource source, const char *thing, const char *name,
                       const char *const *known, size_t count);
/* The name of a kind for messages. Names that velo does not know are shortened. */
vlShortText vl_import_kind_text(const vlKindFamily *family, const char *name);
/* Like vl_import_unknown; the known names are the kinds of the family. */
bool vl_import_unknown_kind(vlImport *import, vlSource source, const vlKindFamily *family,
                            const char *name);
/* copy that lives until the end of the import; null when out of memory */
const char *vl_import_keep(vlImport *import, const char *text);
/* Reports a name that is not in the table. Returns false. */
bool vl_import_missing_name(vlImport *import, vlSource source, const char *thing,
                            const char *name, const vlNameTable *table);
/* Looks for a file that the file `naming` names (find.h), and notes the first that is in the
 * current folder only. */
vlFound vl_import_find(vlImport *import, vlSource source, const char *name, char *path,
                       size_t size);
void vl_import_note_elsewhere(void *user, vlSource source, const char *path);
/* Writes the path of the file that a string parameter names. Returns false after an error: the
 * file is not readable or the path too long. */
bool vl_import_path(vlImport *import, const vlParam *param, char *path, size_t size);
/* Like vl_import_path for an image. When permissive, a missing image is a warning,
 * import->image_missing is set, and the result is false without an error. */
bool vl_import_image_path(vlImport *import, const vlParam *param, char *path, size_t size);
bool vl_import_color_space(const char *name, vlColorSpace *space);

/* State (state.c). */
bool vl_import_name_system(vlImport *import, const char *name, const vlMat4 m[2]);
bool vl_import_push(vlImport *import, char kind, vlSource source);
bool vl_import_pop(vlImport *import, char kind, const char *directive, vlSource source);
void vl_import_restore(vlImport *import);
/* Motion (motion.c). vl_import_ctm returns the current transform for something that cannot move
 * and warns when the start and end transforms differ. */
bool vl_import_ctm(vlImport *import, vlSource source, vlMat4 *ctm);
bool vl_import_moves(const vlImport *import); /* whether the start and end transforms differ */
/* The group for a shape under the current, animated transform. The shape's own transform
 * becomes the identity. */
bool vl_import_moving_group(vlImport *import, vlSource source, vlGroupId *group);
bool vl_import_add_instance(vlImport *import, vlGroupId group, const vlMat4 ctm[2],
                            vlSource source);

/* VL_PUSH, which reports that memory is exhausted. */
#define VL_IMPORT_PUSH(import, array)                                            \
  (VL_RESERVE_ZERO((import)->context, array, 1) || vl_import_fail_memory(import) \
       ? &(array)->items[(array)->count++]                                       \
       : NULL)
/* Adds a name to a table. False: memory is exhausted. */
bool vl_import_add_name(vlImport *import, vlNameTable *table, const char *name, size_t index);

/* ---- parts ------------------------------------------------------------------------------- */

/* Functions that obey a directive. False after an error. */
typedef bool vlImportStatement(vlImport *import, const vlStatement *s);
vlImportStatement vl_import_transform, vl_import_use_system, vl_import_attribute; /* state.c */
vlImportStatement vl_import_object_begin, vl_import_object_end, vl_import_object_instance;
vlImportStatement vl_import_times;  /* motion.c */
vlImportStatement vl_import_option; /* film.c */
vlImportStatement vl_import_texture, vl_import_medium, vl_import_shape;
vlImportStatement vl_import_light, vl_import_area_light;
vlImportStatement vl_import_material, vl_import_make_named_material, vl_import_named_material;

/* Functions of the whole import. False after an error. */
typedef bool vlImportStep(vlImport *import);
/* They apply the directives before WorldBegin to the scene's defs: sampling.c those of sampler,
 * filter and integrator; the camera follows the film. */
vlImportStep vl_import_camera, vl_import_film, vl_import_sampling;
/* At the end: mesh files, media, moving groups inside objects (once all instances are known),
 * and the runs (run.c). Other shapes than curves end a run of curves. */
vlImportStep vl_import_read_meshes, vl_import_finish_media, vl_import_finish_motion;
vlImportStep vl_import_flush_runs, vl_import_flush_curves;

/* The spectrum of a parameter (rgb, spectrum, blackbody). Sampled values are kept with the
 * import's strings. */
bool vl_import_spectrum(vlImport *import, vlParam *param, vlSpectrum *spectrum);
/* The first function reads a number or a float texture, the second a spectrum or a spectrum
 * texture. Both return whether it is given; false also after an error. */
bool vl_import_float_input(vlDict *dict, const char *name, vlFloatInput *input);
bool vl_import_spectrum_input(vlDict *dict, const char *name, vlSpectrumInput *input,
                              bool albedo);

/* The parameters of a directive, and what messages call it (parameters.c). */
vlDict vl_import_dict(vlImport *import, const char *what, vlSource source, vlColorSpace space,
                      const vlParamList *own, const vlParamList *attributes);
/* The same for the directive of a light, which names a kind. */
vlDict vl_import_light_dict(vlImport *import, const char *directive, const vlKindFamily *family,
                            const vlStatement *s);
/* The same for a directive that a file has once; standard: its kind where the file lacks it. */
vlDict vl_import_choice_dict(vlImport *import, const char *directive,
                             const vlKindFamily *family, const vlChoice *choice,
                             const char *standard);
/* Sets the kind and its row. */
void vl_dict_set_kind(vlDict *dict, const vlKindFamily *family, int kind);
/* Reads the parameters of the row into the members of def. A member whose parameter is not
 * given is unchanged. spectrum selects the spectrum or the float input of EITHER_INPUT.
 * Parameters with VL_PARAMETER_RULE and BLOCKs are left to the caller. False after an error. */
bool vl_import_parameters(vlDict *dict, void *def, bool spectrum);
/* Whether the file gives the parameter, which the row has. */
bool vl_import_given(const vlDict *dict, const char *name);
/* Reads the choice of the row's parameter into *value. False when the row lacks it, it is not
 * given, or after an error. */
bool vl_dict_row_choice(vlDict *dict, const char *name, int *value);

bool vl_import_texture_id(vlImport *import, const char *name, bool spectrum, vlSource source,
                          vlTextureId *id);
/* first resolves the textures that this one refers to */
bool vl_import_finish_texture(vlImport *import, uint32_t index);
bool vl_import_finish_material(vlImport *import, uint32_t index);
/* Instead: the default material, by its name. */
bool vl_import_give_up_material(vlImport *import, vlPending *pending);
/* Finishes a texture or a material once. too_deep: the error where they refer to each other
 * more than VL_IMPORT_DEPTH deep. */
bool vl_import_finish_once(vlImport *import, vlPending *pending,
                           bool (*finish)(vlImport *import, vlPending *pending),
                           const char *too_deep);
/* Reads the parameter "type" of a directive that makes something by name. False after an
 * error, also that there is none. */
bool vl_dict_type(vlDict *dict, const char **type);
/* Absorption and scattering per millimetre of the substance named by parameter `name`
 * (scattering.h). */
bool vl_import_scattering_preset(vlDict *dict, const char *name, vlSpectrum *absorption,
                                 vlSpectrum *scattering, bool *given);
bool vl_import_material_id(vlImport *import, const char *name, vlSource source,
                           vlMaterialId *id, bool *is_interface);

/* Moves the parameters of a statement to the end of `to`, so that they outlive it. The scene
 * keeps the file names of their sources. */
bool vl_import_keep_params(vlImport *import, const vlStatement *s, vlParamList *to);
/* Keeps a texture or a material, with the attributes of the target, until the end of the file.
 * Null after an error. */
vlPending *vl_import_wait(vlImport *import, const vlStatement *s, vlAttributeTarget target,
                          bool is_texture);
/* Notes that pbrt shows the rough coats of the scene brighter. */
void vl_import_note_rough_coats(vlImport *import);

/* Keeps what links a shape of this index to other things, if anything does. */
bool vl_import_link_shape(vlImport *import, const vlShapeLink *link, uint32_t shape);
bool vl_import_note_mesh(vlImport *import, const char *path, vlSource source,
                         const vlShapeDef *def, const vlShapeLink *link);
/* Adds a shape between two media that are not those of the current state. The scene takes
 * ownership of the def's arrays. */
bool vl_import_add_shape_between(vlImport *import, const vlShapeDef *def,
                                 const vlShapeLink *link, const char *inside,
                                 const char *outside);
bool vl_import_curve(vlDict *dict, vlShapeDef *def, const vlShapeLink *link);
/* Runs (run.c): the one that the shape joins; a new one ends another. Null after an error. */
vlShapeRun *vl_import_run(vlImport *import, vlRunKind kind, const vlShapeDef *def,
                          const vlShapeLink *link);
void vl_import_free_runs(vlImport *import);
/* Whether meshes and spheres are gathered yet, and such ones. */
bool vl_import_may_gather(const vlImport *import, const vlShapeDef *def,
                          const vlShapeLink *link);
/* Copy a small mesh or a whole sphere into a run. *taken is false when it must become a shape
 * of its own. */
typedef bool vlImportGather(vlImport *import, const vlShapeDef *def, const vlShapeLink *link,
                            bool *taken);
vlImportGather vl_import_gather_mesh, vl_import_gather_sphere;
/* Records the media of the current state for a shape ('s'), a light ('l') or the camera
 * ('c'). */
bool vl_import_note_media(vlImport *import, char target, uint32_t index, vlSource source);

#endif
