/* render/render.c: `velo render`: reads the options, loads the scene, builds the world, plans
 * outputs and memory; then run.c renders one image, frames_render.c several. Only a render that
 * reached its samples or its time replaces an earlier image (outputs.h). */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "cli/commands.h"
#include "cli/confine.h"
#include "cli/context.h"
#include "cli/crop.h"
#include "cli/macros.h"
#include "cli/report.h"
#include "cli/text.h"
#include "render/animate.h"
#include "render/blend.h"
#include "render/exposure.h"
#include "render/first_image.h"
#include "render/lens_options.h"
#include "render/near.h"
#include "render/needs.h"
#include "render/noise.h"
#include "render/output_names.h"
#include "render/race.h"
#include "render/run.h"
#include "render/shard.h"
#include "render/video.h"

/* A model becomes a .png, unless something is asked for that only .exr holds. */
static const char *default_suffix(const Render *render, const Arguments *arguments) {
  const OptionValue *v = arguments->values;
  bool exr = v[RENDER_CHANNELS].given || v[RENDER_SPECTRUM].given || v[RENDER_HALF].given ||
             v[RENDER_STEREO].given;
  return render->opening.model && !exr ? ".png" : ".exr";
}

/* The default output name: the last component of the name that the scene gives, otherwise the
 * scene's name with the suffix. It is in the current directory, since scenes may be
 * untrusted. */
static void choose_output(Render *render, const char *scene_path, const char *asked,
                          const char *suffix) {
  asked = text_file_name(asked);
  if (output_is_known(asked)) {
    text_set(render->default_output, "%s", asked);
  } else {
    const char *name = text_file_name(scene_path);
    const char *end = strstr(name, ".pbrt");
    if (!end)
      end = strrchr(name, '.');
    int length = end && end > name ? (int)(end - name) : (int)strlen(name);
    text_set(render->default_output, "%.*s%s", length > 500 ? 500 : length, name, suffix);
  }
  render->outputs.paths[0] = render->default_output;
  render->outputs.count = 1;
}

/* ---- ground truth ------------------------------------------------------------------------ */

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
      report_warning("--transparent: %s cannot hold alpha, only .png and .exr can",
                     render->outputs.paths[i]);
}

/* ---- steps: each returns -1 to go on, else the exit code --------------------------------- */

static void set_up_reports(const Arguments *arguments) {
  const OptionValue *v = arguments->values;
  report_setup(v[RENDER_LOG_JSON].given, v[RENDER_QUIET].given     ? REPORT_QUIET
                                         : v[RENDER_VERBOSE].given ? REPORT_VERBOSE
                                                                   : REPORT_NORMAL);
}

/* Whether a file of this render holds a receipt: a film, or an .exr. Without -o the name of the
 * image is known only when the scene is loaded. */
static bool writes_receipt(const Render *render, const Arguments *arguments) {
  const Outputs *outputs = &render->outputs;
  if (arguments->values[RENDER_DRY_RUN].given)
    return false;
  if (render->film_plan.path)
    return true;
  if (arguments->values[RENDER_NO_RECEIPT].given)
    return false;
  return outputs->count == 0 || outputs_any(outputs, output_holds_layers);
}

/* Records files, which costs a digest of each, where a receipt is written or compared. */
static void record_files(Render *render, const Arguments *arguments) {
  render->job.records_files = render->again.receipt || writes_receipt(render, arguments);
  vl_context_record_files(render->context, render->job.records_files);
}

/* Sets what the images' receipts have in common. From this call on, files are recorded. */
static void start_receipt(Render *render, const Arguments *arguments) {
  const Again *again = &render->again;
  render->receipt = (ReceiptPlan){.arguments = arguments,
                                  .opening = &render->opening,
                                  .again = again->receipt,
                                  .again_is_ours = again->is_ours};
  if (again->camera.given)
    render->job.receipt_camera = &again->camera;
  if (!arguments->values[RENDER_NO_RECEIPT].given)
    render->job.receipt = &render->receipt;
  record_files(render, arguments);
}

/* Tells the context of files that others read: no output may replace them. */
static int note_inputs(const Render *render, const Arguments *arguments) {
  const OptionValue *v = arguments->values;
  const char *const plain[] = {render->again.path, v[RENDER_DENOISER_LIBRARY].text};
  vlResult result = VL_OK;
  for (size_t i = 0; i < LENGTH(plain) && result != VL_ERROR_MEMORY; i++)
    if (plain[i])
      result = vl_note_input(render->context, plain[i], VL_OUTPUT_PLAIN);
  if (render->resumed.path && result != VL_ERROR_MEMORY)
    result = vl_note_input(render->context, render->resumed.path, VL_OUTPUT_FILM);
  return result == VL_ERROR_MEMORY ? report_error(NULL, result, NULL) : -1;
}

