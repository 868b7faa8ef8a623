/* test/film/test_film_files.c: film files: a film is read as it was written, parts merge to the
 * whole in any order, and all damage is detected. */
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <jansson.h>

#include "failing_allocator.h"
#include "film/file.h"
#include "film/sums.h"
#include "math/hash.h"
#include "unit.h"
#include "velo/film.h"
#include "velo/receipt.h"

enum { WIDTH = 83, HEIGHT = 70, SPP = 24 };
static char folder[64];
static vlContext *context;

static int begin(void **state) {
  (void)state;
  snprintf(folder, sizeof folder, "/tmp/velo-film-XXXXXX");
  if (!mkdtemp(folder))
    return 1;
  vlContextDef def = vl_default_context_def();
  def.threads = 2;
  return vl_context_create(&def, &context) != VL_OK;
}

static int end(void **state) {
  (void)state;
  char command[128];
  vl_context_destroy(context);
  snprintf(command, sizeof command, "rm -r %s", folder);
  return system(command);
}

static const char *path_of(const char *name) {
  static char paths[32][128];
  static unsigned next;
  char *path = paths[next++ % 32];
  snprintf(path, sizeof paths[0], "%s/%s", folder, name);
  return path;
}

static char *bytes_of(const char *path, size_t *size) {
  FILE *file = fopen(path, "rb");
  assert_non_null(file);
  fseek(file, 0, SEEK_END);
  *size = (size_t)ftell(file);
  rewind(file);
  char *bytes = malloc(*size + 1);
  assert_int_equal(fread(bytes, 1, *size, file), *size);
  fclose(file);
  return bytes;
}

static void put_bytes(const char *path, const char *bytes, size_t size) {
  FILE *file = fopen(path, "wb");
  assert_non_null(file);
  assert_int_equal(fwrite(bytes, 1, size, file), size);
  fclose(file);
}

static bool same_bytes(const char *a, const char *b) {
  size_t n, m;
  char *x = bytes_of(a, &n), *y = bytes_of(b, &m);
  bool same = n == m && memcmp(x, y, n) == 0;
  free(x);
  free(y);
  return same;
}

/* ---- films ------------------------------------------------------------------------------- */

enum { PLAIN, ERRORS, SPECTRUM, KINDS };

static vlFilmDef film_def(int kind) {
  vlFilmDef def = vl_default_film_def(WIDTH, HEIGHT);
  def.crop[0] = 5;
  def.crop[3] = HEIGHT - 2;
  def.errors = kind == ERRORS;
  if (def.errors) /* quickly made: many films are read */
    def.filter = vl_default_pixel_filter(VL_PIXEL_FILTER_BOX);
  def.buckets = kind == SPECTRUM ? 3 : 0;
  return def;
}

static float value(uint32_t x, uint32_t y, uint32_t sample, uint32_t salt) {
  return vl_unit_float(vl_hash3(x | y << 16, sample, salt)) * 3.0f - 0.5f;
}

/* Makes a film that has the samples first to end - 1 in the pixels of the tiles. */
static vlFilm *make_film(vlContext *own, int kind, const uint32_t tiles[4], uint32_t first,
                         uint32_t last) {
  vlFilmDef def = film_def(kind);
  if (tiles)
    memcpy(def.crop, tiles, sizeof def.crop);
  vlFilm *film;
  if (vl_film_create(own, &def, &film) != VL_OK)
    return NULL;
  if (vl_film_begin_pass(film) != VL_OK) {
    vl_film_destroy(film);
    return NULL;
  }
  vl_film_set_pass_samples(film, first, last);
  for (uint32_t s = first; s < last; s++)
    for (uint32_t y = def.crop[1]; y < def.crop[3]; y++)
      for (uint32_t x = def.crop[0]; x < def.crop[2]; x++) {
        int32_t px = (int32_t)x, py = (int32_t)y;
        float r = value(x, y, s, 1), g = value(x, y, s, 2), b = value(x, y, s, 3) * 1e5f, a = 1,
              w = value(x, y, s, 4);
        float lambda[4] = {400, 500, 600, 700};
        vlFilmSpectra spectra = {
            1, &px, &py, {&r, &g, &b, &w}, {lambda, lambda + 1, lambda + 2, lambda + 3}, &w};
        vlFilmSamples samples = {1, &px, &py, &r, &g, &b, &a, &w, &s};
        if (def.buckets)
          vl_film_add_spectra(film, &spectra);
        vl_film_add(film, &samples, NULL, NULL);
      }
  vl_film_commit_pass(film);
  vl_film_set_spp(film, last - first);
  vl_film_set_sequence(film, (vlFilmSequence){.length = 256, .first = first});
  return film;
}

