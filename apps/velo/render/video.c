/* render/video.c: see video.h. */
#include "render/video.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/context.h"
#include "cli/macros.h"
#include "cli/report.h"
#include "cli/signals.h"
#include "cli/text.h"
#include "render/child.h"
#include "render/ffmpeg.h"
#include "render/job.h"
#include "render/pattern.h"
#include "velo/pending.h"

enum { PATH_SIZE = 4096, MAX_NAME = 255 };

static bool is_mp4(const char *path) {
  return output_has_suffix(path, ".mp4");
}

static bool is_video(const char *path) {
  return is_mp4(path) || output_has_suffix(path, ".gif");
}

bool videos_wanted(const Arguments *arguments) {
  for (int i = 0; i < arguments->text_count; i++)
    if (is_video(arguments->texts[i]))
      return true;
  return false;
}

/* ---- the command line -------------------------------------------------------------------- */

static int check_options(const Videos *videos, const Arguments *arguments) {
  static const struct {
    int id;
    const char *why;
  } others[] = {
      {RENDER_SANDBOX, "--sandbox starts no other program, and ffmpeg makes the video"},
      {RENDER_SHARD, "a part of the frames is no video"},
      {RENDER_STEREO, "a video is of one eye"},
      {RENDER_RIG, "a video is of one camera"},
      {RENDER_TRANSPARENT, "a video holds no alpha"},
      {RENDER_FILM, "--film is of one image"},
      {RENDER_CONTINUE, "--continue is of one image"}};
  const OptionValue *v = arguments->values;
  const char *path = videos->paths[0];
  if (!v[RENDER_ANIMATE].given && !v[RENDER_TURNTABLE].given && !v[RENDER_TRAJECTORY].given)
    return report_usage(
        "output \"%s\": a video goes with --animate, --turntable or --trajectory", path);
  for (size_t i = 0; i < LENGTH(others); i++)
    if (v[others[i].id].given || (others[i].id == RENDER_SANDBOX && arguments->folder_count))
      return report_usage("output \"%s\": %s; render the frames: -o %s", path, others[i].why,
                          videos->frames);
  return -1;
}

static int check_video(const Videos *videos, int i) {
  enum { MAX_GIF = 50 }; /* viewers show shorter times than .02 s as .1 s */
  const char *path = videos->paths[i];
  if (strchr(path, '%'))
    return report_usage("output \"%s\": a video is one file, its name has no %%", path);
  if (output_is_stdout(path))
    return report_usage(
        "output \"%s\": a video is not written to the standard output; a file of that name is "
        "./%s",
        path, path);
  if (!is_mp4(path) && videos->fps > MAX_GIF)
    return report_usage("output \"%s\": a .gif has at most %d frames per second (--fps)", path,
                        MAX_GIF);
  TRY(output_check(NULL, path, VL_OUTPUT_PLAIN));
  vl_remove_leftovers(path);
  for (int k = 0; k < i; k++)
    if (output_is_same(videos->paths[k], path))
      return report_usage("the outputs %s and %s are the same file", videos->paths[k], path);
  return -1;
}

/* Whether frames of these names can be found by their numbers. */
static bool is_frames(const char *path) {
  return output_has_suffix(path, ".png") && pattern_is_numbered(path);
}

/* NAME_%04d.png, with .part if velo removes the frames. */
static bool name_frames(Videos *videos, const char *part) {
  const char *path = videos->paths[0];
  const int stem = (int)(output_dot(path) - path);
  const size_t max_length = MAX_NAME - strlen(".part_1000000.part.png");
  return text_set(videos->frames, "%.*s%s_%%04d.png", stem, path, part) <
             (int)sizeof videos->frames &&
         (size_t)(path + stem - text_file_name(path)) <= max_length;
}

int videos_plan(Videos *videos, const Arguments *arguments, Arguments *frames) {
  char program[PATH_SIZE];
  const OptionValue *fps = &arguments->values[RENDER_FPS];
  *videos = (Videos){.fps = fps->given ? fps->number : 24, .programs = getenv("PATH")};
  *frames = *arguments;
  frames->text_count = 0;
  const char *named = NULL;
  for (int i = 0; i < arguments->text_count; i++) {
    const char *path = arguments->texts[i];
    if (is_video(path)) {
      videos->paths[videos->count++] = path;
      continue;
    }
    if (!named && is_frames(path))
      named = path;
    frames->texts[frames->text_count++] = path;
  }
  const bool fits = name_frames(videos, "");
  TRY(check_options(videos, arguments));
  for (int i = 0; i < videos->count; i++)
    TRY(check_video(videos, i));
  if (!fits)
    return report_failure(STATUS_IO, "%s: the file's name is too long", videos->paths[0]);
  if (!child_find(videos->programs, "ffmpeg", program, sizeof program))
    return report_failure(STATUS_MISSING,
                          "output \"%s\": ffmpeg is not installed, and it makes the video; "
                          "render the frames: -o %s",
                          videos->paths[0], videos->frames);
  videos->own_frames = !named;
  if (named)
    text_set(videos->frames, "%s", named);
  else if (!name_frames(videos, ".part"))
    return report_failure(STATUS_IO, "%s: the file's name is too long", videos->paths[0]);
  if (!named)
    frames->texts[frames->text_count++] = videos->frames;
  return -1;
}

