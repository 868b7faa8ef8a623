/* render/render.c: vl_render: prepares world, camera and film, runs the passes over the image
 * and reports their progress. A pass goes over blocks of tiles (block.h). */
#include <math.h>
#include <string.h>

#include "base/context.h"
#include "base/cookie.h"
#include "base/error.h"
#include "base/file.h"
#include "camera/parts.h"
#include "render/block.h"
#include "render/support.h"
#include "schema/schema.h"
#include "velo/focus.h"
#include "velo/schema.h"
#include "velo/trace.h"
#include "velo/tracer.h"

enum { MAX_PASS = 16, PASS_SECONDS = 5 };
static const double NEARLY = 0.97; /* share of the time limit after which no new pass begins */

static void count_rays(const vlRenderRun *r, uint64_t *paths, uint64_t *rays) {
  *paths = *rays = 0;
  for (uint32_t i = 0; i < vl_context_threads(r->world->context); i++) {
    const vlRenderWorker *w = &r->workers[i];
    *paths += w->paths;
    *rays += w->paths + w->bounce_rays + w->shadow_rays;
  }
}

/* Reports the progress to the caller's callback. False: the callback asks to stop. Only on the
 * thread that called vl_render. work: as in vlRenderRun. In render.c. */
static bool report(vlRenderRun *r, bool pass_done, double work) {
  if (!r->def->progress)
    return true;
  vlProgress p;
  memset(&p, 0, sizeof p);
  double total = r->work_total - r->work_before;
  p.spp_done = vl_film_spp(r->film);
  p.spp_total = r->def->spp > r->sequence.first ? r->def->spp - r->sequence.first : 0;
  p.elapsed = vl_seconds() - r->start;
  p.fraction = total > 0 ? fmin(1, (work - r->work_before) / total) : 1;
  p.remaining = p.fraction > 0 ? p.elapsed * (1 - p.fraction) / p.fraction : INFINITY;
  if (r->def->time_limit > 0 && p.elapsed + p.remaining > r->def->time_limit) {
    p.remaining = fmax(0, r->def->time_limit - p.elapsed);
    p.fraction = fmax(p.fraction, fmin(1, p.elapsed / r->def->time_limit));
  }
  p.pass_done = pass_done;
  p.rows = pass_done ? vl_adaptive_rows(&r->adaptive) : 0;
  count_rays(r, &p.paths, &p.rays);
  return r->def->progress(r->def->progress_user, &p);
}

/* The callback during a pass: reports progress; true: stop. */
static bool ask_to_stop(void *user) {
  vlRenderRun *r = user;
  double share = (double)atomic_load(&r->blocks_done) / vl_render_block_count(r);
  return !report(r, false, r->work_done + share * r->work_pass);
}

/* The names of the caller's own code; all are checked. */
static vlFilmOwn own_names(const vlCamera *camera, const vlRenderDef *def) {
  vlFilmOwn own = {0};
  if (camera->own)
    memcpy(own.name[VL_OWN_CAMERA], camera->own->name, strlen(camera->own->name));
  if (def->own_sampler)
    memcpy(own.name[VL_OWN_SAMPLER], def->own_sampler->name, strlen(def->own_sampler->name));
  if (def->own_tracer)
    memcpy(own.name[VL_OWN_TRACER], def->own_tracer->name, strlen(def->own_tracer->name));
  return own;
}

vlResult vl_render_def_check(const vlRenderDef *def, const char *what, vlError *error) {
  char wrong[VL_GIVEN_MESSAGE];
  if (def->cookie != VL_COOKIE_RENDER)
    return vl_fail_argument(error, "%s: " VL_BAD_COOKIE, what);
  if (!vl_choices_check(VL_SETTING_RENDER, offsetof(vlSceneDefs, render), sizeof *def, def,
                        wrong))
    return vl_fail_argument(error, "%s: %s", what, wrong);
  return VL_OK;
}

