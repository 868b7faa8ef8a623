/* import/pbrt/mesh_run.c: merges small meshes. Some exporters write every quad as its own
 * Shape, and each Shape would take two kilobytes in scene, world and accelerator. From the
 * VL_MESH_RUN_FROM-th shape of a file on, meshes of few triangles with equal graphics state are
 * merged. Nothing is merged before that, or while diagnosing. Several runs are open at a time,
 * since exporters alternate between materials. */

#include "base/text.h"
#include "import/pbrt/builder.h"
#include "velo/shape.h"

enum { MAX_FACES = 256, MAX_OF_A_RUN = 1 << 20 };

bool vl_import_same_text(const char *a, const char *b) {
  return a == b || vl_text_is(a ? a : "", b ? b : "");
}

bool vl_import_same_link(const vlShapeLink *a, const vlShapeLink *b) {
  return a->material == b->material &&
         vl_import_same_text(a->material_name, b->material_name) &&
         vl_import_same_text(a->alpha, b->alpha);
}

static bool fits(const vlMeshRun *run, const vlShapeDef *def, const vlShapeLink *link,
                 const vlGraphicsState *state) {
  const vlShapeDef *d = &run->def;
  return run->open && d->group.index == def->group.index &&
         d->reverse_orientation == def->reverse_orientation &&
         d->alpha.value == def->alpha.value && !d->normals == !def->normals &&
         !d->uvs == !def->uvs && vl_import_same_link(&run->link, link) &&
         vl_import_same_text(run->inside, state->inside) &&
         vl_import_same_text(run->outside, state->outside) &&
         run->indices.count / 3 + def->faces < MAX_OF_A_RUN;
}

static bool all_finite(const float *v, size_t count) {
  float zero = 0;
  for (size_t i = 0; v && i < count; i++)
    zero += v[i] - v[i];
  return zero == 0.0f;
}

static void free_rows(vlImport *import, vlMeshRun *run) {
  VL_ARRAY_FREE(import->context, &run->positions);
  VL_ARRAY_FREE(import->context, &run->normals);
  VL_ARRAY_FREE(import->context, &run->uvs);
  VL_ARRAY_FREE(import->context, &run->indices);
}

static bool flush(vlImport *import, vlMeshRun *run) {
  if (!run->open)
    return true;
  run->open = false;
  vlShapeDef *d = &run->def;
  d->vertices = (uint32_t)(run->positions.count / 3);
  d->faces = (uint32_t)(run->indices.count / 3);
  d->positions = run->positions.items;
  d->indices = run->indices.items;
  d->normals = d->normals ? run->normals.items : NULL;
  d->uvs = d->uvs ? run->uvs.items : NULL;
  memset(&run->positions, 0, sizeof run->positions);
  memset(&run->normals, 0, sizeof run->normals);
  memset(&run->uvs, 0, sizeof run->uvs);
  memset(&run->indices, 0, sizeof run->indices);
  return vl_import_add_shape_between(import, d, &run->link, run->inside, run->outside);
}

bool vl_import_flush_meshes(vlImport *import) {
  for (int i = 0; i < VL_MESH_RUNS; i++)
    if (!flush(import, &import->mesh_runs[i]))
      return false;
  return true;
}

void vl_import_free_meshes(vlImport *import) {
  for (int i = 0; i < VL_MESH_RUNS; i++)
    free_rows(import, &import->mesh_runs[i]);
}

/* Transforms points as the world's builder does (world/shapes.c). False when a result
 * exceeds the range of floats. */
static bool move_points(const vlMat4 *m, const float *from, size_t count, float *to) {
  for (size_t i = 0; i < count; i++) {
    double p[3] = {from[3 * i], from[3 * i + 1], from[3 * i + 2]}, q[3];
    vl_mat4_point(m, p, q);
    for (int k = 0; k < 3; k++)
      to[3 * i + (size_t)k] = (float)q[k];
  }
  return all_finite(to, 3 * count);
}

/* Transforms normals. A transform that mirrors moves the mirroring to reverse_orientation,
 * which also flips normals. */
static void move_normals(const vlMat4 *m, const vlMat4 *inverse, bool mirrored,
                         const float *from, size_t count, float *to) {
  double scale = vl_mat4_scale_of(m);
  for (size_t i = 0; i < 3 * count; i += 3) {
    vl_mat4_vertex_normal(inverse, scale, from + i, to + i);
    for (size_t k = 0; mirrored && k < 3; k++)
      to[i + k] = -to[i + k];
  }
}

static bool open_run(vlImport *import, vlMeshRun *run, const vlShapeDef *def,
                     const vlShapeLink *link) {
  if (!flush(import, run))
    return false;
  run->def = *def;
  run->link = *link;
  vlMat4 unit = vl_mat4_identity();
  memcpy(run->def.group_from_shape, unit.m, sizeof run->def.group_from_shape);
  run->inside = import->state.inside;
  run->outside = import->state.outside;
  run->open = vl_scene_copy_source(import->scene, &run->def.source);
  return run->open;
}

bool vl_import_gather_mesh(vlImport *import, const vlShapeDef *given, const vlShapeLink *link,
                           bool *taken) {
  *taken = false;
  vlShapeDef def = *given;
  size_t n = def.vertices;
  vlMat4 m = vl_mat4_load(def.group_from_shape), inverse;
  if (import->scene->shapes.count < VL_MESH_RUN_FROM || import->scene->problem ||
      def.faces == 0 || n == 0 || def.faces > MAX_FACES || n > 3 * MAX_FACES || def.tangents ||
      def.emission.index || link->displacement || !all_finite(def.positions, 3 * n) ||
      !all_finite(def.normals, 3 * n) || !all_finite(def.uvs, 2 * n) || !vl_mat4_is_finite(m) ||
      !vl_mat4_inverse(m, &inverse))
    return true;
  bool mirrored = vl_mat4_determinant3(m) < 0;
  def.reverse_orientation = def.reverse_orientation != mirrored;
  vlMeshRun *run = NULL;
  for (int i = 0; i < VL_MESH_RUNS && !run; i++)
    if (fits(&import->mesh_runs[i], &def, link, &import->state))
      run = &import->mesh_runs[i];
  if (!run) {
    run = &import->mesh_runs[import->next_run++ % VL_MESH_RUNS];
    if (!open_run(import, run, &def, link))
      return false;
  }
  vlContext *context = import->context;
  uint32_t first = (uint32_t)(run->positions.count / 3);
  if (!VL_RESERVE(context, &run->positions, 3 * n) ||
      (def.normals && !VL_RESERVE(context, &run->normals, 3 * n)) ||
      (def.uvs && !VL_RESERVE(context, &run->uvs, 2 * n)) ||
      !VL_RESERVE(context, &run->indices, 3 * (size_t)def.faces))
    return vl_import_fail_memory(import);
  if (!move_points(&m, def.positions, n, run->positions.items + run->positions.count)) {
    run->open = run->indices.count > 0;
    return true; /* kept as its own shape; the world reports the error */
  }
  run->positions.count += 3 * n;
  if (def.normals) {
    move_normals(&m, &inverse, mirrored, def.normals, n,
                 run->normals.items + run->normals.count);
    run->normals.count += 3 * n;
  }
  if (def.uvs) {
    memcpy(run->uvs.items + run->uvs.count, def.uvs, 2 * n * sizeof(float));
    run->uvs.count += 2 * n;
  }
  for (size_t i = 0; i < 3 * (size_t)def.faces; i++)
    run->indices.items[run->indices.count++] = first + def.indices[i];
  *taken = true;
  return true;
}
