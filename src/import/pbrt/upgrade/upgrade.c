/* import/pbrt/upgrade/upgrade.c: the interface: reads the statements of each file, applies the
 * rules, writes the new files. */
#include "import/pbrt/upgrade/upgrade.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

#include "base/context.h"
#include "base/cookie.h"
#include "base/error.h"
#include "base/file.h"
#include "base/free.h"
#include "base/text.h"
#include "import/import.h"
#include "import/pbrt/token.h"
#include "import/pbrt/upgrade/detect.h"

/* ---- directives without a table ---------------------------------------------------------- */

static bool remove_it(vlOldStatement *s) {
  vl_old_note(s, "left out");
  return vl_old_finish(s) && vl_old_remove(s);
}

static bool lose_it(vlOldStatement *s) {
  vl_old_lose(s, "%s has no counterpart: left out", s->directive);
  return vl_old_remove(s);
}

/* Numbers without brackets, those of a matrix in brackets. */
static bool bracket(vlOldStatement *s) {
  bool has = s->numbers[0].end > s->numbers[0].start, wanted = s->word->form == VL_OLD_MATRIX;
  if (has == wanted)
    return true;
  if (wanted)
    return vl_old_edit(s, (vlOldSpan){s->keyword.end, s->keyword.end}, " [") &&
           vl_old_edit(s, (vlOldSpan){s->whole.end, s->whole.end}, " ]");
  return vl_old_edit(s, s->numbers[0], "%s", "") && vl_old_edit(s, s->numbers[1], "%s", "");
}

const vlOldWord vl_old_words[] = {
    {"AttributeBegin AttributeEnd TransformBegin TransformEnd", VL_OLD_PLAIN, 0, vl_old_block},
    {"Identity ReverseOrientation ObjectEnd", VL_OLD_PLAIN, 0, NULL},
    {"WorldBegin", VL_OLD_PLAIN, 0, vl_old_world},
    {"WorldEnd", VL_OLD_PLAIN, 0, remove_it},
    {"ActiveTransform", VL_OLD_WORD, 0, NULL},
    {"Include Import", VL_OLD_PLAIN, 1, vl_old_include},
    {"Translate Scale Rotate LookAt TransformTimes", VL_OLD_NUMBERS, 0, bracket},
    {"Transform ConcatTransform", VL_OLD_MATRIX, 0, bracket},
    {"CoordinateSystem CoordSysTransform ColorSpace NamedMaterial ObjectBegin ObjectInstance",
     VL_OLD_PLAIN, 1, NULL},
    {"MediumInterface", VL_OLD_PLAIN, 2, NULL},
    {"Attribute", VL_OLD_PARAMS, 1, NULL},
    {"Film", VL_OLD_PARAMS, 1, vl_old_film},
    {"Sampler", VL_OLD_PARAMS, 1, vl_old_sampler},
    {"Integrator SurfaceIntegrator", VL_OLD_PARAMS, 1, vl_old_integrator},
    {"VolumeIntegrator Renderer Volume", VL_OLD_PARAMS, 1, lose_it},
    {"SearchPath", VL_OLD_PLAIN, 1, lose_it},
    {"PixelFilter", VL_OLD_PARAMS, 1, vl_old_filter},
    {"Accelerator", VL_OLD_PARAMS, 1, vl_old_accelerator},
    {"Camera", VL_OLD_PARAMS, 1, vl_old_camera},
    {"MakeNamedMedium", VL_OLD_PARAMS, 1, vl_old_medium},
    {"Material", VL_OLD_PARAMS, 1, vl_old_material},
    {"MakeNamedMaterial", VL_OLD_PARAMS, 1, vl_old_named_material},
    {"AreaLightSource", VL_OLD_PARAMS, 1, vl_old_area_light},
    {"LightSource", VL_OLD_PARAMS, 1, vl_old_light},
    {"Shape", VL_OLD_PARAMS, 1, vl_old_shape},
    {"Texture", VL_OLD_PARAMS, 3, vl_old_texture},
    {NULL, VL_OLD_PLAIN, 0, NULL}};

/* ---- a file ------------------------------------------------------------------------------ */

static bool read_all(vlOldFile *file) {
  vlTokenizer tokens;
  vl_tokenizer_start(&tokens, file->words, file->size);
  for (bool end = false; !end;) {
    vlOldStatement s;
    bool fine = vl_old_read(file, &tokens, &s, &end);
    if (fine && !end) {
      fine = (s.word->form != VL_OLD_PARAMS || vl_old_types(&s)) && vl_old_names(&s);
      if (fine && s.word->rule)
        fine = s.word->rule(&s);
      fine = fine && vl_old_finish(&s);
      if (fine)
        vl_old_block_sets(&s);
    }
    vl_old_free(&s);
    if (!fine)
      return false;
  }
  return true;
}

