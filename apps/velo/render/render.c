/* render/render.c: `velo render`: load, build, make, render, develop, write. The first pass is written at once and
 * later ones at intervals, so that there is a progress image. A signal stops the render and keeps its whole passes.
 * Only a render that reached its samples or its time replaces an earlier image (outputs.h). */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/commands.h"
#include "cli/context.h"
#include "cli/report.h"
#include "cli/signals.h"
#include "render/again.h"
#include "render/animate.h"
#include "render/attributes.h"
#include "render/channels.h"
#include "render/continue.h"
#include "render/denoised.h"
#include "render/exposure.h"
#include "render/film_keeper.h"
#include "render/frames.h"
#include "render/job.h"
#include "render/lens_options.h"
#include "render/memory.h"
#include "render/noise.h"
#include "render/outputs.h"
#include "render/progress.h"
#include "render/scene_options.h"
#include "render/shard.h"

/* Seconds between two progress images. Writing them takes at most 1 / WRITE_SHARE of the time. */
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
  uint32_t begun_spp;            /* samples per pixel of a film that is continued */
  uint32_t written_spp;          /* samples per pixel of the last progress image */
  bool part_named;               /* the paths of the NAME.part.EXT files were reported */
  double last_write, write_cost; /* seconds: when, and for how long, a progress image was written */
  double first_pass;             /* seconds of the first pass, one sample; 0: not done */
  double start, render_start;    /* start of the command, start of the first pass; seconds */
  double time_limit;             /* --time, seconds; 0: none */
  Channels channels;             /* of the ground truth */
  Frames frames;                 /* of a trajectory, a rig or two eyes */
  MemoryPlan memory;
  Denoised denoised;
  bool many; /* whether `frames` is used */
  SceneOpening opening;
  Again again;
  Continue resumed;
  FilmKeeper keeper;
  FilmPlan film_plan;
  ReceiptPlan receipt;
} Render;

/* ---- files ------------------------------------------------------------------------------------------------------- */

static int write_image(Render *render, OutputStage stage) {
  vlDevelopDef develop = vl_default_develop_def();
  develop.exposure = render->job.defs->develop.exposure;
  vlImage *image = NULL;
  uint32_t spp = vl_film_spp(render->film);
  vlResult result = vl_film_develop(render->film, &develop, &image);
  if (result == VL_OK) result = attributes_set(image, &render->job, spp);
  const ReceiptImage which = {.samples = spp};
  if (result == VL_OK) result = receipt_set(render->context, &render->job, &which, image);
  if (result == VL_OK) result = channels_describe(&render->channels, image);
  int status = STATUS_OK;
  if (result == VL_OK)
    status = outputs_write(render->context, &render->outputs, image, spp, stage);
  else if (stage == OUTPUT_PROGRESS)
    report_warning("progress image: %s", vl_result_name(result));
  else
    status = report_reason(result, render->outputs.paths[0], "the image and its header cannot be made");
  vl_image_destroy(image);
  return status;
}

static bool has_layers(const Render *render) {
  for (int i = 0; i < render->outputs.count && channels_any(&render->channels); i++)
    if (output_holds_layers(render->outputs.paths[i])) return true;
  return false;
}

/* Formats the list of files: "a.exr, b.png". */
static void list_files(const Render *render, OutputStage stage, char *text, size_t size) {
  char part[5000];
  text[0] = 0;
  for (int i = 0; i < render->outputs.count; i++) {
    size_t n = strlen(text);
    snprintf(text + n, size - n, "%s%s", i ? ", " : "", output_written(&render->outputs, i, stage, part, sizeof part));
  }
  if (render->denoised.outputs.count && stage != OUTPUT_PROGRESS) {
    size_t n = strlen(text);
    snprintf(text + n, size - n, ", %s", output_written(&render->denoised.outputs, 0, stage, part, sizeof part));
  }
}

