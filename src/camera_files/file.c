/* camera_files/file.c: the public functions: detects the dialect of a file, reads and writes whole files. */
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "base/cookie.h"
#include "base/file.h"
#include "base/text.h"
#include "camera_files/files.h"

typedef struct {
  const char *name;
  vlCameraReadTree *read;
  vlCameraWriteText *write;
  vlCameraReadText *read_text; /* for dialects that are neither JSON nor YAML */
} Dialect;

static const Dialect dialects[VL_CAMERA_DIALECT_COUNT] = {
    [VL_CAMERA_DIALECT_AUTO] = {"auto", NULL, NULL, NULL},
    [VL_CAMERA_DIALECT_VELO] = {"velo", vl_camera_read_velo, vl_camera_write_velo, NULL},
    [VL_CAMERA_DIALECT_OPENCV] = {"opencv", vl_camera_read_opencv, vl_camera_write_opencv, NULL},
    [VL_CAMERA_DIALECT_ROS] = {"ros", vl_camera_read_ros, vl_camera_write_ros, NULL},
    [VL_CAMERA_DIALECT_COLMAP] = {"colmap", NULL, NULL, NULL},
    [VL_CAMERA_DIALECT_NERF] = {"nerf", vl_camera_read_nerf, vl_camera_write_nerf, NULL},
    [VL_CAMERA_DIALECT_KALIBR] = {"kalibr", vl_camera_read_kalibr, vl_camera_write_kalibr, NULL},
    [VL_CAMERA_DIALECT_BLENDER] = {"blender", vl_camera_read_blender, vl_camera_write_blender, NULL},
    [VL_CAMERA_DIALECT_PBRT] = {"pbrt", NULL, vl_camera_write_pbrt, NULL},
    [VL_CAMERA_DIALECT_GLTF] = {"gltf", vl_camera_read_gltf, vl_camera_write_gltf, NULL},
    [VL_CAMERA_DIALECT_OPENGL] = {"opengl", vl_camera_read_matrices, vl_camera_write_matrices, NULL},
    [VL_CAMERA_DIALECT_VULKAN] = {"vulkan", vl_camera_read_matrices, vl_camera_write_matrices, NULL},
    [VL_CAMERA_DIALECT_D3D] = {"d3d", vl_camera_read_matrices, vl_camera_write_matrices, NULL},
    [VL_CAMERA_DIALECT_MITSUBA] = {"mitsuba", NULL, vl_camera_write_mitsuba, vl_camera_read_mitsuba},
    [VL_CAMERA_DIALECT_EXR] = {"exr", NULL, NULL, NULL},
    [VL_CAMERA_DIALECT_USD] = {"usd", NULL, vl_camera_write_usd, vl_camera_read_usd},
};

const char *vl_camera_dialect_name(vlCameraDialect dialect) {
  return (uint32_t)dialect < VL_CAMERA_DIALECT_COUNT ? dialects[dialect].name : NULL;
}

vlCameraFileDef vl_default_camera_file_def(void) {
  return (vlCameraFileDef){.cookie = VL_COOKIE_CAMERA_FILE};
}

/* Detects the dialect of a tree by a field that only this dialect has. */
static vlCameraDialect dialect_of(const json_t *tree) {
  static const struct {
    const char *key;
    vlCameraDialect dialect;
  } marks[] = {{"velo_camera", VL_CAMERA_DIALECT_VELO},
               {"asset", VL_CAMERA_DIALECT_GLTF},
               {"frames", VL_CAMERA_DIALECT_NERF},
               {"fl_x", VL_CAMERA_DIALECT_NERF},
               {"camera_angle_x", VL_CAMERA_DIALECT_NERF},
               {"cam0", VL_CAMERA_DIALECT_KALIBR},
               {"projection_matrix", VL_CAMERA_DIALECT_ROS},
               {"rectification_matrix", VL_CAMERA_DIALECT_ROS},
               {"K", VL_CAMERA_DIALECT_ROS},
               {"k", VL_CAMERA_DIALECT_ROS},
               {"camera_matrix", VL_CAMERA_DIALECT_OPENCV},
               {"matrix_world", VL_CAMERA_DIALECT_BLENDER},
               {"sensor_fit", VL_CAMERA_DIALECT_BLENDER},
               {"lens", VL_CAMERA_DIALECT_BLENDER},
               {"image_width", VL_CAMERA_DIALECT_OPENCV}};
  const char *api = vl_camera_text(tree, "graphics_api");
  if (api) {
    for (int i = VL_CAMERA_DIALECT_OPENGL; i <= VL_CAMERA_DIALECT_D3D; i++)
      if (strcmp(api, dialects[i].name) == 0) return (vlCameraDialect)i;
    return VL_CAMERA_DIALECT_OPENGL; /* its reader names the three APIs */
  }
  for (size_t i = 0; i < sizeof marks / sizeof *marks; i++)
    if (json_object_get(tree, marks[i].key)) return marks[i].dialect;
  return VL_CAMERA_DIALECT_AUTO;
}

