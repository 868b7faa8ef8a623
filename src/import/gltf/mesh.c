/* import/gltf/mesh.c: a mesh's primitives become shapes: attributes are read, deformed,
 * triangulated and given tangents. */
#include <string.h>

#include "base/free.h"
#include "import/far.h"
#include "import/gltf/gltf.h"
#include "velo/shape_kinds.h"

/* Reads attribute `name` as floats, `components` per vertex. VEC3 colours get alpha 1. Null
 * when the primitive lacks the attribute. */
static bool attribute(vlGltf *g, const vlGltfLocation *up, const char *name, uint32_t min,
                      uint32_t components, size_t vertices, float **out) {
  size_t index;
  const vlGltfLocation *at = VL_GLTF_KEY(up, name);
  if (!vl_gltf_index(up, name, g->accessor_count, &index))
    return false;
  if (index == VL_GLTF_NONE)
    return true;
  const vlGltfAccessor *a = vl_gltf_accessor(g, index);
  if (!a)
    return false;
  if (a->matrix || a->components < min || a->components > components)
    return vl_gltf_fail(at, "accessors[%zu] has %u components, %u are needed", index,
                        a->components, components);
  *out = vl_gltf_load_floats(at, index, components, vertices, NULL);
  return *out != NULL;
}

static bool read_attributes(vlGltf *g, const vlGltfLocation *up, size_t position, vlMesh *p) {
  static const char *const sets[4] = {"TEXCOORD_0", "TEXCOORD_1", "TEXCOORD_2", "TEXCOORD_3"};
  const vlGltfLocation *at = VL_GLTF_KEY(up, "attributes"),
                       *at_position = VL_GLTF_KEY(at, "POSITION");
  const vlGltfAccessor *a = vl_gltf_accessor(g, position);
  if (!a)
    return false;
  if (a->components != 3)
    return vl_gltf_fail(at_position, "must be of type VEC3");
  p->vertices = a->count;
  if (!attribute(g, at, "POSITION", 3, 3, p->vertices, &p->positions) ||
      !attribute(g, at, "NORMAL", 3, 3, p->vertices, &p->normals) ||
      !attribute(g, at, "TANGENT", 4, 4, p->vertices, &p->tangents) ||
      !attribute(g, at, "COLOR_0", 3, 4, p->vertices, &p->colors))
    return false;
  for (int k = 0; k < 4; k++) {
    if (!attribute(g, at, sets[k], 2, 2, p->vertices, &p->uvs[k]))
      return false;
    for (size_t i = 0; p->uvs[k] && i < p->vertices; i++)
      p->uvs[k][2 * i + 1] = 1.0f - p->uvs[k][2 * i + 1];
  }
  return true;
}

/* The indices in a new block; 0, 1, 2, ... when the primitive has none. */
static bool read_indices(vlGltf *g, const vlGltfLocation *up, size_t vertices,
                         uint32_t **indices, size_t *count) {
  size_t index;
  const vlGltfLocation *at = VL_GLTF_KEY(up, "indices");
  if (!vl_gltf_index(up, "indices", g->accessor_count, &index))
    return false;
  const vlGltfAccessor *a = index == VL_GLTF_NONE ? NULL : vl_gltf_accessor(g, index);
  if (index != VL_GLTF_NONE && !a)
    return false;
  *count = a ? a->count : vertices;
  if (a && (a->components != 1 || a->type == VL_GLTF_FLOAT || a->type == VL_GLTF_BYTE ||
            a->type == VL_GLTF_SHORT))
    return vl_gltf_fail(at, "must be SCALAR of unsigned whole numbers");
  if (!vl_gltf_spend(at, 4 * (uint64_t)*count))
    return false;
  if (!(*indices = vl_alloc_array(g->context, *count, sizeof **indices)))
    return vl_gltf_fail_memory(g);
  if (a)
    vl_gltf_read_uints(a, 1, *indices);
  else
    for (size_t i = 0; i < *count; i++)
      (*indices)[i] = (uint32_t)i;
  for (size_t i = 0; i < *count; i++)
    if ((*indices)[i] >= vertices) {
      vl_gltf_fail(at, "number %zu names vertex %u, but there are only %zu", i, (*indices)[i],
                   vertices);
      vl_free(g->context, *indices);
      *indices = NULL;
      return false;
    }
  return true;
}

/* The material of the chosen variant, or the primitive's own. */
static bool choose_material(vlGltf *g, const vlGltfLocation *at, size_t *material) {
  if (!vl_gltf_index(at, "material", g->material_count, material))
    return false;
  const vlGltfLocation *up = VL_GLTF_KEY(at, "extensions.KHR_materials_variants");
  const json_t *mappings = json_object_get(vl_gltf_json(up), "mappings");
  for (size_t i = 0; g->variant != VL_GLTF_NONE && i < json_array_size(mappings); i++) {
    const json_t *mapping = json_array_get(mappings, i),
                 *variants = json_object_get(mapping, "variants");
    for (size_t k = 0; k < json_array_size(variants); k++)
      if (json_number_value(json_array_get(variants, k)) == (double)g->variant)
        return vl_gltf_index(VL_GLTF_ITEM(up, "mappings", i), "material", g->material_count,
                             material);
  }
  return true;
}

