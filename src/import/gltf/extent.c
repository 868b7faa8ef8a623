/* import/gltf/extent.c: how large everything that is drawn is together, from the bounds that accessors of positions
 * have. */
#include <math.h>

#include "import/gltf/gltf.h"

static bool bounds(const json_t *accessor, double low[3], double high[3]) {
  const json_t *min = json_object_get(accessor, "min"), *max = json_object_get(accessor, "max");
  for (size_t i = 0; i < 3; i++) {
    const json_t *a = json_array_get(min, i), *b = json_array_get(max, i);
    if (!json_is_number(a) || !json_is_number(b)) return false;
    low[i] = json_number_value(a), high[i] = json_number_value(b);
    if (!(fabs(low[i]) < 1e30) || !(fabs(high[i]) < 1e30)) return false;
  }
  return true;
}

static void grow(const vlMat4 *world, const double low[3], const double high[3], double box[6]) {
  for (int k = 0; k < 8; k++) {
    double p[3] = {k & 1 ? low[0] : high[0], k & 2 ? low[1] : high[1], k & 4 ? low[2] : high[2]}, q[3];
    vl_mat4_point(world, p, q);
    for (int i = 0; i < 3; i++) box[i] = fmin(box[i], q[i]), box[3 + i] = fmax(box[3 + i], q[i]);
  }
}

double vl_gltf_diagonal(const vlGltf *g, const uint32_t *order, size_t count) {
  double box[6] = {INFINITY, INFINITY, INFINITY, -INFINITY, -INFINITY, -INFINITY}, sum = 0;
  for (size_t k = 0; k < count; k++) {
    const vlGltfNode *node = &g->nodes[order[k]];
    const json_t *mesh = json_array_get(json_object_get(g->root, "meshes"),
                                        (size_t)fmax(0, json_is_integer(json_object_get(node->json, "mesh"))
                                                            ? json_number_value(json_object_get(node->json, "mesh"))
                                                            : 1e15));
    const json_t *primitives = json_object_get(mesh, "primitives");
    for (size_t i = 0; i < json_array_size(primitives); i++) {
      const json_t *position =
          json_object_get(json_object_get(json_array_get(primitives, i), "attributes"), "POSITION");
      double index = json_is_integer(position) ? json_number_value(position) : -1, low[3], high[3];
      if (!(index >= 0 && index < (double)g->accessor_count)) continue;
      if (bounds(json_array_get(json_object_get(g->root, "accessors"), (size_t)index), low, high))
        grow(&node->world, low, high, box);
    }
  }
  for (int i = 0; i < 3; i++) sum += (box[3 + i] - box[i]) * (box[3 + i] - box[i]);
  return box[0] <= box[3] && isfinite(sum) ? sqrt(sum) : 0;
}
