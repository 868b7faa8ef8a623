/* texture/images.h: the images of textures. */
#ifndef TEXTURE_IMAGES_H
#define TEXTURE_IMAGES_H

#include "scene/scene.h"
#include "world/world.h"

/* Index of the image of a texture in world->images; it is read if it is not there yet. -1:
 * error, which is set. */
int32_t vl_texture_image_index(vlWorld *world, const vlScene *scene, const vlTextureDef *def,
                               vlError *error);

#endif
