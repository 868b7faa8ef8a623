/* import/gltf/label.c: names of nodes, meshes and materials become labels of shapes, instances
 * and materials. A mesh placed by one node is called by the node, else by the mesh; equal names
 * get those of their parents: Hall/Chair. */
#include <stdio.h>

#include "base/text.h"
#include "import/gltf/gltf.h"
#include "import/labels.h"

enum { MAX_PARENTS = 8, CHAIN = 64 };

static const char *name_of(const json_t *json) {
  const char *name = vl_gltf_name(json);
  return name && *name ? name : NULL;
}

/* Number of named parents. */
static uint32_t find_parents(const vlGltf *g, size_t node, uint32_t parents[CHAIN]) {
  uint32_t n = 0;
  for (uint32_t k = g->nodes[node].parent; k != UINT32_MAX && n < CHAIN; k = g->nodes[k].parent)
    if (name_of(g->nodes[k].json))
      parents[n++] = k;
  return n;
}

/* The node's name, after those of its `depth` nearest named parents. */
static void node_path(const vlGltf *g, size_t node, uint32_t depth, char path[VL_LABEL_SIZE]) {
  uint32_t parents[CHAIN], n = find_parents(g, node, parents);
  char number[40];
  path[0] = 0;
  for (uint32_t k = depth < n ? depth : n; k-- > 0;)
    vl_label_append(path, name_of(g->nodes[parents[k]].json));
  const char *name = name_of(g->nodes[node].json);
  const size_t mesh = vl_gltf_mesh_of(g, &g->nodes[node]);
  if (!name && mesh != VL_GLTF_NONE)
    name = name_of(vl_gltf_item(g, "meshes", mesh));
  if (!name)
    snprintf(number, sizeof number, "nodes[%zu]", node);
  vl_label_append(path, name ? name : number);
}

/* Makes the paths of the nodes in `list` and counts how often each occurs. */
static bool count_paths(vlGltf *g, const uint32_t *list, size_t count, const uint8_t *depths,
                        char **paths, vlNameTable *table) {
  char path[VL_LABEL_SIZE];
  for (size_t i = 0; i < count; i++) {
    uint32_t before = 0;
    node_path(g, list[i], depths[i], path);
    vl_free(g->context, paths[i]);
    if (!(paths[i] = vl_alloc(g->context, strlen(path) + 1)))
      return false;
    memcpy(paths[i], path, strlen(path) + 1);
    vl_names_find(table, path, &before);
    if (!vl_names_add(g->context, table, paths[i], before + 1))
      return false;
  }
  return true;
}

/* Where a path occurs twice, takes one more parent. False when nothing changes. */
static bool deepen(const vlGltf *g, const uint32_t *list, size_t count, uint8_t *depths,
                   char **paths, const vlNameTable *table) {
  bool changed = false;
  for (size_t i = 0; i < count; i++) {
    uint32_t times = 0, parents[CHAIN];
    vl_names_find(table, paths[i], &times);
    if (times < 2 || depths[i] >= MAX_PARENTS || depths[i] >= find_parents(g, list[i], parents))
      continue;
    depths[i]++;
    changed = true;
  }
  return changed;
}

static bool label_list(vlGltf *g, const uint32_t *list, size_t count, uint8_t *depths,
                       char **paths) {
  bool ok = true, changed = true;
  for (int round = 0; ok && changed && round <= MAX_PARENTS; round++) {
    vlNameTable table = {0};
    ok = count_paths(g, list, count, depths, paths, &table);
    changed = ok && deepen(g, list, count, depths, paths, &table);
    vl_free(g->context, table.slots);
  }
  vlNameTable table = {0};
  if (!ok)
    vl_gltf_fail_memory(g);
  for (size_t i = 0; ok && i < count; i++)
    ok = vl_label_make_unique(g->scene, &table, paths[i], list[i], &g->node_labels[list[i]]);
  vl_free(g->context, table.slots);
  return ok;
}

static bool label_nodes(vlGltf *g) {
  size_t count = 0;
  uint32_t *list = vl_gltf_make(g, g->node_count + 1, sizeof *list);
  uint8_t *depths = list ? vl_gltf_make(g, g->node_count + 1, 1) : NULL;
  char **paths = depths ? vl_gltf_make(g, g->node_count + 1, sizeof *paths) : NULL;
  if (!paths)
    return false;
  for (size_t i = 0; i < g->node_count; i++)
    if (vl_gltf_mesh_of(g, &g->nodes[i]) != VL_GLTF_NONE)
      list[count++] = (uint32_t)i;
  const bool ok = label_list(g, list, count, depths, paths);
  for (size_t i = 0; i < count; i++)
    vl_free(g->context, paths[i]);
  return ok;
}

