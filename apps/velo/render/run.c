/* render/run.c: see run.h. The first pass is written at once and later ones at intervals, so
 * that there is a progress image. A signal stops the render and keeps its whole passes. */
#include <stdio.h>
#include <string.h>

#include "cli/crop.h"
#include "cli/macros.h"
#include "cli/options.h"
#include "cli/report.h"
#include "cli/signals.h"
#include "cli/text.h"
#include "render/attributes.h"
#include "render/job.h"
#include "render/noise.h"
#include "render/run.h"

static void add_option(FILE *out, const Option *option, const char *value) {
  char name[40];
  text_set(name, "--%s", option->name);
  if (option->letter)
    text_set(name, "-%c", option->letter);
  text_shell_word(out, name);
  if (option->kind != OPTION_FLAG)
    text_shell_word(out, value);
}

/* The command line that renders the same image with the usual samples and without denoising,
 * quoted for a shell. False: it does not fit. */
static bool plain_command(const Arguments *arguments, char *text, size_t size) {
  const char *path = arguments->operands[0];
  FILE *out = fmemopen(text, size, "w");
  *text = 0;
  if (!out)
    return false;
  fputs("velo render", out);
  char file[4200];
  text_set(file, "%s%s", path[0] == '-' ? "./" : "", path);
  text_shell_word(out, file);
  for (const Option *option = render_options; option->name; option++) {
    const OptionValue *value = &arguments->values[option->id];
    if (!value->given)
      continue;
    if (option->kind == OPTION_TEXTS || option->kind == OPTION_FOLDERS) {
      const bool texts = option->kind == OPTION_TEXTS;
      const char *const *all = texts ? arguments->texts : arguments->folders;
      int count = texts ? arguments->text_count : arguments->folder_count;
      for (int i = 0; i < count; i++)
        add_option(out, option, all[i]);
    } else {
      add_option(out, option, value->text);
    }
  }
  fputs(" --plain", out);
  return fclose(out) == 0 && strlen(text) + 1 < size;
}

/* Seconds between two progress images. Writing them takes at most 1 / WRITE_SHARE of the
 * time. */
enum { WRITE_EVERY = 10, WRITE_SHARE = 20 };

/* ---- files ------------------------------------------------------------------------------- */

static vlResult set_header(const Render *render, uint32_t spp, vlImage *image) {
  const ReceiptImage which = {.samples = spp};
  TRY_RESULT(attributes_set(image, &render->job, spp));
  TRY_RESULT(channels_describe(&render->channels, image));
  return receipt_set(&render->job, &which, image);
}

/* An image without its whole header is kept as one of a stopped render. */
static int write_image(Render *render, OutputStage stage) {
  vlImage *image = NULL;
  uint32_t spp = vl_film_spp(render->film);
  vlResult result = vl_film_develop(render->film, &render->job.defs->develop, &image);
  if (result == VL_OK)
    result = set_header(render, spp, image);
  int status = STATUS_OK;
  if (result != VL_OK && stage != OUTPUT_PROGRESS)
    status = report_reason(result, render->outputs.paths[0],
                           "the image and its header cannot be made");
  if (result == VL_OK || (image && stage != OUTPUT_PROGRESS))
    status = first_failure(status, outputs_write(render->context, &render->outputs, image, spp,
                                                 result == VL_OK ? stage : OUTPUT_STOPPED));
  else if (stage == OUTPUT_PROGRESS)
    report_warning("progress image: %s", vl_result_name(result));
  vl_image_destroy(image);
  return status;
}

bool run_has_layers(const Render *render) {
  return channels_any(&render->channels) && outputs_any(&render->outputs, output_holds_layers);
}

/* Formats the list of files: "a.exr, b.png". */
static void list_files(const Render *render, OutputStage stage, char *text, size_t size) {
  char part[5000];
  text[0] = 0;
  for (int i = 0; i < render->outputs.count; i++)
    text_add(text, size, "%s%s", i ? ", " : "",
             output_written(&render->outputs, i, stage, part, sizeof part));
  if (render->denoised.written && denoised_is_copy(&render->denoised) &&
      stage != OUTPUT_PROGRESS)
    text_add(text, size, ", %s",
             output_written(&render->denoised.outputs, 0, stage, part, sizeof part));
}

/* Reported once, when the render outlasts its first progress images. */
static void name_parts(Render *render, const vlProgress *now) {
  char files[1200];
  if (render->part_named || render->videos || now->remaining < WRITE_EVERY)
    return;
  render->part_named = true;
  list_files(render, OUTPUT_PROGRESS, files, sizeof files);
  report_note("the image so far is in %s", files);
}

