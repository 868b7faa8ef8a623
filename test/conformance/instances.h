/* conformance/instances.h: the law of places: a shape in an object that is placed by a map is
 * the shape under that map itself, whether the map stretches, mirrors or moves. */
#ifndef TEST_CONFORMANCE_INSTANCES_H
#define TEST_CONFORMANCE_INSTANCES_H

#include "conformance.h"
#include "shapes.h"
#include "surfaces.h"
#include "unit.h"

/* A stretched map that does not mirror, and one that does. */
static const char *const placing_maps[2] = {STRETCHED, STRETCHED "Scale 1 -1 1 "};

/* The shape under a map, in an object, and in one that hardly moves, but is not at rest. */
static const char *const placings[3] = {
    "AttributeBegin %s Shape %%s AttributeEnd",
    "ObjectBegin \"o\" Shape %%s ObjectEnd AttributeBegin %s ObjectInstance \"o\" AttributeEnd",
    "ObjectBegin \"o\" Shape %%s ObjectEnd AttributeBegin %s ActiveTransform EndTime "
    "Translate 0 0 1e-7 ActiveTransform All ObjectInstance \"o\" AttributeEnd",
};

static Sides *placed(const char *placing, const char *map, const char *directive,
                     const char *parameters) {
  char scene[600];
  char form[1000];
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
  expect_no_failures();
}

#endif