static void write_film(const char *path, int kind, const uint32_t tiles[4], uint32_t first,
                       uint32_t last) {
  vlFilm *film = make_film(context, kind, tiles, first, last);
  vlFilmWriteDef def = vl_default_film_write_def();
  vlFilmDef whole = film_def(kind);
  memcpy(def.window, whole.crop, sizeof def.window);
  vlError error;
  if (vl_film_write(film, &def, path, &error) != VL_OK)
    fail_msg("%s", error.message);
  vl_film_destroy(film);
}

static void same_images(vlImage *a, vlImage *b) {
  size_t size =
      (size_t)vl_image_width(a) * vl_image_height(a) * vl_image_channels(a) * sizeof(float);
  assert_int_equal(vl_image_width(a), vl_image_width(b));
  assert_memory_equal(vl_image_const_pixels(a), vl_image_const_pixels(b), size);
  vl_image_destroy(a);
  vl_image_destroy(b);
}

/* ---- tests ------------------------------------------------------------------------------- */

static void what_is_written_is_read(void **state) {
  (void)state;
  for (int kind = 0; kind < KINDS; kind++) {
    vlFilm *film = make_film(context, kind, NULL, 7, 7 + SPP), *read;
    vlImage *a, *b;
    vlError error;
    assert_int_equal(vl_film_write(film, NULL, path_of("a.film"), &error), VL_OK);
    assert_int_equal(vl_film_read(context, path_of("a.film"), false, &read, &error), VL_OK);
    assert_int_equal(vl_film_spp(read), SPP);
    assert_int_equal(vl_film_sequence(read).length, 256);
    assert_int_equal(vl_film_sequence(read).first, 7);
    assert_int_equal(vl_film_develop(film, NULL, &a), VL_OK);
    assert_int_equal(vl_film_develop(read, NULL, &b), VL_OK);
    same_images(a, b);
    if (kind == ERRORS) {
      assert_int_equal(vl_film_errors(film, NULL, &a), VL_OK);
      assert_int_equal(vl_film_errors(read, NULL, &b), VL_OK);
      same_images(a, b);
    }
    if (kind == SPECTRUM) {
      assert_int_equal(vl_film_spectrum(film, &a), VL_OK);
      assert_int_equal(vl_film_spectrum(read, &b), VL_OK);
      same_images(a, b);
    }
    assert_int_equal(vl_film_write(read, NULL, path_of("b.film"), &error), VL_OK);
    assert_true(same_bytes(path_of("a.film"), path_of("b.film")));
    vl_film_destroy(film);
    vl_film_destroy(read);
  }
}

static vlResult merge(const char *const *paths, uint32_t count, const char *output,
                      vlError *error) {
  vlFilmMergeDef def = vl_default_film_merge_def();
  def.overwrite = true;
  return vl_film_merge(context, paths, count, &def, output, error);
}

/* Turns the data of a block of the present format into that of format 1 or 2. Returns its
 * size. */
static size_t old_data(const vlFilmDef *def, uint32_t format, size_t pixels, bool compared,
                       const char *from, char *to) {
  char *start = to;
  memcpy(to, from, pixels * sizeof(vlFilmPixel));
  from += pixels * sizeof(vlFilmPixel);
  to += pixels * sizeof(vlFilmPixel);
  for (size_t i = 0; i < pixels && def->errors; i++) {
    vlFilmMoments m;
    memcpy(&m, from, sizeof m);
    memcpy(to, m.plain, sizeof m.plain);
    memcpy(to + sizeof m.plain, m.squares, sizeof m.squares);
    memcpy(to + sizeof m.plain + sizeof m.squares, &m.samples, sizeof m.samples);
    from += sizeof m;
    to += sizeof m.plain + sizeof m.squares + sizeof m.samples;
  }
  if (compared && format == 2) {
    memset(to, 1, 16 * pixels);
    to += 16 * pixels;
  }
  return (size_t)(to - start);
}

/* Turns a file of the present format into one of format 1 or 2, whose first block has a
 * comparison. */
