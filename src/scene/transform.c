/* scene/transform.c: moves, turns and scales all that a scene describes (velo/edit.h). Numbers
 * that are lengths, or that depend on them, change by powers of the scale; docs/verify.md lists
 * them. */
#include <math.h>
#include <string.h>

#include "base/unset.h"
#include "math/double3.h"
#include "math/transform.h"
#include "scene/scene.h"
#include "schema/schema.h"
#include "velo/edit.h"
#include "velo/light.h"
#include "velo/material.h"
#include "velo/medium.h"
#include "velo/shape.h"
#include "velo/texture.h"

/* A similarity: p' = scale * turn(p) + shift. */
typedef struct Similarity {
  vlMat4 matrix;  /* all of it */
  vlMat4 inverse; /* of matrix */
  vlMat4 turn;    /* the rotation alone */
  double scale;
} Similarity;

/* Takes the matrix apart. False: it is not a rotation, a uniform scale and a shift. */
static bool take_apart(const double m[16], Similarity *s) {
  s->matrix = vl_mat4_load(m);
  if (!vl_mat4_is_finite(s->matrix) || !vl_is_affine(m))
    return false;
  s->scale = sqrt(vl_dot_columns(m, 0, 0));
  if (!(vl_determinant3(s->matrix.m) > 0) || !vl_mat4_inverse(s->matrix, &s->inverse))
    return false;
  s->turn = vl_mat4_identity();
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      s->turn.m[4 * i + j] = m[4 * i + j] / s->scale;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      if (fabs(vl_dot_columns(s->turn.m, i, j) - (i == j)) > 1e-6)
        return false;
  return true;
}

/* Replaces a matrix m by matrix * m. */
static void apply(const vlMat4 *matrix, double m[16]) {
  const vlMat4 product = vl_mat4_multiply(*matrix, vl_mat4_load(m));
  memcpy(m, product.m, sizeof product.m);
}

/* A float texture with `scale` times the values of another one. Index 0: an error of the
 * scene. */
static vlTextureId scaled_texture(vlScene *scene, vlTextureId texture, double scale) {
  vlTextureDef def = vl_default_texture_def(VL_TEXTURE_SCALE, false);
  def.float_a.texture = texture;
  def.amount.value = (float)scale;
  return vl_scene_add_texture(scene, &def);
}

/* The height of a bump map is a length. */
static bool scale_height(vlScene *scene, vlFloatInput *height, double scale) {
  if (scale == 1)
    return true;
  height->value = (float)(height->value * scale);
  if (!height->texture.index)
    return true;
  const vlTextureId scaled = scaled_texture(scene, height->texture, scale);
  height->texture = scaled;
  return scaled.index != 0;
}

static bool transform_material(vlScene *scene, size_t index, const Similarity *s) {
  vlMaterialDef *m = &scene->materials.items[index];
  if (m->kind == VL_MATERIAL_SUBSURFACE)
    m->scale =
        (float)(m->subsurface.from_reflectance ? m->scale * s->scale : m->scale / s->scale);
  return scale_height(scene, &m->displacement, s->scale);
}

/* Whether the light comes from a point of the scene. */
static bool is_near(const vlLightDef *light) {
  const vlKindRow *row = vl_kind_row(&vl_light_family, (int)light->kind);
  return (row->traits & VL_LIGHT_TRAIT_AT_POINT) != 0;
}

size_t vl_scene_lamps(const vlScene *scene) {
  size_t count = 0;
  for (size_t i = 0; i < scene->lights.count; i++)
    count += is_near(&scene->lights.items[i]);
  for (size_t i = 0; i < scene->emissions.count; i++)
    count += !vl_is_unset(scene->emissions.items[i].power);
  return count - vl_scene_removed_count(&scene->light_marks); /* they are point lights now */
}

/* The direction and the position of a light change, its own space is scaled: so images of
 * lights keep their size. */
