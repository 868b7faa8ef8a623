/* camera_files/colmap.c: COLMAP's model, in its text form: cameras.txt (id, model, width,
 * height, parameters) and images.txt (id, quaternion w x y z, translation, camera id, name; a
 * line of points follows each). OpenCV's axes, camera from world, but the first pixel's centre
 * is (0.5, 0.5), as in velo. */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/free.h"
#include "base/text.h"
#include "camera_files/colmap.h"
#include "camera_files/fields.h"
#include "camera_files/lines.h"
#include "camera_files/trajectory.h"
#include "velo/distortion.h"
#include "velo/projection.h"

/* The next line that is not a comment; null: there is none. */
static char *next_line(vlRawLines *lines) {
  char *line = vl_camera_raw_line(lines);
  while (line && line[0] == '#')
    line = vl_camera_raw_line(lines);
  return line;
}

/* The same for lines that are not blank. */
static char *next_entry(vlRawLines *lines) {
  char *line = next_line(lines);
  while (line && line[strspn(line, " \t")] == 0)
    line = next_line(lines);
  return line;
}

static vlResult wrong_line(const vlCameraFile *file, const char *path, uint32_t line,
                           const char *what) {
  return vl_fail_at(file->error, VL_ERROR_SCENE, path, line, 1, "colmap: %s", what);
}

static bool next_number(char **at, double *value) {
  char *end;
  *value = vl_camera_parse(*at, &end);
  bool found = end != *at && isfinite(*value) && (*end == ' ' || *end == '\t' || *end == 0);
  *at = end;
  return found;
}

static char *next_word(char **at) {
  char *word = *at + strspn(*at, " \t");
  size_t n = strcspn(word, " \t");
  *at = word + n + (word[n] != 0);
  word[n] = 0;
  return word;
}

static vlResult read_camera_line(const vlCameraFile *file, const char *path,
                                 const vlRawLines *lines, char *rest, vlCameraDef *d) {
  char *model = next_word(&rest);
  double size[2], parameters[16];
  uint32_t count = 0;
  if (!next_number(&rest, &size[0]) || !next_number(&rest, &size[1]) ||
      !vl_camera_set_sides(d, size))
    return wrong_line(file, path, lines->number,
                      "after the model come width and height in whole pixels");
  for (rest += strspn(rest, " \t"); *rest; rest += strspn(rest, " \t")) {
    if (count == VL_LENGTH(parameters))
      return wrong_line(file, path, lines->number, "more than 16 parameters");
    if (!next_number(&rest, &parameters[count++]))
      return wrong_line(file, path, lines->number, "a parameter is no finite number");
  }
  vlError error = {0};
  if (vl_camera_def_colmap(d, model, parameters, count, &error) == VL_OK)
    return VL_OK;
  vl_shorten_quoted(&error, model);
  return wrong_line(file, path, lines->number, error.message);
}

/* Loads a file into *text, which is to be freed. */
static vlResult open_lines(const vlCameraFile *file, const char *path, char **text,
                           vlRawLines *lines) {
  size_t size;
  VL_TRY(vl_colmap_load(file, path, text, &size));
  *lines = (vlRawLines){*text, *text + size, 0};
  return VL_OK;
}

/* Reads the camera with this id, or the first camera if id is null. */
static vlResult read_cameras(const vlCameraFile *file, const char *path, const double *id,
                             vlCameraRecord *record) {
  char *text = NULL;
  vlRawLines lines;
  vlResult result = open_lines(file, path, &text, &lines);
  bool found = false;
  for (char *line; result == VL_OK && !found && (line = next_entry(&lines));) {
    double number;
    if (!next_number(&line, &number))
      result = wrong_line(file, path, lines.number, "a line begins with the camera's number");
    else if ((found = !id || number == *id))
      result = read_camera_line(file, path, &lines, line, &record->camera);
  }
  if (result == VL_OK && !found)
    result = wrong_line(file, path, 0, "the camera of the image is not there");
  vl_free(file->context, text);
  return result;
}

