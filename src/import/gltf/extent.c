/* import/gltf/extent.c: the size of points and lines, from the file's camera or from the extent
 * of everything that is drawn. The bounds are those that accessors of positions have. */
#include <math.h>

#include "import/gltf/gltf.h"
#include "math/double3.h"
#include "math/elementary.h"
#include "scene/extent.h"

/* Rows of the image for which the size is chosen. */
enum { POINT_ROWS = 720 };

static bool bounds(const json_t *accessor, vlExtent *box) {
  const json_t *min = json_object_get(accessor, "min"), *max = json_object_get(accessor, "max");
  for (size_t i = 0; i < 3; i++) {
    const json_t *a = json_array_get(min, i), *b = json_array_get(max, i);
    if (!json_is_number(a) || !json_is_number(b))
      return false;
    box->low[i] = json_number_value(a);
    box->high[i] = json_number_value(b);
    if (!(fabs(box->low[i]) < 1e30) || !(fabs(box->high[i]) < 1e30))
      return false;
  }
  return true;
}

/* Height of an image row, in the world, at the centre of the box, for the file's camera. 0: the
 * file has none. */
static double row_height(const vlGltf *g, const vlExtent *box) {
  const vlSceneDefs *s = vl_scene_defs(g->scene);
  const vlCameraDef *c = &s->camera;
  if (s->camera_missing)
    return 0;
  if (c->projection == VL_PROJECTION_ORTHOGRAPHIC)
    return (c->screen_max_y - c->screen_min_y) / POINT_ROWS;
  double away[3];
  vl_extent_middle(box, away);
  for (int i = 0; i < 3; i++)
    away[i] -= c->world_from_camera[4 * i + 3];
  /* A camera inside sees most things at a distance of this order. */
  double distance = fmax(vl_norm3(away), 0.25 * vl_extent_diagonal(box));
  return 2 * distance * vl_precise_tan(0.5 * c->fov) / POINT_ROWS;
}

double vl_gltf_point_radius(const vlGltf *g, const uint32_t *order, size_t count) {
  vlExtent box = vl_extent_nothing;
  for (size_t k = 0; k < count; k++) {
    const vlGltfNode *node = &g->nodes[order[k]];
    const json_t *mesh = vl_gltf_item(g, "meshes", vl_gltf_mesh_of(g, node));
    const json_t *primitives = json_object_get(mesh, "primitives");
    for (size_t i = 0; i < json_array_size(primitives); i++) {
      vlExtent own;
      if (bounds(vl_gltf_peek_positions(g, json_array_get(primitives, i)), &own))
        vl_extent_visit_box(&node->world, &own, vl_extent_grow, &box);
    }
  }
  const double diagonal = vl_extent_diagonal(&box);
  if (!isfinite(diagonal) || vl_extent_is_empty(&box))
    return 0;
  const double row = row_height(g, &box);
  return row > 0 ? row : 0.0015 * diagonal;
}