static void make_old(const char *path, uint32_t format) {
  size_t size;
  char *bytes = bytes_of(path, &size), *made = malloc(size + 16 * 32 * 32), *to = made;
  vlFilmPreamble p;
  vlFilmDef def = film_def(ERRORS);
  memcpy(&p, bytes, sizeof p);
  p.format = format;
  p.crc = vl_film_crc(0, &p, offsetof(vlFilmPreamble, crc));
  memcpy(to, &p, sizeof p);
  memcpy(to + sizeof p, bytes + sizeof p, p.header_size);
  to += sizeof p + p.header_size;
  for (char *from = bytes + sizeof p + p.header_size; from < bytes + size;) {
    vlFilmBlockHead head;
    memcpy(&head, from, sizeof head);
    bool first = from == bytes + sizeof p + p.header_size;
    size_t ranges = head.range_count * sizeof(vlSampleSpan), data = head.data_size;
    size_t pixels = (size_t)(head.x1 - head.x0) * (head.y1 - head.y0);
    if (first)
      head.compared = (vlComparedNoise){16, 0.25f, 2.0f, 1};
    head.data_size = old_data(&def, format, pixels, first, from + sizeof head + ranges,
                              to + sizeof head + ranges);
    memcpy(to, &head, sizeof head);
    memcpy(to + sizeof head, from + sizeof head, ranges);
    size_t whole = sizeof head + ranges + head.data_size;
    uint32_t crc = vl_film_crc(0, to, whole);
    memcpy(to + whole, &crc, sizeof crc);
    to += whole + sizeof crc;
    from += sizeof head + ranges + data + sizeof crc;
  }
  put_bytes(path, made, (size_t)(to - made));
  free(bytes);
  free(made);
}

static vlImage *independent_errors(const vlFilm *film) {
  vlDevelopDef def = vl_default_develop_def();
  def.independent = true;
  vlImage *image;
  assert_int_equal(vl_film_errors(film, &def, &image), VL_OK);
  return image;
}

/* Films of formats 1 and 2 have the same image, and the errors of independent samples.
 * Continued beyond the next power of two they have the bytes of new films. */
static void old_formats_are_read(void **state) {
  (void)state;
  const char *path = path_of("old.film"), *more = path_of("more.film"),
             *whole = path_of("whole.film");
  const char *again = path_of("again.film"), *parts[2] = {path, more};
  vlError error;
  vlFilm *film, *present = make_film(context, ERRORS, NULL, 0, 16);
  write_film(whole, ERRORS, NULL, 0, SPP);
  write_film(more, ERRORS, NULL, 16, SPP);
  for (uint32_t format = 1; format <= 2; format++) {
    write_film(path, ERRORS, NULL, 0, 16);
    make_old(path, format);
    if (vl_film_read(context, path, false, &film, &error) != VL_OK)
      fail_msg("%s", error.message);
    assert_true((film->compared != NULL) == (format == 2));
    if (format == 2)
      assert_true(film->compared[0].spp == 16 && film->compared[0].noise == 0.25f);
    vlImage *a, *b;
    assert_int_equal(vl_film_develop(film, NULL, &a), VL_OK);
    assert_int_equal(vl_film_develop(present, NULL, &b), VL_OK);
    same_images(a, b);
    assert_int_equal(vl_film_errors(film, NULL, &a), VL_OK);
    same_images(a, independent_errors(present));
    vl_film_destroy(film);
    assert_int_equal(merge(parts, 2, again, &error), VL_OK);
    assert_true(same_bytes(again, whole));
  }
  vl_film_destroy(present);
}

/* The memory for a block's data is enough for each format, also of files that compared blocks
 * without errors. */
static void whole_blocks_fit(void **state) {
  (void)state;
  const size_t pixels = (size_t)VL_FILM_BLOCK * VL_FILM_BLOCK;
  for (int kind = 0; kind < KINDS; kind++) {
    const vlFilmDef def = film_def(kind);
    const size_t max = vl_film_max_data(&def);
    assert_true(max >= pixels * vl_film_pixel_size(&def));
    for (uint32_t format = 1; format <= 2; format++)
      for (int compared = 0; compared < 2; compared++)
        assert_true(max >= vl_film_old_data_size(&def, format, pixels, compared));
  }
}

/* Blocks keep their last comparison of adaptive sampling, unless samples of another part join
 * them. */
static void compared_noise(void **state) {
  (void)state;
  enum { LAST = 2 };
  vlFilm *film = make_film(context, ERRORS, NULL, 0, 16), *read;
  assert_non_null(vl_film_compared(film));
  vl_film_compare_block(film, LAST, VL_VIEW_STANDARD, 1, 1, 1);
  float noise = film->compared[LAST].noise;
  assert_true(noise > 0);
  vlError error;
  assert_int_equal(vl_film_write(film, NULL, path_of("noise.film"), &error), VL_OK);
  vl_film_clear(film);
  assert_int_equal(vl_film_compared(film)[LAST].spp, 0);
  vl_film_destroy(film);
  write_film(path_of("more.film"), ERRORS, NULL, 16, SPP);
  const char *paths[3] = {path_of("noise.film"), path_of("noise.film"), path_of("more.film")};
  for (uint32_t count = 1; count <= 3; count++) { /* the same part twice counts once */
    assert_int_equal(merge(paths, count, path_of("merged.film"), &error), VL_OK);
    assert_int_equal(vl_film_read(context, path_of("merged.film"), false, &read, &error),
                     VL_OK);
    vlComparedNoise got = vl_film_compared(read)[LAST],
                    other = vl_film_compared(read)[LAST - 1];
    assert_int_equal(got.spp, count < 3 ? 16 : 0);
    if (count < 3)
      assert_true(got.noise == noise && got.factor == 2.0f && got.view == VL_VIEW_STANDARD);
    assert_int_equal(other.spp, 0);
    vl_film_destroy(read);
  }
}

