/* export/gltf/gltf.c: a scene as glTF 2.0: JSON, buffer, meshes and the node tree. When the
 * scene's camera mirrors the image, as pbrt's cameras do, all nodes have a parent that mirrors
 * the world. The exported camera then does not mirror. */
#include <math.h>
#include <stdio.h>

#include "base/glb.h"
#include "base/text.h"
#include "export/export.h"
#include "math/transform.h"
#include "schema/schema.h"
#include "velo/shape.h"

enum {
  ARRAY = 34962,
  ELEMENTS = 34963,
  TYPE_UINT = 5125,
  TYPE_USHORT = 5123,
  TYPE_FLOAT = 5126
};

json_t *vl_gltf_array_of(const float *values, size_t count) {
  json_t *array = json_array();
  for (size_t i = 0; i < count; i++)
    json_array_append_new(array, json_real((double)values[i]));
  return array;
}

json_int_t vl_gltf_put(vlExport *x, const char *key, json_t *value) {
  json_t *array = json_object_get(x->root, key);
  if (!array) {
    array = json_array();
    json_object_set_new(x->root, key, array);
  }
  json_array_append_new(array, value);
  return (json_int_t)json_array_size(array) - 1;
}

void vl_gltf_put_node(vlExport *x, json_t *list, json_t *node) {
  json_array_append_new(list, json_integer(vl_gltf_put(x, "nodes", node)));
}

json_t *vl_gltf_child(json_t *parent, const char *key) {
  json_t *child = json_object_get(parent, key);
  if (!child)
    json_object_set_new(parent, key, child = json_object());
  return child;
}

void vl_gltf_name(json_t *object, const char *name) {
  if (name && name[0])
    json_object_set_new(object, "name", json_string(name));
}

void vl_gltf_put_extension(vlExport *x, const char *name, json_t *value) {
  json_object_set_new(vl_gltf_child(x->root, "extensions"), name, value);
  vl_gltf_use(x, name);
}

void vl_gltf_use(vlExport *x, const char *extension) {
  json_t *used = json_object_get(x->root, "extensionsUsed");
  if (!used)
    json_object_set_new(x->root, "extensionsUsed", used = json_array());
  for (size_t i = 0; i < json_array_size(used); i++)
    if (vl_text_is(json_string_value(json_array_get(used, i)), extension))
      return;
  json_array_append_new(used, json_string(extension));
}

json_int_t vl_gltf_put_view(vlExport *x, const void *data, size_t size, int target) {
  static const char zeros[4] = {0};
  vl_bytes_put(x->context, &x->buffer, zeros, (4 - x->buffer.data.count % 4) % 4);
  json_t *view = json_pack("{s:i,s:I,s:I}", "buffer", 0, "byteOffset",
                           (json_int_t)x->buffer.data.count, "byteLength", (json_int_t)size);
  if (target)
    json_object_set_new(view, "target", json_integer(target));
  vl_bytes_put(x->context, &x->buffer, data, size);
  return vl_gltf_put(x, "bufferViews", view);
}

/* ---- meshes ------------------------------------------------------------------------------ */

static json_int_t put_floats(vlExport *x, const float *values, size_t count,
                             uint32_t components, bool bounds) {
  static const char *const types[5] = {NULL, "SCALAR", "VEC2", "VEC3", "VEC4"};
  json_int_t view = vl_gltf_put_view(x, values, count * components * sizeof *values, ARRAY);
  json_t *accessor =
      json_pack("{s:I,s:i,s:I,s:s}", "bufferView", view, "componentType", TYPE_FLOAT, "count",
                (json_int_t)count, "type", types[components]);
  if (bounds) {
    float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (size_t i = 0; i < 3 * count; i++) {
      low[i % 3] = fminf(low[i % 3], values[i]);
      high[i % 3] = fmaxf(high[i % 3], values[i]);
    }
    json_object_set_new(accessor, "min", vl_gltf_array_of(low, 3));
    json_object_set_new(accessor, "max", vl_gltf_array_of(high, 3));
  }
  return vl_gltf_put(x, "accessors", accessor);
}

