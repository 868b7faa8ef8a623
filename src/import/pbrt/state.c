/* import/pbrt/state.c: pbrt's graphics state: current transforms, named coordinate systems, the
 * stack, attributes, objects and their instances. */
#include "base/text.h"
#include "import/pbrt/builder.h"
#include "math/double3.h"

/* ---- transforms -------------------------------------------------------------------------- */

static void set_ctm(vlImport *import, vlMat4 m) {
  for (int i = 0; i < 2; i++)
    if (import->state.active & 1u << i)
      import->state.ctm[i] = m;
}

static void apply(vlImport *import, vlMat4 m) {
  for (int i = 0; i < 2; i++)
    if (import->state.active & 1u << i)
      import->state.ctm[i] = vl_mat4_multiply(import->state.ctm[i], m);
}

/* pbrt's LookAt (book, 3.9.2): camera_from_world with x right, y up, z forward. */
static bool look_at(vlImport *import, const vlStatement *s) {
  const double *e = s->numbers, *l = s->numbers + 3, *u = s->numbers + 6;
  double d[3] = {l[0] - e[0], l[1] - e[1], l[2] - e[2]};
  double length = vl_normalize3(d);
  if (!(length > 0.0))
    return vl_import_wrong(import, s->source,
                           "LookAt: the eye and the point it looks at are the same");
  double r[3], n[3];
  vl_cross3(u, d, r);
  double size = vl_normalize3(r);
  double up = vl_norm3(u);
  if (!(up > 0.0))
    return vl_import_wrong(import, s->source, "LookAt: the up vector is zero");
  if (!(size > 1e-12 * up))
    return vl_import_wrong(import, s->source,
                           "LookAt: the up vector is parallel to the view direction");
  vl_cross3(d, r, n);
  vlMat4 world_from_camera = {{r[0], n[0], d[0], e[0], r[1], n[1], d[1], e[1], r[2], n[2], d[2],
                               e[2], 0, 0, 0, 1}},
         m;
  vl_mat4_inverse(world_from_camera, &m);
  apply(import, m);
  return true;
}

bool vl_import_transform(vlImport *import, const vlStatement *s) {
  const double *v = s->numbers;
  vlMat4 m = vl_mat4_identity();
  if (s->directive == VL_DIR_LOOK_AT)
    return look_at(import, s);
  if (s->directive == VL_DIR_ROTATE && v[1] == 0.0 && v[2] == 0.0 && v[3] == 0.0)
    return vl_import_wrong(import, s->source, "Rotate: the axis is zero");
  if (s->directive == VL_DIR_IDENTITY)
    set_ctm(import, m);
  else if (s->directive == VL_DIR_TRANSLATE)
    apply(import, vl_mat4_translate(v[0], v[1], v[2]));
  else if (s->directive == VL_DIR_SCALE)
    apply(import, vl_mat4_scale(v[0], v[1], v[2]));
  else if (s->directive == VL_DIR_ROTATE)
    apply(import, vl_mat4_rotate(v[0] * 0.017453292519943295, v[1], v[2], v[3]));
  if (s->directive != VL_DIR_TRANSFORM && s->directive != VL_DIR_CONCAT_TRANSFORM)
    return true;
  for (int i = 0; i < 4; i++) /* files store matrices column by column */
    for (int j = 0; j < 4; j++)
      m.m[4 * i + j] = v[4 * j + i];
  if (s->directive == VL_DIR_TRANSFORM)
    set_ctm(import, m);
  else
    apply(import, m);
  return true;
}

bool vl_import_name_system(vlImport *import, const char *name, const vlMat4 m[2]) {
  const char *kept = vl_import_keep(import, name);
  vlTransforms *slot = kept ? VL_IMPORT_PUSH(import, &import->matrices) : NULL;
  if (!slot)
    return false;
  slot->at[0] = m[0];
  slot->at[1] = m[1];
  return vl_import_add_name(import, &import->coordinate_systems, kept,
                            import->matrices.count - 1);
}

bool vl_import_use_system(vlImport *import, const vlStatement *s) {
  uint32_t index;
  if (vl_names_find(&import->coordinate_systems, s->names[0], &index)) {
    for (int i = 0; i < 2; i++)
      import->state.ctm[i] = import->matrices.items[index].at[i];
    return true;
  }
  return vl_import_missing_name(import, s->source, "coordinate system", s->names[0],
                                &import->coordinate_systems);
}

/* ---- the stack --------------------------------------------------------------------------- */

