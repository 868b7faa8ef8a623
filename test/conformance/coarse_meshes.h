/* conformance/coarse_meshes.h: the law of interpolated normals: on a coarse mesh, whose shading
 * normals are far from those of its faces, tracers that find all light agree. */
#ifndef TEST_CONFORMANCE_COARSE_MESHES_H
#define TEST_CONFORMANCE_COARSE_MESHES_H

#include "conformance.h"
#include "transport.h"
#include "unit.h"

/* An octahedron shaded as a ball on a floor, near a lamp as large as itself. */
static const char *const coarse_ball =
    "LookAt 0 .4 2.4 0 .05 0 0 1 0 Camera \"perspective\" \"float fov\" 26\n" VIEW("12")
    "Integrator \"volpath\" \"integer maxdepth\" 5 WorldBegin "
    "Material \"diffuse\" \"rgb reflectance\" [.8 .8 .8] "
    "Shape \"bilinearmesh\" \"point3 P\" [-2 -.7 2 2 -.7 2 -2 -.7 -2 2 -.7 -2]\n"
    "Shape \"trianglemesh\" \"point3 P\" [.7 0 0 -.7 0 0 0 .7 0 0 -.7 0 0 0 .7 0 0 -.7] "
    "\"normal N\" [1 0 0 -1 0 0 0 1 0 0 -1 0 0 0 1 0 0 -1] \"integer indices\" "
    "[0 2 4 2 1 4 1 3 4 3 0 4 2 0 5 1 2 5 3 1 5 0 3 5]\n"
    "AreaLightSource \"diffuse\" \"rgb L\" [4 4 4] \"bool twosided\" true "
    "Shape \"bilinearmesh\" \"point3 P\" [-.8 .75 .8 .8 .75 .8 -.8 .75 -.8 .8 .75 -.8]\n";

enum { COARSE_SPP = 4096 };

static vlImage *image_of_coarse(const char *tracer, uint32_t spp) {
  return need_image(scene_in(VL_COLOR_RGB, coarse_ball, tracer, VL_PIXEL_FILTER_BOX, spp),
                    coarse_ball);
}

static void tracers_on_coarse_meshes(void **state) {
  (void)state;
  const vlKindFamily *family = vl_kind_family_find("tracers");
  vlImage *paths = image_of_coarse("path", COARSE_SPP);
  const double whole = mean_of_green(paths);
  for (uint32_t k = 0; k < family->kind_count; k++) {
    const TracerCase *c = tracer_cases[k];
    if (!c->room_spp || k == VL_TRACER_PATH)
      continue;
    vlImage *image = image_of_coarse(family->rows[k]->name, 16 * c->room_spp);
    const Mean off = mean_difference(image, paths);
    vl_image_destroy(image);
    check_mean("tracers", family->rows[k]->name, "a coarse mesh shaded as a ball", &off, 0,
               (Sight){(c->blurs ? 0.05 : 0.002) * whole, (c->blurs ? 0.45 : 0.05) * whole});
  }
  vl_image_destroy(paths);
  expect_no_failures();
}

#endif
