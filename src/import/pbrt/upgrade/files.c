/* import/pbrt/upgrade/files.c: names of files, and included files. */
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

#include "base/context.h"
#include "base/text.h"
#include "import/pbrt/upgrade/upgrade.h"

/* The path from one absolute folder to an absolute file. */
static bool relative(const char *folder, const char *file, char *result, size_t size) {
  size_t same = 0, at = 0, n = 0;
  while (folder[at] && folder[at] == file[at]) {
    at++;
    if (folder[at - 1] == '/')
      same = at;
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
    if (n >= size)
      return false;
  }
  n += (size_t)snprintf(result + n, size - n, "%s", file + same);
  return n < size;
}

/* pbrt-v3's measured metals, which pbrt-v4 has by name. */
static bool is_metal(const char *name, char *result, size_t size) {
  static const char *const metals[] = {"Ag", "Al", "Au", "Cu", "CuZn", "MgO", "TiO2"};
  static const char *const parts[] = {"eta", "k"};
  const char *base = vl_file_name(name);
  char known[32];
  for (size_t i = 0; i < VL_LENGTH(metals); i++)
    for (int k = 0; k < 2; k++) {
      snprintf(known, sizeof known, "%s.%s.spd", metals[i], parts[k]);
      if (vl_text_is(known, base))
        return snprintf(result, size, "metal-%s-%s", metals[i], parts[k]) > 0;
    }
  return false;
}

vlFound vl_old_find_file(const vlOldStatement *s, const char *name, const char *what,
                         const char *otherwise, char path[4096]) {
  vlUpgrade *u = s->u;
  const vlFound found =
      vl_find_file(u->context, s->file->path, u->first, u->def->search_path, name, path, 4096);
  if (found == VL_FOUND_NOT) {
    u->missing++;
    vl_old_lose(s, "there is no %s \"%s\": %s", what, name, otherwise);
  }
  return found;
}

static const char same_name[] = "its name stays as it is";

bool vl_old_file_name(const vlOldStatement *s, const char *name, char *result, size_t size) {
  vlUpgrade *u = s->u;
  char path[4096], beside[4096], real[PATH_MAX];
  if (is_metal(name, result, size))
    return true;
  const vlFound found = vl_old_find_file(s, name, "file", same_name, path);
  if (found == VL_FOUND_TOO_LONG || strlen(name) >= size)
    return vl_old_fail(s->file, VL_ERROR_SCENE, s->line, 0, "file name too long");
  snprintf(result, size, "%s", name);
  if (found == VL_FOUND_NOT)
    return true;
  struct stat info;
  bool first = vl_path_join(u->first, name, beside, sizeof beside) &&
               vl_context_allows(u->context, beside) && stat(beside, &info) == 0;
  if (name[0] == '/' || (u->same_folder && first))
    return true;
  if (!realpath(first ? beside : path, real) || !relative(u->to_folder, real, result, size))
    return vl_old_fail(s->file, VL_ERROR_SCENE, s->line, 0, "file name too long: %s", path);
  return true;
}

bool vl_old_write_file_name(vlOldStatement *s, const vlOldParam *p) {
  char name[4096];
  if (!p || !p->strings)
    return true;
  return vl_old_file_name(s, p->text[0], name, sizeof name) &&
         vl_old_put_name(s, p, name, "filename is");
}

bool vl_old_put_name(vlOldStatement *s, const vlOldParam *p, const char *name,
                     const char *note) {
  if (vl_text_is(name, p->text[0]))
    return true;
  vl_old_note(s, "%s \"%s\"", note, name);
  return vl_old_edit(s, p->span[0], "\"%s\"", name);
}

/* ---- Include ----------------------------------------------------------------------------- */

static const vlOldInclude *find_include(vlUpgrade *u, const char *path) {
  for (size_t i = 0; i < u->includes.count; i++)
    if (vl_text_is(u->includes.items[i].path, path))
      return &u->includes.items[i];
  return NULL;
}

/* The name of a changed file: its own in another folder, else with -v4; never an existing file
 * of the old scene. */
