/* test/raw/test_raw_files.c: raw files: DNG read back, with every metadata and pattern; the
 * same bytes each time; the other formats; files that are damaged; a failure of every
 * allocation. */
#include "sample_raw.h"

/* Whatever the numbers are, they come back to the last bit; the focal length nearly so. */
static void test_numbers_of_metadata(void **state) {
  (void)state;
  static const float times[] = {1e-6f, 1.0f / 8000.0f, 0.004f, 0.3f, 1.0f / 3.0f, 30.0f, 1e6f};
  static const float exposures[] = {-3.3f, -1.0f / 3.0f, 0.1f, 2.7f, 99.9f};
  vlContext *context = make_context(1);
  char path[1024];
  in_folder("metadata.dng", path);
  for (int i = 0; i < 35 && has_tiff(); i++) {
    vlRawDef def = vl_default_raw_def(2, 2);
    def.exposure_time = times[i % 7];
    def.f_number = 1.0f + 0.37f * (float)i;
    def.focal_length = 0.0013f * (float)(i + 1);
    def.gain = 0.1f * (float)(i + 1);
    def.read_noise = 0.7f * (float)i;
    def.baseline_exposure = exposures[i % 5];
    vlRaw *raw = make_raw(context, &def), *back = NULL;
    assert_int_equal(vl_raw_write(raw, path, NULL), VL_OK);
    assert_int_equal(vl_raw_read(context, path, &back, NULL), VL_OK);
    const vlRawDef *read = vl_raw_def(back);
    assert_true(read->exposure_time == def.exposure_time);
    assert_true(read->f_number == def.f_number);
    assert_true(fabsf(read->focal_length / def.focal_length - 1.0f) < 2e-7f); /* stored in mm */
    assert_true(read->gain == def.gain);
    assert_true(read->read_noise == def.read_noise);
    assert_true(read->baseline_exposure == def.baseline_exposure);
    vl_raw_destroy(raw);
    vl_raw_destroy(back);
  }
  end_context(context);
}

static const char *const patterns[] = {"RG/GB",
                                       "BG/GR",
                                       "GR/BG",
                                       "GB/RG",
                                       "RRGG/RRGG/GGBB/GGBB",
                                       "W",
                                       "RG/BW",
                                       "GGRGGB/GGBGGR/BRGRBG/GGBGGR/GGRGGB/RBGBRG"};
enum { PATTERNS = sizeof patterns / sizeof *patterns };

static void set_color(vlRawDef *def) {
  static const float rows[9] = {0.9f, 0.3f, 0.0f, 0.1f, 1.0f, 0.05f, 0.0f, 0.1f, 0.8f};
  static float sensitivities[4 * VL_SPECTRUM_VALUES];
  uint8_t colors[VL_RAW_MAX_COLORS];
  mix_observer(rows, sensitivities);
  uint32_t count = vl_raw_colors(def, colors);
  for (int i = 0; i < VL_SPECTRUM_VALUES; i++)
    sensitivities[3 * VL_SPECTRUM_VALUES + i] = 1.0f; /* of a white pixel */
  vlError error;
  if (count != 2 && vl_raw_match_color(def, sensitivities, NULL, &error) != VL_OK)
    fail_msg("%s", error.message);
}

static void assert_same_def(const vlRawDef *a, const vlRawDef *b, bool is_mono) {
  assert_int_equal(a->width, b->width);
  assert_int_equal(a->height, b->height);
  assert_int_equal(a->bits, b->bits);
  assert_int_equal(a->pattern_rows, b->pattern_rows);
  assert_int_equal(a->pattern_columns, b->pattern_columns);
  assert_memory_equal(a->pattern, b->pattern, sizeof a->pattern);
  assert_memory_equal(a->black, b->black, sizeof a->black);
  assert_int_equal(a->white, b->white);
  assert_string_equal(a->camera, b->camera);
  assert_true(a->exposure_time == b->exposure_time);
  assert_true(a->f_number == b->f_number);
  assert_true(a->focal_length == b->focal_length);
  assert_int_equal(a->iso, b->iso);
  assert_true(a->gain == b->gain);
  assert_true(a->read_noise == b->read_noise);
  assert_true(a->baseline_exposure == b->baseline_exposure);
  if (is_mono)
    return;
  assert_memory_equal(a->neutral, b->neutral, sizeof a->neutral);
  assert_memory_equal(a->matrices, b->matrices, sizeof a->matrices);
}

static void test_round_trip(void **state) {
  (void)state;
  vlContext *context = make_context(2);
  char path[1024];
  in_folder("a.dng", path);
  for (int i = 0; i < PATTERNS && has_tiff(); i++) {
    vlRawDef def = full_def(patterns[i], 37, 23);
    set_color(&def);
    vlRaw *raw = make_raw(context, &def), *back = NULL;
    vlError error;
    if (vl_raw_write(raw, path, &error) != VL_OK ||
        vl_raw_read(context, path, &back, &error) != VL_OK)
      fail_msg("%s: %s", patterns[i], error.message);
    assert_same_def(vl_raw_def(back), &def, strcmp(patterns[i], "W") == 0);
    assert_memory_equal(vl_raw_numbers(back), vl_raw_numbers(raw), 37 * 23 * 2);
    vl_raw_destroy(back);
    vl_raw_destroy(raw);
  }
  end_context(context);
}

