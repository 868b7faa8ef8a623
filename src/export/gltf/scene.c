/* export/gltf/scene.c: camera and lights of a scene as glTF. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/text.h"
#include "export/export.h"
#include "math/double3.h"
#include "math/elementary.h"
#include "math/stretch.h"
#include "velo/light.h"

/* Makes axes exactly orthogonal if they are orthogonal except for rounding, since readers of
 * glTF decompose transforms. */
static void square_up(double m[16]) {
  double a[3][3];
  for (int c = 0; c < 3; c++)
    for (int i = 0; i < 3; i++)
      a[c][i] = m[4 * i + c];
  const int order[3] = {2, 1, 0};
  for (int k = 0; k < 3; k++) {
    double *v = a[order[k]];
    for (int j = 0; j < k; j++) {
      const double dot = vl_dot3(v, a[order[j]]);
      if (fabs(dot) > 1e-4)
        return;
      vl_along3(v, -dot, a[order[j]], v);
    }
    if (!(fabs(vl_dot3(v, v) - 1) < 1e-4))
      return;
    vl_normalize3(v);
  }
  for (int c = 0; c < 3; c++)
    for (int i = 0; i < 3; i++)
      m[4 * i + c] = a[c][i];
}

/* The glTF file of the camera alone, as the writer of camera files makes it. Velo's own
 * description in the extras keeps what glTF cannot hold. *tree: null if it cannot hold the
 * camera at all. */
static bool camera_tree(vlExport *x, const vlCameraRecord *record, json_t **tree) {
  static const char lost[] =
      "the camera's projection, lens or principal point: in the extras, which velo alone reads";
  vlCameraText text;
  if (!vl_export_camera(x, VL_CAMERA_DIALECT_GLTF, record, lost, &text))
    return false;
  const bool held = text.text.count > 0;
  *tree = held ? json_loadb(text.text.items, text.text.count, 0, NULL) : NULL;
  VL_ARRAY_FREE(x->context, &text.text);
  return !held || *tree || vl_export_no_memory(x);
}

bool vl_gltf_put_camera(vlExport *x, json_t *nodes, bool mirror) {
  const vlSceneDefs *defs = &x->scene->defs;
  if (defs->camera_medium.index)
    vl_export_lose(x, "the medium that the camera is in: left out");
  if (defs->camera_missing)
    return true;
  vlCameraRecord record = {.camera = defs->camera, .name = "Camera"};
  if (mirror) {
    vlCamera camera;
    vlResult r = vl_camera_make(&defs->camera, &camera, NULL, x->error);
    if (r != VL_OK) {
      x->result = r;
      return false;
    }
    record.camera.roll = 0; /* the matrix has it */
    record.camera.has_matrix = true;
    memcpy(record.camera.world_from_camera, camera.world_from_camera,
           sizeof camera.world_from_camera);
    for (int i = 8; i < 12; i++)
      record.camera.world_from_camera[i] *= -1;
  }
  if (record.camera.has_matrix)
    square_up(record.camera.world_from_camera);
  if (record.camera.own) {
    vl_export_lose(x, "the camera's own functions: a perspective camera in its place");
    record.camera.own = NULL;
    record.camera.projection = VL_PROJECTION_PERSPECTIVE;
  }
  json_t *tree;
  if (!camera_tree(x, &record, &tree))
    return false;
  json_t *camera = json_array_get(json_object_get(tree, "cameras"), 0),
         *node = json_array_get(json_object_get(tree, "nodes"), 0);
  if (camera && node) {
    json_t *copy = json_deep_copy(node);
    json_object_set_new(copy, "camera",
                        json_integer(vl_gltf_put(x, "cameras", json_deep_copy(camera))));
    vl_gltf_put_node(x, nodes, copy);
  } else {
    vl_export_lose(x, "the camera: left out");
  }
  json_decref(tree);
  return true;
}

