/* render/frames_render.c: renders the frames one after the other. A failed frame does not stop
 * the rest; the exit code reports it. */
#include <stdio.h>
#include <string.h>

#include "cli/macros.h"
#include "cli/report.h"
#include "cli/signals.h"
#include "render/continue.h"
#include "render/frame_writer.h"
#include "render/lens_options.h"
#include "render/progress.h"
#include "render/run.h"

typedef struct Run {
  Frames *frames;
  vlContext *context;
  const vlWorld *world;
  const Outputs *outputs;
  const Channels *channels; /* what is wanted; layers are empty */
  bool layers;              /* whether some file holds layers */
  Denoised *denoised;       /* its outputs may be empty */
  Progress progress;        /* of one image */
  FrameProgress shown;      /* of all */
  uint32_t number;          /* of the frame that is rendered */
  vlFilm *film;             /* of the view that is rendered */
  FilmKeeper keeper;
  int kept; /* exit code of the first film that could not be written */
  vlRenderStats total;
} Run;

static bool on_progress(void *user, const vlProgress *now) {
  Run *run = user;
  if (run->shown.count == 1)
    progress_show(&run->progress, now);
  else
    progress_show_frames(&run->shown, run->number, now->fraction);
  if (now->pass_done && now->spp_done < now->spp_total && !signals_pending())
    film_keeper_checkpoint(&run->keeper, run->film);
  return !signals_pending();
}

/* Text that names the frame in messages. */
static void frame_name(const Run *run, const Frame *frame, char *text, size_t size) {
  if (!run->frames->trajectory)
    snprintf(text, size, "%s", frame->camera->job.path);
  else
    snprintf(text, size, "frame %u%s%s%s", frame->number, *frame->pose.name ? " (" : "",
             vl_short_text(frame->pose.name).text, *frame->pose.name ? ")" : "");
}

static void add_stats(vlRenderStats *total, const vlRenderStats *more) {
  if (!total->not_finite) {
    total->worst_x = more->worst_x;
    total->worst_y = more->worst_y;
  }
  total->spp = more->spp;
  total->paths += more->paths;
  total->camera_rays += more->camera_rays;
  total->bounce_rays += more->bounce_rays;
  total->shadow_rays += more->shadow_rays;
  total->not_finite += more->not_finite;
}

/* Returns -1, or the exit code after reporting the error. */
static int develop(const Job *job, const vlFilm *film, vlImage **image) {
  return report_reason(vl_film_develop(film, &job->defs->develop, image), job->path,
                       "the image cannot be made of the film");
}

/* Gets the film of a view. It is the camera's film, cleared, or the film to continue, which the
 * caller then frees. own null: only checks the film to continue. */
static int open_film(Run *run, const Frame *frame, int view, Job *job, vlFilm **own) {
  const FilmPlan *plan = run->frames->films;
  const char *name = run->frames->view_names[view];
  if (own)
    vl_film_clear(frame->camera->film);
  run->film = frame->camera->film;
  if (!plan)
    return -1;
  int status = film_keeper_start(&run->keeper, plan, view, job, *name ? name : NULL);
  if (status < 0)
    status = continue_film(&plan->claims[view], plan->receipt->arguments, run->keeper.receipt,
                           run->context, job->defs, own);
  if (own && *own)
    run->film = *own;
  return status;
}

/* Renders the film of a view and develops it, also that of a render that stopped early. */
static int render_film(Run *run, const char *name, int view, Job *job, FrameImage *image) {
  vlError error = {0};
  vlRenderStats stats = {0};
  vlResult result =
      vl_render(run->world, &job->camera, run->film, &job->defs->render, &stats, &error);
  add_stats(&run->total, &stats);
  int status = result == VL_CANCELLED ? signals_status() : report_finish(&error, result, name);
  image->spp = vl_film_spp(run->film);
  if (!image->spp)
    return status;
  run->kept = first_failure(run->kept, film_keeper_finish(&run->keeper, run->film));
  TRY(develop(job, run->film, &image->images[view]));
  if (status == STATUS_OK && run->denoised->outputs.count)
    status = denoised_make(run->denoised, job, run->film, &image->clean);
  if (status != STATUS_OK)
    return status;
  image->channels[view] = *run->channels;
  return run->layers && !run->frames->steady.only_kept
             ? channels_render(&image->channels[view], job, run->film)
             : STATUS_OK;
}

/* Makes the job of a view, with its camera. */
static int make_view(Run *run, const Frame *frame, int view, Job *job) {
  char name[200];
  vlError error = {0};
  *job = frame->camera->job;
  job->world = run->world;
  frame_name(run, frame, name, sizeof name);
  TRY(report_error(&error, frames_camera(run->frames, frame, view, &job->camera, &error),
                   name));
  return lens_autofocus(job, NULL, run->world);
}

/* Checks the films of both eyes before the first is rendered. */
static int check_films(Run *run) {
  const Frame frame = frames_at(run->frames, 0);
  int status = -1;
  for (int view = 0; view < run->frames->views && run->frames->films && status < 0; view++) {
    Job job;
    status = make_view(run, &frame, view, &job);
    vlSceneDefs defs = *job.defs; /* continuing changes them */
    job.defs = &defs;
    if (status < 0)
      status = open_film(run, &frame, view, &job, NULL);
    film_keeper_free(&run->keeper);
  }
  return status;
}

/* Renders one eye's image and channels. When interrupted: 128 + signal, with an image if a
 * whole pass is done. */
