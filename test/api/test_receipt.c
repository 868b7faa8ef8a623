/* test/api/test_receipt.c: receipts store exact values, comparisons find every difference, and
 * damaged receipts are refused. */
/* cmocka.h needs the four headers above */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/digest.h"
#include "failing_allocator.h"
#include "unit.h"
#include "velo/projection.h"
#include "velo/receipt.h"
#include "velo/render.h"
#include "velo/tracer.h"

typedef struct Fixture {
  vlContext *context;
  vlScene *scene;
} Fixture;

static int set_up(void **state) {
  Fixture *f = calloc(1, sizeof *f);
  vlContextDef def = vl_default_context_def();
  def.threads = 1;
  if (!f || vl_context_create(&def, &f->context) != VL_OK ||
      vl_scene_create(f->context, &f->scene) != VL_OK)
    return 1;
  *state = f;
  return 0;
}

static int tear_down(void **state) {
  Fixture *f = *state;
  vl_scene_destroy(f->scene);
  vl_context_destroy(f->context);
  free(f);
  return 0;
}

static void write_file(const char *path, const char *text) {
  FILE *file = fopen(path, "wb");
  assert_non_null(file);
  assert_int_equal(fwrite(text, 1, strlen(text), file), strlen(text));
  fclose(file);
}

static vlReceipt *make(Fixture *f, const vlReceiptDef *def) {
  vlReceipt *receipt = NULL;
  vlError error = {0};
  assert_int_equal(vl_receipt_make(f->context, def, &receipt, &error), VL_OK);
  return receipt;
}

static vlReceipt *parse(Fixture *f, const char *text) {
  vlReceipt *receipt = NULL;
  vlError error = {0};
  assert_int_equal(vl_receipt_parse(f->context, text, strlen(text), &receipt, &error), VL_OK);
  return receipt;
}

typedef struct Lines {
  char text[4000];
  uint32_t left; /* number of differences after which the callback ends the comparison */
} Lines;

static bool add_line(void *user, const char *line) {
  Lines *lines = user;
  size_t n = strlen(lines->text);
  snprintf(lines->text + n, sizeof lines->text - n, "%s\n", line);
  return lines->left-- > 1;
}

/* Returns all differences of two receipts, one per line. */
static const char *differences(const vlReceipt *then, const vlReceipt *now, uint32_t parts) {
  static Lines lines;
  lines = (Lines){.left = 1000};
  uint32_t count = vl_receipt_compare(then, now, parts, add_line, &lines), found = 0;
  for (const char *c = lines.text; *c; c++)
    found += *c == '\n';
  assert_int_equal(count, found);
  assert_int_equal(vl_receipt_compare(then, now, parts, NULL, NULL), count);
  return lines.text;
}

/* The published values of MurmurHash3_x64_128 for seed 0, and distinct digests for inputs of 0
 * to 63 bytes. */
static void digests_are_murmur3(void **state) {
  (void)state;
  static const struct {
    const char *text, *digest;
  } known[] = {
      {"", "00000000000000000000000000000000"},
      {"hello", "cbd8a7b341bd9b025b1e906a48ae1d19"},
      {"The quick brown fox jumps over the lazy dog", "e34bbc7bbc071b6c7a433ca9c49a9347"}};
  for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
    uint8_t digest[16];
    char text[33];
    vl_digest(known[i].text, strlen(known[i].text), digest);
    vl_digest_text(digest, text);
    assert_string_equal(text, known[i].digest);
  }
  uint8_t bytes[64] = {0}, seen[64][16];
  for (size_t n = 0; n < 64; n++) {
    vl_digest(bytes, n, seen[n]);
    for (size_t k = 0; k < n; k++)
      assert_memory_not_equal(seen[n], seen[k], 16);
  }
}

