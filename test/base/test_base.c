/* test/base/test_base.c: the base room: counted memory, arrays, names, errors, files that are
 * written whole or not at all, instruction sets. */
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include "base/array.h"
#include "base/error.h"
#include "base/file.h"
#include "base/isa.h"
#include "base/text.h"
#include "failing_allocator.h"
#include "unit.h"
#include "velo/pending.h"

static char folder[256];

static vlContext *make_context(failAllocator *state) {
  vlContextDef def = vl_default_context_def();
  def.threads = 1;
  if (state)
    def.allocator = fail_allocator(state);
  vlContext *context = NULL;
  assert_int_equal(vl_context_create(&def, &context), VL_OK);
  return context;
}

static const char *in_folder(const char *name) {
  static char path[512];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  return path;
}

static void put_file(const char *path, const void *data, size_t size) {
  FILE *file = fopen(path, "wb");
  assert_non_null(file);
  assert_int_equal(fwrite(data, 1, size, file), size);
  fclose(file);
}

static int count_entries(void) {
  char command[400];
  snprintf(command, sizeof command, "ls -A '%s' | wc -l", folder);
  FILE *pipe = popen(command, "r");
  int count = -1;
  assert_int_equal(fscanf(pipe, "%d", &count), 1);
  pclose(pipe);
  return count;
}

static void memory_is_counted(void **state) {
  (void)state;
  failAllocator allocator = {0};
  vlContext *context = make_context(&allocator);
  size_t before = vl_context_memory(context, NULL);
  char *a = vl_alloc(context, 1000);
  double *b = vl_alloc_zero(context, 100, sizeof *b);
  assert_int_equal((uintptr_t)a % 64, 0);
  assert_int_equal((uintptr_t)b % 64, 0);
  for (int i = 0; i < 100; i++)
    assert_true(b[i] == 0);
  assert_int_equal(vl_context_memory(context, NULL) - before, 1800);
  memset(a, 7, 1000);
  a = vl_realloc_array(context, a, 5, 1000);
  for (int i = 0; i < 1000; i++)
    assert_int_equal(a[i], 7);
  size_t peak = 0;
  vl_free(context, a);
  vl_free(context, b);
  vl_free(context, NULL);
  assert_int_equal(vl_context_memory(context, &peak), before);
  assert_true(peak >= before + 5800);
  /* sizes that do not fit */
  assert_null(vl_alloc_array(context, SIZE_MAX / 2, 3));
  assert_null(vl_alloc_zero(context, SIZE_MAX, 2));
  assert_null(vl_alloc(context, SIZE_MAX));
  vl_context_destroy(context);
  assert_int_equal(allocator.blocks, 0);
}

static void arrays_grow_and_survive_refusal(void **state) {
  (void)state;
  failAllocator allocator = {0};
  vlContext *context = make_context(&allocator);
  VL_ARRAY(int) numbers = {0};
  assert_true(VL_RESERVE(context, &numbers, 0)); /* nothing of nothing */
  for (int i = 0; i < 1000; i++) {
    int *slot = VL_PUSH(context, &numbers);
    assert_non_null(slot);
    assert_int_equal(*slot, 0);
    *slot = i;
  }
  allocator.fail_at = allocator.calls + 1;
  assert_false(VL_RESERVE(context, &numbers, 100000));
  assert_int_equal(numbers.count, 1000);
  for (int i = 0; i < 1000; i++)
    assert_int_equal(numbers.items[i], i);
  assert_false(VL_RESERVE(context, &numbers, SIZE_MAX / 8));
  VL_ARRAY_FREE(context, &numbers);
  assert_null(numbers.items);
  vl_context_destroy(context);
  assert_int_equal(allocator.blocks, 0);
}

static void contexts_check_their_def(void **state) {
  (void)state;
  vlContext *context = NULL;
  vlContextDef bare;
  memset(&bare, 0, sizeof bare);
  assert_int_equal(vl_context_create(&bare, &context), VL_ERROR_ARGUMENT);
  assert_null(context);
  vlContextDef def = vl_default_context_def();
  assert_int_equal(vl_context_create(&def, NULL), VL_ERROR_ARGUMENT);
  def.threads = 0;
  assert_int_equal(vl_context_create(&def, &context), VL_ERROR_ARGUMENT);
  failAllocator allocator = {.fail_at = 1};
  def = vl_default_context_def();
  def.allocator = fail_allocator(&allocator);
  assert_int_equal(vl_context_create(&def, &context), VL_ERROR_MEMORY);
  assert_int_equal(allocator.blocks, 0);
  vl_context_destroy(NULL);
}

