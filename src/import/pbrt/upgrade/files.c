/* import/pbrt/upgrade/files.c: names of files, and included files. */
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/context.h"
#include "base/text.h"
#include "import/find.h"
#include "import/pbrt/upgrade/upgrade.h"

/* The path from one absolute folder to an absolute file. */
static bool relative(const char *folder, const char *file, char *result, size_t size) {
  size_t same = 0, at = 0, n = 0;
  while (folder[at] && folder[at] == file[at]) {
    at++;
    if (folder[at - 1] == '/') same = at;
  }
  if (!folder[at] && file[at] == '/')
    same = at + 1;
  else if (!folder[at] && at && folder[at - 1] == '/')
    same = at;
  result[0] = 0;
  for (const char *f = folder + (same < strlen(folder) ? same : strlen(folder)); *f;) {
    n += (size_t)snprintf(result + n, n < size ? size - n : 0, "../");
    f += strcspn(f, "/");
    f += *f == '/';
    if (n >= size) return false;
  }
  n += (size_t)snprintf(result + n, size - n, "%s", file + same);
  return n < size;
}

/* pbrt-v3's measured metals, which pbrt-v4 has by name. */
static bool is_metal(const char *name, char *result, size_t size) {
  static const char *const metals[] = {"Ag", "Al", "Au", "Cu", "CuZn", "MgO", "TiO2"};
  static const char *const parts[] = {"eta", "k"};
  const char *slash = strrchr(name, '/'), *base = slash ? slash + 1 : name;
  char known[32];
  for (size_t i = 0; i < sizeof metals / sizeof *metals; i++)
    for (int k = 0; k < 2; k++) {
      snprintf(known, sizeof known, "%s.%s.spd", metals[i], parts[k]);
      if (strcmp(known, base) == 0) return snprintf(result, size, "metal-%s-%s", metals[i], parts[k]) > 0;
    }
  return false;
}

bool vl_old_file_name(vlOldFile *file, uint32_t line, const char *name, char *result, size_t size) {
  vlUpgrade *u = file->u;
  char path[4096], beside[4096], real[PATH_MAX];
  if (is_metal(name, result, size)) return true;
  vlFound found = vl_find_file(file->path, u->first, u->def->search_path, name, path, sizeof path);
  if (found == VL_FOUND_TOO_LONG || strlen(name) >= size)
    return vl_old_fail(file, VL_ERROR_SCENE, line, 0, "file name too long");
  snprintf(result, size, "%s", name);
  if (found == VL_FOUND_NOT) {
    vl_old_lose(file, line, "there is no file \"%s\": its name stays as it is", name);
    return true;
  }
  struct stat info;
  bool first = vl_path_join(u->first, name, beside, sizeof beside) && stat(beside, &info) == 0;
  if (name[0] == '/' || (u->same_folder && first)) return true;
  if (!realpath(first ? beside : path, real) || !relative(u->to_folder, real, result, size))
    return vl_old_fail(file, VL_ERROR_SCENE, line, 0, "file name too long: %s", path);
  return true;
}

/* ---- Include ----------------------------------------------------------------------------------------------------- */

static vlOldInclude *find_include(vlUpgrade *u, const char *path) {
  for (size_t i = 0; i < u->includes.count; i++)
    if (strcmp(u->includes.items[i].path, path) == 0) return &u->includes.items[i];
  return NULL;
}

/* The name of a changed file: its own in another folder, else with -v4; never an existing file of the old scene. */
static bool new_name(vlUpgrade *u, const char *name, const char *path, char *result, size_t size) {
  char clean[4096], real[PATH_MAX], folder[PATH_MAX + 4200];
  const char *from = name[0] == '/' || strncmp(name, "../", 3) == 0 || strstr(name, "/../") ? NULL : name;
  if (!from) from = strrchr(path, '/') ? strrchr(path, '/') + 1 : path;
  while (strncmp(from, "./", 2) == 0) from += 2;
  size_t length = strlen(from);
  if (vl_ends_with(from, ".gz")) length -= 3;
  snprintf(clean, sizeof clean, "%.*s", (int)length, from);
  bool suffix = vl_ends_with(clean, ".pbrt");
  size_t stem = strlen(clean) - (suffix ? 5 : 0);
  snprintf(folder, sizeof folder, "%s/%s", u->to_folder, clean);
  bool clash = realpath(folder, real) != NULL && u->same_folder;
  int n = snprintf(result, size, "%.*s%s%s", (int)stem, clean, clash ? "-v4" : "", suffix ? ".pbrt" : clean + stem);
  return n > 0 && (size_t)n < size;
}

void vl_old_make_folders(const vlUpgrade *u, const char *path) {
  char folder[PATH_MAX + 4200];
  snprintf(folder, sizeof folder, "%s", path);
  size_t base = strlen(u->to_folder) + 1;
  for (char *slash = strchr(folder + base, '/'); slash; slash = strchr(slash + 1, '/')) {
    *slash = 0;
    mkdir(folder, 0777); /* writing the file reports a failure */
    *slash = '/';
  }
}

/* Keeps a file to be written at the end. Takes the text. */
static bool keep_output(vlUpgrade *u, const char *name, char *text) {
  char path[PATH_MAX + 4200];
  snprintf(path, sizeof path, "%s/%s", u->to_folder, name);
  char **slot = VL_PUSH(u->context, &u->outputs), *copy = vl_strdup(u->context, path);
  char **second = slot && copy ? VL_PUSH(u->context, &u->outputs) : NULL;
  if (slot) u->outputs.items[u->outputs.count - (second ? 2 : 1)] = copy;
  if (!second) {
    if (!slot) vl_free(u->context, copy);
    vl_free(u->context, text);
    return vl_old_fail_memory(u);
  }
  *second = text;
  return true;
}

bool vl_old_include(vlOldFile *file, vlOldStatement *s) {
  vlUpgrade *u = file->u;
  char path[4096], name[4096];
  vlFound found = vl_find_file(file->path, u->first, u->def->search_path, s->name[0], path, sizeof path);
  if (found == VL_FOUND_TOO_LONG) return vl_old_fail(file, VL_ERROR_SCENE, s->line, s->column, "file name too long");
  if (u->depth > 64)
    return vl_old_fail(file, VL_ERROR_SCENE, s->line, s->column, "files include each other more than 64 deep");
  if (found == VL_FOUND_NOT) {
    vl_old_lose(file, s->line, "there is no file \"%s\": its name stays as it is", s->name[0]);
    return true;
  }
  vlOldInclude *known = find_include(u, path);
  if (!known) {
    char *text = NULL;
    bool changed;
    u->depth++;
    if (!vl_old_upgrade_file(u, path, &text, &changed)) return false;
    u->depth--;
    if (!changed) {
      vl_free(u->context, text);
      if (!vl_old_file_name(file, s->line, s->name[0], name, sizeof name)) return false;
    } else {
      if (!new_name(u, s->name[0], path, name, sizeof name))
        return vl_free(u->context, text), vl_old_fail(file, VL_ERROR_SCENE, s->line, s->column, "file name too long");
      if (!keep_output(u, name, text)) return false;
    }
    known = VL_PUSH(u->context, &u->includes);
    if (!known) return vl_old_fail_memory(u);
    *known = (vlOldInclude){vl_strdup(u->context, path), vl_strdup(u->context, name)};
    if (!known->path || !known->name) return vl_old_fail_memory(u);
  }
  return vl_old_rename(file, s, 0, known->name);
}
