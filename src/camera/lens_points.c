/* camera/lens_points.c: points of an aperture that is not a plain disc: sampled by its shape,
 * rotated, then scaled. Not a hot file: blades and images need table lookups. */
#include "camera/lens.h"

void vl_lens_points(const vlCameraCompiled *c, uint32_t n, const float *u, const float *v,
                    float *x, float *y) {
  if (c->aperture)
    vl_aperture_points(c->aperture, n, u, v, x, y);
  else if (c->blades.count)
    vl_blades_points(&c->blades, n, u, v, x, y);
  else
    for (uint32_t i = 0; i < n; i++) {
      vlLensPoint p = vl_lens_disk(u[i], v[i]);
      x[i] = p.x;
      y[i] = p.y;
    }
  double cosine = c->aperture ? c->lens_turn[0] : 1.0,
         sine = c->aperture ? c->lens_turn[1] : 0.0;
  for (uint32_t i = 0; i < n; i++) {
    double px = (double)x[i], py = (double)y[i];
    x[i] = (float)(c->inv_ratio * (cosine * px - sine * py));
    y[i] = (float)(sine * px + cosine * py);
  }
}