/* Orients the node so that its -z is the light's direction. */
static json_t *light_node(const vlLightDef *d, json_int_t index) {
  vlMat4 m = vl_mat4_load(d->world_from_light);
  double from[3], to[3], z[3];
  vl_mat4_vertex(&m, d->from, from);
  vl_mat4_vertex(&m, d->to, to);
  vl_sub3(from, to, z);
  if (!(vl_normalize3(z) > 0))
    z[2] = 1;
  json_t *node =
      json_pack("{s:{s:{s:I}}}", "extensions", "KHR_lights_punctual", "light", index);
  if (d->kind != VL_LIGHT_DISTANT)
    json_object_set_new(node, "translation", json_pack("[f,f,f]", from[0], from[1], from[2]));
  if (d->kind == VL_LIGHT_POINT)
    return node;
  /* the shortest rotation from +z to z: quaternion (-z1, z0, 0, 1 + z2), normalised */
  double q[4] = {-z[1], z[0], 0, 1 + z[2]}, n = sqrt(q[0] * q[0] + q[1] * q[1] + q[3] * q[3]);
  if (n < 1e-6) {
    q[0] = n = 1;
    q[1] = q[3] = 0;
  }
  json_object_set_new(node, "rotation",
                      json_pack("[f,f,f,f]", q[0] / n, q[1] / n, 0.0, q[3] / n));
  return node;
}

/* ---- lamp files -------------------------------------------------------------------------- */

/* The contents of a light's lamp file. *owned: the block to free, or null. */
static bool lamp_file(vlExport *x, const vlLightDef *d, const char **data, size_t *size,
                      char **owned) {
  *data = d->lamp_data;
  *size = d->lamp_size;
  *owned = NULL;
  if (d->lamp_data)
    return true;
  const bool fine = vl_export_read(x, d->path, owned, size);
  *data = *owned;
  return fine;
}

/* The profile of a lamp: a buffer view, or a file beside the scene. Null after an error. */
static json_t *lamp_profile(vlExport *x, size_t number, const char *data, size_t size) {
  if (x->binary) {
    json_int_t view = vl_gltf_put_view(x, data, size, 0);
    return json_pack("{s:I,s:s}", "bufferView", view, "mimeType", "application/x-ies-lm-63");
  }
  char name[300];
  snprintf(name, sizeof name, "%.200s-lamp%zu.ies", x->stem, number);
  return vl_export_data(x, name, data, size) ? json_pack("{s:s}", "uri", name) : NULL;
}

/* Light space has -y where the node has -z, x where it has x, and -z where it has y. */
static json_t *lamp_node(const vlLightDef *d, json_int_t index, const float color[3],
                         double multiplier) {
  vlMat4 m = vl_mat4_load(d->world_from_light);
  double position[3];
  vl_mat4_vertex(&m, d->from, position);
  float matrix[16] = {[15] = 1};
  for (int i = 0; i < 3; i++) {
    matrix[i] = (float)m.m[4 * i];
    matrix[4 + i] = (float)-m.m[4 * i + 2];
    matrix[8 + i] = (float)m.m[4 * i + 1];
    matrix[12 + i] = (float)position[i];
  }
  json_t *node = json_pack("{s:{s:{s:I,s:f}}}", "extensions", "EXT_lights_ies", "light", index,
                           "multiplier", multiplier);
  json_t *own = json_object_get(json_object_get(node, "extensions"), "EXT_lights_ies");
  json_object_set_new(own, "color", vl_gltf_array_of(color, 3));
  json_object_set_new(node, "matrix", vl_gltf_array_of(matrix, 16));
  return node;
}

/* Puts a light of a lamp file. lights: the profiles of EXT_lights_ies. */
static bool put_lamp(vlExport *x, const vlLightDef *d, json_t *lights, json_t *nodes) {
  static const char sign[] = "TILT="; /* every IES file has it, and no EULUMDAT file */
  const char *data;
  char *owned;
  size_t size;
  float rgb[3];
  vl_export_light_rgb(&d->color, rgb);
  float max = fmaxf(rgb[0], fmaxf(rgb[1], rgb[2]));
  if (!(max > 0.0f))
    return true;
  if (!lamp_file(x, d, &data, &size, &owned))
    return false;
  json_t *profile = NULL;
  bool ies = memmem(data, size, sign, sizeof sign - 1) != NULL;
  if (!ies)
    vl_export_lose(x, "lamp files in EULUMDAT, which glTF has not: left out");
  else
    profile = lamp_profile(x, (size_t)(d - x->scene->lights.items) + 1, data, size);
  vl_free(x->context, owned);
  if (!profile)
    return !ies;
  if (!isnan(d->power))
    vl_export_lose(x, "the power of lamp files: that of the file is written");
  const float color[3] = {rgb[0] / max, rgb[1] / max, rgb[2] / max};
  json_t *node =
      lamp_node(d, (json_int_t)json_array_size(lights), color, (double)max * (double)d->scale);
  json_array_append_new(lights, profile);
  vl_gltf_put_node(x, nodes, node);
  return true;
}

