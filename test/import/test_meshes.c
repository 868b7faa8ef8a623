/* test/import/test_meshes.c: STL, OFF, and what PLY files hold besides polygons: strips,
 * colours of faces, points. */
#include "load.h"
#include "velo/shape.h"

static Loaded load(const char *name, const void *data, size_t size) {
  Loaded l;
  char path[64];
  snprintf(path, sizeof path, "/tmp/velo-mesh-%d-%s", (int)getpid(), name);
  FILE *f = fopen(path, "wb");
  assert_non_null(f);
  assert_int_equal(fwrite(data, 1, size, f), size);
  fclose(f);
  start_load(&l);
  l.result = vl_scene_load(l.scene, path, NULL, &l.error);
  unlink(path);
  return l;
}

static Loaded load_lines(const char *name, const char *text) {
  return load(name, text, strlen(text));
}

static const vlShapeDef *shape(const Loaded *l) {
  if (l->result != VL_OK)
    fail_msg("%u: %s", l->error.line, l->error.message);
  assert_int_equal(l->scene->shapes.count, 1);
  assert_true(l->scene->defs.camera_missing && l->scene->defs.light_missing);
  return &l->scene->shapes.items[0];
}

static void expect_error(const char *name, const char *text, uint32_t line,
                         const char *message) {
  Loaded l = load_lines(name, text);
  assert_int_equal(l.result, VL_ERROR_SCENE);
  if (!strstr(l.error.message, message))
    fail_msg("%s: \"%s\" does not say \"%s\"", text, l.error.message, message);
  assert_int_equal(l.error.line, line);
  end_load(&l);
}

#define FACET(a, b, c)                                                    \
  "facet normal 0 0 0\nouter loop\nvertex " a "\nvertex " b "\nvertex " c \
  "\nendloop\nendfacet\n"

static void stl(void **state) {
  (void)state;
  Loaded l =
      load_lines("a.stl", "solid a facet of vertex 1 2\n" FACET("0 0 0", "1 0 0", "0 2.5e0 0")
                              FACET("0 0 0", "0 1 0", "0 0 -1") "ENDSOLID\n");
  const vlShapeDef *d = shape(&l);
  assert_int_equal(d->faces, 2);
  assert_int_equal(d->vertices, 6);
  assert_true(d->positions[7] == 2.5f && d->positions[17] == -1);
  end_load(&l);
  /* Binary, by its length, though it begins with "solid"; also with bytes after the facets. */
  for (size_t more = 0; more < 7; more += 6) {
    uint8_t data[84 + 50 + 6] = "solid";
    const float facet[12] = {9, 9, 9, 0, 0, 0, 3, 0, 0, 0, 4, 5};
    data[80] = 1;
    if (more)
      data[0] = 'x';
    memcpy(data + 84, facet, sizeof facet);
    l = load("b.stl", data, 84 + 50 + more);
    d = shape(&l);
    assert_int_equal(d->faces, 1);
    assert_true(d->positions[3] == 3 && d->positions[8] == 5);
    end_load(&l);
  }
  expect_error("c.stl", "solid\nfacet\nouter loop\nvertex 0 0 0\nvertex 1 0 zero\n", 5,
               "found \"zero\"");
  expect_error("d.stl", "solid\nfacet\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\n", 6,
               "must have 3 vertices");
  expect_error("e.stl", "solid\nfacet\nouter loop\nvertex 0 0 0\n", 5, "ends too early");
  expect_error("f.stl", "neither", 0, "neither");
  expect_error("g.stl", "solid nothing\nendsolid nothing\n", 0, "there is nothing to draw");
}

static void off(void **state) {
  (void)state;
  Loaded l = load_lines(
      "a.off",
      "OFF # comment\n5 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n\n0 0 1\n4 0 1 2 3\n3  0 1 4\n");
  const vlShapeDef *d = shape(&l);
  assert_int_equal(d->faces, 3);
  assert_int_equal(d->vertices, 5);
  assert_null(d->colors);
  end_load(&l);
  l = load_lines("b.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 255 0 0\n");
  d = shape(&l);
  assert_true(d->colors[0] == 1 && d->colors[1] == 0 && d->colors[3] == 1);
  end_load(&l);
  l = load_lines("c.off",
                 "CNOFF\n3 1 0\n0 0 0 0 0 1 0 .5 1 1\n1 0 0 0 0 1 0 0 0 1\n0 1 0 0 0 1 0 0 0 "
                 "1\n3 0 1 2\n");
  d = shape(&l);
  assert_true(d->normals[2] == 1 && fabs((double)d->colors[1] - 0.2140) < 1e-3 &&
              d->colors[2] == 1);
  end_load(&l);
  l = load_lines(
      "s.off",
      "STCOFF\n3 1 0\n0 0 0 255 0 0 255 0 0\n1 0 0 255 0 0 255 1 0\n0 1 0 255 0 0 255 "
      ".25 .75\n3 0 1 2\n");
  d = shape(&l);
  assert_true(d->uvs[4] == 0.25f && d->uvs[5] == 0.75f && d->colors[0] == 1 &&
              d->colors[1] == 0);
  end_load(&l);
  expect_error("t.off", "STOFF\n3 1 0\n0 0 0 0 0\n1 0 0 1\n", 4, "no texture coordinates");
  expect_error("u.off", "COFF\n3 1 0\n0 0 0 1 1 1\n1 0 0 1 1\n", 4, "no colour");
  expect_error("d.off", "OF\n", 1, "must begin with OFF");
  expect_error("e.off", "OFF BINARY\n", 1, "binary");
  expect_error("f.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", 6, "not there");
  expect_error("g.off", "OFF\n900000 1 0\n0 0 0\n", 2, "too short");
  expect_error("h.off", "OFF\n3 1 0\n0 0 0\n1 0 x\n", 4, "found \"x\"");
}