static void shuffle(const char **paths, uint32_t count, uint32_t seed) {
  for (uint32_t i = count; i > 1; i--) {
    uint32_t k = vl_hash2(seed, i) % i;
    const char *swap = paths[i - 1];
    paths[i - 1] = paths[k];
    paths[k] = swap;
  }
}

/* Merges six parts, divided by samples and by tiles, in any order and grouping. One part is
 * given twice. */
static void parts_become_the_whole(void **state) {
  (void)state;
  static const uint32_t left[4] = {5, 0, 32, HEIGHT - 2}, right[4] = {32, 0, WIDTH, HEIGHT - 2};
  static const struct {
    const uint32_t *tiles;
    uint32_t first, end;
  } parts[6] = {{NULL, 0, 5},  {NULL, 5, 6},   {left, 6, 20},
                {right, 6, 9}, {right, 9, 20}, {NULL, 20, SPP}};
  for (int kind = 0; kind < KINDS; kind++) {
    const char *paths[7];
    char names[6][128];
    write_film(path_of("whole.film"), kind, NULL, 0, SPP);
    for (uint32_t i = 0; i < 6; i++) {
      snprintf(names[i], sizeof names[i], "%s/part%u.film", folder, i);
      write_film(names[i], kind, parts[i].tiles, parts[i].first, parts[i].end);
    }
    for (uint32_t round = 0; round < 8; round++) {
      vlError error;
      for (int i = 0; i < 7; i++)
        paths[i] = names[i % 6];
      shuffle(paths, 7, round + 100 * (uint32_t)kind);
      uint32_t some = 1 + round % 5;
      const char *second[7] = {path_of("some.film")};
      if (merge(paths, some, second[0], &error) != VL_OK)
        fail_msg("%s", error.message);
      for (uint32_t i = some; i < 7; i++)
        second[1 + i - some] = paths[i];
      if (merge(second, 8 - some, path_of("all.film"), &error) != VL_OK)
        fail_msg("%s", error.message);
      assert_true(same_bytes(path_of("all.film"), path_of("whole.film")));
    }
  }
}

static void what_does_not_belong_together_is_refused(void **state) {
  (void)state;
  const char *a = path_of("one.film"), *b = path_of("two.film"), *output = path_of("none.film");
  const char *paths[2] = {a, b};
  vlError error;
  write_film(a, PLAIN, NULL, 0, 8);
  write_film(b, PLAIN, NULL, 4, 12);
  assert_int_equal(merge(paths, 2, output, &error), VL_ERROR_SCENE);
  assert_non_null(strstr(error.message, "one.film"));
  assert_non_null(strstr(error.message, "two.film"));
  assert_non_null(strstr(error.message, "4:8"));
  write_film(b, ERRORS, NULL, 8, 12);
  assert_int_equal(merge(paths, 2, output, &error), VL_ERROR_SCENE);
  assert_int_not_equal(access(output, F_OK), 0);
}

/* Two merged parts with a gap between their samples can be developed but not continued. Without
 * the gap both work. */
static void a_film_with_gaps_is_only_developed(void **state) {
  (void)state;
  const char *paths[2] = {path_of("one.film"), path_of("two.film")};
  vlFilm *film;
  vlImage *image;
  vlError error;
  write_film(paths[0], PLAIN, NULL, 0, 8);
  write_film(paths[1], PLAIN, NULL, 10, 12);
  assert_int_equal(merge(paths, 2, path_of("gap.film"), &error), VL_OK);
  assert_int_equal(vl_film_read(context, path_of("gap.film"), false, &film, &error),
                   VL_ERROR_SCENE);
  assert_null(film);
  assert_int_equal(vl_film_read(context, path_of("gap.film"), true, &film, &error), VL_OK);
  assert_int_equal(vl_film_spp(film), 10);
  assert_int_equal(vl_film_develop(film, NULL, &image), VL_OK);
  assert_int_equal(vl_film_write(film, NULL, path_of("x.film"), &error), VL_ERROR_ARGUMENT);
  vl_image_destroy(image);
  vl_film_destroy(film);
}