vlResult vl_render_check(const vlWorld *world, const vlCamera *camera, vlFilm *film,
                         const vlRenderDef *def, vlError *error) {
  if (!world || !camera || !film)
    return vl_fail_argument(error, "render: world, camera or film is null");
  VL_TRY(vl_render_def_check(def, "render", error));
  const vlFilmDef *f = vl_film_def(film);
  if (camera->width != f->width || camera->height != f->height)
    return vl_fail_argument(error, "render: camera (%u x %u) and film (%u x %u) differ",
                            camera->width, camera->height, f->width, f->height);
  if (f->buckets && world->def.color == VL_COLOR_RGB)
    return vl_fail_argument(error, "render: a world in RGB has no spectra for the film");
  uint32_t length = vl_film_sequence(film).length;
  if (def->sequence && length && def->sequence != length)
    return vl_fail_argument(error,
                            "render: the film's samples are of a sequence of %u, not of %u",
                            length, def->sequence);
  vlResult result = VL_OK;
  if (def->own_sampler)
    result = vl_own_check("sampler", def->own_sampler->name, def->own_sampler->numbers != NULL,
                          error);
  if (result == VL_OK && def->own_tracer)
    result =
        vl_own_check("tracer", def->own_tracer->name, def->own_tracer->radiance != NULL, error);
  if (result != VL_OK)
    return result;
  vlFilmOwn own = own_names(camera, def);
  vlFilmSequence sequence = vl_film_sequence(film);
  vlOwnKind kind = length ? vl_film_own_differs(&sequence.own, &own) : VL_OWN_KINDS;
  if (kind < VL_OWN_KINDS)
    return vl_fail_argument(
        error, "render: the film's samples are of the own %s \"%s\", not of \"%s\"",
        vl_own_words[kind], vl_short_text(sequence.own.name[kind]).text,
        vl_short_text(own.name[kind]).text);
  if (sequence.uneven)
    return vl_fail_argument(error,
                            "render: the film's pixels do not all have the same samples");
  if (!(def->noise >= 0) ||
      (def->noise > 0 && (!f->errors || !(def->noise_scale > 0) || def->first_sample)))
    return vl_fail(
        error, VL_ERROR_ARGUMENT,
        "render: noise %g needs a film with errors, a noise_scale above 0, and samples "
        "from the first on",
        def->noise);
  if (def->max_depth > 4096)
    return vl_fail_argument(error, "render: max_depth %u is above 4096", def->max_depth);
  if (!vl_is_unset(def->merge_radius) && !(def->merge_radius > 0 && def->merge_radius <= 3e38))
    return vl_fail_argument(error, "render: merge_radius %g is not a radius",
                            def->merge_radius);
  if (def->light_paths != VL_AS_MANY_AS_PIXELS && def->light_paths > VL_MAX_LIGHT_PATHS)
    return vl_fail_argument(error, "render: light_paths %u is above %u", def->light_paths,
                            VL_MAX_LIGHT_PATHS);
  return VL_OK;
}

static size_t grids_size(void) {
  return vl_whole_lines(VL_SHARED_SAMPLES * sizeof(vlSharedGrid));
}

uint64_t vl_render_memory(const vlWorld *world, const vlFilmDef *film, const vlRenderDef *def) {
  size_t rows = vl_whole_lines((size_t)VL_RENDER_ROWS * VL_ROW_SIZE * sizeof(float));
  uint64_t each = vl_whole_lines(vl_trace_scratch_size(world)) + rows +
                  (vl_shares_samples(film, def) ? grids_size() : 0);
  uint64_t bytes = vl_context_threads(world->context) * each;
  return vl_two_way_tracer(def->tracer) ? bytes + vl_two_way_memory(world, film, def) : bytes;
}

/* Workers' memory is one block that the film keeps (vl_film_scratch), so that many small
 * renders in a row need no new memory. */
