/* test/import/test_lens.c: lenses in scene files: velo's parameters, pbrt's realistic camera,
 * errors. */
#include "import/load.h"
#include "velo/projection.h"

#define W "WorldBegin\nShape \"sphere\"\n"
#define FILM "Film \"rgb\" \"integer xresolution\" 400 \"integer yresolution\" 200\n"
#define GAUSS VELO_SOURCE_DIR "/scenes/cameras/lenses/double_gauss_50mm.dat"

static void thin_lens_words(void **state) {
  (void)state;
  Loaded l;
  load_fine(&l, FILM
            "Camera \"thinlens\" \"point3 eye\" [1 2 3] \"point3 lookat\" [1 2 -9] "
            "\"float focallength\" 50 \"float sensorwidth\" 36 \"float fnumber\" 2 "
            "\"float focuspixel\" [10 20] \"integer blades\" 6 \"float bladerotation\" 30 "
            "\"float apertureratio\" 2 \"float tiltx\" 10 \"float tilty\" -5 "
            "\"bool vignetting\" true \"float iso\" 200 \"float seconds\" 0.01\n" W);
  const vlCameraDef *d = &vl_scene_defs(l.scene)->camera;
  vlCamera c;
  vlError error;
  if (vl_camera_make(d, &c, NULL, &error) != VL_OK)
    fail_msg("%s", error.message);
  assert_true(fabs(c.lens_radius - 0.0125) < 1e-12 && c.lens.blades == 6 && c.lens.ratio == 2 &&
              c.lens.vignetting);
  assert_true(fabs(c.lens.rotation - 0.523598775598) < 1e-9 &&
              fabs(c.lens.tilt[1] - tan(0.174532925199)) < 1e-9);
  assert_true(c.lens.focus_pixel[0] == 10 && c.lens.focus_pixel[1] == 20);
  assert_true(fabs(c.exposure_time - 0.01 * 200 / 480) < 1e-12);
  end_load(&l);
  load_fine(&l, FILM
            "Camera \"fisheye\" \"float lensradius\" 0.1 \"point3 focuspoint\" [0 0 -3] "
            "\"string aperture\" \"star\"\n" W);
  if (vl_camera_make(&vl_scene_defs(l.scene)->camera, &c, NULL, &error) != VL_OK)
    fail_msg("%s", error.message);
  assert_true(c.focus_distance == 3 && c.lens.aperture);
  end_load(&l);
  load_fine(&l, FILM
            "Camera \"thinlens\" \"float fov\" 40 \"float focallength\" 50 \"float fnumber\" 4 "
            "\"float lenstiltx\" 5 \"float unitmm\" 1 \"string aperture\" \"circle\"\n" W);
  if (vl_camera_make(&vl_scene_defs(l.scene)->camera, &c, NULL, &error) != VL_OK)
    fail_msg("%s", error.message);
  assert_true(fabs(c.lens_radius - 6.25) < 1e-12 && !c.lens.aperture);
  assert_true(fabs(c.lens.hinge[1] - sin(0.0872664626) / 50) < 1e-9);
  end_load(&l);
}

static void realistic(void **state) {
  (void)state;
  Loaded l;
  load_fine(&l,
            "Film \"rgb\" \"integer xresolution\" 400 \"integer yresolution\" 300 "
            "\"float diagonal\" 43\n"
            "Camera \"realistic\" \"string lensfile\" \"" GAUSS
            "\" \"float aperturediameter\" 8 \"float focusdistance\" 1.5 "
            "\"string aperture\" \"pentagon\" \"float shutterclose\" 0.5\n" W);
  const vlSceneDefs *s = vl_scene_defs(l.scene);
  vlCamera c;
  vlError error;
  if (vl_camera_make(&s->camera, &c, NULL, &error) != VL_OK)
    fail_msg("%s", error.message);
  vlOpticsInfo info;
  assert_int_equal(c.projection, VL_PROJECTION_OPTICS);
  vl_optics_info(c.lens.optics, &info);
  assert_true(fabs(info.film_diagonal - 0.043) < 1e-12 && info.focus_distance == 1.5);
  assert_true(s->develop.exposure == 0.5f);
  end_load(&l);
}

static void wrong(void **state) {
  (void)state;
  const struct {
    const char *text, *said;
  } cases[] = {
      {"\"realistic\"", "\"string lensfile\" is missing"},
      {"\"realistic\" \"string lensfile\" \"/nowhere/wide.dat\"", "/nowhere/wide.dat"},
      {"\"realistic\" \"string lensfile\" \"" GAUSS "\" \"float focusdistance\" 0.01",
       "cannot focus"},
      {"\"realistic\" \"string lensfile\" \"" GAUSS "\" \"float fov\" 30", "fov"},
      {"\"realistic\" \"string lensfile\" \"" GAUSS
       "\" \"string aperture\" \"/nowhere/hole.png\"",
       "hole.png"},
      {"\"thinlens\" \"float fnumber\" 2", "focal length"},
      {"\"thinlens\" \"float fnumber\" -1", "\"fnumber\" must be a number from"},
      {"\"thinlens\" \"float lensradius\" 1 \"float focusdistance\" 0",
       "\"focusdistance\" must be a number above 0"},
      {"\"thinlens\" \"float focuspixel\" [1 2 3]", "focuspixel"},
      {"\"thinlens\" \"integer blades\" 2", "2 blades"},
      {"\"pinhole\" \"integer blades\" 5", "blades"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    char text[800];
    Loaded l;
    snprintf(text, sizeof text, FILM "Camera %s\n" W, cases[i].text);
    load_text(&l, text, false);
    if (l.result == VL_OK || !strstr(l.error.message, cases[i].said) ||
        strchr(l.error.message, '\n'))
      fail_msg("%s: \"%s\" should speak of \"%s\"", cases[i].text, l.error.message,
               cases[i].said);
    end_load(&l);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(thin_lens_words),
      cmocka_unit_test(realistic),
      cmocka_unit_test(wrong),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
