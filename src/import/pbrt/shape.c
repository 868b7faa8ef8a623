/* import/pbrt/shape.c: Shape directives. The arrays of a mesh move to the scene without a
 * copy. */
#include <stdio.h>

#include "base/free.h"
#include "base/text.h"
#include "import/pbrt/builder.h"
#include "import/pbrt/loop.h"
#include "velo/shape_kinds.h"

/* Takes the array from the parameter, shrunk to its size. */
static bool take_floats(vlImport *import, vlParam *p, const float **result) {
  float *items = p->floats.items;
  if (p->optional) { /* an attribute's array is copied: other shapes read it, too */
    float *copy = vl_alloc_array(import->context, p->floats.count, sizeof *copy);
    if (!copy)
      return vl_import_fail_memory(import);
    memcpy(copy, items, p->floats.count * sizeof *copy);
    *result = copy;
    return true;
  }
  if (p->floats.capacity > p->floats.count) {
    items = vl_realloc_array(import->context, items, p->floats.count, sizeof *items);
    if (!items)
      return vl_import_fail_memory(import);
  }
  *result = items;
  p->floats.items = NULL;
  p->floats.count = p->floats.capacity = 0;
  return true;
}

/* Takes the values of a parameter that must have an integer number of values per vertex. */
static bool take_vertex_floats(vlDict *dict, const char *name, vlParamType type, size_t per,
                               uint32_t vertices, const float **result) {
  vlParam *p = vl_dict_find(dict, name, 1u << type);
  if (!p)
    return vl_import_fine(dict->import);
  size_t count = p->floats.count;
  if (count != per * vertices)
    return vl_dict_fail_at(dict, p->source,
                           "\"%s\" holds %zu numbers, but %u vertices need %zu", name, count,
                           vertices, per * vertices);
  return take_floats(dict->import, p, result);
}

static bool take_indices(vlDict *dict, vlShapeDef *def, size_t per) {
  vlImport *import = dict->import;
  vlParam *p = vl_dict_find(dict, "indices", VL_BIT_INTEGER);
  if (!p && !vl_import_fine(import))
    return false;
  size_t count = p ? p->integers.count : per;
  if (!p && def->vertices != per)
    return vl_dict_fail(dict, "\"integer indices\" is missing");
  if (count % per)
    return vl_dict_fail_at(dict, p->source,
                           "\"indices\" holds %zu numbers, not a multiple of %zu", count, per);
  if (count / per > 0x7fffffffu)
    return vl_dict_fail_at(dict, p->source, "too many faces");
  for (size_t i = 0; p && i < count; i++)
    if (p->integers.items[i] < 0 || (uint32_t)p->integers.items[i] >= def->vertices)
      return vl_dict_fail_at(
          dict, p->source,
          "\"indices\": number %zu names vertex %d, but there are %u vertices (0 to %u)", i,
          p->integers.items[i], def->vertices, def->vertices - 1);
  uint32_t *indices = vl_alloc_array(import->context, count, sizeof *indices);
  if (!indices)
    return vl_import_fail_memory(import);
  for (size_t i = 0; i < count; i++)
    indices[i] = p ? (uint32_t)p->integers.items[i] : (uint32_t)i;
  def->indices = indices;
  def->faces = (uint32_t)(count / per);
  if (p && !p->optional)
    VL_ARRAY_FREE(import->context, &p->integers);
  return true;
}

