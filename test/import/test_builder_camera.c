/* test/import/test_builder_camera.c: statements for pbrt's and the lecture's cameras, and the
 * defs of the image. */
#include "import/load.h"
#include "velo/filter_kinds.h"
#include "velo/sampler.h"
#include "velo/shape.h"
#include "velo/tracer.h"

#define W "WorldBegin\n"

static const double *shape_matrix(const Loaded *l, size_t i) {
  return l->scene->shapes.items[i].group_from_shape;
}

static void assert_matrix(const double *m, const double expected[16]) {
  for (int i = 0; i < 16; i++)
    assert_near(m[i], expected[i], 1e-12);
}

static vlCamera camera_of(Loaded *l, const char *text) {
  vlCamera camera;
  vlError error;
  load_fine(l, text);
  vlResult result = vl_camera_make(&vl_scene_defs(l->scene)->camera, &camera, NULL, &error);
  if (result != VL_OK)
    print_message("%s\n", error.message);
  assert_int_equal(result, VL_OK);
  return camera;
}

static void assert_seen(const vlCamera *camera, double x, double y, double z, double px,
                        double py) {
  double pixel[2], depth;
  assert_true(vl_camera_project(camera, (double[]){x, y, z}, pixel, &depth));
  assert_near(pixel[0], px, 1e-9);
  assert_near(pixel[1], py, 1e-9);
}

/* pbrt looks along +z, x to the right, y up, in a left-handed world; fov spans the smaller
 * side. */
static void pbrt_cameras(void **state) {
  (void)state;
  Loaded l;
  vlCamera c = camera_of(&l,
                         "Film \"rgb\" \"integer xresolution\" 200 "
                         "\"integer yresolution\" 100\n"
                         "Camera \"perspective\" \"float fov\" 90\n" W);
  assert_seen(&c, 0, 0, 1, 100, 50);
  assert_seen(&c, 1, 0, 1, 150, 50);
  assert_seen(&c, 0, 1, 1, 100, 0);
  assert_string_equal(vl_scene_defs(l.scene)->camera_source.file, "t.pbrt");
  assert_int_equal(vl_scene_defs(l.scene)->camera_source.line, 2);
  end_load(&l);
  /* portrait: fov across */
  c = camera_of(&l,
                "Film \"rgb\" \"integer xresolution\" 100 \"integer yresolution\" 200\nCamera "
                "\"perspective\"\n" W);
  assert_seen(&c, 1, 0, 1, 100, 100);
  assert_seen(&c, 0, 1, 1, 50, 50);
  end_load(&l);
  /* LookAt: from (0,0,-5) to the origin; right is +x in pbrt's numbers */
  c = camera_of(&l,
                "LookAt 0 0 -5 0 0 0 0 1 0\n"
                "Film \"rgb\" \"integer xresolution\" 100 \"integer yresolution\" 100\n"
                "Camera \"perspective\"\n" W);
  assert_seen(&c, 5, 0, 0, 100, 50);
  assert_seen(&c, 0, 5, 0, 50, 0);
  assert_near(c.world_from_camera[11], -5, 1e-12);
  end_load(&l);
  /* a mirroring transform before the camera swaps left and right */
  c = camera_of(&l,
                "Scale -1 1 1\n"
                "Film \"rgb\" \"integer xresolution\" 100 \"integer yresolution\" 100\n"
                "Camera \"perspective\"\n" W);
  assert_seen(&c, 1, 0, 1, 0, 50);
  end_load(&l);
  /* screen window: x 0..1, y 0..1 at fov 90: the quadrant right and above */
  c = camera_of(&l,
                "Film \"rgb\" \"integer xresolution\" 100 \"integer yresolution\" 100\n"
                "Camera \"perspective\" \"float screenwindow\" [0 1 0 1] \"float fov\" 90\n" W);
  assert_seen(&c, 0, 0, 1, 0, 100);
  assert_seen(&c, 1, 1, 1, 100, 0);
  end_load(&l);
  /* a frame of another shape than the image: pixels are not square */
  c = camera_of(&l,
                "Film \"rgb\" \"integer xresolution\" 100 \"integer yresolution\" 100\n"
                "Camera \"perspective\" \"float frameaspectratio\" 2\n" W);
  assert_seen(&c, 2, 1, 1, 100, 0);
  end_load(&l);
  c = camera_of(&l,
                "Film \"rgb\" \"integer xresolution\" 200 \"integer yresolution\" 100\n"
                "Camera \"orthographic\" \"float screenwindow\" [-4 4 -2 2]\n" W);
  assert_int_equal(c.projection, VL_PROJECTION_ORTHOGRAPHIC);
  assert_seen(&c, 2, 1, 7, 150, 25);
  end_load(&l);
  c = camera_of(&l,
                "Film \"rgb\" \"integer xresolution\" 200 \"integer yresolution\" 100\nCamera "
                "\"orthographic\"\n" W);
  assert_seen(&c, 2, 1, 7, 200, 0);
  end_load(&l);
  c = camera_of(&l,
                "Camera \"perspective\" \"float lensradius\" 0.5 \"float focaldistance\" 7 "
                "\"float shutteropen\" 1 \"float shutterclose\" 3\n" W);
  assert_near(c.lens_radius, 0.5, 0);
  assert_near(c.focus_distance, 7, 0);
  assert_near(c.shutter_open, 1, 0);
  assert_near(c.shutter_close, 3, 0);
  /* pbrt's imaging ratio counts the time */
  assert_near(vl_scene_defs(l.scene)->develop.exposure, 2, 0);
  end_load(&l);
  c = camera_of(&l, "Camera \"perspective\" \"float lensradius\" 0.5\n" W);
  assert_near(c.focus_distance, 1e6, 0);
  end_load(&l);
  c = camera_of(&l, W); /* no camera: pbrt's default at the origin */
  assert_seen(&c, 0, 0, 1, 640, 360);
  assert_seen(&c, 0, 1, 1, 640, 0);
  end_load(&l);
}

