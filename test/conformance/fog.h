/* conformance/fog.h: the law of light in fog: in a closed room full of a medium that scatters
 * and absorbs, where rays pass the surface of the lamp, tracers that find all light agree. */
#ifndef TEST_CONFORMANCE_FOG_H
#define TEST_CONFORMANCE_FOG_H

#include "conformance.h"
#include "transport.h"
#include "unit.h"

/* Most light is scattered several times. The lamp is the last shape. */
static const char *const foggy_room =
    "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [.1 .1 .1] "
    "\"rgb sigma_s\" [2 2 2] \"float g\" .3 MediumInterface \"fog\" \"fog\"\n"
    "LookAt 0 0 .9 0 0 -1 0 1 0 Camera \"perspective\" \"float fov\" 80\n" VIEW("8")
    "Integrator \"volpath\" \"integer maxdepth\" 6 WorldBegin MediumInterface \"fog\" \"fog\"\n"
    "Material \"diffuse\" \"rgb reflectance\" [.7 .7 .7]\n" BOX_FROM("-1", "1")
    "AreaLightSource \"diffuse\" \"rgb L\" [20 20 20] "
    "Shape \"bilinearmesh\" \"point3 P\" [-.2 .3 .2 .2 .3 .2 -.2 .3 -.2 .2 .3 -.2]\n";

enum { FOG_SPP = 5120 };

/* Rays pass the surface of the lamp: what they meet behind it, they see through it. */
static vlImage *image_of_fog(const char *tracer, uint32_t spp) {
  vlScene *scene = scene_in(VL_COLOR_RGB, foggy_room, tracer, VL_PIXEL_FILTER_BOX, spp);
  const vlMaterialDef border = vl_default_material_def(VL_MATERIAL_INTERFACE);
  const vlShapeId lamp = {2};
  vlShapeDef def = *vl_scene_shape(scene, lamp);
  vlError error = {0};
  def.material = vl_scene_add_material(scene, &border);
  assert_int_equal(vl_scene_set_shape(scene, lamp, &def, &error), VL_OK);
  return need_image(scene, foggy_room);
}

static void tracers_in_fog(void **state) {
  (void)state;
  const vlKindFamily *family = vl_kind_family_find("tracers");
  vlImage *paths = image_of_fog("volpath", FOG_SPP);
  const double whole = mean_of_green(paths);
  for (uint32_t k = 0; k < family->kind_count; k++) {
    const TracerCase *c = tracer_cases[k];
    if (!c->room_spp || k == VL_TRACER_VOLPATH)
      continue;
    vlImage *image = image_of_fog(family->rows[k]->name, 3 * c->room_spp);
    const Mean off = mean_difference(image, paths);
    vl_image_destroy(image);
    const double min = k == VL_TRACER_BIDIRECTIONAL ? 0.1 : 0.45; /* single paths are bright */
    check_mean("tracers", family->rows[k]->name, "a room full of fog", &off, 0,
               (Sight){(c->blurs ? 0.15 : 0.002) * whole, min * whole});
  }
  vl_image_destroy(paths);
  expect_no_failures();
}

#endif
