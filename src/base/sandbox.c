/* base/sandbox.c: see sandbox.h. A path is followed by component, as the system does it, since realpath tells a missing
 * folder outside from one that is there ("outside/folder/../../inside/file"). */
#include "base/sandbox.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MOST_LINKS = 40 };

vlResult vl_sandbox_make(vlSandbox *sandbox, const char *const *folders, uint32_t count) {
  pthread_mutex_init(&sandbox->mutex, NULL);
  if (!count) return VL_OK;
  if (!(sandbox->folders = calloc(count, sizeof *sandbox->folders))) return VL_ERROR_MEMORY;
  sandbox->count = count;
  for (uint32_t i = 0; i < count; i++)
    if (!(sandbox->folders[i] = realpath(folders[i], NULL))) return VL_ERROR_MISSING;
  return VL_OK;
}

void vl_sandbox_free(vlSandbox *sandbox) {
  for (uint32_t i = 0; i < sandbox->count; i++) free(sandbox->folders[i]);
  for (size_t i = 0; i < sandbox->passed_count; i++) free(sandbox->passed[i]);
  free(sandbox->folders);
  free(sandbox->passed);
  pthread_mutex_destroy(&sandbox->mutex);
}

/* Whether a path is a folder or lies in it. Compares whole components: /a/b is not beneath /a/bc. */
static bool is_beneath(const char *path, const char *folder) {
  size_t n = strlen(folder);
  if (n && folder[n - 1] == '/') n--;
  return strncmp(path, folder, n) == 0 && (path[n] == '/' || !path[n]);
}

static bool is_inside(const vlSandbox *sandbox, const char *path) {
  for (uint32_t i = 0; i < sandbox->count; i++)
    if (is_beneath(path, sandbox->folders[i])) return true;
  return false;
}

/* Whether a name may lead through this folder: it is in the sandbox, or known to be there. */
static bool is_passable(vlSandbox *sandbox, const char *folder) {
  if (is_inside(sandbox, folder)) return true;
  for (uint32_t i = 0; i < sandbox->count; i++)
    if (is_beneath(sandbox->folders[i], folder)) return true;
  bool found = false;
  pthread_mutex_lock(&sandbox->mutex);
  for (size_t i = 0; i < sandbox->passed_count && !found; i++) found = is_beneath(sandbox->passed[i], folder);
  pthread_mutex_unlock(&sandbox->mutex);
  return found;
}

/* A path on its way: `at` is absolute and without links, `rest` is still to be followed. */
typedef struct Walk {
  char at[PATH_MAX], rest[PATH_MAX], start[PATH_MAX];
  int links;
  bool missing; /* nothing is at `at`: names below it are no links */
} Walk;

static void go_up(char *at) {
  char *slash = strrchr(at, '/');
  slash[slash == at] = 0;
}

static bool go_down(char *at, const char *name, size_t length) {
  size_t n = strlen(at);
  if (n == 1) n = 0; /* "/" */
  if (n + 1 + length >= PATH_MAX) return false;
  at[n] = '/';
  memcpy(at + n + 1, name, length);
  at[n + 1 + length] = 0;
  return true;
}

/* Puts the target of the link at `at` before the rest. */
static bool follow(Walk *walk, const char *link) {
  char rest[PATH_MAX];
  int n = snprintf(rest, sizeof rest, "%s/%s", link, walk->rest);
  if (n < 0 || (size_t)n >= sizeof rest || ++walk->links > MOST_LINKS) return false;
  memcpy(walk->rest, rest, (size_t)n + 1);
  if (*link == '/')
    strcpy(walk->at, "/");
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
  if (!length || strcmp(name, ".") == 0) return true;
  if (!is_passable(sandbox, walk->at) && !is_beneath(walk->start, walk->at)) return false;
  if (strcmp(name, "..") == 0) return go_up(walk->at), true;
  if (!go_down(walk->at, name, length)) return false;
  ssize_t n = walk->missing ? -1 : readlink(walk->at, link, sizeof link - 1);
  if (n > 0) {
    link[n] = 0;
    return follow(walk, link);
  }
  walk->missing |= access(walk->at, F_OK) != 0;
  return true;
}

bool vl_sandbox_allows(vlSandbox *sandbox, const char *path) {
  Walk walk = {.links = 0};
  if (!sandbox->count) return true;
  if (strlen(path) >= sizeof walk.rest) return false;
  strcpy(walk.rest, path);
  if (!getcwd(walk.start, sizeof walk.start) || *walk.start != '/') strcpy(walk.start, "/");
  strcpy(walk.at, *path == '/' ? "/" : walk.start);
  while (*walk.rest)
    if (!step(sandbox, &walk)) return false;
  return is_inside(sandbox, walk.at);
}

void vl_sandbox_pass(vlSandbox *sandbox, const char *path) {
  char folder[PATH_MAX];
  if (!sandbox->count) return;
  const char *slash = strrchr(path, '/');
  int n = slash ? snprintf(folder, sizeof folder, "%.*s/", (int)(slash - path), path)
                : snprintf(folder, sizeof folder, ".");
  char *real = n > 0 && (size_t)n < sizeof folder ? realpath(folder, NULL) : NULL;
  pthread_mutex_lock(&sandbox->mutex);
  bool known = !real;
  for (size_t i = 0; i < sandbox->passed_count && !known; i++) known = strcmp(sandbox->passed[i], real) == 0;
  char **grown = known ? NULL : realloc(sandbox->passed, (sandbox->passed_count + 1) * sizeof *grown);
  if (grown) {
    grown[sandbox->passed_count++] = real;
    sandbox->passed = grown;
    real = NULL;
  }
  pthread_mutex_unlock(&sandbox->mutex);
  free(real);
}
