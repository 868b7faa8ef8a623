/* shape/triangles.c: the functions of meshes of triangles, as of any shape. The room trace
 * intersects triangles in batches. */
#include "shape/mesh.h"
#include "velo/shape.h"

static void triangles_bounds(const vlWorldShape *shape, uint32_t prim, double low[3],
                             double high[3]) {
  vl_mesh_bounds(shape, 3, prim, low, high);
}

static bool triangles_intersect(const vlWorldShape *shape, uint32_t prim, const double o[3],
                                const double d[3], double t_min, double t_max,
                                vlShapeHit *hit) {
  (void)shape;
  (void)prim;
  (void)o;
  (void)d;
  (void)t_min;
  (void)t_max;
  (void)hit;
  return false;
}

static void triangles_point(const vlWorldShape *shape, uint32_t prim, const vlShapeHit *hit,
                            vlSurfacePoint *point) {
  (void)shape;
  (void)prim;
  (void)hit;
  (void)point;
}

static void triangles_sample(const vlWorldShape *shape, uint32_t prim, float u, float v,
                             vlSurfacePoint *point, double *pdf) {
  (void)shape;
  (void)prim;
  (void)u;
  (void)v;
  (void)point;
  (void)pdf;
}

static double triangles_pdf(const vlWorldShape *shape, uint32_t prim, const double at[3]) {
  (void)shape;
  (void)prim;
  (void)at;
  return 0;
}

const vlShapeFunctions vl_triangles_functions = {vl_mesh_compile,     triangles_bounds,
                                                 triangles_intersect, triangles_point,
                                                 triangles_sample,    triangles_pdf};
