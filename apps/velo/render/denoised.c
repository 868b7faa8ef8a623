/* render/denoised.c: see denoised.h. */
#include "render/denoised.h"

#include <math.h>
#include <string.h>

#include "cli/macros.h"
#include "cli/report.h"
#include "cli/signals.h"
#include "image/denoise.h"
#include "image/image.h"
#include "render/attributes.h"
#include "render/pattern.h"

enum { MAX_CHANNELS = 1010 }; /* a spectrum of 1000 buckets, colours and errors */

int denoised_choose(Denoised *d, const Arguments *arguments, const Outputs *image) {
  const OptionValue *v = arguments->values;
  const char *path = v[RENDER_DENOISE].text;
  memset(d, 0, sizeof *d);
  d->def = vl_default_denoise_def();
  d->def.denoiser = (vlDenoiser)option_count(&v[RENDER_DENOISER], d->def.denoiser);
  d->def.library = v[RENDER_DENOISER_LIBRARY].text;
  if (!v[RENDER_DENOISE].given) {
    if (v[RENDER_DENOISER].given || v[RENDER_DENOISER_LIBRARY].given)
      return report_usage("--denoiser goes with --denoise FILE");
    return -1;
  }
  if (v[RENDER_SPP].given && v[RENDER_SPP].integer < 2)
    return report_usage("--denoise needs at least 2 samples per pixel (--spp)");
  if (v[RENDER_RIG].given)
    return report_usage("--denoise does not go with --rig; velo image denoise does");
  if (v[RENDER_TRAJECTORY].given && d->def.denoiser != VL_DENOISER_VELO)
    return report_usage("--trajectory goes with velo's own denoiser: leave out --denoiser");
  for (int i = 0; i < image->count; i++)
    if (strcmp(path, image->paths[i]) == 0)
      return report_usage(
          "--denoise \"%s\": the image itself is never replaced by its denoised copy", path);
  d->outputs = *image;
  d->outputs.paths[0] = path;
  d->outputs.count = 1;
  TRY(outputs_check_names(&d->outputs));
  if (v[RENDER_TRAJECTORY].given)
    TRY(pattern_check(path));
  return outputs_check_folders(&d->outputs);
}

void denoised_replace(Denoised *d, const Outputs *image) {
  d->outputs = *image;
  d->replaces = true;
}

bool denoised_is_copy(const Denoised *d) {
  return d->outputs.count && !d->replaces;
}

int denoised_check(const Denoised *d, vlContext *context) {
  if (!d->outputs.count || d->def.denoiser == VL_DENOISER_VELO)
    return -1;
  vlImage *pixel = NULL, *clean = NULL;
  vlError error = {0};
  vlResult result = image_make(context, 1, 1, 3, NULL, &pixel);
  if (result == VL_OK)
    result = vl_denoise(pixel, &d->def, &clean, NULL, &error);
  vl_image_destroy(pixel);
  vl_image_destroy(clean);
  return report_error(&error, result, NULL);
}

uint64_t denoised_memory(uint64_t pixels) {
  enum { INPUT = 14, PLANES = 23, RESULT = 4, CHANNELS = 10 };
  return pixels * sizeof(float) * (INPUT + PLANES + RESULT + CHANNELS);
}

double denoised_seconds(uint64_t pixels, uint32_t spp, double sample, double writing,
                        uint32_t threads) {
  const double per_pixel = 1e-6, ray = 0.3; /* measured on one thread: seconds per pixel; cost
                                                 of a camera ray relative to a sample */
  uint32_t features = spp < VL_FEATURE_SAMPLES ? spp : VL_FEATURE_SAMPLES;
  return per_pixel * (double)pixels / threads + ray * sample * features + writing;
}

vlResult denoised_join(vlContext *context, const vlImage *const parts[], int n,
                       const char *const *names, vlImage **joined) {
  const char *own[MAX_CHANNELS];
  uint32_t count = 0;
  for (int k = 0; k < n; k++)
    for (uint32_t c = 0; c < vl_image_channels(parts[k]) && count < MAX_CHANNELS; c++)
      own[count++] = vl_image_channel_name(parts[k], c);
  TRY_RESULT(image_make_like(context, parts[0], count, names ? names : own, joined));
  float *to = vl_image_pixels(*joined);
  for (size_t i = 0; i < image_pixel_count(parts[0]); i++)
    for (int k = 0; k < n; k++) {
      uint32_t channels = vl_image_channels(parts[k]);
      memcpy(to, (const float *)vl_image_const_pixels(parts[k]) + i * channels,
             channels * sizeof *to);
      to += channels;
    }
  return VL_OK;
}