static void files_are_recorded(void **state) {
  Fixture *f = *state;
  char folder[] = "/tmp/velo-receipt-XXXXXX", scene[100], part[100];
  assert_non_null(mkdtemp(folder));
  snprintf(scene, sizeof scene, "%s/room.pbrt", folder);
  snprintf(part, sizeof part, "%s/part.pbrt", folder);
  write_file(scene,
             "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\nCamera "
             "\"perspective\"\n"
             "WorldBegin\nInclude \"part.pbrt\"\n");
  write_file(part, "Shape \"sphere\"\n");
  vl_context_record_files(f->context, true);
  vlError error = {0};
  assert_int_equal(vl_scene_load(f->scene, scene, NULL, &error), VL_OK);
  vl_context_record_files(f->context, false);

  vlReceiptDef def = vl_default_receipt_def();
  def.defs = vl_scene_defs(f->scene);
  def.scene = scene;
  vlReceipt *then = make(f, &def);
  vlFileRecord record;
  assert_string_equal(vl_receipt_file(then, 0, &record)->path, "part.pbrt");
  assert_int_equal(record.size, strlen("Shape \"sphere\"\n"));
  uint8_t digest[16];
  vl_digest("Shape \"sphere\"\n", 15, digest);
  assert_memory_equal(record.digest, digest, 16);
  assert_string_equal(vl_receipt_file(then, 1, &record)->path, "room.pbrt");
  assert_null(vl_receipt_file(then, 2, &record));

  write_file(part, "Shape \"disk\"\n");
  vl_context_record_files(f->context, true);
  vlScene *again;
  assert_int_equal(vl_scene_create(f->context, &again), VL_OK);
  assert_int_equal(vl_scene_load(again, scene, NULL, &error), VL_OK);
  vlReceipt *now = make(f, &def);
  assert_string_equal(differences(then, now, VL_RECEIPT_ALL), "the file part.pbrt changed\n");
  assert_string_equal(differences(then, now, VL_RECEIPT_ALL & ~VL_RECEIPT_FILES), "");
  vl_scene_destroy(again);
  vl_receipt_destroy(then);
  vl_receipt_destroy(now);
  unlink(scene);
  unlink(part);
  rmdir(folder);
}

/* Numbers that are easily changed by a conversion to text and back. */
static const double awkward[] = {0.1,           -0.0,       1.0 / 3.0, 1e-300,
                                 6.02214076e23, 12345678.9, 5e-324};

static void numbers_are_exact(void **state) {
  Fixture *f = *state;
  vlSceneDefs *defs = vl_scene_defs(f->scene);
  vlCameraDef *camera = &defs->camera;
  for (size_t i = 0; i < sizeof awkward / sizeof *awkward; i++) {
    camera->has_matrix = true;
    for (int k = 0; k < 16; k++)
      camera->world_from_camera[k] = awkward[(i + (size_t)k) % 7];
    /* a camera has no other */
    camera->focus_distance = awkward[i] > 0 ? awkward[i] : 2.0 / 3.0;
    /* less than a right angle; turns -0 into 0 */
    camera->lens.tilt_x = fmod(awkward[(i + 1) % 7], 1.5) + 0.0;
    defs->film.filter.sigma = (float)awkward[i];
    vlReceiptDef def = vl_default_receipt_def();
    def.defs = defs;
    vlReceipt *made = make(f, &def), *read = parse(f, vl_receipt_text(made));
    assert_string_equal(vl_receipt_text(made), vl_receipt_text(read));
    assert_string_equal(differences(made, read, VL_RECEIPT_ALL), "");
    vlCameraDef back;
    uint32_t size[2], crop[4];
    vlError error = {0};
    if (vl_receipt_camera(read, &back, size, crop, &error) != VL_OK)
      fail_msg("%s", error.message);
    assert_memory_equal(back.world_from_camera, camera->world_from_camera,
                        sizeof back.world_from_camera);
    assert_memory_equal(&back.focus_distance, &camera->focus_distance, sizeof(double));
    assert_memory_equal(&back.lens.tilt_x, &camera->lens.tilt_x, sizeof(double));
    assert_int_equal(size[0], defs->film.width);
    assert_int_equal(crop[3], defs->film.crop[3]);
    defs->film.filter.sigma = nextafterf((float)awkward[i], 1.0f);
    vlReceipt *other = make(f, &def);
    assert_true(strncmp(differences(made, other, VL_RECEIPT_ALL), "film differs: filter.sigma ",
                        27) == 0);
    vl_receipt_destroy(made);
    vl_receipt_destroy(read);
    vl_receipt_destroy(other);
  }
}

/* A receipt that lacks a switch differs only where the switch is on. */
static void switches_of_later_versions(Fixture *f, vlReceiptDef def) {
  vlCompleteDef complete = *def.complete;
  def.complete = &complete;
  vlReceipt *off = make(f, &def);
  char *text = strdup(vl_receipt_text(off)), *at = strstr(text, "\"both_sides\"");
  assert_non_null(at);
  const char *after = strstr(at, "false") + 5;
  while (*at != ',')
    at--;
  memset(at, ' ', (size_t)(after - at));
  vlReceipt *before = parse(f, text);
  assert_string_equal(differences(before, off, VL_RECEIPT_ALL), "");
  complete.both_sides = true;
  vlReceipt *on = make(f, &def);
  assert_string_equal(differences(before, on, VL_RECEIPT_ALL),
                      "completed differs: both_sides is true, was not given\n");
  free(text);
  vl_receipt_destroy(off);
  vl_receipt_destroy(before);
  vl_receipt_destroy(on);
}