static json_int_t put_indices(vlExport *x, const vlExportMesh *m, bool turned) {
  size_t count = 3 * (size_t)m->faces;
  bool small = m->vertices < 65535;
  uint32_t *wide = vl_export_alloc(x, count, sizeof *wide);
  if (!wide)
    return -1;
  uint16_t *narrow = (uint16_t *)wide; /* the same block */
  const size_t corner[3] = {0, turned ? 2 : 1, turned ? 1 : 2};
  for (size_t i = 0; i < count; i++) {
    const uint32_t index = m->indices[i - i % 3 + corner[i % 3]];
    if (small)
      narrow[i] = (uint16_t)index;
    else
      wide[i] = index;
  }
  json_int_t view = vl_gltf_put_view(x, wide, count * (small ? 2 : 4), ELEMENTS);
  vl_free(x->context, wide);
  return vl_gltf_put(
      x, "accessors",
      json_pack("{s:I,s:i,s:I,s:s}", "bufferView", view, "componentType",
                small ? TYPE_USHORT : TYPE_UINT, "count", (json_int_t)count, "type", "SCALAR"));
}

/* Normalises directions, as glTF requires. Directions of nearly unit length stay unchanged;
 * zero vectors become an arbitrary unit vector. */
static void make_unit(const float *v, float sign, float *to) {
  float l = sqrtf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]),
        k = fabsf(l - 1) < 1e-4f ? sign : sign / l;
  for (int i = 0; i < 3; i++)
    to[i] = l > 1e-20f ? v[i] * k : (i == 2 ? 1.0f : 0.0f);
}

/* A new block of unit normals, reversed if `turned`, or of unit tangents with their signs. */
static float *unit_vectors(vlExport *x, const vlExportMesh *m, bool tangents, bool turned) {
  size_t per = tangents ? 4 : 3;
  float *to = vl_export_alloc(x, m->vertices, per * sizeof *to);
  if (!to)
    return NULL;
  for (size_t i = 0; i < m->vertices; i++) {
    make_unit((tangents ? m->tangents : m->normals) + 3 * i, turned && !tangents ? -1 : 1,
              to + per * i);
    if (tangents)
      to[4 * i + 3] = m->signs && m->signs[i] < 0 ? -1.0f : 1.0f;
  }
  return to;
}

static void put_attribute(vlExport *x, json_t *attributes, const char *name,
                          const float *values, const vlExportMesh *m, uint32_t components) {
  if (!values)
    return;
  json_object_set_new(attributes, name,
                      json_integer(put_floats(x, values, m->vertices, components,
                                              vl_text_is(name, "POSITION"))));
}

static bool put_vectors(vlExport *x, const vlExportMesh *m, json_t *attributes, bool turned,
                        bool tangents) {
  float *v = unit_vectors(x, m, tangents, turned);
  if (!v)
    return false;
  put_attribute(x, attributes, tangents ? "TANGENT" : "NORMAL", v, m, tangents ? 4 : 3);
  vl_free(x->context, v);
  return true;
}

static bool put_attributes(vlExport *x, const vlExportMesh *m, json_t *attributes, bool turned,
                           bool colors, bool tangents) {
  static const char *const sets[4] = {"TEXCOORD_0", "TEXCOORD_1", "TEXCOORD_2", "TEXCOORD_3"};
  put_attribute(x, attributes, "POSITION", m->positions, m, 3);
  if (m->normals && !put_vectors(x, m, attributes, turned, false))
    return false;
  if (m->normals && m->tangents && tangents && !put_vectors(x, m, attributes, turned, true))
    return false;
  for (int k = 0; k < 4; k++) {
    if (!m->uvs[k])
      break;
    float *v = vl_export_alloc(x, m->vertices, 2 * sizeof *v);
    if (!v)
      return false;
    for (size_t i = 0; i < m->vertices; i++) {
      v[2 * i] = m->uvs[k][2 * i];
      v[2 * i + 1] = 1.0f - m->uvs[k][2 * i + 1];
    }
    put_attribute(x, attributes, sets[k], v, m, 2);
    vl_free(x->context, v);
  }
  if (!m->colors || !colors)
    return true;
  float *v = vl_export_alloc(x, m->vertices, 4 * sizeof *v);
  if (!v)
    return false;
  for (size_t i = 0; i < 4 * (size_t)m->vertices; i++)
    v[i] = fminf(1, fmaxf(0, m->colors[i]));
  put_attribute(x, attributes, "COLOR_0", v, m, 4);
  vl_free(x->context, v);
  return true;
}

