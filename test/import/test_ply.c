/* test/import/test_ply.c: PLY files of all kinds, valid and invalid. */
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

#include "import/load.h"
#include "import/ply/ply.h"
#include "velo/shape_kinds.h"

static vlContext *context;
static const vlPlyOptions plain; /* a file that a scene names */

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

/* ---- writing ----------------------------------------------------------------------------- */

typedef struct Buffer {
  char data[4096];
  size_t size;
  int format; /* 0 ascii, 1 little, 2 big */
} Buffer;

static void say(Buffer *b, const char *text) {
  b->size += (size_t)snprintf(b->data + b->size, sizeof b->data - b->size, "%s", text);
}

static void put_bytes(Buffer *b, const void *data, size_t n) {
  for (size_t i = 0; i < n; i++)
    b->data[b->size++] = ((const char *)data)[b->format == 2 ? n - 1 - i : i];
}

static void put(Buffer *b, const char *type, double v) {
  if (b->format == 0) {
    b->size += (size_t)snprintf(b->data + b->size, sizeof b->data - b->size, "%.9g ", v);
    return;
  }
#define AS(name, T)              \
  if (strcmp(type, name) == 0) { \
    T x = (T)v;                  \
    put_bytes(b, &x, sizeof x);  \
    return;                      \
  }
  AS("char", int8_t);
  AS("uchar", uint8_t);
  AS("short", int16_t);
  AS("ushort", uint16_t);
  AS("int", int32_t);
  AS("uint", uint32_t);
  AS("float", float);
  AS("double", double);
#undef AS
  fail();
}

static const char *const formats[] = {"ascii", "binary_little_endian", "binary_big_endian"};

/* A pyramid: 5 vertices; a quad, four triangles and a pentagon that repeats a corner line, with
 * things to skip between. */
static void write_pyramid(Buffer *b, int format, const char *real, const char *index,
                          const char *count, bool rich) {
  static const float p[5][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5f, 0.5f, 1}};
  static const int faces[6][6] = {{4, 0, 1, 2, 3}, {3, 0, 1, 4}, {3, 1, 2, 4},
                                  {3, 2, 3, 4},    {3, 3, 0, 4}, {5, 0, 1, 2, 3, 4}};
  char line[256];
  *b = (Buffer){.format = format};
  say(b, "ply\nformat ");
  say(b, formats[format]);
  say(b, " 1.0\ncomment made by hand\nobj_info nothing\nelement vertex 5\n");
  if (rich)
    say(b, "property uchar red\n");
  snprintf(line, sizeof line, "property %s z\nproperty %s x\nproperty %s y\n", real, real,
           real);
  say(b, line);
  if (rich)
    say(b,
        "property list uchar int marks\nproperty float nx\nproperty float ny\nproperty float "
        "nz\nproperty double "
        "s\nproperty float t\nelement edge 2\nproperty int a\nproperty list ushort double w\n");
  snprintf(line, sizeof line, "element face 6\nproperty list %s %s %s\n", count, index,
           rich ? "vertex_indices" : "vertex_index");
  say(b, line);
  if (rich)
    say(b, "property int face_indices\n");
  say(b, "end_header\n");
  for (int i = 0; i < 5; i++) {
    if (rich)
      put(b, "uchar", 200);
    put(b, real, (double)p[i][2]);
    put(b, real, (double)p[i][0]);
    put(b, real, (double)p[i][1]);
    if (rich) {
      put(b, "uchar", i);
      for (int k = 0; k < i; k++)
        put(b, "int", -k);
      put(b, "float", 0);
      put(b, "float", 0);
      put(b, "float", 1);
      put(b, "double", i * 0.25);
      put(b, "float", 0.5);
    }
    if (format == 0)
      say(b, i % 2 ? "\r\n" : "\n");
  }
  for (int i = 0; rich && i < 2; i++) {
    put(b, "int", 7);
    put(b, "ushort", i);
    i ? put(b, "double", 1.5) : (void)0;
  }
  if (rich && format == 0)
    say(b, "\n");
  for (int i = 0; i < 6; i++) {
    put(b, count, faces[i][0]);
    for (int k = 1; k <= faces[i][0]; k++)
      put(b, index, faces[i][k]);
    if (rich)
      put(b, "int", i);
    if (format == 0)
      say(b, "\n");
  }
}

