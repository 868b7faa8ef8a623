/* test/import/test_loop.c: Loop subdivision against known properties of its limit surface. */
#include "import/load.h"
#include "import/pbrt/loop.h"

static vlContext *context;

static int open_context(void **state) {
  (void)state;
  return vl_context_create(NULL, &context) != VL_OK;
}

static int close_context(void **state) {
  (void)state;
  size_t left = vl_context_memory(context, NULL);
  vl_context_destroy(context);
  return left != 0;
}

static void free_mesh(vlMesh *m) {
  vl_free(context, m->positions);
  vl_free(context, m->normals);
  vl_free(context, m->indices);
}

static void subdivide(uint32_t vertices, const float *p, uint32_t faces, const uint32_t *v,
                      uint32_t levels, vlMesh *m) {
  vlError error;
  vlResult result = vl_loop_subdivide(context, vertices, p, faces, v, levels, m, &error);
  if (result != VL_OK)
    print_message("%s\n", error.message);
  assert_int_equal(result, VL_OK);
}

static const float octahedron[] = {1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1};
static const uint32_t octahedron_faces[] = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4,
                                            2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};

/* A closed mesh: V - E + F = 2 at every level; the limit points of the first vertices do not
 * hang on the level; normals all point to one side; everything keeps the symmetry. */
static void closed(void **state) {
  (void)state;
  float first = 0;
  for (uint32_t levels = 0; levels <= 5; levels++) {
    vlMesh m;
    subdivide(6, octahedron, 8, octahedron_faces, levels, &m);
    assert_int_equal(m.triangles, 8u << 2 * levels);
    assert_int_equal(m.vertices, 2 + m.triangles / 2);
    if (levels == 0)
      first = m.positions[0];
    for (uint32_t i = 0; i < 6; i++)
      for (int k = 0; k < 3; k++)
        assert_near(m.positions[3 * i + k], octahedron[3 * i + k] * first, 2e-6);
    for (uint32_t i = 0; i < m.vertices; i++) {
      const float *p = &m.positions[3 * i], *n = &m.normals[3 * i];
      /* against the winding, as pbrt has them */
      assert_true(p[0] * n[0] + p[1] * n[1] + p[2] * n[2] < 0);
    }
    for (uint32_t i = 0; i < 3 * m.triangles; i++)
      assert_true(m.indices[i] < m.vertices);
    free_mesh(&m);
  }
  /* valence 4: the limit mask is (1 - 4 g) p + g * ring with g = 1/(4 + 3/(8 b)), b = 3/32; the
   * ring sums to zero */
  assert_near(first, 1 - 4.0 / 8.0, 1e-6);
}

/* A flat grid stays flat; a border of collinear vertices stays a line; the normals are the
 * plane's. */
static void flat(void **state) {
  (void)state;
  enum { N = 4 };
  float p[3 * (N + 1) * (N + 1)];
  uint32_t v[6 * N * N], n = 0;
  for (int y = 0; y <= N; y++)
    for (int x = 0; x <= N; x++) {
      float *q = &p[3 * (y * (N + 1) + x)];
      q[0] = (float)x;
      q[1] = (float)y;
      q[2] = 0.5f;
    }
  for (uint32_t y = 0; y < N; y++)
    for (uint32_t x = 0; x < N; x++) {
      uint32_t a = y * (N + 1) + x;
      const uint32_t quad[] = {a, a + 1, a + N + 2, a, a + N + 2, a + N + 1};
      memcpy(v + n, quad, sizeof quad);
      n += 6;
    }
  vlMesh m;
  subdivide((N + 1) * (N + 1), p, 2 * N * N, v, 3, &m);
  double area = 0;
  for (uint32_t i = 0; i < m.vertices; i++) {
    assert_near(m.positions[3 * i + 2], 0.5, 1e-6);
    assert_true(m.positions[3 * i] > -1e-6f && m.positions[3 * i] < N + 1e-6f);
    const float *k = &m.normals[3 * i];
    assert_true(k[2] < 0 && fabsf(k[0]) < -1e-4f * k[2] && fabsf(k[1]) < -1e-4f * k[2]);
  }
  for (uint32_t f = 0; f < m.triangles; f++) {
    const float *a = &m.positions[3 * m.indices[3 * f]],
                *b = &m.positions[3 * m.indices[3 * f + 1]],
                *c = &m.positions[3 * m.indices[3 * f + 2]];
    double twice = (double)(b[0] - a[0]) * (double)(c[1] - a[1]) -
                   (double)(b[1] - a[1]) * (double)(c[0] - a[0]);
    assert_true(twice > 0); /* no face turned over */
    area += 0.5 * twice;
  }
  assert_true(area > 15.5 && area < 16); /* the corners are rounded off */
  free_mesh(&m);
}

