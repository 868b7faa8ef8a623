/* test/fuzz/replay.c: runs a fuzz target without libFuzzer over files and directories: each
 * file unchanged and, with --mutate N, in N damaged forms (fixed seed: bytes changed, cut off,
 * duplicated, replaced by special values). Prints the number of inputs. A crash or a
 * sanitizer's report is a failure. */
#include <dirent.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static unsigned long runs;
static unsigned long mutations;

static uint32_t next(uint64_t *state) {
  *state = *state * 6364136223846793005u + 1442695040888963407u;
  return (uint32_t)(*state >> 33);
}

/* In place; room for twice the size. Returns the new size. */
static size_t damage(uint8_t *data, size_t size, uint64_t *state) {
  static const char *const telling[] = {
      "4294967295",      "-1", "nan", "inf", "1e39", "\"", "[", "]", "\xff\xff\xff\xff",
      "\x00\x00\x00\x80"};
  unsigned rounds = 1 + next(state) % 8;
  size_t room = 2 * size + 64;
  for (unsigned i = 0; i < rounds && size > 0; i++) {
    size_t at = next(state) % size;
    const char *word = telling[next(state) % (sizeof telling / sizeof *telling)];
    size_t length = strlen(word) ? strlen(word) : 4;
    switch (next(state) % 6) {
      case 0:
        data[at] = (uint8_t)next(state);
        break;
      case 1:
        data[at] ^= (uint8_t)(1u << next(state) % 8);
        break;
      case 2:
        size = at;
        break;
      case 3:
        if (at + length <= size)
          memcpy(data + at, word, length);
        break;
      case 4: {
        size_t count = 1 + next(state) % 32;
        if (at + count > size)
          count = size - at;
        if (size + count <= room) {
          memmove(data + at + count, data + at, size - at);
          size += count;
        }
        break;
      }
      default: {
        size_t count = 1 + next(state) % 32;
        if (at + count > size)
          count = size - at;
        memmove(data + at, data + at + count, size - at - count);
        size -= count;
      }
    }
  }
  return size;
}

/* The target gets a block of exactly its size, so that a sanitizer sees a read past the end. */
static void once(const uint8_t *data, size_t size) {
  uint8_t *exact = malloc(size ? size : 1);
  if (!exact)
    return;
  memcpy(exact, data, size);
  LLVMFuzzerTestOneInput(exact, size);
  free(exact);
  runs++;
}

static int replay_file(const char *path) {
  FILE *file = fopen(path, "rb");
  if (!file) {
    perror(path);
    return 1;
  }
  fseek(file, 0, SEEK_END);
  long size = ftell(file);
  rewind(file);
  if (size < 0)
    size = 0;
  uint8_t *data = malloc((size_t)size + 1), *work = malloc(2 * (size_t)size + 64);
  int failed = !data || !work || fread(data, 1, (size_t)size, file) != (size_t)size;
  fclose(file);
  if (!failed) {
    once(data, (size_t)size);
    uint64_t state = 1;
    for (unsigned long i = 0; i < mutations; i++) {
      memcpy(work, data, (size_t)size);
      once(work, damage(work, (size_t)size, &state));
    }
  }
  free(data);
  free(work);
  return failed;
}

static int replay(const char *path) {
  struct stat info;
  if (stat(path, &info) != 0) {
    perror(path);
    return 1;
  }
  if (!S_ISDIR(info.st_mode))
    return replay_file(path);
  struct dirent **entries;
  int count = scandir(path, &entries, NULL, alphasort), failed = 0;
  for (int i = 0; i < count; i++) {
    char name[4096];
    if (entries[i]->d_name[0] != '.' &&
        snprintf(name, sizeof name, "%s/%s", path, entries[i]->d_name) < (int)sizeof name)
      failed |= replay(name);
    free(entries[i]);
  }
  if (count >= 0)
    free(entries);
  return failed;
}

int main(int count, char **arguments) {
  int failed = 0;
  for (int i = 1; i < count; i++) {
    if (strcmp(arguments[i], "--mutate") == 0 && i + 1 < count)
      mutations = strtoul(arguments[++i], NULL, 10);
    else
      failed |= replay(arguments[i]);
  }
  printf("%lu inputs\n", runs);
  return failed;
}
