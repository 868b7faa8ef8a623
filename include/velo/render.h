/** @file
 * velo/render.h: world (compiled, constant), film (what the light adds up in), and the one call where world, camera and
 * film meet. */
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

typedef struct vlWorld vlWorld;
/** What is promised of the image's bits. PORTABLE: the same scene, options and version give the same bits on every
 * x86-64 machine, for any number of threads, and a crop the same pixels as the whole. FAST: the same on machines for
 * which Embree, which finds what rays meet, picks the same instruction set; elsewhere a few pixels differ, where
 * surfaces lie in one plane or a ray meets an edge. docs/decisions/0013-the-bits-of-embree.md has the numbers. */
typedef enum vlBits { VL_BITS_PORTABLE, VL_BITS_FAST } vlBits;
typedef struct vlBuildDef {
  uint32_t cookie;
  vlColorMode color; /**< spectral (default) or RGB; fixed at build */
  vlLightSampler light_sampler;
  bool imitate_pbrt; /**< follow pbrt-v4 where it is known to be off (rough coats too bright by up to 8 %;
                      * docs/decisions)
                      */
  /** Rough what a path meets after it has been scattered by anything but a mirror (pbrt-v4's regularize: alphas below
   * 0.3 become twice as large, from 0.1 to 0.3): no fireflies of caustics, and not all of their light. Of the path and
   * volume tracers. Default false. */
  bool regularize;
  /** Default portable. The environment variable VELO_EMBREE=sse4.2|avx|avx2|avx512 forces Embree's instruction set, for
   * tests: portable takes the first two. One that does not fit or is not there: UNSUPPORTED from the build. */
  vlBits bits;
} vlBuildDef;
VL_API vlBuildDef vl_default_build_def(void);
/** Compiles the scene, with the images that it names. The scene may be destroyed afterwards, the context not. The
 * world is constant: any number of threads and renders may share it. Errors: ARGUMENT, what vl_scene_result says, SCENE
 * (with the place), MISSING (images), IO, MEMORY; *world is null then. */
VL_API vlResult vl_world_build(const vlScene *scene, const vlBuildDef *def, vlWorld **world, vlError *error);
/** The same for a scene that no other world will be built of: its meshes go as soon as the world has them, so that both
 * are never in memory beside the accelerator. Another build of it is ARGUMENT. */
VL_API vlResult vl_world_build_last(vlScene *scene, const vlBuildDef *def, vlWorld **world, vlError *error);
VL_API void vl_world_destroy(vlWorld *world);
typedef struct vlWorldInfo {
  uint64_t triangles, primitives; /**< triangles count among the primitives; those of groups once */
  uint64_t instances, lights;     /**< each emissive primitive is a light */
  uint64_t texture_bytes;         /**< of images, with their coarser levels */
  uint64_t bytes; /**< that the context held when the world was done, the scene's included; not Embree's */
  float bounds_min[3], bounds_max[3];
  double build_seconds;
} vlWorldInfo;
VL_API void vl_world_info(const vlWorld *world, vlWorldInfo *info);

/* ---- film ------------------------------------------------------------------------------------------------------- */

