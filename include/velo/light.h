/** @file
 * velo/light.h: lights: their kinds, the def with their parameters, and the emission of shapes.
 */
#ifndef VELO_LIGHT_H
#define VELO_LIGHT_H

#include "velo/image.h"
#include "velo/spectrum.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Emission of surfaces. The emitted radiance is scale * L in units in which a spectrum L with
 * Y = 1 has luminance 1. As in pbrt (SpectrumToPhotometric, book 12.1), named, blackbody and
 * sampled spectra are first divided by their own Y. */
struct vlEmissionDef {
  uint32_t cookie;
  vlSource source;     /**< where the file describes it */
  vlSpectrum radiance; /**< L */
  float scale;         /**< factor on radiance */
  double power; /**< total power, lumens (pbrt's "power"); it determines the scale; VL_UNSET:
                   not used */
  /** Radiant power of each face from 360 to 830 nm, W; above 0, in place of power.
   * vl_scene_add_emission turns it into power, and the scene's def has VL_UNSET. Default
   * VL_UNSET. */
  double radiant_power;
  bool two_sided; /**< true: both sides emit light; false: only the side of the normal */
  /** Full angle about the normal into which each point emits, radians, 1 to 180 degrees. Below
   * 180 degrees the radiance at an angle a from the normal is multiplied by
   * max(0, 1 - tan a / tan h) / (1 - h / tan h), h half of the spread: what a grid of slats in
   * front of the surface lets pass (a soft box), scaled to the same power. Default: 180
   * degrees, the same radiance in all directions. */
  float spread;
  const char *image;   /**< path of an emission image over uv; null: none; or */
  vlTextureId texture; /**< a colour texture of kind VL_TEXTURE_IMAGE: emits its value times
                          scale; radiance is ignored */
};
/** The default def. */
VL_API vlEmissionDef vl_default_emission_def(void);
/** Adds an emission, which any number of shapes may use. Returns index 0 on error. */
VL_API vlEmissionId vl_scene_add_emission(vlScene *scene, const vlEmissionDef *def);

/** X(kind, name) for each kind of light. velo/schema.h describes the kinds and their
 * parameters. A goniometric light's image is an equal-area octahedral square (pbrt book 3.8.3)
 * with the light's y axis as its axis. A projection light's image is its intensity, projected
 * along the light's z axis with y up. */
#define VL_LIGHT_KINDS(X)              \
  X(VL_LIGHT_POINT, point)             \
  X(VL_LIGHT_SPOT, spot)               \
  X(VL_LIGHT_DISTANT, distant)         \
  X(VL_LIGHT_INFINITE, infinite)       \
  X(VL_LIGHT_GONIOMETRIC, goniometric) \
  X(VL_LIGHT_PROJECTION, projection)
/** The kinds of lights: VL_LIGHT_POINT and so on, from VL_LIGHT_KINDS. */
typedef enum vlLightKind {
#define VL_KIND(kind, name) kind,
  VL_LIGHT_KINDS(VL_KIND)
#undef VL_KIND
} vlLightKind;
/** A light that is not a surface. */
struct vlLightDef {
  uint32_t cookie;
  vlSource source;    /**< where the file describes it */
  vlLightKind kind;   /**< which fields below are read */
  vlSpectrum color;   /**< intensity (point, spot, ...) or radiance (distant, infinite) */
  float scale;        /**< factor on color or image */
  double power;       /**< lights that emit from a point: total power, lumens; it determines the
                         scale; VL_UNSET: not used */
  double illuminance; /**< distant, infinite: illuminance, lux; it determines the scale;
                         VL_UNSET: not used */
  /** Radiometric forms, all from 360 to 830 nm and above 0; at most one of them, and none
   * beside the photometric form. vl_scene_add_light turns them into power, illuminance and
   * scale by the colour's spectrum and 683 lm/W (docs/lights.md), and the scene's def has
   * VL_UNSET. SCENE for lights whose colour is that of an image. Default VL_UNSET.
   * radiant_power: W, of all directions, as power. radiant_intensity: point and spot, W/sr, of
   * a spot along its axis. irradiance: distant and infinite, W/m^2, as illuminance. */
  double radiant_power, radiant_intensity, irradiance;
  double world_from_light[16]; /**< light space to world space */
  float from[3], to[3]; /**< light space. Point: its position is `from`; spot, distant: emits in
                           the direction from `from` to `to` */
  float cone_angle, cone_delta; /**< spot: angle between the cone's axis and its edge, and width
                                   of the falloff inside it; radians */
  bool cone_squared; /**< true: the falloff is t^2, t linear in the cosine, as in glTF; false:
                        pbrt's smooth step 3t^2 - 2t^3 */
  const char *path;  /**< path of the image, or of a lamp file (goniometric); infinite: a square
                        equal-area octahedral map (pbrt book 3.8.3); null: uniform light */
  const vlImage *image;  /**< the image in memory, in place of path; copied */
  const void *lamp_data; /**< goniometric: the contents of a lamp file in memory, in place of
                            path and image; copied */
  size_t lamp_size;      /**< length of lamp_data, bytes */
  vlColorSpace space;    /**< colour space of an image that names none; an image replaces color,
                            and its values are multiplied by scale */
  vlMediumId medium;     /**< the medium around the light */
  float fov; /**< projection: radians across the image's smaller side; default pi/2 */
  /** Infinite with an image: the light enters only through the rectangle `portal` in the world,
   * in directions to the side that (last - first) x (second - first) points to. A point from
   * which the portal is not seen in such a direction gets no light. */
  bool has_portal;
  float portal[4][3]; /**< the four corners, in order around the rectangle, world space */
};
/** The default def of a kind. */
VL_API vlLightDef vl_default_light_def(vlLightKind kind);
/** Adds a light. Returns index 0 on error. */
VL_API vlLightId vl_scene_add_light(vlScene *scene, const vlLightDef *def);

#ifdef __cplusplus
}
#endif
#endif
