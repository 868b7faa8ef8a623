/* import/gltf/node.c: the node tree: poses, the choice of the scene, and the placement of
 * meshes and lights. */
#include <math.h>
#include <stdlib.h>

#include "import/gltf/gltf.h"
#include "math/double3.h"
#include "math/motion.h"
#include "velo/shape.h"

vlMat4 vl_gltf_matrix_from_trs(const double t[3], const double r[4], const double s[3]) {
  double n = sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2] + r[3] * r[3]);
  double x = r[0], y = r[1], z = r[2], w = r[3];
  if (n > 0) {
    x /= n;
    y /= n;
    z /= n;
    w /= n;
  } else {
    w = 1;
  }
  vlMat4 m = {{(1 - 2 * (y * y + z * z)) * s[0], 2 * (x * y - z * w) * s[1],
               2 * (x * z + y * w) * s[2], t[0], 2 * (x * y + z * w) * s[0],
               (1 - 2 * (x * x + z * z)) * s[1], 2 * (y * z - x * w) * s[2], t[1],
               2 * (x * z - y * w) * s[0], 2 * (y * z + x * w) * s[1],
               (1 - 2 * (x * x + y * y)) * s[2], t[2], 0, 0, 0, 1}};
  return m;
}

static bool read_node(vlGltf *g, size_t i) {
  const vlGltfLocation *at = VL_GLTF_ROOT(g, "nodes", i);
  vlGltfNode *n = &g->nodes[i];
  double columns[16];
  const json_t *children;
  size_t count;
  n->has_matrix = json_object_get(n->json, "matrix") != NULL;
  n->rotation[3] = n->scale[0] = n->scale[1] = n->scale[2] = 1;
  if (!vl_gltf_numbers(at, "translation", 3, n->translation) ||
      !vl_gltf_numbers(at, "rotation", 4, n->rotation) ||
      !vl_gltf_numbers(at, "scale", 3, n->scale) ||
      !vl_gltf_numbers(at, "matrix", 16, columns) ||
      !vl_gltf_array(at, "children", &children, &count))
    return false;
  for (int k = 0; n->has_matrix && k < 16; k++)
    n->matrix[k] = columns[4 * (k % 4) + k / 4];
  if (n->has_matrix && !vl_is_affine(n->matrix))
    return vl_gltf_fail_key(at, "matrix", "its last row must be 0 0 0 1");
  for (size_t k = 0; k < count; k++) {
    const vlGltfLocation *here = VL_GLTF_ITEM(at, "children", k);
    size_t index;
    if (!vl_gltf_element(here, json_array_get(children, k), g->node_count, "node", &index))
      return false;
    vlGltfNode *c = &g->nodes[index];
    if (c->parent != UINT32_MAX)
      return vl_gltf_fail(here, "node %zu is already a child of node %u", index, c->parent);
    c->parent = (uint32_t)i;
  }
  return true;
}

bool vl_gltf_read_nodes(vlGltf *g) {
  for (size_t i = 0; i < g->node_count; i++) {
    g->nodes[i].json = vl_gltf_item(g, "nodes", i);
    g->nodes[i].parent = UINT32_MAX;
  }
  for (size_t i = 0; i < g->node_count; i++)
    if (!read_node(g, i))
      return false;
  /* a node has at most one parent, so a walk upwards from a node of a cycle never reaches a
   * root */
  for (size_t i = 0; i < g->node_count; i++) {
    size_t steps = 0;
    for (uint32_t k = g->nodes[i].parent; k != UINT32_MAX && !g->nodes[k].reached;
         k = g->nodes[k].parent)
      if (++steps > g->node_count)
        return vl_gltf_fail(VL_GLTF_ROOT(g, "nodes", i), "is among its own children");
    for (uint32_t k = (uint32_t)i; k != UINT32_MAX && !g->nodes[k].reached;
         k = g->nodes[k].parent)
      g->nodes[k].reached = true;
  }
  for (size_t i = 0; i < g->node_count; i++)
    g->nodes[i].reached = false;
  return true;
}