static bool new_name(vlUpgrade *u, const char *name, const char *path, char *result,
                     size_t size) {
  char clean[4096], real[PATH_MAX], folder[PATH_MAX + 4200];
  const char *from =
      name[0] == '/' || strncmp(name, "../", 3) == 0 || strstr(name, "/../") ? NULL : name;
  if (!from)
    from = path + vl_folder_length(path);
  while (strncmp(from, "./", 2) == 0)
    from += 2;
  size_t length = strlen(from);
  if (vl_ends_with(from, ".gz"))
    length -= 3;
  snprintf(clean, sizeof clean, "%.*s", (int)length, from);
  bool suffix = vl_ends_with(clean, ".pbrt");
  size_t stem = strlen(clean) - (suffix ? 5 : 0);
  snprintf(folder, sizeof folder, "%s/%s", u->to_folder, clean);
  bool clash = realpath(folder, real) != NULL && u->same_folder;
  int n = snprintf(result, size, "%.*s%s%s", (int)stem, clean, clash ? "-v4" : "",
                   suffix ? ".pbrt" : clean + stem);
  return n > 0 && (size_t)n < size;
}

/* Keeps a file to be written at the end. Takes the text. */
static bool keep_output(vlUpgrade *u, const char *name, char *text) {
  char **slot = VL_PUSH(u->context, &u->outputs), *copy = vl_strdup(u->context, name);
  char **second = slot && copy ? VL_PUSH(u->context, &u->outputs) : NULL;
  if (slot)
    u->outputs.items[u->outputs.count - (second ? 2 : 1)] = copy;
  if (!second) {
    if (!slot)
      vl_free(u->context, copy);
    vl_free(u->context, text);
    return vl_old_fail_memory(u);
  }
  *second = text;
  return true;
}

/* Whether a file that was included before has the text; null: that of the old file. */
static const vlOldInclude *find_text(const vlUpgrade *u, const char *path, const char *text) {
  VL_EACH_ITEM(const vlOldInclude, n, &u->includes) {
    if (vl_text_is(n->path, path) &&
        (n->text && text ? vl_text_is(n->text, text) : n->text == text))
      return n;
  }
  return NULL;
}

/* The name of the new file; a number is added where another file has it. */
static bool choose_name(const vlOldStatement *s, const char *path, const char *text, char *name,
                        size_t size) {
  vlUpgrade *u = s->u;
  if (!new_name(u, s->name[0], path, name, size))
    return vl_old_wrong(s, "file name too long");
  u->result = vl_file_set_name(&u->files, name, size, text, strlen(text), &u->error);
  return u->result == VL_OK;
}

/* Upgrades the file, and names the new one. first: it was not included before. Null after an
 * error. */
static const vlOldInclude *read_include(const vlOldStatement *s, const char *path, bool first) {
  vlUpgrade *u = s->u;
  vlOldFile file = {.u = u, .path = path};
  char name[4096], *text;
  const size_t made = u->names.count;
  const uint32_t referred = u->referred;
  const bool quiet = u->quiet;
  u->depth++;
  u->quiet = quiet || !first;
  const bool fine = vl_old_upgrade_file(&file, &text), changed = file.edits.count > 0;
  vl_old_free_file(&file);
  u->quiet = quiet;
  u->depth--;
  if (!fine)
    return NULL;
  if (!changed) {
    vl_free(u->context, text);
    text = NULL;
  }
  const vlOldInclude *known = find_text(u, path, text);
  if (known) {
    vl_free(u->context, text);
    return known;
  }
  if (!text && !vl_old_file_name(s, s->name[0], name, sizeof name))
    return NULL;
  if (text && !choose_name(s, path, text, name, sizeof name)) {
    vl_free(u->context, text);
    return NULL;
  }
  if (text && !keep_output(u, name, text))
    return NULL;
  vlOldInclude *n = VL_PUSH(u->context, &u->includes);
  if (!n) {
    vl_old_fail_memory(u);
    return NULL;
  }
  *n = (vlOldInclude){.path = vl_strdup(u->context, path),
                      .name = vl_strdup(u->context, name),
                      .text = text,
                      .makes = u->names.count > made,
                      .refers = u->referred > referred};
  if (!n->path || !n->name) {
    vl_old_fail_memory(u);
    return NULL;
  }
  return n;
}

bool vl_old_include(vlOldStatement *s) {
  vlUpgrade *u = s->u;
  char path[4096];
  const vlFound found = vl_old_find_file(s, s->name[0], "file", same_name, path);
  if (found == VL_FOUND_TOO_LONG)
    return vl_old_wrong(s, "file name too long");
  if (u->depth > 64)
    return vl_old_wrong(s, "files include each other more than 64 deep");
  if (found == VL_FOUND_NOT)
    return true;
  const vlOldInclude *known = find_include(u, path);
  if (!known || known->makes || (known->refers && u->renamed))
    known = read_include(s, path, !known);
  return known && vl_old_rename(s, 0, known->name);
}
