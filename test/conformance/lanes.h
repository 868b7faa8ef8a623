/* conformance/lanes.h: the law of lanes: what a ray finds does not depend on its place in a
 * batch, nor on the other rays of the batch. Rays of many widths and directions meet shapes of
 * all forms with all materials, or all textures, some of them in objects, in two orders. */
#ifndef TEST_CONFORMANCE_LANES_H
#define TEST_CONFORMANCE_LANES_H

#include "materials.h"
#include "neighbours.h"
#include "textures.h"

enum { CROWD_TEXT = 65536, CROWD_ROW = 6 };

static const char *const crowd_shapes[] = {
    "\"sphere\" \"float radius\" .6",
    "\"trianglemesh\" \"integer indices\" [0 1 2 2 1 3] \"point3 P\" "
    "[-.7 -.7 .1 .7 -.7 0 -.7 .7 0 .7 .7 .2] \"point2 uv\" [0 0 1 0 0 1 1 1] "
    "\"normal N\" [-.2 0 1 .2 0 1 -.2 .1 1 .2 .1 1]",
    "\"bilinearmesh\" \"point3 P\" [-.7 -.7 .3 .7 -.7 0 -.7 .7 0 .7 .7 .3]",
    "\"disk\" \"float radius\" .7 \"float innerradius\" .2",
    "\"cylinder\" \"float radius\" .4 \"float zmin\" -.5 \"float zmax\" .5",
    "\"curve\" \"point3 P\" [-.7 -.5 0 -.2 .9 .2 .2 -.9 .3 .7 .5 0] \"float width\" .4",
};
enum { CROWD_SHAPES = sizeof crowd_shapes / sizeof *crowd_shapes };

/* Adds a thing of the crowd with what `part` says of its material; every third is an instance.
 */
static void add_to_crowd(char text[CROWD_TEXT], int number, const char *part) {
  const char *shape = crowd_shapes[number % CROWD_SHAPES];
  const double x = 1.4 * (number % CROWD_ROW - (CROWD_ROW - 1) / 2.0);
  const double y = 1.4 * (number / CROWD_ROW - 2);
  char *at = text + strlen(text);
  const size_t size = CROWD_TEXT - strlen(text);
  const int length =
      number % 3 == 2
          ? snprintf(at, size,
                     "AttributeBegin %s ObjectBegin \"o%d\" Shape %s ObjectEnd AttributeEnd "
                     "AttributeBegin Translate %g %g .2 Rotate %d 1 .4 .2 Scale 1 1.2 .9 "
                     "ObjectInstance \"o%d\" AttributeEnd\n",
                     part, number, shape, x, y, 20 * number, number)
          : snprintf(at, size,
                     "AttributeBegin Translate %g %g 0 Rotate %d .3 1 .4 %s Shape %s "
                     "AttributeEnd\n",
                     x, y, 25 * number, part, shape);
  assert_true((size_t)length < size);
}

/* What a batch finds: the hits, and the BSDF there. */
typedef struct LaneFound {
  vlTraceHits hits;
  float value[4][VL_OWN_BATCH], pdf[VL_OWN_BATCH];
} LaneFound;

typedef struct LaneLaws {
  vlTraceRays *rays;
  LaneFound *found[2];
  uint32_t order[VL_OWN_BATCH]; /* the ray of each lane of the second batch */
  uint32_t hit, others;
} LaneLaws;

/* Ray r goes from a point around the crowd to one in it, from every fourth along an axis. */
static void place_ray(vlTraceRays *rays, uint32_t i, uint32_t r, uint32_t batch) {
  double origin[3];
  double direction[3];
  double length = 0;
  even_direction(r, VL_OWN_BATCH, 0.7548776662 * batch, origin);
  for (int k = 0; k < 3; k++) {
    static const double extent[3] = {4.2, 2.8, 0.3};
    static const double step[3] = {0.8191725134, 0.6710436067, 0.5497004779};
    const double to = extent[k] * (2 * fmod(0.5 + (r + 1) * step[k], 1.0) - 1);
    origin[k] = r % 4 ? 9 * origin[k] : to + (k == 2 ? 9 : 0);
    direction[k] = to - origin[k];
    length += direction[k] * direction[k];
  }
  for (int k = 0; k < 3; k++)
    direction[k] /= sqrt(length);
  set_ray(rays, i, origin, direction);
  rays->width[i] = r % 3 ? 0.002f * (float)(r % 50) : 0.0f;
}