typedef struct vlFilm vlFilm;
typedef struct vlFilmDef {
  uint32_t cookie;
  uint32_t width, height; /**< the whole image */
  uint32_t crop[4];       /**< x0, y0, x1, y1, exclusive; the pixels that are rendered */
  vlPixelFilter filter;
  vlColorSpace space;   /**< of the developed image */
  double white_balance; /**< kelvin: daylight of this colour temperature comes out white; 0 (default): as it is */
  /** Whose colours: null (default) or "cie1931", the standard observer; or a measured camera, vl_sensor_name. Its
   * values become XYZ by the matrix that fits 24 reflectances under its white, daylight of white_balance kelvin (0:
   * 6500 then), pbrt book 5.4.2. Worlds in RGB mode have no spectra: the standard observer takes them, with that white.
   */
  const char *sensor;
  /** A sample with one of X, Y, Z (the sensor's red, green, blue) above this is made darker until none is: against
   * fireflies, and biased. Default infinity. */
  float max_component;
  bool errors; /**< remember what vl_film_errors needs: three times the memory; default false */
  /** Spectra beside the colours: so many buckets of equal width from lambda_min to lambda_max (nm, inside of 360 to
   * 830; the default), of 48 bytes each in every pixel. Paths have wavelengths of these alone then, all alike. 0
   * (default): none. 1000 at most. */
  uint32_t buckets;
  double lambda_min, lambda_max;
} vlFilmDef;
/** Names for vlFilmDef.sensor, index from 0; null past the end. They live forever. */
VL_API const char *vl_sensor_name(uint32_t index);
VL_API vlFilmDef vl_default_film_def(uint32_t width, uint32_t height);
VL_API vlResult vl_film_create(vlContext *context, const vlFilmDef *def, vlFilm **film);
VL_API void vl_film_destroy(vlFilm *film);
/** Bytes that a film of this def holds while it is rendered into. */
VL_API uint64_t vl_film_memory(const vlFilmDef *def);
/** As new: no samples. Keeps its memory, for the next image of the same size. Not while a render runs. */
VL_API void vl_film_clear(vlFilm *film);
/** Samples that each pixel has (whole passes). */
VL_API uint32_t vl_film_spp(const vlFilm *film);
typedef struct vlDevelopDef {
  uint32_t cookie;
  float exposure; /**< factor on the linear values; default 1 */
} vlDevelopDef;
VL_API vlDevelopDef vl_default_develop_def(void);
/** New float image R G B A of the crop window: the weighted mean of the samples, linear, in the film's colour space; A
 * is the share of them that met a surface (R G B hold the sky behind, too). Zero where there is none. Not while a
 * render runs, except from its callback after a pass. def may be null. */
VL_API vlResult vl_film_develop(const vlFilm *film, const vlDevelopDef *def, vlImage **image);
/** New float image error.R error.G error.B of the crop window: the standard error of what vl_film_develop gives: the
 * square root of the variance of the mean, estimated from the pixel's samples as if they were independent (those of
 * most samplers err less); infinity below 2 samples. ARGUMENT when the film was made without vlFilmDef.errors. */
VL_API vlResult vl_film_errors(const vlFilm *film, const vlDevelopDef *def, vlImage **image);
/** New float image of the crop window with a channel for each of the film's buckets, in the names of Fichet,
 * Pacanowski, Wilkie 2021 ("An OpenEXR layout for spectral images") for emitted light: S0.374,688nm for the one round
 * 374.688 nm. The mean radiance per wavelength in the bucket, in the unit in which a light of a constant spectrum and
 * luminance 1 has 1 at each (pbrt-v4's): neither white balance nor exposure nor max_component change it. ARGUMENT when
 * the film has none. */
VL_API vlResult vl_film_spectrum(const vlFilm *film, vlImage **image);

/* ---- render ----------------------------------------------------------------------------------------------------- */

/** Called after each pass, and about ten times a second inside one, on the thread that called vl_render. */
typedef struct vlProgress {
  uint32_t spp_done, spp_total;
  double elapsed, remaining; /**< seconds; remaining is an estimate, infinity before there is one */
  double fraction;           /**< of the work, 0 to 1; also between passes */
  uint64_t paths, rays;
  bool pass_done; /**< the film may be read; false: just a sign of life from inside a pass, the film must not be read */
} vlProgress;
/** Return false to stop: after a pass at once; inside a pass the pass is given up and its samples are not counted. */
typedef bool vlProgressFn(void *user, const vlProgress *progress);

#define VL_AS_MANY_AS_PIXELS 0xffffffffu

