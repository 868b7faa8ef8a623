/** @file
 * velo/channels.h: ground truth: what each pixel sees, as numbers. Depth, position, normals,
 * albedo, ids and flow have 32 bits and are never filtered, so that each value belongs to one
 * surface point. Cryptomatte is computed from the image's own samples. docs/ground-truth.md
 * defines each channel. */
#ifndef VELO_CHANNELS_H
#define VELO_CHANNELS_H

#include "velo/base.h"
#include "velo/camera.h"
#include "velo/image.h"
#include "velo/render.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Ground truth channels, as bits of a set. Values are in world space and scene units unless
 * stated otherwise. "nothing: v" gives the value v of a pixel whose ray meets no surface. */
typedef enum vlChannel {
  /** Z: depth along the view axis, camera space; nothing: +infinity */
  VL_CHANNEL_Z = 1 << 0,
  /** distance.Y: distance from the ray's origin along the ray; nothing: +infinity */
  VL_CHANNEL_DISTANCE = 1 << 1,
  /** P.X P.Y P.Z: position, origin + distance * ray; nothing: 0 0 0, as for N, Ng, uv and
   * albedo */
  VL_CHANNEL_P = 1 << 2,
  /** N.X N.Y N.Z: unit shading normal, with bump and normal maps */
  VL_CHANNEL_N = 1 << 3,
  /** Ng.X Ng.Y Ng.Z: unit geometric normal */
  VL_CHANNEL_NG = 1 << 4,
  /** uv.U uv.V: texture coordinates */
  VL_CHANNEL_UV = 1 << 5,
  /** albedo.R albedo.G albedo.B: reflectance under the colour space's white, linear */
  VL_CHANNEL_ALBEDO = 1 << 6,
  /** ray.X ray.Y ray.Z: unit direction of the ray, also if it meets nothing */
  VL_CHANNEL_RAY = 1 << 7,
  /** id.object: number of the shape in the order of the file, from 1; nothing: 0 */
  VL_CHANNEL_ID_OBJECT = 1 << 8,
  /** id.material: 1 is the default material; the others follow in the order of the file */
  VL_CHANNEL_ID_MATERIAL = 1 << 9,
  /** id.instance: number of the instance, from 1; 0 for nothing and for objects in no
   * instance */
  VL_CHANNEL_ID_INSTANCE = 1 << 10,
  /** id.primitive: number of the face in its shape, from 1 */
  VL_CHANNEL_ID_PRIMITIVE = 1 << 11,
  /** samples: samples per pixel of the image, vlChannelsDef.samples */
  VL_CHANNEL_SAMPLES = 1 << 12,
  /** film.X film.Y: the film point, pixels from the pixel's top left corner */
  VL_CHANNEL_FILM = 1 << 13,
  /* The following channels cost more and are not part of VL_CHANNEL_ALL. */
  /** error.R error.G error.B: standard error of the image; needs a film with vlFilmDef.errors;
   * infinity below 2 samples */
  VL_CHANNEL_ERROR = 1 << 14,
  /** forward.U forward.V: flow in pixels to the image of the camera vlChannelsDef.forward, for
   * the same point of the same surface (or direction of the sky); forward.hidden: a vlHidden,
   * as uint */
  VL_CHANNEL_FORWARD = 1 << 15,
  /** backward.U backward.V backward.hidden: the same for the camera vlChannelsDef.backward */
  VL_CHANNEL_BACKWARD = 1 << 16,
  /** CryptoObject00.R ...: Cryptomatte, `ranks` pairs of id and coverage */
  VL_CHANNEL_CRYPTO_OBJECT = 1 << 17,
  VL_CHANNEL_CRYPTO_MATERIAL = 1 << 18, /**< CryptoMaterial00.R ... */
  VL_CHANNEL_CRYPTO_INSTANCE = 1 << 19, /**< CryptoInstance00.R ... */
  /** feature.albedo.R .G .B, feature.N.X .Y .Z, feature.disparity.Y: features for denoisers
   * (vl_denoise). They are means over the first samples of each pixel (8 to VL_FEATURE_SAMPLES;
   * 4 where these agree and nothing moves) and those it shares, through the lens; so they are
   * blurred as the image is, at edges, by defocus and by motion. The albedo uses fewer
   * wavelengths than the channel albedo. The disparity is 1 / distance, 0 for nothing. They
   * need vlChannelsDef.film and .render, as Cryptomatte does. With VL_CHANNEL_ERROR there are
   * also feature.error.R .G .B: vl_film_errors with vlDevelopDef.independent. */
  VL_CHANNEL_FEATURES = 1 << 20,
  /** luminance.Y: luminance of the image's pixel, cd/m^2 (docs/conventions.md, Light), by the
   * standard observer, before exposure. It needs vlChannelsDef.film of the same crop, with the
   * sensor cie1931 and no white balance. */
  VL_CHANNEL_LUMINANCE = 1 << 21,
  /** illuminance.Y: illuminance of the visible surface, lx, in scenes in metres: 683 lm/W times
   * the integral over wavelengths of CIE V(lambda) of 1924 times the irradiance of the first
   * surface, on the side of its shading normal that is seen. It is pi times the luminance that
   * a white diffuse surface would have in its place, without what is between it and the camera
   * (docs/ground-truth.md, Illuminance): mean over the pixel's area that shows a surface; 0
   * where none is seen. It is a render of its own with as many samples per pixel as the image,
   * by VL_TRACER_VOLPATH whatever tracer made the image. It needs vlChannelsDef.film and
   * .render, as Cryptomatte does; sensor, white balance, exposure and vignetting do not apply.
   */
  VL_CHANNEL_ILLUMINANCE = 1 << 22
} vlChannel;
/** The number of channels; the default set, which has all cheap channels; the largest number of
 * samples per pixel that features use. */
