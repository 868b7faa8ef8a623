/** @file
 * velo/render.h: the film (accumulated samples), and vl_render, which renders a world with a
 * camera into a film. */
#ifndef VELO_RENDER_H
#define VELO_RENDER_H

#include "velo/base.h"
#include "velo/camera.h"
#include "velo/filter.h"
#include "velo/image.h"
#include "velo/own.h"
#include "velo/spectrum.h"
#include "velo/world.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- film -------------------------------------------------------------------------------- */

/** The accumulated samples of an image. Only one thread at a time may use a film. Its context
 * must outlive it. */
typedef struct vlFilm vlFilm;
/** How to create a film. */
typedef struct vlFilmDef {
  uint32_t cookie;
  uint32_t width, height; /**< size of the whole image, pixels */
  uint32_t crop[4]; /**< the pixels that are rendered: x0, y0, x1, y1, exclusive; default all */
  vlPixelFilter filter; /**< reconstruction filter */
  vlColorSpace space;   /**< colour space of the developed image */
  double white_balance; /**< colour temperature of the daylight that becomes white, kelvin; 0
                           (default): no white balance */
  /** The sensor's spectral response. Null (default) or "cie1931" is the standard observer. The
   * name of a measured camera (vl_sensor_name) selects its response; a matrix converts its
   * values to XYZ. The matrix is fitted to 24 reflectances under the sensor's white, which is
   * daylight of white_balance kelvin, or of 6500 K if that is 0 (pbrt book 5.4.2). Worlds in
   * RGB mode have no spectra: for them the sensor is the standard observer with the same
   * white. */
  const char *sensor;
  /** A sample whose X, Y or Z (or the sensor's red, green or blue) is above this value is
   * scaled down so that the largest equals it. This removes fireflies, but biases the image.
   * Default infinity. */
  float max_component;
  bool errors; /**< keep the sums that vl_film_errors needs, which takes four times the memory;
                  default false */
  /** The number of wavelength buckets, at most 1000. A film with buckets stores spectra besides
   * the colours: its buckets have equal width and cover lambda_min to lambda_max. Each bucket
   * takes 48 bytes per pixel. All paths then sample wavelengths from the same distribution, and
   * only in this range. 0 (default): no spectra. */
  uint32_t buckets;
  double lambda_min, lambda_max; /**< wavelengths in nm, between 360 and 830 (the defaults) */
} vlFilmDef;
/** Name `index`, from 0, of the names for vlFilmDef.sensor; null past the end. Constant
 * strings. */
VL_API const char *vl_sensor_name(uint32_t index);
/** The default def for an image of this size, in pixels. */
VL_API vlFilmDef vl_default_film_def(uint32_t width, uint32_t height);
/** The def of a film of 1/factor of the size, rounded up, for a first coarse image by
 * vl_camera_coarse. Pixel (x, y) covers the pixels from (factor x, factor y) on. The crop
 * covers that of `def`; sums for errors and spectra are left out. factor: 1 to 64. */
VL_API vlFilmDef vl_coarse_film_def(const vlFilmDef *def, uint32_t factor);
/** Creates a film without samples. ARGUMENT, MEMORY. */
VL_API vlResult vl_film_create(vlContext *context, const vlFilmDef *def, vlFilm **film);
/** Null is allowed. */
VL_API void vl_film_destroy(vlFilm *film);
/** The number of bytes that a film of this def holds during a render. */
VL_API uint64_t vl_film_memory(const vlFilmDef *def);
/** Removes all samples but keeps the memory, so that the film can take another image of the
 * same size. Must not be called while a render runs. */
VL_API void vl_film_clear(vlFilm *film);
/** The number of samples per pixel. Only finished passes count. With adaptive sampling: of the
 * blocks with the most. */
VL_API uint32_t vl_film_spp(const vlFilm *film);
/** How to develop a film. */
typedef struct vlDevelopDef {
  uint32_t cookie;
  float exposure;   /**< factor on the linear values; default 1 */
  bool independent; /**< vl_film_errors: as if the samples of a pixel were independent; default
                       false */
} vlDevelopDef;
/** The default def. */
VL_API vlDevelopDef vl_default_develop_def(void);
/** Makes a float image R G B A of the crop window, owned by the caller. R G B are the weighted
 * mean of the samples: linear, in the film's colour space, with the background. A is the share
 * of samples that met a surface. Pixels without samples are 0. Must not be called while a
 * render runs, except from its callback after a pass. def may be null. ARGUMENT, MEMORY. */