static vlMat4 local_matrix(const vlGltfNode *n) {
  return n->has_matrix ? vl_mat4_load(n->matrix)
                       : vl_gltf_matrix_from_trs(n->translation, n->rotation, n->scale);
}

bool vl_gltf_pose_nodes(vlGltf *g) {
  uint32_t *chain = vl_alloc_array(g->context, g->node_count + 1, sizeof *chain);
  if (!chain)
    return vl_gltf_fail_memory(g);
  for (size_t i = 0; i < g->node_count; i++) {
    size_t n = 0;
    for (uint32_t k = (uint32_t)i; k != UINT32_MAX && !g->nodes[k].has_pose;
         k = g->nodes[k].parent)
      chain[n++] = k;
    while (n > 0) {
      vlGltfNode *node = &g->nodes[chain[--n]];
      vlMat4 local = local_matrix(node);
      node->world = node->parent == UINT32_MAX
                        ? local
                        : vl_mat4_multiply(g->nodes[node->parent].world, local);
      node->has_pose = true;
    }
  }
  vl_free(g->context, chain);
  for (size_t i = 0; i < g->node_count; i++)
    if (!vl_mat4_is_finite(g->nodes[i].world))
      return vl_gltf_fail(VL_GLTF_ROOT(g, "nodes", i),
                          "its transform to the world is not finite");
  return true;
}

size_t vl_gltf_mesh_of(const vlGltf *g, const vlGltfNode *node) {
  return vl_gltf_peek(node->json, "mesh", g->mesh_count);
}

bool vl_gltf_deforms(const vlGltf *g, const vlGltfNode *node) {
  if (json_object_get(node->json, "skin"))
    return true;
  size_t mesh = vl_gltf_mesh_of(g, node);
  const json_t *json = mesh == VL_GLTF_NONE ? NULL : vl_gltf_item(g, "meshes", mesh);
  return (node->weights || json_object_get(node->json, "weights") ||
          json_object_get(json, "weights")) &&
         json_object_get(json_array_get(json_object_get(json, "primitives"), 0), "targets");
}

/* ---- drawing ----------------------------------------------------------------------------- */

/* Poses of EXT_mesh_gpu_instancing relative to the node; null and count 0 when absent. */
static bool read_instances(vlGltf *g, const vlGltfLocation *node_at, const json_t *node,
                           vlMat4 **poses, size_t *count) {
  static const char *const names[3] = {"TRANSLATION", "ROTATION", "SCALE"};
  static const uint32_t sizes[3] = {3, 4, 3};
  *poses = NULL;
  *count = 0;
  const json_t *extension = vl_gltf_extension(node, "EXT_mesh_gpu_instancing"), *attributes;
  if (!extension)
    return true;
  const vlGltfLocation *at = VL_GLTF_KEY(node_at, "extensions.EXT_mesh_gpu_instancing");
  if (!vl_gltf_object(at, "attributes", &attributes))
    return false;
  float *values[3] = {NULL, NULL, NULL};
  bool ok = true;
  for (int k = 0; k < 3 && ok; k++) {
    size_t index;
    const vlGltfLocation *here = VL_GLTF_KEY(at, "attributes");
    ok = vl_gltf_index(here, names[k], g->accessor_count, &index);
    if (!ok || index == VL_GLTF_NONE)
      continue;
    values[k] =
        vl_gltf_load_floats(VL_GLTF_KEY(here, names[k]), index, sizes[k], *count, count);
    ok = values[k] != NULL;
  }
  if (ok && *count) {
    *poses = vl_gltf_spend(at, *count * sizeof **poses)
                 ? vl_alloc_array(g->context, *count, sizeof **poses)
                 : NULL;
    ok = *poses || vl_gltf_fail_memory(g);
  }
  for (size_t i = 0; ok && i < *count; i++) {
    double v[3][4] = {{0, 0, 0, 0}, {0, 0, 0, 1}, {1, 1, 1, 0}};
    for (int k = 0; k < 3; k++)
      for (uint32_t c = 0; values[k] && c < sizes[k]; c++)
        v[k][c] = values[k][i * sizes[k] + c];
    (*poses)[i] = vl_gltf_matrix_from_trs(v[0], v[1], v[2]);
  }
  for (int k = 0; k < 3; k++)
    vl_free(g->context, values[k]);
  if (!ok) {
    vl_free(g->context, *poses);
    *poses = NULL;
  }
  return ok;
}

