/* render/render.c: `velo render`: load → build → make → render → develop → write. The first pass is written at once,
 * later ones now and then, so that there is a picture to look at; a signal stops the render and keeps its whole passes.
 */
#include <stdio.h>
#include <string.h>

#include "cli/commands.h"
#include "cli/report.h"
#include "cli/signals.h"
#include "render/attributes.h"
#include "render/channels.h"
#include "render/exposure.h"
#include "render/frames.h"
#include "render/job.h"
#include "render/lens_options.h"
#include "render/outputs.h"
#include "render/progress.h"
#include "render/scene_options.h"

/* Seconds between two progress pictures; and they may take at most a twentieth of the time. */
enum { WRITE_EVERY = 10, WRITE_SHARE = 20 };

typedef struct Render {
  vlContext *context;
  vlScene *scene;
  vlWorld *world;
  vlFilm *film;
  Job job;
  Outputs outputs;
  char default_output[600];
  Progress progress;
  uint32_t written_spp; /* of the progress pictures */
  bool written_whole;   /* all of them */
  bool write_failed;    /* said once */
  double last_write, write_cost;
  Channels channels; /* of ground truth */
  Frames frames;     /* of a trajectory, a rig, two eyes */
  bool many;         /* there are such */
} Render;

/* ---- files ------------------------------------------------------------------------------------------------------- */

static int write_picture(Render *render, bool progress) {
  vlDevelopDef develop = vl_default_develop_def();
  develop.exposure = render->job.defs->develop.exposure;
  vlImage *image = NULL;
  uint32_t spp = vl_film_spp(render->film);
  vlResult result = vl_film_develop(render->film, &develop, &image);
  if (result == VL_OK) result = attributes_set(image, &render->job, spp);
  if (result == VL_OK) result = channels_describe(&render->channels, image);
  int status = result == VL_OK ? outputs_write(render->context, &render->outputs, image, progress)
                               : report_error(NULL, result, NULL);
  vl_image_destroy(image);
  render->written_spp = spp;
  render->written_whole = status == STATUS_OK;
  return status;
}

static void write_progress_picture(Render *render, const vlProgress *now) {
  double start = monotonic_seconds(), wait = WRITE_SHARE * render->write_cost;
  if (now->spp_done >= now->spp_total || render->write_failed) return;
  if (render->written_spp && start - render->last_write < (wait > WRITE_EVERY ? wait : WRITE_EVERY)) return;
  if (write_picture(render, true) != STATUS_OK) render->write_failed = true;
  render->last_write = monotonic_seconds();
  render->write_cost = render->last_write - start;
}

static bool on_progress(void *user, const vlProgress *now) {
  Render *render = user;
  progress_show(&render->progress, now);
  if (now->pass_done && !signals_pending()) write_progress_picture(render, now);
  return !signals_pending();
}

/* Without -o: the last part of the name that the scene asks for, else the scene's own name with .exr; in the current
 * folder either way, since a scene may come from anywhere. */
static void choose_output(Render *render, const char *scene_path, const char *asked) {
  bool eight_bit;
  const char *slash = strrchr(asked, '/');
  if (slash) asked = slash + 1;
  if (output_suffix(asked, &eight_bit)) {
    snprintf(render->default_output, sizeof render->default_output, "%s", asked);
  } else {
    slash = strrchr(scene_path, '/');
    const char *name = slash ? slash + 1 : scene_path, *end = strstr(name, ".pbrt");
    if (!end) end = strrchr(name, '.');
    int length = end && end > name ? (int)(end - name) : (int)strlen(name);
    snprintf(render->default_output, sizeof render->default_output, "%.*s.exr", length > 500 ? 500 : length, name);
  }
  render->outputs.paths[0] = render->default_output;
  render->outputs.count = 1;
}

/* ---- ground truth ------------------------------------------------------------------------------------------------ */

static void warn_of_channels(const Render *render) {
  const Channels *c = &render->channels;
  for (int i = 0; i < render->outputs.count && channels_any(c); i++)
    if (!output_holds_layers(render->outputs.paths[i]))
      report_warning("%s: %s cannot hold %s, only .exr can",
                     c->bits      ? "--channels"
                     : c->gbuffer ? "gbuffer"
                                  : "spectrum",
                     render->outputs.paths[i], c->bits ? "them" : "it");
}

static bool has_layers(const Render *render) {
  for (int i = 0; i < render->outputs.count && channels_any(&render->channels); i++)
    if (output_holds_layers(render->outputs.paths[i])) return true;
  return false;
}

