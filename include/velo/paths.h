/** @file
 * velo/paths.h: the paths of one pixel, vertex by vertex: the same samples as in the image,
 * traced again and recorded. docs/tracers.md explains how to read them. */
#ifndef VELO_PATHS_H
#define VELO_PATHS_H

#include "velo/render.h"

#ifdef __cplusplus
extern "C" {
#endif

/** What a path met at a vertex. SURFACE: a surface. MEDIUM: a medium scattered or absorbed the
 * light there. EXIT: the point where light leaves a subsurface material, after the vertex where
 * it entered. NOTHING: the ray left the scene; the vertex has no position. */
typedef enum vlPathEvent {
  VL_PATH_SURFACE,
  VL_PATH_MEDIUM,
  VL_PATH_EXIT,
  VL_PATH_NOTHING
} vlPathEvent;
/** How the path goes on from a vertex. ON: to the next vertex, in `direction`. LEFT: the ray
 * left the scene. ABSORBED: the BSDF or the medium gave no direction or no weight. ROULETTE:
 * Russian roulette ended the path. DEPTH: the path has its largest number of
 * bounces, of all or of one kind. */
typedef enum vlPathFate {
  VL_PATH_ON,
  VL_PATH_LEFT,
  VL_PATH_ABSORBED,
  VL_PATH_ROULETTE,
  VL_PATH_DEPTH
} vlPathFate;
/** The lobe that scattered the path, as bits. SPECULAR: a delta lobe. TRANSMISSION: to the
 * other side of the surface; else reflection. */
enum { VL_PATH_SPECULAR = 1, VL_PATH_TRANSMISSION = 2 };

/** A vertex of a path. Positions and directions are in world space. Channels are the path's
 * four wavelengths, or in RGB mode linear red, green, blue and an unused one. */
typedef struct vlPathVertex {
  vlPathEvent event; /**< what the path met */
  vlPathFate fate;   /**< how it goes on */
  uint32_t bounce;   /**< number of bounces before this vertex: 0 for what the camera ray met */
  /** ids as in velo/channels.h, from 1; 0: none. The material is the chosen one of a mix */
  uint32_t object, material, instance, primitive;
  uint32_t medium;   /**< MEDIUM: number of the medium in the world, from 1; else 0 */
  float position[3]; /**< NOTHING: 0 */
  float distance; /**< from the previous vertex, or from the origin of the camera ray; NOTHING:
                     infinity */
  float arrival[3];     /**< unit direction of the ray that arrived */
  float normal[3];      /**< unit geometric normal; MEDIUM, NOTHING: 0 */
  float shading[3];     /**< unit shading normal, with bump and normal maps; 0 where nothing was
                           shaded */
  float uv[2];          /**< texture coordinates */
  float throughput[4];  /**< of the path on arrival: the factor on radiance that arrives from
                         * here on
                         */
  const char *bsdf;     /**< kind of the BSDF or phase function: a constant string; null where
                           nothing was shaded */
  float reflectance[4]; /**< the material's reflectance at this point; 0 for materials without
                           one */
  /** The texture of the reflectance: its kind ("image", "checkerboard", ...), null for a
   * constant; and the path of the first image in it, null without one. Strings live as long as
   * the world. */
  const char *texture, *image;
  uint32_t lobe;      /**< bits of the sampled lobe */
  float direction[3]; /**< ON: unit direction in which the path goes on */
  /** density of that direction per solid angle; of a specular lobe its probability */
  float pdf;
  float factor[4]; /**< BSDF times cosine over pdf: the step's factor on the throughput */
  float survival;  /**< probability with which Russian roulette keeps the path; 1: it was not
                    * applied
                    */
} vlPathVertex;

/** How light got into the path. SAMPLED: light sampling at the vertex. HIT: the path's ray met
 * an emissive surface, at the vertex. SKY: the ray left the scene towards an infinite light.
 * MEDIUM: emission of media between the previous vertex and this one. */
typedef enum vlPathLightEvent {
  VL_PATH_LIGHT_SAMPLED,
  VL_PATH_LIGHT_HIT,
  VL_PATH_LIGHT_SKY,
  VL_PATH_LIGHT_MEDIUM
} vlPathLightEvent;

/** What a light adds to a path's radiance. */
typedef struct vlPathContribution {
  vlPathLightEvent event; /**< how the light was found */
  uint32_t vertex;        /**< index of the vertex in vlPath.vertices */
  uint32_t light;         /**< number of the light in the world, from 1; MEDIUM: 0 */
  /** "area", "point", "infinite", ...: a constant string; MEDIUM: "medium" */
  const char *type;
  uint32_t object; /**< id of the emissive object; 0: a light without a shape */
  bool distant;    /**< the light is infinitely far */
  bool occluded;   /**< SAMPLED: something hides the light; the contribution is 0 */
  float target[3]; /**< the point on the light; if distant: the unit direction towards it;
                    * MEDIUM: 0
                    */
  float light_pdf; /**< density per solid angle of light sampling, with the choice of the light;
                      0: it cannot make this path. A delta light: the probability of choosing it
                    */
  float bsdf_pdf;  /**< density per solid angle of BSDF or phase-function sampling; 0: it cannot
                      make this path */
  float weight;    /**< weight of multiple importance sampling, 0 to 1 */
  float radiance[4]; /**< by channel: throughput, BSDF, light, weight and transmittance
                        multiplied */
  float rgb[3];      /**< the same in the film's colour space, times vlPath.camera_weight */
} vlPathContribution;

/** A path: one sample that counts in the pixel. */
typedef struct vlPath {
  int32_t x, y;    /**< the pixel in which the sample was taken: the pixel itself, or one of its
                      neighbours (then it may lie outside the image) if pixels share samples
                      (vlRenderDef.share_samples) */
  uint32_t sample; /**< index of the sample in that pixel */
  float film[2];   /**< film point, pixels from the image's top left corner */
  float origin[3]; /**< the camera ray */
  float direction[3]; /**< unit length */
  float time;         /**< seconds; if something in the world moves: the world's time, 0 to 1 */
  float filter_weight; /**< weight of the sample in the pixel whose paths these are */
  float camera_weight; /**< factor of the lens (vignetting) on the radiance; 0: the camera has
                          no ray here, or the sample shows the removed background */
  float lambda[4];     /**< wavelengths, nm; 0 in RGB mode */
  float inv_pdf[4];    /**< 1 / density of each wavelength, nm; 1 in RGB mode */
  float radiance[4];   /**< by channel: the float sum of the contributions in their order, times
                          camera_weight. Not finite: the film drops the sample */
  float rgb[3]; /**< the sample as the film adds it: in its colour space, exposed and limited to
                   max_component */
  const vlPathVertex *vertices; /**< in the order of the path; none if the camera has no ray */
  const vlPathContribution *contributions;   /**< in the order in which the tracer added them */
  uint32_t vertex_count, contribution_count; /**< their numbers */
} vlPath;

/** Paths of a pixel, of one block of memory. */
typedef struct vlPixelPaths {
  uint32_t x, y;       /**< the pixel */
  uint32_t tracer;     /**< the tracer that was used */
  uint32_t samples;    /**< number of samples per pixel that were traced */
  uint32_t count;      /**< number of paths: samples, or more if pixels share samples */
  const vlPath *paths; /**< in the order of samples; of one index the pixel's own comes first */
  double mean[3];      /**< sum of filter_weight * rgb over the sum of filter_weight, over the
                          samples that are finite: the pixel of a film with these samples,
                          without its exposure */
  uint32_t dropped;    /**< number of samples that are not finite */
} vlPixelPaths;

/** Traces samples first to first + count - 1 of a pixel again, and records them. If pixels
 * share samples, these are the samples of the same indices that the pixel and its neighbours
 * took and that count in the pixel. The random numbers, the tracer's code and the bits of each
 * path's rgb are those of vl_render with the same world, camera, film def and render def, of
 * which first_sample, noise, time_limit and progress are ignored. count is 1 to 2^20. *paths is
 * owned by the caller (vl_pixel_paths_destroy). A null render def means the default.
 *
 * Errors: ARGUMENT: a pixel outside the film's crop, a camera of another size, a tracer other
 * than path and volpath. MEMORY. CANCELLED: def->cancel was requested; the call looks after at
 * most 256 paths. It runs on the calling thread alone. Must not be called from inside a
 * parallel loop. */
VL_API vlResult vl_trace_paths(const vlWorld *world, const vlCamera *camera,
                               const vlFilmDef *film, const vlRenderDef *def, uint32_t x,
                               uint32_t y, uint32_t first, uint32_t count, vlPixelPaths **paths,
                               vlError *error);
/** Frees the paths; null is ignored. */
VL_API void vl_pixel_paths_destroy(vlPixelPaths *paths);

#ifdef __cplusplus
}
#endif
#endif