static vlResult unknown(const vlCameraFile *file, const json_t *tree) {
  char names[160] = "";
  const char *key;
  json_t *unused;
  json_object_foreach((json_t *)tree, key, unused) {
    size_t n = strlen(names);
    if (n < 100) snprintf(names + n, sizeof names - n, "%s%s", n ? ", " : "", vl_short_text(key).text);
  }
  return vl_camera_wrong(
      file,
      "no camera of a known dialect (velo, opencv, ros, colmap, nerf, kalibr, blender, gltf, opengl, "
      "vulkan, d3d, mitsuba, usd); its fields are: %s",
      names);
}

static bool is_folder(const char *path) {
  struct stat status;
  return stat(path, &status) == 0 && S_ISDIR(status.st_mode);
}

static bool is_colmap_name(const char *path) {
  return vl_ends_with(path, "cameras.txt") || vl_ends_with(path, "images.txt");
}

/* Detects the dialect by the first characters; AUTO: JSON or YAML. */
static vlCameraDialect dialect_of_text(const char *text, size_t size) {
  size_t first = size >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0 ? 3 : 0; /* skips a UTF-8 byte order mark */
  if (size >= first + 5 && memcmp(text + first, "#usda", 5) == 0) return VL_CAMERA_DIALECT_USD;
  first += strspn(text + first, " \t\r\n");
  if (first < size && text[first] == '<') return VL_CAMERA_DIALECT_MITSUBA;
  return VL_CAMERA_DIALECT_AUTO;
}

static vlResult other_dialect(const vlCameraFile *file, vlCameraDialect found, vlCameraDialect wish) {
  return vl_camera_wrong(file, "this is a camera in the dialect of %s, not of %s", dialects[found].name,
                         dialects[wish].name);
}

static vlResult read_tree(vlCameraFile *file, const char *text, size_t size, vlCameraRecord *record) {
  json_t *tree = NULL;
  vlResult result = vl_camera_tree(file, text, size, &tree);
  if (result != VL_OK) return result;
  vlCameraDialect found = dialect_of(tree), wish = file->def->dialect;
  /* ROS files also have OpenCV's fields */
  bool related = wish == VL_CAMERA_DIALECT_OPENCV && found == VL_CAMERA_DIALECT_ROS;
  related = related || (wish == VL_CAMERA_DIALECT_ROS && found == VL_CAMERA_DIALECT_OPENCV);
  if (wish && found && wish != found && !related) {
    result = other_dialect(file, found, wish);
  } else if (wish && !dialects[wish].read) {
    result = vl_camera_wrong(file, "this is no camera in the dialect of %s", dialects[wish].name);
  } else if (!wish && !found) {
    result = unknown(file, tree);
  } else {
    record->dialect = wish ? wish : found;
    file->dialect = dialects[record->dialect].name;
    result = dialects[record->dialect].read(file, tree, record);
  }
  json_decref(tree);
  return result;
}

static vlResult read_file(vlCameraFile *file, vlCameraRecord *record) {
  char *text;
  size_t size;
  vlResult result = vl_file_read_given(file->context, file->path, false, &text, &size, file->error);
  if (result != VL_OK) return result;
  vlCameraDialect found = dialect_of_text(text, size), wish = file->def->dialect;
  if (found && wish && found != wish) {
    result = other_dialect(file, found, wish);
  } else if (found) {
    record->dialect = found;
    file->dialect = dialects[found].name;
    result = dialects[found].read_text(file, text, size, record);
  } else {
    result = read_tree(file, text, size, record);
  }
  vl_free(file->context, text);
  return result;
}

