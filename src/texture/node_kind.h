/* texture/node_kind.h: the kinds of nodes of compiled textures. */
#ifndef TEXTURE_NODE_KIND_H
#define TEXTURE_NODE_KIND_H

#include "velo/texture.h"

/* There is one kind of node per kind of texture, except for constants: a constant texture
 * compiles to a number or, for colours, to a spectrum. */
typedef enum vlNodeKind {
#define VL_KIND(NAME, name) VL_NODE_##NAME,
  VL_TEXTURE_KINDS(VL_KIND)
#undef VL_KIND
      VL_NODE_SPECTRUM,
  VL_NODE_FLOAT = VL_NODE_CONSTANT
} vlNodeKind;

#endif
