/* import/gltf/camera.c: the choice of the scene's camera, and its parameters (specification,
 * 3.10). */
#include <math.h>
#include <stdlib.h>

#include "base/text.h"
#include "import/gltf/gltf.h"

enum { HEIGHT = 720, SIDE = 1280 }; /* default image size: glTF has no resolution */

static void set_size(vlGltf *g, double aspect) {
  vlSceneDefs *s = vl_scene_defs(g->scene);
  double width = SIDE, height = SIDE / aspect;
  if (height > HEIGHT) {
    height = HEIGHT;
    width = HEIGHT * aspect;
  }
  s->film.width = width >= 1 ? (uint32_t)(width + 0.5) : 1;
  s->film.height = height >= 1 ? (uint32_t)(height + 0.5) : 1;
  const uint32_t whole[4] = {0, 0, s->film.width, s->film.height};
  memcpy(s->film.crop, whole, sizeof whole);
}

static bool take_planes(const vlGltfLocation *at, vlCameraDef *def) {
  double near_plane = 0, far_plane = INFINITY;
  if (!vl_gltf_number(at, "znear", &near_plane) || !vl_gltf_number(at, "zfar", &far_plane))
    return false;
  def->near_plane = near_plane > 0 ? near_plane : 0;
  def->far_plane = far_plane > def->near_plane ? far_plane : INFINITY;
  return true;
}

static bool take_perspective(vlGltf *g, const vlGltfLocation *at, vlCameraDef *def) {
  double yfov = 0, aspect = 16.0 / 9.0;
  if (!vl_gltf_number(at, "yfov", &yfov) || !vl_gltf_number(at, "aspectRatio", &aspect) ||
      !take_planes(at, def))
    return false;
  if (!(yfov > 0 && yfov < 3.1415926))
    return vl_gltf_fail_key(at, "yfov", "must lie between 0 and pi");
  if (aspect == 0)
    aspect = 16.0 / 9.0; /* not valid, but Assimp writes it where it knows none */
  if (!(aspect > 1e-3 && aspect < 1e3))
    return vl_gltf_fail_key(at, "aspectRatio", "%g is no shape", aspect);
  set_size(g, aspect);
  def->fov = yfov;
  def->fov_axis = VL_FOV_VERTICAL;
  return true;
}

static bool take_orthographic(vlGltf *g, const vlGltfLocation *at, vlCameraDef *def) {
  double x = 0, y = 0;
  if (!vl_gltf_number(at, "xmag", &x) || !vl_gltf_number(at, "ymag", &y) ||
      !take_planes(at, def))
    return false;
  x = fabs(x);
  y = fabs(y); /* some exporters write negative values */
  if (!(x > 0 && y > 0 && x / y > 1e-3 && x / y < 1e3))
    return vl_gltf_fail(at, "needs xmag and ymag above 0");
  set_size(g, x / y);
  def->projection = VL_PROJECTION_ORTHOGRAPHIC;
  def->screen_min_x = -x;
  def->screen_max_x = x;
  def->screen_min_y = -y;
  def->screen_max_y = y;
  return true;
}

/* A glTF camera has y up and looks along -z. The position and orientation of the node are used;
 * its scale is ignored. */
static void set_pose(const vlMat4 *world, double m[16]) {
  memcpy(m, world->m, 16 * sizeof *m);
  for (int column = 0; column < 3; column++) {
    double l = 0;
    for (int row = 0; row < 3; row++)
      l += m[4 * row + column] * m[4 * row + column];
    l = (column ? -1 : 1) / (l > 0 ? sqrt(l) : 1);
    for (int row = 0; row < 3; row++)
      m[4 * row + column] *= l;
  }
}

