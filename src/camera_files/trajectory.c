/* camera_files/trajectory.c: trajectories, many frames from one file: detects the kind of file,
 * checks the frames, public functions. Poses and cameras are stored apart, because thousands of
 * frames may share one camera. */
#include "camera_files/trajectory.h"

#include <math.h>
#include <string.h>
#include <sys/stat.h>

#include "base/cookie.h"
#include "base/file.h"
#include "base/free.h"
#include "base/machine.h"
#include "base/text.h"
#include "camera_files/formats.h"
#include "math/double3.h"

/* Allowed deviation of a pose's matrix from a rotation: files have 4 digits or more. */
static const double rotation_tolerance = 1e-3;

vlResult vl_frame_wrong(const vlCameraFile *file, const vlFrameLocation *location,
                        const char *format, ...) {
  char message[300];
  VL_FORMAT(message, format);
  const char *path = location->path ? location->path : file->path;
  const char *name = location->name ? location->name : "";
  return vl_fail_at(file->error, VL_ERROR_SCENE, path, location->line, location->line ? 1 : 0,
                    "frame %u%s%s%s: %s", location->frame, *name ? " (" : "",
                    vl_short_text(name).text, *name ? ")" : "", message);
}

/* Describes what is wrong with a pose. Returns null if the pose is a rotation and a
 * translation. */
static const char *pose_fault(const double m[16]) {
  for (int i = 0; i < 12; i++)
    if (!isfinite(m[i]))
      return "the pose holds a value that is not finite";
  if (vl_rotation_error(m) > rotation_tolerance)
    return "the pose is no rotation: its axes are not of length 1 and at right angles";
  return vl_determinant3(m) > 0.0 ? NULL : "the pose is no rotation: it mirrors";
}

vlResult vl_trajectory_add(vlTrajectory *t, const vlCameraFile *file,
                           const vlFrameLocation *location, int32_t camera, const double m[16],
                           double time) {
  const char *fault = pose_fault(m);
  if (fault)
    return vl_frame_wrong(file, location, "%s", fault);
  if (t->frames.count == INT32_MAX)
    return vl_frame_wrong(file, location, "too many frames");
  const char *name = location->name ? location->name : "";
  size_t length = strlen(name) + 1;
  if (!VL_RESERVE(t->context, &t->names, length))
    return vl_fail_memory(file->error);
  vlStoredFrame *frame = VL_PUSH(t->context, &t->frames);
  if (!frame)
    return vl_fail_memory(file->error);
  memcpy(frame->pose, m, sizeof frame->pose);
  frame->time = time;
  frame->camera = camera;
  frame->line = location->line;
  frame->name = t->names.count;
  memcpy(t->names.items + t->names.count, name, length);
  t->names.count += length;
  return VL_OK;
}

/* The record of a default camera. Clears padding, too, because records are compared bytewise.
 */
void vl_trajectory_begin(vlCameraDialect dialect, vlCameraRecord *record) {
  memset(record, 0, sizeof *record);
  record->camera = vl_default_camera_def(1, 1);
  record->dialect = dialect;
}

vlResult vl_trajectory_add_camera(vlTrajectory *t, const vlCameraFile *file,
                                  const vlCameraRecord *record, int32_t *index) {
  if (t->cameras.count > 0) {
    vlCameraDef last = t->cameras.items[t->cameras.count - 1].camera;
    last.has_matrix = record->camera.has_matrix;
    memcpy(last.world_from_camera, record->camera.world_from_camera,
           sizeof last.world_from_camera);
    *index = (int32_t)t->cameras.count - 1;
    if (memcmp(&last, &record->camera, sizeof last) == 0)
      return VL_OK;
  }
  if (t->cameras.count == INT32_MAX)
    return vl_camera_wrong(file, "too many cameras");
  vlCameraRecord *added = VL_PUSH(t->context, &t->cameras);
  if (!added)
    return vl_fail_memory(file->error);
  memcpy(added, record, sizeof *added); /* with padding, as records are compared bytewise */
  *index = (int32_t)t->cameras.count - 1;
  return VL_OK;
}

/* ---- which file -------------------------------------------------------------------------- */

/* Adds a camera with its pose as a frame. */
static vlResult add_record(void *data, const vlCameraFile *file, const vlCameraRecord *record,
                           uint32_t frame) {
  vlTrajectory *t = data;
  vlCamera camera;
  int32_t index;
  vlResult result = vl_camera_make(&record->camera, &camera, NULL, file->error);
  if (result == VL_ERROR_ARGUMENT)
    result = vl_camera_wrong(
        file, "%s", file->error && file->error->message[0] ? file->error->message : "camera");
  if (result == VL_OK)
    result = vl_trajectory_add_camera(t, file, record, &index);
  vlFrameLocation location = {.name = record->name, .frame = frame};
  if (result == VL_OK)
    result = vl_trajectory_add(t, file, &location, index, camera.world_from_camera, VL_UNSET);
  return result;
}

/* Fields that the dialect does not know are noted in the first camera. */
static vlResult note_unread(const vlCameraFile *file, const json_t *tree,
                            vlCameraRecord *first) {
  const vlCameraFormat *format = vl_camera_formats[first->dialect];
  vlCameraFile copy = *file;
  copy.dialect = format->name;
  return vl_camera_check_unread(&copy, format, tree, first);
}

