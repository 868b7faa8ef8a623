/* texture/vertex_color.case.c: what tests know of the texture vertex color. */
#include "texture/texture.case.h"

/* Files cannot name it: vertex colours come with meshes of glTF, PLY and OBJ. */
const TextureCase vertex_color_texture = {
    .variants = {{.parameters = NULL}},
};
