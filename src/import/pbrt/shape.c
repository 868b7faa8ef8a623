/* import/pbrt/shape.c: Shape directives to the scene. The arrays of a mesh change hands, they are not copied. */
#include <stdio.h>
#include <string.h>

#include "import/pbrt/builder.h"
#include "import/pbrt/loop.h"

static const double degrees = 0.017453292519943295;
static const char *const kinds[] = {"trianglemesh", "bilinearmesh", "plymesh",    "sphere",
                                    "disk",         "cylinder",     "loopsubdiv", "curve"};
enum { KINDS = 8, TRIANGLES = 0, BILINEAR, PLY, SPHERE, DISK, CYLINDER, LOOP, CURVE };

/* Takes the array out of the parameter: a block of the context without slack. */
static bool take_floats(vlImport *import, vlParam *p, const float **result) {
  float *items = p->floats.items;
  if (p->optional) { /* an attribute's: others will ask for it */
    float *copy = vl_alloc_array(import->context, p->floats.count, sizeof *copy);
    if (!copy) return vl_import_fail_memory(import);
    memcpy(copy, items, p->floats.count * sizeof *copy);
    *result = copy;
    return true;
  }
  if (p->floats.capacity > p->floats.count) {
    items = vl_realloc_array(import->context, items, p->floats.count, sizeof *items);
    if (!items) return vl_import_fail_memory(import);
  }
  *result = items;
  p->floats.items = NULL;
  p->floats.count = p->floats.capacity = 0;
  return true;
}

/* Per-vertex values: a whole number for each of the mesh's vertices. */
static bool take_vertex_floats(vlDict *dict, const char *name, vlParamType type, size_t per, uint32_t vertices,
                               const float **result) {
  vlParam *p = vl_dict_find(dict, name, 1u << type);
  if (!p) return dict->import->scene->error.code == VL_OK;
  size_t count = p->floats.count;
  if (count != per * vertices)
    return vl_import_fail(dict->import, VL_ERROR_SCENE, p->place,
                          "%s: \"%s\" holds %zu numbers, but %u vertices need %zu", dict->what, name, count, vertices,
                          per * vertices);
  return take_floats(dict->import, p, result);
}

static bool take_indices(vlDict *dict, vlShapeDef *def, size_t per) {
  vlImport *import = dict->import;
  vlParam *p = vl_dict_find(dict, "indices", 1u << VL_PARAM_INTEGER);
  if (!p && import->scene->error.code != VL_OK) return false;
  size_t count = p ? p->integers.count : per;
  if (!p && def->vertices != per)
    return vl_import_fail(import, VL_ERROR_SCENE, dict->place, "%s: \"integer indices\" is missing", dict->what);
  if (count % per)
    return vl_import_fail(import, VL_ERROR_SCENE, p->place, "%s: \"indices\" holds %zu numbers, not a multiple of %zu",
                          dict->what, count, per);
  if (count / per > 0x7fffffffu)
    return vl_import_fail(import, VL_ERROR_SCENE, p->place, "%s: too many faces", dict->what);
  for (size_t i = 0; p && i < count; i++)
    if (p->integers.items[i] < 0 || (uint32_t)p->integers.items[i] >= def->vertices)
      return vl_import_fail(import, VL_ERROR_SCENE, p->place,
                            "%s: \"indices\": number %zu names vertex %d, but there are %u vertices (0 to %u)",
                            dict->what, i, p->integers.items[i], def->vertices, def->vertices - 1);
  uint32_t *indices = vl_alloc_array(import->context, count, sizeof *indices);
  if (!indices) return vl_import_fail_memory(import);
  for (size_t i = 0; i < count; i++) indices[i] = p ? (uint32_t)p->integers.items[i] : (uint32_t)i;
  def->indices = indices;
  def->faces = (uint32_t)(count / per);
  if (p && !p->optional) VL_ARRAY_FREE(import->context, &p->integers);
  return true;
}