/* ---- the shape --------------------------------------------------------------------------- */

/* Applies a singular pose to the vertices, since it cannot be a transform of the scene. */
static void bake(vlMesh *p, vlMat4 pose, vlContext *context) {
  for (size_t i = 0; i < p->vertices; i++) {
    float *v = p->positions + 3 * i;
    double w[3];
    vl_mat4_vertex(&pose, v, w);
    for (int k = 0; k < 3; k++)
      v[k] = (float)w[k];
  }
  vl_mesh_drop(
      context, p,
      VL_MESH_NORMALS | VL_MESH_TANGENTS | VL_MESH_POSITIONS_CLOSE | VL_MESH_NORMALS_CLOSE);
}

/* Moves the signs of the bitangents, the fourth numbers of tangents, to an array of their
 * own. */
static bool split_tangents(vlGltf *g, vlMesh *p, float **signs) {
  *signs = NULL;
  if (!p->tangents)
    return true;
  if (!(*signs = vl_alloc_array(g->context, p->vertices, sizeof **signs)))
    return vl_gltf_fail_memory(g);
  for (size_t i = 0; i < p->vertices; i++) {
    (*signs)[i] = p->tangents[4 * i + 3] < 0 ? -1.0f : 1.0f;
    memmove(p->tangents + 3 * i, p->tangents + 4 * i, 3 * sizeof *p->tangents);
  }
  return true;
}

/* Adds the shape; the arrays move to the scene. */
static bool add_shape(vlGltf *g, const vlGltfMaterial *m, vlMesh *p, vlGroupId group,
                      vlMat4 pose) {
  float *signs;
  if (!split_tangents(g, p, &signs))
    return false;
  vlShapeDef def = vl_default_shape_def(VL_SHAPE_TRIANGLES);
  def.source.file = g->path;
  def.group = group;
  memcpy(def.group_from_shape, pose.m, sizeof def.group_from_shape);
  def.material = m->material;
  def.alpha = m->alpha;
  def.emission = m->emission;
  def.inside = m->inside;
  def.one_sided = !m->double_sided;
  vl_mesh_to_shape(p, &def);
  def.tangents = p->tangents;
  def.tangent_signs = signs;
  def.times[1] = p->positions_close ? g->close - g->open : def.times[1];
  if (g->def->permissive)
    vl_repair_mesh(g->context, &g->repairs, &def); /* out of memory: the scene checks it */
  vlShapeId id = vl_scene_adopt_shape(g->scene, &def);
  *p = (vlMesh){0};
  g->shapes_made++;
  return id.index != 0;
}

static bool finish_primitive(vlGltf *g, const vlGltfMaterial *m, vlMesh *p, vlGroupId group,
                             vlMat4 pose, bool posed) {
  if (!vl_gltf_compact(g, p))
    return false;
  const bool flat = vl_gltf_is_flat(&pose);
  if (flat && !posed)
    bake(p, pose, g->context);
  if (flat || posed)
    pose = vl_mat4_identity();
  if (!p->normals || !m->needs_tangents)
    vl_mesh_drop(g->context, p, VL_MESH_TANGENTS);
  if (m->needs_tangents && !p->tangents && p->uvs[m->tangent_set] &&
      !vl_gltf_make_tangents(g, m->tangent_set, p))
    return false;
  return add_shape(g, m, p, group, pose);
}

static bool is_skinned(const vlGltfNode *node) {
  return node && json_object_get(node->json, "skin");
}

/* The vertices as the node deforms them. */
static bool deform(vlGltf *g, const vlGltfLocation *at, const json_t *mesh,
                   const vlGltfNode *node, vlMesh *p) {
  return vl_gltf_morph(g, at, mesh, node, p) &&
         (!is_skinned(node) || vl_gltf_skin(g, at, node, p));
}

/* The vertices as deformed at shutter close. */
static bool read_close(vlGltf *g, const vlGltfLocation *at, const json_t *mesh,
                       const vlGltfNode *node, size_t position, vlMesh *p) {
  vlMesh q = {0};
  g->closing = true;
  bool ok = read_attributes(g, at, position, &q) && deform(g, at, mesh, node, &q);
  g->closing = false;
  if (ok && memcmp(p->positions, q.positions, 3 * p->vertices * sizeof(float)) != 0) {
    p->positions_close = q.positions;
    p->normals_close = q.normals;
    q.positions = q.normals = NULL;
  }
  vl_mesh_free(g->context, &q);
  return ok;
}

/* A deforming mesh cannot emit light. An emissive mesh keeps its emission and loses its
 * deformation. */
static void still(vlGltf *g, const vlGltfLocation *at, vlMesh *p) {
  vl_mesh_drop(g->context, p, VL_MESH_POSITIONS_CLOSE | VL_MESH_NORMALS_CLOSE);
  if (vl_gltf_once(g, VL_GLTF_REPORTED_MOTION))
    vl_gltf_warn(VL_LOG_INFO, at, "gives out light, and stays as it is when the shutter opens");
}