static void check_pyramid(const Buffer *b, bool rich) {
  vlMesh m;
  vlError error;
  vlResult result = vl_ply_parse(context, "p.ply", b->data, b->size, &plain, &m, &error);
  if (result != VL_OK)
    print_message("%s:%u: %s\n", error.file, error.line, error.message);
  assert_int_equal(result, VL_OK);
  assert_int_equal(m.vertices, 5);
  assert_int_equal(m.quads, 1);
  assert_int_equal(m.triangles, 4 + 3);
  const uint32_t quad[] = {0, 1, 3, 2}; /* p00 p10 p01 p11 */
  assert_memory_equal(m.quad_indices, quad, sizeof quad);
  const uint32_t triangles[] = {0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4, 0, 1, 2, 0, 2, 3, 0, 3, 4};
  assert_memory_equal(m.indices, triangles, sizeof triangles);
  assert_near(m.positions[14], 1, 0);
  assert_near(m.positions[9], 0, 0);
  assert_near(m.positions[10], 1, 0);
  assert_int_equal(m.normals != NULL, rich);
  assert_int_equal(m.uvs[0] != NULL, rich);
  if (rich) {
    assert_near(m.normals[5], 1, 0);
    assert_near(m.uvs[0][8], 1, 0);
    assert_near(m.uvs[0][9], 0.5, 0);
  }
  vl_mesh_free(context, &m);
}

static void every_format_and_type(void **state) {
  (void)state;
  static const char *const reals[] = {"float", "double"}, *const indices[] = {"int",   "uint",
                                                                              "short", "ushort",
                                                                              "char",  "uchar"},
                           *const counts[] = {"uchar", "int", "ushort", "uint"};
  Buffer b;
  for (int f = 0; f < 3; f++)
    for (int r = 0; r < 2; r++)
      for (int i = 0; i < 6; i++)
        for (int c = 0; c < 4; c++)
          for (int rich = 0; rich < 2; rich++) {
            write_pyramid(&b, f, reals[r], indices[i], counts[c], rich);
            check_pyramid(&b, rich);
          }
}

/* Every cut of a good file is refused (or, past the last face, accepted), never read beyond. */
static void cut_short(void **state) {
  (void)state;
  for (int f = 0; f < 3; f++) {
    Buffer b;
    write_pyramid(&b, f, "float", "int", "uchar", true);
    for (size_t n = 0; n < b.size; n++) {
      char *copy = malloc(n + 1);
      memcpy(copy, b.data, n);
      copy[n] = 0;
      vlMesh m;
      vlError error;
      vlResult result = vl_ply_parse(context, "p.ply", copy, n, &plain, &m, &error);
      if (result == VL_OK)
        assert_true(f == 0 && n + 3 > b.size);
      else
        assert_int_equal(result, VL_ERROR_SCENE);
      vl_mesh_free(context, &m);
      free(copy);
    }
  }
}

#define HEAD                                                                               \
  "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty " \
  "float "                                                                                 \
  "z\nelement face "                                                                       \
  "1\nproperty list uchar int vertex_indices\nend_header\n"