VL_API vlResult vl_film_develop(const vlFilm *film, const vlDevelopDef *def, vlImage **image);
/** Makes a float image error.R error.G error.B of the crop window, owned by the caller: the
 * standard errors of vl_film_develop's values. They are square roots of the estimated variance
 * of the mean, for the samples that the sampler gives, which are better distributed than
 * independent ones (docs/ground-truth.md, Standard error). How much better they are is
 * estimated in cells of 8 x 8 pixels of the whole image, so a crop has the errors of the whole
 * image if it ends at multiples of 8. With def.independent they are those of independent
 * samples instead, each from the samples of its pixel only. Pixels with fewer than 2 samples
 * have infinity. ARGUMENT when the film was made without vlFilmDef.errors. */
VL_API vlResult vl_film_errors(const vlFilm *film, const vlDevelopDef *def, vlImage **image);
/** Makes a float image of the crop window with one channel per bucket, owned by the caller.
 * Channels are named as emitted light in Fichet, Pacanowski, Wilkie 2021 ("An OpenEXR layout
 * for spectral images"): S0.374,688nm is the bucket centred at 374.688 nm. A value is the mean
 * radiance per wavelength in the bucket. Its unit is pbrt-v4's: a light of constant spectrum
 * and luminance 1 has the value 1 at all wavelengths. White balance, exposure and max_component
 * do not apply. ARGUMENT for a film without buckets. */
VL_API vlResult vl_film_spectrum(const vlFilm *film, vlImage **image);
/** Makes a float image luminance.Y of the crop window, owned by the caller: the luminance of
 * each pixel in cd/m^2, by the standard observer (docs/conventions.md, Light). Exposure does
 * not apply. ARGUMENT for a film with a white balance, or with another sensor than cie1931;
 * MEMORY. */
VL_API vlResult vl_film_luminance(const vlFilm *film, vlImage **image);

/* ---- render ------------------------------------------------------------------------------ */

/** The state of a render. */
typedef struct vlProgress {
  uint32_t spp_done, spp_total; /**< samples per pixel of the film: those of finished passes,
                                   and the requested number */
  /** seconds; remaining is an estimate, infinity before there is one */
  double elapsed, remaining;
  double fraction; /**< share of the work that is done, 0 to 1; also advances inside a pass */
  uint64_t paths, rays; /**< numbers of paths and rays traced so far */
  bool pass_done; /**< true: a pass is finished, and the film may be read; false: a pass is
                     running, and the film must not be read */
  uint32_t rows;  /**< the rows of the film, from its top, whose pixels have spp_done samples;
                     after a pass, else 0. Fewer than all with vlRenderDef.pass_rows */
} vlProgress;
/** Called after each pass, and about forty times a second inside one, on the thread that
 * called vl_render. Return false to stop the render; a pass that is running is then discarded.
 */
typedef bool vlProgressFn(void *user, const vlProgress *progress);

/** Value of vlRenderDef.light_paths: one light path per pixel, but at most 2^20. */
#define VL_AS_MANY_AS_PIXELS 0xffffffffu