static void nearest_names(void **state) {
  (void)state;
  static const char *const names[] = {"diffuse", "coateddiffuse", "conductor", "dielectric",
                                      "thindielectric"};
  assert_string_equal(vl_nearest_name("difuse", names, 5), "diffuse");
  assert_string_equal(vl_nearest_name("Dielectirc", names, 5), "dielectric");
  assert_string_equal(vl_nearest_name("condutcor", names, 5), "conductor");
  assert_null(vl_nearest_name("banana", names, 5));
  assert_null(vl_nearest_name("x", names, 0));
  assert_int_equal(vl_edit_distance("abc", "acb"), 1);
  assert_int_equal(vl_edit_distance("", "four"), 4);
  assert_int_equal(vl_edit_distance("kitten", "sitting"), 3);
  /* a name of any length is safe */
  char *endless = malloc(100001);
  memset(endless, 'a', 100000);
  endless[100000] = 0;
  assert_null(vl_nearest_name(endless, names, 5));
  free(endless);
  assert_true(vl_ends_with("IMAGE.EXR", ".exr"));
  assert_false(vl_ends_with("exr", ".exr"));
}

static void paths_join(void **state) {
  (void)state;
  char path[32];
  assert_true(vl_path_join("a/b.pbrt", "c.ply", path, sizeof path));
  assert_string_equal(path, "a/c.ply");
  assert_true(vl_path_join("b.pbrt", "c.ply", path, sizeof path));
  assert_string_equal(path, "c.ply");
  assert_true(vl_path_join("a/b.pbrt", "/c.ply", path, sizeof path));
  assert_string_equal(path, "/c.ply");
  assert_true(vl_path_join(NULL, "c.ply", path, sizeof path));
  assert_false(
      vl_path_join("a/b.pbrt", "a-name-that-is-longer-than-its-room.ply", path, sizeof path));
}

static void errors_are_cut_not_overrun(void **state) {
  (void)state;
  vlError error;
  memset(&error, 0x55, sizeof error);
  char *text = malloc(5001);
  memset(text, 'x', 5000);
  text[5000] = 0;
  assert_int_equal(vl_fail_at(&error, VL_ERROR_SCENE, text, 3, 4, "%s", text), VL_ERROR_SCENE);
  assert_int_equal(strlen(error.file), sizeof error.file - 1);
  assert_int_equal(strlen(error.message), sizeof error.message - 1);
  assert_int_equal(error.line, 3);
  assert_int_equal(error.column, 4);
  assert_int_equal(vl_fail(NULL, VL_ERROR_IO, "nobody asks"), VL_ERROR_IO);
  assert_int_equal(vl_fail(&error, VL_ERROR_IO, "%d", 7), VL_ERROR_IO);
  assert_string_equal(error.message, "7");
  assert_int_equal(error.line, 0);
  free(text);
  for (int result = VL_OK; result <= VL_CANCELLED; result++)
    assert_string_not_equal(vl_result_name((vlResult)result), vl_result_name((vlResult)99));
}

