/** @file
 * velo/render.h: the world (compiled, constant), the film (accumulated samples), and vl_render, the one call where
 * world, camera and film meet. */
#ifndef VELO_RENDER_H
#define VELO_RENDER_H

#include "velo/base.h"
#include "velo/camera.h"
#include "velo/image.h"
#include "velo/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- world ------------------------------------------------------------------------------------------------------ */

/** A compiled scene. Constant: any number of threads and renders may share it. Its context must outlive it. */
typedef struct vlWorld vlWorld;
/** What is guaranteed for the image's bits. PORTABLE: the same scene, options and version give the same bits on every
 * x86-64 machine, for any number of threads; a crop has the same pixels as the whole image. FAST: the same on machines
 * for which Embree, which intersects the rays, selects the same instruction set; elsewhere a few pixels differ, where
 * surfaces are coplanar or a ray meets an edge. docs/decisions/0013-the-bits-of-embree.md has the numbers. */
typedef enum vlBits { VL_BITS_PORTABLE, VL_BITS_FAST } vlBits;
/** How to compile a scene. */
typedef struct vlBuildDef {
  uint32_t cookie;
  vlColorMode color;            /**< spectral (default) or RGB; fixed at build */
  vlLightSampler light_sampler; /**< default BVH */
  bool imitate_pbrt; /**< reproduce known errors of pbrt-v4 (rough coats up to 8 % too bright; docs/decisions) */
  /** Path and volume tracers: roughen what a path meets after its first non-specular scattering (pbrt-v4's regularize:
   * alphas below 0.3 are doubled and clamped to 0.1 to 0.3). Removes fireflies of caustics, and part of their light.
   * Default false. */
  bool regularize;
  /** Default portable. The environment variable VELO_EMBREE=sse4.2|avx|avx2|avx512 forces Embree's instruction set, for
   * tests; portable accepts the first two. UNSUPPORTED from the build for one that is not accepted or not available. */
  vlBits bits;
} vlBuildDef;
/** The default def. */
VL_API vlBuildDef vl_default_build_def(void);
/** Compiles the scene, and reads the images that it names. The scene may be destroyed afterwards. def may be null.
 * Errors: ARGUMENT, that of vl_scene_result, SCENE (with the place), MISSING (images), IO, MEMORY, UNSUPPORTED; *world
 * is null then. */
VL_API vlResult vl_world_build(const vlScene *scene, const vlBuildDef *def, vlWorld **world, vlError *error);
/** The same for the last build of a scene: its meshes are freed as soon as the world has them, so that both are never
 * in memory beside the accelerator. Another build of the scene is ARGUMENT. */
VL_API vlResult vl_world_build_last(vlScene *scene, const vlBuildDef *def, vlWorld **world, vlError *error);
/** Null is allowed. */
VL_API void vl_world_destroy(vlWorld *world);
/** The size of a world. */
typedef struct vlWorldInfo {
  uint64_t triangles, primitives; /**< counts; triangles are among the primitives; those of groups count once */
  uint64_t instances, lights;     /**< counts; each emissive primitive is a light */
  uint64_t texture_bytes;         /**< of images, with their coarser levels */
  uint64_t bytes; /**< held by the context when the build was done, the scene's included, Embree's excluded */
  float bounds_min[3], bounds_max[3]; /**< corners of the bounding box, world space */
  double build_seconds;               /**< duration of the build */
} vlWorldInfo;
/** Fills *info. */
VL_API void vl_world_info(const vlWorld *world, vlWorldInfo *info);

/* ---- film ------------------------------------------------------------------------------------------------------- */