bool vl_gltf_make_labels(vlGltf *g) {
  g->node_labels = vl_gltf_make(g, g->node_count + 1, sizeof *g->node_labels);
  g->material_labels = vl_gltf_make(g, g->material_count + 1, sizeof *g->material_labels);
  if (!g->node_labels || !g->material_labels)
    return false;
  for (size_t i = 0; i < g->material_count; i++) {
    char name[VL_LABEL_SIZE] = "";
    vl_label_append(name, name_of(vl_gltf_item(g, "materials", i)));
    if (!*name)
      snprintf(name, sizeof name, "materials[%zu]", i);
    if (!vl_label_make_unique(g->scene, &g->material_names, name, i, &g->material_labels[i]))
      return false;
  }
  return label_nodes(g);
}

/* nodes[3], or nodes[3].copies[7] where EXT_mesh_gpu_instancing places the node several
 * times. */
static int print_node(const vlGltf *g, size_t node, char *text, size_t size) {
  return g->copy == VL_GLTF_NONE
             ? snprintf(text, size, "nodes[%zu]", node)
             : snprintf(text, size, "nodes[%zu].copies[%zu]", node, g->copy);
}

static void append_copy(const vlGltf *g, char name[VL_LABEL_SIZE]) {
  char number[24];
  snprintf(number, sizeof number, "%zu", g->copy);
  if (g->copy != VL_GLTF_NONE)
    vl_label_append(name, number);
}

void vl_gltf_label_instance(vlGltf *g, size_t node) {
  char name[VL_LABEL_SIZE] = "", path[VL_LABEL_SIZE], location[80];
  vlLabel label = {.path = path, .place = location};
  snprintf(name, sizeof name, "%s", g->node_labels[node]);
  node_path(g, node, CHAIN, path);
  append_copy(g, name);
  append_copy(g, path);
  print_node(g, node, location, sizeof location);
  if (vl_label_make_unique(g->scene, &g->instance_names, name, node, &label.name))
    vl_scene_label_instance(g->scene, &label);
}

/* Whether the material of primitive `index` tells it from the mesh's other primitives. */
static bool material_tells(const json_t *primitives, size_t index) {
  const double own =
      json_number_value(json_object_get(json_array_get(primitives, index), "material"));
  for (size_t i = 0; i < json_array_size(primitives) && i < 100; i++) {
    const json_t *other = json_object_get(json_array_get(primitives, i), "material");
    if (i != index && other && json_number_value(other) == own)
      return false;
  }
  return index < 100;
}

bool vl_gltf_label_shape(vlGltf *g, const vlGltfShapeIndices *at, vlLabel *label) {
  char name[VL_LABEL_SIZE] = "", path[VL_LABEL_SIZE] = "", location[160], number[40];
  const char *mesh = name_of(vl_gltf_item(g, "meshes", at->mesh));
  const char *material =
      at->material == VL_GLTF_NONE ? NULL : name_of(vl_gltf_item(g, "materials", at->material));
  size_t n = 0;
  snprintf(number, sizeof number, "meshes[%zu]", at->mesh);
  if (at->node == VL_GLTF_NONE) {
    vl_label_append(name, mesh ? mesh : number);
  } else {
    snprintf(name, sizeof name, "%s", g->node_labels[at->node]);
    node_path(g, at->node, CHAIN, path);
    append_copy(g, name);
    append_copy(g, path);
    n = (size_t)print_node(g, at->node, location, sizeof location);
    location[n++] = '.';
  }
  if (mesh && !vl_text_is(path + vl_folder_length(path), mesh))
    vl_label_append(path, mesh);
  vl_label_append(path, material);
  snprintf(location + n, sizeof location - n, "meshes[%zu].primitives[%zu]", at->mesh,
           at->primitive);
  const json_t *primitives = json_object_get(vl_gltf_item(g, "meshes", at->mesh), "primitives");
  snprintf(number, sizeof number, "%zu", at->primitive);
  if (json_array_size(primitives) > 1)
    vl_label_append(name,
                    material && material_tells(primitives, at->primitive) ? material : number);
  *label = (vlLabel){.path = path, .place = location};
  return vl_label_make_unique(g->scene, &g->shape_names, name,
                              at->node == VL_GLTF_NONE ? at->mesh : at->node, &label->name) &&
         vl_scene_copy_string(g->scene, &label->path) &&
         vl_scene_copy_string(g->scene, &label->place);
}