uint64_t run_pixels(const Render *render) {
  return crop_pixels(render->job.defs->film.crop);
}

/* Returns the smallest number of samples per pixel that suffices for every output. A denoiser
 * needs more samples, for its standard errors. */
static uint32_t min_samples(const Render *render) {
  return render->denoised.outputs.count ? 2 : 1;
}

/* Estimated seconds between the last pass and the end of the command. */
static double finish_seconds(const Render *render) {
  const vlFilmDef *film = &render->job.defs->film;
  uint32_t spp = vl_film_spp(render->film);
  double seconds =
      render->write_cost + film_keeper_seconds(&render->keeper, vl_film_memory(film));
  if (run_has_layers(render))
    seconds += channels_seconds(&render->channels, film->buckets, spp, render->first_pass,
                                render->write_cost);
  if (render->denoised.outputs.count)
    seconds += denoised_seconds(run_pixels(render), spp, render->first_pass, render->write_cost,
                                vl_context_threads(render->context));
  return seconds;
}

/* Sets the render's time limit so that the whole command ends after --time. */
static void limit_time(Render *render) {
  if (!(render->time_limit > 0))
    return;
  double left =
      render->time_limit - (render->render_start - render->start) - finish_seconds(render);
  render->job.defs->render.time_limit = left > 1e-3 ? left : 1e-3;
  if (vl_film_spp(render->film) < min_samples(render))
    render->job.defs->render.time_limit = 0;
}

/* The frame is rendered for the denoised frames after it, and not written. */
static bool is_only_kept(const Render *render) {
  return render->denoised.steady && render->denoised.steady->only_kept;
}

static void write_progress_image(Render *render, const vlProgress *now) {
  if (render->outputs.count == 0 || is_only_kept(render))
    return;
  double start = monotonic_seconds(), wait = WRITE_SHARE * render->write_cost;
  bool ends = now->spp_done >= now->spp_total || now->remaining <= 2 * render->write_cost;
  if (ends && render->time_limit > 0)
    return; /* the final image follows soon */
  if (now->spp_done >= now->spp_total)
    return;
  if (render->written_spp &&
      start - render->last_write < (wait > WRITE_EVERY ? wait : WRITE_EVERY))
    return;
  write_image(render, OUTPUT_PROGRESS);
  name_parts(render, now);
  render->written_spp = vl_film_spp(render->film);
  render->last_write = monotonic_seconds();
  render->write_cost = render->last_write - start;
}

static void write_checkpoint(Render *render, const vlProgress *now) {
  if (now->spp_done < now->spp_total)
    film_keeper_checkpoint(&render->keeper, render->film);
}

static bool on_progress(void *user, const vlProgress *now) {
  Render *render = user;
  if (render->videos)
    progress_show_frames(&render->videos->shown, render->videos->number, now->fraction);
  else
    progress_show(&render->progress, now);
  if (now->pass_done && !signals_pending()) {
    if (!(render->first_pass > 0))
      render->first_pass = now->elapsed;
    write_checkpoint(render, now);
    if (render->serve)
      serve_film(render->serve, render->film, now);
    write_progress_image(render, now);
    limit_time(render);
  }
  return !signals_pending();
}

static int render_channels(Render *render) {
  if (!run_has_layers(render))
    return STATUS_OK;
  Channels *channels = &render->channels;
  int status = channels_render(channels, &render->job, render->film);
  for (int k = 0; k < CHANNEL_LAYERS; k++)
    render->outputs.layers[k] = channels->layers[k];
  return status;
}

/* ---- the result -------------------------------------------------------------------------- */

void json_render_stats(Json *json, const vlRenderStats *stats) {
  json_put(
      json, "paths %lld, camera_rays %lld, bounce_rays %lld, shadow_rays %lld, not_finite %lld",
      (long long)stats->paths, (long long)stats->camera_rays, (long long)stats->bounce_rays,
      (long long)stats->shadow_rays, (long long)stats->not_finite);
}

void not_finite_text(const vlRenderStats *stats, char *text, size_t size) {
  snprintf(text, size,
           "%llu samples were not finite or negative and were left out; the first one at pixel "
           "%u, %u",
           (unsigned long long)stats->not_finite, stats->worst_x, stats->worst_y);
}

void report_not_finite(const vlRenderStats *stats) {
  char text[160];
  if (!stats->not_finite)
    return;
  not_finite_text(stats, text, sizeof text);
  report_warning("%s", text);
}

static void report_memory(const Render *render) {
  if (report_is_verbose())
    report_note("memory: %sB at most, %sB were reckoned",
                format_count((double)memory_peak()).text,
                format_count((double)render->memory.total).text);
}