static void differences_are_named(void **state) {
  Fixture *f = *state;
  static const char *const words[] = {"render", "a.pbrt"};
  vlSceneDefs *defs = vl_scene_defs(f->scene);
  vlLoadDef load = vl_default_load_def();
  vlCompleteDef complete = vl_default_complete_def();
  vlReceiptDef def = vl_default_receipt_def();
  def.defs = defs;
  def.load = &load;
  def.complete = &complete;
  def.commit = "0123456789ab";
  def.command = words;
  def.command_count = 2;
  def.samples = 16;
  def.scene = "a.pbrt";
  defs->render.spp = 16;
  defs->camera.fov = 0.6;
  vlReceipt *then = make(f, &def);
  assert_string_equal(vl_receipt_command(then, 1), "a.pbrt");
  assert_null(vl_receipt_command(then, 2));
  assert_string_equal(vl_receipt_scene(then), "a.pbrt");
  const char *commit;
  assert_string_equal(vl_receipt_version(then, &commit), vl_version()->text);
  assert_string_equal(commit, "0123456789ab");

  defs->render.spp = def.samples = 64;
  defs->render.tracer = VL_TRACER_SPPM;
  defs->build.color = VL_COLOR_RGB;
  defs->camera.fov = 0.5;
  defs->develop.exposure = 2;
  load.variant = "red";
  complete.ground = true;
  def.commit = "ba9876543210";
  vlReceipt *now = make(f, &def);
  assert_string_equal(
      differences(then, now, VL_RECEIPT_ALL),
      "velo's commit is ba9876543210, was 0123456789ab\ncamera differs: fov is 0.5, was 0.6\n"
      "load differs: variant is red, was not given\ncompleted differs: ground is true, was "
      "false\n"
      "build differs: color is rgb, was spectral\nrender differs: tracer is sppm, was volpath\n"
      "spp is 64, was 16\nsamples is 64, was 16\ndevelop differs: exposure is 2.0, was 1.0\n");
  assert_string_equal(differences(then, now, VL_RECEIPT_SAMPLES),
                      "spp is 64, was 16\nsamples is 64, was 16\n");
  assert_string_equal(differences(now, now, VL_RECEIPT_ALL), "");
  complete.ground = false;
  switches_of_later_versions(f, def);
  uint32_t planned;
  assert_int_equal(vl_receipt_samples(now, &planned), 64);
  assert_int_equal(planned, 64);
  Lines lines = {.left = 2};
  assert_int_equal(vl_receipt_compare(then, now, VL_RECEIPT_ALL, add_line, &lines), 2);
  vl_receipt_destroy(then);
  vl_receipt_destroy(now);
}

static void long_values_are_cut(void **state) {
  Fixture *f = *state;
  char long_text[900] = "{\"velo_receipt\": 1, \"scene\": [\"";
  memset(long_text + strlen(long_text), 'x', 600);
  strcat(long_text, "\"]}");
  vlReceipt *then = parse(f, "{\"velo_receipt\": 1, \"scene\": \"a\"}"),
            *now = parse(f, long_text);
  const char *text = differences(then, now, VL_RECEIPT_ALL),
             *end = strstr(text, "xxx..., was a\n");
  assert_non_null(end);
  assert_int_equal(strlen(text), strlen("scene is ") + 119 + strlen(", was a\n"));
  assert_int_equal(strncmp(text, "scene is [\"xxx", 14), 0);
  vl_receipt_destroy(then);
  vl_receipt_destroy(now);
}

/* No difference shows a value as nothing. */
static void empty_values_are_shown(void **state) {
  Fixture *f = *state;
  static const char *const empty[] = {"\"\"", "\" \"", "[]", "{}"};
  vlReceipt *other = parse(f, "{\"velo_receipt\": 1, \"scene\": \"a\"}");
  for (size_t i = 0; i < sizeof empty / sizeof *empty; i++) {
    char text[80], is[80], was[80];
    snprintf(text, sizeof text, "{\"velo_receipt\": 1, \"scene\": %s}", empty[i]);
    snprintf(is, sizeof is, "scene is %s, was a\n", empty[i]);
    snprintf(was, sizeof was, "scene is a, was %s\n", empty[i]);
    vlReceipt *receipt = parse(f, text);
    assert_string_equal(differences(other, receipt, VL_RECEIPT_ALL), is);
    assert_string_equal(differences(receipt, other, VL_RECEIPT_ALL), was);
    vl_receipt_destroy(receipt);
  }
  vl_receipt_destroy(other);
}