static vlResult make_workers(vlRenderRun *r, vlContext *context, vlError *error) {
  uint32_t threads = vl_context_threads(context);
  size_t head = vl_whole_lines(threads * sizeof *r->workers),
         scratch = vl_whole_lines(vl_trace_scratch_size(r->world));
  size_t rows = vl_whole_lines((size_t)VL_RENDER_ROWS * VL_ROW_SIZE * sizeof(float));
  size_t grids = r->shares ? grids_size() : 0;
  char *block = vl_film_scratch(r->film, head + threads * (scratch + rows + grids));
  if (!block)
    return vl_fail_memory(error);
  r->workers = (vlRenderWorker *)(void *)block;
  memset(block, 0, head);
  for (uint32_t i = 0; i < threads; i++) {
    char *own = block + head + i * (scratch + rows + grids);
    r->workers[i].scratch = (vlTraceScratch *)(void *)own;
    vl_trace_scratch_begin(r->workers[i].scratch, r->world);
    r->workers[i].rows = (float *)(void *)(own + scratch);
    if (grids)
      r->workers[i].grids = (vlSharedGrid *)(void *)(own + scratch + rows);
  }
  return VL_OK;
}

static bool is_limited(const vlRenderDef *def) {
  return def->max_diffuse_depth || def->max_glossy_depth || def->max_transmission_depth ||
         def->max_volume_depth;
}

/* The tracer that is used: volpath in place of one that lacks something of the scene
 * (support.c). */
static vlTracer tracer_of(vlRenderRun *r, const vlCamera *camera) {
  const vlWorld *world = r->world;
  vlTracer tracer = r->def->tracer;
  if (r->def->own_tracer)
    return VL_TRACER_PATH; /* no light paths */
  if (tracer == VL_TRACER_BIDIRECTIONAL && r->def->light_paths == 0)
    return VL_TRACER_VOLPATH;
  const vlKindRow *row = vl_kind_row(vl_kind_family_find("tracers"), (int)tracer);
  const bool unlimited =
      row && vl_row_find(row, "maxdepth") && !vl_row_find(row, "maxdiffusedepth");
  const char *lack = is_limited(r->def) && unlimited ? "limits of one kind of bounces" : NULL;
  if (!lack && world->has_subsurface &&
      (tracer == VL_TRACER_PATH || tracer == VL_TRACER_RANDOM_WALK))
    vl_log(world->context, VL_LOG_WARNING, NULL,
           "this tracer renders material \"subsurface\" as clear glass; volpath renders its "
           "scattering");
  if (!lack && !r->raced)
    r->prepared =
        vl_tracers_lack(world, camera, vl_film_def(r->film), VL_TRACER_BIT(tracer), &lack);
  if (!lack)
    return tracer;
  vl_log(world->context, VL_LOG_INFO, NULL,
         "tracer \"%s\" does not support %s: volpath is used", row ? row->name : "?", lack);
  return VL_TRACER_VOLPATH;
}

/* The passes of two-way tracers have one sample; its light paths come first. */
static vlResult prepare_two_way(vlRenderRun *r, const vlCamera *camera, vlError *error) {
  if (!vl_two_way_tracer(r->trace.tracer))
    return VL_OK;
  VL_TRY(vl_two_way_create(r->world, camera, r->film, r->def, &r->trace, &r->film_rays,
                           &r->two_way, error));
  r->trace.two_way = vl_two_way_of(r->two_way);
  for (uint32_t i = 0; i < vl_context_threads(r->world->context); i++)
    vl_two_way_use(r->two_way, i, r->workers[i].scratch);
  return VL_OK;
}

/* Limits of 0 are none. The numbers of the kinds are those of vlBounceKind. */
static void take_limits(const vlRenderDef *def, vlTraceDef *to) {
  const uint32_t limits[VL_BOUNCE_KINDS] = {def->max_diffuse_depth, def->max_glossy_depth,
                                            def->max_transmission_depth, def->max_volume_depth};
  for (int k = 0; k < VL_BOUNCE_KINDS; k++)
    to->max_of_kind[k] = limits[k] ? limits[k] : VL_NONE;
  to->limited = is_limited(def);
}