static bool read_mesh(vlDict *dict, vlShapeDef *def, size_t per) {
  vlImport *import = dict->import;
  vlParam *p = vl_dict_find(dict, "P", 1u << VL_PARAM_POINT3);
  if (!p) {
    if (import->scene->error.code != VL_OK) return false;
    vl_dict_find(dict, "indices", 1u << VL_PARAM_INTEGER), vl_dict_find(dict, "uv", 1u << VL_PARAM_POINT2);
    vl_dict_find(dict, "N", 1u << VL_PARAM_NORMAL), vl_dict_find(dict, "faceIndices", 1u << VL_PARAM_INTEGER);
    if (per == 3) vl_dict_find(dict, "S", 1u << VL_PARAM_VECTOR3);
    if (!vl_dict_done(dict)) return false; /* a misspelt one */
    return vl_import_fail(import, VL_ERROR_SCENE, dict->place, "%s: \"point3 P\" is missing", dict->what);
  }
  size_t count = p->floats.count;
  if (count % 3)
    return vl_import_fail(import, VL_ERROR_SCENE, p->place, "%s: \"P\" holds %zu numbers, not a multiple of 3",
                          dict->what, count);
  if (count / 3 > 0x7fffffffu)
    return vl_import_fail(import, VL_ERROR_SCENE, p->place, "%s: too many vertices", dict->what);
  def->vertices = (uint32_t)(count / 3);
  vl_dict_find(dict, "faceIndices", 1u << VL_PARAM_INTEGER); /* only pbrt's ptex textures look at them */
  if (!take_floats(import, p, &def->positions) || !take_indices(dict, def, per) ||
      !take_vertex_floats(dict, "uv", VL_PARAM_POINT2, 2, def->vertices, &def->uvs) ||
      !take_vertex_floats(dict, "N", VL_PARAM_NORMAL, 3, def->vertices, &def->normals) ||
      (per == 3 && !take_vertex_floats(dict, "S", VL_PARAM_VECTOR3, 3, def->vertices, &def->tangents)))
    return false;
  if (per == 4) vl_dict_find(dict, "emissionfilename", 1u << VL_PARAM_STRING); /* where pbrt looks for light: a hint */
  return import->scene->error.code == VL_OK;
}

static void free_arrays(vlImport *import, const vlShapeDef *def) {
  const void *blocks[5] = {def->positions, def->normals, def->tangents, def->uvs, def->indices};
  for (int i = 0; i < 5; i++) {
    void *block;
    memcpy(&block, &blocks[i], sizeof block);
    vl_free(import->context, block);
  }
}

/* A control mesh, subdivided to its limit. */
static bool read_loop(vlDict *dict, vlShapeDef *def) {
  vlImport *import = dict->import;
  uint32_t levels = 3;
  const char *scheme = "loop";
  vl_dict_count(dict, "levels", 0, &levels);
  vl_dict_string(dict, "scheme", &scheme); /* pbrt reads it, too, and knows one only */
  if (!read_mesh(dict, def, 3)) return false;
  vlLoopMesh mesh;
  vlError error = {0};
  vlResult result = vl_loop_subdivide(import->context, def->vertices, def->positions, def->faces, def->indices, levels,
                                      &mesh, &error);
  if (result != VL_OK) return vl_import_fail(import, result, dict->place, "%s: %s", dict->what, error.message);
  free_arrays(import, def);
  def->uvs = def->tangents = NULL;
  def->vertices = mesh.vertices;
  def->faces = mesh.faces;
  def->positions = mesh.positions;
  def->normals = mesh.normals;
  def->indices = mesh.indices;
  return true;
}

