/* conformance/instances.h: the law of instances: a shape in an object whose instance has a map
 * is the same as the shape itself under this map, which may stretch, mirror or move it. */
#ifndef TEST_CONFORMANCE_INSTANCES_H
#define TEST_CONFORMANCE_INSTANCES_H

#include "conformance.h"
#include "shading.h"
#include "shapes.h"
#include "surfaces.h"
#include "unit.h"

/* A stretched map that does not mirror, and one that does. */
static const char *const placing_maps[2] = {STRETCHED, STRETCHED "Scale 1 -1 1 "};

/* Another object, far away, before it and after it. */
#define DECOY(name, map)                                                 \
  "ObjectBegin \"" name                                                  \
  "\" Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point3 P\" "  \
  "[0 0 0 1 0 0 0 1 0] ObjectEnd AttributeBegin Translate 50 60 70 " map \
  " ObjectInstance \"" name "\" AttributeEnd "
#define BEFORE DECOY("before", "Rotate 40 1 2 3 Scale 2 1 -3")
#define AFTER DECOY("after", "Rotate 70 3 1 2 Scale 1 5 1")

/* The shape under a map, in an object, and in one that hardly moves, but is not at rest. */
static const char *const placings[3] = {
    "AttributeBegin %s Shape %%s AttributeEnd",
    BEFORE
    "ObjectBegin \"o\" Shape %%s ObjectEnd AttributeBegin %s ObjectInstance \"o\" AttributeEnd " AFTER,
    BEFORE
    "ObjectBegin \"o\" Shape %%s ObjectEnd AttributeBegin %s ActiveTransform EndTime "
    "Translate 0 0 1e-7 ActiveTransform All ObjectInstance \"o\" AttributeEnd " AFTER,
};

static Sides *placed(const char *placing, const char *map, const char *directive,
                     const char *parameters) {
  char scene[1400];
  char form[1800];
  snprintf(scene, sizeof scene,
           HEAD "WorldBegin LightSource \"infinite\" Material \"diffuse\" %s", placing);
  snprintf(form, sizeof form, scene, map);
  return sides_of_scene(form, directive, parameters);
}

/* The largest difference of two normals; of two lines, if their sides do not count. */
static double normals_apart(const Sides *a, const Sides *b, uint32_t i, bool lines) {
  double same = 0;
  double opposite = 0;
  for (int k = 0; k < 3; k++) {
    same = fmax(same, fabs((double)a->shading[k][i] - (double)b->shading[k][i]));
    opposite = fmax(opposite, fabs((double)a->shading[k][i] + (double)b->shading[k][i]));
  }
  return lines ? fmin(same, opposite) : same;
}

/* A mirrored sphere, cylinder, disk, patch or curve has its outside within, as in pbrt, but in
 * a mirrored object it has not. */
static void check_placing(const vlKindRow *row, const char *parameters, int placing, int map) {
  const bool lines = map == 1 && strcmp(row->name, "trianglemesh") != 0;
  Sides *direct = placed(placings[0], placing_maps[map], row->name, parameters);
  Sides *other = placed(placings[placing], placing_maps[map], row->name, parameters);
  uint32_t hit = 0;
  uint32_t far = 0;
  uint32_t turned = 0;
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    const bool met = isfinite(direct->hits->t[i]);
    const bool again = isfinite(other->hits->t[i]);
    hit += met && again;
    far += met != again;
    if (!met || !again)
      continue;
    far += !(fabsf(direct->hits->t[i] - other->hits->t[i]) < 1e-4f &&
             fabsf(direct->hits->uv[0][i] - other->hits->uv[0][i]) < 1e-3f &&
             fabsf(direct->hits->uv[1][i] - other->hits->uv[1][i]) < 1e-3f);
    turned += !(normals_apart(direct, other, i, lines) < 2e-3);
  }
  /* single rays may pass an edge, or its seam, on either side */
  if (hit < 10 || far > 2 || turned > 2)
    broken("shapes", row->name,
           "%s: %s object, %s: of %u points %u are elsewhere, %u normals are others",
           parameters, placing == 1 ? "a still" : "a moving", map ? "mirrored" : "stretched",
           hit, far, turned);
  free_sides(direct);
  free_sides(other);
}

static void check_placings(const vlKindRow *row, const char *parameters) {
  for (int placing = 1; placing < 3; placing++)
    for (int map = 0; map < 2; map++)
      check_placing(row, parameters, placing, map);
}

/* ---- tangents ---------------------------------------------------------------------------- */