void vl_render_prepare(vlRenderRun *r, const vlCamera *camera) {
  const vlWorld *world = r->world;
  const vlFilmDef *f = vl_film_def(r->film);
  vlIsa isa = vl_context_isa(world->context);
  vlSampler sampler;
  vl_sampler_init(&sampler, r->def->sampler, r->def->seed, f->width, f->height,
                  r->sequence.length);
  sampler.own = r->def->own_sampler;
  sampler.own_bad = &r->own_bad;
  vl_film_rays_init(&r->film_rays, camera, vl_film_filter(r->film), &sampler, isa);
  vl_film_rays_clock(&r->film_rays, world);
  r->film_rays.centred = r->def->centred;
  r->shares = vl_shares_samples(f, r->def);
  r->film_rays.uniform = r->shares;
  r->exposure_time = (float)camera->exposure_time;
  r->trace_kernels = vl_trace_kernels(isa);
  r->rgb_mode = world->def.color == VL_COLOR_RGB;
  /* Footprints shrink with the samples per pixel (pbrt book 10.1.3 scales by 1/sqrt(spp), at
   * least 1/8). Here the factor is constant, so that more samples refine the same image. */
  const float footprint = r->def->sharp_textures ? 0.0f : 0.25f;
  r->trace =
      (vlTraceDef){.tracer = tracer_of(r, camera),
                   .own = r->def->own_tracer,
                   .sampler = &r->film_rays.sampler,
                   .isa = isa,
                   .cancel = r->def->cancel,
                   .max_depth = r->def->max_depth,
                   .ao_distance = r->def->ao_distance,
                   .ao_cosine = r->def->ao_cosine,
                   .same_wavelengths = r->def->same_wavelengths,
                   .lambda_low = (float)f->lambda_min,
                   .lambda_span = f->buckets ? (float)(f->lambda_max - f->lambda_min) : 0.0f,
                   .pixel_spread = footprint * r->film_rays.camera.pixel_spread,
                   .pixel_width = footprint * r->film_rays.camera.pixel_width};
  take_limits(r->def, &r->trace);
  memcpy(r->crop, f->crop, sizeof r->crop);
  r->tile_x0 = r->crop[0] / VL_RENDER_TILE;
  r->tile_y0 = r->crop[1] / VL_RENDER_TILE;
  r->tiles_x = (r->crop[2] + VL_RENDER_TILE - 1) / VL_RENDER_TILE - r->tile_x0;
  r->tiles_y = (r->crop[3] + VL_RENDER_TILE - 1) / VL_RENDER_TILE - r->tile_y0;
}

/* The number of samples of the next pass, at most `max`. Passes have 1, 1, 2, 4, ... samples,
 * so that a first image exists early. The first pass of a call has one sample, since the time
 * of a sample is not known yet. A pass takes at most PASS_SECONDS, since its work is lost when
 * it is abandoned, and at most half of the remaining time. The split into passes does not
 * change the image. */
static uint32_t pass_size(uint32_t done, uint32_t max, double seconds_per_sample, double left) {
  uint32_t size = done == 0 ? 1 : done < MAX_PASS ? done : MAX_PASS;
  double fit = seconds_per_sample > 0 ? fmin(PASS_SECONDS, 0.5 * left) / seconds_per_sample : 1;
  if (fit < size)
    size = fit > 1 ? (uint32_t)fit : 1;
  return size < max ? size : max;
}

