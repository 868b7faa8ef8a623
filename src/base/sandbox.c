/* base/sandbox.c: see sandbox.h. A path is followed by component, as the system does it, since
 * realpath tells a missing folder outside from one that is there
 * ("outside/folder/../../inside/file"). */
#include "base/sandbox.h"
#include "base/text.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h> /* realpath */
#include <unistd.h>

enum { MAX_LINKS = 40 };

static void *take(const vlSandbox *sandbox, size_t size) {
  return sandbox->allocator.allocate(sandbox->allocator.user, size);
}

static void give_back(const vlSandbox *sandbox, void *block) {
  if (block)
    sandbox->allocator.release(sandbox->allocator.user, block);
}

static char *copy_text(const vlSandbox *sandbox, const char *text) {
  const size_t size = strlen(text) + 1;
  char *copy = take(sandbox, size);
  if (copy)
    memcpy(copy, text, size);
  return copy;
}

vlResult vl_sandbox_make(vlSandbox *sandbox, const vlAllocator *allocator,
                         const char *const *folders, uint32_t count) {
  char real[PATH_MAX];
  pthread_mutex_init(&sandbox->mutex, NULL);
  sandbox->allocator = *allocator;
  if (!count)
    return VL_OK;
  if (!(sandbox->folders = take(sandbox, count * sizeof *sandbox->folders)))
    return VL_ERROR_MEMORY;
  for (uint32_t i = 0; i < count; i++) {
    if (!realpath(folders[i], real))
      return VL_ERROR_MISSING;
    if (!(sandbox->folders[i] = copy_text(sandbox, real)))
      return VL_ERROR_MEMORY;
    sandbox->count++;
  }
  return VL_OK;
}

void vl_sandbox_free(vlSandbox *sandbox) {
  for (uint32_t i = 0; i < sandbox->count; i++)
    give_back(sandbox, sandbox->folders[i]);
  for (size_t i = 0; i < sandbox->passed_count; i++)
    give_back(sandbox, sandbox->passed[i]);
  give_back(sandbox, sandbox->folders);
  give_back(sandbox, sandbox->passed);
  pthread_mutex_destroy(&sandbox->mutex);
}

/* Whether a path is a folder or lies in it. Compares whole components: /a/b is not beneath
 * /a/bc. */
static bool is_beneath(const char *path, const char *folder) {
  size_t n = strlen(folder);
  if (n && folder[n - 1] == '/')
    n--;
  return strncmp(path, folder, n) == 0 && (path[n] == '/' || !path[n]);
}

static bool is_inside(const vlSandbox *sandbox, const char *path) {
  for (uint32_t i = 0; i < sandbox->count; i++)
    if (is_beneath(path, sandbox->folders[i]))
      return true;
  return false;
}

/* Whether a name may lead through this folder: it is in the sandbox, or known to be there. */
static bool is_passable(vlSandbox *sandbox, const char *folder) {
  if (is_inside(sandbox, folder))
    return true;
  for (uint32_t i = 0; i < sandbox->count; i++)
    if (is_beneath(sandbox->folders[i], folder))
      return true;
  bool found = false;
  pthread_mutex_lock(&sandbox->mutex);
  for (size_t i = 0; i < sandbox->passed_count && !found; i++)
    found = is_beneath(sandbox->passed[i], folder);
  pthread_mutex_unlock(&sandbox->mutex);
  return found;
}

/* A path on its way: `at` is absolute and without links, `rest` is still to be followed. */
typedef struct Walk {
  char at[PATH_MAX], rest[PATH_MAX], start[PATH_MAX];
  int links;
  bool missing; /* nothing is at `at`: names below it are no links */
} Walk;

/* The text is shorter than PATH_MAX. */
static void set(char at[PATH_MAX], const char *text) {
  memcpy(at, text, strlen(text) + 1);
}

static void go_up(char *at) {
  char *slash = strrchr(at, '/');
  slash[slash == at] = 0;
}

static bool go_down(char *at, const char *name, size_t length) {
  size_t n = strlen(at);
  if (n == 1)
    n = 0; /* "/" */
  if (n + 1 + length >= PATH_MAX)
    return false;
  at[n] = '/';
  memcpy(at + n + 1, name, length);
  at[n + 1 + length] = 0;
  return true;
}

/* Puts the target of the link at `at` before the rest. */
static bool follow(Walk *walk, const char *link) {
  char rest[PATH_MAX];
  int n = snprintf(rest, sizeof rest, "%s/%s", link, walk->rest);
  if (n < 0 || (size_t)n >= sizeof rest || ++walk->links > MAX_LINKS)
    return false;
  memcpy(walk->rest, rest, (size_t)n + 1);
  if (*link == '/')
    set(walk->at, "/");
  else
    go_up(walk->at);
  return true;
}

/* Follows the first component of the rest. False: it leads outside. */
static bool step(vlSandbox *sandbox, Walk *walk) {
  char name[PATH_MAX], link[PATH_MAX];
  size_t skip = strspn(walk->rest, "/"), length = strcspn(walk->rest + skip, "/");
  memcpy(name, walk->rest + skip, length);
  name[length] = 0;
  memmove(walk->rest, walk->rest + skip + length, strlen(walk->rest + skip + length) + 1);
  if (!length || vl_text_is(name, "."))
    return true;
  if (!is_passable(sandbox, walk->at) && !is_beneath(walk->start, walk->at))
    return false;
  if (vl_text_is(name, "..")) {
    go_up(walk->at);
    return true;
  }
  if (!go_down(walk->at, name, length))
    return false;
  ssize_t n = walk->missing ? -1 : readlink(walk->at, link, sizeof link - 1);
  if (n > 0) {
    link[n] = 0;
    return follow(walk, link);
  }
  walk->missing |= access(walk->at, F_OK) != 0;
  return true;
}

bool vl_sandbox_allows(vlSandbox *sandbox, const char *path) {
  if (!sandbox->count)
    return true;
  Walk walk = {.links = 0};
  if (strlen(path) >= sizeof walk.rest)
    return false;
  set(walk.rest, path);
  if (!getcwd(walk.start, sizeof walk.start) || *walk.start != '/')
    set(walk.start, "/");
  set(walk.at, *path == '/' ? "/" : walk.start);
  while (*walk.rest)
    if (!step(sandbox, &walk))
      return false;
  return is_inside(sandbox, walk.at);
}

void vl_sandbox_pass(vlSandbox *sandbox, const char *path) {
  char folder[PATH_MAX], real[PATH_MAX];
  if (!sandbox->count)
    return;
  if (!vl_folder_of(path, folder, sizeof folder) || !realpath(folder, real))
    return;
  pthread_mutex_lock(&sandbox->mutex);
  bool known = false;
  for (size_t i = 0; i < sandbox->passed_count && !known; i++)
    known = vl_text_is(sandbox->passed[i], real);
  char **grown = known ? NULL : take(sandbox, (sandbox->passed_count + 1) * sizeof *grown);
  if (grown) {
    if (sandbox->passed)
      memcpy(grown, sandbox->passed, sandbox->passed_count * sizeof *grown);
    give_back(sandbox, sandbox->passed);
    sandbox->passed = grown;
    grown[sandbox->passed_count] = copy_text(sandbox, real);
    if (grown[sandbox->passed_count])
      sandbox->passed_count++;
  }
  pthread_mutex_unlock(&sandbox->mutex);
}
