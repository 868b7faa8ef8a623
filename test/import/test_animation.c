/* test/import/test_animation.c: several glTF animations at once; an automatic camera frames a
 * whole animation. */
#include "import/gltf_load.h"
#include "velo/shape.h"

static void is_near(double a, double b, double max) {
  if (!(fabs(a - b) <= max))
    fail_msg("%.9g is not %.9g", a, b);
}

/* Two nodes: animation 0 (Walk) moves the first along x in 4 s, animation 1 (Jump) the second
 * along y in 2 s. */
static Gltf *two_animations(void) {
  Gltf *g = new_square();
  const float four[] = {0, 4}, two[] = {0, 2}, along[] = {0, 0, 0, 8, 0, 0},
              up[] = {0, 0, 0, 0, 6, 0};
  gltf_accessor(g, gltf_view(g, four, sizeof four, 0), 5126, 2, "SCALAR",
                ",\"min\":[0],\"max\":[4]"); /* 2 */
  gltf_accessor(g, gltf_view(g, two, sizeof two, 0), 5126, 2, "SCALAR",
                ",\"min\":[0],\"max\":[2]"); /* 3 */
  gltf_floats(g, along, 2, "VEC3", 3);       /* 4 */
  gltf_floats(g, up, 2, "VEC3", 3);          /* 5 */
  return g;
}

#define CHANNEL(node) \
  "\"channels\":[{\"sampler\":0,\"target\":{\"node\":" #node ",\"path\":\"translation\"}}]"
#define ANIMATIONS \
  "\"scenes\":[{\"nodes\":[0,1]}],\"nodes\":[{\"mesh\":0},{\"mesh\":1}],"                                \
  "\"animations\":[{\"name\":\"Walk\",\"samplers\":[{\"input\":2,\"output\":4}]," CHANNEL(0) "},"        \
  "{\"name\":\"Jump\",\"samplers\":[{\"input\":3,\"output\":5}]," CHANNEL(1) "}],"                       \
  "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1}]},"                      \
  "{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1}]}]"

/* Where the two meshes are at 1 s. */
static void places(const Gltf *g, const char *animation, double x, double y) {
  Loaded l;
  vlLoadDef def = vl_default_load_def();
  def.time = 1;
  def.animation = animation;
  fine_with(&l, g, ANIMATIONS, &def);
  is_near(shape(&l, 0)->group_from_shape[3], x, 1e-6);
  is_near(shape(&l, 1)->group_from_shape[7], y, 1e-6);
  end_load(&l);
}

static void several(void **state) {
  (void)state;
  Gltf *g = two_animations();
  places(g, NULL, 2, 0);
  places(g, "Jump", 0, 3);
  places(g, "Walk,Jump", 2, 3);
  places(g, "1,0", 2, 3);
  places(g, "all", 2, 3);
  Loaded l;
  vlLoadDef def = vl_default_load_def();
  def.time = 1;
  def.animation = "Walk,Run";
  load(&l, g, ANIMATIONS, &def);
  assert_int_equal(l.result, VL_ERROR_SCENE);
  assert_non_null(
      strstr(l.error.message, "there is no animation \"Run\" (2 are there: Walk, Jump)"));
  end_load(&l);
  free(g);
}

static void eye_at(const Gltf *g, double time, vlCameraDef *camera) {
  Loaded l;
  vlLoadDef def = vl_default_load_def();
  def.time = time;
  fine_with(&l, g, ANIMATIONS, &def);
  assert_int_equal(vl_scene_complete(l.scene, NULL, NULL), VL_OK);
  *camera = l.scene->defs.camera;
  end_load(&l);
}

/* The camera is the same at all times, and sees the square at both ends of its way. */
static void framing(void **state) {
  (void)state;
  Gltf *g = two_animations();
  vlCameraDef first, other, still;
  eye_at(g, 0, &first);
  eye_at(g, 3.3, &other);
  assert_memory_equal(first.eye, other.eye, sizeof first.eye);
  assert_memory_equal(first.lookat, other.lookat, sizeof first.lookat);
  eye_at(g, VL_UNSET, &still); /* without a time the camera frames the model as it is */
  assert_true(still.eye[2] < first.eye[2] - 3);
  vlCamera camera;
  assert_int_equal(vl_camera_make(&first, &camera, NULL, NULL), VL_OK);
  for (int k = 0; k < 2; k++) {
    const double point[3] = {k ? 9 : 0, 0.5, 0};
    double pixel[2];
    assert_true(vl_camera_project(&camera, point, pixel, NULL));
    assert_true(pixel[0] > 0 && pixel[0] < camera.width && pixel[1] > 0 &&
                pixel[1] < camera.height);
  }
  free(g);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(several), cmocka_unit_test(framing)};
  return cmocka_run_group_tests(tests, set_up, tear_down);
}
