/* import/gltf/frame.c: the extent of a whole animation: an automatic camera frames it, so that
 * all frames agree. */
#include <math.h>

#include "import/gltf/gltf.h"

enum {
  TIMES = 33,
  MAX_VERTICES = 4000000 /* of deforming meshes, counted once for each time they are posed at */
};

/* Adds the corners of the box in world space. */
static bool add_corners(vlGltf *g, const vlExtent *b, const vlMat4 *world) {
  if (vl_extent_is_empty(b))
    return true;
  if (!VL_RESERVE(g->context, &g->scene->frame_points, 24))
    return vl_gltf_fail_memory(g);
  for (int k = 0; k < 8; k++) {
    double corner[3], p[3];
    vl_extent_corner(b, k, corner);
    vl_mat4_point(world, corner, p);
    for (int i = 0; i < 3; i++)
      g->scene->frame_points.items[g->scene->frame_points.count++] = p[i];
  }
  return true;
}

static size_t vertices_of(const vlGltf *g, size_t mesh) {
  const json_t *primitives = json_object_get(vl_gltf_item(g, "meshes", mesh), "primitives");
  double sum = 0;
  for (size_t i = 0; i < json_array_size(primitives); i++) {
    const json_t *positions = vl_gltf_peek_positions(g, json_array_get(primitives, i));
    sum += json_number_value(json_object_get(positions, "count"));
  }
  return sum > 0 && sum < 1e15 ? (size_t)sum : 0;
}

/* Number of times at which deforming meshes are posed: fewer for large ones. */
static int choose_times(const vlGltf *g) {
  size_t sum = 0;
  for (size_t i = 0; i < g->node_count; i++) {
    const size_t mesh = vl_gltf_mesh_of(g, &g->nodes[i]);
    if (!g->nodes[i].reached || mesh == VL_GLTF_NONE || !vl_gltf_deforms(g, &g->nodes[i]))
      continue;
    sum += vertices_of(g, mesh);
  }
  const size_t max = sum ? MAX_VERTICES / sum : TIMES;
  return max >= TIMES ? TIMES : max < 3 ? 3 : (int)max;
}

static bool longest(vlGltf *g, size_t animation) {
  g->time = fmax(g->time, vl_gltf_animation_end(g, animation));
  return true;
}

/* The box of a mesh that does not deform is the same at all times. */
static bool frame_node(vlGltf *g, size_t node, vlExtent *boxes, bool first) {
  const vlGltfNode *n = &g->nodes[node];
  const size_t mesh = vl_gltf_mesh_of(g, n);
  const vlMat4 identity = vl_mat4_identity();
  if (!n->reached || mesh == VL_GLTF_NONE)
    return true;
  const bool deforms = vl_gltf_deforms(g, n);
  if (first || deforms) {
    boxes[node] = vl_extent_nothing;
    if (!vl_gltf_mesh_box(g, mesh, n, &boxes[node]))
      return false;
  }
  return add_corners(g, &boxes[node], json_object_get(n->json, "skin") ? &identity : &n->world);
}

bool vl_gltf_frame_animation(vlGltf *g) {
  if (isnan(g->def->time) || g->animation_count == 0)
    return true;
  g->time = 0;
  if (!vl_gltf_each_animation(g, longest))
    return false;
  const double end = g->time;
  const int times = choose_times(g);
  vlExtent *boxes = vl_gltf_make(g, g->node_count + 1, sizeof *boxes);
  bool ok = boxes;
  for (int k = 0; ok && k < times; k++) {
    ok = vl_gltf_pose_at(g, end * k / (times - 1));
    for (size_t i = 0; ok && i < g->node_count; i++)
      ok = frame_node(g, i, boxes, k == 0);
  }
  return ok;
}