static bool take_camera(vlGltf *g, size_t camera, const vlGltfNode *node) {
  const vlGltfLocation *at = VL_GLTF_ROOT(g, "cameras", camera);
  const json_t *json = vl_gltf_item(g, "cameras", camera), *lens;
  static const char *const types[] = {"perspective", "orthographic"};
  int flat = 0;
  if (!json_object_get(json, "type"))
    return vl_gltf_fail(at, "\"type\" is missing");
  if (!vl_gltf_choice(at, "type", types, 2, &flat))
    return false;
  const char *type = types[flat];
  if (!vl_gltf_object(at, type, &lens))
    return false;
  if (!lens)
    return vl_gltf_fail(at, "\"%s\" is missing", type);
  vlCameraDef def = vl_default_camera_def(1, 1);
  if (!(flat ? take_orthographic(g, VL_GLTF_KEY(at, type), &def)
             : take_perspective(g, VL_GLTF_KEY(at, type), &def)))
    return false;
  def.has_matrix = true;
  set_pose(&node->world, def.world_from_camera);
  if (g->moves) {
    def.shutter_open = 0;
    def.shutter_close = g->close - g->open;
  }
  def.has_matrix_close = vl_gltf_node_moves(g, node);
  if (def.has_matrix_close)
    set_pose(&node->keys[VL_GLTF_KEYS - 1], def.world_from_camera_close);
  if (!(fabs(vl_determinant3(def.world_from_camera)) > 1e-9))
    return vl_gltf_fail(at, "its node's transform is singular");
  vlSceneDefs *s = vl_scene_defs(g->scene);
  def.width = s->film.width;
  def.height = s->film.height;
  s->camera = def;
  s->camera_source.file = NULL;
  s->camera_missing = false;
  g->scene->camera_read = true;
  g->scene->camera_in_full = json_object_get(json_object_get(json, "extras"), "velo") != NULL;
  return true;
}

bool vl_gltf_check_camera(vlGltf *g, size_t index) {
  const vlGltfNode node = {.world = vl_mat4_identity()};
  return take_camera(g, index, &node);
}

bool vl_gltf_next_camera(vlGltf *g, size_t *node, size_t *camera) {
  for (; *node < g->node_count; ++*node) {
    if (!g->nodes[*node].reached)
      continue;
    if (!vl_gltf_index(VL_GLTF_ROOT(g, "nodes", *node), "camera", g->camera_count, camera))
      return false;
    if (*camera != VL_GLTF_NONE)
      return true;
  }
  return true;
}

bool vl_gltf_choose_camera(vlGltf *g) {
  const char *wanted = g->def->camera;
  char *end = NULL;
  unsigned long number = wanted ? strtoul(wanted, &end, 10) : 0;
  bool numbered = wanted && end != wanted && !*end;
  size_t by_name = VL_GLTF_NONE, by_number = VL_GLTF_NONE;
  size_t camera;
  for (size_t i = 0;; i++) {
    if (!vl_gltf_next_camera(g, &i, &camera))
      return false;
    if (i == g->node_count)
      break;
    const vlGltfNode *node = &g->nodes[i];
    bool named =
        wanted && (vl_text_is(vl_gltf_name(node->json), wanted) ||
                   vl_text_is(vl_gltf_name(vl_gltf_item(g, "cameras", camera)), wanted));
    if (named && by_name == VL_GLTF_NONE)
      by_name = i;
    if ((numbered || !wanted) && g->cameras_seen == number)
      by_number = i;
    g->cameras_seen++;
  }
  size_t chosen = by_name != VL_GLTF_NONE ? by_name : by_number;
  if (chosen == VL_GLTF_NONE && wanted) {
    char names[200] = "";
    for (size_t i = 0; i < g->node_count; i++) {
      const char *own = vl_gltf_name(g->nodes[i].json);
      if (!g->nodes[i].reached || !json_object_get(g->nodes[i].json, "camera") || !own)
        continue;
      vl_list_name(names, sizeof names, vl_short_text(own).text);
    }
    return vl_gltf_fail(&g->top, "the scene has no camera \"%s\" (%zu are there%s)",
                        vl_argument_text(wanted).text, g->cameras_seen, names);
  }
  if (chosen == VL_GLTF_NONE)
    return true;
  const vlGltfNode *node = &g->nodes[chosen];
  return take_camera(g, (size_t)json_number_value(json_object_get(node->json, "camera")), node);
}
