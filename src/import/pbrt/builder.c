/* import/pbrt/builder.c: executes the statements of a pbrt file: where each statement may stand
 * and which function handles it; textures and materials wait for the end of the file, where
 * they are resolved and linked to shapes. Also imports a whole file. */
#include "import/pbrt/builder.h"
#include "base/error.h"
#include "base/free.h"
#include "import/pbrt/upgrade/detect.h"

#include "base/text.h"
#include "import/import.h"
#include "velo/shape.h"

/* ---- parameters that outlive their directive --------------------------------------------- */

bool vl_import_keep_params(vlImport *import, const vlStatement *s, vlParamList *to) {
  vlParamList *own = s->params;
  for (size_t i = 0; i < own->list.count; i++)
    if (!vl_scene_copy_source(import->scene, &own->list.items[i]->source))
      return false;
  if (!VL_RESERVE(import->context, &to->list, own->list.count))
    return vl_import_fail_memory(import);
  for (size_t i = 0; i < own->list.count; i++)
    to->list.items[to->list.count++] = own->list.items[i];
  VL_ARRAY_FREE(import->context, &own->list);
  return true;
}

/* Shares the attributes of a target with `to`. */
static bool share_attributes(vlImport *import, vlAttributeTarget target, vlParamList *to) {
  const vlParamList *from = &import->attributes[target];
  if (!VL_RESERVE(import->context, &to->list, from->list.count))
    return vl_import_fail_memory(import);
  for (size_t i = 0; i < from->list.count; i++) {
    from->list.items[i]->shared++;
    to->list.items[to->list.count++] = from->list.items[i];
  }
  return true;
}

/* The statement's parameters follow the attributes: the last one given counts. */
vlPending *vl_import_wait(vlImport *import, const vlStatement *s, vlAttributeTarget target,
                          bool is_texture) {
  vlPending *p = is_texture ? VL_IMPORT_PUSH(import, &import->textures)
                            : VL_IMPORT_PUSH(import, &import->materials);
  if (!p)
    return NULL;
  p->source = s->source;
  p->space = import->state.space;
  p->ctm = import->state.ctm[0];
  if (!vl_scene_copy_source(import->scene, &p->source) ||
      !share_attributes(import, target, &p->params) ||
      !vl_import_keep_params(import, s, &p->params))
    return NULL;
  return p;
}

/* ---- statements that need no file of their own ------------------------------------------- */

/* Records a directive that precedes WorldBegin. The last directive of a kind counts. */
static bool choose(vlImport *import, const vlStatement *s) {
  vlChoice *choice = &import->choices[s->directive - VL_DIR_FILM];
  if (choice->given)
    vl_import_remark(import, s->source, "%s a second time: this one counts",
                     vl_directive_name(s->directive));
  vl_param_list_free(import->context, &choice->params);
  choice->given = true;
  choice->source = s->source;
  choice->space = import->state.space;
  choice->kind = vl_import_keep(import, s->names[0]);
  return choice->kind && vl_scene_copy_source(import->scene, &choice->source) &&
         vl_import_keep_params(import, s, &choice->params);
}

/* A later camera replaces the media of the earlier one. */
static void forget_camera_media(vlImport *import) {
  for (size_t i = 0; i < import->medium_links.count;) {
    vlMediumLink *link = &import->medium_links.items[i];
    if (link->target == 'c')
      *link = import->medium_links.items[--import->medium_links.count];
    else
      i++;
  }
}

static bool camera(vlImport *import, const vlStatement *s) {
  vlMat4 world_from_camera[2];
  if (!choose(import, s))
    return false;
  memcpy(import->camera_from_world, import->state.ctm, sizeof import->state.ctm);
  if (!vl_mat4_inverse(import->state.ctm[0], &world_from_camera[0]) ||
      !vl_mat4_inverse(import->state.ctm[1], &world_from_camera[1]))
    return vl_import_wrong(import, s->source, "Camera: the current transform is singular");
  forget_camera_media(import);
  return vl_import_note_media(import, 'c', 0, s->source) &&
         vl_import_name_system(import, "camera", world_from_camera);
}