static vlResult read_image_line(const vlCameraFile *file, const char *path, uint32_t line,
                                char *rest, bool *found, uint32_t index, double *id,
                                vlCameraRecord *record) {
  double v[9], r[9];
  for (int i = 0; i < 9; i++)
    if (!next_number(&rest, &v[i]))
      return wrong_line(file, path, line,
                        "an image has 9 finite numbers: id, qw qx qy qz, tx ty tz, camera");
  rest += strspn(rest, " \t");
  *found = vl_camera_is_frame(file, index, rest);
  if (!*found)
    return VL_OK;
  if (!vl_rotation_from_quaternion(v + 1, r))
    return wrong_line(file, path, line, "the quaternion is zero");
  vl_camera_set_pose(&record->camera, r, v + 5);
  vl_camera_name(record, rest);
  *id = v[8];
  return VL_OK;
}

static vlResult read_images(const vlCameraFile *file, const char *path, double *id,
                            vlCameraRecord *record) {
  char *text = NULL;
  vlRawLines lines;
  vlResult result = open_lines(file, path, &text, &lines);
  bool taken = false;
  record->frames = 0;
  for (char *line; result == VL_OK && (line = next_entry(&lines));) {
    bool found = false;
    if (!taken)
      result =
          read_image_line(file, path, lines.number, line, &found, record->frames, id, record);
    taken = taken || found;
    record->frames++;
    next_line(&lines); /* skip the line of points */
  }
  if (result == VL_OK && !taken)
    result = vl_camera_no_frame(file, "image", record);
  vl_free(file->context, text);
  return result;
}

/* ---- many images ------------------------------------------------------------------------- */

typedef struct {
  double id;
  int32_t index; /* index in the trajectory's cameras */
} CameraId;
typedef VL_ARRAY(CameraId) CameraIds;

static int by_id(const void *a, const void *b) {
  double x = ((const CameraId *)a)->id, y = ((const CameraId *)b)->id;
  return (x > y) - (x < y);
}

static vlResult read_all_cameras(vlTrajectory *t, const vlCameraFile *file, const char *path,
                                 char *text, size_t size, CameraIds *ids) {
  vlRawLines lines = {text, text + size, 0};
  for (char *line; (line = next_entry(&lines));) {
    vlCameraRecord record;
    CameraId id;
    vl_trajectory_begin(VL_CAMERA_DIALECT_COLMAP, &record);
    if (!next_number(&line, &id.id))
      return wrong_line(file, path, lines.number, "a line begins with the camera's number");
    VL_TRY(read_camera_line(file, path, &lines, line, &record.camera));
    snprintf(record.name, sizeof record.name, "%.0f", id.id);
    VL_TRY(vl_trajectory_add_camera(t, file, &record, &id.index));
    CameraId *added = VL_PUSH(file->context, ids);
    if (!added)
      return vl_fail_memory(file->error);
    *added = id;
  }
  if (ids->count)
    qsort(ids->items, ids->count, sizeof *ids->items, by_id);
  return VL_OK;
}

static vlResult read_all_images(vlTrajectory *t, const vlCameraFile *file, const char *path,
                                char *text, size_t size, const CameraIds *ids) {
  vlRawLines lines = {text, text + size, 0};
  vlCameraFileDef any = *file->def; /* no frame filter: every image is read */
  vlCameraFile copy = *file;
  copy.def = &any;
  any.frame = NULL;
  for (char *line; (line = next_entry(&lines));) {
    vlCameraRecord record = {.frames = 0};
    CameraId wanted = {0, 0};
    bool found = false;
    VL_TRY(read_image_line(&copy, path, lines.number, line, &found, 0, &wanted.id, &record));
    const CameraId *id =
        ids->count ? bsearch(&wanted, ids->items, ids->count, sizeof *ids->items, by_id) : NULL;
    vlFrameLocation location = {path, lines.number, (uint32_t)t->frames.count, record.name};
    if (!id)
      return vl_frame_wrong(file, &location, "there is no camera %.0f in cameras.txt",
                            wanted.id);
    VL_TRY(vl_trajectory_add(t, file, &location, id->index, record.camera.world_from_camera,
                             VL_UNSET));
    next_line(&lines); /* skip the line of points */
  }
  return VL_OK;
}

static bool find_files(const char *path, bool to_read, char cameras[4096], char images[4096]);