/* Reported once, when the render outlasts its first progress images. */
static void name_parts(Render *render, const vlProgress *now) {
  char files[1200];
  if (render->part_named || now->remaining < WRITE_EVERY) return;
  render->part_named = true;
  list_files(render, OUTPUT_PROGRESS, files, sizeof files);
  report_note("the image so far is in %s", files);
}

static uint64_t image_pixels(const Render *render) {
  const uint32_t *crop = render->job.defs->film.crop;
  return (uint64_t)(crop[2] - crop[0]) * (crop[3] - crop[1]);
}

/* Returns the smallest number of samples per pixel that suffices for every output. A denoiser needs more samples, for
 * its standard errors. */
static uint32_t least_samples(const Render *render) {
  return render->denoised.outputs.count ? 2 : 1;
}

/* Estimated seconds between the last pass and the end of the command. */
static double finish_seconds(const Render *render) {
  const vlFilmDef *film = &render->job.defs->film;
  uint32_t spp = vl_film_spp(render->film);
  double seconds = render->write_cost + film_keeper_seconds(&render->keeper, vl_film_memory(film));
  if (has_layers(render))
    seconds += channels_seconds(&render->channels, film->buckets, spp, render->first_pass, render->write_cost);
  if (render->denoised.outputs.count)
    seconds += denoised_seconds(image_pixels(render), spp, render->first_pass, render->write_cost,
                                vl_context_threads(render->context));
  return seconds;
}

/* Sets the render's time limit so that the whole command ends after --time. */
static void limit_time(Render *render) {
  if (!(render->time_limit > 0)) return;
  double left = render->time_limit - (render->render_start - render->start) - finish_seconds(render);
  render->job.defs->render.time_limit = left > 1e-3 ? left : 1e-3;
  if (vl_film_spp(render->film) < least_samples(render)) render->job.defs->render.time_limit = 0;
}

static void write_progress_image(Render *render, const vlProgress *now) {
  if (render->outputs.count == 0) return;
  double start = monotonic_seconds(), wait = WRITE_SHARE * render->write_cost;
  bool ends = now->spp_done >= now->spp_total || now->remaining <= 2 * render->write_cost;
  if (ends && render->time_limit > 0) return; /* the final image follows soon */
  if (now->spp_done >= now->spp_total) return;
  if (render->written_spp && start - render->last_write < (wait > WRITE_EVERY ? wait : WRITE_EVERY)) return;
  write_image(render, OUTPUT_PROGRESS);
  name_parts(render, now);
  render->written_spp = vl_film_spp(render->film);
  render->last_write = monotonic_seconds();
  render->write_cost = render->last_write - start;
}

static void write_checkpoint(Render *render, const vlProgress *now) {
  if (now->spp_done < now->spp_total) film_keeper_checkpoint(&render->keeper, render->film);
}

static bool on_progress(void *user, const vlProgress *now) {
  Render *render = user;
  progress_show(&render->progress, now);
  if (now->pass_done && !signals_pending()) {
    if (!(render->first_pass > 0)) render->first_pass = now->elapsed;
    write_checkpoint(render, now);
    write_progress_image(render, now);
    limit_time(render);
  }
  return !signals_pending();
}

/* A model becomes a .png, unless something is asked for that only .exr holds. */
static const char *default_suffix(const Render *render, const Arguments *arguments) {
  const OptionValue *v = arguments->values;
  bool exr = v[RENDER_CHANNELS].given || v[RENDER_SPECTRUM].given || v[RENDER_HALF].given || v[RENDER_STEREO].given;
  return render->opening.model && !exr ? ".png" : ".exr";
}

/* The default output name: the last component of the name that the scene gives, otherwise the scene's name with the
 * suffix. It is in the current directory, since scenes may be untrusted. */
