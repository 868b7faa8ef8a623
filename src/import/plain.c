/* import/plain.c: plain geometry: loads a PLY file as a scene, with default settings and
 * material. */
#include "import/plain.h"

#include "import/far.h"

#include <string.h>

#include "base/file.h"
#include "base/free.h"
#include "import/import.h"
#include "import/labels.h"
#include "import/ply/ply.h"
#include "import/repair.h"
#include "velo/material.h"
#include "velo/shape_kinds.h"
#include "velo/texture.h"
#include "velo/tracer.h"

void vl_import_plain_settings(vlScene *scene) {
  vlSceneDefs *s = vl_scene_defs(scene);
  s->render.spp = 64;
  s->render.tracer = VL_TRACER_VOLPATH;
  s->tracer_missing = true;
  s->render.max_depth = 12; /* paths through glass need many bounces */
  s->camera_missing = true;
  s->light_missing = true;
}

/* The default material: grey or the vertex colours, with the roughness of slightly polished
 * plaster. */
static vlMaterialId add_material(vlScene *scene, bool colors) {
  vlMaterialDef def = vl_default_material_def(VL_MATERIAL_PRINCIPLED);
  def.reflectance = vl_spectrum_input(vl_spectrum_rgb(0.8f, 0.8f, 0.8f));
  if (colors) {
    vlTextureDef texture = vl_default_texture_def(VL_TEXTURE_VERTEX_COLOR, true);
    def.reflectance.texture = vl_scene_add_texture(scene, &texture);
  }
  def.principled.metallic = vl_float_input(0.0f);
  def.principled.roughness = vl_float_input(0.5f);
  return vl_scene_add_material(scene, &def);
}

static void free_mesh(vlContext *context, vlPlainMesh *m) {
  VL_FREE(context, m->positions, m->normals, m->uvs, m->colors, m->face_colors, m->indices);
  *m = (vlPlainMesh){0};
}

static float *copy_rows(vlContext *context, const float *from, uint32_t width,
                        const uint32_t *rows, size_t count) {
  float *to = vl_alloc_array(context, count, width * sizeof *to);
  for (size_t i = 0; to && i < count; i++)
    memcpy(to + i * width, from + (size_t)rows[i] * width, width * sizeof *to);
  return to;
}

/* Gives each triangle vertices of its own, with its colour. */
static bool separate_faces(vlContext *context, vlPlainMesh *m) {
  size_t count = 3 * (size_t)m->triangles;
  vlPlainMesh made = {.vertices = (uint32_t)count, .triangles = m->triangles};
  if (count > 0x7fffffff)
    return false;
  made.positions = copy_rows(context, m->positions, 3, m->indices, count);
  if (m->normals)
    made.normals = copy_rows(context, m->normals, 3, m->indices, count);
  if (m->uvs)
    made.uvs = copy_rows(context, m->uvs, 2, m->indices, count);
  made.colors = vl_alloc_array(context, count, 4 * sizeof *made.colors);
  made.indices = vl_alloc_array(context, count, sizeof *made.indices);
  bool ok = made.positions && made.colors && made.indices && (!m->normals || made.normals) &&
            (!m->uvs || made.uvs);
  for (size_t i = 0; ok && i < count; i++) {
    memcpy(made.colors + 4 * i, m->face_colors + i / 3 * 3, 3 * sizeof *made.colors);
    made.colors[4 * i + 3] = 1;
    made.indices[i] = (uint32_t)i;
  }
  if (!ok) {
    free_mesh(context, &made);
    return false;
  }
  free_mesh(context, m);
  *m = made;
  return true;
}

bool vl_import_plain_read(vlScene *scene, const char *path, char **data, const char **at,
                          const char **end) {
  size_t size = 0;
  vlError inside = {0};
  vl_import_plain_settings(scene);
  vlResult r = vl_file_read_given(scene->context, path, true, data, &size, &inside);
  if (r != VL_OK) {
    vl_scene_fail(scene, r, (vlSource){.file = path}, "%s", inside.message);
    return false;
  }
  *at = *data;
  *end = *data + size;
  return true;
}

vlResult vl_import_plain_mesh(vlScene *scene, const char *path, const vlLoadDef *load,
                              vlPlainMesh *m, vlError *error) {
  vlContext *context = scene->context;
  bool ok = true;
  if (!m->vertices) {
    free_mesh(context, m);
    vl_scene_fail(scene, VL_ERROR_SCENE, (vlSource){.file = path},
                  "it has no faces and no points: there is nothing to draw");
    return vl_scene_result(scene, error);
  }
  if (!m->triangles)
    ok = vl_import_points(context, path, m);
  if (ok && m->face_colors && !m->colors)
    ok = separate_faces(context, m);
  if (!ok) {
    free_mesh(context, m);
    vl_scene_fail(scene, VL_ERROR_MEMORY, (vlSource){.file = path}, "out of memory");
    return vl_scene_result(scene, error);
  }
  vl_free(context, m->face_colors);
  vlShapeDef def = vl_default_shape_def(VL_SHAPE_TRIANGLES);
  char name[VL_LABEL_SIZE];
  vl_label_of_file(path, name);
  def.source.file = path;
  def.label.name = name;
  def.vertices = m->vertices;
  def.faces = m->triangles;
  def.positions = m->positions;
  def.normals = m->normals;
  def.uvs = m->uvs;
  def.colors = m->colors;
  def.indices = m->indices;
  vl_far_place(m->origin, &def);
  def.material = add_material(scene, m->colors != NULL);
  vlRepairs repairs = {0};
  if (load && load->permissive)
    vl_repair_mesh(context, &repairs, &def); /* out of memory: the scene checks it */
  vl_repairs_report(context, &repairs, path);
  vl_scene_adopt_shape(scene, &def);
  *m = (vlPlainMesh){0};
  return vl_scene_result(scene, error);
}

vlResult vl_import_ply(vlScene *scene, const char *path, const vlLoadDef *load,
                       vlError *error) {
  vlContext *context = scene->context;
  vl_import_plain_settings(scene);
  vlPlyMesh mesh = {0};
  vlError inside = {0};
  vlResult r =
      vl_ply_read_given(context, scene->task, path, load && load->permissive, &mesh, &inside);
  if (r == VL_OK && !vl_ply_split_quads(context, &mesh)) {
    r = VL_ERROR_MEMORY;
    vl_ply_free(context, &mesh);
  }
  if (r != VL_OK) {
    vlSource source = {inside.file[0] ? inside.file : NULL, inside.line, inside.column};
    vl_scene_fail(scene, r, source, "%s",
                  r == VL_ERROR_MEMORY ? "out of memory" : inside.message);
    return vl_scene_result(scene, error);
  }
  vlPlainMesh plain = {.vertices = mesh.vertices,
                       .triangles = mesh.triangles,
                       .positions = mesh.positions,
                       .normals = mesh.normals,
                       .uvs = mesh.uvs,
                       .colors = mesh.colors,
                       .face_colors = mesh.face_colors,
                       .indices = mesh.triangle_indices};
  memcpy(plain.origin, mesh.origin, sizeof plain.origin);
  return vl_import_plain_mesh(scene, path, load, &plain, error);
}
