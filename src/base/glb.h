/* base/glb.h: words of a .glb file (glTF 2.0, 4.4): "glTF", the version, and the types "JSON"
 * and "BIN" of chunks. */
#ifndef BASE_GLB_H
#define BASE_GLB_H

enum {
  VL_GLB_MAGIC = 0x46546C67,
  VL_GLB_VERSION = 2,
  VL_GLB_JSON = 0x4E4F534A,
  VL_GLB_BIN = 0x004E4942
};

#endif