static void choose_output(Render *render, const char *scene_path, const char *asked, const char *suffix) {
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
    snprintf(render->default_output, sizeof render->default_output, "%.*s%s", length > 500 ? 500 : length, name,
             suffix);
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

static void warn_of_alpha(const Render *render) {
  for (int i = 0; i < render->outputs.count && render->outputs.transparent; i++)
    if (!output_holds_alpha(render->outputs.paths[i]))
      report_warning("--transparent: %s cannot hold alpha, only .png and .exr can", render->outputs.paths[i]);
}

static int render_channels(Render *render) {
  if (!has_layers(render)) return STATUS_OK;
  Channels *channels = &render->channels;
  int status = channels_render(channels, render->context, render->world, &render->job, render->film);
  for (int k = 0; k < CHANNEL_LAYERS; k++) render->outputs.layers[k] = channels->layers[k];
  return status;
}

/* ---- steps: each returns -1 to go on, else the exit code --------------------------------------------------------- */

static void set_up_reports(const Arguments *arguments) {
  const OptionValue *v = arguments->values;
  report_setup(v[RENDER_LOG_JSON].given, v[RENDER_QUIET].given     ? REPORT_QUIET
                                         : v[RENDER_VERBOSE].given ? REPORT_VERBOSE
                                                                   : REPORT_NORMAL);
}

/* Whether a file of this render holds a receipt: a film, or an .exr. Without -o the name of the image is known only
 * when the scene is loaded. */
static bool writes_receipt(const Render *render, const Arguments *arguments) {
  const Outputs *outputs = &render->outputs;
  if (arguments->values[RENDER_DRY_RUN].given) return false;
  if (render->film_plan.path) return true;
  if (arguments->values[RENDER_NO_RECEIPT].given) return false;
  for (int i = 0; i < outputs->count; i++)
    if (output_holds_layers(outputs->paths[i])) return true;
  return outputs->count == 0;
}

/* Records files, which costs a digest of each, where a receipt is written or compared. */
static void record_files(Render *render, const Arguments *arguments) {
  render->job.records_files = render->again.receipt || writes_receipt(render, arguments);
  vl_context_record_files(render->context, render->job.records_files);
}

/* Sets what the images' receipts have in common. From this call on, files are recorded. */
static void start_receipt(Render *render, const Arguments *arguments) {
  const Again *again = &render->again;
  render->receipt = (ReceiptPlan){
      .arguments = arguments, .opening = &render->opening, .again = again->receipt, .again_is_ours = again->is_ours};
  if (again->camera.given) render->job.receipt_camera = &again->camera;
  if (!arguments->values[RENDER_NO_RECEIPT].given) render->job.receipt = &render->receipt;
  record_files(render, arguments);
}

static int prepare(Render *render, const Arguments *arguments) {
  const OptionValue *v = arguments->values;
  if (v[RENDER_QUIET].given && v[RENDER_VERBOSE].given) return report_usage("--quiet and --verbose exclude each other");
  Outputs *outputs = &render->outputs;
  for (int i = 0; i < arguments->text_count; i++) outputs->paths[i] = arguments->texts[i];
  outputs->count = arguments->text_count;
  render->film_plan = (FilmPlan){.path = v[RENDER_FILM].given       ? v[RENDER_FILM].text
                                         : v[RENDER_CONTINUE].given ? v[RENDER_CONTINUE].text
                                                                    : NULL,
                                 .from = render->resumed.path,
                                 .receipt = &render->receipt,
                                 .outputs = &render->outputs};
  outputs->half = v[RENDER_HALF].given;
  outputs->transparent = v[RENDER_TRANSPARENT].given;
  outputs->view = v[RENDER_VIEW].given ? (vlView)v[RENDER_VIEW].integer : VL_VIEW_STANDARD;
  int status = exposure_parse(&v[RENDER_EXPOSURE], &outputs->exposure, &outputs->meter);
  if (status < 0) status = channels_choose(&render->channels, arguments);
  if (status < 0) status = outputs_check_names(outputs);
  if (status < 0) status = shard_check(arguments);
  if (status < 0) status = noise_check(arguments);
  if (status < 0) status = frames_check(arguments, outputs);
  if (status < 0) status = denoised_choose(&render->denoised, arguments, outputs);
  if (status < 0) status = outputs_check_folders(outputs);
  const Outputs film = {
      .paths = {render->film_plan.path}, .count = render->film_plan.path ? 1 : 0, .patterns = outputs->patterns};
  if (status < 0) status = outputs_check_folders(&film);
  if (status >= 0) return status;

  vlContextDef def = vl_default_context_def();
  def.log = report_log;
  if (v[RENDER_THREADS].given) def.threads = (uint32_t)v[RENDER_THREADS].integer;
  if (v[RENDER_ISA].given) def.isa = (vlIsa)v[RENDER_ISA].integer;
  if (v[RENDER_MAX_MEMORY].given) def.max_memory = (size_t)v[RENDER_MAX_MEMORY].integer;
  if (v[RENDER_MAX_TEXTURE].given) def.max_texture_pixels = (uint64_t)v[RENDER_MAX_TEXTURE].integer;
  def.sandbox = arguments->folders, def.sandbox_count = (uint32_t)arguments->folder_count;
  status = context_open(&def, &render->context);
  if (status < 0) report_memory_of(render->context, def.max_memory);
  return status;
}

/* Checks before the render for outputs that could not be written after it. */
static int check_sizes(const Render *render) {
  const vlFilmDef *film = &render->job.defs->film;
  uint32_t width = film->crop[2] - film->crop[0], height = film->crop[3] - film->crop[1];
  for (int i = 0; i < render->outputs.count; i++) {
    uint32_t most = output_largest_side(render->outputs.paths[i]);
    if (width > most || height > most)
      return report_usage("output \"%s\": %u x %u pixels, this format holds at most %u each way",
                          render->outputs.paths[i], width, height, most);
  }
  vlFilm *film_made = NULL; /* memory is allocated by the first pass */
  vlResult result = vl_film_create(render->context, film, &film_made);
  vl_film_destroy(film_made);
  if (result == VL_OK) return -1;
  return job_no_film(&render->job, result);
}

/* A trajectory is metered by its first frame, so a part without that frame cannot be metered. */
static int check_metering(const Outputs *outputs, const Arguments *arguments) {
  const OptionValue *v = arguments->values;
  bool shard = v[RENDER_SHARD].given, eight_bit;
  if (!outputs->meter || !v[RENDER_TRAJECTORY].given || !(shard || v[RENDER_SKIP_EXISTING].given)) return -1;
  for (int i = 0; i < outputs->count; i++)
    if (output_suffix(outputs->paths[i], &eight_bit) && eight_bit)
      return report_usage("output \"%s\": the first frame would set the exposure: with %s give --exposure EV",
                          outputs->paths[i], shard ? "--shard" : "--skip-existing");
  return -1;
}

/* Meters a model before the render, so that neither noise nor the crop nor a part of the work changes its exposure. */
static int meter_model(Render *render, const Arguments *arguments) {
  const OptionValue *v = arguments->values;
  Outputs *outputs = &render->outputs;
  bool eight_bit = false;
  for (int i = 0; i < outputs->count && !eight_bit; i++) output_suffix(outputs->paths[i], &eight_bit);
  bool wanted = outputs->meter || !v[RENDER_EXPOSURE].given;
  eight_bit |= v[RENDER_NOISE].given; /* its threshold is of display values, also in parts without an image */
  if (!render->opening.model || !eight_bit || !wanted || v[RENDER_DRY_RUN].given) return -1;
  const vlCamera *camera = &render->job.camera;
  vlCamera first;
  vlError error = {0};
  if (render->many) {
    const Frame frame = frames_at(&render->frames, 0);
    vlResult result = frames_camera(&render->frames, &frame, 0, &first, &error);
    if (result != VL_OK) return -1; /* the render reports it */
    camera = &first;
  }
  bool given = outputs->meter || render->opening.lamps;
  outputs->meter = false;
  if (outputs->shared && !isnan(*outputs->shared)) {
    outputs->exposure = *outputs->shared;
    return -1;
  }
  int status =
      exposure_meter_model(render->context, render->world, camera, render->job.defs, given ? 0 : 1, &outputs->exposure);
  if (status < 0 && outputs->shared) *outputs->shared = outputs->exposure;
  if (status < 0 && (given || outputs->exposure != 0)) exposure_tell(outputs->exposure);
  return status;
}

static int load_and_build(Render *render, const char *path, const Arguments *arguments) {
  double start = monotonic_seconds();
  vlError error = {0};
  start_receipt(render, arguments);
  int status = scene_open(render->context, path, arguments, &render->scene, &render->opening);
  if (status >= 0) return status;
  double loaded = monotonic_seconds();

  status = job_make(&render->job, render->context, render->scene, path, arguments);
  if (status >= 0) return status;
  warn_of_alpha(render);
  if (render->outputs.count == 0 && !render->film_plan.path) {
    choose_output(render, path, render->job.defs->output, default_suffix(render, arguments));
    record_files(render, arguments);
    status = outputs_check_folders(&render->outputs);
    if (status >= 0) return status;
  }
  status = denoised_check(&render->denoised, render->context);
  if (status >= 0) return status;
  status = check_sizes(render);
  if (status >= 0) return status;
  channels_take(&render->channels, &render->job);
  warn_of_channels(render);
  status = channels_load(&render->channels, render->context, &render->job);
  if (status >= 0) return status;
  render->job.defs->film.errors = ((render->channels.bits & VL_CHANNEL_ERROR || render->channels.gbuffer) &&
                                   (has_layers(render) || render->film_plan.path)) ||
                                  render->denoised.outputs.count;
  noise_apply(arguments, &render->outputs, render->job.defs);
  if (render->resumed.file && job_sequence_is_planned(&render->job, arguments))
    render->job.defs->render.sequence = vl_film_file_sequence(render->resumed.file);
  render->film_plan.whole = *render->job.defs;
  status = shard_apply(arguments, &render->job.defs->film, &render->job.defs->render);
  if (status >= 0) return status;
  render->many = frames_wanted(arguments, &render->job);
  if (render->many && render->denoised.outputs.count) return report_usage("--denoise goes with one image");
  if (render->many) {
    render->frames.films = render->film_plan.path ? &render->film_plan : NULL;
    status = frames_load(&render->frames, render->context, &render->job, arguments);
    if (status < 0) status = frames_check_names(&render->frames, &render->outputs);
    if (status < 0) status = check_metering(&render->outputs, arguments);
    if (status >= 0) return status;
  }
  vlResult result = vl_world_build_last(render->scene, &render->job.defs->build, &render->world, &error);
  if (result != VL_OK) return report_error(&error, result, path);
  vl_context_record_files(render->context, false);
  if (arguments->values[RENDER_VERBOSE].given) {
    char bytes[32];
    format_count(bytes, sizeof bytes, (double)vl_context_memory(render->context, NULL));
    report_note("loaded in %.3f s, built in %.3f s, %sB held; %u threads, x86-64-v%d", loaded - start,
                monotonic_seconds() - loaded, bytes, vl_context_threads(render->context),
                (int)vl_context_isa(render->context));
  }
  return -1;
}

/* Checked before the render, so that it does not run out of memory after hours. */
static int reckon_memory(Render *render, const Arguments *arguments) {
  const OptionValue *limit = &arguments->values[RENDER_MAX_MEMORY];
  uint64_t most = limit->given ? (uint64_t)limit->integer : 0;
  memory_plan(&render->memory, render->context, render->world, &render->job, &render->outputs, &render->channels,
              render->many ? &render->frames : NULL);
  if (render->denoised.outputs.count) memory_add(&render->memory, "denoising", denoised_memory(image_pixels(render)));
  if (report_is_json()) memory_report_json(&render->memory, most);
  if (arguments->values[RENDER_VERBOSE].given) {
    char list[400], total[32];
    memory_list(&render->memory, list, sizeof list);
    format_count(total, sizeof total, (double)render->memory.total);
    report_note("memory: %sB are needed: %s", total, list);
  }
  return memory_check(&render->memory, most);
}

static void report_not_finite(const vlRenderStats *stats) {
  if (stats->not_finite)
    report_warning("%llu samples were not finite or negative and were left out; the first one at pixel %u, %u",
                   (unsigned long long)stats->not_finite, stats->worst_x, stats->worst_y);
}

static void report_memory(const Render *render) {
  char peak[32], needed[32];
  format_count(peak, sizeof peak, (double)memory_peak());
  format_count(needed, sizeof needed, (double)render->memory.total);
  if (report_is_verbose()) report_note("memory: %sB at most, %sB were reckoned", peak, needed);
}

static void report_result(const Render *render, const vlRenderStats *stats, OutputStage stage, int status) {
  const Outputs *outputs = &render->outputs;
  uint64_t rays = stats->camera_rays + stats->bounce_rays + stats->shadow_rays;
  uint32_t spp = vl_film_spp(render->film);
  if (report_is_json()) {
    char part[5000];
    Json json = report_json_begin("result");
    json_integer(&json, "status", status);
    json_bool(&json, "finished", stage == OUTPUT_FINISHED);
    json_integer(&json, "spp", spp);
    json_number(&json, "mean_spp", stats->mean_spp);
    json_integer(&json, "noisy_blocks", stats->noisy_blocks);
    json_number(&json, "seconds", stats->seconds);
    json_integer(&json, "paths", (int64_t)stats->paths);
    json_integer(&json, "camera_rays", (int64_t)stats->camera_rays);
    json_integer(&json, "bounce_rays", (int64_t)stats->bounce_rays);
    json_integer(&json, "shadow_rays", (int64_t)stats->shadow_rays);
    json_integer(&json, "not_finite", (int64_t)stats->not_finite);
    json_integer(&json, "memory_needed", (int64_t)render->memory.total);
    json_integer(&json, "memory_peak", (int64_t)memory_peak());
    json_begin(&json, "files", '[');
    for (int i = 0; i < outputs->count && spp; i++)
      json_text(&json, NULL, output_written(outputs, i, stage, part, sizeof part));
    if (render->denoised.outputs.count && spp)
      json_text(&json, NULL, output_written(&render->denoised.outputs, 0, stage, part, sizeof part));
    if (render->film_plan.path && spp) json_text(&json, NULL, render->film_plan.path);
    json_end(&json, ']');
    report_json_end(&json);
    return;
  }
  char time[32], speed[32], ray_count[32], files[1200];
  format_seconds(time, sizeof time, stats->seconds);
  format_count(speed, sizeof speed, stats->seconds > 0 ? (double)stats->paths / stats->seconds : 0);
  format_count(ray_count, sizeof ray_count, (double)rays);
  list_files(render, stage, files, sizeof files);
  report_note("%u spp in %s, %s paths/s, %s rays; wrote %s%s%s", spp, time, speed, ray_count, files,
              *files && render->film_plan.path ? ", " : "", render->film_plan.path ? render->film_plan.path : "");
  report_memory(render);
}

/* The first pass, with --denoise the second one too, is always completed. */
static void report_late(const Render *render, uint32_t spp) {
  double elapsed = monotonic_seconds() - render->start;
  char wanted[32], taken[32];
  if (!(render->time_limit > 0) || spp > render->begun_spp + least_samples(render) ||
      elapsed < 1.05 * render->time_limit || signals_pending())
    return;
  format_seconds(wanted, sizeof wanted, render->time_limit);
  format_seconds(taken, sizeof taken, elapsed);
  report_warning("%u spp and writing it took %s, --time was %s", spp - render->begun_spp, taken, wanted);
}

/* Writes the final image with its ground truth. A stopped render is written before its ground truth is rendered, which
 * another signal may interrupt. *stage: the stage of the last write. */
static int write_last(Render *render, OutputStage *stage) {
  int written = STATUS_OK;
  if (*stage == OUTPUT_STOPPED && has_layers(render)) written = write_image(render, *stage);
  int status = render_channels(render);
  if (status > 128) {
    *stage = OUTPUT_STOPPED;
    memset(render->outputs.layers, 0, sizeof render->outputs.layers);
    report_note("interrupted before the ground truth was done: the image has none");
  } else if (status != STATUS_OK) {
    return status;
  }
  for (int i = 0; i < render->outputs.count && status == STATUS_OK; i++) {
    char part[5000];
    if (render->channels.bits && output_holds_layers(render->outputs.paths[i]))
      written = channels_write_ids(&render->channels, NULL, render->world,
                                   output_written(&render->outputs, i, *stage, part, sizeof part));
  }
  int code = write_image(render, *stage);
  render->denoised.outputs.meter = render->outputs.meter;
  if (code == STATUS_OK && status == STATUS_OK)
    code = denoised_write(&render->denoised, render->context, render->world, &render->job, render->film, *stage);
  return code != STATUS_OK ? code : written != STATUS_OK ? written : status;
}

/* Makes the film, or reads the film to continue. */
static int open_film(Render *render) {
  const char *from = render->resumed.path;
  int status = film_keeper_start(&render->keeper, &render->film_plan, render->film_plan.path, render->context,
                                 &render->job, NULL);
  if (status < 0 && from)
    status = continue_film(from, render->receipt.arguments, render->keeper.receipt, render->context, render->job.defs,
                           &render->film);
  if (status >= 0 || render->film) return status;
  vlResult result = vl_film_create(render->context, &render->job.defs->film, &render->film);
  return result == VL_OK ? -1 : job_no_film(&render->job, result);
}

/* The receipt of a render that ended at its time limit states the samples that it reached. */
static int plan_reached(Render *render, uint32_t end) {
  if (!(render->time_limit > 0) || end >= render->job.defs->render.spp) return -1;
  render->job.defs->render.spp = render->film_plan.whole.render.spp = end;
  return film_keeper_describe(&render->keeper, &render->film_plan, render->context, &render->job, NULL);
}

static int render_and_write(Render *render) {
  Job *job = &render->job;
  vlError error = {0};
  vlRenderStats stats = {0};
  int opened = open_film(render);
  if (opened >= 0) return opened;
  render->time_limit = job->defs->render.time_limit;
  render->begun_spp = vl_film_spp(render->film);
  render->render_start = monotonic_seconds();
  progress_start(&render->progress, render->time_limit);
  limit_time(render);
  job->defs->render.progress = on_progress;
  job->defs->render.progress_user = render;
  signals_remember();
  vlResult result = vl_render(render->world, &job->camera, render->film, &job->defs->render, &stats, &error);
  report_status_line(NULL);
  report_not_finite(&stats);
  noise_report(&job->defs->render, &stats);
  if (result != VL_OK && result != VL_CANCELLED) return report_error(&error, result, job->path);

  uint32_t spp = vl_film_spp(render->film);
  OutputStage stage = result == VL_OK ? OUTPUT_FINISHED : OUTPUT_STOPPED;
  if (!spp) {
    report_failure(128 + signals_pending(), "interrupted before the first pass was done; nothing is written");
    return 128 + signals_pending();
  }
  if (stage == OUTPUT_STOPPED) report_note("interrupted after %u of %u spp", spp, job->defs->render.spp);
  if (stage == OUTPUT_FINISHED && (opened = plan_reached(render, job->defs->render.first_sample + spp)) >= 0)
    return opened;
  int kept = film_keeper_finish(&render->keeper, render->film);
  /* The image's receipt states the samples that its blocks needed at most; the film's states the limit. */
  if (job->defs->render.noise > 0) job->defs->render.spp = spp;
  int status = render->outputs.count ? write_last(render, &stage) : STATUS_OK;
  if (kept != STATUS_OK && (status == STATUS_OK || status > 128)) status = kept;
  if (status == STATUS_OK) report_late(render, spp);
  if (signals_pending() && status == STATUS_OK) status = 128 + signals_pending();
  if (status == STATUS_OK || status > 128) report_result(render, &stats, stage, status);
  return status;
}

/* With --again: whether the image will be the same. */
static int check_again(const Render *render) {
  const Job *job = &render->job;
  const Frames *frames = &render->frames;
  ReceiptImage which = {.samples = job->defs->render.spp};
  if (render->many) {
    which.is_frame = frames->trajectory != NULL;
    const Frame first = frames_at(frames, 0);
    which.frame = first.number;
    job = &first.camera->job; /* a file of poses may have its own cameras */
    if (frames_count(frames) > 1)
      return report_usage("--again: the images of a rig are made again by the command in the receipt");
  }
  /* several images have different cameras; the files and the command determine them */
  return again_check(&render->again, &render->receipt, render->context, job, &which, !render->many);
}

/* exposure: see outputs.h, `shared`; null: the image has its own. */
static int render_once(const Command *command, const Arguments *arguments, float *exposure) {
  Render render;
  memset(&render, 0, sizeof render);
  render.start = monotonic_seconds();
  render.outputs.shared = exposure;
  set_up_reports(arguments);
  int status = again_open(&render.again, &arguments);
  if (status < 0) status = continue_open(&render.resumed, &arguments);
  if (status < 0 && arguments->operand_count == 0)
    status = report_usage("%s: too few arguments; usage: velo %s %s", command->name, command->name, command->usage);
  if (status < 0) status = prepare(&render, arguments);
  if (status < 0) status = load_and_build(&render, arguments->operands[0], arguments);
  if (status < 0) status = reckon_memory(&render, arguments);
  if (status < 0 && !render.many) status = lens_autofocus(&render.job, render.scene, render.world);
  if (status < 0) status = meter_model(&render, arguments);
  if (status < 0)
    status = noise_expose(&render.outputs, render.many, &render.job.defs->render, &render.film_plan.whole.render);
  if (status < 0 && render.again.receipt) status = check_again(&render);
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
  film_keeper_free(&render.keeper);
  vl_film_destroy(render.film);
  vl_world_destroy(render.world);
  vl_scene_destroy(render.scene);
  report_memory_of(NULL, 0);
  vl_context_destroy(render.context);
  again_close(&render.again);
  continue_close(&render.resumed);
  return status;
}

static int run_render(const Command *command, const Arguments *arguments) {
  if (arguments->operand_count && animate_wanted(arguments)) return animate_run(command, arguments, render_once);
  return render_once(command, arguments, NULL);
}

const Command render_command = {
    .name = "render",
    .usage = "FILE [options]",
    .summary = "render a scene: .pbrt .gltf .glb .obj .ply .stl .off",
    .text =
        "Renders FILE. Options override the settings in the file. After the first pass, and then about every\n"
        "ten seconds, the unfinished image is written to NAME.part.EXT; at the end it becomes NAME.EXT.\n"
        "Ctrl-C ends the render; the samples so far are in NAME.part.EXT, and in the film file of --film,\n"
        "which --continue continues.",
    .examples =
        "velo render room.pbrt -o room.exr -o room.png --spp 256\n"
        "velo render model.glb --resolution 1280x720 --time 5m -o model.png",
    .options = render_options,
    .sections = render_sections,
    .min_operands = 0, /* --again and --continue need none */
    .max_operands = 1,
    .run = run_render,
};