static int render_channels(Render *render) {
  if (!has_layers(render)) return STATUS_OK;
  Channels *channels = &render->channels;
  int status = channels_render(channels, render->context, render->world, &render->job, render->film);
  for (int k = 0; k < CHANNEL_LAYERS; k++) render->outputs.layers[k] = channels->layers[k];
  for (int i = 0; i < render->outputs.count && status == STATUS_OK; i++)
    if (channels->bits && output_holds_layers(render->outputs.paths[i]))
      status = channels_write_ids(channels, NULL, render->world, render->outputs.paths[i]);
  return status;
}

/* ---- steps: each returns -1 to go on, else the exit code --------------------------------------------------------- */

static int prepare(Render *render, const Arguments *arguments) {
  const OptionValue *v = arguments->values;
  report_setup(v[RENDER_LOG_JSON].given, v[RENDER_QUIET].given     ? REPORT_QUIET
                                         : v[RENDER_VERBOSE].given ? REPORT_VERBOSE
                                                                   : REPORT_NORMAL);
  if (v[RENDER_QUIET].given && v[RENDER_VERBOSE].given) return report_usage("--quiet and --verbose exclude each other");
  Outputs *outputs = &render->outputs;
  for (int i = 0; i < arguments->text_count; i++) outputs->paths[i] = arguments->texts[i];
  outputs->count = arguments->text_count;
  outputs->half = v[RENDER_HALF].given;
  outputs->view = v[RENDER_VIEW].given ? (vlView)v[RENDER_VIEW].integer : VL_VIEW_STANDARD;
  int status = exposure_parse(&v[RENDER_EXPOSURE], &outputs->exposure, &outputs->meter);
  if (status < 0) status = channels_choose(&render->channels, arguments);
  if (status < 0) status = outputs_check_names(outputs);
  if (status < 0) status = frames_check(arguments, outputs);
  if (status < 0) status = outputs_check_folders(outputs);
  if (status >= 0) return status;

  vlContextDef def = vl_default_context_def();
  def.log = report_log;
  if (v[RENDER_THREADS].given) def.threads = (uint32_t)v[RENDER_THREADS].integer;
  if (v[RENDER_ISA].given) def.isa = (vlIsa)v[RENDER_ISA].integer;
  vlResult result = vl_context_create(&def, &render->context);
  if (result == VL_ERROR_UNSUPPORTED && v[RENDER_ISA].given)
    return report_usage("--isa %s: this machine does not have it", v[RENDER_ISA].text);
  if (result == VL_ERROR_UNSUPPORTED || result == VL_ERROR_ARGUMENT)
    return report_usage("the environment variable VELO_ISA must be v2, v3 or v4, and the machine must have it");
  return result == VL_OK ? -1 : report_error(NULL, result, NULL);
}

static int load_and_build(Render *render, const char *path, const Arguments *arguments) {
  double start = monotonic_seconds();
  vlError error = {0};
  bool lamps = false;
  int status = scene_open(render->context, path, arguments, &render->scene, &lamps);
  if (status >= 0) return status;
  if (lamps && !arguments->values[RENDER_EXPOSURE].given) render->outputs.meter = true;
  double loaded = monotonic_seconds();

  status = job_make(&render->job, render->context, render->scene, path, arguments);
  if (status >= 0) return status;
  if (render->outputs.count == 0) {
    choose_output(render, path, render->job.defs->output);
    status = outputs_check_folders(&render->outputs);
    if (status >= 0) return status;
  }
  channels_take(&render->channels, &render->job);
  warn_of_channels(render);
  status = channels_load(&render->channels, render->context, &render->job);
  if (status >= 0) return status;
  render->job.defs->film.errors =
      (render->channels.bits & VL_CHANNEL_ERROR || render->channels.gbuffer) && has_layers(render);
  render->many = frames_wanted(arguments, &render->job);
  if (render->many) {
    status = frames_load(&render->frames, render->context, &render->job, arguments);
    if (status < 0) status = frames_check_names(&render->frames, &render->outputs);
    if (status >= 0) return status;
  }
  vlResult result = vl_world_build_last(render->scene, &render->job.defs->build, &render->world, &error);
  if (result != VL_OK) return report_error(&error, result, path);
  if (arguments->values[RENDER_VERBOSE].given) {
    size_t peak;
    char bytes[32];
    vl_context_memory(render->context, &peak);
    format_count(bytes, sizeof bytes, (double)peak);
    report_note("loaded in %.3f s, built in %.3f s, %sB at most; %u threads, x86-64-v%d", loaded - start,
                monotonic_seconds() - loaded, bytes, vl_context_threads(render->context),
                (int)vl_context_isa(render->context));
  }
  return -1;
}

static void report_not_finite(const vlRenderStats *stats) {
  if (stats->not_finite)
    report_warning("%llu samples were not finite or negative and were left out; the first one at pixel %u, %u",
                   (unsigned long long)stats->not_finite, stats->worst_x, stats->worst_y);
}