static bool read_mesh(vlDict *dict, vlShapeDef *def, size_t per) {
  vlImport *import = dict->import;
  vlParam *p = vl_dict_find(dict, "P", VL_BIT_POINT3);
  if (!p) {
    if (!vl_import_fine(import))
      return false;
    vl_dict_find(dict, "indices", VL_BIT_INTEGER);
    vl_dict_find(dict, "uv", VL_BIT_POINT2);
    vl_dict_find(dict, "N", VL_BIT_NORMAL);
    vl_dict_find(dict, "faceIndices", VL_BIT_INTEGER);
    if (per == 3)
      vl_dict_find(dict, "S", VL_BIT_VECTOR3);
    return vl_dict_missing(dict, "\"point3 P\"");
  }
  size_t count = p->floats.count;
  if (count % 3)
    return vl_dict_fail_at(dict, p->source, "\"P\" holds %zu numbers, not a multiple of 3",
                           count);
  if (count / 3 > 0x7fffffffu)
    return vl_dict_fail_at(dict, p->source, "too many vertices");
  def->vertices = (uint32_t)(count / 3);
  /* accepted and ignored: only pbrt's ptex textures use it */
  vl_dict_find(dict, "faceIndices", VL_BIT_INTEGER);
  if (!take_floats(import, p, &def->positions) || !take_indices(dict, def, per) ||
      !take_vertex_floats(dict, "uv", VL_PARAM_POINT2, 2, def->vertices, &def->uvs) ||
      !take_vertex_floats(dict, "N", VL_PARAM_NORMAL, 3, def->vertices, &def->normals) ||
      (per == 3 &&
       !take_vertex_floats(dict, "S", VL_PARAM_VECTOR3, 3, def->vertices, &def->tangents)))
    return false;
  if (per == 4)
    /* accepted and ignored: a hint for pbrt's light sampling */
    vl_dict_find(dict, "emissionfilename", VL_BIT_STRING);
  if (import->permissive && !vl_repair_mesh(import->context, &import->repairs, def))
    return vl_import_fail_memory(import);
  return vl_import_fine(import);
}

static void free_arrays(vlImport *import, const vlShapeDef *def) {
  VL_FREE(import->context, vl_owned(def->positions), vl_owned(def->normals),
          vl_owned(def->tangents), vl_owned(def->uvs), vl_owned(def->indices));
}

/* Loop subdivision of a control mesh to its limit surface. */
static bool read_loop(vlDict *dict, vlShapeDef *def) {
  vlImport *import = dict->import;
  uint32_t levels = 3;
  const char *scheme = "loop";
  vl_dict_count(dict, "levels", 0, &levels);
  vl_dict_string(dict, "scheme", &scheme); /* accepted: pbrt knows one scheme only */
  if (!read_mesh(dict, def, 3))
    return false;
  vlMesh mesh;
  vlError error = {0};
  vlResult result = vl_loop_subdivide(import->context, def->vertices, def->positions,
                                      def->faces, def->indices, levels, &mesh, &error);
  if (result != VL_OK)
    return vl_import_fail(import, result, dict->source, "%s: %s", dict->what, error.message);
  free_arrays(import, def);
  def->tangents = NULL;
  vl_mesh_to_shape(&mesh, def);
  return true;
}

static bool read_quadric(vlDict *dict, vlShapeDef *def) {
  const float whole = vl_default_shape_def(def->kind).phi_max;
  if (!vl_import_parameters(dict, def, false))
    return false;
  if (def->phi_max > whole)
    def->phi_max = whole;
  if (def->kind == VL_SHAPE_SPHERE) {
    if (!vl_import_given(dict, "zmin"))
      def->z_min = -def->radius;
    if (!vl_import_given(dict, "zmax"))
      def->z_max = def->radius;
  }
  if (def->z_min > def->z_max) { /* as in pbrt, sorted */
    float t = def->z_min;
    def->z_min = def->z_max;
    def->z_max = t;
  }
  if (def->kind == VL_SHAPE_SPHERE) { /* as in pbrt, clamped */
    if (def->z_min < -def->radius)
      def->z_min = -def->radius;
    if (def->z_max > def->radius)
      def->z_max = def->radius;
  }
  return true;
}

/* ---- shapes enter ------------------------------------------------------------------------ */

bool vl_import_link_shape(vlImport *import, const vlShapeLink *link, uint32_t shape) {
  if (!link->material && !link->material_name && !link->alpha && !link->displacement)
    return true;
  vlShapeLink *slot = VL_IMPORT_PUSH(import, &import->links);
  if (!slot)
    return false;
  *slot = *link;
  slot->shape = shape;
  return true;
}

/* Adds a shape. The scene takes ownership of the def's arrays. */
static bool add_shape(vlImport *import, const vlShapeDef *def, const vlShapeLink *link) {
  vlShapeId id = vl_scene_adopt_shape(import->scene, def);
  if (!id.index)
    return false;
  return vl_import_link_shape(import, link, id.index - 1);
}

bool vl_import_add_shape_between(vlImport *import, const vlShapeDef *def,
                                 const vlShapeLink *link, const char *inside,
                                 const char *outside) {
  vlGraphicsState now = import->state;
  import->state.inside = inside;
  import->state.outside = outside;
  bool fine =
      add_shape(import, def, link) &&
      vl_import_note_media(import, 's', (uint32_t)import->scene->shapes.count - 1, def->source);
  import->state = now;
  return fine;
}

