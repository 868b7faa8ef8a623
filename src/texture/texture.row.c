/* texture/texture.row.c: the family of textures: the list of its rows, each from the file of
 * its kind. */
#include "texture/texture.row.h"

const char *const vl_texture_mappings[] = {"uv", "spherical", "cylindrical", "planar", NULL};

#define ROW(NAME, name) [VL_TEXTURE_##NAME] = &vl_texture_row_##name,
VL_KIND_FAMILY(vl_texture_family, VL_TEXTURE_KINDS, ROW, "textures", "texture", "Texture")