/** The accumulated samples of an image. One thread at a time. Its context must outlive it. */
typedef struct vlFilm vlFilm;
/** How to create a film. */
typedef struct vlFilmDef {
  uint32_t cookie;
  uint32_t width, height; /**< the whole image, pixels */
  uint32_t crop[4];       /**< the pixels that are rendered: x0, y0, x1, y1, exclusive; default all */
  vlPixelFilter filter;   /**< reconstruction filter */
  vlColorSpace space;     /**< of the developed image */
  double white_balance; /**< kelvin: daylight of this colour temperature becomes white; 0 (default): no white balance */
  /** The spectral response: null (default) or "cie1931": the standard observer; or a measured camera (vl_sensor_name),
   * whose values become XYZ by the matrix that fits 24 reflectances under its white, daylight of white_balance kelvin
   * (0: 6500 here), pbrt book 5.4.2. Worlds in RGB mode have no spectra and use the standard observer with that white.
   */
  const char *sensor;
  /** A sample whose X, Y or Z (the sensor's red, green or blue) is above this is scaled down to it: removes fireflies,
   * and is biased. Default infinity. */
  float max_component;
  bool errors; /**< keep what vl_film_errors needs: three times the memory; default false */
  /** Spectra beside the colours: the number of buckets of equal width from lambda_min to lambda_max, at most 1000; each
   * takes 48 bytes a pixel. All paths then have the same distribution of wavelengths, in this range only. 0 (default):
   * none. */
  uint32_t buckets;
  double lambda_min, lambda_max; /**< nm, within 360 to 830 (the default) */
} vlFilmDef;
/** The names for vlFilmDef.sensor, index from 0; null past the end. Constant. */
VL_API const char *vl_sensor_name(uint32_t index);
/** The default def for an image of this size, in pixels. */
VL_API vlFilmDef vl_default_film_def(uint32_t width, uint32_t height);
/** Creates a film without samples. ARGUMENT, MEMORY. */
VL_API vlResult vl_film_create(vlContext *context, const vlFilmDef *def, vlFilm **film);
/** Null is allowed. */
VL_API void vl_film_destroy(vlFilm *film);
/** Bytes that a film of this def holds while it is rendered into. */
VL_API uint64_t vl_film_memory(const vlFilmDef *def);
/** Removes all samples and keeps the memory, for the next image of the same size. Not while a render runs. */
VL_API void vl_film_clear(vlFilm *film);
/** The number of samples per pixel (of whole passes). */
VL_API uint32_t vl_film_spp(const vlFilm *film);
/** How to develop a film. */
typedef struct vlDevelopDef {
  uint32_t cookie;
  float exposure; /**< factor on the linear values; default 1 */
} vlDevelopDef;
/** The default def. */
VL_API vlDevelopDef vl_default_develop_def(void);
/** Makes a float image R G B A of the crop window, owned by the caller: the weighted mean of the samples, linear, in
 * the film's colour space; A is the share of samples that met a surface (R G B include the background). Zero for pixels
 * without samples. Not while a render runs, except from its callback after a pass. def may be null. ARGUMENT, MEMORY.
 */
VL_API vlResult vl_film_develop(const vlFilm *film, const vlDevelopDef *def, vlImage **image);
/** Makes a float image error.R error.G error.B of the crop window: the standard error of vl_film_develop's values, that
 * is the square root of the variance of the mean, estimated as if the pixel's samples were independent (most samplers
 * have less error); infinity below 2 samples. ARGUMENT when the film was made without vlFilmDef.errors. */
VL_API vlResult vl_film_errors(const vlFilm *film, const vlDevelopDef *def, vlImage **image);
/** Makes a float image of the crop window with one channel per bucket, named as emitted light in Fichet, Pacanowski,
 * Wilkie 2021 ("An OpenEXR layout for spectral images"): S0.374,688nm for the one centred at 374.688 nm. A value is the
 * mean radiance per wavelength in the bucket, in the unit in which a light of constant spectrum and luminance 1 has 1
 * everywhere (pbrt-v4's). White balance, exposure and max_component do not apply. ARGUMENT for a film without buckets.
 */
VL_API vlResult vl_film_spectrum(const vlFilm *film, vlImage **image);

/* ---- render ----------------------------------------------------------------------------------------------------- */

/** The state of a render. */
typedef struct vlProgress {
  uint32_t spp_done, spp_total; /**< samples per pixel of the film: done in whole passes, and requested */
  double elapsed, remaining;    /**< seconds; remaining is an estimate, infinity before there is one */
  double fraction;              /**< of the work, 0 to 1; also inside a pass */
  uint64_t paths, rays;         /**< traced so far */
  bool pass_done; /**< a pass is done and the film may be read; false: inside a pass, the film must not be read */
} vlProgress;
/** Called after each pass, and about ten times a second inside one, on the thread that called vl_render. Return false
 * to stop: after a pass at once; inside a pass the pass is discarded. */
typedef bool vlProgressFn(void *user, const vlProgress *progress);

/** vlRenderDef.light_paths: one light path per pixel, at most 2^20. */
#define VL_AS_MANY_AS_PIXELS 0xffffffffu

