/* import/pbrt/report.c: errors and warnings with their sources (file, line, column), kept
 * strings, paths. */

#include "base/file.h"
#include "base/text.h"
#include "color/color.h"
#include "import/pbrt/builder.h"

/* ---- errors ------------------------------------------------------------------------------ */

bool vl_import_fail(vlImport *import, vlResult code, vlSource source, const char *format, ...) {
  char text[512];
  VL_FORMAT(text, format);
  return vl_scene_fail(import->scene, code, source, "%s", text);
}

bool vl_import_wrong(vlImport *import, vlSource source, const char *format, ...) {
  char text[512];
  VL_FORMAT(text, format);
  return vl_import_fail(import, VL_ERROR_SCENE, source, "%s", text);
}

bool vl_dict_fail_at(const vlDict *dict, vlSource source, const char *format, ...) {
  char text[512];
  VL_FORMAT(text, format);
  return vl_import_wrong(dict->import, source, "%s: %s", dict->what, text);
}

bool vl_dict_fail(const vlDict *dict, const char *format, ...) {
  char text[512];
  VL_FORMAT(text, format);
  return vl_dict_fail_at(dict, dict->source, "%s", text);
}

bool vl_import_fine(const vlImport *import) {
  return import->scene->error.code == VL_OK;
}

bool vl_import_fail_memory(vlImport *import) {
  return vl_import_fail(import, VL_ERROR_MEMORY, (vlSource){0}, "out of memory");
}

static void log_text(vlImport *import, vlLogLevel level, vlSource source, const char *text) {
  vlError where = {0};
  vl_fail_source(&where, VL_OK, source, "%s", "");
  vl_log(import->context, level, &where, "%s", text);
}

void vl_import_warn(vlImport *import, vlLogLevel level, vlSource source, const char *format,
                    ...) {
  char text[512];
  VL_FORMAT(text, format);
  log_text(import, level, source, text);
}

void vl_dict_warn(const vlDict *dict, const char *format, ...) {
  char text[512];
  VL_FORMAT(text, format);
  vl_import_warn(dict->import, VL_LOG_WARNING, dict->source, "%s: %s", dict->what, text);
}

bool vl_import_recover(vlImport *import) {
  vlScene *scene = import->scene;
  if (!scene->problem || scene->error.code == VL_ERROR_MEMORY || scene->error.code == VL_OK)
    return false;
  if (++import->problems > VL_IMPORT_PROBLEMS)
    return false;
  vlError problem = scene->error;
  vl_error_clear(&scene->error);
  scene->problem(scene->problem_user, &problem);
  return true;
}

void vl_import_remark(vlImport *import, vlSource source, const char *format, ...) {
  if (!import->scene->problem)
    return;
  char text[400];
  VL_FORMAT(text, format);
  vlError remark = {0};
  vl_fail_source(&remark, VL_OK, source, "%s", text);
  import->scene->problem(import->scene->problem_user, &remark);
}

bool vl_import_unsupported(vlImport *import, vlSource source, const char *format, ...) {
  char text[400];
  VL_FORMAT(text, format);
  if (!import->permissive)
    return vl_import_wrong(import, source, "%s", text);
  log_text(import, VL_LOG_WARNING, source, text);
  return true;
}

bool vl_import_unknown(vlImport *import, vlSource source, const char *thing, const char *name,
                       const char *const *known, size_t count) {
  const char *near = vl_nearest_name(name, known, count);
  return vl_import_unsupported(import, source, "unknown %s \"%s\"%s", thing,
                               vl_short_text(name).text, vl_hint(near).text);
}

vlShortText vl_import_kind_text(const vlKindFamily *family, const char *name) {
  vlShortText text = vl_short_text(name);
  if (vl_kind_find(family, name) >= 0)
    snprintf(text.text, sizeof text.text, "%s", name);
  return text;
}

bool vl_import_unknown_kind(vlImport *import, vlSource source, const vlKindFamily *family,
                            const char *name) {
  const char *names[64];
  size_t count = vl_kind_names(family, names, VL_LENGTH(names));
  return vl_import_unknown(import, source, family->thing, name, names, count);
}

const char *vl_import_keep(vlImport *import, const char *text) {
  char **slot = VL_IMPORT_PUSH(import, &import->strings);
  if (!slot)
    return NULL;
  if (!(*slot = vl_strdup(import->context, text)))
    vl_import_fail_memory(import);
  return *slot;
}

bool vl_import_missing_name(vlImport *import, vlSource source, const char *thing,
                            const char *name, const vlNameTable *table) {
  const char *near = vl_names_nearest(table, name);
  return vl_import_wrong(import, source, "there is no %s \"%s\"%s", thing,
                         vl_short_text(name).text,
                         vl_hint(near ? vl_short_text(near).text : NULL).text);
}

void vl_import_note_elsewhere(void *user, vlSource source, const char *path) {
  vlImport *import = user;
  if (!import->elsewhere++)
    vl_import_warn(import, VL_LOG_INFO, source,
                   "%s: taken from the current folder; it is not beside the scene's files",
                   path);
}

vlFound vl_import_find(vlImport *import, vlSource source, const char *name, char *path,
                       size_t size) {
  vlFound found = vl_find_file(import->context, source.file, import->first, import->search_path,
                               name, path, size);
  if (found == VL_FOUND_CURRENT)
    vl_import_note_elsewhere(import, source, path);
  return found;
}

bool vl_import_path(vlImport *import, const vlParam *param, char *path, size_t size) {
  if (param->strings.count != 1)
    return vl_import_wrong(import, param->source, "\"%s\" takes one file name, found %zu",
                           param->name, param->strings.count);
  if (param->strings.items[0][0] == 0)
    return vl_import_wrong(import, param->source, "\"%s\" is an empty file name", param->name);
  if (vl_import_find(import, param->source, param->strings.items[0], path, size) ==
      VL_FOUND_TOO_LONG)
    return vl_import_wrong(import, param->source, "\"%s\": file name too long", param->name);
  vlError error = {0};
  const vlResult result = vl_file_check(import->context, path, &error);
  return result == VL_OK || vl_import_fail(import, result, param->source, "%s", error.message);
}

bool vl_import_image_path(vlImport *import, const vlParam *param, char *path, size_t size) {
  const char *name = param->strings.count == 1 ? param->strings.items[0] : "";
  if (!import->permissive || import->scene->problem || !name[0] ||
      vl_import_find(import, param->source, name, path, size) != VL_FOUND_NOT)
    return vl_import_path(import, param, path, size);
  vl_import_warn(import, VL_LOG_WARNING, param->source, "no such file: %s; done without", path);
  import->repairs.images++;
  import->image_missing = true;
  return false;
}

bool vl_import_color_space(const char *name, vlColorSpace *space) {
  for (int i = 0; vl_color_space_names[i]; i++) {
    const char *known = vl_color_space_names[i];
    /* case is ignored, as in pbrt */
    if (strlen(name) == strlen(known) && vl_ends_with(name, known)) {
      *space = (vlColorSpace)i;
      return true;
    }
  }
  return false;
}

bool vl_import_add_name(vlImport *import, vlNameTable *table, const char *name, size_t index) {
  return vl_names_add(import->context, table, name, (uint32_t)index) ||
         vl_import_fail_memory(import);
}
