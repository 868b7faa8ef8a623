/* render/blend.c: see blend.h. */
#include "render/blend.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "cli/context.h"
#include "cli/macros.h"
#include "cli/report.h"
#include "cli/signals.h"
#include "cli/text.h"
#include "render/blend_child.h"
#include "render/job.h"
#include "render/noise.h"
#include "render/pattern.h"
#include "velo/pending.h"

enum { PATH_SIZE = 4096 };

/* The frames of a render. */
typedef struct BlendFrames {
  bool many; /* their numbers are in the names; else this is one image */
  bool given;
  FrameRange range;
} BlendFrames;

/* A render by Blender. */
typedef struct Blend {
  const Arguments *arguments;
  Arguments own; /* the command's, with the default output */
  char default_output[PATH_SIZE];
  vlContext *context;
  Blender blender;
  BlendFrames frames;
  FrameProgress shown;
  uint32_t written;
} Blend;

bool blend_wanted(const Arguments *arguments) {
  return arguments->operand_count && text_ends_with(arguments->operands[0], ".blend");
}

/* ---- the command line -------------------------------------------------------------------- */

/* Options that Blender's add-on, or velo here, follows. */
static const int followed[] = {
    RENDER_OUTPUT, RENDER_THREADS, RENDER_SPP,     RENDER_NOISE,       RENDER_RESOLUTION,
    RENDER_CROP,   RENDER_SEED,    RENDER_COLOR,   RENDER_MAX_DEPTH,   RENDER_CAMERA,
    RENDER_FRAME,  RENDER_FRAMES,  RENDER_HALF,    RENDER_TRANSPARENT, RENDER_SKIP_EXISTING,
    RENDER_QUIET,  RENDER_VERBOSE, RENDER_LOG_JSON};

static int check_options(const Arguments *arguments) {
  const OptionValue *v = arguments->values;
  const char *scene = arguments->operands[0];
  if (arguments->folder_count)
    return report_usage("%s: --sandbox starts no other program, and Blender reads .blend files",
                        scene);
  for (const Option *option = render_options; option->name; option++)
    if (v[option->id].given && !option_is_in(option->id, followed, LENGTH(followed)))
      return report_usage("%s: Blender renders it, and --%s cannot be passed on", scene,
                          option->name);
  TRY(options_exclude(arguments, RENDER_QUIET, RENDER_VERBOSE));
  if (v[RENDER_FRAME].given && !v[RENDER_CAMERA].given)
    return report_usage(
        "--frame NAME says which camera of --camera FILE; a frame of Blender's "
        "animation is --frames N");
  return noise_check(arguments);
}

/* Blender writes these. */
static bool is_written(const char *path) {
  return output_is_known(path) && !output_has_suffix(path, ".pfm");
}

static int check_output(const Blend *blend, const char *path) {
  if (output_is_stdout(path))
    return report_usage("output \"%s\": Blender does not write to the standard output", path);
  if (!is_written(path))
    return report_usage(
        "output \"%s\": of a .blend file there are .exr, .hdr, .png, .jpg, .tga", path);
  if (!blend->frames.many)
    return output_check(blend->context, path, VL_OUTPUT_PLAIN);
  TRY(pattern_check(path));
  if (!pattern_is_numbered(path))
    return report_usage(
        "output \"%s\": the names of several frames have their numbers alone, "
        "such as frame_%%04d.png",
        path);
  return -1;
}

/* FILE.png in the current folder. */
static void choose_output(Blend *blend) {
  const char *name = text_file_name(blend->arguments->operands[0]);
  text_set(blend->default_output, "%.*s.png", (int)(strlen(name) - strlen(".blend")), name);
  blend->own.texts[blend->own.text_count++] = blend->default_output;
}

static int take_frames(Blend *blend) {
  const OptionValue *frames = &blend->arguments->values[RENDER_FRAMES];
  BlendFrames *f = &blend->frames;
  f->given = frames->given;
  f->range.step = 1;
  if (frames->given)
    TRY(pattern_range(frames->text, &f->range));
  for (int i = 0; i < blend->own.text_count; i++)
    f->many |= strchr(blend->own.texts[i], '%') != NULL;
  if (f->many || !frames->given || f->range.first == f->range.last)
    return -1;
  return report_usage(
      "--frames %s are several images: give a name with the frame's number, "
      "such as -o frame_%%04d.png",
      frames->text);
}

static int prepare(Blend *blend) {
  TRY(check_options(blend->arguments));
  if (blend->own.text_count == 0)
    choose_output(blend);
  TRY(take_frames(blend));
  TRY(context_open_one(&blend->context));
  const char *scene = blend->arguments->operands[0];
  if (access(scene, R_OK) != 0)
    return report_failure(STATUS_MISSING, "%s: there is no such file that can be read", scene);
  if (vl_note_input(blend->context, scene, VL_OUTPUT_PLAIN) != VL_OK)
    return report_failure(STATUS_MISSING, "%s: it cannot be read", scene);
  for (int i = 0; i < blend->own.text_count; i++)
    TRY(check_output(blend, blend->own.texts[i]));
  return -1;
}

