/** @file
 * velo/channels.h: ground truth: what each pixel sees, as numbers. Depth, position, normals, albedo, ids, flow: never
 * filtered, never mixed between neighbours, always 32-bit; and Cryptomatte, computed from the image's own samples.
 * docs/ground-truth.md defines each channel. */
#ifndef VELO_CHANNELS_H
#define VELO_CHANNELS_H

#include "velo/base.h"
#include "velo/camera.h"
#include "velo/image.h"
#include "velo/render.h"
#include "velo/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Ground truth channels, as bits of a set. World space and scene units, unless stated; "nothing" is the value of a
 * pixel whose ray meets no surface. */
typedef enum vlChannel {
  VL_CHANNEL_Z = 1 << 0,         /**< Z: depth along the view axis, camera space; nothing: +infinity */
  VL_CHANNEL_DISTANCE = 1 << 1,  /**< distance.Y: along the ray from its origin; nothing: +infinity */
  VL_CHANNEL_P = 1 << 2,         /**< P.X P.Y P.Z: origin + distance * ray; nothing: 0 0 0, as for the following */
  VL_CHANNEL_N = 1 << 3,         /**< N.X N.Y N.Z: unit shading normal, with bump and normal maps */
  VL_CHANNEL_NG = 1 << 4,        /**< Ng.X Ng.Y Ng.Z: unit geometric normal */
  VL_CHANNEL_UV = 1 << 5,        /**< uv.U uv.V: texture coordinates */
  VL_CHANNEL_ALBEDO = 1 << 6,    /**< albedo.R albedo.G albedo.B: reflectance under the colour space's white, linear */
  VL_CHANNEL_RAY = 1 << 7,       /**< ray.X ray.Y ray.Z: unit direction; also where the ray meets nothing */
  VL_CHANNEL_ID_OBJECT = 1 << 8, /**< id.object: shape, in the order of the file, from 1; nothing: 0 */
  VL_CHANNEL_ID_MATERIAL = 1 << 9,   /**< id.material: 1 is the default material, then in the order of the file */
  VL_CHANNEL_ID_INSTANCE = 1 << 10,  /**< id.instance: from 1; 0 also for objects that are in no instance */
  VL_CHANNEL_ID_PRIMITIVE = 1 << 11, /**< id.primitive: face of the shape, from 1 */
  VL_CHANNEL_SAMPLES = 1 << 12,      /**< samples: of the image's pixel: vlChannelsDef.samples */
  VL_CHANNEL_FILM = 1 << 13,         /**< film.X film.Y: the film point, pixels from the pixel's top left corner */
  /* These cost more, and are not part of VL_CHANNEL_ALL. */
  VL_CHANNEL_ERROR = 1 << 14,           /**< error.R error.G error.B: standard error of the image; needs a film with
                                         * vlFilmDef.errors; infinity below 2 samples */
  VL_CHANNEL_FORWARD = 1 << 15,         /**< forward.U forward.V, pixels, to where `forward` sees the same point of the
                                         * same surface (or direction of the sky); uint forward.hidden: vlHidden */
  VL_CHANNEL_BACKWARD = 1 << 16,        /**< backward.U backward.V backward.hidden: the same with `backward` */
  VL_CHANNEL_CRYPTO_OBJECT = 1 << 17,   /**< CryptoObject00.R ...: Cryptomatte, `ranks` pairs of id and coverage */
  VL_CHANNEL_CRYPTO_MATERIAL = 1 << 18, /**< CryptoMaterial00.R ... */
  VL_CHANNEL_CRYPTO_INSTANCE = 1 << 19, /**< CryptoInstance00.R ... */
  /** feature.albedo.R .G .B, feature.N.X .Y .Z, feature.disparity.Y: for denoisers (vl_denoise). Means over the image's
   * own samples, the first VL_FEATURE_SAMPLES of each pixel, through the lens: smooth where edges, the lens and motion
   * make the image smooth. Albedo from fewer wavelengths than `albedo`; disparity: 1 / distance, 0 for nothing. Needs
   * film and render, as Cryptomatte does. */
  VL_CHANNEL_FEATURES = 1 << 20
} vlChannel;
/** The number of channels; the set of all cheap ones, the default; the most samples that features are means of. */
enum { VL_CHANNEL_COUNT = 21, VL_CHANNEL_ALL = (1 << 14) - 1, VL_FEATURE_SAMPLES = 16 };

/** The film point at which a pixel's channels are computed. CENTRE: the pixel's exact centre. The others choose among
 * the points of the image's samples (through the centre of the lens, at the middle of the exposure). NEAREST: the point
 * of smallest depth. COVERAGE: of the surface (object and instance, or nothing) whose samples have the greatest total
 * filter weight, the point closest to the centre. */