/* "camera" names the camera's place with pbrt's axes. */
static void camera_system(void **state) {
  (void)state;
  Loaded l;
  load_fine(&l, "LookAt 1 2 3 1 2 9 0 1 0\nCamera \"perspective\"\n" W
                "CoordSysTransform \"camera\"\nShape \"sphere\"");
  assert_matrix(shape_matrix(&l, 0),
                (double[]){1, 0, 0, 1, 0, 1, 0, 2, 0, 0, 1, 3, 0, 0, 0, 1});
  end_load(&l);
  load_fine(&l, "Camera \"pinhole\" \"point3 eye\" [1 2 3] \"point3 lookat\" [1 2 -9]\n" W
                "CoordSysTransform \"camera\"\nShape \"sphere\"");
  assert_matrix(shape_matrix(&l, 0),
                (double[]){1, 0, 0, 1, 0, 1, 0, 2, 0, 0, -1, 3, 0, 0, 0, 1});
  end_load(&l);
}

/* The lecture's words: d = x_v u + y_v v - d w with x_v = s (c - h/2 + p_x); rows in files
 * count from the top. */
static void lecture_cameras(void **state) {
  (void)state;
  Loaded l;
  vlCamera c =
      camera_of(&l,
                "Film \"rgb\" \"integer xresolution\" 400 \"integer yresolution\" 300\n"
                "Camera \"pinhole\" \"point3 eye\" [0 0 500] \"point3 lookat\" [0 0 0] "
                "\"vector3 up\" [0 1 0] \"float d\" 400\n"
                "  \"float zoom\" 1.5 \"float pixelsize\" 0.5 \"float exposuretime\" 2 "
                "\"float roll\" 0\n" W);
  assert_seen(&c, 0, 0, 0, 200, 150);
  assert_seen(&c, 10, 20, 0, 200 + 1.5 * 400 / 0.5 * 10 / 500,
              150 - 1.5 * 400 / 0.5 * 20 / 500);
  assert_near(c.exposure_time, 2, 0);
  end_load(&l);
  c = camera_of(&l,
                "Film \"rgb\" \"integer xresolution\" 400 \"integer yresolution\" 300\n"
                "Camera \"pinhole\" \"point3 eye\" [0 0 5] \"float fov\" 90 "
                "\"string fovaxis\" \"horizontal\" \"float roll\" 90\n" W);
  assert_near(c.fx, 200, 1e-9);
  assert_seen(&c, 0, 1, 4, 0, 150); /* the camera turned clockwise: up is on the left */
  end_load(&l);
  c = camera_of(&l,
                "Camera \"thinlens\" \"float lensradius\" 2 \"float focusdistance\" 30 "
                "\"float fx\" 100 \"float cx\" 3 \"float cy\" 4\n" W);
  assert_near(c.lens_radius, 2, 0);
  assert_near(c.focus_distance, 30, 0);
  assert_near(c.fy, 100, 0);
  assert_near(c.cx, 3, 0);
  end_load(&l);
}