/** How to render. */
typedef struct vlRenderDef {
  uint32_t cookie;
  uint32_t tracer;  /**< light transport algorithm: a vlTracer (velo/tracer.h) */
  uint32_t sampler; /**< sample generator: a vlSamplerKind (velo/sampler.h) */
  uint32_t spp;  /**< samples per pixel that the film has after the render; includes the samples
                    that it has before, and those before its first_sample */
  uint32_t seed; /**< seed of the random numbers */
  /** The length of the sample sequence: the number of samples per pixel for which the sampler
   * lays out its points. All renders with the same length have the same sample i of a pixel,
   * whatever their spp. Samples past the end begin another, independent sequence. 0 (default):
   * the length with which the film's samples were taken. For a film without samples it is then
   * 65536, or spp for samplers that divide the sequence into cells (those without
   * VL_SAMPLER_TRAIT_OPEN). */
  uint32_t sequence;
  /** The index of the first sample. A film without samples gets the samples first_sample to spp
   * - 1; so several machines can each render a part of the samples of one image. Default 0. A
   * film with samples ignores it and continues after its last sample. */
  uint32_t first_sample;
  uint32_t max_depth; /**< largest number of bounces of a path */
  /** Further limits, of bounces of one kind: diffuse reflection; glossy or specular reflection;
   * transmission; scattering in media. A path that has so many bounces of the kind ends at its
   * next hit, whose emission it still adds. Subsurface scattering counts as diffuse; light that
   * passes through interfaces and cut-outs has no bounce there. The tracers path and volpath
   * have them; others are replaced by volpath. Default 0: no such limit. */
  uint32_t max_diffuse_depth, max_glossy_depth, max_transmission_depth, max_volume_depth;
  float ao_distance; /**< ambient occlusion: length of its rays, scene units */
  bool ao_cosine;    /**< ambient occlusion: directions weighted by the cosine; else uniform */
  /** For comparisons (as pbrt's disablepixeljitter and similar options). centred: all samples
   * are at the centre of the pixel, of the lens and of the exposure. same_wavelengths: all
   * paths have the same wavelengths. sharp_textures: textures are not filtered by the
   * footprint. */
  bool centred, same_wavelengths, sharp_textures;
  /** Each pixel counts all samples that its filter covers, also those of its neighbours,
   * instead of samples of its own that are drawn from the filter: two to three times as many
   * for the same work (docs/filters.md). The errors of neighbouring pixels are then correlated.
   * Ignored for filters with negative lobes or a radius above 2.5 pixels, for films with
   * spectra, and if centred. Default true. */
  bool share_samples;
  /** Samples whose camera ray meets nothing, or a backdrop, have no radiance: the image is
   * premultiplied by its alpha. Light paths that connect to the camera are not affected.
   * Default false. */
  bool transparent;
  /** Tracers with light paths (docs/tracers.md): the radius within which paths are merged in
   * the first pass, in scene units, above 0. VL_UNSET: the radius spans two pixels. */
  double merge_radius;
  uint32_t light_paths; /**< tracers with light paths: their number per pass, up to 2^24, or
                           VL_AS_MANY_AS_PIXELS */
  /** The limit of the call's duration, in seconds; 0: no limit. Passes are sized by the time
   * left, and a pass that is not finished in time is discarded. The first pass of each call is
   * always finished. The callback may change the limit while the render runs. */
  double time_limit;
  /** Adaptive sampling: above 0, the threshold of noise in display values (1: white). The film
   * needs vlFilmDef.errors. It is divided into blocks of 32 x 32 pixels. When a block has 8,
   * 12, 16, 24, 32, 48, 64, ... samples per pixel, its noise is estimated: an upper bound of
   * the root mean square, over its pixels and channels, of the standard errors of the display
   * values. If the noise will be below the threshold before the next of these numbers, the
   * block gets the samples that this needs and no more; the other blocks get up to spp
   * (docs/adaptive.md). first_sample must be 0. A crop has the pixels of the whole image if it
   * ends at multiples of 32. Default 0: none. */
  double noise;
  vlView noise_view;      /**< the view that makes the display values; default standard */
  float noise_exposure;   /**< as vl_image_view's: a factor of 2^noise_exposure before the view;
                             default 0 */
  float noise_scale;      /**< a further factor, as vlDevelopDef.exposure; default 1 */
  vlProgressFn *progress; /**< default null */
  void *progress_user;    /**< passed to progress */
  /** Stops the render within one batch of at most 1024 paths; the pass that is running is
   * discarded, and the film keeps whole passes. Default null. */
  const vlCancel *cancel;
  /** A pass goes over at most so many rows of the image, rounded up to blocks of 32 rows, from
   * the top: so the image of a slow scene can be shown while it grows (vlProgress.rows). The
   * pixels of the other rows have the samples of the pass before, or none. The image at the end
   * is the same; passes cost a little more. Ignored by tracers with light paths. Default 0: all
   * rows. */
  uint32_t pass_rows;
  /** Of several calls that run at once in a context, those with the highest priority get all
   * workers; the others wait between two batches, except for one batch each 50 ms. Default
   * 0. */
  int priority;
  /** A sampler of one's own (velo/own.h), in place of `sampler` for all paths that begin at the
   * camera. Must outlive the call. `sampler` then still gives the numbers of light paths and
   * the length of the sequence. Default null. */
  const vlOwnSampler *own_sampler;
  /** A tracer of one's own (velo/trace.h), in place of `tracer`; must outlive the call. It gets
   * surfaces and lights; media are not there for it. Default null. */
  const struct vlOwnTracer *own_tracer;
} vlRenderDef;
/** The default def. */
VL_API vlRenderDef vl_default_render_def(void);