static bool medium_interface(vlImport *import, const vlStatement *s) {
  import->state.inside = vl_import_keep(import, s->names[0]);
  import->state.outside = vl_import_keep(import, s->names[1]);
  return import->state.inside && import->state.outside;
}

static bool color_space(vlImport *import, const vlStatement *s) {
  if (vl_import_color_space(s->names[0], &import->state.space))
    return true;
  return vl_import_wrong(
      import, s->source,
      "unknown colour space \"%s\" (known: srgb, dci-p3, rec2020, aces2065-1)",
      vl_short_text(s->names[0]).text);
}

static bool world_begin(vlImport *import, VL_UNUSED const vlStatement *s) {
  import->in_world = true;
  import->state.ctm[0] = import->state.ctm[1] = vl_mat4_identity();
  import->state.active = 3;
  return vl_import_name_system(import, "world", import->state.ctm) && vl_import_film(import) &&
         vl_import_camera(import) && vl_import_sampling(import);
}

static void note_space(vlImport *import, const vlStatement *s) {
  for (size_t i = 0; i < s->params->list.count; i++)
    s->params->list.items[i]->space = import->state.space;
}

/* ---- statements -------------------------------------------------------------------------- */

static bool begin_block(vlImport *import, const vlStatement *s) {
  return vl_import_push(import, s->directive == VL_DIR_IMPORT_BEGIN ? 'i' : 'a', s->source);
}

static bool end_block(vlImport *import, const vlStatement *s) {
  return vl_import_pop(import, 'a', vl_directive_name(s->directive), s->source);
}

static bool fail_open(vlImport *import) {
  const vlStackEntry *top = &import->stack.items[import->stack.count - 1];
  return vl_import_wrong(import, top->source, "%s is never closed",
                         top->kind == 'o' ? "ObjectBegin" : "AttributeBegin");
}

static bool end_import(vlImport *import, VL_UNUSED const vlStatement *s) {
  if (import->stack.items[import->stack.count - 1].kind != 'i')
    return fail_open(import);
  vl_import_restore(import);
  return true;
}

static bool activate(vlImport *import, const vlStatement *s) {
  import->state.active = s->directive == VL_DIR_ACTIVE_ALL     ? 3
                         : s->directive == VL_DIR_ACTIVE_START ? 1
                                                               : 2;
  return true;
}

static bool reverse_orientation(vlImport *import, VL_UNUSED const vlStatement *s) {
  import->state.reverse_orientation = !import->state.reverse_orientation;
  return true;
}

static bool name_system(vlImport *import, const vlStatement *s) {
  return vl_import_name_system(import, s->names[0], import->state.ctm);
}

/* ---- directives -------------------------------------------------------------------------- */

/* What obeys a directive, and the part of a file where it may stand: options precede
 * WorldBegin, the world follows it. */
typedef enum Part { ANYWHERE, OPTIONS, WORLD } Part;
typedef struct Rule {
  vlImportStatement *obey;
  Part part;
} Rule;