static void report_result(const Render *render, const vlRenderStats *stats, int status) {
  const Outputs *outputs = &render->outputs;
  uint64_t rays = stats->camera_rays + stats->bounce_rays + stats->shadow_rays;
  uint32_t spp = vl_film_spp(render->film);
  if (report_is_json()) {
    Json json = report_json_begin("result");
    json_integer(&json, "status", status);
    json_integer(&json, "spp", spp);
    json_number(&json, "seconds", stats->seconds);
    json_integer(&json, "paths", (int64_t)stats->paths);
    json_integer(&json, "camera_rays", (int64_t)stats->camera_rays);
    json_integer(&json, "bounce_rays", (int64_t)stats->bounce_rays);
    json_integer(&json, "shadow_rays", (int64_t)stats->shadow_rays);
    json_integer(&json, "not_finite", (int64_t)stats->not_finite);
    json_begin(&json, "files", '[');
    for (int i = 0; i < outputs->count && spp; i++) json_text(&json, NULL, outputs->paths[i]);
    json_end(&json, ']');
    report_json_end(&json);
    return;
  }
  char time[32], speed[32], ray_count[32], files[1200] = "";
  format_seconds(time, sizeof time, stats->seconds);
  format_count(speed, sizeof speed, stats->seconds > 0 ? (double)stats->paths / stats->seconds : 0);
  format_count(ray_count, sizeof ray_count, (double)rays);
  for (int i = 0; i < outputs->count; i++) {
    size_t n = strlen(files);
    snprintf(files + n, sizeof files - n, "%s%s", i ? ", " : "", outputs->paths[i]);
  }
  report_note("%u spp in %s, %s paths/s, %s rays; wrote %s", spp, time, speed, ray_count, files);
}

static int render_and_write(Render *render) {
  Job *job = &render->job;
  vlError error = {0};
  vlRenderStats stats = {0};
  vlResult result = vl_film_create(render->context, &job->defs->film, &render->film);
  if (result != VL_OK) return report_error(NULL, result, job->path);
  progress_start(&render->progress, job->defs->render.time_limit);
  job->defs->render.progress = on_progress;
  job->defs->render.progress_user = render;
  signals_remember();
  result = vl_render(render->world, &job->camera, render->film, &job->defs->render, &stats, &error);
  report_status_line(NULL);
  report_not_finite(&stats);
  if (result != VL_OK && result != VL_CANCELLED) return report_error(&error, result, job->path);

  uint32_t spp = vl_film_spp(render->film);
  int status = STATUS_OK;
  if (spp) status = render_channels(render);
  if (spp && status == STATUS_OK && (!(render->written_whole && render->written_spp == spp) || has_layers(render)))
    status = write_picture(render, false);
  int number = signals_pending();
  if (number && !spp) {
    report_failure(128 + number, "interrupted before the first pass was done; nothing is written");
    return 128 + number;
  }
  if (number && status == STATUS_OK) {
    if (spp < job->defs->render.spp) report_note("interrupted after %u of %u spp", spp, job->defs->render.spp);
    status = 128 + number;
  }
  if (status == STATUS_OK || status > 128) report_result(render, &stats, status);
  return status;
}

static int run_render(const Command *command, const Arguments *arguments) {
  (void)command;
  Render render;
  memset(&render, 0, sizeof render);
  int status = prepare(&render, arguments);
  if (status < 0) status = load_and_build(&render, arguments->operands[0], arguments);
  if (status < 0 && !render.many) status = lens_autofocus(&render.job, render.scene, render.world);
  if (status < 0 && arguments->values[RENDER_DRY_RUN].given) {
    job_describe(&render.job, render.context, render.scene, render.world, render.outputs.paths, render.outputs.count);
    if (render.many && frames_count(&render.frames) > 1)
      report_note("%u frames%s", frames_count(&render.frames), render.frames.views == 2 ? ", two eyes each" : "");
    status = STATUS_OK;
  }
  if (status < 0 && render.many)
    status = frames_render(&render.frames, render.context, render.world, &render.outputs, &render.channels);
  if (status < 0) status = render_and_write(&render);
  frames_free(&render.frames);
  channels_free(&render.channels);
  vl_film_destroy(render.film);
  vl_world_destroy(render.world);
  vl_scene_destroy(render.scene);
  vl_context_destroy(render.context);
  return status;
}

const Command render_command = {
    .name = "render",
    .usage = "FILE [options]",
    .summary = "render a scene file (.pbrt, .gltf, .glb, .obj, .ply) into pictures",
    .text =
        "Renders FILE. Options override what the file says. After the first pass, and then every ten\n"
        "seconds or so, the pictures are written as they are; Ctrl-C writes the whole passes that are done.",
    .options = render_options,
    .min_operands = 1,
    .max_operands = 1,
    .run = run_render,
};