/* ---- the frames -------------------------------------------------------------------------- */

/* The file of output i of a frame. False: its name is too long. */
static bool frame_path(const Blend *blend, int i, uint32_t frame, char *path) {
  const PatternValues values = {.number = frame};
  if (blend->frames.many)
    return pattern_expand(blend->own.texts[i], &values, path, PATH_SIZE);
  return snprintf(path, PATH_SIZE, "%s", blend->own.texts[i]) < PATH_SIZE;
}

/* Whether all files of a frame are there, with --skip-existing. */
static bool is_there(const Blend *blend, uint32_t frame) {
  char path[PATH_SIZE];
  if (!blend->arguments->values[RENDER_SKIP_EXISTING].given)
    return false;
  for (int i = 0; i < blend->own.text_count; i++)
    if (!frame_path(blend, i, frame, path) || access(path, F_OK) != 0)
      return false;
  return true;
}

static int commit(vlPendingFile *const *pending, int count) {
  vlError error = {0};
  for (int i = 0; i < count; i++)
    TRY(report_error(&error, vl_pending_file_commit(pending[i], &error), NULL));
  return -1;
}

static int render_frame(Blend *blend, uint32_t frame) {
  vlPendingFile *pending[MAX_TEXTS] = {NULL};
  const char *paths[MAX_TEXTS];
  const int count = blend->own.text_count;
  const bool numbered = blend->frames.many || blend->frames.given;
  int status = -1;
  blend->blender.number = frame;
  for (int i = 0; i < count && status < 0; i++) {
    char path[PATH_SIZE];
    vlError error = {0};
    if (!frame_path(blend, i, frame, path))
      status =
          report_failure(STATUS_IO, "%s: the file's name is too long", blend->own.texts[i]);
    else if (vl_pending_file_create(blend->context, path, &pending[i], &error) != VL_OK)
      status = report_failure(STATUS_IO, "%s: %s", path, error.message);
    else
      paths[i] = vl_pending_file_path(pending[i]);
  }
  if (status < 0)
    status = blender_frame(&blend->blender, numbered ? &frame : NULL, paths, count);
  if (status < 0)
    status = commit(pending, count);
  for (int i = 0; i < count; i++)
    vl_pending_file_destroy(pending[i]);
  blend->written += status < 0;
  blend->shown.done++;
  return status;
}

static int render_frames(Blend *blend) {
  BlendFrames *f = &blend->frames;
  const Blender *b = &blend->blender;
  const uint32_t end = b->last > 0 ? (uint32_t)b->last : 0;
  if (!f->given)
    f->range.first = f->many && b->first > 0 ? (uint32_t)b->first : 0;
  if (!f->many) /* without --frames it is the file's own frame, whatever its number */
    f->range.last = f->range.first;
  else if (!f->given || f->range.last == UINT32_MAX)
    f->range.last = end;
  if (f->range.last < f->range.first)
    return report_usage("--frames: the scene's last frame is %u", end);
  blend->shown = progress_frames(pattern_count(&f->range));
  blend->blender.shown = &blend->shown;
  int status = -1;
  for (uint32_t k = 0; k < blend->shown.count && status < 0; k++) {
    const uint32_t frame = f->range.first + k * f->range.step;
    if (is_there(blend, frame))
      blend->shown.done++;
    else
      status = render_frame(blend, frame);
  }
  return status;
}

/* ---- the end ----------------------------------------------------------------------------- */

static void report_made(const Blend *blend) {
  const Blender *b = &blend->blender;
  const double seconds = monotonic_seconds() - blend->shown.start;
  const char *name = blend->own.texts[0];
  if (report_is_json()) {
    Json *json = report_json_begin("result");
    json_put(json, "status %d, frames %u, written %u, spp %lld, seconds %g", STATUS_OK,
             blend->shown.count, blend->written, (long long)b->spp, seconds);
    report_json_end(json);
    return;
  }
  if (!blend->written)
    report_note("nothing to render: %s is there", name);
  else
    report_note("%u of %u images of %ld x %ld in %s, %ld spp at most; wrote %s%s",
                blend->written, blend->shown.count, b->width, b->height,
                format_seconds(seconds).text, b->spp, name,
                blend->own.text_count > 1 ? ", ..." : "");
}

int blend_run(const Arguments *arguments) {
  Blend blend = {.arguments = arguments, .own = *arguments, .blender = {.events = -1}};
  int status = prepare(&blend);
  signals_remember();
  if (status < 0)
    status = blender_open(&blend.blender, arguments->operands[0], &blend.own);
  if (status < 0) {
    report_note("%s is rendered by Blender %s (%s) with velo's add-on", arguments->operands[0],
                blend.blender.version, blend.blender.program);
    status = render_frames(&blend);
  }
  report_status_line(NULL);
  blender_close(&blend.blender);
  context_close(blend.context);
  if (status < 0)
    report_made(&blend);
  if (status >= 128)
    report_note("interrupted; %u of %u images were written", blend.written, blend.shown.count);
  return status < 0 ? STATUS_OK : status;
}