static void defaults_are_those_of_pbrt(void **state) {
  (void)state;
  Loaded l;
  load_fine(&l, W);
  const vlSceneDefs *s = vl_scene_defs(l.scene);
  assert_int_equal(s->film.width, 1280);
  assert_int_equal(s->film.height, 720);
  assert_int_equal(s->render.spp, 16);
  assert_int_equal(s->render.sampler, VL_SAMPLER_ZSOBOL);
  assert_int_equal(s->render.tracer, VL_TRACER_VOLPATH);
  assert_int_equal(s->render.max_depth, 5);
  assert_int_equal(s->film.filter.kind, VL_PIXEL_FILTER_GAUSSIAN);
  assert_near(s->film.filter.radius_x, 1.5, 0);
  assert_near(s->film.filter.sigma, 0.5, 0);
  assert_near(s->develop.exposure, 1, 0);
  end_load(&l);
}

static void film_sampler_and_filter(void **state) {
  (void)state;
  Loaded l;
  load_fine(&l,
            "Option \"seed\" 17\n"
            "ColorSpace \"rec2020\"\n"
            "Film \"rgb\" \"integer xresolution\" 100 \"integer yresolution\" [ 50 ]\n"
            "  \"string filename\" \"out.exr\" \"float iso\" 200\n"
            "  \"float cropwindow\" [ .101 .5 0 .21 ] \"bool savefp16\" false\n"
            "  \"float diagonal\" 20 \"string sensor\" \"cie1931\"\n"
            "Sampler \"stratified\" \"integer xsamples\" 3 \"integer ysamples\" 5\n"
            "PixelFilter \"mitchell\" \"float xradius\" 3 \"float B\" .5 \"float C\" .25\n"
            "Integrator \"volpath\" \"integer maxdepth\" 12\n"
            "  \"string lightsampler\" \"power\" \"bool regularize\" true\n"
            "Accelerator \"kdtree\" \"integer intersectcost\" 5\n"
            "TransformTimes 0 1\n" W);
  const vlSceneDefs *s = vl_scene_defs(l.scene);
  assert_int_equal(s->film.crop[0], 11); /* rounded up, as pbrt */
  assert_int_equal(s->film.crop[2], 50);
  assert_int_equal(s->film.crop[1], 0);
  assert_int_equal(s->film.crop[3], 11);
  assert_string_equal(s->output, "out.exr");
  assert_near(s->develop.exposure, 2, 0);
  assert_int_equal(s->film.space, VL_SPACE_REC2020);
  assert_int_equal(s->render.sampler, VL_SAMPLER_STRATIFIED);
  assert_int_equal(s->render.spp, 15);
  assert_int_equal(s->render.seed, 17);
  assert_near(s->film.filter.radius_x, 3, 0);
  assert_near(s->film.filter.radius_y, 2, 0);
  assert_near(s->film.filter.c, .25, 0);
  assert_int_equal(s->render.max_depth, 12);
  assert_int_equal(s->build.light_sampler, VL_LIGHT_SAMPLER_POWER);
  assert_true(s->build.regularize);
  end_load(&l);
}

static void crop_in_pixels_and_ambient_occlusion(void **state) {
  (void)state;
  Loaded l;
  load_fine(&l,
            "Film \"rgb\" \"integer xresolution\" 100 \"integer yresolution\" 50 "
            "\"integer pixelbounds\" [ 10 20 -5 500 ]\n"
            "Integrator \"ambientocclusion\" \"float maxdistance\" 4 "
            "\"bool cossample\" false\n"
            "Sampler \"paddedsobol\" \"integer pixelsamples\" 8 \"integer seed\" 3 "
            "\"string randomization\" \"owen\"\n" W);
  const vlSceneDefs *s = vl_scene_defs(l.scene);
  assert_int_equal(s->film.crop[0], 10);
  assert_int_equal(s->film.crop[1], 0);
  assert_int_equal(s->film.crop[2], 20);
  assert_int_equal(s->film.crop[3], 50);
  assert_int_equal(s->render.tracer, VL_TRACER_AMBIENT_OCCLUSION);
  assert_near(s->render.ao_distance, 4, 0);
  assert_false(s->render.ao_cosine);
  assert_int_equal(s->render.sampler, VL_SAMPLER_SOBOL);
  assert_int_equal(s->render.seed, 3);
  assert_non_null(strstr(l.log, "info t.pbrt:3:1: sampler \"paddedsobol\""));
  end_load(&l);
}

