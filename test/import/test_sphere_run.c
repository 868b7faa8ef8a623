/* test/import/test_sphere_run.c: the importer joins consecutive spheres into one shape of many
 * spheres (a run). A world with runs has the same spheres as one without, rays hit a sphere of
 * many where they hit it alone, and a failed allocation leaks no memory. */
#include "import/load_failing.h"

#include "scene/solid.h"
#include "shape/surface_point.h"
#include "velo/light.h"
#include "velo/shape_kinds.h"

enum { BEFORE = 4096, SPHERES = 60 };

/* A scene of `before` disks, then of spheres with different transforms, materials, media,
 * emission and alpha. */
static char *text_of(int before) {
  char *text = malloc(100 * (size_t)BEFORE + 600 * (size_t)SPHERES + 1000), *at = text;
  at += sprintf(at,
                "WorldBegin\nTexture \"t\" \"float\" \"constant\" \"float value\" 0.5\n"
                "MakeNamedMedium \"m\" \"string type\" \"homogeneous\"\n");
  for (int i = 0; i < before; i++)
    at += sprintf(at, "Shape \"disk\"\n");
  for (int i = 0; i < SPHERES; i++) {
    at += sprintf(at, "AttributeBegin\nTranslate %d 0.3 %d\n", 3 * i, i % 7);
    if (i % 3 == 1)
      at += sprintf(at, "Rotate 40 1 2 3\n");
    if (i % 5 == 2)
      at += sprintf(at, "Scale -1 2 3\n");
    if (i % 5 == 3)
      at += sprintf(at, "Scale 0.3 0.3 0.3\n");
    if (i % 4 == 3)
      at += sprintf(at, "ReverseOrientation\n");
    if (i % 2)
      at += sprintf(at, "Material \"conductor\"\n");
    if (i % 6 == 4)
      at += sprintf(at, "MediumInterface \"m\" \"\"\n");
    if (i == 30)
      at += sprintf(at, "AreaLightSource \"diffuse\"\n");
    at += sprintf(at, "Shape \"sphere\" \"float radius\" %g", 0.2 + 0.01 * i);
    if (i % 10 == 9)
      at += sprintf(at, " \"float phimax\" 200");
    if (i % 10 == 8)
      at += sprintf(at, " \"float zmax\" 0.1");
    if (i % 8 == 4)
      at += sprintf(at, " \"texture alpha\" \"t\"");
    if (i % 8 == 5)
      at += sprintf(at, " \"float alpha\" 0.3");
    at += sprintf(at, "\nAttributeEnd\n");
  }
  return text;
}

/* What is compared of a sphere: its place (the first number, by which spheres are sorted),
 * bounding box, points and normals, material kind, emission, alpha, media. */
typedef struct Sphere {
  float v[25];
} Sphere;
enum { NUMBERS = 25 };

static int by_place(const void *a, const void *b) {
  const Sphere *x = a, *y = b;
  return (x->v[0] > y->v[0]) - (x->v[0] < y->v[0]);
}

static void describe(const vlWorld *world, const vlWorldShape *s, uint32_t prim, float *v) {
  double pdf;
  vlSurfacePoint p;
  vl_world_prim_bounds(s, prim, v + 1, v + 4);
  v[0] = floorf((v[1] + v[4]) / 6.0f + 0.5f);
  for (int k = 0; k < 2; k++) {
    vl_shape_sample(s, prim, 0.3f, 0.2f + 0.5f * (float)k, &p, &pdf);
    for (int i = 0; i < 3; i++) {
      v[7 + 6 * k + i] = (float)p.p[i];
      v[10 + 6 * k + i] = (float)p.n[i];
    }
  }
  v[19] = (float)world->materials.items[s->material].kind;
  v[20] = s->first_light != VL_NONE;
  vlTextureQuery at = {0, 0, {v[7], v[8], v[9]}, {0, 0, 1}, NULL};
  v[21] = s->alpha < 0 ? 1 : vl_texture_float_at(world, s->alpha, &at);
  v[22] = s->inside == VL_NONE ? -1 : (float)s->inside;
  v[23] = s->outside == VL_NONE ? -1 : (float)s->outside;
  v[24] = (float)pdf;
}

static Sphere *spheres_of(const char *text, size_t *shapes) {
  Loaded l;
  load_fine(&l, text);
  vlWorld *world;
  vlError error = {0};
  if (vl_world_build(l.scene, NULL, &world, &error) != VL_OK)
    fail_msg("%s", error.message);
  Sphere *spheres = calloc(SPHERES, sizeof *spheres);
  size_t count = *shapes = 0;
  for (size_t i = 0; i < world->shapes.count; i++) {
    const vlWorldShape *s = &world->shapes.items[i];
    if (s->kind != VL_SHAPE_SPHERE)
      continue;
    ++*shapes;
    for (uint32_t k = 0; k < s->faces; k++) {
      assert_true(count < SPHERES);
      describe(world, s, k, spheres[count++].v);
    }
  }
  assert_int_equal(count, SPHERES);
  qsort(spheres, count, sizeof *spheres, by_place);
  vl_world_destroy(world);
  end_load(&l);
  return spheres;
}