/* What camera files cannot hold has a name in receipts. */
static void every_projection_has_a_name(void **state) {
  Fixture *f = *state;
  vlReceiptDef def = vl_default_receipt_def();
  vlSceneDefs *defs = vl_scene_defs(f->scene);
  def.defs = defs;
  for (vlProjection p = VL_PROJECTION_PERSPECTIVE; p <= VL_PROJECTION_OWN; p++) {
    if (p == VL_PROJECTION_OPTICS)
      continue; /* needs a lens; it has a name in the same way as VL_PROJECTION_OWN */
    defs->camera.projection = p;
    vlReceipt *receipt = make(f, &def);
    assert_null(strstr(vl_receipt_text(receipt), "\"projection\":\"\""));
    assert_non_null(strstr(vl_receipt_text(receipt), "\"projection\":\""));
    vl_receipt_destroy(receipt);
  }
}

static void a_film_has_the_receipt_of_its_image(void **state) {
  Fixture *f = *state;
  static const char *const words[2][5] = {{"velo", "render", "a.pbrt", "--spp", "16"},
                                          {"velo", "render", "a.pbrt", "--spp", "64"}};
  static const char *const outputs[] = {"a.exr"};
  vlSceneDefs *defs = vl_scene_defs(f->scene);
  vlReceiptDef def = vl_default_receipt_def();
  def.defs = defs;
  def.scene = "a.pbrt";
  def.command_count = 5;
  def.command = words[0];
  def.samples = defs->render.spp = 16;
  def.outputs = outputs;
  def.output_count = 1;
  vlReceipt *film = make(f, &def), *image = NULL;
  assert_string_equal(vl_receipt_output(film, 0), "a.exr");
  def.command = words[1];
  def.samples = defs->render.spp = 64;
  def.outputs = NULL;
  vlReceipt *straight = make(f, &def);
  assert_int_equal(vl_receipt_of_image(film, 64, &image, NULL), VL_OK);
  assert_string_equal(vl_receipt_text(image), vl_receipt_text(straight));
  vl_receipt_destroy(image);
  vl_receipt_destroy(film);
  film = parse(f, vl_receipt_text(straight)); /* parsed from text, as if read from a file */
  assert_int_equal(vl_receipt_of_image(film, 64, &image, NULL), VL_OK);
  assert_string_equal(vl_receipt_text(image), vl_receipt_text(straight));
  vl_receipt_destroy(image);
  vl_receipt_destroy(film);
  vl_receipt_destroy(straight);
}

static void autofocus_is_in_the_camera(void **state) {
  Fixture *f = *state;
  vlSceneDefs *defs = vl_scene_defs(f->scene);
  defs->camera.lens_radius = 0.1;
  defs->camera.lens.focus_pixel[0] = defs->camera.lens.focus_pixel[1] = 5;
  vlReceiptDef def = vl_default_receipt_def();
  def.defs = defs;
  def.focus_distance = 7.25;
  vlReceipt *receipt = make(f, &def);
  vlCameraDef camera;
  assert_int_equal(vl_receipt_camera(receipt, &camera, NULL, NULL, NULL), VL_OK);
  assert_true(camera.focus_distance == 7.25);
  assert_true(isnan(camera.lens.focus_pixel[0]));
  vl_receipt_destroy(receipt);
}

static void wrong_receipts_are_refused(void **state) {
  Fixture *f = *state;
  static const struct {
    const char *text;
    vlResult result;
  } wrong[] = {{"", VL_ERROR_SCENE},
               {"{", VL_ERROR_SCENE},
               {"[]", VL_ERROR_SCENE},
               {"{\"velo_receipt\": \"1\"}", VL_ERROR_SCENE},
               {"{\"velo_receipt\": 0}", VL_ERROR_SCENE},
               {"{\"velo_receipt\": 2}", VL_ERROR_UNSUPPORTED},
               {"{\"velo_receipt\": 1, \"velo_receipt\": 1}", VL_ERROR_SCENE}};
  vlReceipt *receipt = NULL;
  vlError error;
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    assert_int_equal(
        vl_receipt_parse(f->context, wrong[i].text, strlen(wrong[i].text), &receipt, &error),
        wrong[i].result);
    assert_null(receipt);
    assert_true(error.message[0] != 0);
  }
  assert_int_equal(vl_receipt_make(f->context, NULL, &receipt, &error), VL_ERROR_ARGUMENT);
  vlReceiptDef def = vl_default_receipt_def();
  /* the def has no defs */
  assert_int_equal(vl_receipt_make(f->context, &def, &receipt, &error), VL_ERROR_ARGUMENT);
}