/* --sandbox: what the render opens besides the files of the scene. */
static void confine(const Render *render, const Arguments *arguments) {
  static const int inputs[] = {
      RENDER_CAMERA,      RENDER_TRAJECTORY,         RENDER_RIG,
      RENDER_FLOW_CAMERA, RENDER_FLOW_CAMERA_BEFORE, RENDER_DENOISER_LIBRARY};
  const OptionValue *v = arguments->values;
  Confine c = {.sockets = v[RENDER_SERVE].given};
  confine_read(&c, arguments->operands[0]);
  confine_read(&c, render->again.path);
  confine_read(&c, v[RENDER_ENVIRONMENT].text);
  for (size_t i = 0; i < LENGTH(inputs); i++)
    confine_read_folder(&c, v[inputs[i]].text);
  for (int i = 0; i < render->outputs.count; i++)
    confine_write(&c, render->outputs.paths[i]);
  if (!render->outputs.count)
    confine_write(&c, "default.exr"); /* its name is chosen later, its folder is this one */
  confine_write(&c, render->film_plan.path);
  confine_write(&c, render->film_plan.from);
  if (render->denoised.outputs.count)
    confine_write(&c, render->denoised.outputs.paths[0]);
  confine_apply(&c, arguments);
}

static int make_context(Render *render, const Arguments *arguments) {
  vlContextDef def = scene_context_def(arguments);
  if (!render->context) {
    confine(render, arguments);
    TRY(context_open(&def, &render->context));
  }
  report_memory_of(render->context, def.max_memory);
  return note_inputs(render, arguments);
}

static int prepare(Render *render, const Arguments *arguments) {
  const OptionValue *v = arguments->values;
  TRY(options_exclude(arguments, RENDER_QUIET, RENDER_VERBOSE));
  Outputs *outputs = &render->outputs;
  outputs_take_names(outputs, arguments);
  render->film_plan =
      (FilmPlan){.path = v[v[RENDER_FILM].given ? RENDER_FILM : RENDER_CONTINUE].text,
                 .from = render->resumed.path,
                 .overwrite = v[RENDER_OVERWRITE].given,
                 .receipt = &render->receipt,
                 .outputs = &render->outputs,
                 .channels = &render->channels};
  if (render->film_plan.path)
    render->film_plan.path = output_opened(render->film_plan.path);
  outputs->to_stdout = true;
  outputs->half = v[RENDER_HALF].given;
  outputs->transparent = v[RENDER_TRANSPARENT].given;
  outputs->view = (vlView)option_count(&v[RENDER_VIEW], VL_VIEW_STANDARD);
  TRY(exposure_parse(&v[RENDER_EXPOSURE], &outputs->exposure, &outputs->meter));
  TRY(channels_choose(&render->channels, arguments));
  TRY(outputs_check_names(outputs));
  TRY(shard_check(arguments));
  TRY(noise_check(arguments));
  TRY(race_check(render, arguments));
  TRY(frames_check(arguments, outputs));
  TRY(denoised_choose(&render->denoised, arguments, outputs));
  if (render->shared && v[RENDER_DENOISE].given)
    render->denoised.steady = &render->shared->steady;
  TRY(outputs_check_folders(outputs));
  TRY(film_claim_check(v[RENDER_OVERWRITE].given, v[RENDER_FILM].text, render->film_plan.from));
  const Outputs film = {.paths = {render->film_plan.path},
                        .count = render->film_plan.path ? 1 : 0,
                        .patterns = outputs->patterns};
  TRY(outputs_check_folders(&film));
  return make_context(render, arguments);
}

/* Adds the files of each frame and view. */
static void add_frames(const Render *render, OutputNames *names) {
  const Frames *frames = &render->frames;
  char path[4096];
  for (uint32_t k = 0; k < frames_count(frames); k++) {
    const Frame frame = frames_at(frames, k);
    for (int i = 0; i < render->outputs.count; i++) {
      const char *pattern = render->outputs.paths[i];
      for (int view = 0; view < frames_files(frames, pattern); view++)
        if (frames_path(frames, &frame, pattern, view, path, sizeof path))
          output_names_add_image(names, path, true, render->channels.bits);
    }
    const Outputs *denoised = &render->denoised.outputs;
    if (denoised->count &&
        frames_path(frames, &frame, denoised->paths[0], 0, path, sizeof path))
      output_names_add_image(names, path, true, false);
    for (int view = 0; view < frames->views && frames->films; view++)
      if (frames_path(frames, &frame, frames->films->path, view, path, sizeof path))
        output_names_add(names, path, VL_OUTPUT_FILM);
  }
}