static void put_together_they_are_the_same(void **state) {
  (void)state;
  char *apart = text_of(0), *together = text_of(BEFORE);
  size_t shapes[2];
  Sphere *a = spheres_of(apart, &shapes[0]), *b = spheres_of(together, &shapes[1]);
  assert_int_equal(shapes[0], SPHERES);
  assert_true(shapes[1] < SPHERES);
  for (size_t i = 0; i < SPHERES; i++)
    for (int k = 0; k < NUMBERS; k++)
      if (!(fabsf(a[i].v[k] - b[i].v[k]) <= 4e-7f * fmaxf(1, fabsf(a[i].v[k]))))
        fail_msg("sphere %zu, number %d: %.9g apart, %.9g together", i, k, (double)a[i].v[k],
                 (double)b[i].v[k]);
  free(a);
  free(b);
  free(apart);
  free(together);
}

/* The spheres are transformed by a matrix that is not a similarity. A ray hits a sphere of many
 * at the same point as the same sphere alone; this also holds for rays through the whole
 * world. */
static void many_are_each_alone(void **state) {
  (void)state;
  enum { N = 50 };
  const double matrix[16] = {1.2, 0.3,  0,    1, -0.4, 0.8, 0.5, -2,
                             0.1, -0.2, -0.6, 3, 0,    0,   0,   1};
  double centers[3 * N];
  float radii[N];
  for (int i = 0; i < N; i++) {
    for (int k = 0; k < 3; k++)
      centers[3 * i + k] = 5 * sin(7.7 * i + 2.1 * k);
    radii[i] = 0.5f + 0.01f * (float)i;
  }
  vlContext *context;
  vlScene *scene[2];
  vlWorld *world[2];
  vlError error = {0};
  assert_int_equal(vl_context_create(NULL, &context), VL_OK);
  vlShapeDef def = vl_default_shape_def(VL_SHAPE_SPHERE);
  def.centers = centers;
  def.radii = radii;
  def.faces = N;
  memcpy(def.group_from_shape, matrix, sizeof matrix);
  double low[2][3], high[2][3];
  for (int w = 0; w < 2; w++) {
    assert_int_equal(vl_scene_create(context, &scene[w]), VL_OK);
    for (uint32_t i = 0; i < (w ? N : 1); i++) {
      vlShapeDef one = vl_shape_one_sphere(&def, i);
      assert_int_not_equal(vl_scene_add_shape(scene[w], w ? &one : &def).index, 0);
    }
    vl_scene_bounds(scene[w], low[w], high[w]);
    if (vl_world_build_last(scene[w], NULL, &world[w], &error) != VL_OK)
      fail_msg("%s", error.message);
  }
  for (int k = 0; k < 3; k++)
    assert_true(low[0][k] == low[1][k] && high[0][k] == high[1][k]);
  uint32_t hits = 0;
  for (int i = 0; i < 4000; i++) {
    double o[3] = {20 * sin(1.1 * i), 20 * sin(1.7 * i + 1), 20},
           to[3] = {5 * sin(2.3 * i), 5 * sin(3.1 * i + 2), 1};
    float row[6][1];
    for (int k = 0; k < 3; k++) {
      row[k][0] = (float)o[k];
      row[3 + k][0] = (float)(to[k] - o[k]);
    }
    vlRays ray = {
        .ox = row[0], .oy = row[1], .oz = row[2], .dx = row[3], .dy = row[4], .dz = row[5]};
    uint32_t shape[2], prim[2], instance[2];
    float t[2];
    for (int w = 0; w < 2; w++)
      vl_accel_closest(world[w], 1, &ray, false, shape + w, prim + w, instance + w, t + w);
    assert_true((shape[0] == VL_NONE) == (shape[1] == VL_NONE));
    if (shape[0] == VL_NONE)
      continue;
    hits++;
    assert_int_equal(prim[0], shape[1]);
    assert_true(fabsf(t[0] - t[1]) <= 1e-6f * t[1]);
  }
  assert_true(hits > 300);
  for (int w = 0; w < 2; w++) {
    vl_world_destroy(world[w]);
    vl_scene_destroy(scene[w]);
  }
  vl_context_destroy(context);
}

static void wrong_ones_are_refused(void **state) {
  (void)state;
  for (int wrong = 0; wrong < 6; wrong++) {
    Loaded l;
    start_load(&l);
    double centers[6] = {0, 0, 0, 1, 1, 1};
    float radii[2] = {1, 2};
    vlEmissionDef emission = vl_default_emission_def();
    vlShapeDef def = vl_default_shape_def(VL_SHAPE_SPHERE);
    def.centers = centers;
    def.radii = radii;
    def.faces = 2;
    if (wrong == 1)
      def.radii = NULL;
    if (wrong == 2)
      def.faces = 0;
    if (wrong == 3)
      radii[1] = 0;
    if (wrong == 4)
      centers[4] = (double)NAN;
    if (wrong == 5)
      def.emission = vl_scene_add_emission(l.scene, &emission);
    assert_int_equal(vl_scene_add_shape(l.scene, &def).index != 0, wrong == 0);
    end_load(&l);
  }
}

static void memory_runs_out(void **state) {
  (void)state;
  char *text = text_of(BEFORE);
  fail_last_allocations(text, 200);
  free(text);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(put_together_they_are_the_same),
      cmocka_unit_test(many_are_each_alone),
      cmocka_unit_test(wrong_ones_are_refused),
      cmocka_unit_test(memory_runs_out),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