/* Denoises the image. A frame of several is kept, and blended with those before it. *clean is
 * null for a frame that is only kept. */
static vlResult clean_frame(Denoised *d, const Job *job, const vlImage *image, vlImage **clean,
                            vlDenoiseStats *stats, vlError *error) {
  vlDenoiseDef def = d->def;
  def.errors = d->steady != NULL;
  TRY_RESULT(vl_denoise(image, &def, clean, stats, error));
  if (!d->steady)
    return VL_OK;
  int signals = signals_count();
  vlImage *kept = *clean;
  *clean = NULL;
  TRY_RESULT(steady_keep(d->steady, job, image, kept, &signals, error));
  return d->steady->only_kept ? VL_OK : steady_blend(d->steady, job, &signals, clean, error);
}

/* Makes the image with its standard errors and the denoiser's features. The errors are those of
 * independent samples, which the denoiser prefers; the others need not be estimated. */
static vlResult gather(const Job *job, const vlFilm *film, vlImage **joined, vlError *error) {
  vlDevelopDef develop = job->defs->develop;
  develop.independent = true; /* does not matter to the colours */
  int signals = signals_count();
  vlChannelsDef def = job_channels_def(job, film, &signals);
  def.channels = VL_CHANNEL_FEATURES;
  def.time = VL_UNSET; /* features are means over the exposure */
  vlImage *color = NULL, *errors = NULL, *features = NULL;
  vlResult result = vl_film_develop(film, &develop, &color);
  if (result == VL_OK)
    result = vl_film_errors(film, &develop, &errors);
  if (result == VL_OK)
    result = vl_render_channels(job->world, &job->camera, &def, &features, NULL, error);
  if (result == VL_OK)
    result = denoised_join(job->context, (const vlImage *const[]){color, errors, features}, 3,
                           NULL, joined);
  if (result == VL_OK)
    result = attributes_set(*joined, job, vl_film_spp(film));
  vl_image_destroy(color);
  vl_image_destroy(errors);
  vl_image_destroy(features);
  return result;
}

void denoised_share_exposure(Denoised *d, Outputs *image) {
  if (!d->outputs.count)
    return;
  d->exposure = NAN;
  if (image->meter && !image->shared)
    image->shared = &d->exposure;
  d->outputs.meter = image->meter;
  d->outputs.exposure = image->exposure;
  d->outputs.shared = image->shared;
}

int denoised_make(Denoised *d, const Job *job, const vlFilm *film, vlImage **clean) {
  vlImage *image = NULL;
  vlError error = {0};
  vlDenoiseStats stats;
  *clean = NULL;
  vlResult result = gather(job, film, &image, &error);
  if (result == VL_OK)
    result = clean_frame(d, job, image, clean, &stats, &error);
  vl_image_destroy(image);
  if (result == VL_OK && *clean)
    result = denoise_name(*clean, d->def.denoiser);
  if (result == VL_OK) {
    if (*clean)
      denoise_report(&stats);
    return STATUS_OK;
  }
  vl_image_destroy(*clean);
  *clean = NULL;
  if (result != VL_CANCELLED)
    return report_error(&error, result, d->outputs.paths[0]);
  report_note("interrupted before %s was done", d->outputs.paths[0]);
  return signals_status();
}

int denoised_write(Denoised *d, const Job *job, const vlFilm *film, OutputStage stage) {
  if (!d->outputs.count)
    return STATUS_OK;
  vlImage *clean = NULL;
  int status = denoised_make(d, job, film, &clean);
  if (clean) {
    status = outputs_write(job->context, &d->outputs, clean, vl_film_spp(film), stage);
    d->written = status == STATUS_OK;
  }
  vl_image_destroy(clean);
  return status;
}