/* Whether the normals of vl_export_mesh must be reversed. A mirroring transform also reverses
 * the normals of spheres, disks and cylinders (velo/scene.h); transforms of glTF nodes never
 * reverse normals. */
static bool is_turned(const vlShapeDef *d) {
  bool quadric = vl_kind_row(&vl_shape_family, (int)d->kind)->traits & VL_SHAPE_TRAIT_QUADRIC;
  return d->reverse_orientation != (quadric && vl_determinant3(d->group_from_shape) < 0);
}

/* The last uv set that the material's textures or the mesh have; -1: none. */
static int last_uv_set(const json_t *material, const vlExportMesh *mesh) {
  int last = -1;
  const char *key;
  json_t *value;
  for (int k = 0; k < 4; k++)
    if (mesh->uvs[k])
      last = k;
  json_object_foreach((json_t *)(uintptr_t)material, key, value) {
    if (!json_is_object(value))
      continue;
    const size_t n = strlen(key);
    const bool texture =
        n > 7 && vl_text_is(key + n - 7, "Texture") && json_object_get(value, "index");
    const int set = texture ? (int)json_integer_value(json_object_get(value, "texCoord"))
                            : last_uv_set(value, &(vlExportMesh){0});
    if (set > last)
      last = set;
  }
  return last;
}

/* Adds the shape's mesh. *index -1: the shape is invisible. */
static bool put_mesh(vlExport *x, const vlShapeDef *d, json_int_t *index) {
  vlExportMesh mesh;
  bool colors, tangents, turned = is_turned(d);
  *index = -1;
  if (vl_export_parts_media(x, d)) {
    vl_export_lose(x, "surfaces that only part media (material interface): left out");
    return true;
  }
  if (d->displacement.texture.index)
    vl_export_lose(x, "displacement of meshes: left out");
  if (d->positions_close)
    vl_export_lose(x, "meshes that change in time: as they are at first");
  if (d->hidden_from_camera)
    vl_export_lose(x, "shapes that are hidden from the camera: seen");
  if (d->outside.index)
    vl_export_lose(x, "media outside of surfaces: left out");
  if (!vl_export_mesh(x, d, &mesh))
    return x->result == VL_OK;
  if (!mesh.faces || !mesh.vertices) {
    vl_export_free_mesh(x, &mesh);
    return true;
  }
  json_int_t material = vl_gltf_put_material(x, d, &colors, &tangents);
  const int last = last_uv_set(
      json_array_get(json_object_get(x->root, "materials"), (size_t)material), &mesh);
  json_t *attributes = json_object();
  bool fine = (last < 0 || vl_export_make_uvs(x, d, (uint32_t)last, &mesh)) &&
              put_attributes(x, &mesh, attributes, turned, colors, tangents);
  json_int_t indices = fine ? put_indices(x, &mesh, turned) : -1;
  json_t *primitive = json_pack("{s:o,s:I}", "attributes", attributes, "indices", indices);
  if (material >= 0)
    json_object_set_new(primitive, "material", json_integer(material));
  json_t *json = json_pack("{s:[o]}", "primitives", primitive);
  vl_gltf_name(json, d->label.name);
  *index = vl_gltf_put(x, "meshes", json);
  vl_export_free_mesh(x, &mesh);
  return indices >= 0;
}

/* ---- nodes ------------------------------------------------------------------------------- */

static json_t *node_of(const double m[16]) {
  json_t *node = json_object(), *matrix = json_array();
  for (int i = 0; i < 16; i++)
    json_array_append_new(matrix, json_real(m[4 * (i % 4) + i / 4]));
  if (!vl_mat4_is_identity(m))
    json_object_set(node, "matrix", matrix);
  json_decref(matrix);
  return node;
}

static bool is_sheared(const double m[16]) {
  for (int a = 0; a < 3; a++) {
    int b = (a + 1) % 3;
    double dot = 0, aa = 0, bb = 0;
    for (int i = 0; i < 3; i++) {
      dot += m[4 * i + a] * m[4 * i + b];
      aa += m[4 * i + a] * m[4 * i + a];
      bb += m[4 * i + b] * m[4 * i + b];
    }
    if (!(fabs(dot) <= 1e-6 * sqrt(aa * bb)))
      return true;
  }
  return false;
}

