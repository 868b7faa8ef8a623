/* camera_files/trajectory_trees.c: trajectories in JSON and YAML files: transforms.json,
 * camchains, OpenCV's calibrations. The JSON tree has no line numbers: the line of a frame is
 * searched in the text. */
#include <stdio.h>
#include <string.h>

#include "camera_files/trajectory.h"

/* Returns the line of occurrence n of a key, counted from 0. Returns 0 if there are fewer
 * occurrences. */
static uint32_t line_of_key(const char *text, const char *key, uint32_t n) {
  const char *at = strstr(text, key);
  for (uint32_t i = 0; at && i < n; i++)
    at = strstr(at + 1, key);
  uint32_t line = 1;
  for (const char *c = text; at && c < at; c++)
    line += *c == '\n';
  return at ? line : 0;
}

/* Prefixes the reader's message with the frame, and with its location if known. */
static vlResult in_frame(const vlCameraFile *file, const vlFrameLocation *location,
                         vlResult result) {
  if (result != VL_ERROR_SCENE || !file->error)
    return result;
  vlError inner = *file->error;
  vl_frame_wrong(file, location, "%s", inner.message);
  return result;
}

vlResult vl_trajectory_read_nerf(vlTrajectory *t, const vlCameraFile *from, const json_t *tree,
                                 const char *text) {
  const json_t *frames = json_object_get(tree, "frames");
  vlCameraFile copy = *from, *file = &copy;
  file->dialect = "nerf";
  if (!json_is_array(frames))
    return vl_camera_wrong(file, "nerf: \"frames\" must be a list");
  uint32_t count = (uint32_t)json_array_size(frames);
  for (uint32_t i = 0; i < count; i++) {
    const json_t *frame = json_array_get(frames, i), *time = json_object_get(frame, "time");
    vlCameraRecord record;
    vl_trajectory_begin(VL_CAMERA_DIALECT_NERF, &record);
    record.frames = count;
    vlFrameLocation location = {.frame = i, .name = vl_camera_text(frame, "file_path")};
    int32_t camera = 0;
    vlResult result = VL_ERROR_SCENE;
    if (json_is_object(frame))
      result = vl_camera_read_nerf_frame(file, frame, tree, &record);
    else
      vl_camera_wrong(file, "nerf: it is no object");
    if (result == VL_OK)
      result = vl_trajectory_add_camera(t, file, &record, &camera);
    if (result == VL_OK)
      result = vl_trajectory_add(t, file, &location, camera, record.camera.world_from_camera,
                                 json_is_number(time) ? json_number_value(time) : VL_UNSET);
    else
      result = in_frame(file, &location, result);
    if (result == VL_OK)
      continue;
    if (result == VL_ERROR_SCENE && file->error && file->error->line == 0) {
      file->error->line = line_of_key(text, "transform_matrix", i);
      file->error->column = file->error->line ? 1 : 0;
    }
    return result;
  }
  return VL_OK;
}

/* Adds each camera as a frame, with its pose relative to the first camera. */
vlResult vl_trajectory_read_kalibr(vlTrajectory *t, const vlCameraFile *from,
                                   const json_t *tree) {
  enum { MAX_CAMERAS = 1024 };
  vlCameraFileDef def = *from->def;
  vlCameraFile copy = *from, *file = &copy;
  file->def = &def;
  file->dialect = "kalibr";
  for (uint32_t i = 0; i < MAX_CAMERAS; i++) {
    char key[16];
    snprintf(key, sizeof key, "cam%u", i);
    if (!json_object_get(tree, key))
      break;
    def.frame = key;
    vlCameraRecord record;
    vl_trajectory_begin(VL_CAMERA_DIALECT_KALIBR, &record);
    int32_t camera = 0;
    vlFrameLocation location = {.frame = i, .name = key};
    VL_TRY(vl_camera_read_kalibr(file, tree, &record));
    VL_TRY(vl_trajectory_add_camera(t, file, &record, &camera));
    VL_TRY(vl_trajectory_add(t, file, &location, camera, record.camera.world_from_camera,
                             VL_UNSET));
  }
  return VL_OK;
}

/* "extrinsic_parameters" of OpenCV's calibration program: one row per view, rvec and tvec:
 * camera from world. */
vlResult vl_trajectory_read_opencv(vlTrajectory *t, const vlCameraFile *from,
                                   const json_t *tree, const char *text) {
  vlCameraFile copy = *from, *file = &copy;
  file->dialect = "opencv";
  vlCameraRecord record;
  vl_trajectory_begin(VL_CAMERA_DIALECT_OPENCV, &record);
  int32_t camera = 0;
  VL_TRY(vl_camera_read_opencv(file, tree, &record));
  VL_TRY(vl_trajectory_add_camera(t, file, &record, &camera));
  const json_t *views = json_object_get(tree, "extrinsic_parameters");
  const json_t *data = json_is_object(views) ? json_object_get(views, "data") : views;
  bool nested = json_is_array(json_array_get(data, 0));
  size_t values = json_array_size(data), count = nested ? values : values / 6;
  if (!json_is_array(data) || (!nested && values % 6 != 0))
    return vl_camera_wrong(
        file, "opencv: \"extrinsic_parameters\" must be 6 numbers for each view: rvec, tvec");
  const uint32_t line = line_of_key(text, "extrinsic_parameters", 0);
  for (size_t i = 0; i < count; i++) {
    double v[6] = {0}, r[9];
    vlFrameLocation location = {.frame = (uint32_t)i, .line = line};
    const json_t *row = nested ? json_array_get(data, i) : NULL;
    bool good = !nested || json_array_size(row) == 6;
    for (size_t k = 0; k < 6 && good; k++) {
      const json_t *value = nested ? json_array_get(row, k) : json_array_get(data, 6 * i + k);
      good = json_is_number(value);
      v[k] = json_number_value(value);
    }
    if (!good)
      return vl_frame_wrong(file, &location,
                            "\"extrinsic_parameters\" must be 6 finite numbers: rvec, tvec");
    vl_rotation_from_vector(v, r);
    vl_camera_set_pose(&record.camera, r, v + 3);
    VL_TRY(vl_trajectory_add(t, file, &location, camera, record.camera.world_from_camera,
                             VL_UNSET));
  }
  return VL_OK;
}
