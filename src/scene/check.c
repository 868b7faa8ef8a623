/* scene/check.c: runs the parts of the scene check; stores, sorts and names the findings. */
#include "scene/check.h"

#include <string.h>

#include "base/cookie.h"
#include "base/free.h"
#include "base/text.h"

vlCheckDef vl_default_check_def(void) {
  return (vlCheckDef){.cookie = VL_COOKIE_CHECK, .images = true};
}

const char *vl_finding_kind_name(vlFindingKind kind) {
  static const char *const names[VL_FINDING_KINDS] = {
      "missing-file", "broken-file",     "unused",
      "replaced",     "open-dielectric", "inverted-dielectric",
      "media",        "degenerate",      "no-uv",
      "albedo",       "camera-inside",   "dark-light",
      "rough-coat",   "wrong",           "overwritten",
      "remark"};
  return (unsigned)kind < VL_FINDING_KINDS ? names[kind] : "";
}

void vl_check_add(vlCheck *check, vlFindingKind kind, vlSeverity severity, vlSource source,
                  const char *format, ...) {
  char text[600];
  VL_FORMAT(text, format);
  vl_make_printable(text);
  char *message = vl_strdup(check->context, text);
  vlFinding *slot = message ? VL_PUSH(check->context, &check->findings) : NULL;
  if (!slot) {
    vl_free(check->context, message);
    check->no_memory = true;
    return;
  }
  vlResult code = severity != VL_SEVERITY_ERROR     ? VL_OK
                  : kind == VL_FINDING_MISSING_FILE ? VL_ERROR_MISSING
                                                    : VL_ERROR_SCENE;
  *slot = (vlFinding){kind, severity, code, source, message};
}

static bool make_used(vlCheck *check) {
  for (int k = 0; k < VL_SCENE_FAMILIES; k++) {
    const size_t count = vl_scene_highest(check->scene, (vlSceneFamily)k);
    check->used[k] = vl_alloc_zero(check->context, count + 1, 1);
    if (!check->used[k])
      return false;
  }
  return true;
}

/* Sorts by severity (errors, warnings, notes); findings of equal severity stay in the order in
 * which they were found. */
static bool sort(vlCheck *check) {
  size_t n = check->findings.count, next = 0;
  vlFinding *sorted = vl_alloc_array(check->context, n ? n : 1, sizeof *sorted);
  if (!sorted)
    return false;
  for (int severity = VL_SEVERITY_ERROR; severity <= (int)VL_SEVERITY_NOTE; severity++)
    for (size_t i = 0; i < n; i++)
      if ((int)check->findings.items[i].severity == severity)
        sorted[next++] = check->findings.items[i];
  if (n)
    memcpy(check->findings.items, sorted, n * sizeof *sorted);
  vl_free(check->context, sorted);
  return true;
}

vlResult vl_check_make(const vlScene *scene, const vlCheckDef *def, vlCheckPart *more,
                       vlCheck **result, vlError *error) {
  vl_error_clear(error);
  if (result)
    *result = NULL;
  if (!scene || !result)
    return vl_fail_argument(error, "scene check: scene or result is null");
  if (def && def->cookie != VL_COOKIE_CHECK)
    return vl_fail_argument(error, "scene check: " VL_BAD_COOKIE);
  VL_TRY(vl_scene_result(scene, error));
  if (scene->meshes_dropped)
    return vl_fail_argument(error, "the scene gave its meshes to a world");
  vlCheck *check = vl_alloc_zero(scene->context, 1, sizeof *check);
  if (!check)
    return vl_fail_memory(error);
  check->context = scene->context;
  check->scene = scene;
  check->def = def ? *def : vl_default_check_def();
  check->no_memory = !make_used(check);
  vlCheckPart *const parts[] = {vl_check_names, vl_check_images, vl_check_meshes,
                                vl_check_inside, more};
  size_t count = check->def.names_only ? 1 : VL_LENGTH(parts);
  for (size_t i = 0; i < count && !check->no_memory; i++)
    parts[i](check);
  if (check->no_memory || !sort(check)) {
    vl_check_destroy(check);
    return vl_fail_memory(error);
  }
  *result = check;
  return VL_OK;
}

void vl_check_destroy(vlCheck *check) {
  if (!check)
    return;
  vlContext *c = check->context;
  for (size_t i = 0; i < check->findings.count; i++)
    vl_free(c, vl_owned(check->findings.items[i].message));
  VL_ARRAY_FREE(c, &check->findings);
  for (int k = 0; k < VL_SCENE_FAMILIES; k++)
    vl_free(c, check->used[k]);
  vl_free(c, check);
}

uint32_t vl_check_count(const vlCheck *check) {
  return check ? (uint32_t)check->findings.count : 0;
}

const vlFinding *vl_check_finding(const vlCheck *check, uint32_t index) {
  return check && index < check->findings.count ? &check->findings.items[index] : NULL;
}