/* Whether put_lamps writes the light. */
static bool is_lamp(const vlLightDef *d) {
  return d->kind == VL_LIGHT_GONIOMETRIC &&
         (d->lamp_data || (!d->image && vl_names_lamp(d->path)));
}

static bool put_lamps(vlExport *x, json_t *nodes) {
  json_t *lights = json_array();
  bool fine = true;
  for (size_t i = 0; fine && i < x->scene->lights.count; i++) {
    const vlLightDef *d = &x->scene->lights.items[i];
    if (is_lamp(d) && !vl_scene_light_is_removed(x->scene, i))
      fine = put_lamp(x, d, lights, nodes);
  }
  if (json_array_size(lights))
    vl_gltf_put_extension(x, "EXT_lights_ies", json_pack("{s:O}", "lights", lights));
  json_decref(lights);
  return fine;
}

/* ---- all lights -------------------------------------------------------------------------- */

bool vl_gltf_put_lights(vlExport *x, json_t *nodes) {
  /* The KHR_lights_punctual object; null when the extension has no such light. */
  static const char *const types[] = {
      [VL_LIGHT_POINT] = "point", [VL_LIGHT_SPOT] = "spot", [VL_LIGHT_DISTANT] = "directional"};
  json_t *lights = json_array();
  for (size_t i = 0; i < x->scene->lights.count; i++) {
    const vlLightDef *d = &x->scene->lights.items[i];
    float rgb[3];
    if (d->kind == VL_LIGHT_INFINITE || is_lamp(d) || vl_scene_light_is_removed(x->scene, i))
      continue; /* vl_gltf_put_environment, put_lamps */
    if (d->kind >= VL_LENGTH(types) || !types[d->kind]) {
      vl_export_lose(x, "lights of kinds that glTF has not: left out");
      continue;
    }
    vl_export_light_rgb(&d->color, rgb);
    double max = fmax(rgb[0], fmax(rgb[1], rgb[2])), intensity = max * d->scale;
    if (!(max > 0))
      continue;
    if (!isnan(d->illuminance))
      intensity *= d->illuminance;
    if (!isnan(d->power)) {
      double cone =
          2 * 3.14159265358979 * (1 - vl_precise_cos(d->cone_angle - 0.5 * d->cone_delta));
      intensity *= d->power / (d->kind == VL_LIGHT_SPOT ? cone : 4 * 3.14159265358979);
      vl_export_lose(x, "lights given by their power: an approximate intensity is written");
    }
    json_t *light = json_pack("{s:s,s:[f,f,f],s:f}", "type", types[d->kind], "color",
                              rgb[0] / max, rgb[1] / max, rgb[2] / max, "intensity", intensity);
    if (d->kind == VL_LIGHT_SPOT) {
      if (vl_stretch(d->world_from_light).is_skewed)
        vl_export_lose(x, "spots in frames that are skewed or scaled unevenly: a round cone");
      if (d->cone_delta > 0 && !d->cone_squared)
        vl_export_lose(x, "edges of spots' cones that are pbrt's: glTF's, which are darker");
      double inner = d->cone_angle - d->cone_delta, outer = fmin(d->cone_angle, 1.57079632679);
      if (outer < d->cone_angle - 1e-6) /* a float may be a little above pi / 2 */
        vl_export_lose(x, "spots wider than a half space: the half space");
      json_object_set_new(
          light, "spot",
          json_pack("{s:f,s:f}", "innerConeAngle", fmax(0, fmin(inner, outer - 1e-6)),
                    "outerConeAngle", outer));
    }
    json_array_append_new(lights, light);
    vl_gltf_put_node(x, nodes, light_node(d, (json_int_t)json_array_size(lights) - 1));
  }
  if (json_array_size(lights))
    vl_gltf_put_extension(x, "KHR_lights_punctual", json_pack("{s:O}", "lights", lights));
  json_decref(lights);
  return put_lamps(x, nodes);
}