/** How to render. */
typedef struct vlRenderDef {
  uint32_t cookie;
  vlTracer tracer;       /**< light transport algorithm */
  vlSamplerKind sampler; /**< sample generator */
  uint32_t spp;          /**< samples per pixel that the film shall have in the end, those it has already included
                          * and those before its first_sample */
  uint32_t seed;         /**< of the random numbers */
  /** The length of the sample sequence: for how many samples per pixel the sampler lays out its points; sample i of a
   * pixel is the same in all renders of one length, whatever their spp. Samples past it begin another, independent
   * sequence. 0 (default): that of the samples which the film has; for its first ones 65536, or spp for the samplers
   * that divide it into cells (without VL_SAMPLER_TRAIT_OPEN). */
  uint32_t sequence;
  /** The index of the first sample of a film without samples, which then gets those from first_sample to spp - 1: a
   * part of an image that is rendered on several machines. Default 0. A film with samples continues where it ends. */
  uint32_t first_sample;
  uint32_t max_depth; /**< the most bounces of a path */
  float ao_distance;  /**< ambient occlusion: length of its rays, scene units */
  bool ao_cosine;     /**< ambient occlusion: directions weighted by the cosine; else uniform */
  /** For comparisons (pbrt's disablepixeljitter and the like). centred: all samples at the centre of the pixel, the
   * lens and the exposure; same_wavelengths: the same for all paths; sharp_textures: no filtering by footprint. */
  bool centred, same_wavelengths, sharp_textures;
  /** Tracers that follow light both ways (docs/tracers.md): radius within which paths are merged in the first pass,
   * scene units, above 0; VL_UNSET: two pixels wide. */
  double merge_radius;
  uint32_t light_paths; /**< the same tracers: light paths per pass, up to 2^24; or VL_AS_MANY_AS_PIXELS */
  /** Seconds; 0: no limit. Passes are sized by the time left, and one that is not done by then is discarded; the first
   * pass of each call is always finished. The callback may change it while the render runs. */
  double time_limit;
  vlProgressFn *progress; /**< default null */
  void *progress_user;    /**< passed to progress */
} vlRenderDef;
/** The default def. */
VL_API vlRenderDef vl_default_render_def(void);

/** What a render did. */
typedef struct vlRenderStats {
  uint32_t spp;                                          /**< samples per pixel of the film */
  uint64_t paths, camera_rays, bounce_rays, shadow_rays; /**< counts */
  uint64_t not_finite;       /**< samples discarded because they were not finite or above 2^40 */
  double seconds;            /**< duration of the call */
  uint32_t worst_x, worst_y; /**< a pixel where such a sample was found */
} vlRenderStats;
/** Adds samples until each pixel has def->spp. The bits do not depend on the number of threads, the crop and the
 * division into passes and calls. VL_CANCELLED when the callback stopped it: the film holds whole passes. One render at
 * a time adds to a film; it runs on the workers of the world's context. def and stats may be null. Errors: ARGUMENT
 * (also camera and film of different sizes, a film with buckets and a world in RGB, a film whose samples are of a
 * sequence of another length), MEMORY. For films with buckets the tracers that follow light both ways use camera paths
 * only. */
VL_API vlResult vl_render(const vlWorld *world, const vlCamera *camera, vlFilm *film, const vlRenderDef *def,
                          vlRenderStats *stats, vlError *error);

/** Bytes that vl_render needs beside the film, for its workers and for light paths; the latter are an estimate, since
 * their number is known after the first pass. */
VL_API uint64_t vl_render_memory(const vlWorld *world, const vlFilmDef *film, const vlRenderDef *def);

/* ---- how the image of a scene is taken -------------------------------------------------------------------------- */

/** The defs of the calls that make the image of a scene, each complete and ready to be passed on. A
 * new scene has the defaults of an empty pbrt-v4 file (1280 x 720 pixels); an importer sets what its file gives.
 *
 *   vlSceneDefs *defs = vl_scene_defs(scene);
 *   vl_world_build(scene, &defs->build, &world, &error);
 *   vl_camera_make(&defs->camera, &camera, NULL, &error);
 *   vl_film_create(context, &defs->film, &film);
 *   vl_render(world, &camera, film, &defs->render, NULL, &error);
 *   vl_film_develop(film, &defs->develop, &image);
 *
 * A copy stays valid after the scene, except for what the scene owns: camera.lens.aperture, camera.lens.optics,
 * camera_source.file. Not thread-safe. */
struct vlSceneDefs {
  vlCameraDef camera; /**< for vl_camera_make; width and height are the film's */
  vlFilmDef film;     /**< for vl_film_create */
  vlBuildDef build;   /**< for vl_world_build */
  vlRenderDef render; /**< for vl_render */
  vlDevelopDef
      develop; /**< for vl_film_develop; exposure: the file's sensor (ISO, imaging ratio, seconds) as one factor */
  vlMediumId camera_medium; /**< the medium around the camera; index 0: vacuum. Read when the world is built */
  vlGbuffer gbuffer;        /**< ground truth channels that the file requests (pbrt's gbuffer film) */
  char output[512];         /**< name of the image file given in the scene's file; empty: none */
  vlSource camera_source;   /**< where the file describes the camera, for errors of vl_camera_make; file may be null */
  bool camera_missing;      /**< the file describes no camera: vl_scene_complete makes one */
  bool light_missing;       /**< the file describes no environment light: vl_scene_complete may add one */
};

#ifdef __cplusplus
}
#endif
#endif