enum { VL_CHANNEL_COUNT = 23, VL_CHANNEL_ALL = (1 << 14) - 1, VL_FEATURE_SAMPLES = 16 };

/** The film point at which a pixel's channels are computed. CENTRE: the pixel's exact centre.
 * The other modes select one of the points of the image's samples (traced through the centre of
 * the lens, at the middle of the row's exposure). NEAREST: the point with the smallest depth.
 * COVERAGE: first the surface (object and instance, or nothing) whose samples have the greatest
 * total filter weight is selected, then the point on it that is closest to the pixel's
 * centre. */
typedef enum vlChannelMode {
  VL_CHANNEL_MODE_CENTRE,
  VL_CHANNEL_MODE_NEAREST,
  VL_CHANNEL_MODE_COVERAGE
} vlChannelMode;

/** Whether the other camera sees the surface point of this pixel. NOT: it does. BEHIND: another
 * surface occludes the point. OUTSIDE: the point lies outside the other image, or a near or far
 * plane clips it; the flow is still valid. NOWHERE: the point has no projection, and U = V =
 * 0. */
typedef enum vlHidden {
  VL_HIDDEN_NOT,
  VL_HIDDEN_BEHIND,
  VL_HIDDEN_OUTSIDE,
  VL_HIDDEN_NOWHERE
} vlHidden;

/** "Z", "distance", "P", ...: the name of bit `index`; a constant string; null past the end. */
VL_API const char *vl_channel_name(uint32_t index);

