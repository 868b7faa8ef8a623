/* camera_files/file.c: the public functions: detects the dialect of a file, reads and writes
 * whole files. */
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "base/cookie.h"
#include "base/file.h"
#include "base/machine.h"
#include "base/text.h"
#include "camera_files/fields.h"
#include "camera_files/formats.h"
#include "camera_files/trajectory.h"

const char *vl_camera_dialect_name(vlCameraDialect dialect) {
  if ((uint32_t)dialect >= VL_CAMERA_DIALECT_COUNT)
    return NULL;
  return dialect ? vl_camera_formats[dialect]->name : "auto";
}

vlCameraFileDef vl_default_camera_file_def(void) {
  return (vlCameraFileDef){.cookie = VL_COOKIE_CAMERA_FILE};
}

/* Reports a file of another program, by name, or that its fields are not known. */
static vlResult unknown(const vlCameraFile *file, const json_t *tree, const char *text,
                        size_t size) {
  const char *advice = vl_camera_other_tool(text, size);
  if (advice)
    return vl_camera_wrong(file, "no camera that velo reads: %s", advice);
  char names[160] = "";
  const char *key;
  json_t *unused;
  json_object_foreach((json_t *)tree, key, unused) {
    size_t n = strlen(names);
    if (n < 100)
      snprintf(names + n, sizeof names - n, "%s%s", n ? ", " : "", vl_short_text(key).text);
  }
  if (vl_camera_has(tree, "<"))
    return vl_camera_wrong(file, "no camera of a known dialect: XML with the root <%.60s>",
                           vl_camera_text(tree, "<"));
  if (json_array_size(json_object_get(tree, "[]")) > 0)
    snprintf(names, sizeof names, "those of a list");
  return vl_camera_wrong(
      file,
      "no camera of a known dialect (docs/camera-files.md has the table); its fields are: %s",
      names);
}

static bool is_folder(const char *path) {
  struct stat status;
  return stat(path, &status) == 0 && S_ISDIR(status.st_mode);
}

static vlResult other_dialect(const vlCameraFile *file, vlCameraDialect found,
                              vlCameraDialect wish) {
  return vl_camera_wrong(file, "this is a camera in the dialect of %s, not of %s",
                         vl_camera_formats[found]->name, vl_camera_formats[wish]->name);
}

/* Returns whether the text looks like a tree format. Then the error of that format's parser is
 * reported. */
static bool is_meant_as_tree(const char *path, const char *text) {
  const char *first = text + strspn(text, " \t\r\n"), *second = *first ? first + 1 : first;
  bool section = *first == '[' && ((*second >= 'A' && *second <= 'Z') ||
                                   (*second >= 'a' && *second <= 'z')); /* .ini */
  if (section && !vl_ends_with(path, ".json"))
    return false;
  return strchr("{[<", *first) || strncmp(first, "%YAML", 5) == 0 ||
         strncmp(first, "---", 3) == 0 || strncmp(first, "glTF", 4) == 0 ||
         vl_ends_with(path, ".yaml") || vl_ends_with(path, ".yml") ||
         vl_ends_with(path, ".json");
}

/* Reports that the file is of no known kind, without naming a format. */
static vlResult no_kind(const vlCameraFile *file, const char *text, size_t size) {
  if (memchr(text, 0, size))
    return vl_camera_wrong(file, "no camera: a binary file of no known kind");
  return vl_camera_wrong_at(
      file, 1, 1, "no camera of a known dialect (docs/camera-files.md has the table)");
}

/* The text or the tree of a file that is being read; one of the two is null. */
typedef struct {
  const json_t *tree;
  const char *text;
  size_t size;
} Source;

/* A file of one camera has no other: refuses the name of one. */
static vlResult check_frame(const vlCameraFile *file, bool looked,
                            const vlCameraRecord *record) {
  if (looked || !file->def->frame || record->frames > 1 ||
      vl_camera_is_frame(file, 0, record->name))
    return VL_OK;
  return vl_camera_no_frame(file, "camera", record);
}

/* Reads one camera, or all cameras if there is a sink. */
static vlResult read_source(vlCameraFile *file, vlCameraDialect dialect, const Source *source,
                            const vlCameraSink *sink, vlCameraRecord *record) {
  const vlCameraFormat *format = vl_camera_formats[dialect];
  vlResult result = VL_OK;
  uint32_t frames = 1, i = 0;
  bool looked = false;
  file->dialect = format->name;
  file->looked = &looked;
  if (sink)
    file->ordinal = &i;
  for (; i < frames && result == VL_OK; i++) {
    if (sink) {
      vl_trajectory_begin(dialect, record);
      record->frames = 1;
    }
    record->dialect = dialect;
    result = source->tree ? format->read(file, source->tree, record)
                          : format->read_text(file, source->text, source->size, record);
    if (result == VL_OK && format->rotates)
      result = vl_camera_check_rotation(file, record);
    if (sink)
      frames = record->frames;
    else if (result == VL_OK)
      result = check_frame(file, looked, record);
    if (source->tree && i == 0 && result == VL_OK)
      result = vl_camera_check_unread(file, format, source->tree, record);
    if (source->text && format->separator && i == 0 && result == VL_OK)
      result = vl_camera_check_lines(file, format, source->text, source->size, record);
    if (sink && result == VL_OK)
      result = sink->add(sink->data, file, record, i);
  }
  file->ordinal = NULL;
  file->looked = NULL;
  return result;
}

