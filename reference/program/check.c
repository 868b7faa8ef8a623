/* program/check.c: the one list of what the core and more/ have; all else is refused by its name in files. */
#include <stdio.h>
#include <string.h>

#include "program.h"

/* Always false. what: "a texture with vertex colours"; it "is not part of the reference renderer". */
static bool refuse(vlError *error, vlSource source, const char *what) {
  error->code = VL_ERROR_UNSUPPORTED;
  snprintf(error->file, sizeof error->file, "%s", source.file ? source.file : "");
  error->line = source.line;
  error->column = source.column;
  snprintf(error->message, sizeof error->message, "%s is not part of the reference renderer", what);
  return false;
}

/* The same for a kind of a family ("textures"), named as in files. */
static bool refuse_kind(vlError *error, vlSource source, const char *family, uint32_t kind) {
  const vlKindFamily *rows = vl_kind_family_find(family);
  const char *name = rows && kind < rows->kind_count ? rows->rows[kind]->name : NULL;
  char what[200];
  snprintf(what, sizeof what, "%s \"%s\"", rows ? rows->thing : family, name ? name : "of this kind");
  return refuse(error, source, what);
}

static bool check_shape(const vlScene *scene, const vlShapeDef *def, vlError *error) {
  if (def->centers) return refuse(error, def->source, "many spheres as one shape");
  if (def->positions_close) return refuse(error, def->source, "a moving mesh");
  if (def->displacement.texture.index) return refuse(error, def->source, "a displaced mesh");
  if (def->tangents && def->group.index) return refuse(error, def->source, "a mesh with tangents in a group");
  const vlMaterialDef *m = vl_scene_material(scene, def->material);
  if (m && m->kind == VL_MATERIAL_PRINCIPLED && m->principled.normal.index && !def->tangent_signs)
    return refuse(error, def->source, "a principled material's normal map over a mesh without tangents");
  if (def->one_sided) return refuse(error, def->source, "a mesh with one side");
  return true;
}

static bool check_principled(const vlMaterialDef *def, vlError *error) {
  const vlPrincipledDef *d = &def->principled;
  bool clear = d->transmission.texture.index || d->transmission.value > 0;
  if (d->iridescence.texture.index || d->iridescence.value > 0) return refuse(error, def->source, "a thin film");
  if (d->anisotropy_rotation.texture.index || d->anisotropy_rotation.value != 0)
    return refuse(error, def->source, "a turned anisotropy");
  bool coat = d->clearcoat.texture.index || d->clearcoat.value > 0;
  if (coat && (d->normal.index || d->clearcoat_normal.index))
    return refuse(error, def->source, "a clear coat with another normal than what is under it");
  return !clear || d->thin_walled || refuse(error, def->source, "a principled solid that transmits light");
}

static bool check_material(const vlMaterialDef *def, vlError *error) {
  bool coated = def->kind == VL_MATERIAL_COATED_DIFFUSE;
  if (coated && def->conserve_energy) return refuse(error, def->source, "a coat that conserves energy");
  if (def->kind == VL_MATERIAL_PRINCIPLED) return check_principled(def, error);
  bool missing = def->kind == VL_MATERIAL_MEASURED || def->kind == VL_MATERIAL_SUBSURFACE;
  return !missing || refuse_kind(error, def->source, "materials", (uint32_t)def->kind);
}

/* An octahedral map of the sky is square. Files may name the colours that their numbers mean. */
static bool check_image(vlContext *context, const char *path, const vlImage *given, bool square, vlSource source,
                        vlError *error) {
  vlImage *file = NULL;
  vlAttribute primaries;
  if (path && vl_image_read_header(context, path, &file, error) != VL_OK) return false;
  const vlImage *image = file ? file : given;
  bool fits = !square || !image || vl_image_width(image) == vl_image_height(image);
  bool names = file && vl_image_find_attribute(file, "chromaticities", &primaries) == VL_OK;
  vl_image_destroy(file);
  if (!fits) return refuse(error, source, "an image of the sky that is not square");
  bool srgb = !names || fabs(primaries.numbers[0] - 0.64) < 1e-3; /* x of red */
  return srgb || refuse(error, source, "an image in another colour space than sRGB");
}

static bool check_texture(vlContext *context, const vlTextureDef *def, vlError *error) {
  if (def->uv_set) return refuse(error, def->source, "a texture over a second uv set");
  if (def->colors) return refuse(error, def->source, "a texture with vertex colours");
  if (def->wrap == VL_WRAP_OCTAHEDRAL) return refuse(error, def->source, "a texture that wraps as an octahedron");
  if (def->kind == VL_TEXTURE_VERTEX_COLOR) return refuse_kind(error, def->source, "textures", (uint32_t)def->kind);
  return check_image(context, def->path, NULL, false, def->source, error);
}

