/* import/repair.h: repairs of permissive loading, and what is done without. The importers count
 * them and report the counts once. */
#ifndef IMPORT_REPAIR_H
#define IMPORT_REPAIR_H

#include "velo/scene_base.h"

typedef struct vlRepairs {
  uint64_t normals, uvs, shapes; /* numbers of vertices, and of the shapes that hold them */
  uint32_t images;               /* that are missing */
  uint32_t includes;             /* that were left out */
  char file[512];                /* location of the first repaired shape */
  uint32_t line;
} vlRepairs;

/* Replaces normals of a mesh that are zero or not finite by the sum of the normals of their
 * faces, weighted by area and turned to the side of the face's other normals, and uvs that are
 * not finite by zero. The def's arrays, which the caller owns, are changed. False: out of
 * memory. */
bool vl_repair_mesh(vlContext *context, vlRepairs *repairs, const vlShapeDef *def);
/* Logs the counts, one warning for each that is not zero. `file` is the scene's file. */
void vl_repairs_report(vlContext *context, const vlRepairs *repairs, const char *file);

#endif