/* Checks that no file which this command writes is one that it has read, and that no two are
 * the same. */
static int check_outputs(const Render *render) {
  OutputNames names = {.frames = render->many};
  if (render->many)
    add_frames(render, &names);
  for (int i = 0; i < render->outputs.count && !render->many; i++)
    output_names_add_image(&names, render->outputs.paths[i], true, render->channels.bits);
  if (render->film_plan.path && !render->many)
    output_names_add(&names, render->film_plan.path, VL_OUTPUT_FILM);
  if (denoised_is_copy(&render->denoised) && !render->many)
    output_names_add_image(&names, render->denoised.outputs.paths[0], true, false);
  return output_names_check(&names, render->context);
}

/* Checks before the render for outputs that could not be written after it. */
static int check_sizes(const Render *render) {
  const vlFilmDef *film = &render->job.defs->film;
  uint32_t width = crop_width(film->crop), height = crop_height(film->crop);
  for (int i = 0; i < render->outputs.count; i++) {
    uint32_t max = output_largest_side(render->outputs.paths[i]);
    if (width > max || height > max)
      return report_usage(
          "output \"%s\": %u x %u pixels, this format holds at most %u each way",
          render->outputs.paths[i], width, height, max);
  }
  vlFilm *film_made = NULL; /* memory is allocated by the first pass */
  const int status = job_make_film(&render->job, &film_made);
  vl_film_destroy(film_made);
  return status;
}

/* A trajectory is metered by its first frame, so a part without that frame cannot be
 * metered. */
static int check_metering(const Outputs *outputs, const Arguments *arguments) {
  const OptionValue *v = arguments->values;
  const bool shard = v[RENDER_SHARD].given;
  if (!outputs->meter || !v[RENDER_TRAJECTORY].given ||
      !(shard || v[RENDER_SKIP_EXISTING].given))
    return -1;
  for (int i = 0; i < outputs->count; i++)
    if (output_is_display(outputs->paths[i]))
      return report_usage(
          "output \"%s\": the first frame would set the exposure: with %s give --exposure EV",
          outputs->paths[i], shard ? "--shard" : "--skip-existing");
  return -1;
}

/* Meters a model before the render, so that neither noise nor the crop nor a part of the work
 * changes its exposure. A trajectory is metered by its first frame, rendered here or not. */
static int meter_model(Render *render, const Arguments *arguments) {
  const OptionValue *v = arguments->values;
  Outputs *outputs = &render->outputs;
  const bool wanted = outputs->meter || !v[RENDER_EXPOSURE].given;
  /* the threshold of --noise is of display values, also in parts without an image */
  const bool eight_bit = outputs_any(outputs, output_is_display) || v[RENDER_NOISE].given;
  if (!render->opening.model || !eight_bit || !wanted || v[RENDER_DRY_RUN].given)
    return -1;
  const vlCamera *camera = &render->job.camera;
  vlCamera first;
  vlError error = {0};
  if (render->many) {
    const Frame frame = frames_first(&render->frames);
    if (frames_camera(&render->frames, &frame, 0, &first, &error) != VL_OK)
      return -1; /* the render reports it */
    camera = &first;
  }
  bool given = outputs->meter || render->opening.lamps;
  outputs->meter = false;
  if (outputs->shared && !isnan(*outputs->shared)) {
    outputs->exposure = *outputs->shared;
    return -1;
  }
  int status = exposure_meter_model(render->context, render->scene, render->world, camera,
                                    render->job.defs, given ? 0 : 1, &outputs->exposure);
  if (status < 0 && outputs->shared)
    *outputs->shared = outputs->exposure;
  if (status < 0 && (given || outputs->exposure != 0))
    exposure_tell(outputs->exposure);
  return status;
}