static vlResult read_bytes(const char *bytes, size_t size, vlError *error) {
  vlFilm *film;
  put_bytes(path_of("damaged.film"), bytes, size);
  vlResult result = vl_film_read(context, path_of("damaged.film"), true, &film, error);
  vl_film_destroy(film);
  return result;
}

/* Changes each byte of the header and of the first block's head, and every hundredth of the
 * other bytes; also truncates the file at many lengths. Two blocks. */
static void no_damage_goes_unseen(void **state) {
  (void)state;
  size_t size, held = vl_context_memory(context, NULL);
  vlError error;
  const uint32_t tiles[4] = {64, 32, WIDTH, HEIGHT - 2};
  write_film(path_of("good.film"), ERRORS, tiles, 0, 2);
  char *bytes = bytes_of(path_of("good.film"), &size);
  vlFilmPreamble preamble;
  memcpy(&preamble, bytes, sizeof preamble);
  size_t head =
      sizeof preamble + preamble.header_size + sizeof(vlFilmBlockHead) + sizeof(vlSampleSpan);
  for (size_t at = 0; at < size; at += at < head ? 1 : 101) {
    for (int bit = 0; bit < 8; bit += at < 32 ? 1 : 5) {
      bytes[at] = (char)(bytes[at] ^ 1 << bit);
      vlResult result = read_bytes(bytes, size, &error);
      if (result != VL_ERROR_SCENE)
        fail_msg("byte %zu, bit %d: %s", at, bit, vl_result_name(result));
      assert_non_null(strstr(error.message, "damaged.film"));
      bytes[at] = (char)(bytes[at] ^ 1 << bit);
    }
  }
  for (size_t cut = 0; cut < size; cut += cut < head ? 7 : 997)
    assert_int_equal(read_bytes(bytes, cut, &error), VL_ERROR_SCENE);
  bytes[size] = 0;
  assert_int_equal(read_bytes(bytes, size + 1, &error), VL_ERROR_SCENE);
  assert_int_equal(read_bytes(bytes, size, &error), VL_OK);
  free(bytes);
  assert_int_equal(vl_context_memory(context, NULL), held);
}

/* Sums that no samples can produce are refused even if their CRC is right, since later
 * additions could overflow; so are more samples than an image's header can hold. */
static void impossible_sums_are_refused(void **state) {
  (void)state;
  size_t size;
  vlError error;
  write_film(path_of("good.film"), PLAIN, NULL, 0, 2);
  char *bytes = bytes_of(path_of("good.film"), &size);
  vlFilmPreamble preamble;
  memcpy(&preamble, bytes, sizeof preamble);
  char *block = bytes + sizeof preamble + preamble.header_size;
  vlFilmBlockHead head;
  memcpy(&head, block, sizeof head);
  size_t length = sizeof head + sizeof(vlSampleSpan) + head.data_size;
  for (uint32_t more = 0; more < 2; more++) {
    const vlSampleSpan range = {0, INT32_MAX + more};
    memcpy(block + sizeof head, &range, sizeof range);
    uint32_t crc = vl_film_crc(0, block, length);
    memcpy(block + length, &crc, sizeof crc);
    assert_int_equal(read_bytes(bytes, size, &error), more ? VL_ERROR_SCENE : VL_OK);
  }
  assert_non_null(strstr(error.message, "a block's samples"));
  const vlSampleSpan range = {0, 2};
  memcpy(block + sizeof head, &range, sizeof range);
  block[sizeof head + sizeof(vlSampleSpan) + 15] = 0x7f; /* the highest byte of a sum */
  uint32_t crc = vl_film_crc(0, block, length);
  memcpy(block + length, &crc, sizeof crc);
  assert_int_equal(read_bytes(bytes, size, &error), VL_ERROR_SCENE);
  assert_non_null(strstr(error.message, "sums"));
  free(bytes);
}

static void files_that_cannot_be_written(void **state) {
  (void)state;
  vlFilm *film = make_film(context, PLAIN, NULL, 0, 1), *none;
  vlFilmDef def = film_def(PLAIN);
  vlError error;
  vlFilmFile *file;
  assert_int_equal(vl_film_write(film, NULL, path_of("no/such/folder.film"), &error),
                   VL_ERROR_IO);
  assert_int_equal(vl_film_read(context, path_of("absent.film"), false, &none, &error),
                   VL_ERROR_MISSING);
  assert_int_equal(vl_film_read(context, folder, false, &none, &error), VL_ERROR_IO);
  put_bytes(path_of("text.film"), "not a film", 10);
  assert_int_equal(vl_film_file_open(context, path_of("text.film"), &file, &error),
                   VL_ERROR_SCENE);
  vl_film_destroy(film);
  assert_int_equal(vl_film_create(context, &def, &film), VL_OK);
  assert_int_equal(vl_film_write(film, NULL, path_of("empty.film"), &error), VL_ERROR_ARGUMENT);
  vl_film_destroy(film);
}