static vlResult read_tree(vlCameraFile *file, const char *text, size_t size,
                          const vlCameraSink *sink, vlCameraRecord *record) {
  json_t *tree = NULL;
  vlCameraLocations locations = {.root = NULL};
  file->locations = &locations;
  vlResult result = vl_camera_tree(file, text, size, &tree);
  if (result != VL_OK) {
    vl_camera_locations_free(file);
    const char *advice = result == VL_ERROR_SCENE ? vl_camera_other_tool(text, size) : NULL;
    if (advice)
      return vl_camera_wrong(file, "no camera that velo reads: %s", advice);
    if (result == VL_ERROR_SCENE && size > 0 && !is_meant_as_tree(file->path, text))
      return no_kind(file, text, size);
    return result;
  }
  vlCameraDialect found = vl_camera_dialect_of_tree(tree), wish = file->def->dialect;
  /* ROS files also have OpenCV's fields */
  bool related = wish == VL_CAMERA_DIALECT_OPENCV && found == VL_CAMERA_DIALECT_ROS;
  related = related || (wish == VL_CAMERA_DIALECT_ROS && found == VL_CAMERA_DIALECT_OPENCV);
  if (wish && found && wish != found && !related) {
    result = other_dialect(file, found, wish);
  } else if (wish && wish != found &&
             (!vl_camera_formats[wish]->read || vl_camera_has(tree, "<"))) {
    result = vl_camera_wrong(file, "this is no camera in the dialect of %s",
                             vl_camera_formats[wish]->name);
  } else if (!wish && !found) {
    result = unknown(file, tree, text, size);
  } else {
    result = read_source(file, wish ? wish : found, &(Source){.tree = tree}, sink, record);
  }
  if (result == VL_ERROR_SCENE)
    vl_camera_locate_error(file);
  json_decref(tree);
  vl_camera_locations_free(file);
  return result;
}

static vlResult read_file(vlCameraFile *file, const vlCameraSink *sink,
                          vlCameraRecord *record) {
  char *text;
  size_t size;
  vlResult result =
      vl_file_read_given(file->context, file->path, false, &text, &size, file->error);
  if (result != VL_OK)
    return result;
  size_t skip = size >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0 ? 3 : 0; /* byte order mark */
  vlCameraDialect found = vl_camera_dialect_of_text(text + skip, size - skip),
                  wish = file->def->dialect;
  if (found && wish && found != wish)
    result = other_dialect(file, found, wish);
  else if (found)
    result = read_source(file, found, &(Source){.text = text + skip, .size = size - skip}, sink,
                         record);
  else
    result = read_tree(file, text, size, sink, record);
  vl_free(file->context, text);
  return result;
}

vlResult vl_camera_read_each(const vlCameraFile *file, const vlCameraSink *sink) {
  vlCameraFile own = *file;
  vlCameraRecord record;
  return read_file(&own, sink, &record);
}

static vlResult begin(vlContext *context, const char *path, const vlCameraRecord *record,
                      const vlCameraFileDef **def, vlCameraFileDef *standard, vlError *error) {
  vl_error_clear(error);
  *standard = vl_default_camera_file_def();
  if (!context || !path)
    return vl_fail_argument(error, "camera file: context or path is null");
  if (!*def)
    *def = standard;
  if ((*def)->cookie != VL_COOKIE_CAMERA_FILE)
    return vl_fail_argument(error, "camera file: " VL_BAD_COOKIE);
  if ((uint32_t)(*def)->dialect >= VL_CAMERA_DIALECT_COUNT)
    return vl_fail_argument(error, "camera file: unknown dialect %d", (int)(*def)->dialect);
  if (!record)
    return vl_fail_argument(error, "camera file: record is null");
  return VL_OK;
}

static vlResult read_plainly(vlContext *context, const char *path, const vlCameraFileDef *def,
                             vlCameraRecord *record, vlError *error) {
  vlCameraFileDef standard;
  VL_TRY(begin(context, path, record, &def, &standard, error));
  if (def->dialect == VL_CAMERA_DIALECT_EXR)
    return vl_fail(error, VL_ERROR_UNSUPPORTED,
                   "camera file: this is an image; it is read as one");
  if (def->dialect == VL_CAMERA_DIALECT_PBRT)
    return vl_fail(error, VL_ERROR_UNSUPPORTED, "camera file: pbrt scenes are read as scenes");
  vlCameraFile file = {.context = context,
                       .path = path,
                       .dialect = vl_camera_dialect_name(def->dialect),
                       .def = def,
                       .error = error};
  vlCameraRecord read = {.camera = vl_default_camera_def(1, 1), .frames = 1};
  if (def->dialect == VL_CAMERA_DIALECT_COLMAP ||
      (!def->dialect && (is_folder(path) || vl_colmap_is_name(path)))) {
    file.dialect = "colmap";
    read.dialect = VL_CAMERA_DIALECT_COLMAP;
    VL_TRY(vl_camera_read_colmap(&file, &read));
  } else {
    VL_TRY(read_file(&file, NULL, &read));
  }
  *record = read;
  return VL_OK;
}