typedef enum vlChannelMode { VL_CHANNEL_MODE_CENTRE, VL_CHANNEL_MODE_NEAREST, VL_CHANNEL_MODE_COVERAGE } vlChannelMode;

/** Whether the other camera sees the surface point of this pixel. NOT: it does. BEHIND: another surface occludes it.
 * OUTSIDE: it lies outside the other image, or is clipped by a near or far plane; the flow is still valid. NOWHERE: it
 * has no projection, U = V = 0. */
typedef enum vlHidden { VL_HIDDEN_NOT, VL_HIDDEN_BEHIND, VL_HIDDEN_OUTSIDE, VL_HIDDEN_NOWHERE } vlHidden;

/** "Z", "distance", "P", ...: the name of bit `index`; a constant string; null past the end. */
VL_API const char *vl_channel_name(uint32_t index);

/** Which ground truth to compute. Pointers must stay valid during the call. */
typedef struct vlChannelsDef {
  uint32_t cookie;
  uint32_t channels;  /**< bits of vlChannel; default VL_CHANNEL_ALL */
  uint32_t crop[4];   /**< pixels: x0, y0, x1, y1, exclusive; default all */
  vlColorSpace space; /**< of the albedo */
  uint32_t samples;   /**< value of the channel `samples` */
  vlChannelMode mode; /**< film point; default CENTRE */
  uint32_t ranks;     /**< of Cryptomatte: an even number, 2 to 32; default 6 */
  /** The image's film and how it was rendered. Required for ERROR, FEATURES, Cryptomatte and the modes that choose
   * among the image's samples; otherwise they may be null. */
  const vlFilm *film;
  const vlRenderDef *render;          /**< as film */
  float exposure;                     /**< for ERROR: exposure of the developed image; default 1 */
  const vlCamera *forward, *backward; /**< for FORWARD and BACKWARD: the other cameras */
  double time;                        /**< seconds: the instant that is shown; unset: the middle of the exposure */
  vlStopFn *stop;                     /**< returns true to stop with VL_CANCELLED; default null: never */
  void *stop_user;                    /**< passed to stop */
} vlChannelsDef;
/** The default def for an image of this size, in pixels. */
VL_API vlChannelsDef vl_default_channels_def(uint32_t width, uint32_t height);

/** Traces one ray through a point of each pixel, by default its exact centre, through the centre of the lens, at the
 * middle of the exposure. Makes images of the crop window, owned by the caller: *floats, VL_PIXEL_F32, and *ids,
 * VL_PIXEL_U32, with ids and samples; null where the def has no such channel (the pointer may be null then). The bits
 * do not depend on threads, instruction set and crop. Pixels outside the camera's domain have the values of nothing;
 * their ray is 0 0 0.
 *
 * Motion is frozen at one time (in Cryptomatte: at the times of the image's samples), as seen by the camera at that
 * time, all rows of a rolling shutter at once: vl_camera_at(camera, time). The middle of the exposure is the time when
 * half of the light has reached the middle of the image: vl_camera_time. Flow points to where the surface point is at
 * the middle of the other camera's exposure.
 *
 * Cryptomatte's header (cryptomatte/.../name, hash, conversion, manifest) is stored as attributes of *floats. Not from
 * inside a parallel body. Errors: ARGUMENT, MEMORY, CANCELLED. */
VL_API vlResult vl_render_channels(const vlWorld *world, const vlCamera *camera, const vlChannelsDef *def,
                                   vlImage **floats, vlImage **ids, vlError *error);

/* ---- meaning of the ids ---------------------------------------------------------------------------------------- */

/** The kinds of ids. */
typedef enum vlIdKind { VL_ID_OBJECT, VL_ID_MATERIAL, VL_ID_INSTANCE } vlIdKind;
/** What an id stands for. Strings live as long as the world. */
typedef struct vlIdInfo {
  const char *name;  /**< a material's name in the scene; an instance's group's name; may be null */
  const char *type;  /**< "triangles", "sphere", "diffuse", "instance", ... */
  vlSource source;   /**< file is null where the scene gave none */
  uint32_t material; /**< objects: their id.material */
} vlIdInfo;
/** The number of ids of a kind; ids are 1 to this number. */
VL_API uint32_t vl_world_id_count(const vlWorld *world, vlIdKind kind);
/** The 32-bit id of a name in Cryptomatte: MurmurHash3_32, adjusted so that the same bits are a normal float. */
VL_API uint32_t vl_cryptomatte_hash(const char *name);
/** Fills *info. ARGUMENT when there is no such id. */
VL_API vlResult vl_world_id_info(const vlWorld *world, vlIdKind kind, uint32_t id, vlIdInfo *info);

#ifdef __cplusplus
}
#endif
#endif
