/* import/gltf/pose.c: node poses at one moment, or at several while the shutter is open. The
 * scene's time 0 is shutter open; times are in seconds. */
#include <math.h>
#include <string.h>

#include "import/gltf/gltf.h"

bool vl_gltf_pose_at(vlGltf *g, double time) {
  g->time = time;
  for (size_t i = 0; i < g->node_count; i++)
    g->nodes[i].has_pose = false;
  return (isnan(time) || vl_gltf_each_animation(g, vl_gltf_apply_animation)) &&
         vl_gltf_pose_nodes(g);
}

bool vl_gltf_pose(vlGltf *g) {
  g->open = g->def->time;
  g->close = g->def->time_close;
  bool both = !isnan(g->open) && !isnan(g->close);
  if (both && g->close < g->open)
    return vl_gltf_fail(&g->top, "the shutter cannot close (%g s) before it opens (%g s)",
                        g->close, g->open);
  g->moves = both && g->close > g->open && g->animation_count > 0;
  if (!g->moves)
    return vl_gltf_pose_at(g, g->open);
  if (!vl_gltf_spend(&g->top, (uint64_t)g->node_count * VL_GLTF_KEYS * sizeof *g->keys))
    return false;
  g->keys = vl_gltf_make(g, g->node_count + 1, VL_GLTF_KEYS * sizeof *g->keys);
  if (!g->keys)
    return false;
  /* the order of the times does not matter, since an animation sets the same properties at any
   * time */
  for (int k = VL_GLTF_KEYS - 1; k >= 0; k--) {
    double f = (double)k / (VL_GLTF_KEYS - 1);
    if (!vl_gltf_pose_at(g, k ? g->open + f * (g->close - g->open) : g->open))
      return false;
    for (size_t i = 0; i < g->node_count; i++) {
      vlGltfNode *n = &g->nodes[i];
      n->keys = g->keys + i * VL_GLTF_KEYS;
      n->keys[k] = n->world;
      if (k != VL_GLTF_KEYS - 1)
        continue;
      n->weights_close = n->weights;
      n->weight_close_count = n->weight_count;
      n->weights = NULL;
    }
  }
  vlCameraDef *camera = &vl_scene_defs(g->scene)->camera;
  camera->shutter_open = 0;
  camera->shutter_close = g->close - g->open;
  return true;
}

bool vl_gltf_node_moves(const vlGltf *g, const vlGltfNode *node) {
  if (!g->moves)
    return false;
  for (int k = 1; k < VL_GLTF_KEYS; k++)
    if (memcmp(&node->keys[0], &node->keys[k], sizeof(vlMat4)) != 0)
      return true;
  return false;
}