/* Appends the nodes of a shape's mesh to `list`: one node, or for a shape of many spheres one
 * node per sphere, whose mesh is the unit sphere. */
static void put_nodes(vlExport *x, const vlShapeDef *d, json_int_t mesh, json_t *list) {
  for (uint32_t i = 0; i < (d->centers ? d->faces : 1); i++) {
    vlMat4 m = vl_mat4_load(d->group_from_shape);
    if (d->centers) {
      const double *c = d->centers + 3 * (size_t)i, r = d->radii[i];
      m = vl_mat4_multiply(
          m, vl_mat4_multiply(vl_mat4_translate(c[0], c[1], c[2]), vl_mat4_scale(r, r, r)));
    }
    json_t *node = node_of(m.m);
    vl_gltf_name(node, d->label.name);
    json_object_set_new(node, "mesh", json_integer(mesh));
    vl_gltf_put_node(x, list, node);
  }
}

static bool put_shapes(vlExport *x, json_t *roots, json_int_t *mesh_of) {
  const vlScene *s = x->scene;
  for (size_t i = 0; i < s->shapes.count; i++) {
    const vlShapeDef *d = &s->shapes.items[i];
    mesh_of[i] = -1;
    if (vl_scene_shape_is_removed(s, i))
      continue;
    if (!put_mesh(x, d, &mesh_of[i]))
      return false;
    if (mesh_of[i] < 0 || d->group.index)
      continue;
    if (is_sheared(d->group_from_shape))
      vl_export_lose(x, "transforms that shear: in the file, but not as glTF wants it");
    put_nodes(x, d, mesh_of[i], roots);
  }
  return true;
}

/* An instance becomes a node whose children are the shapes of its group. A group of one shape
 * without a transform of its own becomes a single node. */
static bool put_instances(vlExport *x, json_t *roots, const json_int_t *mesh_of) {
  const vlScene *s = x->scene;
  VL_EACH_ITEM(const vlSceneInstance, instance, &s->instances) {
    if (instance->hidden)
      continue;
    json_t *node = node_of(instance->world_from_group), *children = json_array();
    vl_gltf_name(node, instance->label.name);
    if (instance->keys)
      vl_export_lose(x, "instances that move: as they stand at first");
    if (is_sheared(instance->world_from_group))
      vl_export_lose(x, "transforms that shear: in the file, but not as glTF wants it");
    for (size_t k = 0; k < s->shapes.count; k++) {
      const vlShapeDef *d = &s->shapes.items[k];
      if (d->group.index != instance->group.index || mesh_of[k] < 0)
        continue;
      json_t *shape = node_of(d->group_from_shape);
      if (s->groups.items[d->group.index - 1].shape_count == 1 &&
          !json_object_get(shape, "matrix") && !d->centers)
        json_object_set_new(node, "mesh", json_integer(mesh_of[k]));
      else
        put_nodes(x, d, mesh_of[k], children);
      json_decref(shape);
    }
    if (json_array_size(children))
      json_object_set(node, "children", children);
    json_decref(children);
    vl_gltf_put_node(x, roots, node);
  }
  return true;
}

static bool is_mirrored(const vlExport *x) {
  const vlCameraDef *c = &x->scene->defs.camera;
  vlCamera camera;
  if (x->scene->defs.camera_missing || vl_camera_make(c, &camera, NULL, NULL) != VL_OK)
    return false;
  return vl_determinant3(camera.world_from_camera) < 0;
}

