/* export/export.c: the interface of this room: chooses the format, counts losses, writes
 * files. */
#include "export/export.h"

#include <stdarg.h>

#include "base/cookie.h"
#include "base/machine.h"
#include "base/text.h"
#include "image/image.h"
#include "velo/material.h"
#include "velo/shape.h"

vlSaveDef vl_default_save_def(void) {
  return (vlSaveDef){.cookie = VL_COOKIE_SAVE};
}

void vl_export_lose(vlExport *x, const char *format, ...) {
  char text[sizeof x->losses->text];
  VL_FORMAT(text, format);
  for (uint32_t i = 0; i < x->loss_count; i++)
    if (vl_text_is(x->losses[i].text, text) || i + 1 == VL_EXPORT_LOSSES) {
      x->losses[i].count++;
      return;
    }
  vlLoss *loss = &x->losses[x->loss_count++];
  loss->count = 1;
  memcpy(loss->text, text, sizeof text);
  /* the last row counts all kinds of loss that have no row of their own */
  if (x->loss_count == VL_EXPORT_LOSSES)
    snprintf(loss->text, sizeof loss->text, "more of other kinds");
}

static void lose_many(vlExport *x, uint64_t count, const char *text) {
  if (!count)
    return;
  vl_export_lose(x, "%s", text);
  for (uint32_t i = 0; i < x->loss_count; i++)
    if (vl_text_is(x->losses[i].text, text))
      x->losses[i].count += count - 1;
}

static uint32_t beyond_first(const vlScene *scene, vlChoiceKind kind) {
  const uint32_t count = vl_scene_choice_count(scene, kind);
  return count ? count - 1 : 0;
}

void vl_export_lose_choices(vlExport *x) {
  const vlScene *s = x->scene;
  lose_many(x, vl_scene_choice_count(s, VL_CHOICE_ANIMATION), "animations: one moment of them");
  lose_many(x, vl_scene_choice_count(s, VL_CHOICE_VARIANT),
            "variants of materials: the chosen one");
  lose_many(x, beyond_first(s, VL_CHOICE_SCENE), "scenes: the chosen one");
  lose_many(x, beyond_first(s, VL_CHOICE_CAMERA), "cameras: the chosen one");
  lose_many(x, s->skinned, "skins: vertices as they pose them");
  lose_many(x, s->morphed, "morph targets: vertices as they pose them");
  for (size_t i = 0; i < s->unread.count; i++)
    lose_many(x, s->unread.items[i].count, s->unread.items[i].what);
}

bool vl_export_fail(vlExport *x, vlResult result, const char *format, ...) {
  if (x->result != VL_OK)
    return false;
  char text[400];
  VL_FORMAT(text, format);
  x->result = vl_fail(x->error, result, "%s", text);
  return false;
}

bool vl_export_no_memory(vlExport *x) {
  return vl_export_fail(x, VL_ERROR_MEMORY, "out of memory");
}

void *vl_export_alloc(vlExport *x, size_t count, size_t size) {
  void *block = vl_alloc_array(x->context, count, size);
  if (!block)
    vl_export_no_memory(x);
  return block;
}

bool vl_export_read(vlExport *x, const char *path, char **data, size_t *size) {
  vlError error = {0};
  const vlResult r = vl_file_read(x->context, path, false, data, size, &error);
  return r == VL_OK || vl_export_fail(x, r, "%s", error.message);
}

/* ---- bytes ------------------------------------------------------------------------------- */

bool vl_export_parts_media(const vlExport *x, const vlShapeDef *d) {
  const vlMaterialDef *m = vl_scene_material(x->scene, d->material);
  return m && m->kind == VL_MATERIAL_INTERFACE;
}

void vl_bytes_put(vlContext *context, vlBytes *bytes, const void *data, size_t size) {
  if (bytes->full || !VL_RESERVE(context, &bytes->data, size + 1)) {
    bytes->full = true;
    return;
  }
  if (size)
    memcpy(bytes->data.items + bytes->data.count, data, size);
  bytes->data.count += size;
}

void vl_bytes_print(vlContext *context, vlBytes *bytes, const char *format, ...) {
  char text[2048];
  va_list args;
  va_start(args, format);
  int n = vsnprintf(text, sizeof text, format, args);
  va_end(args);
  vl_bytes_put(context, bytes, text,
               n < 0                     ? 0
               : (size_t)n < sizeof text ? (size_t)n
                                         : sizeof text - 1);
}

/* ---- files ------------------------------------------------------------------------------- */

/* Keeps the first error of the export. Returns whether this result is none. */
static bool keep_result(vlExport *x, vlResult result) {
  if (result != VL_OK && x->result == VL_OK)
    x->result = result;
  return result == VL_OK;
}

bool vl_export_main(vlExport *x, const void *data, size_t size) {
  if (x->result != VL_OK)
    return false; /* whatever became of the part that failed */
  return x->dry || keep_result(x, vl_file_set_main(&x->files, data, size, x->error));
}

