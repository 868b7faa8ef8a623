/* light/compile.h: functions shared by the files that compile lights. */
#ifndef LIGHT_COMPILE_H
#define LIGHT_COMPILE_H

#include "scene/scene.h"
#include "texture/lookup.h"
#include "velo/light.h"
#include "world/world.h"

/* Compiles a colour as a spectrum of luminance 1, times the scale of the colour itself, times
 * factor. */
vlResult vl_light_color(vlWorld *world, const vlSpectrum *color, float factor, vlEmitted *e,
                        vlError *error);
/* Compiles the spectrum that texels of an image multiply: the illuminant of the colour space,
 * with luminance 1. */
void vl_light_image_color(vlWorld *world, vlColorSpace space, float scale, vlEmitted *e);
/* The colour space that the image declares; `otherwise` if it declares none. */
vlColorSpace vl_light_image_space(const vlWorld *world, int32_t image, vlColorSpace otherwise);
/* Sets `corners` of a light at a point: the map from world directions to the light's. `order`
 * and `sign` permute and flip the axes of the light. An error if its transform is singular. */
vlResult vl_light_set_frame(const vlLightDef *def, const int order[3], const float sign[3],
                            vlWorldLight *light, vlError *error);
/* Luminance of a constant emitted spectrum. */
float vl_light_luminance(const vlSpectral *spectrum);
/* Luminance of a texel of this colour space. */
float vl_light_texel_luminance(vlTexel t, uint32_t channels, vlColorSpace space);
/* Reports a pixel of an image, by its name, whose luminance is not finite. null: it has no
 * name. */
vlResult vl_light_bad_pixel(const char *name, uint32_t x, uint32_t y, vlError *error);

/* Adds one light per emitting face of an emissive shape (shape_lights.c). compiled: one entry
 * per emission of the scene: its index in world->emitted, which its shapes share; VL_NONE: not
 * compiled yet. */
vlResult vl_world_add_shape_lights(vlWorld *world, const vlScene *scene, uint32_t shape,
                                   uint32_t *compiled, vlError *error);
/* There is one function per kind of light in the scene (light/kinds.row.h). It sets colour,
 * power and the members that only this kind has. The caller has set the position, the direction
 * (unit length; for lights at infinity, towards the light) and the traits. */
typedef vlResult vlCompileLight(vlWorld *world, const vlLightDef *def, vlWorldLight *light,
                                vlEmitted *e, vlError *error);
/* Makes the distribution of an environment whose image is set. Results: mean_luminance, of the
 * image; illuminance, of a horizontal surface lit by the environment (environment.c). */
vlResult vl_world_build_environment(vlWorld *world, vlEnvironment *env, double *mean_luminance,
                                    double *illuminance, vlError *error);
/* Adds a portal to an environment image; env holds the rotation of the image. power: receives
 * the power of the light that passes through the portal (portal.c). */
vlResult vl_world_add_portal(vlWorld *world, const vlLightDef *def, vlEnvironment *env,
                             double *power, vlError *error);

#endif