static const Rule rules[] = {
    [VL_DIR_ATTRIBUTE_BEGIN] = {begin_block, WORLD}, /* as in pbrt-v4, both blocks save the */
    [VL_DIR_ATTRIBUTE_END] = {end_block, WORLD},     /* whole graphics state */
    [VL_DIR_TRANSFORM_BEGIN] = {begin_block, WORLD},
    [VL_DIR_TRANSFORM_END] = {end_block, WORLD},
    [VL_DIR_IDENTITY] = {vl_import_transform, ANYWHERE},
    [VL_DIR_REVERSE_ORIENTATION] = {reverse_orientation, WORLD},
    [VL_DIR_WORLD_BEGIN] = {world_begin, OPTIONS},
    [VL_DIR_OBJECT_END] = {vl_import_object_end, WORLD},
    [VL_DIR_ACTIVE_ALL] = {activate, ANYWHERE},
    [VL_DIR_ACTIVE_START] = {activate, ANYWHERE},
    [VL_DIR_ACTIVE_END] = {activate, ANYWHERE},
    [VL_DIR_IMPORT_BEGIN] = {begin_block, WORLD},
    [VL_DIR_IMPORT_END] = {end_import, ANYWHERE},
    [VL_DIR_TRANSLATE] = {vl_import_transform, ANYWHERE},
    [VL_DIR_SCALE] = {vl_import_transform, ANYWHERE},
    [VL_DIR_ROTATE] = {vl_import_transform, ANYWHERE},
    [VL_DIR_LOOK_AT] = {vl_import_transform, ANYWHERE},
    [VL_DIR_TRANSFORM] = {vl_import_transform, ANYWHERE},
    [VL_DIR_CONCAT_TRANSFORM] = {vl_import_transform, ANYWHERE},
    [VL_DIR_TRANSFORM_TIMES] = {vl_import_times, OPTIONS},
    [VL_DIR_COORDINATE_SYSTEM] = {name_system, ANYWHERE},
    [VL_DIR_COORD_SYS_TRANSFORM] = {vl_import_use_system, ANYWHERE},
    [VL_DIR_COLOR_SPACE] = {color_space, ANYWHERE},
    [VL_DIR_NAMED_MATERIAL] = {vl_import_named_material, WORLD},
    [VL_DIR_OBJECT_BEGIN] = {vl_import_object_begin, WORLD},
    [VL_DIR_OBJECT_INSTANCE] = {vl_import_object_instance, WORLD},
    [VL_DIR_MEDIUM_INTERFACE] = {medium_interface, ANYWHERE},
    [VL_DIR_OPTION] = {vl_import_option, ANYWHERE},
    [VL_DIR_ATTRIBUTE] = {vl_import_attribute, ANYWHERE},
    [VL_DIR_FILM] = {choose, OPTIONS},
    [VL_DIR_SAMPLER] = {choose, OPTIONS},
    [VL_DIR_INTEGRATOR] = {choose, OPTIONS},
    [VL_DIR_PIXEL_FILTER] = {choose, OPTIONS},
    [VL_DIR_ACCELERATOR] = {choose, OPTIONS},
    [VL_DIR_CAMERA] = {camera, OPTIONS},
    [VL_DIR_MAKE_NAMED_MEDIUM] = {vl_import_medium, ANYWHERE},
    [VL_DIR_MATERIAL] = {vl_import_material, WORLD},
    [VL_DIR_MAKE_NAMED_MATERIAL] = {vl_import_make_named_material, WORLD},
    [VL_DIR_AREA_LIGHT_SOURCE] = {vl_import_area_light, WORLD},
    [VL_DIR_LIGHT_SOURCE] = {vl_import_light, WORLD},
    [VL_DIR_SHAPE] = {vl_import_shape, WORLD},
    [VL_DIR_TEXTURE] = {vl_import_texture, WORLD},
};

/* ---- statements -------------------------------------------------------------------------- */

static bool in_right_part(vlImport *import, const vlStatement *s) {
  const Part part = rules[s->directive].part;
  if (part == ANYWHERE || (part == WORLD) == import->in_world)
    return true;
  if (s->directive == VL_DIR_WORLD_BEGIN)
    return vl_import_wrong(import, s->source, "WorldBegin a second time");
  return vl_import_wrong(import, s->source, "%s must come %s WorldBegin",
                         vl_directive_name(s->directive), part == WORLD ? "after" : "before");
}

/* While diagnosing, an invalid statement is skipped. The name of a medium that it defines stays
 * known, so that later uses are not reported, too. */
static bool statement(void *user, const vlStatement *s) {
  vlImport *import = user;
  bool misplaced = !in_right_part(import, s);
  note_space(import, s);
  if (!misplaced && rules[s->directive].obey(import, s))
    return true;
  if (misplaced && !import->in_world) { /* a file without WorldBegin: every later statement
                                           would be an error, too */
    import->problems = VL_IMPORT_PROBLEMS;
    return false;
  }
  if (!vl_import_recover(import))
    return false;
  uint32_t index;
  if (s->directive != VL_DIR_MAKE_NAMED_MEDIUM ||
      vl_names_find(&import->media, s->names[0], &index))
    return true;
  const char *name = vl_import_keep(import, s->names[0]);
  return name && vl_import_add_name(import, &import->media, name, 0);
}

static void parse_error(void *user, vlResult code, vlSource source, const char *message) {
  vl_import_fail(user, code, source, "%s", message);
}