/* A regular interior vertex (valence 6) has the limit mask 1/2, and 1/12 for each neighbour. */
static void regular_vertex(void **state) {
  (void)state;
  float p[3 * 7] = {0.1f, 0.2f, 3};
  uint32_t v[18];
  double x = 0, y = 0, z = 0;
  for (uint32_t i = 0; i < 6; i++) {
    p[3 + 3 * i] = (float)cos(i * M_PI / 3) + 0.1f * (float)i;
    p[4 + 3 * i] = (float)sin(i * M_PI / 3);
    p[5 + 3 * i] = 0.3f * (float)(i * i % 5);
    x += (double)p[3 + 3 * i];
    y += (double)p[4 + 3 * i];
    z += (double)p[5 + 3 * i];
    const uint32_t face[] = {0, 1 + i, 1 + (i + 1) % 6};
    memcpy(v + 3 * i, face, sizeof face);
  }
  for (uint32_t levels = 0; levels < 4; levels++) {
    vlMesh m;
    subdivide(7, p, 6, v, levels, &m);
    assert_near(m.positions[0], 0.5 * 0.1 + x / 12, 2e-6);
    assert_near(m.positions[1], 0.5 * 0.2 + y / 12, 2e-6);
    assert_near(m.positions[2], 0.5 * 3 + z / 12, 2e-6);
    free_mesh(&m);
  }
}

static void refused(void **state) {
  (void)state;
  const float p[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 0, 1};
  const uint32_t twice[] = {0, 1, 1}, same_way[] = {0, 1, 2, 0, 1, 3};
  vlMesh m;
  vlError error;
  assert_int_equal(vl_loop_subdivide(context, 5, p, 1, twice, 1, &m, &error), VL_ERROR_SCENE);
  assert_string_equal(error.message, "face 0 names vertex 1 twice");
  assert_int_equal(vl_loop_subdivide(context, 5, p, 2, same_way, 1, &m, &error),
                   VL_ERROR_SCENE);
  /* three faces at an edge, a vertex of two fans, a vertex of none: odd, but there is an
   * answer */
  const uint32_t book[] = {0, 1, 2, 1, 0, 3, 0, 1, 4}, bow[] = {0, 1, 2, 0, 3, 4};
  subdivide(5, p, 3, book, 3, &m);
  free_mesh(&m);
  subdivide(5, p, 2, bow, 3, &m);
  free_mesh(&m);
  subdivide(5, p, 1, book, 3, &m);
  free_mesh(&m);
}

/* The largest meshes are made, and refused with a level or a face more. Beyond 5 levels fewer
 * faces are allowed. */
static void limits(void **state) {
  (void)state;
  enum { MAX_FACES = 1 << 24 };
  static const struct {
    uint32_t vertices, faces, levels;
  } too_many[] = {{6, 8, 9},
                  {3, 1, 11},
                  {6, 8, 40},
                  {3, MAX_FACES + 1, 0},
                  {MAX_FACES + 1, 1, 0},
                  {6, MAX_FACES / 1024 + 1, 5}};
  const uint32_t triangle[] = {0, 2, 4};
  vlMesh m;
  vlError error;
  for (size_t i = 0; i < sizeof too_many / sizeof *too_many; i++) {
    assert_int_equal(
        vl_loop_subdivide(context, too_many[i].vertices, octahedron, too_many[i].faces,
                          octahedron_faces, too_many[i].levels, &m, &error),
        VL_ERROR_SCENE);
    assert_non_null(strstr(error.message, "too many"));
  }
  subdivide(6, octahedron, 8, octahedron_faces, 6, &m);
  assert_int_equal(m.triangles, 8 << 12);
  free_mesh(&m);
  subdivide(6, octahedron, 1, triangle, 10, &m);
  assert_int_equal(m.triangles, 1 << 20);
  free_mesh(&m);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(closed), cmocka_unit_test(flat),
                                     cmocka_unit_test(regular_vertex),
                                     cmocka_unit_test(refused), cmocka_unit_test(limits)};
  return cmocka_run_group_tests(tests, open_context, close_context);
}