/* Of a def without metadata nothing comes back. */
static void test_bare(void **state) {
  (void)state;
  vlContext *context = make_context(1);
  char path[1024];
  in_folder("bare.dng", path);
  vlRawDef def = vl_default_raw_def(4, 2);
  vlRaw *raw = make_raw(context, &def), *back = NULL;
  if (has_tiff()) {
    assert_int_equal(vl_raw_write(raw, path, NULL), VL_OK);
    assert_int_equal(vl_raw_read(context, path, &back, NULL), VL_OK);
    assert_same_def(vl_raw_def(back), &def, false);
  } else {
    vlError error;
    assert_int_equal(vl_raw_write(raw, path, &error), VL_ERROR_UNSUPPORTED);
    assert_non_null(
        strstr(error.message, "this build has no DNG: it was made without libtiff"));
    assert_int_equal(vl_raw_read(context, path, &back, &error), VL_ERROR_UNSUPPORTED);
  }
  vl_raw_destroy(back);
  vl_raw_destroy(raw);
  end_context(context);
}

/* The bytes do not depend on the threads, nor on what was in memory before. */
static void test_same_bytes(void **state) {
  (void)state;
  static const char *const suffixes[] = {"dng", "tif", "png", "exr"};
  for (int s = has_tiff() ? 0 : 2; s < 4; s++) {
    void *data[2];
    size_t size[2];
    for (uint32_t i = 0; i < 2; i++) {
      char name[32], path[1024];
      vlContext *context = make_context(1 + 2 * i);
      vlRawDef def = full_def("RG/GB", 65, 40);
      set_color(&def);
      vlRaw *raw = make_raw(context, &def);
      snprintf(name, sizeof name, "%u.%s", i, suffixes[s]);
      assert_int_equal(vl_raw_write(raw, in_folder(name, path), NULL), VL_OK);
      data[i] = slurp(path, &size[i]);
      vl_raw_destroy(raw);
      end_context(context);
    }
    assert_int_equal(size[0], size[1]);
    assert_memory_equal(data[0], data[1], size[0]);
    free(data[0]);
    free(data[1]);
  }
}

static void test_images(void **state) {
  (void)state;
  vlContext *context = make_context(1);
  vlRawDef def = full_def("RG/GB", 8, 4);
  vlRaw *raw = make_raw(context, &def);
  char path[1024];
  vlImage *image = NULL;
  assert_int_equal(vl_raw_write(raw, in_folder("n.png", path), NULL), VL_OK);
  assert_int_equal(vl_image_read(context, path, &image, NULL), VL_OK);
  assert_int_equal(vl_image_type(image), VL_PIXEL_U16);
  assert_memory_equal(vl_image_pixels(image), vl_raw_numbers(raw), 8 * 4 * 2);
  vl_image_destroy(image);
  assert_int_equal(vl_raw_write(raw, in_folder("e.exr", path), NULL), VL_OK);
  assert_int_equal(vl_image_read(context, path, &image, NULL), VL_OK);
  const float *electrons = vl_image_const_pixels(image);
  for (uint32_t i = 0; i < 32; i++) {
    uint32_t cell = i / 8 % 2 * 2 + i % 2;
    float expected = ((float)vl_raw_numbers(raw)[i] - (float)(64 + cell)) * 4.0f;
    assert_true(electrons[i] == expected);
  }
  vl_image_destroy(image);
  vl_raw_destroy(raw);
  end_context(context);
}

static void refuse(const vlRaw *raw, const char *name, vlResult code, const char *text) {
  char path[1024];
  vlError error = {0};
  assert_int_equal(vl_raw_write(raw, in_folder(name, path), &error), code);
  if (!strstr(error.message, text))
    fail_msg("\"%s\" lacks \"%s\"", error.message, text);
  assert_int_not_equal(access(path, F_OK), 0);
}

static void test_refused_writes(void **state) {
  (void)state;
  vlContext *context = make_context(1);
  vlRawDef def = vl_default_raw_def(6, 6);
  vlRaw *raw = make_raw(context, &def);
  refuse(raw, "a.exr", VL_ERROR_ARGUMENT, "gain");
  refuse(raw, "a.jpg", VL_ERROR_ARGUMENT, ".dng");
  refuse(raw, "none/a.png", VL_ERROR_IO, "none");
  vl_raw_numbers(raw)[7] = 4096;
  refuse(raw, "a.png", VL_ERROR_ARGUMENT, "pixel (1, 1) is 4096");
  vl_raw_destroy(raw);
  end_context(context);
}

/* ---- damaged files ----------------------------------------------------------------------- */