bool vl_import_push(vlImport *import, char kind, vlSource source) {
  if (import->stack.count > 100000)
    return vl_import_wrong(import, source, "attributes are nested more than 100000 deep");
  vlStackEntry *entry = VL_IMPORT_PUSH(import, &import->stack);
  if (!entry)
    return false;
  *entry = (vlStackEntry){kind, source, import->state};
  return vl_scene_copy_source(import->scene, &entry->source);
}

void vl_import_restore(vlImport *import) {
  import->state = import->stack.items[--import->stack.count].state;
  for (int t = 0; t < VL_ATTR_TARGETS; t++) {
    vlParamList *params = &import->attributes[t];
    while (params->list.count > import->state.attributes[t])
      vl_param_free(import->context, params->list.items[--params->list.count]);
  }
}

bool vl_import_pop(vlImport *import, char kind, const char *directive, vlSource source) {
  static const struct {
    char kind;
    const char *name;
  } openers[] = {{'a', "AttributeBegin"}, {'o', "ObjectBegin"}, {'i', "Import"}};
  const vlStackEntry *top =
      import->stack.count ? &import->stack.items[import->stack.count - 1] : NULL;
  if (!top || (top->kind != kind && top->kind == 'i'))
    return vl_import_wrong(import, source, "%s without its beginning", directive);
  if (top->kind != kind) {
    const char *open = "";
    for (size_t i = 0; i < 3; i++)
      if (openers[i].kind == top->kind)
        open = openers[i].name;
    return vl_import_wrong(import, source, "%s: the %s of line %u must be closed first",
                           directive, open, top->source.line);
  }
  vl_import_restore(import);
  return true;
}

/* ---- attributes -------------------------------------------------------------------------- */

bool vl_import_attribute(vlImport *import, const vlStatement *s) {
  static const char *const targets[] = {"shape", "light", "material", "medium", "texture"};
  int target = -1;
  for (int i = 0; i < VL_ATTR_TARGETS; i++)
    if (vl_text_is(s->names[0], targets[i]))
      target = i;
  if (target < 0)
    return vl_import_wrong(
        import, s->source,
        "Attribute: unknown target \"%s\" (known: shape, light, material, medium, texture)",
        vl_short_text(s->names[0]).text);
  for (size_t i = 0; i < s->params->list.count; i++)
    s->params->list.items[i]->optional = true;
  if (!vl_import_keep_params(import, s, &import->attributes[target]))
    return false;
  import->state.attributes[target] = import->attributes[target].list.count;
  return true;
}

/* ---- objects ----------------------------------------------------------------------------- */

/* An object may be instanced before it is defined: its group is made at the first use. */
static vlObject *find_object(vlImport *import, const char *name, vlSource source) {
  uint32_t index;
  if (vl_names_find(&import->objects, name, &index))
    return &import->object_list.items[index];
  const char *kept = vl_import_keep(import, name);
  if (!kept || !vl_scene_copy_source(import->scene, &source))
    return NULL;
  vlGroupId group = vl_scene_add_group(import->scene, kept);
  if (!group.index)
    return NULL;
  vlObject *object = VL_IMPORT_PUSH(import, &import->object_list);
  if (!object ||
      !vl_import_add_name(import, &import->objects, kept, import->object_list.count - 1))
    return NULL;
  *object = (vlObject){.name = kept, .group = group, .source = source};
  return object;
}

static bool is_outside(vlImport *import, const vlStatement *s, const char *directive) {
  return !import->in_object ||
         vl_import_wrong(import, s->source, "%s inside of an object: objects do not nest",
                         directive);
}

bool vl_import_object_begin(vlImport *import, const vlStatement *s) {
  if (!is_outside(import, s, "ObjectBegin"))
    return false;
  vlObject *object = find_object(import, s->names[0], s->source);
  if (!object)
    return false;
  if (object->defined)
    return vl_import_wrong(import, s->source, "object \"%s\" is defined a second time",
                           vl_short_text(s->names[0]).text);
  object->defined = true;
  import->in_object = true;
  import->object = object->group;
  return vl_import_push(import, 'o', s->source);
}

bool vl_import_object_end(vlImport *import, const vlStatement *s) {
  if (!vl_import_pop(import, 'o', "ObjectEnd", s->source))
    return false;
  import->in_object = false;
  import->object = (vlGroupId){0};
  return true;
}

bool vl_import_object_instance(vlImport *import, const vlStatement *s) {
  if (!is_outside(import, s, "ObjectInstance"))
    return false;
  const vlObject *object = find_object(import, s->names[0], s->source);
  return object && vl_import_add_instance(import, object->group, import->state.ctm, s->source);
}