vlResult vl_trajectory_read_colmap(vlTrajectory *t, const vlCameraFile *file) {
  char paths[2][4096], *texts[2] = {NULL, NULL};
  size_t sizes[2] = {0, 0};
  CameraIds ids = {NULL, 0, 0};
  if (!find_files(file->path, true, paths[0], paths[1]))
    return vl_camera_wrong(file, "colmap: the name is too long");
  vlResult result = VL_OK;
  for (int i = 0; i < 2 && result == VL_OK; i++)
    result = vl_colmap_load(file, paths[i], &texts[i], &sizes[i]);
  if (result == VL_OK)
    result = read_all_cameras(t, file, paths[0], texts[0], sizes[0], &ids);
  if (result == VL_OK)
    result = read_all_images(t, file, paths[1], texts[1], sizes[1], &ids);
  VL_FREE(file->context, texts[0], texts[1], ids.items);
  return result;
}

bool vl_colmap_is_name(const char *path) {
  static const char *const names[] = {"cameras.txt", "images.txt", "cameras.bin", "images.bin"};
  for (int i = 0; i < 4; i++)
    if (vl_ends_with(path, names[i]))
      return true;
  return false;
}

/* Returns whether the path is a folder. A missing path counts as a folder unless it has the
 * name of a model file. */
static bool is_folder(const char *path) {
  struct stat status;
  if (stat(path, &status) == 0)
    return S_ISDIR(status.st_mode);
  return !vl_ends_with(path, ".txt") && !vl_ends_with(path, ".bin");
}

static bool exists(const char *folder, const char *inner, const char *name) {
  struct stat status;
  char path[4096];
  int length = snprintf(path, sizeof path, "%s/%s%s", folder, inner, name);
  return length > 0 && length < (int)sizeof path && stat(path, &status) == 0;
}

/* Finds the paths of both files from the path of either, or of their folder, or of a project
 * with its models in sparse. A folder with both forms is read in its binary one, as COLMAP
 * does. */
static bool find_files(const char *path, bool to_read, char cameras[4096], char images[4096]) {
  static const char *const inner[] = {"", "sparse/0/", "sparse/", "0/"};
  int a, b;
  if (is_folder(path)) {
    int found = 0, folders = to_read ? 4 : 1;
    while (found < folders && !exists(path, inner[found], "cameras.bin") &&
           !exists(path, inner[found], "cameras.txt"))
      found++;
    const char *below = inner[found % folders],
               *suffix = exists(path, below, "cameras.bin") ? "bin" : "txt";
    a = snprintf(cameras, 4096, "%s/%scameras.%s", path, below, suffix);
    b = snprintf(images, 4096, "%s/%simages.%s", path, below, suffix);
  } else {
    const char *suffix = vl_ends_with(path, ".bin") ? "bin" : "txt";
    bool is_images = vl_ends_with(path, "images.txt") || vl_ends_with(path, "images.bin");
    int folder_length = (int)vl_folder_length(path);
    a = is_images ? snprintf(cameras, 4096, "%.*scameras.%s", folder_length, path, suffix)
                  : snprintf(cameras, 4096, "%s", path);
    b = is_images ? snprintf(images, 4096, "%s", path)
                  : snprintf(images, 4096, "%.*simages.%s", folder_length, path, suffix);
  }
  return a > 0 && a < 4096 && b > 0 && b < 4096;
}

vlResult vl_camera_read_colmap(const vlCameraFile *file, vlCameraRecord *record) {
  char cameras[4096], images[4096];
  struct stat status;
  double id = 0.0;
  if (!find_files(file->path, true, cameras, images))
    return vl_camera_wrong(file, "colmap: the name is too long");
  /* cameras.txt alone: the camera is at the origin, unless an image's pose was requested */
  if (stat(images, &status) == 0 || file->def->frame ||
      vl_ends_with(file->path, "images.txt") || vl_ends_with(file->path, "images.bin")) {
    VL_TRY(read_images(file, images, &id, record));
    return read_cameras(file, cameras, &id, record);
  }
  vl_camera_set_origin(&record->camera);
  return read_cameras(file, cameras, NULL, record);
}

/* ---- writing ----------------------------------------------------------------------------- */