static bool recover(void *user) {
  return vl_import_recover(user);
}

/* Permissive: a file beyond the limits is left out. */
static bool skip_include(void *user, vlSource source) {
  vlImport *import = user;
  if (!import->permissive)
    return false;
  if (!import->repairs.includes++)
    vl_import_warn(import, VL_LOG_WARNING, source,
                   "this file and others beyond the limits of Include are left out");
  return true;
}

static bool go_on(void *user, double fraction) {
  vlImport *import = user;
  /* then the meshes of other files are read */
  return !vl_scene_stopped(import->scene, 0.5 * fraction);
}

/* ---- the end of the file ----------------------------------------------------------------- */

bool vl_import_finish_once(vlImport *import, vlPending *pending,
                           bool (*finish)(vlImport *import, vlPending *pending),
                           const char *too_deep) {
  if (pending->state == VL_DONE)
    return true;
  if (++import->depth > VL_IMPORT_DEPTH)
    return vl_import_wrong(import, pending->source, "%s more than %d deep", too_deep,
                           VL_IMPORT_DEPTH);
  pending->state = VL_IN_PROGRESS;
  if (!finish(import, pending))
    return false;
  import->depth--;
  pending->state = VL_DONE;
  return true;
}

static bool link_shape(vlImport *import, const vlShapeLink *link) {
  vlShapeDef *shape = &import->scene->shapes.items[link->shape];
  bool is_interface = false;
  if (link->material_name) {
    if (!vl_import_material_id(import, link->material_name, link->material_source,
                               &shape->material, &is_interface))
      return false;
  } else if (link->material) {
    const vlPending *p = &import->materials.items[link->material - 1];
    shape->material.index = p->id;
    is_interface = p->is_interface;
  }
  if (is_interface && shape->emission.index) {
    vl_import_warn(
        import, VL_LOG_WARNING, shape->source,
        "a shape of material \"interface\" gives no light: its area light is ignored");
    shape->emission.index = 0;
  }
  if (link->displacement &&
      !vl_import_texture_id(import, link->displacement, false, link->displacement_source,
                            &shape->displacement.texture))
    return false;
  return !link->alpha || vl_import_texture_id(import, link->alpha, false, link->alpha_source,
                                              &shape->alpha.texture);
}

/* While diagnosing: unfinished textures are skipped and unfinished materials become the default
 * one. */
static bool give_up(vlImport *import) {
  if (!vl_import_recover(import))
    return false;
  import->depth = 0;
  for (size_t i = 0; i < import->textures.count; i++)
    if (import->textures.items[i].state == VL_IN_PROGRESS)
      import->textures.items[i].state = VL_DONE;
  VL_EACH_ITEM(vlPending, p, &import->materials) {
    if (p->state == VL_IN_PROGRESS && !vl_import_give_up_material(import, p))
      return false;
  }
  return true;
}

static bool finish(vlImport *import) {
  vlScene *scene = import->scene;
  if (scene->error.code != VL_OK)
    return false;
  if (!import->in_world)
    return vl_import_wrong(import, (vlSource){import->first, 0, 0},
                           "the file has no WorldBegin");
  if (import->stack.count)
    return fail_open(import);
  if (!vl_import_flush_runs(import))
    return false;
  if (!vl_import_read_meshes(import))
    return false;
  for (uint32_t i = 0; i < import->textures.count; i++)
    if (!vl_import_finish_texture(import, i) && !give_up(import))
      return false;
  for (uint32_t i = 0; i < import->materials.count; i++)
    if (!vl_import_finish_material(import, i) && !give_up(import))
      return false;
  for (size_t i = 0; i < import->links.count; i++)
    if (!link_shape(import, &import->links.items[i]) && !give_up(import))
      return false;
  if (!vl_import_finish_motion(import))
    return false;
  VL_EACH_ITEM(const vlObject, object, &import->object_list) {
    if (object->defined)
      continue;
    vl_import_wrong(import, object->source, "there is no object \"%s\"",
                    vl_short_text(object->name).text);
    if (!vl_import_recover(import))
      return false;
  }
  vl_import_note_rough_coats(import);
  return vl_import_finish_media(import);
}