/* Opens the scene, or takes that of the frame before. */
static int open_scene(Render *render, const char *path, const Arguments *arguments) {
  AnimateShared *shared = render->shared;
  const bool silent = render->videos && render->videos->shown.done;
  if (shared && shared->scene) {
    render->scene = shared->scene;
    render->opening = shared->opening;
    render->opening.silent = silent;
    *vl_scene_defs(render->scene) = shared->defs;
    scene_turn(&render->opening, arguments, vl_scene_defs(render->scene));
    return -1;
  }
  render->opening.silent = silent;
  render->opening.images_only = near_is_allowed(arguments);
  int status = scene_open(render->context, path, arguments, &render->scene, &render->opening);
  if (status < 0 && shared && shared->still) {
    shared->scene = render->scene;
    shared->opening = render->opening;
    shared->opening.metered = NULL;
    shared->defs = *vl_scene_defs(render->scene);
  }
  return status;
}

/* Builds the world, or takes that of the frame before. */
static int build_world(Render *render, const char *path) {
  AnimateShared *shared = render->shared;
  vlError error = {0};
  if (shared && shared->still && shared->world) {
    render->world = shared->world;
    render->job.world = shared->world;
    return -1;
  }
  vlBuildDef *build = &render->job.defs->build;
  build->previous = shared && shared->world ? shared->world : render->opening.metered;
  vlResult result = vl_world_build_last(render->scene, build, &render->world, &error);
  build->previous = NULL;
  scene_opening_close(&render->opening);
  TRY(report_error(&error, result, path));
  render->job.world = render->world;
  if (shared) {
    vl_world_destroy(shared->world);
    shared->world = render->world;
  }
  return -1;
}

static bool film_name(const Render *render, const char *pattern, int view, char *path,
                      size_t size) {
  if (!render->many)
    return snprintf(path, size, "%s", pattern) < (int)size;
  const Frame frame = frames_at(&render->frames, 0);
  return frames_path(&render->frames, &frame, pattern, view, path, size);
}

/* Locks the film files, and opens the films that are there. */
static int claim_films(Render *render, const Arguments *arguments) {
  FilmPlan *plan = &render->film_plan;
  if (!plan->path || arguments->values[RENDER_DRY_RUN].given)
    return -1;
  int status = -1, views = render->many ? render->frames.views : 1;
  for (int view = 0; view < views && status < 0; view++) {
    char path[4096], from[4096];
    if (!film_name(render, plan->path, view, path, sizeof path) ||
        !film_name(render, plan->from ? plan->from : "", view, from, sizeof from))
      return report_failure(STATUS_IO, "%s: the file's name is too long", plan->path);
    if (render->many && access(from, F_OK) != 0)
      *from = 0; /* an eye that was not begun */
    status = film_claim(&plan->claims[view], render->context, path, from, plan->overwrite);
  }
  if (status >= 0 || render->many)
    return status;
  film_claim_take(&plan->claims[0], &render->job.defs->film);
  plan->whole.film.errors = render->job.defs->film.errors;
  return -1;
}

static int load_frames(Render *render, const Arguments *arguments) {
  render->frames.films = render->film_plan.path ? &render->film_plan : NULL;
  TRY(frames_load(&render->frames, &render->job, arguments));
  const Frames *frames = &render->frames;
  const Outputs *denoised = &render->denoised.outputs;
  if (render->videos)
    videos_range(render->videos, &frames->range);
  TRY(frames_check_names(frames, &render->outputs));
  TRY(frames_check_names(frames, denoised));
  TRY(check_metering(&render->outputs, arguments));
  return denoised->count ? check_metering(denoised, arguments) : -1;
}