typedef struct vlRenderDef {
  uint32_t cookie;
  vlTracer tracer;
  vlSamplerKind sampler;
  uint32_t spp; /**< samples each pixel shall have in the end */
  uint32_t seed;
  uint32_t max_depth; /**< bounces */
  float ao_distance;
  bool ao_cosine;
  /** For comparisons: all samples of a pixel through its centre, the lens' and the middle of the shutter's time; all
   * paths with the same wavelengths; textures without a footprint. pbrt's disablepixeljitter and so on. */
  bool centred, same_wavelengths, sharp_textures;
  /** Tracers that follow light both ways (docs/tracers.md). merge_radius: within which paths meet in the first pass,
   * scene units, above 0; VL_UNSET: two pixels wide. light_paths: in a pass, up to 2^24; VL_AS_MANY_AS_PIXELS: that,
   * at most 2^20. */
  double merge_radius;
  uint32_t light_paths;
  /** Seconds, 0: none. Passes are sized by what is left, and one that is not done by then is dropped; but the first
   * pass of each call is finished. The callback may change it while the render runs. */
  double time_limit;
  vlProgressFn *progress;
  void *progress_user;
} vlRenderDef;
VL_API vlRenderDef vl_default_render_def(void);

typedef struct vlRenderStats {
  uint32_t spp;
  uint64_t paths, camera_rays, bounce_rays, shadow_rays;
  uint64_t not_finite; /**< samples dropped since not finite (or above 2^40): counted, never hidden */
  double seconds;
  uint32_t worst_x, worst_y; /**< a pixel where such a sample was found */
} vlRenderStats;
/** Adds samples until each pixel has def->spp. The same bits for any number of threads, crop and split of the passes.
 * VL_CANCELLED when the callback stopped it: the film holds whole passes. One render at a time adds to a film; it
 * runs on the workers of the world's context. def and stats may be null. Errors: ARGUMENT (camera and film of different
 * sizes, too; a film with buckets and a world in RGB), MEMORY. Films with buckets are filled from the eye alone. */
VL_API vlResult vl_render(const vlWorld *world, const vlCamera *camera, vlFilm *film, const vlRenderDef *def,
                          vlRenderStats *stats, vlError *error);

/** Bytes that vl_render takes beside the film, for its workers and for paths from the lights; the latter are an
 * estimate, since their number shows in the first pass. */
VL_API uint64_t vl_render_memory(const vlWorld *world, const vlFilmDef *film, const vlRenderDef *def);

/* ---- what a scene's file says about all these ------------------------------------------------------------------- */

/** How the image of a scene is taken: the defs of the calls that take it, each complete and ready to be passed on. A
 * new scene has the defaults of a pbrt-v4 file that says nothing (1280 x 720 pixels); an importer writes what its file
 * says.
 *
 *   vlSceneDefs *defs = vl_scene_defs(scene);
 *   vl_world_build(scene, &defs->build, &world, &error);
 *   vl_camera_make(&defs->camera, &camera, NULL, &error);
 *   vl_film_create(context, &defs->film, &film);
 *   vl_render(world, &camera, film, &defs->render, NULL, &error);
 *   vl_film_develop(film, &defs->develop, &image);
 *
 * A copy stays valid after the scene, save for what the scene owns: camera.lens.aperture, camera.lens.optics,
 * camera_source.file. Not thread-safe. */
struct vlSceneDefs {
  vlCameraDef camera; /**< width and height are the film's */
  vlFilmDef film;
  vlBuildDef build;
  vlRenderDef render;
  vlDevelopDef develop;     /**< exposure: the file's sensor (ISO, imaging ratio, seconds) as one factor */
  vlMediumId camera_medium; /**< the medium around the camera; index 0: vacuum. Read when the world is built */
  vlGbuffer gbuffer;        /**< pbrt's film of that name: ground truth channels are wanted, in this space */
  char output[512];         /**< name of the image file that the scene's file asks for; empty: none */
  vlSource camera_source;   /**< where the file describes the camera, for errors of vl_camera_make; file may be null */
  bool camera_missing;      /**< the file describes no camera: vl_scene_complete makes one */
  bool light_missing;       /**< nor light from all around */
};

#ifdef __cplusplus
}
#endif
#endif
