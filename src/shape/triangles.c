/* shape/triangles.c: the functions of meshes of triangles, as of any shape. The room trace
 * intersects triangles in batches. */
#include "shape/mesh.h"

static void triangles_bounds(const vlWorldShape *shape, uint32_t prim, double low[3],
                             double high[3]) {
  vl_mesh_bounds(shape, 3, prim, low, high);
}

static bool triangles_intersect(VL_UNUSED const vlWorldShape *shape, VL_UNUSED uint32_t prim,
                                VL_UNUSED const double o[3], VL_UNUSED const double d[3],
                                VL_UNUSED double t_min, VL_UNUSED double t_max,
                                VL_UNUSED vlShapeHit *hit) {
  return false;
}

static void triangles_point(VL_UNUSED const vlWorldShape *shape, VL_UNUSED uint32_t prim,
                            VL_UNUSED const vlShapeHit *hit, VL_UNUSED vlSurfacePoint *point) {}

static void triangles_sample(VL_UNUSED const vlWorldShape *shape, VL_UNUSED uint32_t prim,
                             VL_UNUSED float u, VL_UNUSED float v,
                             VL_UNUSED vlSurfacePoint *point, VL_UNUSED double *pdf) {}

static double triangles_pdf(VL_UNUSED const vlWorldShape *shape, VL_UNUSED uint32_t prim,
                            VL_UNUSED const double at[3]) {
  return 0;
}

const vlShapeFunctions vl_triangles_functions = {vl_mesh_compile,     triangles_bounds,
                                                 triangles_intersect, triangles_point,
                                                 triangles_sample,    triangles_pdf};