static size_t instance_count(vlGltf *g, const json_t *node) {
  const json_t *attributes =
      json_object_get(vl_gltf_extension(node, "EXT_mesh_gpu_instancing"), "attributes");
  const char *key;
  json_t *value;
  size_t count = 1;
  json_object_foreach((json_t *)(uintptr_t)attributes, key, value) {
    const size_t index = vl_gltf_peek(attributes, key, g->accessor_count);
    const double n =
        json_number_value(json_object_get(vl_gltf_item(g, "accessors", index), "count"));
    if (n > (double)count)
      count = (size_t)(n < 1e9 ? n : 1e9);
  }
  return count;
}

bool vl_gltf_is_flat(const vlMat4 *m) {
  double l = 0;
  for (int i = 0; i < 12; i++)
    l += i % 4 == 3 ? 0 : m->m[i] * m->m[i];
  return !(fabs(vl_determinant3(m->m)) > 1e-12 * l * sqrt(l));
}

static bool group_mesh(vlGltf *g, size_t mesh) {
  vlGltfMesh *m = &g->meshes[mesh];
  if (m->grouped)
    return true;
  const char *name = vl_gltf_name(vl_gltf_item(g, "meshes", mesh));
  m->group = vl_scene_add_group(g->scene, name ? name : "");
  m->grouped = true;
  return vl_gltf_add_mesh(g, mesh, NULL, VL_GLTF_NONE, m->group, vl_mat4_identity());
}

/* Adds a moving instance. A deforming mesh gets a group of its own. Returns -1 when two
 * successive poses cannot be interpolated, otherwise 1 for success and 0 after an error. */
static int place_moving(vlGltf *g, size_t mesh, const vlGltfNode *node, size_t node_index,
                        vlMat4 local, bool deforms) {
  double times[VL_GLTF_KEYS], poses[16 * VL_GLTF_KEYS];
  for (int k = 0; k < VL_GLTF_KEYS; k++) {
    vlMat4 m = vl_mat4_multiply(node->keys[k], local);
    vlMotion motion;
    times[k] = (g->close - g->open) * k / (VL_GLTF_KEYS - 1);
    memcpy(poses + 16 * k, m.m, sizeof m.m);
    if (k == 0 || vl_motion_make(poses + 16 * (k - 1), poses + 16 * k, &motion))
      continue;
    if (vl_gltf_once(g, VL_GLTF_REPORTED_MOTION))
      vl_gltf_warn(
          VL_LOG_WARNING, VL_GLTF_ROOT(g, "nodes", node_index),
          "no motion leads from pose to pose: it stays as it is when the shutter opens");
    return -1;
  }
  vlGroupId group;
  if (deforms) {
    group = vl_scene_add_group(g->scene, "");
    if (!vl_gltf_add_mesh(g, mesh, node, node_index, group, vl_mat4_identity()))
      return 0;
  } else {
    if (!group_mesh(g, mesh))
      return 0;
    group = g->meshes[mesh].group;
  }
  vl_scene_add_moving_instance(g->scene, group, VL_GLTF_KEYS, times, poses,
                               (vlSource){g->path, 0, 0});
  vl_gltf_label_instance(g, node_index);
  return g->scene->error.code == VL_OK;
}

