/* import/gltf/deform.c: deformation of vertices by morph targets, then by skins. */
#include <math.h>
#include <string.h>

#include "base/free.h"
#include "base/text.h"
#include "import/gltf/gltf.h"
#include "math/double3.h"

/* ---- morph targets ----------------------------------------------------------------------- */

/* What the targets of one attribute change: the first `components` floats of each vertex, which
 * are `stride` floats apart. sign_y: of the second one. */
typedef struct Morphed {
  const char *name;
  uint32_t components, stride;
  float sign_y;
  float *out;
} Morphed;

/* out += weight * delta */
static bool add_target(vlGltf *g, const vlGltfLocation *at, const Morphed *m, float weight,
                       size_t vertices) {
  size_t index;
  if (!vl_gltf_index(at, m->name, g->accessor_count, &index))
    return false;
  if (index == VL_GLTF_NONE || !m->out || weight == 0.0f)
    return true;
  const uint32_t n = m->components;
  float *delta = vl_gltf_load_floats(VL_GLTF_KEY(at, m->name), index, n, vertices, NULL);
  if (!delta)
    return false;
  for (size_t i = 0; i < vertices; i++)
    for (uint32_t c = 0; c < n; c++)
      m->out[i * m->stride + c] += weight * (c == 1 ? m->sign_y : 1.0f) * delta[i * n + c];
  vl_free(g->context, delta);
  return true;
}

bool vl_gltf_morph(vlGltf *g, const vlGltfLocation *at, const json_t *mesh,
                   const vlGltfNode *node, vlMesh *p) {
  const Morphed rows[] = {
      {"POSITION", 3, 3, 1, p->positions}, {"NORMAL", 3, 3, 1, p->normals},
      {"TANGENT", 3, 4, 1, p->tangents},   {"TEXCOORD_0", 2, 2, -1, p->uvs[0]},
      {"TEXCOORD_1", 2, 2, -1, p->uvs[1]}, {"COLOR_0", 4, 4, 1, p->colors}};
  const json_t *targets;
  size_t count;
  if (!vl_gltf_array(at, "targets", &targets, &count) || count == 0)
    return count == 0 && !g->scene->error.code;
  const json_t *given = node ? json_object_get(node->json, "weights") : NULL;
  if (!given)
    given = json_object_get(mesh, "weights");
  for (size_t i = 0; i < count; i++) {
    float weight = 0;
    const float *animated = !node ? NULL : g->closing ? node->weights_close : node->weights;
    if (animated)
      weight =
          i < (g->closing ? node->weight_close_count : node->weight_count) ? animated[i] : 0.0f;
    else
      weight = (float)json_number_value(json_array_get(given, i));
    const json_t *target = json_array_get(targets, i);
    const vlGltfLocation *here = VL_GLTF_ITEM(at, "targets", i);
    if (!json_is_object(target))
      return vl_gltf_fail(here, "must be an object");
    if (!isfinite(weight))
      return vl_gltf_fail(here, "its weight is not finite");
    for (size_t k = 0; k < VL_LENGTH(rows); k++)
      if (!add_target(g, here, &rows[k], weight, p->vertices))
        return false;
  }
  return true;
}

/* ---- skins ------------------------------------------------------------------------------- */

static const vlMat4 *world_of(const vlGltf *g, const vlGltfNode *node) {
  return g->closing ? &node->keys[VL_GLTF_KEYS - 1] : &node->world;
}

/* Computes the matrix world_from_mesh of each joint. */
static bool joint_matrices(vlGltf *g, size_t skin, vlMat4 **matrices, size_t *count) {
  const vlGltfLocation *at = VL_GLTF_ROOT(g, "skins", skin);
  const json_t *joints;
  size_t inverse;
  *matrices = NULL;
  if (!vl_gltf_array(at, "joints", &joints, count) ||
      !vl_gltf_index(at, "inverseBindMatrices", g->accessor_count, &inverse))
    return false;
  if (*count == 0)
    return vl_gltf_fail(at, "has no joints");
  float *columns = NULL;
  size_t inverse_count = 0;
  if (inverse != VL_GLTF_NONE) {
    const vlGltfLocation *here = VL_GLTF_KEY(at, "inverseBindMatrices");
    const vlGltfAccessor *a = vl_gltf_accessor(g, inverse);
    if (!a)
      return false;
    if (a->components != 16)
      return vl_gltf_fail(here, "must be of type MAT4");
    if (!(columns = vl_gltf_load_floats(here, inverse, 16, 0, &inverse_count)))
      return false;
    if (inverse_count < *count) {
      vl_free(g->context, columns);
      return vl_gltf_fail(here, "%zu matrices for %zu joints", inverse_count, *count);
    }
  }
  vlMat4 *m = vl_alloc_array(g->context, *count, sizeof *m);
  bool ok = m || vl_gltf_fail_memory(g);
  for (size_t i = 0; ok && i < *count; i++) {
    const vlGltfLocation *here = VL_GLTF_ITEM(at, "joints", i);
    size_t index;
    ok = vl_gltf_element(here, json_array_get(joints, i), g->node_count, "node", &index);
    if (!ok)
      break;
    m[i] = *world_of(g, &g->nodes[index]);
    if (!columns)
      continue;
    vlMat4 bind;
    for (int k = 0; k < 16; k++)
      bind.m[k] = columns[16 * i + 4 * (size_t)(k % 4) + (size_t)(k / 4)];
    m[i] = vl_mat4_multiply(m[i], bind);
    if (!vl_mat4_is_finite(m[i]))
      ok = vl_gltf_fail(here, "its matrix is not finite");
  }
  vl_free(g->context, columns);
  if (!ok) {
    vl_free(g->context, m);
    m = NULL;
  }
  *matrices = m;
  return ok;
}