/** What a render did. */
typedef struct vlRenderStats {
  uint32_t spp;    /**< samples per pixel of the film; adaptive: the most of a block */
  double mean_spp; /**< mean over its blocks of 32 x 32 pixels */
  uint32_t blocks, noisy_blocks; /**< number of blocks; of those not below vlRenderDef.noise */
  uint64_t paths, camera_rays, bounce_rays, shadow_rays; /**< counts */
  /** number of samples discarded because they were not finite or above 2^40 */
  uint64_t not_finite;
  uint64_t own_numbers; /**< numbers of vlRenderDef.own_sampler that were not in [0, 1), and
                           were replaced */
  double seconds;       /**< duration of the call */
  uint32_t worst_x, worst_y; /**< a pixel where a sample was discarded */
} vlRenderStats;
/** The name of the first feature of world, camera and film that the tracer does not render,
 * such as "material \"hair\""; null: it renders all. vl_render then uses VL_TRACER_VOLPATH in
 * its place, and tells the log. docs/tracers.md lists the features. The string is constant. */
VL_API const char *vl_tracer_lacks(const vlWorld *world, const vlCamera *camera,
                                   const vlFilmDef *film, uint32_t tracer);
/** Adds samples to the film until each pixel has def->spp. The bits depend neither on the
 * number of threads, nor on the crop, nor on the division into passes and calls. VL_CANCELLED
 * when the callback or def->cancel stopped the render; the film then holds whole passes. Only
 * one render at a time may add to a film. The render runs on the workers of the world's
 * context. def and stats may be null. VL_TRACER_VOLPATH replaces a tracer that lacks something
 * of the scene (vl_tracer_lacks). Errors: MEMORY; ARGUMENT, also when camera and film have
 * different sizes, when the film has buckets and the world is in RGB mode, or when the film's
 * samples are from a sequence of another length. */
VL_API vlResult vl_render(const vlWorld *world, const vlCamera *camera, vlFilm *film,
                          const vlRenderDef *def, vlRenderStats *stats, vlError *error);

/** The number of bytes that vl_render needs in addition to the film, for its workers and for
 * light paths. The share of the light paths is an estimate, because their size is known only
 * after the first pass. */
VL_API uint64_t vl_render_memory(const vlWorld *world, const vlFilmDef *film,
                                 const vlRenderDef *def);

/* ---- how the image of a scene is taken --------------------------------------------------- */

/** The coordinate system of the ground truth channels that the scene's file requests (pbrt's
 * gbuffer film). NONE: it requests no channels. */
typedef enum vlGbuffer { VL_GBUFFER_NONE, VL_GBUFFER_CAMERA, VL_GBUFFER_WORLD } vlGbuffer;

/** The defs of the calls that make the image of a scene. A new scene has the defaults of an
 * empty pbrt-v4 file (1280 x 720 pixels); an importer sets what its file specifies. The defs
 * can be passed to the calls as they are:
 *
 *   vlSceneDefs *defs = vl_scene_defs(scene);
 *   vl_world_build(scene, &defs->build, &world, &error);
 *   vl_camera_make(&defs->camera, &camera, NULL, &error);
 *   vl_film_create(context, &defs->film, &film);
 *   vl_render(world, &camera, film, &defs->render, NULL, &error);
 *   vl_film_develop(film, &defs->develop, &image);
 *
 * A copy stays valid after the scene is destroyed, except for the pointers that the scene owns:
 * camera.lens.aperture, camera.lens.optics, camera_source.file. Not thread-safe. */
struct vlSceneDefs {
  vlCameraDef camera;       /**< for vl_camera_make; width and height equal the film's */
  vlFilmDef film;           /**< for vl_film_create */
  vlBuildDef build;         /**< for vl_world_build */
  vlRenderDef render;       /**< for vl_render */
  vlDevelopDef develop;     /**< for vl_film_develop; its exposure combines the settings of the
                               file's sensor: ISO, imaging ratio, seconds */
  vlMediumId camera_medium; /**< the medium around the camera; index 0: vacuum. Read when the
                               world is built */
  vlGbuffer gbuffer; /**< ground truth channels that the file requests (pbrt's gbuffer film) */
  char output[512];  /**< name of the image file given in the scene's file; empty: none */
  vlSource camera_source; /**< where the file describes the camera, for errors of
                             vl_camera_make; file may be null */
  bool camera_missing;    /**< the file describes no camera: vl_scene_complete adds one */
  bool tracer_missing;    /**< the file names no tracer: render.tracer is VL_TRACER_VOLPATH, and
                             vl_choose_tracer (velo/choose.h) may find a better one */
  bool light_missing; /**< the file describes no environment light: vl_scene_complete may add
                         one */
};

#ifdef __cplusplus
}
#endif
#endif