/* Keeps the name of a texture, which is resolved at the end, and where the file gives it. */
static bool keep_texture(vlImport *import, const vlParam *p, const char **name,
                         vlSource *source) {
  *name = vl_import_keep(import, p->strings.items[0]);
  *source = p->source;
  return *name && vl_scene_copy_source(import->scene, source);
}

static bool read_displacement(vlDict *dict, vlShapeDef *def, vlShapeLink *link) {
  vlImport *import = dict->import;
  vlParam *p = vl_dict_find(dict, "displacement", VL_BIT_TEXTURE);
  const char *const lengths[] = {"displacement.edgelength", "edgelength"};
  for (int i = 0; i < 2; i++)
    if (vl_dict_float(dict, lengths[i], &def->edge_length) && !(def->edge_length > 0.0f))
      return vl_dict_fail(dict, "\"%s\" must be above 0", lengths[i]);
  def->edge_length *= (float)import->edge_scale;
  if (!p)
    return vl_import_fine(import);
  if (vl_param_count(p) != 1)
    return vl_dict_fail_at(dict, p->source, "\"displacement\" takes one texture");
  return keep_texture(import, p, &link->displacement, &link->displacement_source);
}

/* Records the mesh file. All mesh files are read at the end (meshes.c). */
static bool note_ply(vlDict *dict, vlShapeDef *def, vlShapeLink *link) {
  vlImport *import = dict->import;
  vlParam *file = vl_dict_find(dict, "filename", VL_BIT_STRING);
  if (!read_displacement(dict, def, link) || !vl_dict_done(dict))
    return false;
  if (!file)
    return vl_dict_fail(dict, "\"string filename\" is missing");
  char path[4096];
  if (!vl_import_path(import, file, path, sizeof path))
    return false;
  return vl_import_note_mesh(import, path, file->source, def, link);
}

/* Alpha: a number or a float texture. */
static bool read_alpha(vlDict *dict, vlShapeDef *def, vlShapeLink *link) {
  vlImport *import = dict->import;
  vlParam *p = vl_dict_find_counted(dict, "alpha", VL_BIT_FLOAT | VL_BIT_TEXTURE, 1);
  if (!p)
    return vl_import_fine(import);
  if (p->type == VL_PARAM_FLOAT) {
    def->alpha.value = p->floats.items[0];
    return true;
  }
  return keep_texture(import, p, &link->alpha, &link->alpha_source);
}

/* Records the media of the shapes from index first on. */
static bool note_media(vlImport *import, size_t first, vlSource source) {
  for (size_t i = first; i < import->scene->shapes.count; i++)
    if (!vl_import_note_media(import, 's', (uint32_t)i, source))
      return false;
  return true;
}

/* A shape that is read. */
typedef struct Entry {
  vlDict *dict;
  vlShapeDef *def;
  const vlShapeLink *link;
  bool taken; /* the def's arrays have moved */
} Entry;

/* Reads the parameters except alpha and adds the shape. */
typedef bool EnterShape(Entry *e);

static bool enter(Entry *e) {
  vlImport *import = e->dict->import;
  if (!vl_dict_done(e->dict))
    return false;
  e->taken = true;
  size_t before = import->scene->shapes.count;
  return add_shape(import, e->def, e->link) && note_media(import, before, e->dict->source);
}

/* Adds the shape to a run, or else by itself. */
static bool gather(Entry *e, vlImportGather *function) {
  bool gathered = false;
  if (!vl_dict_done(e->dict) || !function(e->dict->import, e->def, e->link, &gathered))
    return false;
  return gathered || enter(e);
}

static bool enter_triangles(Entry *e) {
  return read_mesh(e->dict, e->def, 3) && gather(e, vl_import_gather_mesh);
}

static bool enter_bilinear(Entry *e) {
  return read_mesh(e->dict, e->def, 4) && enter(e);
}

static bool enter_sphere(Entry *e) {
  return read_quadric(e->dict, e->def) && gather(e, vl_import_gather_sphere);
}

/* Adds a shape of any kind that its row describes completely. */
static bool enter_row(Entry *e) {
  const bool quadric = e->dict->row->traits & VL_SHAPE_TRAIT_QUADRIC;
  return (quadric ? read_quadric(e->dict, e->def)
                  : vl_import_parameters(e->dict, e->def, false)) &&
         enter(e);
}