static vlResult begin(vlContext *context, const char *path, const vlCameraFileDef **def, vlCameraFileDef *standard,
                      vlError *error) {
  vl_error_clear(error);
  *standard = vl_default_camera_file_def();
  if (!context || !path) return vl_fail(error, VL_ERROR_ARGUMENT, "camera file: context or path is null");
  if (!*def) *def = standard;
  if ((*def)->cookie != VL_COOKIE_CAMERA_FILE) return vl_fail(error, VL_ERROR_ARGUMENT, "camera file: " VL_BAD_COOKIE);
  if ((uint32_t)(*def)->dialect >= VL_CAMERA_DIALECT_COUNT)
    return vl_fail(error, VL_ERROR_ARGUMENT, "camera file: unknown dialect %d", (int)(*def)->dialect);
  return VL_OK;
}

vlResult vl_camera_read(vlContext *context, const char *path, const vlCameraFileDef *def, vlCameraRecord *record,
                        vlError *error) {
  vlCameraFileDef standard;
  vlResult result = begin(context, path, &def, &standard, error);
  if (result != VL_OK) return result;
  if (!record) return vl_fail(error, VL_ERROR_ARGUMENT, "camera file: record is null");
  if (def->dialect == VL_CAMERA_DIALECT_EXR)
    return vl_fail(error, VL_ERROR_UNSUPPORTED, "camera file: this is an image; it is read as one");
  if (def->dialect == VL_CAMERA_DIALECT_PBRT)
    return vl_fail(error, VL_ERROR_UNSUPPORTED, "camera file: pbrt scenes are read as scenes");
  vlCameraFile file = {context, path, dialects[def->dialect].name, def, error};
  vlCameraRecord read = {.camera = vl_default_camera_def(1, 1), .frames = 1};
  if (def->dialect == VL_CAMERA_DIALECT_COLMAP || (!def->dialect && (is_folder(path) || is_colmap_name(path)))) {
    file.dialect = "colmap";
    read.dialect = VL_CAMERA_DIALECT_COLMAP;
    result = vl_camera_read_colmap(&file, &read);
  } else {
    result = read_file(&file, &read);
  }
  if (result == VL_OK) *record = read;
  return result;
}

static vlCameraDialect dialect_of_name(const char *path) {
  if (is_colmap_name(path) || is_folder(path)) return VL_CAMERA_DIALECT_COLMAP;
  if (vl_ends_with(path, "transforms.json")) return VL_CAMERA_DIALECT_NERF;
  if (vl_ends_with(path, ".json")) return VL_CAMERA_DIALECT_VELO;
  if (vl_ends_with(path, ".yaml") || vl_ends_with(path, ".yml")) return VL_CAMERA_DIALECT_OPENCV;
  if (vl_ends_with(path, ".pbrt")) return VL_CAMERA_DIALECT_PBRT;
  if (vl_ends_with(path, ".gltf")) return VL_CAMERA_DIALECT_GLTF;
  if (vl_ends_with(path, ".usda")) return VL_CAMERA_DIALECT_USD;
  if (vl_ends_with(path, ".xml")) return VL_CAMERA_DIALECT_MITSUBA;
  return VL_CAMERA_DIALECT_AUTO;
}

vlResult vl_camera_write(vlContext *context, const char *path, const vlCameraFileDef *def, const vlCameraRecord *record,
                         vlError *error) {
  vlCameraFileDef standard;
  vlResult result = begin(context, path, &def, &standard, error);
  if (result != VL_OK) return result;
  if (!record) return vl_fail(error, VL_ERROR_ARGUMENT, "camera file: record is null");
  vlCameraDialect dialect = def->dialect ? def->dialect : dialect_of_name(path);
  if (!dialect)
    return vl_fail(error, VL_ERROR_ARGUMENT, "camera file: the name \"%.200s\" does not say which dialect to write",
                   path);
  if (dialect == VL_CAMERA_DIALECT_EXR)
    return vl_fail(error, VL_ERROR_UNSUPPORTED, "camera file: an image's header is written with its image");
  vlCameraFile file = {context, path, dialects[dialect].name, def, error};
  if (dialect == VL_CAMERA_DIALECT_COLMAP) return vl_camera_write_colmap(&file, record);
  vlCameraText text = {.context = context};
  result = dialects[dialect].write(&file, record, &text);
  if (result == VL_OK && text.failed) result = vl_fail_memory(error);
  vlFileWriter writer;
  if (result == VL_OK) result = vl_file_open_write(&writer, path, error);
  if (result == VL_OK) {
    vl_file_write(&writer, text.text.items, text.text.count);
    result = vl_file_commit(&writer, error);
  }
  VL_ARRAY_FREE(context, &text.text);
  return result;
}
