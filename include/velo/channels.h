/** @file
 * velo/channels.h: ground truth: what each pixel sees, as numbers. Depth, position, normals, albedo, ids, flow: never
 * filtered, never mixed between neighbours, always 32-bit; and Cryptomatte, which counts the image's own samples.
 * docs/ground-truth.md says what each channel means. */
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

/** Bits of a set of channels. World space, world units; "nothing" is what a pixel holds that meets no surface. */
typedef enum vlChannel {
  VL_CHANNEL_Z = 1 << 0,         /**< Z: depth along the view axis, camera space; nothing: +infinity */
  VL_CHANNEL_DISTANCE = 1 << 1,  /**< distance.Y: along the ray from its origin; nothing: +infinity */
  VL_CHANNEL_P = 1 << 2,         /**< P.X P.Y P.Z: origin + distance * ray; nothing: 0 0 0, as all that follow */
  VL_CHANNEL_N = 1 << 3,         /**< N.X N.Y N.Z: unit normal of shading, bump and normal maps included */
  VL_CHANNEL_NG = 1 << 4,        /**< Ng.X Ng.Y Ng.Z: unit normal of the surface itself */
  VL_CHANNEL_UV = 1 << 5,        /**< uv.U uv.V */
  VL_CHANNEL_ALBEDO = 1 << 6,    /**< albedo.R albedo.G albedo.B: reflectance under the colour space's white, linear */
  VL_CHANNEL_RAY = 1 << 7,       /**< ray.X ray.Y ray.Z: unit direction; also where nothing is met */
  VL_CHANNEL_ID_OBJECT = 1 << 8, /**< id.object: shape, in the order of the file, from 1; nothing: 0 */
  VL_CHANNEL_ID_MATERIAL = 1 << 9,   /**< id.material: 1 is the default material, then in the order of the file */
  VL_CHANNEL_ID_INSTANCE = 1 << 10,  /**< id.instance: from 1; 0 also for what is no part of an instance */
  VL_CHANNEL_ID_PRIMITIVE = 1 << 11, /**< id.primitive: face of the shape, from 1 */
  VL_CHANNEL_SAMPLES = 1 << 12,      /**< samples: of the image's pixel, as the def says */
  VL_CHANNEL_FILM = 1 << 13,         /**< film.X film.Y: the point of the film, from the pixel's top left corner */
  /** These cost more, and are not among ALL. */
  VL_CHANNEL_ERROR = 1 << 14,           /**< error.R error.G error.B: standard error of the image; needs a film with
                                         * vlFilmDef.errors; infinity below 2 samples */
  VL_CHANNEL_FORWARD = 1 << 15,         /**< forward.U forward.V, pixels, to where `forward` sees the same point of the
                                         * same surface (or direction of the sky); uint forward.hidden: vlHidden */
  VL_CHANNEL_BACKWARD = 1 << 16,        /**< backward.U backward.V backward.hidden: the same with `backward` */
  VL_CHANNEL_CRYPTO_OBJECT = 1 << 17,   /**< CryptoObject00.R ...: Cryptomatte, `ranks` pairs of id and coverage */
  VL_CHANNEL_CRYPTO_MATERIAL = 1 << 18, /**< CryptoMaterial00.R ... */
  VL_CHANNEL_CRYPTO_INSTANCE = 1 << 19  /**< CryptoInstance00.R ... */
} vlChannel;
enum { VL_CHANNEL_COUNT = 20, VL_CHANNEL_ALL = (1 << 14) - 1 };

/** Which of the pixel's points of the film the channels tell about. CENTRE: its exact centre. The others choose among
 * the points that the image's samples have (through the middle of the lens, in the middle of the shutter's time).
 * NEAREST: the one of smallest depth. COVERAGE: of the surface (object and instance, or nothing) whose samples weigh
 * most in the pixel filter, the one closest to the centre. */
typedef enum vlChannelMode { VL_CHANNEL_MODE_CENTRE, VL_CHANNEL_MODE_NEAREST, VL_CHANNEL_MODE_COVERAGE } vlChannelMode;