bool vl_export_data(vlExport *x, char name[300], const void *data, size_t size) {
  if (x->dry)
    return true;
  return keep_result(x, vl_file_set_name(&x->files, name, 300, data, size, x->error)) &&
         keep_result(x, vl_file_set_write(&x->files, name, data, size, x->error));
}

bool vl_export_camera(vlExport *x, vlCameraDialect dialect, const vlCameraRecord *record,
                      const char *lost, vlCameraText *text) {
  static const char *const all[] = {"all"};
  vlCameraFileDef def = vl_default_camera_file_def();
  vlError error = {0};
  const vlCameraFile file = {.context = x->context,
                             .path = x->path,
                             .dialect = vl_camera_dialect_name(dialect),
                             .def = &def,
                             .error = &error};
  *text = (vlCameraText){.context = x->context};
  def.dialect = dialect;
  vlResult r = vl_camera_write_memory(&file, record, text);
  if (r == VL_ERROR_UNSUPPORTED) {
    if (lost)
      vl_export_lose(x, "%s", lost);
    else
      vl_export_lose(x, "the camera: %.*s", (int)strcspn(error.message, ";"), error.message);
    VL_ARRAY_FREE(x->context, &text->text);
    def.drop = all;
    def.drop_count = 1;
    r = vl_camera_write_memory(&file, record, text);
  }
  if (r != VL_OK)
    VL_ARRAY_FREE(x->context, &text->text);
  return r != VL_ERROR_MEMORY || vl_export_fail(x, r, "out of memory");
}

bool vl_export_pack(vlExport *x, const vlImage *image, const char *suffix, char **data,
                    size_t *size) {
  void *bytes = NULL;
  vlError error;
  vl_error_clear(&error);
  vlResult r = vl_image_write_memory(image, suffix, NULL, &bytes, size, &error);
  *data = bytes;
  return r == VL_OK || vl_export_fail(x, r, "%s", error.message);
}

/* ---- saving ------------------------------------------------------------------------------ */

static void start(vlExport *x, bool dry) {
  x->dry = dry;
  x->loss_count = 0;
  const char *name = vl_file_name(x->path), *dot = strrchr(name, '.');
  snprintf(x->stem, sizeof x->stem, "%.*s",
           dot && dot > name ? (int)(dot - name) : (int)strlen(name), name);
}

static void finish(vlExport *x) {
  VL_ARRAY_FREE(x->context, &x->images);
  VL_ARRAY_FREE(x->context, &x->buffer.data);
  VL_ARRAY_FREE(x->context, &x->looks);
  VL_ARRAY_FREE(x->context, &x->text.data);
  x->buffer.full = x->text.full = false;
  json_decref(x->root);
  x->root = NULL;
}

static vlResult save_plainly(const vlScene *scene, const char *path, const vlSaveDef *def,
                             vlError *error) {
  vl_error_clear(error);
  vlSaveDef plain = vl_default_save_def();
  if (!scene || !path)
    return vl_fail_argument(error, "scene save: scene or path is null");
  if (def && def->cookie != VL_COOKIE_SAVE)
    return vl_fail_argument(error, "scene save: " VL_BAD_COOKIE);
  VL_TRY(vl_scene_result(scene, error));
  bool pbrt = vl_ends_with(path, ".pbrt"), binary = vl_ends_with(path, ".glb");
  if (!pbrt && !binary && !vl_ends_with(path, ".gltf"))
    return vl_fail_argument(
        error, "%.300s: unknown kind of file to write (known: .gltf, .glb, .pbrt)", path);
  vlExport *x = vl_alloc_zero(scene->context, 1, sizeof *x);
  if (!x)
    return vl_fail_memory(error);
  x->context = scene->context;
  x->scene = scene;
  x->path = path;
  x->error = error;
  x->binary = binary;
  x->def = def ? def : &plain;
  bool fine = true;
  if (x->def->strict) {
    start(x, true);
    fine = pbrt ? vl_export_pbrt(x) : vl_export_gltf(x);
    finish(x);
    if (fine && x->loss_count)
      fine = vl_export_fail(x, VL_ERROR_UNSUPPORTED,
                            "%s cannot hold: %s (%llu); %u kinds of loss in all",
                            pbrt ? "pbrt" : "glTF", x->losses[0].text,
                            (unsigned long long)x->losses[0].count, x->loss_count);
  }
  if (fine) {
    vl_file_set_begin(&x->files, x->context, x->path);
    start(x, false);
    fine = pbrt ? vl_export_pbrt(x) : vl_export_gltf(x);
    finish(x);
    vl_file_set_end(&x->files, fine);
  }
  for (uint32_t i = 0; i < x->loss_count && x->def->lost; i++)
    x->def->lost(x->def->lost_user, x->losses[i].text, x->losses[i].count);
  vlResult r = fine ? VL_OK : x->result != VL_OK ? x->result : vl_fail_memory(error);
  vl_free(scene->context, x);
  return r;
}

vlResult vl_scene_save(const vlScene *scene, const char *path, const vlSaveDef *def,
                       vlError *error) {
  void *locale = vl_machine_set_numerals();
  vlResult result = save_plainly(scene, path, def, error);
  vl_machine_restore_numerals(locale);
  return result;
}