/* A mesh that several nodes place becomes a group with instances. Other meshes, and those that
 * emit light, are added to the world. */
static bool place_mesh(vlGltf *g, size_t mesh, const vlGltfNode *node, size_t node_index,
                       vlMat4 local) {
  vlMat4 pose = vl_mat4_multiply(node->world, local);
  vlGltfMesh *m = &g->meshes[mesh];
  g->scale = vl_mat4_scale_of(&pose);
  bool deforms = vl_gltf_deforms(g, node), flat = vl_gltf_is_flat(&pose);
  if (flat && vl_gltf_once(g, VL_GLTF_REPORTED_FLAT))
    vl_gltf_warn(VL_LOG_INFO, VL_GLTF_ROOT(g, "nodes", node_index), "its scale makes it flat");
  if (vl_gltf_node_moves(g, node) && !flat && !json_object_get(node->json, "skin")) {
    int done = place_moving(g, mesh, node, node_index, local, deforms);
    if (done >= 0)
      return done;
  }
  if (deforms || flat || m->emissive || m->uses < 2)
    return vl_gltf_add_mesh(g, mesh, node, node_index, (vlGroupId){0}, pose);
  if (!group_mesh(g, mesh))
    return false;
  vl_scene_add_instance(g->scene, m->group, pose.m, (vlSource){g->path, 0, 0});
  vl_gltf_label_instance(g, node_index);
  return g->scene->error.code == VL_OK;
}

static bool draw_node(vlGltf *g, size_t i) {
  const vlGltfLocation *at = VL_GLTF_ROOT(g, "nodes", i);
  const vlGltfNode *node = &g->nodes[i];
  size_t mesh;
  if (!vl_gltf_index(at, "mesh", g->mesh_count, &mesh) || !vl_gltf_add_lights(g, i))
    return false;
  if (mesh == VL_GLTF_NONE)
    return true;
  vlMat4 *poses;
  size_t count;
  if (!read_instances(g, at, node->json, &poses, &count))
    return false;
  bool ok = true;
  if (!poses)
    ok = place_mesh(g, mesh, node, i, vl_mat4_identity());
  for (g->copy = 0; ok && g->copy < count; g->copy++)
    ok = place_mesh(g, mesh, node, i, poses[g->copy]);
  g->copy = VL_GLTF_NONE;
  vl_free(g->context, poses);
  return ok;
}

/* Whether the primitive's material (the chosen variant's, too) emits light. Parse errors are
 * reported later. */
static bool emissive(vlGltf *g, const json_t *primitive) {
  const json_t *mappings =
      json_object_get(vl_gltf_extension(primitive, "KHR_materials_variants"), "mappings");
  bool any = false;
  for (int k = -1; k < (int)json_array_size(mappings); k++) {
    const json_t *mapping = k < 0 ? primitive : json_array_get(mappings, (size_t)k);
    const json_t *m = vl_gltf_item(g, "materials",
                                   vl_gltf_peek(mapping, "material", g->material_count)),
                 *factor = json_object_get(m, "emissiveFactor");
    for (size_t c = 0; c < json_array_size(factor); c++)
      any = any || json_number_value(json_array_get(factor, c)) > 0;
    any = any || vl_gltf_extension(m, "KHR_materials_unlit");
  }
  return any;
}

/* Marks the nodes that the scene reaches, in order. The stack is explicit because trees may be
 * deep. */
