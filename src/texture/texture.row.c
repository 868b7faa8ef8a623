/* texture/texture.row.c: the family of textures: the list of its rows, each from the file of
 * its kind. */
#include "texture/texture.row.h"

const char *const vl_texture_mappings[] = {"uv", "spherical", "cylindrical", "planar", NULL};

#define ROW(kind, name, row, ...) [kind] = &row,
const vlKindFamily vl_texture_family =
    VL_KIND_FAMILY(VL_TEXTURE_KINDS(ROW), VL_TEXTURE_KINDS, "textures", "texture", "Texture");