/* What a metal with a normal map and brushed along given tangents sends under a map, where it
 * is in a still (1) or in a moving object (2), or in none (0). last_first: its faces are in the
 * other order. */
static Scattering *brushed(const double map[16], int placing, float sign, bool last_first) {
  static const uint32_t exchanged[6] = {0, 2, 3, 0, 1, 2};
  static const float normals[12] = {0.3f, 0, 1, 0, 0.2f, 1, -0.1f, 0, 1, 0, 0.4f, 1};
  static const float tangents[12] = {1, 0.3f, 0, 1, 0.2f, 0, 0.8f, 0.4f, 0, 1, 0, 0};
  const float signs[4] = {sign, sign, sign, sign};
  vlScene *scene = need_scene(HEAD "WorldBegin LightSource \"infinite\"");
  vlImage *image;
  vlMaterialDef metal = vl_default_material_def(VL_MATERIAL_PRINCIPLED);
  metal.principled.metallic.value = 1;
  metal.principled.roughness.value = 0.6f;
  metal.principled.anisotropy.value = 0.7f;
  metal.principled.anisotropy_rotation.value = 0.5f;
  metal.principled.normal = add_map(scene, &image, 1);
  vlShapeDef square = square_def();
  square.normals = normals;
  square.tangents = tangents;
  square.tangent_signs = signs;
  if (last_first)
    square.indices = exchanged;
  square.material = vl_scene_add_material(scene, &metal);
  if (placing)
    square.group = vl_scene_add_group(scene, "o");
  else
    memcpy(square.group_from_shape, map, sizeof square.group_from_shape);
  vl_scene_add_shape(scene, &square);
  static const double times[2] = {0, 1};
  double poses[32];
  memcpy(poses, map, 16 * sizeof *map);
  memcpy(poses + 16, map, 16 * sizeof *map);
  poses[16 + 11] += 1e-7; /* hardly moves, but is not at rest */
  if (placing == 1)
    vl_scene_add_instance(scene, square.group, map, (vlSource){0});
  if (placing == 2)
    vl_scene_add_moving_instance(scene, square.group, 2, times, poses, (vlSource){0});
  assert_int_equal(vl_scene_result(scene, NULL), VL_OK);
  Scattering *s = scattering_of(scene, "tangents");
  vl_image_destroy(image);
  return s;
}

/* The square keeps facing the ray, so that only a mirror of its plane turns its tangents. */
static void check_tangents(float sign, bool mirrored) {
  const double side = mirrored ? -1 : 1;
  const double map[16] = {1.2, 0.3 * side, 0.1, 0, 0.2, 0.9 * side, 0, 0,
                          0,   0,          1,   0, 0,   0,          0, 1};
  static const char *const names[3] = {"the other order of faces", "a still object",
                                       "a moving object"};
  Scattering *direct = brushed(map, 0, sign, false);
  for (int placing = 0; placing < 3; placing++) {
    Scattering *other = brushed(map, placing, sign, placing == 0);
    uint32_t differ = 0;
    for (uint32_t i = 0; i < VL_OWN_BATCH; i++)
      differ += !close_to((double)direct->pdf[i], (double)other->pdf[i], 5e-3);
    if (differ)
      broken("shapes", "trianglemesh", "%s, %s: %u of %u densities by tangents differ",
             names[placing], mirrored ? "mirrored" : "stretched", differ, VL_OWN_BATCH);
    free_scattering(other);
  }
  free_scattering(direct);
}

static void laws_of_instances(void **state) {
  (void)state;
  const vlKindFamily *family = vl_kind_family_find("shapes");
  for (uint32_t k = 0; k < family->kind_count; k++)
    check_placings(family->rows[k], shape_cases[k]->variants[0].parameters);
  static const char *const with_normals[][2] = {{"trianglemesh", "[0 1 2 2 1 3]"},
                                                {"bilinearmesh", "[0 1 2 3]"}};
  for (uint32_t k = 0; k < family->kind_count; k++)
    for (int i = 0; i < 2; i++) {
      char parameters[300];
      snprintf(parameters, sizeof parameters,
               "\"point3 P\" [-1 -1 0 1 -1 0 -1 1 0 1 1 .3] \"normal3 N\" [.3 .2 1 -.2 .1 1 "
               ".1 -.4 1 .2 .2 1] \"integer indices\" %s",
               with_normals[i][1]);
      if (strcmp(family->rows[k]->name, with_normals[i][0]) == 0)
        check_placings(family->rows[k], parameters);
    }
  for (int i = 0; i < 4; i++)
    check_tangents(i & 1 ? -1 : 1, i & 2);
  expect_no_failures();
}

#endif