static vlResult choose_model(const vlFittedCamera *fit, vlColmapRecord *out) {
  static const char *const names[VL_LENS_OTHER] = {"PINHOLE", "OPENCV", "OPENCV_FISHEYE",
                                                   "FOV"};
  static const struct {
    const char *name;
    vlDistortion distortion;
    uint32_t count;
  } prisms[] = {{"THIN_PRISM_FISHEYE", VL_DISTORTION_THIN_PRISM, 8},
                {"RAD_TAN_THIN_PRISM_FISHEYE", VL_DISTORTION_RAD_TAN_THIN_PRISM, 12}};
  const vlCameraDef *d = &fit->record->camera;
  const double *k = fit->k;
  uint32_t count = fit->count;
  if (fit->family < VL_LENS_OTHER)
    out->model = names[fit->family];
  if (fit->family == VL_LENS_OPENCV && count > 4) {
    out->model = "FULL_OPENCV";
    count = 8;
  }
  for (size_t i = 0; i < VL_LENGTH(prisms); i++)
    if (d->projection == VL_PROJECTION_EQUIDISTANT && d->distortion == prisms[i].distortion) {
      out->model = prisms[i].name;
      k = d->distortion_coefficients;
      count = prisms[i].count;
    }
  if (!out->model || !vl_camera_all_zero(fit->k + 8, 6))
    return vl_camera_no_model(fit->file, d);
  memcpy(out->parameters + 4, k, count * sizeof *k);
  out->count = 4 + count;
  return VL_OK;
}

static void put_lines(vlCameraText *cameras, vlCameraText *images, const vlColmapRecord *r) {
  vl_camera_put(
      cameras,
      "# CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]; the first pixel's centre is (0.5, 0.5)\n");
  vl_camera_put(cameras, "1 %s %u %u", r->model, r->width, r->height);
  for (uint32_t i = 0; i < r->count; i++)
    vl_camera_put(cameras, " %.17g", r->parameters[i] + 0.0);
  vl_camera_put(cameras, "\n");
  vl_camera_put(
      images, "# IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME; camera from world\n1");
  for (int i = 0; i < 4; i++)
    vl_camera_put(images, " %.17g", r->quaternion[i] + 0.0);
  for (int i = 0; i < 3; i++)
    vl_camera_put(images, " %.17g", r->translation[i] + 0.0);
  vl_camera_put(images, " 1 %s\n\n", r->name);
}

static vlResult write_model(const vlCameraFile *file, const vlCameraRecord *record) {
  char cameras[4096], images[4096];
  vlFittedCamera fit;
  const vlCamera *c = &fit.camera;
  double r[9];
  vlColmapRecord out = {.name = record->name[0] ? record->name : "camera"};
  VL_TRY(vl_camera_fit(file, record, &vl_format_colmap, &fit));
  VL_TRY(choose_model(&fit, &out));
  if (!find_files(file->path, false, cameras, images))
    return vl_camera_wrong(file, "colmap: the name is too long");
  if (is_folder(file->path) && mkdir(file->path, 0777) != 0 && errno != EEXIST)
    return vl_fail(file->error, VL_ERROR_IO, "cannot make the folder %s: %s", file->path,
                   strerror(errno));
  out.width = c->width;
  out.height = c->height;
  const double intrinsics[4] = {c->fx, c->fy, c->cx, c->cy};
  memcpy(out.parameters, intrinsics, sizeof intrinsics);
  vl_camera_get_pose(c, r, out.translation);
  vl_rotation_to_quaternion(r, out.quaternion);
  vlCameraText text = {.context = file->context}, poses = {.context = file->context};
  if (vl_ends_with(cameras, ".bin"))
    vl_colmap_put_bin(&text, &poses, &out);
  else
    put_lines(&text, &poses, &out);
  vlResult result = vl_camera_write_text(file, cameras, &text);
  if (result == VL_OK)
    result = vl_camera_write_text(file, images, &poses);
  VL_FREE(file->context, text.text.items, poses.text.items);
  return result;
}

/* The row has no functions: a model consists of two files, so vl_camera_read and
 * vl_camera_write call COLMAP's functions directly. */
const vlCameraFormat vl_format_colmap = {
    .name = "colmap", .holds = VL_HOLDS_POSE, .write_folder = write_model};