bool vl_old_upgrade_file(vlOldFile *file, char **text) {
  vlUpgrade *u = file->u;
  vlError error = {0};
  *text = NULL;
  vlResult r =
      u->depth
          ? vl_file_read(u->context, file->path, true, &file->text, &file->size, &error)
          : vl_file_read_given(u->context, file->path, true, &file->text, &file->size, &error);
  if (r != VL_OK)
    return vl_old_fail(file, r, 0, 0, "%s", error.message);
  file->words = vl_alloc(u->context, file->size + 1);
  if (!file->words)
    return vl_old_fail_memory(u);
  memcpy(file->words, file->text, file->size + 1);
  if (!u->depth) {
    u->subsurface = strstr(file->text, "subsurface\"") != NULL;
    u->is_old = vl_old_scene_text(file->words, file->size).version != 0;
    memcpy(file->words, file->text, file->size + 1);
  }
  if (!read_all(file))
    return false;
  *text = vl_old_render(file, (vlOldSpan){0, file->size});
  return *text || vl_old_fail_memory(u);
}

void vl_old_free_file(vlOldFile *file) {
  vlUpgrade *u = file->u;
  for (size_t i = 0; i < file->edits.count; i++)
    vl_free(u->context, file->edits.items[i].text);
  VL_FREE(u->context, file->edits.items, file->blocks.items, file->words, file->text);
  if (u->film_file == file)
    u->film_file = NULL;
}

static void tell_written(const vlUpgrade *u, const char *path, const char *what) {
  vlError location = {0};
  vl_fail_at(&location, VL_OK, path, 0, 0, "%s", "");
  if (u->def->report)
    u->def->report(u->def->report_user, VL_UPGRADE_WROTE, &location, what);
}

/* Writes all files, or none. */
static bool write_files(vlUpgrade *u, const char *text) {
  char path[PATH_MAX + 4200];
  for (size_t i = 0; i < u->maps.count && u->result == VL_OK; i++)
    u->result = vl_file_set_write(&u->files, u->maps.items[i].name, u->maps.items[i].data,
                                  u->maps.items[i].size, &u->error);
  for (size_t i = 0; i + 1 < u->outputs.count && u->result == VL_OK; i += 2)
    u->result = vl_file_set_write(&u->files, u->outputs.items[i], u->outputs.items[i + 1],
                                  strlen(u->outputs.items[i + 1]), &u->error);
  if (u->result == VL_OK)
    u->result = vl_file_set_main(&u->files, text, strlen(text), &u->error);
  if (u->result != VL_OK)
    return false;
  for (size_t i = 0; i < u->maps.count; i++) {
    snprintf(path, sizeof path, "%s/%s", u->to_folder, u->maps.items[i].name);
    tell_written(u, path, "the light's image, equal-area");
  }
  for (size_t i = 0; i + 1 < u->outputs.count; i += 2) {
    snprintf(path, sizeof path, "%s/%s", u->to_folder, u->outputs.items[i]);
    tell_written(u, path, "a pbrt-v4 file");
  }
  tell_written(u, u->to, "a pbrt-v4 file");
  return true;
}

/* ---- the interface ----------------------------------------------------------------------- */

static bool folder_of(const char *path, char result[4096]) {
  char folder[4096], real[PATH_MAX];
  if (!vl_folder_of(path, folder, sizeof folder) || !realpath(folder, real) ||
      strlen(real) >= 4096)
    return false;
  memcpy(result, real, strlen(real) + 1);
  return true;
}

static bool same_file(const char *a, const char *b) {
  struct stat x, y;
  return stat(a, &x) == 0 && stat(b, &y) == 0 && x.st_ino == y.st_ino && x.st_dev == y.st_dev;
}

static void release(vlUpgrade *u) {
  vlContext *c = u->context;
  VL_EACH_ITEM(const vlOldTexture, t, &u->textures) {
    VL_FREE(c, t->name, t->text, t->copy);
  }
  for (size_t i = 0; i < u->names.count; i++)
    VL_FREE(c, u->names.items[i].old, u->names.items[i].name);
  for (size_t i = 0; i < u->includes.count; i++)
    VL_FREE(c, u->includes.items[i].path, u->includes.items[i].name);
  for (size_t i = 0; i < u->outputs.count; i++)
    vl_free(c, u->outputs.items[i]);
  VL_EACH_ITEM(const vlOldMap, map, &u->maps) {
    VL_FREE(c, map->from, map->name, map->data);
  }
  VL_FREE(c, u->textures.items, u->includes.items, u->names.items, (void *)u->outputs.items,
          u->maps.items);
}