/* Reads a JSON or YAML file. *single: the file has one camera, for vl_camera_read. */
static vlResult read_tree(vlTrajectory *t, const vlCameraFile *file, const char *text,
                          size_t size, bool *single) {
  json_t *tree = NULL;
  vlResult result = vl_camera_tree(file, text, size, &tree);
  *single = false;
  if (result != VL_OK)
    return result;
  if (json_object_get(tree, "frames"))
    result = vl_trajectory_read_nerf(t, file, tree, text);
  else if (json_object_get(tree, "cam0"))
    result = vl_trajectory_read_kalibr(t, file, tree);
  else if (json_object_get(tree, "extrinsic_parameters"))
    result = vl_trajectory_read_opencv(t, file, tree, text);
  else
    *single = true;
  if (result == VL_OK && !*single && t->cameras.count > 0)
    result = note_unread(file, tree, &t->cameras.items[0]);
  json_decref(tree);
  return result;
}

static bool is_tree(const char *path, const char *text) {
  const char *first = text + strspn(text, " \t\r\n");
  return *first == '{' || strncmp(first, "%YAML", 5) == 0 || strncmp(first, "---", 3) == 0 ||
         vl_ends_with(path, ".yaml") || vl_ends_with(path, ".yml");
}

/* Whether the file is a list of poses: CSV by its name, or text that begins like one. */
static bool is_list(const char *path, const char *text) {
  if (vl_ends_with(path, ".csv") || vl_ends_with(path, ".txt") || vl_ends_with(path, ".tsv"))
    return true;
  const char *first = text + strspn(text, " \t\r\n");
  return *first && strchr("+-.0123456789#", *first);
}

static vlResult read_any(vlTrajectory *t, const vlCameraFile *file) {
  struct stat status;
  bool folder = stat(file->path, &status) == 0 && S_ISDIR(status.st_mode);
  vlCameraDialect wish = file->def->dialect;
  if (folder || wish == VL_CAMERA_DIALECT_COLMAP || (!wish && vl_colmap_is_name(file->path))) {
    vlCameraFile colmap = *file;
    colmap.dialect = "colmap";
    return vl_trajectory_read_colmap(t, &colmap);
  }
  char *text;
  size_t size;
  bool single = true;
  vlResult result =
      vl_file_read_given(file->context, file->path, false, &text, &size, file->error);
  if (result != VL_OK)
    return result;
  bool camera = vl_camera_dialect_of_text(text, size); /* KITTI's calib.txt is no list */
  if (!camera && is_tree(file->path, text)) {
    result = read_tree(t, file, text, size, &single);
  } else if (!camera && is_list(file->path, text)) {
    result = vl_trajectory_read_csv(t, file, text, size);
    single = false;
  }
  vl_free(file->context, text);
  return result == VL_OK && single ? vl_camera_read_each(file, &(vlCameraSink){add_record, t})
                                   : result;
}

/* ---- public functions -------------------------------------------------------------------- */

vlResult vl_trajectory_load(vlContext *context, const char *path, const vlCameraFileDef *def,
                            vlTrajectory **trajectory, vlError *error) {
  vl_error_clear(error);
  if (!context || !path || !trajectory)
    return vl_fail_argument(error, "trajectory: context, path or trajectory is null");
  *trajectory = NULL;
  vlCameraFileDef plain = def ? *def : vl_default_camera_file_def();
  if (plain.cookie != VL_COOKIE_CAMERA_FILE)
    return vl_fail_argument(error, "trajectory: " VL_BAD_COOKIE);
  plain.frame = NULL;
  vlTrajectory *t = vl_alloc_zero(context, 1, sizeof *t);
  if (!t)
    return vl_fail_memory(error);
  t->context = context;
  vlCameraFile file = {
      .context = context, .path = path, .dialect = "trajectory", .def = &plain, .error = error};
  void *locale = vl_machine_set_numerals();
  vlResult result = read_any(t, &file);
  vl_machine_restore_numerals(locale);
  if (result == VL_OK && t->frames.count == 0)
    result = vl_fail_at(error, VL_ERROR_SCENE, path, 0, 0, "the file holds no pose");
  if (result != VL_OK) {
    vl_trajectory_destroy(t);
    return result;
  }
  *trajectory = t;
  return VL_OK;
}

void vl_trajectory_destroy(vlTrajectory *t) {
  if (!t)
    return;
  vlContext *context = t->context;
  VL_FREE(context, t->frames.items, t->cameras.items, t->names.items, t);
}

uint32_t vl_trajectory_frames(const vlTrajectory *t) {
  return t ? (uint32_t)t->frames.count : 0;
}

uint32_t vl_trajectory_cameras(const vlTrajectory *t) {
  return t ? (uint32_t)t->cameras.count : 0;
}

const vlCameraRecord *vl_trajectory_camera(const vlTrajectory *t, uint32_t index) {
  return t && index < t->cameras.count ? &t->cameras.items[index] : NULL;
}

vlResult vl_trajectory_frame(const vlTrajectory *t, uint32_t index, vlTrajectoryFrame *frame) {
  if (!t || !frame || index >= t->frames.count)
    return VL_ERROR_ARGUMENT;
  const vlStoredFrame *stored = &t->frames.items[index];
  *frame = (vlTrajectoryFrame){.name = t->names.items + stored->name,
                               .camera = stored->camera,
                               .line = stored->line,
                               .world_from_camera = {[15] = 1.0},
                               .time = stored->time};
  memcpy(frame->world_from_camera, stored->pose, sizeof stored->pose);
  return VL_OK;
}