static const struct {
  const char *text, *error;
} mistakes[] = {
    {"", "p.ply:1:1: PLY: the file does not begin with \"ply\""},
    {"plx\n", "p.ply:1:1: PLY: the file does not begin with \"ply\""},
    {"ply\nformat ascii 1.0\n", "p.ply:2:1: PLY: the header has no end_header"},
    {"ply\nend_header\n", "p.ply:2:1: PLY: the header has no format line"},
    {"ply\nformat binary 1.0\n",
     "p.ply:2:1: PLY: unknown format \"binary\" (known: ascii, binary_little_endian, "
     "binary_big_endian)"},
    {"ply\nformat ascii 1.0\nelement vertex many\n",
     "p.ply:3:1: PLY: element vertex: \"many\" is not a count"},
    {"ply\nformat ascii 1.0\nelement vertex -3\n",
     "p.ply:3:1: PLY: element vertex: \"-3\" is not a count"},
    {"ply\nformat ascii 1.0\nproperty float x\n",
     "p.ply:3:1: PLY: a property before any element"},
    {"ply\nformat ascii 1.0\nelement vertex 3\nproperty real x\n",
     "p.ply:4:1: PLY: unknown type \"real\""},
    {"ply\nformat ascii 1.0\nelement vertex 3\nelement vertex 3\n",
     "p.ply:4:1: PLY: element vertex appears twice"},
    {"ply\nformat ascii 1.0\nbanana\n",
     "p.ply:3:1: PLY: unknown word \"banana\" in the header"},
    {"ply\nformat ascii 1.0\nelement face 1\nproperty list float int vertex_indices\n",
     "p.ply:4:1: PLY: the length of a list must be of an integer type"},
    {"ply\nformat ascii 1.0\nelement face 1\nproperty list uchar float vertex_indices\n",
     "p.ply:4:1: PLY: vertex_indices must be of an integer type"},
    {"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n1\n",
     "p.ply:6:1: PLY: vertices have no x, y and z"},
    {HEAD "0 0 0\n1 0 0\n0 one 0\n3 0 1 2\n",
     "p.ply:12:1: PLY: expected a number, found \"one\""},
    {HEAD "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n",
     "p.ply:13:1: PLY: face 0 names vertex 3, but there are 3 vertices"},
    {HEAD "0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n",
     "p.ply:13:1: PLY: face 0 names vertex -1, but there are 3 vertices"},
    {HEAD "0 0 0\n1 0 0\n0 1 0\n-3 0 1 2\n", "p.ply:13:1: PLY: -3 is not the length of a list"},
    {HEAD "0 0 0\n1 0 0\n0 1 0\n9 0 1 2\n",
     "p.ply:13:1: PLY: a list promises 9 values, but only 7 bytes follow"},
    {HEAD "0 0 0\n1 0 0\n0 1 0\n3 0 1\n", "p.ply:14:1: PLY: the file ends too early"},
    {HEAD "0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n",
     "p.ply:11:1: PLY: vertex 1: y is not finite (nan)"},
    {HEAD "0 0 0\n1 0 0\n0 1 -inf\n3 0 1 2\n",
     "p.ply:12:1: PLY: vertex 2: z is not finite (inf)"},
    {HEAD "0 0 0\n1 0 1e40\n0 1 0\n3 0 1 2\n",
     "p.ply:11:1: PLY: vertex 1: z is not finite (1e+40)"},
    {HEAD "0 0 0\n1 0 0\n0 1 0\n2 0 1\n", "p.ply:0:0: PLY: the mesh has no faces"},
    {"ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty "
     "float z\nend_header\n",
     "p.ply:0:0: PLY: the mesh has no vertices"},
    {"ply\nformat ascii 1.0\nelement vertex 2147483648\nproperty float x\nproperty float "
     "y\nproperty float z\nelement "
     "face 1\nproperty list uchar int vertex_indices\nend_header\n",
     "p.ply:10:1: PLY: the header promises 2147483648 of element vertex, but only 0 bytes "
     "follow"},
    {"ply\nformat binary_little_endian 1.0\nelement vertex 2147483648\nproperty float "
     "x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int "
     "vertex_indices\nend_header\n",
     "p.ply:0:0: PLY: the header promises 2147483648 of element vertex, but only 0 bytes "
     "follow"},
    {"ply\nformat binary_little_endian 1.0\nelement face 999999999999999999999\nproperty "
     "list uchar int vertex_indices\nend_header\nabc",
     "p.ply:3:1: PLY: element face: \"999999999999…\" is not a count"},
};

static void bad_files(void **state) {
  (void)state;
  size_t wrong = 0;
  for (size_t i = 0; i < sizeof mistakes / sizeof *mistakes; i++) {
    vlMesh m;
    vlError error;
    char said[1200];
    size_t before, peak;
    before = vl_context_memory(context, NULL);
    vlResult result = vl_ply_parse(context, "p.ply", mistakes[i].text, strlen(mistakes[i].text),
                                   &plain, &m, &error);
    snprintf(said, sizeof said, "%s:%u:%u: %s", error.file, error.line, error.column,
             error.message);
    if (result != VL_ERROR_SCENE || strcmp(said, mistakes[i].error) != 0) {
      print_message("file:\n%s\n said: %s\n not:  %s\n", mistakes[i].text, said,
                    mistakes[i].error);
      wrong++;
    }
    assert_int_equal(vl_context_memory(context, &peak), before);
    assert_true(peak < 1 << 20);
  }
  assert_int_equal(wrong, 0);
}

/* A promise costs no time either. */
static void promises_are_refused_at_once(void **state) {
  (void)state;
  const char *text = mistakes[sizeof mistakes / sizeof *mistakes - 2].text;
  vlMesh m;
  struct timespec a, b;
  clock_gettime(CLOCK_MONOTONIC, &a);
  for (int i = 0; i < 1000; i++)
    assert_int_equal(vl_ply_parse(context, "p.ply", text, strlen(text), &plain, &m, NULL),
                     VL_ERROR_SCENE);
  clock_gettime(CLOCK_MONOTONIC, &b);
  double seconds = (double)(b.tv_sec - a.tv_sec) + 1e-9 * (double)(b.tv_nsec - a.tv_nsec);
  assert_true(seconds < 2.0); /* 2 ms each at the very most; some 10 microseconds in truth */
}

