/* render/frames.c: see frames.h. The list of frames, their cameras and their file names. */
#include "render/frames.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "camera/camera.h"
#include "cli/macros.h"
#include "cli/report.h"
#include "cli/text.h"
#include "cli/vector.h"
#include "render/pattern.h"
#include "render/shard.h"

static const double identity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
static const double y_up[16] = {1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

bool frames_wanted(const Arguments *arguments, const Job *job) {
  if (arguments->values[RENDER_TRAJECTORY].given)
    return true;
  return job && job->defs->camera.stereo.mode != VL_STEREO_NONE;
}

/* ---- the command line -------------------------------------------------------------------- */

int frames_check(const Arguments *arguments, Outputs *outputs) {
  const OptionValue *v = arguments->values;
  bool trajectory = v[RENDER_TRAJECTORY].given;
  FrameRange unused;
  outputs->patterns = trajectory || v[RENDER_STEREO].given;
  if (v[RENDER_RIG].given && !trajectory)
    return report_usage("--rig FILE: the poses are missing; give --trajectory");
  if (v[RENDER_FRAMES].given && !trajectory)
    return report_usage("--frames goes with --trajectory, --animate or --turntable");
  if (v[RENDER_SKIP_EXISTING].given && !trajectory)
    return report_usage("--skip-existing goes with --trajectory");
  if (v[RENDER_FRAME].given && (trajectory || !v[RENDER_CAMERA].given))
    return report_usage(
        trajectory ? "--frame goes with --camera; a trajectory's are chosen by --frames"
                   : "--frame NAME says which camera of --camera FILE");
  if (v[RENDER_FRAMES].given)
    TRY(pattern_range(v[RENDER_FRAMES].text, &unused));
  if (trajectory && (v[RENDER_FLOW_CAMERA].given || v[RENDER_FLOW_CAMERA_BEFORE].given))
    return report_usage("--flow-camera is of one image: it does not go with --trajectory");
  if (trajectory && (v[RENDER_FILM].given || v[RENDER_CONTINUE].given))
    return report_usage(
        "--film is of one image; a trajectory is split and continued by its frames: --shard, "
        "--frames");
  if (!trajectory)
    return -1;
  if (outputs->count == 0)
    return report_usage(
        "--trajectory: give the files' name with -o, such as -o frame_%%04d.exr");
  for (int i = 0; i < outputs->count; i++)
    TRY(pattern_check(outputs->paths[i]));
  return -1;
}

/* ---- cameras ----------------------------------------------------------------------------- */

/* Shares the film of an earlier camera with the same film def, or makes one. */
static int make_film(Frames *frames, FrameCamera *camera) {
  for (FrameCamera *other = frames->cameras; other < camera; other++)
    if (memcmp(&other->job.defs->film, &camera->job.defs->film,
               sizeof camera->job.defs->film) == 0) {
      camera->film = other->film;
      return -1;
    }
  TRY(job_make_film(&camera->job, &camera->film));
  camera->owns_film = true;
  return -1;
}

/* Adds a camera. If record is null, adds the job's own camera. */
static int add_camera(Frames *frames, const Job *job, const Arguments *arguments,
                      const vlCameraRecord *record, const char *path) {
  FrameCamera *camera = &frames->cameras[frames->camera_count++];
  camera->job = *job;
  if (record) {
    text_set(camera->name, "%s", record->name);
    TRY(job_take_camera(&camera->job, &camera->defs, &record->camera, path, arguments));
  }
  /* the frames' poses replace the camera's pose and motion */
  vlError error = {0};
  vlCamera base = camera->job.camera;
  vlResult result = VL_OK;
  memcpy(camera->mount, base.world_from_camera, sizeof camera->mount);
  if (frames->trajectory) {
    /* a negative fy in a calibration file, however, is the direction of y for all frames (a
     * camera of a scene has it in its pose) */
    const OptionValue *file = &arguments->values[RENDER_CAMERA];
    bool turned = !record && file->given && !camera_is_scene(file->text) &&
                  memcmp(base.world_from_camera, y_up, sizeof y_up) == 0;
    result = vl_camera_move(&base, turned ? y_up : identity, &base, &error);
  }
  camera->middle = base;
  for (int i = 0; i < frames->views && result == VL_OK; i++)
    result = vl_camera_eye(&base, &camera->job.defs->camera.stereo, frames->eyes[i],
                           &camera->eyes[i], &error);
  if (result == VL_OK)
    return make_film(frames, camera);
  vlError location = camera->job.camera_location;
  text_set(location.message, "%s", error.message);
  return report_error(&location, result, path);
}

static int load_file(vlContext *context, const char *path, const Arguments *arguments,
                     vlTrajectory **trajectory) {
  vlError error = {0};
  vlCameraFileDef def = vl_default_camera_file_def();
  option_size(&arguments->values[RENDER_RESOLUTION], &def.width, &def.height);
  option_size(&arguments->values[RENDER_SIZE], &def.width, &def.height);
  TRY(report_error(&error, vl_trajectory_load(context, path, &def, trajectory, &error), path));
  camera_note_unread(path, vl_trajectory_camera(*trajectory, 0));
  return -1;
}

/* Adds the rig's cameras with their poses in the rig. */
static int add_rig(Frames *frames, const Job *job, const Arguments *arguments,
                   const char *path) {
  for (uint32_t i = 0; i < vl_trajectory_frames(frames->rig); i++) {
    vlTrajectoryFrame frame;
    vl_trajectory_frame(frames->rig, i, &frame);
    if (frame.camera == VL_NO_CAMERA)
      return report_failure(STATUS_SCENE, "%s: a rig needs cameras; this file holds poses only",
                            path);
    vlCameraRecord record = *vl_trajectory_camera(frames->rig, (uint32_t)frame.camera);
    if (*frame.name)
      text_set(record.name, "%s", frame.name);
    if (!record.name[0])
      text_set(record.name, "%u", i);
    TRY(add_camera(frames, job, arguments, &record, path));
    memcpy(frames->cameras[i].mount, frame.world_from_camera, sizeof frame.world_from_camera);
  }
  return -1;
}

/* --shard I/N: every N-th of these frames. */
static int choose_shard(Frames *frames, const Arguments *arguments) {
  FrameRange *range = &frames->range;
  uint32_t index, count, all = pattern_count(range);
  if (!arguments->values[RENDER_SHARD].given)
    return -1;
  shard_read(arguments, &index, &count);
  if (count > all)
    return report_usage("--shard %u/%u: more parts than frames (%u)", index, count, all);
  range->first += (index - 1) * range->step;
  range->step *= count; /* at most last + step, no overflow since count <= all */
  return -1;
}

int frames_load(Frames *frames, const Job *job, const Arguments *arguments) {
  static const char *const names[2] = {"left", "right"};
  const OptionValue *v = arguments->values;
  const vlCameraDef *def = &job->defs->camera;
  const FilmPlan *films = frames->films;
  bool stereo = def->stereo.mode != VL_STEREO_NONE,
       both = stereo && def->stereo_eye == VL_EYE_BOTH;
  memset(frames, 0, sizeof *frames);
  frames->films = films;
  frames->range.step = 1;
  frames->skip_existing = v[RENDER_SKIP_EXISTING].given;
  frames->views = both ? 2 : 1;
  for (int i = 0; i < 2; i++)
    frames->eyes[i] = both ? (i ? VL_EYE_RIGHT : VL_EYE_LEFT) : def->stereo_eye;
  for (int i = 0; i < 2; i++)
    frames->view_names[i] = stereo ? names[frames->eyes[i] == VL_EYE_RIGHT] : "";
  const char *path = v[RENDER_TRAJECTORY].text, *rig = v[RENDER_RIG].text;
  if (v[RENDER_TRAJECTORY].given)
    TRY(load_file(job->context, path, arguments, &frames->trajectory));
  if (v[RENDER_RIG].given)
    TRY(load_file(job->context, rig, arguments, &frames->rig));
  if (frames->trajectory) {
    const uint32_t poses = vl_trajectory_frames(frames->trajectory);
    TRY(pattern_choose(v[RENDER_FRAMES].text, poses, "trajectory", &frames->range));
    TRY(choose_shard(frames, arguments));
  }
  uint32_t count = frames->rig ? vl_trajectory_frames(frames->rig)
                               : vl_trajectory_cameras(frames->trajectory);
  frames->cameras = calloc(count ? count : 1, sizeof *frames->cameras);
  if (!frames->cameras)
    return report_no_memory();
  if (frames->rig)
    return add_rig(frames, job, arguments, rig);
  if (count == 0)
    return add_camera(frames, job, arguments, NULL, NULL);
  for (uint32_t i = 0; i < count; i++)
    TRY(add_camera(frames, job, arguments, vl_trajectory_camera(frames->trajectory, i), path));
  return -1;
}

void frames_free(Frames *frames) {
  for (uint32_t i = 0; i < frames->camera_count; i++)
    if (frames->cameras[i].owns_film)
      vl_film_destroy(frames->cameras[i].film);
  free(frames->cameras);
  steady_free(&frames->steady);
  vl_trajectory_destroy(frames->trajectory);
  vl_trajectory_destroy(frames->rig);
}

/* ---- one after the other ----------------------------------------------------------------- */

uint32_t frames_count(const Frames *frames) {
  uint32_t poses = pattern_count(&frames->range);
  return frames->rig ? poses * frames->camera_count : poses;
}

/* Camera `which` of the rig, or the pose's own camera, at a pose. */
static Frame make_frame(const Frames *frames, uint32_t number, uint32_t which) {
  Frame frame = {.number = number, .camera = &frames->cameras[which]};
  frame.pose.time = VL_UNSET;
  if (!frames->trajectory)
    return frame;
  vl_trajectory_frame(frames->trajectory, frame.number, &frame.pose);
  if (!frames->rig)
    frame.camera = &frames->cameras[frame.pose.camera == VL_NO_CAMERA ? 0 : frame.pose.camera];
  return frame;
}

Frame frames_at(const Frames *frames, uint32_t index) {
  uint32_t cameras = frames->rig ? frames->camera_count : 1;
  return make_frame(frames, frames->range.first + index / cameras * frames->range.step,
                    index % cameras);
}

Frame frames_first(const Frames *frames) {
  return make_frame(frames, 0, 0);
}

uint32_t frames_before(const Frames *frames, const Frame *frame, Frame before[STEADY_BEFORE]) {
  uint32_t count = 0;
  for (uint32_t back = 1; back <= STEADY_BEFORE && back <= frame->number; back++) {
    const Frame earlier = make_frame(frames, frame->number - back, 0);
    if (earlier.camera->film == frame->camera->film)
      before[count++] = earlier;
  }
  return count;
}

bool frames_path(const Frames *frames, const Frame *frame, const char *pattern, int view,
                 char *path, size_t size) {
  if (!frames->trajectory && frames->views == 1)
    return snprintf(path, size, "%s", pattern) < (int)size;
  const PatternValues values = {frame->number, frame->pose.name, frame->camera->name,
                                frames->view_names[view]};
  return pattern_expand(pattern, &values, path, size);
}

bool frames_join(const Frames *frames, const char *pattern) {
  return frames->views == 2 && !pattern_has(pattern, 'v');
}

int frames_files(const Frames *frames, const char *pattern) {
  return frames_join(frames, pattern) ? 1 : frames->views;
}

bool frames_exist(const Frames *frames, const Frame *frame, const Outputs *outputs) {
  char path[4096];
  for (int i = 0; i < outputs->count; i++) {
    for (int view = 0; view < frames_files(frames, outputs->paths[i]); view++)
      if (!frames_path(frames, frame, outputs->paths[i], view, path, sizeof path) ||
          access(path, F_OK) != 0)
        return false;
  }
  return true;
}

/* Moves a camera whose pose is relative to the frame. */
static vlResult put_camera(const Frames *frames, const Frame *frame, const vlCamera *from,
                           vlCamera *camera, vlError *error) {
  double pose[16];
  *camera = *from;
  if (!frames->trajectory)
    return VL_OK;
  memcpy(pose, frame->pose.world_from_camera, sizeof pose);
  if (frames->rig)
    matrix_multiply(pose, frame->camera->mount, pose);
  matrix_multiply(pose, from->world_from_camera, pose);
  TRY_RESULT(vl_camera_move(from, pose, camera, error));
  if (!isnan(frame->pose.time)) {
    camera->shutter_open += frame->pose.time;
    camera->shutter_close += frame->pose.time;
  }
  return VL_OK;
}

vlResult frames_camera(const Frames *frames, const Frame *frame, int view, vlCamera *camera,
                       vlError *error) {
  return put_camera(frames, frame, &frame->camera->eyes[view], camera, error);
}

vlResult frames_middle(const Frames *frames, const Frame *frame, vlCamera *camera,
                       vlError *error) {
  return put_camera(frames, frame, &frame->camera->middle, camera, error);
}

/* ---- names ------------------------------------------------------------------------------- */

static int compare_paths(const void *a, const void *b) {
  return strcmp(*(char *const *)a, *(char *const *)b);
}

/* Checks all paths of one pattern. Two paths may be equal only if the trajectory repeats the
 * name. */
static int check_twice(const Frames *frames, const char *pattern) {
  uint32_t count = frames_count(frames);
  char **paths = calloc(count, sizeof *paths), path[4096];
  int status = paths ? -1 : report_no_memory();
  for (uint32_t i = 0; i < count && status < 0; i++) {
    Frame frame = frames_at(frames, i);
    if (!frames_path(frames, &frame, pattern, 0, path, sizeof path))
      status = report_failure(STATUS_IO, "frame %u: the file's name is too long", frame.number);
    else if (!(paths[i] = strdup(path)))
      status = report_no_memory();
  }
  if (status < 0)
    qsort(paths, count, sizeof *paths, compare_paths);
  for (uint32_t i = 1; i < count && status < 0; i++)
    if (strcmp(paths[i - 1], paths[i]) == 0)
      status = report_usage(
          "output \"%s\": two of the %u frames would be \"%s\"; %s", pattern, count, paths[i],
          frames->rig ? "put %d and %c into the name" : "put %d into the name");
  for (uint32_t i = 0; i < count && paths; i++)
    free(paths[i]);
  free(paths);
  return status;
}

/* Makes directories that contain pattern fields; other directories must exist. */
static int make_folder(char *path) {
  char *slash = strrchr(path, '/');
  if (!slash || slash == path)
    return -1;
  *slash = 0;
  int failed = mkdir(path, 0777) != 0 && errno != EEXIST ? errno : 0;
  int status = failed ? report_failure(STATUS_IO, "cannot make the folder %s: %s", path,
                                       strerror(failed))
                      : -1;
  *slash = '/';
  return status;
}

int frames_check_names(const Frames *frames, const Outputs *outputs) {
  char path[4096];
  if (frames->films && frames->views == 2 &&
      (pattern_check(frames->films->path) >= 0 || !pattern_has(frames->films->path, 'v')))
    return report_usage(
        "--film \"%s\": each eye has a film; put %%v (left, right) into the name",
        frames->films->path);
  for (int i = 0; i < outputs->count; i++) {
    const char *pattern = outputs->paths[i];
    if (frames->views == 2 && pattern_check(pattern) >= 0)
      return STATUS_USAGE;
    if (frames_join(frames, pattern) && !output_holds_layers(pattern))
      return report_usage(
          "output \"%s\": only .exr holds both eyes in one file; put %%v (left, right) into "
          "the name",
          pattern);
    if (frames_count(frames) > 1)
      TRY(check_twice(frames, pattern));
    bool folders = memchr(pattern, '%', (size_t)(text_file_name(pattern) - pattern));
    for (uint32_t k = 0; k < frames_count(frames) && folders; k++)
      for (int view = 0; view < frames_files(frames, pattern); view++) {
        Frame frame = frames_at(frames, k);
        if (!frames_path(frames, &frame, pattern, view, path, sizeof path))
          continue;
        TRY(make_folder(path));
      }
  }
  return -1;
}