static void report_result(const Render *render, const vlRenderStats *stats, OutputStage stage,
                          int status) {
  const Outputs *outputs = &render->outputs;
  uint64_t rays = stats->camera_rays + stats->bounce_rays + stats->shadow_rays;
  uint32_t spp = vl_film_spp(render->film);
  const bool first = render->denoised.replaces && render->denoised.written;
  char plain[6000] = "";
  if (first && !plain_command(render->receipt.arguments, plain, sizeof plain))
    text_set(plain, "--plain");
  if (report_is_json()) {
    char part[5000];
    Json *json = report_json_begin("result");
    json_put(json, "status %d, finished %i, spp %u, mean_spp %g, noisy_blocks %u, denoised %i",
             status, stage == OUTPUT_FINISHED, spp, stats->mean_spp, stats->noisy_blocks,
             first);
    if (first)
      json_text(json, "plain", plain);
    json_number(json, "seconds", stats->seconds);
    json_render_stats(json, stats);
    json_put(json, "memory_needed %lld, memory_peak %lld", (long long)render->memory.total,
             (long long)memory_peak());
    json_begin(json, "files", '[');
    for (int i = 0; i < outputs->count && spp; i++)
      json_text(json, NULL, output_written(outputs, i, stage, part, sizeof part));
    if (render->denoised.written && denoised_is_copy(&render->denoised))
      json_text(json, NULL,
                output_written(&render->denoised.outputs, 0, stage, part, sizeof part));
    if (render->film_plan.path && spp)
      json_text(json, NULL, render->film_plan.path);
    json_end(json, ']');
    report_json_end(json);
    return;
  }
  if (render->videos)
    return; /* the video is reported */
  char files[1200];
  list_files(render, stage, files, sizeof files);
  report_note("%u spp%s in %s, %s paths/s, %s rays; wrote %s%s%s%s%s", spp,
              first ? ", denoised," : "", format_seconds(stats->seconds).text,
              format_count(stats->seconds > 0 ? (double)stats->paths / stats->seconds : 0).text,
              format_count((double)rays).text, files,
              *files && render->film_plan.path ? ", " : "",
              render->film_plan.path ? render->film_plan.path : "",
              first ? "; without denoising: " : "", plain);
  report_memory(render);
}

/* The first pass, with --denoise the second one too, is always completed. */
static void report_late(const Render *render, uint32_t spp) {
  double elapsed = monotonic_seconds() - render->start;
  if (!(render->time_limit > 0) || spp > render->begun_spp + min_samples(render) ||
      elapsed < 1.05 * render->time_limit || signals_pending())
    return;
  report_warning("%u spp and writing it took %s, --time was %s", spp - render->begun_spp,
                 format_seconds(elapsed).text, format_seconds(render->time_limit).text);
}

static int write_stopped(Render *render) {
  render->outputs.comment = NULL;
  return write_image(render, OUTPUT_STOPPED);
}

/* The image of a stopped render is not denoised, nor is one whose denoiser is stopped. */
static int write_first_image(Render *render, OutputStage *stage) {
  Denoised *d = &render->denoised;
  int status = STATUS_OK;
  if (*stage == OUTPUT_FINISHED) {
    d->outputs = render->outputs; /* with their exposure, and what is known of their parts */
    status = denoised_write(d, &render->job, render->film, *stage);
  }
  if (*stage == OUTPUT_FINISHED && status <= 128)
    return status;
  *stage = OUTPUT_STOPPED;
  return first_failure(write_stopped(render), status);
}

/* The files of ids beside the images. Returns the first failure, or STATUS_OK. */
static int write_ids(const Render *render, OutputStage stage) {
  int status = STATUS_OK;
  for (int i = 0; i < render->outputs.count && render->channels.bits; i++) {
    char part[5000];
    if (!output_holds_layers(render->outputs.paths[i]))
      continue;
    const char *path = output_written(&render->outputs, i, stage, part, sizeof part);
    status =
        first_failure(status, channels_write_ids(&render->channels, NULL, &render->job, path));
  }
  return status;
}

/* Writes the final image with its ground truth. A stopped render is written before its ground
 * truth is rendered, which another signal may interrupt. Whatever fails, the rest is written.
 * *stage: the stage of the last write. */