void videos_range(Videos *videos, const FrameRange *range) {
  videos->shown = progress_frames(pattern_count(range));
  videos->range = *range;
  videos->number = range->first;
  videos->ranged = true;
}

/* ---- the videos -------------------------------------------------------------------------- */

static bool frame_path(void *user, uint32_t i, char *path, size_t size) {
  const Videos *videos = user;
  const PatternValues values = {.number = videos->range.first + i * videos->range.step};
  return pattern_expand(videos->frames, &values, path, size);
}

static void report_made(const Videos *videos, const char *path, uint32_t width,
                        uint32_t height) {
  const uint32_t count = videos->shown.count;
  if (report_is_json()) {
    Json *json = report_json_begin("video");
    json_put(json, "file %s, frames %u, fps %g, width %u, height %u", path, count, videos->fps,
             width, height);
    report_json_end(json);
    return;
  }
  report_note("%u frames of %u x %u in %s; wrote %s, %.5g s at %.5g frames per second", count,
              width, height, format_seconds(monotonic_seconds() - videos->shown.start).text,
              path, count / videos->fps, videos->fps);
}

static int make_one(Videos *videos, vlContext *context, const char *program, const char *path) {
  VideoSource source = {.program = program,
                        .fps = videos->fps,
                        .count = videos->shown.count,
                        .frame = frame_path,
                        .user = videos,
                        .name = path};
  vlPendingFile *pending = NULL;
  vlError error = {0};
  char wrong[600];
  uint32_t width = 0, height = 0;
  TRY(report_error(&error, vl_pending_file_create(context, path, &pending, &error), path));
  int status = STATUS_OK;
  const bool made =
      ffmpeg_make(&source, is_mp4(path) ? VIDEO_MP4 : VIDEO_GIF, vl_pending_file_path(pending),
                  &width, &height, wrong, sizeof wrong);
  if (made && vl_pending_file_commit(pending, &error) != VL_OK)
    text_set(wrong, "%s", error.message);
  vl_pending_file_destroy(pending);
  if (wrong[0])
    status = report_failure(STATUS_IO, "%s is not written: %s; the frames are in %s", path,
                            wrong, videos->frames);
  else if (made)
    report_made(videos, path, width, height);
  else
    status = signals_status();
  return status;
}

static void remove_frames(const Videos *videos) {
  char path[PATH_SIZE];
  for (uint32_t i = 0; i < videos->shown.count; i++)
    if (frame_path((void *)videos, i, path, sizeof path))
      unlink(path);
}

/* Whether a frame is there. */
static bool has_frames(Videos *videos) {
  char path[PATH_SIZE];
  for (uint32_t i = 0; i < videos->shown.count && videos->ranged; i++)
    if (frame_path(videos, i, path, sizeof path) && access(path, F_OK) == 0)
      return true;
  return false;
}

int videos_finish(Videos *videos, const Arguments *arguments, int status) {
  char program[PATH_SIZE];
  report_status_line(NULL);
  if (arguments->values[RENDER_DRY_RUN].given)
    return status;
  vlContext *context = NULL;
  signals_remember(); /* where all frames were there, nothing was rendered */
  if (status == STATUS_OK && signals_pending())
    status = signals_status();
  const bool rendered = status == STATUS_OK;
  if (rendered && (!child_find(videos->programs, "ffmpeg", program, sizeof program) ||
                   context_open_one(&context) >= 0))
    status = report_failure(STATUS_IO,
                            "%s is not written: ffmpeg cannot be started; the frames are in %s",
                            videos->paths[0], videos->frames);
  for (int i = 0; i < videos->count && status == STATUS_OK; i++)
    status = make_one(videos, context, program, videos->paths[i]);
  context_close(context);
  if (status == STATUS_OK && videos->own_frames)
    remove_frames(videos);
  if (status >= 128 || (status != STATUS_OK && !rendered && has_frames(videos)))
    report_note(
        "%s is not written; the frames so far are in %s, and the same command with "
        "--skip-existing goes on",
        videos->paths[0], videos->frames);
  return status;
}