static void rough_coats_are_noted(void **state) {
  (void)state;
  Loaded l;
  load_fine(&l, W
            "Material \"coateddiffuse\" \"float roughness\" 0.001\nShape \"sphere\"\n"
            "Material \"coateddiffuse\" \"float roughness\" 0.1\nShape \"sphere\"");
  assert_non_null(strstr(l.log, ": 1 rough coat: pbrt-v4 shows such 2 to 8 %"));
  end_load(&l);
}

static void samplers_by_name(void **state) {
  (void)state;
  Loaded l;
  const struct {
    const char *name;
    vlSamplerKind kind;
  } samplers[] = {{"independent", VL_SAMPLER_INDEPENDENT},
                  {"random", VL_SAMPLER_INDEPENDENT},
                  {"regular", VL_SAMPLER_REGULAR},
                  {"jittered", VL_SAMPLER_STRATIFIED},
                  {"nrooks", VL_SAMPLER_NROOKS},
                  {"multijittered", VL_SAMPLER_MULTI_JITTERED},
                  {"hammersley", VL_SAMPLER_HAMMERSLEY},
                  {"halton", VL_SAMPLER_HALTON},
                  {"sobol", VL_SAMPLER_SOBOL},
                  {"zsobol", VL_SAMPLER_ZSOBOL},
                  {"pmj02bn", VL_SAMPLER_ZSOBOL}};
  for (size_t i = 0; i < sizeof samplers / sizeof *samplers; i++) {
    char text[128];
    snprintf(text, sizeof text, "Sampler \"%s\" \"integer pixelsamples\" 9\n" W,
             samplers[i].name);
    load_fine(&l, text);
    assert_int_equal(vl_scene_defs(l.scene)->render.sampler, samplers[i].kind);
    assert_int_equal(vl_scene_defs(l.scene)->render.spp, 9);
    end_load(&l);
  }
}

static void filters_by_name(void **state) {
  (void)state;
  Loaded l;
  const struct {
    const char *name;
    vlPixelFilterKind kind;
    float radius;
  } filters[] = {{"box", VL_PIXEL_FILTER_BOX, .5f},
                 {"triangle", VL_PIXEL_FILTER_TRIANGLE, 2},
                 {"gaussian", VL_PIXEL_FILTER_GAUSSIAN, 1.5f},
                 {"mitchell", VL_PIXEL_FILTER_MITCHELL, 2},
                 {"sinc", VL_PIXEL_FILTER_LANCZOS, 4},
                 {"lanczos", VL_PIXEL_FILTER_LANCZOS, 4},
                 {"blackmanharris", VL_PIXEL_FILTER_BLACKMAN_HARRIS, 2}};
  for (size_t i = 0; i < sizeof filters / sizeof *filters; i++) {
    char text[128];
    snprintf(text, sizeof text, "PixelFilter \"%s\"\n" W, filters[i].name);
    load_fine(&l, text);
    assert_int_equal(vl_scene_defs(l.scene)->film.filter.kind, filters[i].kind);
    assert_near(vl_scene_defs(l.scene)->film.filter.radius_x, filters[i].radius, 0);
    end_load(&l);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(pbrt_cameras),
                                     cmocka_unit_test(camera_system),
                                     cmocka_unit_test(lecture_cameras),
                                     cmocka_unit_test(defaults_are_those_of_pbrt),
                                     cmocka_unit_test(film_sampler_and_filter),
                                     cmocka_unit_test(crop_in_pixels_and_ambient_occlusion),
                                     cmocka_unit_test(rough_coats_are_noted),
                                     cmocka_unit_test(samplers_by_name),
                                     cmocka_unit_test(filters_by_name)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