static vlResult whole_life(vlContext *own, void *user) {
  (void)user;
  const char *paths[2] = {path_of("life.film"), path_of("life.film")};
  vlFilm *film = make_film(own, ERRORS, NULL, 0, 1), *read = NULL;
  vlError error;
  vlResult result = film ? vl_film_write(film, NULL, paths[0], &error) : VL_ERROR_MEMORY;
  if (result == VL_OK)
    result = vl_film_merge(own, paths, 2, NULL, path_of("life2.film"), &error);
  if (result == VL_OK)
    result = vl_film_read(own, path_of("life2.film"), false, &read, &error);
  vl_film_destroy(film);
  vl_film_destroy(read);
  return result;
}

static void memory_runs_out(void **state) {
  (void)state;
  fail_everywhere(whole_life, NULL, 20);
}

/* The k-th allocation of jansson fails, or that and all later ones. */
static long json_calls, json_at, json_blocks;
static bool json_stays;

static void *json_allocate(size_t size) {
  long n = ++json_calls;
  if (n == json_at || (json_stays && n > json_at))
    return NULL;
  json_blocks++;
  return malloc(size);
}

static void json_release(void *block) {
  if (block)
    json_blocks--;
  free(block);
}

static void a_receipt_that_is_not_json_is_refused(void **state) {
  (void)state;
  vlFilm *film = make_film(context, PLAIN, NULL, 0, 1);
  vlFilmWriteDef def = vl_default_film_write_def();
  vlError error;
  def.receipt = "{\"velo_receipt\": 1,\n \"samples\": }";
  assert_int_equal(vl_film_write(film, &def, path_of("receipt.film"), &error),
                   VL_ERROR_ARGUMENT);
  assert_non_null(strstr(error.message, "receipt: line 2"));
  def.receipt = "{\"velo_receipt\": 1}";
  assert_int_equal(vl_film_write(film, &def, path_of("receipt.film"), &error), VL_OK);
  vl_film_destroy(film);
}

static vlResult life_with_receipt(void) {
  static const char text[] =
      "{\"velo_receipt\": 1, \"command\": [\"velo\", \"render\", \"a.pbrt\"], \"samples\": 1}";
  const char *paths[2] = {path_of("json.film"), path_of("json.film")};
  const uint32_t small[4] = {5, 0, 9, 4};
  vlFilm *film = make_film(context, PLAIN, small, 0, 1), *read = NULL;
  vlFilmWriteDef def = vl_default_film_write_def();
  vlReceipt *receipt = NULL;
  vlError error;
  vlResult result = vl_receipt_parse(context, text, strlen(text), &receipt, &error);
  def.receipt = result == VL_OK ? vl_receipt_text(receipt) : NULL;
  if (result == VL_OK)
    result = vl_film_write(film, &def, paths[0], &error);
  if (result == VL_OK)
    result = vl_film_merge(context, paths, 2, NULL, path_of("json2.film"), &error);
  if (result == VL_OK)
    result = vl_film_read(context, path_of("json2.film"), false, &read, &error);
  if (result != VL_OK && result != VL_ERROR_MEMORY)
    print_message("%s\n", error.message);
  vl_receipt_destroy(receipt);
  vl_film_destroy(film);
  vl_film_destroy(read);
  return result;
}

static void memory_of_json_runs_out(void **state) {
  (void)state;
  long total = LONG_MAX;
  json_set_alloc_funcs(json_allocate, json_release);
  for (json_at = 0; json_at <= total; json_at++)
    /* "and all later" at every fourth */
    for (int stays = 0; stays < (json_at % 4 == 0 ? 2 : 1); stays++) {
      json_calls = 0;
      json_stays = stays && json_at;
      vlResult result = life_with_receipt();
      if (!json_at && !stays) {
        total = json_calls;
        assert_int_equal(rename(path_of("json2.film"), path_of("right.film")), 0);
      }
      bool good = json_at && json_stays
                      ? result == VL_ERROR_MEMORY
                      : result == VL_OK || (json_at && result == VL_ERROR_MEMORY);
      if (json_at && result == VL_OK)
        good = same_bytes(path_of("json2.film"), path_of("right.film"));
      if (!good)
        fail_msg("allocation %ld%s: %s", json_at, stays ? " and later" : "",
                 vl_result_name(result));
    }
  json_set_alloc_funcs(malloc, free);
  assert_int_equal(json_blocks, 0);
  assert_true(total > 100);
}