static int load_and_build(Render *render, const char *path, const Arguments *arguments) {
  double start = monotonic_seconds();
  const bool kept = render->shared && render->shared->scene;
  start_receipt(render, arguments);
  TRY(open_scene(render, path, arguments));
  double loaded = monotonic_seconds();

  TRY(job_make(&render->job, render->context, render->scene, path, arguments));
  warn_of_alpha(render);
  if (render->outputs.count == 0 && !render->film_plan.path) {
    choose_output(render, path, render->job.defs->output, default_suffix(render, arguments));
    record_files(render, arguments);
    TRY(outputs_check_folders(&render->outputs));
  }
  first_image_plan(render, arguments);
  TRY(denoised_check(&render->denoised, render->context));
  TRY(check_sizes(render));
  channels_take(&render->channels, &render->job);
  warn_of_channels(render);
  TRY(channels_load(&render->channels, render->context, &render->job));
  render->job.defs->film.errors =
      ((render->channels.bits & VL_CHANNEL_ERROR || render->channels.gbuffer) &&
       (run_has_layers(render) || render->film_plan.path)) ||
      render->denoised.outputs.count;
  noise_apply(arguments, &render->outputs, render->job.defs);
  if (render->resumed.file && job_sequence_is_planned(&render->job, arguments))
    render->job.defs->render.sequence = vl_film_file_sequence(render->resumed.file);
  render->film_plan.whole = *render->job.defs;
  TRY(shard_apply(arguments, &render->job.defs->film, &render->job.defs->render));
  render->many = frames_wanted(arguments, &render->job);
  if (render->many && render->videos && render->job.defs->camera.stereo.mode != VL_STEREO_NONE)
    return report_usage("output \"%s\": a video is of one eye", render->videos->paths[0]);
  render->outputs.video = render->videos ? render->videos->paths[0] : NULL;
  if (render->many && arguments->values[RENDER_SERVE].given)
    return report_usage("--serve goes with one image");
  if (render->many && render->denoised.outputs.count &&
      render->job.defs->camera.stereo.mode != VL_STEREO_NONE)
    return report_usage("--denoise does not go with two eyes; velo image denoise does");
  if (render->many) {
    TRY(load_frames(render, arguments));
    render->denoised.steady = &render->frames.steady;
  }
  TRY(needs_check_render_scene(render, arguments));
  TRY(claim_films(render, arguments));
  race_plan(render, arguments);
  TRY(build_world(render, path));
  vl_context_record_files(render->context, false);
  if (arguments->values[RENDER_VERBOSE].given && !kept)
    report_note("loaded in %.3f s, built in %.3f s, %sB held; %u threads, %s", loaded - start,
                monotonic_seconds() - loaded,
                format_count((double)vl_context_memory(render->context, NULL)).text,
                vl_context_threads(render->context), context_isa_name(render->context));
  return -1;
}

/* Checked before the render, so that it does not run out of memory after hours. */
static int reckon_memory(Render *render, const Arguments *arguments) {
  const OptionValue *limit = &arguments->values[RENDER_MAX_MEMORY];
  uint64_t max = (uint64_t)limit->integer;
  memory_plan(&render->memory, &render->job, &render->outputs, &render->channels,
              render->many ? &render->frames : NULL);
  if (render->denoised.outputs.count)
    memory_add(&render->memory, "denoising", denoised_memory(run_pixels(render)));
  if (render->denoised.steady && render->denoised.outputs.count)
    memory_add(&render->memory, "frames before", steady_memory(run_pixels(render)));
  if (report_is_json())
    memory_report_json(&render->memory, max);
  if (arguments->values[RENDER_VERBOSE].given) {
    char list[400];
    memory_list(&render->memory, list, sizeof list);
    report_note("memory: %sB are needed: %s", format_count((double)render->memory.total).text,
                list);
  }
  return memory_check(&render->memory, max);
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
      return report_usage(
          "--again: the images of a rig are made again by the command in the receipt");
  }
  /* several images have different cameras; the files and the command determine them */
  return again_check(&render->again, &render->receipt, job, &which, !render->many);
}

/* Frees what a frame does not leave to the next one. */
static void free_render(Render *render) {
  AnimateShared *shared = render->shared;
  serve_stop(render->serve);
  frames_free(&render->frames);
  channels_free(&render->channels);
  film_keeper_free(&render->keeper);
  for (int i = 0; i < 2; i++)
    film_claim_release(&render->film_plan.claims[i]);
  vl_film_destroy(render->film);
  if (!shared)
    vl_world_destroy(render->world);
  scene_opening_close(&render->opening);
  if (!shared || render->scene != shared->scene)
    vl_scene_destroy(render->scene);
  report_memory_of(NULL, 0);
  if (!shared)
    context_close(render->context);
  if (shared)
    shared->context = render->context;
  again_close(&render->again);
  continue_close(&render->resumed);
}