/** Which ground truth to compute. Pointers must stay valid during the call. */
typedef struct vlChannelsDef {
  uint32_t cookie;
  uint32_t channels;  /**< bits of vlChannel; default VL_CHANNEL_ALL */
  uint32_t crop[4];   /**< pixels: x0, y0, x1, y1, exclusive; default all */
  vlColorSpace space; /**< colour space of the albedo */
  uint32_t samples; /**< value of the channel `samples`; of an adaptive film each block has its
                       own number */
  vlChannelMode mode; /**< film point; default CENTRE */
  uint32_t ranks;     /**< number of Cryptomatte's ids per pixel: even, 2 to 32; default 6 */
  /** The image's film and the def with which it was rendered. Required for ERROR, LUMINANCE,
   * ILLUMINANCE, FEATURES, Cryptomatte and the modes NEAREST and COVERAGE; otherwise they may
   * be null. */
  const vlFilm *film;
  const vlRenderDef *render; /**< see film */
  float exposure; /**< for ERROR: exposure of the developed image (vlDevelopDef.exposure);
                     default 1 */
  const vlCamera *forward, *backward; /**< for FORWARD and BACKWARD: the other cameras */
  double time;     /**< the time at which the scene is shown, seconds; unset: the middle of the
                      exposure, of a rolling shutter that of each row (or column) */
  vlStopFn *stop;  /**< returns true to stop with VL_CANCELLED; default null: never */
  void *stop_user; /**< passed to stop */
  const vlCancel *cancel; /**< stops the call within one tile of 32 x 32 pixels; default null */
  int priority;           /**< as vlRenderDef.priority */
} vlChannelsDef;
/** The default def for an image of this size, in pixels. */
VL_API vlChannelsDef vl_default_channels_def(uint32_t width, uint32_t height);

/** Traces one ray through a point of each pixel, by default its exact centre, through the
 * centre of the lens, at the middle of the exposure. Makes two images of the crop window, owned
 * by the caller: *floats (VL_PIXEL_F32) and *ids (VL_PIXEL_U32), which has the ids and samples.
 * An image without channels is null; its pointer argument may then be null, too. The bits do
 * not depend on the number of threads, the instruction set or the crop. Pixels outside the
 * camera's domain have the values of nothing; their ray is 0 0 0.
 *
 * A pixel shows the scene at one time; only Cryptomatte and FEATURES use the times of the
 * image's samples. The camera is vl_camera_at(camera, time). With def.time all pixels have that
 * time; without it, pixel (x, y) has the time at which half of its light has arrived,
 * vl_camera_time(camera, x + 0.5, y + 0.5, 0.5), so that rows of a rolling shutter follow the
 * image. Flow points to the position of the surface point at the middle of the
 * other camera's exposure; of a rolling shutter, that of the row to which it leads.
 *
 * Cryptomatte's metadata (cryptomatte/.../name, hash, conversion, manifest) are attributes of
 * *floats. Must not be called from inside a parallel loop. Errors: ARGUMENT, MEMORY,
 * CANCELLED. */
VL_API vlResult vl_render_channels(const vlWorld *world, const vlCamera *camera,
                                   const vlChannelsDef *def, vlImage **floats, vlImage **ids,
                                   vlError *error);

/* ---- meaning of the ids ------------------------------------------------------------------ */

/** The kinds of ids. */
typedef enum vlIdKind { VL_ID_OBJECT, VL_ID_MATERIAL, VL_ID_INSTANCE } vlIdKind;
/** What an id stands for. Strings live as long as the world. */
typedef struct vlIdInfo {
  /** Names of the file (vlLabel): of a shape, a material or an instance. Instances without a
   * name have that of their group. May be null. */
  const char *name, *path, *place;
  bool shared_name;  /**< the name is that of the group: other instances have it, too */
  const char *type;  /**< "triangles", "sphere", "diffuse", "instance", ... */
  vlSource source;   /**< location in the scene's file; its `file` is null if not known */
  uint32_t material; /**< the id.material of an object */
} vlIdInfo;
/** The number of ids of a kind. Ids run from 1 to this number. */
VL_API uint32_t vl_world_id_count(const vlWorld *world, vlIdKind kind);
/** The 32-bit id of a name in Cryptomatte: MurmurHash3_32, adjusted so that the same bits are a
 * normal float. */
VL_API uint32_t vl_cryptomatte_hash(const char *name);
/** Fills *info. ARGUMENT when there is no such id. */
VL_API vlResult vl_world_id_info(const vlWorld *world, vlIdKind kind, uint32_t id,
                                 vlIdInfo *info);

#ifdef __cplusplus
}
#endif
#endif