static vlResult attributes_of(const char *path, vlImage *image, vlError *error) {
  vlFilmFile *file;
  vlResult result = vl_film_file_open(context, path, &file, error);
  if (result == VL_OK)
    result = vl_film_file_attributes(file, image, error);
  vl_film_file_close(file);
  return result;
}

/* Attributes of each type come back as they were, also out of a merged film, and do not depend
 * on the order of its parts. */
static void attributes_are_kept(void **state) {
  (void)state;
  static const vlAttribute some[] = {
      {"f", VL_ATTRIBUTE_FLOAT, {(double)0.1f}, NULL},
      {"d", VL_ATTRIBUTE_DOUBLE, {-0.1}, NULL},
      {"i", VL_ATTRIBUTE_INT, {-7}, NULL},
      {"s", VL_ATTRIBUTE_STRING, {0}, "\xc3\xa9 \"\\"},
      {"list", VL_ATTRIBUTE_STRINGS, {0}, "left\nright"},
      {"box", VL_ATTRIBUTE_BOX2I, {1, 2, 3, 4}, NULL},
      {"v", VL_ATTRIBUTE_V2F, {1e-30, 5e30}, NULL},
      {"m",
       VL_ATTRIBUTE_M44D,
       {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 1.0 / 3},
       NULL}};
  enum { COUNT = sizeof some / sizeof *some };
  vlImageDef image_def = vl_default_image_def(1, 1, 1);
  vlImage *from, *to;
  vlError error = {0};
  assert_int_equal(vl_image_create(context, &image_def, &from), VL_OK);
  for (int i = 0; i < COUNT; i++)
    assert_int_equal(vl_image_set_attribute(from, &some[i]), VL_OK);
  const vlAttribute lost[2] = {{"nan", VL_ATTRIBUTE_FLOAT, {NAN}, NULL},
                               {"bytes", VL_ATTRIBUTE_STRING, {0}, "\xff"}};
  for (int i = 0; i < 2; i++)
    assert_int_equal(vl_image_set_attribute(from, &lost[i]), VL_OK);
  const char *paths[3] = {path_of("one.film"), path_of("two.film"), path_of("both.film")};
  for (uint32_t i = 0; i < 2; i++) {
    vlFilm *film = make_film(context, PLAIN, NULL, 4 * i, 4 * i + 4);
    vlFilmWriteDef def = vl_default_film_write_def();
    def.attributes = i ? from : NULL; /* a film of an earlier version has none */
    assert_int_equal(vl_film_write(film, &def, paths[i], &error), VL_OK);
    vl_film_destroy(film);
  }
  for (int turn = 0; turn < 2; turn++) {
    const char *const parts[2] = {paths[turn], paths[1 - turn]};
    assert_int_equal(merge(parts, 2, paths[2], &error), VL_OK);
    for (int k = 1; k < 3; k++) {
      assert_int_equal(vl_image_create(context, &image_def, &to), VL_OK);
      assert_int_equal(attributes_of(paths[k], to, &error), VL_OK);
      assert_int_equal(vl_image_attribute_count(to), COUNT);
      for (uint32_t i = 0; i < COUNT; i++) {
        vlAttribute a;
        assert_int_equal(vl_image_attribute(to, i, &a), VL_OK);
        assert_string_equal(a.name, some[i].name);
        assert_int_equal(a.type, some[i].type);
        if (some[i].string)
          assert_string_equal(a.string, some[i].string);
        if (!some[i].string)
          assert_memory_equal(a.numbers, some[i].numbers, sizeof a.numbers);
      }
      vl_image_destroy(to);
    }
  }
  vl_image_destroy(from);
  /* wrong ones */
  static const char *const texts[] = {"{\"a\": 1}",
                                      "{\"a\": [\"int\"]}",
                                      "{\"a\": [\"int\", 1, 2]}",
                                      "{\"a\": [\"int\", \"1\"]}",
                                      "{\"a\": [\"string\", 1]}",
                                      "{\"a\": [\"thing\", 1]}",
                                      "{\"\": [\"int\", 1]}",
                                      "{\"a\": [\"int\", 2147483648]}",
                                      "{\"displayWindow\": [\"box2i\", 0, 0, -1, 3]}",
                                      "{\"displayWindow\": [\"v2f\", 0, 0]}"};
  assert_int_equal(vl_image_create(context, &image_def, &to), VL_OK);
  for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
    assert_int_equal(vl_film_attributes_set("x.film", texts[i], to, &error), VL_ERROR_SCENE);
    assert_non_null(strstr(error.message, "x.film: film file: the attribute \""));
  }
  vl_image_destroy(to);
}

/* A lock is one for all names of a file; who writes without it is refused. A leftover of a
 * killed process locks nothing. */