/* Members of a wrong type count as missing. */
static void wrong_members_are_missing(void **state) {
  Fixture *f = *state;
  vlReceipt *odd = parse(
      f,
      "{\"velo_receipt\": 1, \"velo\": 3, \"command\": {}, \"scene\": [], \"files\": [1, {}], "
      "\"camera\": [], \"film\": 1, \"render\": null, \"samples\": -5, \"outputs\": \"a\"}");
  vlReceipt *empty = parse(f, "{\"velo_receipt\": 1}");
  vlFileRecord record;
  vlCameraDef camera;
  vlError error;
  assert_null(vl_receipt_scene(odd));
  assert_null(vl_receipt_command(odd, 0));
  assert_null(vl_receipt_output(odd, 0));
  assert_null(vl_receipt_file(odd, 0, &record));
  assert_int_equal(vl_receipt_samples(odd, NULL), 0);
  assert_string_equal(vl_receipt_version(odd, NULL), "");
  assert_int_equal(vl_receipt_camera(odd, &camera, NULL, NULL, &error), VL_ERROR_SCENE);
  assert_int_equal(vl_receipt_camera(empty, &camera, NULL, NULL, &error), VL_ERROR_SCENE);
  assert_true(strstr(differences(empty, odd, VL_RECEIPT_ALL), "film is 1, was not given") !=
              NULL);
  assert_true(strstr(differences(odd, empty, VL_RECEIPT_ALL), "scene is not given, was []") !=
              NULL);
  vl_receipt_destroy(odd);
  vl_receipt_destroy(empty);
}

/* Reads a scene while files are recorded, makes its receipt, reads that receipt, and derives an
 * image's receipt from it. user: path of the scene. */
static vlResult all_of_it(vlContext *context, void *user) {
  vlScene *scene = NULL;
  vlReceipt *receipt = NULL, *read = NULL, *image = NULL;
  vlError error = {0};
  vlReceiptDef def = vl_default_receipt_def();
  def.scene = user;
  vl_context_record_files(context, true);
  vlResult result = vl_scene_create(context, &scene);
  if (result == VL_OK)
    result = vl_scene_load(scene, user, NULL, &error);
  if (result == VL_OK) {
    def.defs = vl_scene_defs(scene);
    result = vl_receipt_make(context, &def, &receipt, &error);
  }
  if (result == VL_OK)
    result = vl_receipt_parse(context, vl_receipt_text(receipt),
                              strlen(vl_receipt_text(receipt)), &read, &error);
  if (result == VL_OK)
    result = vl_receipt_of_image(read, 3, &image, &error);
  if (result == VL_OK)
    assert_non_null(strstr(vl_receipt_text(image), "\"files\":[{\"path\":\"one.pbrt\""));
  vl_receipt_destroy(receipt);
  vl_receipt_destroy(read);
  vl_receipt_destroy(image);
  vl_scene_destroy(scene);
  return result;
}

static void memory_may_run_out(void **state) {
  (void)state;
  char folder[] = "/tmp/velo-receipt-XXXXXX", scene[100];
  assert_non_null(mkdtemp(folder));
  snprintf(scene, sizeof scene, "%s/one.pbrt", folder);
  write_file(scene, "Camera \"perspective\"\nWorldBegin\nShape \"sphere\"\n");
  fail_everywhere(all_of_it, scene, 10);
  unlink(scene);
  rmdir(folder);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(digests_are_murmur3),
      cmocka_unit_test_setup_teardown(files_are_recorded, set_up, tear_down),
      cmocka_unit_test_setup_teardown(numbers_are_exact, set_up, tear_down),
      cmocka_unit_test_setup_teardown(differences_are_named, set_up, tear_down),
      cmocka_unit_test_setup_teardown(empty_values_are_shown, set_up, tear_down),
      cmocka_unit_test_setup_teardown(every_projection_has_a_name, set_up, tear_down),
      cmocka_unit_test_setup_teardown(long_values_are_cut, set_up, tear_down),
      cmocka_unit_test_setup_teardown(a_film_has_the_receipt_of_its_image, set_up, tear_down),
      cmocka_unit_test_setup_teardown(autofocus_is_in_the_camera, set_up, tear_down),
      cmocka_unit_test_setup_teardown(wrong_receipts_are_refused, set_up, tear_down),
      cmocka_unit_test_setup_teardown(wrong_members_are_missing, set_up, tear_down),
      cmocka_unit_test(memory_may_run_out),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