/* Reads curves. They are added later, together with their media. */
static bool enter_curves(Entry *e) {
  e->taken = true;
  return vl_import_curve(e->dict, e->def, e->link);
}

static bool enter_loop(Entry *e) {
  return read_loop(e->dict, e->def) && enter(e);
}

static bool enter_ply(Entry *e) {
  vlShapeLink own = *e->link;
  size_t before = e->dict->import->scene->shapes.count;
  e->taken = true;
  return note_ply(e->dict, e->def, &own) &&
         note_media(e->dict->import, before, e->dict->source);
}

/* Rules that the rows do not express; null: enter_row. */
static EnterShape *const rules[0 VL_SHAPE_KINDS(VL_COUNT_KIND)] = {
    [VL_SHAPE_TRIANGLES] = enter_triangles,
    [VL_SHAPE_BILINEAR] = enter_bilinear,
    [VL_SHAPE_SPHERE] = enter_sphere,
    [VL_SHAPE_CURVES] = enter_curves,
};

/* pbrt's shapes that are converted to triangles. */
static const struct {
  const char *name;
  EnterShape *enter;
} meshes[] = {{"plymesh", enter_ply}, {"loopsubdiv", enter_loop}};
enum { MESHES = VL_LENGTH(meshes) };

static EnterShape *find_shape(const char *name, vlShapeKind *kind) {
  int own = vl_kind_find(&vl_shape_family, name);
  *kind = own < 0 ? VL_SHAPE_TRIANGLES : (vlShapeKind)own;
  if (own >= 0)
    return rules[own] ? rules[own] : enter_row;
  for (size_t i = 0; i < MESHES; i++)
    if (vl_text_is(meshes[i].name, name))
      return meshes[i].enter;
  return NULL;
}

static bool unknown_shape(vlImport *import, const vlStatement *s) {
  const char *names[64];
  size_t count = vl_kind_names(&vl_shape_family, names, 64 - MESHES);
  for (size_t i = 0; i < MESHES; i++)
    names[count++] = meshes[i].name;
  /* permissive: skipped */
  return vl_import_unknown(import, s->source, "shape", s->names[0], names, count);
}

/* Removes the emission of shapes that cannot emit light, with a warning. */
static void drop_emission(vlImport *import, vlSource source, bool moves, vlShapeDef *def) {
  if (!def->emission.index)
    return;
  if (import->in_object)
    vl_import_warn(import, VL_LOG_WARNING, source,
                   "area lights inside of objects give no light (as in pbrt)");
  else if (moves)
    vl_import_warn(import, VL_LOG_WARNING, source,
                   "an area light that moves (ActiveTransform) gives no light");
  else
    return;
  def->emission.index = 0;
}

bool vl_import_shape(vlImport *import, const vlStatement *s) {
  char what[96];
  snprintf(what, sizeof what, "Shape \"%s\"", vl_short_text(s->names[0]).text);
  vlDict dict = vl_import_dict(import, what, s->source, import->state.space, s->params,
                               &import->attributes[VL_ATTR_SHAPE]);
  vlShapeKind kind;
  EnterShape *function = find_shape(s->names[0], &kind);
  if (!function)
    return unknown_shape(import, s);
  vl_dict_set_kind(&dict, &vl_shape_family, (int)kind);
  vlShapeDef def = vl_default_shape_def(kind);
  vlShapeLink link = {.material = import->state.material,
                      .material_name = import->state.material_name,
                      .material_source = import->state.material_source};
  vlMat4 ctm = vl_mat4_identity();
  bool moves = vl_import_moves(import);
  def.source = s->source;
  def.group = import->object;
  def.reverse_orientation = import->state.reverse_orientation;
  if (moves && !vl_import_moving_group(import, s->source, &def.group))
    return false;
  if ((!moves && !vl_import_ctm(import, s->source, &ctm)) || !read_alpha(&dict, &def, &link))
    return false;
  memcpy(def.group_from_shape, ctm.m, sizeof def.group_from_shape);
  def.emission = import->state.emission;
  drop_emission(import, s->source, moves, &def);
  if (kind != VL_SHAPE_CURVES && !vl_import_flush_curves(import))
    return false;
  Entry e = {.dict = &dict, .def = &def, .link = &link};
  bool fine = function(&e);
  if (!e.taken)
    free_arrays(import, &def);
  return fine;
}