static void fill_stats(const vlRenderRun *r, vlRenderStats *stats) {
  memset(stats, 0, sizeof *stats);
  stats->spp = vl_film_spp(r->film);
  if (r->adaptive.context) {
    stats->mean_spp = vl_adaptive_mean_spp(&r->adaptive);
    stats->noisy_blocks = vl_adaptive_noisy(&r->adaptive);
    stats->blocks = r->adaptive.blocks;
  }
  stats->seconds = vl_seconds() - r->start;
  for (uint32_t i = 0; i < vl_context_threads(r->world->context); i++) {
    const vlRenderWorker *w = &r->workers[i];
    if (w->not_finite && !stats->not_finite) {
      stats->worst_x = (uint32_t)w->bad_x;
      stats->worst_y = (uint32_t)w->bad_y;
    }
    stats->not_finite += w->not_finite;
    stats->paths += w->paths;
    stats->bounce_rays += w->bounce_rays;
    stats->shadow_rays += w->shadow_rays;
  }
  stats->camera_rays = stats->paths;
  stats->own_numbers = atomic_load(&r->own_bad);
  if (!r->two_way)
    return;
  vlTwoWayCounts more = vl_two_way_counts(r->two_way);
  stats->paths += more.paths;
  stats->bounce_rays += more.bounce_rays;
  stats->shadow_rays += more.shadow_rays;
  stats->not_finite += more.not_finite;
}

/* Chooses the blocks and the samples of the next pass. False: there is none. */
static bool choose_pass(vlRenderRun *r, double seconds_per_work, double left) {
  uint32_t total = r->def->spp > r->sequence.first ? r->def->spp - r->sequence.first : 0, first,
           max;
  bool any = vl_adaptive_next(&r->adaptive, total, &first, &max);
  r->work_done = vl_adaptive_mean_spp(&r->adaptive);
  r->work_total = vl_adaptive_expected_spp(&r->adaptive, total);
  if (!any)
    return false;
  double share = (double)r->adaptive.in_pass / r->adaptive.blocks;
  r->first_sample = r->sequence.first + first;
  r->pass_samples = r->two_way ? 1 : pass_size(first, max, share * seconds_per_work, left);
  r->work_pass = share * r->pass_samples;
  return true;
}

/* One pass. *late: it was not finished before the time limit. */
static vlResult render_pass(vlRenderRun *r, bool *late, vlError *error) {
  if (vl_film_begin_pass(r->film) != VL_OK)
    return vl_fail_memory(error);
  vl_film_set_pass_samples(r->film, r->first_sample, r->first_sample + r->pass_samples);
  vlResult result = VL_OK;
  vl_render_choose_blocks(r);
  if (r->two_way)
    vl_two_way_times(r->two_way, r->first_sample, &r->film_rays);
  atomic_store(&r->blocks_done, 0);
  if (r->two_way)
    result = vl_two_way_light(r->two_way, r->first_sample, &r->stop, error);
  if (result == VL_OK)
    vl_parallel_for_at(r->world->context, &r->loop, vl_render_block_count(r), vl_render_block,
                       r);
  if (r->two_way && r->adaptive.in_pass < r->adaptive.blocks)
    vl_two_way_drop_splats(r->two_way);
  *late = atomic_load(&r->stop.late);
  if (result == VL_OK && !atomic_load(&r->stop.stopped) && !vl_is_cancelled(r->def->cancel)) {
    vl_film_commit_pass(r->film);
    return vl_adaptive_end_pass(&r->adaptive, r->pass_samples) == VL_OK ? VL_OK
                                                                        : vl_fail_memory(error);
  }
  vl_film_abandon_pass(r->film);
  if (*late)
    return VL_OK;
  return result == VL_OK || result == VL_CANCELLED ? vl_fail(error, VL_CANCELLED, "stopped")
                                                   : result;
}

static vlResult render_passes(vlRenderRun *r, vlError *error) {
  const vlRenderDef *def = r->def;
  double seconds_per_work = 0; /* of a sample per pixel of the whole film */
  bool late = false;
  r->work_before = vl_adaptive_mean_spp(&r->adaptive);
  for (bool first = true;; first = false) {
    double end = def->time_limit > 0 ? r->start + def->time_limit : 0,
           pass_start = vl_seconds();
    if (!choose_pass(r, seconds_per_work, end > 0 ? end - pass_start : INFINITY))
      return VL_OK;
    r->stop.deadline = first ? 0 : end;
    vlResult result = render_pass(r, &late, error);
    if (result != VL_OK || late)
      return result;
    seconds_per_work = (vl_seconds() - pass_start) / r->work_pass;
    r->work_done = vl_adaptive_mean_spp(&r->adaptive);
    bool more =
        vl_adaptive_expected_spp(&r->adaptive, def->spp - r->sequence.first) > r->work_done;
    if (!report(r, true, r->work_done) && more)
      return vl_fail(error, VL_CANCELLED, "stopped");
    if (def->time_limit > 0 && vl_seconds() - r->start >= NEARLY * def->time_limit)
      return VL_OK;
  }
}