static bool put_scene(vlExport *x) {
  json_int_t *mesh_of = vl_export_alloc(x, x->scene->shapes.count + 1, sizeof *mesh_of);
  if (!mesh_of)
    return false;
  json_t *roots = json_array(), *nodes = roots;
  bool mirror = is_mirrored(x);
  if (mirror)
    nodes = json_array();
  bool fine = put_shapes(x, nodes, mesh_of) && put_instances(x, nodes, mesh_of) &&
              vl_gltf_put_lights(x, nodes);
  if (mirror && json_array_size(nodes)) {
    json_t *root = json_pack("{s:s,s:[i,i,i],s:O}", "name", "left-handed", "scale", 1, 1, -1,
                             "children", nodes);
    vl_gltf_put_node(x, roots, root);
  }
  if (mirror)
    json_decref(nodes);
  fine = fine && vl_gltf_put_camera(x, roots, mirror);
  json_t *scene = json_object();
  if (json_array_size(roots))
    json_object_set(scene, "nodes", roots);
  json_decref(roots);
  vl_free(x->context, mesh_of);
  json_object_set_new(x->root, "scene", json_integer(0));
  fine = fine && vl_gltf_put_environment(x, scene, mirror);
  vl_gltf_put(x, "scenes", scene);
  return fine;
}

/* ---- the files --------------------------------------------------------------------------- */

static void put_little(vlExport *x, vlBytes *bytes, uint32_t v) {
  const unsigned char four[4] = {(unsigned char)v, (unsigned char)(v >> 8),
                                 (unsigned char)(v >> 16), (unsigned char)(v >> 24)};
  vl_bytes_put(x->context, bytes, four, 4);
}

/* Writes the .glb file: the JSON and the buffer as chunks, whose sizes are multiples of 4. */
static bool write_binary(vlExport *x, const char *json, size_t length) {
  const size_t size = x->buffer.data.count, padding = (4 - length % 4) % 4;
  if ((uint64_t)length + size > 0xffffff00u)
    return vl_export_fail(x, VL_ERROR_UNSUPPORTED, "more than 4 GB do not go into a .glb");
  vlBytes file = {0};
  put_little(x, &file, VL_GLB_MAGIC);
  put_little(x, &file, VL_GLB_VERSION);
  put_little(x, &file, (uint32_t)(12 + 8 + length + padding + (size ? 8 + size : 0)));
  put_little(x, &file, (uint32_t)(length + padding));
  put_little(x, &file, VL_GLB_JSON);
  vl_bytes_put(x->context, &file, json, length);
  vl_bytes_put(x->context, &file, "   ", padding);
  if (size) {
    put_little(x, &file, (uint32_t)size);
    put_little(x, &file, VL_GLB_BIN);
    vl_bytes_put(x->context, &file, x->buffer.data.items, size);
  }
  const bool fine =
      file.full ? vl_export_no_memory(x) : vl_export_main(x, file.data.items, file.data.count);
  VL_ARRAY_FREE(x->context, &file.data);
  return fine;
}

static bool write_files(vlExport *x) {
  char name[300];
  vl_bytes_put(x->context, &x->buffer, "\0\0\0", (4 - x->buffer.data.count % 4) % 4);
  const size_t size = x->buffer.data.count;
  snprintf(name, sizeof name, "%.200s.bin", x->stem);
  if (size && !x->binary && !vl_export_data(x, name, x->buffer.data.items, size))
    return false;
  if (size) {
    json_t *buffer = json_pack("{s:I}", "byteLength", (json_int_t)size);
    if (!x->binary)
      json_object_set_new(buffer, "uri", json_string(name));
    vl_gltf_put(x, "buffers", buffer);
  }
  const size_t flags = x->binary ? JSON_COMPACT : JSON_INDENT(1) | JSON_PRESERVE_ORDER;
  const size_t length = json_dumpb(x->root, NULL, 0, flags);
  char *text = length ? vl_alloc_array(x->context, length, 1) : NULL;
  bool fine;
  if (!text || x->buffer.full || json_dumpb(x->root, text, length, flags) != length)
    fine = vl_export_no_memory(x);
  else
    fine = x->binary ? write_binary(x, text, length) : vl_export_main(x, text, length);
  vl_free(x->context, text);
  return fine;
}

bool vl_export_gltf(vlExport *x) {
  x->root = json_pack("{s:{s:s,s:s}}", "asset", "version", "2.0", "generator", "velo");
  if (!x->root)
    return vl_export_no_memory(x);
  if (x->scene->copyright)
    json_object_set_new(json_object_get(x->root, "asset"), "copyright",
                        json_string(x->scene->copyright));
  vl_export_lose_choices(x);
  return put_scene(x) && write_files(x);
}
