/* test_lamp_light.c: lights by lamp files, as they are rendered: what arrives at a sphere
 * around the lamp, in every direction and in sum; turned lamps; scale and power; the same bits.
 */
#include "render/shots.h"
#include "velo/lamp.h"
#include "velo/projection.h"

#define PI 3.14159265358979323846
#define FILE_NAME VELO_SOURCE_DIR "/scenes/lamps/wall_washer.ies"

enum { WIDE = 96, HIGH = 48 };

typedef struct Shining {
  const char *path;
  double power; /* lm; 0: not given */
  float scale;
  const double *turn; /* world from light */
} Shining;

static const double upright[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
/* x to y, y to z, z to x; twice as large, which changes nothing */
static const double turned[16] = {0, 0, 2, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 0, 1};

/* A sphere of radius 2 and reflectance .5 around lamp and camera, which sees all directions. */
static Image shine(vlContext *context, const void *what) {
  const Shining *shining = what;
  Stage s = stage_open_in(context, WIDE, HIGH);
  s.camera.projection = VL_PROJECTION_EQUIRECTANGULAR;
  s.build.color = VL_COLOR_RGB;
  s.render.spp = 16;
  s.render.max_depth = 1;
  vlShapeDef sphere = vl_default_shape_def(VL_SHAPE_SPHERE);
  sphere.radius = 2;
  sphere.z_min = -2;
  sphere.z_max = 2;
  sphere.material = add_diffuse(&s, 0.5f, 0.5f, 0.5f);
  assert_int_not_equal(vl_scene_add_shape(s.scene, &sphere).index, 0);
  vlLightDef def = vl_default_light_def(VL_LIGHT_GONIOMETRIC);
  def.path = shining->path;
  def.scale = shining->scale;
  if (shining->power > 0)
    def.power = shining->power;
  memcpy(def.world_from_light, shining->turn, sizeof def.world_from_light);
  assert_int_not_equal(vl_scene_add_light(s.scene, &def).index, 0);
  return stage_finish(&s);
}

static vlLamp *load_lamp(vlContext **context) {
  vlContextDef def = vl_default_context_def();
  vlLamp *lamp;
  assert_int_equal(vl_context_create(&def, context), VL_OK);
  assert_int_equal(vl_lamp_load(*context, FILE_NAME, &lamp, NULL), VL_OK);
  return lamp;
}

/* The camera looks along -z with y up; its pixels are latitude and longitude. */
static void pixel_direction(uint32_t x, uint32_t y, double d[3]) {
  double longitude = ((x + 0.5) / WIDE - 0.5) * 2 * PI;
  double latitude = (0.5 - (y + 0.5) / HIGH) * PI;
  d[0] = cos(latitude) * sin(longitude);
  d[1] = sin(latitude);
  d[2] = -cos(latitude) * cos(longitude);
}

/* Candela that the sphere's radiance stands for. */
static double candela(const Image *p, uint32_t x, uint32_t y) {
  return image_at(p, x, y, 0) * PI / 0.5 * 4;
}

static double flux_of(const Image *p) {
  double sum = 0;
  for (uint32_t y = 0; y < HIGH; y++) {
    double top = sin((0.5 - (double)y / HIGH) * PI);
    double bottom = sin((0.5 - (y + 1.0) / HIGH) * PI);
    for (uint32_t x = 0; x < WIDE; x++)
      sum += candela(p, x, y) * (top - bottom) * (2 * PI / WIDE);
  }
  return sum;
}

static void arrives(void **state) {
  (void)state;
  vlContext *context;
  vlLamp *lamp = load_lamp(&context);
  vlLampInfo info;
  vl_lamp_info(lamp, &info);
  for (int which = 0; which < 2; which++) {
    Shining shining = {FILE_NAME, 0, 1, which ? turned : upright};
    Image p = shine(NULL, &shining);
    assert_ratio("flux", flux_of(&p), info.flux, 0.002);
    for (uint32_t y = 1; y < HIGH; y += 3)
      for (uint32_t x = 1; x < WIDE; x += 5) {
        double d[3], local[3];
        pixel_direction(x, y, d);
        for (int k = 0; k < 3; k++)
          local[k] = which ? d[(k + 1) % 3] : d[k];
        assert_near("intensity", candela(&p, x, y), vl_lamp_intensity(lamp, local), 25);
      }
    image_free(&p);
  }
  vl_lamp_destroy(lamp);
  vl_context_destroy(context);
}

static void scaled(void **state) {
  (void)state;
  Shining shining = {FILE_NAME, 500, 1, upright};
  Image p = shine(NULL, &shining);
  assert_ratio("power", flux_of(&p), 500, 0.002);
  image_free(&p);
  shining.scale = 3;
  p = shine(NULL, &shining);
  assert_ratio("power and scale", flux_of(&p), 1500, 0.002);
  image_free(&p);
  p = assert_same_bits(shine, &shining, 1);
  image_free(&p);
}

static void wrong(void **state) {
  (void)state;
  Stage s = stage_open(4, 4);
  vlLightDef def = vl_default_light_def(VL_LIGHT_GONIOMETRIC);
  def.path = "/no/such/lamp.IES";
  assert_int_not_equal(vl_scene_add_light(s.scene, &def).index, 0);
  vlWorld *world = NULL;
  vlError error = {0};
  assert_int_equal(vl_world_build(s.scene, &s.build, &world, &error), VL_ERROR_MISSING);
  assert_null(world);
  stage_close(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(arrives), cmocka_unit_test(scaled),
                                     cmocka_unit_test(wrong)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