static int write_last(Render *render, OutputStage *stage) {
  int written = STATUS_OK;
  if (*stage == OUTPUT_STOPPED && run_has_layers(render))
    written = write_image(render, *stage);
  int status = render_channels(render);
  if (status != STATUS_OK) {
    *stage = OUTPUT_STOPPED;
    memset(render->outputs.layers, 0, sizeof render->outputs.layers);
    report_note(status > 128
                    ? "interrupted before the ground truth was done: the image has none"
                    : "the ground truth cannot be made: the image has none");
  } else {
    written = first_failure(written, write_ids(render, *stage));
  }
  if (render->denoised.replaces)
    return write_first_image(render, stage);
  denoised_share_exposure(&render->denoised, &render->outputs);
  written = first_failure(written, write_image(render, *stage));
  if (status == STATUS_OK)
    written = first_failure(
        written, denoised_write(&render->denoised, &render->job, render->film, *stage));
  return first_failure(written, status);
}

/* Makes the film, or reads the film to continue. */
static int open_film(Render *render) {
  const FilmClaim *claim = &render->film_plan.claims[0];
  int status = film_keeper_start(&render->keeper, &render->film_plan, 0, &render->job, NULL);
  if (status < 0)
    status = continue_film(claim, render->receipt.arguments, render->keeper.receipt,
                           render->context, render->job.defs, &render->film);
  return status >= 0 || render->film ? status : job_make_film(&render->job, &render->film);
}

/* The receipt of a render that ended at its time limit states the samples that it reached. */
static int plan_reached(Render *render, uint32_t end) {
  if (!(render->time_limit > 0) || end >= render->job.defs->render.spp)
    return -1;
  render->job.defs->render.spp = render->film_plan.whole.render.spp = end;
  return film_keeper_describe(&render->keeper, &render->film_plan, &render->job, NULL);
}

/* Writes what was rendered. failed: the exit code of a render that went wrong, or STATUS_OK.
 * Returns the exit code. */
static int finish_image(Render *render, vlResult result, int failed,
                        const vlRenderStats *stats) {
  Job *job = &render->job;
  int reached;
  uint32_t spp = vl_film_spp(render->film);
  OutputStage stage = result == VL_OK ? OUTPUT_FINISHED : OUTPUT_STOPPED;
  if (!spp && failed != STATUS_OK)
    return failed;
  if (!spp)
    return report_failure(signals_status(),
                          "interrupted before the first pass was done; nothing is written");
  if (stage == OUTPUT_STOPPED)
    report_note("%s after %u of %u spp", failed == STATUS_OK ? "interrupted" : "stopped", spp,
                job->defs->render.spp);
  if (stage == OUTPUT_FINISHED &&
      (reached = plan_reached(render, job->defs->render.first_sample + spp)) >= 0)
    return reached;
  int kept = film_keeper_finish(&render->keeper, render->film);
  /* The image's receipt states the samples that its blocks needed at most; the film's states
   * the limit. */
  if (job->defs->render.noise > 0)
    job->defs->render.spp = spp;
  if (is_only_kept(render)) {
    int done = stage == OUTPUT_FINISHED
                   ? denoised_write(&render->denoised, job, render->film, stage)
                   : STATUS_OK;
    return done == STATUS_OK && signals_pending() ? signals_status() : done;
  }
  int status = STATUS_OK;
  if (render->outputs.count)
    status = failed == STATUS_OK ? write_last(render, &stage) : write_stopped(render);
  if (kept != STATUS_OK && (status == STATUS_OK || status > 128))
    status = kept;
  status = first_failure(failed, status);
  if (status == STATUS_OK)
    report_late(render, spp);
  if (signals_pending() && status == STATUS_OK)
    status = signals_status();
  if (status == STATUS_OK || status > 128)
    report_result(render, stats, stage, status);
  return status;
}

int run_image(Render *render) {
  Job *job = &render->job;
  vlError error = {0};
  vlRenderStats stats = {0};
  TRY(open_film(render));
  if (render->receipt.arguments->values[RENDER_SERVE].given)
    TRY(serve_start(job, render->outputs.view, render->outputs.exposure, &render->serve));
  render->time_limit = job->defs->render.time_limit;
  render->begun_spp = vl_film_spp(render->film);
  if (render->film_plan.claims[0].earlier)
    report_note("%s is continued from %u samples per pixel on", render->film_plan.path,
                render->begun_spp);
  render->render_start = monotonic_seconds();
  progress_start(&render->progress, render->time_limit);
  limit_time(render);
  job->defs->render.progress = on_progress;
  job->defs->render.progress_user = render;
  signals_remember();
  vlResult result =
      vl_render(render->world, &job->camera, render->film, &job->defs->render, &stats, &error);
  report_status_line(NULL);
  report_not_finite(&stats);
  noise_report(&job->defs->render, &stats);
  const int failed = result == VL_OK || result == VL_CANCELLED
                         ? STATUS_OK
                         : report_error(&error, result, job->path);
  return finish_image(render, result, failed, &stats);
}