/* Loads the scene, checks the outputs, and renders. Returns the exit code. */
static int load_and_render(Render *render, const Arguments *arguments) {
  const AnimateShared *shared = render->shared;
  Outputs *outputs = &render->outputs;
  Job *job = &render->job;
  if (arguments->operand_count == 0)
    return options_too_few(arguments->command);
  TRY(prepare(render, arguments));
  TRY(load_and_build(render, arguments->operands[0], arguments));
  TRY(check_outputs(render));
  if (!render->many)
    TRY(lens_autofocus(job, render->scene, render->world));
  TRY(race_run(render, arguments));
  TRY(needs_check_render_tracer(render, arguments));
  TRY(reckon_memory(render, arguments));
  TRY(meter_model(render, arguments));
  if (shared && shared->preparing)
    return STATUS_OK;
  TRY(noise_expose(outputs, render->many, &job->defs->render, &render->film_plan.whole.render));
  if (render->again.receipt)
    TRY(check_again(render));
  const uint32_t count = render->many ? frames_count(&render->frames) : 1;
  if (arguments->values[RENDER_DRY_RUN].given) {
    job_describe(job, render->scene, render->denoised.replaces, outputs->paths, outputs->count);
    if (count > 1)
      report_note("%u frames%s", count, render->frames.views == 2 ? ", two eyes each" : "");
    return STATUS_OK;
  }
  return render->many ? frames_render(&render->frames, render->context, render->world, outputs,
                                      &render->channels, &render->denoised)
                      : run_image(render);
}

/* shared: what the frames of an animation have in common; null: this is one image. videos: what
 * becomes of the frames; may be null. */
static int render_once(const Arguments *arguments, AnimateShared *shared, Videos *videos) {
  Render render;
  memset(&render, 0, sizeof render);
  render.start = monotonic_seconds();
  render.shared = shared;
  render.videos = videos;
  render.outputs.shared = shared ? &shared->exposure : NULL;
  render.context = shared ? shared->context : NULL;
  set_up_reports(arguments);
  int status = again_open(&render.again, &arguments);
  if (status < 0)
    status = continue_open(&render.resumed, &arguments);
  if (status < 0)
    status = load_and_render(&render, arguments);
  free_render(&render);
  return status;
}

static int render_all(const Arguments *arguments, Videos *videos) {
  if (arguments->operand_count && animate_wanted(arguments))
    return animate_run(arguments, videos, render_once);
  return render_once(arguments, NULL, videos);
}

static int run_render(const Arguments *arguments, UNUSED vlContext *unused) {
  if (blend_wanted(arguments)) {
    set_up_reports(arguments);
    return blend_run(arguments);
  }
  if (!videos_wanted(arguments))
    return render_all(arguments, NULL);
  Videos videos;
  Arguments frames;
  set_up_reports(arguments);
  TRY(videos_plan(&videos, arguments, &frames));
  return videos_finish(&videos, arguments, render_all(&frames, &videos));
}

const Command render_command = {
    .name = "render",
    .usage = "FILE [options]",
    .summary = "render a scene: .pbrt .gltf .glb .obj .ply .stl .off",
    .text =
        "Renders FILE. Options override the settings in the file. After the first pass, and "
        "then about every\n"
        "ten seconds, the unfinished image is written to NAME.part.EXT; at the end it becomes "
        "NAME.EXT.\n"
        "A .blend file is rendered by Blender, where it is installed (docs/blender.md).\n"
        "Ctrl-C ends the render; the samples so far are in NAME.part.EXT, and in the film "
        "file of --film,\n"
        "which the same command again continues, or --continue.",
    .examples =
        "velo render room.pbrt -o room.exr -o room.png --spp 256\n"
        "velo render model.glb --resolution 1280x720 --time 5m -o model.png",
    .options = render_options,
    .sections = render_sections,
    .brief =
        "  velo render room.pbrt -o room.png              as the scene's file says\n"
        "  velo render model.glb --resolution 1280x720 --time 5m -o model.png\n"
        "  velo render room.pbrt --spp 256 -o room.exr -o room.png\n"
        "  velo render room.pbrt --noise 1% --film room.film -o room.exr  stop, go on\n"
        "\n"
        "  -o, --output FILE       .exr .hdr .pfm (linear), .png .jpg .tga (display); "
        "several\n"
        "      --spp N             samples per pixel\n"
        "      --time TIME         time limit: 30s, 5m, 1h30m\n"
        "      --noise PERCENT     sample until the noise is below this, such as 1%\n"
        "      --resolution WxH    image size in pixels\n"
        "      --denoise FILE      also write a denoised copy\n"
        "      --film FILE         keep the samples; the same command again goes on\n"
        "      --channels LIST     depth, normals, ids and more in the .exr\n"
        "      --exposure EV       brightness of .png and .jpg in stops, or auto\n"
        "      --environment NAME  light of a model: studio, window, evening, sky ...\n"
        "      --camera FILE       another camera; --trajectory FILE: many poses\n"
        "  -t, --threads N         default: all processors\n"
        "\n"
        "Options override the settings in the file. Ctrl-C ends the render and keeps\n"
        "the image so far.",
    .optional_operands = 1, /* --again and --continue need none */
    .run = run_render,
};