static bool collect(vlGltf *g, const json_t *roots, const vlGltfLocation *at, uint32_t *order,
                    size_t *count) {
  uint32_t *stack = vl_gltf_make(g, g->node_count + 1, sizeof *stack);
  *count = 0;
  for (size_t k = 0; stack && k < json_array_size(roots); k++) {
    size_t top = 0, index;
    if (!vl_gltf_element(VL_GLTF_ITEM(at, "nodes", k), json_array_get(roots, k), g->node_count,
                         "node", &index))
      return false;
    stack[top++] = (uint32_t)index;
    while (top > 0) {
      uint32_t i = stack[--top];
      if (g->nodes[i].reached)
        continue; /* a node listed twice is added once */
      g->nodes[i].reached = true;
      const json_t *visibility = vl_gltf_extension(g->nodes[i].json, "KHR_node_visibility");
      if (json_is_false(json_object_get(visibility, "visible")))
        continue; /* the node and its children are hidden */
      order[(*count)++] = i;
      const json_t *children = json_object_get(g->nodes[i].json, "children");
      for (size_t c = json_array_size(children); c-- > 0;)
        if (top <= g->node_count)
          stack[top++] = (uint32_t)json_number_value(json_array_get(children, c));
    }
  }
  return stack;
}

static bool count_uses(vlGltf *g, const uint32_t *order, size_t count) {
  for (size_t k = 0; k < count; k++) {
    size_t mesh;
    const vlGltfNode *node = &g->nodes[order[k]];
    if (!vl_gltf_index(VL_GLTF_ROOT(g, "nodes", order[k]), "mesh", g->mesh_count, &mesh))
      return false;
    if (mesh == VL_GLTF_NONE || vl_gltf_deforms(g, node))
      continue;
    size_t n = instance_count(g, node->json);
    vlGltfMesh *m = &g->meshes[mesh];
    m->uses = m->uses + n > 1000000 ? 1000000 : (uint32_t)(m->uses + n);
  }
  for (size_t i = 0; i < g->mesh_count; i++) {
    const json_t *primitives = json_object_get(vl_gltf_item(g, "meshes", i), "primitives");
    for (size_t k = 0; g->meshes[i].uses > 1 && k < json_array_size(primitives); k++)
      g->meshes[i].emissive =
          g->meshes[i].emissive || emissive(g, json_array_get(primitives, k));
    if (g->meshes[i].uses > 1000)
      g->meshes[i].emissive = false; /* its emission is visible but the mesh is not a light */
  }
  return true;
}

bool vl_gltf_draw(vlGltf *g) {
  size_t index;
  if (!vl_gltf_index(&g->top, "scene", g->scene_count, &index))
    return false;
  size_t chosen = index == VL_GLTF_NONE ? 0 : index;
  if (g->def->scene)
    chosen = vl_gltf_find(g, "scenes", g->def->scene);
  if (chosen == VL_GLTF_NONE)
    return vl_gltf_fail_choice(g, "scene", json_object_get(g->root, "scenes"), g->def->scene,
                               200);
  const vlGltfLocation *at = VL_GLTF_ROOT(g, "scenes", chosen);
  const json_t *scene = g->scene_count ? vl_gltf_item(g, "scenes", chosen) : NULL,
               *roots = NULL;
  size_t root_count = 0, count = 0;
  if (!vl_gltf_array(at, "nodes", &roots, &root_count))
    return false;
  json_t *all = NULL;
  if (!scene) { /* a file without scenes: all root nodes */
    all = json_array();
    for (size_t i = 0; i < g->node_count; i++)
      if (g->nodes[i].parent == UINT32_MAX)
        json_array_append_new(all, json_integer((json_int_t)i));
    roots = all;
  }
  uint32_t *order = vl_gltf_make(g, g->node_count + 1, sizeof *order);
  bool ok = order && collect(g, roots, at, order, &count) && count_uses(g, order, count) &&
            vl_gltf_choose_camera(g);
  if (ok)
    g->point_radius = vl_gltf_point_radius(g, order, count);
  for (size_t k = 0; ok && k < count; k++)
    ok = !vl_scene_stopped(g->scene, (double)k / (double)count) && draw_node(g, order[k]);
  ok = ok && vl_gltf_image_light(g, scene, at);
  json_decref(all);
  return ok;
}