static void one_writer_at_a_time(void **state) {
  (void)state;
  vlError error = {0};
  vlFilmLock *lock = NULL, *other = NULL;
  vlFilm *film = make_film(context, PLAIN, NULL, 0, 4);
  vlFilmWriteDef def = vl_default_film_write_def();
  const char *path = path_of("locked.film"), *alias = path_of("alias.film");
  assert_int_equal(symlink("locked.film", alias), 0);
  assert_int_equal(vl_film_lock(context, path, &lock, &error), VL_OK);
  assert_non_null(lock);
  assert_int_equal(vl_film_lock(context, alias, &other, &error), VL_OK);
  assert_null(other);
  assert_int_equal(vl_film_write(film, NULL, alias, &error), VL_ERROR_IO);
  assert_non_null(strstr(error.message, "another process is writing it"));
  vl_remove_leftovers(path); /* leaves a lock that is held */
  assert_int_equal(vl_film_lock(context, path, &other, &error), VL_OK);
  assert_null(other);
  def.lock = lock;
  for (int i = 0; i < 2; i++)
    assert_int_equal(vl_film_write(film, &def, path, &error), VL_OK);
  assert_int_equal(vl_film_lock(context, path, &other, &error), VL_OK);
  assert_null(other); /* the file was replaced, its lock stays */
  const char *const parts[1] = {path};
  assert_int_equal(vl_film_merge(context, parts, 1, NULL, path, &error), VL_ERROR_IO);
  vl_film_unlock(lock);
  assert_int_equal(vl_film_write(film, NULL, path, &error), VL_OK);
  assert_int_equal(vl_film_merge(context, parts, 1, NULL, path, &error), VL_OK);
  vl_film_unlock(NULL);
  vl_film_destroy(film);
  assert_int_equal(unlink(alias), 0);
}

/* A merge replaces what its result holds, and nothing else. */
static void a_merge_loses_nothing(void **state) {
  (void)state;
  vlError error = {0};
  vlFilmMergeDef over = vl_default_film_merge_def();
  over.overwrite = true;
  const char *first = path_of("first.film"), *last = path_of("last.film"),
             *all = path_of("result.film");
  write_film(first, PLAIN, NULL, 0, 5);
  write_film(last, PLAIN, NULL, 5, SPP);
  write_film(all, PLAIN, NULL, 0, 5);
  const char *const both[2] = {first, last};
  assert_int_equal(vl_film_merge(context, both + 1, 1, NULL, all, &error), VL_ERROR_SCENE);
  assert_non_null(strstr(error.message, "is not replaced: it has samples"));
  assert_true(same_bytes(first, all));
  assert_int_equal(vl_film_merge(context, both, 2, NULL, all, &error), VL_OK);
  assert_int_equal(vl_film_merge(context, both, 2, NULL, all, &error), VL_OK);
  assert_int_equal(vl_film_merge(context, both, 1, NULL, all, &error), VL_ERROR_SCENE);
  assert_int_equal(vl_film_merge(context, both, 1, &over, all, &error), VL_OK);
  assert_true(same_bytes(first, all));
  write_film(all, ERRORS, NULL, 0, 5); /* with error sums: another film */
  assert_int_equal(vl_film_merge(context, both, 2, NULL, all, &error), VL_ERROR_SCENE);
  FILE *file = fopen(all, "wb");
  assert_non_null(file);
  fputs("not a film", file);
  fclose(file);
  assert_int_equal(vl_film_merge(context, both, 2, &over, all, &error), VL_ERROR_SCENE);
  file = fopen(all, "wb"); /* an empty file holds nothing */
  assert_non_null(file);
  fclose(file);
  assert_int_equal(vl_film_merge(context, both, 2, NULL, all, &error), VL_OK);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(what_is_written_is_read),
                                     cmocka_unit_test(compared_noise),
                                     cmocka_unit_test(old_formats_are_read),
                                     cmocka_unit_test(whole_blocks_fit),
                                     cmocka_unit_test(parts_become_the_whole),
                                     cmocka_unit_test(what_does_not_belong_together_is_refused),
                                     cmocka_unit_test(a_receipt_that_is_not_json_is_refused),
                                     cmocka_unit_test(a_film_with_gaps_is_only_developed),
                                     cmocka_unit_test(no_damage_goes_unseen),
                                     cmocka_unit_test(impossible_sums_are_refused),
                                     cmocka_unit_test(files_that_cannot_be_written),
                                     cmocka_unit_test(attributes_are_kept),
                                     cmocka_unit_test(one_writer_at_a_time),
                                     cmocka_unit_test(a_merge_loses_nothing),
                                     cmocka_unit_test(memory_runs_out),
                                     cmocka_unit_test(memory_of_json_runs_out)};
  return cmocka_run_group_tests(tests, begin, end);
}