/* Adds weight * matrix of each joint to sums (12 numbers per vertex, row-major), as the
 * attributes JOINTS_set and WEIGHTS_set give them. *found: whether the mesh has these
 * attributes. */
static bool add_influences(vlGltf *g, const vlGltfLocation *up, const char *joints_name,
                           const char *weights_name, const vlMat4 *matrices, size_t count,
                           size_t vertices, double *sums, bool *found) {
  size_t joint_index, weight_index;
  *found = false;
  if (!vl_gltf_index(up, joints_name, g->accessor_count, &joint_index) ||
      !vl_gltf_index(up, weights_name, g->accessor_count, &weight_index))
    return false;
  if (joint_index == VL_GLTF_NONE || weight_index == VL_GLTF_NONE)
    return true;
  const vlGltfLocation *at = VL_GLTF_KEY(up, joints_name);
  const vlGltfAccessor *a = vl_gltf_accessor(g, joint_index);
  if (!a)
    return false;
  if (a->count != vertices || a->components != 4 || a->type == VL_GLTF_FLOAT)
    return vl_gltf_fail(at, "must be VEC4 of whole numbers, one for each of %zu vertices",
                        vertices);
  float *weights =
      vl_gltf_load_floats(VL_GLTF_KEY(up, weights_name), weight_index, 4, vertices, NULL);
  uint32_t *joints = weights ? vl_alloc_array(g->context, vertices, 4 * sizeof *joints) : NULL;
  bool ok = joints || (weights && vl_gltf_fail_memory(g));
  if (ok)
    vl_gltf_read_uints(a, 4, joints);
  for (size_t i = 0; ok && i < 4 * vertices; i++) {
    double w = weights[i];
    if (w == 0)
      continue;
    if (!isfinite(w)) {
      ok = vl_gltf_fail_key(up, weights_name, "a weight of vertex %zu is not finite", i / 4);
    } else if (joints[i] >= count) {
      ok = vl_gltf_fail(at, "vertex %zu names joint %u of %zu", i / 4, joints[i], count);
    } else {
      for (int k = 0; k < 12; k++)
        sums[12 * (i / 4) + (size_t)k] += w * matrices[joints[i]].m[k];
    }
  }
  VL_FREE(g->context, joints, weights);
  *found = ok;
  return ok;
}

/* Transforms directions: tangents by the matrix, normals by its cofactors (the inverse
 * transpose up to a factor). */
static void turn(const double *m, bool normal, float *v) {
  const double from[3] = {v[0], v[1], v[2]};
  double map[9], cofactors[9], shift[3], to[3];
  vl_split_map(m, map, shift);
  for (int i = 0; i < 3; i++)
    vl_cross3(map + 3 * ((i + 1) % 3), map + 3 * ((i + 2) % 3), cofactors + 3 * i);
  vl_mat3_vector(normal ? cofactors : map, from, to);
  const double length = vl_normalize3(to);
  for (int i = 0; i < 3 && length > 0; i++)
    v[i] = (float)to[i];
}

bool vl_gltf_skin(vlGltf *g, const vlGltfLocation *at, const vlGltfNode *node, vlMesh *p) {
  static const char *const joints[] = {"JOINTS_0", "JOINTS_1", "JOINTS_2", "JOINTS_3"};
  static const char *const weights[] = {"WEIGHTS_0", "WEIGHTS_1", "WEIGHTS_2", "WEIGHTS_3"};
  size_t skin;
  if (!vl_gltf_index_in(VL_GLTF_KEY(&g->top, "nodes"), node->json, "skin", g->skin_count,
                        &skin))
    return false;
  const vlGltfLocation *here = VL_GLTF_KEY(at, "attributes");
  vlMat4 *matrices;
  size_t count;
  if (!joint_matrices(g, skin == VL_GLTF_NONE ? 0 : skin, &matrices, &count))
    return false;
  double *sums = vl_alloc_zero(g->context, p->vertices, 12 * sizeof *sums);
  bool ok = sums || vl_gltf_fail_memory(g), found = true, any = false;
  for (int set = 0; set < 4 && ok && found; set++) {
    ok = add_influences(g, here, joints[set], weights[set], matrices, count, p->vertices, sums,
                        &found);
    any = any || found;
  }
  for (size_t i = 0; ok && i < p->vertices; i++) {
    double *m = sums + 12 * i;
    float *v = p->positions + 3 * i, q[3];
    double total = 0;
    for (int k = 0; k < 12; k++)
      total += fabs(m[k]);
    if (!any || total == 0)
      memcpy(m, world_of(g, node)->m, 12 * sizeof *m); /* no joint influences the vertex */
    for (int k = 0; k < 3; k++)
      q[k] =
          (float)(m[4 * k] * v[0] + m[4 * k + 1] * v[1] + m[4 * k + 2] * v[2] + m[4 * k + 3]);
    memcpy(v, q, sizeof q);
    if (p->normals)
      turn(m, true, p->normals + 3 * i);
    if (p->tangents)
      turn(m, false, p->tangents + 4 * i);
  }
  if (ok && !any && vl_gltf_once(g, VL_GLTF_REPORTED_SKIN))
    vl_gltf_warn(VL_LOG_WARNING, here, "has a skin, but neither joints nor weights");
  VL_FREE(g->context, sums, matrices);
  return ok;
}
