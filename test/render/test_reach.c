/* test/render/test_reach.c: lights that only next-event estimation finds: for each transmissive
 * material, point lights behind, in front and beside it give the same mean with the light tree
 * as with sampling by power. A bound of zero where light arrives would appear as darkness, a
 * bound far too small as noise. */
#include "render/shots.h"

#include "import/import.h"
#include "velo/tracer.h"

enum { SIZE = 12 };

typedef struct Material {
  const char *name, *text, *shape;
  bool through, back; /* light from behind comes through, light from before comes back */
} Material;

static const char quad[] =
    "Shape \"trianglemesh\" \"point3 P\" [-2 -2 -3  2 -2 -3  2 2 -3  -2 2 -3] "
    "\"integer indices\" [0 1 2 0 2 3]";
static const char slab[] =
    "Shape \"trianglemesh\" \"point3 P\" [-9 -9 -3  9 -9 -3  9 9 -3  -9 9 -3] "
    "\"integer indices\" [0 1 2 0 2 3]\n"
    "Shape \"trianglemesh\" \"point3 P\" [-9 -9 -3.1  9 -9 -3.1  9 9 -3.1  -9 9 -3.1] "
    "\"integer indices\" [0 2 1 0 3 2]";
static const char hairs[] =
    "Shape \"curve\" \"point3 P\" [-1 -3 -3  -1 -1 -3  -1 1 -3  -1 3 -3] "
    "\"float width\" 1.2\n"
    "Shape \"curve\" \"string type\" \"cylinder\" "
    "\"point3 P\" [1 -3 -3  1 -1 -3  1 1 -3  1 3 -3] \"float width\" 1.2";

static const Material materials[] = {
    {"diffuse", "\"diffuse\"", quad, false, true},
    {"coated", "\"coateddiffuse\"", quad, false, true},
    {"conductor", "\"conductor\" \"float roughness\" 0.5", quad, false, true},
    {"diffuse transmission", "\"diffusetransmission\" \"rgb reflectance\" [0.3 0.3 0.3]", quad,
     true, true},
    {"transmission alone", "\"diffusetransmission\" \"rgb reflectance\" [0 0 0]", quad, true,
     false},
    {"rough glass, one surface", "\"dielectric\" \"float roughness\" 0.5", quad, true, true},
    {"rough glass, a slab", "\"dielectric\" \"float roughness\" 0.5", slab, true, true},
    {"hair", "\"hair\" \"float eumelanin\" 0.1", hairs, true, true},
    {"wide hair", "\"hair\" \"float eumelanin\" 0.3 \"float beta_m\" 0.9 \"float beta_n\" 0.9",
     hairs, true, true},
};

/* Mean green of the material under lights: where 0 behind, 1 before, 2 all round and nearly in
 * its plane. */
static double mean_of(const Material *m, int where, vlLightSampler sampler, double *noise) {
  static const float places[3][4][3] = {
      {{0.5f, 0.3f, -5}, {-1, 1, -4}, {2, -1, -6}, {-2, -2, -4}},
      {{0.5f, 0.3f, -1}, {-1, 1, -2}, {2, -1, 1}, {-2, -2, -2}},
      {{4, 0, -2.9f}, {-4, 0.5f, -3.1f}, {0, 5, -2.5f}, {0, -5, -3.5f}},
  };
  char text[2000], *at = text;
  at += sprintf(at, "WorldBegin\n");
  for (int i = 0; i < 4; i++)
    at += sprintf(at, "LightSource \"point\" \"point3 from\" [%g %g %g] \"rgb I\" [3 3 3]\n",
                  (double)places[where][i][0], (double)places[where][i][1],
                  (double)places[where][i][2]);
  sprintf(at, "Material %s\n%s\n", m->text, m->shape);
  Stage s = stage_open(SIZE, SIZE);
  vlError error = {0};
  vlLoadDef load = vl_default_load_def();
  if (vl_import_pbrt_memory(s.scene, text, strlen(text), "t.pbrt", &load, &error) != VL_OK)
    fail_msg("%s: %s", m->name, error.message);
  s.build.light_sampler = sampler;
  s.build.color = VL_COLOR_RGB;
  s.render.spp = m->shape == quad ? 256 : 512; /* hair concentrates light */
  s.render.max_depth = m->shape == slab ? 3 : 1;
  s.render.tracer = VL_TRACER_PATH;
  Image p = stage_finish(&s);
  double mean = image_mean(&p, 1), max = 0;
  for (uint32_t i = 0; i < SIZE * SIZE; i++)
    max = fmax(max, p.rgba[4 * i + 1]);
  *noise = mean > 0 ? max / mean : 0;
  image_free(&p);
  return mean;
}

static void every_light_is_asked(void **state) {
  (void)state;
  for (size_t i = 0; i < sizeof materials / sizeof *materials; i++)
    for (int where = 0; where < 3; where++) {
      const Material *m = &materials[i];
      double max_tree, max_power;
      double tree = mean_of(m, where, VL_LIGHT_SAMPLER_BVH, &max_tree);
      double power = mean_of(m, where, VL_LIGHT_SAMPLER_POWER, &max_power);
      char what[100];
      snprintf(what, sizeof what, "%s, lights %s", m->name,
               where == 0   ? "behind"
               : where == 1 ? "before"
                            : "beside");
      bool dark = (where == 0 && !m->through) || (where == 1 && !m->back);
      if (dark != !(power > 1e-6))
        fail_msg("%s: %g by power", what, power);
      assert_near(what, tree, power, 0.04 * power);
      if (max_tree > 2 * max_power + 1)
        fail_msg("%s: a pixel of %g times the mean", what, max_tree);
    }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(every_light_is_asked)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