/** Whether the other camera sees what this pixel sees: it does; something stands before it; it lies outside the other
 * image (or is cut by its near or far plane), the numbers are true all the same; no pixel could show it, U = V = 0.
 */
typedef enum vlHidden { VL_HIDDEN_NOT, VL_HIDDEN_BEHIND, VL_HIDDEN_OUTSIDE, VL_HIDDEN_NOWHERE } vlHidden;

/** "Z", "distance", "P", ...: the name of bit `index`; null past the end. */
VL_API const char *vl_channel_name(uint32_t index);

typedef struct vlChannelsDef {
  uint32_t cookie;
  uint32_t channels;  /**< bits; default all */
  uint32_t crop[4];   /**< x0, y0, x1, y1, exclusive: the pixels that are wanted; default all */
  vlColorSpace space; /**< of the albedo */
  uint32_t samples;   /**< what the channel `samples` holds */
  vlChannelMode mode;
  uint32_t ranks; /**< of Cryptomatte: an even number, 2 to 32; default 6 */
  /** The image's film and how it was rendered: ERROR, Cryptomatte and the modes that choose among the image's
   * samples need them; else they may be null. */
  const vlFilm *film;
  const vlRenderDef *render;
  float exposure;                     /**< of the developed image, for ERROR; default 1 */
  const vlCamera *forward, *backward; /**< the other cameras of FORWARD and BACKWARD */
  double time;    /**< seconds: when all of it is seen; unset: in the middle of the shutter's time */
  vlStopFn *stop; /**< to give up with VL_CANCELLED; default null: never */
  void *stop_user;
} vlChannelsDef;
VL_API vlChannelsDef vl_default_channels_def(uint32_t width, uint32_t height);

/** One ray through a point of each pixel, by default its exact centre, without lens, in the middle of the shutter's
 * time. New images of the crop window: VL_PIXEL_F32 with the channels that are numbers, VL_PIXEL_U32 with ids and
 * samples; null where the def wants none of the kind (the pointer may be null then). The same bits for any number of
 * threads, instruction set and crop. Pixels outside the camera's domain hold nothing, their ray is 0 0 0.
 * What moves is seen at one time (Cryptomatte: at the times of the image's samples), by a camera held there, all rows
 * of a rolling shutter at once: vl_camera_at(camera, time). The middle of the shutter's time is when half of the light
 * has come to the middle of the image: vl_camera_time. Flow leads to where the point of the surface is in the middle
 * of the other camera's time.
 * Cryptomatte's header (cryptomatte/.../name, hash, conversion, manifest) are attributes of *floats. Not from inside a
 * parallel body. */
VL_API vlResult vl_render_channels(const vlWorld *world, const vlCamera *camera, const vlChannelsDef *def,
                                   vlImage **floats, vlImage **ids, vlError *error);

/* ---- what the ids stand for ------------------------------------------------------------------------------------- */

typedef enum vlIdKind { VL_ID_OBJECT, VL_ID_MATERIAL, VL_ID_INSTANCE } vlIdKind;
typedef struct vlIdInfo {
  const char *name;  /**< of a material, as the scene calls it; of an instance, its group's; may be null */
  const char *type;  /**< "triangles", "sphere", "diffuse", "instance", ... */
  vlSource source;   /**< file is null where the scene did not say */
  uint32_t material; /**< objects: their id.material */
} vlIdInfo;
/** Ids are 1 to this number. */
VL_API uint32_t vl_world_id_count(const vlWorld *world, vlIdKind kind);
/** The 32 bits that stand for a name in a Cryptomatte: MurmurHash3_32, so that the same bits are an ordinary float. */
VL_API uint32_t vl_cryptomatte_hash(const char *name);
/** Strings live as long as the world. ARGUMENT when there is no such id. */
VL_API vlResult vl_world_id_info(const vlWorld *world, vlIdKind kind, uint32_t id, vlIdInfo *info);

#ifdef __cplusplus
}
#endif
#endif