static void files_are_read_whole(void **state) {
  (void)state;
  vlContext *context = make_context(NULL);
  size_t empty = vl_context_memory(context, NULL);
  char *data = NULL;
  size_t size = 0;
  vlError error;
  put_file(in_folder("scene.pbrt"), "WorldBegin", 10);
  assert_int_equal(vl_file_read(context, in_folder("scene.pbrt"), true, &data, &size, &error),
                   VL_OK);
  assert_int_equal(size, 10);
  assert_string_equal(data, "WorldBegin");
  vl_free(context, data);

  assert_int_equal(vl_file_read(context, in_folder("scnee.pbrt"), true, &data, &size, &error),
                   VL_ERROR_MISSING);
  assert_non_null(strstr(error.message, "scene.pbrt")); /* the nearest name in that folder */
  assert_int_equal(vl_file_read(context, folder, true, &data, &size, &error), VL_ERROR_IO);
  if (access("/dev/zero", R_OK) == 0) { /* a device never ends */
    assert_int_equal(vl_file_read(context, "/dev/zero", false, &data, &size, &error),
                     VL_ERROR_IO);
    assert_string_equal(error.message, "cannot read /dev/zero: is a device");
  }
  assert_int_equal(vl_file_read(context, in_folder("scene.pbrt/x"), true, &data, &size, &error),
                   VL_ERROR_MISSING);

  put_file(in_folder("empty"), "", 0);
  assert_int_equal(vl_file_read(context, in_folder("empty"), true, &data, &size, &error),
                   VL_OK);
  assert_int_equal(size, 0);
  vl_free(context, data);
  /* a file whose size the system reports as 0 */
  assert_int_equal(vl_file_read(context, "/proc/self/maps", false, &data, &size, &error),
                   VL_OK);
  assert_true(size > 100);
  vl_free(context, data);
  assert_int_equal(vl_context_memory(context, NULL), empty);
  vl_context_destroy(context);
}

enum { PIPE_HALF = 65536 };

static void ignore_signal(int number) {
  (void)number;
}

/* Writes to a pipe, interrupts its reader while it waits for the rest, and writes the rest. */
typedef struct SlowWriter {
  const char *path;
  pthread_t reader;
} SlowWriter;

static void *write_slowly(void *user) {
  const SlowWriter *writer = user;
  char *half = calloc(1, PIPE_HALF);
  FILE *pipe = fopen(writer->path, "wb");
  if (half && pipe) {
    fwrite(half, 1, PIPE_HALF, pipe);
    fflush(pipe);
    for (int i = 0; i < 50; i++) {
      usleep(2000);
      pthread_kill(writer->reader, SIGUSR1);
    }
    fwrite(half, 1, PIPE_HALF, pipe);
  }
  if (pipe)
    fclose(pipe);
  free(half);
  return NULL;
}

/* A signal while a pipe is read does not cut off what it holds. */
static void interrupted_reads_go_on(void **state) {
  (void)state;
  vlContext *context = make_context(NULL);
  struct sigaction action = {.sa_handler = ignore_signal}, before;
  char path[512];
  snprintf(path, sizeof path, "%s", in_folder("pipe"));
  assert_int_equal(mkfifo(path, 0600), 0);
  assert_int_equal(sigaction(SIGUSR1, &action, &before), 0);
  SlowWriter writer = {path, pthread_self()};
  pthread_t thread;
  assert_int_equal(pthread_create(&thread, NULL, write_slowly, &writer), 0);
  char *data = NULL;
  size_t size = 0;
  vlError error;
  assert_int_equal(vl_file_read_given(context, path, false, &data, &size, &error), VL_OK);
  assert_int_equal(size, 2 * PIPE_HALF);
  pthread_join(thread, NULL);
  sigaction(SIGUSR1, &before, NULL);
  vl_free(context, data);
  unlink(path);
  vl_context_destroy(context);
}

static void gzip_is_unpacked(void **state) {
  (void)state;
  vlContext *context = make_context(NULL);
  size_t empty = vl_context_memory(context, NULL);
  enum { LENGTH = 300000 };
  char *text = malloc(LENGTH);
  for (int i = 0; i < LENGTH; i++)
    text[i] = (char)('a' + i % 17);
  gzFile file = gzopen(in_folder("a.gz"), "wb");
  assert_int_equal(gzwrite(file, text, LENGTH), LENGTH);
  gzclose(file);
  file = gzopen(in_folder("a.gz"), "ab"); /* a second member */
  gzwrite(file, "end", 3);
  gzclose(file);

  char *data = NULL, *packed = NULL;
  size_t size = 0, packed_size = 0;
  vlError error;
  assert_int_equal(vl_file_read(context, in_folder("a.gz"), true, &data, &size, &error), VL_OK);
  assert_int_equal(size, LENGTH + 3);
  assert_memory_equal(data, text, LENGTH);
  assert_string_equal(data + LENGTH, "end");
  vl_free(context, data);

  /* cut off or damaged at any place: an error, never a loop, never half a file */
  assert_int_equal(
      vl_file_read(context, in_folder("a.gz"), false, &packed, &packed_size, &error), VL_OK);
  for (size_t cut = 2; cut < packed_size; cut += 1 + packed_size / 40) {
    put_file(in_folder("b.gz"), packed, cut);
    vlResult result = vl_file_read(context, in_folder("b.gz"), true, &data, &size, &error);
    /* a cut between the two members leaves a whole file */
    if (result == VL_OK) {
      assert_int_equal(size, LENGTH);
      vl_free(context, data);
    } else {
      assert_int_equal(result, VL_ERROR_SCENE);
      assert_non_null(strstr(error.message, "b.gz"));
    }
  }
  vl_free(context, packed);
  free(text);
  assert_int_equal(vl_context_memory(context, NULL), empty);
  vl_context_destroy(context);
}