static bool check_light(vlContext *context, const vlLightDef *def, bool rgb, vlError *error) {
  bool lamp = def->lamp_data || (def->path && (strstr(def->path, ".ies") || strstr(def->path, ".ldt")));
  if (def->kind == VL_LIGHT_GONIOMETRIC && lamp) return refuse(error, def->source, "a lamp file");
  if (rgb && def->image && def->space != VL_SPACE_SRGB) return refuse(error, def->source, "this colour space in RGB");
  return check_image(context, def->path, def->image, def->kind == VL_LIGHT_INFINITE, def->source, error);
}

static bool check_emission(vlContext *context, const vlEmissionDef *def, const vlShapeDef *shape, vlError *error) {
  bool by_power = def->power > 0 && (shape->kind != VL_SHAPE_TRIANGLES || def->texture.index || def->image);
  if (by_power) return refuse(error, def->source, "this emission by power");
  return check_image(context, def->image, NULL, false, def->source, error);
}

static bool check_medium(const vlMediumDef *def, bool rgb, vlError *error) {
  bool colored = def->kind == VL_MEDIUM_RGB_GRID;
  if (rgb && colored && def->space != VL_SPACE_SRGB) return refuse(error, def->source, "this colour space in RGB");
  if (def->rgb_absorption) return refuse(error, def->source, "absorption by RGB channel");
  if (def->temperature || def->rgb_emission) return refuse(error, def->source, "this emission of a medium");
  return def->kind <= VL_MEDIUM_CLOUD || refuse_kind(error, def->source, "media", (uint32_t)def->kind);
}

static bool check_camera(const vlCamera *c, vlSource source, vlError *error) {
  const vlLens *l = &c->lens;
  bool missing = c->projection == VL_PROJECTION_EQUAL_AREA || c->projection == VL_PROJECTION_CUBE ||
                 c->projection == VL_PROJECTION_OPTICS;
  bool lens = c->lens_radius > 0 && (c->projection == VL_PROJECTION_SINE || c->projection == VL_PROJECTION_FOV);
  bool planes = c->near_plane > 0 || isfinite(c->far_plane);
  if (missing || lens || (planes && c->projection > VL_PROJECTION_EQUISOLID))
    return refuse(error, source, "this projection");
  if (l->blades || l->aperture || l->ratio != 1 || l->tilt[0] != 0 || l->tilt[1] != 0 || l->vignetting ||
      l->hinge[0] != 0 || l->hinge[1] != 0 || c->eye_circle != 0)
    return refuse(error, source, "this lens");
  return true;
}

static bool check_settings(const vlSceneDefs *defs, vlError *error) {
  const vlFilmDef *film = &defs->film;
  vlTracer tracer = defs->render.tracer;
  bool crop = film->crop[2] > film->crop[0] &&
              (film->crop[0] || film->crop[1] || film->crop[2] < film->width || film->crop[3] < film->height);
  if (tracer == VL_TRACER_RAYCAST || tracer == VL_TRACER_AMBIENT_OCCLUSION || tracer == VL_TRACER_RANDOM_WALK)
    return refuse_kind(error, (vlSource){0}, "tracers", (uint32_t)tracer);
  if (defs->build.regularize) return refuse(error, (vlSource){0}, "regularize");
  if (crop) return refuse(error, (vlSource){0}, "a crop window");
  if (film->white_balance != 0 || film->sensor) return refuse(error, (vlSource){0}, "a film with a sensor");
  if (film->filter.kind > VL_PIXEL_FILTER_GAUSSIAN)
    return refuse_kind(error, (vlSource){0}, "filters", (uint32_t)film->filter.kind);
  return true;
}

bool check_scene(vlContext *context, vlScene *scene, const vlCamera *camera, vlError *error) {
  const vlSceneDefs *defs = vl_scene_defs(scene);
  bool rgb = defs->build.color == VL_COLOR_RGB;
  if (!check_settings(defs, error) || !check_camera(camera, defs->camera_source, error)) return false;
  const vlShapeDef *shape;
  for (uint32_t i = 1; (shape = vl_scene_shape(scene, (vlShapeId){i})); i++) {
    const vlEmissionDef *emission = vl_scene_emission(scene, shape->emission);
    if (!check_shape(scene, shape, error) || (emission && !check_emission(context, emission, shape, error)))
      return false;
  }
  const vlTextureDef *texture;
  for (uint32_t i = 1; (texture = vl_scene_texture(scene, (vlTextureId){i})); i++)
    if (!check_texture(context, texture, error)) return false;
  const vlMaterialDef *material;
  for (uint32_t i = 1; (material = vl_scene_material(scene, (vlMaterialId){i})); i++)
    if (!check_material(material, error)) return false;
  const vlLightDef *lamp;
  for (uint32_t i = 1; (lamp = vl_scene_light(scene, (vlLightId){i})); i++)
    if (!check_light(context, lamp, rgb, error)) return false;
  const vlMediumDef *medium;
  for (uint32_t i = 1; (medium = vl_scene_medium(scene, (vlMediumId){i})); i++)
    if (defs->render.tracer != VL_TRACER_PATH && !check_medium(medium, rgb, error)) return false;
  return true;
}