/* Offset of a line and column, from 1 on. */
static size_t offset_of(const char *text, uint32_t line, uint32_t column) {
  const char *at = text;
  for (const char *end; line > 1 && (end = strchr(at, '\n')); line--)
    at = end + 1;
  return (size_t)(at - text) + (column ? column - 1 : 0);
}

/* What is wrong in the new scene, told at the statement of the old one that it is made of. */
static bool fail_check(vlUpgrade *u, const vlOldFile *file, const char *text,
                       const vlError *found) {
  const bool first = vl_text_is(found->file, u->to) && found->line > 0;
  const uint32_t line =
      first ? vl_old_line(file, offset_of(text, found->line, found->column)) : found->line;
  u->result = vl_fail_at(&u->error, VL_ERROR_SCENE, first ? u->first : found->file, line,
                         first ? 0 : found->column,
                         "%s; the upgraded scene is wrong here, and nothing is written",
                         found->message);
  return false;
}

/* Reads the new scene before it is written: what velo refuses is an error of the upgrade. A
 * file without WorldBegin is part of a scene and is not checked. What velo does not render is
 * no mistake of the upgrade (permissive), nor is a file that the old scene lacks, too. The
 * images that are made of the old ones are not there yet: permissive again. */
static bool check(vlUpgrade *u, const vlOldFile *file, const char *text) {
  if (!u->has_world)
    return true;
  vlContext *context = NULL;
  vlScene *scene = NULL;
  vlError error = {0};
  /* its notes would not be about the upgrade */
  vlResult r = vl_context_create_quiet(u->context, &context);
  if (r == VL_OK)
    r = vl_scene_create(context, &scene);
  if (r == VL_OK) {
    vlLoadDef def = vl_default_load_def();
    def.permissive = true;
    def.search_path = u->def->search_path;
    r = vl_import_pbrt_texts(scene, u->to, text, (const char *const *)u->outputs.items,
                             u->outputs.count / 2, &def, &error);
  }
  vl_scene_destroy(scene);
  vl_context_destroy(context);
  if (r == VL_OK || (r == VL_ERROR_MISSING && u->missing))
    return true;
  if (r == VL_ERROR_MEMORY)
    return vl_old_fail_memory(u);
  return fail_check(u, file, text, &error);
}

static bool check_strict(vlUpgrade *u) {
  if (!u->def->strict || !u->lost)
    return true;
  u->result =
      vl_fail_at(&u->error, VL_ERROR_UNSUPPORTED, u->first, 0, 0,
                 "%u statements have no counterpart in pbrt-v4; nothing is written", u->lost);
  return false;
}

static bool run(vlUpgrade *u) {
  vlOldFile file = {.u = u, .path = u->first};
  char *text;
  const bool fine = vl_old_upgrade_file(&file, &text) && check_strict(u) &&
                    check(u, &file, text) && write_files(u, text);
  vl_old_free_file(&file);
  vl_free(u->context, text);
  return fine;
}

vlUpgradeDef vl_default_upgrade_def(void) {
  return (vlUpgradeDef){.cookie = VL_COOKIE_UPGRADE};
}

vlResult vl_scene_upgrade(vlContext *context, const char *from, const char *to,
                          const vlUpgradeDef *def, vlError *error) {
  vlUpgradeDef plain = vl_default_upgrade_def();
  vl_error_clear(error);
  if (!context || !from || !to)
    return vl_fail_argument(error, "scene upgrade: an argument is null");
  if (def && def->cookie != VL_COOKIE_UPGRADE)
    return vl_fail_argument(error, "scene upgrade: " VL_BAD_COOKIE);
  if (same_file(from, to))
    return vl_fail_argument(error, "scene upgrade: %s would be overwritten", to);
  vlUpgrade u = {.context = context,
                 .def = def ? def : &plain,
                 .first = from,
                 .to = to,
                 .exposure = 1,
                 .iso = 100,
                 .plain_path = true};
  if (!folder_of(to, u.to_folder))
    return vl_fail(error, VL_ERROR_IO, "cannot write %s: no such folder", to);
  u.same_folder = folder_of(from, u.from_folder) && vl_text_is(u.from_folder, u.to_folder);
  vl_file_set_begin(&u.files, context, to);
  vl_file_set_end(&u.files, run(&u));
  release(&u);
  if (error && u.result != VL_OK)
    *error = u.error;
  return u.result;
}