static void files_are_written_whole_or_not_at_all(void **state) {
  (void)state;
  vlFileWriter writer;
  vlError error;
  vlContext *context = NULL;
  assert_int_equal(vl_context_create(NULL, &context), VL_OK);
  put_file(in_folder("target"), "before", 6);
  int entries = count_entries();
  assert_int_equal(
      vl_file_open_write(&writer, context, in_folder("target"), VL_OUTPUT_PLAIN, &error),
      VL_OK);
  vl_file_write(&writer, "after!", 6);
  vl_file_abandon(&writer);
  assert_int_equal(count_entries(), entries);
  struct stat info;
  assert_int_equal(stat(in_folder("target"), &info), 0);
  assert_int_equal(info.st_size, 6);

  assert_int_equal(
      vl_file_open_write(&writer, context, in_folder("target"), VL_OUTPUT_PLAIN, &error),
      VL_OK);
  vl_file_write(&writer, "after", 5);
  vl_file_write_at(&writer, "A", 1, 0);
  assert_int_equal(vl_file_commit(&writer, &error), VL_OK);
  assert_int_equal(count_entries(), entries);
  char text[8] = {0};
  FILE *file = fopen(in_folder("target"), "rb");
  assert_int_equal(fread(text, 1, 7, file), 5);
  fclose(file);
  assert_string_equal(text, "After");

  assert_int_equal(
      vl_file_open_write(&writer, context, in_folder("none/target"), VL_OUTPUT_PLAIN, &error),
      VL_ERROR_IO);
  assert_int_equal(vl_file_open_write(&writer, context, folder, VL_OUTPUT_PLAIN, &error),
                   VL_ERROR_IO);
  /* a full disk: the written bytes cannot be kept, and commit reports an error */
  if (access("/dev/full", W_OK) == 0) {
    assert_int_equal(vl_file_open_write(&writer, context, "/dev/full", VL_OUTPUT_PLAIN, &error),
                     VL_OK);
    vl_file_write(&writer, "x", 1);
    assert_int_equal(vl_file_commit(&writer, &error), VL_ERROR_IO);
    assert_non_null(strstr(error.message, "/dev/full"));
  }
  vl_context_destroy(context);
}

/* A file that another program writes: its temporary file is named and kept by other processes,
 * and replaces the target by its commit alone. */
static void pending_files_replace_by_their_commit(void **state) {
  (void)state;
  vlPendingFile *pending = NULL;
  vlError error;
  vlContext *context = NULL;
  struct stat info;
  char text[8] = {0}, temporary[400];
  assert_int_equal(vl_context_create(NULL, &context), VL_OK);
  put_file(in_folder("video"), "before", 6);
  assert_int_equal(chmod(in_folder("video"), 0600), 0);
  const int entries = count_entries();
  for (int commits = 0; commits < 2; commits++) {
    assert_int_equal(vl_pending_file_create(context, in_folder("video"), &pending, &error),
                     VL_OK);
    snprintf(temporary, sizeof temporary, "%s", vl_pending_file_path(pending));
    assert_int_equal(stat(temporary, &info), 0);
    put_file(temporary, "after", 5);
    vl_remove_leftovers(in_folder("video"));
    assert_int_equal(stat(temporary, &info), 0);
    assert_int_equal(count_entries(), entries + 1);
    if (commits) {
      assert_int_equal(vl_pending_file_commit(pending, &error), VL_OK);
      assert_int_equal(vl_pending_file_commit(pending, &error), VL_ERROR_ARGUMENT);
    }
    vl_pending_file_destroy(pending);
    assert_int_equal(count_entries(), entries);
    FILE *file = fopen(in_folder("video"), "rb");
    memset(text, 0, sizeof text);
    assert_true(fread(text, 1, 7, file) > 0);
    fclose(file);
    assert_string_equal(text, commits ? "after" : "before");
  }
  assert_int_equal(stat(in_folder("video"), &info), 0);
  assert_int_equal(info.st_mode & 0777, 0600);
  assert_int_equal(vl_pending_file_create(context, "/dev/null", &pending, &error), VL_ERROR_IO);
  assert_null(pending);
  assert_int_equal(vl_pending_file_create(context, folder, &pending, &error), VL_ERROR_IO);
  assert_int_equal(vl_pending_file_create(context, NULL, &pending, &error), VL_ERROR_ARGUMENT);
  vl_pending_file_destroy(NULL);
  vl_context_destroy(context);
}