#define VERTICES(n)                          \
  "ply\nformat ascii 1.0\nelement vertex " n \
  "\nproperty float x\nproperty float y\nproperty float z\n"
#define SQUARE "0 0 0\n1 0 0\n0 1 0\n1 1 0\n"

/* Strips turn every second triangle over, so that all look to +z. */
static void strips(void **state) {
  (void)state;
  Loaded l = load_lines(
      "a.ply",
      VERTICES(
          "4") "element tristrips 1\nproperty list int int vertex_indices\nend_header\n" SQUARE
               "8 0 1 2 3 -1 0 1 2\n");
  const vlShapeDef *d = shape(&l);
  assert_int_equal(d->faces, 3);
  for (uint32_t i = 0; i < 3; i++) {
    const float *p[3];
    for (uint32_t k = 0; k < 3; k++)
      p[k] = d->positions + 3 * d->indices[3 * i + k];
    assert_true((p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) >
                (p[1][1] - p[0][1]) * (p[2][0] - p[0][0]));
  }
  end_load(&l);
  expect_error(
      "b.ply",
      VERTICES(
          "4") "element tristrips 1\nproperty list int int vertex_indices\nend_header\n" SQUARE
               "3 0 1 4\n",
      14, "names vertex 4");
  /* before faces, which follow them */
  l = load_lines(
      "c.ply",
      VERTICES("4") "element tristrips 1\nproperty list int int vertex_indices\n"
                    "element face 1\nproperty list uchar int vertex_indices\nend_header\n" SQUARE
                    "3 0 1 2\n3 1 3 2\n");
  d = shape(&l);
  assert_int_equal(d->faces, 2);
  assert_int_equal(d->indices[0], 0);
  assert_int_equal(d->indices[3], 1);
  end_load(&l);
}

/* Far from the origin the transform has what single precision would lose, also where the
 * vertices are made anew: of faces with colours, and of points. */
static void far_meshes(void **state) {
  (void)state;
  static const struct {
    const char *name, *text;
  } files[] = {
      {"a.off", "OFF\n3 1 0\n5000000 0 0\n5000001 0 0\n5000000 1 0\n3 0 1 2 255 0 0\n"},
      {"b.ply", VERTICES("2") "end_header\n5000000 0 0\n5000001 0 0\n"},
      {"c.obj", "v 5000000 0 0\nv 5000001 0 0\nv 5000000 1 0\nf 1 2 3\n"}};
  for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
    Loaded l = load_lines(files[i].name, files[i].text);
    const vlShapeDef *d = shape(&l);
    assert_near(d->group_from_shape[3], 5e6, 1);
    assert_near(d->positions[0] + (float)(d->group_from_shape[3] - 5e6), 0, 0.1);
    end_load(&l);
  }
}

static void face_colors(void **state) {
  (void)state;
  Loaded l = load_lines("a.ply", VERTICES("4") "element face 2\nproperty uchar red\nproperty list uchar int vertex_indices\n"
                                               "property uchar green\nproperty uchar blue\nend_header\n" SQUARE
                                               "255 4 0 1 3 2 0 0\n0 3 0 2 1 0 255\n");
  const vlShapeDef *d = shape(&l);
  assert_int_equal(d->faces, 3);
  assert_int_equal(d->vertices, 9);
  for (uint32_t i = 0; i < 9; i++) {
    const float *c = d->colors + 4 * d->indices[i];
    assert_true(c[0] == (i < 6) && c[1] == 0 && c[2] == (i >= 6) && c[3] == 1);
  }
  end_load(&l);
}

/* A grid of 20 x 20 points: their size is that of the grid's cells. */
static void clouds(void **state) {
  (void)state;
  for (int normals = 0; normals < 2; normals++) {
    char *text = malloc(40000);
    size_t n = (size_t)sprintf(
        text,
        VERTICES(
            "400") "%sproperty uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n",
        normals ? "property float nx\nproperty float ny\nproperty float nz\n" : "");
    for (int i = 0; i < 400; i++)
      n += (size_t)sprintf(text + n, "%d %d 0 %s 255 0 0\n", i % 20, i / 20,
                           normals ? "0 0 2" : "");
    Loaded l = load("a.ply", text, n);
    free(text);
    const vlShapeDef *d = shape(&l);
    assert_int_equal(d->faces, normals ? 1600 : 3200);
    double far = 0;
    for (uint32_t i = 0; i < 6; i++) {
      const float *p = d->positions + 3 * i, *m = d->normals + 3 * i;
      far = fmax(far, sqrt((double)(p[0] * p[0] + p[1] * p[1] + p[2] * p[2])));
      if (normals)
        assert_true(fabs((double)p[2]) < 1e-6 && m[2] == 2);
      assert_true(d->colors[4 * i] == 1 && d->colors[4 * i + 1] == 0);
    }
    assert_true(far > 0.5 && far < 1.1); /* at most 1/50 of the diagonal, 26.9 */
    assert_non_null(strstr(l.log, normals ? "discs of radius" : "balls of radius"));
    end_load(&l);
  }
  /* In a scene of pbrt a mesh needs faces. */
  Loaded l = load_lines("b.ply", VERTICES("1") "end_header\n0 0 0\n");
  assert_int_equal(l.result, VL_OK);
  end_load(&l);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(stl),        cmocka_unit_test(off),         cmocka_unit_test(strips),
      cmocka_unit_test(far_meshes), cmocka_unit_test(face_colors), cmocka_unit_test(clouds)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