/* Damaged files: any answer but a crash; sanitizers watch. */
static void damaged(void **state) {
  (void)state;
  uint64_t random = 99;
  for (int f = 0; f < 3; f++) {
    Buffer b;
    write_pyramid(&b, f, "float", "int", "uchar", true);
    for (int i = 0; i < 4000; i++) {
      char *copy = malloc(b.size + 1);
      memcpy(copy, b.data, b.size);
      copy[b.size] = 0;
      for (int k = 0; k < 3; k++) {
        random = random * 6364136223846793005ull + 1442695040888963407ull;
        copy[(random >> 33) % b.size] = (char)(random >> 17);
      }
      vlMesh m;
      vlError error;
      if (vl_ply_parse(context, "p.ply", copy, b.size, &plain, &m, &error) == VL_OK)
        vl_mesh_free(context, &m);
      free(copy);
    }
  }
}

/* Quads and triangles of one file become two shapes with the same material and place. */
static void through_a_scene(void **state) {
  (void)state;
  Buffer b;
  write_pyramid(&b, 1, "float", "int", "uchar", true);
  char path[64] = "/tmp/velo-ply-XXXXXX", text[256];
  int fd = mkstemp(path);
  assert_true(fd >= 0 && write(fd, b.data, b.size) == (ssize_t)b.size);
  close(fd);
  Loaded l;
  snprintf(text, sizeof text,
           "WorldBegin Translate 1 2 3 Material \"dielectric\" Shape \"plymesh\" "
           "\"string filename\" \"%s\" \"float alpha\" .5",
           path);
  load_fine(&l, text);
  assert_int_equal(l.scene->shapes.count, 2);
  for (int i = 0; i < 2; i++) {
    const vlShapeDef *s = &l.scene->shapes.items[i];
    assert_int_equal(s->kind, i ? VL_SHAPE_TRIANGLES : VL_SHAPE_BILINEAR);
    assert_int_equal(s->material.index, 1);
    assert_int_equal(s->vertices, 5);
    assert_near(s->group_from_shape[7], 2, 0);
    assert_near(s->alpha.value, .5, 0);
    assert_near(s->positions[14], 1, 0);
  }
  end_load(&l);
  unlink(path);
}

/* The first step of the load makes the request, the next one finds it: the rows of one file are
 * not read to the end. */
static bool request(void *user, const vlStep *step) {
  (void)step;
  vl_cancel_request(user);
  return true;
}

static void a_file_stops(void **state) {
  (void)state;
  char path[64] = "/tmp/velo-ply-XXXXXX";
  int fd = mkstemp(path);
  FILE *f = fd < 0 ? NULL : fdopen(fd, "w");
  assert_non_null(f);
  fprintf(f,
          "ply\nformat ascii 1.0\nelement vertex 20000\nproperty double x\nproperty double "
          "y\nproperty double z\n"
          "element face 1\nproperty list uchar int vertex_indices\nend_header\n");
  for (int i = 0; i < 20000; i++)
    fprintf(f, "%d 0 %d\n", i, i % 7);
  fprintf(f, "3 0 1 2\n");
  fclose(f);
  vlCancel *cancel;
  vlTask task;
  const vlPlyOptions options = {.task = &task};
  vlMesh mesh;
  vlError error;
  assert_int_equal(vl_cancel_create(context, &cancel), VL_OK);
  vl_task_start(&task, cancel, request, cancel);
  assert_int_equal(vl_ply_read(context, path, &options, &mesh, &error), VL_CANCELLED);
  assert_null(mesh.positions);
  vl_cancel_clear(cancel);
  vl_task_start(&task, cancel, NULL, NULL);
  assert_int_equal(vl_ply_read(context, path, &options, &mesh, &error), VL_OK);
  assert_int_equal(mesh.vertices, 20000);
  vl_mesh_free(context, &mesh);
  vl_cancel_destroy(cancel);
  unlink(path);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_file_stops),
      cmocka_unit_test(every_format_and_type),
      cmocka_unit_test(cut_short),
      cmocka_unit_test(bad_files),
      cmocka_unit_test(promises_are_refused_at_once),
      cmocka_unit_test(damaged),
      cmocka_unit_test(through_a_scene),
  };
  return cmocka_run_group_tests(tests, open_context, close_context);
}