static void instruction_sets(void **state) {
  (void)state;
  vlIsa isa = VL_ISA_AUTO;
  unsetenv("VELO_ISA");
  assert_int_equal(vl_isa_choose(VL_ISA_AUTO, &isa), VL_OK);
  assert_int_equal(isa, vl_isa_best());
#if defined(__x86_64__)
  const vlIsa lowest = VL_ISA_V2;
  assert_int_equal(vl_isa_choose(VL_ISA_V2, &isa), VL_OK);
  assert_int_equal(isa, VL_ISA_V2);
  setenv("VELO_ISA", "v2", 1);
  assert_int_equal(vl_isa_choose(VL_ISA_AUTO, &isa), VL_OK);
  assert_int_equal(isa, VL_ISA_V2);
#else
  const vlIsa lowest = VL_ISA_BASE;
  assert_int_equal(vl_isa_choose(VL_ISA_V2, &isa), VL_ERROR_UNSUPPORTED);
#endif
  assert_int_equal(vl_isa_choose(VL_ISA_BASE, &isa), VL_OK);
  assert_int_equal(isa, lowest);
  setenv("VELO_ISA", "base", 1);
  assert_int_equal(vl_isa_choose(VL_ISA_AUTO, &isa), VL_OK);
  assert_int_equal(isa, lowest);
  /* a wish is above the environment */
  assert_int_equal(vl_isa_choose(vl_isa_best(), &isa), VL_OK);
  assert_int_equal(isa, vl_isa_best());
  setenv("VELO_ISA", "v9", 1);
  assert_int_equal(vl_isa_choose(VL_ISA_AUTO, &isa), VL_ERROR_ARGUMENT);
  unsetenv("VELO_ISA");
  assert_int_equal(vl_isa_choose((vlIsa)77, &isa), VL_ERROR_ARGUMENT);
}

/* Names from files are shortened and made printable, whatever bytes the file holds. */
static void words_of_a_list_are_found_whole(void **state) {
  (void)state;
  static const char words[] = "radius zmin zmax";
  assert_true(vl_has_word(words, "radius"));
  assert_true(vl_has_word(words, "zmin"));
  assert_true(vl_has_word(words, "zmax"));
  assert_false(vl_has_word(words, "zm"));
  assert_false(vl_has_word(words, "min"));
  assert_false(vl_has_word(words, "zmaxx"));
  assert_false(vl_has_word(words, "radius zmin")); /* a name in a file may hold blanks */
  assert_false(vl_has_word(words, ""));
  assert_false(vl_has_word("", "radius"));
  assert_false(vl_has_word("", ""));
  assert_true(vl_has_word_of(words, "zmin*", 4));
  assert_false(vl_has_word_of(words, "zmin", 3));
}

