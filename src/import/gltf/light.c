/* import/gltf/light.c: KHR_lights_punctual. The extension's units, candela and lux, match
 * velo's if radiance is in nits. */
#include <math.h>

#include "import/gltf/gltf.h"
#include "velo/light.h"

bool vl_gltf_add_light(vlGltf *g, size_t node, int64_t index) {
  const vlGltfLocation *up = VL_GLTF_KEY(NULL, "extensions.KHR_lights_punctual"),
                       *at = VL_GLTF_ITEM(up, "lights", (size_t)index);
  const json_t *json = json_array_get(g->lights, (size_t)index), *spot;
  if (!json_is_object(json))
    return vl_gltf_fail(g, at, "must be an object");
  static const char *const types[] = {"directional", "point", "spot"};
  int type = 0;
  double color[3] = {1, 1, 1}, intensity = 1, inner = 0, outer = 0.7853981633974483,
         range = INFINITY;
  if (!json_object_get(json, "type"))
    return vl_gltf_fail(g, at, "\"type\" is missing");
  if (!vl_gltf_choice(g, at, json, "type", types, 3, &type) ||
      !vl_gltf_numbers(g, at, json, "color", 3, color) ||
      !vl_gltf_number(g, at, json, "intensity", &intensity) ||
      !vl_gltf_number(g, at, json, "range", &range) ||
      !vl_gltf_object(g, at, json, "spot", &spot) ||
      !vl_gltf_number(g, VL_GLTF_KEY(at, "spot"), spot, "innerConeAngle", &inner) ||
      !vl_gltf_number(g, VL_GLTF_KEY(at, "spot"), spot, "outerConeAngle", &outer))
    return false;
  bool is_spot = type == 2, is_distant = type == 0;
  if (!(intensity >= 0))
    return vl_gltf_fail(g, VL_GLTF_KEY(at, "intensity"), "must not be negative");
  for (int i = 0; i < 3; i++)
    if (!(color[i] >= 0))
      return vl_gltf_fail(g, VL_GLTF_KEY(at, "color"), "must not be negative");
  if (is_spot && !(inner >= 0 && inner <= outer && outer > 0 && outer <= 1.5707964))
    return vl_gltf_fail(g, VL_GLTF_KEY(at, "spot"),
                        "its angles must be 0 <= inner <= outer <= pi/2");
  if (isfinite(range) && vl_gltf_once(g, VL_GLTF_REPORTED_RANGE))
    vl_gltf_warn(g, VL_LOG_INFO, at, "its range is ignored: light goes on as far as it may");
  vlLightDef def = vl_default_light_def(is_spot      ? VL_LIGHT_SPOT
                                        : is_distant ? VL_LIGHT_DISTANT
                                                     : VL_LIGHT_POINT);
  def.source.file = g->path;
  def.color = vl_spectrum_rgb((float)color[0], (float)color[1], (float)color[2]);
  def.scale = (float)intensity;
  const double *m = g->nodes[node].world.m;
  double l = sqrt(m[2] * m[2] + m[6] * m[6] + m[10] * m[10]);
  for (int i = 0; i < 3;
       i++) { /* the light points along its node's -z; the node's scale has no effect */
    def.from[i] = is_distant ? 0.0f : (float)m[4 * i + 3];
    def.to[i] = def.from[i] - (l > 0 ? (float)(m[4 * i + 2] / l) : (i == 2));
  }
  def.cone_angle = (float)outer;
  def.cone_delta = (float)(outer - inner);
  def.cone_squared = true;
  if (intensity > 0 && vl_scene_add_light(g->scene, &def).index == 0)
    return false;
  g->lights_made++;
  return true;
}