vlResult vl_camera_read(vlContext *context, const char *path, const vlCameraFileDef *def,
                        vlCameraRecord *record, vlError *error) {
  void *locale = vl_machine_set_numerals();
  vlResult result = read_plainly(context, path, def, record, error);
  vl_machine_restore_numerals(locale);
  return result;
}

vlResult vl_camera_write_text(const vlCameraFile *file, const char *path,
                              const vlCameraText *text) {
  vlFileWriter writer;
  if (text->failed)
    return vl_fail_memory(file->error);
  VL_TRY(vl_file_open_write(&writer, file->context, path, VL_OUTPUT_PLAIN, file->error));
  vl_file_write(&writer, text->text.items, text->text.count);
  return vl_file_commit(&writer, file->error);
}

static vlCameraDialect dialect_of_name(const char *path) {
  static const struct {
    const char *end;
    vlCameraDialect dialect;
  } ends[] = {{"transforms.json", VL_CAMERA_DIALECT_NERF},
              {".json", VL_CAMERA_DIALECT_VELO},
              {".yaml", VL_CAMERA_DIALECT_OPENCV},
              {".yml", VL_CAMERA_DIALECT_OPENCV},
              {".pbrt", VL_CAMERA_DIALECT_PBRT},
              {".gltf", VL_CAMERA_DIALECT_GLTF},
              {".usda", VL_CAMERA_DIALECT_USD},
              {".xml", VL_CAMERA_DIALECT_MITSUBA}};
  if (vl_colmap_is_name(path) || is_folder(path))
    return VL_CAMERA_DIALECT_COLMAP;
  for (size_t i = 0; i < VL_LENGTH(ends); i++)
    if (vl_ends_with(path, ends[i].end))
      return ends[i].dialect;
  return VL_CAMERA_DIALECT_AUTO;
}

bool vl_camera_writes_folder(const char *path, vlCameraDialect dialect) {
  if (!dialect && path)
    dialect = dialect_of_name(path);
  const vlCameraFormat *format =
      (unsigned)dialect < VL_CAMERA_DIALECT_COUNT ? vl_camera_formats[dialect] : NULL;
  return format && format->write_folder;
}

static vlResult check_record(const vlCameraFileDef *def, const vlCameraRecord *record,
                             vlError *error) {
  if (record->camera.own)
    return vl_fail(error, VL_ERROR_UNSUPPORTED,
                   "camera file: none can hold a camera of one's own, \"%s\"",
                   vl_short_text(record->camera.own->name).text);
  return vl_camera_check_drop(def, error);
}

static vlResult make_text(const vlCameraFile *file, const vlCameraFormat *format,
                          const vlCameraRecord *record, vlCameraText *text) {
  vlFittedCamera fit;
  VL_TRY(vl_camera_fit(file, record, format, &fit));
  VL_TRY(format->form ? vl_camera_write_form(format, &fit, text) : format->write(&fit, text));
  return text->failed ? vl_fail_memory(file->error) : VL_OK;
}

vlResult vl_camera_write_memory(const vlCameraFile *file, const vlCameraRecord *record,
                                vlCameraText *text) {
  VL_TRY(check_record(file->def, record, file->error));
  return make_text(file, vl_camera_formats[file->def->dialect], record, text);
}

static vlResult write_plainly(vlContext *context, const char *path, const vlCameraFileDef *def,
                              const vlCameraRecord *record, vlError *error) {
  vlCameraFileDef standard;
  VL_TRY(begin(context, path, record, &def, &standard, error));
  VL_TRY(check_record(def, record, error));
  vlCameraDialect dialect = def->dialect ? def->dialect : dialect_of_name(path);
  if (!dialect)
    return vl_fail_argument(
        error, "camera file: the name \"%.200s\" does not say which dialect to write", path);
  const vlCameraFormat *format = vl_camera_formats[dialect];
  vlCameraFile file = {
      .context = context, .path = path, .dialect = format->name, .def = def, .error = error};
  if (format->write_folder)
    return format->write_folder(&file, record);
  if (!format->write && !format->form)
    return vl_fail(error, VL_ERROR_UNSUPPORTED, "camera file: %s is not written: %s",
                   format->name, format->not_written);
  vlCameraText text = {.context = context};
  vlResult result = make_text(&file, format, record, &text);
  if (result == VL_OK)
    result = vl_camera_write_text(&file, path, &text);
  VL_ARRAY_FREE(context, &text.text);
  return result;
}

vlResult vl_camera_write(vlContext *context, const char *path, const vlCameraFileDef *def,
                         const vlCameraRecord *record, vlError *error) {
  void *locale = vl_machine_set_numerals();
  vlResult result = write_plainly(context, path, def, record, error);
  vl_machine_restore_numerals(locale);
  return result;
}
