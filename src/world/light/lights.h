/* world/light/lights.h: what the files that compile lights share. */
#ifndef WORLD_LIGHT_LIGHTS_H
#define WORLD_LIGHT_LIGHTS_H

#include "scene/scene.h"
#include "world/texture/texture_lookup.h"
#include "world/world.h"

/* A colour with luminance 1 (times what rgb or scale say), times factor. */
vlResult vl_light_color(vlWorld *world, const vlSpectrum *color, float factor, vlEmitted *e, vlError *error);
/* For images: the illuminant of the space, luminance 1; texels multiply it. */
void vl_light_image_color(vlWorld *world, vlColorSpace space, float scale, vlEmitted *e);
/* That of the image, where it says so, else this one. */
vlColorSpace vl_light_image_space(const vlWorld *world, int32_t image, vlColorSpace otherwise);
/* That a constant emitted spectrum shows. */
float vl_light_luminance(const vlSpectral *spectrum);
float vl_light_texel_luminance(vlTexel t, uint32_t channels);

/* One for each face that shines of a shape with an emission (shape_lights.c). compiled: by emission of the scene, index
 * into world->emitted of what shapes share; VL_NONE: not yet. */
vlResult vl_world_add_shape_lights(vlWorld *world, const vlScene *scene, uint32_t shape, uint32_t *compiled,
                                   vlError *error);
/* Points whose light an image shapes: goniometric and projection (beam.c). */
vlResult vl_world_add_goniometric(vlWorld *world, const vlLightDef *def, vlWorldLight *light, vlEmitted *e,
                                  vlError *error);
/* The portal of a imaged sky, whose directions env knows; power: of the light that passes through it (portal.c). */
vlResult vl_world_add_portal(vlWorld *world, const vlLightDef *def, vlEnvironment *env, double *power, vlError *error);

#endif