/* ---- a whole file ------------------------------------------------------------------------ */

static void free_pending(vlContext *context, vlPending *items, size_t count) {
  for (size_t i = 0; i < count; i++)
    vl_param_list_free(context, &items[i].params);
}

static void release(vlImport *import) {
  vlContext *context = import->context;
  free_pending(context, import->textures.items, import->textures.count);
  free_pending(context, import->materials.items, import->materials.count);
  for (size_t i = 0; i < VL_LENGTH(import->choices); i++)
    vl_param_list_free(context, &import->choices[i].params);
  for (int t = 0; t < VL_ATTR_TARGETS; t++)
    vl_param_list_free(context, &import->attributes[t]);
  vlNameTable *tables[] = {
      &import->coordinate_systems, &import->float_textures, &import->spectrum_textures,
      &import->named_materials,    &import->objects,        &import->media};
  for (size_t i = 0; i < VL_LENGTH(tables); i++)
    vl_free(context, tables[i]->slots);
  for (size_t i = 0; i < import->strings.count; i++)
    vl_free(context, import->strings.items[i]);
  vl_import_free_runs(import);
  VL_FREE(context, import->textures.items, import->materials.items,
          (void *)import->strings.items, import->stack.items, import->matrices.items,
          import->moving.items, import->object_list.items, import->links.items,
          import->mesh_files.items, import->medium_links.items, import);
}

/* A scene of an older pbrt: the error names the command. */
static bool fail_old(vlImport *import, const char *path) {
  vlOldScene old = vl_old_scene(import->context, path);
  if (!old.version)
    return false;
  vl_error_clear(&import->scene->error);
  vl_import_wrong(import, (vlSource){path, old.line, old.column},
                  "this is a pbrt-v%d scene (%s): velo scene upgrade %s NEW.pbrt makes a "
                  "pbrt-v4 scene of it",
                  old.version, old.sign, path);
  return true;
}

static vlResult run(vlScene *scene, const char *path, const char *data, size_t size,
                    const char *const *texts, size_t text_count, const vlLoadDef *def,
                    vlError *error) {
  VL_TRY(vl_scene_result(scene, error));
  vlImport *import = vl_alloc_zero(scene->context, 1, sizeof *import);
  if (!import)
    return vl_fail_memory(error);
  import->context = scene->context;
  import->scene = scene;
  import->permissive = def && def->permissive;
  import->first = path;
  import->search_path = def ? def->search_path : NULL;
  import->state.ctm[0] = import->state.ctm[1] = vl_mat4_identity();
  import->state.active = 3;
  import->times[1] = 1.0;
  import->edge_scale = 1.0;
  import->state.space = VL_SPACE_SRGB;
  vlParseTarget target = {.user = import,
                          .statement = statement,
                          .error = parse_error,
                          .recover = recover,
                          .search_path = import->search_path,
                          .found_elsewhere = vl_import_note_elsewhere,
                          .go_on = go_on,
                          .texts = texts,
                          .text_count = text_count,
                          .skip = skip_include};
  /* its many errors are not listed */
  bool is_old = !data && scene->problem && fail_old(import, path);
  bool fine = is_old ? false
              : data ? vl_parse_memory(import->context, data, size, path, &target)
                     : vl_parse_file(import->context, path, &target);
  if (fine)
    finish(import);
  vl_repairs_report(import->context, &import->repairs, path);
  if (!data && scene->error.code == VL_ERROR_SCENE)
    fail_old(import, path);
  release(import);
  return vl_scene_result(scene, error);
}

vlResult vl_import_pbrt(vlScene *scene, const char *path, const vlLoadDef *def,
                        vlError *error) {
  return run(scene, path, NULL, 0, NULL, 0, def, error);
}

vlResult vl_import_pbrt_memory(vlScene *scene, const char *data, size_t size, const char *name,
                               const vlLoadDef *def, vlError *error) {
  return run(scene, name, data, size, NULL, 0, def, error);
}

vlResult vl_import_pbrt_texts(vlScene *scene, const char *path, const char *text,
                              const char *const *texts, size_t count, const vlLoadDef *def,
                              vlError *error) {
  return run(scene, path, text, strlen(text), texts, count, def, error);
}