static bool read_quadric(vlDict *dict, vlShapeDef *def, int kind) {
  double phi_max = 360.0;
  vl_dict_float(dict, "radius", &def->radius);
  def->z_min = kind == SPHERE ? -def->radius : -1.0f;
  def->z_max = kind == SPHERE ? def->radius : 1.0f;
  if (kind != DISK) {
    vl_dict_float(dict, "zmin", &def->z_min);
    vl_dict_float(dict, "zmax", &def->z_max);
    if (def->z_min > def->z_max) { /* pbrt sorts them */
      float t = def->z_min;
      def->z_min = def->z_max;
      def->z_max = t;
    }
    if (kind == SPHERE) { /* and clamps them */
      if (def->z_min < -def->radius) def->z_min = -def->radius;
      if (def->z_max > def->radius) def->z_max = def->radius;
    }
  } else {
    vl_dict_float(dict, "height", &def->height);
    vl_dict_float(dict, "innerradius", &def->inner_radius);
  }
  vl_dict_double(dict, "phimax", &phi_max);
  def->phi_max = (float)((phi_max > 360.0 ? 360.0 : phi_max) * degrees);
  return dict->import->scene->error.code == VL_OK;
}

/* ---- shapes enter ----------------------------------------------------------------------------------------------- */

bool vl_import_add_shape(vlImport *import, const vlShapeDef *def, const vlShapeLink *link) {
  vlShapeId id = vl_scene_adopt_shape(import->scene, def);
  if (!id.index) return false;
  if (!link->material && !link->material_name && !link->alpha && !link->displacement) return true;
  vlShapeLink *slot = VL_PUSH(import->context, &import->links);
  if (!slot) return vl_import_fail_memory(import);
  *slot = *link;
  slot->shape = id.index - 1;
  return true;
}

static bool read_displacement(vlDict *dict, vlShapeDef *def, vlShapeLink *link) {
  vlImport *import = dict->import;
  vlParam *p = vl_dict_find(dict, "displacement", VL_BIT_TEXTURE);
  const char *const lengths[] = {"displacement.edgelength", "edgelength"};
  for (int i = 0; i < 2; i++)
    if (vl_dict_float(dict, lengths[i], &def->edge_length) && !(def->edge_length > 0.0f))
      return vl_import_fail(import, VL_ERROR_SCENE, dict->place, "%s: \"%s\" must be above 0", dict->what, lengths[i]);
  def->edge_length *= (float)import->edge_scale;
  if (!p) return import->scene->error.code == VL_OK;
  if (vl_param_count(p) != 1)
    return vl_import_fail(import, VL_ERROR_SCENE, p->place, "%s: \"displacement\" takes one texture", dict->what);
  link->displacement = vl_import_keep(import, p->strings.items[0]);
  link->displacement_place = p->place;
  return link->displacement && vl_scene_copy_source(import->scene, &link->displacement_place);
}

/* The file itself is read later, beside others (meshes.c). */
static bool note_ply(vlDict *dict, vlShapeDef *def, vlShapeLink *link) {
  vlImport *import = dict->import;
  vlParam *file = vl_dict_find(dict, "filename", 1u << VL_PARAM_STRING);
  if (!read_displacement(dict, def, link) || !vl_dict_done(dict)) return false;
  if (!file)
    return vl_import_fail(import, VL_ERROR_SCENE, dict->place, "%s: \"string filename\" is missing", dict->what);
  char path[4096];
  if (!vl_import_path(import, file, path, sizeof path)) return false;
  return vl_import_note_mesh(import, path, file->place, def, link);
}

/* Alpha: a number, or a float texture that is looked up at the end. */
static bool read_alpha(vlDict *dict, vlShapeDef *def, vlShapeLink *link) {
  vlImport *import = dict->import;
  vlParam *p = vl_dict_find(dict, "alpha", VL_BIT_FLOAT | VL_BIT_TEXTURE);
  if (!p) return import->scene->error.code == VL_OK;
  if (vl_param_count(p) != 1)
    return vl_import_fail(import, VL_ERROR_SCENE, p->place, "%s: parameter \"alpha\" takes 1 value, found %zu",
                          dict->what, vl_param_count(p));
  if (p->type == VL_PARAM_FLOAT) {
    def->alpha.value = p->floats.items[0];
    return true;
  }
  link->alpha = vl_import_keep(import, p->strings.items[0]);
  link->alpha_place = p->place;
  return link->alpha && vl_scene_copy_source(import->scene, &link->alpha_place);
}