static void transform_light(vlLightDef *light, const Similarity *s) {
  double *m = light->world_from_light;
  double position[3] = {m[3], m[7], m[11]}, moved[3];
  vl_mat4_point(&s->matrix, position, moved);
  apply(&s->turn, m);
  m[3] = moved[0];
  m[7] = moved[1];
  m[11] = moved[2];
  for (int i = 0; i < 3; i++) {
    light->from[i] = (float)(light->from[i] * s->scale);
    light->to[i] = (float)(light->to[i] * s->scale);
  }
  /* the same irradiance at `scale` times the distance */
  if (is_near(light))
    light->scale = (float)(light->scale * s->scale * s->scale);
  for (int corner = 0; light->has_portal && corner < 4; corner++) {
    double to[3];
    vl_mat4_vertex(&s->matrix, light->portal[corner], to);
    for (int i = 0; i < 3; i++)
      light->portal[corner][i] = (float)to[i];
  }
}

/* Shapes of a group stay as they are in its space; its instances move. Displacements are
 * lengths in shape space. */
static void transform_shape(vlShapeDef *shape, const Similarity *s) {
  if (shape->group.index)
    return;
  apply(&s->matrix, shape->group_from_shape);
  shape->edge_length = (float)(shape->edge_length * s->scale);
}

static void transform_instance(vlSceneInstance *instance, const Similarity *s) {
  double *poses = (double *)(uintptr_t)instance->poses; /* the scene's own */
  apply(&s->matrix, instance->world_from_group);
  for (uint32_t k = 0; k < instance->keys; k++)
    apply(&s->matrix, poses + 16 * (size_t)k);
}

static void transform_texture(vlTextureDef *texture, const Similarity *s) {
  double *m = texture->texture_from_world, turned[3];
  const double direction[3] = {texture->direction[0], texture->direction[1],
                               texture->direction[2]};
  const vlMat4 product = vl_mat4_multiply(vl_mat4_load(m), s->inverse);
  memcpy(m, product.m, sizeof product.m);
  vl_mat4_vector(&s->turn, direction, turned);
  for (int i = 0; i < 3; i++)
    texture->direction[i] = (float)turned[i];
}

static bool transform_all(vlScene *scene, const Similarity *s) {
  const size_t textures = scene->textures.count; /* without those that are added for heights */
  bool good = true;
  for (size_t i = 0; good && i < scene->materials.count; i++)
    good = transform_material(scene, i, s);
  for (size_t i = 0; good && i < scene->shapes.count; i++)
    transform_shape(&scene->shapes.items[i], s);
  for (size_t i = 0; good && i < scene->instances.count; i++)
    transform_instance(&scene->instances.items[i], s);
  for (size_t i = 0; good && i < textures; i++)
    transform_texture(&scene->textures.items[i], s);
  for (size_t i = 0; good && i < scene->media.count; i++) {
    apply(&s->matrix, scene->media.items[i].world_from_medium);
    scene->media.items[i].scale = (float)(scene->media.items[i].scale / s->scale);
  }
  for (size_t i = 0; good && i < scene->emissions.count; i++)
    scene->emissions.items[i].power *= s->scale * s->scale;
  for (size_t i = 0; good && i < scene->lights.count; i++)
    transform_light(&scene->lights.items[i], s);
  for (size_t i = 0; good && i + 3 <= scene->frame_points.count; i += 3) {
    double *point = &scene->frame_points.items[i];
    vl_mat4_point(&s->matrix, point, point);
  }
  return good;
}

vlResult vl_scene_transform(vlScene *scene, const double world_from_scene[16], vlError *error) {
  Similarity s;
  vl_error_clear(error);
  if (!scene || !world_from_scene)
    return vl_fail_argument(error, "transform: a null pointer");
  VL_TRY(vl_scene_result(scene, error));
  if (!take_apart(world_from_scene, &s))
    return vl_fail_argument(error, "transform: not a rotation, a uniform scale and a shift");
  /* for later worlds these are the shapes of another scene */
  scene->number = vl_context_number(scene->context);
  return transform_all(scene, &s) ? VL_OK : vl_scene_result(scene, error);
}

/* The illuminance of a point light of I candela at d units is I / (d metres)^2, and the
 * luminance of a surface of A units^2 that sends P lumens is P / (pi A metres^2). */
void vl_scene_state_unit(vlScene *scene, size_t first_light, size_t first_emission,
                         double metres) {
  const double factor = 1 / (metres * metres);
  for (size_t i = first_light; i < scene->lights.count; i++) {
    vlLightDef *light = &scene->lights.items[i];
    if (is_near(light))
      light->scale = (float)(light->scale * factor);
  }
  for (size_t i = first_emission; i < scene->emissions.count; i++)
    scene->emissions.items[i].power *= factor;
}
