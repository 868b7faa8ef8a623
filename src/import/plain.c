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
#include "import/points.h"
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

/* Gives each triangle vertices of its own, with its colour. */
static bool color_faces(vlContext *context, vlMesh *m) {
  if (!vl_mesh_separate(context, m) || !vl_mesh_add_attributes(context, m, VL_MESH_COLORS))
    return false;
  for (size_t i = 0; i < m->vertices; i++) {
    memcpy(m->colors + 4 * i, m->face_colors + i / 3 * 3, 3 * sizeof *m->colors);
    m->colors[4 * i + 3] = 1;
  }
  return true;
}

bool vl_import_plain_fail(vlScene *scene, vlResult code, const char *path, uint32_t line,
                          const char *what, const char *word) {
  const vlSource source = {.file = path, .line = line, .column = line ? 1 : 0};
  return vl_scene_fail(scene, code, source, "%s%s%s%s", what, word ? " \"" : "",
                       word ? word : "", word ? "\"" : "");
}

bool vl_import_plain_read(vlScene *scene, const char *path, char **data, const char **at,
                          const char **end) {
  size_t size = 0;
  vlError inside = {0};
  vl_import_plain_settings(scene);
  vlResult r = vl_file_read_given(scene->context, path, true, data, &size, &inside);
  if (r != VL_OK)
    return vl_scene_fail(scene, r, (vlSource){.file = path}, "%s", inside.message);
  *at = *data;
  *end = *data + size;
  return true;
}

/* Gives the mesh faces, and vertices their colours. */
static bool finish_mesh(vlScene *scene, const char *path, vlMesh *m) {
  vlContext *context = scene->context;
  if (scene->error.code != VL_OK)
    return false;
  if (!m->vertices)
    return vl_import_plain_fail(scene, VL_ERROR_SCENE, path, 0,
                                "it has no faces and no points: there is nothing to draw",
                                NULL);
  bool ok = m->triangles || vl_import_points(context, path, m);
  if (ok && m->face_colors && !m->colors)
    ok = color_faces(context, m);
  return ok || vl_import_plain_fail(scene, VL_ERROR_MEMORY, path, 0, "out of memory", NULL);
}

vlResult vl_import_plain_mesh(vlScene *scene, const char *path, const vlLoadDef *load,
                              vlMesh *m, vlError *error) {
  vlContext *context = scene->context;
  if (!finish_mesh(scene, path, m)) {
    vl_mesh_free(context, m);
    return vl_scene_result(scene, error);
  }
  vl_free(context, m->face_colors);
  vlShapeDef def = vl_default_shape_def(VL_SHAPE_TRIANGLES);
  char name[VL_LABEL_SIZE];
  vl_label_of_file(path, name);
  def.source.file = path;
  def.label.name = name;
  vl_mesh_to_shape(m, &def);
  vl_far_place(m->origin, &def);
  def.material = add_material(scene, m->colors != NULL);
  vlRepairs repairs = {0};
  if (load && load->permissive)
    vl_repair_mesh(context, &repairs, &def); /* out of memory: the scene checks it */
  vl_repairs_report(context, &repairs, path);
  vl_scene_adopt_shape(scene, &def);
  *m = (vlMesh){0};
  return vl_scene_result(scene, error);
}

vlResult vl_import_ply(vlScene *scene, const char *path, const vlLoadDef *load,
                       vlError *error) {
  vlContext *context = scene->context;
  vl_import_plain_settings(scene);
  vlMesh mesh = {0};
  vlError inside = {0};
  const vlPlyOptions options = {
      .task = scene->task, .given = true, .broken = load && load->permissive};
  vlResult r = vl_ply_read(context, path, &options, &mesh, &inside);
  if (r == VL_OK && !vl_mesh_split_quads(context, &mesh))
    r = VL_ERROR_MEMORY;
  const vlSource source = {inside.file[0] ? inside.file : NULL, inside.line, inside.column};
  if (r != VL_OK)
    vl_scene_fail(scene, r, source, "%s",
                  r == VL_ERROR_MEMORY ? "out of memory" : inside.message);
  return vl_import_plain_mesh(scene, path, load, &mesh, error);
}