/* Of the shapes from this one on. */
static bool note_media(vlImport *import, size_t first, vlSource place) {
  for (size_t i = first; i < import->scene->shapes.count; i++)
    if (!vl_import_note_media(import, 's', (uint32_t)i, place)) return false;
  return true;
}

bool vl_import_shape(vlImport *import, const vlStatement *s) {
  char what[96];
  snprintf(what, sizeof what, "Shape \"%.60s\"", s->names[0]);
  vlDict dict = vl_import_dict(import, what, s->place, import->state.space, s->params,
                               vl_import_attributes(import, VL_ATTR_SHAPE));
  int kind = -1;
  for (int i = 0; i < KINDS; i++)
    if (strcmp(s->names[0], kinds[i]) == 0) kind = i;
  if (kind < 0)
    return vl_import_unknown(import, s->place, "shape", s->names[0], kinds, KINDS, NULL, 0); /* permissive: left out */
  static const vlShapeKind shape_kinds[KINDS] = {VL_SHAPE_TRIANGLES, VL_SHAPE_BILINEAR, VL_SHAPE_TRIANGLES,
                                                 VL_SHAPE_SPHERE,    VL_SHAPE_DISK,     VL_SHAPE_CYLINDER,
                                                 VL_SHAPE_TRIANGLES, VL_SHAPE_CURVES};
  vlShapeDef def = vl_default_shape_def(shape_kinds[kind]);
  vlShapeLink link = {.material = import->state.material,
                      .material_name = import->state.material_name,
                      .material_place = import->state.material_place};
  vlMat4 ctm = vl_mat4_identity();
  bool moves = vl_import_moves(import);
  def.source = s->place;
  def.group = import->object;
  def.reverse_orientation = import->state.reverse_orientation;
  if (moves && !vl_import_moving_group(import, s->place, &def.group)) return false;
  if ((!moves && !vl_import_ctm(import, s->place, &ctm)) || !read_alpha(&dict, &def, &link)) return false;
  memcpy(def.group_from_shape, ctm.m, sizeof def.group_from_shape);
  def.emission = import->state.emission;
  if (def.emission.index && import->in_object) {
    vl_import_warn(import, VL_LOG_WARNING, s->place, "area lights inside of objects give no light (as in pbrt)");
    def.emission.index = 0;
  }
  if (def.emission.index && moves) {
    vl_import_warn(import, VL_LOG_WARNING, s->place, "an area light that moves (ActiveTransform) gives no light");
    def.emission.index = 0;
  }
  if (kind == CURVE) return vl_import_curve(&dict, &def, &link);
  if (!vl_import_flush_curves(import)) return false;
  size_t before = import->scene->shapes.count;
  if (kind == PLY) return note_ply(&dict, &def, &link) && note_media(import, before, s->place);
  bool fine = kind == LOOP     ? read_loop(&dict, &def)
              : kind >= SPHERE ? read_quadric(&dict, &def, kind)
                               : read_mesh(&dict, &def, kind == TRIANGLES ? 3 : 4);
  fine = fine && vl_dict_done(&dict);
  bool gathered = false;
  if (fine && kind == TRIANGLES && !vl_import_gather_mesh(import, &def, &link, &gathered)) fine = false;
  if (fine && kind == SPHERE && !vl_import_gather_sphere(import, &def, &link, &gathered)) fine = false;
  if (fine && !gathered) return vl_import_add_shape(import, &def, &link) && note_media(import, before, s->place);
  free_arrays(import, &def);
  return fine;
}
