/* import/gltf/extent.c: the size of points and lines, from the file's camera or from the extent
 * of everything that is drawn. The bounds are those that accessors of positions have. */
#include <math.h>

#include "import/gltf/gltf.h"
#include "math/elementary.h"

/* Rows of the image for which the size is chosen. */
enum { POINT_ROWS = 720 };

static bool bounds(const json_t *accessor, double low[3], double high[3]) {
  const json_t *min = json_object_get(accessor, "min"), *max = json_object_get(accessor, "max");
  for (size_t i = 0; i < 3; i++) {
    const json_t *a = json_array_get(min, i), *b = json_array_get(max, i);
    if (!json_is_number(a) || !json_is_number(b))
      return false;
    low[i] = json_number_value(a);
    high[i] = json_number_value(b);
    if (!(fabs(low[i]) < 1e30) || !(fabs(high[i]) < 1e30))
      return false;
  }
  return true;
}

static void grow(const vlMat4 *world, const double low[3], const double high[3],
                 double box[6]) {
  for (int k = 0; k < 8; k++) {
    double p[3] = {k & 1 ? low[0] : high[0], k & 2 ? low[1] : high[1],
                   k & 4 ? low[2] : high[2]},
           q[3];
    vl_mat4_point(world, p, q);
    for (int i = 0; i < 3; i++) {
      box[i] = fmin(box[i], q[i]);
      box[3 + i] = fmax(box[3 + i], q[i]);
    }
  }
}

/* Height of an image row, in the world, at the centre of the box, for the file's camera. 0: the
 * file has none. */
static double row_height(const vlGltf *g, const double box[6], double diagonal) {
  const vlSceneDefs *s = vl_scene_defs(g->scene);
  const vlCameraDef *c = &s->camera;
  if (s->camera_missing)
    return 0;
  if (c->projection == VL_PROJECTION_ORTHOGRAPHIC)
    return (c->screen_max_y - c->screen_min_y) / POINT_ROWS;
  double distance2 = 0;
  for (int i = 0; i < 3; i++) {
    double d = 0.5 * (box[i] + box[3 + i]) - c->world_from_camera[4 * i + 3];
    distance2 += d * d;
  }
  /* A camera inside sees most things at a distance of this order. */
  double distance = fmax(sqrt(distance2), 0.25 * diagonal);
  return 2 * distance * vl_precise_tan(0.5 * c->fov) / POINT_ROWS;
}

double vl_gltf_point_radius(const vlGltf *g, const uint32_t *order, size_t count) {
  double box[6] = {INFINITY, INFINITY, INFINITY, -INFINITY, -INFINITY, -INFINITY}, sum = 0;
  for (size_t k = 0; k < count; k++) {
    const vlGltfNode *node = &g->nodes[order[k]];
    const json_t *mesh = vl_gltf_item(g, "meshes", vl_gltf_mesh_of(g, node));
    const json_t *primitives = json_object_get(mesh, "primitives");
    for (size_t i = 0; i < json_array_size(primitives); i++) {
      double low[3], high[3];
      if (bounds(vl_gltf_peek_positions(g, json_array_get(primitives, i)), low, high))
        grow(&node->world, low, high, box);
    }
  }
  for (int i = 0; i < 3; i++)
    sum += (box[3 + i] - box[i]) * (box[3 + i] - box[i]);
  if (!(box[0] <= box[3]) || !isfinite(sum))
    return 0;
  double row = row_height(g, box, sqrt(sum));
  return row > 0 ? row : 0.0015 * sqrt(sum);
}