static void find_together(LaneLaws *l, vlTrace *trace, int turn, uint32_t batch) {
  static float direction[3][VL_OWN_BATCH];
  LaneFound *f = l->found[turn];
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    const uint32_t r = turn ? l->order[i] : i;
    double w[3];
    even_direction(r * 37 % VL_OWN_BATCH, VL_OWN_BATCH, 0.3, w);
    for (int k = 0; k < 3; k++)
      direction[k][i] = (float)w[k];
    place_ray(l->rays, i, r, batch);
  }
  vl_world_trace(trace, l->rays, &f->hits);
  vl_trace_bsdf(trace, direction, f->value, f->pdf);
}

static bool is_same(const LaneLaws *l, uint32_t i) {
  const uint32_t r = l->order[i];
  const LaneFound *a = l->found[0];
  const LaneFound *b = l->found[1];
  bool same = a->hits.t[r] == b->hits.t[i] && a->hits.object[r] == b->hits.object[i] &&
              a->hits.material[r] == b->hits.material[i] && a->pdf[r] == b->pdf[i];
  for (int k = 0; k < 2; k++)
    same = same && a->hits.uv[k][r] == b->hits.uv[k][i];
  for (int k = 0; k < 3; k++)
    same = same && a->hits.position[k][r] == b->hits.position[k][i] &&
           a->hits.normal[k][r] == b->hits.normal[k][i] &&
           a->hits.shading[k][r] == b->hits.shading[k][i] &&
           a->hits.reflectance[k][r] == b->hits.reflectance[k][i] &&
           a->hits.emission[k][r] == b->hits.emission[k][i] && a->value[k][r] == b->value[k][i];
  return same;
}

static void ask_lanes(Probe *probe, vlTrace *trace, const vlOwnPaths *paths) {
  (void)paths;
  LaneLaws *l = probe->user;
  for (int turn = 0; turn < 2; turn++)
    find_together(l, trace, turn, probe->batch);
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    l->hit += isfinite(l->found[1]->hits.t[i]);
    l->others += !is_same(l, i);
  }
}

static void check_crowd(const char *family, const char *text) {
  LaneLaws l = {.rays = new_rays()};
  Probe probe = {.ask = ask_lanes, .user = &l};
  for (int turn = 0; turn < 2; turn++)
    l.found[turn] = calloc(1, sizeof *l.found[turn]);
  assert_true(l.found[0] && l.found[1]);
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++)
    l.order[i] = (i * 389 + 17) % VL_OWN_BATCH;
  probe_world(text, &probe, 8);
  if (l.hit < VL_OWN_BATCH)
    broken(family, "all", "%u rays hit something", l.hit);
  if (l.others)
    broken(family, "all", "%u of %u rays find something else in another order of their batch",
           l.others, l.hit);
  free(l.rays);
  free(l.found[0]);
  free(l.found[1]);
}

static void lanes_of_materials(void **state) {
  (void)state;
  static char text[CROWD_TEXT];
  const vlKindFamily *family = vl_kind_family_find("materials");
  int count = 0;
  snprintf(text, sizeof text, HEAD "WorldBegin LightSource \"infinite\" " NAMED);
  for (uint32_t k = 0; k < family->kind_count; k++) {
    const MaterialVariant *v = material_cases[k]->variants;
    for (int i = 0; i < 2 && v[i].parameters; i++) {
      char part[TEXT];
      if (v[i].walks)
        continue; /* the random walks of its BSDF depend on the lane */
      material_part(part, family->rows[k], v[i].parameters, 0);
      add_to_crowd(text, count++, part);
    }
  }
  check_crowd("materials", text);
  expect_no_failures();
}

static void lanes_of_textures(void **state) {
  (void)state;
  static char text[CROWD_TEXT];
  const vlKindFamily *family = vl_kind_family_find("textures");
  int count = 0;
  snprintf(text, sizeof text, HEAD "WorldBegin LightSource \"infinite\" " HALVES);
  for (uint32_t k = 0; k < family->kind_count; k++)
    for (int i = 0; texture_variant(k, i); i++) {
      char part[TEXT];
      texture_part(part, family->rows[k], texture_variant(k, i), count);
      add_to_crowd(text, count++, part);
    }
  check_crowd("textures", text);
  expect_no_failures();
}

#endif
