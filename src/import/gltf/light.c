/* import/gltf/light.c: KHR_lights_punctual and EXT_lights_ies. The units, candela and lux,
 * match velo's if radiance is in nits. */
#include <math.h>

#include "base/text.h"
#include "import/gltf/gltf.h"
#include "math/double3.h"
#include "velo/light.h"

#define PUNCTUAL "extensions.KHR_lights_punctual"
#define LAMPS "extensions.EXT_lights_ies"

/* A light's colour and factor must not be negative. */
static bool check_light(const vlGltfLocation *at, const char *factor_key, double factor,
                        const double color[3]) {
  const char *key = NULL;
  for (int i = 0; i < 3; i++)
    if (!(color[i] >= 0))
      key = "color";
  if (!(factor >= 0))
    key = factor_key;
  return !key || vl_gltf_fail_key(at, key, "must not be negative");
}

static bool add_light(vlGltf *g, size_t node, size_t index) {
  const vlGltfLocation *up = VL_GLTF_KEY(&g->top, PUNCTUAL),
                       *at = VL_GLTF_ITEM(up, "lights", index);
  const json_t *json = json_array_get(g->lights, index), *spot;
  if (!json_is_object(json))
    return vl_gltf_fail(at, "must be an object");
  static const char *const types[] = {"directional", "point", "spot"};
  int type = 0;
  double color[3] = {1, 1, 1}, intensity = 1, inner = 0, outer = 0.7853981633974483,
         range = INFINITY;
  if (!json_object_get(json, "type"))
    return vl_gltf_fail(at, "\"type\" is missing");
  if (!vl_gltf_choice(at, "type", types, 3, &type) || !vl_gltf_numbers(at, "color", 3, color) ||
      !vl_gltf_number(at, "intensity", &intensity) || !vl_gltf_number(at, "range", &range) ||
      !vl_gltf_object(at, "spot", &spot) ||
      !vl_gltf_number(VL_GLTF_KEY(at, "spot"), "innerConeAngle", &inner) ||
      !vl_gltf_number(VL_GLTF_KEY(at, "spot"), "outerConeAngle", &outer))
    return false;
  bool is_spot = type == 2, is_distant = type == 0;
  if (!check_light(at, "intensity", intensity, color))
    return false;
  if (is_spot && !(inner >= 0 && inner <= outer && outer > 0 && outer <= 1.5707964))
    return vl_gltf_fail_key(at, "spot", "its angles must be 0 <= inner <= outer <= pi/2");
  if (isfinite(range) && vl_gltf_once(g, VL_GLTF_REPORTED_RANGE))
    vl_gltf_warn(VL_LOG_INFO, at, "its range is ignored: light goes on as far as it may");
  vlLightDef def = vl_default_light_def(is_spot      ? VL_LIGHT_SPOT
                                        : is_distant ? VL_LIGHT_DISTANT
                                                     : VL_LIGHT_POINT);
  def.source.file = g->path;
  def.color = vl_spectrum_rgb((float)color[0], (float)color[1], (float)color[2]);
  def.scale = (float)intensity;
  const double *m = g->nodes[node].world.m;
  double l = sqrt(vl_dot_columns(m, 2, 2));
  /* the light points along its node's -z; the node's scale has no effect */
  for (int i = 0; i < 3; i++) {
    def.from[i] = is_distant ? 0.0f : (float)m[4 * i + 3];
    def.to[i] = def.from[i] - (l > 0 ? (float)(m[4 * i + 2] / l) : (i == 2));
  }
  def.cone_angle = (float)outer;
  def.cone_delta = (float)(outer - inner);
  def.cone_squared = true;
  return !(intensity > 0) || vl_scene_add_light(g->scene, &def).index != 0;
}

/* ---- lamp files -------------------------------------------------------------------------- */

/* Lamp files are external or embedded. A node's lamp aims along the node's -z; C 0 is its x, C
 * 90 its y. */

/* The contents of the light profile: from a file, a data: uri or a buffer view. */
static bool read_profile(vlGltf *g, const vlGltfLocation *at, vlLightDef *def) {
  const char *uri = NULL, *path = NULL;
  const uint8_t *data = NULL;
  size_t view = VL_GLTF_NONE;
  if (!vl_gltf_text(at, "uri", &uri) || !vl_gltf_index(at, "bufferView", g->view_count, &view))
    return false;
  if (!uri && view == VL_GLTF_NONE)
    return vl_gltf_fail(at, "has neither \"uri\" nor \"bufferView\"");
  if (!uri) {
    const vlGltfView *v = vl_gltf_view(g, at, view);
    def->lamp_data = v ? v->data : NULL;
    def->lamp_size = v ? v->size : 0;
    return v != NULL;
  }
  if (!vl_gltf_uri(g, VL_GLTF_KEY(at, "uri"), uri, &data, &def->lamp_size, &path))
    return false;
  def->lamp_data = data;
  def->path = vl_names_lamp(path) ? path : NULL;
  if (def->lamp_data || def->path)
    return true;
  return vl_gltf_fail_key(at, "uri", "\"%s\" does not end with .ies", vl_short_text(uri).text);
}

/* world_from_light: light space has -y where the node has -z, x where it has x, and -z where it
 * has y. */
static void set_pose(const vlMat4 *world, vlLightDef *def) {
  for (int i = 0; i < 3; i++) {
    const double *row = world->m + 4 * i;
    def->world_from_light[4 * i] = row[0];
    def->world_from_light[4 * i + 1] = row[2];
    def->world_from_light[4 * i + 2] = -row[1];
    def->world_from_light[4 * i + 3] = row[3];
  }
}

static bool add_lamp(vlGltf *g, size_t node) {
  const vlGltfLocation *at = VL_GLTF_KEY(VL_GLTF_ROOT(g, "nodes", node), LAMPS);
  size_t index = VL_GLTF_NONE;
  double color[3] = {1, 1, 1}, multiplier = 1;
  if (!vl_gltf_index(at, "light", g->lamp_count, &index) ||
      !vl_gltf_numbers(at, "color", 3, color) || !vl_gltf_number(at, "multiplier", &multiplier))
    return false;
  if (index == VL_GLTF_NONE)
    return true;
  if (!check_light(at, "multiplier", multiplier, color))
    return false;
  const vlGltfLocation *profile = VL_GLTF_ITEM(VL_GLTF_KEY(&g->top, LAMPS), "lights", index);
  const json_t *json = json_array_get(g->lamps, index);
  if (!json_is_object(json))
    return vl_gltf_fail(profile, "must be an object");
  vlLightDef def = vl_default_light_def(VL_LIGHT_GONIOMETRIC);
  def.source.file = g->path;
  def.color = vl_spectrum_rgb((float)fmin(color[0], 1), (float)fmin(color[1], 1),
                              (float)fmin(color[2], 1));
  def.scale = (float)multiplier;
  if (!read_profile(g, profile, &def))
    return false;
  set_pose(&g->nodes[node].world, &def);
  return !(multiplier > 0) || vl_scene_add_light(g->scene, &def).index != 0;
}

bool vl_gltf_add_lights(vlGltf *g, size_t node) {
  const vlGltfLocation *at = VL_GLTF_KEY(VL_GLTF_ROOT(g, "nodes", node), PUNCTUAL);
  size_t light;
  return vl_gltf_index(at, "light", g->light_count, &light) &&
         (light == VL_GLTF_NONE || add_light(g, node, light)) && add_lamp(g, node);
}