static void prepare_pilot(vlRenderRun *r, const vlPilot *pilot) {
  if (!pilot)
    return;
  r->shares = r->film_rays.uniform = false;
  r->film_rays.spread = pilot->spread;
  r->trace.pixel_spread *= pilot->spread;
  r->trace.pixel_width *= pilot->spread;
  r->trace.irradiance = pilot->irradiance;
}

static void end_pilot(const vlRenderRun *r, vlPilot *pilot) {
  if (!pilot)
    return;
  pilot->merge_work = 0;
  for (uint32_t i = 0; i < vl_context_threads(r->world->context); i++)
    pilot->merge_work += r->workers[i].merge_work;
}

vlResult vl_render_pilot(const vlWorld *world, const vlCamera *camera, vlFilm *film,
                         const vlRenderDef *def, vlPilot *pilot, vlRenderStats *stats,
                         vlError *error) {
  vl_error_clear(error);
  vlRenderDef standard = vl_default_render_def();
  if (!def)
    def = &standard;
  vlResult result = vl_render_check(world, camera, film, def, error);
  if (result != VL_OK)
    return result;
  vlRenderRun render, *r = &render;
  memset(r, 0, sizeof *r);
  r->world = world;
  r->film = film;
  r->def = def;
  r->start = vl_seconds();
  r->loop = vl_loop_def(def->priority, def->cancel);
  r->raced = pilot != NULL;
  vl_stop_init(&r->stop, def->cancel, ask_to_stop, r);
  r->sequence = vl_film_sequence(film);
  if (!r->sequence.length) {
    r->sequence.length =
        def->sequence ? def->sequence : vl_sampler_sequence(def->sampler, def->spp);
    r->sequence.first = def->first_sample;
    r->sequence.own = own_names(camera, def);
  }
  vl_film_set_sequence(film, r->sequence);
  vlCamera focused = *camera;
  if ((result = vl_camera_autofocus(world, &focused, error)) != VL_OK)
    return result;
  vl_render_prepare(r, &focused);
  if (r->prepared != VL_OK)
    return vl_fail_memory(error);
  prepare_pilot(r, pilot);
  result = make_workers(r, world->context, error);
  if (r->shares)
    r->reconstruction = vl_reconstruction_of(vl_film_filter(film));
  if (result == VL_OK)
    result = prepare_two_way(r, &focused, error);
  if (result == VL_OK && pilot && r->two_way) {
    vl_two_way_share(r->two_way, pilot->pass_seed);
    vl_two_way_measure(r->two_way, pilot->tails,
                       pilot->spread * pilot->spread / (float)def->spp);
  }
  double correlation = r->shares ? vl_reconstruction_correlation(&r->reconstruction) : 1;
  if (result == VL_OK &&
      vl_adaptive_create(&r->adaptive, world->context, film, def, correlation) != VL_OK)
    result = vl_fail_memory(error);
  r->adaptive.rows = r->two_way ? 0 : def->pass_rows;
  if (result == VL_OK)
    result = render_passes(r, error);
  if (stats && r->workers)
    fill_stats(r, stats);
  if (r->workers)
    end_pilot(r, pilot);
  vl_adaptive_destroy(&r->adaptive);
  vl_two_way_destroy(r->two_way);
  return result;
}

vlResult vl_render(const vlWorld *world, const vlCamera *camera, vlFilm *film,
                   const vlRenderDef *def, vlRenderStats *stats, vlError *error) {
  return vl_render_pilot(world, camera, film, def, NULL, stats, error);
}