static void write_bytes(const char *path, const void *data, size_t size) {
  FILE *file = fopen(path, "wb");
  assert_non_null(file);
  assert_int_equal(fwrite(data, 1, size, file), size);
  fclose(file);
}

/* Reads the bytes as a file: an image, or an error with a message of one line. */
static vlResult read_bytes(vlContext *context, const void *data, size_t size, vlError *error) {
  char path[1024];
  vlRaw *raw = NULL;
  write_bytes(in_folder("damaged.dng", path), data, size);
  *error = (vlError){0};
  vlResult result = vl_raw_read(context, path, &raw, error);
  assert_true((result == VL_OK) == (raw != NULL));
  if (result != VL_OK) {
    assert_true(error->message[0] && !strchr(error->message, '\n'));
    assert_true(result == VL_ERROR_SCENE || result == VL_ERROR_UNSUPPORTED);
  }
  vl_raw_destroy(raw);
  return result;
}

/* The place of a tag's entry in the first directory; 0: it has none. */
static size_t entry_of(const uint8_t *data, uint16_t tag) {
  uint32_t at;
  memcpy(&at, data + 4, 4);
  uint32_t count = data[at] | (uint32_t)data[at + 1] << 8;
  for (uint32_t i = 0; i < count; i++)
    if ((data[at + 2 + 12 * i] | data[at + 3 + 12 * i] << 8) == tag)
      return at + 2 + 12 * i;
  return 0;
}

static void test_damaged(void **state) {
  (void)state;
  static const struct {
    uint16_t tag;
    uint32_t value;
    const char *text;
  } wrong[] = {
      {256, 70000, "65535"},     {256, 60000, "promises"},   {257, 0, "strips"},
      {258, 8, "16 bits"},       {259, 7, "compression"},    {262, 2, "no mosaic"},
      {277, 3, "16 bits"},       {33421, 0x90009, "8 rows"}, {33422, 0x01010109, "colours"},
      {50717, 0, "white level"}, {50717, 65, "black level"}, {50778, 23, "lights"}};
  vlContext *context = make_context(1);
  vlRawDef def = full_def("RG/GB", 37, 23);
  char path[1024];
  vlError error;
  size_t size;
  set_color(&def);
  vlRaw *raw = make_raw(context, &def);
  if (!has_tiff()) {
    vl_raw_destroy(raw);
    end_context(context);
    skip();
  }
  assert_int_equal(vl_raw_write(raw, in_folder("whole.dng", path), NULL), VL_OK);
  vl_raw_destroy(raw);
  uint8_t *data = slurp(path, &size), *copy = malloc(size);
  assert_non_null(copy);
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    memcpy(copy, data, size);
    size_t at = entry_of(data, wrong[i].tag);
    assert_true(at > 0);
    memcpy(copy + at + 8, &wrong[i].value, 4);
    copy[at + 2] = wrong[i].tag == 256 ? 4 : copy[at + 2]; /* a 32-bit integer */
    assert_int_not_equal(read_bytes(context, copy, size, &error), VL_OK);
    if (!strstr(error.message, wrong[i].text))
      fail_msg("tag %u: \"%s\" lacks \"%s\"", wrong[i].tag, error.message, wrong[i].text);
  }
  for (size_t n = 0; n < size; n += 1 + n / 16)
    read_bytes(context, data, n, &error);
  for (size_t i = 0; i < size; i += i < 64 || i > size - 1200 ? 1 : 61) {
    memcpy(copy, data, size);
    copy[i] ^= 0xff;
    read_bytes(context, copy, size, &error);
  }
  assert_int_equal(read_bytes(context, "", 0, &error), VL_ERROR_SCENE);
  free(copy);
  free(data);
  end_context(context);
}

static vlResult write_and_read(vlContext *context, void *user) {
  vlRaw *raw = NULL, *back = NULL;
  vlImage *image = NULL;
  vlRawDef def = full_def("RG/GB", 9, 7);
  set_color(&def);
  vlResult result = vl_raw_create(context, &def, &raw, NULL);
  if (result == VL_OK)
    result = vl_raw_write(raw, user, NULL);
  if (result == VL_OK)
    result = vl_raw_read(context, user, &back, NULL);
  if (result == VL_OK)
    result = vl_raw_develop(back, NULL, &image, NULL);
  vl_image_destroy(image);
  vl_raw_destroy(back);
  vl_raw_destroy(raw);
  return result;
}

static void test_out_of_memory(void **state) {
  (void)state;
  char path[1024];
  in_folder("memory.dng", path);
  if (has_tiff())
    fail_everywhere(write_and_read, path, 10);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_round_trip),     cmocka_unit_test(test_bare),
      cmocka_unit_test(test_same_bytes),     cmocka_unit_test(test_images),
      cmocka_unit_test(test_refused_writes), cmocka_unit_test(test_damaged),
      cmocka_unit_test(test_out_of_memory),  cmocka_unit_test(test_numbers_of_metadata)};
  return cmocka_run_group_tests(tests, NULL, remove_folder);
}
