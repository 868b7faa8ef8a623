/* test/render/fog.h: participating media for a stage: their defs, and spheres that contain
 * them. */
#ifndef TEST_RENDER_FOG_H
#define TEST_RENDER_FOG_H

#include "shots.h"
#include "velo/medium.h"
#include "velo/shape_kinds.h"

static UNUSED vlMediumId add_medium(Stage *s, const vlMediumDef *def) {
  vlMediumId id = vl_scene_add_medium(s->scene, def);
  vlError error;
  if (vl_scene_result(s->scene, &error) != VL_OK)
    fail_msg("medium: %s", error.message);
  return id;
}

static UNUSED vlMaterialId interface(Stage *s) {
  vlMaterialDef def = vl_default_material_def(VL_MATERIAL_INTERFACE);
  return vl_scene_add_material(s->scene, &def);
}

static UNUSED void add_ball(Stage *s, float z, float radius, vlMaterialId material,
                            vlMediumId inside, vlMediumId outside) {
  vlShapeDef def = vl_default_shape_def(VL_SHAPE_SPHERE);
  def.radius = radius;
  def.z_min = -radius;
  def.z_max = radius;
  set_matrix(def.group_from_shape, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, z);
  def.material = material;
  def.inside = inside;
  def.outside = outside;
  assert_int_not_equal(vl_scene_add_shape(s->scene, &def).index, 0);
}

static UNUSED vlMediumDef fog(float a, float s, float g) {
  vlMediumDef def = vl_default_medium_def(VL_MEDIUM_HOMOGENEOUS);
  def.sigma_a = vl_spectrum_constant(a);
  def.sigma_s = vl_spectrum_constant(s);
  def.g = g;
  return def;
}

/* Makes a medium a grid whose density is 1 within `side` of the origin along each axis. */
static UNUSED void make_even_grid(vlMediumDef *def, float side) {
  static const float ones[8] = {1, 1, 1, 1, 1, 1, 1, 1};
  def->kind = VL_MEDIUM_GRID;
  def->nx = def->ny = def->nz = 2;
  def->density = ones;
  for (int i = 0; i < 3; i++) {
    def->low[i] = -side;
    def->high[i] = side;
  }
}

#endif
