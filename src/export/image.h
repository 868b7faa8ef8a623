/* export/image.h: images of textures, as the exporters write them. */
#ifndef EXPORT_IMAGE_H
#define EXPORT_IMAGE_H

#include "export/export.h"
#include "velo/texture.h"

/* The texture of an input if it is an image texture; otherwise null. */
const vlTextureDef *vl_export_texture(const vlExport *x, vlTextureId id);
/* How the image goes on outside along t; t->wrap is that along s. */
vlWrap vl_export_wrap_t(const vlTextureDef *t);
/* The uv transform: (s, t) = 2x3 matrix times (u, v, 1). */
void vl_export_st_from_uv(const vlTextureDef *t, double m[6]);
/* The image of a texture that was written already with these changes; null: none. */
vlExportImage *vl_export_find_image(vlExport *x, const vlTextureDef *t, uint32_t variant);
/* Notes that it is written now. Null: the export has failed. */
vlExportImage *vl_export_add_image(vlExport *x, const vlTextureDef *t, uint32_t variant);
/* The image of a texture: the scene's, or decoded into *own, which the caller destroys. Null
 * after an error. */
const vlImage *vl_export_pixels(vlExport *x, const vlTextureDef *t, vlImage **own);
/* The texture's image as bytes of an image file: the original bytes of a PNG or JPEG, otherwise
 * the image encoded as PNG; if `srgb`, with colours converted to sRGB. *suffix receives the
 * format, *kept whether the bytes are the original ones. The bytes are a block of the context.
 */
bool vl_export_image(vlExport *x, const vlTextureDef *t, bool srgb, char **data, size_t *size,
                     const char **suffix, bool *kept);

#endif