static bool add_primitive(vlGltf *g, const vlGltfLocation *at, const json_t *mesh,
                          const vlGltfNode *node, vlGroupId group, vlMat4 pose, vlMesh *p) {
  const json_t *attributes;
  size_t position, material;
  size_t mode = 4, count = 0;
  uint32_t *indices = NULL;
  if (!vl_gltf_object(at, "attributes", &attributes) ||
      !vl_gltf_index(VL_GLTF_KEY(at, "attributes"), "POSITION", g->accessor_count, &position) ||
      !vl_gltf_size(at, "mode", &mode) || !choose_material(g, at, &material))
    return false;
  if (mode > 6)
    return vl_gltf_fail_key(at, "mode", "%zu is not from 0 to 6", mode);
  if (position == VL_GLTF_NONE) {
    vl_gltf_warn(VL_LOG_WARNING, at, "has no positions and is not drawn");
    return true;
  }
  if (!vl_gltf_unpack_primitive(g, at) || !read_attributes(g, at, position, p) ||
      !read_indices(g, at, p->vertices, &indices, &count))
    return false;
  const bool skinned = is_skinned(node);
  const bool moves = g->moves && node && mode >= 4 && (skinned || node->weights);
  if (!deform(g, at, mesh, node, p) || (moves && !read_close(g, at, mesh, node, position, p))) {
    vl_free(g->context, indices);
    return false;
  }
  if (!vl_gltf_triangles(g, at, (uint32_t)mode, indices, count, p))
    return false;
  if (p->triangles == 0)
    return true;
  const vlGltfMaterial *m = vl_gltf_material(g, material, p->colors != NULL);
  if (m && p->positions_close && m->emission.index)
    still(g, at, p);
  return m && finish_primitive(g, m, p, group, pose, skinned);
}

static void count_deformed(vlGltf *g, const json_t *primitive, bool skinned) {
  g->scene->skinned += skinned;
  g->scene->morphed += json_object_get(primitive, "targets") != NULL;
}

static bool label_last(vlGltf *g, const vlGltfLocation *at, size_t node, size_t mesh,
                       size_t i) {
  vlGltfShapeIndices at_shape = {.node = node, .mesh = mesh, .primitive = i};
  return choose_material(g, at, &at_shape.material) &&
         vl_gltf_label_shape(g, &at_shape,
                             &g->scene->shapes.items[g->scene->shapes.count - 1].label);
}

bool vl_gltf_add_mesh(vlGltf *g, size_t index, const vlGltfNode *node, size_t node_index,
                      vlGroupId group, vlMat4 pose) {
  const vlGltfLocation *at = VL_GLTF_ROOT(g, "meshes", index);
  const json_t *mesh = vl_gltf_item(g, "meshes", index), *primitives;
  size_t count;
  if (!vl_gltf_array(at, "primitives", &primitives, &count))
    return false;
  for (size_t i = 0; i < count; i++) {
    const json_t *primitive = json_array_get(primitives, i);
    const vlGltfLocation *here = VL_GLTF_ITEM(at, "primitives", i);
    if (!json_is_object(primitive))
      return vl_gltf_fail(here, "must be an object");
    vlMesh p = {0};
    const size_t before = g->scene->shapes.count;
    bool ok = add_primitive(g, here, mesh, node, group, pose, &p);
    vl_mesh_free(g->context, &p);
    if (!ok || (g->scene->shapes.count > before && !label_last(g, here, node_index, index, i)))
      return false;
    count_deformed(g, primitive, is_skinned(node));
  }
  return true;
}

/* Grows the box by one primitive's positions, in the node's space; those of a skin are in the
 * world. */
static bool primitive_box(vlGltf *g, const vlGltfLocation *at, const json_t *mesh,
                          const vlGltfNode *node, vlExtent *box) {
  size_t position;
  vlMesh p = {0};
  if (!vl_gltf_index(VL_GLTF_KEY(at, "attributes"), "POSITION", g->accessor_count, &position))
    return false;
  if (position == VL_GLTF_NONE)
    return true;
  bool ok = vl_gltf_unpack_primitive(g, at) && read_attributes(g, at, position, &p) &&
            deform(g, at, mesh, node, &p);
  if (ok)
    vl_grow_box(p.positions, p.vertices, box);
  vl_mesh_free(g->context, &p);
  return ok;
}

bool vl_gltf_mesh_box(vlGltf *g, size_t index, const vlGltfNode *node, vlExtent *box) {
  const vlGltfLocation *at = VL_GLTF_ROOT(g, "meshes", index);
  const json_t *mesh = vl_gltf_item(g, "meshes", index), *primitives;
  size_t count;
  const uint64_t spent = g->spent; /* the arrays are freed again */
  if (!vl_gltf_array(at, "primitives", &primitives, &count))
    return false;
  for (size_t i = 0; i < count; i++)
    if (!primitive_box(g, VL_GLTF_ITEM(at, "primitives", i), mesh, node, box))
      return false;
  g->spent = spent;
  return true;
}