static void names_of_files_are_short(void **state) {
  (void)state;
  const struct {
    const char *name, *shown;
  } cases[] = {
      {"", ""},
      {"twelve_chars", "twelve_chars"},
      {"thirteen_char", "thirteen_cha\u2026"},
      {"a\x1b[31mb\nc\x7f", "a?[31mb?c?"},
      {"b\u00e4ckerstra\u00dfe", "b\u00e4ckerstra\u00dfe"},
      {"\U0001f600\U0001f600\U0001f600\U0001f600\U0001f600\U0001f600\U0001f600\U0001f600"
       "\U0001f600"
       "\U0001f600"
       "\U0001f600\U0001f600\U0001f600",
       "\U0001f600\U0001f600\U0001f600\U0001f600\U0001f600\U0001f600\U0001f600\U0001f600"
       "\U0001f600"
       "\U0001f600"
       "\U0001f600\U0001f600\u2026"},
      {"\xff\xc3.\xed\xa0\x80\xc0\xaf",
       "??.?????"}, /* no UTF-8: half a sequence, a surrogate, an overlong slash */
      {"a\u202eb\u200bc\xc2\x85", "a?b?c?"}, /* from right to left, no width, control */
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
    assert_string_equal(vl_short_text(cases[i].name).text, cases[i].shown);
  assert_string_equal(vl_short_text(NULL).text, "");
  assert_string_equal(vl_short_text_of("a\0b", 3).text, "a?b");

  char argument[1000], shown[1000]; /* what the caller wrote: 200 characters, or 252 bytes */
  memset(argument, 'x', sizeof argument);
  argument[200] = 0;
  assert_string_equal(vl_argument_text(argument).text, argument);
  argument[200] = 'x';
  argument[201] = 0;
  snprintf(shown, sizeof shown, "%.200s\u2026", argument);
  assert_string_equal(vl_argument_text(argument).text, shown);
  for (int i = 0; i < 100; i++)
    memcpy(argument + 4 * i, "\U0001f600", 5);
  snprintf(shown, sizeof shown, "%.*s\u2026", 4 * 63, argument);
  assert_int_equal(strlen(vl_argument_text(argument).text), 4 * 63 + 3);
  assert_string_equal(vl_argument_text(argument).text, shown);
  assert_string_equal(vl_argument_text("a\x1b[2J").text, "a?[2J");

  vlError error;
  static const char models[] = "no model \"SIMPLE_PINHOLES\"; SIMPLE_PINHOLES";
  snprintf(error.message, sizeof error.message, "%s", models);
  vl_shorten_quoted(&error, "SIMPLE_PINHOLE");
  assert_string_equal(error.message, models);
  vl_shorten_quoted(&error, "SIMPLE_PINHOLES");
  assert_string_equal(error.message, "no model \"SIMPLE_PINHO\u2026\"; SIMPLE_PINHOLES");

  /* whole messages and names of files, too; a character that the buffer's end has cut is
   * removed */
  vl_fail_at(&error, VL_ERROR_SCENE, "a\x1b]0;title\x07.pbrt", 1, 1, "%s",
             "some\nfile\x1b[2J\u00e4.png");
  assert_string_equal(error.file, "a?]0;title?.pbrt");
  assert_string_equal(error.message, "some file?[2J\u00e4.png");
  char longer[600];
  for (size_t i = 0; i < 598; i += 2)
    memcpy(longer + i, "\u00e4", 3);
  vl_fail(&error, VL_ERROR_SCENE, "%s", longer);
  assert_int_equal(strlen(error.message), 510);
}

int main(void) {
  const char *temporary = getenv("TMPDIR");
  snprintf(folder, sizeof folder, "%s/velo-base-XXXXXX", temporary ? temporary : "/tmp");
  if (!mkdtemp(folder))
    return 1;
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(memory_is_counted),
      cmocka_unit_test(arrays_grow_and_survive_refusal),
      cmocka_unit_test(contexts_check_their_def),
      cmocka_unit_test(nearest_names),
      cmocka_unit_test(paths_join),
      cmocka_unit_test(names_of_files_are_short),
      cmocka_unit_test(errors_are_cut_not_overrun),
      cmocka_unit_test(files_are_read_whole),
      cmocka_unit_test(interrupted_reads_go_on),
      cmocka_unit_test(gzip_is_unpacked),
      cmocka_unit_test(files_are_written_whole_or_not_at_all),
      cmocka_unit_test(pending_files_replace_by_their_commit),
      cmocka_unit_test(words_of_a_list_are_found_whole),
      cmocka_unit_test(instruction_sets),
  };
  int result = cmocka_run_group_tests(tests, NULL, NULL);
  char command[300];
  snprintf(command, sizeof command, "rm -rf '%s'", folder);
  if (system(command) != 0)
    return 1;
  return result;
}