static int render_view(Run *run, const Frame *frame, int view, FrameImage *image) {
  char name[200];
  vlFilm *own = NULL;
  Job *job = &image->jobs[view];
  frame_name(run, frame, name, sizeof name);
  TRY(make_view(run, frame, view, job));
  job->defs->render.progress = on_progress;
  job->defs->render.progress_user = run;
  int status = open_film(run, frame, view, job, &own);
  if (status < 0)
    status = render_film(run, name, view, job, image);
  film_keeper_free(&run->keeper);
  vl_film_destroy(own);
  return status;
}

/* Keeps a frame that was interrupted, or whose ground truth or denoised copy cannot be made,
 * for NAME.part.EXT. An eye that was not begun is black. */
static bool keep_stopped(Run *run, FrameImage *image) {
  if (!image->images[0])
    return false;
  for (int v = 1; v < run->frames->views; v++) {
    if (image->images[v])
      continue;
    vlFilm *film = image->frame.camera->film;
    image->jobs[v] = image->jobs[0];
    vl_film_clear(film);
    if (develop(&image->jobs[v], film, &image->images[v]) >= 0)
      return false;
  }
  return image->stopped = true;
}

/* What render_kept needs. */
typedef struct Earlier {
  Run *run;
  Frame frames[STEADY_BEFORE];
} Earlier;

/* A SteadyRender. */
static int render_kept(void *user, uint32_t k) {
  const Earlier *earlier = user;
  FrameImage image;
  memset(&image, 0, sizeof image);
  const int status = render_view(earlier->run, &earlier->frames[k], 0, &image);
  frame_image_free(&image);
  return status;
}

static int render_before(Run *run, const Frame *frame) {
  Steady *s = &run->frames->steady;
  Earlier earlier = {.run = run};
  s->count = frames_before(run->frames, frame, earlier.frames);
  for (uint32_t k = 0; k < s->count; k++)
    s->before[k] = earlier.frames[k].number;
  return steady_prepare(s, frame->number, render_kept, &earlier);
}

/* Renders all views of a frame. */
static int render_frame(Run *run, FrameImage *image) {
  int code = run->denoised->outputs.count ? render_before(run, &image->frame) : STATUS_OK;
  for (int v = 0; v < run->frames->views && code == STATUS_OK; v++) {
    progress_start(&run->progress, image->frame.camera->job.defs->render.time_limit);
    code = render_view(run, &image->frame, v, image);
  }
  return code;
}

/* Whether the frame's files are there already, with --skip-existing. */
static bool is_left_out(const Run *run, const Frame *frame) {
  return run->frames->skip_existing && frames_exist(run->frames, frame, run->outputs) &&
         frames_exist(run->frames, frame, &run->denoised->outputs);
}

static void report_end(const Run *run, uint32_t written, int status) {
  double seconds = monotonic_seconds() - run->shown.start;
  const vlRenderStats *t = &run->total;
  report_not_finite(t);
  if (report_is_json()) {
    Json *json = report_json_begin("result");
    json_put(json, "status %d, frames %u, written %u, spp %u, seconds %g", status,
             run->shown.count, written, t->spp, seconds);
    json_render_stats(json, t);
    report_json_end(json);
    return;
  }
  const Outputs *outputs = run->outputs;
  const char *what = "kept in films", *path = "", *more = "";
  if (outputs->video) {
    what = "for ";
    path = outputs->video;
  } else if (outputs->count && written) {
    what = "wrote ";
    path = outputs->paths[0];
    more = outputs->count > 1 ? ", ..." : "";
  } else if (outputs->count) {
    what = "no image is written";
  }
  report_note("%u of %u frames%s in %s, %u spp, %s paths/s; %s%s%s", written, run->shown.count,
              run->frames->views == 2 ? " (two eyes)" : "", format_seconds(seconds).text,
              t->spp, format_count(seconds > 0 ? (double)t->paths / seconds : 0).text, what,
              path, more);
}

int frames_render(Frames *frames, vlContext *context, const vlWorld *world,
                  const Outputs *outputs, const Channels *channels, Denoised *denoised) {
  Run run = {.frames = frames,
             .context = context,
             .world = world,
             .outputs = outputs,
             .channels = channels,
             .denoised = denoised,
             .layers = outputs_any(outputs, output_holds_layers),
             .shown = progress_frames(frames_count(frames))};
  TRY(check_films(&run));
  FrameWriter *writer = frame_writer_start(context, frames, outputs, &denoised->outputs);
  if (!writer)
    return report_no_memory();
  signals_remember();
  int status = STATUS_OK;
  const uint32_t all = run.shown.count;
  for (uint32_t i = 0; i < all && status < 128; i++) {
    if (signals_pending())
      status = signals_status();
    if (status >= 128)
      break;
    FrameImage image;
    memset(&image, 0, sizeof image);
    image.frame = frames_at(frames, i);
    if (is_left_out(&run, &image.frame)) {
      run.shown.count--;
      continue;
    }
    run.number = image.frame.number;
    if (run.shown.count > 1)
      progress_show_frames(&run.shown, run.number, 0);
    int code = render_frame(&run, &image);
    if (code == STATUS_OK || keep_stopped(&run, &image))
      frame_writer_put(writer, &image);
    else
      frame_image_free(&image);
    if (code != STATUS_OK && (status == STATUS_OK || code >= 128))
      status = code;
    run.shown.done++;
  }
  uint32_t written;
  int code = frame_writer_finish(writer, &written);
  report_status_line(NULL);
  if (status < 128 && code != STATUS_OK)
    status = code;
  status = first_failure(status, run.kept);
  if (run.shown.count < all)
    report_note("%u frames exist and were left out", all - run.shown.count);
  if (status >= 128)
    report_note("interrupted; %u of %u frames are written", written, run.shown.count);
  report_end(&run, written, status);
  return status;
}
