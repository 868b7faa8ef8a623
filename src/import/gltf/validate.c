/* import/gltf/validate.c: for `velo scene check`: reads what the chosen scene does not use,
 * into a scene that is thrown away. Messages begin with the codes of Khronos' validator where
 * it has one. */
#include <math.h>

#include "import/gltf/gltf.h"

enum { MAX_MESSAGES = 200 };

typedef struct Check {
  vlGltf *g;
  vlScene *kept;
  uint32_t reported; /* number of messages */
  const uint8_t *used;
} Check;

/* The first error of the scene that is thrown away becomes a message, and the next object is
 * read. */
static void flush(Check *c) {
  vlError *e = &c->g->scene->error;
  if (e->code != VL_OK && e->code != VL_ERROR_MEMORY && ++c->reported <= MAX_MESSAGES)
    vl_log(c->g->context, VL_LOG_ERROR, e, "no scene uses it, but: %s", e->message);
  if (e->code == VL_ERROR_MEMORY)
    vl_scene_fail_memory(c->kept);
  vl_error_clear(e);
}

/* ---- accessors --------------------------------------------------------------------------- */

static void check_bounds(Check *check, size_t index, const float *values, size_t count,
                         uint32_t components) {
  static const char *const keys[2] = {"min", "max"}, *const codes[2] = {
                                                         "ACCESSOR_MIN_MISMATCH",
                                                         "ACCESSOR_MAX_MISMATCH"};
  const vlGltf *g = check->g;
  const vlGltfLocation *at = VL_GLTF_ROOT(g, "accessors", index);
  for (int k = 0; k < 2; k++) {
    const json_t *given = json_object_get(vl_gltf_item(g, "accessors", index), keys[k]);
    for (uint32_t c = 0; c < components && json_array_size(given) == components; c++) {
      const json_t *number = json_array_get(given, c);
      float own = k ? -INFINITY : INFINITY;
      for (size_t i = 0; i < count; i++) {
        const float v = values[i * components + c];
        own = k ? fmaxf(own, v) : fminf(own, v);
      }
      if (!json_is_number(number) || !isfinite(own) || own == (float)json_number_value(number))
        continue;
      if (++check->reported <= MAX_MESSAGES)
        vl_gltf_warn(VL_LOG_WARNING, VL_GLTF_ITEM(at, keys[k], c),
                     "%s: %.9g is given, the data has %.9g", codes[k],
                     json_number_value(number), (double)own);
    }
  }
}

static void check_accessor(Check *c, size_t index) {
  vlGltf *g = c->g;
  const vlGltfAccessor *a = vl_gltf_accessor(g, index);
  if (!a || a->type != VL_GLTF_FLOAT || a->matrix || !a->count)
    return;
  size_t count;
  const uint64_t spent = g->spent;
  float *values =
      vl_gltf_load_floats(VL_GLTF_ROOT(g, "accessors", index), index, a->components, 0, &count);
  if (values)
    check_bounds(c, index, values, count, a->components);
  vl_free(g->context, values);
  g->spent = spent;
}

/* ---- what nothing uses ------------------------------------------------------------------- */

static void report_unused(Check *c, const char *array, size_t index) {
  if (++c->reported <= MAX_MESSAGES)
    vl_gltf_warn(VL_LOG_WARNING, VL_GLTF_ITEM(&c->g->top, array, index),
                 "UNUSED_OBJECT: the scene does not use it");
}

enum { HAS_NODE = 1, HAS_REACHED_NODE = 2, HAS_MATERIAL = 4 };

/* Bits for each mesh and, in the same array, for each material. */
static void mark_used(const vlGltf *g, uint8_t *used) {
  for (size_t i = 0; i < g->node_count; i++) {
    const size_t mesh = vl_gltf_mesh_of(g, &g->nodes[i]);
    if (mesh != VL_GLTF_NONE)
      used[mesh] |= g->nodes[i].reached ? HAS_NODE | HAS_REACHED_NODE : HAS_NODE;
  }
  for (size_t i = 0; i < g->material_count; i++) {
    vlGltfMaterial *m = &g->materials[2 * (i + 1)];
    if (m[0].made || m[1].made)
      used[i] |= HAS_MATERIAL;
    m[0].made = m[1].made = false; /* their ids are those of the scene that is kept */
  }
  g->materials[0].made = g->materials[1].made = false;
}

/* A node that no scene reaches, with its mesh as its skin and morph targets deform it, and its
 * light. */
static bool read_node(vlGltf *g, size_t index) {
  const vlGltfLocation *at = VL_GLTF_ROOT(g, "nodes", index);
  const vlGltfNode *node = &g->nodes[index];
  size_t mesh;
  return vl_gltf_index(at, "mesh", g->mesh_count, &mesh) && vl_gltf_add_lights(g, index) &&
         (mesh == VL_GLTF_NONE ||
          vl_gltf_add_mesh(g, mesh, node, index, (vlGroupId){0}, vl_mat4_identity()));
}

static void read_unused(Check *c) {
  vlGltf *g = c->g;
  for (size_t i = 0; i < g->accessor_count; i++) {
    check_accessor(c, i);
    flush(c);
  }
  for (size_t i = 0; i < g->animation_count; i++) {
    vl_gltf_apply_animation(g, i);
    flush(c);
  }
  for (size_t i = 0; i < g->material_count; i++) {
    if (c->used[i] & HAS_MATERIAL)
      continue;
    report_unused(c, "materials", i);
    vl_gltf_material(g, i, false);
    flush(c);
  }
  for (size_t i = 0; i < g->mesh_count; i++) {
    if (c->used[i] & HAS_REACHED_NODE)
      continue;
    report_unused(c, "meshes", i);
    if (c->used[i] & HAS_NODE)
      continue; /* read with its node */
    vl_gltf_add_mesh(g, i, NULL, VL_GLTF_NONE, (vlGroupId){0}, vl_mat4_identity());
    flush(c);
  }
  for (size_t i = 0; i < g->node_count; i++)
    if (!g->nodes[i].reached) {
      read_node(g, i);
      flush(c);
    }
  for (size_t i = 0; i < g->camera_count; i++) {
    vl_gltf_check_camera(g, i);
    flush(c);
  }
}

void vl_gltf_validate(vlGltf *g) {
  vlScene *scratch = NULL;
  const size_t count = g->mesh_count > g->material_count ? g->mesh_count : g->material_count;
  uint8_t *used = vl_gltf_make(g, count + 1, 1);
  if (!used)
    return;
  if (vl_scene_create(g->context, &scratch) != VL_OK) {
    vl_gltf_fail_memory(g);
    return;
  }
  mark_used(g, used);
  g->moves = false;
  g->time = 0;
  Check c = {.g = g, .kept = g->scene, .used = used};
  g->scene = scratch;
  read_unused(&c);
  g->scene = c.kept;
  vl_scene_destroy(scratch);
}
